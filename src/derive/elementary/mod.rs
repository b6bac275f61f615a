//! Elementary functions as straight-line lane code: no branch, no call, no table look-up.
//!
//! **How an enclosure is made.** A core computes a function at a point as an [`Approx`]: two lanes whose exact sum
//! misses the value by at most a stated error. Monotone functions are enclosed by the cores at the ends; each end adds
//! tail and error first and rounds the sum with the head once, upward. So a result's end is off by the core's error and
//! one rounding.
//!
//! **Errors.** epsilon is 2^-52 (double) or 2^-23 (single): one operation errs by at most epsilon relative to its
//! result *in every rounding mode*, and every core's bound holds in every mode, for either sign. A bound is the
//! certified approximation error of its polynomial (`tables`) plus a running error analysis of the operations as
//! written; `tests/elementary/rounding.py` makes that analysis, cell by cell over the reduced argument, and each bound
//! names its section there. Bounds are stated with a margin of at least 5 % over the analysis.
//!
//! **Underflow.** Where a head is the argument itself, x + d with a correction d smaller than an ulp, d may underflow.
//! Programs that prove something round up: then a computed d has the sign of the true one and at most the smallest
//! number u too much, so x + d rounds to x, or to the number above x where the correction is positive, and E |x| > 0
//! moves either end by a further u at least. If the true correction is positive, the lower end is at most x; if it is
//! negative, the computed d is -0 and the lower end at most x - u. Cores whose correction is a difference or a quotient
//! (log1p and what is made of it, tanh) take the argument itself where the correction cannot count.

mod exp;
mod hyperbolic;
mod inverse_trig;
mod log;
mod power;
mod root;
mod tables;
mod trig;

use crate::derive::Precision;
use crate::derive::ends::Applied;
use crate::derive::ends::Ends;
use crate::derive::lanes::Builder;
use crate::derive::lanes::Lane;
use crate::derive::lanes::LaneOp;
use crate::derive::lanes::Mask;
use crate::graph::Op;

use tables::Constant;
use tables::Polynomial;

/// The natural extension of one elementary operation on the ends of its operands.
///
/// # Panics
/// If `op` is none of the elementary operations.
pub fn apply(b: &mut Builder, op: Op, operands: &[Ends]) -> Applied {
    let x = operands[0];
    match op {
        Op::Exp => exp::apply(b, exp::Base::E, x),
        Op::Exp2 => exp::apply(b, exp::Base::Two, x),
        Op::Exp10 => exp::apply(b, exp::Base::Ten, x),
        Op::Expm1 => exp::expm1(b, x),
        Op::Ln => log::apply(b, log::Base::E, x),
        Op::Log2 => log::apply(b, log::Base::Two, x),
        Op::Log10 => log::apply(b, log::Base::Ten, x),
        Op::Log1p => log::log1p(b, x),
        Op::Sin => trig::wave(b, trig::Wave::Sine, x),
        Op::Cos => trig::wave(b, trig::Wave::Cosine, x),
        Op::Tan => trig::tan(b, x),
        Op::Asin => inverse_trig::asin(b, x),
        Op::Acos => inverse_trig::acos(b, x),
        Op::Atan => inverse_trig::atan(b, x),
        Op::Atan2 => inverse_trig::atan2(b, x, operands[1]),
        Op::Sinh => hyperbolic::sinh(b, x),
        Op::Cosh => hyperbolic::cosh(b, x),
        Op::Tanh => hyperbolic::tanh(b, x),
        Op::Asinh => hyperbolic::asinh(b, x),
        Op::Acosh => hyperbolic::acosh(b, x),
        Op::Atanh => hyperbolic::atanh(b, x),
        Op::Cbrt => root::cbrt(b, x),
        Op::PowRatio(p, q) => root::power_ratio(b, x, p, q),
        Op::Pow => power::apply(b, x, operands[1]),
        _ => unreachable!("{} is no elementary operation", op.name()),
    }
}

