//! Loops that multipliers close: at any state the rates of both ends are equal, whatever the joints, the base and the weight.
#![allow(clippy::unwrap_used)]

mod models;

use std::collections::BTreeMap;

use mbg_compiler::compile::{Compiled, Routines};
use mbg_compiler::expand;
use mbg_compiler::inclusion::no_file;
use mbg_compiler::program::{self, Arguments, Step};
use mbg_runtime::Dual;
use mbg_runtime::solve::project;
use models::dual::{Point, evaluate};
use models::{compiled, run};
use nalgebra::{SMatrix, SVector};
use quote::quote;

/// A base and a limb that stands on the ground, whose ends are held together.
fn model(base: &str, limb: &[&str], joint: &str, gravity: f64) -> String {
    let body = |name: &str, at: &str| {
        format!(
            "{name}: Body {{ mass: 1.5, inertia: diag(0.02, 0.03, 0.04), centre: [0.1, -0.2, 0.3] }} ({at});"
        )
    };
    let mut text = format!(
        "#[derivative] model M {{
            causality componentwise;
            gravity [0.0, 0.0, {gravity:?}];
            1 ground[6]; 1 plate[6]; 1 eye[6]; 1 frame0[6];
            Sf fixed[6] {{ flow: 0.0 }} -> ground;
            base: {base} (ground, plate);
            {}
            to_eye: Offset {{ by: [0.3, 0.1, -0.2] }} (plate, eye);
            foot: Offset {{ by: [0.5, 0.0, 0.0] }} (ground, frame0);",
        body("plate_body", "plate")
    );
    for (number, joint) in limb.iter().enumerate() {
        let next = number + 1;
        text += &format!(
            "1 frame{next}[6]; joint{next}: {joint} (frame{number}, frame{next}); {}",
            body(&format!("body{next}"), &format!("frame{next}"))
        );
    }
    let last = limb.len();
    text + &format!("last: {joint} (frame{last}, eye); }}")
}

/// A state by names, with attitudes of length one.
fn state(model: &Compiled) -> BTreeMap<&str, f64> {
    let states = model.states.iter().enumerate();
    let mut state: Vec<(&str, f64)> = states
        .map(|(place, state)| {
            let name = model.model.states[*state].variable.name.as_str();
            (name, 0.7 * (1.3 * place as f64 + 0.4).sin())
        })
        .collect();
    for row in model.attitudes.iter().flatten() {
        let length = row.iter().map(|place| state[*place].1.powi(2)).sum::<f64>();
        row.iter()
            .for_each(|place| state[*place].1 /= length.sqrt());
    }
    state.into_iter().collect()
}

/// Of what the states of a model are.
fn of<T: Copy>(model: &Compiled, values: &BTreeMap<&str, T>) -> Vec<T> {
    let name = |state: &usize| model.model.states[*state].variable.name.as_str();
    model
        .states
        .iter()
        .map(|state| values[name(state)])
        .collect()
}

fn rates(model: &Compiled, state: &[f64]) -> Vec<f64> {
    let arguments = Arguments {
        parameters: &[],
        time: 0.0,
        state,
        input: &[],
    };
    program::evaluate(&model.program, Routines::DERIVATIVE, &arguments)
}

fn size(rates: &[f64]) -> f64 {
    rates.iter().fold(0.0, |size, rate| size.max(rate.abs()))
}

/// By how much the flows of the ends move apart, over the size of the rates.
fn apart(model: &Compiled, state: &[f64], rates: &[f64]) -> f64 {
    let along = state.iter().zip(rates);
    let along: Vec<Dual<f64>> = along
        .map(|(value, slope)| Dual {
            value: *value,
            slope: *slope,
        })
        .collect();
    let point = Point {
        parameters: &[],
        time: Dual::constant(0.0),
        state: &along,
        input: &[],
    };
    let flows = evaluate(&model.program, Routines::CLOSED_FLOWS, &point);
    let flows = &flows[..model.closed[1].len()];
    let slopes: Vec<f64> = flows.iter().map(|flow| flow.slope).collect();
    size(&slopes) / size(rates)
}

/// By how much rates differ, over their size, with a weight of next to nothing and without: that changes how they are found, and which
/// angles are told, and nothing else. `inspect` is given both models with their states and rates.
fn weighed(
    (base, limb, joint): (&str, &[&str], &str),
    inspect: impl Fn(&Compiled, &[f64], &[f64]),
) -> f64 {
    let [light, heavy] = [0.0, -1e-14].map(|gravity| compiled(&model(base, limb, joint, gravity)));
    let state = state(&heavy);
    let [found, expected] = [&light, &heavy].map(|model| {
        let state = of(model, &state);
        let rates = rates(model, &state);
        inspect(model, &state, &rates);
        rates
    });
    let names = heavy.states.iter();
    let names = names.map(|it| heavy.model.states[*it].variable.name.as_str());
    let expected = of(&light, &names.zip(expected).collect());
    let differences: Vec<f64> = found.iter().zip(&expected).map(|(a, b)| a - b).collect();
    size(&differences) / size(&found)
}

