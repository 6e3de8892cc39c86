//! What a derivative costs: chains in space, with as many operations for each link however many there are.

use mbg_compiler::compile::{Compiled, Routines};
use mbg_compiler::program::{Mode, Solver, Step};
use mbg_compiler::symbolic::Kind;

mod models;

/// The articulated-body recursion written by hand for this chain of seven links, each expression once; counted by
/// `tests/references/chain/counting.rs`.
const BY_HAND: usize = 909;

/// Links on hinges about x and y in turn, one below the other, out of the library.
fn chain(links: usize) -> String {
    format!(
        "#[derivative]
        model Chain {{
            causality componentwise;
            gravity [0.0, 0.0, -9.81];
            let rods = {links};
            input tau[{links}];
            ends: for k in 0..rods + 1 {{ 1 end[6]; }}
            Sf fixed[6] {{ flow: 0.0 }} -> ends[0].end;
            links: for k in 0..rods {{
                1 rod[6];
                hinge: Revolute {{ axis: k % 2, damping: 0.1, torque: tau[k] }} (ends[k].end, rod);
                body: Body {{
                    mass: 1.0,
                    inertia: diag(0.08395833333333334, 0.08395833333333334, 0.00125),
                    centre: [0.0, 0.0, -0.5]
                }} (rod);
                length: Offset {{ by: [0.0, 0.0, -1.0] }} (rod, ends[k+1].end);
            }}
            output y = links[0].hinge.angle;
        }}"
    )
}

fn operations(links: usize) -> usize {
    let compiled = models::compiled(&chain(links));
    compiled.program.routines[Routines::DERIVATIVE].operations()
}

#[test]
fn seven_links_cost_less_than_the_recursion_by_hand() {
    let count = operations(7);
    println!("chain of seven links: {count} operations, {BY_HAND} by hand");
    assert!(count <= BY_HAND, "{count}");
}

/// Mass on the axis of a hinge moves alike whether it turns with the hinge or not, so that the body before has it.
#[test]
fn mass_along_the_axis_of_a_hinge_costs_nothing() {
    let arm = |along: f64| {
        let text = format!(
            "#[derivative]
            model Arm {{
                causality componentwise;
                gravity [0.0, 0.0, -9.81];
                ends: for k in 0..4 {{ 1 end[6]; }}
                Sf fixed[6] {{ flow: 0.0 }} -> ends[0].end;
                links: for k in 0..3 {{
                    1 rod[6];
                    hinge: Revolute {{ axis: k }} (ends[k].end, rod);
                    body: Body {{
                        mass: 3.0,
                        inertia: [[0.3, 0.01, 0.02], [0.01, 0.4, 0.03], [0.02, 0.03, 0.5]],
                        centre: [0.1, 0.2, if k == 2 {{ {along:?} }} else {{ 0.4 }}]
                    }} (rod);
                    length: Offset {{ by: [0.3, -0.2, 0.1] }} (rod, ends[k+1].end);
                }}
            }}"
        );
        models::compiled(&text).program.routines[Routines::DERIVATIVE].operations()
    };
    let counts = [0.0, 0.5].map(arm);
    println!(
        "three links, the last with its mass in its middle plane and beside: {counts:?} operations"
    );
    assert_eq!(counts[0], counts[1]);
}

/// An arm of four links, its hinges in these axes, with more behind its last end.
fn arm(axes: &str, more: &str) -> usize {
    let text = format!(
        "#[derivative]
        model Arm {{
            causality componentwise;
            gravity [0.0, 0.0, -9.81];
            input force[3];
            ends: for k in 0..5 {{ 1 end[6]; }}
            Sf fixed[6] {{ flow: 0.0 }} -> ends[0].end;
            links: for k in 0..4 {{
                1 seat[6];
                1 rod[6];
                axes: Turn {{ by: {axes} }} (ends[k].end, seat);
                hinge: Revolute {{ axis: k % 2 }} (seat, rod);
                body: Body {{ mass: 3.0, inertia: diag(0.3, 0.4, 0.5), centre: [0.1, 0.2, 0.4] }} (rod);
                length: Offset {{ by: [0.3, -0.2, 0.1] }} (rod, ends[k+1].end);
            }}
            {more}
        }}"
    );
    models::compiled(&text).program.routines[Routines::DERIVATIVE].operations()
}

