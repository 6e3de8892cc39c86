//! Stage 4b, equations: one linear equation per unknown effort or flow.
//!
//! Input: the [`Network`] and the laws. Output: a [`Scalars`]: unknowns, and as many equations. An unknown is a
//! *class* of variables: all efforts at a 0-junction are one, all flows at a 1-junction are one. Storages are in
//! integral causality, so what they impose is known. A coefficient or constant may hold signals, which are unknowns
//! that enter nonlinearly; where an equation is affine in one, it becomes an ordinary term.

use std::collections::BTreeMap;

use crate::displacements;
use crate::elaborate::{Elaborated, Place, Quantity};
use crate::graph::{ElementId, ElementKind, JunctionId, JunctionKind, Law};
use crate::network::{Network, OnePort, Wire};
use crate::symbolic::substitute::symbols;
use crate::symbolic::{Expression, Matrix, Pool, Substitution, Symbol, affine};

/// Who states an equation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Owner {
    /// Junctions and two-ports.
    Structure,
    /// A one-port, by component.
    Element(ElementId, usize),
    /// The junction whose flow is a coordinate, by component.
    Coordinate(JunctionId, usize),
}

/// `Σ coefficient · unknown + constant = 0`.
#[derive(Clone, Debug)]
pub struct Equation {
    /// Unknowns with their coefficients.
    pub terms: BTreeMap<usize, Expression>,
    /// What is known.
    pub constant: Expression,
    /// Unknowns that enter nonlinearly.
    pub signals: Vec<usize>,
    /// Who states it.
    pub owner: Owner,
    /// The unknowns that it is about: effort and flow of a wire, or twice the common variable of a junction.
    pub about: [usize; 2],
    /// In a reduced system, its place in the order of elimination.
    pub level: Option<usize>,
    /// In a reduced system, the rate that it gives, if it gives one.
    pub rate: Option<usize>,
}

/// The scalar equations of a model.
pub struct Scalars {
    /// Number of unknowns.
    pub unknowns: usize,
    /// As many equations.
    pub equations: Vec<Equation>,
    /// Unknown behind each signal, with its sign.
    pub signals: Vec<(usize, bool)>,
    /// Unknowns at the port of each one-port: effort and flow by component, and whether the flow is reversed.
    pub ports: BTreeMap<ElementId, Port>,
    /// Readable name of each unknown.
    pub names: Vec<String>,
    /// Effort and flow of every component of every wire, wire by wire.
    pub wires: Vec<Vec<[usize; 2]>>,
    /// What the bonds at each junction share, by component: the effort of a 0-junction, the flow of a 1-junction.
    pub common: Vec<Vec<usize>>,
    /// Flows of the junctions marked `coordinate`, by component.
    pub coordinates: Vec<(JunctionId, usize, usize)>,
    /// For unknowns of a reduced system: the place of each in the order of elimination.
    pub turns: Vec<Option<Turn>>,
    /// In a reduced system, the unknown that is the rate of an unknown.
    pub rate_of: BTreeMap<usize, usize>,
    /// Loops that are closed by multipliers.
    pub closures: Vec<Closure>,
    /// The independent rate of each level of a reduced system.
    pub independent: BTreeMap<usize, Independent>,
    /// Most independent rates from which one rate follows.
    pub deepest: usize,
}

/// Two ends with one effort, the multiplier, and with flows that are to be equal. No equation says so: that of their
/// rates belongs to the reduced system.
#[derive(Clone, Debug)]
pub struct Closure {
    /// Multipliers by component.
    pub multipliers: Vec<usize>,
    /// Flows of both ends by component.
    pub flows: Vec<[usize; 2]>,
}

/// When an unknown of a reduced system is eliminated: level by level, and in a level the deepest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Turn {
    /// Position, from the leaves to the base, of the independent rate to which the unknown belongs.
    pub level: usize,
    /// How many equations lie between the states and the unknown.
    pub depth: usize,
}

