//! The reference search: interval Newton with bisection on the reference arithmetic (Moore, Interval Analysis, 1966;
//! Hansen and Walster, Global Optimization Using Interval Analysis, 2004).
//!
//! A zero is proved by opposite signs at the ends of an interval on which the function is proved continuous, by a Newton
//! step into the interior of such an interval, or by a value that is exactly 0. It is the only one where the derivative
//! excludes 0. An interval is refuted if its enclosure excludes 0. All else is unknown: among it, poles where the
//! function changes its sign, and zeros that it touches without crossing.

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::sync::Arc;

use crate::control::Control;
use crate::derive;
use crate::graph;
use crate::graph::Graph;
use crate::graph::Value;
use crate::interval::Decorated;
use crate::interval::Decoration;
use crate::interval::Interval;
use crate::limits::Budget;
use crate::limits::Limits;
use crate::roots::answer::Options;
use crate::roots::answer::Root;
use crate::roots::answer::Roots;
use crate::roots::answer::merged;
use crate::roots::numbers::is_small;
use crate::roots::numbers::scale;
use crate::roots::numbers::simplest;
use crate::roots::problem::Problem;

/// With so many intervals open, those of the next part of the search interval are given up: a zero that the function
/// touches, at which rounding errors decide, would fill the search with ever smaller ones.
pub const CROWD: usize = 256;
pub const CROWDED: f64 = 1.0 / (1u64 << 26) as f64;
/// Intervals that are looked at once more when the search is over.
const MAX_RESORTS: usize = 64;
/// Steps that narrow one bracket; quadratic convergence needs few, bisection one a bit.
const MAX_STEPS: usize = 200;

/// A function of one unknown, all its other inputs having values: one search on the reference arithmetic.
pub struct Search {
    problem: Arc<Problem>,
    boxes: Vec<Decorated>,
    spent: usize,
}

enum Finding {
    Refuted,
    Root(Root),
    /// What is left to be searched.
    Narrowed(Interval),
    Undecided,
}

impl Search {
    /// `boxes` are those of the graph's variables in their order, `variable` is the place of the one to be searched, whose own
    /// box is not used.
    ///
    /// # Panics
    /// If the boxes are not as many as the variables.
    pub fn new(graph: &Graph, root: Value, boxes: &[Decorated], variable: usize) -> Self {
        let budget = Budget::new(&Limits::unlimited());
        let problem = Problem::new(graph, root, &graph.variables()[variable], &budget);
        let problem = problem.unwrap_or_else(|_| unreachable!("there is no limit"));
        Self::of(Arc::new(problem), boxes.to_vec(), 0)
    }

    /// Zeros in t on the exact line origin + t direction of the inputs named `coordinates`, at most three of them. `boxes` are
    /// those of the graph's variables in their order; those of the coordinates are not used. A line with an end that is no
    /// number may be anywhere: nothing is proved on it.
    ///
    /// # Panics
    /// If the boxes are not as many as the variables, or origin and direction not as many as the coordinates.
    pub fn along_ray(
        graph: &Graph,
        root: Value,
        boxes: &[Decorated],
        coordinates: &[&str],
        origin: &[f64],
        direction: &[f64],
    ) -> Self {
        assert_eq!(graph.variables().len(), boxes.len(), "one box for each variable");
        let budget = Budget::new(&Limits::unlimited());
        let problem = Problem::along_ray(graph, root, coordinates, &budget);
        let problem = problem.unwrap_or_else(|_| unreachable!("there is no limit"));
        let value = |name: &String| {
            let at = |names: &[&str]| names.iter().position(|n| n == name);
            match (at(&derive::ORIGIN), at(&derive::DIRECTION), graph.variables().iter().position(|n| n == name)) {
                (Some(i), _, _) => Decorated::new(number(origin[i])),
                (_, Some(i), _) => Decorated::new(number(direction[i])),
                (_, _, Some(i)) => boxes[i],
                // The unknown.
                _ => Decorated::ENTIRE,
            }
        };
        let boxes = problem.graph.variables().iter().map(value).collect();
        Self::of(Arc::new(problem), boxes, 0)
    }

