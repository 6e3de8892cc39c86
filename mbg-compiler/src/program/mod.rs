//! Stage 6, program: straight-line arithmetic, by how often it changes.
//!
//! Input: expressions for everything a model is asked. Output: a [`Program`]: one list of steps per function, each
//! with only what it needs, and one list that is worked out once, when a model is built. No error is reported here.
//!
//! `schedule` makes the steps out of expressions. Six passes follow, none of which changes what a function returns but for
//! rounding and the signs of zeros: `reorder` has late terms added last, `contract` takes products into sums, `signs` makes
//! negatives where they save an instruction, `hoist` takes out of sweeps of a Jacobian what is the same in all, `arrange` puts
//! the steps in the order in which a processor begins them, and `stretches` those of sweeps in an order in which some can be
//! left out. Of a long routine `repeats` finds the loops; its steps stay in their order.

mod arrange;
mod contract;
mod dump;
#[cfg(test)]
mod fixtures;
mod hoist;
mod interpret;
mod iterate;
mod latency;
#[cfg(test)]
mod property;
mod reorder;
mod repeats;
mod schedule;
mod signs;
mod stretches;
mod sweep;

use std::borrow::Cow;
use std::collections::BTreeSet;

use crate::operands::Operands;
use crate::symbolic::{Expression, Function, Kind, Place, Symbol};

pub use dump::dump;
pub use interpret::{Arguments, evaluate};
pub use repeats::{Reading, Repeat};
pub use schedule::build;
pub use stretches::Stretch;
pub use sweep::{Coverage, Direction, Line, Mode, Slopes, Sweep, Unit};

/// Where an operand's value is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source {
    /// A number.
    Constant(f64),
    /// A parameter, state, input or time.
    Symbol(Symbol),
    /// Worked out when the model was built.
    Folded(usize),
    /// A value of this function.
    Value(usize),
    /// What an iteration has found, or inside of it where it stands.
    Solved(Place),
}

/// A value with a sign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Operand {
    /// The value.
    pub source: Source,
    /// Whether it is negated.
    pub negative: bool,
}

/// One line of a program.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// Sum.
    Add(Operand, Operand),
    /// Product.
    Multiply(Operand, Operand),
    /// The product of the first two, and the third.
    MultiplyAdd(Operand, Operand, Operand),
    /// Quotient.
    Divide(Operand, Operand),
    /// Sine and cosine of one angle; gives two values, the sine first.
    SineCosine(Operand),
    /// Sine alone.
    Sine(Operand),
    /// Cosine alone.
    Cosine(Operand),
    /// Another function.
    Call(Function, Vec<Operand>),
    /// A bounded iteration.
    Solve(Solve),
}

/// How a solve finds its unknowns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solver {
    /// Newton's iteration, with its number among those of the model.
    Newton(usize),
    /// Linear equations.
    Linear(Kind),
    /// The same with the matrix of an earlier solve, of which this is the number.
    Slope(usize),
}

/// A solve. What does not depend on the unknowns is worked out before it.
#[derive(Clone, Debug, PartialEq)]
pub struct Solve {
    /// Number of the definition, see [`Place::number`].
    pub number: usize,
    /// How.
    pub solver: Solver,
    /// How many unknowns there are.
    pub size: usize,
    /// Steps of one evaluation; their values go on from those before, and end with it.
    pub steps: Vec<Step>,
    /// Residuals, or right sides where they are linear; then the derivatives of residuals by rows, unless they are those
    /// of an earlier solve.
    pub results: Vec<Operand>,
}

impl Step {
    /// How many numbers of values it takes.
    #[must_use]
    pub fn results(&self) -> usize {
        match self {
            Self::SineCosine(_) => 2,
            Self::Solve(solve) => solve.steps.iter().map(Self::results).sum(),
            _ => 1,
        }
    }

    /// What it reads.
    #[must_use]
    pub fn operands(&self) -> Operands<'_, Operand> {
        match self {
            Self::Add(a, b) | Self::Multiply(a, b) | Self::Divide(a, b) => Operands::Two([*a, *b]),
            Self::MultiplyAdd(a, b, c) => Operands::Three([*a, *b, *c]),
            Self::SineCosine(a) | Self::Sine(a) | Self::Cosine(a) => Operands::One([*a]),
            Self::Call(_, operands) => Operands::Many(Cow::Borrowed(operands)),
            Self::Solve(solve) => Operands::Many(read(&solve.steps, &solve.results).into()),
        }
    }

    /// The same step with other operands; that of a solve holds its steps as well.
    #[must_use]
    pub fn with(&self, other: &dyn Fn(Operand) -> Operand) -> Self {
        let all = |operands: &[Operand]| operands.iter().map(|it| other(*it)).collect();
        match self {
            Self::Add(a, b) => Self::Add(other(*a), other(*b)),
            Self::Multiply(a, b) => Self::Multiply(other(*a), other(*b)),
            Self::MultiplyAdd(a, b, c) => Self::MultiplyAdd(other(*a), other(*b), other(*c)),
            Self::Divide(a, b) => Self::Divide(other(*a), other(*b)),
            Self::SineCosine(a) => Self::SineCosine(other(*a)),
            Self::Sine(a) => Self::Sine(other(*a)),
            Self::Cosine(a) => Self::Cosine(other(*a)),
            Self::Call(function, operands) => Self::Call(*function, all(operands)),
            Self::Solve(solve) => Self::Solve(Solve {
                steps: solve.steps.iter().map(|it| it.with(other)).collect(),
                results: all(&solve.results),
                ..solve.clone()
            }),
        }
    }

    /// How many operations it counts: sine and cosine of one angle two, a product and a sum two, an iteration those of
    /// one evaluation, anything else one.
    #[must_use]
    pub fn operations(&self) -> usize {
        match self {
            Self::MultiplyAdd(..) | Self::SineCosine(_) => 2,
            Self::Solve(solve) => solve.steps.iter().map(Self::operations).sum(),
            _ => 1,
        }
    }

    /// Angles of which it takes sine or cosine.
    fn angles(&self) -> usize {
        match self {
            Self::SineCosine(_) | Self::Sine(_) | Self::Cosine(_) => 1,
            Self::Solve(solve) => solve.steps.iter().map(Self::angles).sum(),
            _ => 0,
        }
    }
}

