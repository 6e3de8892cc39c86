//! Components in use.

use std::ops::Range;

use proc_macro2::Ident;

use super::calls::by_ports;
use super::conditions::no_word;
use super::driven;
use super::elsewhere;
use super::frames::{IN_PLANE, IN_SPACE, LeftOut};
use super::idle::without_bonds;
use super::kinds;
use super::parts_elsewhere;
use super::scope::{Entity, Scope};
use super::tools;
use super::unused::without_effect;
use super::{Builder, beside, blame, slopes};
use crate::codes;
use crate::diagnostics::{Diagnostic, error, listing};
use crate::graph::{ElementId, End, Junction, JunctionKind, declaration};
use crate::syntax::words::{alternatives, is_misspelt};
use crate::syntax::{ast, dump, library, signals};

/// What the names of components for frames in a plane begin with.
const PLANAR: &str = "Planar";

impl<'a> Builder<'a> {
    /// Puts a component in place.
    pub(super) fn instance(&mut self, scope: usize, instance: &'a ast::Instance) {
        let components = self.components;
        let Some(component) = components.get(&instance.component.to_string()) else {
            self.unknown_component(scope, instance);
            self.is_misled = true;
            self.name(scope, &instance.name, Entity::Opaque);
            return;
        };
        let derivative = self.scopes[scope].derivative
            || instance.derivative.is_some()
            || component.derivative.is_some();
        let around = &self.scopes[scope];
        let constants = around.constants.of_instance(instance, component);
        // What a component hands on has an effect in other uses of it, perhaps.
        let own = around.constants.given.is_empty() && around.constants.chosen.is_empty();
        let is_written = around.library.is_none() && own && self.claims.is_none();
        if is_written {
            let idle = without_effect(instance, component, components, &constants);
            idle.into_iter().for_each(|it| self.diagnostics.warn(it));
        }
        let place = (component.name.to_string(), instance.name.span());
        let inner = self.scopes.add(Scope {
            prefix: format!("{}.", self.path(scope, &instance.name)),
            derivative,
            is_broken: around.is_broken,
            library: around
                .library
                .clone()
                .or(component.library.then_some(place)),
            constants,
            ..Scope::default()
        });
        self.name(scope, &instance.name, Entity::Instance(inner));
        self.called.insert(inner, (scope, instance));
        let before = self.diagnostics.calls();
        self.ports_of(scope, inner, instance, component);
        self.arguments_of(scope, inner, instance, component);
        let is_broken = self.diagnostics.calls() > before;
        self.scopes[inner].is_broken |= is_broken;
        self.is_misled |= is_broken;
        let bonds = self.graph.bonds.len();
        self.declare(inner, &component.statements);
        if is_written && self.graph.bonds.len() == bonds {
            let idle = without_bonds(instance, component);
            idle.into_iter().for_each(|it| self.diagnostics.warn(it));
        }
    }

    fn ports_of(
        &mut self,
        scope: usize,
        inner: usize,
        instance: &ast::Instance,
        component: &'a ast::Component,
    ) {
        let is_counted = instance.connections.len() == component.ports.len();
        let mut ordered = self.in_order(scope, instance, component);
        if !is_counted {
            let call = ordered
                .take()
                .or_else(|| beside::between(instance, component))
                .unwrap_or_else(|| by_ports(instance, component));
            self.tell(scope, wrong_count(instance, component).help(call));
        }
        let mut is_told = false;
        for (position, port) in component.ports.iter().enumerate() {
            let given = instance
                .connections
                .get(position)
                .and_then(|reference| self.resolve(scope, reference));
            let entity = match given {
                Some((End::Junction(id, range), size))
                    if size == port.dimension
                        && !is_half(component, &range, &self.graph.junctions[id.0])
                        && (!is_counted || port.takes(self.graph.junctions[id.0].kind)) =>
                {
                    self.at_frame(inner, component, port, (id, range.clone()));
                    Entity::Junction(id, range)
                }
                Some(given) => {
                    let reference = &instance.connections[position];
                    let mut report =
                        self.misfit(scope, (instance, component), (port, reference), given);
                    // All of them fit in another order, which is told once.
                    if let Some(call) = ordered.as_ref().filter(|_| component.ports.len() > 1) {
                        report.helps = vec![call.clone()];
                    }
                    if ordered.is_none() || !is_told {
                        self.tell(scope, report);
                    }
                    is_told = true;
                    Entity::Opaque
                }
                None => Entity::Opaque,
            };
            self.name(inner, &port.name, entity);
        }
    }

