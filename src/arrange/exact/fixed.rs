//! Enclosures in fixed point with as many bits as it takes, and the roots of polynomials whose coefficients are enclosed.

use std::cmp::Ordering;

use num_bigint::BigInt;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::One;
use num_traits::Signed;
use num_traits::Zero;

use crate::arrange::exact::roots::Place;
use crate::arrange::exact::univariate::Univariate;

/// A closed interval with ends in units of `2^-bits` of a [`Fixed`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Range {
    lo: BigInt,
    hi: BigInt,
}

impl Range {
    /// The sign of all members; `None` if they differ.
    pub fn sign(&self) -> Option<Ordering> {
        if self.lo.is_positive() {
            Some(Ordering::Greater)
        } else if self.hi.is_negative() {
            Some(Ordering::Less)
        } else {
            (self.lo.is_zero() && self.hi.is_zero()).then_some(Ordering::Equal)
        }
    }
}

/// More bits are needed to tell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Undecided;

/// Arithmetic on [`Range`]s, rounded outwards.
#[derive(Debug, Clone, Copy)]
pub struct Fixed {
    pub bits: u64,
}

impl Fixed {
    pub fn integer(self, number: &BigInt) -> Range {
        let scaled = number << self.bits;
        Range { lo: scaled.clone(), hi: scaled }
    }

    /// The numbers from `lo` to `hi`.
    pub fn between(self, lo: &BigRational, hi: &BigRational) -> Range {
        let floor = (lo.numer() << self.bits).div_floor(lo.denom());
        let ceil = (hi.numer() << self.bits).div_ceil(hi.denom());
        Range { lo: floor, hi: ceil }
    }

    pub fn add(self, a: &Range, b: &Range) -> Range {
        Range { lo: &a.lo + &b.lo, hi: &a.hi + &b.hi }
    }

    pub fn sub(self, a: &Range, b: &Range) -> Range {
        Range { lo: &a.lo - &b.hi, hi: &a.hi - &b.lo }
    }

    pub fn mul(self, a: &Range, b: &Range) -> Range {
        let (mut lo, mut hi) = (&a.lo * &b.lo, &a.lo * &b.lo);
        for product in [&a.lo * &b.hi, &a.hi * &b.lo, &a.hi * &b.hi] {
            if product < lo {
                lo = product;
            } else if product > hi {
                hi = product;
            }
        }
        // Shifting right rounds down.
        Range { lo: lo >> self.bits, hi: -(-hi >> self.bits) }
    }

    /// The quotients, if the divisor cannot be 0.
    pub fn div(self, a: &Range, b: &Range) -> Option<Range> {
        if !matches!(b.sign(), Some(Ordering::Less | Ordering::Greater)) {
            return None;
        }
        let (mut lo, mut hi): (Option<BigInt>, Option<BigInt>) = (None, None);
        for x in [&a.lo, &a.hi] {
            for y in [&b.lo, &b.hi] {
                let (down, up) = ((x << self.bits).div_floor(y), (x << self.bits).div_ceil(y));
                lo = Some(lo.map_or(down.clone(), |lo| lo.min(down)));
                hi = Some(hi.map_or(up.clone(), |hi| hi.max(up)));
            }
        }
        Some(Range { lo: lo?, hi: hi? })
    }

    /// The values of a polynomial.
    pub fn evaluate(self, poly: &Univariate, x: &Range) -> Range {
        let zero = self.integer(&BigInt::zero());
        poly.coefficients().iter().rev().fold(zero, |sum, c| self.add(&self.mul(&sum, x), &self.integer(c)))
    }

    fn horner(self, coefficients: &[Range], x: &Range) -> Range {
        let zero = self.integer(&BigInt::zero());
        coefficients.iter().rev().fold(zero, |sum, c| self.add(&self.mul(&sum, x), c))
    }

