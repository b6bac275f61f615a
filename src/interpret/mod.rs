//! The reference kernel: the graph of a [`Spec`], operation by operation, on the tightest enclosures that Imp has. It is
//! slow and written to be checked by eye; every compiled kernel must enclose what it encloses, and no kernel may prove
//! more than it does.

mod point;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use crate::derive::Arithmetic;
use crate::derive::Output;
use crate::derive::Spec;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::graph::Graph;
use crate::graph::Op;
use crate::graph::Value;
use crate::graph::apply;
use crate::graph::apply_affine;
use crate::interval::Affine;
use crate::interval::Decorated;
use crate::interval::Decoration;
use crate::interval::Interval;
use crate::kernel::Backend;
use crate::kernel::Kernel;
use crate::kernel::Packet;
use crate::kernel::Real;
use crate::kernel::verdict;

/// A form in the noise symbols of [`Spec::symbols`], of which a program has at most three.
type Form = Affine<MAX_SYMBOLS>;

const MAX_SYMBOLS: usize = 3;

/// Makes reference kernels.
///
/// Enclosures are computed in `f64` for both formats: `f32` inputs are exact there, and outputs are rounded outward. With
/// [`Rounding::Nearest`](crate::derive::Rounding) they hold all the same, since nothing here is rounded otherwise; that
/// such a program proves nothing is for its consumer to heed.
///
/// Affine programs carry an AF1 form beside each enclosure and intersect the two after each operation.
///
/// Point kernels evaluate with the functions of the standard library, constants rounded to nearest, NaN where an
/// operation is undefined; they take no notice of the domain.
#[derive(Debug, Clone, Copy, Default)]
pub struct Interpreter;

impl Backend for Interpreter {
    fn compile_f32(&self, spec: &Spec) -> Result<Arc<dyn Kernel<f32>>, Diagnostic> {
        Ok(Arc::new(Program::new(spec)?))
    }

    fn compile_f64(&self, spec: &Spec) -> Result<Arc<dyn Kernel<f64>>, Diagnostic> {
        Ok(Arc::new(Program::new(spec)?))
    }
}

/// Where the value of an input comes from.
#[derive(Debug, Clone, Copy)]
enum Source {
    Lane(usize),
    Uniform(usize),
}

/// A spec with what does not depend on the boxes.
#[derive(Debug)]
struct Program {
    graph: Arc<Graph>,
    arithmetic: Arithmetic,
    lanes: usize,
    uniforms: usize,
    outputs: Vec<Output>,
    /// The inputs that outputs or domain need, with the noise symbol of those that have one.
    inputs: Vec<(Value, Source, Option<usize>)>,
    /// The operations that they need, in order, without constants and inputs.
    steps: Vec<Value>,
    /// The enclosure of each node that is a constant; ill elsewhere.
    constants: Vec<Decorated>,
    /// For each node what is known of it.
    known: Vec<Option<Interval>>,
}

impl Program {
    /// # Errors
    /// A spec that contradicts itself: an input in neither list, or an output that its arithmetic does not have. Ours, not
    /// the user's.
    fn new(spec: &Spec) -> Result<Self, Diagnostic> {
        let graph = &spec.graph;
        let point = spec.arithmetic == Arithmetic::Point;
        if spec.outputs.iter().any(|output| matches!(output, Output::Value(_)) != point) {
            return Err(Diagnostic::error(
                "E0901",
                "a point program has values for outputs, all others have enclosures",
            ));
        }
        if spec.symbols.len() > MAX_SYMBOLS {
            return Err(Diagnostic::error(code::INTERNAL, "a program has at most three noise symbols"));
        }
        let mut roots: Vec<Value> = spec.outputs.iter().map(|output| output.value()).collect();
        roots.extend(spec.domain.iter().filter(|_| !point).map(|&(value, _)| value));
        let needed = graph.reachable(&roots);

        let mut inputs = Vec::new();
        let mut steps = Vec::new();
        let mut constants = vec![Decorated::ILL; graph.len()];
        for (value, node) in graph.iter().filter(|(value, _)| needed[value.index()]) {
            match node.op {
                Op::Var(id) => {
                    let name = &graph.variables()[id as usize];
                    let symbol = spec.symbols.iter().position(|symbol| symbol == name);
                    inputs.push((value, source(spec, name)?, symbol));
                }
                _ if node.operands().is_empty() => constants[value.index()] = apply(graph, node, &[]),
                _ => steps.push(value),
            }
        }
        let mut known = vec![None; graph.len()];
        for &(value, interval) in &spec.domain {
            let before = known[value.index()].unwrap_or(Interval::ENTIRE);
            known[value.index()] = Some(interval.intersect(before));
        }
        Ok(Program {
            graph: Arc::clone(graph),
            arithmetic: spec.arithmetic,
            lanes: spec.inputs.len(),
            uniforms: spec.uniforms.len(),
            outputs: spec.outputs.clone(),
            inputs,
            steps,
            constants,
            known,
        })
    }

