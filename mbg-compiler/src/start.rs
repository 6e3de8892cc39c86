//! Stage 5d, start: a model must not start where something that it divides by is zero, nor where a law is infinite.
//!
//! A proper Euler sequence, such as z-x-z, is singular where its middle angle is zero, which is where angles start
//! unless they are told otherwise. Errors: `MBG0404`. Where a ratio is infinite there is a warning of that code.

use std::collections::BTreeMap;

use crate::codes;
use crate::diagnostics::{Diagnostic, Diagnostics, error};
use crate::elaborate::Elaborated;
use crate::graph::Law;
use crate::symbolic::substitute::symbols;
use crate::symbolic::{Evaluation, Expression, Factor, Pool, Symbol};

/// A normalised determinant below this is zero: that of `System::trouble` in double precision.
const SINGULAR: f64 = 1.5e-8;
/// What is proposed in place of a start at which a determinant is zero.
const PROPOSED: f64 = 0.5;

/// Reports normalised determinants, given with their names, that are zero with initial values and default parameters,
/// without inputs.
pub fn check(
    model: &Elaborated,
    conditioning: &[(Expression, &String)],
    pool: &Pool,
    diagnostics: &mut Diagnostics,
) {
    let start = Start::of(model, pool);
    let unchanged = |symbol| start.symbol(symbol, &BTreeMap::new());
    let mut evaluation = Evaluation::new(&unchanged);
    for (divisor, name) in conditioning {
        // One without a value depends on what only an iteration finds.
        if evaluation.value(pool, *divisor).abs() < SINGULAR {
            report(&start, *divisor, name, pool, diagnostics);
        }
    }
}

/// Reports a storage that starts at a pole of its law, and warns of a ratio that starts at one, where a rate is not finite for that.
///
/// A law alone may be: the logarithm of no amount of substance, of which only the exponential is read.
pub fn check_laws(
    model: &Elaborated,
    rates: &[Expression],
    pool: &Pool,
    diagnostics: &mut Diagnostics,
) {
    let start = Start::of(model, pool);
    let is_iterated = |rate: &Expression| {
        let read = symbols(pool, &[*rate]);
        read.iter().any(|it| {
            matches!(
                it,
                Symbol::Signal(_) | Symbol::Unknown(_) | Symbol::Slope(_)
            )
        })
    };
    let is_infinite = |rate: &&Expression| {
        let with_inputs = |input| {
            let symbol = |symbol| match symbol {
                Symbol::Input(_) => input,
                _ => start.symbol(symbol, &BTreeMap::new()),
            };
            Evaluation::new(&symbol).value(pool, **rate)
        };
        !is_iterated(rate) && !with_inputs(0.0).is_finite() && !with_inputs(PROPOSED).is_finite()
    };
    let Some(rate) = rates.iter().find(is_infinite) else {
        return;
    };
    let read = symbols(pool, &[*rate]);
    for element in &model.graph.elements {
        let Law::Storage(storage) = &element.law else {
            continue;
        };
        for (state, law) in storage.states.clone().zip(&storage.coenergy) {
            let changed = BTreeMap::from([(state, start.states[state] + PROPOSED)]);
            let leads_away = start.changed(pool, *law, &changed).is_finite();
            let is_read = read.contains(&Symbol::State(state));
            if is_read && leads_away && !start.value(pool, *law).is_finite() {
                let message = format!("the law of `{}` is not finite at the start", element.name);
                let report = error(codes::SINGULAR_START, model.states[state].span, message);
                diagnostics.report(report.help(proposal(model, &start, state)));
                return;
            }
        }
    }
    // Unlike a law, a line between points that meet is seldom where it is to begin: a start of the run's or `Trim` leads away.
    if let Some(report) = infinite_ratio(&start, pool) {
        diagnostics.warn(report);
    }
}

/// What is said of a ratio that is not finite at the start, as that along a line between two points that meet.
fn infinite_ratio(start: &Start, pool: &Pool) -> Option<Diagnostic> {
    let graph = &start.model.graph;
    graph.elements.iter().find_map(|element| {
        let (Law::Transformer(ratio) | Law::Gyrator(ratio)) = &element.law else {
            return None;
        };
        let entries = ratio.factors.iter().flat_map(|factor| match factor {
            Factor::Dense(matrix) => &matrix.entries[..],
            _ => &[],
        });
        let (state, value) = entries
            .filter(|entry| !start.value(pool, **entry).is_finite())
            .find_map(|entry| start.led_away(pool, *entry))?;
        let message = format!("the ratio of `{}` is not finite at the start", element.name);
        let report = error(
            codes::SINGULAR_START,
            graph.origins.span(element.origin),
            message,
        );
        let state = &start.model.states[state].variable.name;
        Some(report.help(format!(
            "let `{state}` start elsewhere, as at {value:?}, where it is finite"
        )))
    })
}

/// Default parameters, and states at the start.
pub(crate) struct Start<'a> {
    model: &'a Elaborated,
    parameters: Vec<f64>,
    states: Vec<f64>,
}

