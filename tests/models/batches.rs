//! Batches by every instruction set that the machine has.

use mbg_runtime::batch::{Block, Instructions};
use mbg_runtime::lanes::{Lanes, f32x16, f64x8, unpack};
use mbg_runtime::{Convertible, FUSED, Real, System, mbg};
use nalgebra::SVector;

use super::closed::{FourBar, FourBarParameters};
use crate::arm::{Arm, ArmParameters};
use crate::ins::{Ins, InsParameters};
use crate::references::noise::noise;

mbg! {
    /// A pendulum; the angle may be large.
    model Pendulum {
        1 junction {
            I mass { inertia: 1.0 }
            C weight { effort: sin(weight.q) }
        }
    }
}

/// As many blocks as fill the cache more than once, with some left over.
const BLOCKS: usize = 19;

/// By how much of the largest rate the results of two instruction sets may differ, in units of precision.
const ROUNDING: f64 = 32.0;

/// The instruction sets against each state alone: the same bits where both round alike.
fn assert_batch<L, S, A, const N: usize, const M: usize, const P: usize>(
    model: &S,
    alone: impl Fn(usize) -> A,
    scales: [f64; N],
) where
    L: Block<Lane: Into<f64>>,
    S: Convertible<L, N, M, P, Memory = ()>,
    A: System<L::Lane, N, M, P, Memory = ()>,
{
    let mut next = noise(11);
    let mut number = |scale: f64| L::from_lanes(|_| L::Lane::from_f64(scale * next()));
    let states: Vec<SVector<L, N>> = (0..BLOCKS)
        .map(|_| SVector::from(scales.map(&mut number)))
        .collect();
    let inputs: Vec<SVector<L, M>> = states
        .iter()
        .map(|_| SVector::from_fn(|_, _| number(10.0)))
        .collect();
    let time = L::Lane::from_f64(0.0);
    for instructions in Instructions::available() {
        assert_eq!(
            instructions.for_model(model).to_string(),
            instructions.to_string()
        );
        let is_alike = FUSED || instructions.to_string() == "compiled";
        let mut rates = vec![SVector::from_element(L::from_f64(f64::NAN)); BLOCKS];
        instructions.derivatives(model, time, &states, &inputs, &mut rates);
        for (x, (u, rates)) in states.iter().zip(inputs.iter().zip(&rates)) {
            for lane in 0..L::COUNT {
                let (x, u) = (unpack(x, lane), unpack(u, lane));
                let expected = alone(lane).derivative(time, &x, &u, &mut ());
                let found = unpack(rates, lane).map(Into::into);
                let expected = expected.map(Into::into);
                let bound = if is_alike {
                    0.0
                } else {
                    ROUNDING * L::EPSILON * expected.amax()
                };
                let apart: SVector<f64, N> = found - expected;
                assert!(
                    apart.amax() <= bound,
                    "{instructions}: {apart:e} of {expected:e}"
                );
            }
        }
    }
}

/// Parameters that differ from lane to lane.
fn drag(lane: usize) -> f64 {
    1e3 + lane as f64
}

fn navigation<T: Real>(drag: T) -> Ins<T> {
    Ins::new(InsParameters {
        drag,
        ..InsParameters::default()
    })
    .unwrap()
}

#[test]
fn navigation_by_every_instruction_set() {
    let scales = [1e3, 1e3, 1e3, 10.0, 10.0, 10.0, 0.5, 0.5, 0.5];
    let model = navigation(f64x8::from_lanes(drag));
    assert_batch::<f64x8, _, _, _, _, _>(&model, |lane| navigation(drag(lane)), scales);
    let model = navigation(f32x16::from_lanes(|lane| drag(lane) as f32));
    assert_batch::<f32x16, _, _, _, _, _>(&model, |lane| navigation(drag(lane) as f32), scales);
}

#[test]
fn arm_by_every_instruction_set() {
    let model = Arm::<f64x8>::new(ArmParameters::default()).unwrap();
    let alone = Arm::<f64>::new(ArmParameters::default()).unwrap();
    assert_batch::<f64x8, _, _, _, _, _>(&model, |_| alone, [1.0; 14]);
}

#[test]
fn large_angles() {
    let model = Pendulum::<f64x8>::new(PendulumParameters::default()).unwrap();
    let alone = Pendulum::<f64>::new(PendulumParameters::default()).unwrap();
    assert_batch::<f64x8, _, _, _, _, _>(&model, |_| alone, [1e5; 2]);
}

#[test]
fn last_input_is_that_of_the_rest() {
    let model = Arm::<f64x8>::new(ArmParameters::default()).unwrap();
    let states = vec![model.initial_state(); 3];
    let inputs = [1.0, 2.0].map(|torque| SVector::from([f64x8::splat(torque); 7]));
    for instructions in Instructions::available() {
        let rates = |inputs: &[SVector<f64x8, 7>]| {
            let mut rates = vec![model.initial_state(); 2];
            instructions.derivatives(&model, 0.0, &states, inputs, &mut rates);
            rates
        };
        let [first, second] = [0, 1].map(|place| rates(&inputs[place..]));
        assert_eq!(second, vec![rates(&inputs)[1]; 2]);
        assert_eq!(first, rates(&inputs));
        assert_eq!(rates(&[]), rates(&[SVector::from([f64x8::ZERO; 7])]));
    }
}

#[test]
fn what_is_solved_takes_what_was_compiled() {
    let model = FourBar::<f64x8>::new(FourBarParameters::default()).unwrap();
    let x = model.initial_state();
    let u = SVector::from([]);
    for instructions in Instructions::available() {
        assert_eq!(instructions.for_model(&model).to_string(), "compiled");
        let mut rates = [x];
        instructions.derivatives(&model, 0.0, &[x], &[], &mut rates);
        assert_eq!(rates[0], model.derivative(f64x8::ZERO, &x, &u, &mut ()));
    }
}

#[test]
#[cfg(target_arch = "x86_64")]
fn widest_is_what_the_processor_has() {
    let has_avx2 = is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma");
    let has_avx512 = is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vbmi2");
    let names: Vec<_> = Instructions::available().map(|it| it.to_string()).collect();
    assert_eq!(names.contains(&"AVX2".into()), has_avx2);
    assert_eq!(names.contains(&"AVX-512".into()), has_avx512);
    assert_eq!(names.last(), Some(&Instructions::widest().to_string()));
}
