//! What to write for a path that leads nowhere.

use proc_macro2::{Ident, Span};

use super::expressions::{Index, Names, Result, Step, Value};
use super::indices::component_index;
use super::scope::{Entity, Lookup};
use crate::codes;
use crate::diagnostics::{error, listing};
use crate::graph::{ElementId, ElementKind, End, JunctionId, JunctionKind};
use crate::symbolic::Pool;
use crate::syntax::words::nearest;

impl Lookup<'_, '_> {
    /// A help for a path without a value, if there is one.
    pub(super) fn advice_on(&mut self, pool: &mut Pool, path: &[Step]) -> Option<String> {
        if let Some(text) = self.with_brackets(pool, path) {
            return Some(format!("write `{text}`"));
        }
        match self.scopes.follow(self.scope, path) {
            Ok(Some((Entity::Junction(id, _), count))) => {
                let id = *id;
                let known = self.at_junction(pool, path, count, id);
                let known = known.or_else(|| self.as_integral(pool, path, count));
                known.or_else(|| self.by_quantity(pool, path, count))
            }
            Ok(Some((Entity::Element(_), count))) => {
                let known = self.behind_index(pool, path, count, true);
                let known = known.or_else(|| self.as_integral(pool, path, count));
                let known = known.or_else(|| self.by_quantity(pool, path, count));
                known.or_else(|| self.inside_element(pool, path, count))
            }
            Ok(Some((Entity::Instance(_), count))) => self.behind_index(pool, path, count, false),
            Ok(None) => {
                let in_loop = self.scopes.in_loop(self.scope, path);
                let known = in_loop.or_else(|| self.in_instance(pool, path));
                let known = known.or_else(|| self.scopes.meant_inside(self.scope, path));
                let known = known.or_else(|| self.scopes.in_component(self.scope, path));
                let known = known.or_else(|| self.of_output(path));
                match path {
                    [Step { name, index: None }] => {
                        known.or_else(|| self.of_what(&name.to_string()))
                    }
                    _ => known,
                }
            }
            _ => None,
        }
    }

    /// The displacement of what has a flow, or the momentum of what has an effort, where that is no state.
    fn as_integral(&mut self, pool: &mut Pool, path: &[Step], count: usize) -> Option<String> {
        let (front, rest) = path.split_at(count);
        let [Step { name, index: None }] = rest else {
            return None;
        };
        let rate = match name.to_string().as_str() {
            "q" => "f",
            "p" => "e",
            _ => return None,
        };
        let rate = Step {
            name: Ident::new(rate, name.span()),
            index: None,
        };
        let rate = [front, &[rate][..]].concat();
        let Some(Ok(value)) = self.value(pool, &rate) else {
            return None;
        };
        let (size, start) = match value.entries(pool)?.len() {
            1 => (String::new(), ", initial: 0.0"),
            size => (format!("[{size}]"), ""),
        };
        let owner = &front.last()?.name;
        Some(format!(
            "write `integral {name}_{owner}{size} = {}{start};`, and read `{name}_{owner}`",
            text(&rate)
        ))
    }

    /// Outputs are for the surroundings; a law reads the value behind one.
    fn of_output(&self, path: &[Step]) -> Option<String> {
        let name = path.first()?.name.to_string();
        let [declared, value] = self.scopes.output(self.scope, &name)?;
        Some(format!(
            "`{name}` is an output, which nothing in the model reads: declare its value besides, `{declared}`, or write `{value}`"
        ))
    }

    /// `hub.f[k]` for `hub.f.k` or `hub.k.f`, where `k` is a whole number.
    fn with_brackets(&mut self, pool: &mut Pool, path: &[Step]) -> Option<String> {
        let constants = &self.scopes[self.scope].constants;
        let is_number = |step: &Step| step.index.is_none() && constants.named(&step.name).is_some();
        let place = (1..path.len()).rev().find(|at| is_number(&path[*at]))?;
        let vector = [&path[..place], &path[place + 1..]].concat();
        let is_vector =
            matches!(self.value(pool, &vector), Some(Ok(Value::Matrix(it))) if it.columns() == 1);
        is_vector.then(|| format!("{}[{}]", text(&vector), path[place].name))
    }

