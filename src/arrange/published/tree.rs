//! The source's `classify`: a quadtree, level by level, whose leaves are labelled with the curves not excluded.

use std::collections::HashMap;

use crate::arrange::field::Function;
use crate::arrange::published::Evaluate;
use crate::arrange::published::Limits;
use crate::arrange::published::proof;
use crate::arrange::published::proof::Candidate;
use crate::control::Control;
use crate::interval::Interval;
use crate::kernel::verdict;

/// Evaluations of one call: enough for every thread, small beside the tree.
pub(super) const BATCH: usize = 1 << 16;

/// A box of a quadtree: column and row of the grid of `2^level` boxes a side.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Square {
    pub level: u32,
    pub x: u64,
    pub y: u64,
}

impl Square {
    const ROOT: Self = Self { level: 0, x: 0, y: 0 };

    pub(super) fn children(self) -> [Self; 4] {
        let child = |x, y| Self { level: self.level + 1, x: 2 * self.x + x, y: 2 * self.y + y };
        [child(0, 0), child(1, 0), child(0, 1), child(1, 1)]
    }

    /// The box itself.
    pub fn area(self, domain: [Interval; 2]) -> [Interval; 2] {
        let side = |range: Interval, i: u64| {
            let place = |i| place(range, i, self.level);
            Interval::new(place(i), place(i + 1)).unwrap_or(range)
        };
        [side(domain[0], self.x), side(domain[1], self.y)]
    }
}

/// Where line `i` of the grid of a level runs. Rounding moves lines but never makes boxes gape or overlap: the same line
/// has the same place on every level.
fn place(range: Interval, i: u64, level: u32) -> f64 {
    let last = 1u64 << level;
    match i {
        0 => range.lo(),
        _ if i == last => range.hi(),
        _ => (range.lo() + (range.hi() - range.lo()) * (i as f64 / last as f64)).clamp(range.lo(), range.hi()),
    }
}

/// What is known of a leaf.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Mark {
    /// No curve.
    Empty,
    /// One curve, proved to cross.
    Crossed,
    /// One curve, with no proof either way.
    Undecided,
    /// Several curves, at the limit.
    Several,
}

/// A leaf of the quadtree.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Leaf {
    pub square: Square,
    pub mark: Mark,
    /// The curves that could not be excluded, as an index into the tree's labels.
    pub(super) label: u32,
}

/// A grown quadtree.
pub(super) struct Tree {
    pub(super) leaves: Vec<Leaf>,
    pub(super) labels: Labels,
    pub(super) nodes: u64,
    pub(super) evaluations: u64,
    pub(super) discontinuous: u64,
    pub(super) terminal: f64,
    pub(super) complete: bool,
}

/// Sets of curves, each kept once.
pub(super) struct Labels {
    sets: Vec<Box<[u16]>>,
    known: HashMap<Box<[u16]>, u32>,
}

impl Labels {
    /// The label of no curve.
    pub(super) const NONE: u32 = 0;

    fn new() -> Self {
        let none: Box<[u16]> = Box::default();
        Self { sets: vec![none.clone()], known: HashMap::from([(none, Self::NONE)]) }
    }

    pub(super) fn curves(&self, label: u32) -> &[u16] {
        &self.sets[label as usize]
    }

    fn label(&mut self, curves: &[u16]) -> u32 {
        if let Some(&label) = self.known.get(curves) {
            return label;
        }
        let label = self.sets.len() as u32;
        self.sets.push(curves.into());
        self.known.insert(curves.into(), label);
        label
    }
}

/// Grows the tree.
pub(super) fn grow(
    domain: [Interval; 2],
    shapes: &[Function],
    limits: &Limits,
    control: &Control,
    evaluate: &Evaluate,
) -> Tree {
    let mut labels = Labels::new();
    let all: Vec<u16> = (0..shapes.len() as u16).collect();
    let mut level = vec![(Square::ROOT, labels.label(&all))];
    let longest = (domain[0].hi() - domain[0].lo()).max(domain[1].hi() - domain[1].lo());
    let mut tree = Tree {
        leaves: Vec::new(),
        labels,
        nodes: 0,
        evaluations: 0,
        discontinuous: 0,
        terminal: longest,
        complete: true,
    };
    for depth in 0.. {
        tree.nodes += level.len() as u64;
        tree.terminal = longest / (1u64 << depth) as f64;
        let split = tree.classify(domain, shapes, &level, control, evaluate);
        if split.is_empty() {
            break;
        }
        let limit = tree.terminal <= limits.epsilon || depth >= limits.depth.min(Limits::DEEPEST);
        let room = tree.nodes + 4 * split.len() as u64 <= limits.nodes && !control.is_cancelled();
        if limit || !room {
            tree.complete = limit && tree.complete;
            let several = |&(square, label)| Leaf { square, mark: Mark::Several, label };
            tree.leaves.extend(split.iter().map(several));
            break;
        }
        level = split.iter().flat_map(|&(square, label)| square.children().map(|child| (child, label))).collect();
    }
    tree
}

impl Tree {
    /// Looks at the boxes of one level, each with the curves of its parent; returns those with several curves, and makes
    /// leaves of the others. Once cancelled, boxes keep the curves that they came with.
    fn classify(
        &mut self,
        domain: [Interval; 2],
        shapes: &[Function],
        level: &[(Square, u32)],
        control: &Control,
        evaluate: &Evaluate,
    ) -> Vec<(Square, u32)> {
        let mut split = Vec::new();
        let mut single = Vec::new();
        let mut from = 0;
        while from < level.len() {
            let mut queries = Vec::new();
            let mut to = from;
            while to < level.len() && queries.len() < BATCH {
                let (square, label) = level[to];
                let area = square.area(domain);
                queries.extend(self.labels.curves(label).iter().map(|&curve| (shapes[usize::from(curve)], area)));
                to += 1;
            }
            if control.is_cancelled() {
                self.complete = false;
                split.extend_from_slice(&level[from..]);
                break;
            }
            let samples = evaluate(&queries);
            self.evaluations += queries.len() as u64;
            let mut samples = samples.iter();
            for &(square, label) in &level[from..to] {
                let left = self.labels.curves(label).iter().zip(&mut samples);
                let left: Vec<(u16, u32)> = left
                    .filter(|(_, sample)| !sample.is_refuted())
                    .map(|(&curve, sample)| (curve, sample.bits))
                    .collect();
                match left[..] {
                    [] => self.leaves.push(Leaf { square, mark: Mark::Empty, label: Labels::NONE }),
                    [(curve, bits)] => {
                        single.push(Candidate { square, curve, continuous: bits & verdict::CONTINUOUS != 0 });
                    }
                    _ => {
                        let curves: Vec<u16> = left.iter().map(|&(curve, _)| curve).collect();
                        split.push((square, self.labels.label(&curves)));
                    }
                }
            }
            from = to;
        }
        let mut proofs = proof::Proofs::default();
        let marks = proofs.search(domain, shapes, &single, control, evaluate);
        self.evaluations += proofs.evaluations;
        self.discontinuous += proofs.discontinuous;
        for (candidate, mark) in single.iter().zip(marks) {
            let label = if mark == Mark::Empty { Labels::NONE } else { self.labels.label(&[candidate.curve]) };
            self.leaves.push(Leaf { square: candidate.square, mark, label });
        }
        split
    }
}
