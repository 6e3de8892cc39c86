//! Stretches of steps that come again and again, one after the other, and are written as a loop.
//!
//! A row of like links, or of cells, gives like steps for each. Written one by one those of a long row are more than fits
//! beside a processor's core, which waits for its instructions; a loop of them is short, and LLVM works out several turns at
//! once where they do not wait for each other.
//!
//! Steps are in the order of the expressions that they come from, in which those of a link stand together. Turns are alike
//! where the same operations read what is the same in all, the same of their own turn, of the turn before, or what goes on
//! from turn to turn by the same number of places.

use std::collections::BTreeMap;
use std::hash::{Hash, Hasher};
use std::mem::discriminant;
use std::ops::Range;

use rustc_hash::{FxHashMap, FxHasher};

use super::{ANGLES, Operand, Routine, Source, Step, starts};
use crate::symbolic::Symbol;

/// Fewest steps of a routine with loops: what is shorter is as quick without.
const FEWEST: usize = 100;

/// Fewest turns of a loop.
const TURNS: usize = 4;

/// Fewest steps that a loop saves.
const SAVED: usize = 12;

/// How many steps in a row must be alike for the next turn to be looked for there.
const ALIKE: usize = 12;

/// Steps that come again.
#[derive(Clone, Debug, PartialEq)]
pub struct Repeat {
    /// The steps of all turns.
    pub steps: Range<usize>,
    /// How many turns.
    pub turns: usize,
    /// How many of them are written one by one in each turn of the loop; they divide the turns.
    pub together: usize,
    /// Number of the first value.
    pub first: usize,
    /// How many values a turn makes.
    pub values: usize,
    /// What the steps of a turn read, one operand after the other.
    pub readings: Vec<Reading>,
}

/// What an operand is from turn to turn.
#[derive(Clone, Debug, PartialEq)]
pub enum Reading {
    /// The same in all.
    Same,
    /// A number of its own in each.
    Numbers(Vec<f64>),
    /// In each turn the one so many places behind that of the turn before.
    Along(isize),
    /// The value with this place among those of its own turn.
    Own(usize),
    /// That of the turn before; the first turn reads what its own step says.
    Before(usize),
}

impl Repeat {
    /// How many steps a turn has.
    #[must_use]
    pub fn width(&self) -> usize {
        self.steps.len() / self.turns
    }

    /// The steps of the first turn, of those of the routine.
    #[must_use]
    pub fn turn<'a>(&self, steps: &'a [Step]) -> &'a [Step] {
        &steps[self.steps.start..self.steps.start + self.width()]
    }

    /// The turn that makes a value, and its place among the values of one.
    #[must_use]
    pub fn place(&self, value: usize) -> Option<(usize, usize)> {
        let behind = value.checked_sub(self.first)?;
        let turn = behind / self.values;
        (turn < self.turns).then_some((turn, behind % self.values))
    }
}

/// The repeats of a routine, if they save three quarters of its steps. On an Intel Xeon with AVX-512 a chain of 32 links, of which
/// 0.55 would be saved, takes 7 % longer with loops, and one of 64 links, of which 0.78 are, 16 to 20 % less; lines of 25 to 400
/// cells, whose loops LLVM vectorises, take 30 to 40 % less.
pub(super) fn repeats(routine: &Routine) -> Vec<Repeat> {
    let steps = &routine.steps;
    if steps.len() < FEWEST || !routine.sweeps.is_empty() {
        return Vec::new();
    }
    let found = Search::of(steps).all();
    let saved = |it: &Repeat| it.steps.len() - it.width() * it.together;
    let saved: usize = found.iter().map(saved).sum();
    if 4 * saved < 3 * steps.len() {
        return Vec::new();
    }
    found
}

/// What all steps alike have in common; none for what is in no loop.
fn key(step: &Step) -> Option<u64> {
    let mut hasher = FxHasher::default();
    discriminant(step).hash(&mut hasher);
    match step {
        Step::Solve(_) => return None,
        Step::Call(function, _) => function.hash(&mut hasher),
        _ => {}
    }
    for operand in &*step.operands() {
        operand.negative.hash(&mut hasher);
        discriminant(&operand.source).hash(&mut hasher);
        if let Source::Symbol(symbol) = operand.source {
            discriminant(&symbol).hash(&mut hasher);
        }
    }
    Some(hasher.finish())
}

