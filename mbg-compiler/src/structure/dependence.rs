//! What depends on what, when the equations are singular.
//!
//! Rows are taken in order of priority (structure and resistors, sources, storages as declared, marked storages) and
//! reduced by those before them, over the prime field. By the greedy theorem for linear matroids the rows that vanish
//! are the fewest, and each is a combination of earlier rows, which names its causes.

use std::collections::{BTreeMap, BTreeSet};

use crate::causality::report::{APART, alternatives};
use crate::codes;
use crate::diagnostics::{Diagnostics, error, listing};
use crate::elaborate::Elaborated;
use crate::equations::{Owner, Scalars};
use crate::graph::{ElementId, ElementKind, Law};
use crate::symbolic::Pool;
use crate::symbolic::field;

/// Reports every source and storage that says what others have said before.
pub fn report_singular(
    model: &Elaborated,
    scalars: &Scalars,
    pool: &Pool,
    diagnostics: &mut Diagnostics,
) {
    let mut order: Vec<usize> = (0..scalars.equations.len()).collect();
    order.sort_by_key(|row| (priority(model, scalars.equations[*row].owner), *row));
    let mut echelon = Echelon::default();
    let mut lost: BTreeMap<ElementId, (usize, BTreeSet<ElementId>)> = BTreeMap::new();
    let mut structure = false;
    for row in order {
        let equation = &scalars.equations[row];
        let terms = equation
            .terms
            .iter()
            .map(|(unknown, c)| (*unknown, pool.image(*c).0[0]))
            .collect();
        let causes = match equation.owner {
            Owner::Element(id) if is_cause(model, id) => BTreeSet::from([id]),
            _ => BTreeSet::new(),
        };
        if let Some(causes) = echelon.reduce(terms, causes) {
            match equation.owner {
                Owner::Element(id) => {
                    let entry = lost.entry(id).or_default();
                    entry.0 += 1;
                    entry
                        .1
                        .extend(causes.into_iter().filter(|cause| *cause != id));
                }
                Owner::Structure => structure = true,
            }
        }
    }
    for (id, (count, causes)) in &lost {
        report(model, *id, *count, causes, diagnostics);
    }
    if structure || lost.is_empty() {
        let message = "the junction structure leaves efforts or flows undetermined";
        diagnostics.error(codes::SINGULAR_JUNCTIONS, model.name.span(), message);
    }
}

fn is_cause(model: &Elaborated, id: ElementId) -> bool {
    matches!(
        model.graph.elements[id.0].law,
        Law::Source(_) | Law::Storage(_)
    )
}

fn priority(model: &Elaborated, owner: Owner) -> usize {
    match owner {
        Owner::Structure => 0,
        Owner::Element(id) => {
            let element = &model.graph.elements[id.0];
            match element.law {
                Law::Storage(_) => 2 + usize::from(element.derivative),
                Law::Source(_) => 1,
                _ => 0,
            }
        }
    }
}

fn report(
    model: &Elaborated,
    id: ElementId,
    count: usize,
    causes: &BTreeSet<ElementId>,
    diagnostics: &mut Diagnostics,
) {
    let graph = &model.graph;
    let element = &graph.elements[id.0];
    let span = graph.origins.span(element.origin);
    let others = listing(
        causes
            .iter()
            .map(|cause| graph.elements[cause.0].name.clone()),
    );
    let imposed = if matches!(element.kind, ElementKind::I | ElementKind::Sf) {
        "flow"
    } else {
        "effort"
    };
    if matches!(element.law, Law::Source(_)) {
        let message = format!(
            "source `{}` imposes {imposed} that is imposed already",
            element.name
        );
        let report = error(codes::SOURCES_CONFLICT, span, message);
        diagnostics.report(if causes.is_empty() {
            report.note("its law follows from the equations without it")
        } else {
            report.note(format!("it is fixed by {others}"))
        });
        return;
    }
    let (components, follow) = if count == 1 {
        ("one component".to_owned(), "follows")
    } else {
        (format!("{count} components"), "follow")
    };
    let message = format!(
        "storage `{}` depends on others: {components} of its {imposed} {follow} from {others}",
        element.name
    );
    let (code, note) = if element.derivative {
        let note = "`#[derivative]` accepts this true loss of order, but it is not supported yet";
        (codes::ORDER_LOST_UNSUPPORTED, note)
    } else {
        let note = "this is a true loss of order: no choice of strokes makes all of them states";
        (codes::ORDER_LOST, note)
    };
    let mut helps = Vec::new();
    let is_storage = |cause: &ElementId| matches!(graph.elements[cause.0].law, Law::Storage(_));
    if causes.iter().any(is_storage) {
        helps.push("merge the storages into one".to_owned());
    }
    if element.kind == ElementKind::I {
        helps.push(APART.to_owned());
    }
    let mut report = error(code, span, message).note(note);
    report.helps = alternatives(helps);
    diagnostics.report(report);
}

/// Rows in echelon form over the field, each with the elements it came from.
#[derive(Default)]
struct Echelon {
    rows: BTreeMap<usize, (BTreeMap<usize, u64>, BTreeSet<ElementId>)>,
}

impl Echelon {
    /// Adds a row; if it vanishes, gives the elements it is a combination of.
    fn reduce(
        &mut self,
        mut row: BTreeMap<usize, u64>,
        mut causes: BTreeSet<ElementId>,
    ) -> Option<BTreeSet<ElementId>> {
        row.retain(|_, value| *value != 0);
        while let Some((&lead, &value)) = row.first_key_value() {
            let Some((pivot, origin)) = self.rows.get(&lead) else {
                let inverse = field::invert(value).unwrap_or(0);
                row.values_mut()
                    .for_each(|entry| *entry = field::multiply(*entry, inverse));
                self.rows.insert(lead, (row, causes));
                return None;
            };
            for (unknown, entry) in pivot {
                let known = row.get(unknown).copied().unwrap_or(0);
                let reduced = field::subtract(known, field::multiply(value, *entry));
                if reduced == 0 {
                    row.remove(unknown);
                } else {
                    row.insert(*unknown, reduced);
                }
            }
            causes.extend(origin.iter().copied());
        }
        Some(causes)
    }
}
