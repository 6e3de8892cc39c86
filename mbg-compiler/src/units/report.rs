//! What the user reads about units.

use std::collections::BTreeSet;

use super::dimension::Dimension;
use super::inference::Mismatch;
use super::ports::Mistake;
use super::{expression_text, names, pseudo, second, symbol_text};
use crate::causality::report::alternatives;
use crate::codes;
use crate::diagnostics::{Diagnostic, Diagnostics, error};
use crate::elaborate::claims::{Claim, Claims, Site, Subject};
use crate::elaborate::{Elaborated, Place, Quantity, Signal};
use crate::graph::{ElementId, ElementKind, JunctionId, OriginId, component_name};
use crate::symbolic::substitute::symbols;
use crate::symbolic::{Expression, Function, Operation, Pool, Symbol};
use crate::syntax::ast::Unit;
use crate::syntax::words::is_two_port;

/// How a pure number gets a unit.
const FACTOR: &str =
    "a number with a decimal point carries any unit as a factor: `1.0 * …`; a whole number counts";

/// Words of a compliance whose law multiplies or divides by what stands there.
const COEFFICIENTS: [&str; 2] = ["compliance", "stiffness"];

/// Words of elements of which one is the inverse of the other.
const INVERSES: [[&str; 2]; 2] = [COEFFICIENTS, ["conductance", "resistance"]];

/// Tells mistakes, each once.
pub(super) struct Reporter<'a> {
    model: &'a Elaborated,
    claims: &'a Claims,
    pool: &'a Pool,
    /// Symbols with a declared unit.
    declared: BTreeSet<Symbol>,
    diagnostics: &'a mut Diagnostics,
    before: usize,
}

/// A unit as people write it.
pub(super) fn unit_text(unit: &Dimension) -> String {
    if unit.is_pure() {
        return "a pure number".to_owned();
    }
    if unit.is_known() {
        return format!("`{}`", names::text(unit));
    }
    "a unit that is not known".to_owned()
}

/// Whether what a state changes by is in the unit of the state, and wants a factor per second.
fn is_without_its_rate(claim: &Claim, [rate, found]: [&Dimension; 2]) -> bool {
    matches!(claim.subject, Subject::Rate(_)) && found.over(rate) == second()
}

/// What to do about a name whose unit is at fault.
pub(super) fn in_another_unit(name: &str, unit: &Unit) -> String {
    let unit = &unit.text;
    format!("declare `{name}`, which is in `{unit}`, in another unit or in none")
}

/// `damper.e`, `joint.f.x`.
pub(super) fn signal_text(model: &Elaborated, (quantity, place, component): Signal) -> String {
    let letter = match quantity {
        Quantity::Effort => "e",
        Quantity::Flow => "f",
    };
    let (name, dimension) = match place {
        Place::Junction(id) => {
            let junction = &model.graph.junctions[id.0];
            (&junction.name, junction.dimension)
        }
        Place::Port(id) => (&model.graph.elements[id.0].name, 1),
    };
    if dimension == 1 {
        return format!("{name}.{letter}");
    }
    format!("{name}.{letter}.{}", component_name(component, dimension))
}

impl<'a> Reporter<'a> {
    pub(super) fn new(
        model: &'a Elaborated,
        claims: &'a Claims,
        pool: &'a Pool,
        diagnostics: &'a mut Diagnostics,
    ) -> Self {
        let before = diagnostics.list().len();
        Self {
            model,
            claims,
            pool,
            declared: claims.units.iter().map(|(symbol, ..)| *symbol).collect(),
            diagnostics,
            before,
        }
    }

    /// Reports a mistake at a place.
    pub(super) fn tell(&mut self, place: &Site, report: Diagnostic) {
        let report = place.locate(report);
        // Each iteration of a loop makes the same mistake.
        let span = |report: &Diagnostic| format!("{:?}", report.span);
        let told = &self.diagnostics.list()[self.before..];
        if !told.iter().any(|known| span(known) == span(&report)) {
            self.diagnostics.report(report);
        }
    }

    /// Whether an expression is a number without a name.
    pub(super) fn is_number(&self, expression: Expression) -> bool {
        match self.pool.operation(expression) {
            Operation::Constant(_) => true,
            Operation::Symbol(Symbol::Unknown(index)) => self.claims.hidden[*index].number,
            _ => false,
        }
    }

