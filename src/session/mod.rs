//! Source to scene in one function, [`compile`], which keeps every stage for `imp emit`; and [`backend()`], which makes
//! kernels of the scene's formulas.

pub mod answer;
mod backend;
pub mod expression;
mod load;
mod save;
mod snippet;
mod stages;
mod value;

use std::collections::HashMap;
use std::path::Path;

use num_rational::BigRational;

use crate::derive;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::FileId;
use crate::diagnostic::Severity;
use crate::diagnostic::SourceMap;
use crate::graph::Graph;
use crate::graph::Value;
use crate::interval::Interval;
use crate::limits::Budget;
use crate::limits::Exceeded;
use crate::limits::Limits;
use crate::passes;
use crate::passes::Report;
use crate::program;
use crate::program::Context;
use crate::program::Importer;
use crate::program::scene::COORDINATES;
use crate::program::scene::Scene;
use crate::syntax;
use crate::syntax::ast::Module;

pub use crate::session::backend::Within;
pub use crate::session::backend::backend;
pub use crate::session::load::bytes;
pub use crate::session::save::cannot_write;
pub use crate::session::save::check_folder;
pub use crate::session::save::finish_writing;
pub use crate::session::save::write;
pub use crate::session::stages::Emission;
pub use crate::session::stages::Stage;

/// Where a scene comes from.
#[derive(Debug, Clone, Copy)]
pub enum Source<'a> {
    /// A file; its imports are relative to it.
    File(&'a Path),
    /// A text under a name for messages; it may import the standard library alone.
    Text { name: &'a str, text: &'a str },
}

/// A value from outside the file for a parameter or for the time `t`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Override {
    pub name: String,
    pub value: Given,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Given {
    /// A constant expression such as `0.1` (one tenth exactly) or `pi/2`.
    Text(String),
    Exact(BigRational),
}

/// What became of a source, stage by stage. A stage that was not reached because an earlier one found errors is `None`.
#[derive(Debug, Default)]
pub struct Artefact {
    /// Every file that was read, for rendering messages.
    pub sources: SourceMap,
    /// Everything that the stages had to say.
    pub diagnostics: Vec<Diagnostic>,
    pub file: Option<FileId>,
    /// The tree, without the statements that could not be read.
    pub module: Option<Module>,
    /// The scene as it was written.
    pub resolved: Option<Scene>,
    /// What each pass did to the scene's graph.
    pub passes: Vec<Report>,
    /// The scene after the passes. Its formulas enclose the same values for coordinates inside the domain and parameters
    /// inside their ranges, and say nothing about any others.
    pub scene: Option<Scene>,
}

/// Compiles a source up to the scene from which kernels are made. A stage with errors is the last one; whether there
/// were any shows in [`Artefact::scene`].
pub fn compile(source: Source, overrides: &[Override]) -> Artefact {
    compile_within(source, overrides, &Budget::new(&Limits::default()))
}

/// The same within other limits than the default ones.
pub fn compile_within(source: Source, overrides: &[Override], budget: &Budget) -> Artefact {
    let mut artefact = Artefact::default();
    artefact.build(source, overrides, budget);
    artefact
}

/// Reads one file as text.
///
/// # Errors
/// What is wrong with it, and the sources into which that points.
pub fn read(path: &Path) -> Result<(SourceMap, FileId), (SourceMap, Diagnostic)> {
    read_within(path, &Budget::new(&Limits::default()))
}

/// The same within other limits than the default ones.
///
/// # Errors
/// As [`read`].
pub fn read_within(path: &Path, budget: &Budget) -> Result<(SourceMap, FileId), (SourceMap, Diagnostic)> {
    let mut sources = SourceMap::default();
    match load::load(&mut sources, path, budget) {
        Ok(file) => Ok((sources, file)),
        Err(diagnostic) => Err((sources, diagnostic)),
    }
}

impl Artefact {
    fn build(&mut self, source: Source, overrides: &[Override], budget: &Budget) -> Option<()> {
        // Bytes to text.
        let (file, importer): (FileId, &dyn Importer) = match source {
            Source::File(path) => (self.load(path, budget)?, &program::FileSystem),
            Source::Text { name, text } => {
                self.afford(budget.source(text.len()))?;
                (self.sources.add(name, text), &program::Embedded)
            }
        };
        self.file = Some(file);

        // Text to tree.
        let text = self.sources.get(file).text.clone();
        let parsed = syntax::parse(file, &text);
        self.module = Some(parsed.0.clone());
        self.afford(budget.time())?;

        // Tree to formulas in one graph, with the scene around them. Statements that could not be read do not keep the
        // others from being checked.
        let context = |overrides| Context { importer, differentiate: &derive::derivative_within, overrides, budget };
        let overrides = self.values(overrides, &context(&[]))?;
        let (resolved, found) = program::resolve(&mut self.sources, file, parsed, &context(&overrides));
        self.resolved = resolved;
        self.report(found)?;

        // Formulas to formulas that are cheaper or tighter over the domain.
        let simplified = simplify(self.resolved.as_ref()?, budget);
        let (scene, passes) = self.afford(simplified)?;
        self.passes = passes;
        self.scene = Some(scene);
        Some(())
    }

    /// Keeps messages; `None` if one of them is an error.
    fn report(&mut self, found: Vec<Diagnostic>) -> Option<()> {
        let failed = found.iter().any(|diagnostic| diagnostic.severity == Severity::Error);
        self.diagnostics.extend(found);
        (!failed).then_some(())
    }

