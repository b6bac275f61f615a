//! Lane programs to CLIF: one instruction pattern per lane operation, in a loop over the vectors of a packet.
//!
//! Cranelift's optimiser folds scalar float constants to nearest, which is unsound under another rounding mode; here
//! every constant is a vector constant and the optimiser is off. Floating-point operations are pure to Cranelift, so the
//! mode must not change inside a function: it is set around the call (`rounding`).

use std::sync::OnceLock;

use cranelift_codegen::Context;
use cranelift_codegen::FinalizedRelocTarget;
use cranelift_codegen::ir::AbiParam;
use cranelift_codegen::ir::ConstantData;
use cranelift_codegen::ir::ExternalName;
use cranelift_codegen::ir::InstBuilder;
use cranelift_codegen::ir::MemFlagsData;
use cranelift_codegen::ir::Signature;
use cranelift_codegen::ir::Type;
use cranelift_codegen::ir::Value;
use cranelift_codegen::ir::condcodes::FloatCC;
use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::types;
use cranelift_codegen::isa::Builder;
use cranelift_codegen::isa::CallConv;
use cranelift_codegen::isa::OwnedTargetIsa;
use cranelift_codegen::isa::TargetFrontendConfig;
use cranelift_codegen::settings;
use cranelift_codegen::settings::Configurable;
use cranelift_frontend::FunctionBuilder;
use cranelift_frontend::FunctionBuilderContext;
use cranelift_module::FuncId;
use cranelift_module::ModuleReloc;

use crate::derive::LaneProgram;
use crate::derive::Precision;
use crate::derive::lanes::Kind;
use crate::derive::lanes::Lane;
use crate::derive::lanes::LaneOp;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;

/// Bytes of one slot of one packet (see `kernel::Packet`), and of one vector register.
const PACKET: i64 = 64;
pub const VECTOR: usize = 16;

/// Above this many values live at once, the allocator that is linear in the program's length takes over: the other
/// one gives code twice as fast, but its time grows with the square of the live values.
const LIVE_LIMIT: usize = 600;

/// Above this many lane operations it takes over, too: most pictures are computed sooner than such a program is
/// allocated well.
const LONG: usize = 40_000;

/// Programs of more lane operations are refused: they take seconds to compile.
const MAX_OPERATIONS: usize = 400_000;

/// Bytes of stack that a kernel may take, which runs on threads that it does not know: half of the stack of a thread that
/// Rust starts.
pub const MAX_FRAME: u32 = 1 << 20;

/// What code is made for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Machine {
    /// This machine, in this process.
    Host,
    /// x86-64 with SSE4.2 in 128-bit registers and without fused operations, for which the C library's `fma` is called.
    Sse42,
    /// x86-64 with AVX2 and FMA, in the encoding that `widen` reads.
    Avx2,
    /// 64-bit ARM with what every such processor has.
    Aarch64,
}

/// A compiled program: the function, followed by its constants.
pub struct Code {
    pub bytes: Vec<u8>,
    /// Calls of the C library; none where the machine has fused operations.
    pub relocations: Vec<ModuleReloc>,
    /// Bytes of stack.
    pub frame: u32,
}

/// The machine code of a program that calls nothing: the function and its constants, with nothing to relocate.
///
/// # Errors
/// If the program is too large (`KERNEL_TOO_LARGE`), or for a fault of ours.
pub fn machine_code(program: &LaneProgram, isa: &OwnedTargetIsa, stride: usize) -> Result<Vec<u8>, Diagnostic> {
    let code = compile(program, isa, stride)?;
    if !code.relocations.is_empty() {
        return Err(internal(&"a kernel calls a function"));
    }
    Ok(code.bytes)
}

