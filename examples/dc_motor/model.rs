//! The motor, and where it must be at ten times.

use mbg_runtime::{Pulse, mbg};
use nalgebra::SVector;

mbg! {
    /// A DC motor that turns a flywheel through a gear and a flexible shaft.
    pub(crate) model Motor {
        /// Voltage of the supply.
        param voltage: V = 24.0;
        /// Resistance of the winding.
        param resistance: ohm = 0.8;
        /// Inductance of the winding.
        param inductance: H = 0.5e-3;
        /// Torque per current, and voltage per speed.
        param constant: N*m/A = 0.05;
        /// Inertia of the rotor.
        param rotor_inertia: kg*m^2 = 2e-4;
        /// Friction of the rotor.
        param rotor_friction: N*m*s/rad = 1e-4;
        /// Turns of the rotor per turn of the shaft.
        param ratio = 20.0;
        /// Stiffness of the shaft.
        param stiffness: N*m/rad = 500.0;
        /// Damping of the shaft.
        param damping: N*m*s/rad = 0.5;
        /// Inertia of the load.
        param load_inertia: kg*m^2 = 0.15;
        /// Friction of the load's bearing.
        param load_friction: N*m*s/rad = 0.02;
        /// Torque that brakes the load.
        input brake: N*m;

        1 armature {
            Se supply { effort: voltage }
            R winding { resistance: resistance }
            I coil { inertia: inductance }
        }
        1 rotor {
            I spindle { inertia: rotor_inertia }
            R friction { resistance: rotor_friction }
        }
        0 torque;
        1 shaft {
            C spring { stiffness: stiffness }
            R damper { resistance: damping }
        }
        1 load {
            I flywheel { inertia: load_inertia }
            R bearing { resistance: load_friction }
            Se brakes { effort: -brake }
        }
        armature -> GY motor { effort: constant } -> rotor;
        rotor -> TF gear { flow: 1.0 / ratio } -> torque;
        torque -> shaft;
        torque -> load;

        output current: A = armature.f;
        output motor_speed: rad/s = rotor.f;
        output load_speed: rad/s = load.f;
        output twist: rad = spring.q;
    }
}

/// The load is braked from 0.2 s on.
pub(crate) fn brake() -> Pulse<f64, 1> {
    Pulse {
        amplitude: SVector::from([3.0]),
        start: 0.2,
        end: f64::INFINITY,
    }
}

/// One instant of the reference.
pub(crate) struct Instant {
    /// Time in s.
    pub time: f64,
    /// Current in A, speeds of motor and load in rad/s, twist of the shaft in rad.
    pub output: [f64; 4],
}

/// By the matrix exponential, good to 17 digits.
pub(crate) const REFERENCE: [Instant; 10] = [
    Instant {
        time: 0.0005,
        output: [
            16.503125703450607,
            1.1665928223750934,
            3.8915886164840756e-05,
            1.0334347950827591e-05,
        ],
    },
    Instant {
        time: 0.001,
        output: [
            23.8476959155895,
            3.740234167919102,
            0.0002946624297722102,
            6.973288750882018e-05,
        ],
    },
    Instant {
        time: 0.005,
        output: [
            28.321323867236863,
            30.83181127788436,
            0.029453067499763667,
            0.0034912586490282085,
        ],
    },
    Instant {
        time: 0.01,
        output: [
            26.539311929863477,
            58.33472081200622,
            0.20577694221646814,
            0.014338735773272807,
        ],
    },
    Instant {
        time: 0.05,
        output: [
            25.207594139737466,
            78.41370238237275,
            6.425152530813422,
            0.02905118810614024,
        ],
    },
    Instant {
        time: 0.1,
        output: [
            18.157631066242,
            189.36728759348983,
            10.02799741622455,
            0.037135201028994036,
        ],
    },
    Instant {
        time: 0.2,
        output: [
            10.372176036389638,
            314.890002512063,
            15.514301184936965,
            0.008705687826064281,
        ],
    },
    Instant {
        time: 0.3,
        output: [
            7.953751941028691,
            352.8111862274262,
            17.834315258815103,
            0.01366139360578444,
        ],
    },
    Instant {
        time: 0.5,
        output: [
            5.3965961107563425,
            393.71676040419914,
            19.72650538695591,
            0.008443909338430465,
        ],
    },
    Instant {
        time: 1.0,
        output: [
            4.300539563534306,
            411.1948787090572,
            20.560192709468833,
            0.00691196857206917,
        ],
    },
];

/// Largest error of an output, relative to the reference.
pub(crate) fn error(output: &SVector<f64, 4>, reference: &Instant) -> f64 {
    let errors = output
        .iter()
        .zip(reference.output)
        .map(|(ours, theirs)| ((ours - theirs) / theirs).abs());
    errors.fold(0.0, f64::max)
}