    /// Keeps the message if a limit was exceeded.
    fn afford<T>(&mut self, result: Result<T, Exceeded>) -> Option<T> {
        result.map_err(|exceeded| self.diagnostics.push(exceeded.into())).ok()
    }

    fn load(&mut self, path: &Path, budget: &Budget) -> Option<FileId> {
        match load::load(&mut self.sources, path, budget) {
            Ok(file) => Some(file),
            Err(diagnostic) => {
                self.diagnostics.push(diagnostic);
                None
            }
        }
    }

    /// Encloses the values given from outside. Each text becomes a source of its own, so that messages can point into it.
    fn values(&mut self, overrides: &[Override], context: &Context) -> Option<Vec<(String, Interval)>> {
        let mut values = Vec::new();
        let mut found = Vec::new();
        for Override { name, value } in overrides {
            let value = match value {
                Given::Exact(number) => Ok(Interval::from_rational(number)),
                Given::Text(text) => {
                    let file = self.sources.add(format!("value of {name}"), text.as_str());
                    let expression = syntax::parse_expression(file, text);
                    expression.and_then(|e| program::resolve_constant(&mut self.sources, &e, context))
                }
            };
            match value {
                Ok(value) => values.push((name.clone(), value)),
                Err(diagnostics) => found.extend(diagnostics),
            }
        }
        self.report(found)?;
        Some(values)
    }
}

/// Runs the passes over the scene's graph, for coordinates inside the domain and parameters inside their ranges.
fn simplify(scene: &Scene, budget: &Budget) -> Result<(Scene, Vec<Report>), Exceeded> {
    let mut roots: Vec<Value> = Vec::new();
    let mut names: Vec<String> = Vec::new();
    for shape in &scene.shapes {
        roots.push(shape.field);
        names.push(shape.name.clone());
        roots.extend(shape.condition);
        names.extend(shape.condition.map(|_| format!("{} where", shape.name)));
    }
    let mut graph = Graph::new();
    let images = graph.import(&scene.graph, &roots, &Default::default());
    for (name, image) in names.into_iter().zip(images) {
        graph.add_output(name, image);
    }
    let inputs = input_ranges(scene, graph.variables());
    let (graph, reports) = passes::run_within(&graph, &inputs, budget)?;
    // The passes keep the outputs in their order.
    let mut results = graph.outputs().iter().map(|&(_, value)| value);
    let mut scene = scene.clone();
    for shape in &mut scene.shapes {
        shape.field = results.next().unwrap_or(shape.field);
        shape.condition = shape.condition.and_then(|_| results.next());
    }
    scene.graph = graph;
    Ok((scene, reports))
}

/// Where inputs of the scene's graph lie: a coordinate in the domain, a parameter in its range, the time anywhere.
pub fn input_ranges(scene: &Scene, names: &[String]) -> Vec<Interval> {
    // Scenes may have very many parameters.
    let parameters: HashMap<&str, Option<Interval>> =
        scene.parameters.iter().map(|parameter| (parameter.name.as_str(), parameter.range)).collect();
    let range = |name: &String| match COORDINATES.iter().position(|coordinate| coordinate == name) {
        Some(axis) => scene.domain.get(axis).copied().unwrap_or(Interval::ENTIRE),
        None => parameters.get(name.as_str()).copied().flatten().unwrap_or(Interval::ENTIRE),
    };
    names.iter().map(range).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn compiled(text: &str, overrides: &[(&str, &str)]) -> Artefact {
        let overrides: Vec<Override> = overrides
            .iter()
            .map(|(name, value)| Override { name: name.to_string(), value: Given::Text(value.to_string()) })
            .collect();
        compile(Source::Text { name: "test.imp", text }, &overrides)
    }

    #[test]
    fn every_stage_is_kept() {
        let artefact = compiled("x^2 + y^2 + z^2 = 1 where x*x < 1/4\ndomain [-2, 2]^3", &[]);
        assert!(artefact.diagnostics.is_empty(), "{:?}", artefact.diagnostics);
        let scene = artefact.scene.unwrap();
        assert!(artefact.module.is_some() && artefact.resolved.is_some() && !artefact.passes.is_empty());
        assert_eq!(scene.shapes.len(), 1);
        assert_eq!(scene.graph.outputs().len(), 2);
        assert_eq!(scene.graph.outputs()[1].1, scene.shapes[0].condition.unwrap());
    }

    #[test]
    fn errors_stop_at_their_stage() {
        let artefact = compiled("x^2 + = 1", &[]);
        assert!(artefact.module.is_some() && artefact.resolved.is_none() && !artefact.diagnostics.is_empty());
        let artefact = compiled("x^2 + q = 1", &[]);
        assert!(artefact.resolved.is_none() && artefact.scene.is_none());
        assert_eq!(artefact.diagnostics.len(), 1);
    }

    #[test]
    fn given_values_are_exact_reals() {
        let text = "param a = 1 in [0, 4]\nx^2 + y^2 + z^2 = a";
        let artefact = compiled(text, &[("a", "0.1")]);
        let value = artefact.scene.unwrap().parameters[0].value;
        // One tenth lies between two neighbours.
        assert_eq!(value.hi(), 0.1f64);
        assert_eq!(value.lo(), 0.1f64.next_down());
        for wrong in [("a", "5"), ("b", "1"), ("a", "x"), ("a", "1 +"), ("a", "1/0")] {
            let artefact = compiled(text, &[wrong]);
            assert!(artefact.scene.is_none() && !artefact.diagnostics.is_empty(), "{wrong:?}");
        }
    }
}