    /// Whether a law is one of numbers alone: it reads no name with a declared unit, but for what becomes a pure number by a
    /// function, as a rate does in a sine of time.
    pub(super) fn is_numeric(&self, claim: &Claim) -> bool {
        let mut open = claim.entries.clone();
        let mut seen = BTreeSet::new();
        while let Some(current) = open.pop() {
            if !seen.insert(current.node()) {
                continue;
            }
            let operation = self.pool.operation(current);
            match operation {
                Operation::Symbol(symbol) if self.declared.contains(symbol) => return false,
                Operation::Sine(_) | Operation::Cosine(_) => {}
                Operation::Call(Function::Exp | Function::Ln | Function::Tanh, _) => {}
                _ => open.extend_from_slice(&operation.operands()),
            }
        }
        matches!(claim.subject, Subject::Word(..))
    }

    /// The names with a declared unit that are read.
    fn read_by(&self, claim: &Claim) -> BTreeSet<Symbol> {
        let read = symbols(self.pool, &claim.entries).into_iter();
        read.filter(|it| self.declared.contains(it)).collect()
    }

    /// Two units, or by what they differ where one of them is not known.
    fn both(&self, [left, right]: [&Dimension; 2]) -> (String, String) {
        if left.is_known() && right.is_known() {
            return (unit_text(left), unit_text(right));
        }
        let factor = unit_text(&right.over(left));
        ("another unit".to_owned(), format!("that times {factor}"))
    }

    /// An expression, when it is short enough to be read.
    fn text(&self, expression: Expression, otherwise: &str) -> String {
        let text = expression_text(self.model, self.claims, self.pool, expression);
        if text.chars().count() > 40 {
            return otherwise.to_owned();
        }
        format!("`{text}`")
    }

    /// A sum or a function.
    pub(super) fn mismatch(&mut self, place: &Site, mistake: &Mismatch) {
        let (message, pure) = match mistake {
            Mismatch::Terms([a, b], [left, right]) => {
                let pure = left.is_pure() || right.is_pure();
                let (left, right) = self.both([left, right]);
                let (a, b) = (self.text(*a, "the left"), self.text(*b, "the right"));
                let message = format!(
                    "{a} is {left} and {b} is {right}: they are neither added nor compared"
                );
                (message, pure)
            }
            Mismatch::Argument(function, argument, unit) => {
                let argument = self.text(*argument, "its argument");
                let unit = unit_text(unit);
                // Of whichever of the three was written.
                let message = match *function == Function::Fraction.name() {
                    true => format!(
                        "`mod` takes two values of one unit, `floor` and `fraction` a pure number or an angle: whole multiples are \
                         counted of {argument}, which is {unit}"
                    ),
                    false => {
                        format!(
                            "`{function}` takes a pure number or an angle, and {argument} is {unit}"
                        )
                    }
                };
                (message, true)
            }
        };
        // A factor may be all that is missing.
        let help = pure.then(|| FACTOR.to_owned());
        self.report(place, message, None, help);
    }

    /// A name with a declared unit and another value.
    pub(super) fn declared(
        &mut self,
        claim: &Claim,
        name: &str,
        unit: &Unit,
        units: [&Dimension; 2],
    ) {
        let found = units[1];
        let text = unit_text(found);
        let message = format!(
            "`{name}` is declared in `{}`, and this is {text}",
            unit.text
        );
        let mut report = error(codes::UNIT_MISMATCH, claim.place.span, message);
        if let Some(advice) = self.no_power(claim, units) {
            report = report.help(advice);
        } else if found.is_pure() {
            let angle = self
                .may_be_angle(claim)
                .then_some("an angle is declared in `rad`");
            report.helps.extend(angle.map(str::to_owned));
            report = report.help(FACTOR);
        } else if units[0].is_pure() {
            report = report.help(FACTOR);
        }
        self.tell(&claim.place, report);
    }

    /// Whether a value is made of what an angle is made of: a sine or a cosine is none.
    fn may_be_angle(&self, claim: &Claim) -> bool {
        let mut open = claim.entries.clone();
        while let Some(current) = open.pop() {
            match self.pool.operation(current) {
                Operation::Symbol(_) => return true,
                Operation::Sine(_) | Operation::Cosine(_) => {}
                other => open.extend_from_slice(&other.operands()),
            }
        }
        false
    }

