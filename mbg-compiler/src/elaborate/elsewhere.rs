//! Words of other languages and tools, and what is written here instead.

use proc_macro2::{Delimiter, Group, Span, TokenStream, TokenTree};
use quote::ToTokens;
use syn::spanned::Spanned;
use syn::{BinOp, Expr, ExprBinary, Lit, Member, Stmt, UnOp};

use super::constants::plain_name;
use super::indices::component_index;
use super::tools::plain;
use crate::symbolic::LARGEST_POWER;
use crate::syntax::dump;
use crate::units::without_units;

/// The number π, as constants of other languages round it.
const PI: &str = "3.141592653589793";

/// One of two values.
const CHOICE: &str = "(if a { b } else { c })";

/// What is zero up to a width on both sides.
const DEAD_ZONE: &str = "(max(x - width, 0.0) + min(x + width, 0.0))";

/// A curve by its points.
const CURVE: &str = "interpolate(x, places, values)";

/// A root, of negative values an odd one.
const ROOT: &str = "(sign(x) * pow(abs(x), 1.0 / n))";

/// A root, of negative values that of their size with their sign: runs go on along zero where its slope is infinite.
const SIGNED_ROOT: &str = "(sign(x) * sqrt(abs(x)))";

const ASINH: &str = "ln(x + sqrt(x * x + 1))";
const ACOSH: &str = "ln(x + sqrt(x * x - 1))";
const ATANH: &str = "(ln((1 + x) / (1 - x)) / 2)";

