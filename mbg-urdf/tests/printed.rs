//! What is printed is a model that `mbg!` takes.
#![allow(clippy::unwrap_used)]

use mbg_compiler::diagnostics::Diagnostics;
use mbg_compiler::items;
use mbg_urdf::Options;

const BENCH: Options<'_> = Options {
    model: Some("Bench"),
    right_angles: 1e-9,
    frames: &[],
    stops: false,
};

/// A file of a pendulum on a slide, with damping and friction, an axis along no coordinate axis and a fixed link.
fn pendulum([robot, slide, hinge, cart, rod]: [&str; 5]) -> String {
    let inertial = "<inertial><origin xyz=\"0.1 0 0\"/><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/></inertial>";
    format!(
        "<robot name=\"{robot}\">
        <link name=\"ground\"/>
        <link name=\"{cart}\">{inertial}</link>
        <link name=\"{rod}\">{inertial}</link>
        <link name=\"tip\">{inertial}</link>
        <joint name=\"{slide}\" type=\"prismatic\">
          <origin xyz=\"1 0 0\" rpy=\"0 0 0.3\"/>
          <parent link=\"ground\"/><child link=\"{cart}\"/><axis xyz=\"1 0 0\"/>
          <dynamics damping=\"0.1\" friction=\"0.2\"/>
        </joint>
        <joint name=\"{hinge}\" type=\"revolute\">
          <origin xyz=\"0 1 0\" rpy=\"0 0.3 0\"/>
          <parent link=\"{cart}\"/><child link=\"{rod}\"/><axis xyz=\"0.6 0.8 0\"/>
          <dynamics damping=\"0.1\" friction=\"0.2\"/>
        </joint>
        <joint name=\"end\" type=\"fixed\"><parent link=\"{rod}\"/><child link=\"tip\"/></joint>
        </robot>"
    )
}

/// What is wrong with what a file is printed as.
fn mistakes(file: &str) -> Vec<String> {
    let printed = mbg_urdf::convert(file, "r.urdf", &BENCH).unwrap();
    let mut diagnostics = Diagnostics::new();
    let _ = items(printed.text.parse().unwrap(), &mut diagnostics);
    let list = diagnostics.list().iter();
    list.map(|it| format!("{}\n{}", it.text(), printed.text))
        .collect()
}

/// Names that mean something to the language, to Rust or to the library.
const NAMES: &[&str] = &[
    "Self",
    "self",
    "R",
    "Se",
    "TF",
    "MGY",
    "T",
    "E",
    "t",
    "u",
    "x",
    "y",
    "k",
    "e",
    "f",
    "tanh",
    "transpose",
    "diag",
    "given",
    "initial",
    "initial_rate",
    "ideal",
    "matrix",
    "coordinate",
    "component",
    "model",
    "port",
    "gyroscopic",
    "by",
    "rates",
    "base",
    "gravity",
    "robot",
    "body",
    "offset",
    "turn",
    "revolute",
    "prismatic",
    "Offset",
    "union",
    "_",
    "causality",
    "slip",
    "slide_slip",
    "stop_stiffness",
    "slide_stop_dissipation",
    "robot_body",
    "if",
    "inertia",
];

#[test]
fn any_name_can_be_one_of_a_robot() {
    for name in NAMES {
        for names in [
            [name, name, "hinge", "cart", "rod"],
            [name, "slide", "hinge", name, "rod"],
        ] {
            assert_eq!(mistakes(&pendulum(names)), [""; 0], "{names:?}");
        }
    }
}

/// As of the robot iCub, whose drawing gave links a mass and what rounding left of no inertia.
#[test]
fn what_rounding_left_of_an_inertia_is_zero() {
    let file = pendulum(["r", "slide", "hinge", "cart", "rod"]);
    let rounded = "ixx=\"-5e-20\" ixy=\"1e-20\" iyy=\"4e-18\" izz=\"0\"";
    let points = file.replace("ixx=\"1\" iyy=\"1\" izz=\"1\"", rounded);
    assert_ne!(points, file);
    assert!(
        mbg_urdf::convert(&points, "r.urdf", &Options::default())
            .unwrap()
            .remarks
            .is_empty()
    );
    assert_eq!(mistakes(&points), <[String; 0]>::default());
    assert!(
        mbg_urdf::convert(&points, "r.urdf", &Options::default())
            .unwrap()
            .text
            .contains("PointMass")
    );
    // Of a mass of micrometres it would be what makes it a body.
    let small = points.replace("<mass value=\"1\"/>", "<mass value=\"1e-9\"/>");
    assert!(
        !mbg_urdf::convert(&small, "r.urdf", &Options::default())
            .unwrap()
            .remarks
            .is_empty()
    );
}

