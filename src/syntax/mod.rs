//! Source text to tokens to AST; no meaning.
//!
//! ```text
//! text -lex-> tokens -repair-> -layout-> one group a statement -filter-> -grammar-> AST
//! ```
//!
//! Nothing here panics or recurses without bound, whatever the text: every statement is read by itself, nesting is
//! capped before the grammar sees it, and chains of operands are flat.

mod actions;
pub mod ast;
mod bars;
pub mod dump;
mod explain;
mod filter;
pub mod format;
mod functions;
mod layout;
mod literal;
mod repair;
mod report;
mod token;

use lalrpop_util::ParseError;

use crate::diagnostic::Diagnostic;
use crate::diagnostic::FileId;
use crate::diagnostic::code;
use crate::syntax::ast::Expr;
use crate::syntax::ast::Module;
use crate::syntax::ast::Statement;
use crate::syntax::explain::Stop;
use crate::syntax::layout::Group;
use crate::syntax::report::Reporter;
use crate::syntax::token::Lexeme;
use crate::syntax::token::Token;

pub use crate::syntax::filter::MAX_DEPTH;
pub use crate::syntax::filter::MAX_NODES;
pub use crate::syntax::functions::FUNCTIONS;
pub use crate::syntax::layout::wants_more;

#[allow(clippy::all, clippy::pedantic, missing_docs)]
mod grammar {
    include!(concat!(env!("OUT_DIR"), "/imp.rs"));
}

/// Reads a file. Statements with errors are left out of the module; the messages come in the order of the text.
/// An empty file is an empty module.
pub fn parse(file: FileId, text: &str) -> (Module, Vec<Diagnostic>) {
    let mut reporter = Reporter::new(file, text);
    let mut module = Module::default();
    let parser = grammar::StatementParser::new();
    for group in groups(&mut reporter) {
        let before = reporter.count();
        let kind = filter::filter(&mut reporter, &group.tokens)
            .and_then(|tokens| run(&mut reporter, &tokens, |r, input| parser.parse(r, input)));
        if let Some(kind) = &kind {
            kind.expressions(|expr| filter::nodes(&mut reporter, expr));
        }
        if let Some(kind) = kind
            && reporter.count() == before
            && !group.faulty
        {
            let span = reporter.span(group.tokens[0].start, group.tokens[group.tokens.len() - 1].end);
            module.statements.push(Statement { span, doc: group.doc, kind });
        }
    }
    (module, reporter.finish())
}

/// Reads one expression, for `imp eval`, the REPL and values on the command line. Line ends count as blanks.
///
/// Fails with the messages to show: at least one.
pub fn parse_expression(file: FileId, text: &str) -> Result<Expr, Vec<Diagnostic>> {
    let mut reporter = Reporter::new(file, text);
    let Lexed { mut lexemes, .. } = lex(&mut reporter);
    lexemes.retain(|l| !matches!(l.token, Token::Newline | Token::Comment));
    if let Some(semicolon) = lexemes.iter().find(|l| l.token == Token::Semicolon) {
        let diagnostic = Diagnostic::error(code::UNEXPECTED, "one expression is expected here");
        reporter.report(diagnostic.at(reporter.at(*semicolon), "`;` ends a statement"));
    } else if lexemes.is_empty() && reporter.found.is_empty() {
        let diagnostic = Diagnostic::error(code::MISSING_OPERAND, "an expression is expected here");
        reporter.report(diagnostic.at(reporter.span(0, 0), "nothing is written"));
    }
    if !reporter.found.is_empty() {
        return Err(reporter.finish());
    }
    let expr = filter::filter(&mut reporter, &lexemes).and_then(|tokens| {
        let parser = grammar::ExpressionParser::new();
        run(&mut reporter, &tokens, |r, input| parser.parse(r, input))
    });
    if let Some(expr) = &expr {
        filter::nodes(&mut reporter, expr);
    }
    match expr {
        Some(expr) if reporter.found.is_empty() => Ok(expr),
        _ => Err(reporter.finish()),
    }
}

/// The tokens of a text, with spellings of other languages reported and replaced.
fn lex(reporter: &mut Reporter<'_>) -> Lexed {
    if reporter.text.len() > token::MAX_BYTES {
        reporter.report(Diagnostic::error(code::FILE_TOO_LARGE, "this file is too large: 4 GiB or more"));
        return Lexed::default();
    }
    let mut lexemes = token::lex(reporter.text);
    let guesses = repair::repair(reporter, &mut lexemes);
    Lexed { lexemes, guesses }
}

/// The statements of a file that are worth reading further: what repair could only guess at is left out, because
/// every further message about it would be about the guess.
fn groups(reporter: &mut Reporter<'_>) -> Vec<Group> {
    let Lexed { lexemes, guesses } = lex(reporter);
    let mut groups = layout::statements(reporter, &lexemes);
    let mut faults = reporter.places.clone();
    faults.sort_unstable();
    let within = |sorted: &[u32], group: &Group| {
        let (start, end) = (group.tokens[0].start, group.tokens[group.tokens.len() - 1].end);
        sorted.get(sorted.partition_point(|&f| f < start)).is_some_and(|&f| f < end)
    };
    groups.retain(|group| !within(&guesses, group));
    for group in &mut groups {
        group.faulty = within(&faults, group);
    }
    groups
}

#[derive(Default)]
struct Lexed {
    lexemes: Vec<Lexeme>,
    /// Where tokens were put in whose meaning is a guess, ascending.
    guesses: Vec<u32>,
}

/// Feeds tokens to one of the grammar's parsers; a failure is reported.
fn run<'t, T>(
    reporter: &mut Reporter<'t>,
    tokens: &[Lexeme],
    parse: impl FnOnce(
        &mut Reporter<'t>,
        &mut dyn Iterator<Item = (u32, Token, u32)>,
    ) -> Result<T, ParseError<u32, Token, ()>>,
) -> Option<T> {
    let mut input = tokens.iter().map(|l| (l.start, l.token, l.end));
    let error = match parse(reporter, &mut input) {
        Ok(value) => return Some(value),
        Err(error) => error,
    };
    let (at, expected) = match error {
        ParseError::UnrecognizedToken { token: (start, token, _), expected } => (Some((start, token)), expected),
        ParseError::ExtraToken { token: (start, token, _) } => (Some((start, token)), Vec::new()),
        ParseError::UnrecognizedEof { expected, .. } => (None, expected),
        ParseError::InvalidToken { .. } | ParseError::User { .. } => (None, Vec::new()),
    };
    let at = at.and_then(|(start, token)| tokens.iter().position(|l| (l.start, l.token) == (start, token)));
    let stop = Stop { tokens, at: at.unwrap_or(tokens.len()), expected: &expected };
    let diagnostic = explain::explain(reporter, &stop);
    reporter.report(diagnostic);
    None
}
