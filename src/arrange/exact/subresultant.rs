//! Resultants and subresultants of polynomials in x and y, by images modulo primes, with enough primes for proof.

use crate::arrange::exact::modular;
use crate::arrange::exact::modular::Field;
use crate::arrange::exact::polynomial::Polynomial;
use crate::arrange::exact::univariate::Images;
use crate::arrange::exact::univariate::Univariate;

/// More field operations than this are not tried in one resultant: about a second. Resultants are kept for other questions.
const MAX_WORK: u64 = 250_000_000;

/// A computation would take too long.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TooLarge;

/// The k-th subresultant in y of two polynomials of degrees above `k` in y: a polynomial of degree k in y, or zero if its
/// coefficient of y^k vanishes identically. For `k = 0` the resultant.
///
/// # Errors
/// If it would take more than `limit` field operations.
pub fn subresultant(f: &Polynomial, g: &Polynomial, k: usize, limit: u64) -> Result<Polynomial, TooLarge> {
    let (n, m) = (f.degree_y(), g.degree_y());
    debug_assert!(k < n.min(m), "a subresultant of full degree");
    let degree = degree_bound(f, g, k);
    // A determinant's norm is at most the product of its rows' norms; one bit for the sign.
    let bits = (m - k) as u64 * f.norm().bits() + (n - k) as u64 * g.norm().bits() + 1;
    let per_point = ((f.degree_x() + 1) * (n + 1) + (g.degree_x() + 1) * (m + 1) + n * m + 128 * n.min(m)) as u64;
    let per_prime = (degree as u64 + 1) * (per_point + 3 * (k as u64 + 1) * (degree as u64 + 1));
    if (bits / 61 + 1).saturating_mul(per_prime) > limit {
        return Err(TooLarge);
    }
    let mut images = Images::new((k + 1) * (degree + 1));
    let mut zeros = 0;
    for index in 0.. {
        let field = modular::field(index);
        match image(f, g, k, degree, field) {
            Image::Unlucky => continue,
            Image::Zero => zeros += 1,
            Image::Rows(rows) => images.include(field, &rows),
        }
        // Every prime is above 2^61. Primes that divide the leading coefficient say nothing about the others.
        if zeros * 61 > bits {
            return Ok(Polynomial::default());
        }
        if images.bits() > bits {
            break;
        }
    }
    let integers = images.integers();
    Ok(Polynomial::new(integers.chunks(degree + 1).map(|row| Univariate::new(row.to_vec())).collect()))
}

/// The resultant in y as a polynomial in x.
///
/// # Errors
/// If degrees or coefficients are too large.
pub fn resultant(f: &Polynomial, g: &Polynomial) -> Result<Univariate, TooLarge> {
    let power = |row: Univariate, exponent: usize| (0..exponent).fold(Univariate::one(), |p, _| p.mul(&row));
    match (f.degree_y(), g.degree_y()) {
        (0, m) => Ok(power(f.leading(), m)),
        (n, 0) => Ok(power(g.leading(), n)),
        _ => Ok(subresultant(f, g, 0, MAX_WORK)?.leading()),
    }
}

/// A bound of the degree in x of the coefficients: of the determinant's columns or, where that is less, of total degrees.
fn degree_bound(f: &Polynomial, g: &Polynomial, k: usize) -> usize {
    let (n, m) = (f.degree_y(), g.degree_y());
    let partial = (m - k) * f.degree_x() + (n - k) * g.degree_x();
    // Row y^i f has degree deg f - c + i in column c. The columns are those of y^(k+1) and above, and the last one.
    let (a, b) = (m - k, n - k);
    let rows = a * f.degree() + a * (a - 1) / 2 + b * g.degree() + b * (b - 1) / 2;
    let columns: usize = (k + 1..n + m - k).sum();
    partial.min(rows.saturating_sub(columns))
}

/// A subresultant modulo a prime.
enum Image {
    /// A leading coefficient vanishes there.
    Unlucky,
    /// The coefficient of y^k vanishes.
    Zero,
    /// The coefficients, row by row.
    Rows(Vec<u64>),
}

fn image(f: &Polynomial, g: &Polynomial, k: usize, degree: usize, field: Field) -> Image {
    let (f, g) = (f.modulo(field), g.modulo(field));
    let dead = |rows: &[Vec<u64>]| rows.last().is_none_or(|row| row.iter().all(|&c| c == 0));
    if dead(&f) || dead(&g) {
        return Image::Unlucky;
    }
    let (mut points, mut values) = (Vec::new(), vec![Vec::new(); k + 1]);
    let mut zeros = 0;
    for point in 1u64.. {
        let x = field.element(point);
        let (a, b) = (Polynomial::image(&f, field, x), Polynomial::image(&g, field, x));
        if a.last() == Some(&0) || b.last() == Some(&0) {
            continue;
        }
        match field.subresultant(&a, &b, k) {
            // With so many zeros a polynomial of that degree is zero.
            None => zeros += 1,
            Some(result) => {
                points.push(point);
                values.iter_mut().zip(result).for_each(|(values, value)| values.push(value));
            }
        }
        if zeros > degree {
            return Image::Zero;
        }
        if points.len() > degree {
            break;
        }
    }
    Image::Rows(values.iter().flat_map(|values| field.interpolate(&points, values)).collect())
}

