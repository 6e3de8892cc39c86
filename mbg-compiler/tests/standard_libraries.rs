//! Components, parameters and functions of the standard libraries of other tools, and what is to be typed instead.
#![allow(clippy::unwrap_used)]

mod told;

use told::{diagnose, told, typed};

/// Two shafts and an idle one, and nodes of a circuit with a ground.
fn model(statements: &str) -> String {
    format!(
        "#[derivative] model M {{ causality componentwise; input u;
1 v {{ I m {{ inertia: 1.0 }} }} 1 w {{ I n {{ inertia: 2.0 }} }} 1 x {{ R r {{ resistance: 1.0 }} }}
0 k {{ C c {{ compliance: 1.0 }} }} 0 l {{ C d {{ compliance: 2.0 }} R s {{ resistance: 3.0 }} }} 0 g {{ Se e0 {{ effort: 0.0 }} }}
{statements} output y = v.f * u; }}"
    )
}

/// What is to be typed is taken as it stands, with numbers where it leaves room for them.
#[test]
fn components_are_told_as_what_they_are_made_of() {
    for (part, written) in [
        (
            "z: LeadScrew { lead: 0.1 } (v, x);",
            "v -> TF z { flow: 0.1 / 6.283185307179586 } -> x;",
        ),
        (
            "z: IdealGear { ratio: 10.0 + 2.0 } (v, x);",
            "v -> TF z { flow: 1 / (10.0 + 2.0) } -> x;",
        ),
        ("z: Inertia { J: 3.0 } (x);", "I z { inertia: 3.0 } -> x;"),
        ("z: Rotor1D { J: 3.0 } (x);", "I z { inertia: 3.0 } -> x;"),
        (
            "z: Spring { c: 1.0 + 2.0 } (v, w);",
            "0 z_between { C z { stiffness: 1.0 + 2.0 } } v -> z_between; z_between -> w;",
        ),
        (
            "z: SpringDamper { d: 3.0, c: 2.0 } (v, w);",
            "0 z_between; 1 z { C spring { stiffness: 2.0 } R damper { resistance: 3.0 } } v -> z_between; z_between -> w; z_between -> z;",
        ),
        (
            "z: ConstantTorque { tau_constant: -3.0 } (v);",
            "Se z { effort: -3.0 } -> v;",
        ),
        (
            "z: QuadraticSpeedDependentTorque (v);",
            "R z { effort: … * f * abs(f) } -> v;",
        ),
        (
            "z: EddyCurrentBrake { tau_nominal: 5.0, w_nominal: 9.0 } (v);",
            "R z { effort: 2 * 5.0 * f * 9.0 / (f * f + 9.0 * 9.0) } -> v;",
        ),
        (
            "z: MechanicalTranslationalReference (x);",
            "Sf z { flow: 0.0 } -> x;",
        ),
        (
            "z: SineVoltage { V: 1.5, f: 50.0 } (k, l);",
            "1 z_between { Se z { effort: 1.5 * sin(6.283185307179586 * 50.0 * t) } } l -> z_between; z_between -> k;",
        ),
        (
            "z: EMF { k: 0.5 } (k, g, v);",
            "1 z_wire; k -> z_wire -> g; z_wire -> GY z { effort: … } -> v;",
        ),
        (
            "z: VCC { transConductance: 2.0 } (k, g, l, g);",
            "1 z_between { Sf z { flow: 2.0 * (k.e - g.e) } } l -> z_between -> g;",
        ),
        (
            "z: NMOS (k, l, g);",
            "let z_over = max(l.e - g.e - …, 0.0); 1 z_channel { R z { flow: … * (z_over - min(e, z_over) / 2) * min(e, z_over) } } k -> z_channel -> g;",
        ),
        (
            "z: NPN (k, l, g);",
            "z_base: Diode (l, g); 1 z_collector { Sf z { flow: … * z_base.current } } k -> z_collector -> g;",
        ),
        (
            "z: BodyRadiation { Gr: 0.1 } (k, l);",
            "1 z_between pseudo { R z { flow: 5.670374419e-8 * … * (powi(k.e, 4) - powi(l.e, 4)) } } k -> z_between -> l;",
        ),
        (
            "z: CheckValve (k, l);",
            "1 z_between { R z { flow: … * max(e, 0.0) } } k -> z_between; z_between -> l;",
        ),
        (
            "z: Position { s: 1.0 } (x);",
            "input z_rate; Sf z { flow: z_rate } -> x;",
        ),
    ] {
        let texts = typed(&model(part));
        assert_eq!(texts[0], written, "{part}");
        let typed_in = written.replace('…', "0.5");
        let left = told(&model(&typed_in));
        // A node that is true elsewhere in this model is no pseudo one.
        assert!(
            left.is_empty() || left.contains("pseudo"),
            "{typed_in}\n{left}"
        );
    }
}

