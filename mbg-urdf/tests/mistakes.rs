//! Files that cannot be converted: each is answered with the line and the reason.
#![allow(clippy::unwrap_used)]

use std::process::Command;

use mbg_urdf::Options;

/// A file of two links with `changed` in place of a part of it.
fn file(part: &str, changed: &str) -> String {
    let text = "<robot name=\"r\">
<link name=\"a\"/>
<link name=\"b\"><inertial>
<mass value=\"1\"/>
<inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/>
</inertial></link>
<joint name=\"j\" type=\"revolute\">
<origin xyz=\"0 0 1\" rpy=\"0 0 0\"/>
<parent link=\"a\"/>
<child link=\"b\"/>
<axis xyz=\"0 0 1\"/>
</joint>
</robot>";
    assert!(text.contains(part), "{part}");
    text.replace(part, changed)
}

/// What is changed, by what, and the answer.
const MISTAKES: &[(&str, &str, &str)] = &[
    (
        "</robot>",
        "",
        "1: this is no XML: the root node was opened but never closed",
    ),
    ("robot", "model", "1: expected a `robot`, found `model`"),
    ("name=\"a\"", "name=\"b\"", "3: there is another link `b`"),
    ("<link name=\"a\"/>", "<link/>", "2: `link` needs `name`"),
    (
        "<mass value=\"1\"/>",
        "",
        "3: expected a `mass` inside `inertial`",
    ),
    (
        "value=\"1\"",
        "value=\"1 kg\"",
        "4: `value` is a number, found `1 kg`",
    ),
    (
        "value=\"1\"",
        "value=\"inf\"",
        "4: `value` is a number, found `inf`",
    ),
    (" iyy=\"1\"", "", "5: `inertia` needs `iyy`"),
    (
        "<inertia ",
        "<inertias ",
        "3: expected an `inertia` inside `inertial`",
    ),
    (
        "type=\"revolute\"",
        "type=\"hinge\"",
        "7: joint `j` is of the type `hinge`, known are `fixed`, `revolute`, `continuous`, `prismatic`, `planar` and `floating`",
    ),
    ("type=\"revolute\"", "", "7: `joint` needs `type`"),
    (
        "\"0 0 1\" rpy",
        "\"0 1\" rpy",
        "8: `xyz` is three numbers, found `0 1`",
    ),
    (
        "rpy=\"0 0 0\"",
        "rpy=\"0 0 ${turn}\"",
        "8: this is for xacro, which prints the URDF file to convert: `xacro FILE > robot.urdf`",
    ),
    (
        "<parent link=\"a\"/>",
        "",
        "7: expected a `parent` inside `joint`",
    ),
    (
        "<parent link=\"a\"/>",
        "<parent link=\"c\"/>",
        "9: there is no link `c`",
    ),
    (
        "<axis xyz=\"0 0 1\"/>",
        "<axis xyz=\"0 0 0\"/>",
        "11: an axis has a direction",
    ),
    (
        "rpy=\"0 0 0\"",
        "rpy=\"0 0 0\" quat_xyzw=\"0 0 0 1\"",
        "8: an `origin` has `rpy` or `quat_xyzw`, not both",
    ),
    (
        "rpy=\"0 0 0\"",
        "quat_xyzw=\"0 0 0\"",
        "8: `quat_xyzw` is four numbers, found `0 0 0`",
    ),
    (
        "rpy=\"0 0 0\"",
        "quat_xyzw=\"0 0 0 0\"",
        "8: no orientation has the quaternion zero",
    ),
    (
        "<link name=\"a\"/>",
        "<xacro:wheel name=\"a\"/>",
        "2: this is for xacro, which prints the URDF file to convert: `xacro FILE > robot.urdf`",
    ),
    (
        "<link name=\"a\"/>",
        "<wheel xmlns=\"http://www.ros.org/wiki/xacro\" name=\"a\"/>",
        "2: this is for xacro, which prints the URDF file to convert: `xacro FILE > robot.urdf`",
    ),
    (
        "<parent link=\"a\"/>",
        "<parent link=\"b\"/>",
        "1: some joints hang on each other and not on `a`",
    ),
    (
        "</robot>",
        "<link name=\"c\"/>\n</robot>",
        "1: one link is the root, found `a`, `c`",
    ),
    (
        "</robot>",
        "<joint name=\"j\" type=\"fixed\"><parent link=\"b\"/><child link=\"a\"/></joint></robot>",
        "13: there is another joint `j`",
    ),
    (
        "</robot>",
        "<joint name=\"k\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/></joint></robot>",
        "13: `b` hangs on the joint `j` already",
    ),
    (
        "</robot>",
        "<joint name=\"k\" type=\"fixed\"><parent link=\"b\"/><child link=\"a\"/></joint></robot>",
        "1: no link is without a joint that holds it",
    ),
    (
        "<axis ",
        "<mimic joint=\"k\"/><axis ",
        "11: there is no joint `k`",
    ),
    (
        "<axis ",
        "<mimic joint=\"j\" multiplier=\"2\"/><axis ",
        "7: in the end joint `j` mimics itself",
    ),
    (
        "<axis xyz=\"0 0 1\"/>",
        "<mimic joint=\"k\"/></joint><link name=\"c\"/><joint name=\"k\" type=\"prismatic\">\
         <parent link=\"b\"/><child link=\"c\"/><mimic joint=\"j\"/>",
        "7: in the end joint `j` mimics itself",
    ),
    (
        "<axis xyz=\"0 0 1\"/>",
        "<mimic joint=\"k\"/></joint><link name=\"c\"/><joint name=\"k\" type=\"floating\">\
         <parent link=\"b\"/><child link=\"c\"/>",
        "7: joint `j` mimics `k`, which has several coordinates",
    ),
    (
        "<axis ",
        "<mimic joint=\"j\" multiplier=\"twice\"/><axis ",
        "11: `multiplier` is a number, found `twice`",
    ),
];

