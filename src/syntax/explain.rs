//! From "the parser did not expect this token" to a message about the user's problem.

use crate::diagnostic::Diagnostic;
use crate::diagnostic::Span;
use crate::diagnostic::code;
use crate::diagnostic::did_you_mean;
use crate::syntax::actions;
use crate::syntax::report::Reporter;
use crate::syntax::token::Lexeme;
use crate::syntax::token::Token;

/// The words that open a statement, for corrections.
const OPENERS: [&str; 7] = ["let", "fn", "param", "surface", "curve", "domain", "import"];

/// Where the grammar stopped: the statement's tokens, the index of the one it could not use (their number at the
/// end), and what it could have used, as the grammar names it.
pub struct Stop<'s> {
    pub tokens: &'s [Lexeme],
    pub at: usize,
    pub expected: &'s [String],
}

impl Stop<'_> {
    fn expects(&self, name: &str) -> bool {
        self.expected.iter().any(|e| e.trim_matches('"') == name)
    }

    fn found(&self) -> Option<Lexeme> {
        self.tokens.get(self.at).copied()
    }

    /// Where an expression that begins at the stop can reach at most: the end of the bracket, argument or statement.
    fn reach(&self) -> u32 {
        let mut depth = 0usize;
        let mut end = self.found().map_or(0, |l| l.end);
        for lexeme in &self.tokens[self.at..] {
            match lexeme.token {
                Token::LeftParen | Token::LeftBracket => depth += 1,
                Token::RightParen | Token::RightBracket if depth > 0 => depth -= 1,
                Token::RightParen | Token::RightBracket => break,
                Token::Comma | Token::Where if depth == 0 => break,
                _ => {}
            }
            end = lexeme.end;
        }
        end
    }

    fn before(&self) -> Option<Lexeme> {
        // The sign of a product without a sign is nowhere in the text.
        let behind = self.tokens[..self.at].iter().rev();
        behind.copied().find(|l| l.token != Token::Juxtaposed)
    }
}

/// The message for a statement that the grammar could not read.
pub fn explain(r: &Reporter<'_>, stop: &Stop<'_>) -> Diagnostic {
    let special = misspelt_opener(r, stop).or_else(|| second_statement(r, stop)).or_else(|| header(r, stop));
    special.or_else(|| missing_operand(r, stop)).unwrap_or_else(|| misplaced(r, stop))
}

/// The place of the stop: the token found, or the last one where the statement ended too early.
fn place(r: &Reporter<'_>, stop: &Stop<'_>) -> Span {
    match (stop.found(), stop.before()) {
        (Some(found), _) => r.at(found),
        (None, Some(last)) => r.at(last),
        (None, None) => r.span(0, 0),
    }
}

/// A statement whose fixed parts are missing.
fn header(r: &Reporter<'_>, stop: &Stop<'_>) -> Option<Diagnostic> {
    let (model, wanted) = match stop.tokens.first()?.token {
        Token::Let => ("let NAME = VALUE", &["NAME", "="][..]),
        Token::Fn => ("fn NAME(PARAMETER, ...) = VALUE", &["NAME", "(", "="][..]),
        Token::Param => ("param NAME = VALUE in [LOW, HIGH]", &["NAME", "=", "[", "in"][..]),
        Token::Surface => ("surface NAME: EQUATION", &["NAME", ":"][..]),
        Token::Curve => ("curve NAME: EQUATION", &["NAME", ":"][..]),
        Token::Domain => ("domain [LOW, HIGH]^3", &["[", "BOX_TIMES"][..]),
        Token::Import => ("import \"FILE\"", &["TEXT"][..]),
        _ => return None,
    };
    // Past its fixed parts a statement is an expression like any other, where an `=` may be due again.
    let past = |sign: &str| match sign {
        "=" => stop.tokens[..stop.at].iter().any(|l| l.token == Token::Equal),
        ":" => stop.tokens[..stop.at].iter().any(|l| l.token == Token::Colon),
        _ => stop.expects("NUMBER"),
    };
    let missing = wanted.iter().find(|w| stop.expects(w) && !past(w))?;
    let word = r.text_of(stop.tokens[0]);
    let span = place(r, stop);
    if let Some(found) = stop.found()
        && *missing == "NAME"
        && found.token.is_keyword()
    {
        let name = r.text_of(found);
        let title = format!("`{name}` is a word of the language and cannot be a name");
        return Some(Diagnostic::error(code::RESERVED_WORD, title).at(span, "choose another name"));
    }
    let range = stop.found().is_some_and(|l| l.token == Token::LeftBracket);
    if range || *missing != "in" {
        let model = if *missing == "BOX_TIMES" { "domain [LOW, HIGH] x [LOW, HIGH]" } else { model };
        let what = match *missing {
            "NAME" => "a name".to_string(),
            "TEXT" => "a file name in quotes".to_string(),
            "BOX_TIMES" => "an `x` between its ranges".to_string(),
            sign => format!("`{sign}`"),
        };
        let label = if stop.found().is_some() { "expected before this" } else { "expected after this" };
        return Some(
            Diagnostic::error(code::INCOMPLETE_STATEMENT, format!("this `{word}` lacks {what}"))
                .at(span, label)
                .help(format!("it is written `{model}`")),
        );
    }
    None
}