/// Accelerations in space are those of all links, whatever pushes them and whatever slides at their end.
#[test]
fn forces_and_slides_cost_what_they_are() {
    const AXES: &str = "rot_x(0.3)";
    let finger = |k: usize| {
        format!(
            "1 finger{k}[6];
            slide{k}: Prismatic {{ axis: 1, force: force[{k}] }} (ends[4].end, finger{k});
            tip{k}: Body {{ mass: 0.3, inertia: diag(0.01, 0.02, 0.03), centre: [0.0, 0.0, 0.02] }} (finger{k});"
        )
    };
    let [first, second] = [0, 1].map(finger);
    let plain = arm(AXES, "");
    let push = arm(AXES, "Se push[3] { effort: force } -> links[2].rod[3..6];");
    let fingers = [first.clone(), first + &second].map(|fingers| arm(AXES, &fingers));
    println!("an arm: {plain} operations, pushed: {push}, with fingers: {fingers:?}");
    assert_eq!(push, plain + 3);
    assert!(fingers[0] <= plain + 400 && fingers[1] <= fingers[0] + 100);
}

/// Numbers that are rounded are a rotation as angles are, and three turns in a row are one.
#[test]
fn axes_cost_as_little_in_numbers() {
    let [(sx, cx), (sy, cy)] = [0.3_f64, 0.2].map(f64::sin_cos);
    let rows = [
        [cy, 0.0, sy],
        [sx * sy, cx, -sx * cy],
        [-cx * sy, sx, cx * cy],
    ];
    let numbers = arm(&format!("{rows:?}"), "");
    let turns = arm("rot_x(0.3) * rot_y(0.2)", "");
    let three = arm("rot_x(0.3) * rot_y(0.2) * rot_x(0.1)", "");
    println!("two turns: {turns} operations, in numbers: {numbers}, three turns: {three}");
    assert_eq!(turns, numbers);
    assert!(three <= turns + 350);
}

/// The ends of the chain cost less than its middle, by the same number for any length; so growth is measured on what
/// the second half of the links adds.
#[test]
fn operations_grow_linearly() {
    let counts = [4, 8, 16, 32].map(operations);
    let added: Vec<f64> = counts
        .windows(2)
        .map(|pair| (pair[1] - pair[0]) as f64)
        .collect();
    let exponents: Vec<f64> = added
        .windows(2)
        .map(|pair| (pair[1] / pair[0]).log2())
        .collect();
    println!("chains of 4, 8, 16, 32 links: {counts:?}, growth {exponents:?}");
    assert!(
        exponents.iter().all(|exponent| *exponent < 1.1),
        "{counts:?}"
    );
    // Like links are worked out alike, wherever they hang.
    let [_, short, middle, long] = counts;
    assert_eq!(long - middle, 2 * (middle - short), "{counts:?}");
}

/// A Jacobian has as many entries as there are pairs of links, and costs as much for each pair however many there are:
/// it solves the factorised equations once for each state, and differentiates no factorisation.
#[test]
fn jacobians_grow_with_the_square() {
    let counts = [4, 8, 16].map(|links| {
        let compiled = models::compiled(&chain(links));
        compiled.program.routines[Routines::DERIVATIVE_AND_JACOBIAN].operations()
    });
    let pairs = [4.0, 8.0, 16.0].map(|links: f64| links * links);
    let each: Vec<f64> = counts
        .iter()
        .zip(pairs)
        .map(|(count, pairs)| *count as f64 / pairs)
        .collect();
    println!("Jacobians of chains of 4, 8, 16 links: {counts:?}, for each pair {each:.0?}");
    assert!(each[2] < 1.4 * each[1], "{each:?}");
}

