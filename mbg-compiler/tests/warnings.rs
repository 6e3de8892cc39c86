//! Warnings of what is written and changes nothing.

mod told;

use told::{diagnose, told, warned};

/// Of a model with a wheel, after a component.
fn around_a_wheel(component: &str, body: &str) -> String {
    warned(&format!(
        "{component}\nmodel M {{ 1 wheel {{ I rotor {{ inertia: 1.0 }} }}\n{body} }}"
    ))
}

#[test]
fn names_that_nothing_reads_are_told() {
    let body = "input gust: N; param k: N/m = 1.0; let idle = 3.0; integral turns = wheel.f;";
    insta::assert_snapshot!(around_a_wheel("", body), @"
    3:7 `M` does not read its input `gust` [MBG0223]
      help: remove it, or call it `_gust`
    3:22 `M` does not read its parameter `k` [MBG0223]
      help: remove it, or call it `_k`
    3:40 `M` does not read its value `idle` [MBG0223]
      help: remove it, or call it `_idle`
    3:61 `M` does not read its integral `turns` [MBG0223]
      so it is no state; an `output` that reads it makes it one
      help: remove it, or call it `_turns`
    ");
    let marked = ["gust", "k:", "idle", "turns"]
        .iter()
        .fold(body.to_owned(), |body, name| {
            body.replace(name, &format!("_{name}"))
        });
    assert_eq!(around_a_wheel("", &marked), "");
    let read =
        "input gust; param k = 1.0; let factor = 3.0; let size = 2; integral turns = wheel.f;
                1 other[3] { Se push { effort: factor * gust } } other[0] -> I n { inertia: 1.0 };
                for i in 0..size { Sf spin { flow: k * turns } -> other[i + 1]; }";
    assert_eq!(around_a_wheel("", read), "");
}

/// `r#c` is the name `c`; a keyword is told without its mark and typed with it.
#[test]
fn raw_names_are_the_names() {
    let text = "component K(port a, port r#fn) { a -> R r { resistance: 1.0 }; }
        model M { param r#type = 1.0; param c = 1.0; 1 a { I m { inertia: 2.0 * (r#c) } } }";
    insta::assert_snapshot!(warned(text), @"
    1:26 `K` bonds nothing to its port `fn` [MBG0223]
      help: remove it, or call it `_fn`
    2:25 `M` does not read its parameter `type` [MBG0223]
      help: remove it, or call it `_type`
    ");
    let text =
        "model M { param c = 1.0; param r#c = 2.0; param x = r#in; 1 a { I m { inertia: x } } }";
    insta::assert_snapshot!(told(text), @"
    1:32 `c` is declared twice [MBG0202]
    1:53 `in` is not declared [MBG0203]
    ");
}

/// Values of a component are there for those who call it; its parameters are not.
#[test]
fn parameters_that_a_component_does_not_read_are_told() {
    let brake = |body: &str| {
        let parameters = "param grip = 2.0; param speed = 1.0; param kind: dry | wet = dry;";
        let component = format!("component Brake(port at) {{ {parameters} {body} }}");
        around_a_wheel(&component, "brake: Brake (wheel);")
    };
    insta::assert_snapshot!(brake("at -> R pad { resistance: grip }; let force = pad.e;"), @"
    1:52 `Brake` does not read its parameter `speed` [MBG0223]
      help: remove it, or call it `_speed`
    1:71 `Brake` does not read its parameter `kind` [MBG0223]
      help: remove it, or call it `_kind`
    ");
    let both = "if kind == dry { at -> R pad { resistance: grip }; } else { at -> R oil { resistance: speed }; }";
    assert_eq!(brake(both), "");
}

/// In a loop they are told once.
#[test]
fn arguments_without_effect_are_told_with_what_would_give_them_one() {
    let hinge = |arguments: &str| {
        let arms = format!(
            "1 arm[6]; weight: Body {{ mass: 1.0, inertia: 1.0 }} (arm);
             hinge: Revolute {{ axis: 0, {arguments} }} (ground, arm);"
        );
        warned(&format!(
            "#[derivative] model M {{ causality componentwise; 1 ground[6]; Sf still[6] {{ flow: 0.0 }} -> ground;
             for k in 0..2 {{ {arms} }} }}"
        ))
    };
    insta::assert_snapshot!(hinge("rest: 0.5, friction_speed: 0.1, blocked_damping: 3.0"), @"
    3:41 `rest` has no effect on `hinge` [MBG0224]
      help: it counts where `given(stiffness)`
    3:52 `friction_speed` has no effect on `hinge` [MBG0224]
      help: it counts where `given(friction)`
    3:73 `blocked_damping` has no effect on `hinge` [MBG0224]
      help: it counts where `blocked == compliant`
    ");
    let friction = "friction: 0.2, friction_speed: 0.1";
    assert_eq!(hinge(&format!("stiffness: 2.0, rest: 0.5, {friction}")), "");
    assert_eq!(hinge("blocked: compliant, blocked_damping: 3.0"), "");
}

/// What a component hands on may be given in another use of it.
#[test]
fn what_is_handed_on_is_not_told() {
    let finger = "component Finger(port 1 at, port 1 tip) {
        param grip = 1.0; param blocked: ideal | compliant = ideal;
        rack: Rack { radius: 0.1, blocked: blocked, blocked_damping: grip } (at, tip); }";
    let called = |arguments: &str| {
        let jaw = "1 slide { #[derivative] I jaw { inertia: 1.0 } }";
        around_a_wheel(
            finger,
            &format!("{jaw}\nfinger: Finger {arguments} (wheel, slide);"),
        )
    };
    assert_eq!(called(""), "");
    assert_eq!(called("{ blocked: compliant, grip: 2.0 }"), "");
    insta::assert_snapshot!(called("{ grip: 2.0 }"), @"
    6:18 `grip` has no effect on `finger` [MBG0224]
      help: it counts where `blocked == compliant`
    ");
}

#[test]
fn values_at_the_start_that_are_not_used_are_told() {
    let gear = "1 slow { #[derivative] I drum { inertia: 2.0, initial: 1.0 } } wheel -> TF gear { flow: 4.0 } -> slow;";
    insta::assert_snapshot!(around_a_wheel("", gear), @"
    3:26 `drum.p` is not 1.0 at the start but 0.0: it follows from other states [MBG0405]
      help: give it to `rotor`, from which it follows: `initial: 0.125`
    ");
    // What the state has there anyway may be given.
    let moving = |rate: &str| {
        let gear = gear.replace("initial: 1.0", rate);
        warned(&format!(
            "model M {{ 1 wheel {{ I rotor {{ inertia: 1.0, initial_flow: 0.5 }} }} {gear} }}"
        ))
    };
    assert_eq!(moving("initial_flow: 2.0"), "");
    insta::assert_snapshot!(moving("initial_flow: 1.0"), @"1:92 `drum.p` is not 2.0 at the start but 4.0: it follows from other states [MBG0405]");
    // A momentum that is given decides, and one that is not gives the flow.
    let rate = |start: &str, law: &str| {
        let flow = "1 rate coordinate, initial_flow: 3.0";
        warned(&format!(
            "model M {{ {flow} {{ I wheel {{ {law}{start} }} }} }}"
        ))
    };
    let linear = "inertia: 2.0";
    assert_eq!(rate("", linear), "");
    insta::assert_snapshot!(rate(", initial: 1.0", linear), @"1:13 `rate.f` is not 3.0 at the start but 0.5: it follows from other states [MBG0405]");
    // Not where the law is none that can be inverted.
    insta::assert_snapshot!(rate("", "flow: pow(wheel.p, 3)"), @"1:13 `rate.f` is not 3.0 at the start but 0.0: it follows from other states [MBG0405]");
    // Of the flows of two joints that a gear couples one is a state.
    let geared = "1 a coordinate { I first { inertia: 1.0 } }
        1 b coordinate, initial_flow: 3.0 { I second { inertia: 2.0 } }
        a -> TF gear { flow: -2.0 } -> b;";
    insta::assert_snapshot!(warned(&format!("#[derivative] model M {{ {geared} }}")), @"
    2:11 `b.f` is not 3.0 at the start but 0.0: it follows from other states [MBG0405]
      help: let `a.f`, from which it follows, begin with -1.5
    ");
}

#[test]
fn a_ring_that_is_open_at_the_start_is_told() {
    let slider_crank = |rod: &str, slide: &str| {
        let link = "mass: 1.0, inertia: 0.1, centre: 0.0";
        warned(&format!(
            "#[derivative] model M {{
                causality componentwise;
                1 ground[3]; 1 pin[3]; 1 end[3]; 1 block[3];
                Sf fixed[3] {{ flow: 0.0 }} -> ground;
                crank: PlanarLink {{ {link}, end: [1.0, 0.0], initial: 1.0 }} (ground, pin);
                rod: PlanarLink {{ {link}, end: [2.0, 0.0]{rod} }} (pin, end);
                slide: PlanarPrismatic {{ {slide} }} (ground, block);
                wrist: PlanarRevolute {{}} (block, end);
            }}"
        ))
    };
    insta::assert_snapshot!(slider_crank("", "initial: 2.0"), @"
    8:17 `rod` and `wrist` do not meet at `end` at the start: [0.379, -2.524] m are between them, which stay [MBG0406]
      help: give the joints of the ring `initial` values that close it, or put a `PlanarCut` in the place of one of them, which is closed at the start and after each step
    ");
    // To the digits that are typed: the rod goes down by asin(sin(1) / 2) to the line of the slide.
    assert_eq!(slider_crank(", initial: -1.4343", "initial: 2.3547"), "");
}

/// In space, and of a machine of micrometres, whose gap has as many digits.
#[test]
fn a_small_ring_in_space_that_is_open_is_told() {
    let body = "Body { mass: 1e-9, inertia: 1e-18 }";
    insta::assert_snapshot!(warned(&format!(
        "#[derivative] model M {{
            causality componentwise;
            1 ground[6]; 1 crank[6]; 1 pin[6]; 1 rod[6]; 1 end[6]; 1 block[6];
            Sf fixed[6] {{ flow: 0.0 }} -> ground;
            hinge: Revolute {{ axis: 2, initial: 1.0 }} (ground, crank); a: {body} (crank);
            throw: Mount {{ offset: [1e-5, 0.0, 0.0] }} (crank, pin);
            big: Spherical {{}} (pin, rod); b: {body} (rod);
            bar: Mount {{ offset: [2e-5, 0.0, 0.0] }} (rod, end);
            slide: Prismatic {{ axis: 0, initial: 2e-5 }} (ground, block); c: {body} (block);
            small: Spherical {{}} (block, end);
        }}"
    )), @"
    8:13 `small` and `bar` do not meet at `end` at the start: [-0.00000379, 0.00002524, 0.00000000] m are between them, which stay [MBG0406]
      help: give the joints of the ring `initial` values that close it, or put a `Cut` in the place of one of them, which is closed at the start and after each step
    ");
}

/// Velocities are turned by what joints say of axes: where these differ, the motion is another one.
#[test]
fn a_ring_whose_axes_differ_at_the_start_is_told() {
    let ring = |ball: &str| {
        let body = "Body { mass: 1.0, inertia: 0.1 }";
        warned(&format!(
            "#[derivative] model M {{
                causality componentwise;
                1 ground[6]; 1 arm[6]; 1 end[6]; 1 plate[6];
                Sf fixed[6] {{ flow: 0.0 }} -> ground;
                free: Free {{ initial_position: [0.0, -0.29552, 0.955336] }} (ground, plate); a: {body} (plate);
                foot: Universal {{ first: 0, second: 1, initial: [0.3, 0.0] }} (ground, arm); b: {body} (arm);
                rod: Offset {{ by: [0.0, 0.0, 1.0] }} (arm, end);
                ball: Spherical {{ {ball} }} (end, plate);
            }}"
        ))
    };
    insta::assert_snapshot!(ring(""), @"
    8:17 `free` and `ball` do not meet at `plate` at the start: by one its axes are turned by 0.300 rad against those by the other, which stays [MBG0406]
      help: give the joints of the ring `initial` values that close it, or put a `Cut` in the place of one of them, which is closed at the start and after each step
    ");
    assert_eq!(ring("initial: [-0.3, 0.0, 0.0]"), "");
}

#[test]
fn a_ring_that_no_strokes_fit_is_told_how_to_be_closed() {
    let ring = |last: &str, causality: &str| {
        let link = "mass: 1.0, inertia: 0.1, centre: 0.0";
        format!(
            "#[derivative] model M {{
                {causality}
                1 ground[3]; 1 pin[3]; 1 end[3]; 1 far[3]; 1 side[3];
                Sf fixed[3] {{ flow: 0.0 }} -> ground;
                crank: PlanarLink {{ {link}, end: [1.0, 0.0], initial: 1.0 }} (ground, pin);
                rod: PlanarLink {{ {link}, end: [2.0, 0.0] }} (pin, end);
                base: PlanarOffset {{ x: 2.0 }} (ground, side);
                rocker: PlanarLink {{ {link}, end: [1.5, 0.0] }} (side, far);
                {last} (far, end);
            }}"
        )
    };
    let report = diagnose(&ring("last: PlanarRevolute {}", ""));
    assert_eq!(
        report.list()[0].helps[..2],
        [
            "put a `PlanarCut` in the place of a joint of the ring that `rod` and `last` close",
            "or write `causality componentwise;` in the model: one stroke per component instead of one per multibond",
        ]
    );
    for closed in [
        ring("last: PlanarCut {}", ""),
        ring("last: PlanarRevolute {}", "causality componentwise;"),
    ] {
        assert!(diagnose(&closed).list().is_empty());
    }
}

#[test]
fn junctions_that_take_a_branch_out_of_the_model_are_told_with_the_source_that_is_missing() {
    let circuit = |ground: &str| {
        warned(&format!(
            "model M {{ input v: V; 0 a; 0 b; 0 g; Se source {{ effort: v }} -> a; {ground}
             r: Resistor {{ resistance: 1.0 }} (a, b);\nc: Capacitor {{ capacitance: 1e-3 }} (b, g); output i: A = r.current; }}"
        ))
    };
    insta::assert_snapshot!(circuit(""), @"
    1:35 nothing flows through `g`, which has one bond, nor through `c.branch` [MBG0225]
      help: hold `g`: `Se earth { effort: 0.0 } -> g;`
    ");
    assert_eq!(circuit("Se earth { effort: 0.0 } -> g;"), "");
    // Two branches close among the nodes, without the source.
    let ring = |ground: &str| {
        warned(&format!(
            "model M {{ 0 p; 0 q; 0 n; Se s {{ effort: 5.0 }} -> p; {ground} b: Resistor {{ resistance: 1.0 }} (p, q);
             r: Resistor {{ resistance: 1.0 }} (q, n); c: Capacitor {{ capacitance: 1e-6 }} (q, n); }}"
        ))
    };
    insta::assert_snapshot!(ring(""), @"
    1:29 nothing flows through `s`, whatever the state [MBG0224]
      help: if its circuit lacks a ground, hold `n`: `Se earth { effort: 0.0 } -> n;`
    ");
    assert_eq!(ring("Se earth { effort: 0.0 } -> n;"), "");
    let open = around_a_wheel(
        "",
        "0 _open; 1 branch { R r { resistance: 1.0 } } branch -> _open;",
    );
    assert_eq!(open, "");
    // An axis that is locked, of which the torque is asked.
    let locked = "0 lock; 1 axis; 0 shaft { C s { stiffness: 1.0 } } wheel -> shaft; shaft -> axis; axis -> lock;";
    insta::assert_snapshot!(around_a_wheel("", locked), @"
    3:3 nothing flows through `lock`, which has one bond, nor through `axis` [MBG0225]
      help: hold `lock`: `Se earth { effort: 0.0 } -> lock;`
    ");
    assert_eq!(
        around_a_wheel("", &format!("{locked} output torque = lock.e;")),
        ""
    );
    insta::assert_snapshot!(around_a_wheel("", "0 nothing { R stray { resistance: 1.0 } }"), @"
    3:3 nothing flows through `nothing`, which has one bond, nor through `stray` [MBG0225]
      help: hold `nothing`: `Se earth { effort: 0.0 } -> nothing;`
    ");
    // A free axis of a joint, the end of a chain, a body that nothing pushes.
    let free = "1 axis; 0 joint; wheel -> joint; joint -> axis; 1 end; wheel -> TF lever { flow: 2.0 } -> end;";
    assert_eq!(around_a_wheel("", free), "");
}

/// A shaft that nothing brakes takes what is between the others out of the model.
#[test]
fn gears_with_a_loose_shaft_are_told() {
    let geared = |gear: &str| {
        around_a_wheel(
            "",
            &format!("1 shaft {{ #[derivative] I n {{ inertia: 2.0 }} }} 1 c; {gear}"),
        )
    };
    let sum = "0 sum; wheel -> sum; sum -> shaft; sum -> c;";
    for (gear, dead) in [
        (sum, "nor does `sum` act"),
        (
            "gear: Planetary { ratio: 3.0 } (wheel, shaft, c);",
            "nor does `gear.teeth` act",
        ),
        (
            "gear: Differential (wheel, shaft, c);",
            "nor does `gear.side` act",
        ),
        // Behind two-ports, of which a gyrator takes the flow.
        (
            "0 sum; wheel -> sum; sum -> shaft; sum -> TF on { flow: 2.0 } -> c;",
            "nor does `sum` act",
        ),
        (
            "1 coil { R r { resistance: 1.0 } } coil -> GY motor { effort: 0.1 } -> c;",
            "and nothing flows through `coil`",
        ),
    ] {
        let told = format!(
            "3:50 nothing acts on `c`, which has one bond, {dead} [MBG0225]\n  help: hold `c`: `Sf wall {{ flow: 0.0 }} -> c;`"
        );
        assert_eq!(geared(gear), told);
    }
    // Not where it is held, where its motion is asked for or is a coordinate, nor at the end of a chain.
    for held in [
        format!("{sum} Sf brake {{ flow: 0.0 }} -> c;"),
        format!("{sum} output slip = c.f;"),
        "wheel -> TF lever { flow: 2.0 } -> c;".to_owned(),
    ] {
        assert_eq!(geared(&held), "", "{held}");
    }
    let hinge = "1 shaft { I n { inertia: 2.0 } } 1 c coordinate;";
    assert_eq!(around_a_wheel("", &format!("{hinge} {sum}")), "");
}

/// Two gears between the same shafts, whose ratios are not the same.
#[test]
fn shafts_that_gears_lock_are_told() {
    let train = |gears: &str, more: &str| {
        warned(&format!(
            "#[derivative] model M {{
                input drive: N*m; param one = 3.5; param two = 3.5;
                1 a {{ I m {{ inertia: 2.0 }} Se k {{ effort: drive }} }} 1 b {{ I n {{ inertia: 200.0 }} }}
                1 c {{ I moving {{ inertia: 1.0 }} }} 0 soft {{ C spring {{ stiffness: 1.0 }} }} b -> TF slow {{ flow: 0.1 }} -> soft; soft -> c;
                a -> TF first {{ flow: 1.0 / one }} -> b; {gears} {more} }}"
        ))
    };
    let second = "a -> TF second { flow: 1.0 / two } -> b;";
    insta::assert_snapshot!(train(second, ""), @"
    3:25 the flow of `m`, `n` is zero, whatever acts there [MBG0224]
      help: `first`, `second` hold each other where their ratios contradict each other: leave one of them out
    ");
    // Not one gear alone, what is held on purpose, nor two that drive shafts of their own.
    assert_eq!(train("output twice = two;", ""), "");
    assert_eq!(
        train("output twice = two;", "Sf wall { flow: 0.0 } -> b;"),
        ""
    );
    let third = "1 aside { I other { inertia: 1.0 } } a -> TF second { flow: 1.0 / two } -> aside;";
    assert_eq!(train(third, ""), "");
    assert_eq!(train(second, "Sf wall { flow: 0.0 } -> c;"), "");
}

/// An arm on a hinge, and a statement.
fn around_an_arm(statement: &str) -> String {
    warned(&format!(
        "#[derivative] model M {{ causality componentwise; 1 ground[6]; 1 arm[6]; Sf fixed[6] {{ flow: 0.0 }} -> ground;
         body: Body {{ mass: 1.0, inertia: 1.0 }} (arm);\n{statement} }}"
    ))
}

