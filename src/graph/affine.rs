//! What one operation does to affine forms.

use super::Op;
use crate::interval::Coefficients;
use crate::interval::Form;
use crate::interval::Interval;

/// The form of one operation on operands with the given forms and enclosures; `value` encloses the result.
///
/// Operations without a case of their own go through `value`, which is sound for every operation: the result shares no
/// symbol with anything. With [`Op::affine`] it is those called `ThroughInterval`.
pub fn apply_affine<C: Coefficients>(op: Op, operands: &[(Form<C>, Interval)], value: Interval) -> Form<C> {
    match (op, operands) {
        (Op::Neg, [(x, _)]) => -x.clone(),
        (Op::Sqr, [(x, _)]) => x.sqr(),
        (Op::PowInt(n @ 1..), [(x, _)]) => power(x, n.unsigned_abs()),
        (Op::Add, [(x, _), (y, _)]) => x.clone() + y.clone(),
        (Op::Sub, [(x, _), (y, _)]) => x.clone() - y.clone(),
        // A factor of which one number or a rounding of it is known scales; the product would count its width twice.
        (Op::Mul, [(_, c), (y, _)]) if c.hi() <= c.lo().next_up() => y.scale(*c),
        (Op::Mul, [(x, _), (_, c)]) if c.hi() <= c.lo().next_up() => x.scale(*c),
        (Op::Mul, [(x, _), (y, _)]) => x.clone() * y.clone(),
        _ => Form::constant(value),
    }
}

/// `x^n` for n >= 1, by squarings from the highest bit of n.
fn power<C: Coefficients>(x: &Form<C>, n: u32) -> Form<C> {
    let below_highest = n.ilog2();
    (0..below_highest).rev().fold(x.clone(), |power, bit| {
        let square = power.sqr();
        if n >> bit & 1 == 1 { square * x.clone() } else { square }
    })
}
