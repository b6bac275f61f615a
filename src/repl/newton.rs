//! All zeros of a function of one variable in an interval, proved: interval Newton with bisection on the reference
//! arithmetic (Moore, Interval Analysis, 1966; Hansen and Walster, Global Optimization Using Interval Analysis, 2004).
//!
//! A zero is proved by opposite signs at the ends of an interval on which the function is proved continuous, by a Newton
//! step into the interior of such an interval, or by a value that is exactly 0. It is the only one where the derivative
//! excludes 0. An interval is refuted if its enclosure excludes 0. All else is unknown: among it, poles where the
//! function changes its sign, and zeros that it touches without crossing.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use crate::derive;
use crate::graph;
use crate::graph::Graph;
use crate::graph::Op;
use crate::graph::Value;
use crate::interval::Decorated;
use crate::interval::Decoration;
use crate::interval::Interval;

/// Evaluations of graph nodes that one search may take.
const BUDGET: usize = 6_000_000;
/// Undecided intervals of this part of the search interval, or of a number's size, are given up.
const RESOLUTION: f64 = 1.0 / (1u64 << 40) as f64;
/// With so many intervals open, those of the next part of that size are given up: a zero that the function touches, at
/// which rounding errors decide, would fill the search with ever smaller ones.
const CROWD: usize = 256;
const CROWDED: f64 = 1.0 / (1u64 << 26) as f64;
/// Intervals that are looked at once more when the search is over.
const MAX_RESORTS: usize = 64;
/// Steps that narrow one bracket; quadratic convergence needs few, bisection one a bit.
const MAX_STEPS: usize = 200;

/// An interval that is proved to hold a zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Root {
    pub bracket: Interval,
    /// Where it is proved to be the only zero.
    pub alone: Option<Interval>,
}

/// The zeros in an interval: there is none outside of the proved brackets and the unknown rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Roots {
    pub proved: Vec<Root>,
    pub unknown: Vec<Interval>,
    /// Whether the search ended before everything was tried.
    pub exhausted: bool,
}

/// A function of one variable, all others having values.
pub struct Search {
    graph: Graph,
    f: Value,
    slope: Value,
    /// Values that are 0 wherever the function is.
    factors: Vec<Value>,
    boxes: Vec<Decorated>,
    /// The place of the variable among the boxes.
    variable: usize,
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
    /// `boxes` are those of the graph's variables in their order, `variable` is the place of the one to be searched.
    pub fn new(graph: &Graph, root: Value, boxes: &[Decorated], variable: usize) -> Self {
        let mut graph = graph.clone();
        let name = graph.variables()[variable].clone();
        let x = graph.var(&name);
        let slope = derive::derivative(&mut graph, root, x);
        let factors = factors(&mut graph, root);
        Self { graph, f: root, slope, factors, boxes: boxes.to_vec(), variable, spent: 0 }
    }

