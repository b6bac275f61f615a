//! Functions with their gradients on many boxes at once, by compiled kernels.
//!
//! Formulas of one shape that differ in their constants alone, such as a thousand random lines, share one kernel: it takes
//! the constants as inputs of each lane.

use std::collections::HashMap;
use std::sync::Arc;

use num_rational::BigRational;
use num_traits::Zero;
use rayon::prelude::*;

use crate::derive;
use crate::derive::Arithmetic;
use crate::derive::Output;
use crate::derive::Rounding;
use crate::derive::Spec;
use crate::diagnostic::Diagnostic;
use crate::graph::Graph;
use crate::graph::Op;
use crate::graph::Totality;
use crate::graph::Value;
use crate::interval::Interval;
use crate::kernel::Backend;
use crate::kernel::Kernel;
use crate::kernel::Packet;
use crate::kernel::Real;
use crate::kernel::verdict;
use crate::passes;
use crate::program::scene::COORDINATES;
use crate::program::scene::Parameter;

/// An index into the functions of [`crate::arrange::Fields`].
pub type Function = u32;

/// How many functions of one shape are worth a kernel that takes their constants as inputs.
const FAMILY: usize = 8;

/// Packets that one call fills, and one worker takes at a time.
const GROUPS: usize = 16;

/// A function on a box: enclosures of its value and of its partial derivatives, and the verdict bits of the value
/// ([`crate::kernel::verdict`]). The derivatives say something only where the value is proved `CONTINUOUS`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    pub value: Interval,
    pub slope: [Interval; 2],
    pub bits: u32,
}

/// A bit of [`Sample::bits`] beside those of [`crate::kernel::verdict`]: the function is proved defined on all of the box,
/// continuous or not. A truth value jumps, so that this is all that can be known of one.
pub const DEFINED: u32 = 1 << 16;

impl Sample {
    /// Whether the function is proved defined on all of the box.
    pub fn is_defined(&self) -> bool {
        self.bits & (verdict::CONTINUOUS | DEFINED) != 0
    }

    /// Whether the function is proved to have no zero on the box.
    pub fn is_refuted(&self) -> bool {
        self.bits & verdict::REFUTED != 0
    }

    /// Whether it is proved defined and continuous on all of the box.
    pub fn is_continuous(&self) -> bool {
        self.bits & verdict::CONTINUOUS != 0
    }
}

/// One kernel and the places of what it needs.
struct Program {
    kernel: Arc<dyn Kernel<f64>>,
    uniforms: Vec<f64>,
    inputs: usize,
    /// Whether the value, and each derivative, is defined everywhere, kinks and jumps included, which are enclosed by hulls. Increments of the
    /// function are enclosed by derivative times step only where the derivative is defined (contract 7).
    total: [bool; 3],
}

/// Which program computes a function, on which constants.
struct Binding {
    program: u32,
    constants: Vec<Interval>,
}

/// A set of functions of x and y, compiled.
pub struct Functions {
    programs: Vec<Program>,
    bindings: Vec<Binding>,
}

/// A function on its own: a graph of x, y and the parameters, with the constants taken out.
struct Template {
    graph: Graph,
    root: Value,
    constants: Vec<BigRational>,
    key: Key,
}

/// What formulas of one shape have in common: operations, operands, and the names of inputs.
type Key = Vec<(Op, Vec<Value>, Option<String>)>;

impl Functions {
    /// Compiles `roots`, values of `graph`, for boxes inside `domain` and the parameters as they are.
    ///
    /// # Errors
    /// If the backend fails.
    pub fn new(
        graph: &Graph,
        roots: &[Value],
        domain: [Interval; 2],
        parameters: &[Parameter],
        backend: &dyn Backend,
    ) -> Result<Self, Diagnostic> {
        let templates: Vec<Template> = roots.iter().map(|&root| template(graph, root)).collect();
        let mut families: HashMap<&Key, Vec<usize>> = HashMap::new();
        for (index, template) in templates.iter().enumerate() {
            families.entry(&template.key).or_default().push(index);
        }
        let mut programs = Vec::new();
        let mut bindings: Vec<Option<Binding>> = templates.iter().map(|_| None).collect();
        let mut orders = Vec::new();
        for (index, template) in templates.iter().enumerate() {
            let members = &families[&template.key];
            if members.len() < FAMILY {
                let mut own = Graph::new();
                let root = own.import(graph, &[roots[index]], &HashMap::new())[0];
                orders.push((own, root, Vec::new(), vec![index]));
            } else if members[0] == index {
                let ranges = (0..template.constants.len()).map(|slot| {
                    let values = members.iter().map(|&m| Interval::from_rational(&templates[m].constants[slot]));
                    values.fold(Interval::EMPTY, Interval::hull)
                });
                orders.push((template.graph.clone(), template.root, ranges.collect(), members.clone()));
            }
        }
        let compiled: Vec<Result<Program, Diagnostic>> = orders
            .par_iter()
            .map(|(graph, root, ranges, _)| compile(graph, *root, ranges, domain, parameters, backend))
            .collect();
        for ((_, _, ranges, members), program) in orders.iter().zip(compiled) {
            programs.push(program?);
            for &member in members {
                let constants = templates[member].constants.iter().take(ranges.len()).map(Interval::from_rational);
                bindings[member] = Some(Binding { program: programs.len() as u32 - 1, constants: constants.collect() });
            }
        }
        Ok(Self { programs, bindings: bindings.into_iter().flatten().collect() })
    }

