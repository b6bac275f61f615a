//! The quadtree: boxes are quartered until each is settled, or too small.
//!
//! A box is settled if each component that may meet it is regular there (one partial derivative excludes 0, so that the
//! curve is a function of the other coordinate), if every two of them are apart or cross at most once, and if conditions
//! are decided or change at most once along a curve. Everything here is an interval test: what a settled leaf claims is
//! proved.
//!
//! Splits are off-centre, and differently in x and y: symmetric curves would otherwise run through corners of boxes and
//! along their sides, where no sign can be proved.

use std::collections::HashMap;
use std::collections::HashSet;

use crate::arrange::complex::Axis;
use crate::arrange::field::Fields;
use crate::arrange::field::Function;
use crate::arrange::field::Sample;
use crate::arrange::field::Use;
use crate::control::Control;
use crate::interval::Interval;
use crate::kernel::verdict;

/// Where a box is split: no fractions that a formula would have by design.
const SPLIT: [f64; 2] = [0.491_730_517, 0.506_190_283];

/// Components in a settled leaf beyond which it is quartered all the same: pairs grow as the square.
const MOST_ACTIVE: usize = 8;

/// The deepest level: positions in the grid of a level must fit into their words.
const DEEPEST: u32 = 60;

/// A box to be decided.
#[derive(Debug, Clone)]
pub struct Work {
    pub area: [Interval; 2],
    pub depth: u32,
    /// Column and row among the boxes of this depth.
    pub grid: [u64; 2],
    /// Components not yet excluded.
    pub candidates: Vec<u32>,
    /// Components that may have zeros here but no curve, since their conditions are proved false.
    pub silent: Vec<u32>,
}

/// A component that may meet a leaf.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Active {
    pub component: u32,
    /// The coordinate of which the curve is a function in the leaf; `None`: not proved regular.
    pub axis: Option<Axis>,
    /// Whether some condition of it is undecided in the leaf.
    pub conditional: bool,
    /// The one atom at which a condition may change along the curve in the leaf, and at most once.
    pub atom: Option<Function>,
}

/// A leaf of the quadtree.
#[derive(Debug, Clone)]
pub struct Leaf {
    pub area: [Interval; 2],
    pub depth: u32,
    pub grid: [u64; 2],
    /// By rising component.
    pub active: Vec<Active>,
    /// Components that may have zeros in the leaf but no curve: where a curve ends on the way here its zero set goes on.
    pub silent: Vec<u32>,
    /// Pairs of indices into `active` that cross at most once in the leaf; all other pairs have no point in common.
    pub crossing: Vec<(u8, u8)>,
    /// Whether the claims of a settled leaf could not be proved.
    pub open: bool,
    /// Whether it is left open at whatever size it has: quartering did not get anywhere.
    pub hopeless: bool,
}

/// When boxes stop being quartered.
pub enum Stop<'a> {
    /// At this side.
    Epsilon(f64),
    /// At these boxes, given by the bits of their ends: a tiling made earlier.
    At(&'a HashSet<[u64; 4]>),
}

/// The bits of a box's ends.
pub fn key(area: &[Interval; 2]) -> [u64; 4] {
    [area[0].lo(), area[0].hi(), area[1].lo(), area[1].hi()].map(f64::to_bits)
}

impl Work {
    /// The whole domain.
    pub fn root(fields: &Fields) -> Self {
        let candidates = (0..fields.components.len() as u32).collect();
        Self { area: fields.domain, depth: 0, grid: [0; 2], candidates, silent: Vec::new() }
    }

    /// A leaf again.
    pub fn of(leaf: &Leaf) -> Self {
        let candidates = leaf.active.iter().map(|active| active.component).collect();
        Self { area: leaf.area, depth: leaf.depth, grid: leaf.grid, candidates, silent: leaf.silent.clone() }
    }

