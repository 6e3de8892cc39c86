//! What a generated model is to everything that runs it.

use nalgebra::{SMatrix, SVector};

use crate::input::quotient;
use crate::step::Element;
use crate::{Columns, Course, Loop, Memory, Meta, Real, Rooms, Solver, Sparsity, Variable};

/// A state-space model `ẋ = f(t, x, u)`, `y = h(t, x, u)` with `N` states, `M` inputs and `P` outputs.
///
/// `mbg!` implements it for every scalar that implements [`Real`]. A model written by hand may implement it, too: the methods that
/// have a default say what holds "unless it is given".
///
/// To run a model, see [`Integrator`](crate::Integrator). To evaluate it directly, pass a time, a state, an input and a `memory`:
/// `&mut ()` for a model without nonlinear algebraic loops, else `&mut Default::default()`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a system with this scalar and these sizes",
    note = "the sizes are the numbers of states, inputs and outputs, as the documentation of the generated type says"
)]
pub trait System<T: Real, const N: usize, const M: usize, const P: usize> {
    /// Names, units, strokes and counts, known at compile time.
    const META: &'static Meta;

    /// Where `∂f/∂x` can differ from zero; everywhere unless it is given.
    ///
    /// Generated models give it, together with a plan by which implicit methods eliminate where that is faster. Where a pivot is
    /// too small beside its column, these search for pivots in the whole matrix instead.
    const SPARSITY: Option<&'static Sparsity> = None;

    /// Whether time influences the derivative only through the input; `false` unless it is given.
    ///
    /// Generated models give it. Where it is `false`, [`Adaptive`](crate::Adaptive) looks for pulses that its steps may miss.
    const AUTONOMOUS: bool = false;

    /// Warm starts and residuals of the nonlinear algebraic loops; `()` for a model without any.
    type Memory: Memory;

    /// One value per inverted block, as [`conditioning`](Self::conditioning) gives it; an array.
    type Conditioning: AsRef<[T]> + Copy;

    /// [`Room<K>`](crate::Room) for thresholds at which a motion stays at once, in a system that tells of the
    /// [`courses`](Self::courses) of K arguments, and of 64 if there are more; `Room<0>` in one that tells of none, which runs do not ask
    /// then.
    type Room: Rooms;

    /// The state at the start, from the model's `initial:` values.
    #[must_use]
    fn initial_state(&self) -> SVector<T, N>;

    /// Time derivative of the state.
    #[must_use]
    fn derivative(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &mut Self::Memory,
    ) -> SVector<T, N>;

    /// [`derivative`](Self::derivative), written to `derivative`, every entry. A generated model writes each as soon as it is
    /// known, so that those of a large one wait in no register. Unless it is given, it calls [`derivative`](Self::derivative). An
    /// implementation should be marked `#[inline(always)]`, so that batches take the instructions of their caller.
    #[inline(always)]
    fn derivative_into(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &mut Self::Memory,
        derivative: &mut SVector<T, N>,
    ) {
        *derivative = self.derivative(t, x, u, memory);
    }

    /// [`derivative`](Self::derivative) at four stages of a step, each with its time, state and input.
    ///
    /// Generated models without nonlinear loops evaluate all four at once where the scalar has lanes. Unless it is
    /// given, one stage follows the other.
    #[must_use]
    fn derivatives(
        &self,
        t: T::Stages,
        x: &SVector<T::Stages, N>,
        u: &SVector<T::Stages, M>,
        memory: &mut Self::Memory,
    ) -> SVector<T::Stages, N> {
        let slopes: [SVector<T, N>; 4] = core::array::from_fn(|stage| {
            let x = x.map(|state| state.as_columns()[stage]);
            let u = u.map(|input| input.as_columns()[stage]);
            self.derivative(t.as_columns()[stage], &x, &u, memory)
        });
        SVector::from_fn(|state, _| T::Stages::from_columns(|stage| slopes[stage][state]))
    }

