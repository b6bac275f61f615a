//! Inverse circular functions. Arcsine and arccosine by a polynomial on [0, 1/2], above it through
//! asin a = pi/2 - 2 asin sqrt((1 - a)/2); the arctangent by one on [0, 1], above it through the reciprocal.

use crate::derive::elementary::Approx;
use crate::derive::elementary::increasing;
use crate::derive::elementary::increasing_odd;
use crate::derive::elementary::tables;
use crate::derive::ends::Applied;
use crate::derive::ends::Ends;
use crate::derive::lanes::Builder;
use crate::derive::lanes::Lane;
use crate::derive::lanes::Mask;

/// Errors of asin s relative to s, in epsilon, for an argument itself and for a root: section "asin".
const ASIN_ERROR: f64 = 0.3125;
const ASIN_ROOT_ERROR: f64 = 2.875;
/// Errors of atan t relative to t, in epsilon, for an exact t and for a rounded quotient: section "atan".
const ATAN_ERROR: f64 = 2.25;
const ATAN_QUOTIENT_ERROR: f64 = 3.25;

/// asin |x| for |x| <= 1, by a small argument.
struct Arc {
    small: Mask,
    /// asin s = s + tail.
    s: Lane,
    tail: Lane,
    /// The error's factor.
    factor: Lane,
}

fn arc(b: &mut Builder, magnitude: Lane) -> Arc {
    let (half, minus_half) = (b.number(0.5), b.number(-0.5));
    let small = b.less(magnitude, half);
    let square = b.mul(magnitude, magnitude);
    // Exact for |x| >= 1/2.
    let rest = b.fma(minus_half, magnitude, half);
    let z = b.select(small, square, rest);
    let root = b.sqrt(rest);
    let s = b.select(small, magnitude, root);
    let p = b.polynomial(&tables::ASIN, z);
    let p = b.mul(z, p);
    let tail = b.mul(s, p);
    let (exact, rounded) = (b.epsilons(ASIN_ERROR), b.epsilons(ASIN_ROOT_ERROR));
    Arc { small, s, tail, factor: b.select(small, exact, rounded) }
}

/// `C + m (s + tail)` for a constant C of two parts and m in {1, -1, 2, -2}; the error is `factor` relative to s and
/// 2^-45 epsilon relative to C.
fn around(b: &mut Builder, c: [Lane; 2], m: Lane, s: Lane, tail: Lane, factor: Lane) -> Approx {
    let (moved, moved_tail) = (b.mul(m, s), b.mul(m, tail));
    let (head, low) = b.fast_two_sum(c[0], moved);
    let tail = b.add(moved_tail, c[1]);
    let tiny = b.by_precision(1.0 / (1u64 << 16) as f64, 1.0 / (1u64 << 45) as f64);
    let scale = b.fma(c[0], tiny, s);
    Approx { head, tail: b.add(low, tail), factor, scale }
}

/// Selects between constants of two parts.
fn select_parts(b: &mut Builder, mask: Mask, x: [Lane; 2], y: [Lane; 2]) -> [Lane; 2] {
    [b.select(mask, x[0], y[0]), b.select(mask, x[1], y[1])]
}

fn half_pi(b: &mut Builder) -> [Lane; 2] {
    let [high, low, _]: [Lane; 3] = b.parts(&tables::HALF_PI);
    [high, low]
}

fn asin_at(b: &mut Builder, x: Lane) -> Approx {
    let magnitude = b.abs(x);
    let Arc { small, s, tail, factor } = arc(b, magnitude);
    let (zero, one, minus_two) = (b.zero(), b.number(1.0), b.number(-2.0));
    let quarter_turn = half_pi(b);
    let c = select_parts(b, small, [zero; 2], quarter_turn);
    let m = b.select(small, one, minus_two);
    around(b, c, m, s, tail, factor).with_sign_of(b, x)
}

fn acos_at(b: &mut Builder, x: Lane) -> Approx {
    let magnitude = b.abs(x);
    let Arc { small, s, tail, factor } = arc(b, magnitude);
    let zero = b.zero();
    let negative = b.less(x, zero);
    let (minus_one, one) = (b.number(-1.0), b.number(1.0));
    let (minus_two, two) = (b.number(-2.0), b.number(2.0));
    let (quarter_turn, half_turn) = (half_pi(b), b.parts(&tables::PI));
    // pi/2 - asin x, 2 asin s or pi - 2 asin s.
    let outer = select_parts(b, negative, half_turn, [zero; 2]);
    let c = select_parts(b, small, quarter_turn, outer);
    let inner_m = b.select(negative, one, minus_one);
    let outer_m = b.select(negative, minus_two, two);
    let m = b.select(small, inner_m, outer_m);
    around(b, c, m, s, tail, factor)
}

