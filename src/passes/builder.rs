//! The new graph that a pass builds, with what is known of its values over the domain.

use std::cell::RefCell;

use num_rational::BigRational;

use crate::graph::Graph;
use crate::graph::Op;
use crate::graph::Value;
use crate::graph::apply;
use crate::interval::Decorated;
use crate::interval::Decoration;
use crate::interval::Interval;

/// A graph in the making. Its inputs are those of the old graph in the same order, needed or not, so that bounds given by
/// position stay valid and a kernel's signature does not depend on what a rewrite cancels.
#[derive(Debug)]
pub struct Builder<'a> {
    graph: Graph,
    inputs: &'a [Interval],
    /// Facts of the first values, extended when one is asked for.
    facts: RefCell<Vec<Fact>>,
}

#[derive(Debug, Clone, Copy)]
struct Fact {
    /// The natural extension over the whole domain.
    enclosure: Decorated,
    /// Whether the cone of the node holds `Entire`, `Kink` or `SelectJump`.
    set_valued: bool,
}

impl<'a> Builder<'a> {
    pub fn new(variables: &[String], inputs: &'a [Interval]) -> Self {
        assert_eq!(variables.len(), inputs.len(), "one interval for each input");
        let mut graph = Graph::new();
        for name in variables {
            graph.var(name);
        }
        Self { graph, inputs, facts: RefCell::default() }
    }

    pub fn finish(self, outputs: impl Iterator<Item = (String, Value)>) -> Graph {
        let mut graph = self.graph;
        for (name, value) in outputs {
            graph.add_output(name, value);
        }
        graph
    }

    pub fn graph(&self) -> &Graph {
        &self.graph
    }

    pub fn push(&mut self, op: Op, operands: &[Value]) -> Value {
        self.graph.push(op, operands)
    }

    pub fn constant(&mut self, number: BigRational) -> Value {
        self.graph.constant(number)
    }

    pub fn input(&mut self, name: &str) -> Value {
        self.graph.var(name)
    }

    /// The operation and its operands, which is what most rows look at.
    pub fn shape(&self, value: Value) -> (Op, &[Value]) {
        let node = self.graph.node(value);
        (node.op, node.operands())
    }

    /// The number of a constant.
    pub fn number(&self, value: Value) -> Option<&BigRational> {
        self.graph.as_constant(value)
    }

    /// The operand of a unary node of that operation.
    pub fn under(&self, op: Op, value: Value) -> Option<Value> {
        match self.shape(value) {
            (found, &[operand]) if found == op => Some(operand),
            _ => None,
        }
    }

    /// Encloses the value wherever in the domain it is defined.
    pub fn enclosure(&self, value: Value) -> Interval {
        self.fact(value).enclosure.interval()
    }

    /// Whether the value is proved to be defined on the whole domain. To drop a value from the graph forgets nothing then.
    pub fn total(&self, value: Value) -> bool {
        let enclosure = self.fact(value).enclosure;
        enclosure.decoration() >= Decoration::Def
    }

    /// Whether the value is one real number at each point. A derivative across a possible jump or at a kink is not: two
    /// uses of `Entire` are unknown numbers that need not be equal, so that no row may treat them as one.
    pub fn is_function(&self, value: Value) -> bool {
        !self.fact(value).set_valued
    }

    fn fact(&self, value: Value) -> Fact {
        let mut facts = self.facts.borrow_mut();
        for i in facts.len()..=value.index() {
            let node = self.graph.node(Value(i as u32));
            let operands: Vec<Decorated> = node.operands().iter().map(|v| facts[v.index()].enclosure).collect();
            let enclosure = match node.op {
                Op::Var(id) => Decorated::new(self.inputs[id as usize]),
                _ => apply(&self.graph, node, &operands),
            };
            let set_valued = matches!(node.op, Op::Entire | Op::Kink | Op::SelectJump)
                || node.operands().iter().any(|v| facts[v.index()].set_valued);
            facts.push(Fact { enclosure, set_valued });
        }
        facts[value.index()]
    }
}
