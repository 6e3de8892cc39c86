//! One model through all stages.

use std::collections::{BTreeMap, BTreeSet};

use crate::answers::Answers;
use crate::causality::outlook::Outlook;
use crate::causality::report::COMPONENTWISE;
use crate::changes;
use crate::checks::{self, Check};
use crate::closures;
use crate::codes;
use crate::diagnostics::{Diagnostics, error};
use crate::divisors;
use crate::drawing::{self, Drawn};
use crate::elaborate::{self, Elaborated};
use crate::equations::{self, Owner, Scalars};
use crate::graph::{Causality, ElementId, ElementKind};
use crate::jacobians;
use crate::loose;
use crate::network::Network;
use crate::notes;
use crate::program::{self, Program, Request};
use crate::scaling;
use crate::sparsity::Pattern;
use crate::start;
use crate::structure::{self, Failure, Formulation, Loop, Solution, Solved};
use crate::symbolic::print::Printer;
use crate::symbolic::{Expression, Pool, Symbol, jacobian, products, share};
use crate::syntax::ast;
use crate::units;

/// Everything that emission needs.
pub struct Compiled {
    /// The model in scalars.
    pub model: Elaborated,
    /// Candidate states that are states, in order.
    pub states: Vec<usize>,
    /// The program; its routines are numbered by [`Routines`].
    pub program: Program,
    /// Names of the inverted blocks.
    pub conditioning: Vec<String>,
    /// States that follow from others, with what they are.
    pub eliminated: Vec<(String, String)>,
    /// Algebraic loops in order of solution.
    pub loops: Vec<AlgebraicLoop>,
    /// Places of the states of each attitude, by row; rows that nothing reads are left out.
    pub attitudes: Vec<Vec<Vec<usize>>>,
    /// The closure behind each residual of positions and of flows.
    pub closed: [Vec<usize>; 2],
    /// The same of flows beside those that are given for the start; nothing where none is given.
    pub started: Vec<usize>,
    /// Whether rates of loops follow a source from the start on.
    pub driven: bool,
    /// Whose ranks `new` finds.
    pub ranks: closures::Ranks,
    /// Checks of parameters: place in the folded values or parameter, name, condition, reason.
    pub checks: Vec<Check>,
    /// Names of storages that the drawing puts into derivative causality.
    pub dependent: Vec<String>,
    /// Causal strokes by bond: true where the effort enters at `to`.
    pub strokes: Vec<bool>,
    /// Where the Jacobian by the states can differ from zero.
    pub pattern: Pattern,
    /// How many of the changes by time alone come once, and how others are told.
    pub changes: changes::Counts,
    /// The thresholds of each argument of choices.
    pub thresholds: Vec<changes::Kind>,
    /// Things worth knowing.
    pub notes: Vec<String>,
}

impl Compiled {
    /// How many unknowns each iteration finds, in order of solution.
    pub fn iterations(&self) -> impl Iterator<Item = usize> {
        let sizes = self.loops.iter().map(|found| found.iterated);
        sizes.filter(|size| *size > 0)
    }

    /// Operations of a routine per call.
    #[must_use]
    pub fn operations(&self, routine: usize) -> usize {
        self.program.routines[routine].operations()
    }

    /// Where the unknowns of an iteration begin among those of all.
    #[must_use]
    pub fn first(&self, number: usize) -> usize {
        self.iterations().take(number).sum()
    }
}

/// Variables that depend on each other without a storage between them.
pub struct AlgebraicLoop {
    /// Elements whose laws close it, or variables where the junction structure closes it.
    pub through: Vec<String>,
    /// Whether resistors close it, and not the junction structure alone.
    pub resistive: bool,
    /// Number of variables.
    pub variables: usize,
    /// How many of them an iteration finds; none where the loop is linear.
    pub iterated: usize,
}

/// Numbers of the routines.
pub struct Routines;

#[allow(missing_docs)]
impl Routines {
    pub const DERIVATIVE: usize = 0;
    pub const OUTPUT: usize = 1;
    pub const DERIVATIVE_AND_JACOBIAN: usize = 2;
    pub const JACOBIAN_INPUT: usize = 3;
    pub const ENERGY: usize = 4;
    pub const POWER: usize = 5;
    pub const CONDITIONING: usize = 6;
    pub const INITIAL: usize = 7;
    pub const CHECKS: usize = 8;
    pub const CLOSED_POSITIONS: usize = 9;
    pub const CLOSED_FLOWS: usize = 10;
    pub const DERIVATIVE_TIME: usize = 11;
    pub const CHANGES: usize = 12;
    pub const THRESHOLDS: usize = 13;
    pub const RESIDUALS_OF_POSITIONS: usize = 14;
    pub const RESIDUALS_OF_FLOWS: usize = 15;
    pub const SOUGHT: usize = 16;
    pub const STARTED_FLOWS: usize = 17;
    pub const RESIDUALS_OF_START: usize = 18;
    pub const SIDES: usize = 19;
}

