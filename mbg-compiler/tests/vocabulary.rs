//! Words that those who know other tools type, and what is to be typed instead: each text, once typed, compiles.
#![allow(clippy::unwrap_used)]

mod models;
mod told;

use mbg_compiler::compile::Routines;
use mbg_compiler::program::{Arguments, evaluate};
use models::compiled;
use told::{diagnose, told, typed};

/// Two shafts and a spring, with statements.
fn shafts(statements: &str) -> String {
    format!(
        "model M {{ 1 a {{ I m {{ inertia: 1.0 }} }} 1 b {{ I n {{ inertia: 1.0 }} C c {{ stiffness: 1.0 }} }}\n{statements} }}"
    )
}

/// Four nodes with statements.
fn circuit(statements: &str) -> String {
    format!(
        "model M {{ 0 a {{ C k {{ compliance: 1.0 }} }} 0 b {{ C l {{ compliance: 1.0 }} }}
         0 c {{ C m {{ compliance: 1.0 }} }} 0 d {{ C n {{ compliance: 1.0 }} }}\n{statements} }}"
    )
}

/// A body that floats, with statements.
fn hull(statements: &str) -> String {
    format!(
        "#[derivative] model M {{ causality componentwise; gravity [0.0, 0.0, -9.81]; 1 g[6] {{ Sf still {{ flow: 0.0 }} }} 1 hull[6];
         free: Free (g, hull); body: Body {{ mass: 2.0, inertia: 1.0 }} (hull);\n{statements} }}"
    )
}

/// A plate in a plane, with statements.
fn plate(statements: &str) -> String {
    format!(
        "#[derivative] model M {{ causality componentwise; gravity [0.0, -9.81]; 1 g[3] {{ Sf still {{ flow: 0.0 }} }} 1 plate[3];
         hinge: PlanarRevolute {{}} (g, plate); body: PlanarBody {{ mass: 2.0, inertia: 1.0 }} (plate);\n{statements} }}"
    )
}

/// What a slip is answered with first, with this in its gaps; typed in its place, it is no mistake.
fn follow(scene: &dyn Fn(&str) -> String, slip: &str, gap: &str) -> String {
    let mut written = typed(&scene(slip));
    // Names of functions of the runtime are told, too.
    written.retain(|it| it.ends_with(';'));
    let written = written.join(" ");
    let filled = written.replace('…', gap);
    assert_eq!(told(&scene(&filled)), "", "{slip}: {filled}");
    written
}

#[test]
fn vehicles_and_what_drives_them_are_told_with_elements() {
    for (slip, written) in [
        (
            "p: Thruster { thrust: 3.0 } (a);",
            "Se p { effort: 3.0 } -> a;",
        ),
        (
            "p: Buoyancy { density: 1e3, volume: 2.0 } (a);",
            "Se p { effort: 9.81 * 1e3 * 2.0 } -> a;",
        ),
        (
            "p: Drag { area: 1.0 } (a);",
            "R p { effort: … * f * abs(f) } -> a;",
        ),
        (
            "p: ShockAbsorber { c: 1e3, d: 10.0 } (a, b);",
            "0 p_between; 1 p { C spring { stiffness: 1e3 } R damper { resistance: 10.0 } } a -> p_between; p_between -> b; p_between -> p;",
        ),
        (
            "p: Oleo (a, b);",
            "0 p_between; 1 p { C gas { effort: … * pow(1 - q / …, -1.4) } R oil { effort: … * f * abs(f) } } a -> p_between; \
             p_between -> b; p_between -> p;",
        ),
    ] {
        assert_eq!(follow(&shafts, slip, "2.0"), written);
    }
    for (slip, part) in [
        (
            "p: TorqueConverter (a, b);",
            "Se p_turbine { effort: max(2.0 - 1.25 * p_ratio, 1.0) * p_torque } -> b;",
        ),
        (
            "p: LossyGear { ratio: 3.0, efficiency: 0.9 } (a, b);",
            "a -> TF p { flow: 1 / 3.0 } -> b; p_loss: Friction { sliding: … } (b);",
        ),
        (
            "p: Tyre { radius: 0.3 } (a, b);",
            "a -> TF p_rim { flow: 0.3 } -> p_road;",
        ),
    ] {
        // A gear holds the shafts together, whose second storage follows.
        let scene = |text: &str| shafts(text).replace("I n", "#[derivative] I n");
        let written = follow(&scene, slip, "2.0");
        assert!(written.contains(part), "{written}");
    }
}

