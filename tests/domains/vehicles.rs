//! A quarter of a car over a bump.

use mbg_runtime::{Smooth, System, mbg};
use nalgebra::SVector;

use super::balance;

mbg! {
    include "examples/gallery/quarter_car.mbg";
}

/// Time in s; body and wheel, places in m and speeds in m/s: by the matrix exponential, to 18 digits.
const REFERENCE: [(f64, [f64; 4]); 5] = [
    (
        0.25,
        [
            0.003_978_623_658_877_178,
            0.068_329_536_161_223_73,
            0.304_221_659_642_314_4,
            2.864_302_328_272_726_3,
        ],
    ),
    (
        0.3,
        [
            0.023_271_101_981_824_974,
            0.007_430_143_419_377_675,
            0.143_164_906_356_639_17,
            -4.058_584_208_427_614,
        ],
    ),
    (
        0.5,
        [
            0.015_659_385_002_565_947,
            -0.001_898_637_307_406_944,
            -0.116_048_209_132_505_04,
            -0.036_900_140_974_444_58,
        ],
    ),
    (
        1.0,
        [
            -0.004_860_916_939_668_373,
            -8.926_787_825_421_767e-5,
            0.053_493_890_125_185_42,
            0.004_600_913_145_093_187,
        ],
    ),
    (
        3.0,
        [
            0.000_130_986_880_795_490_08,
            1.763_707_080_925_971_2e-5,
            0.001_288_418_465_547_484,
            4.150_802_851_776_413e-5,
        ],
    ),
];

/// The speed of the road under the wheel: a cosine of 8 cm over 0.6 m, passed at 6 m/s from 0.2 s on.
fn road(t: f64) -> SVector<f64, 1> {
    let omega = std::f64::consts::TAU * 6.0 / 0.6;
    let over = (0.2..0.3).contains(&t);
    SVector::from([if over {
        0.04 * omega * f64::sin(omega * (t - 0.2))
    } else {
        0.0
    }])
}

#[test]
fn a_quarter_car_passes_a_bump() {
    let model = QuarterCar::<f64>::new(QuarterCarParameters::default()).unwrap();
    let h = 5e-5;
    for (time, expected) in REFERENCE {
        let steps = (time / h).round() as u32;
        let (x, imbalance) = balance::run(&model, &Smooth(road), h, steps);
        let found = model.output(time, &x, &road(time), &mut Default::default());
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-9, "{time} {found} {expected}");
        }
        assert!(imbalance < 1e-9, "{imbalance:e}");
    }
}
