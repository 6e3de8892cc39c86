//! The spellings of SI, and how a dimension is spelled.
//!
//! Values are never converted: a unit that would scale them is refused with the text to type instead, since a parameter
//! `5.0` that silently becomes `0.005` is worse than a mistake. The radian and the steradian are pure numbers, kept in the
//! spelling; the hertz is one per second, without a turn in it.

use proc_macro2::{Ident, Span};

use super::dimension::{Dimension, Ratio};
use super::spellings;
use crate::codes;
use crate::diagnostics::{Diagnostic, error};
use crate::symbolic::print::number;
use crate::syntax::ast::Unit;

/// Units that scale nothing, with the exponents of kg, m, s, A, K, mol and cd.
const COHERENT: &[(&str, [i8; 7])] = &[
    ("kg", [1, 0, 0, 0, 0, 0, 0]),
    ("m", [0, 1, 0, 0, 0, 0, 0]),
    ("s", [0, 0, 1, 0, 0, 0, 0]),
    ("A", [0, 0, 0, 1, 0, 0, 0]),
    ("K", [0, 0, 0, 0, 1, 0, 0]),
    ("mol", [0, 0, 0, 0, 0, 1, 0]),
    ("cd", [0, 0, 0, 0, 0, 0, 1]),
    ("rad", [0; 7]),
    ("sr", [0; 7]),
    ("Hz", [0, 0, -1, 0, 0, 0, 0]),
    ("N", [1, 1, -2, 0, 0, 0, 0]),
    ("Pa", [1, -1, -2, 0, 0, 0, 0]),
    ("J", [1, 2, -2, 0, 0, 0, 0]),
    ("W", [1, 2, -3, 0, 0, 0, 0]),
    ("C", [0, 0, 1, 1, 0, 0, 0]),
    ("V", [1, 2, -3, -1, 0, 0, 0]),
    ("ohm", [1, 2, -3, -2, 0, 0, 0]),
    ("S", [-1, -2, 3, 2, 0, 0, 0]),
    ("F", [-1, -2, 4, 2, 0, 0, 0]),
    ("Wb", [1, 2, -2, -1, 0, 0, 0]),
    ("T", [1, 0, -2, -1, 0, 0, 0]),
    ("H", [1, 2, -2, -2, 0, 0, 0]),
    ("lm", [0, 0, 0, 0, 0, 0, 1]),
    ("lx", [0, -2, 0, 0, 0, 0, 1]),
];

