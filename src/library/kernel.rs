//! What both kinds of kernels share: the code, the parameters' values, and the packets in which numbers travel.

use std::sync::Arc;

use crate::derive::Spec;
use crate::diagnostic::Diagnostic;
use crate::interval::Interval;
use crate::kernel::Backend;
use crate::kernel::Kernel;
use crate::kernel::Packet;
use crate::kernel::Real;
use crate::library::Error;
use crate::library::Function;
use crate::limits::Budget;
use crate::session;

/// The two formats for which kernels are compiled: `f64` and `f32`.
pub trait Compile: Real + sealed::Sealed {
    /// Compiles a spec for this machine.
    ///
    /// # Errors
    /// If it exceeds the budget, or for a fault of ours; a program that is too large to be compiled is interpreted.
    fn compile(spec: &Spec, budget: &Budget) -> Result<Arc<dyn Kernel<Self>>, Diagnostic>;
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

impl Compile for f64 {
    fn compile(spec: &Spec, budget: &Budget) -> Result<Arc<dyn Kernel<f64>>, Diagnostic> {
        session::Within(budget).compile_f64(spec)
    }
}

impl Compile for f32 {
    fn compile(spec: &Spec, budget: &Budget) -> Result<Arc<dyn Kernel<f32>>, Diagnostic> {
        session::Within(budget).compile_f32(spec)
    }
}

/// Groups that one call of the machine code computes in batches: 64 KiB of packets stay in the cache.
const BATCH_BYTES: usize = 1 << 16;

/// Packets of a single box that need no allocation.
const SMALL: usize = 12;

/// A compiled function with values for its parameters.
#[derive(Clone)]
pub struct Shared<T: Real> {
    pub code: Arc<dyn Kernel<T>>,
    /// The values of the parameters as the code takes them.
    pub uniforms: Vec<T>,
    pub function: Function,
    pub outputs: Arc<[String]>,
}

impl<T: Real> Shared<T> {
    pub fn variables(&self) -> usize {
        self.function.variables().len()
    }

    /// Computes `count` rows: `fill` writes row i into a lane of its group's inputs, `take` reads it from a lane of the
    /// outputs.
    pub fn run(&self, count: usize, fill: impl Fn(usize, &mut Lane<T>), mut take: impl FnMut(usize, &LaneOf<T>)) {
        let (input_slots, output_slots) = (self.code.input_slots(), self.code.output_slots());
        if count == 1 && input_slots.max(output_slots) <= SMALL {
            // One row takes no memory from the heap.
            let mut inputs = [Packet::default(); SMALL];
            let mut outputs = [Packet::default(); SMALL];
            let (inputs, outputs) = (&mut inputs[..input_slots], &mut outputs[..output_slots]);
            fill(0, &mut Lane { packets: inputs, lane: 0 });
            self.code.run(&self.uniforms, inputs, outputs);
            take(0, &LaneOf { packets: outputs, lane: 0 });
            return;
        }
        let packet = size_of::<Packet<T>>();
        let most = (BATCH_BYTES / packet / (input_slots + output_slots).max(1)).max(1);
        let groups = count.div_ceil(T::LANES).min(most);
        let mut inputs = vec![Packet::default(); groups * input_slots];
        let mut outputs = vec![Packet::default(); groups * output_slots];
        for start in (0..count).step_by(most * T::LANES) {
            let rows = (count - start).min(most * T::LANES);
            let groups = rows.div_ceil(T::LANES);
            // Lanes beyond the last row compute what was there before, which nobody reads.
            for row in 0..rows {
                let group = row / T::LANES * input_slots;
                let packets = &mut inputs[group..group + input_slots];
                fill(start + row, &mut Lane { packets, lane: row % T::LANES });
            }
            let (inputs, outputs) = (&inputs[..groups * input_slots], &mut outputs[..groups * output_slots]);
            self.code.run(&self.uniforms, inputs, outputs);
            for row in 0..rows {
                let group = row / T::LANES * output_slots;
                take(start + row, &LaneOf { packets: &outputs[group..group + output_slots], lane: row % T::LANES });
            }
        }
    }
}

/// A parameter's place, if it can take a value.
pub fn parameter(function: &Function, name: &str, value: Interval) -> Result<usize, Error> {
    let parameters = function.parameters();
    let Some(place) = parameters.iter().position(|parameter| parameter.name == name) else {
        let known = parameters.iter().map(|parameter| parameter.name.clone()).collect();
        return Err(Error::UnknownParameter { name: name.to_owned(), known });
    };
    let range = parameters[place].range.unwrap_or(Interval::ENTIRE);
    match range.contains_interval(value) && !value.is_empty() {
        true => Ok(place),
        false => Err(Error::OutOfRange { name: name.to_owned(), value, range }),
    }
}

/// Where a row is written: one lane of all slots.
pub struct Lane<'a, T: Real> {
    packets: &'a mut [Packet<T>],
    lane: usize,
}

impl<T: Real> Lane<'_, T> {
    pub fn set(&mut self, slot: usize, number: T) {
        self.packets[slot].lanes_mut()[self.lane] = number;
    }
}

/// Where a row is read.
pub struct LaneOf<'a, T: Real> {
    packets: &'a [Packet<T>],
    lane: usize,
}

impl<T: Real> LaneOf<'_, T> {
    pub fn get(&self, slot: usize) -> T {
        self.packets[slot].lanes()[self.lane]
    }
}

/// Whether an array has the length that is needed.
pub fn check(what: &'static str, expected: usize, found: usize) -> Result<(), Error> {
    if expected == found { Ok(()) } else { Err(Error::Length { what, expected, found }) }
}

/// How many rows an array of so many numbers or boxes holds.
pub fn rows(what: &'static str, length: usize, variables: usize) -> Result<usize, Error> {
    match variables {
        0 => Ok(length),
        _ if length.is_multiple_of(variables) => Ok(length / variables),
        _ => Err(Error::Length { what, expected: length.next_multiple_of(variables), found: length }),
    }
}