/// A word, its arguments, and what is written here: in parentheses where another operator could come between.
const WORDS: &[(&str, &[&str], &str)] = &[
    ("pi", &[], PI),
    ("PI", &[], PI),
    ("π", &[], PI),
    ("tau", &[], "6.283185307179586"),
    ("time", &[], "t"),
    ("g", &[], "9.81"),
    ("g_n", &[], "9.80665"),
    ("euler", &["q"], "angles_of(matrix_of(q), 2, 1, 0)"),
    ("eulerangles", &["q"], "angles_of(matrix_of(q), 2, 1, 0)"),
    ("rpy", &["q"], "angles_of(matrix_of(q), 2, 1, 0)"),
    ("arctan", &["x"], "atan(x)"),
    ("arctan2", &["y", "x"], "atan2(y, x)"),
    ("arcsin", &["x"], "asin(x)"),
    ("arccos", &["x"], "acos(x)"),
    ("ceil", &["x"], "-floor(-x)"),
    ("round", &["x"], "floor(x + 0.5)"),
    ("trunc", &["x"], "(sign(x) * floor(abs(x)))"),
    ("frac", &["x"], "fraction(x)"),
    ("fract", &["x"], "fraction(x)"),
    // Of the sign of `x` elsewhere, where `mod` is of that of `y`.
    ("fmod", &["x", "y"], "(sign(x) * mod(abs(x), abs(y)))"),
    ("rem", &["x", "y"], "(sign(x) * mod(abs(x), abs(y)))"),
    ("remainder", &["x", "y"], "(x - y * floor(x / y + 0.5))"),
    ("div", &["x", "y"], "(sign(x / y) * floor(abs(x / y)))"),
    ("integer", &["x"], "floor(x)"),
    ("sqr", &["x"], "powi(x, 2)"),
    ("cbrt", &["x"], "(sign(x) * pow(abs(x), 1.0 / 3.0))"),
    ("root", &["x"], "sqrt(x)"),
    ("root", &["x", "n"], ROOT),
    ("nthroot", &["x", "n"], ROOT),
    ("regRoot", &["x"], SIGNED_ROOT),
    ("regRoot", &["x", "delta"], SIGNED_ROOT),
    ("regSquare", &["x"], "(x * abs(x))"),
    ("noEvent", &["x"], "x"),
    ("smooth", &["order", "x"], "x"),
    ("homotopy", &["x", "simplified"], "x"),
    (
        "semiLinear",
        &["x", "a", "b"],
        "(a * max(x, 0.0) + b * min(x, 0.0))",
    ),
    ("rem_euclid", &["x", "y"], "mod(x, abs(y))"),
    ("modulo", &["x", "y"], "mod(x, y)"),
    ("sinh", &["x"], "((exp(x) - exp(-x)) / 2)"),
    ("cosh", &["x"], "((exp(x) + exp(-x)) / 2)"),
    ("asinh", &["x"], ASINH),
    ("arsinh", &["x"], ASINH),
    ("acosh", &["x"], ACOSH),
    ("arcosh", &["x"], ACOSH),
    ("atanh", &["x"], ATANH),
    ("artanh", &["x"], ATANH),
    ("expm1", &["x"], "(exp(x) - 1)"),
    ("log1p", &["x"], "ln(1 + x)"),
    ("ln_1p", &["x"], "ln(1 + x)"),
    ("log", &["x"], "ln(x)"),
    ("log10", &["x"], "(ln(x) / ln(10.0))"),
    ("log2", &["x"], "(ln(x) / ln(2.0))"),
    ("hypot", &["x", "y"], "sqrt(x * x + y * y)"),
    ("sgn", &["x"], "sign(x)"),
    ("signum", &["x"], "sign(x)"),
    ("fabs", &["x"], "abs(x)"),
    ("clamp", &["x", "a", "b"], "min(max(x, a), b)"),
    ("saturate", &["x", "a", "b"], "min(max(x, a), b)"),
    ("saturation", &["x", "a", "b"], "min(max(x, a), b)"),
    ("sat", &["x", "a", "b"], "min(max(x, a), b)"),
    ("limit", &["x", "a", "b"], "min(max(x, a), b)"),
    ("ifelse", &["a", "b", "c"], CHOICE),
    ("select", &["a", "b", "c"], CHOICE),
    ("iif", &["a", "b", "c"], CHOICE),
    ("piecewise", &["a", "b", "c"], CHOICE),
    ("deadzone", &["x", "width"], DEAD_ZONE),
    ("deadband", &["x", "width"], DEAD_ZONE),
    ("interp", &["x", "places", "values"], CURVE),
    ("lookup", &["x", "places", "values"], CURVE),
    ("table", &["x", "places", "values"], CURVE),
    ("lookup1d", &["x", "places", "values"], CURVE),
    ("tablelookup", &["x", "places", "values"], CURVE),
    ("CombiTable1D", &["x", "places", "values"], CURVE),
    ("CombiTable1Ds", &["x", "places", "values"], CURVE),
    ("interp1", &["places", "values", "x"], CURVE),
    (
        "pwm",
        &["time", "duty", "period"],
        "(if mod(time, period) < duty * period { 1.0 } else { 0.0 })",
    ),
    ("cross", &["a", "b"], "skew(a) * b"),
    ("dot", &["a", "b"], "(transpose(a) * b)"),
    ("norm", &["a"], "sqrt(transpose(a) * a)"),
    ("length", &["a"], "sqrt(transpose(a) * a)"),
    ("magnitude", &["a"], "sqrt(transpose(a) * a)"),
    ("to_radians", &["x"], "(0.017453292519943295 * x)"),
    ("radians", &["x"], "(0.017453292519943295 * x)"),
    ("deg2rad", &["x"], "(0.017453292519943295 * x)"),
    ("to_degrees", &["x"], "(57.29577951308232 * x)"),
    ("degrees", &["x"], "(57.29577951308232 * x)"),
    ("rad2deg", &["x"], "(57.29577951308232 * x)"),
];

/// What limits how fast a value changes, and what limits an integral.
const SLEWS: &[&str] = &[
    "ratelimit",
    "ratelimiter",
    "slewrate",
    "slewratelimiter",
    "slew",
];
const LIMITED: &[&str] = &["limint", "limintegrate", "limitedintegral"];

