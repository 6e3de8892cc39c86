//! Components of other tools and their parameters, and what is to be typed instead.
#![allow(clippy::unwrap_used)]

mod told;

use told::{diagnose, told};

/// The texts in backticks of the first help of each mistake.
fn typed(text: &str) -> Vec<String> {
    let diagnostics = diagnose(text);
    let helps = diagnostics.list().iter().map(|it| {
        let help = it.helps.first().map_or("", String::as_str);
        help.split('`').nth(1).unwrap_or_default().to_owned()
    });
    helps.collect()
}

/// A body on a joint, both as they are written.
fn scene(body: &str, joint: &str) -> String {
    format!(
        "#[derivative] model M {{ causality componentwise; 1 ground[6]; 1 arm[6]; Sf still[6] {{ flow: 0.0 }} -> ground;
         body: {body} (arm);\njoint: {joint} (ground, arm); }}"
    )
}

/// What is typed for parameters, after which nothing is told.
fn follow(scene: &dyn Fn(&str) -> String, slip: &str, expected: &str) {
    let help = typed(&scene(slip)).join(", ");
    assert_eq!(help, expected);
    assert_eq!(told(&scene(&help)), "");
}

#[test]
fn what_stands_in_the_place_of_something_else_is_told() {
    let rope = scene("Body { mass: 1.0, inertia: 1.0 }", "Rope { rest: 1.0 }");
    assert_eq!(typed(&rope), ["LineForce"]);
    let end = scene(
        "Body { mass: 1.0, inertia: 1.0 }",
        "HardStop { stiffness: 1.0 }",
    );
    assert_eq!(typed(&end), ["Stop"]);
    let driven = scene("Body { mass: 1.0, inertia: 1.0 }", "Revolute { axis: 2 }");
    let driven = |end: &str| {
        driven.replace(
            "(ground, arm); }",
            &format!("(ground, arm);\nSf drive {{ flow: 1.0 }} -> joint.{end}; }}"),
        )
    };
    insta::assert_snapshot!(told(&driven("angle")), @"
    4:27 `joint.angle` is not declared [MBG0203]
      help: junctions of `joint` are `force`, `moment`, `rate`
    ");
    insta::assert_snapshot!(told(&driven("rat")), @"
    4:27 `joint.rat` is not declared [MBG0203]
      help: did you mean `joint.rate`?
    ");
    assert_eq!(told(&driven("rate")), "");
    let value = |declared: &str| {
        format!("model M {{ param k{declared}; 1 v {{ I m {{ inertia: k }} }} output y = v.f; }}")
    };
    insta::assert_snapshot!(told(&value(": 1.0")), @"
    1:20 expected the name of a unit, found `1.0` [MBG0102]
      help: a colon is before a unit; a value follows `=`: write `= 1.0`
    ");
    insta::assert_snapshot!(told(&value(": f64 = 1.0")), @"
    1:20 `f64` is not a unit of SI [MBG0502]
      help: a colon is before a unit, and every value is a number: leave the colon and the type out
    ");
    insta::assert_snapshot!(told(&value(": [f64; 3] = [1.0, 2.0, 3.0]")), @"
    1:20 expected the name of a unit, found `[` [MBG0102]
      help: a colon is before a unit, and a size stands behind the name, as in `gains[3] = …`
    ");
    insta::assert_snapshot!(told(&value(": kg [3] = [1.0, 2.0, 3.0]")), @"
    1:23 expected the end of the unit, found `[` [MBG0102]
      help: a size stands behind the name: write `k[3]: kg`
    ");
    let way = |declared: &str| {
        let hull = "1 hull[3] { I m { inertia: 2.0 } }";
        format!("model M {{ {hull} integral way{declared}; output y = way.x; }}")
    };
    insta::assert_snapshot!(told(&way(": m = hull.f, initial: [1.0, 0.0, 0.0]")), @"
    1:55 `way` has dimension 1, found a vector of 3 [MBG0204]
      help: write `integral way[3]: m = hull.f, initial: [1.0, 0.0, 0.0];`
    ");
    assert_eq!(told(&way("[3]: m = hull.f, initial: [1.0, 0.0, 0.0]")), "");
    insta::assert_snapshot!(told(&value(" = noise(0.1)")), @"
    1:21 `noise` is not a function of the language [MBG0203]
      help: what is random or sampled comes from outside: declare an `input`, and give its values by `Sampled::held`
    ");
    assert_eq!(told(&value(" = 1.0")), "");
    let thrust = |read: &str| {
        format!(
            "model M {{ input thrust[4]; output y = v.f[0];
             1 v[3] {{ I m {{ inertia: 2.0 }} Se lift {{ effort: [0.0, 0.0, {read}] }} }} }}"
        )
    };
    insta::assert_snapshot!(told(&thrust("thrust")), @"
    2:73 expected a number, found a vector of 4 [MBG0204]
      help: write one component, such as `thrust[0]`
    ");
}

#[test]
fn parameters_of_bodies_and_joints_are_told_by_their_names_here() {
    let body = |given: &str| scene(&format!("Body {{ {given} }}"), "Fixed");
    follow(&body, "m: 1.0, I: 2.0", "mass: 1.0, inertia: 2.0");
    follow(
        &body,
        "m: 2.0, moment_of_inertia: 1.0, com: [0.0, 0.0, 0.5]",
        "mass: 2.0, inertia: 1.0, centre: [0.0, 0.0, 0.5]",
    );
    let joint = |given: &str| {
        scene(
            "Body { mass: 1.0, inertia: 1.0 }",
            &format!("Revolute {{ {given} }}"),
        )
    };
    let given = "n: 1, initial_angle: 0.2, initial_velocity: 1.0, spring: 2.0, damper: 0.1";
    let here = "axis: 1, initial: 0.2, initial_rate: 1.0, stiffness: 2.0, damping: 0.1";
    follow(&joint, given, here);
    follow(
        &joint,
        "n: 1, phi_start: 0.2, w_start: 1.0, k: 2.0, d: 0.1",
        here,
    );
    insta::assert_snapshot!(told(&joint("axis: 1, phi_start: 0.1")), @"
    3:28 `Revolute` has no parameter `phi_start` [MBG0207]
      help: write `initial: 0.1`
    ");
}

/// Joints with an angle and a travel take positions and velocities for the travel.
#[test]
fn starts_of_joints_are_told_by_what_they_are_starts_of() {
    for (joint, slip, here) in [
        ("Free", "position: [0.0, 0.0, 1.0]", "initial_position"),
        ("Free", "initial_pos: [0.0, 0.0, 1.0]", "initial_position"),
        ("Free", "velocity: [0.0, 0.0, 1.0]", "initial_velocity"),
        ("Free", "initial_angles: [0.0, 0.0, 1.0]", "initial"),
        ("Free", "w_start: [0.0, 0.0, 1.0]", "initial_rate"),
        ("Planar", "axis: 2, position: [1.0, 0.0]", "initial_travel"),
        ("Planar", "axis: 2, velocity: [1.0, 0.0]", "initial_sliding"),
        ("Planar", "axis: 2, angle: 1.0", "initial_angle"),
        ("Planar", "axis: 2, rate: 1.0", "initial_turning"),
        ("Cylindrical", "axis: 2, position: 1.0", "initial_travel"),
        ("Cylindrical", "axis: 2, angle: 1.0", "initial_angle"),
        ("Revolute", "axis: 2, speed: 1.0", "initial_rate"),
        ("Prismatic", "axis: 2, speed: 1.0", "initial_rate"),
        ("Prismatic", "axis: 2, position: 1.0", "initial"),
    ] {
        let text = |given: &str| {
            scene(
                "Body { mass: 1.0, inertia: 1.0 }",
                &format!("{joint} {{ {given} }}"),
            )
        };
        let (words, value) = slip.rsplit_once(": ").unwrap();
        let (front, _) = words
            .rsplit_once(' ')
            .map_or(("", words), |(front, _)| (front, ""));
        let help = typed(&text(slip)).remove(0);
        assert_eq!(help, format!("{here}: {value}"));
        assert_eq!(told(&text(&format!("{front} {help}"))), "");
    }
}

#[test]
fn parameters_of_circuits_are_told_by_their_names_here() {
    let circuit = |given: &str| {
        let [r, c, l] = given.split(", ").collect::<Vec<_>>()[..] else {
            panic!("three parameters")
        };
        format!(
            "model M {{ 0 n; 0 p; 0 q; 0 zero; Se g {{ effort: 0.0 }} -> zero; Se u {{ effort: 1.0 }} -> n;
             one: Resistor {{ {r} }} (n, p); two: Inductor {{ {l} }} (p, q); three: Capacitor {{ {c} }} (q, zero); }}"
        )
    };
    let given = "R: 5.0, C: 1e-6, L: 2.0 * 1e-3";
    let help = typed(&circuit(given));
    assert_eq!(
        help,
        [
            "resistance: 5.0",
            "inductance: 2.0 * 1e-3",
            "capacitance: 1e-6"
        ]
    );
    let [r, l, c] = &help[..] else {
        panic!("three")
    };
    assert_eq!(told(&circuit(&[r.as_str(), c, l].join(", "))), "");
    // A name that a component has is its own, whatever it stands for elsewhere.
    let own = "component Own(port 1 at) { param r; param resistance; R d { resistance: r * resistance } -> at; }
        model M { 1 v { I m { inertia: 1.0 } } own: Own { r: 1.0 } (v); }";
    assert!(told(own).contains("`Own` needs a value for `resistance`"));
}

#[test]
fn states_at_the_start_are_told_by_their_words() {
    let text = |inertia: &str, spring: &str| {
        format!(
            "model M {{ 1 v {{ I m {{ inertia: 1.0, {inertia} }} C c {{ stiffness: 1.0, {spring} }} }} }}"
        )
    };
    let help = typed(&text("initial_velocity: 2.0", "initial_displacement: 0.1"));
    assert_eq!(help, ["initial_flow: 2.0", "initial: 0.1"]);
    assert_eq!(told(&text(&help[0], &help[1])), "");
}

#[test]
fn components_are_told_by_their_names_in_the_library() {
    for (name, here) in [
        ("RevoluteJoint", "Revolute"),
        ("revolute_joint", "Revolute"),
        ("PrismaticJoint", "Prismatic"),
        ("WeldJoint", "Fixed"),
        ("Weld", "Fixed"),
        ("FixedTranslation", "Offset"),
        ("RigidTransform", "Mount"),
        ("BodyShape", "Body"),
        ("HeatCapacitor", "HeatCapacity"),
    ] {
        let told = typed(&scene("Body { mass: 1.0, inertia: 1.0 }", name));
        assert_eq!(told, [here]);
    }
}

#[test]
fn what_is_made_of_elements_is_told_with_them() {
    let circuit = |given: &str| {
        format!(
            "model M {{ 0 n; 0 p; 0 q; a: Resistor {{ resistance: 1.0 }} (n, q); c: Capacitor {{ capacitance: 1.0 }} (q, p);\n{given} }}"
        )
    };
    let shafts = |given: &str| {
        format!(
            "model M {{ 1 v {{ I j {{ inertia: 1.0 }} R b {{ resistance: 1.0 }} }} 1 w {{ I k {{ inertia: 1.0 }} }}\n{given} }}"
        )
    };
    let scenes: [&dyn Fn(&str) -> String; 2] = [&circuit, &shafts];
    for (scene, slip, here) in [
        (
            0,
            "u: VoltageSource { V: 5.0 } (p, n); zero: Ground (n);",
            "1 u_between { Se u { effort: 5.0 } } n -> u_between; u_between -> p; Se zero { effort: 0.0 } -> n;",
        ),
        (
            0,
            "i: CurrentSource (p, n); zero: Ground (n);",
            "1 i_between { Sf i { flow: … } } p -> i_between; i_between -> n; Se zero { effort: 0.0 } -> n;",
        ),
        (
            1,
            "m: Mass { m: 1.0 } (v);",
            "#[derivative] I m { inertia: 1.0 } -> v;",
        ),
        (1, "f: Force (v);", "Se f { effort: … } -> v;"),
        (
            1,
            "s: Spring { c: 1.0 } (v, w);",
            "0 s_between { C s { stiffness: 1.0 } } v -> s_between; s_between -> w;",
        ),
        (
            1,
            "s: SpringDamper (v, w);",
            "0 s_between; 1 s { C spring { stiffness: … } R damper { resistance: … } } v -> s_between; s_between -> w; \
             s_between -> s;",
        ),
    ] {
        let help = typed(&scenes[scene](slip)).join(" ");
        assert_eq!(help, here.trim_start_matches("#[derivative] "));
        assert_eq!(told(&scenes[scene](&here.replace('…', "1.0"))), "");
    }
    let mass = typed(&scene("Mass { m: 1.0 }", "Fixed"));
    assert_eq!(mass, ["body: Body { mass: …, inertia: … } (arm);"]);
    let world = scene("Body { mass: 1.0, inertia: 1.0 }", "Fixed");
    let world = world.replace(
        "Sf still[6] { flow: 0.0 } -> ground;",
        "still: World (ground);",
    );
    assert_eq!(typed(&world), ["Sf still[6] { flow: 0.0 } -> ground;"]);
    insta::assert_snapshot!(told(&shafts("m: Mass { m: 1.0 } (v);")), @"
    2:4 component `Mass` is not declared [MBG0203]
      help: here it is written `I m { inertia: 1.0 } -> v;`
    ");
}

#[test]
fn what_elements_have_no_place_for_is_told() {
    let text = |component: &str| {
        format!(
            "model M {{ 0 p {{ C c {{ compliance: 1.0 }} }} 0 n {{ Se zero {{ effort: 0.0 }} }} 1 v; 1 w; z:\n{component}; }}"
        )
    };
    insta::assert_snapshot!(told(&text("Battery { voltage: 12.0, resistance: 0.1, capacity: 5.0 } (p, n)")), @"
    2:1 component `Battery` is not declared [MBG0203]
      help: here it is written `1 z_between { Se z { effort: 12.0 } } n -> z_between; z_between -> p;`; that leaves out `resistance`, `capacity`
    ");
    insta::assert_snapshot!(told(&text("WormGear { ratio: 40.0, efficiency: 0.7 } (v, w)")), @"
    2:1 component `WormGear` is not declared [MBG0203]
      help: here it is written `v -> TF z { flow: 1 / 40.0 } -> w;`; that leaves out `efficiency`
    ");
    insta::assert_snapshot!(told(&text("Damper { c: 5.0 } (v, w)")), @"
    2:1 component `Damper` is not declared [MBG0203]
      help: here it is written `0 z_between { R z { resistance: … } } v -> z_between; z_between -> w;`
    ");
    // What is to be filled in may be what was given.
    insta::assert_snapshot!(told(&text("Pipe { length: 100.0, diameter: 0.1 } (p, n)")), @"
    2:1 component `Pipe` is not declared [MBG0203]
      help: here it is written `1 z_between { R z { conductance: … } } p -> z_between; z_between -> n;`
    ");
}

#[test]
fn the_inverse_of_a_parameter_is_told() {
    let heat = |given: &str| {
        format!(
            "model M {{ 0 a pseudo; 0 b pseudo {{ Se air {{ effort: 290.0 }} }} room: HeatCapacity {{ capacity: 1e3 }} (a);
             wall: Conduction {{ {given} }} (a, b); }}"
        )
    };
    for (slip, here) in [
        ("R: 0.2", "conductance: 1 / 0.2"),
        ("resistance: 0.2 + 0.1", "conductance: 1 / (0.2 + 0.1)"),
    ] {
        assert_eq!(typed(&heat(slip)), [here]);
        assert_eq!(told(&heat(here)), "");
    }
    let circuit = |given: &str| {
        format!(
            "model M {{ 0 a {{ C c {{ compliance: 1.0 }} }} 0 b {{ Se zero {{ effort: 0.0 }} }} r: Resistor {{ {given} }} (a, b); }}"
        )
    };
    assert_eq!(typed(&circuit("conductance: 0.1")), ["resistance: 1 / 0.1"]);
    assert_eq!(told(&circuit("resistance: 1 / 0.1")), "");
}

#[test]
fn what_a_component_is_given_is_not_told_as_what_it_has() {
    let text = |slide: &str, read: &str| {
        format!(
            "#[derivative] model M {{ causality componentwise; 1 ground[3]; 1 cart[3]; Sf fixed[3] {{ flow: 0.0 }} -> ground;
             slide: PlanarPrismatic {{ initial: 1.0{slide} }} (ground, cart); load: PlanarPointMass {{ mass: 2.0 }} (cart);
             rope: PlanarLineForce {{ stiffness: 100.0 }} (ground, cart); output y = {read}; }}"
        )
    };
    for [slip, here] in [
        ["rope.effort", "rope.tension"],
        ["rope.pressure", "rope.tension"],
    ] {
        assert_eq!(typed(&text("", slip)), [here]);
        assert_eq!(told(&text("", here)), "");
    }
    for slide in ["", ", stiffness: 5.0", ", force: 3.0"] {
        let told = told(&text(slide, "slide.effort"));
        assert!(
            told.contains("`damper.e`, `motor.e`") && !told.contains("slide.force"),
            "{told}"
        );
    }
}

#[test]
fn an_effort_at_the_start_is_given_by_its_word() {
    let text = |law: &str, start: &str| {
        format!("model M {{ 0 n {{ C c {{ {law}, {start} }} R r {{ resistance: 1.0 }} }} }}")
    };
    for (law, slip) in [
        ("compliance: 2.0", "initial_pressure: 3.0"),
        ("stiffness: 2.0", "initial_voltage: 3.0"),
        ("effort: 2.0 * q", "initial_force: 3.0"),
    ] {
        assert_eq!(typed(&text(law, slip)), ["initial_effort: 3.0"]);
        assert_eq!(told(&text(law, "initial_effort: 3.0")), "");
    }
    insta::assert_snapshot!(told(&text("effort: q * q", "initial_effort: 3.0")), @"
    1:54 the displacement of `c` does not follow from an effort: its law is not linear [MBG0213]
      help: give the displacement itself: `initial: …`
    ");
    insta::assert_snapshot!(told(&text("stiffness: 2.0, initial: 1.0", "initial_effort: 3.0")), @"
    1:53 `c` is given both a displacement and an effort at the start [MBG0104]
      help: remove `initial` or `initial_effort`: one follows from the other
    ");
    insta::assert_snapshot!(told(&text("stiffness: 2.0, displacement: 1.0", "initial_effort: 3.0")), @"
    1:58 `c` is given both a displacement and where that starts [MBG0104]
      help: remove `initial_effort` or `displacement`: one follows from the other
    ");
}

#[test]
fn amplifiers_and_tanks_are_told_as_elements() {
    let circuit = |given: &str| {
        format!(
            "model M {{ 0 a {{ C c {{ compliance: 1.0 }} R q {{ resistance: 1.0 }} }} 0 b {{ C d {{ compliance: 1.0 }} }}
             0 out {{ R r {{ resistance: 1.0 }} }}\n{given} }}"
        )
    };
    for (slip, here) in [
        (
            "amp: OpAmp { } (a, b, out);",
            "Se amp { effort: 1e5 * (a.e - b.e) } -> out;",
        ),
        (
            "t: Tank { area: 1.0 } (out);",
            "C t { compliance: … } -> out;",
        ),
    ] {
        assert_eq!(typed(&circuit(slip)), [here]);
        assert_eq!(told(&circuit(&here.replace('…', "1.0"))), "");
    }
}

#[test]
fn a_diagonal_of_a_vector_is_told_by_its_components() {
    let body = |inertia: &str| {
        format!(
            "#[derivative] model M {{ causality componentwise; param j[3]: kg*m^2 = [1.0, 2.0, 2.0]; 1 arm[6];
             body: Body {{ mass: 1.0, inertia: {inertia} }} (arm); }}"
        )
    };
    for (slip, here) in [
        ("diag(j)", "diag(j.x, j.y, j.z)"),
        ("diag([1.0, 2.0, 2.0])", "diag(1.0, 2.0, 2.0)"),
    ] {
        assert!(
            told(&body(slip)).contains(&format!("write `{here}`")),
            "{}",
            told(&body(slip))
        );
        assert_eq!(told(&body(here)), "");
    }
}

/// A foot of a body in a plane, with a joint of its own.
fn foot(joint: &str, foot: &str) -> String {
    format!(
        "#[derivative] model M {{ causality componentwise; gravity [0.0, -9.81]; 1 ground[3]; 1 leg[3];
         Sf still[3] {{ flow: 0.0 }} -> ground;\nturn: PlanarRevolute {joint} (ground, leg);\n{foot} (leg);
         body: PlanarBody {{ mass: 1.0, inertia: 1.0 }} (leg); }}"
    )
}

#[test]
fn what_rubs_on_the_ground_is_a_contact() {
    for called in ["Ground", "Foot", "Floor", "Tire", "Wheel", "HertzContact"] {
        let slip = foot("", &format!("f: {called} {{ stiffness: 1e4 }}"));
        assert_eq!(typed(&slip), ["PlanarContact"], "{called}");
    }
    // A frame that stands is none.
    assert_eq!(
        typed(&foot("", "f: Ground")),
        ["Sf f[3] { flow: 0.0 } -> leg;"]
    );
    let contact = |words: &str| {
        foot(
            "",
            &format!("f: PlanarContact {{ stiffness: 1e4, {words} }}"),
        )
    };
    follow(&contact, "mu: 0.5", "friction: 0.5");
    let slow = |words: &str| contact(&format!("friction: 0.5, {words}"));
    follow(&slow, "stiction_velocity: 0.1", "friction_speed: 0.1");
    assert_eq!(
        typed(&contact("restitution: 0.5")),
        ["dissipation: 1.5 * (1 - e) / v"]
    );
    assert_eq!(typed(&contact("damping: 30.0")), ["dissipation"]);
}

#[test]
fn where_a_joint_ends_and_what_holds_it_stands_beside_it() {
    let beside = "turn_stop: Stop { displacement: turn.angle, lower: -1.0, upper: 1.0, stiffness: … } (turn.rate);";
    let slip = foot(
        "{ lower: -1.0, upper: 1.0 }",
        "f: PlanarContact { stiffness: 1e4 }",
    );
    assert_eq!(typed(&slip), [beside; 2]);
    let held = "turn_friction: Friction { sliding: 2.0, at_rest: holds } (turn.rate);";
    let slip = foot(
        "{ friction: 2.0, at_rest: holds }",
        "f: PlanarContact { stiffness: 1e4 }",
    );
    assert!(told(&slip).contains(held), "{}", told(&slip));
    for beside in [beside.replace('…', "1e3"), held.to_owned()] {
        let scene = foot("", "f: PlanarContact { stiffness: 1e4 }");
        let scene = scene.replace("\nf:", &format!("{beside}\nf:"));
        assert_eq!(told(&scene), "");
    }
}

#[test]
fn a_frame_is_given_as_a_whole() {
    let space = |part: &str| {
        format!(
            "#[derivative] model M {{ causality componentwise; gravity [0.0, 0.0, -9.81]; 1 ground[6]; 1 hull[6];
             Sf still[6] {{ flow: 0.0 }} -> ground; free: Free (ground, hull); body: Body {{ mass: 1.0, inertia: 1.0 }} (hull);
             {part} }}"
        )
    };
    assert_eq!(
        typed(&space("c: Contact { stiffness: 1e4 } (hull[3..6]);")),
        ["hull"]
    );
    let planar = foot("", "f: PlanarContact { stiffness: 1e4 }").replace("}\n (leg);", "} (leg);");
    assert_eq!(
        typed(&planar.replace("1e4 } (leg)", "1e4 } (leg[1..3])")),
        ["leg"]
    );
    // Half of a frame in space has as many components as a frame in a plane.
    insta::assert_snapshot!(told(&space("c: PlanarContact { stiffness: 1e4 } (hull[3..6]);")), @"
    3:51 port `at` takes a frame in a plane, and `hull[3..6]` is one half of a frame in space [MBG0204]
      help: write `Contact`, which is for frames in space, and give it all of that frame
    ");
    assert_eq!(told(&space("c: Contact { stiffness: 1e4 } (hull);")), "");
}

#[test]
fn a_contact_of_two_bodies_is_one_between_them() {
    let scene = |contact: &str| {
        format!(
            "#[derivative] model M {{ causality componentwise; 1 ground[6]; 1 deck[6]; 1 hull[6];
             Sf still[6] {{ flow: 0.0 }} -> ground; heave: Prismatic {{ axis: 2 }} (ground, deck); free: Free (ground, hull);
             d: Body {{ mass: 1.0, inertia: 1.0 }} (deck); h: Body {{ mass: 1.0, inertia: 1.0 }} (hull); {contact} }}"
        )
    };
    let written = typed(&scene("c: Contact { stiffness: 1e4 } (hull, deck);"));
    assert_eq!(written, ["c: BodyContact { … } (hull, deck);"]);
    assert_eq!(told(&scene(&written[0].replace('…', "stiffness: 1e4"))), "");
    for called in ["SphereContact", "HertzContact", "SpatialContactForce"] {
        let elsewhere = format!("c: {called} {{ stiffness: 1e4 }} (hull, deck);");
        assert_eq!(typed(&scene(&elsewhere)), ["BodyContact"], "{called}");
    }
    let holds = scene("c: BodyContact { stiffness: 1e4, at_rest: holds } (hull, deck);");
    insta::assert_snapshot!(told(&holds), @"
    3:135 `BodyContact` has no parameter `at_rest` [MBG0207]
      help: in space friction creeps, below `friction_speed`; a `PlanarBodyContact` holds
    ");
}

#[test]
fn a_ground_that_is_no_plane_is_a_stop() {
    let scene = |part: &str| {
        format!(
            "#[derivative] model M {{ causality componentwise; gravity [0.0, -9.81]; 1 foot[3]; integral way[3] = foot.f;
             body: PlanarBody {{ mass: 1.0, inertia: 1.0 }} (foot); {part} }}"
        )
    };
    let ground = "0.1 * sin(3.0 * way[1])";
    let contact = |height: &str, position: &str| {
        scene(&format!(
            "c: PlanarContact {{ stiffness: 1e4, height: {height}, position_at: {position} }} (foot);"
        ))
    };
    let over = contact(ground, "way[1..3]");
    assert!(told(&over).contains("of a `PlanarBodyContact`, on another body"));
    let written = typed(&over).pop().unwrap();
    assert_eq!(
        written,
        "1 c_approach; foot[1..3] -> MTF c_down { flow: [[slope, -1.0]] } -> c_approach; \
         c: Stop { displacement: ground - height_at, upper: 0.0, stiffness: … } (c_approach);"
    );
    let written = written.replace('…', "1e4");
    let around = format!(
        "let ground = {ground}; let slope = 0.3 * cos(3.0 * way[1]); let height_at = way[2];"
    );
    assert_eq!(told(&scene(&format!("{around} {written}"))), "");
    // A position that is not that of the frame, and a height that no flow knows.
    insta::assert_snapshot!(told(&contact("0.0", "[way[2], way[1]]")), @"
    2:67 the displacement of `c.stop.upper_spring` does not change as `c.stop.upper_spring` flows [MBG0309]
      `[way[2], way[1]]` does not move as `foot` does
      help: leave `position_at` out where joints lead to `foot` from a frame that is held: they tell it; else give the integral of its velocity in axes of the world
    ");
    let lifted = scene(
        "input u; c: PlanarContact { stiffness: 1e4, height: u, position_at: way[1..3] } (foot);",
    );
    insta::assert_snapshot!(told(&lifted), @"
    2:76 the displacement of `c.stop.upper_spring` reads the input `u`, whose rate nothing knows [MBG0309]
      `height` of `c` changes with time, and no flow knows that rate
      `height`: Of the ground along its normal, from the origin of the world. It stands still: on what moves it is a `PlanarBodyContact`
      help: give `height` a value that stays: what moves is a junction with a flow, such as a frame behind a joint whose rate is given, `Sf drive { flow: … } -> joint.rate;`
    ");
    assert_eq!(told(&contact("0.0", "way[1..3]")), "");
    // What nothing guides is not at the origin of the world.
    let loose = scene("c: PlanarContact { stiffness: 1e4 } (foot);");
    insta::assert_snapshot!(told(&loose), @"
    2:67 `c` needs `position_at`, which nothing tells at its frame [MBG0214]
      this is inside `PlanarContact`, a component of the library
      help: hold the frame, if it is at rest: `Sf wall[3] { flow: 0.0 } -> foot;`
      help: or let a joint, such as `PlanarFree`, lead to it from a frame that is held
    ");
    let guided = loose.replace(
        "1 foot[3];",
        "1 g[3] { Sf still { flow: 0.0 } } 1 foot[3]; free: PlanarFree (g, foot);",
    );
    assert_eq!(told(&guided), "");
}

/// What both sides of a joint that gives way are needed for.
#[test]
fn positions_behind_what_gives_way_are_told() {
    let model = |part: &str, word: &str| {
        format!(
            "#[derivative] model M {{ causality componentwise; 1 g[3]; Sf still {{ flow: 0.0 }} -> g; 1 a[3]; 1 b[3]; 1 c[3];
             rail: PlanarPrismatic (g, a); leg: PlanarPrismatic {{ direction: -1.5, initial: 1.0{word} }} (a, b);
             foot: PlanarOffset {{ x: 0.3, y: 0.1 }} (b, c); body: PlanarBody {{ mass: 2.0, inertia: 0.3 }} (b); {part} }}"
        )
    };
    let compliant = ", blocked: compliant";
    for part in [
        "on: PlanarContact { stiffness: 100.0, height: -0.3 } (c);",
        "on: PlanarLineForce { stiffness: 100.0, rest: 0.3 } (g, c);",
    ] {
        let text = told(&model(part, compliant));
        assert!(
            text.contains("positions behind `leg` leave deflections out, which flows have")
                && text.contains("help: leave `blocked: compliant` out of `leg`"),
            "{text}"
        );
        assert_eq!(told(&model(part, "")), "");
    }
    // What leads to both ends moves both: another mistake is told as what it is.
    let between = |rest: &str| {
        let part = format!("on: PlanarLineForce {{ stiffness: 100.0, rest: {rest} }} (b, c);");
        told(&model(&part, compliant))
    };
    assert_eq!(between("0.3"), "");
    let changing = between("0.3 + 0.1 * rail.travel");
    assert!(changing.contains("rest_rate"), "{changing}");
}

#[test]
fn all_parameters_are_listed_where_they_are_few() {
    let contact = foot("", "f: PlanarContact { stiffness: 1e4, wobble: 1.0 }");
    let contact = told(&contact);
    assert!(contact.contains("`at_rest`"), "{contact}");
    let joint = foot("{ wobble: 1.0 }", "f: PlanarContact { stiffness: 1e4 }");
    let joint = told(&joint);
    assert!(joint.contains("`initial_rate`"), "{joint}");
}

#[test]
fn what_other_tools_have_for_a_ground_is_declared() {
    let scene = |more: &str| {
        format!(
            "#[derivative] model M {{ causality componentwise; 1 arm[3]; {more} hinge: PlanarRevolute (world, arm);
             body: PlanarBody {{ mass: 1.0, inertia: 1.0 }} (arm); }}"
        )
    };
    let written = typed(&scene("")).remove(0);
    assert_eq!(
        written,
        "1 world[3]; Sf world_fixed[3] { flow: 0.0 } -> world;"
    );
    assert_eq!(told(&scene(&written)), "");
}

