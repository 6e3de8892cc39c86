//! Bennett's linkage: four hinges, whose loop moves for its proportions alone. Three of the five equations that close it are
//! redundant where it is closed, and only there.

use mbg_runtime::{Adaptive, Dop853, Fixed, Integrator, Rk4, Stopped, System, mbg};
use nalgebra::SVector;

mbg! {
    /// Links of lengths a and b, twisted by `alpha` and `beta` with a sin(beta) = b sin(alpha); the last one is the ground.
    #[derivative]
    pub(crate) model Bennett {
        causality componentwise;
        let alpha = 0.6;
        let beta = 1.1;
        let a = 0.5;
        let b = a * sin(beta) / sin(alpha);
        let first = 0.8;
        let second = 2.0 * atan2(sin((beta + alpha) / 2), sin((beta - alpha) / 2) * tan(first / 2));
        1 ground[6]; 1 crank[6]; 1 knee[6]; 1 coupler[6]; 1 elbow[6]; 1 rocker[6]; 1 wrist[6]; 1 seat[6];
        Sf fixed[6] { flow: 0.0 } -> ground;
        one: Revolute { axis: 2, initial: first, initial_rate: 1.3 } (ground, crank);
        light: Body { mass: 1.2, inertia: diag(0.02, 0.05, 0.06), centre: [0.25, 0.02, 0.01] } (crank);
        far: Mount { offset: [a, 0.0, 0.0], tilt: rot_x(alpha) } (crank, knee);
        two: Revolute { axis: 2, initial: second } (knee, coupler);
        long: Body { mass: 0.7, inertia: diag(0.01, 0.03, 0.02), centre: [0.4, 0.0, -0.05] } (coupler);
        beyond: Mount { offset: [b, 0.0, 0.0], tilt: rot_x(beta) } (coupler, elbow);
        three: Revolute { axis: 2, initial: -first } (elbow, rocker);
        heavy: Body { mass: 0.9, inertia: diag(0.02, 0.03, 0.04), centre: [0.2, 0.1, 0.0] } (rocker);
        back: Mount { offset: [a, 0.0, 0.0], tilt: rot_x(alpha) } (rocker, wrist);
        frame: Mount { offset: [-b, 0.0, 0.0], tilt: rot_x(-beta) } (ground, seat);
        cut: Cut { joint: revolute } (wrist, seat);
        output angles[3]: rad = [one.angle, two.angle, three.angle];
    }
}

type State = SVector<f64, 6>;

fn end(system: &Bennett, method: impl Integrator<6>) -> Result<State, Stopped> {
    let mut end = system.initial_state();
    method.integrate(system, &(), 0.0, 2.0, end, |step| end = *step.state())?;
    Ok(end)
}

#[test]
fn an_overconstrained_linkage_is_run_at_the_order_of_the_method() {
    let system = Bennett::new(BennettParameters::default()).unwrap();
    let exact = end(&system, Adaptive::new(Dop853, 1e-12, 1e-12)).unwrap();
    let [one, two, three]: [f64; 3] = system
        .output(2.0, &exact, &SVector::zeros(), &mut ())
        .into();
    // Bennett: opposite angles are opposite, those beside each other have half tangents of a constant product.
    let product = f64::sin(0.85) / f64::sin(0.25);
    assert!((f64::tan(one / 2.0) * f64::tan(two / 2.0) - product).abs() < 1e-11);
    assert!((one + three).abs() < 1e-12 && (one - 0.8).abs() > 0.5);
    let closed = system
        .close(0.0, system.initial_state(), &SVector::zeros(), &[])
        .unwrap();
    let [before, after] = [closed, exact].map(|state| system.energy(0.0, &state));
    assert!((after / before - 1.0).abs() < 1e-10);

    let errors =
        [0.02, 0.01].map(|step| (end(&system, Fixed::new(Rk4, step)).unwrap() - exact).norm());
    assert!(
        errors[0] < 1e-5 && errors[1] < errors[0] / 12.0,
        "{errors:?}"
    );
    let steps = Adaptive::new(Dop853, 1e-9, 1e-9)
        .integrate(&system, &(), 0.0, 2.0, closed, |_| ())
        .unwrap()
        .steps;
    assert!(steps < 60, "{steps}");
}
