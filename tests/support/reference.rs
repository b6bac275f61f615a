//! The operations of `imp::interval`, random arguments for them, and the tightest results there are. Shared by
//! `tests/reference.rs` and by the oracle of `tests/peers`, each of which brings a source of values of its own.
//!
//! The tightest enclosure comes from the values at the corners of pieces on which an operation is monotone in each
//! variable, from its limits at the edges of its domain and at infinity, and from the extremes known by analysis.

use std::f64::consts::FRAC_PI_2;
use std::f64::consts::PI;

use fastrand::Rng;
use imp::interval::Interval;
use rayon::prelude::*;

const INF: f64 = f64::INFINITY;

/// Values of higher precision.
pub trait Oracle {
    /// The largest `f64` not above the value and the least not below it; at infinite arguments and signed zeros the
    /// limit from that side. `None` where there is no such limit.
    fn bracket(&mut self, op: Operation, args: &[f64]) -> Option<(f64, f64)>;

    /// floor(2 x / pi) for the ends of an interval of length at most 7: that of the lower end modulo 4, and by how much
    /// that of the upper one is greater.
    fn quarters(&mut self, lo: f64, hi: f64) -> (u32, u32);
}

macro_rules! operations {
    ($($group:ident: $($name:ident)*;)*) => {
        /// An operation on intervals; remainders, powers and roots carry what they are applied with.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Operation {
            $($($name,)*)*
            PowInt(i32),
            PowRatio(i32, u32),
            Rootn(i32),
        }

        /// Those without parameters.
        const PLAIN: &[Operation] = &[$($(Operation::$name,)*)*];
    };
}

operations! {
    arithmetic: Neg Add Sub Mul Div MulAdd Recip Sqr Sqrt Rsqrt Cbrt Hypot Abs Min Max;
    whole: Sign Floor Ceil Round RoundTiesEven Trunc Modulo;
    exponential: Pow Exp Exp2 Exp10 Expm1 Exp2m1 Exp10m1 Ln Log2 Log10 Log1p Log2p1 Log10p1;
    circular: Sin Cos Tan Asin Acos Atan Atan2;
    hyperbolic: Sinh Cosh Tanh Asinh Acosh Atanh;
}

use Operation::*;

/// A closed range whose ends may be infinite or zeros with a sign.
type Range = (f64, f64);

impl Operation {
    pub fn all() -> Vec<Self> {
        let whole = [-7, -2, -1, 0, 1, 2, 3, 4, 11, 64, 101].map(PowInt);
        let ratio = [(2, 3), (1, 4), (-1, 3), (-3, 2), (5, 3), (7, 10), (-2, 5)].map(|(p, q)| PowRatio(p, q));
        let root = [4, 7, -3, -6].map(Rootn);
        PLAIN.iter().copied().chain(whole).chain(ratio).chain(root).collect()
    }

    pub fn arity(self) -> usize {
        match self {
            Add | Sub | Mul | Div | Hypot | Min | Max | Modulo | Pow | Atan2 => 2,
            MulAdd => 3,
            _ => 1,
        }
    }

    pub fn apply(self, x: &[Interval]) -> Interval {
        let a = x[0];
        match self {
            Neg => -a,
            Add => a + x[1],
            Sub => a - x[1],
            Mul => a * x[1],
            Div => a / x[1],
            MulAdd => a.mul_add(x[1], x[2]),
            Recip => a.recip(),
            Sqr => a.sqr(),
            Sqrt => a.sqrt(),
            Rsqrt => a.rsqrt(),
            Cbrt => a.cbrt(),
            Hypot => a.hypot(x[1]),
            Abs => a.abs(),
            Min => a.min(x[1]),
            Max => a.max(x[1]),
            Sign => a.sign(),
            Floor => a.floor(),
            Ceil => a.ceil(),
            Round => a.round(),
            RoundTiesEven => a.round_ties_even(),
            Trunc => a.trunc(),
            Modulo => a.modulo(x[1]),
            Pow => a.pow(x[1]),
            Exp => a.exp(),
            Exp2 => a.exp2(),
            Exp10 => a.exp10(),
            Expm1 => a.expm1(),
            Exp2m1 => a.exp2m1(),
            Exp10m1 => a.exp10m1(),
            Ln => a.ln(),
            Log2 => a.log2(),
            Log10 => a.log10(),
            Log1p => a.log1p(),
            Log2p1 => a.log2p1(),
            Log10p1 => a.log10p1(),
            Sin => a.sin(),
            Cos => a.cos(),
            Tan => a.tan(),
            Asin => a.asin(),
            Acos => a.acos(),
            Atan => a.atan(),
            Atan2 => a.atan2(x[1]),
            Sinh => a.sinh(),
            Cosh => a.cosh(),
            Tanh => a.tanh(),
            Asinh => a.asinh(),
            Acosh => a.acosh(),
            Atanh => a.atanh(),
            PowInt(n) => a.powi(n),
            PowRatio(p, q) => a.pow_rational(p, q),
            Rootn(n) => a.rootn(n),
        }
    }

