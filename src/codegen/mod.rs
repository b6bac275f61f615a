//! Lane programs to machine code: CLIF by Cranelift, executable memory, and the rounding mode around each call.

mod emit;
mod jit;
pub mod object;
mod rounding;
mod widen;

use std::sync::Arc;

use crate::derive::LaneProgram;
use crate::derive::Precision;
use crate::derive::Spec;
use crate::diagnostic::Diagnostic;
use crate::kernel::Backend;
use crate::kernel::Kernel;
use crate::limits::Budget;

pub use emit::Emitted;
pub use emit::emit;
pub use jit::Width;
pub use widen::Registers;

/// The compiling backend. Needs x86-64 with AVX and FMA; elsewhere every order fails with a diagnostic and the caller
/// falls back to the interpreter.
#[derive(Debug, Clone, Copy, Default)]
pub struct Compiler;

impl Compiler {
    /// Whether this machine can run what the compiler makes.
    pub fn available() -> bool {
        rounding::available()
    }
}

impl Backend for Compiler {
    fn compile_f32(&self, spec: &Spec) -> Result<Arc<dyn Kernel<f32>>, Diagnostic> {
        compile(spec, Width::Best)
    }

    fn compile_f64(&self, spec: &Spec) -> Result<Arc<dyn Kernel<f64>>, Diagnostic> {
        compile(spec, Width::Best)
    }
}

/// The compiler within limits of operations and of time, under a budget that may have begun with the text. Cranelift cannot be
/// stopped: the operations bound its time.
#[derive(Debug, Clone, Copy)]
pub struct Bounded<'b>(pub &'b Budget);

impl Backend for Bounded<'_> {
    fn compile_f32(&self, spec: &Spec) -> Result<Arc<dyn Kernel<f32>>, Diagnostic> {
        compile_within(spec, self.0)
    }

    fn compile_f64(&self, spec: &Spec) -> Result<Arc<dyn Kernel<f64>>, Diagnostic> {
        compile_within(spec, self.0)
    }
}

fn compile_within<T: jit::Format>(spec: &Spec, budget: &Budget) -> Result<Arc<dyn Kernel<T>>, Diagnostic> {
    let program = spec.lower_within(T::PRECISION, budget)?;
    budget.time()?;
    Ok(Arc::new(jit::JitKernel::<T>::new(&program, spec.rounding, Width::Best)?))
}

/// The compiler for registers of a given width: widened kernels must equal narrow ones bit for bit, and are timed against
/// them.
#[derive(Debug, Clone, Copy)]
pub struct CompilerFor(pub Width);

impl Backend for CompilerFor {
    fn compile_f32(&self, spec: &Spec) -> Result<Arc<dyn Kernel<f32>>, Diagnostic> {
        compile(spec, self.0)
    }

    fn compile_f64(&self, spec: &Spec) -> Result<Arc<dyn Kernel<f64>>, Diagnostic> {
        compile(spec, self.0)
    }
}

fn compile<T: jit::Format>(spec: &Spec, width: Width) -> Result<Arc<dyn Kernel<T>>, Diagnostic> {
    let program: LaneProgram = spec.lower(T::PRECISION);
    Ok(Arc::new(jit::JitKernel::<T>::new(&program, spec.rounding, width)?))
}

/// CLIF and machine code of a program as text, for `imp emit clif` and `imp emit asm`.
pub fn listing(spec: &Spec, precision: Precision) -> Result<Emitted, Diagnostic> {
    emit(&spec.lower(precision))
}
