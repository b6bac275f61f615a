//! 128-bit machine code re-encoded for 256-bit and 512-bit registers.
//!
//! Cranelift selects 128-bit vector instructions only, which leaves half of an AVX2 machine idle and three quarters of an
//! AVX-512 one. A kernel is a leaf function whose vector instructions all work lane by lane, so the same instructions on
//! wider registers compute several vectors at once, each lane bit for bit as before. For 256 bits every instruction has
//! its like (`table`); for 512 bits masks live in registers of their own (`masks`). What else changes is where data lies:
//! constants are repeated, and the stack frame, with its spilled vectors, grows as the registers do.
//!
//! Whatever instruction is not known to be lane-wise makes the pass decline, and the caller uses narrower code.

mod dead;
mod masks;
mod slots;
mod table;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use iced_x86::Code;
use iced_x86::Decoder;
use iced_x86::DecoderOptions;
use iced_x86::Encoder;
use iced_x86::Instruction;
use iced_x86::Mnemonic;
use iced_x86::OpKind;
use iced_x86::Register;

use crate::codegen::emit::MAX_FRAME;

/// Where the old code is thought to start, and the new constants, followed by the new code.
const OLD: u64 = 0x1_0000_0000;
const NEW: u64 = 0x2_0000_0000;

/// Bytes of a register in the old code.
const NARROW: usize = 16;

/// The registers that code is re-encoded for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Registers {
    /// 256 bits: AVX2.
    Ymm,
    /// 512 bits: the x86-64-v4 level, AVX-512 with its extensions F, VL, DQ and BW.
    Zmm,
}

impl Registers {
    /// Whether this machine has them, and the system saves them.
    #[cfg(target_arch = "x86_64")]
    pub fn available(self) -> bool {
        match self {
            Self::Ymm => std::arch::is_x86_feature_detected!("avx2"),
            Self::Zmm => {
                std::arch::is_x86_feature_detected!("avx512f")
                    && std::arch::is_x86_feature_detected!("avx512vl")
                    && std::arch::is_x86_feature_detected!("avx512dq")
                    && std::arch::is_x86_feature_detected!("avx512bw")
            }
        }
    }

    #[cfg(not(target_arch = "x86_64"))]
    pub fn available(self) -> bool {
        false
    }

    /// The size of one register: what one pass of the loop covers.
    pub fn bytes(self) -> usize {
        match self {
            Self::Ymm => 32,
            Self::Zmm => 64,
        }
    }

    /// How many old registers one of these is.
    fn copies(self) -> usize {
        self.bytes() / NARROW
    }

    /// The register that takes the place of an old one.
    fn of(self, register: Register) -> Option<Register> {
        let first = match self {
            Self::Ymm => Register::YMM0,
            Self::Zmm => Register::ZMM0,
        };
        register.is_xmm().then(|| first + (register as u32 - Register::XMM0 as u32))
    }
}

/// Re-encoded code: constants first, then the function.
pub struct Wide {
    pub bytes: Vec<u8>,
    /// Where the function starts.
    pub entry: usize,
}

/// An instruction of the new code.
#[derive(Clone, Copy)]
struct Step {
    instruction: Instruction,
    /// It does nothing but write its first operand, and goes if nobody reads that.
    optional: bool,
}

impl From<Instruction> for Step {
    fn from(instruction: Instruction) -> Self {
        Self { instruction, optional: false }
    }
}

/// Widens a kernel emitted with a stride of `registers.bytes()`. `code` is the function followed by its constants; `None`
/// if it holds anything that is not known to be lane-wise, or needs more stack in wide registers than a kernel may take.
pub fn widen(code: &[u8], registers: Registers) -> Option<Wide> {
    let mut old = decode(code)?;
    if registers == Registers::Zmm {
        slots::to_registers(&mut old);
    }
    let frame = Frame::new(&old, registers);
    let targets = targets(&old);
    let mut pool = Pool { code, copies: registers.copies(), offsets: BTreeMap::new(), bytes: Vec::new() };
    let mut masks = masks::Masks::default();
    let mut uniforms = Uniforms::default();
    let mut steps: Vec<Step> = Vec::with_capacity(old.len() + old.len() / 4);
    for Old { instruction, vector } in &old {
        let first = steps.len();
        let target = targets.binary_search(&instruction.ip()).is_ok();
        if target {
            masks.forget();
            uniforms.forget();
        }
        let uniform = uniforms.follow(instruction, registers);
        match (uniform, vector, registers) {
            (Some(new), ..) => {
                masks.overwritten(instruction.op0_register());
                steps.push(new.into());
            }
            (None, false, _) => {
                if instruction.mnemonic() == Mnemonic::Ret {
                    // The upper halves must be clean when code without VEX runs again.
                    steps.push(Instruction::with(Code::VEX_Vzeroupper).into());
                }
                if Frame::changes(instruction) {
                    frame.change(instruction, &mut steps)?;
                } else {
                    steps.push(scalar(instruction)?.into());
                }
            }
            (None, true, Registers::Ymm) => steps.push(lanewise(instruction, registers)?.into()),
            (None, true, Registers::Zmm) => masks.widen(instruction, &mut steps)?,
        }
        for (i, step) in steps[first..].iter_mut().enumerate() {
            relocate(&mut step.instruction, &mut pool)?;
            // Jumps find their targets by the old addresses; 0 is none.
            step.instruction.set_ip(if i == 0 { instruction.ip() } else { 0 });
            step.optional &= !target;
        }
    }
    if registers == Registers::Zmm {
        dead::remove(&mut steps, &targets);
    }
    let entry = pool.bytes.len();
    let mut bytes = pool.bytes;
    bytes.extend(encode(&steps, &targets, NEW + entry as u64)?);
    Some(Wide { bytes, entry })
}

