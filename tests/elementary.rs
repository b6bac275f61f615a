//! The inline elementary functions beyond containment (which `containment.rs` tests on random boxes): their error bounds
//! in every rounding mode, the width of their enclosures, single precision densely, the numbers next to zero, the
//! masks at the edges of the domains, and compiled code against the lane machine bit for bit.
//!
//! `IMP_TEST_EXHAUSTIVE=1` runs the unary functions on every single-precision number instead of every 8 191st (hours; a
//! larger step is a compromise).

#[path = "support/lane_machine.rs"]
mod lane_machine;
#[path = "support/oracle.rs"]
mod oracle;

use std::sync::Arc;

use astro_float::BigFloat;
use astro_float::Consts;
use astro_float::RoundingMode;
use fastrand::Rng;
use imp::codegen::Compiler;
use imp::derive::Arithmetic;
use imp::derive::LaneProgram;
use imp::derive::Output;
use imp::derive::Precision;
use imp::derive::Rounding;
use imp::derive::Spec;
use imp::graph::Graph;
use imp::graph::Op;
use imp::kernel::Backend;
use imp::kernel::Kernel;
use imp::kernel::Packet;
use imp::kernel::Real;
use imp::kernel::verdict;
use lane_machine::Mode;

/// An operation on the inputs a and b.
fn spec(op: Op, arithmetic: Arithmetic, rounding: Rounding) -> Spec {
    let mut graph = Graph::new();
    let inputs: Vec<_> = ["a", "b"].iter().take(op.arity()).map(|name| graph.var(name)).collect();
    let root = graph.push(op, &inputs);
    let output = if arithmetic == Arithmetic::Point { Output::Value(root) } else { Output::Enclosure(root) };
    Spec {
        inputs: graph.variables().to_vec(),
        graph: Arc::new(graph),
        uniforms: Vec::new(),
        outputs: vec![output],
        domain: Vec::new(),
        promises: Vec::new(),
        arithmetic,
        symbols: Vec::new(),
        rounding,
    }
}

/// A format in which tests run.
trait Format: Real {
    const PRECISION: Precision;
    const EPSILON: f64;
    fn word(self) -> u64;
    fn from_word(word: u64) -> Self;
    fn compile(spec: &Spec) -> Arc<dyn Kernel<Self>>;
}

impl Format for f32 {
    const PRECISION: Precision = Precision::Single;
    const EPSILON: f64 = f32::EPSILON as f64;
    fn word(self) -> u64 {
        self.to_bits().into()
    }
    fn from_word(word: u64) -> Self {
        f32::from_bits(word as u32)
    }
    fn compile(spec: &Spec) -> Arc<dyn Kernel<f32>> {
        Compiler.compile_f32(spec).expect("compiles")
    }
}

impl Format for f64 {
    const PRECISION: Precision = Precision::Double;
    const EPSILON: f64 = f64::EPSILON;
    fn word(self) -> u64 {
        self.to_bits()
    }
    fn from_word(word: u64) -> Self {
        f64::from_bits(word)
    }
    fn compile(spec: &Spec) -> Arc<dyn Kernel<f64>> {
        Compiler.compile_f64(spec).expect("compiles")
    }
}

/// One lane of an interval program on the machine: ends and verdict.
fn enclose<T: Format>(program: &LaneProgram, ends: &[(f64, f64)], mode: Mode) -> (f64, f64, u32) {
    let words: Vec<u64> = ends.iter().flat_map(|&(lo, hi)| [T::up(-lo).word(), T::up(hi).word()]).collect();
    let out = lane_machine::run(program, &words, &[], mode);
    (-T::from_word(out[0]).to_f64(), T::from_word(out[1]).to_f64(), out[2] as u32)
}

/// A function with the arguments on which it is tried and the error of its point program, in epsilon relative to the
/// value and in any mode: the core's bound (in the sources) against the smallest value that it can come with, and the
/// last rounding. An enclosure of a point is at most twice as wide.
struct Case {
    op: Op,
    arguments: fn(&mut Rng) -> (f64, f64),
    epsilons: f64,
}

