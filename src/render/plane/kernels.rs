//! The kernels that settle single pixels, with the packets that one worker feeds them.

use crate::derive::Precision;
use crate::derive::Spec;
use crate::diagnostic::Diagnostic;
use crate::graph::Graph;
use crate::graph::Op;
use crate::graph::apply;
use crate::interval::Decorated;
use crate::interval::Interval;
use crate::kernel::Backend;
use crate::kernel::verdict;
use crate::program::scene::COORDINATES;
use crate::program::scene::Parameter;
use crate::program::scene::Shape;
use crate::render::batch::Batch;
use crate::render::batch::Program;
use crate::render::march::GROUPS;
use crate::render::plan::Plan;
use crate::render::plane::jumps::step_name;
use crate::render::plane::system::EQUATIONS;
use crate::render::plane::system::ShapeSpecs;
use crate::render::programs::Compiled;

/// Step functions that one box can be told apart by.
pub const STEPS: usize = 8;

/// Values that step functions can take together on one box, beyond which nothing is said of it.
const CASES: usize = 16;

/// A shape's compiled systems.
pub struct Kernels {
    steps: Option<Compiled<f64>>,
    /// For each step function, whether it is defined everywhere.
    total: Vec<bool>,
    systems: Vec<SystemKernel>,
}

struct SystemKernel {
    compiled: Compiled<f64>,
    equations: usize,
    condition: bool,
    total: Vec<[bool; 2]>,
    formulas: Graph,
}

impl Kernels {
    /// Compiles them.
    ///
    /// # Errors
    /// If the backend fails.
    pub fn new(specs: ShapeSpecs, shape: &Shape, plan: &mut Plan, backend: &dyn Backend) -> Result<Self, Diagnostic> {
        let double = Precision::Double;
        let compiled = |spec: Spec| Compiled::new(backend, &spec).map(|kernel| (spec, kernel));
        let total = specs.steps.as_ref().map(|steps| steps.1.clone()).unwrap_or_default();
        let steps = match specs.steps {
            Some((spec, _)) => {
                let kernel = compiled(spec)?;
                Some(plan.kernel(shape, "steps", double, kernel, "tells the branches of step functions apart"))
            }
            None => None,
        };
        let mut systems = Vec::new();
        for system in specs.systems {
            let kernel = compiled(system.spec)?;
            let compiled = plan.kernel(shape, "piece", double, kernel, "settles what stays open of pixels");
            let (equations, condition) = (system.equations, system.condition);
            let (total, formulas) = (system.total, system.formulas);
            systems.push(SystemKernel { compiled, equations, condition, total, formulas });
        }
        Ok(Self { steps, total, systems })
    }

    /// The kernels on values of the parameters.
    pub fn bind(&self, parameters: &[Parameter]) -> Bound<'_> {
        let systems = self.systems.iter().map(|system| {
            let inputs = system.formulas.variables().iter().map(|name| {
                let step = (0..STEPS).find(|&step| *name == step_name(step));
                match (COORDINATES.iter().position(|coordinate| coordinate == name), step) {
                    (Some(axis), _) => Input::Coordinate(axis),
                    (None, Some(step)) => Input::Step(step),
                    (None, None) => {
                        let parameter = parameters.iter().find(|parameter| parameter.name == *name);
                        Input::Fixed(parameter.map_or(Interval::ENTIRE, |parameter| parameter.value))
                    }
                }
            });
            BoundSystem { kernel: system, program: system.compiled.bind(parameters, &[]), inputs: inputs.collect() }
        });
        let systems = systems.collect();
        Bound { steps: self.steps.as_ref().map(|steps| steps.bind(parameters, &[])), total: &self.total, systems }
    }
}

/// A shape's kernels on values of the parameters.
pub struct Bound<'a> {
    steps: Option<Program<f64>>,
    total: &'a [bool],
    systems: Vec<BoundSystem<'a>>,
}

struct BoundSystem<'a> {
    kernel: &'a SystemKernel,
    program: Program<f64>,
    inputs: Vec<Input>,
}

