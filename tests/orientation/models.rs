//! Scenes with one body that turns, its orientation held in each of the three ways.

use mbg_runtime::mbg;

mbg! {
    include "examples/gallery/flying.mbg";
    include "examples/gallery/top.mbg";
    include "examples/gallery/navigation.mbg";

    /// With a quaternion.
    pub(crate) model FlyingQuaternion {
        1 frame[6];
        flying: Flying { orientation: quaternion, inertia: diag(1.0, 2.0, 3.0) } (frame);
        output rates[3]: rad/s = frame.f[0..3];
        output quaternion[4] = flying.quaternion;
        output momentum[3]: N*m*s = flying.momentum;
    }

    /// With a rotation matrix.
    pub(crate) model FlyingMatrix {
        1 frame[6];
        flying: Flying { orientation: matrix, inertia: diag(1.0, 2.0, 3.0) } (frame);
        output rates[3]: rad/s = frame.f[0..3];
        output quaternion[4] = flying.quaternion;
        output momentum[3]: N*m*s = flying.momentum;
    }

    #[derivative]
    pub(crate) model TopAngles {
        gravity [0.0, 0.0, -10.0];
        param tilt: rad = 0.6;
        param rate: rad/s = 25.0;
        1 frame[6];
        top: Top { orientation: angles, tilt: tilt, rate: rate } (frame);
        output rates[3]: rad/s = frame.f[0..3];
        output quaternion[4] = top.quaternion;
        output momentum[2]: N*m*s = top.momentum;
        output potential: J = top.potential;
    }

    #[derivative]
    pub(crate) model TopMatrix {
        gravity [0.0, 0.0, -10.0];
        param tilt: rad = 0.6;
        param rate: rad/s = 25.0;
        1 frame[6];
        top: Top { orientation: matrix, tilt: tilt, rate: rate } (frame);
        output rates[3]: rad/s = frame.f[0..3];
        output quaternion[4] = top.quaternion;
        output momentum[2]: N*m*s = top.momentum;
        output potential: J = top.potential;
    }

    pub(crate) model PulledMatrix {
        input torque[3]: N*m;
        1 frame[6];
        flying: Flying { orientation: matrix, inertia: diag(1.0, 2.0, 1.5) } (frame);
        Se pull[3] { effort: torque } -> frame[0..3];
        output rates[3]: rad/s = frame.f[0..3];
        output quaternion[4] = flying.quaternion;
    }

    pub(crate) model NavigationMatrix {
        input gust[3]: N*m;
        1 fuselage[3] { Se wind { effort: gust } }
        1 platform[3];
        ins: Navigation { orientation: matrix } (fuselage, platform);
        output angles[3]: rad = ins.joint.angle;
        output quaternion[4] = ins.joint.quaternion;
    }

    /// A plate on a ball joint, and the point of it that belongs to another one, 1 m apart, with which it is a hinge.
    component Plate(port frame[6], port tip[3]) {
        param orientation: angles | quaternion | matrix = angles;
        1 ground[6] { Sf held { flow: 0.0 } }
        1 other[6];
        ball: Spherical { orientation: orientation, initial: [0.5, 0.0, 0.0] } (ground, frame);
        body: Body {
            mass: 2.0, inertia: diag(0.4, 0.3, 0.5), centre: [0.5, 0.2, -0.7]
        } (frame);
        edge: Offset { by: [1.0, 0.0, 0.0] } (frame, other);
        other[3..6] -> MTF world { flow: ball.turn } -> tip;
        let gap[3] = ball.turn * [1.0, 0.0, 0.0] - [1.0, 0.0, 0.0];
        let centre = ball.turn * [0.5, 0.2, -0.7];
    }

    #[derivative]
    pub(crate) model HungQuaternion {
        causality componentwise;
        gravity [0.0, 0.0, -10.0];
        1 frame[6];
        1 tip[3];
        1 post[3] { Sf fixed { flow: 0.0 } }
        plate: Plate { orientation: quaternion } (frame, tip);
        close tip[1..3] -> post[1..3] by multipliers, displacement: plate.gap[1..3];
        output gap[3]: m = plate.gap;
        output angle: rad = plate.ball.angle.x;
        output potential: J = 20.0 * plate.centre.z;
    }

    #[derivative]
    pub(crate) model HungMatrix {
        causality componentwise;
        gravity [0.0, 0.0, -10.0];
        1 frame[6];
        1 tip[3];
        1 post[3] { Sf fixed { flow: 0.0 } }
        plate: Plate { orientation: matrix } (frame, tip);
        close tip[1..3] -> post[1..3] by multipliers, displacement: plate.gap[1..3];
        output gap[3]: m = plate.gap;
        output angle: rad = plate.ball.angle.x;
        output potential: J = 20.0 * plate.centre.z;
    }

    /// The same plate on a hinge.
    #[derivative]
    pub(crate) model Hinged {
        gravity [0.0, 0.0, -10.0];
        1 ground[6] { Sf held { flow: 0.0 } }
        1 corner[6];
        hinge: Revolute { axis: 0, initial: 0.5 } (ground, corner);
        plate: Body {
            mass: 2.0, inertia: diag(0.4, 0.3, 0.5), centre: [0.5, 0.2, -0.7]
        } (corner);
        output angle: rad = hinge.angle;
    }
}
