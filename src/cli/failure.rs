//! What the user reads when a command does not succeed, and the exit status that goes with it.

use std::io;
use std::io::IsTerminal;
use std::io::Write;

use crate::diagnostic;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::SourceMap;
use crate::diagnostic::code;
use crate::library::Error;
use crate::session::expression::Messages;

/// Exit status for a mistake of the user's.
const THEIRS: u8 = 1;
/// Exit status for a fault of Imp's.
pub const OURS: u8 = 2;

/// Codes of faults of Imp itself begin with this.
const INTERNAL: &str = "E09";

/// Messages with the sources that they point into.
#[derive(Debug, Default)]
pub struct Failure {
    /// Each group has sources of its own: commands that take several files report them one after the other.
    groups: Vec<(SourceMap, Vec<Diagnostic>)>,
}

impl Failure {
    pub fn new(sources: SourceMap, diagnostics: Vec<Diagnostic>) -> Self {
        Self { groups: vec![(sources, diagnostics)] }
    }

    /// Adds the messages of a result to those collected so far.
    pub fn collect(&mut self, result: Result<(), Failure>) {
        if let Err(failure) = result {
            self.groups.extend(failure.groups);
        }
    }

    /// An error if anything was collected.
    pub fn into_result(self) -> Result<(), Failure> {
        if self.groups.is_empty() { Ok(()) } else { Err(self) }
    }

    pub fn print(&self) {
        for (sources, diagnostics) in &self.groups {
            print(sources, diagnostics);
        }
    }

    pub fn status(&self) -> u8 {
        let ours = self.groups.iter().flat_map(|(_, found)| found).any(|d| d.code.starts_with(INTERNAL));
        if ours { OURS } else { THEIRS }
    }
}

impl From<Diagnostic> for Failure {
    fn from(diagnostic: Diagnostic) -> Self {
        Self::new(SourceMap::default(), vec![diagnostic])
    }
}

impl From<Messages> for Failure {
    fn from(messages: Messages) -> Self {
        Self::new(messages.sources, messages.diagnostics)
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        match error {
            Error::Source(report) => Self { groups: vec![report.into_parts()] },
            Error::Other(diagnostic) => diagnostic.into(),
            other => Diagnostic::error(code::BAD_OPTION, other.to_string()).into(),
        }
    }
}

/// Messages on stderr, in colour on a terminal whose user has not set `NO_COLOR` (no-color.org).
pub fn print(sources: &SourceMap, diagnostics: &[Diagnostic]) {
    let plain = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
    let colour = io::stderr().is_terminal() && !plain;
    // Nobody is left to be told when stderr is closed.
    let _ = io::stderr().write_all(diagnostic::render(sources, diagnostics, colour).as_bytes());
}
