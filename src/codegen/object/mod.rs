//! Relocatable objects: kernels for several levels of a processor, and around them functions of the C calling convention that
//! take rows, columns or packets.
//!
//! A routine `S` becomes three exported functions:
//!
//! - `S` on rows: `boxes[count][variables][2]` to `enclosures[count][outputs][2]` and `verdicts[count][outputs]`, or
//!   `points[count][variables]` to `values[count][outputs]`;
//! - `S_columns`: the same arrays transposed, `boxes[variables][2][count]` and so on;
//! - `S_packets`: the layout of `kernel::Kernel::run`.
//!
//! Each asks for the level of the processor (`entry`), puts its arguments into a record, and calls a body with that record in
//! the kernel's rounding mode (`stub`); the body moves rows through packets on the stack and calls the kernel (`body`).
//! What is exported allocates nothing, keeps no state but the level found, and may run on any number of threads.
//!
//! The caller's control word and its flags are as before when a function returns, and no result depends on them. NaN is one
//! value here: its sign and payload differ between processors.

mod body;
mod entry;
mod lanes;
mod stub;

use cranelift_codegen::Context;
use cranelift_codegen::ir::FuncRef;
use cranelift_codegen::ir::GlobalValue;
use cranelift_codegen::ir::Signature;
use cranelift_codegen::isa::CallConv;
use cranelift_codegen::isa::OwnedTargetIsa;
use cranelift_module::DataDescription;
use cranelift_module::DataId;
use cranelift_module::FuncId;
use cranelift_module::Linkage;
use cranelift_module::Module;
use cranelift_module::ModuleError;
use cranelift_module::default_libcall_names;
use cranelift_object::ObjectBuilder;
use cranelift_object::ObjectModule;

use crate::codegen::emit as clif;
use crate::codegen::emit::Machine;
use crate::codegen::widen;
use crate::codegen::widen::Registers;
use crate::derive::LaneProgram;
use crate::derive::Precision;
use crate::derive::Rounding;
use crate::diagnostic::Diagnostic;
use body::Layout;
use body::Shape;

/// What the exported word `Unit::abi` holds: the version of this interface.
pub const ABI_VERSION: u32 = 1;

/// Stack of one kernel at most. With what the code around it takes ([`body::MAX_BUFFER`]) a call stays below 1 MiB.
const MAX_KERNEL_FRAME: u32 = 512 << 10;

/// A micro-architecture level of x86-64, as the psABI numbers them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Level {
    /// SSE4.2, registers of 128 bits. Fused operations are those of the C library (`fma`, `fmaf`).
    V2,
    /// AVX2 and FMA, registers of 256 bits.
    V3,
    /// AVX-512, registers of 512 bits.
    V4,
}

impl Level {
    /// Its number: 2, 3 or 4.
    pub fn number(self) -> u32 {
        match self {
            Level::V2 => 2,
            Level::V3 => 3,
            Level::V4 => 4,
        }
    }

    fn machine(self) -> Machine {
        match self {
            Level::V2 => Machine::Sse42,
            Level::V3 | Level::V4 => Machine::Avx2,
        }
    }

    /// The registers to widen kernels for, best first.
    fn registers(self) -> &'static [Registers] {
        match self {
            Level::V2 => &[],
            Level::V3 => &[Registers::Ymm],
            Level::V4 => &[Registers::Zmm, Registers::Ymm],
        }
    }
}

/// The processor that an object is for. All objects are position-independent ELF files for Linux.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Target {
    /// x86-64 with code for each of these levels: ascending, at least one. The highest that the processor has is chosen
    /// at the first call; if it has none of them, a call ends the process with an illegal instruction.
    X86_64(Vec<Level>),
    /// 64-bit ARM, any processor.
    Aarch64,
}

/// What a routine computes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// Boxes in, enclosures and verdicts out.
    Boxes,
    /// Points in, values out.
    Points,
}

/// A program and how it is exported.
#[derive(Debug, Clone)]
pub struct Routine {
    /// The C name of the function on rows.
    pub symbol: String,
    /// Of enclosures only ([`Kind::Boxes`]) or values only ([`Kind::Points`]).
    pub program: LaneProgram,
    /// The mode in which the program runs. With [`Rounding::Nearest`] the verdicts on rows and columns are 0.
    pub rounding: Rounding,
    /// Coordinates of a box or a point.
    pub variables: usize,
    /// Enclosures or values of one box or point.
    pub outputs: usize,
    pub kind: Kind,
    /// The parameters of a caller that gives none: lower and upper end of each, or its value. Rounded to the program's
    /// precision, outward or to the nearest.
    pub defaults: Vec<f64>,
}

/// What one object holds.
#[derive(Debug, Clone)]
pub struct Unit {
    /// The prefix of `<module>_level`.
    pub module: String,
    pub target: Target,
    /// The name of a word of read-only data, which shows what interface the object was made for.
    pub abi: String,
    pub routines: Vec<Routine>,
}

