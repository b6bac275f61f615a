//! Decorations from the definitions of IEEE 1788, 8.8 and 11.

use super::set;
use crate::interval::Decoration::{Com, Dac, Def, Ill, Trv};
use crate::interval::{Decorated, Decoration, Interval, Verdict};

const INF: f64 = f64::INFINITY;
const NAN: f64 = f64::NAN;

fn bare(lo: f64, hi: f64) -> Decorated {
    Decorated::new(set(lo, hi))
}

#[test]
fn constructors_keep_the_invariant() {
    assert_eq!(bare(0.0, 1.0).decoration(), Com);
    assert_eq!(bare(0.0, INF).decoration(), Dac);
    assert_eq!(Decorated::new(Interval::EMPTY).decoration(), Trv);
    assert_eq!(Decorated::with(set(0.0, 1.0), Ill), Decorated::ILL);
    assert_eq!(Decorated::with(set(0.0, INF), Com).decoration(), Dac);
    assert_eq!(Decorated::with(set(0.0, 1.0), Def).to_string(), "[0, 1]_def");
    assert!(Ill < Trv && Trv < Def && Def < Dac && Dac < Com);
}

#[test]
fn functions_of_one_argument() {
    type Function = fn(Decorated) -> Decorated;
    let table: &[(Function, f64, f64, Decoration)] = &[
        (Decorated::sqrt, 0.0, 4.0, Com),
        (Decorated::sqrt, -1.0, 4.0, Trv),
        (Decorated::sqrt, 0.0, INF, Dac),
        (Decorated::recip, 1.0, 2.0, Com),
        (Decorated::recip, 0.0, 2.0, Trv),
        (Decorated::ln, 5e-324, 2.0, Com),
        (Decorated::ln, 0.0, 2.0, Trv),
        (Decorated::exp, 0.0, 1000.0, Dac),
        (Decorated::exp, 0.0, 700.0, Com),
        (Decorated::tan, -1.5, 1.5, Com),
        (Decorated::tan, 1.5, 1.6, Trv),
        (Decorated::tan, 1.6, 4.7, Com),
        (Decorated::tan, 1.6, 4.8, Trv),
        (Decorated::sin, 0.0, INF, Dac),
        (Decorated::asin, -1.0, 1.0, Com),
        (Decorated::asin, -1.1, 1.0, Trv),
        (Decorated::acosh, 1.0, 2.0, Com),
        (Decorated::acosh, 0.9, 2.0, Trv),
        (Decorated::atanh, -0.5, 1f64.next_down(), Com),
        (Decorated::atanh, -0.5, 1.0, Trv),
        (Decorated::log1p, -1.0, 1.0, Trv),
        (Decorated::sign, -1.0, 1.0, Def),
        (Decorated::sign, 0.0, 1.0, Def),
        (Decorated::sign, 0.0, 0.0, Dac),
        (Decorated::sign, 0.5, 1.0, Com),
        (Decorated::floor, 1.2, 1.8, Com),
        (Decorated::floor, 1.0, 1.8, Dac),
        (Decorated::floor, 1.2, 2.0, Def),
        (Decorated::floor, -0.5, 0.5, Def),
        (Decorated::floor, 0.0, INF, Def),
        (Decorated::ceil, 1.2, 1.8, Com),
        (Decorated::ceil, 1.2, 2.0, Dac),
        (Decorated::ceil, 1.0, 1.8, Def),
        (Decorated::round, -0.25, 0.25, Com),
        (Decorated::round, 0.5, 1.0, Dac),
        (Decorated::round, 0.25, 0.5, Def),
        (Decorated::round, -0.5, -0.5, Dac),
        (Decorated::round_ties_even, 0.75, 1.25, Com),
        (Decorated::round_ties_even, 1.5, 2.5, Dac),
        (Decorated::round_ties_even, 0.5, 0.75, Def),
        (Decorated::trunc, -0.5, 0.5, Com),
        (Decorated::trunc, 1.0, 1.5, Dac),
        (Decorated::trunc, -1.5, -1.0, Dac),
        (Decorated::trunc, 0.0, 0.5, Com),
        (Decorated::trunc, 0.5, 1.0, Def),
        (Decorated::rsqrt, 0.0, 1.0, Trv),
        (Decorated::rsqrt, 5e-324, 1.0, Com),
        (Decorated::log2p1, -1.0, 1.0, Trv),
        (Decorated::log10p1, -0.5, 1.0, Com),
        (Decorated::exp2m1, 0.0, 2000.0, Dac),
        (Decorated::exp10m1, -INF, 0.0, Dac),
        (|x| x.rootn(3), -8.0, 8.0, Com),
        (|x| x.rootn(4), -8.0, 8.0, Trv),
        (|x| x.rootn(-3), -8.0, 8.0, Trv),
        (|x| x.powi(-2), -1.0, 1.0, Trv),
        (|x| x.powi(-2), 1.0, 2.0, Com),
        (|x| x.pow_rational(2, 6), -1.0, 1.0, Com),
        (|x| x.pow_rational(1, 6), -1.0, 1.0, Trv),
        (|x| x.pow_rational(0, 2), -1.0, 1.0, Com),
        (|x| -x, -1.0, INF, Dac),
    ];
    for (i, (function, lo, hi, decoration)) in table.iter().enumerate() {
        assert_eq!(function(bare(*lo, *hi)).decoration(), *decoration, "row {i}: [{lo}, {hi}]");
        assert_eq!(function(Decorated::with(set(*lo, *hi), Trv)).decoration(), Trv, "row {i}");
        assert_eq!(function(Decorated::ILL), Decorated::ILL, "row {i}");
        assert_eq!(function(Decorated::new(Interval::EMPTY)).decoration(), Trv, "row {i}");
    }
}

