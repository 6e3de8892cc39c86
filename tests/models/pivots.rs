//! What is divided by where frames stand at right angles or at rest: no rounding error, and nothing that vanishes there.

use mbg_runtime::{Adaptive, Constant, Convertible, Dop853, Integrator, System, Trouble, mbg};
use nalgebra::SVector;

use crate::references::errors::apart;

mbg! {
    /// A body on two slides and a hinge, held at a point 1 m from its centre: a pendulum that stands on its head.
    #[derivative]
    pub(crate) model Held {
        causality componentwise;
        gravity [0.0, -9.81];
        1 ground[3]; 1 frame[3]; 1 tip[3]; 1 slide[3]; 1 lift[3];
        Sf fixed[3] { flow: 0.0 } -> ground;
        x: PlanarPrismatic { initial: 0.5 } (ground, slide);
        y: PlanarPrismatic { direction: 1.5707963267948966, initial: 0.8660254037844386 } (slide, lift);
        turn: PlanarRevolute { initial: 0.5235987755982988 } (lift, frame);
        body: PlanarBody { mass: 2.0, inertia: 0.1 } (frame);
        arm: PlanarOffset { y: -1.0 } (frame, tip);
        Sf still[2] { flow: 0.0 } -> tip[1..3];
        output angle: rad = turn.angle;
        output rate: rad/s = turn.rate.f;
    }

    /// Arms on hinges in a row, and a load on a ball joint.
    #[derivative]
    pub(crate) model Crane {
        causality componentwise;
        gravity [0.0, 0.0, -9.81];
        param mass: kg = 1.0;
        let inertia = mass * diag(1.0, 2.0, 2.5);
        frames: for k in 0..4 { 1 end[6]; }
        1 load[6];
        Sf fixed[6] { flow: 0.0 } -> frames[0].end;
        arms: for k in 0..3 {
            hinge: Revolute { axis: k, initial: 0.3, initial_rate: 0.5, offset: [0.5, 0.2, 1.0], tilt: rot_x(0.3) }
                (frames[k].end, frames[k + 1].end);
            body: Body { mass: mass, inertia: inertia, centre: [0.1, 0.2, 0.3] } (frames[k + 1].end);
        }
        ball: Spherical { orientation: quaternion, initial: [0.1, 0.2, 0.3], offset: [0.5, 0.2, 1.0] } (frames[3].end, load);
        hung: Body { mass: mass, inertia: inertia, centre: [0.1, 0.2, 0.3] } (load);
    }

    /// A body that is free, held at a point, and turned about no axis at the start.
    #[derivative]
    pub(crate) model Top {
        causality componentwise;
        1 ground[6]; 1 frame[6]; 1 tip[6];
        Sf fixed[6] { flow: 0.0 } -> ground;
        free: Free { } (ground, frame);
        body: Body { mass: 2.0, inertia: 0.1 } (frame);
        arm: Offset { by: [0.0, 0.0, -0.3] } (frame, tip);
        Sf still[3] { flow: 0.0 } -> tip[3..6];
        output rates[3] = [body.spin.f.x, body.spin.f.y, body.spin.f.z];
    }

    /// Wires in a row, which conduct the better the warmer they are, and leak; at the end of the last is a store.
    pub(crate) model Leaking {
        param conductance = 1e-3;
        let count = 8;
        1 heating { C heat { compliance: 1.0, initial: 1.0 } Sf flame { flow: 1.0 } }
        0 source;
        Se supply { effort: 10.0 } -> source;
        row: for k in 0..count {
            0 node; 1 wire;
            if k == 0 { source -> wire; } else { row[k-1].node -> wire; }
            wire -> R metal { conductance: conductance * (1.0 + 0.1 * heat.q) };
            wire -> node;
            node -> R leak { conductance: 1e-9 };
        }
        1 last;
        row[count-1].node -> last;
        last -> R end { resistance: 1e6 };
        last -> C store { compliance: 1e-9, initial: 1e-9 };
        output potential = row[count-1].node.e;
    }

    /// A hull that floats with a pendulum under it, of one kilogram or much less.
    #[derivative]
    pub(crate) model Swinging {
        causality componentwise;
        param size = 1.0;
        1 ground[6]; 1 hull[6]; 1 rod[6];
        Sf fixed[6] { flow: 0.0 } -> ground;
        flight: Free { orientation: quaternion } (ground, hull);
        body: Body { mass: 1.2 * size, inertia: size * diag(0.01, 0.012, 0.02) } (hull);
        ball: Spherical { orientation: quaternion, offset: [0.0, 0.0, -0.1] } (hull, rod);
        load: Body { mass: 0.4 * size, inertia: size * diag(1e-3, 1e-3, 5e-4), centre: [0.0, 0.0, -0.5] } (rod);
    }
}