/// For each step the next one from which on steps are alike.
fn next_alike(keys: &[Option<u64>]) -> Vec<Option<usize>> {
    let mut last = FxHashMap::default();
    let mut next = vec![None; keys.len()];
    for (step, alike) in keys.windows(ALIKE).enumerate().rev() {
        next[step] = last.insert(alike, step);
    }
    next
}

struct Search<'a> {
    steps: &'a [Step],
    starts: Vec<usize>,
    keys: Vec<Option<u64>>,
    next: Vec<Option<usize>>,
    found: Vec<Repeat>,
    /// How many steps a turn has where keys were compared last, and where the last turn of them ends.
    compared: (usize, usize),
}

impl<'a> Search<'a> {
    fn of(steps: &'a [Step]) -> Self {
        let keys: Vec<Option<u64>> = steps.iter().map(key).collect();
        Self {
            steps,
            starts: starts(steps),
            next: next_alike(&keys),
            keys,
            found: Vec::new(),
            compared: (0, 0),
        }
    }

    fn all(mut self) -> Vec<Repeat> {
        let mut step = 0;
        while step < self.steps.len() {
            step = match self.from(step) {
                Some(repeat) => {
                    let end = repeat.steps.end;
                    self.found.push(repeat);
                    end
                }
                None => step + 1,
            };
        }
        self.found
    }

    /// The repeat that begins with a step, or within a turn behind it.
    fn from(&mut self, step: usize) -> Option<Repeat> {
        let width = self.next[step]? - step;
        let (compared, end) = self.compared;
        if compared != width || end < step + width {
            let keys = &self.keys[step..];
            let pairs = keys.iter().zip(&keys[width..]);
            let alike = pairs.take_while(|(a, b)| a.is_some() && a == b).count();
            self.compared = (width, step + width + alike);
        }
        let end = self.compared.1;
        let first = Turn::of(self, step, width);
        let (turns, readings) = first.readings((end - step) / width)?;
        let begin = first.begin(&readings);
        let shifted = (begin > 0).then(|| {
            let shifted = Turn::of(self, step + begin, width);
            let (more, readings) = shifted.readings((end - step - begin) / width)?;
            (more + 1 >= turns).then(|| shifted.repeat(more, readings))
        });
        let found = shifted.flatten();
        found.unwrap_or_else(|| first.repeat(turns, readings))
    }

    /// The repeat that makes a value and its place in a turn of it.
    fn home(&self, value: usize) -> Option<(usize, usize)> {
        let number = self.found.partition_point(|it| it.first <= value);
        let number = number.checked_sub(1)?;
        let (_, place) = self.found[number].place(value)?;
        Some((number, place))
    }
}

/// The first turn of what may be a repeat.
struct Turn<'a> {
    search: &'a Search<'a>,
    steps: Range<usize>,
    first: usize,
    values: usize,
}

impl<'a> Turn<'a> {
    fn of(search: &'a Search<'a>, step: usize, width: usize) -> Self {
        let first = search.starts[step];
        Self {
            search,
            steps: step..step + width,
            first,
            values: search.starts[step + width] - first,
        }
    }

    /// The repeat of so many turns, if it saves enough.
    fn repeat(&self, mut turns: usize, mut readings: Vec<Reading>) -> Option<Repeat> {
        let width = self.steps.len();
        // Sines and cosines are worked out side by side.
        let together = match self.search.steps[self.steps.start] {
            Step::SineCosine(_) if width == 1 => ANGLES,
            _ => 1,
        };
        turns -= turns % together;
        for reading in &mut readings {
            if let Reading::Numbers(numbers) = reading {
                numbers.truncate(turns);
            }
        }
        (width * (turns - together) >= SAVED).then(|| Repeat {
            steps: self.steps.start..self.steps.start + turns * width,
            turns,
            together,
            first: self.first,
            values: self.values,
            readings,
        })
    }

