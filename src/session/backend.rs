//! Which backend makes a kernel: the compiler where it can, else the interpreter, which is slower and gives the same
//! answers.

use std::sync::Arc;

use crate::codegen::Bounded;
use crate::codegen::Compiler;
use crate::derive::Precision;
use crate::derive::Spec;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::interpret::Interpreter;
use crate::kernel::Backend;
use crate::kernel::Kernel;
use crate::limits::Budget;

/// The backend for this machine.
pub fn backend() -> &'static dyn Backend {
    if Compiler::available() { &Tiered } else { &Interpreter }
}

/// The backend for this machine under a budget.
#[derive(Debug, Clone, Copy)]
pub struct Within<'b>(pub &'b Budget);

impl Backend for Within<'_> {
    fn compile_f32(&self, spec: &Spec) -> Result<Arc<dyn Kernel<f32>>, Diagnostic> {
        if !Compiler::available() {
            spec.lower_within(Precision::Single, self.0)?;
            return Interpreter.compile_f32(spec);
        }
        or_else(Bounded(self.0).compile_f32(spec), || Interpreter.compile_f32(spec))
    }

    fn compile_f64(&self, spec: &Spec) -> Result<Arc<dyn Kernel<f64>>, Diagnostic> {
        if !Compiler::available() {
            spec.lower_within(Precision::Double, self.0)?;
            return Interpreter.compile_f64(spec);
        }
        or_else(Bounded(self.0).compile_f64(spec), || Interpreter.compile_f64(spec))
    }
}

/// Compiles every program that is not too large for it, kernel by kernel.
#[derive(Debug, Clone, Copy)]
struct Tiered;

impl Backend for Tiered {
    fn compile_f32(&self, spec: &Spec) -> Result<Arc<dyn Kernel<f32>>, Diagnostic> {
        or_else(Compiler.compile_f32(spec), || Interpreter.compile_f32(spec))
    }

    fn compile_f64(&self, spec: &Spec) -> Result<Arc<dyn Kernel<f64>>, Diagnostic> {
        or_else(Compiler.compile_f64(spec), || Interpreter.compile_f64(spec))
    }
}

fn or_else<T>(
    compiled: Result<T, Diagnostic>,
    interpreted: impl FnOnce() -> Result<T, Diagnostic>,
) -> Result<T, Diagnostic> {
    match compiled {
        Err(diagnostic) if diagnostic.code == code::KERNEL_TOO_LARGE => interpreted(),
        other => other,
    }
}
