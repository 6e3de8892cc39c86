//! Motions that are given where none is taken, and what is to be typed instead.
#![allow(clippy::unwrap_used)]

mod told;

use told::{told, typed};

/// A rod on a hinge in space, with statements beside it.
fn hinged(hinge: &str, more: &str) -> String {
    format!(
        "#[derivative] model M {{ causality componentwise; gravity [0.0, 0.0, -9.81]; input u; 1 ground[6]; 1 rod[6];
         Sf fixed[6] {{ flow: 0.0 }} -> ground; body: Body {{ mass: 1.0, inertia: 1.0, centre: [0.0, 0.2, 0.0] }} (rod);
         hinge: Revolute {{ axis: 0{hinge} }} (ground, rod);\n{more} output y = hinge.angle + u; }}"
    )
}

#[test]
fn what_a_component_is_given_in_time_is_told_by_its_parameter() {
    let contact = "c: Contact { stiffness: 1e4, height: -0.5 + 0.1 * sin(3.0 * t) } (rod);";
    insta::assert_snapshot!(told(&hinged("", contact)), @"
    4:1 the displacement of `c.stop.upper_spring` does not change as `c.stop.upper_spring` flows [MBG0309]
      `height` of `c` changes with time, and no flow knows that rate
      `height`: Of the plane along its normal, from the origin of the world. The ground stands still: on what moves it is a `BodyContact`
      help: give `height` a value that stays: what moves is a junction with a flow, such as a frame behind a joint whose rate is given, `Sf drive { flow: … } -> joint.rate;`
    ");
    let stop = "s: Stop { stiffness: 1e4, displacement: hinge.angle, lower: -1.0 + sin(1.0 * t), upper: 2.0 + sin(1.0 * t) } (hinge.rate);";
    insta::assert_snapshot!(told(&hinged("", stop)), @"
    4:1 the displacement of `s.lower_spring` does not change as `s.lower_spring` flows [MBG0309]
      `lower`, `upper` of `s` change with time, and no flow knows that rate
      `lower`: Where it ends; a side without a limit is free
      help: give `lower`, `upper` values that stay: what moves is a junction with a flow, such as a frame behind a joint whose rate is given, `Sf drive { flow: … } -> joint.rate;`
    ");
    let rod = "1 tip[6]; arm: Offset { by: [0.0, 1.0, 0.0] } (rod, tip); 1 peg[6]; foot: Offset { by: [0.0, 0.5, 0.1] } (ground, peg);
               r: Rod { length: 0.5 + 0.1 * sin(1.0 * t) } (tip, peg);";
    insta::assert_snapshot!(told(&hinged("", rod)), @"
    5:16 the displacement of `r.rate -> r.still` does not change as the flows of its ends do [MBG0309]
      `length` of `r` changes with time, and no flow knows that rate
      help: give `length` a value that stays: what moves is a junction with a flow, such as a frame behind a joint whose rate is given, `Sf drive { flow: … } -> joint.rate;`
    ");
    let still = [contact, stop].concat();
    let still = still
        .replace("sin(1.0 * t)", "0.0")
        .replace("sin(3.0 * t)", "0.0");
    assert_eq!(told(&hinged("", &still)), "");
}

#[test]
fn a_motion_in_the_place_of_a_start_is_given_by_its_rate() {
    for given in [
        ", angle: 0.3 * sin(1.0 * t)",
        ", angle: u",
        ", initial: 0.3 * sin(1.0 * t)",
    ] {
        let drive = typed(&hinged(given, "")).pop().unwrap();
        assert_eq!(drive, "Sf drive { flow: … } -> hinge.rate;");
        let driven = drive.replace('…', "0.3 * cos(1.0 * t)");
        assert_eq!(told(&hinged("", &driven)), "");
    }
    assert_eq!(typed(&hinged(", angle: 0.3", "")), ["initial: 0.3"]);
}

#[test]
fn a_rest_that_moves_is_a_torque() {
    let sprung = ", stiffness: 3.0, rest: 0.1 * sin(2.0 * t)";
    insta::assert_snapshot!(told(&hinged(sprung, "")), @"
    3:59 `rest` does not fit in `Revolute`: expected numbers and parameters alone, from which a state starts [MBG0213]
      `rest`: Angle at which the spring is at rest
      help: what moves the rest of a spring pushes by its stiffness: in its place write `torque: 3.0 * (0.1 * sin(2.0 * t))`
    ");
    let torque = typed(&hinged(sprung, "")).pop().unwrap();
    let mended = format!(", stiffness: 3.0, {torque}");
    assert_eq!(told(&hinged(&mended, "")), "");
}
