//! All zeros of a function of one variable in an interval, with proofs: of a formula in one of its variables, or along a ray
//! through its coordinates.
//!
//! [`Solver`] and [`RaySolver`] compile a formula once and answer many times, for other intervals, parameters and rays.
//! [`Search`] needs no compiler: it works on the reference arithmetic, slowly. Both say the same, up to the width of brackets:
//!
//! - each [`Root::bracket`] is proved to hold a zero, and [`Root::alone`] to hold no other;
//! - there is no zero outside of the brackets and of [`Roots::unknown`].
//!
//! Parameters are intervals. What is proved holds for each of their values: a bracket holds a zero of every function of the
//! family, not the same number for all of them.
//!
//! ```
//! use imp::control::Control;
//! use imp::graph::Graph;
//! use imp::interval::Interval;
//! use imp::roots::{Options, Solver};
//! use imp::session;
//!
//! // x^2 = a, for many a.
//! let mut graph = Graph::new();
//! let (x, a) = (graph.var("x"), graph.var("a"));
//! let square = graph.sqr(x);
//! let f = graph.sub(square, a);
//! let solver = Solver::new(&graph, f, "x", &[], session::backend())?;
//! let range = Interval::new(0.0, 10.0).expect("the ends are in order");
//! for a in [2.0, 3.0, 5.0] {
//!     let found = solver.roots(&[Interval::point(a)], range, &Options::default(), &Control::default());
//!     assert!(found.is_complete() && found.proved.len() == 1);
//!     assert!(found.proved[0].bracket.contains(f64::sqrt(a)));
//! }
//! # Ok::<(), imp::diagnostic::Diagnostic>(())
//! ```

mod answer;
mod numbers;
mod packets;
mod problem;
mod search;
mod solver;

pub use answer::Options;
pub use answer::Root;
pub use answer::Roots;
pub use search::Search;
pub use solver::RaySolver;
pub use solver::Solver;
