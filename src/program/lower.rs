//! Expressions to meanings: what each node of the AST becomes in the graph.
//!
//! Everything is inlined here, so the lowering holds a stack of calls, refuses to nest or to grow without bound, and
//! reports an error inside a function together with the call that led there. Chains of operands are walked in loops;
//! sums and products become left chains, `and` and `or` balanced trees.

use std::collections::HashSet;
use std::rc::Rc;

use crate::diagnostic::Diagnostic;
use crate::diagnostic::Label;
use crate::diagnostic::Span;
use crate::graph::Graph;
use crate::graph::Op;
use crate::graph::Value;
use crate::limits::Budget;
use crate::limits::Exceeded;
use crate::syntax::ast::Expr;
use crate::syntax::ast::ExprKind;
use crate::syntax::ast::Join;
use crate::syntax::ast::Relation;
use crate::syntax::ast::Sign;
use crate::syntax::ast::StatementKind;

use super::builtins::Constant;
use super::errors;
use super::exponent::Exact;
use super::names::Lookup;
use super::names::Program;
use super::resolve::Context;
use super::resolve::Differentiate;
use super::values::Equation;
use super::values::Function;
use super::values::ItemId;
use super::values::Meaning;
use super::values::Truth;

/// Levels of expressions open at once, inlined calls included; the parser alone allows 256 brackets with a few levels
/// each. Measured at optimisation level 1, a level takes 690 bytes of stack and a call 1630 more, so that this is at most
/// 1.4 MB of the 2 MiB that the smallest of Rust's threads have.
const MAX_DEPTH: usize = 2000;

/// Levels that a call or product `name(...)` counts.
const CALL_LEVELS: usize = 3;

/// The state of lowering one program into one graph.
pub(super) struct Lowerer<'p> {
    pub program: &'p Program,
    pub graph: Graph,
    pub exact: Exact,
    pub differentiate: &'p Differentiate,
    pub budget: &'p Budget,
    diagnostics: Vec<Diagnostic>,
    reported: HashSet<(&'static str, Option<Span>)>,
    /// By item, once evaluated.
    meanings: Vec<Option<Meaning>>,
    frames: Vec<Frame>,
    depth: usize,
    /// Steps spent inside functions: expressions inlined and nodes copied. What is written in the file itself is linear
    /// in its length and not counted.
    expansion: usize,
    exhausted: bool,
}

/// One inlined call, or the statement at the bottom.
struct Frame {
    file: usize,
    locals: Vec<(String, Meaning)>,
    /// The function's name and where it is called.
    call: Option<(String, Span)>,
}

impl<'p> Lowerer<'p> {
    pub fn new(program: &'p Program, context: &Context<'p>) -> Self {
        Self {
            program,
            graph: Graph::new(),
            exact: Exact::default(),
            differentiate: context.differentiate,
            budget: context.budget,
            diagnostics: Vec::new(),
            reported: HashSet::new(),
            meanings: vec![None; program.items.len()],
            frames: vec![Frame { file: 0, locals: Vec::new(), call: None }],
            depth: 0,
            expansion: 0,
            exhausted: false,
        }
    }

    pub fn into_results(self) -> (Graph, Vec<Diagnostic>) {
        (self.graph, self.diagnostics)
    }

    /// What has been reported; then all is forgotten, so that the next formula reports the same things anew.
    pub fn take_diagnostics(&mut self) -> Vec<Diagnostic> {
        self.reported.clear();
        std::mem::take(&mut self.diagnostics)
    }

    pub fn has_errors(&self) -> bool {
        !self.diagnostics.is_empty()
    }

    /// Evaluates every definition that is used, each after what it needs.
    pub fn evaluate_items(&mut self) {
        for &id in &self.program.order {
            let item = &self.program.items[id.0];
            let meaning = match &self.program.statement(id).kind {
                _ if item.broken => Meaning::Invalid,
                StatementKind::Let { value, .. } => self.in_file(item.file, |lowerer| lowerer.lower(value)),
                StatementKind::Fn { .. } => Meaning::Function(Function::Defined(id)),
                StatementKind::Param { name, .. } => Meaning::Scalar(self.graph.var(&name.text)),
                StatementKind::Shape { relation, .. } => self.in_file(item.file, |lowerer| lowerer.lower(relation)),
                StatementKind::Domain { .. } | StatementKind::Import { .. } => Meaning::Invalid,
            };
            self.meanings[id.0] = Some(meaning);
        }
    }