    /// All zeros in an interval.
    pub fn run(mut self, range: Interval) -> Roots {
        let mut roots = Roots { proved: Vec::new(), unknown: Vec::new(), exhausted: false };
        let mut open = BinaryHeap::from([Open(range)]);
        let mut rest = Vec::new();
        // The widest first: when the search has to end, what is unknown is as short as can be.
        while let Some(Open(x)) = open.pop() {
            let crowded = open.len() > CROWD && x.width() <= CROWDED * scale(x, range);
            if self.spent > BUDGET || crowded {
                roots.exhausted |= !crowded;
                rest.push(x);
                continue;
            }
            match self.examine(x) {
                Finding::Refuted => {}
                Finding::Root(root) => roots.proved.push(root),
                Finding::Narrowed(narrower) => open.push(Open(narrower)),
                Finding::Undecided => match split(x, range) {
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
                0..MAX_RESORTS => self.last_resort(x, range, &mut roots),
                _ => roots.unknown.push(x),
            }
        }
        self.tidy(&mut roots);
        roots
    }

    fn enclose(&mut self, value: Value, x: Interval) -> Decorated {
        self.boxes[self.variable] = Decorated::new(x);
        self.spent += self.graph.len();
        graph::enclose(&self.graph, &[value], &self.boxes)[0]
    }

    /// The sign of the function at a number: -1, 0 or 1 if proved.
    fn sign(&mut self, x: f64) -> Option<i32> {
        let value = self.enclose(self.f, Interval::point(x));
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
        (0..self.factors.len()).any(|i| excludes(self.enclose(self.factors[i], x).interval()))
    }

    /// The derivative where the function is proved continuous and the derivative proved defined.
    fn slope(&mut self, x: Interval, value: Decorated) -> Option<Interval> {
        if value.decoration() < Decoration::Dac {
            return None;
        }
        let slope = self.enclose(self.slope, x);
        (slope.decoration() >= Decoration::Def).then_some(slope.interval())
    }

    fn examine(&mut self, x: Interval) -> Finding {
        let value = self.enclose(self.f, x);
        if self.refuted(x, value.interval()) {
            return Finding::Refuted;
        }
        let Some(slope) = self.slope(x, value).filter(|_| x.is_bounded() && !x.is_singleton()) else {
            return Finding::Undecided;
        };
        let Some(newton) = self.newton(x, slope) else { return Finding::Refuted };
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
        if newton.contains_in_interior(x) {
            // The Newton operator maps the interval into its interior: there is a zero, and the slope allows one only.
            return Finding::Root(Root { bracket: self.contract(newton), alone: Some(x) });
        }
        if newton.width() < 0.75 * x.width() { Finding::Narrowed(newton) } else { Finding::Undecided }
    }

    /// What a Newton step leaves of an interval on which the function has the given slopes; `None` if there is no zero.
    fn newton(&mut self, x: Interval, slope: Interval) -> Option<Interval> {
        let middle = x.mid();
        let value = self.enclose(self.f, Interval::point(middle)).interval();
        // Mean value theorem: 0 = f(root) is in f(middle) + slope (root - middle).
        let step = if slope.contains(0.0) {
            let values = value + slope * (x - Interval::point(middle));
            return values.contains(0.0).then_some(x);
        } else {
            value / slope
        };
        let left = (Interval::point(middle) - step).intersect(x);
        (!left.is_empty()).then_some(left)
    }

    /// Newton steps on an interval that holds exactly one zero, while they help.
    fn contract(&mut self, mut x: Interval) -> Interval {
        for _ in 0..MAX_STEPS {
            let value = self.enclose(self.f, x);
            let Some(slope) = self.slope(x, value).filter(|slope| !slope.contains(0.0)) else { break };
            match self.newton(x, slope) {
                Some(narrower) if narrower.width() < x.width() => x = narrower,
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
        let value = self.enclose(self.f, around);
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
            let value = self.enclose(self.f, region);
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

/// What the width of a part of the search interval is measured by: that interval, or the part's own numbers.
fn scale(x: Interval, range: Interval) -> f64 {
    range.width().min(x.mag().max(1.0))
}

/// Where to cut an interval; `None` if it is as small as is worth it.
fn split(x: Interval, range: Interval) -> Option<f64> {
    if x.is_bounded() && x.width() <= (RESOLUTION * scale(x, range)).max(f64::MIN_POSITIVE) {
        return None;
    }
    simplest(x).filter(|&at| at > x.lo() && at < x.hi())
}

/// Intervals in order, with those that touch made one.
fn merged(mut intervals: Vec<Interval>) -> Vec<Interval> {
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

/// Values that are 0 wherever `root` is 0: of a quotient the dividend, of a power the base, and so on inward; a tangent
/// gives its sine. They have no poles where the root has one.
fn factors(graph: &mut Graph, root: Value) -> Vec<Value> {
    let mut found = Vec::new();
    let mut value = root;
    loop {
        let node = *graph.node(value);
        value = match node.op {
            Op::Div | Op::Neg | Op::Sqr | Op::Sqrt | Op::Cbrt | Op::Abs | Op::Asin | Op::Atan | Op::Sinh | Op::Tanh => {
                node.operands()[0]
            }
            Op::PowInt(n) if n > 0 => node.operands()[0],
            Op::PowRatio(p, _) if p > 0 => node.operands()[0],
            Op::Tan => {
                let sine = graph.push(Op::Sin, node.operands());
                found.push(sine);
                return found;
            }
            _ => return found,
        };
        found.push(value);
    }
}

/// A number in the middle half of an interval: 0, or the one divisible by the largest power of two.
fn simplest(x: Interval) -> Option<f64> {
    let (lo, hi) = match (x.lo() == f64::NEG_INFINITY, x.hi() == f64::INFINITY) {
        (true, true) => return Some(0.0),
        (false, true) => return Some(if x.lo() < 1.0 { 1.0 } else { 2.0 * x.lo() }).filter(|at| at.is_finite()),
        (true, false) => return Some(if x.hi() > -1.0 { -1.0 } else { 2.0 * x.hi() }).filter(|at| at.is_finite()),
        (false, false) => {
            let quarter = x.hi() / 4.0 - x.lo() / 4.0;
            (x.lo() + quarter, x.hi() - quarter)
        }
    };
    if lo <= 0.0 && hi >= 0.0 {
        return Some(0.0);
    }
    if lo > hi {
        return None;
    }
    // The largest power of two that does not exceed the width has a multiple inside, unless rounding is in the way.
    let exponent = (hi - lo).max(f64::MIN_POSITIVE).log2().floor() as i32 + 1;
    let multiple = |exponent: i32| {
        let unit = 2f64.powi(exponent);
        let number = (lo / unit).ceil() * unit;
        (unit > 0.0 && number >= lo && number <= hi).then_some(number)
    };
    let larger = (exponent..exponent + 64).rev().find_map(multiple);
    larger.or_else(|| multiple(exponent - 1)).or_else(|| multiple(exponent - 2)).or(Some(x.mid()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::expression::Bindings;
    use crate::session::expression::Reading;
    use crate::session::expression::Snippet;
    use crate::session::expression::Workspace;

    fn roots(text: &str, lo: f64, hi: f64) -> Roots {
        let workspace = Workspace::default();
        let expression = workspace.expression(&Snippet::whole("", text), &["x"], Reading::Zero).unwrap();
        let boxes = expression.boxes(&Bindings::new());
        Search::new(&expression.graph, expression.root, &boxes, 0).run(Interval::new(lo, hi).unwrap())
    }

    /// Every given zero is in a proved bracket of its own, which is narrow, alone, and nothing is unknown.
    fn complete(text: &str, lo: f64, hi: f64, zeros: &[f64]) {
        let found = roots(text, lo, hi);
        assert!(found.unknown.is_empty() && !found.exhausted, "{text}: {found:?}");
        assert_eq!(found.proved.len(), zeros.len(), "{text}: {found:?}");
        for (root, zero) in found.proved.iter().zip(zeros) {
            let near = Interval::new(zero - 1e-15 * zero.abs(), zero + 1e-15 * zero.abs()).unwrap();
            assert!(!root.bracket.disjoint(near), "{text}: {root:?} is not {zero}");
            assert!(root.bracket.width() <= 1e-14 * zero.abs().max(1e-300), "{text}: {root:?}");
            assert!(root.alone.is_some_and(|alone| alone.contains_interval(root.bracket)), "{text}: {root:?}");
        }
    }

    #[test]
    fn simple_zeros_are_all_proved_and_narrow() {
        use std::f64::consts::PI;
        complete("x^2 - 2", 0.0, 2.0, &[2f64.sqrt()]);
        complete("x^2 = 2", -10.0, 10.0, &[-(2f64.sqrt()), 2f64.sqrt()]);
        complete("sin(x)", 1.0, 20.0, &[PI, 2.0 * PI, 3.0 * PI, 4.0 * PI, 5.0 * PI, 6.0 * PI]);
        complete("cos(x) = x", -100.0, 100.0, &[0.739_085_133_215_160_6]);
        complete("exp(x) - 3", f64::NEG_INFINITY, f64::INFINITY, &[3f64.ln()]);
        complete("x^3 - x", -2.0, 2.0, &[-1.0, 0.0, 1.0]);
        complete("(x - 1)(x - 2)(x - 3)", 0.5, 3.5, &[1.0, 2.0, 3.0]);
        complete("ln(x)", 0.0, 10.0, &[1.0]);
        complete("x^2 + 1", -10.0, 10.0, &[]);
    }

    #[test]
    fn zeros_at_the_ends_count() {
        complete("x^2 - 4", 2.0, 3.0, &[2.0]);
        complete("x - 1", 0.0, 1.0, &[1.0]);
    }

    #[test]
    fn poles_are_never_roots() {
        complete("1/x", -1.0, 2.0, &[]);
        complete("tan(x)", 1.0, 4.0, &[std::f64::consts::PI]);
        complete("1/x - 2", -1.0, 1.0, &[0.5]);
        let beside = roots("tan(x) + 1", 1.0, 3.0);
        assert_eq!(beside.proved.len(), 1, "{beside:?}");
        assert!(beside.proved[0].bracket.contains(0.75 * std::f64::consts::PI), "{beside:?}");
        assert!(beside.unknown.len() == 1 && beside.unknown[0].width() < 1e-10, "{beside:?}");
        let jump = roots("floor(x) - 1/2", 0.2, 1.7);
        assert!(jump.proved.is_empty() && jump.unknown.iter().any(|x| x.contains(1.0)), "{jump:?}");
    }

    #[test]
    fn touching_zeros_are_unknown_but_where_they_are_exact() {
        let touching = roots("x^2 - 2 sqrt(2) x + 2", 0.0, 3.0);
        assert!(touching.proved.is_empty(), "{touching:?}");
        assert!(touching.unknown.iter().any(|x| x.contains(2f64.sqrt())), "{touching:?}");
        assert!(touching.unknown.iter().all(|x| (x.mid() - 2f64.sqrt()).abs() < 1e-5), "{touching:?}");
        let exact = roots("(x - 1)^2", 0.0, 3.0);
        assert!(exact.proved.iter().all(|root| root.bracket == Interval::ONE), "{exact:?}");
        assert_eq!(exact.proved.len(), 1, "{exact:?}");
    }

    #[test]
    fn triple_zeros_are_proved_without_being_alone() {
        let triple = roots("(x - 1/3)^3", 0.0, 1.0);
        assert_eq!(triple.proved.len(), 1, "{triple:?}");
        assert!(triple.proved[0].bracket.contains(1.0 / 3.0) && triple.proved[0].alone.is_none(), "{triple:?}");
    }

    #[test]
    fn endless_zeros_end() {
        let dense = roots("sin(1/x)", 0.0, 1.0);
        assert!(dense.exhausted || !dense.unknown.is_empty());
        assert!(dense.proved.iter().any(|root| root.bracket.contains(std::f64::consts::FRAC_1_PI)));
        assert!(dense.proved.iter().all(|root| root.bracket.lo() > 0.0));
        let zero = roots("x - x", -1.0, 1.0);
        assert!(!zero.unknown.is_empty() && zero.proved.iter().all(|root| root.alone.is_none()), "{zero:?}");
    }
}
