//! What other tools give their contacts and joints, and what stands beside these or has another law here.

use proc_macro2::Ident;
use syn::Expr;

use super::elsewhere::{filled, value_text};
use super::frames::{IN_PLANE, IN_SPACE};
use super::tools::{component, parameter};
use crate::syntax::{ast, dump};

/// Words for what is lost in an impact by the speeds before and behind it.
const RESTITUTIONS: [&str; 4] = [
    "restitution",
    "coefficient_of_restitution",
    "restitution_coefficient",
    "e",
];
/// Words for a damper without regard to the depth.
const DAMPERS: [&str; 6] = [
    "damping",
    "damping_coefficient",
    "damping_constant",
    "damper",
    "kd",
    "d",
];
/// Words for where a joint ends on one side, and what a `Stop` calls that.
const ENDS: [(&str, &str); 6] = [
    ("lower", "lower"),
    ("lower_limit", "lower"),
    ("min", "lower"),
    ("upper", "upper"),
    ("upper_limit", "upper"),
    ("max", "upper"),
];
/// Words for both.
const LIMITS: [&str; 4] = ["limits", "limit", "range", "joint_limits"];
/// Words for friction that holds.
const HOLDS: [&str; 2] = ["at_rest", "stiction"];

/// Moments of inertia about axes of a frame.
const MOMENTS: [[&str; 2]; 3] = [["ixx", "i_11"], ["iyy", "i_22"], ["izz", "i_33"]];
/// What the effort of plates is the product of.
const OF_CAPACITY: [&str; 4] = ["fn_max", "cgeo", "mue_pos", "mue"];
/// Words for what a body begins with.
const STARTS: [&str; 6] = [
    "initial_velocity",
    "initial_angular_velocity",
    "initial_rate",
    "initial_flow",
    "velocity",
    "v0",
];

/// The component of the library that is called otherwise elsewhere: a ground that rubs is no frame that stands, a wheel on one
/// frame none on a rack, and a tyre between two shafts no contact of frames. With how many components the first junction has.
pub(super) fn meant(instance: &ast::Instance, size: Option<usize>) -> Option<&'static str> {
    let is_on_one = instance.connections.len() == 1;
    let is_on_frames = matches!(size, Some(IN_PLANE | IN_SPACE));
    let rubs =
        |it: &ast::Field| it.name == "stiffness" || parameter(&it.name, &["friction"]).is_some();
    match component(&instance.component.to_string()) {
        Some("Rack") if is_on_one => Some("Contact"),
        Some("Contact") if instance.connections.len() > 1 => is_on_frames.then_some("BodyContact"),
        None if is_on_one
            && instance.component == "Ground"
            && instance.arguments.iter().any(rubs) =>
        {
            Some("Contact")
        }
        here => here,
    }
}

/// What a contact with the ground is called on another body.
pub(super) fn on_body(component: &str) -> Option<&'static str> {
    match component {
        "Contact" => Some("BodyContact"),
        "PlanarContact" => Some("PlanarBodyContact"),
        _ => None,
    }
}

/// The call of a contact between two bodies, where one with the ground is given both.
pub(super) fn between(instance: &ast::Instance, component: &ast::Component) -> Option<String> {
    let between = on_body(&component.name.to_string())?;
    let ([at, on], true) = (&instance.connections[..], component.library) else {
        return None;
    };
    let (name, [at, on]) = (&instance.name, [at, on].map(dump::reference));
    Some(format!(
        "write `{name}: {between} {{ … }} ({at}, {on});`, which is between two bodies"
    ))
}

/// What to type for an argument that the component does not have; `names` are those of its parameters.
pub(super) fn told(
    instance: &ast::Instance,
    argument: &ast::Field,
    names: &[&str],
) -> Option<String> {
    let lost = names
        .contains(&"dissipation")
        .then(|| dissipation(&argument.name));
    lost.flatten()
        .or_else(|| stop(instance, argument))
        .or_else(|| holds(instance, argument))
        .or_else(|| moments(instance, argument, names))
        .or_else(|| capacity(instance, argument, names))
        .or_else(|| way_in_plane(instance, argument))
        .or_else(|| start_of_body(instance, argument))
}

/// Whether a word is a factor of the effort of plates.
pub(super) fn is_factor_of_capacity(word: &Ident) -> bool {
    is_one_of(word, &OF_CAPACITY)
}

/// The effort of plates by its factors.
fn capacity(instance: &ast::Instance, argument: &ast::Field, names: &[&str]) -> Option<String> {
    if !is_factor_of_capacity(&argument.name) || !names.contains(&"capacity") {
        return None;
    }
    let factors = OF_CAPACITY.iter().filter_map(|word| {
        let mut arguments = instance.arguments.iter();
        Some((*word, arguments.find(|it| it.name == word)?))
    });
    let factors: Vec<(&str, &ast::Field)> = factors.collect();
    let words: Vec<&str> = factors.iter().map(|(word, _)| *word).collect();
    let given = factors
        .iter()
        .filter_map(|(word, it)| Some((*word, it.value.as_ref()?)));
    let product = filled(&words.join(" * "), &given.collect::<Vec<_>>());
    Some(format!(
        "the effort while it slips is one number: write `capacity: {product}`"
    ))
}