    /// The meaning of an evaluated definition.
    pub fn item(&self, id: ItemId) -> Meaning {
        self.meanings[id.0].clone().unwrap_or(Meaning::Invalid)
    }

    /// Adds a message, once per place. In a function of the library the user's call becomes the main place.
    pub fn report(&mut self, mut diagnostic: Diagnostic) {
        let library = |frame: &Frame| self.program.files[frame.file].origin.library;
        let last = self.frames.len() - 1;
        if library(&self.frames[last]) {
            let entered = (1..=last).rev().find(|&i| !library(&self.frames[i - 1]));
            if let Some((name, span)) = entered.and_then(|i| self.frames[i].call.as_ref()) {
                diagnostic.labels.insert(0, Label { span: *span, text: format!("in this call of `{name}`") });
            }
        } else if let Some((name, span)) = &self.frames[last].call {
            diagnostic = diagnostic.at(*span, format!("`{name}` is called here"));
        }
        if self.reported.insert((diagnostic.code, diagnostic.labels.first().map(|label| label.span))) {
            self.diagnostics.push(diagnostic);
        }
    }

    /// Reports a value of the wrong kind, unless it is the trace of an error already reported.
    pub fn report_kind(&mut self, needs: &str, found: &Meaning, span: Span) {
        if matches!(found, Meaning::Invalid) {
            return;
        }
        let mut diagnostic = errors::wrong_kind(needs, found.kind(), span);
        match found {
            Meaning::Truth(_) | Meaning::Equation(_) => {
                diagnostic =
                    diagnostic.help("`if ... then 1 else 0` makes a number of a condition, field(...) of a shape");
            }
            Meaning::Function(function) => {
                diagnostic = diagnostic.help(format!("call it, for example `{}(x)`", self.function_name(*function)));
            }
            _ => {}
        }
        self.report(diagnostic);
    }

    /// Counts work done inside functions; `false`, with a message, when it is too much.
    pub fn spend(&mut self, steps: usize, span: Span) -> bool {
        self.expansion = self.expansion.saturating_add(steps);
        if !self.exhausted && self.budget.steps(self.expansion).is_err() {
            self.give_up(errors::too_much_expansion(self.written(span)));
        }
        !self.exhausted
    }

    /// The call that was written, not the one among millions at which patience ended.
    fn written(&self, span: Span) -> Span {
        let call = self.frames.iter().find_map(|frame| frame.call.as_ref());
        call.map_or(span, |(_, span)| *span)
    }

    /// Whether time is left and the graph is no larger than allowed; a message when it no longer is.
    fn affords(&mut self, span: Span) -> bool {
        if !self.exhausted
            && let Err(exceeded) = self.budget.tick().and_then(|()| self.budget.nodes(self.graph.len()))
        {
            // Functions that multiply are what makes a graph large most often.
            let inlined = self.frames.iter().any(|frame| frame.call.is_some());
            self.give_up(match exceeded {
                Exceeded::Count { .. } if inlined => errors::too_much_expansion(self.written(span)),
                _ => Diagnostic::from(exceeded).at(self.written(span), "given up here"),
            });
        }
        !self.exhausted
    }

    /// Ends the work: once, wherever a limit is met first; everything after it is given up too.
    pub fn give_up(&mut self, diagnostic: Diagnostic) {
        if !std::mem::replace(&mut self.exhausted, true) {
            self.diagnostics.push(diagnostic);
        }
    }

    /// Lowers `body` with the parameters of a called function, which are lent.
    pub fn in_frame(
        &mut self,
        file: usize,
        locals: &mut Vec<(String, Meaning)>,
        call: (String, Span),
        body: &Expr,
    ) -> Meaning {
        self.frames.push(Frame { file, locals: std::mem::take(locals), call: Some(call) });
        let meaning = self.lower(body);
        *locals = self.frames.pop().map(|frame| frame.locals).unwrap_or_default();
        meaning
    }