/// Compiles a program for any machine.
///
/// # Errors
/// As for [`machine_code`].
pub fn compile(program: &LaneProgram, isa: &OwnedTargetIsa, stride: usize) -> Result<Code, Diagnostic> {
    if program.ops.len() > MAX_OPERATIONS {
        return Err(too_large(program));
    }
    let mut context = Context::new();
    function(program, isa.frontend_config(), stride, &mut context);
    context.compile(&**isa, &mut Default::default()).map_err(|error| internal(&error.inner))?;
    let code = context.compiled_code().ok_or_else(|| internal(&"no code"))?;
    let frame = code.buffer.frame_layout().map_or(0, |frame| frame.frame_to_fp_offset);
    if frame > MAX_FRAME {
        return Err(too_large(program));
    }
    let bytes = code.code_buffer().to_vec();
    let mut relocations = Vec::new();
    for relocation in code.buffer.relocs() {
        if !matches!(relocation.target, FinalizedRelocTarget::ExternalName(ExternalName::LibCall(_))) {
            return Err(internal(&"a kernel refers to what is not in the C library"));
        }
        // The function's own number would matter to labels inside of it only.
        relocations.push(ModuleReloc::from_mach_reloc(relocation, &context.func, FuncId::from_u32(0)));
    }
    Ok(Code { bytes, relocations, frame })
}

/// The text of a compiled program.
pub struct Emitted {
    pub clif: String,
    pub assembly: String,
}

/// Compiles a program and gives its text.
pub fn emit(program: &LaneProgram) -> Result<Emitted, Diagnostic> {
    let isa = isa(program)?;
    let mut context = Context::new();
    context.set_disasm(true);
    function(program, isa.frontend_config(), VECTOR, &mut context);
    let clif = context.func.display().to_string();
    let code = context.compile(&*isa, &mut Default::default()).map_err(|error| internal(&error.inner))?;
    Ok(Emitted { clif, assembly: code.vcode.clone().unwrap_or_default() })
}

/// What went wrong in Cranelift is our mistake, whatever the formula.
pub fn internal(error: &dyn std::fmt::Display) -> Diagnostic {
    Diagnostic::error(code::INTERNAL, format!("the code generator failed: {error}"))
}

/// A program that is not worth compiling, or needs too much stack; the interpreter takes it.
pub fn too_large(program: &LaneProgram) -> Diagnostic {
    let title = format!("this formula is too large to be compiled: {} operations on vectors", program.ops.len());
    Diagnostic::error(code::KERNEL_TOO_LARGE, title)
}

/// The host's instruction set with the settings of this program; made once for each register allocator.
pub fn isa(program: &LaneProgram) -> Result<OwnedTargetIsa, Diagnostic> {
    static MADE: [OnceLock<OwnedTargetIsa>; 2] = [OnceLock::new(), OnceLock::new()];
    let made = &MADE[usize::from(is_simple(program))];
    if let Some(isa) = made.get() {
        return Ok(isa.clone());
    }
    let isa = isa_for(Machine::Host, program)?;
    Ok(made.get_or_init(|| isa).clone())
}

/// A machine's instruction set with the settings of this program.
pub fn isa_for(machine: Machine, program: &LaneProgram) -> Result<OwnedTargetIsa, Diagnostic> {
    let pic = if machine == Machine::Host { "false" } else { "true" };
    let allocator = if is_simple(program) { "single_pass" } else { "backtracking" };
    instructions(machine, &[("opt_level", "none"), ("regalloc_algorithm", allocator), ("is_pic", pic)])
}

/// A machine's instruction set for the code around kernels: it may take much stack, so it touches each of its pages in turn
/// and cannot pass over the page that guards the stack's end. That code rounds nothing, so the optimiser may see it.
pub fn isa_around(machine: Machine) -> Result<OwnedTargetIsa, Diagnostic> {
    let probing = [("enable_probestack", "true"), ("probestack_strategy", "inline")];
    let flags = [("opt_level", "speed"), ("is_pic", "true")];
    instructions(machine, &[flags, probing].concat())
}

