//! Sine, cosine and tangent: x = n pi/2 + r with |r| <= pi/4 and a little, then two short polynomials.
//!
//! The first step of the reduction, x - n P1, is exact for |x| up to [`limit`]: for n != 0 both are multiples of
//! 2^-fraction / 2 and the difference is below 1. The second rounds. Beyond the limit sine and cosine are [-1, 1] and
//! the tangent is anything.
//!
//! Between consecutive odd multiples of pi/2 the sine is monotone, so the ends and the extrema between them enclose it.
//! An end's place is the pair (n, sign of r). The sign is right: no number of the format within the limit is nearer to a
//! multiple of pi/2 than 2^-60.5 (single: 2^-27.9; `rounding.py`, section "nearest multiples"), and what the two parts
//! of pi/2 miss is below 2^-89 (single: 2^-33). So the tangent's poles, which are where r = 0 for odd n, are counted
//! exactly, and so are the extrema.

use crate::derive::elementary::Approx;
use crate::derive::elementary::Format;
use crate::derive::elementary::tables;
use crate::derive::ends::Applied;
use crate::derive::ends::Ends;
use crate::derive::lanes::Builder;
use crate::derive::lanes::Lane;
use crate::derive::lanes::LaneOp;
use crate::derive::lanes::Mask;

/// The error of sine and cosine relative to r and 1, in epsilon: sections "sin" and "cos".
const WAVE_ERROR: f64 = 1.625;
/// The relative error of the tangent, in epsilon: section "tan".
const TANGENT_ERROR: f64 = 6.5;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wave {
    Sine,
    Cosine,
}

/// How far the reduction reaches.
fn limit(b: &mut Builder) -> Lane {
    b.by_precision((1u64 << 16) as f64, (1u64 << 20) as f64)
}

struct Reduced {
    n: Lane,
    r: Lane,
    rest: Lane,
}

/// x = n pi/2 + (r + rest); rest is what the first two parts of pi/2 miss, r has one rounding.
fn reduce(b: &mut Builder, x: Lane) -> Reduced {
    let [per_quarter] = b.parts(&tables::TWO_OVER_PI);
    let quotient = b.mul(x, per_quarter);
    let n = b.nearest(quotient);
    let minus_n = b.neg(n);
    let [p1, p2, p3] = b.parts(&tables::HALF_PI);
    let r = b.fma(minus_n, p1, x);
    let r = b.fma(minus_n, p2, r);
    Reduced { n, r, rest: b.mul(minus_n, p3) }
}

/// sin(x + shift pi/2), and x's reduction.
fn evaluate(b: &mut Builder, wave: Wave, x: Lane) -> (Approx, Reduced) {
    let shift = wave.shift();
    let reduced = reduce(b, x);
    let Reduced { n, r, .. } = reduced;
    let quarter = b.integer_bits(n, shift);
    let odd = odd(b, quarter);
    let one = b.number(1.0);
    let u = b.mul(r, r);
    let (s, c) = (b.polynomial(&tables::SIN, u), b.polynomial(&tables::COS, u));
    let curve = b.select(odd, c, s);
    let curve = b.mul(u, curve);
    let head = b.select(odd, one, r);
    // The second bit of the quarter is the sign.
    let top = b.format().top;
    let half = b.push(LaneOp::ShiftRight(quarter, 1));
    let sign = b.push(LaneOp::ShiftLeft(half, top));
    let head = b.add_to_bits(head, sign);
    let tail = b.mul(head, curve);
    // Two parts of pi/2 miss n 2^-109.04 (single: n 2^-49.05), and n <= 1.28 |x|: in units of the relative error.
    let missed = b.by_precision(1.0 / (1u64 << 26) as f64, 1.0 / (1u64 << 57) as f64);
    let magnitude = b.abs(head);
    let argument = b.abs(x);
    let scale = b.fma(argument, missed, magnitude);
    (Approx { head, tail, factor: b.epsilons(WAVE_ERROR), scale }, reduced)
}

/// Where the low bit of an integer is set.
fn odd(b: &mut Builder, integer: Lane) -> Mask {
    let &Format { bias, fraction, top, .. } = b.format();
    let low = b.push(LaneOp::ShiftLeft(integer, top));
    let one = b.bits(bias << fraction);
    let signed = b.push(LaneOp::BitOr(low, one));
    let signed = b.push(LaneOp::FromBits(signed));
    let zero = b.zero();
    b.less(signed, zero)
}

impl Wave {
    /// Its phase in quarters.
    fn shift(self) -> f64 {
        match self {
            Wave::Sine => 0.0,
            Wave::Cosine => 1.0,
        }
    }

