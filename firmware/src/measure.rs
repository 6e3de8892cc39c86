//! What a piece of work costs.

use core::ptr;

use crate::machine::{self, Counter, GRAIN};

/// How often work is repeated, so that the grain of the counter does not show.
const TIMES: u64 = 4 * GRAIN;

/// Instructions that the work takes each time, and those of the repetition with it.
#[inline(never)]
pub(crate) fn instructions(mut work: impl FnMut()) -> u64 {
    let counter = Counter::start();
    for _ in 0..TIMES {
        work();
    }
    (counter.instructions() + TIMES / 2) / TIMES
}

/// Bytes of stack below the caller's that are looked at.
const REACH: usize = 16 * 1024;
/// What stack that was not used contains.
const UNUSED: u32 = 0x5AFE_57AC;

/// Bytes of stack that the work takes.
#[inline(never)]
pub(crate) fn stack(work: impl FnOnce()) -> u64 {
    let top = machine::stack_pointer();
    if top == 0 {
        return 0;
    }
    let words = (top - REACH..top).step_by(size_of::<u32>());
    for address in words.clone() {
        // SAFETY: memory below the stack pointer, which nothing uses.
        unsafe { ptr::without_provenance_mut::<u32>(address).write_volatile(UNUSED) };
    }
    work();
    let used = words.into_iter().find(|address| {
        // SAFETY: as above.
        unsafe { ptr::without_provenance::<u32>(*address).read_volatile() != UNUSED }
    });
    used.map_or(0, |address| (top - address) as u64)
}
