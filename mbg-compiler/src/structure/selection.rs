//! Which storages are states when not all of them can be.
//!
//! A law that is not linear counts with its slopes, so that what it gives by iteration is not taken to be imposed.
//! Rows are taken in order of priority (structure and resistors, sources, storages as declared, marked storages) and
//! reduced by those before them, over the prime field. By the greedy theorem for linear matroids the rows that vanish
//! are the fewest, and each is a combination of earlier rows, which names its causes. Where storages depend on each
//! other, they are chosen once more: flows of `coordinate` junctions come first, and what is fixed for almost every
//! state, but not at the nominal one, comes last. Where inertias that depend on nothing leave too few flows to
//! coordinates, those that are far from these inertias come before those that are near.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::rc::Rc;

use super::echelon::{Echelon, NominalEchelon, Row};
use super::mesh;
use crate::codes;
use crate::diagnostics::{Diagnostic, Diagnostics, error, listing};
use crate::elaborate::{Elaborated, Ring};
use crate::equations::{Equation, Owner, Scalars};
use crate::graph::{ElementId, ElementKind, End, JunctionId, Law};
use crate::symbolic::substitute::symbols;
use crate::symbolic::{Differentiator, Evaluation, Expression, Pool, Symbol};

/// What is a state, and what is not.
pub struct Selection {
    /// Rows of storages that follow from others.
    pub lost: Vec<Lost>,
    /// Coordinates that are states in their place: junction, component, flow.
    pub coordinates: Vec<(JunctionId, usize, usize)>,
    /// Junctions of coordinates that can move without any storage.
    pub idle: BTreeSet<JunctionId>,
}

/// A component of a storage that is no state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lost {
    /// Its equation.
    pub equation: usize,
    /// The storage.
    pub element: ElementId,
    /// Its component.
    pub component: usize,
    /// Storages, sources and coordinates that it follows from.
    pub causes: BTreeSet<Owner>,
}

/// Selects, or reports why the equations have no solution.
pub fn select(
    model: &Elaborated,
    scalars: &Scalars,
    pool: &mut Pool,
    diagnostics: &mut Diagnostics,
) -> Option<Selection> {
    let equations = tangent(scalars, pool);
    let (equations, pool) = (&equations[..], &*pool);
    let mut first = Selector::new(model, equations, pool);
    let mut order: Vec<usize> = (0..equations.len()).collect();
    let priority = |row: usize| first.priority(equations[row].owner);
    order.sort_by_key(|row| (priority(*row), *row));
    let (storages, others): (Vec<usize>, Vec<usize>) = order
        .into_iter()
        .partition(|row| priority(*row) >= STORAGES);
    for row in others {
        first.take(&equations[row], row, false);
    }
    let second = first.clone();
    for row in &storages {
        first.take(&equations[*row], *row, false);
    }
    match first.report(diagnostics) {
        Verdict::Accepted => Some(again((scalars, equations), &storages, &first, second)),
        Verdict::Refused => None,
        Verdict::Undetermined => {
            mesh::report(model, scalars, pool, diagnostics);
            None
        }
    }
}

/// What the first choice shows.
enum Verdict {
    /// Every dependent storage is accepted as such.
    Accepted,
    /// Something was reported.
    Refused,
    /// The structure itself leaves something open.
    Undetermined,
}

/// The second choice, among the storages that take part in a dependence; the rows of all else are taken.
fn again(
    (scalars, equations): (&Scalars, &[Equation]),
    storages: &[usize],
    first: &Selector,
    mut second: Selector,
) -> Selection {
    let model = first.model;
    let involved: BTreeSet<ElementId> = first
        .lost
        .iter()
        .flat_map(|lost| {
            lost.causes
                .iter()
                .filter_map(|cause| storage(model, *cause))
                .chain([lost.element])
        })
        .collect();
    let is_involved = |owner| storage(model, owner).is_some_and(|id| involved.contains(&id));
    let coordinates = scalars.coordinates.iter();
    let coordinates = coordinates.map(|coordinate| coordinate_row(*coordinate));
    let (coordinates, idle): (Vec<Equation>, Vec<Equation>) =
        coordinates.partition(|row| first.follows(row));
    let idle = idle.iter().filter_map(|row| match row.owner {
        Owner::Coordinate(junction, _) => Some(junction),
        _ => None,
    });
    let (involved, free): (Vec<usize>, Vec<usize>) = storages
        .iter()
        .partition(|row| is_involved(equations[**row].owner));
    for row in free {
        second.take(&equations[row], row, false);
    }
    let coordinates = far_before_near(model, &second, coordinates);
    let mut candidates: Vec<(&Equation, usize)> =
        coordinates.iter().map(|row| (row, usize::MAX)).collect();
    candidates.extend(involved.into_iter().map(|row| (&equations[row], row)));
    let mut postponed = Vec::new();
    for (equation, row) in candidates {
        if !second.take(equation, row, true) {
            postponed.push((equation, row));
        }
    }
    for (equation, row) in postponed {
        second.take(equation, row, false);
    }
    let chosen = second.coordinates;
    Selection {
        lost: second.lost,
        coordinates: scalars
            .coordinates
            .iter()
            .filter(|(junction, component, _)| chosen.contains(&(*junction, *component)))
            .copied()
            .collect(),
        idle: idle.collect(),
    }
}