/// Functions that keep what was, their arguments, and the integral that is declared in their place, for its name `late`.
const DECLARED: &[(&[&str], &[&str], &str)] = &[
    (
        SLEWS,
        &["x", "rate"],
        "late = min(max((x - late) / 1e-3, -rate), rate)",
    ),
    (
        SLEWS,
        &["x", "up", "down"],
        "late = min(max((x - late) / 1e-3, down), up)",
    ),
    (
        &["lowpass", "lag", "pt1", "firstorder"],
        &["x", "time"],
        "late = (x - late) / time",
    ),
    (
        LIMITED,
        &["x", "lower", "upper"],
        "late = if late > upper { min(x, 0.0) } else if late < lower { max(x, 0.0) } else { x }",
    ),
    (
        LIMITED,
        &["x", "lower", "upper", "start"],
        "late = if late > upper { min(x, 0.0) } else if late < lower { max(x, 0.0) } else { x }, initial: start",
    ),
];

/// What to type for a number with units behind it, as in `3kN / m`.
pub(super) fn without_units_behind(expression: &Expr) -> Option<String> {
    let (number, units) = with_units(expression)?;
    without_units(&number, &units)
}

/// A number with the units that are written behind it, and their exponents.
fn with_units(expression: &Expr) -> Option<(String, Vec<(String, i32)>)> {
    match expression {
        Expr::Lit(it) => {
            let (number, unit) = match &it.lit {
                Lit::Int(it) => (it.base10_digits(), it.suffix()),
                Lit::Float(it) => (it.base10_digits(), it.suffix()),
                _ => return None,
            };
            (!unit.is_empty()).then(|| (number.to_owned(), vec![(unit.to_owned(), 1)]))
        }
        Expr::Binary(ExprBinary {
            left, op, right, ..
        }) => {
            let exponent = match op {
                BinOp::Mul(_) => 1,
                BinOp::Div(_) => -1,
                _ => return None,
            };
            let Expr::Path(unit) = &**right else {
                return None;
            };
            let (number, mut units) = with_units(left)?;
            units.push((unit.path.get_ident()?.to_string(), exponent));
            Some((number, units))
        }
        _ => None,
    }
}

/// What to declare for a function that keeps what was.
fn declared(word: &str, arguments: &[Expr]) -> Option<String> {
    let word = plain(word);
    let mut known = DECLARED.iter();
    let (_, places, text) = known.find(|(words, places, _)| {
        words.contains(&word.as_str()) && places.len() == arguments.len()
    })?;
    let mut places: Vec<(&str, &Expr)> = places.iter().copied().zip(arguments).collect();
    // Some tools give the lower limit first.
    if let [_, ("up", up), ("down", down)] = &mut places[..]
        && number(up) < Some(0.0)
        && number(up).is_some()
    {
        std::mem::swap(up, down);
    }
    Some(format!(
        "what keeps what was is declared: write `integral {};`, and read `late`",
        filled(text, &places)
    ))
}

/// A curve that is given by its points, `[[x, y], …]`, by its places and values.
pub(super) fn curve_of_points(arguments: &[Expr]) -> Option<String> {
    let [x, Expr::Array(points)] = arguments else {
        return None;
    };
    let mut columns = [Vec::new(), Vec::new()];
    for point in &points.elems {
        let entries = match point {
            Expr::Array(point) => &point.elems,
            Expr::Tuple(point) => &point.elems,
            _ => return None,
        };
        if entries.len() != columns.len() {
            return None;
        }
        for (column, entry) in columns.iter_mut().zip(entries) {
            column.push(dump::expression(entry));
        }
    }
    let [places, values] = columns.map(|column| column.join(", "));
    let x = dump::expression(x);
    Some(format!("interpolate({x}, [{places}], [{values}])"))
}

