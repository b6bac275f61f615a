//! Arithmetic on meanings: numbers, lists of numbers, and regions.

use crate::diagnostic::Span;
use crate::graph::Op;
use crate::graph::Value;
use crate::syntax::ast::Expr;
use crate::syntax::ast::ExprKind;

use super::errors;
use super::exponent;
use super::exponent::PowerError;
use super::lower::Lowerer;
use super::values::Meaning;
use super::values::Truth;

impl Lowerer<'_> {
    pub fn negate(&mut self, meaning: Meaning, span: Span) -> Meaning {
        match meaning {
            Meaning::Scalar(value) => Meaning::Scalar(self.graph.neg(value)),
            Meaning::Vector(values) => Meaning::Vector(values.iter().map(|&value| self.graph.neg(value)).collect()),
            other => {
                self.report_kind("`-` needs a number", &other, span);
                Meaning::Invalid
            }
        }
    }

    /// Addition, subtraction, multiplication and division. Lists add component by component, and a number times a list
    /// scales it.
    pub fn arithmetic(&mut self, op: Op, (a, a_span): (Meaning, Span), (b, b_span): (Meaning, Span)) -> Meaning {
        let linear = matches!(op, Op::Add | Op::Sub);
        // A list of any length takes two letters.
        if let (Meaning::Vector(list), _) | (_, Meaning::Vector(list)) = (&a, &b)
            && !self.spend(list.len(), a_span.to(b_span))
        {
            return Meaning::Invalid;
        }
        match (&a, &b) {
            (Meaning::Invalid, _) | (_, Meaning::Invalid) => Meaning::Invalid,
            (Meaning::Scalar(a), Meaning::Scalar(b)) => Meaning::Scalar(self.graph.push(op, &[*a, *b])),
            (Meaning::Vector(a), Meaning::Vector(b)) if linear => {
                if a.len() != b.len() {
                    self.report(errors::lengths_differ(a.len(), b.len(), a_span.to(b_span)));
                    return Meaning::Invalid;
                }
                Meaning::Vector(a.iter().zip(b.iter()).map(|(&a, &b)| self.graph.push(op, &[a, b])).collect())
            }
            (Meaning::Vector(a), Meaning::Scalar(b)) if !linear => {
                Meaning::Vector(a.iter().map(|&a| self.graph.push(op, &[a, *b])).collect())
            }
            (Meaning::Scalar(a), Meaning::Vector(b)) if op == Op::Mul => {
                Meaning::Vector(b.iter().map(|&b| self.graph.push(op, &[*a, b])).collect())
            }
            (Meaning::Vector(_), Meaning::Vector(_)) if op == Op::Mul => {
                let diagnostic = errors::wrong_kind("a product has one list at most", b.kind(), b_span);
                self.report(diagnostic.help("write dot(v, w) or cross(v, w)"));
                Meaning::Invalid
            }
            _ => {
                let (sign, verb) = match op {
                    Op::Add => ("+", "adds"),
                    Op::Sub => ("-", "subtracts"),
                    Op::Div => ("/", "divides by"),
                    _ => ("*", "multiplies"),
                };
                // Blame the side that is no number; of two lists or numbers that do not fit, the right one.
                let simple = |meaning: &Meaning| matches!(meaning, Meaning::Scalar(_) | Meaning::Vector(_));
                let (bad, span) = if simple(&a) { (&b, b_span) } else { (&a, a_span) };
                let needs = match (&a, op) {
                    (Meaning::Vector(_), _) if linear => format!("`{sign}` {verb} a list to a list"),
                    _ => format!("`{sign}` needs numbers"),
                };
                self.report_kind(&needs, bad, span);
                Meaning::Invalid
            }
        }
    }

    /// The Euclidean length of a list.
    pub fn length(&mut self, values: &[Value]) -> Value {
        match *values {
            [] => self.graph.int(0),
            [a] => self.graph.unary(Op::Abs, a),
            [a, b] => self.graph.push(Op::Hypot, &[a, b]),
            _ => {
                let squares = self.dot(values, values);
                self.graph.unary(Op::Sqrt, squares)
            }
        }
    }

    /// The inner product of two lists of equal length.
    pub fn dot(&mut self, a: &[Value], b: &[Value]) -> Value {
        let mut sum = None;
        for (&a, &b) in a.iter().zip(b) {
            let product = if a == b { self.graph.sqr(a) } else { self.graph.mul(a, b) };
            sum = Some(match sum {
                Some(sum) => self.graph.add(sum, product),
                None => product,
            });
        }
        sum.unwrap_or_else(|| self.graph.int(0))
    }

    /// The complement.
    pub fn not(&mut self, truth: Truth) -> Truth {
        let one = self.graph.int(1);
        Truth { value: self.graph.sub(one, truth.value), solid: truth.solid.map(|field| self.graph.neg(field)) }
    }

    /// All of them: the intersection.
    pub fn and(&mut self, parts: &[Truth]) -> Truth {
        self.combine(parts, Op::Min, Op::Max)
    }

    /// At least one of them: the union.
    pub fn or(&mut self, parts: &[Truth]) -> Truth {
        self.combine(parts, Op::Max, Op::Min)
    }

    fn combine(&mut self, parts: &[Truth], truth: Op, field: Op) -> Truth {
        let values = parts.iter().map(|part| part.value).collect();
        let fields: Result<Vec<Value>, Span> = parts.iter().map(|part| part.solid).collect();
        Truth { value: self.balanced(truth, values), solid: fields.map(|fields| self.balanced(field, fields)) }
    }

    /// An associative operation over one or more values as a tree of logarithmic depth: choices among thousands of
    /// parts are then pruned in few steps.
    pub fn balanced(&mut self, op: Op, mut values: Vec<Value>) -> Value {
        while values.len() > 1 {
            let pair = |pair: &[Value]| match *pair {
                [a, b] => self.graph.push(op, &[a, b]),
                _ => pair[0],
            };
            values = values.chunks(2).map(pair).collect();
        }
        values[0]
    }

    /// `base ^ exponent` of numbers.
    pub fn power(&mut self, base: &Meaning, base_span: Span, exponent: &Meaning, exponent_span: Span) -> Meaning {
        if let Meaning::Vector(_) = base {
            let diagnostic = errors::wrong_kind("`^` needs a number", base.kind(), base_span);
            self.report(diagnostic.help("the square of a list's length is dot(v, v)"));
            return Meaning::Invalid;
        }
        let base = self.scalar("`^` needs a number", base, base_span);
        let exponent = self.scalar("an exponent is a number", exponent, exponent_span);
        let (Some(base), Some(exponent)) = (base, exponent) else { return Meaning::Invalid };
        match exponent::power(&mut self.graph, &mut self.exact, base, exponent) {
            Ok(value) => Meaning::Scalar(value),
            Err(PowerError::TooLarge(number)) => {
                let help = if number.is_integer() {
                    "for growth of this order use exp(...)"
                } else {
                    "write the exponent as a fraction of smaller numbers"
                };
                self.report(errors::exponent_too_large(&number.to_string(), exponent_span, help));
                Meaning::Invalid
            }
        }
    }

    /// A power as written. `a(b)^n` with a number `a` is `a * b^n`, and `c^a(b)` is `c^a * b` (language rules 5 and 6);
    /// only here is it known what `a` is.
    pub fn power_expression(&mut self, base: &Expr, exponent: &Expr) -> Meaning {
        if let Some((factor, inner)) = self.as_product(base) {
            let factor = (self.name(factor), base.span);
            let inner_meaning = self.lower(inner);
            let power = self.raise(inner_meaning, inner.span, exponent);
            return self.arithmetic(Op::Mul, factor, (power, inner.span.to(exponent.span)));
        }
        let meaning = self.lower(base);
        self.raise(meaning, base.span, exponent)
    }

    /// A meaning to the power of an exponent as written, which may carry a product behind it.
    fn raise(&mut self, base: Meaning, base_span: Span, exponent: &Expr) -> Meaning {
        let mut bare = exponent;
        let mut negative = false;
        while let ExprKind::Neg(inner) = &bare.kind {
            negative = !negative;
            bare = inner;
        }
        let (product, outer) = match &bare.kind {
            ExprKind::Power { base, exponent } => (self.as_product(base), Some(&**exponent)),
            _ => (self.as_product(bare), None),
        };
        let Some((factor, inner)) = product else {
            let meaning = self.lower(exponent);
            return self.power(&base, base_span, &meaning, exponent.span);
        };
        let mut small = self.name(factor);
        if negative {
            small = self.negate(small, bare.span);
        }
        let power = self.power(&base, base_span, &small, bare.span);
        let mut behind = self.lower(inner);
        if let Some(outer) = outer {
            behind = self.raise(behind, inner.span, outer);
        }
        self.arithmetic(Op::Mul, (power, base_span), (behind, inner.span))
    }

    /// `a(b)` where `a` is no function: the name and the factor.
    pub fn as_product<'e>(&mut self, expr: &'e Expr) -> Option<(&'e str, &'e Expr)> {
        let ExprKind::Apply { callee, args } = &expr.kind else { return None };
        let [argument] = &args[..] else { return None };
        let number = matches!(self.name(&callee.text), Meaning::Scalar(_) | Meaning::Vector(_));
        (number && argument.name.is_none()).then_some((&callee.text, &argument.value))
    }

    /// `1/a(b)` with a number `a` is as ambiguous as `1/2x` (language rule 7).
    pub fn check_divisor(&mut self, factor: &Expr) {
        let last = match &factor.kind {
            ExprKind::Power { base, .. } => base,
            _ => factor,
        };
        if self.as_product(last).is_none() {
            return;
        }
        if let ExprKind::Apply { callee, .. } = &last.kind {
            self.report(errors::ambiguous_division(&callee.text, factor.span));
        }
    }
}