/// Units outside SI: so many of what to type instead.
const SCALED: &[(&str, f64, Factors)] = &[
    ("g", 1e-3, &[("kg", 1)]),
    ("t", 1e3, &[("kg", 1)]),
    ("tonne", 1e3, &[("kg", 1)]),
    ("lb", 0.453_592_37, &[("kg", 1)]),
    ("lbs", 0.453_592_37, &[("kg", 1)]),
    ("lbm", 0.453_592_37, &[("kg", 1)]),
    ("slug", 14.593_902_937_206_364, &[("kg", 1)]),
    ("min", 60.0, &[("s", 1)]),
    ("minute", 60.0, &[("s", 1)]),
    ("minutes", 60.0, &[("s", 1)]),
    ("h", 3600.0, &[("s", 1)]),
    ("hr", 3600.0, &[("s", 1)]),
    ("hour", 3600.0, &[("s", 1)]),
    ("hours", 3600.0, &[("s", 1)]),
    ("d", 86400.0, &[("s", 1)]),
    ("day", 86400.0, &[("s", 1)]),
    ("days", 86400.0, &[("s", 1)]),
    ("year", 31_557_600.0, &[("s", 1)]),
    ("years", 31_557_600.0, &[("s", 1)]),
    ("deg", std::f64::consts::PI / 180.0, &[("rad", 1)]),
    ("degree", std::f64::consts::PI / 180.0, &[("rad", 1)]),
    ("degrees", std::f64::consts::PI / 180.0, &[("rad", 1)]),
    ("rev", std::f64::consts::TAU, &[("rad", 1)]),
    ("turn", std::f64::consts::TAU, &[("rad", 1)]),
    ("turns", std::f64::consts::TAU, &[("rad", 1)]),
    ("rpm", std::f64::consts::TAU / 60.0, TURNING),
    ("rps", std::f64::consts::TAU, TURNING),
    ("inch", 0.0254, &[("m", 1)]),
    ("inches", 0.0254, &[("m", 1)]),
    ("in", 0.0254, &[("m", 1)]),
    ("ft", 0.3048, &[("m", 1)]),
    ("foot", 0.3048, &[("m", 1)]),
    ("feet", 0.3048, &[("m", 1)]),
    ("yd", 0.9144, &[("m", 1)]),
    ("mile", 1609.344, &[("m", 1)]),
    ("miles", 1609.344, &[("m", 1)]),
    ("nmi", 1852.0, &[("m", 1)]),
    ("mph", 0.447_04, SPEED),
    ("kmh", 1.0 / 3.6, SPEED),
    ("kph", 1.0 / 3.6, SPEED),
    ("kn", 1852.0 / 3600.0, SPEED),
    ("kt", 1852.0 / 3600.0, SPEED),
    ("knot", 1852.0 / 3600.0, SPEED),
    ("knots", 1852.0 / 3600.0, SPEED),
    ("L", 1e-3, &[("m", 3)]),
    ("l", 1e-3, &[("m", 3)]),
    ("litre", 1e-3, &[("m", 3)]),
    ("liter", 1e-3, &[("m", 3)]),
    ("dL", 1e-4, &[("m", 3)]),
    ("mL", 1e-6, &[("m", 3)]),
    ("ml", 1e-6, &[("m", 3)]),
    ("cc", 1e-6, &[("m", 3)]),
    ("gal", 3.785_411_784e-3, &[("m", 3)]),
    ("gpm", 3.785_411_784e-3 / 60.0, VOLUME_FLOW),
    ("lpm", 1e-3 / 60.0, VOLUME_FLOW),
    ("dyn", 1e-5, &[("N", 1)]),
    ("kgf", 9.806_65, &[("N", 1)]),
    ("lbf", 4.448_221_615_260_5, &[("N", 1)]),
    ("bar", 1e5, &[("Pa", 1)]),
    ("mbar", 1e2, &[("Pa", 1)]),
    ("atm", 101_325.0, &[("Pa", 1)]),
    ("psi", 6_894.757_293_168_36, &[("Pa", 1)]),
    ("mmHg", 133.322_387_415, &[("Pa", 1)]),
    ("Torr", 101_325.0 / 760.0, &[("Pa", 1)]),
    ("torr", 101_325.0 / 760.0, &[("Pa", 1)]),
    ("mmH2O", 9.806_65, &[("Pa", 1)]),
    ("cmH2O", 98.0665, &[("Pa", 1)]),
    ("mH2O", 9806.65, &[("Pa", 1)]),
    ("poise", 0.1, VISCOSITY),
    ("cP", 1e-3, VISCOSITY),
    ("cSt", 1e-6, &[("m", 2), ("s", -1)]),
    ("M", 1e3, CONCENTRATION),
    ("mM", 1.0, CONCENTRATION),
    ("uM", 1e-3, CONCENTRATION),
    ("kat", 1.0, &[("mol", 1), ("s", -1)]),
    ("BTU", 1_055.055_852_62, &[("J", 1)]),
    ("ppm", 1e-6, &[]),
    ("Wh", 3600.0, &[("J", 1)]),
    ("kWh", 3.6e6, &[("J", 1)]),
    ("eV", 1.602_176_634e-19, &[("J", 1)]),
    ("cal", 4.184, &[("J", 1)]),
    ("kcal", 4184.0, &[("J", 1)]),
    ("hp", 745.699_871_582_270_2, &[("W", 1)]),
    ("PS", 735.498_75, &[("W", 1)]),
    ("Ah", 3600.0, &[("C", 1)]),
    ("mAh", 3.6, &[("C", 1)]),
];

