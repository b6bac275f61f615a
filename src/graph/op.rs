//! The one table of operations. Every other place that treats operations matches on [`Op`] without a wildcard, so a
//! row added here makes the compiler list what else has to be written.

/// How affine forms pass through an operation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AffineForm {
    /// Exact up to rounding: every noise symbol keeps its meaning.
    Exact,
    /// A certified affine approximation with an error term: between two lines, a product of forms, or composed of
    /// those. Where the operation has no bounds, through the interval all the same.
    Approximated,
    /// Through the interval enclosure: the result has an error term alone.
    ThroughInterval,
}

/// Where an operation may fail to be defined or continuous.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Totality {
    /// Defined and continuous on all of its arguments' reals.
    Continuous,
    /// Defined everywhere, with jumps.
    Jumps,
    /// Undefined somewhere, continuous where defined.
    Partial,
    /// Undefined somewhere and with jumps.
    PartialJumps,
}

macro_rules! op_table {
    ($($variant:ident $arity:literal $name:literal $affine:ident $totality:ident $doc:literal;)*) => {
        /// An operation of the graph. Operands and domains are those of IEEE 1788-2015 section 9.1 where it lists
        /// the operation.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Op {
            /// An exact rational constant, an index into the graph's constants.
            Const(u32),
            /// An input, an index into the graph's variables.
            Var(u32),
            /// `x^n` for an integer n: total for n >= 0 (with x^0 = 1), a pole at 0 for n < 0.
            PowInt(i32),
            /// `x^(p/q)`, reduced, q >= 2 (q > 0). With odd q real for x < 0; with even q the domain is [0, inf); p <
            /// 0 excludes 0.
            PowRatio(i32, u32),
            $(#[doc = $doc] $variant,)*
        }

        impl Op {
            /// Every operation without payload.
            pub const PLAIN: &[Op] = &[$(Op::$variant),*];

            /// The number of operands.
            pub const fn arity(self) -> usize {
                match self {
                    Op::Const(_) | Op::Var(_) => 0,
                    Op::PowInt(_) | Op::PowRatio(..) => 1,
                    $(Op::$variant => $arity,)*
                }
            }

            /// The name in the textual form, which for operations that the language offers is the language's own.
            pub const fn name(self) -> &'static str {
                match self {
                    Op::Const(_) => "const",
                    Op::Var(_) => "var",
                    Op::PowInt(_) => "powi",
                    Op::PowRatio(..) => "powr",
                    $(Op::$variant => $name,)*
                }
            }

            /// One line on what it does.
            pub const fn doc(self) -> &'static str {
                match self {
                    Op::Const(_) => "An exact rational constant.",
                    Op::Var(_) => "An input.",
                    Op::PowInt(_) => "An integer power.",
                    Op::PowRatio(..) => "A rational power; real for negative arguments when the denominator is odd.",
                    $(Op::$variant => $doc,)*
                }
            }

            /// How affine forms pass through it.
            pub const fn affine(self) -> AffineForm {
                match self {
                    Op::Const(_) | Op::Var(_) => AffineForm::Exact,
                    Op::PowInt(_) | Op::PowRatio(..) => AffineForm::Approximated,
                    $(Op::$variant => AffineForm::$affine,)*
                }
            }

            /// Where it may fail to be defined or continuous.
            pub const fn totality(self) -> Totality {
                match self {
                    Op::Const(_) | Op::Var(_) => Totality::Continuous,
                    Op::PowInt(n) => if n < 0 { Totality::Partial } else { Totality::Continuous },
                    Op::PowRatio(p, q) => if p < 0 || q % 2 == 0 { Totality::Partial } else { Totality::Continuous },
                    $(Op::$variant => Totality::$totality,)*
                }
            }
        }
    };
}

