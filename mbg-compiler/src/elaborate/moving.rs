//! Warnings of geometry that moves and should not: the flow of a frame behind it knows nothing of its rate.
//!
//! Where forces alone act at such a frame that is right, as they act on the point of the body that is there at the moment,
//! and so is contact without slip. Where inertia moves with the frame, its velocity lacks a part.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::Ident;
use syn::Expr;

use super::blame::text;
use super::definitions::Progress;
use super::elsewhere::value_text;
use super::expressions::Value;
use super::frames::{Frame, IN_PLANE, IN_SPACE};
use super::model::StateRate;
use super::scope::Entity;
use super::{Builder, beside};
use crate::codes;
use crate::diagnostics::{error, listing};
use crate::graph::{Element, ElementId, ElementKind, End, JunctionId};
use crate::symbolic::substitute::symbols;
use crate::symbolic::{Expression, Rate, Symbol};
use crate::syntax::ast::Instance;
use crate::syntax::dump;

/// Parameters of the library that tell where something is fixed to a frame, and how it is turned there.
const GEOMETRY: &[&str] = &[
    "by",
    "x",
    "y",
    "centre",
    "end",
    "offset",
    "tilt",
    "zero",
    "azimuth",
    "direction",
];

/// Those of them that are angles or rotations, as is `by` of a `Turn`.
const TURNS: &[&str] = &["tilt", "zero", "azimuth", "direction"];

/// Geometry that the user has written.
struct Geometry<'a> {
    /// Scope of the component.
    inner: usize,
    instance: &'a Instance,
    name: &'a Ident,
    value: Option<&'a Expr>,
    entries: Vec<Expression>,
}

impl Geometry<'_> {
    /// Whether it leads from a point of a body to another one, where bodies may roll on each other.
    fn is_point(&self) -> bool {
        match self.instance.component.to_string().as_str() {
            "Offset" | "PlanarOffset" => true,
            "Mount" => self.name == "offset",
            _ => false,
        }
    }

    /// Whether it does nothing but lead from a frame to another one.
    fn leads(&self) -> bool {
        let component = self.instance.component.to_string();
        ["Offset", "PlanarOffset", "Turn"].contains(&component.as_str())
    }

    fn turns(&self) -> bool {
        self.instance.component == "Turn" || TURNS.iter().any(|turn| self.name == turn)
    }

    /// The axis that it turns about, as far as it is written so.
    fn axis(&self) -> &'static str {
        match self.value.map(dump::expression) {
            _ if self.name == "azimuth" => "2",
            Some(text) if text.starts_with("rot_x(") => "0",
            Some(text) if text.starts_with("rot_y(") => "1",
            Some(text) if text.starts_with("rot_z(") => "2",
            _ => "…",
        }
    }

    /// The joint that moves so, with what goes before the frames.
    fn joint(&self, size: usize) -> String {
        match (size, self.turns()) {
            (IN_SPACE, true) => format!("Revolute {{ axis: {}, initial: … }}", self.axis()),
            (IN_SPACE, false) => "Prismatic { axis: …, initial: … }".to_owned(),
            (_, true) => "PlanarRevolute { initial: … }".to_owned(),
            (_, false) => "PlanarPrismatic { direction: …, initial: … }".to_owned(),
        }
    }
}

impl<'a> Builder<'a> {
    /// Warns of geometry that moves inertia, and notes where inputs move any.
    pub(super) fn warn_of_moving(&mut self) {
        let prescribed = self.prescribed();
        let first = self.joined();
        let inert = self.inert(&first);
        for geometry in self.geometry() {
            let read = symbols(self.pool, &geometry.entries);
            let mut causes = read.into_iter();
            let Some(cause) = causes.find(|it| self.moves(&geometry, *it, &prescribed)) else {
                continue;
            };
            let span = geometry.name.span();
            let message = format!(
                "`{}` of `{}` changes with {}, and the flow of what is fixed there does not know of it",
                geometry.name,
                geometry.instance.name,
                self.cause(cause)
            );
            let mut report = error(codes::UNKNOWN_MOTION, span, message);
            report.helps = self.by_joint(&geometry, cause);
            if let Symbol::Input(input) = cause {
                self.moving_inputs.insert(input, report.clone());
            }
            if self.carries(geometry.inner, &inert) {
                self.diagnostics.warn(report);
            }
        }
    }

    /// Components of the library that the user calls, by their scopes.
    fn called_by_user(&self) -> Vec<(usize, &'a Instance)> {
        let called = self.called.iter();
        let by_user = called.filter(|(inner, (scope, _))| {
            self.scopes[**inner].library.is_some() && self.scopes[*scope].library.is_none()
        });
        by_user
            .map(|(inner, (_, instance))| (*inner, *instance))
            .collect()
    }

