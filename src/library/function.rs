//! A function of numbers: what kernels are compiled from.

use std::fmt;
use std::sync::Arc;

use crate::derive;
use crate::derive::Arithmetic;
use crate::derive::Output;
use crate::derive::Precision;
use crate::derive::Rounding;
use crate::derive::Spec;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::Span;
use crate::graph::Graph;
use crate::graph::Value;
use crate::interval::Interval;
use crate::kernel::Real;
use crate::library::Error;
use crate::library::IntervalKernel;
use crate::library::PointKernel;
use crate::library::Program;
use crate::library::kernel::Compile;
use crate::limits::Budget;
use crate::limits::Limits;
use crate::passes;
use crate::program;
use crate::program::scene::Parameter;

/// A function of a [`crate::library::Program`], ready to be compiled. Cheap to clone.
#[derive(Clone)]
pub struct Function {
    resolved: Arc<program::Function>,
    outputs: Arc<[String]>,
    limits: Limits,
}

/// The input of a kernel of no variables; no name of the language has a point.
const UNUSED: &str = "unused.";

/// How a function is compiled.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Bounds by affine forms (AF1: Messine 2002), intersected with the natural extension: narrower on small boxes where a
    /// variable occurs several times, and three to six times the work. Of more than three variables the first three
    /// have noise symbols of their own.
    pub affine: bool,
    /// Whether the partial derivatives by all variables are outputs, too. At a kink a partial's enclosure is the hull of both
    /// sides, across a jump it is the whole line.
    pub gradient: bool,
    /// [`Rounding::Outward`] proves; [`Rounding::Nearest`] shows what that costs, and proves nothing.
    pub rounding: Rounding,
    /// Where variables lie, by name; others are anywhere. Boxes are intersected with it, and one outside is reported as
    /// empty. It tells signs and excludes overflow, which makes kernels faster and bounds narrower.
    pub domain: Vec<(String, Interval)>,
}

impl Default for Options {
    /// Natural extension, no gradient, rounded outward, everywhere.
    fn default() -> Self {
        Self { affine: false, gradient: false, rounding: Rounding::Outward, domain: Vec::new() }
    }
}

impl Options {
    /// Adds what is known of a variable.
    pub fn on(mut self, variable: impl Into<String>, range: Interval) -> Self {
        self.domain.push((variable.into(), range));
        self
    }

    /// The default with partial derivatives.
    pub fn with_gradient() -> Self {
        Self { gradient: true, ..Self::default() }
    }
}

impl Function {
    pub(super) fn new(resolved: program::Function, limits: Limits) -> Self {
        let outputs = match resolved.values.len() {
            1 => vec![resolved.name.clone()],
            n => (1..=n).map(|i| format!("{}[{i}]", resolved.name)).collect(),
        };
        Self { resolved: Arc::new(resolved), outputs: outputs.into(), limits }
    }

    /// A function of the given variables from an expression alone.
    ///
    /// # Errors
    /// [`Error::Source`] with all of its mistakes.
    pub fn parse(text: &str, variables: &[&str]) -> Result<Self, Error> {
        Program::parse("")?.expression(text, variables)
    }

    /// As it is written in the source.
    pub fn name(&self) -> &str {
        &self.resolved.name
    }

    /// The comment lines before it.
    pub fn doc(&self) -> &[String] {
        &self.resolved.doc
    }

    /// Where it is written.
    pub fn span(&self) -> Span {
        self.resolved.span
    }

    /// What it is called with, in order: its arguments, then the coordinates `x`, `y`, `z` and the time `t` on which it
    /// depends without having them as arguments.
    pub fn variables(&self) -> &[String] {
        &self.resolved.variables
    }

    /// What it depends on besides; each has a value until a kernel sets another one.
    pub fn parameters(&self) -> &[Parameter] {
        &self.resolved.parameters
    }

    /// Its values: the name alone, or `name[1]`, `name[2]`, ... of a list.
    pub fn outputs(&self) -> &[String] {
        &self.outputs
    }

    /// The outputs of a kernel: each value, followed by its partial derivatives with [`Options::gradient`].
    pub fn outputs_of(&self, options: &Options) -> Vec<String> {
        let partials = |output: &String| -> Vec<String> {
            let by = self.variables().iter().filter(|_| options.gradient);
            by.map(|variable| format!("d{output}/d{variable}")).collect()
        };
        self.outputs.iter().flat_map(|output| [vec![output.clone()], partials(output)].concat()).collect()
    }

    /// Its formula in SSA form; the inputs are the variables in their order, then the parameters.
    pub fn graph(&self) -> &Graph {
        &self.resolved.graph
    }

    /// Its values in [`Function::graph`].
    pub fn values(&self) -> &[Value] {
        &self.resolved.values
    }

    /// The variables' names in [`Function::graph`].
    pub(super) fn inputs(&self) -> &[String] {
        &self.resolved.inputs
    }

    /// Bounds over boxes, in double precision.
    ///
    /// # Errors
    /// If the options name a variable that the function does not have, or the function is too large.
    pub fn intervals(&self, options: &Options) -> Result<IntervalKernel<f64>, Error> {
        self.interval_kernel(options)
    }

    /// Bounds over boxes in either precision. In single precision boxes are rounded outward first; bounds are wider, and
    /// twice as many boxes fit in a register.
    ///
    /// # Errors
    /// As [`Function::intervals`].
    pub fn interval_kernel<T: Compile>(&self, options: &Options) -> Result<IntervalKernel<T>, Error> {
        IntervalKernel::new(self, options)
    }

