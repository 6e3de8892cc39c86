//! The bond graph: flat, with vector bonds and typed ids. Elaboration makes it; later stages only read it.

use std::ops::Range;

use proc_macro2::Span;

use crate::symbolic::{Expression, Matrix, Product};
pub use crate::syntax::ast::{Causality, ElementKind, JunctionKind};

macro_rules! ids {
    ($($(#[$doc:meta])* $name:ident;)*) => {
        $($(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub usize);)*
    };
}

ids! {
    /// Index into [`BondGraph::junctions`].
    JunctionId;
    /// Index into [`BondGraph::elements`].
    ElementId;
    /// Index into [`BondGraph::bonds`].
    BondId;
    /// Index into [`Origins`].
    OriginId;
}

/// Where an entity was written, and the path under which users know it.
#[derive(Clone, Debug)]
pub struct Origin {
    /// Such as `arm.spring`.
    pub path: String,
    /// Its name's token.
    pub span: Span,
}

/// All origins of a model.
#[derive(Clone, Debug, Default)]
pub struct Origins(Vec<Origin>);

impl Origins {
    /// Adds an origin.
    pub fn add(&mut self, path: impl Into<String>, span: Span) -> OriginId {
        self.0.push(Origin {
            path: path.into(),
            span,
        });
        OriginId(self.0.len() - 1)
    }

    /// Where it was written.
    #[must_use]
    pub fn span(&self, id: OriginId) -> Span {
        self.0[id.0].span
    }

    /// Under which path.
    #[must_use]
    pub fn path(&self, id: OriginId) -> &str {
        &self.0[id.0].path
    }
}

/// A model after elaboration.
#[derive(Clone, Debug)]
pub struct BondGraph {
    /// Junctions in order of declaration.
    pub junctions: Vec<Junction>,
    /// One-ports and two-ports in order of declaration.
    pub elements: Vec<Element>,
    /// Bonds in order of declaration.
    pub bonds: Vec<Bond>,
    /// One stroke per bond or one per component.
    pub causality: Causality,
    /// Loops that are closed by multipliers.
    pub closures: Vec<Closure>,
    /// Where everything was written.
    pub origins: Origins,
}

/// Two ends that move together, held by efforts without power: `f_from = f_to`.
#[derive(Clone, Debug)]
pub struct Closure {
    /// `a -> b`, for people.
    pub name: String,
    /// The path of the component in use that closes it; empty where the model itself does.
    pub instance: String,
    /// The bond that leaves `from` and the one that arrives at `to`. Both end at the border, and their efforts are one.
    pub bonds: [BondId; 2],
    /// How far apart both ends are, if it was given.
    pub displacement: Option<Vec<Expression>>,
    /// Where it was written.
    pub origin: OriginId,
}

/// An array of scalar junctions of one kind.
#[derive(Clone, Debug)]
pub struct Junction {
    /// Zero or one.
    pub kind: JunctionKind,
    /// Path.
    pub name: String,
    /// Number of scalar junctions.
    pub dimension: usize,
    /// Marked `coordinate`.
    pub coordinate: bool,
    /// Marked `pseudo`: effort times flow is no power.
    pub pseudo: bool,
    /// The flow of a coordinate at the start, zero where nothing is given.
    pub initial_flow: Vec<Expression>,
    /// Where it was written.
    pub origin: OriginId,
}

/// A one-port or a two-port.
#[derive(Clone, Debug)]
pub struct Element {
    /// Which element.
    pub kind: ElementKind,
    /// Path.
    pub name: String,
    /// Its constitutive law.
    pub law: Law,
    /// Which strokes the law allows.
    pub rule: Rule,
    /// Whether `#[derivative]` stands on it, its component or the model.
    pub derivative: bool,
    /// Where it was written.
    pub origin: OriginId,
}

/// Which strokes an element allows at its port or ports. Effort *out* means that the element imposes the effort.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// `Se`: imposes effort.
    EffortOut,
    /// `Sf`: imposes flow.
    FlowOut,
    /// `C`: imposes effort when integral. Its inverse for derivative causality exists.
    PreferEffortOut,
    /// `I`: imposes flow when integral.
    PreferFlowOut,
    /// Linear `R`: either.
    Either,
    /// Gyroscopic multiport: receives flow, imposes effort, and never otherwise under one stroke (rank 2 of 3).
    Gyroscopic,
    /// `R` with a law that gives the effort: imposes effort only.
    ResistanceOnly,
    /// `R` with a law that gives the flow: imposes flow only.
    ConductanceOnly,
    /// `f_out = M f_in`, `e_in = Mᵀ e_out`: forward (flow enters at `in`, effort enters at `out`) always; backward
    /// only if M has an inverse.
    Transformer {
        /// Rows of M: dimension of the bond at `out`.
        rows: usize,
        /// Columns of M: dimension of the bond at `in`.
        columns: usize,
        /// Whether M is square and not identically singular.
        invertible: bool,
    },
    /// `e_out = G f_in`, `e_in = Gᵀ f_out`: both bonds bring flow (forward, always), or both bring effort (backward,
    /// only if G has an inverse).
    Gyrator {
        /// Rows of G: dimension of the bond at `out`.
        rows: usize,
        /// Columns of G: dimension of the bond at `in`.
        columns: usize,
        /// Whether G is square and not identically singular.
        invertible: bool,
    },
}

/// A vector bond; positive power goes from `from` to `to`.
#[derive(Clone, Debug)]
pub struct Bond {
    /// Where positive power comes from.
    pub from: End,
    /// Where positive power goes to.
    pub to: End,
    /// Number of scalar bonds.
    pub dimension: usize,
    /// Where it was written.
    pub origin: OriginId,
}

/// What a bond ends in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum End {
    /// Some or all components of a junction.
    Junction(JunctionId, Range<usize>),
    /// The port of a one-port.
    OnePort(ElementId),
    /// The `in` side of a two-port.
    In(ElementId),
    /// The `out` side of a two-port.
    Out(ElementId),
    /// The border of a graph that is studied by itself: any stroke.
    Border,
}