/// A part of a word, or another part of physics, tells nothing.
#[test]
fn components_are_not_told_by_what_sounds_alike() {
    for (part, meant, other) in [
        (
            "z: IdealOpAmp3Pin (k, l, g);",
            "Se z { effort: 1e5 * (k.e - l.e) } -> g;",
            "Revolute",
        ),
        (
            "z: HydraulicMotor { displacement: 1.0 } (k, l, v);",
            "Pump",
            "DcMotor",
        ),
        (
            "z: SphericalSpherical { rodLength: 1.0 } (v, w);",
            "Rod",
            "Spherical",
        ),
        ("z: LineForceWithMass (v, w);", "LineForce", "PointMass"),
        (
            "z: RevolutePlanarLoopConstraint (v, w);",
            "Cut",
            "PlanarBody",
        ),
        ("z: IdealGearR2T { ratio: 2.0 } (v, w);", "Rack", "Gear"),
        (
            "z: FixedTemperature { T: 300.0 } (k);",
            "Se z { effort: 300.0 } -> k;",
            "Fixed",
        ),
    ] {
        let text = told(&model(part));
        assert!(text.contains(&format!("`{meant}`")), "{text}");
        assert!(!text.contains(&format!("`{other}`")), "{text}");
    }
    assert!(
        told(&model("z: OLine (k, l);"))
            .contains("it is a row of cells, `z: for k in 0..20 { … }`")
    );
    assert!(told(&model("z: Thyristor (k, l);")).contains("`Integrator::until`"));
}

/// `sqr` squares, and the remainder of other languages has the sign of what is divided.
#[test]
fn functions_are_told_by_what_they_give() {
    for (written, here) in [
        ("sqr(v.f)", "powi(v.f, 2)"),
        ("rem(v.f, 2.0)", "(sign(v.f) * mod(abs(v.f), 2.0))"),
        (
            "fmod(v.f - 1, 2.0)",
            "(sign(v.f - 1) * mod(abs(v.f - 1), 2.0))",
        ),
        ("div(v.f, 2.0)", "(sign(v.f / 2.0) * floor(abs(v.f / 2.0)))"),
        ("integer(v.f)", "floor(v.f)"),
        ("noEvent(v.f - 1)", "v.f - 1"),
        ("smooth(0, v.f)", "v.f"),
        ("homotopy(v.f, 1.0)", "v.f"),
        (
            "semiLinear(v.f, 1.0, 2.0)",
            "(1.0 * max(v.f, 0.0) + 2.0 * min(v.f, 0.0))",
        ),
        ("step(1.0)", "(if t < 1.0 { 0.0 } else { 1.0 })"),
        ("step(t - 1.0)", "(if t < 1.0 { 0.0 } else { 1.0 })"),
    ] {
        let text = |value: &str| model(&format!("Se z {{ effort: {value} }} -> v;"));
        assert_eq!(typed(&text(written))[0], here);
        assert_eq!(told(&text(here)), "");
    }
    let late = typed(&model("Se z { effort: tdelay(w.f, 0.1) } -> v;"));
    assert_eq!(late[1], "integral late = (w.f - late) / 0.1;");
}

