//! What a picture will run, and why: which kernels, which rays, which effects. Nothing runs that is not in the plan.

use std::fmt;

use crate::derive;
use crate::derive::Arithmetic;
use crate::derive::Precision;
use crate::derive::Rounding;
use crate::derive::Spec;
use crate::graph::Value;
use crate::interval::Interval;
use crate::program::scene::COORDINATES;
use crate::program::scene::Projection;
use crate::program::scene::Scene;
use crate::program::scene::Shape;
use crate::render::options::Enclosures;
use crate::render::options::Options;
use crate::render::options::Stop;

/// A kernel to be compiled.
#[derive(Debug, Clone, PartialEq)]
pub struct Planned {
    pub shape: String,
    pub name: &'static str,
    pub precision: Precision,
    pub arithmetic: Arithmetic,
    /// Operations of the graph that it evaluates, constants and inputs left out.
    pub operations: usize,
    pub reason: &'static str,
}

/// The plan of a picture; its `Display` is what `imp explain` prints.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Plan {
    pub kernels: Vec<Planned>,
    /// One line each on arithmetic, rays and effects, with the reason.
    pub notes: Vec<String>,
}

impl Plan {
    /// Adds a kernel; hands it through.
    pub fn kernel<K>(
        &mut self,
        shape: &Shape,
        name: &'static str,
        precision: Precision,
        (spec, kernel): (Spec, K),
        reason: &'static str,
    ) -> K {
        let roots: Vec<Value> = spec.outputs.iter().map(|output| output.value()).collect();
        let needed = spec.graph.reachable(&roots);
        let operations = spec.graph.iter().filter(|(v, node)| needed[v.index()] && node.op.arity() > 0).count();
        let (shape, arithmetic) = (shape.name.clone(), spec.arithmetic);
        self.kernels.push(Planned { shape, name, precision, arithmetic, operations, reason });
        kernel
    }

    /// Notes on what all of a picture's kernels have in common.
    pub fn describe(&mut self, scene: &Scene, options: &Options) {
        let (width, height) = (options.width, options.height);
        if scene.dimension() == 2 {
            self.notes.push(format!("boxes: {width}x{height} pixels, quartered until the field decides each"));
        } else {
            let projection = match scene.view.camera.projection {
                Some(Projection::Orthographic) => "parallel rays",
                Some(Projection::Perspective) | None => "rays from one eye",
            };
            self.notes.push(format!("rays: {width}x{height} {projection}, marched in beams of up to 64x64 pixels"));
            let stop = match options.stop {
                Stop::Depth(depth) => format!("cells of 2^-{depth} of the domain"),
                Stop::Epsilon(length) => format!("cells no longer than {length}"),
                Stop::Tolerance(width) => format!("cells over which the field varies by no more than {width}"),
            };
            self.notes.push(format!("hits: brackets refined to {stop}"));
        }
        self.notes.push(match options.rounding {
            Rounding::Outward => "rounding: outward, so that hits and misses are proofs".to_owned(),
            Rounding::Nearest => "rounding: to nearest, as the source papers did it; nothing is proved".to_owned(),
        });
        let lit = !matches!(&scene.view.lights, Some(lights) if lights.is_empty());
        self.notes.push(match (options.layers.color, lit) {
            (false, _) => "shading: none, no colour is asked for".to_owned(),
            (true, false) => "shading: flat, the scene has no light".to_owned(),
            (true, true) if scene.dimension() == 2 => "shading: strokes and fills".to_owned(),
            (true, true) => "shading: Phong".to_owned(),
        });
        self.notes.push("shadows, reflections, refraction: none, the scene asks for none".to_owned());
        if options.certificate {
            self.notes.push("certificate: every refuted cell is recorded".to_owned());
        }
    }
}

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for kernel in &self.kernels {
            let format = match kernel.precision {
                Precision::Single => "f32",
                Precision::Double => "f64",
            };
            let arithmetic = match kernel.arithmetic {
                Arithmetic::Point => "points",
                Arithmetic::Interval => "intervals",
                Arithmetic::Affine => "affine forms",
            };
            let Planned { shape, name, operations, reason, .. } = kernel;
            writeln!(f, "kernel {shape}.{name}: {operations} operations on {format} {arithmetic}: {reason}")?;
        }
        for note in &self.notes {
            writeln!(f, "{note}")?;
        }
        Ok(())
    }
}

/// The arithmetic that refutes cells of beams or boxes, with the reason; everything else is interval arithmetic.
pub fn arithmetic(scene: &Scene, shape: &Shape, choice: Enclosures) -> (Arithmetic, String) {
    match choice {
        Enclosures::Interval => return (Arithmetic::Interval, "intervals were asked for".to_owned()),
        Enclosures::Centred => {
            return (Arithmetic::Interval, "centred forms were asked for, beside intervals".to_owned());
        }
        Enclosures::Affine => return (Arithmetic::Affine, "affine forms were asked for".to_owned()),
        Enclosures::Auto => {}
    }
    let domain: Vec<(&str, Interval)> = COORDINATES.into_iter().zip(scene.domain.iter().copied()).collect();
    let parameters: Vec<(&str, Interval)> = scene
        .parameters
        .iter()
        .map(|parameter| (parameter.name.as_str(), parameter.range.unwrap_or(Interval::ENTIRE)))
        .collect();
    match derive::choose(&scene.graph, shape.field, &domain, &parameters) {
        Some(choice) => (choice.arithmetic, choice.to_string()),
        None => (Arithmetic::Interval, "the formula is too large to try affine forms on".to_owned()),
    }
}
