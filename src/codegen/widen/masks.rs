//! Masks in 512-bit code: comparisons give opmasks, and blends take them.
//!
//! In the old code a mask is a vector of all ones or all zeros a lane, in a register like any other. The new code computes
//! it both ways where it can: as that vector, so that every other instruction finds in its register what it always found,
//! and as an opmask, for the blends. What nobody reads is dropped afterwards (`dead`).

use iced_x86::Code;
use iced_x86::Instruction;
use iced_x86::Mnemonic;
use iced_x86::OpKind;
use iced_x86::Register;

use crate::codegen::widen::Registers;
use crate::codegen::widen::Step;
use crate::codegen::widen::lanewise;

/// How many bytes one bit of an opmask stands for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Grain {
    Byte,
    Single,
    Double,
}

/// An opmask register, and what it says of a vector.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Opmask {
    k: Register,
    grain: Grain,
    /// The vector's lanes are all ones where the bit is set and all zeros elsewhere. If not, the bits are those of the
    /// lanes' signs and nothing more is known.
    full: bool,
}

/// What is known of the vector in a register.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Known {
    Nothing,
    Mask(Opmask),
    /// All bits are set.
    Ones,
    /// One half of a selection by bits, `mask & value`.
    Chosen(Half),
    /// The other half, `!mask & value`.
    Otherwise(Half),
}

/// What a value was combined with, a full mask, and the register where it still is; nowhere else but in the result, if
/// `None`.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Half {
    mask: Opmask,
    value: Option<Register>,
}

/// Follows the masks through straight code.
pub struct Masks {
    /// By the register's number.
    known: [Known; 32],
    /// The opmask register that is given out next, 1 to 7.
    next: u32,
}

impl Default for Masks {
    fn default() -> Self {
        Self { known: [Known::Nothing; 32], next: 1 }
    }
}

impl Masks {
    /// Where a jump may arrive, nothing is known.
    pub fn forget(&mut self) {
        self.known = [Known::Nothing; 32];
    }

    fn of(&self, register: Register) -> Known {
        self.known[index(register)]
    }

    /// What is known of an operand.
    fn operand(&self, old: &Instruction, operand: u32) -> Known {
        match old.op_kind(operand) {
            OpKind::Register => self.of(old.op_register(operand)),
            _ => Known::Nothing,
        }
    }

    /// A register was written, and this is known of it now.
    fn set(&mut self, register: Register, known: Known) {
        self.known[index(register)] = known;
        for known in &mut self.known {
            if let Known::Chosen(half) | Known::Otherwise(half) = known
                && half.value == Some(register)
            {
                half.value = None;
            }
        }
    }

    /// A register was written with what is no mask.
    pub fn overwritten(&mut self, register: Register) {
        self.set(register, Known::Nothing);
    }

    /// A free opmask register: what was known of it is forgotten.
    fn take(&mut self) -> Register {
        let k = Register::K0 + self.next;
        self.next = self.next % 7 + 1;
        for known in &mut self.known {
            if let Known::Mask(mask) | Known::Chosen(Half { mask, .. }) | Known::Otherwise(Half { mask, .. }) = known
                && mask.k == k
            {
                *known = Known::Nothing;
            }
        }
        k
    }

    /// The 512-bit form of a vector instruction; `None` if it is not known to work lane by lane.
    pub fn widen(&mut self, old: &Instruction, steps: &mut Vec<Step>) -> Option<()> {
        use Mnemonic::*;
        match old.mnemonic() {
            Vpcmpeqd | Vpcmpeqq if same_registers(old) => self.ones(old, steps),
            Vcmpps | Vpcmpeqd | Vpcmpgtd => self.compare(old, Grain::Single, steps),
            Vcmppd | Vpcmpeqq | Vpcmpgtq => self.compare(old, Grain::Double, steps),
            Vblendvps => self.blend(old, Grain::Single, steps),
            Vblendvpd => self.blend(old, Grain::Double, steps),
            Vpblendvb => self.blend(old, Grain::Byte, steps),
            // Zero: a short instruction clears the whole register.
            Vxorps | Vxorpd | Vpxor if same_registers(old) => {
                steps.push((*old).into());
                self.set(old.op0_register(), Known::Nothing);
                Some(())
            }
            Vandps | Vandpd | Vpand => self.logic(old, Code::VEX_Kandw_kr_kr_kr, steps),
            Vandnps | Vandnpd | Vpandn => self.logic(old, Code::VEX_Kandnw_kr_kr_kr, steps),
            Vorps | Vorpd | Vpor => self.logic(old, Code::VEX_Korw_kr_kr_kr, steps),
            Vxorps | Vxorpd | Vpxor => self.logic(old, Code::VEX_Kxorw_kr_kr_kr, steps),
            _ => {
                let new = lanewise(old, Registers::Zmm)?;
                let moves = new.code() == Code::EVEX_Vmovups_zmm_k1z_zmmm512;
                steps.push(Step { instruction: new, optional: moves });
                if old.op0_kind() == OpKind::Register {
                    self.set(old.op0_register(), if moves { self.operand(old, 1) } else { Known::Nothing });
                }
                Some(())
            }
        }
    }