    /// How many units in the last place an end may lie outside the tightest one.
    pub fn allowance(self) -> u64 {
        match self {
            Pow | Exp | Exp2 | Exp10 | Expm1 | Exp2m1 | Exp10m1 | Ln | Log2 | Log10 | Log1p | Log2p1 | Log10p1
            | Sin | Cos | Tan | Asin | Acos | Atan | Atan2 | Sinh | Cosh | Tanh | Asinh | Acosh | Atanh => 2,
            _ => 0,
        }
    }

    /// Whether the finite point belongs to the domain.
    fn is_defined(self, x: &[f64]) -> bool {
        let a = x[0];
        match self {
            Div | Modulo => x[1] != 0.0,
            Recip => a != 0.0,
            Sqrt => a >= 0.0,
            Rsqrt | Ln | Log2 | Log10 => a > 0.0,
            Log1p | Log2p1 | Log10p1 => a > -1.0,
            Asin | Acos => a.abs() <= 1.0,
            Acosh => a >= 1.0,
            Atanh => a.abs() < 1.0,
            Atan2 => a != 0.0 || x[1] != 0.0,
            Pow => a > 0.0 || a == 0.0 && x[1] > 0.0,
            PowInt(n) => a != 0.0 || n >= 0,
            PowRatio(p, q) => (a != 0.0 || p >= 0) && (a >= 0.0 || q % 2 == 1),
            Rootn(n) => root(n).is_defined(x),
            _ => true,
        }
    }

    /// Pieces of the box, as far as it lies in the domain, on each of which the operation is monotone in each variable,
    /// or linear in each.
    fn pieces(self, x: &[Interval]) -> Vec<Vec<Range>> {
        let ranges: Vec<Range> = x.iter().map(|x| (x.lo(), x.hi())).collect();
        let a = ranges[0];
        // The part of the first variable from `lo` to `hi`, which belong to the domain or are poles.
        let clipped = |lo: f64, hi: f64| vec![(a.0.max(lo), a.1.min(hi))];
        let unary = |parts: Vec<Range>| parts.into_iter().map(|part| vec![part]).collect();
        match self {
            Sqr | Abs | Cosh => unary(halves(a)),
            Hypot => product(&halves(a), &halves(ranges[1])),
            Recip => unary(without_zero(a)),
            Div => product(&[a], &without_zero(ranges[1])),
            Sqrt if a.1 >= 0.0 => unary(clipped(0.0, INF)),
            Rsqrt | Ln | Log2 | Log10 if a.1 > 0.0 => unary(clipped(0.0, INF)),
            Log1p | Log2p1 | Log10p1 if a.1 > -1.0 => unary(clipped(-1.0, INF)),
            Asin | Acos if a.1 >= -1.0 && a.0 <= 1.0 => unary(clipped(-1.0, 1.0)),
            Acosh if a.1 >= 1.0 => unary(clipped(1.0, INF)),
            Atanh if a.1 > -1.0 && a.0 < 1.0 => unary(clipped(-1.0, 1.0)),
            Sqrt | Rsqrt | Ln | Log2 | Log10 | Log1p | Log2p1 | Log10p1 | Asin | Acos | Acosh | Atanh => Vec::new(),
            // x^y is exp(y ln x), which is linear in y and in ln x.
            Pow if a.1 > 0.0 => vec![vec![(a.0.max(0.0), a.1), ranges[1]]],
            // 0^y = 0 for y > 0.
            Pow if a.1 == 0.0 && ranges[1].1 > 0.0 => vec![vec![(0.0, 0.0), (1.0, 1.0)]],
            Pow => Vec::new(),
            PowInt(n) => unary(if n < 0 { without_zero(a) } else { halves(a) }),
            PowRatio(_, q) if q % 2 == 0 && a.1 < 0.0 => Vec::new(),
            PowRatio(p, q) => {
                let a = if q % 2 == 0 { (a.0.max(0.0), a.1) } else { a };
                unary(if p < 0 { without_zero(a) } else { halves(a) })
            }
            Rootn(n) => root(n).pieces(x),
            _ => vec![ranges],
        }
    }