/// Coordinates in the order in which they are taken. Where some must follow from inertias that are states, such as that of a body
/// on a ball joint whose spin nothing else holds, they are those of the joints next to these: a ball joint gives the spin whatever
/// its position is, while the hinge that carries it gives one only where its axis is not at a right angle to what was taken. Else
/// they are in the order of their declaration.
fn far_before_near(
    model: &Elaborated,
    taken: &Selector,
    mut coordinates: Vec<Equation>,
) -> Vec<Equation> {
    let mut echelon = taken.exact.clone();
    let causes = coordinates
        .iter()
        .filter_map(|row| echelon.reduce(taken.images(row), Some(row.owner)));
    let is_inertia = |id: &ElementId| model.graph.elements[id.0].kind == ElementKind::I;
    let inertias: BTreeSet<ElementId> = causes
        .flatten()
        .filter_map(|cause| storage(model, cause))
        .filter(is_inertia)
        .collect();
    if inertias.is_empty() {
        return coordinates;
    }
    let distances = distances(model, &inertias);
    coordinates.sort_by_key(|row| match row.owner {
        Owner::Coordinate(junction, _) => Reverse(distances[junction.0]),
        _ => Reverse(usize::MAX),
    });
    coordinates
}

/// How many bonds are between each junction and the next of these elements, along bonds that hand on flows as flows.
fn distances(model: &Elaborated, elements: &BTreeSet<ElementId>) -> Vec<usize> {
    let graph = &model.graph;
    let junctions = graph.junctions.len();
    let node = |end: &End| match end {
        End::Junction(id, _) => Some(id.0),
        End::OnePort(id) => Some(junctions + id.0),
        End::In(id) | End::Out(id) => {
            let is_gyrator = matches!(graph.elements[id.0].law, Law::Gyrator(_));
            (!is_gyrator).then_some(junctions + id.0)
        }
        End::Border => None,
    };
    let mut beside = vec![Vec::new(); junctions + graph.elements.len()];
    for bond in &graph.bonds {
        if let (Some(from), Some(to)) = (node(&bond.from), node(&bond.to)) {
            beside[from].push(to);
            beside[to].push(from);
        }
    }
    let mut distances = vec![usize::MAX; beside.len()];
    let mut pending: VecDeque<usize> = elements.iter().map(|id| junctions + id.0).collect();
    for node in &pending {
        distances[*node] = 0;
    }
    while let Some(node) = pending.pop_front() {
        for next in &beside[node] {
            if distances[*next] == usize::MAX {
                distances[*next] = distances[node] + 1;
                pending.push_back(*next);
            }
        }
    }
    distances.truncate(junctions);
    distances
}

/// The equations with the slopes of what enters them nonlinearly as further coefficients.
fn tangent(scalars: &Scalars, pool: &mut Pool) -> Vec<Equation> {
    let mut equations = scalars.equations.clone();
    for equation in equations.iter_mut().filter(|it| !it.signals.is_empty()) {
        let mut left = equation.constant;
        for (unknown, coefficient) in &equation.terms {
            let own = pool.symbol(Symbol::Unknown(*unknown));
            let product = pool.multiply(*coefficient, own);
            left = pool.add(left, product);
        }
        for symbol in symbols(pool, &[left]) {
            let Symbol::Signal(number) = symbol else {
                continue;
            };
            let (unknown, reversed) = scalars.signals[number];
            let slope = Differentiator::new(symbol).derivative(pool, left);
            let term = equation.terms.entry(unknown).or_insert(Expression::ZERO);
            *term = pool.add(*term, slope.flipped(reversed));
        }
        equation.terms.retain(|_, term| *term != Expression::ZERO);
    }
    equations
}

/// The row `flow = state` of a coordinate; its constant is not needed here.
fn coordinate_row((junction, component, flow): (JunctionId, usize, usize)) -> Equation {
    Equation {
        terms: BTreeMap::from([(flow, Expression::ONE)]),
        constant: Expression::ZERO,
        signals: Vec::new(),
        owner: Owner::Coordinate(junction, component),
        about: [flow; 2],
        level: None,
        rate: None,
    }
}

fn storage(model: &Elaborated, owner: Owner) -> Option<ElementId> {
    match owner {
        Owner::Element(id, _) => model.graph.elements[id.0].has_states().then_some(id),
        _ => None,
    }
}

