//! Curves over one algebraic number: the polynomials in y that remain at a root of a polynomial in x.

use std::cmp::Ordering;
use std::collections::HashMap;

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::One;
use num_traits::ToPrimitive;

use crate::arrange::exact::fixed::Fixed;
use crate::arrange::exact::fixed::Range;
use crate::arrange::exact::fixed::Undecided;
use crate::arrange::exact::polynomial::Polynomial;
use crate::arrange::exact::roots;
use crate::arrange::exact::roots::Place;
use crate::arrange::exact::subresultant;
use crate::arrange::exact::subresultant::TooLarge;
use crate::arrange::exact::univariate::Univariate;

/// Enclosures are not refined beyond this.
const MAX_BITS: u64 = 8192;

/// Field operations in one subresultant: about a quarter of a second.
const MAX_WORK: u64 = 50_000_000;

/// A vertical line x = a, where a is a root of a polynomial. Zero tests split that polynomial where they can (dynamic
/// evaluation, Della Dora, Dicrescenzo, Duval 1985), so that it becomes simpler with use.
#[derive(Debug, Clone)]
pub struct Fibre {
    /// Square-free, with a positive leading coefficient; linear if the number is rational.
    modulus: Univariate,
    /// Has no other root of the polynomial in it, nor at its ends.
    place: Place,
    /// Common divisors found so far.
    known: HashMap<(Polynomial, Polynomial), Polynomial>,
}

impl Fibre {
    /// The line at the root of a square-free polynomial in this place.
    pub fn new(modulus: &Univariate, place: Place) -> Self {
        let mut fibre = Self { modulus: modulus.primitive(), place, known: HashMap::new() };
        let is_root = |x: &BigRational| modulus.sign_at(x) == Ordering::Equal;
        while !fibre.place.is_exact() && (is_root(&fibre.place.lo) || is_root(&fibre.place.hi)) {
            fibre.place.bisect(modulus);
        }
        // Numbers with denominators up to 2^24 are found out here; all others are treated as algebraic.
        fibre.place.refine(modulus, &BigRational::new(BigInt::one(), BigInt::one() << 49));
        if !fibre.place.is_exact() {
            let simple = roots::simplest_between(&fibre.place.lo, &fibre.place.hi);
            if is_root(&simple) {
                fibre.place = Place { lo: simple.clone(), hi: simple };
            }
        }
        if fibre.place.is_exact() {
            let x = &fibre.place.lo;
            fibre.modulus = Univariate::new(vec![-x.numer(), x.denom().clone()]);
        } else if fibre.modulus.degree() == 1 {
            let c = fibre.modulus.coefficients();
            let x = BigRational::new(-&c[0], c[1].clone());
            fibre.place = Place { lo: x.clone(), hi: x };
        }
        fibre
    }

    /// The number as a fraction, if it is known as one.
    fn rational(&self) -> Option<&BigRational> {
        self.place.is_exact().then_some(&self.place.lo)
    }

    /// The place of the number, refined to floating-point numbers.
    pub fn x(&mut self) -> Place {
        self.place.tighten(&self.modulus);
        self.place.clone()
    }

    /// Whether a polynomial in x vanishes.
    pub fn is_zero(&mut self, poly: &Univariate) -> bool {
        if poly.is_constant() {
            return poly.is_zero();
        }
        if let Some(x) = self.rational() {
            return poly.sign_at(x) == Ordering::Equal;
        }
        let fixed = Fixed { bits: 64 + poly.bits() };
        let value = fixed.evaluate(poly, &fixed.between(&self.place.lo, &self.place.hi));
        if value.sign().is_some_and(Ordering::is_ne) {
            return false;
        }
        let common = self.modulus.gcd(poly);
        if common.is_constant() {
            return false;
        }
        let vanishes = common.sign_at(&self.place.lo) != common.sign_at(&self.place.hi);
        let part = if vanishes { Some(common) } else { self.modulus.divide(&common) };
        if let Some(part) = part {
            self.modulus = part;
        }
        vanishes
    }

    /// A polynomial with the same values up to a positive factor, whose leading coefficient does not vanish.
    pub fn reduce(&mut self, poly: &Polynomial) -> Polynomial {
        let mut reduced = match self.rational() {
            Some(x) => constant_rows(&poly.at_x(x)),
            None => self.shortened(poly),
        };
        while !reduced.is_zero() && self.is_zero(&reduced.leading()) {
            reduced = reduced.reductum();
        }
        reduced
    }

    /// A polynomial with the same values up to a positive factor: of lower degree in x, unless its coefficients would grow
    /// more than that is worth.
    fn shortened(&self, poly: &Polynomial) -> Polynomial {
        let steps = (poly.degree_x() + 1).saturating_sub(self.modulus.degree()) as u64;
        let growth = steps * self.modulus.bits();
        if steps == 0 || growth > poly.bits() + 64 { poly.clone() } else { poly.reduce(&self.modulus) }
    }

    /// The greatest common divisor of two polynomials that do not vanish identically here.
    fn gcd(&mut self, f: &Polynomial, g: &Polynomial) -> Result<Polynomial, TooLarge> {
        if self.rational().is_some() {
            return Ok(constant_rows(&constants(f).gcd(&constants(g))));
        }
        let (n, m) = (f.degree_y(), g.degree_y());
        // The first subresultant whose leading coefficient does not vanish (Basu, Pollack, Roy, "Algorithms in real
        // algebraic geometry", 2006, proposition 4.25 and theorem 8.56).
        for k in 0..n.min(m) {
            let candidate = subresultant::subresultant(f, g, k, MAX_WORK)?;
            if candidate.degree_y() == k && !candidate.is_zero() && !self.is_zero(&candidate.leading()) {
                return Ok(self.shortened(&candidate));
            }
        }
        Ok(if n <= m { f.clone() } else { g.clone() })
    }

