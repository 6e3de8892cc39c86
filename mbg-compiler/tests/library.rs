//! The library: each component is read, connected, and does what its equation says.
#![allow(clippy::unwrap_used)]

mod models;

use mbg_compiler::compile::{Compiled, Routines};
use mbg_compiler::diagnostics::Diagnostics;
use mbg_compiler::syntax::ast::Item;
use mbg_compiler::syntax::{self, library};
use models::{assert_lossless, assert_near, compiled, elaborated, run, state};

fn cross(a: &[f64], b: &[f64]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn sum(terms: &[[f64; 3]]) -> [f64; 3] {
    [0, 1, 2].map(|axis| terms.iter().map(|term| term[axis]).sum())
}

/// The vector in axes turned by an angle about an axis.
fn turned(vector: [f64; 3], axis: usize, angle: f64) -> [f64; 3] {
    let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
    let (sine, cosine) = angle.sin_cos();
    let mut turned = vector;
    turned[next] = cosine * vector[next] + sine * vector[last];
    turned[last] = cosine * vector[last] - sine * vector[next];
    turned
}

#[test]
fn every_file_is_one_component_with_documentation() {
    for name in library::names() {
        let mut diagnostics = Diagnostics::new();
        let text = library::text(name).unwrap();
        let source = syntax::parse(text.parse().unwrap(), &mut diagnostics);
        assert!(!diagnostics.any(), "{name}: {:?}", diagnostics.list());
        let [Item::Component(component)] = &source.items[..] else {
            panic!("{name} is one component")
        };
        assert_eq!(component.name, name);
        assert!(!component.documentation.is_empty(), "{name}");
    }
    assert!(library::names().is_sorted());
    assert_eq!(library::text("Nothing"), None);
}

#[test]
fn components_are_read_only_when_used() {
    let mut diagnostics = Diagnostics::new();
    let text = "component C(port a[6]) { body: Body { mass: 1.0, inertia: 1.0 } (a); } model M { for k in 0..2 { 1 a[6]; turn: Turn { by: 1.0 } (a, a); } }";
    let source = syntax::parse(text.parse().unwrap(), &mut diagnostics);
    let mut names: Vec<String> = source
        .library
        .iter()
        .map(|it| it.name.to_string())
        .collect();
    names.sort();
    assert_eq!(names, ["Body", "Turn"]);
}

#[test]
fn a_component_of_the_user_wins() {
    let text = "component Body(port at) { at -> I own { inertia: 1.0 }; }
    model M { 1 a; body: Body (a); }";
    assert_eq!(
        elaborated(text).unwrap().0.graph.elements[0].name,
        "body.own"
    );
}

#[test]
fn a_free_body_obeys_newton_and_euler() {
    let model = compiled(
        "model M {
            gravity [0.5, 1.0, -9.81];
            1 frame[6];
            body: Body { mass: 2.0, inertia: diag(1.0, 2.0, 3.0), centre: [0.1, 0.2, -0.3], gravity_at: gravity } (frame);
            Se push[3] { effort: [1.0, -2.0, 0.5] } -> frame[3..6];
            output frame[6] = frame.f;
        }",
    );
    let x = state(&model);
    let (spin, linear) = (&x[..3], &x[3..]);
    let omega = [spin[0], spin[1] / 2.0, spin[2] / 3.0];
    let (centre, push, weight) = ([0.1, 0.2, -0.3], [1.0, -2.0, 0.5], [1.0, 2.0, -19.62]);
    let moment = sum(&[cross(spin, &omega), cross(&push, &centre)]);
    let force = sum(&[cross(linear, &omega), push, weight]);
    assert_near(
        &run(&model, Routines::DERIVATIVE, &x),
        &[moment, force].concat(),
        1e-12,
    );
    // The velocity of the frame is that of the centre less ω × r.
    let velocity = sum(&[
        [0, 1, 2].map(|axis| linear[axis] / 2.0),
        cross(&centre, &omega),
    ]);
    assert_near(
        &run(&model, Routines::OUTPUT, &x),
        &[omega, velocity].concat(),
        1e-12,
    );
    assert_lossless(&model);
}

