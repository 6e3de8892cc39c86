//! Parts of drivelines: each against its law in closed form, and with its energy in balance.
#![allow(clippy::unwrap_used)]

mod models;

use mbg_compiler::compile::{Compiled, Routines};
use mbg_compiler::program::{self, Arguments};
use models::{assert_lossless, assert_near, attempted, compiled, run};

/// Two shafts of the inertias 0.2 and 1.5 with something between them.
fn shafts(part: &str, outputs: &str) -> Compiled {
    compiled(&format!(
        "model M {{
            param capacity: N*m = 30.0; param width: rad/s = 0.5; input pedal;
            1 a {{ I engine {{ inertia: 0.2 }} }} 1 b {{ I load {{ inertia: 1.5 }} }}
            part: {part};
            output pressed = pedal; {outputs}
        }}"
    ))
}

/// Results of a routine with the parameters of `shafts`, half of the pedal, and these speeds before other states.
fn at(model: &Compiled, routine: usize, [a, b]: [f64; 2], more: &[f64]) -> Vec<f64> {
    let mut state = vec![0.2 * a, 1.5 * b];
    state.extend_from_slice(more);
    let arguments = Arguments {
        parameters: &[30.0, 0.5],
        time: 0.0,
        state: &state,
        input: &[0.5],
    };
    program::evaluate(&model.program, routine, &arguments)
}

const SPEEDS: [[f64; 2]; 4] = [[4.0, 1.0], [1.0, 4.0], [-3.0, -2.9], [2.0, 2.0]];

#[test]
fn a_clutch_passes_on_its_capacity_while_it_slips() {
    let outputs = "output effort: N*m = part.effort; output slip: rad/s = part.slip;";
    let law = "capacity: capacity, engagement: pedal";
    let sharp = shafts(&format!("Clutch {{ {law} }} (a, b)"), outputs);
    let smooth = shafts(&format!("Clutch {{ {law}, speed: width }} (a, b)"), outputs);
    for [a, b] in SPEEDS {
        let slip: f64 = a - b;
        let sign = if slip == 0.0 { 0.0 } else { slip.signum() };
        for (model, share) in [(&sharp, sign), (&smooth, (slip / 0.5).tanh())] {
            let torque = 15.0 * share;
            let at = |routine| at(model, routine, [a, b], &[]);
            assert_near(&at(Routines::DERIVATIVE), &[-torque, torque], 1e-13);
            assert_near(&at(Routines::OUTPUT)[1..], &[torque, slip], 1e-13);
            assert_near(&at(Routines::POWER), &[0.0, torque * slip], 1e-13);
        }
    }
}

#[test]
fn a_freewheel_takes_the_load_along_one_way() {
    let outputs = "output effort: N*m = part.effort; output slip: rad/s = part.slip;";
    let sharp = shafts("Freewheel { capacity: capacity } (a, b)", outputs);
    let law = "Freewheel { capacity: capacity, speed: width } (a, b)";
    let smooth = shafts(law, outputs);
    for [a, b] in SPEEDS {
        let slip: f64 = a - b;
        let share = if slip > 0.0 { 1.0 } else { 0.0 };
        for (model, share) in [(&sharp, share), (&smooth, (slip / 0.5).tanh().max(0.0))] {
            let torque = 30.0 * share;
            let at = |routine| at(model, routine, [a, b], &[]);
            assert_near(&at(Routines::DERIVATIVE), &[-torque, torque], 1e-13);
            assert_near(&at(Routines::OUTPUT)[1..], &[torque, slip], 1e-13);
            assert_near(&at(Routines::POWER), &[0.0, torque * slip], 1e-13);
        }
    }
}

