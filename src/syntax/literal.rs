//! Numbers as written, as the exact rationals that they name.

use num_bigint::{BigInt, BigUint};
use num_rational::BigRational;
use num_traits::One;

/// The largest power of ten in a literal, and the largest number of digits. Far past every f64, and small enough
/// that exact arithmetic on such constants stays cheap.
pub const MAX_DECIMAL: u32 = 2_000;

/// The largest power of two in a hexadecimal literal.
pub const MAX_BINARY: u32 = 8_000;

/// The literal is readable, but its digits or its exponent are beyond what exact arithmetic should carry.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TooLarge;

/// The value of a [`Token::Number`](crate::syntax::token::Token::Number): decimal, or hexadecimal with `p`.
pub fn number(text: &str) -> Result<BigRational, TooLarge> {
    if text.len() > 1 && matches!(text.as_bytes()[1], b'x' | b'X') {
        return hexadecimal(&text[2..]);
    }
    if text.len() <= 18 && text.bytes().all(|b| b.is_ascii_digit()) {
        let value = text.bytes().fold(0u64, |v, b| 10 * v + u64::from(b - b'0'));
        return Ok(BigRational::from_integer(value.into()));
    }
    let (mantissa, exponent) = split(text, &['e', 'E'], MAX_DECIMAL)?;
    let (digits, fraction) = digits(mantissa, 10)?;
    let exponent = exponent - fraction;
    let power = BigUint::from(10u32).pow(exponent.unsigned_abs());
    Ok(scaled(digits, power, exponent))
}

fn hexadecimal(text: &str) -> Result<BigRational, TooLarge> {
    let (mantissa, exponent) = split(text, &['p', 'P'], MAX_BINARY)?;
    let (digits, fraction) = digits(mantissa, 16)?;
    let exponent = exponent - 4 * fraction;
    let power = BigUint::one() << exponent.unsigned_abs();
    Ok(scaled(digits, power, exponent))
}

/// `digits * power` or `digits / power`, by the sign of `exponent`.
fn scaled(digits: BigUint, power: BigUint, exponent: i32) -> BigRational {
    if exponent >= 0 {
        BigRational::from_integer(BigInt::from(digits * power))
    } else {
        BigRational::new(BigInt::from(digits), BigInt::from(power))
    }
}

/// Mantissa and exponent; the exponent is refused past `limit` before anything of its size is built.
fn split<'t>(text: &'t str, marks: &[char], limit: u32) -> Result<(&'t str, i32), TooLarge> {
    let Some((mantissa, exponent)) = text.split_once(marks) else { return Ok((text, 0)) };
    let (negative, magnitude) = match exponent.as_bytes().first() {
        Some(b'-') => (true, &exponent[1..]),
        Some(b'+') => (false, &exponent[1..]),
        _ => (false, exponent),
    };
    let magnitude = magnitude.trim_start_matches('0');
    // The lexer lets only digits through, so the one way to fail is size; all zeros leave nothing.
    let value = if magnitude.is_empty() { 0 } else { magnitude.parse::<u32>().map_err(|_| TooLarge)? };
    if value > limit {
        return Err(TooLarge);
    }
    Ok((mantissa, if negative { -(value as i32) } else { value as i32 }))
}

/// All digits as one integer, and how many of them stand behind the point.
fn digits(mantissa: &str, radix: u32) -> Result<(BigUint, i32), TooLarge> {
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    if whole.len() + fraction.len() > MAX_DECIMAL as usize {
        return Err(TooLarge);
    }
    let joined: Vec<u8> = whole.bytes().chain(fraction.bytes()).collect();
    let value = BigUint::parse_bytes(&joined, radix).ok_or(TooLarge)?;
    Ok((value, fraction.len() as i32))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ratio(text: &str) -> String {
        number(text).map_or("too large".into(), |r| r.to_string())
    }

    #[test]
    fn literals_are_exact() {
        for (text, want) in [
            ("2", "2"),
            ("007", "7"),
            ("0.1", "1/10"),
            (".5", "1/2"),
            ("2.", "2"),
            ("2e3", "2000"),
            ("2.5E-3", "1/400"),
            ("1e+0000000000002", "100"),
            ("0e-5", "0"),
            ("123456789012345678901234567890", "123456789012345678901234567890"),
            ("0x1.8p+1", "3"),
            ("0x.8p0", "1/2"),
            ("0x1p-3", "1/8"),
            ("0xA.8P-1", "21/4"),
        ] {
            assert_eq!(ratio(text), want, "{text}");
        }
    }

    #[test]
    fn size_is_bounded() {
        for text in ["1e1000000000", "1e-1000000000", "1e99999999999999999999", "0x1p1000000", "1e2001"] {
            assert_eq!(number(text), Err(TooLarge), "{text}");
        }
        assert_eq!(number(&"9".repeat(5000)), Err(TooLarge));
        assert!(number("1e2000").is_ok() && number("0x1p-1074").is_ok());
    }
}