/// The machine code of the steps from an address on. `targets` are the old addresses, sorted, that are jumped to.
fn encode(steps: &[Step], targets: &[u64], start: u64) -> Option<Vec<u8>> {
    let mut encoder = Encoder::try_with_capacity(64, 8 * steps.len()).ok()?;
    let mut places: Vec<Option<usize>> = vec![None; targets.len()];
    // Where each jump ends, in its displacement of four bytes, and its target.
    let mut jumps: Vec<(usize, usize)> = Vec::new();
    let mut end = 0;
    for Step { mut instruction, .. } in steps.iter().copied() {
        let ip = start + end as u64;
        if let Ok(target) = targets.binary_search(&instruction.ip()) {
            places[target] = Some(end);
        }
        if instruction.op0_kind() == OpKind::NearBranch64 {
            if !matches!(instruction.code(), Code::Je_rel32_64 | Code::Jne_rel32_64 | Code::Jmp_rel32_64) {
                return None;
            }
            let target = targets.binary_search(&instruction.near_branch_target()).ok()?;
            instruction.set_near_branch64(ip);
            end += encoder.encode(&instruction, ip).ok()?;
            jumps.push((end, target));
        } else {
            end += encoder.encode(&instruction, ip).ok()?;
        }
    }
    let mut bytes = encoder.take_buffer();
    for (end, target) in jumps {
        let distance = i32::try_from(places[target]? as i64 - end as i64).ok()?;
        bytes.get_mut(end - 4..end)?.copy_from_slice(&distance.to_le_bytes());
    }
    Some(bytes)
}

struct Old {
    instruction: Instruction,
    /// In VEX encoding, or a move of a whole vector, which Cranelift writes without.
    vector: bool,
}

/// The instructions up to the last return. A kernel returns once, at its end.
fn decode(code: &[u8]) -> Option<Vec<Old>> {
    let mut decoder = Decoder::with_ip(64, code, OLD, DecoderOptions::NONE);
    let mut instructions = Vec::with_capacity(code.len() / 5);
    while decoder.can_decode() {
        let start = decoder.position();
        let instruction = decoder.decode();
        if instruction.is_invalid() {
            return None;
        }
        let vector = matches!(code[start], 0xc4 | 0xc5) || is_move(instruction.mnemonic());
        instructions.push(Old { instruction, vector });
        if instruction.mnemonic() == Mnemonic::Ret {
            return Some(instructions);
        }
    }
    None
}

/// Where jumps go, sorted.
fn targets(old: &[Old]) -> Vec<u64> {
    let jumps = old.iter().filter(|old| old.instruction.op0_kind() == OpKind::NearBranch64);
    let mut targets: Vec<u64> = jumps.map(|old| old.instruction.near_branch_target()).collect();
    targets.sort_unstable();
    targets.dedup();
    targets
}

/// The old code's constants, each repeated to fill a register.
struct Pool<'c> {
    code: &'c [u8],
    copies: usize,
    /// From the old offset to the new one.
    offsets: BTreeMap<usize, usize>,
    bytes: Vec<u8>,
}

impl Pool<'_> {
    fn repeated(&mut self, address: u64) -> Option<u64> {
        let old = usize::try_from(address.checked_sub(OLD)?).ok()?;
        let vector = self.code.get(old..old + NARROW)?;
        let new = *self.offsets.entry(old).or_insert_with(|| {
            let offset = self.bytes.len();
            (0..self.copies).for_each(|_| self.bytes.extend_from_slice(vector));
            offset
        });
        Some(NEW + new as u64)
    }
}

