//! Two sources fix one flow.

use mbg_runtime::mbg;

mbg! {
    model Torn {
        1 shaft {
            Sf left { flow: 1.0 }
            Sf right { flow: 2.0 }
            C spring { stiffness: 1.0 }
        }
    }
}

fn main() {}
