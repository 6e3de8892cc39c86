//! Stage 2b, units: whether the units of a model agree.
//!
//! Input: an [`Elaborated`] model, and its text once more. Output: nothing but errors `MBG05xx`. Afterwards every
//! equation of the model can be one between quantities: terms of sums have one unit, functions that want pure numbers
//! have them, each law fits the effort and the flow at its element, and effort times flow is power in every true bond.
//!
//! A unit that is not declared is an unknown, for which the equations are solved as they come; a mistake is told where
//! they first contradict each other, or at the one value without which all others agree. A number with a decimal point may
//! carry any unit; a whole number counts, and is pure as a factor. A model that declares no unit at all is not looked at.

mod converters;
mod densities;
mod dimension;
mod inference;
mod names;
mod parameters;
mod ports;
mod pseudo;
mod report;
mod sources;
mod spellings;
mod suspects;

use std::collections::BTreeMap;

pub(crate) use names::{acceleration, without_unit, without_units};

use self::dimension::{Dimension, Ratio, Unknowns};
use self::inference::{Inference, Measure, Mismatch};
use self::ports::Ports;
use self::report::Reporter;
use self::suspects::Suspect;
use crate::causality::report::alternatives;
use crate::diagnostics::Diagnostics;
use crate::elaborate::claims::{self, Claim, Claims, Subject};
use crate::elaborate::{Elaborated, Quantity};
use crate::graph::{BondGraph, ElementId, ElementKind, End, JunctionId};
use crate::symbolic::{Expression, Pool, Symbol, substitute};
use crate::syntax::ast::{self, Unit};

/// Whether a unit has this name.
pub(crate) fn is_name_of_unit(name: &str) -> bool {
    names::lookup(name).is_some()
}

/// Whether a unit is that of a pure number, such as an angle.
pub(crate) fn is_pure(unit: &Unit) -> bool {
    names::dimension(unit).is_ok_and(|dimension| dimension.is_pure())
}

/// Checks the units of a model that is sound otherwise.
pub fn check(
    model: &ast::Model,
    components: &BTreeMap<String, &ast::Component>,
    elaborated: &Elaborated,
    diagnostics: &mut Diagnostics,
) {
    let mut pool = Pool::new();
    let claims = claims::claims(model, components, &mut pool);
    let silent = |claim: &Claim| !matches!(claim.subject, Subject::Declared(..));
    if claims.units.is_empty() && claims.list.iter().all(silent) {
        return;
    }
    let mut reporter = Reporter::new(elaborated, &claims, &pool, diagnostics);
    let Some(declared) = declared(&claims, &pool, &mut reporter) else {
        return;
    };
    let mut found = Diagnostics::new();
    let as_written = Otherwise::default();
    checked(
        elaborated,
        &claims,
        &pool,
        declared.clone(),
        &as_written,
        &mut found,
    );
    if !found.any() {
        return;
    }
    // One converter that is another one explains more than effort times flow that is no power.
    let converters = converters::advice(elaborated, &claims, &pool, &declared);
    if converters.is_empty() {
        let report = densities::report(elaborated, &claims, &pool, &declared);
        let report = report.or_else(|| sources::report(elaborated, &claims, &pool, &declared));
        if let Some(report) = report {
            return diagnostics.report(report);
        }
    }
    let mut found = found.list().to_vec();
    if converters.is_empty()
        && let Some(cause) = suspects::cause(elaborated, &claims, &pool, &declared)
    {
        found = vec![cause];
    }
    for (position, mut report) in found.into_iter().enumerate() {
        if position == 0 && !converters.is_empty() {
            report.helps = alternatives(converters.clone());
        } else if position == 0 {
            let cause = parameters::advice(elaborated, &claims, &pool, &declared, &report);
            report.helps.splice(0..0, cause);
        }
        diagnostics.report(report);
    }
}

/// Two-ports whose laws are taken for their inverses.
type Inverted = std::collections::BTreeSet<ElementId>;