/// A polynomial on one vertical line modulo a prime, the same for all: two that have coprime images are coprime.
#[derive(Debug, Clone)]
pub struct Shadow(Vec<u64>);

impl Shadow {
    pub fn new(poly: &Polynomial) -> Self {
        let field = modular::field(0);
        Self(Polynomial::image(&poly.modulo(field), field, field.element(SHADOW_AT)))
    }

    /// Whether the polynomials, without content in x alone, are proved coprime.
    pub fn is_coprime(&self, other: &Self) -> bool {
        // If a leading coefficient of both vanishes, a common factor may have gone with them.
        let lost = self.0.last() == Some(&0) || other.0.last() == Some(&0);
        !lost && modular::field(0).is_coprime(&self.0, &other.0)
    }
}

/// Some place in x.
const SHADOW_AT: u64 = 0x1e37_79b9_7f4a_7c15;

/// The greatest common divisor of two polynomials without content in x alone, each of positive degree in y; `None` if it is
/// a constant.
///
/// # Errors
/// If degrees or coefficients are too large.
pub fn gcd(f: &Polynomial, g: &Polynomial) -> Result<Option<Polynomial>, TooLarge> {
    // The degree in y of a common divisor is at most that of images.
    let field = modular::field(0);
    let (a, b) = (Shadow::new(f).0, Shadow::new(g).0);
    let mut least = f.degree_y().min(g.degree_y());
    if a.last() != Some(&0) && b.last() != Some(&0) {
        least = least.min(field.gcd(&a, &b).len() - 1);
    }
    let smaller = if f.degree_y() <= g.degree_y() { f } else { g };
    for k in (1..=least).rev() {
        let candidate = if k == smaller.degree_y() { smaller.clone() } else { subresultant(f, g, k, MAX_WORK)? };
        if candidate.is_zero() {
            continue;
        }
        let content = Polynomial::new(vec![candidate.content_x()]);
        let Some(candidate) = candidate.divide(&content) else { continue };
        let candidate = candidate.primitive();
        if f.divide(&candidate).is_some() && g.divide(&candidate).is_some() {
            return Ok(Some(candidate));
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use num_bigint::BigInt;

    use super::*;

    fn univariate(coefficients: &[i64]) -> Univariate {
        Univariate::new(coefficients.iter().map(|&c| BigInt::from(c)).collect())
    }

    #[test]
    fn resultants_of_small_polynomials() {
        // y^2 - x^3 against y - 1: 1 - x^3. Against its own derivative: the discriminant -4 x^3 (times the leading 1).
        let cusp = Polynomial::from_terms(&[(1, 0, 2), (-1, 3, 0)]);
        let line = Polynomial::from_terms(&[(1, 0, 1), (-1, 0, 0)]);
        assert_eq!(resultant(&cusp, &line), Ok(univariate(&[1, 0, 0, -1])));
        assert_eq!(resultant(&cusp, &cusp.derivative_y()), Ok(univariate(&[0, 0, 0, -4])));
        // Two circles: x^2 + y^2 - 1 and (x - 1)^2 + y^2 - 1: (2 x - 1)^2.
        let circle = Polynomial::from_terms(&[(1, 2, 0), (1, 0, 2), (-1, 0, 0)]);
        let other = Polynomial::from_terms(&[(1, 2, 0), (-2, 1, 0), (1, 0, 2)]);
        assert_eq!(resultant(&circle, &other), Ok(univariate(&[1, -4, 4])));
    }

    #[test]
    fn common_divisors_are_found_and_coprime_pairs_refused() {
        let a = Polynomial::from_terms(&[(3, 2, 1), (1, 0, 2), (-7, 1, 0)]);
        let b = Polynomial::from_terms(&[(1, 0, 3), (2, 1, 1), (5, 0, 0)]);
        let c = Polynomial::from_terms(&[(4, 3, 0), (1, 0, 1)]);
        assert_eq!(gcd(&a.mul(&b), &a.mul(&c)), Ok(Some(a.clone())));
        assert_eq!(gcd(&a.mul(&b).mul(&b), &b.mul(&b).mul(&c)), Ok(Some(b.mul(&b))));
        assert_eq!(gcd(&a, &b), Ok(None));
        assert_eq!(gcd(&a.mul(&b), &a), Ok(Some(a)));
    }

    #[test]
    fn a_subresultant_that_vanishes_is_zero() {
        let a = Polynomial::from_terms(&[(1, 0, 2), (1, 1, 0)]);
        let b = Polynomial::from_terms(&[(1, 0, 3), (2, 1, 1), (5, 0, 0)]);
        assert_eq!(subresultant(&a.mul(&b), &a.mul(&a), 0, MAX_WORK), Ok(Polynomial::default()));
        assert_eq!(subresultant(&a.mul(&b), &a.mul(&a), 1, MAX_WORK), Ok(Polynomial::default()));
    }
}
