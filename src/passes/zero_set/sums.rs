//! Equations between terms: what sums of a few terms say when they vanish.

use std::collections::BTreeMap;

use num_rational::BigRational;
use num_traits::One;
use num_traits::Signed;
use num_traits::Zero;

use super::guard::Guard;
use super::guard::Sign;
use super::poles::fraction;
use super::rules::Alternative;
use super::rules::all;
use super::space::Space;
use super::sum::Sum;
use super::sum::factors;
use super::sum::normal;
use super::sum::product;
use crate::graph::Op;
use crate::graph::Value;
use crate::passes::exact;

/// The zero set of a sum by its terms; `None` if they say nothing.
pub fn terms(space: &mut Space, field: Value) -> Option<Vec<Alternative>> {
    let form = normal(space, field);
    if form != field {
        return all([form]);
    }
    let sum = Sum::of(space, field);
    match (&sum.terms[..], sum.constant.is_zero()) {
        ([], _) | ([_], true) => return None,
        ([(c, t)], false) => {
            let value = -&sum.constant / c;
            if let Some(parts) = level(space, *t, &value) {
                return Some(parts);
            }
        }
        ([(c, t), (d, u)], true) => {
            let ratio = -d / c;
            if let Some(parts) = pair(space, *t, *u, &ratio) {
                return Some(parts);
            }
        }
        _ => {}
    }
    if let Some(parts) = common_factor(space, &sum) {
        return Some(parts);
    }
    let over = fraction(space, field);
    if over.d.is_some() {
        return all([over.n]);
    }
    root(space, &sum)
}

/// t = r for a number r other than 0.
fn level(space: &mut Space, t: Value, r: &BigRational) -> Option<Vec<Alternative>> {
    let (op, operands) = space.taken(t);
    let u = *operands.first()?;
    let one = BigRational::one;
    let number = |op: Op| exact(op, &[r]);
    let both = |space: &mut Space, s: BigRational| all([space.plus(u, &-&s), space.plus(u, &s)]);
    match op {
        Op::Abs | Op::Sqr | Op::Sqrt | Op::Hypot | Op::Exp | Op::Exp2 | Op::Exp10 if r.is_negative() => all([]),
        Op::PowInt(n) | Op::PowRatio(n, _) if n % 2 == 0 && r.is_negative() => all([]),
        Op::PowRatio(_, q) if q % 2 == 0 && r.is_negative() => all([]),
        Op::Abs => both(space, r.clone()),
        Op::Sqr => both(space, number(Op::Sqrt)?),
        Op::PowInt(n @ 1..) if n % 2 != 0 => {
            let s = number(Op::PowRatio(1, n.unsigned_abs()))?;
            all([space.plus(u, &-s)])
        }
        Op::PowInt(n @ 1..) => match number(Op::PowRatio(1, n.unsigned_abs())) {
            Some(s) => both(space, s),
            None => {
                let half = space.unary(Op::PowInt(n / 2), u);
                let s = number(Op::Sqrt)?;
                // The other square root of r is negative; an even power has no such value.
                let negative = if n % 4 == 0 { None } else { Some(space.plus(half, &s)) };
                all([space.plus(half, &-s)].into_iter().chain(negative))
            }
        },
        Op::Sqrt => all([space.plus(u, &-number(Op::Sqr)?)]),
        Op::Cbrt => all([space.plus(u, &-number(Op::PowInt(3))?)]),
        Op::PowRatio(1, q) => all([space.plus(u, &-number(Op::PowInt(i32::try_from(q).ok()?))?)]),
        Op::Exp | Op::Exp2 | Op::Exp10 | Op::Ln | Op::Log2 | Op::Log10 => {
            let inverse = match op {
                Op::Exp => Op::Ln,
                Op::Exp2 => Op::Log2,
                Op::Exp10 => Op::Log10,
                Op::Ln => Op::Exp,
                Op::Log2 => Op::Exp2,
                _ => Op::Exp10,
            };
            let r = space.constant(r.clone());
            let value = space.unary(inverse, r);
            all([space.binary(Op::Sub, u, value)])
        }
        Op::Hypot => {
            let squares = [u, operands[1]].map(|u| space.unary(Op::Sqr, u));
            let sum = space.push(Op::Add, &squares);
            all([space.plus(sum, &-number(Op::Sqr)?)])
        }
        Op::Min | Op::Max => {
            let shifted = [u, operands[1]].map(|u| space.plus(u, &-r));
            all([space.push(op, &shifted)])
        }
        // 1 - cos u = 2 sin(u/2)^2 and the like: what touches 0 becomes what crosses it.
        Op::Sin | Op::Cos if r.abs() == one() => {
            let half = space.times(&BigRational::new(1.into(), 2.into()), u);
            let (outer, shift) = match (op, r.is_positive()) {
                (Op::Sin, true) => (Op::Sin, -1),
                (Op::Sin, false) => (Op::Sin, 1),
                (_, true) => (Op::Sin, 0),
                (_, false) => (Op::Cos, 0),
            };
            let angle = turned(space, half, shift);
            all([space.unary(outer, angle)])
        }
        _ => None,
    }
}

