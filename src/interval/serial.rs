//! Intervals as serde has them: two ends. In text they are shortest decimals in quotes (`["-inf", "0.1"]`), since JSON
//! has no infinities and not every reader of its numbers rounds right; the empty set is an empty list.

use super::Interval;
use super::decimal;
use serde::Deserialize;
use serde::Deserializer;
use serde::Serialize;
use serde::Serializer;
use serde::de::Error;

impl Serialize for Interval {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let ends = if self.is_empty() { Vec::new() } else { vec![self.lo, self.hi] };
        match serializer.is_human_readable() {
            true => ends.into_iter().map(decimal).collect::<Vec<_>>().serialize(serializer),
            false => ends.serialize(serializer),
        }
    }
}

/// Fails for ends that are no interval.
impl<'de> Deserialize<'de> for Interval {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let ends: Vec<f64> = match deserializer.is_human_readable() {
            true => {
                let texts = Vec::<String>::deserialize(deserializer)?;
                texts.iter().map(|text| text.parse().map_err(D::Error::custom)).collect::<Result<_, _>>()?
            }
            false => Vec::deserialize(deserializer)?,
        };
        match ends[..] {
            [] => Ok(Self::EMPTY),
            [lo, hi] => Self::new(lo, hi).ok_or_else(|| D::Error::custom("the ends are not in order")),
            _ => Err(D::Error::custom("an interval has two ends")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_come_back_as_they_were() {
        let whole = Interval::new(0.1, 1e300).unwrap();
        for x in [Interval::EMPTY, Interval::ENTIRE, Interval::PI, Interval::ZERO, whole] {
            let text = serde_json::to_string(&x).unwrap();
            assert_eq!(serde_json::from_str::<Interval>(&text).unwrap(), x, "{text}");
            let bytes = postcard::to_stdvec(&x).unwrap();
            assert_eq!(postcard::from_bytes::<Interval>(&bytes).unwrap(), x);
        }
        assert_eq!(serde_json::to_string(&Interval::ENTIRE).unwrap(), r#"["-inf","inf"]"#);
        for wrong in [r#"["1","0"]"#, r#"["nan","0"]"#, r#"["1"]"#, r#"["inf","inf"]"#, "[1,2]"] {
            assert!(serde_json::from_str::<Interval>(wrong).is_err(), "{wrong}");
        }
    }
}
