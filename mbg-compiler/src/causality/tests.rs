//! The causal analysis of Tod et al. (2013), Fig. 4, 12 and 13, by exhaustive enumeration.

use super::enumerate::{Enumeration, Options, Storages, enumerate};
use super::fixtures::{Attached, Builder, Ground, Joint, fig_12, navigation};
use super::uniform::verdict;
use crate::codes;
use crate::graph::{BondGraph, ElementId, End, Rule};

const FREE: Options = Options {
    inertias: Storages::Free,
    compliances: Storages::Free,
    limit: 10_000,
};
const INTEGRAL_C: Options = Options {
    compliances: Storages::Integral,
    ..FREE
};

fn names(graph: &BondGraph, ids: &[ElementId]) -> Vec<String> {
    ids.iter()
        .map(|id| graph.elements[id.0].name.clone())
        .collect()
}

/// Patterns at the relative bond and at the 0-junction.
fn joint_patterns(joint: Joint, attached: &[Attached]) -> (usize, usize) {
    let mut builder = Builder::new();
    let made = builder.one_joint(joint, "j", (End::Border, End::Border), attached);
    let all = enumerate(&builder.graph, &INTEGRAL_C);
    assert!(all.complete);
    (all.patterns(&[made.relative]), all.patterns(&made.zero))
}

#[test]
fn joints_have_the_patterns_of_the_paper() {
    for attached in [&[Attached::R, Attached::C][..], &[Attached::R]] {
        assert_eq!(joint_patterns(Joint::Spherical, attached), (2, 3));
        assert_eq!(joint_patterns(Joint::Revolutes, attached), (1, 2));
        assert_eq!(joint_patterns(Joint::Axes, attached), (1, 2));
        assert_eq!(joint_patterns(Joint::New, attached), (2, 3));
    }
}

/// One joint between borders.
fn alone(joint: Joint, attached: &[Attached]) -> BondGraph {
    let mut builder = Builder::new();
    builder.one_joint(joint, "j", (End::Border, End::Border), attached);
    builder.graph
}

/// For every admissible causality of the relative 1-junction: conductances and dependent storages.
fn free_axis(joint: Joint, attached: &[Attached]) -> Vec<(usize, usize)> {
    let graph = alone(joint, attached);
    let all = enumerate(&graph, &FREE);
    let of = |assignment: &super::enumerate::Assignment| {
        (
            assignment.conductances(&graph).len(),
            assignment.dependent(&graph).len(),
        )
    };
    let set: std::collections::BTreeSet<_> = all.assignments.iter().map(of).collect();
    set.into_iter().collect()
}

#[test]
fn the_free_axis_takes_its_flow_from_exactly_one_element() {
    for joint in [Joint::Revolutes, Joint::Axes] {
        assert_eq!(
            free_axis(joint, &[Attached::R, Attached::C]),
            [(0, 1), (1, 0)]
        );
        assert_eq!(
            free_axis(joint, &[Attached::R, Attached::C, Attached::Se]),
            [(0, 1), (1, 0)]
        );
        assert_eq!(free_axis(joint, &[Attached::R]), [(1, 0)]);
        assert_eq!(free_axis(joint, &[Attached::C]), [(0, 1)]);
        assert_eq!(free_axis(joint, &[]), []);
        assert_eq!(free_axis(joint, &[Attached::Se]), []);
    }
}

/// Admissible, optimal, and the dependent storages of each optimal assignment.
fn count(
    a: Joint,
    b: Joint,
    ground: Ground,
    options: &Options,
) -> (usize, usize, Vec<Vec<String>>) {
    let graph = navigation(a, b, ground);
    let all = enumerate(&graph, options);
    assert!(all.complete);
    let optimal = all.optimal(&graph);
    let mut dependent: Vec<Vec<String>> = optimal
        .iter()
        .map(|assignment| names(&graph, &assignment.dependent(&graph)))
        .collect();
    dependent.sort();
    let verdict = verdict(&graph).expect("admissible");
    assert!(verdict.proven_optimal);
    if options.compliances == Storages::Free {
        assert_eq!(
            Some(verdict.dependent.len()),
            dependent.first().map(Vec::len)
        );
    }
    (all.assignments.len(), optimal.len(), dependent)
}

