//! What users read.

use super::explain::{alternatives, explain};
use super::fixtures::{Attached, Builder, Ground, Joint, fig_12, navigation};
use super::outlook::Outlook;
use super::report::{COMPONENTWISE, conflict_diagnostics, diagnose};
use super::uniform::verdict;
use crate::codes;
use crate::diagnostics::Diagnostics;
use crate::graph::{BondGraph, ElementId, End, Rule};

fn reports(graph: &BondGraph) -> Diagnostics {
    let mut diagnostics = Diagnostics::new();
    match verdict(graph) {
        Ok(verdict) => diagnose(graph, &verdict, &Outlook::Soluble, &mut diagnostics),
        Err(conflict) => {
            conflict_diagnostics(graph, &conflict, &Outlook::Soluble, &mut diagnostics)
        }
    }
    diagnostics
}

/// Two bodies and one revolute about x.
fn one_revolute() -> BondGraph {
    let mut builder = Builder::new();
    let a = builder.one("fuselage", 3);
    builder.port("hull", Rule::PreferFlowOut, builder.whole(a));
    let b = builder.one("platform", 3);
    builder.port("body", Rule::PreferFlowOut, builder.whole(b));
    let ends = (builder.whole(a), builder.whole(b));
    builder.one_joint(Joint::Revolutes, "hinge", ends, &[Attached::R, Attached::C]);
    builder.graph
}

#[test]
fn a_dependent_inertia_is_explained() {
    let diagnostics = reports(&one_revolute());
    let text = diagnostics.list()[0].text();
    let expected = "\
inertia `body` is forced into derivative causality: all 3 components of its flow are imposed by the graph [MBG0301]
  `hinge.blocked` fixes the flow of `hinge.rel[1..3]`
  so `hinge.rel -> hinge.sum` carries the flow of `hinge.rel[1..3]` to `hinge.sum`
  `fuselage` has its flow from `hull`, which is in integral causality
  so `fuselage -> hinge.sum` carries the flow of `fuselage` to `hinge.sum`
  every other bond brings flow to `hinge.sum`, so `hinge.sum -> hinge.turn` must bring its effort
  so `hinge.turn` passes the flow on to `platform`
  so `platform -> body` carries the flow of `platform` to `body`
  path: I <- 1 <- MTF <- 0 <- 1 <- I
  the flow of `body` is computed from the states of `hull`, `hinge.spring`; the source `hinge.blocked`; the rate of \
change of `body`
  `hull` could be dependent in the place of `body`, at the same number of dependent storages; storages keep integral \
causality in order of declaration, those under `#[derivative]` last
  help: write `causality componentwise;` in the model: one stroke per component instead of one per multibond
  help: or write `#[derivative]` before `I body` to accept it: `#[derivative] I body { … }`
  help: or replace the joints between two bodies `a` and `b` by one with a square Jacobian: \
`1 gimbals[3] { C spring { … } R damper { … } } 0 joint[3]; a -> joint; \
gimbals -> MTF jacobian { flow: jacobian_xyz(spring.q) } -> joint; \
joint -> MTF turn { flow: transpose(rot_x(spring.q.x) * rot_y(spring.q.y) * rot_z(spring.q.z)) } -> b;`";
    assert_eq!(text, expected);
    let others: Vec<&str> = diagnostics.list()[1..]
        .iter()
        .map(|other| other.message.as_str())
        .collect();
    assert_eq!(
        others,
        [
            "inertia `hull` takes part in forcing inertia `body` into derivative causality",
            "flow source `hinge.blocked` takes part in forcing inertia `body` into derivative causality",
        ]
    );
}

#[test]
fn a_path_names_a_transformer_once_that_demands_what_it_passes_on() {
    let mut builder = Builder::new();
    let rate = builder.one("rate", 1);
    let wide = builder.one("wide", 3);
    builder.transformer("axis", (3, 1), builder.whole(rate), builder.whole(wide));
    builder.port("damper", Rule::Either, builder.whole(rate));
    let body = builder.port("body", Rule::PreferFlowOut, builder.whole(wide));
    let found = verdict(&builder.graph).expect("the inertia can be dependent");
    let path = explain(&builder.graph, &found, body).map(|chain| chain.path);
    assert_eq!(path.as_deref(), Some("I <- 1 <- MTF"));
}

#[test]
fn fig_12_names_the_inertia_its_path_and_all_blocked_axes() {
    let graph = fig_12(Joint::Revolutes);
    let found = verdict(&graph).expect("admissible");
    let chain = explain(&graph, &found, found.dependent[0]).expect("dependent");
    assert_eq!(
        chain.path,
        "I <- 1 <- MTF <- 0 <- 1 <- MTF <- 0 <- 1 <- MTF <- 0 <- 1 <- I"
    );
    let named = |id: &ElementId| graph.elements[id.0].name.as_str();
    let fixed: Vec<&str> = chain.fixed.iter().map(named).collect();
    // The middle axis blocks its two outer components with a source each; one of them suffices to force the bond.
    assert_eq!(fixed, ["b.x.blocked", "b.y.blocked", "b.z.blocked"]);
    assert_eq!(
        chain.integral.iter().map(named).collect::<Vec<_>>(),
        ["hull"]
    );
    assert_eq!(alternatives(&graph, &found, &chain), chain.integral);
    assert_eq!(
        explain(&graph, &found, chain.integral[0]).map(|chain| chain.path),
        None
    );
}

