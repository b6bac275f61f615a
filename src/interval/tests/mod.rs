//! Tests against exact rationals and 256-bit numbers. Random cases are seeded; `IMP_TEST_CASES` sets how many.

mod affine;
mod arithmetic;
mod conformance;
mod decorations;
mod elementary;
mod linear;
mod literals;
mod modal;
mod powers;
mod relations;
mod reverse;
mod rounding;
mod special;

use super::Interval;
use astro_float::BigFloat;
use fastrand::Rng;
use num_rational::BigRational;

/// How many random cases a test runs.
fn cases(default: usize) -> usize {
    std::env::var("IMP_TEST_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(default)
}

/// A finite number of one of the kinds that break arithmetic.
fn number(rng: &mut Rng) -> f64 {
    const SPECIAL: [f64; 16] = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        0.5,
        2.0,
        -2.5,
        5e-324,
        -5e-324,
        f64::MIN_POSITIVE,
        f64::MAX,
        f64::MIN,
        f64::EPSILON,
        9007199254740992.0,
        std::f64::consts::PI,
        -std::f64::consts::FRAC_PI_2,
    ];
    let x = match rng.u32(0..12) {
        0 => SPECIAL[rng.usize(0..SPECIAL.len())],
        // Any bit pattern.
        1 => f64::from_bits(rng.u64(..)),
        // Subnormal.
        2 => f64::from_bits(rng.u64(..) & 0x800f_ffff_ffff_ffff),
        // Near a whole number or a half.
        3 => rng.i32(-200..200) as f64 / 2.0,
        4 => (rng.i32(-20..20) as f64).next_up(),
        5 => (rng.i32(-20..20) as f64).next_down(),
        // Near multiples of pi/2, small and large.
        6 => rng.i32(-1000..1000) as f64 * std::f64::consts::FRAC_PI_2,
        7 => rng.i64(-(1 << 53)..1 << 53) as f64,
        // Powers of two.
        8 => 2f64.powi(rng.i32(-1022..1023)),
        // Near the ends of the domains of inverse functions.
        9 => 1.0 + (rng.f64() - 0.5) * 2f64.powi(rng.i32(-60..0)),
        10 => (rng.f64() - 0.5) * 1500.0,
        _ => (rng.f64() - 0.5) * 8.0,
    };
    if x.is_finite() { x } else { 1.0 }
}

/// A set that is not empty: a point, narrow, wide or unbounded.
fn interval(rng: &mut Rng) -> Interval {
    let (a, b) = (number(rng), number(rng));
    let (lo, hi) = match rng.u32(0..10) {
        0 => (a, a),
        1 => (a, a.next_up()),
        2 => (f64::NEG_INFINITY, a),
        3 => (a, f64::INFINITY),
        4 => (a, a + a.abs() * 2f64.powi(-rng.i32(1..50))),
        5 => (a, a + rng.f64() * 7.0),
        _ => (a.min(b), a.max(b)),
    };
    Interval::new(lo, hi).unwrap_or(Interval::ENTIRE)
}

/// Members of `x`, its finite ends among them.
fn members(rng: &mut Rng, x: Interval) -> Vec<f64> {
    let inside = |t: f64| t.clamp(x.lo().max(f64::MIN), x.hi().min(f64::MAX));
    let (lo, hi) = (inside(x.lo()), inside(x.hi()));
    let between = inside(lo + (hi / 2.0 - lo / 2.0) * 2.0 * rng.f64());
    vec![lo, hi, inside(x.mid()), between, inside(number(rng))]
}

/// A part of `x` that is not empty.
fn part(rng: &mut Rng, x: Interval) -> Interval {
    let ends = members(rng, x);
    let (a, b) = (ends[rng.usize(0..5)], ends[rng.usize(0..5)]);
    Interval::new(a.min(b), a.max(b)).unwrap()
}

/// The finite number `x` as a rational.
fn exact(x: f64) -> BigRational {
    BigRational::from_float(x).unwrap()
}

/// `x` as a number of 64 bits. astro-float reads subnormals wrongly: those are lifted by 2^100 and put back.
fn big(x: f64) -> BigFloat {
    if x.is_subnormal() {
        let lift = 2f64.powi(100);
        return BigFloat::from_f64(x * lift, 64).mul_full_prec(&BigFloat::from_f64(lift.recip(), 64));
    }
    BigFloat::from_f64(x, 64)
}

/// Whether `x` is the largest number that is not above `value`.
fn is_rounded_down(x: f64, value: &BigRational) -> bool {
    let next = x.next_up();
    let not_above = x == f64::NEG_INFINITY || exact(x) <= *value;
    not_above && (next == f64::INFINITY || exact(next) > *value)
}

/// Whether `x` is the least number that is not below `value`.
fn is_rounded_up(x: f64, value: &BigRational) -> bool {
    is_rounded_down(-x, &-value)
}

/// The interval with these bounds; empty for NaN.
fn set(lo: f64, hi: f64) -> Interval {
    if lo.is_nan() { Interval::EMPTY } else { Interval::new(lo, hi).unwrap() }
}
