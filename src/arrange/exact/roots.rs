//! Real roots of polynomials of one variable: isolated by Descartes' rule of signs, refined by bisection.

use std::cmp::Ordering;

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::One;
use num_traits::Signed;
use num_traits::Zero;

use crate::arrange::complex::Axis;
use crate::arrange::exact::polynomial::Polynomial;
use crate::arrange::exact::univariate::Univariate;
use crate::interval::Interval;

/// Intervals looked at before a search for roots gives up.
const MAX_INTERVALS: usize = 4096;

/// A real root: of the open interval, or the number itself where both ends are equal. An interval's ends may be other roots.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    pub lo: BigRational,
    pub hi: BigRational,
}

impl Place {
    /// Whether the root is known as a number.
    pub fn is_exact(&self) -> bool {
        self.lo == self.hi
    }

    pub fn width(&self) -> BigRational {
        &self.hi - &self.lo
    }

    pub fn enclosure(&self) -> Interval {
        let (lo, hi) = (Interval::from_rational(&self.lo), Interval::from_rational(&self.hi));
        Interval::new(lo.lo(), hi.hi()).unwrap_or(Interval::ENTIRE)
    }

    /// Halves it, for the square-free polynomial whose root it is.
    pub fn bisect(&mut self, poly: &Univariate) {
        if self.is_exact() {
            return;
        }
        let middle = midpoint(&self.lo, &self.hi);
        match poly.sign_at(&middle) {
            Ordering::Equal => (self.lo, self.hi) = (middle.clone(), middle),
            sign if sign == sign_after(poly, &self.lo) => self.lo = middle,
            _ => self.hi = middle,
        }
    }

    /// Narrows it until it is no wider than this, by secants that double the digits where they succeed (quadratic
    /// interval refinement; Abbott 2014).
    pub fn refine(&mut self, poly: &Univariate, width: &BigRational) {
        let degree = poly.degree();
        let mut cuts = 1u32;
        let below = if self.is_exact() { Ordering::Equal } else { sign_after(poly, &self.lo) };
        while !self.is_exact() && self.width() > *width {
            // Values at the ends over one denominator; an end may be another root, and then the guess is bad, no more.
            let (p, q) = (poly.numerator_at(&self.lo), poly.numerator_at(&self.hi));
            let (p, q) = (p * self.hi.denom().pow(degree as u32), q * self.lo.denom().pow(degree as u32));
            let (p, q) = (p.abs(), q.abs());
            let (sum, parts) = (&p + &q, BigInt::one() << cuts);
            let guess = if sum.is_zero() { BigInt::one() } else { ((p * &parts * 2) / sum + 1) / 2 };
            let guess: BigInt = guess.clamp(BigInt::one(), &parts - 1);
            let at = |k: &BigInt| &self.lo + self.width() * BigRational::new(k.clone(), parts.clone());
            let (middle, start) = (at(&guess), self.lo.clone());
            let sign = poly.sign_at(&middle);
            if sign == Ordering::Equal {
                (self.lo, self.hi) = (middle.clone(), middle);
                return;
            }
            // The next cut on the side of the root confirms the guess.
            let other = at(&(if sign == below { &guess + 1 } else { &guess - 1 }));
            let confirmed = if other == start || other == self.hi {
                true
            } else {
                match poly.sign_at(&other) {
                    Ordering::Equal => {
                        (self.lo, self.hi) = (other.clone(), other);
                        return;
                    }
                    next => (next == below) != (sign == below),
                }
            };
            if sign == below {
                self.lo = middle;
            } else {
                self.hi = middle;
            }
            if confirmed {
                if sign == below {
                    self.hi = other;
                } else {
                    self.lo = other;
                }
            }
            cuts = if confirmed { (2 * cuts).min(MAX_CUTS) } else { (cuts / 2).max(1) };
        }
    }

