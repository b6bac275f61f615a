//! Parts of texts, and messages that point into them.

use std::ops::Range;

use crate::diagnostic;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::FileId;
use crate::diagnostic::SourceMap;
use crate::diagnostic::Span;
use crate::syntax;
use crate::syntax::ast::Expr;

/// Messages with the sources that they point into.
#[derive(Debug)]
pub struct Messages {
    pub sources: SourceMap,
    pub diagnostics: Vec<Diagnostic>,
}

impl Messages {
    /// Adds an edit to try to the last message.
    pub fn help(mut self, text: impl Into<String>) -> Self {
        if let Some(last) = self.diagnostics.last_mut() {
            last.help.push(text.into());
        }
        self
    }

    /// As text for the user.
    pub fn render(&self, colour: bool) -> String {
        diagnostic::render(&self.sources, &self.diagnostics, colour)
    }
}

impl From<Diagnostic> for Messages {
    fn from(diagnostic: Diagnostic) -> Self {
        Self { sources: SourceMap::default(), diagnostics: vec![diagnostic] }
    }
}

/// Part of a text that is shown as a whole when a message points into the part.
#[derive(Debug, Clone)]
pub struct Snippet<'a> {
    /// Of the text, in messages.
    pub name: &'a str,
    pub text: &'a str,
    pub part: Range<usize>,
}

impl<'a> Snippet<'a> {
    /// All of a text.
    pub fn whole(name: &'a str, text: &'a str) -> Self {
        Self { name, text, part: 0..text.len() }
    }

    /// A part of this part, given by its place in it.
    pub fn within(&self, part: Range<usize>) -> Self {
        Self { part: self.part.start + part.start..self.part.start + part.end, ..self.clone() }
    }

    pub fn as_str(&self) -> &'a str {
        &self.text[self.part.clone()]
    }

    /// A message about this part alone.
    pub fn fault(&self, code: &'static str, title: impl Into<String>, label: impl Into<String>) -> Messages {
        let mut sources = SourceMap::default();
        let file = sources.add(self.name, self.text);
        let span = Span { file, start: self.part.start as u32, end: self.part.end as u32 };
        Messages { sources, diagnostics: vec![Diagnostic::error(code, title).at(span, label)] }
    }

    /// The whole text as a source, and the part with blanks in place of what stands before, which keeps the offsets.
    pub(super) fn add_to(&self, sources: &mut SourceMap) -> (FileId, String) {
        let padded = " ".repeat(self.part.start) + self.as_str();
        (sources.add(self.name, self.text), padded)
    }

    /// Reads the part as an expression whose places are those of the whole text.
    pub(super) fn parse(&self, sources: &mut SourceMap) -> Result<Expr, Vec<Diagnostic>> {
        let (file, padded) = self.add_to(sources);
        syntax::parse_expression(file, &padded)
    }
}
