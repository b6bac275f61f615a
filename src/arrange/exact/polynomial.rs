//! Polynomials in x and y with integer coefficients.

use std::cmp::Ordering;
use std::fmt;

use num_bigint::BigInt;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::One;
use num_traits::Signed;
use num_traits::Zero;

use crate::arrange::exact::modular;
use crate::arrange::exact::univariate;
use crate::arrange::exact::univariate::Univariate;

/// A polynomial in x and y over the integers, as a polynomial in y whose coefficients are polynomials in x.
///
/// What this module hands out has coefficients without a common divisor, and the leading coefficient (in y, then in x) is
/// positive; the zero set is what counts.
#[derive(Clone, PartialEq, Eq, Hash, Default)]
pub struct Polynomial {
    /// By rising power of y; the last one is not 0.
    rows: Vec<Univariate>,
}

impl Polynomial {
    /// From the coefficients of the powers of y.
    pub fn new(mut rows: Vec<Univariate>) -> Self {
        while rows.last().is_some_and(Univariate::is_zero) {
            rows.pop();
        }
        Self { rows }
    }

    /// From terms `c x^i y^j`, given as `(c, i, j)`.
    pub fn from_terms(terms: &[(i64, usize, usize)]) -> Self {
        let mut sum = Self::default();
        for &(c, i, j) in terms {
            let mut row = vec![BigInt::zero(); i + 1];
            row[i] = BigInt::from(c);
            let mut rows = vec![Univariate::default(); j + 1];
            rows[j] = Univariate::new(row);
            sum = sum.add(&Self::new(rows));
        }
        sum
    }

    /// The polynomial without its constant term, primitive: equal for polynomials that differ by a constant, up to factors.
    pub fn without_constant(&self) -> Self {
        let mut rows = self.rows.clone();
        if let Some(first) = rows.first_mut() {
            let mut coefficients = first.coefficients().to_vec();
            if let Some(constant) = coefficients.first_mut() {
                *constant = BigInt::zero();
            }
            *first = Univariate::new(coefficients);
        }
        Self::new(rows).primitive()
    }

    pub fn constant(value: BigInt) -> Self {
        Self::new(vec![Univariate::constant(value)])
    }

    /// The coefficients of the powers of y.
    pub fn rows(&self) -> &[Univariate] {
        &self.rows
    }

    pub fn is_zero(&self) -> bool {
        self.rows.is_empty()
    }

    pub fn is_constant(&self) -> bool {
        self.rows.len() <= 1 && self.rows.iter().all(Univariate::is_constant)
    }

    /// The total degree; 0 for the zero polynomial too.
    pub fn degree(&self) -> usize {
        let rows = self.rows.iter().enumerate().filter(|(_, row)| !row.is_zero());
        rows.map(|(j, row)| j + row.degree()).max().unwrap_or(0)
    }

    pub fn degree_x(&self) -> usize {
        self.rows.iter().map(Univariate::degree).max().unwrap_or(0)
    }

    pub fn degree_y(&self) -> usize {
        self.rows.len().saturating_sub(1)
    }

    /// The bits of the largest coefficient.
    pub fn bits(&self) -> u64 {
        self.rows.iter().map(Univariate::bits).max().unwrap_or(0)
    }

    /// The sum of the coefficients' absolute values.
    pub fn norm(&self) -> BigInt {
        self.rows.iter().map(Univariate::norm).sum()
    }

    /// The coefficient of the highest power of y.
    pub fn leading(&self) -> Univariate {
        self.rows.last().cloned().unwrap_or_default()
    }

    /// Without its highest power of y.
    pub fn reductum(&self) -> Self {
        Self::new(self.rows[..self.rows.len().saturating_sub(1)].to_vec())
    }

    pub fn add(&self, other: &Self) -> Self {
        let (long, short) = if self.rows.len() >= other.rows.len() { (self, other) } else { (other, self) };
        let mut rows = long.rows.clone();
        rows.iter_mut().zip(&short.rows).for_each(|(a, b)| *a = a.add(b));
        Self::new(rows)
    }

    pub fn sub(&self, other: &Self) -> Self {
        self.add(&other.scale(&BigInt::from(-1)))
    }

    pub fn mul(&self, other: &Self) -> Self {
        if self.is_zero() || other.is_zero() {
            return Self::default();
        }
        let mut rows = vec![Univariate::default(); self.rows.len() + other.rows.len() - 1];
        for (i, a) in self.rows.iter().enumerate().filter(|(_, a)| !a.is_zero()) {
            for (j, b) in other.rows.iter().enumerate().filter(|(_, b)| !b.is_zero()) {
                rows[i + j] = rows[i + j].add(&a.mul(b));
            }
        }
        Self::new(rows)
    }

    pub fn scale(&self, factor: &BigInt) -> Self {
        Self::new(self.rows.iter().map(|row| row.scale(factor)).collect())
    }

    /// The greatest common divisor of all coefficients.
    pub fn content(&self) -> BigInt {
        let mut content = BigInt::zero();
        for row in &self.rows {
            content = content.gcd(&row.content());
            if content.is_one() {
                break;
            }
        }
        content
    }

    /// Without a common divisor of its coefficients, the leading one positive.
    pub fn primitive(&self) -> Self {
        let Some(lead) = self.rows.last().and_then(Univariate::leading) else { return Self::default() };
        let mut content = self.content();
        if lead.is_negative() {
            content = -content;
        }
        if content.is_one() {
            return self.clone();
        }
        let divided = |row: &Univariate| Univariate::new(row.coefficients().iter().map(|c| c / &content).collect());
        Self::new(self.rows.iter().map(divided).collect())
    }

