//! The kernel of the solvers: eight parts of the unknown's interval in one packet, each with a point inside about which the
//! function is expanded.

use std::collections::HashMap;
use std::sync::Arc;

use crate::derive::Arithmetic;
use crate::derive::Output;
use crate::derive::Rounding;
use crate::derive::Spec;
use crate::diagnostic::Diagnostic;
use crate::graph::Value;
use crate::interval::Interval;
use crate::kernel::Backend;
use crate::kernel::Kernel;
use crate::kernel::Packet;
use crate::kernel::Real;
use crate::kernel::verdict;
use crate::limits::Budget;
use crate::passes;
use crate::roots::problem::Problem;

/// Lanes of one packet.
pub const LANES: usize = <f64 as Real>::LANES;
/// Packets of one call.
const GROUPS: usize = 4;
/// Lanes of one call.
pub const CAPACITY: usize = GROUPS * LANES;

/// Two slots each for a part of the interval and for the point inside.
const INPUT_SLOTS: usize = 4;
/// The point inside, as an input of the graph; no name of the language has a point.
const CENTRE: &str = "roots.centre";

/// Output slots, in the order in which [`Compiled::new`] asks for them; from `FACTORS` on one slot a factor.
const F: usize = 0;
const SLOPE: usize = 1;
const MIDDLE: usize = 2;
const NEWTON: usize = 5;
const CENTRED: usize = 8;
const FACTORS: usize = 9;

/// The kernel, and what it costs.
pub struct Compiled {
    kernel: Arc<dyn Kernel<f64>>,
    output_slots: usize,
    /// Nodes of its graph.
    pub operations: usize,
}

impl Compiled {
    /// `bounds` are promises about inputs.
    ///
    /// # Errors
    /// What the backend says of the program; if the budget is exceeded.
    pub fn new(
        problem: &Problem,
        bounds: &[(&str, Interval)],
        backend: &dyn Backend,
        budget: &Budget,
    ) -> Result<Self, Diagnostic> {
        let mut graph = problem.graph.clone();
        let names = graph.variables().to_vec();
        let unknown = &names[problem.variable];
        let (x, middle) = (graph.var(unknown), graph.var(CENTRE));
        let at_middle = graph.substitute(&[problem.f], &HashMap::from([(x, middle)]))[0];
        // Newton: 0 = f(root) is in f(m) + slope (root - m), so the root is in m - f(m) / slope.
        let step = graph.div(at_middle, problem.slope);
        let newton = graph.sub(middle, step);
        // The mean-value form.
        let distance = graph.sub(x, middle);
        let change = graph.mul(problem.slope, distance);
        let centred = graph.add(at_middle, change);
        // Outputs of the graph's own come first.
        let others = graph.outputs().len();
        let wanted = [problem.f, problem.slope, at_middle, newton, centred];
        for (index, &value) in wanted.iter().chain(&problem.factors).enumerate() {
            graph.add_output(index.to_string(), value);
        }

        let bound = |name: &str| bounds.iter().find(|(n, _)| *n == name).map(|&(_, range)| range);
        // The point lies in the part.
        let promise = |name: &String| bound(if name == CENTRE { unknown } else { name });
        let known: Vec<Option<Interval>> = graph.variables().iter().map(promise).collect();
        let ranges: Vec<Interval> = known.iter().map(|range| range.unwrap_or(Interval::ENTIRE)).collect();
        budget.nodes(graph.len())?;
        let (graph, _) = passes::run_within(&graph, &ranges, budget)?;
        let promises = graph.variables().iter().cloned().zip(known).filter_map(|(name, range)| Some((name, range?)));
        let promises = promises.collect();
        let results: Vec<Value> = graph.outputs()[others..].iter().map(|&(_, value)| value).collect();
        let mut outputs = vec![
            Output::Verdict(results[0]),
            Output::Verdict(results[1]),
            Output::Enclosure(results[2]),
            Output::Enclosure(results[3]),
            Output::Refutation(results[4]),
        ];
        outputs.extend(results[5..].iter().map(|&factor| Output::Refutation(factor)));
        let operations = graph.len();
        let spec = Spec {
            graph: Arc::new(graph),
            inputs: vec![unknown.clone(), CENTRE.to_owned()],
            uniforms: names.iter().filter(|name| *name != unknown).cloned().collect(),
            outputs,
            domain: Vec::new(),
            promises,
            arithmetic: Arithmetic::Interval,
            symbols: Vec::new(),
            rounding: Rounding::Outward,
        };
        let kernel = backend.compile_f64(&spec)?;
        Ok(Self { output_slots: kernel.output_slots(), kernel, operations })
    }
}

