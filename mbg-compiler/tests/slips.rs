//! What is written as other languages and tools would have it, and what is to be typed instead.
#![allow(clippy::unwrap_used)]

mod told;

use told::{diagnose, told, typed};

/// A hinged arm and a statement.
fn arm(statement: &str) -> String {
    format!(
        "#[derivative] model M {{ causality componentwise; 1 ground[6]; 1 arm[6]; Sf still[6] {{ flow: 0.0 }} -> ground;
         body: Body {{ mass: 1.0, inertia: 1.0 }} (arm);\n{statement} }}"
    )
}

#[test]
fn an_instance_in_another_order_is_told_as_it_is_written() {
    let slips = [
        "hinge: Revolute (ground, arm) { axis: 0 };",
        "Revolute hinge { axis: 0 } (ground, arm);",
        "hinge = Revolute { axis: 0 } (ground, arm);",
        "ground -> Revolute hinge { axis: 0 } -> arm;",
    ];
    for slip in slips {
        let written = "hinge: Revolute { axis: 0 } (ground, arm);";
        assert_eq!(typed(&arm(slip)), [written]);
        assert_eq!(told(&arm(written)), "");
    }
    let nameless = "name: Revolute { axis: 0 } (ground, arm);";
    for slip in [
        "Revolute (ground, arm) { axis: 0 };",
        "Revolute { axis: 0 } (ground, arm);",
    ] {
        assert_eq!(typed(&arm(slip)), [nameless]);
    }
    assert_eq!(
        typed(&arm(
            "fixed: Fixed (ground, arm);\nball = Cut (ground, arm);"
        )),
        ["ball: Cut (ground, arm);"]
    );
}

