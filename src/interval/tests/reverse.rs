//! Reverse operations: no preimage is lost, bounds are preimages or beside one, and tables of special values.

use super::{cases, interval, members, set};
use crate::interval::Interval;
use fastrand::Rng;

const INF: f64 = f64::INFINITY;
const NAN: f64 = f64::NAN;
const MAX: f64 = f64::MAX;
/// An upper bound of pi.
const PI: f64 = std::f64::consts::PI.next_up();

type Forward = fn(Interval) -> Interval;
type Reverse = fn(Interval, Interval) -> Interval;

const UNARY: &[(&str, Forward, Reverse)] = &[
    ("sqr", Interval::sqr, Interval::sqr_rev),
    ("abs", Interval::abs, Interval::abs_rev),
    ("sin", Interval::sin, Interval::sin_rev),
    ("cos", Interval::cos, Interval::cos_rev),
    ("tan", Interval::tan, Interval::tan_rev),
    ("cosh", Interval::cosh, Interval::cosh_rev),
    ("pown 0", |x| x.powi(0), |c, x| c.powi_rev(x, 0)),
    ("pown 1", |x| x.powi(1), |c, x| c.powi_rev(x, 1)),
    ("pown 3", |x| x.powi(3), |c, x| c.powi_rev(x, 3)),
    ("pown 4", |x| x.powi(4), |c, x| c.powi_rev(x, 4)),
    ("pown -1", |x| x.powi(-1), |c, x| c.powi_rev(x, -1)),
    ("pown -2", |x| x.powi(-2), |c, x| c.powi_rev(x, -2)),
    ("pow 2/3", |x| x.pow_rational(2, 3), |c, x| c.pow_rational_rev(x, 2, 3)),
    ("pow -3/5", |x| x.pow_rational(-3, 5), |c, x| c.pow_rational_rev(x, -3, 5)),
    ("pow 3/2", |x| x.pow_rational(3, 2), |c, x| c.pow_rational_rev(x, 3, 2)),
    ("pow -1/4", |x| x.pow_rational(-2, 8), |c, x| c.pow_rational_rev(x, -2, 8)),
];

#[test]
fn no_preimage_is_lost() {
    for (name, forward, reverse) in UNARY {
        let mut rng = Rng::with_seed(70);
        for _ in 0..cases(600) {
            let x = interval(&mut rng);
            for a in members(&mut rng, x) {
                // The real value lies in its enclosure, and so in every set around that.
                let value = forward(Interval::point(a));
                let c = if rng.bool() { value } else { value.hull(interval(&mut rng)) };
                if !value.is_empty() {
                    let found = reverse(c, x);
                    assert!(found.contains(a), "{name}: {a:e} of {x} has a value in {c}, not found in {found}");
                    assert!(x.contains_interval(found), "{name}: {found} leaves {x}");
                }
            }
        }
    }
}

/// Beside each finite bound of the result lies a number whose value is in the set: nothing tighter is true.
#[test]
fn bounds_are_preimages() {
    for (name, forward, reverse) in UNARY {
        let mut rng = Rng::with_seed(71);
        for _ in 0..cases(400) {
            let (c, x) = (interval(&mut rng), interval(&mut rng));
            let found = reverse(c, x);
            for bound in [found.lo(), found.hi()] {
                // From 1e15 on, the periodic functions keep the bounds of x.
                if !bound.is_finite() || bound.abs() > 1e15 {
                    continue;
                }
                let (below, above) = (0..3).fold((bound, bound), |(a, b), _| (a.next_down(), b.next_up()));
                let beside = set(below, above);
                assert!(!forward(beside).disjoint(c), "{name}: {bound:e} of {found}, {c} and {x}");
            }
        }
    }
}

type Forward2 = fn(Interval, Interval) -> Interval;
type Reverse2 = fn(Interval, Interval, Interval) -> Interval;

