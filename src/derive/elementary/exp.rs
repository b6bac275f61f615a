//! Exponentials: x = n ln 2 + r, e^x = 2^n (1 + s) with s = e^r - 1 by a polynomial.
//!
//! The reduction's first step is exact: for n != 0 both x and n L1 are multiples of 2^-fraction / 4 or more, and their
//! difference is below 1/2 (1/4 for base ten, where they are multiples of half of that), so it fits. The second step
//! rounds once. L1 + L2 misses less than n 2^-110 (single: n 2^-53) of the multiple, which the `scale` of the error counts.

use crate::derive::elementary::Approx;
use crate::derive::elementary::Format;
use crate::derive::elementary::tables;
use crate::derive::ends::Applied;
use crate::derive::ends::Ends;
use crate::derive::lanes::Builder;
use crate::derive::lanes::Lane;
use crate::derive::lanes::LaneOp;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Base {
    E,
    Two,
    Ten,
}

impl Base {
    /// The error of `s`, relative to |r|, in epsilon: sections "exp", "exp2" and "exp10".
    const fn error(self) -> f64 {
        match self {
            Base::E => 3.375,
            Base::Two => 1.875,
            Base::Ten => 9.6875,
        }
    }
}

/// base^x = 2^n (1 + s).
#[derive(Clone, Copy)]
pub struct Exponential {
    pub n: Lane,
    pub s: Lane,
    base: Base,
    r: Lane,
}

/// The exponential of a number between the ends of [`Base::range`].
pub fn exponential(b: &mut Builder, base: Base, x: Lane) -> Exponential {
    match base {
        Base::E => {
            let [per_octave] = b.parts(&tables::LOG2_E);
            let (n, r) = reduce(b, x, per_octave, &tables::LN_2);
            let s = minus_one(b, r);
            Exponential { n, s, base, r }
        }
        Base::Ten => {
            let [per_octave] = b.parts(&tables::LOG2_10);
            let (n, r) = reduce(b, x, per_octave, &tables::LOG10_2);
            let s = scaled_minus_one(b, r, &tables::LN_10);
            Exponential { n, s, base, r }
        }
        Base::Two => {
            let n = b.nearest(x);
            let r = b.sub(x, n);
            power_of_two(b, n, r)
        }
    }
}

/// 2^(n + r) for |r| <= 1/2.
pub fn power_of_two(b: &mut Builder, n: Lane, r: Lane) -> Exponential {
    let s = scaled_minus_one(b, r, &tables::LN_2);
    Exponential { n, s, base: Base::Two, r }
}

/// x = n L + r with |r| <= L/2 and a little.
fn reduce(b: &mut Builder, x: Lane, reciprocal: Lane, length: &tables::Constant) -> (Lane, Lane) {
    let quotient = b.mul(x, reciprocal);
    let n = b.nearest(quotient);
    let minus_n = b.neg(n);
    let [l1, l2] = b.parts(length);
    let r = b.fma(minus_n, l1, x);
    (n, b.fma(minus_n, l2, r))
}

/// e^r - 1 = r + r^2 q(r).
fn minus_one(b: &mut Builder, r: Lane) -> Lane {
    let q = b.polynomial(&tables::EXP, r);
    let square = b.mul(r, r);
    b.fma(square, q, r)
}

/// e^(L r) - 1 = L1 r + (L2 r + w^2 q(w)) with w = L r rounded.
fn scaled_minus_one(b: &mut Builder, r: Lane, factor: &tables::Constant) -> Lane {
    let [l1, l2] = b.parts(factor);
    let w = b.mul(r, l1);
    let q = b.polynomial(&tables::EXP, w);
    let square = b.mul(w, w);
    let curved = b.mul(square, q);
    let low = b.fma(r, l2, curved);
    b.fma(r, l1, low)
}

impl Base {
    /// Where the result neither overflows for sure nor underflows to less than half the smallest number, rounded
    /// outward; the powers of two taken apart below suffice for it.
    fn range(self, b: &mut Builder) -> (Lane, Lane) {
        match self {
            Base::E => (b.by_precision(-105.0, -746.0), b.by_precision(89.0, 710.0)),
            Base::Two => (b.by_precision(-151.0, -1076.0), b.by_precision(128.0, 1024.0)),
            Base::Ten => (b.by_precision(-45.5, -324.0), b.by_precision(38.625, 308.375)),
        }
    }
}

impl Exponential {
    /// 1 + s as an approximation.
    pub fn mantissa(self, b: &mut Builder) -> Approx {
        // Never so small that underflow or the reduction's absolute error could count, which is at most 2^-99.9
        // (single: 2^-45.5), below 2^-4 epsilon times the least scale.
        let least = b.by_precision(1.0 / (1u64 << 18) as f64, 1.0 / (1u64 << 40) as f64);
        let scale = b.abs(self.r);
        let scale = b.max(scale, least);
        Approx { head: b.number(1.0), tail: self.s, factor: b.epsilons(self.base.error()), scale }
    }

