//! The text of an expression, with definitions and values around it, to a graph ready to be enclosed: the one path for
//! `imp eval`, the REPL and `imp cost EXPR`.

use std::collections::BTreeMap;
use std::collections::HashMap;
use std::io;
use std::ops::Range;
use std::path::Path;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::Mutex;
use std::sync::PoisonError;

use crate::derive;
use crate::derive::Arithmetic;
use crate::derive::Formula;
use crate::derive::Output;
use crate::derive::Rounding;
use crate::derive::Spec;
use crate::diagnostic;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::FileId;
use crate::diagnostic::SourceMap;
use crate::diagnostic::Span;
use crate::diagnostic::code;
use crate::graph;
use crate::graph::Graph;
use crate::graph::Op;
use crate::graph::Value;
use crate::interval::Decorated;
use crate::interval::Decoration;
use crate::interval::Interval;
use crate::program;
use crate::program::Context;
use crate::program::FileSystem;
use crate::program::Importer;
use crate::program::scene::COORDINATES;
use crate::program::scene::Parameter;
use crate::syntax;
use crate::syntax::ast::Argument;
use crate::syntax::ast::Expr;
use crate::syntax::ast::ExprKind;
use crate::syntax::ast::Module;
use crate::syntax::ast::Name;
use crate::syntax::ast::Relation;
use crate::syntax::ast::Sign;
use crate::syntax::ast::Statement;
use crate::syntax::ast::StatementKind;

/// What variables are: boxes by name.
pub type Bindings = BTreeMap<String, Decorated>;

/// Messages with the sources that they point into.
#[derive(Debug)]
pub struct Messages {
    pub sources: SourceMap,
    pub diagnostics: Vec<Diagnostic>,
}

impl Messages {
    /// Adds an edit to try to the last message.
    pub fn help(mut self, text: impl Into<String>) -> Self {
        if let Some(last) = self.diagnostics.last_mut() {
            last.help.push(text.into());
        }
        self
    }

    /// As text for the user.
    pub fn render(&self, colour: bool) -> String {
        diagnostic::render(&self.sources, &self.diagnostics, colour)
    }
}

impl From<Diagnostic> for Messages {
    fn from(diagnostic: Diagnostic) -> Self {
        Self { sources: SourceMap::default(), diagnostics: vec![diagnostic] }
    }
}

/// Part of a text that is shown as a whole when a message points into the part.
#[derive(Debug, Clone)]
pub struct Snippet<'a> {
    /// Of the text, in messages.
    pub name: &'a str,
    pub text: &'a str,
    pub part: Range<usize>,
}

impl<'a> Snippet<'a> {
    /// All of a text.
    pub fn whole(name: &'a str, text: &'a str) -> Self {
        Self { name, text, part: 0..text.len() }
    }

    /// A part of this part, given by its place in it.
    pub fn within(&self, part: Range<usize>) -> Self {
        Self { part: self.part.start + part.start..self.part.start + part.end, ..self.clone() }
    }

    pub fn as_str(&self) -> &'a str {
        &self.text[self.part.clone()]
    }

    /// A message about this part alone.
    pub fn fault(&self, code: &'static str, title: impl Into<String>, label: impl Into<String>) -> Messages {
        let mut sources = SourceMap::default();
        let file = sources.add(self.name, self.text);
        let span = Span { file, start: self.part.start as u32, end: self.part.end as u32 };
        Messages { sources, diagnostics: vec![Diagnostic::error(code, title).at(span, label)] }
    }

    /// The whole text as a source, and the part with blanks in place of what stands before, which keeps the offsets.
    fn add_to(&self, sources: &mut SourceMap) -> (FileId, String) {
        let padded = " ".repeat(self.part.start) + self.as_str();
        (sources.add(self.name, self.text), padded)
    }

    /// Reads the part as an expression whose places are those of the whole text.
    fn parse(&self, sources: &mut SourceMap) -> Result<Expr, Vec<Diagnostic>> {
        let (file, padded) = self.add_to(sources);
        syntax::parse_expression(file, &padded)
    }
}

