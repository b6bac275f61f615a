//! From a parsed file to a [`Scene`]: the steps of this layer in order.

use std::collections::HashMap;
use std::collections::HashSet;

use crate::diagnostic;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::FileId;
use crate::diagnostic::SourceMap;
use crate::diagnostic::Span;
use crate::diagnostic::did_you_mean;
use crate::graph::Graph;
use crate::graph::Op;
use crate::graph::Value;
use crate::interval::Interval;
use crate::limits::Budget;
use crate::limits::Exceeded;
use crate::syntax::ast::Expr;
use crate::syntax::ast::Module;
use crate::syntax::ast::Name;
use crate::syntax::ast::ShapeKeyword;
use crate::syntax::ast::Statement;
use crate::syntax::ast::StatementKind;

use super::builtins::TIME;
use super::domain::default_domain;
use super::enclose::Dependence;
use super::enclose::inputs_of;
use super::errors;
use super::import::Importer;
use super::lower::Lowerer;
use super::lower::as_truth;
use super::names::Program;
use super::names::defined_name;
use super::scene::Parameter;
use super::scene::Scene;
use super::scene::Shape;
use super::scene::ShapeKind;
use super::settings;
use super::settings::Settings;
use super::values::Meaning;

/// Symbolic differentiation, which a higher layer provides: adds the derivative of the second argument by the third, an
/// input, to the graph, within a budget.
pub type Differentiate = dyn Fn(&mut Graph, Value, Value, &Budget) -> Result<Value, Exceeded>;

/// What resolving needs from outside.
pub struct Context<'a> {
    pub importer: &'a dyn Importer,
    pub differentiate: &'a Differentiate,
    /// Values of parameters and of the time `t` that replace the written ones, as by `--set`.
    pub overrides: &'a [(String, Interval)],
    /// What all of it may cost.
    pub budget: &'a Budget,
}

/// Resolves what [`crate::syntax::parse`] gave for a file. The scene is absent if there is any error, of the parser or of
/// this layer; the messages are those of both in the order of the text. What only follows from a statement that the
/// parser left out is not reported.
pub fn resolve(
    sources: &mut SourceMap,
    file: FileId,
    (module, mut diagnostics): (Module, Vec<Diagnostic>),
    context: &Context,
) -> (Option<Scene>, Vec<Diagnostic>) {
    let empty = module.statements.is_empty();
    let faulty = !diagnostics.is_empty();
    let program = Program::load(sources, (file, module), faulty, HashSet::new(), context, &mut diagnostics);
    let mut lowerer = Lowerer::new(&program, context);
    lowerer.evaluate_items();
    let mut shapes = lower_shapes(&mut lowerer);
    let declared = parameters(&mut lowerer, context.overrides);
    if shapes.is_empty() && diagnostics.is_empty() && !lowerer.has_errors() {
        let end = sources.get(file).text.len() as u32;
        let start = if empty { 0 } else { end };
        lowerer.report(errors::nothing_to_draw(empty, Span { file, start, end: start }));
    }
    let written = domain_statement(&mut lowerer);
    let dimension = check_dimension(&mut lowerer, &mut shapes, written.as_ref().map(|(domain, _)| domain.len()));
    let names: Vec<String> = shapes.iter().map(|shape| shape.shape.name.clone()).collect();
    let mut settings = Settings::default();
    for setting in program.files[0].module.statements.iter().filter_map(settings::as_setting) {
        settings.apply(&mut lowerer, setting, &names);
    }
    let (graph, faults) = lowerer.into_results();
    diagnostics.extend(faults);
    if !diagnostics.is_empty() {
        sort(&mut diagnostics);
        return (None, diagnostics);
    }
    let shapes: Vec<Shape> = shapes.into_iter().map(|lowered| lowered.shape).collect();
    let (graph, shapes) = compact(&graph, shapes);
    let used: HashSet<&String> = graph.variables().iter().collect();
    let parameters: Vec<Parameter> =
        declared.into_iter().filter(|parameter| parameter.name != TIME || used.contains(&parameter.name)).collect();
    let domain_given = written.is_some();
    let domain = match written {
        Some((domain, _)) => domain,
        None => match default_domain(&graph, &shapes, &parameters, dimension, context.budget) {
            Ok(domain) => domain,
            Err(exceeded) => return (None, vec![exceeded.into()]),
        },
    };
    let scene = Scene { graph, shapes, parameters, domain, domain_given, view: settings.view };
    (Some(scene), Vec::new())
}

