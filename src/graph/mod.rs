//! The graph: hash-consed SSA over exact real operations, its textual form, its verifier, and what one operation
//! does to enclosures.

mod affine;
mod eval;
mod op;
mod text;
mod verify;

use std::collections::HashMap;
use std::fmt;

use num_rational::BigRational;
use num_traits::{One, Zero};

pub use affine::apply_affine;
pub use eval::{apply, enclose};
pub(crate) use op::elementary_function;
pub use op::{AffineForm, Op, Totality};
pub use text::{ParseError, parse};
pub use verify::{truths, verify};

/// A value of a graph: the index of the node that computes it. Its `Display` is the textual form, `v7`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Value(pub u32);

impl Value {
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "v{}", self.0)
    }
}

/// One operation with its operands; unused places repeat `Node::NONE`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Node {
    pub op: Op,
    operands: [Value; 3],
}

impl Node {
    const NONE: Value = Value(u32::MAX);

    /// The operands, as many as the operation's arity.
    pub fn operands(&self) -> &[Value] {
        &self.operands[..self.op.arity()]
    }
}

/// Nodes in definition order: an operand always has a smaller index than its user. Equal nodes are one node.
#[derive(Debug, Clone, Default)]
pub struct Graph {
    nodes: Vec<Node>,
    constants: Vec<BigRational>,
    variables: Vec<String>,
    /// Named results, in the order in which they were added.
    outputs: Vec<(String, Value)>,
    interned: HashMap<Node, Value>,
    constant_ids: HashMap<BigRational, u32>,
    variable_ids: HashMap<String, u32>,
}

impl Graph {
    pub fn new() -> Self {
        Self::default()
    }

    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    pub fn node(&self, value: Value) -> &Node {
        &self.nodes[value.index()]
    }

    /// Every value with its node, operands before users.
    pub fn iter(&self) -> impl Iterator<Item = (Value, &Node)> {
        self.nodes.iter().enumerate().map(|(i, node)| (Value(i as u32), node))
    }

    pub fn variables(&self) -> &[String] {
        &self.variables
    }

    pub fn outputs(&self) -> &[(String, Value)] {
        &self.outputs
    }

    /// The value of the output of that name.
    pub fn output(&self, name: &str) -> Option<Value> {
        self.outputs.iter().find(|(n, _)| n == name).map(|&(_, v)| v)
    }

    pub fn add_output(&mut self, name: impl Into<String>, value: Value) {
        self.outputs.push((name.into(), value));
    }

    /// The input of that name, added on its first use.
    pub fn var(&mut self, name: &str) -> Value {
        let index = match self.variable_ids.get(name) {
            Some(&index) => index,
            None => {
                let index = self.variables.len() as u32;
                self.variables.push(name.to_owned());
                self.variable_ids.insert(name.to_owned(), index);
                index
            }
        };
        self.push(Op::Var(index), &[])
    }

    pub fn constant(&mut self, number: BigRational) -> Value {
        let id = match self.constant_ids.get(&number) {
            Some(&id) => id,
            None => {
                let id = self.constants.len() as u32;
                self.constants.push(number.clone());
                self.constant_ids.insert(number, id);
                id
            }
        };
        self.push(Op::Const(id), &[])
    }

    pub fn int(&mut self, number: i64) -> Value {
        self.constant(BigRational::from_integer(number.into()))
    }

    /// The number of a `Const` node; `None` for every other node.
    pub fn as_constant(&self, value: Value) -> Option<&BigRational> {
        match self.node(value).op {
            Op::Const(id) => Some(&self.constants[id as usize]),
            _ => None,
        }
    }

    pub fn is_zero(&self, value: Value) -> bool {
        self.as_constant(value).is_some_and(Zero::is_zero)
    }

    pub fn is_one(&self, value: Value) -> bool {
        self.as_constant(value).is_some_and(One::is_one)
    }

    /// Whether a constant index exists; the verifier's question.
    fn has_constant(&self, id: u32) -> bool {
        (id as usize) < self.constants.len()
    }