#[test]
fn dry_friction_may_be_on_hinges_and_on_slides() {
    let text = pendulum(["robot", "slide", "hinge", "cart", "rod"]);
    assert_eq!(mistakes(&text), [""; 0]);
    let printed = mbg_urdf::convert(&text, "r.urdf", &Options::default())
        .unwrap()
        .text;
    assert!(printed.contains("0.2 * tanh(f / slide_slip)"), "{printed}");
    assert!(printed.contains("0.2 * tanh(f / slip)"), "{printed}");
}

#[test]
fn a_drive_without_a_mass_moves_what_mimics_it() {
    let finger = |name: &str, inertial: &str, mimic: &str| {
        format!(
            "<link name=\"{name}_link\">{inertial}</link>
            <joint name=\"{name}\" type=\"prismatic\">
              <parent link=\"palm\"/><child link=\"{name}_link\"/><axis xyz=\"1 0 0\"/>{mimic}
            </joint>"
        )
    };
    let inertial =
        "<inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/></inertial>";
    let text = format!(
        "<robot name=\"gripper\"><link name=\"palm\"/>{}{}</robot>",
        finger("drive", "", ""),
        finger(
            "finger",
            inertial,
            "<mimic joint=\"drive\" multiplier=\"-0.5\"/>"
        )
    );
    assert_eq!(mistakes(&text), [""; 0]);
    let found = mbg_urdf::convert(&text, "r.urdf", &Options::default()).unwrap();
    assert_eq!(found.remarks, []);
    let alone = text.replace("<mimic joint=\"drive\" multiplier=\"-0.5\"/>", "");
    let found = mbg_urdf::convert(&alone, "r.urdf", &Options::default()).unwrap();
    let told: Vec<&str> = found.remarks.iter().map(|it| it.text.as_str()).collect();
    assert_eq!(
        told,
        ["nothing that `drive` moves has a mass, which `mbg!` will refuse"]
    );
}

/// Three hinges whose axes lie anywhere, the second of which is the first one's parallel.
#[test]
fn one_turn_leads_from_a_hinge_to_the_next() {
    let joint = |number: usize, angles: &str| {
        format!(
            "<link name=\"l{number}\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/></inertial></link>
            <joint name=\"j{number}\" type=\"continuous\">
              <origin xyz=\"0.1 0.2 0.3\" rpy=\"{angles}\"/>
              <parent link=\"l{}\"/><child link=\"l{number}\"/><axis xyz=\"0.3 -0.4 1.2\"/>
            </joint>",
            number - 1
        )
    };
    let [first, second, third, fourth] = [
        joint(1, "0.3 -0.4 1.1"),
        joint(2, "0 0 0"),
        joint(3, "-1.2 0.7 2.9"),
        joint(4, "1 1 1"),
    ];
    let text =
        format!("<robot name=\"r\"><link name=\"l0\"/>{first}{second}{third}{fourth}</robot>");
    let found = mbg_urdf::convert(&text, "r.urdf", &Options::default()).unwrap();
    let turns: Vec<&str> = (found.text.lines())
        .filter_map(|line| line.split_once("Turn { by: "))
        .map(|(_, by)| &by[..6])
        .collect();
    // Onto the base, which cannot be turned, it is two; parallel axes need none.
    assert_eq!(turns, ["[[0.88", "rot_x(", "rot_x("], "{}", found.text);
}

#[test]
fn frames_move_along_hinges_to_where_fewer_lengths_are_left() {
    let link = "<inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/></inertial>";
    let text = format!(
        "<robot name=\"r\"><link name=\"foot\"/><link name=\"post\">{link}</link><link name=\"arm\">{link}</link>
        <joint name=\"turn\" type=\"continuous\">
          <origin xyz=\"0 0 1\"/><parent link=\"foot\"/><child link=\"post\"/><axis xyz=\"0 0 1\"/>
        </joint>
        <joint name=\"lift\" type=\"continuous\">
          <origin xyz=\"0.5 0 0.25\"/><parent link=\"post\"/><child link=\"arm\"/><axis xyz=\"1 0 0\"/>
        </joint></robot>"
    );
    let printed = mbg_urdf::convert(&text, "r.urdf", &Options::default())
        .unwrap()
        .text;
    for expected in [
        "turn_place: Offset { by: [0.0, 0.0, 1.25],",
        "lift_place: Offset { by: [0.5, 0.0, 0.0] }",
        // The link stays where it was.
        "let post_position[3] = turn.position_b + turn.orientation_b * [0.0, 0.0, -0.25];",
    ] {
        assert!(printed.contains(expected), "{expected}\n{printed}");
    }
}