    /// The four quarters; `None` if there are no numbers between the ends.
    pub fn quarters(&self) -> Option<[Work; 4]> {
        let mut halves = [[Interval::EMPTY; 2]; 2];
        for axis in 0..2 {
            let (lo, hi) = (self.area[axis].lo(), self.area[axis].hi());
            let split = lo + SPLIT[axis] * (hi - lo);
            if !(lo < split && split < hi) || self.depth >= DEEPEST {
                return None;
            }
            halves[axis] = [Interval::new(lo, split)?, Interval::new(split, hi)?];
        }
        Some([[0, 0], [1, 0], [0, 1], [1, 1]].map(|[i, j]| Work {
            area: [halves[0][i], halves[1][j]],
            depth: self.depth + 1,
            grid: [2 * self.grid[0] + i as u64, 2 * self.grid[1] + j as u64],
            candidates: self.candidates.clone(),
            silent: self.silent.clone(),
        }))
    }
}

/// What one round found of a box.
struct Decision {
    active: Vec<Active>,
    silent: Vec<u32>,
    crossing: Vec<(u8, u8)>,
    settled: bool,
}

/// The subdivision of a set of boxes.
pub struct Subdivision<'a> {
    pub fields: &'a Fields,
    pub stop: Stop<'a>,
    /// Boxes of a connected open region beyond which it is given up.
    pub region: usize,
    pub boxes: u64,
    pub evaluations: u64,
}