const TURNING: Factors = &[("rad", 1), ("s", -1)];
const SPEED: Factors = &[("m", 1), ("s", -1)];
const VOLUME_FLOW: Factors = &[("m", 3), ("s", -1)];
const VISCOSITY: Factors = &[("Pa", 1), ("s", 1)];
const CONCENTRATION: Factors = &[("mol", 1), ("m", -3)];

/// Prefixes as powers of ten.
const PREFIXES: &[(&str, i32)] = &[
    ("f", -15),
    ("p", -12),
    ("n", -9),
    ("u", -6),
    ("µ", -6),
    ("μ", -6),
    ("m", -3),
    ("c", -2),
    ("d", -1),
    ("da", 1),
    ("h", 2),
    ("k", 3),
    ("M", 6),
    ("G", 9),
    ("T", 12),
];

/// How dimensions are spelled, the first that fits; others are powers of base units.
const SPELLINGS: &[&[(&str, i32)]] = &[
    &[("N", 1)],
    &[("N", 1), ("m", 1)],
    &[("W", 1)],
    &[("N", 1), ("m", -1)],
    &[("N", 1), ("s", 1), ("m", -1)],
    &[("N", 1), ("s", 1)],
    &[("m", 1), ("s", -1), ("N", -1)],
    &[("N", 1), ("m", 1), ("s", 1)],
    &[("V", 1)],
    &[("ohm", 1)],
    &[("S", 1)],
    &[("F", 1)],
    &[("H", 1)],
    &[("C", 1)],
    &[("Wb", 1)],
    &[("N", 1), ("A", -1)],
    &[("T", 1)],
    &[("Pa", 1)],
    &[("Pa", 1), ("s", 1)],
    &[("Pa", 1), ("s", 1), ("m", -3)],
    &[("Pa", 1), ("m", -3)],
    &[("Pa", 1), ("s", 2), ("m", -3)],
    &[("m", 3), ("Pa", -1)],
    &[("W", 1), ("K", -1)],
    &[("K", 1), ("W", -1)],
    &[("J", 1), ("K", -1)],
];

/// The dimension of a unit.
///
/// # Errors
///
/// A name that is not of SI, or that would scale the values.
pub(super) fn dimension(unit: &Unit) -> Result<Dimension, Box<Diagnostic>> {
    checked(unit, Known::instead)
}

/// The dimension of the unit of a value that is read of the model, which is in SI whatever unit it is given.
///
/// # Errors
///
/// As those of [`dimension`].
pub(super) fn dimension_of_read(unit: &Unit) -> Result<Dimension, Box<Diagnostic>> {
    checked(unit, Known::instead_of_read)
}

/// The dimension of a unit, or a mistake in it with what to type in its place.
fn checked(unit: &Unit, instead: fn(&Known) -> String) -> Result<Dimension, Box<Diagnostic>> {
    let (mut whole, mut apart) = (Known::default(), Known::default());
    let (mut misspelt, mut scaling, mut beside) = (None, None, None);
    for (name, exponent) in &unit.factors {
        let text = name.to_string();
        let known = lookup(&text).map(|known| known.to_power(*exponent));
        let meant = match known {
            Some(known) => known,
            None => {
                misspelt = misspelt.or(Some(name));
                spellings::meant(&text, *exponent).ok_or_else(|| Box::new(unknown(name)))?
            }
        };
        if meant.scales() {
            scaling = scaling.or(Some(name));
        }
        let both = spellings::side_by_side(&text, *exponent);
        beside = beside.or(both.is_some().then_some(name));
        apart.multiply(both.unwrap_or_else(|| meant.clone()));
        whole.multiply(meant);
    }
    if let (None, Some(name)) = (misspelt, beside) {
        let message = format!("`{name}` below a stroke may be one unit or two");
        let report = error(codes::UNIT_SCALE, name.span(), message);
        let second = format!("{} where `{name}` is one unit", instead(&whole));
        return Err(Box::new(report.help(instead(&apart)).help(second)));
    }
    match (misspelt, scaling) {
        (Some(name), _) => Err(Box::new(no_unit(name).help(instead(&whole)))),
        (None, Some(name)) if whole.scales() => {
            let message = format!(
                "values in `{}` are not in SI: `{name}` scales them",
                unit.text
            );
            let report = error(codes::UNIT_SCALE, name.span(), message);
            Err(Box::new(report.help(instead(&whole))))
        }
        _ => Ok(product(&whole.factors)),
    }
}