/// A number between, spread over the exponents.
fn spread(rng: &mut Rng, lo: f64, hi: f64) -> f64 {
    lo * (hi / lo).powf(rng.f64())
}

fn signed(rng: &mut Rng, lo: f64, hi: f64) -> f64 {
    let x = spread(rng, lo, hi);
    if rng.bool() { x } else { -x }
}

const CASES: &[Case] = &[
    Case { op: Op::Exp, arguments: |r| (signed(r, 1e-9, 87.0), 0.0), epsilons: 3.0 },
    Case { op: Op::Exp2, arguments: |r| (signed(r, 1e-9, 125.0), 0.0), epsilons: 3.0 },
    Case { op: Op::Exp10, arguments: |r| (signed(r, 1e-9, 37.0), 0.0), epsilons: 3.5 },
    Case { op: Op::Expm1, arguments: |r| (signed(r, 1e-30, 80.0), 0.0), epsilons: 7.0 },
    Case { op: Op::Ln, arguments: |r| (spread(r, 1e-37, 1e37), 0.0), epsilons: 2.5 },
    Case { op: Op::Ln, arguments: |r| (1.0 + signed(r, 1e-6, 0.5), 0.0), epsilons: 2.5 },
    Case { op: Op::Log2, arguments: |r| (1.0 + signed(r, 1e-6, 0.99), 0.0), epsilons: 2.5 },
    Case { op: Op::Log10, arguments: |r| (1.0 + signed(r, 1e-6, 0.99), 0.0), epsilons: 3.0 },
    Case { op: Op::Log1p, arguments: |r| (signed(r, 1e-30, 0.99), 0.0), epsilons: 3.25 },
    Case { op: Op::Log1p, arguments: |r| (spread(r, 0.1, 1e37), 0.0), epsilons: 3.25 },
    Case { op: Op::Sin, arguments: |r| (signed(r, 1e-30, 200.0), 0.0), epsilons: 3.5 },
    Case { op: Op::Cos, arguments: |r| (signed(r, 1e-9, 200.0), 0.0), epsilons: 3.5 },
    Case { op: Op::Tan, arguments: |r| (signed(r, 1e-30, 65_000.0), 0.0), epsilons: 7.5 },
    Case { op: Op::Asin, arguments: |r| (signed(r, 1e-30, 1.0), 0.0), epsilons: 4.0 },
    Case { op: Op::Acos, arguments: |r| (signed(r, 1e-9, 1.0), 0.0), epsilons: 4.0 },
    Case { op: Op::Atan, arguments: |r| (signed(r, 1e-30, 1e30), 0.0), epsilons: 5.25 },
    Case { op: Op::Atan2, arguments: |r| (signed(r, 1e-9, 1e9), signed(r, 1e-9, 1e9)), epsilons: 5.25 },
    Case { op: Op::Sinh, arguments: |r| (signed(r, 1e-30, 87.0), 0.0), epsilons: 12.0 },
    Case { op: Op::Cosh, arguments: |r| (signed(r, 1e-9, 87.0), 0.0), epsilons: 6.0 },
    Case { op: Op::Tanh, arguments: |r| (signed(r, 1e-30, 30.0), 0.0), epsilons: 7.0 },
    Case { op: Op::Asinh, arguments: |r| (signed(r, 1e-30, 1e37), 0.0), epsilons: 8.0 },
    Case { op: Op::Acosh, arguments: |r| (1.0 + spread(r, 1e-6, 1e37), 0.0), epsilons: 7.5 },
    Case { op: Op::Atanh, arguments: |r| (signed(r, 1e-30, 1.0 - 1e-6), 0.0), epsilons: 6.0 },
    Case { op: Op::Cbrt, arguments: |r| (signed(r, 1e-44, 1e38), 0.0), epsilons: 1.125 },
    Case { op: Op::PowRatio(2, 3), arguments: |r| (signed(r, 1e-30, 1e30), 0.0), epsilons: 4.0 },
    Case { op: Op::PowRatio(7, 10), arguments: |r| (spread(r, 1e-30, 1e30), 0.0), epsilons: 4.0 },
    Case { op: Op::PowRatio(-11, 5), arguments: |r| (signed(r, 1e-15, 1e15), 0.0), epsilons: 5.0 },
    Case { op: Op::Pow, arguments: |r| (spread(r, 1e-9, 1e9), signed(r, 1e-9, 4.0)), epsilons: 5.0 },
];

