//! The four operations and their kin against exact rationals: containment, inclusion and tightness on every box.

use super::{cases, exact, interval, is_rounded_down, is_rounded_up, members, number, part};
use crate::interval::{Interval, decimal};
use fastrand::Rng;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::Zero;

fn holds(y: Interval, value: &BigRational) -> bool {
    let above = y.lo() == f64::NEG_INFINITY || exact(y.lo()) <= *value;
    let below = y.hi() == f64::INFINITY || exact(y.hi()) >= *value;
    !y.is_empty() && above && below
}

struct Binary {
    name: &'static str,
    plain: fn(Interval, Interval) -> Interval,
    value: fn(&BigRational, &BigRational) -> Option<BigRational>,
}

fn remainder(x: &BigRational, y: &BigRational) -> Option<BigRational> {
    (!y.is_zero()).then(|| x - y * (x / y).floor())
}

const TABLE: &[Binary] = &[
    Binary { name: "+", plain: |x, y| x + y, value: |x, y| Some(x + y) },
    Binary { name: "-", plain: |x, y| x - y, value: |x, y| Some(x - y) },
    Binary { name: "*", plain: |x, y| x * y, value: |x, y| Some(x * y) },
    Binary { name: "/", plain: |x, y| x / y, value: |x, y| (!y.is_zero()).then(|| x / y) },
    Binary { name: "min", plain: Interval::min, value: |x, y| Some(x.min(y).clone()) },
    Binary { name: "max", plain: Interval::max, value: |x, y| Some(x.max(y).clone()) },
    Binary { name: "mod", plain: Interval::modulo, value: remainder },
];

#[test]
fn binary_operations_enclose_their_values() {
    for op in TABLE {
        let mut rng = Rng::with_seed(20);
        for _ in 0..cases(800) {
            let (x, y) = (interval(&mut rng), interval(&mut rng));
            let z = (op.plain)(x, y);
            for (a, b) in members(&mut rng, x).into_iter().zip(members(&mut rng, y)) {
                if let Some(value) = (op.value)(&exact(a), &exact(b)) {
                    assert!(holds(z, &value), "{a:e} {} {b:e} is not in {z}, of {x} and {y}", op.name);
                }
            }
            let (inner_x, inner_y) = (part(&mut rng, x), part(&mut rng, y));
            let inner = (op.plain)(inner_x, inner_y);
            assert!(z.contains_interval(inner), "{x} {} {y} = {z} is not around {inner}", op.name);
        }
    }
}

#[test]
fn binary_operations_are_tight_on_points() {
    for op in TABLE {
        let mut rng = Rng::with_seed(21);
        for _ in 0..cases(1500) {
            let (a, b) = (number(&mut rng), number(&mut rng));
            let z = (op.plain)(Interval::point(a), Interval::point(b));
            match (op.value)(&exact(a), &exact(b)) {
                None => assert!(z.is_empty(), "{a:e} {} {b:e} = {z}", op.name),
                // A quotient of 2^53 and more leaves the remainder's floor open.
                Some(value) if op.name == "mod" && (exact(a) / exact(b)).floor().numer().bits() > 53 => {
                    assert!(holds(z, &value), "{a:e} mod {b:e} is not in {z}");
                }
                Some(value) => {
                    let tight = is_rounded_down(z.lo(), &value) && is_rounded_up(z.hi(), &value);
                    assert!(tight, "{a:e} {} {b:e} = {z}", op.name);
                }
            }
        }
    }
}

/// Bounded boxes away from a zero divisor take their extremes at corners.
#[test]
fn boxes_are_tight() {
    let mut rng = Rng::with_seed(22);
    for _ in 0..cases(1500) {
        let (x, y) = (interval(&mut rng), interval(&mut rng));
        if !x.is_bounded() || !y.is_bounded() {
            continue;
        }
        for op in &TABLE[..4] {
            if op.name == "/" && y.contains(0.0) {
                continue;
            }
            let z = (op.plain)(x, y);
            let corners = [(x.lo(), y.lo()), (x.lo(), y.hi()), (x.hi(), y.lo()), (x.hi(), y.hi())];
            let values = corners.map(|(a, b)| (op.value)(&exact(a), &exact(b)).unwrap());
            assert!(is_rounded_down(z.lo(), values.iter().min().unwrap()), "{x} {} {y} = {z}", op.name);
            assert!(is_rounded_up(z.hi(), values.iter().max().unwrap()), "{x} {} {y} = {z}", op.name);
        }
    }
}