/// Compiles one model; none if anything was reported.
#[must_use]
pub fn compile(
    model: &ast::Model,
    components: &BTreeMap<String, &ast::Component>,
    diagnostics: &mut Diagnostics,
) -> Option<Compiled> {
    let mut pool = Pool::new();
    let mut elaborated = elaborate::elaborate(model, components, &mut pool, diagnostics)?;
    let before = diagnostics.list().len();
    units::check(model, components, &elaborated, diagnostics);
    if diagnostics.list().len() > before {
        return None;
    }
    let network = Network::of(&elaborated.graph, &mut pool);
    let scalars = equations::form(&elaborated, &network, &mut pool);
    let first = structure::solve(&scalars, Formulation::Articulated, &mut pool);
    // What nothing holds would be told as storages that depend on each other.
    let uniform = elaborated.graph.causality == Causality::Uniform;
    let is_singular = matches!(first, Err(Failure::Singular));
    if uniform
        && is_singular
        && structure::report_floating(&elaborated, &scalars, &pool, diagnostics)
    {
        return None;
    }
    let outlook = || match first.is_ok() {
        true => Outlook::Soluble,
        false => structure::outlook(&elaborated, &pool),
    };
    let verdict = drawing::judge(&elaborated.graph, &outlook, diagnostics);
    let solved = verdict.and_then(|verdict| {
        let solved = structure::resolve(&mut elaborated, scalars, first, &mut pool, diagnostics)?;
        Some((verdict, solved))
    });
    let Some((verdict, solved)) = solved else {
        let mut helps = loose::holdings(&elaborated.graph);
        if uniform && let Some(ring) = elaborated.rings.first() {
            helps.push(ring.opened());
            helps.push(format!("or {COMPONENTWISE}"));
        }
        diagnostics.offer_first(before, &helps);
        return None;
    };
    let answers = Answers::of(&elaborated, &solved, &mut pool, diagnostics)?;
    finish(elaborated, &solved, answers, pool, verdict, diagnostics)
}

/// Requests everything a model is asked, and builds the program.
fn finish(
    mut model: Elaborated,
    solved: &Solved,
    answers: Answers,
    mut pool: Pool,
    verdict: Drawn,
    diagnostics: &mut Diagnostics,
) -> Option<Compiled> {
    structure::starting_momenta(&mut model, solved, &answers.states, &mut pool);
    let (scalars, solution, rates) = (&solved.scalars, &solved.solution, &answers.rates);
    let by_state: Vec<Symbol> = answers.states.iter().copied().map(Symbol::State).collect();
    let by_input: Vec<Symbol> = (0..model.inputs.len()).map(Symbol::Input).collect();
    let attitudes = attitudes(&model, &answers.states);
    let mut positions = closures::positions(&answers.displacements, &by_state, &mut pool);
    closures::tangential(&mut positions, &attitudes, &by_state, &mut pool);
    let [flows, started] = closures::rates(&model, solved, &by_state, &mut pool);
    let (checks, checked) = checks::of(&model, scalars, solution, &pool);
    let conditioning = scaling::scaled(&model, solution, &mut pool);
    let named = divisors::names(&model, scalars, solution, &pool);
    let divisors: Vec<_> = conditioning.iter().copied().zip(&named).collect();
    start::check(&model, &divisors, &pool, diagnostics);
    start::check_laws(&model, rates, &pool, diagnostics);
    if diagnostics.any() {
        return None;
    }
    let initial = answers.states.iter().map(|it| model.states[*it].initial);
    let groups = jacobians::groups(&model, &answers.states);
    let (by_states, pattern) = jacobians::request(&mut pool, rates, rates, &by_state, &groups);
    let inputs = [(0..by_input.len()).collect()];
    let (by_inputs, _) = jacobians::request(&mut pool, &[], rates, &by_input, &inputs);
    let (times, arguments) = changes::of(&mut pool, rates, &by_state);
    let requests: [Request; 20] = [
        rates.clone().into(),
        answers.outputs.clone().into(),
        by_states,
        by_inputs,
        vec![answers.energy].into(),
        vec![answers.supplied, answers.dissipated].into(),
        conditioning.clone().into(),
        initial.collect::<Vec<_>>().into(),
        checked.into(),
        positions.evaluated().into(),
        flows.evaluated().into(),
        jacobian(&mut pool, rates, &[Symbol::Time]).entries.into(),
        times.listed().into(),
        changes::listed(&arguments).into(),
        positions.values.clone().into(),
        flows.values.clone().into(),
        times.telling().into(),
        started.evaluated().into(),
        started.values.clone().into(),
        times.sides().into(),
    ];
    share(&mut pool, rates);
    shorten(&mut pool, &requests);
    let program = build(&pool, scalars, solution, &answers, &requests);
    if !program.is_finite() {
        report_infinite(&model, diagnostics);
        return None;
    }
    let written = |value: &Expression| text(&model, scalars, &pool, *value);
    let eliminated = answers.eliminated.iter().map(|(state, value)| {
        let name = model.states[*state].variable.name.clone();
        (name, written(value))
    });
    let mut notes = verdict.notes;
    loose::warn(&model, solved, diagnostics);
    notes.extend(notes::of(&model, solved, &answers, &pool, diagnostics));
    Some(Compiled {
        program,
        conditioning: named,
        loops: loops(&model, scalars, solution),
        eliminated: eliminated.collect(),
        attitudes,
        ranks: closures::ranks(scalars, &answers.displacements, &pool),
        driven: closures::are_driven(&model, &flows, &mut pool),
        closed: [positions.closures, flows.closures],
        started: started.closures,
        checks,
        dependent: verdict.dependent,
        strokes: verdict.strokes,
        pattern,
        changes: times.counts(),
        thresholds: arguments.iter().map(changes::Argument::kind).collect(),
        notes,
        states: answers.states,
        model,
    })
}