/// A map of two variables as a curve over one of curves over the other. What is looked up comes first or, as in MATLAB, last.
pub(super) fn map(arguments: &[Expr]) -> Option<String> {
    let [first, second, third, fourth, fifth] = arguments else {
        return None;
    };
    let (over, along, values) = match first {
        Expr::Array(_) => ([fifth, second], [fourth, first], third),
        _ => ([first, third], [second, fourth], fifth),
    };
    let counts = [over[1], along[1], values].map(|it| match it {
        Expr::Array(list) => Some(list.elems.len()),
        _ => None,
    });
    // A row for each place of the other variable.
    let is_turned = counts[2].is_some() && counts[0] != counts[2] && counts[1] == counts[2];
    let (over, along) = if is_turned {
        (along, over)
    } else {
        (over, along)
    };
    let [x, places, y, others] = [over[0], over[1], along[0], along[1]].map(dump::expression);
    let row = |row: String| format!("interpolate({y}, {others}, {row})");
    let rows: Vec<String> = match (values, counts[0]) {
        (Expr::Array(rows), _) => rows.elems.iter().map(dump::expression).map(row).collect(),
        (table, count) => {
            let table = dump::expression(table);
            let rows = (0..count.unwrap_or(1)).map(|number| row(format!("{table}[{number}]")));
            let more = count.is_none().then(|| "…".to_owned());
            rows.chain(more).collect()
        }
    };
    let rows = rows.join(", ");
    Some(format!(
        "a map is a curve of curves: write `interpolate({x}, {places}, [{rows}])`"
    ))
}

/// What stands behind a word, or a place for it.
pub(super) fn value_text(value: Option<&Expr>) -> String {
    value.map_or_else(|| "…".to_owned(), dump::expression)
}

/// What the words of a choice are called elsewhere, and here.
const CHOICES: &[(&[&str], &str)] = &[
    (&["euler", "euler_angles", "rpy", "cardan"], "angles"),
    (&["quat", "quaternions"], "quaternion"),
    (&["dcm", "rotation", "rotation_matrix"], "matrix"),
];

/// The word of a choice that has this name elsewhere.
pub(super) fn choice(word: &str) -> Option<&'static str> {
    let word = word.to_lowercase();
    let mut choices = CHOICES.iter();
    let (_, here) = choices.find(|(words, _)| words.contains(&word.as_str()))?;
    Some(here)
}

/// Functions whose values do not follow from their arguments alone.
const OUTSIDE: &[&str] = &[
    "noise",
    "white_noise",
    "random",
    "rand",
    "randn",
    "gauss",
    "sample",
    "hold",
    "zoh",
];

/// What to type here for a word of another language with these arguments.
pub(super) fn instead(word: &str, arguments: &[Expr]) -> Option<String> {
    match (word, arguments) {
        ("inverse" | "inv", [matrix]) => return Some(inverse(matrix)),
        ("powf", [base, exponent]) => return Some(power(base, exponent)),
        ("der" | "ddt" | "dt" | "derivative", [of]) => return Some(rate(of)),
        ("integral" | "integrate" | "int" | "resint", [of]) => return Some(integral(of, None)),
        ("integral" | "integrate" | "int" | "resint", [of, initial]) => {
            return Some(integral(of, Some(initial)));
        }
        ("step" | "heaviside" | "Heaviside", [since]) => return Some(step(since)),
        ("step" | "heaviside" | "Heaviside", [time, at]) => return Some(step_at(time, at)),
        ("delay" | "tdelay", [value, by]) => return Some(delay(value, by)),
        ("delay", [value, by, _longest]) => return Some(delay(value, by)),
        ("energy" | "power", []) => return Some(of_system(word)),
        (
            "interp2" | "interp2d" | "interpolate2" | "interpolate2d" | "interpolate_2d"
            | "lookup2" | "lookup2d" | "lookup_2d" | "table2d" | "map2d" | "CombiTable2D"
            | "CombiTable2Ds",
            [_, _, _, _, _],
        ) => return map(arguments),
        ("vec" | "vec2" | "vec3" | "vector" | "array" | "Vector3", entries) => {
            let entries: Vec<String> = entries.iter().map(dump::expression).collect();
            return Some(format!("write `[{}]`", entries.join(", ")));
        }
        _ if OUTSIDE.contains(&word) => {
            return Some(
                "what is random or sampled comes from outside: declare an `input`, and give its values by `Sampled::held`"
                    .to_owned(),
            );
        }
        _ => {}
    }
    if let Some(help) = declared(word, arguments) {
        return Some(help);
    }
    let known = || WORDS.iter().filter(|(known, ..)| is_same(known, word));
    let fitting = known().find(|(_, places, _)| places.len() == arguments.len());
    let (_, places, text) = fitting.or_else(|| known().next())?;
    // Both orders are written elsewhere.
    let places: &[&str] = match arguments {
        [Expr::Array(_), Expr::Array(_), _] if *text == CURVE => &["places", "values", "x"],
        [_, Expr::Array(_), Expr::Array(_)] if *text == CURVE => &["x", "places", "values"],
        _ => places,
    };
    if places.len() != arguments.len() {
        let places = places.join(", ");
        return Some(format!("for `{word}({places})` write `{text}`"));
    }
    let places: Vec<(&str, &Expr)> = places.iter().copied().zip(arguments).collect();
    Some(format!(
        "write `{}`",
        filled(&without_signs(text, &places), &places)
    ))
}

