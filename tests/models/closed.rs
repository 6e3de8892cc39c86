//! Mechanisms whose loops are closed by multipliers.

use mbg_runtime::{
    Adaptive, Constant, Dop853, Fixed, Gauss6, Integrator, Method, Real, Rk4, System, Trouble, mbg,
};
use nalgebra::SVector;

use crate::references::errors::{apart, larger};

mbg! {
    /// Crank, coupler and rocker between two fixed hinges 1 m apart.
    #[derivative]
    pub(crate) model FourBar {
        causality componentwise;
        gravity [0.0, -9.81];
        param damping: N*m*s/rad = 0.0;

        1 base[3]; 1 crank_tip[3]; 1 coupler_tip[3]; 1 rocker_tip[3];
        Sf fixed[3] { flow: 0.0 } -> base;
        crank: PlanarLink {
            mass: 1.0, inertia: 0.0075, centre: [0.15, 0.0], end: [0.3, 0.0], initial: 1.0, damping: damping
        } (base, crank_tip);
        coupler: PlanarLink {
            mass: 2.0, inertia: 0.135, centre: [0.45, 0.0], end: [0.9, 0.0], damping: damping
        } (crank_tip, coupler_tip);
        rocker: PlanarLink {
            mass: 1.5, inertia: 0.06125, centre: [0.35, 0.0], end: [0.7, 0.0], initial: 1.2, damping: damping,
            position_a: [1.0, 0.0]
        } (base, rocker_tip);

        let open = coupler.position_b - rocker.position_b;
        close coupler_tip[1..3] -> rocker_tip[1..3] by multipliers, displacement: open;
        output gap[2]: m = open;
        output potential: J = 9.81 * (
            crank.position_centre.y + 2.0 * coupler.position_centre.y + 1.5 * rocker.position_centre.y
        );
    }

    /// A four-bar whose crank a motor turns at a given speed: at the start all rates that are states are zero.
    #[derivative]
    pub(crate) model Driven {
        causality componentwise;
        param speed: rad/s = 10.0;
        param start: rad = 1.0;
        1 ground[3]; 1 crank[3]; 1 crank_tip[3]; 1 coupler[3]; 1 coupler_middle[3]; 1 coupler_tip[3];
        1 post[3]; 1 rocker[3]; 1 rocker_middle[3]; 1 rocker_tip[3];
        Sf fixed[3] { flow: 0.0 } -> ground;
        first: PlanarRevolute { initial: start } (ground, crank);
        Sf motor { flow: speed } -> first.rate;
        along_crank: PlanarOffset { x: 1.0 } (crank, crank_tip);
        second: PlanarRevolute { initial: -0.6 } (crank_tip, coupler);
        half_coupler: PlanarOffset { x: 1.5 } (coupler, coupler_middle);
        coupler_body: PlanarBody { mass: 0.5, inertia: 0.01 } (coupler_middle);
        along_coupler: PlanarOffset { x: 3.0 } (coupler, coupler_tip);
        base: PlanarOffset { x: 3.0 } (ground, post);
        third: PlanarRevolute { initial: 1.2 } (post, rocker);
        half_rocker: PlanarOffset { x: 1.25 } (rocker, rocker_middle);
        rocker_body: PlanarBody { mass: 0.5, inertia: 0.01 } (rocker_middle);
        along_rocker: PlanarOffset { x: 2.5 } (rocker, rocker_tip);
        cut: PlanarCut (coupler_tip, rocker_tip);
        output angles[2]: rad = [first.angle, third.angle];
    }

    /// The first four-bar, of joints in space.
    #[derivative]
    pub(crate) model InSpace {
        causality componentwise;
        gravity [0.0, -9.81, 0.0];
        1 base[6]; 1 crank[6]; 1 crank_tip[6]; 1 coupler[6]; 1 coupler_tip[6]; 1 stand[6]; 1 rocker[6]; 1 rocker_tip[6];
        Sf fixed[6] { flow: 0.0 } -> base;
        one: Revolute { axis: 2, initial: 1.0 } (base, crank);
        short: Body { mass: 1.0, inertia: diag(0.001, 0.007, 0.0075), centre: [0.15, 0.0, 0.0] } (crank);
        first: Offset { by: [0.3, 0.0, 0.0] } (crank, crank_tip);
        two: Revolute { axis: 2 } (crank_tip, coupler);
        long: Body { mass: 2.0, inertia: diag(0.001, 0.135, 0.135), centre: [0.45, 0.0, 0.0] } (coupler);
        second: Offset { by: [0.9, 0.0, 0.0] } (coupler, coupler_tip);
        apart: Offset { by: [1.0, 0.0, 0.0] } (base, stand);
        three: Revolute { axis: 2, initial: 1.2 } (stand, rocker);
        heavy: Body { mass: 1.5, inertia: diag(0.001, 0.06125, 0.06125), centre: [0.35, 0.0, 0.0] } (rocker);
        third: Offset { by: [0.7, 0.0, 0.0] } (rocker, rocker_tip);
        cut: Cut { joint: revolute } (coupler_tip, rocker_tip);
        output angles[3] = [one.angle, two.angle, three.angle];
    }

    /// A four-bar of any length, whose masses go with the cube of it.
    #[derivative]
    pub(crate) model Scaled {
        causality componentwise;
        param length: m = 1.0;
        param apart = 3.0;
        let mass = 2000.0 * length * length * length;
        let inertia = 300.0 * length * length * length * length * length;
        1 ground[3]; 1 crank[3]; 1 crank_tip[3]; 1 coupler[3]; 1 coupler_tip[3]; 1 stand[3]; 1 rocker[3]; 1 rocker_tip[3];
        Sf fixed[3] { flow: 0.0 } -> ground;
        shift: PlanarOffset { x: apart * length } (ground, stand);
        one: PlanarRevolute { initial: 1.2, initial_rate: 0.5 } (ground, crank);
        first: PlanarOffset { x: length } (crank, crank_tip);
        light: PlanarBody { mass: mass, inertia: inertia } (crank);
        two: PlanarRevolute { initial: -0.8 } (crank_tip, coupler);
        second: PlanarOffset { x: 3.0 * length } (coupler, coupler_tip);
        long: PlanarBody { mass: mass, inertia: 10.0 * inertia } (coupler);
        three: PlanarRevolute { initial: 1.6 } (stand, rocker);
        third: PlanarOffset { x: 2.0 * length } (rocker, rocker_tip);
        heavy: PlanarBody { mass: mass, inertia: inertia } (rocker);
        pin: PlanarCut { joint: revolute } (coupler_tip, rocker_tip);
        output gap[2]: m = pin.gap;
        output angle: rad = one.angle;
    }

    /// Two bodies that float, joined at a point beside their centres.
    pub(crate) model Docked {
        causality componentwise;
        1 space[6]; 1 one[6]; 1 other[6]; 1 tip[6];
        Sf still[6] { flow: 0.0 } -> space;
        first: Free { orientation: quaternion, initial_rate: [0.3, -0.2, 0.5] } (space, one);
        hull: Body { mass: 2.0, inertia: diag(1.0, 1.5, 2.0) } (one);
        second: Free { orientation: quaternion, initial: [0.4, 0.2, -0.3] } (space, other);
        cargo: Body { mass: 3.0, inertia: diag(0.5, 0.7, 0.9) } (other);
        arm: Offset { by: [0.5, 0.0, 0.0] } (one, tip);
        joint: Cut { joint: spherical } (tip, other);
    }

    /// An arm that holds a body, which floats: where both are apart, the rates of each depend on each other.
    #[derivative]
    pub(crate) model Holding {
        causality componentwise;
        gravity [0.0, 0.0, -9.81];
        1 ground[6]; 1 upper[6]; 1 lower[6]; 1 hand[6]; 1 stone[6];
        Sf fixed[6] { flow: 0.0 } -> ground;
        shoulder: Spherical { orientation: quaternion, initial_rate: [0.3, -0.2, 0.5] } (ground, upper);
        upper_arm: Body {
            mass: 1.0, inertia: diag(0.1, 0.12, 0.02), centre: [0.0, 0.0, 0.2], gravity_at: shoulder.gravity_b
        } (upper);
        elbow: Universal {
            offset: [0.0, 0.0, 0.5], initial: [0.0, 0.4],
            gravity_a: shoulder.gravity_b, orientation_a: shoulder.orientation_b, position_a: shoulder.position_b
        } (upper, lower);
        lower_arm: Body {
            mass: 0.7, inertia: diag(0.06, 0.05, 0.01), centre: [0.0, 0.0, 0.2], gravity_at: elbow.gravity_b
        } (lower);
        wrist: Revolute {
            axis: 0, offset: [0.0, 0.0, 0.4],
            gravity_a: elbow.gravity_b, orientation_a: elbow.orientation_b, position_a: elbow.position_b
        } (lower, hand);
        palm: Body {
            mass: 0.3, inertia: diag(0.01, 0.02, 0.015), centre: [0.0, 0.0, 0.1], gravity_at: wrist.gravity_b
        } (hand);
        flight: Free {
            orientation: quaternion, tilt: rot_z(-0.7), initial_position: [0.11914, 0.10035, 0.86842]
        } (ground, stone);
        rock: Body { mass: 0.8, inertia: diag(0.1, 0.2, 0.25), gravity_at: flight.gravity_b } (stone);
        moss: Body {
            mass: 0.6, inertia: diag(0.1, 0.2, 0.25), centre: [0.3, 0.0, 0.2], gravity_at: flight.gravity_b
        } (stone);
        grip: Cut {
            orientation_a: wrist.orientation_b, position_a: wrist.position_b,
            orientation_b: flight.orientation_b, position_b: flight.position_b
        } (hand, stone);
    }

    /// Two crossed bars twice on each other, and a platform that slides on the upper ones. The cut holds its angle, too.
    #[derivative]
    pub(crate) model Locked {
        causality componentwise;
        let start = 0.6;
        1 ground[3]; 1 foot[3]; 1 first[3]; 1 first_pin[3]; 1 first_end[3]; 1 second[3]; 1 second_pin[3]; 1 second_end[3];
        1 third[3]; 1 third_pin[3]; 1 third_end[3]; 1 fourth[3]; 1 fourth_pin[3]; 1 fourth_end[3]; 1 platform[3];
        Sf fixed[3] { flow: 0.0 } -> ground;
        hinge: PlanarRevolute { initial: start } (ground, first);
        half: PlanarOffset { x: 0.5 } (first, first_pin);
        whole: PlanarOffset { x: 1.0 } (first, first_end);
        slide: PlanarPrismatic { initial: 1.0 * cos(start) } (ground, foot);
        other_hinge: PlanarRevolute { initial: -start } (foot, second);
        other_half: PlanarOffset { x: -0.5 } (second, second_pin);
        other_whole: PlanarOffset { x: -1.0 } (second, second_end);
        upper: PlanarRevolute { initial: 2.0 * start } (second_end, third);
        upper_half: PlanarOffset { x: 0.5 } (third, third_pin);
        upper_whole: PlanarOffset { x: 1.0 } (third, third_end);
        other_upper: PlanarRevolute { initial: -2.0 * start } (first_end, fourth);
        other_upper_half: PlanarOffset { x: -0.5 } (fourth, fourth_pin);
        other_upper_whole: PlanarOffset { x: -1.0 } (fourth, fourth_end);
        top: PlanarRevolute { initial: start } (fourth_end, platform);
        one: PlanarBody { mass: 3.0, inertia: 0.25 } (first_pin);
        two: PlanarBody { mass: 3.0, inertia: 0.25 } (second_pin);
        three: PlanarBody { mass: 3.0, inertia: 0.25 } (third_pin);
        four: PlanarBody { mass: 3.0, inertia: 0.25 } (fourth_pin);
        roller: PlanarPointMass { mass: 1.0 } (foot);
        load: PlanarBody { mass: 22.0, inertia: 0.3 } (platform);
        lower_pin: PlanarCut (first_pin, second_pin);
        upper_pin: PlanarCut (third_pin, fourth_pin);
        rail: PlanarCut { joint: prismatic } (platform, third_end);
    }

    /// A slider-crank whose guide holds an angle beside a length.
    #[derivative]
    pub(crate) model Slider {
        causality componentwise;
        param length: m = 1.0;
        param mass: kg = 1.0;
        gravity [0.0, -9.81];
        let inertia = mass * length * length / 12.0;
        1 ground[3]; 1 crank[3]; 1 pin[3]; 1 rod[3]; 1 end[3]; 1 slide[3];
        Sf fixed[3] { flow: 0.0 } -> ground;
        first: PlanarRevolute { initial: 0.7, initial_rate: 3.0 } (ground, crank);
        cranked: PlanarBody { mass: mass, inertia: inertia } (crank);
        arm: PlanarOffset { x: length } (crank, pin);
        second: PlanarRevolute { initial: -1.0, initial_rate: 1.0 } (pin, rod);
        pushed: PlanarBody { mass: mass, inertia: inertia } (rod);
        long: PlanarOffset { x: 2.0 * length } (rod, end);
        third: PlanarRevolute { initial: 0.3 } (end, slide);
        slid: PlanarBody { mass: mass, inertia: inertia } (slide);
        guide: PlanarCut { joint: prismatic } (ground, slide);
    }

    /// A slider-crank with a rod without mass, in space on a base that is turned, so that velocities along the rod are sums.
    #[derivative]
    pub(crate) model DeadCentre {
        causality componentwise;
        1 world[6]; 1 ground[6]; 1 crank[6]; 1 pin[6]; 1 piston[6];
        Sf fixed[6] { flow: 0.0 } -> world;
        base: Turn { by: rot_x(0.3) * rot_y(0.2) } (world, ground);
        main: Revolute { axis: 2 } (ground, crank);
        wheel: Body { mass: 1.0, inertia: 0.1 } (crank);
        throw: Offset { by: [0.05, 0.0, 0.0] } (crank, pin);
        slide: Prismatic { axis: 0, initial: 0.25 } (ground, piston);
        load: Body { mass: 0.1, inertia: 0.001 } (piston);
        rod: Rod { length: 0.2 } (pin, piston);
    }

    /// A slider-crank on a spring, whose rod has its momentum for a state beside the rates of crank and slide.
    #[derivative]
    pub(crate) model Pressed {
        param length: m = 1.0;
        param mass: kg = 1.0;
        let stiffness = 100.0 * mass;
        let inertia = mass * length * length;
        1 ground[3]; 1 crank[3]; 1 pin[3]; 1 rod[3]; 1 end[3]; 1 slide[3];
        Sf fixed[3] { flow: 0.0 } -> ground;
        first: PlanarRevolute { initial: 0.5, torque: 20.0 * inertia } (ground, crank);
        arm: PlanarOffset { x: length } (crank, pin);
        wheel: PlanarBody { mass: mass, inertia: 2.0 * inertia } (crank);
        second: PlanarRevolute { initial: -0.660_497 } (pin, rod);
        long: PlanarOffset { x: 3.0 * length } (rod, end);
        bar: PlanarBody { mass: 2.0 * mass, inertia: 4.0 * inertia } (rod);
        guide: PlanarPrismatic { initial: 3.839_027 * length, stiffness: stiffness, rest: 3.839_027 * length } (ground, slide);
        piston: PlanarPointMass { mass: 3.0 * mass } (slide);
        pin_joint: PlanarCut { joint: revolute } (end, slide);
        output gap[2]: m = pin_joint.gap;
        output angle: rad = first.angle;
    }
}

