//! What is known of a model at compile time.

/// Description of a generated model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meta {
    /// Name of the type.
    pub name: &'static str,
    /// Parameters in order of declaration.
    pub parameters: &'static [Variable],
    /// States in the order of `x`.
    pub states: &'static [Variable],
    /// Inputs in the order of `u`.
    pub inputs: &'static [Variable],
    /// Outputs in the order of `y`.
    pub outputs: &'static [Variable],
    /// Bonds with their strokes.
    pub bonds: &'static [Bond],
    /// Storages that the drawing puts into derivative causality, accepted by `#[derivative]`.
    pub dependent: &'static [&'static str],
    /// Storages' states that follow from others and are none.
    pub eliminated: &'static [Eliminated],
    /// Names of the inverted blocks, in the order of `conditioning`.
    pub conditioning: &'static [&'static str],
    /// Algebraic loops, in order of solution.
    pub loops: &'static [Loop],
    /// Loops that are closed by multipliers, as `a -> b`.
    pub closures: &'static [&'static str],
    /// What the parameters must fulfil, one sentence each.
    pub assumptions: &'static [&'static str],
    /// Things worth knowing that are no mistakes, such as a mark that is not needed.
    pub notes: &'static [&'static str],
    /// Operations per call.
    pub operations: Operations,
    /// The graph as text, with strokes.
    pub diagram: &'static str,
}

impl Meta {
    /// The place of a state in `x`, by its name.
    ///
    /// It is found while compiling where it stands in a constant, and a name that the model has not is an error there:
    ///
    /// ```
    /// use mbg_runtime::{System, mbg};
    ///
    /// mbg! {
    ///     /// A mass on a spring.
    ///     model Swing {
    ///         input push: N;
    ///         1 way { I mass { inertia: 2.0 } C spring { stiffness: 200.0, initial: 0.1 } Se hand { effort: push } }
    ///         output way: m = spring.q;
    ///     }
    /// }
    ///
    /// const WAY: usize = Swing::<f64>::META.state("spring.q").unwrap();
    /// const PUSH: usize = Swing::<f64>::META.input("push").unwrap();
    ///
    /// let swing = Swing::<f64>::new(SwingParameters::default())?;
    /// assert_eq!(swing.initial_state()[WAY], 0.1);
    /// assert_eq!((PUSH, Swing::<f64>::META.output("speed")), (0, None));
    /// # Ok::<(), mbg_runtime::ParameterError>(())
    /// ```
    #[must_use]
    pub const fn state(&self, name: &str) -> Option<usize> {
        place(self.states, name)
    }

    /// The place of an input in `u`, by its name, as [`Meta::state`].
    #[must_use]
    pub const fn input(&self, name: &str) -> Option<usize> {
        place(self.inputs, name)
    }

    /// The place of an output in `y`, by its name, as [`Meta::state`].
    #[must_use]
    pub const fn output(&self, name: &str) -> Option<usize> {
        place(self.outputs, name)
    }

    /// Sizes of the states, by their names, as [`Adaptive::nominal`](crate::Adaptive::nominal) has them; 1 for those not named.
    ///
    /// A name also stands for all states that have more behind it, after a `.` or in brackets: `hull.p` for `hull.p.x` and its like.
    /// Where several stand for a state the last one counts. None if a name stands for no state, or if there are not `N` states.
    ///
    /// ```
    /// use mbg_runtime::{Adaptive, Integrator, System, Tsit5, mbg};
    ///
    /// mbg! {
    ///     /// A capacitor of 1 nF is discharged from 5 V by 1 kΩ.
    ///     model Pulse {
    ///         1 wire { C capacitor { compliance: 1e-9, initial: 5e-9 } R resistor { resistance: 1e3 } }
    ///         output voltage: V = capacitor.e;
    ///     }
    /// }
    ///
    /// const SIZES: [f64; 1] = Pulse::<f64>::META.nominal(&[("capacitor.q", 1e-9)]).unwrap();
    ///
    /// let pulse = Pulse::<f64>::new(PulseParameters::default())?;
    /// let solver = Adaptive { nominal: &SIZES, ..Adaptive::new(Tsit5, 1e-9, 1e-9) };
    /// let mut voltage = 0.0;
    /// solver.sample_outputs(&pulse, &(), 0.0, pulse.initial_state(), &[3e-6], |_, _, y| voltage = y[0])?;
    /// assert!((voltage - 5.0 * f64::exp(-3.0)).abs() < 1e-8);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    #[must_use]
    pub const fn nominal<const N: usize>(&self, sizes: &[(&str, f64)]) -> Option<[f64; N]> {
        if N != self.states.len() {
            return None;
        }
        let mut all = [1.0; N];
        let mut size = 0;
        while size < sizes.len() {
            let (name, number) = sizes[size];
            let (mut state, mut is_known) = (0, false);
            while state < N {
                if is_named(self.states[state].name, name) {
                    (all[state], is_known) = (number, true);
                }
                state += 1;
            }
            if !is_known {
                return None;
            }
            size += 1;
        }
        Some(all)
    }
}

