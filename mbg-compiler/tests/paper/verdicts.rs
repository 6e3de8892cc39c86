//! What the drawings of the paper are: accepted, rejected, and why.

use mbg_compiler::causality::enumerate::{Enumeration, Options, Storages, enumerate};
use mbg_compiler::codes;
use mbg_compiler::compile::Compiled;
use mbg_compiler::diagnostics::{Code, Diagnostic};
use mbg_compiler::graph::{BondGraph, BondId, ElementId, End};

use super::language::{
    AXES, FIXED, FRICTION, GIMBALS, REVOLUTES, STIFF, System, arithmetic, compiled, elaborated,
    library, texts,
};

const ACCEPTED: &str = "#[derivative]";
const COMPONENTWISE: &str = "causality componentwise;";

fn accepted(system: System) -> Compiled {
    system
        .compile()
        .unwrap_or_else(|found| panic!("{:?}", texts(&found)))
}

fn rejected(result: Result<Compiled, Vec<Diagnostic>>) -> Vec<Diagnostic> {
    match result {
        Err(found) => found,
        Ok(_) => panic!("accepted"),
    }
}

/// A small model by itself.
fn refused(model: &str) -> Vec<Diagnostic> {
    rejected(compiled("", model))
}

fn codes_of(found: &[Diagnostic]) -> Vec<Code> {
    found.iter().map(|diagnostic| diagnostic.code).collect()
}

/// The element that the first line names as forced, in each diagnostic that has one.
fn forced(found: &[Diagnostic]) -> Vec<&str> {
    found
        .iter()
        .filter_map(|diagnostic| {
            let (element, _) = diagnostic
                .message
                .split_once(" is forced into derivative")?;
            Some(element)
        })
        .collect()
}

fn integral_springs(graph: &BondGraph) -> Enumeration {
    let options = Options {
        compliances: Storages::Integral,
        ..Options::default()
    };
    let all = enumerate(graph, &options);
    assert!(all.complete);
    all
}

fn names(graph: &BondGraph, ids: &[ElementId]) -> Vec<String> {
    ids.iter()
        .map(|id| graph.elements[id.0].name.clone())
        .collect()
}

/// One joint with its two junctions cut off: patterns at the relative bond and at the 0-junction.
fn joint_patterns(joint: &str, relative: &str, zero: &str) -> (usize, usize) {
    let mut graph = elaborated(&format!(
        "model Alone {{ 1 left[3]; 1 right[3]; j: {joint} {{ stiffness: 1.0, damping: 1.0 }} (left, right); }}"
    ))
    .graph;
    // The two ends are the first junctions; what was bonded to them is open.
    assert_eq!(graph.junctions[1].name, "right");
    graph.junctions.drain(..2);
    for bond in &mut graph.bonds {
        for end in [&mut bond.from, &mut bond.to] {
            if let End::Junction(id, _) = end {
                match id.0.checked_sub(2) {
                    Some(inner) => id.0 = inner,
                    None => *end = End::Border,
                }
            }
        }
    }
    let at = |end: &End, name: &str| graph.end_name(end) == name;
    let bonds: Vec<BondId> = (0..graph.bonds.len()).map(BondId).collect();
    let around = |name: &str| -> Vec<BondId> {
        bonds
            .iter()
            .copied()
            .filter(|id| at(&graph.bonds[id.0].from, name) || at(&graph.bonds[id.0].to, name))
            .collect()
    };
    let zero = around(zero);
    let relative: Vec<BondId> = around(relative)
        .into_iter()
        .filter(|bond| zero.contains(bond))
        .collect();
    assert_eq!((relative.len(), zero.len()), (1, 3), "{joint}");
    let all = integral_springs(&graph);
    (all.patterns(&relative), all.patterns(&zero))
}

#[test]
fn a_revolute_has_fewer_patterns_than_the_spherical_and_the_new_joint() {
    assert_eq!(joint_patterns("Spherical", "j.rel", "j.sum"), (2, 3));
    assert_eq!(joint_patterns("Gimbals", "j.jacobian", "j.joint"), (2, 3));
    for name in ["RevoluteX", "RevoluteY", "RevoluteZ"] {
        assert_eq!(joint_patterns(name, "j.rel", "j.sum"), (1, 2), "{name}");
    }
    for name in ["AxisX", "AxisY", "AxisZ"] {
        assert_eq!(joint_patterns(name, "j.axis", "j.sum"), (1, 2), "{name}");
    }
}

