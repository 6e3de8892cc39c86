//! Operating points, against closed forms and runs that begin there.

use mbg_runtime::{
    Adaptive, Constant, Convertible, Dop853, Integrator, Linearised, PeriodicTrim, System, Trim,
    Trimmed, Untrimmed, mbg,
};
use nalgebra::SVector;

mbg! {
    /// A craft with four rotors at the ends of a cross, in air that holds it back.
    model Quadrotor {
        param mass: kg = 1.2;
        param drag: N*s/m = 0.4;
        gravity [0.0, 0.0, -9.81];
        input thrust[4]: N;
        1 ground[6] { Sf held { flow: 0.0 } }
        1 craft[6];
        1 sky[6];
        free: Free { orientation: quaternion } (ground, craft);
        hull: Body { mass: mass, inertia: diag(0.01, 0.012, 0.02) } (craft);
        rotors: Load {
            force: [0.0, 0.0, thrust[0] + thrust[1] + thrust[2] + thrust[3]],
            moment: [0.2 * (thrust[1] - thrust[3]), 0.2 * (thrust[2] - thrust[0]),
                0.016 * (thrust[0] - thrust[1] + thrust[2] - thrust[3])]
        } (craft);
        straight: Turn { by: transpose(free.orientation_b) } (craft, sky);
        Se air[3] { effort: -drag * sky.f[3..6] } -> sky[3..6];
        output speed[3]: m/s = sky.f[3..6];
        output place[3]: m = free.position;
        output turning[3]: rad/s = sky.f[0..3];
    }

    /// A crank, a rocker and a coupler between them, whose end is to be where the rocker's is.
    component Bars(port 1 end[3], port 1 b[3]) {
        param torque: N*m;
        1 ground[3]; 1 left[3]; 1 a[3]; 1 right[3]; 1 coupler[3]; 1 foot[3]; 1 centre[3];
        Sf fixed[3] { flow: 0.0 } -> ground;
        first: PlanarRevolute { initial: 1.2, torque: torque } (ground, left);
        left_body: PlanarBody { mass: 1.0, inertia: 0.1 } (left);
        left_arm: PlanarOffset { x: 0.5 } (left, a);
        base: PlanarOffset { x: 1.0 } (ground, foot);
        second: PlanarRevolute { initial: 1.2 } (foot, right);
        right_body: PlanarBody { mass: 1.0, inertia: 0.1 } (right);
        right_arm: PlanarOffset { x: 0.5 } (right, b);
        third: PlanarRevolute { initial: -1.2 } (a, coupler);
        half: PlanarOffset { x: 0.5 } (coupler, centre);
        body: PlanarBody { mass: 3.0, inertia: 0.1 } (centre);
        arm: PlanarOffset { x: 1.0 } (coupler, end);
    }

    /// A four-bar held by a torque at its first crank, which multipliers close.
    #[derivative]
    model Crank {
        causality componentwise;
        gravity [0.0, -9.81];
        input torque: N*m;
        1 end[3]; 1 b[3];
        bars: Bars { torque: torque } (end, b);
        cut: PlanarCut (end, b);
        output angles[2]: rad = [bars.first.angle, bars.second.angle];
    }

    /// The same as a ring of joints, which nothing closes.
    #[derivative]
    model Ring {
        causality componentwise;
        gravity [0.0, -9.81];
        input torque: N*m;
        1 end[3]; 1 b[3];
        bars: Bars { torque: torque } (end, b);
        fourth: PlanarRevolute { initial: 1.2 } (end, b);
        output gap[2]: m = bars.arm.position_b - bars.right_arm.position_b;
    }

    /// A seat that two rods of one length keep level, pushed aside: the moment on it is zero, whatever is chosen.
    #[derivative]
    model Seat {
        causality componentwise;
        gravity [0.0, -9.81];
        input push: N;
        1 ground[3]; 1 slid[3]; 1 lifted[3]; 1 seat[3];
        Sf fixed[3] { flow: 0.0 } -> ground;
        x: PlanarPrismatic (ground, slid);
        y: PlanarPrismatic { direction: 1.5707963267948966, initial: -1.5 } (slid, lifted);
        turn: PlanarRevolute (lifted, seat);
        body: PlanarBody { mass: 3.0, inertia: 0.1 } (seat);
        hand: PlanarLoad { axes: world, force: [push, 0.0] } (seat);
        sides: for k in 0..2 {
            let side: m = 0.4 * (2 * k - 1);
            1 hook[3]; 1 corner[3];
            above: PlanarOffset { x: side } (ground, hook);
            beside: PlanarOffset { x: side, y: 0.1 } (seat, corner);
            rod: PlanarRod { length: 1.4 } (hook, corner);
        }
        output place[2]: m = [x.travel, y.travel];
    }

    /// A load on a rope below a craft that is lifted: how the load is turned has no influence where it hangs.
    model Slung {
        gravity [0.0, 0.0, -9.81];
        input lift: N;
        1 ground[6]; 1 craft[6]; 1 load[6];
        Sf fixed[6] { flow: 0.0 } -> ground;
        above: Free { orientation: quaternion, force: [0.0, 0.0, lift] } (ground, craft);
        hull: Body { mass: 10.0, inertia: 0.4 } (craft);
        below: Free { initial_position: [0.0, 0.0, -5.0] } (ground, load);
        freight: Body { mass: 4.0, inertia: 0.2 } (load);
        rope: LineForce { kind: rope, stiffness: 1e5, rest: 4.99, damping: 2000.0 } (craft, load);
        output tension: N = rope.spring.e;
        output angles[3]: rad = below.angle;
    }

    /// A pull on two springs of which each may have any stroke: more may be chosen than is asked.
    model Shared {
        input pull: N;
        1 block { I mass { inertia: 2.0 } C soft { stiffness: 300.0 } C hard { effort: 50.0 * q + 4000.0 * q * q * q } }
        Se hand { effort: pull } -> block;
        output way: m = soft.q;
    }
}

