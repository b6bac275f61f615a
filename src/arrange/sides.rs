//! Where curves cross the sides of leaves: segments between neighbouring leaves, and on each of them the zeros of each
//! component, isolated as simple roots.

use std::collections::HashMap;
use std::collections::HashSet;

use crate::arrange::complex::Axis;
use crate::arrange::field::Fields;
use crate::arrange::field::Function;
use crate::arrange::field::Sample;
use crate::arrange::subdivide::Leaf;
use crate::arrange::subdivide::excludes_zero;
use crate::arrange::subdivide::truth;
use crate::interval::Interval;

/// Where a stretch is split; see `subdivide`.
const SPLIT: f64 = 0.487_215_309;

/// How often a stretch is halved before its roots are given up.
const HALVINGS: usize = 60;

/// Undecided stretches of one segment beyond which its roots are given up.
const STRETCHES: usize = 24;

/// Steps of Newton's method; it converges quadratically, bisection alone would take as many as a mantissa has bits.
const STEPS: usize = 60;

/// A stretch of the boundary between two leaves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Side {
    pub axis: Axis,
    pub at: f64,
    pub from: f64,
    pub to: f64,
    /// The leaves before and behind: left and right of a vertical side, below and above a horizontal one; `None` outside
    /// the domain.
    pub leaves: [Option<u32>; 2],
}

/// A root of a component on a side.
#[derive(Debug, Clone, PartialEq)]
pub struct Crossing {
    pub component: u32,
    pub place: Interval,
    /// The curves whose condition holds there, rising; none if there is no curve.
    pub curves: Vec<u16>,
}

impl Side {
    /// The part of the side with the given coordinates, as a box.
    pub fn area(&self, range: Interval) -> [Interval; 2] {
        match self.axis {
            Axis::X => [range, Interval::point(self.at)],
            Axis::Y => [Interval::point(self.at), range],
        }
    }

    fn key(&self) -> [u64; 3] {
        [self.at, self.from, self.to].map(f64::to_bits)
    }

    fn along(&self) -> usize {
        self.axis as usize
    }

    pub fn is_frame(&self) -> bool {
        self.leaves.contains(&None)
    }
}

/// The segments of a tiling: as long as both neighbours stay the same. In order of direction, fixed coordinate, place.
pub fn sides(leaves: &[Leaf]) -> Vec<Side> {
    let mut sides = Vec::new();
    for axis in [Axis::X, Axis::Y] {
        let (along, across) = match axis {
            Axis::X => (0, 1),
            Axis::Y => (1, 0),
        };
        // Ends of leaves on lines, with the leaf before or behind the line.
        let mut entries: Vec<(f64, f64, f64, usize, u32)> = Vec::with_capacity(2 * leaves.len());
        for (index, leaf) in leaves.iter().enumerate() {
            let (from, to) = (leaf.area[along].lo(), leaf.area[along].hi());
            entries.push((leaf.area[across].hi(), from, to, 0, index as u32));
            entries.push((leaf.area[across].lo(), from, to, 1, index as u32));
        }
        entries.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        for line in entries.chunk_by(|a, b| a.0 == b.0) {
            let one = |which: usize| line.iter().filter(move |entry| entry.3 == which).copied();
            let (before, behind): (Vec<_>, Vec<_>) = (one(0).collect(), one(1).collect());
            let mut push = |from: f64, to: f64, leaves: [Option<u32>; 2]| {
                sides.push(Side { axis, at: line[0].0, from, to, leaves });
            };
            if before.is_empty() || behind.is_empty() {
                for &(_, from, to, which, leaf) in line {
                    push(from, to, if which == 0 { [Some(leaf), None] } else { [None, Some(leaf)] });
                }
                continue;
            }
            let (mut i, mut j) = (0, 0);
            while i < before.len() && j < behind.len() {
                let (_, a, b, _, first) = before[i];
                let (_, c, d, _, second) = behind[j];
                if a.max(c) < b.min(d) {
                    push(a.max(c), b.min(d), [Some(first), Some(second)]);
                }
                if b <= d {
                    i += 1;
                }
                if d <= b {
                    j += 1;
                }
            }
        }
    }
    sides
}

/// Isolates crossings, and remembers what it found: passes over a tiling that is refined here and there ask again.
pub struct Isolator<'a> {
    pub fields: &'a Fields,
    pub evaluations: u64,
    known: HashMap<([u64; 3], Axis, u32), Option<Vec<Crossing>>>,
    /// Where a component vanishes all along a side; no quartering will help there.
    flat: HashSet<[u64; 3]>,
}

/// One component on one side.
#[derive(Clone, Copy)]
struct Request {
    side: Side,
    component: u32,
}

impl Request {
    fn key(&self) -> ([u64; 3], Axis, u32) {
        (self.side.key(), self.side.axis, self.component)
    }
}

/// A stretch of a request, later the bracket of one root.
struct Stretch {
    request: u32,
    range: Interval,
}

