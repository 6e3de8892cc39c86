//! Helps of messages are followed to the letter, and lead to models that compile.
#![allow(clippy::unwrap_used)]

mod told;

use mbg_compiler::codes;
use mbg_compiler::diagnostics::Code;
use told::diagnose;

/// The helps of the only code of a model, without the `or` between them.
fn helps(text: &str, code: Code) -> Vec<String> {
    let diagnostics = diagnose(text);
    let list = diagnostics.list();
    assert!(!list.is_empty(), "{text}");
    assert!(list.iter().all(|it| it.code == code), "{}", list[0].text());
    let helps = list[0].helps.iter();
    helps
        .map(|help| help.trim_start_matches("or ").to_owned())
        .collect()
}

/// A model with what a help says to type: statements at its end, and words before the element that they name.
fn followed(text: &str, help: &str) -> String {
    let mut followed = text.trim_end().trim_end_matches('}').to_owned();
    for typed in help.split('`').skip(1).step_by(2) {
        if typed.ends_with(';') {
            followed += &typed.replace('…', "1.0");
        } else if let Some(element) = typed.strip_prefix("#[derivative] ") {
            let element = element.trim_end_matches("{ … }");
            followed = followed.replacen(element, &format!("#[derivative] {element}"), 1);
        }
    }
    followed + " }"
}

fn compiles(text: &str) {
    let diagnostics = diagnose(text);
    let told: Vec<String> = diagnostics.list().iter().map(|it| it.text()).collect();
    assert!(told.is_empty(), "{text}\n{}", told.join("\n"));
}

#[test]
fn what_floats_is_held_at_one_junction() {
    let circuit = "0 plus; 0 minus; r: Resistor { resistance: 2.0 } (plus, minus);
                   c: Capacitor { capacitance: 1.0 } (plus, minus);";
    let cases = [
        (circuit, "`plus`, `minus`: their efforts", "`Se earth { effort: 0.0 } -> minus;`"),
        (
            "0 a; 0 b; l: Inductor { inductance: 2.0 } (a, b); c: Capacitor { capacitance: 1.0 } (a, b);",
            "`a`, `b`: their efforts",
            "`Se earth { effort: 0.0 } -> b;`",
        ),
        (
            "causality componentwise; 0 a[2]; 0 b[2]; 1 c[2] { R r { resistance: 1.0 } } a -> c; c -> b;
             1 d[2] { C s { stiffness: 1.0 } } a -> d; d -> b; 0 earth { C k { stiffness: 1.0 } R l { resistance: 1.0 } }",
            "`a`, `b`: their efforts",
            "`Se earth2[2] { effort: 0.0 } -> b;`",
        ),
        (
            "1 x; 1 y; 0 p { C q { stiffness: 1.0 } } 0 r { R d { resistance: 1.0 } } x -> p; p -> y; x -> r; r -> y;",
            "`x`, `y`: their flows",
            "`Sf wall { flow: 0.0 } -> y;`",
        ),
    ];
    for (body, floating, typed) in cases {
        let text = format!("model M {{ {body} }}");
        let report = diagnose(&text).list()[0].message.clone();
        assert!(
            report.starts_with(&format!("nothing holds {floating}")),
            "{report}"
        );
        let helps = helps(&text, codes::SINGULAR_JUNCTIONS);
        assert_eq!(helps[0], format!("hold one of them: {typed}"));
        compiles(&followed(&text, &helps[0]));
    }
}

#[test]
fn a_frame_that_nothing_holds_is_told_before_the_hinge_that_leads_to_it() {
    let hinge = |kind: &str| format!("hinge: {kind} {{ torque: drive }} (ground, arm);");
    let planar = hinge("PlanarRevolute");
    let spatial = hinge("Revolute").replace("torque", "axis: 2, torque");
    let cases = [
        (
            3,
            format!("{planar} beam: PlanarBody {{ mass: 2.0, inertia: 0.1 }} (arm);"),
        ),
        (
            6,
            format!("{spatial} beam: Body {{ mass: 2.0, inertia: 0.1 }} (arm);"),
        ),
    ];
    for (size, parts) in cases {
        let text = format!(
            "#[derivative] model M {{ input drive: N*m; 1 ground[{size}]; 1 arm[{size}]; {parts} }}"
        );
        assert_eq!(
            diagnose(&text).list()[0].message,
            "nothing holds `ground`: its flow and that of `hinge.rate` can change together without any effect"
        );
        let helps = helps(&text, codes::SINGULAR_JUNCTIONS);
        let source = format!("`Sf wall[{size}] {{ flow: 0.0 }} -> ground;`");
        assert_eq!(helps[0], format!("hold it, if it is at rest: {source}"));
        compiles(&followed(&text, &helps[0]));
    }
    let free_end = "#[derivative] model M { 1 ground[6]; 1 arm[6]; Sf fixed[6] { flow: 0.0 } -> ground; \
        hinge: Revolute { axis: 2 } (ground, arm); }";
    assert!(
        diagnose(free_end).list()[0]
            .message
            .starts_with("nothing holds `arm`")
    );
}

