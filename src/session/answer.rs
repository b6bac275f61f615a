//! One expression over one box: which arithmetic encloses it, and the line of text that says what came out.

use std::fmt;

use crate::derive::Extension;
use crate::derive::Formula;
use crate::derive::Symbols;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::diagnostic::did_you_mean;
use crate::interval::Decorated;
use crate::interval::Interval;
use crate::interval::decimal;
use crate::session::expression::Expression;

/// Operations of the natural extension from which on a formula counts as large.
const MAX_OPERATIONS: u64 = 20_000;

/// Which arithmetic encloses an expression.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Choice {
    /// What all of them prove together.
    Auto,
    One(Extension),
}

impl Choice {
    /// Names of all choices.
    pub fn names() -> impl Iterator<Item = &'static str> {
        Extension::ALL.iter().map(|extension| extension.name()).chain(["auto"])
    }

    /// # Errors
    /// If there is no arithmetic of that name.
    pub fn from_name(name: &str) -> Result<Self, Diagnostic> {
        if name == "auto" {
            return Ok(Choice::Auto);
        }
        if let Some(extension) = Extension::ALL.iter().find(|extension| extension.name() == name) {
            return Ok(Choice::One(*extension));
        }
        let diagnostic = Diagnostic::error(code::BAD_OPTION, format!("there is no arithmetic `{name}`"));
        Err(match did_you_mean(name, Choice::names()) {
            Some(near) => diagnostic.help(format!("did you mean `{near}`?")),
            None => diagnostic.help(format!("there are {}", Choice::names().collect::<Vec<_>>().join(", "))),
        })
    }

    /// Encloses a formula over boxes in the order of its variables.
    pub fn enclose(self, formula: &Formula, boxes: &[Decorated]) -> Answer {
        match self {
            Choice::One(extension) => Answer { value: formula.enclose(extension, boxes), by: extension },
            Choice::Auto => best(formula, |extension| formula.enclose(extension, boxes)),
        }
    }

    /// The same over boxes cut into parts.
    pub fn enclose_in_parts(self, formula: &Formula, boxes: &[Decorated], parts: u32) -> Answer {
        let one = |extension| formula.enclose_in_parts(extension, boxes, parts);
        match self {
            Choice::One(extension) => Answer { value: one(extension), by: extension },
            Choice::Auto => best(formula, one),
        }
    }

    /// Operations that one box costs.
    pub fn operations(self, formula: &Formula) -> u64 {
        match self {
            Choice::One(extension) => formula.operations(extension),
            Choice::Auto => tried(formula).map(|extension| formula.operations(extension)).sum(),
        }
    }
}

impl fmt::Display for Choice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Choice::Auto => f.pad("auto"),
            Choice::One(extension) => f.pad(extension.name()),
        }
    }
}

/// The extensions that `auto` tries: for large formulas not those whose cost grows faster than the formula.
fn tried(formula: &Formula) -> impl Iterator<Item = Extension> {
    let small = formula.operations(Extension::Natural) <= MAX_OPERATIONS;
    let steep = |extension| {
        matches!(
            extension,
            Extension::Affine(Symbols::Full) | Extension::Intersected(Symbols::Full) | Extension::SecondOrder
        )
    };
    Extension::ALL.iter().copied().filter(move |&extension| small || !steep(extension))
}

/// What all extensions prove together: each of them encloses the same values, so their intersection does too, and each
/// decoration holds.
fn best(formula: &Formula, enclose: impl Fn(Extension) -> Decorated) -> Answer {
    let natural = enclose(Extension::Natural);
    let mut narrowest = (natural.interval().width(), Extension::Natural);
    let (mut interval, mut decoration) = (natural.interval(), natural.decoration());
    for extension in tried(formula).filter(|&extension| extension != Extension::Natural) {
        let value = enclose(extension);
        interval = interval.intersect(value.interval());
        decoration = decoration.max(value.decoration());
        // Of equally narrow ones the first, which are the cheaper ones.
        if value.interval().width() < narrowest.0 {
            narrowest = (value.interval().width(), extension);
        }
    }
    Answer { value: Decorated::with(interval, decoration), by: narrowest.1 }
}

/// An enclosure and the extension to which it is owed.
#[derive(Debug, Clone, Copy)]
pub struct Answer {
    pub value: Decorated,
    /// With [`Choice::Auto`] the narrowest one.
    pub by: Extension,
}

impl Answer {
    /// One line: enclosure, width, decoration with the reason if it is not `com`, and the arithmetic if it was chosen
    /// and is not the natural one. `boxes` are those of the graph's inputs.
    pub fn line(&self, expression: &Expression, boxes: &[Decorated], choice: Choice) -> String {
        let interval = self.value.interval();
        let mut line = match () {
            _ if !expression.condition || interval.is_empty() => String::new(),
            _ if interval == Interval::ONE => "true  ".to_owned(),
            _ if interval == Interval::ZERO => "false  ".to_owned(),
            _ => "undecided  ".to_owned(),
        };
        line += &format!("{interval}  width {}  {}", width(interval), self.value.decoration());
        if choice == Choice::Auto && self.by != Extension::Natural {
            line += &format!("  (narrowest: {})", self.by);
        }
        if let Some(reason) = expression.shortfall(boxes) {
            line += &format!("\n  {reason}");
        }
        line
    }
}

/// The width as text; the empty set has none.
pub fn width(interval: Interval) -> String {
    if interval.is_empty() { "-".to_owned() } else { decimal(interval.width()) }
}
