//! A kernel with the packets that one worker feeds it.

use std::sync::Arc;

use crate::kernel::Kernel;
use crate::kernel::Packet;
use crate::kernel::Real;

/// A kernel with its parameters bound.
#[derive(Clone)]
pub struct Program<T: Real> {
    pub kernel: Arc<dyn Kernel<T>>,
    /// In the kernel's layout: two numbers a parameter, or one in point mode.
    pub uniforms: Arc<[T]>,
}

/// Input and output packets for up to a fixed number of lanes; allocated once, written in place.
pub struct Batch<T: Real> {
    program: Program<T>,
    inputs: Vec<Packet<T>>,
    outputs: Vec<Packet<T>>,
    input_slots: usize,
    output_slots: usize,
    /// Lanes evaluated on behalf of a caller so far; padding is not counted.
    pub evaluations: u64,
}

impl<T: Real> Batch<T> {
    pub fn new(program: &Program<T>, groups: usize) -> Self {
        let input_slots = program.kernel.input_slots();
        let output_slots = program.kernel.output_slots();
        Self {
            program: program.clone(),
            inputs: vec![Packet::default(); groups * input_slots],
            outputs: vec![Packet::default(); groups * output_slots],
            input_slots,
            output_slots,
            evaluations: 0,
        }
    }

    /// The number of lanes.
    pub fn capacity(&self) -> usize {
        self.outputs.len() / self.output_slots * T::LANES
    }

    /// Input slots of a lane.
    pub fn input_slots(&self) -> usize {
        self.input_slots
    }

    /// Output slots of a lane.
    pub fn output_slots(&self) -> usize {
        self.output_slots
    }

    /// Writes one input slot of a lane.
    #[inline]
    pub fn set(&mut self, lane: usize, slot: usize, value: T) {
        self.inputs[lane / T::LANES * self.input_slots + slot].lanes_mut()[lane % T::LANES] = value;
    }

    /// Writes the box input number `input`: the negated lower end and the upper end.
    #[inline]
    pub fn set_box(&mut self, lane: usize, input: usize, negated_lo: T, hi: T) {
        self.set(lane, 2 * input, negated_lo);
        self.set(lane, 2 * input + 1, hi);
    }

    /// Writes the outward rounding of [lo, hi] to box input number `input`.
    #[inline]
    pub fn set_range(&mut self, lane: usize, input: usize, lo: f64, hi: f64) {
        self.set_box(lane, input, T::up(-lo), T::up(hi));
    }

    /// Makes lane `to` a copy of lane `from`.
    pub fn copy_lane(&mut self, from: usize, to: usize) {
        for slot in 0..self.input_slots {
            let value = self.inputs[from / T::LANES * self.input_slots + slot].lanes()[from % T::LANES];
            self.set(to, slot, value);
        }
    }

    /// Evaluates the first `lanes` lanes.
    pub fn run(&mut self, lanes: usize) {
        let groups = lanes.div_ceil(T::LANES);
        self.evaluations += lanes as u64;
        self.program.kernel.run(
            &self.program.uniforms,
            &self.inputs[..groups * self.input_slots],
            &mut self.outputs[..groups * self.output_slots],
        );
    }

    /// One output slot of a lane.
    #[inline]
    pub fn get(&self, lane: usize, slot: usize) -> T {
        self.outputs[lane / T::LANES * self.output_slots + slot].lanes()[lane % T::LANES]
    }

    /// The verdict bits in one output slot of a lane.
    #[inline]
    pub fn bits(&self, lane: usize, slot: usize) -> u32 {
        self.get(lane, slot).verdict()
    }
}
