//! Bounds of every node over the domain: the natural extension, evaluated once on the whole of it.

use crate::graph::Graph;
use crate::graph::Op;
use crate::graph::Value;
use crate::graph::apply;
use crate::interval::Decorated;
use crate::interval::Interval;

/// Encloses every node over the domain. `inputs` bounds each input, in the order of [`Graph::variables`]; each value of
/// `known` is intersected with its interval where it is computed, which restricts the domain to the points where it lies
/// there. The decoration tells whether the value is proved to be defined (and continuous) on all of the domain; it
/// answers for totality, signs and overflow alike.
///
/// # Panics
/// If the number of bounds is not the number of variables.
pub fn bounds(graph: &Graph, inputs: &[Interval], known: &[(Value, Interval)]) -> Vec<Decorated> {
    assert_eq!(graph.variables().len(), inputs.len(), "one interval for each input");
    let mut bounds: Vec<Decorated> = Vec::with_capacity(graph.len());
    for (value, node) in graph.iter() {
        let operands: Vec<Decorated> = node.operands().iter().map(|v| bounds[v.index()]).collect();
        let mut bound = match node.op {
            Op::Var(id) => Decorated::new(inputs[id as usize]),
            _ => apply(graph, node, &operands),
        };
        for (_, interval) in known.iter().filter(|(v, _)| *v == value) {
            bound = Decorated::with(bound.interval().intersect(*interval), bound.decoration());
        }
        bounds.push(bound);
    }
    bounds
}
