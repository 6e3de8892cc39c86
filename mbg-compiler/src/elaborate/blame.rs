//! Mistakes inside components of the library, which the user does not see, told at the value of the user's behind them.

use std::collections::BTreeSet;
use std::f64::consts::PI;
use std::ptr;

use proc_macro2::Span;
use quote::ToTokens;
use syn::spanned::Spanned;
use syn::{Attribute, Expr, ExprLit, Lit, Meta, MetaNameValue, UnOp};

use super::Builder;
use super::constants::without_point;
use super::definitions::{Definition, Progress};
use super::driven;
use super::elsewhere;
use super::expressions::Value;
use super::indices::component_index;
use super::mentions::mentioned;
use super::scope::Entity;
use crate::codes;
use crate::diagnostics::{Code, Diagnostic};
use crate::symbolic::Rate;
use crate::syntax::{ast, dump};

/// Mistakes that a value of the wrong kind makes.
const OF_VALUES: [Code; 5] = [
    codes::WRONG_DIMENSION,
    codes::EXPRESSION,
    codes::NOT_FINITE,
    codes::WHOLE_NUMBER,
    codes::NO_ROTATION,
];

impl Builder<'_> {
    /// Reports a mistake that was made in reading expressions.
    pub(super) fn tell_of(&mut self, scope: usize, report: Diagnostic, expressions: &[&Expr]) {
        // What an instance makes of its values without its junctions or arguments is no mistake of theirs.
        if self.scopes[scope].is_broken {
            return;
        }
        let inside = self.scopes[scope].library.clone();
        let inside = inside.filter(|_| OF_VALUES.contains(&report.code));
        let culprit = inside.and_then(|(component, _)| {
            let mut parts = report.about.iter();
            let culprit = parts.find_map(|part| self.culprit(scope, report.code, &[part]));
            let culprit = culprit.or_else(|| self.culprit(scope, report.code, expressions))?;
            Some((culprit, component))
        });
        let Some((culprit, component)) = culprit else {
            return self.tell(scope, report);
        };
        // One mistake shows in many places of a component.
        if matches!(self.definitions[culprit].progress, Progress::Failed) {
            return;
        }
        self.definitions[culprit].progress = Progress::Failed;
        let report = self.unfit(culprit, &component, report);
        self.diagnostics.report_once(report, self.before);
    }

    /// The one value of the user's that can have made a mistake of this code.
    fn culprit(
        &mut self,
        scope: usize,
        code: Code,
        expressions: &[&impl ToTokens],
    ) -> Option<usize> {
        let mut behind = BTreeSet::new();
        for expression in expressions {
            self.behind(scope, code, *expression, &mut behind);
        }
        let told = |it: &&usize| matches!(self.definitions[**it].progress, Progress::Failed);
        if let Some(told) = behind.iter().find(told) {
            return Some(*told);
        }
        let odd: Vec<usize> = behind
            .iter()
            .copied()
            .filter(|it| self.is_odd(*it, code))
            .collect();
        let all: Vec<usize> = behind.into_iter().collect();
        match (&odd[..], &all[..]) {
            ([only], _) | ([], [only]) => Some(*only),
            _ => None,
        }
    }

    /// Gathers the values of the user's from which an expression in a component follows.
    fn behind(
        &self,
        scope: usize,
        code: Code,
        expression: &impl ToTokens,
        found: &mut BTreeSet<usize>,
    ) {
        let mut open = vec![(scope, mentioned(expression))];
        let mut seen = BTreeSet::new();
        while let Some((scope, paths)) = open.pop() {
            for path in &paths {
                let Ok(Some((Entity::Definition(id), _))) = self.scopes.follow(scope, path) else {
                    continue;
                };
                let id = self.definitions[*id].told.unwrap_or(*id);
                let definition = &self.definitions[id];
                let is_known = matches!(definition.progress, Progress::Known(_));
                // What has the dimension that it declares has the right shape.
                let fits =
                    code == codes::WRONG_DIMENSION && is_known && definition.dimension.is_some();
                if fits || !seen.insert(id) {
                    continue;
                }
                if self.scopes[definition.scope].library.is_none() {
                    found.insert(id);
                } else {
                    open.push((definition.scope, mentioned(definition.value)));
                }
            }
        }
    }

    /// Whether a value is of the kind that makes such mistakes.
    fn is_odd(&mut self, id: usize, code: Code) -> bool {
        let definition = &self.definitions[id];
        if code == codes::WHOLE_NUMBER {
            let constants = &self.scopes[definition.scope].constants;
            return constants.evaluate(definition.value).is_err();
        }
        if !self.define(id) {
            return false;
        }
        let Progress::Known(value) = &self.definitions[id].progress else {
            return false;
        };
        if code == codes::WRONG_DIMENSION {
            return matches!(value, Value::Matrix(_));
        }
        let value = value.clone();
        let entries = value.entries(self.pool).unwrap_or_default();
        let mut rates = entries.iter().map(|entry| self.pool.rate(*entry));
        rates.any(|rate| rate == Rate::Varying)
    }

    /// A mistake inside a component, at the value behind it.
    fn unfit(&self, culprit: usize, component: &str, inner: Diagnostic) -> Diagnostic {
        let definition = &self.definitions[culprit];
        let (name, place) = (definition.name, self.written(culprit));
        let value = dump::expression(definition.value);
        // The component calls it by its parameter's name, the user wrote this.
        let found = format!("found `{name}`");
        let message = inner.message.replace(&found, &format!("found `{value}`"));
        let documentation = definition.parameter.map(|it| text(&it.documentation));
        let documentation = documentation.filter(|text| !text.is_empty());
        let is_shape = inner.code == codes::WRONG_DIMENSION;
        let turns = elsewhere::turns(definition.value).filter(|_| is_shape && name == "tilt");
        // Of a number that is out of range, or of angles, only the component's own names speak.
        let is_inner = is_shape
            && documentation.is_some()
            && !message.starts_with("expected")
            && (turns.is_some() || self.is_whole(culprit));
        let (told, inside) = match is_inner {
            true => (format!("found `{value}`"), Some(message)),
            false => (message, None),
        };
        let mut report = Diagnostic {
            span: place,
            message: format!("`{name}` does not fit in `{component}`: {told}"),
            ..inner
        };
        if inside.is_some() {
            report.helps.clear();
        }
        if report.code == codes::WHOLE_NUMBER {
            let tilts = self.components.get(component);
            let tilts =
                tilts.is_some_and(|it| it.parameters().any(|parameter| parameter.name == "tilt"));
            let help = direction(definition.value)
                .and_then(|direction| along(&name.to_string(), &value, direction, tilts));
            report.helps.splice(0..0, help);
            let value = definition.value;
            if let Some(help) = without_point(value).or_else(|| elsewhere::whole_call(value)) {
                report.helps = vec![help];
            }
        }
        if report.code == codes::EXPRESSION {
            report.helps.extend(self.driven(culprit, component));
        }
        if report.message.ends_with("found a 6×6 matrix") {
            report.helps.extend(self.with_added_mass(definition.value));
        }
        let is_zero = elsewhere::number(definition.value) == Some(0.0);
        if report.code == codes::NOT_FINITE && is_zero {
            report.helps.extend(self.without_inertia(definition.value));
        }
        let turns = turns.map(|turns| format!("for roll, pitch and yaw write `{name}: {turns}`"));
        report.helps.splice(0..0, turns);
        let notes = documentation.map(|text| format!("`{name}`: {text}"));
        let inside = inside.map(|message| format!("inside it, {message}"));
        report.notes.extend(notes.into_iter().chain(inside));
        report
    }

    /// The instance that is given this value, with its argument.
    fn given_to(&self, value: &Expr) -> Option<(&ast::Instance, &ast::Field)> {
        let mut called = self.called.values().map(|(_, instance)| *instance);
        called.find_map(|instance| {
            let mut arguments = instance.arguments.iter();
            let argument =
                arguments.find(|it| it.value.as_ref().is_some_and(|it| ptr::eq(it, value)));
            argument.map(|argument| (instance, argument))
        })
    }

    /// What to type for a value of the start that moves, or for a rest that does.
    fn driven(&self, culprit: usize, component: &str) -> Option<String> {
        let Definition { scope, value, .. } = self.definitions[culprit];
        if !self.moves_by_itself(scope, Some(value)) {
            return None;
        }
        let (instance, argument) = self.given_to(value)?;
        let component = self.components.get(component)?;
        match argument.name == "rest" {
            true => driven::by_motor(instance, component, argument),
            false => driven::by_rate(instance, component),
        }
    }

    /// What to type for a body that is given the inertia of a frame, with the masses.
    fn with_added_mass(&self, value: &Expr) -> Option<String> {
        let (instance, argument) = self.given_to(value)?;
        let (name, at) = (&instance.name, dump::reference(&instance.connections[0]));
        let is_body = instance.component == "Body" && argument.name == "inertia";
        is_body.then(|| {
            format!(
                "`inertia` has the moments about the centre of mass, `diag(…, …, …)`, and `mass` is a number of its own; masses that \
                 differ by their axes, as those of the water around a hull, stand beside it: \
                 `{name}_water: AddedMass {{ mass: diag(…, …, …), inertia: diag(…, …, …) }} ({at});`"
            )
        })
    }

    /// What to type for a body of whose mass and inertia one is zero.
    fn without_inertia(&self, zero: &Expr) -> Option<String> {
        let (instance, argument) = self.given_to(zero)?;
        let (name, at) = (&instance.name, dump::reference(&instance.connections[0]));
        let (component, zero) = (instance.component.to_string(), argument.name.to_string());
        let given = |word: &str| {
            let given = instance.arguments.iter().find(|it| it.name == word);
            elsewhere::value_text(given.and_then(|it| it.value.as_ref()))
        };
        match (component.as_str(), zero.as_str()) {
            ("Body" | "PlanarBody", "inertia") => {
                let point = component.replace("Body", "PointMass");
                let mass = given("mass");
                Some(format!(
                    "a mass without extent is written `{name}: {point} {{ mass: {mass} }} ({at});`"
                ))
            }
            ("Body" | "PlanarBody", "mass") => {
                let inertia = given("inertia");
                let (size, law, turning) = match component.as_str() {
                    "Body" => ("[3]", ", gyroscopic", "[0..3]"),
                    _ => ("", "", "[0]"),
                };
                Some(format!(
                    "what turns without a mass is written `I {name}{size} {{ inertia: {inertia}{law} }} -> {at}{turning};`"
                ))
            }
            ("PointMass" | "PlanarPointMass", "mass") => Some(format!(
                "remove `{name}`: without a mass it changes nothing"
            )),
            _ => None,
        }
    }

    /// Whether a value is a number that is known while the model is compiled.
    fn is_whole(&self, definition: usize) -> bool {
        let Definition { scope, value, .. } = self.definitions[definition];
        self.scopes[scope].constants.evaluate(value).is_ok()
    }

    /// Where a value is written.
    fn written(&self, definition: usize) -> Span {
        self.definitions[definition].value.span()
    }
}

