//! Interval arithmetic in `f64`, set-based in the sense of IEEE 1788: the reference of everything that Imp proves.
//!
//! An [`Interval`] is a closed connected set of real numbers. An operation returns an enclosure of all values that the
//! function takes on the part of the argument that lies in its domain. Bounds of arithmetic, of roots and of small
//! rational powers are the tightest that `f64` has; those of elementary functions are at most one unit in the last
//! place wider than that on each side. `docs/conformance.md` lists every operation of the standard.
//!
//! - [`round`]: directed rounding;
//! - [`Interval`] and its operations, in one file per group;
//! - [`Verdict`]: answers to questions about numbers of which only a set is known; [`Overlap`] and the relations of the
//!   standard compare the sets themselves;
//! - [`Decorated`]: an interval with what is known about the function on its way there;
//! - both read from text, the literals of the standard, with a [`LiteralError`] for what is none;
//! - [`Form`]: affine forms, with a bounded number of noise symbols ([`Affine`]) or any ([`FullAffine`]);
//! - [`Linear`]: functions between two parallel lines, with which affine forms pass through them;
//! - [`Modal`]: intervals with a quantifier, whose ends come in either order.

mod affine;
mod affine_terms;
mod arith;
mod cancel;
mod decorated_sets;
mod decoration;
mod elementary;
mod exact;
mod exchange;
mod integer;
mod linear;
mod linear_functions;
mod modal;
mod parse;
mod power;
mod relations;
mod reverse;
pub mod round;
mod set_ops;
mod text;
mod trigonometric;
mod verdict;

#[cfg(test)]
mod tests;

pub use affine::{Affine, Form, FullAffine};
pub use affine_terms::{Coefficients, Sparse};
pub use decoration::{Decorated, Decoration};
pub use exchange::NoInterval;
pub use linear::Linear;
pub use modal::Modal;
pub use parse::LiteralError;
pub use relations::Overlap;
pub use text::decimal;
pub use verdict::Verdict;

use num_rational::BigRational;

/// A closed, connected, possibly empty or unbounded set of real numbers.
///
/// Invariant: `lo <= hi`, `lo < +inf`, `hi > -inf`; empty is (NaN, NaN). Zero bounds are +0.0, so that equal sets have
/// equal bits. An infinite bound says that the set is unbounded there; infinity itself is never a member.
#[derive(Clone, Copy)]
pub struct Interval {
    lo: f64,
    hi: f64,
}

impl Interval {
    /// The empty set.
    pub const EMPTY: Self = Self { lo: f64::NAN, hi: f64::NAN };
    /// All real numbers.
    pub const ENTIRE: Self = Self { lo: f64::NEG_INFINITY, hi: f64::INFINITY };
    /// The set {0}.
    pub const ZERO: Self = Self { lo: 0.0, hi: 0.0 };
    /// The set {1}.
    pub const ONE: Self = Self { lo: 1.0, hi: 1.0 };
    /// [0, 1]: a truth value that is not known.
    pub const UNIT: Self = Self { lo: 0.0, hi: 1.0 };
    /// The tightest enclosure of pi: `f64::consts::PI` is pi rounded down (pi - PI = 1.2e-16).
    pub const PI: Self = Self { lo: std::f64::consts::PI, hi: std::f64::consts::PI.next_up() };
    /// The tightest enclosure of pi / 2, half of [`Interval::PI`] exactly.
    pub const HALF_PI: Self = Self { lo: std::f64::consts::FRAC_PI_2, hi: std::f64::consts::FRAC_PI_2.next_up() };
    /// [0, inf].
    pub(super) const NONNEGATIVE: Self = Self { lo: 0.0, hi: f64::INFINITY };

    /// IEEE 1788 `numsToInterval`: the set of reals from `lo` to `hi`; `None` unless `lo <= hi`, `lo < +inf` and
    /// `hi > -inf`. Never swaps the ends.
    pub fn new(lo: f64, hi: f64) -> Option<Self> {
        // Adding +0.0 turns -0.0 into +0.0 and changes nothing else.
        (lo <= hi && lo < f64::INFINITY && hi > f64::NEG_INFINITY).then_some(Self { lo: lo + 0.0, hi: hi + 0.0 })
    }

    /// As [`Interval::new`], for bounds that satisfy the invariant by construction.
    fn raw(lo: f64, hi: f64) -> Self {
        debug_assert!(lo <= hi && lo < f64::INFINITY && hi > f64::NEG_INFINITY, "not an interval: {lo:?}, {hi:?}");
        Self { lo: lo + 0.0, hi: hi + 0.0 }
    }

    /// The set {x}; empty unless `x` is finite, since no real number is meant.
    pub fn point(x: f64) -> Self {
        if x.is_finite() { Self::raw(x, x) } else { Self::EMPTY }
    }

    /// The tightest enclosure of an exact rational number.
    pub fn from_rational(x: &BigRational) -> Self {
        Self::raw(round::rational_down(x), round::rational_up(x))
    }

    /// The lower bound: NaN if empty, -inf if unbounded below.
    pub fn lo(self) -> f64 {
        self.lo
    }

    /// The upper bound: NaN if empty, inf if unbounded above.
    pub fn hi(self) -> f64 {
        self.hi
    }

    /// Whether this is the empty set.
    pub fn is_empty(self) -> bool {
        self.lo.is_nan()
    }

    /// Whether this is the set of all reals.
    pub fn is_entire(self) -> bool {
        self.lo == f64::NEG_INFINITY && self.hi == f64::INFINITY
    }

    /// IEEE 1788 `isCommonInterval`: whether both bounds are finite; false for the empty set.
    pub fn is_bounded(self) -> bool {
        self.lo > f64::NEG_INFINITY && self.hi < f64::INFINITY
    }

    /// Whether this set has exactly one member.
    pub fn is_singleton(self) -> bool {
        self.lo == self.hi
    }
}

/// Equality of sets; empty equals empty.
impl PartialEq for Interval {
    fn eq(&self, other: &Self) -> bool {
        self.is_empty() && other.is_empty() || self.lo == other.lo && self.hi == other.hi
    }
}

impl Eq for Interval {}
