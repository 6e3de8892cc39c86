//! Laws that change by time alone: steps end where they do.

use mbg_runtime::lanes::f64x4;
use mbg_runtime::{
    Adaptive, Auto, Dop853, Dual, Fixed, Gauss6, Integrator, Pirk8, Radau5, Radau9, Real, Rk4,
    Rodas5P, System, Tsit5, mbg,
};

mbg! {
    /// A wheel that a short torque drives, from some time on, and one that rises for a while.
    pub(crate) model Kicked {
        param start: s = 5.0;
        param rise: N*m/s = 0.5;
        1 shaft {
            I wheel { inertia: 1.0, initial: 1.0 }
            R bearing { resistance: 0.1 }
            Se kick { effort: if t > start && t < start + 0.05 { 20.0 } else { 0.0 } }
            Se ramp { effort: min(max(rise * (t - 7.0), 0.0), 1.0) }
        }
        output rate: rad/s = shaft.f;
    }
}

/// What a torque that lasts for a while leaves at 10 s.
fn left(torque: f64, from: f64, to: f64) -> f64 {
    10.0 * torque * (f64::exp(0.1 * (to - 10.0)) - f64::exp(0.1 * (from - 10.0)))
}

/// The rate at 10 s.
fn expected(start: f64) -> f64 {
    // ∫ (s − 7) / 2 exp((s − 10) / 10) ds has the antiderivative 5 (s − 17) exp((s − 10) / 10).
    let ramp = |s: f64| 5.0 * (s - 17.0) * f64::exp(0.1 * (s - 10.0));
    f64::exp(-1.0) + left(20.0, start, start + 0.05) + ramp(9.0) - ramp(7.0) + left(1.0, 9.0, 10.0)
}

fn at_end<T: Real>(start: T, solver: &impl Integrator<1>) -> T {
    let parameters = KickedParameters {
        start,
        ..Default::default()
    };
    let model = Kicked::new(parameters).unwrap();
    let mut last = model.initial_state();
    let (begin, end) = (T::from_f64(0.0), T::from_f64(10.0));
    solver
        .integrate(&model, &(), begin, end, last, |step| last = *step.state())
        .unwrap();
    last[0]
}

#[test]
fn a_short_pulse_of_a_law_is_met_by_all_methods() {
    for start in [5.0, 0.0, 1.0 / 3.0, 9.9] {
        for found in [
            at_end(start, &Adaptive::new(Tsit5, 1e-9, 1e-9)),
            at_end(start, &Adaptive::new(Dop853, 1e-9, 1e-9)),
            at_end(start, &Adaptive::new(Rodas5P, 1e-9, 1e-9)),
            at_end(start, &Adaptive::new(Radau5, 1e-9, 1e-9)),
            at_end(start, &Adaptive::new(Radau9, 1e-9, 1e-9)),
            at_end(start, &Adaptive::new(Pirk8, 1e-9, 1e-9)),
            at_end(start, &Auto::new(1e-9, 1e-9)),
            at_end(start, &Fixed::new(Rk4, 0.05)),
            at_end(start, &Fixed::new(Gauss6::default(), 0.5)),
        ] {
            let error = found - expected(start);
            assert!(error.abs() < 3e-8, "{start}: {error:e}");
        }
    }
}

/// Four wheels in lanes that are kicked at different times.
#[test]
fn changes_of_all_lanes_are_met() {
    let starts = [5.0, 0.5, 2.0 / 3.0, 8.0];
    let found = at_end(f64x4::from(starts), &Adaptive::new(Dop853, 1e-9, 1e-9));
    for (start, found) in starts.into_iter().zip(<[f64; 4]>::from(found)) {
        assert!((found - expected(start)).abs() < 1e-8, "{start}: {found}");
    }
    let found = at_end(5.0_f32, &Fixed::new(Rk4, 0.1));
    assert!((f64::from(found) - expected(5.0)).abs() < 1e-5, "{found}");
}

/// How much sooner or later the torque comes.
#[test]
fn times_of_changes_have_their_slopes() {
    let slope = |start: f64| {
        20.0 * (f64::exp(0.1 * (start + 0.05 - 10.0)) - f64::exp(0.1 * (start - 10.0)))
    };
    let close = |found: f64, start: f64| {
        let error = found - slope(start);
        assert!(error.abs() < 1e-8, "{start}: {error:e}");
    };
    for start in [5.0, 1.0 / 3.0, 9.9] {
        let varied = Dual::variable(start);
        close(
            at_end(varied, &Adaptive::new(Tsit5, 1e-9, 1e-9)).slope,
            start,
        );
        close(
            at_end(varied, &Adaptive::new(Dop853, 1e-9, 1e-9)).slope,
            start,
        );
        close(
            at_end(varied, &Adaptive::new(Rodas5P, 1e-9, 1e-9)).slope,
            start,
        );
        close(
            at_end(varied, &Adaptive::new(Radau9, 1e-9, 1e-9)).slope,
            start,
        );
        close(
            at_end(varied, &Adaptive::new(Pirk8, 1e-9, 1e-9)).slope,
            start,
        );
        close(at_end(varied, &Auto::new(1e-9, 1e-9)).slope, start);
        close(at_end(varied, &Fixed::new(Rk4, 0.05)).slope, start);
    }
    let starts = [5.0, 0.5, 2.0 / 3.0, 8.0];
    let varied = Dual::variable(f64x4::from(starts));
    let found = at_end(varied, &Adaptive::new(Dop853, 1e-9, 1e-9));
    for (start, found) in starts.into_iter().zip(<[f64; 4]>::from(found.slope)) {
        close(found, start);
    }
}

#[test]
fn a_model_tells_its_changes() {
    let model = Kicked::<f64>::new(KickedParameters::default()).unwrap();
    let mut times = Vec::new();
    let mut time = f64::NEG_INFINITY;
    while let Some(next) = model.next_change(time) {
        times.push(next);
        time = next;
    }
    assert_eq!(times, [5.0, 5.05, 7.0, 9.0]);
}