/// An angle and a number of eighths of a turn, in radians.
fn turned(space: &mut Space, angle: Value, eighths: i64) -> Value {
    let pi = space.push(Op::Pi, &[]);
    let shift = space.times(&BigRational::new(eighths.into(), 4.into()), pi);
    if eighths == 0 { angle } else { space.binary(Op::Add, angle, shift) }
}

/// t = k u for a number k other than 0.
fn pair(space: &mut Space, t: Value, u: Value, k: &BigRational) -> Option<Vec<Alternative>> {
    squares(space, t, u, k)
        .or_else(|| same_function(space, t, u, k))
        .or_else(|| angles(space, t, u, k))
        .or_else(|| radicals(space, t, u, k))
}

/// a^2 = s^2 b^2 as a = s b or a = -s b, and |a| = s |b| likewise.
fn squares(space: &mut Space, t: Value, u: Value, k: &BigRational) -> Option<Vec<Alternative>> {
    if !k.is_positive() {
        return None;
    }
    let (a, b, s) = match (space.shape(t), space.shape(u)) {
        ((Op::Abs, &[a]), (Op::Abs, &[b])) => (a, b, k.clone()),
        _ => {
            let s = exact(Op::Sqrt, &[k])?;
            let (a, b) = (halved(space, t)?, halved(space, u)?);
            (product(space, a), product(space, b), s)
        }
    };
    let scaled = space.times(&s, b);
    all([Op::Sub, Op::Add].map(|op| space.binary(op, a, scaled)))
}

/// The factors of a square root of a square.
fn halved(space: &Space, value: Value) -> Option<BTreeMap<Value, i32>> {
    let factors = factors(space, value);
    factors.into_iter().map(|(base, n)| (n % 2 == 0).then_some((base, n / 2))).collect()
}