fn settled<S, const N: usize, const M: usize, const P: usize>(
    model: &S,
    point: &Trimmed<N, M>,
) -> SVector<f64, N>
where
    S: Convertible<f64, N, M, P>,
{
    let mut last = point.state;
    Adaptive::new(Dop853, 1e-10, 1e-10)
        .integrate(model, &Constant(point.input), 0.0, 0.5, last, |step| {
            last = *step.state();
        })
        .unwrap();
    last
}

/// Its place, attitude and rates are integrals one behind the other, which no sweep over all of them finds.
#[test]
fn the_poles_of_a_hover_are_those_of_its_drag() {
    let model = Quadrotor::<f64>::new(QuadrotorParameters::default()).unwrap();
    let hover = Trim::new(&model).fix("free.position").solve().unwrap();
    let next = Linearised::of(&model, 0.0, &hover.state, &hover.input).unwrap();
    let poles = next.poles().unwrap();
    let near = |to: f64, error: f64| {
        let near = poles
            .iter()
            .filter(|pole| (pole.re - to).hypot(pole.im) < error);
        near.count()
    };
    assert_eq!(
        (near(-0.4 / 1.2, 1e-9), near(0.0, 1e-9)),
        (3, 10),
        "{poles:?}"
    );
}

#[test]
fn a_craft_hovers_with_equal_thrusts() {
    let craft = Quadrotor::<f64>::new(QuadrotorParameters::default()).unwrap();
    let hover = Trim::new(&craft).fix("free.position").solve().unwrap();
    // Whatever the heading, torques and thrust fix all four.
    for thrust in hover.input.iter() {
        assert!((thrust - 1.2 * 9.81 / 4.0).abs() < 1e-12, "{thrust}");
    }
    let last = settled(&craft, &hover);
    assert!((last - hover.state).norm() < 1e-10);
    Linearised::of(&craft, 0.0, &hover.state, &hover.input).unwrap();
}

