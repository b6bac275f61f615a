//! Directed rounding: the only place in Rust code where a result is rounded down or up.
//!
//! Every function computes in round-to-nearest and asks an exact question about the sign of the remaining error: the
//! processor's rounding mode is never changed. `_down` returns the largest `f64` not above the real result, `_up` the
//! smallest not below it, for all finite arguments, subnormals and overflow included. Arguments must not be NaN.
//!
//! Sources: Dekker (1971) and Knuth (TAOCP 2, 4.2.2) for the error of a sum; Boldo and Muller (2003) for products,
//! quotients and roots through a fused multiply-add.

use num_bigint::{BigInt, Sign};
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};
use std::cmp::Ordering;

/// A product of at least this size has an error that a `f64` holds exactly: the product of two 53-bit significands is a
/// multiple of 2^(e-105) for a product in [2^e, 2^(e+1)), and here e - 105 >= -1065 > -1074.
const EXACT_ERROR: f64 = pow2(-960);
/// Lifts a factor out of the range where errors underflow.
const LIFT: f64 = pow2(600);

/// 2^e for -1074 <= e <= 1023, exactly.
pub(super) const fn pow2(e: i32) -> f64 {
    assert!(-1074 <= e && e <= 1023);
    if e >= -1022 { f64::from_bits(((e + 1023) as u64) << 52) } else { f64::from_bits(1 << (e + 1074)) }
}

/// The real number `error` compared with 0 says on which side of `nearest` the real result lies; step there if that is
/// downwards. An infinite `nearest` of finite arguments is an overflow: the largest finite number lies below it.
fn settle_down(nearest: f64, error: Ordering) -> f64 {
    if error == Ordering::Less { nearest.next_down() } else { nearest }
}

/// Mirror image of [`settle_down`].
fn settle_up(nearest: f64, error: Ordering) -> f64 {
    if error == Ordering::Greater { nearest.next_up() } else { nearest }
}

/// Sign of the finite number `x`.
fn sign(x: f64) -> Ordering {
    if x > 0.0 {
        Ordering::Greater
    } else if x < 0.0 {
        Ordering::Less
    } else {
        Ordering::Equal
    }
}

/// Sign of `a + b - nearest`, where `nearest` is `a + b` rounded to nearest.
fn sum_error(a: f64, b: f64, nearest: f64) -> Ordering {
    if nearest.is_infinite() {
        // An infinite argument gives an exact infinity; finite ones an overflow, past which the real sum stays inside.
        return if a.is_infinite() || b.is_infinite() { Ordering::Equal } else { sign(-nearest) };
    }
    // Fast2Sum: with |a| >= |b| both subtractions are exact, and no sum of finite numbers underflows inexactly.
    let (large, small) = if a.abs() >= b.abs() { (a, b) } else { (b, a) };
    sign(small - (nearest - large))
}

/// Sign of `a * b - c` for finite arguments, exactly.
fn product_minus(a: f64, b: f64, c: f64) -> Ordering {
    let p = a * b;
    // Rounding is monotone and leaves c alone: on whichever side of c the rounded product is, the real one is too.
    if p != c {
        return if p > c { Ordering::Greater } else { Ordering::Less };
    }
    if a == 0.0 || b == 0.0 || p.abs() >= EXACT_ERROR {
        return sign(a.mul_add(b, -c));
    }
    // |ab| < 2^-959, so the smaller factor is below 2^-479 and can be lifted by 2^600; the larger one too, if small.
    // Lifted factors are multiples of 2^-474 and of 2^-452 or 2^-474: the error is a multiple of 2^-948, held exactly.
    let (small, large) = if a.abs() <= b.abs() { (a, b) } else { (b, a) };
    let (large, c) = if large.abs() < pow2(-400) { (large * LIFT, c * LIFT) } else { (large, c) };
    let (small, c) = (small * LIFT, c * LIFT);
    let p = small * large;
    if p != c { sign(p - c) } else { sign(small.mul_add(large, -c)) }
}

/// Sign of `a * b - nearest`, where `nearest` is `a * b` rounded to nearest.
fn product_error(a: f64, b: f64, nearest: f64) -> Ordering {
    if nearest.is_infinite() {
        return if a.is_infinite() || b.is_infinite() { Ordering::Equal } else { sign(-nearest) };
    }
    product_minus(a, b, nearest)
}

/// Sign of `a / b - nearest`, where `nearest` is `a / b` rounded to nearest and `b` is not zero.
fn quotient_error(a: f64, b: f64, nearest: f64) -> Ordering {
    if nearest.is_infinite() {
        return if a.is_infinite() { Ordering::Equal } else { sign(-nearest) };
    }
    if b.is_infinite() {
        return Ordering::Equal;
    }
    // a/b - q has the sign of (a - qb) b. An overflowing q b is farther from 0 than a, and product_minus says so.
    let residual = product_minus(nearest, b, a).reverse();
    if b > 0.0 { residual } else { residual.reverse() }
}

