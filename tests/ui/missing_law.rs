//! Elements without a law.

use mbg_runtime::mbg;

mbg! {
    model Laws {
        1 body {
            I rotor { initial: 1.0 }
            C spring { }
            R damper { stiffness: 1.0 }
        }
    }
}

fn main() {}
