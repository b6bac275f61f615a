//! Tables of special values, from the rules of IEEE 1788: empties, unbounded sets, zeros, poles and ends of domains.

use super::set;
use crate::interval::Verdict::{Proved, Refuted, Unknown};
use crate::interval::{Interval, Verdict};

const INF: f64 = f64::INFINITY;
const NAN: f64 = f64::NAN;
const MAX: f64 = f64::MAX;
const TINY: f64 = 5e-324;
/// 2^1023.
const LARGEST_POWER: f64 = 2.0 / f64::MIN_POSITIVE;
const BELOW_HALF: f64 = 0.5f64.next_down();
/// Upper bounds of pi and pi/2, and a lower one.
const PI: f64 = std::f64::consts::PI.next_up();
const BELOW_HALF_PI: f64 = std::f64::consts::FRAC_PI_2.next_down();
const HALF_PI: f64 = std::f64::consts::FRAC_PI_2.next_up();

/// Rows of an argument and the expected result; NaN stands for the empty set.
type Rows = &'static [[f64; 4]];
/// Rows of two arguments and the expected result.
type PairRows = &'static [[f64; 6]];
type Unary = fn(Interval) -> Interval;
type Binary = fn(Interval, Interval) -> Interval;

#[test]
fn functions_of_one_argument() {
    let table: &[(&str, Unary, Rows)] = &[
        ("neg", |x| -x, &[[1.0, 2.0, -2.0, -1.0], [-INF, 0.0, 0.0, INF], [-INF, INF, -INF, INF]]),
        (
            "recip",
            Interval::recip,
            &[
                [0.0, 0.0, NAN, NAN],
                [0.0, 1.0, 1.0, INF],
                [-1.0, 0.0, -INF, -1.0],
                [-1.0, 1.0, -INF, INF],
                [2.0, INF, 0.0, 0.5],
                [-INF, -4.0, -0.25, 0.0],
                [-INF, INF, -INF, INF],
            ],
        ),
        (
            "sqr",
            Interval::sqr,
            &[[-2.0, 1.0, 0.0, 4.0], [-3.0, -2.0, 4.0, 9.0], [-INF, INF, 0.0, INF], [TINY, TINY, 0.0, TINY]],
        ),
        ("abs", Interval::abs, &[[-2.0, 1.0, 0.0, 2.0], [-3.0, -2.0, 2.0, 3.0], [-INF, -1.0, 1.0, INF]]),
        (
            "sqrt",
            Interval::sqrt,
            &[[-4.0, 4.0, 0.0, 2.0], [-2.0, -1.0, NAN, NAN], [0.0, INF, 0.0, INF], [-1.0, 0.0, 0.0, 0.0]],
        ),
        ("powi 0", |x| x.powi(0), &[[-1.0, 1.0, 1.0, 1.0], [0.0, 0.0, 1.0, 1.0], [-INF, INF, 1.0, 1.0]]),
        ("powi 3", |x| x.powi(3), &[[-2.0, 3.0, -8.0, 27.0], [-INF, 0.0, -INF, 0.0], [1e200, 1e200, MAX, INF]]),
        ("powi 4", |x| x.powi(4), &[[-2.0, 1.0, 0.0, 16.0], [-3.0, -2.0, 16.0, 81.0], [-INF, INF, 0.0, INF]]),
        (
            "powi -1",
            |x| x.powi(-1),
            &[[0.0, 0.0, NAN, NAN], [-1.0, 0.0, -INF, -1.0], [-1.0, 2.0, -INF, INF], [2.0, 4.0, 0.25, 0.5]],
        ),
        (
            "powi -2",
            |x| x.powi(-2),
            &[[0.0, 0.0, NAN, NAN], [-1.0, 2.0, 0.25, INF], [-4.0, -2.0, 0.0625, 0.25], [-INF, INF, 0.0, INF]],
        ),
        ("x^(1/2)", |x| x.pow_rational(1, 2), &[[-1.0, 9.0, 0.0, 3.0], [-2.0, -1.0, NAN, NAN]]),
        ("x^(-1/2)", |x| x.pow_rational(-2, 4), &[[-1.0, 4.0, 0.5, INF], [-1.0, 0.0, NAN, NAN], [4.0, INF, 0.0, 0.5]]),
        ("x^(1/3)", |x| x.pow_rational(1, 3), &[[-8.0, 27.0, -2.0, 3.0], [-INF, INF, -INF, INF]]),
        ("x^(2/3)", |x| x.pow_rational(2, 3), &[[-8.0, 1.0, 0.0, 4.0], [-27.0, -8.0, 4.0, 9.0]]),
        (
            "x^(-1/3)",
            |x| x.pow_rational(-1, 3),
            &[[-8.0, 1.0, -INF, INF], [-8.0, 0.0, -INF, -0.5], [0.0, 8.0, 0.5, INF]],
        ),
        ("x^(1/0)", |x| x.pow_rational(1, 0), &[[1.0, 2.0, NAN, NAN]]),
        ("sign", Interval::sign, &[[-2.0, 0.0, -1.0, 0.0], [-INF, INF, -1.0, 1.0], [TINY, 1.0, 1.0, 1.0]]),
        ("floor", Interval::floor, &[[-1.5, 1.5, -2.0, 1.0], [-INF, 0.5, -INF, 0.0], [-TINY, 0.0, -1.0, 0.0]]),
        ("ceil", Interval::ceil, &[[-1.5, 1.5, -1.0, 2.0], [0.5, INF, 1.0, INF], [-0.5, -0.5, 0.0, 0.0]]),
        ("round", Interval::round, &[[-1.5, 2.5, -2.0, 3.0], [BELOW_HALF, 0.5, 0.0, 1.0], [-0.5, -0.25, -1.0, 0.0]]),
        ("trunc", Interval::trunc, &[[-1.5, 1.5, -1.0, 1.0], [-INF, -0.5, -INF, 0.0]]),
        (
            "exp",
            Interval::exp,
            &[
                [0.0, 0.0, 1.0, 1.0],
                [-INF, 0.0, 0.0, 1.0],
                [-INF, INF, 0.0, INF],
                [710.0, 710.0, MAX, INF],
                [-1e9, -800.0, 0.0, TINY],
            ],
        ),
        (
            "exp2",
            Interval::exp2,
            &[
                [-2.0, 3.0, 0.25, 8.0],
                [-1074.0, 1023.0, TINY, LARGEST_POWER],
                [-1075.0, 1024.0, 0.0, INF],
                [-INF, INF, 0.0, INF],
            ],
        ),
        ("exp10", Interval::exp10, &[[0.0, 22.0, 1.0, 1e22], [-INF, INF, 0.0, INF], [309.0, 310.0, MAX, INF]]),
        ("expm1", Interval::expm1, &[[0.0, 0.0, 0.0, 0.0], [-INF, 0.0, -1.0, 0.0], [-INF, INF, -1.0, INF]]),
        (
            "ln",
            Interval::ln,
            &[[1.0, 1.0, 0.0, 0.0], [0.0, 1.0, -INF, 0.0], [-1.0, 0.0, NAN, NAN], [-INF, INF, -INF, INF]],
        ),
        (
            "log2",
            Interval::log2,
            &[[0.25, 8.0, -2.0, 3.0], [TINY, LARGEST_POWER, -1074.0, 1023.0], [-1.0, 1.0, -INF, 0.0]],
        ),
        ("log10", Interval::log10, &[[1.0, 1e22, 0.0, 22.0], [100.0, 1000.0, 2.0, 3.0], [0.0, 0.0, NAN, NAN]]),
        ("log1p", Interval::log1p, &[[0.0, 0.0, 0.0, 0.0], [-1.0, 0.0, -INF, 0.0], [-2.0, -1.0, NAN, NAN]]),
        (
            "sin",
            Interval::sin,
            &[
                [0.0, 0.0, 0.0, 0.0],
                [-INF, INF, -1.0, 1.0],
                [0.0, 7.0, -1.0, 1.0],
                [-2.0, 2.0, -1.0, 1.0],
                [0.0, 1e300, -1.0, 1.0],
            ],
        ),
        (
            "cos",
            Interval::cos,
            &[[0.0, 0.0, 1.0, 1.0], [1.0, INF, -1.0, 1.0], [-4.0, 1.0, -1.0, 1.0], [3.0, 9.5, -1.0, 1.0]],
        ),
        (
            "tan",
            Interval::tan,
            &[[0.0, 0.0, 0.0, 0.0], [1.5, 1.6, -INF, INF], [-1.0, 3.0, -INF, INF], [1.0, INF, -INF, INF]],
        ),
        ("asin", Interval::asin, &[[0.0, 0.0, 0.0, 0.0], [1.5, 2.0, NAN, NAN], [-2.0, 0.0, -HALF_PI, 0.0]]),
        ("acos", Interval::acos, &[[1.0, 1.0, 0.0, 0.0], [1.0, 2.0, 0.0, 0.0], [-2.0, -1.5, NAN, NAN]]),
        ("atan", Interval::atan, &[[0.0, 0.0, 0.0, 0.0], [0.0, INF, 0.0, HALF_PI], [-INF, 0.0, -HALF_PI, 0.0]]),
        ("sinh", Interval::sinh, &[[0.0, 0.0, 0.0, 0.0], [-INF, INF, -INF, INF], [0.0, 1000.0, 0.0, INF]]),
        ("cosh", Interval::cosh, &[[0.0, 0.0, 1.0, 1.0], [-INF, 1.0, 1.0, INF], [-1000.0, 0.0, 1.0, INF]]),
        ("tanh", Interval::tanh, &[[0.0, 0.0, 0.0, 0.0], [-INF, INF, -1.0, 1.0], [0.0, 100.0, 0.0, 1.0]]),
        ("asinh", Interval::asinh, &[[0.0, 0.0, 0.0, 0.0], [-INF, INF, -INF, INF]]),
        (
            "acosh",
            Interval::acosh,
            &[[1.0, 1.0, 0.0, 0.0], [-1.0, 1.0, 0.0, 0.0], [-1.0, 0.5, NAN, NAN], [0.0, INF, 0.0, INF]],
        ),
        (
            "atanh",
            Interval::atanh,
            &[
                [0.0, 0.0, 0.0, 0.0],
                [-1.0, 1.0, -INF, INF],
                [1.0, 2.0, NAN, NAN],
                [-2.0, -1.0, NAN, NAN],
                [-1.0, 0.0, -INF, 0.0],
            ],
        ),
    ];
    for (name, function, rows) in table {
        for [a, b, lo, hi] in *rows {
            assert_eq!(function(set(*a, *b)), set(*lo, *hi), "{name} [{a:e}, {b:e}]");
        }
        assert!(function(Interval::EMPTY).is_empty(), "{name} of the empty set");
    }
}