    /// Values at points, in double precision, rounded to nearest operation by operation: fast, and nothing is proved.
    ///
    /// # Errors
    /// As [`Function::intervals`].
    pub fn points(&self, options: &Options) -> Result<PointKernel<f64>, Error> {
        self.point_kernel(options)
    }

    /// Values at points in either precision.
    ///
    /// # Errors
    /// As [`Function::intervals`].
    pub fn point_kernel<T: Compile>(&self, options: &Options) -> Result<PointKernel<T>, Error> {
        PointKernel::new(self, options)
    }

    /// The order for a kernel that encloses all outputs over boxes: what [`crate::derive::Spec::lower`] takes. Parameters must lie
    /// in their ranges.
    ///
    /// # Errors
    /// As [`Function::intervals`].
    pub fn box_spec(&self, options: &Options, precision: Precision) -> Result<Spec, Error> {
        let arithmetic = if options.affine { Arithmetic::Affine } else { Arithmetic::Interval };
        let mut spec = self.spec(options, precision, arithmetic, Output::Enclosure)?;
        if options.affine {
            spec.symbols = spec.inputs.iter().take(3).cloned().collect();
        }
        Ok(spec)
    }

    /// The order for a kernel that computes all outputs at points.
    ///
    /// # Errors
    /// As [`Function::intervals`].
    pub fn point_spec(&self, options: &Options, precision: Precision) -> Result<Spec, Error> {
        let spec = self.spec(options, precision, Arithmetic::Point, Output::Value)?;
        Ok(Spec { rounding: Rounding::Nearest, ..spec })
    }

    /// What each stage after the text may take.
    pub(super) fn budget(&self) -> Budget {
        Budget::new(&self.limits)
    }

    /// Where a parameter may lie in kernels of a precision: its declared range, or all reals, rounded outward to that precision.
    pub fn range_in(parameter: &Parameter, precision: Precision) -> Interval {
        let range = parameter.range.unwrap_or(Interval::ENTIRE);
        match precision {
            Precision::Double => range,
            Precision::Single => {
                let (lo, hi) = (f32::down(range.lo()).to_f64(), f32::up(range.hi()).to_f64());
                Interval::new(lo, hi).unwrap_or(Interval::ENTIRE)
            }
        }
    }

    /// Passes, promises and whatever a caller checks hold for the same ranges of parameters: those of the precision.
    fn spec(
        &self,
        options: &Options,
        precision: Precision,
        arithmetic: Arithmetic,
        output: fn(Value) -> Output,
    ) -> Result<Spec, Error> {
        let (resolved, budget) = (&self.resolved, &self.budget());
        if let Some((name, _)) = options.domain.iter().find(|(name, _)| !resolved.variables.contains(name)) {
            return Err(Error::UnknownVariable { name: name.clone(), known: resolved.variables.clone() });
        }
        let range = |variable: &String| {
            let given = options.domain.iter().filter(|(name, _)| name == variable);
            given.fold(Interval::ENTIRE, |all, (_, range)| all.intersect(*range))
        };
        let mut ranges: Vec<Interval> = resolved.variables.iter().map(range).collect();
        ranges.extend(resolved.parameters.iter().map(|parameter| Self::range_in(parameter, precision)));

        let mut graph = resolved.graph.clone();
        let variables: Vec<Value> = resolved.inputs.iter().map(|name| graph.var(name)).collect();
        let mut values = Vec::new();
        for &value in &resolved.values {
            values.push(value);
            if options.gradient {
                let gradient = derive::gradient_within(&mut graph, value, &variables, budget);
                values.extend(gradient.map_err(Diagnostic::from)?);
            }
        }
        for (index, value) in values.iter().enumerate() {
            graph.add_output(index.to_string(), *value);
        }
        let (mut graph, _) = passes::run_within(&graph, &ranges, budget).map_err(Diagnostic::from)?;
        let outputs = graph.outputs().iter().map(|&(_, value)| output(value)).collect();
        let domain = resolved.inputs.iter().zip(&ranges).filter(|(_, range)| !range.is_entire());
        let domain = domain.map(|(name, range)| (graph.var(name), *range)).collect();
        let mut inputs = resolved.inputs.clone();
        if inputs.is_empty() {
            // A constant has a row of inputs, too: kernels count rows by their inputs.
            inputs.push(UNUSED.to_owned());
            graph.var(UNUSED);
        }
        let ranged = resolved.parameters.iter().filter(|parameter| parameter.range.is_some());
        let promised = ranged.map(|p| (p.name.clone(), Self::range_in(p, precision)));
        Ok(Spec {
            inputs,
            uniforms: resolved.parameters.iter().map(|parameter| parameter.name.clone()).collect(),
            outputs,
            domain,
            promises: promised.collect(),
            arithmetic,
            symbols: Vec::new(),
            rounding: options.rounding,
            graph: Arc::new(graph),
        })
    }
}

/// `name(x, y; a)`: the variables, then the parameters.
impl fmt::Debug for Function {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parameters: Vec<&str> = self.parameters().iter().map(|parameter| parameter.name.as_str()).collect();
        write!(f, "{}({}", self.name(), self.variables().join(", "))?;
        if !parameters.is_empty() {
            write!(f, "; {}", parameters.join(", "))?;
        }
        write!(f, ")")
    }
}
