//! The cases, and what is expected of each.

#[path = "../../methods/double_pendulum.rs"]
mod double_pendulum;
#[path = "../../../tests/references/errors.rs"]
mod errors;
mod friction;
mod inputs;
#[path = "../../ins/models.rs"]
#[allow(dead_code)]
mod ins;
#[path = "../../ins/reference.rs"]
#[allow(dead_code)]
mod ins_reference;
mod mechanisms;
mod models;
mod orientation;
#[path = "../../methods/problems.rs"]
#[allow(dead_code)]
mod problems;
#[path = "../../../tests/orientation/reference.rs"]
#[allow(dead_code)]
mod rotations;
mod steps;
mod stiffness;

use std::fmt;
use std::time::Instant;

use errors::{apart, larger};
use mbg_runtime::{Statistics, Stopped};

/// A case by its name: some methods on one problem.
pub(crate) type Case = (&'static str, fn() -> Vec<Line>);

/// All cases.
pub(crate) const CASES: &[Case] = &[
    ("gimbal lock", orientation::gimbal_lock),
    ("sleeping top", orientation::sleeping_top),
    ("tumbling", orientation::tumbling),
    ("stiff pins", stiffness::pins),
    ("constants of the INS", stiffness::navigation),
    ("chaos", mechanisms::double_pendulum),
    ("singular loops", mechanisms::singular_loops),
    ("impacts", mechanisms::impacts),
    ("dry friction", friction::dry),
    ("single precision", steps::single_precision),
    ("steps too long", steps::too_long),
    ("steps too short", steps::too_short),
    ("gust", inputs::gust),
    ("pulses", inputs::pulses),
];

/// What must come of a run.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Expected {
    /// An error of at most so much.
    Within(f64),
    /// A refusal whose text contains this.
    Refused(&'static str),
}

/// What came of a run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found {
    pub(crate) error: f64,
    pub(crate) steps: u64,
}

impl Found {
    /// Of a run that has not been made: no bound holds for it.
    pub(crate) const NONE: Self = Self {
        error: f64::INFINITY,
        steps: 0,
    };

    pub(crate) fn new(error: f64, statistics: Statistics) -> Self {
        Self {
            error,
            steps: statistics.steps + statistics.rejected,
        }
    }
}

/// A line of the report.
pub(crate) struct Line {
    case: &'static str,
    method: String,
    reference: &'static str,
    expected: Expected,
    found: Result<Found, Stopped>,
    /// In s.
    time: f64,
}

impl Line {
    /// Runs a case with a method.
    pub(crate) fn run(
        (case, method, reference): (&'static str, impl Into<String>, &'static str),
        expected: Expected,
        run: impl FnOnce() -> Result<Found, Stopped>,
    ) -> Self {
        let start = Instant::now();
        let found = run();
        Self {
            case,
            method: method.into(),
            reference,
            expected,
            found,
            time: start.elapsed().as_secs_f64(),
        }
    }

    /// Whether it came as expected.
    pub(crate) fn holds(&self) -> bool {
        match (&self.found, self.expected) {
            (Ok(found), Expected::Within(bound)) => found.error <= bound,
            (Err(stopped), Expected::Refused(text)) => {
                stopped.time.is_finite() && stopped.to_string().contains(text)
            }
            _ => false,
        }
    }
}

/// Titles of the columns.
pub(crate) const HEAD: &str = "\
case                               method               reference                      steps  time / ms  result
---------------------------------------------------------------------------------------------------------------";

impl fmt::Display for Line {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (case, method, reference, time) =
            (self.case, &self.method, self.reference, 1e3 * self.time);
        let steps = match &self.found {
            Ok(found) => found.steps.to_string(),
            Err(_) => "-".to_owned(),
        };
        write!(
            formatter,
            "{case:<35}{method:<21}{reference:<27}{steps:>9}{time:>11.1}  "
        )?;
        match (&self.found, self.expected) {
            (Ok(found), Expected::Within(bound)) => {
                write!(formatter, "error {:.1e}, at most {bound:.0e}", found.error)?;
            }
            (Ok(found), Expected::Refused(_)) => {
                write!(formatter, "error {:.1e}, not refused", found.error)?;
            }
            (Err(stopped), _) => write!(formatter, "{stopped}")?,
        }
        formatter.write_str(if self.holds() {
            ""
        } else {
            "  NOT AS EXPECTED"
        })
    }
}
