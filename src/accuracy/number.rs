//! Numbers as people read them in tables and as programs read them in JSON.

use serde::Serializer;

/// Three significant digits: `0.0123`, `12.3`, `1230`, `1.2e-7`.
pub fn brief(number: f64) -> String {
    let size = number.abs();
    if number.is_nan() {
        "?".to_owned()
    } else if number == 0.0 || !number.is_finite() {
        format!("{number}")
    } else if (1e-3..1e5).contains(&size) {
        let places = (2.0 - size.log10().floor()).clamp(0.0, 5.0) as usize;
        format!("{number:.places$}")
    } else {
        format!("{number:.2e}")
    }
}

/// A number that JSON may not have: infinite ones become `"inf"` and `"-inf"`.
///
/// # Errors
/// Those of the serializer.
pub fn serialize<S: Serializer>(number: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    if number.is_finite() { serializer.serialize_f64(*number) } else { serializer.serialize_str(&number.to_string()) }
}

/// [`serialize`] for pairs.
///
/// # Errors
/// Those of the serializer.
pub fn serialize_pair<S: Serializer>(numbers: &[f64; 2], serializer: S) -> Result<S::Ok, S::Error> {
    #[derive(serde::Serialize)]
    struct Number(#[serde(serialize_with = "serialize")] f64);
    serializer.collect_seq(numbers.map(Number))
}

#[cfg(test)]
mod tests {
    use super::brief;

    #[test]
    fn three_digits() {
        let cases = [
            (0.0, "0"),
            (1.0, "1.00"),
            (0.012345, "0.0123"),
            (12.345, "12.3"),
            (1234.5, "1234"),
            (1e-7, "1.00e-7"),
            (-2.5e6, "-2.50e6"),
            (f64::INFINITY, "inf"),
        ];
        for (number, text) in cases {
            assert_eq!(brief(number), text);
        }
    }
}