    /// What a component of the library hands on is told where it got it.
    fn geometry(&mut self) -> Vec<Geometry<'a>> {
        let mut found = Vec::new();
        for (inner, instance) in self.called_by_user() {
            for argument in &instance.arguments {
                let name = argument.name.to_string();
                if GEOMETRY.contains(&name.as_str()) {
                    found.push(Geometry {
                        inner,
                        instance,
                        name: &argument.name,
                        value: argument.value.as_ref(),
                        entries: self.given_entries(inner, &name),
                    });
                }
            }
        }
        found
    }

    /// What is said of components of the library that are given what moves where something that stays is wanted.
    pub(super) fn moved(&mut self) -> BTreeMap<String, (Vec<String>, String)> {
        let called = self.called_by_user().into_iter();
        let told = called.filter_map(|(inner, instance)| {
            let path = self.scopes[inner].prefix.trim_end_matches('.').to_owned();
            let in_time = self.in_time(inner, instance);
            let told = match in_time.is_empty() {
                true => self
                    .over_travel(inner, instance)
                    .or_else(|| not_there(instance))
                    .or_else(|| self.behind_what_gives_way(inner, instance))?,
                false => told_in_time(&path, &in_time),
            };
            Some((path, told))
        });
        told.collect()
    }

    /// Whether a component in use is given anything that is no number or parameter.
    pub(super) fn is_given_what_moves(&mut self, inner: usize) -> bool {
        let Some((_, instance)) = self.called.get(&inner) else {
            return true;
        };
        let names = instance.arguments.iter().map(|it| it.name.to_string());
        let names: Vec<String> = names.collect();
        names.into_iter().any(|name| {
            let given = self.given_entries(inner, &name);
            given.iter().any(|it| self.pool.rate(*it) == Rate::Varying)
        })
    }

    /// What a component is given that changes with time, but for displacements, which do, and for what is given with its rate; and
    /// what is said of it.
    fn in_time(&mut self, inner: usize, instance: &Instance) -> Vec<[String; 2]> {
        let mut found = Vec::new();
        let names = instance.arguments.iter().map(|argument| &argument.name);
        for name in names.filter(|name| *name != "displacement") {
            let name = name.to_string();
            let given = self.given_entries(inner, &name);
            let rate = format!("{name}_rate");
            let has_rate = self.scopes[inner].names.contains_key(&rate);
            let mut read = symbols(self.pool, &given).into_iter();
            if !has_rate && read.any(|it| matches!(it, Symbol::Time | Symbol::Input(_))) {
                let told = self.documentation(inner, &name);
                found.push([name, told]);
            }
        }
        found
    }

    /// What is said of a contact whose ground is another one at each place.
    fn over_travel(&mut self, inner: usize, instance: &Instance) -> Option<(Vec<String>, String)> {
        let velocity = match instance.component.to_string().as_str() {
            "Contact" => IN_SPACE / 2..IN_SPACE,
            "PlanarContact" => 1..IN_PLANE,
            _ => return None,
        };
        let grounds = ["height", "normal"].into_iter();
        let mut over = grounds.filter(|name| {
            let given = self.given_entries(inner, name);
            let mut read = symbols(self.pool, &given).into_iter();
            read.any(|it| matches!(it, Symbol::State(_)))
        });
        let (ground, name) = (over.next()?, &instance.name);
        let note = format!(
            "`{ground}` of `{name}` changes with where the body is, and the ground of a contact is one plane, at rest or, that of a \
             `{}`, on another body",
            beside::on_body(&instance.component.to_string())?
        );
        let frame = instance.connections.first().map(dump::reference)?;
        let slopes = match velocity.len() {
            2 => "[[slope, -1.0]]",
            _ => "[[slope_x, slope_y, -1.0]] * orientation_at",
        };
        let (start, end) = (velocity.start, velocity.end);
        let help = format!(
            "a ground that is no plane is a stop below the point: `1 {name}_approach; {frame}[{start}..{end}] -> MTF {name}_down \
             {{ flow: {slopes} }} -> {name}_approach; {name}: Stop {{ displacement: ground - height_at, upper: 0.0, stiffness: … }} \
             ({name}_approach);` with the height of the ground there, its slope, and the height of the point"
        );
        Some((vec![note], help))
    }

    /// What is said of a contact or a force along a line where joints that give way lead to one of its frames: they hand on positions
    /// without their deflections, as their geometry leaves these out.
    fn behind_what_gives_way(
        &self,
        inner: usize,
        instance: &Instance,
    ) -> Option<(Vec<String>, String)> {
        let component = instance.component.to_string();
        let component = component.strip_prefix("Planar").unwrap_or(&component);
        if !["Contact", "BodyContact", "LineForce"].contains(&component) {
            return None;
        }
        let frames = self.frames.get(&inner)?;
        let ways = frames.iter().map(|frame| self.giving_way(frame.place.0));
        // What leads to both moves both.
        let joints = ways.reduce(|one, other| &one ^ &other)?;
        if joints.is_empty() {
            return None;
        }
        let joints = listing(joints.into_iter().map(str::to_owned));
        let note = format!("positions behind {joints} leave deflections out, which flows have");
        let help = format!("leave `blocked: compliant` out of {joints}");
        Some((vec![note], help))
    }

    /// The compliant joints by which a frame is led to.
    fn giving_way(&self, mut frame: JunctionId) -> BTreeSet<&str> {
        let (mut joints, mut passed) = (BTreeSet::new(), BTreeSet::new());
        while passed.insert(frame) {
            let mut leading = self.frames.iter().filter_map(|(scope, frames)| {
                let [first, second] = frames.as_slice() else {
                    return None;
                };
                (second.place.0 == frame && first.component.library).then_some((scope, first))
            });
            let Some((scope, first)) = leading.next() else {
                break;
            };
            let is_compliant = |(_, instance): &(usize, &Instance)| {
                let mut arguments = instance.arguments.iter();
                arguments
                    .any(|it| it.name == "blocked" && value_text(it.value.as_ref()) == "compliant")
            };
            if self.called.get(scope).is_some_and(is_compliant) {
                joints.insert(self.name_of(*scope));
            }
            frame = first.place.0;
        }
        joints
    }

    /// What is said of a parameter of a component in use.
    fn documentation(&self, inner: usize, name: &str) -> String {
        let parameter = match self.scopes[inner].names.get(name) {
            Some(Entity::Definition(id)) => self.definitions[*id].parameter,
            _ => None,
        };
        parameter.map_or_else(String::new, |it| text(&it.documentation))
    }

    /// The values that a parameter of a component in use has, as far as they are known.
    fn given_entries(&mut self, inner: usize, name: &str) -> Vec<Expression> {
        let entity = self.scopes[inner].names.get(name);
        let Some(Entity::Definition(id)) = entity else {
            return Vec::new();
        };
        match &self.definitions[*id].progress {
            Progress::Known(Value::Scalar(value)) => vec![*value],
            Progress::Known(Value::Matrix(product)) => product.to_matrix(self.pool).entries,
            _ => Vec::new(),
        }
    }

    /// Integrals that no flow moves, by what they read.
    fn prescribed(&self) -> BTreeSet<usize> {
        let integrals = self.states.iter().enumerate();
        let mut read: BTreeMap<usize, Vec<Symbol>> = integrals
            .filter_map(|(number, state)| match state.rate {
                StateRate::Expression(rate) => Some((number, symbols(self.pool, &[rate]))),
                _ => None,
            })
            .collect();
        loop {
            let by_itself = |symbol: &Symbol| match symbol {
                Symbol::State(other) => read.contains_key(other),
                Symbol::Parameter(_) | Symbol::Input(_) | Symbol::Time => true,
                _ => false,
            };
            let moved = |(number, read): (&usize, &Vec<Symbol>)| {
                (!read.iter().all(by_itself)).then_some(*number)
            };
            let moved: Vec<usize> = read.iter().filter_map(moved).collect();
            if moved.is_empty() {
                return read.into_keys().collect();
            }
            moved.iter().for_each(|number| {
                read.remove(number);
            });
        }
    }

    /// Whether geometry that reads this moves, other than where bodies roll: that depends on how they are turned.
    fn moves(&self, geometry: &Geometry, read: Symbol, prescribed: &BTreeSet<usize>) -> bool {
        let Symbol::State(number) = read else {
            return !matches!(read, Symbol::Parameter(_));
        };
        let state = &self.states[number];
        match state.rate {
            StateRate::Expression(Expression::ZERO) => false,
            _ if !geometry.is_point() => true,
            _ => prescribed.contains(&number) || state.variable.unit == "m",
        }
    }

    /// Frames that inertia is bonded to.
    fn inert(&self, first: &[JunctionId]) -> BTreeSet<JunctionId> {
        let is_inertia = |id: &ElementId| self.graph.elements[id.0].kind == ElementKind::I;
        let bonds = self.graph.bonds.iter();
        let junctions = bonds.filter_map(|bond| match (&bond.from, &bond.to) {
            (End::Junction(id, _), End::OnePort(element))
            | (End::OnePort(element), End::Junction(id, _))
                if is_inertia(element) =>
            {
                Some(first[id.0])
            }
            _ => None,
        });
        junctions.collect()
    }

    /// Whether inertia moves with a component: its own, or that of the frames to which its second port leads.
    fn carries(&self, inner: usize, inert: &BTreeSet<JunctionId>) -> bool {
        let own = &self.scopes[inner].prefix;
        let is_own = |scope: &usize| self.scopes[*scope].prefix.starts_with(own.as_str());
        let elements = &self.graph.elements;
        let within = |it: &Element| it.kind == ElementKind::I && it.name.starts_with(own.as_str());
        let Some([_, end]) = self.frames.get(&inner).map(Vec::as_slice) else {
            return true;
        };
        let mut open = vec![end.place.0];
        let mut reached = BTreeSet::new();
        while let Some(frame) = open.pop() {
            if !reached.insert(frame) {
                continue;
            }
            let others = self.frames.iter().filter(|(scope, _)| !is_own(scope));
            let others = others.map(|(_, frames)| frames);
            let at = |frames: &&Vec<Frame>| {
                frames
                    .iter()
                    .any(|it| it.place.0 == frame && it.component.library)
            };
            open.extend(others.filter(at).flatten().map(|it| it.place.0));
        }
        elements.iter().any(within) || reached.iter().any(|frame| inert.contains(frame))
    }

    fn cause(&self, cause: Symbol) -> String {
        match cause {
            Symbol::Time => "time".to_owned(),
            Symbol::Input(input) => format!("the input `{}`", self.inputs[input].name),
            Symbol::State(state) => format!("`{}`", self.states[state].variable.name),
            _ => "what moves".to_owned(),
        }
    }

    /// What to write where geometry moves: a joint whose rate is given.
    fn by_joint(&self, geometry: &Geometry, cause: Symbol) -> Vec<String> {
        let instance = geometry.instance;
        let size = self.frames.get(&geometry.inner);
        let size = size
            .and_then(|it| it.first())
            .map_or(IN_SPACE, |it| it.place.2);
        let joint = geometry.joint(size);
        let ends: Vec<String> = instance.connections.iter().map(dump::reference).collect();
        let first = ends.first().map_or("…", String::as_str);
        let (name, place, write) = if geometry.leads() {
            let name = instance.name.to_string();
            let write = format!("`{name}: {joint} ({});`", ends.join(", "));
            (name, "in its place", write)
        } else {
            let write = format!(
                "`1 guided[{size}]; guide: {joint} ({first}, guided);`, with `guided` as the frame of `{}`",
                instance.name
            );
            ("guide".to_owned(), "before it", write)
        };
        let joint = format!("write a joint {place}, whose rate is given: {write},");
        let Symbol::Input(input) = cause else {
            return vec![format!(
                "{joint} and `Sf drive {{ flow: … }} -> {name}.rate;`"
            )];
        };
        let input = &self.inputs[input].name.replace('.', "_");
        let (motor, coordinate) = match geometry.turns() {
            true => ("torque", "angle"),
            false => ("force", "travel"),
        };
        vec![
            format!(
                "{joint} and `Sf drive {{ flow: {input}_rate }} -> {name}.rate;`, where \
                 `input {input}_acceleration; integral {input}_rate = {input}_acceleration;`"
            ),
            format!(
                "or in the place of `Sf drive` let an actuator move it, by \
                 `{motor}: … * ({input} - {name}.{coordinate}), damping: …` of the joint"
            ),
        ]
    }
}

