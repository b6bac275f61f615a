//! One expression enclosed in every way that Imp knows: how wide, how many operations, how long.

use std::collections::HashMap;
use std::sync::Arc;
use std::time::Duration;
use std::time::Instant;

use serde::Serialize;

use crate::accuracy::Progress;
use crate::accuracy::level::precision_name;
use crate::accuracy::level::rounding_name;
use crate::accuracy::number::serialize;
use crate::accuracy::number::serialize_pair;
use crate::accuracy::pareto;
use crate::accuracy::range::Range;
use crate::derive::Arithmetic;
use crate::derive::Extension;
use crate::derive::Formula;
use crate::derive::Output;
use crate::derive::Precision;
use crate::derive::Rounding;
use crate::derive::Spec;
use crate::diagnostic::Diagnostic;
use crate::graph::Graph;
use crate::graph::Value;
use crate::interval::Decorated;
use crate::interval::Interval;
use crate::kernel::Backend;
use crate::kernel::Real;
use crate::kernel::verdict;
use crate::passes;
use crate::render::Batch;
use crate::render::Format;
use crate::render::Program;
use crate::render::median;

/// Into how many parts each input is cut.
const PARTS: [u32; 6] = [1, 4, 16, 64, 256, 1024];

/// Boxes beyond which a subdivision is left out.
const BOXES: u64 = 1 << 16;

/// A subdivision that would take longer than this is left out.
const PATIENCE: Duration = Duration::from_secs(2);

/// Time is measured over at least this long, so that the clock's own steps do not show.
const LEAST: Duration = Duration::from_millis(2);

/// Packets that a compiled kernel evaluates in one call.
const GROUPS: usize = 32;

/// What accuracy costs for one expression.
#[derive(Debug, Clone, Serialize)]
pub struct ExpressionCost {
    pub expression: String,
    pub version: &'static str,
    pub inputs: Vec<Input>,
    /// Nothing if the expression was defined at no point that was tried.
    pub range: Option<Range>,
    /// How often each time was measured; the median counts.
    pub repeats: u32,
    /// What ratios of time refer to.
    pub baseline: String,
    /// Sorted by excess, then time; behind them what lost values, then what failed.
    pub enclosures: Vec<Enclosed>,
}

/// The box of one variable.
#[derive(Debug, Clone, Serialize)]
pub struct Input {
    pub name: String,
    #[serde(serialize_with = "serialize")]
    pub lo: f64,
    #[serde(serialize_with = "serialize")]
    pub hi: f64,
}

/// What computes an enclosure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Method {
    /// An extension in reference arithmetic: f64, rounded outward.
    Reference(Extension),
    /// A compiled kernel.
    Kernel { arithmetic: Arithmetic, precision: Precision, rounding: Rounding },
}

/// One way with one subdivision, and what came of it.
#[derive(Debug, Clone, Serialize)]
pub struct Enclosed {
    /// The place in the order, from 1.
    pub number: usize,
    pub name: String,
    /// `reference` or `compiled`.
    pub engine: &'static str,
    /// The extension's name.
    pub arithmetic: &'static str,
    pub precision: &'static str,
    pub rounding: &'static str,
    /// Parts into which each input is cut, and boxes in all.
    pub parts: u32,
    pub boxes: u64,
    #[serde(flatten)]
    pub outcome: Outcome,
}

#[derive(Debug, Clone, Serialize)]
#[serde(untagged)]
pub enum Outcome {
    Measured(Measured),
    /// Why there are no numbers.
    Failed {
        failure: String,
    },
}

#[derive(Debug, Clone, Serialize)]
pub struct Measured {
    /// The hull of all parts' enclosures; the lower end is above the upper one if it is empty.
    #[serde(serialize_with = "serialize")]
    pub lo: f64,
    #[serde(serialize_with = "serialize")]
    pub hi: f64,
    #[serde(serialize_with = "serialize")]
    pub width: f64,
    /// The width less that of the true range, between these.
    #[serde(serialize_with = "serialize_pair")]
    pub excess: [f64; 2],
    /// Whether all values that are known to be taken lie inside.
    pub holds: bool,
    /// What is known of the function on the box, where the way carries it.
    pub decoration: Option<String>,
    /// Operations for one box: on numbers for the reference, lane operations of compiled code.
    pub operations: u64,
    /// Time for one box in nanoseconds, and for all of them in microseconds.
    pub ns_per_box: f64,
    pub us: f64,
    /// `us` over the baseline's.
    pub ratio: Option<f64>,
    /// On the Pareto front of excess and time among what is rounded outward.
    pub pareto: bool,
}

