//! Factors by the plan of elimination against those with a search for pivots.
#![allow(clippy::unwrap_used)]

#[path = "../examples/arm/model.rs"]
#[allow(unreachable_pub)]
mod arm;
#[path = "references/errors.rs"]
#[allow(dead_code)]
mod errors;
#[path = "../examples/ins/models.rs"]
#[allow(unreachable_pub, dead_code)]
mod ins;
#[path = "../benches/elimination/models.rs"]
#[allow(unreachable_pub)]
mod models;
#[path = "references/noise.rs"]
mod noise;

use arm::{Arm, ArmParameters};
use errors::larger;
use ins::{Ins, InsParameters};
use mbg_runtime::__private::{Complex, Shifted};
use mbg_runtime::{Adaptive, Fixed, Integrator, Method, Radau5, Rodas5P, System};
use models::{
    Chain, ChainParameters, Dense, RingModulator, RingModulatorParameters, Row, RowParameters,
    ring_error, ring_nominal,
};
use nalgebra::{SMatrix, SVector};
use noise::noise;

/// Largest component of `A x − b` beside those of the terms in its row.
fn residual<const N: usize>(
    matrix: &SMatrix<f64, N, N>,
    x: &SVector<f64, N>,
    right: &SVector<f64, N>,
) -> f64 {
    (0..N).fold(0.0, |largest: f64, row| {
        let terms: Vec<f64> = (0..N)
            .map(|column| matrix[(row, column)] * x[column])
            .collect();
        let size: f64 = terms.iter().map(|term| term.abs()).sum::<f64>() + right[row].abs();
        larger(
            largest,
            (terms.iter().sum::<f64>() - right[row]).abs() / size,
        )
    })
}

/// Pattern, real and complex solutions on random states, of so many by the plan.
fn compare<S, const N: usize, const M: usize, const P: usize>(
    system: &S,
    size: f64,
    diagonal: f64,
) -> usize
where
    S: System<f64, N, M, P>,
{
    let mut random = noise(1);
    let sparsity = S::SPARSITY.unwrap();
    let mut planned = 0;
    for _ in 0..100 {
        let x = system.initial_state() + SVector::from_fn(|_, _| size * random());
        let u = SVector::from_fn(|_, _| random());
        let jacobian = system.jacobian_state(0.0, &x, &u, &mut S::Memory::default());
        for (row, columns) in sparsity.rows.iter().enumerate() {
            for column in 0..N {
                let empty = columns.binary_search(&(column as u16)).is_err();
                assert!(!empty || jacobian[(row, column)] == 0.0, "{row} {column}");
            }
        }
        let right = SVector::from_fn(|_, _| random());
        let factors = Shifted::new::<S, M, P>(diagonal, 1.0, &jacobian);
        planned += usize::from(factors.is_planned());
        let found = factors.solved::<S, M, P>(&right);
        let matrix = SMatrix::<f64, N, N>::identity() * diagonal - jacobian;
        let left = residual(&matrix, &found, &right);
        assert!(left < 1e-11, "{left:e}");
        let again = Shifted::new::<S, M, P>(diagonal, 1.0, &jacobian).solved::<S, M, P>(&right);
        assert_eq!(found, again);

        let pair = Complex {
            real: 0.7 * diagonal,
            imaginary: 0.8 * diagonal,
        };
        let rights = right.data.0[0].map(|real| Complex {
            real,
            imaginary: -real,
        });
        let found = Shifted::new::<S, M, P>(pair, 1.0, &jacobian).solve::<S, M, P>(rights);
        let dense =
            Shifted::new::<Dense<S>, M, P>(pair, 1.0, &jacobian).solve::<Dense<S>, M, P>(rights);
        let largest = dense.iter().fold(0.0, |largest: f64, it| {
            largest.max(it.real.hypot(it.imaginary))
        });
        for (found, dense) in found.iter().zip(&dense) {
            let apart = (found.real - dense.real).hypot(found.imaginary - dense.imaginary);
            assert!(apart < 1e-10 * largest, "{found:?} {dense:?}");
        }
    }
    planned
}

