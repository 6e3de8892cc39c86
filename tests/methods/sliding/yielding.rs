//! A spring that yields: what it does not give back stays.

use mbg_runtime::{Adaptive, Dop853, Fixed, Integrator, Radau5, Rk4, Rodas5P, Tsit5, mbg};
use nalgebra::SVector;

use super::last;

mbg! {
    /// A mass on a spring in a row with a slider of dry friction.
    model Yielding {
        param stiffness: N/m = 100.0;
        param limit: N = 5.0;
        1 way {
            I mass { inertia: 1.0, initial_flow: 2.0 }
            R brace { effort: stiffness * elastic }
        }
        let most = limit / stiffness;
        integral elastic: m =
            if (elastic >= most && way.f > 0.0) || (elastic <= -most && way.f < 0.0) { 0.0 } else { way.f };
        integral travel: m = way.f;
        output travel: m = travel;
    }
}

/// Whether a run comes to where the mass is when it swings back, by so much.
fn assert_swings_back(solver: &impl Integrator<3>, bound: f64) {
    let model = Yielding::<f64>::new(YieldingParameters::default()).unwrap();
    // With a quarter of the speed gone into the spring it yields; the mass is slowed down evenly then, and swings back.
    let speed = 2.0 * f64::sqrt(1.0 - 0.25 * 0.25);
    let (until_it_yields, until_rest, back) = (f64::asin(0.25) / 10.0, speed / 5.0, 0.2);
    let end = until_it_yields + until_rest + back;
    let elastic = 0.05 * f64::cos(10.0 * back);
    let expected = [
        -0.5 * f64::sin(10.0 * back),
        elastic,
        speed * speed / 10.0 + elastic,
    ];
    let error = (last(&model, &(), end, solver).0 - SVector::from(expected)).amax();
    assert!(error < bound, "{error}");
}

#[test]
fn what_has_yielded_swings_about_where_it_has_come_to() {
    assert_swings_back(&Adaptive::new(Tsit5, 1e-9, 1e-9), 1e-8);
    assert_swings_back(&Adaptive::new(Dop853, 1e-9, 1e-9), 1e-8);
    assert_swings_back(&Adaptive::new(Rodas5P, 1e-9, 1e-9), 1e-8);
    assert_swings_back(&Adaptive::new(Radau5, 1e-9, 1e-9), 1e-8);
    assert_swings_back(&Fixed::new(Rk4, 1e-3), 1e-8);
}
