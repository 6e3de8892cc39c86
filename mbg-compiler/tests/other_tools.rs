//! Elements and components of other tools, and what is to be typed instead.
#![allow(clippy::unwrap_used)]

mod told;

use told::{diagnose, told, typed};

/// Two masses and a statement.
fn masses(statement: &str) -> String {
    format!(
        "model M {{ 1 v {{ I m {{ inertia: 1.0 }} }} 1 w[3] {{ I n {{ inertia: 2.0 }} }} 0 k {{ C c {{ stiffness: 1.0 }} }}\n{statement} }}"
    )
}

/// Driveline parts of other tools: each is told as the component that it is here, with its parameters.
#[test]
fn parts_of_drivelines_are_told_by_their_names_here() {
    let axle = |part: &str| {
        format!(
            "#[derivative] model M {{ 1 a {{ I m {{ inertia: 1.0 }} }} 1 b {{ I n {{ inertia: 1.0 }} }} 1 c {{ R r {{ resistance: 1.0 }} }}
{part} }}"
        )
    };
    for (part, written, whole) in [
        (
            "g: FrictionClutch { capacity: 3.0 } (a, b);",
            "Clutch",
            "g: Clutch { capacity: 3.0 } (a, b);",
        ),
        (
            "g: Clutch { max_torque: 3.0 } (a, b);",
            "capacity: 3.0",
            "g: Clutch { capacity: 3.0 } (a, b);",
        ),
        (
            "g: OneWayClutch { capacity: 3.0 } (a, b);",
            "Freewheel",
            "g: Freewheel { capacity: 3.0 } (a, b);",
        ),
        (
            "g: Disc_Brake { capacity: 3.0 } (a);",
            "Brake",
            "g: Brake { capacity: 3.0 } (a);",
        ),
        (
            "g: ElastoBacklash { gap: 0.1, stiffness: 1e3 } (a, b);",
            "Backlash",
            "g: Backlash { gap: 0.1, stiffness: 1e3 } (a, b);",
        ),
        (
            "g: Backlash { b: 0.1, stiffness: 1e3 } (a, b);",
            "gap: 0.1",
            "g: Backlash { gap: 0.1, stiffness: 1e3 } (a, b);",
        ),
        (
            "g: TorsionBar { stiffness: 1e3 } (a, b);",
            "ElasticShaft",
            "g: ElasticShaft { stiffness: 1e3 } (a, b);",
        ),
        (
            "g: OpenDifferential { ratio: 3.0 } (a, b, c);",
            "Differential",
            "g: Differential { ratio: 3.0 } (a, b, c);",
        ),
        (
            "g: IdealPlanetary { ratio: 3.0 } (a, b, c);",
            "Planetary",
            "g: Planetary { ratio: 3.0 } (a, b, c);",
        ),
        (
            "g: Gear { ratio: 3.5 } (a, c);",
            "a -> TF g { flow: 1 / 3.5 } -> c;",
            "a -> TF g { flow: 1 / 3.5 } -> c;",
        ),
    ] {
        assert_eq!(typed_first(&axle(part)), written);
        assert_eq!(told(&axle(whole)), "");
    }
    // The ratio stands for both radii, which are not asked for then.
    let ratio = told(&axle("g: Gear { ratio: 3.5 } (a, c);"));
    assert_eq!(ratio.matches("[MBG").count(), 1, "{ratio}");
    assert_eq!(
        typed(&axle("g: IdealGear (a, c);")),
        ["a -> TF g { flow: 1 / … } -> c;"]
    );
}

/// The first text in backticks that a help gives for what is no name.
fn typed_first(text: &str) -> String {
    let diagnostics = diagnose(text);
    let mut helps = diagnostics.list()[0].helps.iter();
    let help = helps.next().unwrap();
    help.split('`').nth(1).unwrap().to_owned()
}