/// Units with their exponents.
type Factors = &'static [(&'static str, i32)];

/// What names stand for: coherent units with their exponents, and by which power of ten and which factor they scale them.
#[derive(Clone)]
pub(super) struct Known {
    tens: i32,
    scale: f64,
    factors: Vec<(&'static str, i32)>,
}

impl Default for Known {
    fn default() -> Self {
        Self {
            tens: 0,
            scale: 1.0,
            factors: Vec::new(),
        }
    }
}

impl Known {
    pub(super) fn to_power(&self, exponent: i32) -> Self {
        let factors = self.factors.iter();
        Self {
            tens: self.tens * exponent,
            scale: self.scale.powi(exponent),
            factors: factors.map(|(name, own)| (*name, own * exponent)).collect(),
        }
    }

    pub(super) fn multiply(&mut self, other: Self) {
        self.tens += other.tens;
        self.scale *= other.scale;
        self.factors.extend(other.factors);
    }

    /// Whether values would not stay as they are.
    fn scales(&self) -> bool {
        self.tens != 0 || self.scale != 1.0
    }

    /// What to type.
    fn instead(&self) -> String {
        let unit = spell(&self.factors);
        if !self.scales() {
            return format!("write `{unit}`");
        }
        let factor = number(self.scale * 10f64.powi(self.tens));
        format!("write `{unit}`, and each value times {factor}")
    }

    /// What to type for a value that is read.
    fn instead_of_read(&self) -> String {
        let unit = spell(&self.factors);
        if !self.scales() {
            return format!("write `{unit}`");
        }
        format!("write `{unit}`, which is what the value has: what is read is in SI")
    }
}

/// What to type for a number with a unit behind it.
pub(crate) fn without_unit(number_text: &str, unit: &str) -> Option<String> {
    if let Some(value) = with_prefix(number_text, unit) {
        return Some(format!("numbers carry no prefix: write `{value}`"));
    }
    without_units(number_text, &[(unit.to_owned(), 1)])
}

/// What to type for a number with a product of powers of units behind it.
pub(crate) fn without_units(number_text: &str, units: &[(String, i32)]) -> Option<String> {
    let mut known = Known::default();
    for (unit, exponent) in units {
        known.multiply(match lookup(unit) {
            Some(unit) => unit.to_power(*exponent),
            None => spellings::meant(unit, *exponent)?,
        });
    }
    let is_integer = number_text.chars().all(|digit| digit.is_ascii_digit());
    let mut value = number_text.to_owned() + if is_integer { ".0" } else { "" };
    if known.scales() {
        value += &format!(" * {}", number(known.scale * 10f64.powi(known.tens)));
    }
    let unit = spell(&known.factors);
    Some(format!(
        "numbers carry no unit, declarations do, such as `param x: {unit} = …;`: write `{value}`"
    ))
}

/// A number with a prefix alone behind it, as circuits are written: `4.7k`. Letters that are units, too, are not taken for one.
fn with_prefix(number_text: &str, prefix: &str) -> Option<String> {
    let is_exponent = |digit| matches!(digit, 'e' | 'E');
    if coherent(prefix).is_some() || number_text.contains(is_exponent) {
        return None;
    }
    let (_, tens) = PREFIXES.iter().find(|(known, _)| *known == prefix)?;
    Some(format!("{number_text}e{tens}"))
}

/// What a name stands for.
pub(super) fn lookup(name: &str) -> Option<Known> {
    if let Some(name) = coherent(name) {
        return Some(Known {
            factors: vec![(name, 1)],
            ..Known::default()
        });
    }
    if let Some((_, scale, factors)) = SCALED.iter().find(|(known, _, _)| *known == name) {
        return Some(Known {
            scale: *scale,
            factors: factors.to_vec(),
            ..Known::default()
        });
    }
    prefixed(name)
}

/// The name of a unit that scales nothing.
pub(super) fn coherent(name: &str) -> Option<&'static str> {
    let known = COHERENT.iter().find(|(known, _)| *known == name)?;
    Some(known.0)
}

