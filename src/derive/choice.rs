//! Which arithmetic refutes a formula's empty cells soonest: a trial on its domain, by counting operations and not time,
//! so that the choice is the same on every machine and for every number of threads (contract 12).
//!
//! The domain is halved in every direction, level by level. Of the cells that the natural extension leaves undecided a
//! few are taken, cut, and tried with both arithmetics; their shares estimate how many cells of each level either would
//! have to test. A cell costs the operations of the compiled program; one that is left at the finest level costs as much as
//! what then becomes of it, and every operation costs its compilation. The weights are fitted to measured pictures.

use std::fmt;
use std::sync::Arc;

use crate::derive::Arithmetic;
use crate::derive::Extension;
use crate::derive::Formula;
use crate::derive::LaneProgram;
use crate::derive::Output;
use crate::derive::Precision;
use crate::derive::Rounding;
use crate::derive::Spec;
use crate::derive::Symbols;
use crate::graph::Graph;
use crate::graph::Value;
use crate::interval::Decorated;
use crate::interval::Interval;

/// Halvings of the domain. In space they end at about 4 pixels of a picture, where a renderer that tries cells with their
/// derivative too settles most; in the plane at one pixel, because what is left there stays unknown.
const LEVELS_IN_SPACE: usize = 7;
const LEVELS_IN_THE_PLANE: usize = 9;

/// Cells of a level that are cut, at most, and how many operations of the graph all of a trial may evaluate, so that it
/// takes a few milliseconds.
const SAMPLES: usize = 32;
const BUDGET: usize = 100_000;

/// Fewer sampled cells than this tell nothing.
const LEAST_SAMPLES: usize = 4;

/// In operations of a program on one lane: what a cell costs that is left at the finest level, and what compiling an
/// operation costs.
const LEFT: f64 = 1600.0;
const COMPILATION: f64 = 60_000.0;

/// What one arithmetic would have to do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Work {
    /// Operations of its compiled program.
    pub operations: usize,
    /// Cells to be tested on all levels, and undecided ones that are left at the end.
    pub tested: f64,
    pub left: f64,
    /// All of it in operations.
    pub total: f64,
}

/// The arithmetic chosen for a formula, with the numbers behind it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    pub arithmetic: Arithmetic,
    pub interval: Work,
    pub affine: Work,
}

impl fmt::Display for Choice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Choice { arithmetic, interval, affine } = self;
        let ratio = affine.total / interval.total;
        let verdict = match arithmetic {
            Arithmetic::Affine => "affine forms save work",
            _ => "intervals are cheaper",
        };
        write!(
            f,
            "{verdict}: on trial, affine forms would test {:.0} cells and leave {:.0}, intervals {:.0} and {:.0}, with {} \
             operations a cell against {}; in all {ratio:.2} of the work",
            affine.tested, affine.left, interval.tested, interval.left, affine.operations, interval.operations,
        )
    }
}

/// Tries intervals and affine forms on the domain, which has a range for each of one to three inputs of the graph; the
/// others are parameters with the range that they may be set in. `None` if the formula is too large to be tried.
///
/// The trial does not look at what a parameter is set to, since the choice is part of what a certificate stands on. It takes
/// a number inside each range, another part of it for each parameter: in the middle, symmetric ranges would all have 0 and
/// the formula might be no formula any more.
pub fn choose(
    graph: &Graph,
    root: Value,
    domain: &[(&str, Interval)],
    parameters: &[(&str, Interval)],
) -> Option<Choice> {
    let needed = graph.reachable(&[root]).into_iter().filter(|&needed| needed).count();
    let levels = if domain.len() < 3 { LEVELS_IN_THE_PLANE } else { LEVELS_IN_SPACE };
    let boxes = levels * (1 << domain.len());
    let samples = (BUDGET / (boxes * needed.max(1))).min(SAMPLES);
    if samples < LEAST_SAMPLES {
        return None;
    }
    let costs = [Arithmetic::Interval, Arithmetic::Affine]
        .map(|arithmetic| program(graph, root, domain, parameters, arithmetic).cost());
    let formula = Formula::new(graph, root);
    let known = |list: &[(&str, Interval)], name: &str| list.iter().find(|(n, _)| *n == name).map(|&(_, range)| range);
    let start: Vec<Interval> = formula
        .variables()
        .iter()
        .enumerate()
        .map(|(i, name)| {
            let inside = || known(parameters, name).filter(|range| range.is_bounded()).map(|range| part(range, i));
            known(domain, name).unwrap_or_else(|| Interval::point(inside().unwrap_or(0.5)))
        })
        .collect();
    let counts = trial(&formula, start, levels, samples);
    let [interval, affine] = [0, 1].map(|i| {
        let (operations, Count { tested, left }) = (costs[i], counts[i]);
        let total = tested * operations as f64 + left * LEFT + operations as f64 * COMPILATION;
        Work { operations, tested, left, total }
    });
    let arithmetic = if affine.total < interval.total { Arithmetic::Affine } else { Arithmetic::Interval };
    Some(Choice { arithmetic, interval, affine })
}