impl Subdivision<'_> {
    /// Leaves of the given boxes, level by level. A control that is set to stop leaves everything open that is undecided.
    pub fn run(&mut self, works: Vec<Work>, control: &Control<'_>) -> Vec<Leaf> {
        let mut leaves = Vec::new();
        let mut frontier = works;
        while !frontier.is_empty() {
            self.boxes += frontier.len() as u64;
            let decisions = if control.is_cancelled() { undecided(&frontier) } else { self.decide(&frontier) };
            let mut next = Vec::new();
            for (work, decision) in frontier.into_iter().zip(decisions) {
                let Decision { active, silent, crossing, settled } = decision;
                let candidates = active.iter().map(|active| active.component).collect();
                let work = Work { candidates, silent: [work.silent, silent].concat(), ..work };
                // A replay ends at its leaves alone, even where its own enclosures would have settled a larger box.
                let ends = settled && matches!(self.stop, Stop::Epsilon(_));
                let quarters = if ends || control.is_cancelled() { None } else { self.split(&work) };
                match quarters {
                    Some(quarters) => next.extend(quarters),
                    None => {
                        let Work { area, depth, grid, silent, .. } = work;
                        leaves.push(Leaf {
                            area,
                            depth,
                            grid,
                            active,
                            silent,
                            crossing,
                            open: !settled,
                            hopeless: false,
                        });
                    }
                }
            }
            frontier = self.give_up(next, &mut leaves);
        }
        leaves
    }

    /// The quarters of a box that is not settled, unless it is small enough.
    fn split(&self, work: &Work) -> Option<[Work; 4]> {
        let done = match &self.stop {
            Stop::Epsilon(epsilon) => work.area.iter().all(|side| side.width() <= *epsilon),
            Stop::At(leaves) => leaves.contains(&key(&work.area)),
        };
        if done { None } else { work.quarters() }
    }

    /// Takes out the boxes of connected regions that have grown too large: along overlapping curves their number doubles
    /// with each level, where curves fill an area it grows fourfold, and no depth will settle them.
    fn give_up(&self, frontier: Vec<Work>, leaves: &mut Vec<Leaf>) -> Vec<Work> {
        let limit = self.region + 4 * self.fields.components.len().pow(2);
        if frontier.len() <= limit || matches!(self.stop, Stop::At(_)) {
            return frontier;
        }
        let places: HashMap<(u32, [u64; 2]), u32> =
            frontier.iter().enumerate().map(|(index, work)| ((work.depth, work.grid), index as u32)).collect();
        let mut group = vec![u32::MAX; frontier.len()];
        let mut sizes: Vec<usize> = Vec::new();
        for start in 0..frontier.len() {
            if group[start] != u32::MAX {
                continue;
            }
            let id = sizes.len() as u32;
            let (mut stack, mut size) = (vec![start as u32], 0);
            group[start] = id;
            while let Some(index) = stack.pop() {
                size += 1;
                let work = &frontier[index as usize];
                for (dx, dy) in [(0, 1), (1, 0), (0, u64::MAX), (u64::MAX, 0)] {
                    let grid = [work.grid[0].wrapping_add(dx), work.grid[1].wrapping_add(dy)];
                    if let Some(&other) = places.get(&(work.depth, grid))
                        && group[other as usize] == u32::MAX
                    {
                        group[other as usize] = id;
                        stack.push(other);
                    }
                }
            }
            sizes.push(size);
        }
        let mut kept = Vec::new();
        for (work, group) in frontier.into_iter().zip(group) {
            if sizes[group as usize] <= limit {
                kept.push(work);
                continue;
            }
            let Work { area, depth, grid, candidates, silent } = work;
            let active =
                candidates.into_iter().map(|component| Active { component, axis: None, conditional: true, atom: None });
            let (active, crossing) = (active.collect(), Vec::new());
            leaves.push(Leaf { area, depth, grid, active, silent, crossing, open: true, hopeless: true });
        }
        kept
    }

    /// Evaluates queries and counts them.
    fn evaluate(&mut self, queries: &[(Function, [Interval; 2])]) -> Vec<Sample> {
        self.evaluations += queries.len() as u64;
        self.fields.evaluate(queries)
    }

    fn decide(&mut self, works: &[Work]) -> Vec<Decision> {
        let function = |component: u32| self.fields.components[component as usize].function;
        let queries: Vec<(Function, [Interval; 2])> =
            works.iter().flat_map(|work| work.candidates.iter().map(|&c| (function(c), work.area))).collect();
        let mut samples = self.evaluate(&queries).into_iter();
        let mut found: Vec<Vec<Met>> = Vec::with_capacity(works.len());
        for work in works {
            let mut met = Vec::new();
            for &component in &work.candidates {
                let sample = samples.next().expect("one sample for each query");
                if !sample.is_refuted() {
                    met.push(Met { component, sample, centre: Interval::ENTIRE, uses: Vec::new() });
                }
            }
            found.push(met);
        }
        self.centres(works, &mut found);
        let silent = self.conditions(works, &mut found);
        let mut decisions = self.settle(works, found);
        for (decision, silent) in decisions.iter_mut().zip(silent) {
            decision.silent = silent;
        }
        decisions
    }

    /// Excludes components by their centred form.
    fn centres(&mut self, works: &[Work], found: &mut [Vec<Met>]) {
        let mut queries = Vec::new();
        for (work, met) in works.iter().zip(found.iter()) {
            queries.extend(
                met.iter().map(|met| (self.fields.components[met.component as usize].function, middle(work.area))),
            );
        }
        let mut samples = self.evaluate(&queries).into_iter();
        for (work, met) in works.iter().zip(found.iter_mut()) {
            met.retain_mut(|met| {
                met.centre = samples.next().expect("one sample for each query").value;
                !met.sample.is_continuous() || !excludes_zero(centred(met.centre, met.sample.slope, work.area))
            });
        }
    }

    /// Decides conditions, and takes out components whose conditions are false: by box.
    fn conditions(&mut self, works: &[Work], found: &mut [Vec<Met>]) -> Vec<Vec<u32>> {
        let fields = self.fields;
        let uses = |met: &Met| fields.components[met.component as usize].uses.iter();
        let mut queries = Vec::new();
        for (work, met) in works.iter().zip(found.iter()) {
            queries.extend(met.iter().flat_map(uses).filter_map(|used| Some((used.condition?, work.area))));
        }
        let mut samples = self.evaluate(&queries).into_iter();
        let mut silent = Vec::with_capacity(works.len());
        for met in found {
            let mut dropped = Vec::new();
            met.retain_mut(|met| {
                met.uses = uses(met)
                    .map(|used| match used.condition {
                        None => Some(true),
                        Some(_) => truth(&samples.next().expect("one sample for each query")),
                    })
                    .collect();
                let kept = met.uses.iter().any(|&truth| truth != Some(false));
                if !kept {
                    dropped.push(met.component);
                }
                kept
            });
            silent.push(dropped);
        }
        silent
    }

    fn settle(&mut self, works: &[Work], found: Vec<Vec<Met>>) -> Vec<Decision> {
        let mut decisions: Vec<Decision> =
            works.iter().zip(&found).map(|(work, met)| pairs(self.fields, work.area, met)).collect();
        // Where everything but conditions is settled, their atoms are asked.
        let mut queries = Vec::new();
        let fields = self.fields;
        let undecided = |met: &Met| -> Vec<Function> {
            let uses: &[Use] = &fields.components[met.component as usize].uses;
            let open = uses.iter().zip(&met.uses).filter(|(_, truth)| truth.is_none());
            let mut atoms: Vec<Function> = open.flat_map(|(used, _)| used.atoms.iter().copied()).collect();
            atoms.sort_unstable();
            atoms.dedup();
            atoms
        };
        let conditional =
            |decision: &Decision| decision.settled && decision.active.iter().any(|active| active.conditional);
        for ((work, met), decision) in works.iter().zip(&found).zip(&decisions) {
            if conditional(decision) {
                for atom in met.iter().flat_map(&undecided) {
                    queries.push((atom, work.area));
                    queries.push((atom, middle(work.area)));
                }
            }
        }
        let mut samples = self.evaluate(&queries).into_iter();
        for ((work, met), decision) in works.iter().zip(&found).zip(&mut decisions) {
            if !conditional(decision) {
                continue;
            }
            for (met, active) in met.iter().zip(&mut decision.active) {
                let mut changes = 0;
                let atoms = undecided(met);
                // What changes elsewhere than at atoms may change anywhere.
                let uses = fields.components[met.component as usize].uses.iter().zip(&met.uses);
                let known = uses.filter(|(_, truth)| truth.is_none()).all(|(used, _)| !used.atoms.is_empty());
                for &function in &atoms {
                    let mut next = || samples.next().expect("one sample for each query");
                    let (sample, centre) = (next(), next().value);
                    if sample.is_refuted() {
                        continue;
                    }
                    let atom = Met { component: met.component, sample, centre, uses: Vec::new() };
                    match relation(work.area, met, &atom) {
                        Some(Relation::Apart) => {}
                        Some(Relation::Transversal) => {
                            changes += 1;
                            active.atom = Some(function);
                        }
                        None => changes += 2,
                    }
                }
                decision.settled &= known && changes <= 1;
            }
            // An end among crossings is told apart by more quartering.
            decision.settled &= decision.crossing.is_empty();
        }
        decisions
    }
}

