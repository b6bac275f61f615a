//! Numbers of an interval: where to cut it, and its simplest ones, which are often zeros exactly.

use crate::interval::Interval;

/// What the width of a part of the search interval is measured by: that interval, or the part's own numbers.
pub fn scale(x: Interval, range: Interval) -> f64 {
    range.width().min(x.mag().max(1.0))
}

/// Whether a part of the search interval is as small as is worth it.
pub fn is_small(x: Interval, range: Interval, resolution: f64) -> bool {
    x.is_bounded() && x.width() <= (resolution * scale(x, range)).max(f64::MIN_POSITIVE)
}

/// A number in the middle half of an interval: 0, or the one divisible by the largest power of two.
pub fn simplest(x: Interval) -> Option<f64> {
    let (lo, hi) = match (x.lo() == f64::NEG_INFINITY, x.hi() == f64::INFINITY) {
        (true, true) => return Some(0.0),
        (false, true) => return Some(if x.lo() < 1.0 { 1.0 } else { 2.0 * x.lo() }).filter(|at| at.is_finite()),
        (true, false) => return Some(if x.hi() > -1.0 { -1.0 } else { 2.0 * x.hi() }).filter(|at| at.is_finite()),
        (false, false) => {
            let quarter = x.hi() / 4.0 - x.lo() / 4.0;
            (x.lo() + quarter, x.hi() - quarter)
        }
    };
    (lo <= hi).then(|| simple(lo, hi))
}

/// The number in [lo, hi] that is 0 or divisible by the largest power of two.
pub fn simple(lo: f64, hi: f64) -> f64 {
    match () {
        _ if lo > 0.0 => shortest(lo, hi),
        _ if hi < 0.0 => -shortest(-hi, -lo),
        _ => 0.0,
    }
}

/// The number in [lo, hi], 0 < lo, that is divisible by the largest power of two.
///
/// Positive numbers are ordered as their bits. With different exponents it is the power of two at or below `hi`. Else it is
/// `hi` with all bits cleared after the first one in which the ends differ, which is greater than `lo`, or `lo` itself if
/// that has more zeros at its end.
fn shortest(lo: f64, hi: f64) -> f64 {
    const FRACTION: u32 = f64::MANTISSA_DIGITS - 1;
    let (low, high) = (lo.to_bits(), hi.to_bits());
    if low >= high {
        return lo;
    }
    let first = (low ^ high).ilog2().min(FRACTION);
    if first < FRACTION && low.trailing_zeros() > first {
        return lo;
    }
    f64::from_bits(high >> first << first)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn simple_numbers_are_found_between_the_quarters() {
        let simplest = |lo, hi| simplest(Interval::new(lo, hi).unwrap());
        assert_eq!(simplest(-1.0, 3.0), Some(0.0));
        assert_eq!(simplest(1.0, 4.0), Some(2.0));
        assert_eq!(simplest(-4.0, -1.0), Some(-2.0));
        assert_eq!(simplest(0.3, 0.9), Some(0.5));
        assert_eq!(simplest(0.0, 7.6), Some(4.0));
        assert_eq!(simplest(1.0, 1.5), Some(1.25));
        assert_eq!(simplest(5.0, 5.0), Some(5.0));
        assert_eq!(simplest(f64::NEG_INFINITY, f64::INFINITY), Some(0.0));
        let mut rng = fastrand::Rng::with_seed(7);
        for _ in 0..10_000 {
            let [a, b] = [0, 1].map(|_| (rng.f64() - 0.5) * 2f64.powi(rng.i32(-60..60)));
            let x = Interval::new(a.min(b), a.max(b)).unwrap();
            let at = super::simplest(x).unwrap();
            assert!(x.lo() <= at && at <= x.hi(), "{at:?} in {x}");
        }
    }
}
