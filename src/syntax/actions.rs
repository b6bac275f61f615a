//! What the grammar's productions build, and the rules that need whole operands: chains of relations point one way,
//! and nobody divides by a product without a sign (language rules 7 and 9).

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::ToPrimitive;

use crate::diagnostic::Diagnostic;
use crate::diagnostic::Span;
use crate::diagnostic::code;
use crate::syntax::ast::Argument;
use crate::syntax::ast::Expr;
use crate::syntax::ast::ExprKind;
use crate::syntax::ast::Join;
use crate::syntax::ast::Name;
use crate::syntax::ast::Relation;
use crate::syntax::ast::Sign;
use crate::syntax::literal;
use crate::syntax::repair;
use crate::syntax::report::Reporter;

/// A first operand and what was joined to it so far.
pub type Chain<J> = (Expr, Vec<(J, Expr)>);

pub fn expr(r: &Reporter<'_>, start: u32, end: u32, kind: ExprKind) -> Expr {
    Expr { span: r.span(start, end), kind }
}

pub fn name(r: &Reporter<'_>, start: u32, end: u32) -> Name {
    Name { text: r.slice(start, end).to_string(), span: r.span(start, end) }
}

/// A name as a value; the letter π is the constant `pi`.
pub fn name_value(r: &Reporter<'_>, start: u32, end: u32) -> Expr {
    let text = match r.slice(start, end) {
        "π" => "pi",
        other => other,
    };
    expr(r, start, end, ExprKind::Name(text.to_string()))
}

pub fn number(r: &mut Reporter<'_>, start: u32, end: u32) -> Expr {
    let value = literal::number(r.slice(start, end)).unwrap_or_else(|literal::TooLarge| {
        repair::too_large(r, start, end);
        BigRational::from_integer(BigInt::from(0))
    });
    expr(r, start, end, ExprKind::Number(value))
}

/// The text between the quotes.
pub fn quoted(r: &Reporter<'_>, start: u32, end: u32) -> String {
    let text = r.slice(start, end);
    let inner = text.strip_prefix('"').unwrap_or(text);
    inner.strip_suffix('"').unwrap_or(inner).to_string()
}

pub fn call(r: &Reporter<'_>, start: u32, name_end: u32, end: u32, args: Vec<Argument>) -> Expr {
    expr(r, start, end, ExprKind::Apply { callee: name(r, start, name_end), args })
}

pub fn power(base: Expr, exponent: Expr) -> Expr {
    let span = base.span.to(exponent.span);
    Expr { span, kind: ExprKind::Power { base: Box::new(base), exponent: Box::new(exponent) } }
}

/// `x²`: the raised digits `start..end` as the exponent.
pub fn raised(r: &mut Reporter<'_>, base: Expr, start: u32, end: u32) -> Expr {
    power(base, raised_number(r, start, end))
}

/// The number that raised digits name, as a number or its negative.
pub fn raised_number(r: &mut Reporter<'_>, start: u32, end: u32) -> Expr {
    let text = r.slice(start, end);
    let digits: String = text.chars().filter_map(raised_digit).collect();
    let value = literal::number(&digits).unwrap_or_else(|literal::TooLarge| {
        repair::too_large(r, start, end);
        BigRational::from_integer(BigInt::from(0))
    });
    let exponent = expr(r, start, end, ExprKind::Number(value));
    if text.starts_with('⁻') { expr(r, start, end, ExprKind::Neg(Box::new(exponent))) } else { exponent }
}

fn raised_digit(c: char) -> Option<char> {
    "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|d| d == c).and_then(|d| char::from_digit(d as u32, 10))
}

/// An operand alone, or a chain with one node for all of it.
fn chain<J>(chain: Chain<J>, build: impl FnOnce(Box<Expr>, Vec<(J, Expr)>) -> ExprKind) -> Expr {
    let (first, rest) = chain;
    match rest.last() {
        None => first,
        Some((_, last)) => {
            let span = first.span.to(last.span);
            Expr { span, kind: build(Box::new(first), rest) }
        }
    }
}

pub fn sum(parts: Chain<Sign>) -> Expr {
    chain(parts, |first, rest| ExprKind::Sum { first, rest })
}

/// Factors that stand side by side.
pub fn juxtaposition(parts: Chain<Join>) -> Expr {
    chain(parts, |first, rest| ExprKind::Product { first, rest })
}

/// Factors joined by `*` and `/`. A quotient whose divisor is a product without a sign reads in two ways: `1/2x`.
pub fn product(r: &mut Reporter<'_>, parts: Chain<Join>) -> Expr {
    for (join, factor) in &parts.1 {
        if *join == Join::Over
            && let Some(split) = first_factor_end(factor)
        {
            ambiguous_division(r, parts.0.span.start, factor, split);
        }
    }
    juxtaposition(parts)
}

/// Where the first factor of a product without a sign ends; `None` for any other expression.
fn first_factor_end(factor: &Expr) -> Option<u32> {
    match &factor.kind {
        ExprKind::Neg(inner) => first_factor_end(inner),
        ExprKind::Product { first, rest } if rest.iter().all(|(j, _)| *j == Join::Juxtaposed) => Some(first.span.end),
        _ => None,
    }
}

