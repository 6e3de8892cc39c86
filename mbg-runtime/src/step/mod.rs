//! Integrators for initial value problems.

mod adaptive;
mod approach;
mod auto;
mod control;
mod crossing;
mod dense;
mod elimination;
mod event;
mod explicit;
mod fixed;
mod gauss;
mod grid;
mod integrator;
mod jumps;
mod linear;
mod method;
#[cfg(test)]
mod models;
mod modes;
mod on_grid;
mod over;
mod pace;
mod parallel;
mod probes;
mod problem;
mod radau;
mod rosenbrock;
mod rounding;
mod slide;
mod sliding;
mod surfaces;
mod thresholds;
mod tolerance;
mod transition;
#[cfg(test)]
mod trees;
mod watch;

use core::fmt;
use core::ops::AddAssign;

use nalgebra::SVector;

use crate::{Input, Real, System, Trouble};

pub use adaptive::Adaptive;
pub use auto::{Auto, Choice, Picked, Reason};
pub use dense::Step;
pub use elimination::{Shifted, holds, largest};
pub use event::Direction;
#[cfg(feature = "numeris")]
pub use explicit::Verner9;
pub use explicit::{Dop853, Rk4, Tsit5};
pub use fixed::Fixed;
pub use gauss::{Gauss6, ImplicitMidpoint};
pub use integrator::{Arrival, Integrator};
pub(crate) use linear::Factors;
pub use linear::{Complex, Element};
pub use method::{Estimating, Method};
pub use parallel::{Pirk8, Pirk16};
pub use radau::{Radau5, Radau9};
pub use rosenbrock::{Rodas4, Rodas5P, Ros2};
pub use sliding::{Room, Rooms};
pub use transition::Transition;

/// What a simulation took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Steps taken.
    pub steps: u64,
    /// Steps tried and thrown away as too inaccurate.
    pub rejected: u64,
    /// Evaluations of [`System::derivative`].
    pub evaluations: u64,
    /// Evaluations of [`System::jacobian_state`].
    pub jacobians: u64,
    /// Matrices factorised.
    pub factorisations: u64,
}

/// What several runs took together, such as those between events.
impl AddAssign for Statistics {
    fn add_assign(&mut self, other: Self) {
        self.steps += other.steps;
        self.rejected += other.rejected;
        self.evaluations += other.evaluations;
        self.jacobians += other.jacobians;
        self.factorisations += other.factorisations;
    }
}

/// A simulation that could not go on.
///
/// Whatever the observer has been given before is valid.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Stopped {
    /// When.
    pub time: f64,
    /// Why.
    pub cause: Cause,
}

/// Why a simulation could not go on.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Cause {
    /// The model is in trouble: too near a singular set, say, or where a state, its derivative, or an entry of the Jacobian that
    /// an implicit method takes is not finite.
    Trouble(Trouble),
    /// The step is so small that time does not advance by it; the problem is stiff, or has a singularity or a law that jumps without
    /// end there.
    StepTooSmall,
    /// More steps than [`Adaptive::most`] or [`Auto::most`] allows, which a run over many jumps of an input may well need.
    ///
    /// Where the next step is short for another reason, an explicit method meets a stiff model, or a law jumps again and again, ever
    /// sooner, as a relay does that a place switches and not a rate. So it is with more than 64 thresholds at which the motion
    /// stays at once, and with one in a batch. Let such a law rise over a small width, as `tanh(v / width)` does.
    TooManySteps {
        /// The length that the next step would have, s.
        next: f64,
    },
    /// The stages of an implicit method were not found; a shorter step may help.
    Diverged,
    /// The guard of an event is not a number.
    Guard,
    /// The simulation was not set up properly.
    Argument(&'static str),
}

impl fmt::Display for Stopped {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "stopped at t = {}: {}", self.time, self.cause)
    }
}

impl fmt::Display for Cause {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Trouble(trouble) => trouble.fmt(formatter),
            Self::StepTooSmall => formatter.write_str(
                "the step is too small for time to advance: the model is stiff, or has a singularity or a law that jumps without \
                 end there, or times so far from zero are not told from each other: take f64, or begin at zero",
            ),
            Self::TooManySteps { next } => write!(
                formatter,
                "more steps than `most` allows; the next is {next:.1e} s long, which a stiff model asks of an explicit method, \
                 a tight tolerance of a method of low order, and a law that jumps ever sooner of any: let it rise within a \
                 width there, as `tanh(v / width)` does. A run over many samples that are held, or other jumps, needs a larger \
                 `most`"
            ),
            Self::Diverged => formatter
                .write_str("the stages of the step were not found, which a shorter one may help"),
            Self::Guard => formatter.write_str("the guard of the event is not a number"),
            Self::Argument(what) => formatter.write_str(what),
        }
    }
}