#[test]
fn no_preimage_of_two_arguments_is_lost() {
    let table: &[(&str, Forward2, Reverse2)] = &[
        ("mul", |b, x| b * x, |b, c, x| b.mul_rev(c, x)),
        ("pow 1", |b, x| x.pow(b), |b, c, x| b.pow_rev1(c, x)),
        ("pow 2", |a, x| a.pow(x), |a, c, x| a.pow_rev2(c, x)),
        ("atan2 1", |x, y| y.atan2(x), |x, c, y| x.atan2_rev1(c, y)),
        ("atan2 2", |y, x| y.atan2(x), |y, c, x| y.atan2_rev2(c, x)),
        (
            "two-output division",
            |b, x| b * x,
            |b, c, x| {
                let [low, high] = b.mul_rev_to_pair(c);
                assert!(high.is_empty() || low.strict_precedes(high) || low.hi() == 0.0 && high.lo() == 0.0);
                low.intersect(x).hull(high.intersect(x))
            },
        ),
    ];
    for (name, forward, reverse) in table {
        let mut rng = Rng::with_seed(72);
        for _ in 0..cases(1500) {
            let (b, x) = (interval(&mut rng), interval(&mut rng));
            for (first, second) in members(&mut rng, b).into_iter().zip(members(&mut rng, x)) {
                let value = forward(Interval::point(first), Interval::point(second));
                let c = if rng.bool() { value } else { value.hull(interval(&mut rng)) };
                if !value.is_empty() {
                    let found = reverse(b, c, x);
                    assert!(found.contains(second), "{name}: {second:e} with {first:e}: {b}, {c}, {x}: {found}");
                }
            }
        }
    }
}

#[test]
fn special_values_of_one_argument() {
    // The set of values, x, and what is left of x.
    let table: &[(Reverse, &[[f64; 6]])] = &[
        (
            Interval::sqr_rev,
            &[
                [NAN, NAN, -INF, INF, NAN, NAN],
                [-10.0, -1.0, -INF, INF, NAN, NAN],
                [0.0, INF, -INF, INF, -INF, INF],
                [0.0, 0.0, -INF, INF, 0.0, 0.0],
                [4.0, 9.0, -INF, INF, -3.0, 3.0],
                [4.0, 9.0, 0.0, INF, 2.0, 3.0],
                [4.0, 9.0, -2.5, 1.0, -2.5, -2.0],
                [-5.0, 4.0, -1.0, 1.0, -1.0, 1.0],
                [4.0, 9.0, -1.0, 1.0, NAN, NAN],
            ],
        ),
        (
            Interval::abs_rev,
            &[
                [NAN, NAN, -INF, INF, NAN, NAN],
                [-2.0, -1.0, -INF, INF, NAN, NAN],
                [1.0, 2.0, -INF, INF, -2.0, 2.0],
                [1.0, 2.0, -1.5, 0.5, -1.5, -1.0],
                [-1.0, 2.0, 0.0, 5.0, 0.0, 2.0],
                [0.0, INF, -3.0, INF, -3.0, INF],
            ],
        ),
        (
            |c, x| c.powi_rev(x, 0),
            &[[1.0, 1.0, -2.0, 3.0, -2.0, 3.0], [2.0, 3.0, -2.0, 3.0, NAN, NAN], [NAN, NAN, 0.0, 1.0, NAN, NAN]],
        ),
        (
            |c, x| c.powi_rev(x, 3),
            &[[-8.0, 27.0, -INF, INF, -2.0, 3.0], [0.0, 0.0, 1.0, 2.0, NAN, NAN], [-INF, -1.0, -INF, INF, -INF, -1.0]],
        ),
        (
            |c, x| c.powi_rev(x, -2),
            &[
                [0.0, INF, -INF, INF, -INF, INF],
                [0.0, 0.0, -INF, INF, NAN, NAN],
                [-1.0, 0.0, -INF, INF, NAN, NAN],
                [0.25, 1.0, -INF, INF, -2.0, 2.0],
                [0.25, 1.0, 0.0, INF, 1.0, 2.0],
            ],
        ),
        (
            |c, x| c.powi_rev(x, -1),
            &[
                [-INF, INF, -5.0, 5.0, -5.0, 5.0],
                [0.0, 0.0, -5.0, 5.0, NAN, NAN],
                [-INF, 0.0, -1.0, 1.0, -1.0, 0.0],
                [0.5, 1.0, -1.0, 0.5, NAN, NAN],
            ],
        ),
        (
            |c, x| c.pow_rational_rev(x, 2, 3),
            &[[4.0, 4.0, -INF, INF, -8.0, 8.0], [-1.0, -0.5, -INF, INF, NAN, NAN], [4.0, 9.0, 0.0, 30.0, 8.0, 27.0]],
        ),
        (
            |c, x| c.pow_rational_rev(x, 3, 2),
            &[[8.0, 27.0, -INF, INF, 4.0, 9.0], [0.0, 1.0, -1.0, -0.5, NAN, NAN], [1.0, 1.0, -1.0, 5.0, 1.0, 1.0]],
        ),
        (|c, x| c.pow_rational_rev(x, 1, 0), &[[0.0, 1.0, 0.0, 1.0, NAN, NAN]]),
        (
            Interval::sin_rev,
            &[
                [NAN, NAN, -INF, INF, NAN, NAN],
                [1.5, 2.0, -INF, INF, NAN, NAN],
                [0.0, 0.5, -INF, INF, -INF, INF],
                [-1.0, 1.0, -7.0, 9.0, -7.0, 9.0],
                [0.0, 0.0, -0.5, 0.5, 0.0, 0.0],
                [0.5, 1.0, -0.25, 0.25, NAN, NAN],
                [-1.0, -0.5, 0.0, 3.0, NAN, NAN],
            ],
        ),
        (
            Interval::cos_rev,
            &[[-2.0, -1.1, -INF, INF, NAN, NAN], [1.0, 1.0, -1.0, 1.0, 0.0, 0.0], [0.0, 1.0, 2.0, 4.0, NAN, NAN]],
        ),
        (
            Interval::tan_rev,
            &[
                [-INF, INF, 1.0, 9.0, 1.0, 9.0],
                [0.0, 0.0, -1.0, 1.0, 0.0, 0.0],
                [0.0, 0.0, 1.0, 4.0, PI.next_down(), PI],
            ],
        ),
        (
            Interval::cosh_rev,
            &[
                [-3.0, 0.5, -INF, INF, NAN, NAN],
                [0.0, 1.0, -INF, INF, 0.0, 0.0],
                [1.0, INF, -2.0, INF, -2.0, INF],
                [2.0, 3.0, -1.0, 1.0, NAN, NAN],
            ],
        ),
    ];
    for (i, (reverse, rows)) in table.iter().enumerate() {
        for [a, b, c, d, lo, hi] in *rows {
            let (values, x) = (set(*a, *b), set(*c, *d));
            assert_eq!(reverse(values, x), set(*lo, *hi), "function {i}: {values} over {x}");
        }
        assert!(reverse(Interval::UNIT, Interval::EMPTY).is_empty(), "function {i}");
    }
}

