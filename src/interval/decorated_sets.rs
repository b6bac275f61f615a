//! Decorated intervals as sets: their numbers and relations, and operations on sets and reverse operations.
//!
//! None of those evaluates a point function, so that nothing is known about one: their decoration is `trv` (IEEE 1788,
//! 11.7). What has to be `ill` is: every operation with an operand that is no interval.

use super::{Decorated, Decoration, Overlap};

/// Numbers of the interval; NaN if there is none.
macro_rules! numbers {
    ($($name:ident)*) => {
        impl Decorated {
            $(#[doc = concat!("[`Interval::", stringify!($name), "`]; NaN for [`Decorated::ILL`].")]
            #[doc = concat!("\n\n[`Interval::", stringify!($name), "`]: crate::interval::Interval::", stringify!($name))]
            pub fn $name(self) -> f64 {
                if self.is_nai() { f64::NAN } else { self.interval().$name() }
            })*
        }
    };
}

/// Properties of one set, and relations of two; false for what is no interval.
macro_rules! relations {
    ($($name:ident($($other:ident)?);)*) => {
        impl Decorated {
            $(#[doc = concat!("[`Interval::", stringify!($name), "`]; false for [`Decorated::ILL`].")]
            #[doc = concat!("\n\n[`Interval::", stringify!($name), "`]: crate::interval::Interval::", stringify!($name))]
            pub fn $name(self $(, $other: Self)?) -> bool {
                !self.is_nai() $(&& !$other.is_nai())? && self.interval().$name($($other.interval())?)
            })*
        }
    };
}

/// Operations whose results are `trv`, or `ill` as soon as an operand is.
macro_rules! untracked {
    ($($name:ident($($other:ident)* $(; $($number:ident: $kind:ty),*)?);)*) => {
        impl Decorated {
            $(#[doc = concat!("[`Interval::", stringify!($name), "`], decorated `trv`.")]
            #[doc = concat!("\n\n[`Interval::", stringify!($name), "`]: crate::interval::Interval::", stringify!($name))]
            pub fn $name(self $(, $other: Self)* $($(, $number: $kind)*)?) -> Self {
                if self.is_nai() $(|| $other.is_nai())* {
                    return Self::ILL;
                }
                let value = self.interval().$name($($other.interval(),)* $($($number),*)?);
                Self::with(value, Decoration::Trv)
            })*
        }
    };
}

numbers! { inf sup mid rad width mag mig }

relations! {
    is_empty();
    is_entire();
    is_bounded();
    is_singleton();
    subset(other);
    interior(other);
    weakly_less(other);
    strict_less(other);
    precedes(other);
    strict_precedes(other);
    disjoint(other);
}

untracked! {
    intersect(other);
    hull(other);
    cancel_minus(other);
    cancel_plus(other);
    sqr_rev(x);
    abs_rev(x);
    powi_rev(x; n: i32);
    pow_rational_rev(x; p: i32, q: u32);
    sin_rev(x);
    cos_rev(x);
    tan_rev(x);
    cosh_rev(x);
    mul_rev(c x);
    pow_rev1(c x);
    pow_rev2(c x);
    atan2_rev1(c y);
    atan2_rev2(c x);
}

impl Decorated {
    /// IEEE 1788 `isNaI`: whether this is no interval.
    pub fn is_nai(self) -> bool {
        self.decoration() == Decoration::Ill
    }

    /// IEEE 1788 `equal`: whether both are intervals with the same members, whatever their decorations.
    #[doc(alias = "equal")]
    pub fn same_set(self, other: Self) -> bool {
        !self.is_nai() && !other.is_nai() && self.interval() == other.interval()
    }

    /// IEEE 1788 `isMember`: [`Interval::contains`](crate::interval::Interval::contains).
    pub fn contains(self, x: f64) -> bool {
        self.interval().contains(x)
    }

    /// [`Interval::mid_rad`](crate::interval::Interval::mid_rad); two NaN for [`Decorated::ILL`].
    pub fn mid_rad(self) -> (f64, f64) {
        (self.mid(), self.rad())
    }

    /// [`Interval::overlap`](crate::interval::Interval::overlap); `None` if one is no interval.
    pub fn overlap(self, other: Self) -> Option<Overlap> {
        (!self.is_nai() && !other.is_nai()).then(|| self.interval().overlap(other.interval()))
    }

    /// [`Interval::mul_rev_to_pair`](crate::interval::Interval::mul_rev_to_pair). Where 0 is not in this set, the first
    /// result is the quotient `c / self` and is decorated as one; all else is `trv`.
    pub fn mul_rev_to_pair(self, c: Self) -> [Self; 2] {
        if self.is_nai() || c.is_nai() {
            return [Self::ILL; 2];
        }
        let [low, high] = self.interval().mul_rev_to_pair(c.interval());
        let first = if self.contains(0.0) { Self::with(low, Decoration::Trv) } else { c / self };
        [first, Self::with(high, Decoration::Trv)]
    }
}
