//! The navigation system in the language, with the components that the example writes.

use std::collections::BTreeMap;

use mbg_compiler::compile::{Compiled, Routines, compile};
use mbg_compiler::diagnostics::{Diagnostic, Diagnostics};
use mbg_compiler::elaborate::{self, Elaborated};
use mbg_compiler::program::Program;
use mbg_compiler::symbolic::Pool;
use mbg_compiler::syntax;
use mbg_compiler::syntax::ast::{Component, Item, Model};

/// What stands between the braces of the example's `mbg! { … }`.
fn example() -> String {
    let file = include_str!("../../../examples/ins/models.rs");
    let (_, inner) = file.split_once("mbg! {").expect("the call");
    let (inner, _) = inner.rsplit_once('}').expect("its last brace");
    inner.to_owned()
}

/// Ground to fuselage: friction about axes of the ground. No spring tells the angles, so they are integrated.
const AIR: &str = "
    component Air(port a[3], port b[3]) {
        param drag: N*m*s/rad;
        1 rates[3];
        1 relative[3] { R friction { resistance: drag } }
        0 sum[3];
        integral angle[3]: rad = rates.f;
        rates -> MTF jacobian { flow: jacobian_xyz(angle) } -> relative;
        a -> sum;
        relative -> sum;
        sum -> MTF turn { flow: transpose(rot_x(angle.x) * rot_y(angle.y) * rot_z(angle.z)) } -> b;
    }";

/// The spherical joint of Fig. 3: stiffness and damping about axes of `a`.
const SPHERICAL: &str = "
    component Spherical(port a[3], port b[3]) {
        param stiffness: N*m/rad;
        param damping: N*m*s/rad;
        1 rel[3] {
            C spring { stiffness: stiffness }
            R damper { resistance: damping }
        }
        0 sum[3];
        a -> sum;
        rel -> sum;
        sum -> MTF turn {
            flow: transpose(rot_x(spring.q.x) * rot_y(spring.q.y) * rot_z(spring.q.z))
        } -> b;
    }";

/// One revolute with its axis as a 3×1 transformer instead of a direct sum, about each axis.
fn axes() -> String {
    let axis = |name: &str, column: &str, turn: &str| {
        format!(
            "component Axis{name}(port a[3], port b[3]) {{
                param stiffness: N*m/rad;
                param damping: N*m*s/rad;
                1 rate {{
                    C spring {{ stiffness: stiffness }}
                    R damper {{ resistance: damping }}
                }}
                0 sum[3];
                rate -> MTF axis {{ flow: {column} }} -> sum;
                a -> sum;
                sum -> MTF turn {{ flow: transpose({turn}(spring.q)) }} -> b;
            }}"
        )
    };
    let sections = [
        axis("X", "[[1.0], [0.0], [0.0]]", "rot_x"),
        axis("Y", "[[0.0], [1.0], [0.0]]", "rot_y"),
        axis("Z", "[[0.0], [0.0], [1.0]]", "rot_z"),
    ];
    let joint = "component Axes(port a[3], port b[3]) {
        param stiffness: N*m/rad;
        param damping: N*m*s/rad;
        1 frame1[3];
        1 frame2[3];
        x: AxisX { stiffness: stiffness, damping: damping } (a, frame1);
        y: AxisY { stiffness: stiffness, damping: damping } (frame1, frame2);
        z: AxisZ { stiffness: stiffness, damping: damping } (frame2, b);
    }";
    format!("{}{joint}", sections.concat())
}

/// A joint that the tests know by name, with its arguments.
pub(super) const GIMBALS: &str = "Gimbals { stiffness: stiffness, damping: damping }";
pub(super) const REVOLUTES: &str = "Revolutes { stiffness: stiffness, damping: damping }";
pub(super) const AXES: &str = "Axes { stiffness: stiffness, damping: damping }";
pub(super) const FRICTION: &str = "Air { drag: drag }";

/// The ground as the two things that the paper takes it for.
pub(super) const FIXED: &str = "Sf floor { flow: [0.0, 0.0, 0.0] }";
pub(super) const STIFF: &str = "C floor { stiffness: ground }";