/// A constitutive law, in the symbols of the pool.
#[derive(Clone, Debug)]
pub enum Law {
    /// `Se` or `Sf`: the effort or flow it imposes.
    Source(Vec<Expression>),
    /// `I` or `C`.
    Storage(Storage),
    /// Linear `R`: `e = R f`.
    Resistance(Matrix),
    /// Linear `R`: `f = G e`.
    Conductance(Matrix),
    /// Nonlinear `R`: effort in terms of its own flow, which stands as the signals given.
    EffortLaw(Vec<Expression>),
    /// Nonlinear `R`: flow in terms of its own effort.
    FlowLaw(Vec<Expression>),
    /// `f_out = M f_in`.
    Transformer(Product),
    /// `e_out = G f_in`.
    Gyrator(Product),
    /// Gyroscopic multiport `e = ω × h` with momentum h.
    EulerJunction(Vec<Expression>),
}

/// What a storage does in integral causality.
#[derive(Clone, Debug)]
pub struct Storage {
    /// Its candidate states, numbers of `Symbol::State`.
    pub states: Range<usize>,
    /// The co-energy variable: flow of an `I`, effort of a `C`.
    pub coenergy: Vec<Expression>,
    /// Stored energy.
    pub energy: Expression,
    /// How the energy is found.
    pub integral: Integral,
    /// Its states, where they are told in terms of others: a candidate that is none.
    pub displacement: Option<Vec<Expression>>,
}

/// How the energy of a storage is found from its law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integral {
    /// In closed form.
    Exact,
    /// By a quadrature from the state zero.
    FromZero,
    /// By a quadrature from the state at the start, since the law has no integral from zero.
    FromStart,
}

impl Junction {
    /// Its name without the path.
    pub fn own_name(&self) -> &str {
        self.name.rsplit('.').next().unwrap_or(&self.name)
    }

    /// The name of a component of its flow: `wheel.f`, `wheel.f.x`.
    pub fn flow(&self, component: usize) -> String {
        match self.dimension {
            1 => format!("{}.f", self.name),
            dimension => format!("{}.f.{}", self.name, component_name(component, dimension)),
        }
    }

    /// Its declaration, were it of this kind: `1 wheel[3]`.
    pub fn declaration(&self, kind: JunctionKind) -> String {
        declaration(kind, self.own_name(), self.dimension)
    }
}

/// The declaration of a junction: `1 wheel[3]`.
pub fn declaration(kind: JunctionKind, name: &str, dimension: usize) -> String {
    let digit = kind.digit();
    match dimension {
        1 => format!("{digit} {name}"),
        _ => format!("{digit} {name}[{dimension}]"),
    }
}

impl Element {
    /// Its name without the path.
    pub fn own_name(&self) -> &str {
        self.name.rsplit('.').next().unwrap_or(&self.name)
    }

    /// Whether it is a storage with states of its own.
    #[must_use]
    pub const fn has_states(&self) -> bool {
        matches!(
            self.law,
            Law::Storage(Storage {
                displacement: None,
                ..
            })
        )
    }

    /// Path of the component in use that it belongs to, if it is not written in the model itself.
    #[must_use]
    pub fn instance(&self) -> Option<&str> {
        instance_of(&self.name)
    }

