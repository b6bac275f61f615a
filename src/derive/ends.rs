//! Interval arithmetic on lanes: the ends of an enclosure and the operations that need no table of constants.
//! Every function here is sound when all rounding is upward (see `lanes`).

use crate::derive::lanes::Builder;
use crate::derive::lanes::Lane;
use crate::derive::lanes::LaneOp;
use crate::derive::lanes::Mask;

/// An enclosure: the negated lower end and the upper end. Neither is NaN; the lower is below +inf, the upper above
/// -inf, unless the enclosure's empty mask is set, when both are anything.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Ends {
    pub nlo: Lane,
    pub hi: Lane,
}

/// What an operation made of ends: its enclosure, where it is undefined on the whole box, and where it is proved
/// defined and continuous on all of it. Only the operation's own part: the operands' masks are the caller's.
#[derive(Debug, Clone, Copy)]
pub struct Applied {
    pub ends: Ends,
    pub empty: Mask,
    pub continuous: Mask,
}

impl From<Ends> for Applied {
    fn from(ends: Ends) -> Self {
        Applied { ends, empty: Mask::False, continuous: Mask::True }
    }
}

/// What is known of the sign of an operand's ends themselves (not only of the real values they enclose).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sign {
    NonNegative,
    NonPositive,
    Unknown,
}

impl Builder {
    pub fn zero(&mut self) -> Lane {
        self.number(0.0)
    }

    pub fn infinity(&mut self) -> Lane {
        self.number(f64::INFINITY)
    }

    /// All reals.
    pub fn entire(&mut self) -> Ends {
        let infinity = self.infinity();
        Ends { nlo: infinity, hi: infinity }
    }

    /// The lower end itself.
    pub fn low(&mut self, x: Ends) -> Lane {
        self.neg(x.nlo)
    }

    /// The outward rounded enclosure of [lo, hi].
    pub fn constant_ends(&mut self, lo: f64, hi: f64) -> Ends {
        Ends { nlo: self.up(-lo), hi: self.up(hi) }
    }

    pub fn hull(&mut self, a: Ends, b: Ends) -> Ends {
        Ends { nlo: self.max(a.nlo, b.nlo), hi: self.max(a.hi, b.hi) }
    }

    /// Both enclosures hold, so does their intersection; it is not empty where the enclosed value exists.
    pub fn meet(&mut self, a: Ends, b: Ends) -> Ends {
        Ends { nlo: self.min(a.nlo, b.nlo), hi: self.min(a.hi, b.hi) }
    }

    pub fn select_ends(&mut self, mask: Mask, a: Ends, b: Ends) -> Ends {
        Ends { nlo: self.select(mask, a.nlo, b.nlo), hi: self.select(mask, a.hi, b.hi) }
    }

    /// Where 0 lies in the enclosure.
    pub fn contains_zero(&mut self, x: Ends) -> Mask {
        let zero = self.zero();
        let below = self.less_equal(zero, x.nlo);
        let above = self.less_equal(zero, x.hi);
        self.and(below, above)
    }

    pub fn neg_ends(&mut self, x: Ends) -> Ends {
        Ends { nlo: x.hi, hi: x.nlo }
    }

    pub fn add_ends(&mut self, a: Ends, b: Ends) -> Ends {
        Ends { nlo: self.add(a.nlo, b.nlo), hi: self.add(a.hi, b.hi) }
    }

    pub fn sub_ends(&mut self, a: Ends, b: Ends) -> Ends {
        Ends { nlo: self.add(a.nlo, b.hi), hi: self.add(a.hi, b.nlo) }
    }

    /// A product of two ends; with `guarded`, 0 inf = 0 as interval products demand.
    fn end_product(&mut self, a: Lane, b: Lane, guarded: bool) -> Lane {
        let product = self.mul(a, b);
        if !guarded {
            return product;
        }
        let zero = self.zero();
        let ordered = self.equal(product, product);
        self.select(ordered, product, zero)
    }

