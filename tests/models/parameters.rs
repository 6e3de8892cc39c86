//! What `new` refuses, and that it refuses nothing else.

use mbg_runtime::{Convertible, ParameterError, Rk4, System, mbg};
use nalgebra::SVector;

use super::behaviour::{Ladder, LadderParameters, Oscillator, OscillatorParameters};
use crate::ins::{Ins, InsClassic, InsClassicParameters, InsParameters, gust};

mbg! {
    /// Resistors that must take the effort, or the flow, whatever their law is given as.
    pub(crate) model Leaks {
        param leak: ohm = 2.0;
        param bypass: S = 0.5;
        param drag: N*s/m = 3.0;
        param slip: m/(N*s) = 0.25;
        0 node {
            C store { compliance: 0.5, initial: 1.0 }
            R by_resistance { resistance: leak }
            R by_conductance { conductance: bypass }
        }
        1 body {
            I mass { inertia: 1.0, initial_flow: 1.0 }
            R by_drag { resistance: drag }
            R by_slip { conductance: slip }
        }
        output loss: A = by_resistance.f;
    }
}

mbg! {
    /// Masses on springs of their own.
    pub(crate) model Springs {
        param stiffness[3]: N/m = [2.0, 3.0, 4.0];
        param drag[3]: N*s/m = 0.0;
        param mass[1]: kg = [0.5];
        cells: for k in 0..3 {
            1 cell {
                I body { inertia: mass[0] }
                C spring { stiffness: stiffness[k], initial: 1.0 }
                R damper { resistance: drag[k] }
            }
        }
        output effort[3]: N = [cells[0].spring.e, cells[1].spring.e, cells[2].spring.e];
    }
}

mbg! {
    /// Resistors in a ladder, each rung of twice what leads to it.
    pub(crate) model Rungs {
        param resistance: ohm = 1.0;
        let count = 12;
        0 ground; Se earth { effort: 0.0 } -> ground;
        ends: for k in 0..count + 1 { 0 node; }
        Se supply { effort: 1.0 } -> ends[0].node;
        rungs: for k in 0..count {
            along: Resistor { resistance: resistance } (ends[k].node, ends[k + 1].node);
            across: Resistor { resistance: 2.0 * resistance } (ends[k + 1].node, ground);
        }
        coil: Inductor { inductance: 1.0 } (ends[count].node, ground);
        output current: A = rungs[0].along.current;
    }
}

#[track_caller]
fn refused<T>(result: Result<T, ParameterError>, name: &str, value: f64, reason: &str) {
    match result {
        Ok(_) => panic!("`{name}` = {value} was accepted"),
        Err(error) => {
            assert_eq!(error.name, name);
            assert!(error.value == value || error.value.is_nan() && value.is_nan());
            assert_eq!(error.reason, reason);
        }
    }
}

#[test]
fn a_parameter_may_be_a_vector() {
    let found = |parameters: SpringsParameters| {
        let model = Springs::new(parameters).unwrap();
        let (start, none) = (model.initial_state(), SVector::zeros());
        let rates = model.derivative(0.0, &start, &none, &mut ());
        let moving = start.map(|_| 1.0);
        let drag = model.power(0.0, &moving, &none, &mut ()).dissipated;
        let energy = model.energy(0.0, &start);
        (
            model.output(0.0, &start, &none, &mut ()),
            rates.min(),
            drag,
            energy,
        )
    };
    let effort = |x, y, z| SVector::from([x, y, z]);
    let default = SpringsParameters::default();
    assert_eq!(found(default), (effort(2.0, 3.0, 4.0), -4.0, 0.0, 4.5));
    let other = SpringsParameters {
        stiffness: [5.0, 6.0, 7.0],
        drag: [0.0, 0.25, 0.5],
        mass: [0.5],
    };
    // Momenta of one in half a kilogram are flows of two.
    assert_eq!(found(other), (effort(5.0, 6.0, 7.0), -7.0, 3.0, 9.0));
    let model = Springs::new(other).unwrap();
    assert_eq!(*model.converted(f64::from).parameters(), other);
    assert_eq!(
        model.converted(|it| it as f32).parameters().drag,
        [0.0, 0.25, 0.5]
    );
    let names = Springs::<f64>::META.parameters.iter().map(|it| it.name);
    assert_eq!(
        names.collect::<Vec<_>>().join(" "),
        "stiffness.x stiffness.y stiffness.z drag.x drag.y drag.z mass"
    );
    let stiffness = [5.0, f64::INFINITY, 7.0];
    let reason = "it must be a finite number";
    refused(
        Springs::new(SpringsParameters { stiffness, ..other }),
        "stiffness.y",
        f64::INFINITY,
        reason,
    );
    refused(
        Springs::new(SpringsParameters {
            mass: [0.0],
            ..other
        }),
        "mass",
        0.0,
        "it must be positive: it is the inertia of `cells[0].body`",
    );
}

#[test]
fn an_inertia_must_be_positive() {
    for mass in [0.0, -0.0, -2.0] {
        let parameters = OscillatorParameters {
            mass,
            ..OscillatorParameters::default()
        };
        let reason = "it must be positive: it is the inertia of `body`";
        refused(Oscillator::new(parameters), "mass", mass, reason);
    }
    let lightest = OscillatorParameters {
        mass: f64::MIN_POSITIVE,
        ..OscillatorParameters::default()
    };
    assert!(Oscillator::new(lightest).is_ok());
}