    /// A value that its place wants in another unit.
    pub(super) fn other(
        &mut self,
        claim: &Claim,
        what: &str,
        units: [&Dimension; 2],
        note: Option<String>,
        advice: Option<String>,
    ) {
        let advice = advice.or_else(|| self.no_power(claim, units));
        let advice = advice.or_else(|| self.inverse(claim, units));
        let help = match advice.or_else(|| self.bare_argument(claim)) {
            None if self.is_numeric(claim)
                || units.iter().any(|unit| unit.is_pure())
                || is_without_its_rate(claim, units) =>
            {
                Some(FACTOR.to_owned())
            }
            advice => advice,
        };
        let (wanted, found) = self.both(units);
        let message = format!("{what} must be {wanted} here, and this is {found}");
        self.report(&claim.place, message, note, help);
    }

    /// What to type for a stiffness that is given as a compliance, or the like: one is the inverse of the other.
    fn inverse(&self, claim: &Claim, [wanted, found]: [&Dimension; 2]) -> Option<String> {
        let Subject::Word(_, word) = &claim.subject else {
            return None;
        };
        let mut pairs = INVERSES.into_iter().flat_map(|[a, b]| [(a, b), (b, a)]);
        let (_, other) = pairs.find(|(own, _)| own == word)?;
        let (first, others) = claim.entries.split_first()?;
        let is_one = others.iter().all(|entry| entry == first);
        let is_inverse = wanted.times(found).is_pure() && !found.is_pure();
        let value = expression_text(self.model, self.claims, self.pool, *first);
        (is_one && is_inverse).then(|| format!("write `{other}: {value}`"))
    }

    /// What to type for the logarithm of a variable of the element itself, which becomes a pure number by it.
    fn bare_argument(&self, claim: &Claim) -> Option<String> {
        let Subject::Word(id, _) = &claim.subject else {
            return None;
        };
        let owner = format!("{}.", self.model.graph.elements[id.0].name);
        let mut open = claim.entries.clone();
        let mut seen = BTreeSet::new();
        while let Some(current) = open.pop() {
            if !seen.insert(current.node()) {
                continue;
            }
            let operation = self.pool.operation(current);
            if let Operation::Call(function @ (Function::Ln | Function::Exp), arguments) = operation
                && let [argument] = arguments[..]
                && let Operation::Symbol(Symbol::State(_) | Symbol::Signal(_)) =
                    self.pool.operation(argument)
            {
                let text = expression_text(self.model, self.claims, self.pool, argument);
                let text = text.strip_prefix(&owner).unwrap_or(&text);
                let function = function.name();
                return Some(format!(
                    "`{function}` takes a pure number, which makes `{text}` one: where it has a unit write \
                     `{function}({text} / 1.0)`"
                ));
            }
            open.extend_from_slice(&operation.operands());
        }
        None
    }

    /// What to type for a storage that is given its effort or flow at the start in the place of its state.
    pub(super) fn start(&self, claim: &Claim, id: ElementId) -> String {
        let text = |value: Expression| {
            let text = expression_text(self.model, self.claims, self.pool, value);
            let is_atom = text
                .chars()
                .all(|it| it.is_alphanumeric() || "_.[]".contains(it));
            if is_atom { text } else { format!("({text})") }
        };
        let value = match claim.entries[..] {
            [value] => text(value),
            _ => "…".to_owned(),
        };
        let word = match self.model.graph.elements[id.0].kind {
            ElementKind::I => "initial_flow",
            _ => "initial_effort",
        };
        format!("write `{word}: {value}`")
    }

    /// What to type where units differ because temperature times heat flow is taken for power.
    fn no_power(&self, claim: &Claim, units: [&Dimension; 2]) -> Option<String> {
        let places = pseudo::places(self.model, self.claims, self.pool, claim);
        let advice = || pseudo::advice(&self.model.graph, &places);
        pseudo::is_thermal(units).then(advice)?
    }

    /// Reports units that do not agree.
    fn report(
        &mut self,
        place: &Site,
        message: String,
        note: Option<String>,
        help: Option<String>,
    ) {
        let mut report = error(codes::UNIT_MISMATCH, place.span, message);
        if let Some(note) = note {
            report = report.note(note);
        }
        if let Some(help) = help {
            report = report.help(help);
        }
        self.tell(place, report);
    }