    /// Runs something with the names of another file.
    pub fn in_file<T>(&mut self, file: usize, run: impl FnOnce(&mut Self) -> T) -> T {
        self.frames.push(Frame { file, locals: Vec::new(), call: None });
        let result = run(self);
        self.frames.pop();
        result
    }

    /// What a name means at this place.
    pub fn name(&mut self, name: &str) -> Meaning {
        let Some(frame) = self.frames.last() else { return Meaning::Invalid };
        if let Some((_, meaning)) = frame.locals.iter().rev().find(|(local, _)| local == name) {
            return meaning.clone();
        }
        match self.program.lookup(frame.file, name) {
            Lookup::Item(id) => self.item(id),
            Lookup::Input => Meaning::Scalar(self.graph.var(name)),
            Lookup::Constant(constant) => Meaning::Scalar(self.constant(constant)),
            Lookup::Builtin(builtin) => Meaning::Function(Function::Builtin(builtin)),
            Lookup::Ambiguous(..) | Lookup::Unknown => Meaning::Invalid,
        }
    }

    /// Whether `name` is a definition of a file rather than the parameter of a function.
    pub fn is_definition(&self, name: &str) -> bool {
        self.frames.last().is_some_and(|frame| frame.locals.iter().all(|(local, _)| local != name))
    }

    fn constant(&mut self, constant: Constant) -> Value {
        match constant {
            Constant::Pi => self.graph.push(Op::Pi, &[]),
            Constant::Tau => {
                let (two, pi) = (self.graph.int(2), self.graph.push(Op::Pi, &[]));
                self.graph.mul(two, pi)
            }
            Constant::E => {
                let one = self.graph.int(1);
                self.graph.unary(Op::Exp, one)
            }
        }
    }

    pub fn function_name(&self, function: Function) -> String {
        match function {
            Function::Builtin(builtin) => builtin.name.to_owned(),
            Function::Defined(id) => self.program.items[id.0].name.text.clone(),
        }
    }

    /// The meaning of an expression; errors are reported and give [`Meaning::Invalid`].
    pub fn lower(&mut self, mut expr: &Expr) -> Meaning {
        while let ExprKind::Group(inner) = &expr.kind {
            expr = inner;
        }
        if self.depth >= MAX_DEPTH {
            self.report(errors::too_deep(expr.span));
            return Meaning::Invalid;
        }
        let inlined = self.frames.last().is_some_and(|frame| frame.call.is_some());
        if inlined && !self.spend(1, expr.span) || !self.affords(expr.span) {
            return Meaning::Invalid;
        }
        self.depth += 1;
        let meaning = self.lower_kind(expr);
        self.depth -= 1;
        meaning
    }

    fn lower_kind(&mut self, expr: &Expr) -> Meaning {
        match &expr.kind {
            ExprKind::Number(number) => Meaning::Scalar(self.graph.constant(number.clone())),
            ExprKind::Name(name) => self.name(name),
            ExprKind::Text(text) => Meaning::Text(Rc::from(text.as_str())),
            ExprKind::List(items) => self.list(items),
            ExprKind::Apply { callee, args } => {
                self.depth += CALL_LEVELS;
                let meaning = self.apply(callee, args, expr.span);
                self.depth -= CALL_LEVELS;
                meaning
            }
            ExprKind::Bars(inner) => self.bars(inner),
            ExprKind::Group(inner) => self.lower(inner),
            ExprKind::Neg(inner) => {
                let meaning = self.lower(inner);
                self.negate(meaning, inner.span)
            }
            ExprKind::Not(inner) => {
                let meaning = self.lower(inner);
                match self.truth("`not` needs a condition", &meaning, inner.span) {
                    Some(truth) => Meaning::Truth(self.not(truth)),
                    None => Meaning::Invalid,
                }
            }
            ExprKind::Sum { first, rest } => {
                let mut sum = self.lower(first);
                let mut span = first.span;
                for (sign, term) in rest {
                    let right = self.lower(term);
                    let op = match sign {
                        Sign::Plus => Op::Add,
                        Sign::Minus => Op::Sub,
                    };
                    sum = self.arithmetic(op, (sum, span), (right, term.span));
                    span = span.to(term.span);
                }
                sum
            }
            ExprKind::Product { first, rest } => self.product(first, rest),
            ExprKind::Power { base, exponent } => self.power_expression(base, exponent),
            ExprKind::Relation { operands, relations } => self.relation(operands, relations, expr.span),
            ExprKind::And(parts) => self.connective(parts, "`and`", Self::and),
            ExprKind::Or(parts) => self.connective(parts, "`or`", Self::or),
            ExprKind::If { condition, then, otherwise } => self.choice(condition, then, otherwise),
        }
    }

