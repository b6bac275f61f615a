//! What one operation does to affine forms.

use super::Op;
use crate::interval::Coefficients;
use crate::interval::Form;
use crate::interval::Interval;
use crate::interval::Linear;

/// The form of one operation on operands with the given forms and enclosures; `value` encloses the result on those.
///
/// Operations whose [`Op::affine`] is `ThroughInterval` have the form of `value`, which shares no symbol with
/// anything. So do all others where they have no bounds between lines.
pub fn apply_affine<C: Coefficients>(op: Op, operands: &[(Form<C>, Interval)], value: Interval) -> Form<C> {
    let form = match operands {
        [(x, range)] => unary(op, x, *range),
        [x, y] => binary(op, x, y, value),
        _ => None,
    };
    form.filter(Form::is_bounded).unwrap_or_else(|| Form::constant(value))
}

/// An operation on a form whose value lies in `range`.
fn unary<C: Coefficients>(op: Op, x: &Form<C>, range: Interval) -> Option<Form<C>> {
    let function = match op {
        Op::Neg => return Some(-x.clone()),
        Op::Sqr => Linear::sqr(range),
        Op::PowInt(n) => Linear::powi(range, n),
        Op::PowRatio(p, q) => Linear::pow_rational(range, p, q),
        Op::Sqrt => Linear::sqrt(range),
        Op::Cbrt => Linear::cbrt(range),
        Op::Abs => Linear::abs(range),
        Op::Exp => Linear::exp(range),
        Op::Exp2 => Linear::exp2(range),
        Op::Exp10 => Linear::exp10(range),
        Op::Expm1 => Linear::expm1(range),
        Op::Ln => Linear::ln(range),
        Op::Log1p => Linear::log1p(range),
        Op::Log2 => Linear::log2(range),
        Op::Log10 => Linear::log10(range),
        Op::Sin => Linear::sin(range),
        Op::Cos => Linear::cos(range),
        Op::Tan => Linear::tan(range),
        Op::Asin => Linear::asin(range),
        Op::Acos => Linear::acos(range),
        Op::Atan => Linear::atan(range),
        Op::Sinh => Linear::sinh(range),
        Op::Cosh => Linear::cosh(range),
        Op::Tanh => Linear::tanh(range),
        Op::Asinh => Linear::asinh(range),
        Op::Acosh => Linear::acosh(range),
        Op::Atanh => Linear::atanh(range),
        Op::Sign | Op::Floor | Op::Ceil | Op::Round => return None,
        Op::Const(_)
        | Op::Var(_)
        | Op::Pi
        | Op::Entire
        | Op::Add
        | Op::Sub
        | Op::Mul
        | Op::Div
        | Op::Min
        | Op::Max
        | Op::Mod
        | Op::Hypot
        | Op::Pow
        | Op::Atan2
        | Op::Less
        | Op::LessEqual
        | Op::Equal
        | Op::Select
        | Op::Kink
        | Op::SelectJump => unreachable!("{} is not unary", op.name()),
    };
    Some(x.apply(&function))
}

/// A form with an interval that holds its value.
type Ranged<C> = (Form<C>, Interval);

fn binary<C: Coefficients>(op: Op, x: &Ranged<C>, y: &Ranged<C>, value: Interval) -> Option<Form<C>> {
    Some(match op {
        Op::Add => x.0.clone() + y.0.clone(),
        Op::Sub => x.0.clone() - y.0.clone(),
        Op::Mul => product(x, y),
        Op::Div => quotient(x, y),
        Op::Min => -greater(&negated(x), &negated(y)),
        Op::Max => greater(x, y),
        Op::Hypot => hypotenuse(x, y, value),
        Op::Pow => power(x, y, value)?,
        Op::Atan2 => angle(x, y)?,
        Op::Mod | Op::Less | Op::LessEqual | Op::Equal => return None,
        _ => unreachable!("{} is not binary", op.name()),
    })
}

/// Whether one number or a rounding of it is all that is known: then a product with the width would count it twice.
fn is_number(x: Interval) -> bool {
    x.hi() <= x.lo().next_up()
}

/// A form beside the part of its range that lies in `interval`, which holds its value too.
fn ranged<C: Coefficients>(form: Form<C>, interval: Interval) -> Ranged<C> {
    let range = form.to_interval().intersect(interval);
    (form, range)
}

