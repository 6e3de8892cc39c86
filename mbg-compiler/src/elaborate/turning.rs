//! The terms of Euler and Newton in axes that turn: what to type for an `EJS` that stands elsewhere than at an angular velocity in
//! space, and a warning of an inertia on a whole frame without them.

use proc_macro2::Ident;
use syn::Expr;

use super::Builder;
use super::frames::{IN_PLANE, IN_SPACE};
use crate::causality::ways::beside;
use crate::codes;
use crate::diagnostics::{Diagnostic, error};
use crate::graph::{BondGraph, ElementId, ElementKind, End, JunctionId};
use crate::syntax::ast::Instance;
use crate::syntax::dump;

/// What to type for an `EJS` at a junction that has not three components.
pub(super) fn elsewhere(
    graph: &BondGraph,
    element: ElementId,
    (name, momentum): (&Ident, &Expr),
) -> Option<String> {
    let (own, _) = beside(graph, element)?;
    let End::Junction(id, range) = own else {
        return None;
    };
    match range.len() {
        1 => Some(format!(
            "about one axis nothing turns with the angular velocity: remove `{name}`"
        )),
        2 => Some(in_plane(graph, Some(own), (name, momentum))),
        IN_SPACE => {
            let junction = &graph.junctions[id.0].name;
            let momentum = dump::expression(momentum);
            let terms = terms(junction, &name.to_string(), &momentum);
            Some(format!("write `{terms}`"))
        }
        _ => None,
    }
}

/// What to type for an `EJS` of a momentum in a plane, which stands at the velocity, if that has two components.
pub(super) fn in_plane(
    graph: &BondGraph,
    own: Option<&End>,
    (name, momentum): (&Ident, &Expr),
) -> String {
    let momentum = match momentum {
        Expr::Field(_) | Expr::Path(_) => dump::expression(momentum),
        _ => "p".to_owned(),
    };
    let owner = momentum.strip_suffix(".p");
    let ids = (0..graph.elements.len()).map(ElementId);
    let owner = owner.and_then(|owner| {
        ids.into_iter()
            .find(|id| graph.elements[id.0].name == owner)
    });
    if owner.is_some_and(|id| graph.elements[id.0].instance().is_some()) {
        return resting(name);
    }
    let at = own.or_else(|| Some(beside(graph, owner?)?.0));
    let velocity = at.map_or_else(|| "velocity".to_owned(), |at| graph.end_name(at));
    let rate = match at {
        Some(End::Junction(id, range)) if graph.junctions[id.0].dimension == IN_PLANE => {
            let other = if range.start == 0 { IN_PLANE - 1 } else { 0 };
            graph.end_name(&End::Junction(*id, other..other + 1))
        }
        _ => "rate".to_owned(),
    };
    format!(
        "an `EJS` turns with an angular velocity in space; in a plane, a velocity in axes of the body turns by \
         `{velocity} -> MGY {name} {{ effort: [[-{momentum}.y, {momentum}.x]] }} -> {rate};`, and one in axes of the world by nothing"
    )
}

/// What to do with an `EJS` at a frame in a plane.
fn resting(name: &Ident) -> String {
    format!(
        "a frame in a plane has its velocity in axes of the world, which do not turn: remove `{name}`"
    )
}

/// What turns the momentum of a frame in space with its axes, by the name of what has it.
fn terms(junction: &str, name: &str, momentum: &str) -> String {
    let half = IN_SPACE / 2;
    format!(
        "{junction}[0..{half}] -> EJS {name} {{ momentum: {momentum}[0..{half}] }}; \
         {junction}[{half}..{IN_SPACE}] -> MGY {name}_coupling {{ effort: skew({momentum}[{half}..{IN_SPACE}]) }} -> {junction}[0..{half}];"
    )
}