/// A text in which the magnitudes of numbers are these.
fn without_signs(text: &str, places: &[(&str, &Expr)]) -> String {
    let numbers = places
        .iter()
        .filter_map(|(place, value)| Some((place, number(value)?)));
    numbers.fold(text.to_owned(), |text, (place, number)| {
        text.replace(&format!("abs({place})"), &format!("{:?}", number.abs()))
    })
}

/// Whether these are one word in the spellings of two tools; letters alone differ by their capitals.
fn is_same(known: &str, word: &str) -> bool {
    known == word || known.len() > 2 && plain(known) == plain(word)
}

/// What to type for an expression of Rust that no law is.
pub(super) fn of_rust(expression: &Expr) -> Option<String> {
    match expression {
        Expr::Match(choice) => {
            let of = dump::expression(&choice.expr);
            Some(format!("write `if {of} < … {{ … }} else {{ … }}`"))
        }
        // `|v| * w`, in Rust a closure.
        Expr::Closure(bars) => {
            let inside: Vec<String> = bars
                .inputs
                .iter()
                .map(|it| it.to_token_stream().to_string())
                .collect();
            Some(format!(
                "a magnitude is written `abs({})`",
                inside.join(", ")
            ))
        }
        Expr::Macro(list) if list.mac.path.is_ident("vec") => Some(format!(
            "write `[{}]`",
            dump::tokens(list.mac.tokens.clone())
        )),
        Expr::Tuple(list) => {
            let entries: Vec<String> = list.elems.iter().map(dump::expression).collect();
            Some(format!("write `[{}]`", entries.join(", ")))
        }
        _ => None,
    }
}

/// What to type for the inverse of a matrix: laws have that of a rotation, and elements take that of another.
fn inverse(matrix: &Expr) -> String {
    let (rotation, matrix) = (
        filled("transpose(x)", &[("x", matrix)]),
        dump::expression(matrix),
    );
    format!(
        "of a rotation write `{rotation}`; of another matrix an element finds it: `R name {{ conductance: {matrix} }}` has the \
         resistance that is its inverse, and an `I` gives its flow by `inertia`"
    )
}

