//! Every operation of `imp::interval` on random arguments against values of 256 bits: no value escapes, and the ends lie
//! at most so many units in the last place outside the tightest ones: 0 for arithmetic, roots, powers with a constant
//! exponent and step functions, 2 for elementary functions. With `--nocapture` the worst of each operation is printed.
//!
//! `IMP_TEST_CASES` sets the number of arguments per operation (150 unless told). The oracle of `tests/peers` runs the same
//! cases against MPFR, a million per operation.

#[path = "support/oracle.rs"]
mod oracle;
#[path = "support/reference.rs"]
mod reference;

use std::f64::consts::FRAC_PI_2;
use std::f64::consts::PI;

use astro_float::BigFloat;
use astro_float::Consts;
use astro_float::RoundingMode;
use imp::graph::Op;
use num_rational::BigRational;
use oracle::big;
use reference::HEADER;
use reference::Operation;
use reference::Operation::*;
use reference::Oracle;
use reference::REVERSE;
use reference::Tally;

const P: usize = 256;
const RM: RoundingMode = RoundingMode::ToEven;

fn cases() -> u64 {
    std::env::var("IMP_TEST_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(150)
}

/// Runs the cases and prints a row.
fn run(name: &str, work: impl Fn(u64, u64, &mut Values) -> Tally + Sync) -> Tally {
    let tally = Tally::in_chunks(cases(), 25, |seed, cases| {
        work(seed, cases, &mut Values { cc: Consts::new().expect("constants") })
    });
    println!("{}", tally.row(name));
    tally
}

#[test]
fn every_operation_encloses_its_values_tightly() {
    println!("{HEADER}");
    for op in Operation::all() {
        let tally = run(&format!("{op:?}"), |seed, cases, values| Tally::of(op, seed, cases, values));
        assert_eq!(tally.escapes, 0, "{}", tally.escape.unwrap_or_default());
        let worst = tally.lower.max(tally.upper);
        assert!(worst <= op.allowance(), "{worst} units: {}", tally.widest.unwrap_or_default());
    }
}

#[test]
fn reverse_operations_find_every_solution() {
    for op in REVERSE {
        let tally = run(op.name, |seed, cases, values| Tally::of_reverse(op, seed, cases, &mut Wider(values)));
        assert!(tally.members > cases() / 2, "{} has hardly been asked", op.name);
        assert_eq!(tally.escapes, 0, "{}", tally.escape.unwrap_or_default());
    }
}

/// Values of astro-float.
struct Values {
    cc: Consts,
}

/// Brackets that hold the value even where a `f64` near it was taken for it: what a reverse operation needs, since an
/// argument whose value is not in the set must not be found.
struct Wider<'a>(&'a mut Values);

impl Oracle for Wider<'_> {
    fn bracket(&mut self, op: Operation, args: &[f64]) -> Option<(f64, f64)> {
        self.0.bracket(op, args).map(|(down, up)| (down.next_down(), up.next_up()))
    }

    fn quarters(&mut self, lo: f64, hi: f64) -> (u32, u32) {
        self.0.quarters(lo, hi)
    }
}

/// The neighbours of an exact value.
fn exact(value: &BigFloat) -> Option<(f64, f64)> {
    if value.is_nan() {
        return None;
    }
    // The leading bits are off by less than two units: the comparisons settle the rest.
    let mut down = leading(value);
    while !oracle::at_most(down, value) {
        down = down.next_down();
    }
    while oracle::at_most(down.next_up(), value) {
        down = down.next_up();
    }
    // A value past all numbers is no infinity.
    Some(if oracle::at_least(down, value) { (down, down) } else { (down, down.next_up()) })
}

/// A `f64` near the value.
fn leading(value: &BigFloat) -> f64 {
    let Some((words, _, _, exponent, _)) = value.as_raw_parts() else {
        return if value.is_negative() { f64::MIN } else { f64::MAX };
    };
    let fraction = words.last().map_or(0.0, |&word| word as f64 * 2f64.powi(-64));
    let half = exponent.clamp(-1100, 1100) / 2;
    let magnitude = fraction * 2f64.powi(half) * 2f64.powi(exponent.clamp(-1100, 1100) - half);
    let magnitude = magnitude.min(f64::MAX);
    if value.is_negative() { -magnitude } else { magnitude }
}

/// The neighbours of a value that is off by less than 2^-200 of itself. If a `f64` is as near as that, it is taken for
/// the value: any enclosure of the value by two `f64`s holds it too, and the tightest one may come out a unit smaller.
fn nearly(value: &BigFloat) -> Option<(f64, f64)> {
    let (down, up) = exact(value)?;
    let slack = value.abs().mul(&big(2f64.powi(-200)), P, RM);
    let is_near = |x: f64| x.is_finite() && big(x).sub(value, P + 64, RM).abs() <= slack;
    Some(match (is_near(down), is_near(up)) {
        (true, _) => (down, down),
        (false, true) => (up, up),
        (false, false) => (down, up),
    })
}

