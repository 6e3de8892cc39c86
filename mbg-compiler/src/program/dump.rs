//! A routine as text.

use std::fmt::Write;

use super::{Operand, Routine, Solve, Solver, Source, Step};
use crate::symbolic::{Place, Symbol};

/// The routine as text, one step a line; an iteration is indented, and so is the first turn of a repeat.
#[must_use]
pub fn dump(routine: &Routine) -> String {
    let mut text = String::new();
    let (all, names) = (&routine.steps, &routine.names);
    let (mut step, mut value) = (0, 0);
    for repeat in &routine.repeats {
        steps(&mut text, &all[step..repeat.steps.start], names, value, 0);
        let _ = writeln!(text, "{} turns", repeat.turns);
        steps(&mut text, repeat.turn(all), names, repeat.first, 1);
        step = repeat.steps.end;
        value = repeat.first + repeat.turns * repeat.values;
    }
    steps(&mut text, &all[step..], names, value, 0);
    let _ = writeln!(text, "return {}", list(&routine.results));
    text
}

/// Writes steps whose values begin with number `value`.
fn steps(text: &mut String, steps: &[Step], names: &[String], mut value: usize, depth: usize) {
    let indent = "  ".repeat(depth);
    for step in steps {
        match step {
            Step::Solve(solve) => solution(text, solve, names, value, depth),
            _ => {
                let line = format!("{indent}{}", line(step, value));
                let name = &names[value];
                let _ = if name.is_empty() {
                    writeln!(text, "{line}")
                } else {
                    writeln!(text, "{line:<28} {name}")
                };
            }
        }
        value += step.results();
    }
}

fn solution(text: &mut String, solve: &Solve, names: &[String], value: usize, depth: usize) {
    let indent = "  ".repeat(depth);
    let unknowns: Vec<String> = (0..solve.size)
        .map(|row| {
            let number = solve.number;
            operand(Operand::plain(Source::Solved(Place { number, row })))
        })
        .collect();
    let _ = writeln!(text, "{indent}solve {}", unknowns.join(", "));
    steps(text, &solve.steps, names, value, depth + 1);
    let (first, matrix) = solve.results.split_at(solve.size);
    let _ = match solve.solver {
        Solver::Newton(_) => writeln!(
            text,
            "{indent}  zero {}\n{indent}  by {}",
            list(first),
            list(matrix)
        ),
        Solver::Linear(_) => writeln!(
            text,
            "{indent}  right {}\n{indent}  matrix {}",
            list(first),
            list(matrix)
        ),
        Solver::Slope(of) => writeln!(
            text,
            "{indent}  right {}\n{indent}  matrix of z{of}",
            list(first)
        ),
    };
}

fn line(step: &Step, value: usize) -> String {
    match step {
        Step::Add(a, b) => {
            let sign = if b.negative { '-' } else { '+' };
            format!(
                "v{value} = {} {sign} {}",
                operand(*a),
                operand(Operand::plain(b.source))
            )
        }
        Step::Multiply(a, b) => format!("v{value} = {} * {}", operand(*a), operand(*b)),
        Step::MultiplyAdd(a, b, c) => {
            let sign = if c.negative { '-' } else { '+' };
            format!(
                "v{value} = {} * {} {sign} {}",
                operand(*a),
                operand(*b),
                operand(Operand::plain(c.source))
            )
        }
        Step::Divide(a, b) => format!("v{value} = {} / {}", operand(*a), operand(*b)),
        Step::SineCosine(a) => format!("v{value}, v{} = sin_cos({})", value + 1, operand(*a)),
        Step::Sine(a) => format!("v{value} = sin({})", operand(*a)),
        Step::Cosine(a) => format!("v{value} = cos({})", operand(*a)),
        Step::Call(function, arguments) => {
            let arguments: Vec<_> = arguments.iter().copied().map(operand).collect();
            format!("v{value} = {}({})", function.name(), arguments.join(", "))
        }
        Step::Solve(_) => String::new(),
    }
}

fn list(operands: &[Operand]) -> String {
    let operands: Vec<_> = operands.iter().copied().map(operand).collect();
    format!("[{}]", operands.join(", "))
}

fn operand(operand: Operand) -> String {
    let text = match operand.source {
        Source::Constant(value) => crate::symbolic::print::number(value),
        Source::Symbol(Symbol::Parameter(index)) => format!("k{index}"),
        Source::Symbol(Symbol::State(index)) => format!("x{index}"),
        Source::Symbol(Symbol::Input(index)) => format!("u{index}"),
        Source::Symbol(Symbol::Time) => "t".to_owned(),
        Source::Symbol(Symbol::Slope(index)) => format!("d{index}"),
        Source::Symbol(Symbol::Signal(index) | Symbol::Unknown(index)) => format!("signal{index}"),
        Source::Folded(index) => format!("c{index}"),
        Source::Value(index) => format!("v{index}"),
        Source::Solved(place) => format!("z{}_{}", place.number, place.row),
    };
    if operand.negative {
        format!("-{text}")
    } else {
        text
    }
}
