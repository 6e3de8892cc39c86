//! Units: which models agree in them, and what is told where they do not.
#![allow(clippy::unwrap_used)]

#[path = "told/mod.rs"]
mod reports;

use mbg_compiler::diagnostics::Diagnostic;

fn diagnose(text: &str) -> Vec<Diagnostic> {
    reports::diagnose(text).list().to_vec()
}

/// What is told of a text with one mistake: where, in the text, and what.
fn told(text: &str) -> (String, String) {
    let found = diagnose(text);
    let [only] = &found[..] else {
        panic!("one mistake in {text}, found {found:#?}")
    };
    let place = only.span.start();
    let line = text.lines().nth(place.line - 1).unwrap();
    let place: String = line.chars().skip(place.column).collect();
    (place, only.text())
}

/// A mass of known unit at a 1-junction, with more statements.
fn mass(body: &str) -> String {
    format!("model M {{ param mass: kg = 1.0; 1 a {{ I m {{ inertia: mass }} }} {body} }}")
}

/// Statements beside the mass, the text from the place of the mistake on, and what is told.
const MISTAKES: &[(&str, &str, &str)] = &[
    (
        "param k: N*m/rad = 1.0; a -> C c { stiffness: k };",
        "k }",
        "`stiffness` of `c` must be `N/m` here, and this is `N*m`",
    ),
    (
        "param z: ohm = 1.0; a -> R r { resistance: z };",
        "z }",
        "`resistance` of `r` must be `N*s/m` here, and this is `ohm`",
    ),
    (
        "param g: S = 1.0; a -> R r { conductance: g };",
        "g }",
        "`conductance` of `r` must be `m/s/N` here, and this is `S`",
    ),
    (
        "param force: N = 1.0; param way: m = 1.0; Se s { effort: 2.0 * (force + way) } -> a;",
        "+ way",
        "`force` is `N` and `way` is `m`: they are neither added nor compared",
    ),
    (
        "param way: m = 1.0; Se s { effort: 3.0 * sin(way) } -> a;",
        "sin(way)",
        "`sin` takes a pure number or an angle, and `way` is `m`",
    ),
    (
        "param way: m = 1.0; Se s { effort: 3.0 * floor(way) } -> a;",
        "floor(way)",
        "`mod` takes two values of one unit, `floor` and `fraction` a pure number or an angle: whole multiples are counted of `way`, \
         which is `m`",
    ),
    (
        "param w: rad/s = 1.0; Se s { effort: 3.0 * exp(w) } -> a;",
        "exp(w)",
        "`exp` takes a pure number or an angle, and `w` is `1/s`",
    ),
    (
        "let weight: N = mass * 9.81; let heavy: N = weight + mass * 1;",
        "+ mass",
        "`weight` is `N` and `mass` is `kg`",
    ),
    (
        "let speed: m/s = a.f; let wrong: m = speed;",
        "speed;",
        "`wrong` is declared in `m`, and this is `m/s`",
    ),
    (
        "output speed: m = a.f;",
        "a.f;",
        "`speed` is declared in `m`, and this is `m/s`",
    ),
    (
        "integral way: m = m.p;",
        "m.p;",
        "the rate must be `m/s` here, and this is `N*s`",
    ),
    (
        "param goal: m = 1.0; integral way: m = goal - way;",
        "goal -",
        "the rate must be `m/s` here, and this is `m`",
    ),
    (
        "param start: m/s = 1.0; integral way: m = a.f, initial: start;",
        "start;",
        "`initial` must be `m` here, and this is `m/s`",
    ),
    (
        "param start: m/s = 1.0; a -> C c { stiffness: 1.0, initial: start };",
        "start }",
        "`initial` of `c` must be `m` here, and this is `m/s`",
    ),
    (
        "param r: m = 1.0; param j: kg = 1.0; a -> TF t { flow: r } -> b; 1 b { C c { stiffness: j } }",
        "r }",
        "`flow` of `t` must be",
    ),
    (
        "param k: N*m/A = 1.0; param h: H = 1.0; a -> GY t { effort: k } -> b; 0 b { C l { compliance: h } }",
        "k }",
        "`effort` of `t` must be",
    ),
    (
        "param h: H = 1.0; 1 b { I l { inertia: h } } 0 n { R r { resistance: 1.0 } } a -> n; n -> b;",
        "-> b",
        "`n -> b` joins efforts: `N` before it, `V` after it",
    ),
    (
        "output y = interpolate(a.f, [0, mass], [0.0, 1.0]);",
        "interpolate(",
        "`a.f` is `m/s` and `mass` is `kg`",
    ),
    (
        "output y = interpolate(t, [0, 1], [mass, mass * a.f]);",
        "interpolate(",
        "`mass` is `kg` and",
    ),
    (
        "output y: m = interpolate(a.f, [0, 1], [0, mass]);",
        "interpolate(",
        "`y` is declared in `m`, and this is `kg`",
    ),
    (
        "param x: m = 1.0; param y: s = 1.0; output z = atan2(x, y);",
        "atan2(",
        "`x` is `m` and `y` is `s`",
    ),
    (
        "param x: m = 1.0; output z = 2.0 * atan(x);",
        "atan(",
        "`atan` takes a pure number or an angle, and `x` is `m`",
    ),
    (
        "param x: m = 1.0; output z: m = atan(x / 2.0 / x);",
        "atan(",
        "`z` is declared in `m`, and this is a pure number",
    ),
    (
        "param x: m = 1.0; param n = 1.5; output z: m = pow(x, 1.5) / sqrt(x); output y = pow(x, n);",
        "pow(",
        "`pow` takes a pure number or an angle, and `x` is `m`",
    ),
    (
        "param x: m = 1.0; output z: m = pow(x, 1.5);",
        "pow(",
        "`z` is declared in `m`, and this is `m^(3/2)`",
    ),
    (
        "param x: m = 1.0; output z = max(x, mass);",
        "max(",
        "`x` is `m` and `mass` is `kg`",
    ),
];

