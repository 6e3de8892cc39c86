//! Elements and the bonds between them.

use proc_macro2::Span;

use super::frames::part_of_frame;
use super::model::{State, StateRate};
use super::scope::Entity;
use super::{Builder, Pending, component_names};
use crate::codes;
use crate::diagnostics::error;
use crate::graph::{
    Bond, BondId, Closure, Element, ElementId, ElementKind, End, JunctionKind, Law, Rule,
};
use crate::symbolic::Expression;
use crate::syntax::ast::{self, ChainNode};
use crate::syntax::words::{article, element_name, is_two_port};

impl<'a> Builder<'a> {
    /// Puts the elements in a junction's braces at the junction.
    pub(super) fn fill_junction(&mut self, scope: usize, junction: &'a ast::Junction) {
        let Some(Entity::Junction(id, range)) = self.scopes[scope]
            .names
            .get(&junction.name.to_string())
            .cloned()
        else {
            return;
        };
        if let Some(value) = &junction.initial_flow {
            self.pending.push(Pending::Coordinate {
                scope,
                junction,
                value,
                id,
            });
        }
        for element in &junction.elements {
            if is_two_port(element.kind) {
                let kind = element_name(element.kind);
                let article = article(kind);
                let message =
                    format!("{article} `{kind}` has two ports; put it between two arrows");
                self.tell(scope, error(codes::UNCONNECTED, element.span, message));
                continue;
            }
            let end = End::Junction(id, range.clone());
            self.one_port_at(scope, element, end, range.len(), element.name.span());
        }
    }

    fn one_port_at(
        &mut self,
        scope: usize,
        element: &'a ast::Element,
        end: End,
        dimension: usize,
        span: Span,
    ) {
        if let Some(own) = element.dimension.filter(|own| *own != dimension) {
            let message = format!(
                "`{}` has dimension {own}, its junction {dimension}",
                element.name
            );
            let mut report = error(codes::WRONG_DIMENSION, element.name.span(), message);
            let frame = self.graph.end_name(&end);
            report.helps.extend(part_of_frame(&frame, dimension, own));
            self.tell(scope, report);
            return;
        }
        let id = self.element(scope, element, dimension);
        let source = matches!(element.kind, ElementKind::Se | ElementKind::Sf);
        let (from, to) = if source {
            (End::OnePort(id), end.clone())
        } else {
            (end.clone(), End::OnePort(id))
        };
        self.bond(scope, from, to, dimension, span);
        self.gyroscopic(scope, element, id, &end, dimension);
    }

    /// `gyroscopic` puts the Euler junction structure at the same junction.
    fn gyroscopic(
        &mut self,
        scope: usize,
        element: &ast::Element,
        storage: ElementId,
        end: &End,
        dimension: usize,
    ) {
        let Some(mark) = element
            .fields
            .iter()
            .find(|field| field.name == "gyroscopic")
        else {
            return;
        };
        if dimension != 3 || !matches!(end, End::Junction(..)) {
            let message = "`gyroscopic` needs an inertia of dimension 3 at a junction";
            self.tell(
                scope,
                error(codes::WRONG_DIMENSION, mark.name.span(), message),
            );
            return;
        }
        let name = format!("{}.gyroscopic", self.graph.elements[storage.0].name);
        let span = self.place(scope, mark.name.span());
        let origin = self.graph.origins.add(name.clone(), span);
        let id = ElementId(self.graph.elements.len());
        self.graph.elements.push(Element {
            kind: ElementKind::EJS,
            name,
            law: Law::EulerJunction(Vec::new()),
            rule: Rule::Gyroscopic,
            derivative: false,
            origin,
        });
        self.ports.push((0..0, 3));
        self.bond(scope, end.clone(), End::OnePort(id), 3, span);
        self.pending
            .push(Pending::Gyroscopic { scope, storage, id });
    }

    /// Adds an element with a law to be read later, and its states.
    fn element(&mut self, scope: usize, element: &'a ast::Element, dimension: usize) -> ElementId {
        let path = self.path(scope, &element.name);
        let span = self.place(scope, element.name.span());
        let origin = self.graph.origins.add(path.clone(), span);
        let id = ElementId(self.graph.elements.len());
        let start = self.states.len();
        if let Some(letter) = state_letter(element.kind) {
            for (component, variable) in component_names(&format!("{path}.{letter}"), dimension, "")
                .into_iter()
                .enumerate()
            {
                let rate = StateRate::Storage(id, component);
                self.states.push(State {
                    variable,
                    initial: Expression::ZERO,
                    is_given: false,
                    rate,
                    span,
                });
            }
        }
        self.graph.elements.push(Element {
            kind: element.kind,
            name: path,
            law: Law::Source(Vec::new()),
            rule: Rule::Either,
            derivative: element.derivative.is_some() || self.scopes[scope].derivative,
            origin,
        });
        self.ports.push((start..self.states.len(), dimension));
        self.written.insert(id, (scope, element));
        self.name(scope, &element.name, Entity::Element(id));
        self.pending.push(Pending::Law { scope, element, id });
        id
    }

