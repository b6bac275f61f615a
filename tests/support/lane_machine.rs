//! A machine for lane programs, one lane at a time, in any rounding mode: what compiled kernels must equal bit for bit,
//! and what shows that an error bound holds in modes in which no kernel runs.
//!
//! Every rounded operation is computed to nearest; the exact sign of what is left says whether the directed result is
//! the neighbour. That sign comes from error-free transformations (Dekker 1971, Shewchuk 1997) or, where they could
//! underflow or overflow, from big integers.

use std::cmp::Ordering;

use imp::derive::LaneProgram;
use imp::derive::Precision;
use imp::derive::lanes::Lane;
use imp::derive::lanes::LaneOp;
use num_bigint::BigInt;
use num_bigint::Sign;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    Nearest,
    Up,
    Down,
}

/// Runs a program on one lane: bits in, bits out, those of an `f32` in the low half.
pub fn run(program: &LaneProgram, inputs: &[u64], uniforms: &[u64], mode: Mode) -> Vec<u64> {
    match program.precision {
        Precision::Single => execute::<f32>(program, inputs, uniforms, mode),
        Precision::Double => execute::<f64>(program, inputs, uniforms, mode),
    }
}

/// A floating-point format.
pub trait Number: Copy + PartialOrd {
    const WIDTH: u32;
    fn from_word(word: u64) -> Self;
    fn word(self) -> u64;
    fn as_f64(self) -> f64;
    fn next_up(self) -> Self;
    fn next_down(self) -> Self;
    fn negated(self) -> Self;
    /// a + b, a b, a / b, sqrt a, a b + c, to nearest.
    fn nearest_sum(a: Self, b: Self) -> Self;
    fn nearest_product(a: Self, b: Self) -> Self;
    fn nearest_quotient(a: Self, b: Self) -> Self;
    fn nearest_root(a: Self) -> Self;
    fn nearest_fused(a: Self, b: Self, c: Self) -> Self;
    fn whole(self, op: LaneOp) -> Self;
}

macro_rules! number {
    ($float:ty, $word:ty) => {
        impl Number for $float {
            const WIDTH: u32 = <$word>::BITS;
            fn from_word(word: u64) -> Self {
                <$float>::from_bits(word as $word)
            }
            fn word(self) -> u64 {
                self.to_bits().into()
            }
            fn as_f64(self) -> f64 {
                self.into()
            }
            fn next_up(self) -> Self {
                <$float>::next_up(self)
            }
            fn next_down(self) -> Self {
                <$float>::next_down(self)
            }
            fn negated(self) -> Self {
                -self
            }
            fn nearest_sum(a: Self, b: Self) -> Self {
                a + b
            }
            fn nearest_product(a: Self, b: Self) -> Self {
                a * b
            }
            fn nearest_quotient(a: Self, b: Self) -> Self {
                a / b
            }
            fn nearest_root(a: Self) -> Self {
                a.sqrt()
            }
            fn nearest_fused(a: Self, b: Self, c: Self) -> Self {
                a.mul_add(b, c)
            }
            fn whole(self, op: LaneOp) -> Self {
                match op {
                    LaneOp::Floor(_) => self.floor(),
                    LaneOp::Ceil(_) => self.ceil(),
                    LaneOp::Trunc(_) => self.trunc(),
                    _ => self.round_ties_even(),
                }
            }
        }
    };
}

number!(f32, u32);
number!(f64, u64);

/// The sign of a sum of numbers, exactly: grows an expansion whose components do not overlap, so that the last nonzero
/// one outweighs the others together.
fn sign_of_sum(terms: &[f64]) -> Ordering {
    let mut expansion: Vec<f64> = Vec::with_capacity(terms.len());
    for &term in terms {
        let mut carry = term;
        for part in &mut expansion {
            let sum = carry + *part;
            let back = sum - carry;
            *part = (carry - (sum - back)) + (*part - back);
            carry = sum;
        }
        expansion.push(carry);
    }
    let leading = expansion.iter().rev().find(|part| **part != 0.0).copied().unwrap_or(0.0);
    leading.partial_cmp(&0.0).expect("a sum of numbers")
}

