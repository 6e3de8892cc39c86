//! Pendulums on an ideal pin and on one that gives way, against closed forms and multi-precision references.

use mbg_runtime::{Adaptive, Dop853, Integrator, Radau5, Rk4, System, mbg};
use nalgebra::SVector;

use crate::references::errors::{apart, larger};

mbg! {
    include "examples/gallery/stiff_pin.mbg";

    /// A point mass of 1 kg on a rod of 1 m without mass, let go level.
    #[derivative]
    pub(crate) model Simple {
        gravity [0.0, -9.81];
        1 ground[3] { Sf fixed { flow: 0.0 } }
        1 foot[3]; 1 end[3];
        pin: PlanarRevolute { initial: 3.141592653589793 } (ground, foot);
        rod: PlanarOffset { x: 1.0 } (foot, end);
        mass: PlanarPointMass { mass: 1.0 } (end);
        output place[2]: m = rod.position_b;
        output speed[2]: m/s = end.f[1..3];
    }
}

/// Problem A01 of the multibody benchmarks of IFToMM (González, Dopico, Lugrís, Cuadrado, Multibody System Dynamics 16,
/// 2006). Time in s; x, y in m and their rates in m/s, by `sin(ψ/2) = -k cd(√(g/l) t | k²)`, `k = sin(π/4)`.
const SIMPLE: [(f64, [f64; 4]); 8] = [
    (
        0.1,
        [
            -0.9987974827498897,
            -0.049026405665557576,
            0.048083335112397395,
            -0.9795846426127293,
        ],
    ),
    (
        0.5,
        [
            -0.3910487915505464,
            -0.9203699487851922,
            3.9110480039555524,
            -1.6617346075474144,
        ],
    ),
    (
        1.0,
        [
            0.9862917511318753,
            -0.16501085312554117,
            0.2969055159163158,
            1.7746436411126556,
        ],
    ),
    (
        2.0,
        [
            -0.7935661953433217,
            -0.6084839304437916,
            -2.102437874436126,
            2.7419353930105093,
        ],
    ),
    (
        3.0,
        [
            0.1766517899228382,
            -0.9842734097378926,
            4.325368674538742,
            0.7762925533433997,
        ],
    ),
    (
        5.0,
        [
            -0.9423054350437573,
            -0.3347543384140006,
            0.8579042568859491,
            -2.4149286543704886,
        ],
    ),
    (
        7.5,
        [
            -0.7274587213083755,
            -0.6861514474169557,
            2.517557956711684,
            -2.669118456142095,
        ],
    ),
    (
        10.0,
        [
            -0.2750874625761169,
            -0.961419205099125,
            4.175598100951729,
            -1.1947490545604753,
        ],
    ),
];

/// Time in s; the pin's displacement in m, the angle from the downward vertical in rad, and the rates of all; a rod of
/// 1 m and 1 kg on a pin of 1e6 N/m and 2e3 N s/m. Radau IIA of orders 13 and 15 agree to 5e-16.
const SOFT: [(f64, [f64; 6]); 8] = [
    (
        0.0001,
        [
            6.550276801172872e-17,
            -3.809738203245108e-08,
            1.57079631036597,
            3.690021239075438e-12,
            -0.0006708147803735327,
            -0.0004652778294397009,
        ],
    ),
    (
        0.01,
        [
            1.069138496460478e-08,
            -2.440072590538575e-06,
            1.57006423691402,
            2.59878808842035e-06,
            -6.665768091073876e-06,
            -0.1471399946540341,
        ],
    ),
    (
        0.1,
        [
            1.55449876187907e-06,
            -2.562696686168555e-06,
            1.497238410353922,
            3.149590842347317e-05,
            -4.484580555755721e-06,
            -1.470698378234941,
        ],
    ),
    (
        0.5,
        [
            -1.746280792971478e-06,
            -2.438345917191747e-05,
            -0.09029718209337695,
            -0.0001180131451907154,
            1.891506707785568e-05,
            -5.413663161170385,
        ],
    ),
    (
        1.0,
        [
            -1.59550752070619e-07,
            -2.453669589507872e-06,
            -1.562632036729411,
            -1.01694632503692e-05,
            -1.481256103703395e-07,
            0.4902086774369232,
        ],
    ),
    (
        2.0,
        [
            6.781861822571902e-07,
            -2.473431504045626e-06,
            1.538133843284764,
            2.094903348411737e-05,
            -1.29213655246892e-06,
            -0.980326448323042,
        ],
    ),
    (
        3.0,
        [
            -1.552760039985396e-06,
            -2.56245736918669e-06,
            -1.49731444980794,
            -3.147830513322173e-05,
            -4.477132009187051e-06,
            1.469861911212448,
        ],
    ),
    (
        5.0,
        [
            -4.277782652621478e-06,
            -3.315843570815749e-06,
            -1.366922113009797,
            -4.907371777285553e-05,
            -2.064261643298303e-05,
            2.440936668346874,
        ],
    ),
];