/// The state with the crank where the model puts it, and everything else where it must be.
fn start(model: &FourBar) -> SVector<f64, 6> {
    let crank = FourBar::<f64>::META.state("crank.hinge.angle").unwrap();
    let guess = model.initial_state();
    let start = model
        .close(0.0, guess, &SVector::from([]), &[crank])
        .unwrap();
    assert_eq!(start[crank], guess[crank]);
    start
}

/// A name stands for all behind it, and the last one counts.
#[test]
fn sizes_go_by_names() {
    let meta = InSpace::<f64>::META;
    let sizes = [("one", 2.0), ("one.rate.f", 3.0), ("two.angle", 4.0)];
    assert_eq!(meta.nominal(&sizes), Some([2.0, 4.0, 1.0, 3.0, 1.0, 1.0]));
    for unknown in ["", "on", "one.", "one.angle.x", "four"] {
        assert_eq!(meta.nominal::<6>(&[(unknown, 2.0)]), None, "{unknown}");
    }
    assert_eq!(meta.nominal::<5>(&sizes), None);
}

#[test]
fn four_bar_stays_closed_and_keeps_its_energy() {
    let model = FourBar::new(FourBarParameters::default()).unwrap();
    let u = SVector::from([]);
    let start = start(&model);
    let total = |t, x: &SVector<f64, 6>| {
        let output = model.output(t, x, &u, &mut ());
        (
            apart(&output.as_slice()[..2], &[0.0; 2]),
            model.energy(t, x) + output[2],
        )
    };
    let (_, first) = total(0.0, &start);
    let solver = Adaptive::new(Dop853, 1e-10, 1e-12);
    let (mut gap, mut drift) = (0.0_f64, 0.0_f64);
    solver
        .integrate(&model, &Constant(u), 0.0, 5.0, start, |step| {
            let (open, energy) = total(step.end(), step.state());
            gap = larger(gap, open);
            drift = larger(drift, (energy - first).abs());
        })
        .unwrap();
    assert!(gap < 1e-12, "{gap:e}");
    assert!(drift < 1e-8 * first.abs(), "{drift:e} of {first}");
}

