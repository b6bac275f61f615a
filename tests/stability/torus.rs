//! The torus of radii 0.7 and 0.3, and the plain methods for its first root that R. Toledo's thesis describes (Nancy
//! 2007, section 10.7).

use imp::render::Ray;

use crate::plain::Plain;
use crate::plain::bisect;
use crate::plain::march;
use crate::plain::surface;

surface!(Torus, "(x^2 + y^2 + z^2 - 0.58)^2 = 1.96 (0.09 - z^2)", |x, y, z| {
    let square = x.power(2) + y.power(2) + z.power(2) - N::ratio(29, 50);
    square.power(2) - N::ratio(49, 25) * (N::ratio(9, 100) - z.power(2))
});

/// The torus along a ray of unit speed: T(t) = t^4 + b t^3 + c t^2 + d t + e (eq. 10.11).
#[derive(Debug, Clone, Copy)]
pub struct Quartic<T> {
    b: T,
    c: T,
    d: T,
    e: T,
    /// The length of the ray's own direction.
    speed: T,
}

impl<T: Plain> Quartic<T> {
    /// Coefficients from the ray's origin, wherever that is.
    pub fn new(ray: &Ray) -> Self {
        Self::of(ray.origin.map(T::of), ray.direction.map(T::of))
    }

    /// Coefficients from the point t of the ray.
    pub fn from(ray: &Ray, t: f64) -> Self {
        Self::of(ray.at(t).map(T::of), ray.direction.map(T::of))
    }

    fn of(o: [T; 3], direction: [T; 3]) -> Self {
        let dot = |a: [T; 3], b: [T; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let speed = dot(direction, direction).sqrt();
        let v = direction.map(|component| component / speed);
        let (two, four) = (T::int(2), T::int(4));
        let (outer, inner) = (T::ratio(49, 100), T::ratio(9, 100));
        let (ov, less) = (dot(o, v), dot(o, o) - (outer + inner));
        Self {
            b: four * ov,
            c: two * (less + two * ov * ov + two * outer * v[2] * v[2]),
            d: four * (ov * less + two * outer * v[2] * o[2]),
            e: less * less - four * outer * (inner - o[2] * o[2]),
            speed,
        }
    }

    fn value(&self, t: T) -> T {
        (((t + self.b) * t + self.c) * t + self.d) * t + self.e
    }

    fn slope(&self, t: T) -> T {
        ((T::int(4) * t + T::int(3) * self.b) * t + T::int(2) * self.c) * t + self.d
    }

    /// Equal steps over the polynomial, in and out in the ray's own parameter.
    pub fn march(&self, stretch: [f64; 2], steps: u32) -> Option<f64> {
        march(|t| self.value(t * self.speed), stretch, steps)
    }

    /// Double derivative bisection as printed: derivative bisection up to the root of the third derivative, t = -b/4, and
    /// behind it only if that finds nothing.
    pub fn double_derivative_bisection(&self, way: T) -> Option<T> {
        let middle = -self.b / T::int(4);
        if middle <= T::int(0) || middle >= way {
            return self.derivative_bisection(T::int(0), way);
        }
        self.derivative_bisection(T::int(0), middle).or_else(|| self.derivative_bisection(middle, way))
    }

    /// The first root between ends with at most one extremum between them, as printed: towards the minimum by the sign of
    /// the slope until the sign of T changes.
    fn derivative_bisection(&self, mut lo: T, mut hi: T) -> Option<T> {
        let zero = T::int(0);
        if (self.value(lo) < zero) != (self.value(hi) < zero) {
            return Some(bisect(|t| self.value(t), lo, hi));
        }
        if self.slope(lo) >= zero || self.slope(hi) <= zero {
            return None;
        }
        let start = lo;
        loop {
            let middle = (lo + hi) / T::int(2);
            if middle <= lo || middle >= hi {
                return None;
            }
            if self.value(middle) < zero {
                return Some(bisect(|t| self.value(t), start, middle));
            }
            if self.slope(middle) < zero {
                lo = middle;
            } else {
                hi = middle;
            }
        }
    }

    /// Newton's method from the enclosing sphere with steps of at most 0.15, 60 of them; the caller accepts or discards. If
    /// wanted, every step outside the torus goes forward.
    pub fn clamped_newton(&self, forward: bool) -> T {
        let most = T::ratio(15, 100);
        let mut t = T::int(0);
        for _ in 0..60 {
            let value = self.value(t);
            let step = value / self.slope(t);
            let step = if forward && value > T::int(0) && step > T::int(0) { -step } else { step };
            t = t - if step > most {
                most
            } else if step < -most {
                -most
            } else {
                step
            };
        }
        t
    }

    pub fn speed(&self) -> T {
        self.speed
    }
}