fn dependent(sets: &[&[&str]]) -> Vec<Vec<String>> {
    sets.iter()
        .map(|set| set.iter().map(|name| (*name).to_owned()).collect())
        .collect()
}

#[test]
fn the_whole_system_has_the_counts_of_the_table() {
    use Ground::{Sf, StiffC};
    let one_of_two = dependent(&[&["body"], &["hull"]]);
    let none = dependent(&[&[]]);
    for relaxed in [Joint::Spherical, Joint::New] {
        for classic in [Joint::Revolutes, Joint::Axes] {
            assert_eq!(
                count(relaxed, classic, Sf, &INTEGRAL_C),
                (3, 2, one_of_two.clone())
            );
            assert_eq!(
                count(relaxed, classic, StiffC, &INTEGRAL_C),
                (2, 2, one_of_two.clone())
            );
            let hull = dependent(&[&["hull"]]);
            assert_eq!(count(classic, relaxed, Sf, &INTEGRAL_C), (2, 1, hull));
            assert_eq!(
                count(classic, relaxed, StiffC, &INTEGRAL_C),
                (3, 1, none.clone())
            );
        }
        for other in [Joint::Spherical, Joint::New] {
            assert_eq!(count(relaxed, other, Sf, &INTEGRAL_C), (5, 1, none.clone()));
            assert_eq!(
                count(relaxed, other, StiffC, &INTEGRAL_C),
                (3, 1, none.clone())
            );
            assert_eq!(count(relaxed, other, Sf, &FREE), (8, 1, none.clone()));
            assert_eq!(count(relaxed, other, StiffC, &FREE), (13, 1, none.clone()));
        }
    }
    for classic in [Joint::Revolutes, Joint::Axes] {
        for other in [Joint::Revolutes, Joint::Axes] {
            let both = dependent(&[&["hull", "body"]]);
            assert_eq!(count(classic, other, Sf, &INTEGRAL_C), (1, 1, both));
            assert_eq!(
                count(classic, other, StiffC, &INTEGRAL_C),
                (2, 2, one_of_two.clone())
            );
        }
    }
}

/// The only all-integral assignment: names of the resistances and of the conductances.
fn resistors(graph: &BondGraph) -> (Vec<String>, Vec<String>) {
    let all = Options {
        inertias: Storages::Integral,
        compliances: Storages::Integral,
        ..FREE
    };
    let Enumeration {
        assignments,
        complete,
    } = enumerate(graph, &all);
    assert!(complete);
    let [only] = assignments.as_slice() else {
        panic!("{} assignments", assignments.len())
    };
    (
        names(graph, &only.resistances(graph)),
        names(graph, &only.conductances(graph)),
    )
}

#[test]
fn fig_13_is_all_integral_in_one_way() {
    for joint in [Joint::Spherical, Joint::New] {
        let (resistances, conductances) = resistors(&navigation(joint, Joint::New, Ground::Sf));
        assert_eq!((resistances.len(), conductances.len()), (2, 0));
        let (resistances, conductances) = resistors(&navigation(joint, Joint::New, Ground::StiffC));
        assert_eq!(
            (resistances, conductances),
            (vec!["b.damper".to_owned()], vec!["a.damper".to_owned()])
        );
    }
    let graph = fig_12(Joint::New);
    assert!(verdict(&graph).expect("admissible").dependent.is_empty());
}

#[test]
fn fig_12_makes_the_platform_dependent_because_it_is_declared_last() {
    for joint in [Joint::Revolutes, Joint::Axes] {
        let mut graph = fig_12(joint);
        let found = verdict(&graph).expect("admissible");
        assert_eq!(names(&graph, &found.dependent), ["body"]);
        assert!(found.proven_optimal);
        graph.elements[0].derivative = true;
        let found = verdict(&graph).expect("admissible");
        assert_eq!(
            names(&graph, &found.dependent),
            ["hull"],
            "the marked storage yields"
        );
    }
}