/// What the hinges hold across the plane takes part in nothing.
#[test]
fn joints_in_space_move_in_a_plane_as_those_of_the_plane_do() {
    let planar = FourBar::<f64>::new(FourBarParameters::default()).unwrap();
    let spatial = InSpace::<f64>::new(InSpaceParameters::default()).unwrap();
    let joints = ["one", "two", "three"];
    let states = ["angle", "rate.f"].map(|it| joints.map(|joint| format!("{joint}.{it}")));
    let names = InSpace::<f64>::META.states.iter().map(|it| it.name);
    assert!(names.eq(states.as_flattened().iter().map(String::as_str)));
    let start = start(&planar);
    let solver = Adaptive::new(Dop853, 1e-11, 1e-12);
    let (mut one, mut other) = (start, start);
    let input = Constant(SVector::from([]));
    solver
        .integrate(&planar, &input, 0.0, 2.0, start, |step| one = *step.state())
        .unwrap();
    solver
        .integrate(&spatial, &input, 0.0, 2.0, start, |step| {
            other = *step.state()
        })
        .unwrap();
    assert!((one - start).norm() > 1.0, "{one}");
    assert!((one - other).norm() < 1e-8, "{one} {other}");
}

#[test]
fn jacobian_holds_through_the_multipliers() {
    let model = FourBar::new(FourBarParameters { damping: 0.01 }).unwrap();
    let mut x = start(&model);
    x[3] = 2.0;
    let exact = model.jacobian_state(0.0, &x, &SVector::zeros(), &mut ());
    for column in 0..6 {
        let direction = SVector::from_fn(|row, _| f64::from(row == column));
        let error = (exact.column(column) - slope(&model, &x, &direction)).amax();
        assert!(error < 1e-7 * exact.amax(), "{column}: {error:e}");
    }
}

