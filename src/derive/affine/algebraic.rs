//! Forms of square root, reciprocal, absolute value, minimum and maximum. All are convex or concave, so the chord's
//! slope s is the best one (Chebyshev: Stolfi and de Figueiredo 1997), f(x) - s x is extreme at the ends of X on one
//! side, and on the other its extremum over all x is known in closed form for every s, however s was rounded.

use crate::derive::affine::Af1;
use crate::derive::affine::Operand;
use crate::derive::affine::centre_and_radius;
use crate::derive::affine::linear::Linear;
use crate::derive::affine::sub;
use crate::derive::affine::to_ends;
use crate::derive::ends::Ends;
use crate::derive::lanes::Builder;
use crate::derive::lanes::Lane;

/// The square root on the part of x = [a, b] above 0, where it lies in y. The chord's slope is 1 / (sqrt a + sqrt b).
/// For s > 0, sqrt x - s x is at most 1 / (4 s), at x = 1 / (4 s^2).
pub fn sqrt(b: &mut Builder, x: Ends, y: Ends) -> Linear {
    let (zero, one, fourth) = (b.zero(), b.number(1.0), b.number(0.25));
    let sum = b.sub(y.hi, y.nlo);
    // Rounded up, it is at least 1 / sum, so 1 / (4 s) is at most sum / 4.
    let slope = b.div(one, sum);
    let hi = b.mul(sum, fourth);
    // At b, y.hi is the root rounded up: less 2 epsilon of it, it lies below. At a, y.nlo bounds the root.
    let shrink = b.epsilons(2.0);
    let minus_root = b.neg(y.hi);
    let root_nlo = b.fma(y.hi, shrink, minus_root);
    let at_high = b.fma(slope, x.hi, root_nlo);
    let low = b.low(x);
    let low = b.max(low, zero);
    let at_low = b.fma(slope, low, y.nlo);
    Linear { slope, rest: Ends { nlo: b.max(at_low, at_high), hi } }
}

/// The reciprocals of x = [a, b], NaN where x contains 0: 1/x decreases on either side of it.
pub fn reciprocals(b: &mut Builder, x: Ends) -> Ends {
    let (one, minus_one, nan) = (b.number(1.0), b.number(-1.0), b.number(f64::NAN));
    let low = b.low(x);
    let (nlo, hi) = (b.div(minus_one, x.hi), b.div(one, low));
    let undefined = b.contains_zero(x);
    Ends { nlo, hi: b.select(undefined, nan, hi) }
}

/// 1/x on x = [a, b] without 0. With m = 1/(a b) > 0, the negated slope of the chord, 1/x + m x lies for x > 0 between
/// 2 sqrt m, at x = 1 / sqrt m, and the larger of its values at a and b; for x < 0 it is the negated value at -x.
pub fn reciprocal(b: &mut Builder, x: Ends) -> Linear {
    let (zero, two) = (b.zero(), b.number(2.0));
    let inverses = reciprocals(b, x);
    let low = b.low(x);
    let inverse_low = b.low(inverses);
    let m = b.mul(inverse_low, inverses.hi);
    let [at_low, at_high] = [(low, inverses.hi), (x.hi, inverse_low)].map(|(end, inverse)| {
        let (end, inverse) = (b.abs(end), b.abs(inverse));
        b.fma(m, end, inverse)
    });
    // The inverses are off by an epsilon or by the smallest number at most.
    let largest = b.max(at_low, at_high);
    let (margin, tiny) = (b.epsilons(4.0), b.least_normal());
    let missed = b.fma(largest, margin, tiny);
    let largest = b.add(largest, missed);
    // The root, rounded up, is less than 2 epsilon too large.
    let root = b.sqrt(m);
    let (minus_root, margin) = (b.neg(root), b.epsilons(2.0));
    let minus_smallest = b.fma(root, margin, minus_root);
    let minus_smallest = b.mul(minus_smallest, two);
    let positive = b.less(zero, low);
    let (above, below) = (Ends { nlo: minus_smallest, hi: largest }, Ends { nlo: largest, hi: minus_smallest });
    Linear { slope: b.neg(m), rest: b.select_ends(positive, above, below) }
}

