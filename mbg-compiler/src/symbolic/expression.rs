//! Expressions: handles to the nodes of a pool, and how the value of a node comes about.

use std::borrow::Cow;

use crate::operands::Operands;

/// A handle to a node of a [`Pool`](super::Pool), with a sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Expression(u32);

impl Expression {
    /// The constant 0.
    pub const ZERO: Self = Self(0);
    /// The constant 1.
    pub const ONE: Self = Self(2);

    pub(super) fn new(node: usize, negative: bool) -> Self {
        Self((node as u32) << 1 | u32::from(negative))
    }

    /// Index of the node.
    #[must_use]
    pub fn node(self) -> usize {
        (self.0 >> 1) as usize
    }

    /// Whether the node's value is negated.
    #[must_use]
    pub fn is_negative(self) -> bool {
        self.0 & 1 == 1
    }

    /// Without its sign.
    #[must_use]
    pub fn magnitude(self) -> Self {
        Self(self.0 & !1)
    }

    /// With the opposite sign.
    #[must_use]
    pub fn negated(self) -> Self {
        if self == Self::ZERO {
            self
        } else {
            Self(self.0 ^ 1)
        }
    }

    /// Negated where `flip` holds.
    #[must_use]
    pub fn flipped(self, flip: bool) -> Self {
        if flip { self.negated() } else { self }
    }
}

/// A variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Symbol {
    /// A parameter of the model, by number.
    Parameter(usize),
    /// A candidate state, by number.
    State(usize),
    /// An input, by number.
    Input(usize),
    /// Time.
    Time,
    /// An effort or flow inside the graph, by number, before it is solved for.
    Signal(usize),
    /// How a state or input changes along a direction, by its place among those that vary; in a [sweep](crate::sweeps)
    /// backwards the weight of a rate, by its place.
    Slope(usize),
    /// An effort or flow that an iteration finds, by number of the unknown; see [`Implicit`](super::Implicit).
    Unknown(usize),
}

/// Elementary functions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Function {
    /// Tangent.
    Tan,
    /// Arc sine.
    Asin,
    /// Arc cosine.
    Acos,
    /// Angle of (x, y), arguments y, x.
    Atan2,
    /// Exponential.
    Exp,
    /// Natural logarithm.
    Ln,
    /// The first argument to the power of the second.
    Pow,
    /// Square root.
    Sqrt,
    /// Absolute value.
    Abs,
    /// −1, 0 or 1.
    Sign,
    /// Hyperbolic tangent.
    Tanh,
    /// What is left beyond the next whole number below.
    Fraction,
    /// The smaller.
    Min,
    /// The larger.
    Max,
    /// `a < b ? c : d`.
    SelectLess,
}

impl Function {
    /// All of them.
    pub const ALL: [Self; 15] = [
        Self::Tan,
        Self::Asin,
        Self::Acos,
        Self::Atan2,
        Self::Exp,
        Self::Ln,
        Self::Pow,
        Self::Sqrt,
        Self::Abs,
        Self::Sign,
        Self::Tanh,
        Self::Fraction,
        Self::Min,
        Self::Max,
        Self::SelectLess,
    ];

    /// Name in the language and of the method of `Real`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Tan => "tan",
            Self::Asin => "asin",
            Self::Acos => "acos",
            Self::Atan2 => "atan2",
            Self::Exp => "exp",
            Self::Ln => "ln",
            Self::Pow => "pow",
            Self::Sqrt => "sqrt",
            Self::Abs => "abs",
            Self::Sign => "sign",
            Self::Tanh => "tanh",
            Self::Fraction => "fraction",
            Self::Min => "min",
            Self::Max => "max",
            Self::SelectLess => "select_less",
        }
    }

    /// Number of arguments.
    #[must_use]
    pub fn arity(self) -> usize {
        match self {
            Self::Atan2 | Self::Pow | Self::Min | Self::Max => 2,
            Self::SelectLess => 4,
            _ => 1,
        }
    }

    /// Its value for numbers.
    #[must_use]
    pub fn evaluate(self, a: &[f64]) -> f64 {
        match self {
            Self::Tan => a[0].tan(),
            Self::Asin => a[0].asin(),
            Self::Acos => a[0].acos(),
            Self::Atan2 => a[0].atan2(a[1]),
            Self::Exp => a[0].exp(),
            Self::Ln => a[0].ln(),
            Self::Pow => a[0].powf(a[1]),
            Self::Sqrt => a[0].sqrt(),
            Self::Abs => a[0].abs(),
            Self::Sign => f64::from(i8::from(a[0] > 0.0) - i8::from(a[0] < 0.0)),
            Self::Tanh => a[0].tanh(),
            Self::Fraction => a[0] - a[0].floor(),
            Self::Min => a[0].min(a[1]),
            Self::Max => a[0].max(a[1]),
            Self::SelectLess => {
                if a[0] < a[1] {
                    a[2]
                } else {
                    a[3]
                }
            }
        }
    }
}

/// How a node's value comes about.
#[derive(Clone, Debug, PartialEq)]
pub enum Operation {
    /// A number, not negative.
    Constant(f64),
    /// A variable.
    Symbol(Symbol),
    /// Sum; the first operand carries no sign.
    Add(Expression, Expression),
    /// Product of magnitudes.
    Multiply(Expression, Expression),
    /// Quotient of magnitudes.
    Divide(Expression, Expression),
    /// Sine of a magnitude.
    Sine(Expression),
    /// Cosine of a magnitude.
    Cosine(Expression),
    /// Another function.
    Call(Function, Vec<Expression>),
}

impl Operation {
    /// What it is computed from.
    #[must_use]
    pub fn operands(&self) -> Operands<'_, Expression> {
        match self {
            Self::Constant(_) | Self::Symbol(_) => Operands::Zero,
            Self::Add(a, b) | Self::Multiply(a, b) | Self::Divide(a, b) => Operands::Two([*a, *b]),
            Self::Sine(a) | Self::Cosine(a) => Operands::One([*a]),
            Self::Call(_, arguments) => Operands::Many(Cow::Borrowed(arguments)),
        }
    }
}

/// How often a value changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rate {
    /// Never.
    Constant,
    /// With the parameters: computed once, when a model is built.
    Parameter,
    /// With time, state or input: computed at every evaluation.
    Varying,
}
