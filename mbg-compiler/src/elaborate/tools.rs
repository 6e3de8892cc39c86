//! Components of other tools and their parameters, and what is written here instead.

use std::collections::BTreeSet;

use proc_macro2::Ident;
use syn::Expr;

use super::elsewhere::{bare, operand};
use super::frames::{IN_PLANE, IN_SPACE};
use crate::syntax::slips::axes_of;
use crate::syntax::words::{near, nearest};
use crate::syntax::{ast, dump, library};

/// What components are called elsewhere, without regard to capitals, underscores and the word joint, and in the library.
const COMPONENTS: &[(&[&str], &str)] = &[
    (&["floating", "freeflyer", "sixdof", "freemotion"], "Free"),
    (&["hinge", "pin", "continuous", "rotary"], "Revolute"),
    (&["slider", "sliding", "translational"], "Prismatic"),
    (&["ball", "ballandsocket"], "Spherical"),
    (&["weld", "welded", "rigid"], "Fixed"),
    (&["cardan", "hooke"], "Universal"),
    (
        &[
            "rigidbody",
            "link",
            "bodyshape",
            "bodybox",
            "bodycylinder",
            "solid",
        ],
        "Body",
    ),
    (&["particle"], "PointMass"),
    (&["fixedtranslation", "translation"], "Offset"),
    (&["rigidtransform", "fixedframe"], "Mount"),
    (&["fixedrotation"], "Turn"),
    (
        &[
            "worldforce",
            "worldtorque",
            "bodyforce",
            "forceandtorque",
            "externalforce",
        ],
        "Load",
    ),
    (
        &[
            "rope",
            "cable",
            "tether",
            "string",
            "lineforcewithmass",
            "lineforcewithtwomasses",
        ],
        "LineForce",
    ),
    (
        &[
            "sphericalspherical",
            "universalspherical",
            "sphericalconstraint",
        ],
        "Rod",
    ),
    (&["revoluteplanarloopconstraint", "loopjoint"], "Cut"),
    (
        &[
            "endstop",
            "hardstop",
            "translationalhardstop",
            "rotationalhardstop",
            "elastogap",
            "limit",
            "bumper",
        ],
        "Stop",
    ),
    (
        &[
            "groundcontact",
            "spherecontact",
            "contactforce",
            "contactsphere",
            "spatialcontactforce",
            "hertzcontact",
            "groundplane",
            "halfspace",
            "floor",
            "foot",
            "tire",
            "tyre",
        ],
        "Contact",
    ),
    (&["mainrotor", "helicopterrotor"], "Rotor"),
    (&["motor", "dcmachine"], "DcMotor"),
    (&["idealtransformer"], "Transformer"),
    (&["idealdiode"], "Diode"),
    (
        &[
            "rackandpinion",
            "pulley",
            "drum",
            "winch",
            "wheel",
            "rollingwheel",
            "idealrollingwheel",
            "idealgearr2t",
            "wheelandaxle",
            "beltpulley",
        ],
        "Rack",
    ),
    (&["gearbox"], "Gear"),
    (&["discclutch", "coneclutch", "frictionclutch"], "Clutch"),
    (
        &[
            "onewayclutch",
            "overrunningclutch",
            "sprag",
            "spragclutch",
            "freewheelunit",
            "ratchet",
        ],
        "Freewheel",
    ),
    (&["discbrake", "drumbrake", "handbrake"], "Brake"),
    (
        &["bearingfriction", "dryfriction", "coulombfriction"],
        "Friction",
    ),
    (
        &[
            "elastobacklash",
            "elastobacklash2",
            "freeplay",
            "lostmotion",
        ],
        "Backlash",
    ),
    (
        &[
            "flexibleshaft",
            "compliantshaft",
            "torsionalshaft",
            "torsionbar",
        ],
        "ElasticShaft",
    ),
    (&["differentialgear", "opendifferential"], "Differential"),
    (
        &[
            "planetarygear",
            "idealplanetary",
            "epicyclic",
            "epicyclicgear",
        ],
        "Planetary",
    ),
    (
        &[
            "hydrauliccylinder",
            "doubleactingcylinder",
            "doubleactinghydrauliccylinder",
        ],
        "Cylinder",
    ),
    (
        &[
            "hydraulicmotor",
            "hydraulicpump",
            "fixeddisplacementpump",
            "variabledisplacementpump",
            "fixeddisplacementmotor",
        ],
        "Pump",
    ),
    (&["valve"], "Orifice"),
    (&["heatcapacitor", "thermalmass"], "HeatCapacity"),
    (
        &[
            "thermalconductor",
            "thermalresistor",
            "convection",
            "heatexchanger",
        ],
        "Conduction",
    ),
    (
        &["heatflow", "fixedheatflow", "prescribedheatflow"],
        "HeatSource",
    ),
];

