//! Motions that are given where a value for the start or one that stays is wanted, and what to type for them.

use syn::Expr;

use super::mentions::mentioned;
use super::scope::Entity;
use super::{Builder, elsewhere};
use crate::syntax::ast::{Component, Field, Instance, Statement};

/// The junction of joints whose flow is the rate of what they are given for the start.
const RATE: &str = "rate";

/// What pushes at that junction.
const MOTORS: [&str; 2] = ["torque", "force"];

impl Builder<'_> {
    /// Whether a value that is written in a scope changes by itself.
    pub(super) fn moves_by_itself(&self, scope: usize, value: Option<&Expr>) -> bool {
        let paths = value.map(mentioned).unwrap_or_default();
        paths.iter().any(|path| {
            let name = path[0].name.to_string();
            let found = self.scopes.find(scope, &name);
            name == "t" || matches!(found, Some(Entity::Input(_)))
        })
    }
}

/// What to type where the value of a joint at the start is given a motion.
pub(super) fn by_rate(instance: &Instance, component: &Component) -> Option<String> {
    let has_rate = component
        .statements
        .iter()
        .any(|statement| match statement {
            Statement::Junction(junction) => junction.name == RATE && junction.dimension == 1,
            _ => false,
        });
    has_rate.then(|| {
        format!(
            "a motion is given by its rate: in its place write `Sf drive {{ flow: … }} -> {}.{RATE};`",
            instance.name
        )
    })
}

/// What to type where the spring of a joint is at rest at a place that moves: its motor pushes as much.
pub(super) fn by_motor(instance: &Instance, component: &Component, rest: &Field) -> Option<String> {
    let mut parameters = component.parameters();
    let motor = parameters.find(|it| MOTORS.iter().any(|motor| it.name == motor))?;
    let given = |word: &str| {
        let mut given = instance.arguments.iter().filter(|it| it.name == word);
        given.find_map(|it| it.value.as_ref())
    };
    let (stiffness, rest) = (given("stiffness")?, rest.value.as_ref()?);
    if given(&motor.name.to_string()).is_some() {
        return None;
    }
    let pushes = elsewhere::product(stiffness, rest);
    Some(format!(
        "what moves the rest of a spring pushes by its stiffness: in its place write `{}: {pushes}`",
        motor.name
    ))
}