/// What to read or declare where a rate is meant. Nothing differentiates an input.
fn rate(of: &Expr) -> String {
    let text = dump::expression(of);
    let of_state = |state: &str, rate: &str| {
        let owner = text.strip_suffix(state)?;
        Some(format!("the rate of `{text}` is `{owner}{rate}`"))
    };
    if let Some(help) = of_state(".q", ".f").or_else(|| of_state(".p", ".e")) {
        return help;
    }
    let rule = "laws take no derivatives";
    if is_flow_or_effort(of) {
        let lag = filled("(x - late) / 1e-3", &[("x", of)]);
        return format!(
            "{rule}: the flow of an element `I` has the rate `….e / inertia`, and `System::derivative` gives the rates of \
             all states; for that of `{text}` behind a lag of a millisecond write `integral late = {lag};`, and read `{lag}`"
        );
    }
    match plain_name(of) {
        Some(name) => format!(
            "{rule}: an integral has the rate that it is declared with; where `{name}` is an input, give its rate in its place, \
             `input {name}_rate; integral {name} = {name}_rate;`, and read `{name}_rate`"
        ),
        None => format!("{rule}: read the flow `….f` or the effort `….e` that is this rate"),
    }
}

/// Whether this reads a flow, an effort or a component of one.
fn is_flow_or_effort(read: &Expr) -> bool {
    match read {
        Expr::Index(indexed) => is_flow_or_effort(&indexed.expr),
        Expr::Field(field) => match &field.member {
            Member::Named(name) if component_index(name).is_some() => {
                is_flow_or_effort(&field.base)
            }
            Member::Named(name) => name == "f" || name == "e",
            Member::Unnamed(_) => false,
        },
        _ => false,
    }
}

/// What to declare where an integral is meant.
fn integral(of: &Expr, initial: Option<&Expr>) -> String {
    let rate = dump::expression(of);
    let initial = initial.map(dump::expression);
    let initial = initial.map_or_else(String::new, |initial| format!(", initial: {initial}"));
    format!("an integral is declared: write `integral name = {rate}{initial};`, and read `name`")
}

/// Where the energy of a whole model and its rate are found.
fn of_system(word: &str) -> String {
    let of = match word {
        "energy" => "what all storages hold",
        _ => "the rate of what all storages hold",
    };
    format!("`System::{word}` gives {of} at a state: no output is needed for it")
}

/// What to type for zero before a time and one after it.
fn step(since: &Expr) -> String {
    let (text, places) = match bare(since) {
        Expr::Binary(binary) if matches!(binary.op, BinOp::Sub(_)) => {
            let places = vec![("a", &*binary.left), ("b", &*binary.right)];
            ("(if a < b { 0.0 } else { 1.0 })", places)
        }
        // Of a number alone, it is that of the time.
        since if number(since).is_some() => ("(if t < a { 0.0 } else { 1.0 })", vec![("a", since)]),
        since => ("(if a < 0.0 { 0.0 } else { 1.0 })", vec![("a", since)]),
    };
    or_from_outside(&filled(text, &places))
}

/// The same of a time and that of the jump.
fn step_at(time: &Expr, jump: &Expr) -> String {
    let places = [("a", time), ("b", jump)];
    or_from_outside(&filled("(if a < b { 0.0 } else { 1.0 })", &places))
}

fn or_from_outside(choice: &str) -> String {
    format!(
        "write `{choice}`, or give it from outside, by an `input` that tells when it jumps, as a `Pulse` does"
    )
}

/// What to type for a value of the past, which nothing keeps.
fn delay(value: &Expr, by: &Expr) -> String {
    let lag = filled("(x - late) / d", &[("x", value), ("d", by)]);
    format!(
        "nothing keeps values of the past: write `late` for a lag of first order, `integral late = {lag};`, or delay the \
         value outside and give it by an `input`"
    )
}

/// What to type for a power.
pub(super) fn power(base: &Expr, exponent: &Expr) -> String {
    let places = [("x", base), ("n", exponent)];
    match number(exponent) {
        Some(0.5) => format!("write `{}`", filled("sqrt(x)", &places)),
        Some(whole) if whole.fract() == 0.0 && whole.abs() <= LARGEST_POWER => {
            format!("write `{}`", filled(&format!("powi(x, {whole})"), &places))
        }
        _ => {
            let (text, base) = (filled("pow(x, n)", &places), dump::expression(base));
            format!("write `{text}`, where `{base}` is not negative")
        }
    }
}

