//! Numbers that are none.

use mbg_runtime::mbg;

mbg! {
    model Numbers {
        1 body {
            I rotor { inertia: 1e999 }
            R damper { resistance: 1.0 / 0.0 }
        }
    }
}

fn main() {}
