//! The canonical layout of a file: spaces, indents and blank lines, with every token and comment as it was written.
//!
//! Between two tokens stands one blank, except: none inside brackets and bars, around `^`, behind a sign, before
//! `,` `;` `:`; and between factors that stand side by side, as between a name and its bracket, a blank stays if
//! there was one (`2x`, `phi^2 x^2`). Line ends stay. A statement begins at the left margin; a line that continues it
//! is indented by four blanks for each open bracket, and by four without any.

use crate::diagnostic::Diagnostic;
use crate::diagnostic::FileId;
use crate::syntax::filter;
use crate::syntax::groups;
use crate::syntax::parse;
use crate::syntax::report::Reporter;
use crate::syntax::token;
use crate::syntax::token::Lexeme;
use crate::syntax::token::Token;

/// The text in canonical layout; it reads as the same module, and formatting it again changes nothing. Fails with
/// the messages of [`parse`], because what a text means decides where its blanks go.
pub fn format(file: FileId, text: &str) -> Result<String, Vec<Diagnostic>> {
    let (_, found) = parse(file, text);
    if !found.is_empty() {
        return Err(found);
    }
    let mut reporter = Reporter::new(file, text);
    let mut printer = Printer { text, out: String::with_capacity(text.len()), line: Line::Fresh, depth: 0, last: None };
    // The statements' tokens in order: bars know their direction there, and statements where they begin.
    let mut meaning = Vec::new();
    for group in groups(&mut reporter) {
        let tokens = filter::filter(&mut reporter, &group.tokens).unwrap_or(group.tokens);
        let tokens = tokens.into_iter().filter(|l| l.token != Token::Juxtaposed);
        meaning.extend(tokens.enumerate().map(|(i, lexeme)| (lexeme, i == 0)));
    }
    let mut meaning = meaning.into_iter();
    for lexeme in token::lex(text) {
        match lexeme.token {
            Token::Newline => printer.newline(),
            Token::Comment => printer.comment(lexeme),
            Token::Semicolon => printer.token(lexeme, false),
            _ => {
                if let Some((lexeme, begins)) = meaning.next() {
                    printer.token(lexeme, begins);
                }
            }
        }
    }
    Ok(printer.finish())
}

/// What stands on the line so far.
#[derive(Clone, Copy)]
enum Line {
    /// Nothing, after at least one line of text or at the start of the file.
    Fresh,
    /// Nothing, and the line above is blank.
    Blank,
    /// A token or comment.
    Text,
}

struct Printer<'t> {
    text: &'t str,
    out: String,
    line: Line,
    /// Open brackets of the statement.
    depth: usize,
    /// The last token of the statement that has begun and not ended, on whichever line.
    last: Option<Last>,
}

#[derive(Clone, Copy)]
struct Last {
    token: Token,
    end: u32,
    /// A `-` with no operand on its left.
    sign: bool,
}

impl Printer<'_> {
    fn newline(&mut self) {
        self.line = match self.line {
            Line::Text => {
                self.out.push('\n');
                Line::Fresh
            }
            // Blank lines at the start of the file go; several become one.
            Line::Fresh if self.out.is_empty() => Line::Fresh,
            Line::Fresh | Line::Blank => Line::Blank,
        };
    }

    fn comment(&mut self, comment: Lexeme) {
        let text = self.text[comment.start as usize..comment.end as usize].trim_end();
        if matches!(self.line, Line::Text) {
            self.out.push_str("  ");
        } else {
            self.begin_line(if self.last.is_some() { self.depth } else { 0 });
        }
        self.out.push_str(text);
        self.line = Line::Text;
    }

    fn token(&mut self, lexeme: Lexeme, begins: bool) {
        let token = lexeme.token;
        let closes = matches!(token, Token::RightParen | Token::RightBracket);
        if begins {
            (self.depth, self.last) = (0, None);
        }
        if closes {
            self.depth = self.depth.saturating_sub(1);
        }
        if matches!(self.line, Line::Text) {
            let blank = self.last.map_or(token != Token::Semicolon, |last| blank_between(last, lexeme));
            self.out.push_str(if blank { " " } else { "" });
        } else {
            let continues = self.last.is_some() && token != Token::Semicolon;
            let levels = if continues && !closes { self.depth.max(1) } else { self.depth };
            self.begin_line(levels);
        }
        self.out.push_str(&self.text[lexeme.start as usize..lexeme.end as usize]);
        if matches!(token, Token::LeftParen | Token::LeftBracket) {
            self.depth += 1;
        }
        let sign = token == Token::Minus && self.last.is_none_or(|l| !l.token.ends_operand());
        self.last = if token == Token::Semicolon { None } else { Some(Last { token, end: lexeme.end, sign }) };
        self.line = Line::Text;
    }

    fn begin_line(&mut self, levels: usize) {
        if matches!(self.line, Line::Blank) {
            self.out.push('\n');
        }
        self.out.extend(std::iter::repeat_n(' ', 4 * levels));
    }

    fn finish(mut self) -> String {
        if !self.out.is_empty() && !self.out.ends_with('\n') {
            self.out.push('\n');
        }
        self.out
    }
}

fn blank_between(last: Last, next: Lexeme) -> bool {
    use Token::{BarClose, BarOpen, Caret, Colon, Comma, LeftBracket, LeftParen};
    use Token::{RightBracket, RightParen, Semicolon, Superscript};
    if last.sign || matches!(last.token, LeftParen | LeftBracket | BarOpen | Caret) {
        return false;
    }
    if matches!(next.token, RightParen | RightBracket | BarClose | Caret | Superscript | Comma | Semicolon | Colon) {
        return false;
    }
    let side_by_side = last.token.ends_operand() && next.token.begins_operand();
    !side_by_side || last.end < next.start
}