/// What to type for a power that is written as an operator. Other operators bind tighter or looser than a power does
/// elsewhere: only what stands next to the sign was meant.
pub(super) fn power_operator(left: &Expr, right: &Expr) -> String {
    power(last(left), first(right))
}

/// Whether this is `x ** y`: a product with what `y` points to.
pub(super) fn is_double_star(binary: &ExprBinary) -> bool {
    matches!(binary.op, BinOp::Mul(_)) && starred(&binary.right).is_some()
}

/// What stands behind the second star.
fn starred(right: &Expr) -> Option<&Expr> {
    match right {
        Expr::Unary(unary) if matches!(unary.op, UnOp::Deref(_)) => Some(&unary.expr),
        _ => None,
    }
}

/// What to type where a quaternion is to turn a vector.
pub(super) fn by_quaternion(product: &ExprBinary) -> String {
    let places = [("q", &*product.left), ("v", &*product.right)];
    let text = filled("matrix_of(q) * v", &places);
    format!("to turn a vector by a quaternion write `{text}`")
}

/// What to type where two vectors are to give a number.
pub(super) fn by_scalar_product(product: &ExprBinary) -> String {
    let places = [("a", &*product.left), ("b", &*product.right)];
    let text = filled("transpose(a) * b", &places);
    format!("for the number that two vectors give write `{text}`")
}

/// A vector of roll, pitch and yaw as the turns that it stands for, the first innermost, as URDF has them.
pub(super) fn turns(angles: &Expr) -> Option<String> {
    let Expr::Array(angles) = bare(angles) else {
        return None;
    };
    let names = ["x", "y", "z"];
    if angles.elems.len() != names.len() {
        return None;
    }
    let turns = names.iter().zip(&angles.elems).rev();
    let turns = turns.filter(|(_, angle)| number(angle) != Some(0.0));
    let turns = turns.map(|(axis, angle)| format!("rot_{axis}({})", dump::expression(angle)));
    let turns: Vec<String> = turns.collect();
    Some(match turns.is_empty() {
        true => "1.0".to_owned(),
        false => turns.join(" * "),
    })
}

/// A remainder of values that vary.
pub(super) fn remainder(remainder: &ExprBinary) -> String {
    let places = [("a", &*remainder.left), ("b", &*remainder.right)];
    let divisor = dump::expression(&remainder.right);
    format!(
        "write `{}`, which has the sign of `{divisor}`",
        filled("mod(a, b)", &places)
    )
}

/// What to type for a condition that is read as a number, or times one, and where it stands.
pub(super) fn as_choice(binary: &ExprBinary) -> Option<(Span, String)> {
    let (condition, value) = match (is_condition(binary), &binary.op) {
        (true, _) => (binary, "1.0".to_owned()),
        (false, BinOp::Mul(_)) => {
            let sides = [(&binary.left, &binary.right), (&binary.right, &binary.left)];
            sides
                .into_iter()
                .find_map(|(condition, other)| match bare(condition) {
                    Expr::Binary(inner) if is_condition(inner) => {
                        Some((inner, dump::expression(bare(other))))
                    }
                    _ => None,
                })?
        }
        _ => return None,
    };
    let text = dump::expression(&Expr::Binary(condition.clone()));
    let choice = format!("if {text} {{ {value} }} else {{ 0.0 }}");
    Some((condition.op.span(), choice))
}

/// Whether this is a comparison or joins some.
fn is_condition(binary: &ExprBinary) -> bool {
    matches!(
        binary.op,
        BinOp::Lt(_)
            | BinOp::Le(_)
            | BinOp::Gt(_)
            | BinOp::Ge(_)
            | BinOp::Eq(_)
            | BinOp::Ne(_)
            | BinOp::And(_)
            | BinOp::Or(_)
    )
}

/// A product of two values.
pub(super) fn product(left: &Expr, right: &Expr) -> String {
    filled("a * b", &[("a", left), ("b", right)])
}

