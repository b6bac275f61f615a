//! Absolute value bars: which `|` opens and which closes (language rule 8).
//!
//! A bar does not say which way it faces. Between two brackets, commas, relations or words, all bars must pair; a
//! bar may open if an operand can follow it, close if an operand ends before it, and between two operands it may do
//! either. The pairings that read are the paths from depth 0 to depth 0 through (bar, direction, depth); there is
//! exactly one iff at every bar exactly one state lies on a path. Depths are bits of a `u64`, so both sweeps cost a
//! few instructions a bar.

use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::syntax::report::Reporter;
use crate::syntax::report::one_line;
use crate::syntax::token::Lexeme;
use crate::syntax::token::Token;

/// Replaces every `Bar` by `BarOpen` or `BarClose`; reports bars that pair in no way or in several, and then
/// answers `false`. Brackets must be matched.
pub fn pair(reporter: &mut Reporter<'_>, tokens: &mut [Lexeme]) -> bool {
    let before = reporter.count();
    let mut lonely = Vec::new();
    stretches(tokens, |tokens, bars| settle(reporter, tokens, bars, &mut lonely));
    if !lonely.is_empty() {
        unpaired(reporter, tokens, &lonely);
    }
    reporter.count() == before
}

/// Hands over the bars between which nothing separates, stretch by stretch.
fn stretches(tokens: &mut [Lexeme], mut settle: impl FnMut(&mut [Lexeme], &[usize])) {
    // The bars of the stretch at hand, for each open bracket.
    let mut open: Vec<Vec<usize>> = vec![Vec::new()];
    for i in 0..tokens.len() {
        let token = tokens[i].token;
        match token {
            Token::LeftParen | Token::LeftBracket => open.push(Vec::new()),
            Token::RightParen | Token::RightBracket => settle(tokens, &open.pop().unwrap_or_default()),
            Token::Bar => open.last_mut().into_iter().for_each(|bars| bars.push(i)),
            _ if separates(token) => {
                if let Some(bars) = open.last_mut() {
                    settle(tokens, bars);
                    bars.clear();
                }
            }
            _ => {}
        }
    }
    open.iter().for_each(|bars| settle(tokens, bars));
}

/// Tokens that cannot stand between a bar and its partner without a bracket around them.
fn separates(token: Token) -> bool {
    token.is_relation() || token.is_keyword() || matches!(token, Token::Comma | Token::Colon)
}

const OPEN: usize = 0;
const CLOSE: usize = 1;

/// One bar: whether its neighbours let it open or close, and whether the next token is a bar as well.
struct Bar {
    can: [bool; 2],
    touches_next: bool,
}

/// `||` read as open then close would hold nothing.
fn follows(bar: &Bar, this: usize, next: usize) -> bool {
    !(bar.touches_next && this == OPEN && next == CLOSE)
}

/// Turns the bars of one stretch into opening and closing ones. Those that pair in no way go to `lonely`.
fn settle(reporter: &mut Reporter<'_>, tokens: &mut [Lexeme], at: &[usize], lonely: &mut Vec<usize>) {
    if at.is_empty() {
        return;
    }
    let bars: Vec<Bar> = at.iter().map(|&i| look_around(tokens, i)).collect();
    let viable = viable_states(&bars);
    if viable[0] == [0, 0] {
        lonely.extend(at);
    } else if viable.iter().all(|v| v[OPEN].count_ones() + v[CLOSE].count_ones() == 1) {
        for (v, &i) in viable.iter().zip(at) {
            tokens[i].token = if v[OPEN] != 0 { Token::BarOpen } else { Token::BarClose };
        }
    } else {
        let ways = [CLOSE, OPEN].map(|first| walk(&bars, &viable, first));
        let readings: Vec<String> = ways.iter().filter_map(|ways| reading(reporter, tokens, at, ways)).collect();
        let mut diagnostic = point_at(
            reporter,
            Diagnostic::error(code::BARS, "these bars pair in more than one way"),
            tokens,
            at,
            "which bar belongs to which?",
        );
        for reading in &readings {
            diagnostic = diagnostic.help(format!("write `{reading}`"));
        }
        if readings.is_empty() {
            diagnostic = diagnostic.help("write `abs(...)` for the absolute value");
        }
        reporter.report(diagnostic);
    }
}