    /// Samples of functions on boxes, in the order asked. A point is a box of width 0.
    pub fn evaluate(&self, queries: &[(Function, [Interval; 2])]) -> Vec<Sample> {
        let mut order: Vec<u32> = (0..queries.len() as u32).collect();
        // Stable, so that neighbours stay together.
        order.sort_by_key(|&index| self.bindings[queries[index as usize].0 as usize].program);
        let mut tasks: Vec<(u32, &[u32])> = Vec::new();
        for stretch in order.chunk_by(|&a, &b| self.program(queries, a) == self.program(queries, b)) {
            let program = self.program(queries, stretch[0]);
            tasks.extend(stretch.chunks(GROUPS * <f64 as Real>::LANES).map(|chunk| (program, chunk)));
        }
        let run = |&(program, chunk): &(u32, &[u32])| self.run(&self.programs[program as usize], queries, chunk);
        let found: Vec<Vec<Sample>> = match tasks.len() {
            0..4 => tasks.iter().map(run).collect(),
            _ => tasks.par_iter().map(run).collect(),
        };
        let nothing = Sample { value: Interval::ENTIRE, slope: [Interval::ENTIRE; 2], bits: 0 };
        let mut samples = vec![nothing; queries.len()];
        for ((_, chunk), found) in tasks.iter().zip(found) {
            for (&index, sample) in chunk.iter().zip(found) {
                samples[index as usize] = sample;
            }
        }
        samples
    }

    fn program(&self, queries: &[(Function, [Interval; 2])], index: u32) -> u32 {
        self.bindings[queries[index as usize].0 as usize].program
    }

    fn run(&self, program: &Program, queries: &[(Function, [Interval; 2])], chunk: &[u32]) -> Vec<Sample> {
        const LANES: usize = <f64 as Real>::LANES;
        const OUTPUTS: usize = 9;
        let groups = chunk.len().div_ceil(LANES);
        let slots = 2 * program.inputs;
        let mut inputs = vec![Packet::<f64>::splat(0.0); groups * slots];
        let mut outputs = vec![Packet::<f64>::splat(0.0); groups * OUTPUTS];
        for lane in 0..groups * LANES {
            // The last lane fills up its packet.
            let (function, area) = queries[chunk[lane.min(chunk.len() - 1)] as usize];
            let constants = &self.bindings[function as usize].constants;
            for (input, range) in area.iter().chain(constants).enumerate() {
                let packet = lane / LANES * slots + 2 * input;
                inputs[packet].lanes_mut()[lane % LANES] = -range.lo();
                inputs[packet + 1].lanes_mut()[lane % LANES] = range.hi();
            }
        }
        program.kernel.run(&program.uniforms, &inputs, &mut outputs);
        let get = |lane: usize, slot: usize| outputs[lane / LANES * OUTPUTS + slot].lanes()[lane % LANES];
        let enclosure = |lane: usize, output: usize| {
            let bits = get(lane, 3 * output + 2).verdict();
            let ends = Interval::new(-get(lane, 3 * output), get(lane, 3 * output + 1));
            let range = if bits & verdict::EMPTY != 0 { Interval::EMPTY } else { ends.unwrap_or(Interval::ENTIRE) };
            (range, bits)
        };
        (0..chunk.len())
            .map(|lane| {
                let (value, mut bits) = enclosure(lane, 0);
                bits |= if program.total[0] { DEFINED } else { 0 };
                let slope = [1, 2].map(|output| {
                    let (range, bits) = enclosure(lane, output);
                    let whole = bits & verdict::CONTINUOUS != 0 || program.total[output] && !range.is_empty();
                    if whole { range } else { Interval::ENTIRE }
                });
                Sample { value, slope, bits }
            })
            .collect()
    }
}