#[test]
fn forces_on_frames_are_told_as_loads_and_resistors() {
    for (slip, part) in [
        (
            "p: Thruster { thrust: 3.0 } (hull);",
            "p: Load { force: [3.0, 0.0, 0.0] } (hull);",
        ),
        (
            "p: Drag (hull);",
            "hull[3..6] -> R p { effort: … * sqrt(transpose(f) * f + 1e-12) * f };",
        ),
        (
            "p: Aerodynamics { area: 2.0 } (hull);",
            "hull[3..6] -> R p { effort: 0.6 * 2.0 * sqrt(transpose(f) * f + 1e-12) * (diag(…, …, …) * f) };",
        ),
    ] {
        let written = follow(&hull, slip, "1.5");
        assert!(written.starts_with(part), "{written}");
    }
    let lift = typed(&hull("p: Buoyancy { density: 1e3, volume: 2.0 } (hull);"));
    let whole = format!(
        "{} {}",
        lift[0].replace("orientation_at: …", "orientation_at: free.orientation_b"),
        lift[2].replace('…', "0.1")
    );
    assert!(
        lift[0].contains("force: [0.0, 0.0, 9.81 * 1e3 * 2.0]"),
        "{lift:?}"
    );
    assert_eq!(lift[1], "orientation_b");
    let whole = whole.replace("} (hull); 1", "} (p_at); 1");
    assert_eq!(told(&hull(&whole)), "");
    for (slip, written) in [
        (
            "p: Thruster { thrust: 3.0 } (plate);",
            "p: PlanarLoad { force: [3.0, 0.0] } (plate);",
        ),
        (
            "p: Drag (plate);",
            "plate[1..3] -> R p { effort: … * sqrt(transpose(f) * f + 1e-12) * f };",
        ),
        (
            "p: Buoyancy { volume: 2.0 } (plate);",
            "p: PlanarLoad { axes: world, force: [0.0, 9.81 * … * 2.0] } (plate);",
        ),
    ] {
        assert_eq!(follow(&plate, slip, "1.5"), written);
    }
    assert_eq!(
        typed(&hull("p: Tyre { stiffness: 1e5 } (hull);")),
        ["Contact"]
    );
    assert_eq!(
        typed(&plate("p: Tire { stiffness: 1e5 } (plate);")),
        ["PlanarContact"]
    );
}

#[test]
fn parts_of_circuits_are_told_with_elements() {
    for (slip, part) in [
        (
            "p: HBridge (a, b, c, d);",
            "p_load -> MTF p { flow: … } -> p_supply;",
        ),
        (
            "p: SolarCell { photocurrent: 3.0 } (a, b);",
            "p_junction: Diode (a, b); 1 p_light { Sf p { flow: 3.0 } } b -> p_light -> a;",
        ),
        (
            "p: Fuse (a, b);",
            "1 p_wire { R p { resistance: if p_blown > 0.5 { 1e9 } else { 1e-3 } } }",
        ),
        (
            "p: PWM { frequency: 1e3, duty: 0.3, voltage: 5.0 } (a, b);",
            "1 p_between { Se p { effort: if mod(t, 1 / 1e3) < 0.3 / 1e3 { 5.0 } else { 0.0 } } }",
        ),
        (
            "p: PWM { frequency: 1e3 };",
            "let p = if mod(t, 1e-3) < 0.5 * 1e-3 { 1.0 } else { 0.0 };",
        ),
    ] {
        // A bridge and a source hold their nodes together, of which one follows.
        let scene = |text: &str| circuit(text).replace("{ C ", "{ #[derivative] C ");
        let written = follow(&scene, slip, "0.5");
        assert!(written.contains(part), "{written}");
    }
    let divider = typed(&circuit("p: Potentiometer { resistance: 1e3 } (a, b, c);"));
    assert_eq!(
        divider[0],
        "p_upper: Resistor { resistance: (1 - …) * 1e3 } (a, c); p_lower: Resistor { resistance: … * 1e3 } (c, b);"
    );
    let whole = format!("{} {}", divider[1], divider[0].replace('…', "p_place"));
    assert_eq!(told(&circuit(&whole)), "");
}

