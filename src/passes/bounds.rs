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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::parse;
    use crate::interval::Decoration;

    #[test]
    fn what_is_known_of_a_value_reaches_its_users() {
        let graph = parse("v0 = var x\nv1 = var y\nv2 = add v0, v1\nv3 = ln v2\nout f = v3").unwrap();
        let interval = |lo, hi| Interval::new(lo, hi).unwrap();
        let inputs = [interval(-1.0, 2.0), interval(0.0, 1.0)];
        let free = bounds(&graph, &inputs, &[]);
        assert_eq!(free[2], Decorated::new(interval(-1.0, 3.0)));
        assert_eq!(free[3].decoration(), Decoration::Trv);
        let known = [(Value(0), interval(0.5, 9.0)), (Value(2), interval(1.0, 9.0))];
        let restricted = bounds(&graph, &inputs, &known);
        assert_eq!(restricted[2], Decorated::new(interval(1.0, 3.0)));
        assert_eq!((restricted[3].interval().lo(), restricted[3].decoration()), (0.0, Decoration::Com));
    }

    #[test]
    fn overflow_shows_as_an_infinite_bound() {
        let graph = parse("v0 = var x\nv1 = exp v0\nv2 = exp v1\nout f = v2").unwrap();
        let bounds = bounds(&graph, &[Interval::new(0.0, 10.0).unwrap()], &[]);
        assert!(bounds[1].interval().is_bounded() && !bounds[2].interval().is_bounded());
    }
}
