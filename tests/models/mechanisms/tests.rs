//! What the runs must show, and what holds at any state at which all loops are closed.

use mbg_runtime::{Dual, System};
use nalgebra::SVector;

use super::super::audit::Probe;
use super::andrews::{Andrews, AndrewsParameters};
use super::bricard::{Bricard, BricardParameters};
use super::four_bars::{FourBar, FourBarParameters, FourBars2, FourBars2Parameters};
use super::governor::{Governor, GovernorParameters};
use super::slider_crank::{
    PlanarSliderCrank, PlanarSliderCrankParameters, SpatialSliderCrank,
    SpatialSliderCrankParameters,
};
use super::{Figures, andrews, bricard, four_bars, governor, slider_crank, states};
use crate::references::noise::noise;

/// Loops stay closed, energy is kept, and the point is within its own tolerance.
#[track_caller]
fn check(found: &Figures, rank: usize, point: f64, energy: f64) {
    let name = found.mechanism;
    assert_eq!(found.closing[1], rank, "{name}");
    assert!(found.gap < 1e-12, "{name} {:e}", found.gap);
    assert!(found.point < point, "{name} {:e}", found.point);
    assert!(found.energy < energy, "{name} {:e}", found.energy);
}

#[test]
fn andrews_squeezer_meets_the_reference() {
    check(&andrews::run(), 6, 1e-11, 1e-12);
}

#[test]
fn four_bars_turn_over_through_their_singular_position() {
    // Rounding grows as the inverse cube of the smallest singular value there, so another order of operations moves point
    // and energy by a factor of ten and more.
    check(&four_bars::run1(), 2, 1e-5, 1e-7);
    check(&four_bars::run2(), 4, 1e-5, 1e-7);
    check(&four_bars::run5(), 10, 1e-5, 1e-7);
}

#[test]
fn slider_cranks_pass_their_dead_centres() {
    check(&slider_crank::planar(), 2, 1e-9, 1e-10);
    check(&slider_crank::spatial(), 3, 1e-7, 1e-9);
}

#[test]
fn bricards_mechanism_moves_though_one_equation_is_redundant() {
    check(&bricard::run(), 4, 1e-9, 1e-10);
}

#[test]
fn governor_meets_the_reference() {
    check(&governor::run(), 0, 1e-11, 1e-12);
}

/// Audits a model at states near the start at which all loops are closed, with rates up to the one given.
#[track_caller]
fn sound<S, D, const N: usize, const P: usize>((plain, dual): (&S, &D), rate: f64)
where
    S: System<f64, N, 0, P>,
    D: System<Dual<f64>, N, 0, P>,
{
    let mut next = noise(3);
    let rates = states(S::META, "rate.f");
    for _ in 0..20 {
        let moved =
            SVector::from_fn(|place, _| next() * if rates.contains(&place) { rate } else { 0.2 });
        let input = SVector::zeros();
        let state = plain
            .close(0.0, plain.initial_state() + moved, &input, &[])
            .unwrap();
        let probe = Probe {
            model: dual,
            time: 0.0,
            state,
            input,
        };
        probe.assert_sound(plain);
    }
}

/// Models for numbers and for dual numbers, with their default parameters.
macro_rules! both {
    ($model:ident, $parameters:ident) => {
        (
            &$model::<f64>::new($parameters::default()).unwrap(),
            &$model::<Dual<f64>>::new($parameters::default()).unwrap(),
        )
    };
}

#[test]
fn no_energy_is_created_and_jacobians_are_right() {
    sound(both!(Andrews, AndrewsParameters), 200.0);
    sound(both!(FourBar, FourBarParameters), 1.0);
    sound(both!(FourBars2, FourBars2Parameters), 1.0);
    sound(both!(PlanarSliderCrank, PlanarSliderCrankParameters), 1.0);
    sound(both!(SpatialSliderCrank, SpatialSliderCrankParameters), 1.0);
    sound(both!(Bricard, BricardParameters), 1.0);
    sound(both!(Governor, GovernorParameters), 1.0);
}