#[test]
fn two_classic_joints_on_a_fixed_ground_make_both_bodies_dependent() {
    let graph = navigation(Joint::Revolutes, Joint::Revolutes, Ground::Sf);
    let found = verdict(&graph).expect("admissible");
    assert_eq!(names(&graph, &found.dependent), ["hull", "body"]);
}

#[test]
fn a_frictionless_uniform_revolute_is_a_conflict() {
    let conflict = verdict(&alone(Joint::Revolutes, &[])).expect_err("no flow for the free axis");
    assert_eq!(conflict.code, codes::NO_ASSIGNMENT);
    let conflict = verdict(&alone(Joint::Axes, &[])).expect_err("no flow for the free axis");
    assert_eq!(conflict.code, codes::RECTANGULAR_INVERSE);
    let conflict = verdict(&alone(Joint::Revolutes, &[Attached::Se])).expect_err("two sources");
    assert_eq!(conflict.code, codes::SOURCES_CONFLICT);
    assert!(verdict(&alone(Joint::New, &[])).is_ok());
}

#[test]
fn coulomb_friction_fits_the_new_joint_only() {
    for joint in [Joint::Revolutes, Joint::Axes] {
        let graph = alone(joint, &[Attached::Coulomb]);
        let conflict = verdict(&graph).expect_err("the law gives no flow");
        assert_eq!(conflict.code, codes::FIXED_RESISTOR);
        assert_eq!(names(&graph, &conflict.elements()[..1]), ["j.friction"]);
        // With a spring, the spring's flow is there to be taken, at the price of its state.
        let graph = alone(joint, &[Attached::Coulomb, Attached::C]);
        assert_eq!(
            names(&graph, &verdict(&graph).expect("admissible").dependent),
            ["j.spring"]
        );
    }
    let graph = alone(Joint::New, &[Attached::Coulomb, Attached::C]);
    assert!(verdict(&graph).expect("admissible").dependent.is_empty());
}

#[test]
fn a_gyroscopic_multiport_cannot_give_its_flow() {
    let mut builder = Builder::new();
    let body = builder.one("body", 3);
    builder.port("torque", Rule::EffortOut, builder.whole(body));
    builder.port("euler", Rule::Gyroscopic, builder.whole(body));
    let conflict = verdict(&builder.graph).expect_err("nothing gives the flow");
    assert_eq!(conflict.code, codes::GYROSCOPIC_INVERSE);
    assert!(
        conflict
            .chain
            .iter()
            .any(|step| step.text.contains("rank 2"))
    );
}

#[test]
fn a_rectangular_transformer_cannot_run_backward() {
    let mut builder = Builder::new();
    let rate = builder.one("rate", 1);
    let wide = builder.one("wide", 3);
    builder.transformer("axis", (3, 1), builder.whole(rate), builder.whole(wide));
    builder.port("torque", Rule::EffortOut, builder.whole(rate));
    builder.port("drive", Rule::FlowOut, builder.whole(wide));
    let conflict = verdict(&builder.graph).expect_err("M would have to be inverted");
    assert_eq!(conflict.code, codes::RECTANGULAR_INVERSE);
    assert_eq!(names(&builder.graph, &conflict.elements()[..1]), ["axis"]);
    assert!(
        conflict
            .chain
            .iter()
            .any(|step| step.text.contains("M has 3 rows and 1 column"))
    );
}

#[test]
fn a_junction_without_a_bond_is_a_conflict() {
    let mut builder = Builder::new();
    builder.one("lonely", 3);
    let conflict = verdict(&builder.graph).expect_err("nothing gives the flow");
    assert_eq!(conflict.code, codes::NO_ASSIGNMENT);
    assert!(conflict.proven());
}