/// A body at `a`, friction at `b`, and a joint between them: flows at `a`, flows at `b`, rate and coordinate.
fn spatial(joint: &str, rate: &str, coordinate: &str) -> (Vec<f64>, Vec<f64>, f64, f64) {
    let model = compiled(&format!(
        "model M {{
            gravity [0.5, 1.0, -9.81];
            1 a[6];
            1 b[6] {{ R air {{ resistance: 0.7 }} }}
            body: Body {{ mass: 2.0, inertia: diag(1.0, 2.0, 3.0), centre: [0.1, 0.2, -0.3], gravity_at: gravity }} (a);
            joint: {joint} (a, b);
            output a[6] = a.f;
            output b[6] = b.f;
            output rate = {rate};
            output coordinate = {coordinate};
        }}"
    ));
    assert_lossless(&model);
    let output = run(&model, Routines::OUTPUT, &state(&model));
    (
        output[..6].to_vec(),
        output[6..12].to_vec(),
        output[12],
        output[13],
    )
}

fn halves(flow: &[f64]) -> ([f64; 3], [f64; 3]) {
    ([flow[0], flow[1], flow[2]], [flow[3], flow[4], flow[5]])
}

#[test]
fn a_revolute_joint_turns_about_its_axis() {
    for axis in 0..3 {
        let joint = format!(
            "Revolute {{ axis: {axis}, damping: 0.3, stiffness: 5.0, torque: 0.2, initial: 0.4 }}"
        );
        let (a, b, rate, angle) = spatial(&joint, "joint.rate.f", "joint.angle");
        let (omega, velocity) = halves(&a);
        let mut relative = [0.0; 3];
        relative[axis] = rate;
        let omega = turned(sum(&[omega, relative]), axis, angle);
        let velocity = turned(velocity, axis, angle);
        assert_near(&b, &[omega, velocity].concat(), 1e-12);
        assert!(rate.abs() > 1e-3 && angle.abs() > 1e-3);
    }
}

#[test]
fn a_prismatic_joint_slides_along_its_axis() {
    for axis in 0..3 {
        let joint =
            format!("Prismatic {{ axis: {axis}, damping: 0.3, stiffness: 5.0, force: 0.2 }}");
        let (a, b, rate, travel) = spatial(&joint, "joint.rate.f", "joint.travel");
        let (omega, velocity) = halves(&a);
        let (mut arm, mut relative) = ([0.0; 3], [0.0; 3]);
        (arm[axis], relative[axis]) = (travel, rate);
        let velocity = sum(&[velocity, cross(&omega, &arm), relative]);
        assert_near(&b, &[omega, velocity].concat(), 1e-12);
        assert!(rate.abs() > 1e-3 && travel.abs() > 1e-3);
    }
}

#[test]
fn offsets_and_turns_are_rigid() {
    let (a, b, ..) = spatial("Offset { by: [0.1, -0.2, 0.3] }", "0.0", "0.0");
    let (omega, velocity) = halves(&a);
    let velocity = sum(&[velocity, cross(&omega, &[0.1, -0.2, 0.3])]);
    assert_near(&b, &[omega, velocity].concat(), 1e-12);

    let (a, b, gravity, _) = spatial(
        "Turn { by: rot_y(0.5), gravity_a: gravity }",
        "joint.gravity_b.x",
        "0.0",
    );
    let (omega, velocity) = halves(&a);
    assert_near(
        &b,
        &[turned(omega, 1, 0.5), turned(velocity, 1, 0.5)].concat(),
        1e-12,
    );
    assert_near(&[gravity], &[turned([0.5, 1.0, -9.81], 1, 0.5)[0]], 1e-12);
}

/// A body at `a`, friction at `b`, and a part between them: flows at `a`, flows at `b`, and what else is asked for.
fn planar(part: &str, outputs: &str) -> ([f64; 3], [f64; 3], Vec<f64>) {
    let model = compiled(&format!(
        "model M {{
            gravity [0.5, -9.81];
            1 a[3];
            1 b[3] {{ R air {{ resistance: 0.7 }} }}
            integral angle = a.f[0];
            integral place[2] = a.f[1..3];
            body: PlanarBody {{ mass: 2.0, inertia: 3.0 }} (a);
            part: {part} (a, b);
            output a[3] = a.f;
            output b[3] = b.f;
            output angle = angle;
            {outputs}
        }}"
    ));
    assert_lossless(&model);
    let output = run(&model, Routines::OUTPUT, &state(&model));
    let flow = |start: usize| [output[start], output[start + 1], output[start + 2]];
    (flow(0), flow(3), output[6..].to_vec())
}