/// What the parameters of components are called elsewhere, without regard to capitals, and here: the first that the
/// component has.
const PARAMETERS: &[(&[&str], &[&str])] = &[
    (&["m"], &["mass"]),
    (
        &["i", "j", "moment_of_inertia", "inertia_tensor", "tensor"],
        &["inertia"],
    ),
    (
        &[
            "com",
            "cog",
            "cm",
            "center",
            "center_of_mass",
            "centre_of_mass",
            "center_of_gravity",
            "centre_of_gravity",
            "r_cm",
        ],
        &["centre"],
    ),
    (&["r"], &["resistance", "radius", "by", "offset"]),
    (&["c"], &["capacitance", "capacity", "stiffness"]),
    (&["l", "la"], &["inductance"]),
    (&["ra", "rw"], &["resistance"]),
    (&["ids", "is"], &["saturation"]),
    (&["vt"], &["thermal"]),
    (&["av"], &["area"]),
    (&["cd"], &["discharge"]),
    (&["rho"], &["density"]),
    (&["rodlength"], &["length"]),
    (&["g", "gc", "ga"], &["conductance"]),
    (
        &[
            "k",
            "spring",
            "spring_constant",
            "spring_stiffness",
            "spring_rate",
            "kp",
        ],
        &["stiffness", "constant"],
    ),
    (
        &[
            "d",
            "b",
            "damper",
            "damping_coefficient",
            "damping_constant",
            "viscous_friction",
            "kd",
        ],
        &["damping", "friction"],
    ),
    (
        &[
            "mu",
            "friction_coefficient",
            "coefficient_of_friction",
            "friction_cone",
        ],
        &["friction"],
    ),
    (
        &[
            "friction_velocity",
            "stiction_velocity",
            "stiction_speed",
            "slip_speed",
        ],
        &["friction_speed", "speed"],
    ),
    (
        &[
            "coulomb",
            "f_coulomb",
            "coulomb_friction",
            "dynamic_friction",
        ],
        &["sliding"],
    ),
    (&["static_friction", "stiction"], &["breakaway"]),
    (
        &["min", "minimum", "lower_limit", "lower_bound", "smin"],
        &["lower"],
    ),
    (
        &["max", "maximum", "upper_limit", "upper_bound", "smax"],
        &["upper"],
    ),
    (&["n"], &["axis", "ratio", "exponent"]),
    (&LETTERS, &VECTORS),
    (
        &[
            "initial_angular_velocity",
            "initial_angular_rate",
            "initial_omega",
            "initial_w",
            "omega",
            "omega0",
            "w0",
            "initial_rates",
            "w_start",
            "w_a",
            "w",
            "rate",
        ],
        &["initial_rate", "initial_rates", "initial_turning"],
    ),
    // What slides comes before what turns: the velocity of a joint with both is that of its travel.
    (
        &[
            "initial_velocity",
            "initial_vel",
            "initial_speed",
            "v_start",
            "v_0",
            "v",
            "velocity",
            "vel",
            "speed",
        ],
        &[
            "initial_velocity",
            "initial_sliding",
            "initial_rate",
            "initial_rates",
            "initial_turning",
        ],
    ),
    (
        &[
            "initial_position",
            "initial_pos",
            "initial_travel",
            "initial_displacement",
            "s_start",
            "s",
            "r_start",
            "r_0",
            "position",
            "pos",
            "x0",
        ],
        &[
            "initial_position",
            "initial_travel",
            "initial",
            "initial_angle",
        ],
    ),
    // A slide in a plane has an angle of its own.
    (&["angle"], &["direction"]),
    (
        &[
            "initial_angle",
            "initial_angles",
            "initial_orientation",
            "initial_voltage",
            "initial_current",
            "initial_temperature",
            "initial_volume",
            "start",
            "phi_start",
            "q_start",
            "v_start",
            "i_start",
            "t_start",
            "angle",
            "angles",
            "phi",
            "q0",
            "v",
            "i",
            "t",
        ],
        &["initial", "initial_angle", "initial_travel"],
    ),
    (
        &[
            "rest_angle",
            "rest_position",
            "rest_length",
            "natural_length",
            "free_length",
            "length",
            "s_unstretched",
            "target",
            "setpoint",
            "equilibrium",
            "phi_rel0",
            "s_rel0",
        ],
        &["rest"],
    ),
    (&["tau", "motor", "effort"], &["torque", "force"]),
    (
        &["offset", "translation", "vector", "displacement"],
        &["by", "offset"],
    ),
    (&["blades", "number_of_blades"], &["count"]),
    (&["gear_ratio", "teeth_ratio"], &["ratio"]),
    (
        &[
            "max_torque",
            "maximum_torque",
            "torque_capacity",
            "friction_torque",
            "torque",
        ],
        &["capacity"],
    ),
    (
        &["signal", "command", "pressure", "f_normalized", "u"],
        &["engagement"],
    ),
    (&["play", "backlash", "lash", "clearance", "b"], &["gap"]),
    (&["q_flow", "heat_flow"], &["power"]),
    (&["d"], &["displacement"]),
];

