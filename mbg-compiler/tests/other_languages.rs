//! Statements and laws of other languages, and what is to be typed instead.
#![allow(clippy::unwrap_used)]

mod told;

use told::{diagnose, told, typed};

/// Two masses and a statement.
fn masses(statement: &str) -> String {
    format!(
        "model M {{ 1 v {{ I m {{ inertia: 1.0 }} }} 1 w[3] {{ I n {{ inertia: 2.0 }} }} 0 k {{ C c {{ stiffness: 1.0 }} }}\n{statement} }}"
    )
}

/// A mass and what drives it.
fn driven(law: &str) -> String {
    format!(
        "model M {{ 1 v {{ I m {{ inertia: 1.0 }} R r {{ effort: 0.1 * f }}\nSe s {{ effort: {law} }} }} }}"
    )
}

/// An arm on a joint, with the law of its inertia and the joint as they are written.
fn arm(body: &str, joint: &str) -> String {
    format!(
        "#[derivative] model M {{ causality componentwise; param i: kg*m^2 = 0.5; param s: rad = 0.3; 1 ground[6]; 1 arm[6];
         Sf still[6] {{ flow: 0.0 }} -> ground; body: Body {{ {body} }} (arm);\n{joint} }}"
    )
}

const BODY: &str = "mass: 1.0, inertia: 1.0";