/// F(a) = k F(b) for a function F that takes no value twice: a = b for k = 1, a = -b for k = -1 and odd F, and other k
/// for powers and exponentials.
fn same_function(space: &mut Space, t: Value, u: Value, k: &BigRational) -> Option<Vec<Alternative>> {
    let ((op, a), (other, b)) = match (space.shape(t), space.shape(u)) {
        ((op, &[a]), (other, &[b])) => ((op, a), (other, b)),
        _ => return None,
    };
    if op != other {
        return None;
    }
    let odd = match op {
        Op::Cbrt | Op::Sinh | Op::Tanh | Op::Asinh | Op::Atanh | Op::Asin | Op::Atan => true,
        Op::PowInt(n) => n % 2 != 0,
        Op::PowRatio(p, q) => p % 2 != 0 && q % 2 != 0,
        _ => false,
    };
    let injective = odd
        || matches!(op, Op::Exp | Op::Exp2 | Op::Exp10 | Op::Expm1 | Op::Ln | Op::Log1p | Op::Log2 | Op::Log10)
        || matches!(op, Op::Acos | Op::Acosh | Op::Sqrt)
        || matches!(op, Op::PowRatio(_, q) if q % 2 == 0);
    if injective && k.is_one() {
        return all([space.binary(Op::Sub, a, b)]);
    }
    if odd && (-k).is_one() {
        return all([space.binary(Op::Add, a, b)]);
    }
    let scale = match op {
        Op::PowInt(n @ 1..) if odd => exact(Op::PowRatio(1, n.unsigned_abs()), &[k])?,
        Op::Cbrt => exact(Op::PowInt(3), &[k])?,
        Op::Sqrt if k.is_positive() => exact(Op::Sqr, &[k])?,
        Op::Exp | Op::Exp2 | Op::Exp10 => {
            let inverse = match op {
                Op::Exp => Op::Ln,
                Op::Exp2 => Op::Log2,
                _ => Op::Log10,
            };
            if !k.is_positive() {
                return all([]);
            }
            let k = space.constant(k.clone());
            let (difference, shift) = (space.binary(Op::Sub, a, b), space.unary(inverse, k));
            return all([space.binary(Op::Sub, difference, shift)]);
        }
        _ => return None,
    };
    let scaled = space.times(&scale, b);
    all([space.binary(Op::Sub, a, scaled)])
}

/// Sums and differences of sines, cosines and tangents as products (DLMF 4.21.6 to 4.21.10), whose factors vanish on
/// different curves.
fn angles(space: &mut Space, t: Value, u: Value, k: &BigRational) -> Option<Vec<Alternative>> {
    if !k.abs().is_one() {
        return None;
    }
    let ((op, a), (other, b)) = match (space.shape(t), space.shape(u)) {
        // cos a = k sin b is sin b = cos a / k, and k is its own inverse.
        ((Op::Cos, &[a]), (Op::Sin, &[b])) => ((Op::Sin, b), (Op::Cos, a)),
        ((op, &[a]), (other, &[b])) => ((op, a), (other, b)),
        _ => return None,
    };
    let half = BigRational::new(1.into(), 2.into());
    let (sum, difference) = (space.binary(Op::Add, a, b), space.binary(Op::Sub, a, b));
    let equal = k.is_one();
    if (op, other) == (Op::Tan, Op::Tan) {
        return all([space.unary(Op::Sin, if equal { difference } else { sum })]);
    }
    let (sum, difference) = (space.times(&half, sum), space.times(&half, difference));
    // (function, eighths) of half the sum and of half the difference.
    let (of_sum, of_difference) = match (op, other, equal) {
        (Op::Sin, Op::Sin, true) => ((Op::Cos, 0), (Op::Sin, 0)),
        (Op::Sin, Op::Sin, false) => ((Op::Sin, 0), (Op::Cos, 0)),
        (Op::Cos, Op::Cos, true) => ((Op::Sin, 0), (Op::Sin, 0)),
        (Op::Cos, Op::Cos, false) => ((Op::Cos, 0), (Op::Cos, 0)),
        // sin a - sin(pi/2 - b)
        (Op::Sin, Op::Cos, true) => ((Op::Sin, -1), (Op::Cos, 1)),
        // sin a + sin(pi/2 - b)
        (Op::Sin, Op::Cos, false) => ((Op::Cos, -1), (Op::Sin, 1)),
        _ => return None,
    };
    let factors = [(of_sum, sum), (of_difference, difference)];
    all(factors.map(|((outer, eighths), angle)| {
        let angle = turned(space, angle, eighths);
        space.unary(outer, angle)
    }))
}

