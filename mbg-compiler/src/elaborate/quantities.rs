//! What quantities are called in the parts of physics, and what is read for them here.

use proc_macro2::{Ident, Span};

use super::advice::text;
use super::elsewhere;
use super::expressions::{Index, Names, Step};
use super::frames::{IN_PLANE, IN_SPACE};
use super::scope::{Entity, Lookup};
use crate::diagnostics::listing;
use crate::graph::{ElementKind, JunctionId, JunctionKind};
use crate::symbolic::Pool;

/// The variables of bonds, and what they are called.
const VARIABLES: &[(&str, &[&str])] = &[
    (
        "e",
        &[
            "effort",
            "force",
            "torque",
            "moment",
            "tau",
            "voltage",
            "tension",
            "pressure",
            "temperature",
        ],
    ),
    (
        "f",
        &[
            "flow",
            "velocity",
            "speed",
            "rate",
            "angular_velocity",
            "omega",
            "w",
            "angle_rate",
            "angular_rate",
            "angular_speed",
            "current",
            "i",
            "volume_flow",
            "flow_rate",
            "heat_flow",
        ],
    ),
    (
        "q",
        &[
            "displacement",
            "position",
            "angle",
            "travel",
            "phi",
            "theta",
            "charge",
            "volume",
            "extension",
            "elongation",
            "deflection",
            "stretch",
        ],
    ),
    (
        "p",
        &[
            "momentum",
            "angular_momentum",
            "impulse",
            "flux",
            "flux_linkage",
        ],
    ),
];

/// What is called otherwise of a component in use, and what it has of that: the first that there is.
const OF_INSTANCES: &[(&[&str], &[&str])] = &[
    (
        &["friction_force", "tangential_force", "rubbing_force"],
        &["rubbing.contact.e", "rubbing.e"],
    ),
    (
        &[
            "normal_force",
            "contact_force",
            "reaction",
            "reaction_force",
            "fn",
            "n",
        ],
        &["force"],
    ),
    (&["charge"], &["capacitor.q"]),
    (&["u", "v"], &["voltage"]),
    (&["penetration", "indentation", "compression"], &["depth"]),
];

/// The same for the variables of bonds.
const BY_VARIABLE: &[(&str, &[&str])] = &[
    ("f", &["rate.f", "current"]),
    ("q", &["angle", "travel", "position_b"]),
    ("e", &["tension", "force", "effort", "voltage"]),
];

/// What an effort and a flow make.
const POWERS: [&str; 5] = ["power", "P", "loss", "losses", "heat"];

/// What components along axes are called.
const LETTERS: [&str; 3] = ["x", "y", "z"];

/// Angular velocities of frames in space, which come before their velocities.
const TURNING: [&str; 3] = ["angular_velocity", "omega", "w"];

/// The variable of a bond that has this name in some part of physics, or its own.
fn variable(word: &str) -> Option<&'static str> {
    let mut variables = VARIABLES.iter();
    let (variable, _) = variables.find(|(own, words)| *own == word || words.contains(&word))?;
    Some(variable)
}

/// The axis of a component of a velocity, and whether it is that of an angular one.
fn component_of(word: &str) -> Option<(bool, usize)> {
    let names = [
        (false, "v"),
        (false, "velocity_"),
        (true, "w"),
        (true, "omega_"),
    ];
    names.into_iter().find_map(|(turns, name)| {
        let letter = word.strip_prefix(name)?.trim_start_matches('_');
        let axis = LETTERS.iter().position(|it| *it == letter)?;
        Some((turns, axis))
    })
}

/// A product of two variables with so many components.
fn product(size: usize, owner: &str, [first, second]: [&str; 2]) -> String {
    match size {
        1 => format!("{owner}.{first} * {owner}.{second}"),
        _ => format!("transpose({owner}.{first}) * {owner}.{second}"),
    }
}

fn step(name: &str) -> Step {
    Step {
        name: Ident::new(name, Span::call_site()),
        index: None,
    }
}

/// The steps of a path as the graph names it, such as `rods[1].end`.
fn steps(path: &str) -> Option<Vec<Step>> {
    let step = |text: &str| {
        let indexed = text.strip_suffix(']').and_then(|it| it.split_once('['));
        let (name, index) = indexed.map_or((text, None), |(name, index)| (name, Some(index)));
        let index = match index {
            Some(index) => Some(Index {
                number: index.parse().ok()?,
                span: Span::call_site(),
                written: syn::parse_str(index).ok()?,
            }),
            None => None,
        };
        Some(Step {
            name: syn::parse_str(name).ok()?,
            index,
        })
    };
    path.split('.').map(step).collect()
}