/// Parameters that are the inverse of what other tools give.
const INVERSES: &[(&[&str], &str)] = &[
    (
        &["resistance", "r", "thermal_resistance", "rth", "r_th"],
        "conductance",
    ),
    (&["conductance", "g"], "resistance"),
];

/// The component of the library that has this name elsewhere.
pub(super) fn component(name: &str) -> Option<&'static str> {
    let name = plain(name);
    let mut components = COMPONENTS.iter();
    let listed = components.find(|(names, _)| names.contains(&name.as_str()));
    let of_library = || library::names().find(|known| known.to_lowercase() == name);
    listed.map(|(_, here)| *here).or_else(of_library)
}

/// Names of the library for one that is unknown: by what they are called elsewhere, by a word that they share, or by their
/// spelling; none where all are far from it.
pub(super) fn alike(name: &str) -> Vec<&'static str> {
    let others = COMPONENTS.iter().flat_map(|(names, _)| names.iter());
    let others: Vec<&str> = others.copied().collect();
    // Half of all words of three letters are near another.
    let is_told = name.len() > 3;
    if let Some(meant) = nearest(&plain(name), &others)
        .and_then(component)
        .filter(|_| is_told)
    {
        return vec![meant];
    }
    // The last word tells what a thing is, and those before it of which kind.
    let words = words_of(name).into_iter().rev();
    let mut found = words.map(|word| {
        let listed = COMPONENTS.iter();
        let listed = listed.filter(|(names, _)| names.contains(&word.as_str()));
        let same = library::names().filter(|known| words_of(known).contains(&word));
        let found: BTreeSet<&str> = listed.map(|(_, here)| *here).chain(same).collect();
        found.into_iter().collect::<Vec<_>>()
    });
    let shared = found.find(|found| !found.is_empty());
    shared.unwrap_or_else(|| near(name, library::names()))
}

