//! Hyperbolic functions and their inverses. With |x| = n ln 2 + r, C = cosh r and S = sinh r,
//! sinh |x| = C (p - q) + S (p + q) and cosh x = C (p + q) + S (p - q) for p = 2^(n-1), q = 2^(-n-1): no division, and
//! no cancellation near 0, where p = q.

use crate::derive::elementary::Approx;
use crate::derive::elementary::Format;
use crate::derive::elementary::exp;
use crate::derive::elementary::increasing;
use crate::derive::elementary::increasing_odd;
use crate::derive::elementary::log::log1p_core;
use crate::derive::elementary::tables;
use crate::derive::ends::Applied;
use crate::derive::ends::Ends;
use crate::derive::lanes::Builder;
use crate::derive::lanes::Lane;
use crate::derive::lanes::LaneOp;
use crate::derive::lanes::Mask;

/// Errors in epsilon: of the hyperbolic sine relative to (p - q) + |S| (p + q), of the cosine relative to p + q, of the
/// tangent relative to it: sections "sinh", "cosh" and "tanh".
const SINH_ERROR: f64 = 3.25;
const COSH_ERROR: f64 = 3.4375;
const TANH_ERROR: f64 = 5.9375;
/// Relative errors of the arguments that the inverse functions hand to log1p: sections "asinh", "acosh" and "atanh".
const ASINH_ARGUMENT: f64 = 3.75;
const ACOSH_ARGUMENT: f64 = 3.25;
const ATANH_ARGUMENT: f64 = 2.125;

/// What both functions are made of, all halved so that nothing overflows before the last step.
struct Halves {
    /// (p + q)/2 and (p - q)/2.
    sum: Lane,
    difference: Lane,
    /// C - 1 and S.
    curve: Lane,
    slope: Lane,
}

/// For 0 <= |x| <= 710.75 (single: 89.5).
fn halves(b: &mut Builder, magnitude: Lane) -> Halves {
    let &Format { bias, fraction, .. } = b.format();
    let [per_octave] = b.parts(&tables::LOG2_E);
    let [l1, l2] = b.parts(&tables::LN_2);
    let quotient = b.mul(magnitude, per_octave);
    let n = b.nearest(quotient);
    let minus_n = b.neg(n);
    let r = b.fma(minus_n, l1, magnitude);
    let r = b.fma(minus_n, l2, r);
    let z = b.mul(r, r);
    let curve = b.polynomial(&tables::COSH, z);
    let curve = b.mul(z, curve);
    let slope = b.polynomial(&tables::SINH, z);
    let slope = b.mul(z, slope);
    let slope = b.fma(r, slope, r);
    let p = b.power_of_two(n, -2);
    // q = 2^-4 / p by its exponent. Where it would leave the normal numbers, p is above 2^(bias - 5), and the largest q
    // that is no number any more is still nothing beside it.
    let largest = match fraction {
        23 => f64::from(f32::from_bits((2 * bias as u32 - 5) << 23)),
        _ => f64::from_bits((2 * bias - 5) << 52),
    };
    let largest = b.number(largest);
    let least = b.min(p, largest);
    let turn = b.bits((2 * bias - 4) << fraction);
    let bits = b.push(LaneOp::ToBits(least));
    let bits = b.push(LaneOp::IntSub(turn, bits));
    let q = b.push(LaneOp::FromBits(bits));
    Halves { sum: b.add(p, q), difference: b.sub(p, q), curve, slope }
}

impl Halves {
    /// sinh/2.
    fn sine(&self, b: &mut Builder) -> Approx {
        let slope = b.mul(self.slope, self.sum);
        let tail = b.fma(self.difference, self.curve, slope);
        let magnitude = b.abs(slope);
        let scale = b.add(self.difference, magnitude);
        Approx { head: self.difference, tail, factor: b.epsilons(SINH_ERROR), scale }
    }

    /// cosh/2.
    fn cosine(&self, b: &mut Builder) -> Approx {
        let slope = b.mul(self.slope, self.difference);
        let tail = b.fma(self.sum, self.curve, slope);
        Approx { head: self.sum, tail, factor: b.epsilons(COSH_ERROR), scale: self.sum }
    }
}

