//! Long rows of like parts, whose steps are written as loops.

use mbg_runtime::{Dual, System, mbg};

use super::audit::{Probe, audit, near};
use crate::references::cart::Cart;

/// How many cells and rods.
const COUNT: usize = 40;
const STATES: usize = 2 * COUNT;

const EXACT: f64 = 1e-11;

mbg! {
    include "examples/gallery/rods.mbg";

    /// A line of cells with a current into each, all a little different.
    pub(crate) model Line {
        param resistance: ohm = 2.0;
        param inductance: H = 1e-3;
        let count = 40;
        input supply: V;
        input current[40]: A;
        wires: for k in 0..count + 1 { 1 wire; }
        Se source { effort: supply } -> wires[0].wire;
        cells: for k in 0..count {
            0 node {
                C store { effort: (1e3 + 7.0 * k) * q * (1.0 + 0.3 * q * q) }
                Sf drive { flow: current[k] }
            }
            wires[k].wire -> I coil { inertia: inductance * (1.0 + 0.01 * k) };
            wires[k].wire -> R loss { effort: resistance * f + 0.1 * f * abs(f) };
            wires[k].wire -> node;
            node -> wires[k+1].wire;
            output voltage: V = node.e;
        }
        wires[count].wire -> R load { resistance: 50.0 };
    }

    /// Forty rods below a pin.
    #[derivative]
    pub(crate) model Rods40 {
        gravity [0.0, -9.81];
        1 ground[3] { Sf fixed { flow: 0.0 } }
        row: Rods { count: 40 } (ground);
    }
}

/// Voltages of the cells, the rates of charges and fluxes in turns, and the energy.
fn line(x: &[f64], supply: f64, currents: &[f64]) -> ([f64; COUNT], [f64; STATES], f64) {
    let (mut voltages, mut rates, mut energy) = ([0.0; COUNT], [0.0; STATES], 0.0);
    let inductance = |k: usize| 1e-3 * (1.0 + 0.01 * k as f64);
    for k in 0..COUNT {
        let (charge, flux) = (x[2 * k], x[2 * k + 1]);
        let stiffness = 1e3 + 7.0 * k as f64;
        voltages[k] = stiffness * charge * (1.0 + 0.3 * charge * charge);
        energy += stiffness * (0.5 * charge.powi(2) + 0.3 * charge.powi(4) / 4.0);
        energy += 0.5 * flux * flux / inductance(k);
    }
    for k in 0..COUNT {
        let own = x[2 * k + 1] / inductance(k);
        let next = match k + 1 {
            COUNT => voltages[k] / 50.0,
            next => x[2 * next + 1] / inductance(next),
        };
        let before = if k == 0 { supply } else { voltages[k - 1] };
        rates[2 * k] = own - next + currents[k];
        rates[2 * k + 1] = before - voltages[k] - 2.0 * own - 0.1 * own * own.abs();
    }
    (voltages, rates, energy)
}

#[test]
fn a_line_of_cells_is_that_of_a_loop_by_hand() {
    let plain = Line::<f64>::new(LineParameters::default()).unwrap();
    let dual = Line::new(LineParameters::default()).unwrap();
    audit(&plain, &dual, |probe: &Probe<_, STATES, { COUNT + 1 }>| {
        let (x, u) = (&probe.state, &probe.input);
        let (voltages, rates, energy) = line(x.as_slice(), u[0], &u.as_slice()[1..]);
        let found = plain.derivative(0.0, x, u, &mut ());
        for (found, expected) in found.iter().zip(rates) {
            near(*found, expected, EXACT);
        }
        let found = plain.output(0.0, x, u, &mut ());
        for (found, expected) in found.iter().zip(voltages) {
            near(*found, expected, 1e-14);
        }
        near(plain.energy(0.0, x), energy, 1e-14);
    });
}

#[test]
fn forty_rods_move_as_lagrange_says() {
    let plain = Rods40::<f64>::new(Rods40Parameters::default()).unwrap();
    let dual = Rods40::new(Rods40Parameters::default()).unwrap();
    let reference = Cart::uniform(f64::INFINITY, COUNT);
    let quarter = std::f64::consts::FRAC_PI_2;
    audit(&plain, &dual, |probe: &Probe<_, STATES, 0>| {
        let outputs = probe.outputs();
        let (angles, rates) = outputs.as_slice().split_at(COUNT);
        let value = |outputs: &[Dual<f64>], more: f64| -> Vec<f64> {
            outputs.iter().map(|it| it.value + more).collect()
        };
        let (angles, turning) = (value(angles, quarter), value(rates, 0.0));
        let expected = &reference.accelerations(&angles, &turning, 0.0)[1..];
        let size = expected.iter().fold(1.0_f64, |size, it| size.max(it.abs()));
        for (rate, expected) in rates.iter().zip(expected) {
            near(rate.slope / size, expected / size, EXACT);
        }
        // The work of weights is supplied.
        let [moving, still] =
            [&turning[..], &[0.0; COUNT]].map(|rates| reference.energy(0.0, &angles, rates));
        near(plain.energy(0.0, &probe.state), moving - still, EXACT);
    });
}