    /// The derivative by x.
    pub fn derivative_x(&self) -> Self {
        Self::new(self.rows.iter().map(Univariate::derivative).collect())
    }

    /// The derivative by y.
    pub fn derivative_y(&self) -> Self {
        Self::new(self.rows.iter().enumerate().skip(1).map(|(j, row)| row.scale(&BigInt::from(j))).collect())
    }

    /// With x and y exchanged.
    pub fn exchanged(&self) -> Self {
        let coefficient = |i: usize, row: &Univariate| row.coefficients().get(i).cloned().unwrap_or_default();
        let row = |i: usize| Univariate::new(self.rows.iter().map(|row| coefficient(i, row)).collect());
        Self::new((0..=self.degree_x()).map(row).collect())
    }

    /// A positive multiple of the restriction to a vertical line, as a polynomial in y.
    pub fn at_x(&self, x: &BigRational) -> Univariate {
        let degree = self.degree_x();
        let mut powers = vec![BigInt::one()];
        for i in 0..degree {
            powers.push(&powers[i] * x.denom());
        }
        let row = |row: &Univariate| row.numerator_at(x) * &powers[degree - row.degree()];
        Univariate::new(self.rows.iter().map(row).collect())
    }

    /// A positive multiple of the restriction to a horizontal line, as a polynomial in x.
    pub fn at_y(&self, y: &BigRational) -> Univariate {
        let (mut power, mut sum) = (BigInt::one(), Univariate::default());
        for row in self.rows.iter().rev() {
            sum = sum.scale(y.numer()).add(&row.scale(&power));
            power *= y.denom();
        }
        sum
    }

    /// The exact sign at a point; `None` unless both coordinates are finite.
    pub fn sign_at(&self, point: [f64; 2]) -> Option<Ordering> {
        let [x, y] = [BigRational::from_float(point[0])?, BigRational::from_float(point[1])?];
        Some(univariate::sign(&self.at_x(&x).numerator_at(&y)))
    }

    /// The quotient, if the other divides it over the integers.
    pub fn divide(&self, other: &Self) -> Option<Self> {
        let lead = other.rows.last()?;
        if self.is_zero() {
            return Some(Self::default());
        }
        let steps = (self.rows.len() + 1).checked_sub(other.rows.len())?;
        let mut rest = self.rows.clone();
        let mut quotient = vec![Univariate::default(); steps];
        for i in (0..steps).rev() {
            let q = rest[i + other.rows.len() - 1].divide(lead)?;
            if !q.is_zero() {
                for (j, row) in other.rows.iter().enumerate() {
                    rest[i + j] = rest[i + j].sub(&q.mul(row));
                }
            }
            quotient[i] = q;
        }
        rest.iter().all(Univariate::is_zero).then(|| Self::new(quotient))
    }

    /// The greatest common divisor of the coefficients of the powers of y, a polynomial in x.
    pub fn content_x(&self) -> Univariate {
        let mut content = Univariate::default();
        for row in self.rows.iter().filter(|row| !row.is_zero()) {
            content = content.gcd(row);
            if content.is_constant() {
                return Univariate::one();
            }
        }
        content
    }

    /// A positive multiple modulo a polynomial in x whose leading coefficient is positive.
    pub fn reduce(&self, modulus: &Univariate) -> Self {
        let Some(lead) = modulus.leading() else { return self.clone() };
        let rows: Vec<(Univariate, u32)> = self.rows.iter().map(|row| row.pseudo_remainder(modulus)).collect();
        let exponent = rows.iter().map(|&(_, e)| e).max().unwrap_or(0);
        let rows = rows.into_iter().map(|(row, e)| row.scale(&lead.pow(exponent - e))).collect();
        let reduced = Self::new(rows);
        // A positive content only: the sign of the polynomial stays.
        let content = reduced.content();
        if content.is_zero() || content.is_one() {
            return reduced;
        }
        let divided = |row: &Univariate| Univariate::new(row.coefficients().iter().map(|c| c / &content).collect());
        Self::new(reduced.rows.iter().map(divided).collect())
    }

    /// The restriction to a vertical line modulo the prime of a field; leading zeros are kept.
    pub fn image(rows: &[Vec<u64>], field: modular::Field, x: u64) -> Vec<u64> {
        rows.iter().map(|row| field.evaluate(row, x)).collect()
    }

    /// The coefficients modulo the prime of a field.
    pub fn modulo(&self, field: modular::Field) -> Vec<Vec<u64>> {
        self.rows.iter().map(|row| row.modulo(field)).collect()
    }
}

impl fmt::Display for Polynomial {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut first = true;
        for (j, row) in self.rows.iter().enumerate().rev() {
            for (i, c) in row.coefficients().iter().enumerate().rev().filter(|(_, c)| !c.is_zero()) {
                let sign = match (c.is_negative(), first) {
                    (true, true) => "-",
                    (true, false) => " - ",
                    (false, true) => "",
                    (false, false) => " + ",
                };
                let number = if c.abs().is_one() && i + j > 0 { String::new() } else { c.abs().to_string() };
                let power = |name: &str, n: usize| match n {
                    0 => String::new(),
                    1 => name.to_owned(),
                    n => format!("{name}^{n}"),
                };
                let parts = [number, power("x", i), power("y", j)];
                let parts: Vec<&str> = parts.iter().map(String::as_str).filter(|part| !part.is_empty()).collect();
                write!(f, "{sign}{}", parts.join(" "))?;
                first = false;
            }
        }
        if first { f.write_str("0") } else { Ok(()) }
    }
}

impl fmt::Debug for Polynomial {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}