#[test]
fn a_mistake_is_told_at_its_token_with_both_units() {
    for (body, place, message) in MISTAKES {
        let (found, text) = told(&mass(body));
        assert!(found.starts_with(place), "{body}: at `{found}`\n{text}");
        assert!(text.starts_with(message), "{body}: {text}");
    }
}

#[test]
fn models_whose_units_agree_are_silent() {
    for text in [
        // Without a unit nothing is looked at.
        "model M { param k = 1.0; 1 a { I m { inertia: 1.0 } R r { effort: k * f + f * f + sin(t) } } }",
        // A number with a decimal point carries any unit, a number in its place, too.
        &mass("Se s { effort: 9.81 * mass + 3 + 2.0 * sin(3.0 * t) } -> a; a -> R r { effort: 2.0 * f * abs(f) };"),
        // Whole numbers count.
        &mass("output energy: J = mass * powi(a.f, 2) / 2; output twice: N*s = 2 * m.p;"),
        // A root halves the powers.
        &mass("param k: N/m = 1.0; output w: rad/s = sqrt(k / mass); output e: J = sqrt(mass * mass) * powi(a.f, 2);"),
        // Points of a curve have the units of what is looked up and of what is found, counted or not.
        &mass("param knee: m/s = 2.0; let forces = [-3.0, 0, 4, 9.81 * mass];
            a -> R r { effort: interpolate(f, [-1, 0, knee, 5.0], forces) };
            output force: N = interpolate(a.f, [0, 1], [0, 1]);"),
        // What is not declared follows.
        &mass("param k = 1.0; a -> C c { stiffness: k }; output x: m = c.q; output force: N = k * c.q;"),
        // An arc tangent is an angle, of a slope or an angle.
        &mass("param x: m = 2.0; output slope: rad = atan(x / 3.0) + atan(x / c.q) + atan(t / 2.0); a -> C c { stiffness: 1.0 };"),
        // Half radians are none.
        &mass("output angle: rad = c.q / 2.0; a -> C c { stiffness: 1.0 }; output hertz: Hz = a.f / c.q;"),
        // Each component has its own.
        "model M { param inertia: kg*m^2 = 1.0; param mass: kg = 1.0; param r: m = 1.0;
            1 frame[6] { I m { inertia: diag(inertia, inertia, inertia, mass, mass, mass) } R air { resistance: 1.0 } }
            1 tip[3] { C c { stiffness: 2.0 } }
            0 sum[3]; frame[3..6] -> sum; sum -> tip;
            frame[0..3] -> MTF lever { flow: transpose(skew([0.0, 0.0, r])) } -> sum;
            output speed: m/s = frame.f[3]; output rate: rad/s = frame.f[0]; output way[3]: m = c.q; }",
        // Heat is its own power.
        "model M { param capacity: J/K = 1.0; param loss: W/K = 1.0; causality componentwise;
            0 wall pseudo { C c { compliance: capacity, initial: 300.0 } R r { conductance: loss } }
            output temperature: K = wall.e; output heat: J = c.q; }",
    ] {
        let told: Vec<String> = diagnose(text).iter().map(Diagnostic::text).collect();
        assert!(told.is_empty(), "{text}: {told:#?}");
    }
}

