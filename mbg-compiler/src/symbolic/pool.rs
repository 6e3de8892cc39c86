//! The pool of expressions: a graph in which equal functions are one node.
//!
//! A node is found again by its image (see [`super::field`]), not by its form, so `sin² + cos²` *is* 1, a product of
//! a rotation with its inverse *is* the vector it began with, and a gyroscopic torque of an isotropic inertia *is*
//! zero. The first form in which a function was built is the one that is kept. Negation is a bit of the handle and
//! costs nothing.

use std::collections::HashMap;

use super::field::Image;
use super::implicit::{Implicit, Place};

/// A handle to a node of a [`Pool`], with a sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Expression(u32);

impl Expression {
    /// The constant 0.
    pub const ZERO: Self = Self(0);
    /// The constant 1.
    pub const ONE: Self = Self(2);

    fn new(node: usize, negative: bool) -> Self {
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
    /// An effort or flow that an iteration finds, by number of the unknown; see [`Implicit`].
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
    /// Square root.
    Sqrt,
    /// Absolute value.
    Abs,
    /// −1, 0 or 1.
    Sign,
    /// Hyperbolic tangent.
    Tanh,
    /// The smaller.
    Min,
    /// The larger.
    Max,
    /// `a < b ? c : d`.
    SelectLess,
}

impl Function {
    /// All of them.
    pub const ALL: [Self; 13] = [
        Self::Tan,
        Self::Asin,
        Self::Acos,
        Self::Atan2,
        Self::Exp,
        Self::Ln,
        Self::Sqrt,
        Self::Abs,
        Self::Sign,
        Self::Tanh,
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
            Self::Sqrt => "sqrt",
            Self::Abs => "abs",
            Self::Sign => "sign",
            Self::Tanh => "tanh",
            Self::Min => "min",
            Self::Max => "max",
            Self::SelectLess => "select_less",
        }
    }