    /// Narrows it until the ends are neighbouring floating-point numbers or nearly so, or the root is found as a number.
    pub fn tighten(&mut self, poly: &Univariate) {
        // Each round gains 50 bits or more; floating-point numbers go down to 2^-1074.
        for _ in 0..32 {
            if self.is_exact() {
                return;
            }
            // A root with a small denominator, 0 above all, is found as such.
            let simple = simplest_between(&self.lo, &self.hi);
            if poly.sign_at(&simple) == Ordering::Equal {
                (self.lo, self.hi) = (simple.clone(), simple);
                return;
            }
            let enclosure = self.enclosure();
            if enclosure.lo().next_up().next_up() >= enclosure.hi() {
                return;
            }
            let magnitude = self.lo.abs().max(self.hi.abs());
            self.refine(poly, &(magnitude / (BigInt::one() << 54u32)));
        }
    }
}

/// Parts that a place is cut into at once, as a power of 2.
const MAX_CUTS: u32 = 1024;

/// The number halfway.
pub fn midpoint(lo: &BigRational, hi: &BigRational) -> BigRational {
    (lo + hi) / BigInt::from(2)
}

/// The sign of a square-free polynomial just above a number.
fn sign_after(poly: &Univariate, x: &BigRational) -> Ordering {
    match poly.sign_at(x) {
        Ordering::Equal => poly.derivative().sign_at(x),
        sign => sign,
    }
}

/// The rational number with the smallest denominator strictly between two numbers, `lo < hi`.
pub fn simplest_between(lo: &BigRational, hi: &BigRational) -> BigRational {
    if lo.is_negative() && hi.is_positive() {
        return BigRational::zero();
    }
    if !lo.is_negative() { simplest_positive(lo, hi) } else { -simplest_positive(&-hi, &-lo) }
}

/// The same for `0 <= lo < hi`, by the common start of both continued fractions.
fn simplest_positive(lo: &BigRational, hi: &BigRational) -> BigRational {
    let (mut lo, mut hi) = (lo.clone(), hi.clone());
    let mut parts = Vec::new();
    loop {
        let whole = lo.floor();
        let next = &whole + BigInt::one();
        if next < hi {
            parts.push(next);
            break;
        }
        // lo in [whole, hi), hi <= whole + 1: the number is whole + 1/z with z between 1 / (hi - whole) and 1 / (lo - whole).
        let (low, high) = (&lo - &whole, &hi - &whole);
        parts.push(whole);
        if low.is_zero() {
            parts.push(high.recip().floor() + BigInt::one());
            break;
        }
        (lo, hi) = (high.recip(), low.recip());
    }
    let mut value = parts.pop().unwrap_or_default();
    while let Some(part) = parts.pop() {
        value = part + value.recip();
    }
    value
}

/// Sign changes between neighbouring coefficients, zeros left out.
fn variations(coefficients: &[BigInt]) -> usize {
    let mut last = None;
    let mut count = 0;
    for sign in coefficients.iter().filter(|c| !c.is_zero()).map(BigInt::is_negative) {
        count += usize::from(last.is_some_and(|last| last != sign));
        last = Some(sign);
    }
    count
}

/// `p(x + 1)`.
fn shift_by_one(coefficients: &mut [BigInt]) {
    let n = coefficients.len();
    for i in 0..n {
        for j in (i..n - 1).rev() {
            let (head, tail) = coefficients.split_at_mut(j + 1);
            head[j] += &tail[0];
        }
    }
}

/// `p(x + by)`.
fn shift(coefficients: &mut [BigInt], by: &BigInt) {
    let n = coefficients.len();
    for i in 0..n {
        for j in (i..n - 1).rev() {
            let (head, tail) = coefficients.split_at_mut(j + 1);
            head[j] += &tail[0] * by;
        }
    }
}

/// A bound of the number of roots in (0, 1), of the same parity (Descartes).
fn bound_in_unit(coefficients: &[BigInt]) -> usize {
    if variations(coefficients) == 0 {
        return 0;
    }
    let mut reversed: Vec<BigInt> = coefficients.iter().rev().cloned().collect();
    shift_by_one(&mut reversed);
    variations(&reversed)
}

/// The coefficients of a positive multiple of `p(lo + (hi - lo) t)`.
fn to_unit(poly: &Univariate, lo: &BigRational, hi: &BigRational) -> Vec<BigInt> {
    let denominator = lo.denom() * hi.denom();
    let (from, to) = (lo.numer() * hi.denom(), hi.numer() * lo.denom());
    let mut coefficients = poly.coefficients().to_vec();
    let mut power = BigInt::one();
    for c in coefficients.iter_mut().rev() {
        *c *= &power;
        power *= &denominator;
    }
    shift(&mut coefficients, &from);
    let (span, mut power) = (to - from, BigInt::one());
    for c in &mut coefficients {
        *c *= &power;
        power *= &span;
    }
    coefficients
}

