//! The exported functions: which level the processor has, and the way from the C calling convention to a body.

use cranelift_codegen::Context;
use cranelift_codegen::ir::AbiParam;
use cranelift_codegen::ir::InstBuilder;
use cranelift_codegen::ir::MemFlagsData;
use cranelift_codegen::ir::Signature;
use cranelift_codegen::ir::StackSlotData;
use cranelift_codegen::ir::StackSlotKind;
use cranelift_codegen::ir::TrapCode;
use cranelift_codegen::ir::Value;
use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::types;
use cranelift_codegen::isa::CallConv;
use cranelift_frontend::FunctionBuilder;
use cranelift_frontend::FunctionBuilderContext;
use cranelift_module::FuncId;
use cranelift_module::Linkage;
use cranelift_module::Module;
use cranelift_object::ObjectModule;

use crate::codegen::object::Kernel;
use crate::codegen::object::Kind;
use crate::codegen::object::Target;
use crate::codegen::object::body::Layout;
use crate::codegen::object::body::record;
use crate::codegen::object::declare;
use crate::codegen::object::define_data;
use crate::codegen::object::fault;
use crate::codegen::object::stub;
use crate::diagnostic::Diagnostic;

/// What `<module>_level` says on 64-bit ARM.
const AARCH64: i64 = 8;

/// Set in the cached word once the level is known, since no level is 0.
const KNOWN: i64 = 1 << 8;

/// Of the stubs that set the rounding mode: the record, the body.
pub fn in_mode_signature() -> Signature {
    signature(2, false)
}

/// `count` pointers or sizes in; a 32-bit word out, or nothing.
fn signature(count: usize, word: bool) -> Signature {
    let mut signature = Signature::new(CallConv::SystemV);
    signature.params = vec![AbiParam::new(types::I64); count];
    signature.returns = vec![AbiParam::new(types::I32); usize::from(word)];
    signature
}

/// Defines `uint32_t <module>_level(void)`: the highest of the target's levels that the processor has, or 0.
///
/// # Errors
/// If the name is taken.
pub fn level(module: &mut ObjectModule, name: &str, target: &Target) -> Result<FuncId, Diagnostic> {
    let id = declare(module, name, Linkage::Export, &signature(0, true))?;
    let mut context = Context::new();
    context.func.signature = signature(0, true);
    let levels = match target {
        Target::X86_64(levels) => levels,
        Target::Aarch64 => {
            define(module, id, context, |_, b| {
                let level = b.ins().iconst(types::I32, AARCH64);
                b.ins().return_(&[level]);
            })?;
            return Ok(id);
        }
    };
    let detect = declare(module, "imp.detect", Linkage::Local, &signature(0, true))?;
    module.define_function_bytes(detect, 16, &stub::detect()?, &[]).map_err(fault)?;
    let cache = module.declare_data("imp.level", Linkage::Local, true, false).map_err(fault)?;
    define_data(module, cache, vec![0; 4], 4)?;

    let levels: Vec<i64> = levels.iter().map(|level| level.number().into()).collect();
    define(module, id, context, |module, b| {
        let cache = module.declare_data_in_func(cache, b.func);
        let cache = b.ins().symbol_value(types::I64, cache);
        let known = b.create_block();
        let unknown = b.create_block();
        b.append_block_param(known, types::I32);
        // Threads that come here at once all find, and store, the same word.
        let cached = b.ins().load(types::I32, MemFlagsData::trusted(), cache, 0);
        b.ins().brif(cached, known, &[cached.into()], unknown, &[]);

        b.switch_to_block(unknown);
        let detect = module.declare_func_in_func(detect, b.func);
        let call = b.ins().call(detect, &[]);
        let found = b.inst_results(call)[0];
        let mut best = b.ins().iconst(types::I32, KNOWN);
        for &level in &levels {
            let has = b.ins().icmp_imm_u(IntCC::UnsignedGreaterThanOrEqual, found, level);
            let this = b.ins().iconst(types::I32, KNOWN | level);
            best = b.ins().select(has, this, best);
        }
        b.ins().store(MemFlagsData::trusted(), best, cache, 0);
        b.ins().jump(known, &[best.into()]);

        b.switch_to_block(known);
        let word = b.block_params(known)[0];
        let level = b.ins().band_imm_u(word, KNOWN - 1);
        b.ins().return_(&[level]);
    })?;
    Ok(id)
}