/// Sign of `sqrt(x) - nearest`, where `nearest` is the root rounded to nearest.
fn root_error(x: f64, nearest: f64) -> Ordering {
    if x.is_infinite() { Ordering::Equal } else { product_minus(nearest, nearest, x).reverse() }
}

/// Exponent field and significand, hidden bit included, of a normal number: `|x| = significand * 2^(field - 1075)`.
#[inline(always)]
fn parts(x: f64) -> (i64, i64) {
    let bits = x.to_bits() as i64;
    (bits >> 52 & 0x7ff, bits & ((1 << 52) - 1) | 1 << 52)
}

/// Whether an exponent field is that of a normal number.
#[inline(always)]
fn is_normal(field: i64) -> bool {
    (field - 1) as u64 <= 2045
}

/// `|a b| - |p|` in units of the last place of the exact product, where `p` is `a b` rounded to nearest; `None` unless
/// all three are normal numbers.
///
/// In those units, 2^(ea + eb - 2150), both sides are whole numbers of some 106 bits, and they differ by at most half
/// a unit in the last place of `p`, which is 2^53 of them: 64 bits that wrap around hold the difference.
#[inline(always)]
fn product_residual(a: f64, b: f64, p: f64) -> Option<i64> {
    let ((ea, a), (eb, b), (ep, p)) = (parts(a), parts(b), parts(p));
    (is_normal(ea) & is_normal(eb) & is_normal(ep))
        .then(|| a.wrapping_mul(b).wrapping_sub(p.wrapping_shl((ep - ea - eb + 1075) as u32)))
}

/// `|a| - |q b|` in units of the last place of the exact `q b`, where `q` is `a / b` rounded to nearest: at most half
/// of the significand of `b`. `None` unless all three are normal numbers.
#[inline(always)]
fn quotient_residual(a: f64, b: f64, q: f64) -> Option<i64> {
    product_residual(q, b, a).map(i64::wrapping_neg)
}

/// `nearest`, a normal number, rounded down: the size of the real result exceeds that of `nearest` by a number of the
/// sign of `residual`. Written without branches, whose outcome would be as random as the last bit.
#[inline(always)]
fn resolve_down(nearest: f64, residual: i64) -> f64 {
    // All ones below zero. There, sizes and bits rise as numbers fall.
    let negative = nearest.to_bits() as i64 >> 63;
    let error = (residual ^ negative) - negative;
    let step = error >> 63;
    f64::from_bits((nearest.to_bits() as i64 + ((step ^ negative) - negative)) as u64)
}

/// Mirror image of [`resolve_down`].
#[inline(always)]
fn resolve_up(nearest: f64, residual: i64) -> f64 {
    let negative = nearest.to_bits() as i64 >> 63;
    let error = (residual ^ negative) - negative;
    let step = -error >> 63;
    f64::from_bits((nearest.to_bits() as i64 - ((step ^ negative) - negative)) as u64)
}

/// `a + b - s` for `s = a + b` rounded: Knuth's TwoSum, exact unless something overflows, and then NaN or infinite.
#[inline(always)]
pub(super) fn sum_residual(a: f64, b: f64, s: f64) -> f64 {
    let second = s - a;
    (a - (s - second)) + (b - second)
}

/// `a + b` rounded down. The sum of opposite infinities is NaN.
#[inline]
pub fn add_down(a: f64, b: f64) -> f64 {
    let s = a + b;
    let residual = sum_residual(a, b, s);
    if !residual.is_finite() {
        return add_down_beyond(a, b, s);
    }
    if residual < 0.0 { s.next_down() } else { s }
}

/// `a + b` rounded up. The sum of opposite infinities is NaN.
#[inline]
pub fn add_up(a: f64, b: f64) -> f64 {
    let s = a + b;
    let residual = sum_residual(a, b, s);
    if !residual.is_finite() {
        return add_up_beyond(a, b, s);
    }
    if residual > 0.0 { s.next_up() } else { s }
}

#[cold]
#[inline(never)]
fn add_down_beyond(a: f64, b: f64, s: f64) -> f64 {
    settle_down(s, sum_error(a, b, s))
}

#[cold]
#[inline(never)]
fn add_up_beyond(a: f64, b: f64, s: f64) -> f64 {
    settle_up(s, sum_error(a, b, s))
}

/// `a - b` rounded down. The difference of equal infinities is NaN.
#[inline]
pub fn sub_down(a: f64, b: f64) -> f64 {
    add_down(a, -b)
}

/// `a - b` rounded up. The difference of equal infinities is NaN.
#[inline]
pub fn sub_up(a: f64, b: f64) -> f64 {
    add_up(a, -b)
}

/// `a * b` rounded down, with 0 * inf = 0: an infinite bound stands for arbitrarily large reals, never for infinity.
#[inline]
pub fn mul_down(a: f64, b: f64) -> f64 {
    let p = a * b;
    match product_residual(a, b, p) {
        Some(residual) => resolve_down(p, residual),
        None => mul_down_beyond(a, b, p),
    }
}