/// The registers that hold one number, the same for all lanes, in their lowest lane: bit `i` for `xmm i`. Such a number is
/// loaded to be broadcast, and where its load is no operand of the broadcast, it passes through a register.
#[derive(Default)]
struct Uniforms(u32);

impl Uniforms {
    /// Where a jump may arrive, nothing is known.
    fn forget(&mut self) {
        self.0 = 0;
    }

    /// The new instruction if this is a load of such a number, which stays as it is, or a broadcast of one.
    fn follow(&mut self, old: &Instruction, registers: Registers) -> Option<Instruction> {
        use Mnemonic::*;
        if old.op0_kind() != OpKind::Register || !old.op0_register().is_xmm() {
            return None;
        }
        let bit = |register: Register| 1 << ((register as u32 - Register::XMM0 as u32) % 32);
        let holds =
            old.op1_kind() == OpKind::Register && old.op1_register().is_xmm() && self.0 & bit(old.op1_register()) != 0;
        self.0 &= !bit(old.op0_register());
        let new = match old.mnemonic() {
            // Inputs and spilled vectors are never read this way.
            Vmovss | Vmovsd if old.op1_kind() == OpKind::Memory && !old.is_ip_rel_memory_operand() => {
                self.0 |= bit(old.op0_register());
                *old
            }
            Vbroadcastss if holds => {
                let codes = (Code::VEX_Vbroadcastss_ymm_xmm, Code::EVEX_Vbroadcastss_zmm_k1z_xmmm32);
                broadcast(old, registers, codes)?
            }
            // Twice the low half, in Cranelift's words.
            Vpshufd if holds && old.immediate8() == 0x44 => {
                let codes = (Code::VEX_Vbroadcastsd_ymm_xmm, Code::EVEX_Vbroadcastsd_zmm_k1z_xmmm64);
                broadcast(old, registers, codes)?
            }
            mnemonic if holds && is_move(mnemonic) => {
                self.0 |= bit(old.op0_register());
                return None;
            }
            _ => return None,
        };
        Some(new)
    }
}

/// The lowest lane of the second operand in all lanes of the first.
fn broadcast(old: &Instruction, registers: Registers, (ymm, zmm): (Code, Code)) -> Option<Instruction> {
    let code = match registers {
        Registers::Ymm => ymm,
        Registers::Zmm => zmm,
    };
    Instruction::with2(code, registers.of(old.op0_register())?, old.op1_register()).ok()
}

/// Turns the place of a constant or in the frame into where it lies now.
fn relocate(new: &mut Instruction, pool: &mut Pool) -> Option<()> {
    if !(0..new.op_count()).any(|i| new.op_kind(i) == OpKind::Memory) {
        return Some(());
    }
    if new.is_ip_rel_memory_operand() {
        let address = pool.repeated(new.ip_rel_memory_address())?;
        new.set_memory_displacement64(address);
    } else if new.memory_base() == Register::RSP {
        if new.memory_index() != Register::None {
            return None;
        }
        new.set_memory_displacement64(new.memory_displacement64().checked_mul(pool.copies as u64)?);
        // The encoder picks the short form where the new offset still fits it.
        new.set_memory_displ_size(8);
    } else if new.memory_base() == Register::RBP {
        return None;
    }
    Some(())
}

/// A vector instruction in its wider form, if it works lane by lane. What gives or takes a mask has the form of its kind,
/// but not the operands, in 512 bits.
fn lanewise(old: &Instruction, registers: Registers) -> Option<Instruction> {
    use Mnemonic::*;
    if is_move(old.mnemonic()) {
        return moved(old, registers);
    }
    let forms = table::forms(old.mnemonic())?;
    match old.mnemonic() {
        // By a fixed number of bits only: a count in a register is read from 128 bits in every width, but none is used.
        Vpslld | Vpsllq | Vpsrld | Vpsrlq if old.op2_kind() != OpKind::Immediate8 => return None,
        // One number, to all lanes. Constants are repeated as whole vectors, so it is none of them.
        Vbroadcastss | Vmovddup if old.op1_kind() != OpKind::Memory || old.is_ip_rel_memory_operand() => return None,
        // The high half of the immediate operand is a number of binary places in the 512-bit form.
        Vroundps | Vroundpd if old.immediate8() > 0xf => return None,
        _ => {}
    }
    let mut new = *old;
    new.set_code(match registers {
        Registers::Ymm => forms.ymm,
        Registers::Zmm => forms.zmm,
    });
    renamed(new, registers)
}

/// The instruction with wide registers in the places of narrow ones, its only registers.
fn renamed(mut new: Instruction, registers: Registers) -> Option<Instruction> {
    for i in 0..new.op_count() {
        if new.op_kind(i) == OpKind::Register {
            new.set_op_register(i, registers.of(new.op_register(i))?);
        }
    }
    Some(new)
}

