//! Steps across singular positions of closed loops, where branches of their motion meet.

use mbg_runtime::{
    Adaptive, Dop853, Estimating, Integrator, Radau5, Radau9, Rodas4, Rodas5P, System, Tsit5, mbg,
};
use nalgebra::SVector;

mbg! {
    /// A parallelogram of two cranks and a coupler, which turns through the positions in which all of them are in line.
    #[derivative]
    model Parallelogram {
        causality componentwise;
        gravity [0.0, -9.81];
        1 ground[3]; 1 left[3]; 1 a[3]; 1 right[3]; 1 b[3]; 1 coupler[3]; 1 end[3]; 1 foot[3];
        1 left_centre[3]; 1 right_centre[3]; 1 coupler_centre[3];
        Sf fixed[3] { flow: 0.0 } -> ground;
        first: PlanarRevolute { initial: 1.0 } (ground, left);
        left_half: PlanarOffset { x: 0.25 } (left, left_centre);
        left_body: PlanarBody { mass: 1.0, inertia: 0.1 } (left_centre);
        left_arm: PlanarOffset { x: 0.5 } (left, a);
        base: PlanarOffset { x: 1.0 } (ground, foot);
        second: PlanarRevolute { initial: 1.0 } (foot, right);
        right_half: PlanarOffset { x: 0.25 } (right, right_centre);
        right_body: PlanarBody { mass: 1.0, inertia: 0.1 } (right_centre);
        right_arm: PlanarOffset { x: 0.5 } (right, b);
        third: PlanarRevolute { initial: -1.0 } (a, coupler);
        coupler_half: PlanarOffset { x: 0.5 } (coupler, coupler_centre);
        coupler_body: PlanarBody { mass: 1.0, inertia: 0.1 } (coupler_centre);
        coupler_arm: PlanarOffset { x: 1.0 } (coupler, end);
        cut: PlanarCut (end, b);
        output angles[2]: rad = [first.angle, second.angle];
    }
}

/// The angle of both cranks at 20 s: they stay parallel, and move as one pendulum.
fn pendulum() -> f64 {
    let inertia = 2.0 * (0.1 + 0.25 * 0.25) + 0.5 * 0.5;
    let moment = 9.81 * (2.0 * 0.25 + 0.5);
    let rate = |[angle, speed]: [f64; 2]| [speed, -moment * angle.cos() / inertia];
    let step = 2e-4;
    let along = |x: [f64; 2], k: [f64; 2], part: f64| [0, 1].map(|i| x[i] + part * step * k[i]);
    let mut x = [1.0, 0.0];
    for _ in 0..100_000 {
        let first = rate(x);
        let second = rate(along(x, first, 0.5));
        let third = rate(along(x, second, 0.5));
        let fourth = rate(along(x, third, 1.0));
        let sum = [0, 1].map(|i| (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]) / 6.0);
        x = along(x, sum, 1.0);
    }
    x[0]
}

/// They leave for the motion in which they turn in opposite directions at none of the passages.
#[test]
fn a_parallelogram_stays_on_its_branch() {
    let expected = pendulum();
    for (tolerance, allowed) in [
        (1e-6, 5e-3),
        (1e-8, 1e-4),
        (1e-9, 1e-5),
        (1e-10, 1e-5),
        (1e-11, 1e-5),
    ] {
        for [first, second] in [
            at_end(Tsit5, tolerance),
            at_end(Dop853, tolerance),
            at_end(Rodas4, tolerance),
            at_end(Rodas5P, tolerance),
            at_end(Radau5, tolerance),
            at_end(Radau9, tolerance),
        ] {
            let error = first - expected;
            assert!(error.abs() < allowed, "{tolerance:e} {error:e}");
            assert!(
                (second - first).abs() < 1e-9,
                "{tolerance:e} {first} {second}"
            );
        }
    }
}

fn at_end<M: Estimating>(method: M, tolerance: f64) -> [f64; 2] {
    let model = Parallelogram::<f64>::new(ParallelogramParameters::default()).unwrap();
    let mut last = model.initial_state();
    Adaptive::new(method, tolerance, tolerance)
        .integrate(&model, &(), 0.0, 20.0, last, |step| last = *step.state())
        .unwrap();
    let none = SVector::zeros();
    model.output(20.0, &last, &none, &mut ()).into()
}
