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
    /// Components of the library that the items use and do not declare themselves.
    pub library: Vec<Component>,
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
    /// The name that was written, where no type of the code can have it.
    pub written: Option<Ident>,
    /// What the braces hold.
    pub statements: Vec<Statement>,
}

/// A reusable part of a graph.
pub struct Component {
    /// Documentation comments.
    pub documentation: Vec<Attribute>,
    /// Set by `#[derivative]`: storages inside may be in derivative causality.
    pub derivative: Option<Span>,
    /// Whether it comes from the library: its tokens then have no place in the user's text.
    pub library: bool,
    /// Name by which an instance calls it.
    pub name: Ident,
    /// Ports in order of declaration.
    pub ports: Vec<Port>,
    /// What the braces hold.
    pub statements: Vec<Statement>,
}

/// `port a[3]` or `port 1 a[3]`: stands for the junction given at the call.
pub struct Port {
    /// The only kind of junction that it takes, where one is written.
    pub kind: Option<JunctionKind>,
    /// Name inside the component.
    pub name: Ident,
    /// Dimension, 1 unless written.
    pub dimension: usize,
}

impl Port {
    /// Whether a junction of this kind may be given for it.
    pub fn takes(&self, kind: JunctionKind) -> bool {
        self.kind.is_none_or(|own| own == kind)
    }
}

/// One statement of a model or component.
pub enum Statement {
    /// `param drag: N*m*s/rad = 1e3;`
    Parameter(Parameter),
    /// `param blocked: ideal | compliant = ideal;`
    Choice(Choice),
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
    /// `let arm[2] = [x * cos(angle), x * sin(angle)];`
    Let(Let),
    /// `gravity [0.0, 0.0, -9.81];`
    Gravity(Gravity),
    /// `links: for k in 0..4 { … }`
    Loop(Loop),
    /// `if blocked == compliant { statements } else { statements }`
    Conditional(Conditional),
    /// `close a -> b by multipliers, displacement: r;`
    Closure(Closure),
    /// `assert lower < upper;`
    Assertion(Assertion),
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
    /// Dimension, when written; otherwise a component takes a value of any shape.
    pub dimension: Option<usize>,
    /// Unit, when written.
    pub unit: Option<Unit>,
    /// Default value; a model's parameters must have one.
    pub default: Option<Expr>,
}

impl Parameter {
    /// `: N/m`, or nothing.
    #[must_use]
    pub fn unit_text(&self) -> String {
        let unit = self.unit.as_ref();
        unit.map_or_else(String::new, |unit| format!(": {}", unit.text))
    }
}

/// `param name: word | word = word;`
pub struct Choice {
    /// Documentation comments.
    pub documentation: Vec<Attribute>,
    /// Name.
    pub name: Ident,
    /// The words to choose from, two or more.
    pub words: Vec<Ident>,
    /// The word chosen where an instance says nothing.
    pub default: Option<Ident>,
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

/// `let name[n]: unit = value;`
pub struct Let {
    /// Documentation comments.
    pub documentation: Vec<Attribute>,
    /// Name.
    pub name: Ident,
    /// Dimension, when written; otherwise the value may have any shape.
    pub dimension: Option<usize>,
    /// Unit, when written.
    pub unit: Option<Unit>,
    /// What it stands for.
    pub value: Expr,
}

/// `close a -> b by multipliers, displacement: r;`
pub struct Closure {
    /// The word `close`.
    pub name: Ident,
    /// Where positive power comes from.
    pub from: Reference,
    /// Where positive power goes to.
    pub to: Reference,
    /// How far apart both are: its rate is the flow of `from` less that of `to`.
    pub displacement: Option<Expr>,
}

/// `gravity value;`
pub struct Gravity {
    /// The word.
    pub name: Ident,
    /// The acceleration of free fall.
    pub value: Expr,
}

/// `assert lower < upper;`
pub struct Assertion {
    /// The word.
    pub name: Ident,
    /// What is to hold.
    pub condition: Expr,
}

/// `label: for variable in start..end { statements }`
pub struct Loop {
    /// Name by which its turns are called from outside, when written.
    pub label: Option<Ident>,
    /// The whole number that counts the turns.
    pub variable: Ident,
    /// Its first value.
    pub start: Expr,
    /// One past its last value.
    pub end: Expr,
    /// What the braces hold.
    pub statements: Vec<Statement>,
}

/// `if condition { statements } else if condition { statements } else { statements }`
pub struct Conditional {
    /// The word `if`.
    pub word: Ident,
    /// In order; the first whose condition holds is taken.
    pub branches: Vec<Branch>,
}

/// One part of a [`Conditional`].
pub struct Branch {
    /// What must hold; none after a mere `else`.
    pub condition: Option<Expr>,
    /// What the braces hold.
    pub statements: Vec<Statement>,
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

/// How an attitude is represented by states.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Orientation {
    /// Four, the parts of a quaternion.
    Quaternion,
    /// Nine, a rotation matrix by rows.
    Matrix,
}

impl Orientation {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Quaternion, Self::Matrix];