/// What an input of a formula stands for.
#[derive(Debug, Clone, Copy)]
enum Input {
    Coordinate(usize),
    Step(usize),
    Fixed(Interval),
}

impl<'a> Bound<'a> {
    /// How many systems there are.
    pub fn len(&self) -> usize {
        self.systems.len()
    }

    /// What one worker needs for one system.
    pub fn evaluator(&self, system: usize) -> Evaluator<'_> {
        let BoundSystem { kernel, program, inputs } = &self.systems[system];
        Evaluator {
            steps: self.steps.as_ref().map(|steps| Batch::new(steps, GROUPS)),
            total: self.total,
            batch: Batch::new(program, GROUPS),
            kernel,
            inputs,
            exact: 0,
        }
    }
}

/// A box, and the values of the step functions that are assumed there.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    pub area: [Interval; 2],
    pub steps: [f64; STEPS],
    /// Whether the step functions are proved to have those values on all of the box.
    pub exact: bool,
    /// Whether they are proved to be defined on all of it.
    pub defined: bool,
}

impl Case {
    /// A box on which there is no step function.
    pub fn of(area: [Interval; 2]) -> Self {
        Self { area, steps: [0.0; STEPS], exact: true, defined: true }
    }
}

/// What is known of an equation's left side on a box.
#[derive(Debug, Clone, Copy)]
pub struct Estimate {
    pub value: Interval,
    /// The whole line where increments are not known to be enclosed by derivative times step.
    pub slope: [Interval; 2],
    pub bits: u32,
}

impl Estimate {
    const UNKNOWN: Self = Self { value: Interval::ENTIRE, slope: [Interval::ENTIRE; 2], bits: 0 };
}

/// What is known of a system on a box.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    estimates: [Estimate; EQUATIONS],
    equations: usize,
    /// The verdict of the condition.
    pub condition: u32,
}

impl Sample {
    pub fn estimates(&self) -> &[Estimate] {
        &self.estimates[..self.equations]
    }
}

/// The kernels of one system with their packets.
pub struct Evaluator<'a> {
    steps: Option<Batch<f64>>,
    total: &'a [bool],
    batch: Batch<f64>,
    kernel: &'a SystemKernel,
    inputs: &'a [Input],
    /// Evaluations without a kernel.
    exact: u64,
}