    /// Outputs.
    #[must_use]
    fn output(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &mut Self::Memory,
    ) -> SVector<T, P>;

    /// `∂f/∂x`, exact.
    #[must_use]
    fn jacobian_state(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &mut Self::Memory,
    ) -> SMatrix<T, N, N>;

    /// [`derivative`](Self::derivative) and [`jacobian_state`](Self::jacobian_state) at once; a generated model evaluates what
    /// both need only once.
    #[must_use]
    fn derivative_and_jacobian(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &mut Self::Memory,
    ) -> (SVector<T, N>, SMatrix<T, N, N>) {
        let derivative = self.derivative(t, x, u, memory);
        (derivative, self.jacobian_state(t, x, u, memory))
    }

    /// [`derivative_and_jacobian`](Self::derivative_and_jacobian), written to `derivative` and `jacobian` without a copy. Entries
    /// of the Jacobian that are zero in every state, those outside of [`SPARSITY`](Self::SPARSITY), may be left as they are: begin
    /// with a matrix of zeros.
    fn derivative_and_jacobian_into(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &mut Self::Memory,
        derivative: &mut SVector<T, N>,
        jacobian: &mut SMatrix<T, N, N>,
    ) {
        (*derivative, *jacobian) = self.derivative_and_jacobian(t, x, u, memory);
    }

    /// `∂f/∂u`, exact.
    #[must_use]
    fn jacobian_input(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &mut Self::Memory,
    ) -> SMatrix<T, N, M>;

    /// `∂f/∂t` at a fixed state and input.
    ///
    /// Generated models give it exactly. Unless it is given, it is zero where the model is [`AUTONOMOUS`](Self::AUTONOMOUS),
    /// else a difference quotient over five evaluations of [`System::derivative`] ahead, whose error falls with the fourth
    /// power of `ahead`, the length of the step.
    #[must_use]
    fn derivative_time(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &mut Self::Memory,
        ahead: T,
    ) -> SVector<T, N> {
        if Self::AUTONOMOUS {
            return SVector::from_element(T::from_f64(0.0));
        }
        quotient(t, ahead, |t| self.derivative(t, x, u, memory))
    }

    /// Energy stored in `I` and `C`, in joule if the model is in SI units. Weights are sources and no part of it, see
    /// [energy](crate::language#energy).
    #[must_use]
    fn energy(&self, t: T, x: &SVector<T, N>) -> T;

    /// Power supplied by the sources and dissipated by the resistors: `dH/dt = supplied − dissipated`, where the energy of
    /// each storage depends on its own state alone; [`Meta::notes`] names those where it does not.
    #[must_use]
    fn power(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &mut Self::Memory,
    ) -> Power<T>;

    /// The first time later than `t` at which a choice in the laws changes by time alone, such as that of `if t < 1.0 { … }` or
    /// `if mod(t, 1e-3) < 3e-4 { … }`, or at which a curve over time has a point. Integrators end a step there, as at a jump of the
    /// input. Periodic changes have no first one: for `t` = −∞ it is any of them.
    #[must_use]
    fn next_change(&self, _t: T) -> Option<T> {
        None
    }

    /// Whether a choice of the laws may change at a time that [`change_between`](Self::change_between) finds; `false` unless it is
    /// given.
    const SEEKS_CHANGES: bool = false;

    /// The first time strictly between two times at which a choice in the laws changes by time and inputs without being told by
    /// [`next_change`](Self::next_change), such as where a sine of time meets a triangle, or `mod(t, period)` an input. It is found
    /// where the difference of what is compared has changed its sign, or what is counted has gone over a whole number; two such
    /// times without a told change in between are missed. Integrators end a step there.
    #[must_use]
    fn change_between(&self, _from: T, _to: T, _input: impl Fn(T) -> SVector<T, M>) -> Option<T> {
        None
    }