/// A finite number as a significand times a power of two.
fn dyadic(x: f64) -> (BigInt, i64) {
    let bits = x.to_bits();
    let (exponent, fraction) = ((bits >> 52) as i64 & 0x7ff, bits & ((1 << 52) - 1));
    let (significand, power) = if exponent == 0 { (fraction, -1074) } else { (fraction | 1 << 52, exponent - 1075) };
    let significand = BigInt::from(significand);
    (if x.is_sign_negative() { -significand } else { significand }, power)
}

/// The sign of a b + c - d for finite numbers.
fn sign_of_fused(a: f64, b: f64, c: f64, d: f64) -> Ordering {
    let product = a * b;
    let safe = |x: f64| x == 0.0 || (2f64.powi(-900)..2f64.powi(1000)).contains(&x.abs());
    let exact_zero = a == 0.0 || b == 0.0;
    if (exact_zero || (product != 0.0 && safe(product))) && [c, d].iter().all(|x| x.abs() < 2f64.powi(1000)) {
        return sign_of_sum(&[a.mul_add(b, -product), product, c, -d]);
    }
    let ((ma, ea), (mb, eb)) = (dyadic(a), dyadic(b));
    let terms = [(ma * mb, ea + eb), dyadic(c), dyadic(-d)];
    let least = terms.iter().map(|term| term.1).min().expect("three terms");
    let sum: BigInt = terms.iter().map(|(m, e)| m << (e - least) as usize).sum();
    match sum.sign() {
        Sign::Minus => Ordering::Less,
        Sign::NoSign => Ordering::Equal,
        Sign::Plus => Ordering::Greater,
    }
}

/// The directed result beside a nearest one, given the sign of what the latter misses.
fn settle<N: Number>(nearest: N, missed: Ordering, mode: Mode) -> N {
    match (mode, missed) {
        (Mode::Up, Ordering::Greater) => nearest.next_up(),
        (Mode::Down, Ordering::Less) => nearest.next_down(),
        _ => nearest,
    }
}

/// a b + c of finite or other numbers, `nearest` being it rounded to nearest.
fn fused<N: Number>(nearest: N, [a, b, c]: [f64; 3], mode: Mode) -> N {
    let r = nearest.as_f64();
    if r.is_nan() || [a, b, c].iter().any(|x| x.is_infinite()) {
        return nearest;
    }
    if r.is_infinite() {
        // Past the largest number, which lies between it and the exact result.
        return settle(nearest, 0.0f64.partial_cmp(&r).expect("ordered"), mode);
    }
    let missed = sign_of_fused(a, b, c, r);
    if r == 0.0 && missed == Ordering::Equal && mode == Mode::Down {
        // An exact zero of terms with opposite signs is -0 when rounding down.
        let product_negative = a.is_sign_negative() != b.is_sign_negative();
        return if product_negative != c.is_sign_negative() { minus_zero() } else { nearest };
    }
    settle(nearest, missed, mode)
}

fn minus_zero<N: Number>() -> N {
    N::from_word(1 << (N::WIDTH - 1))
}

fn add<N: Number>(a: N, b: N, mode: Mode) -> N {
    fused(N::nearest_sum(a, b), [a.as_f64(), 1.0, b.as_f64()], mode)
}

fn multiply<N: Number>(a: N, b: N, mode: Mode) -> N {
    let nearest = N::nearest_product(a, b);
    if nearest.as_f64() == 0.0 && (a.as_f64() == 0.0 || b.as_f64() == 0.0) {
        return nearest;
    }
    // The zero added has the product's sign, so that no zero changes its own.
    let zero = if a.as_f64().is_sign_negative() != b.as_f64().is_sign_negative() { -0.0 } else { 0.0 };
    fused(nearest, [a.as_f64(), b.as_f64(), zero], mode)
}