    /// Brackets of values that are taken or approached inside the box, not at a corner of a piece.
    fn extremes(self, x: &[Interval], oracle: &mut impl Oracle) -> Vec<Range> {
        let pi = (PI, PI.next_up());
        let (lo, hi) = (x[0].lo(), x[0].hi());
        match self {
            Sin | Cos | Tan => {
                let (first, crossed) = if hi - lo > 7.0 { (0, 5) } else { oracle.quarters(lo, hi) };
                // Whether a multiple n pi/2 with n = k modulo 4 lies above the lower end and not above the upper one.
                let meets = |k: u32| (1..=crossed).any(|step| (first + step) % 4 == k);
                let candidates = match self {
                    Sin => [(1, 1.0), (3, -1.0), (1, 1.0), (3, -1.0)],
                    Cos => [(0, 1.0), (2, -1.0), (0, 1.0), (2, -1.0)],
                    _ => [(1, INF), (1, -INF), (3, INF), (3, -INF)],
                };
                candidates.into_iter().filter(|(k, _)| meets(*k)).map(|(_, value)| (value, value)).collect()
            }
            // Both sides of the cut.
            Atan2 if lo < 0.0 && hi >= 0.0 && x[1].lo() < 0.0 => vec![pi, (-pi.1, -pi.0)],
            Div if x[0].contains(0.0) && x[1] != Interval::ZERO => vec![(0.0, 0.0)],
            _ => Vec::new(),
        }
    }

    /// The tightest enclosure; `None` where it is not known here.
    fn tightest(self, x: &[Interval], oracle: &mut impl Oracle) -> Option<Interval> {
        let points = x.iter().all(|x| x.is_singleton());
        if self == Modulo && !(points && (x[1].lo() == 0.0 || (x[0].lo() / x[1].lo()).abs() < 2f64.powi(53))) {
            // Over boxes the floor of the quotient changes; past 2^53 it is given up by design.
            return None;
        }
        let mut hull = (INF, -INF);
        let mut widen = |(down, up): Range| hull = (hull.0.min(down), hull.1.max(up));
        for piece in self.pieces(x) {
            for corner in 0..1 << piece.len() {
                let args: Vec<f64> = piece
                    .iter()
                    .enumerate()
                    .map(|(i, part)| if corner >> i & 1 == 0 { part.0 } else { part.1 })
                    .collect();
                let removed =
                    matches!(self, Atan2 | Modulo) && args.iter().all(|x| x.is_finite()) && !self.is_defined(&args);
                if !removed && let Some(bracket) = oracle.bracket(self, &args) {
                    widen(bracket);
                }
            }
        }
        self.extremes(x, oracle).into_iter().for_each(&mut widen);
        Some(Interval::new(hull.0, hull.1).unwrap_or(Interval::EMPTY))
    }

    /// A number for the `i`-th argument: from where the operation has something to do, or from anywhere.
    fn argument(self, rng: &mut Rng, i: usize) -> f64 {
        if rng.bool() {
            return number(rng);
        }
        let sign = if rng.bool() { 1.0 } else { -1.0 };
        let x = match self {
            Exp | Expm1 | Sinh | Cosh => (rng.f64() - 0.5) * 1500.0,
            Exp2 | Exp2m1 => (rng.f64() - 0.5) * 2200.0,
            Exp10 | Exp10m1 => (rng.f64() - 0.5) * 660.0,
            Tanh => (rng.f64() - 0.5) * 80.0,
            Ln | Log2 | Log10 | Sqrt | Rsqrt => number(rng).abs(),
            Pow if i == 0 => number(rng).abs(),
            // So that the power stays in range: y about as large as 700 / |ln x| for common x.
            Pow => (rng.f64() - 0.5) * 2f64.powi(rng.i32(-4..11)),
            Log1p | Log2p1 | Log10p1 => 2f64.powi(rng.i32(-60..60)) * (rng.f64() + 1.0) - rng.f64(),
            Asin | Acos | Atanh => {
                sign * if rng.bool() { 1.0 - rng.f64() * 2f64.powi(rng.i32(-52..1)) } else { rng.f64() }
            }
            Acosh => 1.0 + rng.f64() * 2f64.powi(rng.i32(-52..60)),
            Sin | Cos | Tan => {
                let near = FRAC_PI_2 * (rng.u64(..) >> rng.u32(12..64)) as f64;
                sign * if rng.bool() { near } else { near + rng.f64() }
            }
            PowInt(n) if n != 0 => sign * 2f64.powf((rng.f64() - 0.5) * 2100.0 / f64::from(n.abs())),
            _ => number(rng),
        };
        if x.is_finite() { x } else { 1.0 }
    }

