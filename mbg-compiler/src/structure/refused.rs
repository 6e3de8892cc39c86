//! Dependences between storages that are accepted by `#[derivative]`, and not supported all the same.

use std::collections::BTreeSet;

use crate::causality::outlook::IN_PLACE;
use crate::causality::ways::{Between, through};
use crate::changes;
use crate::codes;
use crate::diagnostics::{Diagnostics, error, listing};
use crate::elaborate::{Elaborated, Variable};
use crate::equations::Owner;
use crate::graph::{Element, ElementId, ElementKind, Law};
use crate::symbolic::{Evaluation, Expression, Pool, Symbol};

/// What keeps a storage from depending on its causes, other storages or sources alone.
pub(super) fn apart(model: &Elaborated, id: ElementId, causes: &BTreeSet<ElementId>) -> String {
    let elements = &model.graph.elements;
    let what = match elements[id.0].kind {
        ElementKind::I => "a spring and a damper",
        _ => "a resistor",
    };
    let is_storage = |id: &ElementId| matches!(elements[id.0].law, Law::Storage(_));
    let between = match causes.iter().any(is_storage) || causes.is_empty() {
        true => "them".to_owned(),
        false => {
            let names = causes.iter().map(|id| elements[id.0].name.clone());
            format!("`{}` and {}", elements[id.0].name, listing(names))
        }
    };
    format!("put {what} between {between}")
}

/// A storage that depends on rates.
pub(super) fn report_second_derivative(
    model: &Elaborated,
    id: ElementId,
    diagnostics: &mut Diagnostics,
) {
    let graph = &model.graph;
    let element = &graph.elements[id.0];
    let message = format!(
        "storage `{}` follows from efforts or flows that are rates themselves",
        element.name
    );
    let report = error(
        codes::ORDER_LOST_UNSUPPORTED,
        graph.origins.span(element.origin),
        message,
    )
    .note("it would have to be differentiated twice")
    .help("put a spring and a damper, or an inertia, where it is coupled");
    diagnostics.report(report);
}

/// A closure between flows without states behind them, such as one by a cut at the end of a leg that has no mass.
pub(super) fn report_unmoved(model: &Elaborated, closure: usize, diagnostics: &mut Diagnostics) {
    let graph = &model.graph;
    let closure = &graph.closures[closure];
    let message = format!(
        "the closure `{}` joins flows that do not follow from the states",
        closure.name
    );
    let report = error(
        codes::ORDER_LOST_UNSUPPORTED,
        graph.origins.span(closure.origin),
        message,
    )
    .help("put an inertia at both ends, or let them move with joints whose rates are states");
    let cut = closure.instance.as_str();
    diagnostics.report(match cut {
        "" => report,
        cut => report
            .help(format!(
                "or, if a leg without mass ends at `{cut}`, write one line in the place of its joints and of `{cut}`: a \
                 `LineForce` if it pulls or pushes by a law, a `Rod` if it keeps its length; in a plane a `PlanarLineForce` \
                 or a `PlanarRod`"
            ))
            .help(format!(
                "or put a joint in the place of `{cut}`, such as `Spherical`, in a plane `PlanarRevolute`: in a ring the \
                 rates of links without mass follow from those of the others, where its `initial` values close it"
            )),
    });
}

/// A storage that depends on an input: one mistake, whichever components of it show it.
pub(super) fn report_input(
    model: &Elaborated,
    owner: Owner,
    input: usize,
    diagnostics: &mut Diagnostics,
) {
    let graph = &model.graph;
    let element = match owner {
        Owner::Element(id, _) => Some(id),
        Owner::Structure | Owner::Coordinate(..) => None,
    };
    let why = "an input is known by its value alone";
    let is_source = element.is_some_and(|id| graph.elements[id.0].kind == ElementKind::Sf);
    if let Some(moving) = model.moving_inputs.get(&input)
        && !is_source
    {
        let mut report = moving.clone().note(why);
        report.code = codes::ORDER_LOST_UNSUPPORTED;
        return diagnostics.report_once(report, 0);
    }
    let span = element.map_or(model.name.span(), |id| {
        graph.origins.span(graph.elements[id.0].origin)
    });
    let name = own_name(&model.inputs[input]);
    let message = format!("a dependent storage needs the time derivative of the input `{name}`");
    let mut report = error(codes::ORDER_LOST_UNSUPPORTED, span, message).note(why);
    let apart = element.and_then(|id| through(graph, id, Between::Resistor));
    let or = if apart.is_some() { "or " } else { "" };
    report.helps.extend(apart);
    let report = report.help(format!("{or}{}", by_rate(model, input)));
    diagnostics.report_once(
        report.help(format!("or {IN_PLACE} the input write a law of `t`")),
        0,
    );
}

/// Where a law of time jumps that storages follow, the impulse that moves them acts on nothing else.
pub(super) fn warn_of_jumps(
    model: &Elaborated,
    owner: Owner,
    law: Expression,
    pool: &mut Pool,
    diagnostics: &mut Diagnostics,
) {
    let Owner::Element(id, _) = owner else {
        return;
    };
    let value = |pool: &Pool, expression, time: f64| {
        let symbol = |symbol| match symbol {
            Symbol::Parameter(index) => model.parameters[index].default,
            Symbol::Time => time,
            _ => 0.5,
        };
        Evaluation::new(&symbol).value(pool, expression)
    };
    let times = changes::times(pool, &[law]);
    let again = times.again.into_iter().map(|[first, _]| first);
    for time in times.once.into_iter().chain(again) {
        let time = value(pool, time, 0.0);
        let difference = |aside: f64| {
            let aside = aside * (1.0 + time.abs());
            (value(pool, law, time + aside) - value(pool, law, time - aside)).abs()
        };
        // What does not jump differs in proportion.
        if difference(1e-9) <= 0.1 * difference(1e-6) {
            continue;
        }
        let element = &model.graph.elements[id.0];
        let message = format!(
            "`{}` jumps at {time:?} s, and what it moves follows without the impulse that this takes",
            element.name
        );
        let span = model.graph.origins.span(element.origin);
        diagnostics.warn(error(codes::LOST_IMPULSE, span, message).help(format!(
            "let it rise within a short time: `min(max((t - {time:?}) / 0.001, 0.0), 1.0)` goes from 0 to 1 within a millisecond"
        )));
    }
}

/// A storage whose energy follows from an input: energies are asked for without any.
pub fn report_energy(
    model: &Elaborated,
    element: &Element,
    input: usize,
    diagnostics: &mut Diagnostics,
) {
    let message = format!(
        "the energy of `{}` follows from the input `{}`, and energies are asked for without inputs",
        element.name, model.inputs[input].name
    );
    let span = model.graph.origins.span(element.origin);
    let report = error(codes::EXPRESSION, span, message);
    diagnostics.report(report.help(by_rate(model, input)));
}

/// The name of an input without its component.
fn own_name(input: &Variable) -> &str {
    input.name.split('.').next().unwrap_or_default()
}

/// How an input is given by its rate instead.
fn by_rate(model: &Elaborated, input: usize) -> String {
    let own = own_name(&model.inputs[input]);
    let of_it = model.inputs.iter().filter(|it| own_name(it) == own);
    let size = match of_it.count() {
        1 => String::new(),
        count => format!("[{count}]"),
    };
    let unit = match model.inputs[input].unit.as_str() {
        "" => String::new(),
        unit => format!(": {unit}"),
    };
    format!(
        "{IN_PLACE} `input {own}{size}{unit};` write its rate: `input {own}_rate{size}; \
         integral {own}{size}{unit} = {own}_rate;`"
    )
}