/// All real roots of a square-free polynomial in the closed interval, rising; `None` after too much work.
pub fn isolate(poly: &Univariate, lo: &BigRational, hi: &BigRational) -> Option<Vec<Place>> {
    let exact = |x: BigRational| Place { lo: x.clone(), hi: x };
    let mut places = Vec::new();
    if poly.is_constant() || lo > hi {
        return Some(places);
    }
    let mut rest = poly.clone();
    for end in [lo, hi] {
        if rest.sign_at(end) == Ordering::Equal {
            rest = rest.divide(&Univariate::new(vec![-end.numer(), end.denom().clone()]))?;
            places.push(exact(end.clone()));
        }
    }
    if lo < hi && !rest.is_constant() {
        let width = hi - lo;
        let at = |k: &BigInt, e: usize| lo + &width * BigRational::new(k.clone(), BigInt::one() << e);
        let mut open = vec![(to_unit(&rest, lo, hi), BigInt::zero(), 0usize)];
        let mut seen = 0;
        while let Some((mut p, k, e)) = open.pop() {
            seen += 1;
            if seen > MAX_INTERVALS {
                return None;
            }
            match bound_in_unit(&p) {
                0 => continue,
                1 => {
                    places.push(Place { lo: at(&k, e), hi: at(&(&k + 1), e) });
                    continue;
                }
                _ => {}
            }
            // p(t / 2) and p(t / 2 + 1 / 2), times a power of 2.
            let n = p.len() - 1;
            for (i, c) in p.iter_mut().enumerate() {
                *c <<= n - i;
            }
            let mut upper = p.clone();
            shift_by_one(&mut upper);
            let k = k << 1usize;
            if upper[0].is_zero() {
                places.push(exact(at(&(&k + 1), e + 1)));
                upper.remove(0);
                // Dividing p by t - 1: the quotient's coefficients are minus the partial sums.
                let mut sum = BigInt::zero();
                p.pop();
                for c in &mut p {
                    sum += &*c;
                    *c = -&sum;
                }
            }
            open.push((upper, &k + 1, e + 1));
            open.push((p, k, e + 1));
        }
    }
    places.sort_by(|a, b| a.lo.cmp(&b.lo).then(a.hi.cmp(&b.hi)));
    Some(places)
}

/// A root on a segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Root {
    /// Encloses it, about one unit in the last place wide.
    pub place: Interval,
    /// How often it is a root of the restriction; 1 means that the curve crosses the segment transversally.
    pub multiplicity: u32,
}

