//! Bounds over boxes.

use std::fmt;

use rayon::iter::IndexedParallelIterator;
use rayon::iter::ParallelIterator;
use rayon::slice::ParallelSlice;
use rayon::slice::ParallelSliceMut;
use serde::Deserialize;
use serde::Serialize;

use crate::derive::Rounding;
use crate::interval::Interval;
use crate::kernel::Kernel;
use crate::kernel::Packet;
use crate::kernel::Real;
use crate::kernel::verdict;
use crate::library::Enclosure;
use crate::library::Error;
use crate::library::Function;
use crate::library::Options;
use crate::library::Verdict;
use crate::library::kernel::Compile;
use crate::library::kernel::Shared;
use crate::library::kernel::check;
use crate::library::kernel::parameter;
use crate::library::kernel::rows;

/// Rows that one task of a parallel call computes.
const TASK: usize = 2048;

/// A function compiled to enclose its values over boxes.
///
/// Call it from any number of threads. A clone shares the code and has parameters of its own; the code is freed with the
/// last of them.
#[derive(Clone)]
pub struct IntervalKernel<T: Real = f64> {
    shared: Shared<T>,
    /// Whether anything is proved.
    rigorous: bool,
}

impl<T: Real> IntervalKernel<T> {
    pub(super) fn new(function: &Function, options: &Options) -> Result<Self, Error>
    where
        T: Compile,
    {
        let spec = function.box_spec(options, T::PRECISION)?;
        let code = T::compile(&spec, &function.budget())?;
        let uniforms = function.parameters().iter().flat_map(|parameter| ends::<T>(parameter.value)).collect();
        let outputs = function.outputs_of(options).into();
        let shared = Shared { code, uniforms, function: function.clone(), outputs };
        Ok(Self { shared, rigorous: options.rounding == Rounding::Outward })
    }

    /// What it was compiled from.
    pub fn function(&self) -> &Function {
        &self.shared.function
    }

    /// Names of the outputs: `f`, and with a gradient `df/dx`, ...
    pub fn outputs(&self) -> &[String] {
        &self.shared.outputs
    }

    /// Gives a parameter another value, which may be an interval; nothing is compiled.
    ///
    /// # Errors
    /// If there is no such parameter, or the value lies outside of its range, for which the code was made.
    pub fn set(&mut self, name: &str, value: Interval) -> Result<(), Error> {
        let place = parameter(&self.shared.function, name, value)?;
        self.shared.uniforms[2 * place..2 * place + 2].copy_from_slice(&ends::<T>(value));
        Ok(())
    }

    /// The same kernel with another value of a parameter.
    ///
    /// # Errors
    /// As [`IntervalKernel::set`].
    pub fn with(mut self, name: &str, value: Interval) -> Result<Self, Error> {
        self.set(name, value)?;
        Ok(self)
    }

    /// The first output over one box, which has an interval for each variable.
    ///
    /// # Errors
    /// If the box has another number of intervals.
    pub fn enclose(&self, of: &[Interval]) -> Result<Enclosure, Error> {
        check("intervals of the box", self.shared.variables(), of.len())?;
        let mut result = Enclosure::UNKNOWN;
        self.fill(1, of, |_, output| result = output(0));
        Ok(result)
    }

    /// All outputs over boxes, row by row: `boxes` holds an interval for each variable of the first box, then those of
    /// the second, and so on; `enclosures` gets the outputs in the same order.
    ///
    /// # Errors
    /// If the lengths are not those of as many whole rows; then nothing is computed.
    pub fn enclose_into(&self, boxes: &[Interval], enclosures: &mut [Enclosure]) -> Result<(), Error> {
        let (count, width) = (self.count(boxes, enclosures)?, self.outputs().len());
        self.fill(count, boxes, |row, output| {
            for (i, enclosure) in enclosures[row * width..(row + 1) * width].iter_mut().enumerate() {
                *enclosure = output(i);
            }
        });
        Ok(())
    }

