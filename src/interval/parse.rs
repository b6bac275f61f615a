//! Intervals from text: the literals of IEEE 1788, clauses 9.7 and 12.11.
//!
//! | literal | set |
//! |---|---|
//! | `[1.5, 0x1.8p+1]`, `[-inf, 2/3]`, `[1,]`, `[,]` | from a lower to an upper bound; a missing one is infinite |
//! | `[1.5]` | a point |
//! | `[ ]`, `[empty]`, `[entire]` | no number, every number |
//! | `3.56?`, `3.56?2`, `3.56?2u`, `10??d`, `3.56?1e2` | a number and its uncertainty, in units of its last digit |
//! | `[nai]` | not an interval, for [`Decorated`] alone |
//!
//! A decoration may follow as in `[1, 2]_com`, again for [`Decorated`] alone. Letters are of either case. Bounds are
//! real numbers, exact as written; each is rounded outward once.

use super::{Decorated, Decoration, Interval, round};
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{Pow, Zero};
use std::fmt;
use std::str::FromStr;

/// Why a text is no interval literal.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LiteralError {
    position: usize,
    message: String,
}

impl LiteralError {
    /// The byte of the text where the mistake is.
    pub fn position(&self) -> usize {
        self.position
    }

    /// What is wrong, as one sentence without a full stop.
    pub fn message(&self) -> &str {
        &self.message
    }
}

impl fmt::Display for LiteralError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} at byte {}", self.message, self.position)
    }
}

impl std::error::Error for LiteralError {}

/// IEEE 1788 `textToInterval` for bare intervals: no decoration, no `[nai]`.
impl FromStr for Interval {
    type Err = LiteralError;

    fn from_str(text: &str) -> Result<Self, LiteralError> {
        let mut reader = Reader { text, at: 0 };
        let literal = reader.literal()?;
        let Literal::Set { interval, .. } = literal else {
            return Err(reader.error_at(0, "[nai] is a decorated interval only"));
        };
        if reader.peek() == Some('_') {
            return Err(reader.error("a bare interval has no decoration"));
        }
        reader.end()?;
        Ok(interval)
    }
}

/// IEEE 1788 `textToInterval` for decorated intervals. Without a suffix the decoration is the greatest that the set
/// allows, as of [`Decorated::new`]; a suffix that the set does not allow is an error.
impl FromStr for Decorated {
    type Err = LiteralError;

    fn from_str(text: &str) -> Result<Self, LiteralError> {
        let mut reader = Reader { text, at: 0 };
        let literal = reader.literal()?;
        let suffix = reader.at;
        let decoration = reader.decoration()?;
        reader.end()?;
        let Literal::Set { interval, bounded } = literal else {
            return match decoration {
                None => Ok(Self::ILL),
                Some(_) => Err(reader.error_at(suffix, "[nai] has no other decoration")),
            };
        };
        match decoration {
            Some(Decoration::Ill) => Err(reader.error_at(suffix, "only [nai] is ill")),
            Some(d) if d > Decoration::Trv && interval.is_empty() => {
                Err(reader.error_at(suffix, "the empty set has the decoration trv only"))
            }
            // A bounded set as written: if only its rounded bounds are infinite, com becomes dac below.
            Some(Decoration::Com) if !bounded => Err(reader.error_at(suffix, "an unbounded set is not com")),
            decoration => Ok(Self::with(interval, decoration.unwrap_or(Decoration::Com))),
        }
    }
}

/// A literal without its decoration.
enum Literal {
    NotAnInterval,
    Set { interval: Interval, bounded: bool },
}

/// One end of a literal.
enum Bound {
    /// Minus or plus infinity.
    Infinite {
        negative: bool,
    },
    Finite(BigRational),
}

/// Numbers of this many decimal digits before or after the point are beyond every `f64`, and are not written out.
const DIGITS: i64 = 2000;
/// The same for binary digits.
const BITS: i64 = 7000;