/// Outputs at the start, whose state is of zeros.
fn outputs(text: &str) -> Vec<f64> {
    let model = compiled(text);
    let state = vec![0.0; model.states.len()];
    let arguments = Arguments {
        parameters: &[],
        time: 0.0,
        state: &state,
        input: &[],
    };
    evaluate(&model.program, Routines::OUTPUT, &arguments)
}

/// What is told of bridges and controlled sources gives the voltages and currents that these have.
#[test]
fn bridges_and_controlled_sources_drive_as_they_are_called() {
    let driven = |part: &str, output: &str| {
        outputs(&format!(
            "model M {{ 1 apart {{ I i {{ inertia: 1.0 }} R j {{ resistance: 1.0 }} }}
             0 a {{ Se s {{ effort: 10.0 }} }} 0 b {{ Se y {{ effort: 0.0 }} }} 0 c; 0 d {{ Se z {{ effort: 0.0 }} }}
             1 load {{ R r {{ resistance: 2.0 }} }} c -> load -> d; {part} {output} }}"
        ))
    };
    let bridge = typed(&circuit("p: HBridge (a, b, c, d);"))[0].replace('…', "0.25");
    let found = driven(&bridge, "output i = load.f; output from = p_supply.f;");
    assert!((found[0] - 0.25 * 10.0 / 2.0).abs() < 1e-12, "{found:?}");
    assert!((found[1] - 0.25 * found[0]).abs() < 1e-12, "{found:?}");
    for (slip, current) in [
        // Two amperes through the wire, times the gain, from c to d: out of the load.
        ("p: CCC { gain: 3.0 } (a, b, c, d);", -3.0 * 2.0),
        ("p: CCV { gain: 3.0 } (a, b, c, d);", 3.0 * 2.0 / 2.0),
    ] {
        let written = typed(&circuit(slip)).join(" ");
        let written = written.replace("a -> p_sensed", "f -> p_sensed");
        let wire = "0 f; 1 e { R q { resistance: 5.0 } } a -> e; e -> f;";
        let found = driven(&format!("{wire} {written}"), "output i = load.f;");
        assert!((found[0] - current).abs() < 1e-12, "{slip}: {found:?}");
    }
}

/// The torque of the machine that is told is that of its flux and its current.
#[test]
fn a_machine_of_three_phases_is_told_in_two_axes() {
    let text = typed(&shafts("p: InductionMachine (a, b);"));
    let machine = text[0].clone();
    let model = format!(
        "model M {{ let ls = 1.0; let lm = 0.9; let lr = 1.1; let rs = 0.1; let rr = 0.2; let pairs = 2.0; let u = 3.0; let w = 4.0;
         1 shaft {{ I rotor {{ inertia: 0.5 }} }} {machine} }}"
    );
    assert_eq!(told(&model), "");
    let model = compiled(&model);
    // The momentum of the shaft, then the flux linkages of stator and rotor.
    let state = [0.3, 0.2, -0.4, 0.7, 0.5];
    let arguments = Arguments {
        parameters: &[],
        time: 0.0,
        state: &state,
        input: &[],
    };
    let rates = evaluate(&model.program, Routines::DERIVATIVE, &arguments);
    let determinant = 1.0 * 1.1 - 0.9 * 0.9;
    let current = |stator: f64, rotor: f64| (1.0 * rotor - 0.9 * stator) / determinant;
    let (along, across) = (current(state[1], state[3]), current(state[2], state[4]));
    let torque = 2.0 * (state[4] * along - state[3] * across);
    assert!((rates[0] - torque).abs() < 1e-12, "{rates:?}");
    let speed = 2.0 * state[0] / 0.5;
    assert!(
        (rates[3] - (-0.2 * along - speed * state[4])).abs() < 1e-12,
        "{rates:?}"
    );
    assert!(
        (rates[4] - (-0.2 * across + speed * state[3])).abs() < 1e-12,
        "{rates:?}"
    );
}

