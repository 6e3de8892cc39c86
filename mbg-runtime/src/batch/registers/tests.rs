use std::vec::Vec;

use fearless_simd::Level;

use super::*;
use crate::lanes::Lanes;
use crate::lanes::tests::{everything, numbers};

/// Places in `everything` of what is rounded once or twice: a product added to, sine and cosine, exponential, hyperbolic
/// tangent.
const FUSED: usize = 6;
const ANGLES: [usize; 2] = [7, 8];
const EXPONENTIAL: usize = 13;
const TANGENT: usize = 16;

/// Registers of numbers of all sizes, some of them special, against each number alone.
fn assert_registers<L, R>()
where
    L: Lanes<Lane: Into<f64>>,
    R: Registers<L>,
{
    let mut number = numbers();
    for _ in 0..500 {
        let [a, b] = [0, 1].map(|_| L::from_lanes(|_| L::Lane::from_f64(number())));
        let mut together = everything(a, b);
        for part in 0..R::PARTS {
            let found = everything(R::part(&a, part), R::part(&b, part));
            for (found, block) in found.into_iter().zip(&mut together) {
                found.put(block, part);
            }
        }
        for lane in 0..L::COUNT {
            let (a, b) = (a.lane(lane), b.lane(lane));
            let alone = everything(a, b);
            for (place, (together, alone)) in together.iter().zip(alone).enumerate() {
                let (together, mut alone): (f64, f64) = (together.lane(lane).into(), alone.into());
                if place == FUSED && !cfg!(feature = "reproducible") {
                    alone = once_rounded(a, b).into();
                }
                let bound = L::EPSILON * epsilons(place, alone);
                let same = together == alone || (together - alone).abs() <= bound;
                let signs = together.is_sign_negative() == alone.is_sign_negative() || bound > 0.0;
                let neither = together.is_nan() && alone.is_nan();
                assert!(
                    (same && signs) || neither,
                    "{place} of {a:?}, {b:?}: {together:e} is not {alone:e}"
                );
            }
        }
    }
}

/// What the evaluations of this crate differ by, at most, where products are rounded once in registers and twice alone.
fn epsilons(place: usize, value: f64) -> f64 {
    match place {
        _ if crate::FUSED || cfg!(feature = "reproducible") => 0.0,
        place if ANGLES.contains(&place) => 2.0,
        EXPONENTIAL => 2.0 * value.abs(),
        TANGENT => 5.4 * value.abs(),
        _ => 0.0,
    }
}

/// `a · b + a`, rounded once.
fn once_rounded<T: Real + Into<f64>>(a: T, b: T) -> T {
    let (a, b): (f64, f64) = (a.into(), b.into());
    if T::EPSILON == f64::EPSILON {
        T::from_f64(a.mul_add(b, a))
    } else {
        let (a, b) = (a as f32, b as f32);
        T::from_f64(a.mul_add(b, a).into())
    }
}

fn assert_set<S: Proven>(set: S) {
    vectorised(
        set,
        #[inline(always)]
        || {
            assert_registers::<f64x8, Doubles<S>>();
            assert_registers::<f32x16, Singles<S>>();
        },
    );
}

#[test]
fn every_lane_gives_what_its_number_gives_alone() {
    let level = Level::new();
    if let Some(set) = level.as_avx2() {
        assert_set(set);
    }
    if let Some(set) = level.as_avx512() {
        assert_set(set);
    }
}

#[test]
fn find_asks_lanes_in_order() {
    let Some(set) = Level::new().as_avx2() else {
        return;
    };
    set.keep();
    let block = f32x16::from_lanes(|lane| lane as f32);
    let parts: Vec<_> = (0..2)
        .map(|part| Singles::<Avx2>::part(&block, part))
        .collect();
    assert_eq!(parts[1].find(|number| number > 2.5), Some(8.0));
    assert_eq!(parts[0].find(|number| number > 8.0), None);
}
