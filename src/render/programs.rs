//! The kernels of a shape: what each computes, in which format, and its binding to parameters.

use std::collections::HashMap;
use std::sync::Arc;

use num_rational::BigRational;

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
use crate::kernel::Backend;
use crate::kernel::Kernel;
use crate::kernel::Real;
use crate::passes;
use crate::passes::zero_set::numerator;
use crate::program::scene::COORDINATES;
use crate::program::scene::Parameter;
use crate::program::scene::Projection;
use crate::program::scene::Scene;
use crate::program::scene::Shape;
use crate::program::scene::ShapeKind;
use crate::render::batch::Program;

/// The inputs of centred forms and of values at a cell's end.
const CENTRE: &str = "ray.m";
const END: &str = "ray.e";

/// Directions are scaled to 1 along an axis of at least 0.3 of their length (`camera`), so no component exceeds this.
const DIRECTION_BOUND: f64 = 4.0;

/// A format that a backend compiles to.
pub trait Format: Real {
    const PRECISION: Precision;
    fn compile(backend: &dyn Backend, spec: &Spec) -> Result<Arc<dyn Kernel<Self>>, Diagnostic>;
}

impl Format for f32 {
    const PRECISION: Precision = Precision::Single;
    fn compile(backend: &dyn Backend, spec: &Spec) -> Result<Arc<dyn Kernel<f32>>, Diagnostic> {
        backend.compile_f32(spec)
    }
}

impl Format for f64 {
    const PRECISION: Precision = Precision::Double;
    fn compile(backend: &dyn Backend, spec: &Spec) -> Result<Arc<dyn Kernel<f64>>, Diagnostic> {
        backend.compile_f64(spec)
    }
}

/// The bounds of what a camera may hand to the kernels, rounded up to powers of two so that small moves of the camera
/// need no other kernels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    pub projection: Projection,
    /// Of each component of an origin.
    pub origin: f64,
    /// Of the ray parameter.
    pub end: f64,
    /// The axis to which the camera is closest to parallel; its input carries no noise symbol.
    pub axis: usize,
}

impl Reach {
    /// The inputs that vary from ray to ray, in slot order.
    pub fn varying(self) -> [&'static str; 3] {
        match self.projection {
            Projection::Perspective => derive::DIRECTION,
            Projection::Orthographic => derive::ORIGIN,
        }
    }

    /// The inputs that a tile's rays share.
    pub fn shared(self) -> [&'static str; 3] {
        match self.projection {
            Projection::Perspective => derive::ORIGIN,
            Projection::Orthographic => derive::DIRECTION,
        }
    }
}

/// What every order of a shape has in common.
pub struct Orders<'a> {
    pub scene: &'a Scene,
    pub shape: &'a Shape,
    /// `None` for a plane scene.
    pub reach: Option<Reach>,
    pub rounding: Rounding,
    /// Of the kernel that refutes cells of beams, or boxes of a plane scene.
    pub arithmetic: Arithmetic,
}