fn big(x: f64) -> BigFloat {
    oracle::big(x)
}

/// How far a number lies above the value, in epsilon relative to the value; the smallest numbers of the format count as
/// the least normal one does.
fn epsilons_above<T: Format>(x: f64, value: &BigFloat) -> f64 {
    let difference = big(x).sub(value, 128, RoundingMode::ToEven);
    let unit = value.abs().mul(&big(T::EPSILON), 128, RoundingMode::ToEven);
    let ratio = difference.div(&unit, 64, RoundingMode::ToEven);
    let mut cc = Consts::new().expect("constants");
    let text = ratio.format(astro_float::Radix::Dec, RoundingMode::ToEven, &mut cc).expect("a number");
    text.parse().expect("a number")
}

/// Errors of the point programs in all three modes, and the width of the enclosures of points rounded upward.
fn errors_and_widths<T: Format>() {
    let mut cc = Consts::new().expect("constants");
    let mut rng = Rng::with_seed(7);
    for Case { op, arguments, epsilons } in CASES {
        let point = spec(*op, Arithmetic::Point, Rounding::Nearest).lower(T::PRECISION);
        let interval = spec(*op, Arithmetic::Interval, Rounding::Outward).lower(T::PRECISION);
        let (mut worst, mut widest) = (0f64, 0f64);
        for _ in 0..150 {
            let (x, y) = arguments(&mut rng);
            let (x, y) = (T::nearest(x), T::nearest(y));
            let (x, y, words) = (x.to_f64(), y.to_f64(), [x.word(), y.word()]);
            let exact = oracle::value(*op, x, y, &mut cc).expect("a value");
            for mode in [Mode::Nearest, Mode::Up, Mode::Down] {
                let got = T::from_word(lane_machine::run(&point, &words, &[], mode)[0]).to_f64();
                let error = epsilons_above::<T>(got, &exact).abs();
                assert!(error <= *epsilons, "{op:?} at ({x:e}, {y:e}), {mode:?}: {got:e} is off by {error} epsilon");
                worst = worst.max(error);
            }
            let (lo, hi, _) = enclose::<T>(&interval, &[(x, x), (y, y)], Mode::Up);
            let context = format!("{op:?} at ({x:e}, {y:e}): [{lo:e}, {hi:e}]");
            assert!(oracle::at_most(lo, &exact) && oracle::at_least(hi, &exact), "{context} misses {exact}");
            let width = epsilons_above::<T>(hi, &exact) - epsilons_above::<T>(lo, &exact);
            assert!(width <= 2.0 * epsilons, "{context} is {width} epsilon wide");
            widest = widest.max(width);
        }
        println!("{op:?} {:?}: error {worst:.2}, width {widest:.2} epsilon", T::PRECISION);
    }
}

#[test]
fn double_precision_keeps_its_bounds_in_every_mode() {
    errors_and_widths::<f64>();
}

#[test]
fn single_precision_keeps_its_bounds_in_every_mode() {
    errors_and_widths::<f32>();
}

/// A unary function in double precision, correctly rounded.
type Reference = fn(f64) -> f64;