#[test]
fn functions_of_two_arguments() {
    let table: &[(&str, Binary, PairRows)] = &[
        ("+", |x, y| x + y, &[[-INF, 1.0, 2.0, INF, -INF, INF], [MAX, MAX, MAX, MAX, MAX, INF]]),
        ("-", |x, y| x - y, &[[1.0, INF, 1.0, INF, -INF, INF], [1.0, 2.0, 0.5, 4.0, -3.0, 1.5]]),
        (
            "*",
            |x, y| x * y,
            &[
                [0.0, 0.0, -INF, INF, 0.0, 0.0],
                [0.0, 1.0, 2.0, INF, 0.0, INF],
                [-1.0, 0.0, 2.0, INF, -INF, 0.0],
                [-2.0, 3.0, -5.0, 7.0, -15.0, 21.0],
                [-2.0, 3.0, -5.0, -1.0, -15.0, 10.0],
                [-3.0, -2.0, -5.0, 7.0, -21.0, 15.0],
                [-3.0, -2.0, -5.0, -1.0, 2.0, 15.0],
                [-INF, INF, 0.0, 1.0, -INF, INF],
                [-INF, -1.0, -INF, -1.0, 1.0, INF],
            ],
        ),
        (
            "/",
            |x, y| x / y,
            &[
                [1.0, 1.0, 0.0, 1.0, 1.0, INF],
                [1.0, 1.0, -1.0, 0.0, -INF, -1.0],
                [1.0, 1.0, -1.0, 1.0, -INF, INF],
                [1.0, 1.0, 0.0, 0.0, NAN, NAN],
                [0.0, 0.0, 0.0, 0.0, NAN, NAN],
                [0.0, 0.0, -1.0, 1.0, 0.0, 0.0],
                [0.0, 0.0, 0.0, 1.0, 0.0, 0.0],
                [0.0, 1.0, 0.0, 2.0, 0.0, INF],
                [-1.0, 1.0, 0.0, 2.0, -INF, INF],
                [-4.0, -2.0, 0.0, 2.0, -INF, -1.0],
                [-4.0, -2.0, -2.0, 0.0, 1.0, INF],
                [1.0, INF, 1.0, INF, 0.0, INF],
                [-INF, -1.0, 1.0, 2.0, -INF, -0.5],
                [-INF, INF, 1.0, 2.0, -INF, INF],
                [-6.0, 4.0, 2.0, 4.0, -3.0, 2.0],
                [-6.0, 4.0, -4.0, -2.0, -2.0, 3.0],
            ],
        ),
        ("min", Interval::min, &[[0.0, 3.0, 1.0, 2.0, 0.0, 2.0], [-INF, 3.0, 1.0, INF, -INF, 3.0]]),
        ("max", Interval::max, &[[0.0, 3.0, 1.0, 2.0, 1.0, 3.0], [-INF, 3.0, 1.0, INF, 1.0, INF]]),
        (
            "hypot",
            Interval::hypot,
            &[[-3.0, 3.0, 4.0, 4.0, 4.0, 5.0], [0.0, INF, -1.0, 1.0, 0.0, INF], [MAX, MAX, MAX, MAX, MAX, INF]],
        ),
        (
            "mod",
            Interval::modulo,
            &[
                [5.5, 5.5, 2.0, 2.0, 1.5, 1.5],
                [-0.5, -0.5, 2.0, 2.0, 1.5, 1.5],
                [5.5, 5.5, -2.0, -2.0, -0.5, -0.5],
                [2.5, 3.5, 2.0, 2.0, 0.5, 1.5],
                [2.5, 4.5, 2.0, 2.0, 0.0, 2.0],
                [6.0, 6.5, 2.5, 3.0, 0.0, 1.5],
                [0.0, 0.5, 1.0, INF, 0.0, 0.5],
                [0.0, 5.0, 0.0, 1.0, 0.0, 1.0],
                [0.0, 0.0, -1.0, 1.0, 0.0, 0.0],
                [1.0, 2.0, 0.0, 0.0, NAN, NAN],
                [1.0, 8.0, -3.0, 2.0, -3.0, 2.0],
                [-INF, INF, 3.0, 3.0, 0.0, 3.0],
            ],
        ),
        (
            "pow",
            Interval::pow,
            &[
                [0.0, 0.0, -1.0, 0.0, NAN, NAN],
                [0.0, 0.0, -1.0, 1.0, 0.0, 0.0],
                [-2.0, -1.0, 2.0, 2.0, NAN, NAN],
                [-2.0, 3.0, 2.0, 2.0, 0.0, 9.0],
                [0.0, 1.0, 0.0, 0.0, 1.0, 1.0],
                [0.0, 0.5, -1.0, 1.0, 0.0, INF],
                [2.0, 4.0, -1.0, 0.5, 0.25, 2.0],
                [1.0, 1.0, -INF, INF, 1.0, 1.0],
                [0.5, 2.0, -INF, INF, 0.0, INF],
                [0.0, 0.5, 1.0, INF, 0.0, 0.5],
                [2.0, INF, -INF, -1.0, 0.0, 0.5],
                [-INF, INF, -INF, INF, 0.0, INF],
            ],
        ),
        (
            "atan2",
            |y, x| y.atan2(x),
            &[
                [0.0, 0.0, 0.0, 0.0, NAN, NAN],
                [0.0, 0.0, 0.0, 1.0, 0.0, 0.0],
                [0.0, 0.0, -1.0, 1.0, 0.0, PI],
                [0.0, 0.0, -2.0, -1.0, std::f64::consts::PI, PI],
                [-1.0, 0.0, -2.0, -1.0, -PI, PI],
                [-1.0, 1.0, -2.0, 3.0, -PI, PI],
                [-INF, INF, 0.0, INF, -HALF_PI, HALF_PI],
                [0.0, INF, -INF, INF, 0.0, PI],
                [-1.0, 0.0, 0.0, 1.0, -HALF_PI, 0.0],
                [-2.0, -1.0, 0.0, 0.0, -HALF_PI, -BELOW_HALF_PI],
            ],
        ),
    ];
    for (name, function, rows) in table {
        for [a, b, c, d, lo, hi] in *rows {
            assert_eq!(function(set(*a, *b), set(*c, *d)), set(*lo, *hi), "[{a:e}, {b:e}] {name} [{c:e}, {d:e}]");
        }
        for (x, y) in [(Interval::EMPTY, Interval::ONE), (Interval::ONE, Interval::EMPTY)] {
            assert!(function(x, y).is_empty(), "{name} of an empty set");
        }
    }
}

