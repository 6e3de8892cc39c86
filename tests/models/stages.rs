//! Four stages of a step at once.

use mbg_runtime::lanes::f64x4;
use mbg_runtime::{Columns, Dual, Real, System};
use nalgebra::SVector;

use super::columns::{Mesh, MeshParameters};
use crate::ins::{Ins, InsParameters};

/// Each stage gives the bits of the derivative alone, at its own time, state and input.
fn assert_stages<T, S, const N: usize, const M: usize, const P: usize>(model: &S)
where
    T: Real,
    S: System<T, N, M, P>,
{
    let near = |mean: f64, seed: usize| {
        let number = |stage| mean + 0.3 * f64::sin((seed + 5 * stage) as f64);
        T::Stages::from_columns(|stage| T::from_f64(number(stage)))
    };
    let time = near(1.0, 2);
    let x = SVector::from_fn(|state, _| near(0.0, 3 + 7 * state));
    let u = SVector::from_fn(|input, _| near(2.0, 4 + 11 * input));
    let together = model.derivatives(time, &x, &u, &mut S::Memory::default());
    let mut memory = S::Memory::default();
    for stage in 0..4 {
        let x = x.map(|it| it.as_columns()[stage]);
        let u = u.map(|it| it.as_columns()[stage]);
        let alone = model.derivative(time.as_columns()[stage], &x, &u, &mut memory);
        let together = together.map(|it| it.as_columns()[stage]);
        assert_eq!(together, alone, "stage {stage}");
        assert!(alone.iter().all(|slope| slope.magnitude().is_finite()));
    }
}

fn assert_each<T: Real>() {
    assert_stages::<T, _, 9, 3, 3>(&Ins::new(InsParameters::default()).unwrap());
    assert_stages::<T, _, 52, 1, 1>(&Mesh::new(MeshParameters::default()).unwrap());
}

#[test]
fn stages_at_once_are_the_stages_alone() {
    assert_each::<f64>();
    assert_each::<f32>();
    assert_each::<Dual<f64>>();
    assert_each::<f64x4>();
}
