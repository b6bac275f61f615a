//! Functions of one and two arguments against 256-bit values: containment on boxes, tightness on points, decorations.

use super::{big, cases, interval, members, number, part};
use crate::interval::{Decorated, Decoration, Interval};
use astro_float::{BigFloat, Consts, RoundingMode};
use fastrand::Rng;
use std::cmp::Ordering;

const P: usize = 256;
const RM: RoundingMode = RoundingMode::ToEven;

/// The real value at a point of the domain.
pub(super) type Oracle = fn(&BigFloat, &mut Consts) -> Option<BigFloat>;

pub(super) struct Unary {
    pub name: &'static str,
    plain: fn(Interval) -> Interval,
    decorated: fn(Decorated) -> Decorated,
    pub oracle: Oracle,
    /// How many neighbours away from the value a bound of a point may be.
    slack: u32,
}

fn compare(value: &BigFloat, x: f64) -> Ordering {
    value.cmp(&big(x)).expect("a value is a number").cmp(&0)
}

pub(super) fn contains(y: Interval, value: &BigFloat) -> bool {
    !y.is_empty() && compare(value, y.lo()).is_ge() && compare(value, y.hi()).is_le()
}

/// Whether moving each bound of `y` inwards by `slack + 1` neighbours passes `value`.
fn is_tight(y: Interval, value: &BigFloat, slack: u32) -> bool {
    let (mut lo, mut hi) = (y.lo(), y.hi());
    for _ in 0..=slack {
        (lo, hi) = (lo.next_up(), hi.next_down());
    }
    // Beyond its exponents the oracle says infinity, meaning a large real number.
    (lo == f64::INFINITY || compare(value, lo).is_lt()) && (hi == f64::NEG_INFINITY || compare(value, hi).is_gt())
}

/// (e^x - e^-x) / 2 and the like lose everything for small x: a few terms of the series do not.
fn is_small(x: &BigFloat) -> bool {
    x.abs().cmp(&big(2f64.powi(-90))).unwrap() < 0
}

fn one() -> BigFloat {
    big(1.0)
}

/// e^x - 1. For |x| < 2^-90, x + x^2/2 + x^3/6 is off by less than 2^-270 of it.
fn expm1(x: &BigFloat, cc: &mut Consts) -> BigFloat {
    if is_small(x) {
        let term = one().add(&x.div(&big(3.0), P, RM), P, RM).mul(x, P, RM).div(&big(2.0), P, RM);
        return term.add_full_prec(&one()).mul(x, P, RM);
    }
    x.exp(P + 128, RM, cc).sub(&one(), P, RM)
}

/// ln(1 + x) for x > -1: for |x| < 2^-90, x - x^2/2 + x^3/3.
fn ln1p(x: &BigFloat, cc: &mut Consts) -> BigFloat {
    if is_small(x) {
        let term = big(0.5).sub(&x.div(&big(3.0), P, RM), P, RM).mul(x, P, RM);
        return one().sub(&term, P, RM).mul(x, P, RM);
    }
    x.add_full_prec(&one()).ln(P + 128, RM, cc)
}

/// b^x - 1, where `ln` is the logarithm of b: the power itself, exact where it is a whole number, but for small x.
fn power_minus_one(b: f64, ln: BigFloat, x: &BigFloat, cc: &mut Consts) -> BigFloat {
    if is_small(x) {
        return expm1(&x.mul(&ln, P + 128, RM), cc);
    }
    big(b).pow(x, P + 128, RM, cc).sub(&one(), P, RM)
}

/// The nearest whole number, the even one of two.
fn ties_even(x: &BigFloat) -> BigFloat {
    let below = x.floor();
    let even = below.mul(&big(0.5), P, RM).floor().mul(&big(2.0), P, RM).cmp(&below) == Some(0);
    match x.sub(&below, P, RM).cmp(&big(0.5)).unwrap().cmp(&0) {
        Ordering::Less => below,
        Ordering::Equal if even => below,
        _ => below.add(&one(), P, RM),
    }
}

fn above_minus_one(x: &BigFloat) -> bool {
    x.cmp(&big(-1.0)).unwrap() > 0
}

fn positive(x: &BigFloat) -> bool {
    x.is_positive() && !x.is_zero()
}

fn within_one(x: &BigFloat) -> bool {
    x.abs().cmp(&one()).unwrap() <= 0
}

