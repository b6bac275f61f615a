//! Values and boxes from their text.

use crate::diagnostic::code;
use crate::interval::Decorated;
use crate::interval::Decoration;
use crate::interval::Interval;
use crate::session::expression::Bindings;
use crate::session::expression::Reading;
use crate::session::expression::Workspace;
use crate::session::snippet::Messages;
use crate::session::snippet::Snippet;

impl Workspace {
    /// A value or a box: an interval literal of IEEE 1788 such as `[1, 2]`, `[entire]` or `3.56?1`, one whose ends are
    /// expressions, or an expression, whose enclosure is taken.
    ///
    /// # Errors
    /// If it cannot be read, is undefined, or its ends are not in order.
    pub fn value(&self, snippet: &Snippet, variables: &Bindings) -> Result<Decorated, Messages> {
        let written = snippet.as_str();
        let start = written.len() - written.trim_start().len();
        let snippet = &snippet.within(start..start + written.trim().len());
        let text = snippet.as_str();
        match text.parse::<Decorated>() {
            Ok(value) => return Ok(value),
            // Nothing but a literal can look like this, so its reader knows best what is wrong.
            Err(error) if text.contains('?') || text.contains("]_") => {
                let at = text.floor_char_boundary(error.position());
                let fault = snippet.within(at..text.len()).fault(code::BAD_VALUE, error.message(), "from here");
                return Err(fault.help("literals are such as `[1, 2]`, `[1, 2]_dac` or `3.56?1`"));
            }
            Err(_) => {}
        }
        let interval = match text.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
            Some(inner) => self.interval(snippet, inner, variables)?,
            None => self.number(snippet, variables)?,
        };
        Ok(Decorated::new(interval))
    }

    /// A box whose ends are expressions; `inner` is what stands between its brackets.
    fn interval(&self, snippet: &Snippet, inner: &str, variables: &Bindings) -> Result<Interval, Messages> {
        let text = snippet.as_str();
        let commas = top_level_commas(inner);
        let (left, right) = match commas[..] {
            [] => return self.number(&snippet.within(1..1 + inner.len()), variables),
            [comma] => (1..1 + comma, comma + 2..1 + inner.len()),
            _ => return Err(snippet.fault(code::BAD_VALUE, "a box has two ends", "write `[lower, upper]`")),
        };
        let lo = self.end(&snippet.within(left.clone()), f64::NEG_INFINITY, variables)?;
        let hi = self.end(&snippet.within(right.clone()), f64::INFINITY, variables)?;
        let (lo_text, hi_text) = (text[left].trim(), text[right].trim());
        Interval::new(lo.0, hi.1).filter(|_| lo.0 <= hi.1).ok_or_else(|| {
            let help = format!("write `[{hi_text}, {lo_text}]`");
            snippet.fault(code::EMPTY_RANGE, "the ends of this box are not in order", "lower end first").help(help)
        })
    }

    /// Bounds of one end of a box; nothing written, or `inf`, is the infinity on that side.
    fn end(&self, snippet: &Snippet, infinity: f64, variables: &Bindings) -> Result<(f64, f64), Messages> {
        match (snippet.as_str().trim().to_ascii_lowercase().as_str(), infinity > 0.0) {
            ("" | "inf" | "+inf" | "infinity" | "+infinity", true) | ("" | "-inf" | "-infinity", false) => {
                Ok((infinity, infinity))
            }
            _ => self.number(snippet, variables).map(|end| (end.lo(), end.hi())),
        }
    }

    /// The enclosure of an expression that is defined for the given variables.
    fn number(&self, snippet: &Snippet, variables: &Bindings) -> Result<Interval, Messages> {
        let names: Vec<&str> = variables.keys().map(String::as_str).collect();
        let expression = self.expression(snippet, &names, Reading::Value)?;
        if expression.condition {
            return Err(snippet.fault(
                code::WRONG_KIND,
                "a value is a number, and this is a condition",
                "true or false",
            ));
        }
        let value = expression.enclose(&expression.boxes(variables));
        if value.interval().is_empty() || value.decoration() < Decoration::Def {
            return Err(snippet.fault(
                code::NOT_FINITE,
                "this value is not defined",
                format!("its enclosure is {value}"),
            ));
        }
        Ok(value.interval())
    }
}

/// Where the commas outside of all brackets stand.
fn top_level_commas(text: &str) -> Vec<usize> {
    let mut depth = 0;
    let mut commas = Vec::new();
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            b'(' | b'[' => depth += 1,
            b')' | b']' => depth -= 1,
            b',' if depth == 0 => commas.push(at),
            _ => {}
        }
    }
    commas
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(result: Result<impl std::fmt::Debug, Messages>) -> String {
        result.unwrap_err().render(false)
    }

    #[test]
    fn values_are_boxes_or_constants() {
        let workspace = Workspace::default();
        let value = |text| workspace.value(&Snippet::whole("value of x", text), &Bindings::new());
        for (text, lo, hi) in [
            ("[1, 2]", 1.0, 2.0),
            (" [ -1/2 , 2^3 ] ", -0.5, 8.0),
            ("0x1.8p+1", 3.0, 3.0),
            ("[0, inf]", 0.0, f64::INFINITY),
            ("[,1]", f64::NEG_INFINITY, 1.0),
            ("[entire]", f64::NEG_INFINITY, f64::INFINITY),
            ("[min(1, 2), max(3, 4)]", 1.0, 4.0),
            ("[1.5]", 1.5, 1.5),
            ("3.5?5", 3.0, 4.0),
        ] {
            assert_eq!(value(text).unwrap().interval(), Interval::new(lo, hi).unwrap(), "{text}");
        }
        assert!(value("[empty]").unwrap().interval().is_empty());
        assert_eq!(value("[1, 2]_def").unwrap().to_string(), "[1, 2]_def");
        let tenth = value("0.1").unwrap().interval();
        assert_eq!((tenth.lo(), tenth.hi()), (0.1f64.next_down(), 0.1));
        assert_eq!(value("pi").unwrap().interval(), Interval::PI);
        assert!(said(value("[2, 1]")).contains("write `[1, 2]`"));
        assert!(said(value("[1, 1 +]")).contains("value of x:1:"));
        for wrong in
            ["", "[1, 2, 3]", "1/0", "[sqrt(-1), 2]", "y", "[1, 2", "[inf, inf]", "[1; 2]", "3?x", "[1, 2]_top"]
        {
            assert!(value(wrong).is_err(), "{wrong}");
        }
    }
}
