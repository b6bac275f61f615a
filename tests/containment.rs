//! Containment: every operation, in interval and affine arithmetic, in both precisions, rounded outward, on random boxes
//! with everything that breaks arithmetic among them. The value at a member of the box must lie in the kernel's
//! enclosure. What decides is the reference interval of the point; where a kernel's end falls between the ends of that
//! interval, 256-bit arithmetic does.
//!
//! `IMP_TEST_CASES` sets the number of boxes per operation, mode and precision (10 000 unless told). With `--nocapture`
//! the width of the f64 interval kernels against the tightest enclosure is printed as a table.
//!
//!     IMP_TEST_CASES=1000000 cargo test --release --test containment -- --nocapture

#[path = "support/oracle.rs"]
mod oracle;

use std::sync::Arc;

use astro_float::Consts;
use fastrand::Rng;
use imp::codegen::Compiler;
use imp::derive::Arithmetic;
use imp::derive::Output;
use imp::derive::Rounding;
use imp::derive::Spec;
use imp::derive::derivative;
use imp::graph::Graph;
use imp::graph::Op;
use imp::graph::Totality;
use imp::graph::Value;
use imp::graph::enclose;
use imp::interval::Decorated;
use imp::interval::Decoration;
use imp::interval::Interval;
use imp::kernel::Backend;
use imp::kernel::Kernel;
use imp::kernel::Packet;
use imp::kernel::Real;
use imp::kernel::verdict;
use num_rational::BigRational;
use num_traits::Pow;

