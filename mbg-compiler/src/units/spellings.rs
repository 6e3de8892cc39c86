//! Units as people spell them elsewhere: by their words, in other letter case, or written together.

use super::names::{Known, coherent, in_other_case, lookup, prefixed};

/// Words and signs, and the units for which they stand.
const WORDS: &[(&str, &str)] = &[
    ("kilogram", "kg"),
    ("kgs", "kg"),
    ("meter", "m"),
    ("metre", "m"),
    ("sec", "s"),
    ("second", "s"),
    ("amp", "A"),
    ("ampere", "A"),
    ("kelvin", "K"),
    ("rad", "rad"),
    ("radian", "rad"),
    ("hertz", "Hz"),
    ("newton", "N"),
    ("pascal", "Pa"),
    ("joule", "J"),
    ("watt", "W"),
    ("coulomb", "C"),
    ("volt", "V"),
    ("Ω", "ohm"),
    ("ohm", "ohm"),
    ("siemens", "S"),
    ("farad", "F"),
    ("weber", "Wb"),
    ("tesla", "T"),
    ("henry", "H"),
];

/// More letters than these are no product of units.
const LONGEST: usize = 12;

/// What was probably meant by a name that is no unit, with the exponent behind it.
pub(super) fn meant(name: &str, exponent: i32) -> Option<Known> {
    word(name)
        .or_else(|| other_case(name))
        .or_else(|| capital_kilo(name))
        .map(|known| known.to_power(exponent))
        .or_else(|| together(name, exponent))
}

/// The two units of `W/mK`, which is hardly ever a watt per millikelvin.
pub(super) fn side_by_side(name: &str, exponent: i32) -> Option<Known> {
    if name != "mK" || exponent >= 0 {
        return None;
    }
    let mut both = lookup("m")?.to_power(-1);
    both.multiply(lookup("K")?.to_power(exponent));
    Some(both)
}

/// `sec`, `Ohms`, `radians`.
fn word(name: &str) -> Option<Known> {
    let lower = name.to_lowercase();
    let singular = lower.strip_suffix('s').unwrap_or(&lower);
    let known = WORDS
        .iter()
        .find(|(word, _)| [lower.as_str(), singular].contains(&word.to_lowercase().as_str()));
    known.and_then(|(_, unit)| lookup(unit))
}

/// `HZ`, `pa`, `v`; a single capital letter may be anything.
fn other_case(name: &str) -> Option<Known> {
    let capital = name.chars().count() == 1 && name.chars().all(char::is_uppercase);
    let unit = in_other_case(name).filter(|_| !capital)?;
    lookup(unit)
}

/// `KN`; `Km` and `Ks` may be kelvin times something.
fn capital_kilo(name: &str) -> Option<Known> {
    let rest = name.strip_prefix('K')?;
    let kilo = lookup(&format!("k{rest}"));
    kilo.filter(|_| !matches!(rest, "m" | "s"))
}

/// A unit in a name of several, and the digit behind it.
#[derive(Clone)]
struct Piece<'a> {
    name: &'a str,
    prefixed: bool,
    power: Option<i32>,
}

/// `Nm`, `kgm2`, `m3`. An exponent belongs to the last unit, as in `kgm^2`; a name below a stroke is there as a whole.
fn together(name: &str, exponent: i32) -> Option<Known> {
    if name.chars().count() > LONGEST {
        return None;
    }
    let mut ways = Vec::new();
    split(name, &mut Vec::new(), &mut ways);
    // `Nms` is N*m*s rather than N*ms, and `mNm` mN*m.
    let mut pieces = ways.into_iter().min_by_key(|pieces| {
        let later = pieces.iter().skip(1).filter(|piece| piece.prefixed).count();
        let all = pieces.iter().filter(|piece| piece.prefixed).count();
        (later, all, pieces.len())
    })?;
    if let Some(last) = pieces.last_mut() {
        last.power = last.power.or(Some(exponent.abs()));
    }
    let mut known = Known::default();
    for piece in &pieces {
        let power = piece.power.unwrap_or(1) * exponent.signum();
        known.multiply(lookup(piece.name)?.to_power(power));
    }
    Some(known)
}

/// All ways to read a name as units side by side, none of them twice: nobody writes `mm` for a square.
fn split<'a>(name: &'a str, pieces: &mut Vec<Piece<'a>>, ways: &mut Vec<Vec<Piece<'a>>>) {
    if name.is_empty() {
        ways.push(pieces.clone());
        return;
    }
    let ends = name
        .char_indices()
        .map(|(start, letter)| start + letter.len_utf8());
    for end in ends {
        let (head, rest) = name.split_at(end);
        let prefixed = coherent(head).is_none();
        let is_unit = !prefixed || self::prefixed(head).is_some();
        if !is_unit || pieces.iter().any(|piece| piece.name == head) {
            continue;
        }
        let digit = rest.chars().next().and_then(|letter| letter.to_digit(10));
        let power = digit.and_then(|digit| i32::try_from(digit).ok());
        pieces.push(Piece {
            name: head,
            prefixed,
            power,
        });
        split(&rest[usize::from(power.is_some())..], pieces, ways);
        pieces.pop();
    }
}
