//! The inertial navigation system of the paper.

use mbg_runtime::lanes::{Lanes, f32x8, f64x4, pack, unpack};
use mbg_runtime::{Dual, Real, System, Trouble};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use crate::ins::{
    Ins, InsClassic, InsClassicObserved, InsClassicObservedParameters, InsClassicParameters,
    InsObserved, InsObservedParameters, InsParameters, gust,
};
use crate::reference;
use crate::references::errors::apart;
use crate::references::noise::noise;
use crate::run::{Method, errors, run};

fn proposed() -> Ins {
    Ins::new(InsParameters::default()).unwrap()
}

fn classic() -> InsClassic {
    InsClassic::new(InsClassicParameters::default()).unwrap()
}

fn random_state(next: &mut impl FnMut() -> f64) -> SVector<f64, 9> {
    loop {
        let x = SVector::from_fn(|row, _| match row {
            0..3 => 1000.0 * next(),
            3..6 => 10.0 * next(),
            _ => std::f64::consts::PI * next(),
        });
        if f64::cos(x[7]).abs() > 0.1 {
            return x;
        }
    }
}

/// Both architectures against the reference, all quantities, both gusts; the architectures are one program.
fn meet_the_reference(method: Method, step: f64, bound: f64) {
    let first = InsObserved::new(InsObservedParameters::default()).unwrap();
    let second = InsClassicObserved::new(InsClassicObservedParameters::default()).unwrap();
    for (width, reference) in [(0.1, &reference::PULSE[..]), (1.0, &reference::LONG[..])] {
        let first = run(&first, method, &gust(width), step, 20.0).unwrap();
        let second = run(&second, method, &gust(width), step, 20.0).unwrap();
        for (name, error) in errors(&first, reference) {
            assert!(error < bound, "{name}: {error:e} for a gust of {width} s");
        }
        for (a, b) in first.iter().zip(&second) {
            assert_eq!(a.output, b.output, "the architectures are one program");
        }
    }
}

#[test]
fn rk4_meets_the_reference() {
    meet_the_reference(Method::Rk4, 1e-3, 1e-12);
}

#[test]
fn the_adaptive_pair_meets_the_reference() {
    meet_the_reference(Method::Dop853(1e-10), 1e-2, 1e-10);
}

/// The equations by hand, in matrices: Newton and Euler, `α̇ = J⁻¹(C ω_p − ω_f)`, `τ = −J⁻ᵀ e`.
fn by_hand(x: &SVector<f64, 9>, u: &SVector<f64, 3>) -> SVector<f64, 9> {
    let part = |first: usize| Vector3::new(x[first], x[first + 1], x[first + 2]);
    let (hull, body, alpha) = (part(0), part(3), part(6));
    let (fuselage, platform) = (
        hull.component_div(&Vector3::new(1e4, 1e4, 5e3)),
        body / 10.0,
    );
    let turn = mbg_runtime::attitude::rotation_xyz(&alpha);
    let ((s1, c1), (s2, c2)) = (alpha[0].sin_cos(), alpha[1].sin_cos());
    let jacobian = Matrix3::new(1.0, 0.0, s2, 0.0, c1, -c2 * s1, 0.0, s1, c1 * c2);
    let inverse = jacobian.try_inverse().unwrap();
    let rate = inverse * (turn * platform - fuselage);
    let torque = -(inverse.transpose() * (alpha * 1e-5 + rate * 1e-5));
    let hull_rate = u - fuselage * 1e3 - torque - fuselage.cross(&hull);
    // The platform is isotropic: ω × Jω is zero, but would be rounding of Jω far above its torque.
    let body_rate = turn.transpose() * torque;
    SVector::from_fn(|row, _| [hull_rate, body_rate, rate][row / 3][row % 3])
}

#[test]
fn derivative_equals_an_independent_evaluation() {
    let mut next = noise(1);
    let (first, second) = (proposed(), classic());
    for number in 0..10_000 {
        let mut x = random_state(&mut next);
        if number % 100 == 0 {
            (x[6], x[8]) = (std::f64::consts::FRAC_PI_2, std::f64::consts::FRAC_PI_2);
        }
        let u = SVector::from_fn(|_, _| 100.0 * next());
        let ours = first.derivative(0.0, &x, &u, &mut ());
        assert_eq!(ours, second.derivative(0.0, &x, &u, &mut ()));
        let theirs = by_hand(&x, &u);
        for block in 0..3 {
            let rows = 3 * block..3 * block + 3;
            let difference = apart(&ours.as_slice()[rows.clone()], &theirs.as_slice()[rows]);
            let scale = theirs.fixed_rows::<3>(3 * block).amax();
            assert!(
                difference <= 1e-13 * scale,
                "block {block}: {difference:e} of {scale:e}"
            );
        }
    }
}

