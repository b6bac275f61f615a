//! The form of a quotient. With c near x / y and v near 1 / y, n = x - c y is small where x and y vary alike, and
//! x / y = c + n / y = c + v n + (1/y - v) n: the last term is at most |n| times the radius of the enclosure of 1 / y.

use crate::derive::affine::Af1;
use crate::derive::affine::Operand;
use crate::derive::affine::algebraic::reciprocal;
use crate::derive::affine::algebraic::reciprocals;
use crate::derive::affine::centre_and_radius;
use crate::derive::affine::mul;
use crate::derive::affine::scaled;
use crate::derive::lanes::Builder;
use crate::derive::lanes::Lane;

pub fn div(b: &mut Builder, x: &Operand, y: &Operand) -> Af1 {
    if b.as_number(x.form.centre).is_some() {
        // A constant numerator never varies like the divisor; the reciprocal's own form is twice as narrow.
        let inverse = reciprocal(b, y.ends).apply(b, &y.form);
        return mul(b, &x.form, &inverse);
    }
    let inverses = reciprocals(b, y.ends);
    let (v, v_radius) = centre_and_radius(b, inverses);
    let c = b.mul(x.form.centre, v);
    let n = remainder(b, x.form, y.form, c);
    let (centre, gap) = b.fma_with_gap(v, n.centre, c);
    // |n| at most.
    let size = b.abs(n.centre);
    let radius = n.radius(b);
    let size = b.add(size, radius);
    let error = b.fma(v_radius, size, gap);
    let steepness = b.abs(v);
    scaled(b, Af1 { centre, coefficients: n.coefficients, error }, v, steepness, &n)
}

/// x - c y.
fn remainder(b: &mut Builder, x: Af1, y: Af1, c: Lane) -> Af1 {
    let minus_c = b.neg(c);
    let size = b.abs(c);
    let (centre, gap) = b.fma_with_gap(minus_c, y.centre, x.centre);
    let error = b.add(x.error, gap);
    let error = b.weighted(size, y.error, error);
    let mut coefficients = x.coefficients;
    for (coefficient, &other) in coefficients.iter_mut().zip(&y.coefficients) {
        *coefficient = b.weighted(minus_c, other, *coefficient);
    }
    // Each rounds once, by epsilon of its size.
    let (spread_x, spread_y) = (x.spread(b), y.spread(b));
    let magnitude = b.weighted(size, spread_y, spread_x);
    let error = b.with_product_rounding(error, 1.0, magnitude);
    Af1 { centre, coefficients, error }
}
