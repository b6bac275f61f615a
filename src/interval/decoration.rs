//! Decorated intervals (IEEE 1788, chapter 11): an enclosure, and what is known about the function on the way there.
//!
//! Each operation below names, beside its enclosure, the *local* decoration: what holds of that one operation on that
//! argument box. The result gets the least of the local one and those of the arguments, since definedness, continuity
//! and boundedness survive composition only together.

use super::{Interval, Verdict};
use std::fmt;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// What is known about a function on a box. A greater one implies all smaller ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Decoration {
    /// Not an interval: the construction went wrong.
    Ill,
    /// Nothing.
    Trv,
    /// Defined on the whole box, which is not empty.
    Def,
    /// Defined on the box, and continuous when restricted to it.
    Dac,
    /// Defined and continuous at each point of the box; the box and the enclosure are bounded.
    Com,
}

/// `com`, `dac`, `def`, `trv` or `ill`.
impl fmt::Display for Decoration {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.pad(match self {
            Self::Ill => "ill",
            Self::Trv => "trv",
            Self::Def => "def",
            Self::Dac => "dac",
            Self::Com => "com",
        })
    }
}

/// An interval with its decoration. Invariant: an empty set has at most `Trv`, an unbounded one at most `Dac`; `Ill`
/// comes with the empty set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Decorated {
    interval: Interval,
    decoration: Decoration,
}

/// A literal of IEEE 1788 such as `[0, 1]_com`, or `[nai]`.
impl fmt::Display for Decorated {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        if self.is_nai() {
            return f.pad("[nai]");
        }
        f.pad(&format!("{}_{}", self.interval, self.decoration))
    }
}

impl Decorated {
    /// IEEE 1788 `NaI`, not an interval; every operation on it is ill too. It has the empty set for its interval.
    ///
    /// It is equal to itself under `==`, which compares representations; the relations of the standard, such as
    /// [`Decorated::same_set`], are all false for it.
    pub const ILL: Self = Self { interval: Interval::EMPTY, decoration: Decoration::Ill };

    /// IEEE 1788 `empty`: the empty set, `trv`.
    pub const EMPTY: Self = Self { interval: Interval::EMPTY, decoration: Decoration::Trv };
    /// IEEE 1788 `entire`: all real numbers, `dac`.
    pub const ENTIRE: Self = Self { interval: Interval::ENTIRE, decoration: Decoration::Dac };

    /// IEEE 1788 `newDec`: the identity function on `interval`, `Com` if bounded, `Dac` if unbounded, `Trv` if empty.
    pub fn new(interval: Interval) -> Self {
        Self::with(interval, Decoration::Com)
    }

    /// IEEE 1788 `setDec`: `interval` with the greatest decoration up to `decoration` that the invariant allows.
    pub fn with(interval: Interval, decoration: Decoration) -> Self {
        let most = if decoration == Decoration::Ill {
            return Self::ILL;
        } else if interval.is_empty() {
            Decoration::Trv
        } else if interval.is_bounded() {
            Decoration::Com
        } else {
            Decoration::Dac
        };
        Self { interval, decoration: decoration.min(most) }
    }

    /// IEEE 1788 `intervalPart`: the enclosure; the empty set of [`Decorated::ILL`].
    pub fn interval(self) -> Interval {
        self.interval
    }

    /// IEEE 1788 `decorationPart`: what is known.
    pub fn decoration(self) -> Decoration {
        self.decoration
    }

    /// The enclosure of an `if` whose condition has the given truth value. An arm that is proved unselected gives
    /// neither value nor decoration; undecided, the result is the hull of both arms and no better than defined.
    pub fn select(condition: Verdict, then: Self, otherwise: Self) -> Self {
        match condition {
            Verdict::Proved => then,
            Verdict::Refuted => otherwise,
            Verdict::Unknown => Self::with(
                then.interval.hull(otherwise.interval),
                then.decoration.min(otherwise.decoration).min(Decoration::Def),
            ),
        }
    }
}

