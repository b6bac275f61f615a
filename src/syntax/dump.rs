//! Tokens and trees as text, for `imp emit tokens` and `imp emit ast`. Both forms are stable: tests compare them.

use std::fmt::Write;

use crate::diagnostic::FileId;
use crate::syntax::ast::Argument;
use crate::syntax::ast::Expr;
use crate::syntax::ast::ExprKind;
use crate::syntax::ast::Join;
use crate::syntax::ast::Module;
use crate::syntax::ast::Relation;
use crate::syntax::ast::ShapeKeyword;
use crate::syntax::ast::Sign;
use crate::syntax::ast::Statement;
use crate::syntax::ast::StatementKind;
use crate::syntax::filter;
use crate::syntax::layout;
use crate::syntax::report::Reporter;
use crate::syntax::token::Lexeme;
use crate::syntax::token::Token;
use crate::syntax::token::lex;

/// One token a line, as the grammar reads them: line and column, kind, text; statements apart by a blank line.
/// Products without a sign, the ways that bars face and named arguments show in the kind. A statement whose brackets
/// or bars do not match is shown as it was lexed.
pub fn tokens(text: &str) -> String {
    let mut reporter = Reporter::new(FileId(0), text);
    let mut out = String::new();
    let mut lines = Lines::default();
    for group in layout::statements(&mut reporter, &lex(text)) {
        if !out.is_empty() {
            out.push('\n');
        }
        for lexeme in filter::filter(&mut reporter, &group.tokens).unwrap_or(group.tokens) {
            let place = lines.place(text, lexeme.start as usize);
            let _ = writeln!(out, "{place:<8}{:<12}{}", lexeme.token.kind(), written(&reporter, lexeme));
        }
    }
    out
}

/// What stands in the text for a token; the sign of a product without one does not.
fn written<'t>(reporter: &Reporter<'t>, lexeme: Lexeme) -> &'t str {
    if lexeme.token == Token::Juxtaposed { "" } else { reporter.text_of(lexeme) }
}

/// Turns ascending offsets into `line:column` (both from 1, columns in characters).
#[derive(Default)]
struct Lines {
    at: usize,
    line: usize,
    column: usize,
}

impl Lines {
    fn place(&mut self, text: &str, offset: usize) -> String {
        let mut behind_return = false;
        for c in text[self.at..offset].chars() {
            // `\r\n` is one line end.
            if c == '\r' || (c == '\n' && !behind_return) {
                (self.line, self.column) = (self.line + 1, 0);
            } else if c != '\n' {
                self.column += 1;
            }
            behind_return = c == '\r';
        }
        self.at = offset;
        format!("{}:{}", self.line + 1, self.column + 1)
    }
}

/// One statement a paragraph: its documentation, then the tree in brackets, broken where a line would pass 100
/// characters. Numbers are exact fractions.
pub fn ast(module: &Module) -> String {
    module.statements.iter().map(statement).collect::<Vec<_>>().join("\n")
}

/// A statement's documentation and tree, with a line end.
pub fn statement(statement: &Statement) -> String {
    let mut out = String::new();
    for line in &statement.doc {
        let _ = writeln!(out, "# {line}");
    }
    let node = match &statement.kind {
        StatementKind::Let { name, value } => Node::list("let", [Node::leaf(&name.text), tree(value)]),
        StatementKind::Fn { name, params, body } => {
            let params = params.iter().map(|p| match &p.default {
                None => Node::leaf(&p.name.text),
                Some(default) => Node::list("=", [Node::leaf(&p.name.text), tree(default)]),
            });
            Node::list("fn", [Node::list(&name.text, params), tree(body)])
        }
        StatementKind::Param { name, value, range } => {
            let range = range.as_ref().map(|(lo, hi)| Node::list("in", [tree(lo), tree(hi)]));
            Node::list("param", [Node::leaf(&name.text), tree(value)].into_iter().chain(range))
        }
        StatementKind::Shape { keyword, name, relation, condition } => {
            let head = match keyword {
                None => "shape",
                Some(ShapeKeyword::Surface) => "surface",
                Some(ShapeKeyword::Curve) => "curve",
            };
            let name = name.iter().map(|n| Node::leaf(&n.text));
            let condition = condition.iter().map(|c| Node::list("where", [tree(c)]));
            Node::list(head, name.chain([tree(relation)]).chain(condition))
        }
        StatementKind::Domain { ranges } => {
            Node::list("domain", ranges.iter().map(|(lo, hi)| Node::list("range", [tree(lo), tree(hi)])))
        }
        StatementKind::Import { path, .. } => Node::list("import", [Node::Leaf(format!("{path:?}"))]),
    };
    node.write(&mut out, 0);
    out.push('\n');
    out
}

