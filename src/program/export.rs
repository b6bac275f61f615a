//! The functions of a file as formulas of numbers: what a program that links kernels can call.

use std::collections::HashMap;
use std::collections::HashSet;

use crate::diagnostic::Diagnostic;
use crate::diagnostic::FileId;
use crate::diagnostic::SourceMap;
use crate::diagnostic::Span;
use crate::graph::Graph;
use crate::graph::Value;
use crate::syntax::ast::Expr;
use crate::syntax::ast::FnParam;
use crate::syntax::ast::Module;
use crate::syntax::ast::Name;
use crate::syntax::ast::Statement;
use crate::syntax::ast::StatementKind;

use super::builtins::TIME;
use super::enclose::inputs_of;
use super::errors;
use super::lower::Lowerer;
use super::names::Program;
use super::names::defined_name;
use super::resolve::Context;
use super::resolve::parameters;
use super::resolve::sort;
use super::scene::COORDINATES;
use super::scene::Parameter;
use super::settings;
use super::values::Equation;
use super::values::Meaning;
use super::values::Truth;

/// One function of numbers.
#[derive(Debug, Clone)]
pub struct Function {
    /// As it is written; a shape without a name has the name `shape1`, ... by its position.
    pub name: String,
    /// The comment before it.
    pub doc: Vec<String>,
    pub span: Span,
    /// What it is called with, in order: the arguments of a `fn`, then the coordinates and the time on which it depends.
    pub variables: Vec<String>,
    /// In a graph of its own, whose inputs are [`Function::inputs`] in the order of the variables, then parameters. One
    /// value for a number, several for a list. Of an equation the difference of its sides, of a region the field that is at
    /// most 0 inside, of any other condition its truth, 0 or 1.
    pub graph: Graph,
    pub values: Vec<Value>,
    /// The names of the variables in the graph: an argument hides no coordinate of its name there.
    pub inputs: Vec<String>,
    /// The parameters on which it depends, in source order.
    pub parameters: Vec<Parameter>,
}

/// A function that cannot be called with numbers, and why.
#[derive(Debug, Clone)]
pub struct Refused {
    pub name: String,
    pub span: Span,
    pub diagnostics: Vec<Diagnostic>,
}

/// What a file offers, in source order.
#[derive(Debug, Clone, Default)]
pub struct Functions {
    pub functions: Vec<Function>,
    pub refused: Vec<Refused>,
}

/// Resolves each `fn`, each `let` that depends on the coordinates, and each shape of a file as a function of numbers, or
/// the one of the name `only`.
///
/// # Errors
/// All messages, if the file has a mistake that does not concern the inside of one `fn` alone.
pub fn resolve_functions(
    sources: &mut SourceMap,
    file: FileId,
    (module, mut diagnostics): (Module, Vec<Diagnostic>),
    only: Option<&str>,
    context: &Context,
) -> Result<Functions, Vec<Diagnostic>> {
    let faulty = !diagnostics.is_empty();
    let program = Program::load(sources, (file, module), faulty, HashSet::new(), context, &mut diagnostics);
    let mut lowerer = Lowerer::new(&program, context);
    lowerer.evaluate_items();
    let parameters = parameters(&mut lowerer, context.overrides);
    diagnostics.extend(lowerer.take_diagnostics());
    if !diagnostics.is_empty() {
        sort(&mut diagnostics);
        return Err(diagnostics);
    }
    let mut found = Functions::default();
    let mut faults = Vec::new();
    let mut nodes = 0;
    for (index, statement) in program.files[0].module.statements.iter().enumerate() {
        if only.is_some_and(|only| defined_name(statement).is_none_or(|name| name.text != only)) {
            continue;
        }
        let Some(lowered) = lower(&mut lowerer, index, statement) else { continue };
        let diagnostics = lowerer.take_diagnostics();
        if !matches!(statement.kind, StatementKind::Fn { .. }) && !diagnostics.is_empty() {
            // A mistake in a shape is one of the file; a `fn` may be meant for regions, and nobody calls it here.
            faults.extend(diagnostics);
            continue;
        }
        let refuse = |diagnostics| Refused { name: lowered.name.clone(), span: statement.span, diagnostics };
        let values = match values(&lowered.meaning) {
            Some(values) if diagnostics.is_empty() => values,
            _ if !diagnostics.is_empty() => {
                found.refused.push(refuse(diagnostics));
                continue;
            }
            _ => {
                let needs = "a function for other programs has numbers";
                found.refused.push(refuse(vec![match lowered.meaning {
                    // What an earlier function has reported.
                    Meaning::Invalid => errors::too_much_expansion(lowered.span),
                    _ => errors::wrong_kind(needs, lowered.meaning.kind(), lowered.span),
                }]));
                continue;
            }
        };
        match function(&lowerer.graph, &lowered, &values, &parameters, statement) {
            Ok(Some(function)) => {
                // Each has a copy of what it shares with others.
                nodes += function.graph.len();
                let afforded = context.budget.nodes(nodes).and_then(|()| context.budget.time());
                afforded.map_err(|exceeded| vec![Diagnostic::from(exceeded).at(statement.span, "up to here")])?;
                found.functions.push(function);
            }
            Ok(None) => {}
            Err(diagnostic) => found.refused.push(refuse(vec![diagnostic])),
        }
    }
    if faults.is_empty() { Ok(found) } else { Err(faults) }
}

