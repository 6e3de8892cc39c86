//! The least firmware: the INS in single precision, a step for each sample of the wind.
#![no_std]
#![no_main]

use core::hint::black_box;

use mbg_runtime::{Rk4, System};
use nalgebra::SVector;

#[path = "../machine/mod.rs"]
#[allow(dead_code, unused_imports)]
mod machine;
#[path = "../../../examples/ins/models.rs"]
#[allow(dead_code)]
mod models;

use models::{Ins, InsParameters};

/// Time between two samples in seconds.
const STEP: f32 = 0.01;

/// Where the start-up code goes.
#[unsafe(no_mangle)]
extern "C" fn start() -> ! {
    let Ok(model) = Ins::<f32>::new(InsParameters::default()) else {
        machine::exit(false);
    };
    let mut x = model.initial_state();
    loop {
        // Here a sensor would be read and a motor be driven.
        let wind = black_box(SVector::from([0.0; 3]));
        x = Rk4::step(&model, 0.0, &x, &wind, STEP, &mut ());
        black_box(&x);
    }
}

/// Where the start-up code goes with what the machine refuses to do.
#[unsafe(no_mangle)]
extern "C" fn stop(success: bool) -> ! {
    machine::exit(success)
}
