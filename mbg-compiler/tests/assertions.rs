//! What models assert of their parameters.
#![allow(clippy::unwrap_used)]

mod models;
mod told;

use models::compiled;
use told::{told, typed};

/// A spring between two limits, which are given to it.
fn text(statement: &str, lower: &str, upper: &str) -> String {
    format!(
        "component Limits(port 1 v) {{ param lower; param upper; assert lower < upper; v -> C s {{ effort: 1.0 * min(max(q, lower), upper) }}; }}
         model M {{ param low = -1.0; param high = 2.0; param way: m = 3.0; param force: N = 1.0;
         1 v {{ I m {{ inertia: 1.0 }} C c {{ effort: force / way * (q + low - high) }} }}\nlimits: Limits {{ lower: {lower}, upper: {upper} }} (v); {statement} }}"
    )
}

#[test]
fn parameters_are_checked_by_new_and_numbers_while_compiling() {
    let model = compiled(&text(
        "assert low <= 0.0 && high != 3.0; assert 1 < 2;",
        "low",
        "high",
    ));
    let checks = model
        .checks
        .iter()
        .filter(|it| it.reason.contains("asserted"));
    let checks = checks.map(|it| {
        (
            it.name.as_str(),
            format!("{:?}", it.condition),
            it.reason.as_str(),
        )
    });
    let expected = [
        ("high - low", "Positive", "`lower < upper` is asserted"),
        ("-low", "NotNegative", "`low <= 0.0` is asserted"),
        ("high - 3", "NonZero", "`high != 3.0` is asserted"),
    ];
    let expected = expected.map(|(name, condition, reason)| (name, condition.to_owned(), reason));
    assert_eq!(checks.collect::<Vec<_>>(), expected);
    insta::assert_snapshot!(told(&text("", "2.0", "1.0")), @"1:63 `lower < upper` is asserted of `limits`, and these are 2.0 and 1.0 [MBG0213]");
    insta::assert_snapshot!(told(&text("assert 2 > 3;", "0.0", "1.0")), @"4:55 `2 > 3` is asserted, and these are 2.0 and 3.0 [MBG0213]");
    insta::assert_snapshot!(told(&text("assert 2 < 1;", "0.0", "1.0")), @"4:55 `2 < 1` is asserted, and these are 2.0 and 1.0 [MBG0213]");
}

#[test]
fn what_is_no_assertion_is_told() {
    for (statement, expected) in [
        ("assert low;", "assert a < b;"),
        ("assert low = 2.0;", "assert a < b;"),
    ] {
        let help = typed(&text(statement, "0.0", "1.0"));
        assert!(
            help.iter().any(|it| it == expected),
            "{statement}: {help:?}"
        );
    }
    insta::assert_snapshot!(told(&text("assert way < force;", "0.0", "1.0")), @"4:55 `way` is `m` and `force` is `N`: they are neither added nor compared [MBG0501]");
    insta::assert_snapshot!(told(&text("assert;", "0.0", "1.0")), @"4:54 expected a comparison after `assert`, found `;` [MBG0101]");
}
