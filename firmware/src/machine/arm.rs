//! Cortex-M4F on the MPS2 board AN386.

use core::arch::{asm, global_asm};
use core::ptr;

global_asm!(
    ".section .vectors, \"a\"",
    ".word top_of_stack",
    ".word reset",
    // Whatever goes wrong ends the run.
    ".rept 14",
    ".word fault",
    ".endr",
    ".section .text.reset",
    ".global reset",
    ".type reset, %function",
    ".thumb_func",
    "reset:",
    // Full access to the floating point unit.
    "ldr r0, =0xE000ED88",
    "ldr r1, [r0]",
    "orr r1, r1, #(0xF << 20)",
    "str r1, [r0]",
    "dsb",
    "isb",
    "bl start",
    ".type fault, %function",
    ".thumb_func",
    "fault:",
    "movs r0, #0",
    "bl stop",
);

/// The timer of the core: control, start value, value. It counts down at 25 MHz from the largest number that it holds.
const CONTROL: *mut u32 = ptr::without_provenance_mut(0xE000_E010);
const RELOAD: *mut u32 = ptr::without_provenance_mut(0xE000_E014);
const VALUE: *mut u32 = ptr::without_provenance_mut(0xE000_E018);
const LARGEST: u32 = 0xFF_FFFF;

/// The emulator takes 1 ns for an instruction, so that a tick is 40 of them.
pub(crate) const GRAIN: u64 = 40;

/// The timer, since it was started.
pub(crate) struct Counter;

impl Counter {
    pub(crate) fn start() -> Self {
        // SAFETY: registers of the core that nothing else uses.
        unsafe {
            RELOAD.write_volatile(LARGEST);
            VALUE.write_volatile(0);
            // On, with the clock of the core.
            CONTROL.write_volatile(0b101);
        }
        Self
    }

    pub(crate) fn instructions(&self) -> u64 {
        // SAFETY: as above.
        let value = unsafe { VALUE.read_volatile() };
        u64::from(LARGEST.wrapping_sub(value) & LARGEST) * GRAIN
    }
}

#[inline(always)]
pub(crate) fn stack_pointer() -> usize {
    let address: usize;
    // SAFETY: reads a register.
    unsafe { asm!("mov {}, sp", out(reg) address, options(nomem, nostack, preserves_flags)) };
    address
}

#[inline]
pub(super) fn call(number: usize, argument: usize) {
    // SAFETY: the call that Arm's specification describes.
    unsafe { asm!("bkpt #0xAB", inout("r0") number => _, in("r1") argument, options(nostack)) };
}
