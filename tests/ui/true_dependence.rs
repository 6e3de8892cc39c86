//! A dependent storage that needs the rate of an input, which is not supported yet.

use mbg_runtime::mbg;

mbg! {
    model Driven {
        input speed: rad/s;
        1 shaft {
            Sf drive { flow: speed }
            #[derivative]
            I load { inertia: 2.0 }
        }
        integral angle = shaft.f;
        output turned = angle;
    }
}

fn main() {}