const UNARY: &[(Op, Reference)] = &[
    (Op::Exp, core_math::exp),
    (Op::Exp2, core_math::exp2),
    (Op::Exp10, core_math::exp10),
    (Op::Expm1, core_math::expm1),
    (Op::Ln, core_math::log),
    (Op::Log1p, core_math::log1p),
    (Op::Log2, core_math::log2),
    (Op::Log10, core_math::log10),
    (Op::Sin, core_math::sin),
    (Op::Cos, core_math::cos),
    (Op::Tan, core_math::tan),
    (Op::Asin, core_math::asin),
    (Op::Acos, core_math::acos),
    (Op::Atan, core_math::atan),
    (Op::Sinh, core_math::sinh),
    (Op::Cosh, core_math::cosh),
    (Op::Tanh, core_math::tanh),
    (Op::Asinh, core_math::asinh),
    (Op::Acosh, core_math::acosh),
    (Op::Atanh, core_math::atanh),
    (Op::Cbrt, core_math::cbrt),
    (Op::PowRatio(7, 10), |x| core_math::pow(x, 0.7)),
    (Op::PowRatio(-5, 7), |x| core_math::pow(x.abs(), -5.0 / 7.0).copysign(x)),
];

/// Every single-precision number, or a sample that takes every exponent and both signs, through compiled kernels, a
/// point box each. Double precision is 2^29 times finer: it decides up to 2 of its own ulps.
#[test]
fn single_precision_contains_its_values_densely() {
    let step = std::env::var("IMP_TEST_EXHAUSTIVE").ok().and_then(|step| step.parse().ok()).unwrap_or(8191u64).max(1);
    const GROUPS: usize = 64;
    for &(op, reference) in UNARY {
        let kernel = f32::compile(&spec(op, Arithmetic::Interval, Rounding::Outward));
        let mut inputs = vec![Packet::<f32>::default(); 2 * GROUPS];
        let mut outputs = vec![Packet::<f32>::default(); 3 * GROUPS];
        let mut next = 0u64;
        while next < 1 << 32 {
            let first = next;
            let argument = |i: usize| f32::from_bits((first + step * i as u64).min(u64::from(u32::MAX)) as u32);
            for (group, pair) in inputs.chunks_mut(2).enumerate() {
                for lane in 0..f32::LANES {
                    let x = argument(group * f32::LANES + lane);
                    pair[0].lanes_mut()[lane] = -x;
                    pair[1].lanes_mut()[lane] = x;
                }
            }
            next += step * (GROUPS * f32::LANES) as u64;
            kernel.run(&[], &inputs, &mut outputs);
            for (group, triple) in outputs.chunks(3).enumerate() {
                for lane in 0..f32::LANES {
                    let x = argument(group * f32::LANES + lane);
                    if !x.is_finite() {
                        continue;
                    }
                    let [lo, hi] = [-triple[0].lanes()[lane], triple[1].lanes()[lane]].map(f64::from);
                    let empty = triple[2].lanes()[lane].verdict() & verdict::EMPTY != 0;
                    let value = reference(x.into());
                    assert_eq!(empty, value.is_nan() || pole(op, x), "{op:?} at {x:e}: domain");
                    let (below, above) = (value.next_down().next_down(), value.next_up().next_up());
                    assert!(
                        empty || (lo <= above && below <= hi),
                        "{op:?} at {x:e}: {value:e} escapes [{lo:e}, {hi:e}]"
                    );
                }
            }
        }
    }
}

/// Where a function's reference is infinite and the function undefined.
fn pole(op: Op, x: f32) -> bool {
    match op {
        Op::Ln | Op::Log2 | Op::Log10 | Op::PowRatio(-5, 7) => x == 0.0,
        Op::Log1p => x == -1.0,
        Op::Atanh => x.abs() == 1.0,
        _ => false,
    }
}

/// Functions with f(x) = x + c(x) next to 0, and the sign of c(x) for x > 0; `odd` ones have the other for x < 0.
const TANGENT_TO_IDENTITY: &[(Op, f64, bool)] = &[
    (Op::Sin, -1.0, true),
    (Op::Atan, -1.0, true),
    (Op::Tanh, -1.0, true),
    (Op::Asinh, -1.0, true),
    (Op::Log1p, -1.0, false),
    (Op::Tan, 1.0, true),
    (Op::Asin, 1.0, true),
    (Op::Sinh, 1.0, true),
    (Op::Atanh, 1.0, true),
    (Op::Expm1, 1.0, false),
];