/// The direction that a letter or a vector of numbers means.
fn direction(value: &Expr) -> Option<[f64; 3]> {
    match value {
        Expr::Path(path) => {
            let along = component_index(path.path.get_ident()?)?;
            Some([0, 1, 2].map(|axis| f64::from(u8::from(axis == along))))
        }
        Expr::Unary(unary) if matches!(unary.op, UnOp::Neg(_)) => {
            Some(direction(&unary.expr)?.map(|entry| -entry))
        }
        Expr::Array(array) => {
            let entries: Option<Vec<f64>> = array.elems.iter().map(elsewhere::number).collect();
            entries?.try_into().ok()
        }
        _ => None,
    }
}

/// What to type for a vector that is told by the letter of its axis, or a normal by the number of that.
pub(super) fn unit_vector(name: &str, value: &Expr) -> Option<String> {
    let entries = match elsewhere::number(value) {
        Some(axis) if name == "normal" => [0.0, 1.0, 2.0].map(|it| f64::from(u8::from(it == axis))),
        Some(_) => return None,
        None => direction(value)?,
    };
    let (value, [x, y, z]) = (dump::expression(value), entries.map(|it| it + 0.0));
    (entries != [0.0; 3]).then(|| {
        format!("`{value}` is an axis, and its direction a vector: write `{name}: [{x:?}, {y:?}, {z:?}]`")
    })
}

