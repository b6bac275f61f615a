//! What every graph goes through before anything is derived from it. The list is [`PIPELINE`]; it runs in rounds until a
//! whole round changes nothing. Each pass builds a new graph that has the same inputs and outputs by name and encloses
//! the same values: it may tighten, it never loses a point and never forgets where a value is undefined.

mod algebra;
mod bounds;
mod builder;
mod exact;
mod fold;

use crate::graph::Graph;
use crate::graph::Node;
use crate::graph::Op;
use crate::graph::Value;
use crate::graph::verify;
use crate::interval::Interval;

pub use bounds::bounds;
use builder::Builder;
pub use exact::{MAX_BITS, exact};

/// One pass: what becomes of each operation whose operands are rewritten already.
#[derive(Clone, Copy)]
pub struct Pass {
    pub name: &'static str,
    /// The value that replaces an operation on given values of the new graph; `None` leaves it as it is.
    rewrite: fn(&mut Builder, Op, &[Value]) -> Option<Value>,
}

/// The passes in their order.
pub const PIPELINE: &[Pass] = &[
    // Drops what no output needs. Inputs stay.
    Pass { name: "dce", rewrite: |_, _, _| None },
    // Operands of symmetric operations by their index, so that equal values become one node.
    Pass { name: "cse", rewrite: order },
    // Numbers, exactly.
    Pass { name: "fold", rewrite: fold::rewrite },
    // Rewrite rows with their side conditions, by bounds and signs over the domain.
    Pass { name: "algebra", rewrite: algebra::rewrite },
];

/// No formula seen needs more than five rounds; the cap is for those that nobody has seen.
const MAX_ROUNDS: usize = 12;

/// Rows that may follow one another at one operation within a pass.
const MAX_STEPS: usize = 8;

/// What one run of one pass did.
#[derive(Debug, Clone)]
pub struct Report {
    pub pass: &'static str,
    /// The graph after the pass; `None` if it is unchanged.
    pub changed: Option<Graph>,
}

/// Runs [`PIPELINE`] in rounds until one changes nothing. `inputs` bounds each input, in the order of
/// [`Graph::variables`]: the result encloses the same values as `graph` on boxes inside, and nothing is said outside.
///
/// # Panics
/// If the number of bounds is not the number of variables; in debug builds if a pass breaks an invariant of the graph.
pub fn run(graph: &Graph, inputs: &[Interval]) -> (Graph, Vec<Report>) {
    let mut graph = graph.clone();
    let mut reports = Vec::new();
    for _ in 0..MAX_ROUNDS {
        let mut unchanged = true;
        for pass in PIPELINE {
            let after = rebuild(&graph, inputs, pass.rewrite);
            debug_assert_eq!(verify(&after), Ok(()), "after {}:\n{after}", pass.name);
            let changed = !same(&graph, &after);
            unchanged &= !changed;
            reports.push(Report { pass: pass.name, changed: changed.then(|| after.clone()) });
            graph = after;
        }
        if unchanged {
            break;
        }
    }
    (graph, reports)
}

/// A new graph of what the outputs need, with each operation replaced as `rewrite` says.
fn rebuild(old: &Graph, inputs: &[Interval], rewrite: fn(&mut Builder, Op, &[Value]) -> Option<Value>) -> Graph {
    let mut builder = Builder::new(old.variables(), inputs);
    let roots: Vec<Value> = old.outputs().iter().map(|&(_, value)| value).collect();
    let needed = old.reachable(&roots);
    let mut image = vec![Value(u32::MAX); old.len()];
    for (value, node) in old.iter().filter(|(value, _)| needed[value.index()]) {
        image[value.index()] = match (node.op, old.as_constant(value)) {
            (_, Some(number)) => builder.constant(number.clone()),
            (Op::Var(id), _) => builder.input(&old.variables()[id as usize]),
            (op, None) => {
                let operands: Vec<Value> = node.operands().iter().map(|v| image[v.index()]).collect();
                rewritten(&mut builder, op, operands, rewrite)
            }
        };
    }
    builder.finish(old.outputs().iter().map(|(name, value)| (name.clone(), image[value.index()])))
}

/// Applies rows to an operation until none fits.
fn rewritten(
    builder: &mut Builder,
    mut op: Op,
    mut operands: Vec<Value>,
    rewrite: fn(&mut Builder, Op, &[Value]) -> Option<Value>,
) -> Value {
    for _ in 0..MAX_STEPS {
        let Some(value) = rewrite(builder, op, &operands) else { break };
        let node: &Node = builder.graph().node(value);
        if node.operands().is_empty() {
            return value;
        }
        (op, operands) = (node.op, node.operands().to_vec());
    }
    builder.push(op, &operands)
}

/// x op y -> y op x  // for symmetric operations, the operand of smaller index first
fn order(builder: &mut Builder, op: Op, operands: &[Value]) -> Option<Value> {
    match (op, operands) {
        (Op::Add | Op::Mul | Op::Min | Op::Max | Op::Hypot | Op::Equal, &[x, y]) if x > y => {
            Some(builder.push(op, &[y, x]))
        }
        _ => None,
    }
}

/// Whether two graphs have the same text.
fn same(a: &Graph, b: &Graph) -> bool {
    let same_node = |(value, node): (Value, &Node)| match (a.as_constant(value), b.as_constant(value)) {
        (Some(x), Some(y)) => x == y,
        _ => node == b.node(value),
    };
    a.len() == b.len() && a.variables() == b.variables() && a.outputs() == b.outputs() && a.iter().all(same_node)
}
