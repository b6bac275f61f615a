//! The names of the built-in functions, and the check that their arguments stand in brackets (language rule 7).

use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::syntax::report::Reporter;
use crate::syntax::report::one_line;
use crate::syntax::token::Lexeme;
use crate::syntax::token::Token;

/// Every function of the language itself (the standard library defines more), in ascending order.
pub const FUNCTIONS: &[&str] = &[
    "abs",
    "acos",
    "acosh",
    "asin",
    "asinh",
    "atan",
    "atan2",
    "atanh",
    "cbrt",
    "ceil",
    "clamp",
    "cos",
    "cosh",
    "deriv",
    "exp",
    "exp10",
    "exp2",
    "expm1",
    "floor",
    "hypot",
    "ln",
    "log10",
    "log1p",
    "log2",
    "max",
    "min",
    "mix",
    "mod",
    "pow",
    "round",
    "sign",
    "sin",
    "sinh",
    "smoothstep",
    "sqr",
    "sqrt",
    "tan",
    "tanh",
];

pub fn is_function(name: &str) -> bool {
    FUNCTIONS.binary_search(&name).is_ok()
}

/// Reports every function name that is followed by an operand or a power instead of a bracket; `false` if any is.
/// `partner` is the other bracket of each bracket.
pub fn check(reporter: &mut Reporter<'_>, tokens: &[Lexeme], partner: &[usize]) -> bool {
    let mut good = true;
    for (i, &lexeme) in tokens.iter().enumerate() {
        if lexeme.token != Token::Name || !is_function(reporter.text_of(lexeme)) {
            continue;
        }
        let Some(next) = tokens.get(i + 1).map(|t| t.token) else { continue };
        let bare = next.begins_operand() && next != Token::LeftParen;
        let raised = matches!(next, Token::Caret | Token::Superscript);
        let defined = i > 0 && matches!(tokens[i - 1].token, Token::Let | Token::Fn | Token::Param);
        if (bare || raised) && !defined {
            report(reporter, tokens, partner, i);
            good = false;
        }
    }
    good
}

fn report(reporter: &mut Reporter<'_>, tokens: &[Lexeme], partner: &[usize], i: usize) {
    let walk = Walk { reporter, tokens, partner };
    let name = reporter.text_of(tokens[i]);
    let power_end = walk.power(i + 1);
    let argument_end = walk.argument(power_end);
    let slice = |from: usize, to: usize| -> Option<String> {
        if from == to { Some(String::new()) } else { reporter.excerpt(tokens[from].start, tokens[to - 1].end) }
    };
    let mut offers: Vec<String> = Vec::new();
    let mut diagnostic =
        Diagnostic::error(code::FUNCTION_WITHOUT_BRACKETS, format!("`{name}` needs its argument in brackets"))
            .at(reporter.at(tokens[i]), "a function's name is followed by `(`");
    if let (Some(power), Some(argument)) = (slice(i + 1, power_end), slice(power_end, argument_end)) {
        let power = power.trim().to_string();
        let grouped = argument_end > power_end && partner[power_end] + 1 == argument_end;
        let call = match argument.trim() {
            "" => format!("{name}(...)"),
            inner if grouped && tokens[power_end].token == Token::LeftParen => format!("{name}{inner}"),
            inner => format!("{name}({inner})"),
        };
        if matches!(power.as_str(), "^-1" | "⁻¹") {
            if let Some(inverse) = inverse(name) {
                offers.push(format!("for the inverse function write `{inverse}{}`", &call[name.len()..]));
            }
            offers.push(format!("for the reciprocal write `1/{call}`"));
        } else {
            offers.extend(one_line(&format!("write `{call}{power}`")));
        }
    }
    for offer in offers {
        diagnostic = diagnostic.help(offer);
    }
    reporter.report(diagnostic);
}

fn inverse(name: &str) -> Option<&'static str> {
    Some(match name {
        "sin" => "asin",
        "cos" => "acos",
        "tan" => "atan",
        "sinh" => "asinh",
        "cosh" => "acosh",
        "tanh" => "atanh",
        "exp" => "ln",
        "ln" => "exp",
        _ => return None,
    })
}

/// Finds ends of powers and arguments; every method takes an index and answers the index behind.
struct Walk<'w, 't> {
    reporter: &'w Reporter<'t>,
    tokens: &'w [Lexeme],
    partner: &'w [usize],
}

impl Walk<'_, '_> {
    fn token(&self, i: usize) -> Option<Token> {
        self.tokens.get(i).map(|t| t.token)
    }

    fn power(&self, mut i: usize) -> usize {
        loop {
            match self.token(i) {
                Some(Token::Superscript) => i += 1,
                Some(Token::Caret) => {
                    i += 1;
                    while self.token(i) == Some(Token::Minus) {
                        i += 1;
                    }
                    // `sin^n(x)`: the bracket holds the argument, not one of `n`.
                    i = match self.token(i) {
                        Some(Token::Name) => i + 1,
                        _ => self.operand(i),
                    };
                }
                _ => return i,
            }
        }
    }

    /// The operands that stand side by side from `i` on, up to the next function.
    fn argument(&self, start: usize) -> usize {
        let mut i = start;
        if self.token(i) == Some(Token::LeftParen) {
            return self.partner[i] + 1;
        }
        while let Some(token) = self.token(i) {
            let function = token == Token::Name && is_function(self.reporter.text_of(self.tokens[i]));
            if !token.begins_operand() || (i > start && function) {
                break;
            }
            i = self.power(self.operand(i));
        }
        i
    }

    fn operand(&self, i: usize) -> usize {
        match self.token(i) {
            Some(Token::Name) if self.token(i + 1) == Some(Token::LeftParen) => self.partner[i + 1] + 1,
            Some(Token::Name | Token::Number) => i + 1,
            Some(Token::LeftParen | Token::LeftBracket) => self.partner[i] + 1,
            Some(Token::BarOpen) => {
                let mut depth = 0usize;
                for (k, lexeme) in self.tokens.iter().enumerate().skip(i) {
                    match lexeme.token {
                        Token::BarOpen => depth += 1,
                        Token::BarClose => depth -= 1,
                        _ => {}
                    }
                    if depth == 0 {
                        return k + 1;
                    }
                }
                i + 1
            }
            _ => i,
        }
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_list_is_sorted() {
        assert!(super::FUNCTIONS.is_sorted());
    }
}