/// One elementary operation at points: near the value by a few ulp (for sine, cosine and tangent up to the argument
/// that [`trig`] reduces).
///
/// # Panics
/// If `op` is none of the elementary operations.
pub fn point(b: &mut Builder, op: Op, operands: &[Lane]) -> Lane {
    let x = operands[0];
    match op {
        Op::Exp => exp::point(b, exp::Base::E, x),
        Op::Exp2 => exp::point(b, exp::Base::Two, x),
        Op::Exp10 => exp::point(b, exp::Base::Ten, x),
        Op::Expm1 => exp::expm1_point(b, x),
        Op::Ln => log::point(b, log::Base::E, x),
        Op::Log2 => log::point(b, log::Base::Two, x),
        Op::Log10 => log::point(b, log::Base::Ten, x),
        Op::Log1p => log::log1p_point(b, x),
        Op::Sin => trig::wave_point(b, trig::Wave::Sine, x),
        Op::Cos => trig::wave_point(b, trig::Wave::Cosine, x),
        Op::Tan => trig::tan_point(b, x),
        Op::Asin => inverse_trig::asin_point(b, x),
        Op::Acos => inverse_trig::acos_point(b, x),
        Op::Atan => inverse_trig::atan_point(b, x),
        Op::Atan2 => inverse_trig::atan2_point(b, x, operands[1]),
        Op::Sinh => hyperbolic::sinh_point(b, x),
        Op::Cosh => hyperbolic::cosh_point(b, x),
        Op::Tanh => hyperbolic::tanh_point(b, x),
        Op::Asinh => hyperbolic::asinh_point(b, x),
        Op::Acosh => hyperbolic::acosh_point(b, x),
        Op::Atanh => hyperbolic::atanh_point(b, x),
        Op::Cbrt => root::cbrt_point(b, x),
        Op::PowRatio(p, q) => root::power_ratio_point(b, x, p, q),
        Op::Pow => power::point(b, x, operands[1]),
        _ => unreachable!("{} is no elementary operation", op.name()),
    }
}

/// What the cores need to know of a floating-point format.
struct Format {
    /// Bits of the stored fraction.
    fraction: u8,
    /// The place of the sign bit.
    top: u8,
    /// Exponent bias.
    bias: u64,
    /// 2^-fraction: bounds the relative error of one operation in any rounding mode.
    epsilon: f64,
    /// The largest finite number.
    max: f64,
    /// The smallest normal number.
    min_normal: f64,
    /// 1.5 2^fraction: added to an integer, it leaves the integer in the low bits of the fraction, exactly.
    magic: f64,
}

static SINGLE: Format = Format {
    fraction: 23,
    top: 31,
    bias: 127,
    epsilon: f32::EPSILON as f64,
    max: f32::MAX as f64,
    min_normal: f32::MIN_POSITIVE as f64,
    magic: 12_582_912.0,
};

static DOUBLE: Format = Format {
    fraction: 52,
    top: 63,
    bias: 1023,
    epsilon: f64::EPSILON,
    max: f64::MAX,
    min_normal: f64::MIN_POSITIVE,
    magic: 6_755_399_441_055_744.0,
};

/// A real number known to be `head + tail` (their exact sum) up to an error of `factor scale >= 0`.
#[derive(Debug, Clone, Copy)]
struct Approx {
    head: Lane,
    tail: Lane,
    factor: Lane,
    scale: Lane,
}

impl Approx {
    /// A number computed with a relative error of `epsilons` epsilon at most; `magnitude` is its absolute value, or more.
    fn of(b: &mut Builder, value: Lane, epsilons: f64, magnitude: Lane) -> Approx {
        Approx { head: b.zero(), tail: value, factor: b.epsilons(epsilons), scale: magnitude }
    }

    /// The value itself.
    fn value(self, b: &mut Builder) -> Lane {
        b.add(self.head, self.tail)
    }

    /// An upper bound.
    fn upper(self, b: &mut Builder) -> Lane {
        let above = b.fma(self.scale, self.factor, self.tail);
        b.add(self.head, above)
    }

    /// A lower bound, negated.
    fn negated_lower(self, b: &mut Builder) -> Lane {
        let tail = b.neg(self.tail);
        let below = b.fma(self.scale, self.factor, tail);
        b.sub(below, self.head)
    }

    /// The number times the sign of `x`.
    fn with_sign_of(self, b: &mut Builder, x: Lane) -> Approx {
        let sign = b.sign_bit(x);
        let head = if b.as_number(self.head) == Some(0.0) { self.head } else { b.add_to_bits(self.head, sign) };
        Approx { head, tail: b.add_to_bits(self.tail, sign), ..self }
    }
}

/// Encloses an increasing function.
fn increasing(b: &mut Builder, x: Ends, mut f: impl FnMut(&mut Builder, Lane) -> Approx) -> Ends {
    let low = b.low(x);
    let (above, below) = (f(b, x.hi), f(b, low));
    Ends { nlo: below.negated_lower(b), hi: above.upper(b) }
}