/// A component on a box that it may meet.
struct Met {
    component: u32,
    sample: Sample,
    /// The value in the middle.
    centre: Interval,
    /// What is known of the condition of each use.
    uses: Vec<Option<bool>>,
}

/// What is proved of two components on a box.
enum Relation {
    /// They have no point in common.
    Apart,
    /// They have at most one.
    Transversal,
}

/// Everything open.
fn undecided(works: &[Work]) -> Vec<Decision> {
    let open = |work: &Work| {
        let active =
            work.candidates.iter().map(|&component| Active { component, axis: None, conditional: true, atom: None });
        let settled = work.candidates.is_empty();
        Decision { active: active.collect(), silent: Vec::new(), crossing: Vec::new(), settled }
    };
    works.iter().map(open).collect()
}

/// The middle of a box, as a box.
pub fn middle(area: [Interval; 2]) -> [Interval; 2] {
    area.map(|side| Interval::point(side.mid()))
}

/// Whether a set is proved to be without 0. An empty one, which an overflow leaves behind, proves nothing.
pub fn excludes_zero(x: Interval) -> bool {
    x.lo() > 0.0 || x.hi() < 0.0
}

/// The mean-value form of a function that is continuous on the box (Moore 1966).
pub fn centred(centre: Interval, slope: [Interval; 2], area: [Interval; 2]) -> Interval {
    let middle = middle(area);
    let step = |axis: usize| slope[axis] * (area[axis] - middle[axis]);
    centre + step(0) + step(1)
}

