//! What is known at a frame, and goes on from component to component.
//!
//! A component tells what holds at its port `b` by a value whose name ends so, such as `gravity_b`, and asks what holds
//! at its port `a` by a parameter such as `gravity_a`. Left out, the parameter is what another component tells of the
//! same frame. Where nobody does, its default holds if sources keep the frame at rest, as the default is that of the
//! world; otherwise it must be given.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use quote::ToTokens;
use syn::{Expr, ExprLit, Lit};

use super::Builder;
use super::expressions::Result;
use super::scope::{Entity, GRAVITY};
use super::spread::{Place, Spread, Teller};
use crate::causality::ways::hold;
use crate::codes;
use crate::diagnostics::{Diagnostic, error};
use crate::graph::{ElementKind, End, JunctionId, JunctionKind};
use crate::syntax::{ast, dump};

/// Components of a frame in space: those of its angular velocity, then those of its velocity.
pub(super) const IN_SPACE: usize = 6;
/// The same in a plane.
pub(super) const IN_PLANE: usize = 3;

/// What a translation leaves as it is.
const OF_AXES: [&str; 3] = [GRAVITY, "orientation", "angle"];

/// A port of a component in use, and where it is connected.
pub(super) struct Frame<'a> {
    pub(super) component: &'a ast::Component,
    /// Name of the port.
    port: String,
    pub(super) place: Place,
}

/// A parameter that is left out.
#[derive(Clone, Copy)]
pub(super) struct LeftOut<'a> {
    /// Number of the definition that has its default.
    pub(super) definition: usize,
    /// Scope of its component.
    pub(super) scope: usize,
    pub(super) parameter: &'a ast::Parameter,
}

/// A parameter that is left out and whose default is no good.
pub(super) struct Unknown<'a> {
    parameter: &'a ast::Parameter,
    /// Scope of its component.
    scope: usize,
    place: Place,
    /// Scope of a component that leads from its frame to one that is known.
    backwards: Option<usize>,
}

impl Frame<'_> {
    /// The parameter that asks for a quantity at this port, and the value that tells it.
    fn word(&self, quantity: &str) -> String {
        format!("{quantity}_{}", self.port)
    }

    /// The quantity that a parameter asks for at this port.
    fn asked(&self, parameter: &str) -> Option<String> {
        let quantity = parameter.strip_suffix(&self.port)?.strip_suffix('_')?;
        Some(quantity.to_owned())
    }

    fn asks(&self, quantity: &str) -> bool {
        let word = self.word(quantity);
        self.component.parameters().any(|it| it.name == word)
    }
}

impl<'a> Builder<'a> {
    /// Notes what a port of a component is connected to.
    pub(super) fn at_frame(
        &mut self,
        scope: usize,
        component: &'a ast::Component,
        port: &ast::Port,
        (junction, range): (JunctionId, Range<usize>),
    ) {
        self.frames.entry(scope).or_default().push(Frame {
            component,
            port: port.name.to_string(),
            place: (junction, range.start, range.len()),
        });
    }

    /// The rate, of one component, of a joint that was called in a scope and carries this junction.
    pub(super) fn rate_at(&self, scope: usize, junction: JunctionId) -> Option<String> {
        let carries = |frame: &Frame| {
            let last = frame.component.ports.last();
            frame.place.0 == junction && last.is_some_and(|last| last.name == frame.port)
        };
        let mut joints = self
            .frames
            .iter()
            .filter(|(_, frames)| frames.iter().any(carries));
        joints.find_map(|(inner, _)| match self.scopes[*inner].names.get("rate") {
            Some(Entity::Junction(_, range)) if range.len() == 1 => {
                let (around, instance) = self.called.get(inner)?;
                (*around == scope).then(|| format!("{}.rate", instance.name))
            }
            _ => None,
        })
    }

