//! What a kernel says of a box.

use std::fmt;

use serde::Deserialize;
use serde::Serialize;

use crate::interval::Interval;
use crate::kernel::verdict;

/// What is proved of the values of a function over a box, as bits of [`crate::kernel::verdict`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
pub struct Verdict(pub u32);

impl Verdict {
    /// Proved: every value is > 0.
    pub fn is_positive(self) -> bool {
        self.0 & verdict::POSITIVE != 0
    }

    /// Proved: every value is < 0.
    pub fn is_negative(self) -> bool {
        self.0 & verdict::NEGATIVE != 0
    }

    /// Proved: the function is undefined everywhere on the box, or the box lies outside of the domain.
    pub fn is_empty(self) -> bool {
        self.0 & verdict::EMPTY != 0
    }

    /// Proved: the function is defined and continuous on the whole box.
    pub fn is_continuous(self) -> bool {
        self.0 & verdict::CONTINUOUS != 0
    }

    /// Proved: the function has no zero on the box.
    pub fn excludes_zero(self) -> bool {
        self.0 & verdict::REFUTED != 0
    }
}

/// Bounds of a function's values over a box, and what else is proved there.
///
/// Every value that the function takes at a point of the box where it is defined lies in the interval. With rounding to
/// nearest nothing is proved: the interval is an estimate and the verdict says nothing.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Enclosure {
    pub interval: Interval,
    pub verdict: Verdict,
}

impl Enclosure {
    /// What is known before anything is computed.
    pub const UNKNOWN: Self = Self { interval: Interval::ENTIRE, verdict: Verdict(0) };

    /// The lower bound; +inf if the enclosure is empty.
    pub fn lo(&self) -> f64 {
        self.interval.inf()
    }

    /// The upper bound; -inf if the enclosure is empty.
    pub fn hi(&self) -> f64 {
        self.interval.sup()
    }

    /// See [`Verdict::is_positive`].
    pub fn is_positive(&self) -> bool {
        self.verdict.is_positive()
    }

    /// See [`Verdict::is_negative`].
    pub fn is_negative(&self) -> bool {
        self.verdict.is_negative()
    }

    /// See [`Verdict::is_empty`].
    pub fn is_empty(&self) -> bool {
        self.verdict.is_empty()
    }

    /// See [`Verdict::is_continuous`].
    pub fn is_continuous(&self) -> bool {
        self.verdict.is_continuous()
    }

    /// See [`Verdict::excludes_zero`].
    pub fn excludes_zero(&self) -> bool {
        self.verdict.excludes_zero()
    }
}

impl Default for Enclosure {
    fn default() -> Self {
        Self::UNKNOWN
    }
}

/// The interval, then what is proved in words.
impl fmt::Display for Enclosure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.interval)?;
        let facts = [
            (self.is_empty(), "undefined"),
            (self.is_positive() && !self.is_empty(), "positive"),
            (self.is_negative() && !self.is_empty(), "negative"),
            (self.is_continuous(), "continuous"),
        ];
        facts.iter().filter(|(holds, _)| *holds).try_for_each(|(_, fact)| write!(f, ", {fact}"))
    }
}
