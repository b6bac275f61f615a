//! The cube root, by an iteration for its reciprocal and one step with the exact residual; and rational powers.

use crate::derive::Precision;
use crate::derive::elementary::Approx;
use crate::derive::elementary::log;
use crate::derive::elementary::power;
use crate::derive::elementary::power::Exponent;
use crate::derive::elementary::tables;
use crate::derive::ends::Applied;
use crate::derive::ends::Ends;
use crate::derive::ends::Sign;
use crate::derive::lanes::Builder;
use crate::derive::lanes::Lane;
use crate::derive::lanes::LaneOp;
use crate::derive::lanes::Mask;

/// The error of the corrected cube root, in epsilon. The seed's 3.01e-3 becomes 1.3e-7 after one step of third order
/// (e = 1 - m y^3 = 9e-3, 14/81 e^3) and, in double precision, less than 3 epsilon after two. The root m y^2 then errs
/// by less than 2^-20 (double: 10 epsilon), the correction by that squared and by the same times the roundings in it.
const CBRT_ERROR: f64 = 1.0 / 64.0;

/// Powers of small roots up to this are multiplied out; beyond, the loss of n roundings exceeds that of an exponential.
const MULTIPLIED: u32 = 8;

/// The cube root of |x| over 2^j, and 2^j.
fn cbrt_parts(b: &mut Builder, x: Lane) -> (Approx, Lane) {
    let magnitude = b.abs(x);
    let log::Parts { k, m, .. } = log::split(b, magnitude, true);
    // k = 3 j + rest: the mantissa takes the rest.
    let (third, minus_three, one) = (b.near(1.0 / 3.0), b.number(-3.0), b.number(1.0));
    let j = b.mul(k, third);
    let j = b.nearest(j);
    let rest = b.fma(minus_three, j, k);
    let rest = b.integer_bits(rest, 0.0);
    let fraction = b.format().fraction;
    let rest = b.push(LaneOp::ShiftLeft(rest, fraction));
    let m = b.add_to_bits(m, rest);
    let minus_m = b.neg(m);
    let mut y = b.number(tables::CBRT_SEED[tables::CBRT_SEED.len() - 1].into());
    for &c in tables::CBRT_SEED.iter().rev().skip(1) {
        let c = b.number(c.into());
        y = b.fma(y, m, c);
    }
    let two_ninths = b.near(2.0 / 9.0);
    let steps = match b.precision() {
        Precision::Single => 1,
        Precision::Double => 2,
    };
    for _ in 0..steps {
        let square = b.mul(y, y);
        let cube = b.mul(square, y);
        let e = b.fma(minus_m, cube, one);
        let slope = b.fma(e, two_ninths, third);
        let slope = b.mul(e, slope);
        y = b.fma(y, slope, y);
    }
    let square = b.mul(y, y);
    let root = b.mul(m, square);
    // m - root^3 with the square in two parts, over 3 root^2.
    let high = b.mul(root, root);
    let minus_high = b.neg(high);
    let low = b.fma(root, root, minus_high);
    let minus_low = b.neg(low);
    let residual = b.fma(minus_high, root, m);
    let residual = b.fma(minus_low, root, residual);
    let slope = b.mul(square, third);
    let tail = b.mul(residual, slope);
    let root = Approx { head: root, tail, factor: b.epsilons(CBRT_ERROR), scale: root };
    (root.with_sign_of(b, x), b.power_of_two(j, 0))
}

/// The value with its power, but x itself where that is 0 or infinite.
fn with_power(b: &mut Builder, x: Lane, value: Lane, power: Lane) -> Lane {
    let value = b.mul(value, power);
    let (zero, infinity) = (b.zero(), b.infinity());
    let magnitude = b.abs(x);
    let (at_zero, at_infinity) = (b.equal(x, zero), b.equal(magnitude, infinity));
    let itself = b.or(at_zero, at_infinity);
    b.select(itself, x, value)
}

pub fn cbrt(b: &mut Builder, x: Ends) -> Applied {
    cbrt_ends(b, x).into()
}

fn cbrt_ends(b: &mut Builder, x: Ends) -> Ends {
    let [nlo, hi] = [x.nlo, x.hi].map(|end| {
        let (root, power) = cbrt_parts(b, end);
        let bound = root.upper(b);
        with_power(b, end, bound, power)
    });
    Ends { nlo, hi }
}

pub fn cbrt_point(b: &mut Builder, x: Lane) -> Lane {
    let (root, power) = cbrt_parts(b, x);
    let value = root.value(b);
    with_power(b, x, value, power)
}