    /// A search that has spent a part of its budget elsewhere.
    pub(super) fn of(problem: Arc<Problem>, boxes: Vec<Decorated>, spent: usize) -> Self {
        assert_eq!(problem.graph.variables().len(), boxes.len(), "one box for each variable");
        Self { problem, boxes, spent }
    }

    /// All zeros in an interval.
    pub fn run(self, range: Interval, options: &Options, control: &Control) -> Roots {
        self.resume(vec![range], Vec::new(), Roots::default(), range, options, control)
    }

    /// All zeros in an interval, of which only `open` is left to be searched and `rest` to be looked at once more.
    pub(super) fn resume(
        mut self,
        open: Vec<Interval>,
        mut rest: Vec<Interval>,
        mut roots: Roots,
        range: Interval,
        options: &Options,
        control: &Control,
    ) -> Roots {
        let mut open: BinaryHeap<Open> = open.into_iter().map(Open).collect();
        // The widest first: when the search has to end, what is unknown is as short as can be.
        while let Some(Open(x)) = open.pop() {
            let crowded = open.len() > CROWD && x.width() <= CROWDED * scale(x, range);
            if self.spent > options.budget || crowded || control.is_cancelled() {
                roots.exhausted |= !crowded;
                rest.push(x);
                continue;
            }
            match self.examine(x) {
                Finding::Refuted => {}
                Finding::Root(root) => roots.proved.push(root),
                Finding::Narrowed(narrower) => open.push(Open(narrower)),
                Finding::Undecided => match split(x, range, options.resolution) {
                    Some(at) => {
                        open.extend(
                            [(x.lo(), at), (at, x.hi())]
                                .map(|(lo, hi)| Interval::new(lo, hi))
                                .into_iter()
                                .flatten()
                                .map(Open),
                        );
                    }
                    None => rest.push(x),
                },
            }
        }
        let rest = merged(rest);
        for (number, &x) in rest.iter().enumerate() {
            match number {
                0..MAX_RESORTS if !control.is_cancelled() => self.last_resort(x, range, &mut roots),
                _ => roots.unknown.push(x),
            }
        }
        self.tidy(&mut roots);
        roots
    }

    fn enclose(&mut self, value: Value, x: Interval) -> Decorated {
        self.boxes[self.problem.variable] = Decorated::new(x);
        self.spent += self.problem.graph.len();
        graph::enclose(&self.problem.graph, &[value], &self.boxes)[0]
    }

    /// The sign of the function at a number: -1, 0 or 1 if proved.
    fn sign(&mut self, x: f64) -> Option<i32> {
        let value = self.enclose(self.problem.f, Interval::point(x));
        let interval = value.interval();
        match () {
            _ if interval.is_empty() || value.decoration() < Decoration::Def => None,
            _ if interval.lo() > 0.0 => Some(1),
            _ if interval.hi() < 0.0 => Some(-1),
            _ if interval == Interval::ZERO => Some(0),
            _ => None,
        }
    }

    fn refuted(&mut self, x: Interval, value: Interval) -> bool {
        let excludes = |interval: Interval| interval.is_empty() || !interval.contains(0.0);
        if excludes(value) {
            return true;
        }
        (0..self.problem.factors.len()).any(|i| excludes(self.enclose(self.problem.factors[i], x).interval()))
    }

    /// The derivative where the function is proved continuous and the derivative proved defined.
    fn slope(&mut self, x: Interval, value: Decorated) -> Option<Interval> {
        if value.decoration() < Decoration::Dac {
            return None;
        }
        let slope = self.enclose(self.problem.slope, x);
        (slope.decoration() >= Decoration::Def).then_some(slope.interval())
    }

