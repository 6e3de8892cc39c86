//! What is written and changes nothing; warnings, but for the first line.
#![deny(deprecated)]
#![forbid(non_upper_case_globals)]

use mbg_runtime::mbg;

mbg! {
    component Brake(port at) {
        param speed = 1.0;
        at -> R pad { resistance: 0.1 };
    }
    model Arm {
        causality componentwise;
        input gust: N*m;
        1 ground[6];
        Sf still[6] { flow: 0.0 } -> ground;
        1 arm[6];
        #[derivative] weight: Body { mass: 1.0, inertia: 2.0 } (arm);
        hinge: Revolute { axis: 2, rest: 0.5 } (ground, arm);
        1 drum { #[derivative] I rotor { inertia: 1.0, initial_flow: 3.0 } }
        hinge.rate -> TF gear { flow: 10.0 } -> drum;
        brake: Brake { speed: 2.0 } (drum);
    }
}

fn main() {}
