//! Poles refuted: the numerator of a formula over a common denominator.
//!
//! Near a pole the enclosure of a field is unbounded and refutes nothing, but the zeros of N / D are zeros of N, and N
//! is bounded there. A box on which N has no zero holds no zero of the field.

use std::collections::HashMap;

use crate::graph::Graph;
use crate::graph::Node;
use crate::graph::Op;
use crate::graph::Value;

/// A graph in which numerators are built.
pub trait Build {
    /// The node of a value.
    fn node(&self, value: Value) -> Node;
    /// The operation, simplified or not.
    fn build(&mut self, op: Op, operands: &[Value]) -> Value;
    /// A whole number.
    fn whole(&mut self, number: i64) -> Value;
    /// What a value needs, itself included, operands before users.
    fn cone(&self, value: Value) -> Vec<Value>;
}

/// As written.
impl Build for Graph {
    fn node(&self, value: Value) -> Node {
        *Graph::node(self, value)
    }

    fn build(&mut self, op: Op, operands: &[Value]) -> Value {
        self.push(op, operands)
    }

    fn whole(&mut self, number: i64) -> Value {
        self.int(number)
    }

    fn cone(&self, value: Value) -> Vec<Value> {
        let needed = self.reachable(&[value]);
        (0..=value.0).map(Value).filter(|v| needed[v.index()]).collect()
    }
}

/// A value as n / d; d is 1 if there is none. Wherever the value is defined, so are n and d, and d is not 0.
#[derive(Debug, Clone, Copy)]
pub struct Fraction {
    pub n: Value,
    pub d: Option<Value>,
}

/// The numerator of `f` over a common denominator of its sums, products, quotients, powers and tangents; `None` if
/// nothing among them has a pole. Other operations are taken as they are, quotients inside included.
pub fn numerator(graph: &mut Graph, f: Value) -> Option<Value> {
    let Fraction { n, d } = fraction(graph, f);
    d.map(|_| n)
}

/// `f` over that denominator.
pub fn fraction<B: Build>(graph: &mut B, f: Value) -> Fraction {
    let mut fractions: HashMap<Value, Fraction> = HashMap::new();
    for value in graph.cone(f) {
        let node = graph.node(value);
        let operands: Vec<Fraction> = node.operands().iter().map(|v| fractions[v]).collect();
        let quotient = match node.op {
            Op::Div => !matches!(graph.node(node.operands()[1]).op, Op::Const(_)),
            Op::PowInt(n) => n < 0,
            Op::PowRatio(p, _) => p < 0,
            Op::Tan => true,
            _ => false,
        };
        let combined = if quotient || operands.iter().any(|operand| operand.d.is_some()) {
            combine(graph, node.op, &operands)
        } else {
            None
        };
        fractions.insert(value, combined.unwrap_or(Fraction { n: value, d: None }));
    }
    fractions[&f]
}

/// The product of two denominators.
fn product<B: Build>(graph: &mut B, a: Option<Value>, b: Option<Value>) -> Option<Value> {
    match (a, b) {
        (Some(a), Some(b)) => Some(graph.build(Op::Mul, &[a, b])),
        (one, other) => one.or(other),
    }
}

/// a times d, if d is there.
fn scaled<B: Build>(graph: &mut B, a: Value, d: Option<Value>) -> Value {
    d.map_or(a, |d| graph.build(Op::Mul, &[a, d]))
}

/// The operation on fractions; `None` if it has no such form.
fn combine<B: Build>(graph: &mut B, op: Op, operands: &[Fraction]) -> Option<Fraction> {
    Some(match (op, operands) {
        (Op::Neg, &[a]) => Fraction { n: graph.build(Op::Neg, &[a.n]), d: a.d },
        (Op::Sqr, &[a]) => Fraction { n: graph.build(Op::Sqr, &[a.n]), d: a.d.map(|d| graph.build(Op::Sqr, &[d])) },
        (Op::Add | Op::Sub, &[a, b]) => {
            let same = a.d == b.d;
            let left = if same { a.n } else { scaled(graph, a.n, b.d) };
            let right = if same { b.n } else { scaled(graph, b.n, a.d) };
            let d = if same { a.d } else { product(graph, a.d, b.d) };
            Fraction { n: graph.build(op, &[left, right]), d }
        }
        (Op::Mul, &[a, b]) => Fraction { n: graph.build(Op::Mul, &[a.n, b.n]), d: product(graph, a.d, b.d) },
        (Op::Div, &[a, b]) => {
            let n = scaled(graph, a.n, b.d);
            Fraction { n, d: product(graph, a.d, Some(b.n)) }
        }
        (Op::PowInt(power), &[a]) => {
            let exponent = power.checked_abs()?;
            let n = graph.build(Op::PowInt(exponent), &[a.n]);
            let one = graph.whole(1);
            let d = a.d.map(|d| graph.build(Op::PowInt(exponent), &[d]));
            if power < 0 { Fraction { n: d.unwrap_or(one), d: Some(n) } } else { Fraction { n, d } }
        }
        (Op::PowRatio(power, root), &[Fraction { n, d: None }]) if power < 0 => {
            let d = graph.build(Op::PowRatio(power.checked_neg()?, root), &[n]);
            Fraction { n: graph.whole(1), d: Some(d) }
        }
        (Op::Tan, &[Fraction { n, d: None }]) => {
            Fraction { n: graph.build(Op::Sin, &[n]), d: Some(graph.build(Op::Cos, &[n])) }
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
