//! Andrews' squeezing mechanism: seven bodies, three loops in a plane, a motor and a spring.
//!
//! Problem `andrews` of the *Test Set for Initial Value Problem Solvers*, release 2.4 (Mazzia, Magherini, University of
//! Bari); Hairer and Wanner, *Solving Ordinary Differential Equations II*, 2nd ed., VII.7; Schiehlen (ed.), *Multibody
//! Systems Handbook*, 1990; problem A03 of the multibody benchmarks of IFToMM.
//!
//! Coordinates `q = (β, θ, γ, φ, δ, ω, ε)`. With `e(a) = (cos a, sin a)`, `n(a) = (−sin a, cos a)` and
//! `P = rr e(β) − d e(β + θ)` the loops are
//!
//! ```text
//! P + ss n(γ) = B        P + e n(φ + δ) − zt e(δ) = A        P − zf e(ω + ε) + u n(ε) = A
//! ```
//! A motor drives `β` with a constant torque, a spring acts between C and a point of the third body. There is no
//! gravity. From rest, for 0.03 s.
//!
//! The bodies are written here from the figure of the problem: their centres of mass as sums of links. No published
//! matrix is used.

use super::planar::{Body, Mechanism, Point, term};

/// Masses in kg, K1 to K7.
pub(crate) const MASS: [f64; 7] = [
    0.04325, 0.00365, 0.02373, 0.00706, 0.07050, 0.00706, 0.05498,
];
/// Inertias about the centres of mass in kg m², K1 to K7.
pub(crate) const INERTIA: [f64; 7] = [
    2.194e-6, 4.410e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5,
];
/// Where bodies 4 to 7 hang on the ground, in m.
pub(crate) const A: [f64; 2] = [-0.06934, -0.00227];
/// Where the third body hangs on the ground, in m.
pub(crate) const B: [f64; 2] = [-0.03635, 0.03273];
/// Where the spring hangs on the ground, in m.
pub(crate) const C: [f64; 2] = [0.014, 0.072];
/// Lengths in m, named as in the problem.
pub(crate) const D: f64 = 28e-3;
pub(crate) const DA: f64 = 115e-4;
pub(crate) const E: f64 = 2e-2;
pub(crate) const EA: f64 = 1421e-5;
pub(crate) const RR: f64 = 7e-3;
pub(crate) const RA: f64 = 92e-5;
pub(crate) const SS: f64 = 35e-3;
pub(crate) const SA: f64 = 1874e-5;
pub(crate) const SB: f64 = 1043e-5;
pub(crate) const SC: f64 = 18e-3;
pub(crate) const SD: f64 = 2e-2;
pub(crate) const TA: f64 = 2308e-5;
pub(crate) const TB: f64 = 916e-5;
pub(crate) const U: f64 = 4e-2;
pub(crate) const UA: f64 = 1228e-5;
pub(crate) const UB: f64 = 449e-5;
pub(crate) const ZF: f64 = 2e-2;
pub(crate) const ZT: f64 = 4e-2;
pub(crate) const FA: f64 = 1421e-5;
/// Stiffness of the spring in N/m.
pub(crate) const STIFFNESS: f64 = 4530.0;
/// Length of the relaxed spring in m.
pub(crate) const RELAXED: f64 = 7785e-5;
/// Torque of the motor in N m.
pub(crate) const TORQUE: f64 = 33e-3;
/// Angles at the start, consistent to all digits; the rates are zero.
pub(crate) const START: [f64; 7] = [
    -0.06171389001427645,
    0.0,
    0.45527981916307037,
    0.22266839016588588,
    0.48736497954384256,
    -0.22266839016588588,
    1.2305474445498212,
];

/// One instant of the reference.
pub(crate) struct Instant {
    /// Time in s.
    pub(crate) time: f64,
    /// `q` in rad.
    pub(crate) angles: [f64; 7],
    /// `q̇` in rad/s.
    pub(crate) rates: [f64; 7],
    /// `q̈` in rad/s².
    pub(crate) accelerations: [f64; 7],
    /// `λ` in N of `M q̈ + Gᵀ λ = f`, loops in the order above, x before y.
    pub(crate) multipliers: [f64; 6],
}