    /// Lets every parameter that is left out stand for what is told of its frame.
    pub(super) fn hand_on(&mut self) {
        let first = self.joined();
        for frame in self.frames.values_mut().flatten() {
            frame.place.0 = first[frame.place.0.0];
        }
        self.check_ends();
        let mut asked: BTreeMap<String, Vec<(LeftOut<'a>, Place)>> = BTreeMap::new();
        for left in &self.left_out {
            let name = left.parameter.name.to_string();
            let own = self.frames.get(&left.scope).into_iter().flatten();
            let own = own.filter_map(|it| Some((it.asked(&name)?, it.place)));
            // The name of one port may end in that of another.
            if let Some((quantity, place)) = own.min_by_key(|(quantity, _)| quantity.len()) {
                asked.entry(quantity).or_default().push((*left, place));
            }
        }
        let still = self.still(&first);
        for (quantity, asked) in asked {
            let scopes = asked.iter().map(|(left, _)| left.scope).collect();
            let held = self.held(&quantity, &still);
            let spread = Spread::new(self.tellers(&quantity, &scopes), &held);
            for (left, place) in asked {
                self.hand(left, place, &quantity, &spread);
            }
            self.note_meetings(&quantity, &spread);
        }
    }

    /// Reports components that lead from a frame or node to itself: they have two ports, or of two there both ask the same,
    /// or one tells what the other asks.
    fn check_ends(&mut self) {
        let mut found = Vec::new();
        for (scope, frames) in &self.frames {
            let pairs =
                (1..frames.len()).flat_map(|last| (0..last).map(move |first| (first, last)));
            let mut pairs = pairs.filter(|(first, last)| {
                let (one, other) = (&frames[*first], &frames[*last]);
                let joins = one.component.ports.len() == 2;
                one.place == other.place && (joins || self.concern_one_quantity(*scope, one, other))
            });
            if let Some((_, last)) = pairs.next() {
                found.push((*scope, last));
            }
        }
        for (inner, port) in found {
            let Some((scope, instance)) = self.called.get(&inner).copied() else {
                continue;
            };
            let reference = &instance.connections[port];
            let (name, frame) = (&instance.name, dump::reference(reference));
            let message = format!("`{name}` leads from `{frame}` to itself");
            let report = error(codes::TOO_MANY_BONDS, reference.span, message);
            self.tell(scope, report.help("give it two different junctions"));
            self.is_misled = true;
            // What it makes of a way of no length is no other mistake.
            let prefix = self.scopes[inner].prefix.clone();
            let inside = self.scopes.0.iter_mut();
            inside
                .filter(|it| it.prefix.starts_with(&prefix))
                .for_each(|it| it.is_broken = true);
        }
    }

    fn concern_one_quantity(&self, scope: usize, one: &Frame, other: &Frame) -> bool {
        let names = &self.scopes[scope].names;
        let asked = one.component.parameters().filter(|it| it.default.is_some());
        let mut asked = asked.flat_map(|it| {
            let name = it.name.to_string();
            [(one, other), (other, one)].map(|(here, there)| Some(there.word(&here.asked(&name)?)))
        });
        asked.any(|word| word.is_some_and(|word| names.contains_key(&word)))
    }

    /// Lets a parameter stand for what is told of its place, or notes that it must be given.
    fn hand(&mut self, left: LeftOut<'a>, place: Place, quantity: &str, spread: &Spread) {
        let told = spread.told(place);
        self.definitions[left.definition].told = told;
        // Without gravity there is none at any frame.
        let weightless = matches!(self.scopes[0].names.get(GRAVITY), Some(Entity::Value(_)));
        let matters = match quantity {
            GRAVITY => !weightless,
            _ => !spread.tellers.is_empty() || self.scopes[left.scope].library.is_some(),
        };
        // A frame that nothing holds and nobody leads to may be anywhere.
        if matters && !self.is_misled && told.is_none() && !spread.is_held(place) {
            let unknown = Unknown {
                parameter: left.parameter,
                scope: left.scope,
                place,
                backwards: spread.backwards(place),
            };
            self.unknown.insert(left.definition, unknown);
        }
    }

    /// The components that tell a quantity, given those that are not given it.
    fn tellers(&self, quantity: &str, not_given: &BTreeSet<usize>) -> Vec<Teller> {
        let mut tellers = Vec::new();
        for (&scope, frames) in &self.frames {
            let (asking, telling): (Vec<&Frame>, Vec<&Frame>) =
                frames.iter().partition(|frame| frame.asks(quantity));
            for frame in telling {
                let names = &self.scopes[scope].names;
                if let Some(Entity::Definition(definition)) = names.get(&frame.word(quantity)) {
                    tellers.push(Teller {
                        scope,
                        definition: *definition,
                        at: frame.place,
                        is_alone: frames.len() == 1,
                        asks: asking.iter().map(|frame| frame.place).collect(),
                        is_given: !not_given.contains(&scope),
                    });
                }
            }
        }
        tellers
    }

    /// The first junction of the frame that each belongs to: a bond between 1-junctions makes one frame of theirs.
    pub(super) fn joined(&self) -> Vec<JunctionId> {
        let mut first: Vec<JunctionId> = (0..self.graph.junctions.len()).map(JunctionId).collect();
        let is_whole = |id: &JunctionId, range: &Range<usize>| {
            let junction = &self.graph.junctions[id.0];
            junction.kind == JunctionKind::One && range.len() == junction.dimension
        };
        for bond in &self.graph.bonds {
            if let (End::Junction(a, of_a), End::Junction(b, of_b)) = (&bond.from, &bond.to)
                && is_whole(a, of_a)
                && is_whole(b, of_b)
            {
                let (kept, gone) = (first[a.0], first[b.0]);
                let members = first.iter_mut().filter(|own| **own == gone);
                members.for_each(|own| *own = kept);
            }
        }
        first
    }

    /// The components of junctions that sources keep at zero.
    pub(super) fn still(&self, first: &[JunctionId]) -> BTreeSet<(JunctionId, usize)> {
        let mut still = BTreeSet::new();
        for bond in &self.graph.bonds {
            if let (End::OnePort(element), End::Junction(id, range))
            | (End::Junction(id, range), End::OnePort(element)) = (&bond.from, &bond.to)
                && self.graph.elements[element.0].kind == ElementKind::Sf
                && let Some((_, element)) = self.written.get(element)
            {
                let zero = |place: usize| element.values().all(|flow| is_zero(flow, place));
                let zeros = range.clone().enumerate().filter(|(place, _)| zero(*place));
                still.extend(zeros.map(|(_, component)| (first[id.0], component)));
            }
        }
        still
    }

    /// Places where a quantity is that of the world, as sources let nothing move that changes it.
    fn held(&self, quantity: &str, still: &BTreeSet<(JunctionId, usize)>) -> BTreeSet<Place> {
        let is_held = |&(id, start, size): &Place| {
            let changing = match size {
                IN_SPACE if OF_AXES.contains(&quantity) => 3,
                IN_PLANE if OF_AXES.contains(&quantity) => 1,
                _ => size,
            };
            (start..start + changing).all(|component| still.contains(&(id, component)))
        };
        let places = self.frames.values().flatten().map(|frame| frame.place);
        places.filter(is_held).collect()
    }

    /// Reports a parameter that is left out, needed and not known.
    pub(super) fn check_known(&self, definition: usize) -> Result<()> {
        match self.unknown.get(&definition) {
            Some(unknown) => Err(Box::new(self.not_known(unknown))),
            None => Ok(()),
        }
    }

    fn not_known(&self, unknown: &Unknown) -> Diagnostic {
        let own = self.name_of(unknown.scope);
        let name = &unknown.parameter.name;
        let message = format!("`{own}` needs `{name}`, which nothing tells at its frame");
        let report = error(codes::MISSING_DEFAULT, name.span(), message);
        let joint = unknown.backwards.map(|scope| self.name_of(scope));
        let default = unknown.parameter.default.to_token_stream();
        let keep = format!("write `{name}: {default}`");
        if self.scopes[unknown.scope].library.is_none() && joint.is_none() {
            return report.help(format!("{keep} to keep its default"));
        }
        let (id, start, size) = unknown.place;
        let report = match joint {
            Some(joint) => report.help(format!(
                "exchange the frames of `{joint}`: it hands on from the first to the second"
            )),
            None => {
                let source = hold(&self.graph, id, start..start + size);
                let such = if size == IN_SPACE {
                    "Free"
                } else {
                    "PlanarFree"
                };
                report
                    .help(format!("hold the frame, if it is at rest: {source}"))
                    .help(format!(
                        "or let a joint, such as `{such}`, lead to it from a frame that is held"
                    ))
            }
        };
        // The place of a contact is none of the world's, since that does not move.
        match name == "position_at" {
            true => report,
            false => report.help(format!("or {keep} where that of the world is meant")),
        }
    }

    /// Path of the component in use with this scope.
    pub(super) fn name_of(&self, scope: usize) -> &str {
        self.scopes[scope].prefix.trim_end_matches('.')
    }
}

/// Where a vector of so many components acts on a frame of this name.
pub(super) fn part_of_frame(frame: &str, dimension: usize, size: usize) -> Option<String> {
    let half = IN_SPACE / 2;
    ((dimension, size) == (IN_SPACE, half)).then(|| {
        format!(
            "bond it to `{frame}[{half}..{IN_SPACE}]` for a force or a velocity, to `{frame}[0..{half}]` for a moment or an angular \
             velocity"
        )
    })
}

/// Whether a component of a flow is written as zero.
fn is_zero(flow: &Expr, component: usize) -> bool {
    match flow {
        Expr::Array(entries) => {
            let entry = entries.elems.get(component);
            entry.is_some_and(|entry| is_zero(entry, 0))
        }
        Expr::Lit(ExprLit { lit, .. }) => match lit {
            Lit::Float(number) => number.base10_parse().is_ok_and(|number: f64| number == 0.0),
            Lit::Int(number) => number.base10_parse().is_ok_and(|number: u64| number == 0),
            _ => false,
        },
        _ => false,
    }
}