    /// What is given for a port that does not take it.
    fn misfit(
        &self,
        scope: usize,
        (instance, component): (&ast::Instance, &ast::Component),
        (port, reference): (&ast::Port, &ast::Reference),
        (end, size): (End, usize),
    ) -> Diagnostic {
        match end {
            End::OnePort(id) => self.no_junction(scope, reference, id),
            End::Junction(id, range) if is_half(component, &range, &self.graph.junctions[id.0]) => {
                half_of_frame(port, component, reference)
            }
            End::Junction(id, _) if size == port.dimension => {
                wrong_kind(port, &instance.name, reference, &self.graph.junctions[id.0])
            }
            End::Junction(id, _) if port.dimension == 1 => {
                let rate = self.rate_at(scope, id);
                wrong_size(port, reference, size).help(of_a_frame(reference, rate))
            }
            _ => {
                let report = wrong_size(port, reference, size);
                let whole = self.whole(scope, reference, port.dimension);
                match whole.or_else(|| counterpart(&component.name.to_string(), size)) {
                    Some(help) => report.help(help),
                    None => report,
                }
            }
        }
    }

    /// What to type for a part of a junction of which all has the dimension of a port.
    fn whole(&self, scope: usize, reference: &ast::Reference, dimension: usize) -> Option<String> {
        let mut whole = reference.clone();
        whole.path.last_mut()?.selection.take()?;
        match self.end_of(scope, &whole) {
            Ok(Some((End::Junction(..), size))) if size == dimension => {
                let whole = dump::reference(&whole);
                Some(format!("write `{whole}`: the port takes all of it"))
            }
            _ => None,
        }
    }

    /// An element where a junction is taken.
    fn no_junction(&self, scope: usize, reference: &ast::Reference, id: ElementId) -> Diagnostic {
        let kind = self.graph.elements[id.0].kind;
        let text = dump::reference(reference);
        let message = format!("`{text}` is an element, `{kind:?}`, and a port takes a junction");
        let report = error(codes::UNCONNECTED, reference.span, message);
        let mut bonds = self.graph.bonds.iter();
        let junction = bonds.find_map(|bond| match (&bond.from, &bond.to) {
            (End::Junction(junction, _), End::OnePort(other))
            | (End::OnePort(other), End::Junction(junction, _))
                if *other == id =>
            {
                Some(&self.graph.junctions[junction.0].name)
            }
            _ => None,
        });
        let prefix = &self.scopes[scope].prefix;
        match junction.and_then(|junction| junction.strip_prefix(prefix.as_str())) {
            Some(junction) => report.help(format!("write `{junction}`, its junction")),
            None => report,
        }
    }

    /// Declares the parameters, with the arguments or defaults as their values.
    fn arguments_of(
        &mut self,
        scope: usize,
        inner: usize,
        instance: &'a ast::Instance,
        component: &'a ast::Component,
    ) {
        let known = parameter_names(component);
        let names: Vec<&str> = known.iter().map(String::as_str).collect();
        for argument in &instance.arguments {
            if !names.iter().any(|known| argument.name == known) {
                self.unknown_argument(scope, (instance, component), argument, &names);
            }
        }
        for choice in component.choices() {
            self.check_word(scope, (instance, component), choice);
            self.name(inner, &choice.name, Entity::Choice);
        }
        for parameter in component.parameters() {
            let name = &parameter.name;
            let shape = (parameter.dimension, parameter.unit.as_ref());
            let value = match (instance.argument(name), &parameter.default) {
                (Some((name, argument)), _) => {
                    self.definition(inner, name, shape, (scope, argument))
                }
                (None, Some(default)) => {
                    self.left_out.push(LeftOut {
                        definition: self.definitions.len(),
                        scope: inner,
                        parameter,
                    });
                    self.definition(inner, name, shape, (inner, default))
                }
                (None, None) => {
                    let value = self
                        .coordinate(scope, instance)
                        .filter(|_| name == "displacement");
                    let value = value.unwrap_or_else(|| "…".to_owned());
                    self.missing_argument(scope, (instance, component), name, &value);
                    Entity::Opaque
                }
            };
            if let Entity::Definition(id) = value {
                self.definitions[id].parameter = Some(parameter);
            }
            self.name(inner, name, value);
        }
    }

