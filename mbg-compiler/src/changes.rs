//! Stage 5e, changes: where choices in the laws change, as in `if t < start { 0.0 } else { 2.0 }` at the time `start`.

use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

use crate::symbolic::choices::choice_of;
use crate::symbolic::substitute::{operations, replace, symbols, visit};
use crate::symbolic::{Differentiator, Expression, Operation, Pool, Rate, Symbol, affine};

/// Most branches of choices within a condition that are tried.
const MOST: usize = 64;

/// An expression, and the values of it at which choices change; without any it is an angle of which choices are by a wave.
pub struct Argument {
    /// Varying, without what parameters alone add to it or multiply it by.
    pub value: Expression,
    /// How it changes with time and states, in terms of their [`Symbol::Slope`]s; zero for what is long to work out.
    pub rate: Expression,
    /// In terms of parameters, each once.
    pub thresholds: Vec<Expression>,
}

/// Times, in terms of parameters, at which steps of integration end.
///
/// A choice by more than time, or by a wave of it, has none.
pub fn times(pool: &mut Pool, rates: &[Expression]) -> Vec<Expression> {
    let mut times = Vec::new();
    for difference in differences(pool, rates) {
        let read = symbols(pool, &[difference]);
        let is_fixed = |it: &Symbol| matches!(it, Symbol::Time | Symbol::Parameter(_));
        if read.contains(&Symbol::Time) && read.iter().all(is_fixed) {
            let zeros: Vec<_> = branches(pool, difference)
                .into_iter()
                .filter_map(|branch| zero(pool, branch))
                .collect();
            add_new(&mut times, zeros);
        }
    }
    times
}

/// What a step may pass more of than it finds: arguments of the state, and waves, which go back over each threshold, with their
/// angles.
///
/// `states` are those of the rates.
pub fn arguments(pool: &mut Pool, rates: &[Expression], states: &[Symbol]) -> Vec<Argument> {
    let mut arguments: Vec<Argument> = Vec::new();
    for difference in differences(pool, rates) {
        for branch in branches(pool, difference) {
            let Some((value, threshold)) = threshold(pool, branch) else {
                continue;
            };
            match arguments.iter_mut().find(|it| it.value == value) {
                Some(known) => add_new(&mut known.thresholds, vec![threshold]),
                None => arguments.push(Argument {
                    value,
                    rate: Expression::ZERO,
                    thresholds: vec![threshold],
                }),
            }
        }
    }
    let mut turning = Vec::new();
    arguments.retain(|argument| {
        let angles = angles(pool, argument.value);
        let is_wave = !angles.is_empty();
        add_new(&mut turning, angles);
        is_wave || is_of_state(pool, argument.value)
    });
    let mut along = Differentiator::along(slopes(pool, states));
    for argument in &mut arguments {
        let rate = along.derivative(pool, argument.value);
        // A step is not to take longer for it than for an evaluation of the model.
        if operations(pool, &[rate]) <= operations(pool, rates) {
            argument.rate = rate;
        }
    }
    arguments.extend(turning.into_iter().map(|value| Argument {
        value,
        rate: Expression::ZERO,
        thresholds: Vec::new(),
    }));
    arguments
}

/// How time and states change with time.
fn slopes(pool: &mut Pool, states: &[Symbol]) -> BTreeMap<Symbol, Expression> {
    let states = states.iter().enumerate();
    let states = states.map(|(place, state)| (*state, pool.symbol(Symbol::Slope(place))));
    states.chain([(Symbol::Time, Expression::ONE)]).collect()
}

fn is_of_state(pool: &Pool, value: Expression) -> bool {
    let is_state = |it: &Symbol| matches!(it, Symbol::State(_) | Symbol::Unknown(_));
    symbols(pool, &[value]).iter().any(is_state)
}

