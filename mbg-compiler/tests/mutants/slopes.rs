//! What an accepted model says of itself in several ways: its energy changes by what is supplied and dissipated, and its
//! Jacobian is the slope of its rates. Slopes are difference quotients of the interpreted program.

use mbg_compiler::compile::{Compiled, Routines};
use mbg_compiler::program::{Arguments, evaluate};

/// The widest step of a difference quotient. Of a direction that changes a state by its own size it is one.
const WIDEST: f64 = 1e-2;

/// Each step is a quarter of that before. The narrowest is 4e-11: the current of a diode changes within 1e-6 of its voltage.
const STEPS: i32 = 15;

/// The error of a quotient that is taken for the slope, of the function's size. Where laws have kinks or are steeper than the
/// narrowest step, none is as good, and nothing is said.
const RESOLVED: f64 = 1e-5;

/// How far apart two values of one thing may be, of their size: a solve of condition 1e9 loses as much.
const ROUNDING: f64 = 1e-7;

/// Rounding of differences of large terms, of the largest rate.
const CANCELLATION: f64 = 1e-9;

/// Larger states, rates and powers are not looked at.
const MODERATE: f64 = 1e8;

/// When a model is looked at.
const TIME: f64 = 0.3;

/// Deviations from the state at the start, of each state's size. Far from there diodes conduct nothing finite; just there
/// laws may have their kinks.
const DEVIATIONS: [f64; 3] = [0.0, 1e-4, 0.2];

/// A compiled model at one state.
struct Place<'a> {
    model: &'a Compiled,
    parameters: &'a [f64],
    input: &'a [f64],
    state: Vec<f64>,
}

/// A difference quotient, and how far it may be from the slope.
#[derive(Clone, Copy, Debug)]
struct Quotient {
    value: f64,
    error: f64,
}

/// What is wrong with a model, if anything.
pub(crate) fn contradiction(model: &Compiled) -> Option<String> {
    let parameters = &model.model.parameters;
    let parameters: Vec<f64> = parameters.iter().map(|it| it.default).collect();
    let input: Vec<f64> = (0..model.model.inputs.len()).map(some).collect();
    let mut place = Place {
        model,
        parameters: &parameters,
        input: &input,
        state: vec![0.0; model.states.len()],
    };
    let start = place.run(Routines::INITIAL);
    // Other states of a closed loop would leave it open.
    let deviations = if model.closed.concat().is_empty() {
        &DEVIATIONS[..]
    } else {
        &DEVIATIONS[..1]
    };
    deviations.iter().find_map(|deviation| {
        let moved = |(number, value): (usize, &f64)| {
            let deviation = if is_bound(model, number) {
                0.0
            } else {
                *deviation
            };
            value + deviation * some(number) * (1.0 + value.abs())
        };
        place.state = start.iter().enumerate().map(moved).collect();
        let found = place.contradiction()?;
        Some(format!("{found} at {:?}", place.state))
    })
}

/// A number without any symmetry.
fn some(number: usize) -> f64 {
    (1.3 * number as f64 + 0.4).sin()
}

/// Whether a state belongs to an attitude: it cannot change alone.
fn is_bound(model: &Compiled, state: usize) -> bool {
    let mut bound = model.attitudes.iter().flatten().flatten();
    bound.any(|place| *place == state)
}

fn is_moderate(values: &[f64]) -> bool {
    values.iter().all(|value| value.abs() < MODERATE)
}

fn largest(values: &[f64]) -> f64 {
    values
        .iter()
        .fold(0.0, |largest, value| largest.max(value.abs()))
}