/// The priority at which storages begin.
const STORAGES: usize = 2;

#[derive(Clone)]
struct Selector<'a> {
    model: &'a Elaborated,
    pool: &'a Pool,
    exact: Echelon,
    nominal: NominalEchelon,
    /// Coefficients at the nominal state by node.
    nominal_values: Rc<[f64]>,
    lost: Vec<Lost>,
    sources: Vec<(ElementId, BTreeSet<Owner>)>,
    coordinates: BTreeSet<(JunctionId, usize)>,
    structure: bool,
}

impl<'a> Selector<'a> {
    fn new(model: &'a Elaborated, equations: &[Equation], pool: &'a Pool) -> Self {
        Self {
            model,
            pool,
            exact: Echelon::default(),
            nominal: NominalEchelon::default(),
            nominal_values: nominal_values(model, equations, pool),
            lost: Vec::new(),
            sources: Vec::new(),
            coordinates: BTreeSet::new(),
            structure: false,
        }
    }

    fn priority(&self, owner: Owner) -> usize {
        let Owner::Element(id, _) = owner else {
            return 0;
        };
        let element = &self.model.graph.elements[id.0];
        match element.law {
            Law::Storage(_) if element.has_states() => STORAGES + usize::from(element.derivative),
            Law::Storage(_) | Law::Source(_) => 1,
            _ => 0,
        }
    }

    fn images(&self, equation: &Equation) -> Row<u64> {
        let terms = equation.terms.iter();
        let images = terms.map(|(unknown, c)| (*unknown, self.pool.image(*c).0[0]));
        images.filter(|(_, image)| *image != 0).collect()
    }

    /// Whether the row is a combination of those taken.
    fn follows(&self, equation: &Equation) -> bool {
        self.exact.vanishes(self.images(equation))
    }

    /// Takes a row. With `cautious`, a row that says something new in general but not at the nominal state is left,
    /// and the answer is no.
    fn take(&mut self, equation: &Equation, row: usize, cautious: bool) -> bool {
        let value = |c: &Expression| {
            let value = self.nominal_values[c.node()];
            if c.is_negative() { -value } else { value }
        };
        let values = equation.terms.iter();
        let values = values.map(|(unknown, c)| (*unknown, value(c))).collect();
        let reduced = self.nominal.reduced(values);
        let own = match equation.owner {
            Owner::Element(id, _) if !is_cause(self.model, id) => None,
            Owner::Structure => None,
            owner => Some(owner),
        };
        let images = self.images(equation);
        if cautious && reduced.is_none() && !self.exact.vanishes(images.clone()) {
            return false;
        }
        match (self.exact.reduce(images, own), equation.owner) {
            (None, owner) => {
                if let Some(reduced) = reduced {
                    self.nominal.insert(reduced);
                }
                if let Owner::Coordinate(junction, component) = owner {
                    self.coordinates.insert((junction, component));
                }
            }
            (Some(causes), Owner::Element(element, component)) => {
                let own = Owner::Element(element, component);
                let causes = causes.into_iter().filter(|cause| *cause != own).collect();
                if storage(self.model, own).is_some() {
                    self.lost.push(Lost {
                        equation: row,
                        element,
                        component,
                        causes,
                    });
                } else {
                    self.sources.push((element, causes));
                }
            }
            (Some(_), Owner::Structure) => self.structure = true,
            (Some(_), Owner::Coordinate(..)) => {}
        }
        true
    }

    /// Reports storages and sources that cannot be accepted.
    fn report(&self, diagnostics: &mut Diagnostics) -> Verdict {
        let before = diagnostics.list().len();
        let mut sources: BTreeMap<ElementId, BTreeSet<Owner>> = BTreeMap::new();
        for (source, causes) in &self.sources {
            sources.entry(*source).or_default().extend(causes);
        }
        for (source, causes) in &sources {
            self.report_source(*source, causes, diagnostics);
        }
        let mut by_element: BTreeMap<ElementId, (usize, BTreeSet<Owner>)> = BTreeMap::new();
        for lost in &self.lost {
            let entry = by_element.entry(lost.element).or_default();
            entry.0 += 1;
            entry.1.extend(&lost.causes);
        }
        for (element, (count, causes)) in &by_element {
            if !self.model.graph.elements[element.0].derivative {
                self.report_storage(*element, *count, causes, diagnostics);
            }
        }
        let nothing =
            self.lost.is_empty() && self.sources.is_empty() && self.model.graph.closures.is_empty();
        let reported = diagnostics.list().len() > before;
        match (self.structure || nothing, reported) {
            (true, _) => Verdict::Undetermined,
            (false, true) => Verdict::Refused,
            (false, false) => Verdict::Accepted,
        }
    }

