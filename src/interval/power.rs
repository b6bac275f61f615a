//! Powers. Those with a rational exponent p/q are tight up to |p| or q of 150, and the others within three units in
//! the last place; an interval as exponent costs two.

use super::{Interval, exact};
use num_integer::Integer;
use std::cmp::Ordering;

impl Interval {
    /// IEEE 1788 `pown`: x^n, with x^0 = 1 everywhere and 0 outside the domain if n < 0.
    pub fn powi(self, n: i32) -> Self {
        self.pow_rational(n, 1)
    }

    /// The real cube root.
    pub fn cbrt(self) -> Self {
        self.pow_rational(1, 3)
    }

    /// IEEE 1788 `rSqrt`: 1 / sqrt(x) for x > 0.
    pub fn rsqrt(self) -> Self {
        self.pow_rational(-1, 2)
    }

    /// IEEE 1788 `rootn`: the real n-th root, of members >= 0 for even n; its reciprocal for n < 0. Empty if n = 0.
    pub fn rootn(self, n: i32) -> Self {
        self.pow_rational(n.signum(), n.unsigned_abs())
    }

    /// x^(p/q) for q >= 1; the fraction need not be reduced. With p/q in lowest terms, an odd q takes the real root,
    /// so that all x are in the domain, and an even q only x >= 0. A negative p takes 0 out of the domain. Empty if q
    /// = 0.
    pub fn pow_rational(self, p: i32, q: u32) -> Self {
        if self.is_empty() || q == 0 {
            return Self::EMPTY;
        }
        let divisor = q.gcd(&p.unsigned_abs());
        // |p| / divisor fits an i32 unless p = i32::MIN stays whole, which i64 holds.
        let (p, q) = ((i64::from(p) / i64::from(divisor)) as i32, q / divisor);
        let x = if q.is_multiple_of(2) { self.intersect(Self::NONNEGATIVE) } else { self };
        if x.is_empty() {
            return Self::EMPTY;
        }
        if p == 0 {
            return Self::ONE;
        }
        if x.lo >= 0.0 {
            return x.pow_nonnegative(p, q);
        }
        // q is odd: x^(p/q) has the parity of p.
        if p % 2 == 0 {
            return x.abs().pow_nonnegative(p, q);
        }
        let (left, right) = (x.intersect(-Self::NONNEGATIVE), x.intersect(Self::NONNEGATIVE));
        // A negative p has a pole at 0, where the two branches go to opposite infinities; the point 0 adds nothing.
        (-(-left).pow_nonnegative(p, q)).hull(right.pow_nonnegative(p, q))
    }

    /// x^(p/q) for a part of [0, inf] that is not empty, p != 0.
    pub(super) fn pow_nonnegative(self, p: i32, q: u32) -> Self {
        if self.is_empty() || p < 0 && self == Self::ZERO {
            return Self::EMPTY;
        }
        let (first, last) = if p > 0 { (self.lo, self.hi) } else { (self.hi, self.lo) };
        Self::raw(power(first, p, q).0, power(last, p, q).1)
    }

    /// x^y as IEEE 1788 has it: for x > 0, and for x = 0 where y > 0.
    pub fn pow(self, y: Self) -> Self {
        let x = self.intersect(Self::NONNEGATIVE);
        if x.is_empty() || y.is_empty() {
            return Self::EMPTY;
        }
        if x == Self::ZERO {
            return if y.hi > 0.0 { Self::ZERO } else { Self::EMPTY };
        }
        // x^y = exp(y ln x), and y ln x is bilinear in (y, ln x): the extremes are at corners, where a bound at 0 or
        // infinity stands for the limit of that product with 0 * inf = 0. A factor 0^y, y > 0 is the limit itself.
        let mut bounds = (f64::INFINITY, 0.0f64);
        for (a, b) in [(x.lo, y.lo), (x.lo, y.hi), (x.hi, y.lo), (x.hi, y.hi)] {
            let corner = power_real(a, b);
            bounds = (bounds.0.min(corner.0), bounds.1.max(corner.1));
        }
        Self::raw(bounds.0, bounds.1)
    }
}

/// Bounds (down, up) of `x^(p/q)` for 0 <= x <= inf and p != 0, with the limits at both ends.
fn power(x: f64, p: i32, q: u32) -> (f64, f64) {
    if x == 1.0 {
        return (1.0, 1.0);
    }
    if x == 0.0 || x.is_infinite() {
        let limit = if (x == 0.0) == (p > 0) { 0.0 } else { f64::INFINITY };
        return (limit, limit);
    }
    if q == 1
        && let Some(bounds) = small_power(x, p)
    {
        return bounds;
    }
    let (guess, steps) = estimate(x, p, q);
    exact::power(x, p, q, guess, |g| compare_powers(g, q, x, p)).unwrap_or_else(|| {
        let (down, up) = exact::widen(guess, steps);
        (down.max(0.0), up)
    })
}

/// What double-double powers lose at most, relative to the power.
const LOST: f64 = 1.0 / (1u128 << 97) as f64;

/// x^n = h + l with |l| <= 2^-53 h, up to an error of [`LOST`], and whether it is exact, for x > 0 and 1 <= n <= 64;
/// `None` if a range is left.
///
/// With h + l the running product, one step computes (h + l) x as RN(h x) + e + RN(l x) with e = h x - RN(h x) exact,
/// and renormalises exactly by Fast2Sum. Two roundings are lost: that of l x, 2^-53 * 2^-53, and that of its sum with
/// e, 2^-53 * 2^-52, relative to h x: less than 2^-104 a step, 63 * 2^-104 < 2^-98 in all.
fn doubled_power(x: f64, n: u32) -> Option<(f64, f64, bool)> {
    if n > 64 {
        return None;
    }
    let (mut h, mut l, mut exact) = (x, 0.0, true);
    for _ in 1..n {
        let product = h * x;
        let tail = h.mul_add(x, -product) + l * x;
        h = product + tail;
        l = tail - (h - product);
        exact &= tail == 0.0;
    }
    // Every partial product lies between x and the last one: none has left the range where errors are exact.
    let in_range = (1e-280..1e280).contains(&h) && (1e-280..1e280).contains(&x);
    in_range.then_some((h, l, exact))
}

