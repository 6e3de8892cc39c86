//! Sums and products that are one product of what is computed anyway.
//!
//! Derivatives come out term by term, and what they come to is often shorter: with `sin² + cos² = 1` the sum
//! `c x + s (s x / c)` is `x / c`, and since what dissipates is symmetric, entries of a Jacobian on both sides of its
//! diagonal are multiples of each other. No rule of algebra is needed to see it, only values at random points (see
//! [`super::field`]): `e` is a product with the factor `a` where `e / a` is the value of something that is there.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use super::expression::{Expression, Operation, Rate};
use super::field::{self, Image};
use super::pool::Pool;
use super::uses::Uses;

/// Largest numerator and denominator of a number that is told by its image.
const LARGEST: u64 = 10_000;

/// How many ends of values are told apart, for each value: so many that few others end as one of them does.
const ENDS: usize = 16;

/// Makes products of what only the roots need, where that saves operations; what the `others` need stays as it is.
pub fn products(pool: &mut Pool, others: &[Expression], roots: &[Expression]) {
    let kept = Uses::of(pool, others);
    let mut uses = Uses::of(pool, &[others, roots].concat());
    let Some(known) = Known::of(pool, &uses) else {
        return;
    };
    for node in known.nodes.iter().rev() {
        if kept.count(*node) == 0 && is_long(pool, &uses, *node) {
            shorten(pool, &mut uses, &known, *node);
        }
    }
}

/// Whether it is a sum, product or quotient with a part that nothing else needs.
fn is_long(pool: &Pool, uses: &Uses, node: Expression) -> bool {
    let operation = pool.operation(node);
    let is_own =
        |part: &Expression| uses.count(*part) == 1 && !pool.operation(*part).operands().is_empty();
    matches!(
        operation,
        Operation::Add(..) | Operation::Multiply(..) | Operation::Divide(..)
    ) && uses.count(node) > 0
        && operation.operands().iter().any(is_own)
}

/// Takes the shortest form of a node.
fn shorten(pool: &mut Pool, uses: &mut Uses, known: &Known, node: Expression) {
    let mut best = (0, None);
    for form in known.forms(pool, uses, node) {
        let saved = exchange(pool, uses, node, &form);
        let old = pool.operation(node).clone();
        if saved > best.0 {
            best = (saved, Some(form.clone()));
        }
        pool.reform(node, form);
        exchange(pool, uses, node, &old);
        pool.reform(node, old);
    }
    if let (_, Some(form)) = best {
        exchange(pool, uses, node, &form);
        pool.reform(node, form);
    }
}

/// Counts a node's parts as those of another form; gives how many nodes that saves.
fn exchange(pool: &Pool, uses: &mut Uses, node: Expression, form: &Operation) -> usize {
    let (new, old) = (form.operands(), pool.operation(node).operands());
    let added: usize = new.iter().map(|part| uses.add(pool, *part)).sum();
    let removed: usize = old.iter().map(|part| uses.remove(pool, *part)).sum();
    removed.saturating_sub(added)
}

/// What is computed anyway.
struct Known {
    /// All that varies, operands before what uses them.
    nodes: Vec<Expression>,
    /// Reciprocals of the nodes' values at the first point.
    reciprocals: Vec<u64>,
    /// Nodes and their negatives by the value at the first point.
    values: FxHashMap<u64, Expression>,
    /// Which last bits the values end with: most others are told from them by these alone.
    ends: Vec<bool>,
    /// Nodes by the ratio of the values at two points, in which multiples of each other agree.
    multiples: FxHashMap<u64, Vec<Expression>>,
    /// Divisors with a bit each.
    divisors: BTreeMap<Expression, u128>,
    /// The divisors and unknowns that each node depends on.
    depends: Vec<u128>,
}

