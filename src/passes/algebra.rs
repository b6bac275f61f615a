//! Algebraic rewrites. A row may tighten an enclosure; it never loses a point and never forgets where a value is undefined.
//!
//! Side conditions over the domain: `total(x)`, x is proved to be defined everywhere; `x >= 0` and the like, by the bounds
//! of x; `function(x)`, x is one number at each point (see [`Builder::is_function`]), needed wherever a row uses that
//! two occurrences of x are equal. c and d are numbers, x and y any values, n and m integers.

use num_rational::BigRational;
use num_traits::One;
use num_traits::Signed;
use num_traits::ToPrimitive;
use num_traits::Zero;

use super::builder::Builder;
use super::exact::exact;
use crate::graph::Op;
use crate::graph::Value;

/// The first row that applies to an operation on given operands.
pub fn rewrite(g: &mut Builder, op: Op, operands: &[Value]) -> Option<Value> {
    if let Some(number) = only_value(g, op, operands) {
        return Some(g.constant(number));
    }
    match *operands {
        [x] => {
            negation(g, op, x).or_else(|| symmetry(g, op, x)).or_else(|| inverse(g, op, x)).or_else(|| power(g, op, x))
        }
        [x, y] => match op {
            Op::Add => sum(g, x, y).or_else(|| sum(g, y, x)),
            Op::Sub => difference(g, x, y),
            Op::Mul => product(g, x, y).or_else(|| product(g, y, x)),
            Op::Div => quotient(g, x, y),
            Op::Min | Op::Max => extremum(g, op, x, y).or_else(|| extremum(g, op, y, x)),
            Op::Hypot => hypotenuse(g, x, y).or_else(|| hypotenuse(g, y, x)),
            Op::Pow => real_power(g, x, y),
            Op::Less | Op::LessEqual | Op::Equal => comparison(g, op, x, y),
            _ => None,
        },
        [switch, below, above] if op == Op::Kink => kink(g, switch, below, above),
        [condition, yes, no] => selection(g, op, condition, yes, no),
        _ => None,
    }
}

/// x -> c  // the bounds hold one number only: 0 x, a decided comparison, the floor of a small range; total(x)
fn only_value(g: &mut Builder, op: Op, operands: &[Value]) -> Option<BigRational> {
    if operands.is_empty() {
        return None;
    }
    let value = g.push(op, operands);
    let enclosure = g.enclosure(value);
    if enclosure.is_singleton() && g.total(value) { BigRational::from_float(enclosure.lo()) } else { None }
}

fn sum(g: &mut Builder, x: Value, y: Value) -> Option<Value> {
    // x + 0 -> x
    if g.number(y).is_some_and(Zero::is_zero) {
        return Some(x);
    }
    // x + (-y) -> x - y  // one operation less
    if let Some(y) = g.under(Op::Neg, y) {
        return Some(g.push(Op::Sub, &[x, y]));
    }
    // c x + d x -> (c + d) x  // sub-distributive: the left side lets x vary twice; function(x)
    if let Some(scaled) = collect(g, Op::Add, x, y) {
        return Some(scaled);
    }
    let d = g.number(y)?;
    // (x + c) + d -> x + (c + d)  // one rounding in place of two; c + d short, else its own rounding may be the larger
    if let Some((x, c)) = offset(g, x) {
        let c = short(c + d)?;
        return Some(with_constant(g, Op::Add, x, c));
    }
    // (c - x) + d -> (c + d) - x  // as above
    if let (Op::Sub, &[c, x]) = g.shape(x) {
        let c = short(g.number(c)? + d)?;
        let c = g.constant(c);
        return Some(g.push(Op::Sub, &[c, x]));
    }
    None
}

