//! Index reduction: what the equations become when some storages are no states.
//!
//! A dependent storage has its co-energy variable imposed, so its momentum or displacement is `J y`, and its other
//! variable the time derivative of that. The equations from which `y` follows are differentiated once (Pantelides
//! 1988), moduli included, with the rates `ẏ` as further unknowns; the rate of a coordinate stays free and is what
//! the balance of efforts determines. What was one singular system is then one regular system, which is solved like
//! any other.

use std::collections::{BTreeMap, BTreeSet};

use super::inverse::{Inverse, inverse, inverse_in, is_definite};
use super::levels;
use super::linear::Linear;
use super::matching;
use super::refused::{
    apart, report_input, report_second_derivative, report_unmoved, warn_of_jumps,
};
use super::selection::{Lost, Selection};
use crate::causality::report::alternatives;
use crate::codes;
use crate::diagnostics::{Diagnostics, error};
use crate::elaborate::{Elaborated, State, StateRate, Variable};
use crate::equations::{Equation, Independent, Inertia, Owner, Scalars, Turn, linearise};
use crate::graph::{ElementId, ElementKind, Law};
use crate::symbolic::substitute::symbols;
use crate::symbolic::{Differentiator, Expression, Pool, Rate, Substitution, Symbol};

/// What replaces the lost states.
pub struct Reduction {
    /// The extended equations.
    pub scalars: Scalars,
    /// Momentum or displacement of each lost state, in signals.
    pub momenta: BTreeMap<usize, Expression>,
}

/// How a symbol changes in time.
enum Change {
    /// At a rate that is known before the rates are solved for.
    Known(Expression),
    /// At the rate that this unknown is, or its negative.
    Unknown(usize, bool),
}

/// Reduces; coordinates become states of the model. None if something was reported.
pub fn reduce(
    model: &mut Elaborated,
    scalars: Scalars,
    selection: &Selection,
    pool: &mut Pool,
    diagnostics: &mut Diagnostics,
) -> Option<Reduction> {
    let mut reducer = Reducer {
        scalars,
        pool,
        momenta: BTreeMap::new(),
        signal_of: BTreeMap::new(),
        rate_of: BTreeMap::new(),
        determined: Vec::new(),
    };
    let before = diagnostics.list().len();
    let inverses = reducer.inverses(model, &selection.lost, diagnostics);
    if diagnostics.list().len() > before {
        return None;
    }
    reducer.express_momenta(model, &selection.lost, &inverses);
    reducer.replace_rows(model, selection);
    let mut matched = reducer.matched()?;
    let moved: BTreeSet<usize> = selection
        .lost
        .iter()
        .flat_map(|lost| reducer.imposed(model, lost, &inverses))
        .collect();
    let follow = reducer.close(
        &mut BTreeSet::new(),
        moved.iter().copied().collect(),
        &matched,
    );
    if follow.is_none() {
        reducer.expose(&moved);
        matched = reducer.matched()?;
    }
    let needed = reducer.closure(model, &matched, &selection.lost, &inverses, diagnostics)?;
    reducer.declare_rates(&needed);
    for unknown in &needed {
        reducer.differentiate(model, *unknown, matched[unknown], diagnostics);
    }
    reducer.constraints();
    reducer.dynamics(model, &selection.lost, &inverses, diagnostics);
    if diagnostics.list().len() > before {
        return None;
    }
    reducer.order(model, &matched, &selection.lost, &inverses);
    reducer.state_rates(model);
    Some(Reduction {
        scalars: reducer.scalars,
        momenta: reducer.momenta,
    })
}

/// Whether a coefficient is 1 or −1.
fn is_unit(coefficient: &Expression) -> bool {
    [Expression::ONE, Expression::ONE.negated()].contains(coefficient)
}

