//! Relations of sets, the numbers of a set and cancellation, row by row from the definitions of IEEE 1788.

use super::{cases, exact, interval, set};
use crate::interval::{Interval, Overlap};
use fastrand::Rng;

const INF: f64 = f64::INFINITY;
const NAN: f64 = f64::NAN;
const MAX: f64 = f64::MAX;
const TINY: f64 = 5e-324;

#[test]
fn relations_of_two_sets() {
    // Sets, then subset, interior, weakly less, strictly less, precedes, strictly precedes, disjoint.
    let table: &[([f64; 4], [u8; 7])] = &[
        ([NAN, NAN, NAN, NAN], [1, 1, 1, 1, 1, 1, 1]),
        ([NAN, NAN, 1.0, 2.0], [1, 1, 0, 0, 1, 1, 1]),
        ([1.0, 2.0, NAN, NAN], [0, 0, 0, 0, 1, 1, 1]),
        ([1.0, 2.0, 1.0, 2.0], [1, 0, 1, 0, 0, 0, 0]),
        ([1.0, 2.0, 0.0, 3.0], [1, 1, 0, 0, 0, 0, 0]),
        ([1.0, 2.0, 1.0, 3.0], [1, 0, 1, 0, 0, 0, 0]),
        ([1.0, 2.0, 2.0, 3.0], [0, 0, 1, 1, 1, 0, 0]),
        ([1.0, 2.0, 3.0, 4.0], [0, 0, 1, 1, 1, 1, 1]),
        ([3.0, 4.0, 1.0, 2.0], [0, 0, 0, 0, 0, 0, 1]),
        ([2.0, 2.0, 2.0, 2.0], [1, 0, 1, 0, 1, 0, 0]),
        ([-INF, INF, -INF, INF], [1, 1, 1, 1, 0, 0, 0]),
        ([-INF, 1.0, -INF, 2.0], [1, 1, 1, 1, 0, 0, 0]),
        ([1.0, INF, 2.0, INF], [0, 0, 1, 1, 0, 0, 0]),
        ([1.0, INF, 1.0, INF], [1, 0, 1, 0, 0, 0, 0]),
        ([-INF, 1.0, 1.0, INF], [0, 0, 1, 1, 1, 0, 0]),
        ([-0.0, 0.0, 0.0, 0.0], [1, 0, 1, 0, 1, 0, 0]),
    ];
    for ([a, b, c, d], expected) in table {
        let (x, y) = (set(*a, *b), set(*c, *d));
        let answers = [
            x.subset(y),
            x.interior(y),
            x.weakly_less(y),
            x.strict_less(y),
            x.precedes(y),
            x.strict_precedes(y),
            x.disjoint(y),
        ];
        assert_eq!(answers.map(u8::from), *expected, "{x} {y}");
    }
}

#[test]
fn overlaps_have_sixteen_states() {
    use Overlap::*;
    let table: &[([f64; 4], Overlap, Overlap)] = &[
        // The state, and the one of the exchanged sets.
        ([NAN, NAN, NAN, NAN], BothEmpty, BothEmpty),
        ([NAN, NAN, 0.0, 1.0], FirstEmpty, SecondEmpty),
        ([0.0, 1.0, 2.0, 3.0], Before, After),
        ([0.0, 1.0, 1.0, 3.0], Meets, MetBy),
        ([0.0, 2.0, 1.0, 3.0], Overlaps, OverlappedBy),
        ([0.0, 2.0, 0.0, 3.0], Starts, StartedBy),
        ([1.0, 2.0, 0.0, 3.0], ContainedBy, Contains),
        ([1.0, 3.0, 0.0, 3.0], Finishes, FinishedBy),
        ([1.0, 3.0, 1.0, 3.0], Equals, Equals),
        // Points meet nothing: they start or finish it.
        ([1.0, 1.0, 1.0, 3.0], Starts, StartedBy),
        ([3.0, 3.0, 1.0, 3.0], Finishes, FinishedBy),
        ([1.0, 1.0, 1.0, 1.0], Equals, Equals),
        ([-INF, 1.0, 1.0, INF], Meets, MetBy),
        ([-INF, INF, 1.0, INF], FinishedBy, Finishes),
        ([-INF, 1.0, -INF, INF], Starts, StartedBy),
        ([-INF, INF, -INF, INF], Equals, Equals),
    ];
    for ([a, b, c, d], there, back) in table {
        let (x, y) = (set(*a, *b), set(*c, *d));
        assert_eq!((x.overlap(y), y.overlap(x)), (*there, *back), "{x} {y}");
    }
}

#[test]
fn bounds_as_the_standard_gives_them() {
    let signs = |x: Interval| (x.inf().is_sign_negative(), x.sup().is_sign_negative());
    assert_eq!((Interval::EMPTY.inf(), Interval::EMPTY.sup()), (INF, -INF));
    assert_eq!((Interval::ENTIRE.inf(), Interval::ENTIRE.sup()), (-INF, INF));
    assert_eq!(signs(Interval::ZERO), (true, false));
    assert_eq!(signs(set(-1.0, -0.0)), (true, false));
    assert_eq!((set(1.0, 2.0).inf(), set(1.0, 2.0).sup()), (1.0, 2.0));
    assert_eq!(set(1.0, 4.0).mid_rad(), (2.5, 1.5));
}

#[test]
fn cancellation() {
    // Sum, what to cancel, and the rest.
    let table: &[[f64; 6]] = &[
        [NAN, NAN, NAN, NAN, NAN, NAN],
        [NAN, NAN, 1.0, 2.0, NAN, NAN],
        [NAN, NAN, 1.0, INF, -INF, INF],
        [1.0, 2.0, NAN, NAN, -INF, INF],
        [1.0, INF, 1.0, 2.0, -INF, INF],
        [1.0, 5.0, 1.0, 2.0, 0.0, 3.0],
        [1.0, 2.0, 1.0, 5.0, -INF, INF],
        [1.0, 2.0, 3.0, 4.0, -2.0, -2.0],
        [-MAX, MAX, -MAX, MAX, 0.0, 0.0],
        [-MAX, MAX, MAX, MAX, -INF, 0.0],
        // Widths that differ by less than a f64 of their size can tell.
        [1.0, 1e300, 0.0, 1e300, -INF, INF],
        [0.0, 1e300, 1.0, 1e300, -1.0, 0.0],
        [0.0, TINY, 0.0, 0.0, 0.0, TINY],
    ];
    for [a, b, c, d, lo, hi] in table {
        let (x, y) = (set(*a, *b), set(*c, *d));
        assert_eq!(x.cancel_minus(y), set(*lo, *hi), "{x} {y}");
        assert_eq!(x.cancel_plus(-y), set(*lo, *hi), "{x} {y}");
    }
}

/// y + (x - y) is around x, and narrower than x itself could not be.
#[test]
fn cancellation_undoes_addition() {
    let mut rng = Rng::with_seed(50);
    for _ in 0..cases(2000) {
        let (x, y) = (interval(&mut rng), interval(&mut rng));
        let z = x.cancel_minus(y);
        if z.is_entire() {
            continue;
        }
        assert!((y + z).contains_interval(x), "{x} {y} {z}");
        for (bound, a, b) in [(-z.lo(), -x.lo(), -y.lo()), (z.hi(), x.hi(), y.hi())] {
            let tighter = bound.next_down();
            assert!(!tighter.is_finite() || exact(tighter) < exact(a) - exact(b), "{x} {y} {z}");
        }
    }
}