#[test]
fn a_robot_without_links_is_told_so() {
    let found = mbg_urdf::convert("<robot/>", "r.urdf", &Options::default()).unwrap_err();
    assert_eq!(found.to_string(), "1: a robot has a link");
}

#[test]
fn mistakes_are_told_with_their_lines() {
    for (part, changed, expected) in MISTAKES {
        let found =
            mbg_urdf::convert(&file(part, changed), "r.urdf", &Options::default()).unwrap_err();
        assert!(
            found.to_string().starts_with(expected),
            "found {found}\nexpected {expected}"
        );
    }
}

#[test]
fn what_is_left_out_is_told() {
    let cases = [
        (
            "<axis ",
            "<limit effort=\"1\"/><axis ",
            "11: `limit` is not converted",
        ),
        (
            "<axis ",
            "<axis xyz=\"0 0 1\"/><axis ",
            "11: another `axis` is not converted",
        ),
        (
            "rpy=\"0 0 0\"",
            "rpy=\"0 0 90\"",
            "8: 90 is more than a turn: `rpy` is in rad",
        ),
        (
            "rpy=\"0 0 0\"",
            "rpi=\"0 0 1\"",
            "8: `rpi` of `origin` is not converted",
        ),
        (
            "<axis ",
            "<dynamics damping=\"1\" spring_stiffness=\"2\"/><axis ",
            "11: `spring_stiffness` of `dynamics` is not converted",
        ),
        (
            "izz=\"1\"",
            "izz=\"-1\"",
            "3: mass or inertia of `b` is negative, as no body's can be",
        ),
        (
            "<axis ",
            "<dynamics damping=\"-0.1\"/><axis ",
            "11: the `damping` of `j` drives it, as it is negative: -0.1",
        ),
        (
            "ixx=\"1\" iyy=\"1\"",
            "ixx=\"-1\" iyy=\"-1\"",
            "3: mass or inertia of `b` is negative, as no body's can be",
        ),
        (
            "ixx=\"1\" iyy=\"1\" izz=\"1\"",
            "ixx=\"1\" ixy=\"2\" iyy=\"1\" izz=\"1\"",
            "3: mass or inertia of `b` is negative, as no body's can be",
        ),
        (
            "<mass value=\"1\"/>\n<inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/>",
            "<mass value=\"0\"/>\n<inertia ixx=\"0\" iyy=\"0\" izz=\"0\"/>",
            "7: nothing that `j` moves has a mass or an inertia, which `mbg!` will refuse",
        ),
        (
            "<mass value=\"1\"/>\n<inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/>",
            "<mass value=\"0\"/>",
            "6: nothing that `j` moves has a mass or an inertia, which `mbg!` will refuse",
        ),
    ];
    for (part, changed, expected) in cases {
        let found = mbg_urdf::convert(&file(part, changed), "r.urdf", &Options::default()).unwrap();
        let told: Vec<String> = found.remarks.iter().map(ToString::to_string).collect();
        assert_eq!(told, [expected], "{changed}");
    }
}

