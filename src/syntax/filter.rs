//! Between the tokens of one statement and the grammar: matched brackets, bounded depth, bars that open or close,
//! products without a sign, the `x` of a domain, named arguments (language rules 2, 4, 8, 9, 10).
//!
//! With these decided here, the grammar is LR(1) without conflicts.

use crate::diagnostic::Diagnostic;
use crate::diagnostic::Span;
use crate::diagnostic::code;
use crate::syntax::ast::Expr;
use crate::syntax::bars;
use crate::syntax::functions;
use crate::syntax::report::Reporter;
use crate::syntax::token::Lexeme;
use crate::syntax::token::Token;

/// How deeply brackets, signs, powers and choices may nest in total. Each adds a bounded number of nodes to the AST
/// (at most eight: or, and, relation, sum, product, juxtaposition, power, call), so that it can be dropped in a small
/// stack.
pub const MAX_DEPTH: usize = 256;

/// How many nodes of the AST may lie one in the other. Few formulas come near: Horner's scheme takes three nodes for a
/// bracket. Who walks the AST recursively has 2 KiB for a node in the smallest stacks in use, which are of 2 MiB.
pub const MAX_NODES: usize = 3 * MAX_DEPTH;

/// The tokens that the grammar reads, or `None` where they cannot be given to it (the reason is reported).
pub fn filter(reporter: &mut Reporter<'_>, tokens: &[Lexeme]) -> Option<Vec<Lexeme>> {
    let partner = brackets(reporter, tokens)?;
    let mut tokens = tokens.to_vec();
    let mut good = bars::pair(reporter, &mut tokens);
    depth(reporter, &tokens)?;
    good &= functions::check(reporter, &tokens, &partner);
    let joined = join(reporter, &tokens);
    good.then_some(joined?)
}

/// For every bracket the index of its partner (for every other token its own index).
fn brackets(reporter: &mut Reporter<'_>, tokens: &[Lexeme]) -> Option<Vec<usize>> {
    let mut partner: Vec<usize> = (0..tokens.len()).collect();
    let mut open: Vec<usize> = Vec::new();
    for (i, lexeme) in tokens.iter().enumerate() {
        match lexeme.token {
            Token::LeftParen | Token::LeftBracket => open.push(i),
            Token::RightParen | Token::RightBracket => {
                let text = reporter.text_of(*lexeme);
                let Some(start) = open.pop() else {
                    let diagnostic = Diagnostic::error(code::BRACKET, format!("this `{text}` closes nothing"));
                    reporter.report(diagnostic.at(reporter.at(*lexeme), "no bracket is open here"));
                    return None;
                };
                let matches = (tokens[start].token == Token::LeftParen) == (lexeme.token == Token::RightParen);
                if !matches {
                    let opener = reporter.text_of(tokens[start]);
                    let want = closer(tokens[start].token);
                    reporter.report(
                        Diagnostic::error(code::BRACKET, format!("`{opener}` is closed by `{text}`"))
                            .at(reporter.at(*lexeme), format!("`{want}` is expected here"))
                            .at(reporter.at(tokens[start]), "opened here"),
                    );
                    return None;
                }
                partner[start] = i;
                partner[i] = start;
            }
            _ => {}
        }
    }
    if let Some(&start) = open.last() {
        let text = reporter.text_of(tokens[start]);
        let want = closer(tokens[start].token);
        reporter.report(
            Diagnostic::error(code::BRACKET, format!("this `{text}` is never closed"))
                .at(reporter.at(tokens[start]), "")
                .help(format!("put a `{want}` where it ends")),
        );
        return None;
    }
    Some(partner)
}

fn closer(open: Token) -> &'static str {
    if open == Token::LeftBracket { "]" } else { ")" }
}

/// Refuses what would nest deeper than [`MAX_DEPTH`]: open brackets and bars, and within each the signs, powers,
/// `not` and `if` that are still waiting for their operands.
fn depth(reporter: &mut Reporter<'_>, tokens: &[Lexeme]) -> Option<()> {
    /// What waits at one bracket level: tight operators until the next binary one, `not` until the next word, and
    /// `if` until the bracket closes.
    #[derive(Default, Clone, Copy)]
    struct Waiting {
        tight: usize,
        nots: usize,
        ifs: usize,
    }
    let mut here = Waiting::default();
    let mut outer: Vec<Waiting> = Vec::new();
    let mut outside = 0;
    let mut last = Token::Comma;
    for lexeme in tokens {
        let token = lexeme.token;
        // A product without a sign ends a power, as an operator does.
        let call = last == Token::Name && token == Token::LeftParen;
        if last.ends_operand() && token.begins_operand() && !call {
            here.tight = 0;
        }
        match token {
            Token::LeftParen | Token::LeftBracket | Token::BarOpen => {
                outside += 1 + here.tight + here.nots + here.ifs;
                outer.push(std::mem::take(&mut here));
            }
            Token::RightParen | Token::RightBracket | Token::BarClose => {
                here = outer.pop().unwrap_or_default();
                outside -= 1 + here.tight + here.nots + here.ifs;
            }
            Token::Caret => here.tight += 1,
            Token::Minus if !last.ends_operand() => here.tight += 1,
            Token::Not => here.nots += 1,
            Token::If => here.ifs += 1,
            Token::And | Token::Or | Token::Then | Token::Else => (here.tight, here.nots) = (0, 0),
            Token::Comma | Token::Colon | Token::Where | Token::In => here = Waiting::default(),
            _ if token.is_binary() => here.tight = 0,
            _ => {}
        }
        last = token;
        if outside + here.tight + here.nots + here.ifs > MAX_DEPTH {
            reporter.report(too_deep(reporter.at(*lexeme), format!("more than {MAX_DEPTH} levels")));
            return None;
        }
    }
    Some(())
}

