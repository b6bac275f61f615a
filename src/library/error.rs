//! The one error of the library.

use std::fmt;

use crate::diagnostic::Diagnostic;
use crate::diagnostic::SourceMap;
use crate::diagnostic::Span;
use crate::diagnostic::render;
use crate::interval::Interval;
use crate::interval::NoInterval;
use crate::session::expression::Messages;

/// What can go wrong in a program that uses Imp. `Debug` shows the same report as `Display`, so that
/// `fn main() -> Result<(), imp::Error>` prints something to read.
#[derive(Clone)]
#[non_exhaustive]
pub enum Error {
    /// A text with mistakes; each knows its place and often an edit to try.
    Source(Report),
    /// A name that the program has no function of.
    UnknownFunction { name: String, known: Vec<String> },
    /// A name that the function has no parameter of.
    UnknownParameter { name: String, known: Vec<String> },
    /// A name that the function has no variable of.
    UnknownVariable { name: String, known: Vec<String> },
    /// A parameter outside of the range for which its kernels were compiled.
    OutOfRange { name: String, value: Interval, range: Interval },
    /// Ends that make no interval.
    NoInterval(NoInterval),
    /// An array of the wrong length.
    Length { what: &'static str, expected: usize, found: usize },
    /// What needs no source and has no place in one: threads, files, work that was stopped, faults of Imp itself.
    Other(Diagnostic),
}

/// Messages with the sources into which they point.
#[derive(Clone)]
pub struct Report {
    sources: SourceMap,
    diagnostics: Vec<Diagnostic>,
}

impl Report {
    pub(crate) fn new(sources: SourceMap, diagnostics: Vec<Diagnostic>) -> Self {
        Self { sources, diagnostics }
    }

    /// What [`Report::new`] takes.
    pub(crate) fn into_parts(self) -> (SourceMap, Vec<Diagnostic>) {
        (self.sources, self.diagnostics)
    }

    /// The messages in the order of the source; there is at least one.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.diagnostics
    }

    /// The file, line and column of a place, both counted from 1; the column counts characters.
    pub fn place(&self, span: Span) -> (&str, usize, usize) {
        let source = self.sources.get(span.file);
        let before = source.text.get(..span.start as usize).unwrap_or(&source.text);
        let line = before.rsplit('\n').next().unwrap_or_default();
        (&source.name, before.matches('\n').count() + 1, line.chars().count() + 1)
    }

    /// The text at a place.
    pub fn text(&self, span: Span) -> &str {
        self.sources.text(span)
    }

    /// The messages with excerpts of the source, as the command line shows them.
    pub fn render(&self, colour: bool) -> String {
        render(&self.sources, &self.diagnostics, colour)
    }
}

impl Error {
    /// The messages of a text with mistakes, else nothing.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        match self {
            Error::Source(report) => report.diagnostics(),
            Error::Other(diagnostic) => std::slice::from_ref(diagnostic),
            _ => &[],
        }
    }
}

impl From<Messages> for Error {
    fn from(messages: Messages) -> Self {
        Error::Source(Report::new(messages.sources, messages.diagnostics))
    }
}

impl From<Diagnostic> for Error {
    fn from(diagnostic: Diagnostic) -> Self {
        Error::Other(diagnostic)
    }
}

impl From<NoInterval> for Error {
    fn from(error: NoInterval) -> Self {
        Error::NoInterval(error)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Source(report) => write!(f, "{}", report.render(false).trim_end()),
            Error::UnknownFunction { name, known } => unknown(f, "function", name, known),
            Error::UnknownParameter { name, known } => unknown(f, "parameter", name, known),
            Error::UnknownVariable { name, known } => unknown(f, "variable", name, known),
            Error::OutOfRange { name, value, range } => {
                write!(f, "parameter `{name}` cannot be {value}: it was declared to lie in {range}")
            }
            Error::NoInterval(error) => error.fmt(f),
            Error::Length { what, expected, found } => write!(f, "{what}: {expected} expected, {found} found"),
            Error::Other(diagnostic) => {
                write!(f, "{} [{}]", diagnostic.title, diagnostic.code)?;
                diagnostic.help.iter().try_for_each(|help| write!(f, "\n  help: {help}"))
            }
        }
    }
}

fn unknown(f: &mut fmt::Formatter<'_>, what: &str, name: &str, known: &[String]) -> fmt::Result {
    write!(f, "there is no {what} `{name}`")?;
    match known {
        [] => write!(f, ", nor any other"),
        _ => write!(f, "; there is {}", known.join(", ")),
    }
}

impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self}")
    }
}

impl std::error::Error for Error {}