impl Orders<'_> {
    /// Box in, refutation of the field out, then the condition's verdict if there is one: what refutes cells of beams.
    pub fn beam(&self) -> Spec {
        self.along_ray(&[], self.arithmetic, |_, formulas| vec![Output::Refutation(formulas.field)])
    }

    /// The same by plain intervals: what proves signs at points of single rays.
    pub fn ends(&self) -> Spec {
        self.along_ray(&[], Arithmetic::Interval, |_, formulas| vec![Output::Refutation(formulas.field)])
    }

    /// Box in, verdicts of field and condition out.
    pub fn verdicts(&self) -> Spec {
        self.along_ray(&[], Arithmetic::Interval, |_, formulas| vec![Output::Verdict(formulas.field)])
    }

    /// As [`Orders::verdicts`], but blind to the domain: what decides at the domain's faces.
    pub fn face(&self) -> Spec {
        let mut spec = self.verdicts();
        spec.domain.clear();
        spec
    }

    /// Box, centre and end in; the verdict of the field, refutations of its centred form, its slope and its value at the
    /// end, the condition's verdict, and for zero sets with poles the refutation of the numerator out: what settles cells
    /// with their derivative.
    pub fn slope(&self) -> Spec {
        // Affine forms of a derivative take several times as long to compile and to run and decide little more.
        self.along_ray(&[CENTRE, END], Arithmetic::Interval, |graph, formulas| {
            let slope = derive::derivative(graph, formulas.field, formulas.t);
            let centred = derive::centred(graph, formulas.field, formulas.t, CENTRE);
            let end = graph.var(END);
            let at_end = graph.substitute(&[formulas.field], &HashMap::from([(formulas.t, end)]))[0];
            let mut outputs = vec![Output::Verdict(formulas.field)];
            outputs.extend([centred, slope, at_end].map(Output::Refutation));
            outputs
        })
    }

    /// Box and centre in; the enclosure of the field, refutations of its slope and its centred form, the condition's
    /// verdict, and for zero sets with poles the refutation of the numerator out.
    pub fn piece(&self) -> Spec {
        self.along_ray(&[CENTRE], Arithmetic::Interval, |graph, formulas| {
            let slope = derive::derivative(graph, formulas.field, formulas.t);
            let centred = derive::centred(graph, formulas.field, formulas.t, CENTRE);
            vec![Output::Enclosure(formulas.field), Output::Refutation(slope), Output::Refutation(centred)]
        })
    }

    /// Point in; field and slope out: what Newton's method follows.
    pub fn root(&self) -> Spec {
        let mut spec = self.along_ray(&[], Arithmetic::Point, |graph, formulas| {
            let slope = derive::derivative(graph, formulas.field, formulas.t);
            vec![Output::Value(formulas.field), Output::Value(slope)]
        });
        spec.domain.clear();
        spec
    }

    /// Point x, y(, z) in; field and gradient out: what normals and strokes are made of.
    pub fn gradient(&self) -> Spec {
        let mut graph = Graph::new();
        let coordinates: Vec<Value> = self.coordinates().iter().map(|name| graph.var(name)).collect();
        let field = graph.import(&self.scene.graph, &[self.shape.field], &HashMap::new())[0];
        let mut outputs = vec![Output::Value(field)];
        outputs.extend(derive::gradient(&mut graph, field, &coordinates).into_iter().map(Output::Value));
        self.spec(graph, self.coordinates(), outputs, Vec::new(), Arithmetic::Point)
    }

    /// Box x, y(, z) in; verdicts of field and condition, and for zero sets with poles the refutation of the numerator out:
    /// what decides pixels of a plane scene.
    pub fn region(&self) -> Spec {
        let mut graph = Graph::new();
        let coordinates: Vec<Value> = self.coordinates().iter().map(|name| graph.var(name)).collect();
        let mut roots = vec![self.shape.field];
        roots.extend(self.shape.condition);
        let roots = graph.import(&self.scene.graph, &roots, &HashMap::new());
        let mut outputs = vec![Output::Verdict(roots[0])];
        outputs.extend(roots.get(1).map(|&condition| Output::Verdict(less_half(&mut graph, condition))));
        outputs.extend(self.numerator(&mut graph, roots[0]));
        let domain = coordinates.into_iter().zip(self.scene.domain.iter().copied()).collect();
        self.spec(graph, self.coordinates(), outputs, domain, self.arithmetic)
    }

    /// Box x, y(, z) and further inputs in, outputs of a graph of one's own out, by plain intervals.
    pub fn boxes(&self, mut graph: Graph, inputs: &[String], outputs: Vec<Output>) -> Spec {
        let coordinates = self.coordinates();
        let domain = coordinates.iter().map(|name| graph.var(name)).zip(self.scene.domain.iter().copied()).collect();
        let lanes = coordinates.into_iter().chain(inputs.iter().cloned()).collect();
        self.spec(graph, lanes, outputs, domain, Arithmetic::Interval)
    }

    /// For zero sets with poles: the refutation of the numerator.
    fn numerator(&self, graph: &mut Graph, field: Value) -> Option<Output> {
        match self.shape.kind {
            ShapeKind::Equation => numerator(graph, field).map(Output::Refutation),
            // The boundary of a region may run along a pole.
            ShapeKind::Region => None,
        }
    }

    fn coordinates(&self) -> Vec<String> {
        COORDINATES[..self.scene.dimension()].iter().map(|&name| name.to_owned()).collect()
    }

    fn along_ray(
        &self,
        extra: &[&'static str],
        arithmetic: Arithmetic,
        outputs: impl FnOnce(&mut Graph, Formulas) -> Vec<Output>,
    ) -> Spec {
        let mut roots = vec![self.shape.field];
        roots.extend(self.shape.condition);
        let mut ray = derive::along_ray(&self.scene.graph, &roots, self.scene.dimension());
        let reach = self.reach.expect("only a space scene casts rays");
        let mut outputs = outputs(&mut ray.graph, Formulas { field: ray.roots[0], t: ray.t });
        if let (Some(&condition), false) = (ray.roots.get(1), arithmetic == Arithmetic::Point) {
            outputs.push(Output::Verdict(less_half(&mut ray.graph, condition)));
        }
        if extra.contains(&CENTRE) {
            outputs.extend(self.numerator(&mut ray.graph, ray.roots[0]));
        }
        let domain = ray.coordinates.into_iter().zip(self.scene.domain.iter().copied()).collect();
        let lanes = reach.varying();
        let lanes = lanes.iter().chain([&derive::PARAMETER]).chain(extra);
        let lanes = lanes.map(|&name| name.to_owned()).collect();
        self.spec(ray.graph, lanes, outputs, domain, arithmetic)
    }

    fn spec(
        &self,
        graph: Graph,
        lanes: Vec<String>,
        outputs: Vec<Output>,
        domain: Vec<(Value, Interval)>,
        arithmetic: Arithmetic,
    ) -> Spec {
        let promises: Vec<(String, Interval)> =
            graph.variables().iter().filter_map(|name| Some((name.clone(), self.promise(name)?))).collect();
        let (graph, outputs, domain) = simplify(graph, outputs, domain, &promises);
        let uniforms = graph.variables().iter().filter(|name| !lanes.contains(name)).cloned().collect();
        let mut symbols = Vec::new();
        if let (Arithmetic::Affine, Some(reach)) = (arithmetic, self.reach) {
            symbols.push(derive::PARAMETER.to_owned());
            symbols.extend((0..3).filter(|&c| c != reach.axis).map(|c| reach.varying()[c].to_owned()));
        } else if arithmetic == Arithmetic::Affine {
            symbols.extend(self.coordinates());
        }
        Spec {
            graph: Arc::new(graph),
            inputs: lanes,
            uniforms,
            outputs,
            domain,
            promises,
            arithmetic,
            symbols,
            rounding: self.rounding,
        }
    }

    /// What an input may be. Parameters are rounded outward to single precision, which is what `f32` kernels receive.
    fn promise(&self, name: &str) -> Option<Interval> {
        if let Some(parameter) = self.scene.parameters.iter().find(|parameter| parameter.name == name) {
            let range = parameter.range?;
            return Interval::new(f32::down(range.lo()).to_f64(), f32::up(range.hi()).to_f64());
        }
        let reach = self.reach?;
        if derive::ORIGIN.contains(&name) {
            Interval::new(-reach.origin, reach.origin)
        } else if derive::DIRECTION.contains(&name) {
            Interval::new(-DIRECTION_BOUND, DIRECTION_BOUND)
        } else if [derive::PARAMETER, CENTRE, END].contains(&name) {
            Interval::new(0.0, reach.end)
        } else {
            None
        }
    }
}