/// How an expression is understood.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reading {
    /// A number; a condition or an equation is its truth value.
    Value,
    /// A number that may be 0: of an equation the difference of its sides, of the name of a function its value at x.
    Zero,
}

/// Definitions from which expressions are made.
#[derive(Debug, Default)]
pub struct Workspace {
    sources: SourceMap,
    definitions: Module,
    files: CachedFiles,
}

impl Workspace {
    /// Adds the definitions (`let`, `fn`, `param`, `import`) of a text; the names that they define.
    ///
    /// # Errors
    /// What is wrong with them; then nothing has changed.
    pub fn define(&mut self, snippet: &Snippet, variables: &Bindings) -> Result<Vec<String>, Messages> {
        let mut sources = self.sources.clone();
        let (file, padded) = snippet.add_to(&mut sources);
        let (module, mut found) = syntax::parse(file, &padded);
        found.extend(module.statements.iter().filter_map(misplaced));
        if !found.is_empty() {
            return Err(Messages { sources, diagnostics: found });
        }
        let names: Vec<String> = module.statements.iter().filter_map(defined).map(str::to_owned).collect();
        let mut definitions = self.definitions.clone();
        definitions.statements.retain(|old| defined(old).is_none_or(|name| !names.iter().any(|new| new == name)));
        definitions.statements.extend(module.statements);
        self.adopt(sources, file, definitions, variables, &names)?;
        Ok(names)
    }

    /// Makes the definitions of a file visible, as `import` does; read anew if it was loaded before.
    ///
    /// # Errors
    /// If the file or a definition in it cannot be read; then nothing has changed.
    pub fn load(&mut self, path: &Snippet, variables: &Bindings) -> Result<(), Messages> {
        self.files.forget();
        let mut sources = self.sources.clone();
        let file = sources.add(path.name, path.text);
        let path_span = Span { file, start: path.part.start as u32, end: path.part.end as u32 };
        let written = path.as_str().to_owned();
        let mut definitions = self.definitions.clone();
        definitions
            .statements
            .retain(|statement| !matches!(&statement.kind, StatementKind::Import { path, .. } if *path == written));
        let kind = StatementKind::Import { path: written, path_span };
        definitions.statements.push(Statement { span: path_span, doc: Vec::new(), kind });
        self.adopt(sources, file, definitions, variables, &[])
    }

    /// Takes new definitions if an expression can be resolved among them.
    fn adopt(
        &mut self,
        sources: SourceMap,
        file: FileId,
        definitions: Module,
        variables: &Bindings,
        replaced: &[String],
    ) -> Result<(), Messages> {
        let mut probe = sources.clone();
        let nothing = Span { file, start: 0, end: 0 };
        let zero = Expr { span: nothing, kind: ExprKind::Number(num_traits::Zero::zero()) };
        let names: Vec<&str> = variables.keys().filter(|name| !replaced.contains(name)).map(String::as_str).collect();
        let resolved = program::resolve_expression(&mut probe, &zero, &names, definitions.clone(), &self.context());
        match resolved {
            Ok(_) => {
                self.sources = sources;
                self.definitions = definitions;
                Ok(())
            }
            Err(diagnostics) => Err(Messages { sources: probe, diagnostics }),
        }
    }

    /// Forgets the definition of a name, which a variable replaces.
    pub fn forget(&mut self, name: &str) {
        self.definitions.statements.retain(|statement| defined(statement) != Some(name));
    }

    /// The definitions as they were written, with the name that each defines; imports have none.
    pub fn definitions(&self) -> impl Iterator<Item = (Option<&str>, &str)> {
        self.definitions.statements.iter().map(|statement| (defined(statement), self.written(statement)))
    }

    fn written(&self, statement: &Statement) -> &str {
        let text = &self.sources.get(statement.span.file).text;
        let span = statement.span.start as usize..statement.span.end as usize;
        text.get(span).unwrap_or_default()
    }