impl Enclosed {
    pub fn measured(&self) -> Option<&Measured> {
        match &self.outcome {
            Outcome::Measured(measured) => Some(measured),
            Outcome::Failed { .. } => None,
        }
    }
}

impl Method {
    /// All extensions, then the kernels.
    fn all() -> Vec<Method> {
        let mut methods: Vec<Method> = Extension::ALL.iter().copied().map(Method::Reference).collect();
        for arithmetic in [Arithmetic::Interval, Arithmetic::Affine] {
            for precision in [Precision::Double, Precision::Single] {
                for rounding in [Rounding::Outward, Rounding::Nearest] {
                    methods.push(Method::Kernel { arithmetic, precision, rounding });
                }
            }
        }
        methods
    }

    /// Engine, arithmetic, format and rounding.
    fn names(self) -> [&'static str; 4] {
        match self {
            Method::Reference(extension) => ["reference", extension.name(), "f64", "outward"],
            Method::Kernel { arithmetic, precision, rounding } => {
                let arithmetic = if arithmetic == Arithmetic::Affine { "affine" } else { "interval" };
                ["compiled", arithmetic, precision_name(precision), rounding_name(rounding)]
            }
        }
    }
}

/// What is measured: the formula `root` over a box for each variable of the graph, in their order.
#[derive(Debug, Clone, Copy)]
pub struct Subject<'a> {
    /// The expression as it was written.
    pub text: &'a str,
    pub graph: &'a Graph,
    pub root: Value,
    pub inputs: &'a [Decorated],
}

/// Encloses an expression in every way and with every subdivision. A way that fails is a row that says why.
pub fn of_expression(subject: Subject, repeats: u32, backend: &dyn Backend, progress: Progress<'_>) -> ExpressionCost {
    let formula = Formula::new(subject.graph, subject.root);
    let methods = Method::all();
    let steps = methods.len() + 1;
    progress(0, steps, "the true range");
    let range = Range::of(&formula, subject.inputs);
    let mut rows = Vec::new();
    for (index, &method) in methods.iter().enumerate() {
        let [engine, arithmetic, precision, rounding] = method.names();
        progress(index + 1, steps, &format!("{engine} {arithmetic} {precision} {rounding}"));
        let bench = Bench { subject, formula: &formula, range, repeats };
        for (parts, outcome) in bench.measure(method, backend) {
            let name = match method {
                Method::Reference(_) => format!("{arithmetic} x{parts}"),
                Method::Kernel { .. } => format!("compiled {arithmetic} {precision} {rounding} x{parts}"),
            };
            let boxes = boxes(subject.inputs, parts).unwrap_or(u64::MAX);
            rows.push(Enclosed { number: 0, name, engine, arithmetic, precision, rounding, parts, boxes, outcome });
        }
    }
    progress(steps, steps, "");
    finish(subject, range, repeats, rows)
}

/// Ratios, the front and the order of all rows, of which the first is the baseline.
fn finish(subject: Subject, range: Option<Range>, repeats: u32, mut rows: Vec<Enclosed>) -> ExpressionCost {
    let baseline = rows.first().map_or_else(String::new, |row| row.name.clone());
    let unit = rows.first().and_then(Enclosed::measured).map(|measured| measured.us);
    // An enclosure is worth its proof: what is rounded to nearest competes with nothing.
    let outward = rounding_name(Rounding::Outward);
    let point = |row: &Enclosed| row.measured().filter(|_| row.rounding == outward).map(|m| (m.excess[1], m.us));
    let points: Vec<(f64, f64)> = rows.iter().map(|row| point(row).unwrap_or((f64::NAN, f64::NAN))).collect();
    for (row, pareto) in rows.iter_mut().zip(pareto::front(&points)) {
        if let Outcome::Measured(measured) = &mut row.outcome {
            measured.ratio = unit.map(|unit| measured.us / unit);
            measured.pareto = pareto;
        }
    }
    // What lost values comes behind what holds, and what failed comes last.
    let key =
        |row: &Enclosed| row.measured().map_or((2, f64::NAN, f64::NAN), |m| (u8::from(!m.holds), m.excess[1], m.us));
    rows.sort_by(|a, b| {
        let (a, b) = (key(a), key(b));
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.total_cmp(&b.2))
    });
    for (number, row) in rows.iter_mut().enumerate() {
        row.number = number + 1;
    }
    let inputs = subject.graph.variables().iter().zip(subject.inputs);
    let input =
        |(name, x): (&String, &Decorated)| Input { name: name.clone(), lo: x.interval().lo(), hi: x.interval().hi() };
    ExpressionCost {
        expression: subject.text.to_owned(),
        version: env!("CARGO_PKG_VERSION"),
        inputs: inputs.map(input).collect(),
        range,
        repeats,
        baseline,
        enclosures: rows,
    }
}