#[test]
fn a_ring_of_junctions_is_opened() {
    let ring = "model M { 1 a { I m { inertia: 1.0 } } 1 b; 0 c; b -> c; c -> b; }";
    let helps = helps(ring, codes::SINGULAR_JUNCTIONS);
    let help = "take one bond of the mesh away: what it says follows from the others";
    assert_eq!(helps, [help]);
}

#[test]
fn of_storages_that_depend_on_each_other_a_linear_one_is_eliminated() {
    let text = |law: &str| {
        let first = "C first { effort: q + powi(q, 3) }";
        format!(
            "model M {{ 0 node {{ {first} #[derivative] C last {{ {law} }} R r {{ resistance: 1.0 }} }} }}"
        )
    };
    compiles(&text("stiffness: 2.0"));
    // The mark stands already, but not before the linear one alone.
    for model in [
        "#[derivative] model M { MARKS",
        "model M { MARKS#[derivative] ",
    ] {
        let (linear, mark) = ("C last { stiffness: 2.0 }", "#[derivative] ");
        let rest = "C first { effort: q + powi(q, 3) } R r { resistance: 1.0 } } }";
        let before = format!("0 node {{ {linear} ");
        let marked = model.replace("MARKS", &before) + rest;
        let told = helps(&marked, codes::ORDER_LOST_UNSUPPORTED);
        let alone =
            "write `#[derivative]` before another of the storages alone, whose law is linear";
        assert!(told[0].starts_with(alone), "{told:?}");
        compiles(
            &marked
                .replace(mark, "")
                .replace(linear, &format!("{mark}{linear}")),
        );
    }
    let nonlinear = text("effort: 2.0 * q + powi(q, 3)");
    let told = helps(&nonlinear, codes::ORDER_LOST_UNSUPPORTED);
    assert_eq!(told, ["put a resistor between them"]);
    let (node, last) = ("0 node {", "#[derivative] C last");
    let between =
        "0 other { C last { effort: 2.0 * q + powi(q, 3) } } 1 path { R s { resistance: 1.0 } }
                   node -> path; path -> other; 0 node {";
    let apart = nonlinear.replace(&format!("{last} {{ effort: 2.0 * q + powi(q, 3) }}"), "");
    compiles(&apart.replace(node, between));
}

/// A body that spins about the one axis that a source leaves, the source, and where it acts.
const HELD: [(&str, &str, &str); 2] = [
    (
        "1 body[3] { I rotor { inertia: diag(1.0, 2.0, 3.0), gyroscopic } }",
        "Sf held[2] { flow: 0.0 }",
        "body[0..2]",
    ),
    (
        "1 body[3] { EJS wheel { momentum: [0.0, 0.0, 1.0] } I rotor { inertia: 1.0 } }
         1 shaft[2]; shaft -> body[0..2];",
        "Sf held[2] { flow: 0.0 }",
        "shaft",
    ),
];

#[test]
fn a_body_held_about_two_axes_keeps_the_third() {
    for (body, source, place) in HELD {
        let text = format!("model M {{ {body} {source} -> {place}; }}");
        let helps = helps(&text, codes::NO_ASSIGNMENT);
        assert_eq!(helps.len(), 2, "{helps:?}");
        compiles(&followed(&text, &helps[0]));
        let driven = text.replace(&format!("-> {place}"), "-> driven");
        assert!(helps[1].starts_with(
            "remove `held`, or let it act through a spring: bond it to `1 driven[2];`"
        ));
        compiles(&followed(&driven, &helps[1]));
    }
}

#[test]
fn a_flow_that_nothing_gives_is_given() {
    let text = "model M { 1 a { I m { inertia: 1.0 } } 1 b { Se s { effort: 1.0 } } }";
    for help in helps(text, codes::NO_ASSIGNMENT) {
        compiles(&followed(text, &help));
    }
}

#[test]
fn a_tank_between_a_pump_and_a_valve_is_held() {
    let text = "model M { 0 tank; 0 supply { C oil { stiffness: 1e12 } } 1 shaft { Sf motor { flow: 100.0 } }
                pump: Pump { displacement: 1e-6 } (tank, supply, shaft); valve: Orifice { area: 1e-6 } (supply, tank); }";
    let helps = helps(text, codes::FIXED_RESISTOR);
    let typed = "`Se earth { effort: 0.0 } -> tank;`";
    let expected = format!("hold `tank`, where it is a ground or a tank: {typed}");
    assert_eq!(helps[0], expected);
    for help in [&helps[0], &helps[2]] {
        compiles(&followed(text, help));
    }
}