/// The words of a name, from capital to capital or between underscores, in small letters.
fn words_of(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    for letter in name.chars() {
        if letter.is_uppercase() || letter == '_' {
            words.push(String::new());
        }
        if let (true, Some(word)) = (letter.is_alphanumeric(), words.last_mut()) {
            word.extend(letter.to_lowercase());
        }
    }
    words.retain(|word| word.len() > 2);
    words
}

/// A name without what tools write differently.
pub(super) fn plain(name: &str) -> String {
    let name = name.to_lowercase().replace('_', "");
    let bare = name.strip_suffix("joint");
    bare.unwrap_or(&name).to_owned()
}

/// The parameter of a component that has this name elsewhere; `names` are those that it has.
pub(super) fn parameter<'a>(word: &Ident, names: &[&'a str]) -> Option<&'a str> {
    let word = word.to_string();
    if names.contains(&word.as_str()) {
        return None;
    }
    let word = word.to_lowercase();
    let mut meant = PARAMETERS.iter();
    meant.find_map(|(words, here)| {
        let mut here = here.iter().filter(|_| words.contains(&word.as_str()));
        here.find_map(|here| names.iter().find(|name| *name == here).copied())
    })
}

/// The parameter of a component whose inverse has this name.
pub(super) fn inverse<'a>(word: &Ident, names: &[&'a str]) -> Option<&'a str> {
    let word = word.to_string().to_lowercase();
    let (_, here) = INVERSES
        .iter()
        .find(|(words, _)| words.contains(&word.as_str()))?;
    names.iter().find(|name| *name == here).copied()
}

/// What to type for a resistance in the place of a conductance, or the other way about.
pub(super) fn by_inverse(argument: &ast::Field, names: &[&str]) -> Option<String> {
    let here = inverse(&argument.name, names)?;
    let value = argument.value.as_ref();
    let value = value.map_or_else(|| "…".to_owned(), operand);
    Some(format!("write `{here}: 1 / {value}`"))
}

/// What to type for the axes of a joint that turns about three of them, as one word or a list.
pub(super) fn sequence(argument: &ast::Field, names: &[&str]) -> Option<String> {
    let words = [
        "sequence",
        "rotation_sequence",
        "rotation_order",
        "axes",
        "order",
    ];
    if !words.iter().any(|word| argument.name == word) || !names.contains(&"first") {
        return None;
    }
    let axes = match argument.value.as_ref().map(dump::expression) {
        Some(text) => axes_of(&text),
        None => None,
    };
    Some(match axes {
        Some([first, second, third]) => {
            format!("write `first: {first}, second: {second}, third: {third}`")
        }
        None => "write `first: …, second: …, third: …` with 0, 1 or 2 for x, y or z".to_owned(),
    })
}

/// What to type for a vector in the place of its components `x` and `y`, which are parameters of their own, and for
/// components in the place of their vector: once, at the first of them. None where the word is neither.
pub(super) fn vector(
    word: &Ident,
    arguments: &[ast::Field],
    names: &[&str],
) -> Option<Option<String>> {
    let known = |name: &str| names.contains(&name);
    let is_vector = word == "by" || parameter(word, &["by"]).is_some();
    if is_vector && known("x") && known("y") {
        let argument = arguments.iter().find(|it| it.name == *word)?;
        let [x, y] = match &argument.value {
            Some(Expr::Array(entries)) if entries.elems.len() == 2 => {
                [0, 1].map(|place| dump::expression(&entries.elems[place]))
            }
            _ => ["…", "…"].map(str::to_owned),
        };
        return Some(Some(format!("write `x: {x}, y: {y}`")));
    }
    let vector = VECTORS.iter().find(|vector| known(vector))?;
    let is_component = |it: &Ident| LETTERS.iter().any(|letter| it == letter && !known(letter));
    if !is_component(word) {
        return None;
    }
    let first = arguments.iter().find(|it| is_component(&it.name))?;
    let entries = LETTERS.map(|letter| {
        let given = arguments.iter().find(|it| it.name == letter);
        let value = given.and_then(|given| given.value.as_ref());
        value.map_or_else(|| "0.0".to_owned(), dump::expression)
    });
    Some((first.name == *word).then(|| format!("write `{vector}: [{}]`", entries.join(", "))))
}

