//! What a user should know of a model that compiles: values at the start that are not used, which are warned of too, and
//! energies that are not what they seem.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::Span;

use crate::answers::Answers;
use crate::codes;
use crate::diagnostics::{Diagnostics, error};
use crate::elaborate::{Elaborated, Ring, State, StateRate};
use crate::graph::{Element, ElementId, ElementKind, Integral, Law, Storage};
use crate::start::Start;
use crate::structure::Solved;
use crate::symbolic::substitute::symbols;
use crate::symbolic::{Expression, Operation, Pool, Symbol};

/// A value at the start is another one if it differs by more than this part of it.
const MET: f64 = 1e-9;
/// A ring is open if the gap is more than this part of its distance from the origin: initial values have a few digits.
const CLOSED: f64 = 1e-3;
/// The same for loops that are put together before the first step.
const GUESSED: f64 = 0.05;
/// Nothing counts as nearer to the origin: what is rounding.
const SMALLEST: f64 = 1e-8;
/// A moment of inertia may be larger than the sum of the others by this part of them: that of a plate, in few digits.
const PLATE: f64 = 1e-2;

/// All of them, one a line.
pub(crate) fn of(
    model: &Elaborated,
    solved: &Solved,
    answers: &Answers,
    pool: &Pool,
    diagnostics: &mut Diagnostics,
) -> Vec<String> {
    let mut notes = Vec::new();
    for (span, note, help) in unused_starts(model, solved, answers, pool) {
        let mut report = error(codes::UNUSED_START, span, note.clone());
        report.helps.extend(help);
        diagnostics.warn(report);
        notes.push(note);
    }
    for (span, note, help) in open_rings(model, pool) {
        diagnostics.warn(error(codes::OPEN_RING, span, note.clone()).help(help));
        notes.push(note);
    }
    for (span, note) in open_closures(model, answers, pool) {
        let help = "give its joints `initial` values that close it: else they are moved by least norm before the first step";
        diagnostics.warn(error(codes::OPEN_RING, span, note.clone()).help(help));
        notes.push(note);
    }
    for (span, note, help) in modulated_energies(model, pool) {
        if let Some(help) = help {
            diagnostics.warn(error(codes::MISSING_PORT, span, note.clone()).help(help));
        }
        notes.push(note);
    }
    for (span, note, help) in impossible_bodies(model, pool) {
        diagnostics.warn(error(codes::NO_BODY, span, note.clone()).help(help));
        notes.push(note);
    }
    notes.extend(approximate_energies(model));
    notes
}

/// Values given for the start to what is no state, and which it does not have there, with default parameters and without
/// inputs.
fn unused_starts(
    model: &Elaborated,
    solved: &Solved,
    answers: &Answers,
    pool: &Pool,
) -> Vec<(Span, String, Option<String>)> {
    let start = Start::of(model, pool);
    let momenta = answers.eliminated.iter().map(|(state, value)| {
        let State {
            variable,
            initial,
            span,
            ..
        } = &model.states[*state];
        (*span, variable.name.clone(), *initial, *value)
    });
    let flows = model.graph.junctions.iter().zip(&solved.scalars.common);
    let flows = flows.flat_map(|(junction, flows)| {
        let span = model.graph.origins.span(junction.origin);
        let given = junction.initial_flow.iter().zip(flows).enumerate();
        given.map(move |(component, (given, flow))| {
            let name = junction.flow(component);
            (span, name, *given, solved.solution.values[*flow])
        })
    });
    let note = |(span, name, given, met): (Span, String, Expression, Expression)| {
        // A zero has no sign here.
        let [given, value] = [given, met].map(|it| start.value(pool, it) + 0.0);
        let is_met = given == 0.0 || (given - value).abs() <= MET * given.abs();
        let place = if value.is_finite() {
            format!(" but {value:?}")
        } else {
            String::new()
        };
        let note =
            format!("`{name}` is not {given:?} at the start{place}: it follows from other states");
        (!is_met).then(|| (span, note, leading(model, &start, pool, (met, given))))
    };
    let all = momenta.chain(flows);
    let given = all.filter(|(_, _, given, _)| *given != Expression::ZERO);
    given.filter_map(note).collect()
}