/// The whole part of a quotient of whole numbers.
pub(super) fn whole_part(quotient: &ExprBinary) -> String {
    let places = [("a", &*quotient.left), ("b", &*quotient.right)];
    filled("(a - a % b) / b", &places)
}

/// What to type where whole numbers are wanted for a function that laws have.
pub(super) fn whole_call(expression: &Expr) -> Option<String> {
    let Expr::Call(call) = bare(expression) else {
        return None;
    };
    let arguments: Vec<&Expr> = call.args.iter().collect();
    let name = plain_name(&call.func)?;
    let written = match (name.trim_start_matches("r#"), &arguments[..]) {
        ("mod", [a, b]) => filled("a % b", &[("a", a), ("b", b)]),
        ("floor", [Expr::Binary(quotient)]) if matches!(quotient.op, BinOp::Div(_)) => {
            whole_part(quotient)
        }
        _ => return None,
    };
    Some(format!("of whole numbers write `{written}`"))
}

/// The operand at the end of an expression.
fn last(expression: &Expr) -> &Expr {
    match expression {
        Expr::Binary(binary) => last(&binary.right),
        Expr::Unary(unary) => last(&unary.expr),
        other => other,
    }
}

/// The operand at the start of an expression, with its sign.
fn first(expression: &Expr) -> &Expr {
    match expression {
        Expr::Binary(binary) => first(&binary.left),
        other => starred(other).map_or(other, first),
    }
}

/// An expression without parentheses or braces around it.
pub(super) fn bare(expression: &Expr) -> &Expr {
    match expression {
        Expr::Paren(inner) => bare(&inner.expr),
        Expr::Group(inner) => bare(&inner.expr),
        Expr::Block(inner) => match &inner.block.stmts[..] {
            [Stmt::Expr(value, None)] => bare(value),
            _ => expression,
        },
        other => other,
    }
}

/// The number that an expression is.
pub(super) fn number(expression: &Expr) -> Option<f64> {
    match bare(expression) {
        Expr::Lit(literal) => match &literal.lit {
            Lit::Int(number) => number.base10_parse().ok(),
            Lit::Float(number) => number.base10_parse().ok(),
            _ => None,
        },
        Expr::Unary(unary) if matches!(unary.op, UnOp::Neg(_)) => {
            number(&unary.expr).map(|value| -value)
        }
        _ => None,
    }
}

/// An expression as it stands beside a sign of another.
pub(super) fn operand(value: &Expr) -> String {
    filled("-x", &[("x", value)]).split_off(1)
}

/// A text with expressions in place of its names.
pub(super) fn filled(text: &str, places: &[(&str, &Expr)]) -> String {
    let Ok(tokens) = text.parse::<TokenStream>() else {
        return text.to_owned();
    };
    dump::tokens(put(tokens, places))
}

fn put(tokens: TokenStream, places: &[(&str, &Expr)]) -> TokenStream {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let is_end = |place: Option<usize>| {
        let token = place.and_then(|place| tokens.get(place));
        token.is_none_or(|token| token.to_string() == ",")
    };
    let put_one = |(at, token): (usize, &TokenTree)| match token {
        TokenTree::Ident(name) => {
            let Some((_, value)) = places.iter().find(|(place, _)| name == place) else {
                return token.to_token_stream();
            };
            let alone = is_end(at.checked_sub(1)) && is_end(Some(at + 1));
            let value = bare(value);
            let is_closed = matches!(
                value,
                Expr::Path(_)
                    | Expr::Lit(_)
                    | Expr::Field(_)
                    | Expr::Index(_)
                    | Expr::Call(_)
                    | Expr::Array(_)
            );
            let value = value.to_token_stream();
            if alone || is_closed {
                return value;
            }
            TokenTree::from(Group::new(Delimiter::Parenthesis, value)).into()
        }
        TokenTree::Group(group) => {
            let inner = put(group.stream(), places);
            TokenTree::from(Group::new(group.delimiter(), inner)).into()
        }
        other => other.to_token_stream(),
    };
    tokens.iter().enumerate().map(put_one).collect()
}