/// The correction underflows here, and the enclosure of {x} must reach past x on its side all the same.
fn next_to_zero<T: Format>() {
    for &(op, sign, odd) in TANGENT_TO_IDENTITY {
        let program = spec(op, Arithmetic::Interval, Rounding::Outward).lower(T::PRECISION);
        // All of the least numbers, and some of every exponent up to where the correction reaches an ulp.
        let (least, top) = (1, T::nearest(T::EPSILON / 2.0).word());
        let octave = (1.0 / T::EPSILON) as u64;
        let steps =
            (0..top / octave).flat_map(|exponent| [0, 1, octave / 2, octave - 1].map(|low| exponent * octave + low));
        for bits in (least..600).chain(steps.filter(|bits| *bits > 0)) {
            let magnitude = T::from_word(bits).to_f64();
            for x in [magnitude, -magnitude] {
                let (lo, hi, _) = enclose::<T>(&program, &[(x, x)], Mode::Up);
                let above = (sign > 0.0) == (x > 0.0 || !odd);
                let contained = if above { lo <= x && x < hi } else { lo < x && x <= hi };
                assert!(contained, "{op:?} at {x:e}: [{lo:e}, {hi:e}]");
                let width = (hi - lo) / T::from_word(1).to_f64().max(x.abs() * T::EPSILON);
                assert!(width <= 24.0, "{op:?} at {x:e}: [{lo:e}, {hi:e}] is too wide");
            }
        }
        let (lo, hi, _) = enclose::<T>(&program, &[(0.0, 0.0)], Mode::Up);
        assert!(lo == 0.0 && hi == 0.0, "{op:?} at 0: [{lo:e}, {hi:e}]");
    }
}

#[test]
fn numbers_next_to_zero_are_enclosed() {
    next_to_zero::<f32>();
    next_to_zero::<f64>();
}