/// Components of other tools are told by their words, and else by what is spelled alike.
#[test]
fn unknown_components_are_told_by_the_nearest() {
    let text = |component: &str| {
        format!(
            "model M {{ 1 a {{ I m {{ inertia: 1.0 }} }} 1 b {{ I n {{ inertia: 1.0 }} }} part:\n{component} (a, b); }}"
        )
    };
    insta::assert_snapshot!(told(&text("BoxBody")), @"
    2:1 component `BoxBody` is not declared [MBG0203]
      help: the library has `Body`, `BodyContact`, `PlanarBody`, `PlanarBodyContact`, see the page `library` of the documentation of `mbg_runtime`
    ");
    insta::assert_snapshot!(told(&text("Valv")), @"
    2:1 component `Valv` is not declared [MBG0203]
      help: the library has `Orifice`, see the page `library` of the documentation of `mbg_runtime`
    ");
    insta::assert_snapshot!(told(&text("Resistance")), @"
    2:1 component `Resistance` is not declared [MBG0203]
      help: the library has `Resistor`, see the page `library` of the documentation of `mbg_runtime`
    ");
    insta::assert_snapshot!(told(&text("Gyrator")), @"
    2:1 component `Gyrator` is not declared [MBG0203]
      help: here it is written `a -> GY part { effort: … } -> b;`
    ");
}

/// A vector is two parameters in a plane, and two parameters are a vector in space.
#[test]
fn vectors_are_told_as_the_component_takes_them() {
    let planar = |arguments: &str| {
        format!(
            "#[derivative] model M {{ causality componentwise; 1 ground[3]; 1 rod[3]; 1 end[3]; Sf fixed[3] {{ flow: 0.0 }} -> ground;
             hinge: PlanarRevolute (ground, rod); arm: PlanarOffset {{ {arguments} }} (rod, end);
             bob: PlanarPointMass {{ mass: 2.0 }} (end); }}"
        )
    };
    assert_eq!(typed(&planar("by: [0.0, -0.5]")), ["x: 0.0, y: -0.5"]);
    assert_eq!(told(&planar("x: 0.0, y: -0.5")), "");
    let spatial = |arguments: &str| {
        format!(
            "#[derivative] model M {{ causality componentwise; 1 ground[6]; 1 rod[6]; 1 end[6]; Sf fixed[6] {{ flow: 0.0 }} -> ground;
             hinge: Revolute {{ axis: 1 }} (ground, rod); arm: Offset {{ {arguments} }} (rod, end);
             bob: PointMass {{ mass: 2.0 }} (end); }}"
        )
    };
    assert_eq!(typed(&spatial("x: 0.1, z: -0.5")), ["by: [0.1, 0.0, -0.5]"]);
    assert_eq!(told(&spatial("by: [0.1, 0.0, -0.5]")), "");
}

