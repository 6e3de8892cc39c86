//! Laws of elements: what they are, what they store, and what is said of mistakes in them.
#![allow(clippy::unwrap_used)]

mod models;
mod told;

use mbg_compiler::compile::Routines;
use mbg_compiler::diagnostics::Diagnostics;
use mbg_compiler::graph::Law;
use mbg_compiler::program::{self, Arguments};
use mbg_compiler::symbolic::Symbol;
use mbg_compiler::symbolic::print::Printer;
use models::{attempted, compiled, elaborated, flat, mistake};
use told::told;

#[test]
fn a_start_that_is_no_number_is_told_at_its_value() {
    let told = |statements: &str| mistake(&format!("input u; 1 v {{ {statements} }}"));
    let varies = "expected numbers and parameters alone, from which a state starts [MBG0213]";
    let coil = "C s { stiffness: 1.0, initial: 2.0 * u }";
    assert_eq!(told(coil), format!("2:47 {varies}"));
    let started = "I b { inertia: 1.0, initial_flow: u }";
    assert_eq!(told(started), format!("2:50 {varies}"));
    let way = "I b { inertia: 1.0 } } integral way = v.f, initial: t; 0 other {";
    assert_eq!(told(way), format!("2:68 {varies}"));
    insta::assert_snapshot!(told("I b { flow: p + powi(p, 3), initial_flow: 2.0 }"), @"
    2:58 the momentum of `b` does not follow from a flow: its law is not linear [MBG0213]
      help: give the momentum itself: `initial: …`
    ");
}

/// The momentum follows from the flow also where the law has a flow at rest.
#[test]
fn an_affine_law_starts_at_the_flow_that_is_given() {
    let model = "model M { 1 v { I m { flow: 2.0 * p + 1.0, initial_flow: 4.0 } R r { resistance: 1.0 } } output y = v.f; }";
    let (elaborated, pool) = elaborated(model).unwrap();
    let start = elaborated.states[0].initial;
    assert_eq!(pool.constant_value(start), Some(1.5));
}

/// What pseudo bonds store is no energy: a gas by its mass and heat has pressure and temperature of no common energy.
#[test]
fn laws_of_pseudo_bonds_need_no_energy() {
    let gas = |word: &str| {
        format!(
            "model M {{ input flow; 0 gas[2] {word} {{ C chamber {{ effort: [2.0 * q.y, q.y / q.x], initial: [1.0, 2.0] }} Sf valve {{ flow: \
             flow }} }}
             1 rod {{ I mass {{ inertia: 2.0, initial_flow: 3.0 }} }} output pressure = chamber.e.x; }}"
        )
    };
    let compiled = compiled(&gas("pseudo"));
    assert_eq!(compiled.notes.len(), 0, "{:?}", compiled.notes);
    let told = told(&gas(""));
    assert!(
        told.contains("the law of `chamber` would create energy"),
        "{told}"
    );
    assert_eq!(
        mistake(
            "0 stored[2] pseudo { C c { compliance: [[2.0, 1.0], [0.5, 3.0]] } R r { resistance: 1.0 } }"
        ),
        ""
    );
}

