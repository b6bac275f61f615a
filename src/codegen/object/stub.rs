//! The few instructions that Cranelift has no operation for: the rounding mode around a call, and what the processor can do.
//!
//! For x86-64 they go through iced's encoder, so that no byte is written by hand; for 64-bit ARM they are fixed words.

use iced_x86::BlockEncoder;
use iced_x86::BlockEncoderOptions;
use iced_x86::Code;
use iced_x86::IcedError;
use iced_x86::Instruction;
use iced_x86::InstructionBlock;
use iced_x86::MemoryOperand;
use iced_x86::Register;

use crate::codegen::emit;
use crate::derive::Rounding;
use crate::diagnostic::Diagnostic;

/// MXCSR with all exceptions masked and denormals honoured.
const MXCSR: u32 = 0x1f80;
/// Its rounding field as "towards +inf".
const MXCSR_UPWARD: u32 = 0b10 << 13;

/// `void stub(void *arguments, void (*body)(void *))` for x86-64: calls the body with a control word of its own and then
/// restores the caller's with all its flags.
///
/// # Errors
/// For a fault of ours.
pub fn in_mode_x86(rounding: Rounding) -> Result<Vec<u8>, Diagnostic> {
    let word = match rounding {
        Rounding::Outward => MXCSR | MXCSR_UPWARD,
        Rounding::Nearest => MXCSR,
    };
    let saved = || MemoryOperand::with_base(Register::RSP);
    let own = || MemoryOperand::with_base_displ(Register::RSP, 4);
    let mut code = Assembler::default();
    // The return address left the stack at 8 modulo 16; these 8 bytes hold both words and align the body's frame.
    code.push(Instruction::with2(Code::Sub_rm64_imm8, Register::RSP, 8))?;
    code.push(Instruction::with1(Code::Stmxcsr_m32, saved()))?;
    code.push(Instruction::with2(Code::Mov_rm32_imm32, own(), word))?;
    code.push(Instruction::with1(Code::Ldmxcsr_m32, own()))?;
    // The first argument stays where it is.
    code.push(Instruction::with1(Code::Call_rm64, Register::RSI))?;
    code.push(Instruction::with1(Code::Ldmxcsr_m32, saved()))?;
    code.push(Instruction::with2(Code::Add_rm64_imm8, Register::RSP, 8))?;
    code.plain(Code::Retnq);
    code.finish()
}

/// The same for 64-bit ARM, where control (FPCR) and flags (FPSR) are two registers.
pub fn in_mode_aarch64(rounding: Rounding) -> Vec<u8> {
    // FPCR.RMode, bits 23:22, is 01 for "towards +inf"; every other field 0: no flushing, no traps.
    let set = match rounding {
        Rounding::Outward => 0xd2a0_080b, // movz x11, #0x40, lsl #16
        Rounding::Nearest => 0xd280_000b, // movz x11, #0
    };
    let words: [u32; 12] = [
        0xa9be_7bfd, // stp x29, x30, [sp, #-32]!
        0x9100_03fd, // mov x29, sp
        0xd53b_4409, // mrs x9, fpcr
        0xd53b_442a, // mrs x10, fpsr
        0xa901_2be9, // stp x9, x10, [sp, #16]
        set,
        0xd51b_440b, // msr fpcr, x11
        0xd63f_0020, // blr x1
        0xa941_2be9, // ldp x9, x10, [sp, #16]
        0xd51b_4409, // msr fpcr, x9
        0xd51b_442a, // msr fpsr, x10
        0xa8c2_7bfd, // ldp x29, x30, [sp], #32
    ];
    let ret: u32 = 0xd65f_03c0; // ret
    words.iter().chain([&ret]).flat_map(|word| word.to_le_bytes()).collect()
}