#[test]
fn functions_of_three_arguments() {
    let (x, one) = (set(-1.0, 3.0), Interval::ONE);
    assert_eq!(x.clamp(Interval::ZERO, one), Interval::UNIT);
    assert_eq!(x.clamp(set(2.0, 2.0), one), set(2.0, 2.0));
    assert_eq!(x.mul_add(x, one), set(-2.0, 10.0));
    assert_eq!(set(-INF, 1.0).mul_add(one, one), set(-INF, 2.0));
    assert_eq!(set(1.0, INF).mul_add(one, set(-INF, 0.0)), Interval::ENTIRE);
    assert!(x.mul_add(one, Interval::EMPTY).is_empty());
}

#[test]
fn constructors_refuse_what_is_no_interval() {
    for (lo, hi) in [(1.0, 0.0), (INF, INF), (-INF, -INF), (NAN, 1.0), (0.0, NAN)] {
        assert_eq!(Interval::new(lo, hi), None, "{lo}, {hi}");
    }
    for x in [INF, -INF, NAN] {
        assert!(Interval::point(x).is_empty());
    }
    assert!(Interval::new(-0.0, -0.0).unwrap().lo().is_sign_positive());
    assert!((-Interval::ZERO).hi().is_sign_positive());
    // f64::consts::PI is 1.22e-16 short of pi = 3.14159265358979323846264338..., less than a unit in its last place.
    assert_eq!((Interval::PI.lo().to_bits(), Interval::PI.hi().to_bits()), (0x400921fb54442d18, 0x400921fb54442d19));
    assert_eq!(Interval::HALF_PI + Interval::HALF_PI, Interval::PI);
}