    /// Whether a choice of the laws by time and inputs is another at one time than at another, by what the laws compare as they
    /// round it. Times of changes are told but for rounding, and next to one integrators take the laws of a time that is on their own
    /// side by this.
    #[must_use]
    fn has_changed(&self, _from: T, _to: T, _input: impl Fn(T) -> SVector<T, M>) -> bool {
        false
    }

    /// Calls `each` for every argument of a choice in the laws, with its course between two points and its thresholds. Each point
    /// is a time, a state with its derivative, and an input with its own. The argument of `if q > 1.0 && q < 1.1 { … }` has two
    /// thresholds, that of a curve over `q` has one at each of its points.
    ///
    /// [`Adaptive`](crate::Adaptive) looks into a step that passes a threshold, since its estimate of the error may be small by
    /// chance, and between thresholds where it passes several, since neither ends nor stages of the step may meet what is there.
    /// Where an argument turns in between, as `x * x + y * y` does when a place is passed by, thresholds count twice that it may go
    /// over and back: those on this side of where its tangents at both points meet. On [`Dual`](crate::Dual) numbers, steps end at
    /// the thresholds at which a law jumps, those of constant length at its kinks, too. A motion may stay at a threshold whose argument
    /// is told with its rate.
    ///
    /// Generated models give it, for arguments in which states have a part, or inputs where a law jumps. Waves over time or one
    /// state, such as `cos(q) > 0.9`, turn often, so half turns of their angles are told as well, with two thresholds each. It
    /// tells of none unless it is given.
    #[inline]
    fn courses(
        &self,
        _from: (T, [&SVector<T, N>; 2], [&SVector<T, M>; 2]),
        _to: (T, [&SVector<T, N>; 2], [&SVector<T, M>; 2]),
        _memory: &mut Self::Memory,
        _each: impl FnMut(Course<'_, T>),
    ) {
    }

    /// Whether one of these arguments goes as an input does. If none does, runs do not work out how fast inputs change, and give zeros
    /// in the place of that.
    const COURSES_FOLLOW_INPUTS: bool = true;

    /// Whether it tells of any, as there is [`Room`](Self::Room) for them.
    const HAS_COURSES: bool = <Self::Room as Rooms>::COUNT > 0;

    /// The normalised determinant of each inverted block, in the order of [`Meta::conditioning`]; a model is at the
    /// edge of its singular set where one of them is zero. One whose size is that of inertias is divided by the largest
    /// that it has at some other orientations of joints, all else at its start. One that is solved with numbers has the
    /// reciprocal of the largest component of a solution, scaled to rows and columns of about one.
    #[must_use]
    fn conditioning(&self, t: T, x: &SVector<T, N>, u: &SVector<T, M>) -> Self::Conditioning;

    /// Why the last evaluation at this state must not be trusted, if there is a reason:
    ///
    /// - a state is not finite (the derivative is not evaluated; where that is not finite, the state after the next step is not);
    /// - the normalised determinant of an inverted block is below the square root of the scalar's precision, so that the block is
    ///   too near its singular set;
    /// - the last solve of a nonlinear algebraic loop did not converge.
    ///
    /// Integrators ask once a step.
    #[must_use]
    fn trouble(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &Self::Memory,
    ) -> Option<Trouble> {
        match Self::stopped_at(x, u, memory) {
            None => Trouble::of_conditioning(Self::META, self.conditioning(t, x, u).as_ref()),
            found => found,
        }
    }

    /// [`trouble`](Self::trouble), and where there is none the determinants. Unless it is given, these are worked out for each:
    /// who gives it has the trouble of this trait.
    #[doc(hidden)]
    fn examined(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &Self::Memory,
    ) -> Result<Self::Conditioning, Trouble> {
        match self.trouble(t, x, u, memory) {
            None => Ok(self.conditioning(t, x, u)),
            Some(trouble) => Err(trouble),
        }
    }

    /// The trouble that is seen without the determinants.
    #[doc(hidden)]
    #[inline]
    fn stopped_at(x: &SVector<T, N>, u: &SVector<T, M>, memory: &Self::Memory) -> Option<Trouble> {
        if let Some(trouble) = Self::unsolved(memory) {
            return Some(trouble);
        }
        let trouble = Trouble::of_state(Self::META, x)?;
        Some(trouble.traced(Self::META, u))
    }

    /// The state next to `x` at which every loop that multipliers close is closed, positions first, then flows, and
    /// every attitude is a rotation: quaternions have length one, rotation matrices orthonormal rows.
    ///
    /// The correction of a loop is that of least norm in the states, by Gauss and Newton; that of an attitude is
    /// [`orthonormal`](crate::attitude::orthonormal). States whose indices are in `fixed` stay as they are, so that consistent
    /// initial values are found from a part of them; an attitude stays of which one state is fixed. Integrators close at the
    /// start and after each step, with nothing fixed.
    ///
    /// What is left of each residual g is below 16 ε Σ |∂g/∂xᵢ xᵢ| of the one for which that is largest; a displacement counts as
    /// one at least, an angle being zero somewhere. Flows that cancel may leave more, as near a dead centre: 16 times what rounding
    /// is seen to leave of them.
    ///
    /// # Errors
    ///
    /// [`Trouble::Open`] with the loop that cannot be closed from there.
    fn close(
        &self,
        _t: T,
        x: SVector<T, N>,
        _u: &SVector<T, M>,
        _fixed: &[usize],
    ) -> Result<SVector<T, N>, Trouble> {
        Ok(x)
    }

    /// Whether states are rotations, which [`upright`](Self::upright) makes of those beside them.
    #[doc(hidden)]
    const HAS_ATTITUDES: bool = false;

    /// The state at which every attitude is a rotation, all else as it is.
    #[doc(hidden)]
    #[inline]
    fn upright(x: SVector<T, N>) -> SVector<T, N> {
        x
    }

    /// Whether the plan of elimination is written out below.
    #[doc(hidden)]
    const UNROLLED: bool = false;

    /// Factors by the plan of elimination, those of `L` and `U` in the place of the matrix with the pivots' reciprocals on
    /// the diagonal; whether all pivots hold.
    #[doc(hidden)]
    fn eliminate<E: Element>(_entry: impl Fn(usize, usize) -> E, _rows: &mut [[E; N]; N]) -> bool {
        false
    }

    /// A solution by the factors that `eliminate` has left.
    #[doc(hidden)]
    fn substitute<E: Element>(_rows: &[[E; N]; N], _x: &mut [E; N]) {}

    /// The first algebraic loop whose last solve did not converge.
    #[must_use]
    fn unsolved(memory: &Self::Memory) -> Option<Trouble> {
        let (number, residual) = memory.unsolved()?;
        let iterated = |found: &&Loop| matches!(found.solver, Solver::Newton { .. });
        let found = Self::META.loops.iter().filter(iterated).nth(number);
        let through = found.map_or(&[][..], |found| found.through);
        Some(Trouble::Unsolved { through, residual })
    }
}

/// Why a loop is not closed that has no coordinate left.
fn write_locked(
    formatter: &mut core::fmt::Formatter<'_>,
    constraints: usize,
    coordinates: usize,
) -> core::fmt::Result {
    if coordinates == 0 {
        return formatter.write_str(
            ": no coordinate moves its ends against each other; see whether both are fixed, or parts of one body",
        );
    }
    let held = match constraints {
        1 => "constraint holds",
        _ => "constraints hold",
    };
    let plural = if coordinates == 1 { "" } else { "s" };
    write!(
        formatter,
        ": {constraints} {held} {coordinates} coordinate{plural}, so that nothing moves unless some are redundant; see whether a \
         cut holds more than it should"
    )
}

/// Power across a model's border.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Power<T> {
    /// From the sources into the model.
    pub supplied: T,
    /// Lost in resistors.
    pub dissipated: T,
}

