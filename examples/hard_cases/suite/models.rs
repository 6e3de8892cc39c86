//! Models that the hard cases need.

use mbg_runtime::mbg;

mbg! {
    include "tests/models/mechanisms/two_four_bars.mbg";

    /// A body whose orientation is held in three angles, turned by a torque.
    pub(crate) model PulledAngles {
        input torque[3]: N*m;
        1 ground[3] { Sf held { flow: 0.0 } }
        1 frame[3];
        joint: FreeRotation { orientation: angles } (ground, frame);
        frame -> I body { inertia: diag(1.0, 2.0, 1.5), gyroscopic };
        Se pull[3] { effort: torque } -> frame;
        output quaternion[4] = joint.quaternion;
    }

    /// The same with a quaternion.
    pub(crate) model PulledQuaternion {
        input torque[3]: N*m;
        1 ground[3] { Sf held { flow: 0.0 } }
        1 frame[3];
        joint: FreeRotation { orientation: quaternion } (ground, frame);
        frame -> I body { inertia: diag(1.0, 2.0, 1.5), gyroscopic };
        Se pull[3] { effort: torque } -> frame;
        output quaternion[4] = joint.quaternion;
    }

    /// A top of 1 kg, its centre of mass 0.5 m above its foot, that turns slightly slower than what keeps it upright.
    #[derivative]
    pub(crate) model Top {
        gravity [0.0, 0.0, -10.0];
        1 ground[6] { Sf held { flow: 0.0 } }
        1 frame[6];
        foot: Spherical {
            orientation: quaternion, initial: [0.01, 0.0, 0.0], initial_rate: [0.0, 0.0, 13.2]
        } (ground, frame);
        body: Body {
            mass: 1.0, inertia: diag(0.55, 0.55, 0.3), centre: [0.0, 0.0, 0.5], gravity_at: foot.gravity_b
        } (frame);
        output quaternion[4] = foot.quaternion;
    }

    /// A block of 1 kg on a belt, held by a spring: with a Stribeck curve it sticks and slips, with Coulomb's it comes to
    /// rest beside the end of the spring.
    pub(crate) model Belt {
        param sliding: N = 2.0;
        param breakaway: N = 4.0;
        param belt_speed: m/s = 0.1;
        1 block { I mass { inertia: 1.0 } C spring { stiffness: 40.0 } }
        1 belt { Sf drive { flow: belt_speed } }
        0 contact;
        1 slip;
        belt -> contact;
        contact -> block;
        contact -> slip;
        friction: Friction { sliding: sliding, breakaway: breakaway, speed: 1e-4, stribeck_speed: 5e-2 } (slip);
        output extension: m = spring.q;
    }
}
