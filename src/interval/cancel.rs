//! Cancellative addition and subtraction: what was added, given the sum and the other summand.

use super::{Interval, exact, round};

impl Interval {
    /// IEEE 1788 `cancelMinus`: the tightest z with `other + z` around this set, for bounded sets of which `other` is
    /// not the wider. Unlike `self - other`, which is wider than this set, it takes the width of `other` away. The
    /// whole line where the sets are not of that kind; empty for an empty set, unless `other` is unbounded.
    pub fn cancel_minus(self, other: Self) -> Self {
        if self.is_empty() && (other.is_empty() || other.is_bounded()) {
            return Self::EMPTY;
        }
        if !self.is_bounded() || !other.is_bounded() || exact::is_wider((other.lo, other.hi), (self.lo, self.hi)) {
            return Self::ENTIRE;
        }
        Self::raw(round::sub_down(self.lo, other.lo), round::sub_up(self.hi, other.hi))
    }

    /// IEEE 1788 `cancelPlus`: `cancel_minus` of the negated set.
    pub fn cancel_plus(self, other: Self) -> Self {
        self.cancel_minus(-other)
    }
}
