//! Directed rounding by exact comparison, for the functions whose error no `f64` holds: fused multiply-add, hypotenuse,
//! and powers with a rational exponent. Slow where it must be, and tight.

use super::round;
use num_bigint::BigInt;
use num_traits::Zero;
use std::cmp::Ordering;

/// The real number `significand * 2^exponent`.
#[derive(Clone)]
struct Dyadic {
    significand: BigInt,
    exponent: i64,
}

impl Dyadic {
    /// The finite number `x`, with an odd significand unless it is 0.
    fn new(x: f64) -> Self {
        let bits = x.to_bits();
        let field = (bits >> 52 & 0x7ff) as i64;
        let fraction = (bits & ((1 << 52) - 1)) as i64;
        let (m, e) = if field == 0 { (fraction, -1074) } else { (fraction | 1 << 52, field - 1075) };
        let shift = if m == 0 { 0 } else { i64::from(m.trailing_zeros()) };
        let m = m >> shift;
        Self { significand: BigInt::from(if x < 0.0 { -m } else { m }), exponent: e + shift }
    }

    fn mul(&self, other: &Self) -> Self {
        Self { significand: &self.significand * &other.significand, exponent: self.exponent + other.exponent }
    }

    fn pow(&self, n: u32) -> Self {
        Self { significand: self.significand.pow(n), exponent: self.exponent * i64::from(n) }
    }

    fn sum(&self, other: &Self) -> Self {
        let exponent = self.exponent.min(other.exponent);
        let shifted = |x: &Self| &x.significand << (x.exponent - exponent).unsigned_abs();
        Self { significand: shifted(self) + shifted(other), exponent }
    }

    fn compare(&self, other: &Self) -> Ordering {
        if self.significand.is_zero()
            || other.significand.is_zero()
            || self.significand.sign() != other.significand.sign()
        {
            return self.significand.cmp(&other.significand);
        }
        // Magnitudes that differ in their leading bit need no alignment.
        let lead = |x: &Self| x.significand.bits() as i64 + x.exponent;
        let by_lead = lead(self).cmp(&lead(other));
        if by_lead != Ordering::Equal {
            return if self.significand.sign() == num_bigint::Sign::Minus { by_lead.reverse() } else { by_lead };
        }
        let exponent = self.exponent.min(other.exponent);
        let shifted = |x: &Self| &x.significand << (x.exponent - exponent).unsigned_abs();
        shifted(self).cmp(&shifted(other))
    }
}

/// The two neighbours (down, up) of a real number, both equal to it if it is a `f64`. `guess` is near it; `side(g)`
/// says exactly how the finite `g` compares with it.
fn bracket(guess: f64, side: impl Fn(f64) -> Ordering) -> (f64, f64) {
    // Infinities lie outside all reals: they bound without a question.
    let compare = |g: f64| match g {
        f64::INFINITY => Ordering::Greater,
        f64::NEG_INFINITY => Ordering::Less,
        _ => side(g),
    };
    let mut down = guess;
    let mut order = compare(down);
    if order == Ordering::Less {
        // Climb to the first number that is not below.
        let mut up = down.next_up();
        loop {
            match compare(up) {
                Ordering::Less => (down, up) = (up, up.next_up()),
                Ordering::Equal => return (up, up),
                Ordering::Greater => return (down, up),
            }
        }
    }
    let mut up = down;
    while order == Ordering::Greater {
        (down, up) = (down.next_down(), down);
        order = compare(down);
    }
    if order == Ordering::Equal { (down, down) } else { (down, up) }
}

/// The error of a product is a `f64` if the product is at least this large: see `round`. Squares of numbers between the
/// square roots of these two, and their sums, are exact as pairs of `f64`.
const LEAST: f64 = round::pow2(-960);
const MOST: f64 = round::pow2(960);

/// Bounds (down, up) of `a b + c` with 0 * inf = 0; an infinite `c` settles the result, whatever the product.
pub(super) fn mul_add(a: f64, b: f64, c: f64) -> (f64, f64) {
    if a == 0.0 || b == 0.0 || c.is_infinite() {
        return (c, c);
    }
    if a.is_infinite() || b.is_infinite() {
        let product = a * b;
        return (product, product);
    }
    if let Some(bounds) = mul_add_in_range(a, b, c) {
        return bounds;
    }
    let value = Dyadic::new(a).mul(&Dyadic::new(b)).sum(&Dyadic::new(c));
    bracket(a.mul_add(b, c), |g| Dyadic::new(g).compare(&value))
}

