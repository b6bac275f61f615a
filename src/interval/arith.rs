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

    fn add(self, b: Self) -> Self {
        if self.is_empty() || b.is_empty() {
            return Self::EMPTY;
        }
        Self::raw(round::add_down(self.lo, b.lo), round::add_up(self.hi, b.hi))
    }
}

impl Sub for Interval {
    type Output = Self;

    fn sub(self, b: Self) -> Self {
        self + -b
    }
}

impl Mul for Interval {
    type Output = Self;

    /// The product is bilinear, so its extremes are at corners; signs say at which:
    ///
    /// | a \ b | b >= 0 | b <= 0 | 0 inside b |
    /// |---|---|---|---|
    /// | a >= 0 | al bl, ah bh | ah bl, al bh | ah bl, ah bh |
    /// | a <= 0 | negate a, then negate the result | | |
    /// | 0 inside a | exchange a and b | | min(al bh, ah bl), max(al bl, ah bh) |
    fn mul(self, b: Self) -> Self {
        let a = self;
        if a.is_empty() || b.is_empty() {
            return Self::EMPTY;
        }
        let (down, up) = (round::mul_down, round::mul_up);
        if a.lo >= 0.0 {
            let low = if b.lo >= 0.0 { a.lo } else { a.hi };
            let high = if b.hi <= 0.0 { a.lo } else { a.hi };
            Self::raw(down(low, b.lo), up(high, b.hi))
        } else if a.hi <= 0.0 {
            -(-a * b)
        } else if b.lo >= 0.0 || b.hi <= 0.0 {
            b * a
        } else {
            Self::raw(down(a.lo, b.hi).min(down(a.hi, b.lo)), up(a.lo, b.lo).max(up(a.hi, b.hi)))
        }
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
    /// 1 / x for x != 0.
    pub fn recip(self) -> Self {
        Self::ONE / self
    }

    /// x^2; tighter than `x * x`, whose factors are taken as independent.
    pub fn sqr(self) -> Self {
        if self.is_empty() {
            return self;
        }
        let (mig, mag) = (self.mig(), self.mag());
        Self::raw(round::mul_down(mig, mig), round::mul_up(mag, mag))
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

    /// x y + z, rounded once.
    pub fn mul_add(self, y: Self, z: Self) -> Self {
        if self.is_empty() || y.is_empty() || z.is_empty() {
            return Self::EMPTY;
        }
        let mut bounds = (f64::INFINITY, f64::NEG_INFINITY);
        // Bilinear in (x, y) and increasing in z: the extremes are at corners.
        for (a, b) in [(self.lo, y.lo), (self.lo, y.hi), (self.hi, y.lo), (self.hi, y.hi)] {
            // An infinite bound of z settles that side, whatever the product.
            let low = if z.lo.is_infinite() { z.lo } else { exact::mul_add(a, b, z.lo).0 };
            let high = if z.hi.is_infinite() { z.hi } else { exact::mul_add(a, b, z.hi).1 };
            bounds = (bounds.0.min(low), bounds.1.max(high));
        }
        Self::raw(bounds.0, bounds.1)
    }
}