fn difference(g: &mut Builder, x: Value, y: Value) -> Option<Value> {
    // x - c -> x + (-c)  // one form for the rows above; x - 0 and x - (-c) among them
    if let Some(c) = g.number(y) {
        let c = -c;
        return Some(with_constant(g, Op::Add, x, c));
    }
    // 0 - x -> -x
    if g.number(x).is_some_and(Zero::is_zero) {
        return Some(g.push(Op::Neg, &[y]));
    }
    // x - (-y) -> x + y
    if let Some(y) = g.under(Op::Neg, y) {
        return Some(g.push(Op::Add, &[x, y]));
    }
    // c x - d x -> (c - d) x  // x - x -> 0 x among them, which keeps the domain; function(x)
    if let Some(scaled) = collect(g, Op::Sub, x, y) {
        return Some(scaled);
    }
    let c = g.number(x)?;
    // c - (x + d) -> (c - d) - x  // c - d short
    if let Some((x, d)) = offset(g, y) {
        let c = short(c - d)?;
        let c = g.constant(c);
        return Some(g.push(Op::Sub, &[c, x]));
    }
    // c - (d - x) -> x + (c - d)  // c - d short
    if let (Op::Sub, &[d, x]) = g.shape(y) {
        let c = short(c - g.number(d)?)?;
        return Some(with_constant(g, Op::Add, x, c));
    }
    None
}

fn product(g: &mut Builder, x: Value, y: Value) -> Option<Value> {
    if let Some(c) = g.number(x) {
        // 1 x -> x
        if c.is_one() {
            return Some(y);
        }
        // (-1) x -> -x
        if (-c).is_one() {
            return Some(g.push(Op::Neg, &[y]));
        }
        // 0 x -> 0  // total(x): by `only_value`
        // c (d x) -> (c d) x  // c (-x) among them
        let (d, base) = scale(g, y);
        if base != y {
            let c = exact(Op::Mul, &[c, &d])?;
            return Some(with_constant(g, Op::Mul, base, c));
        }
        return None;
    }
    // (-x) y -> -(x y)  // the sign meets others further up
    if let Some(x) = g.under(Op::Neg, x) {
        let product = g.push(Op::Mul, &[x, y]);
        return Some(g.push(Op::Neg, &[product]));
    }
    // (c x) (d y) -> (c d) (x y)  // one product less
    let ((c, a), (d, b)) = (scale(g, x), scale(g, y));
    if a != x && b != y {
        let c = exact(Op::Mul, &[&c, &d])?;
        let product = g.push(Op::Mul, &[a, b]);
        return Some(with_constant(g, Op::Mul, product, c));
    }
    // x^n x^m -> x^(n + m)  // x x -> x^2 among them: the factors are one number; n, m of one sign, else 0 is forgotten;
    // function(x)
    let ((a, n), (b, m)) = (exponent(g, x), exponent(g, y));
    if a == b && (n > 0) == (m > 0) && g.is_function(a) {
        return Some(integer_power(g, a, n.checked_add(m)?));
    }
    None
}

fn quotient(g: &mut Builder, x: Value, y: Value) -> Option<Value> {
    // x / c -> (1/c) x  // division is several times slower; the rounding of 1/c costs an ulp; c other than 0
    if let Some(c) = g.number(y) {
        let c = (!c.is_zero()).then(|| c.recip())?;
        return Some(with_constant(g, Op::Mul, x, c));
    }
    // c / (d x) -> (c/d) / x  // c / (-x) among them; d other than 0, which was not defined anywhere
    if let Some(c) = g.number(x) {
        let (d, base) = scale(g, y);
        let c = if base == y { None } else { exact(Op::Div, &[c, &d]) }?;
        let c = g.constant(c);
        return Some(g.push(Op::Div, &[c, base]));
    }
    // (-x) / y -> -(x / y)
    if let Some(x) = g.under(Op::Neg, x) {
        let quotient = g.push(Op::Div, &[x, y]);
        return Some(g.push(Op::Neg, &[quotient]));
    }
    // x / (-y) -> -(x / y)
    if let Some(y) = g.under(Op::Neg, y) {
        let quotient = g.push(Op::Div, &[x, y]);
        return Some(g.push(Op::Neg, &[quotient]));
    }
    None
}

fn negation(g: &mut Builder, op: Op, x: Value) -> Option<Value> {
    match (op, g.shape(x)) {
        // -(-x) -> x
        (Op::Neg, (Op::Neg, &[x])) => Some(x),
        // -(x - y) -> y - x
        (Op::Neg, (Op::Sub, &[x, y])) => Some(g.push(Op::Sub, &[y, x])),
        // -(c / x) -> (-c) / x
        (Op::Neg, (Op::Div, &[c, x])) => {
            let c = -g.number(c)?;
            let c = g.constant(c);
            Some(g.push(Op::Div, &[c, x]))
        }
        (Op::Neg, (Op::Mul | Op::Add, _)) => {
            // -(x + c) -> (-c) - x
            if let Some((x, c)) = offset(g, x) {
                let c = -c;
                let c = g.constant(c);
                return Some(g.push(Op::Sub, &[c, x]));
            }
            // -(c x) -> (-c) x
            let (c, base) = scale(g, x);
            (base != x).then(|| with_constant(g, Op::Mul, base, -c))
        }
        _ => None,
    }
}