#[test]
fn functions_that_keep_what_was_are_told_as_integrals() {
    for (slip, written) in [
        (
            "rate_limit(u, 5.0)",
            "integral late = min(max((u - late) / 1e-3, -5.0), 5.0);",
        ),
        (
            "SlewRateLimiter(u, 5.0, -3.0)",
            "integral late = min(max((u - late) / 1e-3, -3.0), 5.0);",
        ),
        (
            "rateLimiter(u, -3.0, 5.0)",
            "integral late = min(max((u - late) / 1e-3, -3.0), 5.0);",
        ),
        (
            "low_pass(u + 1, 0.1)",
            "integral late = ((u + 1) - late) / 0.1;",
        ),
        (
            "limint(u, 0.0, 1.0, 0.5)",
            "integral late = if late > 1.0 { min(u, 0.0) } else if late < 0.0 { max(u, 0.0) } else { u }, initial: 0.5;",
        ),
    ] {
        let told_so = typed(&shafts(&format!("input u; output y = {slip};")));
        assert_eq!(told_so, [written, "late"]);
        let typed = format!("input u; {written} output y = late;");
        assert_eq!(told(&shafts(&typed)), "");
    }
}

#[test]
fn functions_are_told_in_any_spelling_and_with_their_signs() {
    for (slip, written) in [
        (
            "tablelookup(c.q, [0.0, 1.0], [0.0, 2.0])",
            "interpolate(c.q, [0.0, 1.0], [0.0, 2.0])",
        ),
        (
            "tableLookup([0.0, 1.0], [0.0, 2.0], c.q)",
            "interpolate(c.q, [0.0, 1.0], [0.0, 2.0])",
        ),
        (
            "If_Else(c.q > 1.0, 1.0, 2.0)",
            "(if (c.q > 1.0) { 1.0 } else { 2.0 })",
        ),
        ("root(c.q, 3)", "(sign(c.q) * pow(abs(c.q), 1.0 / 3))"),
        ("root(c.q)", "sqrt(c.q)"),
        ("rem(c.q, -3.0)", "(sign(c.q) * mod(abs(c.q), 3.0))"),
        ("fmod(c.q, c.e)", "(sign(c.q) * mod(abs(c.q), abs(c.e)))"),
        ("c.q.rem_euclid(-3.0)", "mod(c.q, 3.0)"),
        (
            "remainder(c.q, 3.0)",
            "(c.q - 3.0 * floor(c.q / 3.0 + 0.5))",
        ),
        ("regRoot(c.q, 1e-3)", "(sign(c.q) * sqrt(abs(c.q)))"),
        ("regSquare(c.q)", "(c.q * abs(c.q))"),
        ("Modelica.Constants.pi * c.q", "3.141592653589793"),
        ("Modelica.Constants.g_n * c.q", "9.80665"),
    ] {
        let output = |read: &str| shafts(&format!("output y = {read};"));
        assert_eq!(typed(&output(slip)), [written], "{slip}");
        assert_eq!(told(&output(written)), "");
    }
    let signed = typed(&shafts("output y = c.q % -3.0;"));
    assert_eq!(signed, ["mod(c.q, -3.0)", "-3.0"]);
    let turn = "let turn = rot_z(c.q);";
    let inverse = typed(&shafts(&format!(
        "{turn} output y[3] = inverse(turn) * [1.0, 0.0, 0.0];"
    )));
    assert_eq!(inverse[0], "transpose(turn)");
    assert_eq!(
        told(&shafts(&format!(
            "{turn} output y[3] = transpose(turn) * [1.0, 0.0, 0.0];"
        ))),
        ""
    );
}