fn clamped_magnitude(b: &mut Builder, x: Lane) -> Lane {
    let greatest = b.by_precision(89.5, 710.75);
    let magnitude = b.abs(x);
    b.min(magnitude, greatest)
}

fn half_sinh_at(b: &mut Builder, x: Lane) -> Approx {
    let magnitude = clamped_magnitude(b, x);
    halves(b, magnitude).sine(b).with_sign_of(b, x)
}

fn half_cosh_at(b: &mut Builder, x: Lane) -> Approx {
    let magnitude = clamped_magnitude(b, x);
    halves(b, magnitude).cosine(b)
}

/// tanh |x| = t / (t + 2) with t = e^(2 |x|) - 1.
fn tanh_at(b: &mut Builder, x: Lane) -> Approx {
    // Beyond it the tangent rounds to 1.
    let greatest = b.by_precision(22.0, 44.0);
    let magnitude = b.abs(x);
    let twice = b.add(magnitude, magnitude);
    let twice = b.min(twice, greatest);
    let exponential = exp::exponential(b, exp::Base::E, twice);
    let t = exp::shifted(b, exponential.n, exponential.s, false);
    let two = b.number(2.0);
    let denominator = b.add(t, two);
    let quotient = b.div(t, denominator);
    let negligible = b.negligible(magnitude);
    let value = b.select(negligible, magnitude, quotient);
    Approx::of(b, value, TANH_ERROR, value).with_sign_of(b, x)
}

/// Twice a halved end, kept above -inf.
fn doubled(b: &mut Builder, end: Lane) -> Lane {
    let two = b.number(2.0);
    let end = b.mul(end, two);
    b.above_minus_max(end)
}

pub fn sinh(b: &mut Builder, x: Ends) -> Applied {
    let half = increasing_odd(b, x, half_sinh_at);
    Ends { nlo: doubled(b, half.nlo), hi: doubled(b, half.hi) }.into()
}

pub fn cosh(b: &mut Builder, x: Ends) -> Applied {
    let magnitude = b.abs_ends(x);
    let half = increasing(b, magnitude, half_cosh_at);
    let (nlo, hi) = (doubled(b, half.nlo), doubled(b, half.hi));
    // Nothing is below 1.
    let minus_one = b.number(-1.0);
    Ends { nlo: b.min(nlo, minus_one), hi }.into()
}

pub fn tanh(b: &mut Builder, x: Ends) -> Applied {
    let ends = increasing_odd(b, x, tanh_at);
    let one = b.number(1.0);
    Ends { nlo: b.min(ends.nlo, one), hi: b.min(ends.hi, one) }.into()
}

pub fn sinh_point(b: &mut Builder, x: Lane) -> Lane {
    let half = half_sinh_at(b, x).value(b);
    let two = b.number(2.0);
    b.mul(half, two)
}

pub fn cosh_point(b: &mut Builder, x: Lane) -> Lane {
    let half = half_cosh_at(b, x).value(b);
    let two = b.number(2.0);
    b.mul(half, two)
}

pub fn tanh_point(b: &mut Builder, x: Lane) -> Lane {
    tanh_at(b, x).value(b)
}

/// Where ln(2 x) is asinh x and acosh x up to 2^-8 epsilon, and x^2 does not overflow yet at it; the logarithm's
/// argument there and the octave to add.
fn large(b: &mut Builder, magnitude: Lane) -> (Mask, Lane) {
    let limit = b.by_precision((1u64 << 30) as f64, (1u64 << 60) as f64);
    let large = b.less(limit, magnitude);
    let (zero, one) = (b.zero(), b.number(1.0));
    (large, b.select(large, one, zero))
}

/// asinh |x| = ln(1 + (|x| + x^2 / (1 + sqrt(1 + x^2)))).
fn asinh_at(b: &mut Builder, x: Lane) -> Approx {
    let magnitude = b.abs(x);
    let (large, octave) = large(b, magnitude);
    let one = b.number(1.0);
    let square = b.mul(magnitude, magnitude);
    let sum = b.add(square, one);
    let root = b.sqrt(sum);
    let denominator = b.add(root, one);
    let more = b.div(square, denominator);
    let negligible = b.negligible(magnitude);
    let zero = b.zero();
    let more = b.select(negligible, zero, more);
    let w = b.add(magnitude, more);
    let w = b.select(large, magnitude, w);
    log1p_core(b, w, Some(octave), ASINH_ARGUMENT).with_sign_of(b, x)
}

