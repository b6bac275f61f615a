//! Diagnostics as text, with the source under them.

use std::borrow::Cow;
use std::ops::Range;

use codespan_reporting::diagnostic as codespan;
use codespan_reporting::files::Error;
use codespan_reporting::files::Files;
use codespan_reporting::files::line_starts;
use codespan_reporting::term;
use codespan_reporting::term::termcolor::Ansi;

use crate::diagnostic::Diagnostic;
use crate::diagnostic::FileId;
use crate::diagnostic::Severity;
use crate::diagnostic::SourceMap;
use crate::diagnostic::Span;

/// All diagnostics one below the other, with ANSI colours if `colour`. Spans outside of their file are moved into it.
pub fn render(map: &SourceMap, diagnostics: &[Diagnostic], colour: bool) -> String {
    let config = term::Config::default();
    let mut out = Ansi::new(Vec::new());
    let mut plain = String::new();
    for diagnostic in diagnostics {
        let views = Views::new(map, diagnostic);
        let message = views.message(diagnostic);
        let drawn = if colour {
            term::emit_to_write_style(&mut out, &config, &views, &message)
        } else {
            term::emit_to_string(&mut plain, &config, &views, &message)
        };
        // Writing to memory does not fail and all spans are in range; the title is worth more than a panic.
        if drawn.is_err() {
            plain.push_str(&format!("error[{}]: {}\n", diagnostic.code, diagnostic.title));
        }
    }
    plain.push_str(&String::from_utf8_lossy(&out.into_inner()));
    plain
}

/// What one diagnostic shows of its files. Excerpts of long lines (a generated sum has one line of megabytes) show a
/// window around the first label there.
struct Views<'m> {
    files: Vec<(FileId, View<'m>)>,
}

struct View<'m> {
    name: &'m str,
    text: Cow<'m, str>,
    /// Offsets in `text` at which lines start.
    starts: Vec<usize>,
    /// The parts of the file that are shown, ascending: bytes of the file, and where `text` has them.
    pieces: Vec<(Range<usize>, usize)>,
    /// Lines whose beginning is cut off, and how many characters the ellipsis there stands for.
    hidden: Vec<(usize, usize)>,
}

/// Lines up to this many bytes are shown whole.
const LONG_LINE: usize = 240;
/// Bytes shown on either side of the label on a longer line.
const WINDOW: usize = 60;
const ELLIPSIS: &str = "...";
/// Bytes shown of a message that quotes the source; names may be megabytes long too.
const LONG_MESSAGE: usize = 400;

impl<'m> Views<'m> {
    fn new(map: &'m SourceMap, diagnostic: &Diagnostic) -> Self {
        let mut files: Vec<(FileId, View<'m>)> = Vec::new();
        for label in &diagnostic.labels {
            let file = label.span.file;
            if files.iter().all(|(f, _)| *f != file) {
                let source = map.get(file);
                let spans = diagnostic.labels.iter().map(|l| l.span).filter(|s| s.file == file);
                files.push((file, View::new(&source.name, harmless(&source.text), spans)));
            }
        }
        Self { files }
    }

    fn message(&self, diagnostic: &Diagnostic) -> codespan::Diagnostic<FileId> {
        let severity = match diagnostic.severity {
            Severity::Warning => codespan::Severity::Warning,
            Severity::Error => codespan::Severity::Error,
        };
        let labels = diagnostic.labels.iter().enumerate().filter_map(|(i, label)| {
            let range = self.view(label.span.file).ok()?.range(label.span);
            let style = if i == 0 { codespan::LabelStyle::Primary } else { codespan::LabelStyle::Secondary };
            Some(codespan::Label::new(style, label.span.file, range).with_message(clipped(&label.text)))
        });
        codespan::Diagnostic::new(severity)
            .with_code(diagnostic.code)
            .with_message(clipped(&diagnostic.title))
            .with_labels(labels.collect())
            .with_notes(diagnostic.help.iter().map(|h| format!("help: {}", clipped(h))).collect())
    }

    fn view(&self, file: FileId) -> Result<&View<'m>, Error> {
        self.files.iter().find(|(f, _)| *f == file).map(|(_, view)| view).ok_or(Error::FileMissing)
    }
}

