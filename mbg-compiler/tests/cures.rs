//! Mistakes of people who know another tool: each says what to type, and with that typed nothing is told any more.
#![allow(clippy::unwrap_used)]

mod told;

use told::{diagnose, told, typed};

/// A body that floats in space, with more beside it.
fn floating(free: &str, more: &str) -> String {
    format!(
        "model M {{ causality componentwise; input u; 1 ground[6]; 1 hull[6]; Sf fixed[6] {{ flow: 0.0 }} -> ground;
         free: Free {{ {free} }} (ground, hull); body: Body {{ mass: 1.0, inertia: diag(1.0, 1.0, 1.0) }} (hull);
         {more} }}"
    )
}

/// A mass and a resistor with a law, beside an input.
fn by_law(law: &str) -> String {
    format!(
        "model M {{ input u; input road[2]; 1 v {{ I b {{ inertia: 1.0 }} Se push {{ effort: {law} }} }} output y = u * road.x * road.y; }}"
    )
}

/// The first help of the first mistake.
fn first_help(text: &str) -> String {
    let diagnostics = diagnose(text);
    let helps = diagnostics.list().first().unwrap().helps.clone();
    helps.into_iter().next().unwrap_or_default()
}

/// The texts in backticks of the first help of the first mistake.
fn first_typed(text: &str) -> Vec<String> {
    let help = first_help(text);
    let typed = help.split('`').skip(1).step_by(2);
    typed.map(str::to_owned).collect()
}

#[test]
fn a_load_at_a_point_stands_at_an_offset() {
    let load = |frames: &str, load: &str| {
        let more = format!("{frames} load: Load {{ force: [0.0, 0.0, u] {load};");
        floating("", &more)
    };
    let typed = first_typed(&load("", ", at: [0.1, 0.0, 0.0] } (hull)"));
    assert_eq!(
        typed,
        [
            "1 load_at[6]; load_arm: Offset { by: [0.1, 0.0, 0.0] } (hull, load_at);",
            "load",
            "load_at"
        ]
    );
    assert_eq!(told(&load(&typed[0], "} (load_at)")), "");
    let planar = |frames: &str, load: &str| {
        format!(
            "model M {{ causality componentwise; input u; 1 hull[3]; body: PlanarBody {{ mass: 1.0, inertia: 1.0 }} (hull);
             {frames} load: PlanarLoad {{ axes: body, angle_at: 0.0, force: [0.0, u] {load}; }}"
        )
    };
    let typed = first_typed(&planar("", ", at: [0.1, 0.2] } (hull)"));
    assert_eq!(
        typed[0],
        "1 load_at[3]; load_arm: PlanarOffset { x: 0.1, y: 0.2 } (hull, load_at);"
    );
}

#[test]
fn components_are_told_that_fit_and_are_near() {
    let scene = |size: usize, joint: &str| {
        format!(
            "#[derivative] model M {{ 1 g[{size}]; 1 a[{size}]; Sf fixed[{size}] {{ flow: 0.0 }} -> g;
             h: {joint} (g, a); body: {}Body {{ mass: 1.0, inertia: 1.0 }} (a); }}",
            if size == 3 { "Planar" } else { "" }
        )
    };
    assert_eq!(first_typed(&scene(3, "PlanarHinge"))[0], "PlanarRevolute");
    assert_eq!(first_typed(&scene(3, "Hinge"))[0], "PlanarRevolute");
    assert_eq!(told(&scene(3, "PlanarRevolute")), "");
    assert_eq!(first_typed(&scene(6, "Hinge { axis: 2 }"))[0], "Revolute");
    assert_eq!(told(&scene(6, "Revolute { axis: 2 }")), "");
    for far in ["Governor { gain: 1.0 }", "Autopilot { gain: 1.0 }"] {
        insta::allow_duplicates! {
            insta::assert_snapshot!(
                first_help(&floating("", &format!("control: {far} (hull);"))),
                @"the page `library` of the documentation of `mbg_runtime` lists the components that there are"
            );
        }
    }
}

#[test]
fn an_element_that_is_called_as_a_component_is_written_as_an_element() {
    let scene = |part: &str| {
        format!(
            "model M {{ 1 a {{ I m {{ inertia: 1.0 }} }} 1 b {{ R r {{ resistance: 1.0 }} }} 1 c[3] {{ I n {{ inertia: 1.0 }} }} {part} }}"
        )
    };
    for (called, written) in [
        (
            "x: C { stiffness: 2.0 } (a);",
            "a -> C x { stiffness: 2.0 };",
        ),
        ("x: Se { effort: 2.0 } (a);", "Se x { effort: 2.0 } -> a;"),
        (
            "x: TF { flow: 2.0 } (a, b);",
            "a -> TF x { flow: 2.0 } -> b;",
        ),
        (
            "x: EJS { momentum: n.p } (c);",
            "c -> EJS x { momentum: n.p };",
        ),
    ] {
        let typed = first_typed(&scene(called));
        assert_eq!(typed.last().unwrap(), written);
        assert_eq!(
            told(&scene(written).replace(
                "1 b { R r { resistance: 1.0 } }",
                match called.contains("TF") {
                    true => "1 b { R r { resistance: 1.0 } }",
                    false => "",
                }
            )),
            ""
        );
    }
    assert_eq!(first_typed(&scene("x: C (a);"))[1], "a -> C x { … };");
}

