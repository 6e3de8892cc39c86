//! A gyroscopic multiport whose flow nothing gives.

use mbg_runtime::mbg;

mbg! {
    model Gyrostat {
        input torque[3]: N*m;
        1 body[3] {
            EJS wheel { momentum: [0.0, 0.0, 5.0] }
            Se motor { effort: torque }
        }
        integral angle[3] = body.f;
        output turned[3] = angle;
    }
}

fn main() {}