#[test]
fn numbers_of_a_set() {
    let table: &[(Interval, f64, f64, f64, f64, f64)] = &[
        // set, middle, radius, width, largest and least size
        (set(-1.0, 3.0), 1.0, 2.0, 4.0, 3.0, 0.0),
        (set(-5.0, -2.0), -3.5, 1.5, 3.0, 5.0, 2.0),
        (Interval::ENTIRE, 0.0, INF, INF, INF, 0.0),
        (set(2.0, INF), MAX, INF, INF, INF, 2.0),
        (set(-INF, -2.0), -MAX, INF, INF, INF, 2.0),
        (set(MAX / 2.0, MAX), 0.75 * MAX, MAX / 4.0, MAX / 2.0, MAX, MAX / 2.0),
        (set(-MAX, MAX), 0.0, MAX, INF, MAX, 0.0),
        (set(0.0, TINY), 0.0, TINY, TINY, TINY, 0.0),
    ];
    for (x, mid, rad, width, mag, mig) in table {
        assert_eq!((x.mid(), x.width(), x.mag(), x.mig()), (*mid, *width, *mag, *mig), "{x}");
        assert!(x.rad() >= *rad && x.rad() <= rad.next_up(), "{x}: {:e}", x.rad());
    }
    let empty = Interval::EMPTY;
    for x in [empty.mid(), empty.rad(), empty.width(), empty.mag(), empty.mig(), empty.lo(), empty.hi()] {
        assert!(x.is_nan());
    }
}