#[test]
fn a_unit_that_would_scale_values_is_answered_with_the_text_to_type() {
    for (unit, place, help) in [
        ("mm", "mm", "write `m`, and each value times 0.001"),
        ("N/mm", "mm", "write `N/m`, and each value times 1000"),
        ("kN*m", "kN", "write `N*m`, and each value times 1000"),
        (
            "L/min",
            "L",
            "write `m^3/s`, and each value times 0.000016666666666666667",
        ),
        ("uF", "uF", "write `F`, and each value times 1e-6"),
        ("g", "g", "write `kg`, and each value times 0.001"),
        ("mg", "mg", "write `kg`, and each value times 1e-6"),
        ("bar", "bar", "write `Pa`, and each value times 1e5"),
        (
            "deg",
            "deg",
            "write `rad`, and each value times 0.017453292519943295",
        ),
        (
            "degrees",
            "degrees",
            "write `rad`, and each value times 0.017453292519943295",
        ),
        (
            "hp",
            "hp",
            "write `W`, and each value times 745.6998715822702",
        ),
        ("kgf", "kgf", "write `N`, and each value times 9.80665"),
        (
            "lbf*ft",
            "lbf",
            "write `N*m`, and each value times 1.3558179483314003",
        ),
        ("lb", "lb", "write `kg`, and each value times 0.45359237"),
        (
            "slug",
            "slug",
            "write `kg`, and each value times 14.593902937206364",
        ),
        (
            "kt",
            "kt",
            "write `m/s`, and each value times 0.5144444444444445",
        ),
        ("inch", "inch", "write `m`, and each value times 0.0254"),
        ("daN", "daN", "write `N`, and each value times 10"),
        (
            "rpm",
            "rpm",
            "write `rad/s`, and each value times 0.10471975511965977",
        ),
        (
            "degC",
            "degC",
            "write `K`, and temperatures above absolute zero: 20 degrees Celsius are 293.15",
        ),
    ] {
        let (found, text) = told(&mass(&format!("param x: {unit} = 1.0;")));
        assert!(found.starts_with(place), "{unit}: at `{found}`");
        assert!(text.contains("MBG0503") && text.ends_with(help), "{text}");
    }
    // What scales twice may scale nothing.
    assert!(diagnose(&mass("param x: mV/ms = 1.0; output y: V/s = x;")).is_empty());
}

/// A factor there would be a wrong number without a word: one with a decimal point may carry any unit.
#[test]
fn what_is_read_is_in_si_and_takes_no_factor() {
    for (statement, help) in [
        (
            "output y: mm = x;",
            "write `m`, which is what the value has: what is read is in SI",
        ),
        (
            "output y: mm = 2.0 * x;",
            "write `m`, which is what the value has: what is read is in SI",
        ),
        (
            "let y: mm = 2.0 * x; output z = y;",
            "write `m`, which is what the value has: what is read is in SI",
        ),
        (
            "integral y: mm = m.f; output z = y;",
            "write `m`, which is what the value has: what is read is in SI",
        ),
        (
            "integral y: mm = 2.0; output z = y;",
            "write `m`, and each value times 0.001",
        ),
        (
            "let y: mm = 2.0; output z = y;",
            "write `m`, and each value times 0.001",
        ),
        (
            "output y: mm = 2.0;",
            "write `m`, and each value times 0.001",
        ),
    ] {
        let (found, text) = told(&mass(&format!("param x: m = 1.0; {statement}")));
        assert!(found.starts_with("mm"), "{statement}: at `{found}`");
        assert!(text.contains("MBG0503") && text.ends_with(help), "{text}");
    }
}