fn cases() -> usize {
    std::env::var("IMP_TEST_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(10_000)
}

/// Every operation of the table that has operands, with exponents for those that carry one.
fn operations() -> Vec<Op> {
    let plain = Op::PLAIN.iter().copied().filter(|op| op.arity() > 0 && *op != Op::SelectJump && *op != Op::Kink);
    let whole = [-7, -2, -1, 0, 1, 3, 4, 11, 200].map(Op::PowInt);
    let ratio = [(2, 3), (1, 4), (-1, 3), (-3, 2), (5, 3), (7, 10)].map(|(p, q)| Op::PowRatio(p, q));
    plain.chain(whole).chain(ratio).collect()
}

/// The operation on the inputs a, b, c; a selection gets a truth value as its condition.
fn formula(op: Op) -> (Graph, Value) {
    let mut graph = Graph::new();
    let [a, b, c] = ["a", "b", "c"].map(|name| graph.var(name));
    let root = match op.arity() {
        1 => graph.push(op, &[a]),
        2 => graph.push(op, &[a, b]),
        _ => {
            let condition = graph.push(Op::Less, &[a, b]);
            graph.push(op, &[condition, b, c])
        }
    };
    (graph, root)
}

fn spec(graph: &Graph, root: Value, arithmetic: Arithmetic) -> Spec {
    Spec {
        graph: Arc::new(graph.clone()),
        inputs: graph.variables().to_vec(),
        uniforms: Vec::new(),
        outputs: vec![Output::Enclosure(root)],
        domain: Vec::new(),
        promises: Vec::new(),
        arithmetic,
        symbols: if arithmetic == Arithmetic::Affine { graph.variables().to_vec() } else { Vec::new() },
        rounding: Rounding::Outward,
    }
}

/// A finite number of one of the kinds that break arithmetic, in the format `T`.
fn number<T: Real>(rng: &mut Rng) -> f64 {
    let (subnormal, least, largest, ulp) = if T::LANES == 16 {
        (1e-45, f64::from(f32::MIN_POSITIVE), f64::from(f32::MAX), f64::from(f32::EPSILON))
    } else {
        (5e-324, f64::MIN_POSITIVE, f64::MAX, f64::EPSILON)
    };
    let special = [0.0, -0.0, 1.0, -1.0, 0.5, 2.0, -2.5, subnormal, -subnormal, least, largest, -largest, ulp];
    let x = match rng.u32(0..12) {
        0 => special[rng.usize(0..special.len())],
        1 if T::LANES == 16 => f32::from_bits(rng.u32(..)).into(),
        1 => f64::from_bits(rng.u64(..)),
        2 => subnormal * f64::from(rng.i32(-4_000_000..4_000_000)),
        3 => f64::from(rng.i32(-200..200)) / 2.0,
        4 => f64::from(rng.i32(-20..20)) + ulp * f64::from(rng.i32(-4..4)),
        5 => f64::from(rng.i32(-1000..1000)) * std::f64::consts::FRAC_PI_2,
        6 => rng.i64(-(1 << 53)..1 << 53) as f64,
        7 => 2f64.powi(rng.i32(-1074..1023)),
        8 => 1.0 + (rng.f64() - 0.5) * 2f64.powi(rng.i32(-60..0)),
        9 => (rng.f64() - 0.5) * 1500.0,
        _ => (rng.f64() - 0.5) * 8.0,
    };
    let x = T::nearest(x).to_f64();
    if x.is_finite() { x } else { 1.0 }
}

/// A box that is not empty: a point, narrow, wide or unbounded; its ends are numbers of the format.
fn interval<T: Real>(rng: &mut Rng) -> Interval {
    let (a, b) = (number::<T>(rng), number::<T>(rng));
    let up = |x: f64| T::up(x).to_f64();
    let (lo, hi) = match rng.u32(0..10) {
        0 => (a, a),
        1 => (a, up(a + a.abs() * 1e-7)),
        2 => (f64::NEG_INFINITY, a),
        3 => (a, f64::INFINITY),
        4 => (a, up(a + a.abs() * 2f64.powi(-rng.i32(1..50)))),
        5 => (a, up(a + rng.f64() * 7.0)),
        _ => (a.min(b), a.max(b)),
    };
    Interval::new(lo, hi).unwrap_or(Interval::ENTIRE)
}

/// A member of `x`, its finite ends among the choices.
fn member(rng: &mut Rng, x: Interval) -> f64 {
    let inside = |t: f64| t.clamp(x.lo().max(f64::MIN), x.hi().min(f64::MAX));
    let (lo, hi) = (inside(x.lo()), inside(x.hi()));
    match rng.u32(0..4) {
        0 => lo,
        1 => hi,
        2 => inside(number::<f64>(rng)),
        _ => inside(lo + (hi / 2.0 - lo / 2.0) * 2.0 * rng.f64()),
    }
}

/// Runs a kernel of one enclosure over one packet of boxes: ends and verdict by lane.
fn enclosures<T: Real>(kernel: &dyn Kernel<T>, boxes: &[Vec<Interval>]) -> Vec<(f64, f64, u32)> {
    let mut inputs = vec![Packet::<T>::default(); kernel.input_slots()];
    for (lane, item) in boxes.iter().enumerate() {
        for (i, x) in item.iter().enumerate() {
            inputs[2 * i].lanes_mut()[lane] = T::up(-x.lo());
            inputs[2 * i + 1].lanes_mut()[lane] = T::up(x.hi());
        }
    }
    let mut outputs = vec![Packet::<T>::default(); kernel.output_slots()];
    kernel.run(&[], &inputs, &mut outputs);
    let lane = |i: usize| {
        let [nlo, hi] = [0, 1].map(|slot| outputs[slot].lanes()[i].to_f64());
        (-nlo, hi, outputs[2].lanes()[i].verdict())
    };
    (0..boxes.len()).map(lane).collect()
}

/// How far the ends of a kernel lie outside those of the tightest enclosure, in units in the last place of the latter.
fn excess(lo: f64, hi: f64, tight: Interval) -> Option<f64> {
    let side = |outer: f64, inner: f64| {
        let ulp = (inner.abs().next_up() - inner.abs()).max(f64::MIN_POSITIVE * f64::EPSILON);
        if outer == inner { 0.0 } else { (outer - inner).abs() / ulp }
    };
    let finite = [lo, hi, tight.lo(), tight.hi()].iter().all(|x| x.is_finite() && x.abs() < 1e300);
    finite.then(|| side(lo, tight.lo()).max(side(hi, tight.hi())))
}

/// Whether the value of a rational operation lies between the bounds, exactly. For those whose reference enclosure of a
/// point is not tight: remainders of large quotients, high powers. `None` for all others.
fn exactly_within(op: Op, x: f64, y: f64, lo: f64, hi: f64) -> Option<bool> {
    let exact = |x: f64| BigRational::from_float(x).expect("a finite number");
    let value = match op {
        Op::Mod => exact(x) - exact(y) * (exact(x) / exact(y)).floor(),
        Op::PowInt(n) => Pow::pow(exact(x), n),
        _ => return None,
    };
    let above = lo == f64::NEG_INFINITY || (lo.is_finite() && exact(lo) <= value);
    let below = hi == f64::INFINITY || (hi.is_finite() && value <= exact(hi));
    Some(above && below)
}

struct Check<'a> {
    op: Op,
    graph: &'a Graph,
    root: Value,
    cc: &'a mut Consts,
}