    /// [`IntervalKernel::enclose_into`] on the threads of the current rayon pool.
    ///
    /// # Errors
    /// As [`IntervalKernel::enclose_into`].
    pub fn par_enclose_into(&self, boxes: &[Interval], enclosures: &mut [Enclosure]) -> Result<(), Error> {
        self.count(boxes, enclosures)?;
        if self.shared.variables() == 0 {
            return self.enclose_into(boxes, enclosures);
        }
        let inputs = boxes.par_chunks(TASK * self.shared.variables());
        let outputs = enclosures.par_chunks_mut(TASK * self.outputs().len());
        inputs.zip(outputs).try_for_each(|(inputs, outputs)| self.enclose_into(inputs, outputs))
    }

    /// All outputs over boxes in columns: `boxes[v]` holds the lower and the upper ends of variable v. Ends that are NaN, not in
    /// order or both the same infinity stand for the whole line. Columns of `enclosures` are made as long as needed and reused.
    ///
    /// # Errors
    /// If there is not a column for each variable, or one is longer than another.
    pub fn enclose_columns(&self, boxes: &[[&[T]; 2]], enclosures: &mut Columns<T>) -> Result<(), Error> {
        check("columns of boxes", self.shared.variables(), boxes.len())?;
        let count = boxes.first().map_or(0, |[lo, _]| lo.len());
        for column in boxes.iter().flatten() {
            check("numbers in a column", count, column.len())?;
        }
        let width = self.outputs().len();
        enclosures.resize(width, count);
        let (nan, infinity) = (T::nearest(f64::NAN), T::nearest(f64::INFINITY));
        self.shared.run(
            count,
            |rows, packets| {
                for ([lo, hi], slots) in boxes.iter().zip(packets.chunks_exact_mut(2)) {
                    let [lower, upper] = slots else { unreachable!("two slots a variable") };
                    let ends = lo[rows.clone()].iter().zip(&hi[rows.clone()]);
                    for ((lo, hi), (lower, upper)) in ends.zip(lower.lanes_mut().iter_mut().zip(upper.lanes_mut())) {
                        (*lower, *upper) = if lo <= hi && *lo < infinity && *hi > infinity.negated() {
                            (lo.negated(), *hi)
                        } else {
                            (nan, nan)
                        };
                    }
                }
            },
            |rows, packets| {
                for (output, slots) in packets.chunks_exact(3).enumerate() {
                    let results = enclosures.lo[output][rows.clone()].iter_mut().zip(slots[0].lanes());
                    results.for_each(|(lo, lower)| *lo = bounded(*lower, infinity).negated());
                    let results = enclosures.hi[output][rows.clone()].iter_mut().zip(slots[1].lanes());
                    results.for_each(|(hi, upper)| *hi = bounded(*upper, infinity));
                    let verdicts = enclosures.verdict[output][rows.clone()].iter_mut().zip(slots[2].lanes());
                    verdicts.for_each(|(verdict, bits)| *verdict = self.verdict(*bits));
                }
            },
        );
        Ok(())
    }

    /// All outputs over boxes in packets, as [`Kernel::run`] takes them, without any copy: a variable has two slots, the negated lower
    /// end and the upper end; an output three, negated lower end, upper end, and the verdict's bits.
    ///
    /// # Panics
    /// If the lengths are not those of as many whole groups.
    pub fn enclose_packets(&self, boxes: &[Packet<T>], enclosures: &mut [Packet<T>]) {
        self.shared.code.run(&self.shared.uniforms, boxes, enclosures);
        if !self.rigorous {
            let verdicts = enclosures.iter_mut().skip(2).step_by(3);
            verdicts.for_each(|packet| *packet = Packet::splat(T::from_verdict(0)));
        }
    }

    /// The code itself. With rounding to nearest its verdicts, which prove nothing then, are as they were computed;
    /// [`IntervalKernel::enclose_packets`] has none.
    pub fn packets(&self) -> &dyn Kernel<T> {
        &*self.shared.code
    }

    /// The parameters' values as [`IntervalKernel::packets`] takes them: negated lower end and upper end of each.
    pub fn uniforms(&self) -> &[T] {
        &self.shared.uniforms
    }

