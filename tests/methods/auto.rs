//! What `Auto` picks, and what it makes of a run that turns out to be other than it looked.

use mbg_runtime::lanes::f64x4;
use mbg_runtime::{
    Adaptive, Auto, Constant, Dop853, Picked, Radau5, Real, Reason, Tsit5, Variable,
};
use nalgebra::SVector;

use crate::hard::end;
use crate::problems::{Law, RigidBody, Robertson, StiffPin, VanDerPol, Warmed, Written, state};

/// Decay at a rate that is an input, each lane at its own.
#[derive(Clone, Copy)]
struct Decay;

impl Law<1, 1> for Decay {
    const STATES: &'static [Variable] = &[state("left")];

    fn slope<T: Real>(&self, x: &SVector<T, 1>, u: &SVector<T, 1>) -> SVector<T, 1> {
        SVector::from([-u[0] * x[0]])
    }
}

#[test]
fn auto_looks_at_all_lanes() {
    for place in 0..4 {
        let rates: [f64; 4] = std::array::from_fn(|lane| if lane == place { 1e6 } else { 1.0 });
        let input = Constant(SVector::from([f64x4::from(rates)]));
        let [start, end] = [0.0, 10.0].map(f64x4::from_f64);
        let x = SVector::from([f64x4::from_f64(1.0)]);
        let choice = Auto::new(1e-6, 1e-6).choose(&Written(Decay), &input, start, end, x);
        assert_eq!(choice.unwrap().method, Picked::Radau9, "{place}");
    }
}

#[test]
fn auto_tells_what_it_picks_and_meets_the_tolerance() {
    let auto = Auto::new(1e-6, 1e-6);
    let pin = StiffPin {
        stiffness: 1e8,
        damping: 1e3,
    };
    let (strict, _) = end(
        pin,
        Adaptive::new(Radau5, 1e-10, 1e-10),
        5.0,
        StiffPin::level(),
    );
    let choice = auto
        .choose(&Written(pin), &(), 0.0, 5.0, StiffPin::level())
        .unwrap();
    println!("{choice}");
    assert_eq!(
        (choice.method, choice.reason),
        (Picked::Radau9, Reason::StiffTight)
    );
    let moderate = Auto::new(1e-4, 1e-4);
    let choice = moderate.choose(&Written(pin), &(), 0.0, 5.0, StiffPin::level());
    assert_eq!(choice.unwrap().method, Picked::Radau5);
    assert!((end(pin, auto, 5.0, StiffPin::level()).0[2] - strict[2]).abs() < 1e-5);

    let start = SVector::from([2.0, 0.0]);
    let choice = auto
        .choose(&Written(VanDerPol), &(), 0.0, 2.0, start)
        .unwrap();
    println!("{choice}");
    assert_eq!(choice.method, Picked::Radau9);
    let choice = moderate.choose(&Written(VanDerPol), &(), 0.0, 2.0, start);
    assert_eq!(choice.unwrap().method, Picked::Rodas5P);
    assert!((end(VanDerPol, auto, 2.0, start).0[0] - VanDerPol::AFTER_2_S[0]).abs() < 1e-4);

    let start = SVector::from([1e-4, 10.0, 6e-4, 1.0, 0.0, 0.0, 0.0]);
    let choice = auto
        .choose(&Written(RigidBody), &(), 0.0, 100.0, start)
        .unwrap();
    println!("{choice}");
    assert_eq!(
        (choice.method, choice.reason),
        (Picked::Dop853, Reason::NotStiff)
    );
    let choice = Auto::new(1e-3, 1e-3).choose(&Written(RigidBody), &(), 0.0, 100.0, start);
    assert_eq!(choice.unwrap().reason, Reason::Loose);
    let choice = auto
        .choose(&Written(RigidBody), &(), 0.0, 0.1, start)
        .unwrap();
    assert_eq!(
        (choice.method, choice.reason),
        (Picked::Tsit5, Reason::ShortPiece)
    );
    let choice = auto
        .choose(&Written(RigidBody), &(), 0.0, 1.0, start)
        .unwrap();
    assert_eq!(choice.reason, Reason::NotStiff);

    // Not stiff at the start, soon after it is.
    let start = SVector::from([1.0, 0.0, 0.0]);
    let auto = Auto {
        nominal: &[1.0, 1e-5, 1.0],
        ..Auto::new(1e-6, 1e-6)
    };
    let (x, statistics) = end(Robertson, auto, 1e5, start);
    println!("{statistics:?}");
    assert!((x[0] / 0.017_865_921_142_1 - 1.0).abs() < 1e-5, "{x}");
    assert!(statistics.steps < 1000);
}

