//! Compiled kernels in memory: who owns the code, and the one place where it is called.

use std::marker::PhantomData;
use std::mem::ManuallyDrop;

use cranelift_codegen::isa::OwnedTargetIsa;
use cranelift_jit::JITBuilder;
use cranelift_jit::JITModule;
use cranelift_module::Linkage;
use cranelift_module::Module;
use cranelift_module::default_libcall_names;

use crate::codegen::emit;
use crate::codegen::rounding;
use crate::codegen::widen;
use crate::codegen::widen::Registers;
use crate::codegen::widen::Wide;
use crate::derive::LaneProgram;
use crate::derive::Precision;
use crate::derive::Rounding;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::kernel::Kernel;
use crate::kernel::Packet;
use crate::kernel::Real;

/// The precision that belongs to a Rust type.
pub trait Format: Real {
    const PRECISION: Precision;
}

impl Format for f32 {
    const PRECISION: Precision = Precision::Single;
}

impl Format for f64 {
    const PRECISION: Precision = Precision::Double;
}

/// Which registers a kernel uses. No result depends on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Width {
    /// Those with which kernels run fastest on this machine: the widest that it has. On a Zen 4, which computes 512 bits in
    /// two halves, 512-bit registers took 0.54 to 0.91 of the time of 256-bit ones in each of 96 kernels (polynomials,
    /// elementary functions, CSG; intervals, gradients, affine forms; both precisions), 0.68 in the geometric mean: there
    /// are twice as many registers, so that little is spilled, and half as many instructions.
    Best,
    /// 128 bits, as Cranelift emits.
    Narrow,
    /// These, or 128 bits if the machine has none or the widening pass declines.
    Wide(Registers),
}

impl Width {
    /// The registers to try, best first; 128 bits come after them.
    fn candidates(self) -> impl Iterator<Item = Registers> {
        let wanted = move |registers| match self {
            Self::Best => true,
            Self::Narrow => false,
            Self::Wide(wanted) => registers == wanted,
        };
        [Registers::Zmm, Registers::Ymm]
            .into_iter()
            .filter(move |&registers| wanted(registers) && registers.available())
    }
}

/// A kernel that owns its machine code. Cranelift never makes a page writable and executable at once.
pub struct JitKernel<T> {
    entry: rounding::Entry,
    rounding: Rounding,
    input_slots: usize,
    output_slots: usize,
    uniform_slots: usize,
    module: ManuallyDrop<JITModule>,
    format: PhantomData<T>,
}

// SAFETY: after construction the module is touched only by `drop`; the code is immutable and keeps no state.
unsafe impl<T> Sync for JitKernel<T> {}

impl<T: Format> JitKernel<T> {
    pub fn new(program: &LaneProgram, rounding: Rounding, width: Width) -> Result<Self, Diagnostic> {
        assert_eq!(program.precision, T::PRECISION);
        if !rounding::available() {
            let title = "this machine has no AVX and FMA instructions, which compiled kernels need";
            return Err(Diagnostic::error(code::INTERNAL, title));
        }
        let isa = emit::isa(program)?;
        let mut module = JITModule::new(JITBuilder::with_isa(isa.clone(), default_libcall_names()));
        match define(&mut module, &isa, program, width) {
            Ok(entry) => Ok(Self {
                entry,
                rounding,
                input_slots: program.input_slots,
                output_slots: program.outputs.len(),
                uniform_slots: program.uniform_slots,
                module: ManuallyDrop::new(module),
                format: PhantomData,
            }),
            Err(error) => {
                // SAFETY: no entry was handed out.
                unsafe { module.free_memory() };
                Err(error)
            }
        }
    }
}

/// Compiles to the code of the wanted width, or narrower if the widening pass declines.
fn define(
    module: &mut JITModule,
    isa: &OwnedTargetIsa,
    program: &LaneProgram,
    width: Width,
) -> Result<rounding::Entry, Diagnostic> {
    let (bytes, start) = match widest(isa, program, width)? {
        Some(wide) => (wide.bytes, wide.entry),
        None => (emit::machine_code(program, isa, emit::VECTOR)?, 0),
    };
    let id = module
        .declare_function("kernel", Linkage::Local, &emit::signature())
        .map_err(|error| emit::internal(&error))?;
    // The alignment of a cache line is that of the widest constant, too.
    module.define_function_bytes(id, 64, &bytes, &[]).map_err(|error| emit::internal(&error))?;
    module.finalize_definitions().map_err(|error| emit::internal(&error))?;
    let code = module.get_finalized_function(id).wrapping_add(start);
    // SAFETY: the function was compiled with exactly this signature and calling convention.
    Ok(unsafe { std::mem::transmute::<*const u8, rounding::Entry>(code) })
}

/// The code for the first registers with which the widening pass does not decline.
fn widest(isa: &OwnedTargetIsa, program: &LaneProgram, width: Width) -> Result<Option<Wide>, Diagnostic> {
    for registers in width.candidates() {
        let wide = widen::widen(&emit::machine_code(program, isa, registers.bytes())?, registers);
        if wide.is_some() {
            return Ok(wide);
        }
    }
    Ok(None)
}

impl<T: Format> Kernel<T> for JitKernel<T> {
    fn input_slots(&self) -> usize {
        self.input_slots
    }

    fn output_slots(&self) -> usize {
        self.output_slots
    }

    fn run(&self, uniforms: &[T], inputs: &[Packet<T>], outputs: &mut [Packet<T>]) {
        let groups = inputs.len() / self.input_slots.max(1);
        assert_eq!(inputs.len(), groups * self.input_slots, "the inputs are no whole number of groups");
        assert_eq!(outputs.len(), groups * self.output_slots, "the outputs do not match the inputs");
        assert_eq!(uniforms.len(), self.uniform_slots, "the uniforms do not match the spec");
        let (inputs, outputs, uniforms) =
            (inputs.as_ptr().cast::<u8>(), outputs.as_mut_ptr().cast::<u8>(), uniforms.as_ptr().cast::<u8>());
        // SAFETY: the lengths were checked; packets are 64 bytes, aligned to 64, as the code assumes; `entry` lives as
        // long as `self`, which this call borrows.
        unsafe {
            match self.rounding {
                Rounding::Outward => rounding::call_upward(self.entry, inputs, outputs, uniforms, groups),
                Rounding::Nearest => (self.entry)(inputs, outputs, uniforms, groups),
            }
        }
    }
}

impl<T> Drop for JitKernel<T> {
    fn drop(&mut self) {
        // SAFETY: `entry` is private and every call borrows `self`, so none is running; the module is not used again.
        unsafe { ManuallyDrop::take(&mut self.module).free_memory() }
    }
}
