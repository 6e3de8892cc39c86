//! Misspelt names in a chain, a law and a call.

use mbg_runtime::mbg;

mbg! {
    component Bearing(port shaft) {
        shaft -> R friction { resistance: 0.1 };
    }
    model Names {
        param mass: kg = 1.0;
        1 body { I rotor { inertia: mas } }
        bdy -> R damper { resistance: 1.0 };
        bearing: Baering (body);
        output speed = rotor.v;
    }
}

/// What uses the model is no mistake.
fn main() {
    use mbg_runtime::System;
    let names = Names::<f64>::new(NamesParameters::default()).unwrap();
    let still = nalgebra::SVector::zeros();
    let _ = mbg_runtime::Linearised::of(&names, 0.0, &names.initial_state(), &still);
}
