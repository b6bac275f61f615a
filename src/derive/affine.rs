//! AF1 forms on lanes (Messine 2002): x0 + sum x_i e_i + err e, every e in [-1, 1], the e_i shared between forms and
//! the last one each form's own, with err >= 0.
//!
//! All rounding is upward. The error of a rounded coefficient is what rounding it up and rounding it down differ by, and
//! joins `err`. A form that has become useless carries a NaN; it spreads by itself, and the intersection with the
//! natural extension drops it, because `Min` gives its second operand where the first is NaN.

use crate::derive::ends::Ends;
use crate::derive::lanes::Builder;
use crate::derive::lanes::Lane;
use crate::graph::Op;

/// The most shared noise symbols a form carries.
pub const SYMBOLS: usize = 3;

#[derive(Debug, Clone, Copy)]
pub struct Af1 {
    centre: Lane,
    /// The first `count` are coefficients.
    coefficients: [Lane; SYMBOLS],
    count: usize,
    error: Lane,
}

impl Af1 {
    fn coefficients(&self) -> &[Lane] {
        &self.coefficients[..self.count]
    }
}

/// The form of an enclosure: its radius belongs to the symbol of that index, or to the error term.
pub fn from_ends(b: &mut Builder, x: Ends, symbol: Option<usize>, count: usize) -> Af1 {
    let zero = b.zero();
    let half = b.number(0.5);
    let low = b.neg(x.nlo);
    let sum = b.add(x.hi, low);
    let centre = b.mul(sum, half);
    // Whatever the rounding made of the centre, the larger distance to an end bounds the radius. Max would drop a
    // NaN in its first operand, but both are NaN together: where the centre is not finite.
    let minus = b.neg(centre);
    let above = b.add(x.hi, minus);
    let below = b.add(x.nlo, centre);
    let radius = b.max(above, below);
    let mut form = Af1 { centre, coefficients: [zero; SYMBOLS], count, error: radius };
    if let Some(index) = symbol {
        form.coefficients[index] = radius;
        form.error = zero;
    }
    form
}

/// The range of a form.
pub fn to_ends(b: &mut Builder, x: &Af1) -> Ends {
    let radius = radius(b, x);
    let minus = b.neg(x.centre);
    Ends { nlo: b.add(minus, radius), hi: b.add(x.centre, radius) }
}

fn radius(b: &mut Builder, x: &Af1) -> Lane {
    x.coefficients().iter().fold(x.error, |sum, &coefficient| {
        let size = b.abs(coefficient);
        b.add(sum, size)
    })
}

/// One operation: the natural extension's ends intersected with the form's range, and the form. Operations without an
/// affine form of their own go through those ends.
pub fn apply(b: &mut Builder, op: Op, operands: &[Af1], natural: Ends) -> (Ends, Af1) {
    let form = match (op, operands) {
        (Op::Neg, [x]) => neg(b, x),
        (Op::Add, [x, y]) => add(b, x, y),
        (Op::Sub, [x, y]) => {
            let minus = neg(b, y);
            add(b, x, &minus)
        }
        (Op::Mul, [x, y]) => mul(b, x, y),
        (Op::Sqr, [x]) => sqr(b, x),
        (Op::PowInt(n), [x]) if n > 0 => power(b, x, n.unsigned_abs()),
        _ => {
            let count = operands.first().map_or(0, |x| x.count);
            return (natural, from_ends(b, natural, None, count));
        }
    };
    let range = to_ends(b, &form);
    (Ends { nlo: b.min(range.nlo, natural.nlo), hi: b.min(range.hi, natural.hi) }, form)
}

fn neg(b: &mut Builder, x: &Af1) -> Af1 {
    Af1 { centre: b.neg(x.centre), coefficients: x.coefficients.map(|c| b.neg(c)), ..*x }
}

/// A sum rounded up, and the gap to the same sum rounded down.
fn sum_with_gap(b: &mut Builder, x: Lane, y: Lane) -> (Lane, Lane) {
    let up = b.add(x, y);
    let (minus_x, minus_y) = (b.neg(x), b.neg(y));
    let minus_down = b.add(minus_x, minus_y);
    (up, b.add(up, minus_down))
}

fn product_with_gap(b: &mut Builder, x: Lane, y: Lane) -> (Lane, Lane) {
    let up = b.mul(x, y);
    let minus_x = b.neg(x);
    let minus_down = b.mul(minus_x, y);
    (up, b.add(up, minus_down))
}

fn add(b: &mut Builder, x: &Af1, y: &Af1) -> Af1 {
    let (centre, gap) = sum_with_gap(b, x.centre, y.centre);
    let mut error = b.add(x.error, y.error);
    error = b.add(error, gap);
    let mut coefficients = x.coefficients;
    for (coefficient, &other) in coefficients.iter_mut().zip(y.coefficients()) {
        let (sum, gap) = sum_with_gap(b, *coefficient, other);
        *coefficient = sum;
        error = b.add(error, gap);
    }
    Af1 { centre, coefficients, error, ..*x }
}

/// The AF1 product: centre x0 y0, coefficients x0 y_i + y0 x_i, error |x0| err_y + |y0| err_x + rad x rad y.
fn mul(b: &mut Builder, x: &Af1, y: &Af1) -> Af1 {
    let (centre, gap) = product_with_gap(b, x.centre, y.centre);
    let (size_x, size_y) = (b.abs(x.centre), b.abs(y.centre));
    let (radius_x, radius_y) = (radius(b, x), radius(b, y));
    let quadratic = b.mul(radius_x, radius_y);
    let mut error = b.fma(size_x, y.error, gap);
    error = b.fma(size_y, x.error, error);
    error = b.add(error, quadratic);
    let mut coefficients = x.coefficients;
    for (coefficient, &other) in coefficients.iter_mut().zip(y.coefficients()) {
        let (left, left_gap) = product_with_gap(b, x.centre, other);
        let (right, right_gap) = product_with_gap(b, y.centre, *coefficient);
        let (sum, gap) = sum_with_gap(b, left, right);
        *coefficient = sum;
        for gap in [left_gap, right_gap, gap] {
            error = b.add(error, gap);
        }
    }
    Af1 { centre, coefficients, error, ..*x }
}

/// The square: the quadratic term lies in [0, rad^2], so half of it moves the centre and half is error.
fn sqr(b: &mut Builder, x: &Af1) -> Af1 {
    let half = b.number(0.5);
    let two = b.number(2.0);
    let radius = radius(b, x);
    let quadratic = b.mul(radius, radius);
    let half_quadratic = b.mul(quadratic, half);
    let (square, gap) = product_with_gap(b, x.centre, x.centre);
    let (centre, shift_gap) = sum_with_gap(b, square, half_quadratic);
    // 2 x0 (sum x_i e_i + err e): the part of err goes to the error.
    let slope = b.mul(two, x.centre);
    let steepness = b.abs(slope);
    let mut error = b.fma(steepness, x.error, half_quadratic);
    error = b.add(error, gap);
    error = b.add(error, shift_gap);
    let mut coefficients = x.coefficients;
    for coefficient in &mut coefficients[..x.count] {
        let (product, gap) = product_with_gap(b, slope, *coefficient);
        *coefficient = product;
        error = b.add(error, gap);
    }
    Af1 { centre, coefficients, error, ..*x }
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
