//! Numbers that describe a set, and the operations and relations of sets.

use super::{Interval, round};

impl Interval {
    /// IEEE 1788 `inf`: the greatest lower bound, inf if empty. A lower bound of 0 is -0.0, as the standard asks;
    /// [`Interval::lo`] says +0.0 there, and NaN for the empty set.
    pub fn inf(self) -> f64 {
        if self.is_empty() {
            f64::INFINITY
        } else if self.lo == 0.0 {
            -0.0
        } else {
            self.lo
        }
    }

    /// IEEE 1788 `sup`: the least upper bound, -inf if empty.
    pub fn sup(self) -> f64 {
        if self.is_empty() { f64::NEG_INFINITY } else { self.hi }
    }

    /// IEEE 1788 `midRad`: [`Interval::mid`] and [`Interval::rad`].
    pub fn mid_rad(self) -> (f64, f64) {
        (self.mid(), self.rad())
    }

    /// IEEE 1788 `wid`: `hi - lo` rounded up; NaN if empty.
    pub fn width(self) -> f64 {
        round::sub_up(self.hi, self.lo)
    }

    /// A finite member near the middle: 0 for the whole line, the largest finite number for a half line; NaN if empty.
    pub fn mid(self) -> f64 {
        match (self.lo == f64::NEG_INFINITY, self.hi == f64::INFINITY) {
            (true, true) => 0.0,
            (true, false) => f64::MIN,
            (false, true) => f64::MAX,
            (false, false) => {
                // Rounding is monotone, so lo <= mid <= hi; only same-signed large ends overflow, and halves of those
                // are exact.
                let sum = self.lo + self.hi;
                if sum.is_infinite() { 0.5 * self.lo + 0.5 * self.hi } else { 0.5 * sum }
            }
        }
    }

    /// The least `r` with `self` inside [mid - r, mid + r]; inf if unbounded, NaN if empty.
    pub fn rad(self) -> f64 {
        let mid = self.mid();
        round::sub_up(mid, self.lo).max(round::sub_up(self.hi, mid))
    }

    /// The largest absolute value of a member; NaN if empty.
    pub fn mag(self) -> f64 {
        self.lo.abs().max(self.hi.abs())
    }

    /// The least absolute value of a member; NaN if empty.
    pub fn mig(self) -> f64 {
        if self.contains(0.0) { 0.0 } else { self.lo.abs().min(self.hi.abs()) }
    }

    /// IEEE 1788 `isMember`: whether `x` is a member; infinities and NaN never are.
    pub fn contains(self, x: f64) -> bool {
        self.lo <= x && x <= self.hi && x.is_finite()
    }

    /// Whether `other` is a subset; the empty set is one of every set.
    pub fn contains_interval(self, other: Self) -> bool {
        other.is_empty() || self.lo <= other.lo && other.hi <= self.hi
    }

    /// Whether `other` lies in the topological interior, so that [-inf, inf] contains itself in its interior.
    pub fn contains_in_interior(self, other: Self) -> bool {
        let below = self.lo < other.lo || self.lo == f64::NEG_INFINITY;
        let above = other.hi < self.hi || self.hi == f64::INFINITY;
        other.is_empty() || !self.is_empty() && below && above
    }

    /// Whether the two sets have no member in common.
    pub fn disjoint(self, other: Self) -> bool {
        !(self.lo <= other.hi && other.lo <= self.hi)
    }

    /// IEEE 1788 `intersection`: the common members.
    pub fn intersect(self, other: Self) -> Self {
        if self.disjoint(other) {
            return Self::EMPTY;
        }
        Self::raw(self.lo.max(other.lo), self.hi.min(other.hi))
    }

    /// IEEE 1788 `convexHull`: the least interval that holds both sets.
    pub fn hull(self, other: Self) -> Self {
        if self.is_empty() {
            return other;
        }
        if other.is_empty() {
            return self;
        }
        Self::raw(self.lo.min(other.lo), self.hi.max(other.hi))
    }
}