    fn list(&mut self, items: &[Expr]) -> Meaning {
        let mut values = Vec::with_capacity(items.len());
        let mut complete = true;
        for item in items {
            let meaning = self.lower(item);
            match self.scalar("a list needs numbers", &meaning, item.span) {
                Some(value) => values.push(value),
                None => complete = false,
            }
        }
        if complete { Meaning::Vector(values.into()) } else { Meaning::Invalid }
    }

    fn bars(&mut self, inner: &Expr) -> Meaning {
        match self.lower(inner) {
            Meaning::Vector(values) => Meaning::Scalar(self.length(&values)),
            meaning => match self.scalar("`|...|` needs a number or a list", &meaning, inner.span) {
                Some(value) => Meaning::Scalar(self.graph.unary(Op::Abs, value)),
                None => Meaning::Invalid,
            },
        }
    }

    fn product(&mut self, first: &Expr, rest: &[(Join, Expr)]) -> Meaning {
        let mut product = self.lower(first);
        let mut span = first.span;
        for (join, factor) in rest {
            if *join == Join::Over {
                self.check_divisor(factor);
            }
            let right = self.lower(factor);
            let op = match join {
                Join::Times | Join::Juxtaposed => Op::Mul,
                Join::Over => Op::Div,
            };
            product = self.arithmetic(op, (product, span), (right, factor.span));
            span = span.to(factor.span);
        }
        product
    }

    fn relation(&mut self, operands: &[Expr], relations: &[Relation], span: Span) -> Meaning {
        let mut values = Vec::with_capacity(operands.len());
        let mut complete = true;
        for operand in operands {
            let meaning = self.lower(operand);
            match self.scalar("a relation compares numbers", &meaning, operand.span) {
                Some(value) => values.push((value, operand.span)),
                None => complete = false,
            }
        }
        if !complete {
            return Meaning::Invalid;
        }
        if let ([(a, _), (b, _)], [Relation::Equal]) = (&values[..], relations) {
            let truth = self.graph.push(Op::Equal, &[*a, *b]);
            return Meaning::Equation(Equation { difference: self.difference(*a, *b), truth, span });
        }
        let mut parts = Vec::with_capacity(relations.len());
        for (pair, relation) in values.windows(2).zip(relations) {
            let ((a, a_span), (b, b_span)) = (pair[0], pair[1]);
            let (op, left, right) = match relation {
                Relation::Less => (Op::Less, a, b),
                Relation::LessEqual => (Op::LessEqual, a, b),
                Relation::Greater => (Op::Less, b, a),
                Relation::GreaterEqual => (Op::LessEqual, b, a),
                Relation::Equal | Relation::NotEqual => (Op::Equal, a, b),
            };
            let value = self.graph.push(op, &[left, right]);
            parts.push(match relation {
                Relation::Equal => Truth { value, solid: Err(a_span.to(b_span)) },
                Relation::NotEqual => {
                    let part = Truth { value, solid: Err(a_span.to(b_span)) };
                    self.not(part)
                }
                _ => Truth { value, solid: Ok(self.difference(left, right)) },
            });
        }
        Meaning::Truth(self.and(&parts))
    }

    /// `a - b`, where a literal 0 on either side is not worth a node.
    pub fn difference(&mut self, a: Value, b: Value) -> Value {
        if self.graph.is_zero(b) {
            a
        } else if self.graph.is_zero(a) {
            self.graph.neg(b)
        } else {
            self.graph.sub(a, b)
        }
    }