#[test]
fn what_is_divided_by_must_have_a_reciprocal() {
    let reason = "its reciprocal must be a finite number";
    let lightest = OscillatorParameters {
        mass: 1e-320,
        ..OscillatorParameters::default()
    };
    refused(Oscillator::new(lightest), "mass", 1e-320, reason);
    // In single precision a mass is too small sooner.
    let lightest = OscillatorParameters {
        mass: 1e-39_f32,
        ..OscillatorParameters::default()
    };
    assert!(Oscillator::new(lightest).is_err());
}

#[test]
fn a_resistor_must_have_the_inverse_that_its_stroke_needs() {
    let default = LeaksParameters::default();
    let leaks = |leak, bypass, drag, slip| {
        Leaks::new(LeaksParameters {
            leak,
            bypass,
            drag,
            slip,
        })
    };
    let LeaksParameters {
        leak,
        bypass,
        drag,
        slip,
    } = default;
    let reason = "it must not be zero: the chosen causality divides by it";
    refused(leaks(0.0, bypass, drag, slip), "leak", 0.0, reason);
    refused(leaks(leak, bypass, drag, 0.0), "slip", 0.0, reason);
    // Nothing divides by a conductance that takes the effort, nor by a resistance that takes the flow.
    assert!(leaks(leak, 0.0, 0.0, slip).is_ok());
    // A negative resistance is active, not singular.
    assert!(leaks(-leak, bypass, drag, -slip).is_ok());
}

#[test]
fn every_parameter_must_be_a_finite_number() {
    let reason = "it must be a finite number";
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let with = |drag, stiffness, damping| {
            let ins = InsParameters {
                drag,
                stiffness,
                damping,
            };
            let classic = InsClassicParameters {
                drag,
                stiffness,
                damping,
            };
            (Ins::new(ins), InsClassic::new(classic))
        };
        for (name, (ins, classic)) in [
            ("drag", with(value, 1e-5, 1e-5)),
            ("stiffness", with(1e3, value, 1e-5)),
            ("damping", with(1e3, 1e-5, value)),
        ] {
            refused(ins, name, value, reason);
            refused(classic, name, value, reason);
        }
    }
}

#[test]
fn the_navigation_system_runs_without_friction_and_springs() {
    let free = Ins::new(InsParameters {
        drag: 0.0,
        stiffness: 0.0,
        damping: 0.0,
    })
    .unwrap();
    let mut last = free.initial_state();
    let damped = Ins::new(InsParameters {
        damping: 0.0,
        ..InsParameters::default()
    })
    .unwrap();
    Rk4::fixed(
        &damped,
        &gust(0.1),
        0.0,
        5.0,
        1e-2,
        damped.initial_state(),
        |_, x| last = *x,
    )
    .unwrap();
    assert!(last[6] < -0.1, "the fuselage turned about its gimbals");
    Rk4::fixed(
        &free,
        &gust(0.1),
        0.0,
        1.5,
        1e-2,
        free.initial_state(),
        |_, x| last = *x,
    )
    .unwrap();
    // Nothing holds the platform and nothing brakes the fuselage.
    assert_eq!(last.rows(3, 3).amax(), 0.0);
    assert!(last.rows(0, 3).norm() > 1000.0);
}

#[test]
fn a_loop_is_refused_where_its_determinant_vanishes() {
    let ladder = |r1, r2| Ladder::new(LadderParameters { r1, r2 });
    let reason = "it must not be zero: the chosen causality divides by it";
    refused(ladder(0.0, 0.0), "r1 + r2 + r1 r2", 0.0, reason);
    refused(ladder(1.0, -0.5), "r1 + r2 + r1 r2", 0.0, reason);
    // One resistor alone may be a plain wire.
    assert!(ladder(0.0, 3.0).is_ok());
    assert!(ladder(2.0, 0.0).is_ok());
}

/// The product of all that is divided by would be beyond single precision.
#[test]
fn resistances_of_any_size_are_taken_in_single_precision() {
    for resistance in [1e-9_f32, 1e-3, 1.0, 1e3, 1e6, 1e9] {
        let model = Rungs::new(RungsParameters { resistance }).unwrap();
        let current = model.output(0.0, &SVector::from([0.0]), &SVector::zeros(), &mut ())[0];
        assert!((current * resistance - 0.5).abs() < 1e-6, "{resistance:e}");
    }
}

mbg! {
    /// A slide between two ends.
    model Range {
        param lower: m = -1.0;
        param upper: m = 2.0;
        param count = 1.0;
        assert lower < upper && count >= 1.0;
        1 way { I mass { inertia: count } C ends { effort: 1e3 * (min(q - lower, 0.0) + max(q - upper, 0.0)) } }
    }
}

#[test]
fn what_is_asserted_of_parameters_is_asked_by_new() {
    let of = |lower, upper, count| {
        Range::new(RangeParameters {
            lower,
            upper,
            count,
        })
    };
    assert!(of(-1.0, 2.0, 1.0).is_ok());
    let reason = "it must be positive: `lower < upper` is asserted";
    refused(of(2.0, 2.0, 1.0), "upper - lower", 0.0, reason);
    refused(of(3.0, 2.0, 1.0), "upper - lower", -1.0, reason);
    let reason = "it must not be negative: `count >= 1.0` is asserted";
    refused(of(-1.0, 2.0, 0.5), "count - 1", -0.5, reason);
}