/// Equations between what is not negative: squared, for square roots and distances.
fn radicals(space: &mut Space, t: Value, u: Value, k: &BigRational) -> Option<Vec<Alternative>> {
    if !k.is_positive() {
        return None;
    }
    let k = exact(Op::Sqr, &[k])?;
    let [left, right] = [t, u].map(|value| {
        let (op, operands) = space.taken(value);
        match (op, &operands[..]) {
            (Op::Sqrt, &[u]) => Some(u),
            (Op::Abs, &[u]) => Some(space.unary(Op::Sqr, u)),
            (Op::Hypot, &[u, v]) => {
                let squares = [u, v].map(|u| space.unary(Op::Sqr, u));
                Some(space.push(Op::Add, &squares))
            }
            _ => None,
        }
    });
    let scaled = space.times(&k, right?);
    all([space.binary(Op::Sub, left?, scaled)])
}

/// a c + b c as c (a + b).
fn common_factor(space: &mut Space, sum: &Sum) -> Option<Vec<Alternative>> {
    if !sum.constant.is_zero() {
        return None;
    }
    let powers: Vec<BTreeMap<Value, i32>> = sum.terms.iter().map(|(_, term)| factors(space, *term)).collect();
    let (first, others) = powers.split_first()?;
    let least = |base: &Value, n: i32| others.iter().map(|p| p.get(base).copied().unwrap_or(0)).min().map(|m| m.min(n));
    let common: BTreeMap<Value, i32> =
        first.iter().filter_map(|(base, &n)| Some((*base, least(base, n)?))).filter(|&(_, n)| n > 0).collect();
    if common.is_empty() {
        return None;
    }
    let mut rest = Sum { terms: Vec::new(), constant: BigRational::zero() };
    for ((c, _), powers) in sum.terms.iter().zip(&powers) {
        let left = powers.iter().map(|(base, n)| (*base, n - common.get(base).unwrap_or(&0)));
        let term = product(space, left);
        rest.terms.push((c.clone(), term));
    }
    let rest = rest.build(space);
    all(common.into_keys().chain([rest]))
}

/// a + b sqrt(u) = 0 as a^2 = b^2 u with a b <= 0, for b other than 0 and a root that occurs nowhere else and may be 0: there
/// the field has no derivative, and its curve ends or turns. Where b vanishes, the square would cross itself.
fn root(space: &mut Space, sum: &Sum) -> Option<Vec<Alternative>> {
    let is_open = |space: &Space, v: Value| match space.shape(v) {
        (Op::Sqrt, &[u]) => space.enclosure(u).lo() <= 0.0,
        _ => false,
    };
    let powers: Vec<BTreeMap<Value, i32>> = sum.terms.iter().map(|(_, term)| factors(space, *term)).collect();
    // One term has the root as a factor, once, and nothing else has a root of this kind.
    let mut found = None;
    for (index, powers) in powers.iter().enumerate() {
        for (&base, &n) in powers {
            if space.below(base, |_, _| false).iter().any(|&v| is_open(space, v)) {
                if found.is_some() || n != 1 || !is_open(space, base) {
                    return None;
                }
                found = Some((index, base));
            }
        }
    }
    let (index, base) = found?;
    let &[u] = space.shape(base).1 else { return None };
    if space.below(u, |_, _| false).iter().any(|&v| is_open(space, v)) {
        return None;
    }
    let mut rest = sum.clone();
    let (c, _) = rest.terms.remove(index);
    let a = rest.build(space);
    let b = product(space, powers[index].iter().map(|(&v, &n)| (v, if v == base { 0 } else { n })));
    let b = space.times(&c, b);
    if !space.never_zero(b) {
        return None;
    }
    let [a_squared, b_squared] = [a, b].map(|v| space.unary(Op::Sqr, v));
    let scaled = space.binary(Op::Mul, b_squared, u);
    let field = space.binary(Op::Sub, a_squared, scaled);
    let product = space.binary(Op::Mul, a, b);
    let opposite = space.unary(Op::Neg, product);
    Some(vec![Alternative { field, guards: vec![Guard::Sign(Sign::NonNegative, opposite)] }])
}
