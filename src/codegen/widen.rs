//! 128-bit machine code re-encoded for 256-bit registers.
//!
//! Cranelift selects 128-bit vector instructions only, which leaves half of an AVX2 machine idle. A kernel is a leaf
//! function whose vector instructions all work lane by lane, so the same instructions on registers of twice the width
//! compute two vectors at once, each lane bit for bit as before. In VEX encoding the width is one bit (VEX.L); what else
//! changes is where data lies: constants are doubled, and the stack frame, with its spilled vectors, has twice the size.
//!
//! Whatever instruction is not known to be lane-wise makes the pass decline, and the caller uses 128-bit code.

use std::collections::BTreeMap;

use iced_x86::BlockEncoder;
use iced_x86::BlockEncoderOptions;
use iced_x86::Code;
use iced_x86::Decoder;
use iced_x86::DecoderOptions;
use iced_x86::Instruction;
use iced_x86::InstructionBlock;
use iced_x86::Mnemonic;
use iced_x86::OpKind;
use iced_x86::Register;

/// Where the old code is thought to start, and the new constants, followed by the new code. The two ranges must not
/// overlap: the encoder takes an address of the old range for a jump target.
const OLD: u64 = 0x1_0000_0000;
const NEW: u64 = 0x2_0000_0000;

/// Bytes of a register in the old code.
const NARROW: usize = 16;

/// The registers that code is re-encoded for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Registers {
    /// 256 bits: AVX2.
    Ymm,
    /// 512 bits: AVX-512.
    Zmm,
}

impl Registers {
    /// The widest that this machine has and the pass knows how to use.
    #[cfg(target_arch = "x86_64")]
    pub fn widest() -> Option<Self> {
        std::arch::is_x86_feature_detected!("avx2").then_some(Self::Ymm)
    }

    #[cfg(not(target_arch = "x86_64"))]
    pub fn widest() -> Option<Self> {
        None
    }

    /// The size of one register: what one pass of the loop covers.
    pub fn bytes(self) -> usize {
        match self {
            Self::Ymm => 32,
            Self::Zmm => 64,
        }
    }
}

/// Re-encoded code: constants first, then the function.
pub struct Wide {
    pub bytes: Vec<u8>,
    /// Where the function starts.
    pub entry: usize,
}

/// Widens a kernel emitted with a stride of `registers.bytes()`. `code` is the function followed by its constants; `None`
/// if it holds anything that is not known to be lane-wise.
pub fn widen(code: &[u8], registers: Registers) -> Option<Wide> {
    if registers == Registers::Zmm {
        return None;
    }
    let instructions = decode(code)?;
    let mut pool = Pool { code, offsets: BTreeMap::new(), bytes: Vec::new() };
    let mut wide = Vec::with_capacity(instructions.len() + 1);
    for (instruction, bytes) in &instructions {
        let new = one(instruction, bytes, &mut pool)?;
        if new.mnemonic() == Mnemonic::Ret {
            // The upper halves must be clean when code without VEX runs again.
            wide.push(Instruction::with(Code::VEX_Vzeroupper));
        }
        wide.push(new);
    }
    let entry = pool.bytes.len();
    let block = InstructionBlock::new(&wide, NEW + entry as u64);
    let encoded = BlockEncoder::encode(64, block, BlockEncoderOptions::NONE).ok()?;
    let mut bytes = pool.bytes;
    bytes.extend(encoded.code_buffer);
    Some(Wide { bytes, entry })
}

/// The instructions up to the last return, each with its bytes. A kernel returns once, at its end.
fn decode(code: &[u8]) -> Option<Vec<(Instruction, Vec<u8>)>> {
    let mut decoder = Decoder::with_ip(64, code, OLD, DecoderOptions::NONE);
    let mut instructions = Vec::new();
    while decoder.can_decode() {
        let start = decoder.position();
        let instruction = decoder.decode();
        if instruction.is_invalid() {
            return None;
        }
        instructions.push((instruction, code[start..decoder.position()].to_vec()));
        if instruction.mnemonic() == Mnemonic::Ret {
            return Some(instructions);
        }
    }
    None
}

/// The old code's constants, each stored twice in a row.
struct Pool<'c> {
    code: &'c [u8],
    /// From the old offset to the new one.
    offsets: BTreeMap<usize, usize>,
    bytes: Vec<u8>,
}

impl Pool<'_> {
    fn doubled(&mut self, address: u64) -> Option<u64> {
        let old = usize::try_from(address.checked_sub(OLD)?).ok()?;
        let vector = self.code.get(old..old + NARROW)?;
        let new = *self.offsets.entry(old).or_insert_with(|| {
            let offset = self.bytes.len();
            self.bytes.extend_from_slice(vector);
            self.bytes.extend_from_slice(vector);
            offset
        });
        Some(NEW + new as u64)
    }
}

fn one(old: &Instruction, bytes: &[u8], pool: &mut Pool) -> Option<Instruction> {
    let mut new = match bytes.first()? {
        0xc4 | 0xc5 => vector(old, bytes)?,
        _ => match vector_move(old) {
            Some(moved) => moved,
            None => scalar(old)?,
        },
    };
    // Jumps find their targets by the old addresses.
    new.set_ip(old.ip());
    if (0..new.op_count()).any(|i| new.op_kind(i) == OpKind::Memory) {
        if new.is_ip_rel_memory_operand() {
            let address = pool.doubled(old.ip_rel_memory_address())?;
            new.set_memory_displacement64(address);
        } else if new.memory_base() == Register::RSP {
            if new.memory_index() != Register::None {
                return None;
            }
            new.set_memory_displacement64(old.memory_displacement64().checked_mul(2)?);
            // The encoder picks the short form where the doubled offset still fits it.
            new.set_memory_displ_size(8);
        }
    }
    Some(new)
}