#[test]
fn what_floats_is_no_load_of_the_joint_before_it() {
    let part = "</robot>";
    let text = file(
        part,
        "<link name=\"c\"/><joint name=\"k\" type=\"revolute\"><parent link=\"a\"/><child link=\"c\"/></joint></robot>",
    );
    let floating = text.replace(
        "name=\"j\" type=\"revolute\"",
        "name=\"j\" type=\"floating\"",
    );
    let floating = floating.replace("<parent link=\"a\"/>\n", "<parent link=\"c\"/>\n");
    let found = mbg_urdf::convert(&floating, "r.urdf", &Options::default()).unwrap();
    let told: Vec<String> = found.remarks.iter().map(ToString::to_string).collect();
    let expected = "13: nothing that `k` moves has a mass or an inertia, which `mbg!` will refuse";
    assert_eq!(told, [expected]);
}

#[test]
fn stops_without_a_way_and_stops_that_push_at_the_start_are_told() {
    let told = |limit: &str| {
        let text = file("<axis ", &format!("<limit {limit}/><axis "));
        let options = Options {
            stops: true,
            ..Options::default()
        };
        let found = mbg_urdf::convert(&text, "r.urdf", &options).unwrap();
        let texts = found.remarks.iter().map(ToString::to_string);
        texts.collect::<Vec<String>>()
    };
    assert_eq!(told("lower=\"-1\" upper=\"1\""), [""; 0]);
    assert_eq!(
        told("lower=\"0\" upper=\"0\""),
        ["11: `j` gets no stop, as its limits are both 0"]
    );
    assert_eq!(
        told("lower=\"-3\" upper=\"-0.1\""),
        ["11: `j` starts beyond its stop, unless `initial` is from -3 to -0.1"]
    );
}

/// Of any length and sign; that other angles are met, too, geometry's own tests show.
#[test]
fn an_orientation_may_be_a_quaternion() {
    for (quaternion, angles) in [
        ("0.5 0.5 0.5 0.5", "1.5707963267948966 0 1.5707963267948966"),
        ("0 -2 0 -2", "0 1.5707963267948966 0"),
    ] {
        let [turned, expected] =
            [("quat_xyzw", quaternion), ("rpy", angles)].map(|(name, value)| {
                let text = file("rpy=\"0 0 0\"", &format!("{name}=\"{value}\""));
                mbg_urdf::convert(&text, "r.urdf", &Options::default()).unwrap()
            });
        assert_eq!(turned, expected);
    }
}

#[test]
fn a_fixed_joint_mimics_none() {
    let text = file("type=\"revolute\"", "type=\"fixed\"");
    let text = text.replace("<axis ", "<mimic joint=\"j\"/><axis ");
    let found = mbg_urdf::convert(&text, "r.urdf", &Options::default()).unwrap();
    assert_eq!(
        found.remarks[0].to_string(),
        "11: a fixed joint mimics none"
    );
}

#[test]
fn what_means_nothing_is_no_mistake() {
    let plain = |part: &str, changed: &str| {
        let found = mbg_urdf::convert(&file(part, changed), "r.urdf", &Options::default()).unwrap();
        assert_eq!(found.remarks, []);
        found.text
    };
    let head = "<?xml version=\"1.0\"?>\n<!DOCTYPE robot>\n<robot name=\"r\">";
    assert_eq!(plain("<robot name=\"r\">", head), plain("", ""));
    let held = |axis: &str| {
        let joint = "<joint name=\"k\" type=\"fixed\"><parent link=\"b\"/><child link=\"c\"/>";
        plain(
            "</robot>",
            &format!("<link name=\"c\"/>{joint}{axis}</joint></robot>"),
        )
    };
    assert_eq!(held("<axis xyz=\"0 0 0\"/>"), held(""));
}

/// What the command prints on standard output and standard error, and whether it succeeds.
fn run(arguments: &[&str]) -> (String, String, Option<i32>) {
    let output = Command::new(env!("CARGO_BIN_EXE_mbg-urdf"))
        .args(arguments)
        .output()
        .unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (
        text(output.stdout),
        text(output.stderr),
        output.status.code(),
    )
}