    /// Product by the signs known of the ends: 2 multiplications where both are known, 4 and 2 maxima where one is,
    /// else 8 and 6. `guarded` where an end may be infinite.
    pub fn mul_ends(&mut self, a: (Ends, Sign), b: (Ends, Sign), guarded: bool) -> Ends {
        use Sign::*;
        let ((x, sx), (y, sy)) = (a, b);
        // Negation is exact, so a product with a negated factor is the negated product before rounding.
        match (sx, sy) {
            (NonPositive, _) => {
                let flipped = self.neg_ends(x);
                let product = self.mul_ends((flipped, NonNegative), b, guarded);
                self.neg_ends(product)
            }
            (_, NonPositive) => {
                let flipped = self.neg_ends(y);
                let product = self.mul_ends(a, (flipped, NonNegative), guarded);
                self.neg_ends(product)
            }
            (NonNegative, NonNegative) => {
                let y_lo = self.low(y);
                Ends { nlo: self.end_product(x.nlo, y_lo, guarded), hi: self.end_product(x.hi, y.hi, guarded) }
            }
            (NonNegative, Unknown) if self.is_point(x) => {
                Ends { nlo: self.end_product(x.hi, y.nlo, guarded), hi: self.end_product(x.hi, y.hi, guarded) }
            }
            (Unknown, NonNegative) => self.mul_ends(b, a, guarded),
            (NonNegative, Unknown) => {
                let x_lo = self.low(x);
                let n1 = self.end_product(x.hi, y.nlo, guarded);
                let n2 = self.end_product(x_lo, y.nlo, guarded);
                let h1 = self.end_product(x.hi, y.hi, guarded);
                let h2 = self.end_product(x_lo, y.hi, guarded);
                Ends { nlo: self.max(n1, n2), hi: self.max(h1, h2) }
            }
            (Unknown, Unknown) => {
                let (x_lo, y_lo) = (self.low(x), self.low(y));
                let x_neg_hi = self.neg(x.hi);
                let h = [(x.hi, y.hi), (x.nlo, y.nlo), (x.hi, y_lo), (x_lo, y.hi)];
                let n = [(x_neg_hi, y.hi), (x.nlo, y_lo), (x.hi, y.nlo), (x.nlo, y.hi)];
                let [hi, nlo] = [h, n].map(|pairs| {
                    let [p, q, r, s] = pairs.map(|(a, b)| self.end_product(a, b, guarded));
                    let (pq, rs) = (self.max(p, q), self.max(r, s));
                    self.max(pq, rs)
                });
                Ends { nlo, hi }
            }
        }
    }

    /// Whether both ends are the same constant.
    fn is_point(&self, x: Ends) -> bool {
        matches!((self.as_number(x.nlo), self.as_number(x.hi)), (Some(nlo), Some(hi)) if -nlo == hi)
    }

    /// max |x|, and -min |x|, exactly.
    fn magnitudes(&mut self, x: Ends) -> (Lane, Lane) {
        let zero = self.zero();
        let mag = self.max(x.nlo, x.hi);
        let low = self.min(x.nlo, x.hi);
        (mag, self.min(low, zero))
    }

    pub fn abs_ends(&mut self, x: Ends) -> Ends {
        let (hi, nlo) = self.magnitudes(x);
        Ends { nlo, hi }
    }

    pub fn sqr_ends(&mut self, x: Ends) -> Ends {
        let (mag, nmig) = self.magnitudes(x);
        let mig = self.neg(nmig);
        Ends { nlo: self.mul(nmig, mig), hi: self.mul(mag, mag) }
    }

    /// `x^n` of ends known >= 0, n >= 1: monotone, so the powers of the ends bound it however they are multiplied.
    fn power_of_nonnegative(&mut self, x: Ends, n: u32) -> Ends {
        let mut square = x;
        let mut result: Option<Ends> = None;
        let mut rest = n;
        loop {
            if rest % 2 == 1 {
                result = Some(match result {
                    None => square,
                    Some(r) => self.mul_ends((r, Sign::NonNegative), (square, Sign::NonNegative), false),
                });
            }
            rest /= 2;
            if rest == 0 {
                return result.unwrap_or(square);
            }
            square = self.mul_ends((square, Sign::NonNegative), (square, Sign::NonNegative), false);
        }
    }

    /// `x^n` for n >= 1.
    pub fn power_ends(&mut self, x: Ends, sign: Sign, n: u32) -> Ends {
        if n.is_multiple_of(2) {
            let magnitude = self.abs_ends(x);
            return self.power_of_nonnegative(magnitude, n);
        }
        match sign {
            Sign::NonNegative => self.power_of_nonnegative(x, n),
            Sign::NonPositive => {
                let flipped = self.neg_ends(x);
                let power = self.power_of_nonnegative(flipped, n);
                self.neg_ends(power)
            }
            Sign::Unknown => {
                // Odd and monotone: each end on its own, its power enclosed on the side of its sign.
                let hi = self.odd_power_up(x.hi, n);
                let nlo = self.odd_power_up(x.nlo, n);
                Ends { nlo, hi }
            }
        }
    }