/// The place of a name.
const fn place(variables: &[Variable], name: &str) -> Option<usize> {
    let mut place = 0;
    while place < variables.len() {
        if is_same(variables[place].name.as_bytes(), name.as_bytes()) {
            return Some(place);
        }
        place += 1;
    }
    None
}

const fn is_same(one: &[u8], other: &[u8]) -> bool {
    one.len() == other.len() && begins_with(one, other)
}

/// Whether a name is this one, or begins with it and a part of its own.
pub(crate) const fn is_named(whole: &str, name: &str) -> bool {
    let (whole, name) = (whole.as_bytes(), name.as_bytes());
    !name.is_empty()
        && begins_with(whole, name)
        && (whole.len() == name.len() || matches!(whole[name.len()], b'.' | b'['))
}

const fn begins_with(name: &[u8], start: &[u8]) -> bool {
    let mut byte = 0;
    while byte < name.len() && byte < start.len() && name[byte] == start[byte] {
        byte += 1;
    }
    byte == start.len()
}

/// A scalar with a name and a unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variable {
    /// Name, such as `hull.p.x`.
    pub name: &'static str,
    /// Unit as written, empty when none was. Of states only integrals have one that is written: it is empty for momenta,
    /// displacements, flows of coordinates and attitudes.
    pub unit: &'static str,
}

/// A momentum or displacement that is no state, because the graph lets it follow from others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eliminated {
    /// Its name, such as `load.p`.
    pub state: &'static str,
    /// What it is in terms of states and parameters; a long formula is abbreviated.
    pub relation: &'static str,
}

/// A bond as the model draws it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bond {
    /// Where positive power comes from.
    pub from: &'static str,
    /// Where positive power goes to.
    pub to: &'static str,
    /// Number of components.
    pub dimension: usize,
    /// The end at which each component's causal stroke stands.
    pub strokes: &'static [Stroke],
}

/// The end of a bond that receives the effort.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// At `from`.
    From,
    /// At `to`.
    To,
}

/// Variables that depend on each other without a storage between them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Loop {
    /// Resistors and other elements whose laws close the loop, or variables where the junction structure closes it.
    pub through: &'static [&'static str],
    /// What closes it.
    pub class: LoopClass,
    /// Number of variables.
    pub variables: usize,
    /// How it is solved.
    pub solver: Solver,
}

/// What closes an algebraic loop, by the zero-order causal paths of van Dijk and Breedveld, J. Franklin Inst. 328
/// (1991).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoopClass {
    /// Resistors: class 2.
    Resistive,
    /// Junctions, transformers and gyrators alone: classes 3 and 4. Class 5, with a gain of one, is no model.
    Structural,
}

/// How an algebraic loop is solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Solver {
    /// Directly.
    Linear,
    /// By a bounded Newton iteration with the exact Jacobian.
    Newton {
        /// How many of the variables it finds; the others follow from them.
        unknowns: usize,
        /// Most evaluations of residual and Jacobian from one start.
        iterations: usize,
    },
}

impl core::fmt::Display for Solver {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Linear => formatter.write_str("linear"),
            Self::Newton {
                unknowns,
                iterations,
            } => {
                let plural = if *unknowns == 1 { "" } else { "s" };
                write!(
                    formatter,
                    "Newton, {unknowns} unknown{plural}, at most {iterations} iterations"
                )
            }
        }
    }
}

/// Arithmetic per call: an addition, subtraction, multiplication, division or elementary function counts one, sine
/// and cosine of one angle two, a bounded solve one evaluation of its residual and Jacobian, negations and whatever
/// `new` has done once count nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Operations {
    /// Of `derivative`.
    pub derivative: usize,
    /// Of `output`.
    pub output: usize,
    /// Of `derivative_and_jacobian`; where several columns or rows are worked out at once, each counts in full, with what is
    /// left out because none of them changes it.
    pub derivative_and_jacobian: usize,
    /// Of `jacobian_input`, counted alike.
    pub jacobian_input: usize,
    /// Of `energy`.
    pub energy: usize,
    /// Of `power`.
    pub power: usize,
    /// Angles of which `derivative` takes sine and cosine.
    pub angles: usize,
}