/// With 1e12 N/m and 2e6 N s/m.
const HARD: [(f64, [f64; 6]); 8] = [
    (
        0.0001,
        [
            1.55997214410937e-18,
            -2.45250000000011e-12,
            1.570796253223575,
            3.183009007499967e-14,
            -4.502667873234554e-21,
            -0.001471499999999999,
        ],
    ),
    (
        0.01,
        [
            1.623334073919498e-14,
            -2.452511938907422e-12,
            1.570060576811851,
            3.247315092760874e-12,
            -4.776516789051077e-15,
            -0.1471499920343521,
        ],
    ),
    (
        0.1,
        [
            1.617775794636859e-12,
            -2.571716724572478e-12,
            1.497234599277274,
            3.21108036954973e-11,
            -4.758443039805712e-12,
            -1.470703794921167,
        ],
    ),
    (
        0.5,
        [
            -1.983225480050153e-12,
            -2.434534388130715e-11,
            -0.09035208990072544,
            -1.175523681399098e-10,
            2.147384845719716e-11,
            -5.413866990554195,
        ],
    ),
    (
        1.0,
        [
            -1.80404364877503e-13,
            -2.453974590994666e-12,
            -1.562621718047514,
            -1.082414586707844e-11,
            -1.769608445055153e-13,
            0.4904855310177152,
        ],
    ),
    (
        2.0,
        [
            7.211545998812073e-13,
            -2.476086829640478e-12,
            1.538098984263446,
            2.160339436660831e-11,
            -1.414679356628339e-12,
            -0.9808727412956691,
        ],
    ),
    (
        3.0,
        [
            -1.61770253087422e-12,
            -2.571705867996694e-12,
            -1.497237954822064,
            -3.211010455296804e-11,
            -4.758119213854453e-12,
            1.470670311719717,
        ],
    ),
    (
        5.0,
        [
            -4.380457627768428e-12,
            -3.359070586375556e-12,
            -1.366714573477783,
            -4.947756889957721e-11,
            -2.139597763197141e-11,
            2.44223685380214,
        ],
    ),
];

/// Angle and rate on an ideal pin at the same times.
const RIGID: [[f64; 2]; 8] = [
    [1.570796253219897, -0.001471499999999999],
    [1.570060576808173, -0.1471499920343579],
    [1.49723459927345, -1.470703794926997],
    [-0.0903520899559723, -5.413866990753795],
    [-1.562621718034471, 0.4904855312988756],
    [1.538098984222289, -0.9808727418589973],
    [-1.497237954734011, 1.470670312566103],
    [-1.366714573239865, 2.442236855204294],
];

/// An instant in the form of the references.
fn shown(model: &StiffPin, x: &SVector<f64, 6>) -> [f64; 6] {
    let states = (0..).zip(StiffPin::<f64>::META.states);
    let mut give = states.filter(|(_, state)| state.name.ends_with("spring.q"));
    let give = [(); 2].map(|()| x[give.next().unwrap().0]);
    let y = model.output(0.0, x, &SVector::zeros(), &mut ());
    let angle = y[0] + std::f64::consts::FRAC_PI_2;
    [give[0], give[1], angle, y[2], y[3], y[1]]
}

