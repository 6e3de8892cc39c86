//! All stages of a step at once: the same slopes, and errors that follow the tolerance.

use mbg_runtime::{Adaptive, Dop853, Estimating, Integrator, Pirk8, Pirk16, Smooth};
use nalgebra::SVector;

use crate::errors::{apart, larger};
use crate::problems::{Hunters, Law, Oscillator, Pendulum, RigidBody, Written};

/// The states at four hundred times over ten seconds.
fn states<L, S, const N: usize>(
    law: L,
    start: SVector<f64, N>,
    method: S,
    tolerance: f64,
) -> Vec<SVector<f64, N>>
where
    L: Law<N, 0> + Copy,
    S: Estimating,
{
    let times: Vec<f64> = (1..=400).map(|number| 0.025 * f64::from(number)).collect();
    let mut states = Vec::new();
    Adaptive::new(method, tolerance, tolerance)
        .sample(&Written(law), &(), 0.0, start, &times, |_, x| {
            states.push(*x);
        })
        .unwrap();
    states
}

/// The largest error at tolerances from 1e-3 to 1e-10, in units of the tolerance: at the end, and of all samples on the way.
fn worst<L, S, const N: usize>(law: L, start: SVector<f64, N>, method: S) -> [f64; 2]
where
    L: Law<N, 0> + Copy,
    S: Estimating,
{
    let exact = states(law, start, Dop853, 1e-14);
    (3..=10).fold([0.0; 2], |[end, between]: [f64; 2], digits| {
        let tolerance = 10.0_f64.powi(-digits);
        let found = states(law, start, method, tolerance);
        let pairs = found.iter().zip(&exact);
        let errors = pairs.map(|(a, b)| apart(a.as_slice(), b.as_slice()) / tolerance);
        let errors: Vec<f64> = errors.collect();
        let last = errors.last().copied().unwrap_or(f64::INFINITY);
        [larger(end, last), errors.into_iter().fold(between, larger)]
    })
}

#[test]
fn errors_are_as_many_tolerances_as_those_of_the_method_of_dormand_and_prince() {
    fn compare<L: Law<N, 0> + Copy, const N: usize>(law: L, start: [f64; N]) {
        let start = SVector::from(start);
        let ours = [worst(law, start, Pirk8), worst(law, start, Pirk16)];
        let theirs = worst(law, start, Dop853);
        println!("{ours:.1?} and {theirs:.1?} tolerances");
        for (place, theirs) in theirs.into_iter().enumerate() {
            assert!(
                ours.iter().all(|ours| ours[place] < 2.0 * theirs),
                "{ours:?} {theirs}"
            );
        }
    }
    compare(Pendulum, [1.5, 3.0]);
    compare(Pendulum, [2.5, 0.0]);
    compare(Hunters, [3.0, 2.0]);
    compare(RigidBody, [1.0, 4.0, 2.0, 1.0, 0.0, 0.0, 0.0]);
}

/// Where sweeps change nothing the estimate must see what the method misses: an input far faster than the system.
#[test]
fn a_fast_input_is_followed() {
    follow(Pirk8);
    follow(Pirk16);
}

fn follow(method: impl Estimating) {
    let frequency = 60.0;
    let input = Smooth(|t: f64| SVector::from([(frequency * t).cos()]));
    let exact = |t: f64| ((frequency * t).cos() - t.cos()) / (1.0 - frequency * frequency);
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
        let mut last = SVector::from([0.0, 0.0]);
        let statistics = Adaptive::new(method, tolerance, tolerance)
            .integrate(&Written(Oscillator), &input, 0.0, 10.0, last, |step| {
                last = *step.state()
            })
            .unwrap();
        let error = (last[0] - exact(10.0)).abs();
        println!("{tolerance:e}: {error:.1e} {statistics:?}");
        assert!(error < 10.0 * tolerance, "{tolerance:e}: {error:e}");
    }
}