/// Where sine, cosine and tangent have their extremes and poles, within a few neighbours.
#[test]
fn turning_points_are_found() {
    let (half, pi) = (Interval::HALF_PI, Interval::PI);
    for (found, place) in [
        (Interval::ONE.sin_rev(set(0.0, 3.0)), half),
        ((-Interval::ONE).cos_rev(set(0.0, 4.0)), pi),
        (set(1e300, INF).tan_rev(set(1.0, 2.0)), half),
        (set(0.0, 0.0).sin_rev(set(3.0, 4.0)), pi),
        (set(0.0, 0.0).cos_rev(set(-2.0, 0.0)), -half),
        (
            set(0.5, 3.0).sin_rev(set(3.0, 100.0)),
            set(std::f64::consts::TAU + 0.5f64.asin(), 31.0 * std::f64::consts::PI - 0.5f64.asin()),
        ),
    ] {
        let slack = 1e-15 * found.mag();
        assert!(found.lo() <= place.lo() + slack && found.lo() >= place.lo() - slack, "{found}, {place}");
        assert!(found.hi() >= place.hi() - 1e-4 && found.hi() <= place.hi() + 1e-4, "{found}, {place}");
    }
}

#[test]
fn two_output_division() {
    // Divisor, dividend, both results.
    let table: &[[f64; 8]] = &[
        [NAN, NAN, 1.0, 2.0, NAN, NAN, NAN, NAN],
        [1.0, 2.0, NAN, NAN, NAN, NAN, NAN, NAN],
        [1.0, 2.0, 4.0, 8.0, 2.0, 8.0, NAN, NAN],
        [-2.0, -1.0, 4.0, 8.0, -8.0, -2.0, NAN, NAN],
        [0.0, 0.0, 1.0, 2.0, NAN, NAN, NAN, NAN],
        [0.0, 0.0, 0.0, 2.0, -INF, INF, NAN, NAN],
        [-1.0, 2.0, 0.0, 2.0, -INF, INF, NAN, NAN],
        [0.0, 2.0, 4.0, 8.0, 2.0, INF, NAN, NAN],
        [-2.0, 0.0, 4.0, 8.0, -INF, -2.0, NAN, NAN],
        [-1.0, 2.0, 4.0, 8.0, -INF, -4.0, 2.0, INF],
        [-1.0, 2.0, -8.0, -4.0, -INF, -2.0, 4.0, INF],
        [-INF, 2.0, 4.0, INF, -INF, 0.0, 2.0, INF],
        [-INF, INF, 4.0, 8.0, -INF, 0.0, 0.0, INF],
        [-1.0, 1.0, MAX, MAX, -INF, -MAX, MAX, INF],
        [1.0, INF, 4.0, 8.0, 0.0, 8.0, NAN, NAN],
    ];
    for [a, b, c, d, first, second, third, fourth] in table {
        let (divisor, dividend) = (set(*a, *b), set(*c, *d));
        let pair = divisor.mul_rev_to_pair(dividend);
        assert_eq!(pair, [set(*first, *second), set(*third, *fourth)], "{dividend} / {divisor}");
        assert_eq!(divisor.mul_rev(dividend, Interval::ENTIRE), pair[0].hull(pair[1]));
    }
    // Both parts narrow x, and the gap between them does too.
    assert_eq!(set(-1.0, 2.0).mul_rev(set(4.0, 8.0), set(-3.0, 3.0)), set(2.0, 3.0));
    assert_eq!(set(-1.0, 2.0).mul_rev(set(4.0, 8.0), set(-3.0, 1.0)), Interval::EMPTY);
}