#[test]
fn relations_of_sets() {
    let (x, empty, entire) = (set(0.0, 2.0), Interval::EMPTY, Interval::ENTIRE);
    assert_eq!(empty, Interval::EMPTY);
    assert!(empty.is_empty() && !empty.is_bounded() && !empty.is_singleton() && !empty.is_entire());
    assert!(x.contains(2.0) && !x.contains(2.5) && !x.contains(NAN) && !entire.contains(INF) && !empty.contains(0.0));
    assert!(x.contains_interval(set(0.0, 1.0)) && !x.contains_interval(set(0.0, 3.0)));
    assert!(x.contains_interval(empty) && empty.contains_interval(empty) && !empty.contains_interval(x));
    assert!(x.contains_in_interior(set(0.5, 1.0)) && !x.contains_in_interior(set(0.0, 1.0)));
    assert!(entire.contains_in_interior(entire) && empty.contains_in_interior(empty) && !empty.contains_in_interior(x));
    assert!(x.disjoint(set(3.0, 4.0)) && !x.disjoint(set(2.0, 4.0)) && x.disjoint(empty));
    assert_eq!(x.intersect(set(1.0, INF)), set(1.0, 2.0));
    assert_eq!(x.intersect(set(2.5, INF)), empty);
    assert_eq!(x.intersect(empty), empty);
    assert_eq!(x.hull(set(5.0, 6.0)), set(0.0, 6.0));
    assert_eq!((x.hull(empty), empty.hull(x)), (x, x));
}