/// What a sample of a truth value says: an undefined condition holds nowhere.
pub fn truth(sample: &Sample) -> Option<bool> {
    if sample.bits & verdict::EMPTY != 0 || sample.value.hi() < 0.5 {
        return Some(false);
    }
    (sample.value.lo() > 0.5 && sample.is_defined()).then_some(true)
}

/// The coordinate of which a regular curve is a function: the one whose partner's derivative is further from 0.
fn regular(sample: &Sample) -> Option<Axis> {
    if !sample.is_continuous() {
        return None;
    }
    let [x, y] = sample.slope.map(Interval::mig);
    if x <= 0.0 && y <= 0.0 {
        return None;
    }
    Some(if y >= x { Axis::X } else { Axis::Y })
}

/// Regularity of each component and relations of all pairs.
fn pairs(fields: &Fields, area: [Interval; 2], met: &[Met]) -> Decision {
    let active: Vec<Active> = met
        .iter()
        .map(|met| Active {
            component: met.component,
            axis: regular(&met.sample),
            conditional: met.uses.iter().any(Option::is_none),
            atom: None,
        })
        .collect();
    let mut crossing = Vec::new();
    let mut settled = active.len() <= MOST_ACTIVE && active.iter().all(|active| active.axis.is_some());
    if settled {
        for j in 1..met.len() {
            for i in 0..j {
                if fields.are_disjoint(met[i].component, met[j].component) {
                    continue;
                }
                match relation(area, &met[i], &met[j]) {
                    Some(Relation::Apart) => {}
                    Some(Relation::Transversal) => crossing.push((i as u8, j as u8)),
                    None => settled = false,
                }
            }
        }
    }
    // Several crossings in one leaf are told apart by more quartering.
    settled &= crossing.len() <= 1 || active.len() == 2;
    Decision { active, silent: Vec::new(), crossing, settled }
}

/// The relation of two components on a box, if it can be proved. Both are continuous where it is.
///
/// Common zeros z of f and g satisfy f(c) + f'(z - c) = 0 and g(c) + g'(z - c) = 0 for some f', g' in the enclosures of the
/// gradients. If no matrix of these rows is singular there is at most one z (Neumaier 1990, section 5.1), and by Cramer's
/// rule it lies in c - J^-1 (f(c), g(c)). If the gradients are nearly parallel, the combination g + l f that cancels them in
/// the middle is nearly constant, and usually not 0.
fn relation(area: [Interval; 2], f: &Met, g: &Met) -> Option<Relation> {
    if !f.sample.is_continuous() || !g.sample.is_continuous() {
        return None;
    }
    let ([fx, fy], [gx, gy]) = (f.sample.slope, g.sample.slope);
    let bounded = [fx, fy, gx, gy].iter().all(|slope| slope.is_bounded());
    if bounded {
        let [ax, ay, bx, by] = [fx, fy, gx, gy].map(Interval::mid);
        let length = ax * ax + ay * ay;
        let factor = Interval::point(-(ax * bx + ay * by) / length);
        // The quotient of very large or very small numbers is no number.
        if !factor.is_empty() {
            let centre = g.centre + factor * f.centre;
            if excludes_zero(centred(centre, [gx + factor * fx, gy + factor * fy], area)) {
                return Some(Relation::Apart);
            }
        }
    }
    let determinant = fx * gy - fy * gx;
    if !excludes_zero(determinant) {
        return None;
    }
    if bounded {
        let middle = middle(area);
        let x = middle[0] - (f.centre * gy - fy * g.centre) / determinant;
        let y = middle[1] - (fx * g.centre - f.centre * gx) / determinant;
        let outside = |range: Interval, side: Interval| !range.is_empty() && range.intersect(side).is_empty();
        if outside(x, area[0]) || outside(y, area[1]) {
            return Some(Relation::Apart);
        }
    }
    Some(Relation::Transversal)
}