impl Equation {
    /// All unknowns that enter, linearly or not.
    pub fn unknowns(&self) -> impl Iterator<Item = usize> {
        self.terms.keys().chain(&self.signals).copied()
    }

    /// Replaces symbols in its numbers, but where that would divide by zero.
    pub fn replace(&mut self, substitution: &mut Substitution, pool: &mut Pool) {
        let numbers = self.terms.values_mut().chain([&mut self.constant]);
        for number in numbers {
            if let Some(replaced) = substitution.apply(pool, *number) {
                *number = replaced;
            }
        }
    }
}

/// An independent rate of a reduced system.
#[derive(Clone, Debug)]
pub struct Independent {
    /// The unknown.
    pub unknown: usize,
    /// Why what is divided by for its sake is positive.
    pub inertia: Inertia,
}

/// What moves with an independent rate while all lower levels are held.
#[derive(Clone, Debug)]
pub enum Inertia {
    /// Nothing is known.
    Unknown,
    /// A storage with a positive definite law, of which it is the rate.
    Own,
    /// Storages with positive definite laws, each by its co-energy variables, as far as these move with the state
    /// given.
    Moved {
        /// The coordinate.
        state: usize,
        /// Co-energy variables of each storage.
        storages: Vec<Vec<usize>>,
    },
}

/// Efforts and flows at a one-port.
#[derive(Clone, Debug)]
pub struct Port {
    /// Efforts by component.
    pub effort: Vec<usize>,
    /// Flows by component, along the bond.
    pub flow: Vec<usize>,
    /// Whether positive power goes into the element along the bond.
    pub inward: bool,
    /// Whether the element's own effort is the negative of the bond's.
    pub effort_reversed: bool,
    /// Whether the element's own flow is the negative of the bond's.
    pub flow_reversed: bool,
}

/// Forms the equations.
#[must_use]
pub fn form(model: &Elaborated, network: &Network, pool: &mut Pool) -> Scalars {
    let classes = Classes::of(network);
    let mut former = Former {
        model,
        network,
        pool,
        classes,
        equations: Vec::new(),
    };
    former.junctions();
    former.two_ports();
    for one_port in network.one_ports.iter().flatten() {
        former.one_port(one_port);
    }
    former.finish()
}

/// Union of variables that a junction makes equal. Variable `2 w` is an effort, `2 w + 1` a flow, of scalar wire w.
struct Classes {
    first: Vec<usize>,
    class: Vec<usize>,
    count: usize,
}

impl Classes {
    fn of(network: &Network) -> Self {
        let mut first = Vec::with_capacity(network.wires.len());
        let mut total = 0;
        for wire in &network.wires {
            first.push(total);
            total += wire.dimension;
        }
        let mut parent: Vec<usize> = (0..2 * total).collect();
        let mut live = vec![false; 2 * total];
        let mut mark = |wire: usize| {
            live[2 * first[wire]..2 * (first[wire] + network.wires[wire].dimension)].fill(true);
        };
        network.two_ports.iter().for_each(|two_port| {
            mark(two_port.input);
            mark(two_port.output);
        });
        network
            .one_ports
            .iter()
            .flatten()
            .for_each(|one_port| mark(one_port.wire));
        for junction in &network.junctions {
            junction
                .branches
                .iter()
                .for_each(|branch| mark(branch.wire));
            let offset = usize::from(junction.kind == JunctionKind::One);
            for component in 0..junction.dimension {
                let mut members = junction
                    .branches
                    .iter()
                    .filter(|branch| branch.range.contains(&component))
                    .map(|branch| {
                        2 * (first[branch.wire] + component - branch.range.start) + offset
                    });
                if let Some(leader) = members.next() {
                    for member in members {
                        let (a, b) = (root(&mut parent, leader), root(&mut parent, member));
                        parent[a.max(b)] = a.min(b);
                    }
                }
            }
        }
        for [from, to] in &network.closures {
            for component in 0..network.wires[*from].dimension {
                let (a, b) = (2 * (first[*from] + component), 2 * (first[*to] + component));
                let (a, b) = (root(&mut parent, a), root(&mut parent, b));
                parent[a.max(b)] = a.min(b);
            }
        }
        Self::number(first, parent, &live)
    }