    /// Its word in the language.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Quaternion => "quaternion",
            Self::Matrix => "matrix",
        }
    }
}

/// `attitude name = quaternion(angular_velocity), initial: value;`
pub struct Attitude {
    /// Documentation comments.
    pub documentation: Vec<Attribute>,
    /// Name.
    pub name: Ident,
    /// `quaternion` or `matrix`.
    pub orientation: Orientation,
    /// Angular velocity in body axes, the argument of `quaternion(…)`.
    pub angular_velocity: Expr,
    /// Value at the start, that of no rotation unless written.
    pub initial: Option<Expr>,
}

/// `1 name[n] coordinate, initial_flow: value { elements }`, `0 name pseudo;`
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
    /// Set by the word `pseudo`: effort times flow is no power.
    pub pseudo: bool,
    /// The coordinate's flow at the start, zero unless written.
    pub initial_flow: Option<Expr>,
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

impl JunctionKind {
    /// The digit that declares it.
    pub fn digit(self) -> char {
        match self {
            Self::Zero => '0',
            Self::One => '1',
        }
    }
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

/// `rel`, `rel.x`, `rel[0]`, `rel[1..3]`, `arm.rel`, `links[k-1].rel[0]`.
#[derive(Clone)]
pub struct Reference {
    /// The dotted path, never empty; a last `x`, `y` or `z` may mean a component, which elaboration decides.
    pub path: Vec<Segment>,
    /// The whole reference (its first token where spans cannot be joined).
    pub span: Span,
}

/// A name in a path, with what stands in brackets after it: the turn of a loop, or components of a junction.
#[derive(Clone)]
pub struct Segment {
    /// The name.
    pub name: Ident,
    /// What stands in brackets.
    pub selection: Option<Selection>,
}

/// `[0]` or `[1..3]`, of whole numbers that elaboration evaluates.
#[derive(Clone)]
pub struct Selection {
    /// The only one, or the first.
    pub start: Expr,
    /// One past the last.
    pub end: Option<Expr>,
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

impl Element {
    /// What stands after its words.
    pub fn values(&self) -> impl Iterator<Item = &Expr> {
        self.fields.iter().filter_map(|field| field.value.as_ref())
    }
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
    /// The value after the colon; none for a bare word.
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
    pub factors: Vec<(Ident, i32)>,
}

impl Unit {
    /// Where it begins; none where nobody wrote it.
    #[must_use]
    pub fn span(&self) -> Option<Span> {
        self.factors.first().map(|(name, _)| name.span())
    }
}

impl Component {
    /// Its parameters in order of declaration.
    pub fn parameters(&self) -> impl Iterator<Item = &Parameter> {
        self.statements
            .iter()
            .filter_map(|statement| match statement {
                Statement::Parameter(parameter) => Some(parameter),
                _ => None,
            })
    }

    /// Its parameters whose values are words, in order of declaration.
    pub fn choices(&self) -> impl Iterator<Item = &Choice> {
        self.statements
            .iter()
            .filter_map(|statement| match statement {
                Statement::Choice(choice) => Some(choice),
                _ => None,
            })
    }
}

impl Instance {
    /// What is given for a parameter: the name there, and the value.
    #[must_use]
    pub fn argument(&self, parameter: &Ident) -> Option<(&Ident, &Expr)> {
        let field = self
            .arguments
            .iter()
            .find(|field| field.name == *parameter)?;
        Some((&field.name, field.value.as_ref()?))
    }
}
