//! Running a program without compiling it, to check it against what it was made from.

use std::collections::BTreeMap;

use super::iterate::{consistent, iterate};
use super::{Operand, Program, Routine, Solve, Solver, Source, Step, Sweep};
use crate::symbolic::evaluate::regular;
use crate::symbolic::{Kind, Symbol};

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

/// Results of the routine with this number; a Jacobian that it returns besides follows by rows.
#[must_use]
pub fn evaluate(program: &Program, routine: usize, arguments: &Arguments) -> Vec<f64> {
    let folded = run(&program.folded, arguments, &[]);
    run(&program.routines[routine], arguments, &folded)
}

fn run(routine: &Routine, arguments: &Arguments, folded: &[f64]) -> Vec<f64> {
    let mut machine = Machine {
        arguments,
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
    arguments: &'a Arguments<'a>,
    folded: &'a [f64],
    values: Vec<f64>,
    /// The variables that change, or the rates with a weight.
    changing: Vec<usize>,
    /// Unknowns by iteration.
    solved: BTreeMap<usize, Vec<f64>>,
    /// Matrices of linear solves.
    matrices: BTreeMap<usize, (Kind, Vec<f64>)>,
}

impl Machine<'_> {
    /// A Jacobian by rows.
    fn jacobian(&self, sweeps: &[Sweep]) -> Vec<f64> {
        let [rows, columns] = sweeps.first().map_or([0; 2], |it| it.coverage.size);
        let mut entries = vec![0.0; rows * columns];
        for sweep in sweeps {
            let coverage = &sweep.coverage;
            for unit in &coverage.units {
                let one = if unit.negative { -1.0 } else { 1.0 };
                entries[unit.row * columns + unit.column] = one;
            }
            for (place, direction) in coverage.directions.iter().enumerate() {
                let slopes = self.slopes(sweep, place);
                for line in direction {
                    for entry in &line.entries {
                        let (row, column) = coverage.place(line, *entry);
                        entries[row * columns + column] = slopes[*entry];
                    }
                }
            }
        }
        entries
    }

    /// What a sweep gives in the direction in a place.
    fn slopes(&self, sweep: &Sweep, place: usize) -> Vec<f64> {
        let mut inner = self.clone();
        let direction = sweep.coverage.directions[place].iter();
        inner.changing = direction.map(|it| it.number).collect();
        inner.values.resize(sweep.first, f64::NAN);
        let mut rest = &sweep.steps[..];
        for stretch in sweep.stretches() {
            let (steps, behind) = rest.split_at(stretch.steps);
            inner.stretch(steps, stretch.changes_in(place));
            rest = behind;
        }
        inner.results(&sweep.results)
    }

    /// Steps, or zeros for them where nothing changes them.
    fn stretch(&mut self, steps: &[Step], changes: bool) {
        if changes {
            return self.steps(steps);
        }
        let values: usize = steps.iter().map(Step::results).sum();
        self.values.resize(self.values.len() + values, 0.0);
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
                Step::Call(function, operands) => function.evaluate(&self.results(operands)),
                Step::Solve(solve) if !matches!(solve.solver, Solver::Newton(_)) => {
                    let (right, matrix) = self.linear(solve);
                    let (kind, matrix) = match solve.solver {
                        Solver::Slope(of) => self.matrices[&of].clone(),
                        Solver::Linear(kind) => (kind, matrix),
                        Solver::Newton(_) => (Kind::Regular, matrix),
                    };
                    let found = match kind {
                        Kind::Semidefinite => consistent(&right, &matrix),
                        Kind::Regular | Kind::Symmetric => regular(&right, &matrix),
                    };
                    self.solved.insert(solve.number, found);
                    self.matrices.insert(solve.number, (kind, matrix));
                    continue;
                }
                Step::Solve(solve) => {
                    let found = iterate(solve.size, |unknowns| {
                        let mut inner = self.clone();
                        inner.solved.insert(solve.number, unknowns.to_vec());
                        inner.steps(&solve.steps);
                        inner.results(&solve.results)
                    });
                    self.solved.insert(solve.number, found);
                    // Nobody reads the numbers that values inside have taken.
                    let taken = self.values.len() + step.results();
                    self.values.resize(taken, f64::NAN);
                    continue;
                }
            };
            self.values.push(value);
        }
    }

    /// Right side and matrix, as far as the solve has them.
    fn linear(&self, solve: &Solve) -> (Vec<f64>, Vec<f64>) {
        let (right, matrix) = solve.results.split_at(solve.size);
        (self.results(right), self.results(matrix))
    }

    fn results(&self, operands: &[Operand]) -> Vec<f64> {
        operands.iter().map(|operand| self.read(operand)).collect()
    }

    fn read(&self, operand: &Operand) -> f64 {
        let value = match operand.source {
            Source::Constant(value) => value,
            Source::Symbol(Symbol::Parameter(index)) => self.arguments.parameters[index],
            Source::Symbol(Symbol::State(index)) => self.arguments.state[index],
            Source::Symbol(Symbol::Input(index)) => self.arguments.input[index],
            Source::Symbol(Symbol::Time) => self.arguments.time,
            Source::Symbol(Symbol::Slope(index)) => f64::from(self.changing.contains(&index)),
            Source::Symbol(Symbol::Signal(_) | Symbol::Unknown(_)) => f64::NAN,
            Source::Folded(index) => self.folded[index],
            Source::Value(index) => self.values[index],
            Source::Solved(place) => self.solved[&place.number][place.row],
        };
        if operand.negative { -value } else { value }
    }
}
