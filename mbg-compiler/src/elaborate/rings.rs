//! Rings of joints: components that lead to one frame from two sides.
//!
//! Without a cut, the coordinates of a ring are integrals of rates that agree, and nothing closes what their start leaves
//! open. So what each way tells of the place of the frame is compared.

use proc_macro2::Span;

use super::Builder;
use super::definitions::{Definition, Progress};
use super::frames::IN_SPACE;
use super::spread::{Place, Spread};
use crate::diagnostics::Diagnostics;
use crate::graph::{instance_of, outermost_instance};
use crate::symbolic::Expression;

/// What tells where a frame is.
const POSITION: &str = "position";

/// Two components that lead to one frame.
#[derive(Clone)]
pub struct Ring {
    /// Paths of the components in use.
    pub components: [String; 2],
    /// The frame.
    pub frame: String,
    /// Components of the velocity of the frame.
    pub dimension: usize,
    /// Where the frame is by the first, then by the second.
    pub positions: [Vec<Expression>; 2],
    /// The second component.
    pub span: Span,
}

impl Ring {
    /// The component of the library that closes it.
    pub(crate) fn cut(&self) -> &'static str {
        match self.dimension {
            IN_SPACE => "Cut",
            _ => "PlanarCut",
        }
    }
}

/// Two scopes and what they tell of one place.
pub(super) struct Meeting {
    tellers: [(usize, usize); 2],
    place: Place,
}

impl Builder<'_> {
    /// Notes where ways from places that sources hold meet.
    pub(super) fn note_meetings(&mut self, quantity: &str, spread: &Spread) {
        if quantity == POSITION {
            let meetings = spread.meetings();
            let meeting = |(place, tellers)| Meeting { tellers, place };
            self.meetings.extend(meetings.map(meeting));
        }
    }

    /// The rings, once all that is needed is known: what only they need may have no value.
    pub(super) fn rings(&mut self) -> Vec<Ring> {
        let told = std::mem::replace(self.diagnostics, Diagnostics::new());
        let signals = self.signals.clone();
        let meetings = std::mem::take(&mut self.meetings);
        let rings = meetings.iter().filter_map(|it| self.ring(it)).collect();
        self.signals = signals;
        *self.diagnostics = told;
        rings
    }

    fn ring(&mut self, meeting: &Meeting) -> Option<Ring> {
        let (id, _, size) = meeting.place;
        let [first, second] = meeting.tellers;
        let frame = self.graph.junctions[id.0].name.clone();
        // What is inside of a component leads to its port as it does itself.
        let components = [first, second].map(|(scope, _)| {
            let path = self.name_of(scope);
            let outermost = outermost_instance(path, instance_of(&frame));
            outermost.unwrap_or(path).to_owned()
        });
        if components[0] == components[1] {
            return None;
        }
        let span = self.called.get(&second.0)?.1.name.span();
        Some(Ring {
            components,
            frame,
            dimension: size,
            positions: [
                self.position(first.1, size)?,
                self.position(second.1, size)?,
            ],
            span: self.place(second.0, span),
        })
    }

    fn position(&mut self, definition: usize, size: usize) -> Option<Vec<Expression>> {
        if !self.define(definition) {
            return None;
        }
        let Definition { name, progress, .. } = &self.definitions[definition];
        let (Progress::Known(value), name) = (progress, *name) else {
            return None;
        };
        let value = value.clone();
        let dimension = if size == IN_SPACE { 3 } else { 2 };
        self.entries(&value, dimension, name).ok()
    }
}
