//! Networks of bodies that rub at each other and at the ground, at random.

use mbg_runtime::mbg;

use super::several::by_all;

mbg! {
    /// Three bodies, each pair of which rubs, and each at the ground.
    model Network {
        param mass_a = 1.0; param mass_b = 1.0; param mass_c = 1.0;
        param speed_a = 0.0; param speed_b = 0.0; param speed_c = 0.0;
        param force_a = 0.0; param force_b = 0.0; param force_c = 0.0;
        param most_ab = 0.0; param most_bc = 0.0; param most_ca = 0.0;
        param most_a = 0.0; param most_b = 0.0; param most_c = 0.0;
        1 a { I body { inertia: mass_a, initial_flow: speed_a } Se force { effort: force_a } }
        1 b { I other { inertia: mass_b, initial_flow: speed_b } Se push { effort: force_b } }
        1 c { I third { inertia: mass_c, initial_flow: speed_c } Se pull { effort: force_c } }
        ab: Clutch { capacity: most_ab } (a, b);
        bc: Clutch { capacity: most_bc } (b, c);
        ca: Clutch { capacity: most_ca } (c, a);
        at_a: Brake { capacity: most_a } (a);
        at_b: Brake { capacity: most_b } (b);
        at_c: Brake { capacity: most_c } (c);
        output speeds[3] = [a.f, b.f, c.f];
    }
}