    /// Adds a node, or finds the equal one that is there. No rewriting happens here: rewrites are passes.
    ///
    /// # Panics
    /// If the number of operands is not the arity.
    pub fn push(&mut self, op: Op, operands: &[Value]) -> Value {
        assert_eq!(operands.len(), op.arity(), "{} takes {} operands", op.name(), op.arity());
        debug_assert!(operands.iter().all(|v| v.index() < self.nodes.len()), "an operand is not defined yet");
        let mut node = Node { op, operands: [Node::NONE; 3] };
        node.operands[..operands.len()].copy_from_slice(operands);
        if let Some(&value) = self.interned.get(&node) {
            return value;
        }
        let value = Value(self.nodes.len() as u32);
        self.nodes.push(node);
        self.interned.insert(node, value);
        value
    }

    /// Copies what `roots` need from `source` into this graph, with the inputs named in `replace` replaced by given
    /// values of this graph and all others kept by name. Returns the images of `roots`.
    pub fn import(&mut self, source: &Graph, roots: &[Value], replace: &HashMap<String, Value>) -> Vec<Value> {
        let needed = source.reachable(roots);
        let mut image = vec![Node::NONE; source.len()];
        for (value, node) in source.iter().filter(|(v, _)| needed[v.index()]) {
            image[value.index()] = match node.op {
                Op::Const(id) => self.constant(source.constants[id as usize].clone()),
                Op::Var(id) => {
                    let name = &source.variables[id as usize];
                    match replace.get(name) {
                        Some(&replacement) => replacement,
                        None => self.var(name),
                    }
                }
                op => {
                    let operands: Vec<Value> = node.operands().iter().map(|v| image[v.index()]).collect();
                    self.push(op, &operands)
                }
            };
        }
        roots.iter().map(|v| image[v.index()]).collect()
    }

    /// The values of `roots` with inputs replaced by other values of this graph; nothing else changes.
    pub fn substitute(&mut self, roots: &[Value], replace: &HashMap<Value, Value>) -> Vec<Value> {
        let needed = self.reachable(roots);
        let mut image: Vec<Value> = (0..self.nodes.len() as u32).map(Value).collect();
        for i in 0..image.len() {
            let value = Value(i as u32);
            if let Some(&replacement) = replace.get(&value) {
                image[i] = replacement;
            } else if needed[i] && self.nodes[i].op.arity() > 0 {
                let node = self.nodes[i];
                let operands: Vec<Value> = node.operands().iter().map(|v| image[v.index()]).collect();
                image[i] = self.push(node.op, &operands);
            }
        }
        roots.iter().map(|v| image[v.index()]).collect()
    }

    /// For every node whether some root needs it.
    pub fn reachable(&self, roots: &[Value]) -> Vec<bool> {
        let mut needed = vec![false; self.nodes.len()];
        for root in roots {
            needed[root.index()] = true;
        }
        for i in (0..self.nodes.len()).rev() {
            if needed[i] {
                for operand in self.nodes[i].operands() {
                    needed[operand.index()] = true;
                }
            }
        }
        needed
    }
}

/// Short names for the nodes that derivations build most.
impl Graph {
    pub fn unary(&mut self, op: Op, a: Value) -> Value {
        self.push(op, &[a])
    }

    pub fn neg(&mut self, a: Value) -> Value {
        self.push(Op::Neg, &[a])
    }

    pub fn sqr(&mut self, a: Value) -> Value {
        self.push(Op::Sqr, &[a])
    }

    pub fn add(&mut self, a: Value, b: Value) -> Value {
        self.push(Op::Add, &[a, b])
    }

    pub fn sub(&mut self, a: Value, b: Value) -> Value {
        self.push(Op::Sub, &[a, b])
    }

    pub fn mul(&mut self, a: Value, b: Value) -> Value {
        self.push(Op::Mul, &[a, b])
    }

    pub fn div(&mut self, a: Value, b: Value) -> Value {
        self.push(Op::Div, &[a, b])
    }
}
