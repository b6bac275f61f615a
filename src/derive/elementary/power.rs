//! x^y = 2^(y log2 x), the exponent carried in two parts so that its error is that of the logarithm alone: the relative
//! error of the result is at most
//! 0.4 |y| + 2.5 epsilon.

use crate::derive::elementary::Approx;
use crate::derive::elementary::exp;
use crate::derive::elementary::exp::Exponential;
use crate::derive::elementary::log;
use crate::derive::ends::Applied;
use crate::derive::ends::Ends;
use crate::derive::lanes::Builder;
use crate::derive::lanes::Lane;
use crate::derive::lanes::Mask;

/// log2 x in two parts, -inf where x <= 0; the second part is below an ulp of the first.
#[derive(Clone, Copy)]
pub struct Logarithm {
    head: Lane,
    tail: Lane,
}

pub fn logarithm(b: &mut Builder, x: Lane) -> Logarithm {
    let Approx { head, tail, .. } = log::logarithm(b, log::Base::Two, x);
    let (head, tail) = b.fast_two_sum(head, tail);
    let (zero, minus_infinity) = (b.zero(), b.number(f64::NEG_INFINITY));
    let nothing = b.less_equal(x, zero);
    let head = b.select(nothing, minus_infinity, head);
    Logarithm { head: b.unbounded_at_infinity(x, head), tail }
}

/// The exponent y log2 x: `head + above` is an upper bound and `head - below` a lower one.
#[derive(Clone, Copy)]
pub struct Exponent {
    head: Lane,
    /// The tail itself.
    tail: Lane,
    above: Lane,
    below: Lane,
}

/// The product with `y`, of which `y_rest` is a second part. 0 times infinity is 0: x^0 = 1 arbitrarily near x = 0.
pub fn exponent(b: &mut Builder, log: Logarithm, y: Lane, y_rest: Option<Lane>) -> Exponent {
    let zero = b.zero();
    // Beyond the reach every result overflows or underflows.
    let reach = b.by_precision(160.0, 1100.0);
    let minus_reach = b.neg(reach);
    let product = b.mul(y, log.head);
    let magnitude = b.abs(product);
    let inside = b.less_equal(magnitude, reach);
    let minus_product = b.neg(product);
    let tail = b.fma(y, log.head, minus_product);
    let tail = b.fma(y, log.tail, tail);
    let tail = y_rest.map_or(tail, |rest| b.fma(rest, log.head, tail));
    // Products near 0 may lose their second part to underflow; the result is next to 1 there.
    let least = b.by_precision(1.0 / (1u64 << 30) as f64, 1.0 / (1u64 << 60) as f64);
    let (factor, cap) = log::Base::Two.product_error(b);
    let size = b.abs(y);
    let most = b.mul(size, cap);
    let scale = b.min(magnitude, most);
    let scale = b.max(scale, least);
    let minus_tail = b.neg(tail);
    let above = b.fma(scale, factor, tail);
    let below = b.fma(scale, factor, minus_tail);
    let [tail, above, below] = [tail, above, below].map(|part| b.select(inside, part, zero));
    let ordered = b.equal(product, product);
    let head = b.select(ordered, product, zero);
    Exponent { head: b.clamp(head, minus_reach, reach), tail, above, below }
}

impl Exponent {
    /// An upper bound of 2 to this exponent.
    pub fn upper(self, b: &mut Builder) -> Lane {
        upper_power(b, self.head, self.above)
    }

    /// A lower bound, negated.
    pub fn negated_lower(self, b: &mut Builder) -> Lane {
        let minus = b.neg(self.head);
        negated_lower_power(b, minus, self.below)
    }

    pub fn value(self, b: &mut Builder) -> Lane {
        let n = b.nearest(self.head);
        let r = b.sub(self.head, n);
        let r = b.add(r, self.tail);
        power(b, n, r).value(b)
    }
}