fn instructions(machine: Machine, own: &[(&str, &str)]) -> Result<OwnedTargetIsa, Diagnostic> {
    let mut flags = settings::builder();
    let verifier = if cfg!(debug_assertions) { "true" } else { "false" };
    let common = [("enable_verifier", verifier), ("use_colocated_libcalls", "false")];
    for &(name, value) in common.iter().chain(own) {
        flags.set(name, value).map_err(|error| internal(&error))?;
    }
    let mut builder = match machine {
        Machine::Host => cranelift_native::builder().map_err(|error| internal(&error))?,
        Machine::Sse42 | Machine::Avx2 => by_name("x86_64-unknown-linux-gnu")?,
        Machine::Aarch64 => by_name("aarch64-unknown-linux-gnu")?,
    };
    const SSE42: &[&str] = &["has_sse3", "has_ssse3", "has_sse41", "has_sse42", "has_popcnt"];
    const AVX2: &[&str] = &["has_avx", "has_avx2", "has_fma", "has_bmi1", "has_bmi2", "has_lzcnt"];
    // EVEX encodings have no place in `widen`, and 128-bit kernels gain nothing by them.
    const AVX512: &[&str] = &["has_avx512f", "has_avx512vl", "has_avx512dq", "has_avx512bitalg", "has_avx512vbmi"];
    let (with, without): (&[&[&str]], &[&str]) = match machine {
        Machine::Host if cfg!(target_arch = "x86_64") => (&[], AVX512),
        Machine::Host | Machine::Aarch64 => (&[], &[]),
        Machine::Sse42 => (&[SSE42], &[]),
        Machine::Avx2 => (&[SSE42, AVX2], &[]),
    };
    for name in with.iter().copied().flatten() {
        builder.enable(name).map_err(|error| internal(&error))?;
    }
    for name in without {
        builder.set(name, "false").map_err(|error| internal(&error))?;
    }
    builder.finish(settings::Flags::new(flags)).map_err(|error| internal(&error))
}

fn by_name(triple: &str) -> Result<Builder, Diagnostic> {
    cranelift_codegen::isa::lookup_by_name(triple).map_err(|error| internal(&error))
}

/// Whether a program is for the register allocator that is linear in its length.
fn is_simple(program: &LaneProgram) -> bool {
    program.ops.len() > LONG || most_live(program) > LIVE_LIMIT
}

/// The most lane values that are live at one point.
fn most_live(program: &LaneProgram) -> usize {
    let mut last_use: Vec<usize> = (0..program.ops.len()).collect();
    for (i, op) in program.ops.iter().enumerate() {
        op.operands().for_each(|operand| last_use[operand.index()] = i);
    }
    for output in &program.outputs {
        last_use[output.index()] = program.ops.len();
    }
    let mut ends = vec![0usize; program.ops.len() + 1];
    let (mut live, mut most) = (0, 0);
    for (i, op) in program.ops.iter().enumerate() {
        // Constants are loaded where they are used; inputs where they stand, which with many parameters is long before.
        if !matches!(op, LaneOp::Const(_) | LaneOp::Bits(_)) {
            live += 1;
            ends[last_use[i]] += 1;
        }
        live -= ends[i].min(live);
        most = most.max(live);
    }
    most
}

/// The kernel's signature: inputs, outputs, uniforms, groups.
pub fn signature() -> Signature {
    let mut signature = Signature::new(CallConv::SystemV);
    signature.params = vec![AbiParam::new(types::I64); 4];
    signature
}

