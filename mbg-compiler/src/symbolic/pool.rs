//! The pool of expressions: a graph in which equal functions are one node.
//!
//! A node is found again by its image (see [`super::field`]), not by its form, so `sin² + cos²` *is* 1, a product of
//! a rotation with its inverse *is* the vector it began with, and a gyroscopic torque of an isotropic inertia *is*
//! zero. The first form in which a function was built is the one that is kept, unless a later one changes less often: a
//! length that only seems to vary. Negation is a bit of the handle and costs nothing.

use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;
use std::rc::Rc;

use rustc_hash::{FxBuildHasher, FxHashMap};

use super::expression::{Expression, Function, Operation, Rate, Symbol};
use super::field::Image;
use super::implicit::{Implicit, Place};
use super::linear::Linear;
use crate::operands::Operands;

#[derive(Clone)]
struct Node {
    operation: Operation,
    image: Image,
    rate: Rate,
}

/// Cosine and sine of a number that is as near to right angles as its digits allow. They are exact: a rounding error in the
/// place of a zero would be divided by.
fn right_angle(angle: f64) -> Option<(Image, Image)> {
    let quadrants = (angle / FRAC_PI_2).round();
    let is_near = (angle - quadrants * FRAC_PI_2).abs() <= 2.0 * f64::EPSILON * angle.abs();
    let image = |value: f64| Image::integer(value.round() as i64);
    (is_near && angle.abs() < 100.0).then(|| (image(angle.cos()), image(angle.sin())))
}

/// Unknowns that are none of the graph are numbered from here.
const FRESH: usize = 1 << 31;

/// Equations that give something.
#[derive(Clone)]
pub(super) enum Definition {
    /// Unknowns for which symbols stand, by number.
    Implicit(usize),
    /// Unknowns that are expressions.
    Linear(Rc<Linear>),
}

/// All expressions of a model.
#[derive(Clone)]
pub struct Pool {
    nodes: Vec<Node>,
    /// Looked up, never iterated.
    found: FxHashMap<Image, Expression>,
    implicit: Vec<Implicit>,
    /// Images of states that depend on each other, such as the parts of a quaternion.
    located: BTreeMap<usize, Image>,
    /// What equations give, in order.
    definitions: Vec<Definition>,
    /// Where each unknown is defined.
    places: BTreeMap<usize, Place>,
    /// How many unknowns were made up.
    fresh: usize,
}

