//! Small graphs for tests.

use proc_macro2::Span;

use crate::graph::{
    Bond, BondGraph, BondId, Causality, Element, ElementId, ElementKind, End, Junction, JunctionId,
    JunctionKind, Law, Origins, Rule,
};

/// Builds a graph by hand.
pub(super) struct Builder {
    pub(super) graph: BondGraph,
}

/// What stands on the relative 1-junction of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Attached {
    R,
    Coulomb,
    C,
    Se,
}

/// The joints of Tod et al. (2013).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Joint {
    Spherical,
    /// Three revolutes, blocked by `Sf` on a direct sum.
    Revolutes,
    /// Three revolutes, each with a 3x1 transformer for its axis.
    Axes,
    /// The new joint, with a square Jacobian.
    New,
}

/// What a joint has made.
pub(super) struct Made {
    pub(super) relative: BondId,
    pub(super) zero: Vec<BondId>,
}

impl Builder {
    pub(super) fn new() -> Self {
        let graph = BondGraph {
            junctions: Vec::new(),
            elements: Vec::new(),
            bonds: Vec::new(),
            causality: Causality::Uniform,
            closures: Vec::new(),
            origins: Origins::default(),
        };
        Self { graph }
    }

    pub(super) fn junction(
        &mut self,
        kind: JunctionKind,
        name: &str,
        dimension: usize,
    ) -> JunctionId {
        let origin = self.graph.origins.add(name, Span::call_site());
        let name = name.to_owned();
        let coordinate = false;
        self.graph.junctions.push(Junction {
            kind,
            name,
            dimension,
            coordinate,
            pseudo: false,
            initial_flow: Vec::new(),
            origin,
        });
        JunctionId(self.graph.junctions.len() - 1)
    }

    pub(super) fn one(&mut self, name: &str, dimension: usize) -> JunctionId {
        self.junction(JunctionKind::One, name, dimension)
    }

    pub(super) fn zero(&mut self, name: &str, dimension: usize) -> JunctionId {
        self.junction(JunctionKind::Zero, name, dimension)
    }

    pub(super) fn whole(&self, id: JunctionId) -> End {
        End::Junction(id, 0..self.graph.junctions[id.0].dimension)
    }

    pub(super) fn element(&mut self, kind: ElementKind, name: &str, rule: Rule) -> ElementId {
        let origin = self.graph.origins.add(name, Span::call_site());
        let name = name.to_owned();
        // The strokes depend on the rule alone.
        let law = Law::Source(Vec::new());
        self.graph.elements.push(Element {
            kind,
            name,
            law,
            rule,
            derivative: false,
            origin,
        });
        ElementId(self.graph.elements.len() - 1)
    }

    pub(super) fn bond(&mut self, from: End, to: End) -> BondId {
        let dimension = [&from, &to].map(|end| match end {
            End::Junction(_, range) => range.len(),
            _ => 0,
        });
        let dimension = dimension[0].max(dimension[1]);
        let origin = self.graph.origins.add("->", Span::call_site());
        self.graph.bonds.push(Bond {
            from,
            to,
            dimension,
            origin,
        });
        BondId(self.graph.bonds.len() - 1)
    }

    /// A one-port at an end, with power into it unless it is a source.
    pub(super) fn port(&mut self, name: &str, rule: Rule, at: End) -> ElementId {
        let kind = match rule {
            Rule::EffortOut => ElementKind::Se,
            Rule::FlowOut => ElementKind::Sf,
            Rule::PreferEffortOut => ElementKind::C,
            Rule::PreferFlowOut => ElementKind::I,
            Rule::Gyroscopic => ElementKind::EJS,
            _ => ElementKind::R,
        };
        let id = self.element(kind, name, rule);
        if matches!(kind, ElementKind::Se | ElementKind::Sf) {
            self.bond(End::OnePort(id), at);
        } else {
            self.bond(at, End::OnePort(id));
        }
        id
    }

    /// `from -> MTF name -> to`; square ones have an inverse.
    pub(super) fn transformer(
        &mut self,
        name: &str,
        size: (usize, usize),
        from: End,
        to: End,
    ) -> (BondId, BondId) {
        let (rows, columns) = size;
        let rule = Rule::Transformer {
            rows,
            columns,
            invertible: rows == columns,
        };
        let id = self.element(ElementKind::MTF, name, rule);
        (self.bond(from, End::In(id)), self.bond(End::Out(id), to))
    }

    pub(super) fn attach(&mut self, prefix: &str, attached: &[Attached], at: &End) {
        for what in attached {
            let (name, rule) = match what {
                Attached::R => ("damper", Rule::Either),
                Attached::Coulomb => ("friction", Rule::ResistanceOnly),
                Attached::C => ("spring", Rule::PreferEffortOut),
                Attached::Se => ("motor", Rule::EffortOut),
            };
            self.port(&format!("{prefix}.{name}"), rule, at.clone());
        }
    }

