//! What a user should know of a model that compiles: values at the start that are not used, which are warned of too, and
//! energies that are not what they seem.

use std::collections::BTreeSet;

use proc_macro2::Span;

use crate::answers::Answers;
use crate::codes;
use crate::diagnostics::{Diagnostics, error};
use crate::elaborate::{Elaborated, Ring, State};
use crate::graph::{Element, Integral, Law, Storage};
use crate::start::Start;
use crate::structure::Solved;
use crate::symbolic::substitute::symbols;
use crate::symbolic::{Expression, Pool, Symbol};

/// A value at the start is another one if it differs by more than this part of it.
const MET: f64 = 1e-9;
/// A ring is open if the gap is more than this part of its distance from the origin: initial values have a few digits.
const CLOSED: f64 = 1e-3;

/// All of them, one a line.
pub(crate) fn of(
    model: &Elaborated,
    solved: &Solved,
    answers: &Answers,
    pool: &Pool,
    diagnostics: &mut Diagnostics,
) -> Vec<String> {
    let mut notes = Vec::new();
    for (span, note) in unused_starts(model, solved, answers, pool) {
        diagnostics.warn(error(codes::UNUSED_START, span, note.clone()));
        notes.push(note);
    }
    for (span, note, help) in open_rings(model, pool) {
        diagnostics.warn(error(codes::OPEN_RING, span, note.clone()).help(help));
        notes.push(note);
    }
    notes.extend(modulated_energies(model, pool));
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
) -> Vec<(Span, String)> {
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
    let note = |(span, name, given, value): (Span, String, Expression, Expression)| {
        let [given, value] = [given, value].map(|it| start.value(pool, it));
        let is_met = given == 0.0 || (given - value).abs() <= MET * given.abs();
        let place = if value.is_finite() {
            format!(" but {value:?}")
        } else {
            String::new()
        };
        let note =
            format!("`{name}` is not {given:?} at the start{place}: it follows from other states");
        (!is_met).then_some((span, note))
    };
    let all = momenta.chain(flows);
    let given = all.filter(|(_, _, given, _)| *given != Expression::ZERO);
    given.filter_map(note).collect()
}

/// Rings of joints that are open at the start, with default parameters and without inputs: where, and the way out.
fn open_rings(model: &Elaborated, pool: &Pool) -> Vec<(Span, String, String)> {
    let start = Start::of(model, pool);
    let mut told = BTreeSet::new();
    let open = |ring: &Ring| {
        let place = |by: &Vec<Expression>| by.iter().map(|it| start.value(pool, *it)).collect();
        let [one, other]: [Vec<f64>; 2] = ring.positions.each_ref().map(place);
        let far = one
            .iter()
            .chain(&other)
            .fold(0.0, |far, it| it.abs().max(far));
        let gap: Vec<f64> = other.iter().zip(&one).map(|(b, a)| b - a).collect();
        let is_open = gap.iter().any(|it| it.abs() > CLOSED * far);
        if !is_open || !told.insert(ring.frame.clone()) {
            return None;
        }
        // Three digits of the distance, however small the machine.
        let digits = (3.0 - far.log10().floor()).clamp(0.0, 12.0) as usize;
        let gap: Vec<String> = gap.iter().map(|it| format!("{it:.digits$}")).collect();
        let ([first, second], frame) = (&ring.components, &ring.frame);
        let note = format!(
            "`{first}` and `{second}` do not meet at `{frame}` at the start: [{}] m are between them, which stay",
            gap.join(", ")
        );
        let help = format!(
            "give the joints of the ring `initial` values that close it, or put a `{}` in the place of one of them, which \
             is closed at the start and after each step",
            ring.cut()
        );
        Some((ring.span, note, help))
    };
    model.rings.iter().filter_map(open).collect()
}

/// Storages whose energy changes with more than their own states.
fn modulated_energies(model: &Elaborated, pool: &Pool) -> Vec<String> {
    let is_modulated = |storage: &Storage| {
        let mut read = symbols(pool, &[storage.energy]).into_iter();
        read.any(|symbol| match symbol {
            Symbol::State(state) => !storage.states.contains(&state),
            Symbol::Parameter(_) => false,
            _ => true,
        })
    };
    let elements = model.graph.elements.iter();
    let modulated = elements.filter(|it| matches!(&it.law, Law::Storage(it) if is_modulated(it)));
    let note = |element: &Element| {
        let name = &element.name;
        format!(
            "the energy of `{name}` changes with more than its own state: the power of that is not in the balance"
        )
    };
    modulated.map(note).collect()
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