    /// An upper bound of the odd power of one number. As x^n is odd, the negated lower bound is that of the negated number.
    fn odd_power_up(&mut self, x: Lane, n: u32) -> Lane {
        let magnitude = self.abs(x);
        let negated = self.neg(magnitude);
        let power = self.power_of_nonnegative(Ends { nlo: negated, hi: magnitude }, n);
        let zero = self.zero();
        let negative = self.less(x, zero);
        self.select(negative, power.nlo, power.hi)
    }

    /// A number at most sqrt(x) for x >= 0, negated. The root rounded up is exact, or one step above a lower bound:
    /// s^2 - x rounded up is positive exactly when s is not exact, also where it underflows.
    pub fn sqrt_nlo(&mut self, x: Lane) -> Lane {
        let root = self.sqrt(x);
        let minus = self.neg(x);
        let residual = self.fma(root, root, minus);
        let zero = self.zero();
        let lowered = match self.less(zero, residual) {
            Mask::Lane(inexact) => {
                let step = self.push(LaneOp::MaskBits(inexact));
                self.add_to_bits(root, step)
            }
            _ => root,
        };
        self.neg(lowered)
    }

    pub fn sqrt_applied(&mut self, x: Ends) -> Applied {
        let zero = self.zero();
        let hi = self.max(x.hi, zero);
        let hi = self.sqrt(hi);
        let low = self.low(x);
        let low = self.max(low, zero);
        let nlo = self.sqrt_nlo(low);
        Applied { ends: Ends { nlo, hi }, empty: self.less(x.hi, zero), continuous: self.less_equal(x.nlo, zero) }
    }

    /// Set-based quotient: 1/[0, 1] is [1, inf), 1/[0, 0] is empty, and no infinity depends on the sign of a zero.
    /// `sign` is that of the divisor's ends.
    pub fn div_applied(&mut self, x: Ends, y: Ends, sign: Sign) -> Applied {
        let zero = self.zero();
        // Turn the divisor to [yl, yh] with yh > 0 where it does not reach above 0.
        let flip = match sign {
            Sign::NonNegative => Mask::False,
            Sign::NonPositive => Mask::True,
            Sign::Unknown => self.less_equal(y.hi, zero),
        };
        let (x_flipped, y_flipped) = (self.neg_ends(x), self.neg_ends(y));
        let x = self.select_ends(flip, x_flipped, x);
        let y = self.select_ends(flip, y_flipped, y);
        // Now 0 <= yl, or the divisor has 0 inside. Max gives +0 for either zero.
        let y_lo = self.low(y);
        let y_lo = self.max(y_lo, zero);
        let (hi, nlo) = (self.quotient_up(x.hi, y_lo, y.hi), self.quotient_up(x.nlo, y_lo, y.hi));
        let mut ends = Ends { nlo, hi };
        if sign == Sign::Unknown {
            let zero_inside = self.less(zero, y.nlo);
            let entire = self.entire();
            ends = self.select_ends(zero_inside, entire, ends);
        }
        let has_zero = self.contains_zero(y);
        Applied { ends, empty: self.less_equal(y.hi, zero), continuous: self.not(has_zero) }
    }

    /// An upper bound of n / y over 0 <= yl <= y <= yh: the larger of two quotients. 0/0 and inf/inf are NaN: beside 0/0
    /// stands 0/yh = 0, beside inf/inf stands inf/yl = inf, and either alone is right.
    fn quotient_up(&mut self, n: Lane, y_lo: Lane, y_hi: Lane) -> Lane {
        let near = self.div(n, y_lo);
        let far = self.div(n, y_hi);
        let ordered = self.equal(near, near);
        let near = self.select(ordered, near, far);
        self.max(far, near)
    }

    /// 0 or 1: `true` where proved, `false` where refuted, else [0, 1].
    pub fn truth_ends(&mut self, proved: Mask, refuted: Mask) -> Ends {
        let (zero, one, minus_one) = (self.zero(), self.number(1.0), self.number(-1.0));
        Ends { nlo: self.select(proved, minus_one, zero), hi: self.select(refuted, zero, one) }
    }
}