impl Check<'_> {
    /// One point of one box against the kernel's answer.
    fn point(&mut self, point: &[f64], (lo, hi, word): (f64, f64, u32), context: &str) {
        let inputs: Vec<Decorated> = point.iter().map(|&x| Decorated::new(Interval::point(x))).collect();
        let value = enclose(self.graph, &[self.root], &inputs)[0].interval();
        if value.is_empty() {
            assert_eq!(word & verdict::CONTINUOUS, 0, "{context} at {point:?}: undefined, yet called continuous");
            return;
        }
        assert_eq!(word & verdict::EMPTY, 0, "{context} at {point:?}: {value}, yet called empty");
        assert!(word & verdict::POSITIVE == 0 || value.hi() > 0.0, "{context} at {point:?}: {value} called positive");
        assert!(word & verdict::NEGATIVE == 0 || value.lo() < 0.0, "{context} at {point:?}: {value} called negative");
        if lo <= value.lo() && value.hi() <= hi {
            return;
        }
        let y = point.get(1).copied().unwrap_or(0.0);
        if let Some(within) = exactly_within(self.op, point[0], y, lo, hi) {
            assert!(within, "{context} at {point:?} escapes [{lo:e}, {hi:e}]");
            return;
        }
        let Some(exact) = oracle::value(self.op, point[0], y, self.cc) else {
            panic!("{context} at {point:?}: the value in {value} escapes [{lo:e}, {hi:e}]");
        };
        assert!(
            oracle::at_most(lo, &exact) && oracle::at_least(hi, &exact),
            "{context} at {point:?}: {exact} escapes [{lo:e}, {hi:e}]"
        );
    }
}

/// All boxes of one operation, mode and precision. Returns the largest and the mean excess in ulps over the reference.
fn containment<T: Real>(op: Op, arithmetic: Arithmetic, kernel: &dyn Kernel<T>, cc: &mut Consts) -> (f64, f64) {
    let (graph, root) = formula(op);
    let mut check = Check { op, graph: &graph, root, cc };
    let mut rng = Rng::with_seed(40);
    let (mut most, mut sum, mut count) = (0f64, 0.0, 0.0);
    for round in 0..cases().div_ceil(T::LANES) {
        let boxes: Vec<Vec<Interval>> =
            (0..T::LANES).map(|_| (0..3).map(|_| interval::<T>(&mut rng)).collect()).collect();
        for (item, answer) in boxes.iter().zip(enclosures(kernel, &boxes)) {
            let context = || format!("{op:?} {arithmetic:?} {} lanes, round {round}, box {item:?}", T::LANES);
            let (lo, hi, word) = answer;
            assert!(word & verdict::EMPTY != 0 || (lo <= hi && lo < f64::INFINITY), "{}: [{lo}, {hi}]", context());
            let point: Vec<f64> = item.iter().map(|x| member(&mut rng, *x)).collect();
            check.point(&point, answer, &context());
            let inputs: Vec<Decorated> = item.iter().map(|x| Decorated::new(*x)).collect();
            let tight = enclose(&graph, &[root], &inputs)[0];
            // The reference gives up remainders of quotients beyond 2^53, where kernels still see that nothing jumps.
            let given_up = op == Op::Mod && (item[0] / item[1]).mag() >= 2f64.powi(53);
            let claims = word & verdict::CONTINUOUS != 0 && !given_up;
            assert!(!claims || tight.decoration() >= Decoration::Dac, "{}: called continuous", context());
            if let Some(ulps) = (!tight.interval().is_empty()).then(|| excess(lo, hi, tight.interval())).flatten() {
                most = most.max(ulps);
                sum += ulps;
                count += 1.0;
            }
        }
    }
    (most, sum / f64::max(count, 1.0))
}

#[test]
fn every_operation_contains_its_values() {
    let mut cc = Consts::new().expect("constants");
    println!(
        "{:24} {:>12} {:>12}   excess of f64 interval kernels over the tightest enclosure, ulps",
        "", "most", "mean"
    );
    for op in operations() {
        let (graph, root) = formula(op);
        for arithmetic in [Arithmetic::Interval, Arithmetic::Affine] {
            let spec = spec(&graph, root, arithmetic);
            let single = Compiler.compile_f32(&spec).expect("compiles");
            containment::<f32>(op, arithmetic, &*single, &mut cc);
            let double = Compiler.compile_f64(&spec).expect("compiles");
            let (most, mean) = containment::<f64>(op, arithmetic, &*double, &mut cc);
            if arithmetic == Arithmetic::Interval {
                println!("{:24} {most:12.1} {mean:12.3}", format!("{op:?}"));
            }
        }
    }
}

