//! One model through all stages.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::Span;

use crate::closures;
use crate::codes;
use crate::diagnostics::{Diagnostics, error, listing};
use crate::drawing::{self, Drawn};
use crate::elaborate::{self, Condition, Elaborated, State, StateRate, Variable};
use crate::equations::{self, Equation, Owner, Scalars};
use crate::graph::{ElementId, ElementKind, Law};
use crate::network::Network;
use crate::program::{self, Program};
use crate::structure::{self, Failure, Loop, Solution, Undetermined};
use crate::symbolic::print::Printer;
use crate::symbolic::substitute::symbols;
use crate::symbolic::{Expression, Pool, Rate, Substitution, Symbol, jacobian, share};
use crate::syntax::ast;

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
    /// The closure behind each residual of positions and of flows.
    pub closed: [Vec<usize>; 2],
    /// Checks of parameters: place in the folded values or parameter, name, condition, reason.
    pub checks: Vec<Check>,
    /// Names of storages that the drawing puts into derivative causality.
    pub dependent: Vec<String>,
    /// Causal strokes by bond: true where the effort enters at `to`.
    pub strokes: Vec<bool>,
    /// Things worth knowing.
    pub notes: Vec<String>,
}

impl Compiled {
    /// How many unknowns each iteration finds, in order of solution.
    pub fn iterations(&self) -> impl Iterator<Item = usize> {
        let sizes = self.loops.iter().map(|found| found.iterated);
        sizes.filter(|size| *size > 0)
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
    /// Number of variables.
    pub variables: usize,
    /// How many of them an iteration finds; none where the loop is linear.
    pub iterated: usize,
}

/// A check that `new` makes.
pub struct Check {
    /// The parameter, or the expression of parameters.
    pub name: String,
    /// What must hold.
    pub condition: Condition,
    /// Why.
    pub reason: String,
}

/// Numbers of the routines.
pub struct Routines;

#[allow(missing_docs)]
impl Routines {
    pub const DERIVATIVE: usize = 0;
    pub const OUTPUT: usize = 1;
    pub const JACOBIAN_STATE: usize = 2;
    pub const JACOBIAN_INPUT: usize = 3;
    pub const ENERGY: usize = 4;
    pub const POWER: usize = 5;
    pub const CONDITIONING: usize = 6;
    pub const INITIAL: usize = 7;
    pub const CHECKS: usize = 8;
    pub const CLOSED_POSITIONS: usize = 9;
    pub const CLOSED_FLOWS: usize = 10;
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
    let network = Network::of(&elaborated.graph, &mut pool);
    let scalars = equations::form(&elaborated, &network, &mut pool);
    let first = structure::solve(&scalars, &mut pool);
    let soluble = !matches!(first, Err(Failure::Singular));
    let verdict = drawing::judge(&elaborated.graph, soluble, diagnostics)?;
    let solved = solve(&mut elaborated, scalars, first, &mut pool, diagnostics)?;
    let (scalars, solution) = (&solved.scalars, &solved.solution);
    let answers = Answers::of(&elaborated, &solved, &mut pool, diagnostics)?;
    finish(
        elaborated,
        scalars,
        solution,
        answers,
        pool,
        verdict,
        diagnostics,
    )
}

/// Equations with their solution.
struct Solved {
    scalars: Scalars,
    solution: Solution,
    /// Momentum or displacement of every state that was lost, in signals.
    momenta: BTreeMap<usize, Expression>,
}

/// The solution of the equations, with an index reduction where storages depend on each other and the `first` attempt
/// failed.
fn solve(
    model: &mut Elaborated,
    scalars: Scalars,
    first: Result<Solution, Failure>,
    pool: &mut Pool,
    diagnostics: &mut Diagnostics,
) -> Option<Solved> {
    match first {
        Ok(solution) => {
            return Some(Solved {
                scalars,
                solution,
                momenta: BTreeMap::new(),
            });
        }
        Err(Failure::Undetermined(found)) => {
            report_undetermined(model, &scalars, pool, &found, diagnostics);
            return None;
        }
        Err(Failure::Singular) => {}
    }
    let selection = structure::select(model, &scalars, pool, diagnostics)?;
    let reduction = structure::reduce(model, scalars, &selection, pool, diagnostics)?;
    let scalars = reduction.scalars;
    match structure::solve(&scalars, pool) {
        Ok(solution) => Some(Solved {
            scalars,
            solution,
            momenta: reduction.momenta,
        }),
        Err(Failure::Undetermined(found)) => {
            report_undetermined(model, &scalars, pool, &found, diagnostics);
            None
        }
        Err(Failure::Singular) => {
            let message = "the efforts between dependent storages are undetermined";
            diagnostics.error(codes::SINGULAR_JUNCTIONS, model.name.span(), message);
            None
        }
    }
}

/// A nonlinear loop whose Jacobian is identically singular: its equations, and the slopes that show it.
fn report_undetermined(
    model: &Elaborated,
    scalars: &Scalars,
    pool: &Pool,
    found: &Undetermined,
    diagnostics: &mut Diagnostics,
) {
    let names = listing(structure::block_names(scalars, &found.unknowns));
    let message = "a nonlinear algebraic loop does not determine its variables";
    let span = nonlinear_law(model, scalars, &found.unknowns);
    let mut report =
        error(codes::NONLINEAR_LOOP, span, message).note(format!("the loop runs through {names}"));
    for (row, residual) in found.residuals.iter().enumerate() {
        report = report.note(format!("0 = {}", text(model, scalars, pool, *residual)));
        for (column, unknown) in found.left.iter().enumerate() {
            let slope = text(model, scalars, pool, found.jacobian.at(row, column));
            let by = &scalars.names[*unknown];
            report = report.note(format!("  its derivative by `{by}` is {slope}"));
        }
    }
    diagnostics.report(
        report
            .note("the determinant of these derivatives is zero, whatever the state")
            .help(
                "put a storage into the loop: `I body { inertia: … }` at a 1-junction of it, or \
                 `C spring { stiffness: … }` at a 0-junction",
            ),
    );
}

/// Where the law stands in which unknowns of a loop enter nonlinearly.
fn nonlinear_law(model: &Elaborated, scalars: &Scalars, unknowns: &[usize]) -> Span {
    let graph = &model.graph;
    let nonlinear = |equation: &&Equation| equation.signals.iter().any(|it| unknowns.contains(it));
    match scalars.equations.iter().find(nonlinear).map(|it| it.owner) {
        Some(Owner::Element(id, _)) => graph.origins.span(graph.elements[id.0].origin),
        _ => model.name.span(),
    }
}

/// What the functions of the model return.
struct Answers {
    states: Vec<usize>,
    rates: Vec<Expression>,
    outputs: Vec<Expression>,
    energy: Expression,
    supplied: Expression,
    dissipated: Expression,
    /// Displacements of closures: number, component, value.
    displacements: Vec<(usize, usize, Expression)>,
    /// What each lost state is in terms of the others.
    eliminated: Vec<(usize, Expression)>,
}

impl Answers {
    fn of(
        model: &Elaborated,
        solved: &Solved,
        pool: &mut Pool,
        diagnostics: &mut Diagnostics,
    ) -> Option<Self> {
        let (scalars, solution) = (&solved.scalars, &solved.solution);
        let mut substitution = substitution(solved, pool)?;
        let mut replaced = |pool: &mut Pool, expression, variable: &Variable, span| {
            let value = substitution.apply(pool, expression);
            if value.is_none() {
                let message = format!("`{}` divides by zero, whatever the state", variable.name);
                diagnostics.error(codes::NOT_FINITE, span, message);
            }
            value
        };
        let all: Vec<Option<Expression>> = model
            .states
            .iter()
            .map(|state| match state.rate {
                StateRate::Storage(id, component) => {
                    Some(storage_rate(model, scalars, solution, id, component))
                }
                StateRate::Expression(rate) => replaced(pool, rate, &state.variable, state.span),
                StateRate::Unknown(rate) => Some(solution.values[rate]),
            })
            .collect();
        let outputs: Vec<Option<Expression>> = model
            .outputs
            .iter()
            .map(|output| replaced(pool, output.value, &output.variable, output.span))
            .collect();
        let all: Vec<Expression> = all.into_iter().collect::<Option<_>>()?;
        let outputs: Vec<Expression> = outputs.into_iter().collect::<Option<_>>()?;
        let displacements = closures::displacements(model, &mut substitution, pool)?;
        closures::check(
            model,
            scalars,
            solution,
            &displacements,
            &all,
            pool,
            diagnostics,
        );
        if diagnostics.any() {
            return None;
        }
        let (supplied, dissipated) = powers(model, scalars, solution, pool);
        let energies: Vec<Expression> = model
            .graph
            .elements
            .iter()
            .filter_map(|element| {
                if let Law::Storage(storage) = &element.law {
                    Some(storage.energy)
                } else {
                    None
                }
            })
            .collect();
        let energies: Vec<Expression> = energies
            .into_iter()
            .map(|energy| substitution.apply(pool, energy))
            .collect::<Option<_>>()?;
        let energy = pool.sum(&energies);
        let mut told = vec![energy, supplied, dissipated];
        told.extend(&outputs);
        told.extend(displacements.iter().map(|(_, _, value)| *value));
        told.extend(solution.conditioning.iter().map(|it| it.normalised));
        let lost = |state: &usize| solved.momenta.contains_key(state);
        let states = kept(model, pool, &all, &told, &lost);
        let rates = states.iter().map(|state| all[*state]).collect();
        Some(Self {
            states,
            rates,
            outputs,
            energy,
            supplied,
            dissipated,
            displacements,
            eliminated: solved
                .momenta
                .keys()
                .filter_map(|state| Some((*state, substitution.get(Symbol::State(*state))?)))
                .collect(),
        })
    }
}

/// What signals and lost states are, in terms of the states that are left.
fn substitution(solved: &Solved, pool: &mut Pool) -> Option<Substitution> {
    let mut substitution = Substitution::new();
    for (signal, value) in structure::signal_values(&solved.scalars, &solved.solution) {
        substitution.set(Symbol::Signal(signal), value);
    }
    let momenta: Vec<(usize, Expression)> = solved
        .momenta
        .iter()
        .map(|(state, momentum)| Some((*state, substitution.apply(pool, *momentum)?)))
        .collect::<Option<_>>()?;
    for (state, momentum) in momenta {
        substitution.set(Symbol::State(state), momentum);
    }
    Some(substitution)
}

/// `ṗ = e` or `q̇ = f`, with power into the storage.
fn storage_rate(
    model: &Elaborated,
    scalars: &Scalars,
    solution: &Solution,
    id: ElementId,
    component: usize,
) -> Expression {
    let port = &scalars.ports[&id];
    if model.graph.elements[id.0].kind == ElementKind::I {
        solution.values[port.effort[component]].flipped(port.effort_reversed)
    } else {
        solution.values[port.flow[component]].flipped(port.flow_reversed)
    }
}

/// Storages, and the integrals and attitudes that their rates read, or what is `told`.
fn kept(
    model: &Elaborated,
    pool: &Pool,
    rates: &[Expression],
    told: &[Expression],
    lost: &dyn Fn(&usize) -> bool,
) -> Vec<usize> {
    let mut keep: Vec<bool> = model
        .states
        .iter()
        .enumerate()
        .map(|(state, entry)| !lost(&state) && !matches!(entry.rate, StateRate::Expression(_)))
        .collect();
    loop {
        let mut roots: Vec<Expression> = told.to_vec();
        roots.extend(
            rates
                .iter()
                .zip(&keep)
                .filter(|(_, keep)| **keep)
                .map(|(rate, _)| *rate),
        );
        let read: Vec<usize> = symbols(pool, &roots)
            .into_iter()
            .filter_map(|symbol| {
                if let Symbol::State(state) = symbol {
                    Some(state)
                } else {
                    None
                }
            })
            .filter(|state| !keep[*state])
            .collect();
        if read.is_empty() {
            return (0..keep.len()).filter(|state| keep[*state]).collect();
        }
        read.into_iter().for_each(|state| keep[state] = true);
    }
}

/// Power supplied by sources and dissipated in resistors.
fn powers(
    model: &Elaborated,
    scalars: &Scalars,
    solution: &Solution,
    pool: &mut Pool,
) -> (Expression, Expression) {
    let (mut supplied, mut dissipated) = (Expression::ZERO, Expression::ZERO);
    for (id, port) in &scalars.ports {
        let kind = model.graph.elements[id.0].kind;
        let source = matches!(kind, ElementKind::Se | ElementKind::Sf);
        if !source && kind != ElementKind::R {
            continue;
        }
        for (effort, flow) in port.effort.iter().zip(&port.flow) {
            let product = pool.multiply(solution.values[*effort], solution.values[*flow]);
            if source {
                supplied = pool.add(supplied, product.flipped(port.inward));
            } else {
                dissipated = pool.add(dissipated, product.flipped(!port.inward));
            }
        }
    }
    (supplied, dissipated)
}

fn finish(
    model: Elaborated,
    scalars: &Scalars,
    solution: &Solution,
    answers: Answers,
    mut pool: Pool,
    verdict: Drawn,
    diagnostics: &mut Diagnostics,
) -> Option<Compiled> {
    let by_state: Vec<Symbol> = answers
        .states
        .iter()
        .map(|state| Symbol::State(*state))
        .collect();
    let by_input: Vec<Symbol> = (0..model.inputs.len()).map(Symbol::Input).collect();
    let jacobian_state = jacobian(&mut pool, &answers.rates, &by_state).entries;
    let jacobian_input = jacobian(&mut pool, &answers.rates, &by_input).entries;
    let conditioning: Vec<Expression> = solution
        .conditioning
        .iter()
        .map(|inverted| inverted.normalised)
        .collect();
    let initial: Vec<Expression> = answers
        .states
        .iter()
        .map(|state| model.states[*state].initial)
        .collect();
    let positions = closures::positions(&answers.displacements, &by_state, &mut pool);
    let flows = closures::flows(&model, scalars, solution, &by_state, &mut pool);
    let (checks, checked) = checks(&model, scalars, solution, &pool);
    let requests = [
        answers.rates,
        answers.outputs,
        jacobian_state,
        jacobian_input,
        vec![answers.energy],
        vec![answers.supplied, answers.dissipated],
        conditioning.clone(),
        initial,
        checked,
        [&positions.values[..], &positions.jacobian.entries].concat(),
        [&flows.values[..], &flows.jacobian.entries].concat(),
    ];
    let places: BTreeMap<usize, usize> = answers
        .states
        .iter()
        .enumerate()
        .map(|(place, state)| (*state, place))
        .collect();
    let place = |state: usize| places.get(&state).copied().unwrap_or(0);
    let mut names = BTreeMap::new();
    for (unknown, value) in solution.values.iter().enumerate() {
        if !scalars.names[unknown].is_empty() {
            names
                .entry(value.node())
                .or_insert_with(|| scalars.names[unknown].clone());
        }
    }
    share(&mut pool, &requests[Routines::DERIVATIVE]);
    let program = program::build(&pool, &requests, &place, &names);
    let conditioning = conditioning
        .iter()
        .map(|value| text(&model, scalars, &pool, *value))
        .collect();
    if !program.is_finite() {
        let message = "numbers of the model multiply to one that is not finite";
        let report = error(codes::NOT_FINITE, model.name.span(), message);
        diagnostics.report(report.help("choose units in which the values are of moderate size"));
        return None;
    }
    let mut notes = verdict.notes;
    for (state, _) in &answers.eliminated {
        let State {
            variable, initial, ..
        } = &model.states[*state];
        if *initial != Expression::ZERO {
            let name = &variable.name;
            notes.push(format!(
                "the initial value of `{name}` is not used: `{name}` follows from other states"
            ));
        }
    }
    Some(Compiled {
        states: answers.states,
        program,
        conditioning,
        loops: loops(&model, scalars, solution),
        eliminated: answers
            .eliminated
            .iter()
            .map(|(state, value)| {
                let name = model.states[*state].variable.name.clone();
                (name, text(&model, scalars, &pool, *value))
            })
            .collect(),
        closed: [positions.closures, flows.closures],
        checks,
        dependent: verdict.dependent,
        strokes: verdict.strokes,
        notes,
        model,
    })
}

/// An expression with the model's names.
pub(crate) fn text(
    model: &Elaborated,
    scalars: &Scalars,
    pool: &Pool,
    expression: Expression,
) -> String {
    let name = |symbol: Symbol| match symbol {
        Symbol::Parameter(index) => model.parameters[index].name.to_string(),
        Symbol::State(index) => model.states[index].variable.name.clone(),
        Symbol::Input(index) => model.inputs[index].name.clone(),
        Symbol::Time => "t".to_owned(),
        Symbol::Signal(index) => format!("signal {index}"),
        Symbol::Unknown(index) => match scalars.names.get(index) {
            Some(name) if !name.is_empty() => name.clone(),
            _ => format!("unknown {index}"),
        },
    };
    Printer::new(pool, &name).text(expression)
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
            variables: found.unknowns.len(),
            iterated: found.iterated,
        }
    };
    solution.loops.iter().map(named).collect()
}

