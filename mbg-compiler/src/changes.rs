//! Stage 5e, changes: where choices in the laws change, as in `if t < start { 0.0 } else { 2.0 }` at the time `start`, and where
//! `mod(t, period)` jumps.

use std::collections::BTreeMap;
use std::f64::consts::{FRAC_1_PI, PI};

use crate::symbolic::choices::choice_of;
use crate::symbolic::substitute::{depends, operations, replace, symbols, visit};
use crate::symbolic::{
    Differentiator, Expression, Function, Operation, Pool, Rate, Symbol, affine,
};

/// Most branches of choices within a condition that are tried.
const MOST: usize = 64;

/// So many operations are next to nothing.
const LITTLE: usize = 24;

/// Times, in terms of parameters, at which steps of integration end.
#[derive(Default)]
pub struct Times {
    /// Each once.
    pub once: Vec<Expression>,
    /// Each with the period after which it comes again.
    pub again: Vec<[Expression; 2]>,
    /// What changes its sign at others, in terms of time and inputs, too.
    pub sought: Vec<Expression>,
    /// What goes over whole numbers at others, likewise.
    pub counted: Vec<Expression>,
    /// What the laws compare by time and inputs, as they do.
    pub compared: Vec<[Expression; 2]>,
    /// What they count the whole turns of.
    pub turning: Vec<Expression>,
}

impl Times {
    /// All of them, one after the other.
    pub fn listed(&self) -> Vec<Expression> {
        [&self.once, self.again.as_flattened()].concat()
    }

    /// What tells of others.
    pub fn telling(&self) -> Vec<Expression> {
        [&self.sought[..], &self.counted].concat()
    }

    /// What tells on which side of all of them the laws are.
    pub fn sides(&self) -> Vec<Expression> {
        [self.compared.as_flattened(), &self.turning].concat()
    }

    /// How many there are of each.
    pub fn counts(&self) -> Counts {
        Counts {
            once: self.once.len(),
            sought: self.sought.len(),
            compared: self.compared.len(),
        }
    }
}

/// How many [`Times`] come once, and how many tell of others by their signs or by being the smaller of two.
#[allow(missing_docs)]
#[derive(Clone, Copy, Debug)]
pub struct Counts {
    pub once: usize,
    pub sought: usize,
    pub compared: usize,
}

/// An expression, and the values of it at which choices change.
pub struct Argument {
    /// Varying, without what parameters alone add to it or multiply it by.
    pub value: Expression,
    /// How it changes with time, states and inputs, in terms of their [`Symbol::Slope`]s; zero for what is long to work out.
    pub rate: Expression,
    /// In terms of parameters.
    pub thresholds: Vec<Expression>,
    /// Whether they come again with every whole number.
    pub repeats: bool,
    /// Whether choices change there, or a wave may turn.
    pub is_choice: bool,
}

/// What is known of an [`Argument`] while compiling.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    /// How many.
    pub thresholds: usize,
    /// Whether they come again with every whole number.
    pub repeats: bool,
    /// Whether choices change there.
    pub is_choice: bool,
}

impl Argument {
    fn new(value: Expression, thresholds: Vec<Expression>, repeats: bool) -> Self {
        let rate = Expression::ZERO;
        Self {
            value,
            rate,
            thresholds,
            repeats,
            is_choice: true,
        }
    }

    /// How many half turns of waves there are.
    fn turns(value: Expression) -> Self {
        // A wave turns at least once in each half turn, behind what it may have passed before.
        let twice = vec![Expression::ZERO; 2];
        Self {
            is_choice: false,
            ..Self::new(value, twice, true)
        }
    }

    /// What is known of it while compiling.
    pub fn kind(&self) -> Kind {
        Kind {
            thresholds: self.thresholds.len(),
            repeats: self.repeats,
            is_choice: self.is_choice,
        }
    }
}

/// Of rates whose states are these: when they change, and by what a step may pass more of that than it finds.
pub fn of(pool: &mut Pool, rates: &[Expression], states: &[Symbol]) -> (Times, Vec<Argument>) {
    (times(pool, rates), arguments(pool, rates, states))
}