/// `Com` on the domain, `Trv` off it: the functions that are continuous wherever they are defined.
fn defined(inside: bool) -> Decoration {
    if inside { Decoration::Com } else { Decoration::Trv }
}

/// The decoration of a step function: undecided between steps, it is defined only; on one step, it is continuous
/// there, and as a function on the whole line unless the box touches the `edge` of the step.
fn stepwise(one_step: bool, edge: bool) -> Decoration {
    match (one_step, edge) {
        (false, _) => Decoration::Def,
        (true, true) => Decoration::Dac,
        (true, false) => Decoration::Com,
    }
}

/// The decoration of a comparison, as a function into {0, 1}: it jumps where both sides are equal.
fn comparison(answer: Verdict, x: Interval, y: Interval) -> Decoration {
    stepwise(answer != Verdict::Unknown, !x.disjoint(y))
}

fn whole(x: f64) -> bool {
    x.fract() == 0.0
}

fn half(x: f64) -> bool {
    x.fract().abs() == 0.5
}

/// The remainder jumps where the quotient is a whole number, that is where it is 0 itself.
fn remainder(x: Interval, y: Interval) -> Decoration {
    if y.contains(0.0) {
        return Decoration::Trv;
    }
    let quotient = if y.hi() < 0.0 { (-x).quotient_floor(-y) } else { x.quotient_floor(y) };
    stepwise(quotient.is_some(), x.modulo(y).contains(0.0))
}

/// The angle is undefined at the origin and jumps from -pi to pi across the negative x axis, to whose upper side it
/// belongs: seen from there it is continuous, at each point of the plane it is not.
fn angle(y: Interval, x: Interval) -> Decoration {
    if y.contains(0.0) && x.contains(0.0) {
        Decoration::Trv
    } else {
        stepwise(!(x.lo() < 0.0 && y.lo() < 0.0 && y.hi() >= 0.0), x.lo() < 0.0 && y.contains(0.0))
    }
}

/// Operations of one argument, each with its local decoration on a box that is not empty.
macro_rules! unary {
    ($($name:ident($x:ident) $local:expr;)*) => {
        impl Decorated {
            $(#[doc = concat!("[`Interval::", stringify!($name), "`], decorated.")]
            pub fn $name(self) -> Self {
                let $x = self.interval;
                self.then($x.$name(), if $x.is_empty() { Decoration::Trv } else { $local })
            })*
        }
    };
}

/// Operations of two arguments, as in `unary`.
macro_rules! binary {
    ($($name:ident($x:ident, $y:ident) $value:expr, $local:expr;)*) => {
        impl Decorated {
            $(#[doc = concat!("[`Interval::", stringify!($name), "`], decorated.")]
            pub fn $name(self, other: Self) -> Self {
                let ($x, $y) = (self.interval, other.interval);
                let local = if $x.is_empty() || $y.is_empty() { Decoration::Trv } else { $local };
                self.then($value, local.min(other.decoration))
            })*
        }
    };
}

unary! {
    recip(x) defined(!x.contains(0.0));
    sqr(x) Decoration::Com;
    abs(x) Decoration::Com;
    sqrt(x) defined(x.lo() >= 0.0);
    cbrt(x) Decoration::Com;
    rsqrt(x) defined(x.lo() > 0.0);
    sign(x) stepwise(x.sign().is_singleton(), x.contains(0.0));
    floor(x) stepwise(x.floor().is_singleton(), whole(x.lo()));
    ceil(x) stepwise(x.ceil().is_singleton(), whole(x.hi()));
    round(x) stepwise(x.round().is_singleton(), half(x.lo()) || half(x.hi()));
    round_ties_even(x) stepwise(x.round_ties_even().is_singleton(), half(x.lo()) || half(x.hi()));
    trunc(x) stepwise(x.trunc().is_singleton(), x.lo() > 0.0 && whole(x.lo()) || x.hi() < 0.0 && whole(x.hi()));
    exp(x) Decoration::Com;
    exp2(x) Decoration::Com;
    exp10(x) Decoration::Com;
    expm1(x) Decoration::Com;
    exp2m1(x) Decoration::Com;
    exp10m1(x) Decoration::Com;
    ln(x) defined(x.lo() > 0.0);
    log2(x) defined(x.lo() > 0.0);
    log10(x) defined(x.lo() > 0.0);
    log1p(x) defined(x.lo() > -1.0);
    log2p1(x) defined(x.lo() > -1.0);
    log10p1(x) defined(x.lo() > -1.0);
    sin(x) Decoration::Com;
    cos(x) Decoration::Com;
    tan(x) defined(!x.has_tangent_pole());
    asin(x) defined(x.lo() >= -1.0 && x.hi() <= 1.0);
    acos(x) defined(x.lo() >= -1.0 && x.hi() <= 1.0);
    atan(x) Decoration::Com;
    sinh(x) Decoration::Com;
    cosh(x) Decoration::Com;
    tanh(x) Decoration::Com;
    asinh(x) Decoration::Com;
    acosh(x) defined(x.lo() >= 1.0);
    atanh(x) defined(x.lo() > -1.0 && x.hi() < 1.0);
}