impl Builder<'_> {
    /// Warnings of inertias of the user's on all of a frame that turns freely, whose momenta nothing turns.
    pub(super) fn in_turning_axes(&self) -> Vec<Diagnostic> {
        let inertias = self.of_user(ElementKind::I).into_iter();
        let warnings = inertias.filter_map(|(id, frame, size)| {
            let turns = size == IN_SPACE && self.floats(frame) && !self.has_terms(frame);
            let (scope, element) = self.written.get(&id).filter(|_| turns)?;
            let name = &element.name;
            let message = format!(
                "`{name}` is an inertia in axes that turn, and nothing turns its momentum with them"
            );
            let report = error(codes::TURNING_AXES, name.span(), message);
            let prefix = self.scopes[*scope].prefix.as_str();
            let junction = &self.graph.junctions[frame.0].name;
            let junction = junction.strip_prefix(prefix).unwrap_or(junction);
            let terms = terms(junction, &format!("{name}_turning"), &format!("{name}.p"));
            Some(report.help(format!(
                "write `{terms}` beside it, or give the frame a `Body` or an `AddedMass` in its place"
            )))
        });
        warnings.collect()
    }

    /// Reports every `EJS` of the user's that takes the three components of a frame in a plane for an angular velocity in space.
    pub(super) fn check_turning(&mut self) {
        for (id, frame, size) in self.of_user(ElementKind::EJS) {
            let junction = &self.graph.junctions[frame.0];
            let is_whole = size == IN_PLANE && junction.dimension == IN_PLANE;
            let Some((_, element)) = self.written.get(&id) else {
                continue;
            };
            if is_whole && self.lies_in_plane(frame) {
                let name = &element.name;
                let message = format!(
                    "`{name}` turns with an angular velocity in space, and `{}` is a frame in a plane",
                    junction.name
                );
                let report = error(codes::WRONG_DIMENSION, name.span(), message);
                self.diagnostics.report(report.help(resting(name)));
            }
        }
    }

    /// Elements of a kind that no component of the library has, with the junction that each is at and how much of it.
    fn of_user(&self, kind: ElementKind) -> Vec<(ElementId, JunctionId, usize)> {
        let ids = (0..self.graph.elements.len()).map(ElementId);
        let own =
            ids.filter(|id| self.graph.elements[id.0].kind == kind && !self.is_of_library(*id));
        let at = own.filter_map(|id| match beside(&self.graph, id)?.0 {
            End::Junction(junction, range) => Some((id, *junction, range.len())),
            _ => None,
        });
        at.collect()
    }

    /// Whether a component of the library takes a junction for a frame in a plane.
    fn lies_in_plane(&self, frame: JunctionId) -> bool {
        self.is_given(frame, |instance, _| {
            instance.component.to_string().starts_with("Planar")
        })
    }

    /// Whether a joint leads to a frame and leaves it free.
    fn floats(&self, frame: JunctionId) -> bool {
        self.is_given(frame, |instance, port| {
            instance.component == "Free" && port == 1
        })
    }

    /// Whether a junction is given to such a component of the library at such a port.
    fn is_given(&self, junction: JunctionId, is_one: impl Fn(&Instance, usize) -> bool) -> bool {
        self.called.values().any(|(scope, instance)| {
            let component = self.components.get(&instance.component.to_string());
            let mut ends = instance.connections.iter().enumerate();
            component.is_some_and(|it| it.library)
                && ends.any(|(port, end)| {
                    let end = is_one(instance, port).then(|| self.end_of(*scope, end).ok());
                    let end = end.flatten().flatten();
                    matches!(end, Some((End::Junction(id, _), _)) if id == junction)
                })
        })
    }

    /// Whether something of the user's at a frame is gyroscopic.
    fn has_terms(&self, frame: JunctionId) -> bool {
        let is_at = |end: &End| matches!(end, End::Junction(id, _) if *id == frame);
        let bonds = self.graph.bonds.iter();
        let mut beside = bonds.filter_map(|bond| match (&bond.from, &bond.to) {
            (near, End::OnePort(id) | End::In(id)) if is_at(near) => Some(*id),
            (End::OnePort(id) | End::Out(id), near) if is_at(near) => Some(*id),
            _ => None,
        });
        beside.any(|id| {
            use ElementKind::{EJS, GY, MGY};
            matches!(self.graph.elements[id.0].kind, EJS | GY | MGY) && !self.is_of_library(id)
        })
    }

    /// Whether an element stands in a component of the library.
    fn is_of_library(&self, id: ElementId) -> bool {
        // What `gyroscopic` puts beside an inertia follows it.
        let written = self.written.range(..=id).next_back();
        written.is_some_and(|(_, (scope, _))| self.scopes[*scope].library.is_some())
    }
}
