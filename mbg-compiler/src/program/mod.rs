//! Stage 6, program: straight-line arithmetic, by how often it changes.
//!
//! Input: expressions for everything a model is asked. Output: a [`Program`]: one list of steps per function, each
//! with only what it needs, and one list that is worked out once, when a model is built. No error is reported here.

mod interpret;
mod schedule;

use crate::symbolic::{Function, Symbol};

pub use interpret::{Arguments, evaluate};
pub use schedule::build;

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
}

impl Step {
    /// How many values it gives.
    #[must_use]
    pub fn results(&self) -> usize {
        if matches!(self, Self::SineCosine(_)) {
            2
        } else {
            1
        }
    }

    /// What it reads.
    #[must_use]
    pub fn operands(&self) -> Vec<Operand> {
        match self {
            Self::Add(a, b) | Self::Multiply(a, b) | Self::Divide(a, b) => vec![*a, *b],
            Self::SineCosine(a) | Self::Sine(a) | Self::Cosine(a) => vec![*a],
            Self::Call(_, operands) => operands.clone(),
        }
    }

    /// How many operations it counts: sine and cosine of one angle two, anything else one.
    #[must_use]
    pub fn operations(&self) -> usize {
        self.results()
    }
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
}

impl Routine {
    /// Operations per call.
    #[must_use]
    pub fn operations(&self) -> usize {
        self.steps.iter().map(Step::operations).sum()
    }

    /// Angles of which sine or cosine is taken.
    #[must_use]
    pub fn angles(&self) -> usize {
        self.steps
            .iter()
            .filter(|step| matches!(step, Step::SineCosine(_) | Step::Sine(_) | Step::Cosine(_)))
            .count()
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
            routine.results.iter().all(finite)
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
}

/// The routine as text, one step a line.
#[must_use]
pub fn dump(routine: &Routine) -> String {
    use std::fmt::Write;
    let mut text = String::new();
    let mut value = 0;
    for step in &routine.steps {
        let line = match step {
            Step::Add(a, b) => {
                let sign = if b.negative { '-' } else { '+' };
                format!(
                    "v{value} = {} {sign} {}",
                    operand(*a),
                    operand(Operand::plain(b.source))
                )
            }
            Step::Multiply(a, b) => format!("v{value} = {} * {}", operand(*a), operand(*b)),
            Step::Divide(a, b) => format!("v{value} = {} / {}", operand(*a), operand(*b)),
            Step::SineCosine(a) => format!("v{value}, v{} = sin_cos({})", value + 1, operand(*a)),
            Step::Sine(a) => format!("v{value} = sin({})", operand(*a)),
            Step::Cosine(a) => format!("v{value} = cos({})", operand(*a)),
            Step::Call(function, arguments) => {
                let arguments: Vec<_> = arguments
                    .iter()
                    .map(|argument| operand(*argument))
                    .collect();
                format!("v{value} = {}({})", function.name(), arguments.join(", "))
            }
        };
        let name = &routine.names[value];
        let _ = if name.is_empty() {
            writeln!(text, "{line}")
        } else {
            writeln!(text, "{line:<28} {name}")
        };
        value += step.results();
    }
    let results: Vec<_> = routine
        .results
        .iter()
        .map(|result| operand(*result))
        .collect();
    let _ = writeln!(text, "return [{}]", results.join(", "));
    text
}

fn operand(operand: Operand) -> String {
    let text = match operand.source {
        Source::Constant(value) => crate::symbolic::print::number(value),
        Source::Symbol(Symbol::Parameter(index)) => format!("k{index}"),
        Source::Symbol(Symbol::State(index)) => format!("x{index}"),
        Source::Symbol(Symbol::Input(index)) => format!("u{index}"),
        Source::Symbol(Symbol::Time) => "t".to_owned(),
        Source::Symbol(Symbol::Signal(index)) => format!("signal{index}"),
        Source::Folded(index) => format!("c{index}"),
        Source::Value(index) => format!("v{index}"),
    };
    if operand.negative {
        format!("-{text}")
    } else {
        text
    }
}