/// What `root` of a negative value and `rem` by a negative one are told as has their values elsewhere.
#[test]
fn roots_and_remainders_are_those_of_other_languages() {
    let value = |law: &str| {
        let text = format!(
            "model M {{ param x = -7.5; 1 a {{ I m {{ inertia: 1.0 }} R r {{ resistance: 1.0 }} }} output y = {law}; }}"
        );
        let model = compiled(&text.replace(law, &typed(&text)[0]));
        let arguments = Arguments {
            parameters: &[-7.5],
            time: 0.0,
            state: &[0.0],
            input: &[],
        };
        evaluate(&model.program, Routines::OUTPUT, &arguments)[0]
    };
    for (law, expected) in [
        ("root(x, 3)", (-7.5_f64).cbrt()),
        ("rem(x, -2.0)", -7.5 % -2.0),
        ("fmod(x, 2.0)", -7.5 % 2.0),
        ("x.rem_euclid(-2.0)", (-7.5_f64).rem_euclid(-2.0)),
        ("remainder(x, 2.0)", 0.5),
    ] {
        assert!(
            (value(law) - expected).abs() < 1e-12,
            "{law}: {}",
            value(law)
        );
    }
}

#[test]
fn imports_annotations_and_sequences_are_told_where_they_belong() {
    let import = typed(&shafts("import Modelica.Constants.pi;"));
    assert_eq!(import, ["let pi = 3.141592653589793;"]);
    assert_eq!(told(&shafts(&format!("{} output y = pi;", import[0]))), "");
    let before = told(&format!("import Modelica.Units.SI; {}", shafts("")));
    assert!(
        before.contains("leave `import Modelica.Units.SI;` out"),
        "{before}"
    );
    let annotation = told(&shafts("annotation(experiment(StopTime = 1.0));"));
    assert!(
        annotation.contains("leave `annotation(…)` out"),
        "{annotation}"
    );
    let free =
        |given: &str| hull("").replace("free: Free (", &format!("free: Free {{ {given} }} ("));
    for slip in [
        "sequence: zyx",
        "rotation_order: \"ZYX\"",
        "sequence: [3, 2, 1]",
        "sequence: [2, 1, 0]",
    ] {
        assert_eq!(typed(&free(slip)), ["first: 2, second: 1, third: 0"]);
    }
    assert_eq!(told(&free("first: 2, second: 1, third: 0")), "");
    let alone = typed(&hull("sequence: zyx;"));
    assert_eq!(
        alone,
        ["free: Free { first: 2, second: 1, third: 0 } (a, b);"]
    );
}

#[test]
fn magnetic_circuits_and_heat_are_told_by_their_laws() {
    let coil = |winding: &str, core: &str| {
        format!(
            "model M {{ 1 coil {{ Se supply {{ effort: 10.0 }} R wire {{ resistance: 2.0 }} }} 0 core {{ C gap {{ {core} }} }} \
             coil -> GY winding {{ {winding} }} -> core; output flux = gap.q; }}"
        )
    };
    let slips = [
        (coil("turns: 100.0", "stiffness: 2.0"), "effort: 100.0"),
        (coil("effort: 3.0", "reluctance: 1e6"), "stiffness: 1e6"),
        (coil("effort: 3.0", "permeance: 1e-6"), "compliance: 1e-6"),
        (coil("effort: 3.0", "heat_capacity: 5.0"), "compliance: 5.0"),
    ];
    for (slip, written) in slips {
        assert_eq!(typed(&slip)[0], written);
    }
    assert_eq!(told(&coil("effort: 100.0", "stiffness: 1e6")), "");
}