#[test]
fn a_craft_leans_against_its_drag() {
    let craft = Quadrotor::<f64>::new(QuadrotorParameters::default()).unwrap();
    let flight = Trim::new(&craft)
        .fix("free.position")
        .free("free.position")
        .output("speed.x", 6.0)
        .output("speed.y", -2.0)
        .output("speed.z", 1.0)
        .solve()
        .unwrap();
    // Thrust is opposite to weight and drag, in size and direction.
    let force = SVector::<f64, 3>::from([0.4 * 6.0, -0.4 * 2.0, 1.2 * 9.81 + 0.4]);
    assert!((flight.input.sum() - force.norm()).abs() < 1e-10);
    let last = settled(&craft, &flight);
    let place = |state: &SVector<f64, 13>, name: &str| {
        let states = <Quadrotor<f64> as mbg_runtime::System<f64, 13, 4, 9>>::META.states;
        states
            .iter()
            .zip(state.iter())
            .filter(|(it, _)| it.name.starts_with(name))
            .map(|it| *it.1)
            .collect::<Vec<_>>()
    };
    let (before, behind) = (
        place(&flight.state, "free.position"),
        place(&last, "free.position"),
    );
    for ((before, behind), speed) in before.iter().zip(behind).zip([6.0, -2.0, 1.0]) {
        assert!((behind - before - 0.5 * speed).abs() < 1e-9);
    }
}

/// Fast and slow, to either side: what holds it against the air and on its circle.
#[test]
fn a_craft_turns_steadily() {
    let craft = Quadrotor::<f64>::new(QuadrotorParameters::default()).unwrap();
    for turning in [1.0, 0.3, 0.1, -0.1, 1e-2, 1e-3] {
        for speed in [0.5, 2.0, 6.0] {
            let turn = Trim::new(&craft)
                .fix("free.position")
                .free("free")
                .output("speed", 0.0)
                .output("speed.x", speed)
                .output("turning", 0.0)
                .output("turning.z", turning)
                .solve()
                .unwrap_or_else(|missed| panic!("{turning} {speed}: {missed}"));
            let force = [0.4 * speed, 1.2 * speed * turning, 1.2 * 9.81];
            let expected = SVector::from(force).norm();
            assert!((turn.input.sum() - expected).abs() < 1e-9);
        }
    }
}

#[test]
fn a_closed_loop_is_held() {
    let crank = Crank::<f64>::new(CrankParameters::default()).unwrap();
    let held = Trim::new(&crank).fix("bars.first").solve().unwrap();
    // The coupler alone has weight that a turn lifts: 3 kg at the end of a crank of half a metre.
    let expected = 3.0 * 9.81 * 0.5 * f64::cos(1.2);
    assert!(
        (held.input[0] - expected).abs() < 1e-10,
        "{}",
        held.input[0]
    );
    assert!((settled(&crank, &held) - held.state).norm() < 1e-8);
    // With this torque it comes to rest at the same angle, from another one.
    let guess = 1.1 * held.state;
    let found = Trim::new(&crank)
        .state(&guess)
        .input(&[expected])
        .fix("torque")
        .solve()
        .unwrap();
    assert!((found.state - held.state).norm() < 1e-9);
}

/// By itself the angle of a coupler that stays level has no influence but rounding.
#[test]
fn a_parallelogram_is_held_wherever_it_shall_be() {
    let model = Crank::<f64>::new(CrankParameters::default()).unwrap();
    for angle in [1.19, 1.0, 0.3, 0.1, -0.3, 2.5, 3.0] {
        let point = Trim::new(&model).output("angles.x", angle).solve().unwrap();
        let expected = 3.0 * 9.81 * 0.5 * f64::cos(angle);
        assert!(
            (point.input[0] - expected).abs() < 1e-9,
            "{angle}: {}",
            point.input[0]
        );
    }
}

/// With its bars in line it may go on as another linkage, and no torque holds both; next to that it is held.
#[test]
fn a_parallelogram_in_line_is_refused() {
    let model = Crank::<f64>::new(CrankParameters::default()).unwrap();
    for guess in [0.0, 5.0, 14.7, 30.0] {
        let trim = Trim::new(&model).input(&[guess]);
        let in_line = [
            trim.output("angles.x", 0.0).solve(),
            trim.state(&SVector::zeros())
                .fix("bars.first.angle")
                .solve(),
        ];
        for found in in_line {
            assert!(
                matches!(
                    found,
                    Err(Untrimmed::Singular {
                        input: "torque",
                        ..
                    } | Untrimmed::Missed { .. })
                ),
                "{guess}: {found:?}"
            );
        }
        for angle in [-1e-2, 1e-3, 1e-4] {
            let torque = trim.output("angles.x", angle).solve().unwrap().input[0];
            let expected = 3.0 * 9.81 * 0.5 * f64::cos(angle);
            assert!(
                (torque - expected).abs() < 1e-4,
                "{guess} {angle}: {torque}"
            );
        }
    }
}

