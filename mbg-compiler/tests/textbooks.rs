//! Graphs as textbooks write and draw them, and what is to be typed for them.
#![allow(clippy::unwrap_used)]

mod told;

use told::told;

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