/// What to type for an axis that is told by a letter or a vector.
pub(super) fn axis(name: &str, value: &Expr) -> Option<String> {
    along(name, &dump::expression(value), direction(value)?, true)
}

/// What to type for an axis along a direction; `tilts` where a tilt may turn it.
fn along(name: &str, value: &str, direction: [f64; 3], tilts: bool) -> Option<String> {
    let parts = [0, 1, 2].into_iter().filter(|axis| direction[*axis] != 0.0);
    let (axis, tilt) = match parts.collect::<Vec<usize>>()[..] {
        [] => return None,
        [axis] if direction[axis] > 0.0 => {
            return Some(format!("`{value}` is {axis}: write `{name}: {axis}`"));
        }
        // A half turn about another axis.
        [axis] => {
            let about = if axis == 0 { "z" } else { "x" };
            (axis, format!("rot_{about}({PI})"))
        }
        _ => (2, turned(direction)),
    };
    tilts.then(|| {
        format!(
            "an axis is 0, 1 or 2, and `tilt:` turns it, and the axes of the second frame with it: write `tilt: {tilt}, {name}: {axis}`"
        )
    })
}

/// The rotation that takes the axis z to a direction.
fn turned([x, y, z]: [f64; 3]) -> String {
    if x == 0.0 {
        return format!("rot_x({})", (-y).atan2(z));
    }
    if y == 0.0 {
        return format!("rot_y({})", x.atan2(z));
    }
    format!("rot_z({}) * rot_y({})", y.atan2(x), x.hypot(y).atan2(z))
}

/// What documentation comments say.
pub(super) fn text(documentation: &[Attribute]) -> String {
    let lines = documentation.iter().filter_map(|line| match &line.meta {
        Meta::NameValue(MetaNameValue {
            value:
                Expr::Lit(ExprLit {
                    lit: Lit::Str(text),
                    ..
                }),
            ..
        }) => Some(text.value().trim().to_owned()),
        _ => None,
    });
    let text = lines.collect::<Vec<_>>().join(" ");
    text.trim_end_matches('.').to_owned()
}