/// acosh x = ln(1 + (t + sqrt(t (t + 2)))) with t = x - 1.
fn acosh_at(b: &mut Builder, x: Lane) -> Approx {
    let (large, octave) = large(b, x);
    let (one, two) = (b.number(1.0), b.number(2.0));
    let t = b.sub(x, one);
    let sum = b.add(t, two);
    let product = b.mul(t, sum);
    let root = b.sqrt(product);
    let w = b.add(t, root);
    let w = b.select(large, x, w);
    log1p_core(b, w, Some(octave), ACOSH_ARGUMENT)
}

/// 2 atanh |x| = ln(1 + 2 |x| / (1 - |x|)) for |x| < 1.
fn twice_atanh_at(b: &mut Builder, x: Lane) -> Approx {
    let magnitude = b.abs(x);
    let one = b.number(1.0);
    let numerator = b.add(magnitude, magnitude);
    let denominator = b.sub(one, magnitude);
    let w = b.div(numerator, denominator);
    log1p_core(b, w, None, ATANH_ARGUMENT).with_sign_of(b, x)
}

pub fn asinh(b: &mut Builder, x: Ends) -> Applied {
    let ends = increasing_odd(b, x, asinh_at);
    let nlo = b.unbounded_at_infinity(x.nlo, ends.nlo);
    let hi = b.unbounded_at_infinity(x.hi, ends.hi);
    Ends { nlo, hi }.into()
}

pub fn acosh(b: &mut Builder, x: Ends) -> Applied {
    let (one, minus_one, zero) = (b.number(1.0), b.number(-1.0), b.zero());
    let empty = b.less(x.hi, one);
    let continuous = b.less_equal(x.nlo, minus_one);
    let inside = Ends { nlo: b.min(x.nlo, minus_one), hi: b.max(x.hi, one) };
    let ends = increasing(b, inside, acosh_at);
    let hi = b.unbounded_at_infinity(x.hi, ends.hi);
    Applied { ends: Ends { nlo: b.min(ends.nlo, zero), hi }, empty, continuous }
}

pub fn atanh(b: &mut Builder, x: Ends) -> Applied {
    let (one, minus_one, half, infinity) = (b.number(1.0), b.number(-1.0), b.number(0.5), b.infinity());
    let (above, below) = (b.less_equal(x.nlo, minus_one), b.less_equal(x.hi, minus_one));
    let (low_inside, high_inside) = (b.less(x.nlo, one), b.less(x.hi, one));
    let ends = increasing_odd(b, x, twice_atanh_at);
    let (nlo, hi) = (b.mul(ends.nlo, half), b.mul(ends.hi, half));
    let ends = Ends { nlo: b.select(low_inside, nlo, infinity), hi: b.select(high_inside, hi, infinity) };
    Applied { ends, empty: b.or(above, below), continuous: b.and(low_inside, high_inside) }
}

pub fn asinh_point(b: &mut Builder, x: Lane) -> Lane {
    let value = asinh_at(b, x).value(b);
    let infinity = b.infinity();
    let magnitude = b.abs(x);
    let at = b.equal(magnitude, infinity);
    b.select(at, x, value)
}

pub fn acosh_point(b: &mut Builder, x: Lane) -> Lane {
    let value = acosh_at(b, x).value(b);
    let (one, nan) = (b.number(1.0), b.number(f64::NAN));
    let value = b.unbounded_at_infinity(x, value);
    let inside = b.less_equal(one, x);
    b.select(inside, value, nan)
}

pub fn atanh_point(b: &mut Builder, x: Lane) -> Lane {
    let value = twice_atanh_at(b, x).value(b);
    let (half, one, nan, infinity) = (b.number(0.5), b.number(1.0), b.number(f64::NAN), b.infinity());
    let value = b.mul(value, half);
    let sign = b.sign_bit(x);
    let pole = b.add_to_bits(infinity, sign);
    let magnitude = b.abs(x);
    let (inside, at) = (b.less(magnitude, one), b.equal(magnitude, one));
    let beyond = b.select(at, pole, nan);
    b.select(inside, value, beyond)
}