    fn number(first: Vec<usize>, mut parent: Vec<usize>, live: &[bool]) -> Self {
        let mut class = vec![usize::MAX; parent.len()];
        let mut count = 0;
        for variable in 0..parent.len() {
            let leader = root(&mut parent, variable);
            if live[variable] && class[leader] == usize::MAX {
                class[leader] = count;
                count += 1;
            }
            class[variable] = class[leader];
        }
        Self {
            first,
            class,
            count,
        }
    }

    fn pair(&self, wire: usize, component: usize) -> [usize; 2] {
        [self.effort(wire, component), self.flow(wire, component)]
    }

    fn effort(&self, wire: usize, component: usize) -> usize {
        self.class[2 * (self.first[wire] + component)]
    }

    fn flow(&self, wire: usize, component: usize) -> usize {
        self.class[2 * (self.first[wire] + component) + 1]
    }
}

fn root(parent: &mut [usize], mut variable: usize) -> usize {
    while parent[variable] != variable {
        parent[variable] = parent[parent[variable]];
        variable = parent[variable];
    }
    variable
}

struct Former<'a> {
    model: &'a Elaborated,
    network: &'a Network,
    pool: &'a mut Pool,
    classes: Classes,
    equations: Vec<Equation>,
}

impl Former<'_> {
    fn add(
        &mut self,
        terms: &[(usize, Expression)],
        constant: Expression,
        owner: Owner,
        about: [usize; 2],
    ) {
        let mut sum: BTreeMap<usize, Expression> = BTreeMap::new();
        let is_there = |(_, coefficient): &&(usize, Expression)| *coefficient != Expression::ZERO;
        for (unknown, coefficient) in terms.iter().filter(is_there) {
            let known = sum.get(unknown).copied().unwrap_or(Expression::ZERO);
            sum.insert(*unknown, self.pool.add(known, *coefficient));
        }
        sum.retain(|_, coefficient| *coefficient != Expression::ZERO);
        self.equations.push(Equation {
            terms: sum,
            constant,
            signals: Vec::new(),
            owner,
            about,
            level: None,
            rate: None,
        });
    }

    /// At a 0-junction flows sum to zero, at a 1-junction efforts.
    fn junctions(&mut self) {
        for junction in &self.network.junctions {
            for component in 0..junction.dimension {
                let terms: Vec<(usize, Expression)> = junction
                    .branches
                    .iter()
                    .filter(|branch| branch.range.contains(&component))
                    .map(|branch| {
                        let inner = component - branch.range.start;
                        let unknown = match junction.kind {
                            JunctionKind::Zero => self.classes.flow(branch.wire, inner),
                            JunctionKind::One => self.classes.effort(branch.wire, inner),
                        };
                        (unknown, Expression::ONE.flipped(!branch.inward))
                    })
                    .collect();
                let common = junction
                    .branches
                    .iter()
                    .find(|branch| branch.range.contains(&component))
                    .map(|branch| {
                        let inner = component - branch.range.start;
                        match junction.kind {
                            JunctionKind::Zero => self.classes.effort(branch.wire, inner),
                            JunctionKind::One => self.classes.flow(branch.wire, inner),
                        }
                    });
                if let Some(common) = common {
                    self.add(&terms, Expression::ZERO, Owner::Structure, [common; 2]);
                }
            }
        }
    }

    /// `f_out = M f_in` and `e_in = Mᵀ e_out`, or for a gyrator `e_out = G f_in` and `e_in = Gᵀ f_out`.
    fn two_ports(&mut self) {
        for two_port in &self.network.two_ports {
            let matrix = two_port.factor.to_matrix(self.pool);
            let (input, output) = (two_port.input, two_port.output);
            for row in 0..matrix.rows {
                let result = if two_port.gyrator {
                    self.classes.effort(output, row)
                } else {
                    self.classes.flow(output, row)
                };
                let mut terms = vec![(result, Expression::ONE.negated())];
                terms.extend(
                    (0..matrix.columns).map(|k| (self.classes.flow(input, k), matrix.at(row, k))),
                );
                let about = self.classes.pair(output, row);
                self.add(&terms, Expression::ZERO, Owner::Structure, about);
            }
            for column in 0..matrix.columns {
                let mut terms = vec![(
                    self.classes.effort(input, column),
                    Expression::ONE.negated(),
                )];
                terms.extend((0..matrix.rows).map(|k| {
                    let unknown = if two_port.gyrator {
                        self.classes.flow(output, k)
                    } else {
                        self.classes.effort(output, k)
                    };
                    (unknown, matrix.at(k, column))
                }));
                let about = self.classes.pair(input, column);
                self.add(&terms, Expression::ZERO, Owner::Structure, about);
            }
        }
    }

    fn one_port(&mut self, one_port: &OnePort) {
        let element = &self.model.graph.elements[one_port.element.0];
        let id = one_port.element;
        let wire = one_port.wire;
        let reversed = !one_port.inward;
        let minus = Expression::ONE.negated();
        let size = self.network.wires[wire].dimension;
        match &element.law {
            Law::Source(values) => {
                for (component, value) in values.iter().enumerate() {
                    let unknown = match element.kind {
                        ElementKind::Se => self.classes.effort(wire, component),
                        _ => self.classes.flow(wire, component),
                    };
                    self.one_port_row(id, wire, component, &[(unknown, minus)], *value);
                }
            }
            Law::Storage(storage) => {
                for (component, value) in storage.coenergy.iter().enumerate() {
                    let unknown = if element.kind == ElementKind::I {
                        self.classes.flow(wire, component)
                    } else {
                        self.classes.effort(wire, component)
                    };
                    self.one_port_row(id, wire, component, &[(unknown, minus)], *value);
                }
            }
            Law::Resistance(matrix) => self.linear(matrix, one_port, false),
            Law::Conductance(matrix) => self.linear(matrix, one_port, true),
            Law::EffortLaw(values) => {
                for (component, value) in values.iter().enumerate() {
                    let unknown = self.classes.effort(wire, component);
                    self.one_port_row(id, wire, component, &[(unknown, minus)], *value);
                }
            }
            Law::FlowLaw(values) => {
                for (component, value) in values.iter().enumerate() {
                    let unknown = self.classes.flow(wire, component);
                    let terms = [(unknown, minus.flipped(reversed))];
                    self.one_port_row(id, wire, component, &terms, *value);
                }
            }
            Law::EulerJunction(momentum) => {
                // e = ω × h, row by row.
                for row in 0..size.min(3) {
                    let (next, last) = ((row + 1) % 3, (row + 2) % 3);
                    let terms = [
                        (self.classes.effort(wire, row), minus),
                        (
                            self.classes.flow(wire, next),
                            momentum[last].flipped(reversed),
                        ),
                        (
                            self.classes.flow(wire, last),
                            momentum[next].negated().flipped(reversed),
                        ),
                    ];
                    self.one_port_row(id, wire, row, &terms, Expression::ZERO);
                }
            }
            Law::Transformer(_) | Law::Gyrator(_) => {}
        }
    }

    /// `e = R f`, or `f = G e`.
    fn linear(&mut self, matrix: &Matrix, one_port: &OnePort, conductance: bool) {
        let (wire, reversed) = (one_port.wire, !one_port.inward);
        for row in 0..matrix.rows {
            let (effort, flow) = (self.classes.effort(wire, row), self.classes.flow(wire, row));
            let result = if conductance { flow } else { effort };
            let mut terms = vec![(result, Expression::ONE.negated())];
            for column in 0..matrix.columns {
                let cause = if conductance {
                    self.classes.effort(wire, column)
                } else {
                    self.classes.flow(wire, column)
                };
                terms.push((cause, matrix.at(row, column).flipped(reversed)));
            }
            self.one_port_row(one_port.element, wire, row, &terms, Expression::ZERO);
        }
    }

    fn one_port_row(
        &mut self,
        element: ElementId,
        wire: usize,
        component: usize,
        terms: &[(usize, Expression)],
        constant: Expression,
    ) {
        let about = self.classes.pair(wire, component);
        self.add(terms, constant, Owner::Element(element, component), about);
    }

    fn finish(mut self) -> Scalars {
        let ports = self.ports();
        let signals: Vec<(usize, bool)> = self
            .model
            .signals
            .list()
            .iter()
            .map(|s| self.signal(*s, &ports))
            .collect();
        let mut equations = std::mem::take(&mut self.equations);
        let mut told = displacements::substitution(self.model);
        for equation in &mut equations {
            equation.replace(&mut told, self.pool);
            linearise(self.pool, equation, &signals);
        }
        let common = self.common(&ports);
        let names = self.names(&ports, &common);
        let coordinates = self.coordinates(&ports);
        let closures = self.closures();
        let live = |pair: &[usize; 2]| pair.iter().all(|class| *class != usize::MAX);
        let wire = |(wire, entry): (usize, &Wire)| -> Vec<[usize; 2]> {
            (0..entry.dimension)
                .map(|component| self.classes.pair(wire, component))
                .filter(live)
                .collect()
        };
        let wires = self.network.wires.iter().enumerate().map(wire).collect();
        Scalars {
            unknowns: self.classes.count,
            equations,
            signals,
            ports,
            names,
            wires,
            common,
            coordinates,
            turns: vec![None; self.classes.count],
            rate_of: BTreeMap::new(),
            closures,
            independent: BTreeMap::new(),
            deepest: 0,
        }
    }

    fn closures(&self) -> Vec<Closure> {
        let closure = |[from, to]: &[usize; 2]| {
            let components = 0..self.network.wires[*from].dimension;
            Closure {
                multipliers: components
                    .clone()
                    .map(|component| self.classes.effort(*from, component))
                    .collect(),
                flows: components
                    .map(|component| [from, to].map(|wire| self.classes.flow(*wire, component)))
                    .collect(),
            }
        };
        self.network.closures.iter().map(closure).collect()
    }

    fn coordinates(&self, ports: &BTreeMap<ElementId, Port>) -> Vec<(JunctionId, usize, usize)> {
        let marked = self.model.graph.junctions.iter().enumerate();
        marked
            .filter(|(_, junction)| junction.coordinate && junction.kind == JunctionKind::One)
            .flat_map(|(id, junction)| (0..junction.dimension).map(move |k| (JunctionId(id), k)))
            .map(|(id, component)| {
                let signal = (Quantity::Flow, Place::Junction(id), component);
                (id, component, self.signal(signal, ports).0)
            })
            .collect()
    }

    fn ports(&self) -> BTreeMap<ElementId, Port> {
        let port = |one_port: &OnePort| {
            let size = self.network.wires[one_port.wire].dimension;
            let effort = (0..size)
                .map(|k| self.classes.effort(one_port.wire, k))
                .collect();
            let flow = (0..size)
                .map(|k| self.classes.flow(one_port.wire, k))
                .collect();
            // An element that sends power along its bond keeps the variable that it imposes and turns the other round;
            // a source states both along its bond.
            let kind = self.model.graph.elements[one_port.element.0].kind;
            let source = matches!(kind, ElementKind::Se | ElementKind::Sf);
            let reversed = !one_port.inward && !source;
            let port = Port {
                effort,
                flow,
                inward: one_port.inward,
                effort_reversed: reversed && kind == ElementKind::I,
                flow_reversed: reversed && kind != ElementKind::I,
            };
            (one_port.element, port)
        };
        self.network.one_ports.iter().flatten().map(port).collect()
    }

    fn signal(
        &self,
        (quantity, place, component): (Quantity, Place, usize),
        ports: &BTreeMap<ElementId, Port>,
    ) -> (usize, bool) {
        match place {
            Place::Port(id) => {
                let port = &ports[&id];
                match quantity {
                    Quantity::Effort => (port.effort[component], port.effort_reversed),
                    Quantity::Flow => (port.flow[component], port.flow_reversed),
                }
            }
            Place::Junction(id) => {
                let junction = &self.network.junctions[self.network.place[id.0]];
                let branch = junction
                    .branches
                    .iter()
                    .find(|branch| branch.range.contains(&component));
                let unknown = branch.map_or(0, |branch| {
                    let inner = component - branch.range.start;
                    match quantity {
                        Quantity::Effort => self.classes.effort(branch.wire, inner),
                        Quantity::Flow => self.classes.flow(branch.wire, inner),
                    }
                });
                (unknown, false)
            }
        }
    }

    fn common(&self, ports: &BTreeMap<ElementId, Port>) -> Vec<Vec<usize>> {
        let junctions = self.model.graph.junctions.iter().enumerate();
        let common = junctions.map(|(id, junction)| {
            let (quantity, _) = shared(junction.kind);
            let place = Place::Junction(JunctionId(id));
            let components = 0..junction.dimension;
            let unknowns =
                components.map(|component| self.signal((quantity, place, component), ports).0);
            unknowns.collect()
        });
        common.collect()
    }

    fn names(&self, ports: &BTreeMap<ElementId, Port>, common: &[Vec<usize>]) -> Vec<String> {
        let mut names = vec![String::new(); self.classes.count];
        for (junction, unknowns) in self.model.graph.junctions.iter().zip(common) {
            let (_, letter) = shared(junction.kind);
            for (component, unknown) in unknowns.iter().enumerate() {
                put(
                    &mut names[*unknown],
                    &junction.name,
                    letter,
                    component,
                    junction.dimension,
                );
            }
        }
        for (id, port) in ports {
            let element = &self.model.graph.elements[id.0].name;
            for component in 0..port.effort.len() {
                put(
                    &mut names[port.effort[component]],
                    element,
                    "e",
                    component,
                    port.effort.len(),
                );
                put(
                    &mut names[port.flow[component]],
                    element,
                    "f",
                    component,
                    port.flow.len(),
                );
            }
        }
        names
    }
}