    /// The step of a turn with which it had best begin, so that fewest values are handed on to the next.
    fn begin(&self, readings: &[Reading]) -> usize {
        let width = self.steps.len();
        let steps = &self.search.steps[self.steps.clone()];
        let makers: Vec<usize> = (0..width)
            .flat_map(|step| std::iter::repeat_n(step, steps[step].results()))
            .collect();
        let mut last = vec![0; makers.len()];
        let mut readings = readings.iter();
        for (step, reader) in steps.iter().enumerate() {
            for reading in readings.by_ref().take(reader.operands().len()) {
                let (place, read) = match reading {
                    Reading::Own(place) => (*place, step),
                    Reading::Before(place) => (*place, step + width),
                    _ => continue,
                };
                last[place] = last[place].max(read);
            }
        }
        let handed_on = |begin: &usize| {
            let lives = makers.iter().zip(&last);
            let crossing = |(made, read): &(&usize, &usize)| {
                (*made < begin && begin <= read) || *begin + width <= **read
            };
            lives.filter(crossing).count()
        };
        (0..width).min_by_key(handed_on).unwrap_or(0)
    }

    /// In how many turns, of so many with the same keys, all is read alike, and how; none if these are too few.
    fn readings(&self, mut turns: usize) -> Option<(usize, Vec<Reading>)> {
        let mut readings = Vec::new();
        let mut begins = BTreeMap::new();
        for step in self.steps.clone() {
            let width = self.steps.len();
            let steps = self.search.steps[step..].iter().step_by(width).take(turns);
            let operands: Vec<_> = steps.map(Step::operands).collect();
            for place in 0..operands[0].len() {
                let operands: Vec<Operand> = operands.iter().map(|it| it[place]).collect();
                let (reading, alike) = self.reading(&operands)?;
                turns = turns.min(alike);
                if turns < TURNS {
                    return None;
                }
                if let Reading::Before(place) = reading
                    && *begins.entry(place).or_insert(operands[0].source) != operands[0].source
                {
                    return None;
                }
                readings.push(reading);
            }
        }
        Some((turns, readings))
    }

    /// How an operand is read, and in how many turns.
    fn reading(&self, operands: &[Operand]) -> Option<(Reading, usize)> {
        let [first, second, ..] = operands else {
            return None;
        };
        let alike = |is_so: &dyn Fn(usize, Source) -> bool| {
            let turns = operands.iter().enumerate();
            turns
                .take_while(|(turn, it)| is_so(*turn, it.source))
                .count()
        };
        let own = match second.source {
            Source::Value(value) => value.checked_sub(self.first),
            _ => None,
        };
        if let Some(behind) = own {
            let place = behind % self.values;
            let value = |turn: usize| Source::Value(self.first + turn * self.values + place);
            return match behind / self.values {
                0 => {
                    let before = |turn: usize, source| turn == 0 || source == value(turn - 1);
                    let begins = matches!(first.source, Source::Value(it) if it < self.first);
                    begins.then(|| (Reading::Before(place), alike(&before)))
                }
                _ => Some((
                    Reading::Own(place),
                    alike(&|turn, source| source == value(turn)),
                )),
            };
        }
        if first == second {
            return Some((Reading::Same, alike(&|_, source| source == first.source)));
        }
        if let Source::Constant(_) = first.source {
            let number = |operand: &Operand| match operand.source {
                Source::Constant(number) => Some(number),
                _ => None,
            };
            let numbers: Vec<f64> = operands.iter().map_while(number).collect();
            let turns = numbers.len();
            return Some((Reading::Numbers(numbers), turns));
        }
        let begin = number(first.source)?;
        let stride = number(second.source)? - begin;
        let home = match first.source {
            Source::Value(value) => Some(self.search.home(value)?),
            _ => None,
        };
        let along = |turn: usize, source| {
            let there = match source {
                Source::Value(value) => self.search.home(value),
                _ => None,
            };
            number(source) == Some(begin + turn as isize * stride) && there == home
        };
        Some((Reading::Along(stride), alike(&along)))
    }
}

