//! Which lines belong together: tokens cut into statements (language rule 2), each with the comment that documents it.

use crate::diagnostic::Diagnostic;
use crate::diagnostic::FileId;
use crate::diagnostic::code;
use crate::syntax::report::Reporter;
use crate::syntax::token::Lexeme;
use crate::syntax::token::Token;
use crate::syntax::token::lex;

/// The tokens of one statement, without comments and line ends; never empty.
#[derive(Debug, Clone, Default)]
pub struct Group {
    pub tokens: Vec<Lexeme>,
    /// The comment lines directly above, without `#` and the blank after it.
    pub doc: Vec<String>,
    /// An error inside it is already reported: it is read for more errors, but yields no statement.
    pub faulty: bool,
}

/// Cuts the tokens of a file into statements.
pub fn statements(reporter: &mut Reporter<'_>, lexemes: &[Lexeme]) -> Vec<Group> {
    let mut cut = Cut { reporter, out: Vec::new(), current: Group::default(), depth: 0 };
    // Comment lines seen since the last blank line or token: the documentation of what comes next.
    let mut doc: Vec<String> = Vec::new();
    let mut fresh_line = true;
    let mut blank = true;
    for &lexeme in lexemes {
        match lexeme.token {
            Token::Newline => {
                if blank {
                    doc.clear();
                }
                (fresh_line, blank) = (true, true);
            }
            Token::Comment => {
                if fresh_line {
                    let text = cut.reporter.text_of(lexeme)[1..].trim_end();
                    doc.push(text.strip_prefix(' ').unwrap_or(text).to_string());
                }
                (fresh_line, blank) = (false, false);
            }
            Token::Semicolon => {
                cut.finish();
                (fresh_line, blank) = (false, false);
            }
            _ => {
                if fresh_line && cut.starts_anew(lexeme) {
                    cut.finish();
                }
                cut.push(lexeme, &mut doc);
                doc.clear();
                (fresh_line, blank) = (false, false);
            }
        }
    }
    cut.finish();
    cut.out
}

struct Cut<'r, 't> {
    reporter: &'r mut Reporter<'t>,
    out: Vec<Group>,
    current: Group,
    /// Open brackets of the current statement.
    depth: u32,
}

impl Cut<'_, '_> {
    fn finish(&mut self) {
        self.depth = 0;
        if !self.current.tokens.is_empty() {
            self.out.push(std::mem::take(&mut self.current));
        }
    }

    fn push(&mut self, lexeme: Lexeme, doc: &mut Vec<String>) {
        if self.current.tokens.is_empty() {
            self.current.doc = std::mem::take(doc);
        }
        match lexeme.token {
            Token::LeftParen | Token::LeftBracket => self.depth += 1,
            Token::RightParen | Token::RightBracket => self.depth = self.depth.saturating_sub(1),
            _ => {}
        }
        self.current.tokens.push(lexeme);
    }

    /// Whether `next`, the first token of a line, opens a new statement.
    fn starts_anew(&mut self, next: Lexeme) -> bool {
        let Some(&last) = self.current.tokens.last() else { return false };
        // Also inside an open bracket, so that a forgotten `)` does not swallow the rest of the file.
        if next.token.opens_statement() {
            return true;
        }
        if self.depth > 0 || self.continues_after(last) {
            return false;
        }
        if !next.token.continues_before() {
            return true;
        }
        if next.token == Token::Minus && self.column(next.start) <= self.indent() {
            let span = self.reporter.at(next);
            self.reporter.report(
                Diagnostic::error(code::AMBIGUOUS_LINE, "this line may continue the one before or begin anew")
                    .at(span, "`-` subtracts from the line above, or it is the sign of a new formula")
                    .at(self.reporter.at(last), "the line above ends here")
                    .help("to continue: indent this line, or move the `-` to the end of the line above")
                    .help("to begin a new statement: end the line above with `;`"),
            );
        }
        false
    }

    /// Whether the line that ends with `last` goes on. In a domain that includes an `x` behind a range.
    fn continues_after(&self, last: Lexeme) -> bool {
        let tokens = &self.current.tokens;
        let domain = tokens[0].token == Token::Domain && last.token == Token::Name && tokens.len() > 2;
        last.token.continues_after()
            || (domain
                && tokens[tokens.len() - 2].token.ends_operand()
                && matches!(self.reporter.text_of(last), "x" | "X"))
    }

    /// How far the line on which the current statement begins is indented, in characters.
    fn indent(&self) -> usize {
        let start = self.current.tokens[0].start;
        let line = self.line_start(start);
        self.reporter.text[line..].chars().take_while(|c| c.is_whitespace() && !matches!(c, '\n' | '\r')).count()
    }

    fn column(&self, offset: u32) -> usize {
        self.reporter.text[self.line_start(offset)..offset as usize].chars().count()
    }

    fn line_start(&self, offset: u32) -> usize {
        self.reporter.text[..offset as usize].rfind(['\n', '\r']).map_or(0, |i| i + 1)
    }
}

/// Whether more must be typed before `text` is a statement: a bracket is open, or the last line ends in an operator,
/// a comma or a word that wants company. For a REPL.
pub fn wants_more(text: &str) -> bool {
    let lexemes = lex(text);
    let mut reporter = Reporter::new(FileId(0), text);
    let mut cut = Cut { reporter: &mut reporter, out: Vec::new(), current: Group::default(), depth: 0 };
    for &lexeme in &lexemes {
        match lexeme.token {
            Token::Newline | Token::Comment => {}
            Token::Semicolon => cut.finish(),
            _ => cut.push(lexeme, &mut Vec::new()),
        }
    }
    cut.current.tokens.last().is_some_and(|&last| cut.depth > 0 || cut.continues_after(last))
}