/// A resolved expression: what `imp eval` and the REPL compute.
#[derive(Debug, Clone)]
pub struct Expression {
    pub graph: Graph,
    /// A number; of a condition or an equation its truth value, 0 or 1.
    pub value: Value,
    /// Parameters of the definitions, with their values.
    pub parameters: Vec<Parameter>,
}

/// Resolves an expression whose free names are `variables` and the definitions (`let`, `fn`, `param`, `import`) of a
/// module; shapes and settings in it are not looked at. Variables hide everything else of their name, and a later
/// definition replaces an earlier one.
///
/// # Errors
/// All messages about the expression and about the definitions.
pub fn resolve_expression(
    sources: &mut SourceMap,
    expression: &Expr,
    variables: &[&str],
    definitions: Module,
    context: &Context,
) -> Result<Expression, Vec<Diagnostic>> {
    let mut diagnostics = Vec::new();
    let variables: HashSet<String> = variables.iter().map(|&name| name.to_owned()).collect();
    // The expression is scanned like everything else if it is a definition; its name cannot be written.
    let mut module = definitions;
    let mut later = HashSet::new();
    module.statements.reverse();
    module.statements.retain(|statement| match (&statement.kind, defined_name(statement)) {
        (StatementKind::Domain { .. } | StatementKind::Shape { .. }, _) => false,
        (_, Some(name)) => later.insert(name.text.clone()),
        (_, None) => true,
    });
    module.statements.reverse();
    let name = Name { text: String::new(), span: expression.span };
    let kind = StatementKind::Let { name, value: expression.clone() };
    module.statements.push(Statement { span: expression.span, doc: Vec::new(), kind });
    let main = (expression.span.file, module);
    let program = Program::load(sources, main, false, variables.clone(), context, &mut diagnostics);
    let mut lowerer = Lowerer::new(&program, context);
    lowerer.evaluate_items();
    let mut parameters = parameters(&mut lowerer, context.overrides);
    // Time passes in scenes alone; here `t` is a variable like any other.
    parameters.retain(|parameter| parameter.name != TIME);
    let meaning = lowerer.name("");
    let value = match as_truth(&meaning) {
        Some(truth) => Some(truth.value),
        None => lowerer.scalar("an expression to evaluate is a number", &meaning, expression.span),
    };
    if let Some(value) = value {
        let known = |name: &String| variables.contains(name) || parameters.iter().any(|p| p.name == *name);
        for name in inputs_of(&lowerer.graph, &[value]).iter().filter(|name| !known(name)) {
            lowerer.report(errors::no_value(name, expression.span));
        }
    }
    let (graph, faults) = lowerer.into_results();
    diagnostics.extend(faults);
    match value {
        Some(value) if diagnostics.is_empty() => {
            let mut compacted = Graph::new();
            let value = compacted.import(&graph, &[value], &HashMap::new())[0];
            Ok(Expression { graph: compacted, value, parameters })
        }
        _ => {
            sort(&mut diagnostics);
            Err(diagnostics)
        }
    }
}

/// The value of a constant expression such as `pi/2`, as given on a command line.
///
/// # Errors
/// If it is no finite constant.
pub fn resolve_constant(
    sources: &mut SourceMap,
    expression: &Expr,
    context: &Context,
) -> Result<Interval, Vec<Diagnostic>> {
    let mut diagnostics = Vec::new();
    let statement = Statement {
        span: expression.span,
        doc: Vec::new(),
        kind: StatementKind::Let {
            name: Name { text: String::new(), span: expression.span },
            value: expression.clone(),
        },
    };
    let main = (expression.span.file, Module { statements: vec![statement] });
    let program = Program::load(sources, main, false, HashSet::new(), context, &mut diagnostics);
    let mut lowerer = Lowerer::new(&program, context);
    lowerer.evaluate_items();
    let value = lowerer.constant_interval(expression, "this value");
    diagnostics.extend(lowerer.into_results().1);
    match value {
        Some(value) if diagnostics.is_empty() => Ok(value),
        _ => Err(diagnostics),
    }
}