#[test]
fn defaults_with_units_and_attitudes_in_braces_are_told_as_they_are_declared() {
    for (given, number) in [("3kN / m", "3.0 * 1000"), ("2.5kg * m / s", "2.5")] {
        let slip = shafts(&format!("param k = {given};"));
        assert_eq!(typed(&slip).last().unwrap(), number);
        assert_eq!(told(&shafts(&format!("param k = {number};"))), "");
    }
    let body = |attitude: &str| {
        format!(
            "model M {{ 1 hull[3] {{ I body {{ inertia: 2.0, gyroscopic }} }} {attitude} output turn[4] = a; }}"
        )
    };
    let typed = typed(&body("attitude a { rate: hull.f, initial: 1.0 }"));
    assert_eq!(typed, ["attitude a = quaternion(hull.f);"]);
    assert_eq!(told(&body(&typed[0])), "");
}

#[test]
fn a_diode_of_two_slopes_is_told_as_a_resistor() {
    for (slip, flow) in [
        ("Ron: 1e-3, Goff: 1e-6", "max(e, 0.0) / 1e-3 + 1e-6 * e"),
        (
            "Ron: 1e-3, Vknee: 0.7",
            "max(e - 0.7, 0.0) / 1e-3 + 1e-5 * e",
        ),
    ] {
        let written = follow(&circuit, &format!("p: Diode {{ {slip} }} (a, b);"), "1.0");
        let whole = format!("1 p {{ R p_slopes {{ flow: {flow} }} }} a -> p; p -> b;");
        assert_eq!(written, whole);
    }
}

#[test]
fn components_of_velocities_and_powers_are_told_as_they_are_read() {
    for (scene, read, written, size) in [
        (0, "a.vx", "a.f", ""),
        (0, "m.v", "m.f", ""),
        (0, "c.loss", "c.e * c.f", ""),
        (1, "hull.vx", "hull.f[3]", ""),
        (1, "hull.omega_z", "hull.f[2]", ""),
        (1, "body.vz", "hull.f[5]", ""),
        (1, "body.position", "free.position_b", "[3]"),
        (1, "body.omega", "hull.f[0..3]", "[3]"),
        (2, "body.position", "hinge.position_b", "[2]"),
        (2, "plate.angle", "hinge.angle_b", ""),
        (2, "plate.vy", "plate.f.y", ""),
    ] {
        let scenes: [&dyn Fn(&str) -> String; 3] = [&shafts, &hull, &plate];
        let output = |read: &str| scenes[scene](&format!("output y{size} = {read};"));
        assert_eq!(typed(&output(read))[0], written, "{read}");
        assert_eq!(told(&output(written)), "");
    }
    assert_eq!(typed(&plate("output y = plate.vy;"))[1], "plate.f[2]");
    let rods = |read: &str| {
        format!(
            "model M {{ rods: for k in 0..2 {{ 1 end[6]; body: Body {{ mass: 1.0, inertia: 1.0 }} (end); }}
             output y = {read}; }}"
        )
    };
    assert_eq!(typed(&rods("rods[1].body.vz"))[0], "rods[1].end.f[5]");
    assert_eq!(told(&rods("rods[1].end.f[5]")), "");
    let vector = |read: &str| {
        format!(
            "model M {{ 1 v[3] {{ I m {{ inertia: 1.0 }} R r {{ resistance: 1.0 }} }} output y = {read}; }}"
        )
    };
    for (read, written) in [
        ("r.power", "transpose(r.e) * r.f"),
        ("m.energy", "0.5 * transpose(m.p) * m.f"),
    ] {
        assert_eq!(typed(&vector(read))[0], written);
        assert_eq!(told(&vector(written)), "");
    }
    let acceleration = told(&shafts("output y = m.a;"));
    assert!(
        acceleration.contains("laws take no derivatives"),
        "{acceleration}"
    );
}