    /// A box: a point, narrow, wide or unbounded in each variable.
    fn arguments(self, rng: &mut Rng) -> Vec<Interval> {
        let points = rng.u32(0..3) == 0;
        let one = |i: usize| {
            let (a, b) = (self.argument(rng, i), self.argument(rng, i));
            let (lo, hi) = match rng.u32(0..10) {
                _ if points => (a, a),
                0 => (a, a),
                1 => (a, a.next_up()),
                2 => (-INF, a),
                3 => (a, INF),
                4 => (a, a + a.abs() * 2f64.powi(-rng.i32(1..50))),
                5 | 6 => (a, a + rng.f64() * 7.0),
                7 if rng.u32(0..10) == 0 => (-INF, INF),
                _ => (a.min(b), a.max(b)),
            };
            Interval::new(lo, hi).unwrap_or(Interval::ENTIRE)
        };
        (0..self.arity()).map(one).collect()
    }
}

/// The n-th root as a power.
pub fn root(n: i32) -> Operation {
    PowRatio(n.signum(), n.unsigned_abs())
}

/// An operation that asks for an argument: which members of a box have their values in a set.
pub struct Reverse {
    pub name: &'static str,
    forward: Operation,
    /// The place of the argument asked for; the other one, if there is one, is known.
    unknown: usize,
    /// On the box of the known argument, on the set of values and on the box of the argument asked for.
    apply: fn(Interval, Interval, Interval) -> Interval,
}

pub const REVERSE: &[Reverse] = &[
    Reverse { name: "SqrRev", forward: Sqr, unknown: 0, apply: |_, c, x| c.sqr_rev(x) },
    Reverse { name: "AbsRev", forward: Abs, unknown: 0, apply: |_, c, x| c.abs_rev(x) },
    Reverse { name: "SinRev", forward: Sin, unknown: 0, apply: |_, c, x| c.sin_rev(x) },
    Reverse { name: "CosRev", forward: Cos, unknown: 0, apply: |_, c, x| c.cos_rev(x) },
    Reverse { name: "TanRev", forward: Tan, unknown: 0, apply: |_, c, x| c.tan_rev(x) },
    Reverse { name: "CoshRev", forward: Cosh, unknown: 0, apply: |_, c, x| c.cosh_rev(x) },
    Reverse { name: "PowIntRev(3)", forward: PowInt(3), unknown: 0, apply: |_, c, x| c.powi_rev(x, 3) },
    Reverse { name: "PowIntRev(4)", forward: PowInt(4), unknown: 0, apply: |_, c, x| c.powi_rev(x, 4) },
    Reverse { name: "PowIntRev(-2)", forward: PowInt(-2), unknown: 0, apply: |_, c, x| c.powi_rev(x, -2) },
    Reverse { name: "PowIntRev(-1)", forward: PowInt(-1), unknown: 0, apply: |_, c, x| c.powi_rev(x, -1) },
    Reverse {
        name: "PowRatioRev(2, 3)",
        forward: PowRatio(2, 3),
        unknown: 0,
        apply: |_, c, x| c.pow_rational_rev(x, 2, 3),
    },
    Reverse { name: "MulRev", forward: Mul, unknown: 1, apply: |b, c, x| b.mul_rev(c, x) },
    Reverse {
        name: "MulRevToPair",
        forward: Mul,
        unknown: 1,
        apply: |b, c, x| {
            b.mul_rev_to_pair(c).map(|part| part.intersect(x)).into_iter().fold(Interval::EMPTY, Interval::hull)
        },
    },
    Reverse { name: "PowRev1", forward: Pow, unknown: 0, apply: |b, c, x| b.pow_rev1(c, x) },
    Reverse { name: "PowRev2", forward: Pow, unknown: 1, apply: |a, c, x| a.pow_rev2(c, x) },
    Reverse { name: "Atan2Rev1", forward: Atan2, unknown: 0, apply: |x, c, y| x.atan2_rev1(c, y) },
    Reverse { name: "Atan2Rev2", forward: Atan2, unknown: 1, apply: |y, c, x| y.atan2_rev2(c, x) },
];

