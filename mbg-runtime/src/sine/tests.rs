//! Errors against sums of two `f64`, with π/2 to 198 bits.

use super::*;
use crate::twofold::{Twofold, error, next, spread};

/// π/2 in parts of 33 bits.
const PARTS: [f64; 6] = [
    1.570_796_326_734_125_6,
    6.077_100_506_303_966e-11,
    2.022_266_248_711_166_5e-21,
    8.478_427_660_348_229e-32,
    2.067_032_109_450_824e-43,
    3.755_746_296_601_493_8e-53,
];

/// Sine and cosine of an angle below 10⁵ rad, by their series.
fn exact(angle: f64) -> [Twofold; 2] {
    let quadrants = (angle * core::f64::consts::FRAC_2_PI).round();
    let y = PARTS.iter().fold(Twofold(angle, 0.0), |y, part| {
        y.plus(Twofold(-quadrants * part, 0.0))
    });
    let square = y.times(y);
    let series = |start: Twofold, first: u32| {
        let (mut sum, mut term) = (start, start);
        for n in 0..14 {
            let n = f64::from(first + 2 * n);
            term = term.times(square).over(-n * (n + 1.0));
            sum = sum.plus(term);
        }
        sum
    };
    let (sine, cosine) = (series(y, 2), series(Twofold(1.0, 0.0), 1));
    match (quadrants as i64).rem_euclid(4) {
        0 => [sine, cosine],
        1 => [cosine, sine.flipped(true)],
        2 => [sine.flipped(true), cosine.flipped(true)],
        _ => [cosine.flipped(true), sine],
    }
}

/// The largest errors over the angles.
fn worst<T: Angle + Into<f64>>(angles: impl Iterator<Item = T>, bits: i32) -> [f64; 2] {
    let mut worst = [0.0_f64; 2];
    for angle in angles {
        let (sine, cosine) = sin_cos(angle);
        for (found, exact) in [sine, cosine].into_iter().zip(exact(angle.into())) {
            let error = error(found.into(), exact, bits);
            worst = [0, 1].map(|k| worst[k].max(error[k]));
        }
    }
    worst
}

/// The numbers next to multiples of π/2, where the reduction cancels most.
fn near_multiples(count: u32) -> impl Iterator<Item = f64> {
    (1..=count).map(|k| f64::from(k) * core::f64::consts::FRAC_PI_2)
}

#[test]
fn double_precision_stays_within_its_bounds() {
    for largest in [0.8, 10.0, 1000.0, 51_000.0] {
        let [relative, absolute] = worst(spread(largest), 52);
        assert!(
            relative < 1.6 && absolute < 2e-16,
            "{largest}: {relative} {absolute:e}"
        );
    }
    let near = near_multiples(32_000).flat_map(|angle| (-2..=2).map(move |k| next(angle, k)));
    let [relative, absolute] = worst(near.filter(|angle| *angle < 51_000.0), 52);
    assert!(
        relative < 1.6 && absolute < 2e-16,
        "{relative} {absolute:e}"
    );
}

#[test]
fn single_precision_stays_within_its_bounds() {
    for largest in [0.8, 10.0, 1600.0] {
        let [relative, absolute] = worst(spread(largest).map(|angle| angle as f32), 23);
        assert!(
            relative < 2.5 && absolute < 1.19e-7,
            "{largest}: {relative} {absolute:e}"
        );
    }
    let near = near_multiples(1018).flat_map(|angle| {
        (-2..=2).map(move |k| f32::from_bits((angle as f32).to_bits().wrapping_add_signed(k)))
    });
    let [relative, absolute] = worst(near, 23);
    assert!(
        relative < 2.5 && absolute < 1.19e-7,
        "{relative} {absolute:e}"
    );
}

#[test]
fn tiny_angles_are_their_own_sines() {
    for angle in [0.0, 5e-324, 1e-310, f64::MIN_POSITIVE, 1e-9] {
        assert_eq!(sin_cos(angle), (angle, 1.0));
        assert_eq!(sin_cos(-angle), (-angle, 1.0));
    }
    for angle in [0.0, 1e-45, f32::MIN_POSITIVE, 1e-5] {
        assert_eq!(sin_cos(angle), (angle, 1.0_f32));
    }
}

#[test]
fn far_angles_have_their_sine_too() {
    let cases: [(f64, f64, f64); 4] = [
        (1e22, -0.852_200_849_767_188_8, 0.523_214_785_395_139),
        (
            f64::MAX,
            0.004_961_954_789_184_062,
            -0.999_987_689_426_559_9,
        ),
        (
            123_456_789.0,
            0.990_114_751_802_035_5,
            0.140_259_681_533_909_64,
        ),
        (
            1_152_921_504_606_846_976.0,
            -0.830_649_217_637_254_6,
            -0.556_796_082_276_641_7,
        ),
    ];
    for (angle, sine, cosine) in cases {
        let found = sin_cos(angle);
        assert!(
            (found.0 - sine).abs() < 2e-16 && (found.1 - cosine).abs() < 2e-16,
            "{angle}"
        );
    }
    for angle in [51_001.0, -3e8, f64::MAX] {
        assert_eq!(sin_cos(angle), libm::sincos(angle));
    }
    for angle in [1601.0, -3e8, f32::MAX] {
        assert_eq!(sin_cos(angle), libm::sincosf(angle));
    }
}

#[test]
fn no_angle_gives_no_number() {
    for angle in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let (sine, cosine) = sin_cos(angle);
        assert!(sine.is_nan() && cosine.is_nan());
        let (sine, cosine) = sin_cos(angle as f32);
        assert!(sine.is_nan() && cosine.is_nan());
    }
}

/// Side by side or alone, far or not: the same bits.
fn assert_alone<const K: usize>(angles: [f64; K]) {
    let (sines, cosines) = f64::sines_cosines(angles);
    for (angle, found) in angles.into_iter().zip(sines.into_iter().zip(cosines)) {
        let (sine, cosine) = sin_cos(angle);
        let pairs = [(found.0, sine), (found.1, cosine)];
        let same = |(a, b): &(f64, f64)| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
        assert!(pairs.iter().all(same), "{angle} of {angles:?}");
    }
}

#[test]
fn several_are_what_each_is_alone() {
    let odd = [1e22, f64::NAN, f64::INFINITY, -0.0, 51_001.0, 2.5, -7.0];
    for (place, angle) in odd.into_iter().enumerate() {
        let next = odd[(place + 1) % odd.len()];
        assert_alone([angle]);
        assert_alone([0.3, angle]);
        assert_alone([angle, 0.3, 1.0]);
        assert_alone([0.3, 1.0, next, angle]);
        assert_alone([0.1, 0.2, 0.3, 0.4, angle]);
    }
}