struct Reader<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Reader<'a> {
    fn error_at(&self, position: usize, message: impl Into<String>) -> LiteralError {
        LiteralError { position, message: message.into() }
    }

    fn error(&self, message: impl Into<String>) -> LiteralError {
        self.error_at(self.at, message)
    }

    fn peek(&self) -> Option<char> {
        self.text[self.at..].chars().next()
    }

    /// The longest text from here whose characters all satisfy the predicate.
    fn take(&mut self, of: impl Fn(char) -> bool) -> &'a str {
        let rest = &self.text[self.at..];
        let length = rest.find(|c| !of(c)).unwrap_or(rest.len());
        self.at += length;
        &rest[..length]
    }

    fn space(&mut self) {
        self.take(char::is_whitespace);
    }

    /// Takes `c`, in either case, if it comes next.
    fn accept(&mut self, c: char) -> bool {
        let found = self.peek().is_some_and(|next| next.eq_ignore_ascii_case(&c));
        if found {
            self.at += 1;
        }
        found
    }

    fn expect(&mut self, c: char) -> Result<(), LiteralError> {
        if self.accept(c) {
            return Ok(());
        }
        let found = self.peek().map_or("the end".to_owned(), |c| format!("`{c}`"));
        Err(self.error(format!("expected `{c}`, found {found}")))
    }

    fn end(&mut self) -> Result<(), LiteralError> {
        self.space();
        if self.at == self.text.len() { Ok(()) } else { Err(self.error("the interval ends before this")) }
    }

    /// A sign: whether it is negative.
    fn sign(&mut self) -> Option<bool> {
        if self.accept('-') {
            Some(true)
        } else if self.accept('+') {
            Some(false)
        } else {
            None
        }
    }

    fn literal(&mut self) -> Result<Literal, LiteralError> {
        self.space();
        if self.peek() == Some('[') { self.bracket() } else { self.uncertain() }
    }

    fn bracket(&mut self) -> Result<Literal, LiteralError> {
        self.expect('[')?;
        self.space();
        let start = self.at;
        let word = self.take(|c| c.is_ascii_alphabetic());
        let named = match word.to_ascii_lowercase().as_str() {
            "empty" => Some(Literal::Set { interval: Interval::EMPTY, bounded: true }),
            "entire" => Some(Literal::Set { interval: Interval::ENTIRE, bounded: false }),
            "nai" => Some(Literal::NotAnInterval),
            "" if self.peek() == Some(']') => Some(Literal::Set { interval: Interval::EMPTY, bounded: true }),
            _ => None,
        };
        if let Some(literal) = named {
            self.space();
            self.expect(']')?;
            return Ok(literal);
        }
        self.at = start;
        let lo = if self.peek() == Some(',') { Bound::Infinite { negative: true } } else { self.number()? };
        self.space();
        if self.accept(']') {
            let Bound::Finite(x) = lo else { return Err(self.error_at(start, "a point is a finite number")) };
            return Ok(Literal::Set { interval: Interval::from_rational(&x), bounded: true });
        }
        self.expect(',')?;
        self.space();
        let second = self.at;
        let hi = if self.peek() == Some(']') { Bound::Infinite { negative: false } } else { self.number()? };
        self.space();
        self.expect(']')?;
        let bounded = matches!((&lo, &hi), (Bound::Finite(_), Bound::Finite(_)));
        let (below, above) = match (lo, hi) {
            (Bound::Infinite { negative: false }, _) => {
                return Err(self.error_at(start, "plus infinity is no lower bound"));
            }
            (_, Bound::Infinite { negative: true }) => {
                return Err(self.error_at(second, "minus infinity is no upper bound"));
            }
            (Bound::Finite(lo), Bound::Finite(hi)) if lo > hi => {
                return Err(self.error_at(second, "the upper bound is less than the lower one"));
            }
            (lo, hi) => (lo.round(round::rational_down), hi.round(round::rational_up)),
        };
        Ok(Literal::Set { interval: Interval::raw(below, above), bounded })
    }

    fn number(&mut self) -> Result<Bound, LiteralError> {
        let start = self.at;
        let negative = self.sign().unwrap_or(false);
        if self.peek().is_some_and(|c| c.is_ascii_alphabetic()) {
            let word = self.take(|c| c.is_ascii_alphabetic());
            return match word.to_ascii_lowercase().as_str() {
                "inf" | "infinity" => Ok(Bound::Infinite { negative }),
                _ => Err(self.error_at(start, format!("`{word}` is no number"))),
            };
        }
        let hexadecimal = self.text.as_bytes()[self.at..].get(..2).is_some_and(|x| x.eq_ignore_ascii_case(b"0x"));
        let size = if hexadecimal { self.hexadecimal()? } else { self.decimal_or_fraction()? };
        Ok(Bound::Finite(if negative { -size } else { size }))
    }

    /// Digits with at most one point among them: their value without the point, and how many come after it.
    fn digits(&mut self, radix: u32) -> Result<(BigInt, i64), LiteralError> {
        let start = self.at;
        let whole = self.take(|c| c.is_digit(radix));
        let fraction = if self.accept('.') { self.take(|c| c.is_digit(radix)) } else { "" };
        let value = BigInt::parse_bytes(format!("{whole}{fraction}").as_bytes(), radix);
        let value = value.ok_or_else(|| self.error_at(start, "expected a number"))?;
        Ok((value, fraction.len() as i64))
    }

    /// A whole number with a sign, as exponents are; far out it stays far out.
    fn exponent(&mut self) -> Result<i64, LiteralError> {
        let negative = self.sign().unwrap_or(false);
        let digits = self.take(|c| c.is_ascii_digit());
        if digits.is_empty() {
            return Err(self.error("expected the digits of an exponent"));
        }
        let size = digits.parse().unwrap_or(i64::MAX / 4).min(i64::MAX / 4);
        Ok(if negative { -size } else { size })
    }

    fn hexadecimal(&mut self) -> Result<BigRational, LiteralError> {
        self.at += 2;
        let (value, places) = self.digits(16)?;
        if !self.accept('p') {
            return Err(self.error("a hexadecimal number needs an exponent such as p+1"));
        }
        let exponent = self.exponent()?;
        Ok(scaled(value, 2, exponent - 4 * places, BITS))
    }

    fn decimal_or_fraction(&mut self) -> Result<BigRational, LiteralError> {
        let start = self.at;
        let (value, places) = self.digits(10)?;
        if self.accept('/') {
            let divisor_at = self.at;
            if self.text[start..self.at].contains('.') {
                return Err(self.error_at(start, "a fraction has whole numbers above and below"));
            }
            let divisor = self.take(|c| c.is_ascii_digit());
            let divisor = BigInt::parse_bytes(divisor.as_bytes(), 10).filter(|d| !d.is_zero());
            let divisor = divisor.ok_or_else(|| self.error_at(divisor_at, "expected a whole number above 0"))?;
            return Ok(BigRational::new_raw(value, divisor));
        }
        let exponent = if self.accept('e') { self.exponent()? } else { 0 };
        Ok(scaled(value, 10, exponent - places, DIGITS))
    }

    /// `3.56?2ue1`: a number, its radius in units of the last digit (half of one if none is written, no limit if it
    /// is another `?`), whether it extends up or down only, and a power of ten.
    fn uncertain(&mut self) -> Result<Literal, LiteralError> {
        let start = self.at;
        let negative = self.sign().unwrap_or(false);
        let (size, places) = match self.peek() {
            Some(c) if c.is_ascii_digit() || c == '.' => self.digits(10)?,
            _ => return Err(self.error_at(start, "an interval starts with `[` or is a number such as 3.56?1")),
        };
        let value = if negative { -size } else { size };
        if !self.accept('?') {
            return Err(self.error("a number outside brackets needs an uncertainty, as in 3.56?1"));
        }
        let unlimited = self.accept('?');
        let radius = if unlimited { "" } else { self.take(|c| c.is_ascii_digit()) };
        let (up, down) = if self.accept('u') { (true, false) } else { (true, true) };
        let (up, down) = if down && self.accept('d') { (false, true) } else { (up, down) };
        let exponent = if self.accept('e') { self.exponent()? } else { 0 } - places;
        // Tenths of a unit hold the radius of one half exactly.
        let tenths = BigInt::parse_bytes(radius.as_bytes(), 10).map_or(BigInt::from(5), |r| r * 10);
        let moved = |direction: i32| scaled(&value * 10 + &tenths * direction, 10, exponent - 1, DIGITS);
        let end = |moves: bool, direction: i32| match (moves, unlimited) {
            (false, _) => Bound::Finite(moved(0)),
            (true, false) => Bound::Finite(moved(direction)),
            (true, true) => Bound::Infinite { negative: direction < 0 },
        };
        let (lo, hi) = (end(down, -1).round(round::rational_down), end(up, 1).round(round::rational_up));
        Ok(Literal::Set { interval: Interval::raw(lo, hi), bounded: !unlimited })
    }

    fn decoration(&mut self) -> Result<Option<Decoration>, LiteralError> {
        if !self.accept('_') {
            return Ok(None);
        }
        let start = self.at;
        match self.take(|c| c.is_ascii_alphanumeric()).to_ascii_lowercase().as_str() {
            "com" => Ok(Some(Decoration::Com)),
            "dac" => Ok(Some(Decoration::Dac)),
            "def" => Ok(Some(Decoration::Def)),
            "trv" => Ok(Some(Decoration::Trv)),
            "ill" => Ok(Some(Decoration::Ill)),
            _ => Err(self.error_at(start, "expected a decoration: com, dac, def or trv")),
        }
    }
}