/// A ring is opened, since its coordinates are moved each by itself, unless its gap is asked to be none.
#[test]
fn a_ring_is_held_where_its_gap_is_an_output() {
    let crank = Crank::<f64>::new(CrankParameters::default()).unwrap();
    let held = Trim::new(&crank).fix("bars.first.angle").solve().unwrap();
    let ring = Ring::<f64>::new(RingParameters::default()).unwrap();
    let trim = Trim::new(&ring).fix("bars.first.angle");
    let gap = |point: &Trimmed<4, 1>| ring.output(0.0, &point.state, &point.input, &mut ());
    assert!(gap(&trim.solve().unwrap()).norm() > 0.01);
    let closed = trim.output("gap", 0.0).solve().unwrap();
    assert!(gap(&closed).norm() < 1e-12);
    assert!(
        (closed.input[0] - held.input[0]).abs() < 1e-9,
        "{closed:?} {held:?}"
    );
}

/// What is left of a moment that is zero whatever is chosen is rounding, and no failure; so are rates next to rest.
#[test]
fn what_rods_keep_level_is_held() {
    let seat = Seat::<f64>::new(SeatParameters::default()).unwrap();
    for aside in [0.0, 0.1, 0.5, -0.7, 0.84, 1.0, 1.3] {
        let trim = Trim::new(&seat).output("place.x", aside);
        let held = trim.solve().unwrap();
        let expected = 3.0 * 9.81 * aside / f64::sqrt(1.4 * 1.4 - aside * aside);
        let [force]: [f64; 1] = held.input.into();
        assert!(
            (force - expected).abs() < 1e-12 * (30.0 + expected.abs()),
            "{aside}: {force} {expected}"
        );
        let again = trim.state(&held.state).input(&[force]).solve().unwrap();
        assert!((again.state - held.state).norm() < 1e-12);
    }
}

/// Whatever the guess, if the rope is taut in it. Nothing but their own rates tells how large most velocities are.
#[test]
fn a_load_hangs_below_its_craft() {
    const PLACES: [&str; 6] = [
        "below.position.x",
        "below.position.y",
        "below.position.z",
        "below.rotation.gimbal.angle.x",
        "below.rotation.gimbal.angle.y",
        "below.rotation.gimbal.angle.z",
    ];
    let slung = Slung::<f64>::new(SlungParameters::default()).unwrap();
    for guess in 0..40 {
        let mut start = slung.initial_state();
        let aside = |number: usize| (1.7 * (number * 40 + guess) as f64).sin();
        for (number, place) in PLACES.iter().enumerate() {
            start[Slung::<f64>::META.state(place).unwrap()] = 0.5 * aside(number);
        }
        start[Slung::<f64>::META.state("below.position.z").unwrap()] -= 5.6;
        let found = Trim::new(&slung).state(&start).fix("above").solve();
        let hanging = found.unwrap_or_else(|missed| panic!("{guess}: {missed}"));
        assert!((hanging.input[0] - 14.0 * 9.81).abs() < 1e-8);
        let angles = slung.output(0.0, &hanging.state, &hanging.input, &mut ());
        assert!(angles.fixed_rows::<3>(1).amax() < 3.0, "{guess}: {angles}");
    }
}

#[test]
fn more_may_be_chosen_than_is_asked() {
    let shared = Shared::<f64>::new(SharedParameters::default()).unwrap();
    let found = Trim::new(&shared).output("way", 0.3).solve().unwrap();
    let [soft, hard] = [found.state[1], found.state[2]];
    let force = 300.0 * soft + 50.0 * hard + 4000.0 * hard.powi(3);
    assert!((soft - 0.3).abs() < 1e-12 && (found.input[0] - force).abs() < 1e-9);
}