/// What the bonds at a junction share, and its letter.
fn shared(kind: JunctionKind) -> (Quantity, &'static str) {
    match kind {
        JunctionKind::Zero => (Quantity::Effort, "e"),
        JunctionKind::One => (Quantity::Flow, "f"),
    }
}

fn put(slot: &mut String, name: &str, letter: &str, component: usize, dimension: usize) {
    if slot.is_empty() {
        *slot = if dimension == 1 {
            format!("{name}.{letter}")
        } else {
            format!(
                "{name}.{letter}.{}",
                crate::graph::component_name(component, dimension)
            )
        };
    }
}

/// Turns signals that enter linearly into terms; lists those that do not.
pub fn linearise(pool: &mut Pool, equation: &mut Equation, signals: &[(usize, bool)]) {
    for symbol in symbols(pool, &[equation.constant]) {
        let Symbol::Signal(number) = symbol else {
            continue;
        };
        let signal = |symbol: &Symbol| matches!(symbol, Symbol::Signal(_));
        let Some((slope, rest)) = affine(pool, equation.constant, symbol, signal) else {
            continue;
        };
        let (unknown, reversed) = signals[number];
        let known = equation
            .terms
            .get(&unknown)
            .copied()
            .unwrap_or(Expression::ZERO);
        let sum = pool.add(known, slope.flipped(reversed));
        if sum == Expression::ZERO {
            equation.terms.remove(&unknown);
        } else {
            equation.terms.insert(unknown, sum);
        }
        equation.constant = rest;
    }
    equation.signals.clear();
    let mut held: Vec<Expression> = equation.terms.values().copied().collect();
    held.push(equation.constant);
    for symbol in symbols(pool, &held) {
        if let Symbol::Signal(number) = symbol {
            equation.signals.push(signals[number].0);
        }
    }
}