impl<'m> View<'m> {
    fn new(name: &'m str, whole: Cow<'m, str>, spans: impl Iterator<Item = Span>) -> Self {
        let source: &str = &whole;
        let starts: Vec<usize> = line_starts(source).collect();
        // Line, its bounds, and the window shown of it.
        let mut cuts: Vec<(usize, Range<usize>, Range<usize>)> = Vec::new();
        for offset in spans.flat_map(|s| [s.start as usize, s.end as usize]) {
            let at = floor(source, offset);
            let line = line_of(&starts, at);
            let bounds = starts[line]..starts.get(line + 1).map_or(source.len(), |next| next - 1);
            if bounds.len() > LONG_LINE && cuts.iter().all(|c| c.0 != line) {
                let from = floor(source, at.saturating_sub(WINDOW).max(bounds.start));
                let to = floor(source, (at + 2 * WINDOW).min(bounds.end)).max(from);
                cuts.push((line, bounds, from..to));
            }
        }
        if cuts.is_empty() {
            let pieces = vec![(0..source.len(), 0)];
            return Self { name, text: whole, starts, pieces, hidden: Vec::new() };
        }
        cuts.sort_by_key(|c| c.0);
        let mut text = String::new();
        let mut pieces = Vec::new();
        let mut hidden = Vec::new();
        let mut done = 0;
        for (line, bounds, window) in cuts {
            pieces.push((done..bounds.start, text.len()));
            text.push_str(&source[done..bounds.start]);
            if window.start > bounds.start {
                text.push_str(ELLIPSIS);
                hidden.push((line, source[bounds.start..window.start].chars().count()));
            }
            pieces.push((window.clone(), text.len()));
            text.push_str(&source[window.clone()]);
            if window.end < bounds.end {
                text.push_str(ELLIPSIS);
            }
            // The end of the line stays, so that lines keep their numbers.
            done = bounds.end;
        }
        pieces.push((done..source.len(), text.len()));
        text.push_str(&source[done..]);
        let starts = line_starts(&text).collect();
        Self { name, text: text.into(), starts, pieces, hidden }
    }

    /// Where the view shows a span of the file; what is cut off falls on the edge of the window before it.
    fn range(&self, span: Span) -> Range<usize> {
        let shown = |offset: usize| {
            let after = self.pieces.partition_point(|(file, _)| file.start <= offset);
            let (file, at) = &self.pieces[after.saturating_sub(1)];
            floor(&self.text, at + offset.min(file.end).saturating_sub(file.start))
        };
        let start = shown(span.start as usize);
        start..shown(span.end as usize).max(start)
    }
}

impl<'a> Files<'a> for Views<'_> {
    type FileId = FileId;
    type Name = &'a str;
    type Source = &'a str;

    fn name(&'a self, id: FileId) -> Result<&'a str, Error> {
        Ok(self.view(id)?.name)
    }

    fn source(&'a self, id: FileId) -> Result<&'a str, Error> {
        Ok(&self.view(id)?.text)
    }

    fn line_index(&'a self, id: FileId, byte: usize) -> Result<usize, Error> {
        Ok(line_of(&self.view(id)?.starts, byte))
    }

    fn line_range(&'a self, id: FileId, line: usize) -> Result<Range<usize>, Error> {
        let view = self.view(id)?;
        let max = view.starts.len() - 1;
        let start = *view.starts.get(line).ok_or(Error::LineTooLarge { given: line, max })?;
        Ok(start..view.starts.get(line + 1).copied().unwrap_or(view.text.len()))
    }

    fn column_number(&'a self, id: FileId, line: usize, byte: usize) -> Result<usize, Error> {
        let view = self.view(id)?;
        let shown = view.text[view.starts[line]..floor(&view.text, byte)].chars().count();
        let hidden = view.hidden.iter().find(|(l, _)| *l == line);
        Ok(1 + hidden.map_or(shown, |(_, n)| n + shown.saturating_sub(ELLIPSIS.len())))
    }
}

/// The text with characters that a terminal would obey (control codes, changes of writing direction) replaced by
/// visible ones of the same length, so that offsets stay.
fn harmless(text: &str) -> Cow<'_, str> {
    let stand_in = |c: char| match c {
        '\t' | '\n' | '\r' => c,
        '\0'..='\u{1F}' | '\u{7F}' => '?',
        '\u{80}'..='\u{9F}' => '¤',
        '\u{200E}' | '\u{200F}' | '\u{202A}'..='\u{202E}' | '\u{2066}'..='\u{2069}' => '\u{FFFD}',
        _ => c,
    };
    if text.chars().any(|c| stand_in(c) != c) { text.chars().map(stand_in).collect() } else { text.into() }
}

