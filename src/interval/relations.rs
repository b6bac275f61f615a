//! Relations between two sets, as IEEE 1788 has them: quantified over members, with `true` or `false` for an answer.
//!
//! They differ from the questions of [`Verdict`](super::Verdict), which compare numbers that are not known further.

use super::Interval;

/// How two intervals lie with respect to each other: the sixteen states of IEEE 1788, 10.6.4, after Allen (1983).
/// The first set of [`Interval::overlap`] is the subject of each name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Overlap {
    /// Both sets are empty.
    BothEmpty,
    /// The first is empty, the second is not.
    FirstEmpty,
    /// The second is empty, the first is not.
    SecondEmpty,
    /// Wholly below.
    Before,
    /// Below, with the upper bound on the other's lower bound.
    Meets,
    /// Starts below the other and ends inside it.
    Overlaps,
    /// Starts with the other and ends inside it.
    Starts,
    /// Lies inside, both bounds apart.
    ContainedBy,
    /// Starts inside the other and ends with it.
    Finishes,
    /// The same set.
    Equals,
    /// Ended by the other, which starts inside.
    FinishedBy,
    /// Holds the other inside, both bounds apart.
    Contains,
    /// Started by the other, which ends inside.
    StartedBy,
    /// Starts inside the other and ends above it.
    OverlappedBy,
    /// Above, with the lower bound on the other's upper bound.
    MetBy,
    /// Wholly above.
    After,
}

/// a < b, where equal infinities count too: beyond every bound lies another.
fn below(a: f64, b: f64) -> bool {
    a < b || a == b && a.is_infinite()
}

impl Interval {
    /// IEEE 1788 `subset`: whether every member is one of `other`.
    pub fn subset(self, other: Self) -> bool {
        other.contains_interval(self)
    }

    /// IEEE 1788 `interior`: whether every member lies in the topological interior of `other`.
    pub fn interior(self, other: Self) -> bool {
        other.contains_in_interior(self)
    }

    /// IEEE 1788 `less`, weakly less: for every x here some y in `other` with x <= y, and for every y some x.
    #[doc(alias = "less")]
    pub fn weakly_less(self, other: Self) -> bool {
        self.is_empty() && other.is_empty() || self.lo <= other.lo && self.hi <= other.hi
    }

    /// IEEE 1788 `strictLess`: as [`Interval::weakly_less`], with x < y.
    pub fn strict_less(self, other: Self) -> bool {
        self.is_empty() && other.is_empty() || below(self.lo, other.lo) && below(self.hi, other.hi)
    }

    /// IEEE 1788 `precedes`: whether x <= y for all x here and y in `other`; so it is where one of them is empty.
    pub fn precedes(self, other: Self) -> bool {
        self.is_empty() || other.is_empty() || self.hi <= other.lo
    }

    /// IEEE 1788 `strictPrecedes`: whether x < y for all x here and y in `other`.
    pub fn strict_precedes(self, other: Self) -> bool {
        self.is_empty() || other.is_empty() || self.hi < other.lo
    }

    /// IEEE 1788 `overlap`: which of the sixteen states holds.
    pub fn overlap(self, other: Self) -> Overlap {
        use std::cmp::Ordering::{Equal, Greater, Less};
        match (self.is_empty(), other.is_empty()) {
            (true, true) => return Overlap::BothEmpty,
            (true, false) => return Overlap::FirstEmpty,
            (false, true) => return Overlap::SecondEmpty,
            (false, false) => {}
        }
        match (self.lo.total_cmp(&other.lo), self.hi.total_cmp(&other.hi)) {
            (Less, Less) if self.hi < other.lo => Overlap::Before,
            (Less, Less) if self.hi == other.lo => Overlap::Meets,
            (Less, Less) => Overlap::Overlaps,
            (Less, Equal) => Overlap::FinishedBy,
            (Less, Greater) => Overlap::Contains,
            (Equal, Less) => Overlap::Starts,
            (Equal, Equal) => Overlap::Equals,
            (Equal, Greater) => Overlap::StartedBy,
            (Greater, Less) => Overlap::ContainedBy,
            (Greater, Equal) => Overlap::Finishes,
            (Greater, Greater) if self.lo > other.hi => Overlap::After,
            (Greater, Greater) if self.lo == other.hi => Overlap::MetBy,
            (Greater, Greater) => Overlap::OverlappedBy,
        }
    }
}