/// Takes so much of another equation, in which the unknown has the coefficient 1 or −1, that the unknown cancels.
fn cancel(pool: &mut Pool, equation: &mut Equation, other: &Equation, unknown: usize) {
    let Some(own) = equation.terms.get(&unknown).copied() else {
        return;
    };
    let factor = own.flipped(other.terms[&unknown].is_negative());
    for (unknown, coefficient) in &other.terms {
        let product = pool.multiply(factor, *coefficient);
        let term = equation.terms.entry(*unknown).or_insert(Expression::ZERO);
        *term = pool.subtract(*term, product);
    }
    equation.terms.retain(|_, term| *term != Expression::ZERO);
    let product = pool.multiply(factor, other.constant);
    equation.constant = pool.subtract(equation.constant, product);
}

struct Reducer<'a> {
    scalars: Scalars,
    pool: &'a mut Pool,
    momenta: BTreeMap<usize, Expression>,
    /// Signal that reads an unknown.
    signal_of: BTreeMap<usize, Expression>,
    /// Unknown that is the rate of an unknown.
    rate_of: BTreeMap<usize, usize>,
    /// Unknowns that follow from the states without any rate.
    determined: Vec<bool>,
}

impl Reducer<'_> {
    /// The inverse law of every storage that lost a state.
    fn inverses(
        &mut self,
        model: &Elaborated,
        lost: &[Lost],
        diagnostics: &mut Diagnostics,
    ) -> BTreeMap<ElementId, Inverse> {
        let elements: BTreeSet<ElementId> = lost.iter().map(|lost| lost.element).collect();
        let mut inverses = BTreeMap::new();
        for id in elements {
            let own = lost.iter().filter(|lost| lost.element == id);
            let components: Vec<usize> = own.clone().map(|lost| lost.component).collect();
            let whole = inverse(model, self.pool, id);
            if let Some(inverse) = whole.or_else(|| inverse_in(model, self.pool, id, &components)) {
                inverses.insert(id, inverse);
                continue;
            }
            let element = &model.graph.elements[id.0];
            let message = format!(
                "storage `{}` depends on others, and its nonlinear law cannot be inverted",
                element.name
            );
            let span = model.graph.origins.span(element.origin);
            let causes: BTreeSet<ElementId> = own
                .flat_map(|lost| &lost.causes)
                .filter_map(|cause| match cause {
                    Owner::Element(other, _) => Some(*other),
                    _ => None,
                })
                .collect();
            let mut others = causes.iter();
            let linear = others.any(|other| inverse(model, self.pool, *other).is_some());
            let linear = linear.then(|| {
                "write `#[derivative]` before another of the storages alone, whose law is linear, so that this one stays \
                 a state"
                    .to_owned()
            });
            let helps = linear.into_iter().chain([apart(model, id, &causes)]);
            let mut report = error(codes::ORDER_LOST_UNSUPPORTED, span, message);
            report.helps = alternatives(helps.collect());
            diagnostics.report(report);
        }
        inverses
    }

    /// The unknown that a storage states, its co-energy variable.
    fn coenergy(&self, model: &Elaborated, id: ElementId, component: usize) -> usize {
        let port = &self.scalars.ports[&id];
        if model.graph.elements[id.0].kind == ElementKind::I {
            port.flow[component]
        } else {
            port.effort[component]
        }
    }

    /// The unknown that is the rate of a storage's state, and whether it counts the other way.
    fn own_rate(&self, model: &Elaborated, id: ElementId, component: usize) -> (usize, bool) {
        let port = &self.scalars.ports[&id];
        if model.graph.elements[id.0].kind == ElementKind::I {
            (port.effort[component], port.effort_reversed)
        } else {
            (port.flow[component], port.flow_reversed)
        }
    }

    /// The expression that reads an unknown.
    fn signal(&mut self, unknown: usize) -> Expression {
        if let Some(known) = self.signal_of.get(&unknown) {
            return *known;
        }
        let number = self.scalars.signals.len();
        self.scalars.signals.push((unknown, false));
        let signal = self.pool.symbol(Symbol::Signal(number));
        self.signal_of.insert(unknown, signal);
        signal
    }

    /// `p = J (y − y₀)` for the lost states, everywhere.
    fn express_momenta(
        &mut self,
        model: &Elaborated,
        lost: &[Lost],
        inverses: &BTreeMap<ElementId, Inverse>,
    ) {
        for lost in lost {
            let Law::Storage(storage) = &model.graph.elements[lost.element.0].law else {
                continue;
            };
            let inverse = &inverses[&lost.element];
            let mut momentum = Expression::ZERO;
            for component in 0..inverse.matrix.columns {
                let unknown = self.coenergy(model, lost.element, component);
                let own = self.signal(unknown);
                let difference = self.pool.subtract(own, inverse.offset[component]);
                let term = self
                    .pool
                    .multiply(inverse.matrix.at(lost.component, component), difference);
                momentum = self.pool.add(momentum, term);
            }
            self.momenta
                .insert(storage.states.start + lost.component, momentum);
        }
        let mut substitution = Substitution::new();
        for (state, momentum) in &self.momenta {
            substitution.set(Symbol::State(*state), *momentum);
        }
        for equation in &mut self.scalars.equations {
            equation.replace(&mut substitution, self.pool);
            linearise(self.pool, equation, &self.scalars.signals);
        }
    }

    /// Takes the rows of the lost states away and puts those of the coordinates in.
    fn replace_rows(&mut self, model: &mut Elaborated, selection: &Selection) {
        let lost: BTreeSet<usize> = selection.lost.iter().map(|lost| lost.equation).collect();
        let mut position = 0;
        self.scalars.equations.retain(|_| {
            position += 1;
            !lost.contains(&(position - 1))
        });
        for (id, component, flow) in &selection.coordinates {
            let junction = &model.graph.junctions[id.0];
            let state = Symbol::State(model.states.len());
            let span = model.graph.origins.span(junction.origin);
            model.states.push(State {
                variable: Variable {
                    name: junction.flow(*component),
                    unit: String::new(),
                },
                initial: junction
                    .initial_flow
                    .get(*component)
                    .copied()
                    .unwrap_or(Expression::ZERO),
                is_given: false,
                rate: StateRate::Unknown(*flow),
                span,
            });
            self.scalars.equations.push(Equation {
                terms: BTreeMap::from([(*flow, Expression::ONE.negated())]),
                constant: self.pool.symbol(state),
                signals: Vec::new(),
                owner: Owner::Coordinate(*id, *component),
                about: [*flow; 2],
                level: None,
                rate: None,
            });
        }
    }

    /// The equation of every unknown that follows from the states alone (Dulmage and Mendelsohn 1958).
    fn matched(&mut self) -> Option<BTreeMap<usize, usize>> {
        let incidence: Vec<Vec<usize>> = self
            .scalars
            .equations
            .iter()
            .map(|equation| equation.unknowns().collect())
            .collect();
        let unknown_of = matching::of_all_equations(&incidence, self.scalars.unknowns)?;
        let mut containing = vec![Vec::new(); self.scalars.unknowns];
        for (row, equation) in self.scalars.equations.iter().enumerate() {
            for unknown in equation.unknowns() {
                containing[unknown].push(row);
            }
        }
        let mut determined = vec![false; self.scalars.unknowns];
        for unknown in &unknown_of {
            determined[*unknown] = true;
        }
        let mut open: Vec<usize> = (0..self.scalars.unknowns)
            .filter(|unknown| !determined[*unknown])
            .collect();
        while let Some(unknown) = open.pop() {
            for row in &containing[unknown] {
                if std::mem::replace(&mut determined[unknown_of[*row]], false) {
                    open.push(unknown_of[*row]);
                }
            }
        }
        self.determined = determined;
        Some(
            unknown_of
                .into_iter()
                .enumerate()
                .filter(|(_, unknown)| self.determined[*unknown])
                .map(|(row, unknown)| (unknown, row))
                .collect(),
        )
    }

    /// Co-energy variables that the momentum or displacement of a lost state holds.
    fn imposed(
        &self,
        model: &Elaborated,
        lost: &Lost,
        inverses: &BTreeMap<ElementId, Inverse>,
    ) -> Vec<usize> {
        let matrix = &inverses[&lost.element].matrix;
        (0..matrix.columns)
            .filter(|column| matrix.at(lost.component, *column) != Expression::ZERO)
            .map(|column| self.coenergy(model, lost.element, column))
            .collect()
    }

    /// Puts sums of rows in their place in which open unknowns cancel.
    ///
    /// Efforts around a mesh and flows into a part of the network may sum up to nothing but what follows from the states and
    /// the co-energy variables of lost ones, while no row by itself does: as where two capacitors lie beside each other
    /// between nodes of which neither is held. Which unknowns the rows hold does not tell that. Each such sum takes the
    /// place of one of its rows, so that the equations stay equivalent.
    fn expose(&mut self, moved: &BTreeSet<usize>) {
        let mut rows: BTreeMap<usize, Equation> = self
            .scalars
            .equations
            .iter()
            .enumerate()
            .filter(|(_, it)| it.owner == Owner::Structure && it.signals.is_empty())
            .map(|(row, equation)| (row, equation.clone()))
            .collect();
        let open: BTreeSet<usize> = rows
            .values()
            .flat_map(|equation| equation.terms.keys().copied())
            .filter(|unknown| !self.determined[*unknown] && !moved.contains(unknown))
            .collect();
        for unknown in &open {
            // Nothing is divided by, and rows of lost storages are kept for what is left.
            let pivot = rows
                .iter()
                .filter(|(_, it)| it.terms.get(unknown).is_some_and(is_unit))
                .min_by_key(|(row, it)| {
                    let is_kept = it.terms.keys().any(|unknown| moved.contains(unknown));
                    (is_kept, it.terms.len(), **row)
                })
                .map(|(row, _)| *row);
            let Some(pivot) = pivot.and_then(|row| rows.remove(&row)) else {
                continue;
            };
            for equation in rows.values_mut() {
                cancel(self.pool, equation, &pivot, *unknown);
            }
        }
        for (row, equation) in rows {
            let holds_any = |of: &BTreeSet<usize>| equation.terms.keys().any(|it| of.contains(it));
            if holds_any(moved) && !holds_any(&open) {
                self.scalars.equations[row] = equation;
            }
        }
    }

    /// Unknowns whose rates are needed: those that lost momenta hold, and whatever these follow from. None if one of
    /// them follows from a rate itself.
    fn closure(
        &self,
        model: &Elaborated,
        matched: &BTreeMap<usize, usize>,
        lost: &[Lost],
        inverses: &BTreeMap<ElementId, Inverse>,
        diagnostics: &mut Diagnostics,
    ) -> Option<BTreeSet<usize>> {
        let mut needed = BTreeSet::new();
        for lost in lost {
            let open = self.imposed(model, lost, inverses);
            if self.close(&mut needed, open, matched).is_none() {
                report_second_derivative(model, lost.element, diagnostics);
                return None;
            }
        }
        for (number, closure) in self.scalars.closures.iter().enumerate() {
            let open = closure.flows.iter().flatten().copied().collect();
            if self.close(&mut needed, open, matched).is_none() {
                report_unmoved(model, number, diagnostics);
                return None;
            }
        }
        Some(needed)
    }

    /// Adds unknowns and whatever they follow from; none if one of them follows from a rate.
    fn close(
        &self,
        needed: &mut BTreeSet<usize>,
        mut open: Vec<usize>,
        matched: &BTreeMap<usize, usize>,
    ) -> Option<()> {
        while let Some(unknown) = open.pop() {
            if needed.insert(unknown) {
                let equation = &self.scalars.equations[*matched.get(&unknown)?];
                open.extend(equation.unknowns());
            }
        }
        Some(())
    }

    /// `ḟ_from = ḟ_to` for every closure.
    fn constraints(&mut self) {
        for closure in self.scalars.closures.clone() {
            for (multiplier, [from, to]) in closure.multipliers.iter().zip(closure.flows) {
                let mut sum = Linear::default();
                sum.add(self.pool, self.rate_of[&from], Expression::ONE);
                sum.add(self.pool, self.rate_of[&to], Expression::ONE.negated());
                self.push(sum, Owner::Structure, [*multiplier; 2], None);
            }
        }
    }

    fn declare_rates(&mut self, needed: &BTreeSet<usize>) {
        for unknown in needed {
            self.rate_of.insert(*unknown, self.scalars.unknowns);
            self.scalars.unknowns += 1;
            let name = &self.scalars.names[*unknown];
            let name = if name.is_empty() {
                String::new()
            } else {
                format!("{name}.rate")
            };
            self.scalars.names.push(name);
            self.determined.push(false);
        }
    }

    /// The time derivative of the equation from which an unknown follows, unless it is that of a coordinate, whose rate is free.
    fn differentiate(
        &mut self,
        model: &Elaborated,
        unknown: usize,
        row: usize,
        diagnostics: &mut Diagnostics,
    ) {
        let equation = self.scalars.equations[row].clone();
        if let Owner::Coordinate(..) = equation.owner {
            return;
        }
        let mut left = equation.constant;
        for (term, coefficient) in &equation.terms {
            let own = self.signal(*term);
            let product = self.pool.multiply(*coefficient, own);
            left = self.pool.add(left, product);
        }
        warn_of_jumps(model, equation.owner, left, self.pool, diagnostics);
        let sum = self.total(model, left);
        if let Some(input) = sum.input {
            report_input(model, equation.owner, input, diagnostics);
        }
        let rate = self.rate_of.get(&unknown).copied();
        self.push(sum, equation.owner, equation.about, rate);
    }

    fn push(&mut self, sum: Linear, owner: Owner, about: [usize; 2], rate: Option<usize>) {
        let mut equation = Equation {
            terms: sum.terms,
            constant: sum.constant,
            signals: Vec::new(),
            owner,
            about,
            level: None,
            rate,
        };
        equation.terms.retain(|_, c| *c != Expression::ZERO);
        linearise(self.pool, &mut equation, &self.scalars.signals);
        self.scalars.equations.push(equation);
    }

    /// The time derivative of an expression, linear in rates.
    fn total(&mut self, model: &Elaborated, expression: Expression) -> Linear {
        let mut sum = Linear::default();
        if self.pool.rate(expression) != Rate::Varying {
            return sum;
        }
        let mut known = BTreeMap::new();
        for symbol in symbols(self.pool, &[expression]) {
            if let Symbol::Input(input) = symbol {
                sum.input = Some(input);
            }
            match self.change(model, symbol) {
                Some(Change::Known(rate)) => {
                    known.insert(symbol, rate);
                }
                Some(Change::Unknown(rate, reversed)) => {
                    let slope = Differentiator::new(symbol).derivative(self.pool, expression);
                    sum.add(self.pool, rate, slope.flipped(reversed));
                }
                None => {}
            }
        }
        // All at once: what several states move together, as those of an attitude do, is differentiated once.
        sum.constant = Differentiator::along(known).derivative(self.pool, expression);
        sum
    }

    /// How a symbol changes in time; none for one that stays.
    fn change(&mut self, model: &Elaborated, symbol: Symbol) -> Option<Change> {
        let state = match symbol {
            // Unknowns are given symbols of their own only where a reduced system is solved.
            Symbol::Parameter(_) | Symbol::Unknown(_) | Symbol::Slope(_) | Symbol::Input(_) => {
                return None;
            }
            Symbol::Time => return Some(Change::Known(Expression::ONE)),
            Symbol::Signal(signal) => {
                let (unknown, reversed) = self.scalars.signals[signal];
                return Some(Change::Unknown(self.rate_of[&unknown], reversed));
            }
            Symbol::State(state) => state,
        };
        Some(match model.states[state].rate {
            StateRate::Storage(id, component) => {
                let (unknown, reversed) = self.own_rate(model, id, component);
                if self.determined[unknown] {
                    Change::Known(self.signal(unknown).flipped(reversed))
                } else {
                    Change::Unknown(unknown, reversed)
                }
            }
            StateRate::Expression(rate) => Change::Known(rate),
            StateRate::Unknown(flow) => Change::Unknown(*self.rate_of.get(&flow)?, false),
        })
    }

    /// `ṗ = d/dt J (y − y₀)` for every lost state.
    fn dynamics(
        &mut self,
        model: &Elaborated,
        lost: &[Lost],
        inverses: &BTreeMap<ElementId, Inverse>,
        diagnostics: &mut Diagnostics,
    ) {
        for lost in lost {
            let inverse = &inverses[&lost.element];
            let owner = Owner::Element(lost.element, lost.component);
            let (rate, reversed) = self.own_rate(model, lost.element, lost.component);
            let mut sum = Linear::default();
            sum.add(self.pool, rate, Expression::ONE.negated().flipped(reversed));
            for component in 0..inverse.matrix.columns {
                let entry = inverse.matrix.at(lost.component, component);
                if entry == Expression::ZERO {
                    continue;
                }
                let unknown = self.coenergy(model, lost.element, component);
                sum.add(self.pool, self.rate_of[&unknown], entry);
                let offset = inverse.offset[component];
                let own = self.signal(unknown);
                let difference = self.pool.subtract(own, offset);
                let change = self.total(model, entry);
                sum.add_scaled(self.pool, &change, difference);
                let change = self.total(model, offset);
                sum.add_scaled(self.pool, &change, entry.negated());
            }
            if let Some(input) = sum.input {
                report_input(model, owner, input, diagnostics);
            }
            let port = &self.scalars.ports[&lost.element];
            let about = [port.effort[lost.component], port.flow[lost.component]];
            self.push(sum, owner, about, None);
        }
    }

    /// Puts unknowns and equations on their levels.
    fn order(
        &mut self,
        model: &Elaborated,
        matched: &BTreeMap<usize, usize>,
        lost: &[Lost],
        inverses: &BTreeMap<ElementId, Inverse>,
    ) {
        let is_state = |owner| match owner {
            Owner::Coordinate(..) => true,
            Owner::Element(id, _) => {
                matches!(model.graph.elements[id.0].law, Law::Storage(_))
            }
            Owner::Structure => false,
        };
        let moved: Vec<usize> = lost
            .iter()
            .map(|lost| self.coenergy(model, lost.element, lost.component))
            .collect();
        let (mut turns, deepest) =
            levels::assign(&self.scalars, matched, &self.rate_of, &moved, &is_state);
        for unknown in self.known_beforehand(matched, &turns) {
            turns[unknown] = None;
        }
        for equation in &mut self.scalars.equations {
            let about = equation
                .about
                .iter()
                .find_map(|unknown| self.rate_of.get(unknown));
            let rate = equation.rate.as_ref().or(about);
            equation.level = rate.and_then(|rate| turns[*rate]).map(|turn| turn.level);
        }
        let pool = &mut *self.pool;
        let definite = inverses
            .values()
            .all(|inverse| is_definite(model, &inverse.matrix, pool));
        self.independent(model, lost, &turns, definite);
        self.scalars.turns = turns;
        self.scalars.deepest = deepest;
        self.scalars.rate_of = self.rate_of.clone();
    }

    /// Efforts that follow from the states alone and divide by nothing that varies, each after those from which it
    /// follows; one that its law gives by iteration is among them. Others, such as the moment between concentric hinges,
    /// whose axes may come to lie in one plane, are eliminated with the rates that they belong to: so what is divided by
    /// are the inertias of the mechanism. Where loops are closed, all that follow from the states are known: what is left
    /// there has pivots of its own.
    fn known_beforehand(
        &self,
        matched: &BTreeMap<usize, usize>,
        turns: &[Option<Turn>],
    ) -> BTreeSet<usize> {
        let efforts: Vec<(usize, &Equation)> = matched
            .iter()
            .filter(|(unknown, _)| turns[**unknown].is_some())
            .map(|(unknown, row)| (*unknown, &self.scalars.equations[*row]))
            .collect();
        let mut open: BTreeSet<usize> = efforts.iter().map(|(unknown, _)| *unknown).collect();
        if !self.scalars.closures.is_empty() {
            return open;
        }
        let mut known = BTreeSet::new();
        loop {
            let is_ready = |(unknown, equation): &&(usize, &Equation)| {
                let mut others = equation.unknowns();
                let divisor = equation.terms.get(unknown);
                open.contains(unknown)
                    && divisor.is_none_or(|it| self.pool.rate(*it) != Rate::Varying)
                    && others.all(|other| other == *unknown || !open.contains(&other))
            };
            let ready: Vec<usize> = efforts.iter().filter(is_ready).map(|it| it.0).collect();
            if ready.is_empty() {
                return known;
            }
            open.retain(|unknown| !ready.contains(unknown));
            known.extend(ready);
        }
    }

    /// The independent rate of each level.
    fn independent(
        &mut self,
        model: &Elaborated,
        lost: &[Lost],
        turns: &[Option<Turn>],
        definite: bool,
    ) {
        for (number, state) in model.states.iter().enumerate() {
            let (unknown, imposed) = match state.rate {
                StateRate::Unknown(flow) => (self.rate_of.get(&flow).copied(), flow),
                StateRate::Storage(id, component) => (
                    Some(self.own_rate(model, id, component).0),
                    self.coenergy(model, id, component),
                ),
                StateRate::Expression(_) => continue,
            };
            let is_lost = self.momenta.contains_key(&number);
            let (Some(unknown), Some(rate), false) = (unknown, self.rate_of.get(&imposed), is_lost)
            else {
                continue;
            };
            let Some(Turn { level, .. }) = turns[*rate] else {
                continue;
            };
            let inertia = match state.rate {
                _ if !definite => Inertia::Unknown,
                StateRate::Unknown(_) => self.moved(model, lost, turns, number, level),
                StateRate::Storage(id, _) => match inverse(model, self.pool, id) {
                    Some(inverse) if is_definite(model, &inverse.matrix, self.pool) => Inertia::Own,
                    _ => Inertia::Unknown,
                },
                StateRate::Expression(_) => continue,
            };
            let independent = Independent { unknown, inertia };
            self.scalars.independent.insert(level, independent);
        }
    }

    /// Lost storages on the level of a coordinate.
    fn moved(
        &self,
        model: &Elaborated,
        lost: &[Lost],
        turns: &[Option<Turn>],
        state: usize,
        level: usize,
    ) -> Inertia {
        let mut storages: BTreeMap<ElementId, Vec<usize>> = BTreeMap::new();
        for lost in lost {
            let unknown = self.coenergy(model, lost.element, lost.component);
            let rate = self.rate_of.get(&unknown);
            let turn = rate.and_then(|rate| turns[*rate]);
            if turn.is_some_and(|turn| turn.level == level) {
                storages.entry(lost.element).or_default().push(unknown);
            }
        }
        let storages = storages.into_values().collect();
        Inertia::Moved { state, storages }
    }

    /// From now on the rate of a coordinate is an unknown of its own.
    fn state_rates(&mut self, model: &mut Elaborated) {
        for state in &mut model.states {
            if let StateRate::Unknown(flow) = state.rate
                && let Some(rate) = self.rate_of.get(&flow)
            {
                state.rate = StateRate::Unknown(*rate);
            }
        }
    }
}