/// Elements that bond graphs elsewhere have, and sizes before names.
#[test]
fn elements_of_other_tools_are_told_as_they_are_written_here() {
    let within = |element: &str| {
        told(&masses(&format!(
            "1 x {{ {element} x_d {{ effort: 1.0 }} }}"
        )))
    };
    let behind = |element: &str| told(&masses(&format!("v -> {element} x_d {{ effort: 1.0 }};")));
    insta::assert_snapshot!(["MR", "De", "Df", "SS", "RS", "Ce", "Re", "IC", "L", "Sw", "R[2]"].map(within).join("\n"), @"
    2:7 expected an element, found `MR` [MBG0101]
      help: write `R`: any law may be modulated by what it reads
    2:7 expected an element, found `De` [MBG0101]
      help: what is measured is read, and needs no detector: `output name = node.e;` of a 0-junction `node`
    2:7 expected an element, found `Df` [MBG0101]
      help: what is measured is read, and needs no detector: `output name = rod.f;` of a 1-junction `rod`
    2:7 expected an element, found `SS` [MBG0101]
      help: a source and what it measures are written apart: `Se name { effort: … }` and `output measured = name.f;`, or `Sf` and `name.e`
    2:7 expected an element, found `RS` [MBG0101]
      help: write `R name { … }`, and the entropy that it generates as a source of flow where the temperature `node.e` is: `Sf entropy { flow: name.e * name.f / node.e }`
    2:7 expected an element, found `Ce` [MBG0101]
      help: write `C name { effort: rt * ln(k * q), initial: … }`: the chemical potential of the amount `q`, with `rt` in `J/mol`
    2:7 expected an element, found `Re` [MBG0101]
      help: a reaction takes both affinities: `forward -> name[0]; name[1] -> reverse;` of a junction `0 name[2]`, and `name -> R reaction[2] { flow: [rate, -rate] }` with `let rate = kappa * (exp(name.e[0] / rt) - exp(name.e[1] / rt));`
    2:7 expected an element, found `IC` [MBG0101]
      help: write `C name { energy: … }` on a junction with a component for each port; a port of a momentum lies behind a `GY` with `effort: 1.0`
    2:7 expected an element, found `L` [MBG0101]
      help: write `I name { inertia: … }`
    2:7 expected an element, found `Sw` [MBG0101]
      help: a switch is `R name { conductance: if … { … } else { … } }`, or on the average an `MTF`
    2:8 expected the name of the element after `R`, found `[` [MBG0101]
      help: an element has the size of its junction: write `R x_d`
    ");
    for element in ["MSe", "MR", "RS"] {
        let help = |text: String| text.split_once("help: ").map(|(_, help)| help.to_owned());
        assert_eq!(help(behind(element)), help(within(element)));
    }
}

/// Junctions by the names of the ports.
#[test]
fn ports_are_told_to_have_an_order() {
    let piston = |ports: &str| {
        format!(
            "component Piston(port oil, port 1 rod) {{ param area = 1.0; oil -> TF t {{ flow: 1.0 / area }} -> rod; }} {}",
            masses(&format!("piston: Piston {{ area: 2.0 }} ({ports});"))
        )
    };
    for ports in ["oil: k, rod: v", "oil = k, rod = v"] {
        let help = typed(&piston(ports)).remove(0);
        assert_eq!(help, "piston: Piston { area: 2.0 } (k, v);");
    }
    assert_eq!(told(&piston("k, v")), "");
}

/// What an element in the place of a value is read by.
#[test]
fn variables_of_elements_are_told_by_their_kind() {
    let read = |name: &str| {
        told(&masses(&format!(
            "v -> GY g {{ effort: 1.0 }} -> k; k -> R r {{ resistance: 1.0 }}; output y = {name};"
        )))
    };
    insta::assert_snapshot!(["m", "c", "r", "g"].map(read).join("\n"), @"
    2:74 `m` is an element; write `m.p`, `.e` or `.f` [MBG0213]
      help: for its inertia give that a name: `param m_inertia = …;` and `inertia: m_inertia`
    2:74 `c` is an element; write `c.q`, `.e` or `.f` [MBG0213]
      help: for its stiffness give that a name: `param c_stiffness = …;` and `stiffness: c_stiffness`
    2:74 `r` is an element; write `r.e` or `.f` [MBG0213]
      help: for its resistance give that a name: `param r_resistance = …;` and `resistance: r_resistance`
    2:74 `g` is an element; a two-port has two efforts and two flows; read them at a junction [MBG0213]
    ");
}

/// Displacements of masses and junctions, and momenta of springs, are integrals.
#[test]
fn displacements_that_are_no_states_are_told_as_integrals() {
    for (read, integral) in [
        ("m.q", "integral q_m = m.f, initial: 0.0;"),
        ("n.q", "integral q_n[3] = n.f;"),
        ("v.q", "integral q_v = v.f, initial: 0.0;"),
        ("w.q", "integral q_w[3] = w.f;"),
        ("c.p", "integral p_c = c.e, initial: 0.0;"),
        ("k.p", "integral p_k = k.e, initial: 0.0;"),
    ] {
        let helps = typed(&masses(&format!("output y = {read};")));
        assert_eq!(helps[0], integral);
        let size = if helps[0].contains('[') { "[3]" } else { "" };
        let typed = format!("{} output y{size} = {};", helps[0], helps[1]);
        assert_eq!(told(&masses(&typed)), "");
    }
    assert_eq!(typed(&masses("output y = k.q;"))[0], "c.q");
    // The rate of an integral is written where it is declared.
    let rate = told(&masses("integral way = v.f; output y = der(way);"));
    assert!(
        rate.contains("an integral has the rate that it is declared with; where `way` is an input"),
        "{rate}"
    );
}

/// Blocks of block diagrams, as components and as functions: what is told compiles, with what goes in.
#[test]
fn blocks_are_told_as_values_and_integrals() {
    let shaft = |text: &str| {
        format!(
            "model M {{ 1 shaft {{ I rotor {{ inertia: 0.1 }} R r {{ resistance: 0.2 }} }}\n{text} }}"
        )
    };
    let known = "input u; let v = shaft.f; let kp = 1.0; let ki = 2.0; let kd = 0.1; let rate = 2.0;
        let a = 0.0; let b = 1.0; let c = -2.0; let d = -3.0; let e = 0.0; let f = 1.0; let g = 1.0; let h = 0.0;
        let a0 = 2.0; let a1 = 3.0; let b0 = 1.0; let b1 = 0.5;";
    for block in [
        "PID",
        "Gain",
        "Sum",
        "Product",
        "Integrator",
        "Differentiator",
        "TransferFunction",
        "Transfer_Fcn",
        "StateSpace",
        "LowPass",
        "FirstOrder",
        "Saturation",
        "DeadZone",
        "RateLimiter",
        "Quantizer",
        "Delay",
        "TransportDelay",
        "Constant",
        "SineWave",
        "LookupTable",
    ] {
        let instance = format!("w: {block} {{ k: 2.0 }} (shaft);");
        let written = typed(&shaft(&instance)).remove(0);
        let whole = format!("{known} {written} output w = w;");
        assert_eq!(told(&shaft(&whole)), "", "{block}: {written}");
    }
    for (block, part) in [
        ("Relay", "`Integrator::until` finds where it changes"),
        ("UnitDelay", "stays over each step of `Rk4::step`"),
        ("SpeedSensor", "write `output w = ….f;`"),
        ("Scope", "write `output w = u;`, with what goes in as `u`"),
    ] {
        let text = told(&shaft(&format!("w: {block} (shaft);")));
        assert!(text.contains(part), "{text}");
    }
    for (law, part) in [
        ("tf([1.0], [1.0, 2.0])", "write `integral y_x[2] ="),
        ("relay(shaft.f, 0.1)", "`Integrator::until`"),
        ("quantize(shaft.f, 0.1)", "floor(u / 0.1 + 0.5);`"),
    ] {
        let text = told(&shaft(&format!("Se motor {{ effort: {law} }} -> shaft;")));
        assert!(text.contains(part), "{text}");
    }
}

/// Without regard to capitals, in a bond, in the braces of a junction, as a statement and as a component.
#[test]
fn elements_are_told_in_any_case_and_place() {
    for (called, kind) in [
        ("MSe", "Se"),
        ("mse", "Se"),
        ("MSF", "Sf"),
        ("mR", "R"),
        ("Spring", "C"),
        ("Mass", "I"),
        ("Resistor", "R"),
    ] {
        for place in [
            format!("{called} x {{ effort: 1.0 }};"),
            format!("v -> {called} x {{ effort: 1.0 }};"),
            format!("1 z {{ {called} x {{ effort: 1.0 }} }} z -> v;"),
        ] {
            let helps = diagnose(&masses(&place)).list()[0].helps.clone();
            let is_told = helps[0].contains(&format!("`{kind}`"))
                || helps[0].contains(&format!("`{kind} name {{"))
                || helps[0].contains("x: Resistor");
            assert!(is_told, "{place}: {helps:?}");
        }
    }
    for (called, written) in [
        ("x: mse { effort: 1.0 } (v);", "Se x { effort: 1.0 } -> v;"),
        (
            "x: MR { resistance: 1.0 } (v);",
            "v -> R x { resistance: 1.0 };",
        ),
        ("x: ZeroJunction (w[0]);", "0 x; w[0] -> x;"),
    ] {
        assert_eq!(typed(&masses(called)).pop().unwrap(), written);
    }
    for written in [
        "Se x { effort: 1.0 } -> v;",
        "v -> R x { resistance: 1.0 };",
        "0 x; w[0] -> x; x -> C y { stiffness: 1.0 };",
    ] {
        assert_eq!(told(&masses(written)), "");
    }
    assert_eq!(
        typed(&masses("v -> OneJunction x { } -> w[0];")),
        ["1 name;"]
    );
    assert_eq!(typed(&masses("OneJunction x;")), ["1 x"]);
}

/// Blocks as statements, with what makes them compile, and components of the library without their junctions.
#[test]
fn blocks_that_stand_alone_are_told_as_values() {
    for (block, written) in [
        ("Integrator i;", "integral i = u, initial: 0.0;"),
        ("Gain i { k: 2.0 };", "let i = 2.0 * u;"),
        ("Sum i(k = 2.0);", "let i = u - u;"),
        ("i: LowPass;", "integral i = (u - i) / 0.1;"),
    ] {
        let first = typed(&masses(block)).remove(0).replace("u - v", "u - u");
        assert_eq!(first, written);
        let whole = format!("input u; {written} output y = i;");
        assert_eq!(told(&masses(&whole)), "");
    }
    let sensor = told(&masses("Sensor w;"));
    assert!(sensor.contains("read without a sensor"), "{sensor}");
    assert_eq!(
        typed(&masses("Friction f { sliding: 1.0 };")),
        ["f: Friction { sliding: 1.0 } (…);"]
    );
    assert_eq!(told(&masses("f: Friction { sliding: 1.0 } (v);")), "");
}

/// What is read in the place of a velocity, a torque and their like.
#[test]
fn quantities_are_told_as_variables_of_bonds() {
    for (read, written) in [
        ("v.velocity", "v.f"),
        ("v.omega", "v.f"),
        ("v.v", "v.f"),
        ("m.momentum", "m.p"),
        ("m.torque", "m.e"),
        ("k.voltage", "k.e"),
        ("k.v", "k.e"),
        ("c.charge", "c.q"),
        ("c.position", "c.q"),
        ("c.power", "c.e * c.f"),
        ("v.force", "m.e"),
        ("v.e", "m.e"),
        ("k.current", "c.f"),
    ] {
        let first = typed(&masses(&format!("output y = {read};"))).remove(0);
        assert_eq!(first, written, "{read}");
        assert_eq!(told(&masses(&format!("output y = {written};"))), "");
    }
    let way = typed(&masses("output y = v.angle;"));
    assert_eq!(way, ["integral q_v = v.f, initial: 0.0;", "q_v"]);
    assert_eq!(
        told(&masses(&format!("{} output y = {};", way[0], way[1]))),
        ""
    );
    assert_eq!(typed(&masses("output y = velocity;")), ["v.f", "w.f"]);
    let energy = typed(&masses("output y = c.energy;")).remove(0);
    assert_eq!(energy, "0.5 * c.q * c.e");
}

/// A frame without a velocity is read by halves, a joint and a contact by what they tell.
#[test]
fn quantities_of_frames_and_components_are_told() {
    let scene = |read: &str| {
        format!(
            "#[derivative] model M {{ causality componentwise; gravity [0.0, 0.0, -9.81]; 1 ground[6]; 1 hull[6];
             Sf still[6] {{ flow: 0.0 }} -> ground; free: Free (ground, hull);
             body: Body {{ mass: 1.0, inertia: 1.0 }} (hull); pad: Contact {{ stiffness: 1e4, friction: 0.5 }} (hull);
             1 arm[6]; hinge: Revolute {{ axis: 1 }} (hull, arm); rod: Body {{ mass: 1.0, inertia: 1.0 }} (arm); {read} }}"
        )
    };
    for (read, written, size) in [
        ("hull.velocity", "hull.f[3..6]", "[3]"),
        ("hull.omega", "hull.f[0..3]", "[3]"),
        ("hull.position", "free.position_b", "[3]"),
        ("hinge.velocity", "hinge.rate.f", ""),
        ("hinge.phi", "hinge.angle", ""),
        ("pad.normal_force", "pad.force", ""),
        ("pad.penetration", "pad.depth", ""),
        ("pad.friction_force", "pad.rubbing.e", "[3]"),
        ("pad.rubbing.contact.e", "pad.rubbing.e", "[3]"),
    ] {
        let output = |read: &str| scene(&format!("output y{size} = {read};"));
        assert_eq!(typed(&output(read)), [written], "{read}");
        assert_eq!(told(&output(written)), "");
    }
}

