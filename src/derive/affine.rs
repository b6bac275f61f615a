//! AF1 forms on lanes (Messine 2002): x0 + sum x_i e_i + err e, every e in [-1, 1], the e_i shared between forms and
//! the last one each form's own, with err >= 0.
//!
//! All rounding is upward. The error of a rounded centre is what rounding it up and rounding it down differ by; the errors
//! of the coefficients, which are small beside it, are bounded by a few epsilon of what they are made of. Both join `err`.
//! Such a bound is a sum of products of magnitudes, so that it is infinite wherever a coefficient overflows, whatever
//! rounding upward makes of that.
//!
//! A form that has become useless carries a NaN or an infinite `err`; it spreads by itself, and the intersection with
//! the natural extension drops it, because `Min` gives its second operand where the first is NaN.

mod algebraic;
mod linear;
mod quotient;
mod smooth;

use crate::derive::ends::Ends;
use crate::derive::lanes::Builder;
use crate::derive::lanes::Lane;
use crate::graph::Op;

/// The most shared noise symbols a form carries.
pub const SYMBOLS: usize = 3;

#[derive(Debug, Clone, Copy)]
pub struct Af1 {
    centre: Lane,
    /// Those that are 0 for certain are the constant 0, and no operation is spent on them.
    coefficients: [Lane; SYMBOLS],
    error: Lane,
}

/// An operand: its form, and its enclosure, which is often narrower than the form's range.
#[derive(Debug, Clone, Copy)]
pub struct Operand {
    pub form: Af1,
    pub ends: Ends,
}

/// The form of an enclosure: its radius belongs to the symbol of that index, or to the error term.
pub fn from_ends(b: &mut Builder, x: Ends, symbol: Option<usize>) -> Af1 {
    let zero = b.zero();
    let (centre, radius) = match (b.as_number(x.nlo), b.as_number(x.hi)) {
        (Some(nlo), Some(hi)) => constant(b, nlo, hi),
        _ => centre_and_radius(b, x),
    };
    let mut form = Af1 { centre, coefficients: [zero; SYMBOLS], error: radius };
    if let Some(index) = symbol {
        form.coefficients[index] = radius;
        form.error = zero;
    }
    form
}

/// The centre is the upper end, so that numbers of the format have no radius.
fn constant(b: &mut Builder, nlo: f64, hi: f64) -> (Lane, Lane) {
    let width = hi + nlo;
    let radius = match width {
        0.0 => 0.0,
        _ if width.is_finite() => width.next_up(),
        _ => f64::NAN,
    };
    (b.number(hi), b.up(radius))
}

fn centre_and_radius(b: &mut Builder, x: Ends) -> (Lane, Lane) {
    let half = b.number(0.5);
    let low = b.neg(x.nlo);
    let sum = b.add(x.hi, low);
    let centre = b.mul(sum, half);
    // Whatever the rounding made of the centre, the larger distance to an end bounds the radius. Max drops a NaN in its
    // first operand; the second is NaN or infinite too then, because that happens where the centre is not finite.
    let minus = b.neg(centre);
    let above = b.add(x.hi, minus);
    let below = b.add(x.nlo, centre);
    (centre, b.max(above, below))
}

/// The range of a form.
pub fn to_ends(b: &mut Builder, x: &Af1) -> Ends {
    let radius = x.radius(b);
    let minus = b.neg(x.centre);
    Ends { nlo: b.add(minus, radius), hi: b.add(x.centre, radius) }
}

/// The form of one operation whose natural extension has the given ends; `None` for operations without a form of their
/// own, which go through those ends.
pub fn apply(b: &mut Builder, op: Op, operands: &[Operand], natural: Ends) -> Option<Af1> {
    let form = match (op, operands) {
        (Op::Neg, [x]) => neg(b, &x.form),
        (Op::Add, [x, y]) => add(b, &x.form, &y.form),
        (Op::Sub, [x, y]) => sub(b, &x.form, &y.form),
        (Op::Mul, [x, y]) => mul(b, &x.form, &y.form),
        (Op::Sqr, [x]) => sqr(b, &x.form),
        (Op::PowInt(n @ 1..=MULTIPLIED), [x]) => power(b, &x.form, n.unsigned_abs()),
        (Op::Div, [x, y]) => quotient::div(b, x, y),
        (Op::Min, [x, y]) => algebraic::min(b, x, y),
        (Op::Max, [x, y]) => algebraic::max(b, x, y),
        (Op::Hypot, [x, y]) => {
            let (square_x, square_y) = (sqr(b, &x.form), sqr(b, &y.form));
            let form = add(b, &square_x, &square_y);
            let (ends_x, ends_y) = (b.sqr_ends(x.ends), b.sqr_ends(y.ends));
            let ends = b.add_ends(ends_x, ends_y);
            algebraic::sqrt(b, ends, natural).apply(b, &form)
        }
        (_, [x]) => smooth::approximation(b, op, x.ends, natural)?.apply(b, &x.form),
        _ => return None,
    };
    Some(form)
}