fn stays_together(base: &str, limb: &[&str], cut: &str) {
    let case = format!("{base} {limb:?} {cut}");
    let cut = format!("Cut {{ joint: {cut} }}");
    let other = weighed((base, limb, &cut), |model, state, rates| {
        let apart = apart(model, state, rates);
        assert!(apart < 1e-12, "{case}: by {apart:e}");
    });
    assert!(other < 1e-10, "{case}: by {other:e}");
}

#[test]
fn ends_of_loops_stay_together_on_any_base() {
    // With so few freedoms, nothing else is held than the ends.
    for base in ["Spherical", "Planar { axis: 2 }"] {
        let limb = [
            "Revolute { axis: 2 }",
            "Revolute { axis: 1, offset: [0.2, 0.0, 0.1] }",
            "Spherical",
        ];
        for cut in ["spherical", "universal"] {
            stays_together(base, &limb, cut);
        }
    }
    let bases = ["Free", "Free { orientation: quaternion }"];
    let limbs: [&[&str]; 4] = [
        &[],
        &["Spherical"],
        &[
            "Universal { first: 0, second: 1 }",
            "Prismatic { axis: 2, initial: 0.7 }",
        ],
        &[
            "Revolute { axis: 2 }",
            "Revolute { axis: 1, offset: [0.2, 0.0, 0.1] }",
            "Spherical",
        ],
    ];
    for base in bases {
        for limb in limbs {
            for cut in ["spherical", "universal", "revolute"] {
                stays_together(base, limb, cut);
            }
        }
    }
}

/// The same of rings without a cut, in which rates follow from each other.
#[test]
fn rings_move_alike_with_and_without_a_weight() {
    let leg = [
        "Universal { first: 0, second: 1 }",
        "Prismatic { axis: 2, initial: 0.7 }",
    ];
    let arm = [
        "Revolute { axis: 2 }",
        "Revolute { axis: 1, offset: [0.2, 0.0, 0.1] }",
        "Universal { first: 0, second: 1 }",
    ];
    for base in ["Spherical", "Free", "Free { orientation: quaternion }"] {
        for limb in [&leg[..], &arm] {
            let other = weighed((base, limb, "Spherical"), |_, _, _| ());
            assert!(other < 1e-9, "{base} {limb:?}: by {other:e}");
        }
    }
}

/// What holds the links of a plane in it is zero, and not looked for at every state.
#[test]
fn constraints_that_nothing_breaks_are_not_solved_for() {
    let model = compiled(
        "#[derivative] model M {
            causality componentwise;
            gravity [0.0, -9.81, 0.0];
            1 ground[6]; 1 crank[6]; 1 joint[6]; 1 coupler[6]; 1 elbow[6]; 1 pivot[6]; 1 rocker[6]; 1 tip[6];
            Sf fixed[6] { flow: 0.0 } -> ground;
            first: Revolute { axis: 2, initial: -1.2 } (ground, crank);
            along_crank: Offset { by: [1.0, 0.0, 0.0] } (crank, joint);
            second: Revolute { axis: 2, initial: 1.2 } (joint, coupler);
            body: Body { mass: 2.0, inertia: diag(0.01, 0.3, 0.3), centre: [1.0, 0.0, 0.0] } (coupler);
            along_coupler: Offset { by: [2.0, 0.0, 0.0] } (coupler, elbow);
            base: Offset { by: [2.0, 0.0, 0.0] } (ground, pivot);
            third: Revolute { axis: 2, initial: -1.2 } (pivot, rocker);
            along_rocker: Offset { by: [1.0, 0.0, 0.0] } (rocker, tip);
            crank_body: Body { mass: 1.0, inertia: diag(0.01, 0.1, 0.1) } (joint);
            rocker_body: Body { mass: 1.0, inertia: diag(0.01, 0.1, 0.1) } (tip);
            cut: Cut { joint: fixed } (elbow, tip);
        }",
    );
    let steps = model.program.routines[Routines::DERIVATIVE].steps.iter();
    let solves = steps.filter_map(|step| match step {
        Step::Solve(solve) => Some(solve.size),
        _ => None,
    });
    assert_eq!(solves.collect::<Vec<_>>(), [3]);
}