/// Why an evaluation must not be trusted.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Trouble {
    /// A state, or its derivative, is infinite or NaN.
    NotFinite {
        /// The first such state, as [`Meta::states`] names it.
        state: &'static str,
    },
    /// An input is infinite or NaN, and so is a state, or its derivative.
    InputNotFinite {
        /// The first such input, as [`Meta::inputs`] names it.
        input: &'static str,
    },
    /// An entry of a Jacobian is infinite or NaN, though the state is finite: a law has no finite slope there, as a square root
    /// at zero.
    JacobianNotFinite {
        /// The state whose derivative, or the output, it belongs to, as [`Meta::states`] and [`Meta::outputs`] name them.
        of: &'static str,
        /// The state or the input by which that is differentiated.
        by: &'static str,
    },
    /// A singular set is too near.
    Singular {
        /// The block, as [`Meta::conditioning`] names it.
        name: &'static str,
        /// Its normalised determinant.
        value: f64,
    },
    /// A step went over a singular set: a determinant has the other sign behind it.
    SteppedOver {
        /// The block, as [`Meta::conditioning`] names it.
        name: &'static str,
        /// Its normalised determinants before and behind the step.
        values: [f64; 2],
    },
    /// Loops that multipliers close could not be closed.
    Open {
        /// The closure that is open widest, as [`Meta::closures`] names it; a mistake may be in another one.
        name: &'static str,
        /// What is left between its ends.
        residual: f64,
        /// Whether so little is left that corrections would have ended in rounding, had constraints not become dependent on
        /// each other there.
        singular: bool,
        /// How many constraints there are on how many coordinates, where the constraints are not fewer: these loops move
        /// only if some constraints are redundant.
        locked: Option<(usize, usize)>,
    },
    /// A nonlinear algebraic loop was not solved.
    Unsolved {
        /// What it runs through, as [`Meta::loops`] names it.
        through: &'static [&'static str],
        /// What is left, scaled.
        residual: f64,
    },
}