    fn examine(&mut self, x: Interval) -> Finding {
        let value = self.enclose(self.problem.f, x);
        if self.refuted(x, value.interval()) {
            return Finding::Refuted;
        }
        let Some(slope) = self.slope(x, value).filter(|_| x.is_bounded() && !x.is_singleton()) else {
            return Finding::Undecided;
        };
        let Some((newton, into)) = self.newton(x, slope) else { return Finding::Refuted };
        if slope.contains(0.0) {
            return Finding::Undecided;
        }
        match (self.sign(x.lo()), self.sign(x.hi())) {
            (Some(0), _) => return Finding::Root(Root { bracket: Interval::point(x.lo()), alone: Some(x) }),
            (_, Some(0)) => return Finding::Root(Root { bracket: Interval::point(x.hi()), alone: Some(x) }),
            // Monotone and of one sign.
            (Some(left), Some(right)) if left == right => return Finding::Refuted,
            (Some(left), Some(_)) => {
                let bracket = self.narrow(x, left, true);
                return Finding::Root(Root { bracket, alone: Some(x) });
            }
            _ => {}
        }
        if into {
            // The Newton operator maps the interval into itself: there is a zero, and the slope allows one only.
            return Finding::Root(Root { bracket: self.contract(newton), alone: Some(x) });
        }
        if newton.width() < 0.75 * x.width() { Finding::Narrowed(newton) } else { Finding::Undecided }
    }

    /// What a Newton step leaves of an interval on which the function has the given slopes, and whether the step leads into the
    /// interval; `None` if there is no zero.
    fn newton(&mut self, x: Interval, slope: Interval) -> Option<(Interval, bool)> {
        let middle = x.mid();
        let value = self.enclose(self.problem.f, Interval::point(middle)).interval();
        // Mean value theorem: 0 = f(root) is in f(middle) + slope (root - middle).
        let step = if slope.contains(0.0) {
            let values = value + slope * (x - Interval::point(middle));
            return values.contains(0.0).then_some((x, false));
        } else {
            value / slope
        };
        let newton = Interval::point(middle) - step;
        let left = newton.intersect(x);
        (!left.is_empty()).then_some((left, x.contains_interval(newton)))
    }

    /// Newton steps on an interval that holds exactly one zero, while they help.
    pub(super) fn contract(&mut self, mut x: Interval) -> Interval {
        for _ in 0..MAX_STEPS {
            let value = self.enclose(self.problem.f, x);
            let Some(slope) = self.slope(x, value).filter(|slope| !slope.contains(0.0)) else { break };
            match self.newton(x, slope) {
                Some((narrower, _)) if narrower.width() < x.width() => x = narrower,
                _ => break,
            }
        }
        x
    }

    /// Narrows an interval at whose ends the signs are opposite, `left` at the lower one, and keeps that.
    fn narrow(&mut self, x: Interval, left: i32, monotone: bool) -> Interval {
        let mut bracket = x;
        for _ in 0..MAX_STEPS {
            let before = bracket;
            if monotone {
                // The one zero survives each Newton step; signs at the new ends are not needed.
                bracket = self.contract(bracket);
            }
            let middle = bracket.mid();
            if middle <= bracket.lo() || middle >= bracket.hi() {
                break;
            }
            let half = match self.sign(middle) {
                Some(0) => return Interval::point(middle),
                Some(sign) if sign == left => Interval::new(middle, bracket.hi()),
                Some(_) => Interval::new(bracket.lo(), middle),
                None => None,
            };
            match half {
                Some(half) => bracket = half,
                None if bracket == before => break,
                None => {}
            }
        }
        bracket
    }

