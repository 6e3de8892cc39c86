//! Our models.

use std::error::Error;
use std::path::Path;

use mbg_runtime::lanes::{Lanes, f32x8, f32x16, f64x4, f64x8, pack, unpack};
use mbg_runtime::{Real, System};
use nalgebra::{SMatrix, SVector};

use crate::contestant::{Contestant, Label, OURS, rows};
use crate::models::ins::{Ins, InsParameters};
use crate::models::{
    Arm, ArmParameters, Chain8, Chain8Parameters, Chain16, Chain16Parameters, Chain64,
    Chain64Parameters, FourBar, FourBarParameters,
};

type Scene<T, const N: usize, const M: usize> = (SVector<T, N>, SVector<T, M>);
type Linear<const N: usize> = (SVector<f64, N>, SMatrix<f64, N, N>);

fn label(name: &str, kind: &str, variant: &str, operations: usize) -> Label {
    Label {
        scene: format!("{name}-{kind}"),
        peer: OURS.into(),
        variant: variant.into(),
        operations: Some(operations),
    }
}

fn scenes<const N: usize, const M: usize>(rows: &[Vec<f64>]) -> Vec<Scene<f64, N, M>> {
    let part = |row: &Vec<f64>| {
        let (x, u) = row.split_at(N);
        (SVector::from_column_slice(x), SVector::from_column_slice(u))
    };
    rows.iter().map(part).collect()
}

// The code of peers cannot be inlined where it is called, so ours is not.

#[inline(never)]
fn derivative<T: Real, S: System<T, N, M, P>, const N: usize, const M: usize, const P: usize>(
    model: &S,
    (x, u): &Scene<T, N, M>,
    result: &mut SVector<T, N>,
) {
    model.derivative_into(T::from_f64(0.0), x, u, &mut S::Memory::default(), result);
}

#[inline(never)]
fn jacobian<S: System<f64, N, M, P>, const N: usize, const M: usize, const P: usize>(
    model: &S,
    (x, u): &Scene<f64, N, M>,
    result: &mut Linear<N>,
) {
    let (value, slope) = result;
    model.derivative_and_jacobian_into(0.0, x, u, &mut S::Memory::default(), value, slope);
}

/// What a model in `f64` takes part in, at rows of states of the scene of a name.
trait Contests<const N: usize, const M: usize, const P: usize>:
    System<f64, N, M, P> + Clone + 'static
{
    fn value(self, name: &str, rows: &[Vec<f64>]) -> Contestant {
        Contestant::single(
            label(name, "value", "f64", Self::META.operations.derivative),
            N,
            scenes(rows),
            SVector::zeros(),
            move |scene, result| derivative(&self, scene, result),
            |result| result.as_slice().to_vec(),
        )
    }

    fn value_and_jacobian(self, name: &str, rows: &[Vec<f64>]) -> Contestant {
        let operations = Self::META.operations.derivative_and_jacobian;
        Contestant::single(
            label(name, "jacobian", "f64", operations),
            N,
            scenes(rows),
            (SVector::zeros(), SMatrix::zeros()),
            move |scene, result| jacobian(&self, scene, result),
            |(value, slope)| [value.as_slice(), slope.as_slice()].concat(),
        )
    }

    /// A batch, one state at a time.
    fn in_turn(self, name: &str, rows: &[Vec<f64>]) -> Contestant {
        Contestant::batch(
            label(name, "batch", "f64", Self::META.operations.derivative),
            N,
            scenes(rows),
            1,
            SVector::zeros(),
            move |scene, result| derivative(&self, scene, result),
            |result, _| result.as_slice().to_vec(),
        )
    }
}

impl<S, const N: usize, const M: usize, const P: usize> Contests<N, M, P> for S where
    S: System<f64, N, M, P> + Clone + 'static
{
}

/// A batch in lanes.
fn in_lanes<L, S, const N: usize, const M: usize, const P: usize>(
    name: &str,
    variant: &str,
    rows: &[Vec<f64>],
    model: S,
) -> Contestant
where
    L: Lanes + 'static,
    f64: From<L::Lane>,
    S: System<L, N, M, P> + Clone + 'static,
{
    let scenes = scenes::<N, M>(rows);
    let lanes = scenes.chunks(L::COUNT).map(|scenes| {
        let states: Vec<_> = scenes
            .iter()
            .map(|(x, _)| x.map(L::Lane::from_f64))
            .collect();
        let inputs: Vec<_> = scenes
            .iter()
            .map(|(_, u)| u.map(L::Lane::from_f64))
            .collect();
        (pack(&states), pack(&inputs))
    });
    let contestant = Contestant::batch(
        label(name, "batch", variant, S::META.operations.derivative),
        N,
        lanes.collect(),
        L::COUNT,
        SVector::<L, N>::from_element(L::from_f64(0.0)),
        move |scene, result| derivative(&model, scene, result),
        |result, lane| unpack(result, lane).iter().map(|x| f64::from(*x)).collect(),
    );
    // Rounding of the scalar, times what the arm's equations make of it.
    let tolerance = if L::EPSILON < 1e-10 { 1e-11 } else { 1e-3 };
    Contestant {
        tolerance,
        ..contestant
    }
}

macro_rules! lanes {
    ($contestants:ident, $name:literal, $rows:expr, $model:ident, $parameters:ident: $($lanes:ident),*) => { $(
        let model = $model::<$lanes>::new($parameters::default())?;
        $contestants.push(in_lanes::<$lanes, _, _, _, _>($name, stringify!($lanes), $rows, model));
    )* };
}

/// All of ours.
pub(crate) fn contestants(folder: &Path) -> Result<Vec<Contestant>, Box<dyn Error>> {
    let ins = Ins::new(InsParameters::default())?;
    let arm = Arm::new(ArmParameters::default())?;
    let four_bar = FourBar::new(FourBarParameters::default())?;
    let chain8 = Chain8::new(Chain8Parameters::default())?;
    let chain16 = Chain16::new(Chain16Parameters::default())?;
    let chain64 = Chain64::new(Chain64Parameters::default())?;
    let (navigation, poses) = (rows(folder, "ins")?, rows(folder, "arm")?);
    let mut found = vec![
        ins.value("ins", &navigation[..64]),
        ins.value_and_jacobian("ins", &navigation[..64]),
        chain8.value("chain8", &rows(folder, "chain8")?),
        chain16.value("chain16", &rows(folder, "chain16")?),
        chain64.value("chain64", &rows(folder, "chain64")?),
        arm.value("arm", &poses[..64]),
        arm.value_and_jacobian("arm", &poses[..64]),
        four_bar.value("fourbar", &rows(folder, "fourbar")?),
        ins.in_turn("ins", &navigation),
        arm.in_turn("arm", &poses),
    ];
    lanes!(found, "ins", &navigation, Ins, InsParameters: f64x4, f64x8, f32x8, f32x16);
    lanes!(found, "arm", &poses, Arm, ArmParameters: f64x4, f64x8, f32x8, f32x16);
    Ok(found)
}
