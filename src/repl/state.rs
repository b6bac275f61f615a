//! What a session knows, and what one line does to it: a line in, a text out, no terminal.

use crate::derive::Formula;
use crate::diagnostic::code;
use crate::interval::Decorated;
use crate::repl::commands;
use crate::session::answer::Choice;
use crate::session::expression::Bindings;
use crate::session::expression::Expression;
use crate::session::expression::Messages;
use crate::session::expression::Reading;
use crate::session::expression::Snippet;
use crate::session::expression::Workspace;
use crate::syntax;

/// Statements that begin with one of these are definitions; the last three are refused as such.
const KEYWORDS: [&str; 7] = ["let", "fn", "param", "import", "surface", "curve", "domain"];

/// A session of the REPL.
#[derive(Debug)]
pub struct State {
    pub(super) workspace: Workspace,
    pub(super) bindings: Bindings,
    pub(super) choice: Choice,
    /// Columns that a line of text may have.
    pub(super) columns: usize,
    lines: usize,
    finished: bool,
}

impl Default for State {
    fn default() -> Self {
        Self {
            workspace: Workspace::default(),
            bindings: Bindings::new(),
            choice: Choice::Auto,
            columns: 80,
            lines: 0,
            finished: false,
        }
    }
}

/// An expression with all that enclosing it takes.
pub(super) struct Prepared {
    pub expression: Expression,
    pub formula: Formula,
    /// The boxes of the formula's variables, in its order.
    pub boxes: Vec<Decorated>,
}

impl Prepared {
    /// The places of the variables whose boxes are more than numbers.
    pub fn free(&self) -> Vec<usize> {
        (0..self.boxes.len()).filter(|&place| !is_number(self.boxes[place])).collect()
    }
}

impl State {
    /// Does what a line says, which may be several lines of text.
    ///
    /// # Errors
    /// What is wrong with it; the session goes on as if it had not been written.
    pub fn line(&mut self, text: &str) -> Result<String, Messages> {
        self.lines += 1;
        let name = format!("line {}", self.lines);
        let line = trim(&Snippet::whole(&name, text));
        if line.as_str().starts_with(':') {
            return commands::run(self, &line);
        }
        let mut outputs = Vec::new();
        for statement in statements(&line) {
            let output = self.statement(&statement)?;
            if !output.is_empty() {
                outputs.push(output);
            }
        }
        Ok(outputs.join("\n"))
    }

    /// Whether the session was left.
    pub fn finished(&self) -> bool {
        self.finished
    }

    /// Columns that its answers may take.
    pub fn columns(&self) -> usize {
        self.columns
    }

    pub fn set_columns(&mut self, columns: usize) {
        self.columns = columns;
    }

    pub(super) fn finish(&mut self) {
        self.finished = true;
    }

    /// Whether more must be typed before a text can be understood. A blank line ends it all the same.
    pub fn wants_more(text: &str) -> bool {
        let given_up = text.trim_end_matches(['\r', '\n']).len() + 1 < text.len();
        !text.trim_start().starts_with(':') && !given_up && syntax::wants_more(text)
    }

    fn statement(&mut self, statement: &Snippet) -> Result<String, Messages> {
        let text = statement.as_str();
        let first = text.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or_default();
        if KEYWORDS.contains(&first) {
            let names = self.workspace.define(statement, &self.bindings)?;
            for name in &names {
                self.bindings.remove(name);
            }
            return Ok(if names.is_empty() { String::new() } else { format!("defined {}", names.join(", ")) });
        }
        if let Some(equals) = assignment(text) {
            return self.bind(&trim(&statement.within(0..equals)), &statement.within(equals + 1..text.len()));
        }
        let prepared = self.prepare(statement)?;
        let answer = self.choice.enclose(&prepared.formula, &prepared.boxes);
        Ok(answer.line(&prepared.expression, &prepared.expression.boxes(&self.bindings), self.choice))
    }

    fn bind(&mut self, name: &Snippet, value: &Snippet) -> Result<String, Messages> {
        self.workspace.check_variable(name)?;
        let value = self.workspace.value(value, &self.bindings)?;
        let name = name.as_str();
        self.workspace.forget(name);
        self.bindings.insert(name.to_owned(), value);
        let natural = value == Decorated::new(value.interval());
        Ok(if natural { format!("{name} = {}", value.interval()) } else { format!("{name} = {value}") })
    }