#[test]
fn a_unit_in_another_spelling_is_answered_with_the_text_to_type() {
    for (unit, place, help) in [
        ("Ohm", "Ohm", "write `ohm`"),
        ("N*Ohms", "Ohms", "write `N*ohm`"),
        ("HZ", "HZ", "write `Hz`"),
        ("v/m", "v", "write `V/m`"),
        ("rad/sec", "sec", "write `rad/s`"),
        ("Kg", "Kg", "write `kg`"),
        ("KN", "KN", "write `N`, and each value times 1000"),
        (
            "degrees/sec",
            "sec",
            "write `rad/s`, and each value times 0.017453292519943295",
        ),
        // Units side by side.
        ("Nm", "Nm", "write `N*m`"),
        ("Nms", "Nms", "write `N*m*s`"),
        ("Ns", "Ns", "write `N*s`"),
        ("Vs", "Vs", "write `V*s`"),
        ("Pas", "Pas", "write `Pa*s`"),
        ("Nm/rad", "Nm", "write `N*m/rad`"),
        ("kgm", "kgm", "write `kg*m`"),
        ("kgm^2", "kgm", "write `kg*m^2`"),
        ("J/kgK", "kgK", "write `J/kg/K`"),
        ("W/m2K", "m2K", "write `W/m^2/K`"),
        ("W/Km", "Km", "write `W/K/m`"),
        ("kNm", "kNm", "write `N*m`, and each value times 1000"),
        ("mNm", "mNm", "write `N*m`, and each value times 0.001"),
        ("Nmm", "Nmm", "write `N*m`, and each value times 0.001"),
        // Digits behind them.
        ("m3/s", "m3", "write `m^3/s`"),
        ("m/s2", "s2", "write `m/s^2`"),
        ("kg*m2", "m2", "write `kg*m^2`"),
        ("1/kgm2", "kgm2", "write `1/kg/m^2`"),
        ("cm3", "cm3", "write `m^3`, and each value times 1e-6"),
    ] {
        let (found, text) = told(&mass(&format!("output x: {unit} = 1.0;")));
        assert!(found.starts_with(place), "{unit}: at `{found}`");
        assert!(text.contains("MBG0502") && text.ends_with(help), "{text}");
        let written = help.split('`').nth(1).unwrap();
        let mended = diagnose(&mass(&format!("output x: {written} = 1.0;")));
        assert!(mended.is_empty(), "{unit}: {mended:#?}");
    }
    // What differs by a letter may be another quantity.
    for unit in ["furlong", "kkg", "lmn", "mo", "P"] {
        let (_, text) = told(&mass(&format!("param x: {unit} = 1.0;")));
        let help = "help: units are products of powers of kg, m, s, A, K";
        assert!(
            text.contains(help) && !text.contains("did you mean"),
            "{text}"
        );
    }
}

/// `mK` below a stroke, and a digit with the unit behind it, which are one token.
#[test]
fn metres_and_kelvins_side_by_side_are_told_apart() {
    for (unit, first, second) in [
        ("W/mK", "`W/m/K`", "`W/K`, and each value times 1000"),
        ("W/(mK)", "`W/m/K`", "`W/K`, and each value times 1000"),
        ("mW/mK", "`W/m/K`, and each value times 0.001", "`W/K`"),
    ] {
        let (found, text) = told(&mass(&format!("param x: {unit} = 1.0;")));
        assert!(found.starts_with("mK"), "{unit}: at `{found}`");
        let helps = format!("help: write {first}\n  help: write {second} where `mK` is one unit");
        assert!(text.ends_with(&helps), "{text}");
    }
    for (unit, written) in [("W/m^2K", "W/m^2/K"), ("m^3s", "m^3*s")] {
        let (_, text) = told(&mass(&format!("param x: {unit} = 1.0;")));
        assert!(
            text.ends_with(&format!("help: write `{written}`")),
            "{text}"
        );
        let mended = diagnose(&mass(&format!("param x: {written} = 1.0;")));
        assert!(mended.is_empty(), "{mended:#?}");
    }
    let (_, text) = told(&mass("param x: mK = 1.0;"));
    assert!(
        text.ends_with("help: write `K`, and each value times 0.001"),
        "{text}"
    );
}

#[test]
fn a_mistake_in_an_argument_is_told_at_the_argument() {
    let text = "component Spring(port a) { param stiffness: N/m; a -> C c { stiffness: stiffness }; }
model M { param torsion: N*m/rad = 1.0; 1 a { I m { inertia: 2.0 } } s: Spring { stiffness: torsion } (a); }";
    let (place, text) = told(text);
    assert!(place.starts_with("torsion } (a)"), "{place}");
    assert!(
        text.starts_with("`stiffness` is declared in `N/m`, and this is `N*m`"),
        "{text}"
    );
}

