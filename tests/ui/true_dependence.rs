//! Accepted, but not supported yet.

use mbg_runtime::mbg;

mbg! {
    model Rigid {
        1 shaft {
            I rotor { inertia: 1.0 }
            #[derivative]
            I load { inertia: 2.0 }
        }
    }
}

fn main() {}
