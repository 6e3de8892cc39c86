//! The scenes as models.

use mbg_runtime::mbg;

#[path = "../../examples/ins/models.rs"]
#[allow(dead_code)]
pub(crate) mod ins;

mbg! {
    include "../examples/arm/panda.mbg";

    /// The 7-axis arm on its stand, driven by a torque in each joint.
    pub(crate) model Arm {
        causality componentwise;
        gravity [0.0, 0.0, -9.81];
        input torque[7]: N*m;
        1 base[6];
        Sf ground[6] { flow: 0.0 } -> base;
        arm: Panda { effort: torque } (base);
        output hand[3]: m = arm.panda_link7_position;
    }
}

/// Links on hinges about x and y in turn, one below the other, out of the library.
macro_rules! chain {
    ($name:ident, $links:literal) => {
        mbg! {
            /// Rods of 1 m and 1 kg in space, each hanging on the one before.
            #[derivative]
            pub(crate) model $name {
                causality componentwise;
                gravity [0.0, 0.0, -9.81];
                let rods = $links;
                input torque[$links];
                ends: for k in 0..rods + 1 { 1 end[6]; }
                Sf fixed[6] { flow: 0.0 } -> ends[0].end;
                links: for k in 0..rods {
                    1 rod[6];
                    hinge: Revolute { axis: k % 2, damping: 0.1, torque: torque[k] } (ends[k].end, rod);
                    body: Body {
                        mass: 1.0,
                        inertia: diag(0.08395833333333334, 0.08395833333333334, 0.00125),
                        centre: [0.0, 0.0, -0.5]
                    } (rod);
                    length: Offset { by: [0.0, 0.0, -1.0] } (rod, ends[k+1].end);
                }
                output first = links[0].hinge.angle;
            }
        }
    };
}

chain!(Chain8, 8);
chain!(Chain16, 16);
chain!(Chain64, 64);

mbg! {
    /// A four-bar in a plane whose second axis points down: the rotation is positive from x to there.
    #[derivative]
    pub(crate) model FourBar {
        gravity [0.0, 9.81];
        input torque: N*m;
        1 pivot_a[3]; 1 pivot_d[3]; 1 hinge_b[3]; 1 tip_coupler[3]; 1 tip_rocker[3];
        Sf ground_a[3] { flow: 0.0 } -> pivot_a;
        Sf ground_d[3] { flow: 0.0 } -> pivot_d;
        crank: PlanarLink {
            mass: 1.0, inertia: 0.0075, centre: [0.15, 0.0], end: [0.3, 0.0], damping: 0.01, torque: torque
        } (pivot_a, hinge_b);
        coupler: PlanarLink {
            mass: 2.0, inertia: 0.135, centre: [0.45, 0.0], end: [0.9, 0.0], damping: 0.01
        } (hinge_b, tip_coupler);
        rocker: PlanarLink {
            mass: 1.5, inertia: 0.06125, centre: [0.35, 0.0], end: [0.7, 0.0], damping: 0.01,
            position_a: [1.0, 0.0]
        } (pivot_d, tip_rocker);
        cut: PlanarCut {} (tip_coupler, tip_rocker);
        output angle: rad = crank.angle_b;
    }
}
