//! What both kinds of kernels share: the code, the parameters' values, and the packets in which numbers travel.

use std::ops::Range;
use std::sync::Arc;

use crate::derive::Precision;
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
    /// The precision of this type.
    const PRECISION: Precision;

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
    const PRECISION: Precision = Precision::Double;

    fn compile(spec: &Spec, budget: &Budget) -> Result<Arc<dyn Kernel<f64>>, Diagnostic> {
        session::Within(budget).compile_f64(spec)
    }
}

impl Compile for f32 {
    const PRECISION: Precision = Precision::Single;

    fn compile(spec: &Spec, budget: &Budget) -> Result<Arc<dyn Kernel<f32>>, Diagnostic> {
        session::Within(budget).compile_f32(spec)
    }
}

/// Bytes of packets that one call of the machine code works on in batches: they stay in the first cache.
const BATCH_BYTES: usize = 1 << 14;

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

    /// Computes `count` rows, a group of up to [`Real::LANES`] at a time: `fill` writes a range of rows into the first lanes of
    /// the input packets, `take` reads it from those of the output packets.
    #[inline]
    pub fn run(
        &self,
        count: usize,
        fill: impl Fn(Range<usize>, &mut [Packet<T>]),
        mut take: impl FnMut(Range<usize>, &[Packet<T>]),
    ) {
        let (input_slots, output_slots) = (self.code.input_slots(), self.code.output_slots());
        if count <= T::LANES && input_slots.max(output_slots) <= SMALL {
            // One group takes no memory from the heap.
            let mut inputs = [Packet::default(); SMALL];
            let mut outputs = [Packet::default(); SMALL];
            let (inputs, outputs) = (&mut inputs[..input_slots], &mut outputs[..output_slots]);
            if count > 0 {
                fill(0..count, inputs);
                self.code.run(&self.uniforms, inputs, outputs);
                take(0..count, outputs);
            }
            return;
        }
        let packet = size_of::<Packet<T>>();
        let most = (BATCH_BYTES / packet / (input_slots + output_slots).max(1)).max(1);
        let groups = count.div_ceil(T::LANES).min(most);
        let mut inputs = vec![Packet::default(); groups * input_slots];
        let mut outputs = vec![Packet::default(); groups * output_slots];
        for start in (0..count).step_by(most * T::LANES) {
            let end = count.min(start + most * T::LANES);
            let groups = (end - start).div_ceil(T::LANES);
            let rows = |group: usize| start + group * T::LANES..end.min(start + (group + 1) * T::LANES);
            // Lanes beyond the last row compute what was there before, which nobody reads.
            for (group, packets) in inputs.chunks_exact_mut(input_slots).take(groups).enumerate() {
                fill(rows(group), packets);
            }
            let (inputs, outputs) = (&inputs[..groups * input_slots], &mut outputs[..groups * output_slots]);
            self.code.run(&self.uniforms, inputs, outputs);
            for (group, packets) in outputs.chunks_exact(output_slots).enumerate() {
                take(rows(group), packets);
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