#[test]
fn what_cannot_be_is_told() {
    let craft = Quadrotor::<f64>::new(QuadrotorParameters::default()).unwrap();
    let told = |trim: Trim<'_, _, 13, 4, 9>| trim.solve().unwrap_err().to_string();
    assert_eq!(
        told(Trim::new(&craft).fix("free.positon").fix("thrusts")),
        "the model has no state or input `free.positon`: a position or an angle that nothing reads is none"
    );
    assert_eq!(
        told(Trim::new(&craft).rate("x", 1.0)),
        "the model has no state `x`: a position or an angle that nothing reads is none"
    );
    assert_eq!(
        told(Trim::new(&craft).output("spee", 1.0)),
        "the model has no output `spee`"
    );
    assert_eq!(
        told(Trim::new(&craft).output("place[2]", 1.0)),
        "the model has no output `place[2]`: components of vectors are called `.x`, `.y` and `.z`, of longer ones `.0` and so on"
    );
    let fixed = Trim::new(&craft)
        .fix("free.position")
        .output("place.z", 3.0);
    assert_eq!(
        told(fixed),
        "`place.z` is 0e0 instead of 3e0, and nothing that may be chosen has an influence on it"
    );
    let moving = Trim::new(&craft)
        .fix("free")
        .fix("hull")
        .rate("free.position.x", 1.0);
    assert_eq!(
        told(moving),
        "the rate of `free.position.x` is 0e0 instead of 1e0, and nothing that may be chosen has an influence on it there: \
         begin elsewhere, or write `.free(\"free.position.x\")` where it is to change"
    );
    let nowhere = SVector::from_element(f64::NAN);
    assert!(Trim::new(&craft).state(&nowhere).solve().is_err());
    let Err(Untrimmed::Missed {
        name,
        wanted,
        is_fixed: false,
        ..
    }) = Trim::new(&craft).fix("thrust").solve()
    else {
        panic!("nothing carries it");
    };
    assert_eq!((name, wanted), ("hull.body.p.z", 0.0));
}

mbg! {
    /// A mass on two springs, one behind a lever, of which the second is pretensioned, pushed steadily and with a wave.
    model Springs {
        input push: N;
        param shake: N = 0.0;
        1 way {
            I mass { inertia: 1.0 }
            R damper { resistance: 1.0 }
            C one { stiffness: 100.0 }
            C other { stiffness: 10.0, initial: 0.3 }
            Se hand { effort: push + shake * sin(6.0 * t) }
        }
        1 short { C third { stiffness: 5.0, initial: 0.1 } }
        way -> TF lever { flow: -2.0 } -> short;
        output stretched: m = one.q;
    }
}

/// From the start on all springs are stretched by as much, the one behind the lever twice the other way.
#[test]
fn springs_that_move_together_differ_as_at_the_start() {
    let model = Springs::<f64>::new(SpringsParameters::default()).unwrap();
    let stiffness = 100.0 + 10.0 + 4.0 * 5.0;
    let pushed = Trim::new(&model).input(&[11.0]).fix("push").solve();
    let state = pushed.unwrap().state;
    let way = (11.0 - 10.0 * 0.3 + 2.0 * 5.0 * 0.1) / stiffness;
    let expected = SVector::from([0.0, way, 0.3 + way, 0.1 - 2.0 * way]);
    assert!((state - expected).amax() < 1e-12, "{state}");
    // What a run comes to.
    let mut end = model.initial_state();
    let push = Constant(SVector::from([11.0]));
    Adaptive::new(Dop853, 1e-11, 1e-11)
        .integrate(&model, &push, 0.0, 60.0, end, |step| end = *step.state())
        .unwrap();
    assert!((end - state).amax() < 1e-9, "{end}");
    let shaken = Springs::<f64>::new(SpringsParameters { shake: 4.0 }).unwrap();
    let exact = Adaptive::new(Dop853, 1e-11, 1e-11);
    let cycle = PeriodicTrim::new(&shaken, &exact, core::f64::consts::PI / 3.0)
        .input(&[11.0])
        .fix("push")
        .solve()
        .unwrap();
    // A steady part, and the wave that it swings in.
    let (far, damped) = (stiffness - 36.0, 6.0);
    let swung = -4.0 * damped / (far * far + damped * damped);
    let moved = cycle.state[1] - way;
    assert!((moved - swung).abs() < 1e-9, "{} {}", moved, swung);
    let differences = [
        cycle.state[2] - cycle.state[1],
        cycle.state[3] + 2.0 * cycle.state[1],
    ];
    assert!((differences[0] - 0.3).abs() < 1e-9 && (differences[1] - 0.1).abs() < 1e-9);
}

