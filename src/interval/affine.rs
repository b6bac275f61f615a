//! Affine forms: a value as an affine function of noise symbols, up to an error (Stolfi and de Figueiredo,
//! "Self-validated numerical methods and applications", 1997).
//!
//! A form stands for c + a_1 e_1 + a_2 e_2 + ... + r d, with every e_i and d in [-1, 1]. The e_i are shared by all
//! forms, so that what two of them have in common cancels; d is private to a form, and takes up all that is not
//! affine and every rounding. A coefficient is rounded down, and by how much rounding it up would differ is added to
//! r.
//!
//! With a fixed number of symbols these are the forms AF1 of Messine, "Extensions of affine arithmetic: application to
//! unconstrained global optimization" (2002). A full form has as many as it needs: [`Form::claim`] turns the private
//! error of a result into a symbol that all further results share.

use super::affine_terms::{Coefficients, Sparse};
use super::{Interval, Linear, round};
use std::ops::{Add, Mul, Neg, Sub};

/// An affine form. Invariant: centre and coefficients are finite, `error >= 0`; an infinite error means unbounded, with
/// all else 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Form<C> {
    centre: f64,
    coefficients: C,
    error: f64,
}

/// A form in `N` shared symbols: AF1.
pub type Affine<const N: usize> = Form<[f64; N]>;

/// A form in any number of symbols.
pub type FullAffine = Form<Sparse>;

/// An error term that only grows, rounded up.
struct Error(f64);

impl Error {
    fn add(&mut self, size: f64) {
        self.0 = round::add_up(self.0, size);
    }

    /// A real number between `down` and `up` as one of the two, with the difference on record.
    fn settle(&mut self, down: f64, up: f64) -> f64 {
        self.add(round::sub_up(up, down));
        down
    }

    fn sum(&mut self, x: f64, y: f64) -> f64 {
        self.settle(round::add_down(x, y), round::add_up(x, y))
    }

    fn product(&mut self, x: f64, y: f64) -> f64 {
        self.settle(round::mul_down(x, y), round::mul_up(x, y))
    }

    /// The coefficient x y + z w of a product.
    fn products(&mut self, (x, y): (f64, f64), (z, w): (f64, f64)) -> f64 {
        let down = round::add_down(round::mul_down(x, y), round::mul_down(z, w));
        let up = round::add_up(round::mul_up(x, y), round::mul_up(z, w));
        self.settle(down, up)
    }
}

impl<C: Coefficients> Form<C> {
    /// The form that says nothing: every real number.
    pub const UNBOUNDED: Self = Self { centre: 0.0, coefficients: C::NONE, error: f64::INFINITY };

    /// The members of `x` as a function of the symbol `symbol`, counted from 0; as [`Form::constant`] if there is
    /// no such symbol.
    pub fn from_interval(x: Interval, symbol: usize) -> Self {
        let mut form = Self::constant(x);
        if form.is_bounded() && form.error > 0.0 && form.coefficients.set(symbol, form.error) {
            form.error = 0.0;
        }
        form
    }

    /// A number about which only `x` is known, sharing no symbol. Unbounded if `x` is empty or unbounded: an affine
    /// form has no way to be empty, and the caller keeps that apart.
    pub fn constant(x: Interval) -> Self {
        if x.is_bounded() { Self::bounded(x.mid(), C::NONE, Error(x.rad())) } else { Self::UNBOUNDED }
    }

    /// The form with these parts, or the unbounded one if a part has left the finite numbers.
    fn bounded(centre: f64, coefficients: C, error: Error) -> Self {
        let finite = centre.is_finite() && coefficients.values().all(f64::is_finite) && error.0.is_finite();
        if finite { Self { centre, coefficients, error: error.0 } } else { Self::UNBOUNDED }
    }

    /// The same value with its error as a symbol of its own, of the index `symbol`, which no other form has taken. With
    /// a fixed number of symbols nothing changes.
    pub fn claim(mut self, symbol: usize) -> Self {
        if self.is_bounded() && self.error > 0.0 && self.coefficients.claim(symbol, self.error) {
            self.error = 0.0;
        }
        self
    }

    /// The value where every symbol is 0, up to the error.
    pub fn centre(&self) -> f64 {
        self.centre
    }

    /// The coefficients of the shared symbols.
    pub fn coefficients(&self) -> &C {
        &self.coefficients
    }

    /// The bound of all that is not affine in the symbols.
    pub fn error(&self) -> f64 {
        self.error
    }

    /// Whether the form bounds its value.
    pub fn is_bounded(&self) -> bool {
        self.error < f64::INFINITY
    }

    /// How far from the centre a value can be, rounded up.
    pub fn radius(&self) -> f64 {
        self.coefficients.values().fold(self.error, |sum, a| round::add_up(sum, a.abs()))
    }

    /// The interval of all values.
    pub fn to_interval(&self) -> Interval {
        let radius = self.radius();
        if radius.is_infinite() {
            return Interval::ENTIRE;
        }
        Interval::raw(round::sub_down(self.centre, radius), round::add_up(self.centre, radius))
    }

    /// The values of a function, given between two lines over an interval that holds this form's value.
    pub fn apply(&self, function: &Linear) -> Self {
        let offset = Self::constant(function.offset());
        if function.slope() == 0.0 { offset } else { self.scale(Interval::point(function.slope())) + offset }
    }

    /// The product with a number of which `factor` is known; unbounded if that is empty or unbounded.
    pub fn scale(&self, factor: Interval) -> Self {
        if !factor.is_bounded() || !self.is_bounded() {
            return Self::UNBOUNDED;
        }
        let mid = factor.mid();
        let size = round::add_up(self.centre.abs(), self.radius());
        let mut error = Error(round::mul_up(mid.abs(), self.error));
        error.add(round::mul_up(factor.rad(), size));
        let centre = error.product(self.centre, mid);
        let coefficients = self.coefficients.map(|a| error.product(a, mid));
        Self::bounded(centre, coefficients, error)
    }
}

impl<C: Coefficients> Neg for Form<C> {
    type Output = Self;

    fn neg(self) -> Self {
        Self { centre: -self.centre, coefficients: self.coefficients.map(|a| -a), error: self.error }
    }
}

impl<C: Coefficients> Add for Form<C> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let mut error = Error(round::add_up(self.error, other.error));
        let centre = error.sum(self.centre, other.centre);
        let coefficients = self.coefficients.zip(&other.coefficients, |a, b| error.sum(a, b));
        Self::bounded(centre, coefficients, error)
    }
}

impl<C: Coefficients> Sub for Form<C> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<C: Coefficients> Mul for Form<C> {
    type Output = Self;

    /// (c + u)(d + v) = c d + c v + d u + u v.
    fn mul(self, other: Self) -> Self {
        if !self.is_bounded() || !other.is_bounded() {
            return Self::UNBOUNDED;
        }
        let quadratic = C::quadratic(&self, &other);
        if !quadratic.is_bounded() {
            return Self::UNBOUNDED;
        }
        let mut error = Error(quadratic.rad());
        error.add(round::mul_up(self.centre.abs(), other.error));
        error.add(round::mul_up(other.centre.abs(), self.error));
        let product = error.product(self.centre, other.centre);
        let centre = error.sum(product, quadratic.mid());
        let coefficients =
            self.coefficients.zip(&other.coefficients, |a, b| error.products((a, other.centre), (b, self.centre)));
        Self::bounded(centre, coefficients, error)
    }
}