/// Extrapolation in 28 digits: angles and rates are good to 15 digits.
pub(crate) const REFERENCE: [Instant; 7] = [
    Instant {
        time: 0.0,
        angles: [
            -0.06171389001427645,
            0.0,
            0.45527981916307037,
            0.22266839016588588,
            0.48736497954384256,
            -0.22266839016588588,
            1.2305474445498212,
        ],
        rates: [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        accelerations: [
            14222.443919954114,
            -10666.832939965585,
            2.906265606699379e-27,
            5.869094547400751e-27,
            -6.570711663363297e-28,
            -5.869094547400751e-27,
            2.2192831071473968e-27,
        ],
        multipliers: [
            98.56687039624109,
            -6.122688344255662,
            8.770929366519505e-31,
            -7.173879136903687e-31,
            1.293654081728467e-30,
            1.8504512294314953e-30,
        ],
    },
    Instant {
        time: 0.005,
        angles: [
            0.2110763859032667,
            -0.20158717093408013,
            0.4491151900115144,
            0.21025079793001447,
            0.4887437654619352,
            -0.21025079793001447,
            1.2258667940349073,
        ],
        rates: [
            151.01070126923435,
            -110.46733311436861,
            -6.682659880912358,
            -13.427125804932293,
            1.47852776983969,
            13.427125804932293,
            -5.044979345042519,
        ],
        accelerations: [
            65664.77085953207,
            -47384.32306738297,
            -6369.70081993636,
            -12725.465427605697,
            1374.5423351348145,
            12725.465427605697,
            -4745.919106730733,
        ],
        multipliers: [
            89.97110073790627,
            3.242431629655841,
            -1.8331656950312432,
            1.5084230935746519,
            -2.743375160387409,
            -3.9646389856073556,
        ],
    },
    Instant {
        time: 0.01,
        angles: [
            2.1601131315315265,
            -1.8833642311070444,
            0.1585167580012267,
            -0.3286410751746703,
            0.5251547747977294,
            0.3286410751746703,
            1.068427204632401,
        ],
        rates: [
            711.923152831104,
            -786.7700808599398,
            -136.4381913781197,
            -240.29302926786454,
            4.791548225371054,
            240.29302926786454,
            -41.14056696161049,
        ],
        accelerations: [
            209058.27853254118,
            -369745.60017161345,
            -6373.773935841842,
            -5657.410330994548,
            -11869.750534558465,
            5657.410330994548,
            34721.437501431545,
        ],
        multipliers: [
            57.02529043750258,
            2.9679042462494833,
            3.218860385008939,
            -18.179269867940356,
            5.159502718032351,
            34.24011729160661,
        ],
    },
    Instant {
        time: 0.015,
        angles: [
            5.655429749991794,
            -5.833796765108832,
            0.42589192575237794,
            0.1640128375726053,
            0.4936765269686444,
            -0.1640128375726053,
            1.208712541909195,
        ],
        rates: [
            441.7019932552524,
            -375.3594971288744,
            46.63421226488548,
            92.03152208827694,
            -9.50151625591751,
            -92.03152208827694,
            33.690628623572316,
        ],
        accelerations: [
            -39300.234413648875,
            78575.26528361502,
            -41077.7074957535,
            -77904.68012902894,
            6779.740923516637,
            77904.68012902894,
            -26644.709108078736,
        ],
        multipliers: [
            67.48586991938392,
            7.9080036570686465,
            -9.331000728909876,
            7.542770734169833,
            -15.09644331260447,
            -22.423198302388723,
        ],
    },
    Instant {
        time: 0.02,
        angles: [
            8.184905889661676,
            -7.890505363730449,
            0.20953691338469757,
            -0.23832559659585126,
            0.5225369171559964,
            0.23832559659585126,
            1.0862751085998732,
        ],
        rates: [
            726.5583426091277,
            -748.6324206323291,
            -145.73923758440472,
            -259.50079947677506,
            9.79050185516307,
            259.50079947677506,
            -57.75747174274601,
        ],
        accelerations: [
            177724.3327445665,
            -341202.04527245124,
            -33195.92383628786,
            -49292.534678413256,
            -10758.94170672347,
            49292.534678413256,
            24149.460195221083,
        ],
        multipliers: [
            48.493256981749425,
            9.30037734573436,
            2.3032331312870657,
            -15.773889807968303,
            2.94225325451755,
            22.988032419227928,
        ],
    },
    Instant {
        time: 0.025,
        angles: [
            12.10714923444766,
            -12.257030103575486,
            0.44097335558301193,
            0.19394516605445605,
            0.49051954468158976,
            -0.19394516605445605,
            1.2197667718104293,
        ],
        rates: [
            587.4597890778028,
            -477.55714726426305,
            43.07000570007427,
            85.97784179678575,
            -9.25947288267176,
            -85.97784179678575,
            32.02302709216528,
        ],
        accelerations: [
            13980.207140206265,
            59133.460756082604,
            -65262.45999442272,
            -127373.99832833573,
            12619.996175132315,
            127373.99832833573,
            -45925.356573940706,
        ],
        multipliers: [
            48.67204527843051,
            24.94568880661163,
            -17.05044516070309,
            13.906307430058652,
            -26.390216169166393,
            -38.45897445226144,
        ],
    },
    Instant {
        time: 0.03,
        angles: [
            15.810771195153707,
            -15.75637105841184,
            0.0408222401196458,
            -0.5347301163420796,
            0.524409965879954,
            0.5347301163420796,
            1.048080741041938,
        ],
        rates: [
            1139.9203022591062,
            -1424.3792951775401,
            11.032911910618594,
            19.29337410503204,
            0.5735699148295025,
            -19.29337410503204,
            0.3231791492491309,
        ],
        accelerations: [
            -24631.763122874632,
            51850.31963646423,
            324102.6007075786,
            566749.4220009954,
            16743.635418345446,
            -566749.4220009954,
            9826.507801544163,
        ],
        multipliers: [
            199.17534810453864,
            -29.755309974971762,
            23.06654361162215,
            31.452725275771137,
            22.64249478639438,
            11.617392352611256,
        ],
    },
];

/// The published angles at 0.03 s. They differ from [`REFERENCE`] by up to 3e-10 relative, the published rates by 2.8e-8.
pub(crate) const PUBLISHED: [f64; 7] = [
    15.81077119629904,
    -15.75637105984298,
    0.04082224013073101,
    -0.5347301163226948,
    0.5244099658805303,
    0.5347301163226948,
    1.048080741042263,
];

fn turns(indices: &[usize]) -> [f64; 7] {
    let mut turns = [0.0; 7];
    indices.iter().for_each(|i| turns[*i] = 1.0);
    turns
}

/// `length · e(angle + phase)`, the phase in right angles.
fn link(length: f64, phase: i32, indices: &[usize]) -> super::planar::Term<7> {
    term(
        length,
        f64::from(phase) * std::f64::consts::FRAC_PI_2,
        turns(indices),
    )
}

/// The mechanism without its motor and spring.
pub(crate) fn mechanism() -> Mechanism<7> {
    const ORIGIN: [f64; 2] = [0.0, 0.0];
    let centres: [(&[usize], [f64; 2], Vec<super::planar::Term<7>>); 7] = [
        (&[0], ORIGIN, vec![link(RA, 0, &[0])]),
        (
            &[0, 1],
            ORIGIN,
            vec![link(RR, 0, &[0]), link(-DA, 0, &[0, 1])],
        ),
        (&[2], B, vec![link(SA, 0, &[2]), link(SB, 1, &[2])]),
        (
            &[3, 4],
            A,
            vec![link(ZT, 0, &[4]), link(EA - E, 1, &[3, 4])],
        ),
        (&[4], A, vec![link(TA, 0, &[4]), link(TB, 1, &[4])]),
        (
            &[5, 6],
            A,
            vec![link(-U, 1, &[6]), link(ZF - FA, 0, &[5, 6])],
        ),
        (&[6], A, vec![link(UA, 0, &[6]), link(UB, 1, &[6])]),
    ];
    let bodies = centres
        .into_iter()
        .zip(MASS.into_iter().zip(INERTIA))
        .map(|((turn, origin, terms), (mass, inertia))| Body {
            mass,
            inertia,
            centre: Point { origin, terms },
            turn: turns(turn),
        })
        .collect();
    let closing = |end: [f64; 2], others: [super::planar::Term<7>; 2]| {
        let mut terms = vec![link(RR, 0, &[0]), link(-D, 0, &[0, 1])];
        terms.extend(others);
        Point {
            origin: [-end[0], -end[1]],
            terms,
        }
    };
    Mechanism {
        bodies,
        closings: vec![
            closing(B, [link(SS, 1, &[2]), link(0.0, 0, &[2])]),
            closing(A, [link(E, 1, &[3, 4]), link(-ZT, 0, &[4])]),
            closing(A, [link(-ZF, 0, &[5, 6]), link(U, 1, &[6])]),
        ],
        gravity: 0.0,
    }
}

/// Where the spring holds the third body.
fn hook() -> Point<7> {
    Point {
        origin: B,
        terms: vec![link(SD, 0, &[2]), link(-SC, 1, &[2])],
    }
}

/// Generalised forces of motor and spring.
pub(crate) fn forces(angles: &[f64; 7]) -> [f64; 7] {
    let hook = hook();
    let [x, y] = hook.position(angles);
    let (x, y) = (x - C[0], y - C[1]);
    let length = x.hypot(y);
    let pull = -STIFFNESS * (length - RELAXED) / length;
    let mut forces = hook
        .jacobian(angles)
        .map(|[dx, dy]| pull * (x * dx + y * dy));
    forces[0] += TORQUE;
    forces
}

/// Kinetic energy and that of the spring in J.
pub(crate) fn energy(angles: &[f64; 7], rates: &[f64; 7]) -> f64 {
    let [x, y] = hook().position(angles);
    let stretch = (x - C[0]).hypot(y - C[1]) - RELAXED;
    mechanism().energy(angles, rates) + 0.5 * STIFFNESS * stretch * stretch
}

#[cfg(test)]
mod tests {
    use super::super::integrate::integrate;
    use super::*;

    #[test]
    fn instants_satisfy_the_equations() {
        let mechanism = mechanism();
        for instant in &REFERENCE {
            for g in mechanism.closing(&instant.angles) {
                assert!(g.abs() < 1e-17 + 1e-16, "{} {g:e}", instant.time);
            }
            let (a, multipliers) =
                mechanism.accelerations(&instant.angles, &instant.rates, forces(&instant.angles));
            let size = instant
                .accelerations
                .iter()
                .fold(0.0, |size: f64, a| size.max(a.abs()));
            for (a, expected) in a.iter().zip(instant.accelerations) {
                assert!(
                    (a - expected).abs() < 1e-11 * size,
                    "{} {a} {expected}",
                    instant.time
                );
            }
            for (found, expected) in multipliers.iter().zip(instant.multipliers) {
                assert!(
                    (found - expected).abs() < 1e-9,
                    "{} {found} {expected}",
                    instant.time
                );
            }
        }
    }

    #[test]
    fn equations_give_the_reference() {
        let mechanism = mechanism();
        let mut start = [0.0; 14];
        start[..7].copy_from_slice(&START);
        let end = integrate(
            |_, x: &[f64; 14]| {
                let (angles, rates) = split(x);
                let (a, _) = mechanism.accelerations(&angles, &rates, forces(&angles));
                std::array::from_fn(|i| if i < 7 { rates[i] } else { a[i - 7] })
            },
            (0.0, 0.03),
            160,
            start,
        );
        let (angles, rates) = split(&end);
        for i in 0..7 {
            let last = &REFERENCE[6];
            assert!(
                (angles[i] / last.angles[i] - 1.0).abs() < 1e-10,
                "{i} {} {}",
                angles[i],
                last.angles[i]
            );
            assert!(
                (rates[i] / last.rates[i] - 1.0).abs() < 1e-7,
                "{i} {} {}",
                rates[i],
                last.rates[i]
            );
            assert!((PUBLISHED[i] / last.angles[i] - 1.0).abs() < 3e-10);
        }
        let work = TORQUE * (angles[0] - START[0]);
        let gained = energy(&angles, &rates) - energy(&START, &[0.0; 7]);
        assert!(
            (gained - work).abs() < 1e-12 * work.abs().max(1.0),
            "{gained} {work}"
        );
    }

    fn split(x: &[f64; 14]) -> ([f64; 7], [f64; 7]) {
        (
            std::array::from_fn(|i| x[i]),
            std::array::from_fn(|i| x[i + 7]),
        )
    }
}