#[test]
fn fused_and_hypotenuse_are_tight() {
    let mut rng = Rng::with_seed(23);
    for _ in 0..cases(1500) {
        let (x, y, z) = (interval(&mut rng), interval(&mut rng), interval(&mut rng));
        let (fused, length) = (x.mul_add(y, z), x.hypot(y));
        let points = members(&mut rng, x).into_iter().zip(members(&mut rng, y)).zip(members(&mut rng, z));
        for ((a, b), c) in points {
            let value = exact(a) * exact(b) + exact(c);
            assert!(holds(fused, &value), "{a:e} * {b:e} + {c:e} is not in {fused}");
            let point = Interval::point(a).mul_add(Interval::point(b), Interval::point(c));
            let tight = is_rounded_down(point.lo(), &value) && is_rounded_up(point.hi(), &value);
            assert!(tight, "{a:e} * {b:e} + {c:e} = {point}");

            // sqrt is increasing: compare squares.
            let value = exact(a) * exact(a) + exact(b) * exact(b);
            assert!(holds(length.sqr(), &value), "hypot({a:e}, {b:e}) is not in {length}");
            let point = Interval::point(a).hypot(Interval::point(b));
            let square = |t: f64| if t.is_infinite() { None } else { Some(exact(t) * exact(t)) };
            assert!(square(point.lo()).unwrap() <= value, "hypot({a:e}, {b:e}) = {point}");
            assert!(square(point.hi()).is_none_or(|s| s >= value), "hypot({a:e}, {b:e}) = {point}");
            assert!(square(point.lo().next_up()).is_none_or(|s| s > value), "hypot({a:e}, {b:e}) = {point}");
            assert!(
                point.hi() == 0.0 || square(point.hi().next_down()).unwrap() < value,
                "hypot({a:e}, {b:e}) = {point}"
            );
        }
    }
}

#[test]
fn a_middle_and_its_radius_cover_the_set() {
    let mut rng = Rng::with_seed(24);
    for _ in 0..cases(4000) {
        let x = interval(&mut rng);
        let (mid, rad) = (x.mid(), x.rad());
        assert!(x.contains(mid), "mid {x} = {mid:e}");
        if x.is_bounded() && rad.is_finite() {
            assert!(exact(mid) - exact(rad) <= exact(x.lo()) && exact(mid) + exact(rad) >= exact(x.hi()), "{x}");
            assert!(is_rounded_up(x.width(), &(exact(x.hi()) - exact(x.lo()))), "{x}");
        }
    }
}

#[test]
fn rationals_are_enclosed_tightly() {
    let tenth = BigRational::new(BigInt::from(1), BigInt::from(10));
    assert_eq!(Interval::from_rational(&tenth), Interval::new(0.1f64.next_down(), 0.1).unwrap());
    assert_eq!(Interval::from_rational(&exact(0.75)), Interval::point(0.75));
}

#[test]
fn text_reads_back() {
    let mut rng = Rng::with_seed(25);
    for _ in 0..cases(4000) {
        let x = number(&mut rng);
        assert_eq!(decimal(x).parse::<f64>().unwrap().to_bits(), x.to_bits());
    }
    assert_eq!(decimal(f64::NEG_INFINITY), "-inf");
    assert_eq!(Interval::new(-1.0, 1e300).unwrap().to_string(), "[-1, 1e300]");
    assert_eq!(Interval::new(-0.0, f64::INFINITY).unwrap().to_string(), "[0, inf]");
    assert_eq!(Interval::EMPTY.to_string(), "[empty]");
    assert_eq!(Interval::ENTIRE.to_string(), "[entire]");
}
