//! What every consumer calls: packets of boxes in, enclosures or verdicts out; packets of points in, values out.
//! Consumers ask a [`Backend`] for a [`Kernel`] and never learn which one answered.

use std::sync::Arc;

use crate::derive::Spec;
use crate::diagnostic::Diagnostic;

/// Bits of a verdict word (see [`crate::derive::Output::Verdict`]). No bit set says nothing.
pub mod verdict {
    /// The value is proved > 0 wherever it is defined on the box.
    pub const POSITIVE: u32 = 1;
    /// The value is proved < 0 wherever it is defined on the box.
    pub const NEGATIVE: u32 = 2;
    /// The value is proved undefined on all of the box, or the box lies outside the domain.
    pub const EMPTY: u32 = 4;
    /// The value is proved defined and continuous on all of the box, and the box lies inside the domain.
    pub const CONTINUOUS: u32 = 8;
    /// What proves that the value has no zero on the box.
    pub const REFUTED: u32 = POSITIVE | NEGATIVE | EMPTY;
}

/// One slot of one packet: 64 bytes, so 16 `f32` or 8 `f64` lanes, whatever vector width the code uses.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(64))]
pub struct Packet<T: Real>(pub T::Lanes);

impl<T: Real> Packet<T> {
    pub fn splat(value: T) -> Self {
        Packet(T::splat(value))
    }

    pub fn lanes(&self) -> &[T] {
        self.0.as_ref()
    }

    pub fn lanes_mut(&mut self) -> &mut [T] {
        self.0.as_mut()
    }
}

impl<T: Real> Default for Packet<T> {
    fn default() -> Self {
        Packet::splat(T::default())
    }
}

/// The two formats in which kernels compute.
pub trait Real: Copy + Default + PartialOrd + Send + Sync + std::fmt::Debug + 'static {
    /// Lanes of one packet.
    const LANES: usize;
    type Lanes: Copy + Send + Sync + AsRef<[Self]> + AsMut<[Self]> + std::fmt::Debug + PartialEq;
    fn splat(value: Self) -> Self::Lanes;
    /// The verdict bits that a kernel stored in a lane.
    fn verdict(self) -> u32;
    fn from_verdict(bits: u32) -> Self;
    /// Nearest to, at most, and at least the given number.
    fn nearest(value: f64) -> Self;
    fn down(value: f64) -> Self;
    fn up(value: f64) -> Self;
    fn to_f64(self) -> f64;
    /// The number with the other sign.
    fn negated(self) -> Self;
}

impl Real for f32 {
    const LANES: usize = 16;
    type Lanes = [f32; 16];
    fn splat(value: f32) -> [f32; 16] {
        [value; 16]
    }
    fn verdict(self) -> u32 {
        self.to_bits()
    }
    fn from_verdict(bits: u32) -> f32 {
        f32::from_bits(bits)
    }
    fn nearest(value: f64) -> f32 {
        value as f32
    }
    fn down(value: f64) -> f32 {
        let near = value as f32;
        if f64::from(near) > value { near.next_down() } else { near }
    }
    fn up(value: f64) -> f32 {
        -f32::down(-value)
    }
    fn to_f64(self) -> f64 {
        self.into()
    }
    fn negated(self) -> f32 {
        -self
    }
}

impl Real for f64 {
    const LANES: usize = 8;
    type Lanes = [f64; 8];
    fn splat(value: f64) -> [f64; 8] {
        [value; 8]
    }
    fn verdict(self) -> u32 {
        self.to_bits() as u32
    }
    fn from_verdict(bits: u32) -> f64 {
        f64::from_bits(bits.into())
    }
    fn nearest(value: f64) -> f64 {
        value
    }
    fn down(value: f64) -> f64 {
        value
    }
    fn up(value: f64) -> f64 {
        value
    }
    fn to_f64(self) -> f64 {
        self
    }
    fn negated(self) -> f64 {
        -self
    }
}

/// A compiled or interpreted program, callable from any thread.
///
/// Layout: group `g` of `inputs` holds the slots `inputs[g * I .. (g + 1) * I]`, one [`Packet`] a slot, and `outputs`
/// likewise with `O`. A box input takes two slots, the **negated** lower end and the upper end; a point input takes one.
/// An enclosure output takes three: negated lower end, upper end, verdict; a verdict output one; a value output one.
/// `uniforms` holds the parameters in the order of the spec, two numbers each (negated lower end, upper end) or one in
/// point mode. Ends may be infinite; a NaN end stands for the infinite one.
pub trait Kernel<T: Real>: Send + Sync {
    /// Slots of one input group.
    fn input_slots(&self) -> usize;
    /// Slots of one output group.
    fn output_slots(&self) -> usize;

    /// Evaluates all groups.
    ///
    /// # Panics
    /// If the lengths do not match the slots or the uniforms do not match the spec.
    fn run(&self, uniforms: &[T], inputs: &[Packet<T>], outputs: &mut [Packet<T>]);
}

/// Makes kernels.
pub trait Backend: Send + Sync {
    fn compile_f32(&self, spec: &Spec) -> Result<Arc<dyn Kernel<f32>>, Diagnostic>;
    fn compile_f64(&self, spec: &Spec) -> Result<Arc<dyn Kernel<f64>>, Diagnostic>;
}
