//! The text of an expression, with definitions and values around it, to a graph ready to be enclosed: the one path for
//! `imp eval`, the REPL and `imp cost EXPR`.

use std::collections::BTreeMap;
use std::collections::HashMap;
use std::io;
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
use crate::limits::Budget;
use crate::limits::Limits;
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

pub use crate::session::snippet::Messages;
pub use crate::session::snippet::Snippet;

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
    /// What imported files define, as it is written there.
    imported: Vec<(String, String)>,
    limits: Limits,
}

impl Workspace {
    /// An empty workspace in which every definition and every expression is held to these limits; those of
    /// [`Workspace::default`] are the default ones.
    pub fn within(limits: Limits) -> Self {
        Self { limits, ..Self::default() }
    }

    /// Adds the definitions (`let`, `fn`, `param`, `import`) of a text; the names that they define.
    ///
    /// # Errors
    /// What is wrong with them; then nothing has changed.
    pub fn define(&mut self, snippet: &Snippet, variables: &Bindings) -> Result<Vec<String>, Messages> {
        let budget = self.budget(snippet)?;
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
        self.adopt((sources, file), definitions, variables, &names, &budget)?;
        Ok(names)
    }

    /// Makes the definitions of a file visible, as `import` does; read anew if it was loaded before.
    ///
    /// # Errors
    /// If the file or a definition in it cannot be read; then nothing has changed.
    pub fn load(&mut self, path: &Snippet, variables: &Bindings) -> Result<(), Messages> {
        let budget = self.budget(path)?;
        let before = self.files.replace(HashMap::new());
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
        let adopted = self.adopt((sources, file), definitions, variables, &[], &budget);
        if adopted.is_err() {
            self.files.replace(before);
        }
        adopted
    }

    /// Takes new definitions if an expression can be resolved among them.
    fn adopt(
        &mut self,
        (sources, file): (SourceMap, FileId),
        definitions: Module,
        variables: &Bindings,
        replaced: &[String],
        budget: &Budget,
    ) -> Result<(), Messages> {
        let mut probe = sources.clone();
        let nothing = Span { file, start: 0, end: 0 };
        let zero = Expr { span: nothing, kind: ExprKind::Number(num_traits::Zero::zero()) };
        let names: Vec<&str> = variables.keys().filter(|name| !replaced.contains(name)).map(String::as_str).collect();
        let resolved =
            program::resolve_expression(&mut probe, &zero, &names, definitions.clone(), &self.context(budget));
        match resolved {
            Ok(_) => {
                self.sources = sources;
                self.definitions = definitions;
                self.imported = self.files.definitions();
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

    /// The definitions of imported files, each with its name.
    pub fn imported(&self) -> &[(String, String)] {
        &self.imported
    }

    fn written(&self, statement: &Statement) -> &str {
        let text = &self.sources.get(statement.span.file).text;
        let span = statement.span.start as usize..statement.span.end as usize;
        text.get(span).unwrap_or_default()
    }

    fn context<'a>(&'a self, budget: &'a Budget) -> Context<'a> {
        Context { importer: &self.files, differentiate: &derive::derivative_within, overrides: &[], budget }
    }

    /// What reading a text may cost.
    fn budget(&self, snippet: &Snippet) -> Result<Budget, Messages> {
        let budget = Budget::new(&self.limits);
        budget.source(snippet.text.len()).map_err(Diagnostic::from)?;
        Ok(budget)
    }

    /// Resolves an expression in which `variables` may occur.
    ///
    /// # Errors
    /// What is wrong with it, or with the definitions that it uses.
    pub fn expression(&self, snippet: &Snippet, variables: &[&str], how: Reading) -> Result<Expression, Messages> {
        let budget = self.budget(snippet)?;
        let mut sources = self.sources.clone();
        let found = snippet.parse(&mut sources).and_then(|expr| {
            let expr = if how == Reading::Zero { self.zero_of(expr, variables) } else { expr };
            let condition = is_condition(&expr);
            let definitions = self.definitions.clone();
            program::resolve_expression(&mut sources, &expr, variables, definitions, &self.context(&budget))
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
    /// Takes other texts for what has been read; those that it had.
    fn replace(&self, texts: HashMap<PathBuf, String>) -> HashMap<PathBuf, String> {
        std::mem::replace(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner), texts)
    }

    /// What the files define, sorted by name.
    fn definitions(&self) -> Vec<(String, String)> {
        let known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let mut found = Vec::new();
        for text in known.values() {
            let (module, _) = syntax::parse(FileId(0), text);
            for statement in &module.statements {
                let span = statement.span.start as usize..statement.span.end as usize;
                let written = text.get(span).unwrap_or_default();
                found.extend(defined(statement).map(|name| (name.to_owned(), written.to_owned())));
            }
        }
        found.sort();
        found
    }
}

impl Importer for CachedFiles {
    fn read(&self, path: &Path, limit: usize) -> io::Result<String> {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(text) = known.get(path) {
            return if text.len() > limit { Err(io::ErrorKind::FileTooLarge.into()) } else { Ok(text.clone()) };
        }
        let text = FileSystem.read(path, limit)?;
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

    #[test]
    fn expressions_are_enclosed_over_boxes() {
        let mut workspace = Workspace::default();
        let given = bindings(&[("x", -1.0, 2.0)]);
        workspace.define(&Snippet::whole("line 1", "fn f(u) = u^2 - 1"), &given).unwrap();
        let expression = workspace.expression(&Snippet::whole("line 2", "f(x)"), &["x"], Reading::Value).unwrap();
        assert_eq!(expression.variables(), ["x"]);
        assert_eq!(expression.enclose(&expression.boxes(&given)).to_string(), "[-1, 3]_com");
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
    fn a_workspace_holds_to_its_limits() {
        let mut workspace = Workspace::within(Limits { source_bytes: 20, nodes: 9, files: 0, ..Limits::untrusted() });
        let none = Bindings::new();
        let first = |result: Result<_, Messages>| result.err().map(|messages| messages.diagnostics[0].code);
        let long = format!("let a = 1{}", "+1".repeat(20));
        assert_eq!(first(workspace.define(&Snippet::whole("line 1", &long), &none)), Some(code::LARGER_THAN_ALLOWED));
        let import = Snippet::whole("line 1", "import \"a.imp\"");
        assert_eq!(first(workspace.define(&import, &none)), Some(code::LARGER_THAN_ALLOWED));
        workspace.define(&Snippet::whole("line 1", "fn f(u) = u^2 + u"), &none).unwrap();
        let expression =
            |text: &str| workspace.expression(&Snippet::whole("line 2", text), &["x"], Reading::Value).map(|_| ());
        assert!(expression("f(f(x))").is_ok());
        let found = expression("f(f(f(f(f(x)))))").unwrap_err();
        assert_eq!(found.diagnostics[0].code, code::TOO_MUCH_EXPANSION);
    }

    #[test]
    fn equations_have_zeros() {
        let mut workspace = Workspace::default();
        workspace.define(&Snippet::whole("line 1", "fn g(u) = u^2 - 2"), &Bindings::new()).unwrap();
        for (text, expected) in [("x^2 = 2", "[-2, 2]_com"), ("g", "[-2, 2]_com"), ("(g(x) = 0)", "[-2, 2]_com")] {
            let expression = workspace.expression(&Snippet::whole("line 2", text), &["x"], Reading::Zero).unwrap();
            let boxes = expression.boxes(&bindings(&[("x", 0.0, 2.0)]));
            assert_eq!(expression.enclose(&boxes).to_string(), expected, "{text}");
        }
    }
}