#[test]
fn axes_and_inertias_of_other_shapes_are_told() {
    let foot = |normal: &str| {
        hull(&format!(
            "foot: Contact {{ stiffness: 1e4, normal: {normal} }} (hull);"
        ))
    };
    for (slip, written) in [
        ("z", "[0.0, 0.0, 1.0]"),
        ("-y", "[0.0, -1.0, 0.0]"),
        ("2", "[0.0, 0.0, 1.0]"),
    ] {
        assert_eq!(
            typed(&foot(slip)).pop().unwrap(),
            format!("normal: {written}")
        );
        assert_eq!(told(&foot(written)), "");
    }
    let rows = (0..6).map(|row| {
        let entries = (0..6).map(|column| if row == column { "2.0" } else { "0.0" });
        format!("[{}]", entries.collect::<Vec<_>>().join(", "))
    });
    let rows = rows.collect::<Vec<_>>().join(", ");
    let water = typed(&hull("").replace("inertia: 1.0", &format!("inertia: [{rows}]")));
    let written = "body_water: AddedMass { mass: diag(…, …, …), inertia: diag(…, …, …) } (hull);";
    assert_eq!(water.last().unwrap(), written);
    assert_eq!(told(&hull(&written.replace('…', "2.0"))), "");
}

#[test]
fn elements_and_bonds_of_other_drawings_are_told() {
    let damper = "D d { resistance: 1.0 }";
    for slip in [
        format!("{damper} -> a;"),
        format!("a -> {damper};"),
        format!("1 x {{ {damper} }} x -> a;"),
    ] {
        assert_eq!(
            typed(&shafts(&slip)),
            ["R name { resistance: … }"],
            "{slip}"
        );
    }
    let sensor = told(&shafts("a -> SS s;"));
    assert!(
        sensor.contains("a source and what it measures are written apart"),
        "{sensor}"
    );
    let parts = |bond: &str| {
        format!(
            "model M {{ 1 v[3] {{ I m {{ inertia: 1.0 }} }} 1 w[2] {{ R r {{ resistance: 1.0 }} }} 1 u {{ R s {{ resistance: 1.0 }} }} {bond} }}"
        )
    };
    for (slip, written) in [
        ("v -> w; v.z -> u;", "v[0..2]"),
        ("v[0..2] -> w; v -> u;", "v.x"),
    ] {
        assert_eq!(typed(&parts(slip)), [written]);
        assert_eq!(
            told(&parts(&slip.replace("v -> ", &format!("{written} -> ")))),
            ""
        );
    }
}

#[test]
fn transformers_that_were_meant_otherwise_are_told() {
    let motor = |element: &str| {
        format!(
            "model M {{ 1 coil {{ I l {{ inertia: 1.0 }} Se s {{ effort: 1.0 }} }} 1 shaft {{ I j {{ inertia: 1.0 }} }} coil -> {element} -> shaft; }}"
        )
    };
    let forced = diagnose(&motor("TF k { flow: 0.1 }"));
    let help = forced.list()[0].helps.last().unwrap().clone();
    assert!(
        help.contains("write `GY k { effort: … }` in the place of `TF k`"),
        "{help}"
    );
    assert_eq!(told(&motor("GY k { effort: 0.1 }")), "");
    let lever = |bonds: &str| {
        format!(
            "model M {{ let w = [1.0, 2.0, 0.5]; 1 a {{ R r {{ resistance: 1.0 }} }} 1 b[3] {{ I m {{ inertia: 1.0 }} }} {bonds} }}"
        )
    };
    assert_eq!(
        typed(&lever("a -> TF t { effort: w } -> b;")),
        ["flow: 1 / w", "flow: transpose(w)", "flow"]
    );
    assert_eq!(told(&lever("b -> TF t { flow: transpose(w) } -> a;")), "");
}