/// An expression's tree on one or several lines.
pub fn expression(expr: &Expr) -> String {
    let mut out = String::new();
    tree(expr).write(&mut out, 0);
    out
}

enum Node {
    Leaf(String),
    /// The items in brackets, the first of which names the node.
    List(Vec<Node>),
}

impl Node {
    fn leaf(text: &str) -> Node {
        Node::Leaf(text.to_string())
    }

    fn list(head: &str, items: impl IntoIterator<Item = Node>) -> Node {
        Node::List(std::iter::once(Node::leaf(head)).chain(items).collect())
    }

    /// The length on one line, counted up to `limit` only.
    fn width(&self, limit: usize) -> usize {
        match self {
            Node::Leaf(text) => text.chars().count(),
            Node::List(items) => {
                let mut width = 1;
                for item in items {
                    if width > limit {
                        break;
                    }
                    width += 1 + item.width(limit - width);
                }
                width
            }
        }
    }

    fn write(&self, out: &mut String, indent: usize) {
        const LINE: usize = 100;
        let items = match self {
            Node::Leaf(text) => return out.push_str(text),
            Node::List(items) => items,
        };
        let fits = self.width(LINE) <= LINE.saturating_sub(indent);
        out.push('(');
        for (i, item) in items.iter().enumerate() {
            if i > 0 && fits {
                out.push(' ');
            } else if i > 0 {
                let _ = write!(out, "\n{:1$}", "", indent + 2);
            }
            item.write(out, indent + 2);
        }
        out.push(')');
    }
}

fn tree(expr: &Expr) -> Node {
    match &expr.kind {
        ExprKind::Number(value) => Node::Leaf(value.to_string()),
        ExprKind::Name(name) => Node::leaf(name),
        ExprKind::Text(text) => Node::Leaf(format!("{text:?}")),
        ExprKind::List(items) => Node::list("list", items.iter().map(tree)),
        ExprKind::Apply { callee, args } => {
            Node::list("apply", [Node::leaf(&callee.text)].into_iter().chain(args.iter().map(argument)))
        }
        ExprKind::Bars(inner) => Node::list("bars", [tree(inner)]),
        ExprKind::Group(inner) => Node::list("group", [tree(inner)]),
        ExprKind::Neg(inner) => Node::list("neg", [tree(inner)]),
        ExprKind::Not(inner) => Node::list("not", [tree(inner)]),
        ExprKind::Sum { first, rest } => chain("sum", first, rest, |sign| match sign {
            Sign::Plus => "+",
            Sign::Minus => "-",
        }),
        // Factors side by side and factors with signs are never in one node.
        ExprKind::Product { first, rest } if rest.iter().all(|(join, _)| *join == Join::Juxtaposed) => {
            Node::list("side", [tree(first)].into_iter().chain(rest.iter().map(|(_, e)| tree(e))))
        }
        ExprKind::Product { first, rest } => chain("product", first, rest, |join| match join {
            Join::Times => "*",
            Join::Over => "/",
            Join::Juxtaposed => "_",
        }),
        ExprKind::Power { base, exponent } => Node::list("^", [tree(base), tree(exponent)]),
        ExprKind::Relation { operands, relations } => {
            let mut items = Vec::new();
            for (i, operand) in operands.iter().enumerate() {
                if let Some(relation) = i.checked_sub(1).and_then(|k| relations.get(k)) {
                    items.push(Node::leaf(sign(*relation)));
                }
                items.push(tree(operand));
            }
            Node::list("relation", items)
        }
        ExprKind::And(operands) => Node::list("and", operands.iter().map(tree)),
        ExprKind::Or(operands) => Node::list("or", operands.iter().map(tree)),
        ExprKind::If { condition, then, otherwise } => Node::list("if", [tree(condition), tree(then), tree(otherwise)]),
    }
}

fn chain<J>(head: &str, first: &Expr, rest: &[(J, Expr)], sign: impl Fn(&J) -> &'static str) -> Node {
    let rest = rest.iter().flat_map(|(join, operand)| [Node::leaf(sign(join)), tree(operand)]);
    Node::list(head, [tree(first)].into_iter().chain(rest))
}

fn argument(argument: &Argument) -> Node {
    match &argument.name {
        None => tree(&argument.value),
        Some(name) => Node::list("=", [Node::leaf(&name.text), tree(&argument.value)]),
    }
}

fn sign(relation: Relation) -> &'static str {
    match relation {
        Relation::Equal => "=",
        Relation::NotEqual => "!=",
        Relation::Less => "<",
        Relation::LessEqual => "<=",
        Relation::Greater => ">",
        Relation::GreaterEqual => ">=",
    }
}