impl Trouble {
    /// Of the first determinant that is too small, or no number, in some lane.
    pub(crate) fn of_conditioning<T: Real>(meta: &'static Meta, values: &[T]) -> Option<Self> {
        let mut named = meta.conditioning.iter().zip(values);
        named.find_map(|(name, value)| {
            value
                .find(|lane| lane.is_nan() || lane.abs() < T::SINGULAR)
                .map(|value| Self::Singular { name, value })
        })
    }

    /// Of the first state that is infinite or NaN in some lane.
    #[inline]
    pub(crate) fn of_state<T: Real, const N: usize>(
        meta: &'static Meta,
        x: &SVector<T, N>,
    ) -> Option<Self> {
        // Without a branch per state, since nearly always all are finite.
        if x.as_slice()
            .iter()
            .fold(true, |all, state| all & is_finite(state))
        {
            return None;
        }
        Some(Self::of_first_state(meta, x))
    }

    #[cold]
    #[inline(never)]
    fn of_first_state<T: Real, const N: usize>(meta: &'static Meta, x: &SVector<T, N>) -> Self {
        let index = x.iter().position(|state| !is_finite(state));
        let state = index.map_or("?", |index| name(meta.states, index));
        Self::NotFinite { state }
    }

    /// Of the input, where that is what is not finite beside a state.
    #[cold]
    #[inline(never)]
    pub(crate) fn traced<T: Real, const M: usize>(
        self,
        meta: &'static Meta,
        u: &SVector<T, M>,
    ) -> Self {
        match self {
            Self::NotFinite { .. } => Self::of_input(meta, u).unwrap_or(self),
            _ => self,
        }
    }