#[test]
fn the_nearest_name_inside_a_loop_is_told() {
    let scene = |use_: &str| {
        format!(
            "model M {{ 1 v; cells: for k in 0..2 {{ 1 node {{ I m {{ inertia: 1.0 }} }} }} v -> C c {{ stiffness: 1.0 }}; {use_} }}"
        )
    };
    for (slip, meant) in [
        ("output y = cells[0].nod.f;", "cells[0].node"),
        ("output y = cels[0].node.f;", "cells"),
        ("Se s { effort: 1.0 } -> cells[0].nod;", "cells[0].node"),
        ("Se s { effort: 1.0 } -> cell[0].node;", "cells"),
    ] {
        assert_eq!(typed_first(&scene(slip)), meant, "{slip}");
    }
}

/// What is written in one statement or without a name elsewhere, and values in the place of junctions.
#[test]
fn statements_are_told_apart() {
    for (slip, written) in [
        (
            "output v.f, m.p;",
            vec!["output name = v.f; output name_1 = m.p;"],
        ),
        ("1 a, b;", vec!["1 a; 1 b;"]),
        (
            "input u; u -> v;",
            vec!["Se u_source { effort: u }", "Sf u_source { flow: u }"],
        ),
        (
            "f: Friction { sliding: 1.0 };",
            vec!["f: Friction { sliding: 1.0 } (a, b);"],
        ),
    ] {
        assert_eq!(typed(&masses(slip)), written);
    }
    for written in [
        "output name = v.f; output name_1 = m.p;",
        "1 a; 1 b; a -> R r { resistance: 1.0 }; b -> R s { resistance: 1.0 }; v -> a; v -> b;",
        "input u; Se u_source { effort: u } -> v;",
    ] {
        assert_eq!(told(&masses(written)), "");
    }
    let inside = "component K(port a) { a -> R r { resistance: 1.0 }; }";
    let read = |path: &str| {
        format!(
            "{inside} {}",
            masses(&format!("k0: K (v); output y = {path};"))
        )
    };
    assert_eq!(typed(&read("r.e")), ["k0.r.e"]);
    assert_eq!(told(&read("k0.r.e")), "");
}