    /// 2^n v for |v| < 2, rounded once: exact where the result is normal.
    pub fn scale(self, b: &mut Builder, v: Lane) -> Lane {
        // 2^(n + 64) 2^-64 or 2^(n - 1) 2: the first factor is normal over the whole range of n.
        let &Format { bias, fraction, magic, .. } = b.format();
        let zero = b.zero();
        let down = b.less(self.n, zero);
        let (low_offset, high_offset) = (magic + (bias + 64) as f64, magic + (bias - 1) as f64);
        let (low_offset, high_offset) = (b.number(low_offset), b.number(high_offset));
        let (low_rest, high_rest) = (b.number(1.0 / (1u128 << 64) as f64), b.number(2.0));
        let offset = b.select(down, low_offset, high_offset);
        let rest = b.select(down, low_rest, high_rest);
        let sum = b.add(self.n, offset);
        let bits = b.push(LaneOp::ToBits(sum));
        let shifted = b.push(LaneOp::ShiftLeft(bits, fraction));
        let power = b.push(LaneOp::FromBits(shifted));
        let scaled = b.mul(v, power);
        b.mul(scaled, rest)
    }

    pub fn upper(self, b: &mut Builder) -> Lane {
        let v = self.mantissa(b).upper(b);
        self.scale(b, v)
    }

    pub fn negated_lower(self, b: &mut Builder) -> Lane {
        let v = self.mantissa(b).negated_lower(b);
        let scaled = self.scale(b, v);
        b.above_minus_max(scaled)
    }

    pub fn value(self, b: &mut Builder) -> Lane {
        let v = self.mantissa(b).value(b);
        self.scale(b, v)
    }
}

pub fn apply(b: &mut Builder, base: Base, x: Ends) -> Applied {
    let (least, greatest) = base.range(b);
    let low = b.low(x);
    let [low, high] = [low, x.hi].map(|end| {
        let end = b.clamp(end, least, greatest);
        exponential(b, base, end)
    });
    Ends { nlo: low.negated_lower(b), hi: high.upper(b) }.into()
}

pub fn point(b: &mut Builder, base: Base, x: Lane) -> Lane {
    let (least, greatest) = base.range(b);
    let x = b.clamp(x, least, greatest);
    exponential(b, base, x).value(b)
}

/// e^x - 1 = 2 (p s + (p - 1/2)) with p = 2^(n-1), for `s` or a bound of it; `negated`, 1 - e^x from -s. Rounds up
/// where the mode does.
pub fn shifted(b: &mut Builder, n: Lane, s: Lane, negated: bool) -> Lane {
    let p = b.power_of_two(n, -1);
    let half = b.number(0.5);
    let rest = if negated { b.sub(half, p) } else { b.sub(p, half) };
    let sum = b.fma(p, s, rest);
    let two = b.number(2.0);
    b.mul(sum, two)
}

/// The arguments beyond which e^x - 1 overflows, or is -1 up to less than half an ulp.
fn expm1_range(b: &mut Builder) -> (Lane, Lane) {
    (b.by_precision(-20.0, -40.0), b.by_precision(89.0, 710.0))
}

pub fn expm1(b: &mut Builder, x: Ends) -> Applied {
    let (least, greatest) = expm1_range(b);
    let low = b.low(x);
    let [low, high] = [low, x.hi].map(|end| {
        let end = b.clamp(end, least, greatest);
        exponential(b, Base::E, end)
    });
    let factor = b.epsilons(Base::E.error());
    // Near 0 the error must stay relative. Where n = 0 nothing was reduced, else the reduction's error is n 2^-110
    // (single: n 2^-53).
    let missed = b.by_precision(1.0 / (1u64 << 31) as f64, 1.0 / (1u64 << 58) as f64);
    let [low_scale, high_scale] = [low, high].map(|end| {
        let octaves = b.abs(end.n);
        let magnitude = b.abs(end.r);
        b.fma(octaves, missed, magnitude)
    });
    let above = b.fma(high_scale, factor, high.s);
    let hi = shifted(b, high.n, above, false);
    let minus_s = b.neg(low.s);
    let below = b.fma(low_scale, factor, minus_s);
    let nlo = shifted(b, low.n, below, true);
    // Nothing is below -1, and the lower end stays finite.
    let one = b.number(1.0);
    let nlo = b.min(nlo, one);
    Ends { nlo: b.above_minus_max(nlo), hi }.into()
}

pub fn expm1_point(b: &mut Builder, x: Lane) -> Lane {
    let (least, greatest) = expm1_range(b);
    let x = b.clamp(x, least, greatest);
    let Exponential { n, s, .. } = exponential(b, Base::E, x);
    shifted(b, n, s, false)
}