#[test]
fn a_pendulum_meets_its_elliptic_functions() {
    let model = Simple::new(SimpleParameters::default()).unwrap();
    let times = SIMPLE.map(|row| row.0);
    let (mut rows, mut worst) = (SIMPLE.iter(), 0.0_f64);
    Adaptive::new(Dop853, 1e-13, 1e-15)
        .sample(&model, &(), 0.0, model.initial_state(), &times, |t, x| {
            let found = model.output(t, x, &SVector::zeros(), &mut ());
            let expected = rows.next().unwrap().1;
            worst = larger(worst, apart(found.as_slice(), &expected));
        })
        .unwrap();
    // Places of 1 m, speeds up to 4.4 m/s.
    assert!(rows.next().is_none() && worst < 1e-11, "{worst:e}");
}

#[test]
fn a_rod_on_an_ideal_pin_is_the_limit() {
    let model = RigidPin::new(RigidPinParameters::default()).unwrap();
    let times = SOFT.map(|row| row.0);
    let (mut rows, mut worst) = (RIGID.iter(), 0.0_f64);
    Adaptive::new(Dop853, 1e-13, 1e-15)
        .sample(&model, &(), 0.0, model.initial_state(), &times, |t, x| {
            let found = model.output(t, x, &SVector::zeros(), &mut ());
            let [angle, rate] = rows.next().unwrap();
            let found = [found[0] + std::f64::consts::FRAC_PI_2, found[1]];
            worst = larger(worst, apart(&found, &[*angle, *rate]));
        })
        .unwrap();
    assert!(rows.next().is_none() && worst < 1e-12, "{worst:e}");
}

/// Largest errors of the pin's displacement, of angle and rate, and of the pin's velocity, each relative to the largest
/// value of its kind.
fn errors(found: &[[f64; 6]], rows: &[(f64, [f64; 6])]) -> [f64; 3] {
    [[0, 1].as_slice(), &[2, 5], &[3, 4]].map(|kind| {
        let largest = |of: &dyn Fn(usize, usize) -> f64| {
            let all = (0..rows.len()).flat_map(|row| kind.iter().map(move |place| (row, *place)));
            all.fold(0.0, |most, (row, place)| larger(most, of(row, place).abs()))
        };
        let error = largest(&|row, place| found[row][place] - rows[row].1[place]);
        error / largest(&|row, place| rows[row].1[place])
    })
}

#[test]
fn a_rod_on_a_pin_that_gives_way_meets_the_reference() {
    for (stiffness, damping, rows) in [(1e6, 2e3, &SOFT), (1e12, 2e6, &HARD)] {
        let model = StiffPin::new(StiffPinParameters { stiffness, damping }).unwrap();
        let mut found = Vec::new();
        let times = rows.map(|row| row.0);
        Adaptive::new(Radau5, 1e-12, 1e-18)
            .sample(&model, &(), 0.0, model.initial_state(), &times, |_, x| {
                found.push(shown(&model, x));
            })
            .unwrap();
        let errors = errors(&found, rows);
        // The velocity of the hard pin, 1e-10 m/s, is a difference of velocities of 1 m/s.
        assert!(
            errors[0] < 1e-9 && errors[1] < 1e-11 && errors[2] < 1e-2,
            "{stiffness}: {errors:?}"
        );
    }
}

#[test]
fn the_pin_settles_before_an_explicit_method_needs_long() {
    // Within 1e-4 s the loaded pin sinks to where its spring carries a quarter of the weight.
    let model = StiffPin::new(StiffPinParameters {
        stiffness: 1e12,
        damping: 2e6,
    })
    .unwrap();
    let (mut last, start) = (model.initial_state(), model.initial_state());
    Rk4::fixed(&model, &(), 0.0, 1e-4, 1e-7, start, |_, x| last = *x).unwrap();
    let sunk = shown(&model, &last)[1];
    assert!((sunk / HARD[0].1[1] - 1.0).abs() < 1e-10, "{sunk:e}");
    assert!((sunk / (-9.81 / 4.0 / 1e12) - 1.0).abs() < 1e-10);
}
