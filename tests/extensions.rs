//! The extensions of whole formulas against 320-bit values: random expressions with everything that the table of
//! operations bounds between lines, on random boxes, and the sums that break affine libraries.
//!
//! `IMP_TEST_CASES` sets the number of expressions (60 unless told).

use astro_float::BigFloat;
use astro_float::Consts;
use astro_float::RoundingMode;
use fastrand::Rng;
use imp::derive::Extension;
use imp::derive::Formula;
use imp::derive::Symbols;
use imp::graph::Graph;
use imp::graph::Op;
use imp::graph::Value;
use imp::graph::parse;
use imp::interval::Decorated;
use imp::interval::Decoration;
use imp::interval::Interval;

const P: usize = 320;
const RM: RoundingMode = RoundingMode::ToEven;

fn cases() -> usize {
    std::env::var("IMP_TEST_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(60)
}

fn big(x: f64) -> BigFloat {
    BigFloat::from_f64(x, P)
}

/// Whether a comparison of two numbers answers so; false for NaN.
fn below(x: &BigFloat, y: &BigFloat) -> bool {
    x.cmp(y).is_some_and(|order| order < 0)
}

const OPERATIONS: &[Op] = &[
    Op::Add,
    Op::Add,
    Op::Sub,
    Op::Sub,
    Op::Mul,
    Op::Mul,
    Op::Div,
    Op::Neg,
    Op::Sqr,
    Op::PowInt(3),
    Op::PowInt(4),
    Op::PowInt(-1),
    Op::PowInt(-2),
    Op::PowRatio(2, 3),
    Op::PowRatio(-1, 2),
    Op::PowRatio(5, 3),
    Op::Sqrt,
    Op::Cbrt,
    Op::Abs,
    Op::Exp,
    Op::Exp2,
    Op::Exp10,
    Op::Expm1,
    Op::Ln,
    Op::Log1p,
    Op::Log2,
    Op::Log10,
    Op::Sin,
    Op::Cos,
    Op::Tan,
    Op::Asin,
    Op::Acos,
    Op::Atan,
    Op::Sinh,
    Op::Cosh,
    Op::Tanh,
    Op::Asinh,
    Op::Acosh,
    Op::Atanh,
    Op::Min,
    Op::Max,
    Op::Hypot,
    Op::Pow,
    Op::Atan2,
];

/// A rational power of a number for which it is defined.
fn rational_power(x: &BigFloat, p: i32, q: u32, cc: &mut Consts) -> BigFloat {
    if x.is_zero() {
        return big(0.0);
    }
    let ratio = big(p.into()).div(&big(q.into()), P, RM);
    let power = x.abs().pow(&ratio, P, RM, cc);
    if x.is_negative() && p % 2 != 0 { power.neg() } else { power }
}

/// The angle of the point (x, y), not the origin.
fn angle(y: &BigFloat, x: &BigFloat, cc: &mut Consts) -> BigFloat {
    let pi = cc.pi(P, RM);
    if x.is_zero() {
        let half = pi.div(&big(2.0), P, RM);
        return if y.is_negative() { half.neg() } else { half };
    }
    let slope = y.div(x, P, RM).atan(P, RM, cc);
    match (x.is_negative(), y.is_negative() && !y.is_zero()) {
        (false, _) => slope,
        (true, false) => slope.add(&pi, P, RM),
        (true, true) => slope.sub(&pi, P, RM),
    }
}

/// The value of an operation; `None` where it is undefined or beyond the numbers that are worth a comparison.
fn value(op: Op, x: &BigFloat, y: &BigFloat, cc: &mut Consts) -> Option<BigFloat> {
    let one = big(1.0);
    let positive = !x.is_negative() && !x.is_zero();
    let inside_one = !below(&one, &x.abs());
    let defined = match op {
        Op::Div => !y.is_zero(),
        Op::PowInt(n) => n >= 0 || !x.is_zero(),
        Op::PowRatio(p, q) => (p >= 0 || !x.is_zero()) && (q % 2 == 1 || positive || x.is_zero()),
        Op::Sqrt => positive || x.is_zero(),
        Op::Ln | Op::Log2 | Op::Log10 => positive,
        Op::Log1p => below(&one.neg(), x),
        Op::Asin | Op::Acos => inside_one,
        Op::Atanh => below(&x.abs(), &one),
        Op::Acosh => !below(x, &one),
        Op::Pow => positive,
        Op::Atan2 => !x.is_zero() || !y.is_zero(),
        _ => true,
    };
    if !defined {
        return None;
    }
    let result = match op {
        Op::Add => x.add(y, P, RM),
        Op::Sub => x.sub(y, P, RM),
        Op::Mul => x.mul(y, P, RM),
        Op::Div => x.div(y, P, RM),
        Op::Neg => x.neg(),
        Op::Sqr => x.mul(x, P, RM),
        Op::PowInt(n) => {
            let whole = (0..n.unsigned_abs()).fold(one.clone(), |power, _| power.mul(x, P, RM));
            if n < 0 { one.div(&whole, P, RM) } else { whole }
        }
        Op::PowRatio(p, q) => rational_power(x, p, q, cc),
        Op::Sqrt => x.sqrt(P, RM),
        Op::Cbrt => x.cbrt(P, RM),
        Op::Abs => x.abs(),
        Op::Exp => x.exp(P, RM, cc),
        Op::Exp2 => big(2.0).pow(x, P, RM, cc),
        Op::Exp10 => big(10.0).pow(x, P, RM, cc),
        Op::Expm1 => x.exp(2 * P, RM, cc).sub(&one, P, RM),
        Op::Ln => x.ln(P, RM, cc),
        Op::Log1p => x.add(&one, 2 * P, RM).ln(P, RM, cc),
        Op::Log2 => x.log2(P, RM, cc),
        Op::Log10 => x.log10(P, RM, cc),
        Op::Sin => x.sin(P, RM, cc),
        Op::Cos => x.cos(P, RM, cc),
        Op::Tan => x.tan(P, RM, cc),
        Op::Asin => x.asin(P, RM, cc),
        Op::Acos => x.acos(P, RM, cc),
        Op::Atan => x.atan(P, RM, cc),
        Op::Sinh => x.sinh(P, RM, cc),
        Op::Cosh => x.cosh(P, RM, cc),
        Op::Tanh => x.tanh(P, RM, cc),
        Op::Asinh => x.asinh(P, RM, cc),
        Op::Acosh => x.acosh(P, RM, cc),
        Op::Atanh => x.atanh(P, RM, cc),
        Op::Min => {
            if below(x, y) {
                x.clone()
            } else {
                y.clone()
            }
        }
        Op::Max => {
            if below(x, y) {
                y.clone()
            } else {
                x.clone()
            }
        }
        Op::Hypot => x.mul(x, P, RM).add(&y.mul(y, P, RM), P, RM).sqrt(P, RM),
        Op::Pow => x.pow(y, P, RM, cc),
        Op::Atan2 => angle(x, y, cc),
        _ => unreachable!("{op:?} is not drawn"),
    };
    let size = result.abs();
    let worthwhile = result.is_zero() || below(&big(1e-30), &size) && below(&size, &big(1e30));
    (worthwhile && !result.is_nan()).then_some(result)
}

/// A formula in x and y, with the operations that lead to it.
struct Expression {
    graph: Graph,
    steps: Vec<(Op, usize, usize)>,
    constants: Vec<f64>,
}

impl Expression {
    /// Values 0 and 1 are the inputs, then come the constants, then the steps, each on any two values before it.
    fn random(rng: &mut Rng) -> Self {
        let mut graph = Graph::new();
        let mut values = vec![graph.var("x"), graph.var("y")];
        let constants: Vec<f64> = (0..2).map(|_| f64::from(rng.i32(-40..40)) / 8.0).collect();
        for &constant in &constants {
            let exact = num_rational::BigRational::from_float(constant).expect("finite");
            values.push(graph.constant(exact));
        }
        let mut steps = Vec::new();
        for _ in 0..rng.usize(2..9) {
            let op = OPERATIONS[rng.usize(0..OPERATIONS.len())];
            // The last value most of the time, so that formulas get deep.
            let mut draw = || if rng.bool() { values.len() - 1 } else { rng.usize(0..values.len()) };
            let (i, j) = (draw(), draw());
            let operands = [values[i], values[j]];
            values.push(graph.push(op, &operands[..op.arity()]));
            steps.push((op, i, j));
        }
        Self { graph, steps, constants }
    }

    fn root(&self) -> Value {
        // Replaying the steps finds the nodes that are there.
        let mut graph = self.graph.clone();
        let mut values = vec![graph.var("x"), graph.var("y")];
        for &constant in &self.constants {
            values.push(graph.constant(num_rational::BigRational::from_float(constant).expect("finite")));
        }
        for &(op, i, j) in &self.steps {
            let operands = [values[i], values[j]];
            values.push(graph.push(op, &operands[..op.arity()]));
        }
        *values.last().expect("at least the inputs")
    }

    fn at(&self, x: f64, y: f64, cc: &mut Consts) -> Option<BigFloat> {
        let mut values = vec![big(x), big(y)];
        values.extend(self.constants.iter().map(|&constant| big(constant)));
        for &(op, i, j) in &self.steps {
            let next = value(op, &values[i], &values[j], cc)?;
            values.push(next);
        }
        values.pop()
    }
}

/// Whether the enclosure holds the value, which is itself known to some 90 bits after the cancellations of 320.
fn contains(enclosure: Interval, value: &BigFloat) -> bool {
    let doubt = value.abs().mul(&big(2f64.powi(-90)), P, RM);
    let (least, most) = (value.sub(&doubt, P, RM), value.add(&doubt, P, RM));
    let above = enclosure.lo() == f64::NEG_INFINITY || !below(&most, &big(enclosure.lo()));
    !enclosure.is_empty() && above && (enclosure.hi() == f64::INFINITY || !below(&big(enclosure.hi()), &least))
}

#[test]
fn random_expressions_are_contained() {
    let mut cc = Consts::new().expect("constants");
    let mut rng = Rng::with_seed(60);
    let (mut compared, mut narrower) = (0, 0);
    for case in 0..cases() {
        let expression = Expression::random(&mut rng);
        let formula = Formula::new(&expression.graph, expression.root());
        for _ in 0..3 {
            let side = |rng: &mut Rng| {
                let lo = (rng.f64() - 0.4) * 8.0;
                Interval::new(lo, lo + rng.f64() * 2f64.powi(rng.i32(-20..3))).expect("in order")
            };
            let sides = [side(&mut rng), side(&mut rng)];
            let inputs = sides.map(Decorated::new);
            let natural = formula.enclose(Extension::Natural, &inputs);
            let found: Vec<(Extension, Decorated)> =
                Extension::ALL.iter().map(|&extension| (extension, formula.enclose(extension, &inputs))).collect();
            for (extension, enclosure) in &found {
                assert!(!enclosure.interval().lo().is_nan() || enclosure.decoration() <= Decoration::Trv);
                if let Extension::Intersected(_) = extension {
                    let widens = !natural.interval().contains_interval(enclosure.interval());
                    assert!(!widens, "case {case}: {extension} gives {enclosure}, interval {natural}");
                }
                narrower += usize::from(enclosure.interval().width() < 0.5 * natural.interval().width());
            }
            let ends = |rng: &mut Rng, x: Interval| match rng.u32(0..4) {
                0 => x.lo(),
                1 => x.hi(),
                _ => (x.lo() + (x.hi() - x.lo()) * rng.f64()).clamp(x.lo(), x.hi()),
            };
            for _ in 0..4 {
                let (x, y) = (ends(&mut rng, sides[0]), ends(&mut rng, sides[1]));
                let Some(value) = expression.at(x, y, &mut cc) else { continue };
                compared += 1;
                for (extension, enclosure) in &found {
                    assert!(
                        contains(enclosure.interval(), &value),
                        "case {case}, {extension}: {value} at ({x:e}, {y:e}) is not in {enclosure} on {sides:?}: {:?}",
                        expression.steps
                    );
                }
            }
        }
    }
    assert!(
        compared > 2 * cases() && narrower > cases() / 4,
        "{compared} values compared, {narrower} enclosures halved"
    );
}

/// The sum that affine libraries lose which take no account of rounding: [-1, 1] + 1e23 + 2020 - 1e23.
#[test]
fn a_small_interval_survives_a_large_constant() {
    let text = "v0 = var x\nv1 = const 100000000000000000000000\nv2 = const 2020\nv3 = add v0, v1\nv4 = add v3, v2\n\
                v5 = sub v4, v1\nout f = v5";
    let graph = parse(text).expect("a graph");
    let formula = Formula::new(&graph, graph.output("f").expect("the output"));
    let x = [Decorated::new(Interval::new(-1.0, 1.0).expect("in order"))];
    for &extension in Extension::ALL {
        let found = formula.enclose(extension, &x).interval();
        assert!(found.contains(2019.0) && found.contains(2021.0), "{extension}: {found}");
        // 1e23 has neighbours 2^24 away: nothing tighter than a few of those, and nothing worse, but where the large
        // constant cancels before anything is rounded, in the slope.
        assert!(found.width() < 2f64.powi(28), "{extension}: {found}");
    }
}

/// The excess of an enclosure over the range is of second order in the width of the box for all but the natural
/// extension.
#[test]
fn excess_shrinks_with_the_square_of_the_width() {
    let formulas = [
        // exp(-x^2) sin(3 x), sqrt(x^2 - x + 1/2) / sqrt(x^2 + 1/2), ln(1 + x^2) atan(x) / cosh(x)
        "v0 = var x\nv1 = sqr v0\nv2 = neg v1\nv3 = exp v2\nv4 = const 3\nv5 = mul v4, v0\nv6 = sin v5\nv7 = mul v3, v6\n\
         out f = v7",
        "v0 = var x\nv1 = sqr v0\nv2 = sub v1, v0\nv3 = const 1/2\nv4 = add v2, v3\nv5 = sqrt v4\nv6 = add v1, v3\n\
         v7 = sqrt v6\nv8 = div v5, v7\nout f = v8",
        "v0 = var x\nv1 = sqr v0\nv2 = log1p v1\nv3 = atan v0\nv4 = mul v2, v3\nv5 = cosh v0\nv6 = div v4, v5\nout f = v6",
    ];
    for text in formulas {
        let graph = parse(text).expect("a graph");
        let formula = Formula::new(&graph, graph.output("f").expect("the output"));
        // All three are monotone here: the range lies between the values at the ends.
        let excess = |extension, radius: f64| {
            let of = |lo: f64, hi: f64| {
                formula.enclose(extension, &[Decorated::new(Interval::new(lo, hi).expect("in order"))]).interval()
            };
            let (lo, hi) = (0.9 - radius, 0.9 + radius);
            let range = of(lo, lo).hull(of(hi, hi));
            of(lo, hi).width() - range.width()
        };
        for &extension in Extension::ALL.iter().filter(|extension| **extension != Extension::Natural) {
            let (whole, half) = (excess(extension, 1.0 / 64.0), excess(extension, 1.0 / 128.0));
            assert!(half <= whole / 3.5 + 1e-14, "{extension}: {whole}, then {half} for {text}");
        }
    }
}

#[test]
fn more_symbols_are_no_worse_where_they_are_shared() {
    let text = "v0 = var x\nv1 = var y\nv2 = sub v0, v1\nv3 = add v0, v1\nv4 = mul v2, v3\nv5 = sqr v1\nv6 = add v4, v5\n\
                out f = v6";
    let graph = parse(text).expect("a graph");
    let formula = Formula::new(&graph, graph.output("f").expect("the output"));
    let side = |lo: f64, hi: f64| Decorated::new(Interval::new(lo, hi).expect("in order"));
    let inputs = [side(1.0, 1.5), side(2.0, 2.25)];
    let width = |symbols| formula.enclose(Extension::Affine(symbols), &inputs).interval().width();
    // x^2, once y cancels: the second symbol is y's, a third is left over.
    assert!(width(Symbols::Two) < 0.5 * width(Symbols::One));
    assert_eq!(width(Symbols::Two), width(Symbols::Three));
    assert!(width(Symbols::Full) < width(Symbols::Three));
}