/// Defines an exported function of a routine.
///
/// # Errors
/// If the name is taken.
#[expect(clippy::too_many_arguments, reason = "each is one part of the function")]
pub fn entry(
    module: &mut ObjectModule,
    symbol: &str,
    layout: Layout,
    kind: Kind,
    level: FuncId,
    kernels: &[Kernel],
    in_mode: FuncId,
    body: FuncId,
) -> Result<(), Diagnostic> {
    // Which field of the record each argument is.
    let fields: &[i32] = match (layout, kind) {
        (Layout::Packets, _) | (_, Kind::Points) => {
            &[record::INPUTS, record::PARAMETERS, record::OUTPUTS, record::COUNT]
        }
        (_, Kind::Boxes) => &[record::INPUTS, record::PARAMETERS, record::OUTPUTS, record::VERDICTS, record::COUNT],
    };
    let signature = signature(fields.len(), false);
    let id = declare(module, symbol, Linkage::Export, &signature)?;
    let mut context = Context::new();
    context.func.signature = signature;
    define(module, id, context, |module, b| {
        let entry = b.current_block().expect("the entry block is current");
        let slot = b.create_sized_stack_slot(StackSlotData::new(StackSlotKind::ExplicitSlot, record::SIZE, 3));
        for (i, &field) in fields.iter().enumerate() {
            let argument = b.block_params(entry)[i];
            b.ins().stack_store(types::I64, argument, slot, field);
        }
        let kernel = choose(module, b, level, kernels);
        b.ins().stack_store(types::I64, kernel, slot, record::KERNEL);
        let record = b.ins().stack_addr(types::I64, slot, 0);
        let body = module.declare_func_in_func(body, b.func);
        let body = b.ins().func_addr(types::I64, body);
        let in_mode = module.declare_func_in_func(in_mode, b.func);
        b.ins().call(in_mode, &[record, body]);
        b.ins().return_(&[]);
    })
}

/// The address of the kernel for this processor.
fn choose(module: &mut ObjectModule, b: &mut FunctionBuilder, level: FuncId, kernels: &[Kernel]) -> Value {
    let level = module.declare_func_in_func(level, b.func);
    let call = b.ins().call(level, &[]);
    let level = b.inst_results(call)[0];
    b.ins().trapz(level, TrapCode::unwrap_user(1));
    let mut chosen = None;
    for kernel in kernels {
        let function = module.declare_func_in_func(kernel.function, b.func);
        let address = b.ins().func_addr(types::I64, function);
        let address = b.ins().iadd_imm_s(address, kernel.start as i64);
        chosen = Some(match chosen {
            None => address,
            Some(lower) => {
                let has = b.ins().icmp_imm_u(IntCC::UnsignedGreaterThanOrEqual, level, i64::from(kernel.level));
                b.ins().select(has, address, lower)
            }
        });
    }
    chosen.expect("a target has a kernel")
}

fn define(
    module: &mut ObjectModule,
    id: FuncId,
    mut context: Context,
    body: impl FnOnce(&mut ObjectModule, &mut FunctionBuilder),
) -> Result<(), Diagnostic> {
    let mut builder_context = FunctionBuilderContext::new();
    let mut b = FunctionBuilder::new(&mut context.func, &mut builder_context);
    let entry = b.create_block();
    b.append_block_params_for_function_params(entry);
    b.switch_to_block(entry);
    body(module, &mut b);
    b.seal_all_blocks();
    b.finalize(module.isa().frontend_config());
    module.define_function(id, &mut context).map_err(fault)
}
