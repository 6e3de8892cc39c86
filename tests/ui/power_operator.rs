//!  is not a power in Rust.

use mbg_runtime::mbg;

mbg! {
    model Power {
        1 body {
            I rotor { inertia: 1.0 }
            R damper { effort: 0.1 * f ^ 2 }
        }
    }
}

fn main() {}
