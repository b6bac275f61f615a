//! One request of `imp eval --json`: read, evaluated with what was compiled before, and answered.

use std::borrow::Cow;
use std::collections::HashMap;
use std::fmt;
use std::io::Write;

use serde::Deserialize;
use serde::Deserializer;
use serde::de::Error;
use serde::de::MapAccess;
use serde::de::SeqAccess;
use serde::de::Visitor;

use crate::cli::eval::number;
use crate::derive::Extension;
use crate::derive::Formula;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::interval::Decorated;
use crate::interval::Interval;
use crate::session::answer::Choice;
use crate::session::expression::Bindings;
use crate::session::expression::Messages;
use crate::session::expression::Reading;
use crate::session::expression::Snippet;
use crate::session::expression::Workspace;

/// Formulas that are kept; one more, and all are forgotten.
const MAX_FORMULAS: usize = 10_000;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Request<'a> {
    #[serde(borrow)]
    expr: Text<'a>,
    #[serde(borrow, default)]
    vars: Variables<'a>,
    #[serde(borrow, default)]
    arithmetic: Option<Text<'a>>,
}

/// A string, or an integer as if it were written as one.
#[derive(Debug)]
struct Text<'a>(Cow<'a, str>);

/// One value, or both ends of a box.
#[derive(Debug)]
enum Ends<'a> {
    One(Text<'a>),
    Two(Text<'a>, Text<'a>),
}

/// Names with their values, in the order of the request.
#[derive(Debug, Default)]
struct Variables<'a>(Vec<(Text<'a>, Ends<'a>)>);

struct TextVisitor;

impl<'de> Visitor<'de> for TextVisitor {
    type Value = Text<'de>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a string such as \"0.1\", which stands for that number exactly")
    }

    fn visit_borrowed_str<E: Error>(self, text: &'de str) -> Result<Self::Value, E> {
        Ok(Text(Cow::Borrowed(text)))
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Self::Value, E> {
        Ok(Text(Cow::Owned(text.to_owned())))
    }

    fn visit_u64<E: Error>(self, number: u64) -> Result<Self::Value, E> {
        Ok(Text(Cow::Owned(number.to_string())))
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<Self::Value, E> {
        Ok(Text(Cow::Owned(number.to_string())))
    }
}

impl<'de: 'a, 'a> Deserialize<'de> for Text<'a> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(TextVisitor)
    }
}

struct EndsVisitor;

impl<'de> Visitor<'de> for EndsVisitor {
    type Value = Ends<'de>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a value such as \"0.1\" or the two ends of a box such as [\"-1\", \"2\"]")
    }

    fn visit_borrowed_str<E: Error>(self, text: &'de str) -> Result<Self::Value, E> {
        TextVisitor.visit_borrowed_str(text).map(Ends::One)
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Self::Value, E> {
        TextVisitor.visit_str(text).map(Ends::One)
    }

    fn visit_u64<E: Error>(self, number: u64) -> Result<Self::Value, E> {
        TextVisitor.visit_u64(number).map(Ends::One)
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<Self::Value, E> {
        TextVisitor.visit_i64(number).map(Ends::One)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut ends: A) -> Result<Self::Value, A::Error> {
        let (Some(lo), Some(hi)) = (ends.next_element()?, ends.next_element()?) else {
            return Err(A::Error::custom("a box has two ends"));
        };
        match ends.next_element::<Text>()? {
            None => Ok(Ends::Two(lo, hi)),
            Some(_) => Err(A::Error::custom("a box has two ends")),
        }
    }
}

impl<'de: 'a, 'a> Deserialize<'de> for Ends<'a> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(EndsVisitor)
    }
}

struct VariablesVisitor;

impl<'de> Visitor<'de> for VariablesVisitor {
    type Value = Variables<'de>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object of names with their values")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut variables: Vec<(Text, Ends)> = Vec::new();
        while let Some((name, ends)) = map.next_entry::<Text, Ends>()? {
            if variables.iter().any(|(other, _)| other.0 == name.0) {
                return Err(A::Error::custom(format_args!("`{}` is given twice", name.0)));
            }
            variables.push((name, ends));
        }
        Ok(Variables(variables))
    }
}

impl<'de: 'a, 'a> Deserialize<'de> for Variables<'a> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(VariablesVisitor)
    }
}

/// What is wrong with a request.
#[derive(Debug, Clone)]
struct Fault {
    code: &'static str,
    message: String,
}

impl From<Messages> for Fault {
    /// The first message with its place and what would help.
    fn from(messages: Messages) -> Self {
        let found = messages.diagnostics.into_iter().next();
        let diagnostic = found.unwrap_or_else(|| Diagnostic::error(code::INTERNAL, "an error without a message"));
        let mut message = diagnostic.title;
        if let Some(label) = diagnostic.labels.first() {
            let source = messages.sources.get(label.span.file);
            let column = source.text.get(..label.span.start as usize).map_or(0, |before| before.chars().count());
            message += &format!(" ({}, character {})", source.name, column + 1);
        }
        for help in diagnostic.help {
            message += "; ";
            message += &help;
        }
        Fault { code: diagnostic.code, message }
    }
}