impl Bound {
    fn round(self, finite: fn(&BigRational) -> f64) -> f64 {
        match self {
            Self::Infinite { negative: true } => f64::NEG_INFINITY,
            Self::Infinite { negative: false } => f64::INFINITY,
            Self::Finite(x) => finite(&x),
        }
    }
}

/// `value * base^exponent`. Numbers of more than `limit` digits before the point, or zeros after it, all become one
/// number a little farther out: their order among `f64`s and among the others stays, and no exponent fills the memory.
fn scaled(value: BigInt, base: u32, exponent: i64, limit: i64) -> BigRational {
    if value.is_zero() {
        return BigRational::zero();
    }
    // log10(2) = 0.3010299957: the length of the number in digits, within 2 for any text that fits into memory.
    let bits = value.bits() as i64;
    let length = if base == 2 { bits } else { (i128::from(bits) * 30103 / 100_000) as i64 };
    let power = |e: i64| BigInt::from(base).pow(e.unsigned_abs() as u32);
    let beyond = limit + 10;
    let unit = BigInt::from(if value < BigInt::zero() { -1 } else { 1 });
    // Nothing is reduced to lowest terms: that would cost the square of the length.
    match exponent.saturating_add(length) {
        e if e > limit => BigRational::from(unit * power(beyond)),
        e if e < -limit => BigRational::new_raw(unit, power(beyond)),
        _ if exponent >= 0 => BigRational::from(value * power(exponent)),
        _ => BigRational::new_raw(value, power(exponent)),
    }
}