fn negated<C: Coefficients>((x, range): &Ranged<C>) -> Ranged<C> {
    (-x.clone(), -*range)
}

fn product<C: Coefficients>((x, a): &Ranged<C>, (y, b): &Ranged<C>) -> Form<C> {
    match () {
        _ if is_number(*a) => y.scale(*a),
        _ if is_number(*b) => x.scale(*b),
        _ => x.clone() * y.clone(),
    }
}

/// x / y as x (1/y), or as c + (x - c y) (1/y) with c the quotient of the centres, in which what x and y have in common
/// cancels before it is multiplied. Either can be the tighter one.
fn quotient<C: Coefficients>(x: &Ranged<C>, y: &Ranged<C>) -> Form<C> {
    if is_number(y.1) {
        return x.0.scale(y.1.recip());
    }
    let reciprocal = y.0.apply(&Linear::recip(y.1));
    if is_number(x.1) {
        return reciprocal.scale(x.1);
    }
    let plain = x.0.clone() * reciprocal.clone();
    let centre = Interval::point(x.0.centre() / y.0.centre());
    let rest = (x.0.clone() - y.0.scale(centre)) * reciprocal;
    narrower(plain, rest + Form::constant(centre))
}

fn narrower<C: Coefficients>(x: Form<C>, y: Form<C>) -> Form<C> {
    if y.radius() < x.radius() { y } else { x }
}

/// max(x, y) = (x + y + |x - y|) / 2.
fn greater<C: Coefficients>(x: &Ranged<C>, y: &Ranged<C>) -> Form<C> {
    let (gap, range) = ranged(x.0.clone() - y.0.clone(), x.1 - y.1);
    match () {
        _ if range.lo() >= 0.0 => x.0.clone(),
        _ if range.hi() <= 0.0 => y.0.clone(),
        _ => (x.0.clone() + y.0.clone() + gap.apply(&Linear::abs(range))).scale(Interval::point(0.5)),
    }
}

/// sqrt(x^2 + y^2), or through `value` where that is narrower.
fn hypotenuse<C: Coefficients>((x, a): &Ranged<C>, (y, b): &Ranged<C>, value: Interval) -> Form<C> {
    let squares = x.apply(&Linear::sqr(*a)) + y.apply(&Linear::sqr(*b));
    let (sum, range) = ranged(squares, a.sqr() + b.sqr());
    narrower(Form::constant(value), sum.apply(&Linear::sqrt(range)))
}

/// x^y: as a function of x where y is a number, else exp(y ln x), or through `value` where that is narrower.
fn power<C: Coefficients>(x: &Ranged<C>, y: &Ranged<C>, value: Interval) -> Option<Form<C>> {
    if y.1.is_singleton() {
        return Some(x.0.apply(&Linear::pow(x.1, y.1.lo())));
    }
    if x.1.is_empty() || x.1.lo() <= 0.0 {
        return None;
    }
    let logarithm = ranged(x.0.apply(&Linear::ln(x.1)), x.1.ln());
    let (exponent, range) = ranged(product(y, &logarithm), y.1 * logarithm.1);
    Some(narrower(Form::constant(value), exponent.apply(&Linear::exp(range))))
}

/// The angle of (x, y): atan(y/x) to the right of the origin, and a quarter turn or minus that less atan(x/y) above or
/// below it; where both hold, by the side on which the divisor stays farther from 0.
fn angle<C: Coefficients>(y: &Ranged<C>, x: &Ranged<C>) -> Option<Form<C>> {
    let arctangent = |x: &Ranged<C>, y: &Ranged<C>| {
        let (slope, range) = ranged(quotient(x, y), x.1 / y.1);
        slope.apply(&Linear::atan(range))
    };
    let aside = x.1.lo() <= y.1.mig();
    match () {
        _ if x.1.is_empty() || y.1.is_empty() => None,
        _ if aside && y.1.lo() > 0.0 => Some(Form::constant(Interval::HALF_PI) - arctangent(x, y)),
        _ if aside && y.1.hi() < 0.0 => Some(Form::constant(-Interval::HALF_PI) - arctangent(x, y)),
        _ if x.1.lo() > 0.0 => Some(arctangent(y, x)),
        _ => None,
    }
}