/// What decays fast is over before most of a method for smooth problems' steps, which stability keeps short.
#[test]
fn auto_takes_what_decays_for_long_as_stiff() {
    let start = SVector::from_fn(|place, _| if place == 0 { 1.0 } else { 0.0 });
    let auto = Auto::new(1e-6, 1e-6);
    for (time, picked) in [(0.5, Picked::Dop853), (20.0, Picked::Radau9)] {
        let choice = auto.choose(&Written(Warmed), &(), 0.0, time, start);
        assert_eq!(choice.unwrap().method, picked, "{time}");
    }
}

/// What hangs on a damped spring, whose other end moves to and fro at 1 rad/s.
#[derive(Clone, Copy)]
struct Shaken;

impl Law<4, 0> for Shaken {
    const STATES: &'static [Variable] = &[state(""); 4];

    fn slope<T: Real>(&self, x: &SVector<T, 4>, _u: &SVector<T, 0>) -> SVector<T, 4> {
        let [stiffness, damping] = [1e4, 60.0].map(T::from_f64);
        let force = stiffness * (x[0] - x[2]) + damping * (x[1] - x[3]);
        SVector::from([x[1], -x[0], x[3], force])
    }
}

/// What swings fast and is damped is not followed either, but for its first turns.
#[test]
fn auto_leaves_a_method_that_stability_keeps_to_short_steps() {
    let (time, start) = (40.0, SVector::from([0.0, 1.0, 0.0, 0.0]));
    let (exact, _) = end(Shaken, Adaptive::new(Radau5, 1e-11, 1e-11), time, start);
    for (tolerance, picked) in [
        (1e-3, Picked::Tsit5),
        (1e-4, Picked::Dop853),
        (1e-6, Picked::Dop853),
    ] {
        let auto = Auto::new(tolerance, tolerance);
        let choice = auto.choose(&Written(Shaken), &(), 0.0, time, start);
        assert_eq!(choice.unwrap().method, picked);
        let (x, taken) = end(Shaken, auto, time, start);
        let (_, followed) = match picked {
            Picked::Tsit5 => end(
                Shaken,
                Adaptive::new(Tsit5, tolerance, tolerance),
                time,
                start,
            ),
            _ => end(
                Shaken,
                Adaptive::new(Dop853, tolerance, tolerance),
                time,
                start,
            ),
        };
        println!("{tolerance:e}: {taken:?} instead of {followed:?}");
        assert!(
            3 * taken.evaluations < followed.evaluations,
            "{tolerance:e}"
        );
        assert!(
            (x - exact).amax() < 10.0 * tolerance,
            "{tolerance:e} {x} {exact}"
        );
    }
}

/// A pendulum that swings for a long time.
#[derive(Clone, Copy)]
struct Swings;

impl Law<2, 0> for Swings {
    const STATES: &'static [Variable] = &[state("angle"), state("rate")];

    fn slope<T: Real>(&self, x: &SVector<T, 2>, _u: &SVector<T, 0>) -> SVector<T, 2> {
        SVector::from([x[1], -x[0]])
    }
}

/// What swings for long goes through an angle as large as that of a stiff problem, and is followed.
#[test]
fn auto_leaves_a_method_for_stiff_problems_where_there_is_none() {
    let (time, start) = (2e4, SVector::from([1.0, 0.0]));
    for (tolerance, picked) in [(1e-4, Picked::Radau5), (1e-6, Picked::Radau9)] {
        let auto = Auto::new(tolerance, tolerance);
        let choice = auto.choose(&Written(Swings), &(), 0.0, time, start);
        assert_eq!(choice.unwrap().method, picked);
        let (x, taken) = end(Swings, auto, time, start);
        let (other, followed) = end(
            Swings,
            Adaptive::new(Dop853, tolerance, tolerance),
            time,
            start,
        );
        println!("{tolerance:e}: {taken:?}, as {followed:?}");
        assert!(
            taken.evaluations < followed.evaluations + 2000,
            "{tolerance:e}"
        );
        let error = |x: SVector<f64, 2>| (x[0] - f64::cos(time)).abs();
        assert!(error(x) < 1.2 * error(other), "{x} {other}");
    }
}