op_table! {
    Pi 0 "pi" Exact Continuous "The circle constant, exactly.";
    Entire 0 "entire" ThroughInterval Jumps "All reals: the derivative across a possible jump.";
    Neg 1 "neg" Exact Continuous "-x";
    Sqr 1 "sqr" Approximated Continuous "x^2; tighter than x * x, whose factors are one value.";
    Sqrt 1 "sqrt" Approximated Partial "Square root on [0, inf).";
    Cbrt 1 "cbrt" Approximated Continuous "Cube root, odd.";
    Abs 1 "abs" Approximated Continuous "Absolute value.";
    Sign 1 "sign" ThroughInterval Jumps "-1, 0 or 1.";
    Floor 1 "floor" ThroughInterval Jumps "The largest integer not above x.";
    Ceil 1 "ceil" ThroughInterval Jumps "The smallest integer not below x.";
    Round 1 "round" ThroughInterval Jumps "The nearest integer, halves away from zero.";
    Exp 1 "exp" Approximated Continuous "e^x";
    Exp2 1 "exp2" Approximated Continuous "2^x";
    Exp10 1 "exp10" Approximated Continuous "10^x";
    Expm1 1 "expm1" Approximated Continuous "e^x - 1, accurate near 0.";
    Ln 1 "ln" Approximated Partial "Natural logarithm on (0, inf).";
    Log1p 1 "log1p" Approximated Partial "ln(1 + x), accurate near 0, on (-1, inf).";
    Log2 1 "log2" Approximated Partial "Logarithm to base 2 on (0, inf).";
    Log10 1 "log10" Approximated Partial "Logarithm to base 10 on (0, inf).";
    Sin 1 "sin" Approximated Continuous "Sine of an angle in radians.";
    Cos 1 "cos" Approximated Continuous "Cosine of an angle in radians.";
    Tan 1 "tan" Approximated Partial "Tangent of an angle in radians; poles at odd multiples of pi/2.";
    Asin 1 "asin" Approximated Partial "Inverse sine on [-1, 1].";
    Acos 1 "acos" Approximated Partial "Inverse cosine on [-1, 1].";
    Atan 1 "atan" Approximated Continuous "Inverse tangent.";
    Sinh 1 "sinh" Approximated Continuous "Hyperbolic sine.";
    Cosh 1 "cosh" Approximated Continuous "Hyperbolic cosine.";
    Tanh 1 "tanh" Approximated Continuous "Hyperbolic tangent.";
    Asinh 1 "asinh" Approximated Continuous "Inverse hyperbolic sine.";
    Acosh 1 "acosh" Approximated Partial "Inverse hyperbolic cosine on [1, inf).";
    Atanh 1 "atanh" Approximated Partial "Inverse hyperbolic tangent on (-1, 1).";
    Add 2 "add" Exact Continuous "x + y";
    Sub 2 "sub" Exact Continuous "x - y";
    Mul 2 "mul" Approximated Continuous "x y";
    Div 2 "div" Approximated Partial "x / y for y other than 0.";
    Min 2 "min" Approximated Continuous "The smaller of two values.";
    Max 2 "max" Approximated Continuous "The larger of two values.";
    Mod 2 "mod" ThroughInterval PartialJumps "x - y floor(x / y), with the sign of y; undefined for y = 0.";
    Hypot 2 "hypot" Approximated Continuous "sqrt(x^2 + y^2)";
    Pow 2 "pow" Approximated Partial "x^y on x > 0, and 0^y = 0 for y > 0.";
    Atan2 2 "atan2" Approximated PartialJumps "The angle of the point (second, first); undefined at the origin, jumps on the negative axis.";
    Less 2 "less" ThroughInterval Jumps "1 where x < y, else 0.";
    LessEqual 2 "less_equal" ThroughInterval Jumps "1 where x <= y, else 0.";
    Equal 2 "equal" ThroughInterval Jumps "1 where x = y, else 0.";
    Select 3 "select" ThroughInterval Jumps "The second operand where the first is 1, the third where it is 0; undecided, the hull of both.";
    Kink 3 "kink" ThroughInterval Jumps "The second operand where the first is < 0, the third where it is > 0, both where it may be 0: the derivative at a kink.";
    SelectJump 3 "select_jump" ThroughInterval Jumps "Select of derivatives across a possible jump: undecided it is the whole line.";
}

/// The elementary functions of one argument, as a pattern: what most places treat alike, without losing the compiler's word
/// that no operation is forgotten.
macro_rules! elementary_function {
    () => {
        $crate::graph::Op::Cbrt
            | $crate::graph::Op::Exp
            | $crate::graph::Op::Exp2
            | $crate::graph::Op::Exp10
            | $crate::graph::Op::Expm1
            | $crate::graph::Op::Ln
            | $crate::graph::Op::Log1p
            | $crate::graph::Op::Log2
            | $crate::graph::Op::Log10
            | $crate::graph::Op::Sin
            | $crate::graph::Op::Cos
            | $crate::graph::Op::Tan
            | $crate::graph::Op::Asin
            | $crate::graph::Op::Acos
            | $crate::graph::Op::Atan
            | $crate::graph::Op::Sinh
            | $crate::graph::Op::Cosh
            | $crate::graph::Op::Tanh
            | $crate::graph::Op::Asinh
            | $crate::graph::Op::Acosh
            | $crate::graph::Op::Atanh
    };
}
pub(crate) use elementary_function;

impl Op {
    /// The operation without payload that has this textual name.
    pub fn from_name(name: &str) -> Option<Op> {
        Op::PLAIN.iter().copied().find(|op| op.name() == name)
    }
}