fn divide<N: Number>(a: N, b: N, mode: Mode) -> N {
    let nearest = N::nearest_quotient(a, b);
    let (x, y, q) = (a.as_f64(), b.as_f64(), nearest.as_f64());
    if q.is_nan() || x.is_infinite() || y.is_infinite() || x == 0.0 || y == 0.0 {
        return nearest;
    }
    if q.is_infinite() {
        return settle(nearest, 0.0f64.partial_cmp(&q).expect("ordered"), mode);
    }
    // a/b - q has the sign of (a - q b) b.
    let missed = sign_of_fused(-q, y, x, 0.0);
    settle(nearest, if y < 0.0 { missed.reverse() } else { missed }, mode)
}

fn root<N: Number>(a: N, mode: Mode) -> N {
    let nearest = N::nearest_root(a);
    let (x, r) = (a.as_f64(), nearest.as_f64());
    if r.is_nan() || r.is_infinite() || r == 0.0 {
        return nearest;
    }
    settle(nearest, sign_of_fused(-r, r, x, 0.0), mode)
}

fn execute<N: Number>(program: &LaneProgram, inputs: &[u64], uniforms: &[u64], mode: Mode) -> Vec<u64> {
    use LaneOp::*;
    let all = u64::MAX >> (64 - N::WIDTH);
    let sign = 1u64 << (N::WIDTH - 1);
    let mut words: Vec<u64> = Vec::with_capacity(program.ops.len());
    for &op in &program.ops {
        let word = |lane: Lane| words[lane.index()];
        let number = |lane: Lane| N::from_word(words[lane.index()]);
        let mask = |holds: bool| if holds { all } else { 0 };
        let result = match op {
            Input(slot) => inputs[slot as usize],
            Uniform(slot) => uniforms[slot as usize],
            Const(bits) | Bits(bits) => bits & all,
            Add(a, b) => add(number(a), number(b), mode).word(),
            Sub(a, b) => add(number(a), number(b).negated(), mode).word(),
            Mul(a, b) => multiply(number(a), number(b), mode).word(),
            Div(a, b) => divide(number(a), number(b), mode).word(),
            Sqrt(a) => root(number(a), mode).word(),
            Fma(a, b, c) => {
                let (a, b, c) = (number(a), number(b), number(c));
                fused(N::nearest_fused(a, b, c), [a.as_f64(), b.as_f64(), c.as_f64()], mode).word()
            }
            Neg(a) => word(a) ^ sign,
            Abs(a) => word(a) & !sign & all,
            Min(a, b) => {
                if number(a) < number(b) {
                    word(a)
                } else {
                    word(b)
                }
            }
            Max(a, b) => {
                if number(b) < number(a) {
                    word(a)
                } else {
                    word(b)
                }
            }
            Floor(a) | Ceil(a) | Trunc(a) | LaneOp::Nearest(a) => number(a).whole(op).word(),
            Less(a, b) => mask(number(a) < number(b)),
            LessEqual(a, b) => mask(number(a) <= number(b)),
            Equal(a, b) => mask(number(a) == number(b)),
            MaskAnd(a, b) | BitAnd(a, b) => word(a) & word(b),
            MaskOr(a, b) | BitOr(a, b) => word(a) | word(b),
            MaskNot(a) => !word(a) & all,
            Select(m, a, b) => {
                if word(m) != 0 {
                    word(a)
                } else {
                    word(b)
                }
            }
            ToBits(a) | FromBits(a) | MaskBits(a) => word(a),
            IntAdd(a, b) => word(a).wrapping_add(word(b)) & all,
            IntSub(a, b) => word(a).wrapping_sub(word(b)) & all,
            ShiftLeft(a, n) => word(a) << n & all,
            ShiftRight(a, n) => word(a) >> n,
        };
        words.push(result);
    }
    program.outputs.iter().map(|lane| words[lane.index()]).collect()
}
