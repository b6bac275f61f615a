//! Exact algebra of polynomial curves over the rationals, for the few places that interval tests leave open.
//!
//! [`Polynomial`] reads what it can from a graph; [`coprime_base`] splits polynomials at common factors; [`Algebra::settle`]
//! proves what curves do near a point. All of it is exact: results of modular arithmetic are taken modulo enough primes, and
//! enclosures of algebraic numbers are refined until they decide.

mod algebra;
mod base;
mod convert;
mod fibre;
mod finding;
mod fixed;
mod modular;
mod polynomial;
mod roots;
mod star;
mod subresultant;
mod univariate;

#[cfg(test)]
mod tests;

pub use algebra::Algebra;
pub use algebra::settle;
pub use base::Factor;
pub use base::coprime_base;
pub use finding::Arcs;
pub use finding::Branch;
pub use finding::Contact;
pub use finding::Finding;
pub use finding::Star;
pub use polynomial::Polynomial;
pub use roots::Root;
pub use univariate::Univariate;