#[test]
fn a_mistake_in_a_loop_is_told_once() {
    let (place, _) = told(&mass(
        "param c: F = 1.0; for k in 0..3 { a -> R r { resistance: c }; }",
    ));
    assert!(place.starts_with("c }"), "{place}");
}

#[test]
fn a_junction_of_pseudo_bonds_is_not_joined_to_another() {
    let text = mass("0 wall pseudo { C c { compliance: 1.0 } } a -> wall;");
    let (place, text) = told(&text);
    assert!(place.starts_with("-> wall"), "{place}");
    assert!(
        text.contains("a junction of pseudo bonds to one of true bonds"),
        "{text}"
    );
}

#[test]
fn heat_flow_times_temperature_is_no_power() {
    let text = "model M { param capacity: J/K = 1.0; param loss: W/K = 1.0;
0 wall { C c { compliance: capacity } R r { conductance: loss } }";
    let (place, told_of) = told(&format!("{text} }}"));
    assert!(place.starts_with("wall {"), "{place}");
    assert!(
        told_of.ends_with(
            "help: write `0 wall pseudo` where effort times flow is no power, as temperature times heat flow"
        ),
        "{told_of}"
    );
    let (place, told_of) = told(&format!("{text} output temperature: K = wall.e; }}"));
    assert!(place.starts_with("wall.e"), "{place}");
    assert!(
        told_of.starts_with("`temperature` is declared in `K`, and this is"),
        "{told_of}"
    );
}

/// Wherever the units first contradict each other, the junctions to mark are named; marked so, the model is sound.
#[test]
fn temperature_with_heat_flow_is_told_to_be_pseudo() {
    let values = "param capacity: J/K = 50.0; param loss: W/K = 0.8; param weather: K = 293.0; input power: W;";
    for (body, junctions) in [
        (
            "0 case { C metal { compliance: capacity } Sf heat { flow: power } }",
            vec!["0 case"],
        ),
        (
            "0 case { C metal { compliance: capacity, initial: capacity * weather } } 0 air { Se w { effort: weather } }
             1 wall { R r { conductance: loss } } case -> wall; wall -> air;",
            vec!["0 case", "0 air", "1 wall"],
        ),
        (
            "0 case[2] { C metal { compliance: 5.0 } Sf heat { flow: [power, power] } } output t[2]: K = case.e;",
            vec!["0 case[2]"],
        ),
        (
            "0 case pseudo; 0 air; Se w { effort: weather } -> air; metal: HeatCapacity { capacity: capacity } (case);
             surface: Conduction { conductance: loss } (case, air);",
            vec!["0 air"],
        ),
        (
            "cells: for k in 0..9 { 0 cell { C heat { compliance: capacity } } }
             links: for k in 0..8 { 1 flow { R r { conductance: loss } } cells[k].cell -> flow -> cells[k + 1].cell; }
             0 air { Se w { effort: weather } } 1 wall { R r { conductance: loss } }
             air -> wall -> cells[0].cell;",
            vec!["0 cell", "1 flow", "0 air", "1 wall"],
        ),
    ] {
        let text = format!("model M {{ {values} {body} }}");
        let list: Vec<String> = junctions.iter().map(|it| format!("`{it} pseudo`")).collect();
        let help = format!("help: write {} where effort times flow", list.join(", "));
        let told: Vec<String> = diagnose(&text).iter().map(Diagnostic::text).collect();
        assert!(!told.is_empty() && told.iter().all(|it| it.contains(&help)), "{told:#?}");
        let marked = junctions.iter().fold(text, |text, junction| {
            text.replacen(junction, &format!("{junction} pseudo"), 1)
        });
        let told: Vec<String> = diagnose(&marked).iter().map(Diagnostic::text).collect();
        assert!(told.is_empty(), "{marked}: {told:#?}");
    }
    // What differs elsewhere is no matter of bonds.
    let (_, text) = told(&mass(
        "param hot: K = 300.0; output heat: W = 2.0 * hot * (a.f / a.f); output x: K = m.p;",
    ));
    assert!(!text.contains("pseudo"), "{text}");
}