/// More nodes than most models have: to find room for more of them takes long in unoptimised code.
const USUAL: usize = 8192;

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
            found: FxHashMap::with_capacity_and_hasher(USUAL, FxBuildHasher),
            implicit: Vec::new(),
            located: BTreeMap::new(),
            definitions: Vec::new(),
            places: BTreeMap::new(),
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

    /// How the values of all nodes come about, operands before what uses them unless they are constants.
    pub fn operations(&self) -> impl Iterator<Item = &Operation> {
        self.nodes.iter().map(|node| &node.operation)
    }

    /// All nodes, operands before what uses them.
    pub fn nodes(&self) -> impl Iterator<Item = Expression> + use<> {
        (0..self.nodes.len()).map(|node| Expression::new(node, false))
    }

    /// Gives a node another form with the same value.
    pub(super) fn reform(&mut self, expression: Expression, operation: Operation) {
        self.nodes[expression.node()].operation = operation;
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

    fn insert(&mut self, operation: Operation, image: Image, rate: Rate) -> Expression {
        let node = self.nodes.len();
        self.nodes.push(Node {
            operation,
            image,
            rate,
        });
        let (unsigned, is_negative) = image.unsigned();
        self.found
            .insert(unsigned, Expression::new(node, is_negative));
        Expression::new(node, false)
    }

    /// The expression with this image, if there is one.
    #[must_use]
    pub fn find(&self, image: Image) -> Option<Expression> {
        let (unsigned, is_negative) = image.unsigned();
        let found = self.found.get(&unsigned)?;
        Some(found.flipped(is_negative))
    }

    /// The expression with this image, if there is one that changes no more often than any of these.
    pub(super) fn known(&self, image: Image, operands: &[Expression]) -> Option<Expression> {
        let expression = self.find(image)?;
        (self.rate(expression) <= self.rate_of(operands)).then_some(expression)
    }

    /// How often anything made of these changes.
    fn rate_of(&self, operands: &[Expression]) -> Rate {
        let rates = operands.iter().map(|operand| self.rate(*operand));
        rates.max().unwrap_or(Rate::Constant)
    }

    /// The node with this image, or a new one where there is none that changes as seldom.
    pub(super) fn intern(&mut self, operation: Operation, image: Image) -> Expression {
        let operands = operation.operands();
        if let Some(expression) = self.known(image, &operands) {
            return expression;
        }
        let rate = self.rate_of(&operands);
        self.insert(operation, image, rate)
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

    /// Says where a state lies, before it is used: what holds between states at their places holds everywhere.
    pub fn locate(&mut self, state: usize, image: Image) {
        self.located.insert(state, image);
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
            Symbol::Slope(index) => (7, index, Rate::Varying),
        };
        let image = match symbol {
            Symbol::State(state) => self.located.get(&state).copied(),
            _ => None,
        };
        let image = image.unwrap_or_else(|| Image::unknown(&[kind, index as u64]));
        self.find(image)
            .unwrap_or_else(|| self.insert(Operation::Symbol(symbol), image, rate))
    }

    /// Says which equations give unknowns. They may hold unknowns that were defined before.
    pub fn define(&mut self, implicit: Implicit) {
        let number = self.implicit.len();
        for (row, unknown) in implicit.unknowns.iter().enumerate() {
            self.places.insert(*unknown, Place { number, row });
        }
        self.definitions.push(Definition::Implicit(number));
        self.implicit.push(implicit);
    }

    /// Remembers equations with their solution.
    pub fn solved(&mut self, linear: Linear) {
        self.definitions.push(Definition::Linear(Rc::new(linear)));
    }

    /// What equations give, in order.
    pub(super) fn definitions(&self) -> &[Definition] {
        &self.definitions
    }

    /// A number that no unknown has yet.
    pub fn fresh_unknown(&mut self) -> usize {
        self.fresh += 1;
        FRESH + self.fresh
    }

    /// Forgets all definitions.
    pub fn forget(&mut self) {
        self.implicit.clear();
        self.definitions.clear();
        self.places.clear();
    }

    /// What is given by equations, in order of definition.
    #[must_use]
    pub fn implicit(&self) -> &[Implicit] {
        &self.implicit
    }

    /// Where a symbol is defined, if it is an unknown that equations give.
    #[must_use]
    pub fn place(&self, symbol: Symbol) -> Option<Place> {
        match symbol {
            Symbol::Unknown(unknown) => self.places.get(&unknown).copied(),
            _ => None,
        }
    }

    /// What the value of a node depends on: its operands, and for an unknown the equations that give it.
    #[must_use]
    pub fn causes(&self, expression: Expression) -> Operands<'_, Expression> {
        match self.operation(expression) {
            Operation::Symbol(symbol) => match self.place(*symbol) {
                Some(place) => Operands::Many(self.evaluated(place.number).into()),
                None => Operands::Zero,
            },
            operation => operation.operands(),
        }
    }

    /// What a definition evaluates, with what the one evaluates whose matrix it uses.
    fn evaluated(&self, number: usize) -> Vec<Expression> {
        let implicit = &self.implicit[number];
        let earlier = implicit.earlier().map(|of| self.implicit[of].evaluated());
        [implicit.evaluated(), earlier.unwrap_or_default()].concat()
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
            // Of right angles these are found by their images.
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
            let right = self.constant_value(base).and_then(right_angle);
            let (cosine, sine) = right.unwrap_or_else(|| Image::circle(self.image(base)));
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
        if function == Function::Exp
            && let Some(product) = self.without_logarithms(arguments[0])
        {
            return product;
        }
        if let (Function::SelectLess, &[_, _, yes, no]) = (function, arguments)
            && yes == no
        {
            return yes;
        }
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