/// A number inside a bounded range; multiples of the golden ratio fall into different places for all `i`.
fn part(range: Interval, i: usize) -> f64 {
    let fraction = ((i + 1) as f64 * 0.618_033_988_749_895).fract();
    (range.lo() * (1.0 - fraction) + range.hi() * fraction).clamp(range.lo(), range.hi())
}

/// The compiled program of a formula on boxes of the domain.
fn program(
    graph: &Graph,
    root: Value,
    domain: &[(&str, Interval)],
    parameters: &[(&str, Interval)],
    arithmetic: Arithmetic,
) -> LaneProgram {
    let owned =
        |list: &[(&str, Interval)]| -> Vec<String> { list.iter().map(|(name, _)| (*name).to_owned()).collect() };
    let mut graph = graph.clone();
    let ranges = domain.iter().map(|&(name, range)| (graph.var(name), range)).collect();
    let spec = Spec {
        graph: Arc::new(graph),
        inputs: owned(domain),
        uniforms: owned(parameters),
        outputs: vec![Output::Refutation(root)],
        domain: ranges,
        promises: parameters.iter().map(|&(name, range)| (name.to_owned(), range)).collect(),
        arithmetic,
        symbols: owned(domain),
        rounding: Rounding::Outward,
    };
    spec.lower(Precision::Single)
}

/// Cells tested on all levels and cells left undecided on the last.
#[derive(Debug, Clone, Copy, Default)]
struct Count {
    tested: f64,
    left: f64,
}

/// Estimates by intervals and by affine forms, from so many sampled cells a level.
fn trial(formula: &Formula, domain: Vec<Interval>, levels: usize, samples: usize) -> [Count; 2] {
    let undecided = |extension: Extension, cell: &[Interval]| {
        let inputs: Vec<Decorated> = cell.iter().map(|&x| Decorated::new(x)).collect();
        let value = formula.enclose(extension, &inputs).interval();
        !value.is_empty() && value.lo() <= 0.0 && value.hi() >= 0.0
    };
    let mut counts = [Count { tested: 1.0, left: 1.0 }; 2];
    let mut cells = vec![domain];
    let mut random = Sequence(0);
    for _ in 0..levels {
        // A cell that stays undecided is cut in all its directions.
        let parts: Vec<Vec<Interval>> = cells.iter().flat_map(|cell| halves(cell)).collect();
        let (cut, tried) = (cells.len() as f64, parts.len() as f64);
        counts.iter_mut().for_each(|count| count.tested += count.left * tried / cut);
        cells = parts.into_iter().filter(|cell| undecided(Extension::Natural, cell)).collect();
        counts[0].left *= cells.len() as f64 / cut;
        if cells.is_empty() {
            counts[1].left = 0.0;
            break;
        }
        // Of more than enough cells, a sample stands for all.
        for i in 0..samples.min(cells.len()) {
            let other = i + random.below(cells.len() - i);
            cells.swap(i, other);
        }
        cells.truncate(samples);
        // Affine forms within natural extensions leave no cell that intervals refute.
        let affine = cells.iter().filter(|cell| undecided(Extension::Intersected(Symbols::Three), cell)).count();
        counts[1].left = counts[0].left * affine as f64 / cells.len() as f64;
    }
    counts
}

/// A cell halved in every direction in which it is no point.
fn halves(cell: &[Interval]) -> Vec<Vec<Interval>> {
    let mut parts = vec![Vec::with_capacity(cell.len())];
    for &x in cell {
        let (middle, point) = (x.mid(), x.is_singleton());
        let half = |lo: f64, hi: f64| Interval::new(lo, hi).unwrap_or(x);
        let pieces = if point { vec![x] } else { vec![half(x.lo(), middle), half(middle, x.hi())] };
        parts = parts
            .iter()
            .flat_map(|part| pieces.iter().map(move |&piece| part.iter().copied().chain([piece]).collect()))
            .collect();
    }
    parts
}

/// The same numbers each time (SplitMix64: Steele, Lea and Flood 2014).
struct Sequence(u64);

impl Sequence {
    /// A number below `bound` > 0.
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % bound as u64) as usize
    }
}