/// What `new` checks beyond that every parameter is finite.
fn checks(
    model: &Elaborated,
    scalars: &Scalars,
    solution: &Solution,
    pool: &Pool,
) -> (Vec<Check>, Vec<Expression>) {
    let mut checks = Vec::new();
    let mut checked: Vec<Expression> = Vec::new();
    let mut add = |expression: Expression, condition: Condition, reason: String| {
        if pool.rate(expression) == Rate::Parameter && !checked.contains(&expression) {
            checks.push(Check {
                name: text(model, scalars, pool, expression),
                condition,
                reason,
            });
            checked.push(expression);
        }
    };
    for assumption in &model.assumptions {
        add(
            assumption.expression,
            assumption.condition,
            assumption.reason.clone(),
        );
    }
    for (expression, condition) in &solution.assumptions {
        add(
            *expression,
            *condition,
            "the chosen causality divides by it".to_owned(),
        );
    }
    for divisor in divisors(model, pool) {
        add(
            divisor,
            Condition::NonZero,
            "a law divides by it".to_owned(),
        );
    }
    (checks, checked)
}

/// Divisors of parameters alone in the laws of storages.
fn divisors(model: &Elaborated, pool: &Pool) -> Vec<Expression> {
    let mut roots: Vec<Expression> = Vec::new();
    for element in &model.graph.elements {
        match &element.law {
            Law::Storage(storage) => roots.extend(&storage.coenergy),
            Law::Source(values) | Law::EffortLaw(values) | Law::FlowLaw(values) => {
                roots.extend(values)
            }
            Law::Resistance(matrix) | Law::Conductance(matrix) => roots.extend(&matrix.entries),
            _ => {}
        }
    }
    let mut found = Vec::new();
    let mut seen = vec![false; pool.len()];
    while let Some(current) = roots.pop() {
        if std::mem::replace(&mut seen[current.node()], true) {
            continue;
        }
        let operation = pool.operation(current);
        if let crate::symbolic::Operation::Divide(_, divisor) = operation
            && pool.rate(*divisor) == Rate::Parameter
        {
            found.push(divisor.magnitude());
        }
        roots.extend(operation.operands());
    }
    found.sort_unstable();
    found
}