/// A shape with what only the checks need.
struct Lowered {
    shape: Shape,
    keyword: Option<ShapeKeyword>,
    /// Whether it depends on each of the coordinates.
    coordinates: [bool; 3],
}

fn lower_shapes(lowerer: &mut Lowerer) -> Vec<Lowered> {
    let program = lowerer.program;
    let mut dependence = Dependence::default();
    let mut shapes = Vec::new();
    for (index, statement) in program.files[0].module.statements.iter().enumerate() {
        let StatementKind::Shape { keyword, name, relation, condition } = &statement.kind else { continue };
        if settings::as_setting(statement).is_some() {
            continue;
        }
        // A named shape has been evaluated as a definition.
        let meaning = match program.item_of(0, index) {
            Some(item) => lowerer.item(item),
            None => lowerer.lower(relation),
        };
        let field = shape_field(lowerer, &meaning, relation, keyword.is_none() && name.is_none());
        let truth = condition.as_ref().map(|condition| {
            let meaning = lowerer.lower(condition);
            lowerer.truth("`where` needs a condition", &meaning, condition.span).map(|truth| truth.value)
        });
        let Some((kind, field, besides)) = field else { continue };
        let condition = match truth {
            Some(None) => continue,
            Some(Some(value)) => Some(besides.map_or(value, |besides| lowerer.graph.push(Op::Min, &[besides, value]))),
            None => besides,
        };
        let roots: Vec<Value> = [field].into_iter().chain(condition).collect();
        let coordinates = dependence.of(&lowerer.graph, &roots);
        if coordinates == [false; 3] {
            lowerer.report(errors::no_coordinate(relation.span));
            continue;
        }
        let name = name.as_ref().map(|name| name.text.clone()).unwrap_or_default();
        let shape = Shape { name, kind, field, condition, span: statement.span };
        shapes.push(Lowered { shape, keyword: *keyword, coordinates });
    }
    shapes
}

/// The field of a shape, and what must hold besides; a message if its meaning has none. `bare` if it is a statement without
/// keyword.
fn shape_field(
    lowerer: &mut Lowerer,
    meaning: &Meaning,
    relation: &Expr,
    bare: bool,
) -> Option<(ShapeKind, Value, Option<Value>)> {
    let help = match meaning {
        Meaning::Equation(equation) => return Some((ShapeKind::Equation, equation.difference, None)),
        Meaning::Truth(truth) => match truth.solid {
            Ok(field) => return Some((ShapeKind::Region, field, None)),
            Err(blame) => {
                if let Some((field, besides)) = equation_among(lowerer, truth.value) {
                    return Some((ShapeKind::Equation, field, besides));
                }
                let diagnostic = errors::equation_as_solid(blame);
                lowerer.report(diagnostic.help("for both surfaces f = 0 and g = 0 in one, write `f * g = 0`"));
                return None;
            }
        },
        Meaning::Invalid => return None,
        Meaning::Scalar(_) if bare => "write an equation, as in `... = 0`, or define a name with `let`",
        Meaning::Scalar(_) => "write `... = 0` for where it is 0",
        Meaning::Function(_) => "call it with its arguments in brackets",
        Meaning::Vector(_) | Meaning::Text(_) => "for example `x^2 + y^2 + z^2 = 1`",
    };
    lowerer.report(errors::not_a_shape(meaning.kind(), relation.span, help));
    None
}

