//! Values of operations by MPFR (Fousse, Hanrot, Lefevre, Pelissier, Zimmermann, 2007), which rounds them correctly.

use std::cmp::Ordering;

use rug::Float;
use rug::Integer;
use rug::Rational;
use rug::float::Constant;
use rug::float::Round;
use rug::ops::AssignRound;
use rug::ops::Pow as _;

use crate::reference::Operation;
use crate::reference::Operation::*;
use crate::reference::Oracle;
use crate::reference::root;

pub const PRECISION: u32 = 200;
/// 2/pi to this many bits times any `f64`, below 2^1024, has an error below 2^-170, and no multiple of pi/2 other than 0
/// is as close to a `f64` as that times pi/2 (the nearest is some 2^-60 away).
const QUARTER_BITS: u32 = 1200;

pub struct Mpfr;

/// The neighbours of a value that is given by an expression. Rounding down to 200 bits and then to 53 is rounding down,
/// and so is rounding up: nothing is lost on the way.
fn neighbours<T>(expression: T) -> Option<(f64, f64)>
where
    Float: AssignRound<T, Round = Round, Ordering = Ordering>,
{
    let (down, order) = Float::with_val_round(PRECISION, expression, Round::Down);
    let mut up = down.clone();
    if order != Ordering::Equal {
        up.next_up();
    }
    between(&down, &up)
}

/// The neighbours of a value between two numbers.
fn between(down: &Float, up: &Float) -> Option<(f64, f64)> {
    (!down.is_nan()).then(|| (down.to_f64_round(Round::Down), up.to_f64_round(Round::Up)))
}

impl Oracle for Mpfr {
    fn bracket(&mut self, op: Operation, args: &[f64]) -> Option<(f64, f64)> {
        let big = |i: usize| Float::with_val(53, args.get(i).copied().unwrap_or(0.0));
        let (x, y) = (args[0], args.get(1).copied().unwrap_or(0.0));
        let (a, b) = (big(0), big(1));
        match op {
            Neg => neighbours(-&a),
            Add => neighbours(&a + &b),
            Sub => neighbours(&a - &b),
            // 0 times an infinite end: 0, as all products of 0 and a member are.
            Mul if x == 0.0 || y == 0.0 => Some((0.0, 0.0)),
            Mul => neighbours(&a * &b),
            Div => neighbours(&a / &b),
            // An infinite end of the addend settles the sum.
            MulAdd if args[2].is_infinite() || x == 0.0 || y == 0.0 => Some((args[2], args[2])),
            MulAdd => neighbours(a.mul_add_ref(&b, &big(2))),
            Recip => neighbours(a.recip_ref()),
            Sqr => neighbours(a.square_ref()),
            Sqrt => neighbours(a.sqrt_ref()),
            Rsqrt => neighbours(a.recip_sqrt_ref()),
            Cbrt => neighbours(a.cbrt_ref()),
            Hypot => neighbours(a.hypot_ref(&b)),
            Abs => neighbours(a.abs_ref()),
            Min => neighbours(if a < b { &a } else { &b }),
            Max => neighbours(if a > b { &a } else { &b }),
            Sign => neighbours(match a.cmp0()? {
                Ordering::Less => -1,
                Ordering::Equal => 0,
                Ordering::Greater => 1,
            }),
            Floor => neighbours(a.floor_ref()),
            Ceil => neighbours(a.ceil_ref()),
            Round => neighbours(a.round_ref()),
            RoundTiesEven => neighbours(a.round_even_ref()),
            Trunc => neighbours(a.trunc_ref()),
            Modulo => {
                let (x, y) = (Rational::from_f64(x)?, Rational::from_f64(y)?);
                let turns = Rational::from(&x / &y).floor();
                neighbours(&(x - turns * y))
            }
            Pow => neighbours((&a).pow(&b)),
            Exp => neighbours(a.exp_ref()),
            Exp2 => neighbours(a.exp2_ref()),
            Exp10 => neighbours(a.exp10_ref()),
            Expm1 => neighbours(a.exp_m1_ref()),
            Exp2m1 => neighbours(a.exp2_m1_ref()),
            Exp10m1 => neighbours(a.exp10_m1_ref()),
            Ln => neighbours(a.ln_ref()),
            Log2 => neighbours(a.log2_ref()),
            Log10 => neighbours(a.log10_ref()),
            Log1p => neighbours(a.ln_1p_ref()),
            Log2p1 => neighbours(a.log2_1p_ref()),
            Log10p1 => neighbours(a.log10_1p_ref()),
            Sin => neighbours(a.sin_ref()),
            Cos => neighbours(a.cos_ref()),
            Tan => neighbours(a.tan_ref()),
            Asin => neighbours(a.asin_ref()),
            Acos => neighbours(a.acos_ref()),
            Atan => neighbours(a.atan_ref()),
            Atan2 => neighbours(a.atan2_ref(&b)),
            Sinh => neighbours(a.sinh_ref()),
            Cosh => neighbours(a.cosh_ref()),
            Tanh => neighbours(a.tanh_ref()),
            Asinh => neighbours(a.asinh_ref()),
            Acosh => neighbours(a.acosh_ref()),
            Atanh => neighbours(a.atanh_ref()),
            PowInt(n) => neighbours((&a).pow(n)),
            Rootn(n) => self.bracket(root(n), args),
            PowRatio(p, q) => {
                // x^|p| is exact with 53 |p| bits, and 1/t decreases on either side of 0.
                let power = Float::with_val(53 * p.unsigned_abs(), (&a).pow(p.unsigned_abs()));
                let [down, up] =
                    [Round::Down, Round::Up].map(|round| Float::with_val_round(PRECISION, power.root_ref(q), round).0);
                if p > 0 {
                    return between(&down, &up);
                }
                let recip = |x: Float, round: Round| Float::with_val_round(PRECISION, x.recip_ref(), round).0;
                between(&recip(up, Round::Down), &recip(down, Round::Up))
            }
        }
    }

    fn quarters(&mut self, lo: f64, hi: f64) -> (u32, u32) {
        let floor = |x: f64| {
            let turns = Float::with_val(QUARTER_BITS, x) * 2u32 / Float::with_val(QUARTER_BITS, Constant::Pi);
            turns.floor().to_integer().expect("a finite number")
        };
        let (first, last) = (floor(lo), floor(hi));
        let crossed = Integer::from(&last - &first).to_u32().expect("ends in order");
        (first.mod_u(4), crossed)
    }
}
