//! The syntax tree: what was written, with the tokens that say where.
//!
//! Nothing is resolved here. Names are identifiers, laws are Rust expressions, and an item that could not be
//! read is a [`Statement::Broken`] whose error has already been reported.

use proc_macro2::{Ident, Span};
use syn::{Attribute, Expr, Visibility};

/// Everything inside one `mbg! { … }`.
pub struct Source {
    /// Models and components in order of appearance.
    pub items: Vec<Item>,
}

/// A top-level item.
pub enum Item {
    /// `pub model Name { … }`
    Model(Model),
    /// `component Name(port a[3]) { … }`
    Component(Component),
}

/// A model: becomes a Rust type.
pub struct Model {
    /// Documentation comments, passed through to the type.
    pub documentation: Vec<Attribute>,
    /// Set by `#[derivative]`, with the attribute's span.
    pub derivative: Option<Span>,
    /// Visibility of the type and of its parameters.
    pub visibility: Visibility,
    /// Name of the type.
    pub name: Ident,
    /// What the braces hold.
    pub statements: Vec<Statement>,
}

/// A reusable part of a graph.
pub struct Component {
    /// Documentation comments.
    pub documentation: Vec<Attribute>,
    /// Set by `#[derivative]`: storages inside may be in derivative causality.
    pub derivative: Option<Span>,
    /// Name by which an instance calls it.
    pub name: Ident,
    /// Ports in order of declaration.
    pub ports: Vec<Port>,
    /// What the braces hold.
    pub statements: Vec<Statement>,
}

/// `port a[3]`: stands for the junction given at the call.
pub struct Port {
    /// Name inside the component.
    pub name: Ident,
    /// Dimension, 1 unless written.
    pub dimension: usize,
}

/// One statement of a model or component.
pub enum Statement {
    /// `param drag: N*m*s/rad = 1e3;`
    Parameter(Parameter),
    /// `input gust[3]: N*m;`
    Input(Input),
    /// `output alpha[3] = spring.q;`
    Output(Output),
    /// `integral alpha[3] = gimbals.f, initial: [0.0, 0.0, 0.0];`
    Integral(Integral),
    /// `attitude q = quaternion(fuselage.f);`
    Attitude(Attitude),
    /// `1 fuselage[3] { … }`
    Junction(Junction),
    /// `gimbals -> MTF jacobian { … } -> joint;`
    Chain(Chain),
    /// `x: RevoluteX { stiffness: k } (fuselage, frame1);`
    Instance(Instance),
    /// `causality componentwise;`
    Causality(Causality, Span),
    /// A statement that could not be read; its error is reported. It keeps the name, when one was seen, so that
    /// uses of it raise no second error.
    Broken(Option<Ident>),
}

/// `param name: unit = default;`
pub struct Parameter {
    /// Documentation comments.
    pub documentation: Vec<Attribute>,
    /// Name.
    pub name: Ident,
    /// Unit, when written.
    pub unit: Option<Unit>,
    /// Default value; a model's parameters must have one.
    pub default: Option<Expr>,
}

/// `input name[n]: unit;`
pub struct Input {
    /// Documentation comments.
    pub documentation: Vec<Attribute>,
    /// Name.
    pub name: Ident,
    /// Dimension, 1 unless written.
    pub dimension: usize,
    /// Unit, when written.
    pub unit: Option<Unit>,
}

/// `output name[n]: unit = value;`
pub struct Output {
    /// Documentation comments.
    pub documentation: Vec<Attribute>,
    /// Name.
    pub name: Ident,
    /// Dimension, 1 unless written.
    pub dimension: usize,
    /// Unit, when written.
    pub unit: Option<Unit>,
    /// What it shows.
    pub value: Expr,
}

/// `integral name[n]: unit = rate, initial: value;`
pub struct Integral {
    /// Documentation comments.
    pub documentation: Vec<Attribute>,
    /// Name.
    pub name: Ident,
    /// Dimension, 1 unless written.
    pub dimension: usize,
    /// Unit, when written.
    pub unit: Option<Unit>,
    /// Its time derivative.
    pub rate: Expr,
    /// Value at the start, 0 unless written.
    pub initial: Option<Expr>,
}