/// When what is by time and inputs changes. Where there is no closed form for it, as of what compares two waves, times at which a
/// wave turns or goes through zero are among those that come again: between them it hardly changes its sign twice.
pub fn times(pool: &mut Pool, rates: &[Expression]) -> Times {
    let mut times = Times::default();
    for difference in differences(pool, rates) {
        let (is_driven, is_of_time) = (is_driven(pool, difference), is_of_time(pool, difference));
        let unknown = match is_driven && !is_of_time {
            true => vec![difference],
            false => add_zeros(pool, &mut times, difference),
        };
        if unknown.is_empty() {
            continue;
        }
        let sought = if is_driven { vec![difference] } else { unknown };
        for sought in sought {
            add_new(&mut times.sought, [sought]);
            add_new(&mut times.again, quarters(pool, sought));
        }
    }
    for turns in fractions(pool, rates) {
        let mut is_known = is_of_time(pool, turns);
        for branch in branches(pool, turns) {
            if is_of_time(pool, branch) {
                let found = repeated(pool, branch, &[Expression::ZERO], Expression::ONE);
                is_known &= !found.is_empty();
                add_new(&mut times.again, found);
            }
        }
        if !is_known && is_driven(pool, turns) {
            add_new(&mut times.counted, [turns]);
            add_new(&mut times.again, quarters(pool, turns));
        }
    }
    add_sides(pool, &mut times, rates);
    times
}

/// Adds the times at which branches of time alone are zero, and tells of those of which these are not known.
fn add_zeros(pool: &mut Pool, times: &mut Times, difference: Expression) -> Vec<Expression> {
    let mut unknown = Vec::new();
    for branch in branches(pool, difference) {
        if !is_of_time(pool, branch) {
            continue;
        }
        let (zero, zeros) = (zero(pool, branch), zeros(pool, branch));
        if zero.is_none() && zeros.is_none() {
            unknown.push(branch);
        }
        add_new(&mut times.once, zero);
        add_new(&mut times.again, zeros.unwrap_or_default());
    }
    unknown
}

/// Adds what the laws ask by time and inputs: what they add up is rounded otherwise than what is left of it in a difference.
fn add_sides(pool: &mut Pool, times: &mut Times, rates: &[Expression]) {
    for (_, [a, b, ..]) in choices(pool, rates) {
        let difference = pool.subtract(a, b);
        if is_driven(pool, difference) {
            add_new(&mut times.compared, [[a, b]]);
        }
    }
    let mut turning = fractions(pool, rates);
    turning.retain(|turns| is_driven(pool, *turns));
    add_new(&mut times.turning, turning);
}

/// What a step may pass more of than it finds: arguments of the state, of inputs where a law jumps, and waves, which go back over
/// each threshold, with their angles. Steps end at [`times`].
fn arguments(pool: &mut Pool, rates: &[Expression], states: &[Symbol]) -> Vec<Argument> {
    let mut arguments: Vec<Argument> = Vec::new();
    let jumping = jumping(pool, rates);
    for difference in differences(pool, rates) {
        for branch in branches(pool, difference) {
            let Some((value, threshold)) = threshold(pool, branch) else {
                continue;
            };
            let is_known = is_of_time(pool, branch) && zeros(pool, branch).is_some();
            let is_asked = match is_given(pool, branch) {
                true => jumping.contains(&difference) && !comes_again(pool, branch),
                false => is_moved(pool, value) || !angles(pool, value).is_empty(),
            };
            if is_known || !is_asked {
                continue;
            }
            match *pool.operation(value) {
                Operation::Call(Function::Fraction, ref turns) => {
                    let turns = turns[0];
                    add_repeated(pool, &mut arguments, turns, threshold);
                }
                _ => add_threshold(&mut arguments, value, threshold, false),
            }
        }
    }
    for turns in fractions(pool, rates) {
        if is_moved(pool, turns) {
            add_repeated(pool, &mut arguments, turns, Expression::ZERO);
        }
    }
    let mut turning = Vec::new();
    for argument in &arguments {
        add_new(&mut turning, angles(pool, argument.value));
    }
    let mut along = Differentiator::along(slopes(pool, states, &arguments));
    for argument in &mut arguments {
        let rate = along.derivative(pool, argument.value);
        // A step is not to take longer for it than for an evaluation of the model, unless that takes next to nothing.
        if operations(pool, &[rate]) <= operations(pool, rates).max(LITTLE) {
            argument.rate = rate;
        }
    }
    arguments.extend(turning.into_iter().map(Argument::turns));
    arguments
}

/// Adds a threshold of what is beyond whole turns; all that count the same turns, from wherever, are thresholds of one argument.
fn add_repeated(
    pool: &mut Pool,
    arguments: &mut Vec<Argument>,
    turns: Expression,
    threshold: Expression,
) {
    let (varying, fixed) = terms(pool, turns);
    let [value, ahead] = [varying, fixed].map(|terms| pool.sum(&terms));
    let threshold = pool.subtract(threshold, ahead);
    let threshold = threshold.flipped(value.is_negative());
    add_threshold(arguments, value.magnitude(), threshold, true);
}

