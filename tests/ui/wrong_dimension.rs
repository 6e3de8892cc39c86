//! Vectors where others are expected.

use mbg_runtime::mbg;

mbg! {
    model Sizes {
        1 body[3] { I rotor { inertia: diag(1.0, 2.0) } }
        1 shaft { I load { inertia: 1.0 } }
        body -> shaft;
        body[2..4] -> R damper { resistance: 1.0 };
        output speed[2] = body.f;
    }
}

fn main() {}