    /// How many minima and how many maxima lie at or below the place, up to constants.
    fn extrema_below(self, b: &mut Builder, place: &Reduced) -> (Lane, Lane) {
        let zero = b.zero();
        let right = b.less_equal(zero, place.r);
        let (before, after) = (b.number(self.shift()), b.number(self.shift() + 1.0));
        let step = b.select(right, after, before);
        let quarters = b.add(place.n, step);
        // Minima of the sine are at n = -1 modulo 4, maxima at n = 1.
        let (fourth, half) = (b.number(0.25), b.number(0.5));
        let turns = b.mul(quarters, fourth);
        let later = b.add(turns, half);
        (b.floor(turns), b.floor(later))
    }
}

pub fn wave(b: &mut Builder, wave: Wave, x: Ends) -> Applied {
    let low = b.low(x);
    let (at_low, low_place) = evaluate(b, wave, low);
    let (at_high, high_place) = evaluate(b, wave, x.hi);
    let (hi_low, hi_high) = (at_low.upper(b), at_high.upper(b));
    let (nlo_low, nlo_high) = (at_low.negated_lower(b), at_high.negated_lower(b));
    let (minima_low, maxima_low) = wave.extrema_below(b, &low_place);
    let (minima_high, maxima_high) = wave.extrema_below(b, &high_place);
    let (has_minimum, has_maximum) = (b.less(minima_low, minima_high), b.less(maxima_low, maxima_high));
    let reach = limit(b);
    let magnitude = b.max(x.nlo, x.hi);
    let near = b.less_equal(magnitude, reach);
    let far = b.not(near);
    let one = b.number(1.0);
    let [nlo, hi] = [(nlo_low, nlo_high, has_minimum), (hi_low, hi_high, has_maximum)].map(|(p, q, extremum)| {
        let end = b.max(p, q);
        let end = b.min(end, one);
        let extreme = b.or(extremum, far);
        b.select(extreme, one, end)
    });
    Ends { nlo, hi }.into()
}

pub fn wave_point(b: &mut Builder, wave: Wave, x: Lane) -> Lane {
    let value = evaluate(b, wave, x).0.value(b);
    let (minus_one, one) = (b.number(-1.0), b.number(1.0));
    b.clamp(value, minus_one, one)
}

/// The tangent as a quotient, rounded, and the number of poles at or below the place up to a constant.
fn tangent(b: &mut Builder, x: Lane) -> (Lane, Lane) {
    let Reduced { n, r, rest } = reduce(b, x);
    let (zero, one, half) = (b.zero(), b.number(1.0), b.number(0.5));
    let u = b.mul(r, r);
    let (s, c) = (b.polynomial(&tables::SIN, u), b.polynomial(&tables::COS, u));
    // The rest counts in the sine alone, and there only where r is so small that the sine's slope is 1.
    let s = b.mul(u, s);
    let tail = b.fma(r, s, rest);
    let (sine, cosine) = (b.add(r, tail), b.fma(u, c, one));
    let quarter = b.integer_bits(n, 0.0);
    let odd = odd(b, quarter);
    let minus_cosine = b.neg(cosine);
    let numerator = b.select(odd, minus_cosine, sine);
    let denominator = b.select(odd, sine, cosine);
    let quotient = b.div(numerator, denominator);
    // Poles are at odd n.
    let right = b.less_equal(zero, r);
    let step = b.select(right, one, zero);
    let quarters = b.add(n, step);
    let poles = b.mul(quarters, half);
    (quotient, b.floor(poles))
}

pub fn tan(b: &mut Builder, x: Ends) -> Applied {
    let low = b.low(x);
    let (at_low, poles_low) = tangent(b, low);
    let (at_high, poles_high) = tangent(b, x.hi);
    let magnitude = b.abs(at_high);
    let hi = Approx::of(b, at_high, TANGENT_ERROR, magnitude).upper(b);
    let magnitude = b.abs(at_low);
    let nlo = Approx::of(b, at_low, TANGENT_ERROR, magnitude).negated_lower(b);
    let reach = limit(b);
    let magnitude = b.max(x.nlo, x.hi);
    let near = b.less_equal(magnitude, reach);
    let one_branch = b.equal(poles_low, poles_high);
    let continuous = b.and(near, one_branch);
    let entire = b.entire();
    Applied { ends: b.select_ends(continuous, Ends { nlo, hi }, entire), empty: Mask::False, continuous }
}

pub fn tan_point(b: &mut Builder, x: Lane) -> Lane {
    tangent(b, x).0
}
