//! Intervals as text: shortest decimal strings that read back as the same bounds.

use super::Interval;
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

/// As Display: the bounds are exact there.
impl fmt::Debug for Interval {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}