/// |x|^(n/q) as an exponent of 2.
fn ratio_exponent(b: &mut Builder, magnitude: Lane, n: u32, q: u32) -> Exponent {
    let (n, q) = (f64::from(n), f64::from(q));
    // The ratio in two parts; the remainder of the division is exact.
    let (head, rest) = match b.precision() {
        Precision::Double => {
            let head = n / q;
            (head, (-head).mul_add(q, n) / q)
        }
        Precision::Single => {
            let head = f64::from((n / q) as f32);
            (head, f64::from((n / q - head) as f32))
        }
    };
    let (head, rest) = (b.number(head), b.number(rest));
    let log = power::logarithm(b, magnitude);
    power::exponent(b, log, head, Some(rest))
}

/// x^(n/q) for n >= 1 on [0, inf) (q even) or everywhere (q odd).
fn positive_ratio(b: &mut Builder, x: Ends, n: u32, q: u32) -> Ends {
    let zero = b.zero();
    let nonnegative = Ends { nlo: b.min(x.nlo, zero), hi: b.max(x.hi, zero) };
    if n <= MULTIPLIED && q == 3 {
        let root = cbrt_ends(b, x);
        return b.power_ends(root, Sign::Unknown, n);
    }
    if n <= MULTIPLIED && [2, 4, 8].contains(&q) {
        let mut root = nonnegative;
        for _ in 0..q.trailing_zeros() {
            root = b.sqrt_applied(root).ends;
        }
        return b.power_ends(root, Sign::NonNegative, n);
    }
    if n % 2 == 1 && q % 2 == 1 {
        // Odd and increasing: either end is an upper bound at its own sign.
        let [nlo, hi] = [x.nlo, x.hi].map(|end| {
            let magnitude = b.abs(end);
            let exponent = ratio_exponent(b, magnitude, n, q);
            let (above, below) = (exponent.upper(b), exponent.negated_lower(b));
            let negative = b.less(end, zero);
            b.select(negative, below, above)
        });
        return Ends { nlo, hi };
    }
    let magnitude = if q.is_multiple_of(2) { nonnegative } else { b.abs_ends(x) };
    let low = b.low(magnitude);
    let (least, greatest) = (ratio_exponent(b, low, n, q), ratio_exponent(b, magnitude.hi, n, q));
    let nlo = least.negated_lower(b);
    Ends { nlo: b.min(nlo, zero), hi: greatest.upper(b) }
}

/// x^(p/q), reduced: real for x < 0 where q is odd, else on [0, inf); a pole at 0 where p < 0.
pub fn power_ratio(b: &mut Builder, x: Ends, p: i32, q: u32) -> Applied {
    let zero = b.zero();
    let power = positive_ratio(b, x, p.unsigned_abs(), q);
    let even_root = q.is_multiple_of(2);
    if p > 0 {
        let (empty, continuous) =
            if even_root { (b.less(x.hi, zero), b.less_equal(x.nlo, zero)) } else { (Mask::False, Mask::True) };
        return Applied { ends: power, empty, continuous };
    }
    // The power may underflow to a zero end where the base excludes 0: the quotient is then unbounded, still an
    // enclosure; domain and continuity are said of the base.
    let (one, minus_one) = (b.number(1.0), b.number(-1.0));
    let odd = !even_root && p % 2 != 0;
    let sign = if odd { Sign::Unknown } else { Sign::NonNegative };
    let Ends { nlo, hi } = b.div_applied(Ends { nlo: minus_one, hi: one }, power, sign).ends;
    let ends = Ends { nlo: b.above_minus_max(nlo), hi: b.above_minus_max(hi) };
    let at_most_zero = b.less_equal(x.hi, zero);
    let (empty, continuous) = if even_root {
        (at_most_zero, b.less(x.nlo, zero))
    } else {
        let at_least_zero = b.less_equal(x.nlo, zero);
        let touches = b.contains_zero(x);
        (b.and(at_most_zero, at_least_zero), b.not(touches))
    };
    Applied { ends, empty, continuous }
}

pub fn power_ratio_point(b: &mut Builder, x: Lane, p: i32, q: u32) -> Lane {
    let (zero, one, nan) = (b.zero(), b.number(1.0), b.number(f64::NAN));
    let magnitude = b.abs(x);
    let value = ratio_exponent(b, magnitude, p.unsigned_abs(), q).value(b);
    let value = if p < 0 { b.div(one, value) } else { value };
    if q.is_multiple_of(2) {
        let inside = b.less_equal(zero, x);
        return b.select(inside, value, nan);
    }
    if p % 2 == 0 {
        return value;
    }
    let sign = b.sign_bit(x);
    b.add_to_bits(value, sign)
}
