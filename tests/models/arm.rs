//! Robots out of their URDF files and out of their parameters, against recursive Newton-Euler.

use mbg_runtime::{Smooth, System, mbg};
use mbg_urdf::Options;
use nalgebra::SVector;

use super::energy::imbalance;
use crate::arm::{Arm, ArmParameters};
use crate::references::errors::larger;
use crate::references::noise::noise;
use crate::references::robots::{panda, winder};
use crate::references::tree::{self, Link};

mbg! {
    include "examples/arm/serial.mbg";
    include "tests/robots/winder.mbg";

    /// The arm of `panda.urdf` from its parameters.
    pub(crate) model Serial {
        causality componentwise;
        gravity [0.0, 0.0, -9.81];
        input torque[7]: N*m;
        1 base[6];
        Sf ground[6] { flow: 0.0 } -> base;
        arm: SerialArm {
            torque: torque,
            damping: 0.003,
            cosine: [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            sine: [0.0, -1.0, 1.0, 1.0, -1.0, 1.0, 1.0],
            length: [0.0, 0.0, 0.0, 0.0825, -0.0825, 0.0, 0.088],
            offset: [0.333, 0.0, 0.316, 0.0, 0.384, 0.0, 0.0],
            mass: [4.970684, 0.646926, 3.228604, 3.587895, 1.225946, 1.666555, 1.495522],
            centre_x: [0.003875, -0.003141, 0.027518, -0.05317, -0.011953, 0.060149, 0.0017208743],
            centre_y: [0.002081, -0.02872, 0.039252, 0.104419, 0.041065, -0.014117, 0.00136035442],
            centre_z: [-0.04762, 0.003495, -0.066502, 0.027454, -0.038437, -0.010517, 0.100485281],
            xx: [0.70337, 0.007962, 0.037242, 0.025853, 0.035549, 0.001964, 0.0165298537],
            xy: [-0.000139, -0.003925, -0.004761, 0.007796, -0.002117, 0.000109, 0.000394892297],
            xz: [0.006772, 0.010254, -0.011396, -0.001332, -0.004037, -0.001158, -0.000706695711],
            yy: [0.70661, 0.02811, 0.036155, 0.019552, 0.029474, 0.004354, 0.0141072486],
            yz: [0.019169, 0.000704, -0.012805, 0.008641, 0.000229, 0.000341, -0.00105110533],
            zz: [0.009117, 0.025995, 0.01083, 0.028323, 0.008627, 0.005433, 0.00667695556]
        } (base);
        output hand[3]: m = arm.tip;
    }
}

const GRAVITY: [f64; 3] = [0.0, 0.0, -9.81];

/// The largest error of the accelerations at 1,000 random states, relative to the largest of them at that state; and
/// that of the kinetic energy. The states are the coordinates and then their rates, in order of the joints.
fn compared<const N: usize, const M: usize, const P: usize>(
    model: &impl System<f64, N, M, P>,
    links: &[Link],
) -> [f64; 2] {
    let mut next = noise(1);
    let mut worst = [0.0_f64; 2];
    for _ in 0..1000 {
        let x = SVector::<f64, N>::from_fn(|_, _| next());
        let u = SVector::<f64, M>::from_fn(|_, _| next());
        let (q, v) = x.as_slice().split_at(M);
        let (expected, matrix) = tree::accelerations(links, q, v, u.as_slice(), GRAVITY);
        let found = model.derivative(0.0, &x, &u, &mut Default::default());
        assert_eq!(&found.as_slice()[..M], v);
        let size = expected.iter().fold(0.0_f64, |size, it| size.max(it.abs()));
        for (found, expected) in found.as_slice()[M..].iter().zip(&expected) {
            worst[0] = larger(worst[0], (found - expected).abs() / size);
        }
        let row = |row: &Vec<f64>| row.iter().zip(v).map(|(m, v)| m * v).sum::<f64>();
        let kinetic: f64 = 0.5 * matrix.iter().zip(v).map(|(it, v)| row(it) * v).sum::<f64>();
        worst[1] = larger(worst[1], (model.energy(0.0, &x) - kinetic).abs() / kinetic);
    }
    worst
}

#[test]
fn arm_out_of_its_file_equals_the_recursion() {
    let model = Arm::new(ArmParameters::default()).unwrap();
    let [acceleration, energy] = compared(&model, &panda());
    println!("arm: accelerations {acceleration:.1e}, energy {energy:.1e}");
    assert!(acceleration < 1e-13, "{acceleration:e}");
    assert!(energy < 1e-14, "{energy:e}");
}

#[test]
fn arm_out_of_its_parameters_equals_the_recursion() {
    let model = Serial::new(SerialParameters::default()).unwrap();
    let [acceleration, energy] = compared(&model, &panda());
    println!("serial arm: accelerations {acceleration:.1e}, energy {energy:.1e}");
    assert!(acceleration < 1e-13, "{acceleration:e}");
    assert!(energy < 1e-14, "{energy:e}");
}

#[test]
fn winder_of_links_that_are_no_whole_bodies_equals_the_recursion() {
    let model = Winder::new(WinderParameters::default()).unwrap();
    let [acceleration, energy] = compared(&model, &winder());
    println!("winder: accelerations {acceleration:.1e}, energy {energy:.1e}");
    assert!(acceleration < 1e-13, "{acceleration:e}");
    assert!(energy < 1e-14, "{energy:e}");
}

#[test]
fn hand_is_where_the_links_lead() {
    let links = panda();
    let (arm, serial) = (
        Arm::new(ArmParameters::default()).unwrap(),
        Serial::new(SerialParameters::default()).unwrap(),
    );
    let mut next = noise(1);
    let idle = SVector::zeros();
    for _ in 0..100 {
        let x = SVector::<f64, 14>::from_fn(|_, _| 3.0 * next());
        let expected = tree::position(&links, &x.as_slice()[..7], 6);
        let found = [
            arm.output(0.0, &x, &idle, &mut ()),
            serial.output(0.0, &x, &idle, &mut ()),
        ];
        for (found, expected) in found.iter().flat_map(|it| it.iter().zip(expected)) {
            assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        }
    }
}

#[test]
fn arm_balances() {
    let model = Arm::new(ArmParameters::default()).unwrap();
    let swing = Smooth(|t: f64| SVector::from_fn(|joint, _| (3.0 * t + joint as f64).sin()));
    let found = [1e-3, 5e-4, 2.5e-4].map(|h: f64| imbalance(&model, &swing, h, (1.0 / h) as u32));
    println!("arm: imbalance of energy {found:?}");
    // That of the integrator, which is of the fourth order.
    assert!(found[2] < 1e-9, "{found:?}");
    assert!(found[0] / found[1] > 15.0, "{found:?}");
}

#[test]
fn cost_of_the_arm() {
    let costs = [
        <Arm as System<f64, 14, 7, 3>>::META.operations,
        <Serial as System<f64, 14, 7, 3>>::META.operations,
    ];
    for cost in costs {
        println!(
            "operations per derivative: {}, angles: {}",
            cost.derivative, cost.angles
        );
        // The first joint is upright, so that nothing depends on its angle.
        assert_eq!(cost.angles, 6);
        assert!(cost.derivative <= 1_582, "{}", cost.derivative);
    }
}

#[test]
fn files_are_printed_as_they_are_included() {
    let files = [
        ("examples/arm/panda", None, &[][..]),
        (
            "tests/robots/crane",
            Some("Crane"),
            &[
                "57: `limit` is not converted",
                "91: 1.5708 is 3.7e-6 rad beside a right angle; with `--right-angles 1e-5` fewer operations are left",
                "96: `gazebo` is not converted",
            ],
        ),
        ("tests/robots/gripper", None, &[]),
        ("tests/robots/rover", Some("Rover"), &[]),
        ("tests/robots/winder", Some("Winder"), &[]),
    ];
    for (file, model, remarks) in files {
        let read = |ending: &str| std::fs::read_to_string(format!("{file}.{ending}")).unwrap();
        let options = Options {
            model,
            ..Options::default()
        };
        let found = mbg_urdf::convert(&read("urdf"), &format!("{file}.urdf"), &options).unwrap();
        assert!(
            found.text == read("mbg"),
            "{file}.mbg is not what the tool prints"
        );
        let told: Vec<String> = found.remarks.iter().map(ToString::to_string).collect();
        assert_eq!(told, remarks);
    }
}