    /// The quotient of polynomials that is known to be one.
    pub fn quotient(self, a: &[Range], b: &[Range]) -> Result<Vec<Range>, Undecided> {
        let mut rest = a.to_vec();
        let m = b.len() - 1;
        let mut quotient = Vec::with_capacity(a.len() - m);
        for i in (0..a.len() - m).rev() {
            let q = self.div(&rest[i + m], &b[m]).ok_or(Undecided)?;
            for (j, c) in b.iter().enumerate().take(m) {
                rest[i + j] = self.sub(&rest[i + j], &self.mul(&q, c));
            }
            quotient.push(q);
        }
        quotient.reverse();
        Ok(quotient)
    }

    /// `p(from + by t)`.
    fn substitute(self, p: &[Range], from: &Range, by: &Range) -> Vec<Range> {
        let mut p = p.to_vec();
        let n = p.len();
        for i in 0..n {
            for j in (i..n - 1).rev() {
                p[j] = self.add(&p[j], &self.mul(&p[j + 1], from));
            }
        }
        let mut power = by.clone();
        for c in p.iter_mut().skip(1) {
            *c = self.mul(c, &power);
            power = self.mul(&power, by);
        }
        p
    }

    /// The least and the greatest number of sign changes that Descartes' rule can count for (0, 1).
    fn bounds_in_unit(self, p: &[Range]) -> (usize, usize) {
        let mut reversed: Vec<Range> = p.iter().rev().cloned().collect();
        let n = reversed.len();
        for i in 0..n {
            for j in (i..n - 1).rev() {
                reversed[j] = self.add(&reversed[j], &reversed[j + 1]);
            }
        }
        variations(&reversed)
    }

    /// The roots in an open interval, at whose ends there are none, of a polynomial whose roots there are simple.
    pub fn isolate(self, p: &[Range], lo: &BigRational, hi: &BigRational) -> Result<Vec<Place>, Undecided> {
        let width = hi - lo;
        let unit = self.substitute(p, &self.between(lo, lo), &self.between(&width, &width));
        let mut places = Vec::new();
        let mut open = vec![(unit, BigRational::zero(), BigRational::one())];
        for _ in 0..MAX_INTERVALS {
            let Some((p, from, to)) = open.pop() else {
                places.sort_by(|a: &Place, b| a.lo.cmp(&b.lo));
                return Ok(places);
            };
            match self.bounds_in_unit(&p) {
                (_, 0) => {}
                (1, 1) => places.push(Place { lo: lo + &width * &from, hi: lo + &width * &to }),
                _ => {
                    let split = self.split(&p)?;
                    let cut = &from + (&to - &from) * &split;
                    let at = self.between(&split, &split);
                    let rest = self.sub(&self.integer(&BigInt::one()), &at);
                    let zero = self.integer(&BigInt::zero());
                    open.push((self.substitute(&p, &at, &rest), cut.clone(), to));
                    open.push((self.substitute(&p, &zero, &at), from, cut));
                }
            }
        }
        Err(Undecided)
    }

    /// A number in (0, 1) at which the sign is known.
    fn split(self, p: &[Range]) -> Result<BigRational, Undecided> {
        let known = |split: &BigRational| self.horner(p, &self.between(split, split)).sign();
        let decided = |split: &BigRational| matches!(known(split), Some(Ordering::Less | Ordering::Greater));
        splits().into_iter().find(decided).ok_or(Undecided)
    }

    /// Narrows the place of a simple root to a width.
    pub fn refine(self, p: &[Range], place: &Place, width: &BigRational) -> Result<Place, Undecided> {
        let sign_at = |x: &BigRational| self.horner(p, &self.between(x, x)).sign();
        let mut place = place.clone();
        let below = sign_at(&place.lo).filter(|sign| sign.is_ne()).ok_or(Undecided)?;
        while place.width() > *width {
            let cut = splits().into_iter().find_map(|split| {
                let cut = &place.lo + place.width() * split;
                let sign = sign_at(&cut).filter(|sign| sign.is_ne())?;
                Some((cut, sign))
            });
            match cut.ok_or(Undecided)? {
                (cut, sign) if sign == below => place.lo = cut,
                (cut, _) => place.hi = cut,
            }
        }
        Ok(place)
    }
}