#[test]
fn the_command_prints_the_component() {
    let path = format!("{}/arm.urdf", env!("CARGO_TARGET_TMPDIR"));
    let text = file("<axis ", "<limit effort=\"1\"/><axis ");
    std::fs::write(&path, &text).unwrap();
    let (printed, told, code) = run(&["--model", "Bench", &path]);
    let options = Options {
        model: Some("Bench"),
        ..Options::default()
    };
    let expected = mbg_urdf::convert(&text, &path, &options).unwrap();
    assert_eq!(printed, expected.text);
    assert!(printed.contains("pub model Bench {"));
    assert_eq!(told, format!("{path}:11: `limit` is not converted\n"));
    assert_eq!(code, Some(0));
    let limited = text.replace("<limit ", "<limit lower=\"-1\" upper=\"1\" ");
    std::fs::write(&path, &limited).unwrap();
    let (printed, _, code) = run(&["--stops", &path]);
    let options = Options {
        stops: true,
        ..Options::default()
    };
    let expected = mbg_urdf::convert(&limited, &path, &options).unwrap();
    assert_eq!((printed, code), (expected.text, Some(0)));
}

#[test]
fn what_is_not_converted_anywhere_is_told_once() {
    let path = format!("{}/limits.urdf", env!("CARGO_TARGET_TMPDIR"));
    for (count, told_too) in [
        (2, ", and once more below"),
        (4, ", and 3 times more below"),
    ] {
        let limits = "<limit/>".repeat(count);
        std::fs::write(&path, file("<axis ", &format!("{limits}<gazebo/><axis "))).unwrap();
        let (_, told, _) = run(&[&path]);
        let expected = format!(
            "{path}:11: `limit` is not converted{told_too}\n{path}:11: `gazebo` is not converted\n"
        );
        assert_eq!(told, expected);
    }
}

#[test]
fn an_angle_beside_a_right_one_is_told_with_what_to_type() {
    let path = format!("{}/beside.urdf", env!("CARGO_TARGET_TMPDIR"));
    std::fs::write(&path, file("rpy=\"0 0 0\"", "rpy=\"1.5708 0 0\"")).unwrap();
    let (printed, told, code) = run(&[&path]);
    let told = told.strip_prefix(&format!("{path}:8: ")).unwrap();
    assert_eq!(
        told,
        "1.5708 is 3.7e-6 rad beside a right angle; with `--right-angles 1e-5` fewer operations are left\n"
    );
    assert!(printed.contains("Turn { by: rot_x(1.5708"), "{printed}");
    assert_eq!(code, Some(0));
    let (printed, told, _) = run(&["--right-angles", "1e-5", &path]);
    let right = "Turn { by: [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]";
    assert!(printed.contains(right), "{printed}");
    assert_eq!(told, "");
}

#[test]
fn the_command_says_how_it_is_used() {
    let (help, told, code) = run(&["--help"]);
    assert!(help.contains("example:\n  mbg-urdf robots/arm.urdf > robots/arm.mbg"));
    assert_eq!((told.as_str(), code), ("", Some(0)));
    let cases: [(&[&str], &str); 7] = [
        (&[], "mbg-urdf: a file is missing"),
        (&["a", "b"], "mbg-urdf: one file at a time"),
        (&["--mode", "b"], "mbg-urdf: `--mode` is not known"),
        (&["--model"], "mbg-urdf: `--model` needs a name"),
        (
            &["--model", "my arm", "a"],
            "mbg-urdf: `my arm` cannot be the name of a model",
        ),
        (
            &["--right-angles"],
            "mbg-urdf: `--right-angles` needs an angle below 0.1 rad, such as 1e-5",
        ),
        (
            &["--right-angles", "1.6", "a"],
            "mbg-urdf: `--right-angles` needs an angle below 0.1 rad, such as 1e-5",
        ),
    ];
    for (arguments, expected) in cases {
        let (printed, told, code) = run(arguments);
        assert!(told.starts_with(expected), "{told}");
        assert_eq!((printed.as_str(), code), ("", Some(2)));
    }
    let (_, told, code) = run(&["nowhere.urdf"]);
    assert!(told.starts_with("nowhere.urdf: "), "{told}");
    assert_eq!(code, Some(1));
}
