//! Parts of a model that nothing holds: the efforts of 0-junctions that can change together without any effect, as the
//! potentials of a circuit without ground, or the flows of such 1-junctions.
//!
//! Balances that say the same thing twice are such a part: by the balance of power, their factors are a change of efforts
//! or flows that does no work anywhere. A source at one of the junctions adds what is missing.

use std::collections::BTreeSet;

use proc_macro2::Span;

use super::mesh;
use crate::causality::ways::{held_or_heavy, hold, is_bare};
use crate::codes;
use crate::diagnostics::{Diagnostic, Diagnostics, error, listing};
use crate::elaborate::Elaborated;
use crate::equations::{Equation, Owner, Scalars};
use crate::graph::{BondGraph, JunctionId, JunctionKind, outermost_instance};
use crate::symbolic::Pool;

/// A component of a junction.
type Node = (JunctionId, usize);

/// Reports the first part that floats; the answer is whether there is one.
pub fn report_floating(
    model: &Elaborated,
    scalars: &Scalars,
    pool: &Pool,
    diagnostics: &mut Diagnostics,
) -> bool {
    let graph = &model.graph;
    let parts = parts(graph, scalars, mesh::is_structure, pool);
    let Some(part) = parts.first() else {
        return false;
    };
    let depth = |id: JunctionId| graph.junctions[id.0].name.matches('.').count();
    let outermost = part.iter().rev().min_by_key(|(id, _)| depth(*id));
    let Some((place, component)) = outermost.copied() else {
        return false;
    };
    let junction = &graph.junctions[place.0];
    let all: BTreeSet<&Node> = parts.iter().flatten().collect();
    let whole = (0..junction.dimension).all(|component| all.contains(&(place, component)));
    let range = if whole {
        0..junction.dimension
    } else {
        component..component + 1
    };
    let shared = match junction.kind {
        JunctionKind::Zero => "efforts",
        JunctionKind::One => "flows",
    };
    let names: BTreeSet<JunctionId> = part.iter().map(|(id, _)| *id).collect();
    let within: Option<BTreeSet<&str>> = names
        .iter()
        .map(|id| outermost_instance(&graph.junctions[id.0].name, None))
        .collect();
    let span = graph.origins.span(junction.origin);
    if let Some(within) = within
        && within.len() > 1
    {
        diagnostics.report(shared_by(&within, junction.kind, span));
        return true;
    }
    let names = listing(names.iter().map(|id| graph.junctions[id.0].name.clone()));
    let message =
        format!("nothing holds {names}: their {shared} can change together without any effect");
    let help = format!("hold one of them: {}", hold(graph, place, range));
    diagnostics.report(
        error(codes::SINGULAR_JUNCTIONS, span, message)
            .help(help)
            .help("or, if two of them are joined twice where once is meant, take one of the bonds away"),
    );
    true
}

/// The frame that nothing holds, where one is joined to the rest by joints that have no effort: the balances of a motor's
/// and of a damper that is none count as well.
pub(super) fn bare_frame(model: &Elaborated, scalars: &Scalars, pool: &Pool) -> Option<Diagnostic> {
    let graph = &model.graph;
    let is_given = |equation: &Equation| {
        mesh::is_structure(equation)
            || matches!(equation.owner, Owner::Element(..))
                && equation.terms.len() == 1
                && equation.signals.is_empty()
    };
    let parts = parts(graph, scalars, is_given, pool);
    let (part, frame) = parts.iter().find_map(|part| {
        let frame = part.iter().find(|(id, _)| is_bare(graph, *id))?.0;
        Some((part, frame))
    })?;
    let junction = &graph.junctions[frame.0];
    let others: BTreeSet<JunctionId> = part.iter().map(|(id, _)| *id).collect();
    let others = others.into_iter().filter(|id| *id != frame);
    let others = listing(others.map(|id| graph.junctions[id.0].name.clone()));
    let name = &junction.name;
    let message = format!(
        "nothing holds `{name}`: its flow and that of {others} can change together without any effect"
    );
    let span = graph.origins.span(junction.origin);
    let [first, other] = held_or_heavy(graph, frame);
    let report = error(codes::SINGULAR_JUNCTIONS, span, message);
    Some(report.help(first).help(format!("or {other}")))
}

/// The nodes that change together in each mesh of these equations.
fn parts(
    graph: &BondGraph,
    scalars: &Scalars,
    counts: impl Fn(&Equation) -> bool,
    pool: &Pool,
) -> Vec<Vec<Node>> {
    let meshes = mesh::all(scalars, counts, pool).into_iter();
    meshes
        .map(|mesh| nodes(graph, scalars, &mesh))
        .filter(|part| part.len() > 1)
        .collect()
}

/// Components between which something is shared that nothing determines.
fn shared_by(components: &BTreeSet<&str>, kind: JunctionKind, span: Span) -> Diagnostic {
    let names = listing(components.iter().map(|name| (*name).to_owned()));
    let (imposed, shared) = match kind {
        JunctionKind::Zero => ("flows", "efforts"),
        JunctionKind::One => ("efforts", "flows"),
    };
    let message = format!("{names} impose the same {imposed}: how they share the {shared} is open");
    let report = error(codes::SINGULAR_JUNCTIONS, span, message);
    let report = report.help("take one of them away");
    match kind {
        JunctionKind::Zero => report.help("or, of joints, let one give way: `blocked: compliant`"),
        JunctionKind::One => report,
    }
}

/// The junctions whose balances are in a mesh, in order of declaration.
fn nodes(graph: &BondGraph, scalars: &Scalars, mesh: &[usize]) -> Vec<Node> {
    let balances = mesh.iter().map(|row| &scalars.equations[*row]);
    let balances = balances.filter(|it| it.owner == Owner::Structure && it.about[0] == it.about[1]);
    let common: BTreeSet<usize> = balances.map(|it| it.about[0]).collect();
    let junctions = graph.junctions.iter().enumerate();
    let all = junctions.flat_map(|(id, it)| (0..it.dimension).map(move |k| (JunctionId(id), k)));
    all.filter(|(id, component)| common.contains(&scalars.common[id.0][*component]))
        .collect()
}
