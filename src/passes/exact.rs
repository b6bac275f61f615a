//! Operations on exact rationals, where the result is rational too and not too long.

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::One;
use num_traits::Pow;
use num_traits::Signed;
use num_traits::ToPrimitive;
use num_traits::Zero;

use crate::graph::Op;

/// The most bits that numerator and denominator of a folded number have together. Beyond, the operation stays in the graph
/// as the user wrote it: nothing is lost but the folding, and no input makes the compiler run out of memory.
pub const MAX_BITS: u64 = 4096;

/// The value of an operation at rational operands, if it is a rational number of at most [`MAX_BITS`] bits. `None` says
/// nothing else: the value may be irrational, too long, not defined (`1/0`), or not a function (`Entire`).
///
/// Of the elementary functions only those arguments are listed at which the value is rational by the definition; by the
/// theorem of Lindemann and Weierstrass `exp`, `ln`, the trigonometric and the hyperbolic functions have no other ones.
pub fn exact(op: Op, operands: &[&BigRational]) -> Option<BigRational> {
    let x = operands.first().copied();
    let y = operands.get(1).copied();
    let zero = BigRational::zero;
    let one = BigRational::one;
    let when = |condition: bool, value: BigRational| condition.then_some(value);
    let truth = |condition: bool| Some(if condition { one() } else { zero() });
    if let (Some(x), Some(y)) = (x, y)
        && worst_bits(op, x, y) > MAX_BITS
    {
        return None;
    }
    let value = match op {
        Op::Const(_) | Op::Var(_) | Op::Pi | Op::Entire | Op::Kink | Op::SelectJump => None,
        Op::PowInt(n) => power(x?, n.into()),
        Op::PowRatio(p, q) => power(&root(x?, q)?, p.into()),
        Op::Neg => Some(-x?),
        Op::Sqr => Some(x? * x?),
        Op::Sqrt => root(x?, 2),
        Op::Cbrt => root(x?, 3),
        Op::Abs => Some(x?.abs()),
        Op::Sign => Some(x?.signum()),
        Op::Floor => Some(x?.floor()),
        Op::Ceil => Some(x?.ceil()),
        Op::Round => Some(x?.round()),
        Op::Exp | Op::Cosh | Op::Cos => when(x?.is_zero(), one()),
        Op::Exp2 => when(x?.is_integer(), BigRational::from_integer(2.into()))
            .and_then(|base| power(&base, x?.to_integer().to_i64()?)),
        Op::Exp10 => when(x?.is_integer(), BigRational::from_integer(10.into()))
            .and_then(|base| power(&base, x?.to_integer().to_i64()?)),
        Op::Expm1 | Op::Log1p | Op::Sin | Op::Tan | Op::Asin | Op::Atan => when(x?.is_zero(), zero()),
        Op::Sinh | Op::Tanh | Op::Asinh | Op::Atanh => when(x?.is_zero(), zero()),
        Op::Ln | Op::Acos | Op::Acosh => when(x?.is_one(), zero()),
        Op::Log2 => logarithm(x?, 2),
        Op::Log10 => logarithm(x?, 10),
        Op::Add => Some(x? + y?),
        Op::Sub => Some(x? - y?),
        Op::Mul => Some(x? * y?),
        Op::Div => (!y?.is_zero()).then(|| x.zip(y).map(|(x, y)| x / y))?,
        Op::Min => Some(x?.min(y?).clone()),
        Op::Max => Some(x?.max(y?).clone()),
        Op::Mod => (!y?.is_zero()).then(|| x.zip(y).map(|(x, y)| x - y * (x / y).floor()))?,
        Op::Hypot => root(&(x? * x? + y? * y?), 2),
        Op::Pow => real_power(x?, y?),
        Op::Atan2 => when(x?.is_zero() && y?.is_positive(), zero()),
        Op::Less => truth(x? < y?),
        Op::LessEqual => truth(x? <= y?),
        Op::Equal => truth(x? == y?),
        Op::Select if x?.is_one() => y.cloned(),
        Op::Select if x?.is_zero() => operands.get(2).map(|z| (*z).clone()),
        Op::Select => None,
    }?;
    (bits(&value) <= MAX_BITS).then_some(value)
}

/// How long the result of an arithmetic operation is where nothing cancels: looked at first, because a common denominator
/// takes the square of its length to find, and a sum that is too long in the end would be tried again by every pass.
fn worst_bits(op: Op, x: &BigRational, y: &BigRational) -> u64 {
    let [xn, xd, yn, yd] = [x.numer(), x.denom(), y.numer(), y.denom()].map(BigInt::bits);
    match op {
        Op::Add | Op::Sub | Op::Mod => xd + yd + (xn + yd).max(yn + xd),
        Op::Mul | Op::Div => xn + xd + yn + yd,
        _ => 0,
    }
}

fn bits(x: &BigRational) -> u64 {
    x.numer().bits() + x.denom().bits()
}

/// `x^n`, with `0^0 = 1`; no value for a pole or a result that is too long.
fn power(x: &BigRational, n: i64) -> Option<BigRational> {
    if x.is_zero() {
        return match n {
            0 => Some(BigRational::one()),
            1.. => Some(BigRational::zero()),
            _ => None,
        };
    }
    if x.abs().is_one() {
        return Some(if n % 2 == 0 { BigRational::one() } else { x.clone() });
    }
    // A power has about n times as many bits: at least n - 1 even if x is 2 or 1/2, so that this also bounds the loop.
    let exponent = u32::try_from(n.unsigned_abs()).ok().filter(|&e| u64::from(e) <= MAX_BITS)?;
    if (bits(x) - 1).saturating_mul(exponent.into()) > 2 * MAX_BITS {
        return None;
    }
    let result = BigRational::new(x.numer().pow(exponent), x.denom().pow(exponent));
    Some(if n < 0 { result.recip() } else { result })
}

