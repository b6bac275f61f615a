//! The domain: what was written, or a choice that shows the whole picture.

use std::collections::HashMap;

use crate::graph::Graph;
use crate::interval::Interval;
use crate::limits::Budget;
use crate::limits::Exceeded;
use crate::syntax::ast::Expr;

use super::enclose::Enclosures;
use super::errors;
use super::lower::Lowerer;
use super::scene::COORDINATES;
use super::scene::Parameter;
use super::scene::Shape;

/// The default range of every coordinate when the shapes are not known to be bounded.
const FALLBACK: f64 = 4.0;

/// Shapes are looked for in [-1280, 1280]^n and down to [-0.00122, 0.00122]^n: 1.25 times powers of 2, so that a unit
/// sphere is framed with a margin of a quarter.
const LARGEST: f64 = 1.25 * 1024.0;
const SMALLEST: f64 = 1.25 / 1024.0;

/// Operations spent on the search, about 10 ms; a larger graph gets as many as evaluate it 100 times, up to the second.
const WORK: usize = 400_000;
const MAX_WORK: usize = 4_000_000;

/// Bisections of one piece of a shell, and pieces in all, before its emptiness counts as unproved.
const MAX_BISECTIONS: u32 = 15;
const MAX_CELLS: usize = 1500;

impl Lowerer<'_> {
    /// The outward hull of the ranges of a `domain` statement, `None` after an error.
    pub fn domain(&mut self, ranges: &[(Expr, Expr)]) -> Option<Vec<Interval>> {
        let span = ranges.iter().map(|(lo, hi)| lo.span.to(hi.span)).reduce(|a, b| a.to(b))?;
        if !(2..=COORDINATES.len()).contains(&ranges.len()) {
            let title = format!("a domain has 2 or 3 ranges, found {}", ranges.len());
            let help = "write `domain [-2, 2]^3` for space, `domain [-2, 2]^2` for the plane";
            self.report(errors::dimension(&title, span, "the ranges", help));
            return None;
        }
        let hulls: Vec<Interval> = ranges.iter().filter_map(|(lo, hi)| self.range(lo, hi)).collect();
        (hulls.len() == ranges.len()).then_some(hulls)
    }

    /// The outward hull of `[lo, hi]`.
    pub fn range(&mut self, lo: &Expr, hi: &Expr) -> Option<Interval> {
        let needs = "the end of a range";
        let (low, high) = (self.constant_interval(lo, needs), self.constant_interval(hi, needs));
        let (low, high) = (low?, high?);
        // Ends that cannot be told apart are as good as equal.
        if low.hi() < high.lo() {
            return Interval::new(low.lo(), high.hi());
        }
        let diagnostic = errors::empty_range(low.mid(), high.mid(), lo.span.to(hi.span));
        self.report(if low.lo() > high.hi() { diagnostic.help("swap its ends") } else { diagnostic });
        None
    }
}

/// The domain of a scene of `dimension` coordinates that gives none: a box that holds all of the shapes with a small
/// margin (an eighth to a third), if the natural interval extension proves within a bounded cost that nothing of them lies outside (up to
/// [`LARGEST`]); else [-4, 4]^n.
///
/// # Errors
/// If the time ran out.
///
/// Parameters vary over their ranges and the time over all reals; if that leaves the shapes unbounded, the values that
/// they have now decide.
pub(super) fn default_domain(
    graph: &Graph,
    shapes: &[Shape],
    parameters: &[Parameter],
    dimension: usize,
    budget: &Budget,
) -> Result<Vec<Interval>, Exceeded> {
    let widest = |p: &Parameter| p.range.unwrap_or(Interval::ENTIRE);
    let current = |p: &Parameter| p.value;
    let attempts: [&dyn Fn(&Parameter) -> Interval; 2] = [&widest, &current];
    // Without parameters both are the same.
    let attempts = if parameters.is_empty() { &attempts[..1] } else { &attempts };
    for range in attempts {
        let ranges: Vec<(&str, Interval)> = parameters.iter().map(|p| (p.name.as_str(), range(p))).collect();
        let mut search = Search::new(graph, shapes, &ranges, dimension, budget);
        let found = search.fit();
        if let Some(exceeded) = search.exceeded {
            return Err(exceeded);
        }
        if let Some(domain) = found {
            return Ok(domain);
        }
    }
    Ok(vec![symmetric(FALLBACK); dimension])
}

/// The search for a box around all zeros.
struct Search<'g> {
    enclosures: Enclosures<'g>,
    /// Root numbers of the field and of the condition of every shape.
    shapes: Vec<(usize, Option<usize>)>,
    /// Ranges of the inputs; those of the coordinates change.
    inputs: Vec<Interval>,
    /// The place of each coordinate in `inputs`, if it occurs.
    places: Vec<Option<usize>>,
    work: usize,
    budget: &'g Budget,
    /// Ends the search: nothing more is proved empty.
    exceeded: Option<Exceeded>,
}