#[test]
fn choices_are_told_with_braces() {
    let chosen = "if t > 1 { 2.0 } else { 0.0 }";
    let second = "if t > 1 { 2.0 } else if t > 0.5 { 1.0 } else { 0.0 }";
    for (slip, choice) in [
        ("if t > 1 then 2.0 else 0.0", chosen),
        (
            "if (t > 1.0) then 2.0 else 0.0",
            "if (t > 1.0) { 2.0 } else { 0.0 }",
        ),
        ("t > 1 ? 2.0 : 0.0", chosen),
        ("2.0 if t > 1 else 0.0", chosen),
        ("3.0 * (2.0 if t > 1 else 0.0)", chosen),
        ("3.0 * (if t > 1 then 2.0 else 0.0)", chosen),
        ("(t > 1) * 2.0", chosen),
        ("2.0 * (t > 1)", chosen),
        ("if t > 1 then 2.0 elseif t > 0.5 then 1.0 else 0.0", second),
        (
            "if t > 1 then 2.0 else if t > 0.5 then 1.0 else 0.0",
            second,
        ),
    ] {
        let help = typed(&driven(slip)).remove(0);
        assert_eq!(help, choice);
        assert_eq!(told(&driven(&help)), "");
    }
    for word in ["ifelse", "piecewise"] {
        let help = typed(&driven(&format!("3.0 * {word}(t > 1, 2.0, 0.0)"))).remove(0);
        assert_eq!(help, "(if (t > 1) { 2.0 } else { 0.0 })");
        assert_eq!(told(&driven(&help)), "");
    }
    insta::assert_snapshot!(told(&driven("if t > 1 then 2.0")), @"
    2:25 `then` is no word here: the values of a choice stand in braces [MBG0101]
      help: write `if t > 1 { 2.0 } else { … }`
    ");
    insta::assert_snapshot!(told(&driven("2.0 if t > 1 else 0.0")), @"
    2:20 a choice begins with its `if` [MBG0101]
      help: write `if t > 1 { 2.0 } else { 0.0 }`
    ");
    // A junction may bear the word, and a choice as it is written here is no slip.
    assert_eq!(
        told(&masses(
            "1 then; v -> then; then -> R r { resistance: 1.0 };"
        )),
        ""
    );
    assert_eq!(
        told(&driven(
            "if t > 1 { 2.0 } else { if t > 0.5 { 1.0 } else { 0.0 } }"
        )),
        ""
    );
}

#[test]
fn words_of_declarations_in_rust_are_left_out() {
    for slip in ["pub param factor = 1.0;", "pub(crate) param factor = 1.0;"] {
        assert_eq!(typed(&masses(slip)), ["param factor = 1.0;"]);
    }
    insta::assert_snapshot!(told(&masses("param factor: f64 = 1.0;")), @"
    2:15 `f64` is not a unit of SI [MBG0502]
      help: a colon is before a unit, and every value is a number: leave the colon and the type out
    ");
    insta::assert_snapshot!(told(&masses("let mut factor = 1.0;")), @"
    2:5 expected the name of the value after `let`, found the keyword `mut` [MBG0101]
      help: a value does not change: leave out `mut`
    ");
}

#[test]
fn curves_and_choices_are_told_by_their_words_here() {
    for (slip, law) in [
        (
            "select(t > 1, 2.0, 0.0)",
            "(if (t > 1) { 2.0 } else { 0.0 })",
        ),
        (
            "table(t, [0.0, 1.0], [2.0, 3.0])",
            "interpolate(t, [0.0, 1.0], [2.0, 3.0])",
        ),
        (
            "lookup(t, [0.0, 1.0], [2.0, 3.0])",
            "interpolate(t, [0.0, 1.0], [2.0, 3.0])",
        ),
        (
            "lookup1d(t, [0.0, 1.0], [2.0, 3.0])",
            "interpolate(t, [0.0, 1.0], [2.0, 3.0])",
        ),
        ("CombiTable1Ds(t)", "interpolate(x, places, values)"),
        (
            "interpolate([0.0, 1.0], [2.0, 3.0], t)",
            "interpolate(t, [0.0, 1.0], [2.0, 3.0])",
        ),
    ] {
        assert_eq!(typed(&driven(slip)).last().map(String::as_str), Some(law));
        if !law.contains("places") {
            assert_eq!(told(&driven(law)), "");
        }
    }
    insta::assert_snapshot!(told(&driven("interpolate(t, [1.0, 0.0], [2.0, 3.0])")), @"
    2:37 expected a place beyond 1, found 0 [MBG0213]
      help: places rise: where they fall, write both vectors from their other ends
    ");
    assert_eq!(
        typed(&driven("interpolate(t, (0.0, 1.0), [2.0, 3.0])")),
        ["[0.0, 1.0]"]
    );
    assert_eq!(
        typed(&driven("match t { 0 => 1.0, _ => 2.0 }")),
        ["if t < … { … } else { … }"]
    );
}

#[test]
fn bars_and_entries_by_values_are_told_as_functions() {
    for (slip, law) in [
        ("2.0 * v.f * |v.f|", "abs(v.f)"),
        ("|v.f - 1.0| * v.f", "abs(v.f - 1.0)"),
        ("sqrt(|v.f|)", "abs(v.f)"),
        ("|t| * v.f", "abs(t)"),
    ] {
        assert_eq!(typed(&driven(slip)), [law]);
        assert_eq!(told(&driven(law)), "");
    }
    let gears = |ratio: &str| {
        format!(
            "model M {{ input gear; let ratios = [3.5, 2.0]; 1 v {{ I m {{ inertia: 1.0 }} Se s {{ effort: {ratio} }} }} }}"
        )
    };
    let curve = "interpolate(gear, [0.0, 1.0], ratios)";
    assert_eq!(typed(&gears("ratios[gear]")).last().unwrap(), curve);
    assert_eq!(told(&gears(curve)), "");
}

#[test]
fn connections_and_rates_are_told_as_statements() {
    for (slip, here) in [
        ("connect(v, k);", "v -> k;"),
        ("connect(v, w[0]);", "v -> w[0];"),
        ("der(x) = 2.0 * v.f;", "integral x = 2.0 * v.f;"),
        ("der x = 2.0 * v.f;", "integral x = 2.0 * v.f;"),
        ("signal x = 2.0 * v.f;", "let x = 2.0 * v.f;"),
        ("pseudo 0 x;", "0 x pseudo;"),
        ("parameter Real mass = 1.0;", "param mass = 1.0;"),
        ("parameter Real mass(min = 0.0) = 1.0;", "param mass = 1.0;"),
        ("parameter SI.Mass mass = 1.0;", "param mass = 1.0;"),
        (
            "parameter Real mass(unit = \"kg\") = 1.0 \"of a body\";",
            "param mass = 1.0;",
        ),
        ("constant Real g = 9.81;", "let g = 9.81;"),
        ("output Real speed = v.f;", "output speed = v.f;"),
        ("param Real mass = 1.0;", "param mass = 1.0;"),
        ("param mass(kg) = 1.0;", "param mass: kg = 1.0;"),
        ("input force[N];", "input force: N;"),
        ("input torque[N*m];", "input torque: N*m;"),
    ] {
        let help = typed(&masses(slip));
        assert!(help.iter().any(|text| text == here), "{help:?}");
        let answer = told(&masses(here));
        assert!(!answer.contains("MBG0101"), "{answer}");
    }
    let help = typed(&masses("output m.p;")).pop().unwrap();
    assert_eq!(help, "output name = m.p;");
    assert_eq!(told(&masses(&help)), "");
    // A junction may bear one of these names.
    assert_eq!(told(&masses("1 connect; v -> connect; connect -> k;")), "");
    insta::assert_snapshot!(told(&masses("output Real speed = v.f;")), @"
    2:8 expected the name of what is declared, found the type `Real` [MBG0101]
      help: write `output speed = v.f;`
    ");
    insta::assert_snapshot!(told(&masses("connect(v, k);")), @"
    2:1 expected a statement, found `connect` [MBG0101]
      help: a bond is written with an arrow: `v -> k;`
    ");
    insta::assert_snapshot!(told(&masses("input force[N];")), @"
    2:13 expected a dimension, which is an integer from 1 up, found `N` [MBG0103]
      help: a unit stands behind a colon: `input force: N;`
      help: a dimension is a number as it stands, such as `[3]`; `for k in 0..n { … }` repeats a computed number of times
    ");
}

#[test]
fn rates_and_integrals_in_laws_are_told_as_statements() {
    let [_, _, _, _, declared, read] = &typed(&masses("output a = der(w.f[1]);"))[..] else {
        panic!("six texts")
    };
    assert_eq!(told(&masses(&format!("{declared} output a = {read};"))), "");
    let [declared, read] = &typed(&masses("output a = 2.0 * integral(v.f);"))[..] else {
        panic!("two texts")
    };
    assert_eq!(
        told(&masses(&format!("{declared} output a = 2.0 * {read};"))),
        ""
    );
    let joint = "hinge: Revolute { axis: 1 } (ground, arm);\noutput a = der(hinge.rate.f);";
    insta::assert_snapshot!(told(&arm(BODY, joint)), @"
    4:12 `der` is not a function of the language [MBG0203]
      help: laws take no derivatives: the flow of an element `I` has the rate `….e / inertia`, and `System::derivative` gives the rates of all states; for that of `hinge.rate.f` behind a lag of a millisecond write `integral late = (hinge.rate.f - late) / 1e-3;`, and read `(hinge.rate.f - late) / 1e-3`
    ");
}

#[test]
fn gravity_is_told_without_a_mark() {
    for mark in [":", "="] {
        let help = typed(&masses(&format!("gravity{mark} [0, 0, -9.81];"))).remove(0);
        assert_eq!(help, "gravity [0, 0, -9.81];");
    }
}

#[test]
fn parameters_in_parentheses_are_told_in_braces() {
    let written = "hinge: Revolute { axis: 2, initial: 0.1 } (ground, arm);";
    for slip in [
        "hinge: Revolute(axis: 2, initial: 0.1) (ground, arm);",
        "hinge: Revolute(axis = 2, initial = 0.1) (ground, arm);",
        "Revolute hinge(axis = 2, initial = 0.1) (ground, arm);",
    ] {
        assert_eq!(typed(&arm(BODY, slip)), [written]);
    }
    assert_eq!(told(&arm(BODY, written)), "");
}

#[test]
fn units_are_told_with_their_signs() {
    let text = |unit: &str| masses(&format!("param factor: {unit} = 1.0;"));
    for (slip, unit) in [
        ("N.m", "N*m"),
        ("kg m^2", "kg*m^2"),
        ("kg*m**2", "kg*m^2"),
        ("kg.m**2/s", "kg*m^2/s"),
        ("N m/(rad s)", "N*m/(rad*s)"),
    ] {
        assert_eq!(typed(&text(slip)), [unit]);
        assert_eq!(told(&text(unit)), "");
    }
}

#[test]
fn a_range_with_its_end_is_told_with_what_is_beyond() {
    let helps = ["for k in 1:4 { 1 x; }", "for k in 1:count { 1 x; }"]
        .map(|slip| typed(&masses(slip)).remove(0));
    assert_eq!(helps, ["1..5", "1..count + 1"]);
    insta::assert_snapshot!(told(&masses("integral x = v.f, initial = 3.0; output x = x;")), @"
    2:27 expected `:` after `initial`, found `=` [MBG0101]
      help: write `initial: …`
    ");
    insta::assert_snapshot!(told(&masses("initial equation v.f = 10.0;")), @"
    2:1 expected a statement, found `initial` [MBG0101]
      help: what storages begin with stands in their braces: `I body { inertia: …, initial_flow: … }`, `C spring { stiffness: …, initial: … }`
    ");
}

#[test]
fn components_and_ranges_are_told_in_brackets() {
    for (slip, value) in [("w.f(1)", "w.f[1]"), ("[v.f; m.p]", "[v.f, m.p]")] {
        let output = |value: &str| {
            let size = if value.starts_with('[') { "[2]" } else { "" };
            masses(&format!("output y{size} = {value};"))
        };
        let help = typed(&output(slip)).pop().unwrap();
        assert_eq!(help, value);
        assert_eq!(told(&output(&help)), "");
    }
    let matrix = typed(&masses("let a = [1.0, 0.0; 0.0, 2.0];")).remove(0);
    assert_eq!(matrix, "[[1.0, 0.0], [0.0, 2.0]]");
    let called = typed(&driven("2.0 * t(3.0 + t)"));
    assert_eq!(called, ["t * (3.0 + t)"]);
    let range = |text: &str| {
        masses(&format!(
            "1 x[2] {{ R r {{ resistance: 1.0 }} }} {text} -> x;"
        ))
    };
    assert_eq!(typed(&range("w[1:3]")), ["[1..3]"]);
    assert_eq!(told(&range("w[1..3]")), "");
    assert_eq!(typed(&masses("output y[2] = w.f[1:3];")), ["[1..3]"]);
    assert_eq!(told(&masses("output y[2] = w.f[1..3];")), "");
    insta::assert_snapshot!(told(&masses("output y[2] = w.f[1:3];")), @"
    2:20 expected `]`, found `:` [MBG0101]
      help: a range is written `[1..3]`
    ");
    insta::assert_snapshot!(told(&masses("output y = w.f(1);")), @"
    2:14 `w.f` is a value, and it is called as a function [MBG0203]
      help: a component stands in brackets: write `w.f[1]`
    ");
}

#[test]
fn whole_numbers_are_told_without_their_point() {
    let hinge = |axis: &str| {
        arm(
            BODY,
            &format!("hinge: Revolute {{ axis: {axis} }} (ground, arm);"),
        )
    };
    assert_eq!(typed(&hinge("2.0")), ["2"]);
    assert_eq!(told(&hinge("2")), "");
    assert_eq!(
        typed(&masses("for k in 0..2.0 { v -> R r { resistance: 1.0 }; }")),
        ["2"]
    );
}

#[test]
fn what_a_junction_starts_with_is_told_at_its_inertia() {
    insta::assert_snapshot!(told("model M {\n1 v initial: 2.0 { I m { inertia: 1.0 } } output f = v.f; }"), @"
    2:5 expected `[`, `coordinate`, `pseudo`, `{` or `;` after `v`, found `initial` [MBG0101]
      help: a flow at the start is given with the inertia, `I … { inertia: …, initial_flow: 2.0 }`, or with a coordinate, `1 … coordinate, initial_flow: 2.0 { … }`
    ");
    let [law, junction] = &typed("model M { 1 v initial: 2.0; I m { inertia: 1.0 } -> v; }")[..]
    else {
        panic!("two texts")
    };
    assert_eq!(law, "I … { inertia: …, initial_flow: 2.0 }");
    assert_eq!(junction, "1 … coordinate, initial_flow: 2.0 { … }");
}

#[test]
fn a_cosine_is_no_angle() {
    let slide = |initial: &str| {
        arm(
            BODY,
            &format!("slide: Prismatic {{ axis: 1, initial: {initial} }} (ground, arm);"),
        )
    };
    insta::assert_snapshot!(told(&slide("cos(s)")), @"
    3:38 `initial` is declared in `m`, and this is a pure number [MBG0501]
      help: a number with a decimal point carries any unit as a factor: `1.0 * …`; a whole number counts
    ");
    assert_eq!(told(&slide("1.0 * cos(s)")), "");
}

#[test]
fn a_thin_rod_is_told_a_small_inertia() {
    let hinge = "hinge: Revolute { axis: 1 } (ground, arm);";
    for (body, number) in [
        ("mass: 1.0, inertia: diag(0.0, 0.5, 0.5)", "1e-7"),
        ("mass: 1.0, inertia: diag(0.0, i, i)", "1e-6 * …"),
    ] {
        let slip = arm(body, hinge);
        assert_eq!(typed(&slip), [number]);
        let number = number.replace('…', "i");
        assert_eq!(told(&arm(&body.replace("0.0", &number), hinge)), "");
    }
    insta::assert_snapshot!(told(&arm("mass: 1.0, inertia: diag(0.0, i, i)", hinge)), @"
    2:80 `inertia` does not fit in `Body`: the inertia of `spin` is 0, not positive [MBG0216]
      `inertia`: About the centre of mass: a 3×3 matrix, or a number for a ball
      help: write a number far below the others in the place of the 0, such as a millionth of one of them: `1e-6 * …`
    ");
}

/// Where a whole inertia is zero, no number is known to be small beside it.
#[test]
fn what_has_no_inertia_is_told_to_be_left_out() {
    let plate = |tip: &str| {
        format!(
            "model M {{ 1 v {{ I m {{ inertia: 1e-10 }}\n{tip} R r {{ resistance: 1e-5 }} }} }}"
        )
    };
    insta::assert_snapshot!(told(&plate("I tip { inertia: 0.0 }")), @"
    2:18 the inertia of `tip` is 0, not positive [MBG0216]
      help: remove `tip`: without an inertia it changes nothing
    ");
    assert_eq!(told(&plate("")), "");
    for (body, joint, written) in [
        (
            "body: Body { mass: 1.0, inertia: 0.0 } (arm);",
            "Prismatic",
            "body: PointMass { mass: 1.0 } (arm);",
        ),
        (
            "body: Body { mass: 0.0, inertia: 1.0 } (arm);",
            "Revolute",
            "I body[3] { inertia: 1.0, gyroscopic } -> arm[0..3];",
        ),
    ] {
        let text = |body: &str| {
            format!(
                "#[derivative] model M {{ causality componentwise; 1 ground[6]; 1 arm[6];
                 Sf still[6] {{ flow: 0.0 }} -> ground; {body} joint: {joint} {{ axis: 1 }} (ground, arm); }}"
            )
        };
        assert_eq!(typed(&text(body)), [written]);
        assert_eq!(told(&text(written)), "");
    }
}

/// A condition that is a value alone is 0 or 1 in other languages.
#[test]
fn values_as_conditions_are_compared() {
    let law = |law: &str| {
        format!(
            "model M {{ param on = 1.0; 1 v {{ I m {{ inertia: 1.0 }} R r {{ resistance: {law} }} }} output y = v.f; }}"
        )
    };
    let written = "if on > 0.5 { 1e-3 } else { 1e6 }";
    assert_eq!(typed(&law("on ? 1e-3 : 1e6")), [written]);
    assert!(diagnose(&law(written)).list().is_empty());
    for (condition, help) in [
        ("on", "on > 0.5"),
        ("on == 1", "on > 0.5"),
        ("on != 0.0", "on > 0.5"),
        ("on == 0", "on < 0.5"),
    ] {
        let choice = law(&format!("if {condition} {{ 1e-3 }} else {{ 1e6 }}"));
        assert_eq!(typed(&choice), [help], "{condition}");
    }
    // Of other numbers nothing is known.
    let other = law("if on == 2.0 { 1e-3 } else { 1e6 }");
    assert!(typed(&other).is_empty());
}

#[test]
fn elements_and_junctions_are_told_as_they_are_spelled() {
    let mass = "I m { inertia: 1.0 }";
    let numbers = "numbers carry no unit, declarations do, such as `param x: ohm = …;`: write";
    for (body, help) in [
        (
            "1 v { I: m { inertia: 1.0 } }".to_owned(),
            "write `I m`, without the colon".to_owned(),
        ),
        (
            "1 v { m: I { inertia: 1.0 } }".to_owned(),
            "the kind of an element stands before its name: `I m { … }`".to_owned(),
        ),
        (
            "1 v { I m { inertia: 1.0; initial: 2.0 } }".to_owned(),
            "commas stand between the words of an element".to_owned(),
        ),
        (
            "1 v { I m { 0.1 } }".to_owned(),
            "a value has a word before it: write `inertia: 0.1`".to_owned(),
        ),
        (
            format!("1 v {{ {mass} R r {{ resistance: .5 }} }}"),
            "write `0.5`".to_owned(),
        ),
        (
            format!("1 v {{ {mass} R r {{ resistance: 0.5 [ohm] }} }}"),
            format!("{numbers} `0.5`"),
        ),
        (
            format!("1 v {{ {mass} Se s {{ effort: f64::sin(2.0 * t) }} }}"),
            "write `sin(2.0 * t)`".to_owned(),
        ),
        (
            format!("1 v {{ {mass} Se s {{ effort: 2 sin(t) }} }}"),
            "for a product write `2 * sin(t)`".to_owned(),
        ),
        (
            format!("param m = 1.0; 1 v {{ {mass} }}"),
            "an element and a value have different names: call the element something else, such as `m_`".to_owned(),
        ),
        (
            format!("J1 v {{ {mass} }}"),
            "a junction begins with its digit: `1 v`".to_owned(),
        ),
        (
            format!("1-junction v {{ {mass} }}"),
            "write `1 v`".to_owned(),
        ),
        (
            format!("1 v {{ {mass} }} 1 w {{ R r {{ resistance: 1.0 }} }} bond v -> w;"),
            "a bond is written without a word before it: `v -> w;`".to_owned(),
        ),
        (
            format!("1 v {{ {mass} if 1 == 1 {{ R r {{ resistance: 1.0 }} }} }}"),
            "the elements in a junction's braces are always there; others hang by a bond in a statement of their own: `if … { \
             junction -> R name { … }; }`"
                .to_owned(),
        ),
    ] {
        let told = told(&format!("model M {{ {body} }}"));
        let helps: Vec<&str> = told.lines().filter_map(|line| line.trim().strip_prefix("help: ")).collect();
        assert_eq!(helps, [help], "{body}: {told}");
    }
}

#[test]
fn an_entry_of_a_matrix_is_told_with_two_numbers() {
    let read = |entry: &str| masses(&format!("let a = rot_x(0.3); output y = {entry} * v.f;"));
    assert_eq!(typed(&read("a[1].y")), ["a[1][1]"]);
    assert_eq!(told(&read("a[1][1]")), "");
    let hinge = |entry: &str| {
        arm(
            BODY,
            &format!("hinge: Revolute {{ axis: 0 }} (ground, arm); output x = {entry} + s + i;"),
        )
    };
    assert_eq!(
        typed(&hinge("hinge.orientation_b[0].x")),
        ["hinge.orientation_b[0][0]"]
    );
    assert!(!told(&hinge("hinge.orientation_b[0][0]")).contains("declared"));
}

#[test]
fn functions_and_assertions_are_told_as_what_stands_for_them() {
    insta::assert_snapshot!(told(&masses("fn square(x) = x * x;")), @"
    2:1 expected a statement, found `fn` [MBG0101]
      help: functions are not declared: write `let square = x * x;` with what is read in the place of `x`, or give elements with one law to a `component`
    ");
    insta::assert_snapshot!(told(&masses("assert(v.f < 2.0);")), @"
    2:8 `v.f < 2.0` may change while the model runs [MBG0213]
      help: an assertion is of numbers and parameters: what runs the model checks an output that is positive while all is well, `output margin = 2.0 - v.f;`
    ");
    assert_eq!(told(&masses("output margin = 2.0 - v.f;")), "");
    for (slip, here) in [
        ("assert(v.f >= m.p);", "output margin = v.f - m.p;"),
        (
            "assert(v.f < m.p - 1.0);",
            "output margin = m.p - 1.0 - v.f;",
        ),
        (
            "assert(m.p - 1.0 < v.f - 2.0);",
            "output margin = v.f - 2.0 - (m.p - 1.0);",
        ),
    ] {
        assert_eq!(typed(&masses(slip)), [here]);
        assert_eq!(told(&masses(here)), "");
    }
}

#[test]
fn an_element_without_a_name_is_told_with_one() {
    let chain = |gyrator: &str| {
        masses(&format!(
            "1 u {{ I o {{ inertia: 1.0 }} }} v -> {gyrator} -> u;"
        ))
    };
    insta::assert_snapshot!(told(&chain("GY(0.1)")), @"
    2:37 expected `->` after `GY`, found `(` [MBG0101]
      help: an element has a name, and its law stands in braces behind a word: `GY name { effort: 0.1 }`
    ");
    assert_eq!(told(&chain("GY name { effort: 0.1 }")), "");
    assert_eq!(
        typed(&masses("R(2.0) -> v;")),
        ["R name { resistance: 2.0 }"]
    );
}

#[test]
fn functions_without_parentheses_and_products_are_told_before_prefixes() {
    assert_eq!(typed(&driven("sin t")), ["sin(t)"]);
    assert_eq!(told(&driven("sin(t)")), "");
    let resistor = |law: &str| masses(&format!("R r {{ {law} }} -> v;"));
    assert_eq!(typed(&resistor("effort: 2 f")), ["2 * f", "2e-15"]);
    assert_eq!(told(&resistor("effort: 2 * f")), "");
    assert_eq!(typed(&resistor("resistance: 2 k")), ["2e3", "2 * k"]);
}

#[test]
fn conditions_are_joined_by_marks() {
    let resistor = |condition: &str| {
        masses(&format!(
            "R r {{ effort: if {condition} {{ f }} else {{ 0.5 * f }} }} -> v;"
        ))
    };
    for (slip, here, mark) in [
        ("f > 0.0 and f < 1.0", "f > 0.0 && f < 1.0", "&&"),
        ("(f > 0.0) or (f < -1.0)", "(f > 0.0) || (f < -1.0)", "||"),
        ("not (f > 0.0)", "!(f > 0.0)", "!"),
        (
            "f < 2.0 && (f > 0.0 or t > 1.0)",
            "f < 2.0 && (f > 0.0 || t > 1.0)",
            "||",
        ),
    ] {
        assert_eq!(typed(&resistor(slip)), [mark]);
        assert_eq!(told(&resistor(here)), "");
    }
    for (slip, here) in [
        ("0.0 < f < 1.0", "0.0 < f && f < 1.0"),
        ("t > 1.0 || (0.0 <= f <= 1.0)", "0.0 <= f && f <= 1.0"),
    ] {
        assert_eq!(typed(&resistor(slip)), [here]);
        assert_eq!(told(&resistor(here)), "");
    }
    insta::assert_snapshot!(told(&resistor("0.0 < f < 1.0")), @"
    2:26 comparison operators cannot be chained [MBG0101]
      help: write `0.0 < f && f < 1.0`
    ");
    insta::assert_snapshot!(told(&resistor("f > 0.0 and t > 1.0")), @"
    2:26 `and` is no operator [MBG0101]
      help: write `&&`
    ");
    // Names are as good as others.
    assert_eq!(
        told(&masses("let and = 2.0; R r { effort: and * f } -> v;")),
        ""
    );
}

#[test]
fn attributes_of_rust_are_told_with_where_they_stand() {
    let text = "#[derive(Default)] #[cfg(unix)] #[serde(default)]
        model M { #[allow(dead_code)] param x = 1.0; 1 v { I m { inertia: x } } }";
    insta::assert_snapshot!(told(text), @"
    1:3 expected `derivative` or a documentation comment, found `derive` [MBG0101]
      help: the types of a model are `Clone`, `Copy`, `Debug` and `PartialEq`; other traits are written behind the call: `impl Trait for Model { … }`
    1:22 expected `derivative` or a documentation comment, found `cfg` [MBG0101]
      help: a whole call alone can be left out so, and not a part of a model: `#[cfg(unix)] mbg! { … }`
    1:35 expected `derivative` or a documentation comment, found `serde` [MBG0101]
      help: attributes of Rust are not handed on; what a type is to have besides is written behind the call: `impl Trait for Model { … }`
    2:21 expected `derivative` or a documentation comment, found `allow` [MBG0101]
      help: it stands on a module around the call: `#[allow(dead_code)] mod models { … mbg! { … } }`
    ");
}

/// A vector stands in brackets, `else if` is two words, and a comment begins with two strokes.
#[test]
fn marks_of_other_languages_are_told_as_those_that_are_here() {
    for (slip, here) in [
        ("let x = {1.0, 2.0};", "[1.0, 2.0]"),
        (
            "let x = 2.0 * {{1.0, 2.0}, {3.0, m.p}};",
            "[[1.0, 2.0], [3.0, m.p]]",
        ),
        (
            "Se s { effort: interpolate(t, {0.0, 1.0}, [2.0, 3.0]) } -> v;",
            "[0.0, 1.0]",
        ),
        (
            "Se s { effort: if t > 1.0 { 1.0 } elif t > 0.5 { 2.0 } else { 0.0 } } -> v;",
            "else if",
        ),
        (
            "if 1 > 2 { 1 x; x -> v; } elsif 2 > 1 { 1 y; y -> v; }",
            "else if",
        ),
        ("# what follows", "//"),
        ("causality component;", "componentwise"),
    ] {
        assert_eq!(typed(&masses(slip)), [here]);
    }
    insta::assert_snapshot!(told(&masses("let x = {1.0, 2.0};")), @"
    2:9 expected an expression, found `{` [MBG0101]
      help: vectors stand in brackets: write `[1.0, 2.0]`
    ");
    insta::assert_snapshot!(told(&driven("if t > 1.0 { 1.0 } elif t > 0.5 { 2.0 } else { 0.0 }")), @"
    2:35 `elif` is no word here: another choice begins with two [MBG0101]
      help: write `else if`
    ");
}

/// Laws are equations elsewhere, and states are declared.
#[test]
fn equations_are_told_as_laws() {
    let text = |element: &str| {
        format!(
            "model M {{ param a = 2.0; param b = 3.0; 1 v {{ I m {{ inertia: a }} R d {{ resistance: b }} {element} }} }}"
        )
    };
    for (slip, written) in [
        ("R r { 0 = e - a * f }", "effort: a * f"),
        (
            "R r { e - a * f - b * powi(f, 3) = 0.0 }",
            "effort: a * f + b * powi(f, 3)",
        ),
        ("R r { e == -a * f }", "effort: -a * f"),
        ("R r { a * tanh(e) - f - b = 0; }", "flow: a * tanh(e) - b"),
        ("R r { effort = a * f }", "effort: a * f"),
        ("R r { e: a * f }", "effort: a * f"),
        ("C c { e = b * q }", "effort: b * q"),
        ("C c { stiffness: b, state q = 1.0 }", "initial: 1.0"),
        ("I i { f = p / a }", "flow: p / a"),
    ] {
        let texts = typed(&text(slip));
        assert!(texts.contains(&written.to_owned()), "{slip}: {texts:?}");
    }
    insta::assert_snapshot!(told(&text("R r { 0 = e - a * f }")), @"
    1:94 expected a word of `R r`, found `0` [MBG0101]
      help: a law gives the effort: write `effort: a * f`
    ");
    insta::assert_snapshot!(told(&text("R r { e * f = a }")), @"
    1:96 expected `:`, `,` or `}` after `e`, found `*` [MBG0101]
      help: a law is no equation, but gives one variable: write `effort: …` in `f` or `flow: …` in `e`
    ");
    insta::assert_snapshot!(told(&text("C c { der(q) = f; stiffness: b }")), @"
    1:97 expected `:`, `,` or `}` after `der`, found `(` [MBG0101]
      help: how `q` changes is known of the element: leave this out
    ");
    insta::assert_snapshot!(told(&text("} state charge: C = 1.0; 1 w { I i { inertia: 1.0 } ")), @"
    1:90 expected a statement, found `state` [MBG0101]
      help: storages have states of their own, which begin with `initial: 1.0` in their braces; another is an integral: `integral charge: C = …, initial: 1.0;`
    ");
}

#[test]
fn remainders_and_whole_parts_have_their_functions() {
    let text = |law: &str| {
        format!(
            "model M {{ input r; param n = 2.0; 1 v {{ I m {{ inertia: 1.0 }} C k {{ stiffness: 4.0 }}\nSe s {{ effort: {law} }} }} }}"
        )
    };
    for (elsewhere, here) in [
        ("ceil(r)", "-floor(-r)"),
        ("round(r)", "floor(r + 0.5)"),
        ("trunc(r + n)", "(sign(r + n) * floor(abs(r + n)))"),
        ("fmod(r, 2.0)", "(sign(r) * mod(abs(r), 2.0))"),
        ("r.rem_euclid(2.0 * n)", "mod(r, abs(2.0 * n))"),
        ("modulo(r, 2.0)", "mod(r, 2.0)"),
        ("max(r, n, 2.0 * t)", "max(r, max(n, 2.0 * t))"),
    ] {
        assert_eq!(typed(&text(elsewhere)), [here]);
        assert_eq!(told(&text(here)), "");
    }
    insta::assert_snapshot!(told(&text("if t % 1e-3 < 5e-4 { 24.0 } else { 0.0 }")), @"
    2:21 `%` stands between whole numbers, and `t` changes while the model runs [MBG0217]
      help: write `mod(t, 1e-3)`, which has the sign of `1e-3`
    ");
    // Of what stays the same, another cause is told.
    insta::assert_snapshot!(told(&text("n % 2")), @"
    2:16 expected a whole number that is known while the model is compiled, found `n % 2` [MBG0217]
      help: a `param` of a model can change after the model is compiled: declare `let n = 2;` in its place
    ");
}

/// A value over time in parentheses is no unit, and an integrator with limits has a rate that ends there.
#[test]
fn values_over_time_and_integrals_with_limits_are_told() {
    let of_time = "input u(t): N; Se s { effort: u } -> v;";
    assert_eq!(typed(&masses(of_time)).remove(0), "input u: N;");
    let of_time = "let u(t) = sin(t); Se s { effort: u } -> v;";
    let written = typed(&masses(of_time)).remove(0);
    assert_eq!(written, "let u = sin(t);");
    let limited = "integral x = 2.0 - v.f, min: -1.0, max: 1.0; Se s { effort: x } -> v;";
    let written = typed(&masses(limited)).remove(0);
    let whole = format!(
        "let upper = 1.0; let lower = -1.0; let rate = 2.0 - v.f; {written} Se s {{ effort: x }} -> v;"
    );
    assert_eq!(told(&masses(&whole)), "", "{written}");
}

#[test]
fn lengths_and_angles_in_degrees_are_told_as_products() {
    for (slip, written) in [
        ("rad2deg(t)", "(57.29577951308232 * t)"),
        ("degrees(t)", "(57.29577951308232 * t)"),
        ("to_degrees(t)", "(57.29577951308232 * t)"),
        ("length([t, 2.0])", "sqrt(transpose([t, 2.0]) * [t, 2.0])"),
    ] {
        let help = typed(&driven(slip)).remove(0);
        assert_eq!(help, written);
        assert_eq!(told(&driven(&help)), "");
    }
    insta::assert_snapshot!(told(&masses("param speed: kn = 10.0; R r { resistance: speed } -> v;")), @"
    2:14 values in `kn` are not in SI: `kn` scales them [MBG0503]
      help: write `m/s`, and each value times 0.5144444444444445
    ");
}
