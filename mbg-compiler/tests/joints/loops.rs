//! Cuts: a tree of joints that is closed by one moves as the joint of the same kind does.

use mbg_compiler::compile::{Compiled, Routines};
use mbg_compiler::program::{self, Arguments};

use crate::models::attempted;
use crate::rows;
use crate::scene::{Scene, cross};

const BODY: &str = "body: Body {
        mass: 2.0, inertia: diag(1.0, 2.0, 3.0), centre: [0.1, 0.2, -0.3]
    } (b);
    output spin[3] = b.f[0..3];
    output velocity[3] = b.f[3..6];";

/// A body that six joint axes leave free, and what is held of it.
fn scene(cut: &str) -> Scene {
    Scene::of(&format!(
        "#[derivative] model Held {{
            causality componentwise;
            gravity [0.5, 1.0, -9.81];
            1 ground[6]; 1 plate[6]; 1 lift[6]; 1 b[6];
            Sf fixed[6] {{ flow: 0.0 }} -> ground;
            plane: Planar {{ axis: 2 }} (ground, plate);
            height: Prismatic {{ axis: 2 }} (plate, lift);
            cross: Universal (lift, b);
            {cut}
            {BODY}
        }}"
    ))
}

fn closed(word: &str) -> Scene {
    scene(&format!("cut: Cut {{ joint: {word} }} (ground, b);"))
}

/// The body on a joint of its own.
fn joined(joint: &str) -> Scene {
    Scene::of(&format!(
        "#[derivative] model Joined {{
            causality componentwise;
            gravity [0.5, 1.0, -9.81];
            1 ground[6]; 1 b[6];
            Sf fixed[6] {{ flow: 0.0 }} -> ground;
            {joint}
            {BODY}
        }}"
    ))
}

/// How the flows of the body change, from a state in which these are not zero.
fn change(scene: &Scene, moving: &[(&str, f64)]) -> Vec<f64> {
    let mut state = vec![0.0; scene.model.states.len()];
    for (name, value) in moving {
        state[scene.place(name)] = *value;
    }
    let arguments = Arguments {
        parameters: &[],
        time: 0.0,
        state: &state,
        input: &[],
    };
    let rates = program::evaluate(&scene.model.program, Routines::DERIVATIVE, &arguments);
    scene.along(Routines::OUTPUT, &state, &rates)
}

#[test]
fn cuts_take_the_degrees_of_freedom_of_the_table() {
    let table = rows(3);
    assert_eq!(table.len(), 8);
    for row in table {
        let planar = row[0] == "PlanarCut";
        let scene = if planar { flat(row[1]) } else { closed(row[1]) };
        assert_eq!(scene.velocities(), if planar { 3 } else { 6 });
        let closings = scene.model.closed.each_ref().map(Vec::len);
        assert_eq!(closings, [row[2].parse().unwrap(); 2], "{}", row[1]);
    }
}

/// Momenta of the body that turns about the origin with an angular velocity in its own axes.
fn momenta(omega: [f64; 3]) -> Vec<(&'static str, f64)> {
    let speed = cross(&omega, &[0.1, 0.2, -0.3]);
    vec![
        ("body.spin.p.x", omega[0]),
        ("body.spin.p.y", 2.0 * omega[1]),
        ("body.spin.p.z", 3.0 * omega[2]),
        ("body.body.p.x", 2.0 * speed[0]),
        ("body.body.p.y", 2.0 * speed[1]),
        ("body.body.p.z", 2.0 * speed[2]),
    ]
}

#[track_caller]
fn alike(found: &[f64], expected: &[f64]) {
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }
}

