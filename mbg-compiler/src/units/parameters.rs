//! Parameters whose unit is that of another domain, such as a stiffness in N*m/rad of what slides: units agree around them,
//! and differ far away, where something is read.

use std::collections::BTreeMap;

use super::dimension::Dimension;
use super::report::in_another_unit;
use super::{Otherwise, checked, symbol_text};
use crate::diagnostics::{Diagnostic, Diagnostics};
use crate::elaborate::Elaborated;
use crate::elaborate::claims::{Claim, Claims, Subject};
use crate::symbolic::{Pool, Symbol, substitute};

/// What to do about the one parameter without whose unit all units agree, where a mistake is told of a value that reads
/// nothing with a unit of its own.
pub(super) fn advice(
    model: &Elaborated,
    claims: &Claims,
    pool: &Pool,
    declared: &BTreeMap<Symbol, Dimension>,
    mistake: &Diagnostic,
) -> Option<String> {
    let is_told = |claim: &&Claim| {
        matches!(claim.subject, Subject::Declared(..))
            && format!("{:?}", claim.place.span) == format!("{:?}", mistake.span)
    };
    let claim = claims.list.iter().find(is_told)?;
    let mut read = substitute::symbols(pool, &claim.entries).into_iter();
    if read.any(|symbol| declared.contains_key(&symbol)) {
        return None;
    }
    let agree_without = |symbol: &Symbol| {
        let mut others = declared.clone();
        others.remove(symbol);
        let mut told = Diagnostics::new();
        checked(
            model,
            claims,
            pool,
            others,
            &Otherwise::default(),
            &mut told,
        );
        !told.any()
    };
    let units = claims.units.iter();
    let parameters = units.filter(|(symbol, ..)| matches!(symbol, Symbol::Parameter(_)));
    let mut causes = parameters.filter(|(symbol, ..)| agree_without(symbol));
    match (causes.next(), causes.next()) {
        (Some((symbol, unit, _)), None) => {
            Some(in_another_unit(&symbol_text(model, claims, *symbol), unit))
        }
        _ => None,
    }
}
