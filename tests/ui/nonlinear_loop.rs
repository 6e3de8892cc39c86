//! Two resistors determine each other, one of them by a cube.

use mbg_runtime::mbg;

mbg! {
    model Loop {
        1 shaft {
            Se motor { effort: 1.0 }
            R bearing { effort: powi(f, 3) }
            R winding { resistance: 1.0 }
        }
        integral angle = shaft.f;
        output turned = angle;
    }
}

fn main() {}