/// A message made harmless, without the middle of what is too long in it.
fn clipped(message: &str) -> Cow<'_, str> {
    let message = harmless(message);
    if message.len() <= LONG_MESSAGE {
        return message;
    }
    let (head, tail) = (floor(&message, LONG_MESSAGE / 2), floor(&message, message.len() - LONG_MESSAGE / 4));
    format!("{}{ELLIPSIS}{}", &message[..head], &message[tail..]).into()
}

/// The line, counted from 0, that holds the byte.
fn line_of(starts: &[usize], byte: usize) -> usize {
    starts.partition_point(|&start| start <= byte).saturating_sub(1)
}

/// The nearest character boundary at or before `offset`, within the text.
fn floor(text: &str, offset: usize) -> usize {
    text.floor_char_boundary(offset)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn show(text: &str, start: u32, end: u32) -> String {
        let mut map = SourceMap::default();
        let file = map.add("a.imp", text);
        let diagnostic = Diagnostic::error("E0203", "`sqrt` takes 1 argument, found 2")
            .at(Span { file, start, end }, "unexpected second argument")
            .help("write `hypot(x, y)`");
        render(&map, &[diagnostic], false)
    }

    #[test]
    fn the_excerpt_stands_under_the_title() {
        let want = "error[E0203]: `sqrt` takes 1 argument, found 2
  ┌─ a.imp:2:17
  │
2 │ let r = sqrt(x, y)
  │                 ^ unexpected second argument
  │
  = help: write `hypot(x, y)`

";
        assert_eq!(show("# first\nlet r = sqrt(x, y)\n", 24, 25), want);
    }

    #[test]
    fn long_lines_show_a_window() {
        let long = format!("# first\n{}@{}\nlast\n", "1 + ".repeat(1000), " + é".repeat(1000));
        let shown = show(&long, 8 + 4000, 8 + 4001);
        assert!(shown.contains("a.imp:2:4001"), "{shown}");
        assert!(shown.contains("2 │ ...1 + 1") && shown.contains(" + ...\n"), "{shown}");
        assert!(shown.lines().all(|l| l.chars().count() < 250), "{shown}");
        let caret = shown.lines().find(|l| l.contains('^')).and_then(|l| l.chars().position(|c| c == '^'));
        let at = shown.lines().find(|l| l.contains('@')).and_then(|l| l.chars().position(|c| c == '@'));
        assert_eq!(caret, at, "{shown}");
    }

    #[test]
    fn long_messages_lose_their_middle() {
        let long = format!("unknown name `{}`", "é".repeat(100_000));
        assert!(clipped(&long).len() < 2 * LONG_MESSAGE && clipped(&long).ends_with("é`"));
        assert_eq!(clipped("short"), "short");
    }

    #[test]
    fn spans_outside_of_the_text_are_moved_into_it() {
        for (start, end) in [(0, 0), (3, 9), (100, 200), (5, 2), (1, 2), (u32::MAX, u32::MAX)] {
            assert!(show("é\nab\n", start, end).contains("error[E0203]"));
        }
        assert!(show("", 0, 1).contains("a.imp:1:1"));
    }

    #[test]
    fn terminals_are_not_commanded() {
        let shown = show("let a = \u{1b}[31m\u{9b}\u{202e} 1", 8, 9);
        assert!(shown.contains("let a = ?[31m¤\u{FFFD} 1"), "{shown}");
    }

    #[test]
    fn colours_are_escape_sequences() {
        let mut map = SourceMap::default();
        let file = map.add("a.imp", "x");
        let diagnostic = Diagnostic::error("E0101", "t").at(Span { file, start: 0, end: 1 }, "");
        assert!(render(&map, &[diagnostic], true).contains("\u{1b}["));
    }
}
