//! A function of one unknown with its slope, and what else is 0 with it.

use crate::derive;
use crate::graph::Graph;
use crate::graph::Op;
use crate::graph::Value;
use crate::limits::Budget;
use crate::limits::Exceeded;

/// What every search for the same function shares.
#[derive(Debug)]
pub struct Problem {
    pub graph: Graph,
    pub f: Value,
    pub slope: Value,
    /// Values that are 0 wherever the function is.
    pub factors: Vec<Value>,
    /// The place of the unknown among the graph's variables.
    pub variable: usize,
}

impl Problem {
    /// Zeros in the variable of that name, which need not occur.
    ///
    /// # Errors
    /// If its derivative exceeds the budget.
    pub fn new(graph: &Graph, f: Value, variable: &str, budget: &Budget) -> Result<Self, Exceeded> {
        let mut graph = graph.clone();
        let x = graph.var(variable);
        let slope = derive::derivative_within(&mut graph, f, x, budget)?;
        let factors = factors(&mut graph, f);
        let variable = graph.variables().iter().position(|name| name == variable).unwrap_or_default();
        Ok(Self { graph, f, slope, factors, variable })
    }

    /// Zeros in t on the line o + t d of the inputs named, at most three of them.
    ///
    /// # Errors
    /// As [`Problem::new`].
    pub fn along_ray(graph: &Graph, f: Value, coordinates: &[&str], budget: &Budget) -> Result<Self, Exceeded> {
        let ray = derive::along_line(graph, &[f], coordinates);
        Self::new(&ray.graph, ray.roots[0], derive::PARAMETER, budget)
    }
}

/// Values that are 0 wherever `root` is 0: of a quotient the dividend, of a power the base, and so on inward; a tangent
/// gives its sine. They have no poles where the root has one.
fn factors(graph: &mut Graph, root: Value) -> Vec<Value> {
    let mut found = Vec::new();
    let mut value = root;
    loop {
        let node = *graph.node(value);
        value = match node.op {
            Op::Div | Op::Neg | Op::Sqr | Op::Sqrt | Op::Cbrt | Op::Abs | Op::Asin | Op::Atan | Op::Sinh | Op::Tanh => {
                node.operands()[0]
            }
            Op::PowInt(n) if n > 0 => node.operands()[0],
            Op::PowRatio(p, _) if p > 0 => node.operands()[0],
            Op::Tan => {
                let sine = graph.push(Op::Sin, node.operands());
                found.push(sine);
                return found;
            }
            _ => return found,
        };
        found.push(value);
    }
}