/// What acts on its neighbours alone has a Jacobian with few entries, however long it is: its derivative once more and not once
/// for each state.
#[test]
fn jacobians_of_neighbours_cost_as_much_as_derivatives() {
    let ladder = "model Ladder {
        input voltage: V;
        1 source { Se drive { effort: voltage } }
        sections: for k in 0..40 {
            1 line { I coil { inertia: 1e-3 } R wire { resistance: 0.1 } }
            0 node { C store { effort: 1e6 * q * (1.0 + 0.1 * powi(q, 2)) } R leak { conductance: 1e-6 } }
            line -> node;
        }
        source -> sections[0].line;
        for k in 0..39 { sections[k].node -> sections[k+1].line; }
    }";
    let beam = "model Beam {
        gravity [0.0, 0.0, -9.81];
        ends: for k in 0..9 { 1 end[6]; }
        Sf held[6] { flow: 0.0 } -> ends[0].end;
        elements: for k in 0..8 {
            1 rod[6];
            bend: Revolute { axis: 1, blocked: compliant, stiffness: 1e4, damping: 10.0 } (ends[k].end, rod);
            body: Body { mass: 1.0, inertia: diag(0.01, 0.02, 0.02), centre: [0.1, 0.0, 0.0] } (rod);
            length: Offset { by: [0.2, 0.0, 0.0] } (rod, ends[k+1].end);
        }
    }";
    for (name, text) in [("ladder", ladder), ("beam", beam)] {
        let compiled = models::compiled(text);
        let (derivative, both) = (
            compiled.operations(Routines::DERIVATIVE),
            compiled.operations(Routines::DERIVATIVE_AND_JACOBIAN),
        );
        let states = compiled.states.len();
        println!("{name} of {states} states: {derivative} operations, with its Jacobian {both}");
        assert!(both < 2 * derivative, "{name}: {derivative}, {both}");
    }
}

/// Inertial forces of a body of any shape, on two hinges at right angles: vector by vector they would take 150 operations.
#[test]
fn a_turning_body_costs_less_than_its_vectors() {
    let compiled = models::compiled(
        "#[derivative]
        model Body {
            causality componentwise;
            gravity [0.0, 0.0, -9.81];
            input torque[2];
            1 base[6]; 1 first[6]; 1 middle[6]; 1 second[6];
            Sf fixed[6] { flow: 0.0 } -> base;
            one: Revolute { axis: 0, torque: torque[0] } (base, first);
            length: Offset { by: [0.0, 0.3, -1.0] } (first, middle);
            two: Revolute { axis: 1, torque: torque[1] } (middle, second);
            body: Body {
                mass: 2.0,
                inertia: [[3.0, 0.1, 0.2], [0.1, 5.0, 0.3], [0.2, 0.3, 7.0]],
                centre: [0.4, 0.5, -0.6]
            } (second);
            output angle = two.angle;
        }",
    );
    let count = compiled.program.routines[Routines::DERIVATIVE].operations();
    println!("body on two hinges: {count} operations");
    assert!(count <= 124, "{count}");
}

/// A robot whose trunk flies, on legs of three links whose centres of mass are nowhere on an axis.
fn walker(legs: usize) -> String {
    format!(
        "#[derivative]
        model Walker {{
            causality componentwise;
            gravity [0.0, 0.0, -9.81];
            1 world[6]; 1 trunk[6];
            Sf held[6] {{ flow: 0.0 }} -> world;
            float: Free {{ orientation: quaternion }} (world, trunk);
            body: Body {{
                mass: 60.0, inertia: diag(1.0, 8.0, 9.0), centre: [0.05, 0.02, 0.01]
            }} (trunk);
            legs: for k in 0..{legs} {{
                1 hip[6]; 1 thigh[6]; 1 shank[6];
                swing: Revolute {{ axis: 0, offset: [0.3 * (k - 1.5), 0.2, 0.0] }} (trunk, hip);
                lift: Revolute {{ axis: 1, offset: [0.1, 0.0, 0.0] }} (hip, thigh);
                knee: Revolute {{ axis: 1, offset: [0.0, 0.0, -0.35] }} (thigh, shank);
                a: Body {{ mass: 3.0, inertia: diag(0.02, 0.01, 0.02), centre: [0.04, 0.01, 0.0] }} (hip);
                b: Body {{ mass: 4.0, inertia: diag(0.05, 0.05, 0.01), centre: [0.01, 0.02, -0.15] }} (thigh);
                c: Body {{ mass: 1.0, inertia: diag(0.01, 0.01, 0.001), centre: [0.0, 0.01, -0.12] }} (shank);
            }}
        }}"
    )
}