/// Of relations joined by `and`, the first equation's difference, and the truth of the others; `None` if no equation is
/// among them.
fn equation_among(lowerer: &mut Lowerer, truth: Value) -> Option<(Value, Option<Value>)> {
    let mut conjuncts = Vec::new();
    let mut open = vec![truth];
    while let Some(value) = open.pop() {
        let node = *lowerer.graph.node(value);
        match node.op {
            Op::Min => open.extend(node.operands().iter().rev()),
            _ => conjuncts.push(value),
        }
    }
    let first = conjuncts.iter().position(|&value| lowerer.graph.node(value).op == Op::Equal)?;
    let node = *lowerer.graph.node(conjuncts.remove(first));
    let field = lowerer.difference(node.operands()[0], node.operands()[1]);
    let besides = if conjuncts.is_empty() { None } else { Some(lowerer.balanced(Op::Min, conjuncts)) };
    Some((field, besides))
}

/// All parameters in source order, those of imported files after, and the time last.
pub(super) fn parameters(lowerer: &mut Lowerer, overrides: &[(String, Interval)]) -> Vec<Parameter> {
    let program = lowerer.program;
    let mut found: Vec<(Parameter, Span)> = Vec::new();
    let mut places: HashMap<&str, Span> = HashMap::new();
    let mut items = program.order.clone();
    items.sort_unstable();
    for id in items {
        let StatementKind::Param { name, value, range } = &program.statement(id).kind else { continue };
        if let Some(first) = places.get(name.text.as_str()) {
            lowerer.report(errors::same_parameter(&name.text, name.span, *first));
            continue;
        }
        let written = lowerer.in_file(program.items[id.0].file, |lowerer| {
            let number = lowerer.constant_interval(value, "the value of a parameter");
            let range = range.as_ref().map(|(lo, hi)| lowerer.range(lo, hi));
            (number, range)
        });
        let (Some(mut number), range) = written else { continue };
        let range = match range {
            Some(None) => continue,
            Some(range) => range,
            None => None,
        };
        if range.is_some_and(|range| range.disjoint(number)) {
            let range = range.map_or(String::new(), |range| format!("between {} and {}", range.lo(), range.hi()));
            lowerer.report(errors::out_of_range(
                &format!("parameter `{}`", name.text),
                number.mid(),
                &range,
                value.span,
            ));
        }
        // The number lies in both, even where its enclosure sticks out by a rounding.
        number = range.map_or(number, |range| number.intersect(range));
        places.insert(&name.text, name.span);
        found.push((Parameter { name: name.text.clone(), value: number, range }, name.span));
    }
    let time = Parameter { name: TIME.to_owned(), value: Interval::ZERO, range: None };
    let mut all: Vec<(Parameter, Option<Span>)> = found.into_iter().map(|(p, span)| (p, Some(span))).collect();
    all.push((time, None));
    for (name, value) in overrides {
        override_parameter(lowerer, &mut all, name, *value);
    }
    all.into_iter().map(|(parameter, _)| parameter).collect()
}

fn override_parameter(lowerer: &mut Lowerer, all: &mut [(Parameter, Option<Span>)], name: &str, value: Interval) {
    let Some((parameter, span)) = all.iter_mut().find(|(parameter, _)| parameter.name == name) else {
        let help = match did_you_mean(name, all.iter().map(|(parameter, _)| parameter.name.as_str())) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("declare it in the file: `param {name} = ...`"),
        };
        return lowerer.report(errors::override_failed(format!("there is no parameter `{name}`"), None, Some(help)));
    };
    if parameter.range.is_some_and(|range| !range.contains_interval(value)) || !value.is_bounded() {
        let range = parameter.range.unwrap_or(Interval::ENTIRE);
        let title = format!("`{name}` cannot be set to {}, outside of [{}, {}]", value.mid(), range.lo(), range.hi());
        return lowerer.report(errors::override_failed(title, *span, None));
    }
    parameter.value = value;
}