/// What is said of parameters of a component that change with time.
fn told_in_time(component: &str, parameters: &[[String; 2]]) -> (Vec<String>, String) {
    let names = listing(parameters.iter().map(|[name, _]| name.clone()));
    let (change, stay) = match parameters.len() {
        1 => ("changes", "a value that stays"),
        _ => ("change", "values that stay"),
    };
    let rate = format!("{names} of `{component}` {change} with time, and no flow knows that rate");
    let said = parameters.iter().filter(|[_, told]| !told.is_empty());
    let said = said.map(|[name, told]| format!("`{name}`: {told}"));
    let help = format!(
        "give {names} {stay}: what moves is a junction with a flow, such as a frame behind a joint whose rate is given, \
         `Sf drive {{ flow: … }} -> joint.rate;`"
    );
    ([rate].into_iter().chain(said).collect(), help)
}

/// What is said of a contact whose point is not where its frame is.
fn not_there(instance: &Instance) -> Option<(Vec<String>, String)> {
    let position = instance
        .arguments
        .iter()
        .find(|it| it.name == "position_at")?;
    let component = instance.component.to_string();
    if !["Contact", "PlanarContact"].contains(&component.as_str()) {
        return None;
    }
    let frame = instance.connections.first().map(dump::reference)?;
    let value = value_text(position.value.as_ref());
    let note = format!("`{value}` does not move as `{frame}` does");
    let help = format!(
        "leave `position_at` out where joints lead to `{frame}` from a frame that is held: they tell it; else give the integral of \
         its velocity in axes of the world"
    );
    Some((vec![note], help))
}