/// A cut, and the joint of its kind, move a body alike from a state that both allow.
#[test]
fn a_cut_moves_a_body_as_the_joint_does() {
    let hinge = joined("joint: Revolute { axis: 2 } (ground, b);");
    let expected = change(&hinge, &[("joint.angle", 0.4), ("joint.rate.f", 1.3)]);
    let state = [momenta([0.0, 0.0, 1.3]), vec![("plane.angle", 0.4)]].concat();
    alike(&change(&closed("revolute"), &state), &expected);

    let universal = joined("joint: Universal (ground, b);");
    let own = [
        ("joint.angle.x", 0.4),
        ("joint.angle.y", 0.3),
        ("joint.rate.f.x", 1.3),
        ("joint.rate.f.y", -0.7),
    ];
    let expected = change(&universal, &own);
    let (sine, cosine) = 0.3_f64.sin_cos();
    let turned = momenta([1.3 * cosine, -0.7, 1.3 * sine]);
    let state = [turned, vec![("cross.angle.x", 0.4), ("cross.angle.y", 0.3)]].concat();
    alike(&change(&closed("universal"), &state), &expected);

    let ball = joined("joint: Spherical (ground, b);");
    let own = [
        ("joint.rotation.gimbal.rate.f.x", 1.3),
        ("joint.rotation.gimbal.rate.f.y", -0.7),
        ("joint.rotation.gimbal.rate.f.z", 0.6),
    ];
    let expected = change(&ball, &own);
    let state = momenta([1.3, -0.7, 0.6]);
    alike(&change(&closed("spherical"), &state), &expected);
    assert!(expected[..3].iter().all(|slope| slope.abs() > 1e-2));

    let held = change(&closed("fixed"), &[]);
    alike(&held, &[0.0; 6]);
}

/// A plate that three joint axes leave free in a plane, and what is held of it.
fn flat(word: &str) -> Scene {
    Scene::of(&format!(
        "#[derivative] model Flat {{
            causality componentwise;
            gravity [0.5, -9.81];
            1 ground[3]; 1 along[3]; 1 across[3]; 1 b[3];
            Sf fixed[3] {{ flow: 0.0 }} -> ground;
            first: PlanarPrismatic (ground, along);
            second: PlanarPrismatic {{ direction: 1.5707963267948966 }} (along, across);
            hinge: PlanarRevolute (across, b);
            cut: PlanarCut {{ joint: {word}, direction: 0.4 }} (ground, b);
            {PLATE}
        }}"
    ))
}

const PLATE: &str = "1 centre[3];
    arm: PlanarOffset { x: 0.3, y: 0.1 } (b, centre);
    body: PlanarBody { mass: 2.0, inertia: 0.5 } (centre);
    output spin = b.f[0];
    output velocity[2] = b.f[1..3];";

/// As [`joined`], in a plane.
fn joined_flat(joint: &str) -> Scene {
    Scene::of(&format!(
        "#[derivative] model Joined {{
            causality componentwise;
            gravity [0.5, -9.81];
            1 ground[3]; 1 b[3];
            Sf fixed[3] {{ flow: 0.0 }} -> ground;
            {joint}
            {PLATE}
        }}"
    ))
}

#[test]
fn a_planar_cut_moves_a_body_as_the_joint_does() {
    // The plate turns about its point b, which lies at the origin.
    let (angle, rate) = (0.6_f64, 1.3);
    let arm = [
        0.3 * angle.cos() - 0.1 * angle.sin(),
        0.3 * angle.sin() + 0.1 * angle.cos(),
    ];
    let expected = change(
        &joined_flat("hinge: PlanarRevolute (ground, b); let turned = hinge.angle;"),
        &[("hinge.angle", angle), ("hinge.rate.f", rate)],
    );
    let state = [
        ("hinge.angle", angle),
        ("body.spin.p", 0.5 * rate),
        ("body.body.p.x", -2.0 * rate * arm[1]),
        ("body.body.p.y", 2.0 * rate * arm[0]),
    ];
    alike(&change(&flat("revolute"), &state), &expected);

    // The plate slides along a line through the origin.
    let slide =
        joined_flat("slide: PlanarPrismatic { direction: 0.4 } (ground, b); let turned = 0.0;");
    let (speed, travel) = (0.7, 0.2);
    let (sine, cosine) = 0.4_f64.sin_cos();
    let expected = change(&slide, &[("slide.rate.f", speed)]);
    let state = [
        ("first.travel", travel * cosine),
        ("second.travel", travel * sine),
        ("body.body.p.x", 2.0 * speed * cosine),
        ("body.body.p.y", 2.0 * speed * sine),
    ];
    alike(&change(&flat("prismatic"), &state), &expected);

    // It turns about a pin that slides along that line.
    let pinned = joined_flat(
        "1 pin[3]; slide: PlanarPrismatic { direction: 0.4 } (ground, pin); hinge: PlanarRevolute (pin, b);",
    );
    let own = [
        ("slide.rate.f", speed),
        ("hinge.angle", angle),
        ("hinge.rate.f", rate),
    ];
    let expected = change(&pinned, &own);
    let state = [
        ("first.travel", travel * cosine),
        ("second.travel", travel * sine),
        ("hinge.angle", angle),
        ("body.spin.p", 0.5 * rate),
        ("body.body.p.x", 2.0 * (speed * cosine - rate * arm[1])),
        ("body.body.p.y", 2.0 * (speed * sine + rate * arm[0])),
    ];
    alike(&change(&flat("slot"), &state), &expected);

    alike(&change(&flat("fixed"), &[]), &[0.0; 3]);
}