    /// `mass.f[1]` for `mass[1].f`, of an element, and `arm.angle` for `arm[1].angle`, of an instance, which has no components.
    fn behind_index(
        &mut self,
        pool: &mut Pool,
        path: &[Step],
        count: usize,
        has_components: bool,
    ) -> Option<String> {
        let mut plain = path.to_vec();
        let index = plain[count - 1].index.take()?.number;
        let text = self.read(pool, &plain)?;
        Some(match has_components {
            true => format!("write `{text}[{index}]`"),
            false => format!("write `{text}`: an instance has no index"),
        })
    }

    /// An instance in the place of a value.
    pub(super) fn no_value_of<T>(&self, inner: usize, path: &[Step]) -> Result<T> {
        let instance = text(path);
        let message = format!("`{instance}` is an instance, which has no value of its own");
        let span = path
            .last()
            .map_or_else(Span::call_site, |step| step.name.span());
        let report = error(codes::EXPRESSION, span, message);
        let known = self.readable(inner);
        Err(Box::new(match known.is_empty() {
            true => report,
            false => report.help(format!("of `{instance}` can be read {}", listing(known))),
        }))
    }

    /// `hub.x.f`, `hub[1].f`, `hub.spring.q` or `hub.q`, of a junction that is found after `count` steps.
    fn at_junction(
        &mut self,
        pool: &mut Pool,
        path: &[Step],
        count: usize,
        junction: JunctionId,
    ) -> Option<String> {
        let (front, rest) = path.split_at(count);
        let (last, before) = front.split_last()?;
        let plain = Step {
            name: last.name.clone(),
            index: None,
        };
        let own = |variable: &Step| [before, &[plain.clone(), variable.clone()]].concat();
        match (rest, &last.index) {
            ([variable], Some(Index { number: index, .. })) => {
                let text = self.read(pool, &own(variable))?;
                Some(format!("write `{text}[{index}]`"))
            }
            ([component, variable], None) if component_index(&component.name).is_some() => {
                let text = self.read(pool, &own(variable))?;
                Some(format!("write `{text}.{}`", component.name))
            }
            ([variable], None) => self.of_elements(junction, &variable.name),
            ([_, ..], None) => {
                let text = self.read(pool, &[before, rest].concat())?;
                Some(format!(
                    "write `{text}`: an element at a junction has a name of its own"
                ))
            }
            _ => None,
        }
    }

    /// The text of a path that has a value.
    fn read(&mut self, pool: &mut Pool, path: &[Step]) -> Option<String> {
        // A last step may pick a component of what the others read.
        let (last, front) = path.split_last()?;
        let picked = component_index(&last.name).map(|_| front);
        let mut ways = [Some(path), picked].into_iter().flatten();
        let has_value = ways.any(|way| matches!(self.value(pool, way), Some(Ok(_))));
        has_value.then(|| text(path))
    }

    /// Where a variable is read that elements at a junction have.
    pub(super) fn of_elements(&self, junction: JunctionId, variable: &Ident) -> Option<String> {
        let elements = self.elements_with(junction, variable);
        let plural = match elements.len() {
            0 => return None,
            1 => "element has",
            _ => "elements have",
        };
        let texts = elements.iter().map(|it| format!("{it}.{variable}"));
        Some(format!("its {plural} one: {}", listing(texts)))
    }