/// The number of boxes if each input is cut into so many parts: points and unbounded inputs are not.
fn boxes(inputs: &[Decorated], parts: u32) -> Option<u64> {
    let cut = inputs.iter().filter(|x| is_cut(x.interval())).count() as u32;
    u64::from(parts).checked_pow(cut)
}

fn is_cut(x: Interval) -> bool {
    x.is_bounded() && !x.is_singleton()
}

struct Bench<'a> {
    subject: Subject<'a>,
    formula: &'a Formula,
    range: Option<Range>,
    repeats: u32,
}

impl Bench<'_> {
    /// Every subdivision that has not too many boxes.
    fn measure(&self, method: Method, backend: &dyn Backend) -> Vec<(u32, Outcome)> {
        let inputs = self.subject.inputs;
        let several = inputs.iter().any(|x| is_cut(x.interval()));
        let parts = PARTS.iter().copied().filter(|&parts| parts == 1 || several);
        let mut parts: Vec<u32> = parts.filter(|&parts| boxes(inputs, parts).is_some_and(|n| n <= BOXES)).collect();
        parts.sort_unstable();
        let outcomes = match method {
            Method::Reference(extension) => parts.iter().map(|&parts| self.reference(extension, parts)).collect(),
            Method::Kernel { arithmetic, precision, rounding } => {
                let spec = self.spec(arithmetic, rounding);
                let measured = match precision {
                    Precision::Single => self.kernel::<f32>(&spec, &parts, backend),
                    Precision::Double => self.kernel::<f64>(&spec, &parts, backend),
                };
                measured.unwrap_or_else(|diagnostic| {
                    let failed = Outcome::Failed { failure: diagnostic.title };
                    vec![failed; parts.len()]
                })
            }
        };
        parts.into_iter().zip(outcomes).collect()
    }

    fn reference(&self, extension: Extension, parts: u32) -> Outcome {
        let inputs = self.subject.inputs;
        // One box first: derivatives are derived when they are first asked for, and the time foretells that of all boxes.
        self.formula.enclose(extension, inputs);
        let start = Instant::now();
        self.formula.enclose(extension, inputs);
        let boxes = boxes(inputs, parts).unwrap_or(u64::MAX);
        let foretold = start.elapsed().mul_f64(boxes as f64);
        if foretold > PATIENCE {
            return Outcome::Failed {
                failure: format!("left out: {boxes} boxes would take {:.0} s", foretold.as_secs_f64()),
            };
        }
        let (value, seconds) = self.timed(|| self.formula.enclose_in_parts(extension, inputs, parts));
        let interval = value.interval();
        let hull =
            if interval.is_empty() { (f64::INFINITY, f64::NEG_INFINITY) } else { (interval.lo(), interval.hi()) };
        self.outcome(hull, Some(value.decoration().to_string()), self.formula.operations(extension), boxes, seconds)
    }

    /// What work gives, and how many seconds it takes: the median of the repeats, each long enough for the clock.
    fn timed<R>(&self, mut work: impl FnMut() -> R) -> (R, f64) {
        let start = Instant::now();
        let mut value = work();
        let once = start.elapsed().max(Duration::from_nanos(20));
        let rounds = (LEAST.as_secs_f64() / once.as_secs_f64()).ceil().clamp(1.0, 100_000.0) as u32;
        let mut times = Vec::new();
        for _ in 0..self.repeats.max(1) {
            let start = Instant::now();
            for _ in 0..rounds {
                value = std::hint::black_box(work());
            }
            times.push(start.elapsed().as_secs_f64() / f64::from(rounds));
        }
        (value, median(times))
    }

    fn outcome(
        &self,
        (lo, hi): (f64, f64),
        decoration: Option<String>,
        operations: u64,
        boxes: u64,
        seconds: f64,
    ) -> Outcome {
        let width = if lo > hi { 0.0 } else { hi - lo };
        let true_width = self.range.map_or([0.0; 2], |range| range.width());
        Outcome::Measured(Measured {
            lo,
            hi,
            width,
            // Rounding of the differences is far below what is shown; a negative excess would mean a lost value.
            excess: [(width - true_width[1]).max(0.0), (width - true_width[0]).max(0.0)],
            holds: self.range.is_none_or(|range| range.is_held_by(lo, hi)),
            decoration,
            operations,
            ns_per_box: 1e9 * seconds / boxes as f64,
            us: 1e6 * seconds,
            ratio: None,
            pareto: false,
        })
    }

    /// The order for a kernel that encloses the formula over boxes within the given ones.
    fn spec(&self, arithmetic: Arithmetic, rounding: Rounding) -> Spec {
        let inputs = self.subject.inputs;
        let mut graph = Graph::new();
        // All inputs in their order, needed or not.
        for name in self.subject.graph.variables() {
            graph.var(name);
        }
        let root = graph.import(self.subject.graph, &[self.subject.root], &HashMap::new())[0];
        graph.add_output("f", root);
        let ranges: Vec<Interval> = inputs.iter().map(|x| single(x.interval())).collect();
        let (graph, _) = passes::run(&graph, &ranges);
        let root = graph.output("f").unwrap_or(root);
        let names = graph.variables().to_vec();
        let wide = names.iter().zip(inputs).filter(|(_, x)| !x.interval().is_singleton()).map(|(name, _)| name.clone());
        Spec {
            symbols: if arithmetic == Arithmetic::Affine { wide.take(SYMBOLS).collect() } else { Vec::new() },
            inputs: names.clone(),
            uniforms: Vec::new(),
            outputs: vec![Output::Enclosure(root)],
            domain: Vec::new(),
            promises: names.into_iter().zip(ranges).collect(),
            graph: Arc::new(graph),
            arithmetic,
            rounding,
        }
    }

    fn kernel<T: Format>(&self, spec: &Spec, parts: &[u32], backend: &dyn Backend) -> Result<Vec<Outcome>, Diagnostic> {
        let program = Program { kernel: T::compile(backend, spec)?, uniforms: [].into() };
        let mut batch = Batch::<T>::new(&program, GROUPS);
        let operations = spec.lower(T::PRECISION).without_dead_code().cost() as u64;
        let ns = self.kernel_time(&mut batch);
        Ok(parts
            .iter()
            .map(|&parts| {
                let boxes = boxes(self.subject.inputs, parts).unwrap_or(u64::MAX);
                let hull = enclose_in_parts(&mut batch, self.subject.inputs, parts);
                self.outcome(hull, None, operations, boxes, ns * boxes as f64)
            })
            .collect())
    }

    /// Seconds for one box when all lanes of all packets are full, which is how kernels are used.
    fn kernel_time<T: Format>(&self, batch: &mut Batch<T>) -> f64 {
        let lanes = batch.capacity();
        for lane in 0..lanes {
            for (slot, x) in self.subject.inputs.iter().enumerate() {
                batch.set_range(lane, slot, x.interval().lo(), x.interval().hi());
            }
        }
        let ((), seconds) = self.timed(|| batch.run(lanes));
        seconds / lanes as f64
    }
}

