//! Drops the optional steps whose results nobody reads: most masks are wanted either as vectors or as opmasks, not as both.

use iced_x86::Instruction;
use iced_x86::Mnemonic;
use iced_x86::OpKind;
use iced_x86::Register;

use crate::codegen::widen::Step;

/// A set of registers: bit `i` is `zmm i`, bit `32 + i` is `k i`.
type Set = u64;

fn bit(register: Register) -> Set {
    let place = |first: Register| register as u32 - first as u32;
    if register.is_zmm() {
        1 << place(Register::ZMM0)
    } else if register.is_xmm() {
        1 << place(Register::XMM0)
    } else if register.is_k() {
        1 << (32 + place(Register::K0))
    } else {
        0
    }
}

fn is_register(instruction: &Instruction, operand: u32) -> bool {
    instruction.op_kind(operand) == OpKind::Register
}

/// What an instruction reads. The first operand counts as read where it might be, as in fused operations.
fn reads(instruction: &Instruction) -> Set {
    use Mnemonic::*;
    if is_constant(instruction) {
        return 0;
    }
    let overwrites = matches!(
        instruction.mnemonic(),
        Vmovups
            | Vmovdqu32
            | Vmovdqu64
            | Vaddps
            | Vaddpd
            | Vsubps
            | Vsubpd
            | Vmulps
            | Vmulpd
            | Vdivps
            | Vdivpd
            | Vsqrtps
            | Vsqrtpd
            | Vminps
            | Vminpd
            | Vmaxps
            | Vmaxpd
            | Vandps
            | Vandpd
            | Vandnps
            | Vandnpd
            | Vorps
            | Vorpd
            | Vxorps
            | Vxorpd
            | Vpandd
            | Vpandnd
            | Vpord
            | Vpxord
            | Vpaddd
            | Vpaddq
            | Vpsubd
            | Vpsubq
            | Vpslld
            | Vpsllq
            | Vpsrld
            | Vpsrlq
            | Vrndscaleps
            | Vrndscalepd
            | Vbroadcastss
            | Vbroadcastsd
            | Vcmpps
            | Vcmppd
            | Vpcmpeqd
            | Vpcmpeqq
            | Vpcmpgtd
            | Vpcmpgtq
            | Vblendmps
            | Vblendmpd
            | Vpblendmb
            | Vpblendmd
            | Vpblendmq
            | Vpmovm2d
            | Vpmovm2q
            | Vpmovd2m
            | Vpmovq2m
            | Vpmovb2m
            | Kandw
            | Kandnw
            | Korw
            | Kxorw
            | Knotw
    );
    // A store's first operand is in memory, so that this leaves out nothing of it.
    let first = u32::from(overwrites && is_register(instruction, 0));
    let operands = (first..instruction.op_count()).filter(|&i| is_register(instruction, i));
    operands.fold(bit(instruction.op_mask()), |set, i| set | bit(instruction.op_register(i)))
}

/// Every instruction of a kernel writes its first operand if it is a register, and at most that; `cmp` and `push`, which do
/// not, have no vectors there.
fn writes(instruction: &Instruction) -> Set {
    match instruction.op_count() > 0 && is_register(instruction, 0) {
        true => bit(instruction.op0_register()),
        false => 0,
    }
}

/// All ones or all zeros, computed from a register whatever it holds.
fn is_constant(instruction: &Instruction) -> bool {
    match instruction.mnemonic() {
        Mnemonic::Vpternlogd => instruction.immediate8() == 0xff,
        Mnemonic::Vxorps | Mnemonic::Vxorpd | Mnemonic::Vpxor | Mnemonic::Vpxord => {
            is_register(instruction, 1)
                && is_register(instruction, 2)
                && instruction.op1_register() == instruction.op2_register()
        }
        _ => false,
    }
}

/// Removes what is dead. `targets` are the old addresses, sorted, that are jumped to.
pub fn remove(steps: &mut Vec<Step>, targets: &[u64]) {
    let starts = |step: &Step| step.instruction.ip() != 0 && targets.binary_search(&step.instruction.ip()).is_ok();
    let ends = |step: &Step| step.instruction.op0_kind() == OpKind::NearBranch64;

    // Kernels keep no vector from one pass of the loop to the next. If this one does, none dies at a jump.
    let (mut written, mut carried): (Set, bool) = (0, false);
    for step in steps.iter() {
        if starts(step) {
            written = 0;
        }
        carried |= reads(&step.instruction) & !written != 0;
        written |= writes(&step.instruction);
        if ends(step) {
            written = 0;
        }
    }
    let across: Set = if carried { !0 } else { 0 };

    let mut live = across;
    for step in steps.iter_mut().rev() {
        if ends(step) {
            live = across;
        }
        let written = writes(&step.instruction);
        // Wanted after all.
        step.optional &= written & live == 0;
        if !step.optional {
            live = live & !written | reads(&step.instruction);
        }
        if starts(step) {
            live = across;
        }
    }
    steps.retain(|step| !step.optional);
}
