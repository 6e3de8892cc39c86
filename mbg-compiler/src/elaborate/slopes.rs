//! Diodes of other tools, which have two slopes, and what is written for them.

use syn::Expr;

use super::elsewhere::filled;
use crate::syntax::{ast, dump};

/// What such a diode is given: the resistance where it conducts, the conductance where it does not, the voltage between.
const GIVEN: [(&str, &[&str]); 3] = [
    ("on", &["ron", "on_resistance", "forward_resistance"]),
    ("off", &["goff", "off_conductance"]),
    ("knee", &["vknee", "vf", "forward_voltage"]),
];

/// What to type for a diode that is given its slopes, once, at the first of them; none for another argument.
pub(super) fn told(instance: &ast::Instance, argument: &ast::Field) -> Option<Option<String>> {
    let place = |it: &ast::Field| {
        let name = it.name.to_string().to_lowercase();
        let mut given = GIVEN.iter();
        given.find(|(_, words)| {
            words.contains(&name.as_str()) || words.contains(&name.replace('_', "").as_str())
        })
    };
    let [a, b] = &instance.connections[..] else {
        return None;
    };
    place(argument).filter(|_| instance.component == "Diode")?;
    let given = instance
        .arguments
        .iter()
        .filter_map(|it| Some((place(it)?.0, it.value.as_ref()?)));
    let given: Vec<(&str, &Expr)> = given.collect();
    let mut arguments = instance.arguments.iter();
    let first = arguments.find(|it| place(it).is_some())?;
    let has = |wanted: &str| given.iter().any(|(place, _)| *place == wanted);
    let above = if has("knee") {
        "max(e - knee, 0.0)"
    } else {
        "max(e, 0.0)"
    };
    let steep = if has("on") { "on" } else { "1e-5" };
    let flat = if has("off") { "off" } else { "1e-5" };
    let flow = filled(&format!("{above} / {steep} + {flat} * e"), &given);
    let (name, a, b) = (&instance.name, dump::reference(a), dump::reference(b));
    Some((first.name == argument.name).then(|| {
        format!(
            "a diode of the library has the curve of a junction; one of two slopes is written \
             `1 {name} {{ R {name}_slopes {{ flow: {flow} }} }} {a} -> {name}; {name} -> {b};`"
        )
    }))
}
