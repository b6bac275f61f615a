//! Enclosures of graph values over boxes by the natural interval extension: constants of the scene, and the search for a
//! default domain.

use crate::graph;
use crate::graph::Graph;
use crate::graph::Op;
use crate::graph::Value;
use crate::interval::Decorated;
use crate::interval::Interval;

use super::scene::COORDINATES;

/// So few values are looked for without a table of the graph's size.
const FEW: usize = 32;

/// The part of a graph that some values need, laid out for repeated evaluation.
#[derive(Debug)]
pub(super) struct Enclosures<'g> {
    graph: &'g Graph,
    steps: Vec<Step>,
    /// Names of the inputs that occur, in the order of their steps.
    inputs: Vec<String>,
    roots: Vec<usize>,
    results: Vec<Decorated>,
}

#[derive(Debug)]
enum Step {
    Constant(Decorated),
    /// Index into the inputs.
    Input(usize),
    /// A node with the indices of earlier steps.
    Apply(Value, [usize; 3]),
}

impl<'g> Enclosures<'g> {
    pub fn new(graph: &'g Graph, roots: &[Value]) -> Self {
        let order = needed(graph, roots);
        // Of a few values in a large graph there is no table of the graph's size: files may have very many constants.
        let mut table = Vec::new();
        if order.len() > FEW {
            table.resize(order.last().map_or(0, |last| last.index() + 1), 0);
            order.iter().enumerate().for_each(|(i, value)| table[value.index()] = i);
        }
        let place = |value: &Value| match table.get(value.index()) {
            Some(&place) => place,
            None => order.binary_search(value).unwrap_or(0),
        };
        let mut inputs = Vec::new();
        let step = |&value: &Value| {
            let node = graph.node(value);
            match node.op {
                Op::Const(_) => Step::Constant(graph::apply(graph, node, &[])),
                Op::Var(id) => {
                    inputs.push(graph.variables()[id as usize].clone());
                    Step::Input(inputs.len() - 1)
                }
                _ => {
                    let mut operands = [0; 3];
                    for (operand, needed) in operands.iter_mut().zip(node.operands()) {
                        *operand = place(needed);
                    }
                    Step::Apply(value, operands)
                }
            }
        };
        let steps: Vec<Step> = order.iter().map(step).collect();
        let roots = roots.iter().map(place).collect();
        Self { graph, steps, inputs, roots, results: Vec::new() }
    }

    /// The number of operations that one evaluation takes.
    pub fn cost(&self) -> usize {
        self.steps.len()
    }

    /// The inputs that occur; [`Enclosures::evaluate`] takes their ranges in this order.
    pub fn inputs(&self) -> &[String] {
        &self.inputs
    }

    /// Encloses everything for inputs in these ranges. Read the results with [`Enclosures::root`].
    pub fn evaluate(&mut self, inputs: &[Interval]) {
        self.results.clear();
        for step in &self.steps {
            let result = match step {
                Step::Constant(number) => *number,
                Step::Input(index) => Decorated::new(inputs[*index]),
                Step::Apply(value, operands) => {
                    let node = self.graph.node(*value);
                    let mut given = [Decorated::ILL; 3];
                    let count = node.operands().len();
                    for (place, &operand) in given.iter_mut().zip(&operands[..count]) {
                        *place = self.results[operand];
                    }
                    graph::apply(self.graph, node, &given[..count])
                }
            };
            self.results.push(result);
        }
    }

    /// The enclosure of the root of that number after an evaluation.
    pub fn root(&self, index: usize) -> Interval {
        self.results[self.roots[index]].interval()
    }
}

/// What `roots` need, operands before users.
pub(super) fn needed(graph: &Graph, roots: &[Value]) -> Vec<Value> {
    if let Some(few) = few_needed(graph, roots) {
        return few;
    }
    let mut seen = vec![false; roots.iter().map(|root| root.index() + 1).max().unwrap_or(0)];
    let mut stack = roots.to_vec();
    let mut order = Vec::new();
    while let Some(value) = stack.pop() {
        if !std::mem::replace(&mut seen[value.index()], true) {
            order.push(value);
            stack.extend(graph.node(value).operands());
        }
    }
    // Operands have smaller indices than their users.
    order.sort_unstable();
    order
}

/// The same if they are at most [`FEW`], at no cost that grows with the graph.
fn few_needed(graph: &Graph, roots: &[Value]) -> Option<Vec<Value>> {
    let mut stack = roots.to_vec();
    let mut order: Vec<Value> = Vec::new();
    while let Some(value) = stack.pop() {
        if !order.contains(&value) {
            if order.len() == FEW {
                return None;
            }
            order.push(value);
            stack.extend(graph.node(value).operands());
        }
    }
    order.sort_unstable();
    Some(order)
}

/// Which coordinates values depend on, for any number of them in one walk over a graph that only grows.
#[derive(Debug, Default)]
pub(super) struct Dependence {
    known: Vec<[bool; 3]>,
}

impl Dependence {
    /// Whether any of the roots depends on each of the coordinates.
    pub fn of(&mut self, graph: &Graph, roots: &[Value]) -> [bool; 3] {
        let last = roots.iter().map(|root| root.index() + 1).max().unwrap_or(0);
        for index in self.known.len()..last {
            let node = graph.node(Value(index as u32));
            let own = match node.op {
                Op::Var(id) => COORDINATES.map(|coordinate| graph.variables()[id as usize] == coordinate),
                _ => self.any(node.operands()),
            };
            self.known.push(own);
        }
        self.any(roots)
    }

    fn any(&self, values: &[Value]) -> [bool; 3] {
        let known = |value: &Value| self.known[value.index()];
        values.iter().map(known).fold([false; 3], |a, b| [0, 1, 2].map(|i| a[i] || b[i]))
    }
}

/// The names of the inputs that a value depends on.
pub(super) fn inputs_of(graph: &Graph, roots: &[Value]) -> Vec<String> {
    let name = |value: Value| match graph.node(value).op {
        Op::Var(id) => Some(graph.variables()[id as usize].clone()),
        _ => None,
    };
    needed(graph, roots).into_iter().filter_map(name).collect()
}
