//! Logarithms: x = 2^k m with m in [sqrt 1/2, sqrt 2), f = m - 1 exactly, and with s = f / (2 + f)
//! ln m = f - (f^2/2 - s (f^2/2 + R(s^2))), the arrangement of fdlibm's `log` (Sun Microsystems 1993): near 1 the head
//! is f itself, so the error stays relative to the result.

use crate::derive::elementary::Approx;
use crate::derive::elementary::Format;
use crate::derive::elementary::increasing;
use crate::derive::elementary::tables;
use crate::derive::ends::Applied;
use crate::derive::ends::Ends;
use crate::derive::lanes::Builder;
use crate::derive::lanes::Lane;
use crate::derive::lanes::LaneOp;

/// The error of log1p, whose argument 1 + x carries the rounding of the sum along: section "log1p".
const LOG1P_ERROR: Error = Error { relative: 1.75, absolute: 0.48 };

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Base {
    E,
    Two,
    Ten,
}

/// The error of a logarithm in epsilon is below `relative` |head| and, however large the head, below `absolute`.
#[derive(Clone, Copy)]
struct Error {
    relative: f64,
    absolute: f64,
}

impl Base {
    /// Sections "ln", "log2" and "log10".
    const fn error(self) -> Error {
        match self {
            Base::E => Error { relative: 1.1875, absolute: 0.34 },
            Base::Two => Error { relative: 1.1875, absolute: 0.48 },
            Base::Ten => Error { relative: 1.4375, absolute: 0.18 },
        }
    }
}

impl Base {
    /// Factor and cap of the error of a multiple of the logarithm in two parts: in units of the multiple up to the cap
    /// times the multiplier. The second parts lose some epsilon^2.
    pub fn product_error(self, b: &mut Builder) -> (Lane, Lane) {
        let Error { relative, absolute } = self.error();
        let error = Error { relative: relative + 1.0 / 64.0, absolute: absolute + 1.0 / 64.0 };
        (b.epsilons(error.relative), error.cap(b))
    }
}

impl Error {
    /// The error of ln(1 + w) for w >= 0 with an argument whose relative error is so many epsilon. What that adds is
    /// w / (1 + w) of it, at most 1 and at most the logarithm.
    fn with_argument(self, epsilons: f64) -> Error {
        Error { relative: self.relative + epsilons, absolute: self.absolute + epsilons }
    }

    /// Factor and scale of the bound, the cap on the scale rounded up.
    fn bound(self, b: &mut Builder, head: Lane) -> (Lane, Lane) {
        let factor = b.epsilons(self.relative);
        let cap = self.cap(b);
        let magnitude = b.abs(head);
        (factor, b.min(magnitude, cap))
    }

    fn cap(self, b: &mut Builder) -> Lane {
        b.number((self.absolute / self.relative * 64.0).ceil() / 64.0)
    }
}

/// A positive number taken apart: 2^k m.
#[derive(Clone, Copy)]
pub struct Parts {
    pub k: Lane,
    pub m: Lane,
    /// k + bias, in the place of an exponent.
    exponent: Lane,
}