#[test]
fn components_that_change_nothing_are_told() {
    let hinge = "hinge: Revolute { axis: 0 } (ground, arm);";
    let load = |load: &str| around_an_arm(&format!("{hinge}\n{load}"));
    insta::assert_snapshot!(load("push: Load (arm);"), @"
    4:1 `push` changes nothing [MBG0224]
      help: it counts where `given(force)` or `given(moment)`
    ");
    insta::assert_snapshot!(load("push: Load { force: [1.0, 0.0, 0.0] } (ground);"), @"
    4:1 `push` changes nothing: `ground` does not move [MBG0224]
      help: remove it, or give it a frame that moves
    ");
    insta::assert_snapshot!(load("base: Body { mass: 1.0, inertia: 1.0 } (ground);"), @"
    4:1 `base` changes nothing: `ground` does not move [MBG0224]
      help: remove it, or give it a frame that moves
    ");
    for moving in [
        "push: Load { force: [1.0, 0.0, 0.0] } (arm);",
        // What the ground must hold is asked for.
        "push: Load { force: [1.0, 0.0, 0.0] } (ground); output held[6] = fixed.e;",
        // It turns by itself.
        "rotor: Rotor { count: 3, speed: 1.0, offset: 0.1, mass: 1.0, inertia: 1.0, centre: [1.0, 0.0, 0.0] } (ground);",
    ] {
        assert_eq!(load(moving), "", "{moving}");
    }
    // What a component hands on may be given elsewhere.
    let handing = "component Push(port 1 at[6]) { param force[3]: N = 0.0; load: Load { force: force } (at); }";
    let pushed = "1 b[6] { I m { inertia: 1.0 } } push: Push (b);";
    assert_eq!(around_a_wheel(handing, pushed), "");
    // What stands on the ground here may move elsewhere.
    let robot = "component Robot(port 1 base[6]) { base_body: PointMass { mass: 1.0 } (base); }";
    let held = "1 b[6] { Sf fixed { flow: 0.0 } } #[derivative] robot: Robot (b);";
    assert_eq!(around_a_wheel(robot, held), "");
}

#[test]
fn gravity_without_weight_is_told() {
    let hinge = "hinge: Revolute { axis: 0 } (ground, arm);";
    assert_eq!(
        around_an_arm(&format!("gravity [0.0, 0.0, -9.81]; {hinge}")),
        ""
    );
    let massless = "gravity [0.0, -9.81];\n1 rod[3]; pin: PlanarRevolute (held, rod);
                    1 held[3]; Sf wall[3] { flow: 0.0 } -> held; rod -> I mass { inertia: 1.0 };";
    let text = format!("#[derivative] model M {{ causality componentwise; {massless} }}");
    insta::assert_snapshot!(warned(&text), @"
    1:50 `gravity` changes nothing: the model has no weight [MBG0224]
      help: remove it, or give a frame a body: `body: Body { mass: …, inertia: … } (arm);`
    ");
    let read = text.replace("inertia: 1.0 };", "inertia: 1.0 }; output g = gravity.y;");
    assert_eq!(warned(&read), "");
}

#[test]
fn gravity_beside_one_that_is_given_is_told() {
    let mass = "m: PointMass { mass: 1.0 } (bob);";
    let text = format!(
        "gravity [0.0, 0.0, -9.81]; 1 bob[6]; {mass}
         slide: Prismatic {{ axis: 0, gravity_a: [0.0, 0.0, -1.6] }} (ground, bob);"
    );
    let text = format!(
        "#[derivative] model M {{ causality componentwise; 1 ground[6]; Sf fixed[6] {{ flow: 0.0 }} -> ground;\n{text} }}"
    );
    insta::assert_snapshot!(warned(&text), @"
    2:1 `gravity` changes nothing: what has weight is given another [MBG0224]
      help: remove it
    ");
}

/// What a ball joint hands on to the axes of its gimbals.
#[test]
fn arguments_without_effect_inside_what_is_called_are_told() {
    let ball = |arguments: &str| {
        around_an_arm(&format!("ball: Spherical {{ {arguments} }} (ground, arm);"))
    };
    insta::assert_snapshot!(ball("friction_speed: 0.1"), @"
    3:19 `friction_speed` has no effect on `ball` [MBG0224]
      help: it counts where `given(friction)`
    ");
    for arguments in [
        "friction: 0.2, friction_speed: 0.1",
        "damping: 0.1, first: 2, second: 1, third: 0",
    ] {
        assert_eq!(ball(arguments), "", "{arguments}");
    }
    let angles = "orientation: quaternion, friction: 0.2, friction_speed: 0.1";
    assert_eq!(ball(angles), "");
}

#[test]
fn what_a_loop_declares_or_never_does_is_told() {
    let bars = |inside: &str, read: &str| {
        let body = format!(
            "bars: for k in 0..2 {{ 1 bar {{ I rod {{ inertia: 1.0 }} }}\n{inside} }} {read}"
        );
        around_a_wheel("", &body)
    };
    insta::assert_snapshot!(bars("let far = 2 * k; integral way = bar.f;", ""), @"
    4:5 `M` does not read its value `far` [MBG0223]
      help: remove it, or call it `_far`
    4:27 `M` does not read its integral `way` [MBG0223]
      so it is no state; an `output` that reads it makes it one
      help: remove it, or call it `_way`
    ");
    assert_eq!(bars("let far = 2 * k;", "output y = bars[1].far;"), "");
    assert_eq!(
        bars("let far = 2 * k; R r { resistance: far } -> bar;", ""),
        ""
    );
    assert_eq!(bars("let _far = 2 * k;", ""), "");
    insta::assert_snapshot!(around_a_wheel("", "for k in 3..0 { wheel -> R r { resistance: k }; }"), @"
    3:10 `3..0` is empty: nothing is repeated [MBG0224]
      help: write `0..3`
    ");
    assert_eq!(
        around_a_wheel("", "for k in 0..0 { wheel -> R r { resistance: k }; }"),
        ""
    );
}

#[test]
fn ports_that_a_component_does_not_bond_are_told() {
    let brake = |second: &str, body: &str| {
        let component = format!("component Brake(port at, port {second}) {{ {body} }}");
        around_a_wheel(
            &component,
            "1 other { I disc { inertia: 1.0 } } brake: Brake (wheel, other);",
        )
    };
    insta::assert_snapshot!(brake("to", "at -> R pad { resistance: 1.0 };"), @"
    1:31 `Brake` bonds nothing to its port `to` [MBG0223]
      help: remove it, or call it `_to`
    ");
    assert_eq!(brake("_to", "at -> R pad { resistance: 1.0 };"), "");
    assert_eq!(brake("to", "at -> R pad { effort: to.f * f };"), "");
    assert_eq!(
        brake(
            "to",
            "0 slip { R pad { resistance: 1.0 } } at -> slip; slip -> to;"
        ),
        ""
    );
}

#[test]
fn a_start_of_what_follows_is_told_where_it_follows_from() {
    let gear = |first: &str, second: &str| {
        format!(
            "#[derivative] model M {{ 1 a {{ I j {{ inertia: 0.1{first} }} R r {{ resistance: 0.1 }} }}\n1 b {{ I k {{ inertia: 4.0{second} }} }} a -> TF g {{ flow: 0.2 }} -> b; output w = a.f; }}"
        )
    };
    let second = ", initial_flow: 2.0";
    insta::assert_snapshot!(warned(&gear("", second)), @"
    2:9 `k.p` is not 8.0 at the start but 0.0: it follows from other states [MBG0405]
      help: give it to `j`, from which it follows: `initial: 1.0`
    ");
    assert_eq!(warned(&gear(", initial: 1.0", second)), "");
}

/// A loop that is far from closed is one of wrong frames or starts; one that is nearly is put together before the first step.
#[test]
fn a_loop_that_is_open_at_the_start_is_told() {
    let four_bar = |last: &str, initial: f64| {
        let link = "mass: 1.0, inertia: 0.1, centre: 0.0";
        warned(&format!(
            "#[derivative] model M {{
                causality componentwise;
                1 ground[3]; 1 pin[3]; 1 end[3]; 1 far[3]; 1 side[3];
                Sf fixed[3] {{ flow: 0.0 }} -> ground;
                crank: PlanarLink {{ {link}, end: [1.0, 0.0], initial: 1.5707963 }} (ground, pin);
                rod: PlanarLink {{ {link}, end: [2.0, 0.0], initial: -1.5707963 }} (pin, end);
                base: PlanarOffset {{ x: 2.0 }} (ground, side);
                rocker: PlanarLink {{ {link}, end: [1.0, 0.0], initial: {initial:?} }} (side, far);
                {last}: PlanarCut (far, end);
            }}"
        ))
    };
    insta::assert_snapshot!(four_bar("cut", 1.2), @"
    9:17 `cut` is open at the start, by 0.362 [MBG0406]
      help: give its joints `initial` values that close it: else they are moved by least norm before the first step
    ");
    assert_eq!(four_bar("_cut", 1.2), "");
    assert_eq!(four_bar("cut", 1.55), "");
    // Beside what is small a small gap is large, and is told in its own digits.
    let slide = "#[derivative] model M {
        causality componentwise;
        1 ground[3]; 1 pin[3];
        Sf fixed[3] { flow: 0.0 } -> ground;
        crank: PlanarLink { mass: 1.0, inertia: 0.1, centre: 0.0, end: [1e-3, 0.0], initial: 0.5 } (ground, pin);
        cut: PlanarCut { joint: slot } (ground, pin);
    }";
    insta::assert_snapshot!(warned(slide), @"
    6:9 `cut` is open at the start, by 4.79e-4 [MBG0406]
      help: give its joints `initial` values that close it: else they are moved by least norm before the first step
    ");
}

/// Aircraft and ships have z down, and the ground of a contact is below where z points up.
#[test]
fn grounds_above_what_falls_are_told() {
    let scene = |gravity: &str, argument: &str| {
        warned(&format!(
            "model M {{ gravity [0.0, 0.0, {gravity}]; 1 ground[6]; 1 hull[6]; Sf still[6] {{ flow: 0.0 }} -> ground;
             free: Free (ground, hull); body: Body {{ mass: 1.0, inertia: 1.0 }} (hull);
             wheels: for k in 0..2 {{ gear: Contact {{ stiffness: 1e4{argument} }} (hull); }} }}"
        ))
    };
    insta::assert_snapshot!(scene("9.81", ""), @"
    3:38 `gravity` points away from the ground of `gear`, which is above it [MBG0411]
      help: where the last axis points down write `normal: [0.0, 0.0, -1.0]`
    ");
    assert_eq!(scene("9.81", ", normal: [0.0, 0.0, -1.0]"), "");
    assert_eq!(scene("-9.81", ""), "");
    let planar = "model M { gravity [0.0, 9.81]; 1 hull[3]; integral way[2]: m = hull.f[1..3];
                  body: PlanarBody { mass: 1.0, inertia: 1.0 } (hull);
                  gear: PlanarContact { stiffness: 1e4, position_at: way } (hull); }";
    insta::assert_snapshot!(warned(planar), @"
    3:19 `gravity` points away from the ground of `gear`, which is above it [MBG0411]
      help: where the last axis points down write `normal: [0.0, -1.0]`
    ");
}

/// A contact acts on what moves; what stands still may stand at a way from what is held.
#[test]
fn contacts_on_what_stands_are_told() {
    let scene = |part: &str| {
        warned(&format!(
            "#[derivative] model M {{ causality componentwise; gravity [0.0, -9.81]; 1 ground[3]; 1 tip[3]; 1 arm[3];
             Sf still[3] {{ flow: 0.0 }} -> ground; up: PlanarOffset {{ y: 1.0 }} (ground, tip);
             hinge: PlanarRevolute (tip, arm); body: PlanarBody {{ mass: 1.0, inertia: 1.0 }} (arm);
             {part} }}"
        ))
    };
    insta::assert_snapshot!(scene("c: PlanarContact { stiffness: 1e4, friction: 0.5 } (ground);"), @"
    4:14 `c` changes nothing: `ground` does not move [MBG0224]
      help: remove it, or give it a frame that moves
    ");
    insta::assert_snapshot!(scene("c: PlanarContact { stiffness: 1e4, friction: 0.5, at_rest: holds } (tip);"), @"
    4:14 `c` changes nothing: `tip` does not move [MBG0224]
      help: remove it, or give it a frame that moves
    ");
    assert_eq!(scene("c: PlanarContact { stiffness: 1e4 } (arm);"), "");
    // A loop that is closed at the ground holds its end in part alone.
    let in_slot = scene("slot: PlanarCut { joint: slot } (arm, ground);");
    assert!(!in_slot.contains("MBG0224"), "{in_slot}");
}

/// A rope's `force` is what it takes besides; a name that is given, or that a component works out, is read as it is meant.
#[test]
fn parameters_of_zero_that_are_read_are_told() {
    let rope = |force: &str, read: &str| {
        warned(&format!(
            "component Post(port 1 a[3]) {{ param offset: m = 0.0; a -> R r {{ resistance: 1.0 }}; let place = 2.0 * offset; }}
            model M {{ 1 crab[3]; 1 load[3]; Sf rail[3] {{ flow: 0.0 }} -> crab; post: Post (load);
            level: PlanarFree {{ initial_position: [0.0, -2.0] }} (crab, load); mass: PlanarBody {{ mass: 2.0, inertia: 1.0 }} (load);
            rope: PlanarLineForce {{ kind: rope, stiffness: 1e4, rest: 2.0{force} }} (crab, load);
            output read = {read}; }}"
        ))
    };
    insta::assert_snapshot!(rope("", "rope.force + 2.0 * rope.force"), @"
    5:27 `rope.force` is a parameter that `rope` is not given: it is zero [MBG0224]
      help: what `rope` works out in N: `rope.tension`
    ");
    assert_eq!(rope(", force: 3.0", "rope.force"), "");
    assert_eq!(rope("", "rope.tension"), "");
    // A default that is something is read as what it is, and so is one of a component of the user's.
    assert_eq!(rope("", "level.friction_speed"), "");
    assert_eq!(rope("", "post.offset"), "");
}

#[test]
fn lines_between_frames_that_meet_at_the_start_are_warned_of() {
    let rope = |place: &str| {
        warned(&format!(
            "model M {{ 1 crab[3]; 1 load[3]; Sf rail[3] {{ flow: 0.0 }} -> crab;
            level: PlanarFree {{ initial_position: {place} }} (crab, load);
            mass: PlanarBody {{ mass: 2.0, inertia: 1.0 }} (load);
            rope: PlanarLineForce {{ stiffness: 10.0, rest: 2.0 }} (crab, load); }}"
        ))
    };
    insta::assert_snapshot!(rope("0.0"), @"
    4:13 the ratio of `rope.line` is not finite at the start [MBG0404]
      help: let `level.position.x` start elsewhere, as at 0.5, where it is finite
    ");
    assert_eq!(rope("[0.0, -1.0]"), "");
    let strut = |place: &str| {
        warned(&format!(
            "model M {{ 1 ground[6]; 1 stone[6]; Sf fixed[6] {{ flow: 0.0 }} -> ground;
            free: Free {{ orientation: quaternion, initial_position: {place} }} (ground, stone);
            rock: Body {{ mass: 0.5, inertia: 0.01 }} (stone);
            strut: LineForce {{ stiffness: 200.0, rest: 1.0 }} (ground, stone); }}"
        ))
    };
    insta::assert_snapshot!(strut("0.0"), @"
    4:13 the ratio of `strut.line` is not finite at the start [MBG0404]
      help: let `free.position.x` start elsewhere, as at 0.5, where it is finite
    ");
    assert_eq!(strut("[0.0, 0.0, -1.0]"), "");
}