/// Compiles a unit to the bytes of a relocatable object. The same unit gives the same bytes.
///
/// # Errors
/// `KERNEL_TOO_LARGE` if a program has too many operations or needs too much stack; `INTERNAL` for a fault of ours or of the
/// caller: names that occur twice, or counts that do not match a program.
pub fn emit(unit: &Unit) -> Result<Vec<u8>, Diagnostic> {
    let mut builder = Builder::new(unit)?;
    for routine in &unit.routines {
        builder.routine(routine)?;
    }
    builder.module.finish().emit().map_err(|error| clif::internal(&error))
}

/// What is guarded at the end of a stack, at least.
const PAGE: u32 = 4 << 10;

/// What a body refers to besides its record.
struct Parts {
    /// The uniforms of a caller that gives no parameters.
    defaults: Option<GlobalValue>,
    /// To call before the kernel.
    probe: Option<FuncRef>,
}

/// A compiled kernel of the object.
struct Kernel {
    function: FuncId,
    /// Where the code starts; widened code has its constants first.
    start: usize,
    /// From which level on it is called.
    level: u32,
    /// Bytes of stack.
    frame: u32,
}

struct Builder {
    module: ObjectModule,
    target: Target,
    /// Finds the level; x86-64 only.
    level: FuncId,
    /// Calls in the rounding mode of proofs, and of points.
    upward: FuncId,
    nearest: FuncId,
}

impl Builder {
    fn new(unit: &Unit) -> Result<Self, Diagnostic> {
        let lowest = match &unit.target {
            Target::X86_64(levels) if levels.is_empty() || !levels.is_sorted() => {
                return Err(clif::internal(&"the levels of an object are not ascending"));
            }
            // Whatever is chosen at run time, it runs on every processor that has one of the levels.
            Target::X86_64(_) => Machine::Sse42,
            Target::Aarch64 => Machine::Aarch64,
        };
        let isa = clif::isa_around(lowest)?;
        let builder = ObjectBuilder::new(isa, unit.module.as_str(), default_libcall_names());
        let mut builder = builder.map_err(fault)?;
        // A linker that collects garbage then drops the routines that nobody calls.
        builder.per_function_section(true);
        let mut module = ObjectModule::new(builder);

        let abi = module.declare_data(&unit.abi, Linkage::Export, false, false).map_err(fault)?;
        define_data(&mut module, abi, ABI_VERSION.to_le_bytes().to_vec(), 4)?;
        let signature = entry::in_mode_signature();
        let upward = declare(&mut module, "imp.upward", Linkage::Local, &signature)?;
        let nearest = declare(&mut module, "imp.nearest", Linkage::Local, &signature)?;
        for (function, rounding) in [(upward, Rounding::Outward), (nearest, Rounding::Nearest)] {
            let bytes = match unit.target {
                Target::X86_64(_) => stub::in_mode_x86(rounding)?,
                Target::Aarch64 => stub::in_mode_aarch64(rounding),
            };
            module.define_function_bytes(function, 16, &bytes, &[]).map_err(fault)?;
        }
        let level = entry::level(&mut module, &format!("{}_level", unit.module), &unit.target)?;
        Ok(Self { module, target: unit.target.clone(), level, upward, nearest })
    }

    fn routine(&mut self, routine: &Routine) -> Result<(), Diagnostic> {
        let shape = Shape::of(routine)?;
        let kernels = self.kernels(routine)?;
        let defaults = self.defaults(routine)?;
        let probe = self.probe(routine, &kernels)?;
        let in_mode = match routine.rounding {
            Rounding::Outward => self.upward,
            Rounding::Nearest => self.nearest,
        };
        for layout in [Layout::Rows, Layout::Columns, Layout::Packets] {
            let symbol = format!("{}{}", routine.symbol, layout.suffix());
            let signature = body::signature();
            let body = declare(&mut self.module, &format!("{symbol}.body"), Linkage::Local, &signature)?;
            let mut context = Context::new();
            let parts = Parts {
                defaults: defaults.map(|data| self.module.declare_data_in_func(data, &mut context.func)),
                probe: probe.map(|function| self.module.declare_func_in_func(function, &mut context.func)),
            };
            body::define(&shape, layout, parts, self.module.isa(), &mut context);
            self.define(body, &mut context)?;
            entry::entry(&mut self.module, &symbol, layout, routine.kind, self.level, &kernels, in_mode, body)?;
        }
        Ok(())
    }

    fn define(&mut self, function: FuncId, context: &mut Context) -> Result<(), Diagnostic> {
        self.module.define_function(function, context).map_err(fault)
    }

