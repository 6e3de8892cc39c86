//! Nothing changes with time.

use mbg_runtime::mbg;

mbg! {
    model Still {
        1 body { R damper { resistance: 1.0 } Se motor { effort: 1.0 } }
    }
}

fn main() {}