    fn names(&self, own: ElementId, causes: &BTreeSet<Owner>) -> String {
        let elements: BTreeSet<ElementId> = causes
            .iter()
            .filter_map(|cause| match cause {
                Owner::Element(id, _) if *id != own => Some(*id),
                _ => None,
            })
            .collect();
        let graph = &self.model.graph;
        listing(elements.iter().map(|id| graph.elements[id.0].name.clone()))
    }

    fn report_source(
        &self,
        id: ElementId,
        causes: &BTreeSet<Owner>,
        diagnostics: &mut Diagnostics,
    ) {
        let graph = &self.model.graph;
        let element = &graph.elements[id.0];
        let imposed = imposed(element.kind);
        let message = format!(
            "source `{}` imposes {imposed} that is imposed already",
            element.name
        );
        let span = graph.origins.span(element.origin);
        let report = error(codes::SOURCES_CONFLICT, span, message);
        let names = self.names(id, causes);
        let ring = self.model.rings.first();
        if let (ElementKind::Sf, true, Some(ring)) = (element.kind, names.is_empty(), ring) {
            return diagnostics.report(held_twice(report, ring));
        }
        let report = match names.is_empty() {
            true => report.note("the junction structure alone fixes it"),
            false => report.note(format!("it is fixed by {names}")),
        };
        diagnostics.report(match element.kind {
            ElementKind::Se => report.help(
                "give what it moves an inertia, such as a body on the frame that a joint carries",
            ),
            _ if names.is_empty() => report.help(
                "where joints form a loop, close it by a `Cut`, or by `close a -> b by multipliers;`",
            ),
            _ => report,
        });
    }

    fn report_storage(
        &self,
        id: ElementId,
        count: usize,
        causes: &BTreeSet<Owner>,
        diagnostics: &mut Diagnostics,
    ) {
        let graph = &self.model.graph;
        let element = &graph.elements[id.0];
        let components = if count == 1 {
            "one component".to_owned()
        } else {
            format!("{count} components")
        };
        let follow = if count == 1 { "follows" } else { "follow" };
        let names = match self.names(id, causes) {
            none if none.is_empty() => "the junction structure alone".to_owned(),
            names => names,
        };
        let message = format!(
            "storage `{}` depends on others: {components} of its {} {follow} from {names}",
            element.name,
            imposed(element.kind),
        );
        let report = error(
            codes::ORDER_LOST,
            graph.origins.span(element.origin),
            message,
        )
        .note("this is a true loss of order: no choice of strokes makes all of them states")
        .help(element.acceptance())
        .help(match element.kind {
            ElementKind::I => {
                "or put a spring and a damper between them, or merge the storages into one"
            }
            _ => "or put a resistor between them, or merge the storages into one",
        });
        diagnostics.report(report);
    }
}

/// A source that holds a ring of joints: what they hold twice is told at the joint that closes it.
fn held_twice(report: Diagnostic, ring: &Ring) -> Diagnostic {
    let [first, second] = &ring.components;
    let frame = &ring.frame;
    let report = Diagnostic {
        span: ring.span,
        ..report
    };
    report
        .note(format!(
            "`{first}` and `{second}` lead to `{frame}` from two sides, and hold a motion that the ring holds already"
        ))
        .help(ring.opened())
        .help("or close it by `close a -> b by multipliers;`")
}

/// What the element states about its bond.
fn imposed(kind: ElementKind) -> &'static str {
    if matches!(kind, ElementKind::I | ElementKind::Sf) {
        "flow"
    } else {
        "effort"
    }
}

fn is_cause(model: &Elaborated, id: ElementId) -> bool {
    matches!(
        model.graph.elements[id.0].law,
        Law::Source(_) | Law::Storage(_)
    )
}

/// Coefficients by node at the nominal state: initial values, default parameters, inputs zero.
fn nominal_values(model: &Elaborated, equations: &[Equation], pool: &Pool) -> Rc<[f64]> {
    let parameter = |symbol: Symbol| match symbol {
        Symbol::Parameter(index) => model.parameters[index].default,
        _ => 0.0,
    };
    let mut initial = Evaluation::new(&parameter);
    let states: Vec<f64> = model
        .states
        .iter()
        .map(|state| initial.value(pool, state.initial))
        .collect();
    let symbol = |symbol: Symbol| match symbol {
        Symbol::State(index) => states[index],
        other => parameter(other),
    };
    let mut evaluation = Evaluation::new(&symbol);
    let mut values = vec![f64::NAN; pool.len()];
    let coefficients = equations.iter();
    let coefficients = coefficients.flat_map(|equation| equation.terms.values());
    for coefficient in coefficients.chain([&Expression::ONE]) {
        values[coefficient.node()] = evaluation.value(pool, coefficient.magnitude());
    }
    values.into()
}
