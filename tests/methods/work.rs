//! What methods take on standard problems: what makes one of them slower shows here, whatever it was made for.

use mbg_runtime::{
    Adaptive, Dop853, Estimating, Integrator, Radau5, Radau9, Rodas4, Rodas5P, Tsit5,
};
use nalgebra::SVector;

use crate::problems::{Law, Pendulum, RigidBody, Robertson, StiffPin, VanDerPol, Written};

/// Counts differ by so much where products and sums are fused.
const APART: f64 = 0.03;

/// A problem with the time of its end and the sizes of its states.
struct Task<L, const N: usize> {
    law: L,
    start: SVector<f64, N>,
    end: f64,
    nominal: [f64; N],
}

impl<L: Law<N, 0> + Copy, const N: usize> Task<L, N> {
    /// Compares steps, refused ones included, and evaluations at tolerances of 1e-3 and 1e-6.
    fn takes<S: Estimating>(&self, method: S, expected: [[u64; 2]; 2]) {
        for (tolerance, expected) in [1e-3, 1e-6].into_iter().zip(expected) {
            let solver = Adaptive {
                nominal: &self.nominal,
                ..Adaptive::new(method, tolerance, tolerance)
            };
            let law = Written(self.law);
            let ran = solver
                .integrate(&law, &(), 0.0, self.end, self.start, |_| ())
                .unwrap();
            let found = [ran.steps + ran.rejected, ran.evaluations];
            for (found, expected) in found.into_iter().zip(expected) {
                let apart = (found as f64 / expected as f64 - 1.0).abs();
                assert!(
                    apart < APART,
                    "{} at {tolerance:e}: {ran:?}, expected {expected}",
                    S::NAME
                );
            }
        }
    }
}

#[test]
fn smooth_problems_take_no_more_steps() {
    let pendulum = Task {
        law: Pendulum,
        start: SVector::from([2.0, 1.0]),
        end: 100.0,
        nominal: [1.0; 2],
    };
    pendulum.takes(Tsit5, [[102, 620], [352, 2114]]);
    pendulum.takes(Dop853, [[84, 1083], [171, 2023]]);
    let body = Task {
        law: RigidBody,
        start: SVector::from([1e-4, 10.0, 6e-4, 1.0, 0.0, 0.0, 0.0]),
        end: 100.0,
        nominal: [1.0; 7],
    };
    body.takes(Tsit5, [[239, 1436], [846, 5078]]);
    body.takes(Dop853, [[162, 1923], [293, 3506]]);
}

#[test]
fn a_stiff_pin_takes_no_more_steps() {
    let pin = Task {
        law: StiffPin {
            stiffness: 1e8,
            damping: 1e3,
        },
        start: StiffPin::level(),
        end: 5.0,
        nominal: [1e-7, 1e-7, 1.0, 1e-3, 1e-3, 1.0],
    };
    pin.takes(Rodas4, [[167, 991], [1505, 9020]]);
    pin.takes(Rodas5P, [[163, 1303], [1099, 8778]]);
    pin.takes(Radau5, [[110, 1301], [455, 4091]]);
    pin.takes(Radau9, [[90, 1809], [164, 3757]]);
}

#[test]
fn stiff_oscillators_and_reactions_take_no_more_steps() {
    let oscillator = Task {
        law: VanDerPol,
        start: SVector::from([2.0, 0.0]),
        end: 2.0,
        nominal: [1.0; 2],
    };
    oscillator.takes(Rodas4, [[191, 1132], [1069, 6410]]);
    oscillator.takes(Rodas5P, [[151, 1191], [631, 5035]]);
    oscillator.takes(Radau5, [[184, 1633], [861, 6464]]);
    oscillator.takes(Radau9, [[128, 2115], [237, 3847]]);
    let reactions = Task {
        law: Robertson,
        start: SVector::from([1.0, 0.0, 0.0]),
        end: 1e5,
        nominal: [1.0, 1e-5, 1.0],
    };
    reactions.takes(Rodas4, [[38, 229], [146, 877]]);
    reactions.takes(Rodas5P, [[35, 284], [94, 751]]);
    reactions.takes(Radau5, [[45, 392], [157, 1272]]);
    reactions.takes(Radau9, [[32, 493], [60, 962]]);
}