binary! {
    min(x, y) x.min(y), Decoration::Com;
    max(x, y) x.max(y), Decoration::Com;
    hypot(x, y) x.hypot(y), Decoration::Com;
    modulo(x, y) x.modulo(y), remainder(x, y);
    pow(x, y) x.pow(y), defined(x.lo() > 0.0 || x.lo() == 0.0 && y.lo() > 0.0);
    atan2(y, x) y.atan2(x), angle(y, x);
    less(x, y) x.less(y).to_interval(), comparison(x.less(y), x, y);
    less_equal(x, y) x.less_equal(y).to_interval(), comparison(x.less_equal(y), x, y);
    equal(x, y) x.equal(y).to_interval(), comparison(x.equal(y), x, y);
}

impl Decorated {
    /// The result of an operation on this and perhaps other arguments, whose least decoration `local` includes.
    fn then(self, value: Interval, local: Decoration) -> Self {
        Self::with(value, self.decoration.min(local))
    }

    /// [`Interval::powi`], decorated.
    pub fn powi(self, n: i32) -> Self {
        self.pow_rational(n, 1)
    }

    /// [`Interval::pow_rational`], decorated.
    pub fn pow_rational(self, p: i32, q: u32) -> Self {
        let x = self.interval;
        // The root is even if q keeps a factor 2 in lowest terms.
        let even_root = q != 0 && q.trailing_zeros() > p.trailing_zeros();
        let inside = (p >= 0 || !x.contains(0.0)) && (!even_root || x.lo() >= 0.0);
        let local = if x.is_empty() || q == 0 { Decoration::Trv } else { defined(inside) };
        self.then(x.pow_rational(p, q), local)
    }

    /// [`Interval::rootn`], decorated.
    pub fn rootn(self, n: i32) -> Self {
        self.pow_rational(n.signum(), n.unsigned_abs())
    }

    /// [`Interval::clamp`], decorated.
    pub fn clamp(self, low: Self, high: Self) -> Self {
        self.min(high).max(low)
    }

    /// [`Interval::mul_add`], decorated.
    pub fn mul_add(self, y: Self, z: Self) -> Self {
        let value = self.interval.mul_add(y.interval, z.interval);
        self.then(value, y.decoration.min(z.decoration))
    }
}

impl Neg for Decorated {
    type Output = Self;

    fn neg(self) -> Self {
        self.then(-self.interval, Decoration::Com)
    }
}

/// The operators: continuous everywhere but for the quotient, which is undefined where the divisor is 0.
macro_rules! operator {
    ($($trait:ident $name:ident($y:ident) $local:expr;)*) => {
        $(impl $trait for Decorated {
            type Output = Self;

            fn $name(self, other: Self) -> Self {
                let $y = other.interval;
                self.then($trait::$name(self.interval, $y), other.decoration.min($local))
            }
        })*
    };
}

operator! {
    Add add(_y) Decoration::Com;
    Sub sub(_y) Decoration::Com;
    Mul mul(_y) Decoration::Com;
    Div div(y) defined(!y.contains(0.0));
}