/// Laws of diodes are turned round by iteration, and cannot be written otherwise: they are of the library.
#[test]
fn a_bridge_of_diodes_is_told_what_solves_it() {
    let bridge = "0 a; 0 b; 0 p; 0 n; Se earth { effort: 0.0 } -> n; 1 winding { R wire { resistance: 0.1 } Se grid { effort: 10.0 } }
                  b -> winding; winding -> a; d1: Diode { } (a, p); d2: Diode { } (b, p); d3: Diode { } (n, a);
                  d4: Diode { } (n, b); c: Capacitor { capacitance: 1e-3 } (p, n);";
    let leg = "0 a; 0 p; 0 n; Se earth { effort: 0.0 } -> n; 0 x; Se grid { effort: 10.0 } -> x;
               coil: Inductor { inductance: 1e-3 } (x, a); d1: Diode { } (a, p); d2: Diode { } (n, a);
               c: Capacitor { capacitance: 1e-3 } (p, n);";
    for (text, code) in [
        (bridge, codes::FIXED_RESISTOR),
        (leg, codes::STORAGE_DERIVATIVE),
    ] {
        let text = format!("model M {{ {text} }}");
        let helps = helps(&text, code);
        assert!(helps[0].contains("`causality componentwise;`"), "{helps:?}");
        assert!(
            helps.iter().all(|it| !it.contains("the law of")),
            "{helps:?}"
        );
        compiles(&followed(&text, &helps[0]));
    }
}

/// Not at the pump, whose pressure is imposed.
#[test]
fn of_resistors_in_series_one_more_is_put_between() {
    let cases = [
        (
            "1 first { R wall { effort: f * abs(f) } } 1 second { R bend { effort: 2.0 * f * abs(f) } }",
            "`first -> R damper { conductance: … };`",
        ),
        (
            "1 first; 1 second; 0 drop { R valve { flow: e * abs(e) } } first -> drop; 0 fall { R gate { flow: 2.0 * e * abs(e) } }
             second -> fall;",
            "`between -> R damper { resistance: … };`",
        ),
    ];
    for (resistors, typed) in cases {
        let text = format!(
            "model M {{ 0 source; 0 between; 0 end; Se pump {{ effort: 2.0 }} -> source; {resistors}
             source -> first; first -> between; between -> second; second -> end; Se tank {{ effort: 0.0 }} -> end;
             integral volume = first.f; output flow = volume; }}"
        );
        let helps = helps(&text, codes::FIXED_RESISTOR);
        let help = helps.last().unwrap();
        assert_eq!(
            *help,
            format!(
                "attach a resistor that can give the {}: {typed}",
                if typed.contains("cond") {
                    "flow"
                } else {
                    "effort"
                }
            )
        );
        compiles(&followed(&text, help));
    }
}

#[test]
fn parallel_axes_of_a_joint_are_told_at_the_axes() {
    let scene = |joint: &str, axes: &str| {
        format!(
            "#[derivative] model M {{ causality componentwise; 1 ground[6]; 1 arm[6]; Sf still[6] {{ flow: 0.0 }} -> ground;
             joint: {joint} {{\n{axes} }} (ground, arm); body: Body {{ mass: 1.0, inertia: 1.0 }} (arm); }}"
        )
    };
    let cases = [
        ("Universal", "first: 1, second: 1", 19),
        ("Universal", "second: 0", 9),
        ("Universal", "first: 1", 8),
        ("Spherical", "first: 2, second: 0, third: 0", 29),
    ];
    for (joint, axes, column) in cases {
        let text = scene(joint, axes);
        let report = diagnose(&text).list()[0].clone();
        let parallel = "the axes of two turns in a row are parallel";
        assert!(report.message.contains(parallel), "{}", report.message);
        let start = report.span.start();
        assert_eq!((start.line, start.column), (3, column - 1), "{axes}");
        let names = ["first", "second", "third"];
        for help in helps(&text, codes::EXPRESSION) {
            for written in help.split('`').skip(1).step_by(2) {
                let axes = names.iter().zip(written.split(", "));
                let axes = axes.map(|(name, axis)| format!("{name}: {axis}"));
                let start = ["", ", initial: [0.1, 0.2, 0.3]"][usize::from(joint == "Spherical")];
                let axes = axes.collect::<Vec<_>>().join(", ") + start;
                compiles(&scene(joint, &axes));
            }
        }
    }
}