/// The range cut at 0.
fn halves((lo, hi): Range) -> Vec<Range> {
    if lo < 0.0 && hi > 0.0 { vec![(lo, -0.0), (0.0, hi)] } else { vec![(lo, hi)] }
}

/// The range cut at 0, where there is a pole; the sign of a zero end tells the side.
fn without_zero((lo, hi): Range) -> Vec<Range> {
    let negative = (lo < 0.0).then_some((lo, if hi >= 0.0 { -0.0 } else { hi }));
    let positive = (hi > 0.0).then_some((if lo <= 0.0 { 0.0 } else { lo }, hi));
    negative.into_iter().chain(positive).collect()
}

fn product(a: &[Range], b: &[Range]) -> Vec<Vec<Range>> {
    a.iter().flat_map(|&a| b.iter().map(move |&b| vec![a, b])).collect()
}

/// A finite number of one of the kinds that break arithmetic.
fn number(rng: &mut Rng) -> f64 {
    const SPECIAL: [f64; 12] =
        [0.0, -0.0, 1.0, -1.0, 0.5, 2.0, 5e-324, -5e-324, f64::MIN_POSITIVE, f64::MAX, f64::MIN, f64::EPSILON];
    let x = match rng.u32(0..14) {
        0 => SPECIAL[rng.usize(0..SPECIAL.len())],
        // Exponents evenly; subnormal numbers.
        1..=3 => f64::from_bits(rng.u64(..)),
        4 => f64::from_bits(rng.u64(..) & 0x800f_ffff_ffff_ffff),
        // Whole numbers and halves, their neighbours, large whole numbers.
        5 => f64::from(rng.i32(-200..200)) / 2.0,
        6 => f64::from(rng.i32(-20..20)).next_up(),
        7 => f64::from(rng.i32(-20..20)).next_down(),
        8 => rng.i64(-(1 << 53)..1 << 53) as f64,
        9 => f64::from(rng.i32(-1000..1000)) * FRAC_PI_2,
        10 => 2f64.powi(rng.i32(-1074..1024)),
        11 => 1.0 + (rng.f64() - 0.5) * 2f64.powi(rng.i32(-60..0)),
        12 => (rng.f64() - 0.5) * 1500.0,
        _ => (rng.f64() - 0.5) * 8.0,
    };
    if x.is_finite() { x } else { 1.0 }
}

/// A finite member of `x`, its ends among the choices.
fn member(rng: &mut Rng, x: Interval) -> f64 {
    let inside = |t: f64| t.clamp(x.lo().max(f64::MIN), x.hi().min(f64::MAX));
    let (lo, hi) = (inside(x.lo()), inside(x.hi()));
    let member = match rng.u32(0..6) {
        0 => lo,
        1 => hi,
        2 => inside(number(rng)),
        _ => inside(lo + (hi / 2.0 - lo / 2.0) * 2.0 * rng.f64()),
    };
    // Zeros without a sign, as real numbers have it.
    member + 0.0
}

/// What the cases of one operation came to.
#[derive(Default)]
pub struct Tally {
    pub cases: u64,
    /// Values of members that were looked at, those at corners not counted.
    pub members: u64,
    /// Cases with a value outside the result, or with a result that is empty or not empty against the domain.
    pub escapes: u64,
    pub escape: Option<String>,
    /// Ends whose tightest place is known, and how many of those are there.
    pub ends: u64,
    pub tight: u64,
    /// Units in the last place between an end and the tightest one, at worst, with the case.
    pub lower: u64,
    pub upper: u64,
    pub widest: Option<String>,
}

impl Tally {
    /// Runs cases in parallel, in chunks that have a seed of their own each: the arguments do not depend on the threads.
    pub fn in_chunks(cases: u64, chunk: u64, work: impl Fn(u64, u64) -> Self + Sync) -> Self {
        (0..cases.div_ceil(chunk))
            .into_par_iter()
            .map(|seed| work(seed, chunk.min(cases - seed * chunk)))
            .reduce(Self::default, Self::merge)
    }

    /// Runs seeded random cases.
    pub fn of(op: Operation, seed: u64, cases: u64, oracle: &mut impl Oracle) -> Self {
        let mut tally = Self { cases, ..Self::default() };
        let mut rng = Rng::with_seed(seed);
        for _ in 0..cases {
            tally.case(op, &op.arguments(&mut rng), &mut rng, oracle);
        }
        tally
    }

