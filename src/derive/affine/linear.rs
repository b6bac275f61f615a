//! What every form of a function of one variable is: a slope, and an enclosure of what the function leaves of it.
//!
//! If f(x) - s x lies in R for all x of an enclosure X, then s times the form of x plus R is a form of f(x), whatever
//! number s is: the form's noise symbols keep their meaning, R's middle moves its centre and R's radius joins its error.
//! Of an x outside the domain of f nothing is said.

use crate::derive::affine::Af1;
use crate::derive::affine::centre_and_radius;
use crate::derive::affine::scaled;
use crate::derive::ends::Ends;
use crate::derive::lanes::Builder;
use crate::derive::lanes::Lane;

/// f(x) - slope x lies in `rest` for all x of the operand's enclosure at which f is defined.
///
/// A slope that is not finite makes the form useless: its centre is not finite then, and its error is NaN.
#[derive(Debug, Clone, Copy)]
pub struct Linear {
    pub slope: Lane,
    pub rest: Ends,
}

impl Linear {
    /// The form of f(x).
    pub fn apply(self, b: &mut Builder, x: &Af1) -> Af1 {
        // slope x0 + rest as an enclosure, so that its radius covers the centre's roundings.
        let minus = b.neg(x.centre);
        let ends = Ends { nlo: b.fma(self.slope, minus, self.rest.nlo), hi: b.fma(self.slope, x.centre, self.rest.hi) };
        let (centre, error) = centre_and_radius(b, ends);
        let steepness = b.abs(self.slope);
        scaled(b, Af1 { centre, coefficients: x.coefficients, error }, self.slope, steepness, x)
    }

    /// f increases on x at least as fast as `slope` >= 0 and has its values in y. Then f(x) - slope x increases too, and
    /// its ends are those at the ends of x (min-range: de Figueiredo and Stolfi 2004).
    pub fn rising(b: &mut Builder, slope: Lane, x: Ends, y: Ends) -> Linear {
        let minus = b.neg(slope);
        Linear { slope, rest: Ends { nlo: b.fma(minus, x.nlo, y.nlo), hi: b.fma(minus, x.hi, y.hi) } }
    }

    /// The same for f that decreases at least as fast as -`fall` <= 0.
    pub fn falling(b: &mut Builder, fall: Lane, x: Ends, y: Ends) -> Linear {
        let minus = b.neg(fall);
        Linear { slope: minus, rest: Ends { nlo: b.fma(minus, x.hi, y.nlo), hi: b.fma(minus, x.nlo, y.hi) } }
    }

    /// The same by the sign of `slope`: f' has that sign and at least that size on all of x. With 0, f may be anything.
    pub fn monotone(b: &mut Builder, slope: Lane, x: Ends, y: Ends) -> Linear {
        let zero = b.zero();
        // Max and Min would make 0 of a NaN; the slope itself keeps it.
        let (rise, fall) = (b.max(slope, zero), b.min(slope, zero));
        let minus_rise = b.neg(rise);
        let partial = Ends { nlo: b.fma(minus_rise, x.nlo, y.nlo), hi: b.fma(minus_rise, x.hi, y.hi) };
        Linear { slope, rest: Ends { nlo: b.fma(fall, x.hi, partial.nlo), hi: b.fma(fall, x.nlo, partial.hi) } }
    }
}
