//! Powers: which operation `base ^ exponent` is, decided by the exact value of the exponent.
//!
//! `x^(1/3)` and `x^0.1` are rational powers, exactly; only an exponent that is no rational constant becomes the general
//! power, whose domain is narrower.

use std::collections::HashMap;

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::One;
use num_traits::Pow;
use num_traits::Signed;
use num_traits::ToPrimitive;
use num_traits::Zero;

use crate::graph::Graph;
use crate::graph::Op;
use crate::graph::Value;

/// Largest numerator and denominator of an exact exponent.
const MAX_EXPONENT: u32 = 10_000;

/// Constants with more bits than this (numerator and denominator together) are not followed: no exponent needs them, and
/// their cost would be the user's to choose.
const MAX_BITS: u64 = 4096;

/// The exact rational values of constant parts of a graph, remembered by node.
#[derive(Debug, Default)]
pub(super) struct Exact {
    known: HashMap<Value, Option<BigRational>>,
}

impl Exact {
    /// The value of a node that is built from rational constants by `+ - * /`, squares and integer powers. `None` if it
    /// is not, if it divides by zero, or if its numbers grow past [`MAX_BITS`].
    pub fn rational(&mut self, graph: &Graph, value: Value) -> Option<BigRational> {
        let mut stack = vec![value];
        while let Some(&top) = stack.last() {
            if self.known.contains_key(&top) {
                stack.pop();
                continue;
            }
            let node = graph.node(top);
            let operands = node.operands();
            let result = if !is_followed(node.op) || operands.iter().any(|v| matches!(self.known.get(v), Some(None))) {
                None
            } else if let Some(&unknown) = operands.iter().find(|v| !self.known.contains_key(v)) {
                stack.push(unknown);
                continue;
            } else if let Some(constant) = graph.as_constant(top) {
                Some(constant.clone())
            } else {
                let numbers: Vec<&BigRational> = operands.iter().filter_map(|v| self.known[v].as_ref()).collect();
                fold(node.op, &numbers)
            };
            self.known.insert(top, result.filter(|number| bits(number) <= MAX_BITS));
            stack.pop();
        }
        self.known[&value].clone()
    }
}

fn bits(number: &BigRational) -> u64 {
    number.numer().bits() + number.denom().bits()
}

/// Operations that keep rational numbers rational.
fn is_followed(op: Op) -> bool {
    matches!(op, Op::Const(_) | Op::Neg | Op::Sqr | Op::PowInt(_) | Op::Add | Op::Sub | Op::Mul | Op::Div)
}

fn fold(op: Op, a: &[&BigRational]) -> Option<BigRational> {
    match op {
        Op::Neg => Some(-a[0]),
        Op::Sqr => Some(a[0] * a[0]),
        Op::PowInt(n) => {
            let small = bits(a[0]).saturating_mul(n.unsigned_abs().into()) <= MAX_BITS || a[0].abs().is_one();
            (small && !(n < 0 && a[0].is_zero())).then(|| Pow::pow(a[0], n))
        }
        Op::Add => Some(a[0] + a[1]),
        Op::Sub => Some(a[0] - a[1]),
        Op::Mul => Some(a[0] * a[1]),
        Op::Div => (!a[1].is_zero()).then(|| a[0] / a[1]),
        _ => None,
    }
}

/// Why a power cannot be formed.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum PowerError {
    /// An integer, or a fraction with odd denominator, that is too large to be exact.
    TooLarge(BigRational),
}

