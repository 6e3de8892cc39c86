//! How a run ends.

use core::fmt;

use nalgebra::SVector;

use crate::Trouble;

/// A run that reached its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finished<T, const N: usize> {
    /// The end of the time span; its start when the span is empty.
    pub time: f64,
    /// The state then.
    pub state: SVector<T, N>,
    /// What it took.
    pub statistics: Statistics,
}

/// What a run took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Steps that count.
    pub steps: u64,
    /// Calls of [`System::derivative`](crate::System::derivative).
    pub evaluations: u64,
    /// Steps that error control refused and tried again shorter.
    pub rejected: u64,
}

/// A run that could not reach its end.
///
/// The text names the time and the state or the block: `stopped at t = 1.25: state `wheel.p` is not finite`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stopped {
    /// The time of the first state that is not to be trusted; for the causes of step control, the last good time.
    pub time: f64,
    /// Why.
    pub cause: Cause,
}

/// Why a run stopped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cause {
    /// The model says that it must not be trusted there.
    Trouble(Trouble),
    /// A state is infinite or NaN.
    NotFinite {
        /// Its name in [`Meta::states`](crate::Meta::states).
        state: &'static str,
    },
    /// The step is zero, negative, NaN or too short for the clock; or error control asked for such a step.
    StepTooSmall,
    /// The limit of [`Adaptive::most_steps`](crate::Adaptive::most_steps) is reached.
    TooManySteps,
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
            Self::NotFinite { state } => write!(formatter, "state `{state}` is not finite"),
            Self::StepTooSmall => formatter.write_str("the step is too small to advance the time"),
            Self::TooManySteps => formatter.write_str("the limit on the number of steps is reached"),
        }
    }
}

impl core::error::Error for Stopped {}
