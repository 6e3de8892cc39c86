//! Programs on dual numbers: values and slopes along one direction, exact to rounding.

use mbg_compiler::program::{Operand, Program, Routine, Source, Step};
use mbg_compiler::symbolic::{Function, Symbol};
use mbg_runtime::{Dual, Real};

/// Where and along which direction a program runs.
#[derive(Clone, Copy)]
pub(crate) struct Point<'a> {
    pub(crate) parameters: &'a [f64],
    pub(crate) time: Dual<f64>,
    pub(crate) state: &'a [Dual<f64>],
    pub(crate) input: &'a [Dual<f64>],
}

/// Results of a routine.
pub(crate) fn evaluate(program: &Program, routine: usize, point: &Point) -> Vec<Dual<f64>> {
    let folded = run(&program.folded, point, &[]);
    run(&program.routines[routine], point, &folded)
}

fn run(routine: &Routine, point: &Point, folded: &[Dual<f64>]) -> Vec<Dual<f64>> {
    let mut values = Vec::new();
    for step in &routine.steps {
        let read = |operand: &Operand| read(operand, point, folded, &values);
        let value = match step {
            Step::Add(a, b) => read(a) + read(b),
            Step::Multiply(a, b) => read(a) * read(b),
            Step::MultiplyAdd(a, b, c) => read(a) * read(b) + read(c),
            Step::Divide(a, b) => read(a) / read(b),
            Step::Sine(a) => read(a).sin(),
            Step::Cosine(a) => read(a).cos(),
            Step::SineCosine(a) => {
                let (sine, cosine) = read(a).sin_cos();
                values.push(sine);
                cosine
            }
            Step::Call(Function::Sqrt, operands) => read(&operands[0]).sqrt(),
            Step::Call(Function::Exp, operands) => read(&operands[0]).exp(),
            Step::Call(Function::Tanh, operands) => read(&operands[0]).tanh(),
            Step::Call(function, _) => panic!("no model here calls {function:?}"),
            Step::Solve(_) => panic!("a loop is iterated"),
        };
        values.push(value);
    }
    let read = |operand| read(operand, point, folded, &values);
    routine.results.iter().map(read).collect()
}

fn read(operand: &Operand, point: &Point, folded: &[Dual<f64>], values: &[Dual<f64>]) -> Dual<f64> {
    let value = match operand.source {
        Source::Constant(value) => Dual::constant(value),
        Source::Symbol(Symbol::State(index)) => point.state[index],
        Source::Symbol(Symbol::Input(index)) => point.input[index],
        Source::Symbol(Symbol::Time) => point.time,
        Source::Symbol(Symbol::Parameter(index)) => Dual::constant(point.parameters[index]),
        Source::Symbol(Symbol::Signal(_)) => panic!("no program reads a signal"),
        Source::Folded(index) => folded[index],
        Source::Value(index) => values[index],
        Source::Solved(_) | Source::Symbol(Symbol::Unknown(_)) => panic!("a loop is iterated"),
    };
    if operand.negative { -value } else { value }
}

/// Whether a program iterates, which dual numbers here do not.
pub(crate) fn iterates(program: &Program) -> bool {
    let mut steps = program.routines.iter().flat_map(|routine| &routine.steps);
    steps.any(|step| matches!(step, Step::Solve(_)))
}