    /// One 0-junction with its relative bond and the rotation behind it.
    fn section(
        &mut self,
        joint: Joint,
        prefix: &str,
        ends: (End, End),
        attached: &[Attached],
        axis: usize,
    ) -> Made {
        let sum = self.zero(&format!("{prefix}.sum"), 3);
        let relative = match joint {
            Joint::Spherical => {
                let rel = self.one(&format!("{prefix}.rel"), 3);
                self.attach(prefix, attached, &self.whole(rel));
                self.bond(self.whole(rel), self.whole(sum))
            }
            Joint::Revolutes => {
                let rel = self.one(&format!("{prefix}.rel"), 3);
                self.attach(prefix, attached, &End::Junction(rel, axis..axis + 1));
                let blocked =
                    self.element(ElementKind::Sf, &format!("{prefix}.blocked"), Rule::FlowOut);
                // One source for both blocked components where they are neighbours, else one for each.
                if axis == 1 {
                    let second = self.element(
                        ElementKind::Sf,
                        &format!("{prefix}.blocked_z"),
                        Rule::FlowOut,
                    );
                    self.bond(End::OnePort(blocked), End::Junction(rel, 0..1));
                    self.bond(End::OnePort(second), End::Junction(rel, 2..3));
                } else {
                    let range = if axis == 0 { 1..3 } else { 0..2 };
                    self.bond(End::OnePort(blocked), End::Junction(rel, range));
                }
                self.bond(self.whole(rel), self.whole(sum))
            }
            Joint::Axes => {
                let rate = self.one(&format!("{prefix}.rate"), 1);
                self.attach(prefix, attached, &self.whole(rate));
                self.transformer(
                    &format!("{prefix}.axis"),
                    (3, 1),
                    self.whole(rate),
                    self.whole(sum),
                )
                .1
            }
            Joint::New => {
                let rate = self.one(&format!("{prefix}.gimbals"), 3);
                self.attach(prefix, attached, &self.whole(rate));
                self.transformer(
                    &format!("{prefix}.jacobian"),
                    (3, 3),
                    self.whole(rate),
                    self.whole(sum),
                )
                .1
            }
        };
        let before = self.bond(ends.0, self.whole(sum));
        let (after, _) =
            self.transformer(&format!("{prefix}.turn"), (3, 3), self.whole(sum), ends.1);
        Made {
            relative,
            zero: vec![before, relative, after],
        }
    }

    /// One section of a joint between two ends.
    pub(super) fn one_joint(
        &mut self,
        joint: Joint,
        prefix: &str,
        ends: (End, End),
        attached: &[Attached],
    ) -> Made {
        self.section(joint, prefix, ends, attached, 0)
    }

    /// A whole joint between two junctions: three sections for the classic ones.
    pub(super) fn joint(
        &mut self,
        joint: Joint,
        prefix: &str,
        ends: (JunctionId, JunctionId),
        attached: &[Attached],
    ) {
        let (mut from, last) = (self.whole(ends.0), self.whole(ends.1));
        if matches!(joint, Joint::Spherical | Joint::New) {
            self.section(joint, prefix, (from, last), attached, 0);
            return;
        }
        for (axis, name) in ["x", "y", "z"].iter().enumerate() {
            // Sections meet at 1-junctions, as components do that are joined in series.
            let to = if axis == 2 {
                last.clone()
            } else {
                let frame = self.one(&format!("{prefix}.frame{}", axis + 1), 3);
                self.whole(frame)
            };
            self.section(
                joint,
                &format!("{prefix}.{name}"),
                (from, to.clone()),
                attached,
                axis,
            );
            from = to;
        }
    }
}

/// What holds the ground of the navigation system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ground {
    Sf,
    StiffC,
}

/// Ground, joint A, fuselage, joint B, platform: Fig. 12 and 13 of the paper, with joint A before the fuselage.
pub(super) fn navigation(a: Joint, b: Joint, ground: Ground) -> BondGraph {
    let mut builder = Builder::new();
    let base = builder.one("ground", 3);
    let rule = if ground == Ground::Sf {
        Rule::FlowOut
    } else {
        Rule::PreferEffortOut
    };
    builder.port("floor", rule, builder.whole(base));
    let fuselage = builder.one("fuselage", 3);
    builder.port("hull", Rule::PreferFlowOut, builder.whole(fuselage));
    let platform = builder.one("platform", 3);
    builder.port("body", Rule::PreferFlowOut, builder.whole(platform));
    builder.joint(a, "a", (base, fuselage), &[Attached::R]);
    builder.joint(b, "b", (fuselage, platform), &[Attached::R, Attached::C]);
    builder.graph
}

/// Fuselage and platform alone with joint B between them, as in the example of the language.
pub(super) fn fig_12(joint: Joint) -> BondGraph {
    let mut builder = Builder::new();
    let fuselage = builder.one("fuselage", 3);
    builder.port("hull", Rule::PreferFlowOut, builder.whole(fuselage));
    builder.port("air", Rule::Either, builder.whole(fuselage));
    builder.port("wind", Rule::EffortOut, builder.whole(fuselage));
    let platform = builder.one("platform", 3);
    builder.port("body", Rule::PreferFlowOut, builder.whole(platform));
    builder.joint(
        joint,
        "b",
        (fuselage, platform),
        &[Attached::R, Attached::C],
    );
    builder.graph
}
