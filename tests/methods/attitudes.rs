//! Rotations in methods whose stages leave them.

use mbg_runtime::{
    Adaptive, Estimating, Fixed, Integrator, Method, Rodas4, Rodas5P, Ros2, System, mbg,
};

mbg! {
    /// A ball that rolls on a turntable, whose centre goes in circles at 2/7 of the rate of the table.
    component Rolling() {
        param orientation: quaternion | matrix = quaternion;
        1 ground[6]; 1 ball[6]; 1 low[6]; 1 world[6];
        Sf fixed[6] { flow: 0.0 } -> ground;
        free: Free {
            orientation: orientation, initial_position: [0.5, 0.0, 0.1], initial_velocity: [0.2, 0.3, 0.0]
        } (ground, ball);
        body: Body { mass: 0.5, inertia: 0.4 * 0.5 * 0.01 } (ball);
        down: Offset { by: transpose(free.orientation_b) * [0.0, 0.0, -0.1] } (ball, low);
        turn: Turn { by: transpose(free.orientation_b) } (low, world);
        Sf grip[3] { flow: [-3.0 * free.position.y, 3.0 * free.position.x, 0.0] } -> world[3..6];
        1 upright coordinate, initial_flow: 2.0;
        world[2] -> upright;
    }

    /// A quaternion tells how the ball is turned.
    #[derivative]
    pub(crate) model Turntable {
        causality componentwise;
        ball: Rolling ();
    }

    /// A matrix does.
    #[derivative]
    pub(crate) model TurntableOfMatrix {
        causality componentwise;
        ball: Rolling { orientation: matrix } ();
    }
}

/// Where the ball is after 3 s.
fn exact() -> [f64; 2] {
    let rate = 2.0 / 7.0 * 3.0;
    let (sine, cosine) = f64::sin_cos(rate * 3.0);
    [
        0.5 + (0.2 * sine + 0.3 * (cosine - 1.0)) / rate,
        (0.3 * sine - 0.2 * (cosine - 1.0)) / rate,
    ]
}

/// By how much the ball is beside that, and after how many steps.
fn rolled(method: impl Estimating, tolerance: f64) -> (f64, u64) {
    let model = Turntable::<f64>::new(TurntableParameters::default()).unwrap();
    let start = model.initial_state();
    let mut last = start;
    let statistics = Adaptive::new(method, tolerance, tolerance)
        .integrate(&model, &(), 0.0, 3.0, start, |step| last = *step.state())
        .unwrap();
    let [x, y] = exact();
    (f64::hypot(last[0] - x, last[1] - y), statistics.steps)
}

/// The Jacobian at rotations is not that beside them, where the stages of a step are.
#[test]
fn steps_that_linearise_once_keep_their_order_where_bodies_turn() {
    let (error, steps) = rolled(Rodas5P, 1e-10);
    assert!(error < 2e-9 && steps < 1000, "{error:e} {steps}");
    let (error, steps) = rolled(Rodas4, 1e-8);
    assert!(error < 3e-7 && steps < 800, "{error:e} {steps}");
}

/// The same of matrices, at the ends of steps of constant length.
#[test]
fn steps_of_constant_length_have_their_order_where_matrices_turn() {
    fn error(method: impl Method, steps: f64) -> f64 {
        let parameters = TurntableOfMatrixParameters::default();
        let model = TurntableOfMatrix::<f64>::new(parameters).unwrap();
        let start = model.initial_state();
        let mut last = start;
        Fixed::new(method, 3.0 / steps)
            .integrate(&model, &(), 0.0, 3.0, start, |step| last = *step.state())
            .unwrap();
        let [x, y] = exact();
        f64::hypot(last[0] - x, last[1] - y)
    }
    fn order(method: impl Method, steps: f64) -> f64 {
        (error(method, steps) / error(method, 2.0 * steps)).log2()
    }
    let orders = [
        order(Ros2, 600.0),
        order(Rodas4, 200.0),
        order(Rodas5P, 200.0),
    ];
    assert!(
        orders[0] > 1.8 && orders[1] > 3.7 && orders[2] > 4.6,
        "{orders:?}"
    );
}