#[test]
fn functions_of_two_arguments() {
    type Function = fn(Decorated, Decorated) -> Decorated;
    let table: &[(Function, [f64; 4], Decoration)] = &[
        (|x, y| x / y, [1.0, 2.0, 0.0, 1.0], Trv),
        (|x, y| x / y, [1.0, 2.0, 0.5, 1.0], Com),
        (|x, y| x * y, [1e200, 1e300, 1e200, 1e300], Dac),
        (|x, y| x + y, [1.0, 2.0, 3.0, INF], Dac),
        (Decorated::pow, [0.0, 1.0, 1.0, 2.0], Com),
        (Decorated::pow, [0.0, 1.0, 0.0, 2.0], Trv),
        (Decorated::pow, [-1.0, 1.0, 1.0, 2.0], Trv),
        (Decorated::pow, [0.5, 1.0, -1.0, 2.0], Com),
        (Decorated::atan2, [-1.0, 1.0, 0.5, 1.0], Com),
        (Decorated::atan2, [-1.0, 1.0, -1.0, 1.0], Trv),
        (Decorated::atan2, [-1.0, 1.0, -2.0, -1.0], Def),
        (Decorated::atan2, [-1.0, 0.0, -2.0, -1.0], Def),
        (Decorated::atan2, [0.0, 1.0, -2.0, -1.0], Dac),
        (Decorated::atan2, [0.5, 1.0, -2.0, 1.0], Com),
        (Decorated::atan2, [0.0, 1.0, 0.5, 1.0], Com),
        (Decorated::modulo, [0.25, 0.5, 1.0, 1.0], Com),
        (Decorated::modulo, [0.0, 0.5, 1.0, 1.0], Dac),
        (Decorated::modulo, [0.5, 1.0, 1.0, 1.0], Def),
        (Decorated::modulo, [0.5, 1.0, 0.0, 1.0], Trv),
        (Decorated::modulo, [1.25, 1.5, -1.0, -1.0], Com),
        (Decorated::less, [0.0, 1.0, 2.0, 3.0], Com),
        (Decorated::less, [0.0, 1.0, 0.0, 0.0], Dac),
        (Decorated::less, [0.0, 1.0, 1.0, 3.0], Def),
        (Decorated::less_equal, [0.0, 1.0, 1.0, 3.0], Dac),
        (Decorated::equal, [0.0, 0.0, 0.0, 0.0], Dac),
        (Decorated::equal, [0.0, 0.0, 1.0, 2.0], Com),
        (Decorated::equal, [0.0, 1.0, 1.0, 2.0], Def),
        (Decorated::min, [0.0, 1.0, 1.0, 2.0], Com),
        (|x, y| y.clamp(x, x), [0.0, 1.0, 1.0, 2.0], Com),
        (|x, y| x.mul_add(y, y), [0.0, 1.0, 1.0, INF], Dac),
    ];
    for (i, (function, [a, b, c, d], decoration)) in table.iter().enumerate() {
        let (x, y) = (bare(*a, *b), bare(*c, *d));
        assert_eq!(function(x, y).decoration(), *decoration, "row {i}");
        assert_eq!(function(x, Decorated::with(y.interval(), Trv)).decoration(), Trv, "row {i}");
        assert_eq!(function(Decorated::ILL, y), Decorated::ILL, "row {i}");
        assert_eq!(function(x, Decorated::new(Interval::EMPTY)).decoration(), Trv, "row {i}");
    }
}

