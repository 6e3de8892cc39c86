//! A model in a crate that does not call this one `mbg_runtime`, as nothing here does.

use crate::System;

crate::mbg! {
    model Wheel {
        param inertia: kg*m^2 = 2.0;
        1 rate { I rotor { inertia: inertia, initial_flow: 3.0 } R bearing { resistance: 0.5 } }
    }
}

#[test]
fn a_model_finds_the_crate_by_whatever_name() {
    let wheel = Wheel::<f64>::new(WheelParameters::default());
    let start = wheel.map(|wheel| wheel.initial_state()[0]);
    assert_eq!(start, Ok(6.0));
}
