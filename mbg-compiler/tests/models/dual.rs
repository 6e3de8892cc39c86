//! Programs on dual numbers: values and slopes along one direction, exact to rounding. The machine stands apart from that
//! of the compiler, whose library knows no scalar but `f64`: dual numbers belong to the runtime, on which it does not
//! depend.

use std::collections::BTreeMap;

use mbg_compiler::program::{Operand, Program, Routine, Solver, Source, Step, Sweep};
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
    let mut machine = Machine {
        point,
        folded,
        values: Vec::new(),
        changing: Vec::new(),
        solved: BTreeMap::new(),
        matrices: BTreeMap::new(),
    };
    machine.steps(&routine.steps);
    let mut results = machine.results(&routine.results);
    results.extend(machine.jacobian(&routine.sweeps));
    results
}

#[derive(Clone)]
struct Machine<'a> {
    point: &'a Point<'a>,
    folded: &'a [Dual<f64>],
    values: Vec<Dual<f64>>,
    /// The variables that change, or the rates with a weight.
    changing: Vec<usize>,
    /// Unknowns of solves.
    solved: BTreeMap<usize, Vec<Dual<f64>>>,
    /// Their matrices.
    matrices: BTreeMap<usize, Vec<Dual<f64>>>,
}

impl Machine<'_> {
    /// A Jacobian by rows.
    fn jacobian(&self, sweeps: &[Sweep]) -> Vec<Dual<f64>> {
        let [rows, columns] = sweeps.first().map_or([0; 2], |it| it.coverage.size);
        let mut entries = vec![Dual::constant(0.0); rows * columns];
        for sweep in sweeps {
            for unit in &sweep.coverage.units {
                let one = if unit.negative { -1.0 } else { 1.0 };
                entries[unit.row * columns + unit.column] = Dual::constant(one);
            }
            for direction in &sweep.coverage.directions {
                let mut inner = self.clone();
                inner.changing = direction.iter().map(|it| it.number).collect();
                inner.values.resize(sweep.first, Dual::constant(f64::NAN));
                inner.steps(&sweep.steps);
                let slopes = inner.results(&sweep.results);
                for line in direction {
                    for entry in &line.entries {
                        let (row, column) = sweep.coverage.place(line, *entry);
                        entries[row * columns + column] = slopes[*entry];
                    }
                }
            }
        }
        entries
    }

    fn steps(&mut self, steps: &[Step]) {
        for step in steps {
            let value = match step {
                Step::Add(a, b) => self.read(a) + self.read(b),
                Step::Multiply(a, b) => self.read(a) * self.read(b),
                Step::MultiplyAdd(a, b, c) => self.read(a) * self.read(b) + self.read(c),
                Step::Divide(a, b) => self.read(a) / self.read(b),
                Step::Sine(a) => self.read(a).sin(),
                Step::Cosine(a) => self.read(a).cos(),
                Step::SineCosine(a) => {
                    let (sine, cosine) = self.read(a).sin_cos();
                    self.values.push(sine);
                    cosine
                }
                Step::Call(Function::Sqrt, operands) => self.read(&operands[0]).sqrt(),
                Step::Call(Function::Exp, operands) => self.read(&operands[0]).exp(),
                Step::Call(Function::Tanh, operands) => self.read(&operands[0]).tanh(),
                Step::Call(Function::Abs, operands) => self.read(&operands[0]).abs(),
                Step::Call(Function::Max, operands) => {
                    self.read(&operands[0]).max(self.read(&operands[1]))
                }
                Step::Call(function, _) => panic!("no model here calls {function:?}"),
                Step::Solve(solve) => {
                    let results = self.results(&solve.results);
                    let (right, matrix) = results.split_at(solve.size);
                    let matrix = match solve.solver {
                        Solver::Linear(Kind::Regular | Kind::Symmetric) => matrix.to_vec(),
                        Solver::Slope(of) => Vec::clone(&self.matrices[&of]),
                        _ => panic!("a loop is iterated"),
                    };
                    self.solved.insert(solve.number, regular(right, &matrix));
                    self.matrices.insert(solve.number, matrix);
                    continue;
                }
            };
            self.values.push(value);
        }
    }

    fn results(&self, operands: &[Operand]) -> Vec<Dual<f64>> {
        operands.iter().map(|operand| self.read(operand)).collect()
    }

    fn read(&self, operand: &Operand) -> Dual<f64> {
        let value = match operand.source {
            Source::Constant(value) => Dual::constant(value),
            Source::Symbol(Symbol::State(index)) => self.point.state[index],
            Source::Symbol(Symbol::Input(index)) => self.point.input[index],
            Source::Symbol(Symbol::Time) => self.point.time,
            Source::Symbol(Symbol::Parameter(index)) => {
                Dual::constant(self.point.parameters[index])
            }
            Source::Symbol(Symbol::Slope(index)) => {
                Dual::constant(f64::from(self.changing.contains(&index)))
            }
            Source::Symbol(Symbol::Signal(_)) => panic!("no program reads a signal"),
            Source::Symbol(Symbol::Unknown(_)) => panic!("no program reads an unknown"),
            Source::Folded(index) => self.folded[index],
            Source::Value(index) => self.values[index],
            Source::Solved(place) => self.solved[&place.number][place.row],
        };
        if operand.negative { -value } else { value }
    }
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

/// Whether a program iterates, which dual numbers here do not.
pub(crate) fn iterates(program: &Program) -> bool {
    let mut steps = program.routines.iter().flat_map(|routine| &routine.steps);
    steps.any(|step| match step {
        Step::Solve(solve) => !matches!(
            solve.solver,
            Solver::Linear(Kind::Regular | Kind::Symmetric) | Solver::Slope(_)
        ),
        _ => false,
    })
}
