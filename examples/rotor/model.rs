//! A rotor of four blades on hinges.

use mbg_runtime::mbg;

mbg! {
    /// Four blades of 20 kg, uniform from their hinges at 0.3 m to a radius of 5 m.
    component Blades(port mast[6]) {
        param drive: driven | free = driven;
        param speed: rad/s;
        rotor: Rotor {
            count: 4, drive: drive, speed: speed, offset: 0.3, mass: 20.0,
            inertia: diag(0.3, 36.816666666666667, 37.116666666666667), centre: [2.35, 0.0, 0.0],
            stiffness: [6000.0, 2000.0, 8000.0]
        } (mast);
    }

    /// Driven, on a mast that slides on springs in the plane of the hub.
    #[derivative]
    pub model Sliding {
        causality componentwise;
        param speed: rad/s = 30.0;
        /// Of all that slides besides the blades.
        param mass: kg = 420.0;
        param stiffness: N/m = 2e5;
        1 ground[6]; 1 between[6]; 1 mast[6];
        Sf fixed[6] { flow: 0.0 } -> ground;
        along: Prismatic { axis: 0, stiffness: stiffness } (ground, between);
        across: Prismatic { axis: 1, stiffness: stiffness } (between, mast);
        body: PointMass { mass: mass } (mast);
        blades: Blades { speed: speed } (mast);
        output azimuth: rad = blades.rotor.shaft.angle;
        output mast[2]: m = [along.travel, across.travel];
    }

    /// On a hub that turns freely, on a mast that stands still.
    #[derivative]
    pub model Coasting {
        causality componentwise;
        1 mast[6];
        Sf fixed[6] { flow: 0.0 } -> mast;
        blades: Blades { drive: free, speed: 30.0 } (mast);
        disk: Body { mass: 10.0, inertia: diag(3.0, 3.0, 5.0) } (blades.rotor.hub);
        // About the axis.
        sums: for k in 0..4 {
            let turn = blades.rotor.blades[k].blade.orientation_b;
            let momentum = turn * blades.rotor.blades[k].blade.body.body.p;
            let at = blades.rotor.blades[k].blade.position_b + turn * [2.35, 0.0, 0.0];
            let spin = turn * blades.rotor.blades[k].blade.body.spin.p + skew(at) * momentum;
            let before = if k == 0 { disk.spin.p.z } else { sums[k-1].total };
            let total = before + spin.z;
        }
        output momentum: N*m*s = sums[3].total;
        output speed: rad/s = blades.rotor.shaft.rate.f;
    }
}
