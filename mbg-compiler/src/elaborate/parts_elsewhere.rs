//! Components of other tools that are elements or circuits here, and what is written for them.

use syn::Expr;

use super::elsewhere::{filled, operand};
use super::frames::{IN_PLANE, IN_SPACE};
use super::tools::plain;
use crate::diagnostics::listing;
use crate::graph::JunctionKind;
use crate::syntax::{ast, dump};

/// Where the elements of a component of another tool stand.
#[derive(Clone, Copy, PartialEq)]
enum Stand {
    /// At one junction.
    At,
    /// Between two junctions, on what they differ by.
    Between,
    /// At the third of its junctions, by what the first two differ by.
    Across,
    /// In a bond from the first of its junctions to the second.
    Through,
}

/// Components of other tools that are elements here: what stands still has none of its own. Capitals stand for what is given.
const ELEMENTS: &[(&[&str], Stand, &[Law])] = &[
    (
        &[
            "voltagesource",
            "constantvoltage",
            "signalvoltage",
            "dcvoltagesource",
            "battery",
            "force",
            "torque",
            "forcesource",
            "torquesource",
            "idealforcesource",
            "idealtorquesource",
        ],
        Stand::Between,
        &[("Se", "source", "effort: EFFORT")],
    ),
    (
        &[
            "constantforce",
            "constanttorque",
            "torquestep",
            "forcestep",
            "pressuresource",
            "fixedpressure",
            "effortsource",
            "fixedtemperature",
            "prescribedtemperature",
            "temperaturesource",
            "thruster",
            "propeller",
            "jet",
        ],
        Stand::At,
        &[("Se", "source", "effort: EFFORT")],
    ),
    (
        &["buoyancy", "buoyancyforce", "archimedes"],
        Stand::At,
        &[("Se", "lift", "effort: 9.81 * DENSITY * VOLUME")],
    ),
    (
        &["sinevoltage", "acvoltagesource"],
        Stand::Between,
        &[("Se", "source", SINE)],
    ),
    (
        &[
            "pwm",
            "pwmvoltage",
            "controlledpwmvoltage",
            "pulsevoltage",
            "pulsevoltagesource",
        ],
        Stand::Between,
        &[(
            "Se",
            "source",
            "effort: if mod(t, 1 / FREQUENCY) < DUTY / FREQUENCY { EFFORT } else { 0.0 }",
        )],
    ),
    (
        &["stepvoltage"],
        Stand::Between,
        &[(
            "Se",
            "source",
            "effort: if t < TIME { 0.0 } else { EFFORT }",
        )],
    ),
    (
        &[
            "currentsource",
            "constantcurrent",
            "signalcurrent",
            "dccurrentsource",
            "flowsource",
        ],
        Stand::Between,
        &[("Sf", "source", "flow: FLOW")],
    ),
    (
        &[
            "speed",
            "constantspeed",
            "speedsource",
            "velocitysource",
            "angularvelocitysource",
        ],
        Stand::At,
        &[("Sf", "source", "flow: FLOW")],
    ),
    (
        &[
            "opamp",
            "operationalamplifier",
            "idealopamp",
            "idealopamp3pin",
        ],
        Stand::Across,
        &[("Se", "amplifier", "effort: …")],
    ),
    (
        &["gyrator", "idealgyrator"],
        Stand::Through,
        &[("GY", "gyrator", "effort: …")],
    ),
    (&["lever"], Stand::Through, &[("TF", "lever", "flow: …")]),
    (
        &["idealgear", "simplegear", "bevelgear1d", "worm", "wormgear"],
        Stand::Through,
        &[("TF", "gear", "flow: 1 / RATIO")],
    ),
    (
        &["leadscrew", "screw"],
        Stand::Through,
        &[("TF", "screw", "flow: LEAD / 6.283185307179586")],
    ),
    (
        &[
            "switch",
            "idealswitch",
            "idealopeningswitch",
            "idealclosingswitch",
            "mosfet",
            "igbt",
        ],
        Stand::Between,
        &[(
            "R",
            "switch",
            "resistance: if closed > 0.5 { 1e-3 } else { 1e6 }",
        )],
    ),
    (
        &["checkvalve", "nonreturnvalve"],
        Stand::Between,
        &[("R", "valve", "flow: … * max(e, 0.0)")],
    ),
    (
        &["reliefvalve", "pressurereliefvalve"],
        Stand::Between,
        &[("R", "valve", "flow: … * max(e - …, 0.0)")],
    ),
    (
        &["pipe", "staticpipe", "hydraulicpipe", "laminarresistance"],
        Stand::Between,
        &[("R", "pipe", "conductance: …")],
    ),
    (
        &["eddycurrentbrake"],
        Stand::At,
        &[(
            "R",
            "brake",
            "effort: 2 * TORQUE * f * SPEED / (f * f + SPEED * SPEED)",
        )],
    ),
    (
        &["linearspeeddependenttorque", "linearspeeddependentforce"],
        Stand::At,
        &[("R", "load", "resistance: …")],
    ),
    (
        &[
            "quadraticspeeddependenttorque",
            "quadraticspeeddependentforce",
            "drag",
            "airdrag",
            "aerodynamicdrag",
            "aerodynamics",
        ],
        Stand::At,
        &[("R", "load", "effort: … * f * abs(f)")],
    ),
    (
        &["tank", "opentank", "reservoir", "vessel"],
        Stand::At,
        &[("C", "tank", "compliance: …")],
    ),
    (
        &["reluctance", "constantreluctance"],
        Stand::Between,
        &[("C", "reluctance", "stiffness: RELUCTANCE")],
    ),
    (
        &["mass", "inertia", "rotationalinertia", "rotor1d"],
        Stand::At,
        &[("I", "mass", "inertia: INERTIA")],
    ),
    (
        &[
            "spring",
            "translationalspring",
            "rotationalspring",
            "torsionspring",
        ],
        Stand::Between,
        &[("C", "spring", "stiffness: STIFFNESS")],
    ),
    (
        &[
            "damper",
            "dashpot",
            "translationaldamper",
            "rotationaldamper",
        ],
        Stand::Between,
        &[("R", "damper", "resistance: DAMPING")],
    ),
    (
        &[
            "springdamper",
            "springanddamper",
            "shockabsorber",
            "strut",
            "suspensionstrut",
            "coilover",
        ],
        Stand::Between,
        &[
            ("C", "spring", "stiffness: STIFFNESS"),
            ("R", "damper", "resistance: DAMPING"),
        ],
    ),
    (
        &["oleo", "oleostrut", "oleopneumaticstrut", "gasspring"],
        Stand::Between,
        &[
            ("C", "gas", "effort: … * pow(1 - q / …, -1.4)"),
            ("R", "oil", "effort: … * f * abs(f)"),
        ],
    ),
    (
        &[
            "ground",
            "world",
            "electricalreference",
            "mechanicalreference",
            "mechanicaltranslationalreference",
            "mechanicalrotationalreference",
        ],
        Stand::At,
        &[],
    ),
];

