//! The stages of a compilation as text, for `imp emit`.

use std::collections::HashMap;
use std::fmt::Write;
use std::sync::Arc;

use crate::codegen;
use crate::derive;
use crate::derive::Arithmetic;
use crate::derive::Output;
use crate::derive::Precision;
use crate::derive::Rounding;
use crate::derive::Spec;
use crate::diagnostic::Diagnostic;
use crate::graph::Graph;
use crate::graph::Value;
use crate::interval::Interval;
use crate::kernel::Real;
use crate::passes;
use crate::program::scene::COORDINATES;
use crate::program::scene::Scene;
use crate::program::scene::Shape;
use crate::session::Artefact;
use crate::session::input_ranges;
use crate::syntax::dump;

/// What `imp emit` prints.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// One token a line.
    Tokens,
    /// One statement a paragraph.
    Ast,
    /// The graph of all formulas as they were written.
    Graph,
    /// The graph after each pass that changed it.
    Passes,
    /// Field and gradient of each shape as a graph.
    Gradient,
    /// The lane program that encloses each field over boxes.
    Interval,
    /// The same with affine forms.
    Affine,
    /// The code generator's input for the arithmetic asked for.
    Clif,
    /// The machine code.
    Asm,
}

/// How kernels are to be emitted.
#[derive(Debug, Clone, Copy)]
pub struct Emission {
    pub precision: Precision,
    pub rounding: Rounding,
    /// Of the kernels whose CLIF or machine code is printed.
    pub arithmetic: Arithmetic,
}

impl Artefact {
    /// A stage as text; `None` if the compilation stopped before it.
    ///
    /// # Errors
    /// If the code generator does not know this machine.
    pub fn emit(&self, stage: Stage, how: Emission) -> Result<Option<String>, Diagnostic> {
        Ok(match stage {
            Stage::Tokens => self.file.map(|file| dump::tokens(&self.sources.get(file).text)),
            Stage::Ast => self.module.as_ref().map(dump::ast),
            Stage::Graph => self.resolved.as_ref().map(|scene| scene.graph.to_string()),
            Stage::Passes => self.scene.as_ref().map(|_| self.passes.iter().map(|report| report.to_string()).collect()),
            Stage::Gradient => self.each_shape(|scene, shape| Ok(gradient(scene, shape).to_string()))?,
            Stage::Interval => self.each_shape(|scene, shape| Ok(lanes(scene, shape, how, Arithmetic::Interval)))?,
            Stage::Affine => self.each_shape(|scene, shape| Ok(lanes(scene, shape, how, Arithmetic::Affine)))?,
            Stage::Clif => self.each_shape(|scene, shape| Ok(listing(scene, shape, how)?.clif))?,
            Stage::Asm => self.each_shape(|scene, shape| Ok(listing(scene, shape, how)?.assembly))?,
        })
    }

    /// The text of each shape under its name.
    fn each_shape(
        &self,
        text: impl Fn(&Scene, &Shape) -> Result<String, Diagnostic>,
    ) -> Result<Option<String>, Diagnostic> {
        let Some(scene) = &self.scene else { return Ok(None) };
        let mut out = String::new();
        for shape in &scene.shapes {
            let text = text(scene, shape)?;
            // Writing to a string does not fail.
            let _ = writeln!(out, "# {}\n{}", shape.name, text.trim_end());
        }
        Ok(Some(out))
    }
}

/// A shape's field and its partial derivatives after the passes.
fn gradient(scene: &Scene, shape: &Shape) -> Graph {
    let coordinates = &COORDINATES[..scene.dimension()];
    let mut graph = Graph::new();
    let inputs: Vec<Value> = coordinates.iter().map(|name| graph.var(name)).collect();
    let field = graph.import(&scene.graph, &[shape.field], &HashMap::new())[0];
    let slopes = derive::gradient(&mut graph, field, &inputs);
    graph.add_output(&shape.name, field);
    for (coordinate, slope) in coordinates.iter().zip(slopes) {
        graph.add_output(format!("d{}/d{coordinate}", shape.name), slope);
    }
    let ranges = input_ranges(scene, graph.variables());
    passes::run(&graph, &ranges).0
}

/// The order for a kernel that encloses a shape's field over boxes of the coordinates.
fn over_boxes(scene: &Scene, shape: &Shape, arithmetic: Arithmetic, rounding: Rounding) -> Spec {
    let coordinates = &COORDINATES[..scene.dimension()];
    let mut graph = Graph::new();
    let inputs: Vec<Value> = coordinates.iter().map(|name| graph.var(name)).collect();
    let field = graph.import(&scene.graph, &[shape.field], &HashMap::new())[0];
    let lanes: Vec<String> = coordinates.iter().map(|&name| name.to_owned()).collect();
    let uniforms: Vec<String> = graph.variables().iter().filter(|name| !lanes.contains(name)).cloned().collect();
    let ranges = input_ranges(scene, &uniforms);
    let promises = uniforms.iter().cloned().zip(ranges.into_iter().map(single)).collect();
    Spec {
        graph: Arc::new(graph),
        symbols: if arithmetic == Arithmetic::Affine { lanes.clone() } else { Vec::new() },
        inputs: lanes,
        uniforms,
        outputs: vec![Output::Enclosure(field)],
        domain: inputs.into_iter().zip(scene.domain.iter().copied()).collect(),
        promises,
        arithmetic,
        rounding,
    }
}

/// The hull in single precision, which is what kernels of that format receive.
fn single(range: Interval) -> Interval {
    Interval::new(f32::down(range.lo()).to_f64(), f32::up(range.hi()).to_f64()).unwrap_or(Interval::ENTIRE)
}

fn lanes(scene: &Scene, shape: &Shape, how: Emission, arithmetic: Arithmetic) -> String {
    over_boxes(scene, shape, arithmetic, how.rounding).lower(how.precision).to_string()
}

fn listing(scene: &Scene, shape: &Shape, how: Emission) -> Result<codegen::Emitted, Diagnostic> {
    codegen::listing(&over_boxes(scene, shape, how.arithmetic, how.rounding), how.precision)
}