/// The text for a parameter is taken: an axis is told as the number that it is.
#[test]
fn parameters_are_told_as_they_are_taken() {
    let part = |size: usize, part: &str| {
        format!(
            "#[derivative] model M {{ causality componentwise; 1 f[{size}]; 1 h[{size}]; Sf z[{size}] {{ flow: 0.0 }} -> f;
{part} (f, h); 1 c[{size}] {{ I i {{ inertia: 1.0 }} }} h -> c; }}"
        )
    };
    for (size, component, written, here) in [
        (6, "Revolute", "n: [0.0, 0.0, 1.0]", "axis: 2"),
        (6, "Prismatic", "axis: 0, s: 0.3", "initial: 0.3"),
        (6, "Prismatic", "axis: 0, v: 0.3", "initial_rate: 0.3"),
        (6, "Revolute", "axis: 0, phi: 0.3", "initial: 0.3"),
        (6, "Revolute", "axis: 0, w: 0.3", "initial_rate: 0.3"),
        (
            3,
            "PlanarPrismatic",
            "axis: [0.0, -1.0]",
            "direction: atan2(-1.0, 0.0)",
        ),
        (3, "PlanarPrismatic", "angle: 0.5", "direction: 0.5"),
    ] {
        let text = |arguments: &str| part(size, &format!("j: {component} {{ {arguments} }}"));
        let texts = typed(&text(written));
        assert_eq!(texts.last().unwrap(), here);
        let kept = written
            .rsplit_once(", ")
            .filter(|_| written.starts_with("axis: 0"));
        let whole = kept.map_or_else(|| here.to_owned(), |(kept, _)| format!("{kept}, {here}"));
        assert_eq!(told(&text(&whole)), "");
    }
    let clutch = "z: Clutch { fn_max: 100.0, mue_pos: 0.5 - 0.1, cgeo: 2.0 } (v, w);";
    let diagnostics = diagnose(&model(clutch));
    let helps: Vec<_> = diagnostics
        .list()
        .iter()
        .map(|it| it.helps.concat())
        .collect();
    assert_eq!(
        helps.len(),
        3,
        "each word once, and no value is missed: {helps:?}"
    );
    let capacity = helps[0].split('`').nth(1).unwrap();
    assert_eq!(capacity, "capacity: 100.0 * 2.0 * (0.5 - 0.1)");
    assert_eq!(
        told(&model(&format!("z: Clutch {{ {capacity} }} (v, w);"))),
        ""
    );
}

#[test]
fn laws_loops_starts_and_units_are_told() {
    let storage = |law: &str| model(&format!("1 a {{ I core {{ {law} }} }} k -> a; a -> g;"));
    let text = told(&storage("flux: 0.1 * f + atan(f)"));
    assert!(
        text.contains("`flow: interpolate(p, [flux, …], [flow, …])`"),
        "{text}"
    );
    assert_eq!(
        told(&storage(
            "flow: interpolate(p, [-0.1, 0.0, 0.1], [-3.0, 0.0, 3.0])"
        )),
        ""
    );

    let row = |range: &str| {
        model(&format!(
            "for i in {range} {{ 1 a {{ R b {{ resistance: 1.0 }} }} v -> a; }}"
        ))
    };
    let diagnostics = diagnose(&row("1:10 loop"));
    assert!(diagnostics.list()[0].helps[0].contains("`1..11`"));
    assert_eq!(told(&row("1..11")), "");

    let start = typed(&model("integral a = v.f, start: 1.0; output b = a;"));
    assert_eq!(start, ["initial: …"]);

    let brake = |signal: &str| {
        format!(
            "model M {{ 1 v {{ I m {{ inertia: 1.0 }} }} b: Brake {{ capacity: 5.0, engagement: {signal} }} (v); output y: rad/s = v.f; }}"
        )
    };
    assert_eq!(
        typed(&brake("min(max(t - 0.2, 0.0), 1.0)")).last().unwrap(),
        "1.0 * …"
    );
    assert_eq!(told(&brake("min(max(1.0 * t - 0.2, 0.0), 1.0)")), "");
}