/// Takes apart a number > 0; `subnormals` where it may be one. Zeros and infinities give finite garbage.
pub fn split(b: &mut Builder, x: Lane, subnormals: bool) -> Parts {
    let &Format { bias, fraction, min_normal, magic, .. } = b.format();
    // 2^fraction, above which the fraction field counts in units.
    let unit = magic / 1.5;
    let mut base = b.number(unit + bias as f64);
    let mut x = x;
    if subnormals {
        let least = b.number(min_normal);
        let small = b.less(x, least);
        let lift = 2 * u64::from(fraction / 2) + 2;
        let factor = b.number((1u64 << lift) as f64);
        let lifted = b.mul(x, factor);
        x = b.select(small, lifted, x);
        let lifted_base = b.number(unit + (bias + lift) as f64);
        base = b.select(small, lifted_base, base);
    }
    // sqrt 1/2 rounded, so that adding the rest to 1 carries into the exponent exactly where m reaches sqrt 2.
    let (root, one, unit_bits) = match fraction {
        23 => (u64::from(std::f32::consts::FRAC_1_SQRT_2.to_bits()), bias << 23, u64::from((unit as f32).to_bits())),
        _ => (std::f64::consts::FRAC_1_SQRT_2.to_bits(), bias << 52, unit.to_bits()),
    };
    let bits = b.push(LaneOp::ToBits(x));
    let offset = b.bits(one - root);
    let moved = b.push(LaneOp::IntAdd(bits, offset));
    let fraction_mask = b.bits((1 << fraction) - 1);
    let low = b.push(LaneOp::BitAnd(moved, fraction_mask));
    let root = b.bits(root);
    let m = b.push(LaneOp::IntAdd(low, root));
    let m = b.push(LaneOp::FromBits(m));
    let shifted = b.push(LaneOp::ShiftRight(moved, fraction));
    let unit_bits = b.bits(unit_bits);
    let k = b.push(LaneOp::BitOr(shifted, unit_bits));
    let k = b.push(LaneOp::FromBits(k));
    let k = b.sub(k, base);
    let exponent = b.push(LaneOp::ShiftLeft(shifted, fraction));
    Parts { k, m, exponent }
}

/// ln(1 + f) - f for 1 + f in [sqrt 1/2, sqrt 2] and a little.
fn curved(b: &mut Builder, f: Lane) -> Lane {
    let (two, half) = (b.number(2.0), b.number(0.5));
    let denominator = b.add(f, two);
    let s = b.div(f, denominator);
    let z = b.mul(s, s);
    let half_f = b.mul(f, half);
    let half_square = b.mul(half_f, f);
    let p = b.polynomial(&tables::LN, z);
    let inner = b.fma(z, p, half_square);
    let t = b.mul(s, inner);
    let minus_half_f = b.neg(half_f);
    b.fma(minus_half_f, f, t)
}

/// log(2^k (1 + f)) with the given relative error, where `rest` = ln(1 + f) - f.
fn combine(b: &mut Builder, base: Base, k: Lane, f: Lane, rest: Lane, error: Error) -> Approx {
    let (head, tail) = match base {
        Base::E => {
            // k L1 is exact, the sum with f is taken apart without loss.
            let [l1, l2] = b.parts(&tables::LN_2_SHORT);
            let multiple = b.mul(k, l1);
            let (head, low) = b.fast_two_sum(multiple, f);
            let tail = b.fma(k, l2, rest);
            (head, b.add(low, tail))
        }
        Base::Two => {
            let (product, tail) = scaled(b, f, rest, &tables::LOG2_E);
            let (head, low) = b.fast_two_sum(k, product);
            (head, b.add(low, tail))
        }
        Base::Ten => {
            let (product, tail) = scaled(b, f, rest, &tables::LOG10_E);
            let [l1, l2] = b.parts(&tables::LOG10_2_SHORT);
            let multiple = b.mul(k, l1);
            let (head, low) = b.fast_two_sum(multiple, product);
            let tail = b.fma(k, l2, tail);
            (head, b.add(low, tail))
        }
    };
    let (factor, scale) = error.bound(b, head);
    Approx { head, tail, factor, scale }
}

/// C (f + rest) as a rounded product and what is left: C1 f + (C1 rest + (C2 f + the product's error)).
fn scaled(b: &mut Builder, f: Lane, rest: Lane, factor: &tables::Constant) -> (Lane, Lane) {
    let [c1, c2] = b.parts(factor);
    let product = b.mul(f, c1);
    let minus = b.neg(product);
    let error = b.fma(f, c1, minus);
    let low = b.fma(f, c2, error);
    (product, b.fma(rest, c1, low))
}

/// The logarithm of a number > 0.
pub fn logarithm(b: &mut Builder, base: Base, x: Lane) -> Approx {
    let Parts { k, m, .. } = split(b, x, true);
    let one = b.number(1.0);
    let f = b.sub(m, one);
    let rest = curved(b, f);
    combine(b, base, k, f, rest, base.error())
}

