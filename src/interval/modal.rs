//! Modal intervals: intervals whose ends may come in either order (Kaucher, "Interval analysis in the extended interval
//! space IR", 1980; Gardenes and others, "Modal intervals", 2001).
//!
//! [a, b] stands for the reals between a and b together with a quantifier: "there is" for a <= b (proper), "for all"
//! for a >= b (improper). What a result means is said by the *-semantic theorem: if f*(X) is included in Z, then
//!
//! > for all x_p in the proper X_p, [there is | for all] z in Z, there is x_i in the improper X_i, so that z = f(x_p, x_i),
//!
//! with "there is" for a proper Z. So [1, 3] + [3, 2] = [4, 5] says: for every x in [1, 3] there are z in [4, 5] and y in
//! [2, 3] with x + y = z. Here f*(X) = [min_p max_i f, max_p min_i f]; for each operation of this file it equals its
//! mirror image f**(X) = [max_i min_p f, min_i max_p f]. A formula in which a variable occurs more than once is another
//! matter: an improper one must become a point of it first (*theorem 5* of Florez, "Improvements in the ray tracing of
//! implicit surfaces based on interval arithmetic", 2008), unless monotony allows more (*theorems 3 and 6* there).
//!
//! Every operation rounds outward, the lower end down and the upper end up, whatever their order, so that f* is
//! included in the result. Inner rounding is the same through duals: [`Modal::inner`].

use super::{Interval, round};
use std::ops::{Add, Mul, Neg, Sub};

/// A modal interval: two ends in any order, neither of them NaN, zeros being +0.0. Infinite ends are limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Modal {
    lo: f64,
    hi: f64,
}

impl Modal {
    /// The first end `lo` and the second end `hi`, in any order; `None` if one is NaN.
    pub fn new(lo: f64, hi: f64) -> Option<Self> {
        (!lo.is_nan() && !hi.is_nan()).then(|| Self::outward(lo, hi))
    }

    /// The ends of a result; NaN says that nothing is known, and the outer infinity too.
    fn outward(lo: f64, hi: f64) -> Self {
        let known = |x: f64, otherwise: f64| if x.is_nan() { otherwise } else { x + 0.0 };
        Self { lo: known(lo, f64::NEG_INFINITY), hi: known(hi, f64::INFINITY) }
    }

    /// The proper interval of these members; `None` for the empty set, which no modal interval stands for.
    pub fn from_interval(x: Interval) -> Option<Self> {
        Self::new(x.lo(), x.hi())
    }

    /// The set of the members of a proper interval; `None` for an improper one.
    pub fn to_interval(self) -> Option<Interval> {
        Interval::new(self.lo, self.hi)
    }

    /// The first end: the least member of a proper interval, the greatest of an improper one.
    pub fn lo(self) -> f64 {
        self.lo
    }

    /// The second end.
    pub fn hi(self) -> f64 {
        self.hi
    }

    /// Whether the quantifier is "there is"; true for points, which are of both kinds.
    pub fn is_proper(self) -> bool {
        self.lo <= self.hi
    }

    /// The same reals with the other quantifier.
    pub fn dual(self) -> Self {
        Self { lo: self.hi, hi: self.lo }
    }

    /// The same reals with the quantifier "there is".
    pub fn prop(self) -> Self {
        if self.is_proper() { self } else { self.dual() }
    }

    /// Whether this is included in `other`: [a, b] in [c, d] if a >= c and b <= d.
    pub fn is_subset(self, other: Self) -> bool {
        self.lo >= other.lo && self.hi <= other.hi
    }

    /// Whether both ends are at most those of `other`.
    pub fn is_less_equal(self, other: Self) -> bool {
        self.lo <= other.lo && self.hi <= other.hi
    }

    /// The greatest interval that is included in both; improper if they have no member in common.
    pub fn meet(self, other: Self) -> Self {
        Self { lo: self.lo.max(other.lo), hi: self.hi.min(other.hi) }
    }