#[test]
fn the_end_of_a_range_is_excluded() {
    let scene = |read: &str| format!("model M {{ 1 w[6] {{ I b {{ inertia: 1.0 }} }} {read} }}");
    for (short, written) in [
        ("output e[2] = w.f[1..2];", "w.f[1..3]"),
        ("output e[3] = w.f[3..5];", "w.f[3..6]"),
        ("integral e[2] = w.f[0..1];", "w.f[0..2]"),
    ] {
        let help = format!("the end of a range is excluded: write `{written}`");
        assert_eq!(first_help(&scene(short)), help);
        let (front, _) = short.split_once("w.f").unwrap();
        assert_eq!(told(&scene(&format!("{front}{written};"))), "");
    }
    let number = first_help(&scene("output e[2] = w.f[1];"));
    assert!(number.starts_with("write each component"), "{number}");
    let bond = "model M { 1 w[4] { I b { inertia: 1.0 } } Se s[2] { effort: 1.0 } -> w[1..2]; }";
    assert_eq!(
        first_help(bond),
        "the end of a range is excluded: write `w[1..3]`"
    );
    assert_eq!(told(&bond.replace("1..2", "1..3")), "");
}

#[test]
fn a_number_for_a_way_is_told_along_an_axis() {
    let arm = |by: &str| {
        floating(
            "",
            &format!("1 tip[6]; arm: Offset {{ {by} }} (hull, tip);"),
        )
    };
    assert_eq!(
        first_help(&arm("by: 1.5")),
        "write each component: `[1.5, 0.0, 0.0]` is a way along x"
    );
    assert_eq!(first_help(&arm("by: {1.5}")), first_help(&arm("by: 1.5")));
    assert_eq!(told(&arm("by: [1.5, 0.0, 0.0]")), "");
}

#[test]
fn a_function_of_a_module_is_written_alone() {
    for module in ["Math", "math", "np", "Modelica.Math"] {
        let text = by_law(&format!("{module}.sin(u)"));
        let diagnostics = diagnose(&text);
        let [report] = diagnostics.list() else {
            panic!("{}", told(&text))
        };
        assert_eq!(report.message, format!("`{module}` is not declared"));
        assert_eq!(
            report.helps,
            ["functions belong to no module: write `sin(u)`"]
        );
    }
    assert_eq!(
        first_typed(&by_law("Math.atan2(u, 1.0)")),
        ["atan2(u, 1.0)"]
    );
    assert_eq!(told(&by_law("sin(u)")), "");
    // A value has its own mistake.
    assert!(told(&by_law("u.sin(u)")).contains("`sin` takes 1 argument, found 2"));
}

#[test]
fn three_components_are_bonded_to_a_part_of_a_frame() {
    let push = |to: &str| {
        floating(
            "",
            &format!("Se push[3] {{ effort: [0.0, 0.0, u] }} -> {to};"),
        )
    };
    let help = "bond it to `hull[3..6]` for a force or a velocity, to `hull[0..3]` for a moment or an angular velocity";
    assert_eq!(first_help(&push("hull")), help);
    let short = first_help(&push("hull[0..2]"));
    assert_eq!(short, format!("the end of a range is excluded: {help}"));
    for part in ["hull[0..3]", "hull[3..6]"] {
        assert_eq!(told(&push(part)), "");
    }
    for size in ["", "[3]"] {
        let inside = floating("", "").replace(
            "1 hull[6]",
            &format!("1 hull[6] {{ Se push{size} {{ effort: [0.0, 0.0, u] }} }}"),
        );
        assert_eq!(first_help(&inside), help);
    }
}

#[test]
fn starts_of_a_rotation_are_angles_and_rates() {
    let quaternion = first_typed(&floating("initial: [1.0, 0.0, 0.0, 0.0]", ""));
    let angles = "initial: angles_of(matrix_of([1.0, 0.0, 0.0, 0.0]), 0, 1, 2)";
    assert_eq!(quaternion, ["initial", "[w, x, y, z]", angles]);
    assert_eq!(told(&floating(angles, "")), "");
    for name in [
        "initial_omega",
        "omega",
        "omega0",
        "initial_angular_velocity",
    ] {
        let rate = first_typed(&floating(&format!("{name}: [1.0, 0.0, 0.0]"), ""));
        assert_eq!(rate, ["initial_rate: [1.0, 0.0, 0.0]"]);
    }
    assert_eq!(told(&floating("initial_rate: [1.0, 0.0, 0.0]", "")), "");
}

