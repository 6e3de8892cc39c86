//! Values whose negative is made in their place, where that saves instructions.
//!
//! A multiply-add takes any signs, and a difference one. What is returned with a sign, or a product with one, takes an
//! instruction more. Whoever reads a value whose negative was made reads it with the other sign. Values with a name stay,
//! so that a line is what its name says.

use super::{Operand, Routine, Solve, Source, Step};

/// How often all values are looked at: each change may make room for another.
const ROUNDS: usize = 4;

/// The cost of an instruction that only changes a sign.
const SIGN: u32 = 2;
/// That of a multiply-add with both signs: nothing where it is fused, else an instruction.
const BOTH_SIGNS: u32 = 1;

/// The routine with as few signs as are found by changing one value after the other.
pub(super) fn signs(routine: &Routine) -> Routine {
    let mut signs = Signs::of(routine);
    for _ in 0..ROUNDS {
        let changes = (0..routine.names.len())
            .rev()
            .filter(|value| signs.change(*value));
        if changes.count() == 0 {
            break;
        }
    }
    signs.routine(routine)
}

/// Where a value is read or made.
enum Place<'a> {
    /// A step, and the first value that it makes if that may change its sign.
    Step(&'a Step, Option<usize>),
    Result(Operand),
}

struct Signs<'a> {
    places: Vec<Place<'a>>,
    /// The places that read each value, and the one that makes it.
    touched: Vec<Vec<usize>>,
    /// Whether each value may change its sign.
    is_free: Vec<bool>,
    /// The values whose negative is made.
    negative: Vec<bool>,
}

impl<'a> Signs<'a> {
    fn of(routine: &'a Routine) -> Self {
        let count = routine.names.len();
        let mut signs = Self {
            places: Vec::new(),
            touched: vec![Vec::new(); count],
            is_free: vec![false; count],
            negative: vec![false; count],
        };
        let mut value = 0;
        for step in &routine.steps {
            let made = changeable(step, value, &routine.names);
            if let Some(made) = made {
                signs.is_free[made] = true;
                signs.touched[made].push(signs.places.len());
            }
            signs.read(step, made);
            value += step.results();
        }
        for sweep in &routine.sweeps {
            sweep.steps.iter().for_each(|step| signs.read(step, None));
        }
        let of_sweeps = routine.sweeps.iter().flat_map(|it| &it.results);
        for result in routine.results.iter().chain(of_sweeps) {
            signs.returned(*result);
        }
        signs
    }

    fn read(&mut self, step: &'a Step, made: Option<usize>) {
        if let Step::Solve(Solve { steps, results, .. }) = step {
            steps.iter().for_each(|it| self.read(it, None));
            results.iter().for_each(|it| self.returned(*it));
            return;
        }
        self.enter(&step.operands(), Place::Step(step, made));
    }

    fn returned(&mut self, operand: Operand) {
        self.enter(&[operand], Place::Result(operand));
    }

    fn enter(&mut self, operands: &[Operand], place: Place<'a>) {
        for operand in operands {
            if let Source::Value(value) = operand.source {
                self.touched[value].push(self.places.len());
            }
        }
        self.places.push(place);
    }

    /// Changes the sign of a value if that saves something; says whether it did.
    fn change(&mut self, value: usize) -> bool {
        if !self.is_free[value] {
            return false;
        }
        let before = self.cost(value);
        self.negative[value] ^= true;
        let is_better = self.cost(value) < before;
        self.negative[value] ^= !is_better;
        is_better
    }

    /// What signs cost wherever a value is made or read.
    fn cost(&self, value: usize) -> u32 {
        let places = self.touched[value].iter().map(|it| &self.places[*it]);
        places.map(|it| self.cost_of(it)).sum()
    }

    fn cost_of(&self, place: &Place<'_>) -> u32 {
        let (step, made) = match place {
            Place::Result(operand) => return SIGN * u32::from(self.operand(*operand).negative),
            Place::Step(step, made) => (step, *made),
        };
        let sign =
            |a: &Operand, b: &Operand| !is_number(a) && !is_number(b) && a.negative ^ b.negative;
        match self.step(step, made) {
            Step::Add(a, b) => SIGN * u32::from(a.negative && b.negative),
            Step::Multiply(a, b) | Step::Divide(a, b) => SIGN * u32::from(sign(&a, &b)),
            Step::MultiplyAdd(a, b, c) => BOTH_SIGNS * u32::from(sign(&a, &b) && c.negative),
            other => {
                let operands = other.operands();
                SIGN * operands
                    .iter()
                    .map(|it| u32::from(it.negative))
                    .sum::<u32>()
            }
        }
    }

    fn operand(&self, operand: Operand) -> Operand {
        match operand.source {
            Source::Value(value) => Operand {
                negative: operand.negative ^ self.negative[value],
                ..operand
            },
            _ => operand,
        }
    }

