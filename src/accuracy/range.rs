//! The true range of a formula over a box, as closely as it can be had: what enclosures are measured against.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use serde::Serialize;

use crate::accuracy::number::serialize_pair;
use crate::derive::Extension;
use crate::derive::Formula;
use crate::derive::Symbols;
use crate::interval::Decorated;
use crate::interval::Decoration;
use crate::interval::Interval;

/// Boxes that are looked at for each end of the range.
const BOXES: usize = 3_000;

/// An end that is known to this part of the range's width, or of its own size, is known well enough.
const ENOUGH: f64 = 1e-13;

/// Enclosures of both ends of a range.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Range {
    /// The infimum lies between these.
    #[serde(serialize_with = "serialize_pair")]
    pub lo: [f64; 2],
    /// The supremum lies between these.
    #[serde(serialize_with = "serialize_pair")]
    pub hi: [f64; 2],
}

impl Range {
    /// Encloses the range of a formula by branch and bound (Moore 1966; Skelboe 1974): the box with the least lower bound is
    /// halved until the value at some point is as low as that bound. `None` if the formula was defined at no point that
    /// was tried.
    pub fn of(formula: &Formula, inputs: &[Decorated]) -> Option<Self> {
        let lo = infimum(formula, inputs, false)?;
        let [least, most] = infimum(formula, inputs, true)?;
        Some(Self { lo, hi: [-most, -least] })
    }

    /// The width lies between these.
    pub fn width(&self) -> [f64; 2] {
        [(self.hi[0] - self.lo[1]).max(0.0), self.hi[1] - self.lo[0]]
    }

    /// Whether an enclosure holds all values that are known to be taken.
    pub fn is_held_by(&self, lo: f64, hi: f64) -> bool {
        lo <= self.lo[1] && self.hi[0] <= hi
    }
}

/// A box with a lower bound of the formula on it; the least bound comes first out of a heap.
struct Piece {
    bound: f64,
    inputs: Vec<Decorated>,
}

impl Ord for Piece {
    fn cmp(&self, other: &Self) -> Ordering {
        other.bound.total_cmp(&self.bound)
    }
}

impl PartialOrd for Piece {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Piece {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Piece {}

/// Bounds of the infimum of the formula, or of its negative, from below and from above.
fn infimum(formula: &Formula, inputs: &[Decorated], negated: bool) -> Option<[f64; 2]> {
    let ends = |range: Interval| if negated { [-range.hi(), -range.lo()] } else { [range.lo(), range.hi()] };
    let lower = |inputs: &[Decorated]| {
        let ways = [Extension::Natural, Extension::Intersected(Symbols::Full), Extension::MeanValue];
        let meet = ways.into_iter().map(|way| formula.enclose(way, inputs).interval()).reduce(Interval::intersect);
        meet.filter(|range| !range.is_empty()).map(|range| ends(range)[0])
    };
    // An upper bound of the value at the middle is one of the infimum.
    let sample = |inputs: &[Decorated]| {
        let middle: Vec<Decorated> =
            inputs.iter().map(|x| Decorated::new(Interval::point(x.interval().mid()))).collect();
        let value = formula.enclose(Extension::Natural, &middle);
        let defined = !value.interval().is_empty() && value.decoration() >= Decoration::Def;
        if defined { ends(value.interval())[1] } else { f64::INFINITY }
    };
    let corners = corners(inputs);
    let mut above = corners.iter().map(|corner| sample(corner)).fold(sample(inputs), f64::min);
    let mut open = BinaryHeap::from([Piece { bound: lower(inputs)?, inputs: inputs.to_vec() }]);
    // What is too small to be halved is put aside with its bound.
    let mut aside = f64::INFINITY;
    for _ in 0..BOXES {
        let Some(Piece { bound, inputs }) = open.pop() else { break };
        if above - bound.min(aside) <= ENOUGH * above.abs() {
            aside = aside.min(bound);
            break;
        }
        let Some(halves) = halve(&inputs) else {
            aside = aside.min(bound);
            continue;
        };
        for half in halves {
            above = above.min(sample(&half));
            open.extend(lower(&half).map(|own| Piece { bound: own.max(bound), inputs: half }));
        }
    }
    let below = open.peek().map_or(f64::INFINITY, |piece| piece.bound).min(aside);
    (above < f64::INFINITY).then_some([below.min(above), above])
}

/// The corners of the box, while there are not too many.
fn corners(inputs: &[Decorated]) -> Vec<Vec<Decorated>> {
    if inputs.len() > 8 || inputs.iter().any(|x| !x.interval().is_bounded()) {
        return Vec::new();
    }
    let corner = |bits: usize| {
        let ends = inputs.iter().enumerate().map(|(index, x)| {
            let range = x.interval();
            Decorated::new(Interval::point(if bits >> index & 1 == 0 { range.lo() } else { range.hi() }))
        });
        ends.collect()
    };
    (0..1 << inputs.len()).map(corner).collect()
}

/// The box in two, across its widest input; `None` if no number lies within.
fn halve(inputs: &[Decorated]) -> Option<[Vec<Decorated>; 2]> {
    let width = |x: &Decorated| x.interval().width();
    let widest = (0..inputs.len()).max_by(|&a, &b| width(&inputs[a]).total_cmp(&width(&inputs[b])))?;
    let range = inputs[widest].interval();
    let middle = range.mid();
    let inside = range.lo() < middle && middle < range.hi();
    let part = |lo: f64, hi: f64| {
        let mut part = inputs.to_vec();
        part[widest] = Decorated::new(Interval::new(lo, hi)?);
        Some(part)
    };
    if inside { Some([part(range.lo(), middle)?, part(middle, range.hi())?]) } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph;

    fn range(text: &str, inputs: &[(f64, f64)]) -> Option<Range> {
        let graph = graph::parse(text).unwrap();
        let root = graph.output("f").unwrap();
        let inputs: Vec<Decorated> =
            inputs.iter().map(|&(lo, hi)| Decorated::new(Interval::new(lo, hi).unwrap())).collect();
        Range::of(&Formula::new(&graph, root), &inputs)
    }

    #[test]
    fn ranges_are_tight() {
        // x (10 - x) on [4, 6] has the range [24, 25].
        let graph = "v0 = var x\nv1 = const 10\nv2 = sub v1, v0\nv3 = mul v0, v2\nout f = v3\n";
        let found = range(graph, &[(4.0, 6.0)]).unwrap();
        assert!(found.lo[0] <= 24.0 && found.lo[1] >= 24.0 && found.hi[0] <= 25.0 && found.hi[1] >= 25.0, "{found:?}");
        assert!(found.width()[0] > 1.0 - 1e-9 && found.width()[1] < 1.0 + 1e-9, "{found:?}");
        assert!(found.is_held_by(24.0 - 1e-9, 25.0 + 1e-9) && !found.is_held_by(24.5, 26.0));
    }

    #[test]
    fn what_is_nowhere_defined_has_no_range() {
        assert_eq!(range("v0 = var x\nv1 = sqrt v0\nout f = v1\n", &[(-2.0, -1.0)]), None);
    }
}