impl<'a> Isolator<'a> {
    pub fn new(fields: &'a Fields) -> Self {
        Self { fields, evaluations: 0, known: HashMap::new(), flat: HashSet::new() }
    }

    fn evaluate(&mut self, queries: &[(Function, [Interval; 2])]) -> Vec<Sample> {
        self.evaluations += queries.len() as u64;
        self.fields.evaluate(queries)
    }

    /// The crossings on each side, in rising order; `None` where they could not be isolated or told apart.
    pub fn crossings(&mut self, sides: &[Side], leaves: &[Leaf]) -> Vec<Option<Vec<Crossing>>> {
        let mut requests = Vec::new();
        let mut spans = Vec::with_capacity(sides.len());
        for side in sides {
            let start = requests.len();
            requests.extend(shared(side, leaves).into_iter().map(|component| Request { side: *side, component }));
            spans.push(start..requests.len());
        }
        let fresh: Vec<Request> = requests.iter().filter(|r| !self.known.contains_key(&r.key())).copied().collect();
        let found = self.isolate(&fresh);
        self.known.extend(fresh.iter().map(Request::key).zip(found));
        let merged = spans.into_iter().map(|span| {
            let mut crossings = Vec::new();
            for request in &requests[span] {
                crossings.extend(self.known[&request.key()].as_ref()?.iter().cloned());
            }
            crossings.sort_by(|a, b| a.place.lo().total_cmp(&b.place.lo()));
            crossings.windows(2).all(|pair| pair[0].place.hi() < pair[1].place.lo()).then_some(crossings)
        });
        merged.collect()
    }

    /// Whether a curve is known to run along a side.
    pub fn is_flat(&self, side: &Side) -> bool {
        self.flat.contains(&side.key())
    }

    /// The roots of each request; `None` where they are not all proved simple.
    fn isolate(&mut self, requests: &[Request]) -> Vec<Option<Vec<Crossing>>> {
        let function = |request: u32| self.fields.components[requests[request as usize].component as usize].function;
        let functions: Vec<Function> = (0..requests.len() as u32).map(function).collect();
        let query = |stretch: &Stretch, range: Interval| {
            (functions[stretch.request as usize], requests[stretch.request as usize].side.area(range))
        };
        let mut failed = vec![false; requests.len()];
        let mut open: Vec<Stretch> = (0..)
            .zip(requests)
            .filter_map(|(request, r)| Some(Stretch { request, range: Interval::new(r.side.from, r.side.to)? }))
            .collect();
        let mut monotone = Vec::new();
        for _ in 0..HALVINGS {
            let queries: Vec<_> = open.iter().map(|stretch| query(stretch, stretch.range)).collect();
            let samples = self.evaluate(&queries);
            let mut next: Vec<Stretch> = Vec::new();
            for (stretch, sample) in open.into_iter().zip(samples) {
                let request = stretch.request as usize;
                let slope = sample.slope[requests[request].side.along()];
                if sample.value == Interval::ZERO && !stretch.range.is_singleton() {
                    self.flat.insert(requests[request].side.key());
                    failed[request] = true;
                }
                if sample.is_refuted() || failed[request] {
                } else if sample.is_continuous() && excludes_zero(slope) {
                    monotone.push((stretch, slope.lo() > 0.0));
                } else {
                    let (lo, hi) = (stretch.range.lo(), stretch.range.hi());
                    let split = lo + SPLIT * (hi - lo);
                    match (Interval::new(lo, split), Interval::new(split, hi)) {
                        (Some(low), Some(high)) if lo < split && split < hi => {
                            next.extend([low, high].map(|range| Stretch { request: stretch.request, range }));
                        }
                        _ => failed[request] = true,
                    }
                }
            }
            // Stretches of one request are neighbours.
            for stretches in next.chunk_by(|a, b| a.request == b.request) {
                failed[stretches[0].request as usize] |= stretches.len() > STRETCHES;
            }
            open = next;
        }
        for stretch in open {
            failed[stretch.request as usize] = true;
        }
        let ends = |stretch: &Stretch| [stretch.range.lo(), stretch.range.hi()].map(Interval::point);
        let queries: Vec<_> =
            monotone.iter().flat_map(|(stretch, _)| ends(stretch).map(|end| query(stretch, end))).collect();
        let samples = self.evaluate(&queries);
        let mut roots = Vec::new();
        for ((stretch, rising), samples) in monotone.into_iter().zip(samples.chunks(2)) {
            let request = stretch.request as usize;
            let sign = |end: usize| {
                let sign = self.sign(&samples[end], &requests[request].side, ends(&stretch)[end].lo());
                if rising { sign } else { -sign }
            };
            match (sign(0), sign(1)) {
                (-1, 1) => roots.push(stretch),
                (1, _) | (_, -1) => {}
                _ => failed[request] = true,
            }
        }
        roots.retain(|stretch| !failed[stretch.request as usize]);
        self.refine(requests, &functions, &mut roots);
        let labels = self.labels(requests, &roots);
        let mut results: Vec<Option<Vec<Crossing>>> = failed.iter().map(|&failed| (!failed).then(Vec::new)).collect();
        for (stretch, curves) in roots.into_iter().zip(labels) {
            let request = stretch.request as usize;
            let component = requests[request].component;
            match (curves, &mut results[request]) {
                (Some(curves), Some(found)) => found.push(Crossing { component, place: stretch.range, curves }),
                (None, result) => *result = None,
                _ => {}
            }
        }
        results
    }