/// Adds `base ^ exponent`.
///
/// - exponent p/q in lowest terms: the exact operation, if |p| and q are at most 10000. A larger even q means the same as
///   the general power, which then stands for it; anything else that large is an error;
/// - base e, 2 or 10: the exponential, which is the same function;
/// - else the general power on base > 0 (IEEE 1788-2015, table 9.1).
pub(super) fn power(graph: &mut Graph, exact: &mut Exact, base: Value, exponent: Value) -> Result<Value, PowerError> {
    if is_e(graph, base) {
        return Ok(graph.unary(Op::Exp, exponent));
    }
    if let Some(number) = exact.rational(graph, exponent) {
        let limit = BigInt::from(MAX_EXPONENT);
        if number.numer().abs() <= limit && *number.denom() <= limit {
            // Both fit by the comparison above.
            let (p, q) = (number.numer().to_i32().unwrap_or(0), number.denom().to_u32().unwrap_or(1));
            return Ok(match (p, q) {
                (1, 1) => base,
                (2, 1) => graph.sqr(base),
                (n, 1) => graph.unary(Op::PowInt(n), base),
                (1, 2) => graph.unary(Op::Sqrt, base),
                (1, 3) => graph.unary(Op::Cbrt, base),
                (p, q) => graph.unary(Op::PowRatio(p, q), base),
            });
        }
        if number.denom().bit(0) {
            return Err(PowerError::TooLarge(number));
        }
    } else if graph.as_constant(base) == Some(&BigRational::from_integer(2.into())) {
        return Ok(graph.unary(Op::Exp2, exponent));
    } else if graph.as_constant(base) == Some(&BigRational::from_integer(10.into())) {
        return Ok(graph.unary(Op::Exp10, exponent));
    }
    Ok(graph.push(Op::Pow, &[base, exponent]))
}

fn is_e(graph: &Graph, value: Value) -> bool {
    let node = graph.node(value);
    node.op == Op::Exp && graph.is_one(node.operands()[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The textual form of `x ^ (p/q)`, or the error.
    fn power_text(p: i64, q: i64) -> String {
        let mut graph = Graph::new();
        let x = graph.var("x");
        let exponent = graph.constant(BigRational::new(p.into(), q.into()));
        match power(&mut graph, &mut Exact::default(), x, exponent) {
            Ok(value) => graph.node_text(graph.node(value)),
            Err(PowerError::TooLarge(number)) => format!("{number} too large"),
        }
    }

    #[test]
    fn the_exponent_decides_the_operation() {
        let table = [
            (0, 1, "powi v0, 0"),
            (1, 1, "var x"),
            (2, 1, "sqr v0"),
            (-1, 1, "powi v0, -1"),
            (10_000, 1, "powi v0, 10000"),
            (10_001, 1, "10001 too large"),
            (1, 2, "sqrt v0"),
            (2, 4, "sqrt v0"),
            (1, 3, "cbrt v0"),
            (1, 10, "powr v0, 1/10"),
            (-2, 3, "powr v0, -2/3"),
            (4, 2, "sqr v0"),
            // 0.33333: the denominator is even, so that the general power is the same function.
            (33_333, 100_000, "pow v0, v1"),
            (1, 10_001, "1/10001 too large"),
        ];
        for (p, q, expected) in table {
            assert_eq!(power_text(p, q), expected, "x^({p}/{q})");
        }
    }

    #[test]
    fn exponents_are_folded_exactly() {
        let mut graph = Graph::new();
        let [one, three, ten] = [1, 3, 10].map(|n| graph.int(n));
        let third = graph.div(one, three);
        let tenth = graph.div(one, ten);
        let sum = graph.add(third, tenth);
        let negative = graph.neg(sum);
        let mut exact = Exact::default();
        assert_eq!(exact.rational(&graph, negative), Some(BigRational::new((-13).into(), 30.into())));
        let zero = graph.sub(one, one);
        let undefined = graph.div(one, zero);
        assert_eq!(exact.rational(&graph, undefined), None);
        let x = graph.var("x");
        let open = graph.add(x, undefined);
        assert_eq!(exact.rational(&graph, open), None);
    }

    #[test]
    fn towers_and_long_sums_cost_little() {
        let mut graph = Graph::new();
        let mut exact = Exact::default();
        let mut tower = graph.int(3);
        for _ in 0..100 {
            tower = graph.unary(Op::PowInt(9999), tower);
        }
        assert_eq!(exact.rational(&graph, tower), None);
        let mut sum = graph.int(0);
        let one = graph.int(1);
        for _ in 0..200_000 {
            sum = graph.add(sum, one);
        }
        assert_eq!(exact.rational(&graph, sum), Some(BigRational::from_integer(200_000.into())));
    }
}
