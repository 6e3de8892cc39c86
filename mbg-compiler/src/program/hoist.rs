//! What sweeps of a Jacobian work out although no direction changes it, worked out once, before them.
//!
//! Of a product of several factors those are multiplied first that are ready first, and of such as 2 a δb that may be 2 a.

use super::{Routine, Step, Sweep};

/// The routine with such steps behind its own.
pub(super) fn hoist(routine: &Routine) -> Routine {
    let Some(first) = routine.sweeps.first().map(|it| it.first) else {
        return routine.clone();
    };
    let mut hoist = Hoist {
        steps: routine.steps.clone(),
        names: routine.names[..first].to_vec(),
        numbers: (0..routine.names.len()).collect(),
    };
    let rest: Vec<Rest> = routine
        .sweeps
        .iter()
        .map(|it| hoist.split(routine, it))
        .collect();
    let sweeps = routine.sweeps.iter().zip(rest);
    let sweeps: Vec<Sweep> = sweeps
        .map(|(sweep, rest)| hoist.rest(routine, sweep, rest))
        .collect();
    Routine {
        results: routine.results.clone(),
        steps: hoist.steps,
        names: hoist.names,
        sweeps,
        repeats: Vec::new(),
    }
}

/// Steps that stay, each with the number of its first value.
type Rest<'a> = Vec<(usize, &'a Step)>;

/// A routine in the making.
struct Hoist {
    steps: Vec<Step>,
    names: Vec<String>,
    /// The new number of each value.
    numbers: Vec<usize>,
}

impl Hoist {
    /// Takes those steps of a sweep that no direction changes, and gives the others.
    fn split<'a>(&mut self, routine: &Routine, sweep: &'a Sweep) -> Rest<'a> {
        let mut rest = Vec::new();
        let mut value = sweep.first;
        for (step, directions) in sweep.steps.iter().zip(sweep.changes()) {
            if directions.len() == 0 {
                self.append(step, value, &routine.names);
            } else {
                rest.push((value, step));
            }
            value += step.results();
        }
        rest
    }

    /// Appends a step whose values began with number `value`.
    fn append(&mut self, step: &Step, value: usize, names: &[String]) {
        let step = step.with(&|it| it.renumbered(&self.numbers));
        for place in 0..step.results() {
            self.numbers[value + place] = self.names.len();
            self.names.push(names[value + place].clone());
        }
        self.steps.push(step);
    }

    /// A sweep of the steps that stay.
    fn rest(&mut self, routine: &Routine, sweep: &Sweep, rest: Rest<'_>) -> Sweep {
        let before = std::mem::take(&mut self.steps);
        let first = self.names.len();
        for (value, step) in rest {
            self.append(step, value, &routine.names);
        }
        let steps = std::mem::replace(&mut self.steps, before);
        let results = sweep.results.iter();
        Sweep {
            coverage: sweep.coverage.clone(),
            first,
            steps,
            results: results.map(|it| it.renumbered(&self.numbers)).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::program::fixtures::{coverage, slope, state, value};
    use crate::program::{Operand, Source};

    fn sweep(first: usize, steps: Vec<Step>, result: usize) -> Sweep {
        Sweep {
            coverage: coverage(1),
            first,
            steps,
            results: vec![value(result)],
        }
    }

    #[test]
    fn what_no_direction_changes_is_worked_out_before_all_sweeps() {
        let double = |operand| Step::Multiply(Operand::plain(Source::Constant(2.0)), operand);
        let first = vec![
            Step::Multiply(slope(0), value(0)),
            double(value(0)),
            Step::Multiply(value(2), value(1)),
        ];
        let second = vec![double(state(1)), Step::Multiply(value(4), slope(0))];
        let routine = Routine {
            steps: vec![Step::Sine(state(0))],
            names: ["sine", "a", "b", "c", "d", "e"]
                .map(str::to_owned)
                .to_vec(),
            results: vec![value(0)],
            sweeps: vec![sweep(1, first, 3), sweep(4, second, 5)],
            repeats: Vec::new(),
        };
        let found = hoist(&routine);
        assert_eq!(found.names, ["sine", "b", "d", "a", "c", "e"]);
        assert_eq!(
            found.steps,
            [Step::Sine(state(0)), double(value(0)), double(state(1))]
        );
        let first = [
            Step::Multiply(slope(0), value(0)),
            Step::Multiply(value(1), value(3)),
        ];
        assert_eq!(
            found.sweeps,
            [
                sweep(3, first.to_vec(), 4),
                sweep(5, vec![Step::Multiply(value(2), slope(0))], 5),
            ]
        );
    }
}
