//! Formulas in plain floating point, and the usual ways to look for roots with it.

use std::ops::Add;
use std::ops::Div;
use std::ops::Mul;
use std::ops::Neg;
use std::ops::Sub;

use imp::render::Ray;

/// What the formula of a surface is computed in: `f32`, `f64`, or exact polynomials along a ray.
pub trait Number:
    Clone + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self> + Sized
{
    fn ratio(numerator: i64, denominator: i64) -> Self;

    /// The golden ratio.
    fn phi() -> Self;

    fn int(n: i64) -> Self {
        Self::ratio(n, 1)
    }

    /// x^n by squaring, n > 0: the same operations on every machine.
    fn power(&self, n: u32) -> Self {
        match n {
            1 => self.clone(),
            _ if n.is_multiple_of(2) => {
                let half = self.power(n / 2);
                half.clone() * half
            }
            _ => self.power(n - 1) * self.clone(),
        }
    }
}

/// A floating-point format, rounded to nearest.
pub trait Plain: Number + Copy + PartialOrd + Div<Output = Self> {
    fn of(x: f64) -> Self;
    fn to_f64(self) -> f64;
    fn tan(self) -> Self;
    fn sqrt(self) -> Self;
}

macro_rules! plain {
    ($($type:ident)*) => {
        $(impl Number for $type {
            fn ratio(numerator: i64, denominator: i64) -> Self {
                numerator as $type / denominator as $type
            }

            fn phi() -> Self {
                let five: $type = 5.0;
                (1.0 + five.sqrt()) / 2.0
            }
        }

        impl Plain for $type {
            fn of(x: f64) -> Self {
                x as $type
            }

            fn to_f64(self) -> f64 {
                self.into()
            }

            fn tan(self) -> Self {
                <$type>::tan(self)
            }

            fn sqrt(self) -> Self {
                <$type>::sqrt(self)
            }
        })*
    };
}

plain! { f32 f64 }

/// A surface as an equation: its text for Imp and the same formula for everything else.
pub trait Surface {
    /// The equation in Imp's language.
    const TEXT: &'static str;

    /// A polynomial with the same zeros.
    fn value<N: Number>(point: [N; 3]) -> N;

    /// A polynomial whose zeros are the poles.
    fn pole<N: Number>(_point: [N; 3]) -> Option<N> {
        None
    }

    /// What a program without Imp computes.
    fn plain<T: Plain>(point: [T; 3]) -> T {
        Self::value(point)
    }
}

/// Declares a surface of a polynomial.
macro_rules! surface {
    ($name:ident, $text:literal, |$x:ident, $y:ident, $z:ident| $value:expr) => {
        pub struct $name;

        impl crate::plain::Surface for $name {
            const TEXT: &'static str = $text;

            fn value<N: crate::plain::Number>([$x, $y, $z]: [N; 3]) -> N {
                $value
            }
        }
    };
}
pub(crate) use surface;

/// A number with its derivative along the ray.
#[derive(Clone, Copy)]
struct Dual<T> {
    value: T,
    slope: T,
}

impl<T: Plain> Number for Dual<T> {
    fn ratio(numerator: i64, denominator: i64) -> Self {
        Self { value: T::ratio(numerator, denominator), slope: T::int(0) }
    }

    fn phi() -> Self {
        Self { value: T::phi(), slope: T::int(0) }
    }
}

impl<T: Plain> Add for Dual<T> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, slope: self.slope + other.slope }
    }
}

impl<T: Plain> Sub for Dual<T> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, slope: self.slope - other.slope }
    }
}

impl<T: Plain> Mul for Dual<T> {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self { value: self.value * other.value, slope: self.slope * other.value + self.value * other.slope }
    }
}

impl<T: Plain> Neg for Dual<T> {
    type Output = Self;

    fn neg(self) -> Self {
        Self { value: -self.value, slope: -self.slope }
    }
}

/// Newton's method from where the ray enters the domain; `None` unless it settles inside.
pub fn newton<T: Plain, S: Surface>(ray: &Ray, [start, end]: [f64; 2]) -> Option<f64> {
    let mut t = start;
    for _ in 0..200 {
        let at = |c: usize| Dual {
            value: T::of(ray.origin[c]) + T::of(ray.direction[c]) * T::of(t),
            slope: T::of(ray.direction[c]),
        };
        let Dual { value, slope } = S::value([at(0), at(1), at(2)]);
        let step = (value / slope).to_f64();
        t -= step;
        if step.abs() < 1e-5 * (end - start) {
            return (start <= t && t <= end).then_some(t);
        }
    }
    None
}

/// The first of equal steps at which the value is at most `epsilon`: a root, as programs with one tolerance for all have it.
pub fn close<T: Plain, S: Surface>(ray: &Ray, [start, end]: [f64; 2], epsilon: f64) -> Option<f64> {
    let at = |i: u32| start + (end - start) * f64::from(i) / 1000.0;
    (0..=1000).map(at).find(|&t| value::<T, S>(ray, T::of(t)).to_f64().abs() <= epsilon)
}

/// The value at one point of a ray, all of it in the format.
pub fn value<T: Plain, S: Surface>(ray: &Ray, t: T) -> T {
    S::plain([0, 1, 2].map(|c| T::of(ray.origin[c]) + T::of(ray.direction[c]) * t))
}

/// The usual root finder without intervals: equal steps until the sign changes, then bisection.
pub fn march<T: Plain>(f: impl Fn(T) -> T, [start, end]: [f64; 2], steps: u32) -> Option<f64> {
    let at = |i: u32| T::of(start + (end - start) * f64::from(i) / f64::from(steps));
    let zero = T::of(0.0);
    let mut before = f(at(0));
    for i in 1..=steps {
        let after = f(at(i));
        if (before < zero && after >= zero) || (before > zero && after <= zero) {
            return Some(bisect(&f, at(i - 1), at(i)).to_f64());
        }
        before = after;
    }
    None
}

/// Halves a stretch whose ends have opposite signs until they are neighbours in the format.
pub fn bisect<T: Plain>(f: impl Fn(T) -> T, mut lo: T, mut hi: T) -> T {
    let rising = f(lo) < T::of(0.0);
    loop {
        let middle = lo + (hi - lo) / T::of(2.0);
        if middle <= lo || middle >= hi {
            return middle;
        }
        if (f(middle) < T::of(0.0)) == rising {
            lo = middle;
        } else {
            hi = middle;
        }
    }
}