/// |x| on x = [a, b]. For a slope s from -1 to 1, |x| - s x is at least 0 and largest at an end. The slope of the chord,
/// (a + b) / (b - a), is beyond -1 or 1 where x has one sign; it is -1 for the point 0.
pub fn abs(b: &mut Builder, x: Ends) -> Linear {
    let (zero, one, minus_one) = (b.zero(), b.number(1.0), b.number(-1.0));
    let low = b.low(x);
    let (sum, width) = (b.add(x.hi, low), b.add(x.hi, x.nlo));
    let chord = b.div(sum, width);
    let slope = b.max(chord, minus_one);
    let slope = b.min(slope, one);
    let minus_slope = b.neg(slope);
    let [at_low, at_high] = [low, x.hi].map(|end| {
        let size = b.abs(end);
        b.fma(minus_slope, end, size)
    });
    Linear { slope, rest: Ends { nlo: zero, hi: b.max(at_low, at_high) } }
}

/// max(x, y) = y + max(d, 0) with d = x - y.
pub fn max(b: &mut Builder, x: &Operand, y: &Operand) -> Af1 {
    let (slope, excess) = larger(b, x, y);
    let zero = b.zero();
    blend(b, &y.form, &x.form, slope, Ends { nlo: zero, hi: excess })
}

/// min(x, y) = x - max(d, 0) with d = x - y.
pub fn min(b: &mut Builder, x: &Operand, y: &Operand) -> Af1 {
    let (slope, excess) = larger(b, x, y);
    let zero = b.zero();
    blend(b, &x.form, &y.form, slope, Ends { nlo: excess, hi: zero })
}

/// For d = x - y in [a, b]: a slope s of max(d, 0) from 0 to 1, and an upper bound of max(d, 0) - s d, whose lower
/// bound is 0. The slope of the chord is b / (b - a), beyond 0 or 1 where d has one sign; it is 0 where d is the point 0.
fn larger(b: &mut Builder, x: &Operand, y: &Operand) -> (Lane, Lane) {
    let (zero, one) = (b.zero(), b.number(1.0));
    let difference = sub(b, &x.form, &y.form);
    let range = to_ends(b, &difference);
    let natural = b.sub_ends(x.ends, y.ends);
    let d = b.meet(range, natural);
    let width = b.add(d.hi, d.nlo);
    let chord = b.div(d.hi, width);
    let slope = b.max(chord, zero);
    let slope = b.min(slope, one);
    let minus_slope = b.neg(slope);
    // At b it is b - s b, or -s b where b < 0; at a likewise, with -nlo for a.
    let [at_low, at_high] = [b.low(d), d.hi].map(|end| {
        let kept = b.max(end, zero);
        b.fma(minus_slope, end, kept)
    });
    (slope, b.max(at_low, at_high))
}

/// (1 - s) x + s y + rest for 0 <= s <= 1: with s = 0 it is x and with s = 1 it is y, up to rounding.
fn blend(b: &mut Builder, x: &Af1, y: &Af1, s: Lane, rest: Ends) -> Af1 {
    let zero = b.zero();
    let (minus_x, minus_y) = (b.neg(x.centre), b.neg(y.centre));
    let (step, minus_step) = (b.add(y.centre, minus_x), b.add(x.centre, minus_y));
    let (above, below) = (b.fma(s, step, rest.hi), b.fma(s, minus_step, rest.nlo));
    let ends = Ends { nlo: b.add(minus_x, below), hi: b.add(x.centre, above) };
    let (centre, radius) = centre_and_radius(b, ends);
    let one = b.number(1.0);
    let share = b.sub(one, s);
    let error = b.weighted(share, x.error, radius);
    let error = b.weighted(s, y.error, error);
    // y_i - x_i rounds by epsilon (|x_i| + |y_i|), and the sum by epsilon of at most |x_i| + (1 + epsilon) (|x_i| + |y_i|).
    let (spread_x, spread_y) = (x.spread(b), y.spread(b));
    let magnitude = b.add(spread_x, spread_y);
    let error = b.with_product_rounding(error, 4.0, magnitude);
    let coefficients = std::array::from_fn(|i| {
        let (p, q) = (x.coefficients[i], y.coefficients[i]);
        let step = b.sub(q, p);
        if b.is_zero(p) && b.is_zero(q) { zero } else { b.weighted(s, step, p) }
    });
    Af1 { centre, coefficients, error }
}
