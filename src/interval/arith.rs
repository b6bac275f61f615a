//! Arithmetic: every result is the tightest interval that encloses the values.

use super::{Interval, exact, round};
use std::ops::{Add, Div, Mul, Neg, Sub};

impl Neg for Interval {
    type Output = Self;

    fn neg(self) -> Self {
        if self.is_empty() { self } else { Self::raw(-self.hi, -self.lo) }
    }
}

impl Add for Interval {
    type Output = Self;

    #[inline]
    fn add(self, b: Self) -> Self {
        let (lo, hi) = (self.lo + b.lo, self.hi + b.hi);
        let (below, above) = (round::sum_residual(self.lo, b.lo, lo), round::sum_residual(self.hi, b.hi, hi));
        // NaN where a set is empty, or a bound or a sum infinite.
        if !(below + above).is_finite() {
            return self.add_beyond(b);
        }
        // Neither sum is -0.0, since no bound is, and a sum that is 0 has no error.
        Self { lo: if below < 0.0 { lo.next_down() } else { lo }, hi: if above > 0.0 { hi.next_up() } else { hi } }
    }
}

impl Sub for Interval {
    type Output = Self;

    #[inline]
    fn sub(self, b: Self) -> Self {
        // An empty set stays one here, with NaN bounds. Zeros are positive by the sum with +0.0.
        self + Self { lo: 0.0 - b.hi, hi: 0.0 - b.lo }
    }
}

impl Mul for Interval {
    type Output = Self;

    /// The product is bilinear, so its extremes are at corners; signs say at which:
    ///
    /// | a \ b | b >= 0 | b <= 0 | 0 inside b |
    /// |---|---|---|---|
    /// | a >= 0 | al bl, ah bh | ah bl, al bh | ah bl, ah bh |
    /// | a <= 0 | al bh, ah bl | ah bh, al bl | al bh, al bl |
    /// | 0 inside a | al bh, ah bh | ah bl, al bl | min(al bh, ah bl), max(al bl, ah bh) |
    #[inline]
    fn mul(self, b: Self) -> Self {
        let (a, down, up) = (self, round::mul_down, round::mul_up);
        if a.is_empty() || b.is_empty() {
            return Self::EMPTY;
        }
        if a.lo < 0.0 && a.hi > 0.0 && b.lo < 0.0 && b.hi > 0.0 {
            return Self::raw(down(a.lo, b.hi).min(down(a.hi, b.lo)), up(a.lo, b.lo).max(up(a.hi, b.hi)));
        }
        let ((a_least, b_least), (a_greatest, b_greatest)) = a.product_corners(b);
        Self::raw(down(a_least, b_least), up(a_greatest, b_greatest))
    }
}

impl Div for Interval {
    type Output = Self;

    /// The values of x / y for y != 0: empty if `b` is {0}, unbounded where `b` comes near 0. The infinity is chosen by
    /// the sides on which the operands lie, never by the sign of a zero.
    fn div(self, b: Self) -> Self {
        let a = self;
        if a.is_empty() || b.is_empty() || b == Self::ZERO {
            return Self::EMPTY;
        }
        if a == Self::ZERO {
            return Self::ZERO;
        }
        if b.lo < 0.0 {
            return if b.hi <= 0.0 { -a / -b } else { Self::ENTIRE };
        }
        let (down, up) = (round::div_down, round::div_up);
        // From here on b lies in [0, inf] and reaches past 0.
        if b.lo == 0.0 {
            return if a.lo >= 0.0 {
                Self::raw(down(a.lo, b.hi), f64::INFINITY)
            } else if a.hi <= 0.0 {
                Self::raw(f64::NEG_INFINITY, up(a.hi, b.hi))
            } else {
                Self::ENTIRE
            };
        }
        let low = if a.lo >= 0.0 { b.hi } else { b.lo };
        let high = if a.hi <= 0.0 { b.hi } else { b.lo };
        Self::raw(down(a.lo, low), up(a.hi, high))
    }
}