    /// All ones, whatever the operands.
    fn ones(&mut self, old: &Instruction, steps: &mut Vec<Step>) -> Option<()> {
        let zmm = Registers::Zmm.of(old.op0_register())?;
        let code = Code::EVEX_Vpternlogd_zmm_k1z_zmm_zmmm512b32_imm8;
        let instruction = Instruction::with4(code, zmm, zmm, zmm, 0xff).ok()?;
        steps.push(Step { instruction, optional: true });
        self.set(old.op0_register(), Known::Ones);
        Some(())
    }

    fn compare(&mut self, old: &Instruction, grain: Grain, steps: &mut Vec<Step>) -> Option<()> {
        let mut new = lanewise(old, Registers::Zmm)?;
        let k = self.take();
        new.set_op0_register(k);
        steps.push(new.into());
        let code = match grain {
            Grain::Double => Code::EVEX_Vpmovm2q_zmm_kr,
            _ => Code::EVEX_Vpmovm2d_zmm_kr,
        };
        let instruction = Instruction::with2(code, Registers::Zmm.of(old.op0_register())?, k).ok()?;
        steps.push(Step { instruction, optional: true });
        self.set(old.op0_register(), Known::Mask(Opmask { k, grain, full: true }));
        Some(())
    }

    /// `old` takes its third operand where the fourth has a sign, by lanes or by bytes.
    fn blend(&mut self, old: &Instruction, grain: Grain, steps: &mut Vec<Step>) -> Option<()> {
        let mask = match self.of(old.op3_register()) {
            Known::Mask(mask) if mask.grain == grain || (mask.full && grain == Grain::Byte) => mask,
            _ => {
                let k = self.take();
                let code = match grain {
                    Grain::Byte => Code::EVEX_Vpmovb2m_kr_zmm,
                    Grain::Single => Code::EVEX_Vpmovd2m_kr_zmm,
                    Grain::Double => Code::EVEX_Vpmovq2m_kr_zmm,
                };
                steps.push(Instruction::with2(code, k, Registers::Zmm.of(old.op3_register())?).ok()?.into());
                let mask = Opmask { k, grain, full: false };
                self.known[index(old.op3_register())] = Known::Mask(mask);
                mask
            }
        };
        let mut new = lanewise(old, Registers::Zmm)?;
        new.set_code(blend_code(mask.grain));
        new.set_op3_register(Register::None);
        new.set_op_mask(mask.k);
        steps.push(new.into());
        self.set(old.op0_register(), Known::Nothing);
        Some(())
    }

