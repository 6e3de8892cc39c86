//! Long rows of like parts: their steps are written once, in a loop.

use mbg_compiler::compile::{Compiled, Routines};
use mbg_compiler::program::dump;

mod models;

const RODS: &str = include_str!("../../examples/gallery/rods.mbg");

fn rods(count: usize) -> Compiled {
    models::compiled(&format!(
        "{RODS}
        #[derivative]
        model Row {{
            gravity [0.0, -9.81];
            1 ground[3] {{ Sf fixed {{ flow: 0.0 }} }}
            row: Rods {{ count: {count} }} (ground);
        }}"
    ))
}

/// Lines of what a function works out.
fn lines(compiled: &Compiled, routine: usize) -> usize {
    dump(&compiled.program.routines[routine]).lines().count()
}

#[test]
fn twice_as_many_rods_take_no_more_lines() {
    let (short, long) = (rods(60), rods(120));
    for routine in [Routines::DERIVATIVE, Routines::OUTPUT, Routines::ENERGY] {
        let (short, long) = (lines(&short, routine), lines(&long, routine));
        println!("{short} lines for 60 rods, {long} for 120");
        assert_eq!(short, long, "routine {routine}");
    }
}

#[test]
fn few_rods_have_no_loop() {
    let loops = |compiled: &Compiled| {
        compiled.program.routines[Routines::DERIVATIVE]
            .repeats
            .len()
    };
    assert_eq!(loops(&rods(4)), 0);
    assert!(loops(&rods(60)) > 0);
}
