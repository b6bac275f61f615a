//! The abstract syntax tree: what was written and where, with no meaning attached.
//!
//! Names are not resolved here. `a(b)` is an [`ExprKind::Apply`] whether `a` turns out to be a function, a field
//! or a number, and `a(b)^2` keeps the power outside of it; layer `program` decides (language rule 5).

use num_rational::BigRational;

use crate::diagnostic::Span;

/// One source file.
#[derive(Debug, Clone, Default)]
pub struct Module {
    pub statements: Vec<Statement>,
}

/// One statement with the comment lines directly above it (without `#`), which document it.
#[derive(Debug, Clone)]
pub struct Statement {
    pub span: Span,
    pub doc: Vec<String>,
    pub kind: StatementKind,
}

#[derive(Debug, Clone)]
pub enum StatementKind {
    /// `let NAME = EXPR`
    Let { name: Name, value: Expr },
    /// `fn NAME(PARAM, PARAM = DEFAULT, ...) = EXPR`
    Fn { name: Name, params: Vec<FnParam>, body: Expr },
    /// `param NAME = VALUE in [LO, HI]`
    Param { name: Name, value: Expr, range: Option<(Expr, Expr)> },
    /// `surface NAME: RELATION where CONDITION`, the keyword `curve`, or a bare relation (`keyword` and `name` absent).
    /// A statement that is a bare call, such as `camera(fov = 30)`, is a shape without keyword whose relation is an
    /// [`ExprKind::Apply`].
    Shape { keyword: Option<ShapeKeyword>, name: Option<Name>, relation: Expr, condition: Option<Expr> },
    /// `domain [a, b] x [c, d]`, with `[a, b]^n` already repeated.
    Domain { ranges: Vec<(Expr, Expr)> },
    /// `import "path"`
    Import { path: String, path_span: Span },
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ShapeKeyword {
    Surface,
    Curve,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Name {
    pub text: String,
    pub span: Span,
}

#[derive(Debug, Clone)]
pub struct FnParam {
    pub name: Name,
    pub default: Option<Expr>,
}

#[derive(Debug, Clone)]
pub struct Expr {
    pub span: Span,
    pub kind: ExprKind,
}

impl Expr {
    /// Hands over the expressions that this one is directly made of, from left to right.
    pub fn parts<'e>(&'e self, mut visit: impl FnMut(&'e Expr)) {
        match &self.kind {
            ExprKind::Number(_) | ExprKind::Name(_) | ExprKind::Text(_) => {}
            ExprKind::List(parts) | ExprKind::And(parts) | ExprKind::Or(parts) => parts.iter().for_each(visit),
            ExprKind::Relation { operands, .. } => operands.iter().for_each(visit),
            ExprKind::Apply { args, .. } => args.iter().for_each(|argument| visit(&argument.value)),
            ExprKind::Bars(inner) | ExprKind::Group(inner) | ExprKind::Neg(inner) | ExprKind::Not(inner) => {
                visit(inner)
            }
            ExprKind::Sum { first, rest } => {
                visit(first);
                rest.iter().for_each(|(_, term)| visit(term));
            }
            ExprKind::Product { first, rest } => {
                visit(first);
                rest.iter().for_each(|(_, factor)| visit(factor));
            }
            ExprKind::Power { base, exponent } => {
                visit(base);
                visit(exponent);
            }
            ExprKind::If { condition, then, otherwise } => {
                visit(condition);
                visit(then);
                visit(otherwise);
            }
        }
    }
}

impl StatementKind {
    /// Hands over the expressions of the statement, in the order of the text.
    pub fn expressions<'s>(&'s self, mut visit: impl FnMut(&'s Expr)) {
        match self {
            StatementKind::Let { value, .. } => visit(value),
            StatementKind::Fn { params, body, .. } => {
                params.iter().filter_map(|parameter| parameter.default.as_ref()).for_each(&mut visit);
                visit(body);
            }
            StatementKind::Param { value, range, .. } => {
                visit(value);
                range.iter().for_each(|(lo, hi)| [lo, hi].into_iter().for_each(&mut visit));
            }
            StatementKind::Shape { relation, condition, .. } => {
                visit(relation);
                condition.iter().for_each(visit);
            }
            StatementKind::Domain { ranges } => {
                ranges.iter().for_each(|(lo, hi)| [lo, hi].into_iter().for_each(&mut visit));
            }
            StatementKind::Import { .. } => {}
        }
    }
}

#[derive(Debug, Clone)]
pub enum ExprKind {
    /// The real number written, exactly.
    Number(BigRational),
    Name(String),
    /// A quoted string, only meaningful as an argument of a scene setting.
    Text(String),
    /// `[a, b, c]`
    List(Vec<Expr>),
    /// `name(args)`: a call, a field at a point, or a product.
    Apply {
        callee: Name,
        args: Vec<Argument>,
    },
    /// `|e|`
    Bars(Box<Expr>),
    /// `(e)`; kept so that the formatter gives back what was written.
    Group(Box<Expr>),
    Neg(Box<Expr>),
    Not(Box<Expr>),
    /// A flat sum: first term, then signed terms. Long sums must not nest.
    Sum {
        first: Box<Expr>,
        rest: Vec<(Sign, Expr)>,
    },
    /// A flat product: first factor, then factors with how each was joined.
    Product {
        first: Box<Expr>,
        rest: Vec<(Join, Expr)>,
    },
    Power {
        base: Box<Expr>,
        exponent: Box<Expr>,
    },
    /// `a < b <= c`, `a = b`: operands and the relations between them (one fewer).
    Relation {
        operands: Vec<Expr>,
        relations: Vec<Relation>,
    },
    /// Flat conjunction or disjunction.
    And(Vec<Expr>),
    Or(Vec<Expr>),
    If {
        condition: Box<Expr>,
        then: Box<Expr>,
        otherwise: Box<Expr>,
    },
}

#[derive(Debug, Clone)]
pub struct Argument {
    /// `name = value` in a call.
    pub name: Option<Name>,
    pub value: Expr,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sign {
    Plus,
    Minus,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Join {
    Times,
    Over,
    Juxtaposed,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Relation {
    Equal,
    NotEqual,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
}
