//! Polynomials along rays with exact rational coefficients, and an exact proof that one has no zero on a stretch: what
//! the answers of the ray caster are held against.

use std::ops::Add;
use std::ops::Mul;
use std::ops::Neg;
use std::ops::Sub;

use imp::render::Ray;
use num_bigint::BigInt;
use num_traits::One;
use num_traits::Signed;
use num_traits::Zero;

use crate::plain::Number;
use crate::plain::Surface;

/// Bits of the golden ratio, the one irrational number of these surfaces. It moves values by less than 2^-500.
const PHI_BITS: u64 = 512;

/// Halvings after which a stretch that still may hold a zero is taken to hold one.
const HALVINGS: usize = 200;

/// A polynomial in s: the sum of coefficients[i] s^i, divided by 2^shift and by the positive divisor.
#[derive(Debug, Clone)]
pub struct Polynomial {
    coefficients: Vec<BigInt>,
    shift: u64,
    divisor: BigInt,
}

impl Polynomial {
    /// A finite number, exactly.
    pub fn number(x: f64) -> Self {
        let bits = x.to_bits();
        let exponent = (bits >> 52 & 0x7ff) as i64;
        let fraction = bits & ((1 << 52) - 1);
        let (mantissa, power) = if exponent == 0 { (fraction, -1074) } else { (fraction | 1 << 52, exponent - 1075) };
        let zeros = if mantissa == 0 { 0 } else { mantissa.trailing_zeros() };
        let (mantissa, power) = (BigInt::from(mantissa >> zeros), power + i64::from(zeros));
        let mantissa = if x < 0.0 { -mantissa } else { mantissa };
        let (number, shift) = if power >= 0 { (mantissa << power as u64, 0) } else { (mantissa, -power as u64) };
        Self { coefficients: vec![number], shift, divisor: BigInt::one() }
    }

    /// s itself.
    fn s() -> Self {
        Self { coefficients: vec![BigInt::zero(), BigInt::one()], shift: 0, divisor: BigInt::one() }
    }

    /// Both polynomials over one denominator.
    fn aligned(self, other: Self) -> (Vec<BigInt>, Vec<BigInt>, u64, BigInt) {
        let shift = self.shift.max(other.shift);
        let same = self.divisor == other.divisor;
        let scale = |p: &Self, other: &BigInt| -> Vec<BigInt> {
            let factor = if same { BigInt::one() } else { other.clone() } << (shift - p.shift);
            p.coefficients.iter().map(|c| c * &factor).collect()
        };
        let (a, b) = (scale(&self, &other.divisor), scale(&other, &self.divisor));
        let divisor = if same { self.divisor } else { self.divisor * other.divisor };
        (a, b, shift, divisor)
    }

    /// The coefficients for the Bernstein basis on [0, 1], all times one positive number:
    /// b_j = sum over i <= j of C(j, i) / C(n, i) a_i (Farouki and Rajan 1987, eq. 6), times n!.
    fn bernstein(&self) -> Vec<BigInt> {
        let n = self.coefficients.len() - 1;
        let mut factorials = vec![BigInt::one()];
        for i in 1..=n {
            factorials.push(&factorials[i - 1] * i);
        }
        (0..=n)
            .map(|j| {
                let term = |i: usize| {
                    let choose = &factorials[j] / (&factorials[i] * &factorials[j - i]);
                    choose * &factorials[i] * &factorials[n - i] * &self.coefficients[i]
                };
                (0..=j).map(term).sum()
            })
            .collect()
    }
}

impl Number for Polynomial {
    fn ratio(numerator: i64, denominator: i64) -> Self {
        assert!(denominator > 0, "a positive denominator");
        Self { coefficients: vec![numerator.into()], shift: 0, divisor: denominator.into() }
    }

    fn phi() -> Self {
        let root = (BigInt::from(5) << (2 * PHI_BITS)).sqrt();
        Self { coefficients: vec![(BigInt::one() << PHI_BITS) + root], shift: PHI_BITS + 1, divisor: BigInt::one() }
    }
}

