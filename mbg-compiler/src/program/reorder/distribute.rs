//! Sums that are multiplied term by term.
//!
//! Where a sum waits for a late term and is then multiplied, as an acceleration by the reciprocal of an inertia, the product
//! waits once more. If the product of the late term's other factor with the reciprocal is there, only the rest of the sum is
//! multiplied, and what comes late goes straight into the result. The number of operations stays, though a product
//! that is read twice goes into no sum by itself.

use super::{Numbered, Operand, Order, Parts, Source, key, step};

/// The sources of two factors, in any order.
pub(super) type Factors = [(u8, u64); 2];

/// The sources of two factors, if they can be looked up.
pub(super) fn factors(a: Operand, b: Operand) -> Option<Factors> {
    let (a, b) = (key(a.source)?, key(b.source)?);
    Some(if a <= b { [a, b] } else { [b, a] })
}

impl Order {
    /// The product of a sum and a factor with the sum's last terms multiplied one by one, if it is ready earlier then.
    pub(super) fn distributed(
        &mut self,
        value: usize,
        parts: [Operand; 2],
    ) -> Option<Vec<Numbered>> {
        let [a, b] = parts;
        self.distributed_over(value, a, b)
            .or_else(|| self.distributed_over(value, b, a))
    }

    fn distributed_over(
        &mut self,
        value: usize,
        sum: Operand,
        factor: Operand,
    ) -> Option<Vec<Numbered>> {
        self.inner(sum, true)?;
        let (mut terms, mut partial) = (Vec::new(), Vec::new());
        self.flatten(sum, true, &mut terms, &mut partial);
        terms.sort_by_key(|term| self.ready_as(*term, true));
        let late = self.late(&mut terms, factor)?;
        let ready = self.ready_of(false, [sum, factor]);
        let before = self.uses.len();
        let (mut steps, rest) = self.rest(&mut terms);
        let mut products = vec![self.product(&mut steps, rest, factor)];
        for product in late.iter().rev() {
            let reused = Operand {
                source: Source::Value(product.reused),
                negative: product.negative,
            };
            products.push(self.product(&mut steps, reused, product.other));
        }
        if products.iter().any(|it| !it.negative) {
            steps.extend(self.chain(value, true, &products));
            if self.ready[value] < ready {
                for product in late {
                    partial.push(product.replaced);
                    self.uses[product.reused] += 1;
                }
                partial.iter().for_each(|it| self.gone[*it] = true);
                return Some(steps);
            }
        }
        self.forget(before);
        None
    }

    /// The last terms, taken off, as far as each can be multiplied by itself; all but the first at most.
    fn late(&self, terms: &mut Vec<Operand>, factor: Operand) -> Option<Vec<Multiplied>> {
        let mut late = Vec::new();
        while terms.len() > 1
            && let Some(product) = terms.last().and_then(|term| self.multiplied(*term, factor))
        {
            late.push(product);
            terms.pop();
        }
        let is_replaced = |value: usize| late.iter().any(|it| it.replaced == value);
        let is_there = !late.iter().any(|it| is_replaced(it.reused));
        (is_there && !late.is_empty()).then_some(late)
    }

    /// A term times the factor, as a product of what is there, if the term is a product that nothing else needs.
    fn multiplied(&self, term: Operand, factor: Operand) -> Option<Multiplied> {
        let Parts { parts: [x, y], .. } = self.inner(term, false)?;
        let Source::Value(replaced) = term.source else {
            return None;
        };
        [[x, y], [y, x]].into_iter().find_map(|[of, other]| {
            let (reused, negative) = *self.products.get(&factors(of, factor)?)?;
            let negative = negative ^ of.negative ^ factor.negative ^ term.negative;
            (!self.gone[reused]).then_some(Multiplied {
                replaced,
                reused,
                negative,
                other,
            })
        })
    }

    /// The sum of the early terms.
    fn rest(&mut self, terms: &mut [Operand]) -> (Vec<Numbered>, Operand) {
        if let [term] = terms {
            return (Vec::new(), *term);
        }
        let negative = terms.iter().all(|term| term.negative);
        terms.iter_mut().for_each(|term| term.negative ^= negative);
        let number = self.fresh();
        let steps = self.chain(number, true, terms);
        let source = Source::Value(number);
        (steps, Operand { source, negative })
    }

    /// A product of its own, with its sign on it.
    fn product(&mut self, steps: &mut Vec<Numbered>, a: Operand, b: Operand) -> Operand {
        let number = self.fresh();
        let parts = [a, b].map(|it| Operand::plain(it.source));
        self.enter(number, false, parts);
        steps.push((number, step(false, parts)));
        Operand {
            source: Source::Value(number),
            negative: a.negative ^ b.negative,
        }
    }
}

/// What comes in the place of a term: a product that is there, with a sign, times the term's other factor.
struct Multiplied {
    replaced: usize,
    reused: usize,
    negative: bool,
    other: Operand,
}