/// Boxes, and whether the operation is undefined on all of them, or proved defined and continuous.
#[test]
fn masks_follow_the_domains() {
    let inf = f64::INFINITY;
    let (neither, empty, continuous) = (0, verdict::EMPTY, verdict::CONTINUOUS);
    type Ends = (f64, f64);
    let none: Ends = (1.0, 1.0);
    let table: &[(Op, Ends, Ends, u32)] = &[
        (Op::Ln, (-2.0, -1.0), none, empty),
        (Op::Ln, (-2.0, 0.0), none, empty),
        (Op::Ln, (0.0, 1.0), none, neither),
        (Op::Ln, (1e-300, inf), none, continuous),
        (Op::Log1p, (-2.0, -1.0), none, empty),
        (Op::Log1p, (-1.0, 0.0), none, neither),
        (Op::Log1p, (-0.999, 5.0), none, continuous),
        (Op::Tan, (1.0, 2.0), none, neither),
        (Op::Tan, (-1.5, 1.5), none, continuous),
        (Op::Tan, (1.6, 4.7), none, continuous),
        (Op::Tan, (1.6, 4.8), none, neither),
        (Op::Tan, (-inf, inf), none, neither),
        (Op::Asin, (-1.0, 1.0), none, continuous),
        (Op::Asin, (-1.5, 1.0), none, neither),
        (Op::Asin, (1.5, 2.0), none, empty),
        (Op::Acos, (-3.0, -1.5), none, empty),
        (Op::Acos, (-1.0, 0.5), none, continuous),
        (Op::Acosh, (0.0, 0.5), none, empty),
        (Op::Acosh, (0.0, 1.0), none, neither),
        (Op::Acosh, (1.0, inf), none, continuous),
        (Op::Atanh, (1.0, 2.0), none, empty),
        (Op::Atanh, (-1.0, 0.5), none, neither),
        (Op::Atanh, (-0.5, 0.5), none, continuous),
        (Op::PowRatio(1, 4), (-2.0, -1.0), none, empty),
        (Op::PowRatio(1, 4), (-2.0, 1.0), none, neither),
        (Op::PowRatio(3, 10), (0.0, 1.0), none, continuous),
        (Op::PowRatio(-3, 4), (0.0, 1.0), none, neither),
        (Op::PowRatio(-3, 4), (-1.0, 0.0), none, empty),
        (Op::PowRatio(-1, 3), (0.0, 0.0), none, empty),
        (Op::PowRatio(-1, 3), (-1.0, 1.0), none, neither),
        (Op::PowRatio(-2, 9), (-2.0, -1.0), none, continuous),
        (Op::PowRatio(5, 3), (-1.0, 1.0), none, continuous),
        (Op::Pow, (-2.0, -1.0), (2.0, 2.0), empty),
        (Op::Pow, (-2.0, 0.0), (-2.0, 0.0), empty),
        (Op::Pow, (0.0, 1.0), (-1.0, 1.0), neither),
        (Op::Pow, (0.0, 1.0), (0.5, 1.0), continuous),
        (Op::Pow, (0.5, inf), (-inf, inf), continuous),
        (Op::Atan2, (0.0, 0.0), (0.0, 0.0), empty),
        (Op::Atan2, (0.0, 1.0), (-2.0, -1.0), neither),
        (Op::Atan2, (-1.0, 0.0), (0.0, 1.0), neither),
        (Op::Atan2, (-1.0, 1.0), (0.5, 1.0), continuous),
        (Op::Atan2, (0.1, 1.0), (-3.0, 1.0), continuous),
        (Op::Atan2, (-1.0, -0.1), (-3.0, 1.0), continuous),
    ];
    for &(op, x, y, expected) in table {
        let spec = spec(op, Arithmetic::Interval, Rounding::Outward);
        for precision in [Precision::Single, Precision::Double] {
            let program = spec.lower(precision);
            let (_, _, word) = match precision {
                Precision::Single => enclose::<f32>(&program, &[x, y], Mode::Up),
                Precision::Double => enclose::<f64>(&program, &[x, y], Mode::Up),
            };
            // The least double has no single between 0 and it.
            let rounded_to_zero = precision == Precision::Single && x.0 == 1e-300;
            let masks = word & (verdict::EMPTY | verdict::CONTINUOUS);
            assert!(masks == expected || rounded_to_zero, "{op:?} on {x:?}, {y:?} in {precision:?}: {masks}");
        }
    }
}

/// The angle's extremes over boxes that touch the origin with a corner or a side.
#[test]
fn angles_of_boxes_at_the_origin_are_tight() {
    let program = spec(Op::Atan2, Arithmetic::Interval, Rounding::Outward).lower(Precision::Double);
    let pi = std::f64::consts::PI;
    let table = [
        ((0.0, 1.0), (0.0, 1.0), 0.0, pi / 2.0),
        ((0.0, 1.0), (-1.0, 0.0), pi / 2.0, pi),
        ((-1.0, 0.0), (0.0, 1.0), -pi / 2.0, 0.0),
        ((-1.0, 0.0), (-1.0, 0.0), -pi, pi),
        ((0.0, 1.0), (-1.0, 1.0), 0.0, pi),
        ((-1.0, 1.0), (0.0, 1.0), -pi / 2.0, pi / 2.0),
        ((0.0, 0.0), (0.0, 1.0), 0.0, 0.0),
        ((0.0, 0.0), (-1.0, -0.5), pi, pi),
        ((-1.0, 1.0), (-1.0, 1.0), -pi, pi),
    ];
    for (y, x, least, greatest) in table {
        let (lo, hi, _) = enclose::<f64>(&program, &[y, x], Mode::Up);
        let close = lo <= least && least - lo < 4e-15 && greatest <= hi && hi - greatest < 4e-15;
        assert!(close, "atan2 of {y:?}, {x:?}: [{lo}, {hi}]");
    }
}