    /// The kernels of a routine, lowest level first.
    fn kernels(&mut self, routine: &Routine) -> Result<Vec<Kernel>, Diagnostic> {
        let program = &routine.program;
        let mut kernels = Vec::new();
        match self.target.clone() {
            Target::X86_64(levels) => {
                for level in levels {
                    let isa = clif::isa_for(level.machine(), program)?;
                    let name = format!("{}.v{}", routine.symbol, level.number());
                    let (code, start) = code(program, &isa, level.registers())?;
                    kernels.push(self.kernel(&name, &code, start, level.number())?);
                }
            }
            Target::Aarch64 => {
                let isa = clif::isa_for(Machine::Aarch64, program)?;
                let (code, start) = code(program, &isa, &[])?;
                let name = format!("{}.neon", routine.symbol);
                kernels.push(self.kernel(&name, &code, start, 0)?);
            }
        }
        Ok(kernels)
    }

    fn kernel(&mut self, name: &str, code: &clif::Code, start: usize, level: u32) -> Result<Kernel, Diagnostic> {
        let function = declare(&mut self.module, name, Linkage::Local, &clif::signature())?;
        // The alignment of a cache line is that of the widest constant, too.
        self.module.define_function_bytes(function, 64, &code.bytes, &code.relocations).map_err(fault)?;
        Ok(Kernel { function, start, level, frame: code.frame })
    }

    /// A function that touches as much stack as the kernels of a routine take, page by page, which the kernels themselves do
    /// not do; none if they cannot pass over a page.
    fn probe(&mut self, routine: &Routine, kernels: &[Kernel]) -> Result<Option<FuncId>, Diagnostic> {
        let frame = kernels.iter().map(|kernel| kernel.frame).max().unwrap_or(0);
        if frame < PAGE / 2 {
            return Ok(None);
        }
        let signature = Signature::new(CallConv::SystemV);
        let probe = declare(&mut self.module, &format!("{}.probe", routine.symbol), Linkage::Local, &signature)?;
        let mut context = Context::new();
        body::define_probe(frame + PAGE, self.module.isa(), &mut context);
        self.define(probe, &mut context)?;
        Ok(Some(probe))
    }

    /// The parameters of a caller that gives none, as the kernel takes them.
    fn defaults(&mut self, routine: &Routine) -> Result<Option<DataId>, Diagnostic> {
        if routine.defaults.is_empty() {
            return Ok(None);
        }
        let name = format!("{}.defaults", routine.symbol);
        let data = self.module.declare_data(&name, Linkage::Local, false, false).map_err(fault)?;
        let uniforms = uniforms(routine.kind, &routine.defaults, routine.program.precision);
        define_data(&mut self.module, data, uniforms, 16)?;
        Ok(Some(data))
    }
}

/// The code of a kernel in the first of these registers for which it can be widened, else in those of 128 bits.
fn code(
    program: &LaneProgram,
    isa: &OwnedTargetIsa,
    registers: &[Registers],
) -> Result<(clif::Code, usize), Diagnostic> {
    for &registers in registers {
        let narrow = clif::compile(program, isa, registers.bytes())?;
        // A widened frame grows with the registers.
        let frame = narrow.frame * (registers.bytes() / clif::VECTOR) as u32;
        if frame > MAX_KERNEL_FRAME {
            continue;
        }
        if let Some(wide) = widen::widen(&narrow.bytes, registers) {
            return Ok((clif::Code { bytes: wide.bytes, frame, ..narrow }, wide.entry));
        }
    }
    let code = clif::compile(program, isa, clif::VECTOR)?;
    if code.frame > MAX_KERNEL_FRAME {
        return Err(clif::too_large(program));
    }
    Ok((code, 0))
}

/// Parameters as the ABI has them to uniforms as kernels take them: of an interval the negated lower end and the upper end.
fn uniforms(kind: Kind, parameters: &[f64], precision: Precision) -> Vec<u8> {
    let upward = |value: f64| match precision {
        Precision::Single => crate::interval::round::f32_up(value).into(),
        Precision::Double => value,
    };
    let values: Vec<f64> = match kind {
        Kind::Points => parameters.to_vec(),
        Kind::Boxes => parameters.as_chunks::<2>().0.iter().flat_map(|&[lo, hi]| [upward(-lo), upward(hi)]).collect(),
    };
    match precision {
        Precision::Single => values.iter().flat_map(|&value| (value as f32).to_le_bytes()).collect(),
        Precision::Double => values.iter().flat_map(|value| value.to_le_bytes()).collect(),
    }
}

/// What went wrong in a module: mostly our fault.
fn fault(error: ModuleError) -> Diagnostic {
    clif::internal(&error)
}

fn declare(
    module: &mut ObjectModule,
    name: &str,
    linkage: Linkage,
    signature: &Signature,
) -> Result<FuncId, Diagnostic> {
    module.declare_function(name, linkage, signature).map_err(fault)
}

fn define_data(module: &mut ObjectModule, data: DataId, bytes: Vec<u8>, align: u64) -> Result<(), Diagnostic> {
    let mut description = DataDescription::new();
    description.define(bytes.into_boxed_slice());
    description.set_align(align);
    module.define_data(data, &description).map_err(fault)
}