/// A VEX instruction with VEX.L set, if it works lane by lane.
fn vector(old: &Instruction, bytes: &[u8]) -> Option<Instruction> {
    use Mnemonic::*;
    match old.mnemonic() {
        Vaddps | Vaddpd | Vsubps | Vsubpd | Vmulps | Vmulpd | Vdivps | Vdivpd | Vsqrtps | Vsqrtpd | Vminps | Vminpd
        | Vmaxps | Vmaxpd | Vandps | Vandpd | Vandnps | Vandnpd | Vorps | Vorpd | Vxorps | Vxorpd | Vpand | Vpandn
        | Vpor | Vpxor | Vcmpps | Vcmppd | Vblendvps | Vblendvpd | Vpblendvb | Vroundps | Vroundpd | Vpaddd
        | Vpaddq | Vpsubd | Vpsubq | Vpcmpeqd | Vpcmpeqq | Vpcmpgtd | Vpcmpgtq | Vmovups | Vmovupd | Vmovdqu
        | Vmovaps | Vmovapd | Vmovdqa | Vfmadd132ps | Vfmadd213ps | Vfmadd231ps | Vfmadd132pd | Vfmadd213pd
        | Vfmadd231pd | Vfmsub132ps | Vfmsub213ps | Vfmsub231ps | Vfmsub132pd | Vfmsub213pd | Vfmsub231pd
        | Vfnmadd132ps | Vfnmadd213ps | Vfnmadd231ps | Vfnmadd132pd | Vfnmadd213pd | Vfnmadd231pd | Vfnmsub132ps
        | Vfnmsub213ps | Vfnmsub231ps | Vfnmsub132pd | Vfnmsub213pd | Vfnmsub231pd => {}
        // By a fixed number of bits only: a count in a register is read from 128 bits in both widths, but none is used.
        Vpslld | Vpsllq | Vpsrld | Vpsrlq if old.op_kind(2) == OpKind::Immediate8 => {}
        Vbroadcastss if old.op_kind(1) == OpKind::Memory => return without_constants(old, with_length(bytes)?),
        // The 256-bit form reads two numbers; the broadcast reads one, as here.
        Vmovddup if old.op_kind(1) == OpKind::Memory => {
            let mut new = *old;
            new.set_code(Code::VEX_Vbroadcastsd_ymm_m64);
            new.set_op0_register(ymm(old.op0_register())?);
            return without_constants(old, new);
        }
        _ => return None,
    }
    with_length(bytes)
}

/// Declines a scalar constant: the pool doubles whole vectors.
fn without_constants(old: &Instruction, new: Instruction) -> Option<Instruction> {
    (!old.is_ip_rel_memory_operand()).then_some(new)
}

/// Decodes an instruction again with its VEX.L bit set: the same on 256 bits.
fn with_length(bytes: &[u8]) -> Option<Instruction> {
    let mut bytes = bytes.to_vec();
    let payload = match bytes.first()? {
        0xc5 => 1,
        0xc4 => 2,
        _ => return None,
    };
    *bytes.get_mut(payload)? |= 0b100;
    let new = Decoder::with_ip(64, &bytes, OLD, DecoderOptions::NONE).decode();
    (!new.is_invalid() && new.len() == bytes.len()).then_some(new)
}

/// Moves of whole vectors that Cranelift writes without VEX: spills, reloads and copies.
fn vector_move(old: &Instruction) -> Option<Instruction> {
    use Mnemonic::*;
    if !matches!(old.mnemonic(), Movups | Movupd | Movdqu | Movaps | Movapd | Movdqa) {
        return None;
    }
    let mut new = *old;
    if old.op0_kind() == OpKind::Memory {
        new.set_code(Code::VEX_Vmovups_ymmm256_ymm);
        new.set_op1_register(ymm(old.op1_register())?);
    } else {
        new.set_code(Code::VEX_Vmovups_ymm_ymmm256);
        new.set_op0_register(ymm(old.op0_register())?);
        if old.op1_kind() == OpKind::Register {
            new.set_op1_register(ymm(old.op1_register())?);
        }
    }
    Some(new)
}

fn ymm(register: Register) -> Option<Register> {
    register.is_xmm().then(|| Register::YMM0 + (register as u32 - Register::XMM0 as u32))
}

/// Pointers, counters and the frame. The frame's size doubles with all that lies in it.
fn scalar(old: &Instruction) -> Option<Instruction> {
    use Mnemonic::*;
    let touches_vectors =
        (0..old.op_count()).any(|i| old.op_kind(i) == OpKind::Register && old.op_register(i).is_vector_register());
    if touches_vectors {
        return None;
    }
    match old.mnemonic() {
        Add | Sub if old.op0_register() == Register::RSP => {
            let size = i32::try_from(old.immediate(1) as i64).ok()?.checked_mul(2)?;
            let code = if old.mnemonic() == Add { Code::Add_rm64_imm32 } else { Code::Sub_rm64_imm32 };
            return Instruction::with2(code, Register::RSP, size).ok();
        }
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