    /// Number of arguments.
    #[must_use]
    pub fn arity(self) -> usize {
        match self {
            Self::Atan2 | Self::Min | Self::Max => 2,
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
            Self::Sqrt => a[0].sqrt(),
            Self::Abs => a[0].abs(),
            Self::Sign => f64::from(i8::from(a[0] > 0.0) - i8::from(a[0] < 0.0)),
            Self::Tanh => a[0].tanh(),
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
    pub fn operands(&self) -> Vec<Expression> {
        match self {
            Self::Constant(_) | Self::Symbol(_) => Vec::new(),
            Self::Add(a, b) | Self::Multiply(a, b) | Self::Divide(a, b) => vec![*a, *b],
            Self::Sine(a) | Self::Cosine(a) => vec![*a],
            Self::Call(_, arguments) => arguments.clone(),
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

struct Node {
    operation: Operation,
    image: Image,
    rate: Rate,
}

/// Unknowns that are none of the graph are numbered from here.
const FRESH: usize = 1 << 31;

/// All expressions of a model.
pub struct Pool {
    nodes: Vec<Node>,
    /// Looked up, never iterated.
    found: HashMap<Image, u32>,
    implicit: Vec<Implicit>,
    /// How many unknowns were made up.
    fresh: usize,
}

impl Default for Pool {
    fn default() -> Self {
        Self::new()
    }
}

impl Pool {
    /// A pool that holds 0 and 1.
    #[must_use]
    pub fn new() -> Self {
        let mut pool = Self {
            nodes: Vec::new(),
            found: HashMap::new(),
            implicit: Vec::new(),
            fresh: 0,
        };
        pool.insert(Operation::Constant(0.0), Image::ZERO, Rate::Constant);
        pool.insert(Operation::Constant(1.0), Image::ONE, Rate::Constant);
        pool
    }

    /// Number of nodes.
    #[must_use]
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Never: 0 and 1 are always there.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// How the value of a node comes about.
    #[must_use]
    pub fn operation(&self, expression: Expression) -> &Operation {
        &self.nodes[expression.node()].operation
    }

    /// How the values of all nodes come about, operands before what uses them.
    pub fn operations(&self) -> impl Iterator<Item = &Operation> {
        self.nodes.iter().map(|node| &node.operation)
    }

    /// All nodes, operands before what uses them.
    pub fn nodes(&self) -> impl Iterator<Item = Expression> + use<> {
        (0..self.nodes.len()).map(|node| Expression::new(node, false))
    }

    /// Makes a sum or product one of two other parts with the same value, if it can be written so.
    pub fn reform(&mut self, expression: Expression, a: Expression, b: Expression) -> bool {
        let operation = match self.operation(expression) {
            Operation::Add(..) if !a.is_negative() => Operation::Add(a, b),
            Operation::Add(..) if !b.is_negative() => Operation::Add(b, a),
            Operation::Multiply(..) if !a.is_negative() && !b.is_negative() => {
                Operation::Multiply(a, b)
            }
            _ => return false,
        };
        self.nodes[expression.node()].operation = operation;
        true
    }

    /// How often it changes.
    #[must_use]
    pub fn rate(&self, expression: Expression) -> Rate {
        self.nodes[expression.node()].rate
    }

    /// Its values at the points.
    #[must_use]
    pub fn image(&self, expression: Expression) -> Image {
        let image = self.nodes[expression.node()].image;
        if expression.is_negative() {
            image.negated()
        } else {
            image
        }
    }

    /// Its value, if it is a constant.
    #[must_use]
    pub fn constant_value(&self, expression: Expression) -> Option<f64> {
        match self.operation(expression) {
            Operation::Constant(value) => Some(if expression.is_negative() {
                -value
            } else {
                *value
            }),
            _ => None,
        }
    }

    /// The symbol, if it is one and not negated.
    #[must_use]
    pub fn symbol_of(&self, expression: Expression) -> Option<Symbol> {
        match self.operation(expression) {
            Operation::Symbol(symbol) if !expression.is_negative() => Some(*symbol),
            _ => None,
        }
    }

    fn insert(&mut self, operation: Operation, image: Image, rate: Rate) -> Expression {
        let node = self.nodes.len();
        self.nodes.push(Node {
            operation,
            image,
            rate,
        });
        self.found.insert(image, node as u32);
        Expression::new(node, false)
    }

    /// The expression with this image, if there is one.
    #[must_use]
    pub fn find(&self, image: Image) -> Option<Expression> {
        if let Some(node) = self.found.get(&image) {
            return Some(Expression::new(*node as usize, false));
        }
        self.found
            .get(&image.negated())
            .map(|node| Expression::new(*node as usize, true))
    }

    /// The node with this image, or a new one.
    fn intern(&mut self, operation: Operation, image: Image) -> Expression {
        if let Some(expression) = self.find(image) {
            return expression;
        }
        let rate = operation
            .operands()
            .iter()
            .map(|operand| self.rate(*operand))
            .max();
        self.insert(operation, image, rate.unwrap_or(Rate::Constant))
    }

    /// A constant with its exact image.
    pub fn constant(&mut self, value: f64, image: Image) -> Expression {
        if value < 0.0 {
            return self.constant(-value, image.negated()).negated();
        }
        self.intern(Operation::Constant(value), image)
    }

    /// An integer.
    pub fn integer(&mut self, value: i64) -> Expression {
        self.constant(value as f64, Image::integer(value))
    }

    /// A decimal literal as written in Rust, such as `1e-5` or `10_000.0`; none if it is not finite or no number.
    pub fn literal(&mut self, text: &str) -> Option<Expression> {
        let text: String = text.chars().filter(|character| *character != '_').collect();
        let value: f64 = text.parse().ok()?;
        if !value.is_finite() || text.starts_with(|first: char| !first.is_ascii_digit()) {
            return None;
        }
        let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((&text, "0"));
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let exponent: i64 = exponent.parse().ok()?;
        let image = Image::decimal(
            &format!("{whole}{fraction}"),
            exponent - fraction.len() as i64,
        );
        Some(self.constant(value, image))
    }

    /// A number that has no exact decimal, such as a node of a quadrature: an independent unknown of its bits.
    pub fn irrational(&mut self, value: f64) -> Expression {
        let image = Image::unknown(&[0x1_22a7, value.abs().to_bits()]);
        self.constant(value, if value < 0.0 { image.negated() } else { image })
    }

    /// A variable.
    pub fn symbol(&mut self, symbol: Symbol) -> Expression {
        let (kind, index, rate) = match symbol {
            Symbol::Parameter(index) => (1, index, Rate::Parameter),
            Symbol::State(index) => (2, index, Rate::Varying),
            Symbol::Input(index) => (3, index, Rate::Varying),
            Symbol::Time => (4, 0, Rate::Varying),
            Symbol::Signal(index) => (5, index, Rate::Varying),
            Symbol::Unknown(index) => (6, index, Rate::Varying),
        };
        let image = Image::unknown(&[kind, index as u64]);
        self.find(image)
            .unwrap_or_else(|| self.insert(Operation::Symbol(symbol), image, rate))
    }

    /// Says which equations give unknowns. They may hold unknowns that were defined before.
    pub fn define(&mut self, implicit: Implicit) {
        self.implicit.push(implicit);
    }

    /// A number that no unknown has yet.
    pub fn fresh_unknown(&mut self) -> usize {
        self.fresh += 1;
        FRESH + self.fresh
    }

    /// Forgets all definitions.
    pub fn forget(&mut self) {
        self.implicit.clear();
    }

    /// What is given by equations, in order of definition.
    #[must_use]
    pub fn implicit(&self) -> &[Implicit] {
        &self.implicit
    }

    /// Where a symbol is defined, if it is an unknown that equations give.
    #[must_use]
    pub fn place(&self, symbol: Symbol) -> Option<Place> {
        let Symbol::Unknown(unknown) = symbol else {
            return None;
        };
        let position = |(number, implicit): (usize, &Implicit)| {
            let row = implicit.unknowns.iter().position(|own| *own == unknown)?;
            Some(Place { number, row })
        };
        self.implicit.iter().enumerate().find_map(position)
    }

    /// What the value of a node depends on: its operands, and for an unknown the equations that give it.
    #[must_use]
    pub fn causes(&self, expression: Expression) -> Vec<Expression> {
        match self.operation(expression) {
            Operation::Symbol(symbol) => match self.place(*symbol) {
                Some(place) => self.implicit[place.number].residuals.clone(),
                None => Vec::new(),
            },
            operation => operation.operands(),
        }
    }

    /// Sum.
    pub fn add(&mut self, a: Expression, b: Expression) -> Expression {
        if a == Expression::ZERO {
            return b;
        }
        if b == Expression::ZERO {
            return a;
        }
        let image = self.image(a).plus(self.image(b));
        if let Some(expression) = self.find(image) {
            return expression;
        }
        if let (Some(x), Some(y)) = (self.constant_value(a), self.constant_value(b)) {
            return self.constant(x + y, image);
        }
        if let Some(collected) = self.collect(a, b) {
            return collected;
        }
        if let Some(gathered) = self.gather(a, b) {
            return gathered;
        }
        self.put_sum(a, b)
    }

    /// The sum in this form, if there is none in another.
    fn put_sum(&mut self, a: Expression, b: Expression) -> Expression {
        if a == Expression::ZERO {
            return b;
        }
        if b == Expression::ZERO {
            return a;
        }
        let image = self.image(a).plus(self.image(b));
        match (a.is_negative(), b.is_negative()) {
            (true, true) => self
                .intern(Operation::Add(a.negated(), b.negated()), image.negated())
                .negated(),
            (true, false) => self.intern(Operation::Add(b, a), image),
            _ => self.intern(Operation::Add(a, b), image),
        }
    }

    /// Terms that change seldom are gathered and added last: `(x + a) + (y + b)` is `(x + y) + (a + b)`.
    fn gather(&mut self, a: Expression, b: Expression) -> Option<Expression> {
        let (first, slow) = self.apart(a);
        let (second, other) = self.apart(b);
        let is_mixed = |fast, slow| fast != Expression::ZERO && slow != Expression::ZERO;
        if !is_mixed(first, slow) && !is_mixed(second, other) {
            return None;
        }
        let fast = self.add(first, second);
        let slow = self.add(slow, other);
        // Put down as it is: what is known under another form need not come apart again.
        Some(self.put_sum(fast, slow))
    }

    /// A sum as what changes often and what changes seldom.
    fn apart(&self, sum: Expression) -> (Expression, Expression) {
        if self.rate(sum) != Rate::Varying {
            return (Expression::ZERO, sum);
        }
        if let Operation::Add(first, second) = *self.operation(sum) {
            let [first, second] = [first, second].map(|term| term.flipped(sum.is_negative()));
            match (self.rate(first), self.rate(second)) {
                (Rate::Varying, Rate::Varying) => {}
                (Rate::Varying, _) => return (first, second),
                _ => return (second, first),
            }
        }
        (sum, Expression::ZERO)
    }

    /// The sum with a common factor taken out, where what remains in the brackets is known already or is computed once
    /// when a model is built: that is how `m cos² + m sin²` becomes `m`, and `a x y − b x y` becomes `(a − b) x y`.
    fn collect(&mut self, a: Expression, b: Expression) -> Option<Expression> {
        let left = self.factors(a);
        let mut right = self.factors(b);
        let mut common = Vec::new();
        let mut rest = Vec::new();
        for factor in left {
            match right.iter().position(|other| *other == factor) {
                Some(position) => common.push(right.swap_remove(position)),
                None => rest.push(factor),
            }
        }
        if common.is_empty() {
            return None;
        }
        let product = |pool: &Self, factors: &[Expression], negative: bool| {
            let start = if negative {
                Image::ONE.negated()
            } else {
                Image::ONE
            };
            factors
                .iter()
                .fold(start, |image, factor| image.times(pool.image(*factor)))
        };
        let image = product(self, &rest, a.is_negative());
        let image = image.plus(product(self, &right, b.is_negative()));
        let varies = |factor: &Expression| self.rate(*factor) == Rate::Varying;
        let whole = match self.find(image) {
            Some(whole) => whole,
            None if rest.iter().chain(&right).any(varies) => return None,
            None => {
                let multiply = |pool: &mut Self, factors: Vec<Expression>, negative: bool| {
                    let start = Expression::ONE.flipped(negative);
                    factors
                        .into_iter()
                        .fold(start, |product, factor| pool.multiply(product, factor))
                };
                let left = multiply(self, rest, a.is_negative());
                let right = multiply(self, right, b.is_negative());
                self.add(left, right)
            }
        };
        // A product with one of them that is there is not made again.
        let is_known = |factor: &Expression| {
            let image = self.image(whole).times(self.image(*factor));
            self.find(image).is_some()
        };
        let known = common.iter().position(is_known);
        let first = known.map(|position| common.swap_remove(position));
        let whole = first.map_or(whole, |first| self.multiply(whole, first));
        let common = common.into_iter().fold(Expression::ONE, |product, factor| {
            self.multiply(product, factor)
        });
        Some(self.multiply(whole, common))
    }

    /// Factors of a product, without their signs.
    fn factors(&self, product: Expression) -> Vec<Expression> {
        let mut factors = Vec::new();
        let mut pending = vec![product.magnitude()];
        while let Some(current) = pending.pop() {
            match self.operation(current) {
                Operation::Multiply(a, b) if factors.len() + pending.len() < 16 => {
                    pending.extend([*a, *b]);
                }
                _ => factors.push(current),
            }
        }
        factors
    }

    /// Difference.
    pub fn subtract(&mut self, a: Expression, b: Expression) -> Expression {
        self.add(a, b.negated())
    }

    /// Sum of several, from the left.
    pub fn sum(&mut self, terms: &[Expression]) -> Expression {
        terms
            .iter()
            .fold(Expression::ZERO, |sum, term| self.add(sum, *term))
    }

    /// Product. Factors that change seldom are gathered: `a (b x)` is `(a b) x`, and `(a x) y` is `a (x y)` if `x y` is
    /// there.
    pub fn multiply(&mut self, a: Expression, b: Expression) -> Expression {
        let negative = a.is_negative() != b.is_negative();
        let (a, b) = (a.magnitude(), b.magnitude());
        self.multiply_magnitudes(a, b).flipped(negative)
    }

    fn multiply_magnitudes(&mut self, a: Expression, b: Expression) -> Expression {
        if a == Expression::ZERO || b == Expression::ZERO {
            return Expression::ZERO;
        }
        if a == Expression::ONE {
            return b;
        }
        if b == Expression::ONE {
            return a;
        }
        let image = self.image(a).times(self.image(b));
        if let Some(expression) = self.find(image) {
            return expression;
        }
        if let (Some(x), Some(y)) = (self.constant_value(a), self.constant_value(b)) {
            return self.constant(x * y, image);
        }
        let (slow, fast) = if self.rate(a) <= self.rate(b) {
            (a, b)
        } else {
            (b, a)
        };
        let (inner, first) = self.scaled(slow);
        let (outer, second) = self.scaled(fast);
        let is_mixed = |slow, fast| slow != Expression::ONE && fast != Expression::ONE;
        let product = match first {
            Expression::ONE => is_mixed(outer, second).then_some(second),
            _ if !is_mixed(inner, first) && !is_mixed(outer, second) => None,
            _ => self.find(self.image(first).times(self.image(second))),
        };
        if let Some(product) = product {
            let gathered = self.multiply(inner, outer);
            return self.multiply(gathered, product);
        }
        self.intern(Operation::Multiply(slow, fast), image)
    }

    /// A product as the factors that change seldom, and those that change often.
    fn scaled(&self, product: Expression) -> (Expression, Expression) {
        if self.rate(product) != Rate::Varying {
            return (product, Expression::ONE);
        }
        match *self.operation(product) {
            Operation::Multiply(slow, fast) if self.rate(slow) != Rate::Varying => (slow, fast),
            _ => (Expression::ONE, product),
        }
    }

    /// Quotient; none if the divisor is identically zero.
    #[must_use]
    pub fn divide(&mut self, a: Expression, b: Expression) -> Option<Expression> {
        let negative = a.is_negative() != b.is_negative();
        let (a, b) = (a.magnitude(), b.magnitude());
        let inverse = self.image(b).inverted()?;
        let image = self.image(a).times(inverse);
        if let Some(expression) = self.find(image) {
            return Some(expression.flipped(negative));
        }
        if let (Some(x), Some(y)) = (self.constant_value(a), self.constant_value(b)) {
            return Some(self.constant(x / y, image).flipped(negative));
        }
        let quotient = if self.rate(b) < self.rate(a) {
            let reciprocal = self.divide(Expression::ONE, b)?;
            self.multiply(reciprocal, a)
        } else {
            self.intern(Operation::Divide(a, b), image)
        };
        Some(quotient.flipped(negative))
    }

    /// Integer power by repeated squaring; none for a negative power of zero.
    #[must_use]
    pub fn power(&mut self, base: Expression, exponent: i32) -> Option<Expression> {
        let mut result = Expression::ONE;
        let mut square = base;
        let mut rest = exponent.unsigned_abs();
        while rest > 0 {
            if rest & 1 == 1 {
                result = self.multiply(result, square);
            }
            rest >>= 1;
            if rest > 0 {
                square = self.multiply(square, square);
            }
        }
        if exponent < 0 {
            self.divide(Expression::ONE, result)
        } else {
            Some(result)
        }
    }

    /// Sine.
    pub fn sine(&mut self, angle: Expression) -> Expression {
        if angle == Expression::ZERO {
            return angle;
        }
        let magnitude = angle.magnitude();
        let (_, image) = self.circle(magnitude);
        self.trigonometric(Operation::Sine(magnitude), image, magnitude, f64::sin)
            .flipped(angle.is_negative())
    }

    /// Cosine.
    pub fn cosine(&mut self, angle: Expression) -> Expression {
        if angle == Expression::ZERO {
            return Expression::ONE;
        }
        let magnitude = angle.magnitude();
        let (image, _) = self.circle(magnitude);
        self.trigonometric(Operation::Cosine(magnitude), image, magnitude, f64::cos)
    }

    fn trigonometric(
        &mut self,
        operation: Operation,
        image: Image,
        angle: Expression,
        function: fn(f64) -> f64,
    ) -> Expression {
        match self.constant_value(angle) {
            Some(value) => self.constant(function(value), image),
            None => self.intern(operation, image),
        }
    }

    /// Images of cosine and sine: the angle is taken apart into integer multiples of base angles, each of which is a
    /// random point of the circle, and put together by the addition formulas.
    fn circle(&self, angle: Expression) -> (Image, Image) {
        let mut parts = Vec::new();
        self.angle_parts(angle, 1, &mut parts);
        let mut whole = (Image::ONE, Image::ZERO);
        for (base, multiple) in parts {
            let (cosine, sine) = Image::circle(self.image(base));
            let sine = if multiple < 0 { sine.negated() } else { sine };
            for _ in 0..multiple.unsigned_abs() {
                whole = (
                    whole.0.times(cosine).minus(whole.1.times(sine)),
                    whole.1.times(cosine).plus(whole.0.times(sine)),
                );
            }
        }
        whole
    }

    fn angle_parts(&self, angle: Expression, multiple: i64, parts: &mut Vec<(Expression, i64)>) {
        let multiple = if angle.is_negative() {
            -multiple
        } else {
            multiple
        };
        let base = angle.magnitude();
        match *self.operation(base) {
            Operation::Add(a, b) => {
                self.angle_parts(a, multiple, parts);
                self.angle_parts(b, multiple, parts);
            }
            Operation::Multiply(a, b) => match self.constant_value(a) {
                Some(factor) if factor.fract() == 0.0 && factor <= 64.0 => {
                    self.angle_parts(b, multiple * factor as i64, parts);
                }
                _ => parts.push((base, multiple)),
            },
            _ => parts.push((base, multiple)),
        }
    }

    /// Any other function.
    pub fn call(&mut self, function: Function, arguments: &[Expression]) -> Expression {
        let values: Option<Vec<f64>> = arguments
            .iter()
            .map(|argument| self.constant_value(*argument))
            .collect();
        let images: Vec<Image> = arguments
            .iter()
            .map(|argument| self.image(*argument))
            .collect();
        let image = self.function_image(function, arguments, &images);
        match values.map(|values| function.evaluate(&values)) {
            Some(value) if value.is_finite() => self.folded_call(value, image),
            _ => self.intern(Operation::Call(function, arguments.to_vec()), image),
        }
    }

    fn folded_call(&mut self, value: f64, image: Image) -> Expression {
        if value.fract() == 0.0 && value.abs() < 1e15 {
            return self.integer(value as i64);
        }
        self.constant(value, image)
    }

    fn function_image(
        &self,
        function: Function,
        arguments: &[Expression],
        images: &[Image],
    ) -> Image {
        if function == Function::Tan {
            let angle = arguments[0];
            let (cosine, sine) = self.circle(angle.magnitude());
            if let Some(inverse) = cosine.inverted() {
                let tangent = sine.times(inverse);
                return if angle.is_negative() {
                    tangent.negated()
                } else {
                    tangent
                };
            }
        }
        Image::opaque(function as u64, images)
    }
}