impl<'a> Start<'a> {
    /// The initial values, worked out.
    pub(crate) fn of(model: &'a Elaborated, pool: &Pool) -> Self {
        let defaults = model.parameters.iter().map(|it| it.default);
        Self::with(model, defaults.collect(), pool)
    }

    /// The same with other parameters.
    pub(crate) fn with(model: &'a Elaborated, parameters: Vec<f64>, pool: &Pool) -> Self {
        let parameters = Self {
            model,
            parameters,
            states: Vec::new(),
        };
        let symbol = |symbol| parameters.symbol(symbol, &BTreeMap::new());
        let mut evaluation = Evaluation::new(&symbol);
        let states = model.states.iter();
        let states = states.map(|state| evaluation.value(pool, state.initial));
        let states = states.collect();
        Self {
            states,
            ..parameters
        }
    }

    /// The value of an expression at the start, without inputs; NaN if it depends on what only an iteration finds.
    pub(crate) fn value(&self, pool: &Pool, expression: Expression) -> f64 {
        self.changed(pool, expression, &BTreeMap::new())
    }

    /// The same with some states changed.
    pub(crate) fn changed(
        &self,
        pool: &Pool,
        expression: Expression,
        changed: &BTreeMap<usize, f64>,
    ) -> f64 {
        let symbol = |symbol| self.symbol(symbol, changed);
        Evaluation::new(&symbol).value(pool, expression)
    }

    /// A state with another value at which an expression is finite that is not finite at the start.
    fn led_away(&self, pool: &Pool, expression: Expression) -> Option<(usize, f64)> {
        let read = symbols(pool, &[expression]).into_iter();
        let mut others = read.filter_map(|it| match it {
            Symbol::State(state) => Some((state, self.states[state] + PROPOSED)),
            _ => None,
        });
        others.find(|other| {
            let changed = BTreeMap::from([*other]);
            self.changed(pool, expression, &changed).is_finite()
        })
    }

    /// What a symbol is at the start, but with some states changed.
    fn symbol(&self, symbol: Symbol, changed: &BTreeMap<usize, f64>) -> f64 {
        match symbol {
            Symbol::Parameter(index) => self.parameters[index],
            Symbol::State(index) => *changed.get(&index).unwrap_or(&self.states[index]),
            Symbol::Input(_) | Symbol::Time => 0.0,
            Symbol::Signal(_) | Symbol::Unknown(_) | Symbol::Slope(_) => f64::NAN,
        }
    }
}

fn report(
    start: &Start,
    divisor: Expression,
    name: &str,
    pool: &Pool,
    diagnostics: &mut Diagnostics,
) {
    let model = start.model;
    let read: Vec<usize> = symbols(pool, &[divisor])
        .into_iter()
        .filter_map(|symbol| match symbol {
            Symbol::State(state) => Some(state),
            _ => None,
        })
        .collect();
    // The one that leads away, or else the first.
    let leads_away = |state: &&usize| {
        let changed = BTreeMap::from([(**state, start.states[**state] + PROPOSED)]);
        start.changed(pool, divisor, &changed).abs() > SINGULAR
    };
    let Some(state) = read.iter().find(leads_away).or(read.first()) else {
        return;
    };
    let message = format!("the model starts where {name} is zero, which it divides by");
    let report = error(codes::SINGULAR_START, model.states[*state].span, message)
        .note("rates are not finite there: this is the edge of the model's singular set");
    diagnostics.report(report.help(proposal(model, start, *state)));
}

/// The initial values to type, with one component changed.
fn proposal(model: &Elaborated, start: &Start, state: usize) -> String {
    let name = &model.states[state].variable.name;
    let (whole, members) = match vector(model, state) {
        Some((whole, members)) => (whole, members),
        None => (name.as_str(), state..state + 1),
    };
    let values = members.clone().map(|member| {
        let value = start.states[member] + if member == state { PROPOSED } else { 0.0 };
        format!("{value:?}")
    });
    let values = values.collect::<Vec<_>>().join(", ");
    let values = if members.len() == 1 {
        values
    } else {
        format!("[{values}]")
    };
    format!("give `{whole}` another start, such as `initial: {values}`")
}

/// The vector of which a state is a component: its name, and its states.
fn vector(model: &Elaborated, state: usize) -> Option<(&str, std::ops::Range<usize>)> {
    let name = |state: usize| model.states.get(state).map(|it| it.variable.name.as_str());
    let (whole, component) = name(state)?.rsplit_once('.')?;
    let place = match ["x", "y", "z"].iter().position(|known| *known == component) {
        Some(place) => place,
        None => component.parse().ok()?,
    };
    let first = state.checked_sub(place)?;
    let belongs = |state: &usize| {
        name(*state).is_some_and(|name| name.rsplit_once('.').is_some_and(|it| it.0 == whole))
    };
    let end = (state..model.states.len()).take_while(belongs).last()? + 1;
    Some((whole, first..end))
}