/// A crank and a rod on a block that slides along an axis: a ring of joints without a cut.
macro_rules! slider_crank {
    ($name:ident, { $($parameter:tt)* }, $direction:expr, $start:literal) => {
        mbg! {
            /// The direction is an angle to the horizontal.
            #[derivative]
            pub(crate) model $name {
                causality componentwise;
                gravity [0.0, -9.81];
                $($parameter)*
                1 ground[3]; 1 crank[3]; 1 pin[3]; 1 rod[3]; 1 end[3]; 1 block[3];
                Sf fixed[3] { flow: 0.0 } -> ground;
                h1: PlanarRevolute { initial: 0.9 } (ground, crank);
                o1: PlanarOffset { x: 1.0 } (crank, pin);
                m1: PlanarBody { mass: 1.0, inertia: 0.3 } (pin);
                slide: PlanarPrismatic { direction: $direction, initial: $start } (ground, block);
                m3: PlanarPointMass { mass: 0.5 } (block);
                h3: PlanarRevolute { initial: 0.7 } (block, rod);
                o3: PlanarOffset { y: -2.0 } (rod, end);
                m2: PlanarBody { mass: 1.0, inertia: 0.3 } (rod);
                pin[1..3] -> end[1..3];
                output rates[3] = [h1.rate.f, h3.rate.f, slide.rate.f];
            }
        }
    };
}
slider_crank!(Right, {}, 0.0, -2.0);
slider_crank!(Left, {}, 3.141592653589793, 2.0);
slider_crank!(Near, {}, 3.1415926, 2.0);
slider_crank!(Across, { param direction: rad = 3.0; }, direction, 2.0);

/// The outputs at some times, started as the model says.
fn outputs<S, const N: usize, const M: usize, const P: usize>(
    model: &S,
    times: &[f64],
) -> Vec<SVector<f64, P>>
where
    S: System<f64, N, M, P>,
{
    let (still, mut found) = (SVector::zeros(), Vec::new());
    Adaptive::new(Dop853, 1e-12, 1e-14)
        .sample(
            model,
            &Constant(still),
            0.0,
            model.initial_state(),
            times,
            |t, x| {
                found.push(model.output(t, x, &still, &mut Default::default()));
            },
        )
        .unwrap();
    found
}

#[test]
fn what_slides_at_right_angles_swings_as_a_pendulum() {
    let model = Held::new(HeldParameters::default()).unwrap();
    for found in outputs(&model, &[0.1, 0.3, 0.5]) {
        let [angle, rate] = found.into();
        let fallen = 0.5235987755982988_f64.cos() - f64::cos(angle);
        let expected = (2.0 * 2.0 * 9.81 * fallen / 2.1).sqrt();
        assert!((rate.abs() - expected).abs() < 1e-9, "{rate} {expected}");
    }
}

/// Near the other way its sine is 5e-8, which no other entry is divided by.
#[test]
fn a_slide_may_point_either_way() {
    let times = [0.1, 0.2, 0.3];
    let right = outputs(&Right::new(RightParameters::default()).unwrap(), &times);
    let left = outputs(&Left::new(LeftParameters::default()).unwrap(), &times);
    let near = outputs(&Near::new(NearParameters::default()).unwrap(), &times);
    for ((right, left), near) in right.into_iter().zip(left).zip(near) {
        let expected = [right[0], right[1], -right[2]];
        assert!(right.amax() > 0.05, "{right}");
        for (found, tolerance) in [(left, 1e-8), (near, 1e-6)] {
            let error = apart(found.as_slice(), &expected);
            assert!(error < tolerance, "{error:e} {found}");
        }
    }
}

#[test]
fn a_parameter_that_is_divided_by_is_checked() {
    let across = |direction| Across::<f64>::new(AcrossParameters { direction });
    across(3.0).unwrap();
    let told = across(0.0).map(|_| ()).unwrap_err().to_string();
    assert!(told.contains("sin(direction)"), "{told}");
}

#[test]
fn a_body_that_is_held_at_a_point_starts_where_no_angle_is_turned() {
    let model = Top::new(TopParameters::default()).unwrap();
    let found = outputs(&model, &[0.5]);
    assert!(found[0].iter().all(|rate| rate.abs() < 1e-12), "{found:?}");
    let conditioning = model.conditioning(0.0, &model.initial_state(), &SVector::zeros());
    assert!(
        conditioning.iter().all(|it| it.is_finite()),
        "{conditioning:?}"
    );
}