/// A formula with where each of its inputs comes from.
struct Compiled {
    formula: Formula,
    inputs: Vec<Input>,
}

#[derive(Debug, Clone, Copy)]
enum Input {
    /// The place of a variable in the request.
    Given(usize),
    Fixed(Decorated),
}

/// Answers requests, and keeps the formulas that it has compiled.
pub struct Evaluator<'w> {
    workspace: &'w Workspace,
    arithmetic: Choice,
    /// By the text of the expression with the names of its variables.
    formulas: HashMap<String, Result<Compiled, Fault>>,
    key: String,
    values: Vec<Decorated>,
    boxes: Vec<Decorated>,
}

impl<'w> Evaluator<'w> {
    /// # Errors
    /// If there is no arithmetic of that name; without a name it is the natural extension.
    pub fn new(workspace: &'w Workspace, arithmetic: Option<&str>) -> Result<Self, Diagnostic> {
        let arithmetic = arithmetic.map_or(Ok(Choice::One(Extension::Natural)), Choice::from_name)?;
        let formulas = HashMap::new();
        Ok(Self { workspace, arithmetic, formulas, key: String::new(), values: Vec::new(), boxes: Vec::new() })
    }

    /// Appends the answer to one line.
    pub fn answer(&mut self, line: &[u8], out: &mut Vec<u8>) {
        match self.evaluate(line) {
            Ok(value) => write_value(value, out),
            Err(fault) => write_fault(&fault, out),
        }
    }

    /// Appends the answer to a line that is no request.
    pub fn refuse(&self, message: String, out: &mut Vec<u8>) {
        write_fault(&Fault { code: code::BAD_REQUEST, message }, out);
    }

    fn evaluate(&mut self, line: &[u8]) -> Result<Decorated, Fault> {
        let text = std::str::from_utf8(line).map_err(|error| Fault {
            code: code::NOT_TEXT,
            message: format!("this line is not text in UTF-8 (byte {})", error.valid_up_to()),
        })?;
        let request: Request = serde_json::from_str(text)
            .map_err(|error| Fault { code: code::BAD_REQUEST, message: without_line(&error.to_string()) })?;
        let choice = match &request.arithmetic {
            Some(name) => Choice::from_name(&name.0).map_err(|diagnostic| Fault::from(Messages::from(diagnostic)))?,
            None => self.arithmetic,
        };
        self.values.clear();
        for (name, ends) in &request.vars.0 {
            let value = self.value(&name.0, ends)?;
            self.values.push(value);
        }
        let Self { values, boxes, .. } = self;
        let (values, mut boxes) = (std::mem::take(values), std::mem::take(boxes));
        let answer = self.compiled(&request).map(|compiled| {
            boxes.clear();
            boxes.extend(compiled.inputs.iter().map(|input| match *input {
                Input::Given(place) => values[place],
                Input::Fixed(value) => value,
            }));
            choice.enclose(&compiled.formula, &boxes).value
        });
        (self.values, self.boxes) = (values, boxes);
        answer
    }

    fn value(&self, name: &str, ends: &Ends) -> Result<Decorated, Fault> {
        let fast = match ends {
            Ends::One(text) => number::decimal(&text.0),
            Ends::Two(lo, hi) => match (number::decimal(&lo.0), number::decimal(&hi.0)) {
                (Some(lo), Some(hi)) => Interval::new(lo.lo(), hi.hi()).filter(|_| lo.lo() <= hi.lo()),
                _ => None,
            },
        };
        if let Some(value) = fast {
            return Ok(Decorated::new(value));
        }
        let text = match ends {
            Ends::One(text) => text.0.clone(),
            Ends::Two(lo, hi) => Cow::Owned(format!("[{}, {}]", lo.0, hi.0)),
        };
        let title = format!("value of {name}");
        Ok(self.workspace.value(&Snippet::whole(&title, &text), &Bindings::new())?)
    }

    /// The formula of a request, compiled on its first use.
    fn compiled(&mut self, request: &Request) -> Result<&Compiled, Fault> {
        self.key.clear();
        self.key.push_str(&request.expr.0);
        for (name, _) in &request.vars.0 {
            self.key.push('\0');
            self.key.push_str(&name.0);
        }
        if !self.formulas.contains_key(&self.key) {
            if self.formulas.len() >= MAX_FORMULAS {
                self.formulas.clear();
            }
            let compiled = self.compile(request);
            self.formulas.insert(self.key.clone(), compiled);
        }
        self.formulas[&self.key].as_ref().map_err(Fault::clone)
    }

    fn compile(&self, request: &Request) -> Result<Compiled, Fault> {
        let names: Vec<&str> = request.vars.0.iter().map(|(name, _)| &*name.0).collect();
        for name in &names {
            self.workspace.check_variable(&Snippet::whole("vars", name))?;
        }
        let expression = self.workspace.expression(&Snippet::whole("expr", &request.expr.0), &names, Reading::Value)?;
        let formula = expression.formula();
        let fixed = expression.boxes_for(formula.variables(), &Bindings::new());
        let inputs = formula.variables().iter().zip(fixed).map(|(variable, fixed)| {
            names.iter().position(|name| name == variable).map_or(Input::Fixed(fixed), Input::Given)
        });
        let inputs = inputs.collect();
        Ok(Compiled { formula, inputs })
    }
}