/// The real q-th root where it is rational; of a negative number only for odd q.
fn root(x: &BigRational, q: u32) -> Option<BigRational> {
    if x.is_negative() && q.is_multiple_of(2) {
        return None;
    }
    // A root of at least 2 in absolute value has q times fewer bits than the number, so the power back is no longer than x.
    let integer_root = |n: &BigInt| {
        let root = n.nth_root(q);
        (Pow::pow(&root, q) == *n).then_some(root)
    };
    Some(BigRational::new(integer_root(x.numer())?, integer_root(x.denom())?))
}

/// `x^y` on the domain of IEEE 1788 `pow`.
fn real_power(x: &BigRational, y: &BigRational) -> Option<BigRational> {
    if x.is_zero() {
        return y.is_positive().then(BigRational::zero);
    }
    if x.is_negative() {
        return None;
    }
    power(&root(x, y.denom().to_u32()?)?, y.numer().to_i64()?)
}

/// The k with `base^k = x`.
fn logarithm(x: &BigRational, base: u32) -> Option<BigRational> {
    if !x.is_positive() || bits(x) > MAX_BITS {
        return None;
    }
    let (mut n, sign) = if x.is_integer() {
        (x.numer().clone(), 1)
    } else if x.numer().is_one() {
        (x.denom().clone(), -1)
    } else {
        return None;
    };
    let mut k = 0;
    while (&n % base).is_zero() {
        n /= base;
        k += 1;
    }
    n.is_one().then(|| BigRational::from_integer((sign * k).into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fold(op: Op, operands: &[&str]) -> Option<String> {
        let operands: Vec<BigRational> = operands.iter().map(|text| text.parse().unwrap()).collect();
        exact(op, &operands.iter().collect::<Vec<_>>()).map(|value| value.to_string())
    }

    #[test]
    fn values_are_exact_or_absent() {
        let rows: &[(Op, &[&str], Option<&str>)] = &[
            (Op::Add, &["1/10", "2/10"], Some("3/10")),
            (Op::Div, &["1", "-3"], Some("-1/3")),
            (Op::Div, &["1", "0"], None),
            (Op::Sqrt, &["9/4"], Some("3/2")),
            (Op::Sqrt, &["2"], None),
            (Op::Sqrt, &["-1"], None),
            (Op::Cbrt, &["-8/27"], Some("-2/3")),
            (Op::PowInt(-3), &["-2"], Some("-1/8")),
            (Op::PowInt(0), &["0"], Some("1")),
            (Op::PowInt(-1), &["0"], None),
            (Op::PowInt(i32::MIN), &["-1"], Some("1")),
            (Op::PowInt(i32::MAX), &["3/2"], None),
            (Op::PowRatio(-2, 3), &["-8"], Some("1/4")),
            (Op::PowRatio(1, 2), &["-4"], None),
            (Op::PowRatio(1, u32::MAX), &["1"], Some("1")),
            (Op::PowRatio(-1, 2), &["0"], None),
            (Op::Pow, &["0", "1/2"], Some("0")),
            (Op::Pow, &["0", "0"], None),
            (Op::Pow, &["4/9", "-3/2"], Some("27/8")),
            (Op::Pow, &["-8", "1/3"], None),
            (Op::Floor, &["-1/2"], Some("-1")),
            (Op::Ceil, &["-1/2"], Some("0")),
            (Op::Round, &["-1/2"], Some("-1")),
            (Op::Round, &["5/2"], Some("3")),
            (Op::Mod, &["-7", "3"], Some("2")),
            (Op::Mod, &["7", "-3"], Some("-2")),
            (Op::Mod, &["7", "0"], None),
            (Op::Hypot, &["3", "-4"], Some("5")),
            (Op::Hypot, &["1", "1"], None),
            (Op::Log2, &["1/8"], Some("-3")),
            (Op::Log10, &["1000"], Some("3")),
            (Op::Log10, &["20"], None),
            (Op::Log2, &["0"], None),
            (Op::Exp10, &["-2"], Some("1/100")),
            (Op::Exp2, &["1/2"], None),
            (Op::Exp2, &["99999999999999999999"], None),
            (Op::Ln, &["1"], Some("0")),
            (Op::Atan2, &["0", "2"], Some("0")),
            (Op::Atan2, &["0", "-2"], None),
            (Op::Less, &["1/3", "1/3"], Some("0")),
            (Op::LessEqual, &["1/3", "1/3"], Some("1")),
            (Op::Select, &["0", "5", "7"], Some("7")),
            (Op::SelectJump, &["0", "5", "7"], None),
        ];
        for (op, operands, expected) in rows {
            assert_eq!(fold(*op, operands).as_deref(), *expected, "{op:?} {operands:?}");
        }
    }

    #[test]
    fn long_numbers_are_left_alone() {
        assert!(fold(Op::PowInt(4000), &["2"]).is_some());
        assert!(fold(Op::PowInt(4095), &["3"]).is_none());
        let long = exact(Op::PowInt(4000), &[&BigRational::from_integer(2.into())]).unwrap();
        assert!(exact(Op::Mul, &[&long, &long]).is_none());
    }
}