/// The width of f(a, b) less its tangent plane at a point, by the affine kernel, over a box of half the given size around
/// the point.
fn width_beside_tangent(op: Op, point: [f64; 2], radius: f64) -> f64 {
    let (mut graph, root) = formula(op);
    let at = |a: f64, b: f64| {
        let inputs: Vec<Decorated> = [a, b, 0.0].map(|x| Decorated::new(Interval::point(x))).to_vec();
        enclose(&formula(op).0, &[root], &inputs)[0].interval().mid()
    };
    let [a, b] = point;
    let step = 1e-6;
    let slopes = [
        (at(a + step, b) - at(a - step, b)) / (2.0 * step),
        if op.arity() > 1 { (at(a, b + step) - at(a, b - step)) / (2.0 * step) } else { 0.0 },
    ];
    let mut rest = root;
    for (name, slope) in ["a", "b"].into_iter().zip(slopes) {
        let slope = graph.constant(BigRational::from_float(slope).expect("a finite slope"));
        let input = graph.var(name);
        let term = graph.mul(slope, input);
        rest = graph.sub(rest, term);
    }
    let kernel = Compiler.compile_f64(&spec(&graph, rest, Arithmetic::Affine)).expect("compiles");
    let around = |x: f64| Interval::new(x - radius, x + radius).expect("a box");
    let (lo, hi, _) = enclosures(&*kernel, &[vec![around(a), around(b), Interval::ZERO]])[0];
    hi - lo
}

/// An operation with an affine form of its own shares its operands' noise symbols: less its tangent plane, a smooth
/// function has an enclosure whose width shrinks with the square of the box. Through the interval it would shrink with
/// the box alone, as it does for steps, atan2 and general powers.
#[test]
fn affine_forms_keep_what_operands_share() {
    let points = |op: Op| match op {
        Op::Acosh => [1.75, 0.0],
        Op::Asin | Op::Acos | Op::Atanh => [-0.375, 0.0],
        Op::Abs => [-0.75, 0.0],
        Op::PowInt(_) => [1.25, 0.0],
        _ => [0.75, 1.625],
    };
    let stepwise = |op: Op| matches!(op.totality(), Totality::Jumps | Totality::PartialJumps) || op == Op::PowInt(0);
    for op in operations().into_iter().filter(|&op| !stepwise(op) && op != Op::Pow) {
        let [wide, narrow] = [4, 8].map(|bits| width_beside_tangent(op, points(op), 0.5f64.powi(bits)));
        // The square of 16 is 256; what is left after it is rounding.
        assert!(narrow <= wide / 128.0 + 1e-8, "{op:?}: {wide:e} shrinks to {narrow:e} only");
    }
}

/// Derivatives as enclosures: where the function is continuous on the box, every difference quotient between two of its
/// points lies in the derivative's enclosure (mean-value form), kinks and jumps among them.
#[test]
fn derivatives_contain_difference_quotients() {
    for op in operations() {
        let (graph, root) = formula(op);
        let mut slope_graph = graph.clone();
        let a = slope_graph.var("a");
        let slope = derivative(&mut slope_graph, root, a);
        let spec = spec(&slope_graph, slope, Arithmetic::Interval);
        let kernel = Compiler.compile_f64(&spec).expect("compiles");
        let mut rng = Rng::with_seed(41);
        for round in 0..cases().div_ceil(f64::LANES) {
            let boxes: Vec<Vec<Interval>> =
                (0..f64::LANES).map(|_| (0..3).map(|_| interval::<f64>(&mut rng)).collect()).collect();
            for (item, (lo, hi, word)) in boxes.iter().zip(enclosures(&*kernel, &boxes)) {
                let inputs: Vec<Decorated> = item.iter().map(|x| Decorated::new(*x)).collect();
                if enclose(&graph, &[root], &inputs)[0].decoration() < Decoration::Dac {
                    continue;
                }
                let others: Vec<f64> = item.iter().map(|x| member(&mut rng, *x)).collect();
                let [p, q] = [0, 1].map(|_| member(&mut rng, item[0]));
                if p == q || word & verdict::EMPTY != 0 {
                    continue;
                }
                let value = |x: f64| {
                    let at: Vec<Decorated> =
                        [x, others[1], others[2]].map(|x| Decorated::new(Interval::point(x))).to_vec();
                    enclose(&graph, &[root], &at)[0].interval()
                };
                let quotient = (value(p) - value(q)) / (Interval::point(p) - Interval::point(q));
                assert!(
                    quotient.lo() <= hi && lo <= quotient.hi(),
                    "{op:?} round {round}, box {item:?}: {quotient} between {p:e} and {q:e} is not in [{lo:e}, {hi:e}]"
                );
            }
        }
    }
}
