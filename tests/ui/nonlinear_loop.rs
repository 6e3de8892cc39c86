//! Resistors determine each other, and the last gives back what the others take, so that any flow will do.

use mbg_runtime::mbg;

mbg! {
    model Loop {
        1 shaft {
            Se motor { effort: 1.0 }
            R bearing { effort: powi(f, 3) }
            R winding { resistance: 1.0 }
            R drive { effort: -powi(f, 3) - f }
        }
        integral angle = shaft.f;
        output turned = angle;
    }
}

fn main() {}
