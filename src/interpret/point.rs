//! Operations on plain numbers: what a point kernel computes, with the functions of the standard library. Nothing here
//! is proved; where an operation is undefined the result is NaN.

use num_rational::BigRational;
use num_traits::ToPrimitive;

use crate::graph::Op;

/// The number nearest to a constant.
pub fn constant(number: &BigRational) -> f64 {
    number.to_f64().unwrap_or(f64::NAN)
}

/// One operation, rounded to nearest where `f64` says so. Inputs and constants are the caller's.
///
/// # Panics
/// For `Const` and `Var`.
pub fn apply(op: Op, operands: &[f64]) -> f64 {
    let x = || operands[0];
    let y = || operands[1];
    let truth = |condition: bool| f64::from(u8::from(condition));
    match op {
        Op::Const(_) | Op::Var(_) => panic!("constants and inputs have no operands to evaluate"),
        Op::PowInt(n) => x().powi(n),
        Op::PowRatio(p, q) => power(x(), p, q),
        Op::Pi => std::f64::consts::PI,
        Op::Entire => f64::NAN,
        Op::Neg => -x(),
        Op::Sqr => x() * x(),
        Op::Sqrt => x().sqrt(),
        Op::Cbrt => x().cbrt(),
        Op::Abs => x().abs(),
        Op::Sign if x() == 0.0 => 0.0,
        Op::Sign => x().signum(),
        Op::Floor => x().floor(),
        Op::Ceil => x().ceil(),
        Op::Round => x().round(),
        Op::Exp => x().exp(),
        Op::Exp2 => x().exp2(),
        Op::Exp10 => 10f64.powf(x()),
        Op::Expm1 => x().exp_m1(),
        Op::Ln => positive(x()).ln(),
        Op::Log1p => positive(1.0 + x()).min(x()).ln_1p(),
        Op::Log2 => positive(x()).log2(),
        Op::Log10 => positive(x()).log10(),
        Op::Sin => x().sin(),
        Op::Cos => x().cos(),
        Op::Tan => x().tan(),
        Op::Asin => x().asin(),
        Op::Acos => x().acos(),
        Op::Atan => x().atan(),
        Op::Sinh => x().sinh(),
        Op::Cosh => x().cosh(),
        Op::Tanh => x().tanh(),
        Op::Asinh => x().asinh(),
        Op::Acosh => x().acosh(),
        Op::Atanh => x().atanh(),
        Op::Add => x() + y(),
        Op::Sub => x() - y(),
        Op::Mul => x() * y(),
        Op::Div => x() / y(),
        // NaN on either side stays, unlike with `f64::min`.
        Op::Min if x().is_nan() || y().is_nan() => f64::NAN,
        Op::Min => x().min(y()),
        Op::Max if x().is_nan() || y().is_nan() => f64::NAN,
        Op::Max => x().max(y()),
        Op::Mod => x() - y() * (x() / y()).floor(),
        Op::Hypot => x().hypot(y()),
        Op::Pow if x() < 0.0 || x() == 0.0 && y() <= 0.0 => f64::NAN,
        Op::Pow => x().powf(y()),
        Op::Atan2 if x() == 0.0 && y() == 0.0 => f64::NAN,
        Op::Atan2 => x().atan2(y()),
        Op::Less | Op::LessEqual | Op::Equal if x().is_nan() || y().is_nan() => f64::NAN,
        Op::Less => truth(x() < y()),
        Op::LessEqual => truth(x() <= y()),
        Op::Equal => truth(x() == y()),
        Op::Select | Op::SelectJump | Op::Kink if x().is_nan() => f64::NAN,
        Op::Select | Op::SelectJump => operands[if x() != 0.0 { 1 } else { 2 }],
        // At the kink itself the slope above stands for both.
        Op::Kink => operands[if x() < 0.0 { 1 } else { 2 }],
    }
}

/// `x`, or NaN where a logarithm is undefined: `f64` would answer -inf at 0.
fn positive(x: f64) -> f64 {
    if x > 0.0 { x } else { f64::NAN }
}

/// `x^(p/q)`, for odd q through the magnitude.
fn power(x: f64, p: i32, q: u32) -> f64 {
    if x < 0.0 && q.is_multiple_of(2) || x == 0.0 && p < 0 {
        return f64::NAN;
    }
    let magnitude = x.abs().powf(f64::from(p) / f64::from(q));
    if x < 0.0 && p % 2 != 0 { -magnitude } else { magnitude }
}
