//! Names inside loops, read from outside: what is told of them, and that what is told leads to a model.
#![allow(clippy::unwrap_used)]

mod told;

use told::{told, typed};

/// What a loop of junctions holds.
const CELL: &str = "1 v { I m { inertia: 1.0 } R r { resistance: 1.0 } }";

/// A model of the statements, with `…` for what a junction with its elements holds.
fn model(statements: &str) -> String {
    format!("model M {{ let n = 3; {} }}", statements.replace('…', CELL))
}

/// The helps of the only mistake are these, and what they say to type makes a model.
fn leads(statements: &str, helps: &[&str], followed: &str) {
    assert_eq!(typed(&model(statements)), helps, "{statements}");
    assert_eq!(told(&model(followed)), "", "{followed}");
}

#[test]
fn a_loop_without_a_label_is_to_be_named() {
    let named = "cells: for k in 0..n { … }";
    let cases = [
        ("output s = v.f;", "cells[0].v.f"),
        ("output s = m.p;", "cells[0].m.p"),
        ("output s = v[2].f;", "cells[2].v.f"),
        ("output s = missing; let missing = v.f;", "cells[0].v.f"),
    ];
    for (output, read) in cases {
        leads(
            &format!("for k in 0..n {{ … }} {output}"),
            &[named, read],
            &format!("{named} output s = {read};"),
        );
    }
    let bond =
        "1 w { I z { inertia: 1.0 } } for k in 0..n { … } v -> GY gear { effort: 2.0 } -> w;";
    let followed = "1 w { I z { inertia: 1.0 } } cells: for k in 0..n { … } cells[0].v -> GY gear { effort: 2.0 } -> w;";
    leads(bond, &[named, "cells[0].v"], followed);
    insta::assert_snapshot!(told(&model("for k in 0..n { … }\noutput s = v.f;")), @"
    2:12 `v` is not declared [MBG0203]
      help: give the loop a name, `cells: for k in 0..n { … }`, and write `cells[0].v.f`
    ");
    // A name that is taken, a label that stands there, and a name that nothing declares.
    let taken = "cellss: for k in 0..n { … }";
    leads(
        "let cells = 1.0; for k in 0..n { … } output s = cells * v.f;",
        &[taken, "cellss[0].v.f"],
        &format!("let cells = 1.0; {taken} output s = cells * cellss[0].v.f;"),
    );
    insta::assert_snapshot!(told(&model("row: for k in 0..n { … }\noutput s = v.f;")), @"
    2:12 `v` is not declared [MBG0203]
      help: it is declared in a loop: write `row[0].v.f`
    ");
    insta::assert_snapshot!(told(&model("for k in 0..n { … }\noutput s = u.f;")), @"2:12 `u` is not declared [MBG0203]");
    insta::assert_snapshot!(told(&model("for k in 0..n { … }\noutput s = 1.0 * k;")), @"2:18 `k` is not declared [MBG0203]");
}

#[test]
fn a_loop_inside_another_is_to_be_named() {
    let outer = |inner: &str| format!("c: for k in 0..n {{ {inner} }}");
    let (plain, named) = ("for j in 0..2 { … }", "inner: for j in 0..2 { … }");
    for (read, written) in [
        ("c[1].v.f", "c[1].inner[0].v.f"),
        ("c[1][1].v.f", "c[1].inner[1].v.f"),
        ("v.f", "c[0].inner[0].v.f"),
    ] {
        leads(
            &format!("{} output s = {read};", outer(plain)),
            &[named, written],
            &format!("{} output s = {written};", outer(named)),
        );
    }
    let both =
        "cells: for k in 0..2 { inner: for j in 0..2 { … } } output s = cells[0].inner[0].v.f;";
    leads(
        "for k in 0..2 { for j in 0..2 { … } } output s = v.f;",
        &["cells: for k in 0..2 { … }", named, "cells[0].inner[0].v.f"],
        both,
    );
    insta::assert_snapshot!(told(&model("c: for k in 0..n { for j in 0..2 { … } }\noutput s = c[1][1].v.f; output r = c[1].v.f;")), @"
    2:17 `c[1]` is one iteration, which has no index of its own [MBG0203]
      help: give the inner loop a name, `inner: for j in 0..2 { … }`, and write `c[1].inner[1].v.f`
    2:43 `c[1].v.f` is not declared [MBG0203]
      help: give the inner loop a name, `inner: for j in 0..2 { … }`, and write `c[1].inner[0].v.f`
    ");
    insta::assert_snapshot!(told(&model("c: for k in 0..n { … }\noutput s = c[1];")), @"2:12 `c` is a loop; read what is inside an iteration, `c[0].…` [MBG0213]");
}

#[test]
fn an_iteration_behind_the_last_one_is_left_out() {
    let row = "for k in 0..n { 0 gap { C s { stiffness: 1.0 } R d { resistance: 1.0 } } c[k].v -> gap; LINK }";
    let link = "gap -> c[k+1].v;";
    let cells = |end: &str| format!("c: for k in 0..{end} {{ … }}");
    let statements =
        |end: &str, link: &str| format!("{} {}", cells(end), row.replace("LINK", link));
    insta::assert_snapshot!(told(&model(&statements("n", link)).replace("gap ->", "\ngap ->")), @"
    2:8 `c` runs over 0..3, there is no `c[3]` [MBG0203]
      help: where there is none, nothing is written: `if k < 2 { … }` around the statement
      help: or let `c` run to 4: a row has one junction more than elements between them
    ");
    leads(
        &statements("n", link),
        &["if k < 2 { … }", "c"],
        &statements("n", "if k < 2 { gap -> c[k+1].v; }"),
    );
    assert_eq!(told(&model(&statements("n + 1", link))), "");
    leads(
        &statements("n", "gap -> c[2*k].v;"),
        &["if 2 * k < 3 { … }"],
        &statements("n", "if 2 * k < 3 { gap -> c[2*k].v; }"),
    );
    leads(
        &statements("n", "gap -> c[k-1].v;"),
        &["if k > 0 { … }"],
        &statements("n", "if k > 0 { gap -> c[k-1].v; }"),
    );
    // A number says nothing of a loop.
    assert!(typed(&model(&format!("{} output s = c[3].v.f;", cells("n")))).is_empty());
}