#[test]
fn a_brake_holds_against_the_motion() {
    let outputs = "output effort: N*m = part.effort;";
    let sharp = shafts("Brake { capacity: capacity } (a)", outputs);
    let smooth = shafts(
        "Brake { capacity: capacity, engagement: pedal, speed: width } (a)",
        outputs,
    );
    for [a, b] in SPEEDS {
        let laws = [
            (&sharp, 30.0 * a.signum()),
            (&smooth, 15.0 * (a / 0.5).tanh()),
        ];
        for (model, torque) in laws {
            let at = |routine| at(model, routine, [a, b], &[]);
            assert_near(&at(Routines::DERIVATIVE), &[-torque, 0.0], 1e-13);
            assert_near(&at(Routines::OUTPUT)[1..], &[torque], 1e-13);
            assert_near(&at(Routines::POWER), &[0.0, torque * a], 1e-12);
        }
    }
}

/// Nothing within the gap; beyond it the flank pushes by its depth, more while that grows, and never pulls.
#[test]
fn backlash_pushes_beyond_its_gap_alone() {
    let model = shafts(
        "Backlash { gap: 0.04, stiffness: 2e3, dissipation: 0.3 } (a, b)",
        "output effort: N*m = part.effort; output twist: rad = part.twist;",
    );
    for [a, b] in [[4.0, 1.0], [1.0, 4.0], [9.0, 1.0], [1.0, 9.0]] {
        for twist in [-0.07, -0.021, -0.02, -0.01, 0.0, 0.0199, 0.03, 0.1] {
            let (slip, depth) = (a - b, f64::abs(twist) - 0.02);
            let approach = slip * twist.signum();
            let push = 2e3 * depth.max(0.0) * (1.0 + 0.3 * approach).max(0.0);
            let torque = push * twist.signum();
            let at = |routine| at(&model, routine, [a, b], &[twist]);
            assert_near(&at(Routines::DERIVATIVE), &[-torque, torque, slip], 1e-10);
            assert_near(&at(Routines::OUTPUT)[1..], &[torque, twist], 1e-10);
            let stored = 1e3 * depth.max(0.0).powi(2);
            let moving = 0.1 * a * a + 0.75 * b * b;
            assert_near(&at(Routines::ENERGY), &[stored + moving], 1e-12);
            // What is not stored is lost.
            let lost = torque * slip - 2e3 * depth.max(0.0) * approach;
            assert_near(&at(Routines::POWER), &[0.0, lost], 1e-9);
            assert!(lost >= -1e-12);
        }
    }
}

#[test]
fn an_elastic_shaft_is_a_spring_beside_a_damper() {
    let model = shafts(
        "ElasticShaft { stiffness: 400.0, damping: 2.0, initial: 0.1 } (a, b)",
        "output effort: N*m = part.effort; output twist: rad = part.twist;",
    );
    let initial = at(&model, Routines::INITIAL, [0.0; 2], &[0.0]);
    assert_eq!(initial, [0.0, 0.0, 0.1]);
    for [a, b] in SPEEDS {
        let (slip, twist) = (a - b, 0.03);
        let torque = 400.0 * twist + 2.0 * slip;
        let at = |routine| at(&model, routine, [a, b], &[twist]);
        assert_near(&at(Routines::DERIVATIVE), &[-torque, torque, slip], 1e-12);
        assert_near(&at(Routines::OUTPUT)[1..], &[torque, twist], 1e-12);
        assert_near(&at(Routines::POWER), &[0.0, 2.0 * slip * slip], 1e-12);
        let stored = 200.0 * twist * twist + 0.1 * a * a + 0.75 * b * b;
        assert_near(&at(Routines::ENERGY), &[stored], 1e-12);
    }
}