    /// What to type so that its derivative causality is accepted.
    #[must_use]
    pub fn acceptance(&self) -> String {
        let own = self.name.rsplit('.').next().unwrap_or(&self.name);
        let Some(instance) = self.instance() else {
            let written = format!("{:?} {own}", self.kind);
            return format!(
                "write `#[derivative]` before `{written}` to accept it: `#[derivative] {written} {{ … }}`"
            );
        };
        let own = instance.rsplit('.').next().unwrap_or(instance);
        format!(
            "write `#[derivative]` before `{own}: …`, which makes `{instance}`, or before the model, to accept it"
        )
    }
}

/// Path of the component in use in which a path leads. A loop is no component: what it makes has a number.
#[must_use]
pub fn instance_of(mut path: &str) -> Option<&str> {
    while let Some((outer, _)) = path.rsplit_once('.') {
        if !outer.ends_with(']') {
            return Some(outer);
        }
        path = outer;
    }
    None
}

/// Paths of the components in use in which a path leads, from inside out.
fn instances_of(path: &str) -> impl Iterator<Item = &str> {
    std::iter::successors(instance_of(path), |outer| instance_of(outer))
}

/// The outermost component in use in which a path leads, inside another one.
pub fn outermost_instance<'a>(path: &'a str, inside: Option<&str>) -> Option<&'a str> {
    let instances = instances_of(path);
    instances.take_while(|it| Some(*it) != inside).last()
}

impl BondGraph {
    /// Whether an element is on a pseudo bond: effort times flow is no power there.
    #[must_use]
    pub fn is_pseudo(&self, id: ElementId) -> bool {
        let pseudo = |end: &End| matches!(end, End::Junction(id, _) if self.junctions[id.0].pseudo);
        self.bonds.iter().any(|bond| {
            (bond.from == End::OnePort(id) && pseudo(&bond.to))
                || (bond.to == End::OnePort(id) && pseudo(&bond.from))
        })
    }

    /// What the bonds of a junction lead to.
    pub fn across(&self, id: JunctionId) -> impl Iterator<Item = &End> {
        let is_here = move |end: &End| matches!(end, End::Junction(other, _) if *other == id);
        let bonds = self.bonds.iter();
        let ends = bonds.flat_map(|bond| [(&bond.from, &bond.to), (&bond.to, &bond.from)]);
        ends.filter(move |(end, _)| is_here(end))
            .map(|(_, far)| far)
    }

    /// What the other port of a two-port leads to.
    #[must_use]
    pub fn beyond(&self, port: &End) -> Option<&End> {
        let other = match port {
            End::In(id) => End::Out(*id),
            End::Out(id) => End::In(*id),
            _ => return None,
        };
        self.bonds
            .iter()
            .find_map(|bond| match (&bond.from, &bond.to) {
                (from, to) if *from == other => Some(to),
                (from, to) if *to == other => Some(from),
                _ => None,
            })
    }

    /// The path of an end, for people.
    #[must_use]
    pub fn end_name(&self, end: &End) -> String {
        match end {
            End::Junction(id, range) => {
                let junction = &self.junctions[id.0];
                if *range == (0..junction.dimension) {
                    junction.name.clone()
                } else if range.len() == 1 {
                    format!(
                        "{}.{}",
                        junction.name,
                        component_name(range.start, junction.dimension)
                    )
                } else {
                    format!("{}[{}..{}]", junction.name, range.start, range.end)
                }
            }
            End::OnePort(id) | End::In(id) | End::Out(id) => self.elements[id.0].name.clone(),
            End::Border => "border".to_owned(),
        }
    }

    /// `a -> b`, for people.
    #[must_use]
    pub fn bond_name(&self, id: BondId) -> String {
        let bond = &self.bonds[id.0];
        format!(
            "{} -> {}",
            self.end_name(&bond.from),
            self.end_name(&bond.to)
        )
    }

    /// One junction or element a line.
    #[must_use]
    pub fn dump(&self) -> String {
        let junctions = self.junctions.iter().map(|junction| {
            let kind = junction.kind.digit();
            format!("{kind} {}[{}]", junction.name, junction.dimension)
        });
        let elements = self.elements.iter().map(|element| {
            let mark = if element.derivative {
                " #[derivative]"
            } else {
                ""
            };
            format!(
                "{:?} {} {:?}{mark}",
                element.kind, element.name, element.rule
            )
        });
        junctions.chain(elements).collect::<Vec<_>>().join("\n")
    }
}

/// `x`, `y`, `z` up to dimension 3, else the number.
#[must_use]
pub fn component_name(index: usize, dimension: usize) -> String {
    if dimension <= 3 {
        ["x", "y", "z"][index].to_owned()
    } else {
        index.to_string()
    }
}
