//! The same at steps of constant length.

use mbg_runtime::{
    Adaptive, Constant, Dop853, Dual, Fixed, Gauss6, ImplicitMidpoint, Input, Integrator, Method,
    Radau5, Rk4, Rodas5P, Smooth, System,
};
use nalgebra::SVector;

use super::{
    Belt, BeltParameters, Block, BlockParameters, CAUGHT, Follower, FollowerParameters, Row,
    RowParameters, Shaken, ShakenParameters, Stacked, StackedParameters, last, push,
};

const STRICT: Adaptive<'_, Dop853> = Adaptive::new(Dop853, 1e-12, 1e-13);

/// The last of the states and outputs by a method of each kind, with their names and orders.
fn by_each<const N: usize, const M: usize, const P: usize>(
    model: &impl System<f64, N, M, P>,
    input: &dyn Input<f64, M>,
    (end, step): (f64, f64),
) -> Vec<(&'static str, u32, SVector<f64, N>, SVector<f64, P>)> {
    macro_rules! by {
        ($($name:ident: $method:expr),*) => {
            vec![
                $({
                    let found = last(model, input, end, &Fixed::new($method, step));
                    ($name::NAME, $name::ORDER, found.0, found.1)
                },)*
            ]
        };
    }
    by!(
        Rk4: Rk4,
        Gauss6: Gauss6::default(),
        ImplicitMidpoint: ImplicitMidpoint::default(),
        Rodas5P: Rodas5P,
        Radau5: Radau5
    )
}

/// Steps end where friction turns around, and where it holds.
#[test]
fn friction_holds_what_a_spring_is_too_weak_for() {
    let model = Block::new(BlockParameters::default()).unwrap();
    for (method, _, state, outputs) in by_each(&model, &(), (30.0, 0.01)) {
        let errors = [state[0], state[1] - 0.2, outputs[0] + 0.8];
        assert!(
            errors.iter().all(|error| error.abs() < 1e-8),
            "{method}: {errors:?}"
        );
    }
    let single = Block::<f32>::new(BlockParameters::default()).unwrap();
    let (state, outputs, _) = last(&single, &(), 30.0, &Fixed::new(Rk4, 0.01));
    assert!(
        state[0] == 0.0 && (state[1] - 0.2).abs() < 2e-6 && (outputs[0] + 0.8).abs() < 8e-6,
        "{state} {outputs}"
    );
}

/// Laws between jumps are of the second degree at most, which all of these methods have exactly, but for the midpoint rule.
#[test]
fn several_hold_at_once_and_one_after_the_other() {
    let model = Stacked::new(StackedParameters::default()).unwrap();
    let pulse = push(12.0, 1.0, 2.0);
    for (end, speeds, forces) in CAUGHT {
        for (method, _, state, outputs) in by_each(&model, &pulse, (end, 0.03)) {
            let errors = [
                state - SVector::from(speeds),
                outputs - SVector::from(forces),
            ];
            assert!(
                errors.iter().all(|it| it.amax() < 1e-12),
                "{method} until {end}: {errors:?}"
            );
        }
    }
    let growing = Smooth(|t: f64| SVector::from([t]));
    for (method, _, state, outputs) in by_each(&model, &growing, (11.0, 0.03)) {
        let errors = [
            state - SVector::from([12.0, 38.0]),
            outputs - SVector::from([2.0, 1.0]),
        ];
        assert!(
            errors.iter().all(|it| it.amax() < 1e-8),
            "{method}: {errors:?}"
        );
    }
    let model = Shaken::<f64>::new(ShakenParameters::default()).unwrap();
    let reference = last(&model, &(), 3.0, &STRICT).0;
    for (method, order, state, _) in by_each(&model, &(), (3.0, 1e-3)) {
        let bound = if order == 2 { 1e-5 } else { 1e-10 };
        let errors = state - reference;
        assert!(errors.amax() < bound, "{method}: {errors}");
    }
}