/// Adds a threshold that is not there.
fn add_threshold(
    arguments: &mut Vec<Argument>,
    value: Expression,
    threshold: Expression,
    repeats: bool,
) {
    let is_known = |it: &&mut Argument| it.value == value && it.repeats == repeats;
    match arguments.iter_mut().find(is_known) {
        Some(known) => add_new(&mut known.thresholds, [threshold]),
        None => arguments.push(Argument::new(value, vec![threshold], repeats)),
    }
}

/// How time, states and the inputs that are read change with time; the slopes of inputs are behind those of all states.
fn slopes(
    pool: &mut Pool,
    states: &[Symbol],
    arguments: &[Argument],
) -> BTreeMap<Symbol, Expression> {
    let values: Vec<Expression> = arguments.iter().map(|it| it.value).collect();
    let inputs = symbols(pool, &values)
        .into_iter()
        .filter_map(|symbol| match symbol {
            Symbol::Input(place) => Some((symbol, states.len() + place)),
            _ => None,
        });
    let states = states.iter().enumerate().map(|(place, it)| (*it, place));
    let varying = states.chain(inputs);
    let changes = varying.map(|(symbol, place)| (symbol, pool.symbol(Symbol::Slope(place))));
    changes.chain([(Symbol::Time, Expression::ONE)]).collect()
}

/// Whether it changes with time, and with nothing but that and inputs while a model runs.
fn is_driven(pool: &Pool, value: Expression) -> bool {
    let is_given =
        |it: &Symbol| matches!(it, Symbol::Time | Symbol::Input(_) | Symbol::Parameter(_));
    !depends(pool, value, |it| !is_given(it)) && depends(pool, value, is_time)
}

/// Whether it changes with time, and with nothing else while a model runs.
fn is_of_time(pool: &Pool, value: Expression) -> bool {
    let is_fixed = |it: &Symbol| matches!(it, Symbol::Time | Symbol::Parameter(_));
    !depends(pool, value, |it| !is_fixed(it)) && depends(pool, value, is_time)
}

fn is_time(symbol: &Symbol) -> bool {
    *symbol == Symbol::Time
}

/// Whether it changes with inputs, and with nothing but those and time while a model runs.
fn is_given(pool: &Pool, value: Expression) -> bool {
    let is_found = |it: &Symbol| matches!(it, Symbol::State(_) | Symbol::Unknown(_));
    let is_input = |it: &Symbol| matches!(it, Symbol::Input(_));
    !depends(pool, value, is_found) && depends(pool, value, is_input)
}

/// Whether it begins anew with time at [`times`] that come again, as `mod(t, period) - input` does: between them it hardly changes
/// its sign twice.
fn comes_again(pool: &mut Pool, value: Expression) -> bool {
    let turns = fractions(pool, &[value]);
    turns.into_iter().any(|turns| is_of_time(pool, turns)) || !quarters(pool, value).is_empty()
}

/// Whether it changes with the state or an input.
fn is_moved(pool: &Pool, value: Expression) -> bool {
    depends(pool, value, |it| {
        matches!(it, Symbol::State(_) | Symbol::Unknown(_) | Symbol::Input(_))
    })
}

/// What grows by one from each end of the way of a wave to the next, for waves over one state alone, or over time and inputs.
fn angles(pool: &mut Pool, value: Expression) -> Vec<Expression> {
    let mut read = symbols(pool, &[value]);
    read.retain(|it| !matches!(it, Symbol::Parameter(_)));
    let is_given = |it: &Symbol| matches!(it, Symbol::Time | Symbol::Input(_));
    if !matches!(read[..], [Symbol::State(_)]) && !read.iter().all(is_given) {
        return Vec::new();
    }
    let mut waves = Vec::new();
    visit(pool, &[value], |_, operation| match *operation {
        Operation::Sine(angle) => waves.push((angle, true)),
        Operation::Cosine(angle) => waves.push((angle, false)),
        _ => {}
    });
    waves.retain(|(angle, _)| pool.rate(*angle) == Rate::Varying);
    let reciprocal = pool.irrational(FRAC_1_PI);
    let two = pool.integer(2);
    let half = pool.divide(Expression::ONE, two);
    let half_turns = |(angle, is_sine)| {
        let half_turns = pool.multiply(reciprocal, angle);
        match is_sine {
            true => pool.add(half_turns, half.unwrap_or(Expression::ZERO)),
            false => half_turns,
        }
    };
    waves.into_iter().map(half_turns).collect()
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
        add_new(&mut differences, [difference]);
    }
    differences
}