/// `uint32_t detect(void)`: the highest x86-64 level, 2 to 4, whose instructions the processor has and whose registers the
/// system saves; 0 if it is not even the second. Of each level the parts that our code uses are asked for.
///
/// # Errors
/// For a fault of ours.
pub fn detect() -> Result<Vec<u8>, Diagnostic> {
    // CPUID leaf 1, ecx.
    const SSE3: u32 = 1 << 0;
    const SSSE3: u32 = 1 << 9;
    const FMA: u32 = 1 << 12;
    const SSE41: u32 = 1 << 19;
    const SSE42: u32 = 1 << 20;
    const POPCNT: u32 = 1 << 23;
    const OSXSAVE: u32 = 1 << 27;
    const AVX: u32 = 1 << 28;
    // CPUID leaf 7, ebx.
    const BMI1: u32 = 1 << 3;
    const AVX2: u32 = 1 << 5;
    const BMI2: u32 = 1 << 8;
    const AVX512F: u32 = 1 << 16;
    const AVX512DQ: u32 = 1 << 17;
    const AVX512CD: u32 = 1 << 28;
    const AVX512BW: u32 = 1 << 30;
    const AVX512VL: u32 = 1 << 31;
    // CPUID leaf 0x8000_0001, ecx.
    const LZCNT: u32 = 1 << 5;
    // XCR0: xmm and ymm; opmasks, upper halves of zmm0-15, zmm16-31.
    const YMM_STATE: u32 = 0b110;
    const ZMM_STATE: u32 = 0b1110_0000 | YMM_STATE;

    use Register::*;
    let (level, highest_leaf, features, extended) = (R8D, R9D, R10D, R11D);
    let mut code = Assembler::default();
    // cpuid writes rbx, which belongs to the caller.
    code.push(Instruction::with1(Code::Push_r64, RBX))?;
    code.set(level, 0)?;
    code.cpuid(0)?;
    code.copy(highest_leaf, EAX)?;
    code.at_least(highest_leaf, 1)?;
    code.cpuid(1)?;
    code.copy(features, ECX)?;
    code.all_of(ECX, SSE3 | SSSE3 | SSE41 | SSE42 | POPCNT)?;
    code.set(level, 2)?;

    code.all_of(features, OSXSAVE | AVX | FMA)?;
    // A processor answers a leaf beyond its last with another leaf.
    code.at_least(highest_leaf, 7)?;
    code.cpuid(7)?;
    code.copy(extended, EBX)?;
    code.all_of(EBX, AVX2 | BMI1 | BMI2)?;
    code.cpuid(0x8000_0000)?;
    code.at_least(EAX, 0x8000_0001)?;
    code.cpuid(0x8000_0001)?;
    code.all_of(ECX, LZCNT)?;
    code.set(ECX, 0)?;
    code.plain(Code::Xgetbv);
    code.copy(features, EAX)?;
    code.all_of(EAX, YMM_STATE)?;
    code.set(level, 3)?;

    code.all_of(extended, AVX512F | AVX512DQ | AVX512CD | AVX512BW | AVX512VL)?;
    code.all_of(features, ZMM_STATE)?;
    code.set(level, 4)?;

    code.end_here();
    code.copy(EAX, level)?;
    code.push(Instruction::with1(Code::Pop_r64, RBX))?;
    code.plain(Code::Retnq);
    code.finish()
}

/// Instructions in a row, with one label.
#[derive(Default)]
struct Assembler {
    instructions: Vec<Instruction>,
    /// Where [`Assembler::all_of`] and [`Assembler::at_least`] jump to.
    end: usize,
    jumps: Vec<usize>,
}

/// Addresses of the instructions by their index, apart from where they are encoded (see `widen`).
const INDEX: u64 = 0x1_0000_0000;
const PLACE: u64 = 0x2_0000_0000;

impl Assembler {
    fn push(&mut self, instruction: Result<Instruction, IcedError>) -> Result<(), Diagnostic> {
        let mut instruction = instruction.map_err(|error| emit::internal(&error))?;
        instruction.set_ip(INDEX + self.instructions.len() as u64);
        self.instructions.push(instruction);
        Ok(())
    }

    fn plain(&mut self, code: Code) {
        let mut instruction = Instruction::with(code);
        instruction.set_ip(INDEX + self.instructions.len() as u64);
        self.instructions.push(instruction);
    }

    fn set(&mut self, register: Register, value: u32) -> Result<(), Diagnostic> {
        self.push(Instruction::with2(Code::Mov_r32_imm32, register, value))
    }

    fn copy(&mut self, to: Register, from: Register) -> Result<(), Diagnostic> {
        self.push(Instruction::with2(Code::Mov_r32_rm32, to, from))
    }

    fn cpuid(&mut self, leaf: u32) -> Result<(), Diagnostic> {
        self.set(Register::EAX, leaf)?;
        self.set(Register::ECX, 0)?;
        self.plain(Code::Cpuid);
        Ok(())
    }

    /// To the end unless all bits of the mask are set.
    fn all_of(&mut self, register: Register, mask: u32) -> Result<(), Diagnostic> {
        // The register is asked again for other bits later: the test works on a copy.
        self.copy(Register::EDX, register)?;
        self.push(Instruction::with2(Code::And_rm32_imm32, Register::EDX, mask))?;
        self.push(Instruction::with2(Code::Cmp_rm32_imm32, Register::EDX, mask))?;
        self.jump(Code::Jne_rel32_64)
    }

    /// To the end if the register, as an unsigned number, is less.
    fn at_least(&mut self, register: Register, value: u32) -> Result<(), Diagnostic> {
        self.push(Instruction::with2(Code::Cmp_rm32_imm32, register, value))?;
        self.jump(Code::Jb_rel32_64)
    }

    fn jump(&mut self, code: Code) -> Result<(), Diagnostic> {
        self.jumps.push(self.instructions.len());
        self.push(Instruction::with_branch(code, INDEX))
    }

    fn end_here(&mut self) {
        self.end = self.instructions.len();
    }

    fn finish(mut self) -> Result<Vec<u8>, Diagnostic> {
        for &jump in &self.jumps {
            self.instructions[jump].set_near_branch64(INDEX + self.end as u64);
        }
        let block = InstructionBlock::new(&self.instructions, PLACE);
        let encoded = BlockEncoder::encode(64, block, BlockEncoderOptions::NONE);
        Ok(encoded.map_err(|error| emit::internal(&error))?.code_buffer)
    }
}