    /// Reports an argument that is no parameter of the component, with what to type in its place.
    fn unknown_argument(
        &mut self,
        scope: usize,
        (instance, component): (&ast::Instance, &ast::Component),
        argument: &ast::Field,
        names: &[&str],
    ) {
        let message = format!("`{}` has no parameter `{}`", component.name, argument.name);
        let report = error(codes::UNKNOWN_FIELD, argument.name.span(), message);
        let vector = tools::vector(&argument.name, &instance.arguments, names);
        if let Some(told) = vector.or_else(|| slopes::told(instance, argument)) {
            if let Some(help) = told {
                self.tell(scope, report.help(help));
            }
            return;
        }
        let here = beside::told(instance, argument, names)
            .or_else(|| self.parameter_here(scope, (instance, component), argument, names))
            .or_else(|| tools::by_inverse(argument, names))
            .or_else(|| tools::by_ratio(instance, argument))
            .or_else(|| tools::sequence(argument, names))
            .or_else(|| tools::at_point(instance, argument));
        if let Some(help) = here {
            return self.tell(scope, report.help(help));
        }
        let longer = ending_in(&argument.name.to_string(), names);
        let report = match longer.is_empty() {
            true => report.did_you_mean(&argument.name.to_string(), names),
            false => report.help(format!("write {}", alternatives(&longer))),
        };
        let known = names.iter().map(|name| (*name).to_owned());
        let help = format!("its parameters are {}", listing(known));
        self.tell(scope, report.help(help));
    }

    /// What to type for a parameter that has another name elsewhere; a motion is none for the start.
    fn parameter_here(
        &self,
        scope: usize,
        (instance, component): (&ast::Instance, &ast::Component),
        argument: &ast::Field,
        names: &[&str],
    ) -> Option<String> {
        let here = tools::parameter(&argument.name, names)?;
        let value = argument.value.as_ref();
        let is_start = here.starts_with("initial");
        let by_rate = driven::by_rate(instance, component)
            .filter(|_| is_start && self.moves_by_itself(scope, value));
        let axis = value
            .filter(|_| here == "axis")
            .and_then(|value| blame::axis(here, value));
        let written =
            || axis.unwrap_or_else(|| format!("write `{here}: {}`", elsewhere::value_text(value)));
        Some(by_rate.unwrap_or_else(written))
    }

    /// The angle or travel of the joint whose rate an instance is given.
    fn coordinate(&self, scope: usize, instance: &ast::Instance) -> Option<String> {
        let [given] = &instance.connections[..] else {
            return None;
        };
        let text = dump::reference(given);
        let (joint, _) = text.rsplit_once('.').filter(|(_, last)| *last == "rate")?;
        let Some(Entity::Instance(inner)) = self.scopes.find(scope, joint) else {
            return None;
        };
        let (_, called) = self.called.get(inner)?;
        let travel = beside::travel(called)?;
        Some(format!("{joint}.{travel}"))
    }

    /// Reports a parameter without a value, unless a word that is not known was meant to be its name, or stands for all of them.
    fn missing_argument(
        &mut self,
        scope: usize,
        (instance, component): (&ast::Instance, &ast::Component),
        name: &Ident,
        value: &str,
    ) {
        let known = parameter_names(component);
        let known: Vec<&str> = known.iter().map(String::as_str).collect();
        let mut arguments = instance.arguments.iter().map(|argument| &argument.name);
        let name_text = name.to_string();
        let is_shortened = |found: &Ident| {
            let found = found.to_string();
            !known.contains(&found.as_str()) && !ending_in(&found, &[&name_text]).is_empty()
        };
        let is_meant = |found: &Ident| {
            let meant = [tools::parameter, tools::inverse].map(|told| told(found, &known));
            meant.contains(&Some(&name_text))
        };
        let is_ratio = |given: &ast::Field| {
            !known.iter().any(|known| given.name == known)
                && tools::by_ratio(instance, given).is_some()
        };
        if is_misspelt(&name_text, arguments.clone(), &known)
            || arguments.clone().any(is_meant)
            || name_text == "inertia" && arguments.clone().any(beside::is_moment)
            || name_text == "capacity" && arguments.clone().any(beside::is_factor_of_capacity)
            || arguments.any(is_shortened)
            || instance.arguments.iter().any(is_ratio)
        {
            return;
        }
        let message = format!("`{}` needs a value for `{name}`", instance.component);
        let report = error(codes::MISSING_DEFAULT, instance.name.span(), message);
        self.tell(scope, report.help(format!("write `{{ {name}: {value} }}`")));
    }

