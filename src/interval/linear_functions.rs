//! The linear enclosures of the elementary functions: where each is convex and where concave, its derivative, and where
//! that takes a given value.

use super::linear::{Bend, Curve, Linear, Piece};
use super::{Interval, round};

const ONE: Interval = Interval::ONE;

/// Inflections beyond this many half turns are given up: up to here they are known to within a thousandth.
const HALF_TURNS: f64 = round::pow2(40);

/// ln(base).
fn ln_of(base: f64) -> Interval {
    Interval::point(base).ln()
}

impl Linear {
    /// [`Interval::sqrt`] between lines.
    pub fn sqrt(x: Interval) -> Self {
        let slope = |x: Interval| Interval::point(0.5) / x.sqrt();
        let curve = Curve { value: Interval::sqrt, slope, distance: |s: f64| 0.25 / (s * s) };
        curve.bent(x.intersect(Interval::NONNEGATIVE), Bend::Concave, 1.0)
    }

    /// [`Interval::abs`] between lines: |x| - s x >= 0 for |s| <= 1, and at most its value at one of the ends.
    pub fn abs(x: Interval) -> Self {
        if x.lo() >= 0.0 {
            return Self::line(1.0);
        }
        if x.hi() <= 0.0 {
            return Self::line(-1.0);
        }
        let (lo, hi) = (0.5 * x.lo(), 0.5 * x.hi());
        let slope = ((hi + lo) / (hi - lo)).clamp(-1.0, 1.0);
        // NaN where the halves are 0 or infinite.
        if slope.is_nan() || !x.is_bounded() {
            return Self::flat(x.abs());
        }
        let at = |x: f64| Interval::point(x).abs() - Interval::point(slope) * Interval::point(x);
        let offset = Interval::ZERO.hull(at(x.lo())).hull(at(x.hi())).intersect(Interval::NONNEGATIVE);
        Self::new(slope, offset)
    }

    /// [`Interval::recip`] between lines.
    pub fn recip(x: Interval) -> Self {
        Self::powi(x, -1)
    }

    /// [`Interval::sqr`] between lines.
    pub fn sqr(x: Interval) -> Self {
        Self::powi(x, 2)
    }

    /// [`Interval::cbrt`] between lines.
    pub fn cbrt(x: Interval) -> Self {
        Self::pow_rational(x, 1, 3)
    }

    /// [`Interval::powi`] between lines.
    pub fn powi(x: Interval, n: i32) -> Self {
        Self::pow_rational(x, n, 1)
    }

    /// [`Interval::pow_rational`] between lines, for p/q in lowest terms.
    pub fn pow_rational(x: Interval, p: i32, q: u32) -> Self {
        let value = |x: Interval| x.pow_rational(p, q);
        let x = if q.is_multiple_of(2) { x.intersect(Interval::NONNEGATIVE) } else { x };
        if p == 0 || x.is_empty() || p < 0 && x.contains(0.0) {
            return Self::flat(value(x));
        }
        if (p, q) == (1, 1) {
            return Self::line(1.0);
        }
        let (Ok(lower), Ok(denominator)) = (i32::try_from(i64::from(p) - i64::from(q)), i32::try_from(q)) else {
            return Self::flat(value(x));
        };
        let factor = Interval::point(f64::from(p)) / Interval::point(f64::from(denominator));
        let slope = |x: Interval| factor * x.pow_rational(lower, q);
        let r = f64::from(p) / f64::from(denominator);
        // |f'| is |r| |x|^(r - 1).
        let distance = |s: f64| (s / r).abs().powf(1.0 / (r - 1.0));
        // f'' is r (r - 1) x^(r - 2) to the right of 0; to the left f is the mirror image of that, or its negative.
        let right = Bend::convex_if(!(0.0..=1.0).contains(&r));
        let even = p % 2 == 0;
        let left = if even { right } else { right.reverse() };
        match () {
            _ if x.lo() >= 0.0 => Curve { value, slope, distance }.bent(x, right, 1.0),
            _ if x.hi() <= 0.0 => Curve { value, slope, distance }.bent(x, left, -1.0),
            _ if even && r > 1.0 => {
                let signed = |s: f64| distance(s).copysign(s);
                Curve { value, slope, distance: signed }.bent(x, right, 1.0)
            }
            _ if even => {
                // A cusp: concave on both sides, and not across.
                let halves = [(Interval { lo: x.lo(), hi: 0.0 }, -1.0), (Interval { lo: 0.0, hi: x.hi() }, 1.0)];
                let pieces = halves.map(|(range, side)| Piece { range, bend: right, centre: 0.0, side });
                Curve { value, slope, distance }.between_lines(x, &pieces, &[])
            }
            _ => Curve { value, slope, distance }.symmetric(x, right),
        }
    }