    fn context(&self) -> Context<'_> {
        Context { importer: &self.files, differentiate: &derive::derivative, overrides: &[] }
    }

    /// Resolves an expression in which `variables` may occur.
    ///
    /// # Errors
    /// What is wrong with it, or with the definitions that it uses.
    pub fn expression(&self, snippet: &Snippet, variables: &[&str], how: Reading) -> Result<Expression, Messages> {
        let mut sources = self.sources.clone();
        let found = snippet.parse(&mut sources).and_then(|expr| {
            let expr = if how == Reading::Zero { self.zero_of(expr, variables) } else { expr };
            let condition = is_condition(&expr);
            let definitions = self.definitions.clone();
            program::resolve_expression(&mut sources, &expr, variables, definitions, &self.context())
                .map(|resolved| (resolved, condition))
        });
        match found {
            Ok((program::Expression { mut graph, value, parameters }, condition)) => {
                graph.add_output("f", value);
                Ok(Expression { graph: Arc::new(graph), root: value, parameters, condition })
            }
            Err(diagnostics) => Err(Messages { sources, diagnostics }),
        }
    }

    /// The expression whose zeros are meant.
    fn zero_of(&self, mut expr: Expr, variables: &[&str]) -> Expr {
        while let ExprKind::Group(inner) = expr.kind {
            expr = *inner;
        }
        let span = expr.span;
        match expr.kind {
            ExprKind::Relation { mut operands, relations } if relations == [Relation::Equal] => {
                let right = operands.pop();
                match (operands.pop(), right) {
                    (Some(left), Some(right)) => {
                        let kind = ExprKind::Sum { first: Box::new(left), rest: vec![(Sign::Minus, right)] };
                        Expr { span, kind }
                    }
                    // A relation has two sides.
                    _ => Expr { span, kind: ExprKind::Relation { operands: Vec::new(), relations } },
                }
            }
            ExprKind::Name(text) if !variables.contains(&text.as_str()) && self.is_function(&text) => {
                let x = Expr { span, kind: ExprKind::Name(COORDINATES[0].to_owned()) };
                let callee = Name { text, span };
                Expr { span, kind: ExprKind::Apply { callee, args: vec![Argument { name: None, value: x }] } }
            }
            kind => Expr { span, kind },
        }
    }

    fn is_function(&self, name: &str) -> bool {
        let own = self.definitions.statements.iter();
        own.clone().any(|s| matches!(s.kind, StatementKind::Fn { .. }) && defined(s) == Some(name))
            || program::BUILTINS.iter().any(|builtin| builtin.name == name)
    }

    /// A value or a box: an interval literal of IEEE 1788 such as `[1, 2]`, `[entire]` or `3.56?1`, one whose ends are
    /// expressions, or an expression, whose enclosure is taken.
    ///
    /// # Errors
    /// If it cannot be read, is undefined, or its ends are not in order.
    pub fn value(&self, snippet: &Snippet, variables: &Bindings) -> Result<Decorated, Messages> {
        let written = snippet.as_str();
        let start = written.len() - written.trim_start().len();
        let snippet = &snippet.within(start..start + written.trim().len());
        let text = snippet.as_str();
        match text.parse::<Decorated>() {
            Ok(value) => return Ok(value),
            // Nothing but a literal can look like this, so its reader knows best what is wrong.
            Err(error) if text.contains('?') || text.contains("]_") => {
                let at = text.floor_char_boundary(error.position());
                let fault = snippet.within(at..text.len()).fault(code::BAD_VALUE, error.message(), "from here");
                return Err(fault.help("literals are such as `[1, 2]`, `[1, 2]_dac` or `3.56?1`"));
            }
            Err(_) => {}
        }
        let interval = match text.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
            Some(inner) => self.interval(snippet, inner, variables)?,
            None => self.number(snippet, variables)?,
        };
        Ok(Decorated::new(interval))
    }

    /// A box whose ends are expressions; `inner` is what stands between its brackets.
    fn interval(&self, snippet: &Snippet, inner: &str, variables: &Bindings) -> Result<Interval, Messages> {
        let text = snippet.as_str();
        let commas = top_level_commas(inner);
        let (left, right) = match commas[..] {
            [] => return self.number(&snippet.within(1..1 + inner.len()), variables),
            [comma] => (1..1 + comma, comma + 2..1 + inner.len()),
            _ => return Err(snippet.fault(code::BAD_VALUE, "a box has two ends", "write `[lower, upper]`")),
        };
        let lo = self.end(&snippet.within(left.clone()), f64::NEG_INFINITY, variables)?;
        let hi = self.end(&snippet.within(right.clone()), f64::INFINITY, variables)?;
        let (lo_text, hi_text) = (text[left].trim(), text[right].trim());
        Interval::new(lo.0, hi.1).filter(|_| lo.0 <= hi.1).ok_or_else(|| {
            let help = format!("write `[{hi_text}, {lo_text}]`");
            snippet.fault(code::EMPTY_RANGE, "the ends of this box are not in order", "lower end first").help(help)
        })
    }

    /// Bounds of one end of a box; nothing written, or `inf`, is the infinity on that side.
    fn end(&self, snippet: &Snippet, infinity: f64, variables: &Bindings) -> Result<(f64, f64), Messages> {
        match (snippet.as_str().trim().to_ascii_lowercase().as_str(), infinity > 0.0) {
            ("" | "inf" | "+inf" | "infinity" | "+infinity", true) | ("" | "-inf" | "-infinity", false) => {
                Ok((infinity, infinity))
            }
            _ => self.number(snippet, variables).map(|end| (end.lo(), end.hi())),
        }
    }

    /// The enclosure of an expression that is defined for the given variables.
    fn number(&self, snippet: &Snippet, variables: &Bindings) -> Result<Interval, Messages> {
        let names: Vec<&str> = variables.keys().map(String::as_str).collect();
        let expression = self.expression(snippet, &names, Reading::Value)?;
        if expression.condition {
            return Err(snippet.fault(
                code::WRONG_KIND,
                "a value is a number, and this is a condition",
                "true or false",
            ));
        }
        let value = expression.enclose(&expression.boxes(variables));
        if value.interval().is_empty() || value.decoration() < Decoration::Def {
            return Err(snippet.fault(
                code::NOT_FINITE,
                "this value is not defined",
                format!("its enclosure is {value}"),
            ));
        }
        Ok(value.interval())
    }

    /// Whether a name can be given a value: it must be a name and none that the language needs.
    ///
    /// # Errors
    /// Why not.
    pub fn check_variable(&self, snippet: &Snippet) -> Result<(), Messages> {
        let text = snippet.as_str().trim();
        if program::BUILTINS.iter().any(|builtin| builtin.name == text) || text == "pi" {
            let what = if text == "pi" { "a constant" } else { "a built-in function" };
            return Err(snippet.fault(code::RESERVED_NAME, format!("`{text}` is {what}"), "choose another name"));
        }
        match snippet.parse(&mut SourceMap::default()) {
            Ok(Expr { kind: ExprKind::Name(name), .. }) if name == text => Ok(()),
            _ => {
                Err(snippet.fault(code::BAD_ARGUMENT, format!("`{text}` is not a name"), "a value is given to a name"))
            }
        }
    }
}