    /// Reports a choice that is not made, or made of a word that is not listed.
    fn check_word(
        &mut self,
        scope: usize,
        (instance, component): (&ast::Instance, &ast::Component),
        choice: &ast::Choice,
    ) {
        let name = &choice.name;
        let words: Vec<String> = choice.words.iter().map(ToString::to_string).collect();
        let Some(argument) = instance.arguments.iter().find(|it| it.name == *name) else {
            if choice.default.is_none() {
                self.missing_argument(scope, (instance, component), name, &words.join(" | "));
            }
            return;
        };
        let Some(value) = &argument.value else {
            return self.missing_argument(scope, (instance, component), name, &words.join(" | "));
        };
        let word = self.scopes[scope].constants.word(value);
        if word.is_none_or(|word| !words.contains(&word)) {
            self.tell(scope, *no_word(value, &words));
        }
    }

    fn unknown_component(&mut self, scope: usize, instance: &ast::Instance) {
        let name = &instance.component;
        let message = format!("component `{name}` is not declared");
        let components = self.components;
        let mut known: Vec<&str> = library::names().collect();
        known.extend(components.keys().map(String::as_str));
        let report = error(codes::UNKNOWN_NAME, name.span(), message);
        let end = self.first_end(scope, instance);
        let fitting = |here: &str| match end {
            Some((_, size)) => in_frames(here, size).unwrap_or_else(|| here.to_owned()),
            None => here.to_owned(),
        };
        let value = instance.name.to_string();
        let elements = kinds::as_junction(instance)
            .or_else(|| kinds::as_element(instance))
            .or_else(|| parts_elsewhere::elements(instance, end))
            .or_else(|| signals::block(&name.to_string(), &value));
        let mut report = match (beside::meant(instance, end.map(|it| it.1)), elements) {
            (Some(here), _) => {
                let here = fitting(here);
                report.help(format!("write `{here}`, as it is called here"))
            }
            (None, Some(help)) => report.help(help),
            (None, None) => report.did_you_mean(&name.to_string(), &known),
        };
        if report.helps.is_empty() {
            let alike = tools::alike(&name.to_string());
            let mut alike: Vec<String> = alike.into_iter().map(fitting).collect();
            alike.dedup();
            let page = "the page `library` of the documentation of `mbg_runtime`";
            report = report.help(match alike.is_empty() {
                true => format!("{page} lists the components that there are"),
                false => format!("the library has {}, see {page}", listing(alike)),
            });
        }
        self.tell(scope, report);
    }

    /// Kind and dimension of the first junction that an instance is given.
    fn first_end(&self, scope: usize, instance: &ast::Instance) -> Option<(JunctionKind, usize)> {
        let first = instance.connections.first()?;
        match self.end_of(scope, first) {
            Ok(Some((End::Junction(id, _), size))) => Some((self.graph.junctions[id.0].kind, size)),
            _ => None,
        }
    }
}

/// The names that end in these words, as `blocked_torsional_stiffness` does in `torsional_stiffness`.
fn ending_in<'a>(words: &str, names: &[&'a str]) -> Vec<&'a str> {
    let front = |name: &&&str| {
        let front = name.strip_suffix(words);
        front.is_some_and(|front| front.ends_with('_'))
    };
    names.iter().filter(front).copied().collect()
}

/// What a component can be given.
fn parameter_names(component: &ast::Component) -> Vec<String> {
    let parameters = component.parameters().map(|known| &known.name);
    let choices = component.choices().map(|known| &known.name);
    parameters.chain(choices).map(ToString::to_string).collect()
}