#[test]
fn what_a_loop_makes_is_marked_where_it_is_written() {
    let element = "model M { Se air { effort: 1.0 } -> cells[0].node;
                   cells: for k in 0..1 { 0 node { C heat { compliance: 1.0 } } } }";
    let help = helps(element, codes::STORAGE_DERIVATIVE).remove(0);
    assert!(
        help.contains("before `C heat` to accept it: `#[derivative] C heat { … }`"),
        "{help}"
    );
    compiles(&followed(element, &help));

    let component =
        "component Cell(port p) { 0 node { C heat { compliance: 1.0 } } p -> node; }
                     model M { 0 air { Se s { effort: 1.0 } } cells: for k in 0..1 { cell: Cell (air); } }";
    let help = helps(component, codes::STORAGE_DERIVATIVE).remove(0);
    assert!(
        help.contains("before `cell: …`, which makes `cells[0].cell`"),
        "{help}"
    );
    compiles(&component.replace("cell: Cell", "#[derivative] cell: Cell"));
}

/// All codes that a text is answered with.
fn codes_of(text: &str) -> Vec<&'static str> {
    let diagnostics = diagnose(text);
    let list = diagnostics.list().iter();
    list.map(|it| it.code.text).collect()
}

#[test]
fn a_word_that_is_misspelt_is_told_alone_with_the_word_that_is_meant() {
    let scene = |joint: &str, body: &str| {
        format!(
            "#[derivative] model M {{ gravity [0.0, 0.0, -9.81]; 1 arm[6]; 1 world[6]; Sf ground[6] {{ flow: 0.0 }} -> world;
             hinge: {joint} (world, arm); body: {body} (arm); output angle: rad = hinge.angle; }}"
        )
    };
    let (joint, body) = ("Revolute { axis: 1 }", "Body { mass: 1.0, inertia: 0.1 }");
    compiles(&scene(joint, body));
    let misspelt = [
        (scene("Revolut { axis: 1 }", body), "Revolute"),
        (scene("Revolute { axs: 1 }", body), "axis"),
        (scene(joint, "Body { mas: 1.0, inertia: 0.1 }"), "mass"),
        (scene(joint, body).replace("(world,", "(wrld,"), "world"),
        (
            "model M { 1 a { I m { inertia: 1.0 } R r { resistnce: 1.0 } } output e = r.e; }"
                .to_owned(),
            "resistance",
        ),
    ];
    for (text, meant) in misspelt {
        let diagnostics = diagnose(&text);
        let told: Vec<String> = diagnostics.list().iter().map(|it| it.text()).collect();
        assert_eq!(told.len(), 1, "{}", told.join("\n"));
        let help = format!("did you mean `{meant}`?");
        assert!(diagnostics.list()[0].helps.contains(&help), "{}", told[0]);
    }
    // What is wrong besides is told.
    let both = "model M { 1 a[6]; body: Body { inerta: 0.1 } (a); }";
    assert_eq!(codes_of(both), ["MBG0207", "MBG0214"]);
}

#[test]
fn where_the_rate_of_an_input_is_needed_the_source_acts_through_a_resistor_or_gives_its_rate() {
    let texts = [
        "model M { input u: m/s; 1 a { I m { inertia: 2.0 } } Sf s { flow: u } -> a; }",
        "model M { input u: V; 0 a { C m { compliance: 2.0 } } Se s { effort: u } -> a; }",
    ];
    let marked = |text: &str| {
        text.replace("{ I", "{ #[derivative] I")
            .replace("{ C", "{ #[derivative] C")
    };
    for text in texts {
        let told = helps(text, codes::STORAGE_DERIVATIVE);
        // Where the mark stands it is not asked for.
        let without = told
            .iter()
            .map(|help| help.replace("write `#[derivative]`, and ", ""));
        let without: Vec<String> = without.collect();
        assert_ne!(told, without);
        assert_eq!(helps(&marked(text), codes::ORDER_LOST_UNSUPPORTED), without);
        let helps = told;
        assert_eq!(helps.len(), 3, "{helps:?}");
        let driven = text.replace("-> a;", "-> driven;");
        compiles(&followed(&driven, &helps[0]));
        let typed: Vec<&str> = helps[1].split('`').skip(1).step_by(2).collect();
        let rate = text.replace(typed[1], typed[2]);
        compiles(&marked(&rate));
        compiles(&marked(
            &text
                .replace("flow: u", "flow: 2.0 * t")
                .replace("effort: u", "effort: 2.0 * t"),
        ));
    }
}

