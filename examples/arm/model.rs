//! The 7-axis arm out of its URDF file, its base at rest.
//!
//! `panda.mbg` is what `cargo run -p mbg-urdf -- examples/arm/panda.urdf` prints.

use mbg_runtime::mbg;

mbg! {
    include "examples/arm/panda.mbg";

    /// The arm on its stand, driven by a torque in each joint.
    pub model Arm {
        causality componentwise;
        gravity [0.0, 0.0, -9.81];
        input torque[7]: N*m;
        1 base[6];
        Sf ground[6] { flow: 0.0 } -> base;
        // Bent at shoulder, elbow and wrist.
        arm: Panda { effort: torque, initial: [0.0, 0.5, 0.0, -1.8, 0.0, 2.0, 0.6] } (base);
        output hand[3]: m = arm.panda_link7_position;
    }
}
