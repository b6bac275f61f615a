//! Affine forms beside the enclosures: what the operations that have a form of their own do to it.

use crate::graph::Op;
use crate::interval::Affine;
use crate::interval::Interval;

/// A form in the noise symbols of [`Spec::symbols`](crate::derive::Spec::symbols), of which a program has at most three.
pub type Form = Affine<MAX_SYMBOLS>;

pub const MAX_SYMBOLS: usize = 3;

/// The form of one operation on operands with the given forms and enclosures; `value` encloses the result.
///
/// Operations without a case of their own go through `value`, which is sound for every operation: the result shares no
/// symbol with anything. With [`Op::affine`] it is those called `ThroughInterval`.
pub fn apply(op: Op, operands: &[(Form, Interval)], value: Interval) -> Form {
    match (op, operands) {
        (Op::Neg, &[(x, _)]) => -x,
        (Op::Sqr, &[(x, _)]) => x.sqr(),
        (Op::PowInt(n @ 1..), &[(x, _)]) => power(x, n.unsigned_abs()),
        (Op::Add, &[(x, _), (y, _)]) => x + y,
        (Op::Sub, &[(x, _), (y, _)]) => x - y,
        // A factor of which one number or a rounding of it is known scales; the product would count its width twice.
        (Op::Mul, &[(_, c), (y, _)]) if c.hi() <= c.lo().next_up() => y.scale(c),
        (Op::Mul, &[(x, _), (_, c)]) if c.hi() <= c.lo().next_up() => x.scale(c),
        (Op::Mul, &[(x, _), (y, _)]) => x * y,
        _ => Form::constant(value),
    }
}

/// `x^n` for n >= 1, by squarings from the highest bit of n.
fn power(x: Form, n: u32) -> Form {
    let below_highest = n.ilog2();
    (0..below_highest).rev().fold(x, |power, bit| {
        let square = power.sqr();
        if n >> bit & 1 == 1 { square * x } else { square }
    })
}
