//! The spellings of SI, and how a dimension is spelled.
//!
//! Values are never converted: a unit that would scale them is refused with the text to type instead, since a parameter
//! `5.0` that silently becomes `0.005` is worse than a mistake. The radian and the steradian are pure numbers, kept in the
//! spelling; the hertz is one per second, without a turn in it.

use proc_macro2::{Ident, Span};

use super::dimension::{Dimension, Ratio};
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
const SCALED: &[(&str, f64, &str)] = &[
    ("g", 1e-3, "kg"),
    ("t", 1e3, "kg"),
    ("min", 60.0, "s"),
    ("h", 3600.0, "s"),
    ("d", 86400.0, "s"),
    ("deg", std::f64::consts::PI / 180.0, "rad"),
    ("rev", std::f64::consts::TAU, "rad"),
    ("rpm", std::f64::consts::TAU / 60.0, "rad/s"),
    ("L", 1e-3, "m^3"),
    ("l", 1e-3, "m^3"),
    ("bar", 1e5, "Pa"),
    ("mbar", 1e2, "Pa"),
    ("atm", 101_325.0, "Pa"),
    ("Wh", 3600.0, "J"),
    ("kWh", 3.6e6, "J"),
    ("eV", 1.602_176_634e-19, "J"),
    ("ft", 0.3048, "m"),
];

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
    let mut dimension = Dimension::pure();
    let (mut tens, mut scale, mut scaling) = (0, 1.0, None);
    let mut instead: Vec<(String, i32)> = Vec::new();
    for (name, exponent) in &unit.factors {
        let Some(known) = lookup(&name.to_string()) else {
            return Err(Box::new(unknown(name)));
        };
        dimension = dimension.times_power(&known.dimension, Ratio::new((*exponent).into(), 1));
        tens += known.tens * exponent;
        scale *= known.scale.powi(*exponent);
        if known.tens != 0 || known.scale != 1.0 {
            scaling = scaling.or(Some(name));
        }
        let factors = known.factors.into_iter();
        instead.extend(factors.map(|(name, power)| (name.to_owned(), power * exponent)));
    }
    match scaling {
        Some(name) if tens != 0 || scale != 1.0 => {
            let factor = number(scale * 10f64.powi(tens));
            let message = format!(
                "values in `{}` are not in SI: `{name}` scales them",
                unit.text
            );
            let help = format!("write `{}`, and each value times {factor}", spell(&instead));
            Err(Box::new(
                error(codes::UNIT_SCALE, name.span(), message).help(help),
            ))
        }
        _ => Ok(dimension),
    }
}

/// What a name stands for: a dimension, and by which power of ten and which factor it scales what to type instead.
struct Known {
    dimension: Dimension,
    tens: i32,
    scale: f64,
    factors: Vec<(&'static str, i32)>,
}

fn lookup(name: &str) -> Option<Known> {
    if let Some((name, exponents)) = COHERENT.iter().find(|(known, _)| *known == name) {
        return Some(Known {
            dimension: Dimension::of(*exponents),
            tens: 0,
            scale: 1.0,
            factors: vec![(name, 1)],
        });
    }
    if let Some((_, scale, instead)) = SCALED.iter().find(|(known, _, _)| *known == name) {
        let factors = match *instead {
            "m^3" => vec![("m", 3)],
            "rad/s" => vec![("rad", 1), ("s", -1)],
            plain => vec![(plain, 1)],
        };
        return Some(Known {
            dimension: product(&factors),
            tens: 0,
            scale: *scale,
            factors,
        });
    }
    PREFIXES.iter().find_map(|(prefix, tens)| {
        let rest = name.strip_prefix(prefix)?;
        let (tens, rest) = if rest == "g" {
            (tens - 3, "kg")
        } else {
            (*tens, rest)
        };
        let prefixed = *COHERENT.iter().find(|(known, _)| *known == rest)?;
        // A kilogram has its prefix already, and a pure number has none.
        let plain = name.ends_with(prefixed.0) && prefixed.0 == "kg" || prefixed.0 == "sr";
        (!plain).then(|| Known {
            dimension: Dimension::of(prefixed.1),
            tens,
            scale: 1.0,
            factors: vec![(prefixed.0, 1)],
        })
    })
}

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
    let report = error(
        codes::UNIT_NAME,
        name.span(),
        format!("`{text}` is not a unit of SI"),
    );
    let coherent: Vec<&str> = COHERENT.iter().map(|(name, _)| *name).collect();
    if text == "Ω" || text == "Ohm" || text == "Ohms" {
        return report.help("write `ohm`");
    }
    let report = report.did_you_mean(&text, &coherent);
    if report.helps.is_empty() {
        let help = format!("units are products of powers of {}", coherent.join(", "));
        return report.help(help);
    }
    report
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
