//! Mechanisms whose bodies depend on each other, against Lagrange's equations.

use mbg_runtime::{Adaptive, Constant, Dop853, Dual, Integrator, System, mbg};
use nalgebra::SVector;

use super::audit::{Probe, audit, near};
use super::energy::imbalance;
use crate::references::{cart, crane, double_pendulum};

const EXACT: f64 = 1e-11;

mbg! {
    include "examples/gallery/rods.mbg";

    /// A trolley under a force, and a load on a rigid cable.
    #[derivative]
    pub(crate) model Crane {
        param trolley: kg = 3.0;
        param load: kg = 1.2;
        param cable: m = 2.0;
        input force: N;
        gravity [0.0, -9.81];
        1 speed coordinate {
            I carriage { inertia: trolley }
            Se push { effort: force }
        }
        1 swing coordinate { R pivot { resistance: 0.0 } }
        1 hook[2] {
            I body { inertia: load }
            Se weight { effort: load * gravity }
        }
        integral place: m = speed.f;
        integral angle: rad = swing.f, initial: 0.8;
        0 sum[2];
        speed -> sum.x;
        swing -> MTF lever { flow: [[cable * cos(angle)], [cable * sin(angle)]] } -> sum;
        sum -> hook;
        output coordinates[2] = [place, angle];
        output rates[2] = [speed.f, swing.f];
        output momentum[2]: N*s = body.p;
    }

    /// Two rods on a fixed pin.
    #[derivative]
    pub(crate) model DoublePendulum {
        gravity [0.0, -9.81];
        1 ground[3] { Sf fixed { flow: 0.0 } }
        pendulum: Rods { count: 2, bend: 0.1 } (ground);
    }
}

/// A cart with rods, and the audit of it.
macro_rules! carts {
    ($($model:ident, $parameters:ident, $test:ident, $rods:tt;)*) => {$(
        mbg! {
            /// Rods that hang one below the other from a cart under a force.
            #[derivative]
            pub(crate) model $model {
                param mass: kg = 2.0;
                input force: N;
                gravity [0.0, -9.81];
                let rods = $rods;
                1 ground[3] { Sf fixed { flow: 0.0 } }
                slide: PlanarPrismatic { force: force } (ground, ends[0].end);
                body: PlanarBody { mass: mass, inertia: 1.0 } (ends[0].end);
                ends: for k in 0..rods + 1 { 1 end[3]; }
                links: for k in 0..rods {
                    1 top[3];
                    1 middle[3];
                    hinge: PlanarRevolute {} (ends[k].end, top);
                    half: PlanarOffset { x: 0.5 } (top, middle);
                    body: PlanarBody { mass: 1.0, inertia: 1.0 / 12.0 } (middle);
                    whole: PlanarOffset { x: 1.0 } (top, ends[k+1].end);
                    output angle: rad = hinge.angle_b;
                    output rate: rad/s = hinge.rate.f;
                }
                output travel: m = slide.travel;
                output speed: m/s = slide.rate.f;
            }
        }

        #[test]
        fn $test() {
            let plain = $model::<f64>::new($parameters::default()).unwrap();
            let dual = $model::new($parameters::default()).unwrap();
            audit(&plain, &dual, |probe: &Probe<_, { 2 * $rods + 2 }, 1>| {
                meets_the_cart(probe.outputs().as_slice(), probe.input[0]);
            });
            let push = Constant(SVector::from([4.0]));
            let imbalance = imbalance(&plain, &push, 1e-4, 10_000);
            assert!(imbalance < 1e-11, "{imbalance:e}");
        }
    )*};
}

carts! {
    Cart1, Cart1Parameters, one_rod_swings_on_a_cart, 1;
    Cart2, Cart2Parameters, two_rods_swing_on_a_cart, 2;
    Cart3, Cart3Parameters, three_rods_swing_on_a_cart, 3;
    Cart4, Cart4Parameters, four_rods_swing_on_a_cart, 4;
    Cart5, Cart5Parameters, five_rods_swing_on_a_cart, 5;
}

/// Angles against the horizontal with the rates of the hinges, rod by rod, then travel and speed of the cart.
fn meets_the_cart(outputs: &[Dual<f64>], force: f64) {
    let (rods, cart) = outputs.split_at(outputs.len() - 2);
    let quarter = std::f64::consts::FRAC_PI_2;
    let (mut angles, mut rates, mut found) = (Vec::new(), Vec::new(), vec![cart[1].slope]);
    let (mut rate, mut change) = (0.0, 0.0);
    for rod in rods.chunks(2) {
        rate += rod[1].value;
        change += rod[1].slope;
        near(rod[0].slope, rate, EXACT);
        angles.push(rod[0].value + quarter);
        rates.push(rate);
        found.push(change);
    }
    near(cart[0].slope, cart[1].value, EXACT);
    let expected = cart::Cart::uniform(2.0, angles.len()).accelerations(&angles, &rates, force);
    let size = expected.iter().fold(1.0_f64, |size, a| size.max(a.abs()));
    for (found, expected) in found.iter().zip(&expected) {
        near(found / size, expected / size, EXACT);
    }
}

#[test]
fn a_crane_moves_as_lagrange_says() {
    let reference = crane::Crane {
        trolley: 3.0,
        load: 1.2,
        cable: 2.0,
        gravity: 9.81,
    };
    let plain = Crane::<f64>::new(CraneParameters::default()).unwrap();
    let dual = Crane::new(CraneParameters::default()).unwrap();
    audit(&plain, &dual, |probe: &Probe<_, 4, 1>| {
        let outputs = probe.outputs();
        let x = [0, 1, 2, 3].map(|row| outputs[row].value);
        let expected = reference.derivative(&x, probe.input[0]);
        for row in 0..4 {
            near(outputs[row].slope, expected[row], EXACT);
        }
        let (sine, cosine) = x[1].sin_cos();
        near(outputs[4].value, 1.2 * (x[2] + 2.0 * cosine * x[3]), EXACT);
        near(outputs[5].value, 1.2 * 2.0 * sine * x[3], EXACT);
    });
    let push = Constant(SVector::from([4.0]));
    let imbalance = imbalance(&plain, &push, 1e-3, 3000);
    assert!(imbalance < 1e-11, "{imbalance:e}");
}

#[test]
fn a_double_pendulum_meets_the_published_numbers() {
    let model = DoublePendulum::new(DoublePendulumParameters::default()).unwrap();
    let quarter = std::f64::consts::FRAC_PI_2;
    let times: Vec<f64> = double_pendulum::REFERENCE[..5]
        .iter()
        .map(|it| it.0)
        .collect();
    let mut reference = double_pendulum::REFERENCE.iter();
    Adaptive::new(Dop853, 1e-13, 1e-14)
        .sample(&model, &(), 0.0, model.initial_state(), &times, |t, x| {
            let y = model.output(t, x, &SVector::zeros(), &mut ());
            let found = [y[0] + quarter, y[1] + quarter, y[2], y[3]];
            for (found, expected) in found.into_iter().zip(reference.next().unwrap().1) {
                near(found, expected, 1e-9);
            }
        })
        .unwrap();
    let dual = DoublePendulum::new(DoublePendulumParameters::default()).unwrap();
    audit(&model, &dual, |probe: &Probe<_, 4, 0>| {
        let y = probe.outputs();
        let x = [
            y[0].value + quarter,
            y[1].value + quarter,
            y[2].value,
            y[3].value,
        ];
        let expected = double_pendulum::derivative(&x);
        for row in 0..4 {
            near(y[row].slope, expected[row], EXACT);
        }
    });
}
