//! Sweeps of a Jacobian: steps that give some of its columns or rows, run for each direction, or for several at once.

use super::{Operand, Step, read};
use crate::symbolic::Expression;

/// What a sweep goes through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// From variables that change to what rates do: it gives columns.
    Forward,
    /// From rates with weights to what their sum takes from each variable: it gives rows.
    Reverse,
}

/// A column of a Jacobian, or a row in [`Mode::Reverse`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line {
    /// The variable by which it is the derivative; of a row the rate.
    pub number: usize,
    /// Where in it the entries are that the sweep gives: by rate, in a row by variable.
    pub entries: Vec<usize>,
}

/// Columns of which no two share a row, or rows of which no two share a column, so that one run of the steps gives them all.
pub type Direction = Vec<Line>;

/// An entry that is one or minus one, the only one of its row in a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unit {
    /// The rate.
    pub row: usize,
    /// The variable.
    pub column: usize,
    /// Whether it is minus one.
    pub negative: bool,
}

/// The entries that a sweep gives.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Coverage {
    /// How many rows and columns the Jacobian has.
    pub size: [usize; 2],
    /// Whether it gives columns or rows.
    pub mode: Mode,
    /// What one run of the steps gives each.
    pub directions: Vec<Direction>,
    /// What it gives without steps.
    pub units: Vec<Unit>,
}

impl Coverage {
    /// Row and column of an entry of a line.
    #[must_use]
    pub fn place(&self, line: &Line, entry: usize) -> (usize, usize) {
        match self.mode {
            Mode::Forward => (entry, line.number),
            Mode::Reverse => (line.number, entry),
        }
    }
}

/// What a sweep is asked for.
#[derive(Clone, Debug)]
pub struct Slopes {
    /// The entries.
    pub coverage: Coverage,
    /// Linear in the [`Symbol::Slope`](crate::symbolic::Symbol::Slope)s of what changes or has a weight: how each rate changes,
    /// or by what each variable is multiplied.
    pub forms: Vec<Expression>,
}

/// Steps that are run for each direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// The entries.
    pub coverage: Coverage,
    /// Number of the first value.
    pub first: usize,
    /// Steps. All are linear in the slopes or weights; all else that they read is worked out before.
    pub steps: Vec<Step>,
    /// The forms.
    pub results: Vec<Operand>,
}

impl Sweep {
    /// The same with other steps and results.
    pub(super) fn with(
        &self,
        step: &dyn Fn(&Step) -> Step,
        result: &dyn Fn(Operand) -> Operand,
    ) -> Self {
        Self {
            coverage: self.coverage.clone(),
            first: self.first,
            steps: self.steps.iter().map(step).collect(),
            results: self.results.iter().copied().map(result).collect(),
        }
    }

    /// What it reads or returns.
    pub(super) fn operands(&self) -> Vec<Operand> {
        read(&self.steps, &self.results)
    }
}