    /// A bond between what cannot be joined.
    pub(super) fn bond(&mut self, origin: OriginId, mistake: &Mistake) {
        let origins = &self.model.graph.origins;
        let variable = if mistake.flow { "flows" } else { "efforts" };
        let (left, right) = self.both([&mistake.units[0], &mistake.units[1]]);
        let message = format!(
            "`{}` joins {variable}: {left} before it, {right} after it",
            origins.path(origin)
        );
        let advice = || pseudo::advice(&self.model.graph, &pseudo::ends(&self.model.graph, origin));
        let help = pseudo::is_thermal([&mistake.units[0], &mistake.units[1]]).then(advice);
        let help = help.flatten().unwrap_or_else(|| {
            "a transformer or a gyrator goes between two domains: `a -> TF gear { flow: ratio } -> b;`".to_owned()
        });
        let report = error(codes::UNIT_MISMATCH, origins.span(origin), message).help(help);
        let place = Site {
            span: origins.span(origin),
            library: None,
        };
        self.tell(&place, report);
    }

    /// Whether anything was reported.
    pub(super) fn any(&self) -> bool {
        self.diagnostics.list().len() > self.before
    }

    /// A junction whose effort could only be in a root of units.
    pub(super) fn root(&mut self, id: JunctionId, unit: &Dimension) {
        let graph = &self.model.graph;
        let junction = &graph.junctions[id.0];
        let place = Site {
            span: graph.origins.span(junction.origin),
            library: None,
        };
        let message = format!(
            "the effort of `{}` could only be in {}, if effort times flow is power",
            junction.name,
            unit_text(unit)
        );
        let law = self.only_law(id).or_else(|| self.bare_modulus(id));
        let (place, declared) = law.unwrap_or((place, None));
        let mut report = error(codes::UNIT_MISMATCH, place.span, message);
        let advice = pseudo::advice(graph, &[id]);
        let helps = declared.into_iter().chain(advice);
        report.helps = alternatives(helps.collect());
        self.tell(&place, report);
    }

    /// The only law at a junction that reads names with units, and what to do where that is one name.
    fn only_law(&self, id: JunctionId) -> Option<(Site, Option<String>)> {
        let graph = &self.model.graph;
        let claims = self.claims.list.iter();
        let laws = claims.filter_map(|claim| match &claim.subject {
            Subject::Word(element, _) if pseudo::around(graph, *element).contains(&id) => {
                Some((claim, self.read_by(claim)))
            }
            _ => None,
        });
        let laws: Vec<_> = laws.filter(|(_, read)| !read.is_empty()).collect();
        let [(claim, read)] = &laws[..] else {
            return None;
        };
        let mut units = self.claims.units.iter();
        let declared = match read.iter().collect::<Vec<_>>()[..] {
            [only] => units.find(|(symbol, ..)| symbol == only),
            _ => None,
        };
        let help = declared.map(|(symbol, unit, _)| {
            let name = symbol_text(self.model, self.claims, *symbol);
            in_another_unit(&name, unit)
        });
        Some((claim.place.clone(), help))
    }

    /// The only modulus at a junction that is made of efforts and flows alone, so that its unit is theirs.
    fn bare_modulus(&self, id: JunctionId) -> Option<(Site, Option<String>)> {
        let graph = &self.model.graph;
        let is_bare = |claim: &&Claim| {
            let Subject::Word(element, _) = &claim.subject else {
                return false;
            };
            let read = symbols(self.pool, &claim.entries);
            is_two_port(graph.elements[element.0].kind)
                && pseudo::around(graph, *element).contains(&id)
                && !read.is_empty()
                && read.iter().all(|it| matches!(it, Symbol::Signal(_)))
        };
        let mut claims = self.claims.list.iter().filter(is_bare);
        let claim = claims.next().filter(|_| claims.next().is_none())?;
        Some((claim.place.clone(), Some(FACTOR.to_owned())))
    }

    /// A bond between a junction of pseudo bonds and one of true bonds.
    pub(super) fn pseudo(&mut self, origin: OriginId) {
        let origins = &self.model.graph.origins;
        let message = format!(
            "`{}` joins a junction of pseudo bonds to one of true bonds",
            origins.path(origin)
        );
        let mut report = error(codes::UNIT_MISMATCH, origins.span(origin), message);
        let ends = pseudo::ends(&self.model.graph, origin);
        report
            .helps
            .extend(pseudo::advice(&self.model.graph, &ends));
        let place = Site {
            span: origins.span(origin),
            library: None,
        };
        self.tell(&place, report);
    }
}