/// A statement's formula.
struct Lowered<'a> {
    name: String,
    /// Empty but for a `fn`.
    arguments: &'a [FnParam],
    callable: bool,
    meaning: Meaning,
    span: Span,
}

fn lower<'a>(lowerer: &mut Lowerer, index: usize, statement: &'a Statement) -> Option<Lowered<'a>> {
    let program = lowerer.program;
    let whole = |lowerer: &mut Lowerer, name: &str, expr: &Expr| {
        let meaning = match program.item_of(0, index) {
            Some(item) => lowerer.item(item),
            None => lowerer.in_file(0, |lowerer| lowerer.lower(expr)),
        };
        Lowered { name: name.to_owned(), arguments: &[], callable: false, meaning, span: expr.span }
    };
    match &statement.kind {
        StatementKind::Fn { name, params, body } => {
            let locals = params.iter().map(|param| {
                (param.name.text.clone(), Meaning::Scalar(lowerer.graph.var(&input(name, &param.name.text))))
            });
            let mut locals = locals.collect();
            let meaning = lowerer.in_frame(0, &mut locals, (name.text.clone(), name.span), body);
            Some(Lowered { name: name.text.clone(), arguments: params, callable: true, meaning, span: body.span })
        }
        StatementKind::Let { name, value } => Some(whole(lowerer, &name.text, value)),
        StatementKind::Shape { name, relation, .. } if settings::as_setting(statement).is_none() => {
            let name = name.as_ref().map_or_else(|| unnamed(program, index), |name| name.text.clone());
            Some(Lowered { callable: true, ..whole(lowerer, &name, relation) })
        }
        _ => None,
    }
}

/// `shape1`, ... by the position among the shapes of the file.
fn unnamed(program: &Program, index: usize) -> String {
    let shapes = program.files[0].module.statements[..=index].iter();
    let is_shape = |statement: &&Statement| {
        matches!(statement.kind, StatementKind::Shape { .. }) && settings::as_setting(statement).is_none()
    };
    format!("shape{}", shapes.filter(is_shape).count())
}

/// The graph's input for an argument of a function. That of a `fn` has a name that no text of the language reads like; in an
/// expression the coordinates and the time are meant.
fn input(function: &Name, argument: &str) -> String {
    if function.text.is_empty() && (COORDINATES.contains(&argument) || argument == TIME) {
        return argument.to_owned();
    }
    format!("{argument} of fn")
}

fn values(meaning: &Meaning) -> Option<Vec<Value>> {
    match meaning {
        Meaning::Scalar(value) => Some(vec![*value]),
        Meaning::Vector(values) if !values.is_empty() => Some(values.to_vec()),
        Meaning::Truth(Truth { solid: Ok(field), .. }) => Some(vec![*field]),
        Meaning::Truth(Truth { value, .. }) => Some(vec![*value]),
        Meaning::Equation(Equation { difference, .. }) => Some(vec![*difference]),
        Meaning::Vector(_) | Meaning::Text(_) | Meaning::Function(_) | Meaning::Invalid => None,
    }
}

/// `None` for a constant that nobody calls.
fn function(
    graph: &Graph,
    lowered: &Lowered,
    values: &[Value],
    parameters: &[Parameter],
    statement: &Statement,
) -> Result<Option<Function>, Diagnostic> {
    let used: HashSet<String> = inputs_of(graph, values).into_iter().collect();
    let mut variables: Vec<String> = lowered.arguments.iter().map(|param| param.name.text.clone()).collect();
    let name = Name { text: lowered.name.clone(), span: lowered.span };
    let mut inputs: Vec<String> = variables.iter().map(|variable| input(&name, variable)).collect();
    for name in COORDINATES.iter().chain([&TIME]).filter(|name| used.contains(**name)) {
        if inputs.iter().any(|input| input == name) {
            continue;
        }
        if lowered.name.is_empty() {
            return Err(errors::no_value(name, lowered.span));
        }
        if variables.iter().any(|variable| variable == name) {
            let title =
                format!("`{}` depends on the coordinate `{name}` and on an argument of that name", lowered.name);
            let diagnostic = errors::ambiguous_variable(title, lowered.span);
            return Err(diagnostic.help("give the argument another name"));
        }
        variables.push((*name).to_owned());
        inputs.push((*name).to_owned());
    }
    if variables.is_empty() && !lowered.callable {
        return Ok(None);
    }
    let parameters: Vec<Parameter> =
        parameters.iter().filter(|p| p.name != TIME && used.contains(&p.name)).cloned().collect();
    let mut own = Graph::new();
    for name in inputs.iter().chain(parameters.iter().map(|parameter| &parameter.name)) {
        own.var(name);
    }
    let values = own.import(graph, values, &HashMap::new());
    Ok(Some(Function {
        name: lowered.name.clone(),
        doc: statement.doc.clone(),
        span: statement.span,
        variables,
        graph: own,
        values,
        inputs,
        parameters,
    }))
}

/// A module in which an expression is the last function, of the given variables: `resolve_functions` finds it under the
/// empty name, which no text can have.
pub fn with_expression(mut module: Module, expression: Expr, variables: &[&str]) -> Module {
    let span = expression.span;
    let name = |text: &str| Name { text: text.to_owned(), span };
    let params = variables.iter().map(|text| FnParam { name: name(text), default: None }).collect();
    let kind = StatementKind::Fn { name: name(""), params, body: expression };
    module.statements.push(Statement { span, doc: Vec::new(), kind });
    module
}
