//! Limits of stability of explicit methods, at steps of one length and to loose tolerances.

use mbg_runtime::{
    Adaptive, Auto, Dop853, Estimating, Fixed, Integrator, Method, Pirk8, Pirk16, Radau9, Real,
    Rk4, System, Tsit5, Variable, Verner9, mbg,
};
use nalgebra::SVector;

use crate::problems::{Law, Written, state};

const STEPS: f64 = 2000.0;

/// `ẋ = λ x` in real numbers, with the real and the imaginary part of λ.
#[derive(Clone, Copy)]
struct Mode([f64; 2]);

impl Law<2, 0> for Mode {
    const STATES: &'static [Variable] = &[state("real"), state("imaginary")];

    fn slope<T: Real>(&self, x: &SVector<T, 2>, _: &SVector<T, 0>) -> SVector<T, 2> {
        let [real, imaginary] = self.0.map(T::from_f64);
        SVector::from([
            real * x[0] - imaginary * x[1],
            imaginary * x[0] + real * x[1],
        ])
    }
}

/// How large a mode has become after many steps of length 1.
fn grown(method: impl Method, mode: [f64; 2]) -> f64 {
    let start = SVector::from([1.0, 0.0]);
    let mut last = start;
    let run = Fixed::new(method, 1.0);
    run.integrate(&Written(Mode(mode)), &(), 0.0, STEPS, start, |step| {
        last = *step.state()
    })
    .map_or(f64::INFINITY, |_| last.norm())
}

/// Along each axis a mode grows by less than 1e-6 a step up to the limit, and by more a hundredth beyond it.
fn assert_limits<M: Method>(method: M, real: f64, imaginary: f64) {
    let modes = [[real, 0.0], [0.0, imaginary]];
    for mode in modes.into_iter().filter(|mode| *mode != [0.0; 2]) {
        let rate = |part: f64| grown(method, mode.map(|it| part * it)).ln() / STEPS;
        let beyond = rate(1.01);
        assert!(beyond > 1e-6, "{} beyond {mode:?}: {beyond:e}", M::NAME);
        for part in [0.1, 0.3, 0.5, 0.6, 0.8, 0.99] {
            let within = rate(part);
            assert!(within < 1e-6, "{} at {part} {mode:?}: {within:e}", M::NAME);
        }
    }
}

#[test]
fn modes_grow_beyond_the_limits_of_stability_alone() {
    assert_limits(Rk4, -2.79, 2.83);
    assert_limits(Tsit5, -3.51, 0.0);
    assert_limits(Dop853, -6.39, 5.96);
    assert_limits(Verner9, -4.47, 2.75);
    assert_limits(Pirk8, -1.69, 1.70);
    assert_limits(Pirk16, -3.50, 3.47);
    // Below its limit this one grows, by as much as its documentation says.
    for tenths in 1..=22 {
        let rate = grown(Pirk16, [0.0, 0.1 * f64::from(tenths)]).ln() / STEPS;
        assert!(rate < 1e-9, "at {tenths} tenths: {rate:e}");
    }
}

/// What decays is gone at the end, however loose the tolerance.
fn assert_decays<M: Estimating>(method: M) {
    for tolerance in [0.1, 0.03, 0.01, 3e-3, 1e-3] {
        for mode in [[-1.0, 0.0], [-10.0, 0.0], [-9.0, 4.4], [-3.0, 300.0]] {
            let start = SVector::from([1.0, 0.0]);
            let mut last = start;
            Adaptive::new(method, tolerance, tolerance)
                .integrate(&Written(Mode(mode)), &(), 0.0, 100.0, start, |step| {
                    last = *step.state()
                })
                .unwrap();
            let size = last.norm();
            println!("{} {mode:?} to {tolerance:e}: {size:e}", M::NAME);
            assert!(size < 200.0 * tolerance.min(1e-2));
        }
    }
}

#[test]
fn loose_tolerances_do_not_let_modes_grow() {
    assert_decays(Tsit5);
    assert_decays(Dop853);
    assert_decays(Verner9);
    assert_decays(Pirk8);
    assert_decays(Pirk16);
}

mbg! {
    /// A loudspeaker, whose current settles fast beside the motion of its cone.
    model Speaker {
        1 coil { I field { inertia: 5e-4 } R wire { resistance: 6.0 } Se drive { effort: 10.0 * sin(300.0 * t) } }
        1 cone { I mass { inertia: 0.02 } C rim { stiffness: 1500.0 } R air { resistance: 1.5 } }
        coil -> GY motor { effort: 7.0 } -> cone;
        output current = coil.f;
    }
}

/// Where stability limits steps what settles fast is small at their ends, and is to be so in between.
#[test]
fn samples_are_as_exact_as_the_ends_of_steps_that_stability_limits() {
    let model = Speaker::<f64>::new(SpeakerParameters::default()).unwrap();
    let times: Vec<f64> = (1..=400)
        .map(|number| 2.49e-4 * f64::from(number))
        .collect();
    macro_rules! by {
        ($solver:expr) => {{
            let mut samples = Vec::new();
            let start = model.initial_state();
            let run = $solver.sample(&model, &(), 0.0, start, &times, |_, x| samples.push(*x));
            run.unwrap();
            samples
        }};
    }
    let exact = by!(Adaptive::new(Radau9, 1e-13, 1e-14));
    for tolerance in [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10] {
        let found = [
            ("Tsit5", by!(Adaptive::new(Tsit5, tolerance, tolerance))),
            ("Dop853", by!(Adaptive::new(Dop853, tolerance, tolerance))),
            ("Verner9", by!(Adaptive::new(Verner9, tolerance, tolerance))),
            ("Auto", by!(Auto::new(tolerance, tolerance))),
        ];
        for (name, found) in found {
            let errors = found.iter().zip(&exact).map(|(a, b)| (a - b).amax());
            let error = errors.fold(0.0, f64::max) / tolerance;
            assert!(error < 6.0, "{name} at {tolerance:e}: {error} times that");
        }
    }
}
