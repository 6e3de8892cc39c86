//! Stage 3, the drawing's verdict: accept it or reject it.
//!
//! Input: the [`BondGraph`]. Output: strokes and accepted dependences for the metadata. Under `causality
//! componentwise;` only the equations can reject a model; strokes are then those of the best uniform drawing, if there
//! is one. Errors: `MBG03xx`.

use crate::causality::outlook::Outlook;
use crate::causality::{report, uniform};
use crate::diagnostics::Diagnostics;
use crate::graph::{Bond, BondGraph, BondId, Causality};

/// What the drawing says.
pub struct Drawn {
    /// True where the effort enters at a bond's `to`; empty if no uniform assignment exists.
    pub strokes: Vec<bool>,
    /// Storages in derivative causality, all of them accepted.
    pub dependent: Vec<String>,
    /// Things worth knowing.
    pub notes: Vec<String>,
}

/// Judges the drawing; none if it is rejected. The `outlook` of the equations, component by component, decides which ways
/// out are offered then.
#[must_use]
pub fn judge(
    graph: &BondGraph,
    outlook: &dyn Fn() -> Outlook,
    diagnostics: &mut Diagnostics,
) -> Option<Drawn> {
    let verdict = match uniform::verdict(graph) {
        Ok(verdict) => verdict,
        Err(_) if graph.causality == Causality::Componentwise => {
            let notes = vec!["no assignment with one stroke per multibond exists".to_owned()];
            return Some(Drawn {
                strokes: Vec::new(),
                dependent: Vec::new(),
                notes,
            });
        }
        Err(conflict) => {
            report::conflict_diagnostics(graph, &conflict, &outlook(), diagnostics);
            return None;
        }
    };
    let name = |id: &crate::graph::ElementId| graph.elements[id.0].name.clone();
    let rejected = verdict
        .dependent
        .iter()
        .any(|id| !graph.elements[id.0].derivative);
    if graph.causality == Causality::Uniform && rejected {
        report::diagnose(graph, &verdict, &outlook(), diagnostics);
        return None;
    }
    let marked = graph.elements.iter().any(|element| element.derivative);
    // Sums of efforts or flows may make storages dependent that strokes let be states.
    let notes = if marked && verdict.dependent.is_empty() && outlook().is_soluble() {
        vec!["`#[derivative]` is not needed: every storage is in integral causality".to_owned()]
    } else {
        Vec::new()
    };
    let strokes = (0..graph.bonds.len())
        .map(|bond| verdict.stroke_at_to(BondId(bond)))
        .collect();
    Some(Drawn {
        strokes,
        dependent: verdict.dependent.iter().map(name).collect(),
        notes,
    })
}

/// One bond a line: half arrow, dimension, and a bar at the end that receives the effort.
#[must_use]
pub fn diagram(graph: &BondGraph, strokes: &[bool]) -> String {
    let names = |bond: &Bond| (graph.end_name(&bond.from), graph.end_name(&bond.to));
    let length = |name: &str| name.chars().count();
    let widths = graph.bonds.iter().map(|bond| length(&names(bond).0));
    let width = widths.max().unwrap_or(0);
    let line = |(index, bond): (usize, &Bond)| {
        let arrow = match strokes.get(index) {
            Some(true) => " ──⇀│",
            Some(false) => "│──⇀ ",
            None => " ──⇀ ",
        };
        let (from, to) = names(bond);
        // Formatting pads to 65,535 at most.
        let space = " ".repeat(width - length(&from));
        format!("{from}{space} {arrow} {to} [{}]", bond.dimension)
    };
    let lines: Vec<String> = graph.bonds.iter().enumerate().map(line).collect();
    lines.join("\n")
}