/// A spring knows no length without load, and a stop asks for the coordinate of its joint.
#[test]
fn lengths_without_load_and_coordinates_are_told() {
    let spring = |law: &str| masses(&format!("v -> C s {{ {law} }};"));
    for (slip, written) in [
        ("stiffness: 10.0, rest: 0.2", "effort: 10.0 * (q - 0.2)"),
        ("stiffness: 10.0, preload: 3.0", "effort: 3.0 + 10.0 * q"),
    ] {
        assert_eq!(typed(&spring(slip))[0], written);
        assert_eq!(told(&spring(written)), "");
    }
    let scene = |displacement: &str| {
        format!(
            "#[derivative] model M {{ causality componentwise; 1 g[3]; 1 a[3]; Sf f[3] {{ flow: 0.0 }} -> g; j: PlanarRevolute (g, a);
             b: PlanarBody {{ mass: 1.0, inertia: 1.0 }} (a);
             s: Stop {{ {displacement}lower: -1.0, upper: 1.0, stiffness: 1e3 }} (j.rate); }}"
        )
    };
    let written = typed(&scene("")).remove(0);
    assert_eq!(written, "{ displacement: j.angle }");
    let value = written.trim_matches(['{', '}', ' ']);
    assert_eq!(told(&scene(&format!("{value}, "))), "");
    for (vector, written) in [
        ("vec![1.0, 2.0]", "[1.0, 2.0]"),
        ("vec2(1.0, 2.0)", "[1.0, 2.0]"),
    ] {
        let read = |vector: &str| masses(&format!("output y[2] = {vector};"));
        assert_eq!(typed(&read(vector)), [written]);
        assert_eq!(told(&read(written)), "");
    }
}

