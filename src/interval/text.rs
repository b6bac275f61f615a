//! Intervals as text: for people as shortest decimals, each of which `f64` reads as the bound; exactly, as hexadecimal
//! numbers; and as decimals of a given length that are rounded outward.

use super::{Decorated, Interval};
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::Pow;
use std::fmt;

/// The shortest decimal string that `str::parse::<f64>` reads back as `x`; `inf`, `-inf` and `NaN` by name.
pub fn decimal(x: f64) -> String {
    // Rust's Debug form is shortest and takes an exponent where zeros would pile up; a whole number gets a ".0".
    let text = format!("{x:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// `[lo, hi]`, `[empty]` or `[entire]`.
impl fmt::Display for Interval {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        if self.is_empty() {
            f.pad("[empty]")
        } else if self.is_entire() {
            f.pad("[entire]")
        } else {
            f.pad(&format!("[{}, {}]", decimal(self.lo), decimal(self.hi)))
        }
    }
}

impl Interval {
    /// IEEE 1788 `intervalToExact`: a literal with hexadecimal bounds, which reads back as the same set. (A decimal
    /// literal is a real number, and its enclosure may be wider than the `f64` that it was written for.)
    pub fn exact_text(self) -> String {
        if self.is_empty() {
            return "[empty]".to_owned();
        }
        format!("[{}, {}]", hexadecimal(self.lo), hexadecimal(self.hi))
    }

    /// IEEE 1788 `intervalToText`: a literal with bounds of at least one and at most `digits` decimal digits, rounded
    /// outward, so that it encloses this set.
    pub fn outward_text(self, digits: usize) -> String {
        if self.is_empty() || self.is_entire() {
            return self.to_string();
        }
        // Mirrored, a lower bound is an upper one.
        let upper = |x: f64| above(x, digits.max(1));
        let lower = upper(-self.lo);
        let lower = lower.strip_prefix('-').map_or_else(|| format!("-{lower}"), str::to_owned);
        format!("[{}, {}]", if self.lo == 0.0 { "0" } else { &lower }, upper(self.hi))
    }
}

impl Decorated {
    /// [`Interval::exact_text`] with the decoration.
    pub fn exact_text(self) -> String {
        if self.is_nai() { self.to_string() } else { format!("{}_{}", self.interval().exact_text(), self.decoration()) }
    }
}

/// `x` as a hexadecimal number with a binary exponent.
fn hexadecimal(x: f64) -> String {
    let sign = if x < 0.0 { "-" } else { "" };
    if x.is_infinite() || x == 0.0 {
        return format!("{sign}{}", decimal(x.abs()));
    }
    let field = x.to_bits() >> 52 & 0x7ff;
    let (whole, exponent) = if field == 0 { (0, -1022) } else { (1, field as i64 - 1023) };
    let fraction = format!("{:013x}", x.to_bits() & ((1 << 52) - 1));
    let fraction = fraction.trim_end_matches('0');
    let point = if fraction.is_empty() { "" } else { "." };
    format!("{sign}0x{whole}{point}{fraction}p{exponent:+}")
}

/// A decimal number of so many digits that is not below `x`, and less than a unit of its last digit above.
fn above(x: f64, digits: usize) -> String {
    if x.is_infinite() || x == 0.0 {
        return decimal(x);
    }
    // The nearest such decimal, exactly converted, may lie one unit of its last digit below.
    let nearest = format!("{x:.*e}", digits - 1);
    let (significand, exponent) = nearest.split_once('e').unwrap_or((&nearest, "0"));
    let mut units: BigInt = significand.replace('.', "").parse().unwrap_or_default();
    let mut unit = exponent.parse::<i32>().unwrap_or_default() - (digits as i32 - 1);
    let value = BigRational::from(units.clone()) * BigRational::from(BigInt::from(10)).pow(unit);
    if BigRational::from_float(x).is_some_and(|x| value < x) {
        if units == -BigInt::from(10).pow(digits as u32 - 1) {
            // From -100 the way is to -99.9.
            (units, unit) = (units * 10, unit - 1);
        }
        units += 1;
    }
    let text = units.to_string();
    let (sign, text) = text.strip_prefix('-').map_or(("", text.as_str()), |size| ("-", size));
    let exponent = unit + text.len() as i32 - 1;
    if text == "0" {
        text.to_owned()
    } else if (-5..16).contains(&exponent) {
        format!("{sign}{}", plain(text, unit))
    } else {
        format!("{sign}{}e{exponent}", plain(text, 1 - text.len() as i32))
    }
}

/// The decimal `digits * 10^unit` without an exponent, for small ones.
fn plain(digits: &str, unit: i32) -> String {
    let places = unit.min(0).unsigned_abs() as usize;
    let padded = format!("{digits:0>width$}{zeros}", width = places + 1, zeros = "0".repeat(unit.max(0) as usize));
    let (whole, fraction) = padded.split_at(padded.len() - places);
    let fraction = fraction.trim_end_matches('0');
    if fraction.is_empty() { whole.to_owned() } else { format!("{whole}.{fraction}") }
}

/// As Display, for people.
impl fmt::Debug for Interval {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}
