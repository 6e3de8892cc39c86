//! Every hard case is solved to its reference, or refused with the time and the cause.
#![allow(clippy::unwrap_used)]

#[path = "../examples/hard_cases/suite/mod.rs"]
mod suite;

/// The test prints the report, and fails with the lines that are not as expected.
fn assert_holds(name: &str) {
    let (_, case) = suite::CASES.iter().find(|case| case.0 == name).unwrap();
    let lines = case();
    assert!(!lines.is_empty());
    println!("{}", suite::HEAD);
    for line in &lines {
        println!("{line}");
    }
    let failed: Vec<String> = lines
        .iter()
        .filter(|it| !it.holds())
        .map(ToString::to_string)
        .collect();
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

/// What the report lets pass, and what it does not.
#[test]
fn lines_hold_only_as_expected() {
    use suite::{Expected, Found, Line};
    let holds = |expected, error| {
        let found = Found { error, steps: 1 };
        Line::run(("", "", ""), expected, || Ok(found)).holds()
    };
    assert!(holds(Expected::Within(1.0), 1.0));
    assert!(!holds(Expected::Within(1.0), 1.1));
    assert!(!holds(Expected::Within(1.0), f64::NAN));
    assert!(!holds(Expected::Within(1.0), Found::NONE.error));
    assert!(!holds(Expected::Refused(""), 0.0));
}

macro_rules! cases {
    ($($test:ident = $name:literal;)*) => {
        $(#[test] fn $test() { assert_holds($name); })*

        #[test]
        fn every_case_has_a_test() {
            let names = [$($name),*];
            assert!(suite::CASES.iter().map(|case| case.0).eq(names));
        }
    };
}

cases! {
    gimbal_lock = "gimbal lock";
    sleeping_top = "sleeping top";
    tumbling = "tumbling";
    stiff_pins = "stiff pins";
    constants_of_the_ins = "constants of the INS";
    chaos = "chaos";
    singular_loops = "singular loops";
    impacts = "impacts";
    dry_friction = "dry friction";
    single_precision = "single precision";
    steps_too_long = "steps too long";
    steps_too_short = "steps too short";
    gust = "gust";
    pulses = "pulses";
}