    /// [`Interval::pow`] with a number as the exponent, between lines.
    pub fn pow(x: Interval, exponent: f64) -> Self {
        let c = Interval::point(exponent);
        let value = |x: Interval| x.pow(c);
        let x = x.intersect(Interval::NONNEGATIVE);
        if exponent == 0.0 || x.is_empty() || exponent < 0.0 && x.contains(0.0) {
            return Self::flat(value(x));
        }
        if exponent == 1.0 {
            return Self::line(1.0);
        }
        let slope = |x: Interval| c * x.pow(c - ONE);
        let distance = |s: f64| (s / exponent).abs().powf(1.0 / (exponent - 1.0));
        Curve { value, slope, distance }.bent(x, Bend::convex_if(!(0.0..=1.0).contains(&exponent)), 1.0)
    }

    /// [`Interval::exp`] between lines.
    pub fn exp(x: Interval) -> Self {
        Curve { value: Interval::exp, slope: Interval::exp, distance: f64::ln }.bent(x, Bend::Convex, 1.0)
    }

    /// [`Interval::expm1`] between lines.
    pub fn expm1(x: Interval) -> Self {
        Curve { value: Interval::expm1, slope: Interval::exp, distance: f64::ln }.bent(x, Bend::Convex, 1.0)
    }

    /// [`Interval::exp2`] between lines.
    pub fn exp2(x: Interval) -> Self {
        Self::exponential(x, 2.0, Interval::exp2)
    }

    /// [`Interval::exp10`] between lines.
    pub fn exp10(x: Interval) -> Self {
        Self::exponential(x, 10.0, Interval::exp10)
    }

    fn exponential(x: Interval, base: f64, value: fn(Interval) -> Interval) -> Self {
        let log = ln_of(base);
        let distance = |s: f64| (s / log.mid()).ln() / log.mid();
        Curve { value, slope: |x| log * value(x), distance }.bent(x, Bend::Convex, 1.0)
    }

    /// [`Interval::ln`] between lines.
    pub fn ln(x: Interval) -> Self {
        Self::logarithm(x, ONE, Interval::ln)
    }

    /// [`Interval::log2`] between lines.
    pub fn log2(x: Interval) -> Self {
        Self::logarithm(x, ln_of(2.0), Interval::log2)
    }

    /// [`Interval::log10`] between lines.
    pub fn log10(x: Interval) -> Self {
        Self::logarithm(x, ln_of(10.0), Interval::log10)
    }

    /// ln x / log; without bounds where `x` reaches 0.
    fn logarithm(x: Interval, log: Interval, value: fn(Interval) -> Interval) -> Self {
        let distance = |s: f64| 1.0 / (s * log.mid());
        let x = x.intersect(Interval::NONNEGATIVE);
        Curve { value, slope: |x| ONE / (log * x), distance }.bent(x, Bend::Concave, 1.0)
    }

    /// [`Interval::log1p`] between lines.
    pub fn log1p(x: Interval) -> Self {
        let x = x.intersect(Interval { lo: -1.0, hi: f64::INFINITY });
        let curve = Curve { value: Interval::log1p, slope: |x| ONE / (ONE + x), distance: |s: f64| 1.0 / s - 1.0 };
        curve.bent(x, Bend::Concave, 1.0)
    }

    /// [`Interval::cosh`] between lines.
    pub fn cosh(x: Interval) -> Self {
        Curve { value: Interval::cosh, slope: Interval::sinh, distance: f64::asinh }.bent(x, Bend::Convex, 1.0)
    }

    /// [`Interval::sinh`] between lines.
    pub fn sinh(x: Interval) -> Self {
        Curve { value: Interval::sinh, slope: Interval::cosh, distance: f64::acosh }.symmetric(x, Bend::Convex)
    }

    /// [`Interval::tanh`] between lines.
    pub fn tanh(x: Interval) -> Self {
        let slope = |x: Interval| ONE / x.cosh().sqr();
        let distance = |s: f64| (1.0 / s.sqrt()).acosh();
        Curve { value: Interval::tanh, slope, distance }.symmetric(x, Bend::Concave)
    }

    /// [`Interval::asinh`] between lines.
    pub fn asinh(x: Interval) -> Self {
        let slope = |x: Interval| ONE / (ONE + x.sqr()).sqrt();
        let distance = |s: f64| (1.0 / (s * s) - 1.0).sqrt();
        Curve { value: Interval::asinh, slope, distance }.symmetric(x, Bend::Concave)
    }

    /// [`Interval::acosh`] between lines.
    pub fn acosh(x: Interval) -> Self {
        let slope = |x: Interval| ONE / ((x - ONE) * (x + ONE)).sqrt();
        let distance = |s: f64| (1.0 / (s * s) + 1.0).sqrt();
        let x = x.intersect(Interval { lo: 1.0, hi: f64::INFINITY });
        Curve { value: Interval::acosh, slope, distance }.bent(x, Bend::Concave, 1.0)
    }

    /// [`Interval::atanh`] between lines; without bounds where `x` reaches -1 or 1.
    pub fn atanh(x: Interval) -> Self {
        let slope = |x: Interval| ONE / ((ONE - x) * (ONE + x));
        let distance = |s: f64| (1.0 - 1.0 / s).sqrt();
        let x = x.intersect(Interval { lo: -1.0, hi: 1.0 });
        Curve { value: Interval::atanh, slope, distance }.symmetric(x, Bend::Convex)
    }