/// An operand was due, but the statement ends or goes on with something else.
fn missing_operand(r: &Reporter<'_>, stop: &Stop<'_>) -> Option<Diagnostic> {
    if !stop.expects("NUMBER") && !stop.expects("NAME") {
        return None;
    }
    let error = |title: String| Diagnostic::error(code::MISSING_OPERAND, title);
    let quote = |lexeme: Lexeme| r.quote(lexeme);
    let (before, found) = (stop.before(), stop.found());
    if let Some(found) = found
        && before.is_some_and(|l| l.token == Token::Caret)
        && !stop.expects("NAME")
    {
        return Some(actions::bad_repetition(r.at(found)));
    }
    Some(match (before, found) {
        (Some(before), Some(found)) if matches!(found.token, Token::If | Token::Not) => {
            let word = r.text_of(found);
            let what = if found.token == Token::If { "a choice" } else { "a `not`" };
            error(format!("{what} inside a formula needs brackets"))
                .at(r.at(found), format!("`{word}` reaches as far right as it can"))
                .at(r.at(before), "and would stand under this")
                .help(match r.excerpt(found.start, stop.reach()) {
                    Some(inner) => format!("write `({inner})`"),
                    None => format!("put `(` before `{word}` and `)` where it ends"),
                })
        }
        (Some(before), None) => {
            error(format!("nothing follows {}", quote(before))).at(r.at(before), "this needs something on its right")
        }
        (Some(before), Some(found)) => match (before.token, found.token) {
            (Token::LeftParen | Token::LeftBracket, Token::RightParen | Token::RightBracket) => {
                error("these brackets are empty".into()).at(r.span(before.start, found.end), "")
            }
            (Token::LeftParen | Token::LeftBracket | Token::Comma | Token::BarOpen | Token::Colon, sign)
                if sign.is_binary() =>
            {
                nothing_left(r, found)
            }
            (_, Token::Plus) => nothing_left(r, found),
            _ => error(format!("nothing stands between {} and {}", quote(before), quote(found)))
                .at(r.at(found), "")
                .at(r.at(before), "this needs something on its right"),
        },
        (None, Some(found)) if found.token.is_binary() => nothing_left(r, found),
        (None, _) => return None,
    })
}

fn nothing_left(r: &Reporter<'_>, sign: Lexeme) -> Diagnostic {
    let text = r.text_of(sign);
    let diagnostic =
        Diagnostic::error(code::MISSING_OPERAND, format!("nothing stands on the left of `{text}`")).at(r.at(sign), "");
    if sign.token == Token::Plus { diagnostic.help("a positive number needs no `+`") } else { diagnostic }
}

