//! Programs on dual numbers: values and slopes along one direction, exact to rounding.

use std::collections::BTreeMap;

use mbg_compiler::program::{Operand, Program, Routine, Solver, Source, Step};
use mbg_compiler::symbolic::{Function, Kind, Symbol};
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
    let (mut solved, mut matrices) = (BTreeMap::new(), BTreeMap::new());
    for step in &routine.steps {
        let read = |operand: &Operand| read(operand, point, folded, (&values, &solved));
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
            Step::Solve(solve) => {
                let results: Vec<Dual<f64>> = solve.results.iter().map(read).collect();
                let (right, matrix) = results.split_at(solve.size);
                let matrix = match solve.solver {
                    Solver::Linear(Kind::Regular) => matrix.to_vec(),
                    Solver::Slope(of) => Vec::clone(&matrices[&of]),
                    _ => panic!("a loop is iterated"),
                };
                solved.insert(solve.number, regular(right, &matrix));
                matrices.insert(solve.number, matrix);
                continue;
            }
        };
        values.push(value);
    }
    let read = |operand| read(operand, point, folded, (&values, &solved));
    routine.results.iter().map(read).collect()
}

/// Gaussian elimination with row pivots, chosen by their values relative to their rows.
fn regular(right: &[Dual<f64>], matrix: &[Dual<f64>]) -> Vec<Dual<f64>> {
    let size = right.len();
    let mut rows: Vec<Vec<Dual<f64>>> = (0..size)
        .map(|row| {
            let entries = &matrix[row * size..][..size];
            let largest = entries
                .iter()
                .fold(0.0_f64, |largest, it| largest.max(it.value.abs()));
            let scaled = |it: &Dual<f64>| *it / Dual::constant(largest);
            entries.iter().chain([&right[row]]).map(scaled).collect()
        })
        .collect();
    for k in 0..size {
        let largest = (k..size)
            .max_by(|a, b| rows[*a][k].value.abs().total_cmp(&rows[*b][k].value.abs()))
            .unwrap();
        rows.swap(k, largest);
        let pivot = rows[k].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(row, _)| *row != k) {
            let factor = row[k] / pivot[k];
            for (entry, above) in row.iter_mut().zip(&pivot) {
                *entry -= factor * *above;
            }
        }
    }
    (0..size).map(|k| rows[k][size] / rows[k][k]).collect()
}

/// Values by number, and unknowns of solves.
type Made<'a> = (&'a [Dual<f64>], &'a BTreeMap<usize, Vec<Dual<f64>>>);

fn read(operand: &Operand, point: &Point, folded: &[Dual<f64>], made: Made) -> Dual<f64> {
    let value = match operand.source {
        Source::Constant(value) => Dual::constant(value),
        Source::Symbol(Symbol::State(index)) => point.state[index],
        Source::Symbol(Symbol::Input(index)) => point.input[index],
        Source::Symbol(Symbol::Time) => point.time,
        Source::Symbol(Symbol::Parameter(index)) => Dual::constant(point.parameters[index]),
        Source::Symbol(Symbol::Signal(_)) => panic!("no program reads a signal"),
        Source::Symbol(Symbol::Slope(_)) => panic!("only columns of Jacobians read slopes"),
        Source::Folded(index) => folded[index],
        Source::Value(index) => made.0[index],
        Source::Solved(place) => made.1[&place.number][place.row],
        Source::Symbol(Symbol::Unknown(_)) => panic!("no program reads an unknown"),
    };
    if operand.negative { -value } else { value }
}

/// Whether a program iterates, which dual numbers here do not.
pub(crate) fn iterates(program: &Program) -> bool {
    let mut steps = program.routines.iter().flat_map(|routine| &routine.steps);
    steps.any(|step| match step {
        Step::Solve(solve) => !matches!(
            solve.solver,
            Solver::Linear(Kind::Regular) | Solver::Slope(_)
        ),
        _ => false,
    })
}
