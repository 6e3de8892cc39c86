//! A hart of RISC-V with single precision on QEMU's board `virt`.

use core::arch::{asm, global_asm};

global_asm!(
    ".section .vectors, \"ax\"",
    ".global reset",
    "reset:",
    "la sp, top_of_stack",
    // Whatever goes wrong ends the run.
    "la t0, fault",
    "csrw mtvec, t0",
    // The floating point unit is on once its state is not `off`.
    "li t0, 1 << 13",
    "csrs mstatus, t0",
    "call start",
    ".balign 4",
    "fault:",
    "li a0, 0",
    "call stop",
);

/// The counter counts single instructions.
pub(crate) const GRAIN: u64 = 1;

/// The counter of instructions, since it was looked at.
pub(crate) struct Counter(u32);

impl Counter {
    pub(crate) fn start() -> Self {
        Self(retired())
    }

    pub(crate) fn instructions(&self) -> u64 {
        u64::from(retired().wrapping_sub(self.0))
    }
}

fn retired() -> u32 {
    let number: u32;
    // SAFETY: reads a register.
    unsafe { asm!("csrr {}, minstret", out(reg) number, options(nostack)) };
    number
}

#[inline(always)]
pub(crate) fn stack_pointer() -> usize {
    let address: usize;
    // SAFETY: reads a register.
    unsafe { asm!("mv {}, sp", out(reg) address, options(nomem, nostack, preserves_flags)) };
    address
}

#[inline]
pub(super) fn call(number: usize, argument: usize) {
    // SAFETY: the call that the specification of semihosting for RISC-V describes; the three instructions must have
    // their full length and lie on one page.
    unsafe {
        asm!(
            ".balign 16",
            ".option push",
            ".option norvc",
            "slli x0, x0, 0x1f",
            "ebreak",
            "srai x0, x0, 7",
            ".option pop",
            inout("a0") number => _,
            in("a1") argument,
            options(nostack)
        );
    }
}
