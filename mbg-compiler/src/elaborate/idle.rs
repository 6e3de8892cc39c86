//! Warnings of what changes nothing in the model at hand: components without an element, bodies and loads on what stands
//! still, gravity without weight, grounds above what falls.

use std::collections::BTreeSet;

use syn::Expr;

use super::Builder;
use super::definitions::{Definition, Progress};
use super::elsewhere::number;
use super::model::{Place, Quantity};
use super::scope::{Entity, GRAVITY};
use crate::codes;
use crate::diagnostics::{Diagnostic, error};
use crate::graph::{ElementKind, JunctionId, JunctionKind, instance_of};
use crate::syntax::ast::{ChainNode, Component, Instance, Statement};
use crate::syntax::dump;
use crate::syntax::words::{alternatives, is_two_port};

/// A warning for a component that came without a bond, all of which stand in its `if`s.
pub(super) fn without_bonds(instance: &Instance, component: &Component) -> Option<Diagnostic> {
    let conditionals = component.statements.iter().filter_map(|it| match it {
        Statement::Conditional(conditional) => Some(conditional),
        _ => None,
    });
    let conditions = conditionals.flat_map(|it| &it.branches);
    let conditions = conditions.filter_map(|it| it.condition.as_ref());
    let conditions: Vec<String> = conditions.map(dump::expression).collect();
    if conditions.is_empty() {
        return None;
    }
    let conditions: Vec<&str> = conditions.iter().map(String::as_str).collect();
    let message = format!("`{}` changes nothing", instance.name);
    let report = error(codes::NO_EFFECT, instance.name.span(), message);
    Some(report.help(format!("it counts where {}", alternatives(&conditions))))
}