fn look_around(tokens: &[Lexeme], i: usize) -> Bar {
    let before = i.checked_sub(1).map(|j| tokens[j].token);
    let after = tokens.get(i + 1).map(|t| t.token);
    let opens_into = after.is_some_and(|t| t.begins_operand() || matches!(t, Token::Minus | Token::Bar));
    let closes_from = before.is_some_and(|t| t.ends_operand() || t == Token::Bar);
    Bar { can: [opens_into, closes_from], touches_next: after == Some(Token::Bar) }
}

/// For every bar and direction, the set of depths behind it that lie on a complete pairing.
fn viable_states(bars: &[Bar]) -> Vec<[u64; 2]> {
    let n = bars.len();
    let mut forward = vec![[0u64; 2]; n];
    for i in 0..n {
        for way in [OPEN, CLOSE] {
            if !bars[i].can[way] {
                continue;
            }
            let before = if i == 0 {
                1
            } else {
                let from = |w: usize| if follows(&bars[i - 1], w, way) { forward[i - 1][w] } else { 0 };
                from(OPEN) | from(CLOSE)
            };
            // Closing from depth 0 and opening past depth 63 both drop out.
            forward[i][way] = if way == OPEN { before << 1 } else { before >> 1 };
        }
    }
    let mut backward = vec![[0u64; 2]; n];
    backward[n - 1] = [1, 1];
    for i in (0..n - 1).rev() {
        for way in [OPEN, CLOSE] {
            for next in [OPEN, CLOSE] {
                if bars[i + 1].can[next] && follows(&bars[i], way, next) {
                    let after = backward[i + 1][next];
                    backward[i][way] |= if next == OPEN { after >> 1 } else { after << 1 };
                }
            }
        }
    }
    (0..n).map(|i| [forward[i][OPEN] & backward[i][OPEN], forward[i][CLOSE] & backward[i][CLOSE]]).collect()
}

/// One of the pairings: at every bar the direction `first`, where it leads on.
fn walk(bars: &[Bar], viable: &[[u64; 2]], first: usize) -> Vec<usize> {
    let mut ways: Vec<usize> = Vec::with_capacity(bars.len());
    let mut depth = 1u64;
    for (i, states) in viable.iter().enumerate() {
        let step = |way: usize| if way == OPEN { depth << 1 } else { depth >> 1 };
        let fits = |way: usize| {
            states[way] & step(way) != 0 && ways.last().is_none_or(|&last| follows(&bars[i - 1], last, way))
        };
        let way = if fits(first) { first } else { 1 - first };
        depth = step(way);
        ways.push(way);
    }
    ways
}

/// The text with `abs(` and `)` in place of bars, where it is short enough to show.
fn reading(reporter: &Reporter<'_>, tokens: &[Lexeme], at: &[usize], ways: &[usize]) -> Option<String> {
    let mut out = String::new();
    let mut end = tokens[*at.first()?].start;
    for (&i, &way) in at.iter().zip(ways) {
        out.push_str(reporter.slice(end, tokens[i].start));
        if way == OPEN {
            let glued = out.chars().next_back().is_some_and(|c| c.is_alphanumeric() || matches!(c, '_' | '\''));
            out.push_str(if glued { " abs(" } else { "abs(" });
        } else {
            out.push(')');
        }
        end = tokens[i].end;
    }
    one_line(&out)
}

fn unpaired(reporter: &mut Reporter<'_>, tokens: &[Lexeme], at: &[usize]) {
    let (title, label) = match at {
        [_] => ("this bar has no partner", ""),
        _ => ("these bars do not pair", "no bar closes what another opens"),
    };
    let mut diagnostic = point_at(reporter, Diagnostic::error(code::BARS, title), tokens, at, label)
        .help("write `abs(...)` for the absolute value");
    if at.windows(2).any(|w| w[0] + 1 == w[1] && tokens[w[0]].end == tokens[w[1]].start) {
        diagnostic = diagnostic.help("if `||` means a choice, write `or`");
    }
    reporter.report(diagnostic);
}

/// Labels the first few of the bars, and the first of them with `text`.
fn point_at(
    reporter: &Reporter<'_>,
    diagnostic: Diagnostic,
    tokens: &[Lexeme],
    at: &[usize],
    text: &str,
) -> Diagnostic {
    const SHOWN: usize = 8;
    at.iter()
        .take(SHOWN)
        .enumerate()
        .fold(diagnostic, |diagnostic, (k, &i)| diagnostic.at(reporter.at(tokens[i]), if k == 0 { text } else { "" }))
}