/// Functions that are even or odd.
fn symmetry(g: &mut Builder, op: Op, x: Value) -> Option<Value> {
    let even = match op {
        Op::Abs | Op::Sqr | Op::Cos | Op::Cosh => true,
        Op::PowInt(n) => n % 2 == 0,
        Op::PowRatio(p, q) => q % 2 == 1 && p % 2 == 0,
        _ => false,
    };
    let odd = match op {
        Op::Sign | Op::Round | Op::Cbrt | Op::Sin | Op::Tan | Op::Asin | Op::Atan => true,
        Op::Sinh | Op::Tanh | Op::Asinh | Op::Atanh => true,
        Op::PowInt(n) => n % 2 != 0,
        Op::PowRatio(p, q) => q % 2 == 1 && p % 2 != 0,
        _ => false,
    };
    match g.shape(x) {
        // f(-x) -> f(x), f(|x|) -> f(x)  // f even
        (Op::Neg | Op::Abs, &[x]) if even => Some(g.push(op, &[x])),
        // f(-x) -> -f(x)  // f odd
        (Op::Neg, &[x]) if odd => {
            let image = g.push(op, &[x]);
            Some(g.push(Op::Neg, &[image]))
        }
        _ => None,
    }
}

/// A function of its own inverse, and what bounds decide of a single operand.
fn inverse(g: &mut Builder, op: Op, x: Value) -> Option<Value> {
    let bounds = g.enclosure(x);
    match (op, g.shape(x)) {
        // |x| -> x  // x >= 0
        (Op::Abs, _) if bounds.lo() >= 0.0 => Some(x),
        // |x| -> -x  // x <= 0
        (Op::Abs, _) if bounds.hi() <= 0.0 => Some(g.push(Op::Neg, &[x])),
        // sqrt(x^2n) -> |x^n|  // x is defined where its power is; n > 0
        (Op::Sqrt, (Op::Sqr | Op::PowInt(2..), _)) => {
            let (base, n) = exponent(g, x);
            let root = if n % 2 == 0 { integer_power(g, base, n / 2) } else { return None };
            Some(g.push(Op::Abs, &[root]))
        }
        // sqrt(x)^2 -> x  // x >= 0, else a domain is forgotten
        (Op::Sqr, (Op::Sqrt, &[y])) if g.enclosure(y).lo() >= 0.0 => Some(y),
        // cbrt(x)^3 -> x, cbrt(x^3) -> x
        (Op::PowInt(3), (Op::Cbrt, &[y])) | (Op::Cbrt, (Op::PowInt(3), &[y])) => Some(y),
        // ln(exp(x)) -> x  // exp is positive everywhere
        (Op::Ln, (Op::Exp, &[y]))
        | (Op::Log2, (Op::Exp2, &[y]))
        | (Op::Log10, (Op::Exp10, &[y]))
        | (Op::Log1p, (Op::Expm1, &[y])) => Some(y),
        // exp(ln(x)) -> x  // x > 0, else a domain is forgotten
        (Op::Exp, (Op::Ln, &[y])) | (Op::Exp2, (Op::Log2, &[y])) | (Op::Exp10, (Op::Log10, &[y]))
            if g.enclosure(y).lo() > 0.0 =>
        {
            Some(y)
        }
        // expm1(log1p(x)) -> x  // x > -1
        (Op::Expm1, (Op::Log1p, &[y])) if g.enclosure(y).lo() > -1.0 => Some(y),
        // floor(x) -> x  // x is an integer: floor, ceiling, rounding or sign
        (Op::Floor | Op::Ceil | Op::Round, (Op::Floor | Op::Ceil | Op::Round | Op::Sign, _)) => Some(x),
        _ => None,
    }
}

