//! Step functions and the remainder.

use super::{Interval, exact, round};

/// The quotient's floor is decided exactly below this: all whole numbers up to here are `f64`s, so that the floor of
/// the quotient rounded down is the floor of the real quotient.
const WHOLE: f64 = round::pow2(53);

impl Interval {
    /// The values of a function that never decreases and is exact in `f64`; infinite bounds stay.
    fn step(self, f: impl Fn(f64) -> f64) -> Self {
        if self.is_empty() { self } else { Self::raw(f(self.lo), f(self.hi)) }
    }

    /// -1, 0 or 1.
    pub fn sign(self) -> Self {
        self.step(|x| if x == 0.0 { 0.0 } else { x.signum() })
    }

    /// The greatest whole number not above x.
    pub fn floor(self) -> Self {
        self.step(f64::floor)
    }

    /// The least whole number not below x.
    pub fn ceil(self) -> Self {
        self.step(f64::ceil)
    }

    /// IEEE 1788 `roundTiesToEven`: the nearest whole number, the even one of two.
    pub fn round_ties_even(self) -> Self {
        self.step(f64::round_ties_even)
    }

    /// IEEE 1788 `roundTiesToAway`: the nearest whole number, halves away from zero, as `f64::round`.
    pub fn round(self) -> Self {
        self.step(f64::round)
    }

    /// The whole part, towards zero.
    pub fn trunc(self) -> Self {
        self.step(f64::trunc)
    }

    /// The floored remainder x - y floor(x/y) for y != 0: in [0, y) for y > 0 and in (y, 0] for y < 0.
    pub fn modulo(self, y: Self) -> Self {
        if self.is_empty() || y.is_empty() {
            return Self::EMPTY;
        }
        // mod(x, -y) = -mod(-x, y).
        let negative = -(-self).modulo_positive(-y);
        negative.hull(self.modulo_positive(y))
    }

    /// The remainder for the part of `y` above 0.
    fn modulo_positive(self, y: Self) -> Self {
        let y = y.intersect(Self::NONNEGATIVE);
        if y.is_empty() || y == Self::ZERO {
            return Self::EMPTY;
        }
        // In [0, y), and no greater than x where x >= 0.
        let range = Self::raw(0.0, if self.lo >= 0.0 { self.hi.min(y.hi) } else { y.hi });
        match self.quotient_floor(y) {
            Some(0.0) => self.intersect(range),
            Some(k) => {
                // x - k y is increasing in x and monotone in y.
                let (first, last) = if k > 0.0 { (y.hi, y.lo) } else { (y.lo, y.hi) };
                if last.is_infinite() || first.is_infinite() {
                    return range;
                }
                Self::raw(exact::mul_add(-k, first, self.lo).0, exact::mul_add(-k, last, self.hi).1).intersect(range)
            }
            None => range,
        }
    }

    /// floor(x/y) if it is the same for all members, for y in [0, inf] without 0.
    pub(super) fn quotient_floor(self, y: Self) -> Option<f64> {
        // x/y has its least value where x is least: at the greatest y for x >= 0, else at the least. y -> 0 sends it
        // to an infinity, y -> inf to 0 from the side of x.
        let floor = |x: f64, y: f64| {
            if x == 0.0 {
                0.0
            } else if y == 0.0 || x.is_infinite() {
                x * f64::INFINITY
            } else if y.is_infinite() {
                if x < 0.0 { -1.0 } else { 0.0 }
            } else {
                round::div_down(x, y).floor()
            }
        };
        let least = floor(self.lo, if self.lo >= 0.0 { y.hi } else { y.lo });
        let greatest = floor(self.hi, if self.hi >= 0.0 { y.lo } else { y.hi });
        (least == greatest && least.abs() < WHOLE).then_some(least)
    }
}