impl Builder<'_> {
    /// Warns of all but [`without_bonds`], once everything is read that has an effect.
    pub(super) fn warn_of_idle(&mut self) {
        let mut warnings: Vec<Diagnostic> = self.weightless().into_iter().collect();
        warnings.extend(self.grounds_above());
        warnings.extend(self.in_turning_axes());
        let mut still = self.held_frames();
        self.carry_stillness(&mut still);
        for (inner, frames) in &self.frames {
            let [frame] = &frames[..] else { continue };
            // A component of the user's may be used on what moves, too.
            if let Some((scope, instance)) = self.called.get(inner)
                && instance_of(&self.path(*scope, &instance.name)).is_none()
                && still.contains(&frame.place.0)
                && self.is_passive(frame.component)
            {
                let at = dump::reference(&instance.connections[0]);
                let name = &instance.name;
                let message = format!("`{name}` changes nothing: `{at}` does not move");
                let report = error(codes::NO_EFFECT, name.span(), message);
                warnings.push(report.help("remove it, or give it a frame that moves"));
            }
        }
        warnings
            .into_iter()
            .for_each(|it| self.diagnostics.warn(it));
    }

    /// The gravity of the scene.
    fn free_fall(&self) -> Option<&Definition<'_>> {
        match self.scopes[0].names.get(GRAVITY) {
            Some(Entity::Definition(id)) => Some(&self.definitions[*id]),
            _ => None,
        }
    }

    /// Warnings of grounds without a normal where the last axis points down: they are above, and push down what falls.
    fn grounds_above(&self) -> Vec<Diagnostic> {
        let Some(Expr::Array(gravity)) = self.free_fall().map(|it| it.value) else {
            return Vec::new();
        };
        if gravity.elems.last().and_then(number).unwrap_or(0.0) <= 0.0 {
            return Vec::new();
        }
        let grounds = self.called.values().filter_map(|(_, instance)| {
            let component = instance.component.to_string();
            let normal = match component.as_str() {
                "Contact" => "[0.0, 0.0, -1.0]",
                "PlanarContact" => "[0.0, -1.0]",
                _ => return None,
            };
            let is_given = instance.arguments.iter().any(|it| it.name == "normal");
            let is_library = (self.components.get(&component)).is_some_and(|it| it.library);
            (is_library && !is_given).then_some((instance, normal))
        });
        let warnings = grounds.map(|(Instance { name, .. }, normal)| {
            let message =
                format!("`gravity` points away from the ground of `{name}`, which is above it");
            let report = error(codes::GROUND_ABOVE, name.span(), message);
            report.help(format!(
                "where the last axis points down write `normal: {normal}`"
            ))
        });
        warnings.collect()
    }

    /// A warning where nothing has read gravity.
    fn weightless(&self) -> Option<Diagnostic> {
        let gravity = self.free_fall()?;
        if !matches!(gravity.progress, Progress::Unread) {
            return None;
        }
        // What weighs may be given a gravity of its own.
        let weighs = self.definitions.iter().any(|it| {
            let of_frame = it.name.to_string().starts_with(GRAVITY) && it.parameter.is_some();
            of_frame && !matches!(it.progress, Progress::Unread)
        });
        let (reason, help) = match weighs {
            true => ("what has weight is given another", "remove it"),
            false => (
                "the model has no weight",
                "remove it, or give a frame a body: `body: Body { mass: …, inertia: … } (arm);`",
            ),
        };
        let message = format!("`gravity` changes nothing: {reason}");
        let report = error(codes::NO_EFFECT, gravity.name.span(), message);
        Some(report.help(help))
    }

    /// The 1-junctions that sources hold still as a whole, and at which nobody asks for an effort.
    fn held_frames(&self) -> BTreeSet<JunctionId> {
        let still = self.still(&self.joined());
        let asked = self
            .signals
            .list()
            .iter()
            .any(|(quantity, place, _)| match place {
                Place::Port(id) => {
                    *quantity == Quantity::Effort
                        && self.graph.elements[id.0].kind == ElementKind::Sf
                }
                Place::Junction(_) => false,
            });
        let junctions = self.graph.junctions.iter().enumerate();
        let held = junctions.filter(|(id, junction)| {
            let mut components = 0..junction.dimension;
            junction.kind == JunctionKind::One
                && components.all(|component| still.contains(&(JunctionId(*id), component)))
        });
        let held = held.map(|(id, _)| JunctionId(id));
        held.filter(|_| !asked).collect()
    }

    /// Adds the frames that stand at a fixed place of one that does not move.
    fn carry_stillness(&mut self, still: &mut BTreeSet<JunctionId>) {
        let pairs = self.frames.iter().filter_map(|(inner, frames)| {
            let [a, b] = &frames[..] else { return None };
            let is_rigid = self.is_made_of(a.component, &is_two_port);
            is_rigid.then_some((*inner, a.place.0, b.place.0))
        });
        let pairs: Vec<_> = pairs.collect();
        let fixed = pairs
            .into_iter()
            .filter(|(inner, ..)| !self.is_given_what_moves(*inner));
        let fixed: Vec<_> = fixed.collect();
        loop {
            let known = still.len();
            for (_, a, b) in &fixed {
                if still.contains(a) || still.contains(b) {
                    still.extend([*a, *b]);
                }
            }
            if still.len() == known {
                return;
            }
        }
    }

    /// Whether a component of the library has elements alone, none of which moves by itself.
    fn is_passive(&self, component: &Component) -> bool {
        self.is_made_of(component, &|_| true)
    }

    /// Whether a component of the library has such elements alone, also in those that it is made of, and no state besides.
    fn is_made_of(&self, component: &Component, element: &dyn Fn(ElementKind) -> bool) -> bool {
        let mut open: Vec<&Statement> = component.statements.iter().collect();
        while let Some(statement) = open.pop() {
            let is_one = match statement {
                // What is closed is held in part alone.
                Statement::Integral(_) | Statement::Attitude(_) | Statement::Closure(_) => false,
                Statement::Instance(it) => {
                    let inner = self.components.get(&it.component.to_string());
                    inner.is_some_and(|inner| self.is_made_of(inner, element))
                }
                Statement::Junction(it) => {
                    !it.coordinate && it.elements.iter().all(|it| element(it.kind))
                }
                Statement::Chain(chain) => chain.nodes.iter().all(|node| match node {
                    ChainNode::Element(it) => element(it.kind),
                    ChainNode::Reference(_) => true,
                }),
                _ => true,
            };
            if !is_one {
                return false;
            }
            open.extend(statement.inside());
        }
        component.library
    }
}