/// No stage of a step is beyond a jump.
#[test]
fn methods_keep_their_order_where_a_motion_sticks_and_slips() {
    let model = Belt::<f64>::new(BeltParameters::default()).unwrap();
    let reference = last(&model, &(), 20.0, &STRICT).0;
    let coarse = by_each(&model, &(), (20.0, 0.02));
    let fine = by_each(&model, &(), (20.0, 0.01));
    for ((method, order, state, _), finer) in coarse.into_iter().zip(fine) {
        let [before, behind] = [state, finer.2].map(|it| (it - reference).amax());
        let found = (before / behind).log2();
        // Those of high order are at rounding.
        assert!(
            found > f64::from(order) - 0.4 || behind < 1e-10,
            "{method}: {before:e} {behind:e}"
        );
    }
}

#[test]
fn a_switched_force_takes_a_mass_along_a_reference() {
    let model = Follower::<f64>::new(FollowerParameters::default()).unwrap();
    let reference = Smooth(|t: f64| SVector::from([t.sin(), t.cos()]));
    let exact = last(&model, &reference, 4.0, &STRICT);
    for (method, order, state, outputs) in by_each(&model, &reference, (4.0, 0.01)) {
        let bound = if order == 2 { 3e-5 } else { 1e-9 };
        let errors = [(state - exact.0).amax(), (outputs - exact.1).amax()];
        assert!(errors.iter().all(|it| *it < bound), "{method}: {errors:?}");
    }
}

/// Each tick is a run of one step, with the force of that tick, and begins with nothing but the state.
#[test]
fn a_loop_with_a_clock_of_its_own_holds() {
    let model = Stacked::<f32>::new(StackedParameters::default()).unwrap();
    let tick = Fixed::new(Rk4, 1e-3);
    let mut state = model.initial_state();
    let mut speeds = Vec::new();
    for k in 0..4000 {
        let force = match k {
            1000..2000 => 12.0,
            2000.. => 0.0,
            _ => 0.9,
        };
        let input = Constant(SVector::from([force]));
        tick.integrate(&model, &input, 0.0, 1e-3, state, |step| {
            state = *step.state();
        })
        .unwrap();
        if k % 1000 == 999 {
            speeds.push(state);
        }
    }
    let expected = [[0.0, 0.0], [2.0, 9.0], [2.5, 7.5], [2.25, 6.75]];
    for (found, expected) in speeds.iter().zip(expected) {
        let errors = found - SVector::from(expected);
        assert!(errors.amax() < 5e-4, "{speeds:?}");
    }
    assert_eq!(speeds[0], SVector::from([0.0, 0.0]));
}

/// The time at which the load is caught has slopes, too.
#[test]
fn slopes_are_those_of_where_it_holds() {
    let slope = |end: f64, h: f64| {
        let run = |friction: f64| {
            let model = Block::new(BlockParameters { friction }).unwrap();
            last(&model, &(), end, &STRICT).0
        };
        (run(1.0 + h) - run(1.0 - h)) / (2.0 * h)
    };
    let dual = Block::<Dual<f64>>::new(BlockParameters {
        friction: Dual::variable(1.0),
    })
    .unwrap();
    for end in [9.0, 30.0] {
        let (state, _, _) = last(&dual, &(), end, &Fixed::new(Rk4, 0.01));
        let found = state.map(|it| it.slope);
        let errors = found - slope(end, 1e-4);
        assert!(errors.amax() < 1e-5, "{end}: {found} {errors}");
    }
}

/// Twelve at rest one after the other.
#[test]
fn many_hold_at_once() {
    let row = Row::<f64>::new(RowParameters::default()).unwrap();
    let start = SVector::from_fn(|block, _| 0.1 + 0.07 * block as f64);
    let mut end = start;
    Fixed::new(Rk4, 0.01)
        .integrate(&row, &(), 0.0, 3.0, start, |step| end = *step.state())
        .unwrap();
    assert!(end.amax() < 1e-12, "{end}");
}
