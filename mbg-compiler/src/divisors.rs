//! Names of what a model divides by: the formula where it is short, and else what it is for or what it reads.

use crate::compile::text;
use crate::elaborate::Elaborated;
use crate::equations::Scalars;
use crate::structure::{Inverted, Solution, block_names};
use crate::symbolic::substitute::symbols;
use crate::symbolic::{Expression, Pool, Symbol};

/// Longest formula that serves as a name.
const LONGEST: usize = 60;

/// Most variables in one name.
const MOST: usize = 4;

/// The names of the inverted blocks, no two alike.
pub(crate) fn names(
    model: &Elaborated,
    scalars: &Scalars,
    solution: &Solution,
    pool: &Pool,
) -> Vec<String> {
    let named = solution.conditioning.iter().map(
        |Inverted {
             normalised,
             unknowns,
         }| {
            let name =
                short(model, scalars, pool, *normalised).unwrap_or_else(|| {
                    match &block_names(scalars, unknowns)[..] {
                        [] => read(model, pool, *normalised),
                        solved => format!("the determinant for {}", list(solved)),
                    }
                });
            (name, *normalised)
        },
    );
    let named: Vec<(String, Expression)> = named.collect();
    let mut names: Vec<String> = Vec::new();
    for (name, normalised) in &named {
        // What several are for tells none from the others; the states that it reads may.
        let is_of_many = named.iter().filter(|(other, _)| other == name).count() > 1;
        let states = if is_of_many {
            states(model, pool, *normalised)
        } else {
            String::new()
        };
        let name = format!("{name}{states}");
        let numbered = (2..).map(|number| format!("{name}, number {number}"));
        let mut all = std::iter::once(name.clone()).chain(numbered);
        names.extend(all.find(|name| !names.contains(name)));
    }
    names
}

/// `, in a, b, c and 3 more`, the states of a formula; nothing of one without.
fn states(model: &Elaborated, pool: &Pool, formula: Expression) -> String {
    let read = symbols(pool, &[formula]).into_iter();
    let states = read.filter(|it| matches!(it, Symbol::State(_)));
    let names: Vec<String> = states.map(|it| model.symbol_text(it)).collect();
    if names.is_empty() {
        return String::new();
    }
    format!(", in {}", list(&names))
}

/// The name of a divisor of parameters.
pub(crate) fn name(
    model: &Elaborated,
    scalars: &Scalars,
    pool: &Pool,
    divisor: Expression,
) -> String {
    short(model, scalars, pool, divisor).unwrap_or_else(|| read(model, pool, divisor))
}

/// The formula, where it can serve as a name.
fn short(
    model: &Elaborated,
    scalars: &Scalars,
    pool: &Pool,
    divisor: Expression,
) -> Option<String> {
    Some(text(model, scalars, pool, divisor)).filter(|it| it.chars().count() <= LONGEST)
}

/// `a formula in a, b and 3 more`.
fn read(model: &Elaborated, pool: &Pool, divisor: Expression) -> String {
    let read = symbols(pool, &[divisor]);
    let names: Vec<String> = read.into_iter().map(|it| model.symbol_text(it)).collect();
    format!("a formula in {}", list(&names))
}

fn list(names: &[String]) -> String {
    let named = names[..names.len().min(MOST)].join(", ");
    match names.len().saturating_sub(MOST) {
        0 => named,
        more => format!("{named} and {more} more"),
    }
}
