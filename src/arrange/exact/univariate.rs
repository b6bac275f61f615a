//! Polynomials of one variable with integer coefficients.

use std::cmp::Ordering;

use num_bigint::BigInt;
use num_bigint::Sign;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::One;
use num_traits::Signed;
use num_traits::Zero;

use crate::arrange::exact::modular;

/// Coefficients by rising power; the last one is not 0.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct Univariate(Vec<BigInt>);

impl Univariate {
    pub fn new(mut coefficients: Vec<BigInt>) -> Self {
        while coefficients.last().is_some_and(Zero::is_zero) {
            coefficients.pop();
        }
        Self(coefficients)
    }

    pub fn constant(value: BigInt) -> Self {
        Self::new(vec![value])
    }

    pub fn one() -> Self {
        Self(vec![BigInt::one()])
    }

    pub fn coefficients(&self) -> &[BigInt] {
        &self.0
    }

    pub fn is_zero(&self) -> bool {
        self.0.is_empty()
    }

    /// Zero or of degree 0.
    pub fn is_constant(&self) -> bool {
        self.0.len() <= 1
    }

    /// The degree; 0 for the zero polynomial too.
    pub fn degree(&self) -> usize {
        self.0.len().saturating_sub(1)
    }

    pub fn leading(&self) -> Option<&BigInt> {
        self.0.last()
    }

    /// The bits of the largest coefficient.
    pub fn bits(&self) -> u64 {
        self.0.iter().map(BigInt::bits).max().unwrap_or(0)
    }

    /// The sum of the coefficients' absolute values.
    pub fn norm(&self) -> BigInt {
        self.0.iter().map(BigInt::abs).sum()
    }

    pub fn add(&self, other: &Self) -> Self {
        let (long, short) = if self.0.len() >= other.0.len() { (self, other) } else { (other, self) };
        let mut sum = long.0.clone();
        sum.iter_mut().zip(&short.0).for_each(|(a, b)| *a += b);
        Self::new(sum)
    }

    pub fn sub(&self, other: &Self) -> Self {
        self.add(&other.scale(&BigInt::from(-1)))
    }

    pub fn mul(&self, other: &Self) -> Self {
        if self.is_zero() || other.is_zero() {
            return Self::default();
        }
        let mut product = vec![BigInt::zero(); self.0.len() + other.0.len() - 1];
        for (i, a) in self.0.iter().enumerate().filter(|(_, a)| !a.is_zero()) {
            for (j, b) in other.0.iter().enumerate() {
                product[i + j] += a * b;
            }
        }
        Self::new(product)
    }

    pub fn scale(&self, factor: &BigInt) -> Self {
        Self::new(self.0.iter().map(|c| c * factor).collect())
    }

    pub fn derivative(&self) -> Self {
        Self::new(self.0.iter().enumerate().skip(1).map(|(i, c)| c * i).collect())
    }

    /// The greatest common divisor of the coefficients; 0 for the zero polynomial.
    pub fn content(&self) -> BigInt {
        let mut content = BigInt::zero();
        for c in &self.0 {
            content = content.gcd(c);
            if content.is_one() {
                break;
            }
        }
        content
    }

    /// Without its content, and with a positive leading coefficient.
    pub fn primitive(&self) -> Self {
        let Some(lead) = self.leading() else { return Self::default() };
        let mut content = self.content();
        if lead.is_negative() {
            content = -content;
        }
        if content.is_one() { self.clone() } else { Self(self.0.iter().map(|c| c / &content).collect()) }
    }