/// What grows by half a turn from each end of the way of a wave to the next, for waves over time or one state alone.
fn angles(pool: &mut Pool, value: Expression) -> Vec<Expression> {
    let mut read = symbols(pool, &[value]);
    read.retain(|it| !matches!(it, Symbol::Parameter(_)));
    let [Symbol::State(_) | Symbol::Time] = read[..] else {
        return Vec::new();
    };
    let mut waves = Vec::new();
    visit(pool, &[value], |_, operation| match *operation {
        Operation::Sine(angle) => waves.push((angle, true)),
        Operation::Cosine(angle) => waves.push((angle, false)),
        _ => {}
    });
    waves.retain(|(angle, _)| pool.rate(*angle) == Rate::Varying);
    let quarter = pool.irrational(FRAC_PI_2);
    let turned = |(angle, is_sine)| match is_sine {
        true => pool.add(angle, quarter),
        false => angle,
    };
    waves.into_iter().map(turned).collect()
}

/// Each argument with its rate, followed by its thresholds.
pub fn listed(arguments: &[Argument]) -> Vec<Expression> {
    let listed = |it: &Argument| [&[it.value, it.rate][..], &it.thresholds].concat();
    arguments.iter().flat_map(listed).collect()
}

/// What changes its sign where a choice in some expressions changes.
fn differences(pool: &mut Pool, expressions: &[Expression]) -> Vec<Expression> {
    let choices = choices(pool, expressions);
    let mut differences = Vec::new();
    for (_, [a, b, ..]) in choices {
        let difference = pool.subtract(a, b);
        add_new(&mut differences, vec![difference]);
    }
    differences
}

/// What each choice in some expressions is, and what it is between.
fn choices(pool: &Pool, expressions: &[Expression]) -> Vec<(Expression, [Expression; 4])> {
    let mut found = Vec::new();
    visit(pool, expressions, |part, operation| {
        found.extend(choice_of(operation).map(|choice| (part, choice)));
    });
    found
}

/// An expression of choices, such as `min(max(t, 0.0), 1.0)`, with one branch of each in its place: all that there are, as
/// long as they are few.
fn branches(pool: &mut Pool, expression: Expression) -> Vec<Expression> {
    let mut found = Vec::new();
    let mut open = vec![expression];
    for _ in 0..MOST {
        let Some(expression) = open.pop() else {
            break;
        };
        match choices(pool, &[expression]).first().copied() {
            None => add_new(&mut found, vec![expression]),
            Some((part, [_, _, c, d])) => {
                let chosen = [d, c].map(|branch| replace(pool, expression, &[(part, branch)]));
                open.extend(chosen.into_iter().flatten());
            }
        }
    }
    found
}

/// The time at which an expression of time and parameters is zero, if it is a line.
fn zero(pool: &mut Pool, expression: Expression) -> Option<Expression> {
    let is_time = |symbol: &Symbol| *symbol == Symbol::Time;
    let (slope, rest) = affine(pool, expression, Symbol::Time, is_time)?;
    pool.divide(rest.negated(), slope)
}

/// What has a value of parameters alone where an expression is zero, and that value.
fn threshold(pool: &mut Pool, difference: Expression) -> Option<(Expression, Expression)> {
    let (mut value, mut threshold) = (difference, Expression::ZERO);
    loop {
        let (varying, fixed) = terms(pool, value);
        let rest = pool.sum(&varying);
        let fixed = pool.sum(&fixed);
        threshold = pool.subtract(threshold, fixed);
        let (factor, product) = pool.scaled(rest.magnitude());
        threshold = pool.divide(threshold.flipped(rest.is_negative()), factor)?;
        if product == value {
            return Some((value, threshold));
        }
        value = product;
    }
}

/// The terms of a sum, those of parameters alone apart.
fn terms(pool: &Pool, sum: Expression) -> (Vec<Expression>, Vec<Expression>) {
    let mut open = vec![sum];
    let (mut varying, mut fixed) = (Vec::new(), Vec::new());
    while let Some(term) = open.pop() {
        if pool.rate(term) != Rate::Varying {
            fixed.push(term);
        } else if let Operation::Add(a, b) = *pool.operation(term) {
            open.extend([b, a].map(|part| part.flipped(term.is_negative())));
        } else {
            varying.push(term);
        }
    }
    (varying, fixed)
}

/// Adds those that are not there.
fn add_new(known: &mut Vec<Expression>, found: Vec<Expression>) {
    for it in found {
        if !known.contains(&it) {
            known.push(it);
        }
    }
}
