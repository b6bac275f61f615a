//! Questions about sets have three answers: proved, refuted, or not known.

use super::Interval;

/// The answer to a question about every member of a set. `Unknown` must never be taken for either of the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// True for every member.
    Proved,
    /// False for every member.
    Refuted,
    /// Neither is established; always the answer for an empty set.
    Unknown,
}

impl Verdict {
    fn decide(proved: bool, refuted: bool) -> Self {
        match (proved, refuted) {
            (true, _) => Self::Proved,
            (false, true) => Self::Refuted,
            (false, false) => Self::Unknown,
        }
    }

    /// Whether both hold: refuted as soon as one is.
    pub fn and(self, other: Self) -> Self {
        Self::decide(self == Self::Proved && other == Self::Proved, self == Self::Refuted || other == Self::Refuted)
    }

    /// Whether at least one holds: proved as soon as one is.
    pub fn or(self, other: Self) -> Self {
        self.negate().and(other.negate()).negate()
    }

    /// Whether it does not hold.
    pub fn negate(self) -> Self {
        match self {
            Self::Proved => Self::Refuted,
            Self::Refuted => Self::Proved,
            Self::Unknown => Self::Unknown,
        }
    }

    /// The set of truth values that are possible: {1}, {0} or [0, 1].
    pub fn to_interval(self) -> Interval {
        match self {
            Self::Proved => Interval::ONE,
            Self::Refuted => Interval::ZERO,
            Self::Unknown => Interval::UNIT,
        }
    }
}

/// Comparisons are written so that NaN bounds, those of the empty set, answer `Unknown`.
impl Interval {
    /// Whether every member is greater than 0.
    pub fn is_positive(self) -> Verdict {
        Self::ZERO.less(self)
    }

    /// Whether every member is less than 0.
    pub fn is_negative(self) -> Verdict {
        self.less(Self::ZERO)
    }

    /// Whether every member is at least 0.
    pub fn is_nonnegative(self) -> Verdict {
        Self::ZERO.less_equal(self)
    }

    /// Whether every member is 0: refuted exactly if 0 is not a member of this set.
    pub fn is_zero(self) -> Verdict {
        self.equal(Self::ZERO)
    }

    /// Whether x < y for all x here and y there.
    pub fn less(self, y: Self) -> Verdict {
        Verdict::decide(self.hi < y.lo, self.lo >= y.hi)
    }

    /// Whether x <= y for all x here and y there.
    pub fn less_equal(self, y: Self) -> Verdict {
        Verdict::decide(self.hi <= y.lo, self.lo > y.hi)
    }

    /// Whether x = y for all x here and y there.
    pub fn equal(self, y: Self) -> Verdict {
        Verdict::decide(self.lo == y.hi && self.hi == y.lo, self.hi < y.lo || self.lo > y.hi)
    }
}