/// Vectors in space from one point to another.
const VECTORS: [&str; 2] = ["by", "offset"];

/// Whether a parameter of this name has the angles of a joint that turns about three axes.
pub(super) fn is_of_angles(name: &Ident) -> bool {
    name == "initial" || name == "rest"
}

/// What to type for a quaternion in the place of such angles.
pub(super) fn as_angles(name: &Ident, quaternion: &Expr) -> String {
    let quaternion = dump::expression(quaternion);
    format!(
        "`{name}` has three angles, however the orientation is represented: for a quaternion `[w, x, y, z]` and the axes that \
         are not given write `{name}: angles_of(matrix_of({quaternion}), 0, 1, 2)`"
    )
}

/// Whether a parameter of this name leads from one point to another.
pub(super) fn is_way(name: &Ident) -> bool {
    VECTORS.iter().any(|way| name == way)
}

/// What to type where a number stands for such a way, which has a direction.
pub(super) fn along_an_axis(number: &Expr) -> String {
    let number = dump::expression(bare(number));
    format!("write each component: `[{number}, 0.0, 0.0]` is a way along x")
}

const LETTERS: [&str; 3] = ["x", "y", "z"];

/// What to type for a load that is given the point where it acts.
pub(super) fn at_point(instance: &ast::Instance, argument: &ast::Field) -> Option<String> {
    let is_point = ["at", "point", "position", "r"]
        .iter()
        .any(|it| argument.name == it);
    let [frame] = &instance.connections[..] else {
        return None;
    };
    let (size, offset) = match instance.component.to_string().as_str() {
        "Load" => (IN_SPACE, "Offset"),
        "PlanarLoad" => (IN_PLANE, "PlanarOffset"),
        _ => return None,
    };
    let by = match &argument.value {
        Some(Expr::Array(entries)) if size == IN_PLANE && entries.elems.len() == 2 => {
            let [x, y] = [0, 1].map(|place| dump::expression(&entries.elems[place]));
            format!("x: {x}, y: {y}")
        }
        _ if size == IN_PLANE => "x: …, y: …".to_owned(),
        value => format!(
            "by: {}",
            value
                .as_ref()
                .map_or_else(|| "…".to_owned(), dump::expression)
        ),
    };
    let (name, frame) = (&instance.name, dump::reference(frame));
    is_point.then(|| {
        format!(
            "a load acts at the origin of its frame: write `1 {name}_at[{size}]; {name}_arm: {offset} {{ {by} }} ({frame}, {name}_at);`, \
             and give `{name}` the frame `{name}_at`"
        )
    })
}

/// What to type for a gear that is given its ratio in the place of its radii.
pub(super) fn by_ratio(instance: &ast::Instance, argument: &ast::Field) -> Option<String> {
    let ends: Vec<String> = instance.connections.iter().map(dump::reference).collect();
    let [from, to] = &ends[..] else { return None };
    let is_ratio = ["ratio", "i", "n"].iter().any(|it| argument.name == it);
    if instance.component != "Gear" || !is_ratio {
        return None;
    }
    let value = argument.value.as_ref();
    let ratio = value.map_or_else(|| "…".to_owned(), dump::expression);
    Some(format!(
        "a ratio alone is a transformer: `{from} -> TF {} {{ flow: 1 / {ratio} }} -> {to};`",
        instance.name
    ))
}
