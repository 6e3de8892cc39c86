//! An element with two laws.

use mbg_runtime::mbg;

mbg! {
    model Laws {
        1 body {
            I rotor { inertia: 1.0 }
            R damper { resistance: 1.0, conductance: 1.0 }
        }
    }
}

fn main() {}