/// What to type at the only state from which a value follows, so that it starts as it is `given`; of flows of coordinates at the
/// only one without a start.
fn leading(
    model: &Elaborated,
    start: &Start,
    pool: &Pool,
    (value, given): (Expression, f64),
) -> Option<String> {
    let read = symbols(pool, &[value]).into_iter();
    let states: Vec<usize> = read
        .filter_map(|it| match it {
            Symbol::State(state) => Some(state),
            _ => None,
        })
        .collect();
    let own = |state: usize| {
        let at = |own: f64| start.changed(pool, value, &BTreeMap::from([(state, own)]));
        let own = (given - at(0.0)) / (at(1.0) - at(0.0));
        // In the digits that a value at the start is compared by.
        let own: f64 = format!("{own:.11e}").parse().ok()?;
        ((at(own) - given).abs() <= MET * given.abs()).then_some(own)
    };
    let is_free_flow = |state: &usize| {
        let State { rate, initial, .. } = &model.states[*state];
        matches!(rate, StateRate::Unknown(_)) && *initial == Expression::ZERO
    };
    let mut flows = states.iter().copied().filter(is_free_flow);
    if let (Some(state), None) = (flows.next(), flows.next()) {
        let name = &model.states[state].variable.name;
        let own = own(state)?;
        return Some(format!(
            "let `{name}`, from which it follows, begin with {own:?}"
        ));
    }
    let [state] = states[..] else { return None };
    let State {
        rate: StateRate::Storage(id, _),
        is_given: false,
        ..
    } = model.states[state]
    else {
        return None;
    };
    let element = &model.graph.elements[id.0];
    let is_alone = matches!(&element.law, Law::Storage(storage) if storage.states.len() == 1);
    let own = own(state)?;
    let name = &element.name;
    (is_alone && element.instance().is_none())
        .then(|| format!("give it to `{name}`, from which it follows: `initial: {own:?}`"))
}

/// Rings of joints that are open at the start, with default parameters and without inputs: where, and the way out.
fn open_rings(model: &Elaborated, pool: &Pool) -> Vec<(Span, String, String)> {
    let start = Start::of(model, pool);
    let mut told_of = BTreeSet::new();
    let open = |ring: &Ring| {
        let value = |by: &Vec<Expression>| by.iter().map(|it| start.value(pool, *it)).collect();
        let told: [Vec<f64>; 2] = ring.told.each_ref().map(value);
        let between = match ring.is_turned {
            true => turned(&told)?,
            false => gap(&told)?,
        };
        if !told_of.insert(ring.frame.clone()) {
            return None;
        }
        let ([first, second], frame) = (&ring.components, &ring.frame);
        let note =
            format!("`{first}` and `{second}` do not meet at `{frame}` at the start: {between}");
        let help = format!(
            "give the joints of the ring `initial` values that close it, or put a `{}` in the place of one of them, which \
             is closed at the start and after each step",
            ring.cut()
        );
        Some((ring.span, note, help))
    };
    model.rings.iter().filter_map(open).collect()
}

/// Loops closed by multipliers that are open at the start by more than a guess, with default parameters and without inputs.
fn open_closures(model: &Elaborated, answers: &Answers, pool: &Pool) -> Vec<(Span, String)> {
    let start = Start::of(model, pool);
    let mut told = BTreeSet::new();
    let open = |(number, _, displacement): &(usize, usize, Expression)| {
        let closure = &model.graph.closures[*number];
        let name = match closure.instance.as_str() {
            "" => &closure.name,
            instance => instance,
        };
        let own = name.rsplit('.').next().unwrap_or(name);
        let gap = start.value(pool, *displacement).abs();
        let terms = terms(pool, *displacement);
        let far = terms.map(|term| start.value(pool, term).abs());
        let is_open = gap > GUESSED * far.fold(SMALLEST, f64::max);
        if !is_open || own.starts_with('_') || !told.insert(name.to_owned()) {
            return None;
        }
        let by = match gap < 0.1 {
            true => format!("{gap:.2e}"),
            false => format!("{gap:.3}"),
        };
        let note = format!("`{name}` is open at the start, by {by}");
        Some((model.graph.origins.span(closure.origin), note))
    };
    answers.displacements.iter().filter_map(open).collect()
}