/// The name of the input for a constant: none that a parameter can have.
fn slot(number: usize) -> String {
    format!("#{number}")
}

/// The function of x, y and the parameters whose constants are inputs, in the order of the graph.
fn template(source: &Graph, root: Value) -> Template {
    let mut own = Graph::new();
    let root = own.import(source, &[root], &HashMap::new())[0];
    let mut graph = Graph::new();
    for name in &COORDINATES[..2] {
        graph.var(name);
    }
    let mut constants = Vec::new();
    let mut image: Vec<Value> = Vec::new();
    let mut key = Vec::new();
    for (value, node) in own.iter() {
        let operands: Vec<Value> = node.operands().iter().map(|v| image[v.index()]).collect();
        let new = match node.op {
            Op::Const(_) => {
                constants.extend(own.as_constant(value).cloned());
                graph.var(&slot(constants.len() - 1))
            }
            Op::Var(id) => graph.var(&own.variables()[id as usize]),
            op => graph.push(op, &operands),
        };
        // Numbers of constants and inputs are those of the formula alone; what counts is which input it is.
        let (op, name) = match node.op {
            Op::Const(_) => (Op::Const(constants.len() as u32 - 1), None),
            Op::Var(id) => (Op::Var(0), Some(own.variables()[id as usize].clone())),
            op => (op, None),
        };
        key.push((op, operands, name));
        image.push(new);
    }
    key.push((Op::Pi, vec![image[root.index()]], None));
    Template { graph, root: image[root.index()], constants, key }
}

fn compile(
    graph: &Graph,
    root: Value,
    constants: &[Interval],
    domain: [Interval; 2],
    parameters: &[Parameter],
    backend: &dyn Backend,
) -> Result<Program, Diagnostic> {
    let mut graph = graph.clone();
    let mut promises: Vec<(String, Interval)> = Vec::new();
    let coordinates = [0, 1].map(|axis| graph.var(COORDINATES[axis]));
    let slopes = derive::gradient(&mut graph, root, &coordinates);
    for (name, value) in ["value", "x", "y"].iter().zip([root, slopes[0], slopes[1]]) {
        graph.add_output(*name, value);
    }
    let mut inputs: Vec<String> = COORDINATES[..2].iter().map(|name| (*name).to_owned()).collect();
    promises.extend(inputs.iter().cloned().zip(domain));
    for (number, range) in constants.iter().enumerate() {
        inputs.push(slot(number));
        promises.push((slot(number), *range));
    }
    promises.extend(parameters.iter().map(|parameter| (parameter.name.clone(), parameter.value)));
    let range = |name: &String| promises.iter().find(|(n, _)| n == name).map_or(Interval::ENTIRE, |&(_, range)| range);
    let ranges: Vec<Interval> = graph.variables().iter().map(range).collect();
    let (graph, _) = passes::run(&graph, &ranges);
    let total = [0, 1, 2].map(|output| is_total(&graph, graph.outputs()[output].1));
    let uniforms: Vec<String> = graph.variables().iter().filter(|name| !inputs.contains(name)).cloned().collect();
    let values = uniforms.iter().flat_map(|name| {
        let value = range(name);
        [-value.lo(), value.hi()]
    });
    let values = values.collect();
    let outputs = graph.outputs().iter().map(|&(_, value)| Output::Enclosure(value)).collect();
    let inputs_count = inputs.len();
    let spec = Spec {
        graph: Arc::new(graph),
        inputs,
        uniforms,
        outputs,
        domain: Vec::new(),
        promises,
        arithmetic: Arithmetic::Interval,
        symbols: Vec::new(),
        rounding: Rounding::Outward,
    };
    Ok(Program { kernel: backend.compile_f64(&spec)?, uniforms: values, inputs: inputs_count, total })
}

/// Whether no operation of the value can be undefined.
fn is_total(graph: &Graph, value: Value) -> bool {
    let needed = graph.reachable(&[value]);
    graph.iter().filter(|(v, _)| needed[v.index()]).all(|(_, node)| match (node.op, node.op.totality()) {
        (Op::Div, _) => graph.as_constant(node.operands()[1]).is_some_and(|divisor| !divisor.is_zero()),
        (_, Totality::Continuous | Totality::Jumps) => true,
        (_, Totality::Partial | Totality::PartialJumps) => false,
    })
}
