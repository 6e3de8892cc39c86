//! Loops that go on side by side.
//!
//! A turn that reads the turn before waits for it, and the processor waits with it: a loop of such turns takes as long as its
//! longest chain. Where the next loop follows in the same direction, as the accelerations of a row of links do behind its
//! velocities, its turns can begin as soon as the first ones of the loop before are done. So they come between those, as one
//! loop, and each works while the other waits. On an AMD EPYC of 2024 a chain of 64 links takes 5 % less.

use std::ops::Range;

use super::repeats::loops;
use super::{Reading, Repeat, Routine, Source, Step, starts};

/// How many turns of a loop must follow one by one behind those of another.
const TURNS: usize = 4;

/// The routine with loops that can go on side by side as one.
pub(super) fn interleave(routine: Routine) -> Routine {
    let mut order: Vec<usize> = (0..routine.steps.len()).collect();
    let makers = makers(&routine.steps);
    let mut pairs = routine.repeats.windows(2);
    let mut changed = false;
    while let Some([first, second]) = pairs.next() {
        let pair = Pair { first, second };
        if let Some(turns) = pair.turns(&routine.steps, &makers) {
            let begin = first.steps.start;
            order[pair.steps()].sort_by_key(|step| turns[*step - begin]);
            pairs.next();
            changed = true;
        }
    }
    if !changed {
        return routine;
    }
    let mut interleaved = routine.in_order(&order);
    interleaved.repeats = loops(&interleaved.steps);
    interleaved
}

/// The step that makes each value.
fn makers(steps: &[Step]) -> Vec<usize> {
    let starts = starts(steps);
    let values = |step: usize| starts[step + 1] - starts[step];
    (0..steps.len())
        .flat_map(|step| std::iter::repeat_n(step, values(step)))
        .collect()
}

/// Whether a turn waits for the one before.
fn waits(repeat: &Repeat) -> bool {
    let is_handed_on = |reading: &Reading| matches!(reading, Reading::Before(_));
    repeat.readings.iter().any(is_handed_on)
}

/// A loop, and the next one behind it.
struct Pair<'a> {
    first: &'a Repeat,
    second: &'a Repeat,
}

impl Pair<'_> {
    /// The steps of both, and between them.
    fn steps(&self) -> Range<usize> {
        self.first.steps.start..self.second.steps.end
    }

    /// For each step of both, and between them, the turn of the first loop in which it comes; none if the turns of the second
    /// do not follow one by one.
    fn turns(&self, steps: &[Step], makers: &[usize]) -> Option<Vec<usize>> {
        let solves = |step: &Step| matches!(step, Step::Solve(_));
        if !waits(self.first) || !waits(self.second) || steps[self.steps()].iter().any(solves) {
            return None;
        }
        let begin = self.first.steps.start;
        let earliest = self.earliest(steps, makers);
        // What waits for nothing in the first loop comes just before what it is for.
        let mut turns = vec![self.first.turns; earliest.len()];
        for step in self.steps().rev() {
            let place = step - begin;
            turns[place] = earliest[place].unwrap_or(turns[place]);
            for maker in self.read(steps, makers, step) {
                turns[maker - begin] = turns[maker - begin].min(turns[place]);
            }
        }
        let width = self.second.width();
        let places = &turns[self.second.steps.start - begin..];
        let mut last = places.chunks(width).map(|turn| turn.iter().max());
        let mut before = last.next()?;
        let follows = |turn| std::mem::replace(&mut before, turn) < turn;
        last.take(TURNS).all(follows).then_some(turns)
    }

    /// The turn of the first loop that each step belongs to or waits for.
    fn earliest(&self, steps: &[Step], makers: &[usize]) -> Vec<Option<usize>> {
        let begin = self.first.steps.start;
        let mut earliest: Vec<Option<usize>> = Vec::new();
        for step in self.steps() {
            earliest.push(if self.first.steps.contains(&step) {
                Some((step - begin) / self.first.width())
            } else {
                let read = self.read(steps, makers, step);
                read.filter_map(|maker| earliest[maker - begin]).max()
            });
        }
        earliest
    }

    /// Those of the steps whose values a step reads.
    fn read(&self, steps: &[Step], makers: &[usize], step: usize) -> impl Iterator<Item = usize> {
        let operands = steps[step].operands();
        let made = operands.iter().filter_map(|operand| match operand.source {
            Source::Value(value) => Some(makers[value]),
            _ => None,
        });
        let made = made.filter(|maker| self.steps().contains(maker));
        made.collect::<Vec<_>>().into_iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::program::fixtures::{state, value};
    use crate::program::{Arguments, Program, evaluate};

    /// Two sums along a row of states, of which the second reads the first from one end or the other.
    fn sums(length: usize, backwards: bool) -> Routine {
        let mut steps = vec![Step::Sine(state(100)), Step::Cosine(state(100))];
        for k in 0..length {
            steps.push(Step::Multiply(value(2 * k + 1), state(k)));
            steps.push(Step::Add(value(2 * k + 2), state(k + length)));
        }
        let second = steps.len();
        steps.extend([Step::Sine(state(101)), Step::Cosine(state(101))]);
        for k in 0..length {
            let other = if backwards { length - 1 - k } else { k };
            let own = second + 2 * k + 1;
            steps.push(Step::Multiply(value(own), value(2 * other + 3)));
            steps.push(Step::Add(value(own + 1), state(k)));
        }
        let values = steps.len();
        let mut routine = Routine {
            steps,
            names: vec![String::new(); values],
            results: vec![value(values - 1)],
            ..Routine::default()
        };
        routine.repeats = loops(&routine.steps);
        routine
    }

    fn shapes(routine: &Routine) -> Vec<(usize, bool)> {
        let loops = routine.repeats.iter();
        loops.map(|it| (it.width(), it.turns > 20)).collect()
    }

    #[test]
    fn loops_that_follow_each_other_become_one() {
        let routine = sums(30, false);
        assert_eq!(shapes(&routine), [(2, true), (2, true)]);
        assert_eq!(shapes(&interleave(routine)), [(4, true)]);
    }

    #[test]
    fn loops_that_wait_for_the_end_of_another_stay_behind_it() {
        let routine = sums(30, true);
        assert_eq!(shapes(&routine), [(2, true), (2, true)]);
        assert_eq!(interleave(routine.clone()), routine);
    }

    #[test]
    fn results_are_those_of_the_same_steps() {
        let routine = sums(30, false);
        let interleaved = interleave(routine.clone());
        let state: Vec<f64> = (0..102).map(|k| 0.9 + 0.01 * f64::from(k)).collect();
        let program = Program {
            folded: Routine::default(),
            routines: vec![routine, interleaved],
        };
        let results = [0, 1].map(|routine| {
            let arguments = Arguments {
                parameters: &[],
                time: 0.0,
                state: &state,
                input: &[],
            };
            evaluate(&program, routine, &arguments)
        });
        assert_eq!(results[0], results[1]);
        assert!(results[0][0].is_finite());
    }
}