/// What is taken otherwise than it is written, to see whether units agree then.
#[derive(Default)]
struct Otherwise {
    inverted: Inverted,
    /// What is looked at when all others have said what units are.
    suspect: Suspect,
}

/// Checks units of which these are declared; the result has the effort and the flow of the first component of each junction.
fn checked(
    model: &Elaborated,
    claims: &Claims,
    pool: &Pool,
    declared: BTreeMap<Symbol, Dimension>,
    otherwise: &Otherwise,
    diagnostics: &mut Diagnostics,
) -> Vec<[Dimension; 2]> {
    let mut reporter = Reporter::new(model, claims, pool, diagnostics);
    let mut unknowns = Unknowns::default();
    let ports = Ports::of(&model.graph, &mut unknowns, &mut reporter);
    let symbols = symbols(model, claims, declared, &ports, &mut unknowns);
    let inference = Inference::new(pool, symbols, unknowns);
    let mut checker = Checker {
        model,
        ports,
        inference,
        otherwise,
        reporter,
    };
    checker.run(&claims.list);
    let unknowns = &mut checker.inference.unknowns;
    let junctions = checker.ports.junctions.iter();
    let pairs = junctions.map(|pairs| pairs[0].each_ref().map(|unit| unknowns.reduce(unit)));
    pairs.collect()
}

/// The units that are declared; none if one of them is no unit of SI, which is told.
fn declared(
    claims: &Claims,
    pool: &Pool,
    reporter: &mut Reporter<'_>,
) -> Option<BTreeMap<Symbol, Dimension>> {
    let mut declared = BTreeMap::new();
    let mut sound = true;
    let is_number = |symbol: Symbol| match symbol {
        Symbol::Unknown(index) => claims.hidden[index].number,
        _ => false,
    };
    // A factor helps numbers alone: what is read of the model is in SI.
    let dimension = |entries: &[Expression], unit: &Unit| {
        let mut read = substitute::symbols(pool, entries).into_iter();
        match read.all(is_number) {
            true => names::dimension(unit),
            false => names::dimension_of_read(unit),
        }
    };
    // Of each unit the first mistake is told, and what a name stands for tells more than the name.
    for claim in &claims.list {
        let Subject::Declared(_, unit) = &claim.subject else {
            continue;
        };
        if let Err(report) = dimension(&claim.entries, unit) {
            reporter.tell(&claim.place, *report);
            sound = false;
        }
    }
    let rate = |state: &usize| {
        let of_state =
            |it: &&Claim| matches!(&it.subject, Subject::Rate(states) if states.contains(state));
        claims.list.iter().find(of_state)
    };
    for (symbol, unit, place) in &claims.units {
        let found = match symbol {
            Symbol::State(state) => {
                let rate = rate(state).map(|claim| &claim.entries[..]);
                dimension(rate.unwrap_or_default(), unit)
            }
            _ => names::dimension(unit),
        };
        match found {
            Ok(dimension) => {
                declared.insert(*symbol, dimension);
            }
            Err(report) => {
                reporter.tell(place, *report);
                sound = false;
            }
        }
    }
    sound.then_some(declared)
}

/// The units of all symbols: declared, of a port, or unknown.
fn symbols(
    model: &Elaborated,
    claims: &Claims,
    declared: BTreeMap<Symbol, Dimension>,
    ports: &Ports,
    unknowns: &mut Unknowns,
) -> BTreeMap<Symbol, Dimension> {
    let mut symbols = declared;
    symbols.insert(Symbol::Time, second());
    for (number, (quantity, place, component)) in claims.signals.list().iter().enumerate() {
        let [effort, flow] = ports.variables(*place, *component);
        let unit = match quantity {
            Quantity::Effort => effort,
            Quantity::Flow => flow,
        };
        symbols.insert(Symbol::Signal(number), unit.clone());
    }
    for (state, entry) in model.states.iter().enumerate() {
        let unit = match entry.rate {
            crate::elaborate::StateRate::Storage(id, component) => {
                let [effort, flow] = &ports.inner[id.0][component];
                let rate = match model.graph.elements[id.0].kind {
                    ElementKind::I => effort,
                    _ => flow,
                };
                rate.times(&second())
            }
            _ => unknowns.fresh(),
        };
        symbols.entry(Symbol::State(state)).or_insert(unit);
    }
    symbols
}