#[test]
fn fig_12_is_rejected_with_the_sources_that_begin_the_chain() {
    let found = rejected(System::free(REVOLUTES).compile());
    assert!(
        codes_of(&found)
            .iter()
            .all(|code| *code == codes::STORAGE_DERIVATIVE)
    );
    assert_eq!(forced(&found), ["inertia `body`"]);
    let text = found[0].text();
    for part in [
        "all 3 components",
        "`joint.x.blocked` fixes the flow",
        "`joint.y.blocked_x` fixes the flow",
        "`joint.z.blocked` fixes the flow",
        "path: I <- 1 <- MTF <- 0 <- ",
        "`causality componentwise;`",
        "`#[derivative]`",
        "jacobian_xyz",
    ] {
        assert!(text.contains(part), "{part} in\n{text}");
    }
}

#[test]
fn fig_12_with_axes_as_transformers_is_rejected_for_their_dimension() {
    let found = rejected(System::free(AXES).compile());
    assert_eq!(forced(&found), ["inertia `body`"]);
    let text = found[0].text();
    for axis in ["x", "y", "z"] {
        let part = format!("`joint.{axis}.axis` runs forward only (M has 3 rows and 1 column)");
        assert!(text.contains(&part), "{part} in\n{text}");
    }
    assert!(!text.contains("blocked"), "no source takes part:\n{text}");
}

#[test]
fn all_drawings_give_one_program() {
    let proposed = accepted(System::free(GIMBALS));
    assert!(proposed.dependent.is_empty());
    assert_eq!(proposed.conditioning, ["cos(joint.spring.q.y)"]);
    let program = arithmetic(proposed.program);
    for joint in [REVOLUTES, AXES] {
        let free = System::free(joint);
        let opted = accepted(System {
            mark: ACCEPTED,
            ..free
        });
        assert_eq!(opted.dependent, ["body"]);
        let componentwise = accepted(System {
            first: COMPONENTWISE,
            ..free
        });
        for classic in [opted, componentwise] {
            assert_eq!(classic.conditioning, ["cos(joint.y.spring.q)"], "{joint}");
            assert!(arithmetic(classic.program) == program, "{joint}");
        }
    }
}

#[test]
fn a_coordinate_changes_nothing_where_no_storage_depends() {
    let plain = library();
    let marked = plain.replace("1 rates[3] {", "1 rates[3] coordinate {");
    assert_eq!(marked.len(), plain.len() + " coordinate".len());
    let text = System::free(GIMBALS).text();
    let programs = [plain, marked].map(|library| match compiled(&library, &text) {
        Ok(compiled) => compiled.program,
        Err(found) => panic!("{:?}", texts(&found)),
    });
    assert!(programs[0] == programs[1]);
}

/// Admissible, all integral, and the resistors of the only all-integral assignment.
fn fig_13(floor: &str) -> (usize, Vec<String>, Vec<String>) {
    let graph = System::grounded(floor, FRICTION, GIMBALS).elaborate().graph;
    let all = integral_springs(&graph);
    let integral: Vec<_> = all
        .assignments
        .iter()
        .filter(|assignment| assignment.dependent(&graph).is_empty())
        .collect();
    assert_eq!(integral.len(), 1, "{floor}");
    (
        all.assignments.len(),
        names(&graph, &integral[0].resistances(&graph)),
        names(&graph, &integral[0].conductances(&graph)),
    )
}

#[test]
fn fig_13_is_all_integral_in_one_way_on_both_grounds() {
    let (admissible, resistances, conductances) = fig_13(FIXED);
    assert_eq!(admissible, 5);
    assert_eq!(resistances, ["joint.damper", "air.friction"]);
    assert!(conductances.is_empty());
    let (admissible, resistances, conductances) = fig_13(STIFF);
    assert_eq!(admissible, 3);
    assert_eq!(resistances, ["joint.damper"]);
    assert_eq!(conductances, ["air.friction"]);
}