/// A complete operand is followed by something that cannot follow it.
fn misplaced(r: &Reporter<'_>, stop: &Stop<'_>) -> Diagnostic {
    let span = place(r, stop);
    let Some(found) = stop.found() else {
        return match () {
            () if stop.expects("then") => lacks(span, "this `if` lacks its `then`"),
            () if stop.expects("else") => lacks(span, "this `if` lacks its `else`"),
            () => Diagnostic::error(code::UNEXPECTED, "the statement ends too early").at(span, "after this"),
        };
    };
    // Side by side: the second operand is what the user sees.
    let shown = if found.token == Token::Juxtaposed { stop.tokens.get(stop.at + 1).copied() } else { Some(found) };
    let text = r.quote(shown.unwrap_or(found));
    let error = |title: String| Diagnostic::error(code::UNEXPECTED, title).at(span, "");
    match found.token {
        // The range of a domain or of a parameter: a list would also take other numbers of items.
        Token::RightBracket if stop.expects(",") && !stop.expects("]") => two_ends(span),
        Token::Comma if stop.expects("]") && !stop.expects(",") => two_ends(span),
        Token::Then | Token::Else if !stop.tokens[..stop.at].iter().any(|l| l.token == Token::If) => {
            error(format!("this {text} belongs to no `if`")).help("a choice is written `if c then a else b`")
        }
        _ if stop.expects("then") && !found.token.is_relation() => lacks(span, "this `if` lacks its `then`"),
        _ if stop.expects("else") && found.token != Token::Then => lacks(span, "this `if` lacks its `else`"),
        Token::Colon => error("only a surface or a curve has a name before `:`".into())
            .help("write `surface NAME: EQUATION` or `curve NAME: EQUATION`"),
        Token::Where => error("a condition stands at the end of a shape only".into())
            .help("write `surface NAME: EQUATION where CONDITION`"),
        Token::In => error("a range after `in` belongs to a `param`".into())
            .help("write `param NAME = VALUE in [LOW, HIGH]`, or two inequalities"),
        Token::Comma => error("a comma separates arguments inside brackets only".into())
            .help("write a list as `[a, b]`; separate statements by a new line or `;`"),
        Token::Superscript | Token::Caret => {
            error(format!("a raised power is followed by {text}")).help("put brackets around one of the powers")
        }
        Token::Text => error("text can only be an argument, such as a file name".into()),
        token if token.is_relation() => error(format!("{text} cannot stand here"))
            .help("put the relation in brackets, or give it a name with `let`"),
        token if token.is_keyword() => error(format!("{text} cannot stand inside a formula")),
        _ => error(format!("{text} cannot stand here")),
    }
}

fn lacks(span: Span, title: &str) -> Diagnostic {
    Diagnostic::error(code::UNEXPECTED, title).at(span, "").help("a choice is written `if c then a else b`")
}

fn two_ends(span: Span) -> Diagnostic {
    Diagnostic::error(code::UNEXPECTED, "a range has two ends").at(span, "").help("write `[LOW, HIGH]`")
}

/// A word that opens statements inside of one.
fn second_statement(r: &Reporter<'_>, stop: &Stop<'_>) -> Option<Diagnostic> {
    let found = stop.found()?;
    let past_names = !stop.expects("NAME") || stop.expects("NUMBER");
    (found.token.opens_statement() && past_names).then(|| {
        let title = format!("`{}` begins a statement and cannot stand inside one", r.text_of(found));
        Diagnostic::error(code::UNEXPECTED, title).at(r.at(found), "").help("put it on a line of its own")
    })
}

/// `surfce s: ...`: the statement begins with two names, the first of which is nearly a word that opens statements.
fn misspelt_opener(r: &Reporter<'_>, stop: &Stop<'_>) -> Option<Diagnostic> {
    let [first, sign, second, ..] = stop.tokens else { return None };
    let names = first.token == Token::Name
        && sign.token == Token::Juxtaposed
        && matches!(second.token, Token::Name | Token::LeftBracket);
    let word = r.text_of(*first);
    let meant = did_you_mean(word, OPENERS).filter(|_| names)?;
    let title = format!("`{word}` does not begin a statement");
    let diagnostic = Diagnostic::error(code::UNEXPECTED, title).at(r.at(*first), "");
    Some(diagnostic.help(format!("did you mean `{meant}`?")))
}
