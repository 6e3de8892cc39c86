//! The three classic revolute joints of Fig. 12 leave the platform's inertia without integral causality.

use mbg_runtime::mbg;

mbg! {
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

    /// Fuselage and platform with three classic joints in a row, Fig. 12.
    model InsClassic {
        param drag: N*m*s/rad = 1e3;
        param stiffness: N*m/rad = 1e-5;
        param damping: N*m*s/rad = 1e-5;
        input gust[3]: N*m;

        1 fuselage[3] {
            I hull  { inertia: diag(1e4, 1e4, 5e3), gyroscopic }
            R air   { resistance: drag }
            Se wind { effort: gust }
        }
        1 platform[3] {
            I body { inertia: diag(10.0, 10.0, 10.0), gyroscopic }
        }
        1 frame1[3];
        1 frame2[3];
        x: RevoluteX { stiffness: stiffness, damping: damping } (fuselage, frame1);
        y: RevoluteY { stiffness: stiffness, damping: damping } (frame1, frame2);
        z: RevoluteZ { stiffness: stiffness, damping: damping } (frame2, platform);

        output alpha[3]: rad = [x.spring.q, y.spring.q, z.spring.q];
    }
}

fn main() {}
