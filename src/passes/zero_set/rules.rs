//! Equations in one operation: what f(u) = 0 says of u.

use num_rational::BigRational;
use num_traits::One;
use num_traits::Zero;

use super::guard::Guard;
use super::guard::Sign;
use super::space::Space;
use super::sum::factors;
use crate::graph::Op;
use crate::graph::Value;
use crate::interval::Interval;

/// A field with guards: a part of the zero set of another field, wherever that one is defined.
#[derive(Debug, Clone, PartialEq)]
pub struct Alternative {
    pub field: Value,
    pub guards: Vec<Guard>,
}

impl Alternative {
    pub fn new(field: Value) -> Self {
        Self { field, guards: Vec::new() }
    }
}

/// Fields without guards.
pub fn all(fields: impl IntoIterator<Item = Value>) -> Option<Vec<Alternative>> {
    Some(fields.into_iter().map(Alternative::new).collect())
}

/// The zero set by the operation of the field; `None` if that says nothing, an empty list if there is none.
pub fn operation(space: &mut Space, field: Value) -> Option<Vec<Alternative>> {
    if let Some(number) = space.number(field) {
        // A field that is 0 everywhere stays.
        return if number.is_zero() { None } else { all([]) };
    }
    if space.never_zero(field) {
        return all([]);
    }
    let (op, operands) = space.taken(field);
    let one = BigRational::one;
    match (op, &operands[..]) {
        (Op::Neg | Op::Abs | Op::Sqr | Op::Sqrt | Op::Cbrt | Op::PowInt(1..) | Op::PowRatio(1.., _), &[u]) => all([u]),
        (
            Op::Sign | Op::Expm1 | Op::Log1p | Op::Asin | Op::Atan | Op::Sinh | Op::Tanh | Op::Asinh | Op::Atanh,
            &[u],
        ) => all([u]),
        (Op::PowInt(_) | Op::PowRatio(..) | Op::Exp | Op::Exp2 | Op::Exp10 | Op::Cosh, _) => all([]),
        (Op::Ln | Op::Log2 | Op::Log10 | Op::Acosh | Op::Acos, &[u]) => all([space.plus(u, &-one())]),
        (Op::Tan, &[u]) => all([space.unary(Op::Sin, u)]),
        (Op::Sin, &[u]) if Interval::PI.lo() > space.enclosure(u).mag() => all([u]),
        (Op::Mul, _) => {
            let factors = factors(space, field);
            // A power whose exponent does not fit is a factor of its own.
            if factors.contains_key(&field) { None } else { all(factors.into_keys()) }
        }
        (Op::Div, &[n, _]) => all([n]),
        (Op::Hypot, &[u, v]) => {
            let squares = [u, v].map(|u| space.unary(Op::Sqr, u));
            all([space.push(Op::Add, &squares)])
        }
        // x^y is 0 for x = 0 and y > 0 alone.
        (Op::Pow, &[u, v]) => Some(vec![Alternative { field: u, guards: vec![Guard::Sign(Sign::Positive, v)] }]),
        (Op::Atan2, &[u, v]) => Some(vec![Alternative { field: u, guards: vec![Guard::Sign(Sign::Positive, v)] }]),
        _ => None,
    }
}

/// min(a, b) = 0 as a = 0 where b >= 0 and b = 0 where a >= 0, and max(a, b) = 0 likewise.
pub fn extremum(space: &mut Space, field: Value) -> Option<Vec<Alternative>> {
    let (op, operands) = space.taken(field);
    let (Op::Min | Op::Max, &[u, v]) = (op, &operands[..]) else { return None };
    let mut part = |field: Value, other: Value| {
        let signed = if op == Op::Min { other } else { space.unary(Op::Neg, other) };
        Alternative { field, guards: vec![Guard::Sign(Sign::NonNegative, signed)] }
    };
    Some(vec![part(u, v), part(v, u)])
}