/// serde's message about one line of input, which is always its line 1.
fn without_line(message: &str) -> String {
    message.replacen(" at line 1 column ", " at character ", 1)
}

fn write_value(value: Decorated, out: &mut Vec<u8>) {
    let interval = value.interval();
    out.extend_from_slice(b"{\"lo\": \"");
    write_end(interval.lo(), out);
    out.extend_from_slice(b"\", \"hi\": \"");
    write_end(interval.hi(), out);
    // Writing to memory does not fail.
    let _ = write!(out, "\", \"decoration\": \"{}\"}}", value.decoration());
}

/// The shortest decimal that reads back exactly; the ends of the empty set are `empty`.
fn write_end(end: f64, out: &mut Vec<u8>) {
    if end.is_nan() {
        out.extend_from_slice(b"empty");
        return;
    }
    let _ = write!(out, "{end:?}");
    if out.ends_with(b".0") {
        out.truncate(out.len() - 2);
    }
}

fn write_fault(fault: &Fault, out: &mut Vec<u8>) {
    let message = serde_json::Value::from(fault.message.as_str());
    let _ = write!(out, "{{\"error\": {{\"code\": \"{}\", \"message\": {message}}}}}", fault.code);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answer(line: &str) -> String {
        let workspace = Workspace::default();
        let mut out = Vec::new();
        Evaluator::new(&workspace, None).unwrap().answer(line.as_bytes(), &mut out);
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn requests_are_answered_as_documented() {
        let table = [
            (r#"{"expr": "x^2 - 1", "vars": {"x": ["-1", "2"]}}"#, r#"{"lo": "-1", "hi": "3", "decoration": "com"}"#),
            (r#"{"expr": "1/x", "vars": {"x": "[0, 1]"}}"#, r#"{"lo": "1", "hi": "inf", "decoration": "trv"}"#),
            (r#"{"expr": "ln(x)", "vars": {"x": "-1"}}"#, r#"{"lo": "empty", "hi": "empty", "decoration": "trv"}"#),
            (r#"{"expr": "0x1.8p+1"}"#, r#"{"lo": "3", "hi": "3", "decoration": "com"}"#),
            (r#"{"vars": {"x": [1, 2]}, "expr": "x"}"#, r#"{"lo": "1", "hi": "2", "decoration": "com"}"#),
            (r#"{"expr": "x", "vars": {"x": "[entire]"}}"#, r#"{"lo": "-inf", "hi": "inf", "decoration": "dac"}"#),
            (
                r#"{"expr": "x - x", "vars": {"x": ["0", "pi/2"]}, "arithmetic": "interval"}"#,
                r#"{"lo": "-1.5707963267948968", "hi": "1.5707963267948968", "decoration": "com"}"#,
            ),
        ];
        for (line, expected) in table {
            assert_eq!(answer(line), expected, "{line}");
        }
    }

    #[test]
    fn faults_have_codes_and_places() {
        let table = [
            ("{", code::BAD_REQUEST, "at character 1"),
            ("[]", code::BAD_REQUEST, "invalid length"),
            (r#"{"vars": {}}"#, code::BAD_REQUEST, "missing field `expr`"),
            (r#"{"expr": "x", "vars": {"x": 0.1}}"#, code::BAD_REQUEST, "a value such as"),
            (r#"{"expr": "x", "vars": {"x": ["1"]}}"#, code::BAD_REQUEST, "two ends"),
            (r#"{"expr": "x", "vars": {"x": "1", "x": "2"}}"#, code::BAD_REQUEST, "given twice"),
            (r#"{"expr": "x", "vars": {"x": ["2", "1"]}}"#, code::EMPTY_RANGE, "write `[1, 2]`"),
            (r#"{"expr": "sin 2x", "vars": {"x": "1"}}"#, code::FUNCTION_WITHOUT_BRACKETS, "sin(2x)"),
            (r#"{"expr": "x + yy", "vars": {"x": "1"}}"#, code::UNKNOWN_NAME, "(expr, character 5)"),
            (r#"{"expr": "x"}"#, code::NO_VALUE, "`x` has no value"),
            (r#"{"expr": "1", "vars": {"2x": "1"}}"#, code::BAD_ARGUMENT, "not a name"),
            (r#"{"expr": "1", "arithmetic": "afine"}"#, code::BAD_OPTION, "there is no arithmetic `afine`"),
        ];
        for (line, code, part) in table {
            let found = answer(line);
            let value: serde_json::Value = serde_json::from_str(&found).unwrap();
            assert_eq!(value["error"]["code"], *code, "{line}: {found}");
            assert!(value["error"]["message"].as_str().unwrap().contains(part), "{line}: {found}");
        }
    }
}