/// How `g` > 0 compares with `x^(p/q)`, if double-double powers can tell.
fn compare_powers(g: f64, q: u32, x: f64, p: i32) -> Option<Ordering> {
    // Four times what both powers lose: the rest is for the roundings below, each by 2^-53 of numbers below 2^-51 of
    // the powers, where those are close; where they are not, the sign cannot fail.
    const MARGIN: f64 = 8.0 * LOST;
    let ((gh, gl, _), (xh, xl, _)) = (doubled_power(g, q)?, doubled_power(x, p.unsigned_abs())?);
    let (difference, size) = if p >= 0 {
        ((gh - xh) + (gl - xl), gh + xh)
    } else {
        // g^q x^-p against 1.
        let product = gh * xh;
        ((product - 1.0) + (gh.mul_add(xh, -product) + (gh * xl + gl * xh)), 1.0 + product)
    };
    (difference.abs() > MARGIN * size).then(|| difference.total_cmp(&0.0))
}

/// Bounds of `x^p` for |p| <= 64, by multiplication in double-double arithmetic; `None` if the bits lost there could
/// decide the rounding, or if a range is left.
fn small_power(x: f64, p: i32) -> Option<(f64, f64)> {
    let (mut h, mut l, exact) = doubled_power(x, p.unsigned_abs())?;
    if exact && p > 0 {
        return Some((h, h));
    }
    if p < 0 {
        // One Newton step from r = 1/h rounded: with s = 1 - r (h + l), |s| < 2^-51, the reciprocal is r (1 + s + s^2
        // + ...). The remainder 1 - r h is exact; the roundings of r l, of s and of r s lose less than 2^-103, s^2
        // less than 2^-102: with the above, less than LOST.
        let r = 1.0 / h;
        let step = ((-r).mul_add(h, 1.0) - r * l) * r;
        h = r + step;
        l = step - (h - r);
    }
    // h is h + l rounded: the power lies on the side of l, and less than a unit away.
    match l {
        _ if l.abs() <= LOST * h => None,
        _ if l > 0.0 => Some((h, h.next_up())),
        _ => Some((h.next_down(), h)),
    }
}

/// A number near `x^(p/q)` for finite x > 0, x != 1, and how many neighbours away at most the real one is.
fn estimate(x: f64, p: i32, q: u32) -> (f64, u32) {
    // CORE-MATH rounds correctly: half a unit.
    match (p, q) {
        (1, 1) => return (x, 1),
        (_, 1) => return (core_math::pow(x, f64::from(p)), 1),
        (1, 2) => return (x.sqrt(), 1),
        (1, 3) => return (core_math::cbrt(x), 1),
        _ => {}
    }
    // p/q = y + d with y rounded and d = (p - y q)/q, where the remainder is exact. Then x^(p/q) = x^y x^d and
    // |d ln x| <= 2^-53 |y ln x| < 2^-53 * 746 < 2^-43, as |y ln x| < 746 wherever x^y is neither 0 nor inf. So
    // x^d = 1 + d ln x up to 2^-87; computed, d ln x is off by 2^-50 of itself, 2^-93. One fused operation applies it.
    // The error is half a unit of x^y, half a unit of the result and 2^-34 of a unit; a unit of x^y can be two of the
    // result's if a power of two lies between: 1.5 units and a little.
    let (p, q) = (f64::from(p), f64::from(q));
    let y = p / q;
    let near = core_math::pow(x, y);
    if near == 0.0 {
        // At most 2^-1075 (1 + 2^-43).
        return (near, 1);
    }
    let log = core_math::log(x);
    if near.is_infinite() {
        // e^710 > 1.2 * 2^1024: surely out of range. Else at least the threshold 2^1024 - 2^970 less 2^-43 of it,
        // which is 2^10 units of 2^971.
        return (near, if y * log > 710.0 { 1 } else { 1 << 11 });
    }
    let correction = (-y).mul_add(q, p) / q * log;
    (near.mul_add(correction, near), if correction == 0.0 { 1 } else { 2 })
}

/// Bounds (down, up) of `exp(y ln x)` for 0 <= x <= inf, -inf <= y <= inf, taken as limits with 0 * inf = 0.
fn power_real(x: f64, y: f64) -> (f64, f64) {
    if y == 0.0 || x == 1.0 {
        return (1.0, 1.0);
    }
    if x == 0.0 || x.is_infinite() || y.is_infinite() {
        let limit = if (x < 1.0) == (y > 0.0) { 0.0 } else { f64::INFINITY };
        return (limit, limit);
    }
    // Exact values need a dyadic exponent of small size: then the exact comparison finds them.
    for denominator in [1u32, 2, 4, 8, 16, 32] {
        let numerator = y * f64::from(denominator);
        if numerator.fract() == 0.0 && numerator.abs() <= 1100.0 {
            return power(x, numerator as i32, denominator);
        }
    }
    let (down, up) = exact::widen(core_math::pow(x, y), 1);
    if (x > 1.0) == (y > 0.0) { (down.max(1.0), up) } else { (down.max(0.0), up.min(1.0)) }
}