fn report_infinite(model: &Elaborated, diagnostics: &mut Diagnostics) {
    let message = "numbers of the model multiply to one that is not finite";
    let report = error(codes::NOT_FINITE, model.name.span(), message);
    diagnostics.report(report.help("choose units in which the values are of moderate size"));
}

/// Shortens a Jacobian that is written out.
fn shorten(pool: &mut Pool, requests: &[Request]) {
    let roots = |request: &Request| request.results.clone();
    let (before, rest) = requests.split_at(Routines::DERIVATIVE_AND_JACOBIAN);
    let Some((jacobian, behind)) = rest.split_first() else {
        return;
    };
    if jacobian.sweeps.is_empty() {
        let others = before.iter().chain(behind).flat_map(roots);
        let others: Vec<Expression> = others.collect();
        products(pool, &others, &jacobian.results);
    }
}

/// Where the states of each attitude went, by row.
fn attitudes(model: &Elaborated, states: &[usize]) -> Vec<Vec<Vec<usize>>> {
    let place = |state: &usize| states.binary_search(state).ok();
    let row = |row: &Vec<usize>| row.iter().map(place).collect::<Option<Vec<usize>>>();
    let attitudes = model.attitudes.iter();
    let kept = attitudes.map(|attitude| attitude.rows.iter().filter_map(row).collect());
    kept.filter(|rows: &Vec<Vec<usize>>| !rows.is_empty())
        .collect()
}

/// The program, with values named after what they are the values of.
fn build(
    pool: &Pool,
    scalars: &Scalars,
    solution: &Solution,
    answers: &Answers,
    requests: &[Request],
) -> Program {
    let numbered = answers.states.iter().enumerate();
    let places: BTreeMap<usize, usize> = numbered.map(|(place, state)| (*state, place)).collect();
    let place = |state: usize| places.get(&state).copied().unwrap_or(0);
    let mut names = BTreeMap::new();
    for (value, name) in solution.values.iter().zip(&scalars.names) {
        if !name.is_empty() {
            names.entry(value.node()).or_insert_with(|| name.clone());
        }
    }
    program::build(pool, requests, &place, &names)
}

/// An expression with the model's names.
pub(crate) fn text(
    model: &Elaborated,
    scalars: &Scalars,
    pool: &Pool,
    expression: Expression,
) -> String {
    let name = |symbol: Symbol| match symbol {
        Symbol::Unknown(index) => unknown_text(scalars, index),
        other => model.symbol_text(other),
    };
    Printer::new(pool, &name).text(expression)
}

/// The name of an unknown, or its number.
pub(crate) fn unknown_text(scalars: &Scalars, unknown: usize) -> String {
    match scalars.names.get(unknown) {
        Some(name) if !name.is_empty() => name.clone(),
        _ => format!("unknown {unknown}"),
    }
}

/// The loops, by the names of what closes them.
fn loops(model: &Elaborated, scalars: &Scalars, solution: &Solution) -> Vec<AlgebraicLoop> {
    let named = |found: &Loop| {
        let owners: BTreeSet<ElementId> = found
            .equations
            .iter()
            .filter_map(|equation| match scalars.equations[*equation].owner {
                Owner::Element(id, _) => Some(id),
                Owner::Structure | Owner::Coordinate(..) => None,
            })
            .collect();
        let name = |id: &ElementId| model.graph.elements[id.0].name.clone();
        let mut through: Vec<String> = owners.iter().map(name).collect();
        if through.is_empty() {
            through = structure::block_names(scalars, &found.unknowns);
        }
        AlgebraicLoop {
            through,
            resistive: owners
                .iter()
                .any(|id| model.graph.elements[id.0].kind == ElementKind::R),
            variables: found.unknowns.len(),
            iterated: found.iterated,
        }
    };
    solution.loops.iter().map(named).collect()
}