/// As [`mul_down`], where an operand or the result is not a normal number.
#[inline(never)]
fn mul_down_beyond(a: f64, b: f64, p: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { settle_down(p, product_error(a, b, p)) }
}

/// `a * b` rounded up, with 0 * inf = 0 as in [`mul_down`].
#[inline]
pub fn mul_up(a: f64, b: f64) -> f64 {
    let p = a * b;
    match product_residual(a, b, p) {
        Some(residual) => resolve_up(p, residual),
        None => mul_up_beyond(a, b, p),
    }
}

/// As [`mul_up`], where an operand or the result is not a normal number.
#[inline(never)]
fn mul_up_beyond(a: f64, b: f64, p: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { settle_up(p, product_error(a, b, p)) }
}

/// `a / b` rounded down. `b` must not be zero, and not both may be infinite.
#[inline]
pub fn div_down(a: f64, b: f64) -> f64 {
    let q = a / b;
    match quotient_residual(a, b, q) {
        Some(residual) => resolve_down(q, residual),
        None => div_down_beyond(a, b, q),
    }
}

/// As [`div_down`], where an operand or the result is not a normal number.
#[inline(never)]
fn div_down_beyond(a: f64, b: f64, q: f64) -> f64 {
    settle_down(q, quotient_error(a, b, q))
}

/// `a / b` rounded up. `b` must not be zero, and not both may be infinite.
#[inline]
pub fn div_up(a: f64, b: f64) -> f64 {
    let q = a / b;
    match quotient_residual(a, b, q) {
        Some(residual) => resolve_up(q, residual),
        None => div_up_beyond(a, b, q),
    }
}

/// As [`div_up`], where an operand or the result is not a normal number.
#[inline(never)]
fn div_up_beyond(a: f64, b: f64, q: f64) -> f64 {
    settle_up(q, quotient_error(a, b, q))
}

/// Square root of `x >= 0` rounded down.
#[inline]
pub fn sqrt_down(x: f64) -> f64 {
    let r = x.sqrt();
    match quotient_residual(x, r, r) {
        Some(residual) => resolve_down(r, residual),
        None => settle_down(r, root_error(x, r)),
    }
}

/// Square root of `x >= 0` rounded up.
#[inline]
pub fn sqrt_up(x: f64) -> f64 {
    let r = x.sqrt();
    match quotient_residual(x, r, r) {
        Some(residual) => resolve_up(r, residual),
        None => settle_up(r, root_error(x, r)),
    }
}

/// `x` rounded down to `f32`.
pub fn f32_down(x: f64) -> f32 {
    let y = x as f32;
    if f64::from(y) > x { y.next_down() } else { y }
}

/// `x` rounded up to `f32`.
pub fn f32_up(x: f64) -> f32 {
    let y = x as f32;
    if f64::from(y) < x { y.next_up() } else { y }
}

/// `x` rounded down to `f64`: -inf below the finite numbers, the largest finite number above them.
pub fn rational_down(x: &BigRational) -> f64 {
    if x.is_negative() { -magnitude(x, true) } else { magnitude(x, false) }
}

/// `x` rounded up to `f64`: inf above the finite numbers, the least finite number below them.
pub fn rational_up(x: &BigRational) -> f64 {
    if x.is_negative() { -magnitude(x, false) } else { magnitude(x, true) }
}

/// `|x|` rounded towards zero or `away` from it.
fn magnitude(x: &BigRational, away: bool) -> f64 {
    let (n, d) = (x.numer().abs(), x.denom());
    if n.is_zero() {
        return 0.0;
    }
    // With k = bits(n) - bits(d), n/d lies in (2^(k-1), 2^(k+1)); in units of 2^(k-53) that is (2^52, 2^54), so one
    // more halving may be needed to leave 53 bits. Subnormals have the fixed unit 2^-1074.
    let k = n.bits() as i64 - d.bits() as i64;
    let mut unit = (k - 53).max(-1074);
    let (mut units, mut rest) = in_units(&n, d, unit);
    if units.bits() > 53 {
        unit += 1;
        (units, rest) = in_units(&n, d, unit);
    }
    if away && rest {
        units += 1;
    }
    if unit > 971 {
        return if away { f64::INFINITY } else { f64::MAX };
    }
    // At most 2^53 units: exact, and the product is exact too unless it is the overflow 2^53 * 2^971, which is inf.
    let units = units.to_u64().map_or(f64::INFINITY, |m| m as f64);
    units * pow2(unit as i32)
}

/// How many whole `2^unit` fit into `n / d`, and whether something is left over.
fn in_units(n: &BigInt, d: &BigInt, unit: i64) -> (BigInt, bool) {
    let shift = unit.unsigned_abs();
    let (n, d) = if unit < 0 { (n << shift, d.clone()) } else { (n.clone(), d << shift) };
    let (quotient, remainder) = (&n / &d, &n % &d);
    (quotient, remainder.sign() != Sign::NoSign)
}