/// The number of what comes in rows.
fn number(source: Source) -> Option<isize> {
    match source {
        Source::Value(number)
        | Source::Folded(number)
        | Source::Symbol(Symbol::State(number) | Symbol::Input(number)) => Some(number as isize),
        Source::Symbol(_) | Source::Constant(_) | Source::Solved(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::program::fixtures::{negative, state, value};

    fn number(number: f64) -> Operand {
        Operand::plain(Source::Constant(number))
    }

    /// What an operand is in a turn, by the reading and the operand of the first turn.
    fn read(repeat: &Repeat, reading: &Reading, turn: usize, first: Operand) -> Operand {
        let own = repeat.first + turn * repeat.values;
        let behind =
            |number: usize, stride: isize| number.saturating_add_signed(stride * turn as isize);
        let source = match (reading, first.source) {
            (Reading::Same, source) => source,
            (Reading::Numbers(numbers), _) => Source::Constant(numbers[turn]),
            (Reading::Own(place), _) => Source::Value(own + place),
            (Reading::Before(_), source) if turn == 0 => source,
            (Reading::Before(place), _) => Source::Value(own - repeat.values + place),
            (Reading::Along(stride), Source::Value(number)) => {
                Source::Value(behind(number, *stride))
            }
            (Reading::Along(stride), Source::Folded(number)) => {
                Source::Folded(behind(number, *stride))
            }
            (Reading::Along(stride), Source::Symbol(Symbol::State(number))) => {
                Source::Symbol(Symbol::State(behind(number, *stride)))
            }
            (Reading::Along(stride), Source::Symbol(Symbol::Input(number))) => {
                Source::Symbol(Symbol::Input(behind(number, *stride)))
            }
            (Reading::Along(_), source) => panic!("{source:?} does not come in rows"),
        };
        Operand { source, ..first }
    }

    /// The steps are those that turns and readings say.
    fn assert_told(repeat: &Repeat, steps: &[Step]) {
        for turn in 0..repeat.turns {
            let mut readings = repeat.readings.iter();
            for (place, first) in repeat.turn(steps).iter().enumerate() {
                let told: Vec<Operand> = first
                    .operands()
                    .iter()
                    .map(|operand| {
                        read(repeat, readings.next().expect("a reading"), turn, *operand)
                    })
                    .collect();
                let step = &steps[repeat.steps.start + turn * repeat.width() + place];
                assert_eq!(discriminant(step), discriminant(first));
                assert_eq!(&*step.operands(), &told[..], "turn {turn}, step {place}");
            }
            assert_eq!(readings.next(), None);
        }
    }

    fn found(steps: &[Step]) -> Vec<Repeat> {
        let found = Search::of(steps).all();
        for repeat in &found {
            assert_told(repeat, steps);
        }
        found
    }

    /// Cells that each read two states, a number of their own, and the cell before.
    fn cells(count: usize) -> Vec<Step> {
        let cell = |k: usize| {
            let before = if k == 0 { state(99) } else { value(4 * k - 2) };
            [
                Step::Multiply(state(2 * k), number(2.0 + k as f64)),
                Step::Multiply(value(4 * k), state(2 * k + 1)),
                Step::Sine(value(4 * k + 1)),
                Step::Add(value(4 * k + 2), negative(before)),
            ]
        };
        (0..count).flat_map(cell).collect()
    }

    #[test]
    fn cells_in_a_row_are_turns() {
        let found = found(&cells(20));
        assert_eq!(found.len(), 1, "{found:?}");
        let repeat = &found[0];
        assert_eq!((repeat.width(), repeat.values), (4, 4));
        // The first cell reads a state where the others read a value.
        assert!(repeat.turns >= 18, "{repeat:?}");
        let has = |is: fn(&Reading) -> bool| repeat.readings.iter().filter(|it| is(it)).count();
        assert_eq!(has(|it| matches!(it, Reading::Numbers(_))), 1);
        assert_eq!(has(|it| *it == Reading::Along(2)), 2);
        // What is handed on, wherever a turn begins, is a sine, or it and what it is of.
        assert_eq!(has(|it| matches!(it, Reading::Before(_))), 1, "{repeat:?}");
    }

    #[test]
    fn values_of_one_loop_are_read_along_by_the_next_and_back() {
        let mut steps: Vec<Step> = (0..16).map(|k| Step::SineCosine(state(k))).collect();
        for k in 0..16 {
            let sum = 32 + 2 * k;
            steps.push(Step::Multiply(value(30 - 2 * k), value(31 - 2 * k)));
            steps.push(Step::Add(value(sum), state(3)));
        }
        let found = found(&steps);
        let shapes: Vec<_> = found.iter().map(|it| (it.width(), it.turns)).collect();
        assert_eq!(shapes, [(1, 16), (2, 16)]);
        assert_eq!(found[0].together, ANGLES);
        let back = Reading::Along(-2);
        assert_eq!(
            found[1].readings,
            [back.clone(), back, Reading::Own(0), Reading::Same]
        );
    }

    #[test]
    fn another_operation_sign_or_stride_ends_a_loop() {
        let ends = |change: fn(&mut Step)| {
            let mut steps = cells(40);
            change(&mut steps[83]);
            let turns = found(&steps).into_iter().map(|it| it.turns);
            turns.max().unwrap_or(0)
        };
        assert!(ends(|_| {}) >= 38);
        for change in [
            |step: &mut Step| *step = step.with(&negative),
            |step: &mut Step| *step = Step::Multiply(value(82), value(78)),
            |step: &mut Step| *step = Step::Add(value(82), negative(value(74))),
        ] {
            assert!(ends(change) < 22);
        }
    }

    #[test]
    fn few_steps_and_few_alike_have_no_loop() {
        let repeats = |steps: Vec<Step>| {
            let values = steps.iter().map(Step::results).sum();
            repeats(&Routine {
                steps,
                names: vec![String::new(); values],
                ..Routine::default()
            })
        };
        assert!(repeats(cells(20)).is_empty());
        assert_eq!(repeats(cells(40)).len(), 1);
        let mut mixed = cells(40);
        let other = |k: usize| match k % 7 * k % 5 {
            0 => Step::Add(state(k % 3), state(k)),
            1 => Step::Multiply(state(k), state(k * k)),
            _ => Step::Sine(state(k * k % 11)),
        };
        mixed.extend((0..200).map(other));
        assert!(repeats(mixed).is_empty());
    }

    /// Another operand that is as good a one for the same step.
    fn other(operand: Operand) -> Operand {
        let source = match operand.source {
            Source::Value(number) => Source::Value(number.saturating_sub(1)),
            Source::Symbol(Symbol::State(number)) => Source::Symbol(Symbol::State(number + 1)),
            Source::Constant(number) => Source::Constant(number + 1.0),
            source => source,
        };
        Operand { source, ..operand }
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// Rows of a few steps with random operands, those of some steps changed.
        #[test]
        fn what_is_told_of_turns_is_so(
            turn in prop::collection::vec((0..3usize, 0..5usize, 0..5usize, 0..9usize), 1..9),
            turns in 4..30usize,
            changes in prop::collection::vec(0..300usize, 0..3),
        ) {
            let width = turn.len();
            let operand = |kind: usize, more: usize, at: usize, turn: usize| match kind {
                0 => state(more),
                1 => state(3 * turn + more),
                2 => number(if more < 4 { 2.0 } else { turn as f64 }),
                _ if at > more => value(at - 1 - more),
                _ => state(7),
            };
            let mut steps = Vec::new();
            for number in 0..turns {
                for (operation, a, b, more) in &turn {
                    let at = steps.len();
                    let a = operand(*a, *more, at, number);
                    let b = operand(*b, width, at, number);
                    steps.push(match operation {
                        0 => Step::Add(a, b),
                        1 => Step::Multiply(a, negative(b)),
                        _ => Step::MultiplyAdd(a, b, state(more % 3)),
                    });
                }
            }
            for place in changes {
                let place = place % steps.len();
                steps[place] = steps[place].with(&other);
            }
            found(&steps);
        }
    }
}
