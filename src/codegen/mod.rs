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

pub use emit::Emitted;
pub use emit::emit;
use jit::Width;

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
        compile(spec, Width::Widest)
    }

    fn compile_f64(&self, spec: &Spec) -> Result<Arc<dyn Kernel<f64>>, Diagnostic> {
        compile(spec, Width::Widest)
    }
}

/// The compiler without the widening pass: what widened kernels must equal bit for bit, and what they are timed against.
#[derive(Debug, Clone, Copy, Default)]
pub struct NarrowCompiler;

impl Backend for NarrowCompiler {
    fn compile_f32(&self, spec: &Spec) -> Result<Arc<dyn Kernel<f32>>, Diagnostic> {
        compile(spec, Width::Narrow)
    }

    fn compile_f64(&self, spec: &Spec) -> Result<Arc<dyn Kernel<f64>>, Diagnostic> {
        compile(spec, Width::Narrow)
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