/// Powers up to this are multiplied out; of higher ones the form by its slope is cheaper and no wider.
const MULTIPLIED: i32 = 8;

impl Af1 {
    /// Sum of the coefficients' magnitudes.
    fn spread(&self, b: &mut Builder) -> Lane {
        spread(b, &self.coefficients)
    }

    /// Half the width of its range.
    fn radius(&self, b: &mut Builder) -> Lane {
        let spread = self.spread(b);
        b.add(spread, self.error)
    }
}

fn spread(b: &mut Builder, coefficients: &[Lane]) -> Lane {
    let zero = b.zero();
    coefficients.iter().fold(zero, |sum, &coefficient| {
        if b.is_zero(coefficient) {
            return sum;
        }
        let size = b.abs(coefficient);
        b.add(sum, size)
    })
}

impl Builder {
    fn is_zero(&self, x: Lane) -> bool {
        self.as_number(x) == Some(0.0)
    }

    /// `sum` and what rounding coefficients may have missed: so many epsilon of the sum of the magnitudes of their terms.
    /// That holds for sums, which do not underflow.
    fn with_rounding(&mut self, sum: Lane, epsilons: f64, magnitude: Lane) -> Lane {
        if self.is_zero(magnitude) {
            return sum;
        }
        let factor = self.epsilons(epsilons);
        self.fma(factor, magnitude, sum)
    }

    /// The same for products. Each that underflows misses at most the smallest number; there are fewer of them than the
    /// smallest normal number has units.
    fn with_product_rounding(&mut self, sum: Lane, epsilons: f64, magnitude: Lane) -> Lane {
        if self.is_zero(magnitude) {
            return sum;
        }
        let tiny = self.least_normal();
        let missed = self.with_rounding(tiny, epsilons, magnitude);
        self.add(sum, missed)
    }

    fn least_normal(&mut self) -> Lane {
        self.by_precision(f32::MIN_POSITIVE.into(), f64::MIN_POSITIVE)
    }

    /// a b + sum, with nothing spent on constant zeros. Where that drops 0 times a NaN or an infinity, the form's centre
    /// is not finite either.
    fn weighted(&mut self, a: Lane, b: Lane, sum: Lane) -> Lane {
        match (self.is_zero(a) || self.is_zero(b), self.is_zero(sum)) {
            (true, _) => sum,
            (false, true) => self.mul(a, b),
            (false, false) => self.fma(a, b, sum),
        }
    }

    /// A product rounded up, and the gap to the same product rounded down.
    fn product_with_gap(&mut self, x: Lane, y: Lane) -> (Lane, Lane) {
        let up = self.mul(x, y);
        let minus_x = self.neg(x);
        let minus_down = self.mul(minus_x, y);
        (up, self.add(up, minus_down))
    }

    /// The same for a sum.
    fn sum_with_gap(&mut self, x: Lane, y: Lane) -> (Lane, Lane) {
        if self.is_zero(x) || self.is_zero(y) {
            return (self.add(x, y), self.zero());
        }
        let up = self.add(x, y);
        let (minus_x, minus_y) = (self.neg(x), self.neg(y));
        let minus_down = self.add(minus_x, minus_y);
        (up, self.add(up, minus_down))
    }

    /// The same for a b + c.
    fn fma_with_gap(&mut self, x: Lane, y: Lane, z: Lane) -> (Lane, Lane) {
        let up = self.fma(x, y, z);
        let (minus_x, minus_z) = (self.neg(x), self.neg(z));
        let minus_down = self.fma(minus_x, y, minus_z);
        (up, self.add(up, minus_down))
    }
}

fn neg(b: &mut Builder, x: &Af1) -> Af1 {
    let coefficients = x.coefficients.map(|c| if b.is_zero(c) { c } else { b.neg(c) });
    Af1 { centre: b.neg(x.centre), coefficients, ..*x }
}

