//! Sums of multiples, products of powers, and the one form of a field among its multiples.

use std::collections::BTreeMap;

use num_bigint::BigInt;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::One;
use num_traits::Signed;
use num_traits::Zero;

use super::space::Space;
use crate::graph::Op;
use crate::graph::Value;

/// Whole coefficients longer than this are not exact in double precision: such sums stay as they are.
const MAX_BITS: u64 = 53;

/// `c0 + c1 t1 + c2 t2 + ...` with different terms, none of them a sum, a number or a multiple, and no coefficient 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Sum {
    pub terms: Vec<(BigRational, Value)>,
    pub constant: BigRational,
}

impl Sum {
    /// The value as a sum of multiples; one that is none is its own only term. Terms that cancel are gone, and with
    /// them what is known of where they are undefined.
    pub fn of(space: &Space, value: Value) -> Self {
        let mut open = BTreeMap::from([(value, BigRational::one())]);
        let mut terms = Vec::new();
        let mut constant = BigRational::zero();
        let add = |open: &mut BTreeMap<Value, BigRational>, v: Value, c: BigRational| {
            *open.entry(v).or_insert_with(BigRational::zero) += c;
        };
        // Operands have smaller indices than their users: each value comes with its coefficient complete.
        while let Some((value, c)) = open.pop_last() {
            if c.is_zero() {
                continue;
            }
            if let Some(number) = space.number(value) {
                constant += c * number;
                continue;
            }
            match space.shape(value) {
                (Op::Add, &[a, b]) => {
                    add(&mut open, a, c.clone());
                    add(&mut open, b, c);
                }
                (Op::Sub, &[a, b]) => {
                    add(&mut open, a, c.clone());
                    add(&mut open, b, -c);
                }
                (Op::Neg, &[a]) => add(&mut open, a, -c),
                (Op::Mul, &[a, b]) => match (space.number(a), space.number(b)) {
                    (Some(factor), _) => add(&mut open, b, c * factor),
                    (_, Some(factor)) => add(&mut open, a, c * factor),
                    _ => terms.push((c, value)),
                },
                _ => terms.push((c, value)),
            }
        }
        terms.sort_by(|(_, a), (_, b)| space.order(*a, *b));
        Self { terms, constant }
    }

    /// The sum as a value.
    pub fn build(&self, space: &mut Space) -> Value {
        let mut sum: Option<Value> = None;
        // What is added first: a difference takes one operation less than a sum with a negation.
        let (positive, negative): (Vec<_>, Vec<_>) = self.terms.iter().partition(|(c, _)| c.is_positive());
        for (c, term) in positive.into_iter().chain(negative) {
            sum = Some(match sum {
                None => space.times(c, *term),
                Some(sum) => {
                    let scaled = space.times(&c.abs(), *term);
                    space.binary(if c.is_positive() { Op::Add } else { Op::Sub }, sum, scaled)
                }
            });
        }
        match sum {
            None => space.constant(self.constant.clone()),
            Some(sum) if self.constant.is_zero() => sum,
            Some(sum) => space.plus(sum, &self.constant),
        }
    }

    /// All coefficients times a number.
    pub fn scaled(&self, factor: &BigRational) -> Self {
        let terms = self.terms.iter().map(|(c, t)| (c * factor, *t)).collect();
        Self { terms, constant: &self.constant * factor }
    }

    /// The positive number that makes all coefficients whole without a common divisor; `None` for 0 and for coefficients
    /// that are too long then.
    fn content(&self) -> Option<BigRational> {
        let numbers = || self.terms.iter().map(|(c, _)| c).chain([&self.constant]).filter(|c| !c.is_zero());
        let denominator = numbers().fold(BigInt::one(), |lcm, c| lcm.lcm(c.denom()));
        let numerator = numbers().fold(BigInt::zero(), |gcd, c| gcd.gcd(&(c.numer() * (&denominator / c.denom()))));
        if numerator.is_zero() {
            return None;
        }
        let factor = BigRational::new(denominator, numerator);
        numbers().all(|c| (c * &factor).numer().bits() <= MAX_BITS).then_some(factor)
    }

    /// Whether this is a single value with coefficient 1.
    fn is_plain(&self) -> bool {
        self.constant.is_zero() && matches!(&self.terms[..], [(c, _)] if c.is_one())
    }
}

/// The value among its positive multiples that has whole coefficients without a common divisor.
pub fn primitive(space: &mut Space, value: Value) -> Value {
    let sum = Sum::of(space, value);
    match sum.content() {
        Some(factor) if !sum.is_plain() => sum.scaled(&factor).build(space),
        _ => value,
    }
}

/// The value among its multiples that is primitive and has a positive leading coefficient: the one form of a zero set.
pub fn normal(space: &mut Space, value: Value) -> Value {
    let sum = Sum::of(space, value);
    let Some(factor) = sum.content() else { return value };
    let negative = sum.terms.first().is_some_and(|(c, _)| c.is_negative());
    match () {
        () if sum.is_plain() => value,
        () if negative => sum.scaled(&-factor).build(space),
        () => sum.scaled(&factor).build(space),
    }
}

/// A product of powers with whole exponents above 0 as its bases, none of them a product; the value itself if it is none.
pub fn factors(space: &Space, value: Value) -> BTreeMap<Value, i32> {
    bases(space, value).unwrap_or_else(|| BTreeMap::from([(value, 1)]))
}

/// The same; `None` if an exponent is too large.
fn bases(space: &Space, value: Value) -> Option<BTreeMap<Value, i32>> {
    let mut open: BTreeMap<Value, i64> = BTreeMap::from([(value, 1)]);
    let mut bases = BTreeMap::new();
    while let Some((value, n)) = open.pop_last() {
        let short = i32::try_from(n).ok()?;
        let power = match space.shape(value).0 {
            Op::Mul => n,
            Op::Sqr => 2 * n,
            Op::PowInt(m @ 1..) => i64::from(m) * n,
            _ => {
                bases.insert(value, short);
                continue;
            }
        };
        for &part in space.shape(value).1 {
            *open.entry(part).or_insert(0) += i64::from(i32::try_from(power).ok()?);
        }
    }
    Some(bases)
}

/// The product of powers; 1 for an empty one.
pub fn product(space: &mut Space, factors: impl IntoIterator<Item = (Value, i32)>) -> Value {
    let mut powers: Vec<(Value, i32)> = factors.into_iter().filter(|&(_, n)| n > 0).collect();
    powers.sort_by(|(a, _), (b, _)| space.order(*a, *b));
    let mut product = None;
    for (base, n) in powers {
        let power = if n == 1 { base } else { space.unary(Op::PowInt(n), base) };
        product = Some(match product {
            None => power,
            Some(product) => space.binary(Op::Mul, product, power),
        });
    }
    product.unwrap_or_else(|| space.int(1))
}
