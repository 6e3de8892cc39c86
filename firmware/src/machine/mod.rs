//! What the firmware asks of the machine that it runs on.
//!
//! | function | does |
//! |---|---|
//! | `write` | shows one byte |
//! | `exit` | stops; whether with success |
//! | `Counter` | counts instructions, in steps of `GRAIN` |
//! | `stack_pointer` | lowest address of the stack in use |

#[cfg(target_arch = "arm")]
mod arm;
#[cfg(not(target_os = "none"))]
mod host;
#[cfg(target_arch = "riscv32")]
mod riscv;
#[cfg(target_os = "none")]
mod semihosting;

#[cfg(target_arch = "arm")]
pub(crate) use arm::{Counter, GRAIN, stack_pointer};
#[cfg(not(target_os = "none"))]
pub(crate) use host::{Counter, GRAIN, exit, stack_pointer, write};
#[cfg(target_arch = "riscv32")]
pub(crate) use riscv::{Counter, GRAIN, stack_pointer};
#[cfg(target_os = "none")]
pub(crate) use semihosting::{exit, write};

/// Where a panic would go: this is defined nowhere, so that firmware which can panic does not link.
#[cfg(target_os = "none")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    unsafe extern "C" {
        fn this_firmware_can_panic() -> !;
    }
    // SAFETY: it never runs.
    unsafe { this_firmware_can_panic() }
}