/// A law without units says least of what units are: where it contradicts others, it is told and not they.
#[test]
fn a_law_of_numbers_is_the_last_to_say_what_units_are() {
    let text = |law: &str, rest: &str| {
        format!(
            "model M {{ param way: m = 1.0; 1 a {{ I m {{ inertia: 1.0 }} R drag {{ {law} }} }} {rest} }}"
        )
    };
    let speed = "output speed: m/s = a.f;";
    let (place, told_of) = told(&text("effort: f * abs(f)", speed));
    assert!(place.starts_with("f * abs(f)"), "{place}");
    insta::assert_snapshot!(told_of, @"
    `effort` of `drag` must be `N` here, and this is `m^2/s^2` [MBG0501]
      the effort is `N` and the flow `m/s` there
      help: a number with a decimal point carries any unit as a factor: `1.0 * …`; a whole number counts
    ");
    assert!(diagnose(&text("effort: 1.0 * f * abs(f)", speed)).is_empty());
    let told_of = diagnose(&text("effort: tanh(f)", speed));
    assert!(
        told_of[0].text().contains("`drag.f` is `m/s`"),
        "{told_of:#?}"
    );
    assert!(diagnose(&text("effort: 1.0 * tanh(1.0 * f)", speed)).is_empty());
    // Where nothing else is said, neither is a domain.
    assert!(diagnose(&text("effort: f * abs(f)", "output speed = a.f;")).is_empty());
}

#[test]
fn an_angle_declared_in_another_unit_is_answered_with_its_own() {
    let text = |unit: &str, value: &str| {
        format!(
            "model M {{ param k: N*m/rad = 1.0; param j: kg*m^2 = 1.0; 1 a {{ I m {{ inertia: j }} C s {{ stiffness: k }} }}
output x: {unit} = {value}; }}"
        )
    };
    let (place, told_of) = told(&text("m", "s.q"));
    assert!(place.starts_with("s.q"), "{place}");
    assert!(
        told_of.ends_with(
            "
  help: an angle is declared in `rad`
  help: a number with a decimal point carries any unit as a factor: `1.0 * …`; a whole number counts"
        ),
        "{told_of}"
    );
    assert!(diagnose(&text("rad", "s.q")).is_empty());
    assert!(diagnose(&text("m", "1.0 * s.q")).is_empty());
}

/// What an argument reads gives a flow no unit: the frame's own is found by its body, and the argument is told.
#[test]
fn an_argument_that_reads_a_frame_is_told_and_not_the_frame() {
    let text = |force: &str| {
        format!(
            "#[derivative]
            model M {{
                causality componentwise;
                1 ground[6]; 1 rod[6]; 1 tip[6];
                Sf fixed[6] {{ flow: 0.0 }} -> ground;
                hinge: Revolute {{ axis: 1 }} (ground, rod);
                body: Body {{ mass: 1.0, inertia: 1.0 }} (rod);
                end: Offset {{ by: [1.0, 0.0, 0.0] }} (rod, tip);
                drag: Load {{ force: [0.0, 0.0, {force}] }} (tip);
                output angle = hinge.angle;
            }}"
        )
    };
    for (force, unit) in [
        ("-tip.f[5]", "m/s"),
        ("-tip.f[5] * abs(tip.f[5])", "m^2/s^2"),
    ] {
        let (place, told_of) = told(&text(force));
        assert!(place.starts_with("[0.0, 0.0, -tip"), "{place}");
        let expected = format!("`force` is declared in `N`, and this is `{unit}`");
        assert!(told_of.starts_with(&expected), "{told_of}");
        assert!(diagnose(&text(&format!("1.0 * {force}"))).is_empty());
    }
}

/// As circuits are written elsewhere: the factor is part of the number.
#[test]
fn a_prefix_behind_a_number_is_told_as_its_power_of_ten() {
    for (number, help) in [
        ("4.7k", "write `4.7e3`"),
        ("100n", "write `100e-9`"),
        ("1u", "write `1e-6`"),
        ("2M", "write `2e6`"),
        ("4.7kohm", "write `4.7 * 1000`"),
        // A metre, and a thousandth.
        ("1m", "such as `param x: m = …;`: write `1.0`"),
    ] {
        let text = format!(
            "model M {{ 0 n {{ C c {{ compliance: 1.0 }} R r {{ resistance: {number} }} }} output y = n.e; }}"
        );
        let (place, told_of) = told(&text);
        assert!(place.starts_with(number), "{place}");
        assert!(told_of.ends_with(help), "{told_of}");
    }
}