impl Add for Polynomial {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (mut a, mut b, shift, divisor) = self.aligned(other);
        if a.len() < b.len() {
            std::mem::swap(&mut a, &mut b);
        }
        for (a, b) in a.iter_mut().zip(b) {
            *a += b;
        }
        Self { coefficients: a, shift, divisor }
    }
}

impl Neg for Polynomial {
    type Output = Self;

    fn neg(mut self) -> Self {
        for c in &mut self.coefficients {
            *c = -std::mem::take(c);
        }
        self
    }
}

impl Sub for Polynomial {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Polynomial {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let mut coefficients = vec![BigInt::zero(); self.coefficients.len() + other.coefficients.len() - 1];
        for (i, a) in self.coefficients.iter().enumerate().filter(|(_, a)| !a.is_zero()) {
            for (j, b) in other.coefficients.iter().enumerate() {
                coefficients[i + j] += a * b;
            }
        }
        Self { coefficients, shift: self.shift + other.shift, divisor: self.divisor * other.divisor }
    }
}

/// The point at t = start + (end - start) s on a ray.
fn along(ray: &Ray, start: f64, end: f64) -> [Polynomial; 3] {
    let number = Polynomial::number;
    let t = number(start) + (number(end) - number(start)) * Polynomial::s();
    [0, 1, 2].map(|c| number(ray.origin[c]) + number(ray.direction[c]) * t.clone())
}

/// The sign of the surface's polynomial at one point of a ray: -1, 0 or 1.
pub fn sign<S: Surface>(ray: &Ray, t: f64) -> i32 {
    sign_of(&S::value(along(ray, t, t)).coefficients[0])
}

fn sign_of(number: &BigInt) -> i32 {
    i32::from(number.is_positive()) - i32::from(number.is_negative())
}

/// Whether the surface's polynomial is proved to have no zero on a ray from start to end, both included.
pub fn is_clear<S: Surface>(ray: &Ray, start: f64, end: f64) -> bool {
    has_no_zero(&S::value(along(ray, start, end)))
}

/// Whether the surface's poles are proved to lie elsewhere on a ray; so they do if it has none.
pub fn is_defined<S: Surface>(ray: &Ray, start: f64, end: f64) -> bool {
    S::pole(along(ray, start, end)).is_none_or(|pole| has_no_zero(&pole))
}

/// Whether a polynomial is proved to have no zero on [0, 1]: its Bernstein coefficients have one sign, on each of the
/// parts into which halving cuts it.
fn has_no_zero(polynomial: &Polynomial) -> bool {
    let mut parts = vec![(polynomial.bernstein(), 0)];
    while let Some((part, depth)) = parts.pop() {
        let signs: Vec<i32> = part.iter().map(sign_of).collect();
        let (first, last) = (signs[0], signs[signs.len() - 1]);
        if first == 0 || first != last || depth == HALVINGS {
            return false;
        }
        if signs.iter().any(|&sign| sign == -first) {
            let (left, right) = halves(part);
            parts.extend([(right, depth + 1), (left, depth + 1)]);
        }
    }
    true
}

/// De Casteljau's algorithm at 1/2, in integers: both halves times one power of two.
fn halves(mut part: Vec<BigInt>) -> (Vec<BigInt>, Vec<BigInt>) {
    let n = part.len() - 1;
    let (mut left, mut right) = (Vec::with_capacity(n + 1), vec![BigInt::zero(); n + 1]);
    for level in 0..=n {
        left.push(&part[0] << (n - level));
        right[n - level] = &part[n - level] << (n - level);
        for i in 0..n - level {
            part[i] = &part[i] + &part[i + 1];
        }
    }
    (reduced(left), reduced(right))
}

/// Without the power of two that all have in common.
fn reduced(mut part: Vec<BigInt>) -> Vec<BigInt> {
    let zeros = part.iter().filter_map(BigInt::trailing_zeros).min().unwrap_or(0);
    for c in &mut part {
        *c >>= zeros;
    }
    part
}