#[test]
fn a_keyword_as_a_name_is_told_as_that() {
    for keyword in ["crate", "type", "for", "let", "input", "gravity", "if"] {
        let hinge = |name: &str| arm(&format!("{name}: Revolute {{ axis: 0 }} (ground, arm);"));
        let report = diagnose(&hinge(keyword)).list()[0].clone();
        let message = format!("expected the name of an instance, found the keyword `{keyword}`");
        assert_eq!((report.message, report.span.start().line), (message, 3));
        let name = typed(&hinge(keyword)).remove(0);
        assert_eq!(told(&hinge(&name)), "");
    }
    insta::assert_snapshot!(told("model M { 1 a { I i { inertia: 1.0 } }\nloop: for k in 0..2 { a -> R r { resistance: 1.0 }; } }"), @"
    2:1 expected the label of a loop, found the keyword `loop` [MBG0101]
      help: write another name, such as `loop_`
    ");
    for keyword in ["in", "as", "gen", "use"] {
        let text = |name: &str| format!("model M {{ 1 {name} {{ I i {{ inertia: 1.0 }} }} }}");
        let name = typed(&text(keyword)).remove(0);
        assert_eq!(name, format!("{keyword}_"));
        assert_eq!(told(&text(&name)), "");
    }
    // What is read of it is not told besides.
    let read = "crate: Revolute { axis: 0 } (ground, arm); output angle = crate.angle;";
    assert_eq!(typed(&arm(read)), ["crate_"]);
}

#[test]
fn an_element_bonded_without_its_law_is_told_whole() {
    let text = |element: &str| {
        format!("model M {{ 1 arm[3] {{ I body {{ inertia: 2.0 }} }} {element} -> arm; }}")
    };
    let help = typed(&text("Se push[3]")).remove(0);
    assert_eq!(help, "Se push[3] { effort: … }");
    assert_eq!(told(&text(&help.replace('…', "1.0"))), "");
}

#[test]
fn entries_of_matrices_are_read_by_rows() {
    let text = |value: &str| {
        format!(
            "model M {{ 1 turning[3] {{ I body {{ inertia: diag(1.0, 2.0, 3.0), gyroscopic }} }}
             attitude q = quaternion(turning.f); let m = matrix_of(q);\noutput y = {value}; }}"
        )
    };
    assert_eq!(
        told(&text("m[1][2] + matrix_of(q)[0][1] + (m * m)[2].z")),
        ""
    );
    assert_eq!(typed(&text("2.0 * m[1, 2]")), ["[1][2]"]);
    insta::assert_snapshot!(told(&text("m[1, 2]")), @"
    3:15 expected `]`, found `,` [MBG0101]
      help: an entry of a matrix is taken from a row: `[1][2]`
    ");
    insta::assert_snapshot!(told(&text("m[3][0]")), @"
    3:14 row 3 of a 3×3 matrix does not exist [MBG0204]
      help: they are counted from 0: the last is `[2]`
    ");
    insta::assert_snapshot!(told(&text("m[0]")), @"
    3:8 `y` has dimension 1, found a vector of 3 [MBG0204]
      help: write `output y[3] = m[0];`
    ");
    let turned = |value: &str| text(&format!("({value}).x"));
    let help = typed(&turned("q * [1.0, 0.0, 0.0]")).remove(0);
    assert_eq!(help, "matrix_of(q) * [1.0, 0.0, 0.0]");
    assert_eq!(told(&turned(&help)), "");
}

#[test]
fn a_number_for_a_vector_is_told_by_component() {
    let joint = |damping: &str| {
        arm(&format!(
            "cross: Universal {{ damping: {damping} }} (ground, arm);"
        ))
    };
    let help = typed(&joint("0.05")).remove(0);
    assert_eq!(help, "[0.05, 0.05]");
    assert_eq!(told(&joint(&help)), "");
    insta::assert_snapshot!(told("model M { 1 a[2] { I i { inertia: 1.0 } }\nintegral x[2] = a.f, initial: 1.0; output y[2] = x; }"), @"
    2:10 `x` has dimension 2, found a number [MBG0204]
      help: write each component, such as `[1.0, 1.0]`
    ");
}

#[test]
fn a_frame_at_a_shaft_is_told_the_rate_of_its_joint() {
    let gear = |a: &str, b: &str| {
        arm(&format!(
            "one: Revolute {{ axis: 0 }} (ground, arm); 1 wheel {{ I disc {{ inertia: 1.0 }} }}
             gear: Gear {{ radius_a: 0.1, radius_b: 0.2 }} ({a}, {b});"
        ))
    };
    assert_eq!(typed(&gear("arm", "wheel")), ["one.rate"]);
    assert_eq!(told(&gear("one.rate", "wheel")), "");
    assert_eq!(typed(&gear("wheel", "ground")), ["ground[0]", "hinge.rate"]);
}

#[test]
fn quotients_that_are_not_whole_are_told_with_their_whole_part() {
    let text = |bound: &str| {
        format!(
            "model M {{ 1 a {{ I i {{ inertia: 1.0 }} }} let n = 6;\nfor k in 0..{bound} {{ a -> R r {{ resistance: 1.0 }}; }} }}"
        )
    };
    insta::assert_snapshot!(told(&text("(n + 1) / 2")), @"
    2:13 expected a whole number, found `(n + 1) / 2`, which is 3.5 [MBG0217]
      help: its whole part is `((n + 1) - (n + 1) % 2) / 2`
    ");
    for (bound, mended) in [
        ("(n + 1) / 2", "((n + 1) - (n + 1) % 2) / 2"),
        ("n + 1 - (n + 1) / 2", "((n + 1) - (n + 1) % 2) / 2"),
        ("mod(n + 1, 4)", "(n + 1) % 4"),
        ("floor(n / 4)", "(n - n % 4) / 4"),
    ] {
        let help = typed(&text(bound)).remove(0);
        assert_eq!((help.as_str(), told(&text(&help))), (mended, String::new()));
    }
    insta::assert_snapshot!(told("model M {\n1 a[7/2] { I i { inertia: 1.0 } } }"), @"
    2:6 expected `]` after the dimension, found `/` [MBG0103]
      help: a dimension is a number as it stands, such as `[3]`; `for k in 0..n { … }` repeats a computed number of times
    ");
}

#[test]
fn a_junction_without_bonds_can_be_removed() {
    insta::assert_snapshot!(told("model M { 1 a { I i { inertia: 1.0 } }\n1 b; 1 c[2]; c.x -> a; }"), @"
    2:3 junction `b` has no bond [MBG0208]
      help: write an arrow to it: `b -> …;`
      help: or remove it
    2:8 junction `c[1]` has no bond [MBG0208]
      help: write an arrow to it: `c[1] -> …;`
    ");
}

/// A junction that is not there makes no mistake of gravity, which a body on it cannot ask for.
#[test]
fn a_body_on_a_junction_that_is_not_there_is_told_alone() {
    let model = "model M { causality componentwise; gravity [0.0, -9.81]; 1 ground[3]; Sf wall[3] { flow: 0.0 } -> ground;
        ends: for k in 0..2 { 1 end[3]; } h: PlanarRevolute { initial: 0.3 } (ground, ends[0].end);
        b: PlanarBody { mass: 1.0, inertia: 0.1 } (ends[2].end); output angle: rad = h.angle; }";
    insta::assert_snapshot!(told(model), @"3:52 `ends` runs over 0..2, there is no `ends[2]` [MBG0203]");
}

#[test]
fn a_junction_without_any_bond_is_told_as_a_whole() {
    let model =
        |bonds: &str| format!("model M {{ 1 v[2]; 1 a {{ I m {{ inertia: 1.0 }} }} {bonds} }}");
    insta::assert_snapshot!(told(&model("")), @"
    1:13 junction `v` has no bond [MBG0208]
      help: write an arrow to it: `v -> …;`
      help: or remove it
    ");
    insta::assert_snapshot!(told(&model("v.x -> a;")), @"
    1:13 junction `v[1]` has no bond [MBG0208]
      help: write an arrow to it: `v[1] -> …;`
    ");
}

#[test]
fn an_output_that_a_law_reads_is_told_with_its_value() {
    let text = |read: &str| {
        format!(
            "model M {{ input r: m; param gain: N/m = 2.0; 1 v {{ I m {{ inertia: 1.0 }} C k {{ stiffness: 4.0 }}\nSe s {{ effort: gain * (r - {read}) }} }}
             output x: m = k.q; output w[2] = [k.q, 2.0 * k.q]; }}"
        )
    };
    insta::assert_snapshot!(told(&text("x")), @"
    2:28 `x` is not declared [MBG0203]
      help: `x` is an output, which nothing in the model reads: declare its value besides, `let x: m = k.q;`, or write `k.q`
    ");
    for (read, place) in [("x", 2), ("w.x", 2), ("w[0]", 2), ("x", 1)] {
        let help = typed(&text(read));
        let [_, declared, value] = &help[..] else {
            panic!("{help:?}")
        };
        let read = if place == 1 { value } else { read };
        let besides = text(read).replace("output x", &format!("{declared} output x"));
        let followed = if place == 1 { text(read) } else { besides };
        assert_eq!(told(&followed), "");
    }
    // What reads its own name would be defined by itself.
    let own = text("k.q").replace("= k.q", "= x");
    assert_eq!(typed(&own), [""; 0]);
}

#[test]
fn a_product_of_two_vectors_is_told_as_a_number() {
    let text = |law: &str| {
        format!(
            "model M {{ param k[2] = [3.0, 1.0]; 1 v {{ I m {{ inertia: 1.0 }} C c {{ stiffness: 4.0 }} Se s {{ effort: {law} }} }} }}"
        )
    };
    let help = typed(&text("-k * [c.q, v.f]")).remove(0);
    assert_eq!(help, "transpose(-k) * [c.q, v.f]");
    assert_eq!(told(&text(&help)), "");
    assert_eq!(typed(&text("k * [c.q, v.f, 1.0]")), [""; 0]);
}

#[test]
fn functions_that_laws_lack_are_told_with_what_stands_for_them() {
    let text = |law: &str, besides: &str| {
        format!(
            "model M {{ input r; {besides} 1 v {{ I m {{ inertia: 1.0 }} C k {{ stiffness: 4.0 }}\nSe s {{ effort: r + {law} }} }} }}"
        )
    };
    let read = |law: &str| text(law, "");
    for name in ["saturate", "saturation", "sat", "limit"] {
        let help = typed(&read(&format!("{name}(2.0 * r, -1.0, 1.0)"))).remove(0);
        assert_eq!(help, "min(max(2.0 * r, -1.0), 1.0)");
        assert_eq!(told(&read(&help)), "");
    }
    for (law, choice) in [
        ("step(t - 1.0)", "(if t < 1.0 { 0.0 } else { 1.0 })"),
        ("step(t, 1.0)", "(if t < 1.0 { 0.0 } else { 1.0 })"),
        (
            "pwm(t, 0.5 * r, 1e-3)",
            "(if mod(t, 1e-3) < (0.5 * r) * 1e-3 { 1.0 } else { 0.0 })",
        ),
        (
            "2.0 * heaviside(2.0 * t + r)",
            "(if (2.0 * t + r) < 0.0 { 0.0 } else { 1.0 })",
        ),
    ] {
        let help = typed(&read(law)).remove(0);
        assert_eq!(help, choice);
        assert_eq!(told(&read(&help)), "");
    }
    for (law, rate) in [("der(k.q)", "k.f"), ("2.0 * ddt(m.p)", "m.e")] {
        let help = typed(&read(law)).remove(1);
        assert_eq!(help, rate);
        assert_eq!(told(&read(&format!("0.5 * {help}"))), "");
    }
    let [input, declared, rate] = &typed(&read("0.5 * der(r)"))[..] else {
        panic!("three texts")
    };
    assert_eq!(input, "r");
    let followed = read(&format!("0.5 * {rate}")).replace("input r;", declared);
    assert_eq!(told(&followed), "");
    let [late, declared, ..] = &typed(&read("delay(r, 0.1)"))[..] else {
        panic!("two texts")
    };
    assert_eq!(told(&text(late, declared)), "");
}

#[test]
fn matrices_are_declared_by_rows() {
    let text = |statement: &str| {
        format!(
            "model M {{ 1 v {{ I m {{ inertia: 1.0 }} C c {{ stiffness: 4.0 }} Se s {{ effort: (k * [c.q, v.f])[0] }} }}\n{statement} }}"
        )
    };
    let followed = |help: &str| {
        let values = help.replacen("= …", "= [1.0, 0.0]", 1);
        text(&values.replace("= …", "= [0.0, 1.0]"))
    };
    insta::assert_snapshot!(told(&text("param k[1][2]: N = [[3.0, 1.0]];")), @"
    2:11 expected one dimension of `k`, found `[` [MBG0101]
      help: `param` declares a number or a vector: write `param k_0[2] = …; let k = [[k_0[0], k_0[1]]];`
    ");
    let declared = "k_0[2] = …;WORD k_1[2] = …; let k = [[k_0[0], k_0[1]], [k_1[0], k_1[1]]];";
    for word in ["param", "integral"] {
        let help = typed(&text(&format!(
            "{word} k[2][2] = [[1.0, 0.0], [0.0, 1.0]];"
        )))
        .remove(1);
        let declared = declared.replace("WORD", &format!(" {word}"));
        assert_eq!(help, format!("{word} {declared}"));
        assert_eq!(told(&followed(&help)), "");
    }
    let help = typed(&text("input k[2][2];")).remove(1);
    assert_eq!(told(&followed(&help)), "");
    let help = typed(&text("let k[2][2] = [[1.0, 0.0], [0.0, 1.0]];")).remove(0);
    assert_eq!(
        told(&text(&help.replace("[[…], …]", "[[1.0, 0.0], [0.0, 1.0]]"))),
        ""
    );
    let output = "let k = diag(1.0, 2.0); output a[2][2] = k;";
    let help = typed(&text(output)).remove(1);
    assert_eq!(help, "output a_0[2] = …; output a_1[2] = …;");
    assert_eq!(
        told(&followed(&format!("let k = diag(1.0, 2.0); {help}"))),
        ""
    );
}

#[test]
fn coefficients_are_told_by_the_words_of_their_elements() {
    let text = |element: &str, law: &str| {
        format!(
            "model M {{ 1 v {{ I m {{ inertia: 1.0 }} Se s {{ effort: 0.0 }} }} 0 n {{ C c {{ compliance: 1.0 }} R r {{ resistance: 1.0 }} }}
             1 w {{ R d {{ resistance: 1.0 }} {element} x {{ {law} }} }} v -> n; n -> w; }}"
        )
    };
    for (element, word, law) in [
        ("C", "capacitance", "compliance"),
        ("C", "spring_constant", "stiffness"),
        ("C", "k", "stiffness"),
        ("I", "inductance", "inertia"),
        ("I", "mass", "inertia"),
        ("I", "moment", "inertia"),
        ("R", "damping", "resistance"),
        ("R", "r", "resistance"),
        ("Se", "voltage", "effort"),
        ("Se", "e", "effort"),
    ] {
        let help = typed(&text(element, &format!("{word}: 2.0 * 3.0"))).remove(0);
        assert_eq!(help, format!("{law}: 2.0 * 3.0"));
        assert_eq!(told(&text(element, &help)), "");
    }
}

#[test]
fn a_source_of_flow_is_told_by_its_letter() {
    let text = |law: &str| {
        format!(
            "model M {{ 0 n {{ C c {{ compliance: 1.0 }} R r {{ resistance: 1.0 }} Sf s {{ {law} }} }} }}"
        )
    };
    let help = typed(&text("f: 2.0")).remove(0);
    assert_eq!(help, "flow: 2.0");
    assert_eq!(told(&text(&help)), "");
}

#[test]
fn converters_are_told_what_their_number_multiplies() {
    let text = |element: &str, law: &str| {
        format!(
            "model M {{ param d = 2.0; 1 v {{ I m {{ inertia: 1.0 }} }} 1 w {{ R r {{ resistance: d }} }}
             v -> {element} x {{ {law} }} -> w; }}"
        )
    };
    for (element, slip, laws) in [
        ("TF", "ratio: d", &["flow: d", "flow: 1 / d"][..]),
        (
            "MTF",
            "n: 2.0 * d",
            &["flow: 2.0 * d", "flow: 1 / (2.0 * d)"],
        ),
        ("TF", "effort: d", &["flow: 1 / d"]),
        ("TF", "effort: 2.0 * d", &["flow: 1 / (2.0 * d)"]),
        ("GY", "r: d", &["effort: d"]),
        ("MGY", "ratio: d", &["effort: d"]),
        ("GY", "flow: d", &["effort: 1 / d"]),
    ] {
        let helps = typed(&text(element, slip));
        assert_eq!(helps[..laws.len()], *laws);
        for law in laws {
            assert_eq!(told(&text(element, law)), "");
        }
    }
    insta::assert_snapshot!(told(&text("TF", "ratio: 2.0")), @"
    2:26 `TF` does not know `ratio` [MBG0207]
      help: write `flow: 2.0`: the flow behind it is that times the flow before it; write `flow: 1 / 2.0` if the flow is divided by it
      help: its words are `flow`
    ");
    insta::assert_snapshot!(told(&text("TF", "effort: [[1.0, 0.0], [0.0, 2.0]]")), @"
    2:26 `TF` does not know `effort` [MBG0207]
      help: write `flow: transpose([[1.0, 0.0], [0.0, 2.0]])` with the bonds turned round: the flow behind it is that times the flow before it
      help: its words are `flow`
    ");
    insta::assert_snapshot!(told(&text("GY", "r: 2.0")), @"
    2:26 `GY` does not know `r` [MBG0207]
      help: write `effort: 2.0`: the effort behind it is that times the flow before it
      help: its words are `effort`
    ");
}

#[test]
fn a_parameter_is_told_by_the_end_of_its_name() {
    let hinge = |parameter: &str| {
        arm(&format!(
            "hinge: Revolute {{ axis: 1, blocked: compliant, {parameter}: 1.0 }} (ground, arm);"
        ))
    };
    let help = typed(&hinge("torsional_stiffness")).remove(0);
    assert_eq!(help, "blocked_torsional_stiffness");
    assert!(!told(&hinge(&help)).contains("no parameter"));
    // Nothing else is told of a value that was meant to be given so.
    let text = |parameter: &str| {
        format!(
            "component Shaft(port 1 a) {{ param left_stiffness; param right_stiffness; C l {{ stiffness: left_stiffness + right_stiffness }} -> a; }}
             model M {{ 1 v {{ I m {{ inertia: 1.0 }} }} shaft: Shaft {{ {parameter}: 2.0 }} (v); }}"
        )
    };
    assert_eq!(
        typed(&text("stiffness"))[..2],
        ["left_stiffness", "right_stiffness"]
    );
    // The end of a word is no word.
    assert_eq!(typed(&hinge("orsional_stiffness"))[0], "axis");
}

#[test]
fn elements_apart_from_their_junction_are_told_at_its_declaration() {
    let text = |declared: &str, apart: &str| {
        format!(
            "model M {{ 1 a {{ I m {{ inertia: 1.0 }} }} {declared} {apart} a -> TF gear {{ flow: 2.0 }} -> nut; }}"
        )
    };
    let apart = "nut { #[derivative] I body { inertia: 0.1 } R r { resistance: 2.0 } }";
    for declared in ["1 nut", "1 nut[1]"] {
        let help = typed(&text(&format!("{declared};"), apart)).remove(0);
        let elements = apart.trim_start_matches("nut");
        assert_eq!(help, format!("{declared}{elements}"));
        assert_eq!(told(&text(&help, "")), "");
    }
    let help = typed(&text("", apart)).remove(0);
    assert_eq!(told(&text(&help, "")), "");
    let help = typed(&text("1 nut;", "nut { resistance: 1.0 }"));
    assert_eq!(help, ["nut", "R name { resistance: 1.0 } -> nut;"]);
    assert_eq!(told(&text("1 nut;", &help[1])), "");
    let help = typed(&text("1 nut;", "nut { inertia: 1.0 }")).remove(1);
    assert_eq!(help, "I name { inertia: 1.0 } -> nut;");
}

#[test]
fn joints_are_told_by_their_names_in_the_library() {
    let joint = |name: &str| arm(&format!("joint: {name} (ground, arm);"));
    for (name, here) in [
        ("Floating", "Free"),
        ("Hinge", "Revolute"),
        ("Pin", "Revolute"),
        ("Slider", "Prismatic"),
        ("Ball", "Spherical"),
        ("Weld", "Fixed"),
    ] {
        let written = match here {
            "Revolute" | "Prismatic" => " { axis: 1 }",
            _ => "",
        };
        assert_eq!(typed(&joint(&format!("{name}{written}"))), [here]);
        let answers = told(&joint(&format!("{here}{written}")));
        assert!(!answers.contains("not declared"), "{answers}");
    }
}

#[test]
fn a_joint_in_the_place_of_a_junction_is_told_its_junctions() {
    let motor = |at: &str| {
        arm(&format!(
            "hinge: Revolute {{ axis: 1 }} (ground, arm);\nSe motor {{ effort: 1.0 }} -> {at};"
        ))
    };
    let help = typed(&motor("hinge"));
    assert_eq!(help[..2], ["hinge", "hinge.rate"]);
    assert_eq!(told(&motor(&help[1])), "");
}

#[test]
fn an_axis_is_told_by_its_number() {
    let hinge = |axis: &str| {
        arm(&format!(
            "hinge: Revolute {{ axis: {axis} }} (ground, arm);"
        ))
    };
    for (axis, number) in [
        ("x", "axis: 0"),
        ("y", "axis: 1"),
        ("z", "axis: 2"),
        ("[0.0, 0.0, 1.0]", "axis: 2"),
    ] {
        let help = typed(&hinge(axis));
        assert_eq!(help[..2], [axis, number]);
        assert_eq!(
            told(&hinge(axis).replace(&format!("axis: {axis}"), number)),
            ""
        );
    }
    insta::assert_snapshot!(told(&hinge("3")), @"
    3:25 `axis` does not fit in `Revolute`: found `3` [MBG0204]
      `axis`: 0, 1 or 2 for x, y or z
      inside it, `moment` has 3 components, `moment[axis]` asks for more
    ");
}

#[test]
fn a_direction_is_told_by_an_axis_and_its_tilt() {
    let joint = |component: &str, axis: &str| {
        arm(&format!("joint: {component} {{ {axis} }} (ground, arm);"))
    };
    for (direction, written) in [
        ("[0.0, 0.0, 2.0]", "axis: 2"),
        ("[-1, 0, 0]", "tilt: rot_z(3.141592653589793), axis: 0"),
        ("-y", "tilt: rot_x(3.141592653589793), axis: 1"),
        (
            "[0.0, 0.0, -1.0]",
            "tilt: rot_x(3.141592653589793), axis: 2",
        ),
        (
            "[0.0, 1.0, 1.0]",
            "tilt: rot_x(-0.7853981633974483), axis: 2",
        ),
        (
            "[-1.0, 0.0, 1.0]",
            "tilt: rot_y(-0.7853981633974483), axis: 2",
        ),
        (
            "[3.0, 4.0, 5.0]",
            "tilt: rot_z(0.9272952180016122) * rot_y(0.7853981633974483), axis: 2",
        ),
    ] {
        for component in ["Revolute", "Prismatic"] {
            let help = typed(&joint(component, &format!("axis: {direction}")));
            assert!(help.iter().any(|it| it == written), "{help:?}");
            assert_eq!(told(&joint(component, written)), "");
        }
    }
    insta::assert_snapshot!(told(&joint("Revolute", "axis: [0.0, 0.6, 0.8]")), @"
    3:25 `axis` does not fit in `Revolute`: expected a whole number that is known while the model is compiled, found `[0.0, 0.6, 0.8]` [MBG0217]
      `axis`: 0, 1 or 2 for x, y or z
      help: an axis is 0, 1 or 2, and `tilt:` turns it, and the axes of the second frame with it: write `tilt: rot_x(-0.6435011087932844), axis: 2`
      help: it is made of integers, variables of loops, values given by `let`, and parameters of a component that are given as integers
      help: a `param` of a model is no such number, because it can change after the model is compiled
    ");
    insta::assert_snapshot!(told(&joint("Revolute", "axis: [0.0, 0.0, 0.0]")), @"
    3:25 `axis` does not fit in `Revolute`: expected a whole number that is known while the model is compiled, found `[0.0, 0.0, 0.0]` [MBG0217]
      `axis`: 0, 1 or 2 for x, y or z
      help: it is made of integers, variables of loops, values given by `let`, and parameters of a component that are given as integers
      help: a `param` of a model is no such number, because it can change after the model is compiled
    ");
}

#[test]
fn a_tilt_by_three_angles_is_told_as_turns() {
    let tilted = |tilt: &str| {
        arm(&format!(
            "hinge: Revolute {{ axis: 2, tilt: {tilt} }} (ground, arm);"
        ))
    };
    for (angles, turns) in [
        ("[0.1, 0.2, 0.3]", "rot_z(0.3) * rot_y(0.2) * rot_x(0.1)"),
        ("[0.0, 0.5 + 0.1, 0]", "rot_y(0.5 + 0.1)"),
        ("[0.0, 0.0, 0.0]", "1.0"),
    ] {
        let help = typed(&tilted(angles)).pop().unwrap();
        assert_eq!(help, format!("tilt: {turns}"));
        assert_eq!(told(&tilted(turns)), "");
    }
    insta::assert_snapshot!(told(&tilted("[0.1, 0.2, 0.3]")), @"
    3:34 `tilt` does not fit in `Revolute`: expected a 3×3 matrix, found a vector of 3 [MBG0204]
      `tilt`: Takes axes of the joint to axes of a, such as `rot_x(0.5)`
      help: for roll, pitch and yaw write `tilt: rot_z(0.3) * rot_y(0.2) * rot_x(0.1)`
    ");
}

#[test]
fn orientations_are_told_by_their_words() {
    let free = |word: &str| {
        arm(&format!(
            "free: Free {{ orientation: {word} }} (ground, arm);"
        ))
    };
    for (word, here) in [
        ("euler", "angles"),
        ("rpy", "angles"),
        ("quaternions", "quaternion"),
        ("quat", "quaternion"),
        ("dcm", "matrix"),
        ("rotation", "matrix"),
    ] {
        assert_eq!(typed(&free(word)), [here]);
        assert_eq!(told(&free(here)), "");
    }
}

#[test]
fn what_a_running_model_gives_is_told_as_that() {
    let text = |statement: &str| {
        format!(
            "model M {{ 1 v {{ I m {{ inertia: 1.0 }} R r {{ resistance: 1.0 }} }} {statement} }}"
        )
    };
    assert_eq!(typed(&text("output E = energy;")), ["System::energy"]);
    assert_eq!(typed(&text("output P = 2.0 * power;")), ["System::power"]);
    assert_eq!(told(&text("let energy = m.p; output E = energy;")), "");
    for event in [
        "when m.f > 1.0 { }",
        "when (m.f > 1.0) { m.p = 0.0; }",
        "when m.f > 1.0 then reinit(m.p, 0.0); end when;",
    ] {
        let told = told(&text(event));
        let first = told.lines().nth(1).unwrap();
        assert!(first.contains("`Integrator::until`"), "{told}");
    }
    assert_eq!(told(&text("1 when; v -> when;")), "");
    insta::assert_snapshot!(told(&text("when m.f > 1.0 { }")), @"
    1:64 expected a statement, found `when` [MBG0101]
      help: events are found while a model runs: `Integrator::until` stops where a guard goes through zero, and the next run starts from there
    ");
}

#[test]
fn a_dead_zone_and_a_choice_of_one_side_are_told_whole() {
    let text = |law: &str| {
        format!(
            "model M {{ param w: m/s = 0.1; param k: N*s/m = 2.0; param mass: kg = 1.0;
             1 v {{ I m {{ inertia: mass }} R r {{ effort: k * {law} }} }} }}"
        )
    };
    let help = typed(&text("deadzone(f, w)")).remove(0);
    assert_eq!(help, "(max(f - w, 0.0) + min(f + w, 0.0))");
    assert_eq!(told(&text(&help)), "");
    for choice in [
        "(if f > w { f })",
        "(if f > w { f } else if f < -w { 2.0 * f })",
    ] {
        let help = typed(&text(choice)).pop().unwrap();
        assert_eq!(help, "else { 0.0 }");
        let whole = choice.replace(" })", &format!(" }} {help})"));
        assert_eq!(told(&text(&whole)), "");
    }
}

#[test]
fn numbers_with_units_are_told_without_them() {
    let start = |angle: &str| {
        arm(&format!(
            "hinge: Revolute {{ axis: 1, initial: {angle} }} (ground, arm);"
        ))
    };
    for (compliance, value) in [
        ("1.5 mL/mmHg", "1.5 * 7.500615758456563e-9"),
        ("2 m^3/Pa", "2.0"),
    ] {
        let tank = format!(
            "model M {{ 0 a {{ C c {{ compliance: {compliance} }} R r {{ resistance: 1.0 }} }} }}"
        );
        assert_eq!(typed(&tank).last().unwrap(), value);
    }
    for (angle, value) in [
        ("30 deg", "30.0 * 0.017453292519943295"),
        ("30.0deg", "30.0 * 0.017453292519943295"),
        ("0.5 rad", "0.5"),
    ] {
        let help = typed(&start(angle)).pop().unwrap();
        assert_eq!(help, value);
        assert_eq!(told(&start(&help)), "");
    }
    insta::assert_snapshot!(told("model M { 1 a { I l { inertia: 1.0 }\nSe s { effort: 12 V } } }"), @"
    2:19 expected `,` or `}` after `12`, found `V` [MBG0101]
      help: numbers carry no unit, declarations do, such as `param x: V = …;`: write `12.0`
      help: for a product write `12 * V`
    ");
    insta::assert_snapshot!(told("model M { 1 a { I l { inertia: 1.0 } Se s { effort: v } }\nparam v = 12 kV; }"), @"
    2:14 expected `;` after `12`, found `kV` [MBG0101]
      help: numbers carry no unit, declarations do, such as `param x: V = …;`: write `12.0 * 1000`
    ");
}

#[test]
fn a_product_without_its_sign_is_told_with_it() {
    let text = |law: &str| {
        format!(
            "model M {{ param w = 3.0; input r; 1 v {{ I m {{ inertia: 1.0 }} C k {{ stiffness: 4.0 }}\nSe s {{ effort: r + {law} }} }} }}"
        )
    };
    for (law, product) in [
        ("sin(w t)", "w * t"),
        ("cos(2 t)", "2 * t"),
        ("sin(2.0 * w k.q)", "w * k.q"),
        ("exp(k.q sin(t))", "k.q * sin(t)"),
        ("exp((1.0 + w) t)", "(1.0 + w) * t"),
    ] {
        let help = typed(&text(law)).pop().unwrap();
        assert_eq!(help, product);
        let (before, after) = (product.replace(" * ", " "), product);
        assert_eq!(told(&text(&law.replace(&before, after))), "");
    }
    assert_eq!(typed(&text("w t")), ["w * t"]);
    assert_eq!(told(&text("mod(r, 2)")), "");
    // A word of the element lacks its comma alone.
    let mass = |law: &str| format!("model M {{ param m = 1.0; 1 a[3] {{ I i {{ {law} }} }} }}");
    for law in ["inertia: m initial: 2.0", "inertia: m gyroscopic"] {
        assert_eq!(typed(&mass(law)), [""; 0]);
    }
    // Another language's `if` has no product in it, but braces here.
    assert_eq!(
        typed(&text("(if w > r then w else r)")),
        ["if w > r { w } else { r }"]
    );
}

#[test]
fn entries_that_break_a_symmetry_are_told() {
    let text =
        |law: &str| format!("model M {{ param c = 2.0; 1 a[2] {{\nI l {{ inertia: {law} }} }} }}");
    insta::assert_snapshot!(told(&text("[[1e-3, 2e-3], [1e-3, 4e-3]]")), @"
    2:16 the matrix of a storage must be symmetric, or it would create energy [MBG0213]
      two of its entries differ: entry `[0][1]` is 0.002, entry `[1][0]` is 0.001
    ");
    insta::assert_snapshot!(told(&text("[[1.0, c], [-c, 4.0]]")), @"
    2:16 the matrix of a storage must be symmetric, or it would create energy [MBG0213]
      two of its entries differ: entry `[0][1]`, entry `[1][0]`
    ");
}

#[test]
fn a_whole_exponent_beyond_what_is_multiplied_out_is_told_as_a_power() {
    let law = |law: &str| {
        format!("model M {{ 1 a {{ I m {{ inertia: 1.0 }} C c {{ effort: {law} }} }} }}")
    };
    for slip in ["powi(q, 100)", "q ^ 100"] {
        assert_eq!(typed(&law(slip)), ["pow(q, 100)", "q"]);
    }
    assert_eq!(told(&law("pow(q, 100)")), "");
}

#[test]
fn a_name_that_is_missing_is_told_as_that() {
    for (slip, written) in [
        ("input: N;", "input name: N;"),
        ("output: m = 1.0;", "output name: m = 1.0;"),
        ("let: m = 2.0;", "let name: m = 2.0;"),
    ] {
        assert_eq!(typed(&arm(slip)), [written]);
    }
    insta::assert_snapshot!(told(&arm("param: kg = 2.0;")), @"
    3:6 expected a name after `param`, found `:` [MBG0101]
      help: write `param name: kg = 2.0;`
    ");
}

#[test]
fn one_slip_is_one_mistake() {
    let mass = |junction: &str, statement: &str| {
        told(&format!(
            "model M {{ input u; 1 v {{ I m {{ inertia: 1.0 }} {junction} }}\n{statement} }}"
        ))
    };
    insta::assert_snapshot!(mass("Se s { effort: u }", "integral way: m = v.f initial: 1.0; output y = way;"), @"
    2:23 expected `,` after `f`, found `initial` [MBG0101]
      help: write `, initial: …`
    ");
    insta::assert_snapshot!(mass("hinge: Revolute { axis: 2 } (a, b); Se s { effort: u }", ""), @"
    1:47 expected an element, found `hinge` [MBG0101]
      help: instances stand outside the junction's braces, each in a statement of its own: `hinge: Revolute { axis: 2 } (a, b);`
    ");
    insta::assert_snapshot!(mass("Se drive { flow: u }", ""), @"
    1:58 `Se` does not know `flow` [MBG0207]
      help: a source of flow is written `Sf drive { flow: u }`
      help: its words are `effort`
    ");
    insta::assert_snapshot!(mass("Se s { effort: u }", "output y[2]: m [v.f, v.f];"), @"
    2:16 expected `=` after `m`, found `[` [MBG0101]
      help: write `= [v.f, v.f]`
    ");
    insta::assert_snapshot!(mass("Se s { effort: static }", ""), @"
    1:62 expected an expression, found the keyword `static` [MBG0101]
      help: write another name, such as `static_`
    ");
    insta::assert_snapshot!(mass("Se s { effort: u }", "output w = let;"), @"
    2:12 expected an expression, found the keyword `let` [MBG0101]
      help: write another name, such as `let_`
    ");
    insta::assert_snapshot!(mass("Se s { effort: m.p as f64 }", ""), @"
    1:66 `as` changes a type, and every value is a number [MBG0213]
      help: write `m.p`
    ");
}