fn power(g: &mut Builder, op: Op, x: Value) -> Option<Value> {
    let n = match op {
        Op::PowInt(n) => n,
        Op::Sqr => 2,
        _ => return None,
    };
    match n {
        // x^0 -> 1  // total(x): by `only_value`
        0 => return None,
        // x^(-1) -> 1 / x
        -1 => {
            let one = g.constant(BigRational::one());
            return Some(g.push(Op::Div, &[one, x]));
        }
        // x^1 -> x
        1 => return Some(x),
        _ => {}
    }
    // (x^m)^n -> x^(m n)  // not for two negative exponents: 0 would be forgotten; m, n other than 0
    let (base, m) = exponent(g, x);
    if base != x && m != 0 && (m > 0 || n > 0) {
        return Some(integer_power(g, base, m.checked_mul(n)?));
    }
    // x^2 as a power -> sqr(x)
    (op == Op::PowInt(2)).then(|| g.push(Op::Sqr, &[x]))
}

fn hypotenuse(g: &mut Builder, x: Value, y: Value) -> Option<Value> {
    // hypot(x, 0) -> |x|
    if g.number(y).is_some_and(Zero::is_zero) {
        return Some(g.push(Op::Abs, &[x]));
    }
    // hypot(-x, y) -> hypot(x, y), hypot(|x|, y) -> hypot(x, y)
    match g.shape(x) {
        (Op::Neg | Op::Abs, &[x]) => Some(g.push(Op::Hypot, &[x, y])),
        _ => None,
    }
}

/// `pow` with a number as base or exponent.
fn real_power(g: &mut Builder, x: Value, y: Value) -> Option<Value> {
    // 2^x -> exp2(x), 10^x -> exp10(x)
    if let Some(c) = g.number(x) {
        let exponential = match c.to_i64().filter(|_| c.is_integer())? {
            2 => Op::Exp2,
            10 => Op::Exp10,
            _ => return None,
        };
        return Some(g.push(exponential, &[y]));
    }
    let (p, q) = (g.number(y)?.numer().to_i32()?, g.number(y)?.denom().to_u32()?);
    // Both sides are undefined at 0 for p < 0; for p = 0 only the left one is.
    let bounds = g.enclosure(x);
    let nonnegative = if p == 0 { bounds.lo() > 0.0 } else { bounds.lo() >= 0.0 };
    match q {
        // pow(x, n) -> x^n  // x >= 0, else a domain is forgotten; x > 0 for n = 0
        1 if nonnegative => Some(g.push(Op::PowInt(p), &[x])),
        // pow(x, 1/2) -> sqrt(x)
        2 if p == 1 => Some(g.push(Op::Sqrt, &[x])),
        // pow(x, p/q) -> x^(p/q)  // q even: one domain; q odd: x >= 0
        2.. if q % 2 == 0 || nonnegative => Some(g.push(Op::PowRatio(p, q), &[x])),
        _ => None,
    }
}

fn extremum(g: &mut Builder, op: Op, x: Value, y: Value) -> Option<Value> {
    let (a, b) = (g.enclosure(x), g.enclosure(y));
    let first = if op == Op::Min { a.hi() <= b.lo() } else { a.lo() >= b.hi() };
    // min(x, x) -> x
    // min(x, y) -> x  // x <= y; total(y)
    if x == y || first && g.total(y) {
        return Some(x);
    }
    // max(x, -x) -> |x|, min(x, -x) -> -|x|  // tighter where x changes sign; function(x)
    if g.under(Op::Neg, y) == Some(x) && g.is_function(x) {
        let magnitude = g.push(Op::Abs, &[x]);
        return Some(if op == Op::Max { magnitude } else { g.push(Op::Neg, &[magnitude]) });
    }
    None
}

fn comparison(g: &mut Builder, op: Op, x: Value, y: Value) -> Option<Value> {
    // x < x -> 0, x <= x -> 1, x = x -> 1  // function(x); total(x)
    if x == y && g.is_function(x) && g.total(x) {
        let truth = if op == Op::Less { BigRational::zero() } else { BigRational::one() };
        return Some(g.constant(truth));
    }
    None
}