/// A limit in `f64`: 0, 1, an argument, an infinity, or a multiple of pi/2, which lies above its `f64`.
fn limit(x: f64) -> Option<(f64, f64)> {
    match x.abs() {
        size if size == PI || size == FRAC_PI_2 => {
            Some(if x > 0.0 { (size, size.next_up()) } else { (-size.next_up(), -size) })
        }
        size => (!size.is_nan()).then_some((x, x)),
    }
}

/// x^n without rounding.
fn power(x: &BigFloat, n: u32) -> BigFloat {
    (0..n).fold(big(1.0), |product, _| product.mul_full_prec(x))
}

/// x^(p/q) at 0 and infinity, from the side of the sign of x.
fn limit_of_power(x: f64, p: i32, q: u32) -> f64 {
    let size = x.abs().powf(f64::from(p) / f64::from(q));
    if x.is_sign_negative() && p % 2 != 0 { -size } else { size }
}

impl Values {
    fn value(&mut self, op: Op, x: f64, y: f64) -> BigFloat {
        oracle::value(op, x, y, &mut self.cc).expect("a value of high precision")
    }
}

/// e^t - 1, for |t| < 2^-90 by three terms of the series, which are off by less than 2^-270 of it.
fn expm1(t: &BigFloat, cc: &mut Consts) -> BigFloat {
    let p = P + 64;
    if t.abs() < big(2f64.powi(-90)) {
        let tail = big(1.0).add(&t.div(&big(3.0), p, RM), p, RM).mul(t, p, RM).div(&big(2.0), p, RM);
        return big(1.0).add(&tail, p, RM).mul(t, p, RM);
    }
    t.exp(p + 128, RM, cc).sub(&big(1.0), p + 128, RM)
}

impl Oracle for Values {
    fn bracket(&mut self, op: Operation, args: &[f64]) -> Option<(f64, f64)> {
        let at = |i: usize| args.get(i).copied().unwrap_or(0.0);
        let (x, y, z) = (at(0), at(1), at(2));
        let finite = args.iter().all(|x| x.is_finite());
        let a = || big(x);
        match op {
            Neg => limit(-x),
            Abs => limit(x.abs()),
            Min => limit(x.min(y)),
            Max => limit(x.max(y)),
            Sign => limit(if x == 0.0 { 0.0 } else { x.signum() }),
            Floor => limit(x.floor()),
            Ceil => limit(x.ceil()),
            Round => limit(x.round()),
            RoundTiesEven => limit(x.round_ties_even()),
            Trunc => limit(x.trunc()),
            Add if !finite => limit(x + y),
            Add => exact(&oracle::sum(&a(), &big(y))),
            Sub if !finite => limit(x - y),
            Sub => exact(&oracle::sum(&a(), &big(-y))),
            // 0 times an infinite end: 0, as all products of 0 and a member are.
            Mul if x == 0.0 || y == 0.0 => limit(0.0),
            Mul if !finite => limit(x * y),
            Mul => exact(&a().mul_full_prec(&big(y))),
            Div if !finite || x == 0.0 || y == 0.0 => limit(x / y),
            Div => exact(&a().div(&big(y), P, RM)),
            // An infinite end of the addend settles the sum.
            MulAdd if z.is_infinite() || x == 0.0 || y == 0.0 => limit(z),
            MulAdd if !finite => limit(x * y),
            MulAdd => exact(&oracle::sum(&a().mul_full_prec(&big(y)), &big(z))),
            Recip if !finite || x == 0.0 => limit(1.0 / x),
            Recip => exact(&big(1.0).div(&a(), P, RM)),
            Sqr if !finite => limit(f64::INFINITY),
            Sqr => exact(&power(&a(), 2)),
            Rsqrt if !finite || x == 0.0 => limit(1.0 / x),
            Rsqrt => nearly(&big(1.0).div(&a().sqrt(P + 64, RM), P, RM)),
            Sqrt if !finite || x == 0.0 => limit(x),
            Sqrt => exact(&a().sqrt(P, RM)),
            Cbrt if !finite || x == 0.0 => limit(x),
            Cbrt => exact(&a().cbrt(P, RM)),
            Hypot if !finite => limit(f64::INFINITY),
            Hypot => {
                let square = oracle::sum(&power(&a(), 2), &power(&big(y), 2));
                // A root that rounds to a `f64` may still lie beside it: the square tells.
                let (down, up) = exact(&square.sqrt(P, RM))?;
                match square.cmp(&power(&big(down), 2))? {
                    ..0 => Some((down.next_down(), down)),
                    0 => Some((down, down)),
                    _ => Some((down, up.max(down.next_up()))),
                }
            }
            Modulo => {
                let [x, y] = [x, y].map(|x| BigRational::from_float(x).expect("a finite number"));
                let remainder = &x - &y * (&x / &y).floor();
                let nearest = imp::interval::Interval::from_rational(&remainder);
                Some((nearest.lo(), nearest.hi()))
            }
            PowInt(n) if !finite || x == 0.0 => limit(if n == 0 { 1.0 } else { limit_of_power(x, n, 1) }),
            PowInt(n) if n >= 0 => exact(&power(&a(), n.unsigned_abs())),
            PowInt(n) => exact(&big(1.0).div(&power(&a(), n.unsigned_abs()), P, RM)),
            Rootn(n) => self.bracket(reference::root(n), args),
            PowRatio(p, q) if !finite || x == 0.0 => limit(limit_of_power(x, p, q)),
            Pow if !finite || x == 0.0 || y == 0.0 => limit(x.powf(y)),
            Exp | Exp2 | Exp10 | Cosh | Cos if x == 0.0 => limit(1.0),
            Acos if x == 0.0 => limit(FRAC_PI_2),
            Ln | Log2 | Log10 if x == 0.0 => limit(f64::NEG_INFINITY),
            Expm1 | Exp2m1 | Exp10m1 | Log1p | Log2p1 | Log10p1 | Sin | Tan | Asin | Atan | Sinh | Tanh | Asinh
            | Atanh
                if x == 0.0 =>
            {
                limit(0.0)
            }
            Exp | Exp2 | Exp10 if !finite => limit(x.exp()),
            Expm1 | Exp2m1 | Exp10m1 if !finite => limit(x.exp_m1()),
            Ln | Log2 | Log10 | Acosh | Log1p | Log2p1 | Log10p1 | Sinh | Asinh if !finite => limit(x),
            Cosh if !finite => limit(x.abs()),
            Tanh if !finite => limit(x.signum()),
            Atan if !finite => limit(x.atan()),
            Sin | Cos | Tan if !finite => None,
            Log1p | Log2p1 | Log10p1 if x == -1.0 => limit(f64::NEG_INFINITY),
            Atanh if x.abs() == 1.0 => limit(x * f64::INFINITY),
            Asin if x.abs() == 1.0 => limit(x.asin()),
            Acos if x.abs() == 1.0 => limit(x.acos()),
            Acosh if x == 1.0 => limit(0.0),
            // Between the limits of the two ends, which are at other corners.
            Atan2 if x.is_infinite() && y.is_infinite() => None,
            Atan2 if !finite || x == 0.0 || y == 0.0 => limit(x.atan2(y)),
            // Through e^t - 1 and ln(1 + x), whose small values the oracle keeps.
            Exp2m1 => nearly(&expm1(&a().mul(&self.cc.ln_2(P + 64, RM), P + 64, RM), &mut self.cc)),
            Exp10m1 => nearly(&expm1(&a().mul(&self.cc.ln_10(P + 64, RM), P + 64, RM), &mut self.cc)),
            Log2p1 => nearly(&self.value(Op::Log1p, x, y).div(&self.cc.ln_2(P, RM), P, RM)),
            Log10p1 => nearly(&self.value(Op::Log1p, x, y).div(&self.cc.ln_10(P, RM), P, RM)),
            _ => nearly(&self.value(elementary(op), x, y)),
        }
    }

