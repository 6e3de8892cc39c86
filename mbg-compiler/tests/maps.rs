//! Maps of two variables by the functions of other tools, and the curves of curves that are to be typed.
#![allow(clippy::unwrap_used)]

mod told;

use told::{told, typed};

/// A mass and what drives it.
fn driven(law: &str) -> String {
    format!("model M {{ 1 v {{ I m {{ inertia: 1.0 }}\nSe s {{ effort: {law} }} }} }}")
}

#[test]
fn maps_of_two_variables_are_told_as_curves_of_curves() {
    let along = "[[0.0, 1.0, 2.0], [1.0, 2.0, 4.0]]";
    let across = "[[0.0, 1.0], [1.0, 2.0], [2.0, 4.0]]";
    let (x, y) = ("[0.0, 1.0]", "[0.0, 1.0, 3.0]");
    let by_x = "interpolate(t, [0.0, 1.0], [interpolate(m.p, [0.0, 1.0, 3.0], [0.0, 1.0, 2.0]), \
                interpolate(m.p, [0.0, 1.0, 3.0], [1.0, 2.0, 4.0])])";
    let by_y = "interpolate(m.p, [0.0, 1.0, 3.0], [interpolate(t, [0.0, 1.0], [0.0, 1.0]), \
                interpolate(t, [0.0, 1.0], [1.0, 2.0]), interpolate(t, [0.0, 1.0], [2.0, 4.0])])";
    for (slip, map) in [
        (format!("lookup_2d(t, m.p, {x}, {y}, {along})"), by_x),
        (format!("interpolate(t, m.p, {x}, {y}, {along})"), by_x),
        (format!("interpolate(t, m.p, {x}, {y}, {across})"), by_y),
        (format!("interp2({x}, {y}, {across}, t, m.p)"), by_y),
    ] {
        let help = typed(&driven(&slip)).remove(0);
        assert_eq!(help, map);
        assert_eq!(told(&driven(&help)), "");
    }
    // A table with a name, by its rows.
    let table =
        |law: &str| driven(law).replace("model M {", &format!("model M {{ let table = {along};"));
    let help = typed(&table(&format!("interp2d(t, m.p, {x}, {y}, table)"))).remove(0);
    let rows = "[interpolate(m.p, [0.0, 1.0, 3.0], table[0]), interpolate(m.p, [0.0, 1.0, 3.0], table[1])]";
    assert_eq!(help, format!("interpolate(t, [0.0, 1.0], {rows})"));
    assert_eq!(told(&table(&help)), "");
}
