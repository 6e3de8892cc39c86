//! Mistakes between parts: ports, junctions and bonds, and what is read of them.
#![allow(clippy::unwrap_used)]

mod told;

use told::{told, typed};

#[test]
fn mistakes_at_ports_are_told() {
    let told = |body: &str| {
        told(&format!(
            "component Tie(port left[3], port right) {{ left.x -> right; }}
             component Stop(port at) {{ Sf s {{ flow: 0.0 }} -> at; }}
             model M {{ 1 a[3] {{ I m {{ inertia: 1.0 }} R air {{ resistance: 1.0 }} }} 0 b {{ C c {{ compliance: 1.0 }} }} {body} }}"
        ))
    };
    insta::assert_snapshot!(told("tie: Tie (air, b);"), @"
    3:124 `air` is an element, `R`, and a port takes a junction [MBG0208]
      help: write `a`, its junction
    ");
    insta::assert_snapshot!(told("tie: Tie (a);"), @"
    3:114 `Tie` has the ports `left[3]`, `right`, found 1 junction [MBG0208]
      help: write `tie: Tie (a, …);`
    ");
    insta::assert_snapshot!(told("stop: Stop (b, b);"), @"
    3:114 `Stop` has the port `at`, found 2 junctions [MBG0208]
      help: write `stop: Stop (at);`
    ");
    insta::assert_snapshot!(told("tie: Tie (a.x, b);"), @"3:124 port `left` has dimension 3, and `a.x` has 1 [MBG0204]");
    assert_eq!(told("tie: Tie (a, b);"), "");
}

/// Chains and ports see what is inside of a component behind its use.
#[test]
fn a_bond_into_what_stands_further_down_is_told() {
    let told = |body: &str| {
        told(&format!(
            "component Cart(port 1 at) {{ 1 way; way -> I m {{ inertia: 1.0 }}; at -> way; }}
             component Stop(port at) {{ at -> R s {{ resistance: 1.0 }}; }}
             model M {{ 1 a {{ R air {{ resistance: 1.0 }} }} {body} }}"
        ))
    };
    insta::assert_snapshot!(told("a -> cart.way; cart: Cart (a);"), @"
    3:63 `cart.way` is not declared [MBG0203]
      help: `cart` stands further down: write this behind it, where its junctions are known
    ");
    insta::assert_snapshot!(told("stop: Stop (cart.way); cart: Cart (a);"), @"
    3:70 `cart.way` is not declared [MBG0203]
      help: `cart` stands further down: write this behind it, where its junctions are known
    ");
    insta::assert_snapshot!(told("for k in 0..1 { stop: Stop (cart.way); } cart: Cart (a);"), @"
    3:86 `cart.way` is not declared [MBG0203]
      help: `cart` stands further down: write this behind it, where its junctions are known
    ");
    insta::assert_snapshot!(told("cart: Cart (a); stop: Stop (cart.wey);"), @"
    3:86 `cart.wey` is not declared [MBG0203]
      help: did you mean `cart.way`?
    ");
    assert_eq!(told("cart: Cart (a); stop: Stop (cart.way);"), "");
}

/// A motor's shaft on a 0-junction and a tank's node on a 1-junction would simulate other physics.
#[test]
fn a_port_takes_junctions_of_its_kind() {
    let told = |wheel: &str, motor: &str| {
        told(&format!(
            "model M {{ 0 plus {{ Se battery {{ effort: 12.0 }} }} 0 earth {{ Se zero {{ effort: 0.0 }} }}
             {wheel} motor: DcMotor {{ resistance: 1.0, inductance: 1e-3, constant: 0.1, inertia: 1e-3 }} {motor}; }}"
        ))
    };
    insta::assert_snapshot!(told("0 wheel;", "(plus, earth, wheel)"), @"
    2:120 port `shaft` takes a 1-junction, whose flow is common, and `wheel` is a 0-junction [MBG0222]
      help: declare it as `1 wheel`
      help: if its effort is common indeed, put one between: `1 shaft_motor; wheel -> shaft_motor;`, and give `shaft_motor`
    ");
    insta::assert_snapshot!(told("1 wheel[2]; 1 amps;", "(amps, earth, wheel[1])"), @"
    2:118 port `a` takes a 0-junction, whose effort is common, and `amps` is a 1-junction [MBG0222]
      help: declare it as `0 amps`
      help: if its flow is common indeed, put one between: `0 a_motor; amps -> a_motor;`, and give `a_motor`
    ");
    let brake = "{ R brake { resistance: 0.1 } }";
    let declared = told(&format!("1 wheel {brake}"), "(plus, earth, wheel)");
    let between = told(
        &format!("0 wheel {brake} 1 shaft_motor; wheel -> shaft_motor;"),
        "(plus, earth, shaft_motor)",
    );
    assert_eq!((declared.as_str(), between.as_str()), ("", ""));
}

/// A wall without its source takes the state of the spring; both terminals at one node, and a bond drawn twice.
#[test]
fn slips_in_wiring_are_told_with_what_is_missing() {
    let wall = "model M { 1 wall; 0 pull { C s { stiffness: 1.0 } } 1 a { I m { inertia: 1.0 } } wall -> pull; pull -> a; }";
    let report = told(wall);
    let help = report.lines().find(|line| line.contains("help: ")).unwrap();
    assert_eq!(
        help.trim(),
        "help: hold `wall`: `Sf wall2 { flow: 0.0 } -> wall;`"
    );
    assert_eq!(
        told(&wall.replace("wall;", "wall; Sf wall2 { flow: 0.0 } -> wall;")),
        ""
    );
    insta::assert_snapshot!(told("model M { 0 a { C c { compliance: 1.0 } } r: Resistor { resistance: 1.0 } (a, a); }"), @"
    1:79 `r` leads from `a` to itself [MBG0209]
      help: give it two different junctions
    ");
    insta::assert_snapshot!(told("model M { 1 a { I b { inertia: 1.0 } } 1 c { C e { stiffness: 1.0 } } a -> c; c -> a; }"), @"
    1:81 `c -> a` is bonded twice [MBG0209]
      help: take one of the bonds away
    ");
}

#[test]
fn names_and_junctions_read_wrongly_are_told_with_what_to_write() {
    insta::assert_snapshot!(told("model M { 1 velocty { I b { inertia: 1.0 } } output v = velocity.f; }"), @"
    1:57 `velocity` is not declared [MBG0203]
      help: did you mean `velocty`?
    ");
    let hinge = |value: &str| {
        told(&format!(
            "model M {{ causality componentwise; 1 g[6]; 1 a[6]; Sf s[6] {{ flow: 0.0 }} -> g; hinge: Revolute {{ axis: 0 }} (g, a);
             #[derivative] b: Body {{ mass: 1.0, inertia: 1.0 }} (a);\noutput y{value}; }}"
        ))
    };
    insta::assert_snapshot!(hinge(" = hinge.rate"), @"3:18 `hinge.rate` is a 1-junction; write `hinge.rate.f` [MBG0213]");
    insta::assert_snapshot!(hinge("[3] = hinge.force"), @"3:21 `hinge.force` is a 0-junction; write `hinge.force.e` [MBG0213]");
    assert_eq!(hinge(" = hinge.rate.f") + &hinge("[3] = hinge.force.e"), "");
    // A port that is missing is told alone, not by the junctions that stand in its place.
    insta::assert_snapshot!(told(
        "model M { 0 a { C c { compliance: 1.0 } } 1 shaft { I i { inertia: 1.0 } }
         motor: DcMotor { resistance: 1.0, inductance: 1e-3, constant: 0.1, inertia: 1e-3 } (a, shaft); }"
    ), @"
    2:10 `DcMotor` has the ports `a`, `b`, `shaft`, found 2 junctions [MBG0208]
      help: write `motor: DcMotor { … } (a, …, shaft);` with a junction `0 b`
    ");
}

/// A velocity that reaches a frame directly and by a junction between, whose bonds have no names.
#[test]
fn a_mesh_of_bonds_between_junctions_is_told() {
    insta::assert_snapshot!(told("model M {
        causality componentwise;
        1 car[2] { I body { inertia: 2.0 } } 1 yaw { #[derivative] I turning { inertia: 3.0 } }
        1 front[2] { R tyre { resistance: 2.0 } } 0 arm[2];
        car -> front; car -> arm; yaw -> TF lever { flow: [[0.0], [1.2]] } -> arm; arm -> front;
    }"), @"
    1:7 the junction structure leaves efforts or flows undetermined [MBG0401]
      2 of its equations say the same thing twice, about bonds between junctions
      help: take one bond of the mesh away: what it says follows from the others
    ");
}

#[test]
fn an_element_between_two_junctions_is_told_a_junction_of_its_own() {
    let nodes = |link: &str| {
        format!(
            "model M {{ 0 a {{ C c {{ compliance: 1.0 }} }} 0 b {{ C d {{ compliance: 1.0 }} }}\n{link} }}"
        )
    };
    insta::assert_snapshot!(told(&nodes("a -> R link { resistance: 1.0 } -> b;")), @"
    2:8 `link` has a port with more than one bond [MBG0209]
      help: what stands between two junctions has one flow, at a junction of its own: write `1 link_path { R link { resistance: 1.0 } } a -> link_path -> b;`
    ");
    let path = "1 link_path { R link { resistance: 1.0 } } a -> link_path -> b;";
    assert_eq!(told(&nodes(path)), "");
    let shafts = |link: &str| {
        format!(
            "model M {{ 1 a[2] {{ I i {{ inertia: 1.0 }} }} 1 b[2] {{ I j {{ inertia: 1.0 }} }}\n{link} }}"
        )
    };
    let path = "0 s_path[2] { C s { stiffness: 2.0 } } a -> s_path -> b;";
    assert_eq!(typed(&shafts("a -> C s { stiffness: 2.0 } -> b;")), [path]);
    assert_eq!(told(&shafts(path)), "");
}

#[test]
fn mistakes_of_one_model_leave_the_checks_of_the_next() {
    insta::assert_snapshot!(told("model A { 1 v { I m { inertia: 1.0 } } 0 spare; }
model B { 1 v { I m { inertia: 1.0 } } 0 node; }"), @"
    1:42 junction `spare` has no bond [MBG0208]
      help: write an arrow to it: `spare -> …;`
      help: or remove it
    2:42 junction `node` has no bond [MBG0208]
      help: write an arrow to it: `node -> …;`
      help: or remove it
    ");
}

#[test]
fn an_element_without_a_bond_is_told_with_its_bond() {
    let model = |statement: &str| {
        format!(
            "model M {{ 1 v {{ I m {{ inertia: 1.0 }} }} 0 a {{ R k {{ resistance: 1.0 }} }}
             0 b {{ R l {{ resistance: 1.0 }} }}\n{statement} }}"
        )
    };
    let slips = [
        (
            "C c { stiffness: 1.0 } v -> c;",
            "v -> C c { stiffness: 1.0 };",
        ),
        ("Se s { effort: 1.0 } s -> v;", "Se s { effort: 1.0 } -> v;"),
        (
            "R r { resistance: 1.0 } (v);",
            "v -> R r { resistance: 1.0 };",
        ),
        (
            "TF g { flow: 2.0 } (v, a);",
            "v -> TF g { flow: 2.0 } -> a;",
        ),
        (
            "C c { stiffness: 1.0 } (a, b);",
            "1 branch { C c { stiffness: 1.0 } } a -> branch; branch -> b;",
        ),
    ];
    for (slip, written) in slips {
        let texts = typed(&model(slip));
        assert_eq!(texts.last().unwrap(), written);
        assert_eq!(told(&model(written)), "", "{written}");
    }
    for (slip, written) in [
        (
            "R r { resistance: 1.0 } (a, b);",
            "r: Resistor { resistance: 1.0 } (a, b);",
        ),
        (
            "C r { compliance: 1.0 } (a, b);",
            "r: Capacitor { capacitance: 1.0 } (a, b);",
        ),
        (
            "I r { inertia: 1.0 } (a, b);",
            "r: Inductor { inductance: 1.0 } (a, b);",
        ),
    ] {
        let texts = typed(&model(slip));
        assert_eq!(texts[1], written);
        for text in texts {
            assert_eq!(told(&model(&text)), "", "{text}");
        }
    }
    insta::assert_snapshot!(told(&model("C c { stiffness: 1.0 } v -> c;")), @"
    3:24 expected `->` after `}`, found `v` [MBG0101]
      help: an element stands in a bond or in the braces of a junction: `v -> C c { stiffness: 1.0 };`
    ");
    insta::assert_snapshot!(told(&model("R r { resistance: 1.0 } (a, b);")), @"
    3:25 expected `->` after `}`, found `(` [MBG0101]
      help: an element between two nodes stands at a junction of its own: `1 branch { R r { resistance: 1.0 } } a -> branch; branch -> b;`
      help: components of the library take nodes in parentheses: `r: Resistor { resistance: 1.0 } (a, b);`
    ");
    insta::assert_snapshot!(told(&model("C c { stiffness: 1.0 };")), @"
    3:23 expected `->` after `}`, found `;` [MBG0101]
      help: an element stands in a bond or in the braces of a junction: `… -> C c { stiffness: 1.0 };`
    ");
    insta::assert_snapshot!(told(&model("MTF g { flow: 2.0 }")), @"
    3:19 expected `->` after `}`, found the end of the braces [MBG0101]
      help: an element with two ports stands between two arrows: `… -> MTF g { flow: 2.0 } -> …;`
    ");
}

/// Junctions in another order than the ports are told once, with the order in which all of them fit.
#[test]
fn junctions_in_another_order_are_told_in_order() {
    let text = |junctions: &str| {
        format!(
            "model M {{ input u; 0 supply {{ Se s {{ effort: u }} }} 0 ground {{ Se z {{ effort: 0.0 }} }}
             1 shaft {{ R load {{ resistance: 0.01 }} }}
             motor: DcMotor {{ resistance: 1.0, inductance: 1e-3, constant: 0.1, inertia: 1e-4 }}\n({junctions});
             output speed = shaft.f; }}"
        )
    };
    insta::assert_snapshot!(told(&text("shaft, supply, ground")), @"
    4:2 port `a` takes a 0-junction, whose effort is common, and `shaft` is a 1-junction [MBG0222]
      help: write `motor: DcMotor { … } (supply, ground, shaft);`
    ");
    assert_eq!(told(&text("supply, ground, shaft")), "");
    // What fits nowhere is told by itself, and what is missing with its kind.
    insta::assert_snapshot!(told(&text("supply, shaft, shaft")), @"
    4:10 port `b` takes a 0-junction, whose effort is common, and `shaft` is a 1-junction [MBG0222]
      help: declare it as `0 shaft`
      help: if its flow is common indeed, put one between: `0 b_motor; shaft -> b_motor;`, and give `b_motor`
    ");
    insta::assert_snapshot!(told(&text("shaft, shaft")), @"
    3:14 `DcMotor` has the ports `a`, `b`, `shaft`, found 2 junctions [MBG0208]
      help: write `motor: DcMotor { … } (a, b, shaft);` with junctions `0 a`, `0 b`, `1 shaft`
    ");
}

/// `a.k` for `a[k]`, and indices where nothing has one.
#[test]
fn components_by_number_are_told_in_brackets() {
    let law = |law: &str| {
        format!(
            "component Load(port 1 at) {{ let x = 2.0; at -> R r {{ resistance: x }}; }}
             model M {{ param c[3] = [1.0, 2.0, 3.0]; let k = 1; 1 a[3] {{ I m {{ inertia: 1.0 }} }} load: Load (a.x);
             cells: for i in 0..3 {{ let y = 1.0; a[i] -> R r {{ resistance: c[i] * y }}; }} output o =\n{law}; }}"
        )
    };
    for (slip, written) in [
        ("c.k", "c[k]"),
        ("c.1", "c[1]"),
        ("a.f.k", "a.f[k]"),
        ("a.k.f", "a.f[k]"),
        ("m.k.p", "m.p[k]"),
        ("m[1].p", "m.p[1]"),
        ("load[0].x", "load.x"),
    ] {
        assert_eq!(typed(&law(slip)), [written]);
        assert_eq!(told(&law(written)), "", "{written}");
    }
    insta::assert_snapshot!(told(&law("load[0]")), @"
    4:1 `load` is an instance, which has no value of its own [MBG0213]
      help: of `load` can be read `x`, `r.e`
    ");
    insta::assert_snapshot!(told(&law("cells.k.y")), @"4:1 `cells` is a loop; write `cells[k]` [MBG0203]");
    assert_eq!(told(&law("cells[k].y")), "");
    let loops = |bond: &str| {
        format!("model M {{ 1 a[3] {{ I m {{ inertia: 1.0 }} }} for k in 0..3 {{ {bond} }} }}")
    };
    assert_eq!(typed(&loops("a.k -> R r { resistance: 1.0 };")), ["a[k]"]);
    assert_eq!(told(&loops("a[k] -> R r { resistance: 1.0 };")), "");
}

/// What is read of iterations whose number is not known follows from that.
#[test]
fn a_loop_over_a_parameter_is_told_alone() {
    let text = |number: &str| {
        format!(
            "model M {{ 1 a {{ I m {{ inertia: 1.0 }} }} {number}\ncells: for k in 0..n {{ 1 b {{ I i {{ inertia: 1.0 }} C c {{ stiffness: 1.0 }} }} }}
             a -> cells[0].b; output o = cells[1].c.q; }}"
        )
    };
    insta::assert_snapshot!(told(&text("param n = 3.0;")), @"
    2:20 expected a whole number that is known while the model is compiled, found `n` [MBG0217]
      help: a `param` of a model can change after the model is compiled: declare `let n = 3;` in its place
    ");
}