#[test]
fn jacobian_holds_along_the_motion_of_two_bodies_that_are_joined() {
    holds_along_its_motion(&Docked::new(DockedParameters::default()).unwrap());
}

#[test]
fn jacobian_holds_where_rates_besides_the_multipliers_are_solved_with_numbers() {
    holds_along_its_motion(&Holding::new(HoldingParameters::default()).unwrap());
}

/// Across the length of its quaternions a model has no meaning, and the Jacobian another slope.
fn holds_along_its_motion<S: System<f64, N, 0, P, Memory = ()>, const N: usize, const P: usize>(
    model: &S,
) {
    let none = SVector::zeros();
    let mut x = model.close(0.0, model.initial_state(), &none, &[]).unwrap();
    for _ in 0..3 {
        let exact = model.jacobian_state(0.0, &x, &none, &mut ());
        let direction = model.derivative(0.0, &x, &none, &mut ());
        let error = (exact * direction - slope(model, &x, &direction)).amax();
        let size = (exact * direction).amax();
        assert!(error < 1e-9 * size, "{error:e} of {size:e}");
        x = model.close(0.0, x + 0.1 * direction, &none, &[]).unwrap();
    }
}

/// How the derivative changes in a direction, by central differences of fourth order.
fn slope<S: System<f64, N, 0, P, Memory = ()>, const N: usize, const P: usize>(
    model: &S,
    x: &SVector<f64, N>,
    direction: &SVector<f64, N>,
) -> SVector<f64, N> {
    let h = 5e-4;
    let at = |step: f64| model.derivative(0.0, &(x + step * direction), &SVector::zeros(), &mut ());
    (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h)
}