/// The way of a slide in a plane, which is told by its angle.
fn way_in_plane(instance: &ast::Instance, argument: &ast::Field) -> Option<String> {
    let is_axis = argument.name == "axis" || argument.name == "n";
    if instance.component != "PlanarPrismatic" || !is_axis {
        return None;
    }
    Some(match &argument.value {
        Some(Expr::Array(entries)) if entries.elems.len() == 2 => {
            let [x, y] = [0, 1].map(|place| dump::expression(&entries.elems[place]));
            format!("write `direction: atan2({y}, {x})`")
        }
        _ => "write `direction: …` with the angle of the slide from x".to_owned(),
    })
}

/// Whether a word is a moment of inertia, which a tensor has on its diagonal.
pub(super) fn is_moment(word: &Ident) -> bool {
    let word = word.to_string().to_lowercase();
    MOMENTS.iter().flatten().any(|known| *known == word)
}

/// The tensor of moments that are given one by one.
fn moments(instance: &ast::Instance, argument: &ast::Field, names: &[&str]) -> Option<String> {
    if !is_moment(&argument.name) || !names.contains(&"inertia") {
        return None;
    }
    let entries = MOMENTS.map(|words| {
        let mut given = instance.arguments.iter();
        let given = given.find(|it| words.contains(&it.name.to_string().to_lowercase().as_str()));
        given.map_or_else(|| "…".to_owned(), |it| value_text(it.value.as_ref()))
    });
    Some(format!("write `inertia: diag({})`", entries.join(", ")))
}

/// A body begins as its frame does.
fn start_of_body(instance: &ast::Instance, argument: &ast::Field) -> Option<String> {
    let size = match instance.component.to_string().as_str() {
        "Body" | "PointMass" => IN_SPACE,
        "PlanarBody" | "PlanarPointMass" => IN_PLANE,
        _ => return None,
    };
    let frame = instance.connections.first().map(dump::reference)?;
    is_one_of(&argument.name, &STARTS).then(|| {
        format!(
            "a body begins as its frame does: write `1 {frame}[{size}] coordinate, initial_flow: …;` with the angular velocity, \
             then the velocity, or give the joint that leads there its rate at the start"
        )
    })
}

fn is_one_of(name: &Ident, words: &[&str]) -> bool {
    words.iter().any(|word| name == word)
}

/// What a stop or a contact loses.
fn dissipation(name: &Ident) -> Option<String> {
    if is_one_of(name, &RESTITUTIONS) {
        let rate = "1.5 * (1 - e) / v";
        return Some(format!(
            "write `dissipation: {rate}` for the coefficient of restitution e, near one, at the speed v; or stop at each impact \
             by `Integrator::until` and change the speed there"
        ));
    }
    is_one_of(name, &DAMPERS).then(|| {
        "write `dissipation`, by speed: the damper acts by the depth d, `stiffness * d * dissipation` times its rate".to_owned()
    })
}

/// The travel of a joint with one free axis.
pub(super) fn travel(instance: &ast::Instance) -> Option<&'static str> {
    match instance.component.to_string().as_str() {
        "Revolute" | "PlanarRevolute" => Some("angle"),
        "Prismatic" | "PlanarPrismatic" => Some("travel"),
        _ => None,
    }
}

/// Where a joint ends: all that it is given of that.
fn stop(instance: &ast::Instance, argument: &ast::Field) -> Option<String> {
    let end = |name: &Ident| ENDS.iter().find(|(word, _)| name == word);
    let is_end = |it: &Ident| end(it).is_some() || is_one_of(it, &LIMITS);
    if !is_end(&argument.name) {
        return None;
    }
    let (travel, name) = (travel(instance)?, &instance.name);
    let ends = instance.arguments.iter().filter_map(|it| {
        let (_, here) = end(&it.name)?;
        Some(format!("{here}: {}", value_text(it.value.as_ref())))
    });
    let mut ends: Vec<String> = ends.collect();
    if ends.is_empty() {
        ends = ["lower", "upper"].map(|it| format!("{it}: …")).to_vec();
    }
    Some(format!(
        "a joint ends at a stop beside it: \
         `{name}_stop: Stop {{ displacement: {name}.{travel}, {}, stiffness: … }} ({name}.rate);`",
        ends.join(", ")
    ))
}

/// Friction that holds, where that of the component creeps.
fn holds(instance: &ast::Instance, argument: &ast::Field) -> Option<String> {
    if !is_one_of(&argument.name, &HOLDS) {
        return None;
    }
    let component = instance.component.to_string();
    if ["Contact", "BodyContact"].contains(&component.as_str()) {
        return Some(format!(
            "in space friction creeps, below `friction_speed`; a `Planar{component}` holds"
        ));
    }
    travel(instance)?;
    let name = &instance.name;
    let given = instance.arguments.iter().find(|it| it.name == "friction");
    let sliding = value_text(given.and_then(|it| it.value.as_ref()));
    Some(format!(
        "what holds is beside the joint, in the place of `friction`: \
         `{name}_friction: Friction {{ sliding: {sliding}, at_rest: holds }} ({name}.rate);`"
    ))
}
