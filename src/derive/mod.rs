//! Graph to graph and graph to lanes: gradients, points along rays, interval and affine versions, the
//! extensions of a formula to boxes, and the kernel's ABI.

mod affine;
mod choice;
mod cost;
mod elementary;
mod ends;
mod extension;
mod gradient;
mod interval;
pub mod lanes;
mod magnitude;
mod point;
mod ray;

use std::collections::HashMap;
use std::sync::Arc;

use crate::graph::Graph;
use crate::graph::Value;
use crate::interval::Interval;
use crate::limits::Budget;
use crate::limits::Exceeded;
use crate::limits::Limits;
use crate::passes::bounds;

pub use choice::Choice;
pub use choice::Work;
pub use choice::choose;
pub use extension::Extension;
pub use extension::Formula;
pub use extension::Symbols;
pub use extension::UnknownExtension;
pub use gradient::derivative;
pub use gradient::derivative_within;
pub use gradient::gradient;
pub use gradient::gradient_within;
pub use gradient::power_ratio;
pub use lanes::LaneProgram;
pub use ray::DIRECTION;
pub use ray::ORIGIN;
pub use ray::PARAMETER;
pub use ray::RayGraph;
pub use ray::along_line;
pub use ray::along_ray;
pub use ray::centred;

/// The format in which a kernel computes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Precision {
    Single,
    Double,
}

/// What a program computes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Arithmetic {
    /// Points: rounded to nearest, nothing proved.
    Point,
    /// The natural interval extension.
    Interval,
    /// AF1 forms intersected with the natural extension: one noise symbol per input of [`Spec::symbols`].
    Affine,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Rounding {
    /// Every enclosure holds.
    Outward,
    /// Every operation rounded to nearest, as the source papers did it: enclosures may fail, nothing is proved.
    Nearest,
}

/// One result of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Output {
    /// The value at points ([`Arithmetic::Point`] only): one slot.
    Value(Value),
    /// Enclosure and verdict: three slots.
    Enclosure(Value),
    /// Verdict bits alone (`kernel::verdict`): one slot.
    Verdict(Value),
    /// The verdict bits that can refute a zero, `POSITIVE`, `NEGATIVE` and `EMPTY`, the last only where the value is
    /// undefined and not for boxes outside the domain: one slot, and cheaper than a verdict.
    Refutation(Value),
}

impl Output {
    pub fn value(self) -> Value {
        match self {
            Output::Value(value) | Output::Enclosure(value) | Output::Verdict(value) | Output::Refutation(value) => {
                value
            }
        }
    }
}

/// An order for a kernel.
#[derive(Debug, Clone)]
pub struct Spec {
    pub graph: Arc<Graph>,
    /// Lane inputs, in slot order, by the name of a graph input.
    pub inputs: Vec<String>,
    /// Uniform inputs (parameters), in order; every graph input is in one of the two lists.
    pub uniforms: Vec<String>,
    pub outputs: Vec<Output>,
    /// What is known of values beforehand: each listed value is intersected with its interval, and where the
    /// intersection is empty the box lies outside the domain. A scene lists its coordinates with its domain here.
    pub domain: Vec<(Value, Interval)>,
    /// What is promised of inputs: uniforms and lane inputs lie within these; the caller holds to it. Used to know
    /// signs and to exclude overflow; inputs not listed may be anything.
    pub promises: Vec<(String, Interval)>,
    pub arithmetic: Arithmetic,
    /// The inputs that carry a noise symbol of their own, with [`Arithmetic::Affine`]; at most three.
    pub symbols: Vec<String>,
    pub rounding: Rounding,
}

impl Spec {
    /// The lane program of this order: bounds over the domain first, then the arithmetic asked for.
    pub fn lower(&self, precision: Precision) -> LaneProgram {
        let budget = Budget::new(&Limits::unlimited());
        self.lower_within(precision, &budget).unwrap_or_else(|_| unreachable!("there is no limit"))
    }

    /// The same within limits of time and of operations; those that nothing needs in the end count too.
    ///
    /// # Errors
    /// Which limit was exceeded.
    pub fn lower_within(&self, precision: Precision, budget: &Budget) -> Result<LaneProgram, Exceeded> {
        let promises: HashMap<&str, Interval> =
            self.promises.iter().map(|(name, range)| (name.as_str(), *range)).collect();
        let promised = |name: &String| promises.get(name.as_str()).copied().unwrap_or(Interval::ENTIRE);
        let inputs: Vec<Interval> = self.graph.variables().iter().map(promised).collect();
        budget.time()?;
        let bounds = bounds(&self.graph, &inputs, &self.domain);
        match self.arithmetic {
            Arithmetic::Point => point::lower(self, &bounds, precision, budget),
            Arithmetic::Interval | Arithmetic::Affine => interval::lower(self, &bounds, precision, budget),
        }
    }
}