/// A plate that is turned by 0.5 against the ground slides along the same line with that angle.
#[test]
fn a_planar_cut_keeps_the_angle_that_it_is_told() {
    let slide =
        joined_flat("slide: PlanarPrismatic { direction: -0.1, angle_a: 0.5 } (ground, b);");
    let (speed, travel) = (0.7, 0.2);
    let (sine, cosine) = 0.4_f64.sin_cos();
    let expected = change(&slide, &[("slide.rate.f", speed)]);
    let state = [
        ("hinge.angle", 0.5),
        ("first.travel", travel * cosine),
        ("second.travel", travel * sine),
        ("body.body.p.x", 2.0 * speed * cosine),
        ("body.body.p.y", 2.0 * speed * sine),
    ];
    let told = flat("prismatic, zero: 0.5");
    alike(&change(&told, &state), &expected);

    // What is left open of the angle and of the place beside the line.
    let open = |scene: &Scene, named: &[(&str, f64)]| {
        let mut state = vec![0.0; scene.model.states.len()];
        for (name, value) in named {
            state[scene.place(name)] = *value;
        }
        scene.run(Routines::CLOSED_POSITIONS, &state)
    };
    alike(&open(&told, &state), &[0.0, 0.0]);
    alike(&open(&flat("prismatic"), &state), &[-0.5, 0.0]);
    let told = flat("fixed, zero: 0.5");
    alike(&open(&told, &[("hinge.angle", 0.5)]), &[0.0, 0.0, 0.0]);
}

/// Both ends may move: that displacements change as the flows do is proven for every state when they are compiled.
#[test]
fn both_ends_of_a_cut_may_move() {
    for word in ["spherical", "universal", "revolute", "fixed"] {
        let scene = Scene::of(&format!(
            "#[derivative] model Both {{
                causality componentwise;
                1 ground[6]; 1 a[6]; 1 b[6];
                Sf fixed[6] {{ flow: 0.0 }} -> ground;
                left: Cylindrical {{ axis: 1, tilt: rot_x(0.3) }} (ground, a);
                right: Universal {{ offset: [1.0, 0.0, 0.0] }} (ground, b);
                one: Body {{ mass: 2.0, inertia: diag(1.0, 2.0, 3.0) }} (a);
                other: Body {{ mass: 2.0, inertia: diag(1.0, 2.0, 3.0) }} (b);
                cut: Cut {{ joint: {word} }} (a, b);
            }}"
        ));
        assert_eq!(scene.velocities(), 4);
    }
    for word in ["slot", "revolute", "prismatic", "fixed"] {
        let scene = Scene::of(&format!(
            "#[derivative] model Both {{
                causality componentwise;
                1 ground[3]; 1 foot[3]; 1 a[3]; 1 b[3];
                Sf fixed[3] {{ flow: 0.0 }} -> ground;
                left: PlanarRevolute (ground, foot);
                slide: PlanarPrismatic (foot, a);
                right: PlanarRevolute (ground, b);
                one: PlanarBody {{ mass: 2.0, inertia: 1.0 }} (a);
                other: PlanarBody {{ mass: 2.0, inertia: 1.0 }} (b);
                cut: PlanarCut {{ joint: {word}, direction: 0.3, position_b: [1.0, 0.0] }} (a, b);
            }}"
        ));
        assert_eq!(scene.velocities(), 3);
    }
}