/// A four-bar of hinges in space on a base that is turned by numbers, in which what is across its plane does not cancel: it divides
/// by what is positive wherever it is, as on a base that is not turned.
#[test]
fn a_linkage_on_a_base_turned_by_numbers_is_nowhere_singular() {
    let turns = [
        "rot_x(0.3) * rot_y(0.2)",
        "rot_x(1.21) * rot_z(-0.37)",
        "rot_z(0.7) * rot_x(-0.9)",
        "rot_y(0.4) * rot_x(1.3)",
        "rot_y(-0.25) * rot_z(1.1)",
        "rot_z(-0.6) * rot_y(0.8) * rot_x(0.15)",
        "rot_x(0.5)",
    ];
    for turn in turns {
        let model = compiled(&format!(
            "#[derivative] model M {{
                causality componentwise;
                1 world[6]; 1 ground[6]; 1 crank[6]; 1 coupler[6]; 1 rocker[6]; 1 end[6]; 1 tip[6];
                Sf fixed[6] {{ flow: 0.0 }} -> world;
                base: Turn {{ by: {turn} }} (world, ground);
                first: Revolute {{ axis: 2 }} (ground, crank);
                a: Body {{ mass: 0.5, inertia: 0.002, centre: [0.1, 0.0, 0.0] }} (crank);
                second: Revolute {{ axis: 2, offset: [0.2, 0.0, 0.0] }} (crank, coupler);
                b: Body {{ mass: 0.9, inertia: 0.02, centre: [0.25, 0.0, 0.0] }} (coupler);
                third: Revolute {{ axis: 2, offset: [0.4, 0.0, 0.0] }} (ground, rocker);
                c: Body {{ mass: 0.7, inertia: 0.01, centre: [0.15, 0.0, 0.0] }} (rocker);
                along_coupler: Offset {{ by: [0.5, 0.0, 0.0] }} (coupler, end);
                along_rocker: Offset {{ by: [0.35, 0.0, 0.0] }} (rocker, tip);
                cut: Cut {{ joint: revolute }} (end, tip);
            }}"
        ));
        assert!(
            model.conditioning.is_empty(),
            "{turn}: {:?}",
            model.conditioning
        );
    }
}

/// A slider-crank with rates at the start; its states are the momentum of the rod, and the rates of crank and slide.
fn slider_crank(rates: [f64; 3]) -> String {
    let [crank, rod, slide] = rates.map(|rate| format!("initial_rate: {rate:?}"));
    let body = "PlanarBody { mass: 1.0, inertia: 0.1 }";
    format!(
        "#[derivative] model M {{
            1 ground[3]; 1 crank[3]; 1 pin[3]; 1 rod[3]; 1 end[3]; 1 block[3];
            Sf fixed[3] {{ flow: 0.0 }} -> ground;
            first: PlanarRevolute {{ initial: 0.5, {crank} }} (ground, crank); a: {body} (crank);
            throw: PlanarOffset {{ x: 0.1 }} (crank, pin);
            second: PlanarRevolute {{ initial: -0.66, {rod} }} (pin, rod); b: {body} (rod);
            bar: PlanarOffset {{ x: 0.3 }} (rod, end);
            slide: PlanarPrismatic {{ initial: 0.384, {slide} }} (ground, block); c: {body} (block);
            cut: PlanarCut {{}} (end, block);
            output rates[3] = [first.rate.f, second.rate.f, slide.rate.f];
        }}"
    )
}

/// A rate that is given is kept, be it a state or not, and those that are not given follow, where all moved by least norm.
#[test]
fn rates_that_are_given_are_kept_at_the_start() {
    for given in 0..3 {
        let mut rates = [0.0; 3];
        rates[given] = 10.0;
        let model = compiled(&slider_crank(rates));
        let split = |x: &SVector<f64, 6>| {
            let found = run(&model, Routines::STARTED_FLOWS, x.as_slice());
            let (values, slopes) = found.split_at(model.started.len());
            (
                SVector::<f64, 3>::from_row_slice(values),
                SMatrix::<f64, 3, 6>::from_row_slice(slopes),
            )
        };
        let start = SVector::from_row_slice(&run(&model, Routines::INITIAL, &[]));
        let found = project(start, 1e-12, split);
        assert!(found.converged, "{given}");
        let rates = run(&model, Routines::OUTPUT, found.point.as_slice());
        assert!((rates[given] - 10.0).abs() < 1e-11, "{given}: {rates:?}");
        let open = run(&model, Routines::RESIDUALS_OF_FLOWS, found.point.as_slice());
        assert!(size(&open) < 1e-11 && size(&rates) > 9.9, "{given}");
    }
    let tokens = [[0.0; 3], [10.0, 0.0, 0.0]].map(|rates| {
        let source = slider_crank(rates).parse().unwrap();
        expand(source, &quote!(::mbg_runtime), &no_file).to_string()
    });
    let keeps = tokens.each_ref().map(|it| it.contains("close (start)"));
    assert_eq!(keeps, [false, true]);
    // Without any that are given, where a source drives it from the start on.
    let driven = |flow: &str| {
        let drive = format!("Sf drive {{ flow: {flow} }} -> first.rate; slide:");
        let source = slider_crank([0.0; 3]).replace("slide:", &drive);
        let tokens = expand(source.parse().unwrap(), &quote!(::mbg_runtime), &no_file);
        tokens.to_string().contains("close (start)")
    };
    let flows = ["12.0", "3.0 * cos(5.0 * t)", "3.0 * sin(5.0 * t)"];
    assert_eq!(flows.map(driven), [true, true, false]);
    // Momenta too, and nothing without a loop.
    let pair = |closure: &str| {
        let wheel = "I m { inertia: 2.0, initial: 6.0 }";
        let text =
            format!("model M {{ 1 a {{ {wheel} }} 1 b {{ I n {{ inertia: 3.0 }} }} {closure} }}");
        compiled(&text).started.len()
    };
    assert_eq!([pair("close a -> b by multipliers;"), pair("")], [2, 0]);
}