/// As [`mul_add`], in `f64` alone; `None` where the sum cancels or numbers are very large or small.
///
/// a b = p + e and p + c = s + t, t + e = u + v, s + u = r + w, all exactly (TwoProduct, then TwoSum thrice), so that
/// a b + c = r + (w + v), and the rounded w + v has the sign of the real one. With ulp(x) the unit of x,
/// |w| <= ulp(r)/2, or half of that below a power of two, and |v| <= ulp(u)/2 <= ulp(r)/8 as |u| <= |r|/4: the value
/// lies between r and its neighbour on that side.
fn mul_add_in_range(a: f64, b: f64, c: f64) -> Option<(f64, f64)> {
    let p = a * b;
    let in_range = |x: f64| (LEAST..MOST).contains(&x.abs());
    if !in_range(p) || !(c == 0.0 || in_range(c)) {
        return None;
    }
    let e = a.mul_add(b, -p);
    let two_sum = |x: f64, y: f64| (x + y, round::sum_residual(x, y, x + y));
    let (s, t) = two_sum(p, c);
    let (u, v) = two_sum(t, e);
    let (r, w) = two_sum(s, u);
    // e and all that follows are multiples of 2^-1066, so that nothing underflows.
    if u.abs() > r.abs() / 4.0 {
        return None;
    }
    Some(match w + v {
        0.0 => (r, r),
        rest if rest > 0.0 => (r, r.next_up()),
        _ => (r.next_down(), r),
    })
}

/// Bounds (down, up) of `sqrt(x^2 + y^2)` for nonnegative arguments.
pub(super) fn hypot(x: f64, y: f64) -> (f64, f64) {
    if x == 0.0 || y == 0.0 || x.is_infinite() || y.is_infinite() {
        let h = x.max(y);
        return (h, h);
    }
    let h = core_math::hypot(x, y);
    match hypot_side(x, y, h) {
        Some(Ordering::Greater) => return (h, h.next_up()),
        Some(Ordering::Less) => return (h.next_down(), h),
        _ => {}
    }
    let value = Dyadic::new(x).pow(2).sum(&Dyadic::new(y).pow(2));
    // Both sides are nonnegative: squaring keeps the order. A guess never descends below max(x, y) > 0.
    bracket(h, |g| Dyadic::new(g).pow(2).compare(&value))
}

/// How `sqrt(x^2 + y^2)` compares with `h`, which is that number rounded to nearest, where `f64` can tell.
///
/// x^2 + y^2 - h^2 is a sum of six numbers: each square is a rounded one p and its error e, |e| <= 2^-53 p. The leading
/// ones are (a, b) = TwoSum(px, py), and a - ph, exact since ph is within 2^-51 of a. What then remains to be added
/// rounds four times, each time less than 2^-50 h^2 by 2^-53 of it: 2^-101 h^2 in all.
fn hypot_side(x: f64, y: f64, h: f64) -> Option<Ordering> {
    const LOST: f64 = round::pow2(-100);
    let square = |z: f64| (z * z, z.mul_add(z, -(z * z)));
    let ((px, ex), (py, ey), (ph, eh)) = (square(x), square(y), square(h));
    if px.min(py) < LEAST || ph > MOST {
        return None;
    }
    let a = px + py;
    let rest = (a - ph) + (round::sum_residual(px, py, a) + ((ex + ey) - eh));
    (rest.abs() > LOST * ph).then(|| rest.total_cmp(&0.0))
}

/// Significands of more bits than this are not raised: the bounds come from an estimate instead.
const POWER_BITS: u64 = 1 << 13;

/// Bounds (down, up) of `x^(p/q)` for finite `x > 0`, if `x^p` and the `q`-th power of the result are small enough to
/// be written out. `guess` is near the result and not negative; `quick` compares a positive number with the result
/// where that is easy.
pub(super) fn power(x: f64, p: i32, q: u32, guess: f64, quick: impl Fn(f64) -> Option<Ordering>) -> Option<(f64, f64)> {
    let x = Dyadic::new(x);
    let result_bits = 53;
    if x.significand.bits() * u64::from(p.unsigned_abs()) > POWER_BITS || result_bits * u64::from(q) > POWER_BITS {
        return None;
    }
    let powered = || x.pow(p.unsigned_abs());
    Some(bracket(guess, |g| {
        // g against x^(p/q) is g^q against x^p, or g^q x^-p against 1. Bracketing starts from g >= 0 and passes 0 at
        // most by one step, to a negative number that is below.
        if g < 0.0 {
            return Ordering::Less;
        }
        quick(g).unwrap_or_else(|| {
            let g = Dyadic::new(g).pow(q);
            if p >= 0 { g.compare(&powered()) } else { g.mul(&powered()).compare(&Dyadic::new(1.0)) }
        })
    }))
}

/// Bounds (down, up) that enclose a real number given to within `steps` neighbours.
pub(super) fn widen(nearest: f64, steps: u32) -> (f64, f64) {
    let mut bounds = (nearest, nearest);
    for _ in 0..steps {
        bounds = (bounds.0.next_down(), bounds.1.next_up());
    }
    bounds
}

/// Whether the first of two bounded sets is the wider, by the real difference of their bounds.
pub(super) fn is_wider(a: (f64, f64), b: (f64, f64)) -> bool {
    let width = |(lo, hi): (f64, f64)| Dyadic::new(hi).sum(&Dyadic::new(-lo));
    width(a).compare(&width(b)) == Ordering::Greater
}