    /// What can be said of an interval that will not be cut: a change of sign around it, an exact zero in it, or nothing.
    fn last_resort(&mut self, x: Interval, range: Interval, roots: &mut Roots) {
        let margin = (2.0 * x.width()).max(4.0 * f64::EPSILON * x.mag());
        let lo = if x.lo() - margin > range.lo() { x.lo() - margin } else { range.lo() };
        let hi = if x.hi() + margin < range.hi() { x.hi() + margin } else { range.hi() };
        let Some(around) = Interval::new(lo, hi).filter(|around| around.is_bounded()) else {
            return roots.unknown.push(x);
        };
        let value = self.enclose(self.problem.f, around);
        if value.decoration() >= Decoration::Dac
            && let (Some(left), Some(right)) = (self.sign(around.lo()), self.sign(around.hi()))
            && left * right < 0
        {
            let monotone = self.slope(around, value).is_some_and(|slope| !slope.contains(0.0));
            let bracket = self.narrow(around, left, monotone);
            roots.proved.push(Root { bracket, alone: monotone.then_some(around) });
            // Another zero in what was asked for is excluded by a slope alone.
            if !monotone {
                roots.unknown.push(x);
            }
            return;
        }
        let exact = [Some(x.lo()), simplest(x), Some(x.hi())].into_iter().flatten();
        for candidate in exact {
            if self.sign(candidate) == Some(0) {
                roots.proved.push(Root { bracket: Interval::point(candidate), alone: None });
            }
        }
        roots.unknown.push(x);
    }

    /// Brackets of the same zero become one, neighbours among the unknown too, and what lies where a zero is proved to
    /// be the only one is known.
    fn tidy(&mut self, roots: &mut Roots) {
        roots.proved.sort_by(|a, b| a.bracket.lo().total_cmp(&b.bracket.lo()));
        let mut proved: Vec<Root> = Vec::new();
        for root in std::mem::take(&mut roots.proved) {
            match proved.last_mut() {
                Some(last) if !last.bracket.disjoint(root.bracket) => *last = self.joined(*last, root),
                _ => proved.push(root),
            }
        }
        let known = |x: Interval, root: &Root| {
            root.alone.is_some_and(|alone| alone.contains_interval(x)) || x.is_singleton() && x == root.bracket
        };
        roots.unknown.retain(|x| proved.iter().all(|root| !known(*x, root)));
        roots.unknown = merged(std::mem::take(&mut roots.unknown));
        roots.proved = proved;
    }

    /// Two overlapping brackets: of one zero if the function is monotone on both together, else of at least one.
    fn joined(&mut self, a: Root, b: Root) -> Root {
        let hull = a.bracket.hull(b.bracket);
        let regions = a.alone.into_iter().chain(b.alone).fold(hull, Interval::hull);
        for (region, bracket) in [(regions, a.bracket.intersect(b.bracket)), (hull, a.bracket.intersect(b.bracket))] {
            let value = self.enclose(self.problem.f, region);
            if region.is_singleton() || self.slope(region, value).is_some_and(|slope| !slope.contains(0.0)) {
                let alone = if region.is_singleton() { a.alone.or(b.alone) } else { Some(region) };
                return Root { bracket, alone };
            }
        }
        Root { bracket: hull, alone: None }
    }
}

/// An interval to be searched; the greatest is the widest.
struct Open(Interval);

impl Ord for Open {
    fn cmp(&self, other: &Self) -> Ordering {
        let Open(a) = self;
        let Open(b) = other;
        a.width().total_cmp(&b.width()).then(b.lo().total_cmp(&a.lo()))
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Open {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Open {}

/// Where to cut an interval; `None` if it is as small as is worth it.
fn split(x: Interval, range: Interval, resolution: f64) -> Option<f64> {
    if is_small(x, range, resolution) {
        return None;
    }
    simplest(x).filter(|&at| at > x.lo() && at < x.hi())
}

/// A coordinate of a ray; what is no number may be any.
pub fn number(x: f64) -> Interval {
    if x.is_finite() { Interval::point(x) } else { Interval::ENTIRE }
}