/// Reads files once, so that a definition keeps its meaning until the file is loaded again.
#[derive(Debug, Default)]
struct CachedFiles(Mutex<HashMap<PathBuf, String>>);

impl CachedFiles {
    fn forget(&self) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clear();
    }
}

impl Importer for CachedFiles {
    fn read(&self, path: &Path) -> io::Result<String> {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(text) = known.get(path) {
            return Ok(text.clone());
        }
        let text = FileSystem.read(path)?;
        known.insert(path.to_owned(), text.clone());
        Ok(text)
    }

    fn names(&self, folder: &Path) -> Vec<String> {
        FileSystem.names(folder)
    }
}

/// The name that a definition defines.
fn defined(statement: &Statement) -> Option<&str> {
    match &statement.kind {
        StatementKind::Let { name, .. } | StatementKind::Fn { name, .. } | StatementKind::Param { name, .. } => {
            Some(&name.text)
        }
        StatementKind::Shape { .. } | StatementKind::Domain { .. } | StatementKind::Import { .. } => None,
    }
}

/// A message about a statement that is no definition.
fn misplaced(statement: &Statement) -> Option<Diagnostic> {
    let (what, help) = match &statement.kind {
        StatementKind::Let { .. } | StatementKind::Fn { .. } | StatementKind::Param { .. } => return None,
        StatementKind::Import { .. } => return None,
        StatementKind::Domain { .. } => ("a domain", "give variables their boxes instead, such as `x = [-1, 1]`"),
        StatementKind::Shape { .. } => ("a shape", "write its formula, or `let` to give that a name"),
    };
    let title = format!("{what} belongs to a scene, and there is none here");
    Some(Diagnostic::error(code::UNEXPECTED, title).at(statement.span, "not a definition").help(help))
}

