//! What must hold of the finished graph: equal dimensions, one bond per port.

use proc_macro2::Span;
use syn::Expr;

use super::Builder;
use super::definitions::END_EXCLUDED;
use super::frames::part_of_frame;
use crate::codes;
use crate::diagnostics::{Diagnostic, error};
use crate::graph::{Bond, ElementId, End, JunctionKind, Rule, declaration};
use crate::syntax::dump;

impl Builder<'_> {
    /// Completes the dimensions of bonds at two-ports and reports what does not fit.
    pub(super) fn check(&mut self, model: Span) {
        // Mistakes of models before this one say nothing of it.
        if self.diagnostics.calls() > self.calls {
            return;
        }
        self.check_bonds();
        self.check_ports();
        self.check_junctions();
        if self.states.is_empty() {
            let message =
                "the model has no storage, integral or attitude: nothing changes with time";
            let help = "write `I body { inertia: … }` or `C spring { stiffness: … }` in the braces of a junction";
            self.diagnostics
                .report(error(codes::EMPTY_MODEL, model, message).help(help));
        }
    }

    fn check_bonds(&mut self) {
        for index in 0..self.graph.bonds.len() {
            let bond = &self.graph.bonds[index];
            if [&bond.from, &bond.to].contains(&&End::Border) {
                continue;
            }
            let (from, to) = (self.size(&bond.from), self.size(&bond.to));
            let span = self.graph.origins.span(bond.origin);
            let name = self.graph.origins.path(bond.origin).to_owned();
            if let (End::OnePort(a), End::OnePort(b)) = (&bond.from, &bond.to)
                && self.graph.elements[a.0].kind == self.graph.elements[b.0].kind
            {
                let message =
                    format!("`{name}` joins two equal one-ports; both fix the same variable");
                self.diagnostics
                    .error(codes::EQUAL_ONE_PORTS, span, message);
            } else if let (End::Junction(a, first), End::Junction(b, second)) =
                (&bond.from, &bond.to)
                && (a, first) == (b, second)
            {
                let message = format!("`{name}` joins a junction to itself, which says nothing");
                let report = error(codes::TOO_MANY_BONDS, span, message);
                self.diagnostics
                    .report(report.help("remove it, or lead it through a `TF` or a `GY`"));
            } else if self.is_doubled(index) {
                let message = format!("`{name}` is bonded twice");
                let report = error(codes::TOO_MANY_BONDS, span, message);
                self.diagnostics
                    .report(report.help("take one of the bonds away"));
            } else if from != to {
                let message = format!("`{name}` joins dimension {from} to dimension {to}");
                let mut report = error(codes::WRONG_DIMENSION, span, message);
                report.helps.extend(self.other_components(index));
                let report = self.tell_of_transposed(index, report);
                self.tell_of_two_port(index, report);
            }
            self.graph.bonds[index].dimension = from;
        }
    }

    /// Whether a bond before this one joins the same components of the same junctions, both of one kind, so that this one
    /// says nothing.
    fn is_doubled(&self, index: usize) -> bool {
        let Bond { from, to, .. } = &self.graph.bonds[index];
        let (End::Junction(a, _), End::Junction(b, _)) = (from, to) else {
            return false;
        };
        let [a, b] = [a, b].map(|id| self.graph.junctions[id.0].kind);
        let mut before = self.graph.bonds[..index].iter();
        a == b && before.any(|it| [(&it.from, &it.to), (&it.to, &it.from)].contains(&(from, to)))
    }

    /// What to type where a bond joins too many or too few components of a junction to an element or another junction.
    fn other_components(&self, bond: usize) -> Option<String> {
        let Bond { from, to, .. } = &self.graph.bonds[bond];
        [(from, to), (to, from)]
            .into_iter()
            .find_map(|(own, far)| {
                let End::Junction(id, range) = own else {
                    return None;
                };
                let (junction, size) = (&self.graph.junctions[id.0], self.size(far));
                let is_short = range.len() < junction.dimension && range.len() + 1 == size;
                let excluded = if is_short { END_EXCLUDED } else { "" };
                if let Some(help) = part_of_frame(&junction.name, junction.dimension, size) {
                    return Some(format!("{excluded}{help}"));
                }
                let longer = range.start..range.start + size;
                let fits = is_short && longer.end <= junction.dimension;
                let longer = End::Junction(*id, longer);
                fits.then(|| format!("{excluded}write `{}`", self.graph.end_name(&longer)))
            })
            .or_else(|| self.first_components([from, to]))
    }

    /// What to type where one end of a bond has more components than the other.
    fn first_components(&self, ends: [&End; 2]) -> Option<String> {
        let [longer, shorter] = match ends.map(|end| self.size(end)) {
            [from, to] if from > to => ends,
            _ => [ends[1], ends[0]],
        };
        let (End::Junction(id, range), End::Junction(..) | End::OnePort(_)) = (longer, shorter)
        else {
            return None;
        };
        let picked = range.start..range.start + self.size(shorter);
        let picked = self.graph.end_name(&End::Junction(*id, picked));
        Some(format!(
            "a part of the components is bonded by its numbers, from 0: the first are `{picked}`"
        ))
    }

    /// What to type where the matrix of a two-port would fit at both of its ends if it were transposed.
    fn tell_of_transposed(&self, bond: usize, report: Diagnostic) -> Diagnostic {
        let Bond { from, to, .. } = &self.graph.bonds[bond];
        let Some(id) = [from, to].into_iter().find_map(|end| match end {
            End::In(id) | End::Out(id) => Some(*id),
            _ => None,
        }) else {
            return report;
        };
        let beside = |end: End| {
            let mut bonds = self.graph.bonds.iter();
            let other = bonds.find_map(|bond| match bond {
                Bond { from, to, .. } if *to == end => Some(from),
                Bond { from, to, .. } if *from == end => Some(to),
                _ => None,
            });
            other.map(|other| self.size(other))
        };
        let (rows, columns) = self.two_port(id);
        if rows == columns
            || (beside(End::In(id)), beside(End::Out(id))) != (Some(rows), Some(columns))
        {
            return report;
        }
        let name = &self.graph.elements[id.0].name;
        report
            .note(format!(
                "the matrix of `{name}` has a row for each component behind it and a column for each before it: {columns} of \
                 {rows} numbers, and this has {rows} of {columns}"
            ))
            .help("write `transpose(…)` around it; one row is written `[[a, b]]`, since `[a, b]` is a column")
    }

    /// Reports a mistake at a bond, of which the law of a two-port is the reason if one is there.
    fn tell_of_two_port(&mut self, bond: usize, report: Diagnostic) {
        let Bond { from, to, .. } = &self.graph.bonds[bond];
        let written = [from, to].into_iter().find_map(|end| match end {
            End::In(id) | End::Out(id) => self.written.get(id).copied(),
            _ => None,
        });
        let Some((scope, element)) = written else {
            return self.diagnostics.report(report);
        };
        let law: Vec<&Expr> = element.values().collect();
        self.tell_of(scope, report, &law);
    }

    fn size(&self, end: &End) -> usize {
        match end {
            End::Junction(_, range) => range.len(),
            End::OnePort(id) => self.ports[id.0].1,
            End::In(id) => self.two_port(*id).1,
            End::Out(id) => self.two_port(*id).0,
            End::Border => 0,
        }
    }

    fn two_port(&self, id: ElementId) -> (usize, usize) {
        match self.graph.elements[id.0].rule {
            Rule::Transformer { rows, columns, .. } | Rule::Gyrator { rows, columns, .. } => {
                (rows, columns)
            }
            _ => (0, 0),
        }
    }

    /// A junction without a bond would leave its common variable undetermined.
    fn check_junctions(&mut self) {
        let graph = &self.graph;
        let components = graph.junctions.iter().map(|it| vec![false; it.dimension]);
        let mut bonded: Vec<Vec<bool>> = components.collect();
        for end in graph.bonds.iter().flat_map(|bond| [&bond.from, &bond.to]) {
            if let End::Junction(id, range) = end {
                bonded[id.0][range.clone()].fill(true);
            }
        }
        for (index, bonded) in bonded.iter().enumerate() {
            if let Some(component) = bonded.iter().position(|bonded| !bonded) {
                let junction = &graph.junctions[index];
                let is_alone = !bonded.contains(&true);
                let name = match is_alone {
                    true => junction.name.clone(),
                    false => format!("{}[{component}]", junction.name),
                };
                let span = graph.origins.span(junction.origin);
                let report = error(
                    codes::UNCONNECTED,
                    span,
                    format!("junction `{name}` has no bond"),
                );
                let report = report.help(format!("write an arrow to it: `{name} -> …;`"));
                let report = match is_alone {
                    true => report.help("or remove it"),
                    false => report,
                };
                self.diagnostics.report(report);
            }
        }
    }

    /// What to type for `a -> R link { … } -> b`, an element on what two junctions of one kind differ by.
    fn in_series(&self, id: ElementId) -> Option<String> {
        let bonds = || self.graph.bonds.iter();
        let mut into = bonds().filter(|bond| bond.to == End::OnePort(id));
        let mut out = bonds().filter(|bond| bond.from == End::OnePort(id));
        let (Some(into), None, Some(out), None) =
            (into.next(), into.next(), out.next(), out.next())
        else {
            return None;
        };
        let kind = |end: &End| match end {
            End::Junction(junction, _) => Some(self.graph.junctions[junction.0].kind),
            _ => None,
        };
        let kind = kind(&into.from).filter(|own| kind(&out.to) == Some(*own))?;
        let (other, shared) = match kind {
            JunctionKind::Zero => (JunctionKind::One, "flow"),
            JunctionKind::One => (JunctionKind::Zero, "effort"),
        };
        let (scope, element) = self.written.get(&id)?;
        let prefix = &self.scopes[*scope].prefix;
        let names = [&into.from, &out.to].map(|end| self.graph.end_name(end));
        let [a, b] = names
            .each_ref()
            .map(|name| name.strip_prefix(prefix.as_str()).unwrap_or(name));
        let name = &element.name;
        let written = dump::element_text(element);
        let junction = declaration(other, &format!("{name}_path"), into.dimension);
        Some(format!(
            "what stands between two junctions has one {shared}, at a junction of its own: write \
             `{junction} {{ {written} }} {a} -> {name}_path -> {b};`"
        ))
    }

    fn check_ports(&mut self) {
        let mut counts = vec![[0usize; 2]; self.graph.elements.len()];
        for bond in &self.graph.bonds {
            for end in [&bond.from, &bond.to] {
                match end {
                    End::OnePort(id) | End::In(id) => counts[id.0][0] += 1,
                    End::Out(id) => counts[id.0][1] += 1,
                    End::Junction(..) | End::Border => {}
                }
            }
        }
        for (id, (element, count)) in self.graph.elements.iter().zip(counts).enumerate() {
            let two_port = matches!(
                element.rule,
                Rule::Transformer { .. } | Rule::Gyrator { .. }
            );
            let expected = [1, usize::from(two_port)];
            let span = self.graph.origins.span(element.origin);
            if count
                .iter()
                .zip(expected)
                .any(|(found, expected)| *found < expected)
            {
                let message = format!("`{}` has a port without a bond", element.name);
                let help = if two_port {
                    "write an arrow on either side of it: `a -> TF gear { … } -> b;`"
                } else {
                    "write an arrow to a junction"
                };
                self.diagnostics
                    .report(error(codes::UNCONNECTED, span, message).help(help));
            } else if count != expected {
                let message = format!("`{}` has a port with more than one bond", element.name);
                let help = self.in_series(ElementId(id)).unwrap_or_else(|| {
                    "bonds meet at junctions: write the arrow to the element's junction instead"
                        .to_owned()
                });
                self.diagnostics
                    .report(error(codes::TOO_MANY_BONDS, span, message).help(help));
            }
        }
    }
}
