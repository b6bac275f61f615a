//! Exponential, logarithmic, hyperbolic and inverse functions.
//!
//! CORE-MATH (Sibidanov, Zimmermann, Glondu, 2022) returns the `f64` nearest to the real value, so the value lies
//! between that number's two neighbours. Where a neighbour is known to be a value itself, the bound is exact.

use super::Interval;

impl Interval {
    /// The values of an increasing function on this part of its domain. `nearest` is correctly rounded, limits at
    /// infinite bounds included; `preimage` returns the `f64` whose value is exactly the given one, if there is one.
    fn increasing(self, nearest: impl Fn(f64) -> f64, preimage: impl Fn(f64) -> Option<f64>) -> Self {
        if self.is_empty() {
            return self;
        }
        // Where x lies beside the preimage of its rounded value, the real value lies on the same side of that.
        let (lo, hi) = (nearest(self.lo), nearest(self.hi));
        let lo = if preimage(lo).is_some_and(|e| e <= self.lo) { lo } else { lo.next_down() };
        let hi = if preimage(hi).is_some_and(|e| e >= self.hi) { hi } else { hi.next_up() };
        Self::raw(lo, hi)
    }

    /// e^x.
    pub fn exp(self) -> Self {
        self.increasing(core_math::exp, |y| (y == 1.0).then_some(0.0)).intersect(Self::NONNEGATIVE)
    }

    /// 2^x.
    pub fn exp2(self) -> Self {
        // 2^k is a f64 for all whole k from -1074 to 1023.
        let preimage = |y| is_power_of_two(y).then(|| core_math::log2(y));
        self.increasing(core_math::exp2, preimage).intersect(Self::NONNEGATIVE)
    }

    /// 10^x.
    pub fn exp10(self) -> Self {
        self.increasing(core_math::exp10, decimal_exponent).intersect(Self::NONNEGATIVE)
    }

    /// e^x - 1.
    pub fn expm1(self) -> Self {
        self.increasing(core_math::expm1, zero_at_zero).intersect(Self { lo: -1.0, hi: f64::INFINITY })
    }

    /// IEEE 1788 `exp2m1`: 2^x - 1.
    pub fn exp2m1(self) -> Self {
        // 2^k - 1 is a f64 for whole k from -53 to 53, and then adding 1 is exact too.
        let preimage = |y: f64| {
            let power = y + 1.0;
            (power <= 9007199254740992.0 && power - 1.0 == y && power > 0.0 && is_power_of_two(power))
                .then(|| core_math::log2(power))
        };
        self.increasing(core_math::exp2m1, preimage).intersect(Self { lo: -1.0, hi: f64::INFINITY })
    }

    /// IEEE 1788 `exp10m1`: 10^x - 1.
    pub fn exp10m1(self) -> Self {
        // 10^k - 1 is odd, and a f64 for 0 <= k <= 15: 10^15 < 2^53 < 10^16 - 1. Powers with k < 0 are not dyadic.
        let preimage = |y: f64| decimal_exponent(y + 1.0).filter(|k| *k <= 15.0 && core_math::exp10(*k) - 1.0 == y);
        self.increasing(core_math::exp10m1, preimage).intersect(Self { lo: -1.0, hi: f64::INFINITY })
    }

    /// IEEE 1788 `log`: the natural logarithm of the positive members.
    pub fn ln(self) -> Self {
        self.logarithm(0.0, core_math::log, |y| (y == 0.0).then_some(1.0))
    }

    /// The binary logarithm of the positive members.
    pub fn log2(self) -> Self {
        let whole = |y: f64| y.fract() == 0.0 && (-1074.0..=1023.0).contains(&y);
        self.logarithm(0.0, core_math::log2, |y| whole(y).then(|| core_math::exp2(y)))
    }

    /// The decimal logarithm of the positive members.
    pub fn log10(self) -> Self {
        let preimage = |y| Some(core_math::exp10(y)).filter(|x| decimal_exponent(*x) == Some(y));
        self.logarithm(0.0, core_math::log10, preimage)
    }

    /// IEEE 1788 `logp1`: ln(1 + x) of the members greater than -1.
    pub fn log1p(self) -> Self {
        self.logarithm(-1.0, core_math::log1p, zero_at_zero)
    }

    /// IEEE 1788 `log2p1`: the binary logarithm of 1 + x of the members greater than -1.
    pub fn log2p1(self) -> Self {
        // 2^k - 1 as in `exp2m1`.
        let preimage = |y: f64| (y.fract() == 0.0 && y.abs() <= 53.0).then(|| core_math::exp2(y) - 1.0);
        self.logarithm(-1.0, core_math::log2p1, preimage)
    }

    /// IEEE 1788 `log10p1`: the decimal logarithm of 1 + x of the members greater than -1.
    pub fn log10p1(self) -> Self {
        // 10^k - 1 as in `exp10m1`.
        let preimage = |y: f64| (y.fract() == 0.0 && (0.0..=15.0).contains(&y)).then(|| core_math::exp10(y) - 1.0);
        self.logarithm(-1.0, core_math::log10p1, preimage)
    }

    /// An increasing function whose domain is the reals above `pole`, where it goes to -inf.
    fn logarithm(self, pole: f64, nearest: impl Fn(f64) -> f64, preimage: impl Fn(f64) -> Option<f64>) -> Self {
        if self.is_empty() || self.hi <= pole {
            return Self::EMPTY;
        }
        let at = |x: f64| if x == pole { f64::NEG_INFINITY } else { nearest(x) };
        self.intersect(Self { lo: pole, hi: f64::INFINITY }).increasing(at, preimage)
    }