impl Interval {
    #[inline(never)]
    fn add_beyond(self, b: Self) -> Self {
        if self.is_empty() || b.is_empty() {
            return Self::EMPTY;
        }
        Self::raw(round::add_down(self.lo, b.lo), round::add_up(self.hi, b.hi))
    }

    /// Where `a b` is least and where it is greatest, by the table of the product; not if 0 is inside both.
    #[inline(always)]
    fn product_corners(self, b: Self) -> ((f64, f64), (f64, f64)) {
        let a = self;
        let a_least = if b.lo >= 0.0 || a.hi <= 0.0 && b.hi > 0.0 { a.lo } else { a.hi };
        let b_least = if a.lo >= 0.0 || b.hi <= 0.0 && a.hi > 0.0 { b.lo } else { b.hi };
        // The same for a and -b.
        let a_greatest = if b.hi <= 0.0 || a.hi <= 0.0 && b.lo < 0.0 { a.lo } else { a.hi };
        let b_greatest = if a.lo >= 0.0 || b.lo >= 0.0 && a.hi > 0.0 { b.hi } else { b.lo };
        ((a_least, b_least), (a_greatest, b_greatest))
    }

    /// 1 / x for x != 0.
    pub fn recip(self) -> Self {
        Self::ONE / self
    }

    /// x^2; tighter than `x * x`, whose factors are taken as independent.
    pub fn sqr(self) -> Self {
        let (low, high) = if self.lo >= 0.0 {
            (self.lo, self.hi)
        } else if self.hi <= 0.0 {
            (-self.hi, -self.lo)
        } else if self.is_empty() {
            return self;
        } else {
            (0.0, self.hi.max(-self.lo))
        };
        Self::raw(if low == 0.0 { 0.0 } else { round::mul_down(low, low) }, round::mul_up(high, high))
    }

    /// |x|.
    pub fn abs(self) -> Self {
        if self.is_empty() { self } else { Self::raw(self.mig(), self.mag()) }
    }

    /// The square root of the part of the set in [0, inf].
    pub fn sqrt(self) -> Self {
        let x = self.intersect(Self::NONNEGATIVE);
        if x.is_empty() { x } else { Self::raw(round::sqrt_down(x.lo), round::sqrt_up(x.hi)) }
    }

    /// The lesser of x and y.
    pub fn min(self, y: Self) -> Self {
        if self.is_empty() || y.is_empty() {
            return Self::EMPTY;
        }
        Self::raw(self.lo.min(y.lo), self.hi.min(y.hi))
    }

    /// The greater of x and y.
    pub fn max(self, y: Self) -> Self {
        if self.is_empty() || y.is_empty() {
            return Self::EMPTY;
        }
        Self::raw(self.lo.max(y.lo), self.hi.max(y.hi))
    }

    /// max(low, min(x, high)): x held between two limits; `low` wins where the limits cross.
    pub fn clamp(self, low: Self, high: Self) -> Self {
        self.min(high).max(low)
    }

    /// sqrt(x^2 + y^2), without overflow or underflow on the way.
    pub fn hypot(self, y: Self) -> Self {
        if self.is_empty() || y.is_empty() {
            return Self::EMPTY;
        }
        Self::raw(exact::hypot(self.mig(), y.mig()).0, exact::hypot(self.mag(), y.mag()).1)
    }

    /// IEEE 1788 `fma`: x y + z, rounded once.
    pub fn mul_add(self, y: Self, z: Self) -> Self {
        if self.is_empty() || y.is_empty() || z.is_empty() {
            return Self::EMPTY;
        }
        let low = |(a, b): (f64, f64)| exact::mul_add(a, b, z.lo).0;
        let high = |(a, b): (f64, f64)| exact::mul_add(a, b, z.hi).1;
        if self.lo < 0.0 && self.hi > 0.0 && y.lo < 0.0 && y.hi > 0.0 {
            let least = low((self.lo, y.hi)).min(low((self.hi, y.lo)));
            return Self::raw(least, high((self.lo, y.lo)).max(high((self.hi, y.hi))));
        }
        // Increasing in the product: the corners are the same.
        let (least, greatest) = self.product_corners(y);
        Self::raw(low(least), high(greatest))
    }
}
