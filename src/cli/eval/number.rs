//! Decimal numbers to their tightest enclosures without arbitrary precision, for the stream of requests.

use crate::interval::Interval;

/// Powers of ten up to this exponent are exact in `f64`, and times a significand they fit 128 bits.
const MAX_PLACES: u32 = 22;

/// The tightest enclosure of a number written as digits with at most one point; `None` for all other texts, and for
/// those with too many digits.
pub fn decimal(text: &str) -> Option<Interval> {
    let digits = text.strip_prefix('-').unwrap_or(text);
    let mut number: u64 = 0;
    let mut places = None;
    for byte in digits.bytes() {
        match (byte, places) {
            (b'0'..=b'9', _) => {
                number = number.checked_mul(10)?.checked_add(u64::from(byte - b'0'))?;
                places = places.map(|places| places + 1);
            }
            (b'.', None) => places = Some(0),
            _ => return None,
        }
    }
    // A point needs a digit beside it; the grammar says what else is wrong with other texts.
    let places = places.unwrap_or(0);
    if digits.len() < 1 + usize::from(digits.contains('.')) || places > MAX_PLACES {
        return None;
    }
    let value = enclose(number, places)?;
    Some(if digits.len() < text.len() { -value } else { value })
}

/// The tightest enclosure of `number` / 10^`places`.
fn enclose(number: u64, places: u32) -> Option<Interval> {
    if number < 1 << 53 {
        // Both operands are exact, and the quotient is the tightest.
        return Some(Interval::point(number as f64) / Interval::point(10f64.powi(places as i32)));
    }
    let near = number as f64 / 10f64.powi(places as i32);
    // Both roundings together are off by less than two units in the last place, so the truth lies between neighbours
    // of `near`; where exactly, integers tell: near = significand 2^exponent.
    let bits = near.to_bits();
    let (significand, exponent) = ((bits & ((1 << 52) - 1)) | 1 << 52, (bits >> 52) as i32 - 1075);
    let candidate = |step: i64| (near.next(step), u64::try_from(significand as i64 + step).ok());
    // Below 2^52 the last place is a fraction, and then number 2^-exponent stays below 2^64 2^75.
    if !(-60..0).contains(&exponent) || significand <= (1 << 52) + 2 || significand >= (1 << 53) - 2 {
        return None;
    }
    let scaled = u128::from(number).checked_mul(1 << -exponent)?;
    let unit = 10u128.pow(places);
    let compare = |significand: u64| u128::from(significand).checked_mul(unit).map(|value| value.cmp(&scaled));
    let mut lo = None;
    let mut hi = None;
    for step in -2..=2 {
        let (value, significand) = candidate(step);
        let order = compare(significand?)?;
        if order.is_le() {
            lo = Some(value);
        }
        if order.is_ge() && hi.is_none() {
            hi = Some(value);
        }
    }
    Interval::new(lo?, hi?)
}

/// Steps to a neighbour of a positive number.
trait Neighbour {
    fn next(self, steps: i64) -> Self;
}

impl Neighbour for f64 {
    fn next(self, steps: i64) -> f64 {
        f64::from_bits(self.to_bits().wrapping_add_signed(steps))
    }
}

#[cfg(test)]
mod tests {
    use num_bigint::BigInt;
    use num_rational::BigRational;

    use super::*;

    #[test]
    fn enclosures_are_the_tightest() {
        let mut random = fastrand::Rng::with_seed(7);
        let mut answered = 0;
        for _ in 0..20_000 {
            let number = random.u64(..) >> random.u32(0..64);
            let places = random.u32(0..=MAX_PLACES);
            let ten = BigInt::from(10);
            let exact = BigRational::new(number.into(), ten.pow(places));
            if let Some(value) = enclose(number, places) {
                answered += 1;
                assert_eq!(value, Interval::from_rational(&exact), "{number}e-{places}");
            }
        }
        assert!(answered > 15_000, "{answered}");
    }

    #[test]
    fn texts() {
        let tenth = Interval::new(0.1f64.next_down(), 0.1).unwrap();
        assert_eq!(decimal("0.1"), Some(tenth));
        assert_eq!(decimal("-0.1"), Some(-tenth));
        assert_eq!(decimal("-2"), Some(Interval::point(-2.0)));
        assert_eq!(decimal(".5"), Some(Interval::point(0.5)));
        let sixth = BigRational::new(16_666_666_666_666_666u64.into(), 100_000_000_000_000_000u64.into());
        assert_eq!(decimal("0.16666666666666666"), Some(Interval::from_rational(&sixth)));
        for other in ["", "-", ".", "1e5", "pi", "--1", "1.2.3", "0x10", " 1", "99999999999999999999", "inf"] {
            assert_eq!(decimal(other), None, "{other}");
        }
    }
}