    /// Resolves an expression over the session's boxes.
    pub(super) fn prepare(&self, snippet: &Snippet) -> Result<Prepared, Messages> {
        let names: Vec<&str> = self.bindings.keys().map(String::as_str).collect();
        let expression = self.workspace.expression(snippet, &names, Reading::Value)?;
        let formula = expression.formula();
        let boxes = expression.boxes_for(formula.variables(), &self.bindings);
        Ok(Prepared { expression, formula, boxes })
    }

    /// Resolves an expression in which the coordinates and the time need no values.
    pub(super) fn open(&self, snippet: &Snippet, how: Reading) -> Result<Expression, Messages> {
        let mut names: Vec<&str> = self.bindings.keys().map(String::as_str).collect();
        names.extend(["x", "y", "z", "t"].iter().filter(|name| !self.bindings.contains_key(**name)));
        self.workspace.expression(snippet, &names, how)
    }

    /// The place of the one variable of an expression that has a box.
    pub(super) fn only_free(&self, snippet: &Snippet, prepared: &Prepared) -> Result<usize, Messages> {
        match prepared.free()[..] {
            [only] => Ok(only),
            [] => {
                let fault = snippet.fault(code::NO_VALUE, "this has no variable with a box", "nothing varies here");
                Err(fault.help("give one a box first, such as `x = [-1, 1]`"))
            }
            [first, second, ..] => {
                let (first, second) = (&prepared.formula.variables()[first], &prepared.formula.variables()[second]);
                let title = format!("both `{first}` and `{second}` have boxes, and one variable is needed");
                let fault = snippet.fault(code::BAD_COMMAND, title, "depends on both");
                Err(fault.help(format!("give one of them a number, such as `{second} = 0.5`")))
            }
        }
    }
}

/// Whether a box is one number, or the enclosure of one that is no binary fraction.
pub(super) fn is_number(value: Decorated) -> bool {
    let interval = value.interval();
    interval.is_empty() || interval.is_singleton() || interval.lo().next_up() == interval.hi()
}

/// A snippet without the blanks around it.
pub(super) fn trim<'a>(snippet: &Snippet<'a>) -> Snippet<'a> {
    let text = snippet.as_str();
    let start = text.len() - text.trim_start().len();
    snippet.within(start..start + text.trim().len())
}

/// Where the `=` of `NAME = VALUE` stands.
fn assignment(text: &str) -> Option<usize> {
    let equals = text.find('=')?;
    let name = text[..equals].trim_end();
    let word = name.starts_with(|c: char| c.is_alphabetic() || c == '_')
        && name.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '\'');
    (word && !text[equals + 1..].starts_with('=')).then_some(equals)
}

/// The statements of a line, which `;` separates; nothing of what is blank or a comment.
fn statements<'a>(line: &Snippet<'a>) -> Vec<Snippet<'a>> {
    let text = line.as_str();
    let mut found = Vec::new();
    let mut start = 0;
    let (mut quoted, mut comment) = (false, false);
    // Where a comment starts after which nothing but blanks follows in the statement.
    let mut end = None;
    for (at, c) in text.char_indices() {
        match c {
            '\n' => (quoted, comment) = (false, false),
            _ if comment => {}
            '"' => quoted = !quoted,
            '#' if !quoted => {
                comment = true;
                end = end.or(Some(at));
            }
            ';' if !quoted => {
                found.push(line.within(start..end.take().unwrap_or(at)));
                start = at + 1;
            }
            c if !c.is_whitespace() => end = None,
            _ => {}
        }
    }
    found.push(line.within(start..end.unwrap_or(text.len())));
    found.iter().map(trim).filter(|statement| !statement.as_str().is_empty()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_statements() {
        let split = |text| statements(&Snippet::whole("", text)).iter().map(Snippet::as_str).collect::<Vec<_>>();
        assert_eq!(split("x = 1; x^2 # the square; no more"), ["x = 1", "x^2"]);
        assert_eq!(split("# nothing"), [] as [&str; 0]);
        assert_eq!(split("import \"a;b\"; 1"), ["import \"a;b\"", "1"]);
        assert_eq!(split("1 + # one\n2"), ["1 + # one\n2"]);
        assert_eq!(split(";;"), [] as [&str; 0]);
    }

    #[test]
    fn assignments_are_told_from_equations() {
        for (text, at) in
            [("x = 1", Some(2)), ("x'=[1,2]", Some(2)), ("x == 1", None), ("x^2 = 1", None), ("2 = x", None)]
        {
            assert_eq!(assignment(text), at, "{text}");
        }
    }
}