/// What changes its sign where an expression may jump, which the smaller of two and what has no sign do not.
fn jumping(pool: &mut Pool, expressions: &[Expression]) -> Vec<Expression> {
    let mut choices = choices(pool, expressions);
    choices.retain(|(part, _)| match *pool.operation(*part) {
        Operation::Call(function, _) => {
            !matches!(function, Function::Min | Function::Max | Function::Abs)
        }
        _ => false,
    });
    let of = |(_, [a, b, ..]): (_, [Expression; 4])| pool.subtract(a, b);
    choices.into_iter().map(of).collect()
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
            None if is_number(pool, expression) => add_new(&mut found, [expression]),
            None => {}
            Some((part, [_, _, c, d])) => {
                let chosen = [d, c].map(|branch| replace(pool, expression, &[(part, branch)]));
                // It stands in the equations of an unknown, in which nothing is replaced.
                if chosen.contains(&Some(expression)) {
                    break;
                }
                open.extend(chosen.into_iter().flatten());
            }
        }
    }
    found
}

/// Whether it has a value wherever its variables have: a call of constants is a constant but where it is no number, as the root of
/// what is below zero. A law does not come to a branch with such a one.
fn is_number(pool: &Pool, expression: Expression) -> bool {
    let is_constant = |it: &Expression| pool.constant_value(*it).is_some();
    let mut is_number = true;
    visit(pool, &[expression], |_, operation| {
        if let Operation::Call(_, arguments) = operation {
            is_number &= !arguments.iter().all(is_constant);
        }
    });
    is_number
}

/// The time at which an expression of time and parameters is zero, if it is a line.
fn zero(pool: &mut Pool, expression: Expression) -> Option<Expression> {
    let (slope, rest) = affine(pool, expression, Symbol::Time, is_time)?;
    pool.divide(rest.negated(), slope)
}

/// The times at which an expression of time and parameters is zero, each with the period after which it is so again, if it is of
/// one wave or of one fraction of what is a line; a wave may never come so far.
fn zeros(pool: &mut Pool, expression: Expression) -> Option<Vec<[Expression; 2]>> {
    let (value, threshold) = threshold(pool, expression)?;
    let is_beyond = pool
        .constant_value(threshold)
        .is_some_and(|it| it.abs() > 1.0);
    let turn = pool.irrational(2.0 * PI);
    let found = match *pool.operation(value) {
        Operation::Sine(_) | Operation::Cosine(_) if is_beyond => return Some(Vec::new()),
        Operation::Sine(angle) => {
            let place = pool.call(Function::Asin, &[threshold]);
            let half = pool.irrational(PI);
            let other = pool.subtract(half, place);
            repeated(pool, angle, &[place, other], turn)
        }
        Operation::Cosine(angle) => {
            let place = pool.call(Function::Acos, &[threshold]);
            repeated(pool, angle, &[place, place.negated()], turn)
        }
        Operation::Call(Function::Fraction, ref turns) => {
            let turns = turns[0];
            repeated(pool, turns, &[threshold], Expression::ONE)
        }
        _ => return None,
    };
    (!found.is_empty()).then_some(found)
}

/// The times at which the waves in an expression turn or are zero, each with its period.
fn quarters(pool: &mut Pool, expression: Expression) -> Vec<[Expression; 2]> {
    let mut angles = Vec::new();
    visit(pool, &[expression], |_, operation| {
        if let Operation::Sine(angle) | Operation::Cosine(angle) = *operation {
            add_new(&mut angles, [angle]);
        }
    });
    angles.retain(|angle| is_of_time(pool, *angle));
    let quarter = pool.irrational(0.5 * PI);
    let half = pool.irrational(PI);
    let places = [Expression::ZERO, quarter];
    let times = angles.into_iter();
    times
        .flat_map(|angle| repeated(pool, angle, &places, half))
        .collect()
}

/// The times at which an argument is at one of some places but for whole periods, each with how long a period lasts, if it is a line
/// over time.
fn repeated(
    pool: &mut Pool,
    argument: Expression,
    places: &[Expression],
    period: Expression,
) -> Vec<[Expression; 2]> {
    let Some((slope, rest)) = affine(pool, argument, Symbol::Time, is_time) else {
        return Vec::new();
    };
    let Some(lasting) = pool.divide(period, slope) else {
        return Vec::new();
    };
    let lasting = pool.call(Function::Abs, &[lasting]);
    let times = places.iter().filter_map(|place| {
        let way = pool.subtract(*place, rest);
        Some([pool.divide(way, slope)?, lasting])
    });
    times.collect()
}

/// What the fractions in some expressions are of.
fn fractions(pool: &Pool, expressions: &[Expression]) -> Vec<Expression> {
    let mut found = Vec::new();
    visit(pool, expressions, |_, operation| {
        if let Operation::Call(Function::Fraction, arguments) = operation {
            found.push(arguments[0]);
        }
    });
    found
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
fn add_new<T: PartialEq>(known: &mut Vec<T>, found: impl IntoIterator<Item = T>) {
    for it in found {
        if !known.contains(&it) {
            known.push(it);
        }
    }
}