/// A law of which effort and flow would be roots of units is told with the name that it reads.
#[test]
fn a_unit_that_makes_roots_is_told_at_its_law() {
    let text = |unit: &str| {
        format!(
            "model M {{ param k{unit} = 1.0; 1 v {{ I m {{ inertia: 2.0 }} C s {{ stiffness: 3.0 }}\nR r {{ effort: k * f }} }} }}"
        )
    };
    insta::assert_snapshot!(reports::told(&text(": 1/s")), @"
    2:15 the effort of `v` could only be in `kg^(1/2)*m/s^2`, if effort times flow is power [MBG0501]
      help: declare `k`, which is in `1/s`, in another unit or in none
      help: or write `1 v pseudo` where effort times flow is no power, as temperature times heat flow
    ");
    assert_eq!(reports::told(&text("")), "");
    assert_eq!(reports::told(&text(": N*s/m")), "");
    let windings = |modulus: &str| {
        format!(
            "model M {{ 1 dq[2] {{ I w {{ inertia: 2.0 }} R c {{ resistance: 1.0 }} }} 1 s {{ I j {{ inertia: 1.0 }} }}
dq -> GY m {{ effort: [[{modulus} * dq.f[0], {modulus} * dq.f[1]]] }} -> s; output w: rad/s = s.f; }}"
        )
    };
    insta::assert_snapshot!(reports::told(&windings("1")), @"
    2:22 the effort of `dq` could only be in `kg^(1/2)*m/s^2`, if effort times flow is power [MBG0501]
      help: a number with a decimal point carries any unit as a factor: `1.0 * …`; a whole number counts
      help: or write `1 dq[2] pseudo` where effort times flow is no power, as temperature times heat flow
    ");
    assert_eq!(reports::told(&windings("1.0")), "");
}

/// A voltage times a current per area is no power.
#[test]
fn laws_per_area_are_told_as_pseudo_bonds() {
    let membrane = |mark: &str| {
        format!(
            "model M {{ param g: S/m^2 = 12.0; param c: F/m^2 = 0.01; param rest: V = 0.05; input i: A/m^2;
             0 n{mark} {{ C s {{ compliance: c }} R r {{ flow: g * (e - rest) }} Sf clamp {{ flow: i }} }}
             output v: V = s.e; }}"
        )
    };
    insta::assert_snapshot!(reports::told(&membrane("")), @"
    2:16 the effort of `n` is `V` and its flow `A/m^2`: their product is no power [MBG0501]
      help: write `0 n pseudo` where effort times flow is no power, as temperature times heat flow
    ");
    assert_eq!(reports::told(&membrane(" pseudo")), "");
    // A unit that is wrong by an area is one that is wrong.
    let mistaken = membrane("").replace("rest: V", "rest: A");
    assert!(!reports::told(&mistaken).contains("pseudo"));
}

#[test]
fn a_variable_in_a_logarithm_is_told_with_a_quotient() {
    let pool = |law: &str| {
        format!(
            "model M {{ param rt: J/mol = 2479.0; 0 a {{ C x {{ effort: rt * {law}, initial: 1.0 }} R r {{ conductance: 1.0 }} }}
             output n: mol = x.q; }}"
        )
    };
    let told = diagnose(&pool("ln(q)"));
    let help =
        "`ln` takes a pure number, which makes `q` one: where it has a unit write `ln(q / 1.0)`";
    assert_eq!(told[0].helps, [help]);
    assert_eq!(reports::told(&pool("ln(q / 1.0)")), "");
}

#[test]
fn units_of_other_trades_are_told_with_their_factors() {
    for (unit, here, factor) in [
        ("Torr", "Pa", 101_325.0 / 760.0),
        ("cmH2O", "Pa", 98.0665),
        ("cP", "Pa*s", 1e-3),
        ("cSt", "m^2/s", 1e-6),
        ("gpm", "m^3/s", 3.785_411_784e-3 / 60.0),
        ("lpm", "m^3/s", 1e-3 / 60.0),
        ("dL", "m^3", 1e-4),
        ("M", "mol/m^3", 1e3),
        ("uM", "mol/m^3", 1e-3),
        ("BTU", "J", 1_055.055_852_62),
        ("year", "s", 31_557_600.0),
        ("ppm", "1", 1e-6),
        ("%", "1", 0.01),
    ] {
        let help = &diagnose(&mass(&format!("param _x: {unit} = 1.0;")))[0].helps[0];
        let (text, number) = help.split_once(", and each value times ").unwrap();
        assert_eq!(text, format!("write `{here}`"));
        let number: f64 = number.parse().unwrap();
        assert!((number / factor - 1.0).abs() < 1e-12, "{unit}: {number}");
        assert!(diagnose(&mass(&format!("param _x: {here} = 1.0;"))).is_empty());
    }
    // These are as large as those of SI.
    assert!(diagnose(&mass("param _x: mM = 1.0; param _y: kat = 1.0;")).is_empty());
}

