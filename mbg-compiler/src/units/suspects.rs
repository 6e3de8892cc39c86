//! The one statement without which all units agree: where it is wrong, all others contradict it, far from it.

use std::collections::{BTreeMap, BTreeSet};

use super::dimension::Dimension;
use super::{Otherwise, checked};
use crate::diagnostics::{Diagnostic, Diagnostics};
use crate::elaborate::Elaborated;
use crate::elaborate::claims::{Argument, Claim, Claims, Site, Subject};
use crate::graph::OriginId;
use crate::symbolic::{Pool, Symbol, substitute};

/// How many statements are looked at in all: each suspect is the model once more.
const LARGEST: usize = 50_000;

/// Efforts and flows that go together, by the exponents of both: forces, moments, pressures, voltages, magnetic tensions,
/// temperatures, and chemical potentials.
const DOMAINS: [[[i8; 7]; 2]; 7] = [
    [[1, 1, -2, 0, 0, 0, 0], [0, 1, -1, 0, 0, 0, 0]],
    [[1, 2, -2, 0, 0, 0, 0], [0, 0, -1, 0, 0, 0, 0]],
    [[1, -1, -2, 0, 0, 0, 0], [0, 3, -1, 0, 0, 0, 0]],
    [[1, 2, -3, -1, 0, 0, 0], [0, 0, 0, 1, 0, 0, 0]],
    [[0, 0, 0, 1, 0, 0, 0], [1, 2, -3, -1, 0, 0, 0]],
    [[0, 0, 0, 0, 1, 0, 0], [1, 2, -3, 0, -1, 0, 0]],
    [[1, 2, -2, 0, 0, -1, 0], [0, 0, -1, 0, 0, 1, 0]],
];

/// What may be wrong alone.
#[derive(Clone, Default)]
pub(super) struct Suspect {
    /// By position.
    claims: BTreeSet<usize>,
    bonds: Vec<OriginId>,
    /// The parameter of a component whose argument the claims are, and where that is written.
    argument: Option<(String, Site)>,
}

impl Suspect {
    pub(super) fn has_claim(&self, position: usize) -> bool {
        self.claims.contains(&position)
    }

    pub(super) fn has_bond(&self, origin: OriginId) -> bool {
        self.bonds.contains(&origin)
    }

    /// The argument that is looked at, for people.
    pub(super) fn argument(&self) -> Option<String> {
        let (path, _) = self.argument.as_ref()?;
        let (instance, name) = path.rsplit_once('.')?;
        Some(format!("`{name}` of `{instance}`"))
    }
}

/// What to tell in the place of all else, where all units agree but for one statement, and each effort and flow is then one of
/// a domain. Where that may be a bond or else one value, both are told; of more values none is told.
pub(super) fn cause(
    model: &Elaborated,
    claims: &Claims,
    pool: &Pool,
    declared: &BTreeMap<Symbol, Dimension>,
) -> Option<Diagnostic> {
    let (values, bonds) = (
        of_claims(model, claims, pool, declared),
        of_bonds(model, claims),
    );
    if (values.len() + bonds.len()) * claims.list.len() > LARGEST {
        return None;
    }
    let causes = |suspects: Vec<Suspect>| {
        let causes = suspects.into_iter();
        causes.filter_map(|suspect| alone(model, claims, pool, declared, suspect))
    };
    let mut values = causes(values);
    let value = values.next();
    if values.next().is_some() {
        return None;
    }
    let mut bonds = causes(bonds);
    match (value, bonds.next()) {
        (Some(value), Some(bond)) => {
            let value = value
                .message
                .replace(" here, and this is ", " there and is ");
            Some(bond.help(format!("or the bond is right, and {value}")))
        }
        (None, Some(bond)) => bonds.next().is_none().then_some(bond),
        (value, None) => value,
    }
}