/// The rocker of [`Driven`] above the line from the crank's tip to the post, by the law of cosines.
fn rocker(crank: f64) -> f64 {
    let [x, y] = [f64::cos(crank) - 3.0, f64::sin(crank)];
    let square = x * x + y * y;
    let cosine = (square + 2.5 * 2.5 - 3.0 * 3.0) / (2.0 * 2.5 * square.sqrt());
    f64::atan2(y, x) - cosine.acos()
}

#[test]
fn a_loop_that_a_source_of_flow_drives_closes_from_rest() {
    for speed in [10.0, -3.7, 1e-3, 250.0, 0.0] {
        for start in [0.3, 1.0, 2.0] {
            let model = Driven::<f64>::new(DrivenParameters { speed, start }).unwrap();
            let x = model.initial_state();
            let end = if speed == 0.0 {
                0.1
            } else {
                0.5 / f64::abs(speed)
            };
            let x = model.close(0.0, x, &SVector::zeros(), &[]).unwrap();
            let angles = |t, x| model.output(t, x, &SVector::zeros(), &mut ());
            let mut last = x;
            Adaptive::new(Dop853, 1e-9, 1e-9)
                .integrate(&model, &(), 0.0, end, x, |step| last = *step.state())
                .unwrap();
            let (before, behind) = (angles(0.0, &x), angles(end, &last));
            let turned = behind[0] - before[0] - speed * end;
            assert!(turned.abs() < 1e-8, "{speed} {start}: {turned:e}");
            let apart = (behind[1] - rocker(behind[0])) / std::f64::consts::TAU;
            assert!(
                (apart - apart.round()).abs() < 1e-8,
                "{speed} {start}: {behind}"
            );
        }
    }
}