/// ln(1 + w) + j ln 2 for w > -1 and an integer j, 0 where w is small. `more_epsilons` is what the argument's own relative error adds.
pub fn log1p_core(b: &mut Builder, w: Lane, j: Option<Lane>, more_epsilons: f64) -> Approx {
    let &Format { bias, fraction, .. } = b.format();
    let (zero, one) = (b.zero(), b.number(1.0));
    // 1 + w = u + c. The 1 counts for nothing, and might overflow, beyond 2^60 (single: 2^30): it is less than
    // 2^-8 epsilon there, and the logarithm above 20.
    let limit = b.by_precision((1u64 << 30) as f64, (1u64 << 60) as f64);
    let huge = b.less(limit, w);
    let (large, small) = (b.max(w, one), b.min(w, one));
    let small = b.select(huge, zero, small);
    let (u, c) = b.fast_two_sum(large, small);
    let Parts { k, m, exponent } = split(b, u, false);
    // ln(1 + w) = k ln 2 + ln(m + c 2^-k), and the last is ln m + c 2^-k / m up to a relative epsilon of that term.
    // 2^(1-k) instead of 2^-k: a number for all k; at its end, k = 1 + bias, it is 0, where the term is nothing.
    let turn = b.bits((2 * bias + 1) << fraction);
    let power = b.push(LaneOp::IntSub(turn, exponent));
    let power = b.push(LaneOp::FromBits(power));
    let lost = b.mul(c, power);
    let f = b.sub(m, one);
    // Half of 1/m.
    let [r0, r1] = tables::RECIPROCAL.map(|r| b.number(f64::from(r) / 2.0));
    let weight = b.fma(f, r1, r0);
    let lost = b.mul(lost, weight);
    // Without an exponent, the argument itself is the better f.
    let plain = b.equal(k, zero);
    let f = b.select(plain, w, f);
    let lost = b.select(plain, zero, lost);
    let rest = curved(b, f);
    let rest = b.add(rest, lost);
    let k = j.map_or(k, |j| b.add(k, j));
    // Next to 0 the correction is less than epsilon / 8, and its parts underflow.
    let magnitude = b.abs(w);
    let negligible = b.negligible(magnitude);
    let rest = b.select(negligible, zero, rest);
    combine(b, Base::E, k, f, rest, LOG1P_ERROR.with_argument(more_epsilons))
}

/// A logarithm whose argument has its pole at `pole`: -inf there, inf at inf.
fn bounded(b: &mut Builder, x: Ends, pole: f64, f: impl FnMut(&mut Builder, Lane) -> Approx) -> Applied {
    let pole = b.number(pole);
    let minus_pole = b.neg(pole);
    let ends = increasing(b, x, f);
    let infinity = b.infinity();
    let reaches = b.less_equal(minus_pole, x.nlo);
    let nlo = b.select(reaches, infinity, ends.nlo);
    let hi = b.unbounded_at_infinity(x.hi, ends.hi);
    Applied { ends: Ends { nlo, hi }, empty: b.less_equal(x.hi, pole), continuous: b.less(x.nlo, minus_pole) }
}

pub fn apply(b: &mut Builder, base: Base, x: Ends) -> Applied {
    bounded(b, x, 0.0, |b, end| logarithm(b, base, end))
}

pub fn log1p(b: &mut Builder, x: Ends) -> Applied {
    bounded(b, x, -1.0, |b, end| log1p_core(b, end, None, 0.0))
}

/// The value, with the pole and the domain's end around it.
fn point_of(b: &mut Builder, x: Lane, pole: f64, value: Lane) -> Lane {
    let pole = b.number(pole);
    let (nan, minus_infinity) = (b.number(f64::NAN), b.number(f64::NEG_INFINITY));
    let value = b.unbounded_at_infinity(x, value);
    let above = b.less(pole, x);
    let at = b.equal(x, pole);
    let beyond = b.select(at, minus_infinity, nan);
    b.select(above, value, beyond)
}

pub fn point(b: &mut Builder, base: Base, x: Lane) -> Lane {
    let value = logarithm(b, base, x).value(b);
    point_of(b, x, 0.0, value)
}

pub fn log1p_point(b: &mut Builder, x: Lane) -> Lane {
    let value = log1p_core(b, x, None, 0.0).value(b);
    point_of(b, x, -1.0, value)
}