/// Fills `context` with the kernel of a program.
///
/// `stride` is how many bytes of a packet one pass of the loop covers: those of a register, or twice as many in code that
/// is to be widened.
pub fn function(program: &LaneProgram, config: TargetFrontendConfig, stride: usize, context: &mut Context) {
    let stride = stride as i64;
    context.func.signature = signature();
    let mut builder_context = FunctionBuilderContext::new();
    let mut b = FunctionBuilder::new(&mut context.func, &mut builder_context);
    let entry = b.create_block();
    let body = b.create_block();
    let next_group = b.create_block();
    let exit = b.create_block();
    b.append_block_params_for_function_params(entry);
    b.switch_to_block(entry);
    let [inputs, outputs, uniforms, groups] = std::array::from_fn(|i| b.block_params(entry)[i]);
    let zero = b.ins().iconst(types::I64, 0);
    // body(inputs, outputs, groups left, bytes done in the packet)
    for _ in 0..4 {
        b.append_block_param(body, types::I64);
    }
    let [inputs_now, outputs_now, left, done] = std::array::from_fn(|i| b.block_params(body)[i]);
    let start = [inputs.into(), outputs.into(), groups.into(), zero.into()];
    b.ins().brif(groups, body, &start, exit, &[]);

    b.switch_to_block(body);
    let mut emitter = Emitter {
        b: &mut b,
        number: if program.precision == Precision::Single { types::F32X4 } else { types::F64X2 },
        word: if program.precision == Precision::Single { types::I32X4 } else { types::I64X2 },
        scalar: if program.precision == Precision::Single { types::F32 } else { types::F64 },
        inputs: inputs_now,
        uniforms,
        values: Vec::with_capacity(program.ops.len()),
        program,
    };
    for op in &program.ops {
        let value = emitter.op(*op);
        emitter.values.push(value);
    }
    for (slot, output) in program.outputs.iter().enumerate() {
        let value = emitter.values[output.index()];
        emitter.b.ins().store(MemFlagsData::trusted(), value, outputs_now, slot as i32 * PACKET as i32);
    }
    let done = b.ins().iadd_imm_s(done, stride);
    let inputs_next = b.ins().iadd_imm_s(inputs_now, stride);
    let outputs_next = b.ins().iadd_imm_s(outputs_now, stride);
    let more = b.ins().icmp_imm_s(IntCC::NotEqual, done, PACKET);
    let again = [inputs_next.into(), outputs_next.into(), left.into(), done.into()];
    b.ins().brif(more, body, &again, next_group, &[]);

    b.switch_to_block(next_group);
    let inputs_next = b.ins().iadd_imm_s(inputs_next, PACKET * (program.input_slots as i64 - 1));
    let outputs_next = b.ins().iadd_imm_s(outputs_next, PACKET * (program.outputs.len() as i64 - 1));
    let left = b.ins().iadd_imm_s(left, -1);
    let again = [inputs_next.into(), outputs_next.into(), left.into(), zero.into()];
    b.ins().brif(left, body, &again, exit, &[]);

    b.switch_to_block(exit);
    b.ins().return_(&[]);
    b.seal_all_blocks();
    b.finalize(config);
}

struct Emitter<'a, 'f> {
    b: &'a mut FunctionBuilder<'f>,
    /// Vector types of numbers and of words (masks and bits), and the number's lane type.
    number: Type,
    word: Type,
    scalar: Type,
    inputs: Value,
    uniforms: Value,
    values: Vec<Value>,
    program: &'a LaneProgram,
}

impl Emitter<'_, '_> {
    fn at(&self, lane: Lane) -> Value {
        self.values[lane.index()]
    }