/// Intervals looked at before more bits are asked for.
const MAX_INTERVALS: usize = 256;

/// Where to cut (0, 1): one cut may hit a root, not all.
fn splits() -> [BigRational; 3] {
    [8, 7, 10].map(|n| BigRational::new(BigInt::from(n), BigInt::from(16)))
}

/// The least and the greatest number of sign changes that coefficients in these ranges can have.
fn variations(p: &[Range]) -> (usize, usize) {
    // By the last sign other than 0: none yet, negative, positive.
    let mut states: [Option<(usize, usize)>; 3] = [Some((0, 0)), None, None];
    for range in p {
        let (negative, positive) = (range.lo.is_negative(), range.hi.is_positive());
        let zero = !range.lo.is_positive() && !range.hi.is_negative();
        let mut next = if zero { states } else { [None; 3] };
        for (target, possible) in [(1, negative), (2, positive)] {
            if !possible {
                continue;
            }
            for (last, state) in states.iter().enumerate() {
                let Some((least, greatest)) = *state else { continue };
                let step = usize::from(last != 0 && last != target);
                let (least, greatest) = (least + step, greatest + step);
                next[target] = Some(match next[target] {
                    None => (least, greatest),
                    Some((a, b)) => (a.min(least), b.max(greatest)),
                });
            }
        }
        states = next;
    }
    let states = states.into_iter().flatten();
    states.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or((0, 0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_of_enclosed_polynomials() {
        // (y^2 - 2)(3 y - 1) with coefficients to 100 bits
        let fixed = Fixed { bits: 100 };
        let ratio = |p: i64, q: i64| BigRational::new(p.into(), q.into());
        let tiny = BigRational::new(BigInt::one(), BigInt::one() << 98);
        let fuzzy = |c: i64| fixed.between(&(ratio(c, 1) - &tiny), &(ratio(c, 1) + &tiny));
        let p: Vec<Range> = [2, -6, -1, 3].map(fuzzy).to_vec();
        let places = fixed.isolate(&p, &ratio(-2, 1), &ratio(2, 1)).unwrap();
        assert_eq!(places.len(), 3);
        let middle = fixed.refine(&p, &places[1], &ratio(1, 1 << 40)).unwrap();
        assert!(middle.lo < ratio(1, 3) && ratio(1, 3) < middle.hi);
        assert_eq!(fixed.isolate(&p, &ratio(1, 2), &ratio(7, 5)), Ok(Vec::new()));
        // A double root stays open.
        let square: Vec<Range> = [1, -2, 1].map(fuzzy).to_vec();
        assert_eq!(fixed.isolate(&square, &ratio(0, 1), &ratio(3, 1)), Err(Undecided));
        let quotient = fixed.quotient(&p, &[-1, 3].map(fuzzy)).unwrap();
        assert!(quotient.iter().zip([-2, 0, 1]).all(|(q, c)| {
            let error = fixed.sub(q, &fixed.integer(&BigInt::from(c)));
            error.lo.bits() < 8 && error.hi.bits() < 8
        }));
    }

    #[test]
    fn sign_changes_of_ranges() {
        let range = |lo: i64, hi: i64| Range { lo: lo.into(), hi: hi.into() };
        let (plus, minus, any, zero) = (range(1, 2), range(-3, -1), range(-1, 1), range(0, 0));
        let count = |ranges: &[&Range]| variations(&ranges.iter().map(|&r| r.clone()).collect::<Vec<_>>());
        assert_eq!(count(&[&plus, &any, &minus]), (1, 1));
        assert_eq!(count(&[&plus, &any, &plus]), (0, 2));
        assert_eq!(count(&[&plus, &zero, &plus]), (0, 0));
        assert_eq!(count(&[&minus, &plus, &zero, &minus]), (2, 2));
    }
}