/// Operations on sets know nothing about a function; what is no interval stays none.
#[test]
fn set_operations_are_trivial() {
    type Function = fn(Decorated, Decorated) -> Decorated;
    let table: &[(Function, [f64; 2])] = &[
        (Decorated::intersect, [1.0, 2.0]),
        (Decorated::hull, [0.0, 4.0]),
        (Decorated::cancel_minus, [-INF, INF]),
        (|x, y| y.cancel_minus(x), [1.0, 2.0]),
        (|x, y| y.cancel_plus(-x), [1.0, 2.0]),
        (Decorated::sqr_rev, [1.0, 2f64.sqrt()]),
        (Decorated::abs_rev, [1.0, 2.0]),
        (|c, x| c.powi_rev(x, 1), [1.0, 2.0]),
        (|c, x| c.pow_rational_rev(x, 2, 2), [1.0, 2.0]),
        (|b, c| b.mul_rev(c, c), [1.0, 4.0]),
        (|b, c| b.mul_rev_to_pair(c)[1], [NAN, NAN]),
    ];
    let (x, y) = (bare(0.0, 2.0), bare(1.0, 4.0));
    for (i, (function, [lo, hi])) in table.iter().enumerate() {
        let result = function(x, y);
        assert!(result.interval().contains_interval(set(*lo, *hi)) && result.decoration() == Trv, "row {i}: {result}");
        assert_eq!(result.interval().is_empty(), lo.is_nan(), "row {i}: {result}");
        assert_eq!(function(Decorated::ILL, y), Decorated::ILL, "row {i}");
        assert_eq!(function(x, Decorated::ILL), Decorated::ILL, "row {i}");
    }
    type Reverse = fn(Decorated, Decorated) -> Decorated;
    let reverses: [Reverse; 9] = [
        Decorated::sin_rev,
        Decorated::cos_rev,
        Decorated::tan_rev,
        Decorated::cosh_rev,
        |a, x| a.pow_rev1(x, x),
        |a, x| a.pow_rev2(x, x),
        |a, x| a.atan2_rev1(x, x),
        |a, x| a.atan2_rev2(x, x),
        |a, x| x.mul_rev(x, a),
    ];
    for (i, function) in reverses.iter().enumerate() {
        assert_eq!(function(x, y).decoration(), Trv, "row {i}");
        assert_eq!(function(Decorated::ILL, y), Decorated::ILL, "row {i}");
        assert_eq!(function(x, Decorated::ILL), Decorated::ILL, "row {i}");
        assert_eq!(function(x, Decorated::EMPTY), Decorated::EMPTY, "row {i}");
    }
    // A quotient by numbers away from 0 is a function.
    assert_eq!(y.mul_rev_to_pair(x), [Decorated::with(set(0.0, 2.0), Com), Decorated::EMPTY]);
    assert_eq!(x.mul_rev_to_pair(y), [Decorated::with(set(0.5, INF), Trv), Decorated::EMPTY]);
}

#[test]
fn nothing_is_true_of_what_is_no_interval() {
    let (x, ill) = (bare(0.0, 2.0), Decorated::ILL);
    type Relation = fn(Decorated, Decorated) -> bool;
    let relations: [Relation; 12] = [
        Decorated::same_set,
        Decorated::subset,
        Decorated::interior,
        Decorated::weakly_less,
        Decorated::strict_less,
        Decorated::precedes,
        Decorated::strict_precedes,
        Decorated::disjoint,
        |x, _| x.is_empty(),
        |x, _| x.is_entire() || x.is_bounded() || x.is_singleton(),
        |x, _| x.contains(0.0),
        |x, y| x.overlap(y).is_some(),
    ];
    for (i, relation) in relations.iter().enumerate() {
        assert!(!relation(ill, ill) && !relation(ill, x), "row {i}");
        assert!(i > 7 || !relation(x, ill), "row {i}");
    }
    for number in [ill.inf(), ill.sup(), ill.mid(), ill.rad(), ill.width(), ill.mag(), ill.mig(), ill.mid_rad().0] {
        assert!(number.is_nan());
    }
    assert!(ill.is_nai() && !x.is_nai() && !Decorated::EMPTY.is_nai());
    assert_eq!((Decorated::EMPTY.inf(), Decorated::EMPTY.sup(), x.mid_rad()), (INF, -INF, (1.0, 1.0)));
    // Decorations do not count.
    assert!(x.same_set(Decorated::with(x.interval(), Trv)) && Decorated::EMPTY.same_set(Decorated::EMPTY));
}

#[test]
fn an_undecided_choice_is_defined_at_most() {
    let (a, b) = (bare(0.0, 1.0), bare(3.0, 4.0).floor());
    assert_eq!(Decorated::select(Verdict::Proved, a, b), a);
    assert_eq!(Decorated::select(Verdict::Refuted, a, b), b);
    assert_eq!(Decorated::select(Verdict::Unknown, a, b), Decorated::with(set(0.0, 4.0), Def));
    let undefined = bare(-1.0, 1.0).sqrt();
    assert_eq!(Decorated::select(Verdict::Unknown, a, undefined).decoration(), Trv);
    assert_eq!(Decorated::select(Verdict::Proved, a, undefined), a);
}