/// A parallelogram of three rods, and its ground: in a plane, two equations close it.
const PARALLELOGRAM: &str = "#[derivative] model Flat {
    causality componentwise;
    gravity [0.5, -9.81];
    1 ground[3]; 1 first[3]; 1 second[3]; 1 third[3];
    Sf fixed[3] { flow: 0.0 } -> ground;
    crank: PlanarLink { mass: 1.0, inertia: 0.2, centre: [0.5, 0.0], end: [1.0, 0.0] } (ground, first);
    coupler: PlanarLink {
        mass: 2.0, inertia: 0.7, centre: [1.0, 0.1], end: [2.0, 0.0]
    } (first, second);
    rocker: PlanarLink {
        mass: 1.5, inertia: 0.3, centre: [0.4, 0.0], end: [1.0, 0.0]
    } (second, third);
    cut: PlanarCut { position_b: [2.0, 0.0] } (third, ground);
    output rates[3] = [crank.hinge.rate.f, coupler.hinge.rate.f, rocker.hinge.rate.f];
}";

/// The same in space, where a hinge takes five equations, three of which say nothing in any position.
const IN_SPACE: &str = "
component Link(port a[6], port b[6]) {
    param mass; param inertia; param centre[3]; param end[3];
    1 rod[6];
    hinge: Revolute { axis: 2 } (a, rod);
    body: Body { mass: mass, inertia: diag(1.0, 2.0, inertia), centre: centre } (rod);
    reach: Offset { by: end } (rod, b);
}
#[derivative] model Spatial {
    causality componentwise;
    gravity [0.5, -9.81, 0.0];
    1 ground[6]; 1 first[6]; 1 second[6]; 1 third[6];
    Sf fixed[6] { flow: 0.0 } -> ground;
    crank: Link {
        mass: 1.0, inertia: 0.2, centre: [0.5, 0.0, 0.0], end: [1.0, 0.0, 0.0]
    } (ground, first);
    coupler: Link {
        mass: 2.0, inertia: 0.7, centre: [1.0, 0.1, 0.0], end: [2.0, 0.0, 0.0]
    } (first, second);
    rocker: Link {
        mass: 1.5, inertia: 0.3, centre: [0.4, 0.0, 0.0], end: [1.0, 0.0, 0.0]
    } (second, third);
    cut: Cut { joint: revolute, position_b: [2.0, 0.0, 0.0] } (third, ground);
    output rates[3] = [crank.hinge.rate.f, coupler.hinge.rate.f, rocker.hinge.rate.f];
}";

#[test]
fn equations_that_say_nothing_close_a_loop_as_well() {
    let (angle, rate) = (1.0, 0.8);
    let state = [
        ("crank.hinge.angle", angle),
        ("coupler.hinge.angle", -angle),
        ("rocker.hinge.angle", angle + std::f64::consts::PI),
        ("crank.hinge.rate.f", rate),
        ("coupler.hinge.rate.f", -rate),
        ("rocker.hinge.rate.f", rate),
    ];
    let [flat, spatial] = [PARALLELOGRAM, IN_SPACE].map(|text| change(&Scene::of(text), &state));
    alike(&spatial, &flat);
    assert!(flat.iter().all(|slope| slope.abs() > 1.0), "{flat:?}");
}

