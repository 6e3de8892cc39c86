//! Laws of several entries in different units: the one that is wrong is told, with what stands beside that.
#![allow(clippy::unwrap_used)]

mod told;

use told::told;

#[test]
fn an_entry_of_a_law_is_told_where_entries_differ_in_their_units() {
    let wing = |law: &str| {
        format!(
            "model Wing {{ param mass: kg = 1.0; param offset: kg*m = 0.1; param inertia: kg*m^2 = 0.5; param lift: N = 2.0;
             1 motion[2] {{ I wing {{ inertia: [[mass, offset], [offset, inertia]] }} }}
             {law} }}"
        )
    };
    let law = "Se air[2] { effort: [-lift, lift] } -> motion;";
    insta::assert_snapshot!(told(&wing(law)), @"
    3:34 `effort[1]` of `air` must be `N*m` here, and this is `N` [MBG0501]
      the effort is `N*m` and the flow `1/s` there
    ");
    let law = "param d: N*s/m = 1.0; motion -> R drag { resistance: [[d, 0.0], [0.0, d]] };";
    insta::assert_snapshot!(told(&wing(law)), @"
    3:67 `resistance[1][1]` of `drag` must be `N*m*s` here, and this is `N*s/m` [MBG0501]
      the effort is `N*m` and the flow `1/s` there
    ");
    let law = "param k: N/m = 1.0; motion -> TF lever { flow: [[1, mass]] } -> out; 1 out { C spring { stiffness: k } }";
    insta::assert_snapshot!(told(&wing(law)), @"
    3:61 `flow[0][1]` of `lever` must be `m` here, and this is `kg` [MBG0501]
      before it the effort is `N*m` and the flow `1/s`, after it the effort is `N` and the flow `m/s`
    ");
    // Where all are alike no entry needs to be told.
    let law = "1 way[2]; param k: N = 1.0; param m: kg = 1.0; way -> I both { inertia: m }; way -> C c { stiffness: diag(k, k) };";
    insta::assert_snapshot!(told(&wing(law)), @"
    3:115 `stiffness` of `c` must be `N/m` here, and this is `N` [MBG0501]
      the effort is `N` and the flow `m/s` there
    ");
}
