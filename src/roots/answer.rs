//! What is asked and what is answered.

use std::fmt;

use serde::Deserialize;
use serde::Serialize;

use crate::interval::Interval;

/// An interval that is proved to hold a zero.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Root {
    /// At least one zero is in here; of one number only if that is the zero exactly.
    pub bracket: Interval,
    /// Where it is proved to be the only zero; the bracket lies inside. `None` if there may be others in the bracket.
    pub alone: Option<Interval>,
}

/// Bracket, `exact` if it is one number, and where the zero is alone.
impl fmt::Display for Root {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.bracket)?;
        if self.bracket.is_singleton() {
            f.write_str(" exact")?;
        }
        match self.alone {
            Some(alone) => write!(f, ", the only one in {alone}"),
            None => f.write_str(", at least one"),
        }
    }
}

/// The zeros in an interval: there is none outside of the proved brackets and the unknown rest.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Roots {
    /// Brackets in ascending order, no two of which meet.
    pub proved: Vec<Root>,
    /// Where zeros are neither proved nor excluded, in ascending order: zeros that are touched but not crossed, poles and
    /// jumps with a change of sign, and what was not tried. A bracket may lie inside one of them.
    pub unknown: Vec<Interval>,
    /// Whether the search ended before everything was tried, for lack of budget or because it was cancelled. What is
    /// proved holds all the same.
    pub exhausted: bool,
}

impl Roots {
    /// Whether these are all zeros and each is one: nothing is unknown, and every root is alone in its bracket.
    pub fn is_complete(&self) -> bool {
        self.unknown.is_empty() && self.proved.iter().all(|root| root.alone.is_some())
    }

    /// The root with the lowest bracket, if it is proved that no zero lies below it and that it is the only one in its
    /// bracket: the first hit of a ray.
    pub fn first(&self) -> Option<&Root> {
        let first = self.proved.first().filter(|root| root.alone.is_some())?;
        self.unknown.iter().all(|x| x.lo() > first.bracket.hi()).then_some(first)
    }
}

/// One line for each root and each unknown interval.
impl fmt::Display for Roots {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.proved.is_empty() && self.unknown.is_empty() {
            return f.write_str("no root: proved");
        }
        let proved = self.proved.iter().map(|root| format!("root {root}"));
        let unknown = self.unknown.iter().map(|x| format!("unknown {x}"));
        let ended = self.exhausted.then(|| "the search ended early".to_owned());
        let lines: Vec<String> = proved.chain(unknown).chain(ended).collect();
        f.write_str(&lines.join("\n"))
    }
}

/// How hard zeros are searched for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Undecided intervals of this part of the search interval, or of a number's size where that is smaller (but at least of
    /// 1), are given up as unknown.
    pub resolution: f64,
    /// Operations on intervals, graph nodes times evaluations, that one search may take, give or take those that finish a
    /// bracket. A count and not a time: the same question has the same answer.
    pub budget: usize,
}

/// A part of 2^-40, six million operations.
impl Default for Options {
    fn default() -> Self {
        Self { resolution: 1.0 / (1u64 << 40) as f64, budget: 6_000_000 }
    }
}

/// Intervals in order, with those that touch made one.
pub fn merged(mut intervals: Vec<Interval>) -> Vec<Interval> {
    intervals.sort_by(|a, b| a.lo().total_cmp(&b.lo()));
    let mut merged: Vec<Interval> = Vec::new();
    for x in intervals {
        match merged.last_mut() {
            Some(last) if !last.disjoint(x) => *last = last.hull(x),
            _ => merged.push(x),
        }
    }
    merged
}
