//! Slopes of elementary functions, as lower bounds of |f'| over x: with them f(x) - s x is monotone, and its ends are
//! those of f that the natural extension has computed already. Bounds come out of the values of f wherever the
//! derivative is a function of those (e^x, tan' = 1 + tan^2, cosh^2 = 1 + sinh^2, (x^r)' = r x^r / x), so that a form
//! costs little beside its enclosure. Near a point where f' = 0 the slope is 0 and f itself varies little.

use crate::derive::affine::algebraic;
use crate::derive::affine::linear::Linear;
use crate::derive::elementary;
use crate::derive::ends::Ends;
use crate::derive::lanes::Builder;
use crate::derive::lanes::Lane;
use crate::graph::Op;

/// A linear approximation of a function of one variable over x, where it lies in y; `None` for those without one.
pub fn approximation(b: &mut Builder, op: Op, x: Ends, y: Ends) -> Option<Linear> {
    let (one, minus_one) = (b.number(1.0), b.number(-1.0));
    let y_low = b.low(y);
    Some(match op {
        Op::Sqrt => algebraic::sqrt(b, x, y),
        Op::Abs => algebraic::abs(b, x),
        Op::PowInt(-1) => algebraic::reciprocal(b, x),
        Op::PowInt(0) => return None,
        Op::PowInt(n) => power(b, n, 1, x, y),
        Op::PowRatio(p, q) => power(b, p, q, x, y),
        // e^x grows by itself.
        Op::Exp => rising(b, y_low, x, y),
        Op::Exp2 => {
            let slope = b.multiple_below(y_low, std::f64::consts::LN_2);
            rising(b, slope, x, y)
        }
        Op::Exp10 => {
            let slope = b.multiple_below(y_low, std::f64::consts::LN_10);
            rising(b, slope, x, y)
        }
        Op::Expm1 => {
            let minus_slope = b.add(y.nlo, minus_one);
            let slope = b.neg(minus_slope);
            rising(b, slope, x, y)
        }
        // 1/x and its multiples fall.
        Op::Ln => rising_by_inverse(b, x.hi, x, y),
        Op::Log2 | Op::Log10 => {
            let factor = if op == Op::Log2 { std::f64::consts::LOG2_E } else { std::f64::consts::LOG10_E };
            let factor = b.just_below(factor);
            let minus_factor = b.neg(factor);
            let minus_slope = b.div(minus_factor, x.hi);
            let slope = b.neg(minus_slope);
            rising(b, slope, x, y)
        }
        Op::Log1p => {
            let shifted = b.add(x.hi, one);
            rising_by_inverse(b, shifted, x, y)
        }
        Op::Cbrt => {
            let three = b.number(3.0);
            let size = b.largest(y);
            let square = b.mul(size, size);
            let divisor = b.mul(square, three);
            rising_by_inverse(b, divisor, x, y)
        }
        Op::Sin => {
            let cosines = elementary::apply(b, Op::Cos, &[x]).ends;
            by_slopes(b, cosines, x, y)
        }
        Op::Cos => {
            let sines = elementary::apply(b, Op::Sin, &[x]).ends;
            let slopes = b.neg_ends(sines);
            by_slopes(b, slopes, x, y)
        }
        // 1 + tan^2
        Op::Tan => {
            let slope = b.one_plus_square_below(y);
            rising(b, slope, x, y)
        }
        // sqrt(1 + sinh^2)
        Op::Sinh => {
            let square = b.one_plus_square_below(y);
            let slope = b.root_below(square);
            rising(b, slope, x, y)
        }
        // sqrt(cosh^2 - 1), with the sign of x; it is 0 where x contains 0.
        Op::Cosh => {
            let zero = b.zero();
            let minus_square = b.fma(y.nlo, y_low, one);
            let square = b.neg(minus_square);
            let square = b.max(square, zero);
            let size = b.root_below(square);
            let negative = b.less_equal(x.hi, zero);
            let minus_size = b.neg(size);
            let slope = b.select(negative, minus_size, size);
            Linear::monotone(b, slope, x, y)
        }
        // 1 - tanh^2
        Op::Tanh => {
            let size = b.largest(y);
            let minus_slope = b.fma(size, size, minus_one);
            let slope = b.neg(minus_slope);
            rising(b, slope, x, y)
        }
        // 1 / sqrt(1 - x^2)
        Op::Asin | Op::Acos => {
            let x = Ends { nlo: b.min(x.nlo, one), hi: b.min(x.hi, one) };
            let square = b.one_minus_square_above(x);
            let root = b.sqrt(square);
            let size = b.inverse_below(root);
            if op == Op::Asin { rising(b, size, x, y) } else { Linear::falling(b, size, x, y) }
        }
        // 1 / (1 + x^2)
        Op::Atan => {
            let size = b.largest(x);
            let divisor = b.fma(size, size, one);
            rising_by_inverse(b, divisor, x, y)
        }
        // 1 / sqrt(1 + x^2)
        Op::Asinh => {
            let size = b.largest(x);
            let square = b.fma(size, size, one);
            let root = b.sqrt(square);
            rising_by_inverse(b, root, x, y)
        }
        // 1 / sqrt(x^2 - 1)
        Op::Acosh => {
            let x = Ends { nlo: b.min(x.nlo, minus_one), hi: x.hi };
            let square = b.fma(x.hi, x.hi, minus_one);
            let root = b.sqrt(square);
            rising_by_inverse(b, root, x, y)
        }
        // 1 / (1 - x^2)
        Op::Atanh => {
            let divisor = b.one_minus_square_above(x);
            rising_by_inverse(b, divisor, x, y)
        }
        _ => return None,
    })
}