    /// The step with the signs as they are now, of which it carries as few as it can.
    fn step(&self, step: &Step, made: Option<usize>) -> Step {
        let turned = made.is_some_and(|value| self.negative[value]);
        let turn = |operand: Operand| Operand {
            negative: operand.negative ^ turned,
            ..operand
        };
        match step.with(&|operand| self.operand(operand)) {
            Step::Add(a, b) => match [turn(a), turn(b)] {
                [a, b] if a.negative && !b.negative => Step::Add(b, a),
                [a, b] => Step::Add(a, b),
            },
            Step::Multiply(a, b) => {
                let (a, b) = product(turn(a), b);
                Step::Multiply(a, b)
            }
            Step::MultiplyAdd(a, b, c) => {
                let (a, b) = product(turn(a), b);
                Step::MultiplyAdd(a, b, turn(c))
            }
            Step::Divide(a, b) => {
                let (a, b) = product(a, b);
                Step::Divide(a, b)
            }
            other => other,
        }
    }

    fn routine(&self, routine: &Routine) -> Routine {
        let mut value = 0;
        let steps = routine.steps.iter().map(|step| {
            let made = changeable(step, value, &routine.names);
            value += step.results();
            self.step(step, made)
        });
        let steps = steps.collect();
        let sweeps = routine.sweeps.iter();
        let sweeps = sweeps.map(|it| it.with(&|it| self.step(it, None), &|it| self.operand(it)));
        Routine {
            steps,
            names: routine.names.clone(),
            results: routine.results.iter().map(|it| self.operand(*it)).collect(),
            sweeps: sweeps.collect(),
            repeats: Vec::new(),
        }
    }
}

/// The value that a step makes, if it may change its sign: that of a sum or a product without a name.
fn changeable(step: &Step, value: usize, names: &[String]) -> Option<usize> {
    let is_sum_or_product = matches!(
        step,
        Step::Add(..) | Step::Multiply(..) | Step::MultiplyAdd(..)
    );
    (is_sum_or_product && names[value].is_empty()).then_some(value)
}

fn is_number(operand: &Operand) -> bool {
    matches!(operand.source, Source::Constant(_))
}

/// The factors with one sign at most, and that on a number if there is one.
fn product(a: Operand, b: Operand) -> (Operand, Operand) {
    let negative = a.negative ^ b.negative;
    let [mut a, mut b] = [a, b].map(|it| Operand::plain(it.source));
    if is_number(&b) {
        b.negative = negative;
    } else {
        a.negative = negative;
    }
    (a, b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::program::fixtures::{negative, state, value};

    fn routine(steps: &[Step], results: &[Operand]) -> Routine {
        let values: usize = steps.iter().map(Step::results).sum();
        Routine {
            steps: steps.to_vec(),
            names: vec![String::new(); values],
            results: results.to_vec(),
            sweeps: Vec::new(),
            repeats: Vec::new(),
        }
    }

    #[test]
    fn a_multiply_add_takes_the_sign_of_what_is_returned() {
        let before = routine(
            &[
                Step::MultiplyAdd(state(0), state(1), negative(state(2))),
                Step::Add(value(0), state(3)),
            ],
            &[negative(value(0)), value(1)],
        );
        let after = signs(&before);
        let first = Step::MultiplyAdd(negative(state(0)), state(1), state(2));
        assert_eq!(
            after.steps,
            [first, Step::Add(state(3), negative(value(0)))]
        );
        assert_eq!(after.results, [value(0), value(1)]);
    }

    #[test]
    fn a_multiply_add_has_one_sign_rather_than_two() {
        let before = routine(
            &[
                Step::MultiplyAdd(negative(state(0)), state(1), negative(state(2))),
                Step::Add(state(3), value(0)),
            ],
            &[value(1)],
        );
        let first = Step::MultiplyAdd(state(0), state(1), state(2));
        let second = Step::Add(state(3), negative(value(0)));
        assert_eq!(signs(&before).steps, [first, second]);
    }

    #[test]
    fn a_number_takes_the_sign_of_its_product() {
        let number = Operand::plain(Source::Constant(0.5));
        let product = routine(&[Step::Multiply(state(0), number)], &[negative(value(0))]);
        let after = signs(&product);
        assert_eq!(after.steps, [Step::Multiply(state(0), negative(number))]);
        assert_eq!(after.results, [value(0)]);
    }

    #[test]
    fn what_would_only_move_a_sign_stays() {
        let product = routine(&[Step::Multiply(state(0), state(1))], &[negative(value(0))]);
        assert_eq!(signs(&product), product);
    }

    #[test]
    fn what_has_a_name_stays() {
        let mut difference = routine(
            &[Step::Add(state(0), negative(state(1)))],
            &[negative(value(0))],
        );
        difference.names[0] = "spring.e".to_owned();
        assert_eq!(signs(&difference), difference);
    }
}