/// Where a source drives it that is no input, the rates that are not given follow at the start already.
#[test]
fn rates_of_a_loop_follow_the_source_that_drives_it() {
    for (speed, start) in [(10.0, 0.3), (-3.7, 1.0), (250.0, 2.0), (0.0, 1.0)] {
        let model = Driven::<f64>::new(DrivenParameters { speed, start }).unwrap();
        let (x, u) = (model.initial_state(), SVector::zeros());
        let closed = model.close(0.0, x, &u, &[]).unwrap();
        assert!((closed - x).norm() < 1e-12 * (1.0 + x.norm()), "{speed}");
        let before = |by: f64| rocker(model.output(0.0, &x, &u, &mut ())[0] + by);
        let expected = speed * (before(1e-5) - before(-1e-5)) / 2e-5;
        let found = model.derivative(0.0, &x, &u, &mut ());
        let place = Driven::<f64>::META.state("third.angle").unwrap();
        assert!(
            (found[place] - expected).abs() < 1e-8 * (1.0 + speed.abs()),
            "{speed}"
        );
    }
}

/// Near a dead centre all rates that are states are small or have no influence on the rod, along which velocities of 5 m/s cancel:
/// what these leave by rounding is no open loop, and what is given against each other is one.
#[test]
fn a_loop_closes_as_far_as_rounding_lets_it_at_a_dead_centre() {
    let model = DeadCentre::<f64>::new(DeadCentreParameters::default()).unwrap();
    let u = SVector::from([]);
    let near = SVector::from([
        6.283_395_307_179_586,
        0.249_999_998_621_875_02,
        100.0,
        -0.001_312_498_984_925_433_6,
    ]);
    let closed = model.close(0.0, near, &u, &[]).unwrap();
    assert!((closed - near).norm() < 1e-9, "{closed}");
    for place in 0..4000 {
        let mut start = near;
        start[0] = std::f64::consts::TAU + 1e-5 * (f64::from(place) - 2000.0);
        let mut start = model.close(0.0, start, &u, &[0, 2]).unwrap();
        start[3] += 1e-9;
        let closed = model.close(0.0, start, &u, &[]);
        assert!(closed.is_ok(), "{place}: {closed:?}");
    }
    for slower in [1e-9, 1e-6, 1.0] {
        let mut apart = near;
        apart[3] += slower;
        let closed = model.close(0.0, apart, &u, &[2, 3]);
        assert!(matches!(closed, Err(Trouble::Open { .. })), "{slower:e}");
    }
}

#[test]
fn what_locks_a_loop_is_told_in_words() {
    let locked = |constraints, coordinates| {
        let trouble = Trouble::Open {
            name: "a -> b",
            residual: 1.0,
            singular: false,
            locked: Some((constraints, coordinates)),
        };
        trouble.to_string()
    };
    let cases = [
        (
            1,
            0,
            ": no coordinate moves its ends against each other; see whether both are fixed",
        ),
        (1, 1, ": 1 constraint holds 1 coordinate, so that"),
        (2, 1, ": 2 constraints hold 1 coordinate, so that"),
        (6, 6, ": 6 constraints hold 6 coordinates, so that"),
    ];
    for (constraints, coordinates, expected) in cases {
        let told = locked(constraints, coordinates);
        assert!(told.contains(expected), "{told}");
    }
}