#[test]
fn a_transformer_that_is_drawn_the_wrong_way_is_turned_round() {
    let text = "model M { param d = 0.5; 0 dc { C c { compliance: 1.0 } }
                1 load[2] { I l { inertia: 1.0 } R r { resistance: 1.0 } }
                dc -> MTF t { flow: [[d], [1.0 - d]] } -> load; }";
    let helps = helps(text, codes::STORAGE_DERIVATIVE);
    let (before, after) = (
        "dc -> MTF t { flow: [[d], [1.0 - d]] } -> load;",
        "[[d], [1.0 - d]]",
    );
    let turned = helps[1].split('`').nth(5).unwrap().replace('…', after);
    compiles(&text.replace(before, &turned));
    // Both storages are forced by one cause, which is told once.
    assert_eq!(codes_of(text), ["MBG0301"]);
    let typed = helps[0]
        .split('`')
        .filter(|typed| typed.starts_with("#[derivative] "));
    let accepted = typed.fold(text.to_owned(), |text, typed| {
        let typed = typed.trim_end_matches("{ … }");
        text.replace(typed.trim_start_matches("#[derivative] "), typed)
    });
    compiles(&accepted);
}

#[test]
fn a_choice_of_other_languages_is_written_with_if() {
    let laws = ["f > 0.0 ? f : 2.0 * f", "2.0 * (f > 0.0 ? f : 2.0 * f)"];
    for law in laws {
        let text =
            format!("model M {{ 1 a {{ I m {{ inertia: 1.0 }} R r {{ effort: {law} }} }} }}");
        let helps = helps(&text, codes::SYNTAX);
        assert_eq!(helps, ["write `if f > 0.0 { f } else { 2.0 * f }`"]);
        compiles(&text.replace("f > 0.0 ? f : 2.0 * f", helps[0].split('`').nth(1).unwrap()));
    }
}

#[test]
fn a_law_that_is_zero_is_told_at_its_element() {
    let cases = [
        (
            "0 n { C c { compliance: 1.0 } R r { resistance: 0.0 } }",
            "resistor `r` would have to give its flow",
        ),
        (
            "1 n { I i { inertia: 1.0 } R r { conductance: 0.0 } }",
            "resistor `r` would have to give its effort",
        ),
        (
            "0 n { C c { compliance: 0.0 } }",
            "the compliance of `c` is zero, and its law divides by it",
        ),
    ];
    for (body, message) in cases {
        let diagnostics = diagnose(&format!("model M {{ {body} }}"));
        let [report] = diagnostics.list() else {
            panic!("{body}")
        };
        assert!(report.message.starts_with(message), "{}", report.message);
    }
    compiles("model M { 1 n { I i { inertia: 1.0 } R r { resistance: 0.0 } } }");
    let gas = "component Gas(port at) { param n; at -> C c { effort: q / (n - 1) }; }
               model M { 0 n { R r { resistance: 1.0 } } gas: Gas { n: 1.0 } (n); }";
    assert_eq!(diagnose(gas).list()[0].notes[0], "`n - 1` is zero");
}

#[test]
fn a_storage_given_its_effort_or_flow_at_the_start_is_told_its_state() {
    let text = "model M { param c: F = 1.0; param k: N/m = 1.0; param m: kg = 1.0; param v: V = 1.0;
                param g: N = 1.0; param w: m/s = 1.0; 0 n { C a { compliance: c, initial: v } R r { resistance: 1.0 } }
                1 j { C b { stiffness: k, initial: g } I i { inertia: m, initial: w } } }";
    let mut mended = text.to_owned();
    for (before, after) in [
        ("initial: v", "initial_effort: v"),
        ("initial: g", "initial_effort: g"),
        ("initial: w", "initial_flow: w"),
    ] {
        let helps = helps(&mended, codes::UNIT_MISMATCH);
        assert_eq!(helps, [format!("write `{after}`")]);
        mended = mended.replace(before, after);
    }
    compiles(&mended);
}

