//! Expressions as Imp reads them, with what it says of them: by reference arithmetic in every extension and by compiled
//! kernels of both formats.

use std::sync::Arc;

use imp::derive;
use imp::derive::Arithmetic;
use imp::derive::Extension;
use imp::derive::Output;
use imp::derive::Rounding;
use imp::derive::Spec;
use imp::diagnostic::SourceMap;
use imp::graph::Graph;
use imp::graph::Value;
use imp::graph::enclose;
use imp::interval::Decorated;
use imp::interval::Interval;
use imp::kernel::Kernel;
use imp::kernel::Packet;
use imp::kernel::Real;
use imp::limits::Budget;
use imp::limits::Limits;
use imp::passes;
use imp::program;
use imp::program::Context;
use imp::program::Embedded;
use imp::session;
use imp::syntax;
use num_rational::BigRational;

/// One expression in the variables x, y and z.
pub struct Formula {
    graph: Graph,
    root: Value,
}

/// x as a set.
pub fn point(x: f64) -> Interval {
    Interval::point(x)
}

/// A rational number exactly written, as the tightest enclosure.
pub fn rational(text: &str) -> Interval {
    Interval::from_rational(&text.parse::<BigRational>().expect("a rational number"))
}

impl Formula {
    pub fn new(text: &str) -> Self {
        Self::with("", text)
    }

    /// An expression over definitions.
    pub fn with(definitions: &str, text: &str) -> Self {
        let mut sources = SourceMap::default();
        let file = sources.add("case", text);
        let budget = Budget::new(&Limits::default());
        let context =
            Context { importer: &Embedded, differentiate: &derive::derivative_within, overrides: &[], budget: &budget };
        let definitions_file = sources.add("definitions", definitions);
        let (module, found) = syntax::parse(definitions_file, definitions);
        assert!(found.is_empty() || definitions.is_empty(), "{definitions}: {found:?}");
        let resolved = syntax::parse_expression(file, text).and_then(|expression| {
            program::resolve_expression(&mut sources, &expression, &["x", "y", "z"], module, &context)
        });
        let resolved = resolved.unwrap_or_else(|diagnostics| panic!("{text}: {diagnostics:?}"));
        Self { graph: resolved.graph, root: resolved.value }
    }

    /// After the passes, which fold what is constant exactly.
    pub fn folded(&self) -> Self {
        let mut graph = self.graph.clone();
        graph.add_output("f", self.root);
        let inputs = vec![Interval::ENTIRE; graph.variables().len()];
        let (graph, _) = passes::run(&graph, &inputs);
        let root = graph.output("f").expect("passes keep outputs");
        Self { graph, root }
    }

    /// The exact number, if the expression is one.
    pub fn number(&self) -> Option<&BigRational> {
        self.graph.as_constant(self.root)
    }

    /// The values of x, y, z in the order in which the graph knows its inputs.
    fn inputs<T: Copy>(&self, values: &[T]) -> Vec<T> {
        let place = |name: &String| ["x", "y", "z"].iter().position(|v| v == name).expect("x, y or z");
        self.graph.variables().iter().map(|name| values[place(name)]).collect()
    }

    /// The natural extension in reference arithmetic.
    pub fn reference(&self, values: &[Interval]) -> Decorated {
        let inputs: Vec<Decorated> = self.inputs(values).into_iter().map(Decorated::new).collect();
        enclose(&self.graph, &[self.root], &inputs)[0]
    }

    fn spec(&self, rounding: Rounding) -> Spec {
        Spec {
            graph: Arc::new(self.graph.clone()),
            inputs: self.graph.variables().to_vec(),
            uniforms: Vec::new(),
            outputs: vec![Output::Enclosure(self.root)],
            domain: Vec::new(),
            promises: Vec::new(),
            arithmetic: Arithmetic::Interval,
            symbols: Vec::new(),
            rounding,
        }
    }

    /// Everything that encloses the formula and must hold.
    pub fn answers(&self) -> Answers {
        let spec = self.spec(Rounding::Outward);
        Answers {
            reference: derive::Formula::new(&self.graph, self.root),
            single: Boxes::new(session::backend().compile_f32(&spec), self),
            double: Boxes::new(session::backend().compile_f64(&spec), self),
            variables: self.inputs(&[0, 1, 2]),
        }
    }

    /// Intervals as other programs compute them: every operation rounded to nearest.
    pub fn nearest_single(&self) -> Boxes<f32> {
        Boxes::new(session::backend().compile_f32(&self.spec(Rounding::Nearest)), self)
    }

    /// The same in double precision.
    pub fn nearest_double(&self) -> Boxes<f64> {
        Boxes::new(session::backend().compile_f64(&self.spec(Rounding::Nearest)), self)
    }
}

/// The reference in every extension, and the compiled kernels of both formats.
pub struct Answers {
    reference: derive::Formula,
    single: Boxes<f32>,
    double: Boxes<f64>,
    variables: Vec<usize>,
}

impl Answers {
    /// The enclosure over a box by the reference in each extension and by each kernel, under their names.
    pub fn each(&self, values: &[Interval]) -> Vec<(&'static str, Interval)> {
        let inputs: Vec<Decorated> = self.variables.iter().map(|&i| Decorated::new(values[i])).collect();
        let reference = |&way: &Extension| (way.name(), self.reference.enclose(way, &inputs).interval());
        let mut all: Vec<(&str, Interval)> = Extension::ALL.iter().map(reference).collect();
        all.extend([("kernel in f32", self.single.enclose(values)), ("kernel in f64", self.double.enclose(values))]);
        all
    }

    /// Asserts that each of them is as it must be.
    pub fn all(&self, values: &[Interval], holds: impl Fn(Interval) -> bool) {
        for (name, interval) in self.each(values) {
            assert!(holds(interval), "{name} over {values:?}: {interval}");
        }
    }
}

/// A kernel that encloses a formula over boxes.
pub struct Boxes<T: Real> {
    kernel: Arc<dyn Kernel<T>>,
    variables: Vec<usize>,
}

impl<T: Real> Boxes<T> {
    fn new(kernel: Result<Arc<dyn Kernel<T>>, imp::diagnostic::Diagnostic>, formula: &Formula) -> Self {
        Self { kernel: kernel.expect("a kernel"), variables: formula.inputs(&[0, 1, 2]) }
    }

    /// The enclosure over a box, whose ends are rounded outward to the format.
    pub fn enclose(&self, values: &[Interval]) -> Interval {
        self.run(values, T::up)
    }

    /// The same with the box rounded to nearest, as a program without outward rounding takes it.
    pub fn enclose_nearest(&self, values: &[Interval]) -> Interval {
        self.run(values, T::nearest)
    }

    fn run(&self, values: &[Interval], round: fn(f64) -> T) -> Interval {
        let ends = self.variables.iter().flat_map(|&i| [round(-values[i].lo()), round(values[i].hi())]);
        let inputs: Vec<Packet<T>> = ends.map(Packet::splat).collect();
        let mut outputs = [Packet::default(); 3];
        self.kernel.run(&[], &inputs, &mut outputs);
        let [negated, hi] = [0, 1].map(|slot| outputs[slot].lanes()[0].to_f64());
        let end = |x: f64, otherwise: f64| if x.is_nan() { otherwise } else { x };
        let (lo, hi) = (end(-negated, f64::NEG_INFINITY), end(hi, f64::INFINITY));
        // An end that overflowed inwards stands for some number that large.
        Interval::new(lo.min(f64::MAX), hi.max(f64::MIN)).unwrap_or(Interval::EMPTY)
    }
}