/// Noise symbols that a kernel has at most.
const SYMBOLS: usize = 3;

/// The interval with its ends rounded outward to single precision, which is what kernels of that format receive.
fn single(x: Interval) -> Interval {
    Interval::new(f32::down(x.lo()).to_f64(), f32::up(x.hi()).to_f64()).unwrap_or(x)
}

/// The hull of a kernel's enclosures over all parts, with its ends in the wrong order if all of them are empty.
fn enclose_in_parts<T: Real>(batch: &mut Batch<T>, inputs: &[Decorated], parts: u32) -> (f64, f64) {
    let cuts: Vec<Vec<Interval>> = inputs.iter().map(|x| cut(x.interval(), parts)).collect();
    let total: usize = cuts.iter().map(Vec::len).product();
    let mut hull = (f64::INFINITY, f64::NEG_INFINITY);
    let lanes = batch.capacity();
    for start in (0..total).step_by(lanes) {
        let count = lanes.min(total - start);
        for lane in 0..count {
            let mut rest = start + lane;
            for (slot, cut) in cuts.iter().enumerate() {
                let part = cut[rest % cut.len()];
                rest /= cut.len();
                batch.set_range(lane, slot, part.lo(), part.hi());
            }
        }
        batch.run(count);
        for lane in 0..count {
            if batch.bits(lane, 2) & verdict::EMPTY != 0 {
                continue;
            }
            // A NaN end stands for the infinite one.
            let end = |slot: usize| Some(batch.get(lane, slot).to_f64()).filter(|end| !end.is_nan());
            hull.0 = hull.0.min(-end(0).unwrap_or(f64::INFINITY));
            hull.1 = hull.1.max(end(1).unwrap_or(f64::INFINITY));
        }
    }
    hull
}