/// The packets of one search.
pub struct Batch<'a> {
    compiled: &'a Compiled,
    uniforms: Vec<f64>,
    inputs: Vec<Packet<f64>>,
    outputs: Vec<Packet<f64>>,
}

impl<'a> Batch<'a> {
    /// `uniforms` are the inputs but for the unknown, in the graph's order.
    pub fn new(compiled: &'a Compiled, uniforms: impl Iterator<Item = Interval>) -> Self {
        let uniforms = uniforms.flat_map(|range| [-range.lo(), range.hi()]).collect();
        Self { compiled, uniforms, inputs: Vec::new(), outputs: Vec::new() }
    }

    /// Writes a part of the unknown's interval and a point inside to a lane.
    pub fn set(&mut self, lane: usize, x: Interval, middle: f64) {
        let first = lane / LANES * INPUT_SLOTS;
        if self.inputs.len() <= first {
            self.inputs.resize(first + INPUT_SLOTS, Packet::default());
            self.outputs.resize((lane / LANES + 1) * self.compiled.output_slots, Packet::default());
        }
        for (slot, number) in [-x.lo(), x.hi(), -middle, middle].into_iter().enumerate() {
            self.inputs[first + slot].lanes_mut()[lane % LANES] = number;
        }
    }

    /// Evaluates the first lanes, at least one.
    pub fn run(&mut self, lanes: usize) {
        let groups = lanes.div_ceil(LANES);
        // Lanes that nobody asked for answer what the last one is asked, so that no leftovers slow the others down.
        let last = &mut self.inputs[(groups - 1) * INPUT_SLOTS..groups * INPUT_SLOTS];
        for packet in last {
            let filled = (lanes - 1) % LANES + 1;
            let number = packet.lanes()[filled - 1];
            packet.lanes_mut()[filled..].fill(number);
        }
        self.compiled.kernel.run(
            &self.uniforms,
            &self.inputs[..groups * INPUT_SLOTS],
            &mut self.outputs[..groups * self.compiled.output_slots],
        );
    }

    /// What the kernel says of one lane.
    pub fn answer(&self, lane: usize) -> Answer {
        let slots = self.compiled.output_slots;
        let slots = &self.outputs[lane / LANES * slots..][..slots];
        let number = |slot: usize| slots[slot].lanes()[lane % LANES];
        let bits = |slot: usize| number(slot).verdict();
        let factors = (FACTORS..slots.len()).any(|slot| bits(slot) & verdict::REFUTED != 0);
        let smooth = bits(F) & bits(SLOPE) & verdict::CONTINUOUS != 0;
        let steep = bits(SLOPE) & (verdict::POSITIVE | verdict::NEGATIVE) != 0;
        let enclosure = |slot: usize| Interval::new(-number(slot), number(slot + 1));
        Answer {
            refuted: factors || bits(F) & verdict::REFUTED != 0 || smooth && bits(CENTRED) & verdict::REFUTED != 0,
            monotone: smooth && steep,
            newton: if smooth && steep { enclosure(NEWTON) } else { None },
            sign: match bits(F) {
                f if f & verdict::CONTINUOUS == 0 => None,
                f if f & verdict::POSITIVE != 0 => Some(1),
                f if f & verdict::NEGATIVE != 0 => Some(-1),
                _ => None,
            },
            zero: bits(MIDDLE + 2) & verdict::CONTINUOUS != 0 && enclosure(MIDDLE) == Some(Interval::ZERO),
        }
    }
}

/// What is proved of one part.
#[derive(Debug, Clone, Copy)]
pub struct Answer {
    /// There is no zero in it.
    pub refuted: bool,
    /// The function is defined and continuous on it, and its slope has one sign.
    pub monotone: bool,
    /// Where a zero must lie, if the function is monotone; `None` says nothing.
    pub newton: Option<Interval>,
    /// The sign of the function if it is defined and of one sign on the part: 1 or -1.
    pub sign: Option<i32>,
    /// The function is defined and exactly 0 at the point inside.
    pub zero: bool,
}