    fn connective(&mut self, parts: &[Expr], word: &str, combine: fn(&mut Self, &[Truth]) -> Truth) -> Meaning {
        let needs = format!("{word} needs conditions or regions");
        let mut truths = Vec::with_capacity(parts.len());
        for part in parts {
            let meaning = self.lower(part);
            truths.extend(self.truth(&needs, &meaning, part.span));
        }
        if truths.len() == parts.len() { Meaning::Truth(combine(self, &truths)) } else { Meaning::Invalid }
    }

    fn choice(&mut self, condition: &Expr, then: &Expr, otherwise: &Expr) -> Meaning {
        let tested = self.lower(condition);
        let truth = self.truth("`if` needs a condition", &tested, condition.span);
        let (yes, no) = (self.lower(then), self.lower(otherwise));
        let Some(truth) = truth else { return Meaning::Invalid };
        let mut select = |a: Value, b: Value| self.graph.push(Op::Select, &[truth.value, a, b]);
        match (&yes, &no) {
            (Meaning::Invalid, _) | (_, Meaning::Invalid) => Meaning::Invalid,
            (Meaning::Scalar(a), Meaning::Scalar(b)) => Meaning::Scalar(select(*a, *b)),
            (Meaning::Vector(a), Meaning::Vector(b)) if a.len() == b.len() => {
                Meaning::Vector(a.iter().zip(b.iter()).map(|(&a, &b)| select(a, b)).collect())
            }
            (Meaning::Vector(a), Meaning::Vector(b)) => {
                self.report(errors::lengths_differ(a.len(), b.len(), then.span.to(otherwise.span)));
                Meaning::Invalid
            }
            (Meaning::Equation(a), Meaning::Equation(b)) => Meaning::Equation(Equation {
                difference: select(a.difference, b.difference),
                truth: select(a.truth, b.truth),
                span: a.span,
            }),
            (Meaning::Truth(_) | Meaning::Equation(_), Meaning::Truth(_) | Meaning::Equation(_)) => {
                let (Some(a), Some(b)) = (as_truth(&yes), as_truth(&no)) else { return Meaning::Invalid };
                let value = select(a.value, b.value);
                let solid = a.solid.and_then(|a| b.solid.map(|b| select(a, b)));
                Meaning::Truth(Truth { value, solid })
            }
            (Meaning::Function(_) | Meaning::Text(_), _) => {
                self.report_kind("`if` chooses between numbers or regions", &yes, then.span);
                Meaning::Invalid
            }
            (expected, _) => {
                let needs = format!("both arms of `if` must be of one kind: after {} here", expected.kind());
                let diagnostic = errors::wrong_kind(&needs, no.kind(), otherwise.span);
                self.report(diagnostic.help("`else` reaches to the end; to go on after it put the `if` in brackets"));
                Meaning::Invalid
            }
        }
    }

    /// The number that a meaning is, else a message.
    pub fn scalar(&mut self, needs: &str, meaning: &Meaning, span: Span) -> Option<Value> {
        match meaning {
            Meaning::Scalar(value) => Some(*value),
            other => {
                self.report_kind(needs, other, span);
                None
            }
        }
    }

    /// The condition that a meaning is, else a message.
    pub fn truth(&mut self, needs: &str, meaning: &Meaning, span: Span) -> Option<Truth> {
        let truth = as_truth(meaning);
        if truth.is_none() {
            if let Meaning::Scalar(_) = meaning {
                let diagnostic = errors::wrong_kind(needs, meaning.kind(), span);
                self.report(diagnostic.help("compare it with something, as in `... > 0`"));
            } else {
                self.report_kind(needs, meaning, span);
            }
        }
        truth
    }
}

/// A condition as such, an equation as the condition that it holds.
pub(super) fn as_truth(meaning: &Meaning) -> Option<Truth> {
    match meaning {
        Meaning::Truth(truth) => Some(*truth),
        Meaning::Equation(equation) => Some(Truth { value: equation.truth, solid: Err(equation.span) }),
        _ => None,
    }
}