    fn op(&mut self, op: LaneOp) -> Value {
        use LaneOp::*;
        match op {
            Input(slot) => {
                let offset = slot as i32 * PACKET as i32;
                self.b.ins().load(self.number, MemFlagsData::trusted(), self.inputs, offset)
            }
            Uniform(slot) => {
                let offset = slot as i32 * self.scalar.bytes() as i32;
                let number = self.b.ins().load(self.scalar, MemFlagsData::trusted(), self.uniforms, offset);
                self.b.ins().splat(self.number, number)
            }
            Const(bits) => self.constant(self.number, bits),
            Bits(bits) => self.constant(self.word, bits),
            Add(x, y) => self.b.ins().fadd(self.values[x.index()], self.values[y.index()]),
            Sub(x, y) => self.b.ins().fsub(self.values[x.index()], self.values[y.index()]),
            Mul(x, y) => self.b.ins().fmul(self.values[x.index()], self.values[y.index()]),
            Div(x, y) => self.b.ins().fdiv(self.values[x.index()], self.values[y.index()]),
            Sqrt(x) => self.b.ins().sqrt(self.values[x.index()]),
            Fma(x, y, z) => self.b.ins().fma(self.values[x.index()], self.values[y.index()], self.values[z.index()]),
            Neg(x) => {
                let sign = self.constant(self.number, self.sign_bit());
                self.b.ins().bxor(self.values[x.index()], sign)
            }
            Abs(x) => {
                let rest = self.constant(self.number, self.sign_bit() - 1);
                self.b.ins().band(self.values[x.index()], rest)
            }
            // The two patterns that lower to one minps or maxps: second operand where either is NaN.
            Min(x, y) => self.pick(FloatCC::LessThan, (x, y), (x, y)),
            Max(x, y) => self.pick(FloatCC::LessThan, (y, x), (x, y)),
            Floor(x) => self.b.ins().floor(self.values[x.index()]),
            Ceil(x) => self.b.ins().ceil(self.values[x.index()]),
            Trunc(x) => self.b.ins().trunc(self.values[x.index()]),
            Nearest(x) => self.b.ins().nearest(self.values[x.index()]),
            Less(x, y) => self.compare(FloatCC::LessThan, x, y),
            LessEqual(x, y) => self.compare(FloatCC::LessThanOrEqual, x, y),
            Equal(x, y) => self.compare(FloatCC::Equal, x, y),
            MaskAnd(x, y) | BitAnd(x, y) => self.b.ins().band(self.values[x.index()], self.values[y.index()]),
            MaskOr(x, y) | BitOr(x, y) => self.b.ins().bor(self.values[x.index()], self.values[y.index()]),
            MaskNot(x) => {
                let ones = self.constant(self.word, u64::MAX);
                self.b.ins().bxor(self.values[x.index()], ones)
            }
            Select(mask, x, y) => {
                debug_assert_eq!(self.program.ops[mask.index()].kind(), Kind::Mask);
                let mask = self.cast(self.number, self.at(mask));
                self.b.ins().bitselect(mask, self.values[x.index()], self.values[y.index()])
            }
            ToBits(x) => self.cast(self.word, self.at(x)),
            FromBits(x) => self.cast(self.number, self.at(x)),
            MaskBits(x) => self.at(x),
            IntAdd(x, y) => self.b.ins().iadd(self.values[x.index()], self.values[y.index()]),
            IntSub(x, y) => self.b.ins().isub(self.values[x.index()], self.values[y.index()]),
            ShiftLeft(x, n) => self.b.ins().ishl_imm_u(self.values[x.index()], i64::from(n)),
            ShiftRight(x, n) => self.b.ins().ushr_imm_u(self.values[x.index()], i64::from(n)),
        }
    }

    fn sign_bit(&self) -> u64 {
        1 << (self.scalar.bits() - 1)
    }

    /// The low bits of `lane` in every lane.
    fn constant(&mut self, ty: Type, lane: u64) -> Value {
        let bytes = &lane.to_le_bytes()[..self.scalar.bytes() as usize];
        let vector: Vec<u8> = bytes.repeat(VECTOR / bytes.len());
        let handle = self.b.func.dfg.constants.insert(ConstantData::from(vector));
        self.b.ins().vconst(ty, handle)
    }

    fn cast(&mut self, ty: Type, value: Value) -> Value {
        self.b.ins().bitcast(ty, MemFlagsData::new(), value)
    }

    fn compare(&mut self, condition: FloatCC, x: Lane, y: Lane) -> Value {
        self.b.ins().fcmp(condition, self.values[x.index()], self.values[y.index()])
    }

    fn pick(&mut self, condition: FloatCC, (p, q): (Lane, Lane), (x, y): (Lane, Lane)) -> Value {
        let holds = self.compare(condition, p, q);
        let mask = self.cast(self.number, holds);
        self.b.ins().bitselect(mask, self.values[x.index()], self.values[y.index()])
    }
}