mbg! {
    /// A plate on a beam before another one, drawn to it by a voltage: a pair of plates that is a field of two ports.
    model PullIn {
        param gap: m = 2e-6;
        param plates: F*m = 8.854e-20;
        param k: N/m = 1.0;
        input bias: V;
        1 wire { Se source { effort: bias } R lead { resistance: 1e5 } }
        1 plate { I proof { inertia: 1e-10 } R film { resistance: 2e-5 } C beam { stiffness: k } }
        1 field[2] { C pair { energy: powi(q[0], 2) * (gap - q[1]) / (2 * plates) } }
        wire -> field[0];
        plate -> field[1];
        output bent: m = beam.q;
        output left: m = gap - pair.q[1];
    }
}

/// The plate goes by as much as the beam is bent, so that nothing rests beyond the voltage at which it is pulled in.
#[test]
fn a_plate_that_is_pulled_in_has_no_rest() {
    let parameters = PullInParameters::<f64>::default();
    let PullInParameters { gap, plates, k } = parameters;
    let pulled_in = f64::sqrt(8.0 * k * gap.powi(3) / (27.0 * plates));
    let model = PullIn::<f64>::new(parameters).unwrap();
    let trim = |part: f64| Trim::new(&model).input(&[part * pulled_in]).fix("bias");
    for part in [0.1, 0.5, 0.9, 0.99] {
        let point = trim(part).solve().unwrap();
        let [bent, left] = model
            .output(0.0, &point.state, &point.input, &mut ())
            .into();
        // The first root of x (1 - x)^2 = 4/27 part^2, by three times its angle.
        let third = 2.0 / 3.0 * (part.acos() + core::f64::consts::PI);
        let expected = 2.0 / 3.0 * gap * (1.0 + third.cos());
        assert!((bent - expected).abs() < 1e-9 * gap, "{part}: {bent:e}");
        assert!((bent + left - gap).abs() < 1e-12 * gap, "{part}: {left:e}");
    }
    for part in [1.001, 1.01, 1.1, 1.5, 3.0] {
        let missed = trim(part).solve().unwrap_err();
        let Untrimmed::Apart {
            name: "pair.q.y",
            other: "beam.q",
            times: 1.0,
            kept: 0.0,
            needed,
        } = missed
        else {
            panic!("{part}: {missed:?}");
        };
        assert!(needed < -0.1 * gap, "{part}: {needed:e}");
        let told = missed.to_string();
        let begins = "`pair.q.y` - `beam.q` is 0e0 and stays so in every motion, but";
        assert!(told.starts_with(begins), "{told}");
        // An output that rests elsewhere does not excuse it.
        let wanted = trim(part).output("bent", 0.1 * gap).solve();
        assert_eq!(wanted.unwrap_err().to_string()[..begins.len()], *begins);
    }
}