/// The legs go before the trunk that carries them. Released before them, the trunk would take eighteen times as many operations
/// with four legs.
#[test]
fn each_leg_of_what_flies_costs_the_same() {
    let counts = [1, 2, 3, 4].map(|legs| {
        let compiled = models::compiled(&walker(legs));
        compiled.program.routines[Routines::DERIVATIVE].operations()
    });
    println!("walkers on one to four legs: {counts:?} operations");
    for (more, count) in counts.iter().enumerate() {
        assert!(*count <= 1030 + 765 * more, "{counts:?}");
    }
}

/// How many equations are solved with numbers, and how.
fn solved(compiled: &Compiled) -> Vec<(Solver, usize)> {
    let steps = &compiled.program.routines[Routines::DERIVATIVE].steps;
    let solvers = steps.iter().filter_map(|step| match step {
        Step::Solve(solve) => Some((solve.solver, solve.size)),
        _ => None,
    });
    solvers.collect()
}

/// The six equations of the trunk are solved with numbers, and their matrix is symmetric as an inertia is, so that no pivot
/// is looked for.
#[test]
fn what_flies_is_solved_by_a_symmetric_matrix() {
    let compiled = models::compiled(&walker(1));
    assert_eq!(solved(&compiled), [(Solver::Linear(Kind::Symmetric), 6)]);
}

/// Hinges on a trunk that flies go before its velocity, which carries them though no spin about their axes follows from it.
#[test]
fn what_flies_leaves_six_equations_whatever_the_axes_of_its_hinges() {
    let text = "#[derivative]
        model Flyer {
            causality componentwise;
            gravity [0.0, 0.0, -9.81];
            1 world[6];
            Sf held[6] { flow: 0.0 } -> world;
            bodies: for k in 0..4 { 1 body[6]; }
            float: Free { orientation: quaternion } (world, bodies[0].body);
            trunk: Body {
                mass: 5.0, inertia: diag(0.5, 0.6, 0.7), centre: [0.0, 0.0, 0.1]
            } (bodies[0].body);
            links: for k in 0..3 {
                hinge: Revolute { axis: 2 - k % 2, offset: [0.1, 0.2, 0.3] } (bodies[k].body, bodies[k+1].body);
                link: Body {
                    mass: 1.0, inertia: diag(0.1, 0.2, 0.15), centre: [0.0, 0.1, -0.3]
                } (bodies[k+1].body);
            }
        }";
    let compiled = models::compiled(text);
    let count = compiled.program.routines[Routines::DERIVATIVE].operations();
    println!("three links on a trunk that flies: {count} operations");
    assert_eq!(solved(&compiled), [(Solver::Linear(Kind::Symmetric), 6)]);
    assert!(count <= 1045, "{count}");
}

/// What a rod's ends do beside their accelerations is differentiated along the motion and not by each state in turn, where a
/// platform that turns has four, and so are columns of the Jacobian. By states they took 2,429 and 53,940 operations.
#[test]
fn rods_of_a_platform_cost_what_their_motion_is() {
    let text = std::fs::read_to_string("../tests/models/platform.mbg").unwrap();
    let compiled = models::compiled(&text);
    let count = |routine: usize| compiled.program.routines[routine].operations();
    let counts = [Routines::DERIVATIVE, Routines::DERIVATIVE_AND_JACOBIAN].map(count);
    println!("a platform on six rods: {counts:?} operations, alone and with the Jacobian");
    assert!(counts[0] <= 1_516 && counts[1] <= 26_104, "{counts:?}");
}

/// Fourteen states change seven accelerations: seven rows of the Jacobian take less than fourteen columns, which took 11,185
/// operations. What flies has more accelerations than each of its states changes alone, and goes by columns.
#[test]
fn a_jacobian_goes_by_rows_where_these_are_fewer() {
    let sweeps = |text: &str| {
        let compiled = models::compiled(text);
        let routine = &compiled.program.routines[Routines::DERIVATIVE_AND_JACOBIAN];
        let modes = routine.sweeps.iter().map(|it| it.coverage.mode);
        (modes.collect::<Vec<_>>(), routine.operations())
    };
    let (modes, count) = sweeps(&chain(7));
    println!("chain of seven links with its Jacobian: {count} operations");
    assert_eq!(modes, [Mode::Reverse]);
    assert!(count <= 6_870, "{count}");
    assert_eq!(sweeps(&walker(4)).0, [Mode::Forward; 2]);
}