#[test]
fn solutions_fulfil_their_equations() {
    let ring = RingModulator::new(RingModulatorParameters::default()).unwrap();
    assert_eq!(compare(&ring, 1e-13, 1e8), 100);
    let row = Row::new(RowParameters::default()).unwrap();
    assert_eq!(compare(&row, 1.0, 1e3), 100);
    let chain = Chain::new(ChainParameters::default()).unwrap();
    assert_eq!(compare(&chain, 1.0, 1e3), 100);
    let arm = Arm::new(ArmParameters::default()).unwrap();
    assert_eq!(compare(&arm, 0.5, 1e3), 100);
    let ins = Ins::new(InsParameters::default()).unwrap();
    assert_eq!(compare(&ins, 0.3, 1e3), 100);
}

#[test]
fn a_pivot_that_vanishes_is_searched_for() {
    type Ring = RingModulator<f64>;
    let system = Ring::new(RingModulatorParameters::default()).unwrap();
    let mut jacobian =
        system.jacobian_state(0.0, &system.initial_state(), &SVector::zeros(), &mut ());
    let first = usize::from(Ring::SPARSITY.unwrap().elimination.unwrap().order[0]);
    for (pivot, found) in [(1e8, true), (1e-300, false), (0.0, false)] {
        jacobian[(first, first)] = 1e8 - pivot;
        let factors = Shifted::new::<Ring, 0, 0>(1e8, 1.0, &jacobian);
        assert_eq!(factors.is_planned(), found, "{pivot}");
        let right = SVector::from_fn(|row, _| 1.0 + row as f64);
        let matrix = SMatrix::<f64, 15, 15>::identity() * 1e8 - jacobian;
        let left = residual(&matrix, &factors.solved::<Ring, 0, 0>(&right), &right);
        assert!(left < 1e-12, "{pivot}: {left:e}");
    }
    jacobian[(first, first)] = f64::NAN;
    assert!(!Shifted::new::<Ring, 0, 0>(1e8, 1.0, &jacobian).is_planned());
}

#[test]
fn the_ring_modulator_reaches_its_published_end() {
    let system = RingModulator::<f64>::new(RingModulatorParameters::default()).unwrap();
    let nominal = ring_nominal();
    let solver = Adaptive {
        nominal: &nominal,
        ..Adaptive::new(Rodas5P, 1e-5, 1e-5)
    };
    let mut last = SVector::zeros();
    solver
        .integrate(&system, &(), 0.0, 1e-3, system.initial_state(), |step| {
            last = *step.state()
        })
        .unwrap();
    let error = ring_error(&last);
    assert!(error < 2e-3, "{error:e}");
}

/// The first stages that are tried on the way overflow in a diode: such a step is halved, too.
#[test]
fn the_ring_modulator_runs_at_fixed_steps() {
    let system = RingModulator::<f64>::new(RingModulatorParameters::default()).unwrap();
    // A period of the fastest modes is 0.2 µs.
    for (step, halvings, within) in [(1e-7, 1..2000, 0.1), (2e-8, 0..10, 3e-3)] {
        let mut last = system.initial_state();
        let statistics = Fixed::new(Radau5, step)
            .integrate(&system, &(), 0.0, 1e-3, last, |step| last = *step.state())
            .unwrap();
        let error = ring_error(&last);
        println!("{step:e} s: {error:.1e} V, {statistics:?}");
        assert!(halvings.contains(&statistics.rejected));
        assert!(error < within, "{error:e}");
    }
}

#[test]
fn steps_are_those_of_the_dense_system() {
    fn end<S, D: Method>(system: &S, method: D) -> SVector<f64, 31>
    where
        S: System<f64, 31, 0, 0>,
    {
        let mut last = system.initial_state();
        Fixed::new(method, 1e-2)
            .integrate(system, &(), 0.0, 1.0, last, |step| last = *step.state())
            .unwrap();
        last
    }
    fn apart<D: Method>(method: D) {
        let row = Row::<f64>::new(RowParameters::default()).unwrap();
        let (sparse, dense) = (end(&row, method), end(&Dense(row), method));
        assert!(
            (sparse - dense).norm() < 1e-11 * dense.norm(),
            "{}",
            D::NAME
        );
    }
    apart(Rodas5P);
    apart(Radau5);
    apart(mbg_runtime::ImplicitMidpoint::default());
}