    /// [`Interval::asin`] between lines.
    pub fn asin(x: Interval) -> Self {
        let slope = |x: Interval| ONE / ((ONE - x) * (ONE + x)).sqrt();
        let distance = |s: f64| (1.0 - 1.0 / (s * s)).sqrt();
        let x = x.intersect(Interval { lo: -1.0, hi: 1.0 });
        Curve { value: Interval::asin, slope, distance }.symmetric(x, Bend::Convex)
    }

    /// [`Interval::acos`] between lines.
    pub fn acos(x: Interval) -> Self {
        let slope = |x: Interval| -(ONE / ((ONE - x) * (ONE + x)).sqrt());
        let distance = |s: f64| (1.0 - 1.0 / (s * s)).sqrt();
        let x = x.intersect(Interval { lo: -1.0, hi: 1.0 });
        Curve { value: Interval::acos, slope, distance }.symmetric(x, Bend::Concave)
    }

    /// [`Interval::atan`] between lines.
    pub fn atan(x: Interval) -> Self {
        let slope = |x: Interval| ONE / (ONE + x.sqr());
        let distance = |s: f64| (1.0 / s - 1.0).sqrt();
        Curve { value: Interval::atan, slope, distance }.symmetric(x, Bend::Concave)
    }

    /// [`Interval::tan`] between lines; without bounds across a pole.
    pub fn tan(x: Interval) -> Self {
        let range = x.tan();
        let k = (x.mid() / std::f64::consts::PI).round();
        if !range.is_bounded() || k.abs() > HALF_TURNS {
            return Self::flat(range);
        }
        let slope = |x: Interval| ONE + x.tan().sqr();
        let curve = Curve { value: Interval::tan, slope, distance: |s: f64| (s - 1.0).sqrt().atan() };
        // Between two poles the tangent is concave where it is negative, convex where it is positive.
        let inflection = Interval::point(k) * Interval::PI;
        let piece = |range: Interval, bend, side| Piece { range, bend, centre: inflection.mid(), side };
        if range.lo() >= 0.0 {
            return curve.between_lines(x, &[piece(x, Bend::Convex, 1.0)], &[]);
        }
        if range.hi() <= 0.0 {
            return curve.between_lines(x, &[piece(x, Bend::Concave, -1.0)], &[]);
        }
        // One inflection is inside, and the others are more than a radian outside: this is it, or none is found.
        let (Some(left), Some(right)) =
            (Interval::new(x.lo(), inflection.lo()), Interval::new(inflection.hi(), x.hi()))
        else {
            return Self::flat(range);
        };
        let pieces = [piece(left, Bend::Concave, -1.0), piece(right, Bend::Convex, 1.0)];
        curve.between_lines(x, &pieces, &[inflection])
    }

    /// [`Interval::sin`] between lines.
    pub fn sin(x: Interval) -> Self {
        Self::wave(x, 0.0, Interval::sin, Interval::cos)
    }

    /// [`Interval::cos`] between lines.
    pub fn cos(x: Interval) -> Self {
        Self::wave(x, -0.5, Interval::cos, |x| -x.sin())
    }

    /// A sine that is 0 and rising `shift` half turns from 0.
    fn wave(x: Interval, shift: f64, value: fn(Interval) -> Interval, slope: fn(Interval) -> Interval) -> Self {
        let flat = Self::flat(value(x));
        let largest = HALF_TURNS * std::f64::consts::PI;
        if x.is_empty() || x.mag() > largest || x.width() >= std::f64::consts::TAU {
            return flat;
        }
        let inflection = |k: f64| Interval::point(k + shift) * Interval::PI;
        // Inflections are known to within a thousandth: two half turns before the end is well outside.
        let mut k = (x.lo() / std::f64::consts::PI - shift).floor() - 1.0;
        let (mut pieces, mut gaps) = (Vec::new(), Vec::new());
        while inflection(k).lo() <= x.hi() {
            let gap = inflection(k).intersect(x);
            if !gap.is_empty() {
                gaps.push(gap);
            }
            // From here to the next inflection the function is the cosine of the distance from the middle, concave, if
            // k is even, and else its negative. The derivative is the negative sine of that distance, or the sine.
            let (lo, hi) = (inflection(k).hi().max(x.lo()), inflection(k + 1.0).lo().min(x.hi()));
            if let Some(range) = Interval::new(lo, hi) {
                let even = k % 2.0 == 0.0;
                let centre = inflection(k + 0.5).mid();
                let side = if even { -1.0 } else { 1.0 };
                pieces.push(Piece { range, bend: Bend::convex_if(!even), centre, side });
            }
            k += 1.0;
        }
        Curve { value, slope, distance: f64::asin }.between_lines(x, &pieces, &gaps)
    }
}