/// A frame that was asked for is where its link is, though the frame of the body moves along its axis.
#[test]
fn frames_of_links_are_junctions() {
    let names = ["r", "slide", "hinge", "cart", "rod"];
    let frames = ["ground", "cart", "tip"];
    let options = Options {
        frames: &frames,
        ..BENCH
    };
    let file = pendulum(names).replace(
        "<joint name=\"end\" type=\"fixed\">",
        "<joint name=\"end\" type=\"fixed\"><origin xyz=\"0 0 0.5\" rpy=\"0.1 0 0\"/>",
    );
    let printed = mbg_urdf::convert(&file, "r.urdf", &options).unwrap().text;
    let loads: String = frames
        .map(|it| format!("on_{it}: Load {{ force: [1.0, 2.0, 3.0] }} (robot.{it}_frame);"))
        .concat();
    let outputs = "output apart[3] = robot.tip_position - robot.tip_frame_mount.position_b;";
    let model = printed.replace(
        "    output coordinates",
        &format!("    {loads}\n    {outputs}\n    output coordinates"),
    );
    for text in [&printed, &model] {
        let mut diagnostics = Diagnostics::new();
        let _ = items(text.parse().unwrap(), &mut diagnostics);
        let told: Vec<_> = diagnostics.list().iter().map(|it| it.text()).collect();
        // The load on the ground alone does nothing.
        assert!(
            told.iter()
                .all(|it| text == &model && it.contains("on_ground")),
            "{told:?}\n{text}"
        );
    }
    let options = Options {
        frames: &["top"],
        ..BENCH
    };
    let missing = mbg_urdf::convert(&file, "r.urdf", &options).unwrap_err();
    assert_eq!(
        missing.to_string(),
        "1: there is no link `top`, of which a frame was asked for"
    );
}

/// Limits are stops where these are asked for, and nothing of them is there otherwise.
#[test]
fn limits_may_be_stops() {
    let plain = pendulum(["r", "slide", "hinge", "cart", "rod"]);
    let limited = plain.replace(
        "<dynamics",
        "<limit lower=\"-1.5\" upper=\"2\" effort=\"9\" velocity=\"3\"/><dynamics",
    );
    let stops = Options {
        stops: true,
        ..BENCH
    };
    let printed = |text: &str, options| mbg_urdf::convert(text, "r.urdf", options).unwrap();
    assert_eq!(printed(&limited, &BENCH).text, printed(&plain, &BENCH).text);
    assert_eq!(printed(&plain, &stops), printed(&plain, &BENCH));
    let found = printed(&limited, &stops);
    assert_eq!(found.remarks, []);
    for expected in [
        "displacement: slide.travel, lower: -1.5, upper: 2.0,\n        stiffness: slide_stop_stiffness,",
        "displacement: hinge.angle, lower: -1.5, upper: 2.0,\n        stiffness: stop_stiffness,",
        "param stop_stiffness: N*m/rad = ",
        "param slide_stop_dissipation: s/m = ",
    ] {
        assert!(found.text.contains(expected), "{expected}\n{}", found.text);
    }
    let mut diagnostics = Diagnostics::new();
    let _ = items(found.text.parse().unwrap(), &mut diagnostics);
    assert!(!diagnostics.any(), "{:?}", diagnostics.list());
    // What turns on has no end, and what limits efforts alone tells none.
    for other in [
        limited.replace("revolute", "continuous"),
        limited.replace("lower=\"-1.5\" upper=\"2\"", ""),
    ] {
        let found = printed(&other, &stops);
        assert!(!found.text.contains("hinge_stop"));
        assert!(
            found
                .remarks
                .iter()
                .all(|it| it.text == "`limit` is not converted")
        );
        assert!(!found.remarks.is_empty());
    }
    let turned = limited.replace("upper=\"2\"", "upper=\"-2\"");
    let mistake = mbg_urdf::convert(&turned, "r.urdf", &stops).unwrap_err();
    assert!(
        mistake
            .to_string()
            .ends_with("`lower` is above `upper`: -1.5 and -2"),
        "{mistake}"
    );
}