    /// Elements at a junction that have a variable of this name, by their paths from here.
    fn elements_with(&self, junction: JunctionId, variable: &Ident) -> Vec<String> {
        let bonds = self.graph.bonds.iter();
        let elements = bonds.filter_map(|bond| match (&bond.from, &bond.to) {
            (End::Junction(id, _), End::OnePort(element))
            | (End::OnePort(element), End::Junction(id, _))
                if *id == junction =>
            {
                Some(*element)
            }
            _ => None,
        });
        let elements = elements.filter(|id| self.variables(*id).iter().any(|it| variable == it));
        let prefix = self.scopes[self.scope].prefix.as_str();
        let names = elements.filter_map(|id| self.graph.elements[id.0].name.strip_prefix(prefix));
        names.map(str::to_owned).collect()
    }

    fn variables(&self, element: ElementId) -> &'static [&'static str] {
        use ElementKind::{C, EJS, GY, I, MGY, MTF, R, Se, Sf, TF};
        match self.graph.elements[element.0].kind {
            I => &["p", "e", "f"],
            C => &["q", "e", "f"],
            R | Se | Sf | EJS => &["e", "f"],
            TF | MTF | GY | MGY => &[],
        }
    }

    /// `pad.rubbing.e` for `pad.rubbing.contact.e`, where `rubbing` is an element.
    fn inside_element(&mut self, pool: &mut Pool, path: &[Step], count: usize) -> Option<String> {
        let (front, [_, variable]) = path.split_at(count) else {
            return None;
        };
        let own = [front, std::slice::from_ref(variable)].concat();
        let text = self.read(pool, &own)?;
        Some(format!("write `{text}`: an element has nothing inside"))
    }

    /// What can be read of the instance in which the path ends.
    fn in_instance(&mut self, pool: &mut Pool, path: &[Step]) -> Option<String> {
        let (inner, count) = (1..path.len()).rev().find_map(|count| {
            match self.scopes.follow(self.scope, &path[..count]) {
                Ok(Some((Entity::Instance(inner), found))) if found == count => {
                    Some((*inner, count))
                }
                _ => None,
            }
        })?;
        let (front, name) = (text(&path[..count]), path[count].name.to_string());
        let known = self.readable(inner);
        let names: Vec<&str> = known.iter().map(String::as_str).collect();
        if let Some(quantity) = self.by_quantity_inside(pool, &path[..count], &name) {
            return Some(quantity);
        }
        if let Some(near) = nearest(&name, &names) {
            return Some(format!("did you mean `{front}.{near}`?"));
        }
        if let Some(frame) = self.of_its_frame(pool, &path[..count], &name) {
            return Some(frame);
        }
        (!known.is_empty()).then(|| format!("of `{front}` can be read {}", listing(known)))
    }

    /// What has a value in an instance: named values, variables of junctions, those of elements.
    fn readable(&self, scope: usize) -> Vec<String> {
        let within = &self.scopes[scope];
        let (mut values, mut junctions, mut elements) = (Vec::new(), Vec::new(), Vec::new());
        for (name, entity) in &within.names {
            match entity {
                // A port is a junction of the caller's, who knows it, as are the arguments.
                Entity::Junction(id, _) => {
                    let junction = &self.graph.junctions[id.0];
                    if junction.name == format!("{}{name}", within.prefix) {
                        junctions.push(match junction.kind {
                            JunctionKind::One => format!("{name}.f"),
                            JunctionKind::Zero => format!("{name}.e"),
                        });
                    }
                }
                Entity::Element(id) => {
                    let first = self.variables(*id).first();
                    elements.extend(first.map(|variable| format!("{name}.{variable}")));
                }
                Entity::Definition(_) if within.constants.given.contains_key(name) => {}
                Entity::Value(_)
                | Entity::Definition(_)
                | Entity::States(_)
                | Entity::Rotation(_) => values.push(name.clone()),
                _ => {}
            }
        }
        [values, junctions, elements].concat()
    }
}

/// `links[2].spring.q`.
pub(super) fn text(path: &[Step]) -> String {
    let steps = path.iter().map(|step| match &step.index {
        Some(index) => format!("{}[{}]", step.name, index.number),
        None => step.name.to_string(),
    });
    steps.collect::<Vec<_>>().join(".")
}