/// Most angles side by side: four `f64` fill a register of AVX, and more at once would not be kept in registers.
const ANGLES: usize = 4;

/// The angles of the first steps, whose sines and cosines are evaluated side by side: those of what was there before. The
/// steps' values begin with number `value`.
#[must_use]
pub fn angles(steps: &[Step], value: usize) -> Vec<Operand> {
    let angle = |step: &Step| match step {
        Step::SineCosine(angle) => match angle.source {
            Source::Value(earlier) if (value..value + 2 * ANGLES).contains(&earlier) => None,
            _ => Some(*angle),
        },
        _ => None,
    };
    steps.iter().map_while(angle).take(ANGLES).collect()
}

/// What a function is asked for.
#[derive(Clone, Debug, Default)]
pub struct Request {
    /// Its results.
    pub results: Vec<Expression>,
    /// Sweeps of a Jacobian that is not among the results.
    pub sweeps: Vec<Slopes>,
}

impl From<Vec<Expression>> for Request {
    fn from(results: Vec<Expression>) -> Self {
        Self {
            results,
            sweeps: Vec::new(),
        }
    }
}

/// The number of the first value of each step, and of the next behind them all.
fn starts(steps: &[Step]) -> Vec<usize> {
    let mut starts = vec![0];
    for step in steps {
        starts.push(starts[starts.len() - 1] + step.results());
    }
    starts
}

/// What steps read, and what is returned of them.
fn read(steps: &[Step], results: &[Operand]) -> Vec<Operand> {
    let mut read = Vec::new();
    for step in steps {
        read.extend_from_slice(&step.operands());
    }
    read.extend_from_slice(results);
    read
}

/// A function: steps in order of evaluation, and what it returns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Routine {
    /// Steps; values are numbered in order.
    pub steps: Vec<Step>,
    /// A readable name for each value, or nothing.
    pub names: Vec<String>,
    /// Results.
    pub results: Vec<Operand>,
    /// Sweeps of a Jacobian that is returned besides; their values go on from those of the steps.
    pub sweeps: Vec<Sweep>,
    /// Steps that are written as loops, in order.
    pub repeats: Vec<Repeat>,
}

impl Routine {
    /// Operations per call.
    #[must_use]
    pub fn operations(&self) -> usize {
        let count = |steps: &[Step]| -> usize { steps.iter().map(Step::operations).sum() };
        let sweeps = self.sweeps.iter();
        let sweeps = sweeps.map(|it| it.coverage.directions.len() * count(&it.steps));
        count(&self.steps) + sweeps.sum::<usize>()
    }

    /// The values that sweeps of a Jacobian read, ascending.
    #[must_use]
    pub fn kept(&self) -> Vec<usize> {
        let first = self.sweeps.first().map_or(0, |it| it.first);
        let value = |operand: Operand| match operand.source {
            Source::Value(value) if value < first => Some(value),
            _ => None,
        };
        let read = self.sweeps.iter().flat_map(Sweep::operands);
        let kept: BTreeSet<usize> = read.filter_map(value).collect();
        kept.into_iter().collect()
    }

    /// All that it reads or returns behind its steps.
    #[must_use]
    pub fn read_behind(&self) -> Vec<Operand> {
        let read = self.sweeps.iter().flat_map(Sweep::operands);
        self.results.iter().copied().chain(read).collect()
    }

    /// Whether its steps read a symbol or return it.
    #[must_use]
    pub fn reads(&self, symbol: Symbol) -> bool {
        let is_read = |operand: &Operand| operand.source == Source::Symbol(symbol);
        let by = |step: &Step| step.operands().iter().any(is_read);
        self.steps.iter().any(by) || self.read_behind().iter().any(is_read)
    }

    /// Whether there is an iteration in it.
    #[must_use]
    pub fn iterates(&self) -> bool {
        self.steps.iter().any(
            |step| matches!(step, Step::Solve(solve) if matches!(solve.solver, Solver::Newton(_))),
        )
    }

    /// Angles of which sine or cosine is taken.
    #[must_use]
    pub fn angles(&self) -> usize {
        self.steps.iter().map(Step::angles).sum()
    }
}

/// All functions of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    /// Worked out once.
    pub folded: Routine,
    /// Functions in the order of the requests.
    pub routines: Vec<Routine>,
}

impl Program {
    /// Whether every number in it is finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        let finite = |operand: &Operand| !matches!(operand.source, Source::Constant(value) if !value.is_finite());
        self.routines.iter().chain([&self.folded]).all(|routine| {
            routine.read_behind().iter().all(finite)
                && routine
                    .steps
                    .iter()
                    .all(|step| step.operands().iter().all(finite))
        })
    }
}

impl Operand {
    /// A value without sign.
    #[must_use]
    pub fn plain(source: Source) -> Self {
        Self {
            source,
            negative: false,
        }
    }

    /// The same with new numbers of values.
    fn renumbered(self, numbers: &[usize]) -> Self {
        match self.source {
            Source::Value(value) => Self {
                source: Source::Value(numbers[value]),
                ..self
            },
            _ => self,
        }
    }
}