impl Place<'_> {
    fn run(&self, routine: usize) -> Vec<f64> {
        self.run_at(routine, TIME, &self.state)
    }

    fn run_at(&self, routine: usize, time: f64, state: &[f64]) -> Vec<f64> {
        let arguments = Arguments {
            parameters: self.parameters,
            time,
            state,
            input: self.input,
        };
        evaluate(&self.model.program, routine, &arguments)
    }

    fn contradiction(&self) -> Option<String> {
        let rates = self.run(Routines::DERIVATIVE);
        if !is_moderate(&self.state) || !is_moderate(&rates) || !self.is_closed() {
            return None;
        }
        self.imbalance(&rates).or_else(|| self.wrong_entry(&rates))
    }

    /// Whether ends that are held together move together, so that what holds them does no work.
    fn is_closed(&self) -> bool {
        let [_, flows] = &self.model.closed;
        let apart = self.run(Routines::CLOSED_FLOWS);
        largest(&apart[..flows.len()]) < 1e-9
    }

    /// The change of the energy along the flow against the power.
    fn imbalance(&self, rates: &[f64]) -> Option<String> {
        // Quadratures are not exact, and what changes an energy besides its state has a power that is not counted.
        let mut notes = self.model.notes.iter();
        if notes.any(|note| note.starts_with("the energy of")) {
            return None;
        }
        let along = self.scaled(rates)?;
        let power = self.run(Routines::POWER);
        if !is_moderate(&power) {
            return None;
        }
        let factor = largest(&along) / largest(rates);
        let told = (power[0] - power[1]) * factor;
        let size = largest(&power) * factor;
        let [found] = &self.quotients(Routines::ENERGY, &along, factor)[..] else {
            return Some("there is no energy".to_owned());
        };
        let wrong = differs(
            found,
            told,
            size + CANCELLATION / ROUNDING * (1.0 + largest(rates)),
        );
        wrong.then(|| {
            let [supplied, dissipated] = [power[0], power[1]];
            let changes: Vec<f64> = found.iter().map(|it| it.value / factor).collect();
            format!("the energy changes by {changes:?}, supplied is {supplied} and dissipated {dissipated}")
        })
    }

    /// The Jacobian against the change of the rates, along the flow and along each state that can change alone.
    fn wrong_entry(&self, rates: &[f64]) -> Option<String> {
        let count = rates.len();
        let both = self.run(Routines::DERIVATIVE_AND_JACOBIAN);
        let (again, jacobian) = both.split_at(count);
        let floor = CANCELLATION / ROUNDING * (1.0 + largest(rates));
        let same = |(one, other): (&f64, &f64)| {
            (one - other).abs() <= ROUNDING * (one.abs() + other.abs() + floor)
        };
        if !again.iter().zip(rates).all(same) {
            return Some(format!(
                "rates are {rates:?}, beside the Jacobian {again:?}"
            ));
        }
        let is_free =
            |state: &usize| self.model.closed.concat().is_empty() && !is_bound(self.model, *state);
        let alone = (0..count).filter(is_free).map(|state| {
            let mut along = vec![0.0; count];
            along[state] = 1.0;
            along
        });
        let directions = alone.chain([rates.to_vec()]);
        directions
            .filter_map(|direction| self.scaled(&direction))
            .find_map(|along| {
                let found = self.quotients(Routines::DERIVATIVE, &along, 0.0);
                let told = jacobian.chunks(count).map(|row| {
                    // An entry beside the direction may be infinite.
                    let terms = row.iter().zip(&along).filter(|(_, part)| **part != 0.0);
                    terms.map(|(entry, part)| entry * part).sum::<f64>()
                });
                let mut rows = found.iter().zip(told).zip(rates);
                let wrong = rows
                    .position(|((found, told), rate)| differs(found, told, rate.abs() + floor))?;
                let row = &jacobian[wrong * count..][..count];
                let found = &found[wrong];
                Some(format!(
                    "row {wrong} of the Jacobian is {row:?}, and along {along:?} there is {found:?}"
                ))
            })
    }

    /// A direction by such a length that a step of one changes some state by its own size.
    fn scaled(&self, direction: &[f64]) -> Option<Vec<f64>> {
        let parts = direction.iter().zip(&self.state);
        let parts: Vec<f64> = parts
            .map(|(part, value)| part / (1.0 + value.abs()))
            .collect();
        let largest = largest(&parts);
        (largest > 0.0).then(|| direction.iter().map(|part| part / largest).collect())
    }

    /// Slopes of what a routine returns along a direction, in which time passes as well, each by all steps that resolve it.
    fn quotients(&self, routine: usize, along: &[f64], passing: f64) -> Vec<Vec<Quotient>> {
        let at = |step: f64| {
            let moved = self.state.iter().zip(along);
            let moved: Vec<f64> = moved.map(|(value, part)| value + step * part).collect();
            self.run_at(routine, TIME + step * passing, &moved)
        };
        let here = at(0.0);
        let size = largest(&here);
        let steps = (0..STEPS).map(|number| WIDEST * 0.25_f64.powi(number));
        let samples = steps.map(|step| (step, at(step), at(-step)));
        let samples: Vec<(f64, Vec<f64>, Vec<f64>)> = samples.collect();
        let results = here.iter().enumerate().map(|(result, here)| {
            let one = |(step, ahead, behind): &(f64, Vec<f64>, Vec<f64>)| Sample {
                step: *step,
                here: *here,
                ahead: ahead[result],
                behind: behind[result],
            };
            resolved(&samples.iter().map(one).collect::<Vec<_>>(), size)
        });
        results.collect()
    }
}

/// Values of a function at a place and a step to both sides.
struct Sample {
    step: f64,
    here: f64,
    ahead: f64,
    behind: f64,
}

impl Sample {
    fn slope(&self) -> f64 {
        (self.ahead - self.behind) / (2.0 * self.step)
    }

    /// The second difference.
    fn bend(&self) -> f64 {
        self.ahead - 2.0 * self.here + self.behind
    }
}

/// The quotients that resolve the slope, by steps that become a quarter each; values beside this one have a size.
fn resolved(samples: &[Sample], size: f64) -> Vec<Quotient> {
    let mut found = Vec::new();
    for first in 0..samples.len() {
        let [wide, narrow, _, narrower @ ..] = &samples[first..] else {
            break;
        };
        // Rounding is that of the terms that cancel inside: it shows in narrower steps, over which little else bends.
        let least = f64::EPSILON * size;
        let rounding = narrower
            .iter()
            .fold(least, |most, it| most.max(it.bend().abs()));
        // From step to step the quotient stays, but for what it leaves out, and the second difference becomes a sixteenth, but
        // for kinks.
        let value = narrow.slope();
        let kink = (narrow.bend() - wide.bend() / 16.0) / narrow.step;
        let error = (value - wide.slope()).abs() + kink.abs() + rounding / narrow.step;
        if error.is_finite() && error <= RESOLVED * (value.abs() + narrow.here.abs()) {
            found.push(Quotient { value, error });
        }
    }
    found
}

/// Whether a slope is not what is told, beside rounding of values of this size. One step that agrees is enough: over wide ones
/// a kink may not show, and over narrow ones a term that is lost in the sum with a large one.
fn differs(found: &[Quotient], told: f64, size: f64) -> bool {
    let agrees = |found: &Quotient| {
        let rounding = ROUNDING * (found.value.abs() + told.abs() + size);
        (found.value - told).abs() <= 4.0 * found.error + rounding
    };
    !found.is_empty() && !found.iter().any(agrees)
}