fn ambiguous_division(r: &mut Reporter<'_>, start: u32, divisor: &Expr, split: u32) {
    let (from, to) = (divisor.span.start, divisor.span.end);
    let mut diagnostic = Diagnostic::error(code::AMBIGUOUS_DIVISION, "this quotient can be read in two ways")
        .at(divisor.span, "does `/` divide by all of this, or by its first factor only?");
    if let (Some(left), Some(rest)) = (r.excerpt(start, split), r.excerpt(split, to)) {
        diagnostic = diagnostic.help(format!("write `({left}){rest}`"));
    }
    if let (Some(left), Some(all)) = (r.excerpt(start, from), r.excerpt(from, to)) {
        diagnostic = diagnostic.help(format!("or write `{left}({all})`"));
    }
    if diagnostic.help.is_empty() {
        diagnostic = diagnostic.help("put brackets around the quotient or around the divisor");
    }
    r.report(diagnostic);
}

/// A relation or a chain of them; one operand stays as it is.
pub fn relation(r: &mut Reporter<'_>, parts: Chain<Relation>) -> Expr {
    let (first, rest) = parts;
    if rest.is_empty() {
        return first;
    }
    let mut operands = vec![first];
    let mut relations = Vec::with_capacity(rest.len());
    for (relation, operand) in rest {
        relations.push(relation);
        operands.push(operand);
    }
    if relations.len() > 1 {
        check_chain(r, &operands, &relations);
    }
    let span = operands[0].span.to(operands[operands.len() - 1].span);
    Expr { span, kind: ExprKind::Relation { operands, relations } }
}

fn check_chain(r: &mut Reporter<'_>, operands: &[Expr], relations: &[Relation]) {
    use Relation::{Equal, Greater, GreaterEqual, Less, LessEqual, NotEqual};
    let direction = |relation: Relation| match relation {
        Less | LessEqual => -1,
        Greater | GreaterEqual => 1,
        Equal | NotEqual => 0,
    };
    let one_way = direction(relations[0]);
    let Some(odd) = relations.iter().position(|&x| direction(x) == 0 || direction(x) != one_way) else { return };
    // The first relation cannot differ from itself in direction, but it can be the `=` of a chain.
    let odd = odd.max(1);
    let between = |k: usize| {
        let (start, end) = (operands[k].span.end, operands[k + 1].span.start);
        let text = r.slice(start, end);
        let lead = (text.len() - text.trim_start().len()) as u32;
        let trail = (text.len() - text.trim_end().len()) as u32;
        r.span(start + lead, end - trail)
    };
    let equations = relations.iter().filter(|&&x| direction(x) == 0).count();
    let (title, help) = if equations == relations.len() {
        ("an equation has one `=`", "write two equations joined by `and`")
    } else if equations > 0 {
        ("`=` cannot stand in a chain of inequalities", "join the parts by `and`")
    } else {
        ("`<` and `>` stand in one chain", "turn one of them around, or join two relations by `and`")
    };
    let mut diagnostic = Diagnostic::error(code::MIXED_RELATIONS, title).at(between(odd), "").at(between(odd - 1), "");
    let end = operands[odd + 1].span.end;
    let parts = [(operands[odd - 1].span.start, operands[odd].span.end), (operands[odd].span.start, end)];
    diagnostic = match parts.map(|(a, b)| r.excerpt(a, b)) {
        [Some(left), Some(right)] => diagnostic.help(format!("write `{left} and {right}`")),
        _ => diagnostic.help(help),
    };
    r.report(diagnostic);
}

/// Operands of `and` or of `or`; one operand stays as it is.
pub fn words((first, rest): (Expr, Vec<Expr>), build: fn(Vec<Expr>) -> ExprKind) -> Expr {
    let Some(last) = rest.last() else { return first };
    let span = first.span.to(last.span);
    let mut operands = vec![first];
    operands.extend(rest);
    Expr { span, kind: build(operands) }
}

/// The ranges of a domain, each with how often it is repeated.
pub fn ranges(parts: Vec<((Expr, Expr), usize)>) -> Vec<(Expr, Expr)> {
    parts.into_iter().flat_map(|(range, times)| std::iter::repeat_n(range, times)).collect()
}

/// The `n` of `[a, b]^n`: a whole number from 1 to 3.
pub fn repetition(r: &mut Reporter<'_>, exponent: &Expr) -> usize {
    let count = match &exponent.kind {
        ExprKind::Number(n) if n.is_integer() => n.to_usize().filter(|n| (1..=3).contains(n)),
        _ => None,
    };
    count.unwrap_or_else(|| {
        r.report(bad_repetition(exponent.span));
        1
    })
}

/// A range is repeated by something else than 1, 2 or 3.
pub fn bad_repetition(span: Span) -> Diagnostic {
    Diagnostic::error(code::BAD_REPETITION, "a domain has two or three ranges")
        .at(span, "this is how often the range is repeated")
        .help("write `[a, b]^2` for a plane, `[a, b]^3` for space")
}
