//! Lane programs to machine code: CLIF by Cranelift, executable memory, and the rounding mode around each call.

mod emit;
mod jit;
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

/// The compiling backend. Needs x86-64 with AVX and FMA; elsewhere every order fails with a diagnostic and the caller
/// falls back to the interpreter.
#[derive(Debug, Clone, Copy, Default)]
pub struct Compiler;

impl Compiler {
    /// Compiles a lane program to a kernel of the precision `T` that the program must have.
    fn compile<T: jit::Format>(&self, spec: &Spec) -> Result<Arc<dyn Kernel<T>>, Diagnostic> {
        let program: LaneProgram = spec.lower(T::PRECISION);
        Ok(Arc::new(jit::JitKernel::<T>::new(&program, spec.rounding)?))
    }

    /// Whether this machine can run what the compiler makes.
    pub fn available() -> bool {
        rounding::available()
    }
}

impl Backend for Compiler {
    fn compile_f32(&self, spec: &Spec) -> Result<Arc<dyn Kernel<f32>>, Diagnostic> {
        self.compile::<f32>(spec)
    }

    fn compile_f64(&self, spec: &Spec) -> Result<Arc<dyn Kernel<f64>>, Diagnostic> {
        self.compile::<f64>(spec)
    }
}

/// CLIF and machine code of a program as text, for `imp emit clif` and `imp emit asm`.
pub fn listing(spec: &Spec, precision: Precision) -> Result<Emitted, Diagnostic> {
    emit(&spec.lower(precision))
}