/// Spills, reloads and copies, which Cranelift writes without VEX, and inputs and outputs.
fn is_move(mnemonic: Mnemonic) -> bool {
    use Mnemonic::*;
    matches!(
        mnemonic,
        Movups | Movupd | Movdqu | Movaps | Movapd | Movdqa | Vmovups | Vmovupd | Vmovdqu | Vmovaps | Vmovapd | Vmovdqa
    )
}

fn moved(old: &Instruction, registers: Registers) -> Option<Instruction> {
    let mut new = *old;
    new.set_code(match (registers, old.op0_kind() == OpKind::Memory) {
        (Registers::Ymm, false) => Code::VEX_Vmovups_ymm_ymmm256,
        (Registers::Ymm, true) => Code::VEX_Vmovups_ymmm256_ymm,
        (Registers::Zmm, false) => Code::EVEX_Vmovups_zmm_k1z_zmmm512,
        (Registers::Zmm, true) => Code::EVEX_Vmovups_zmmm512_k1z_zmm,
    });
    renamed(new, registers)
}

/// The stack frame, which grows with all that lies in it.
struct Frame {
    registers: Registers,
    /// Spilled vectors lie at multiples of their size: a vector across two cache lines takes twice as long. This takes a
    /// frame that is made once, right after its caller's end was kept in `rbp`, and given up once.
    aligned: bool,
}

impl Frame {
    fn new(old: &[Old], registers: Registers) -> Self {
        let writes =
            |old: &Old, register| old.instruction.op_count() == 2 && old.instruction.op0_register() == register;
        let keeps = |old: &Old| {
            let (mnemonic, from) = (old.instruction.mnemonic(), old.instruction.op1_register());
            mnemonic == Mnemonic::Mov && writes(old, Register::RBP) && from == Register::RSP
        };
        let makes = |old: &Old| Self::changes(&old.instruction) && old.instruction.mnemonic() == Mnemonic::Sub;
        let count = |test: &dyn Fn(&Old) -> bool| old.iter().filter(|old| test(old)).count();
        let kept = old.windows(2).any(|pair| keeps(&pair[0]) && makes(&pair[1]));
        let once = count(&makes) == 1 && count(&|old| Self::changes(&old.instruction)) == 2;
        Self { registers, aligned: kept && once && count(&|old| writes(old, Register::RBP)) == 1 }
    }

    /// Whether an instruction makes the frame or gives it up.
    fn changes(old: &Instruction) -> bool {
        matches!(old.mnemonic(), Mnemonic::Sub | Mnemonic::Add) && old.op0_register() == Register::RSP
    }

    /// The same in the new code; `None` if the frame is too large.
    fn change(&self, old: &Instruction, steps: &mut Vec<Step>) -> Option<()> {
        let make = old.mnemonic() == Mnemonic::Sub;
        if self.aligned && !make {
            steps.push(Instruction::with2(Code::Mov_r64_rm64, Register::RSP, Register::RBP).ok()?.into());
            return Some(());
        }
        let size = i32::try_from(old.immediate(1) as i64).ok()?.checked_mul(self.registers.copies() as i32)?;
        // Alignment takes less than one register more.
        if size.unsigned_abs() > MAX_FRAME - self.registers.bytes() as u32 {
            return None;
        }
        let code = if make { Code::Sub_rm64_imm32 } else { Code::Add_rm64_imm32 };
        steps.push(Instruction::with2(code, Register::RSP, size).ok()?.into());
        if self.aligned {
            let boundary = -(self.registers.bytes() as i32);
            steps.push(Instruction::with2(Code::And_rm64_imm8, Register::RSP, boundary).ok()?.into());
        }
        Some(())
    }
}

/// Pointers and counters.
fn scalar(old: &Instruction) -> Option<Instruction> {
    use Mnemonic::*;
    let touches_vectors =
        (0..old.op_count()).any(|i| old.op_kind(i) == OpKind::Register && old.op_register(i).is_vector_register());
    if touches_vectors {
        return None;
    }
    match old.mnemonic() {
        Push | Pop | Ret | Jmp | Je | Jne | Mov | Add | Sub | Cmp | Test | Xor | Lea | Nop => {}
        _ => return None,
    }
    let memory = (0..old.op_count()).any(|i| old.op_kind(i) == OpKind::Memory);
    if memory && (old.is_ip_rel_memory_operand() || (old.memory_base() != Register::RSP && old.mnemonic() != Lea)) {
        return None;
    }
    if old.mnemonic() == Lea && old.memory_base() == Register::RSP {
        return None;
    }
    Some(*old)
}
