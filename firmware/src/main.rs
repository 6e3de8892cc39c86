//! Runs the generated INS on a microcontroller, or on this machine to compare with.
#![cfg_attr(target_os = "none", no_std, no_main)]

mod digest;
mod flight;
mod joint;
mod machine;
mod measure;
#[path = "../../examples/ins/models.rs"]
#[allow(dead_code)]
mod models;
mod print;
#[path = "../../examples/ins/reference.rs"]
#[allow(dead_code)]
mod reference;

use flight::{Steps, fly};
use mbg_runtime::Real;
use models::{Ins, InsObserved, InsObservedParameters, InsParameters};

fn models<T: Real>() -> Option<(Ins<T>, InsObserved<T>)> {
    let bare = Ins::new(InsParameters::default()).ok()?;
    let observed = InsObserved::new(InsObservedParameters::default()).ok()?;
    Some((bare, observed))
}

/// Flies both models in both precisions; whether all stayed within their bounds of error.
fn flights() -> bool {
    let (Some((bare, observed)), Some((bare64, observed64))) = (models::<f32>(), models::<f64>())
    else {
        return false;
    };
    #[cfg(feature = "planted")]
    print::text(["an index that may be out of bounds"][core::hint::black_box(0)]);
    fly("Ins, f32, plain", &bare, Steps::plain, 1e-6)
        & fly("Ins, f32, compensated", &bare, Steps::compensated, 1e-7)
        & fly("Ins, f32, guarded", &bare, Steps::guarded, 1e-7)
        & fly("InsObserved, f32, plain", &observed, Steps::plain, 1e-6)
        & fly(
            "InsObserved, f32, compensated",
            &observed,
            Steps::compensated,
            1e-7,
        )
        & fly("InsObserved, f32, guarded", &observed, Steps::guarded, 1e-7)
        & fly("Ins, f64, plain", &bare64, Steps::plain, 1e-10)
        & fly(
            "InsObserved, f64, guarded",
            &observed64,
            Steps::guarded,
            1e-10,
        )
        & joint::moves()
}

#[cfg(not(target_os = "none"))]
fn main() {
    machine::exit(flights());
}

/// Where the start-up code of a microcontroller goes.
#[cfg(target_os = "none")]
#[unsafe(no_mangle)]
extern "C" fn start() -> ! {
    machine::exit(flights())
}

/// Where the start-up code goes with what the machine refuses to do.
#[cfg(target_os = "none")]
#[unsafe(no_mangle)]
extern "C" fn stop(success: bool) -> ! {
    machine::exit(success)
}
