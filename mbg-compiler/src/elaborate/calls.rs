//! Junctions of an instance that stand in another order than its ports, or are fewer, and the call that was meant.

use super::Builder;
use crate::diagnostics::listing;
use crate::graph::{End, JunctionKind, declaration};
use crate::syntax::{ast, dump};

impl Builder<'_> {
    /// The call with each junction at the first port that takes it; none where a junction fits no port.
    pub(super) fn in_order(
        &self,
        scope: usize,
        instance: &ast::Instance,
        component: &ast::Component,
    ) -> Option<String> {
        let given: Option<Vec<Given>> = instance
            .connections
            .iter()
            .map(|reference| self.given(scope, reference))
            .collect();
        let places = placed(&component.ports, &given?)?;
        let junctions = (0..component.ports.len()).map(|port| {
            let given = places.iter().position(|place| *place == port);
            given.map_or_else(
                || "…".to_owned(),
                |given| dump::reference(&instance.connections[given]),
            )
        });
        let call = call(instance, &junctions.collect::<Vec<_>>());
        let ports = component.ports.iter().enumerate();
        let missing = ports.filter(|(port, _)| !places.contains(port));
        Some(with_kinds(call, missing.map(|(_, port)| port)))
    }

    fn given(&self, scope: usize, reference: &ast::Reference) -> Option<Given> {
        match self.end_of(scope, reference) {
            Ok(Some((End::Junction(id, _), size))) => Some((self.graph.junctions[id.0].kind, size)),
            _ => None,
        }
    }
}

/// Kind and dimension of a junction.
type Given = (JunctionKind, usize);

/// The port of each junction, in order of ports as far as they fit.
fn placed(ports: &[ast::Port], given: &[Given]) -> Option<Vec<usize>> {
    let mut places: Vec<usize> = Vec::new();
    for (kind, size) in given {
        let is_free = |port: &usize| !places.contains(port);
        let fits = |port: &usize| {
            let port = &ports[*port];
            port.dimension == *size && port.takes(*kind)
        };
        // A port of either kind is left to what fits nowhere else.
        let free = || (0..ports.len()).filter(is_free).filter(fits);
        let of_kind = free().find(|port| ports[*port].kind.is_some());
        places.push(of_kind.or_else(|| free().next())?);
    }
    Some(places)
}

/// How the instance is written with junctions that are called as the ports are.
pub(super) fn by_ports(instance: &ast::Instance, component: &ast::Component) -> String {
    let ports = component.ports.iter();
    let names: Vec<String> = ports.clone().map(|port| port.name.to_string()).collect();
    with_kinds(call(instance, &names), ports)
}

/// A call with the junctions that ports take, where they take one kind only.
fn with_kinds<'p>(call: String, ports: impl Iterator<Item = &'p ast::Port>) -> String {
    let kinds: Vec<String> = ports
        .filter_map(|port| {
            Some(declaration(
                port.kind?,
                &port.name.to_string(),
                port.dimension,
            ))
        })
        .collect();
    match &kinds[..] {
        [] => call,
        [kind] => format!("{call} with a junction `{kind}`"),
        _ => format!("{call} with junctions {}", listing(kinds)),
    }
}

/// How the instance is written with these junctions.
fn call(instance: &ast::Instance, junctions: &[String]) -> String {
    let braces = match instance.arguments.is_empty() {
        true => "",
        false => " { … }",
    };
    let (name, component) = (&instance.name, &instance.component);
    format!(
        "write `{name}: {component}{braces} ({});`",
        junctions.join(", ")
    )
}
