//! Intervals from ranges, and intervals in files and messages of other programs. Where people read (JSON), the ends are texts, shortest decimals that read
//! back as the same `f64`, since JSON has no infinities: `{"lo": "-1", "hi": "inf"}`, and both are `"empty"` for the empty set.
//! Elsewhere they are two numbers, both NaN for the empty set.

use std::fmt;
use std::ops::RangeInclusive;

use serde::Deserialize;
use serde::Deserializer;
use serde::Serialize;
use serde::Serializer;
use serde::de::Error;

use super::Interval;
use super::decimal;

/// Ends that are NaN, not in order, or both the same infinity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoInterval {
    pub lo: f64,
    pub hi: f64,
}

impl fmt::Display for NoInterval {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "[{}, {}] is no interval", decimal(self.lo), decimal(self.hi))
    }
}

impl std::error::Error for NoInterval {}

/// All numbers of a range, as in `Interval::try_from(0.0..=1.0)?`.
impl TryFrom<RangeInclusive<f64>> for Interval {
    type Error = NoInterval;

    fn try_from(range: RangeInclusive<f64>) -> Result<Self, NoInterval> {
        let (lo, hi) = range.into_inner();
        Interval::new(lo, hi).ok_or(NoInterval { lo, hi })
    }
}

#[derive(Serialize, Deserialize)]
struct Texts {
    lo: String,
    hi: String,
}

#[derive(Serialize, Deserialize)]
struct Numbers {
    lo: f64,
    hi: f64,
}

impl Serialize for Interval {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if !serializer.is_human_readable() {
            return Numbers { lo: self.lo, hi: self.hi }.serialize(serializer);
        }
        let text = |x: f64| if self.is_empty() { "empty".to_owned() } else { decimal(x) };
        Texts { lo: text(self.lo), hi: text(self.hi) }.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Interval {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let (lo, hi) = if deserializer.is_human_readable() {
            let Texts { lo, hi } = Texts::deserialize(deserializer)?;
            if lo == "empty" && hi == "empty" {
                return Ok(Interval::EMPTY);
            }
            let number = |text: &str| match text.parse::<f64>() {
                Ok(number) if !number.is_nan() => Ok(number),
                _ => Err(D::Error::custom(format!("`{text}` is no end of an interval"))),
            };
            (number(&lo)?, number(&hi)?)
        } else {
            let Numbers { lo, hi } = Numbers::deserialize(deserializer)?;
            if lo.is_nan() && hi.is_nan() {
                return Ok(Interval::EMPTY);
            }
            (lo, hi)
        };
        Interval::try_from(lo..=hi).map_err(D::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_come_back_as_they_were() {
        let tenth = Interval::new(0.1, 1.0 / 3.0).unwrap();
        assert_eq!(serde_json::to_string(&tenth).unwrap(), r#"{"lo":"0.1","hi":"0.3333333333333333"}"#);
        for interval in [tenth, Interval::ENTIRE, Interval::point(-0.0), Interval::point(5e-324), Interval::EMPTY] {
            let json = serde_json::to_string(&interval).unwrap();
            assert_eq!(serde_json::from_str::<Interval>(&json).unwrap(), interval, "{json}");
            let bytes = postcard::to_stdvec(&interval).unwrap();
            assert_eq!(postcard::from_bytes::<Interval>(&bytes).unwrap(), interval);
        }
        for wrong in [r#"{"lo":"1","hi":"0"}"#, r#"{"lo":"nan","hi":"0"}"#, r#"{"lo":"inf","hi":"inf"}"#] {
            assert!(serde_json::from_str::<Interval>(wrong).is_err(), "{wrong}");
        }
    }
}