#[test]
fn mistakes_in_laws_are_told() {
    insta::assert_snapshot!(mistake("1 v[2] { EJS wheel { momentum: [0.0, 1.0] } I b { inertia: 1.0 } }"), @"
    2:14 `wheel` needs a junction of dimension 3, and this one has 2 [MBG0204]
      help: an `EJS` turns with an angular velocity in space; in a plane, a velocity in axes of the body turns by `v -> MGY wheel { effort: [[-p.y, p.x]] } -> rate;`, and one in axes of the world by nothing
    ");
    insta::assert_snapshot!(mistake("1 v[4] { EJS wheel { momentum: 1.0 } I b { inertia: 1.0 } }"), @"2:14 `wheel` needs a junction of dimension 3, and this one has 4 [MBG0204]");
    insta::assert_snapshot!(mistake("input f; 1 v { I b { inertia: 1.0 } Se s { effort: 2.0 * f } }"), @"
    2:58 `f` is a variable of `s` in its law, and declared as another value [MBG0202]
      help: declare the other value by a longer name than `f`
    ");
    insta::assert_snapshot!(mistake("1 v[2] { C c { effort: [q.x + q.y, 2.0 * q.y] } I b { inertia: 1.0 } }"), @"
    2:24 the law of `c` would create energy: its component x changes with y otherwise than its component y with x [MBG0213]
      help: write `energy: …`, from which the law follows by differentiation
      help: or where effort times flow is no power write `pseudo` behind the name of its junction
    ");
    insta::assert_snapshot!(mistake("1 v { C c { stiffness: 1.0 + f } I b { inertia: 2.0 + e * e } }"), @"
    2:30 `c` stores energy by its own `q` alone, and its law reads `f` [MBG0213]
      help: write `effort: …` or `energy: …` as a function of `q`
    2:55 `b` stores energy by its own `p` alone, and its law reads `e` [MBG0213]
      help: write `flow: …` or `energy: …` as a function of `p`
    ");
    insta::assert_snapshot!(mistake("1 v[2] { C c { stiffness: diag(1.0 + q.y, 1.0) } I b { inertia: 1.0 } }"), @"
    2:27 the law of `c` would create energy: its component x changes with y otherwise than its component y with x [MBG0213]
      help: write `energy: …`, from which the law follows by differentiation
      help: or where effort times flow is no power write `pseudo` behind the name of its junction
    ");
    insta::assert_snapshot!(mistake("1 v { I b { inertia: 1.0, initial: 2.0, initial_flow: 3.0 } }"), @"
    2:41 `b` is given both a momentum and a flow at the start [MBG0104]
      help: remove `initial` or `initial_flow`: one follows from the other
    ");
    insta::assert_snapshot!(mistake("1 v[3] { I b { inertia: [1.0, 2.0, 3.0] } }"), @"
    2:25 expected a number or a 3×3 matrix, found a vector of 3 [MBG0204]
      help: write `diag(…)` for a matrix with these on its diagonal
    ");
    insta::assert_snapshot!(mistake("1 v[2] { I b { inertia: [[1.0, 2.0], [2.0, 1.0]] } }"), @"2:25 the inertia of `b` is not positive definite: the determinant of its first 2 rows and columns is -3 [MBG0216]");
    insta::assert_snapshot!(mistake("1 v { I b { inerta: 1.0 } R r { effort: Sin(f) } }"), @"
    2:13 `I` does not know `inerta` [MBG0207]
      help: did you mean `inertia`?
      help: its words are `inertia`, `flow`, `energy`, `initial`, `initial_flow`, `gyroscopic`
    2:41 `Sin` is not a function of the language [MBG0203]
      help: did you mean `sin`?
      help: functions are sin, cos, tan, asin, acos, atan, atan2, exp, ln, sqrt, abs, sign, tanh, mod, floor, fraction, min, max, pow, powi, interpolate, diag, transpose, skew, rot_x, rot_y, rot_z, rot, jacobian_xyz, jacobian, matrix_of, quaternion_of, angles_of, rotation
    ");
    insta::assert_snapshot!(mistake("1 v { I b { inertia: q } C c { stiffness: p } R r { resistance: p } TF t { flow: 1.0 } MGY g { effort: 1.0 } }"), @"
    2:69 a `TF` has two ports; put it between two arrows [MBG0208]
    2:88 an `MGY` has two ports; put it between two arrows [MBG0208]
    2:22 an `I` has no `q` [MBG0213]
    2:43 a `C` has no `p` [MBG0213]
    2:65 an `R` has no `p` [MBG0213]
    ");
    insta::assert_snapshot!(mistake("1 v[8] { I b { inertia: diag(1.0, 2.0) } }"), @"2:25 expected a number or an 8×8 matrix, found a 2×2 matrix [MBG0204]");
    insta::assert_snapshot!(mistake("1 v { I b { inertia: 1.0 } } v -> v;"), @"
    2:32 `v -> v` joins a junction to itself, which says nothing [MBG0209]
      help: remove it, or lead it through a `TF` or a `GY`
    ");
    insta::assert_snapshot!(mistake("1 w[2]; a.x -> w[0];"), @"
    2:3 junction `w[1]` has no bond [MBG0208]
      help: write an arrow to it: `w[1] -> …;`
    ");
}

/// A law that takes its vector apart, or the square of its length, is one of the whole vector.
#[test]
fn laws_of_whole_vectors_are_no_laws_of_components() {
    let force = |law: &str| {
        let (model, pool) = elaborated(&format!(
            "model M {{ 1 v[2] {{ C c {{ {law} }} I m {{ inertia: 1.0 }} }} }}"
        ))
        .unwrap_or_else(|reported| panic!("{reported}"));
        let Law::Storage(storage) = &model.graph.elements[0].law else {
            panic!("a storage was written")
        };
        let name = |symbol| match symbol {
            Symbol::State(index) => model.states[index].variable.name.clone(),
            other => format!("{other:?}"),
        };
        let printer = Printer::new(&pool, &name);
        let text = storage.coenergy.iter().map(|value| printer.text(*value));
        text.collect::<Vec<_>>().join("\n")
    };
    insta::assert_snapshot!(force("effort: q * (transpose(q) * q)"), @"
    (c.q.x c.q.x + c.q.y c.q.y) c.q.x
    (c.q.x c.q.x + c.q.y c.q.y) c.q.y
    ");
    insta::assert_snapshot!(force("energy: 0.25 * powi(transpose(q) * q, 2)"), @"
    0.25 2 c.q.x 2 (c.q.x c.q.x + c.q.y c.q.y)
    0.25 2 (c.q.x c.q.x + c.q.y c.q.y) 2 c.q.y
    ");
    insta::assert_snapshot!(force("effort: 3.0 * powi(q, 3)"), @"
    3 c.q.x c.q.x c.q.x
    3 c.q.y c.q.y c.q.y
    ");
    insta::assert_snapshot!(force("energy: q[0] * q.y"), @"
    c.q.y
    c.q.x
    ");
    // A junction of that name is no variable of the element.
    let law = "1 q[2] { I g { inertia: 1.0 } } 1 v[2] { I b { inertia: 1.0 } R r { effort: q.f.x * powi(f, 3) } }";
    assert_eq!(mistake(law), "");
}

/// In a law `f` is the element's own, and so are its components, whatever else has that name.
#[test]
fn own_variables_hide_what_else_has_their_names() {
    let efforts = |text: &str| {
        let arguments = Arguments {
            parameters: &[],
            time: 0.0,
            state: &[1.0, 2.0, 0.0],
            input: &[],
        };
        program::evaluate(&compiled(text).program, Routines::OUTPUT, &arguments)
    };
    let resistor = |law: &str, other: &str| {
        efforts(&format!(
            "component Thing(port 1 a) {{ let x = 5.0; let w = 7.0; a -> R r {{ resistance: 1.0 }}; }}
             model M {{ 1 v[2] {{ I m {{ inertia: 1.0 }} R d {{ {law} }} }} 1 w {{ I k {{ inertia: 1.0 }} {other}"
        ))
    };
    let flows = "effort: [3.0 * f.x, 4.0 * f[1]]";
    let read = "} f: Thing (w); output y[3] = [d.e.x, d.e.y, f.x]; }";
    assert_eq!(resistor(flows, read), [3.0, 8.0, 5.0]);
    let read = "Se e { effort: 1.0 } } output y[3] = [d.e.x, d.e.y, e.e]; }";
    assert_eq!(resistor("flow: [e.x, 2.0 * e.y]", read), [1.0, 1.0, 1.0]);
    let read = "} f: for k in 0..1 { let x = 5.0; } output y[3] = [d.e.x, d.e.y, f[0].x]; }";
    assert_eq!(resistor(flows, read), [3.0, 8.0, 5.0]);
    // Four components are no quaternion.
    let four = "model M { 1 v[4] { I m { inertia: 1.0 } R d { effort: [f.x, f.y, f.z, f[3]] } } }";
    assert_eq!(compiled(four).states.len(), 4);
    // Nothing but a component is read behind an own variable: this is what else has the name.
    let read = "} f: Thing (w); output y[2] = d.e; }";
    assert_eq!(resistor("effort: f.w * f", read), [7.0, 14.0]);
    let read = "R r { effort: f[0].x } } f: for k in 0..1 { let x = 5.0; }";
    insta::assert_snapshot!(mistake(&format!("1 v {{ I b {{ inertia: 1.0 }} {read}")), @"
    2:42 `f[0]` is a component of the element's own `f`, and nothing is read behind it [MBG0213]
      help: declare what else has this name by a longer one than `f`
    ");
    let known = |law: &str| {
        mistake(&format!(
            "let f = 3; 1 v[2] {{ I b {{ inertia: 1.0 }} R r {{ effort: {law} }} }}"
        ))
    };
    insta::assert_snapshot!(known("if f > 2 { 1.0 } else { 2.0 }"), @"
    2:59 `f` is a variable of `r` in its law, and declared as another value [MBG0202]
      help: declare the other value by a longer name than `f`
    ");
    insta::assert_snapshot!(known("[1.0, f % 2]"), @"
    2:62 `f` is a variable of `r` in its law, and declared as another value [MBG0202]
      help: declare the other value by a longer name than `f`
    ");
}

/// A law that multiplies is a resistance, whatever word gives it, and so has both causalities.
#[test]
fn a_law_that_multiplies_is_a_coefficient() {
    let model = |resistor: &str| {
        let text = format!(
            "model M {{ param k = 2.0; 1 a {{ I m {{ inertia: 1.0 }} }}
             0 b {{ C c {{ stiffness: 3.0 }} {resistor} }} a -> b; }}"
        );
        let model = compiled(&text);
        let arguments = Arguments {
            parameters: &[2.0],
            time: 0.0,
            state: &[0.5, 0.7],
            input: &[],
        };
        program::evaluate(&model.program, Routines::DERIVATIVE, &arguments)
    };
    let expected = model("R r { resistance: k }");
    assert_eq!(model("R r { effort: k * f }"), expected);
    assert_eq!(model("R r { flow: e / k }"), expected);
    let itself = |law| mistake(&format!("1 v {{ I b {{ inertia: 1.0 }} R r {{ {law} }} }}"));
    insta::assert_snapshot!(itself("effort: 2.0 * e"), @"
    2:42 the law of `r` gives its effort `e`, and reads it [MBG0218]
      help: write it as a function of `f`
    ");
}

/// A law that jumps has the same slope on both sides, and yet two values.
#[test]
fn laws_that_jump_keep_both_sides() {
    let force = |law: &str, momentum: f64| {
        let text =
            format!("model M {{ 1 v {{ I m {{ inertia: 2.0 }} {law} }} output force = m.e; }}");
        let arguments = Arguments {
            parameters: &[],
            time: 0.0,
            state: &[momentum],
            input: &[],
        };
        program::evaluate(&compiled(&text).program, Routines::OUTPUT, &arguments)[0]
    };
    let cases = [
        ("R r { effort: 5.0 * sign(f) }", -5.0, 5.0),
        ("R r { effort: 5.0 * sign(f) + 0.1 * f }", -5.15, 5.15),
        (
            "R r { effort: if f > 0.0 { 5.0 } else { -2.0 } }",
            -5.0,
            2.0,
        ),
        (
            "R r { effort: if f > 0.0 { 5.0 + f } else { f } }",
            -6.5,
            1.5,
        ),
        (
            "Se s { effort: if v.f < 1.0 { 2.0 } else { 0.5 } }",
            0.5,
            2.0,
        ),
    ];
    for (law, forward, backward) in cases {
        assert_eq!(
            [3.0, -3.0].map(|momentum| force(law, momentum)),
            [forward, backward],
            "{law}"
        );
    }
    // Such a law has no inverse, which a dependent storage would need.
    let text = "#[derivative] model M { 0 n { C a { stiffness: 2.0 } C b { effort: q + sign(q) } } \
                1 v { I m { inertia: 1.0 } } n -> v; }";
    assert_eq!(attempted(text).err(), Some(vec!["MBG0403"]));
}

/// `System::energy` is given no inputs: code that read one there would not compile.
#[test]
fn storages_that_an_input_changes_are_told() {
    let text = |inputs: &str| {
        format!(
            "model M {{ {inputs} 1 v {{ C c {{ stiffness: 10.0 + u }} I m {{ inertia: 1.0 }} }} }}"
        )
    };
    assert_eq!(attempted(&text("input u;")).err(), Some(vec!["MBG0213"]));
    let by_rate = attempted(&text("input u_rate; integral u = u_rate;"));
    assert!(by_rate.is_ok());
}

/// The value of an expression of constants.
fn value(expression: &str) -> f64 {
    let text = format!("model M {{ 1 a {{ I m {{ inertia: 1.0 }} }} output y = {expression}; }}");
    let (model, pool) = elaborated(&text).unwrap_or_else(|reported| panic!("{reported}"));
    pool.constant_value(model.outputs[0].value).unwrap()
}

#[test]
fn an_arc_tangent_of_numbers_is_a_number() {
    for tangent in [0.7_f64, -2.5, 0.0, 1e300] {
        assert_eq!(value(&format!("atan({tangent:?})")), tangent.atan());
    }
    insta::assert_snapshot!(mistake("output y = atan(n, 1.0);"), @"2:12 `atan` takes 1 argument, found 2 [MBG0213]");
}

/// What the help on the only mistake of an expression says to write.
fn instead(expression: &str) -> String {
    let text = format!("model M {{ 1 a {{ I m {{ inertia: 1.0 }} }} output y = {expression}; }}");
    let reported = elaborated(&text).err().unwrap_or_default();
    let [_, help] = reported.lines().collect::<Vec<_>>()[..] else {
        panic!("one mistake with one help, found {reported}")
    };
    help.split('`').nth(1).unwrap().to_owned()
}

#[test]
fn words_of_other_languages_are_answered_with_what_has_their_value() {
    let cases = [
        ("arctan(0.7)", 0.7_f64.atan()),
        ("arctan2(0.7, 0.2)", 0.7_f64.atan2(0.2)),
        ("arcsin(0.7)", 0.7_f64.asin()),
        ("arccos(0.7)", 0.7_f64.acos()),
        ("sinh(0.5 + 0.2)", 0.7_f64.sinh()),
        ("asinh(0.5 + 0.2)", 0.7_f64.asinh()),
        ("acosh(0.5 + 1.2)", 1.7_f64.acosh()),
        ("atanh(0.5 + 0.2)", 0.7_f64.atanh()),
        ("expm1(0.5 + 0.2)", 0.7_f64.exp_m1()),
        ("log1p(0.5 + 0.2)", 0.7_f64.ln_1p()),
        ("cosh(0.7)", 0.7_f64.cosh()),
        ("log(0.7)", 0.7_f64.ln()),
        ("log10(0.7)", 0.7_f64.log10()),
        ("log2(0.7)", 0.7_f64.log2()),
        ("hypot(0.7, 0.2)", 0.7_f64.hypot(0.2)),
        ("sgn(-0.7)", -1.0),
        ("(-0.7).signum()", -1.0),
        ("fabs(-0.7)", 0.7),
        ("clamp(0.7, -1.0, 0.5)", 0.5),
        ("clamp(0.7 - 2.0, -1.0, 0.5)", -1.0),
        ("interp(0.5, [0.0, 2.0], [1.0, 5.0])", 2.0),
        ("interp1([0.0, 2.0], [1.0, 5.0], 0.5)", 2.0),
        ("interp1(0.5, [0.0, 2.0], [1.0, 5.0])", 2.0),
        ("norm([3.0, 4.0])", 5.0),
        ("dot([3.0, 4.0], [1.0, 2.0])", 11.0),
        ("radians(90)", std::f64::consts::FRAC_PI_2),
        ("powf(0.7, 2.0)", 0.49),
        ("powf(0.2 + 0.5, -1)", 0.7_f64.recip()),
        ("powf(0.7, 0.5)", 0.7_f64.sqrt()),
        ("powf(0.7, 1.5)", 0.7_f64.powf(1.5)),
        ("powi(0.7, 1.5)", 0.7_f64.powf(1.5)),
        ("powf(0.7, 1.0 + 0.5)", 0.7_f64.powf(1.5)),
        ("0.7 ^ 2", 0.49),
        ("0.7 ** 2", 0.49),
        ("0.7 ** 1.5", 0.7_f64.powf(1.5)),
        ("pi", std::f64::consts::PI),
        ("std::f64::consts::PI", std::f64::consts::PI),
        ("TAU", std::f64::consts::TAU),
    ];
    for (typed, expected) in cases {
        let found = value(&instead(typed));
        assert!(
            (found - expected).abs() < 1e-15 * (1.0 + expected.abs()),
            "{typed}: {found}"
        );
    }
    assert_eq!(instead("time"), "t");
    assert_eq!(instead("cross(a.f, 2.0 + a.f)"), "skew(a.f) * (2.0 + a.f)");
}

/// Scales of fixed-point numbers, whose ratio is 2⁶¹.
#[test]
fn numbers_far_apart_are_not_one() {
    let model = compiled(
        "model Q31 { 1 s { I m { inertia: 1.0 } R r { resistance: 2.0 } }
            output full = 2147483648.0 * m.f; output back = m.f / 1073741824.0;
            output half = 0.5 * m.f; output large = 1152921504606846976.0 * m.f; }",
    );
    let arguments = Arguments {
        parameters: &[],
        time: 0.0,
        state: &[3.0],
        input: &[],
    };
    let found = program::evaluate(&model.program, Routines::OUTPUT, &arguments);
    let bits = |exponent: i32| 3.0 * 2.0_f64.powi(exponent);
    assert_eq!(found, [bits(31), bits(-30), bits(-1), bits(60)]);
    for (typed, expected) in [
        ("9223372036854775807.0", 2.0_f64.powi(63)),
        ("1.0 / 9223372036854775807.0", 2.0_f64.powi(-63)),
        ("3.0 + 2305843009213693951.0", 2.0_f64.powi(61)),
    ] {
        assert_eq!(value(typed), expected, "{typed}");
    }
}

#[test]
fn powers_are_those_of_the_standard_library() {
    for (typed, expected) in [
        ("pow(0.7, 1.5)", 0.7_f64.powf(1.5)),
        ("pow(0.7, -0.3)", 0.7_f64.powf(-0.3)),
        ("pow(0.7, 0.5)", 0.7_f64.sqrt()),
        ("pow(-0.7, 3)", -0.343),
        ("pow(0.2 + 0.5, -1)", 0.7_f64.recip()),
        ("pow(0.0, 1.5)", 0.0),
    ] {
        let found = value(typed);
        assert!((found - expected).abs() < 1e-15, "{typed}: {found}");
    }
}

/// At zero, where a product with a root has none: slopes of forces, and of one whose exponent varies.
#[test]
fn powers_have_slopes_at_zero() {
    let model = compiled(
        "model M { param n = 1.5; input m; 1 v {
            C contact { effort: 3.0 * pow(max(q, 0.0), n) }
            R water { effort: 2.0 * sign(f) * pow(abs(f), 1.75) }
            R oil { effort: pow(2.0 + tanh(f), m) - pow(2.0, m) }
            I body { inertia: 1.0 }
        } }",
    );
    let entries = |routine, state: [f64; 2]| {
        let arguments = Arguments {
            parameters: &[1.5],
            time: 0.0,
            state: &state,
            input: &[0.3],
        };
        program::evaluate(&model.program, routine, &arguments)
    };
    let oil = |f: f64| 0.3 * (2.0 + f.tanh()).powf(-0.7) * (1.0 - f.tanh().powi(2));
    for (q, f) in [(0.0_f64, 0.0_f64), (-0.1, 0.0), (0.2, -0.3)] {
        let stiffness = 4.5 * q.max(0.0).sqrt();
        let damping = 3.5 * f.abs().powf(0.75) + oil(f);
        let found = &entries(Routines::DERIVATIVE_AND_JACOBIAN, [q, f])[2..];
        for (found, expected) in found.iter().zip([0.0, 1.0, -stiffness, -damping]) {
            assert!(
                (found - expected).abs() < 1e-14,
                "{q} {f}: {found}, not {expected}"
            );
        }
        let base = 2.0 + f.tanh();
        let by_exponent = 2.0_f64.powf(0.3) * 2.0_f64.ln() - base.powf(0.3) * base.ln();
        let found = entries(Routines::JACOBIAN_INPUT, [q, f])[1];
        assert!(
            (found - by_exponent).abs() < 1e-15,
            "{q} {f}: {found}, not {by_exponent}"
        );
    }
}

#[test]
fn mistakes_in_powers_and_functions_are_told() {
    // What stands beside the sign was meant, whatever Rust takes for its operands.
    insta::assert_snapshot!(mistake("1 v { R r { effort: 3.0 * f ** 2 + f } }"), @"
    2:29 `**` is not a power; Rust has no sign for it [MBG0212]
      help: write `powi(f, 2)`
    ");
    insta::assert_snapshot!(mistake("1 v { R r { effort: 2.0 + f ^ 2 * 3.0 } }"), @"
    2:29 `^` is not a power; in Rust it is the exclusive or [MBG0212]
      help: write `powi(f, 2)`
    ");
    insta::assert_snapshot!(mistake("1 v { R r { effort: powi(f, n) } }"), @"
    2:29 expected an integer exponent between -64 and 64 [MBG0213]
      help: write `pow(f, n)`, where `f` is not negative
    ");
    insta::assert_snapshot!(mistake("1 v { R r { effort: arctan(f) } }"), @"
    2:21 `arctan` is not a function of the language [MBG0203]
      help: write `atan(f)`
    ");
    insta::assert_snapshot!(mistake("1 v { R r { effort: clamp(f) } }"), @"
    2:21 `clamp` is not a function of the language [MBG0203]
      help: for `clamp(x, a, b)` write `min(max(x, a), b)`
    ");
    insta::assert_snapshot!(mistake("1 v { R r { effort: sin(f, f) } }"), @"2:21 `sin` takes 1 argument, found 2 [MBG0213]");
    insta::assert_snapshot!(mistake("1 v { R r { effort: n * (f > 0.0) } }"), @"
    2:28 expected +, -, * or /; comparisons, `&&` and `||` stand between `if` and `{` [MBG0213]
      help: write `if f > 0.0 { n } else { 0.0 }`
    ");
}

#[test]
fn conditions_of_laws_are_joined() {
    let holds = |condition: &str| value(&format!("if {condition} {{ 1.0 }} else {{ 2.0 }}")) == 1.0;
    for a in ["0.5 < 1.0", "0.5 > 1.0", "1 < 2", "1 > 2"] {
        assert_eq!(holds(&format!("!({a})")), !holds(a));
        for b in ["2.0 <= 2.0", "2.5 <= 2.0", "2 >= 2", "2 >= 3"] {
            let (first, second) = (holds(a), holds(b));
            assert_eq!(holds(&format!("{a} && {b}")), first && second, "{a} && {b}");
            assert_eq!(holds(&format!("{a} || {b}")), first || second, "{a} || {b}");
            assert_eq!(
                holds(&format!("{a} && !({b})")),
                first && !second,
                "{a} && !({b})"
            );
            let both = format!("0.5 > 1.0 || {a} && {b}");
            assert_eq!(holds(&both), first && second, "{both}");
        }
    }
    let text = "model M {
        1 a { I m { inertia: 1.0 } C c { effort: if q > 0.0 && q < 1.0 || q < -3.0 { 2.0 * q } else { q } } }
        output y = if a.f > 0.0 && a.f < 1.0 { 1.0 } else { 0.0 };
    }";
    assert!(compiled(text).notes.is_empty());
    insta::assert_snapshot!(flat(text), @"
    a -> m [1]
    a -> c [1]
    state m.p = 0
    state c.q = 0
    output y = select_less(0, Signal(0), select_less(Signal(0), 1, 1, 0), 0)
    ");
    insta::assert_snapshot!(mistake("output y = if a.f.x > 0.0 && a.f.y == 1.0 { 1.0 } else { 0.0 };"), @"
    2:36 expected a comparison with < <= > or >= [MBG0213]
      help: of a value that is 0 or 1 write `a.f.y > 0.5`
    ");
    insta::assert_snapshot!(mistake("output y = if a.f.x { 1.0 } else { 0.0 };"), @"
    2:15 expected a comparison with < <= > or >= [MBG0213]
      help: of a value that is 0 or 1 write `a.f.x > 0.5`
    ");
}

/// A formula that nobody would read as a name gives way to what it is for.
#[test]
fn what_is_divided_by_has_a_short_name() {
    let model = compiled(
        "model M { param a = 1.0; param b = 2.0; param c = 0.1; param d = 3.0;
           1 gimbals[3] { C spring { stiffness: 1.0, initial: [0.1, 0.2, 0.3] } }
           1 body[3] {
             I rotor { inertia: [[a + b * d, c, c * a], [c, b + a * d, c * d], [c * a, c * d, d * a + d]] }
             R bearing { resistance: 1.0 / (a * b - 0.5) }
           }
           gimbals -> MTF jacobian { flow: [
             [1.0 + a * spring.q.x * spring.q.y, sin(spring.q.z) * b, 0.2 * spring.q.x],
             [0.3 * a, cos(spring.q.y), 0.2],
             [0.5 * b * spring.q.z, 0.1 * a, cos(spring.q.x)],
           ] } -> body; }",
    );
    let checks = model.checks.iter();
    let checks: Vec<String> = checks
        .map(|it| format!("{}: {}", it.name, it.reason))
        .collect();
    insta::assert_snapshot!(checks.join("\n"), @"
    a + b d: it is the inertia of `rotor`
    (a + b d) (b + a d) - c c: it is the determinant of the first 2 rows and columns of the inertia of `rotor`
    a formula in a, b, d, c: it is the determinant of the first 3 rows and columns of the inertia of `rotor`
    a b - 0.5: the law of `bearing` divides by it
    ");
    insta::assert_snapshot!(model.conditioning.join("\n"), @"
    a formula in a, spring.q.x, spring.q.y, b and 1 more
    the determinant for gimbals.f.x, gimbals.f.y, gimbals.f.z
    ");
}

/// No amount of a substance has an infinite potential, and what decays by it is zero.
#[test]
fn an_infinite_law_without_an_infinite_rate_is_told_by_nothing() {
    compiled("model M { 0 node { C amount { effort: ln(q) } R decay { flow: exp(e) } } }");
}

/// A displacement that is told follows from states, and changes as its storage flows.
#[test]
fn displacements_that_are_told_wrongly_are_refused() {
    let of = |words: &str| {
        let element = format!("C c {{ stiffness: 2.0, {words} }}");
        told(&format!(
            "model M {{ input u: m; integral way: m = v.f; 1 v {{ I b {{ inertia: 1.0 }} {element} }} }}"
        ))
    };
    assert_eq!(of("displacement: way - 0.3"), "");
    insta::assert_snapshot!(of("displacement: 2.0 * way"), @"
    1:75 the displacement of `c` does not change as `c` flows [MBG0309]
      it has another rate than the flow into `c`
      help: bond it where the flow is the rate of what is told
      help: or leave `displacement` out: then it is a state
    ");
    insta::assert_snapshot!(of("displacement: way - u"), @"
    1:75 the displacement of `c` reads the input `u`, whose rate nothing knows [MBG0309]
      help: tell it in terms of states, of positions that components tell, or of `t`
    ");
    insta::assert_snapshot!(of("displacement: way + v.f"), @"
    1:75 the displacement of `c` reads an effort or a flow, whose rate nothing knows [MBG0309]
      help: tell it in terms of states, of positions that components tell, or of `t`
    ");
    insta::assert_snapshot!(of("displacement: 0.5 * (way + q)"), @"1:75 the displacement `c.q` is told by itself [MBG0218]");
    insta::assert_snapshot!(of("displacement: way, initial: 0.3"), @"
    1:114 `c` is given both a displacement and where that starts [MBG0104]
      help: remove `initial` or `displacement`: one follows from the other
    ");
    insta::assert_snapshot!(of("displacement"), @"1:95 expected `displacement: value` [MBG0213]");
    insta::assert_snapshot!(of("displacement: [way, way]"), @"1:109 expected a number, found a vector of 2 [MBG0204]");
    insta::assert_snapshot!(of("displacement: way * way"), @"
    1:109 `displacement` of `c` must be `m` here, and this is `m^2` [MBG0501]
      the effort is `N` and the flow `m/s` there
    ");
    insta::assert_snapshot!(of("displacement: way / 0.0"), @"1:113 this divides by zero, whatever the state [MBG0216]");
}

/// Neither strokes by components nor an accepted dependence make a slip follow from a force by `sign`.
#[test]
fn a_spring_in_a_row_with_dry_friction_is_told_to_have_a_law_for_its_flow() {
    let text = |law: &str| {
        format!(
            "model M {{ 1 floor {{ I slab {{ inertia: 5.0 }} C bed {{ stiffness: 4.0, initial: 1.0 }} }}
             0 row {{ C spring {{ stiffness: 8.0 }} R slider {{ {law} }} }} floor -> row; output way = bed.q; }}"
        )
    };
    let report = told(&text("effort: 6.0 * sign(f)"));
    assert!(
        report.contains("`#[derivative]` does not mend it: a nonlinear algebraic loop"),
        "{report}"
    );
    assert!(!report.contains("loss of order"), "{report}");
    assert!(
        report.contains("help: write the law of `slider` for the flow: `flow: …` in terms of `e`"),
        "{report}"
    );
    assert!(!report.contains("causality componentwise"), "{report}");
    assert_eq!(told(&text("flow: 1e3 * (e - min(max(e, -6.0), 6.0))")), "");
}

/// The code of a model of two vectors with such a law beside them.
fn code(law: &str) -> String {
    let text = format!(
        "model M {{ input wanted[2]: m/s; input most: m/s; param soft[2]: m/s = [0.1, 0.2];
        1 v[2] {{ I m {{ inertia: 2.0 }} R r {{ resistance: 1.0 }} }} {law} }}"
    );
    let mut diagnostics = Diagnostics::new();
    let items = mbg_compiler::items(text.parse().unwrap(), &mut diagnostics);
    assert!(!diagnostics.any(), "{law}: {:?}", diagnostics.list());
    items.behaviour.to_string()
}

/// A function of vectors is one of each component, with what is a number counting for all of them.
#[test]
fn functions_of_vectors_are_those_of_their_components() {
    let pairs = [
        (
            "min(wanted, most)",
            "[min(wanted.x, most), min(wanted.y, most)]",
        ),
        (
            "max(min(v.f, most), -wanted)",
            "[max(min(v.f.x, most), -wanted.x), max(min(v.f.y, most), -wanted.y)]",
        ),
        (
            "most * tanh(3.0 * v.f)",
            "[most * tanh(3.0 * v.f.x), most * tanh(3.0 * v.f.y)]",
        ),
        (
            "most * sin(pow(3.0 * v.f, 2.0))",
            "[most * sin(pow(3.0 * v.f.x, 2.0)), most * sin(pow(3.0 * v.f.y, 2.0))]",
        ),
        ("mod(v.f, soft)", "[mod(v.f.x, soft.x), mod(v.f.y, soft.y)]"),
        (
            "most * atan(floor(3.0 * v.f))",
            "[most * atan(floor(3.0 * v.f.x)), most * atan(floor(3.0 * v.f.y))]",
        ),
        ("wanted.abs()", "[wanted.x.abs(), wanted.y.abs()]"),
    ];
    for (whole, apart) in pairs {
        let integral =
            |rate: &str| code(&format!("integral way[2] = {rate}; output way[2] = way;"));
        assert!(integral(whole) == integral(apart), "{whole}");
    }
    // In a law the element's own variable stands for one component, and beside a vector for all.
    let limited = |law: &str| code(&format!("v -> R limited {{ effort: {law} }};"));
    let apart = "[2.0 * min(f.x, 3.0), 2.0 * min(f.y, 3.0)]";
    assert!(limited("2.0 * min(f, 3.0)") == limited(apart));
    let apart = "[2.0 * min(f.x, soft.x), 2.0 * min(f.y, soft.y)]";
    assert!(limited("2.0 * min(f, soft)") == limited(apart));
    let told = told(
        "model M { input u[2]; input w[3]; 1 a[2] { I m { inertia: 1.0 } R r { resistance: 1.0 } }
        output y[2] = max(u, w); output z = sin(diag(u.x, u.y)); output s[2] = pow(u, w); }",
    );
    insta::assert_snapshot!(told, @"
    2:27 expected a number or a vector of 3, as the other argument is, found a vector of 2 [MBG0204]
    2:49 expected a number, found a 2×2 matrix [MBG0204]
    2:84 expected a number or a vector of 3, as the other argument is, found a vector of 2 [MBG0204]
    ");
}