/// As [`Linear::rising`], for a bound that rounding may have taken below 0, which is never the least slope.
fn rising(b: &mut Builder, slope: Lane, x: Ends, y: Ends) -> Linear {
    let zero = b.zero();
    let slope = b.max(slope, zero);
    Linear::rising(b, slope, x, y)
}

/// The slope is at least the inverse of `divisor`, which is not below 0.
fn rising_by_inverse(b: &mut Builder, divisor: Lane, x: Ends, y: Ends) -> Linear {
    let slope = b.inverse_below(divisor);
    Linear::rising(b, slope, x, y)
}

/// By an enclosure of the derivative: the slope next to 0, or 0.
fn by_slopes(b: &mut Builder, slopes: Ends, x: Ends, y: Ends) -> Linear {
    let zero = b.zero();
    let low = b.low(slopes);
    let (rise, fall) = (b.max(low, zero), b.min(slopes.hi, zero));
    let slope = b.add(rise, fall);
    Linear::monotone(b, slope, x, y)
}

/// x^(p/q), p and q without common divisor, where x does not contain 0. The derivative is (p/q) x^(p/q) / |x|; its size
/// falls with |x| for p/q < 1, else it grows.
fn power(b: &mut Builder, p: i32, q: u32, x: Ends, y: Ends) -> Linear {
    let zero = b.zero();
    let ratio = f64::from(p.unsigned_abs()) / f64::from(q);
    let (size_x, size_y) = (b.abs_ends(x), b.abs_ends(y));
    let (value, argument) = if p > 0 && ratio < 1.0 {
        let at_largest = Ends { nlo: b.neg(size_x.hi), hi: size_x.hi };
        let values = elementary::apply(b, Op::PowRatio(p, q), &[at_largest]).ends;
        (b.low(values), size_x.hi)
    } else if p > 0 {
        (b.low(size_y), b.low(size_x))
    } else {
        (b.low(size_y), size_x.hi)
    };
    let minus_value = b.neg(value);
    let minus_quotient = b.div(minus_value, argument);
    let quotient = b.neg(minus_quotient);
    let size = b.multiple_below(quotient, ratio);
    // Max makes 0 of the NaN that 0/0 is.
    let size = b.max(size, zero);
    let touches = b.contains_zero(x);
    let size = b.select(touches, zero, size);
    let negative = b.less(x.hi, zero);
    let minus_size = b.neg(size);
    // On x > 0 the power grows where p > 0. On x < 0 that turns round where p is even.
    let (on_positive, on_negative) = match (p > 0, p % 2 == 0) {
        (true, true) => (size, minus_size),
        (true, false) => (size, size),
        (false, true) => (minus_size, size),
        (false, false) => (minus_size, minus_size),
    };
    let slope = b.select(negative, on_negative, on_positive);
    Linear::monotone(b, slope, x, y)
}

impl Builder {
    /// max |x|.
    fn largest(&mut self, x: Ends) -> Lane {
        self.max(x.nlo, x.hi)
    }

    /// At most 1 + v^2 for all v of x.
    fn one_plus_square_below(&mut self, x: Ends) -> Lane {
        let minus_one = self.number(-1.0);
        let nlo = self.abs_ends(x).nlo;
        let least = self.neg(nlo);
        let minus = self.fma(nlo, least, minus_one);
        self.neg(minus)
    }

    /// At least 1 - v^2 for all v of x, and not below 0.
    fn one_minus_square_above(&mut self, x: Ends) -> Lane {
        let (zero, one) = (self.zero(), self.number(1.0));
        let nlo = self.abs_ends(x).nlo;
        let least = self.neg(nlo);
        let above = self.fma(nlo, least, one);
        self.max(above, zero)
    }

    /// At most 1 / x.
    fn inverse_below(&mut self, x: Lane) -> Lane {
        let minus_one = self.number(-1.0);
        let minus = self.div(minus_one, x);
        self.neg(minus)
    }

    /// At most sqrt x: the root rounded up is less than 2 epsilon too large.
    fn root_below(&mut self, x: Lane) -> Lane {
        let root = self.sqrt(x);
        let (minus_root, margin) = (self.neg(root), self.epsilons(2.0));
        let minus = self.fma(root, margin, minus_root);
        self.neg(minus)
    }

    /// A number of the format below `value` > 0, which is a real number rounded to the nearest double.
    fn just_below(&mut self, value: f64) -> Lane {
        let minus = self.up(-value.next_down());
        self.neg(minus)
    }

    /// At most x times the positive real number that rounds to `factor`, for x >= 0.
    fn multiple_below(&mut self, x: Lane, factor: f64) -> Lane {
        let factor = self.just_below(factor);
        let minus_x = self.neg(x);
        let minus = self.mul(minus_x, factor);
        self.neg(minus)
    }
}