#[test]
fn a_loop_that_cannot_close_is_named() {
    let model = FourBar::new(FourBarParameters::default()).unwrap();
    let u = SVector::from([]);
    // Crank and rocker point away from each other: the gap is longer than the coupler.
    let apart = SVector::from([3.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let trouble = model.close(0.0, apart, &u, &[0, 2]).unwrap_err();
    assert!(
        trouble
            .to_string()
            .starts_with("the loop `coupler_tip[1..3] -> rocker_tip[1..3]` cannot be closed")
    );
}

/// A scissor lift whose platform is not let turn against the bar that it slides on: it would fit flat or upright alone. By
/// corrections that halve what is left it comes so near to that that rounding decides whether it fits.
#[test]
fn a_mechanism_that_is_locked_is_told_by_its_constraints() {
    let model = Locked::new(LockedParameters::default()).unwrap();
    let mut locked = 0;
    for number in 0..12 {
        let mut start = model.initial_state();
        start[number % 5 + 1] += 0.01 * number as f64;
        match model.close(0.0, start, &SVector::from([]), &[]) {
            Ok(flat) => assert!(flat[1].sin().abs() < 1e-6, "{flat}"),
            Err(trouble) => {
                locked += 1;
                let told = trouble.to_string();
                assert!(
                    told.ends_with(
                        " is left next to a position in which constraints depend on each other: 6 constraints hold 6 \
                         coordinates, so that nothing moves unless some are redundant; see whether a cut holds more than it \
                         should"
                    ),
                    "{told}"
                );
            }
        }
    }
    assert!(locked > 2, "{locked}");
}

/// The motion of a slider-crank at rest and at speed, in units of its size: that of one of a metre, whatever its size is.
#[test]
fn small_and_large_machines_close_and_move_as_others_do() {
    fn motion<T: Real>(length: f64, mass: f64) -> [f64; 4] {
        let [length, mass] = [length, mass].map(T::from_f64);
        let model = Slider::new(SliderParameters { length, mass }).unwrap();
        let (none, time) = (SVector::from([]), T::from_f64(0.0));
        // What is closed depends a little on the size, as it goes the way that is shortest for all coordinates.
        let closed = model
            .close(time, model.initial_state(), &none, &[])
            .unwrap();
        let [crank, rod] = [closed[1], closed[2]].map(|it| it.find(|_| true).unwrap());
        let open = crank.sin() + 2.0 * (crank + rod).sin();
        let [moves, turns] = [closed[4], closed[5]].map(|it| it.find(|_| true).unwrap());
        let slips = crank.cos() * moves + 2.0 * (crank + rod).cos() * (moves + turns);
        let start = [
            0.0,
            0.7,
            -(0.7 + (0.5 * 0.7_f64.sin()).asin()),
            (0.5 * 0.7_f64.sin()).asin(),
            0.0,
            0.0,
        ];
        let falling =
            model.derivative(time, &SVector::from(start.map(T::from_f64)), &none, &mut ());
        let falling = [falling[4], falling[5]].map(|rate| (length * rate).find(|_| true).unwrap());
        [open, slips, falling[0], falling[1]]
    }
    let usual = motion::<f64>(1.0, 1.0);
    let compare = |found: [f64; 4], bound: f64| {
        for (found, usual) in found.iter().zip(usual) {
            assert!((found - usual).abs() < bound, "{found:e} {usual:e}");
        }
    };
    for (length, mass) in [(0.05, 1e-4), (1e-2, 1e-2), (1e-6, 1e-9), (1e3, 1e9)] {
        compare(motion::<f64>(length, mass), 1e-8);
    }
    for (length, mass) in [(10.0, 1e4), (1e-2, 1e-2), (1e-3, 1e-3)] {
        compare(motion::<f32>(length, mass), 1e-3);
    }
}

/// A machine of micrometres closes as sharply as one of metres, moves as it does, and one that cannot be closed is told so.
#[test]
fn loops_of_any_length_are_closed_alike() {
    fn angle<T: Real>(length: f64, sharpest: f64) -> f64 {
        let number = T::from_f64;
        let parameters = ScaledParameters {
            length: number(length),
            apart: number(3.0),
        };
        let model = Scaled::<T>::new(parameters).unwrap();
        let none = SVector::from([]);
        let gap = |x: &SVector<T, 6>| {
            let outputs = model.output(number(0.0), x, &none, &mut ());
            outputs[0].magnitude().max(outputs[1].magnitude()) / length
        };
        let x = model
            .close(number(0.0), model.initial_state(), &none, &[2, 5])
            .unwrap();
        assert!(gap(&x) < sharpest, "{length}: {:e}", gap(&x));
        let (mut last, mut widest) = (x, 0.0);
        Rk4::fixed(
            &model,
            &(),
            number(0.0),
            number(1.0),
            number(1e-2),
            x,
            |_, x| {
                last = *x;
                widest = larger(widest, gap(x));
            },
        )
        .unwrap();
        assert!(widest < 20.0 * sharpest, "{length}: {widest:e}");
        let apart = ScaledParameters {
            apart: number(6.1),
            ..parameters
        };
        let broken = Scaled::<T>::new(apart).unwrap();
        assert!(
            broken.close(number(0.0), x, &none, &[]).is_err(),
            "{length}"
        );
        model.output(number(0.0), &last, &none, &mut ())[2]
            .find(|_| true)
            .unwrap()
    }
    let expected = angle::<f64>(1.0, 1e-15);
    // Corrections are of least norm in momenta and rates, so that they are others for a metre, within the error of a step.
    for length in [1e-3, 1e-5, 1e-8] {
        assert!(
            (angle::<f64>(length, 2e-15) - expected).abs() < 1e-11,
            "{length}"
        );
    }
    for length in [1.0, 1e-3, 1e-5, 1e-6] {
        assert!(
            (angle::<f32>(length, 1e-6) - expected).abs() < 2e-5,
            "{length}"
        );
    }
}

/// Where a state is the momentum of a light rod and others are rates, rates are corrected as well.
#[test]
fn the_momentum_of_a_light_rod_does_not_hold_rates() {
    fn angle<T: Real>(length: f64, mass: f64, widest: f64) -> f64 {
        let [length, mass] = [length, mass].map(T::from_f64);
        let model = Pressed::new(PressedParameters { length, mass }).unwrap();
        let [start, end, step] = [0.0, 1.0, 1e-2].map(T::from_f64);
        let mut last = model.initial_state();
        Rk4::fixed(&model, &(), start, end, step, last, |_, x| last = *x).unwrap();
        let [gap_x, gap_y, angle] = model
            .output(end, &last, &SVector::from([]), &mut ())
            .map(|it| it.find(|_| true).unwrap())
            .into();
        let length = length.magnitude();
        assert!(gap_x.abs().max(gap_y.abs()) < widest * length, "{length}");
        angle
    }
    let expected = angle::<f64>(1.0, 1.0, 1e-14);
    assert!((expected - 0.5).abs() > 0.5, "{expected}");
    for (length, mass) in [
        (1e-3, 1e-3),
        (1e-4, 1e-5),
        (1e-6, 1e-12),
        (1.0, 1e-15),
        (1e3, 1e6),
    ] {
        let found = angle::<f64>(length, mass, 1e-8);
        assert!((found - expected).abs() < 1e-6, "{length} {mass} {found}");
    }
    for (length, mass) in [(1e-2, 1e-3), (1e-3, 1e-6), (1.0, 1e-9), (1e3, 1e6)] {
        let found = angle::<f32>(length, mass, 1e-5);
        assert!((found - expected).abs() < 1e-4, "{length} {mass} {found}");
    }
}

mbg! {
    /// A crank with a piston that a damper brings to rest.
    #[derivative]
    pub(crate) model Damped {
        causality componentwise;
        1 ground[3]; 1 tip[3]; 1 end[3]; 1 slide[3];
        Sf fixed[3] { flow: 0.0 } -> ground;
        crank: PlanarLink {
            mass: 1.0, inertia: 0.1, centre: [0.0, 0.0], end: [0.1, 0.0],
            initial: 0.5, initial_rate: 1.0, damping: 10.0
        } (ground, tip);
        rod: PlanarLink { mass: 0.1, inertia: 0.001, centre: [0.1, 0.0], end: [0.3, 0.0], initial: -0.66 } (tip, end);
        guide: PlanarPrismatic { initial: 0.38 } (ground, slide);
        piston: PlanarPointMass { mass: 0.1 } (slide);
        pin: PlanarCut (end, slide);
    }
}

/// Squares of what is left of its rates are too small for numbers, at the end the rates themselves.
#[test]
fn a_loop_comes_to_rest() {
    fn fastest<T: Real>(method: impl Method, seconds: f64) -> f64 {
        let model = Damped::new(DampedParameters::<T>::default()).unwrap();
        let mut last = model.initial_state();
        let [start, end] = [0.0, seconds].map(T::from_f64);
        Fixed::new(method, 1e-3)
            .integrate(&model, &(), start, end, last, |step| last = *step.state())
            .unwrap();
        last.iter()
            .skip(3)
            .fold(0.0, |most, rate| larger(most, rate.magnitude()))
    }
    assert!(fastest::<f32>(Rk4, 3.0) < 1e-36);
    assert!(fastest::<f32>(Gauss6::default(), 3.0) < 1e-36);
    assert!(fastest::<f64>(Rk4, 10.0) < 1e-300);
    assert!(fastest::<f64>(Gauss6::default(), 10.0) < 1e-300);
}
