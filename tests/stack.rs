//! Large models: implicit methods keep a few matrices of them on the stack, and no more than fit on that of a main thread.

#![allow(clippy::unwrap_used)]

#[allow(dead_code, reason = "other tests use more of it")]
#[path = "../examples/methods/problems.rs"]
mod problems;

use mbg_runtime::{Adaptive, Auto, Integrator, Picked, Radau5, Real, Variable};
use nalgebra::SVector;
use problems::{Law, Written};

/// Nothing is optimised with assertions, and more is copied.
const STATES: usize = if cfg!(debug_assertions) { 150 } else { 300 };
/// Of a main thread on most systems.
const STACK: usize = 8 << 20;

/// Conduction between neighbours, in 1/s: the fastest mode decays at four times that.
const RATE: f64 = 9e4;

/// Temperatures of a rod between ends at zero.
#[derive(Clone, Copy)]
struct Rod;

impl Law<STATES, 0> for Rod {
    const STATES: &'static [Variable] = &[];

    fn slope<T: Real>(&self, x: &SVector<T, STATES>, _: &SVector<T, 0>) -> SVector<T, STATES> {
        let at = |place: usize| x.get(place).copied().unwrap_or(T::from_f64(0.0));
        SVector::from_fn(|place, _| {
            let before = at(place.wrapping_sub(1));
            T::from_f64(RATE) * (before + at(place + 1) - x[place] - x[place])
        })
    }
}

const TIME: f64 = 0.1;

/// What is left of a half wave, which has one rate of decay.
fn cooled(solver: impl Integrator<STATES>) -> f64 {
    let wave =
        |place: usize| f64::sin(std::f64::consts::PI * (place + 1) as f64 / (STATES + 1) as f64);
    let start = SVector::from_fn(|place, _| wave(place));
    let mut last = 0.0;
    let run = solver.integrate(&Written(Rod), &(), 0.0, TIME, start, |step| {
        last = step.state()[STATES / 2];
    });
    run.unwrap();
    last / wave(STATES / 2)
}

fn in_a_thread(run: impl FnOnce() -> f64 + Send + 'static) -> f64 {
    let thread = std::thread::Builder::new().stack_size(STACK);
    thread.spawn(run).unwrap().join().unwrap()
}

#[test]
fn hundreds_of_states_fit_on_the_stack_of_a_main_thread() {
    let decay = 2.0 * RATE * (1.0 - f64::cos(std::f64::consts::PI / (STATES + 1) as f64));
    let exact = f64::exp(-decay * TIME);
    let found = [
        in_a_thread(|| cooled(Auto::new(1e-4, 1e-6))),
        in_a_thread(|| cooled(Auto::new(1e-6, 1e-8))),
        in_a_thread(|| cooled(Adaptive::new(Radau5, 1e-4, 1e-6))),
    ];
    for cooled in found {
        assert!((cooled / exact - 1.0).abs() < 1e-2, "{found:?} {exact}");
    }
}

#[test]
fn the_rod_is_stiff_for_auto() {
    let picked = |relative: f64| {
        in_a_thread(move || {
            let start = SVector::from_element(1.0);
            let auto = Auto::new(relative, 1e-8);
            let choice = auto.choose(&Written(Rod), &(), 0.0, TIME, start).unwrap();
            f64::from(u8::from(choice.method == Picked::Radau9))
        })
    };
    assert_eq!([picked(1e-4), picked(1e-6)], [0.0, 1.0]);
}