/// The terms of a sum.
fn terms(pool: &Pool, sum: Expression) -> impl Iterator<Item = Expression> {
    let mut open = vec![sum];
    std::iter::from_fn(move || {
        loop {
            let term = open.pop()?;
            match *pool.operation(term) {
                Operation::Add(a, b) => open.extend([a, b]),
                _ => return Some(term),
            }
        }
    })
}

/// What is between two places, if they are apart.
fn gap([one, other]: &[Vec<f64>; 2]) -> Option<String> {
    let all = one.iter().chain(other);
    let far = all.fold(0.0, |far, it| it.abs().max(far));
    let gap: Vec<f64> = other.iter().zip(one).map(|(b, a)| b - a).collect();
    let is_open = gap.iter().any(|it| it.abs() > CLOSED * far);
    // Three digits of the distance, however small the machine.
    let digits = (3.0 - far.log10().floor()).clamp(0.0, 12.0) as usize;
    let gap: Vec<String> = gap.iter().map(|it| format!("{it:.digits$}")).collect();
    is_open.then(|| format!("[{}] m are between them, which stay", gap.join(", ")))
}

/// By how much axes are turned against each other, if they are.
fn turned([one, other]: &[Vec<f64>; 2]) -> Option<String> {
    let trace: f64 = one.iter().zip(other).map(|(a, b)| a * b).sum();
    let angle = (0.5 * (trace - 1.0)).clamp(-1.0, 1.0).acos();
    (angle > CLOSED).then(|| {
        format!(
            "by one its axes are turned by {angle:.3} rad against those by the other, which stays"
        )
    })
}

/// Storages whose energy changes with more than their own states; where that is a state it should have a port for it, of which
/// the way out tells.
fn modulated_energies(model: &Elaborated, pool: &Pool) -> Vec<(Span, String, Option<String>)> {
    let others = |storage: &Storage| {
        let read = symbols(pool, &[storage.energy]).into_iter();
        let is_other = |symbol: &Symbol| match symbol {
            Symbol::State(state) => !storage.states.contains(state),
            Symbol::Parameter(_) => false,
            _ => true,
        };
        read.filter(is_other).collect::<Vec<_>>()
    };
    let note = |(id, element): (usize, &Element)| {
        let Law::Storage(storage) = &element.law else {
            return None;
        };
        let others = others(storage);
        if others.is_empty() {
            return None;
        }
        let name = &element.name;
        let state = others.iter().find_map(|it| match it {
            Symbol::State(state) => Some(&model.states[*state].variable.name),
            _ => None,
        });
        let with = state.map_or("more than its own state".to_owned(), |it| format!("`{it}`"));
        let note = format!(
            "the energy of `{name}` changes with {with}: the power of that is not in the balance"
        );
        let own = element.name.rsplit('.').next().unwrap_or(name);
        let is_meant = own.starts_with('_') || model.graph.is_pseudo(ElementId(id));
        let help = state.filter(|_| !is_meant).map(|state| {
            let through = match element.kind {
                ElementKind::I => ", one through `GY { effort: 1.0 }`",
                _ => "",
            };
            format!(
                "what moves `{state}` feels no force of it: write a `C` on `1 field[{}]` with a bond to each of its ports{through}, \
                 and `energy: …` in its `q`, or call it `_{own}`",
                storage.states.len() + 1
            )
        });
        Some((model.graph.origins.span(element.origin), note, help))
    };
    let elements = model.graph.elements.iter().enumerate();
    elements.filter_map(note).collect()
}