/// 2^(n + r), n kept where the last step can scale by it: beyond, the result overflows or underflows all the same.
fn power(b: &mut Builder, n: Lane, r: Lane) -> Exponential {
    let (least, greatest) = (b.by_precision(-151.0, -1076.0), b.by_precision(129.0, 1025.0));
    let n = b.clamp(n, least, greatest);
    exp::power_of_two(b, n, r)
}

/// An upper bound of 2^(head + above).
fn upper_power(b: &mut Builder, head: Lane, above: Lane) -> Lane {
    let n = b.nearest(head);
    let r = b.sub(head, n);
    let r = b.add(r, above);
    power(b, n, r).upper(b)
}

/// A lower bound of 2^-(head + above), negated.
fn negated_lower_power(b: &mut Builder, head: Lane, above: Lane) -> Lane {
    let n = b.nearest(head);
    let r = b.sub(head, n);
    let r = b.add(r, above);
    let (n, r) = (b.neg(n), b.neg(r));
    power(b, n, r).negated_lower(b)
}

/// Two parts that are together at least both of two such sums.
fn larger(b: &mut Builder, x: (Lane, Lane), y: (Lane, Lane)) -> (Lane, Lane) {
    if x == y {
        return x;
    }
    let head = b.max(x.0, y.0);
    let [x_rest, y_rest] = [x, y].map(|(part, rest)| {
        let gap = b.sub(head, part);
        b.sub(rest, gap)
    });
    (head, b.max(x_rest, y_rest))
}

pub fn apply(b: &mut Builder, x: Ends, y: Ends) -> Applied {
    let zero = b.zero();
    let (x_lo, y_lo) = (b.low(x), b.low(y));
    let (at_low, at_high) = (logarithm(b, x_lo), logarithm(b, x.hi));
    // For each end of y, the end of the logarithm that makes the product largest, and smallest.
    let mut largest = Vec::new();
    let mut smallest = Vec::new();
    for y in [y_lo, y.hi] {
        let rising = b.less_equal(zero, y);
        let top = select(b, rising, at_high, at_low);
        let bottom = select(b, rising, at_low, at_high);
        let Exponent { head, above, .. } = exponent(b, top, y, None);
        largest.push((head, above));
        let Exponent { head, below, .. } = exponent(b, bottom, y, None);
        smallest.push((b.neg(head), below));
    }
    let (head, above) = larger(b, largest[0], largest[1]);
    let hi = upper_power(b, head, above);
    let (head, above) = larger(b, smallest[0], smallest[1]);
    let nlo = negated_lower_power(b, head, above);
    let (no_base, no_exponent) = (b.less(x.hi, zero), b.less_equal(y.hi, zero));
    let zero_base = b.less_equal(x.hi, zero);
    let undefined = b.and(zero_base, no_exponent);
    let (positive_base, positive_exponent) = (b.less(x.nlo, zero), b.less(y.nlo, zero));
    let nonnegative_base = b.less_equal(x.nlo, zero);
    let at_zero = b.and(nonnegative_base, positive_exponent);
    Applied { ends: Ends { nlo, hi }, empty: b.or(no_base, undefined), continuous: b.or(positive_base, at_zero) }
}

fn select(b: &mut Builder, mask: Mask, x: Logarithm, y: Logarithm) -> Logarithm {
    Logarithm { head: b.select(mask, x.head, y.head), tail: b.select(mask, x.tail, y.tail) }
}

pub fn point(b: &mut Builder, x: Lane, y: Lane) -> Lane {
    let (zero, nan) = (b.zero(), b.number(f64::NAN));
    let log = logarithm(b, x);
    let value = exponent(b, log, y, None).value(b);
    let (positive, at_zero) = (b.less(zero, x), b.equal(x, zero));
    let growing = b.less(zero, y);
    let at_zero = b.and(at_zero, growing);
    let defined = b.or(positive, at_zero);
    b.select(defined, value, nan)
}
