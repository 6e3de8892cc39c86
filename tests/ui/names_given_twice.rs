//! Names that are given twice, of which Rust must not speak as well.

use mbg_runtime::{System, mbg};

mbg! {
    model Wheel {
        param inertia = 1.0;
        param inertia = 2.0;
        1 rate { I rotor { inertia: inertia } }
    }
    model Wheel {
        1 rate { I rotor { inertia: 2.0 } }
    }
    model WheelParameters {
        1 rate { I rotor { inertia: 2.0 } }
    }
    model f64 {
        1 rate { I rotor { inertia: 2.0 } }
    }
}

fn main() {
    let wheel = Wheel::<f64>::new(WheelParameters { inertia: 1.0 }).unwrap();
    let _ = wheel.initial_state();
}