    /// As [`Tally::of`]: the values are those of members of the boxes, so that the members must be found again.
    pub fn of_reverse(op: &Reverse, seed: u64, cases: u64, oracle: &mut impl Oracle) -> Self {
        let mut tally = Self { cases, ..Self::default() };
        let mut rng = Rng::with_seed(seed);
        for _ in 0..cases {
            let x = op.forward.arguments(&mut rng);
            let point: Vec<f64> = x.iter().map(|&x| member(&mut rng, x)).collect();
            if !op.forward.is_defined(&point) {
                continue;
            }
            let Some((down, up)) = oracle.bracket(op.forward, &point) else { continue };
            let values = Interval::new(down, up).expect("a value between numbers");
            let values = if rng.bool() { values } else { values.hull(Interval::point(number(&mut rng))) };
            let (known, asked) = (x[x.len() - 1 - op.unknown], x[op.unknown]);
            let found = (op.apply)(known, values, asked);
            tally.members += 1;
            if !found.contains(point[op.unknown]) || !asked.contains_interval(found) {
                tally.escapes += 1;
                tally.escape = Some(format!("{} of {x:?}, {values:?} is {found}, from {point:?}", op.name));
            }
        }
        tally
    }

    fn case(&mut self, op: Operation, x: &[Interval], rng: &mut Rng, oracle: &mut impl Oracle) {
        let y = op.apply(x);
        let escape = |what: &str| Some(format!("{op:?} of {x:?} is {y}, {what}"));
        let tightest = op.tightest(x, oracle);
        if tightest.is_none() || !x.iter().all(|x| x.is_singleton()) {
            let point: Vec<f64> = x.iter().map(|&x| member(rng, x)).collect();
            if op.is_defined(&point)
                && let Some((down, up)) = oracle.bracket(op, &point)
            {
                self.members += 1;
                // An end is a `f64`: it is at most the value if and only if it is at most the value rounded down.
                if !(y.lo() <= down && up <= y.hi()) {
                    self.escapes += 1;
                    self.escape = escape(&format!("without the value at {point:?}, between {down:e} and {up:e}"));
                }
            }
        }
        let Some(tightest) = tightest else { return };
        if !y.contains_interval(tightest) || y.is_empty() != tightest.is_empty() {
            self.escapes += 1;
            self.escape = escape(&format!("the tightest being {tightest}"));
        }
        if y.is_empty() || tightest.is_empty() {
            return;
        }
        let (lower, upper) = (neighbours(y.lo(), tightest.lo()), neighbours(tightest.hi(), y.hi()));
        self.ends += 2;
        self.tight += u64::from(lower == 0) + u64::from(upper == 0);
        if lower.max(upper) > self.lower.max(self.upper) {
            self.widest = escape(&format!("the tightest being {tightest}"));
        }
        (self.lower, self.upper) = (self.lower.max(lower), self.upper.max(upper));
    }

    fn merge(self, other: Self) -> Self {
        let wider = self.lower.max(self.upper) >= other.lower.max(other.upper);
        Self {
            cases: self.cases + other.cases,
            members: self.members + other.members,
            escapes: self.escapes + other.escapes,
            escape: self.escape.or(other.escape),
            ends: self.ends + other.ends,
            tight: self.tight + other.tight,
            lower: self.lower.max(other.lower),
            upper: self.upper.max(other.upper),
            widest: if wider { self.widest } else { other.widest },
        }
    }

    /// A row of the table below [`HEADER`]; nothing about ends where the tightest ones are not known.
    pub fn row(&self, name: &str) -> String {
        let Self { cases, members, escapes, lower, upper, .. } = self;
        if self.ends == 0 {
            return format!("| {name:18} | {cases:8} | {members:8} | {escapes:7} |       |       |        |");
        }
        let tight = 100.0 * self.tight as f64 / self.ends as f64;
        format!("| {name:18} | {cases:8} | {members:8} | {escapes:7} | {lower:5} | {upper:5} | {tight:6.2} |")
    }
}

pub const HEADER: &str = "\
| operation          |    cases |  members | escapes | lower | upper | tight % |
|--------------------|---------:|---------:|--------:|------:|------:|--------:|";

/// How many steps from one number to the next lead from `a` up to `b`; 0 if `a` is above `b`.
fn neighbours(a: f64, b: f64) -> u64 {
    let rank = |x: f64| {
        let magnitude = i128::from(x.to_bits() & (u64::MAX >> 1));
        if x.is_sign_negative() { -magnitude } else { magnitude }
    };
    u64::try_from(rank(b) - rank(a)).unwrap_or(0)
}
