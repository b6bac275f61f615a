//! Poles refuted: the numerator of a formula over a common denominator.
//!
//! Near a pole the enclosure of a field is unbounded and refutes nothing, but the zeros of N / D are zeros of N, and N
//! is bounded there. A box on which N has no zero holds no zero of the field.

use crate::graph::Graph;
use crate::graph::Op;
use crate::graph::Value;

/// A value as n / d; d is 1 if there is none. Wherever the value is defined, so are n and d, and d is not 0.
#[derive(Debug, Clone, Copy)]
struct Fraction {
    n: Value,
    d: Option<Value>,
}

/// The numerator of `f` over a common denominator of its sums, products, quotients, powers and tangents; `None` if
/// nothing among them has a pole. Other operations are taken as they are, quotients inside included.
pub fn numerator(graph: &mut Graph, f: Value) -> Option<Value> {
    let needed = graph.reachable(&[f]);
    let mut fractions: Vec<Fraction> = (0..=f.0).map(|index| Fraction { n: Value(index), d: None }).collect();
    for index in 0..=f.index() {
        if !needed[index] {
            continue;
        }
        let node = *graph.node(Value(index as u32));
        let operands: Vec<Fraction> = node.operands().iter().map(|v| fractions[v.index()]).collect();
        let quotient = match node.op {
            Op::Div => graph.as_constant(node.operands()[1]).is_none(),
            Op::PowInt(n) => n < 0,
            Op::PowRatio(p, _) => p < 0,
            Op::Tan => true,
            _ => false,
        };
        if (quotient || operands.iter().any(|operand| operand.d.is_some()))
            && let Some(fraction) = combine(graph, node.op, &operands)
        {
            fractions[index] = fraction;
        }
    }
    let Fraction { n, d } = fractions[f.index()];
    d.map(|_| n)
}

/// The product of two denominators.
fn product(graph: &mut Graph, a: Option<Value>, b: Option<Value>) -> Option<Value> {
    match (a, b) {
        (Some(a), Some(b)) => Some(graph.mul(a, b)),
        (one, other) => one.or(other),
    }
}

/// a times d, if d is there.
fn scaled(graph: &mut Graph, a: Value, d: Option<Value>) -> Value {
    d.map_or(a, |d| graph.mul(a, d))
}

/// The operation on fractions; `None` if it has no such form.
fn combine(graph: &mut Graph, op: Op, operands: &[Fraction]) -> Option<Fraction> {
    Some(match (op, operands) {
        (Op::Neg, &[a]) => Fraction { n: graph.neg(a.n), d: a.d },
        (Op::Sqr, &[a]) => Fraction { n: graph.sqr(a.n), d: a.d.map(|d| graph.sqr(d)) },
        (Op::Add | Op::Sub, &[a, b]) => {
            let same = a.d == b.d;
            let left = if same { a.n } else { scaled(graph, a.n, b.d) };
            let right = if same { b.n } else { scaled(graph, b.n, a.d) };
            let d = if same { a.d } else { product(graph, a.d, b.d) };
            Fraction { n: graph.push(op, &[left, right]), d }
        }
        (Op::Mul, &[a, b]) => Fraction { n: graph.mul(a.n, b.n), d: product(graph, a.d, b.d) },
        (Op::Div, &[a, b]) => {
            let n = scaled(graph, a.n, b.d);
            Fraction { n, d: product(graph, a.d, Some(b.n)) }
        }
        (Op::PowInt(power), &[a]) => {
            let exponent = power.checked_abs()?;
            let n = graph.unary(Op::PowInt(exponent), a.n);
            let one = graph.int(1);
            let d = a.d.map(|d| graph.unary(Op::PowInt(exponent), d));
            if power < 0 { Fraction { n: d.unwrap_or(one), d: Some(n) } } else { Fraction { n, d } }
        }
        (Op::PowRatio(power, root), &[Fraction { n, d: None }]) if power < 0 => {
            let d = graph.unary(Op::PowRatio(power.checked_neg()?, root), n);
            Fraction { n: graph.int(1), d: Some(d) }
        }
        (Op::Tan, &[Fraction { n, d: None }]) => {
            Fraction { n: graph.unary(Op::Sin, n), d: Some(graph.unary(Op::Cos, n)) }
        }
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_of_quotients_have_a_numerator() {
        let mut graph = Graph::new();
        let (x, y) = (graph.var("x"), graph.var("y"));
        let one = graph.int(1);
        let inverse = graph.div(one, x);
        let f = graph.sub(y, inverse);
        // y - 1 / x = (y x - 1) / x
        let product = graph.mul(y, x);
        let expected = graph.sub(product, one);
        assert_eq!(numerator(&mut graph, f), Some(expected));
        // Constant denominators and quotients inside other functions are left alone.
        let three = graph.int(3);
        let third = graph.div(x, three);
        assert_eq!(numerator(&mut graph, third), None);
        let sine = graph.unary(Op::Sin, f);
        assert_eq!(numerator(&mut graph, sine), None);
    }

    #[test]
    fn powers_and_products_keep_one_denominator() {
        let mut graph = Graph::new();
        let (x, y) = (graph.var("x"), graph.var("y"));
        let inverse = graph.unary(Op::PowInt(-2), x);
        let square = graph.sqr(inverse);
        let sum = graph.add(square, inverse);
        let f = graph.mul(sum, y);
        // (x^-2)^2 + x^-2 = (x^2 + x^4) / (x^4 x^2), times y; the 1s are multiplied out by the passes.
        let n = numerator(&mut graph, f).expect("it has a pole");
        assert!(graph.reachable(&[n]).len() > n.index());
        let touched = graph.reachable(&[n]);
        assert!(graph.iter().all(|(v, node)| !touched[v.index()] || node.op != Op::PowInt(-2) && node.op != Op::Div));
    }
}