impl Polynomial {
    /// The roots of the restriction to a segment, both ends included, rising: along x at the height `at`, or along y. Their
    /// enclosures are disjoint unless two roots are closer than floating-point numbers are there. `None` if the
    /// restriction vanishes identically, an argument is not finite, or it takes too long.
    pub fn roots_on(&self, axis: Axis, at: f64, from: f64, to: f64) -> Option<Vec<Root>> {
        let at = BigRational::from_float(at)?;
        let (from, to) = (BigRational::from_float(from)?, BigRational::from_float(to)?);
        let restriction = match axis {
            Axis::X => self.at_y(&at),
            Axis::Y => self.at_x(&at),
        };
        if restriction.is_zero() {
            return None;
        }
        let mut roots = Vec::new();
        for (factor, multiplicity) in restriction.square_free() {
            for mut place in isolate(&factor, &from, &to)? {
                place.tighten(&factor);
                roots.push((place.enclosure(), multiplicity, factor.clone(), place));
            }
        }
        roots.sort_by(|a, b| a.3.lo.cmp(&b.3.lo));
        for i in 1..roots.len() {
            for _ in 0..MAX_INTERVALS.min(256) {
                let (before, after) = roots.split_at_mut(i);
                let (a, b) = (&mut before[i - 1], &mut after[0]);
                if a.0.hi() < b.0.lo() || (a.3.is_exact() && b.3.is_exact()) {
                    break;
                }
                for root in [a, b] {
                    root.3.bisect(&root.2);
                    root.0 = root.3.enclosure();
                }
            }
        }
        roots.sort_by(|a, b| a.3.lo.cmp(&b.3.lo));
        Some(roots.into_iter().map(|(place, multiplicity, ..)| Root { place, multiplicity }).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn poly(coefficients: &[i64]) -> Univariate {
        Univariate::new(coefficients.iter().map(|&c| BigInt::from(c)).collect())
    }

    fn ratio(p: i64, q: i64) -> BigRational {
        BigRational::new(p.into(), q.into())
    }

    #[test]
    fn roots_in_closed_intervals_are_counted_once() {
        // (x - 1)(x - 2)(x - 3)(2 x - 3)(x^2 - 2)
        let p = poly(&[-1, 1]).mul(&poly(&[-2, 1])).mul(&poly(&[-3, 1])).mul(&poly(&[-3, 2])).mul(&poly(&[-2, 0, 1]));
        let count = |lo, hi| isolate(&p, &lo, &hi).unwrap().len();
        assert_eq!(count(ratio(1, 1), ratio(3, 1)), 5);
        assert_eq!(count(ratio(-2, 1), ratio(4, 1)), 6);
        assert_eq!(count(ratio(1, 1), ratio(1, 1)), 1);
        assert_eq!(count(ratio(7, 5), ratio(141, 100)), 0);
        assert_eq!(count(ratio(141, 100), ratio(3, 2)), 2);
    }

    #[test]
    fn close_roots_are_told_apart_and_refined() {
        // (10^12 x - 1)(10^12 x - 2)(x^2 - 2)
        let (a, b) = (poly(&[-1, 1_000_000_000_000]), poly(&[-2, 1_000_000_000_000]));
        let p = a.mul(&b).mul(&poly(&[-2, 0, 1]));
        let mut places = isolate(&p, &ratio(-1, 3), &ratio(2, 1)).unwrap();
        assert_eq!(places.len(), 3);
        places.iter_mut().for_each(|place| place.tighten(&p));
        for (place, root) in places.iter().zip([1e-12, 2e-12, 2f64.sqrt()]) {
            let enclosure = place.enclosure();
            assert!(
                enclosure.lo() <= root && root <= enclosure.hi() && enclosure.hi() - enclosure.lo() <= 5e-16 * root
            );
        }
    }

    #[test]
    fn the_simplest_number_between_two() {
        assert_eq!(simplest_between(&ratio(1, 3), &ratio(1, 2)), ratio(2, 5));
        assert_eq!(simplest_between(&ratio(333, 1000), &ratio(334, 1000)), ratio(1, 3));
        assert_eq!(simplest_between(&ratio(-7, 2), &ratio(-5, 2)), ratio(-3, 1));
        assert_eq!(simplest_between(&ratio(0, 1), &ratio(1, 7)), ratio(1, 8));
        assert_eq!(simplest_between(&ratio(2, 1), &ratio(3, 1)), ratio(5, 2));
    }

    #[test]
    fn restrictions_have_roots_with_multiplicities() {
        // The circle of radius 5 on its tangent y = 5, on y = 3, and on x = 4 up to the point (4, 3).
        let circle = Polynomial::from_terms(&[(1, 2, 0), (1, 0, 2), (-25, 0, 0)]);
        let tangent = circle.roots_on(Axis::X, 5.0, -10.0, 10.0).unwrap();
        assert_eq!(tangent, [Root { place: Interval::point(0.0), multiplicity: 2 }]);
        let secant: Vec<f64> =
            circle.roots_on(Axis::X, 3.0, -10.0, 10.0).unwrap().iter().map(|r| r.place.lo()).collect();
        assert_eq!(secant, [-4.0, 4.0]);
        let end = circle.roots_on(Axis::Y, 4.0, 0.0, 3.0).unwrap();
        assert_eq!(end, [Root { place: Interval::point(3.0), multiplicity: 1 }]);
        assert_eq!(Polynomial::from_terms(&[(1, 1, 1)]).roots_on(Axis::X, 0.0, 0.0, 1.0), None);
    }
}