/// A number of a kind that breaks arithmetic.
fn odd_number(rng: &mut Rng) -> f64 {
    match rng.u32(0..8) {
        0 => [0.0, -0.0, 1.0, -1.0, 0.5, f64::INFINITY, f64::NEG_INFINITY, 5e-324][rng.usize(0..8)],
        1 => f64::from_bits(rng.u64(..)),
        2 => f64::from(f32::from_bits(rng.u32(..))),
        3 => f64::from(rng.i32(-1000..1000)) * std::f64::consts::FRAC_PI_2,
        4 => 1.0 + (rng.f64() - 0.5) * 2f64.powi(rng.i32(-60..0)),
        5 => (rng.f64() - 0.5) * 1500.0,
        _ => (rng.f64() - 0.5) * 8.0,
    }
}

/// Compiled kernels against the machine on all slots of all lanes, both arithmetics; and no end is NaN or on the wrong
/// side of infinity, whichever the mode.
fn compiled_equals_machine<T: Format>() {
    let mut rng = Rng::with_seed(3);
    let binary = [Op::Pow, Op::Atan2];
    for op in UNARY.iter().map(|&(op, _)| op).chain(binary) {
        for (arithmetic, rounding) in [
            (Arithmetic::Interval, Rounding::Outward),
            (Arithmetic::Interval, Rounding::Nearest),
            (Arithmetic::Point, Rounding::Nearest),
        ] {
            let spec = spec(op, arithmetic, rounding);
            let (kernel, program) = (T::compile(&spec), spec.lower(T::PRECISION));
            let mode = if rounding == Rounding::Outward { Mode::Up } else { Mode::Nearest };
            for _ in 0..12 {
                let mut inputs = vec![Packet::<T>::default(); program.input_slots];
                for lane in 0..T::LANES {
                    for slots in inputs.chunks_mut(if arithmetic == Arithmetic::Point { 1 } else { 2 }) {
                        let (a, b) = (odd_number(&mut rng), odd_number(&mut rng));
                        let (lo, hi) = if rng.bool() || a.is_nan() { (a, a) } else { (a.min(b), a.max(b)) };
                        if let [nlo, end] = slots {
                            // Ends as kernels promise them: below inf and above -inf.
                            nlo.lanes_mut()[lane] = T::up((-lo).max(-1e30));
                            end.lanes_mut()[lane] = T::up(hi.max(-1e30));
                        } else {
                            slots[0].lanes_mut()[lane] = T::nearest(lo);
                        }
                    }
                }
                let mut outputs = vec![Packet::<T>::default(); program.outputs.len()];
                kernel.run(&[], &inputs, &mut outputs);
                for lane in 0..T::LANES {
                    let words: Vec<u64> = inputs.iter().map(|slot| slot.lanes()[lane].word()).collect();
                    let expected = lane_machine::run(&program, &words, &[], mode);
                    for (slot, &word) in expected.iter().enumerate() {
                        let (got, wanted) = (outputs[slot].lanes()[lane], T::from_word(word));
                        let both_nan = got.to_f64().is_nan() && wanted.to_f64().is_nan();
                        assert!(
                            got.word() == word || both_nan,
                            "{op:?} {arithmetic:?} {mode:?} slot {slot} of {words:x?}: compiled {got:?}, machine {wanted:?}"
                        );
                    }
                    if arithmetic == Arithmetic::Interval && expected[2] as u32 & verdict::EMPTY == 0 {
                        let [nlo, hi] = [0, 1].map(|slot| T::from_word(expected[slot]).to_f64());
                        assert!(
                            nlo > f64::NEG_INFINITY && hi > f64::NEG_INFINITY,
                            "{op:?} {mode:?} of {words:x?}: [{}, {hi}]",
                            -nlo
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn compiled_single_precision_equals_the_machine() {
    compiled_equals_machine::<f32>();
}

#[test]
fn compiled_double_precision_equals_the_machine() {
    compiled_equals_machine::<f64>();
}