/// The pinion is braked by its oil alone: its torque is 7 − 0.3 of its speed.
#[test]
fn a_differential_halves_torque_and_takes_the_mean_of_speeds() {
    let text = |ratio: &str| {
        format!(
            "model M {{
                1 pinion {{ Se motor {{ effort: 7.0 }} R oil {{ resistance: 0.3 }} }}
                1 left {{ I one {{ inertia: 2.0 }} }} 1 right {{ I two {{ inertia: 3.0 }} }}
                axle: Differential {ratio} (pinion, left, right);
                output speed = pinion.f;
            }}"
        )
    };
    for (words, ratio) in [("{ ratio: 4.1 }", 4.1), ("", 1.0)] {
        let model = compiled(&text(words));
        for [left, right] in SPEEDS {
            let speed = ratio * (left + right) / 2.0;
            let side = ratio * (7.0 - 0.3 * speed) / 2.0;
            let state = [2.0 * left, 3.0 * right];
            let at = |routine| run(&model, routine, &state);
            assert_near(&at(Routines::OUTPUT), &[speed], 1e-13);
            assert_near(&at(Routines::DERIVATIVE), &[side, side], 1e-12);
            // What the sides gain is what the pinion gives.
            let gained = side * (left + right);
            let [supplied, lost] = at(Routines::POWER)[..] else {
                panic!("two powers")
            };
            assert_near(
                &[supplied, lost],
                &[7.0 * speed, 0.3 * speed * speed],
                1e-12,
            );
            assert_near(&[gained], &[supplied - lost], 1e-11);
        }
        assert_lossless(&model);
    }
}

/// Speeds by the equation of Willis for 30 teeth of the sun and 75 of the ring.
#[test]
fn a_planetary_gear_turns_as_its_teeth_say() {
    let gear = |held: &str| {
        compiled(&format!(
            "model M {{
                1 sun {{ Se motor {{ effort: 7.0 }} R oil {{ resistance: 0.3 }} }}
                1 carrier {{ I one {{ inertia: 2.0 }} }} 1 ring {{ {held} }}
                gear: Planetary {{ ratio: 75.0 / 30.0 }} (sun, carrier, ring);
                output speed = sun.f;
            }}"
        ))
    };
    let free = gear("I two { inertia: 3.0 }");
    for [carrier, ring] in SPEEDS {
        let speed = 3.5 * carrier - 2.5 * ring;
        let torque = 7.0 - 0.3 * speed;
        let state = [2.0 * carrier, 3.0 * ring];
        let at = |routine| run(&free, routine, &state);
        assert_near(&at(Routines::OUTPUT), &[speed], 1e-13);
        // Sun, ring and carrier in the ratio 1 : 2.5 : −3.5; what comes out of the carrier turns it.
        assert_near(
            &at(Routines::DERIVATIVE),
            &[3.5 * torque, -2.5 * torque],
            1e-12,
        );
        let expected = [7.0 * speed, 0.3 * speed * speed];
        assert_near(&at(Routines::POWER), &expected, 1e-12);
    }
    assert_lossless(&free);
    let held = gear("Sf case { flow: 0.0 }");
    let at = |routine| run(&held, routine, &[2.0 * 4.0]);
    assert_near(&at(Routines::OUTPUT), &[14.0], 1e-13);
    assert_near(
        &at(Routines::DERIVATIVE),
        &[3.5 * (7.0 - 0.3 * 14.0)],
        1e-12,
    );
}

/// A gap must be one, shafts have common flows, and what acts on them are torques.
#[test]
fn what_is_no_driveline_is_refused() {
    let between = |part: &str| {
        attempted(&format!(
            "model M {{ param length: m = 1.0; param torque: N*m = 1.0; output turn: rad/s = a.f; output both = length * torque;
             1 a {{ I m {{ inertia: 1.0 }} }} 1 b {{ I n {{ inertia: 1.0 }} }} 0 k {{ R r {{ resistance: 1.0 }} }} part: {part}; }}"
        ))
        .err()
    };
    let gap = "Backlash { gap: -0.1, stiffness: 1.0 } (a, b)";
    assert_eq!(between(gap), Some(vec!["MBG0213"]));
    assert_eq!(
        between("Clutch { capacity: 1.0 } (a, k)"),
        Some(vec!["MBG0222"])
    );
    assert_eq!(
        between("Clutch { capacity: length } (a, b)"),
        Some(vec!["MBG0501"])
    );
    assert_eq!(between("Clutch { capacity: torque } (a, b)"), None);
}
