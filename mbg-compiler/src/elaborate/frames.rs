//! What is known at a frame, and goes on from component to component.
//!
//! A component tells what holds at its port `b` by a value whose name ends so, such as `gravity_b`, and asks what holds
//! at its port `a` by a parameter such as `gravity_a`. Left out, the parameter is what another component tells of the
//! same frame; where nobody does, its default holds, which is that of the world.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use quote::ToTokens;

use super::Builder;
use super::expressions::Result;
use super::scope::{Entity, GRAVITY};
use super::spread::{Place, Spread, Teller};
use crate::codes;
use crate::diagnostics::{Diagnostic, error};
use crate::graph::{ElementKind, End, JunctionId, JunctionKind};
use crate::syntax::ast;

/// Components of a frame in space: those of its angular velocity and of its velocity.
const IN_SPACE: usize = 6;

/// A port of a component in use, and where it is connected.
pub(super) struct Frame<'a> {
    component: &'a ast::Component,
    /// Name of the port.
    port: String,
    place: Place,
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
    is_in_space: bool,
    /// Scope of a component that leads from its frame to one that is known.
    backwards: Option<usize>,
}

impl<'a> Frame<'a> {
    /// The quantity that a parameter asks for at this port.
    fn asked(&self, parameter: &'a ast::Parameter) -> Option<String> {
        let name = parameter.name.to_string();
        let quantity = name.strip_suffix(&self.port)?.strip_suffix('_')?;
        Some(quantity.to_owned())
    }

    fn asks(&self, quantity: &str) -> bool {
        let mut asked = self.component.parameters();
        asked.any(|parameter| self.asked(parameter).as_deref() == Some(quantity))
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

    /// Lets every parameter that is left out stand for what is told of its frame.
    pub(super) fn hand_on(&mut self) {
        let first = self.joined();
        for frame in self.frames.values_mut().flatten() {
            frame.place.0 = first[frame.place.0.0];
        }
        let held = self.held(&first);
        let mut asked: BTreeMap<String, Vec<(LeftOut<'a>, Place)>> = BTreeMap::new();
        for left in &self.left_out {
            let mut own = self.frames.get(&left.scope).into_iter().flatten();
            let question = own.find_map(|it| Some((it.asked(left.parameter)?, it.place)));
            if let Some((quantity, place)) = question {
                asked.entry(quantity).or_default().push((*left, place));
            }
        }
        // Without gravity there is none at any frame.
        let weightless = matches!(self.scopes[0].names.get(GRAVITY), Some(Entity::Value(_)));
        asked.retain(|quantity, _| quantity != GRAVITY || !weightless);
        for (quantity, asked) in asked {
            let scopes = asked.iter().map(|(left, _)| left.scope).collect();
            let spread = Spread::new(self.tellers(&quantity, &scopes), &held);
            for (left, place) in asked {
                self.hand(left, place, &quantity, &spread);
            }
        }
    }

    /// Lets a parameter stand for what is told of its place, or notes that it must be given.
    fn hand(&mut self, left: LeftOut<'a>, place: Place, quantity: &str, spread: &Spread) {
        let LeftOut {
            definition,
            scope,
            parameter,
        } = left;
        if let Some(told) = spread.told(place) {
            if self.definitions[told].dimension == parameter.dimension {
                let name = parameter.name.to_string();
                let told = Entity::Definition(told);
                self.scopes[scope].names.insert(name, told);
            }
            return;
        }
        // A frame that nothing holds and nobody leads to may be anywhere.
        let is_told_elsewhere = !spread.tellers.is_empty() || quantity == GRAVITY;
        if is_told_elsewhere && !spread.is_held(place) {
            let unknown = Unknown {
                parameter,
                scope,
                is_in_space: place.2 == IN_SPACE,
                backwards: spread.backwards(place),
            };
            self.unknown.insert(definition, unknown);
        }
    }

    /// The components that tell a quantity, given those that are not given it.
    fn tellers(&self, quantity: &str, not_given: &BTreeSet<usize>) -> Vec<Teller> {
        let mut tellers = Vec::new();
        for (&scope, frames) in &self.frames {
            let (asking, telling): (Vec<&Frame>, Vec<&Frame>) =
                frames.iter().partition(|frame| frame.asks(quantity));
            for frame in telling {
                let told = format!("{quantity}_{}", frame.port);
                if let Some(Entity::Definition(definition)) = self.scopes[scope].names.get(&told) {
                    tellers.push(Teller {
                        scope,
                        definition: *definition,
                        at: frame.place,
                        asks: asking.iter().map(|frame| frame.place).collect(),
                        is_given: !not_given.contains(&scope),
                    });
                }
            }
        }
        tellers
    }

    /// The first junction of the frame that each belongs to: a bond between 1-junctions makes one frame of theirs.
    fn joined(&self) -> Vec<JunctionId> {
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

    /// Places that sources move in all components: their user knows how.
    fn held(&self, first: &[JunctionId]) -> BTreeSet<Place> {
        let mut moved: BTreeMap<JunctionId, usize> = BTreeMap::new();
        for bond in &self.graph.bonds {
            if let (End::OnePort(element), End::Junction(id, range))
            | (End::Junction(id, range), End::OnePort(element)) = (&bond.from, &bond.to)
                && self.graph.elements[element.0].kind == ElementKind::Sf
            {
                *moved.entry(first[id.0]).or_default() += range.len();
            }
        }
        let is_held = |(id, ..): &Place| {
            let dimension = self.graph.junctions[id.0].dimension;
            moved.get(id).is_some_and(|count| *count >= dimension)
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
        let report = report.help(match (joint, unknown.is_in_space) {
            (Some(joint), _) => {
                format!(
                    "exchange the frames of `{joint}`: it hands on from the first to the second"
                )
            }
            (None, true) => {
                "let a joint lead to it from a frame that an `Sf` holds, such as a `Free`"
                    .to_owned()
            }
            (None, false) => "let a joint lead to it from a frame that an `Sf` holds".to_owned(),
        });
        let default = unknown.parameter.default.to_token_stream();
        report.help(format!(
            "write `{name}: {default}` where that of the world is meant"
        ))
    }

    /// Path of the component in use with this scope.
    fn name_of(&self, scope: usize) -> &str {
        self.scopes[scope].prefix.trim_end_matches('.')
    }
}
