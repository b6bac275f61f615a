//! Powers: those with a rational exponent by comparing q-th powers of the bounds with the p-th power of the argument.

use super::{big, cases, exact, interval, members, number, part};
use crate::interval::{Decorated, Decoration, Interval};
use astro_float::{BigFloat, Consts, RoundingMode};
use fastrand::Rng;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{Pow, Signed};

/// Whether b <= x^(p/q) for x in the domain and p/q in lowest terms. For odd q, powers with exponent q keep the
/// order; for even q both sides are nonnegative or the bound is trivial.
fn is_at_most(b: f64, x: f64, p: i32, q: u32) -> bool {
    if b.is_infinite() {
        return b < 0.0;
    }
    if q.is_multiple_of(2) && b < 0.0 {
        return true;
    }
    let power: BigRational = Pow::pow(exact(x), p);
    Pow::pow(exact(b), q) <= power
}

fn is_at_least(b: f64, x: f64, p: i32, q: u32) -> bool {
    if b.is_infinite() {
        return b > 0.0;
    }
    let power: BigRational = Pow::pow(exact(x), p);
    !(q.is_multiple_of(2) && b < 0.0) && Pow::pow(exact(b), q) >= power
}

fn in_domain(x: f64, p: i32, q: u32) -> bool {
    (x != 0.0 || p >= 0) && (x >= 0.0 || q % 2 == 1)
}

#[test]
fn rational_powers_are_tight() {
    let mut rng = Rng::with_seed(30);
    for i in 0..cases(2500) {
        let mut q = if i % 3 == 0 { rng.u32(1..12) } else { 1 };
        let mut p = rng.i32(-12..13);
        let divisor = q.gcd(&p.unsigned_abs());
        (p, q) = (p / divisor as i32, q / divisor);
        let scale = rng.u32(1..4);
        let power = |x: Interval| x.pow_rational(p * scale as i32, q * scale);
        let x = interval(&mut rng);
        let y = power(x);
        let decorated = Decorated::new(x).pow_rational(p, q);
        assert_eq!(decorated.interval(), y);
        for a in members(&mut rng, x) {
            let point = power(Interval::point(a));
            if !in_domain(a, p, q) {
                assert!(point.is_empty() && decorated.decoration() == Decoration::Trv, "{a:e}^({p}/{q})");
                continue;
            }
            assert!(is_at_most(y.lo(), a, p, q) && is_at_least(y.hi(), a, p, q), "{a:e}^({p}/{q}) is not in {y}");
            let (lo, hi) = (point.lo(), point.hi());
            assert!(is_at_most(lo, a, p, q) && is_at_least(hi, a, p, q), "{a:e}^({p}/{q}) is not in {point}");
            assert!(!is_at_most(lo.next_up(), a, p, q), "{a:e}^({p}/{q}): {point}");
            assert!(!is_at_least(hi.next_down(), a, p, q), "{a:e}^({p}/{q}): {point}");
        }
        assert!(y.contains_interval(power(part(&mut rng, x))), "{x}^({p}/{q})");
    }
}

/// Whole exponents up to 64 take the fast path wherever it decides; near 1 nothing overflows.
#[test]
fn whole_powers_are_tight() {
    let mut rng = Rng::with_seed(31);
    for _ in 0..cases(1500) {
        let p = rng.i32(2..65) * if rng.bool() { 1 } else { -1 };
        let a = match rng.u32(0..3) {
            0 => 1.0 + f64::from(rng.i32(-1000..1000)) / 1024.0,
            1 => f64::from(rng.i32(1..50)),
            _ => 0.5 + 4.0 * rng.f64(),
        };
        let point = Interval::point(a).powi(p);
        let (lo, hi) = (point.lo(), point.hi());
        assert!(is_at_most(lo, a, p, 1) && is_at_least(hi, a, p, 1), "{a:e}^{p} is not in {point}");
        assert!(!is_at_most(lo.next_up(), a, p, 1) && !is_at_least(hi.next_down(), a, p, 1), "{a:e}^{p}: {point}");
    }
}

const PRECISION: usize = 320;

/// x^(p/q) for x > 0 to nearly 320 bits.
fn high_power(x: f64, y: &BigFloat, cc: &mut Consts) -> BigFloat {
    big(x).pow(y, PRECISION, RoundingMode::ToEven, cc)
}