#[test]
fn an_output_of_another_dimension_than_its_value_is_told_both_ways() {
    let text = "model M { 1 arm[3] { I m { inertia: 1.0 } } output w: m/s = arm.f; }";
    let helps = helps(text, codes::WRONG_DIMENSION);
    assert_eq!(helps.len(), 2, "{helps:?}");
    for help in helps {
        compiles(&text.replace("output w: m/s = arm.f;", help.split('`').nth(1).unwrap()));
    }
}

#[test]
fn joints_between_one_frame_or_the_same_two_are_told_by_name() {
    let scene = |joints: &str| {
        format!(
            "#[derivative] model M {{ gravity [0.0, 0.0, -9.81]; 1 arm[6]; 1 world[6]; Sf ground[6] {{ flow: 0.0 }} -> world;
             body: Body {{ mass: 1.0, inertia: 0.1 }} (arm); {joints} }}"
        )
    };
    for itself in [
        "hinge: Revolute { axis: 1 } (arm, arm);",
        "hinge: Cut (arm, arm);",
    ] {
        let diagnostics = diagnose(&scene(itself));
        let [report] = diagnostics.list() else {
            panic!("{itself}")
        };
        assert_eq!(report.message, "`hinge` leads from `arm` to itself");
    }
    let twice =
        scene("one: Revolute { axis: 1 } (world, arm); other: Revolute { axis: 1 } (world, arm);");
    let diagnostics = diagnose(&twice);
    let message = "`one`, `other` impose the same flows: how they share the efforts is open";
    assert_eq!(diagnostics.list()[0].message, message);
    let helps = helps(&twice, codes::SINGULAR_JUNCTIONS);
    let typed = helps[1].split('`').nth(1).unwrap();
    compiles(&twice.replace(
        "other: Revolute { ",
        &format!("other: Revolute {{ {typed}, "),
    ));
    // Both chambers of a cylinder may be one node.
    compiles(
        "model M { 0 node { C oil { stiffness: 1.0 } } 1 rod { I mass { inertia: 1.0 } }
         piston: Cylinder { area_a: 2.0, area_b: 1.0 } (node, node, rod); }",
    );
}

#[test]
fn a_mass_without_extent_on_a_ball_joint_is_told_what_it_lacks() {
    let text = "model M { gravity [0.0, 0.0, -9.81]; 1 arm[6]; 1 tip[6]; 1 world[6]; Sf ground[6] { flow: 0.0 } -> world;
                ball: Spherical (world, arm); rod: Offset { by: [1.0, 0.0, 0.0] } (arm, tip);
                #[derivative] weight: PointMass { mass: 1.0 } (tip); }";
    let report = diagnose(text).list()[0].clone();
    assert_eq!(report.code, codes::SINGULAR_JUNCTIONS);
    assert!(
        report.message.ends_with("at `weight.body`"),
        "{}",
        report.message
    );
    compiles(&text.replace(
        "PointMass { mass: 1.0 }",
        "Body { mass: 1.0, inertia: 0.1 }",
    ));
}

#[test]
fn a_name_given_twice_is_told_alone() {
    let elements = "model M { 0 n { C c { compliance: 1.0 } R rs { resistance: 2.0 } } 1 k { R rs { resistance: 1.0 } }
                    n -> k; output y = rs.q; }";
    assert_eq!(codes_of(elements), ["MBG0202"]);
    let values =
        "model M { 0 n { C c { compliance: 1.0 } } let rs = 1.0; 1 rs { R r { resistance: 2.0 } }
                  n -> rs; output y = rs.e; }";
    assert_eq!(codes_of(values), ["MBG0202"]);
}