fn is_condition(expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Group(inner) => is_condition(inner),
        ExprKind::Relation { .. } | ExprKind::And(_) | ExprKind::Or(_) | ExprKind::Not(_) => true,
        _ => false,
    }
}

/// Where the commas outside of all brackets stand.
fn top_level_commas(text: &str) -> Vec<usize> {
    let mut depth = 0;
    let mut commas = Vec::new();
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            b'(' | b'[' => depth += 1,
            b')' | b']' => depth -= 1,
            b',' if depth == 0 => commas.push(at),
            _ => {}
        }
    }
    commas
}

/// A resolved expression; its graph holds nothing that it does not need, and one output, `f`.
#[derive(Debug, Clone)]
pub struct Expression {
    pub graph: Arc<Graph>,
    pub root: Value,
    /// Whether it is a condition, whose values are 0 and 1.
    pub condition: bool,
    parameters: Vec<Parameter>,
}

impl Expression {
    /// The variables on which its value depends, parameters of the definitions aside.
    pub fn variables(&self) -> Vec<&str> {
        let names = self.graph.variables().iter().map(String::as_str);
        names.filter(|name| self.parameters.iter().all(|parameter| parameter.name != *name)).collect()
    }

    /// The box of each input of the graph: as given, or the value of a parameter. Inputs that have neither are entire.
    pub fn boxes(&self, given: &Bindings) -> Vec<Decorated> {
        self.graph.variables().iter().map(|name| self.value_of(name, given)).collect()
    }

    /// The same for an order of names of its own.
    pub fn boxes_for(&self, names: &[String], given: &Bindings) -> Vec<Decorated> {
        names.iter().map(|name| self.value_of(name, given)).collect()
    }

    fn value_of(&self, name: &str, given: &Bindings) -> Decorated {
        let parameter = self.parameters.iter().find(|parameter| parameter.name == name);
        match given.get(name) {
            Some(value) => *value,
            None => Decorated::new(parameter.map_or(Interval::ENTIRE, |parameter| parameter.value)),
        }
    }

    /// The natural extension over boxes in the order of the graph's inputs.
    pub fn enclose(&self, boxes: &[Decorated]) -> Decorated {
        graph::enclose(&self.graph, &[self.root], boxes)[0]
    }

    /// The same expression for all extensions.
    pub fn formula(&self) -> Formula {
        Formula::new(&self.graph, self.root)
    }

    /// The order for a kernel that encloses it over boxes of all its inputs.
    pub fn spec(&self, arithmetic: Arithmetic, rounding: Rounding) -> Spec {
        let inputs = self.graph.variables().to_vec();
        Spec {
            graph: Arc::clone(&self.graph),
            symbols: if arithmetic == Arithmetic::Affine { inputs.clone() } else { Vec::new() },
            inputs,
            uniforms: Vec::new(),
            outputs: vec![Output::Enclosure(self.root)],
            domain: Vec::new(),
            promises: Vec::new(),
            arithmetic,
            rounding,
        }
    }