/// The unit of time.
fn second() -> Dimension {
    Dimension::of([0, 0, 1, 0, 0, 0, 0])
}

/// The unit of power.
fn watt() -> Dimension {
    Dimension::of([1, 2, -3, 0, 0, 0, 0])
}

/// When claims are looked at: what says most about units comes first, so that a contradiction is found where it
/// most likely was made.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Phase {
    OnePorts,
    TwoPorts,
    Bonds,
    /// Values of what has a unit of its own: where they read a flow, its unit is found without them.
    Declared,
    Answers,
    /// What may be wrong alone.
    Suspect,
    /// Laws of numbers alone: a factor of one is not written, so that their units are no more than a guess.
    Numeric,
}

struct Checker<'a> {
    model: &'a Elaborated,
    ports: Ports,
    inference: Inference<'a>,
    otherwise: &'a Otherwise,
    reporter: Reporter<'a>,
}

impl Checker<'_> {
    fn run(&mut self, claims: &[Claim]) {
        for phase in [
            Phase::OnePorts,
            Phase::TwoPorts,
            Phase::Bonds,
            Phase::Declared,
            Phase::Answers,
            Phase::Suspect,
            Phase::Numeric,
        ] {
            if matches!(phase, Phase::Bonds | Phase::Suspect) {
                self.junction_bonds(phase == Phase::Suspect);
            }
            if phase == Phase::Numeric && !self.reporter.any() {
                self.roots();
            }
            let mut start = 0;
            for (position, claim) in claims.iter().enumerate() {
                if claim.is_part() && position + 1 < claims.len() {
                    continue;
                }
                // Parts belong to what is made of them.
                let is_suspect = self.otherwise.suspect.has_claim(position);
                let own = if is_suspect {
                    Phase::Suspect
                } else {
                    self.phase(claim)
                };
                if own == phase {
                    for claim in &claims[start..=position] {
                        self.claim(claim);
                    }
                }
                start = position + 1;
            }
        }
    }

    /// A junction whose units could only be roots is one where effort times flow is no power.
    fn roots(&mut self) {
        for (id, pairs) in self.ports.junctions.iter().enumerate() {
            let units = pairs
                .iter()
                .map(|pair| self.inference.unknowns.reduce(&pair[0]));
            let root = units.filter(Dimension::is_known).find(Dimension::has_roots);
            if let Some(unit) = root {
                self.reporter.root(JunctionId(id), &unit);
            }
        }
    }

    fn phase(&self, claim: &Claim) -> Phase {
        match &claim.subject {
            Subject::Word(id, _) if is_two_port(&self.model.graph, *id) => Phase::TwoPorts,
            Subject::Word(..) if self.reporter.is_numeric(claim) => Phase::Numeric,
            Subject::Word(..) => Phase::OnePorts,
            Subject::Declared(..) => Phase::Declared,
            _ => Phase::Answers,
        }
    }

    /// Bonds between junctions, and between both ends of a closure: those that may be wrong alone, or all others.
    fn junction_bonds(&mut self, suspect: bool) {
        let graph = &self.model.graph;
        let is_due = |origin| self.otherwise.suspect.has_bond(origin) == suspect;
        for bond in &graph.bonds {
            if ports::joins_junctions(bond) && is_due(bond.origin) {
                self.bond(&bond.from, &bond.to, bond.origin);
            }
        }
        for closure in graph.closures.iter().filter(|it| is_due(it.origin)) {
            let [first, last] = closure.bonds.map(|bond| &graph.bonds[bond.0]);
            self.bond(&first.from, &last.to, closure.origin);
        }
    }

    fn bond(&mut self, from: &End, to: &End, origin: crate::graph::OriginId) {
        let pairs = self.ports.pairs(&self.model.graph, from, to);
        let mistake = ports::join(&pairs, &mut self.inference.unknowns);
        if let Some(mistake) = mistake {
            self.reporter.bond(origin, &mistake);
        }
    }

    fn claim(&mut self, claim: &Claim) {
        let mut mistakes = Vec::new();
        let measures: Vec<Measure> = claim
            .entries
            .iter()
            .map(|entry| self.inference.measure(*entry, &mut mistakes))
            .collect();
        if let Some(mistake) = mistakes.first() {
            self.reporter.mismatch(&claim.place, mistake);
        }
        match &claim.subject {
            Subject::Part => {}
            Subject::Argument(function) => {
                let pure = [Dimension::pure()];
                if let Some((_, [_, found])) = self.first_other(&measures, &pure) {
                    let mistake = Mismatch::Argument(function, claim.entries[0], found);
                    self.reporter.mismatch(&claim.place, &mistake);
                }
            }
            Subject::Declared(name, unit) => {
                let wanted = names::dimension(unit).unwrap_or_default();
                let found = self.first_other(&measures, &vec![wanted; measures.len()]);
                if let Some((_, [wanted, found])) = found {
                    self.reporter.declared(claim, name, unit, [&wanted, &found]);
                }
            }
            Subject::Word(id, word) => self.word(claim, *id, word, &measures),
            Subject::Rate(states) => {
                let wanted = self.state_units(states.clone(), Ratio::MINUS);
                self.expect(claim, "the rate", &wanted, &measures);
            }
            Subject::Start(states) => {
                let wanted = self.state_units(states.clone(), Ratio::new(0, 1));
                self.expect(claim, "`initial`", &wanted, &measures);
            }
            Subject::Flow(id) => {
                let flows = self.ports.junctions[id.0].iter();
                let wanted: Vec<Dimension> = flows.map(|[_, flow]| flow.clone()).collect();
                self.expect(claim, "`initial_flow`", &wanted, &measures);
            }
            Subject::Turning => {
                let wanted = vec![Dimension::pure().over(&second()); measures.len()];
                self.expect(claim, "an angular velocity", &wanted, &measures);
            }
            Subject::Displacement(number) => {
                let bond = self.model.graph.closures[*number].bonds[0];
                let end = self.model.graph.bonds[bond.0].from.clone();
                let pairs = self.ports.pairs(&self.model.graph, &end, &end);
                let wanted = pairs.iter().map(|pair| pair[0][1].times(&second()));
                let wanted: Vec<Dimension> = wanted.collect();
                self.expect(claim, "`displacement`", &wanted, &measures);
            }
        }
    }

    /// The units of states times a power of a second.
    fn state_units(&self, states: std::ops::Range<usize>, power: Ratio) -> Vec<Dimension> {
        let unit = |state| self.inference.symbols[&Symbol::State(state)].clone();
        states
            .map(|state| unit(state).times_power(&second(), power))
            .collect()
    }

    fn expect(&mut self, claim: &Claim, what: &str, wanted: &[Dimension], found: &[Measure]) {
        if let Some((_, [wanted, found])) = self.first_other(found, wanted) {
            self.reporter
                .other(claim, what, [&wanted, &found], None, None);
        }
    }

    /// Makes units what they must be: the place of the first that cannot, with what it must be and what it is.
    fn first_other(
        &mut self,
        found: &[Measure],
        wanted: &[Dimension],
    ) -> Option<(usize, [Dimension; 2])> {
        let unknowns = &mut self.inference.unknowns;
        let mut other = None;
        for (place, (found, wanted)) in found.iter().zip(wanted).enumerate() {
            if let Measure::Of(found) = found
                && !unknowns.equate(found, wanted)
            {
                let units = [wanted, found].map(|unit| unknowns.reduce(unit));
                other = other.or(Some((place, units)));
            }
        }
        other
    }

    /// What stands after a word must fit the effort and the flow at the element.
    fn word(&mut self, claim: &Claim, id: ElementId, word: &str, found: &[Measure]) {
        let known: Vec<Measure> = found.to_vec();
        let (mut measures, mut wanted, mut places) = (Vec::new(), Vec::new(), Vec::new());
        for (position, measure) in known.into_iter().enumerate() {
            // A number stands for each component, whatever their units.
            if self.reporter.is_number(claim.entries[position]) {
                continue;
            }
            let place = (position / claim.columns, position % claim.columns);
            for unit in self
                .ports
                .wanted(&self.model.graph, id, word, place, found.len())
            {
                places.push(place);
                measures.push(measure.clone());
                wanted.push(match self.otherwise.inverted.contains(&id) {
                    true => Dimension::pure().over(&unit),
                    false => unit,
                });
            }
        }
        if let Some((first, [wanted, found])) = self.first_other(&measures, &wanted) {
            let place = places[first];
            let name = &self.model.graph.elements[id.0].name;
            let argument = self.otherwise.suspect.argument();
            let entry = self.entry(claim, id, place);
            let what = argument.unwrap_or_else(|| format!("`{word}{entry}` of `{name}`"));
            let note = self.surroundings(id, place);
            let given = usize::from(self.model.graph.elements[id.0].kind == ElementKind::I);
            let given = &self.ports.inner[id.0][0][given];
            let is_given = word == "initial" && self.inference.unknowns.reduce(given) == found;
            let help = is_given.then(|| self.reporter.start(claim, id));
            self.reporter
                .other(claim, &what, [&wanted, &found], Some(note), help);
        }
    }

    /// Which entry of a law is meant, where an element has components of several units.
    fn entry(&mut self, claim: &Claim, id: ElementId, (row, column): (usize, usize)) -> String {
        let unknowns = &mut self.inference.unknowns;
        let mut differs = |pairs: &[[Dimension; 2]]| {
            let mut efforts = pairs.iter().map(|pair| unknowns.reduce(&pair[0]));
            let first = efforts.next();
            efforts.any(|effort| Some(effort) != first)
        };
        let is_mixed = differs(&self.ports.inner[id.0]) || differs(&self.ports.outer[id.0]);
        match (is_mixed && claim.entries.len() > 1, claim.columns) {
            (false, _) => String::new(),
            (true, 1) => format!("[{row}]"),
            (true, _) => format!("[{row}][{column}]"),
        }
    }

    /// The efforts and flows at an element beside an entry of its law, for people.
    fn surroundings(&mut self, id: ElementId, (row, column): (usize, usize)) -> String {
        let mut side = |variables: &[[Dimension; 2]], component: usize| {
            let units = variables[component].each_ref().map(|unit| {
                let unit = self.inference.unknowns.reduce(unit);
                report::unit_text(&unit)
            });
            format!("the effort is {} and the flow {}", units[0], units[1])
        };
        if self.ports.outer[id.0].is_empty() {
            return format!("{} there", side(&self.ports.inner[id.0], row));
        }
        let inner = side(&self.ports.inner[id.0], column);
        let outer = side(&self.ports.outer[id.0], row);
        format!("before it {inner}, after it {outer}")
    }
}

/// Whether an element has two ports.
fn is_two_port(graph: &BondGraph, id: ElementId) -> bool {
    use ElementKind::{GY, MGY, MTF, TF};
    matches!(graph.elements[id.0].kind, TF | GY | MTF | MGY)
}

/// An expression with the names of a text.
pub(super) fn expression_text(
    model: &Elaborated,
    claims: &Claims,
    pool: &Pool,
    expression: Expression,
) -> String {
    let name = |symbol: Symbol| symbol_text(model, claims, symbol);
    crate::symbolic::print::Printer::new(pool, &name).text(expression)
}

/// The name of what a symbol stands for.
fn symbol_text(model: &Elaborated, claims: &Claims, symbol: Symbol) -> String {
    match symbol {
        Symbol::Unknown(index) => claims.hidden[index].text.clone(),
        Symbol::Signal(index) => report::signal_text(model, claims.signals.list()[index]),
        other => model.symbol_text(other),
    }
}