fn sub(b: &mut Builder, x: &Af1, y: &Af1) -> Af1 {
    let minus = neg(b, y);
    add(b, x, &minus)
}

fn add(b: &mut Builder, x: &Af1, y: &Af1) -> Af1 {
    let (centre, gap) = b.sum_with_gap(x.centre, y.centre);
    let error = b.add(x.error, y.error);
    let error = b.add(error, gap);
    // Only sums of two coefficients round, each by at most epsilon of its size.
    let rounded: Vec<usize> =
        (0..SYMBOLS).filter(|&i| !b.is_zero(x.coefficients[i]) && !b.is_zero(y.coefficients[i])).collect();
    let [spread_x, spread_y] = [x, y].map(|form| {
        let terms: Vec<Lane> = rounded.iter().map(|&i| form.coefficients[i]).collect();
        spread(b, &terms)
    });
    let magnitude = b.add(spread_x, spread_y);
    let error = b.with_rounding(error, 1.0, magnitude);
    let coefficients = std::array::from_fn(|i| b.add(x.coefficients[i], y.coefficients[i]));
    Af1 { centre, coefficients, error }
}

/// The AF1 product: centre x0 y0, coefficients x0 y_i + y0 x_i, error |x0| err_y + |y0| err_x + rad x rad y.
fn mul(b: &mut Builder, x: &Af1, y: &Af1) -> Af1 {
    let (centre, gap) = b.product_with_gap(x.centre, y.centre);
    let (size_x, size_y) = (b.abs(x.centre), b.abs(y.centre));
    let (radius_x, radius_y) = (x.radius(b), y.radius(b));
    let error = b.weighted(size_x, y.error, gap);
    let error = b.weighted(size_y, x.error, error);
    let error = b.weighted(radius_x, radius_y, error);
    let zero = b.zero();
    let coefficients = std::array::from_fn(|i| {
        let right = b.weighted(y.centre, x.coefficients[i], zero);
        b.weighted(x.centre, y.coefficients[i], right)
    });
    // y0 x_i rounds by epsilon of itself, and the sum by epsilon of what it then is: (2 + epsilon) |y0 x_i| + |x0 y_i|.
    let (spread_x, spread_y) = (x.spread(b), y.spread(b));
    let magnitude = b.weighted(size_y, spread_x, zero);
    let magnitude = b.weighted(size_x, spread_y, magnitude);
    let error = b.with_product_rounding(error, 3.0, magnitude);
    Af1 { centre, coefficients, error }
}

/// The square: the quadratic term lies in [0, rad^2], so half of it moves the centre and half is error.
fn sqr(b: &mut Builder, x: &Af1) -> Af1 {
    let half = b.number(0.5);
    let two = b.number(2.0);
    let radius = x.radius(b);
    let half_radius = b.mul(radius, half);
    let half_quadratic = b.mul(half_radius, radius);
    let (centre, gap) = b.fma_with_gap(x.centre, x.centre, half_quadratic);
    // 2 x0 (sum x_i e_i + err e): the part of err goes to the error.
    let slope = b.mul(two, x.centre);
    let steepness = b.abs(slope);
    let error = b.add(half_quadratic, gap);
    let form = Af1 { centre, coefficients: x.coefficients, error };
    scaled(b, form, slope, steepness, x)
}

/// The form with its coefficients replaced by `slope` times those of x, whose error counts `steepness` = |slope| times.
fn scaled(b: &mut Builder, form: Af1, slope: Lane, steepness: Lane, x: &Af1) -> Af1 {
    let zero = b.zero();
    let error = b.weighted(steepness, x.error, form.error);
    let spread = x.spread(b);
    let magnitude = b.weighted(steepness, spread, zero);
    let error = b.with_product_rounding(error, 1.0, magnitude);
    let coefficients = x.coefficients.map(|coefficient| b.weighted(slope, coefficient, zero));
    Af1 { centre: form.centre, coefficients, error }
}

/// `x^n`, n >= 1, by squaring.
fn power(b: &mut Builder, x: &Af1, n: u32) -> Af1 {
    let mut square = *x;
    let mut result: Option<Af1> = None;
    let mut rest = n;
    loop {
        if rest % 2 == 1 {
            result = Some(match result {
                None => square,
                Some(r) => mul(b, &r, &square),
            });
        }
        rest /= 2;
        if rest == 0 {
            return result.unwrap_or(square);
        }
        square = sqr(b, &square);
    }
}