    /// The quotient, if the other divides it over the integers.
    pub fn divide(&self, other: &Self) -> Option<Self> {
        let lead = other.leading()?;
        if self.is_zero() {
            return Some(Self::default());
        }
        let steps = (self.0.len() + 1).checked_sub(other.0.len())?;
        if steps == 0 || other.0.first().is_some_and(|c| !c.is_zero() && !self.0[0].is_multiple_of(c)) {
            return None;
        }
        let mut rest = self.0.clone();
        let mut quotient = vec![BigInt::zero(); steps];
        for i in (0..steps).rev() {
            let (q, r) = rest[i + other.0.len() - 1].div_rem(lead);
            if !r.is_zero() {
                return None;
            }
            if !q.is_zero() {
                for (j, c) in other.0.iter().enumerate() {
                    rest[i + j] -= &q * c;
                }
            }
            quotient[i] = q;
        }
        rest.iter().all(Zero::is_zero).then(|| Self::new(quotient))
    }

    /// `l^e self` modulo the other polynomial, where `l` is its leading coefficient and `e` how often it was needed.
    pub fn pseudo_remainder(&self, other: &Self) -> (Self, u32) {
        let Some(lead) = other.leading() else { return (self.clone(), 0) };
        let m = other.0.len();
        let mut rest = self.0.clone();
        let mut exponent = 0;
        while rest.len() >= m {
            let top = rest.pop().unwrap_or_default();
            if top.is_zero() {
                continue;
            }
            rest.iter_mut().for_each(|c| *c *= lead);
            exponent += 1;
            let offset = rest.len() + 1 - m;
            for (j, c) in other.0[..m - 1].iter().enumerate() {
                rest[offset + j] -= &top * c;
            }
        }
        (Self::new(rest), exponent)
    }

    /// The sign at a rational number.
    pub fn sign_at(&self, x: &BigRational) -> Ordering {
        sign(&self.numerator_at(x))
    }

    /// The value at `p/q` times `q^degree`.
    pub fn numerator_at(&self, x: &BigRational) -> BigInt {
        let (p, q) = (x.numer(), x.denom());
        let mut power = BigInt::one();
        let mut sum = BigInt::zero();
        for c in self.0.iter().rev() {
            sum = sum * p + c * &power;
            power *= q;
        }
        sum
    }

    /// Modulo the prime of a field; leading zeros are kept.
    pub fn modulo(&self, field: modular::Field) -> Vec<u64> {
        self.0.iter().map(|c| field.of(c)).collect()
    }

    /// The primitive greatest common divisor, by images modulo primes; what it returns divides both, and no image has
    /// a divisor of higher degree.
    pub fn gcd(&self, other: &Self) -> Self {
        let (a, b) = (self.primitive(), other.primitive());
        let (Some(lead_a), Some(lead_b)) = (a.leading(), b.leading()) else {
            return if a.is_zero() { b } else { a };
        };
        if a.is_constant() || b.is_constant() {
            return Self::one();
        }
        let lead = lead_a.gcd(lead_b);
        let mut images = Images::default();
        let mut last = Self::default();
        for index in 0.. {
            let field = modular::field(index);
            let (image_a, image_b) = (a.modulo(field), b.modulo(field));
            if image_a.last() == Some(&0) || image_b.last() == Some(&0) {
                continue;
            }
            let mut image = field.gcd(&image_a, &image_b);
            if image.len() == 1 {
                return Self::one();
            }
            let scale = field.of(&lead);
            image.iter_mut().for_each(|c| *c = field.mul(*c, scale));
            // An image of a higher degree belongs to an unlucky prime; one of a lower degree shows that all before were.
            match image.len().cmp(&images.values.len()) {
                Ordering::Greater if !images.values.is_empty() => continue,
                Ordering::Equal => {}
                _ => images = Images::new(image.len()),
            }
            images.include(field, &image);
            let candidate = Self::new(images.integers()).primitive();
            if candidate == last && a.divide(&candidate).is_some() && b.divide(&candidate).is_some() {
                return candidate;
            }
            last = candidate;
        }
        Self::one()
    }