    /// And, and-not, or, exclusive or.
    fn logic(&mut self, old: &Instruction, on_masks: Code, steps: &mut Vec<Step>) -> Option<()> {
        let instruction = lanewise(old, Registers::Zmm)?;
        let (a, b) = (self.operand(old, 1), self.operand(old, 2));
        let to = old.op0_register();
        match (a, b) {
            (Known::Mask(a), Known::Mask(b)) if a.full && b.full && a.grain == b.grain => {
                let k = self.take();
                let both = Instruction::with3(on_masks, k, a.k, b.k).ok()?;
                steps.push(Step { instruction: both, optional: true });
                steps.push(Step { instruction, optional: true });
                self.set(to, Known::Mask(Opmask { k, ..a }));
            }
            (Known::Mask(mask), Known::Ones) | (Known::Ones, Known::Mask(mask))
                if mask.full && on_masks == Code::VEX_Kxorw_kr_kr_kr =>
            {
                let k = self.take();
                let not = Instruction::with2(Code::VEX_Knotw_kr_kr, k, mask.k).ok()?;
                steps.push(Step { instruction: not, optional: true });
                steps.push(Step { instruction, optional: true });
                self.set(to, Known::Mask(Opmask { k, ..mask }));
            }
            (Known::Chosen(x), Known::Otherwise(y)) | (Known::Otherwise(y), Known::Chosen(x))
                if x.mask == y.mask && on_masks == Code::VEX_Korw_kr_kr_kr =>
            {
                let swapped = matches!(a, Known::Otherwise(_));
                let (chosen, otherwise) = if swapped { (2, 1) } else { (1, 2) };
                let chosen = x.value.unwrap_or_else(|| old.op_register(chosen));
                let otherwise = y.value.unwrap_or_else(|| old.op_register(otherwise));
                steps.push(select(to, x.mask, chosen, otherwise)?.into());
                self.set(to, Known::Nothing);
            }
            (Known::Mask(mask), _) if mask.full && on_masks == Code::VEX_Kandnw_kr_kr_kr => {
                steps.push(Step { instruction, optional: true });
                self.set(to, Known::Otherwise(Half { mask, value: register(old, 2) }));
            }
            (Known::Mask(mask), _) if mask.full && on_masks == Code::VEX_Kandw_kr_kr_kr => {
                steps.push(Step { instruction: chosen(old, mask, 2)?, optional: true });
                self.set(to, Known::Chosen(Half { mask, value: register(old, 2) }));
            }
            (_, Known::Mask(mask)) if mask.full && on_masks == Code::VEX_Kandw_kr_kr_kr => {
                steps.push(Step { instruction: chosen(old, mask, 1)?, optional: true });
                self.set(to, Known::Chosen(Half { mask, value: register(old, 1) }));
            }
            _ => {
                steps.push(instruction.into());
                self.set(to, Known::Nothing);
            }
        }
        Some(())
    }
}

/// `mask & value`, the value being an operand of `old`: that where the mask is set, zero elsewhere.
fn chosen(old: &Instruction, mask: Opmask, operand: u32) -> Option<Instruction> {
    let mut new = *old;
    new.set_code(match mask.grain {
        Grain::Double => Code::EVEX_Vmovdqu64_zmm_k1z_zmmm512,
        _ => Code::EVEX_Vmovdqu32_zmm_k1z_zmmm512,
    });
    new.set_op0_register(Registers::Zmm.of(old.op0_register())?);
    new.set_op1_kind(old.op_kind(operand));
    new.set_op2_kind(OpKind::Register);
    new.set_op2_register(Register::None);
    new.set_op1_register(match register(old, operand) {
        Some(register) => Registers::Zmm.of(register)?,
        None => Register::None,
    });
    new.set_op_mask(mask.k);
    new.set_zeroing_masking(true);
    Some(new)
}

/// `chosen` where the mask is set, `otherwise` elsewhere.
fn select(to: Register, mask: Opmask, chosen: Register, otherwise: Register) -> Option<Instruction> {
    let zmm = |register| Registers::Zmm.of(register);
    let mut blend = Instruction::with3(blend_code(mask.grain), zmm(to)?, zmm(otherwise)?, zmm(chosen)?).ok()?;
    blend.set_op_mask(mask.k);
    Some(blend)
}

/// The register that an operand is.
fn register(old: &Instruction, operand: u32) -> Option<Register> {
    (old.op_kind(operand) == OpKind::Register).then(|| old.op_register(operand))
}

fn index(register: Register) -> usize {
    (register as usize).wrapping_sub(Register::XMM0 as usize) % 32
}

fn same_registers(old: &Instruction) -> bool {
    old.op1_kind() == OpKind::Register && old.op2_kind() == OpKind::Register && old.op1_register() == old.op2_register()
}

fn blend_code(grain: Grain) -> Code {
    match grain {
        Grain::Byte => Code::EVEX_Vpblendmb_zmm_k1z_zmm_zmmm512,
        Grain::Single => Code::EVEX_Vblendmps_zmm_k1z_zmm_zmmm512b32,
        Grain::Double => Code::EVEX_Vblendmpd_zmm_k1z_zmm_zmmm512b64,
    }
}