/// How the slips go by the speeds.
const SLIPS: [[f64; 3]; 6] = [
    [1.0, -1.0, 0.0],
    [0.0, 1.0, -1.0],
    [-1.0, 0.0, 1.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
];
/// Which of them there are in a kind of network.
const KINDS: [&[usize]; 4] = [&[0, 1], &[0, 1, 2], &[0, 1, 3, 4], &[0, 1, 2, 3, 4, 5]];

#[derive(Debug)]
struct Rubbing {
    masses: [f64; 3],
    speeds: [f64; 3],
    forces: [f64; 3],
    most: [f64; 6],
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl Rubbing {
    /// Of a kind, by numbers from 0 to 1.
    fn at_random(kind: &[usize], mut next: impl FnMut() -> f64) -> Self {
        let masses = [(); 3].map(|()| 0.5 + 2.0 * next());
        let rests = [(); 3].map(|()| next() < 0.4);
        let speeds = rests.map(|rests| if rests { 0.0 } else { 2.0 * next() - 1.0 });
        let forces = [(); 3].map(|()| 8.0 * next() - 4.0);
        let mut most = [0.0; 6];
        for place in kind {
            most[*place] = 0.3 + 2.0 * next();
        }
        Self {
            masses,
            speeds,
            forces,
            most,
        }
    }

    /// By all methods as by pieces of uniform acceleration.
    fn assert_moves_rightly(&self) {
        let expected = self.speeds(2.0);
        for (name, _, speeds) in by_all(&self.model(), 2.0, 1e-8, 0.1) {
            let errors: [f64; 3] = core::array::from_fn(|body| speeds[body] - expected[body]);
            let error = errors
                .iter()
                .fold(0.0_f64, |most, error| most.max(error.abs()));
            assert!(error < 1e-11, "{name}: {errors:?} in {self:?}");
        }
    }

    fn model(&self) -> Network<f64> {
        let ([mass_a, mass_b, mass_c], [speed_a, speed_b, speed_c]) = (self.masses, self.speeds);
        let [force_a, force_b, force_c] = self.forces;
        let [most_ab, most_bc, most_ca, most_a, most_b, most_c] = self.most;
        Network::new(NetworkParameters {
            mass_a,
            mass_b,
            mass_c,
            speed_a,
            speed_b,
            speed_c,
            force_a,
            force_b,
            force_c,
            most_ab,
            most_bc,
            most_ca,
            most_a,
            most_b,
            most_c,
        })
        .unwrap()
    }

    /// How fast the speeds change where slips have these signs, or are held: of all efforts that friction allows, those by which the
    /// bodies accelerate least (Gauss), one after the other until none changes.
    fn accelerations(&self, signs: &[f64; 6]) -> [f64; 3] {
        let mut efforts: [f64; 6] = core::array::from_fn(|place| self.most[place] * signs[place]);
        let by = |efforts: &[f64; 6]| {
            core::array::from_fn(|body| {
                let slips = SLIPS.iter().zip(efforts);
                let rubs: f64 = slips.map(|(slip, effort)| slip[body] * effort).sum();
                (self.forces[body] - rubs) / self.masses[body]
            })
        };
        for _ in 0..100_000 {
            let mut change = 0.0_f64;
            for place in (0..6).filter(|place| signs[*place] == 0.0) {
                let (slip, most) = (&SLIPS[place], self.most[place]);
                let mobility: f64 = slip
                    .iter()
                    .zip(&self.masses)
                    .map(|(by, mass)| by * by / mass)
                    .sum();
                let effort = efforts[place] + dot(slip, &by(&efforts)) / mobility;
                let effort = effort.clamp(-most, most);
                change = change.max((effort - efforts[place]).abs());
                efforts[place] = effort;
            }
            if change < 1e-15 {
                break;
            }
        }
        by(&efforts)
    }

    /// The speeds at an end, from one time to the next at which a slip is over.
    fn speeds(&self, end: f64) -> [f64; 3] {
        let (mut speeds, mut left) = (self.speeds, end);
        while left > 1e-13 {
            let signs = SLIPS.map(|slip| {
                let slip = dot(&slip, &speeds);
                if slip.abs() > 1e-10 {
                    slip.signum()
                } else {
                    0.0
                }
            });
            let accelerations = self.accelerations(&signs);
            let over = SLIPS.iter().zip(&signs).filter_map(|(slip, sign)| {
                let (slip, rate) = (dot(slip, &speeds), dot(slip, &accelerations));
                (slip * rate < 0.0 && *sign != 0.0).then(|| -slip / rate)
            });
            let next = over.fold(left, f64::min);
            for (speed, rate) in speeds.iter_mut().zip(accelerations) {
                *speed += next * rate;
            }
            left -= next;
        }
        speeds
    }
}

/// Bodies are caught, carried along, torn loose and stopped, several at once and where slips tell of each other.
#[test]
fn what_rubs_in_a_network_holds_where_it_can() {
    let mut state = 1_u64;
    let mut next = move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    for number in 0..200 {
        let network = Rubbing::at_random(KINDS[number % KINDS.len()], &mut next);
        network.assert_moves_rightly();
    }
}

/// So near to rest that rounding of where it is hides where lines beside it go across slips.
#[test]
fn bodies_that_stick_to_each_other_come_to_rest_together() {
    let network = Rubbing {
        masses: [
            0.626_531_390_279_514,
            1.637_038_181_651_148,
            2.249_366_281_230_413_4,
        ],
        speeds: [
            -0.293_104_958_585_284_5,
            0.549_490_454_896_891_5,
            -0.100_617_931_379_528_79,
        ],
        forces: [
            1.964_042_323_909_441_6,
            0.034_729_955_083_479_425,
            -0.228_183_276_044_193_3,
        ],
        most: [
            1.971_381_970_758_491,
            1.870_970_794_364_654_5,
            0.0,
            2.246_359_326_118_059,
            1.825_605_289_828_892_1,
            0.0,
        ],
    };
    network.assert_moves_rightly();
}

/// The second body comes to rest fast, and is almost torn loose as soon as it rests: it would go on only slowly.
#[test]
fn what_is_almost_torn_loose_holds_where_it_comes_to_rest() {
    let network = Rubbing {
        masses: [
            1.917_882_181_761_946_7,
            1.549_019_348_111_686_3,
            1.001_763_950_495_090_4,
        ],
        speeds: [0.781_663_268_574_989_4, -0.803_900_549_428_932_9, 0.0],
        forces: [
            -0.722_391_617_332_118_8,
            -0.261_666_805_521_045_4,
            3.830_844_067_977_485,
        ],
        most: [
            0.670_063_133_569_239_7,
            0.941_523_882_327_476_7,
            0.0,
            1.859_316_145_455_19,
            1.354_108_181_753_719_5,
            0.0,
        ],
    };
    network.assert_moves_rightly();
}

/// The brake of the third body takes nothing: it is passed where the second one comes to rest, as the clutch between both lets go.
#[test]
fn a_brake_that_takes_nothing_does_not_hide_that_others_let_go() {
    let first = Rubbing {
        masses: [
            1.523_913_176_536_917_4,
            2.173_424_076_436_37,
            2.458_440_553_766_414,
        ],
        speeds: [
            -0.532_650_022_752_237_9,
            0.825_489_629_666_864_8,
            0.672_234_373_048_651_7,
        ],
        forces: [
            -3.790_489_352_982_716,
            1.542_881_611_251_142_5,
            -2.661_373_144_760_158,
        ],
        most: [
            1.875_910_024_025_561_7,
            1.827_505_548_339_572_1,
            0.0,
            1.540_318_803_325_107_4,
            1.797_833_504_428_656_2,
            0.0,
        ],
    };
    let second = Rubbing {
        masses: [
            1.322_486_213_879_897_6,
            2.110_123_880_131_340_4,
            2.447_466_265_944_955,
        ],
        speeds: [
            -0.982_809_990_857_851_1,
            0.092_718_771_442_847_9,
            -0.811_433_534_263_712_7,
        ],
        forces: [
            -3.344_701_076_413_113,
            2.354_988_561_245_974_7,
            3.488_817_391_317_486,
        ],
        most: [
            0.351_345_596_975_703_94,
            1.193_101_401_566_865,
            0.0,
            0.927_799_362_521_263_9,
            1.508_968_497_054_634_2,
            0.0,
        ],
    };
    first.assert_moves_rightly();
    second.assert_moves_rightly();
}

/// The first and the third body turn alike because each turns as the second one does: a clutch between both that takes nothing is not
/// met again and again by rounding.
#[test]
fn a_clutch_that_takes_nothing_is_not_met_between_bodies_that_hold() {
    let network = Rubbing {
        masses: [
            2.124_814_500_424_727,
            2.350_806_601_393_452_3,
            1.218_224_831_005_212_8,
        ],
        speeds: [-0.312_012_759_614_524_1, 0.0, 0.0],
        forces: [
            3.130_043_501_348_435_3,
            2.671_024_805_383_960_5,
            2.881_859_336_064_618_3,
        ],
        most: [
            1.817_504_720_938_314_4,
            1.130_610_882_812_028_3,
            0.0,
            0.0,
            0.0,
            0.0,
        ],
    };
    network.assert_moves_rightly();
}

/// At rest numbers tell of any distance: what is torn loose begins as far beside the others as they are asked.
#[test]
fn what_is_torn_loose_from_rest_begins_beside_what_holds() {
    let pulled_by_one = Rubbing {
        masses: [
            2.282_737_769_213_466_3,
            1.494_979_418_053_232_5,
            1.452_539_658_012_940_6,
        ],
        speeds: [0.0; 3],
        forces: [
            -2.437_727_582_057_427,
            2.317_385_404_746_854_5,
            1.304_359_624_326_977_5,
        ],
        most: [
            1.357_764_691_197_120_6,
            0.315_757_275_281_39,
            0.0,
            1.242_659_795_551_698_7,
            2.037_065_799_045_465,
            0.0,
        ],
    };
    let pulled_by_all = Rubbing {
        masses: [
            2.071_509_430_792_905,
            0.936_143_276_323_725_8,
            1.509_206_980_824_132,
        ],
        speeds: [0.0; 3],
        forces: [
            -2.615_145_164_776_955_7,
            3.919_416_150_512_382,
            -2.171_596_474_451_525_3,
        ],
        most: [
            1.466_567_118_512_856_4,
            1.109_022_523_610_149_2,
            1.832_260_545_050_312_7,
            1.567_623_849_962_226_4,
            0.791_994_593_189_172_3,
            1.441_082_940_451_699_4,
        ],
    };
    pulled_by_one.assert_moves_rightly();
    pulled_by_all.assert_moves_rightly();
}