#[test]
fn questions_have_three_answers() {
    let table: &[([f64; 4], [Verdict; 3])] = &[
        // sets, less, less or equal, equal
        ([0.0, 1.0, 2.0, 3.0], [Proved, Proved, Refuted]),
        ([2.0, 3.0, 0.0, 1.0], [Refuted, Refuted, Refuted]),
        ([0.0, 1.0, 1.0, 2.0], [Unknown, Proved, Unknown]),
        ([1.0, 2.0, 0.0, 1.0], [Refuted, Unknown, Unknown]),
        ([1.0, 1.0, 1.0, 1.0], [Refuted, Proved, Proved]),
        ([0.0, 1.0, 0.0, 1.0], [Unknown, Unknown, Unknown]),
        ([-INF, INF, 0.0, 1.0], [Unknown, Unknown, Unknown]),
        ([NAN, NAN, 0.0, 1.0], [Unknown, Unknown, Unknown]),
        ([0.0, 1.0, NAN, NAN], [Unknown, Unknown, Unknown]),
        ([NAN, NAN, NAN, NAN], [Unknown, Unknown, Unknown]),
    ];
    for ([a, b, c, d], answers) in table {
        let (x, y) = (set(*a, *b), set(*c, *d));
        assert_eq!([x.less(y), x.less_equal(y), x.equal(y)], *answers, "{x} {y}");
    }
    let signs = |x: Interval| [x.is_positive(), x.is_negative(), x.is_nonnegative(), x.is_zero()];
    assert_eq!(signs(set(TINY, 1.0)), [Proved, Refuted, Proved, Refuted]);
    assert_eq!(signs(set(0.0, 1.0)), [Unknown, Refuted, Proved, Unknown]);
    assert_eq!(signs(Interval::ZERO), [Refuted, Refuted, Proved, Proved]);
    assert_eq!(signs(set(-1.0, 1.0)), [Unknown; 4]);
    assert_eq!(signs(Interval::EMPTY), [Unknown; 4]);
    assert_eq!((Proved.and(Unknown), Refuted.and(Unknown), Proved.and(Proved)), (Unknown, Refuted, Proved));
    assert_eq!((Proved.or(Unknown), Refuted.or(Unknown), Refuted.or(Refuted)), (Proved, Unknown, Refuted));
    assert_eq!((Proved.negate(), Refuted.negate(), Unknown.negate()), (Refuted, Proved, Unknown));
    let truth = [Proved, Refuted, Unknown].map(Verdict::to_interval);
    assert_eq!(truth, [Interval::ONE, Interval::ZERO, Interval::UNIT]);
}