/// What people write as one: claims of users at one place, which a loop may repeat, and arguments that stand alone after a word
/// inside of a component.
fn of_claims(
    model: &Elaborated,
    claims: &Claims,
    pool: &Pool,
    declared: &BTreeMap<Symbol, Dimension>,
) -> Vec<Suspect> {
    let reads_units = |claim: &Claim| {
        let mut read = substitute::symbols(pool, &claim.entries).into_iter();
        read.any(|symbol| !matches!(symbol, Symbol::Unknown(_)) || declared.contains_key(&symbol))
    };
    let mut found: BTreeMap<String, Suspect> = BTreeMap::new();
    for (position, claim) in claims.list.iter().enumerate() {
        if claim.is_part() || !reads_units(claim) {
            continue;
        }
        let argument = argument(model, claims, claim);
        let place = argument.map_or(&claim.place, |argument| &argument.place);
        if place.library.is_some() {
            continue;
        }
        let suspect = found.entry(key(place)).or_default();
        suspect.claims.insert(position);
        if let Some(argument) = argument {
            suspect.argument = Some((argument.path.clone(), argument.place.clone()));
        }
    }
    found.into_values().collect()
}

/// The argument of a user that stands alone after the word inside of a component that a claim is about.
fn argument<'a>(model: &Elaborated, claims: &'a Claims, claim: &Claim) -> Option<&'a Argument> {
    let Subject::Word(id, _) = &claim.subject else {
        return None;
    };
    let name = &model.graph.elements[id.0].name;
    let mut given = claims.arguments.iter().filter(|argument| {
        let instance = argument.path.rsplit_once('.').map(|(instance, _)| instance);
        argument.place.library.is_none()
            && claim.entries[..] == [argument.value]
            && instance
                .is_some_and(|it| name.strip_prefix(it).is_some_and(|it| it.starts_with('.')))
    });
    // Where two are one value, it is not known which of them it is.
    match (given.next(), given.next()) {
        (Some(argument), None) => Some(argument),
        _ => None,
    }
}

/// The bonds that users write, those at one place together.
fn of_bonds(model: &Elaborated, claims: &Claims) -> Vec<Suspect> {
    let graph = &model.graph;
    let inside = claims.list.iter().filter(|it| it.place.library.is_some());
    let calls: BTreeSet<String> = inside.map(|claim| key(&claim.place)).collect();
    let mut found: BTreeMap<String, Suspect> = BTreeMap::new();
    let bonds = graph
        .bonds
        .iter()
        .filter(|it| super::ports::joins_junctions(it));
    let bonds = bonds.map(|bond| bond.origin);
    for origin in bonds.chain(graph.closures.iter().map(|it| it.origin)) {
        let place = format!("{:?}", graph.origins.span(origin));
        if !calls.contains(&place) {
            found.entry(place).or_default().bonds.push(origin);
        }
    }
    found.into_values().collect()
}

/// What is told of a suspect once all others have said what units are: nothing if something else is told as well, or if an
/// effort and a flow are none of a domain then.
fn alone(
    model: &Elaborated,
    claims: &Claims,
    pool: &Pool,
    declared: &BTreeMap<Symbol, Dimension>,
    suspect: Suspect,
) -> Option<Diagnostic> {
    let mut claims = claims.clone();
    if let Some((_, place)) = &suspect.argument {
        for position in &suspect.claims {
            claims.list[*position].place = place.clone();
        }
    }
    let of_claims = suspect.claims.iter();
    let places = of_claims.map(|position| key(&claims.list[*position].place));
    let of_bonds = suspect.bonds.iter();
    let of_bonds = of_bonds.map(|origin| format!("{:?}", model.graph.origins.span(*origin)));
    let places: BTreeSet<String> = places.chain(of_bonds).collect();
    let otherwise = Otherwise {
        suspect,
        ..Otherwise::default()
    };
    let mut told = Diagnostics::new();
    let declared = declared.clone();
    let units = checked(model, &claims, pool, declared, &otherwise, &mut told);
    let [report] = told.list() else {
        return None;
    };
    let is_plausible = units
        .iter()
        .zip(&model.graph.junctions)
        .all(|(pair, junction)| junction.pseudo || is_of_domain(pair));
    let is_it = places.contains(&format!("{:?}", report.span));
    (is_it && is_plausible).then(|| report.clone())
}

/// Whether an effort and a flow go together, or are not known.
fn is_of_domain(pair: &[Dimension; 2]) -> bool {
    let mut domains = DOMAINS.iter();
    !pair.iter().all(Dimension::is_known)
        || domains.any(|domain| domain.map(Dimension::of) == *pair)
}

/// What tells places apart.
fn key(place: &Site) -> String {
    format!("{:?}", place.span)
}