    /// Why its value over boxes, in the order of the graph's inputs, is decorated with less than `com`; nothing if it is
    /// not. Names the first operation that lost what the result lacks.
    pub fn shortfall(&self, boxes: &[Decorated]) -> Option<String> {
        let all: Vec<Value> = self.graph.iter().map(|(value, _)| value).collect();
        let enclosures = graph::enclose(&self.graph, &all, boxes);
        let result = enclosures[self.root.index()];
        let lacks = |value: &Value| enclosures[value.index()].decoration() <= result.decoration();
        if result.decoration() == Decoration::Com {
            return None;
        }
        let culprit = all.iter().find(|value| lacks(value)).copied().unwrap_or(self.root);
        let place = self.describe(culprit, &enclosures);
        let bounded = enclosures[culprit.index()].interval().is_bounded();
        Some(match result.decoration() {
            Decoration::Ill => format!("not an interval: {place}"),
            Decoration::Trv if result.interval().is_empty() => format!("undefined on the whole box: {place}"),
            Decoration::Trv => format!("may be undefined on part of the box: {place}"),
            Decoration::Def => format!("may jump on the box: {place}"),
            _ if !bounded => format!("continuous, but without finite bounds: {place}"),
            _ => format!("continuous on the box, but not beyond its edge: {place}"),
        })
    }