/// A joint or a body of the plane at frames in space is told what it is called there, and the other way round.
#[test]
fn components_are_told_by_their_names_in_the_other_space() {
    let model = |dimension: usize, joint: &str, body: &str| {
        format!(
            "#[derivative] model M {{ 1 ground[{dimension}]; 1 b[{dimension}]; Sf held[{dimension}] {{ flow: 0.0 }} -> ground;
             hinge: {joint} (ground, b); load: {body} {{ mass: 1.0, inertia: 0.1 }} (b); }}"
        )
    };
    let [plane, space] = ["PlanarRevolute {}", "Revolute { axis: 2 }"];
    let in_space = helps(&model(6, plane, "Body"), codes::WRONG_DIMENSION);
    assert_eq!(in_space, ["write `Revolute`, which is for frames in space"]);
    let in_plane = helps(&model(3, space, "PlanarBody"), codes::WRONG_DIMENSION);
    assert_eq!(
        in_plane,
        ["write `PlanarRevolute`, which is for frames in a plane"]
    );
    // What a joint leaves free in space is all that there is in a plane.
    let [all, plate] = ["PlanarFree {}", "Planar { axis: 2 }"];
    assert_eq!(
        helps(&model(3, plate, "PlanarBody"), codes::WRONG_DIMENSION),
        ["write `PlanarFree`, which is for frames in a plane"]
    );
    compiles(&model(6, space, "Body"));
    compiles(&model(6, plate, "Body"));
    compiles(&model(3, plane, "PlanarBody"));
    compiles(&model(3, all, "PlanarBody"));
}

/// A storage whose variable a source gives is left out or the source is let act through something.
#[test]
fn a_storage_across_a_source_is_told_first() {
    let driven = |coil: &str| {
        format!(
            "model M {{ input amp: A; 1 v {{ Sf s {{ flow: amp }} {coil} C c {{ stiffness: 1.0 }} }} output y = s.e; }}"
        )
    };
    let told = helps(
        &driven("I coil { inertia: 1.0 }"),
        codes::STORAGE_DERIVATIVE,
    );
    assert_eq!(told[0], "remove `coil`, whose effort only `s` would feel");
    assert!(told[1].starts_with("remove `s`"), "{told:?}");
    compiles(&driven(""));
}

#[test]
fn a_nonlinear_storage_across_a_source_is_told_no_other() {
    let across = |beside: &str| {
        format!(
            "#[derivative] model M {{ 0 n {{ Se s {{ effort: 2.0 + sin(t) }} C c {{ effort: q + powi(q, 3) }} {beside} }}
             1 w {{ I l {{ inertia: 1.0 }} R r {{ resistance: 10.0 }} }} n -> w; }}"
        )
    };
    let told = helps(&across(""), codes::ORDER_LOST_UNSUPPORTED);
    assert_eq!(told, ["put a resistor between `c` and `s`"]);
}

#[test]
fn a_vector_input_whose_rate_is_needed_is_told_once() {
    let text = |input: &str| {
        format!(
            "#[derivative] model M {{ {input} 1 v[3] {{ Sf drive {{ flow: speed }} I m {{ inertia: 2.0 }} }}
             output force[3] = drive.e; }}"
        )
    };
    let vector = text("input speed[3]: m/s;");
    assert_eq!(diagnose(&vector).list().len(), 1);
    let told = helps(&vector, codes::ORDER_LOST_UNSUPPORTED);
    assert!(
        told[1].starts_with("in the place of `input speed[3]: m/s;`"),
        "{told:?}"
    );
    compiles(&text(
        "input speed_rate[3]; integral speed[3]: m/s = speed_rate;",
    ));
}

/// A platform on a leg without mass, whose length is a state, and a cut at the end of it.
#[test]
fn a_leg_without_mass_is_a_line_or_in_a_ring() {
    let scene = |leg: &str| {
        format!(
            "#[derivative] model M {{ causality componentwise; gravity [0.0, 0.0, -9.81];
             1 ground[6]; 1 platform[6]; 1 eye[6]; Sf fixed[6] {{ flow: 0.0 }} -> ground;
             free: Free {{ orientation: quaternion, initial_position: [0.0, 0.0, 1.0] }} (ground, platform);
             load: Body {{ mass: 2.0, inertia: diag(0.1, 0.2, 0.3), centre: [0.1, 0.2, 0.3] }} (platform);
             to_eye: Offset {{ by: [0.1, 0.0, 0.0] }} (platform, eye); {leg} }}"
        )
    };
    let leg = |end: &str| {
        scene(&format!(
            "1 lower[6]; 1 upper[6]; cross: Universal {{ first: 0, second: 1, initial: [0.0, 0.1] }} (ground, lower);
             piston: Prismatic {{ axis: 2, initial: 1.0, stiffness: 100.0 }} (lower, upper); ball: {end} (upper, eye);"
        ))
    };
    let typed = helps(&leg("Cut"), codes::ORDER_LOST_UNSUPPORTED);
    let helps = typed.join("\n");
    for (word, followed) in [
        (
            "LineForce",
            scene("leg: LineForce { stiffness: 100.0, rest: 1.0 } (ground, eye);"),
        ),
        ("Rod", scene("leg: Rod { length: 1.0 } (ground, eye);")),
        ("Spherical", leg("Spherical { orientation: quaternion }")),
    ] {
        assert!(helps.contains(&format!("`{word}`")), "{word}: {helps}");
        compiles(&followed);
    }
    assert!(
        helps.contains("in the place of its joints and of `ball`"),
        "{helps}"
    );
    compiles(&leg("Cut").replace(
        "ball:",
        "rod: Body { mass: 1.0, inertia: diag(0.1, 0.1, 0.01) } (upper);
         cylinder: Body { mass: 1.0, inertia: diag(0.1, 0.1, 0.01) } (lower); ball:",
    ));
}

