//! Rings of joints: components that lead to one frame from two sides.
//!
//! Without a cut, the coordinates of a ring are integrals of rates that agree, and nothing closes what their start leaves
//! open. So what each way tells of the frame is compared: its place, and in space its axes, by which velocities are turned.

use proc_macro2::Span;

use super::Builder;
use super::definitions::{Definition, Progress};
use super::expressions::Value;
use super::frames::IN_SPACE;
use super::spread::{Place, Spread};
use crate::diagnostics::Diagnostics;
use crate::graph::{instance_of, outermost_instance};
use crate::symbolic::{Expression, Matrix};

/// What tells where a frame is.
const POSITION: &str = "position";
/// What tells how a frame in space stands.
const ORIENTATION: &str = "orientation";

/// Two components that lead to one frame.
#[derive(Clone)]
pub struct Ring {
    /// Paths of the components in use.
    pub components: [String; 2],
    /// The frame.
    pub frame: String,
    /// Components of the velocity of the frame.
    pub dimension: usize,
    /// What is told of the frame by the first, then by the second: its place, or its axes as the rows of a rotation matrix.
    pub told: [Vec<Expression>; 2],
    /// Whether that is its axes.
    pub is_turned: bool,
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

    /// What opens it.
    pub(crate) fn opened(&self) -> String {
        let (cut, [first, second]) = (self.cut(), &self.components);
        format!(
            "put a `{cut}` in the place of a joint of the ring that `{first}` and `{second}` close"
        )
    }
}

/// Two scopes and what they tell of one frame.
pub(super) struct Meeting {
    tellers: [(usize, usize); 2],
    place: Place,
    is_turned: bool,
}

impl Builder<'_> {
    /// Notes where ways from places that sources hold meet.
    pub(super) fn note_meetings(&mut self, quantity: &str, spread: &Spread) {
        if ![POSITION, ORIENTATION].contains(&quantity) {
            return;
        }
        let is_turned = quantity == ORIENTATION;
        let meeting = |(place, tellers)| Meeting {
            tellers,
            place,
            is_turned,
        };
        self.meetings.extend(spread.meetings().map(meeting));
    }

    /// The rings, once all that is needed is known: what only they need may have no value.
    pub(super) fn rings(&mut self) -> Vec<Ring> {
        let told = std::mem::replace(self.diagnostics, Diagnostics::new());
        let signals = self.signals.clone();
        let meetings = std::mem::take(&mut self.meetings);
        let rings = meetings.iter().filter_map(|it| self.ring(it));
        let mut rings: Vec<Ring> = rings.collect();
        // Of a frame whose place is open, no more is told.
        rings.sort_by_key(|ring| ring.is_turned);
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
            told: [
                self.told(first.1, (size, meeting.is_turned))?,
                self.told(second.1, (size, meeting.is_turned))?,
            ],
            is_turned: meeting.is_turned,
            span: self.place(second.0, span),
        })
    }

    fn told(
        &mut self,
        definition: usize,
        (size, is_turned): (usize, bool),
    ) -> Option<Vec<Expression>> {
        if !self.define(definition) {
            return None;
        }
        let Definition { name, progress, .. } = &self.definitions[definition];
        let (Progress::Known(value), name) = (progress, *name) else {
            return None;
        };
        let value = value.clone();
        if is_turned {
            return match value {
                Value::Matrix(product) => Some(product.to_matrix(self.pool).entries),
                // One, for axes of the world.
                Value::Scalar(_) => Some(Matrix::diagonal(&[Expression::ONE; 3]).entries),
            };
        }
        let dimension = if size == IN_SPACE { 3 } else { 2 };
        self.entries(&value, dimension, name).ok()
    }
}