    /// The least interval that includes both.
    pub fn join(self, other: Self) -> Self {
        Self { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    /// The lesser of x and y.
    pub fn min(self, y: Self) -> Self {
        Self { lo: self.lo.min(y.lo), hi: self.hi.min(y.hi) }
    }

    /// The greater of x and y.
    pub fn max(self, y: Self) -> Self {
        Self { lo: self.lo.max(y.lo), hi: self.hi.max(y.hi) }
    }

    /// An operation, or a formula of operations, rounded inward: Inn(f(X)) = Dual(Out(f(Dual X))), since each operation
    /// on duals is the dual of the operation, and what is outside of the one is inside of the other.
    pub fn inner<const N: usize>(x: [Self; N], f: impl FnOnce([Self; N]) -> Self) -> Self {
        f(x.map(Self::dual)).dual()
    }

    /// x / y, or `None` if 0 lies between the ends of y or is one. The quotient is the product with [1/y2, 1/y1], each
    /// end rounded once.
    pub fn checked_div(self, y: Self) -> Option<Self> {
        let zero_free = y.lo > 0.0 && y.hi > 0.0 || y.lo < 0.0 && y.hi < 0.0;
        zero_free.then(|| product(self, y.dual(), round::div_down, round::div_up))
    }

    /// The square.
    pub fn sqr(self) -> Self {
        self.even(Interval::sqr)
    }

    /// The absolute value.
    pub fn abs(self) -> Self {
        self.even(Interval::abs)
    }

    /// x^n for n >= 0.
    pub fn powi(self, n: u16) -> Self {
        let power = |x: Interval| x.powi(n.into());
        if n.is_multiple_of(2) { self.even(power) } else { self.increasing(power) }
    }

    /// The square root, or `None` if a number below 0 lies between the ends.
    pub fn sqrt(self) -> Option<Self> {
        (self.prop().lo >= 0.0).then(|| self.increasing(Interval::sqrt))
    }

    /// The real cube root.
    pub fn cbrt(self) -> Self {
        self.increasing(Interval::cbrt)
    }

    /// e^x.
    pub fn exp(self) -> Self {
        self.increasing(Interval::exp)
    }

    /// The natural logarithm, or `None` unless all between the ends is above 0.
    pub fn ln(self) -> Option<Self> {
        (self.prop().lo > 0.0).then(|| self.increasing(Interval::ln))
    }

    /// arctan x.
    pub fn atan(self) -> Self {
        self.increasing(Interval::atan)
    }

    /// The hyperbolic tangent.
    pub fn tanh(self) -> Self {
        self.increasing(Interval::tanh)
    }

    /// A function that increases: [f(lo), f(hi)] in either order of the ends.
    fn increasing(self, f: impl Fn(Interval) -> Interval) -> Self {
        Self::outward(f(near(self.lo)).lo(), f(near(self.hi)).hi())
    }

    /// A function of |x| that increases with it. The least value is that at the member nearest to 0.
    fn even(self, f: impl Fn(Interval) -> Interval) -> Self {
        let Self { lo, hi } = self.prop();
        let least = if lo <= 0.0 && hi >= 0.0 { 0.0 } else { lo.abs().min(hi.abs()) };
        let values = Self { lo: least, hi: lo.abs().max(hi.abs()) };
        // Dual before rounding: an improper range has its greater end rounded down.
        if self.is_proper() { values.increasing(f) } else { values.dual().increasing(f) }
    }
}

/// The point {x}; for an infinite end the numbers past all `f64`, among whose values the limit of a monotone function
/// is.
fn near(x: f64) -> Interval {
    match x {
        f64::INFINITY => Interval::raw(f64::MAX, x),
        f64::NEG_INFINITY => Interval::raw(x, f64::MIN),
        _ => Interval::point(x),
    }
}

/// Where the ends of a factor lie.
#[derive(Clone, Copy)]
enum Signs {
    /// Both at least 0.
    Positive,
    /// Both below 0.
    Negative,
    /// The first below 0, the second not.
    Across,
    /// The second below 0, the first not.
    AcrossDual,
}

fn signs(x: Modal) -> Signs {
    match (x.lo >= 0.0, x.hi >= 0.0) {
        (true, true) => Signs::Positive,
        (false, false) => Signs::Negative,
        (false, true) => Signs::Across,
        (true, false) => Signs::AcrossDual,
    }
}

/// The product by the table of Kaucher, one product an end wherever signs settle which. `down` and `up` multiply, or
/// divide by the ends of `b` (which are then those of the divisor in the other order, and have one sign).
fn product(a: Modal, b: Modal, down: fn(f64, f64) -> f64, up: fn(f64, f64) -> f64) -> Modal {
    use Signs::{Across, AcrossDual, Negative, Positive};
    let (a1, a2, b1, b2) = (a.lo, a.hi, b.lo, b.hi);
    let corners = |lo: (f64, f64), hi: (f64, f64)| Modal::outward(down(lo.0, lo.1), up(hi.0, hi.1));
    match (signs(a), signs(b)) {
        (Positive, Positive) => corners((a1, b1), (a2, b2)),
        (Positive, AcrossDual) => corners((a1, b1), (a1, b2)),
        (Positive, Across) => corners((a2, b1), (a2, b2)),
        (Positive, Negative) => corners((a2, b1), (a1, b2)),
        (AcrossDual, Positive) => corners((a1, b1), (a2, b1)),
        (AcrossDual, AcrossDual) => Modal::outward(down(a1, b1).max(down(a2, b2)), up(a1, b2).min(up(a2, b1))),
        (AcrossDual, Across) | (Across, AcrossDual) => Modal { lo: 0.0, hi: 0.0 },
        (AcrossDual, Negative) => corners((a2, b2), (a1, b2)),
        (Across, Positive) => corners((a1, b2), (a2, b2)),
        (Across, Across) => Modal::outward(down(a1, b2).min(down(a2, b1)), up(a1, b1).max(up(a2, b2))),
        (Across, Negative) => corners((a2, b1), (a1, b1)),
        (Negative, Positive) => corners((a1, b2), (a2, b1)),
        (Negative, AcrossDual) => corners((a2, b2), (a2, b1)),
        (Negative, Across) => corners((a1, b2), (a1, b1)),
        (Negative, Negative) => corners((a2, b2), (a1, b1)),
    }
}

impl Neg for Modal {
    type Output = Self;

    fn neg(self) -> Self {
        Self::outward(-self.hi, -self.lo)
    }
}

impl Add for Modal {
    type Output = Self;

    fn add(self, y: Self) -> Self {
        Self::outward(round::add_down(self.lo, y.lo), round::add_up(self.hi, y.hi))
    }
}

impl Sub for Modal {
    type Output = Self;

    fn sub(self, y: Self) -> Self {
        self + -y
    }
}

impl Mul for Modal {
    type Output = Self;

    fn mul(self, y: Self) -> Self {
        product(self, y, round::mul_down, round::mul_up)
    }
}