#[test]
fn a_vector_at_a_junction_of_one_component_is_told_both_ways() {
    assert_eq!(typed(&by_law("road")), ["road.x", "1 v[2]"]);
    assert_eq!(told(&by_law("road.x")), "");
    assert_eq!(told(&by_law("road").replace("1 v {", "1 v[2] {")), "");
    let long = by_law("road").replace("road[2]", "road[4]");
    assert_eq!(first_typed(&long), ["road[0]"]);
}

#[test]
fn a_value_has_no_variables_of_an_element() {
    let text = "model M { param spring = 2.0; 1 v { I b { inertia: 1.0 } C stroke { stiffness: spring } }\noutput y = spring.q; }";
    insta::assert_snapshot!(told(text), @"
    2:19 `spring.q` is not declared [MBG0203]
      help: `spring` is a value, and `q` is read of an element: write the name of that before it
    ");
    assert_eq!(told(&text.replace("spring.q", "stroke.q")), "");
}

#[test]
fn an_instance_among_the_elements_of_a_junction_stands_outside() {
    for written in [
        "brake: Brake { capacity: 3.0 }",
        "Brake brake { capacity: 3.0 }",
    ] {
        let text = format!("model M {{ 1 v {{ I b {{ inertia: 1.0 }} {written} }} }}");
        let typed = typed(&text);
        assert_eq!(typed, ["brake: Brake { capacity: 3.0 } (v);"]);
        let text = format!(
            "model M {{ 1 v {{ I b {{ inertia: 1.0 }} }} {} }}",
            typed[0]
        );
        assert_eq!(told(&text), "");
    }
    // A kind that stands in the place of a component is an element still.
    let turned = "model M { 1 v { b: I { inertia: 1.0 } } }";
    assert!(first_help(turned).starts_with("the kind of an element stands before its name"));
}

#[test]
fn a_ground_that_is_left_free_is_held() {
    let scene = |causality: &str, source: &str| {
        format!(
            "model M {{ {causality} 1 ground[6]; 1 hull[6]; {source} free: Free (ground, hull);
             body: Body {{ mass: 1.0, inertia: diag(1.0, 1.0, 1.0) }} (hull); }}"
        )
    };
    for causality in ["", "causality componentwise;"] {
        let helps = diagnose(&scene(causality, "")).list()[0].helps.clone();
        let source = "Sf wall[6] { flow: 0.0 } -> ground;";
        assert_eq!(helps[0], format!("hold it, if it is at rest: `{source}`"));
        assert_eq!(
            helps[1],
            "or give it an inertia, such as a body, if it moves by itself"
        );
        assert_eq!(told(&scene("causality componentwise;", source)), "");
    }
}

#[test]
fn a_parameter_in_the_unit_of_another_domain_is_named_where_its_unit_shows() {
    let text = |unit: &str| {
        format!(
            "model M {{ param k{unit} = 2.0; 1 v {{ I b {{ inertia: 1.0 }} C spring {{ stiffness: k }} }}\noutput x: m = spring.q; }}"
        )
    };
    insta::assert_snapshot!(told(&text(": N*m/rad")), @"
    2:15 `x` is declared in `m`, and this is a pure number [MBG0501]
      help: declare `k`, which is in `N*m/rad`, in another unit or in none
      help: an angle is declared in `rad`
      help: a number with a decimal point carries any unit as a factor: `1.0 * …`; a whole number counts
    ");
    assert_eq!(told(&text(": N/m")), "");
    assert_eq!(told(&text("")), "");
    // What is read at the mistake itself is seen there, and of two causes none is the one.
    let direct = told(&text(": N/m").replace("= spring.q", "= k * spring.q"));
    assert!(!direct.contains("declare `k`"), "{direct}");
    let two = "model M { param k: N*m/rad = 2.0; param d: N*m*s/rad = 2.0; 1 v { I b { inertia: 1.0 } C spring { stiffness: k }
        R damper { resistance: d } } output x: m = spring.q; }";
    assert!(!told(two).contains("declare `k`"), "{}", told(two));
}

