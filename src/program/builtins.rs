//! The functions that the language itself provides: one table of names, parameters, meaning and help.
//!
//! What can be written in the language is in `stdlib/` instead.

use crate::graph::Op;

/// A function of the language.
#[derive(Debug)]
pub struct Builtin {
    pub name: &'static str,
    /// The names of its parameters, which a call may use; of a variadic function the fewest that it takes.
    pub parameters: &'static [&'static str],
    /// Whether more arguments than parameters may follow.
    pub variadic: bool,
    /// One line on what it does.
    pub help: &'static str,
    pub(super) meaning: Lowering,
}

/// What a call of a builtin becomes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Lowering {
    /// One operation on numbers.
    Op(Op),
    /// An associative operation over two or more numbers, or over the components of one list.
    Fold(Op),
    Power,
    Derivative,
    Component,
    Length,
    Dot,
    Cross,
    Field,
    Union,
    Intersect,
    Difference,
}

/// A row whose meaning is one operation and whose help is that operation's.
const fn op(op: Op, parameters: &'static [&'static str]) -> Builtin {
    Builtin { name: op.name(), parameters, variadic: false, help: op.doc(), meaning: Lowering::Op(op) }
}

const fn row(
    name: &'static str,
    parameters: &'static [&'static str],
    variadic: bool,
    meaning: Lowering,
    help: &'static str,
) -> Builtin {
    Builtin { name, parameters, variadic, help, meaning }
}

/// Every builtin function, by subject.
pub static BUILTINS: &[Builtin] = &[
    op(Op::Abs, &["u"]),
    op(Op::Sign, &["u"]),
    op(Op::Floor, &["u"]),
    op(Op::Ceil, &["u"]),
    op(Op::Round, &["u"]),
    op(Op::Mod, &["u", "period"]),
    row("min", &["a", "b"], true, Lowering::Fold(Op::Min), "The smallest of two or more numbers, or of a list."),
    row("max", &["a", "b"], true, Lowering::Fold(Op::Max), "The largest of two or more numbers, or of a list."),
    op(Op::Sqr, &["u"]),
    op(Op::Sqrt, &["u"]),
    op(Op::Cbrt, &["u"]),
    row(
        "hypot",
        &["a", "b"],
        true,
        Lowering::Fold(Op::Hypot),
        "The root of the sum of squares of two or more numbers.",
    ),
    row("pow", &["base", "exponent"], false, Lowering::Power, "The same as base^exponent."),
    op(Op::Exp, &["u"]),
    op(Op::Exp2, &["u"]),
    op(Op::Exp10, &["u"]),
    op(Op::Expm1, &["u"]),
    op(Op::Ln, &["u"]),
    op(Op::Log1p, &["u"]),
    op(Op::Log2, &["u"]),
    op(Op::Log10, &["u"]),
    op(Op::Sin, &["u"]),
    op(Op::Cos, &["u"]),
    op(Op::Tan, &["u"]),
    op(Op::Asin, &["u"]),
    op(Op::Acos, &["u"]),
    op(Op::Atan, &["u"]),
    op(Op::Atan2, &["b", "a"]),
    op(Op::Sinh, &["u"]),
    op(Op::Cosh, &["u"]),
    op(Op::Tanh, &["u"]),
    op(Op::Asinh, &["u"]),
    op(Op::Acosh, &["u"]),
    op(Op::Atanh, &["u"]),
    row(
        "deriv",
        &["f", "variable"],
        false,
        Lowering::Derivative,
        "The derivative of f by a coordinate, the time or a parameter.",
    ),
    row(
        "component",
        &["v", "index"],
        false,
        Lowering::Component,
        "A component of a list, numbered from 1. A number stands for the list of three equal ones; a plane vector has third component 0.",
    ),
    row("length", &["v"], false, Lowering::Length, "The Euclidean length of a list, also written |v|."),
    row("dot", &["v", "w"], false, Lowering::Dot, "The inner product of two lists of equal length."),
    row("cross", &["v", "w"], false, Lowering::Cross, "The vector product of two lists of three."),
    row(
        "field",
        &["shape"],
        false,
        Lowering::Field,
        "The number behind a shape: of a region what is <= 0 inside, of an equation the difference of its sides, of a number itself.",
    ),
    row("union", &["a", "b"], true, Lowering::Union, "What is in at least one region; the same as `or`."),
    row("intersect", &["a", "b"], true, Lowering::Intersect, "What is in all regions; the same as `and`."),
    row(
        "difference",
        &["a", "b"],
        true,
        Lowering::Difference,
        "What is in the first region and in none of the others.",
    ),
];

/// The builtin function of that name.
pub(super) fn builtin(name: &str) -> Option<&'static Builtin> {
    BUILTINS.iter().find(|builtin| builtin.name == name)
}

/// A number with a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Constant {
    Pi,
    /// 2 pi.
    Tau,
    /// exp(1).
    E,
}

/// Named numbers. A file may give `tau` and `e` another meaning, as papers do, but not `pi`.
pub(super) const CONSTANTS: &[(&str, Constant)] = &[("pi", Constant::Pi), ("tau", Constant::Tau), ("e", Constant::E)];

/// The input that holds the time of an animation.
pub const TIME: &str = "t";

/// Names from other languages and textbooks, with what to write here.
const SYNONYMS: &[(&str, &str)] = &[
    ("log", "ln(u), log2(u) or log10(u)"),
    ("lg", "log10(u)"),
    ("arcsin", "asin(u)"),
    ("arccos", "acos(u)"),
    ("arctan", "atan(u)"),
    ("arctan2", "atan2(b, a)"),
    ("arcsinh", "asinh(u)"),
    ("arsinh", "asinh(u)"),
    ("arccosh", "acosh(u)"),
    ("arcosh", "acosh(u)"),
    ("arctanh", "atanh(u)"),
    ("artanh", "atanh(u)"),
    ("tg", "tan(u)"),
    ("cot", "1 / tan(u)"),
    ("ctg", "1 / tan(u)"),
    ("sec", "1 / cos(u)"),
    ("csc", "1 / sin(u)"),
    ("sgn", "sign(u)"),
    ("fabs", "abs(u)"),
    ("ceiling", "ceil(u)"),
    ("square", "u^2"),
    ("cube", "u^3"),
    ("root", "u^(1/n)"),
    ("lerp", "mix(a, b, s)"),
    ("grad", "gradient(f)"),
    ("norm", "length(v)"),
    ("diff", "deriv(f, x)"),
    ("subtract", "difference(a, b)"),
    ("intersection", "intersect(a, b)"),
    ("ball", "sphere(radius)"),
    ("cuboid", "box(size)"),
    ("cube", "box(size)"),
];

/// What to write instead of a name that is known elsewhere.
pub(super) fn synonym(name: &str) -> Option<&'static str> {
    SYNONYMS.iter().find(|(other, _)| *other == name).map(|(_, ours)| *ours)
}