    /// Slots that one input takes: its ends, or itself.
    fn width(&self) -> usize {
        if self.arithmetic == Arithmetic::Point { 1 } else { 2 }
    }

    /// The enclosures of one box.
    fn enclose(&self, input: impl Fn(Source) -> Decorated) -> Enclosed {
        let mut enclosed = Enclosed { values: self.constants.clone(), outside: false, inside: true };
        // Without affine arithmetic the forms stay empty; constants get theirs where they are used.
        let affine = self.arithmetic == Arithmetic::Affine;
        let mut forms: Vec<Option<Form>> = vec![None; if affine { self.graph.len() } else { 0 }];
        for &(value, source, symbol) in &self.inputs {
            enclosed.values[value.index()] = input(source);
            enclosed.restrict(value, self.known[value.index()]);
            if let (true, Some(symbol)) = (affine, symbol) {
                forms[value.index()] = Some(Form::from_interval(enclosed.values[value.index()].interval(), symbol));
            }
        }
        let mut operands = Vec::with_capacity(3);
        for &value in &self.steps {
            let node = self.graph.node(value);
            operands.clear();
            operands.extend(node.operands().iter().map(|v| enclosed.values[v.index()]));
            let mut result = apply(&self.graph, node, &operands);
            if affine {
                let form = |v: &Value| {
                    let interval = enclosed.values[v.index()].interval();
                    (forms[v.index()].unwrap_or_else(|| Form::constant(interval)), interval)
                };
                let operand_forms: Vec<(Form, Interval)> = node.operands().iter().map(form).collect();
                let form = apply_affine(node.op, &operand_forms, result.interval());
                forms[value.index()] = Some(form);
                // Both hold wherever the operation is defined, so that what is left holds too.
                result = Decorated::with(result.interval().intersect(form.to_interval()), result.decoration());
            }
            enclosed.values[value.index()] = result;
            enclosed.restrict(value, self.known[value.index()]);
        }
        enclosed
    }

    fn run_boxes<T: Real>(&self, lane: usize, uniforms: &[T], inputs: &[Packet<T>], outputs: &mut [Packet<T>]) {
        let enclosed = self.enclose(|source| {
            let (negated_lo, hi) = match source {
                Source::Lane(i) => (inputs[2 * i].lanes()[lane], inputs[2 * i + 1].lanes()[lane]),
                Source::Uniform(i) => (uniforms[2 * i], uniforms[2 * i + 1]),
            };
            Decorated::new(input_interval(negated_lo, hi))
        });
        let mut slots = outputs.iter_mut();
        let mut store = |number: T| {
            slots.next().expect("the slots of all outputs").lanes_mut()[lane] = number;
        };
        for &output in &self.outputs {
            let (interval, bits) = enclosed.output(output.value());
            if let Output::Enclosure(_) = output {
                let (lo, hi) = if interval.is_empty() {
                    (f64::INFINITY, f64::NEG_INFINITY)
                } else {
                    (interval.lo(), interval.hi())
                };
                store(T::up(-lo));
                store(T::up(hi));
            }
            let refutation = matches!(output, Output::Refutation(_));
            store(T::from_verdict(if refutation { bits & !verdict::CONTINUOUS } else { bits }));
        }
    }

    fn run_points<T: Real>(&self, lane: usize, uniforms: &[T], inputs: &[Packet<T>], outputs: &mut [Packet<T>]) {
        let mut values = vec![f64::NAN; self.graph.len()];
        for (value, _) in self.graph.iter() {
            if let Some(number) = self.graph.as_constant(value) {
                values[value.index()] = point::constant(number);
            }
        }
        for &(value, source, _) in &self.inputs {
            values[value.index()] = match source {
                Source::Lane(i) => inputs[i].lanes()[lane],
                Source::Uniform(i) => uniforms[i],
            }
            .to_f64();
        }
        let mut operands = Vec::with_capacity(3);
        for &value in &self.steps {
            let node = self.graph.node(value);
            operands.clear();
            operands.extend(node.operands().iter().map(|v| values[v.index()]));
            values[value.index()] = point::apply(node.op, &operands);
        }
        for (packet, &output) in outputs.iter_mut().zip(&self.outputs) {
            packet.lanes_mut()[lane] = T::nearest(values[output.value().index()]);
        }
    }
}