#[test]
fn what_a_brake_or_a_clutch_is_given_lies_between_nothing_and_all() {
    let scene = |engagement: &str| {
        format!(
            "model M {{ input u; param e: 1 = 0.5; 1 a {{ I m {{ inertia: 1.0 }} }} 1 b {{ I n {{ inertia: 1.0 }} }}
             clutch: Clutch {{ capacity: 3.0,\nengagement: {engagement} }} (a, b); output y = e * u; }}"
        )
    };
    insta::assert_snapshot!(told(&scene("2")), @"
    3:13 `engagement` does not fit in `Clutch`: `engagement <= 1` is asserted of `clutch.plates`, and these are 2.0 and 1.0 [MBG0213]
      `engagement`: How much of the capacity acts, from 0 for an open clutch to 1: a number, or a signal such as an input
    ");
    assert!(told(&scene("-0.1")).contains("`0 <= engagement` is asserted"));
    for within in [
        "0",
        "0.5",
        "1",
        "u",
        "2 * u",
        "e",
        "if t < 1.0 { 0 } else { 1 }",
    ] {
        assert_eq!(told(&scene(within)), "", "{within}");
    }
    let brake = scene("0")
        .replace("Clutch", "Brake")
        .replace("(a, b)", "(a)");
    assert_eq!(told(&brake), "");
    assert!(told(&brake.replace("engagement: 0", "engagement: 1.5")).contains("`engagement <= 1`"));
}

/// A storage with a wrong unit says what efforts and flows are, which all that is right contradicts.
#[test]
fn the_one_value_in_another_unit_is_told_and_not_what_contradicts_it() {
    let tank = |unit: &str, oil: &str| {
        format!(
            "model M {{ param given: {unit} = 1e5; input supply: m^3/s;
             0 chamber {{ C oil {{ {oil} }} Sf pump {{ flow: supply }} }} 0 sump {{ Se air {{ effort: 0.0 }} }}
             out: Orifice {{ area: 1e-6 }} (chamber, sump); output p: Pa = chamber.e; }}"
        )
    };
    insta::assert_snapshot!(told(&tank("Pa", "stiffness: given")), @"
    2:45 `stiffness` of `oil` must be `Pa/m^3` here, and this is `Pa` [MBG0501]
      the effort is `Pa` and the flow `m^3/s` there
    ");
    assert_eq!(told(&tank("Pa/m^3", "stiffness: given")), "");
    let initial = "stiffness: 1e13, initial: given";
    insta::assert_snapshot!(told(&tank("Pa", initial)), @"
    2:60 `initial` of `oil` must be `m^3` here, and this is `Pa` [MBG0501]
      the effort is `Pa` and the flow `m^3/s` there
      help: write `initial_effort: given`
    ");
    let by_effort = initial.replace("initial", "initial_effort");
    assert_eq!(told(&tank("Pa", &by_effort)), "");
    insta::assert_snapshot!(told(&tank("m^2", "compliance: given")), @"
    2:46 `compliance` of `oil` must be `m^3/Pa` here, and this is `m^2` [MBG0501]
      the effort is `Pa` and the flow `m^3/s` there
    ");
    assert_eq!(told(&tank("m^3/Pa", "compliance: given")), "");
    let rod = |initial: &str| {
        format!(
            "model M {{ param start: N = 1.0; input force: N; 1 rod {{ I m {{ inertia: 2.0 }}
             C spring {{ stiffness: 1e3, {initial} }} Se push {{ effort: force }} }} }}"
        )
    };
    insta::assert_snapshot!(told(&rod("initial: start")), @"
    2:50 `initial` of `spring` must be `m` here, and this is `N` [MBG0501]
      the effort is `N` and the flow `m/s` there
      help: write `initial_effort: start`
    ");
    assert_eq!(told(&rod("initial_effort: start")), "");
}