#[test]
fn planar_parts_move_as_their_equations_say() {
    let (a, b, rest) = planar(
        "PlanarRevolute { damping: 0.3, stiffness: 5.0, torque: 0.2, angle_a: angle }",
        "output rate = part.rate.f; output turned = part.angle; output total = part.angle_b;",
    );
    assert_near(&b, &[a[0] + rest[1], a[1], a[2]], 1e-12);
    assert_near(&[rest[3]], &[rest[0] + rest[2]], 1e-12);

    let (a, b, rest) = planar(
        "PlanarOffset { x: 0.3, y: 0.4, angle_a: angle, position_a: place }",
        "output place[2] = place; output end[2] = part.position_b;",
    );
    let (sine, cosine) = rest[0].sin_cos();
    let arm = [0.3 * cosine - 0.4 * sine, 0.3 * sine + 0.4 * cosine];
    assert_near(
        &b,
        &[a[0], a[1] - a[0] * arm[1], a[2] + a[0] * arm[0]],
        1e-12,
    );
    assert_near(&rest[3..], &[rest[1] + arm[0], rest[2] + arm[1]], 1e-12);

    let (a, b, rest) = planar(
        "PlanarPrismatic { angle_a: angle, direction: 0.2, damping: 0.3, stiffness: 5.0, force: 1.0 }",
        "output rate = part.rate.f; output travel = part.travel;",
    );
    let (sine, cosine) = (rest[0] + 0.2).sin_cos();
    let (rate, travel) = (rest[1], rest[2]);
    let expected = [
        a[0],
        a[1] - a[0] * travel * sine + rate * cosine,
        a[2] + a[0] * travel * cosine + rate * sine,
    ];
    assert_near(&b, &expected, 1e-12);
}

#[test]
fn what_is_not_given_costs_nothing() {
    let model = |gravity: &str| {
        compiled(&format!(
            "model M {{
                {gravity}
                1 a[6];
                1 b[6] {{ R air {{ resistance: diag(0.7, 0.8, 0.9, 1.0, 1.1, 1.2) }} }}
                body: Body {{ mass: 2.0, inertia: 3.0, gravity_at: gravity }} (a);
                hinge: Revolute {{ axis: 2 }} (a, b);
            }}"
        ))
    };
    let operations = |model: &Compiled| model.program.routines[Routines::DERIVATIVE].operations();
    let weightless = model("");
    // Six momenta and the angle; the damper and the drive that are not given leave no trace in the program.
    assert_eq!(weightless.states.len(), 7);
    // Drawn with one stroke per multibond, the hinge needs its damper, whose flow may be the rate.
    let drawn = "model M {
        causality componentwise;
        1 a[6];
        1 b[6] { R air { resistance: diag(0.7, 0.8, 0.9, 1.0, 1.1, 1.2) } }
        1 velocity[3] { I body { inertia: 2.0 } }
        a[0..3] -> I spin { inertia: 3.0, gyroscopic };
        a[3..6] -> velocity;
        velocity -> MGY coupling { effort: skew(body.p) } -> a[0..3];
        1 rate { Se free { effort: 0.0 } }
        integral angle = rate.f;
        0 moment[3];
        a[0..3] -> moment;
        rate -> moment.z;
        moment -> MTF turn { flow: transpose(rot_z(angle)) } -> b[0..3];
        a[3..6] -> MTF swing { flow: transpose(rot_z(angle)) } -> b[3..6];
    }";
    assert_eq!(operations(&weightless), operations(&compiled(drawn)));
    assert!(operations(&model("gravity [0.0, 0.0, -9.81];")) > operations(&weightless));
}

