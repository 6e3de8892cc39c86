//! The inertial navigation system of Tod et al. (2013) in both architectures.

use mbg_runtime::{Pulse, mbg};
use nalgebra::Vector3;

/// The gust of the paper's Table I on [1, 1 + width) s.
pub(crate) fn gust(width: f64) -> Pulse<f64, 3> {
    Pulse {
        amplitude: Vector3::new(5000.0, 1000.0, 10000.0),
        start: 1.0,
        end: 1.0 + width,
    }
}

mbg! {
    /// Fuselage in the wind, and the platform that is to stay where it is. Rates in own axes.
    component Bodies(port fuselage[3], port platform[3]) {
        param drag: N*m*s/rad;
        fuselage -> I hull { inertia: diag(1e4, 1e4, 5e3), gyroscopic };
        fuselage -> R air { resistance: drag };
        platform -> I body { inertia: diag(10.0, 10.0, 10.0), gyroscopic };
        attitude orientation = quaternion(fuselage.f);
        attitude deviation = quaternion(platform.f);
    }

    /// The gimbal joint of Fig. 6: a Jacobian takes the rates of the three gimbals to axes of `a`.
    component Gimbals(port a[3], port b[3]) {
        param stiffness: N*m/rad;
        param damping: N*m*s/rad;
        1 rates[3] {
            C spring { stiffness: stiffness }
            R damper { resistance: damping }
        }
        0 joint[3];
        a -> joint;
        rates -> MTF jacobian { flow: jacobian_xyz(spring.q) } -> joint;
        joint -> MTF turn {
            flow: transpose(rot_x(spring.q.x) * rot_y(spring.q.y) * rot_z(spring.q.z))
        } -> b;
        // Eq. (16).
        integral estimate[3]: rad = -(transpose(rot_x(spring.q.x) * rot_y(spring.q.y) * rot_z(spring.q.z))
            * (jacobian_xyz(spring.q) * rates.f));
    }

    /// One axis of the classic joint of Fig. 3: stiffness and damping about x, the other axes blocked.
    component RevoluteX(port a[3], port b[3]) {
        param stiffness: N*m/rad;
        param damping: N*m*s/rad;
        0 sum[3];
        1 rel[3];
        rel.x -> C spring { stiffness: stiffness };
        rel.x -> R damper { resistance: damping };
        Sf blocked[2] { flow: [0.0, 0.0] } -> rel[1..3];
        a -> sum;
        rel -> sum;
        sum -> MTF turn { flow: transpose(rot_x(spring.q)) } -> b;
    }

    /// About y.
    component RevoluteY(port a[3], port b[3]) {
        param stiffness: N*m/rad;
        param damping: N*m*s/rad;
        0 sum[3];
        1 rel[3];
        rel.y -> C spring { stiffness: stiffness };
        rel.y -> R damper { resistance: damping };
        Sf blocked_x { flow: 0.0 } -> rel.x;
        Sf blocked_z { flow: 0.0 } -> rel.z;
        a -> sum;
        rel -> sum;
        sum -> MTF turn { flow: transpose(rot_y(spring.q)) } -> b;
    }

    /// About z.
    component RevoluteZ(port a[3], port b[3]) {
        param stiffness: N*m/rad;
        param damping: N*m*s/rad;
        0 sum[3];
        1 rel[3];
        rel.z -> C spring { stiffness: stiffness };
        rel.z -> R damper { resistance: damping };
        Sf blocked[2] { flow: [0.0, 0.0] } -> rel[0..2];
        a -> sum;
        rel -> sum;
        sum -> MTF turn { flow: transpose(rot_z(spring.q)) } -> b;
    }

    /// The classic joint of Fig. 7: three revolutes in a row.
    component Revolutes(port a[3], port b[3]) {
        param stiffness: N*m/rad;
        param damping: N*m*s/rad;
        1 frame1[3];
        1 frame2[3];
        x: RevoluteX { stiffness: stiffness, damping: damping } (a, frame1);
        y: RevoluteY { stiffness: stiffness, damping: damping } (frame1, frame2);
        z: RevoluteZ { stiffness: stiffness, damping: damping } (frame2, b);
        // Eq. (16).
        integral estimate[3]: rad = -(transpose(rot_x(x.spring.q) * rot_y(y.spring.q) * rot_z(z.spring.q))
            * (jacobian_xyz([x.spring.q, y.spring.q, z.spring.q]) * [x.spring.f, y.spring.f, z.spring.f]));
    }

    /// Rotorcraft fuselage and inertial platform with the gimbal joint of Tod et al. (2013), Fig. 13.
    pub(crate) model Ins {
        /// Viscous friction between air and fuselage.
        param drag: N*m*s/rad = 1e3;
        /// Stiffness of each gimbal.
        param stiffness: N*m/rad = 1e-5;
        /// Damping of each gimbal.
        param damping: N*m*s/rad = 1e-5;
        /// Torque of the wind, fuselage axes.
        input gust[3]: N*m;

        1 fuselage[3] { Se wind { effort: gust } }
        1 platform[3];
        bodies: Bodies { drag: drag } (fuselage, platform);
        gimbals: Gimbals { stiffness: stiffness, damping: damping } (fuselage, platform);

        output alpha[3]: rad = gimbals.spring.q;
    }

    /// The same with the three classic revolute joints of Fig. 12.
    #[derivative]
    pub(crate) model InsClassic {
        /// Viscous friction between air and fuselage.
        param drag: N*m*s/rad = 1e3;
        /// Stiffness of each gimbal.
        param stiffness: N*m/rad = 1e-5;
        /// Damping of each gimbal.
        param damping: N*m*s/rad = 1e-5;
        /// Torque of the wind, fuselage axes.
        input gust[3]: N*m;

        1 fuselage[3] { Se wind { effort: gust } }
        1 platform[3];
        bodies: Bodies { drag: drag } (fuselage, platform);
        gimbals: Revolutes { stiffness: stiffness, damping: damping } (fuselage, platform);

        output alpha[3]: rad = [gimbals.x.spring.q, gimbals.y.spring.q, gimbals.z.spring.q];
    }

    /// `Ins` with its attitude and the estimate of eq. (16).
    pub(crate) model InsObserved {
        /// Viscous friction between air and fuselage.
        param drag: N*m*s/rad = 1e3;
        /// Stiffness of each gimbal.
        param stiffness: N*m/rad = 1e-5;
        /// Damping of each gimbal.
        param damping: N*m*s/rad = 1e-5;
        /// Torque of the wind, fuselage axes.
        input gust[3]: N*m;

        1 fuselage[3] { Se wind { effort: gust } }
        1 platform[3];
        bodies: Bodies { drag: drag } (fuselage, platform);
        gimbals: Gimbals { stiffness: stiffness, damping: damping } (fuselage, platform);

        output alpha[3]: rad = gimbals.spring.q;
        output fuselage_rate[3]: rad/s = fuselage.f;
        output platform_rate[3]: rad/s = platform.f;
        output fuselage_attitude[4] = bodies.orientation;
        output estimated[3]: rad = gimbals.estimate;
        output platform_attitude[4] = bodies.deviation;
    }

    /// `InsClassic` with its attitude and the estimate of eq. (16).
    #[derivative]
    pub(crate) model InsClassicObserved {
        /// Viscous friction between air and fuselage.
        param drag: N*m*s/rad = 1e3;
        /// Stiffness of each gimbal.
        param stiffness: N*m/rad = 1e-5;
        /// Damping of each gimbal.
        param damping: N*m*s/rad = 1e-5;
        /// Torque of the wind, fuselage axes.
        input gust[3]: N*m;

        1 fuselage[3] { Se wind { effort: gust } }
        1 platform[3];
        bodies: Bodies { drag: drag } (fuselage, platform);
        gimbals: Revolutes { stiffness: stiffness, damping: damping } (fuselage, platform);

        output alpha[3]: rad = [gimbals.x.spring.q, gimbals.y.spring.q, gimbals.z.spring.q];
        output fuselage_rate[3]: rad/s = fuselage.f;
        output platform_rate[3]: rad/s = platform.f;
        output fuselage_attitude[4] = bodies.orientation;
        output estimated[3]: rad = gimbals.estimate;
        output platform_attitude[4] = bodies.deviation;
    }
}