/// The value, within three neighbours of both bounds.
fn assert_near(point: Interval, value: &BigFloat, what: &str) {
    let compare = |x: f64| big(x).cmp(value).expect("a number");
    assert!(compare(point.lo()) <= 0 && compare(point.hi()) >= 0, "{what} = {value} is not in {point}");
    let lo = (0..4).fold(point.lo(), |x, _| x.next_up());
    let hi = (0..4).fold(point.hi(), |x, _| x.next_down());
    // Beyond its exponents the oracle says infinity, meaning a large real number.
    assert!((lo == f64::INFINITY || compare(lo) > 0) && compare(hi) < 0, "{what} = {value}: {point}");
}

#[test]
fn large_fractions_are_enclosed() {
    let mut cc = Consts::new().unwrap();
    let mut rng = Rng::with_seed(32);
    for _ in 0..cases(400) {
        let (p, q) = (rng.i32(-2000..2000), rng.u32(301..2000));
        // An exponent that is a multiple of 1/32 at most can give an exact value, which 320 bits do not tell from its
        // neighbours.
        if p == 0 || q / q.gcd(&p.unsigned_abs()) <= 150 {
            continue;
        }
        let x = number(&mut rng).abs();
        if x == 0.0 || x == 1.0 {
            continue;
        }
        let exponent =
            BigFloat::from_i32(p, PRECISION).div(&BigFloat::from_u32(q, 64), PRECISION, RoundingMode::ToEven);
        let value = high_power(x, &exponent, &mut cc);
        let point = Interval::point(x).pow_rational(p, q);
        if point.hi().is_finite() {
            assert_near(point, &value, &format!("{x:e}^({p}/{q})"));
        }
    }
}

#[test]
fn real_powers_enclose_their_values() {
    let mut cc = Consts::new().unwrap();
    let mut rng = Rng::with_seed(33);
    for _ in 0..cases(800) {
        let (x, y) = (interval(&mut rng), interval(&mut rng));
        let z = Decorated::new(x).pow(Decorated::new(y));
        for (a, b) in members(&mut rng, x).into_iter().zip(members(&mut rng, y)) {
            if !(a > 0.0 || a == 0.0 && b > 0.0) {
                assert!(z.decoration() == Decoration::Trv, "{x}^{y}: {z}");
                continue;
            }
            let point = Interval::point(a).pow(Interval::point(b));
            // Sixteenths may give exact values: rationals decide those.
            let sixteenths = b * 16.0;
            if a == 0.0 || a == 1.0 || sixteenths.abs() < 300.0 && sixteenths.fract() == 0.0 {
                let (p, q) = (sixteenths as i32, 16);
                let exactly = a == 0.0 && point == Interval::ZERO || a == 1.0 && point == Interval::ONE;
                let encloses = |y: Interval| is_at_most(y.lo(), a, p, q) && is_at_least(y.hi(), a, p, q);
                assert!(exactly || encloses(point), "{a:e}^{b:e} is not in {point}");
                assert!(z.interval().contains_interval(point) || encloses(z.interval()), "{a:e}^{b:e} is not in {z}");
                continue;
            }
            let value = high_power(a, &big(b), &mut cc);
            assert_near(point, &value, &format!("{a:e}^{b:e}"));
            let (lo, hi) = (big(z.interval().lo()), big(z.interval().hi()));
            assert!(lo.cmp(&value).unwrap() <= 0 && hi.cmp(&value).unwrap() >= 0, "{a:e}^{b:e} is not in {z}");
        }
    }
}

#[test]
fn exact_powers_stay_exact() {
    let point = Interval::point;
    assert_eq!(point(3.0).powi(5), point(243.0));
    assert_eq!(point(-3.0).powi(3), point(-27.0));
    assert_eq!(point(2.0).powi(-1074), point(5e-324));
    assert_eq!(point(2.0).powi(1023), point(2f64.powi(1023)));
    assert_eq!(point(27.0).cbrt(), point(3.0));
    assert_eq!(point(-8.0).pow_rational(2, 3), point(4.0));
    assert_eq!(point(-8.0).pow_rational(-1, 3), point(-0.5));
    assert_eq!(point(2.25).pow(point(1.5)), point(3.375));
    assert_eq!(point(16.0).pow(point(-0.25)), point(0.5));
    assert_eq!(point(1.0).pow_rational(i32::MIN, u32::MAX), Interval::ONE);
    assert!(
        exact(1.5).is_positive() && point(1.5).powi(i32::MIN).contains_interval(Interval::new(0.0, 5e-324).unwrap())
    );
}