/// More or fewer junctions than ports.
fn wrong_count(instance: &ast::Instance, component: &ast::Component) -> Diagnostic {
    let ports = component.ports.iter().map(|port| match port.dimension {
        1 => port.name.to_string(),
        dimension => format!("{}[{dimension}]", port.name),
    });
    let ports = match component.ports.len() {
        0 => "no ports".to_owned(),
        1 => format!("the port {}", listing(ports)),
        _ => format!("the ports {}", listing(ports)),
    };
    let (name, found) = (&component.name, instance.connections.len());
    let noun = if found == 1 { "junction" } else { "junctions" };
    let message = format!("`{name}` has {ports}, found {found} {noun}");
    error(codes::UNCONNECTED, instance.name.span(), message)
}

/// A junction of another dimension than the port.
fn wrong_size(port: &ast::Port, reference: &ast::Reference, size: usize) -> Diagnostic {
    let (name, dimension) = (&port.name, port.dimension);
    let text = dump::reference(reference);
    let message = format!("port `{name}` has dimension {dimension}, and `{text}` has {size}");
    error(codes::WRONG_DIMENSION, reference.span, message)
}

/// Whether a component of the library for frames in a plane is given the angular velocity or the velocity of a frame in space.
fn is_half(component: &ast::Component, range: &Range<usize>, junction: &Junction) -> bool {
    let half = IN_SPACE / 2;
    component.library
        && component.name.to_string().starts_with(PLANAR)
        && junction.dimension == IN_SPACE
        && (*range == (0..half) || *range == (half..IN_SPACE))
}

/// Such a half, which has as many components as a frame in a plane.
fn half_of_frame(
    port: &ast::Port,
    component: &ast::Component,
    reference: &ast::Reference,
) -> Diagnostic {
    let text = dump::reference(reference);
    let message = format!(
        "port `{}` takes a frame in a plane, and `{text}` is one half of a frame in space",
        port.name
    );
    let report = error(codes::WRONG_DIMENSION, reference.span, message);
    match counterpart(&component.name.to_string(), IN_SPACE) {
        Some(help) => report.help(format!("{help}, and give it all of that frame")),
        None => report,
    }
}

/// What to type for a component whose frames are those of the other space.
fn counterpart(name: &str, size: usize) -> Option<String> {
    let space = if size == IN_PLANE { "a plane" } else { "space" };
    let other = in_frames(name, size)?;
    Some(format!("write `{other}`, which is for frames in {space}"))
}

/// The component of the library that is in space what another is in a plane, or the other way round.
fn in_frames(name: &str, size: usize) -> Option<String> {
    let other = match (name.strip_prefix(PLANAR), size) {
        // A joint in space that leaves free what there is in a plane.
        (Some(""), IN_PLANE) => format!("{PLANAR}Free"),
        (Some(other), IN_SPACE) => other.to_owned(),
        (None, IN_PLANE) => format!("{PLANAR}{name}"),
        _ => return None,
    };
    library::names()
        .any(|known| known == other)
        .then_some(other)
}

/// What to give a port for a shaft or a node in the place of a frame.
fn of_a_frame(reference: &ast::Reference, rate: Option<String>) -> String {
    match rate {
        Some(rate) => format!("write `{rate}`, which is the shaft of the joint"),
        None => {
            let text = dump::reference(reference);
            format!(
                "write one of its components, such as `{text}[0]`, or the rate of a joint, such as `hinge.rate`"
            )
        }
    }
}

/// A junction of the kind that the port does not take.
///
/// The component would only simulate other physics there: a shaft with a common torque, a node with a common current.
fn wrong_kind(
    port: &ast::Port,
    instance: &Ident,
    reference: &ast::Reference,
    junction: &Junction,
) -> Diagnostic {
    let (kind, common, common_here) = match junction.kind {
        JunctionKind::Zero => (JunctionKind::One, "flow", "effort"),
        JunctionKind::One => (JunctionKind::Zero, "effort", "flow"),
    };
    let text = dump::reference(reference);
    let message = format!(
        "port `{}` takes a {}-junction, whose {common} is common, and `{text}` is a {}-junction",
        port.name,
        kind.digit(),
        junction.kind.digit(),
    );
    let between = format!("{}_{instance}", port.name);
    error(codes::JUNCTION_KIND, reference.span, message)
        .help(format!("declare it as `{}`", junction.declaration(kind)))
        .help(format!(
            "if its {common_here} is common indeed, put one between: `{}; {text} -> {between};`, and give `{between}`",
            declaration(kind, &between, port.dimension),
        ))
}