impl Known {
    /// Of what is needed; none where there are too many divisors.
    fn of(pool: &Pool, uses: &Uses) -> Option<Self> {
        let is_zero = |node: &Expression| pool.image(*node).0[0] == 0;
        let nodes = pool.nodes().filter(|node| uses.count(*node) > 0);
        let nodes = nodes.filter(|node| pool.rate(*node) == Rate::Varying && !is_zero(node));
        let nodes: Vec<Expression> = nodes.collect();
        let (divisors, depends) = divisors(pool, &nodes)?;
        let firsts: Vec<u64> = nodes.iter().map(|node| pool.image(*node).0[0]).collect();
        let reciprocals = field::reciprocals(&firsts);
        let mut values = FxHashMap::default();
        let mut ends = vec![false; (2 * ENDS * nodes.len()).next_power_of_two()];
        let last = ends.len() - 1;
        let mut multiples: FxHashMap<u64, Vec<Expression>> = FxHashMap::default();
        for (node, reciprocal) in nodes.iter().zip(&reciprocals) {
            let [first, second, _] = pool.image(*node).0;
            for (value, node) in [(first, *node), (field::negate(first), node.negated())] {
                values.entry(value).or_insert(node);
                ends[value as usize & last] = true;
            }
            let ratio = field::multiply(second, *reciprocal);
            multiples.entry(ratio).or_default().push(*node);
        }
        Some(Self {
            nodes,
            reciprocals,
            values,
            ends,
            multiples,
            divisors,
            depends,
        })
    }

    /// Other forms of a node, of what is there before it. No divisor comes to it that it does not depend on as it is, and
    /// no unknown either: the equations that give one may need the node.
    fn forms(&self, pool: &mut Pool, uses: &Uses, node: Expression) -> Vec<Operation> {
        let depends = self.depends[node.node()];
        let is_there = |it: Expression| {
            let is_new = self.depends[it.node()] & !depends != 0;
            it.node() < node.node() && uses.count(it) > 0 && !is_new
        };
        let mut forms = Vec::new();
        let image = pool.image(node);
        let last = self.ends.len() - 1;
        for (factor, reciprocal) in self.nodes.iter().zip(&self.reciprocals) {
            if factor.node() >= node.node() {
                break;
            }
            let other = field::multiply(image.0[0], *reciprocal);
            if !self.ends[other as usize & last] {
                continue;
            }
            let other = self.values.get(&other);
            let Some(other) = other.filter(|it| is_there(**it) && is_there(*factor)) else {
                continue;
            };
            if pool.image(*factor).times(pool.image(*other)) == image {
                forms.push(Operation::Multiply(*factor, *other));
            }
        }
        for (divisor, bit) in &self.divisors {
            let dividend = image.times(pool.image(*divisor));
            let other = self.values.get(&dividend.0[0]);
            let Some(other) = other.filter(|it| is_there(**it) && bit & !depends == 0) else {
                continue;
            };
            if pool.image(*other) == dividend && uses.count(*divisor) > 0 {
                forms.push(Operation::Divide(*other, *divisor));
            }
        }
        let other = self.multiple(pool, image, &is_there);
        forms.extend(other.map(|(factor, other)| Operation::Multiply(factor, other)));
        forms
    }

    /// A number and what is there, of which a value is the product.
    fn multiple(
        &self,
        pool: &mut Pool,
        image: Image,
        is_there: &dyn Fn(Expression) -> bool,
    ) -> Option<(Expression, Expression)> {
        let [first, second, _] = image.0;
        let ratio = field::multiply(second, field::invert(first)?);
        let others = self.multiples.get(&ratio)?.iter();
        let other = others.copied().find(|it| is_there(*it))?;
        let ratio = image.times(pool.image(other).inverted()?);
        number(pool, ratio).map(|number| (number, other))
    }
}

/// The fraction of small numbers that has this image.
pub(super) fn number(pool: &mut Pool, image: Image) -> Option<Expression> {
    let (numerator, denominator) = field::fraction(image.0[0], LARGEST)?;
    let fraction = Image::integer(denominator).inverted()?;
    if fraction.times(Image::integer(numerator)) != image {
        return None;
    }
    Some(pool.constant(numerator as f64 / denominator as f64, image))
}