/// A crank and a rod to a block that slides.
fn slider_crank(last: &str) -> Scene {
    Scene::of(&format!(
        "#[derivative] model SliderCrank {{
            causality componentwise;
            gravity [0.0, -9.81];
            1 ground[3]; 1 crank[3]; 1 pin[3]; 1 rod[3]; 1 end[3]; 1 block[3];
            Sf fixed[3] {{ flow: 0.0 }} -> ground;
            first: PlanarRevolute {{ initial: 0.9 }} (ground, crank);
            long: PlanarOffset {{ x: 1.0 }} (crank, pin);
            wheel: PlanarBody {{ mass: 1.0, inertia: 0.3 }} (crank);
            second: PlanarRevolute {{ initial: -0.7 }} (pin, rod);
            longer: PlanarOffset {{ x: 2.0 }} (rod, end);
            bar: PlanarBody {{ mass: 1.0, inertia: 0.3 }} (rod);
            slide: PlanarPrismatic {{ initial: 2.7 }} (ground, block);
            body: PlanarPointMass {{ mass: 0.5 }} (block);
            {last}
            output gap[2] = longer.position_b - slide.position_b;
        }}"
    ))
}

#[test]
fn a_ring_moves_with_its_gap_and_a_cut_closes_it() {
    let ring = slider_crank("third: PlanarRevolute (block, end);");
    assert_eq!((ring.velocities(), ring.displacements()), (1, 3));
    assert_eq!(ring.model.closed.each_ref().map(Vec::len), [0; 2]);
    let mut start = ring.start();
    start[ring.place("first.rate.f")] = 1.3;
    let gap = |state: &[f64]| ring.run(Routines::OUTPUT, state);
    let (before, after) = (gap(&start), gap(&ring.after(start.clone(), 1e-3, 200)));
    assert!(before[0].abs() > 0.1, "{before:?}");
    for (before, after) in before.iter().zip(after) {
        assert!((before - after).abs() < 1e-9, "{before} {after}");
    }

    let cut = slider_crank("third: PlanarCut (end, block);");
    assert_eq!((cut.velocities(), cut.displacements()), (3, 3));
    assert_eq!(cut.model.closed.each_ref().map(Vec::len), [2; 2]);
}

/// Three rods in space, all hinges about y.
fn four_bar(last: &str) -> Result<Compiled, Vec<&'static str>> {
    attempted(&format!(
        "#[derivative] model FourBar {{
            causality componentwise;
            1 ground[6]; 1 far[6]; 1 a[6]; 1 b[6]; 1 c[6]; 1 a_end[6]; 1 b_end[6]; 1 c_end[6];
            Sf fixed[6] {{ flow: 0.0 }} -> ground;
            base: Offset {{ by: [1.0, 0.0, 0.0] }} (ground, far);
            first: Revolute {{ axis: 1, initial: -1.0 }} (ground, a);
            crank: Offset {{ by: [0.3, 0.0, 0.0] }} (a, a_end);
            second: Revolute {{ axis: 1, initial: 0.9 }} (a_end, b);
            coupler: Offset {{ by: [0.9, 0.0, 0.0] }} (b, b_end);
            third: Revolute {{ axis: 1, initial: -1.2 }} (far, c);
            rocker: Offset {{ by: [0.7, 0.0, 0.0] }} (c, c_end);
            body: Body {{ mass: 1.0, inertia: 1.0 }} (b);
            wheel: Body {{ mass: 1.0, inertia: 1.0 }} (a);
            arm: Body {{ mass: 1.0, inertia: 1.0 }} (c);
            {last}
        }}"
    ))
}

#[test]
fn redundant_constraints_are_for_a_cut() {
    let ring = four_bar("last: Revolute { axis: 1 } (b_end, c_end);");
    assert!(ring.err().unwrap().contains(&"MBG0302"));
    // Its hinge is about z of the frames.
    let cut = four_bar(
        "1 b_pin[6]; 1 c_pin[6];
        b_turn: Turn { by: rot_x(-1.5707963267948966) } (b_end, b_pin);
        c_turn: Turn { by: rot_x(-1.5707963267948966) } (c_end, c_pin);
        last: Cut { joint: revolute } (b_pin, c_pin);",
    );
    assert_eq!(cut.unwrap().closed.each_ref().map(Vec::len), [5; 2]);
}