    fn count(&self, boxes: &[Interval], enclosures: &[Enclosure]) -> Result<usize, Error> {
        let width = self.outputs().len();
        // A function without variables has a row for each row of results.
        let count = match self.shared.variables() {
            0 => rows("enclosures", enclosures.len(), width)?,
            variables => rows("intervals of boxes", boxes.len(), variables)?,
        };
        check("enclosures", count * width, enclosures.len())?;
        Ok(count)
    }

    /// Computes rows; `take` gets each row's number and its outputs.
    #[inline]
    fn fill(&self, count: usize, boxes: &[Interval], mut take: impl FnMut(usize, &dyn Fn(usize) -> Enclosure)) {
        let variables = self.shared.variables();
        let row_of = |row: usize| &boxes[row * variables..(row + 1) * variables];
        self.shared.run(
            count,
            |rows, packets| {
                for (lane, row) in rows.enumerate() {
                    for (interval, slots) in row_of(row).iter().zip(packets.chunks_exact_mut(2)) {
                        let [lo, hi] = ends::<T>(*interval);
                        slots[0].lanes_mut()[lane] = lo;
                        slots[1].lanes_mut()[lane] = hi;
                    }
                }
            },
            |rows, packets| {
                for (lane, row) in rows.enumerate() {
                    let nowhere = row_of(row).iter().any(|interval| interval.is_empty());
                    take(row, &|output| match nowhere {
                        true => Enclosure {
                            interval: Interval::EMPTY,
                            verdict: self.verdict(T::from_verdict(verdict::EMPTY)),
                        },
                        false => self.enclosure(packets, output, lane),
                    });
                }
            },
        );
    }

    fn enclosure(&self, packets: &[Packet<T>], output: usize, lane: usize) -> Enclosure {
        let slot = |i: usize| packets[3 * output + i].lanes()[lane];
        let verdict = self.verdict(slot(2));
        let (lo, hi) = (-slot(0).to_f64(), slot(1).to_f64());
        let lo = if lo.is_nan() { f64::NEG_INFINITY } else { lo };
        let hi = if hi.is_nan() { f64::INFINITY } else { hi };
        let interval = match Interval::new(lo, hi) {
            Some(interval) => interval,
            None if lo == f64::INFINITY && hi == f64::NEG_INFINITY => Interval::EMPTY,
            // Ends out of order happen with rounding to nearest alone, where nothing is proved.
            None => Interval::new(hi, lo).unwrap_or(Interval::ENTIRE),
        };
        Enclosure { interval, verdict }
    }

    fn verdict(&self, bits: T) -> Verdict {
        Verdict(if self.rigorous { bits.verdict() } else { 0 })
    }
}

/// An end as kernels give it, where NaN stands for infinity.
fn bounded<T: Real>(end: T, infinity: T) -> T {
    if end <= infinity { end } else { infinity }
}

/// An interval as kernels take it: its lower end negated, and its upper end, rounded outward. Of the empty set both are NaN.
fn ends<T: Real>(interval: Interval) -> [T; 2] {
    [T::up(-interval.lo()), T::up(interval.hi())]
}

/// Enclosures in columns, one of `count` numbers for each output. An empty enclosure is from +inf to -inf.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Columns<T> {
    pub lo: Vec<Vec<T>>,
    pub hi: Vec<Vec<T>>,
    pub verdict: Vec<Vec<Verdict>>,
}

impl<T: Real> Columns<T> {
    fn resize(&mut self, width: usize, count: usize) {
        for ends in [&mut self.lo, &mut self.hi] {
            ends.resize(width, Vec::new());
            ends.iter_mut().for_each(|column| column.resize(count, T::default()));
        }
        self.verdict.resize(width, Vec::new());
        self.verdict.iter_mut().for_each(|column| column.resize(count, Verdict::default()));
    }
}

impl<T: Real> fmt::Debug for IntervalKernel<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "bounds of {:?}", self.shared.function)
    }
}