/// A planar pendulum of rods, as a user would write it.
const PENDULUM: &str = "#[derivative]
model Pendulum {
    gravity [0.0, -9.81];
    let rods = 3;
    ends: for k in 0..rods + 1 { 1 end[3]; }
    Sf fixed[3] { flow: 0.0 } -> ends[0].end;
    links: for k in 0..rods {
        1 top[3];
        1 middle[3];
        hinge: PlanarRevolute { initial: 0.5 } (ends[k].end, top);
        half: PlanarOffset { x: 0.5 } (top, middle);
        body: PlanarBody { mass: 1.0, inertia: 1.0 / 12 } (middle);
        rod: PlanarOffset { x: 1.0 } (top, ends[k+1].end);
    }
    output tip[2]: m = links[rods-1].rod.position_b;
}";

/// A chain of rods with axes in turn about x and y, as a user would write it.
const CHAIN: &str = include_str!("stages/chain.mbg");

#[test]
fn mechanisms_of_any_length_are_written_once() {
    let (pendulum, _) = elaborated(PENDULUM).unwrap();
    let states: Vec<&str> = pendulum
        .states
        .iter()
        .map(|it| it.variable.name.as_str())
        .collect();
    assert_eq!(
        states,
        [
            "links[0].body.spin.p",
            "links[0].body.body.p.x",
            "links[0].body.body.p.y",
            "links[1].body.spin.p",
            "links[1].body.body.p.x",
            "links[1].body.body.p.y",
            "links[2].body.spin.p",
            "links[2].body.body.p.x",
            "links[2].body.body.p.y",
            "links[0].hinge.angle",
            "links[1].hinge.angle",
            "links[2].hinge.angle",
        ]
    );
    let coordinates = pendulum.graph.junctions.iter().filter(|it| it.coordinate);
    assert_eq!(coordinates.count(), 3);
    for rods in [1, 32, 64] {
        let text = CHAIN.replace("rods = 4", &format!("rods = {rods}"));
        let (chain, _) = elaborated(&text).unwrap();
        assert_eq!(chain.states.len(), 7 * rods);
        assert_eq!(chain.outputs.len(), rods);
    }
}

/// The place of a state in the order of the program.
fn place(model: &Compiled, name: &str) -> usize {
    let mut names = model
        .states
        .iter()
        .map(|state| &model.model.states[*state].variable.name);
    names.position(|known| known == name).unwrap()
}

#[test]
fn a_pendulum_swings_on_a_cart() {
    assert_lossless(&compiled(PENDULUM));
    let model = compiled(
        "#[derivative]
        model Cart {
            gravity [0.0, -9.81];
            1 ground[3] { Sf fixed { flow: 0.0 } }
            1 cart[3];
            1 arm[3];
            1 bob[3];
            slide: PlanarPrismatic { force: 0.7 } (ground, cart);
            body: PlanarBody { mass: 3.0, inertia: 1.0 } (cart);
            hinge: PlanarRevolute { damping: 0.2 } (cart, arm);
            rod: PlanarOffset { x: 0.5 } (arm, bob);
            load: PlanarBody { mass: 2.0, inertia: 0.1 } (bob);
            output angle = hinge.angle;
            output travel = slide.travel;
        }",
    );
    assert_lossless(&model);
    let state = state(&model);
    let change = run(&model, Routines::DERIVATIVE, &state);
    let [angle, rate, speed] =
        ["hinge.angle", "hinge.rate.f", "slide.rate.f"].map(|name| place(&model, name));
    let ((sine, cosine), (spin, slide)) = (state[angle].sin_cos(), (change[rate], change[speed]));
    // Masses 3 and 2 at a distance of 0.5, hence 2 · 0.5 = 1 as the coupling.
    let force = 5.0 * slide - (spin * sine + state[rate].powi(2) * cosine);
    let moment = (0.5 + 0.1) * spin - slide * sine + 9.81 * cosine;
    assert_near(&[force, moment], &[0.7, -0.2 * state[rate]], 1e-12);
    assert_near(&[change[angle]], &[state[rate]], 1e-12);
}