/// Bodies of which a principal moment of inertia is more than the sum of the other two, with default parameters.
fn impossible_bodies(model: &Elaborated, pool: &Pool) -> Vec<(Span, String, String)> {
    let start = Start::of(model, pool);
    let elements = &model.graph.elements;
    let turning = elements.iter().filter_map(|it| match &it.law {
        Law::EulerJunction(momentum) => Some(symbols(pool, momentum)),
        _ => None,
    });
    let turning: Vec<_> = turning.collect();
    let note = |element: &Element| {
        let Law::Storage(storage) = &element.law else {
            return None;
        };
        let own: Vec<_> = storage.states.clone().map(Symbol::State).collect();
        if own.len() != 3 || !turning.contains(&own) {
            return None;
        }
        let flows = storage.states.clone().map(|column| {
            let momenta = storage
                .states
                .clone()
                .map(|state| (state, f64::from(state == column)));
            let momenta = momenta.collect();
            [0, 1, 2].map(|row| start.changed(pool, storage.coenergy[row], &momenta))
        });
        let flows: Vec<_> = flows.collect();
        let [a, b, c] = flows[..] else {
            return None;
        };
        if is_of_a_body([a, b, c]) {
            return None;
        }
        let note = format!(
            "no body has the inertia of `{}`: one of its principal moments is more than the sum of the other two",
            element.name
        );
        let help = "all moments are about the centre of mass and in one unit; those of a thin plate are that sum, those of \
                    other bodies less";
        Some((
            model.graph.origins.span(element.origin),
            note,
            help.to_owned(),
        ))
    };
    elements.iter().filter_map(note).collect()
}

/// Whether no principal moment is more than the sum of the others, by the inverse of the inertia.
///
/// The largest moment is at most a part of the trace where the inverse less that share of the unit matrix is positive.
fn is_of_a_body(inverse: [[f64; 3]; 3]) -> bool {
    let pairs = |[[a, b, c], [d, e, f], [g, h, i]]: [[f64; 3]; 3]| {
        [a * e - b * d, a * i - c * g, e * i - f * h]
    };
    let determinant = |matrix: [[f64; 3]; 3]| {
        let [[a, b, c], [d, e, f], [g, h, i]] = matrix;
        a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    };
    let trace = pairs(inverse).iter().sum::<f64>() / determinant(inverse);
    let least = (2.0 + PLATE) / ((1.0 + PLATE) * trace);
    let mut rest = inverse;
    (0..3).for_each(|axis| rest[axis][axis] -= least);
    let is_negative = |minor: f64| minor < 0.0;
    !is_negative(rest[0][0]) && !is_negative(pairs(rest)[0]) && !is_negative(determinant(rest))
}

/// Storages whose law has no integral in closed form.
fn approximate_energies(model: &Elaborated) -> Vec<String> {
    let note = |element: &Element| {
        let Law::Storage(storage) = &element.law else {
            return None;
        };
        let from = match storage.integral {
            Integral::Exact => return None,
            Integral::FromZero => "",
            Integral::FromStart => {
                " from its state at the start, where it is zero, as the law has no integral from the state zero;"
            }
        };
        Some(format!(
            "the energy of `{}` is a quadrature of its law at sixteen points,{from} good to rounding only where the law is \
             that smooth",
            element.name
        ))
    };
    model.graph.elements.iter().filter_map(note).collect()
}

#[cfg(test)]
mod tests {
    use super::is_of_a_body;

    #[test]
    fn moments_are_those_of_bodies_up_to_plates() {
        let diagonal = |a: f64, b: f64, c: f64| {
            [
                [1.0 / a, 0.0, 0.0],
                [0.0, 1.0 / b, 0.0],
                [0.0, 0.0, 1.0 / c],
            ]
        };
        for (a, b, c, is_body) in [
            (1.0, 2.0, 2.5, true),
            (1.0, 2.0, 3.0, true),
            (1.0, 2.0, 3.02, true),
            (1.0, 2.0, 3.05, false),
            (1e-9, 1.0, 1.0, true),
            (1e-3, 1e-3, 9e-3, false),
        ] {
            assert_eq!(is_of_a_body(diagonal(a, b, c)), is_body, "{a} {b} {c}");
            assert_eq!(is_of_a_body(diagonal(c, a, b)), is_body, "{c} {a} {b}");
        }
        // Moments 1, 2 and 4, turned about z by an angle whose sine is 0.6.
        let turned = [[0.82, 0.24, 0.0], [0.24, 0.68, 0.0], [0.0, 0.0, 0.25]];
        assert!(!is_of_a_body(turned));
    }
}