impl Evaluator<'_> {
    pub fn evaluations(&self) -> u64 {
        self.exact + self.batch.evaluations + self.steps.as_ref().map_or(0, |steps| steps.evaluations)
    }

    /// For each box the cases in which the step functions can be there: none if some step function is undefined on all of
    /// it, `None` if there are too many.
    pub fn cases(&mut self, areas: &[[Interval; 2]]) -> Vec<Option<Vec<Case>>> {
        let Some(batch) = &mut self.steps else {
            let whole = |&area: &[Interval; 2]| Some(vec![Case::of(area)]);
            return areas.iter().map(whole).collect();
        };
        let mut cases = Vec::with_capacity(areas.len());
        for areas in areas.chunks(batch.capacity()) {
            for (lane, area) in areas.iter().enumerate() {
                for (axis, side) in area.iter().enumerate() {
                    batch.set_range(lane, axis, side.lo(), side.hi());
                }
            }
            batch.run(areas.len());
            let total = &self.total;
            for (lane, &area) in areas.iter().enumerate() {
                let mut found = Some(vec![Case::of(area)]);
                for step in 0..total.len() {
                    let bits = batch.bits(lane, 3 * step + 2);
                    let (lo, hi) = (-batch.get(lane, 3 * step), batch.get(lane, 3 * step + 1));
                    if bits & verdict::EMPTY != 0 {
                        found = Some(Vec::new());
                        break;
                    }
                    let count = hi - lo + 1.0;
                    // Also if the ends are no numbers.
                    if !(count >= 1.0 && count <= CASES as f64) {
                        found = None;
                    }
                    let Some(known) = found.take() else { continue };
                    if known.len() * count as usize > CASES {
                        continue;
                    }
                    let decided = count == 1.0 && bits & verdict::CONTINUOUS != 0;
                    let with = |case: Case, value: f64| {
                        let mut case = case;
                        case.steps[step] = value;
                        case.exact &= decided;
                        case.defined &= decided || total[step];
                        case
                    };
                    let values = (0..count as usize).map(|index| lo + index as f64);
                    found = Some(values.flat_map(|value| known.iter().map(move |&case| with(case, value))).collect());
                }
                cases.push(found);
            }
        }
        cases
    }

    /// Encloses the system on boxes.
    pub fn samples(&mut self, cases: impl ExactSizeIterator<Item = Case>) -> Vec<Sample> {
        let mut samples = Vec::with_capacity(cases.len());
        let steps = self.batch.input_slots() / 2 - 2;
        let mut lanes = 0;
        let mut cases = cases.peekable();
        while let Some(case) = cases.next() {
            for (axis, side) in case.area.iter().enumerate() {
                self.batch.set_range(lanes, axis, side.lo(), side.hi());
            }
            for (step, &value) in case.steps[..steps].iter().enumerate() {
                self.batch.set_range(lanes, 2 + step, value, value);
            }
            lanes += 1;
            if lanes == self.batch.capacity() || cases.peek().is_none() {
                self.batch.run(lanes);
                samples.extend((0..lanes).map(|lane| self.sample(lane)));
                lanes = 0;
            }
        }
        samples
    }

    /// Encloses an equation's left side at a point by the interval library, which is slow and knows sines of numbers for which
    /// the kernels' reduction is not exact.
    /// The derivatives are asked for in vain of points at which they are not defined.
    pub fn enclose(&mut self, equation: usize, case: &Case, derivatives: bool) -> (Interval, [f64; 2]) {
        self.exact += 1;
        let SystemKernel { formulas, equations, .. } = self.kernel;
        let place = |output: usize| formulas.outputs()[output].1.index();
        let slopes = [0, 1].map(|axis| place(equations + 2 * equation + axis));
        // Derivatives come after all values.
        let last = if derivatives { slopes[0].max(slopes[1]).max(place(equation)) } else { place(equation) };
        let mut values: Vec<Decorated> = Vec::with_capacity(last + 1);
        for (_, node) in formulas.iter().take(last + 1) {
            let operands: Vec<Decorated> = node.operands().iter().map(|value| values[value.index()]).collect();
            values.push(match node.op {
                Op::Var(id) => Decorated::new(match self.inputs[id as usize] {
                    Input::Coordinate(axis) => case.area[axis],
                    Input::Step(step) => Interval::point(case.steps[step]),
                    Input::Fixed(value) => value,
                }),
                _ => apply(formulas, node, &operands),
            });
        }
        let slope = slopes.map(|index| values.get(index).map_or(0.0, |slope| slope.interval().mid()));
        (values[place(equation)].interval(), slope)
    }

    fn sample(&self, lane: usize) -> Sample {
        let enclosure = |output: usize| {
            let bits = self.batch.bits(lane, 3 * output + 2);
            let ends = Interval::new(-self.batch.get(lane, 3 * output), self.batch.get(lane, 3 * output + 1));
            let value = if bits & verdict::EMPTY != 0 { Interval::EMPTY } else { ends.unwrap_or(Interval::ENTIRE) };
            (value, bits)
        };
        let SystemKernel { equations, condition, total, .. } = self.kernel;
        let mut estimates = [Estimate::UNKNOWN; EQUATIONS];
        for (index, (estimate, total)) in estimates.iter_mut().zip(total).enumerate() {
            let (value, bits) = enclosure(3 * index);
            let slope = [0, 1].map(|axis| {
                let (slope, bits) = enclosure(3 * index + 1 + axis);
                let whole = bits & verdict::CONTINUOUS != 0 || total[axis] && !slope.is_empty();
                if whole { slope } else { Interval::ENTIRE }
            });
            *estimate = Estimate { value, slope, bits };
        }
        let condition =
            if *condition { self.batch.bits(lane, 9 * equations) } else { verdict::POSITIVE | verdict::CONTINUOUS };
        Sample { estimates, equations: *equations, condition }
    }
}