    /// arcsin x, of the members in [-1, 1].
    pub fn asin(self) -> Self {
        self.intersect(Self { lo: -1.0, hi: 1.0 }).increasing(core_math::asin, zero_at_zero)
    }

    /// arccos x, of the members in [-1, 1].
    pub fn acos(self) -> Self {
        // Decreasing: -acos increases.
        let x = self.intersect(Self { lo: -1.0, hi: 1.0 });
        -x.increasing(|x| -core_math::acos(x), |y| (y == 0.0).then_some(1.0))
    }

    /// arctan x.
    pub fn atan(self) -> Self {
        self.increasing(core_math::atan, zero_at_zero).intersect(Self { lo: -Self::HALF_PI.hi, hi: Self::HALF_PI.hi })
    }

    /// The angle of the point (x, y) = (`x`, `self`) in (-pi, pi], as IEEE 1788 has it: the origin is outside the
    /// domain, and the negative x axis has the angle pi.
    pub fn atan2(self, x: Self) -> Self {
        let y = self;
        if x.is_empty() || y.is_empty() || x == Self::ZERO && y == Self::ZERO {
            return Self::EMPTY;
        }
        if y.lo < 0.0 {
            return if y.hi < 0.0 || y.hi == 0.0 && x.lo >= 0.0 {
                // The lower half plane mirrors the upper one away from the branch cut.
                -(-y).atan2(x)
            } else if x.lo < 0.0 {
                // Both sides of the branch cut.
                Self { lo: -Self::PI.hi, hi: Self::PI.hi }
            } else {
                // The right half plane: the angle increases with y; at a negative y it increases with x, at a positive
                // one it decreases.
                Self::raw(angle(y.lo, x.lo).0, angle(y.hi, x.lo).1)
            };
        }
        if y == Self::ZERO {
            // On the axis, where the origin cannot stand for a limit.
            let least = if x.hi > 0.0 { 0.0 } else { Self::PI.lo };
            return Self { lo: least, hi: if x.lo < 0.0 { Self::PI.hi } else { 0.0 } };
        }
        // The upper half plane: the angle decreases with x; it increases with y for x > 0, and decreases for x < 0.
        let (first, last) = (if x.hi > 0.0 { y.lo } else { y.hi }, if x.lo < 0.0 { y.lo } else { y.hi });
        Self::raw(angle(first, x.hi).0, angle(last, x.lo).1)
    }

    /// The hyperbolic sine.
    pub fn sinh(self) -> Self {
        self.increasing(core_math::sinh, zero_at_zero)
    }

    /// The hyperbolic cosine.
    pub fn cosh(self) -> Self {
        self.abs()
            .increasing(core_math::cosh, |y| (y == 1.0).then_some(0.0))
            .intersect(Self { lo: 1.0, hi: f64::INFINITY })
    }

    /// The hyperbolic tangent.
    pub fn tanh(self) -> Self {
        self.increasing(core_math::tanh, zero_at_zero).intersect(Self { lo: -1.0, hi: 1.0 })
    }

    /// The inverse hyperbolic sine.
    pub fn asinh(self) -> Self {
        self.increasing(core_math::asinh, zero_at_zero)
    }

    /// The inverse hyperbolic cosine of the members in [1, inf].
    pub fn acosh(self) -> Self {
        self.intersect(Self { lo: 1.0, hi: f64::INFINITY }).increasing(core_math::acosh, |y| (y == 0.0).then_some(1.0))
    }

    /// The inverse hyperbolic tangent of the members in (-1, 1).
    pub fn atanh(self) -> Self {
        if self.is_empty() || self.hi <= -1.0 || self.lo >= 1.0 {
            return Self::EMPTY;
        }
        let at = |x: f64| if x.abs() == 1.0 { x * f64::INFINITY } else { core_math::atanh(x) };
        self.intersect(Self { lo: -1.0, hi: 1.0 }).increasing(at, zero_at_zero)
    }
}

/// The preimages of functions that are 0 at 0 and take no other `f64` at a `f64` (Lindemann and Weierstrass).
fn zero_at_zero(y: f64) -> Option<f64> {
    (y == 0.0).then_some(0.0)
}

/// The k with `y` = 10^k, for 0 <= k <= 22: 10^22 = 2^22 5^22 and 5^22 < 2^53 < 5^23, so that no other power is a
/// `f64`.
fn decimal_exponent(y: f64) -> Option<f64> {
    let k = core_math::log10(y);
    (k.fract() == 0.0 && (0.0..=22.0).contains(&k) && core_math::exp10(k) == y).then_some(k)
}

/// Whether `x` > 0 is a power of two: one bit in the fraction of a subnormal, none in that of a normal number.
fn is_power_of_two(x: f64) -> bool {
    let fraction = x.to_bits() & ((1 << 52) - 1);
    if x.is_subnormal() { fraction.is_power_of_two() } else { x.is_finite() && fraction == 0 }
}

/// Bounds of the angle of (x, y), not the origin; at most one of the two is infinite. A zero y on the negative axis
/// means pi.
fn angle(y: f64, x: f64) -> (f64, f64) {
    if y == 0.0 {
        return if x > 0.0 { (0.0, 0.0) } else { (Interval::PI.lo, Interval::PI.hi) };
    }
    let nearest = core_math::atan2(y, x);
    // The value has the sign of y and is below pi in size.
    let sign =
        if y > 0.0 { Interval { lo: 0.0, hi: Interval::PI.hi } } else { Interval { lo: -Interval::PI.hi, hi: 0.0 } };
    (nearest.next_down().max(sign.lo), nearest.next_up().min(sign.hi))
}