fn selection(g: &mut Builder, op: Op, condition: Value, yes: Value, no: Value) -> Option<Value> {
    // if 1 then x else y -> x  // by constant folding; a condition that bounds decide is a number by `only_value`
    // if 1 - c then x else y -> if c then y else x
    if let (Op::Sub, &[one, negated]) = g.shape(condition)
        && g.number(one).is_some_and(One::is_one)
    {
        return Some(g.push(op, &[negated, no, yes]));
    }
    if op == Op::SelectJump {
        // Equal arms do not help: the derivative across the jump is neither.
        return None;
    }
    // if c then x else x -> x  // total(c)
    if yes == no && g.total(condition) {
        return Some(yes);
    }
    let is = |g: &Builder, value: Value, number: BigRational| g.number(value) == Some(&number);
    // if c then 1 else 0 -> c
    if is(g, yes, BigRational::one()) && is(g, no, BigRational::zero()) {
        return Some(condition);
    }
    // if c then 0 else 1 -> 1 - c
    if is(g, yes, BigRational::zero()) && is(g, no, BigRational::one()) {
        return Some(g.push(Op::Sub, &[no, condition]));
    }
    None
}

/// The derivative at a kink, between the arms where the switch is 0.
fn kink(g: &mut Builder, switch: Value, below: Value, above: Value) -> Option<Value> {
    let bounds = g.enclosure(switch);
    if g.total(switch) {
        // kink(s, x, y) -> x  // s < 0; total(s)
        // kink(s, x, x) -> x  // total(s); between equal slopes there is one
        if bounds.hi() < 0.0 || below == above {
            return Some(below);
        }
        // kink(s, x, y) -> y  // s > 0; total(s)
        if bounds.lo() > 0.0 {
            return Some(above);
        }
    }
    // kink(-s, x, y) -> kink(s, y, x)
    let switch = g.under(Op::Neg, switch)?;
    Some(g.push(Op::Kink, &[switch, above, below]))
}

/// `c x op d x` as one multiple of x, for `op` a sum or difference.
fn collect(g: &mut Builder, op: Op, x: Value, y: Value) -> Option<Value> {
    let ((c, a), (d, b)) = (scale(g, x), scale(g, y));
    if a != b || !g.is_function(a) {
        return None;
    }
    let c = exact(op, &[&c, &d])?;
    Some(with_constant(g, Op::Mul, a, c))
}

/// x as `c y`: a product with a number, a negation, or `1 x`. Numbers themselves are `1 x` too.
fn scale(g: &Builder, x: Value) -> (BigRational, Value) {
    match g.shape(x) {
        (Op::Neg, &[y]) => (-BigRational::one(), y),
        (Op::Mul, &[a, b]) => match (g.number(a), g.number(b)) {
            (Some(c), _) => (c.clone(), b),
            (None, Some(c)) => (c.clone(), a),
            (None, None) => (BigRational::one(), x),
        },
        _ => (BigRational::one(), x),
    }
}

/// x as `y + c`.
fn offset<'g>(g: &'g Builder, x: Value) -> Option<(Value, &'g BigRational)> {
    match g.shape(x) {
        (Op::Add, &[a, b]) => g.number(b).map(|c| (a, c)).or_else(|| g.number(a).map(|c| (b, c))),
        _ => None,
    }
}

/// x as `y^n` for an integer n; every value is its own first power.
fn exponent(g: &Builder, x: Value) -> (Value, i32) {
    match g.shape(x) {
        (Op::Sqr, &[y]) => (y, 2),
        (Op::PowInt(n), &[y]) => (y, n),
        _ => (x, 1),
    }
}

/// `x^n` by its one name.
fn integer_power(g: &mut Builder, x: Value, n: i32) -> Value {
    match n {
        1 => x,
        2 => g.push(Op::Sqr, &[x]),
        _ => g.push(Op::PowInt(n), &[x]),
    }
}

fn with_constant(g: &mut Builder, op: Op, x: Value, number: BigRational) -> Value {
    let constant = g.constant(number);
    g.push(op, &[constant, x])
}

/// The number if it is exact in both formats, so that adding it rounds once: at most 24 significant bits and a modest
/// exponent.
fn short(number: BigRational) -> Option<BigRational> {
    let numerator = number.numer().abs();
    let odd_bits = numerator.bits() - numerator.trailing_zeros().unwrap_or(0);
    let denominator = number.denom();
    let power_of_two = denominator.trailing_zeros() == Some(denominator.bits() - 1);
    (odd_bits <= 24 && power_of_two && numerator.bits() <= 100 && denominator.bits() <= 100).then_some(number)
}