/// A system under test.
#[derive(Clone, Copy)]
pub(super) struct System<'a> {
    /// What stands before `model`, such as `#[derivative]`.
    pub mark: &'a str,
    /// What stands first in the model, such as `causality componentwise;`.
    pub first: &'a str,
    /// One-port and joint that hold the fuselage; air of its own if there are none.
    pub ground: Option<(&'a str, &'a str)>,
    /// Joint between fuselage and platform.
    pub joint: &'a str,
}

impl System<'_> {
    /// Without ground, as drawn.
    pub(super) fn free(joint: &str) -> System<'_> {
        System {
            mark: "",
            first: "",
            ground: None,
            joint,
        }
    }

    /// With a ground, as drawn.
    pub(super) fn grounded<'a>(floor: &'a str, air: &'a str, joint: &'a str) -> System<'a> {
        System {
            ground: Some((floor, air)),
            ..System::free(joint)
        }
    }

    /// The model's text.
    pub(super) fn text(&self) -> String {
        let Self {
            mark, first, joint, ..
        } = self;
        let hold = match self.ground {
            Some((floor, air)) => {
                format!("1 base[3] {{ {floor} }} air: {air} (base, fuselage);")
            }
            None => "fuselage -> R air { resistance: drag };".to_owned(),
        };
        format!(
            "{mark} model Tested {{
                {first}
                param drag: N*m*s/rad = 1e3;
                param stiffness: N*m/rad = 1e-5;
                param damping: N*m*s/rad = 1e-5;
                param ground: N*m/rad = 1e6;
                input gust[3]: N*m;
                1 fuselage[3] {{
                    I hull {{ inertia: diag(1e4, 1e4, 5e3), gyroscopic }}
                    Se wind {{ effort: gust }}
                }}
                1 platform[3] {{ I body {{ inertia: diag(10.0, 10.0, 10.0), gyroscopic }} }}
                joint: {joint} (fuselage, platform);
                {hold}
            }}"
        )
    }

    /// Through all stages.
    pub(super) fn compile(&self) -> Result<Compiled, Vec<Diagnostic>> {
        compiled(&library(), &self.text())
    }

    /// Flat, before any verdict.
    pub(super) fn elaborate(&self) -> Elaborated {
        elaborated(&self.text())
    }
}

/// The components of the example and those of the tests.
pub(super) fn library() -> String {
    format!("{}{AIR}{SPHERICAL}{}", example(), axes())
}

/// The last model of a text, with the components of another.
pub(super) fn compiled(library: &str, model: &str) -> Result<Compiled, Vec<Diagnostic>> {
    with_last(library, model, |model, components, diagnostics| {
        compile(model, components, diagnostics)
    })
}

/// The graph of a model that may use the components, before any verdict.
pub(super) fn elaborated(model: &str) -> Elaborated {
    let elaborated = with_last(&library(), model, |model, components, diagnostics| {
        elaborate::elaborate(model, components, &mut Pool::new(), diagnostics)
    });
    elaborated.unwrap_or_else(|found| panic!("{:?}", texts(&found)))
}

fn with_last<T>(
    library: &str,
    model: &str,
    stage: impl FnOnce(&Model, &BTreeMap<String, &Component>, &mut Diagnostics) -> Option<T>,
) -> Result<T, Vec<Diagnostic>> {
    let mut diagnostics = Diagnostics::new();
    let tokens = format!("{library}{model}").parse().expect("tokens");
    let source = syntax::parse(tokens, &mut diagnostics);
    assert!(
        !diagnostics.any(),
        "syntax: {:?}",
        texts(diagnostics.list())
    );
    let components = elaborate::component_table(&source);
    let Some(Item::Model(last)) = source.items.last() else {
        panic!("a model comes last")
    };
    stage(last, &components, &mut diagnostics).ok_or_else(|| diagnostics.list().to_vec())
}

/// What users would read.
pub(super) fn texts(diagnostics: &[Diagnostic]) -> Vec<String> {
    diagnostics.iter().map(Diagnostic::text).collect()
}

/// The arithmetic of a program without the names of its lines, and without the energy: that of a spring with three
/// components halves their sum, that of three springs sums their halves.
pub(super) fn arithmetic(mut program: Program) -> Program {
    program.folded.names.clear();
    for routine in &mut program.routines {
        routine.names.clear();
    }
    program.routines.remove(Routines::ENERGY);
    program
}
