//! The coefficients of affine forms: an array for a fixed number of symbols, a sorted list for any number.

use super::{Form, Interval, round};
use std::fmt::Debug;

/// Coefficients of shared noise symbols, which are counted from 0.
pub trait Coefficients: Clone + PartialEq + Debug {
    /// All coefficients 0.
    const NONE: Self;

    /// Gives `symbol`, which has none yet, a coefficient; false if there is no such symbol.
    fn set(&mut self, symbol: usize, coefficient: f64) -> bool;

    /// Takes a symbol for the use of one form alone, until others are computed from it; false if the symbols are fixed.
    fn claim(&mut self, symbol: usize, coefficient: f64) -> bool;

    /// Every coefficient replaced, `f(0) = 0`.
    fn map(&self, f: impl FnMut(f64) -> f64) -> Self;

    /// The coefficients of each symbol combined, `f(0, 0) = 0`.
    fn zip(&self, other: &Self, f: impl FnMut(f64, f64) -> f64) -> Self;

    /// The coefficients that may differ from 0.
    fn values(&self) -> impl Iterator<Item = f64>;

    /// Encloses u v, where x = c + u and y = d + v for the centres c and d. Both forms are bounded.
    fn quadratic(x: &Form<Self>, y: &Form<Self>) -> Interval;
}

/// |u v| is at most the product of the radii.
fn independent<C: Coefficients>(x: &Form<C>, y: &Form<C>) -> Interval {
    let size = round::mul_up(x.radius(), y.radius());
    Interval::new(-size, size).unwrap_or(Interval::ENTIRE)
}

impl<const N: usize> Coefficients for [f64; N] {
    const NONE: Self = [0.0; N];

    fn set(&mut self, symbol: usize, coefficient: f64) -> bool {
        let place = self.get_mut(symbol);
        let found = place.is_some();
        place.into_iter().for_each(|a| *a = coefficient);
        found
    }

    fn claim(&mut self, _: usize, _: f64) -> bool {
        false
    }

    fn map(&self, f: impl FnMut(f64) -> f64) -> Self {
        <[f64; N]>::map(*self, f)
    }

    fn zip(&self, other: &Self, mut f: impl FnMut(f64, f64) -> f64) -> Self {
        std::array::from_fn(|i| f(self[i], other[i]))
    }

    fn values(&self) -> impl Iterator<Item = f64> {
        self.iter().copied()
    }

    fn quadratic(x: &Form<Self>, y: &Form<Self>) -> Interval {
        independent(x, y)
    }
}

/// Coefficients other than 0 of any number of symbols, by rising symbol.
#[derive(Clone, Debug, PartialEq)]
pub struct Sparse(Vec<(usize, f64)>);

impl Sparse {
    /// Each symbol with its coefficient, by rising symbol.
    pub fn terms(&self) -> &[(usize, f64)] {
        &self.0
    }
}

impl Coefficients for Sparse {
    const NONE: Self = Self(Vec::new());

    fn set(&mut self, symbol: usize, coefficient: f64) -> bool {
        let place = self.0.partition_point(|&(other, _)| other < symbol);
        self.0.insert(place, (symbol, coefficient));
        true
    }

    fn claim(&mut self, symbol: usize, coefficient: f64) -> bool {
        self.set(symbol, coefficient)
    }

    fn map(&self, mut f: impl FnMut(f64) -> f64) -> Self {
        let terms = self.0.iter().map(|&(symbol, a)| (symbol, f(a)));
        Self(terms.filter(|&(_, a)| a != 0.0).collect())
    }

    fn zip(&self, other: &Self, mut f: impl FnMut(f64, f64) -> f64) -> Self {
        let (mut left, mut right) = (self.0.iter().peekable(), other.0.iter().peekable());
        let mut terms = Vec::with_capacity(self.0.len() + other.0.len());
        loop {
            let symbol = match (left.peek(), right.peek()) {
                (Some(a), Some(b)) => a.0.min(b.0),
                (Some(one), None) | (None, Some(one)) => one.0,
                (None, None) => return Self(terms),
            };
            let a = left.next_if(|term| term.0 == symbol).map_or(0.0, |term| term.1);
            let b = right.next_if(|term| term.0 == symbol).map_or(0.0, |term| term.1);
            let combined = f(a, b);
            if combined != 0.0 {
                terms.push((symbol, combined));
            }
        }
    }

    fn values(&self) -> impl Iterator<Item = f64> {
        self.0.iter().map(|&(_, a)| a)
    }

    /// For every s > 0, u v = ((u + s v)^2 - (u - s v)^2) / 4s, so that u v is at least -rad(u - s v)^2 / 4s and at
    /// most rad(u + s v)^2 / 4s. With s the quotient of the radii neither is larger than the product of the radii, and
    /// what u and v share cancels in one of them: the square of a form gets [0, rad^2].
    fn quadratic(x: &Form<Self>, y: &Form<Self>) -> Interval {
        const MODERATE: std::ops::Range<f64> = 1e-100..1e100;
        let s = x.radius() / y.radius();
        if !MODERATE.contains(&s) {
            return independent(x, y);
        }
        // The largest |a + factor b|, and the sum of those with the private errors, which share nothing: rounded up.
        let reach = |factor: f64| {
            let size = |a: f64, b: f64| {
                let up = round::add_up(a, round::mul_up(factor, b));
                let down = round::add_down(a, round::mul_down(factor, b));
                up.max(-down)
            };
            let own = round::add_up(x.error(), round::mul_up(s, y.error()));
            let sizes = x.coefficients().zip(y.coefficients(), size);
            let radius = sizes.values().fold(own, round::add_up);
            round::div_up(round::mul_up(radius, radius), 4.0 * s)
        };
        let (below, above) = (reach(-s), reach(s));
        Interval::new(-below, above).map_or(Interval::ENTIRE, |range| range.intersect(independent(x, y)))
    }
}