impl<T: Real> Kernel<T> for Program {
    fn input_slots(&self) -> usize {
        self.width() * self.lanes
    }

    fn output_slots(&self) -> usize {
        let slots = |output: &Output| match output {
            Output::Value(_) | Output::Verdict(_) | Output::Refutation(_) => 1,
            Output::Enclosure(_) => 3,
        };
        self.outputs.iter().map(slots).sum()
    }

    fn run(&self, uniforms: &[T], inputs: &[Packet<T>], outputs: &mut [Packet<T>]) {
        let (i, o) = (Kernel::<T>::input_slots(self), Kernel::<T>::output_slots(self));
        assert_eq!(uniforms.len(), self.width() * self.uniforms, "the numbers of all uniforms");
        assert_eq!(inputs.len() * o, outputs.len() * i, "as many output groups as input groups");
        assert!(inputs.len().is_multiple_of(i.max(1)) && outputs.len().is_multiple_of(o.max(1)), "whole groups");
        for group in 0..outputs.len() / o.max(1) {
            let inputs = &inputs[group * i..(group + 1) * i];
            let outputs = &mut outputs[group * o..(group + 1) * o];
            for lane in 0..T::LANES {
                match self.arithmetic {
                    Arithmetic::Point => self.run_points(lane, uniforms, inputs, outputs),
                    Arithmetic::Interval | Arithmetic::Affine => self.run_boxes(lane, uniforms, inputs, outputs),
                }
            }
        }
    }
}

/// The enclosures of all nodes on the part of one box that lies in the domain.
struct Enclosed {
    values: Vec<Decorated>,
    /// The box is proved to lie outside the domain.
    outside: bool,
    /// The box is proved to lie inside the domain.
    inside: bool,
}

impl Enclosed {
    /// Leaves the part of the box on which the value lies in what is known of it.
    fn restrict(&mut self, value: Value, known: Option<Interval>) {
        let Some(known) = known else { return };
        let before = self.values[value.index()];
        let after = before.interval().intersect(known);
        self.outside |= after.is_empty();
        // A point at which the value is undefined does not lie in the domain either.
        self.inside &= known.contains_interval(before.interval()) && before.decoration() >= Decoration::Def;
        self.values[value.index()] = Decorated::with(after, before.decoration());
    }

    /// What is enclosed and proved of a value.
    fn output(&self, value: Value) -> (Interval, u32) {
        let enclosure = self.values[value.index()];
        let interval = enclosure.interval();
        if self.outside || interval.is_empty() {
            return (Interval::EMPTY, verdict::EMPTY);
        }
        let mut bits = 0;
        if interval.lo() > 0.0 {
            bits |= verdict::POSITIVE;
        }
        if interval.hi() < 0.0 {
            bits |= verdict::NEGATIVE;
        }
        if self.inside && enclosure.decoration() >= Decoration::Dac {
            bits |= verdict::CONTINUOUS;
        }
        (interval, bits)
    }
}

fn source(spec: &Spec, name: &str) -> Result<Source, Diagnostic> {
    let position = |names: &[String]| names.iter().position(|n| n == name);
    match (position(&spec.inputs), position(&spec.uniforms)) {
        (Some(i), _) => Ok(Source::Lane(i)),
        (None, Some(i)) => Ok(Source::Uniform(i)),
        (None, None) => Err(Diagnostic::error(code::INTERNAL, format!("the program has no input {name}"))),
    }
}

/// The set that two ends stand for. A NaN end is the infinite one; an end that overflowed inwards, [inf, inf], still
/// stands for some number that large; crossed ends hold nothing.
fn input_interval<T: Real>(negated_lo: T, hi: T) -> Interval {
    let (lo, hi) = (-negated_lo.to_f64(), hi.to_f64());
    let largest = T::down(f64::MAX).to_f64();
    let lo = if lo.is_nan() { f64::NEG_INFINITY } else { lo };
    let hi = if hi.is_nan() { f64::INFINITY } else { hi };
    if lo > hi {
        return Interval::EMPTY;
    }
    Interval::new(lo.min(largest), hi.max(-largest)).unwrap_or(Interval::EMPTY)
}
