//! Spellings of other languages: each is reported with what it is called here, and read as that, so that the rest
//! of the statement is still checked.

use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::syntax::literal::MAX_DECIMAL;
use crate::syntax::report::Reporter;
use crate::syntax::token::Lexeme;
use crate::syntax::token::Token;

/// Reports tokens that are not of this language and puts in what was meant. Answers where that is only a guess, in
/// ascending order.
pub fn repair(reporter: &mut Reporter<'_>, lexemes: &mut [Lexeme]) -> Vec<u32> {
    let mut guesses = Vec::new();
    for lexeme in lexemes {
        let (diagnostic, meant) = match lexeme.token {
            Token::Foreign => foreign(reporter, *lexeme),
            Token::Unknown => (unknown(reporter, *lexeme), None),
            Token::BadHexadecimal => (hexadecimal(reporter, *lexeme), Some(Token::Number)),
            Token::OpenText => (open_text(reporter, *lexeme), Some(Token::Text)),
            _ => continue,
        };
        reporter.report(diagnostic);
        if meant.is_none() {
            guesses.push(lexeme.start);
        }
        lexeme.token = meant.unwrap_or(Token::Number);
    }
    guesses
}

fn foreign(reporter: &Reporter<'_>, lexeme: Lexeme) -> (Diagnostic, Option<Token>) {
    let text = reporter.text_of(lexeme);
    let (offer, meant) = match text {
        "**" => ("a power is written `^`", Some(Token::Caret)),
        "==" | "===" | ":=" => ("write `=`", Some(Token::Equal)),
        "!==" | "<>" => ("write `!=`", Some(Token::NotEqual)),
        "&" | "&&" => ("write `and`", Some(Token::And)),
        "!" | "~" => ("for the opposite of a condition write `not`", None),
        "%" => ("for the remainder write `mod(a, b)`", Some(Token::Star)),
        "{" => ("brackets are `(` `)` here; a condition follows the word `where`", Some(Token::LeftParen)),
        "}" => ("brackets are `(` `)` here", Some(Token::RightParen)),
        "=>" => ("greater or equal is written `>=`", Some(Token::GreaterEqual)),
        "=<" => ("less or equal is written `<=`", Some(Token::LessEqual)),
        "//" | "/*" => ("a comment begins with `#`", None),
        "->" => ("a function is written `fn f(x) = ...`", None),
        "?" => ("a choice is written `if c then a else b`", None),
        "√" => ("write `sqrt(...)`", None),
        _ => ("bounds are numbers; leave a side out or choose a large one", None),
    };
    let title = format!("Imp does not write `{text}`");
    (Diagnostic::error(code::FOREIGN_OPERATOR, title).at(reporter.at(lexeme), "").help(offer), meant)
}

fn unknown(reporter: &Reporter<'_>, lexeme: Lexeme) -> Diagnostic {
    const SHOWN: usize = 8;
    let text = reporter.text_of(lexeme);
    let mut shown: String = text.chars().take(SHOWN).map(visible).collect();
    if text.chars().nth(SHOWN).is_some() {
        shown.push_str("...");
    }
    let single = text.chars().nth(1).is_none();
    let title = if single { format!("unknown character `{shown}`") } else { format!("unknown characters `{shown}`") };
    let diagnostic = Diagnostic::error(code::UNKNOWN_CHARACTER, title).at(reporter.at(lexeme), "");
    match text.chars().next() {
        Some('‘' | '’' | '′') => diagnostic.help("the mark behind a name is a straight `'`"),
        Some('\'' | '“' | '”' | '„' | '«' | '»' | '`') => {
            diagnostic.help("text stands in straight quotes: `\"...\"`")
        }
        Some('.') => diagnostic.help("a point stands only inside a number, as in `0.5`"),
        Some('∪') => diagnostic.help("write `union(a, b)`"),
        Some('∩') => diagnostic.help("write `intersect(a, b)`"),
        Some('‖') => diagnostic.help("for a distance write `hypot(x, y)`"),
        Some('\u{300}'..='\u{36F}') => diagnostic.help("write the letter without its combining mark"),
        _ => diagnostic.help("names are letters, digits, `_` and a trailing `'`"),
    }
}

/// The character itself where it can be seen on its own.
fn visible(c: char) -> String {
    let unseen = c.is_control()
        || matches!(c, '\u{300}'..='\u{36F}' | '\u{200C}'..='\u{200F}' | '\u{2028}'..='\u{202E}' | '\u{2066}'..='\u{2069}');
    if unseen { c.escape_unicode().to_string() } else { c.to_string() }
}

fn hexadecimal(reporter: &Reporter<'_>, lexeme: Lexeme) -> Diagnostic {
    let text = reporter.text_of(lexeme);
    let readable = text.len() < 40 && text[2..].bytes().all(|b| b.is_ascii_hexdigit() || b == b'.');
    let power = if readable { format!("{text}p0") } else { "0x1.8p+1".to_string() };
    Diagnostic::error(code::BAD_NUMBER, "a hexadecimal number needs its power of two")
        .at(reporter.at(lexeme), "no `p` with an exponent here")
        .help(format!("write `{power}`, where `p` stands before the power of two"))
        .help("for 0 times a name put a blank between them")
}

fn open_text(reporter: &Reporter<'_>, lexeme: Lexeme) -> Diagnostic {
    Diagnostic::error(code::OPEN_TEXT, "this text is never closed")
        .at(reporter.at(lexeme), "it must end on this line")
        .help("put a `\"` at its end")
}

/// A literal past the bounds of `literal`.
pub fn too_large(reporter: &mut Reporter<'_>, start: u32, end: u32) {
    let span = reporter.span(start, end);
    reporter.report(
        Diagnostic::error(code::NUMBER_TOO_LARGE, "this number is too large to be kept exactly")
            .at(span, "too many digits, or too large an exponent")
            .help(format!("exact constants have up to {MAX_DECIMAL} digits and powers of ten up to {MAX_DECIMAL}")),
    );
}
