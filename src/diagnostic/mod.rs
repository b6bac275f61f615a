//! Where source text lives, how a place in it is named, and the one shape of every message to the user.

use std::sync::Arc;

pub mod code;
mod render;
mod suggest;

pub use crate::diagnostic::render::render;
pub use crate::diagnostic::suggest::did_you_mean;

/// Index of a file in a [`SourceMap`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FileId(pub u32);

/// A half-open byte range of one file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Span {
    pub file: FileId,
    pub start: u32,
    pub end: u32,
}

impl Span {
    /// The smallest span that covers both; they must lie in one file.
    pub fn to(self, end: Span) -> Span {
        debug_assert_eq!(self.file, end.file);
        Span { file: self.file, start: self.start.min(end.start), end: self.end.max(end.end) }
    }
}

/// One loaded file: the name shown to the user and its text.
#[derive(Debug, Clone)]
pub struct Source {
    pub name: String,
    pub text: Arc<str>,
}

/// All files of one run, in the order in which they were read.
#[derive(Debug, Clone, Default)]
pub struct SourceMap {
    files: Vec<Source>,
}

impl SourceMap {
    pub fn add(&mut self, name: impl Into<String>, text: impl Into<Arc<str>>) -> FileId {
        self.files.push(Source { name: name.into(), text: text.into() });
        FileId(self.files.len() as u32 - 1)
    }

    /// Adds a file as it was read. Bytes that are not UTF-8 are replaced by `\u{FFFD}`, and the message says where the
    /// first of them stands; such a file should not be read further.
    pub fn add_bytes(&mut self, name: impl Into<String>, bytes: &[u8]) -> (FileId, Option<Diagnostic>) {
        let (name, text) = (name.into(), String::from_utf8_lossy(bytes));
        let title = format!("`{name}` is not text in UTF-8");
        let file = self.add(name, text.as_ref());
        let Err(error) = std::str::from_utf8(bytes) else { return (file, None) };
        let at = error.valid_up_to();
        let mut diagnostic = Diagnostic::error(code::NOT_TEXT, title);
        // Everything before the first bad byte is unchanged, so offsets agree up to here.
        if let Ok(start) = u32::try_from(at) {
            let end = start.saturating_add(char::REPLACEMENT_CHARACTER.len_utf8() as u32);
            diagnostic = diagnostic.at(Span { file, start, end }, format!("byte {at} is 0x{:02X}", bytes[at]));
        }
        (file, Some(diagnostic.help("save the file as UTF-8")))
    }

    pub fn get(&self, file: FileId) -> &Source {
        &self.files[file.0 as usize]
    }

    /// All files, in the order in which they were read.
    pub fn iter(&self) -> impl Iterator<Item = &Source> {
        self.files.iter()
    }

    pub fn text(&self, span: Span) -> &str {
        &self.get(span.file).text[span.start as usize..span.end as usize]
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    Warning,
    Error,
}

/// A message to the user: a stable code, the user's problem as a title, places in the source, and edits to try.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    pub severity: Severity,
    /// Stable, e.g. `"E0201"`; the list is in `code.rs`.
    pub code: &'static str,
    pub title: String,
    /// The first label is the main one.
    pub labels: Vec<Label>,
    pub help: Vec<String>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Label {
    pub span: Span,
    pub text: String,
}

/// Past so many messages the rest is only counted: nobody reads more at once.
pub const MAX_SHOWN: usize = 100;

/// Leaves out all but the first [`MAX_SHOWN`] messages and says how many are missing, `dropped` ones included.
pub fn shorten(found: &mut Vec<Diagnostic>, dropped: usize) {
    // What says so already counts as one.
    if found.len() > MAX_SHOWN + 1 {
        let more = found.len() - MAX_SHOWN + dropped;
        found.truncate(MAX_SHOWN);
        found.push(Diagnostic::error(code::TOO_MANY_ERRORS, format!("{more} more errors are not shown")));
    }
}

impl Diagnostic {
    pub fn error(code: &'static str, title: impl Into<String>) -> Self {
        Self { severity: Severity::Error, code, title: title.into(), labels: Vec::new(), help: Vec::new() }
    }

    pub fn warning(code: &'static str, title: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(code, title) }
    }

    pub fn at(mut self, span: Span, text: impl Into<String>) -> Self {
        self.labels.push(Label { span, text: text.into() });
        self
    }

    pub fn help(mut self, text: impl Into<String>) -> Self {
        self.help.push(text.into());
        self
    }
}
