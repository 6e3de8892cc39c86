//! Two sources fix one effort.

use mbg_runtime::mbg;

mbg! {
    model Torn {
        Se left { effort: 1.0 } -> node;
        Se right { effort: 2.0 } -> node;
        0 node { I rotor { inertia: 1.0 } }
    }
}

fn main() {}