#[test]
fn a_body_held_by_sources_alone_has_no_alternative() {
    let graph = navigation(Joint::Revolutes, Joint::Revolutes, Ground::Sf);
    let diagnostics = reports(&graph);
    let [hull, body] = diagnostics.list() else {
        panic!("{} errors", diagnostics.list().len())
    };
    for (report, name) in [(hull, "hull"), (body, "body")] {
        assert!(report.message.contains(name), "{}", report.message);
        let none =
            format!("no other storage of the chain could be dependent in the place of `{name}`");
        assert!(report.notes.contains(&none), "{:?}", report.notes);
    }
    assert!(hull.notes[0].contains("`floor` fixes the flow of `ground`"));
}

#[test]
fn accepted_storages_are_not_reported() {
    let mut graph = one_revolute();
    graph.elements[1].derivative = true;
    assert!(!reports(&graph).any());
    let mut graph = one_revolute();
    graph.elements[0].derivative = true;
    assert!(!reports(&graph).any(), "the mark moves the dependence");
}

/// A vector body between two scalar ones: integral causality of the first costs both of the others theirs.
fn one_against_two() -> BondGraph {
    let mut builder = Builder::new();
    let wide = builder.one("wide", 2);
    builder.port("first", Rule::PreferFlowOut, builder.whole(wide));
    for (index, name) in ["left", "right"].into_iter().enumerate() {
        let narrow = builder.one(name, 1);
        builder.port(
            &format!("{name}_body"),
            Rule::PreferFlowOut,
            builder.whole(narrow),
        );
        let end = builder.whole(narrow);
        builder.bond(End::Junction(wide, index..index + 1), end);
    }
    builder.graph
}

#[test]
fn greedy_would_lose_two_states_where_one_suffices() {
    let graph = one_against_two();
    let found = verdict(&graph).expect("admissible");
    assert_eq!(found.dependent, [ElementId(0)]);
    assert!(found.proven_optimal);
    let text = reports(&graph).list()[0].text();
    let cost = "integral causality of `first` would put `left_body`, `right_body` into derivative causality";
    assert!(text.contains(cost), "{text}");
}

#[test]
fn a_supposition_that_fails_is_told_as_one() {
    // Two parallel bonds between the body's junction and a second one, which would take its flow from both.
    let mut builder = Builder::new();
    let body = builder.one("body", 1);
    builder.port("mass", Rule::PreferFlowOut, builder.whole(body));
    let other = builder.one("other", 1);
    for _ in 0..2 {
        builder.bond(builder.whole(body), builder.whole(other));
    }
    let text = reports(&builder.graph).list()[0].text();
    assert!(
        text.contains("in integral causality `mass` would give the flow of `body`"),
        "{text}"
    );
    assert!(
        text.contains("but then `other` has its flow from more than one bond"),
        "{text}"
    );
}

#[test]
fn conflicts_say_what_fails_where_and_what_to_type() {
    let mut builder = Builder::new();
    builder.one_joint(Joint::Revolutes, "hinge", (End::Border, End::Border), &[]);
    let diagnostics = reports(&builder.graph);
    let expected = "\
no assignment of strokes satisfies the rules at `hinge.rel.x` [MBG0303]
  `hinge.blocked` fixes the flow of `hinge.rel[1..3]`
  so `hinge.rel -> hinge.sum` carries the flow of `hinge.rel[1..3]` to `hinge.sum`
  but then no bond gives `hinge.rel.x` its flow
  help: attach a resistor that can give the flow: `hinge.rel.x -> R damper { conductance: … };`
  help: or write `causality componentwise;` in the model: one stroke per component instead of one per multibond
  help: or replace the joints between two bodies `a` and `b` by one with a square Jacobian: \
`1 gimbals[3] { C spring { … } R damper { … } } 0 joint[3]; a -> joint; \
gimbals -> MTF jacobian { flow: jacobian_xyz(spring.q) } -> joint; \
joint -> MTF turn { flow: transpose(rot_x(spring.q.x) * rot_y(spring.q.y) * rot_z(spring.q.z)) } -> b;`";
    assert_eq!(diagnostics.list()[0].text(), expected);
    let mut builder = Builder::new();
    builder.one_joint(
        Joint::Axes,
        "hinge",
        (End::Border, End::Border),
        &[Attached::Coulomb],
    );
    let diagnostics = reports(&builder.graph);
    let first = &diagnostics.list()[0];
    assert_eq!(first.code, codes::FIXED_RESISTOR);
    assert_eq!(
        first.message,
        "resistor `hinge.friction` would have to give its flow, but its law gives the effort and has no inverse"
    );
    assert_eq!(first.helps[0], COMPONENTWISE);
    assert_eq!(
        diagnostics.list().len(),
        2,
        "the resistor and the transformer"
    );
}

#[test]
fn long_chains_of_bodies_are_judged_without_search() {
    let mut builder = Builder::new();
    let mut last = builder.one("base", 3);
    builder.port("floor", Rule::FlowOut, builder.whole(last));
    for index in 0..170 {
        let next = builder.one(&format!("b{index}"), 3);
        builder.port(
            &format!("i{index}"),
            Rule::PreferFlowOut,
            builder.whole(next),
        );
        builder.joint(
            Joint::Revolutes,
            &format!("j{index}"),
            (last, next),
            &[Attached::R, Attached::C],
        );
        last = next;
    }
    assert!(builder.graph.bonds.len() > 3900);
    let found = verdict(&builder.graph).expect("admissible");
    assert_eq!((found.dependent.len(), found.proven_optimal), (170, true));
    let chain = explain(&builder.graph, &found, found.dependent[169]).expect("dependent");
    assert!(chain.steps.len() > 1000);
}
