//! What every graph goes through before anything is derived from it. The list is [`PIPELINE`]; it runs in rounds until a
//! whole round changes nothing. Each pass builds a new graph that has the same inputs and outputs by name and encloses
//! the same values: it may tighten, it never loses a point and never forgets where a value is undefined.

mod algebra;
mod bounds;
mod builder;
mod exact;
mod fold;
pub mod zero_set;

use std::fmt;

use crate::graph::Graph;
use crate::graph::Node;
use crate::graph::Op;
use crate::graph::Value;
use crate::graph::verify;
use crate::interval::Interval;
use crate::limits::Budget;
use crate::limits::Exceeded;
use crate::limits::Limits;

pub use bounds::bounds;
use builder::Builder;
pub use exact::{MAX_BITS, exact};

/// What becomes of an operation on given values of the new graph: another value of it, or `None` to leave it as it is.
type Rewrite = fn(&mut Builder, Op, &[Value]) -> Option<Value>;

/// One pass, as what it does to each operation whose operands are rewritten already.
#[derive(Clone, Copy)]
pub struct Pass {
    pub name: &'static str,
    rewrite: Rewrite,
}

/// The passes in their order. Each of them leaves equal values as one node, symmetric operations with the operand of
/// smaller index first, and nothing that no output needs but the inputs.
pub const PIPELINE: &[Pass] = &[
    // That alone: common subexpressions and dead values.
    Pass { name: "cse", rewrite: |_, _, _| None },
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
    let budget = Budget::new(&Limits::unlimited());
    run_within(graph, inputs, &budget).unwrap_or_else(|_| unreachable!("there is no limit"))
}

/// The same within limits: of time, and of the nodes that rows may add.
///
/// # Errors
/// Which limit was exceeded.
///
/// # Panics
/// As [`run`].
pub fn run_within(graph: &Graph, inputs: &[Interval], budget: &Budget) -> Result<(Graph, Vec<Report>), Exceeded> {
    let mut graph = graph.clone();
    let mut reports = Vec::new();
    for _ in 0..MAX_ROUNDS {
        let mut unchanged = true;
        for pass in PIPELINE {
            let after = rebuild(&graph, inputs, pass.rewrite, budget)?;
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
    Ok((graph, reports))
}

/// A new graph in which each operation that the outputs need is replaced as `rewrite` says.
fn rebuild(old: &Graph, inputs: &[Interval], rewrite: Rewrite, budget: &Budget) -> Result<Graph, Exceeded> {
    // The second sweep drops what the rows built on the way and orders operands by their final indices.
    let rewritten = sweep(old, inputs, budget, |builder, op, operands| settle(builder, op, operands, rewrite))?;
    sweep(&rewritten, inputs, budget, |builder, op, operands| match (op, operands) {
        (Op::Add | Op::Mul | Op::Min | Op::Max | Op::Hypot | Op::Equal, &[x, y]) if x > y => builder.push(op, &[y, x]),
        _ => builder.push(op, operands),
    })
}

/// Copies what the outputs need, each operation by `copy`, and all inputs.
fn sweep(
    old: &Graph,
    inputs: &[Interval],
    budget: &Budget,
    copy: impl Fn(&mut Builder, Op, &[Value]) -> Value,
) -> Result<Graph, Exceeded> {
    let mut builder = Builder::new(old.variables(), inputs);
    let roots: Vec<Value> = old.outputs().iter().map(|&(_, value)| value).collect();
    let needed = old.reachable(&roots);
    let mut image = vec![Value(u32::MAX); old.len()];
    let mut operands = Vec::with_capacity(3);
    for (value, node) in old.iter().filter(|(value, _)| needed[value.index()]) {
        budget.tick()?;
        budget.nodes(builder.graph().len())?;
        operands.clear();
        operands.extend(node.operands().iter().map(|v| image[v.index()]));
        image[value.index()] = match (node.op, old.as_constant(value)) {
            (_, Some(number)) => builder.constant(number.clone()),
            (Op::Var(id), None) => builder.input(&old.variables()[id as usize]),
            (op, None) => copy(&mut builder, op, &operands),
        };
    }
    Ok(builder.finish(old.outputs().iter().map(|(name, value)| (name.clone(), image[value.index()]))))
}

/// Rewrites an operation until no row fits.
fn settle(builder: &mut Builder, mut op: Op, operands: &[Value], rewrite: Rewrite) -> Value {
    let mut operands = operands.to_vec();
    for _ in 0..MAX_STEPS {
        let Some(value) = rewrite(builder, op, &operands) else { break };
        let node = builder.graph().node(value);
        if node.operands().is_empty() {
            return value;
        }
        (op, operands) = (node.op, node.operands().to_vec());
    }
    builder.push(op, &operands)
}

/// Whether two graphs have the same text.
fn same(a: &Graph, b: &Graph) -> bool {
    let same_node = |(value, node): (Value, &Node)| match (a.as_constant(value), b.as_constant(value)) {
        (Some(x), Some(y)) => x == y,
        _ => node == b.node(value),
    };
    a.len() == b.len() && a.variables() == b.variables() && a.outputs() == b.outputs() && a.iter().all(same_node)
}

/// A heading that names the pass, then the graph, or `(unchanged)` on the line of the heading.
impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.changed {
            Some(graph) => write!(f, "# {}\n{graph}", self.pass),
            None => writeln!(f, "# {} (unchanged)", self.pass),
        }
    }
}
