//! Whether a program satisfies the graph that it was made from.

use mbg_compiler::codes;
use mbg_compiler::compile::{Compiled, Routines};
use mbg_compiler::diagnostics::Code;
use mbg_runtime::Dual;

use super::elements::{Kind, Port, effort, flow};
use super::graph::{Drawing, Graph, Verdict};
use crate::models::attempted;
use crate::models::dual::{Point, evaluate, iterates};

/// By how much an equation between numbers of order one may be broken.
const TOLERANCE: f64 = 1e-9;
const TIME: f64 = 0.4;
const INPUT: f64 = -0.7;

/// What a program tells of a port: values with their time derivatives.
struct Told<'a> {
    port: &'a Port,
    effort: Vec<Dual<f64>>,
    flow: Vec<Dual<f64>>,
    state: Vec<Dual<f64>>,
}

impl Told<'_> {
    fn values(of: &[Dual<f64>]) -> Vec<f64> {
        of.iter().map(|it| it.value).collect()
    }
}

/// How a graph fared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Fate {
    /// It is no model at all.
    NoModel,
    /// It is rejected, and must or may be.
    Rejected(Verdict, &'static str),
    /// It has a nonlinear loop, as where a lost compliance modulates.
    Iterated,
    /// Every state that was tried is too near the singular set.
    Singular,
    /// Its program satisfies it.
    Satisfied(Verdict),
}

/// Checks a graph, and says what is wrong.
pub(crate) fn hold(graph: &Graph, drawing: Drawing) -> Result<Fate, String> {
    if !graph.ports.iter().any(Port::is_storage) {
        return Ok(Fate::NoModel);
    }
    let verdict = graph.verdict();
    let model = match attempted(&graph.text(drawing)) {
        Ok(model) => model,
        Err(reported) => return rejected(graph, verdict, drawing.uniform, &reported),
    };
    match verdict {
        // Dangling bonds vanish when junctions merge.
        Verdict::Undetermined => return Ok(Fate::NoModel),
        Verdict::Contradictory => return Err("a contradiction was accepted".to_owned()),
        Verdict::Dependent(dependent) => {
            let storages = graph.ports.iter().filter(|port| port.is_storage());
            let storages: usize = storages.map(|port| port.dimension).sum();
            let kept = names(&model).filter(|name| !name.starts_with('a')).count();
            if kept + dependent != storages {
                return Err(format!(
                    "{kept} states of {storages}, {dependent} dependent by the rank"
                ));
            }
        }
    }
    if iterates(&model.program) {
        return Ok(Fate::Iterated);
    }
    let mut next = noise();
    for _ in 0..20 {
        let state: Vec<f64> = model.states.iter().map(|_| next()).collect();
        let duals: Vec<Dual<f64>> = state.iter().map(|value| Dual::constant(*value)).collect();
        let point = Point {
            parameters: &[],
            time: Dual::constant(TIME),
            state: &duals,
            input: &[Dual::constant(INPUT)],
        };
        let conditioning = evaluate(&model.program, Routines::CONDITIONING, &point);
        if conditioning.iter().all(|it| it.value.abs() > 0.03) {
            check(graph, &model, &state)?;
            return Ok(Fate::Satisfied(verdict));
        }
    }
    Ok(Fate::Singular)
}

/// Without resistors, the ports that give their effort are even in number, or odd, whatever storages are states; without
/// gyrators they are always as many. False if there is nothing to compare.
pub(crate) fn is_even(graph: &Graph, uniform: bool) -> Result<bool, String> {
    let drawing = |reversed| Drawing {
        uniform,
        reversed,
        coordinates: false,
    };
    let counts = [false, true].map(|reversed| {
        let model = attempted(&graph.text(drawing(reversed))).ok()?;
        let kept = |letter| {
            names(&model)
                .filter(|name| !name.starts_with('a') && name.contains(letter))
                .count()
        };
        let inertias = graph
            .ports
            .iter()
            .filter(|port| matches!(port.kind, Kind::Inertia(_)));
        let inertias: usize = inertias.map(|port| port.dimension).sum();
        Some(kept(".q") + inertias - kept(".p"))
    });
    match counts {
        [Some(a), Some(b)] if a == b || graph.gyrators && a.abs_diff(b) % 2 == 0 => Ok(true),
        [Some(a), Some(b)] => Err(format!(
            "{a} and {b} efforts given\n{}",
            graph.text(drawing(false))
        )),
        _ => Ok(false),
    }
}

