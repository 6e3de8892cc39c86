//! Two inertias on one junction have one flow.

use mbg_runtime::mbg;

mbg! {
    model Rigid {
        1 shaft {
            I rotor { inertia: 1.0 }
            I load { inertia: 2.0 }
        }
    }
}

fn main() {}
