//! Mechanisms whose loops are closed by multipliers.

use mbg_runtime::{Adaptive, Constant, Dop853, Integrator, System, mbg};
use nalgebra::SVector;

use crate::references::errors::{apart, larger};

mbg! {
    /// Crank, coupler and rocker between two fixed hinges 1 m apart.
    #[derivative]
    pub(crate) model FourBar {
        causality componentwise;
        gravity [0.0, -9.81];
        param damping: N*m*s/rad = 0.0;

        1 base[3]; 1 crank_tip[3]; 1 coupler_tip[3]; 1 rocker_tip[3];
        Sf fixed[3] { flow: 0.0 } -> base;
        crank: PlanarLink {
            mass: 1.0, inertia: 0.0075, centre: [0.15, 0.0], end: [0.3, 0.0], initial: 1.0, damping: damping
        } (base, crank_tip);
        coupler: PlanarLink {
            mass: 2.0, inertia: 0.135, centre: [0.45, 0.0], end: [0.9, 0.0], damping: damping
        } (crank_tip, coupler_tip);
        rocker: PlanarLink {
            mass: 1.5, inertia: 0.06125, centre: [0.35, 0.0], end: [0.7, 0.0], initial: 1.2, damping: damping,
            position_a: [1.0, 0.0]
        } (base, rocker_tip);

        let open = coupler.position_b - rocker.position_b;
        close coupler_tip[1..3] -> rocker_tip[1..3] by multipliers, displacement: open;
        output gap[2]: m = open;
        output potential: J = 9.81 * (
            crank.position_centre.y + 2.0 * coupler.position_centre.y + 1.5 * rocker.position_centre.y
        );
    }
}

/// The state with the crank where the model puts it, and everything else where it must be.
fn start(model: &FourBar) -> SVector<f64, 6> {
    let crank = FourBar::<f64>::META
        .states
        .iter()
        .position(|state| state.name == "crank.hinge.angle")
        .unwrap();
    let guess = model.initial_state();
    let start = model
        .close(0.0, guess, &SVector::from([]), &[crank])
        .unwrap();
    assert_eq!(start[crank], guess[crank]);
    start
}

#[test]
fn four_bar_stays_closed_and_keeps_its_energy() {
    let model = FourBar::new(FourBarParameters::default()).unwrap();
    let u = SVector::from([]);
    let start = start(&model);
    let total = |t, x: &SVector<f64, 6>| {
        let output = model.output(t, x, &u, &mut ());
        (
            apart(&output.as_slice()[..2], &[0.0; 2]),
            model.energy(t, x) + output[2],
        )
    };
    let (_, first) = total(0.0, &start);
    let solver = Adaptive::new(Dop853, 1e-10, 1e-12);
    let (mut gap, mut drift) = (0.0_f64, 0.0_f64);
    solver
        .integrate(&model, &Constant(u), 0.0, 5.0, start, |step| {
            let (open, energy) = total(step.end(), step.state());
            gap = larger(gap, open);
            drift = larger(drift, (energy - first).abs());
        })
        .unwrap();
    assert!(gap < 1e-12, "{gap:e}");
    assert!(drift < 1e-8 * first.abs(), "{drift:e} of {first}");
}

#[test]
fn jacobian_holds_through_the_multipliers() {
    let model = FourBar::new(FourBarParameters { damping: 0.01 }).unwrap();
    let mut x = start(&model);
    x[3] = 2.0;
    let u = SVector::from([]);
    let exact = model.jacobian_state(0.0, &x, &u, &mut ());
    for column in 0..6 {
        let at = |step: f64| {
            let mut moved = x;
            moved[column] += step;
            model.derivative(0.0, &moved, &u, &mut ())
        };
        // Central differences of fourth order.
        let h = 1e-3;
        let slope = (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h);
        let error = (exact.column(column) - slope).amax();
        assert!(error < 1e-7 * exact.amax(), "{column}: {error:e}");
    }
}

#[test]
fn a_loop_that_cannot_close_is_named() {
    let model = FourBar::new(FourBarParameters::default()).unwrap();
    let u = SVector::from([]);
    // Crank and rocker point away from each other: the gap is longer than the coupler.
    let apart = SVector::from([3.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let trouble = model.close(0.0, apart, &u, &[0, 2]).unwrap_err();
    assert!(
        trouble
            .to_string()
            .starts_with("the loop `coupler_tip[1..3] -> rocker_tip[1..3]` cannot be closed")
    );
}
