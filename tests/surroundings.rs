//! Generated code among what is forbidden and called by names of Rust: it needs no lint to be allowed, and takes its types from
//! no scope.
#![forbid(unused_variables, unused_parens, missing_docs, future_incompatible)]
#![forbid(clippy::all)]

/// Models of any visibility.
#[deny(clippy::pedantic, clippy::nursery)]
pub mod models {
    use mbg_runtime::mbg;

    mbg! {
        /// Matrices, outputs, inputs and parameters.
        pub model Oscillator {
            param mass: kg = 2.0;
            param spans[2]: m = [0.5, -0.25];
            input force: N;
            1 velocity {
                I body { inertia: mass }
                C spring { stiffness: 100.0 / (1.0 - spans[1] / spans[0]) }
                R damper { effort: -3.0 * f * abs(f) }
                Se drive { effort: force + 2.0 * sin(3.0 * t) }
            }
            output position: m = spring.q;
            output shares[4]: m = [1.570_796_3 * spring.q, -0.3183 * spring.q, 3.1416 * spring.q, 1.618_034 * spring.q];
        }
        /// No parameters, and nothing to fold.
        pub(crate) model Bare {
            1 velocity { I body { inertia: 2.0 } C spring { effort: sin(q) } }
        }
        /// An algebraic loop that is solved by iteration.
        pub model Rectifier {
            1 coil { Se source { effort: sin(t) } I inductor { inertia: 1.0 } }
            0 node;
            coil -> node;
            node -> R diode { flow: 1e-12 * (exp(e / 0.026) - 1.0) };
            1 load { R resistor { effort: 3.0 * f * f * f + f } C capacitor { stiffness: 2.0 } }
            node -> load;
            output voltage = diode.e;
        }
        /// Joints, whose Jacobian is worked out by columns.
        #[derivative]
        pub model Pendulum {
            gravity [0.0, 0.0, -9.81];
            1 ground[6];
            Sf still[6] { flow: 0.0 } -> ground;
            1 upper[6];
            1 lower[6];
            shoulder: Revolute { axis: 2 } (ground, upper);
            elbow: Revolute { axis: 2 } (upper, lower);
            arm: Body { mass: 1.0, inertia: 2.0 } (upper);
            forearm: Body { mass: 2.0, inertia: 2.0 } (lower);
        }
    }
}

/// A scope in which types of Rust are others, and what generated code binds has values.
pub mod renamed {
    #![allow(non_camel_case_types, non_upper_case_globals)]

    /// No number.
    pub struct f64;
    /// No number.
    pub struct usize;
    /// No truth.
    pub struct bool;
    /// No time.
    pub const t: i32 = 1;
    /// No state.
    pub static x: i32 = 2;
    /// No input.
    pub struct u;
    /// No memory.
    pub const memory: i32 = 3;
    /// No rows that a state holds.
    pub static held: i32 = 4;
    /// No first value.
    pub const v0: i32 = 5;
    /// No first unknown.
    pub const z0: i32 = 6;
    /// No factors.
    pub const s0: i32 = 7;
    /// No element.
    pub const a0_0: i32 = 8;

    mbg_runtime::mbg! {
        /// A loop that is closed.
        #[derivative]
        pub model Crank {
            gravity [0.0, -9.81];
            1 ground[3];
            Sf still[3] { flow: 0.0 } -> ground;
            1 crank[3];
            1 pin[3];
            1 rod[3];
            turn: PlanarRevolute { initial: 0.5, initial_rate: 2.0 } (ground, crank);
            along: PlanarOffset { x: 1.0 } (crank, pin);
            joint: PlanarRevolute { initial: -1.0 } (pin, rod);
            wheel: PlanarBody { mass: 1.0, inertia: 2.0 } (crank);
            bar: PlanarBody { mass: 1.0, inertia: 2.0 } (rod);
            _back: PlanarCut { joint: slot } (rod, ground);
        }
        /// What is eliminated row by row.
        pub model Row {
            1 first { I one { inertia: 1.0 } C spring { stiffness: 2.0 } }
            1 second { I two { inertia: 1.0 } }
            0 between { C link { stiffness: 2.0 } }
            first -> between;
            between -> second;
        }
    }
}

/// A scope without a prelude.
#[no_implicit_prelude]
pub mod bare {
    use ::core::default::Default as _;
    use ::mbg_runtime::{System as _, mbg};

    /// What models of one name start with, which a function and a block of it call so.
    pub fn starts() -> [f64; 2] {
        mbg! {
            model Wheel { 1 rate { I rotor { inertia: 2.0, initial_flow: 3.0 } } }
        }
        mbg! {
            model Pulley { 1 rate { I rotor { inertia: 1.0 } } }
        }
        let inner = {
            mbg! {
                model Wheel { 1 rate { I rotor { inertia: 4.0, initial_flow: 3.0 } } }
            }
            let wheel = Wheel::<f64>::new(WheelParameters::default());
            wheel.map_or(0.0, |wheel| wheel.initial_state()[0])
        };
        let pulley = Pulley::<f64>::new(PulleyParameters::default());
        let pulley = pulley.map_or(1.0, |pulley| pulley.initial_state()[0]);
        let wheel = Wheel::<f64>::new(WheelParameters::default());
        [
            inner,
            wheel.map_or(0.0, |wheel| wheel.initial_state()[0] + pulley),
        ]
    }
}

#[test]
fn models_stand_in_functions() {
    assert_eq!(bare::starts(), [12.0, 6.0]);
}

#[test]
fn parameters_show_what_they_have() {
    let bare = models::BareParameters::<f64>::default();
    assert_eq!(format!("{bare:?}"), "BareParameters");
    let model = models::Bare::new(bare).map_err(|error| error.to_string());
    assert_eq!(model.map(|it| *it.parameters()), Ok(bare));
    let oscillator = models::OscillatorParameters {
        mass: 1.0,
        spans: [2.0, 3.0],
    };
    let text = "OscillatorParameters { mass: 1.0, spans: [2.0, 3.0] }";
    assert_eq!(format!("{oscillator:?}"), text);
}