/// Encloses an increasing odd function: its negated lower end is its upper bound at the negated argument.
fn increasing_odd(b: &mut Builder, x: Ends, mut f: impl FnMut(&mut Builder, Lane) -> Approx) -> Ends {
    let (above, below) = (f(b, x.hi), f(b, x.nlo));
    Ends { nlo: below.upper(b), hi: above.upper(b) }
}

impl Builder {
    fn format(&self) -> &'static Format {
        match self.precision() {
            Precision::Single => &SINGLE,
            Precision::Double => &DOUBLE,
        }
    }

    /// One of two numbers, by the precision.
    pub fn by_precision(&mut self, single: f64, double: f64) -> Lane {
        match self.precision() {
            Precision::Single => self.number(single),
            Precision::Double => self.number(double),
        }
    }

    /// `count` epsilon. Counts are multiples of 1/64.
    pub fn epsilons(&mut self, count: f64) -> Lane {
        let epsilon = self.format().epsilon;
        self.number(count * epsilon)
    }

    /// The parts of a constant, largest first.
    fn parts<const N: usize>(&mut self, constant: &Constant) -> [Lane; N] {
        std::array::from_fn(|i| self.by_precision(constant.single[i].into(), constant.double[i]))
    }

    fn coefficient(&mut self, polynomial: &Polynomial, i: usize) -> Lane {
        match self.precision() {
            Precision::Single => self.number(polynomial.single[i].into()),
            Precision::Double => self.number(polynomial.double[i]),
        }
    }

    /// The polynomial at `x`, by Horner's rule.
    fn polynomial(&mut self, polynomial: &Polynomial, x: Lane) -> Lane {
        let terms = match self.precision() {
            Precision::Single => polynomial.single.len(),
            Precision::Double => polynomial.double.len(),
        };
        let mut value = self.coefficient(polynomial, terms - 1);
        for i in (0..terms - 1).rev() {
            let c = self.coefficient(polynomial, i);
            value = self.fma(value, x, c);
        }
        value
    }

    /// The integer `n + offset` in the low bits of the result; `n` is an integer of magnitude below 2^20.
    fn integer_bits(&mut self, n: Lane, offset: f64) -> Lane {
        let magic = self.format().magic + offset;
        let magic = self.number(magic);
        let sum = self.add(n, magic);
        self.push(LaneOp::ToBits(sum))
    }

    /// 2^(n + offset), which must be a normal number, for an integer `n`.
    fn power_of_two(&mut self, n: Lane, offset: i32) -> Lane {
        let &Format { bias, fraction, .. } = self.format();
        let bits = self.integer_bits(n, f64::from(offset) + bias as f64);
        let shifted = self.push(LaneOp::ShiftLeft(bits, fraction));
        self.push(LaneOp::FromBits(shifted))
    }

    /// The sign bit alone.
    fn sign_bit(&mut self, x: Lane) -> Lane {
        let mask = self.sign_mask();
        let bits = self.push(LaneOp::ToBits(x));
        self.push(LaneOp::BitAnd(bits, mask))
    }

    fn sign_mask(&mut self) -> Lane {
        let top = self.format().top;
        self.bits(1 << top)
    }

    fn clamp(&mut self, x: Lane, lo: Lane, hi: Lane) -> Lane {
        let x = self.max(x, lo);
        self.min(x, hi)
    }

    /// Where a number >= 0 is so small that its square is below epsilon / 4 of it.
    fn negligible(&mut self, magnitude: Lane) -> Mask {
        let limit = self.epsilons(0.25);
        self.less(magnitude, limit)
    }

    /// An upper end that is at least `-max`, as every upper end must be; a negated lower end likewise.
    fn above_minus_max(&mut self, end: Lane) -> Lane {
        let max = self.format().max;
        let least = self.number(-max);
        self.max(end, least)
    }

    /// `value`, but +inf where `x` is +inf.
    fn unbounded_at_infinity(&mut self, x: Lane, value: Lane) -> Lane {
        let infinity = self.infinity();
        let at = self.equal(x, infinity);
        self.select(at, infinity, value)
    }

    /// `C + t` without loss, for 0 <= C, and |t| <= C or C = 0: the rounded sum and what it misses. The error of the
    /// second part is 2^-fraction relative to it in any rounding mode (Fast2Sum: Dekker 1971; Boldo, Graillat and
    /// Muller 2017 for directed rounding).
    fn fast_two_sum(&mut self, large: Lane, small: Lane) -> (Lane, Lane) {
        let sum = self.add(large, small);
        let used = self.sub(sum, large);
        (sum, self.sub(small, used))
    }
}
