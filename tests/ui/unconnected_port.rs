//! Ports without a bond, and with two.

use mbg_runtime::mbg;

mbg! {
    model Ports {
        1 body { I rotor { inertia: 1.0 } }
        body -> TF gear { flow: 2.0 };
        body -> rotor;
    }
}

fn main() {}