    /// The sign of a function at an end of a stretch: -1, 1, or 0 if it is not known. A curve through a corner of the domain
    /// is taken to pass it as if the domain were higher by an infinitesimal amount, provided that it enters there: then the
    /// part inside is the same.
    fn sign(&self, sample: &Sample, side: &Side, end: f64) -> i32 {
        if sample.value.lo() > 0.0 {
            return 1;
        }
        if sample.value.hi() < 0.0 {
            return -1;
        }
        let [x, y] = side.area(Interval::point(end)).map(Interval::lo);
        let [columns, rows] = self.fields.domain;
        let (right, top) = (x == columns.hi(), y == rows.hi());
        let corner = (right || x == columns.lo()) && (top || y == rows.lo());
        if !corner || sample.value != Interval::ZERO || !sample.is_continuous() {
            return 0;
        }
        let sign = |x: Interval| i32::from(x.lo() > 0.0) - i32::from(x.hi() < 0.0);
        let [fx, fy] = sample.slope.map(sign);
        // The tangent is (f_y, -f_x).
        let enters = if right == top { fx * fy < 0 } else { fx * fy > 0 };
        if !enters {
            return 0;
        }
        if top { fy } else { -fy }
    }

    /// Narrows brackets of simple roots by the interval Newton method (Moore 1966).
    fn refine(&mut self, requests: &[Request], functions: &[Function], roots: &mut [Stretch]) {
        let mut going: Vec<usize> = (0..roots.len()).collect();
        for _ in 0..STEPS {
            if going.is_empty() {
                return;
            }
            let mut queries = Vec::with_capacity(2 * going.len());
            for &index in &going {
                let Stretch { request, range } = &roots[index];
                let (function, side) = (functions[*request as usize], requests[*request as usize].side);
                queries.push((function, side.area(*range)));
                queries.push((function, side.area(Interval::point(range.mid()))));
            }
            let samples = self.evaluate(&queries);
            let mut still = Vec::new();
            for (&index, samples) in going.iter().zip(samples.chunks(2)) {
                let Stretch { request, range } = &mut roots[index];
                let slope = samples[0].slope[requests[*request as usize].side.along()];
                let next = range.intersect(Interval::point(range.mid()) - samples[1].value / slope);
                // The root is in both.
                if !next.is_empty() && next.width() < 0.9 * range.width() {
                    *range = next;
                    still.push(index);
                }
            }
            going = still;
        }
    }

    /// The curves that run through each root; `None` where a condition is undecided.
    fn labels(&mut self, requests: &[Request], roots: &[Stretch]) -> Vec<Option<Vec<u16>>> {
        let fields = self.fields;
        let uses =
            |stretch: &Stretch| fields.components[requests[stretch.request as usize].component as usize].uses.iter();
        let mut queries = Vec::new();
        for stretch in roots {
            let area = requests[stretch.request as usize].side.area(stretch.range);
            queries.extend(uses(stretch).filter_map(|used| Some((used.condition?, area))));
        }
        let mut samples = self.evaluate(&queries).into_iter();
        let labels = roots.iter().map(|stretch| {
            let truths: Vec<Option<bool>> = uses(stretch)
                .map(|used| match used.condition {
                    None => Some(true),
                    Some(_) => truth(&samples.next().expect("one sample for each query")),
                })
                .collect();
            let mut curves = Vec::new();
            for (used, truth) in uses(stretch).zip(truths) {
                if truth? {
                    curves.push(used.curve);
                }
            }
            curves.sort_unstable();
            curves.dedup();
            Some(curves)
        });
        labels.collect()
    }
}

/// The components that may cross a side with a curve on one side of it: their zero sets may meet both neighbours. Sides
/// inside a cluster need none.
fn shared(side: &Side, leaves: &[Leaf]) -> Vec<u32> {
    let neighbours = side.leaves.map(|leaf| leaf.map(|leaf| &leaves[leaf as usize]));
    let active = |leaf: &Leaf| leaf.active.iter().map(|active| active.component).collect::<Vec<u32>>();
    match neighbours {
        [Some(first), Some(second)] if first.open && second.open => Vec::new(),
        [Some(first), Some(second)] => {
            let meets = |leaf: &Leaf, component: &u32| {
                leaf.active.iter().any(|active| active.component == *component) || leaf.silent.contains(component)
            };
            let mut shared = active(first);
            shared.retain(|component| meets(second, component));
            shared.extend(active(second).into_iter().filter(|component| first.silent.contains(component)));
            shared
        }
        [one, other] => one.or(other).map(active).unwrap_or_default(),
    }
}
