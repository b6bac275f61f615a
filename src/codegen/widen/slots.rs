//! Spilled vectors in registers: AVX-512 has sixteen vector registers that the old code does not know.

use std::collections::BTreeMap;

use iced_x86::Instruction;
use iced_x86::Mnemonic;
use iced_x86::OpKind;
use iced_x86::Register;

use crate::codegen::widen::NARROW;
use crate::codegen::widen::Old;
use crate::codegen::widen::is_move;
use crate::codegen::widen::table;

/// Puts the slots of the frame that are used most into `xmm16` to `xmm31`, which stand for the wide registers of the same
/// numbers. No other instruction names these, so each holds what its slot would.
pub fn to_registers(old: &mut [Old]) {
    // Uses by slot; none for a slot that is not always read and written as a whole.
    let mut uses: BTreeMap<u64, Option<usize>> = BTreeMap::new();
    for Old { instruction, .. } in old.iter() {
        let Some(offset) = offset(instruction) else { continue };
        let slot = offset / NARROW as u64;
        if offset % NARROW as u64 == 0 && is_whole(instruction) {
            let count = uses.entry(slot).or_insert(Some(0));
            *count = count.map(|count| count + 1);
        } else {
            uses.insert(slot, None);
            uses.insert(slot + 1, None);
        }
    }
    let mut used: Vec<(usize, u64)> = uses.into_iter().filter_map(|(slot, count)| Some((count?, slot))).collect();
    // The most used first; of the same, that which lies lowest.
    used.sort_by_key(|&(count, slot)| (std::cmp::Reverse(count), slot));
    let registers: BTreeMap<u64, Register> =
        used.iter().take(16).zip(16..).map(|(&(_, slot), i)| (slot, Register::XMM0 + i)).collect();
    for Old { instruction, .. } in old.iter_mut() {
        let register = offset(instruction).and_then(|offset| registers.get(&(offset / NARROW as u64)));
        if let Some(&register) = register {
            replace(instruction, register);
        }
    }
}

/// Where in the frame an instruction reads or writes.
fn offset(instruction: &Instruction) -> Option<u64> {
    let memory = (0..instruction.op_count()).any(|i| instruction.op_kind(i) == OpKind::Memory);
    (memory && instruction.memory_base() == Register::RSP).then(|| instruction.memory_displacement64())
}

/// Whether an instruction reads or writes a whole vector in memory.
fn is_whole(instruction: &Instruction) -> bool {
    let mnemonic = instruction.mnemonic();
    let number = matches!(mnemonic, Mnemonic::Vbroadcastss | Mnemonic::Vmovddup);
    instruction.memory_index() == Register::None && !number && (is_move(mnemonic) || table::forms(mnemonic).is_some())
}

fn replace(instruction: &mut Instruction, register: Register) {
    for i in 0..instruction.op_count() {
        if instruction.op_kind(i) == OpKind::Memory {
            instruction.set_op_kind(i, OpKind::Register);
            instruction.set_op_register(i, register);
        }
    }
}
