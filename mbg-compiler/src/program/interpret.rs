//! Running a program without compiling it, to check it against what it was made from.

use super::{Operand, Program, Routine, Source, Step};
use crate::symbolic::Symbol;

/// What a program is run with.
pub struct Arguments<'a> {
    /// Parameters.
    pub parameters: &'a [f64],
    /// Time.
    pub time: f64,
    /// State.
    pub state: &'a [f64],
    /// Inputs.
    pub input: &'a [f64],
}

/// Results of the routine with this number.
#[must_use]
pub fn evaluate(program: &Program, routine: usize, arguments: &Arguments) -> Vec<f64> {
    let folded = run(&program.folded, arguments, &[]);
    run(&program.routines[routine], arguments, &folded)
}

fn run(routine: &Routine, arguments: &Arguments, folded: &[f64]) -> Vec<f64> {
    let mut values = Vec::new();
    for step in &routine.steps {
        let read = |operand: &Operand| read(operand, arguments, folded, &values);
        let value = match step {
            Step::Add(a, b) => read(a) + read(b),
            Step::Multiply(a, b) => read(a) * read(b),
            Step::Divide(a, b) => read(a) / read(b),
            Step::Sine(a) => read(a).sin(),
            Step::Cosine(a) => read(a).cos(),
            Step::SineCosine(a) => {
                let (sine, cosine) = read(a).sin_cos();
                values.push(sine);
                cosine
            }
            Step::Call(function, operands) => {
                let operands: Vec<f64> = operands.iter().map(read).collect();
                function.evaluate(&operands)
            }
        };
        values.push(value);
    }
    routine
        .results
        .iter()
        .map(|result| read(result, arguments, folded, &values))
        .collect()
}

fn read(operand: &Operand, arguments: &Arguments, folded: &[f64], values: &[f64]) -> f64 {
    let value = match operand.source {
        Source::Constant(value) => value,
        Source::Symbol(Symbol::Parameter(index)) => arguments.parameters[index],
        Source::Symbol(Symbol::State(index)) => arguments.state[index],
        Source::Symbol(Symbol::Input(index)) => arguments.input[index],
        Source::Symbol(Symbol::Time) => arguments.time,
        Source::Symbol(Symbol::Signal(_)) => f64::NAN,
        Source::Folded(index) => folded[index],
        Source::Value(index) => values[index],
    };
    if operand.negative { -value } else { value }
}