/// Divisors with a bit each, and the bits of what each node of the pool depends on: divisors, and unknowns that equations
/// give. None if there are more than bits.
fn divisors(pool: &Pool, nodes: &[Expression]) -> Option<(BTreeMap<Expression, u128>, Vec<u128>)> {
    let mut divisors = BTreeMap::new();
    let mut depends = vec![0; pool.len()];
    let mut free = (0..u128::BITS).map(|place| 1 << place);
    for node in nodes {
        let mut bits = 0;
        for &part in pool.causes(*node).iter() {
            bits |= depends[part.node()];
        }
        bits |= match *pool.operation(*node) {
            Operation::Divide(_, divisor) => match divisors.get(&divisor.magnitude()) {
                Some(bit) => *bit,
                None => {
                    let bit = free.next()?;
                    divisors.insert(divisor.magnitude(), bit);
                    bit
                }
            },
            Operation::Symbol(symbol) if pool.place(symbol).is_some() => free.next()?,
            _ => 0,
        };
        depends[node.node()] = bits;
    }
    Some((divisors, depends))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::symbolic::Symbol;

    fn states<const N: usize>(pool: &mut Pool) -> [Expression; N] {
        std::array::from_fn(|number| pool.symbol(Symbol::State(number)))
    }

    #[test]
    fn the_sum_of_the_squares_of_sine_and_cosine_is_seen() {
        let mut pool = Pool::new();
        let [x, angle] = states(&mut pool);
        let (sine, cosine) = (pool.sine(angle), pool.cosine(angle));
        let along = pool.multiply(sine, x);
        let along = pool.divide(along, cosine).unwrap();
        let (first, second) = (pool.multiply(cosine, x), pool.multiply(sine, along));
        let sum = pool.add(first, second);
        products(&mut pool, &[], &[along, sum]);
        assert_eq!(*pool.operation(sum), Operation::Divide(x, cosine));
    }

    #[test]
    fn the_quotient_of_a_factor_that_is_there_is_a_factor() {
        let mut pool = Pool::new();
        let [x, y, z] = states(&mut pool);
        let quotient = pool.divide(x, z).unwrap();
        let product = pool.multiply(x, y);
        let whole = pool.divide(product, z).unwrap();
        products(&mut pool, &[], &[quotient, whole]);
        assert_eq!(*pool.operation(whole), Operation::Multiply(y, quotient));
    }

    #[test]
    fn what_is_a_multiple_of_another_is_made_of_it() {
        let mut pool = Pool::new();
        let [x, y] = states(&mut pool);
        let scaled = |pool: &mut Pool, number: i64, a, b| {
            let number = pool.integer(number);
            let product = pool.multiply(a, b);
            pool.multiply(number, product)
        };
        // (x + y) (2 x - 3 y), and ten times that term by term.
        let (two, three) = (pool.integer(2), pool.integer(3));
        let (sum, twice) = (pool.add(x, y), pool.multiply(two, x));
        let thrice = pool.multiply(three, y);
        let difference = pool.subtract(twice, thrice);
        let short = pool.multiply(sum, difference);
        let terms = [(20, x, x), (-10, x, y), (-30, y, y)];
        let terms = terms.map(|(number, a, b)| scaled(&mut pool, number, a, b));
        let long = pool.sum(&terms);
        products(&mut pool, &[], &[short, long]);
        let ten = pool.integer(10);
        assert_eq!(*pool.operation(long), Operation::Multiply(ten, short));
    }

    #[test]
    fn what_always_has_one_value_hides_no_number() {
        let mut pool = Pool::new();
        let [x, y] = states(&mut pool);
        let (sum, difference) = (pool.add(x, y), pool.subtract(x, y));
        let short = pool.multiply(sum, difference);
        let seven = pool.integer(7);
        let sines = [x, y].map(|angle| pool.sine(angle));
        let long = {
            // A seventh of the product, by a detour.
            let terms = [(x, sines[0]), (y, sines[1])].map(|(side, sine)| {
                let product = pool.multiply(side, sine);
                let squares = pool.multiply(side, product);
                let scaled = pool.multiply(seven, sine);
                pool.divide(squares, scaled).unwrap()
            });
            pool.subtract(terms[0], terms[1])
        };
        let seven_x = pool.multiply(seven, x);
        let seventh = pool.divide(x, seven_x).unwrap();
        assert_eq!(pool.constant_value(seventh), None);
        products(&mut pool, &[], &[short, long, seventh]);
        let Operation::Multiply(number, other) = *pool.operation(long) else {
            panic!("a product of a number");
        };
        assert_eq!(pool.constant_value(number), Some(1.0 / 7.0));
        assert_eq!(other, short);
    }

    #[test]
    fn what_others_need_stays() {
        let mut pool = Pool::new();
        let [x] = states(&mut pool);
        let (sine, cosine) = (pool.sine(x), pool.cosine(x));
        let rest = pool.multiply(cosine, cosine);
        let rest = pool.subtract(Expression::ONE, rest);
        let form = pool.operation(rest).clone();
        products(&mut pool, &[rest], &[rest, sine]);
        assert_eq!(*pool.operation(rest), form);
        products(&mut pool, &[], &[rest, sine]);
        assert_eq!(*pool.operation(rest), Operation::Multiply(sine, sine));
    }
}