/// The torques that move the chain as given, by the recursion of Newton and Euler in the axes of the links.
fn torques(angles: &[f64], rates: &[f64], accelerations: &[f64]) -> Vec<f64> {
    let (tip, centre, inertia) = (
        [0.0, 0.0, -1.0],
        [0.0, 0.0, -0.5],
        [0.083_958_333_333_333_34, 0.083_958_333_333_333_34, 0.001_25],
    );
    let along = |axis: usize, value: f64| {
        let mut vector = [0.0; 3];
        vector[axis] = value;
        vector
    };
    let spun = |omega: &[f64; 3], alpha: &[f64; 3], arm: &[f64; 3]| {
        sum(&[cross(alpha, arm), cross(omega, &cross(omega, arm))])
    };
    let (mut omega, mut alpha, mut acceleration) = ([0.0; 3], [0.0; 3], [0.0, 0.0, 9.81]);
    let mut loads = Vec::new();
    for (link, angle) in angles.iter().enumerate() {
        let axis = link % 2;
        if link > 0 {
            acceleration = sum(&[acceleration, spun(&omega, &alpha, &tip)]);
        }
        acceleration = turned(acceleration, axis, *angle);
        let rate = along(axis, rates[link]);
        omega = sum(&[turned(omega, axis, *angle), rate]);
        let own = sum(&[along(axis, accelerations[link]), cross(&omega, &rate)]);
        alpha = sum(&[turned(alpha, axis, *angle), own]);
        let momentum = [0, 1, 2].map(|axis| inertia[axis] * omega[axis]);
        let change = [0, 1, 2].map(|axis| inertia[axis] * alpha[axis]);
        let force = sum(&[acceleration, spun(&omega, &alpha, &centre)]);
        let moment = sum(&[change, cross(&omega, &momentum), cross(&centre, &force)]);
        loads.push((force, moment));
    }
    let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
    let mut torques = vec![0.0; angles.len()];
    for (link, (own_force, own_moment)) in loads.into_iter().enumerate().rev() {
        moment = sum(&[own_moment, moment, cross(&tip, &force)]);
        force = sum(&[own_force, force]);
        torques[link] = moment[link % 2];
        force = turned(force, link % 2, -angles[link]);
        moment = turned(moment, link % 2, -angles[link]);
    }
    torques
}

#[test]
fn a_chain_moves_as_newton_and_euler_say() {
    for rods in 1..7 {
        let model = compiled(&CHAIN.replace("rods = 4", &format!("rods = {rods}")));
        let state = state(&model);
        let place = |link: usize, word: &str| place(&model, &format!("links[{link}].hinge.{word}"));
        let change = run(&model, Routines::DERIVATIVE, &state);
        let by_link = |word: &str, values: &[f64]| -> Vec<f64> {
            (0..rods).map(|link| values[place(link, word)]).collect()
        };
        let rates = by_link("rate.f", &state);
        assert_near(&by_link("angle", &change), &rates, 1e-12);
        let found = torques(
            &by_link("angle", &state),
            &rates,
            &by_link("rate.f", &change),
        );
        let damping: Vec<f64> = rates.iter().map(|rate| -0.1 * rate).collect();
        assert_near(&found, &damping, 1e-9);
    }
}

