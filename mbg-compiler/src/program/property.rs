//! Random routines give the same after each pass, in whole numbers modulo 2⁶⁴: sums and products are exact there, and sines
//! some function of one number.

use proptest::prelude::*;

use super::arrange::arrange;
use super::contract::contract;
use super::reorder::reorder;
use super::signs::signs;
use super::{Columns, Operand, Routine, Source, Step};
use crate::symbolic::Symbol;

const STATES: usize = 2;

/// How far back an operand may be; all others are states, so that many steps have some in common.
const NEAR: usize = 6;

fn read(operand: Operand, values: &[u64]) -> u64 {
    let number = match operand.source {
        Source::Value(value) => values[value],
        Source::Symbol(Symbol::State(state)) => sine(state as u64 + 1),
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
            Step::SineCosine(a) => {
                values.push(sine(read(*a, values)));
                sine(read(*a, values)).rotate_left(7)
            }
            other => unreachable!("{other:?}"),
        };
        values.push(found);
    }
}

/// What a routine returns, and its columns do.
fn results(routine: &Routine) -> Vec<u64> {
    let mut values = Vec::new();
    run(&routine.steps, &mut values);
    let mut found: Vec<u64> = routine
        .results
        .iter()
        .map(|it| read(*it, &values))
        .collect();
    values.resize(routine.names.len(), 0);
    for columns in &routine.columns {
        let mut inside = values[..columns.first].to_vec();
        run(&columns.steps, &mut inside);
        found.extend(columns.results.iter().map(|it| read(*it, &inside)));
    }
    found
}

/// A step in the making: its kind, and its operands among what is there, counted from behind.
type Draft = (u8, [(usize, bool); 2]);

fn drafts(most: usize) -> impl Strategy<Value = Vec<Draft>> {
    let operand = (0..12_usize, any::<bool>());
    prop::collection::vec((0..12_u8, [operand.clone(), operand]), 1..most)
}

/// Steps behind so many values, of which those in `hidden` are not to be read; how many values there are then.
fn steps(
    drafts: &[Draft],
    mut count: usize,
    hidden: &std::ops::Range<usize>,
) -> (Vec<Step>, usize) {
    let mut steps = Vec::new();
    for (kind, operands) in drafts {
        let [a, b] = operands.map(|(back, negative)| {
            let value = count.checked_sub(back + 1);
            let value = value.filter(|it| back < NEAR && !hidden.contains(it));
            let state = Source::Symbol(Symbol::State(back % STATES));
            let source = value.map_or(state, Source::Value);
            Operand { source, negative }
        });
        let step = match kind {
            0 => Step::SineCosine(a),
            1..6 => Step::Add(a, b),
            _ => Step::Multiply(a, b),
        };
        count += step.results();
        steps.push(step);
    }
    (steps, count)
}

/// Some values have a name, which keeps their sign.
fn name(value: usize) -> String {
    if value.is_multiple_of(5) {
        format!("v.{value}")
    } else {
        String::new()
    }
}

fn last(count: usize) -> Vec<Operand> {
    let value = |value| Operand::plain(Source::Value(value));
    (count.saturating_sub(3)..count).map(value).collect()
}

fn routine(main: &[Draft], of_columns: &[Vec<Draft>]) -> Routine {
    let (main, first) = steps(main, 0, &(0..0));
    let mut count = first;
    let mut columns = Vec::new();
    for drafts in of_columns {
        let begin = count;
        let (steps, end) = steps(drafts, begin, &(first..begin));
        columns.push(Columns {
            variables: vec![0],
            first: begin,
            steps,
            results: vec![Operand::plain(Source::Value(end - 1))],
        });
        count = end;
    }
    Routine {
        steps: main,
        names: (0..count).map(name).collect(),
        results: last(first),
        columns,
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 5000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn passes_keep_what_a_routine_returns(
        main in drafts(40),
        columns in prop::collection::vec(drafts(12), 0..3),
    ) {
        let before = routine(&main, &columns);
        let expected = results(&before);
        let reordered = reorder(&before);
        prop_assert_eq!(&results(&reordered), &expected, "reordered");
        let contracted = contract(&reordered);
        prop_assert_eq!(&results(&contracted), &expected, "contracted");
        let signed = signs(&contracted);
        prop_assert_eq!(&results(&signed), &expected, "with other signs");
        prop_assert_eq!(&results(&arrange(&signed)), &expected, "arranged");
    }
}