/// Inside of a component nothing can be changed, and bonds join what they should.
#[test]
fn an_argument_in_another_unit_is_told_where_it_is_given() {
    let shafts = |unit: &str, call: &str| {
        format!(
            "model M {{ param k: {unit} = 3.0; param j: kg*m^2 = 1.0; input torque: N*m;
             1 a {{ I ja {{ inertia: j }} Se drive {{ effort: torque }} }} 1 b {{ I jb {{ inertia: j }} }}
             {call} output w: rad/s = b.f; }}
             component Coupling(port 1 a, port 1 b) {{ param stiffness; param damping;
             1 both {{ C spring {{ stiffness: stiffness }} R damper {{ resistance: damping }} }} 0 shaft; a -> shaft -> b; shaft -> both; }}"
        )
    };
    let elastic = "shaft: ElasticShaft { stiffness: k } (a, b);";
    insta::assert_snapshot!(told(&shafts("N/m", elastic)), @"
    3:47 `stiffness` of `shaft` must be `N*m` here, and this is `N/m` [MBG0501]
      the effort is `N*m` and the flow `1/s` there
    ");
    assert_eq!(told(&shafts("N*m", elastic)), "");
    assert_eq!(told(&shafts("N*m/rad", elastic)), "");
    let own = "shaft: Coupling { stiffness: k, damping: 1.0 } (a, b);";
    insta::assert_snapshot!(told(&shafts("N/m", own)), @"
    5:124 `shaft.shaft -> shaft.both` joins efforts: `N*m` before it, `N` after it [MBG0501]
      help: a transformer or a gyrator goes between two domains: `a -> TF gear { flow: ratio } -> b;`
      help: or the bond is right, and `stiffness` of `shaft` must be `N*m` there and is `N/m`
    ");
    assert_eq!(told(&shafts("N*m", own)), "");
    // Of two arguments of one value it is not known which one a law reads.
    let twice = "shaft: Coupling { stiffness: k, damping: k } (a, b);";
    insta::assert_snapshot!(told(&shafts("N*m", twice)), @"
    5:80 `resistance` of `shaft.damper` must be `N*m*s` here, and this is `N*m` [MBG0501]
      the effort is `N*m` and the flow `1/s` there
    ");
}

/// Far behind the law that is wrong, and one of many that a loop repeats.
#[test]
fn a_law_in_another_unit_is_told_and_not_bonds_beside_it() {
    let row = |unit: &str| {
        format!(
            "model M {{ param k: {unit} = 1.0; param m: kg = 1.0; input force: N; Se push {{ effort: force }} -> cars[0].a;
             cars: for k in 0..4 {{ 1 a {{ I mass {{ inertia: m }} }} }}
             links: for n in 0..3 {{ 0 z {{ C spring {{ stiffness: k }} }} cars[n].a -> z -> cars[n + 1].a; }}
             output v: m/s = cars[3].a.f; }}"
        )
    };
    insta::assert_snapshot!(told(&row("N*m/rad")), @"
    3:65 `stiffness` of `links[0].spring` must be `N/m` here, and this is `N*m` [MBG0501]
      the effort is `N` and the flow `m/s` there
    ");
    assert_eq!(told(&row("N/m")), "");
    let motor = |unit: &str| {
        format!(
            "model M {{ param k: N*m/A = 0.1; param r: ohm = 1.0; param j: {unit} = 1.0; input v: V;
             1 wire {{ Se s {{ effort: v }} R w {{ resistance: r }} I l {{ inertia: 0.01 }} }} wire -> GY motor {{ effort: k }} -> shaft;
             1 shaft {{ I rotor {{ inertia: j }} }} output w: rad/s = shaft.f; }}"
        )
    };
    insta::assert_snapshot!(told(&motor("kg")), @"
    3:43 `inertia` of `rotor` must be `kg*m^2` here, and this is `kg` [MBG0501]
      the effort is `N*m` and the flow `1/s` there
    ");
    assert_eq!(told(&motor("kg*m^2")), "");
    // Which of two is wrong cannot be known: a bond that joins two domains is told as before.
    let joined = "model M { param m: kg = 1.0; param l: H = 1.0; 0 n { R r { resistance: 1.0 } }
        1 a { I mass { inertia: m } } 1 b { I coil { inertia: l } } a -> n -> b; }";
    assert!(told(joined).contains("joins efforts"), "{}", told(joined));
}

/// A hinged flap beside a shaft, with a stop at the rate of the flap.
fn stopped(given: &str, joint: &str) -> String {
    format!(
        "#[derivative] model M {{ 1 ground[6]; 1 rod[6]; 1 wheel[6]; Sf wall[6] {{ flow: 0.0 }} -> ground;
         flap: Revolute {{ axis: 1 }} (ground, rod); plate: Body {{ mass: 1.0, inertia: 1.0 }} (rod);
         shaft: Revolute {{ axis: 1 }} (ground, wheel); disc: Body {{ mass: 1.0, inertia: 1.0 }} (wheel);
         1 slide {{ I sledge {{ inertia: 1.0 }} }}
         stop: Stop {{ {given}, lower: -0.2, upper: 0.2, stiffness: 1e4 }} ({joint}); }}"
    )
}