#[test]
fn mistakes_inside_the_library_are_told_at_the_instance() {
    let planar = "model M { gravity [0.0, 0.0, -9.81]; 1 a[3];
        body: PlanarBody { mass: 1.0, inertia: 2.0 } (a); }";
    insta::assert_snapshot!(elaborated(planar).err().unwrap(), @"
    1:19 `gravity` does not fit in `PlanarBody`: `fall` has dimension 2, found a vector of 3 [MBG0204]
      help: write `gravity [0.0, -9.81];` in the model
    ");
    let axis = "model M { 1 a[6]; 1 b[6];
        hinge: Revolute { axis: 3 } (a, b); }";
    insta::assert_snapshot!(elaborated(axis).err().unwrap(), @"
    2:33 `axis` does not fit in `Revolute`: found `3` [MBG0204]
      `axis`: 0, 1 or 2 for x, y or z
      inside it, `moment` has 3 components, `moment[axis]` asks for more
    ");
    let undecided = "model M { param n = 1.0; 1 a[6]; 1 b[6];
        hinge: Revolute { axis: n, blocked: compliant } (a, b); }";
    insta::assert_snapshot!(elaborated(undecided).err().unwrap(), @"
    2:9 expected a condition that is decided while the model is compiled, found `free == 0` [MBG0220]
      this is inside `Revolute`, a component of the library
      help: it compares whole numbers that are known then, or a parameter with one of its words, as in `blocked == ideal`
      help: it may ask `given(parameter)`, and join conditions by `&&`, `||` and `!`
    ");
    let word = "model M { 1 a[6]; 1 b[6];
        hinge: Revolute { axis: 1, blocked: complaint } (a, b); }";
    insta::assert_snapshot!(elaborated(word).err().unwrap(), @"
    2:45 expected `ideal` or `compliant`, found `complaint` [MBG0219]
      help: did you mean `compliant`?
    ");
    let shape = "model M { 1 a[6]; 1 b[6];
        offset: Offset { by: [1.0, 2.0] } (a, b); }";
    insta::assert_snapshot!(elaborated(shape).err().unwrap(), @"2:26 `by` has dimension 3, found a vector of 2 [MBG0204]");
    let negative = "component Arm(port a[6]) { body: Body { mass: -1.0, inertia: 2.0 } (a); }
        model M { 1 a[6]; arm: Arm (a); }";
    insta::assert_snapshot!(elaborated(negative).err().unwrap(), @"1:47 `mass` does not fit in `Body`: the inertia of `body` is -1, not positive [MBG0216]");
    let word = "model M { 1 a[6];
        body: Body { mas: 1.0, inertia: 2.0 } (a); output p = body.spin.p.x; }";
    insta::assert_snapshot!(elaborated(word).err().unwrap(), @"
    2:22 `Body` has no parameter `mas` [MBG0207]
      help: did you mean `mass`?
      help: its parameters are `mass`, `inertia`, `centre`, `gravity_at`
    ");
    let unknown = "model M { 1 a[6];
        body: Bodi { mass: 1.0 } (a); output p = body.spin.p.x; }";
    insta::assert_snapshot!(elaborated(unknown).err().unwrap(), @"
    2:15 component `Bodi` is not declared [MBG0203]
      help: did you mean `Body`?
    ");
}

#[test]
fn a_joint_starts_with_its_rate() {
    let pendulum = |rate: &str| {
        compiled(&format!(
            "#[derivative] model M {{
                param rate: rad/s = 0.3;
                1 ground[3];
                1 end[3];
                Sf fixed[3] {{ flow: 0.0 }} -> ground;
                rod: PlanarLink {{ mass: 2.0, inertia: 0.1, centre: [0.5, 0.0], end: [1.0, 0.0], initial_rate: {rate} }}
                    (ground, end);
            }}"
        ))
    };
    let place = |model: &Compiled| {
        let name = |state: &usize| &model.model.states[*state].variable.name;
        model
            .states
            .iter()
            .position(|state| name(state) == "rod.hinge.rate.f")
            .unwrap()
    };
    let model = pendulum("2.0 * rate");
    let initial = run(&model, Routines::INITIAL, &[]);
    assert_eq!(initial[place(&model)], 0.6);
    let model = pendulum("0.0");
    assert_eq!(run(&model, Routines::INITIAL, &[])[place(&model)], 0.0);
}

/// What would create energy is told at its value, whether the spring is a storage or not.
#[test]
fn springs_with_an_asymmetric_matrix_are_refused() {
    let told = |joint: &str| {
        let text = format!("model M {{ 1 a[6]; 1 b[6];\njoint: {joint} (a, b); }}");
        elaborated(&text).err().unwrap()
    };
    let skew = "[[100.0, 30.0, 0.0], [20.0, 400.0, 0.0], [0.0, 0.0, 900.0]]";
    for word in ["angles", "quaternion", "matrix"] {
        let found = told(&format!(
            "Spherical {{ orientation: {word}, stiffness: {skew} }}"
        ));
        let place = format!("2:{} ", 46 + word.len());
        assert!(found.starts_with(&place), "{found}");
        assert_eq!(found.matches("[MBG0213]").count(), 1, "{found}");
        assert!(
            found.contains("entry `[0][1]` is 30, entry `[1][0]` is 20"),
            "{found}"
        );
    }
    let bearing = |value: &str| {
        told(&format!(
            "Fixed {{ blocked: compliant, blocked_stiffness: {value} }}"
        ))
    };
    assert!(bearing(skew).contains("the matrix of a storage must be symmetric"));
    let vector = bearing("[1e6, 1e6, 3e6]");
    assert!(vector.contains("write `diag(…)` for a matrix"), "{vector}");
}