/// Moments about axes, and what a body begins with.
#[test]
fn bodies_are_given_a_tensor_and_begin_with_their_frames() {
    let body = |frame: &str, words: &str| {
        format!(
            "#[derivative] model M {{ causality componentwise; {frame} b: Body {{ mass: 1.0, {words} }} (hull); output y[6] = hull.f; }}"
        )
    };
    let frame = "1 hull[6];";
    let told_first = |words: &str| {
        let diagnostics = diagnose(&body(frame, words));
        diagnostics.list()[0].helps[0].clone()
    };
    assert_eq!(
        told_first("ixx: 1.0, iyy: 2.0, izz: 3.0"),
        "write `inertia: diag(1.0, 2.0, 3.0)`"
    );
    let missing = told(&body(frame, "ixx: 1.0, iyy: 2.0, izz: 3.0"));
    assert!(
        !missing.contains("needs a value for `inertia`"),
        "{missing}"
    );
    let moments = "inertia: diag(1.0, 2.0, 3.0)";
    assert_eq!(told(&body(frame, moments)), "");
    let start = typed(&body(frame, &format!("{moments}, initial_velocity: 1.0")));
    assert_eq!(start, ["1 hull[6] coordinate, initial_flow: …;"]);
    let begun = start[0].replace('…', "[0.0, 0.0, 0.0, 1.0, 0.0, 0.0]");
    assert_eq!(told(&body(&begun, moments)), "");
}

/// What a branch of a circuit tells, and literals that are no numbers.
#[test]
fn branches_and_literals_are_told() {
    let circuit = |read: &str| {
        format!(
            "model M {{ 0 a {{ Se s {{ effort: 1.0 }} }} 0 b {{ Se z {{ effort: 0.0 }} }} 0 m; r: Resistor {{ resistance: 1.0 }} (a, m);
             c: Capacitor {{ capacitance: 1.0 }} (m, b); output y = {read}; }}"
        )
    };
    for (read, written) in [
        ("r.i", "r.current"),
        ("r.v", "r.voltage"),
        ("c.charge", "c.capacitor.q"),
    ] {
        assert_eq!(typed(&circuit(read)), [written]);
        assert_eq!(told(&circuit(written)), "");
    }
    let literal = told(&masses("let on = true; output y = on;"));
    assert!(
        literal.contains("write `1.0`, and ask `> 0.5`"),
        "{literal}"
    );
    let word = told(&masses("let kind = \"linear\"; output y = kind;"));
    assert!(
        word.contains("`param kind: linear | cubic = linear;`"),
        "{word}"
    );
}