fn rejected(
    graph: &Graph,
    verdict: Verdict,
    uniform: bool,
    reported: &[&'static str],
) -> Result<Fate, String> {
    let drawing = [
        codes::STORAGE_DERIVATIVE,
        codes::SOURCES_CONFLICT,
        codes::NO_ASSIGNMENT,
        codes::RECTANGULAR_INVERSE,
        codes::FIXED_RESISTOR,
    ];
    // The last may befall any graph that starts where a modulus makes it singular.
    let unsupported = [
        codes::ORDER_LOST_UNSUPPORTED,
        codes::NONLINEAR_LOOP,
        codes::SINGULAR_START,
    ];
    let among = |list: &[Code], code: &&str| list.iter().any(|it| it.text == *code);
    let expected = reported.iter().all(|code| match verdict {
        Verdict::Dependent(dependent) => {
            among(&unsupported, code)
                || uniform && among(&drawing, code)
                // A random graph may happen to start where its determinant is zero.
                || *code == codes::SINGULAR_START.text
                // A lost compliance may be empty for ever, and what it modulates then vanishes.
                || dependent > 0 && graph.is_modulated_by_storages() && *code == codes::SINGULAR_JUNCTIONS.text
        }
        _ => true,
    });
    match reported.first() {
        Some(first) if expected => Ok(Fate::Rejected(verdict, first)),
        _ => Err(format!("rejected with {reported:?}")),
    }
}

fn names(model: &Compiled) -> impl Iterator<Item = &str> {
    model
        .states
        .iter()
        .map(|state| model.model.states[*state].variable.name.as_str())
}

/// A sequence in [-1, 1), the same every time.
fn noise() -> impl FnMut() -> f64 {
    let mut state = 1_u64;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

fn near(what: &str, found: f64, expected: f64, scale: f64) -> Result<(), String> {
    let error = (found - expected).abs();
    if error <= TOLERANCE * scale.max(1.0) {
        Ok(())
    } else {
        Err(format!("{what}: {found} is not {expected}, by {error:e}"))
    }
}

/// All equations at one state.
fn check(graph: &Graph, model: &Compiled, state: &[f64]) -> Result<(), String> {
    let run = |routine, along: &[f64], time: f64, input: f64| {
        let state: Vec<Dual<f64>> = state
            .iter()
            .zip(along)
            .map(|(value, slope)| Dual {
                value: *value,
                slope: *slope,
            })
            .collect();
        let point = Point {
            parameters: &[],
            time: Dual {
                value: TIME,
                slope: time,
            },
            state: &state,
            input: &[Dual {
                value: INPUT,
                slope: input,
            }],
        };
        evaluate(&model.program, routine, &point)
    };
    let still = vec![0.0; state.len()];
    let rates = Told::values(&run(Routines::DERIVATIVE, &still, 0.0, 0.0));
    let outputs = run(Routines::OUTPUT, &rates, 1.0, 0.0);
    let scale = outputs.iter().fold(1.0_f64, |scale, it| {
        scale.max(it.value.abs()).max(it.slope.abs())
    });
    if !scale.is_finite() {
        return Err("not finite".to_owned());
    }
    if scale > 1e4 {
        return Ok(());
    }
    let (told, integrals) = told(graph, &outputs);
    laws(&told, scale)?;
    let own: Vec<&str> = names(model).collect();
    for (place, name) in own.iter().enumerate() {
        if name.starts_with('a') {
            let flow = integrals.iter().find(|(known, _)| known == name);
            near(name, rates[place], flow.map_or(f64::NAN, |it| it.1), scale)?;
        }
    }
    structure(graph, &told, &variables(graph, &own, state, &told), scale)?;
    let energy = run(Routines::ENERGY, &rates, 1.0, 0.0)[0];
    let power = Told::values(&run(Routines::POWER, &still, 0.0, 0.0));
    let (stored, supplied, dissipated) = accounts(&told);
    near("energy", energy.value, stored, scale * scale)?;
    near("supplied", power[0], supplied, scale * scale)?;
    near("dissipated", power[1], dissipated, scale * scale)?;
    near("balance", energy.slope, power[0] - power[1], scale * scale)?;
    let jacobian = Told::values(&run(Routines::DERIVATIVE_AND_JACOBIAN, &still, 0.0, 0.0));
    let jacobian = &jacobian[state.len()..];
    let by_input = Told::values(&run(Routines::JACOBIAN_INPUT, &still, 0.0, 0.0));
    let size = jacobian
        .iter()
        .chain(&by_input)
        .fold(scale, |size, it| size.max(it.abs()));
    for column in 0..=state.len() {
        let mut along = still.clone();
        if let Some(slope) = along.get_mut(column) {
            *slope = 1.0;
        }
        let slopes = run(
            Routines::DERIVATIVE,
            &along,
            0.0,
            f64::from(u8::from(column == state.len())),
        );
        for (row, slope) in slopes.iter().enumerate() {
            let ours = if column < state.len() {
                jacobian[row * state.len() + column]
            } else {
                by_input[row]
            };
            near("Jacobian", ours, slope.slope, size)?;
        }
    }
    Ok(())
}

/// What the outputs say, by port, and the flows of the integrals by their names.
fn told<'a>(graph: &'a Graph, outputs: &[Dual<f64>]) -> (Vec<Told<'a>>, Vec<(String, f64)>) {
    let mut rest = outputs;
    let mut take = |count| {
        let (first, others) = rest.split_at(count);
        rest = others;
        first.to_vec()
    };
    let told = graph
        .ports
        .iter()
        .map(|port| Told {
            port,
            effort: take(port.dimension),
            flow: take(port.dimension),
            state: if port.is_storage() {
                take(port.dimension)
            } else {
                Vec::new()
            },
        })
        .collect();
    let rates = graph
        .integrals
        .iter()
        .enumerate()
        .flat_map(|(number, junction)| {
            let dimension = graph.dimension(*junction);
            Graph::components(&format!("a{number}"), dimension)
                .into_iter()
                .zip(Told::values(&take(dimension)))
        });
    let rates = rates.collect();
    (told, rates)
}

/// The laws of storages, and that each changes by its own effort or flow.
fn laws(told: &[Told], scale: f64) -> Result<(), String> {
    for (number, told) in told.iter().enumerate() {
        let (law, coenergy, rate) = match told.port.kind {
            Kind::Inertia(law) => (law, &told.flow, &told.effort),
            Kind::Compliance(law) => (law, &told.effort, &told.flow),
            _ => continue,
        };
        let (state, coenergy) = (Told::values(&told.state), Told::values(coenergy));
        for (component, (own, rate)) in told.state.iter().zip(rate).enumerate() {
            let residual = law.residual(&state, &coenergy, component);
            near(&format!("law of p{number}"), residual, 0.0, scale)?;
            near(&format!("rate of p{number}"), own.slope, rate.value, scale)?;
        }
    }
    Ok(())
}

/// Values of what coefficients depend on.
fn variables(graph: &Graph, names: &[&str], state: &[f64], told: &[Told]) -> Vec<f64> {
    let of_ports = told.iter().enumerate().flat_map(|(number, told)| {
        let names = Graph::components(&format!("p{number}.q"), told.port.dimension);
        names
            .into_iter()
            .zip(&told.state)
            .map(|(name, it)| (name, it.value))
    });
    let mut known: Vec<(String, f64)> = of_ports.collect();
    known.extend([("t".to_owned(), TIME), ("u".to_owned(), INPUT)]);
    known.extend(
        names
            .iter()
            .zip(state)
            .map(|(name, value)| ((*name).to_owned(), *value)),
    );
    let value = |name: &String| {
        known
            .iter()
            .find(|it| it.0 == *name)
            .map_or(0.123, |it| it.1)
    };
    graph.variables.iter().map(value).collect()
}

/// Junctions, two-ports, resistors and sources with the efforts and flows told have a solution.
fn structure(graph: &Graph, told: &[Told], variables: &[f64], scale: f64) -> Result<(), String> {
    let unknowns = 2 * graph.bonds;
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for row in graph.structure() {
        let mut dense = vec![0.0; unknowns + 1];
        for (unknown, entry, sign) in row {
            dense[unknown] += sign as f64 * entry.value(variables);
        }
        rows.push(dense);
    }
    let mut known = |unknown: usize, value: f64| {
        let mut dense = vec![0.0; unknowns + 1];
        dense[unknown] = 1.0;
        dense[unknowns] = value;
        rows.push(dense);
    };
    for told in told {
        let port = told.port;
        let (efforts, flows) = match port.kind {
            Kind::Inertia(_) => (port.sign, 1),
            Kind::Effort(_) | Kind::Flow(_) => (1, 1),
            _ => (1, port.sign),
        };
        for component in 0..port.dimension {
            let bond = port.bond + component;
            known(effort(bond), efforts as f64 * told.effort[component].value);
            known(flow(bond), flows as f64 * told.flow[component].value);
            if let Kind::Effort(entry) | Kind::Flow(entry) = port.kind {
                known(port.fixed(component), entry.value(variables));
            }
        }
    }
    near("junctions", contradiction(rows, unknowns), 0.0, scale)
}

/// What remains of the right sides when all unknowns are eliminated.
fn contradiction(mut rows: Vec<Vec<f64>>, unknowns: usize) -> f64 {
    let mut done = 0;
    for column in 0..unknowns {
        let size = |row: &usize| rows[*row][column].abs();
        let Some(pivot) = (done..rows.len()).max_by(|a, b| size(a).total_cmp(&size(b))) else {
            break;
        };
        if size(&pivot) < 1e-9 {
            continue;
        }
        rows.swap(done, pivot);
        let (above, below) = rows.split_at_mut(done + 1);
        let top = &above[done];
        for row in below.iter_mut().filter(|row| row[column] != 0.0) {
            let factor = row[column] / top[column];
            for (entry, above) in row.iter_mut().zip(top).skip(column) {
                *entry -= factor * above;
            }
        }
        done += 1;
    }
    rows[done..]
        .iter()
        .fold(0.0, |most, row| most.max(row[unknowns].abs()))
}

/// Energy stored, power supplied and dissipated, by port.
fn accounts(told: &[Told]) -> (f64, f64, f64) {
    let (mut stored, mut supplied, mut dissipated) = (0.0, 0.0, 0.0);
    for told in told {
        for component in 0..told.port.dimension {
            let (e, f) = (told.effort[component].value, told.flow[component].value);
            match told.port.kind {
                Kind::Inertia(law) => stored += law.energy(told.state[component].value, f),
                Kind::Compliance(law) => stored += law.energy(told.state[component].value, e),
                Kind::Resistor(_) => dissipated += e * f,
                Kind::Effort(_) | Kind::Flow(_) => supplied -= e * f * told.port.sign as f64,
            }
        }
    }
    (stored, supplied, dissipated)
}