const SINE: &str = "effort: EFFORT * sin(6.283185307179586 * FREQUENCY * t)";

/// Kind, name and law of an element.
type Law = (&'static str, &'static str, &'static str);

/// What the arguments are called that laws have capitals for.
const GIVEN: &[(&str, &[&str])] = &[
    (
        "EFFORT",
        &[
            "v",
            "force",
            "f_constant",
            "torque",
            "tau",
            "tau_constant",
            "stepforce",
            "steptorque",
            "p",
            "pressure",
            "t",
            "voltage",
            "temperature",
            "amplitude",
            "thrust",
        ],
    ),
    (
        "FLOW",
        &[
            "i",
            "current",
            "w",
            "w_fixed",
            "v",
            "v_fixed",
            "speed",
            "photocurrent",
            "isc",
        ],
    ),
    ("FREQUENCY", &["f", "freqhz", "frequency"]),
    ("DUTY", &["duty", "duty_cycle", "dutycycle"]),
    ("GAIN", &["gain", "transconductance", "transresistance"]),
    ("DENSITY", &["density", "rho"]),
    ("VOLUME", &["volume"]),
    ("AREA", &["area", "s", "a", "sref", "reference_area"]),
    ("RADIUS", &["radius", "r"]),
    ("OHMS", &["resistance", "r"]),
    ("TIME", &["starttime", "start_time", "steptime"]),
    ("RATIO", &["ratio", "gear_ratio"]),
    ("LEAD", &["lead"]),
    ("TORQUE", &["tau_nominal"]),
    ("SPEED", &["w_nominal"]),
    ("RELUCTANCE", &["r_m", "reluctance"]),
    ("INERTIA", &["j", "m", "mass", "inertia"]),
    ("STIFFNESS", &["c", "k", "stiffness", "spring_rate"]),
    ("DAMPING", &["d", "b", "damping", "damping_coefficient"]),
];

/// What stands at frames in space, with the marks of [`CIRCUITS`].
const IN_FRAMES: &[(&[&str], &str)] = &[
    (
        &["thruster", "propeller", "jet"],
        "@: Load { force: [EFFORT, 0.0, 0.0] } (#0);",
    ),
    (
        &["buoyancy", "buoyancyforce", "archimedes"],
        "@: Load { axes: world, force: [0.0, 0.0, 9.81 * DENSITY * VOLUME], orientation_at: … } (#0);` with the `orientation_b` of \
         the joint that leads there; where it acts at another point, `1 @_at[6]; @_arm: Offset { by: […, …, …] } (#0, @_at);` leads to it",
    ),
    (
        &["drag", "airdrag", "aerodynamicdrag"],
        "#0[3..6] -> R @ { effort: … * sqrt(transpose(f) * f + 1e-12) * f };",
    ),
    (
        &["aerodynamics"],
        "#0[3..6] -> R @ { effort: 0.6 * AREA * sqrt(transpose(f) * f + 1e-12) * (diag(…, …, …) * f) };` with the coefficients of \
         drag along x, and of side force and lift by the angles that the velocity has to it; what damps its turning is \
         `#0[0..3] -> R @_damping { resistance: diag(…, …, …) };`",
    ),
];

/// The same in a plane.
const IN_PLANAR_FRAMES: &[(&[&str], &str)] = &[
    (
        &["thruster", "propeller", "jet"],
        "@: PlanarLoad { force: [EFFORT, 0.0] } (#0);",
    ),
    (
        &["buoyancy", "buoyancyforce", "archimedes"],
        "@: PlanarLoad { axes: world, force: [0.0, 9.81 * DENSITY * VOLUME] } (#0);",
    ),
    (
        &["drag", "airdrag", "aerodynamicdrag", "aerodynamics"],
        "#0[1..3] -> R @ { effort: … * sqrt(transpose(f) * f + 1e-12) * f };",
    ),
];

/// Circuits that components of other tools are here, with `@` for their names and `#` for their junctions by number.
const CIRCUITS: &[(&[&str], &str)] = &[
    (
        &["potentiometer"],
        "@_upper: Resistor { resistance: (1 - …) * OHMS } (#0, #2); @_lower: Resistor { resistance: … * OHMS } (#2, #1);` with where \
         the wiper is in both, such as `input @_place;`, between zero and one and neither of these",
    ),
    (
        &[
            "hbridge",
            "fullbridge",
            "dcdcconverter",
            "fourquadrantchopper",
        ],
        "1 @_supply; 1 @_load; #0 -> @_supply -> #1; #3 -> @_load -> #2; @_load -> MTF @ { flow: … } -> @_supply;` on the average, \
         with the duty from -1 to 1, such as `input @_duty;`",
    ),
    (
        &["solarcell", "photovoltaiccell", "pvcell"],
        "@_junction: Diode (#0, #1); 1 @_light { Sf @ { flow: FLOW } } #1 -> @_light -> #0;",
    ),
    (
        &["fuse", "circuitbreaker"],
        "input @_blown; 1 @_wire { R @ { resistance: if @_blown > 0.5 { 1e9 } else { 1e-3 } } } #0 -> @_wire -> #1; \
         integral @_melting = powi(@_wire.f, 2);` and, to find by `Integrator::until` where it blows, `output @_left = … - @_melting;`",
    ),
    (
        &["ccc", "cccs", "currentcontrolledcurrentsource"],
        "1 @_sensed; #0 -> @_sensed -> #1; 1 @_driven { Sf @ { flow: GAIN * @_sensed.f } } #2 -> @_driven -> #3;",
    ),
    (
        &["ccv", "ccvs", "currentcontrolledvoltagesource"],
        "1 @_sensed; #0 -> @_sensed -> #1; 1 @_driven { Se @ { effort: GAIN * @_sensed.f } } #3 -> @_driven -> #2;",
    ),
    (
        &["lossygear", "gearwithefficiency"],
        "#0 -> TF @ { flow: 1 / RATIO } -> #1; @_loss: Friction { sliding: … } (#1);` with what is lost, such as \
         (1 - efficiency) of the torque of the load",
    ),
    (
        &["torqueconverter", "fluidcoupling"],
        "let @_ratio = min(max(#1.f / max(#0.f, 1.0), 0.0), 1.0); \
         let @_torque = powi(#0.f / …, 2) * interpolate(@_ratio, [0.0, 0.8, 1.0], [1.0, 0.9, 0.0]); \
         Se @_pump { effort: -@_torque } -> #0; Se @_turbine { effort: max(2.0 - 1.25 * @_ratio, 1.0) * @_torque } -> #1;",
    ),
    (
        &[
            "tire",
            "tyre",
            "tiremagicformula",
            "tiresimple",
            "tyresimple",
        ],
        "0 @_road; 1 @_slip { R @ { effort: … * tanh(f / …) } } #0 -> TF @_rim { flow: RADIUS } -> @_road; @_road -> @_slip; \
         @_road -> #1;` from the shaft of the wheel to the speed of the car, with the load times the coefficient of friction, and \
         the speed of the slip at which it is nearly reached",
    ),
    (
        &[
            "emf",
            "rotationalemf",
            "translationalemf",
            "rotationalelectromechanicalconverter",
            "translationalelectromechanicalconverter",
        ],
        "1 @_wire; #0 -> @_wire -> #1; @_wire -> GY @ { effort: … } -> #2;",
    ),
    (
        &["electromagneticconverter"],
        "1 @_wire; 1 @_core; #0 -> @_wire -> #1; @_wire -> GY @ { effort: … } -> @_core; #3 -> @_core -> #2;",
    ),
    (
        &["vcv", "vcvs", "voltagecontrolledvoltagesource"],
        "1 @_between { Se @ { effort: GAIN * (#0.e - #1.e) } } #3 -> @_between -> #2;",
    ),
    (
        &["vcc", "vccs", "voltagecontrolledcurrentsource"],
        "1 @_between { Sf @ { flow: GAIN * (#0.e - #1.e) } } #2 -> @_between -> #3;",
    ),
    (
        &["nmos", "nchannelmosfet"],
        "let @_over = max(#1.e - #2.e - …, 0.0); \
         1 @_channel { R @ { flow: … * (@_over - min(e, @_over) / 2) * min(e, @_over) } } #0 -> @_channel -> #2;",
    ),
    (
        &["npn", "npnbipolartransistor"],
        "@_base: Diode (#1, #2); 1 @_collector { Sf @ { flow: … * @_base.current } } #0 -> @_collector -> #2;",
    ),
    (
        &["mutualinductor", "mutualinductance"],
        "1 @[2] { I @_core { inertia: [[…, …], […, …]] } } 1 @_a; 1 @_b; #0 -> @_a -> #1; #2 -> @_b -> #3; @_a -> @[0]; @_b -> @[1];",
    ),
    (
        &[
            "bodyradiation",
            "radiation",
            "radiativeheattransfer",
            "thermalradiation",
        ],
        "1 @_between pseudo { R @ { flow: 5.670374419e-8 * … * (powi(#0.e, 4) - powi(#1.e, 4)) } } #0 -> @_between -> #1;",
    ),
    (
        &[
            "fourwaydirectionalvalve",
            "4waydirectionalvalve",
            "servovalve",
        ],
        "@_pa: Orifice { area: max(…, 1e-12) } (#0, #2); @_bt: Orifice { area: max(…, 1e-12) } (#3, #1); \
         @_pb: Orifice { area: max(-…, 1e-12) } (#0, #3); @_at: Orifice { area: max(-…, 1e-12) } (#2, #1);",
    ),
    (
        &["position", "move", "accelerate", "positionsource"],
        "input @_rate; Sf @ { flow: @_rate } -> #0;` and, to read it, `integral @_position = @_rate;`",
    ),
];

/// What a component of another tool is here that no few elements are.
const TOLD: &[(&[&str], &str)] = &[
    (
        &[
            "oline",
            "uline",
            "tline",
            "tline1",
            "tline2",
            "tline3",
            "transmissionline",
        ],
        "nothing keeps values of the past, as a line without losses does: it is a row of cells, `@: for k in 0..20 { … }`, each a \
         1-junction with an `I` and an `R` and a 0-junction with a `C`",
    ),
    (
        &["thyristor", "idealthyristor", "scr", "gto", "triac"],
        "what remembers where it came from is an `input` that stays between two events: write a switch, \
         `R @ { flow: if fired > 0.5 { … * max(e, 0.0) } else { 0.0 } }`, and let `Integrator::until` find where its current ends",
    ),
    (
        &[
            "inductionmachine",
            "inductionmotor",
            "asynchronousmachine",
            "asynchronousinductionmachine",
            "squirrelcage",
            "aimsquirrelcage",
        ],
        "a machine of three phases is written in two axes that stand, with the currents of the stator, then those of the rotor: \
         `1 @[4] { I @_field { inertia: [[ls, 0.0, lm, 0.0], [0.0, ls, 0.0, lm], [lm, 0.0, lr, 0.0], [0.0, lm, 0.0, lr]] } } \
         @[0..2] -> R @_stator { resistance: rs }; @[2..4] -> R @_rotor { resistance: rr }; \
         @[2..4] -> MGY @_gap { effort: pairs * [[@_field.p[3], -@_field.p[2]]] } -> shaft; \
         Se @_grid[2] { effort: [u * cos(w * t), u * sin(w * t)] } -> @[0..2];` with the shaft `shaft`",
    ),
    (
        &[
            "jointrrr", "jointrrp", "jointupr", "jointups", "jointusr", "jointusp", "jointssr",
            "jointssp",
        ],
        "an assembly of joints is written as its joints, and a `Cut`, in a plane a `PlanarCut`, closes the loop",
    ),
];

/// An element, which bears the name of the instance where it is alone.
struct Part {
    kind: &'static str,
    name: &'static str,
    law: String,
}

/// What to type for an instance of a component of another tool that is made of elements here; `end` is the first junction
/// that it was given, by its kind and dimension.
pub(super) fn elements(
    instance: &ast::Instance,
    end: Option<(JunctionKind, usize)>,
) -> Option<String> {
    let component = plain(&instance.component.to_string());
    let circuits = match end {
        Some((_, IN_SPACE)) => IN_FRAMES,
        Some((_, IN_PLANE)) => IN_PLANAR_FRAMES,
        _ => CIRCUITS,
    };
    if let Some(text) = named_alike(circuits, &component) {
        // What is told behind the text to type ends it itself.
        let end = if text.contains('`') { "" } else { "`" };
        let typed = circuit(instance, text);
        let left_out = left_out(instance, &[text], &typed);
        return Some(format!("here it is written `{typed}{end}{left_out}"));
    }
    if let Some(text) = named_alike(TOLD, &component) {
        return Some(circuit(instance, text));
    }
    let mut known = ELEMENTS.iter();
    let (_, stand, parts) = known.find(|(names, ..)| names.contains(&component.as_str()))?;
    let laws: Vec<&str> = parts.iter().map(|(.., law)| *law).collect();
    let (kind, dimension) = end.unwrap_or((JunctionKind::One, 1));
    let ends: Vec<String> = instance.connections.iter().map(dump::reference).collect();
    let parts: Vec<Part> = parts.iter().map(|part| given(instance, part)).collect();
    let parts = &parts[..];
    let name = instance.name.to_string();
    let at = ends.first().map_or("…", String::as_str);
    let text = match (stand, &ends[..], parts) {
        (_, _, []) => at_junction(&[still(kind)], &name, at, dimension),
        (Stand::At, _, [part]) if part.kind == "I" && dimension > 1 => {
            of_frame(&name, at, dimension)
        }
        (Stand::Across, [plus, minus, out], _) => {
            format!("Se {name} {{ effort: 1e5 * ({plus}.e - {minus}.e) }} -> {out};")
        }
        (Stand::Across, ..) => return None,
        (Stand::Through, [from, to], [part]) => {
            let element = element(part, &name, "");
            format!("{from} -> {element} -> {to};")
        }
        (Stand::Through, ..) => format!("… -> {} -> …;", element(&parts[0], &name, "")),
        (Stand::Between, [_, _], _) if dimension > 1 => return None,
        (Stand::Between, [a, b], _) => between(parts, &name, (kind, [a, b])),
        _ => at_junction(parts, &name, at, dimension),
    };
    let left_out = left_out(instance, &laws, &text);
    Some(format!("here it is written `{text}`{left_out}"))
}

/// The arguments of an instance for which laws have no place, unless what is typed leaves something to be filled in.
fn left_out(instance: &ast::Instance, laws: &[&str], typed: &str) -> String {
    let is_read = |place: &str| laws.iter().any(|law| law.contains(place));
    let places = GIVEN.iter().filter(|(place, _)| is_read(place));
    let taken: Vec<&[&str]> = places.map(|(_, names)| *names).collect();
    let names = instance.arguments.iter().map(|it| it.name.to_string());
    let lost = names.filter(|name| {
        let name = name.to_lowercase();
        !taken.iter().any(|names| names.contains(&name.as_str()))
    });
    let lost: Vec<String> = lost.collect();
    if lost.is_empty() || laws.is_empty() || typed.contains('…') {
        return String::new();
    }
    format!("; that leaves out {}", listing(lost))
}

/// The text for the names among which this one is.
fn named_alike(table: &[(&[&str], &'static str)], name: &str) -> Option<&'static str> {
    let (_, text) = table.iter().find(|(names, _)| names.contains(&name))?;
    Some(text)
}

/// A text with the name of an instance, its junctions, and its arguments.
fn circuit(instance: &ast::Instance, text: &str) -> String {
    let named = text.replace('@', &instance.name.to_string());
    let values = GIVEN.iter().fold(named, |text, (place, names)| {
        let value = argument(instance, names).map_or_else(|| "…".to_owned(), operand);
        text.replace(place, &value)
    });
    (0..4).fold(values, |text, place| {
        let junction = instance.connections.get(place);
        let junction = junction.map_or_else(|| "…".to_owned(), dump::reference);
        text.replace(&format!("#{place}"), &junction)
    })
}

/// An element with the arguments of an instance in its law.
fn given(instance: &ast::Instance, (kind, name, law): &Law) -> Part {
    let places = GIVEN
        .iter()
        .filter_map(|(place, names)| Some((*place, argument(instance, names)?)));
    let places: Vec<(&str, &Expr)> = places.collect();
    let (word, value) = law.split_once(": ").unwrap_or_default();
    let missing = GIVEN
        .iter()
        .filter(|(place, _)| places.iter().all(|(given, _)| given != place));
    let value = missing.fold(filled(value, &places), |value, (place, _)| {
        value.replace(place, "…")
    });
    let law = format!("{word}: {value}");
    Part { kind, name, law }
}

/// The argument of an instance that has one of these names.
fn argument<'i>(instance: &'i ast::Instance, names: &[&str]) -> Option<&'i Expr> {
    let mut arguments = instance.arguments.iter();
    let argument = arguments.find(|it| {
        let name = it.name.to_string().to_lowercase();
        names.contains(&name.as_str())
    })?;
    argument.value.as_ref()
}

/// What holds a flow or an effort at zero.
fn still(kind: JunctionKind) -> Part {
    let (kind, name, law) = match kind {
        JunctionKind::One => ("Sf", "still", "flow: 0.0"),
        JunctionKind::Zero => ("Se", "zero", "effort: 0.0"),
    };
    let law = law.to_owned();
    Part { kind, name, law }
}

fn at_junction(parts: &[Part], name: &str, at: &str, dimension: usize) -> String {
    let size = match dimension {
        1 => String::new(),
        size => format!("[{size}]"),
    };
    let bonds = parts.iter().map(|part| {
        format!(
            "{} -> {at};",
            element(part, &named(parts, name, part), &size)
        )
    });
    bonds.collect::<Vec<_>>().join(" ")
}

fn of_frame(name: &str, at: &str, dimension: usize) -> String {
    let component = match dimension {
        IN_PLANE => "PlanarBody",
        _ => "Body",
    };
    format!("{name}: {component} {{ mass: …, inertia: … }} ({at});")
}

/// Elements on what two junctions differ by: on the flow between those with common flows, all elements of one flow, and
/// on the effort between those with common efforts.
fn between(parts: &[Part], name: &str, (kind, [a, b]): (JunctionKind, [&str; 2])) -> String {
    let elements = parts
        .iter()
        .map(|part| element(part, &named(parts, name, part), ""));
    let elements = elements.collect::<Vec<_>>().join(" ");
    let middle = format!("{name}_between");
    // A source of effort raises it from the second of its nodes to the first.
    let is_raised = kind == JunctionKind::Zero && parts[0].kind == "Se";
    let (a, b) = if is_raised { (b, a) } else { (a, b) };
    let bonds = format!("{a} -> {middle}; {middle} -> {b};");
    match (kind, parts.len()) {
        (JunctionKind::Zero, _) => format!("1 {middle} {{ {elements} }} {bonds}"),
        (JunctionKind::One, 1) => format!("0 {middle} {{ {elements} }} {bonds}"),
        (JunctionKind::One, _) => {
            format!("0 {middle}; 1 {name} {{ {elements} }} {bonds} {middle} -> {name};")
        }
    }
}

fn named(parts: &[Part], name: &str, part: &Part) -> String {
    let is_alone = parts.len() == 1;
    if is_alone { name } else { part.name }.to_owned()
}

fn element(Part { kind, law, .. }: &Part, name: &str, size: &str) -> String {
    format!("{kind} {name}{size} {{ {law} }}")
}