    /// Square-free factors that are coprime, with their multiplicities (Yun 1976); constants are left out.
    pub fn square_free(&self) -> Vec<(Self, u32)> {
        let mut factors = Vec::new();
        let f = self.primitive();
        if f.is_constant() {
            return factors;
        }
        let derivative = f.derivative();
        let common = f.gcd(&derivative);
        let (Some(mut b), Some(c)) = (f.divide(&common), derivative.divide(&common)) else { return factors };
        let mut d = c.sub(&b.derivative());
        let mut multiplicity = 1;
        while !b.is_constant() {
            let factor = if d.is_zero() { b.clone() } else { b.gcd(&d) };
            let (Some(next), Some(c)) = (b.divide(&factor), d.divide(&factor)) else { break };
            if !factor.is_constant() {
                factors.push((factor, multiplicity));
            }
            d = c.sub(&next.derivative());
            b = next;
            multiplicity += 1;
        }
        factors
    }
}

/// The sign of an integer.
pub fn sign(number: &BigInt) -> Ordering {
    match number.sign() {
        Sign::Minus => Ordering::Less,
        Sign::NoSign => Ordering::Equal,
        Sign::Plus => Ordering::Greater,
    }
}

/// Integers known modulo a growing product of primes (Garner's mixed radix).
#[derive(Debug, Default)]
pub struct Images {
    values: Vec<BigInt>,
    modulus: BigInt,
}

impl Images {
    pub fn new(count: usize) -> Self {
        Self { values: vec![BigInt::zero(); count], modulus: BigInt::one() }
    }

    /// Takes the residues modulo one more prime in.
    pub fn include(&mut self, field: modular::Field, image: &[u64]) {
        let inverse = field.inv(field.of(&self.modulus));
        for (value, &residue) in self.values.iter_mut().zip(image) {
            let step = field.mul(field.sub(residue, field.of(value)), inverse);
            *value += &self.modulus * field.residue(step);
        }
        self.modulus *= field.prime();
    }

    /// The bits of the product of the primes, rounded down.
    pub fn bits(&self) -> u64 {
        self.modulus.bits().saturating_sub(1)
    }

    /// The integers of least absolute value with these residues.
    pub fn integers(&self) -> Vec<BigInt> {
        let half = &self.modulus >> 1u32;
        self.values.iter().map(|value| if *value > half { value - &self.modulus } else { value.clone() }).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn poly(coefficients: &[i64]) -> Univariate {
        Univariate::new(coefficients.iter().map(|&c| BigInt::from(c)).collect())
    }

    #[test]
    fn greatest_common_divisors_are_primitive_and_complete() {
        let (a, b, c) = (poly(&[-1, 3]), poly(&[5, 0, 0, 7]), poly(&[2, 1, 9]));
        assert_eq!(a.mul(&b).gcd(&a.mul(&c)), a);
        assert_eq!(b.scale(&BigInt::from(6)).gcd(&c), Univariate::one());
        let large = poly(&[1, i64::MAX, 3]).mul(&poly(&[i64::MAX - 4, 17, i64::MAX]));
        assert_eq!(large.mul(&b).gcd(&large.mul(&c)), large.primitive());
        assert_eq!(poly(&[]).gcd(&c), c);
    }

    #[test]
    fn square_free_factors_carry_their_multiplicities() {
        let (a, b, c) = (poly(&[-1, 3]), poly(&[5, 0, 7]), poly(&[2, 1]));
        let product = a.mul(&b).mul(&b).mul(&c).mul(&c).mul(&c);
        assert_eq!(product.square_free(), vec![(a, 1), (b, 2), (c, 3)]);
        assert_eq!(poly(&[0, 0, 5]).square_free(), vec![(poly(&[0, 1]), 2)]);
        assert!(poly(&[7]).square_free().is_empty());
    }

    #[test]
    fn division_is_exact_or_refused() {
        let (a, b) = (poly(&[-1, 3]), poly(&[5, 0, 7]));
        assert_eq!(a.mul(&b).divide(&b), Some(a.clone()));
        assert_eq!(a.mul(&b).add(&poly(&[1])).divide(&b), None);
        assert_eq!(a.divide(&b), None);
        let (rest, exponent) = b.pseudo_remainder(&a);
        assert_eq!((rest, exponent), (poly(&[52]), 2));
    }
}