/// A shape's formulas along the ray.
#[derive(Clone, Copy)]
struct Formulas {
    field: Value,
    t: Value,
}

/// A truth value less one half: positive where true, negative where false.
pub fn less_half(graph: &mut Graph, condition: Value) -> Value {
    let half = graph.constant(BigRational::new(1.into(), 2.into()));
    graph.sub(condition, half)
}

/// Runs the passes over a derived graph, which has terms that its source had not.
pub fn simplify(
    mut graph: Graph,
    outputs: Vec<Output>,
    domain: Vec<(Value, Interval)>,
    promises: &[(String, Interval)],
) -> (Graph, Vec<Output>, Vec<(Value, Interval)>) {
    let values = outputs.iter().map(|output| output.value()).chain(domain.iter().map(|&(value, _)| value));
    for (index, value) in values.collect::<Vec<_>>().into_iter().enumerate() {
        graph.add_output(index.to_string(), value);
    }
    let known = |name: &String| promises.iter().find(|(n, _)| n == name).map_or(Interval::ENTIRE, |&(_, range)| range);
    let inputs: Vec<Interval> = graph.variables().iter().map(known).collect();
    let (graph, _) = passes::run(&graph, &inputs);
    let results: Vec<Value> = graph.outputs().iter().map(|&(_, value)| value).collect();
    let count = outputs.len();
    let outputs = outputs.into_iter().zip(&results).map(|(output, &value)| match output {
        Output::Value(_) => Output::Value(value),
        Output::Enclosure(_) => Output::Enclosure(value),
        Output::Verdict(_) => Output::Verdict(value),
        Output::Refutation(_) => Output::Refutation(value),
    });
    let outputs = outputs.collect();
    let domain = domain.into_iter().zip(&results[count..]).map(|((_, range), &value)| (value, range)).collect();
    (graph, outputs, domain)
}

/// A kernel with the names of its uniforms.
#[derive(Clone)]
pub struct Compiled<T: Real> {
    kernel: Arc<dyn Kernel<T>>,
    uniforms: Vec<String>,
    point: bool,
}

impl<T: Format> Compiled<T> {
    pub fn new(backend: &dyn Backend, spec: &Spec) -> Result<Self, Diagnostic> {
        let kernel = T::compile(backend, spec)?;
        Ok(Self { kernel, uniforms: spec.uniforms.clone(), point: spec.arithmetic == Arithmetic::Point })
    }

    /// The kernel on these parameters and constants of the rays.
    ///
    /// # Panics
    /// If a uniform is neither a parameter nor among the constants: our mistake.
    pub fn bind(&self, parameters: &[Parameter], constants: &[(&str, f64)]) -> Program<T> {
        let mut uniforms = Vec::new();
        for name in &self.uniforms {
            let constant = constants.iter().find(|(n, _)| n == name).map(|&(_, value)| Interval::point(value));
            let parameter = || parameters.iter().find(|parameter| &parameter.name == name).map(|p| p.value);
            let value = constant.or_else(parameter).expect("every uniform is a parameter or a constant of the rays");
            if self.point {
                uniforms.push(T::nearest(value.mid()));
            } else {
                uniforms.extend([T::up(-value.lo()), T::up(value.hi())]);
            }
        }
        Program { kernel: Arc::clone(&self.kernel), uniforms: uniforms.into() }
    }
}