/// Where the beam is asked to be bent otherwise than the voltage bends it, or one of both is fixed, the plate may be elsewhere.
#[test]
fn differences_change_where_that_is_asked() {
    let model = PullIn::<f64>::new(PullInParameters::default()).unwrap();
    let bent = 0.5e-6;
    let wanted = Trim::new(&model).input(&[4.0]).fix("bias");
    let mut start = model.initial_state();
    start[PullIn::<f64>::META.state("beam.q").unwrap()] = bent;
    let fixed = Trim::new(&model).state(&start).input(&[6.0]).fix("bias");
    let points = [
        wanted.output("bent", bent).solve().unwrap(),
        fixed.fix("beam.q").solve().unwrap(),
    ];
    for point in points {
        let [found, left] = model
            .output(0.0, &point.state, &point.input, &mut ())
            .into();
        // The plates draw each other as the beam draws back.
        let force = 0.5 * 8.854e-20 * (point.input[0] / left).powi(2);
        assert!((found - bent).abs() < 1e-9 * bent, "{found:e}");
        assert!((force - bent).abs() < 1e-9 * bent, "{force:e}");
        assert!((found + left - 2e-6).abs() > 1e-8, "{left:e}");
    }
    let springs = Springs::<f64>::new(SpringsParameters::default()).unwrap();
    let both = Trim::new(&springs)
        .input(&[11.0])
        .fix("push")
        .output("stretched", 0.02);
    let state = both.solve().unwrap().state;
    let forces = 100.0 * state[1] + 10.0 * state[2] - 2.0 * 5.0 * state[3];
    assert!((state[1] - 0.02).abs() < 1e-12 && (forces - 11.0).abs() < 1e-9);
}

mbg! {
    /// A motor whose speed is controlled, with a voltage that is limited.
    model Servo {
        param proportional: V*s/rad = 0.5;
        param integrating: V/rad = 2.0;
        param most: V = 12.0;
        input wanted: rad/s;
        let error = wanted - shaft.f;
        integral sum = error;
        let voltage = max(-most, min(most, proportional * error + integrating * sum));
        1 coil { Se source { effort: voltage } I windings { inertia: 1e-3 } R wire { resistance: 1.0 } }
        coil -> GY motor { effort: 0.05 } -> shaft;
        1 shaft { I rotor { inertia: 1e-3 } R bearing { resistance: 1e-4 } }
        output speed: rad/s = shaft.f;
    }

    /// A mass above a floor.
    model Dropped {
        param above: m = 0.3;
        1 fall {
            I mass { inertia: 2.0 }
            Se weight { effort: -19.62 }
            C floor { effort: if q < 0.0 { 1e5 * q } else { 0.0 * q }, initial: above }
            R damper { effort: if floor.q < 0.0 { 100.0 * f } else { 0.0 * f } }
        }
    }

    /// A tank that a pump fills through a valve.
    model Filled {
        input command;
        let opening = max(0.0, min(command, 1.0));
        0 level {
            C tank { compliance: 2.0, initial: 0.1 }
            Sf pump { flow: 0.3 * opening }
            R outflow { flow: 0.2 * e }
        }
        output content = tank.q;
    }
}

#[test]
fn what_is_beyond_a_limit_is_led_back() {
    let servo = Servo::<f64>::new(ServoParameters::default()).unwrap();
    let at = |wanted| Trim::new(&servo).input(&[wanted]).fix("wanted").solve();
    // By far more than the limit at the start, at rest with 0.052 V for each rad/s.
    for speed in [-229.0, -100.0, 50.0, 100.0, 225.0, 230.0] {
        let sum = at(speed).unwrap().state[2];
        assert!((sum / (0.026 * speed) - 1.0).abs() < 1e-12, "{speed} {sum}");
    }
    assert_eq!(
        at(300.0).unwrap_err().to_string().split("; ").last(),
        Some("`sum` is beyond a limit, where it has no influence")
    );
    let filled = Filled::<f64>::new(FilledParameters::default()).unwrap();
    for command in [-1e3, -0.5, 0.5, 2.0, 70.0] {
        let trim = Trim::new(&filled).input(&[command]);
        let open = trim.output("content", 1.5).solve().unwrap().input[0];
        assert!((open - 0.5).abs() < 1e-12, "{command} {open}");
        let open = trim.fix("tank").solve().unwrap().input[0];
        assert!((open - 0.1 / 3.0).abs() < 1e-12, "{command} {open}");
        assert!(trim.output("content", 3.1).solve().is_err(), "{command}");
    }
}

#[test]
fn what_is_above_a_floor_is_found_on_it() {
    for above in [-0.01, 1e-6, 0.3, 70.0] {
        let dropped = Dropped::<f64>::new(DroppedParameters { above }).unwrap();
        let floor = Trim::new(&dropped).solve().unwrap().state[1];
        assert!((floor / -1.962e-4 - 1.0).abs() < 1e-12, "{above} {floor}");
    }
}
