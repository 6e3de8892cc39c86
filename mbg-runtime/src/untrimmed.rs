//! Why what is wanted of a model was not found.

use crate::{Stopped, Trouble};

/// Why there is no operating point, or no motion that comes back.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Untrimmed {
    /// A name that is none of the model's.
    Unknown {
        /// Of what it should be the name.
        kind: &'static str,
        /// The name.
        name: &'static str,
    },
    /// Conditions that cannot be met from the guess.
    Missed {
        /// The state whose rate, or the output, that is farthest from what is wanted beside the terms it is made of.
        name: &'static str,
        /// Whether it is an output.
        is_output: bool,
        /// What is wanted.
        wanted: f64,
        /// What was reached.
        reached: f64,
        /// Whether nothing that may be chosen has an influence on it.
        is_fixed: bool,
        /// What may be chosen and has no influence at all there, though it has elsewhere, such as an input beyond a limiter.
        idle: Option<&'static str>,
    },
    /// A point that no motion from the guess reaches: what two states differ by that change alike whatever is done, such as the
    /// displacements of two springs at one junction, would have to be something else. With the differences of the guess none was
    /// found, and there may be none, as beyond the voltage at which a plate is pulled in.
    Apart {
        /// One of the states.
        name: &'static str,
        /// The other one.
        other: &'static str,
        /// By what number the change of the other one is to be multiplied to be that of the first one.
        times: f64,
        /// The first one without so many of the other one in the guess, as it stays.
        kept: f64,
        /// What it would have to be.
        needed: f64,
    },
    /// Constraints of closed loops depend on each other there, as those of a parallelogram whose bars are in line: which forces
    /// hold it is not determined. Ask for a point beside it.
    Singular {
        /// The input that is not determined.
        input: &'static str,
        /// What was found.
        here: f64,
        /// By how much another state that is as closed may ask for another one.
        error: f64,
    },
    /// A motion that does not come back.
    Open {
        /// The state that is farthest from what is wanted beside the terms it is made of.
        name: &'static str,
        /// By how much it is to grow.
        wanted: f64,
        /// By how much it does.
        reached: f64,
        /// Whether nothing that may be chosen has an influence on it.
        is_fixed: bool,
    },
    /// A motion on which the state that tells the period is not what it was after half to twice the period that was given, or rests.
    Away {
        /// The state.
        name: &'static str,
        /// Its value at the start.
        value: f64,
    },
    /// A motion that comes back, but not for ever: laws that depend on time, or on what has grown, are others a period later.
    Driven {
        /// The state on which that has the largest effect.
        name: &'static str,
        /// The period, s.
        period: f64,
        /// By how much it would change otherwise within the next period.
        change: f64,
    },
    /// The motion from the guess cannot go on.
    Stopped(Stopped),
    /// The model is in trouble there.
    Trouble(Trouble),
}

impl core::fmt::Display for Untrimmed {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match *self {
            Self::Unknown { kind, name } => write_unknown(formatter, kind, name),
            Self::Missed {
                name,
                is_output,
                wanted,
                reached,
                is_fixed,
                idle,
            } => {
                write_missed(formatter, (name, is_output), [wanted, reached])?;
                if !wanted.is_finite() {
                    return Ok(());
                }
                write_choices(formatter, name, (is_output, is_fixed))?;
                match idle {
                    Some(idle) => write!(
                        formatter,
                        "; `{idle}` is beyond a limit, where it has no influence"
                    ),
                    None => Ok(()),
                }
            }
            Self::Apart {
                name,
                other,
                times,
                kept,
                needed,
            } => {
                write_difference(formatter, [name, other], times)?;
                write!(
                    formatter,
                    " is {kept:e} and stays so in every motion, but the point that was found asks for {needed:e}: begin with that, \
                     fix or free one of them, or let more be chosen"
                )
            }
            Self::Singular { input, here, error } => write!(
                formatter,
                "`{input}` is {here:e}, give or take {error:e}: constraints of closed loops depend on each other there, so that it \
                 is not determined; ask for a point beside it"
            ),
            Self::Open {
                name,
                wanted,
                reached,
                is_fixed,
            } => {
                write!(
                    formatter,
                    "`{name}` grows by {reached:e} instead of {wanted:e}, and "
                )?;
                if !is_fixed {
                    return formatter.write_str(
                        "no motion was found that does better: begin elsewhere, or let more be chosen",
                    );
                }
                write!(
                    formatter,
                    "nothing that may be chosen has an influence on it: write `.grows(\"{name}\", …)`, or `.free(\"{name}\")` \
                     where it need not come back"
                )
            }
            Self::Away { name, value } => write!(
                formatter,
                "`{name}` does not go through {value:e} again after half to twice the period that was given: give another period, or \
                 a state that the motion goes through"
            ),
            Self::Driven {
                name,
                period,
                change,
            } => write!(
                formatter,
                "the motion comes back after {period:e} s, but its laws do not: within the next period `{name}` would change \
                 otherwise by {change:e}; give a whole period of what drives it, and growths that leave laws as they are"
            ),
            Self::Stopped(stopped) => stopped.fmt(formatter),
            Self::Trouble(trouble) => trouble.fmt(formatter),
        }
    }
}

/// A name that is none of the model's.
fn write_unknown(
    formatter: &mut core::fmt::Formatter<'_>,
    kind: &str,
    name: &str,
) -> core::fmt::Result {
    write!(formatter, "the model has no {kind} `{name}`")?;
    formatter.write_str(match kind {
        _ if name.ends_with(']') => {
            ": components of vectors are called `.x`, `.y` and `.z`, of longer ones `.0` and so on"
        }
        "state" | "state or input" => ": a position or an angle that nothing reads is none",
        _ => "",
    })
}

/// A condition that is not met, or that nothing can meet.
fn write_missed(
    formatter: &mut core::fmt::Formatter<'_>,
    (name, is_output): (&str, bool),
    [wanted, reached]: [f64; 2],
) -> core::fmt::Result {
    let of = if is_output { "" } else { "the rate of " };
    match wanted.is_finite() {
        true => write!(
            formatter,
            "{of}`{name}` is {reached:e} instead of {wanted:e}, and "
        ),
        false => write!(
            formatter,
            "{of}`{name}` is to be {wanted:e}, which nothing is"
        ),
    }
}

/// What may be chosen where a condition is not met.
fn write_choices(
    formatter: &mut core::fmt::Formatter<'_>,
    name: &str,
    (is_output, is_fixed): (bool, bool),
) -> core::fmt::Result {
    if !is_fixed {
        return formatter.write_str(
            "no choice was found that does better: begin elsewhere, or let more be chosen",
        );
    }
    formatter.write_str("nothing that may be chosen has an influence on it")?;
    if is_output {
        return Ok(());
    }
    write!(
        formatter,
        " there: begin elsewhere, or write `.free(\"{name}\")` where it is to change"
    )
}

/// One state without so many of another one.
fn write_difference(
    formatter: &mut core::fmt::Formatter<'_>,
    [name, other]: [&str; 2],
    times: f64,
) -> core::fmt::Result {
    let sign = if times < 0.0 { '+' } else { '-' };
    write!(formatter, "`{name}` {sign} ")?;
    if times.abs() != 1.0 {
        write!(formatter, "{} ", times.abs())?;
    }
    write!(formatter, "`{other}`")
}

impl core::error::Error for Untrimmed {}