    fn quarters(&mut self, lo: f64, hi: f64) -> (u32, u32) {
        // 2/pi to 1400 bits times a `f64` below 2^1024: no multiple of pi/2 but 0 is nearly as close to a `f64`.
        let half_pi = self.cc.pi(1400, RM).div(&big(2.0), 1400, RM);
        let [first, last] = [lo, hi].map(|x| big(x).div(&half_pi, 1400, RM).floor());
        let turns = first.div(&big(4.0), 1400, RM).floor();
        let difference =
            |x: &BigFloat, y: &BigFloat| exact(&oracle::sum(x, &y.neg())).map_or(0, |(down, _)| down as u32);
        (difference(&first, &turns.mul_full_prec(&big(4.0))), difference(&last, &first))
    }
}

/// The operation of the graph that the oracle of the kernels knows.
fn elementary(op: Operation) -> Op {
    match op {
        Pow => Op::Pow,
        PowRatio(p, q) => Op::PowRatio(p, q),
        Exp => Op::Exp,
        Exp2 => Op::Exp2,
        Exp10 => Op::Exp10,
        Expm1 => Op::Expm1,
        Ln => Op::Ln,
        Log2 => Op::Log2,
        Log10 => Op::Log10,
        Log1p => Op::Log1p,
        Sin => Op::Sin,
        Cos => Op::Cos,
        Tan => Op::Tan,
        Asin => Op::Asin,
        Acos => Op::Acos,
        Atan => Op::Atan,
        Atan2 => Op::Atan2,
        Sinh => Op::Sinh,
        Cosh => Op::Cosh,
        Tanh => Op::Tanh,
        Asinh => Op::Asinh,
        Acosh => Op::Acosh,
        Atanh => Op::Atanh,
        _ => unreachable!("{op:?} has its values above"),
    }
}