/// Inertias make determinants as small as the machine, which is not singular for that.
#[test]
fn a_small_machine_is_not_singular() {
    let first = Swinging::new(SwingingParameters { size: 1.0 }).unwrap();
    let x = first.initial_state();
    let none = SVector::zeros();
    let expected = first.conditioning(0.0, &x, &none);
    for size in [1e-9, 1e-3, 1.0, 1e6] {
        let model = Swinging::new(SwingingParameters { size }).unwrap();
        assert_eq!(model.trouble(0.0, &x, &none, &()), None);
        assert!(apart(&model.conditioning(0.0, &x, &none), &expected) < 1e-12);
        let single = model.converted(|it| it as f32);
        if size > 1e-4 && size < 1e4 {
            assert_eq!(
                single.trouble(
                    0.0,
                    &x.map(|it| it as f32),
                    &none.map(|it: f64| it as f32),
                    &()
                ),
                None
            );
        }
    }
}

/// Six inertias are beyond single precision when they are multiplied.
#[test]
fn a_large_machine_is_not_singular_in_single_precision() {
    let usual = Crane::<f64>::new(CraneParameters::default()).unwrap();
    let expected = usual.derivative(0.0, &usual.initial_state(), &SVector::zeros(), &mut ());
    for mass in [1e-9_f32, 1e-3, 1e3, 1e6, 1e9] {
        let model = Crane::new(CraneParameters { mass }).unwrap();
        let (x, none) = (model.initial_state(), SVector::zeros());
        assert_eq!(model.trouble(0.0, &x, &none, &()), None, "{mass:e}");
        let found = model.derivative(0.0, &x, &none, &mut ()).map(f64::from);
        assert!(
            apart(&found.data.0[0], &expected.data.0[0]) < 1e-4,
            "{mass:e}"
        );
    }
}

/// What a small constant is divided into may be much larger: nothing bounds what stands beside it.
#[test]
fn small_leaks_of_wires_are_not_divided_by() {
    for conductance in [1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6] {
        let model = Leaking::<f64>::new(LeakingParameters { conductance }).unwrap();
        let x = model.initial_state();
        // From the source on, each node is the half of a voltage and a resistance.
        let (mut source, mut resistance) = (10.0, 0.0);
        for _ in 0..8 {
            resistance += 1.0 / (1.1 * conductance);
            source /= 1.0 + 1e-9 * resistance;
            resistance /= 1.0 + 1e-9 * resistance;
        }
        let expected = (source * 1e6 + x[1] * 1e9 * resistance) / (1e6 + resistance);
        let none = SVector::zeros();
        let found = model.output(0.0, &x, &none, &mut ())[0];
        assert_eq!(model.trouble(0.0, &x, &none, &()), None);
        assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
    }
    let model = Leaking::<f32>::new(LeakingParameters::default()).unwrap();
    let found = model.output(0.0, &model.initial_state(), &SVector::zeros(), &mut ())[0];
    assert!((found / 9.934_694 - 1.0).abs() < 1e-5, "{found}");
}

mbg! {
    /// Two blades with feather, flap and lag hinges on a hull that flies.
    #[derivative]
    pub(crate) model Hubbed {
        causality componentwise;
        1 ground[6]; 1 hull[6];
        Sf fixed[6] { flow: 0.0 } -> ground;
        free: Free { orientation: quaternion } (ground, hull);
        body: Body { mass: 20.0, inertia: 10.0 } (hull);
        rotor: Rotor {
            count: 2, speed: 30.0, offset: 0.3, mass: 2.0, inertia: diag(0.3, 3.0, 3.1), centre: [1.0, 0.0, 0.0]
        } (hull);
    }
}

/// The determinants are for the same unknowns, and each tells the states that it reads.
#[test]
fn what_is_singular_is_told_by_its_states() {
    let model = Hubbed::<f64>::new(HubbedParameters::default()).unwrap();
    let meta = Hubbed::<f64>::META;
    let mut x = model.initial_state();
    // Flapped to where the lag hinge and the feathering hinge are in line.
    let flap = "rotor.blades[1].blade.about_y.spring.q";
    x[meta.state(flap).unwrap()] = core::f64::consts::FRAC_PI_2;
    let Some(Trouble::Singular { name, .. }) = model.trouble(0.0, &x, &SVector::zeros(), &())
    else {
        panic!("it is singular")
    };
    let (_, states) = name.split_once(", in ").unwrap();
    let lag = "rotor.blades[1].blade.about_z.spring.q";
    assert_eq!(states, [flap, lag].join(", "));
    let numbered = meta
        .conditioning
        .iter()
        .filter(|it| it.contains(", number "));
    assert_eq!(numbered.count(), 0, "{:?}", meta.conditioning);
}