    fn bond(&mut self, scope: usize, from: End, to: End, dimension: usize, span: Span) {
        let path = format!(
            "{} -> {}",
            self.graph.end_name(&from),
            self.graph.end_name(&to)
        );
        let origin = self.graph.origins.add(path, self.place(scope, span));
        self.graph.bonds.push(Bond {
            from,
            to,
            dimension,
            origin,
        });
    }

    /// Bonds the nodes of a chain.
    pub(super) fn chain(&mut self, scope: usize, chain: &'a ast::Chain) {
        let known: Vec<Option<(End, usize)>> = chain
            .nodes
            .iter()
            .map(|node| match node {
                ChainNode::Reference(reference) => self.resolve(scope, reference),
                ChainNode::Element(_) => None,
            })
            .collect();
        let ends: Vec<Option<(End, End, usize)>> = (0..chain.nodes.len())
            .map(|position| match &chain.nodes[position] {
                ChainNode::Reference(_) => known[position]
                    .clone()
                    .map(|(end, size)| self.both_sides(end, size)),
                ChainNode::Element(element) => {
                    let neighbour = [position.wrapping_sub(1), position + 1]
                        .into_iter()
                        .find_map(|side| known.get(side).cloned().flatten());
                    self.chain_element(scope, element, neighbour)
                }
            })
            .collect();
        for (position, arrow) in chain.arrows.iter().enumerate() {
            if let (Some((_, from, size)), Some((to, _, other))) =
                (&ends[position], &ends[position + 1])
            {
                let size = if *size == 0 { *other } else { *size };
                self.bond(scope, from.clone(), to.clone(), size, *arrow);
            }
        }
    }

    /// Puts a bond to the border at either end of a closure.
    pub(super) fn closure(&mut self, scope: usize, closure: &'a ast::Closure) {
        let (from, to) = (
            self.resolve(scope, &closure.from),
            self.resolve(scope, &closure.to),
        );
        let (Some((from, size)), Some((to, other))) = (from, to) else {
            return;
        };
        let span = closure.name.span();
        let junctions = [&from, &to].into_iter().all(|end| self.is_common_flow(end));
        if !junctions || size != other {
            let message = "a loop is closed between 1-junctions of equal dimension";
            self.tell(scope, error(codes::WRONG_DIMENSION, span, message));
            return;
        }
        let name = format!(
            "{} -> {}",
            self.graph.end_name(&from),
            self.graph.end_name(&to)
        );
        let origin = self
            .graph
            .origins
            .add(name.clone(), self.place(scope, span));
        let first = BondId(self.graph.bonds.len());
        self.bond(scope, from, End::Border, size, span);
        self.bond(scope, End::Border, to, size, span);
        let number = self.graph.closures.len();
        let instance = self.name_of(scope).to_owned();
        self.graph.closures.push(Closure {
            name,
            instance,
            bonds: [first, BondId(first.0 + 1)],
            displacement: None,
            origin,
        });
        self.pending.push(Pending::Displacement {
            scope,
            closure,
            number,
        });
    }

    fn is_common_flow(&self, end: &End) -> bool {
        matches!(end, End::Junction(id, _) if self.graph.junctions[id.0].kind == JunctionKind::One)
    }

    /// The ends that an arrow arriving and an arrow leaving see, and the dimension (0 while unknown).
    fn both_sides(&self, end: End, size: usize) -> (End, End, usize) {
        match end {
            End::OnePort(id) if is_two_port(self.graph.elements[id.0].kind) => {
                (End::In(id), End::Out(id), 0)
            }
            end => (end.clone(), end, size),
        }
    }

    fn chain_element(
        &mut self,
        scope: usize,
        element: &'a ast::Element,
        neighbour: Option<(End, usize)>,
    ) -> Option<(End, End, usize)> {
        let size = neighbour.as_ref().map_or(1, |(_, size)| *size);
        if is_two_port(element.kind) {
            let id = self.element(scope, element, size);
            return Some((End::In(id), End::Out(id), 0));
        }
        let size = element.dimension.unwrap_or(size.max(1));
        let id = self.element(scope, element, size);
        if let Some((end, _)) = neighbour {
            self.gyroscopic(scope, element, id, &end, size);
        }
        Some((End::OnePort(id), End::OnePort(id), size))
    }
}

fn state_letter(kind: ElementKind) -> Option<char> {
    match kind {
        ElementKind::I => Some('p'),
        ElementKind::C => Some('q'),
        _ => None,
    }
}