#[test]
fn a_tilt_is_a_rotation() {
    let told = |tilt: &str| {
        let model = format!(
            "#[derivative] model M {{ causality componentwise; gravity [0.0, 0.0, -9.81]; 1 ground[6]; 1 arm[6]; Sf fixed[6] {{ flow: 0.0 }} -> ground;
             hinge: Revolute {{ axis: 1, tilt: {tilt} }} (ground, arm); body: Body {{ mass: 1.0, inertia: 1.0 }} (arm); }}"
        );
        let list = diagnose(&model);
        let told: Vec<String> = list.list().iter().map(|it| it.text()).collect();
        told.join("\n")
    };
    for tilt in ["rot_x(0.5)", "diag(1.0, -1.0, -1.0)", "1.0"] {
        assert_eq!(told(tilt), "");
    }
    let angle = told("0.5");
    let expected = "`tilt` does not fit in `Revolute`: expected a 3×3 matrix, found a number";
    assert!(angle.starts_with(expected), "{angle}");
    assert!(angle.contains("such as `rot_x(0.5)`"), "{angle}");
    let stretched = told("diag(1.0, 2.0, 3.0)");
    let expected = "`tilt` does not fit in `Revolute`: this matrix is no rotation";
    assert!(stretched.starts_with(expected), "{stretched}");
}
