//! Friction that falls with the slip: what it lets go departs ever faster from where it was.

use mbg_runtime::{Adaptive, Dop853, Estimating, Radau5, Radau9, Tsit5, mbg};
use nalgebra::SVector;

use super::last;

mbg! {
    /// A block on a belt, between springs and beside another block.
    model Bowed {
        1 motion { I block { inertia: 0.01 } R loss { resistance: 0.5 } }
        0 pull { C spring { stiffness: 400.0 } }
        1 next { I other { inertia: 0.01 } }
        0 end { C tension { stiffness: 400.0 } }
        1 wall { Sf still { flow: 0.0 } }
        motion -> pull; pull -> next; next -> end; end -> wall;
        0 contact;
        1 belt { Sf roller { flow: 0.15 } }
        1 slip { R rub { effort: (0.3 + 0.5 / (1.0 + abs(f) / 0.05)) * sign(f) } }
        belt -> contact; contact -> motion; contact -> slip;
        output speed: m/s = motion.f;
    }
}

/// The state after a second, in which the block sticks and slips.
fn end(method: impl Estimating, tolerance: f64) -> SVector<f64, 4> {
    let model = Bowed::<f64>::new(BowedParameters::default()).unwrap();
    let solver = Adaptive::new(method, tolerance, tolerance);
    last(&model, &(), 1.0, &solver).0
}

#[test]
fn what_was_held_sets_off_as_exactly_as_it_goes_on() {
    let exact = end(Dop853, 1e-13);
    assert!((end(Tsit5, 1e-13) - exact).amax() < 1e-10);
    for tolerance in [1e-7, 1e-8, 1e-9, 1e-10] {
        for found in [end(Radau9, tolerance), end(Radau5, tolerance)] {
            let error = (found - exact).amax();
            assert!(error < 100.0 * tolerance, "{tolerance}: {error}");
        }
    }
}