    /// One operation with the enclosures of its operands.
    fn describe(&self, value: Value, enclosures: &[Decorated]) -> String {
        let node = self.graph.node(value);
        let operands: Vec<String> =
            node.operands().iter().map(|v| enclosures[v.index()].interval().to_string()).collect();
        match (node.op, &operands[..]) {
            (Op::Var(id), _) => {
                format!("{} in {}", self.graph.variables()[id as usize], enclosures[value.index()].interval())
            }
            (Op::Div, [_, divisor]) => format!("division by {divisor}"),
            (Op::Add, [a, b]) => format!("{a} + {b}"),
            (Op::Sub, [a, b]) => format!("{a} - {b}"),
            (Op::Mul, [a, b]) => format!("{a} times {b}"),
            (Op::PowInt(n), [base]) => format!("{base}^{n}"),
            (Op::PowRatio(p, q), [base]) => format!("{base}^({p}/{q})"),
            (Op::Select, [condition, ..]) => format!("a condition that is undecided, {condition}"),
            (op, _) => format!("{} of {}", op.name(), operands.join(" and ")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bindings(values: &[(&str, f64, f64)]) -> Bindings {
        let interval = |lo, hi| Decorated::new(Interval::new(lo, hi).unwrap());
        values.iter().map(|&(name, lo, hi)| (name.to_owned(), interval(lo, hi))).collect()
    }

    fn said(result: Result<impl std::fmt::Debug, Messages>) -> String {
        result.unwrap_err().render(false)
    }

    #[test]
    fn expressions_are_enclosed_over_boxes() {
        let mut workspace = Workspace::default();
        let given = bindings(&[("x", -1.0, 2.0)]);
        workspace.define(&Snippet::whole("line 1", "fn f(u) = u^2 - 1"), &given).unwrap();
        let expression = workspace.expression(&Snippet::whole("line 2", "f(x)"), &["x"], Reading::Value).unwrap();
        assert_eq!(expression.variables(), ["x"]);
        assert_eq!(expression.enclose(&expression.boxes(&given)).to_string(), "[-1, 3] com");
        assert_eq!(expression.shortfall(&expression.boxes(&given)), None);
    }

    #[test]
    fn a_failed_definition_changes_nothing() {
        let mut workspace = Workspace::default();
        let none = Bindings::new();
        workspace.define(&Snippet::whole("line 1", "let a = 2"), &none).unwrap();
        for wrong in ["let a = b", "let a = a", "let x = 1", "let a =", "domain [0, 1]^2", "x^2 + y^2 = 1"] {
            assert!(workspace.define(&Snippet::whole("line 2", wrong), &none).is_err(), "{wrong}");
        }
        let value = workspace.value(&Snippet::whole("line 3", "a"), &none).unwrap();
        assert_eq!(value.interval(), Interval::point(2.0));
        workspace.define(&Snippet::whole("line 4", "let a = 3"), &none).unwrap();
        let value = workspace.value(&Snippet::whole("line 5", "a"), &none).unwrap();
        assert_eq!(value.interval(), Interval::point(3.0));
    }

    #[test]
    fn values_are_boxes_or_constants() {
        let workspace = Workspace::default();
        let value = |text| workspace.value(&Snippet::whole("value of x", text), &Bindings::new());
        for (text, lo, hi) in [
            ("[1, 2]", 1.0, 2.0),
            (" [ -1/2 , 2^3 ] ", -0.5, 8.0),
            ("0x1.8p+1", 3.0, 3.0),
            ("[0, inf]", 0.0, f64::INFINITY),
            ("[,1]", f64::NEG_INFINITY, 1.0),
            ("[entire]", f64::NEG_INFINITY, f64::INFINITY),
            ("[min(1, 2), max(3, 4)]", 1.0, 4.0),
            ("[1.5]", 1.5, 1.5),
            ("3.5?5", 3.0, 4.0),
        ] {
            assert_eq!(value(text).unwrap().interval(), Interval::new(lo, hi).unwrap(), "{text}");
        }
        assert!(value("[empty]").unwrap().interval().is_empty());
        assert_eq!(value("[1, 2]_def").unwrap().to_string(), "[1, 2] def");
        let tenth = value("0.1").unwrap().interval();
        assert_eq!((tenth.lo(), tenth.hi()), (0.1f64.next_down(), 0.1));
        assert_eq!(value("pi").unwrap().interval(), Interval::PI);
        assert!(said(value("[2, 1]")).contains("write `[1, 2]`"));
        assert!(said(value("[1, 1 +]")).contains("value of x:1:"));
        for wrong in
            ["", "[1, 2, 3]", "1/0", "[sqrt(-1), 2]", "y", "[1, 2", "[inf, inf]", "[1; 2]", "3?x", "[1, 2]_top"]
        {
            assert!(value(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_shortfall_names_the_operation_to_blame() {
        let workspace = Workspace::default();
        let why = |text: &str, lo, hi| {
            let expression = workspace.expression(&Snippet::whole("line 1", text), &["x"], Reading::Value).unwrap();
            expression.shortfall(&expression.boxes(&bindings(&[("x", lo, hi)]))).unwrap()
        };
        assert_eq!(why("1 + sqrt(x)", -1.0, 4.0), "may be undefined on part of the box: sqrt of [-1, 4]");
        assert_eq!(why("sqrt(x)", -2.0, -1.0), "undefined on the whole box: sqrt of [-2, -1]");
        assert_eq!(why("2/x", -1.0, 1.0), "may be undefined on part of the box: division by [-1, 1]");
        assert_eq!(why("floor(x)", 0.0, 1.5), "may jump on the box: floor of [0, 1.5]");
        assert_eq!(why("floor(x)", 0.0, 0.5), "continuous on the box, but not beyond its edge: floor of [0, 0.5]");
        assert_eq!(why("exp(x)", 0.0, 1e6), "continuous, but without finite bounds: exp of [0, 1000000]");
    }

    #[test]
    fn equations_have_zeros() {
        let mut workspace = Workspace::default();
        workspace.define(&Snippet::whole("line 1", "fn g(u) = u^2 - 2"), &Bindings::new()).unwrap();
        for (text, expected) in [("x^2 = 2", "[-2, 2] com"), ("g", "[-2, 2] com"), ("(g(x) = 0)", "[-2, 2] com")] {
            let expression = workspace.expression(&Snippet::whole("line 2", text), &["x"], Reading::Zero).unwrap();
            let boxes = expression.boxes(&bindings(&[("x", 0.0, 2.0)]));
            assert_eq!(expression.enclose(&boxes).to_string(), expected, "{text}");
        }
    }
}
