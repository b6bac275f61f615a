//! What an expression can mean while a file is resolved.
//!
//! The graph knows numbers alone. A relation becomes a truth value (0 or 1) in the graph *and* a field that is at most 0
//! inside, so that `and`, `or`, `not` combine regions exactly as solid modelling does (maximum, minimum, negation).

use std::rc::Rc;

use crate::diagnostic::Span;
use crate::graph::Value;

use super::builtins::Builtin;

/// Index of a definition in the resolved program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct ItemId(pub usize);

/// The compile-time value of an expression.
#[derive(Debug, Clone)]
pub(super) enum Meaning {
    /// A number; a *field* is a number that depends on the coordinates.
    Scalar(Value),
    /// A condition, which is also a region if all of it is made of inequalities.
    Truth(Truth),
    /// `lhs = rhs`
    Equation(Equation),
    /// A list of numbers: a point, a vector, a colour.
    Vector(Rc<[Value]>),
    Text(Rc<str>),
    Function(Function),
    /// Something is wrong and has been reported; whatever uses it stays silent.
    Invalid,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Truth {
    /// 1 where the condition holds, 0 elsewhere.
    pub value: Value,
    /// The field that is <= 0 inside; without one, the equation (or `!=`) that is to blame.
    pub solid: Result<Value, Span>,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Equation {
    /// `lhs - rhs`; a side that is the literal 0 is left out.
    pub difference: Value,
    /// 1 where both sides are equal.
    pub truth: Value,
    pub span: Span,
}

#[derive(Debug, Clone, Copy)]
pub(super) enum Function {
    Builtin(&'static Builtin),
    Defined(ItemId),
}

impl Meaning {
    /// The kind, as messages name it.
    pub fn kind(&self) -> &'static str {
        match self {
            Meaning::Scalar(_) => "a number",
            Meaning::Truth(Truth { solid: Ok(_), .. }) => "a region",
            Meaning::Truth(_) => "a condition",
            Meaning::Equation(_) => "an equation",
            Meaning::Vector(_) => "a list",
            Meaning::Text(_) => "a text",
            Meaning::Function(_) => "a function",
            Meaning::Invalid => "an error",
        }
    }
}