impl Lookup<'_, '_> {
    /// What to read for a quantity of a junction or an element, which is found after `count` steps.
    pub(super) fn by_quantity(
        &mut self,
        pool: &mut Pool,
        path: &[Step],
        count: usize,
    ) -> Option<String> {
        let (front, rest) = path.split_at(count);
        let [Step { name, index: None }] = rest else {
            return None;
        };
        let word = name.to_string();
        let of = |variable: &str| [front, &[step(variable)][..]].concat();
        let owner = text(front);
        match word.as_str() {
            _ if POWERS.contains(&word.as_str()) => {
                let [effort, flow] = ["e", "f"].map(of);
                let size = self
                    .size(pool, &effort)
                    .filter(|_| self.has_value(pool, &flow));
                return size.map(|size| format!("write `{}`", product(size, &owner, ["e", "f"])));
            }
            "energy" => return Some(self.energy(pool, front)),
            "v" if self.leads_to_element(front) => {
                let [effort, flow] = ["e", "f"].map(|it| text(&of(it)));
                return Some(format!(
                    "write `{flow}` for a velocity, `{effort}` for a voltage"
                ));
            }
            "acceleration" | "acc" | "a" => {
                let flow = syn::parse_str(&format!("{owner}.f")).ok()?;
                return elsewhere::instead("der", &[flow]);
            }
            _ => {}
        }
        let part = self.of_frame(front, &word);
        if let Some(part) = part.or_else(|| self.along_axis(pool, front, &word)) {
            return Some(part);
        }
        let variable = self.variable_at(front, &word)?;
        let renamed = of(variable);
        match self.has_value(pool, &renamed) {
            true => Some(format!("write `{}`", text(&renamed))),
            false if variable == word => None,
            false => self.advice_on(pool, &renamed),
        }
    }

