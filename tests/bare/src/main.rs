//! A program without std, allocator or unwinding that steps the generated INS ten seconds and exits with 0 if the
//! gimbals turned as they must.
#![no_std]
#![no_main]

extern crate bonds as mbg_runtime;

use mbg_runtime::{Rk4, System};
use nalgebra::SVector;

#[path = "../../../examples/ins/models.rs"]
#[allow(dead_code)]
mod models;
use models::{Ins, InsParameters, gust};

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    loop {}
}

#[unsafe(no_mangle)]
extern "C" fn main(_: i32, _: *const *const u8) -> i32 {
    let Ok(model) = Ins::<f64>::new(InsParameters::default()) else { return 1 };
    let mut last = SVector::<f64, 9>::zeros();
    match Rk4::fixed(&model, &gust(0.1), 0.0, 10.0, 1e-2, model.initial_state(), |_, x| last = *x) {
        Ok(_) if last[6] < -0.1 && last[6] > -1.0 => 0,
        _ => 2,
    }
}