    /// Of the first input that is infinite or NaN in some lane.
    pub(crate) fn of_input<T: Real, const M: usize>(
        meta: &'static Meta,
        u: &SVector<T, M>,
    ) -> Option<Self> {
        let index = u.iter().position(|input| !is_finite(input))?;
        Some(Self::InputNotFinite {
            input: name(meta.inputs, index),
        })
    }

    /// Of the first entry of a Jacobian that is infinite or NaN in some lane, whose rows and columns belong to these variables.
    pub(crate) fn of_jacobian<T: Real, const R: usize, const C: usize>(
        jacobian: &SMatrix<T, R, C>,
        [rows, columns]: [&'static [Variable]; 2],
    ) -> Option<Self> {
        let mut entries = jacobian.data.0.iter().enumerate();
        entries.find_map(|(column, entries)| {
            let row = entries.iter().position(|entry| !is_finite(entry))?;
            Some(Self::JacobianNotFinite {
                of: name(rows, row),
                by: name(columns, column),
            })
        })
    }
}

fn name(variables: &'static [Variable], index: usize) -> &'static str {
    variables.get(index).map_or("?", |variable| variable.name)
}

#[inline]
fn is_finite<T: Real>(number: &T) -> bool {
    number.magnitude().is_finite()
}

impl core::fmt::Display for Trouble {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::NotFinite { state } => {
                write!(formatter, "state `{state}` or its derivative is not finite")
            }
            Self::InputNotFinite { input } => write!(formatter, "input `{input}` is not finite"),
            Self::JacobianNotFinite { of, by } => write!(
                formatter,
                "the Jacobian is not finite: the derivative of `{of}` by `{by}`"
            ),
            Self::Singular { name, value } => {
                write!(formatter, "{name} is {value:e}, too near its singular set")
            }
            Self::SteppedOver {
                name,
                values: [before, behind],
            } => write!(
                formatter,
                "{name} went from {before:e} to {behind:e} in one step, over its singular set"
            ),
            Self::Open {
                name,
                residual,
                singular,
                locked,
            } => {
                write!(
                    formatter,
                    "the loop `{name}` cannot be closed, {residual:e} is left"
                )?;
                if *singular {
                    formatter.write_str(
                        " next to a position in which constraints depend on each other",
                    )?;
                }
                if let Some((constraints, coordinates)) = locked {
                    write_locked(formatter, *constraints, *coordinates)?;
                }
                Ok(())
            }
            Self::Unsolved { through, residual } => {
                formatter.write_str("the algebraic loop through ")?;
                for (index, name) in through.iter().enumerate() {
                    let comma = if index == 0 { "" } else { ", " };
                    write!(formatter, "{comma}`{name}`")?;
                }
                match residual.is_nan() {
                    true => formatter.write_str(
                        " was not solved: a law of it has no value there, as where it divides by zero",
                    ),
                    false => write!(formatter, " was not solved, {residual:e} is left"),
                }
            }
        }
    }
}

impl core::error::Error for Trouble {}

/// A parameter that breaks an assumption of the chosen causality.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ParameterError {
    /// The parameter, or the expression of parameters.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// What it must be, and what relies on that.
    pub reason: &'static str,
}

impl core::fmt::Display for ParameterError {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(
            formatter,
            "`{}` is {:e}: {}",
            self.name, self.value, self.reason
        )
    }
}

impl core::error::Error for ParameterError {}

#[cfg(test)]
mod tests {
    use std::boxed::Box;

    use super::*;

    #[test]
    fn trouble_is_handed_on_as_any_error() {
        let singular = Trouble::Singular {
            name: "det",
            value: 0.0,
        };
        let error: Box<dyn core::error::Error> = singular.into();
        assert!(error.downcast_ref::<Trouble>() == Some(&singular));
        let cause: Box<dyn core::error::Error> = crate::Cause::Guard.into();
        assert!(cause.is::<crate::Cause>());
    }
}
