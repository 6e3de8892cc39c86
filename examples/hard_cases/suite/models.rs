//! Models that the hard cases need.

use mbg_runtime::mbg;

mbg! {
    include "examples/gallery/flying.mbg";
    include "examples/gallery/top.mbg";
    include "tests/models/mechanisms/parallelogram.mbg";
    include "tests/models/mechanisms/two_four_bars.mbg";
    include "tests/models/pulses.mbg";

    /// A body whose orientation is represented by three angles, turned by a torque.
    pub(crate) model PulledAngles {
        input torque[3]: N*m;
        1 frame[6];
        flying: Flying { orientation: angles, inertia: diag(1.0, 2.0, 1.5) } (frame);
        Se pull[3] { effort: torque } -> frame[0..3];
        output rates[3]: rad/s = frame.f[0..3];
        output quaternion[4] = flying.quaternion;
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

    /// The same, with friction that holds at rest.
    pub(crate) model HoldingBelt {
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
        friction: Friction { sliding: sliding, breakaway: breakaway, at_rest: holds, stribeck_speed: 5e-2 } (slip);
        output extension: m = spring.q;
    }
}