/// A rope whose length at rest changes needs its rate.
#[test]
fn a_rope_that_is_wound_up_is_given_the_rate() {
    let scene = |more: &str| {
        format!(
            "model M {{ input winch: m/s; integral rest: m = winch, initial: 1.0; gravity [0.0, 0.0, -9.81];
             1 ground[6]; 1 stone[6]; Sf fixed[6] {{ flow: 0.0 }} -> ground;
             free: Free {{ initial_position: [0.0, 0.0, -1.0] }} (ground, stone);
             rock: Body {{ mass: 2.0, inertia: 0.1 }} (stone);
             rope: LineForce {{ kind: rope, stiffness: 100.0, rest: rest{more} }} (ground, stone); }}"
        )
    };
    let helps = helps(&scene(""), codes::DISPLACEMENT);
    assert!(
        helps[0].contains("`rest_rate` of a `LineForce`"),
        "{helps:?}"
    );
    compiles(&scene(", rest_rate: winch"));
}

/// A row that is written as a vector, and a matrix the other way round; what fits neither way is left alone.
#[test]
fn matrices_of_two_ports_are_transposed() {
    let model = |law: &str| {
        let parts = "1 a[2] { I m { inertia: 1.0 } } 1 b { R r { resistance: 1.0 } }";
        format!("model M {{ {parts} a -> {law} -> b; }}")
    };
    for (wrong, right) in [
        ("TF t { flow: [3.0, 4.0] }", "TF t { flow: [[3.0, 4.0]] }"),
        (
            "TF t { flow: [3.0, 4.0] }",
            "TF t { flow: transpose([3.0, 4.0]) }",
        ),
        (
            "GY g { effort: [[3.0], [4.0]] }",
            "GY g { effort: transpose([[3.0], [4.0]]) }",
        ),
    ] {
        let diagnostics = diagnose(&model(wrong));
        assert_eq!(diagnostics.list().len(), 2);
        for told in diagnostics.list() {
            assert_eq!(told.code, codes::WRONG_DIMENSION);
            assert_eq!(told.helps.len(), 1, "{}", told.text());
            assert!(
                told.helps[0].contains("`transpose(…)`")
                    && told.text().contains("1 of 2 numbers, and this has 2 of 1")
            );
        }
        compiles(&model(right));
    }
    assert!(
        helps(
            &model("TF t { flow: [3.0, 4.0, 5.0] }"),
            codes::WRONG_DIMENSION
        )
        .is_empty()
    );
}

#[test]
fn sources_that_are_given_together_are_added() {
    let text =
        |junction: &str| format!("model M {{ {junction} 1 b {{ I n {{ inertia: 1.0 }} }} }}");
    for (together, added) in [
        (
            "1 a { Sf one { flow: 1.0 } Sf two { flow: 2.0 } R r { resistance: 1.0 } }",
            "0 sum { Sf one { flow: … } Sf two { flow: … } } sum -> a;",
        ),
        (
            "0 a[2] { Se one { effort: 1.0 } Se two { effort: 2.0 } R r { resistance: 1.0 } }",
            "1 sum[2] { Se one { effort: … } Se two { effort: … } } sum -> a;",
        ),
    ] {
        let found = helps(&text(together), codes::SOURCES_CONFLICT);
        assert_eq!(
            found,
            [
                "remove one of `one`, `two`".to_owned(),
                format!(
                    "where their {} add up: `{added}`",
                    if added.starts_with('0') {
                        "flows"
                    } else {
                        "efforts"
                    }
                )
            ]
        );
        let (junction, _) = together.split_once('{').unwrap();
        compiles(&text(&format!(
            "{junction} {{ R r {{ resistance: 1.0 }} }} {}",
            added.replace('…', "1.0")
        )));
    }
}
