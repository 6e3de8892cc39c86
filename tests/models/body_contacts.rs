//! Contacts between bodies that both move.

use mbg_runtime::{Adaptive, Constant, Dop853, Dual, Integrator, Real, System, mbg};
use nalgebra::SVector;

use super::audit::{assert_sound_about_the_start, near};

mbg! {
    include "tests/models/body_contacts.mbg";
}

/// The outputs at the start and at the end.
fn ends<S, const N: usize, const P: usize>(model: &S, end: f64) -> [SVector<f64, P>; 2]
where
    S: System<f64, N, 0, P>,
{
    let mut shown = Vec::new();
    let times = [0.0, end];
    Adaptive::new(Dop853, 1e-11, 1e-13)
        .sample_outputs(
            model,
            &(),
            0.0,
            model.initial_state(),
            &times,
            |_, _, it| {
                shown.push(*it);
            },
        )
        .unwrap();
    [shown[0], shown[1]]
}

/// On a table that is screwed down all is as on a slope of the ground, whose plane is told otherwise.
#[test]
fn what_stands_still_is_the_ground() {
    let ground = OnGround::new(OnGroundParameters::default()).unwrap();
    let table = OnTable::new(OnTableParameters::default()).unwrap();
    let [ground, table] = [ends(&ground, 1.0), ends(&table, 1.0)].map(|it| it[1]);
    assert!((ground - table).amax() < 1e-9, "{ground} {table}");
    assert!(ground[0] > 1.0, "it touches");
}

/// Without loss speeds are exchanged by the masses.
#[test]
fn balls_bounce_off_each_other() {
    let balls = Balls::new(BallsParameters::default()).unwrap();
    let [_, end] = ends(&balls, 0.5);
    // The speed of the centre of mass stays, and those against it turn about.
    let centre = (0.5 * 2.0 - 0.8) / 1.3;
    near(end[1], 2.0 * centre - 2.0, 1e-9);
    near(end[4], 2.0 * centre + 1.0, 1e-9);
    // Of `μ v dv/dd = -k d (1 + a v)` the function `a v - ln(1 + a v)` is the same before and after.
    let dissipation = 0.3;
    let parameters = BallsParameters {
        dissipation,
        ..Default::default()
    };
    let [_, end] = ends(&Balls::new(parameters).unwrap(), 0.5);
    let held = |speed: f64| dissipation * speed - f64::ln_1p(dissipation * speed);
    near(held(end[1] - end[4]), held(3.0), 1e-7);
}

/// Whatever balls do to each other, what one gets the other one loses.
#[test]
fn balls_keep_their_momentum_and_moment_of_momentum() {
    let parameters = BallsParameters {
        friction: 0.4,
        dissipation: 0.2,
        beside: [0.05, 0.03],
        rate: [3.0, -2.0, 5.0],
        ..Default::default()
    };
    let balls = Balls::new(parameters).unwrap();
    let [start, end] = ends(&balls, 0.5);
    assert!((end - start).rows(7, 6).amax() < 1e-11, "{start} {end}");
    assert!((end - start).rows(1, 6).amin() > 0.1, "they met: {end}");
    let discs = Discs::new(DiscsParameters::default()).unwrap();
    let [start, end] = ends(&discs, 0.5);
    assert!((end - start).rows(1, 3).amax() < 1e-12, "{start} {end}");
}

/// On a table that turns at Ω a ball rolls on a circle in the other frame at 2/7 Ω, to and fro as the table turns: Burns, Am. J. Phys.
/// 49 (1981). Its velocity turns that fast, and does not change otherwise.
#[test]
fn a_ball_on_a_turntable_rolls_in_a_circle() {
    let model = Turntable::new(TurntableParameters::default()).unwrap();
    let rate = 2.0 / 7.0 * 3.0;
    for end in [0.5, 2.0, 3.5] {
        let [_, shown] = ends(&model, end);
        let turned = rate * end;
        let velocity = [-0.1 * f64::sin(turned), 0.1 * f64::cos(turned), 0.2];
        for (found, expected) in shown.rows(3, 3).iter().zip(velocity) {
            // What little friction asks for is slip.
            assert!((found - expected).abs() < 1e-5, "{end}: {shown}");
        }
        let radius = 0.1 / rate;
        let place = [
            0.3 - radius * (1.0 - f64::cos(turned)),
            radius * f64::sin(turned),
        ];
        for (found, expected) in shown.iter().zip(place) {
            assert!((found - expected).abs() < 1e-5, "{end}: {shown}");
        }
    }
}

#[test]
fn a_plane_has_the_contacts_of_space() {
    let flat = Carried::new(CarriedParameters::default()).unwrap();
    let space = CarriedInSpace::new(CarriedInSpaceParameters::default()).unwrap();
    let [flat, space] = [ends(&flat, 1.0), ends(&space, 1.0)].map(|it| it[1]);
    assert!((flat - space).amax() < 1e-8, "{flat} {space}");
    assert!(flat[0] > 1.0 && flat[1] > 0.2, "{flat}");
}

/// Friction of 0.4 · 0.5 · 9.81 N moves the stone with the plank as long as that is enough, and slows it down where it slips.
#[test]
fn friction_carries_a_stone_as_far_as_it_goes() {
    let model = Stack::new(StackParameters::default()).unwrap();
    let most = 0.4 * 9.81;
    for pull in [-3.0, 3.0, 9.7, 9.9, 20.0] {
        let mut places = SVector::zeros();
        let input = Constant(SVector::from([pull]));
        Adaptive::new(Dop853, 1e-10, 1e-12)
            .sample_outputs(
                &model,
                &input,
                0.0,
                model.initial_state(),
                &[1.0],
                |_, _, it| {
                    places = *it;
                },
            )
            .unwrap();
        let together: f64 = pull / 2.5;
        let expected = match together.abs() < most {
            true => [0.5 * together; 2],
            false => [0.5 * (pull - 0.5 * most) / 2.0, 0.5 * most],
        };
        let error = (places - SVector::from(expected)).amax();
        assert!(error < 1e-8, "{pull}: {places}");
    }
}

/// What falls has a power at all states, also where nothing touches.
#[test]
fn energies_balance_and_jacobians_are_right() {
    macro_rules! sound {
        ($($model:ident, $parameters:ident { $($name:ident: $value:expr),* };)*) => {$({
            let parameters = $parameters { $($name: $value,)* ..Default::default() };
            let dual = $parameters { $($name: Dual::from_f64($value),)* ..Default::default() };
            assert_sound_about_the_start((
                &$model::<f64>::new(parameters).unwrap(),
                &$model::<Dual<f64>>::new(dual).unwrap(),
            ));
        })*};
    }
    sound! {
        OnTable, OnTableParameters {};
        Balls, BallsParameters { falling: 9.81, friction: 0.3, away: 0.2 };
        Turntable, TurntableParameters {};
        Carried, CarriedParameters {};
        CarriedInSpace, CarriedInSpaceParameters {};
        Discs, DiscsParameters { falling: 9.81, away: 0.2 };
    }
}
