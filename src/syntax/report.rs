//! The text being read and what is wrong with it: shared by all steps from tokens to AST.

use crate::diagnostic::Diagnostic;
use crate::diagnostic::FileId;
use crate::diagnostic::MAX_SHOWN;
use crate::diagnostic::Span;
use crate::diagnostic::shorten;
use crate::syntax::token::Lexeme;

/// One file's text, and the messages found in it so far.
#[derive(Debug)]
pub struct Reporter<'t> {
    pub file: FileId,
    pub text: &'t str,
    pub found: Vec<Diagnostic>,
    /// How many more there were than are kept.
    pub dropped: usize,
    /// Where each of them stands, those that were dropped included.
    pub places: Vec<u32>,
}

/// So many messages are kept at least, the first ones by their places; few are shown.
const KEPT: usize = 2 * MAX_SHOWN;

impl<'t> Reporter<'t> {
    pub fn new(file: FileId, text: &'t str) -> Self {
        Self { file, text, found: Vec::new(), dropped: 0, places: Vec::new() }
    }

    pub fn span(&self, start: u32, end: u32) -> Span {
        Span { file: self.file, start, end }
    }

    /// The place of one token.
    pub fn at(&self, lexeme: Lexeme) -> Span {
        self.span(lexeme.start, lexeme.end)
    }

    pub fn slice(&self, start: u32, end: u32) -> &'t str {
        &self.text[start as usize..end as usize]
    }

    pub fn text_of(&self, lexeme: Lexeme) -> &'t str {
        self.slice(lexeme.start, lexeme.end)
    }

    /// The token's text for the middle of a message: shortened where nobody would read it.
    pub fn quote(&self, lexeme: Lexeme) -> String {
        const LONGEST: usize = 40;
        let text = self.text_of(lexeme);
        match text.char_indices().nth(LONGEST) {
            None => format!("`{text}`"),
            Some((end, _)) => format!("`{}...`", &text[..end]),
        }
    }

    /// How many messages there were.
    pub fn count(&self) -> usize {
        self.found.len() + self.dropped
    }

    /// The messages in the order of the text, and not more of them than anyone reads.
    pub fn finish(mut self) -> Vec<Diagnostic> {
        self.found.sort_by_key(place);
        shorten(&mut self.found, self.dropped);
        self.found
    }

    pub fn report(&mut self, diagnostic: Diagnostic) {
        self.places.extend(diagnostic.labels.first().map(|label| label.span.start));
        self.found.push(diagnostic);
        if self.found.len() >= 10 * KEPT {
            self.found.sort_by_key(place);
            self.dropped += self.found.len() - KEPT;
            self.found.truncate(KEPT);
        }
    }

    /// Source text as it goes into an offered edit: on one line, or `None` where it would be too long to help.
    pub fn excerpt(&self, start: u32, end: u32) -> Option<String> {
        one_line(self.slice(start, end))
    }
}

fn place(diagnostic: &Diagnostic) -> Option<u32> {
    diagnostic.labels.first().map(|label| label.span.start)
}

/// `text` with its white space collapsed to single blanks, or `None` where it is too long (or holds a comment) for an offered edit.
pub fn one_line(text: &str) -> Option<String> {
    const LIMIT: usize = 80;
    if text.len() > LIMIT || text.contains('#') {
        return None;
    }
    let inner = text.split_whitespace().collect::<Vec<_>>().join(" ");
    // A blank at either end separates factors; it must survive.
    let blank = |is: bool| if is { " " } else { "" };
    let (lead, tail) = (text.starts_with(char::is_whitespace), text.ends_with(char::is_whitespace));
    Some(format!("{}{inner}{}", blank(lead), blank(tail && !inner.is_empty())))
}
