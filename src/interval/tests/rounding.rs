//! Directed rounding against exact rationals.

use super::{cases, exact, is_rounded_down, is_rounded_up, number};
use crate::interval::round::*;
use fastrand::Rng;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::Zero;

const MAX: f64 = f64::MAX;
const INF: f64 = f64::INFINITY;
const TINY: f64 = 5e-324;

/// A second operand that often cancels the first, or sends a product or quotient to an end of the range.
fn partner(rng: &mut Rng, x: f64) -> f64 {
    match rng.u32(0..6) {
        0 => -x.next_up(),
        1 => x * (rng.f64() + 0.5),
        2 => 2f64.powi(-1074) / x * rng.f64(),
        3 => MAX / x,
        _ => number(rng),
    }
}

#[test]
fn sums_products_and_quotients_are_tight() {
    let mut rng = Rng::with_seed(1);
    for _ in 0..cases(6000) {
        let a = number(&mut rng);
        let b = partner(&mut rng, a);
        if !b.is_finite() {
            continue;
        }
        let (x, y) = (exact(a), exact(b));
        let sum = &x + &y;
        assert!(is_rounded_down(add_down(a, b), &sum) && is_rounded_up(add_up(a, b), &sum), "{a:e} + {b:e}");
        let difference = &x - &y;
        assert!(is_rounded_down(sub_down(a, b), &difference), "{a:e} - {b:e}");
        assert!(is_rounded_up(sub_up(a, b), &difference), "{a:e} - {b:e}");
        let product = &x * &y;
        assert!(is_rounded_down(mul_down(a, b), &product), "{a:e} * {b:e}: {:e}", mul_down(a, b));
        assert!(is_rounded_up(mul_up(a, b), &product), "{a:e} * {b:e}: {:e}", mul_up(a, b));
        if b != 0.0 {
            let quotient = &x / &y;
            assert!(is_rounded_down(div_down(a, b), &quotient), "{a:e} / {b:e}: {:e}", div_down(a, b));
            assert!(is_rounded_up(div_up(a, b), &quotient), "{a:e} / {b:e}: {:e}", div_up(a, b));
            assert_eq!(rational_down(&quotient), div_down(a, b), "{a:e} / {b:e}");
            assert_eq!(rational_up(&quotient), div_up(a, b), "{a:e} / {b:e}");
        }
    }
}

#[test]
fn roots_are_tight() {
    let mut rng = Rng::with_seed(2);
    for _ in 0..cases(3000) {
        let x = number(&mut rng).abs();
        let (down, up) = (sqrt_down(x), sqrt_up(x));
        let value = exact(x);
        let square = |r: f64| exact(r) * exact(r);
        assert!(square(down) <= value && square(down.next_up()) > value, "sqrt({x:e}) down {down:e}");
        assert!(square(up) >= value, "sqrt({x:e}) up {up:e}");
        assert!(up == 0.0 || square(up.next_down()) < value, "sqrt({x:e}) up {up:e}");
    }
}

#[test]
fn f32_is_the_tightest() {
    let mut rng = Rng::with_seed(3);
    for i in 0..cases(5000) {
        let x = if i % 2 == 0 { number(&mut rng) } else { f64::from(f32::from_bits(rng.u32(..))) * (1.0 + 1e-9) };
        if x.is_nan() {
            continue;
        }
        let (down, up) = (f32_down(x), f32_up(x));
        assert!(f64::from(down) <= x && (down == f32::INFINITY || f64::from(down.next_up()) > x), "{x:e}");
        assert!(f64::from(up) >= x && (up == f32::NEG_INFINITY || f64::from(up.next_down()) < x), "{x:e}");
    }
    assert_eq!((f32_down(1e300), f32_up(1e300)), (f32::MAX, f32::INFINITY));
    assert_eq!((f32_down(-1e300), f32_up(-1e300)), (f32::NEG_INFINITY, f32::MIN));
    assert_eq!((f32_down(1e-300), f32_up(1e-300)), (0.0, f32::from_bits(1)));
    assert_eq!(f32_down(INF), f32::INFINITY);
}

#[test]
fn rationals_of_every_size_are_tight() {
    let mut rng = Rng::with_seed(4);
    for _ in 0..cases(3000) {
        let bits = |rng: &mut Rng| {
            let length = rng.u32(1..70);
            BigInt::from(rng.u128(..) >> (128 - length)) + 1
        };
        let (n, d) = (bits(&mut rng), bits(&mut rng));
        let (up, down) = (rng.u32(0..1200), rng.u32(0..1200));
        let sign = if rng.bool() { 1 } else { -1 };
        let x = BigRational::new((n * sign) << up, d << down);
        assert!(is_rounded_down(rational_down(&x), &x), "{x}");
        assert!(is_rounded_up(rational_up(&x), &x), "{x}");
    }
    // Ties, the largest number and its overflow threshold, the least subnormal and half of it.
    let max = exact(MAX);
    let unit = exact(2f64.powi(970));
    for (x, down, up) in [
        (BigRational::zero(), 0.0, 0.0),
        (max.clone(), MAX, MAX),
        (&max + &unit, MAX, INF),
        (-(&max + &unit), -INF, -MAX),
        (exact(TINY), TINY, TINY),
        (exact(TINY) / exact(2.0), 0.0, TINY),
        (-exact(TINY) / exact(3.0), -TINY, 0.0),
        (exact(1.0) / exact(10.0), 0.1f64.next_down(), 0.1),
        (exact(1.0) - exact(2f64.powi(-54)), 1f64.next_down(), 1.0),
    ] {
        assert_eq!((rational_down(&x), rational_up(&x)), (down, up), "{x}");
    }
}

/// Overflow, infinite bounds and 0 * inf = 0.
#[test]
fn ends_of_the_range() {
    assert_eq!((add_down(MAX, MAX), add_up(MAX, MAX)), (MAX, INF));
    assert_eq!((add_down(-MAX, -MAX), add_up(-MAX, -MAX)), (-INF, -MAX));
    assert_eq!((add_down(-INF, MAX), add_up(INF, -MAX)), (-INF, INF));
    assert_eq!((sub_down(MAX, -TINY), sub_up(MAX, -TINY)), (MAX, INF));
    assert_eq!((mul_down(MAX, 2.0), mul_up(MAX, 2.0)), (MAX, INF));
    assert_eq!((mul_down(MAX, -2.0), mul_up(MAX, -2.0)), (-INF, -MAX));
    assert_eq!((mul_down(0.0, INF), mul_up(-INF, -0.0)), (0.0, 0.0));
    assert_eq!((mul_down(INF, TINY), mul_up(-INF, TINY)), (INF, -INF));
    assert_eq!((mul_down(TINY, TINY), mul_up(TINY, TINY)), (0.0, TINY));
    assert_eq!((mul_down(TINY, -TINY), mul_up(TINY, -TINY)), (-TINY, 0.0));
    assert_eq!((div_down(MAX, 0.5), div_up(MAX, 0.5)), (MAX, INF));
    assert_eq!((div_down(TINY, 2.0), div_up(TINY, 2.0)), (0.0, TINY));
    assert_eq!((div_down(1.0, INF), div_up(-1.0, INF)), (0.0, 0.0));
    assert_eq!((div_down(INF, 2.0), div_up(INF, -2.0)), (INF, -INF));
    assert_eq!((sqrt_down(INF), sqrt_up(INF)), (INF, INF));
    assert_eq!((sqrt_down(0.0), sqrt_up(0.0)), (0.0, 0.0));
}
