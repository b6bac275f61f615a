//! The hardware rounding mode around a kernel call. Nothing else in the crate touches it.
//!
//! Rust assumes round-to-nearest throughout, so the mode is changed, the kernel called and the mode changed back inside
//! one assembly block: no Rust instruction ever runs in another mode. Both control words are constants; reading the old
//! one would stall for about twenty times as long (`stmxcsr` after vector work).

/// A kernel's machine code: inputs, outputs, uniforms, number of groups.
pub type Entry = unsafe extern "sysv64" fn(*const u8, *mut u8, *const u8, usize);

#[cfg(target_arch = "x86_64")]
mod words {
    /// Round to nearest, all exceptions masked, denormals honoured: what Rust assumes.
    pub static NEAREST: u32 = 0x1f80;
    /// The same with rounding towards +inf.
    pub static UPWARD: u32 = 0x5f80;
}

/// Whether the machine has the instructions that kernels use. Without FMA, Cranelift would call a library per lane.
#[cfg(target_arch = "x86_64")]
pub fn available() -> bool {
    std::arch::is_x86_feature_detected!("avx") && std::arch::is_x86_feature_detected!("fma")
}

#[cfg(not(target_arch = "x86_64"))]
pub fn available() -> bool {
    false
}

/// Calls a kernel with the rounding mode towards +inf.
///
/// # Safety
/// As for calling `entry`: the pointers must be valid for the kernel's slots times `groups`.
#[cfg(target_arch = "x86_64")]
pub unsafe fn call_upward(entry: Entry, inputs: *const u8, outputs: *mut u8, uniforms: *const u8, groups: usize) {
    // SAFETY: the block restores the mode that Rust assumes before it ends; `clobber_abi` tells the compiler what a
    // call may change. Alignment: no push precedes the call and `asm!` blocks start with the stack aligned to 16.
    unsafe {
        std::arch::asm!(
            "ldmxcsr [rip + {up}]",
            "call {entry}",
            "ldmxcsr [rip + {nearest}]",
            up = sym words::UPWARD,
            nearest = sym words::NEAREST,
            entry = in(reg) entry,
            in("rdi") inputs,
            in("rsi") outputs,
            in("rdx") uniforms,
            in("rcx") groups,
            clobber_abi("sysv64"),
        );
    }
}

#[cfg(not(target_arch = "x86_64"))]
pub unsafe fn call_upward(_: Entry, _: *const u8, _: *mut u8, _: *const u8, _: usize) {
    unreachable!("no kernel is compiled for this machine");
}