#[test]
fn a_stop_is_given_what_changes_as_its_junction_flows() {
    insta::assert_snapshot!(told(&stopped("displacement: 0.3", "flap.rate")), @"
    5:10 the displacement of `stop.lower_spring` does not change as `stop.lower_spring` flows [MBG0309]
      it has another rate than the flow into `stop.lower_spring`
      help: write `displacement: flap.angle`, which changes as `flap.rate` flows
    ");
    for given in [
        "displacement: 0.3",
        "displacement: shaft.angle",
        "displacement: -flap.angle",
    ] {
        let typed = typed(&stopped(given, "flap.rate"));
        assert_eq!(typed, ["displacement: flap.angle", "flap.rate"]);
        assert_eq!(told(&stopped(&typed[0], "flap.rate")), "");
    }
    // Where nothing changes so there is an integral of it.
    let typed = typed(&stopped("displacement: 0.1", "slide"));
    assert_eq!(
        typed,
        ["integral slide_way = slide.f;", "displacement: slide_way"]
    );
    let mended = stopped(&typed[1], "slide");
    assert_eq!(
        told(&mended.replace("stop:", &format!("{} stop:", typed[0]))),
        ""
    );
}

#[test]
fn values_of_a_choice_are_told_with_their_braces() {
    insta::assert_snapshot!(told(&by_law("if u > 0.0 5.0 else 0.0")), @"
    1:91 the values of a choice stand in braces [MBG0101]
      help: write `if u > 0.0 { 5.0 } else { 0.0 }`
    ");
    for (slip, written) in [
        ("if u > 0.0 5.0 else 0.0", "if u > 0.0 { 5.0 } else { 0.0 }"),
        ("if (u > 0.0) 5.0 else u", "if (u > 0.0) { 5.0 } else { u }"),
        (
            "if (u > 0.0) -5.0 else u",
            "if (u > 0.0) { -5.0 } else { u }",
        ),
        (
            "if (u > 0.0) (5.0) else (u)",
            "if (u > 0.0) { (5.0) } else { (u) }",
        ),
        ("if u > 0.0 { 5.0 } else u", "if u > 0.0 { 5.0 } else { u }"),
        (
            "if u > t { 5.0 * t } else u",
            "if u > t { 5.0 * t } else { u }",
        ),
        (
            "if u > t 5.0 * t else { u }",
            "if u > t { 5.0 * t } else { u }",
        ),
        ("if u > t sin(t) else u", "if u > t { sin(t) } else { u }"),
        (
            "if u > t 5.0 * u else if u < 2.0 3.0 else u",
            "if u > t { 5.0 * u } else if u < 2.0 { 3.0 } else { u }",
        ),
    ] {
        assert_eq!(typed(&by_law(slip)), [written]);
        assert_eq!(told(&by_law(written)), "");
    }
    let nested = by_law("2.0 * (if u > 0.0 5.0 else u)");
    assert_eq!(typed(&nested), ["if u > 0.0 { 5.0 } else { u }"]);
    // The other value is the user's to say.
    assert_eq!(
        typed(&by_law("if u > 0.0 5.0")),
        ["if u > 0.0 { 5.0 } else { … }"]
    );
    // Values side by side inside of braces lack an operator still.
    let joined = told(&by_law("if u > 0.0 { 5.0 t } else { u }"));
    assert!(
        joined.contains("expected an operator between `5.0` and `t`"),
        "{joined}"
    );
}

#[test]
fn numbers_of_a_loop_are_compared_with_whole_ones() {
    let rows = |condition: &str| {
        format!(
            "model M {{ rows: for k in 0..3 {{ 1 v {{ I b {{ inertia: 1.0 }} R air {{ effort: if {condition} {{ 2.0 * f }} else {{ f }} }} }} }} }}"
        )
    };
    insta::assert_snapshot!(told(&rows("k == 0.0")), @"
    1:81 `k` is a whole number here, and `0.0` is none [MBG0213]
      help: write `k == 0`
    ");
    for (slip, whole, before, behind) in [
        ("k == 0.0 || k == 2", "k == 0", "", " || k == 2"),
        ("k == 0 || k == 2.0", "k == 2", "k == 0 || ", ""),
        ("2.0 != k", "2 != k", "", ""),
        ("k + 1 == 2.", "k + 1 == 2", "", ""),
    ] {
        assert_eq!(typed(&rows(slip)), [whole]);
        assert_eq!(told(&rows(&format!("{before}{whole}{behind}"))), "");
    }
    // Of a value that is no whole number, or between two of them, there is none.
    assert!(!told(&rows("k == 0.5")).contains("write `k"));
    let switch = told(&by_law("if u == 0.0 { 1.0 } else { 2.0 }"));
    assert!(
        switch.contains("of a value that is 0 or 1 write `u < 0.5`"),
        "{switch}"
    );
}

/// What a component makes of a way of no length is told of none of its values, nor of those of another one.
#[test]
fn a_line_from_a_frame_to_itself_is_one_mistake() {
    for by in ["[0.1, 0.0, 0.0]", "[0.1, 0.0, way]"] {
        for line in ["force: 2.0", "stiffness: 2.0, rest: 0.1"] {
            let scene = |ends: &str| {
                let more = format!(
                    "1 tip[6]; arm: Offset {{ by: {by} }} (hull, tip); line: LineForce {{ {line} }} ({ends});"
                );
                floating("", &more).replace("input u;", "param way = 0.1;")
            };
            insta::allow_duplicates! {
                insta::assert_snapshot!(told(&scene("tip, tip")).split_once(' ').unwrap().1, @"
                `line` leads from `tip` to itself [MBG0209]
                  help: give it two different junctions
                ");
            }
            assert_eq!(told(&scene("ground, tip")), "");
        }
    }
}

/// Two links on hinges, with what the second carries.
fn links(second: &str, more: &str) -> String {
    format!(
        "#[derivative] model M {{ causality componentwise; gravity [0.0, 0.0, -9.81]; 1 ground[6]; 1 arm[6]; 1 rod[6]; 1 tip[6];
         Sf fixed[6] {{ flow: 0.0 }} -> ground; a: Revolute {{ axis: 2 }} (ground, arm); upper: Body {{ mass: 1.0, inertia: 1.0 }} (arm);
         {second} o: Offset {{ by: [0.0, 0.0, -0.4] }} (rod, tip);
{more} output y = a.angle; }}"
    )
}

#[test]
fn what_a_ring_holds_twice_is_told_at_the_joint_that_closes_it() {
    let hinge = "b: Revolute { axis: 2, offset: [0.5, 0.0, 0.0] } (arm, rod); bob: Body { mass: 0.3, inertia: 1.0 } (tip);";
    insta::assert_snapshot!(told(&links(hinge, "c: Revolute { axis: 0 } (ground, rod);")), @"
    3:10 source `fixed` imposes flow that is imposed already [MBG0302]
      `c` and `b` lead to `rod` from two sides, and hold a motion that the ring holds already
      help: put a `Cut` in the place of a joint of the ring that `c` and `b` close
      help: or close it by `close a -> b by multipliers;`
    ");
    let closed =
        links(hinge, "c: Cut (ground, rod);").replace("offset: [0.5, 0.0, 0.0]", "initial: 0.0");
    assert_eq!(told(&closed), "");
}

#[test]
fn a_joint_that_can_move_without_inertia_is_told() {
    let ball = "b: Spherical { offset: [0.5, 0.0, 0.0] } (arm, rod);";
    insta::assert_snapshot!(told(&links(ball, "bob: PointMass { mass: 0.3 } (tip);")), @"
    3:10 the efforts between dependent storages are undetermined: at `upper.spin`, `upper.body`, `bob.body` [MBG0401]
      what `b` leads to can move without moving any inertia
      help: give the frame behind `b` a body with an inertia: a `PointMass` has none about the lines through it
    ");
    assert_eq!(
        told(&links(ball, "bob: Body { mass: 0.3, inertia: 0.1 } (tip);")),
        ""
    );
    let hung = |load: &str| {
        format!(
            "model M {{ gravity [0.0, 0.0, -9.81]; 1 ground[6]; 1 hook[6]; Sf fixed[6] {{ flow: 0.0 }} -> ground;
             free: Free {{ initial_position: [0.0, 0.0, -5.0] }} (ground, hook); load: {load} (hook);
             rope: LineForce {{ kind: rope, stiffness: 1e5, rest: 5.0 }} (ground, hook); output y = rope.tension; }}"
        )
    };
    insta::assert_snapshot!(told(&hung("PointMass { mass: 10.0 }")), @"
    2:14 resistor `free.rotation.gimbal.damper` would have to give its flow, but its resistance is zero [MBG0307]
      what `free` leads to can move without moving any inertia
      help: give the frame behind `free` a body with an inertia: a `PointMass` has none about the lines through it
    ");
    assert_eq!(told(&hung("Body { mass: 10.0, inertia: 1.0 }")), "");
}

/// The help that holds a text, of the first mistake.
fn help_with(text: &str, part: &str) -> String {
    let diagnostics = diagnose(text);
    let helps = diagnostics.list().first().unwrap().helps.clone();
    let mut helps = helps.into_iter().filter(|help| help.contains(part));
    helps.next().unwrap_or_default()
}

#[test]
fn an_inertia_that_follows_from_another_is_put_behind_a_compliance() {
    let text = "model M { 1 left { I j { inertia: 1.0 } } 1 right { I k { inertia: 1.0 } } left -> TF g { flow: 2.0 } -> right; }";
    let help = help_with(text, "compliance");
    let written = help.split('`').skip(1).step_by(2).last().unwrap();
    let written = written.replacen('…', "inertia: 1.0", 1).replace('…', "1.0");
    assert_eq!(
        written,
        "1 k_own { I k { inertia: 1.0 } } 0 between { C spring { stiffness: 1.0 } } right -> between; between -> k_own;"
    );
    let moved = text.replace(
        "{ I k { inertia: 1.0 } } left",
        &format!("; {written} left"),
    );
    assert_eq!(told(&moved), "");
}

/// Three capacitors in a triangle have two states.
#[test]
fn what_follows_from_several_storages_is_not_merged() {
    let circuit = |third: &str| {
        format!(
            "model M {{ 0 x; 0 y; 0 g; Se e {{ effort: 0.0 }} -> g; r: Resistor {{ resistance: 10.0 }} (x, y);
             c1: Capacitor {{ capacitance: 1e-9 }} (x, g); c2: Capacitor {{ capacitance: 1e-9 }} (y, g); {third} }}"
        )
    };
    let capacitor = |end: &str| format!("c3: Capacitor {{ capacitance: 1e-9 }} (x, {end});");
    let text = circuit(&capacitor("y"));
    assert_eq!(help_with(&text, "merge"), "");
    assert_eq!(
        help_with(&text, "series"),
        "or put a resistor in series with one of `c3`, `c1`, `c2`"
    );
    let series = format!(
        "0 z; s: Resistor {{ resistance: 1.0 }} (z, y); {}",
        capacitor("z")
    );
    assert_eq!(told(&circuit(&series)), "");
    let parallel = circuit(&capacitor("g"));
    assert_eq!(
        help_with(&parallel, "merge"),
        "or merge the storages into one: `c3: …`"
    );
}

#[test]
fn components_are_counted_from_zero() {
    let scene = |read: &str| {
        format!("model M {{ 1 w[3] {{ I b {{ inertia: 1.0 }} }} let x = [1.0, 2.0, 3.0]; {read} }}")
    };
    for (read, last) in [
        ("output y = x[3];", "[2]"),
        ("output y = w.f[3];", "[2]"),
        ("output y[3] = x[1..4];", "[2]"),
        ("Se s { effort: 1.0 } -> w[3];", "w[2]"),
    ] {
        let help = format!("they are counted from 0: the last is `{last}`");
        assert_eq!(first_help(&scene(read)), help, "{read}");
    }
    assert_eq!(
        first_help(&scene("output y[2] = x[0..=1];")),
        "write `[0..2]`"
    );
    assert_eq!(
        told(&scene("output y[2] = x[0..2]; output z = w.f[2];")),
        ""
    );
    // Another number is no slip of counting.
    assert_eq!(first_help(&scene("output y = x[7];")), "");
}

#[test]
fn vectors_and_matrices_are_told_apart() {
    let scene = |law: &str, effort: &str| {
        format!("model M {{ 1 w[3] {{ I b {{ inertia: {law} }} Se s {{ effort: {effort} }} }} }}")
    };
    assert_eq!(
        first_help(&scene("1.0", "diag(1.0, 2.0, 3.0)")),
        "`diag` is a matrix: write `[1.0, 2.0, 3.0]`"
    );
    assert_eq!(
        first_help(&scene(
            "[1.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 3.0]",
            "0.0"
        )),
        "a matrix is written by rows: `[[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]]`"
    );
    let by_rows = "[[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]]";
    assert_eq!(told(&scene(by_rows, "[1.0, 2.0, 3.0]")), "");
    let load = |force: &str| floating("", &format!("push: Load {{ force: {force} }} (hull);"));
    assert_eq!(
        first_typed(&load("diag(0.0, 0.0, u)")).pop().unwrap(),
        "[0.0, 0.0, u]"
    );
    assert_eq!(told(&load("[0.0, 0.0, u]")), "");
    let planar =
        "model M { 1 a[3]; b: PlanarBody { mass: 1.0, inertia: diag(1.0, 1.0, 1.0) } (a); }";
    assert!(
        told(planar).contains("expected a number, found a 3×3 matrix"),
        "{}",
        told(planar)
    );
}

#[test]
fn equations_of_rates_and_starts_are_integrals() {
    let scene = |text: &str| {
        format!("model M {{ input u; 1 v {{ I m {{ inertia: 1.0 }} }} {text} output y = x + u; }}")
    };
    for equation in [
        "dx/dt = v.f - u;",
        "d(x)/dt = v.f - u;",
        "der(x) = v.f - u;",
        "ddt(x) = v.f - u;",
        "x_dot = v.f - u;",
        "der x = v.f - u;",
    ] {
        let written = first_typed(&scene(equation));
        assert_eq!(written, ["integral x = v.f - u;"], "{equation}");
        assert_eq!(told(&scene(&written[0])), "");
    }
    for start in ["init x = 1.0;", "initial x = 1.0;", "start x = 1.0;"] {
        let written = first_typed(&scene(start)).pop().unwrap();
        assert_eq!(written, "integral x = …, initial: 1.0;");
        assert_eq!(told(&scene(&written.replace('…', "v.f"))), "");
    }
    assert_eq!(
        first_typed(&scene("integral x = v.f initial 0.5;")),
        [", initial: …"]
    );
    assert_eq!(
        first_help(&scene("equation der(x) = v.f;")),
        "statements stand side by side, in no sections: leave `equation` out"
    );
    assert_eq!(
        first_help(&scene("m.initial = 1.0;")),
        "what is given to an element or an instance stands in its braces: `{ …, initial: … }`"
    );
    assert!(first_help(&scene("reinit(v, 1.0);")).starts_with("events are found"));
    assert_eq!(
        first_typed(&scene("output r[2, 2] = u;")).pop().unwrap(),
        "output r_0[2] = …; output r_1[2] = …;"
    );
}
