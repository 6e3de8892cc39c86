//! The operations of a recursion with structural zeros and ones removed.
//!
//! A [`Counted`] number is a constant or varies. Operations among constants are folded, as are those with zero, and
//! multiplications by one. What is left is counted: additions, subtractions, multiplications and divisions one each,
//! sine and cosine of one angle two, negations none.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::articulated::{self, Scalar};

/// Operations of a function.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Operations {
    /// As they are written: what occurs again is counted again, and so is what no result needs.
    pub(crate) all: usize,
    /// Each expression that a result needs, once.
    pub(crate) distinct: usize,
}

/// A number of which is known whether it is a constant.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Counted {
    /// Known before the function runs.
    Constant(f64),
    /// Changes from call to call; an expression, or its negative.
    Varying {
        /// The same for the same expression.
        identity: usize,
        /// Whether it is negated, which costs nothing.
        negative: bool,
    },
}

/// An operand: whether it is a constant, which constant or expression, and its sign.
type Operand = (bool, u64, bool);
/// What is done, and to what.
type Expression = (char, Operand, Operand);

/// What has been computed.
struct Record {
    operations: usize,
    expressions: Vec<Expression>,
}

impl Record {
    const EMPTY: Self = Self {
        operations: 0,
        expressions: Vec::new(),
    };
}

thread_local! {
    static RECORD: RefCell<Record> = const { RefCell::new(Record::EMPTY) };
}

impl Counted {
    /// A number that varies, of its own.
    pub(crate) fn varying() -> Self {
        RECORD.with_borrow_mut(|Record { expressions, .. }| {
            let own = (false, expressions.len() as u64, false);
            expressions.push(('x', own, own));
            Self::Varying {
                identity: expressions.len() - 1,
                negative: false,
            }
        })
    }

    fn operand(self) -> Operand {
        match self {
            Self::Constant(value) => (true, value.to_bits(), false),
            Self::Varying { identity, negative } => (false, identity as u64, negative),
        }
    }

    fn is(self, value: f64) -> bool {
        matches!(self, Self::Constant(constant) if constant == value)
    }

    fn operation(name: char, a: Self, b: Self) -> Self {
        let commutes = name != '/';
        let (a, b) = (a.operand(), b.operand());
        let expression = if commutes && b < a {
            (name, b, a)
        } else {
            (name, a, b)
        };
        RECORD.with_borrow_mut(|record| {
            record.operations += 1;
            let expressions = &mut record.expressions;
            let identity = expressions.iter().position(|seen| *seen == expression);
            let identity = identity.unwrap_or_else(|| {
                expressions.push(expression);
                expressions.len() - 1
            });
            Self::Varying {
                identity,
                negative: false,
            }
        })
    }

    /// Without its sign, and the sign.
    fn split(self) -> (Self, bool) {
        match self {
            Self::Constant(value) => (Self::Constant(value.abs()), value.is_sign_negative()),
            Self::Varying { identity, negative } => (
                Self::Varying {
                    identity,
                    negative: false,
                },
                negative,
            ),
        }
    }

    fn signed(self, negative: bool) -> Self {
        if negative { -self } else { self }
    }
}

impl Neg for Counted {
    type Output = Self;

    fn neg(self) -> Self {
        match self {
            Self::Constant(value) => Self::Constant(-value),
            Self::Varying { identity, negative } => Self::Varying {
                identity,
                negative: !negative,
            },
        }
    }
}

impl Add for Counted {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        match (self, other) {
            (Self::Constant(a), Self::Constant(b)) => Self::Constant(a + b),
            _ if self.is(0.0) => other,
            _ if other.is(0.0) => self,
            _ => {
                // −a − b is −(a + b), and −a + b is −(a − b): one expression for both signs.
                let negative =
                    self.split().1 && (other.split().1 || !matches!(other, Self::Constant(_)));
                Self::operation('+', self.signed(negative), other.signed(negative)).signed(negative)
            }
        }
    }
}

impl Sub for Counted {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Counted {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let ((a, first), (b, second)) = (self.split(), other.split());
        let product = match (a, b) {
            (Self::Constant(a), Self::Constant(b)) => Self::Constant(a * b),
            _ if a.is(0.0) || b.is(0.0) => Self::Constant(0.0),
            _ if a.is(1.0) => b,
            _ if b.is(1.0) => a,
            _ => Self::operation('*', a, b),
        };
        product.signed(first != second)
    }
}

impl Div for Counted {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let ((a, first), (b, second)) = (self.split(), other.split());
        let ratio = match (a, b) {
            (Self::Constant(a), Self::Constant(b)) => Self::Constant(a / b),
            _ if a.is(0.0) => a,
            _ if b.is(1.0) => a,
            _ => Self::operation('/', a, b),
        };
        ratio.signed(first != second)
    }
}

impl Scalar for Counted {
    fn constant(value: f64) -> Self {
        Self::Constant(value)
    }

    fn sin_cos(self) -> (Self, Self) {
        let zero = Self::Constant(0.0);
        (
            Self::operation('s', self, zero),
            Self::operation('c', self, zero),
        )
    }
}

/// Operations of the articulated-body recursion for `n` links of `length`.
///
/// With a length of one all multiplications by it are gone, too.
pub(crate) fn articulated_body(n: usize, length: f64) -> Operations {
    RECORD.set(Record::EMPTY);
    let varying = || (0..n).map(|_| Counted::varying()).collect::<Vec<_>>();
    let (q, v, torque) = (varying(), varying(), varying());
    let accelerations = articulated::accelerations(length, &q, &v, &torque);
    RECORD.with_borrow(|record| Operations {
        all: record.operations,
        distinct: needed(&record.expressions, &accelerations),
    })
}

/// The operations that the results need, each once.
fn needed(expressions: &[Expression], results: &[Counted]) -> usize {
    let mut open: Vec<u64> = results.iter().map(|result| result.operand().1).collect();
    let mut seen = BTreeSet::new();
    while let Some(identity) = open.pop() {
        let (name, a, b) = expressions[identity as usize];
        if name != 'x' && seen.insert(identity) {
            open.extend([a, b].into_iter().filter(|it| !it.0).map(|it| it.1));
        }
    }
    seen.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_zeros_and_ones_cost_nothing() {
        RECORD.set(Record::EMPTY);
        let (x, y) = (Counted::varying(), Counted::varying());
        let [zero, one, two] = [0.0, 1.0, 2.0].map(Counted::Constant);
        let count = || RECORD.with_borrow(|record| record.operations);
        let _ = (
            x + zero,
            zero - x,
            x * one,
            -one * x,
            x * zero,
            two * two / two,
            zero / x,
        );
        assert_eq!(count(), 0);
        let sum = (x * y + two * x).operand().1;
        assert_eq!(count(), 3);
        assert_eq!((y * x + two * x).operand().1, sum);
        assert_eq!(count(), 6);
    }

    #[test]
    fn table_of_the_articulated_body() {
        println!("{:>2} {:>18} {:>18}", "n", "length 1", "length given");
        println!(
            "{:>2} {:>9}{:>9} {:>9}{:>9}",
            "", "all", "distinct", "all", "distinct"
        );
        let mut last = 0;
        for n in 1..=8 {
            let (one, other) = (articulated_body(n, 1.0), articulated_body(n, 1.25));
            println!(
                "{n:>2} {:>9}{:>9} {:>9}{:>9}",
                one.all, one.distinct, other.all, other.distinct
            );
            assert!(one.distinct <= one.all && one.distinct > last);
            last = one.distinct;
        }
    }
}
