//! Where pieces are built: a graph whose operations are simplified as they are added, with operands in an order that
//! depends on nothing but what they are, so that equal zero sets of different curves become equal values.

use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::collections::BTreeSet;
use std::collections::HashMap;
use std::collections::HashSet;

use num_rational::BigRational;

use super::poles::Build;
use crate::graph::Graph;
use crate::graph::Node;
use crate::graph::Op;
use crate::graph::Value;
use crate::graph::apply;
use crate::interval::Decorated;
use crate::interval::Interval;
use crate::passes::algebra;
use crate::passes::builder::Builder;
use crate::passes::fold;

/// Rows that may follow one another at one operation.
const MAX_STEPS: usize = 8;

/// A graph in the making, by simplified operations.
pub struct Space<'a> {
    builder: Builder<'a>,
    inputs: &'a [Interval],
}

impl<'a> Space<'a> {
    pub fn new(variables: &[String], inputs: &'a [Interval]) -> Self {
        Self { builder: Builder::new(variables, inputs), inputs }
    }

    pub fn graph(&self) -> &Graph {
        self.builder.graph()
    }

    /// The operation, simplified.
    pub fn push(&mut self, op: Op, operands: &[Value]) -> Value {
        let (mut op, mut operands) = (op, operands.to_vec());
        for _ in 0..MAX_STEPS {
            self.sort(op, &mut operands);
            let folded = fold::rewrite(&mut self.builder, op, &operands);
            let Some(value) = folded.or_else(|| algebra::rewrite(&mut self.builder, op, &operands)) else { break };
            let node = self.graph().node(value);
            if node.operands().is_empty() {
                return value;
            }
            (op, operands) = (node.op, node.operands().to_vec());
        }
        self.sort(op, &mut operands);
        self.builder.push(op, &operands)
    }

    fn sort(&self, op: Op, operands: &mut [Value]) {
        if let (Op::Add | Op::Mul | Op::Min | Op::Max | Op::Hypot | Op::Equal, [x, y]) = (op, operands)
            && self.order(*x, *y) == Ordering::Greater
        {
            std::mem::swap(x, y);
        }
    }

    /// An order of values by what they are: operations, numbers and inputs, then the first operands that differ.
    pub fn order(&self, mut a: Value, mut b: Value) -> Ordering {
        let graph = self.graph();
        while a != b {
            if let (Some(c), Some(d)) = (graph.as_constant(a), graph.as_constant(b)) {
                return c.cmp(d);
            }
            let (x, y) = (graph.node(a), graph.node(b));
            // Indices of constants say nothing; those of inputs are the caller's.
            let by_operation = match (x.op, y.op) {
                (Op::Const(_), _) => Ordering::Less,
                (_, Op::Const(_)) => Ordering::Greater,
                (op, other) => op.cmp(&other),
            };
            if by_operation != Ordering::Equal {
                return by_operation;
            }
            // Equal nodes are one node, so that some operands differ.
            match x.operands().iter().zip(y.operands()).find(|(x, y)| x != y) {
                Some((&x, &y)) => (a, b) = (x, y),
                None => return Ordering::Equal,
            }
        }
        Ordering::Equal
    }

    pub fn unary(&mut self, op: Op, x: Value) -> Value {
        self.push(op, &[x])
    }

    pub fn binary(&mut self, op: Op, x: Value, y: Value) -> Value {
        self.push(op, &[x, y])
    }

    pub fn constant(&mut self, number: BigRational) -> Value {
        self.builder.constant(number)
    }

    pub fn int(&mut self, number: i64) -> Value {
        self.constant(BigRational::from_integer(number.into()))
    }

    /// A value times a number.
    pub fn times(&mut self, factor: &BigRational, x: Value) -> Value {
        let factor = self.constant(factor.clone());
        self.push(Op::Mul, &[factor, x])
    }

    /// A value and a number.
    pub fn plus(&mut self, x: Value, number: &BigRational) -> Value {
        let number = self.constant(number.clone());
        self.push(Op::Add, &[x, number])
    }

    pub fn number(&self, value: Value) -> Option<&BigRational> {
        self.builder.number(value)
    }

