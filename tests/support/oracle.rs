//! Values of operations to 256 bits, for the tests that hold kernels against higher precision.

use astro_float::BigFloat;
use astro_float::Consts;
use astro_float::RoundingMode;
use imp::graph::Op;

const P: usize = 256;
const RM: RoundingMode = RoundingMode::ToEven;

/// `x` exactly. astro-float reads subnormals wrongly: those are lifted by 2^100 and put back.
pub fn big(x: f64) -> BigFloat {
    if x.is_subnormal() {
        let lift = 2f64.powi(100);
        return BigFloat::from_f64(x * lift, 64).mul_full_prec(&BigFloat::from_f64(lift.recip(), 64));
    }
    BigFloat::from_f64(x, 64)
}

/// a + b without rounding. astro-float makes the full-precision sum of anything and 0 a 0.
pub fn sum(a: &BigFloat, b: &BigFloat) -> BigFloat {
    match (a.is_zero(), b.is_zero()) {
        (true, _) => b.clone(),
        (_, true) => a.clone(),
        _ => a.add_full_prec(b),
    }
}

/// The value of an elementary operation where it is defined; `None` for operations whose reference enclosure of a point
/// is tight anyway, so that nothing lies between its ends.
pub fn value(op: Op, x: f64, y: f64, cc: &mut Consts) -> Option<BigFloat> {
    let a = big(x);
    let small = x.abs() < 2f64.powi(-90);
    Some(match op {
        Op::Exp => a.exp(P, RM, cc),
        Op::Exp2 => big(2.0).pow(&a, P, RM, cc),
        Op::Exp10 => big(10.0).pow(&a, P, RM, cc),
        // For |x| < 2^-90, three terms of the series are off by less than 2^-270 of the value.
        Op::Expm1 if small => {
            let tail = big(1.0).add(&a.div(&big(3.0), P, RM), P, RM).mul(&a, P, RM).div(&big(2.0), P, RM);
            tail.add_full_prec(&big(1.0)).mul(&a, P, RM)
        }
        Op::Expm1 => a.exp(P + 128, RM, cc).sub(&big(1.0), P, RM),
        Op::Ln => a.ln(P, RM, cc),
        Op::Log1p if small => {
            let tail = big(0.5).sub(&a.div(&big(3.0), P, RM), P, RM).mul(&a, P, RM);
            big(1.0).sub(&tail, P, RM).mul(&a, P, RM)
        }
        Op::Log1p => a.add_full_prec(&big(1.0)).ln(P + 128, RM, cc),
        Op::Log2 => a.log2(P, RM, cc),
        Op::Log10 => a.log10(P, RM, cc),
        Op::Sin => a.sin(P, RM, cc),
        Op::Cos => a.cos(P, RM, cc),
        Op::Tan => a.tan(P, RM, cc),
        Op::Asin => a.asin(P, RM, cc),
        Op::Acos => a.acos(P, RM, cc),
        Op::Atan => a.atan(P, RM, cc),
        Op::Sinh => a.sinh(P, RM, cc),
        Op::Cosh => a.cosh(P, RM, cc),
        Op::Tanh => a.tanh(P, RM, cc),
        Op::Asinh => a.asinh(P, RM, cc),
        Op::Acosh => a.acosh(P, RM, cc),
        Op::Atanh => a.atanh(P, RM, cc),
        Op::Cbrt => a.cbrt(P, RM),
        Op::Hypot => {
            let b = big(y);
            sum(&a.mul_full_prec(&a), &b.mul_full_prec(&b)).sqrt(P, RM)
        }
        Op::Pow if x == 0.0 => big(0.0),
        Op::Pow => a.pow(&big(y), P, RM, cc),
        Op::Atan2 => angle(x, y, cc),
        Op::PowRatio(p, q) => {
            let ratio = big(p.into()).div(&big(q.into()), P + 64, RM);
            let power = a.abs().pow(&ratio, P, RM, cc);
            if x < 0.0 && p % 2 != 0 { power.neg() } else { power }
        }
        _ => return None,
    })
}

/// The angle of the point (x, y), not the origin, in (-pi, pi].
fn angle(y: f64, x: f64, cc: &mut Consts) -> BigFloat {
    let pi = cc.pi(P + 64, RM);
    if x == 0.0 {
        let half = pi.div(&big(2.0), P, RM);
        return if y > 0.0 { half } else { half.neg() };
    }
    let slope = big(y).div(&big(x), P + 64, RM).atan(P + 64, RM, cc);
    match (x > 0.0, y >= 0.0) {
        (true, _) => slope,
        (false, true) => slope.add(&pi, P, RM),
        (false, false) => slope.sub(&pi, P, RM),
    }
}

/// Whether `bound <= value`, and whether `value <= bound`; infinite bounds included.
pub fn at_most(bound: f64, value: &BigFloat) -> bool {
    bound == f64::NEG_INFINITY || (bound < f64::INFINITY && value.cmp(&big(bound)).expect("a value is a number") >= 0)
}

pub fn at_least(bound: f64, value: &BigFloat) -> bool {
    bound == f64::INFINITY || (bound > f64::NEG_INFINITY && value.cmp(&big(bound)).expect("a value is a number") <= 0)
}