/// An interval in equal parts that share their ends; points and unbounded ones stay whole.
fn cut(x: Interval, parts: u32) -> Vec<Interval> {
    if !is_cut(x) {
        return vec![x];
    }
    let at = |i: u32| {
        let share = f64::from(i) / f64::from(parts);
        if i == parts { x.hi() } else { (x.lo() * (1.0 - share) + x.hi() * share).clamp(x.lo(), x.hi()) }
    };
    (0..parts).map(|i| Interval::new(at(i), at(i + 1)).unwrap_or(x)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph;
    use crate::interpret::Interpreter;

    fn cost(text: &str, inputs: &[(f64, f64)]) -> ExpressionCost {
        let graph = graph::parse(text).unwrap();
        let root = graph.output("f").unwrap();
        let inputs: Vec<Decorated> =
            inputs.iter().map(|&(lo, hi)| Decorated::new(Interval::new(lo, hi).unwrap())).collect();
        let subject = Subject { text: "f", graph: &graph, root, inputs: &inputs };
        of_expression(subject, 1, &Interpreter, &|_, _, _| {})
    }

    #[test]
    fn outward_ways_hold_the_range_and_finer_parts_are_no_wider() {
        // x (10 - x) on [4, 6].
        let cost = cost("v0 = var x\nv1 = const 10\nv2 = sub v1, v0\nv3 = mul v0, v2\nout f = v3\n", &[(4.0, 6.0)]);
        assert_eq!(cost.enclosures.len(), Method::all().len() * PARTS.len());
        let natural: Vec<&Enclosed> = cost.enclosures.iter().filter(|row| row.name.starts_with("interval x")).collect();
        assert_eq!(natural.len(), PARTS.len());
        for row in &cost.enclosures {
            let measured = row.measured().unwrap();
            assert!(measured.holds || row.rounding == "nearest", "{}: {measured:?}", row.name);
            assert!(measured.excess[0] <= measured.excess[1] && measured.operations > 0, "{}", row.name);
        }
        // [4, 6] * [4, 6] is [16, 36]; the range is [24, 25].
        let whole = natural.iter().find(|row| row.parts == 1).unwrap().measured().unwrap();
        assert_eq!((whole.lo, whole.hi), (16.0, 36.0));
        assert!((whole.excess[1] - 19.0).abs() < 1e-9);
        let finest = natural.iter().find(|row| row.parts == 1024).unwrap().measured().unwrap();
        assert!(finest.width < 1.05);
        let held = cost.enclosures.iter().filter_map(Enclosed::measured).filter(|m| m.holds);
        let excess: Vec<f64> = held.map(|m| m.excess[1]).collect();
        assert!(excess.is_sorted());
    }

    #[test]
    fn many_inputs_are_cut_into_fewer_parts() {
        let cost = cost(
            "v0 = var x\nv1 = var y\nv2 = var z\nv3 = mul v0, v1\nv4 = mul v3, v2\nout f = v4\n",
            &[(0.0, 1.0); 3],
        );
        assert_eq!(cost.enclosures.iter().map(|row| row.parts).max(), Some(16));
    }
}