/// Such a unit in other letter case.
pub(super) fn in_other_case(name: &str) -> Option<&'static str> {
    let mut names = COHERENT.iter().map(|(known, _)| *known);
    names.find(|known| known.eq_ignore_ascii_case(name))
}

/// A unit with a prefix.
pub(super) fn prefixed(name: &str) -> Option<Known> {
    PREFIXES.iter().find_map(|(prefix, tens)| {
        let rest = name.strip_prefix(prefix)?;
        let (tens, rest) = if rest == "g" {
            (tens - 3, "kg")
        } else {
            (*tens, rest)
        };
        let unit = coherent(rest)?;
        // A kilogram has its prefix already, and a pure number has none.
        let plain = name.ends_with(unit) && unit == "kg" || unit == "sr";
        (!plain).then(|| Known {
            tens,
            factors: vec![(unit, 1)],
            ..Known::default()
        })
    })
}

fn no_unit(name: &Ident) -> Diagnostic {
    let message = format!("`{name}` is not a unit of SI");
    error(codes::UNIT_NAME, name.span(), message)
}

/// Types of other languages, where a unit stands here.
const TYPES: &[&str] = &[
    "f64", "f32", "float", "double", "real", "Real", "number", "int", "Integer", "i32", "usize",
    "u32", "bool", "Boolean",
];

/// A name of which it cannot be told what was meant: one that differs by a letter may be another quantity.
fn unknown(name: &Ident) -> Diagnostic {
    let text = name.to_string();
    if matches!(text.as_str(), "degC" | "celsius" | "degF") {
        let message =
            format!("`{text}` has its zero elsewhere: values in it are no temperatures in SI");
        let report = error(codes::UNIT_SCALE, name.span(), message);
        return report.help(
            "write `K`, and temperatures above absolute zero: 20 degrees Celsius are 293.15",
        );
    }
    if TYPES.contains(&text.as_str()) {
        let help = "a colon is before a unit, and every value is a number: leave the colon and the type out";
        return no_unit(name).help(help);
    }
    let coherent: Vec<&str> = COHERENT.iter().map(|(name, _)| *name).collect();
    let help = format!("units are products of powers of {}", coherent.join(", "));
    no_unit(name).help(help)
}

fn product(factors: &[(&str, i32)]) -> Dimension {
    factors
        .iter()
        .fold(Dimension::pure(), |product, (name, power)| {
            let exponents = COHERENT.iter().find(|(known, _)| known == name);
            let factor =
                exponents.map_or_else(Dimension::pure, |(_, exponents)| Dimension::of(*exponents));
            product.times_power(&factor, Ratio::new((*power).into(), 1))
        })
}

/// A dimension as people write it.
pub(super) fn text(dimension: &Dimension) -> String {
    match SPELLINGS
        .iter()
        .find(|factors| product(factors) == *dimension)
    {
        Some(factors) => spell(factors),
        None => dimension.text(),
    }
}

/// `N*m/s^2`.
fn spell<S: AsRef<str>>(factors: &[(S, i32)]) -> String {
    let side = |sign: i32| -> Vec<String> {
        let own = factors.iter().filter(|(_, power)| power * sign > 0);
        own.map(|(name, power)| match power.abs() {
            1 => name.as_ref().to_owned(),
            power => format!("{}^{power}", name.as_ref()),
        })
        .collect()
    };
    let (above, below) = (side(1), side(-1));
    let above = if above.is_empty() {
        "1".to_owned()
    } else {
        above.join("*")
    };
    let mut text = above;
    for factor in below {
        text.push('/');
        text.push_str(&factor);
    }
    text
}

/// `m/s^2`, the unit of gravity.
pub(crate) fn acceleration() -> Unit {
    let name = |text: &str| Ident::new(text, Span::call_site());
    Unit {
        text: "m/s^2".to_owned(),
        factors: vec![(name("m"), 1), (name("s"), -2)],
    }
}
