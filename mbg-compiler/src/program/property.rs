//! Random routines give the same after each pass, in whole numbers modulo 2⁶⁴: sums and products are exact there, and sines
//! some function of one number.

use std::ops::Range;

use proptest::prelude::*;

use super::arrange::arrange;
use super::contract::contract;
use super::fixtures::{coverage, state, value};
use super::hoist::hoist;
use super::reorder::reorder;
use super::signs::signs;
use super::stretches::by_stretches;
use super::{Operand, Routine, Source, Step, Sweep};
use crate::symbolic::Symbol;

/// How far back a value may be that a step reads.
const NEAR: usize = 8;

fn read(operand: Operand, values: &[u64]) -> u64 {
    let number = match operand.source {
        Source::Value(value) => values[value],
        Source::Symbol(Symbol::State(state)) => sine(state as u64 + 1),
        Source::Symbol(Symbol::Slope(variable)) => sine(variable as u64 + 100),
        Source::Constant(number) => number as u64,
        other => unreachable!("{other:?}"),
    };
    if operand.negative {
        number.wrapping_neg()
    } else {
        number
    }
}

fn sine(angle: u64) -> u64 {
    (angle ^ (angle >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9)
}

fn run(steps: &[Step], values: &mut Vec<u64>) {
    for step in steps {
        let found = match step {
            Step::Add(a, b) => read(*a, values).wrapping_add(read(*b, values)),
            Step::Multiply(a, b) => read(*a, values).wrapping_mul(read(*b, values)),
            Step::MultiplyAdd(a, b, c) => read(*a, values)
                .wrapping_mul(read(*b, values))
                .wrapping_add(read(*c, values)),
            Step::Sine(a) => sine(read(*a, values)),
            Step::SineCosine(a) => {
                values.push(sine(read(*a, values)));
                sine(read(*a, values)).rotate_left(7)
            }
            other => unreachable!("{other:?}"),
        };
        values.push(found);
    }
}

/// What a routine returns, and its sweeps do.
fn results(routine: &Routine) -> Vec<u64> {
    let mut values = Vec::new();
    run(&routine.steps, &mut values);
    let mut found: Vec<u64> = routine
        .results
        .iter()
        .map(|it| read(*it, &values))
        .collect();
    values.resize(routine.names.len(), 0);
    for sweep in &routine.sweeps {
        let mut inside = values[..sweep.first].to_vec();
        run(&sweep.steps, &mut inside);
        found.extend(sweep.results.iter().map(|it| read(*it, &inside)));
    }
    found
}

/// An operand in the making: of what kind it is, its number, and whether it is negative.
type DraftOperand = (usize, usize, bool);

/// A step in the making: its kind and its operands.
type Draft = (u8, [DraftOperand; 2]);

fn drafts(most: usize) -> impl Strategy<Value = Vec<Draft>> {
    let operand = (0..12_usize, 0..NEAR, any::<bool>());
    prop::collection::vec((0..24_u8, [operand.clone(), operand]), 1..most)
}

/// How many states there are, and how many of twelve operands are states: few of them, read often, make many steps with
/// something in common.
#[derive(Clone, Copy, Debug)]
struct Share {
    states: usize,
    of_twelve: usize,
}

fn shares() -> impl Strategy<Value = Share> {
    (1..5_usize, 1..10_usize).prop_map(|(states, of_twelve)| Share { states, of_twelve })
}

impl Share {
    fn operand(self, (kind, number, negative): DraftOperand, value: Option<usize>) -> Operand {
        let source = match value {
            _ if kind == 11 => Source::Constant(1.0 + (number % 3) as f64),
            Some(value) if kind >= self.of_twelve => Source::Value(value),
            _ => Source::Symbol(Symbol::State(number % self.states)),
        };
        Operand { source, negative }
    }

    /// Steps behind so many values, of which those in `hidden` are not to be read; how many values there are then.
    fn steps(
        self,
        drafts: &[Draft],
        mut count: usize,
        hidden: &Range<usize>,
    ) -> (Vec<Step>, usize) {
        let mut steps = Vec::new();
        for (kind, operands) in drafts {
            let [a, b] = operands.map(|draft| {
                let value = count.checked_sub(draft.1 + 1);
                self.operand(draft, value.filter(|it| !hidden.contains(it)))
            });
            let step = match kind {
                0..2 => Step::Sine(a),
                2 => Step::SineCosine(a),
                3..12 => Step::Add(a, b),
                _ => Step::Multiply(a, b),
            };
            count += step.results();
            steps.push(step);
        }
        (steps, count)
    }
}

/// Some values have a name, which keeps their sign.
fn name(value: usize) -> String {
    if value.is_multiple_of(5) {
        format!("v.{value}")
    } else {
        String::new()
    }
}

/// The last values, every other one with a sign.
fn last(count: usize) -> Vec<Operand> {
    let value = |value| Operand {
        source: Source::Value(value),
        negative: value.is_multiple_of(2),
    };
    (count.saturating_sub(3)..count).map(value).collect()
}

/// In sweeps, every other state is a slope.
fn slope(operand: Operand) -> Operand {
    match operand.source {
        Source::Symbol(Symbol::State(state)) if !state.is_multiple_of(2) => Operand {
            source: Source::Symbol(Symbol::Slope(state)),
            ..operand
        },
        _ => operand,
    }
}

fn routine(share: Share, main: &[Draft], of_sweeps: &[Vec<Draft>]) -> Routine {
    let (main, first) = share.steps(main, 0, &(0..0));
    let mut count = first;
    let mut sweeps = Vec::new();
    for drafts in of_sweeps {
        let begin = count;
        let (steps, end) = share.steps(drafts, begin, &(first..begin));
        sweeps.push(Sweep {
            coverage: coverage(share.states),
            first: begin,
            steps: steps.iter().map(|it| it.with(&slope)).collect(),
            results: vec![Operand::plain(Source::Value(end - 1))],
        });
        count = end;
    }
    Routine {
        steps: main,
        names: (0..count).map(name).collect(),
        results: last(first),
        sweeps,
        repeats: Vec::new(),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 5000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn passes_keep_what_a_routine_returns(
        share in shares(),
        main in drafts(40),
        sweeps in prop::collection::vec(drafts(12), 0..3),
    ) {
        let before = routine(share, &main, &sweeps);
        let expected = results(&before);
        let reordered = reorder(&before);
        prop_assert_eq!(&results(&reordered), &expected, "reordered");
        let contracted = contract(&reordered);
        prop_assert_eq!(&results(&contracted), &expected, "contracted");
        let signed = signs(&contracted);
        prop_assert_eq!(&results(&signed), &expected, "with other signs");
        let hoisted = hoist(&signed);
        prop_assert_eq!(&results(&hoisted), &expected, "hoisted");
        let arranged = arrange(&hoisted);
        prop_assert_eq!(&results(&arranged), &expected, "arranged");
        let sorted = by_stretches(&arranged);
        prop_assert_eq!(&results(&sorted), &expected, "in stretches");
        let mut stretches = sorted.sweeps.iter().flat_map(Sweep::stretches);
        prop_assert!(stretches.all(|it| it.mask() != 0), "nothing is left out of all sweeps");
    }
}

/// Steps give the same for their last values after they are reordered.
fn assert_kept(steps: &[Step], last: &[usize]) {
    let values: usize = steps.iter().map(Step::results).sum();
    let before = Routine {
        steps: steps.to_vec(),
        names: vec![String::new(); values],
        results: last.iter().copied().map(value).collect(),
        sweeps: Vec::new(),
        repeats: Vec::new(),
    };
    assert_eq!(results(&reorder(&before)), results(&before));
}

#[test]
fn a_product_that_went_into_another_is_not_read() {
    let steps = [
        Step::Sine(state(2)),
        Step::Multiply(state(0), value(0)),
        Step::Multiply(value(1), state(1)),
        Step::Sine(value(2)),
        Step::Multiply(state(0), value(3)),
        Step::Add(state(3), value(4)),
        Step::Multiply(value(5), value(0)),
    ];
    assert_kept(&steps, &[6]);
}

#[test]
fn a_product_that_is_read_goes_into_no_other() {
    let steps = [
        Step::Sine(state(2)),
        Step::Multiply(state(0), state(1)),
        Step::Multiply(state(0), value(0)),
        Step::Add(state(3), value(2)),
        Step::Multiply(value(3), state(1)),
        Step::Multiply(value(1), value(0)),
        Step::Multiply(value(5), state(4)),
    ];
    assert_kept(&steps, &[4, 6]);
}