impl<'g> Search<'g> {
    fn new(
        graph: &'g Graph,
        shapes: &[Shape],
        parameters: &[(&str, Interval)],
        dimension: usize,
        budget: &'g Budget,
    ) -> Self {
        let mut roots = Vec::new();
        let mut places = Vec::new();
        for shape in shapes {
            roots.push(shape.field);
            let field = roots.len() - 1;
            roots.extend(shape.condition);
            places.push((field, shape.condition.map(|_| field + 1)));
        }
        let enclosures = Enclosures::new(graph, &roots);
        let names = enclosures.inputs();
        let parameters: HashMap<&str, Interval> = parameters.iter().copied().collect();
        let range = |name: &String| parameters.get(name.as_str()).copied().unwrap_or(Interval::ENTIRE);
        let inputs = names.iter().map(range).collect();
        let coordinate = |name: &&str| names.iter().position(|input| input == name);
        let coordinates = COORDINATES[..dimension].iter().map(coordinate).collect();
        let work = (100 * enclosures.cost()).clamp(WORK, MAX_WORK);
        Self { enclosures, shapes: places, inputs, places: coordinates, work, budget, exceeded: None }
    }

    fn fit(&mut self) -> Option<Vec<Interval>> {
        // Of a few cells nothing comes.
        if self.work < 20 * self.enclosures.cost() {
            return None;
        }
        let mut radius = LARGEST;
        while radius > SMALLEST && self.shell_is_empty(radius / 2.0, radius) {
            radius /= 2.0;
        }
        // Nothing proved, or nothing there.
        if radius == LARGEST || radius <= SMALLEST {
            return None;
        }
        let inner = [0.625, 0.75, 0.875].into_iter().find(|share| self.shell_is_empty(share * radius, radius));
        radius *= inner.unwrap_or(1.0) + 0.125;
        let mut domain = vec![symmetric(radius); self.places.len()];
        for axis in 0..domain.len() {
            self.trim(&mut domain, axis, radius / 8.0);
        }
        Some(domain)
    }

    /// Whether nothing lies in [-outer, outer]^n outside of [-inner, inner]^n: two slabs for every axis, with the axes
    /// before it inside.
    fn shell_is_empty(&mut self, inner: f64, outer: f64) -> bool {
        let dimension = self.places.len();
        (0..dimension).all(|axis| {
            let mut slab: Vec<Interval> =
                (0..dimension).map(|i| symmetric(if i < axis { inner } else { outer })).collect();
            [(inner, outer), (-outer, -inner)].into_iter().all(|(lo, hi)| {
                slab[axis] = interval(lo, hi);
                self.is_empty(&slab)
            })
        })
    }

    /// Cuts empty slabs of width `step` off both ends of an axis, and gives one of them back as a margin.
    fn trim(&mut self, domain: &mut [Interval], axis: usize, step: f64) {
        let (mut lo, mut hi) = (domain[axis].lo(), domain[axis].hi());
        let mut slab = domain.to_vec();
        let mut cuts = |from: f64, direction: f64| {
            let mut count = 0;
            while count < 15 {
                let (near, far) =
                    (from + direction * f64::from(count) * step, from + direction * f64::from(count + 1) * step);
                slab[axis] = interval(near.min(far), near.max(far));
                if !self.is_empty(&slab) {
                    break;
                }
                count += 1;
            }
            f64::from((count - 1).max(0)) * step
        };
        let (low_cut, high_cut) = (cuts(lo, 1.0), cuts(hi, -1.0));
        if lo + low_cut < hi - high_cut {
            (lo, hi) = (lo + low_cut, hi - high_cut);
        }
        domain[axis] = interval(lo, hi);
    }

    /// Whether a box is proved to hold nothing of any shape. Undecided pieces are bisected on their widest side.
    fn is_empty(&mut self, region: &[Interval]) -> bool {
        let mut cells = 0;
        let mut stack = vec![(region.to_vec(), 0)];
        while let Some((cell, depth)) = stack.pop() {
            cells += 1;
            self.exceeded = self.exceeded.or(self.budget.time().err());
            if self.work < self.enclosures.cost() || cells > MAX_CELLS || self.exceeded.is_some() {
                return false;
            }
            self.work -= self.enclosures.cost();
            if self.is_refuted(&cell) {
                continue;
            }
            // Only coordinates that occur can decide anything.
            let width = |axis: &usize| cell[*axis].hi() - cell[*axis].lo();
            let axes = (0..cell.len()).filter(|&axis| self.places[axis].is_some());
            let Some(axis) = axes.max_by(|a, b| width(a).total_cmp(&width(b))) else { return false };
            if depth == MAX_BISECTIONS {
                return false;
            }
            let middle = cell[axis].mid();
            let (mut low, mut high) = (cell.clone(), cell);
            low[axis] = interval(low[axis].lo(), middle);
            high[axis] = interval(middle, high[axis].hi());
            stack.extend([(low, depth + 1), (high, depth + 1)]);
        }
        true
    }

    /// Whether every shape is proved absent: its field keeps away from 0, or its condition fails, on all of the box.
    fn is_refuted(&mut self, cell: &[Interval]) -> bool {
        for (place, range) in self.places.iter().zip(cell) {
            if let Some(place) = place {
                self.inputs[*place] = *range;
            }
        }
        self.enclosures.evaluate(&self.inputs);
        self.shapes.iter().all(|&(field, condition)| {
            let field = self.enclosures.root(field);
            let fails = condition.is_some_and(|condition| {
                let truth = self.enclosures.root(condition);
                truth.is_empty() || truth.hi() < 1.0
            });
            fails || field.is_empty() || field.lo() > 0.0 || field.hi() < 0.0
        })
    }
}

fn interval(lo: f64, hi: f64) -> Interval {
    Interval::new(lo, hi).unwrap_or(Interval::ENTIRE)
}

fn symmetric(radius: f64) -> Interval {
    interval(-radius, radius)
}