/// What all units behind a converter tell, far from it, is told of it.
#[test]
fn a_converter_that_is_another_one_is_told() {
    let helps = |text: &str| {
        let found = diagnose(text);
        let helps = found.iter().flat_map(|it| it.helps.clone());
        helps.collect::<Vec<_>>().join("; ")
    };
    let speaker = |converter: &str| {
        format!(
            "model M {{ param bl: N/A = 7.0; input v: V; 1 wire {{ Se amplifier {{ effort: v }} R winding {{ resistance: 6.0 }} }}
             wire -> {converter} -> cone; 1 cone {{ I mass {{ inertia: 0.1 }} C edge {{ stiffness: 10.0 }} }}
             output way: m = edge.q; output speed: m/s = cone.f; }}"
        )
    };
    assert_eq!(
        helps(&speaker("TF motor { flow: bl }")),
        "all units agree with `GY motor { effort: bl }`"
    );
    assert_eq!(helps(&speaker("GY motor { effort: bl }")), "");
    let cylinder = |law: &str| {
        format!(
            "model M {{ param area: m^2 = 0.1; param length: m = 0.5; input supply: Pa; 0 line {{ Se source {{ effort: supply }} }}
             line -> TF piston {{ flow: {law} }} -> rod; 1 rod {{ I mass {{ inertia: 0.1 }} }} output speed: m/s = rod.f; }}"
        )
    };
    for (slip, told, meant) in [
        ("area", "1 / area", "1 / area"),
        ("length * length", "1 / (…)", "1 / (length * length)"),
    ] {
        assert_eq!(
            helps(&cylinder(slip)),
            format!("all units agree with `TF piston {{ flow: {told} }}`")
        );
        assert_eq!(helps(&cylinder(meant)), "");
    }
    // Where a loop repeats it, all of them are meant.
    let row = |law: &str| {
        format!(
            "model M {{ param radius: m = 0.1; param force: N = 2.0; 1 shaft {{ I rotor {{ inertia: 0.1 }} C spring {{ stiffness: 1.0 }} }}
             rows: for k in 0..3 {{ shaft -> TF wheel {{ flow: {law} }} -> rod; 1 rod {{ Se load {{ effort: force }} }} }}
             output angle: rad = spring.q; }}"
        )
    };
    assert_eq!(
        helps(&row("1 / radius")),
        "all units agree with `TF wheel { flow: radius }`"
    );
    assert_eq!(helps(&row("radius")), "");
}

/// A source that waves without an amplitude is looked at last, though its rate has a unit.
#[test]
fn a_position_for_a_source_of_flow_is_told_at_its_law() {
    let road = |declared: &str, flow: &str| {
        format!(
            "model Quarter {{ param m: kg = 300.0; param k: N/m = 1e5; input {declared};
             1 body {{ I mass {{ inertia: m }} }} 0 contact {{ C tyre {{ stiffness: k }} }}
             Sf ground {{ flow: {flow} }} -> contact -> body; }}"
        )
    };
    let (place, text) = told(&road("road: m", "road"));
    assert!(place.starts_with("road }"));
    insta::assert_snapshot!(text, @"
    `flow` of `ground` must be `m/s` here, and this is `m` [MBG0501]
      help: a source of flow is given the rate of what moves: in the place of `road` declare its rate, such as `input ground_rate: m/s;`, and write `flow: ground_rate`
    ");
    assert!(diagnose(&road("ground_rate: m/s", "ground_rate")).is_empty());
    // What is no position is told as before, where it contradicts the rest.
    let found = diagnose(&road("road: N", "road"));
    assert!(
        found
            .iter()
            .all(|report| !report.text().contains("source of flow"))
    );
    assert!(!found.is_empty());
}

#[test]
fn a_wave_without_an_amplitude_is_told_at_its_law() {
    let (place, text) = told(
        "model M { param k: N/m = 1.0; param w: rad/s = 3.0; 1 a { I m { inertia: 1.0 } }
         0 z { C d { stiffness: k } } Sf road { flow: sin(w * t) } -> z; z -> a; }",
    );
    assert!(place.starts_with("sin(w * t)"), "{place}");
    assert!(
        text.contains("`flow` of `road` must be `m/s` here, and this is a pure number"),
        "{text}"
    );
    assert!(text.contains("`1.0 * …`"), "{text}");
}