    /// The polynomial whose roots in an open interval are the common roots there.
    pub fn common(&mut self, f: &Polynomial, g: &Polynomial) -> Result<Polynomial, TooLarge> {
        let key = (f.clone(), g.clone());
        if let Some(known) = self.known.get(&key) {
            return Ok(known.clone());
        }
        let common = self.find_common(f, g)?;
        self.known.insert(key, common.clone());
        Ok(common)
    }

    fn find_common(&mut self, f: &Polynomial, g: &Polynomial) -> Result<Polynomial, TooLarge> {
        let (f, g) = (self.reduce(f), self.reduce(g));
        if f.is_zero() {
            return Ok(g);
        }
        if g.is_zero() {
            return Ok(f);
        }
        self.gcd(&f, &g)
    }

    /// The distinct real roots in an open interval at whose ends there are none, each in a place no wider than `width`
    /// if it is the only one. The polynomial must not vanish identically here.
    pub fn roots(
        &mut self,
        poly: &Polynomial,
        lo: &BigRational,
        hi: &BigRational,
        width: Option<&BigRational>,
    ) -> Result<Vec<Place>, TooLarge> {
        let f = self.reduce(poly);
        if f.degree_y() == 0 {
            return Ok(Vec::new());
        }
        if self.rational().is_some() {
            let f = constants(&f);
            let free = f.divide(&f.gcd(&f.derivative())).unwrap_or(f);
            let mut places = roots::isolate(&free, lo, hi).ok_or(TooLarge)?;
            if let ([place], Some(width)) = (places.as_mut_slice(), width) {
                place.refine(&free, width);
                place.tighten(&free);
            }
            return Ok(places);
        }
        let repeated = if f.degree_y() == 1 { None } else { Some(self.common(&f, &f.derivative_y())?) };
        let span = (hi - lo).to_f64().map_or(0.0, |span| (-span.log2()).max(0.0)) as u64;
        let mut bits = 192 + f.degree_y() as u64 * span + 2 * f.bits().min(512);
        while bits <= MAX_BITS {
            if let Ok(places) = self.attempt(&f, repeated.as_ref(), [lo, hi], width, bits) {
                return Ok(places);
            }
            bits *= 2;
        }
        Err(TooLarge)
    }

    fn attempt(
        &mut self,
        f: &Polynomial,
        repeated: Option<&Polynomial>,
        [lo, hi]: [&BigRational; 2],
        width: Option<&BigRational>,
        bits: u64,
    ) -> Result<Vec<Place>, Undecided> {
        let fixed = Fixed { bits };
        self.place.refine(&self.modulus, &BigRational::new(BigInt::one(), BigInt::one() << bits));
        let x = fixed.between(&self.place.lo, &self.place.hi);
        let values =
            |poly: &Polynomial| -> Vec<Range> { poly.rows().iter().map(|row| fixed.evaluate(row, &x)).collect() };
        let mut free = values(f);
        if let Some(repeated) = repeated.filter(|repeated| repeated.degree_y() > 0) {
            free = fixed.quotient(&free, &values(repeated))?;
        }
        let mut places = fixed.isolate(&free, lo, hi)?;
        if let ([place], Some(width)) = (places.as_mut_slice(), width) {
            *place = fixed.refine(&free, place, width)?;
        }
        Ok(places)
    }
}

/// A polynomial in y as one in x and y.
fn constant_rows(poly: &Univariate) -> Polynomial {
    Polynomial::new(poly.coefficients().iter().map(|c| Univariate::constant(c.clone())).collect())
}

/// A polynomial in y alone as such.
fn constants(poly: &Polynomial) -> Univariate {
    Univariate::new(poly.rows().iter().map(|row| row.coefficients().first().cloned().unwrap_or_default()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_over_irrational_numbers() {
        // Over x = sqrt 2: (y - x)^2 (y^2 - 3) has the distinct roots sqrt 2 and -sqrt 3, sqrt 3.
        let modulus = Univariate::new([-2, 0, 1].map(BigInt::from).to_vec());
        let ratio = |p: i64, q: i64| BigRational::new(p.into(), q.into());
        let place = Place { lo: ratio(1, 1), hi: ratio(2, 1) };
        let line = Polynomial::from_terms(&[(1, 0, 1), (-1, 1, 0)]);
        let pair = Polynomial::from_terms(&[(1, 0, 2), (-3, 0, 0)]);
        let product = line.mul(&line).mul(&pair);
        let mut fibre = Fibre::new(&modulus, place);
        assert_eq!(fibre.roots(&product, &ratio(-2, 1), &ratio(2, 1), None).unwrap().len(), 3);
        let width = ratio(1, 1 << 60);
        let root = &fibre.roots(&product, &ratio(1, 1), &ratio(3, 2), Some(&width)).unwrap()[0];
        let enclosure = root.enclosure();
        assert!(
            enclosure.lo() <= 2f64.sqrt() && 2f64.sqrt() <= enclosure.hi() && enclosure.hi() - enclosure.lo() < 1e-15
        );
        // y^2 - 2 vanishes with y - x, y^2 - 3 does not.
        let square = Polynomial::from_terms(&[(1, 0, 2), (-2, 0, 0)]);
        assert_eq!(fibre.common(&line, &square).unwrap().degree_y(), 1);
        assert_eq!(fibre.common(&line, &pair).unwrap().degree_y(), 0);
    }
}