/// The domain as written and where.
fn domain_statement(lowerer: &mut Lowerer) -> Option<(Vec<Interval>, Span)> {
    let program = lowerer.program;
    let mut found: Option<(Vec<Interval>, Span)> = None;
    for statement in &program.files[0].module.statements {
        let StatementKind::Domain { ranges } = &statement.kind else { continue };
        if let Some((_, first)) = &found {
            lowerer.report(errors::set_twice("the domain", statement.span, *first));
        } else if let Some(domain) = lowerer.domain(ranges) {
            found = Some((domain, statement.span));
        }
    }
    found
}

/// Whether the scene lies in space or in the plane, which every shape must agree to, and the names of shapes without one.
fn check_dimension(lowerer: &mut Lowerer, shapes: &mut [Lowered], written: Option<usize>) -> usize {
    let uses_z = |lowered: &Lowered| lowered.coordinates[2];
    let is_surface = |lowered: &Lowered| lowered.keyword == Some(ShapeKeyword::Surface);
    let space = shapes.iter().any(|lowered| is_surface(lowered) || uses_z(lowered));
    let dimension = written.unwrap_or(if space { 3 } else { 2 });
    for lowered in shapes.iter() {
        let span = lowered.shape.span;
        if lowered.keyword == Some(ShapeKeyword::Curve) && uses_z(lowered) {
            let help = "a curve lies in the plane of x and y; write `surface` for a shape in space";
            lowerer.report(errors::dimension("this curve uses z", span, "depends on `z`", help));
        } else if lowered.keyword == Some(ShapeKeyword::Curve) && dimension == 3 {
            let help = match written {
                Some(_) => "give the domain two ranges, or write `surface`",
                None => "curves and surfaces cannot share a file; write `surface` for a cylinder over the curve",
            };
            lowerer.report(errors::dimension("a curve in a scene of three dimensions", span, "this curve", help));
        } else if dimension == 2 && uses_z(lowered) {
            let help = "give the domain a third range";
            lowerer.report(errors::dimension(
                "this shape uses z, but the domain has two ranges",
                span,
                "depends on `z`",
                help,
            ));
        } else if dimension == 2 && is_surface(lowered) {
            let help = "write `curve`, or give the domain a third range";
            lowerer.report(errors::dimension("a surface in a scene of two dimensions", span, "this surface", help));
        }
    }
    let mut number = 0;
    let mut taken: HashSet<String> = shapes.iter().map(|lowered| lowered.shape.name.clone()).collect();
    for (index, lowered) in shapes.iter_mut().enumerate().filter(|(_, lowered)| lowered.shape.name.is_empty()) {
        let word = if dimension == 3 { "surface" } else { "curve" };
        // All numbers from an earlier shape's place up to its number are taken.
        number = number.max(index) + 1;
        while !taken.insert(format!("{word}{number}")) {
            number += 1;
        }
        lowered.shape.name = format!("{word}{number}");
    }
    dimension
}

/// The graph with what the shapes need alone, their fields and conditions as its outputs.
fn compact(graph: &Graph, mut shapes: Vec<Shape>) -> (Graph, Vec<Shape>) {
    let roots: Vec<Value> = shapes.iter().flat_map(|shape| [Some(shape.field), shape.condition]).flatten().collect();
    let mut result = Graph::new();
    let mut images = result.import(graph, &roots, &HashMap::new()).into_iter();
    for shape in &mut shapes {
        if let Some(field) = images.next() {
            shape.field = field;
        }
        shape.condition = shape.condition.and_then(|_| images.next());
    }
    for shape in &shapes {
        result.add_output(shape.name.clone(), shape.field);
        if let Some(condition) = shape.condition {
            result.add_output(format!("{} where", shape.name), condition);
        }
    }
    (result, shapes)
}

/// In the order of the source, messages without a place last; no more than anyone reads.
pub(super) fn sort(diagnostics: &mut Vec<Diagnostic>) {
    let place = |diagnostic: &Diagnostic| diagnostic.labels.first().map(|label| (label.span.file, label.span.start));
    diagnostics.sort_by_key(|diagnostic| (place(diagnostic).is_none(), place(diagnostic)));
    diagnostic::shorten(diagnostics, 0);
}
