//! Graphs as textbooks write and draw them, and what is to be typed for them.
#![allow(clippy::unwrap_used)]

mod told;

use told::{diagnose, told, typed};

fn beside_a_mass(statements: &str) -> String {
    format!("model M {{ 1 a {{ I m {{ inertia: 1.0 }} }} {statements} }}")
}

#[test]
fn elements_with_a_colon_and_bonds_with_a_stroke_are_told() {
    let in_chain = |element: &str| beside_a_mass(&format!("a -> {element} {{ resistance: 2.0 }};"));
    let written = typed(&in_chain("R: b")).remove(0);
    assert_eq!(written, "R b");
    assert_eq!(told(&in_chain(&written)), "");
    for bond in ["a ->| b", "a |-> b"] {
        let text =
            |bond: &str| beside_a_mass(&format!("1 b {{ R r {{ resistance: 2.0 }} }} {bond};"));
        let written = typed(&text(bond)).remove(0);
        assert_eq!(told(&text(&written)), "", "{bond}");
    }
}

#[test]
fn a_stiffness_in_the_place_of_a_compliance_is_told_by_its_unit() {
    let spring = |law: &str| {
        format!(
            "model M {{ param k: N/m = 1.0; param b: N*s/m = 2.0; param m: kg = 1.0; 1 a {{ I body {{ inertia: m }} {law} }} }}"
        )
    };
    for (element, name, taken, meant) in [
        ("C", "spring", "compliance: k", "stiffness: k"),
        ("R", "damper", "conductance: b", "resistance: b"),
    ] {
        let other = |law: &str| spring(&format!("{element} {name} {{ {law} }}"));
        let written = typed(&other(taken)).pop().unwrap();
        assert_eq!(written, meant);
        assert_eq!(told(&other(&written)), "");
    }
    // A mass is neither.
    let mass = diagnose(&spring("C spring { compliance: m }")).list()[0].clone();
    assert!(mass.helps.is_empty(), "{:?}", mass.helps);
}

/// `int`, `resint` and `ddt` are functions in 20-sim.
#[test]
fn functions_of_simulators_elements_without_names_and_strokes_of_elements_are_told() {
    let pushed = |effort: &str| beside_a_mass(&format!("a -> Se s {{ effort: {effort} }};"));
    for function in ["int(a.f, 0.5)", "resint(a.f, 0.5)"] {
        let written = typed(&pushed(function));
        let [integral, name] = &written[..] else {
            panic!("{written:?}")
        };
        assert_eq!(integral, "integral name = a.f, initial: 0.5;");
        let declared = beside_a_mass(&format!("{integral} Se s {{ effort: {name} }} -> a;"));
        assert_eq!(told(&declared), "");
    }
    assert!(told(&pushed("dt(a.f)")).contains("laws take no derivatives"));
    let text = |element: &str| beside_a_mass(&format!("a -> {element};"));
    let written = typed(&text("R { resistance: 2.0 }")).remove(0);
    let named = written.replace('…', "resistance: 2.0");
    assert_eq!(told(&text(&named)), "");
    let stroke = text("R r { resistance: 2.0, causality: resistive }");
    assert!(told(&stroke).contains("strokes are found while compiling"));
}

#[test]
fn what_bonds_do_not_share_is_read_at_an_element() {
    let node = |read: &str| {
        format!(
            "model M {{ 0 n {{ Se s {{ effort: 1.0 }} }} 1 a {{ I m {{ inertia: 1.0 }} }} n -> a; output y = {read}; }}"
        )
    };
    for (common, own) in [("n.f", "s.f"), ("a.e", "m.e")] {
        assert_eq!(typed(&node(common)), [own]);
        assert_eq!(told(&node(own)), "");
    }
}

/// The shapes of modes of a beam at one place of it.
#[test]
fn a_row_of_a_matrix_is_told_where_a_vector_stands_in_brackets() {
    let beam = |matrix: &str| {
        format!(
            "model M {{ let shapes = [0.5, 0.8, 0.3]; 1 modes[3] {{ I m {{ inertia: 1.0 }} }} 1 place {{ R r {{ resistance: 2.0 }} }}
             modes -> TF t {{ flow: {matrix} }} -> place; }}"
        )
    };
    let written = typed(&beam("[shapes]")).pop().unwrap();
    assert_eq!(written, "transpose(shapes)");
    assert_eq!(told(&beam(&written)), "");
}

/// Coordinates move masses through a matrix that has no inverse: with one stroke for all of a bond nothing gives the rates.
#[test]
fn dependent_masses_behind_a_matrix_are_told_one_stroke_per_component() {
    let text = |causality: &str| {
        format!(
            "#[derivative] model M {{ {causality} 1 rates[2] coordinate; integral ways[2] = rates.f;
             1 c[3] {{ I m {{ inertia: diag(2.0, 1.5, 1.0) }} }} rates.x -> C k {{ stiffness: 4.0 }};
             rates -> MTF j {{ flow: [[cos(ways[0]), ways[1]], [sin(ways[0]), 1.0], [0.5, ways[0]]] }} -> c; }}"
        )
    };
    let report = diagnose(&text("")).list()[0].clone();
    assert!(
        report.helps[0].contains("`causality componentwise;`"),
        "{:?}",
        report.helps
    );
    assert_eq!(told(&text("causality componentwise;")), "");
}

/// A dependence elsewhere takes nothing from a law that is solved by iteration.
#[test]
fn a_gear_elsewhere_does_not_make_a_law_impose_what_it_gives() {
    let text = |statements: &str| {
        format!(
            "model M {{ causality componentwise; 1 a {{ I m {{ inertia: 1.0 }} }} 1 b {{ I n {{ inertia: 2.0 }} }}
             0 coupling {{ R slip {{ flow: 0.2 * e + powi(e, 3) }} }} a -> coupling -> b; {statements} }}"
        )
    };
    assert_eq!(told(&text("")), "");
    let gear = "1 x { I one { inertia: 1.0 } } 1 y { #[derivative] I other { inertia: 1.0 } }
                x -> TF gear { flow: 3.0 } -> y;";
    assert_eq!(told(&text(gear)), "");
}
