//! The drive.

use mbg_runtime::mbg;

mbg! {
    /// A pump with an accumulator drives a cylinder through a valve; the piston pushes a mass against a spring, and the
    /// oil behind it leaves through a throttle.
    pub(crate) model Drive {
        /// Speed of the pump.
        param speed: rad/s = 150.0;
        /// Of the pump for each radian.
        param displacement: m^3/rad = 1.5e-6;
        /// Of the oil.
        param density: kg/m^3 = 870.0;
        /// Of the oil: pressure for each part of the volume.
        param bulk_modulus: Pa = 1.4e9;
        /// Of the oil before the piston, and of that behind it, with the lines.
        param volume: m^3 = 4e-4;
        /// Of the piston.
        param piston: m^2 = 2e-3;
        /// Of the ring around the rod.
        param ring: m^2 = 1.2e-3;
        /// Of the valve and of the throttle when open.
        param opening: m^2 = 6e-6;
        /// Of what the rod moves.
        param mass: kg = 250.0;
        /// Of the seals.
        param friction: N*s/m = 900.0;
        /// Of the spring that the rod presses.
        param stiffness: N/m = 2e4;
        /// What leaks back to the tank.
        param leakage: m^3/s/Pa = 4e-11;
        /// Force against the rod.
        input load: N;

        0 supply;
        0 head { C oil_a { stiffness: bulk_modulus / volume } }
        0 back { C oil_b { stiffness: bulk_modulus / volume } }
        0 tank;
        1 shaft { Sf motor { flow: speed } }
        1 rod {
            I body { inertia: mass }
            R seals { resistance: friction }
            C spring { stiffness: stiffness }
            Se against { effort: -load }
        }
        Se atmosphere { effort: 0.0 } -> tank;
        supply -> R leak { conductance: leakage };

        pump: Pump { displacement: displacement } (tank, supply, shaft);
        reserve: Accumulator { volume: 2e-3, precharge: 3e6, initial: 8e-4 } (supply);
        valve: Orifice { area: opening, density: density } (supply, head);
        cylinder: Cylinder { area_a: piston, area_b: ring } (head, back, rod);
        throttle: Orifice { area: opening, density: density } (back, tank);

        output supply_pressure: Pa = supply.e;
        output head_pressure: Pa = head.e;
        output back_pressure: Pa = back.e;
        output travel: m = cylinder.travel;
        output velocity: m/s = rod.f;
    }
}