#[test]
fn the_singular_set_is_the_cosine_of_the_second_angle() {
    let mut next = noise(2);
    for _ in 0..100 {
        let x = random_state(&mut next);
        let u = SVector::zeros();
        let cosine = Real::cos(x[7]);
        assert_eq!(proposed().conditioning(0.0, &x, &u), [cosine]);
        assert_eq!(classic().conditioning(0.0, &x, &u), [cosine]);
        assert_eq!(proposed().examined(0.0, &x, &u, &()), Ok([cosine]));
    }
    let mut locked = SVector::<f64, 9>::zeros();
    locked[7] = std::f64::consts::FRAC_PI_2;
    let trouble = proposed()
        .trouble(0.0, &locked, &SVector::zeros(), &())
        .unwrap();
    let examined = proposed().examined(0.0, &locked, &SVector::zeros(), &());
    assert_eq!(examined, Err(trouble));
    assert!(
        matches!(
            trouble,
            Trouble::Singular {
                name: "cos(gimbals.spring.q.y)",
                ..
            }
        ),
        "{trouble}"
    );
}

#[test]
fn the_program_is_small() {
    for meta in [
        <Ins as System<f64, 9, 3, 3>>::META,
        <InsClassic as System<f64, 9, 3, 3>>::META,
    ] {
        assert!(
            meta.operations.derivative <= 100,
            "{}",
            meta.operations.derivative
        );
        assert_eq!(meta.operations.angles, 3);
    }
    assert_eq!(<Ins as System<f64, 9, 3, 3>>::META.dependent.len(), 0);
    assert_eq!(
        <InsClassic as System<f64, 9, 3, 3>>::META.dependent,
        ["bodies.body"]
    );
}

#[test]
fn jacobians_equal_dual_numbers() {
    let mut next = noise(3);
    let model = proposed();
    let parameters = InsParameters {
        drag: 1e3,
        stiffness: 1e-5,
        damping: 1e-5,
    };
    let dual = Ins::new(InsParameters {
        drag: Dual::constant(parameters.drag),
        stiffness: Dual::constant(parameters.stiffness),
        damping: Dual::constant(parameters.damping),
    })
    .unwrap();
    for _ in 0..100 {
        let x = random_state(&mut next);
        let u = SVector::<f64, 3>::from_fn(|_, _| 100.0 * next());
        let state: SMatrix<f64, 9, 9> = model.jacobian_state(0.0, &x, &u, &mut ());
        let input: SMatrix<f64, 9, 3> = model.jacobian_input(0.0, &x, &u, &mut ());
        for column in 0..12 {
            let seed = |value: f64, here: bool| {
                if here {
                    Dual::variable(value)
                } else {
                    Dual::constant(value)
                }
            };
            let xs = SVector::<Dual<f64>, 9>::from_fn(|row, _| seed(x[row], row == column));
            let us = SVector::<Dual<f64>, 3>::from_fn(|row, _| seed(u[row], row + 9 == column));
            let slopes = dual.derivative(Dual::constant(0.0), &xs, &us, &mut ());
            for row in 0..9 {
                let ours = if column < 9 {
                    state[(row, column)]
                } else {
                    input[(row, column - 9)]
                };
                let scale = slopes[row].slope.abs().max(1.0);
                assert!(
                    (ours - slopes[row].slope).abs() <= 1e-12 * scale,
                    "({row}, {column})"
                );
            }
        }
    }
}

/// Models of different parameters at different states, in lanes and each alone.
fn assert_lanes<L: Lanes>() {
    let mut next = noise(7);
    for _ in 0..50 {
        let runs: Vec<_> = (0..L::COUNT)
            .map(|_| {
                let parameters = [1e3, 1.0, 1.0].map(|scale| scale * (2.0 + next()));
                let x = random_state(&mut next).map(L::Lane::from_f64);
                let u = SVector::<f64, 3>::from_fn(|_, _| 100.0 * next());
                (parameters, x, u.map(L::Lane::from_f64))
            })
            .collect();
        let together =
            |number: usize| L::from_lanes(|lane| L::Lane::from_f64(runs[lane].0[number]));
        let model = Ins::<L>::new(InsParameters {
            drag: together(0),
            stiffness: together(1),
            damping: together(2),
        });
        let states: Vec<_> = runs.iter().map(|run| run.1).collect();
        let inputs: Vec<_> = runs.iter().map(|run| run.2).collect();
        let (x, u): (SVector<L, 9>, SVector<L, 3>) = (pack(&states), pack(&inputs));
        let found = model.unwrap().derivative(L::from_f64(0.0), &x, &u, &mut ());
        for (lane, ([drag, stiffness, damping], x, u)) in runs.iter().enumerate() {
            let alone = Ins::new(InsParameters {
                drag: L::Lane::from_f64(*drag),
                stiffness: L::Lane::from_f64(*stiffness),
                damping: L::Lane::from_f64(*damping),
            });
            let time = L::Lane::from_f64(0.0);
            let alone = alone.unwrap().derivative(time, x, u, &mut ());
            assert_eq!(unpack(&found, lane), alone);
        }
    }
}

#[test]
fn lanes_give_what_each_model_gives_alone() {
    assert_lanes::<f64x4>();
    assert_lanes::<f32x8>();
}