    /// The variable that a word stands for: `v` is a velocity or a voltage, whichever is common to the bonds of a junction.
    fn variable_at(&self, front: &[Step], word: &str) -> Option<&'static str> {
        if word != "v" {
            return variable(word);
        }
        match self.scopes.follow(self.scope, front) {
            Ok(Some((Entity::Junction(id, _), _))) => Some(match self.graph.junctions[id.0].kind {
                JunctionKind::One => "f",
                JunctionKind::Zero => "e",
            }),
            _ => None,
        }
    }

    fn leads_to_element(&self, front: &[Step]) -> bool {
        let found = self.scopes.follow(self.scope, front);
        matches!(found, Ok(Some((Entity::Element(_), count))) if count == front.len())
    }

    /// The component of a flow that `vx` or `omega_z` is.
    fn along_axis(&mut self, pool: &mut Pool, front: &[Step], word: &str) -> Option<String> {
        let (turns, axis) = component_of(word)?;
        let owner = text(front);
        let size = self.size(pool, &[front, &[step("f")][..]].concat())?;
        let letter = LETTERS[axis];
        // A frame has its angular velocity before its velocity.
        let of_frame = match (turns, axis) {
            (false, 0 | 1) => Some(axis + 1),
            (true, 2) => Some(0),
            _ => None,
        };
        match (size, of_frame) {
            (1, _) => Some(format!("write `{owner}.f`")),
            (IN_SPACE, _) => {
                let place = if turns { axis } else { axis + IN_SPACE / 2 };
                Some(format!("write `{owner}.f[{place}]`, in axes of the frame"))
            }
            (IN_PLANE, Some(place)) => Some(format!(
                "write `{owner}.f.{letter}`; of a frame in a plane `{owner}.f[{place}]`"
            )),
            _ => (axis < size).then(|| format!("write `{owner}.f.{letter}`")),
        }
    }

    /// The number of components of a value, if this has one.
    fn size(&mut self, pool: &mut Pool, path: &[Step]) -> Option<usize> {
        match self.value(pool, path) {
            Some(Ok(value)) => Some(value.entries(pool)?.len()),
            _ => None,
        }
    }

    fn has_value(&mut self, pool: &mut Pool, path: &[Step]) -> bool {
        matches!(self.value(pool, path), Some(Ok(_)))
    }

    /// What a storage holds; that of a model is no sum to be written.
    fn energy(&mut self, pool: &mut Pool, front: &[Step]) -> String {
        let owner = text(front);
        let all = "`System::energy` gives what all storages hold";
        let halves = [["q", "e"], ["p", "f"]].into_iter().find_map(|variables| {
            let state = [front, &[step(variables[0])][..]].concat();
            Some((self.size(pool, &state)?, variables))
        });
        match halves {
            Some((size, variables)) => format!(
                "where its law is linear write `0.5 * {}`; {all}",
                product(size, &owner, variables)
            ),
            None => all.to_owned(),
        }
    }

    /// The part of the flow of a frame in space that is meant, or where it is.
    fn of_frame(&self, front: &[Step], word: &str) -> Option<String> {
        let Ok(Some((Entity::Junction(id, range), _))) = self.scopes.follow(self.scope, front)
        else {
            return None;
        };
        let (owner, half) = (text(front), IN_SPACE / 2);
        match word {
            _ if range.len() == IN_PLANE => {
                let told = if variable(word) == Some("q") && word != "angle" {
                    "position_b"
                } else if word == "angle" || word == "orientation" {
                    "angle_b"
                } else {
                    return None;
                };
                self.led_to(*id, told)
            }
            _ if range.len() != IN_SPACE => None,
            "velocity" | "speed" | "v" => Some(format!(
                "write `{owner}.f[{half}..{IN_SPACE}]`, in axes of the frame"
            )),
            _ if TURNING.contains(&word) => Some(format!(
                "write `{owner}.f[0..{half}]`, in axes of the frame"
            )),
            _ if variable(word) == Some("q") || word == "orientation" => {
                let told = match word {
                    "orientation" => "orientation_b",
                    _ => "position_b",
                };
                self.led_to(*id, told)
            }
            _ => None,
        }
    }

    /// What tells where a frame is.
    fn led_to(&self, junction: JunctionId, told: &str) -> Option<String> {
        let joint = self.told_by(junction, told)?;
        Some(format!("what leads to it tells it: write `{joint}.{told}`"))
    }

    /// The same of the only frame of a component, such as a body.
    pub(super) fn of_its_frame(
        &mut self,
        pool: &mut Pool,
        front: &[Step],
        word: &str,
    ) -> Option<String> {
        let Ok(Some((Entity::Instance(inner), _))) = self.scopes.follow(self.scope, front) else {
            return None;
        };
        let inner = &self.scopes[*inner];
        let mut ports = inner
            .names
            .iter()
            .filter_map(|(name, entity)| match entity {
                Entity::Junction(id, _) => {
                    let junction = &self.graph.junctions[id.0].name;
                    (*junction != format!("{}{name}", inner.prefix)).then_some(junction)
                }
                _ => None,
            });
        let (Some(frame), None) = (ports.next(), ports.next()) else {
            return None;
        };
        let prefix = self.scopes[self.scope].prefix.as_str();
        let frame = steps(frame.strip_prefix(prefix)?)?;
        let part = self.of_frame(&frame, word);
        part.or_else(|| self.along_axis(pool, &frame, word))
    }

    /// The component in use that leads to a junction and has such a value.
    fn told_by(&self, junction: JunctionId, value: &str) -> Option<&str> {
        let mut names = self.scopes[self.scope].names.iter();
        let (name, _) = names.find(|(_, entity)| match entity {
            Entity::Instance(inner) => {
                let names = &self.scopes[*inner].names;
                let leads =
                    matches!(names.get("b"), Some(Entity::Junction(id, _)) if *id == junction);
                leads && names.contains_key(value)
            }
            _ => false,
        })?;
        Some(name)
    }

    /// What to read of a component in use in the place of a name that it does not have.
    pub(super) fn by_quantity_inside(
        &mut self,
        pool: &mut Pool,
        front: &[Step],
        word: &str,
    ) -> Option<String> {
        let mut of_instances = OF_INSTANCES.iter();
        let plain = word.to_lowercase();
        let named = of_instances.find(|(words, _)| words.contains(&plain.as_str()));
        let by_variable = || {
            let variable = variable(word)?;
            let mut known = BY_VARIABLE.iter();
            known
                .find(|(own, _)| *own == variable)
                .map(|(_, here)| here)
        };
        let here = named.map(|(_, here)| here).or_else(by_variable)?;
        here.iter().find_map(|path| {
            let inside = path.split('.').map(step);
            let path: Vec<Step> = front.iter().cloned().chain(inside).collect();
            let is_read = !self.is_argument(&path) && self.has_value(pool, &path);
            is_read.then(|| format!("write `{}`", text(&path)))
        })
    }

    /// Whether a path leads to what a component is given: the `force` of a joint is that of its motor alone.
    fn is_argument(&self, path: &[Step]) -> bool {
        match self.scopes.follow(self.scope, path) {
            Ok(Some((Entity::Definition(id), _))) => self.definitions[*id].parameter.is_some(),
            _ => false,
        }
    }

    /// What has a quantity whose name stands alone.
    pub(super) fn of_what(&self, word: &str) -> Option<String> {
        let variable = variable(word).filter(|variable| *variable != word)?;
        let has = |entity: &Entity| match entity {
            Entity::Junction(id, _) => match self.graph.junctions[id.0].kind {
                JunctionKind::One => variable == "f",
                JunctionKind::Zero => variable == "e",
            },
            Entity::Element(id) => match self.graph.elements[id.0].kind {
                ElementKind::C => variable == "q" || variable == "e",
                ElementKind::I => variable == "p",
                _ => variable == "e",
            },
            _ => false,
        };
        let names = self.scopes.visible(self.scope).into_iter();
        let known = names.filter(|name| self.scopes.find(self.scope, name).is_some_and(has));
        let known: Vec<String> = known.map(|name| format!("{name}.{variable}")).collect();
        (!known.is_empty()).then(|| format!("it is read at what has it: {}", listing(known)))
    }
}