#[test]
fn revolutes_on_both_sides_of_the_fuselage_make_both_bodies_dependent() {
    for joint in [REVOLUTES, AXES] {
        let found = rejected(System::grounded(FIXED, joint, joint).compile());
        assert_eq!(forced(&found), ["inertia `hull`", "inertia `body`"]);
        let system = System {
            first: COMPONENTWISE,
            ..System::grounded(FIXED, joint, joint)
        };
        assert_eq!(accepted(system).states.len(), 12);
        let found = rejected(System::grounded(STIFF, joint, joint).compile());
        assert_eq!(forced(&found).len(), 1);
    }
}

/// A revolute about x, with what is attached to its free axis, between two wheels.
fn revolute(first: &str, attached: &str) -> String {
    format!(
        "model Hinge {{
            {first}
            1 a[3] {{ I hull {{ inertia: 2.0 }} }}
            1 b[3] {{ R air {{ resistance: 1.0 }} }}
            0 sum[3];
            1 rel[3];
            {attached}
            integral angle = rel.f.x;
            Sf blocked[2] {{ flow: [0.0, 0.0] }} -> rel[1..3];
            a -> sum;
            rel -> sum;
            sum -> MTF turn {{ flow: transpose(rot_x(angle)) }} -> b;
        }}"
    )
}

#[test]
fn a_frictionless_revolute_is_a_conflict_under_one_stroke_only() {
    let found = refused(&revolute("", ""));
    assert_eq!(found[0].code, codes::NO_ASSIGNMENT, "{:?}", texts(&found));
    assert!(compiled("", &revolute(COMPONENTWISE, "")).is_ok());
    assert!(compiled("", &revolute("", "rel.x -> R damper { resistance: 1.0 };")).is_ok());
}

#[test]
fn coulomb_friction_is_a_conflict_on_the_axis_of_a_revolute_only() {
    let dry = "rel.x -> R dry { effort: 2.0 * sign(f) };";
    let found = refused(&revolute("", dry));
    println!("{:?}", texts(&found));
    assert_eq!(found[0].code, codes::FIXED_RESISTOR, "{:?}", texts(&found));
    assert!(found[0].text().contains("`dry`"), "{}", found[0].text());
    assert!(compiled("", &revolute(COMPONENTWISE, dry)).is_ok());
    let library = library().replace(
        "R damper { resistance: damping }",
        "R damper { effort: damping * 1.0 * sign(f) }",
    );
    assert!(compiled(&library, &System::free(GIMBALS).text()).is_ok());
}

#[test]
fn dry_friction_fits_the_new_joint_and_costs_the_classic_one_its_springs() {
    let dry = library().replace(
        "R damper { resistance: damping }",
        "R damper { effort: damping * 1.0 * tanh(f / 1.0) }",
    );
    let compiled = |system: System| compiled(&dry, &system.text());
    assert!(compiled(System::free(GIMBALS)).is_ok());
    let classic = System::free(REVOLUTES);
    let found = rejected(compiled(classic));
    let dependent = [
        "inertia `body`",
        "compliance `joint.x.spring`",
        "compliance `joint.y.spring`",
        "compliance `joint.z.spring`",
    ];
    assert_eq!(forced(&found), dependent);
    let componentwise = System {
        first: COMPONENTWISE,
        ..classic
    };
    assert!(compiled(componentwise).is_ok());
}

#[test]
fn a_gyroscopic_multiport_cannot_give_its_flow() {
    let found = refused(
        "model Gyrostat {
            1 body[3] { Se torque { effort: [1.0, 0.0, 0.0] } EJS rotor { momentum: [0.0, 0.0, 1.0] } }
            integral turned[3] = body.f;
            output y[3] = turned;
        }",
    );
    assert_eq!(codes_of(&found)[0], codes::GYROSCOPIC_INVERSE);
    assert!(found[0].text().contains("rank 2"), "{}", found[0].text());
}

#[test]
fn a_rectangular_transformer_cannot_run_backward() {
    let found = refused(
        "model Backward {
            1 rate { C spring { stiffness: 1.0 } }
            1 wide[3] { Sf drive { flow: [1.0, 0.0, 0.0] } }
            rate -> MTF axis { flow: [[1.0], [0.0], [0.0]] } -> wide;
        }",
    );
    assert_eq!(codes_of(&found)[0], codes::RECTANGULAR_INVERSE);
    let text = found[0].text();
    assert!(text.contains("M has 3 rows and 1 column"), "{text}");
}