#[test]
fn special_values_of_two_arguments() {
    let entire = Interval::ENTIRE;
    // x^b for b in [2, 2], [0, 1], {0}.
    assert_eq!(set(2.0, 2.0).pow_rev1(set(4.0, 9.0), entire), set(2.0, 3.0));
    assert_eq!(set(0.0, 1.0).pow_rev1(set(2.0, 3.0), entire), set(2.0, INF));
    assert_eq!(Interval::ZERO.pow_rev1(set(2.0, 3.0), entire), Interval::EMPTY);
    assert_eq!(Interval::ZERO.pow_rev1(set(0.0, 3.0), set(-1.0, 7.0)), set(0.0, 7.0));
    assert_eq!(set(-1.0, -1.0).pow_rev1(set(2.0, 4.0), entire), set(0.25, 0.5));
    assert_eq!(set(1.0, 2.0).pow_rev1(set(-3.0, -1.0), entire), Interval::EMPTY);
    // a^x: 1^x is 1 and 0^x is 0, for x of any size.
    assert_eq!(Interval::ONE.pow_rev2(Interval::ONE, set(-2.0, 3.0)), set(-2.0, 3.0));
    assert_eq!(Interval::ONE.pow_rev2(set(2.0, 3.0), entire), Interval::EMPTY);
    assert_eq!(Interval::ZERO.pow_rev2(Interval::UNIT, entire), set(0.0, INF));
    assert_eq!(Interval::ZERO.pow_rev2(set(0.5, 1.0), entire), Interval::EMPTY);
    assert!(set(2.0, 2.0).pow_rev2(set(4.0, 8.0), entire).contains_interval(set(2.0, 3.0)));
    assert!(set(2.0, 2.0).pow_rev2(set(4.0, 8.0), entire).width() < 1.0 + 1e-14);
    // Angles: the positive y axis, the negative x axis, one quadrant.
    let right = Interval::HALF_PI;
    assert_eq!(Interval::ZERO.atan2_rev1(right, entire), set(0.0, INF));
    assert_eq!(set(1.0, 2.0).atan2_rev1(Interval::ZERO, entire), Interval::ZERO);
    assert_eq!(set(1.0, 2.0).atan2_rev1(set(2.0, 3.0), entire), Interval::EMPTY);
    assert_eq!(set(-2.0, -1.0).atan2_rev1(Interval::ZERO, entire), Interval::EMPTY);
    assert_eq!(Interval::ZERO.atan2_rev2(Interval::ZERO, entire), set(0.0, INF));
    assert!(set(1.0, 1.0).atan2_rev2(right, entire).mag() < 1e-15);
    assert_eq!(set(1.0, 2.0).atan2_rev2(set(-1.0, -0.5), entire), Interval::EMPTY);
    let diagonal = set(1.0, 2.0).atan2_rev1(set(0.78, 0.79), entire);
    assert!(diagonal.contains_interval(set(1.0, 2.0)) && diagonal.lo() > 0.98 && diagonal.hi() < 2.02, "{diagonal}");
}