macro_rules! table {
    ($($name:ident($x:ident, $cc:ident) $slack:literal $oracle:expr;)*) => {
        &[$(Unary {
            name: stringify!($name),
            plain: Interval::$name,
            decorated: Decorated::$name,
            oracle: |$x, $cc| { let _ = &$cc; $oracle },
            slack: $slack,
        }),*]
    };
}

pub(super) const TABLE: &[Unary] = table! {
    exp(x, cc) 1 Some(x.exp(P, RM, cc));
    exp2(x, cc) 1 Some(big(2.0).pow(x, P, RM, cc));
    exp10(x, cc) 1 Some(big(10.0).pow(x, P, RM, cc));
    expm1(x, cc) 1 Some(expm1(x, cc));
    ln(x, cc) 1 positive(x).then(|| x.ln(P, RM, cc));
    log2(x, cc) 1 positive(x).then(|| x.log2(P, RM, cc));
    log10(x, cc) 1 positive(x).then(|| x.log10(P, RM, cc));
    exp2m1(x, cc) 1 Some({ let ln = cc.ln_2(P + 128, RM); power_minus_one(2.0, ln, x, cc) });
    exp10m1(x, cc) 1 Some({ let ln = cc.ln_10(P + 128, RM); power_minus_one(10.0, ln, x, cc) });
    log1p(x, cc) 1 above_minus_one(x).then(|| ln1p(x, cc));
    log2p1(x, cc) 1 above_minus_one(x).then(|| {
        if is_small(x) { ln1p(x, cc).div(&cc.ln_2(P, RM), P, RM) } else { x.add_full_prec(&one()).log2(P, RM, cc) }
    });
    log10p1(x, cc) 1 above_minus_one(x).then(|| {
        if is_small(x) { ln1p(x, cc).div(&cc.ln_10(P, RM), P, RM) } else { x.add_full_prec(&one()).log10(P, RM, cc) }
    });
    sin(x, cc) 1 Some(x.sin(P, RM, cc));
    cos(x, cc) 1 Some(x.cos(P, RM, cc));
    tan(x, cc) 1 Some(x.tan(P, RM, cc));
    asin(x, cc) 1 within_one(x).then(|| x.asin(P, RM, cc));
    acos(x, cc) 1 within_one(x).then(|| x.acos(P, RM, cc));
    atan(x, cc) 1 Some(x.atan(P, RM, cc));
    sinh(x, cc) 1 Some(x.sinh(P, RM, cc));
    cosh(x, cc) 1 Some(x.cosh(P, RM, cc));
    tanh(x, cc) 1 Some(x.tanh(P, RM, cc));
    asinh(x, cc) 1 Some(x.asinh(P, RM, cc));
    acosh(x, cc) 1 (x.cmp(&one()).unwrap() >= 0).then(|| x.acosh(P, RM, cc));
    atanh(x, cc) 1 (x.abs().cmp(&one()).unwrap() < 0).then(|| x.atanh(P, RM, cc));
    sqr(x, cc) 0 Some(x.mul_full_prec(x));
    recip(x, cc) 0 (!x.is_zero()).then(|| x.reciprocal(P, RM));
    abs(x, cc) 0 Some(x.abs());
    sqrt(x, cc) 0 (!x.is_negative() || x.is_zero()).then(|| x.sqrt(P, RM));
    rsqrt(x, cc) 0 positive(x).then(|| x.sqrt(P + 64, RM).reciprocal(P, RM));
    cbrt(x, cc) 0 Some(x.cbrt(P, RM));
    sign(x, cc) 0 Some(if x.is_zero() { big(0.0) } else { x.signum() });
    floor(x, cc) 0 Some(x.floor());
    ceil(x, cc) 0 Some(x.ceil());
    trunc(x, cc) 0 Some(if x.is_negative() { x.ceil() } else { x.floor() });
    round_ties_even(x, cc) 0 Some(ties_even(x));
    round(x, cc) 0 Some(x.abs().add_full_prec(&big(0.5)).floor().mul_full_prec(&x.signum()));
};

