//! Stage 5d, scaling: determinants beside what they are elsewhere.
//!
//! A determinant of inertias is as small as the machine: what says that a state is near the singular set is not its size,
//! but how much smaller it is there than where the axes stand otherwise. So it is divided by the largest of some values
//! with other orientations of joints, which follow from the parameters when a model is built; all other states have
//! their start there.

use std::collections::{BTreeMap, BTreeSet};

use crate::elaborate::{Attitude, Elaborated};
use crate::structure::Solution;
use crate::symbolic::substitute::symbols;
use crate::symbolic::{Expression, Function, Operation, Pool, Substitution, Symbol};

/// How many orientations are looked at.
pub(crate) const SAMPLES: usize = 3;

/// Quaternions of length one in decimals.
const QUATERNIONS: [[f64; 4]; SAMPLES] = [
    [0.5, 0.5, 0.5, 0.5],
    [0.8, 0.0, 0.36, 0.48],
    [0.1, 0.7, 0.1, 0.7],
];

/// Rotation matrices in decimals.
const ROTATIONS: [[[f64; 3]; 3]; SAMPLES] = [
    [[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]],
    [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
    [[0.36, -0.8, 0.48], [0.48, 0.6, 0.64], [-0.8, 0.0, 0.6]],
];

/// The determinants that vary with the state, of a moderate size away from their zeros.
pub(crate) fn scaled(model: &Elaborated, solution: &Solution, pool: &mut Pool) -> Vec<Expression> {
    let divisors = solution.conditioning.iter().map(|it| it.normalised);
    let divisors: Vec<Expression> = divisors.collect();
    let scaled = divisors.into_iter().map(|divisor| {
        let scale = scale(model, divisor, pool);
        let scaled = scale.and_then(|scale| pool.divide(divisor, scale));
        scaled.unwrap_or(divisor).magnitude()
    });
    scaled.collect()
}

/// The largest value of a divisor in the samples; none if one depends on what an iteration finds, or where it is near one
/// anyway. What does not depend on an orientation may be found again in terms of a quaternion of length one.
fn scale(model: &Elaborated, divisor: Expression, pool: &mut Pool) -> Option<Expression> {
    let read = symbols(pool, &[divisor]);
    let angles = angles(divisor, &read, pool);
    let mut largest: Option<Expression> = None;
    for number in 0..SAMPLES {
        let sample = sample(model, &angles, number, pool);
        let mut substitution = Substitution::new();
        for symbol in &read {
            let value = match symbol {
                Symbol::State(state) => match sample.get(state) {
                    Some(value) => *value,
                    None => model.states[*state].initial,
                },
                Symbol::Input(_) | Symbol::Time => Expression::ZERO,
                Symbol::Parameter(_) => continue,
                Symbol::Signal(_) | Symbol::Unknown(_) | Symbol::Slope(_) => return None,
            };
            substitution.set(*symbol, value);
        }
        let value = substitution.apply(pool, divisor)?;
        let value = pool.call(Function::Abs, &[value]);
        largest = Some(match largest {
            Some(largest) => pool.call(Function::Max, &[largest, value]),
            None => value,
        });
    }
    let largest = largest.filter(|it| *it != Expression::ZERO)?;
    let Some(value) = pool.constant_value(largest) else {
        return Some(largest);
    };
    // A power of two rounds nothing, and a moderate size needs none.
    let power = value.log2().round();
    (power.abs() > 8.0).then(|| pool.irrational(power.exp2()))
}

/// The states that are read in sines and cosines alone, whatever their units.
fn angles(divisor: Expression, read: &[Symbol], pool: &Pool) -> BTreeSet<usize> {
    let states = read.iter().filter_map(|symbol| match symbol {
        Symbol::State(state) => Some(*state),
        _ => None,
    });
    let mut angles: BTreeSet<usize> = states.collect();
    let mut seen = BTreeSet::new();
    let mut open = vec![divisor];
    while let Some(current) = open.pop() {
        match pool.operation(current) {
            Operation::Sine(_) | Operation::Cosine(_) => {}
            Operation::Symbol(Symbol::State(state)) => _ = angles.remove(state),
            _ if seen.insert(current.node()) => open.extend_from_slice(&pool.causes(current)),
            _ => {}
        }
    }
    angles
}

/// Values for angles and for the states of attitudes.
pub(crate) fn sample(
    model: &Elaborated,
    angles: &BTreeSet<usize>,
    number: usize,
    pool: &mut Pool,
) -> BTreeMap<usize, Expression> {
    let mut sample = BTreeMap::new();
    for state in angles {
        // Multiples of the golden ratio spread evenly.
        let place = (0.618 * ((number + 1) * (state + 2)) as f64).fract();
        sample.insert(*state, decimal(pool, 4.0 * place - 2.0));
    }
    for Attitude { rows } in &model.attitudes {
        for (row, states) in rows.iter().enumerate() {
            for (column, state) in states.iter().enumerate() {
                let value = match rows.len() {
                    1 => QUATERNIONS[number][column],
                    _ => ROTATIONS[number][row][column],
                };
                sample.insert(*state, decimal(pool, value));
            }
        }
    }
    sample
}

/// A number of three decimals.
fn decimal(pool: &mut Pool, value: f64) -> Expression {
    let magnitude = pool.literal(&format!("{:.3}", value.abs()));
    let magnitude = magnitude.unwrap_or(Expression::ZERO);
    magnitude.flipped(value < 0.0)
}