/// `attitude name = quaternion(angular_velocity), initial: value;`
pub struct Attitude {
    /// Documentation comments.
    pub documentation: Vec<Attribute>,
    /// Name.
    pub name: Ident,
    /// Angular velocity in body axes, the argument of `quaternion(…)`.
    pub angular_velocity: Expr,
    /// Value at the start, `[1, 0, 0, 0]` unless written.
    pub initial: Option<Expr>,
}

/// `1 name[n] coordinate { elements }`
pub struct Junction {
    /// Zero or one.
    pub kind: JunctionKind,
    /// Span of the `0` or `1`.
    pub span: Span,
    /// Name.
    pub name: Ident,
    /// Dimension, 1 unless written.
    pub dimension: usize,
    /// Set by the word `coordinate`.
    pub coordinate: bool,
    /// One-ports in the braces.
    pub elements: Vec<Element>,
}

/// Common effort or common flow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JunctionKind {
    /// `0`: common effort, flows sum to zero.
    Zero,
    /// `1`: common flow, efforts sum to zero.
    One,
}

/// `A -> B -> C;`
pub struct Chain {
    /// Two nodes or more.
    pub nodes: Vec<ChainNode>,
    /// Spans of the arrows, one fewer than nodes.
    pub arrows: Vec<Span>,
}

/// A stop in a chain.
pub enum ChainNode {
    /// A junction, port, element or components of a junction, by name.
    Reference(Reference),
    /// An element declared in place.
    Element(Element),
}

/// `rel`, `rel.x`, `rel[0]`, `rel[1..3]`, `arm.rel`.
pub struct Reference {
    /// The dotted path; a last `x`, `y` or `z` may mean a component, which elaboration decides.
    pub path: Vec<Ident>,
    /// What stands in brackets.
    pub selection: Option<Selection>,
    /// The whole reference (its first token where spans cannot be joined).
    pub span: Span,
}

/// `[0]` or `[1..3]`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Selection {
    /// First component.
    pub start: usize,
    /// One past the last component.
    pub end: usize,
}

/// `R air { resistance: drag }`
pub struct Element {
    /// Set by `#[derivative]`.
    pub derivative: Option<Span>,
    /// Which element.
    pub kind: ElementKind,
    /// Span of the kind.
    pub span: Span,
    /// Name.
    pub name: Ident,
    /// Dimension when written: `Sf blocked[2]`.
    pub dimension: Option<usize>,
    /// `word: value` and bare words, in order.
    pub fields: Vec<Field>,
}

/// The elements of the language.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ElementKind {
    /// Effort source.
    Se,
    /// Flow source.
    Sf,
    /// Inertia: stores momentum.
    I,
    /// Compliance: stores displacement.
    C,
    /// Resistor.
    R,
    /// Transformer with a constant modulus.
    TF,
    /// Gyrator with a constant modulus.
    GY,
    /// Modulated transformer.
    MTF,
    /// Modulated gyrator.
    MGY,
    /// Euler junction structure.
    EJS,
}

/// `stiffness: k` or the bare word `gyroscopic`.
pub struct Field {
    /// The word.
    pub name: Ident,
    /// The value after the colon; none for a bare word. `range: lo..hi` arrives as a range expression.
    pub value: Option<Expr>,
}

/// `name: Component { parameter: value } (a, b);`
pub struct Instance {
    /// Name of the instance.
    pub name: Ident,
    /// Set by `#[derivative]`.
    pub derivative: Option<Span>,
    /// The component called.
    pub component: Ident,
    /// Values of parameters.
    pub arguments: Vec<Field>,
    /// Junctions given for the ports, in order.
    pub connections: Vec<Reference>,
}

/// How many strokes a multibond has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Causality {
    /// One stroke per multibond, as drawn.
    Uniform,
    /// One stroke per component.
    Componentwise,
}

/// A unit: its text with single spaces removed, and its factors.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unit {
    /// As shown to users, `N*m*s/rad`.
    pub text: String,
    /// Names with their integer exponents, in order of writing.
    pub factors: Vec<(String, i32)>,
}