impl core::error::Error for Stopped {}

impl core::error::Error for Cause {}

impl Stopped {
    fn new<T: Real>(time: T, cause: Cause) -> Self {
        Self {
            time: seen(time),
            cause,
        }
    }
}

/// The number, seen as `f64`; of several lanes the first.
pub(crate) fn seen<T: Real>(number: T) -> f64 {
    number.find(|_| true).unwrap_or(f64::NAN)
}

/// Whether `a < b`, for times, which are the same in all lanes.
pub(crate) fn less<T: Real>(a: T, b: T) -> bool {
    (a - b).find(|difference| difference < 0.0).is_some()
}

/// Where the piece that begins at `from` ends, at most `end`: at a jump of the input or a change of the laws.
fn piece_end<T: Real, S, const N: usize, const M: usize, const P: usize>(
    system: &S,
    input: &(impl Input<T, M> + ?Sized),
    from: T,
    end: T,
) -> Result<T, Stopped>
where
    S: System<T, N, M, P>,
{
    let end = match system.next_change(from) {
        Some(change) if less(change, end) && !is_met(change, (from, end)) => change,
        _ => end,
    };
    let end = match input.next_jump(from) {
        Some(jump) if !less(from, jump) => {
            return Err(Stopped::new(
                from,
                Cause::Argument(
                    "the input's next jump is not later than the one before, or not a number",
                ),
            ));
        }
        Some(jump) if less(jump, end) && !is_met(jump, (from, end)) => jump,
        _ => end,
    };
    if !S::SEEKS_CHANGES {
        return Ok(end);
    }
    let change = system.change_between(from, end, |t| input.value(t, from));
    Ok(change.filter(|it| !is_met(*it, (from, end))).unwrap_or(end))
}

/// Whether a jump is the end of the run but for rounding: then the piece before it goes on to the end, and no tiny step is
/// left. A piece so short that this would count stays what it is.
fn is_met<T: Real>(jump: T, (from, end): (T, T)) -> bool {
    let left = (end - jump).magnitude();
    left <= 4.0 * T::EPSILON * end.magnitude() && 64.0 * left <= (jump - from).magnitude()
}

/// Whether a time is not the same in all lanes.
fn is_split<T: Real>(time: T) -> bool {
    let first = T::from_f64(seen(time));
    (time - first).find(|apart| apart != 0.0).is_some()
}

/// Refuses times that are not finite, infinitely far apart, go backwards or differ between lanes.
fn check_times<T: Real>(start: T, end: T) -> Result<(), Stopped> {
    if !seen(end - start).is_finite() {
        return Err(Stopped::new(
            start,
            Cause::Argument(
                "the times of start and end must be finite, and so must their distance",
            ),
        ));
    }
    let what = if [start, end].into_iter().any(|time| is_split(time)) {
        "lanes share their times: start and end must be the same in all of them"
    } else if less(end, start) {
        "the end must not be earlier than the start"
    } else {
        return Ok(());
    };
    Err(Stopped::new(start, Cause::Argument(what)))
}

/// Refuses a vector that is not finite; where an algebraic loop was not solved on the way to it, that is the cause.
#[inline]
fn check_result<T, S, const N: usize, const M: usize, const P: usize>(
    _system: &S,
    time: T,
    x: &SVector<T, N>,
    memory: &S::Memory,
) -> Result<(), Stopped>
where
    T: Real,
    S: System<T, N, M, P>,
{
    match Trouble::of_state(S::META, x) {
        None => Ok(()),
        Some(trouble) => {
            let trouble = S::unsolved(memory).unwrap_or(trouble);
            Err(Stopped::new(time, Cause::Trouble(trouble)))
        }
    }
}

#[cfg(test)]
mod tests {
    use std::string::ToString;

    use super::Cause;

    #[cfg(feature = "lanes")]
    #[test]
    fn lanes_share_their_times() {
        use super::check_times;
        use crate::Real;
        use crate::lanes::{Lanes, f64x4};

        let [start, end] = [0.0, 1.0].map(f64x4::from_f64);
        let apart = f64x4::from_lanes(|lane| 1.0 + lane as f64);
        assert!(check_times(start, end).is_ok());
        for (start, end) in [(start, apart), (apart - end, apart)] {
            let told = check_times(start, end).unwrap_err().to_string();
            assert!(told.contains("lanes share their times"), "{told}");
        }
    }

    #[test]
    fn too_many_steps_are_told_with_what_to_write_for_a_jump() {
        let told = Cause::TooManySteps { next: 1e-9 }.to_string();
        assert!(
            told.contains("1.0e-9 s") && told.contains("`tanh(v / width)`"),
            "{told}"
        );
        assert!(told.contains("many samples"), "{told}");
        assert!(Cause::StepTooSmall.to_string().contains("take f64"));
    }
}