/// Refuses an expression with more than [`MAX_NODES`] nodes one in the other.
pub fn nodes(reporter: &mut Reporter<'_>, expr: &Expr) {
    let mut open = vec![(expr, 1)];
    while let Some((expr, depth)) = open.pop() {
        if depth > MAX_NODES {
            let span = reporter.span(expr.span.start, expr.span.end);
            return reporter
                .report(too_deep(span, format!("more than {MAX_NODES} operations, each inside of another")));
        }
        expr.parts(|part| open.push((part, depth + 1)));
    }
}

fn too_deep(span: Span, label: String) -> Diagnostic {
    Diagnostic::error(code::TOO_DEEP, "this formula is nested too deeply")
        .at(span, label)
        .help("give inner parts names with `let`")
}

/// Puts in products without a sign, box products and named arguments.
fn join(reporter: &mut Reporter<'_>, tokens: &[Lexeme]) -> Option<Vec<Lexeme>> {
    let mut out: Vec<Lexeme> = Vec::with_capacity(tokens.len() + tokens.len() / 4);
    // For every open bracket, whether it holds the arguments of a call.
    let mut calls: Vec<bool> = Vec::new();
    let in_domain = tokens[0].token == Token::Domain;
    let mut good = true;
    for (i, &lexeme) in tokens.iter().enumerate() {
        let last = out.last().map(|l| l.token);
        let mut lexeme = lexeme;
        let side_by_side = last.is_some_and(Token::ends_operand) && lexeme.token.begins_operand();
        let box_level = in_domain && calls.is_empty();
        if box_level && is_box_sign(reporter, tokens, i) {
            lexeme.token = Token::BoxTimes;
        } else if lexeme.token == Token::Cross {
            lexeme.token = Token::Star;
        } else if side_by_side && last == Some(Token::Number) && lexeme.token == Token::Number {
            adjacent_numbers(reporter, tokens[i - 1], lexeme, calls.is_empty());
            good = false;
        } else if param_range(tokens, i) && calls.is_empty() {
            // No product with the range of a parameter: the grammar misses the `in`.
        } else if side_by_side && !(last == Some(Token::Name) && lexeme.token == Token::LeftParen) {
            out.push(Lexeme { token: Token::Juxtaposed, ..lexeme });
        }
        match lexeme.token {
            Token::LeftParen => calls.push(last == Some(Token::Name)),
            Token::LeftBracket => calls.push(false),
            Token::RightParen | Token::RightBracket => {
                calls.pop();
            }
            Token::Equal if calls.last() == Some(&true) && is_argument_name(tokens, i) => {
                lexeme.token = Token::ArgumentEqual;
            }
            _ => {}
        }
        out.push(lexeme);
    }
    good.then_some(out)
}

/// `x` or `×` behind a range; no other name can stand there.
fn is_box_sign(reporter: &Reporter<'_>, tokens: &[Lexeme], i: usize) -> bool {
    let sign = match tokens[i].token {
        Token::Cross => true,
        Token::Name => matches!(reporter.text_of(tokens[i]), "x" | "X"),
        _ => false,
    };
    sign && tokens[i - 1].token.ends_operand()
}

fn param_range(tokens: &[Lexeme], i: usize) -> bool {
    tokens[0].token == Token::Param && tokens[i].token == Token::LeftBracket
}

/// Whether the `=` at `i` follows a name that itself follows the call's bracket or a comma.
fn is_argument_name(tokens: &[Lexeme], i: usize) -> bool {
    i >= 2 && tokens[i - 1].token == Token::Name && matches!(tokens[i - 2].token, Token::LeftParen | Token::Comma)
}

fn adjacent_numbers(reporter: &mut Reporter<'_>, left: Lexeme, right: Lexeme, outside: bool) {
    let (a, b) = (reporter.text_of(left), reporter.text_of(right));
    let mut diagnostic = Diagnostic::error(code::ADJACENT_NUMBERS, "two numbers stand side by side")
        .at(reporter.span(left.start, right.end), "is a sign missing between them?");
    if a.len() + b.len() < 60 {
        diagnostic = diagnostic.help(format!("for their product write `{a} * {b}`"));
        if !outside {
            diagnostic = diagnostic.help(format!("to separate them write `{a}, {b}`"));
        }
    }
    reporter.report(diagnostic);
}