/// The part of the box in [-1, 1], and its masks.
fn clip_to_unit(b: &mut Builder, x: Ends) -> (Ends, Mask, Mask) {
    let (one, minus_one) = (b.number(1.0), b.number(-1.0));
    let (above, below) = (b.less(x.nlo, minus_one), b.less(x.hi, minus_one));
    let empty = b.or(above, below);
    let (low_inside, high_inside) = (b.less_equal(x.nlo, one), b.less_equal(x.hi, one));
    let continuous = b.and(low_inside, high_inside);
    let ends = Ends { nlo: b.clamp(x.nlo, minus_one, one), hi: b.clamp(x.hi, minus_one, one) };
    (ends, empty, continuous)
}

pub fn asin(b: &mut Builder, x: Ends) -> Applied {
    let (x, empty, continuous) = clip_to_unit(b, x);
    Applied { ends: increasing_odd(b, x, asin_at), empty, continuous }
}

pub fn acos(b: &mut Builder, x: Ends) -> Applied {
    let (x, empty, continuous) = clip_to_unit(b, x);
    // Decreasing: what encloses an increasing function, of the exchanged ends.
    let low = b.low(x);
    let minus_high = b.neg(x.hi);
    let exchanged = Ends { nlo: minus_high, hi: low };
    let ends = increasing(b, exchanged, acos_at);
    // An arccosine is not negative.
    let zero = b.zero();
    Applied { ends: Ends { nlo: b.min(ends.nlo, zero), hi: ends.hi }, empty, continuous }
}

pub fn asin_point(b: &mut Builder, x: Lane) -> Lane {
    let value = asin_at(b, x).value(b);
    unless_outside(b, x, value)
}

pub fn acos_point(b: &mut Builder, x: Lane) -> Lane {
    let value = acos_at(b, x).value(b);
    unless_outside(b, x, value)
}

/// NaN beyond [-1, 1]: the root of a negative number is one there already, but not what Select makes of it.
fn unless_outside(b: &mut Builder, x: Lane, value: Lane) -> Lane {
    let (one, nan) = (b.number(1.0), b.number(f64::NAN));
    let magnitude = b.abs(x);
    let inside = b.less_equal(magnitude, one);
    b.select(inside, value, nan)
}

/// atan t = t + tail for |t| <= 1.
fn curved(b: &mut Builder, t: Lane) -> Lane {
    let z = b.mul(t, t);
    let p = b.polynomial(&tables::ATAN, z);
    let p = b.mul(z, p);
    b.mul(t, p)
}

fn atan_at(b: &mut Builder, x: Lane) -> Approx {
    let magnitude = b.abs(x);
    let (zero, one, minus_one) = (b.zero(), b.number(1.0), b.number(-1.0));
    let steep = b.less(one, magnitude);
    let denominator = b.select(steep, magnitude, one);
    let numerator = b.select(steep, one, magnitude);
    let t = b.div(numerator, denominator);
    let tail = curved(b, t);
    let quarter_turn = half_pi(b);
    let c = select_parts(b, steep, quarter_turn, [zero; 2]);
    let m = b.select(steep, minus_one, one);
    let (exact, rounded) = (b.epsilons(ATAN_ERROR), b.epsilons(ATAN_QUOTIENT_ERROR));
    let factor = b.select(steep, rounded, exact);
    around(b, c, m, t, tail, factor).with_sign_of(b, x)
}

pub fn atan(b: &mut Builder, x: Ends) -> Applied {
    increasing_odd(b, x, atan_at).into()
}

pub fn atan_point(b: &mut Builder, x: Lane) -> Lane {
    atan_at(b, x).value(b)
}