    pub fn shape(&self, value: Value) -> (Op, &[Value]) {
        self.builder.shape(value)
    }

    /// The operation with copies of its operands, which can be looked at while the graph grows.
    pub fn taken(&self, value: Value) -> (Op, Vec<Value>) {
        let (op, operands) = self.shape(value);
        (op, operands.to_vec())
    }

    pub fn enclosure(&self, value: Value) -> Interval {
        self.builder.enclosure(value)
    }

    pub fn total(&self, value: Value) -> bool {
        self.builder.total(value)
    }

    pub fn is_function(&self, value: Value) -> bool {
        self.builder.is_function(value)
    }

    /// What is proved not to vanish anywhere in the domain where it is defined.
    pub fn never_zero(&self, value: Value) -> bool {
        !self.enclosure(value).contains(0.0)
    }

    /// What `value` needs, itself included, operands before users; nothing that only operands in `stop` need.
    pub fn below(&self, value: Value, stop: impl Fn(Op, usize) -> bool) -> Vec<Value> {
        let mut seen = HashSet::from([value]);
        let mut stack = vec![value];
        let mut order = BTreeSet::new();
        while let Some(value) = stack.pop() {
            order.insert(value);
            let (op, operands) = self.shape(value);
            for (place, &operand) in operands.iter().enumerate() {
                if !stop(op, place) && seen.insert(operand) {
                    stack.push(operand);
                }
            }
        }
        order.into_iter().collect()
    }

    /// The value on that part of the domain where `known` lies in an interval.
    pub fn enclosure_where(&self, value: Value, known: Value, range: Interval) -> Interval {
        let mut bounds: HashMap<Value, Decorated> = HashMap::new();
        for value in self.below(value, |_, _| false) {
            let node = self.graph().node(value);
            let operands: Vec<Decorated> = node.operands().iter().map(|v| bounds[v]).collect();
            let bound = match node.op {
                Op::Var(id) => Decorated::new(self.inputs[id as usize]),
                _ => apply(self.graph(), node, &operands),
            };
            let meets = if value == known { bound.interval().intersect(range) } else { bound.interval() };
            bounds.insert(value, Decorated::with(meets, bound.decoration()));
        }
        bounds[&value].interval()
    }

    /// Copies of values of another graph with the same inputs, simplified.
    pub fn import(&mut self, source: &Graph, roots: &[Value]) -> Vec<Value> {
        let needed = source.reachable(roots);
        let mut image: HashMap<Value, Value> = HashMap::new();
        for (value, node) in source.iter().filter(|(v, _)| needed[v.index()]) {
            let copy = match (node.op, source.as_constant(value)) {
                (_, Some(number)) => self.constant(number.clone()),
                (Op::Var(id), None) => self.builder.input(&source.variables()[id as usize]),
                (op, None) => {
                    let operands: Vec<Value> = node.operands().iter().map(|v| image[v]).collect();
                    self.push(op, &operands)
                }
            };
            image.insert(value, copy);
        }
        roots.iter().map(|root| image[root]).collect()
    }

    /// The value with another one in the place of `part`.
    pub fn substitute(&mut self, value: Value, part: Value, replacement: Value) -> Value {
        let mut image: BTreeMap<Value, Value> = BTreeMap::from([(part, replacement)]);
        for v in self.below(value, |_, _| false) {
            let (op, operands) = self.taken(v);
            if v == part || operands.iter().all(|operand| !image.contains_key(operand)) {
                continue;
            }
            let operands: Vec<Value> = operands.iter().map(|v| *image.get(v).unwrap_or(v)).collect();
            let copy = self.push(op, &operands);
            image.insert(v, copy);
        }
        *image.get(&value).unwrap_or(&value)
    }
}

impl Build for Space<'_> {
    fn node(&self, value: Value) -> Node {
        *self.graph().node(value)
    }

    fn build(&mut self, op: Op, operands: &[Value]) -> Value {
        self.push(op, operands)
    }

    fn whole(&mut self, number: i64) -> Value {
        self.int(number)
    }

    fn cone(&self, value: Value) -> Vec<Value> {
        self.below(value, |_, _| false)
    }
}
