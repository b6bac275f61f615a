//! The places in x where something may happen to curves: roots of discriminants, resultants and leading coefficients.

use std::collections::HashMap;
use std::sync::Arc;
use std::sync::Mutex;

use num_bigint::BigInt;
use num_rational::BigRational;

use crate::arrange::exact::finding::Finding;
use crate::arrange::exact::polynomial::Polynomial;
use crate::arrange::exact::star;
use crate::arrange::exact::subresultant::TooLarge;
use crate::arrange::exact::subresultant::resultant;
use crate::arrange::exact::univariate::Univariate;
use crate::interval::Interval;

/// Square-free polynomials in x whose roots are events, or that they cannot be had.
type Events = Result<Arc<Vec<Univariate>>, TooLarge>;

/// Polynomials that are square-free and pairwise coprime, with what has been computed of them so far.
#[derive(Debug, Default)]
pub struct Algebra {
    /// As given, and with x and y exchanged.
    polys: Vec<[Polynomial; 2]>,
    /// By exchange, and the two polynomials that meet; a polynomial with itself stands for its own events.
    events: Mutex<HashMap<(usize, usize, usize), Events>>,
}

/// Two polynomials share a factor, or one is not square-free.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Missing {
    Dependent,
    TooLarge,
}

impl Algebra {
    /// For polynomials as [`crate::arrange::exact::coprime_base`] returns them.
    pub fn new(polys: impl IntoIterator<Item = Polynomial>) -> Self {
        let both = |poly: Polynomial| {
            let poly = poly.primitive();
            [poly.exchanged().primitive(), poly]
        };
        let polys = polys.into_iter().map(both).map(|[exchanged, poly]| [poly, exchanged]).collect();
        Self { polys, events: Mutex::default() }
    }

    /// What the zero sets of these polynomials do together in the area, or in a somewhat larger box.
    pub fn settle(&self, indices: &[usize], area: [Interval; 2]) -> Finding {
        star::settle(self, indices, area)
    }

    /// A polynomial, with x and y exchanged for `exchange = 1`.
    pub(super) fn poly(&self, index: usize, exchange: usize) -> &Polynomial {
        &self.polys[index][exchange]
    }

    /// The roots of these polynomials in x are where curves may turn, meet themselves, or come from infinity; for two
    /// indices, where two curves meet. Vertical lines are their own events.
    pub(super) fn events(&self, exchange: usize, i: usize, j: usize) -> Result<Arc<Vec<Univariate>>, Missing> {
        let key = (exchange, i.min(j), i.max(j));
        let known = self.lock().get(&key).cloned();
        let events = known.unwrap_or_else(|| {
            let events = self.compute(key).map(Arc::new);
            self.lock().insert(key, events.clone());
            events
        });
        let events = events.map_err(|TooLarge| Missing::TooLarge)?;
        if events.iter().any(Univariate::is_zero) { Err(Missing::Dependent) } else { Ok(events) }
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, HashMap<(usize, usize, usize), Events>> {
        self.events.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    /// A zero polynomial among the events says that resultants vanish.
    fn compute(&self, (exchange, i, j): (usize, usize, usize)) -> Result<Vec<Univariate>, TooLarge> {
        let (f, g) = (self.poly(i, exchange), self.poly(j, exchange));
        let mut sources = Vec::new();
        if i != j {
            // A vertical line is an event anyway.
            if f.degree_y() > 0 && g.degree_y() > 0 {
                sources.push(resultant(f, g)?);
            } else if f.degree_y() == 0 && g.degree_y() == 0 && !f.leading().gcd(&g.leading()).is_constant() {
                sources.push(Univariate::default());
            }
        } else {
            sources.push(f.leading());
            if f.degree_y() > 1 {
                sources.push(resultant(f, &f.derivative_y())?);
            }
        }
        let mut events: Vec<Univariate> = Vec::new();
        for source in sources {
            if source.is_zero() {
                events.push(source);
            } else {
                events.extend(source.square_free().into_iter().map(|(factor, _)| factor));
            }
        }
        Ok(events)
    }
}

/// Settles one question: [`Algebra::settle`] without anything to remember.
pub fn settle(polys: &[&Polynomial], area: [Interval; 2]) -> Finding {
    let indices: Vec<usize> = (0..polys.len()).collect();
    Algebra::new(polys.iter().map(|&poly| poly.clone())).settle(&indices, area)
}

/// A floating-point number as a fraction; 0 for infinities, which callers exclude.
pub(super) fn exact(x: f64) -> BigRational {
    BigRational::from_float(x).unwrap_or_else(|| BigRational::from_integer(BigInt::from(0)))
}