/// The angle of (x, |y|), in [0, pi]. At the origin it is 0.
fn angle(b: &mut Builder, y: Lane, x: Lane) -> Approx {
    let (zero, one, minus_one) = (b.zero(), b.number(1.0), b.number(-1.0));
    let (height, width) = (b.abs(y), b.abs(x));
    let steep = b.less(width, height);
    let leftward = b.less(x, zero);
    let numerator = b.select(steep, width, height);
    let denominator = b.select(steep, height, width);
    let t = b.div(numerator, denominator);
    // 0/0 is NaN: Max gives its second operand.
    let t = b.max(t, zero);
    let tail = curved(b, t);
    let (quarter_turn, half_turn) = (half_pi(b), b.parts(&tables::PI));
    let flat = select_parts(b, leftward, half_turn, [zero; 2]);
    let c = select_parts(b, steep, quarter_turn, flat);
    // pi/2 - t to the right and pi - t to the left; pi/2 + t and t otherwise.
    let backward = b.exclusive(steep, leftward);
    let m = b.select(backward, minus_one, one);
    let factor = b.epsilons(ATAN_QUOTIENT_ERROR);
    around(b, c, m, t, tail, factor)
}

/// The upper bound of the angle's value, or of its negative.
fn angle_bound(b: &mut Builder, angle: Approx, negated: Mask) -> Lane {
    let (minus_head, minus_tail) = (b.neg(angle.head), b.neg(angle.tail));
    let head = b.select(negated, minus_head, angle.head);
    let tail = b.select(negated, minus_tail, angle.tail);
    Approx { head, tail, ..angle }.upper(b)
}

/// The angle of the points (x, y) of a box other than the origin, in (-pi, pi]. Its extremes are at corners: seen from
/// the origin, the box lies in a half plane unless it crosses the negative x axis, where the answer is everything.
pub fn atan2(b: &mut Builder, y: Ends, x: Ends) -> Applied {
    let zero = b.zero();
    let (x_lo, y_lo) = (b.low(x), b.low(y));
    let below = b.less(y.hi, zero);
    let above = b.less_equal(y.nlo, zero);
    // The largest angle: a box below the x axis has it at its right side, else at its left one; there at the top where
    // the side is right of the y axis, else at the bottom.
    let x_max = b.select(below, x.hi, x_lo);
    let right = b.less_equal(zero, x_max);
    let y_max = b.select(right, y.hi, y_lo);
    // The smallest: mirrored at the x axis. A right side on the y axis has it at the top, so that a corner at the origin
    // does not count.
    let x_min = b.select(above, x.hi, x_lo);
    let (right, on_axis) = (b.less(zero, x_min), b.equal(zero, x_min));
    let not_above = b.not(above);
    let on_axis = b.and(on_axis, not_above);
    let right = b.or(right, on_axis);
    let y_min = b.select(right, y_lo, y.hi);
    let (largest, smallest) = (angle(b, y_max, x_max), angle(b, y_min, x_min));
    let negative = b.less(y_max, zero);
    let hi = angle_bound(b, largest, negative);
    let negative = b.less(y_min, zero);
    let positive = b.not(negative);
    let nlo = angle_bound(b, smallest, positive);
    // Points with x < 0 on both sides of the cut, which itself belongs to the upper side.
    let reaches_left = b.less(zero, x.nlo);
    let not_below = b.not(below);
    let both_sides = b.and(not_below, not_above);
    let cut = b.and(reaches_left, both_sides);
    let pi = b.constant_ends(-std::f64::consts::PI.next_up(), std::f64::consts::PI.next_up());
    let ends = b.select_ends(cut, pi, Ends { nlo, hi });
    let (flat, thin) = (b.point_zero(y), b.point_zero(x));
    let right = b.less(x.nlo, zero);
    let strictly_above = b.less(y.nlo, zero);
    let off_axis = b.or(strictly_above, below);
    Applied { ends, empty: b.and(flat, thin), continuous: b.or(right, off_axis) }
}

pub fn atan2_point(b: &mut Builder, y: Lane, x: Lane) -> Lane {
    angle(b, y, x).with_sign_of(b, y).value(b)
}

impl Builder {
    /// Where exactly one of two masks is set.
    fn exclusive(&mut self, a: Mask, c: Mask) -> Mask {
        let (not_a, not_c) = (self.not(a), self.not(c));
        let (left, right) = (self.and(a, not_c), self.and(not_a, c));
        self.or(left, right)
    }

    /// Where the box is the number 0 alone.
    fn point_zero(&mut self, x: Ends) -> Mask {
        let zero = self.zero();
        let (low, high) = (self.equal(x.nlo, zero), self.equal(x.hi, zero));
        self.and(low, high)
    }
}
