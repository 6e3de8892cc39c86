mbg_runtime::mbg! {
    /// Rotorcraft fuselage and inertial platform with the gimbal joint of Tod et al. (2013), Fig. 13.
    pub model Ins {
        /// Viscous friction between air and fuselage.
        param drag: N*m*s/rad = 1e3;
        /// Stiffness of each gimbal.
        param stiffness: N*m/rad = 1e-5;
        /// Damping of each gimbal.
        param damping: N*m*s/rad = 1e-5;
        /// Torque of the wind, fuselage axes.
        input gust[3]: N*m;

        1 fuselage[3] {
            I hull  { inertia: diag(1e4, 1e4, 5e3), gyroscopic }
            R air   { resistance: drag }
            Se wind { effort: gust }
        }
        1 platform[3] {
            I body { inertia: diag(10.0, 10.0, 10.0), gyroscopic }
        }
        1 gimbals[3] {
            C spring { stiffness: stiffness }
            R damper { resistance: damping }
        }
        0 joint[3];

        fuselage -> joint;
        gimbals  -> MTF jacobian { flow: jacobian_xyz(spring.q) } -> joint;
        joint    -> MTF turn {
            flow: transpose(rot_x(spring.q.x) * rot_y(spring.q.y) * rot_z(spring.q.z))
        } -> platform;

        output alpha[3]: rad = spring.q;
    }
}
