//! Warnings of geometry that moves inertia and whose rate no flow knows.

mod told;

use told::{told, warned};

const FLAP: &str =
    "flap: Revolute { axis: 1 } (pitched, root); body: Body { mass: 1.0, inertia: 1.0 } (root);";
const BODY: &str = "body: Body { mass: 1.0, inertia: 1.0 } (root);";

/// A shaft that turns, with something on its hub.
fn on_a_hub(declared: &str, behind: &str) -> String {
    format!(
        "#[derivative] model M {{ causality componentwise; {declared} 1 ground[6]; 1 hub[6];
         Sf fixed[6] {{ flow: 0.0 }} -> ground;
         shaft: Revolute {{ axis: 2 }} (ground, hub); Sf drive {{ flow: 27.0 }} -> shaft.rate;
         {behind} }}"
    )
}

fn pitched(by: &str) -> String {
    format!("1 root[6]; 1 pitched[6]; pitch: Turn {{ by: {by} }} (hub, pitched); {FLAP}")
}

fn reaching(by: &str, behind: &str) -> String {
    format!("1 root[6]; reach: Offset {{ by: [{by}, 0.0, 0.0] }} (hub, root); {behind}")
}

#[test]
fn a_pitch_by_a_state_is_told_with_the_joint_to_write() {
    let by_state = pitched("rot_x(0.1 + 0.05 * sin(shaft.angle))");
    insta::assert_snapshot!(warned(&on_a_hub("", &by_state)), @"
    4:49 `by` of `pitch` changes with `shaft.angle`, and the flow of what is fixed there does not know of it [MBG0410]
      help: write a joint in its place, whose rate is given: `pitch: Revolute { axis: 0, initial: … } (hub, pitched);`, and `Sf drive { flow: … } -> pitch.rate;`
    ");
    let tilt = format!(
        "1 root[6]; flap: Revolute {{ axis: 1, tilt: rot_x(shaft.angle) }} (hub, root); {BODY}"
    );
    insta::assert_snapshot!(warned(&on_a_hub("", &tilt)), @"
    4:47 `tilt` of `flap` changes with `shaft.angle`, and the flow of what is fixed there does not know of it [MBG0410]
      help: write a joint before it, whose rate is given: `1 guided[6]; guide: Revolute { axis: 0, initial: … } (hub, guided);`, with `guided` as the frame of `flap`, and `Sf drive { flow: … } -> guide.rate;`
    ");
    let right = "1 root[6]; 1 pitched[6]; pitch: Revolute { axis: 0, initial: 0.1 } (hub, pitched);
         Sf pitching { flow: 0.05 * cos(shaft.angle) * shaft.rate.f } -> pitch.rate;";
    assert_eq!(warned(&on_a_hub("", &format!("{right} {FLAP}"))), "");
}

/// The advice for an input in a source does not help where it is an angle.
#[test]
fn a_pitch_by_an_input_is_refused_with_the_joint_to_write() {
    let (input, by_input) = ("input collective: rad;", pitched("rot_x(collective)"));
    insta::assert_snapshot!(told(&on_a_hub(input, &by_input)), @"
    4:49 `by` of `pitch` changes with the input `collective`, and the flow of what is fixed there does not know of it [MBG0403]
      an input is known by its value alone
      help: write a joint in its place, whose rate is given: `pitch: Revolute { axis: 0, initial: … } (hub, pitched);`, and `Sf drive { flow: collective_rate } -> pitch.rate;`, where `input collective_acceleration; integral collective_rate = collective_acceleration;`
      help: or in the place of `Sf drive` let an actuator move it, by `torque: … * (collective - pitch.angle), damping: …` of the joint
    ");
    // As the helps say.
    let joint = |declared: &str, motor: &str, drive: &str| {
        let joint =
            format!("pitch: Revolute {{ axis: 0, initial: 0.1{motor} }} (hub, pitched); {drive}");
        warned(&on_a_hub(
            declared,
            &format!("1 root[6]; 1 pitched[6]; {joint} {FLAP}"),
        ))
    };
    let rate = "input collective_acceleration; integral collective_rate = collective_acceleration;";
    assert_eq!(
        joint(rate, "", "Sf lift { flow: collective_rate } -> pitch.rate;"),
        ""
    );
    let motor = ", torque: 1000.0 * (collective - pitch.angle), damping: 10.0";
    assert_eq!(joint(input, motor, ""), "");
    let by_integral = "input rate; integral collective: rad = rate;";
    assert!(warned(&on_a_hub(by_integral, &by_input)).contains("[MBG0410]"));
}

#[test]
fn all_geometry_that_moves_inertia_is_told() {
    let mut cases = vec![
        ("integral out: m = 0.5;", reaching("out", BODY)),
        (
            "input gain: m/s; param pace: 1/s = 2.0; integral out: m = gain - pace * out;",
            reaching("out", BODY),
        ),
        ("", reaching("0.5 * t", BODY)),
    ];
    for behind in [
        "mount: Mount { tilt: rot_x(0.1 * shaft.angle) } (hub, root); BODY",
        "flap: Revolute { axis: 1, offset: [0.3 * shaft.angle, 0.0, 0.0] } (hub, root); BODY",
        "flap: Revolute { axis: 1, zero: 0.3 * shaft.angle } (hub, root); BODY",
        "slide: Prismatic { axis: 0 } (hub, root); BODY 1 tip[6];
         reach: Offset { by: [slide.travel, 0.0, 0.0] } (root, tip); bob: PointMass { mass: 1.0 } (tip);",
        "flap: Revolute { axis: 1 } (hub, root);
         body: Body { mass: 1.0, inertia: 1.0, centre: [0.1 * shaft.angle, 0.0, 0.0] } (root);",
        "flap: Revolute { axis: 1 } (hub, root); BODY
         blade: Blade { azimuth: 27.0 * t, mass: 20.0, inertia: 1.0, centre: 0.0 } (root);",
    ] {
        cases.push(("", format!("1 root[6]; {}", behind.replace("BODY", BODY))));
    }
    // Where a bearing gives way, nothing needs the rate of the input.
    let pod = "1 root[6]; 1 pod[6]; arm: Mount { tilt: rot_x(swivel) } (hub, root);
         joint: Fixed { blocked: compliant } (root, pod); body: Body { mass: 1.0, inertia: 1.0 } (pod);";
    cases.push(("input swivel: rad;", pod.to_owned()));
    for (declared, behind) in cases {
        let found = warned(&on_a_hub(declared, &behind));
        assert_eq!(found.matches("[MBG0410]").count(), 1, "{behind}: {found}");
    }
    let plane = "#[derivative] model M { causality componentwise; 1 ground[3]; 1 slider[3]; Sf fixed[3] { flow: 0.0 } -> ground;
        rail: PlanarPrismatic { direction: 5.0 * t } (ground, slider); bob: PlanarPointMass { mass: 1.0 } (slider); }";
    assert!(warned(plane).contains("`direction` of `rail` changes with time"));
}

/// A force acts on the point of the body that is there, and so does what holds it. Where bodies roll on each other depends on
/// how they are turned.
#[test]
fn points_where_forces_act_and_bodies_roll_are_right() {
    let load = "body: Body { mass: 1.0, inertia: 1.0 } (hub); jet: Load { force: [1.0, 0.0, 0.0] } (root);";
    let nozzle = format!("1 root[6]; nozzle: Turn {{ by: rot_y(swivel) }} (hub, root); {load}");
    let rolling = "model Coin { causality componentwise; 1 ground[6]; 1 contact[6]; 1 coin[6];
        Sf fixed[6] { flow: 0.0 } -> ground; touch: Spherical { orientation: quaternion } (ground, contact);
        let up = transpose(touch.turn) * [0.0, 0.0, 1.0];
        spoke: Offset { by: [up.x, up.y, 0.0] } (contact, coin); body: Body { mass: 2.0, inertia: 1.0 } (coin); }";
    for text in [
        on_a_hub("", &reaching("0.5 * t", load)),
        on_a_hub("input swivel;", &nozzle),
        on_a_hub(
            "integral fixed_by_hand: m = 0.0;",
            &reaching("fixed_by_hand", BODY),
        ),
        rolling.replace("model", "#[derivative] model"),
    ] {
        assert_eq!(warned(&text), "", "{text}");
    }
}