#[test]
fn unary_functions_enclose_their_values() {
    let mut cc = Consts::new().unwrap();
    for op in TABLE {
        let mut rng = Rng::with_seed(10);
        for _ in 0..cases(120) {
            let x = interval(&mut rng);
            let y = (op.plain)(x);
            let decorated = (op.decorated)(Decorated::new(x));
            assert_eq!(decorated.interval(), y, "{} {x}", op.name);
            for point in members(&mut rng, x) {
                match (op.oracle)(&big(point), &mut cc) {
                    Some(value) => assert!(contains(y, &value), "{}({point:e}) = {value} is not in {y}; {x}", op.name),
                    None => assert!(decorated.decoration() <= Decoration::Trv, "{} {x} at {point:e}", op.name),
                }
            }
            let inner = (op.plain)(part(&mut rng, x));
            assert!(y.contains_interval(inner), "{} {x}: {inner} is not in {y}", op.name);
        }
    }
}

#[test]
fn unary_functions_are_tight_on_points() {
    let mut cc = Consts::new().unwrap();
    for op in TABLE {
        let mut rng = Rng::with_seed(11);
        for _ in 0..cases(200) {
            let point = number(&mut rng);
            let y = (op.plain)(Interval::point(point));
            let decoration = (op.decorated)(Decorated::new(Interval::point(point))).decoration();
            let Some(value) = (op.oracle)(&big(point), &mut cc) else {
                assert!(y.is_empty() && decoration == Decoration::Trv, "{}({point:e}) = {y}", op.name);
                continue;
            };
            assert!(contains(y, &value), "{}({point:e}) = {value} is not in {y}", op.name);
            assert!(is_tight(y, &value, op.slack), "{}({point:e}) = {value}, {y} is wide", op.name);
            let bounded = if y.is_bounded() { Decoration::Com } else { Decoration::Dac };
            let jump = y.is_singleton() && decoration == Decoration::Dac;
            assert!(decoration == bounded || jump, "{}({point:e}) {decoration}", op.name);
        }
    }
}

/// The angle of (x, y), not the origin, in (-pi, pi].
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

#[test]
fn atan2_encloses_its_values() {
    let mut cc = Consts::new().unwrap();
    let mut rng = Rng::with_seed(12);
    for _ in 0..cases(1500) {
        let (y, x) = (interval(&mut rng), interval(&mut rng));
        let angles = Decorated::new(y).atan2(Decorated::new(x));
        for (y, x) in members(&mut rng, y).into_iter().zip(members(&mut rng, x)) {
            if y == 0.0 && x == 0.0 {
                assert!(angles.decoration() <= Decoration::Trv);
                continue;
            }
            let value = angle(y, x, &mut cc);
            assert!(contains(angles.interval(), &value), "atan2({y:e}, {x:e}) = {value} is not in {angles}");
            let point = Interval::point(y).atan2(Interval::point(x));
            assert!(is_tight(point, &value, 1), "atan2({y:e}, {x:e}) = {value}, {point} is wide");
        }
        let inner = part(&mut rng, y).atan2(part(&mut rng, x));
        assert!(angles.interval().contains_interval(inner), "atan2({y}, {x})");
    }
}

/// Boxes of up to a turn and a half: the extremes found are those of the wave, at any distance from 0.
#[test]
fn waves_are_as_wide_as_their_samples() {
    let mut rng = Rng::with_seed(13);
    for _ in 0..cases(2000) {
        let start = (rng.f64() - 0.5) * 2f64.powi(rng.i32(0..30));
        let width = rng.f64() * 9.0;
        let x = Interval::new(start, start + width).unwrap();
        let samples = 300;
        // Between samples a wave rises by at most half the curvature, 1, times the square of half a step, beside
        // roundings.
        let margin = (width / f64::from(samples)).powi(2) / 8.0 + 1e-6;
        for (name, y, f) in [("sin", x.sin(), f64::sin as fn(f64) -> f64), ("cos", x.cos(), f64::cos)] {
            let values = (0..=samples).map(|i| f(start + width * f64::from(i) / f64::from(samples)));
            let (low, high) = values.fold((1.0f64, -1.0f64), |(low, high), v| (low.min(v), high.max(v)));
            assert!(y.lo() <= low + 1e-7 && y.hi() >= high - 1e-7, "{name} {x}: {y} against [{low}, {high}]");
            assert!(y.lo() >= low - margin && y.hi() <= high + margin, "{name} {x}: {y} against [{low}, {high}]");
        }
    }
}
