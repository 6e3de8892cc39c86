//! Sums and products take last what is ready last.
//!
//! A sum of several terms of which one comes late, as everywhere where links depend on each other in a row, waits for it
//! only once if it is added last. Terms are added in the order in which they are ready, where nothing else needs a partial
//! sum, and factors are multiplied likewise. Two of them may come to the same partial result, which then is made once; else
//! the number of operations stays.

mod distribute;

use rustc_hash::FxHashMap;

use self::distribute::{Factors, factors};
use super::{Operand, Routine, Source, Step, Sweep, latency, read};
use crate::symbolic::Symbol;

/// The routine with sums and products reordered.
pub(super) fn reorder(routine: &Routine) -> Routine {
    let values = routine.names.len();
    let mut order = Order {
        uses: vec![0; values],
        ready: vec![0; values],
        parts: vec![None; values],
        first: 0,
        gone: vec![false; values],
        products: FxHashMap::default(),
    };
    order.count(routine);
    let steps = order.list(&routine.steps, 0);
    let there = order.products.clone();
    let sweeps = routine.sweeps.iter().map(|sweep| {
        order.products.clone_from(&there);
        order.list(&sweep.steps, sweep.first)
    });
    let sweeps: Vec<Vec<Numbered>> = sweeps.collect();
    let mut numbers = Numbers {
        new: vec![0; order.uses.len()],
        names: Vec::new(),
        made: FxHashMap::default(),
    };
    let steps = numbers.steps(steps, &order, &routine.names);
    let common = numbers.made.clone();
    let sweeps = routine.sweeps.iter().zip(sweeps).map(|(sweep, steps)| {
        let first = numbers.names.len();
        numbers.made.clone_from(&common);
        Sweep {
            first,
            steps: numbers.steps(steps, &order, &routine.names),
            results: numbers.operands(&sweep.results),
            coverage: sweep.coverage.clone(),
        }
    });
    let sweeps = sweeps.collect();
    Routine {
        steps,
        sweeps,
        results: numbers.operands(&routine.results),
        names: numbers.names,
        repeats: Vec::new(),
    }
}

/// A step with the old number of its first value; new ones are numbered behind all old.
type Numbered = (usize, Step);

/// A sum or a product of two.
#[derive(Clone, Copy)]
struct Parts {
    is_sum: bool,
    parts: [Operand; 2],
}

struct Order {
    uses: Vec<usize>,
    /// When each value is ready.
    ready: Vec<u32>,
    /// The sums and products.
    parts: Vec<Option<Parts>>,
    /// The first value of the list at hand: those before it are not taken apart.
    first: usize,
    /// Partial results in whose place others came.
    gone: Vec<bool>,
    /// The products that there are by their factors, and whether they carry a sign.
    products: FxHashMap<Factors, (usize, bool)>,
}

impl Order {
    fn count(&mut self, routine: &Routine) {
        for operand in read(&routine.steps, &routine.read_behind()) {
            if let Source::Value(value) = operand.source {
                self.uses[value] += 1;
            }
        }
    }

    /// The steps of a list whose values begin with number `value`.
    fn list(&mut self, steps: &[Step], mut value: usize) -> Vec<Numbered> {
        self.first = value;
        let mut list = Vec::with_capacity(steps.len());
        for step in steps {
            match *step {
                Step::Add(a, b) => self.result(&mut list, value, true, [a, b]),
                Step::Multiply(a, b) => self.result(&mut list, value, false, [a, b]),
                _ => {
                    let ready = self.latest(&step.operands()) + latency::of(step);
                    self.ready[value..value + step.results()].fill(ready);
                    list.push((value, step.clone()));
                }
            }
            value += step.results();
        }
        list
    }

    /// Appends a sum or product, as it is or ready earlier.
    fn result(
        &mut self,
        list: &mut Vec<Numbered>,
        value: usize,
        is_sum: bool,
        parts: [Operand; 2],
    ) {
        let mut better = self.improved(value, is_sum, parts);
        if better.is_none() && !is_sum {
            better = self.distributed(value, parts);
        }
        if let Some(better) = better {
            list.extend(better);
            return;
        }
        self.enter(value, is_sum, parts);
        list.push((value, step(is_sum, parts)));
        let [a, b] = parts;
        if !is_sum && let Some(factors) = factors(a, b) {
            let product = (value, a.negative ^ b.negative);
            self.products.entry(factors).or_insert(product);
        }
    }

    /// The same sum or product with its terms in the order in which they are ready, if it is ready earlier then.
    fn improved(
        &mut self,
        value: usize,
        is_sum: bool,
        parts: [Operand; 2],
    ) -> Option<Vec<Numbered>> {
        let (mut terms, mut partial) = (Vec::new(), Vec::new());
        for part in parts {
            self.flatten(part, is_sum, &mut terms, &mut partial);
        }
        if partial.is_empty() {
            return None;
        }
        terms.sort_by_key(|term| self.ready_as(*term, is_sum));
        if is_sum && terms.iter().all(|term| term.negative) {
            return None;
        }
        let (ready, before) = (self.ready_of(is_sum, parts), self.uses.len());
        let chain = self.chain(value, is_sum, &terms);
        if self.ready[value] < ready {
            partial.iter().for_each(|it| self.gone[*it] = true);
            return Some(chain);
        }
        self.forget(before);
        None
    }

    fn enter(&mut self, value: usize, is_sum: bool, parts: [Operand; 2]) {
        self.parts[value] = Some(Parts { is_sum, parts });
        self.ready[value] = self.ready_of(is_sum, parts);
    }

    /// The terms one after the other, the last of which gives `value`.
    fn chain(&mut self, value: usize, is_sum: bool, terms: &[Operand]) -> Vec<Numbered> {
        let mut chain = Vec::new();
        let mut so_far = terms[0];
        for (place, term) in terms.iter().enumerate().skip(1) {
            let (parts, negative) = with_signs(is_sum, [so_far, *term]);
            let number = if place + 1 == terms.len() {
                value
            } else {
                self.fresh()
            };
            self.enter(number, is_sum, parts);
            chain.push((number, step(is_sum, parts)));
            so_far = Operand {
                source: Source::Value(number),
                negative,
            };
        }
        chain
    }

    /// A partial result, which is used once.
    fn fresh(&mut self) -> usize {
        self.uses.push(1);
        self.ready.push(0);
        self.parts.push(None);
        self.gone.push(false);
        self.uses.len() - 1
    }

    /// Forgets partial results from this number on.
    fn forget(&mut self, from: usize) {
        self.uses.truncate(from);
        self.ready.truncate(from);
        self.parts.truncate(from);
        self.gone.truncate(from);
    }

    /// When a sum or product is ready.
    fn ready_of(&self, is_sum: bool, [a, b]: [Operand; 2]) -> u32 {
        let whole = |operand: Operand| self.latest(&[operand]);
        let first = self.ready_as(a, is_sum).max(whole(b));
        let second = whole(a).max(self.ready_as(b, is_sum));
        first.min(second) + latency::SUM
    }

    /// When a term can go into a sum: a product that nothing else needs takes no time of its own there.
    fn ready_as(&self, term: Operand, of_sum: bool) -> u32 {
        match self.inner(term, false) {
            Some(product) if of_sum => self.latest(&product.parts),
            _ => self.latest(&[term]),
        }
    }

    /// The parts of a sum, or of a product, that nothing else needs.
    fn inner(&self, operand: Operand, is_sum: bool) -> Option<Parts> {
        match operand.source {
            Source::Value(value) if value >= self.first && self.uses[value] == 1 => {
                self.parts[value].filter(|parts| parts.is_sum == is_sum)
            }
            _ => None,
        }
    }

    /// Takes terms apart as long as nothing else needs them.
    fn flatten(
        &self,
        term: Operand,
        is_sum: bool,
        terms: &mut Vec<Operand>,
        partial: &mut Vec<usize>,
    ) {
        match (self.inner(term, is_sum), term.source) {
            (Some(inner), Source::Value(value)) => {
                partial.push(value);
                for (place, part) in inner.parts.into_iter().enumerate() {
                    // The sign of a product is that of one of its factors.
                    let flip = term.negative && (is_sum || place == 0);
                    let negative = part.negative ^ flip;
                    self.flatten(Operand { negative, ..part }, is_sum, terms, partial);
                }
            }
            _ => terms.push(term),
        }
    }

    fn latest(&self, operands: &[Operand]) -> u32 {
        latency::latest(&self.ready, operands)
    }
}

/// The parts as a sum is written, beginning with one that carries no sign, and whether the sum carries one.
fn with_signs(is_sum: bool, [a, b]: [Operand; 2]) -> ([Operand; 2], bool) {
    match (is_sum && a.negative, b.negative) {
        (true, true) => ([a, b].map(|it| Operand::plain(it.source)), true),
        (true, false) => ([b, a], false),
        (false, _) => ([a, b], false),
    }
}

fn step(is_sum: bool, [a, b]: [Operand; 2]) -> Step {
    if is_sum {
        Step::Add(a, b)
    } else {
        Step::Multiply(a, b)
    }
}

/// A source to be looked up, if it can be.
fn key(source: Source) -> Option<(u8, u64)> {
    Some(match source {
        Source::Constant(value) => (0, value.to_bits()),
        Source::Folded(number) => (1, number as u64),
        Source::Value(number) => (2, number as u64),
        Source::Symbol(Symbol::State(number)) => (3, number as u64),
        Source::Symbol(Symbol::Input(number)) => (4, number as u64),
        Source::Symbol(Symbol::Parameter(number)) => (5, number as u64),
        Source::Symbol(_) | Source::Solved(_) => return None,
    })
}

/// What a sum or product is made of, to be looked up: whether it is a sum, and its parts in any order.
type Made = (bool, [(u8, u64, bool); 2]);

/// The new numbers of values.
struct Numbers {
    new: Vec<usize>,
    names: Vec<String>,
    /// The sums and products that there are.
    made: FxHashMap<Made, usize>,
}

impl Numbers {
    fn steps(&mut self, steps: Vec<Numbered>, order: &Order, names: &[String]) -> Vec<Step> {
        let kept = steps
            .into_iter()
            .filter(|(value, step)| step.results() == 0 || !order.gone[*value]);
        kept.filter_map(|(value, step)| self.step(value, &step, names))
            .collect()
    }

    /// The step with new numbers; none if its value is there.
    fn step(&mut self, value: usize, step: &Step, names: &[String]) -> Option<Step> {
        let name = |value: usize| names.get(value).cloned().unwrap_or_default();
        let made = self.made_of(step);
        if let Some(number) = made.and_then(|it| self.made.get(&it).copied()) {
            self.new[value] = number;
            if self.names[number].is_empty() {
                self.names[number] = name(value);
            }
            return None;
        }
        if let Some(made) = made {
            self.made.insert(made, self.names.len());
        }
        for value in value..value + step.results() {
            self.new[value] = self.names.len();
            self.names.push(name(value));
        }
        Some(step.with(&|operand| self.operand(operand)))
    }

    /// What a sum or product is made of, if that can be looked up.
    fn made_of(&self, step: &Step) -> Option<Made> {
        let part = |operand: &Operand| {
            let (kind, number) = key(self.operand(*operand).source)?;
            Some((kind, number, operand.negative))
        };
        let (is_sum, a, b) = match step {
            Step::Add(a, b) => (true, part(a)?, part(b)?),
            Step::Multiply(a, b) => (false, part(a)?, part(b)?),
            _ => return None,
        };
        Some((is_sum, if a <= b { [a, b] } else { [b, a] }))
    }

    fn operands(&self, operands: &[Operand]) -> Vec<Operand> {
        operands.iter().map(|it| self.operand(*it)).collect()
    }

    fn operand(&self, operand: Operand) -> Operand {
        operand.renumbered(&self.new)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::program::fixtures::{coverage, negative, state, value};

    fn ordered(steps: &[Step]) -> Vec<Step> {
        let values: usize = steps.iter().map(Step::results).sum();
        let routine = Routine {
            steps: steps.to_vec(),
            names: vec![String::new(); values],
            results: vec![value(values - 1)],
            sweeps: Vec::new(),
            repeats: Vec::new(),
        };
        reorder(&routine).steps
    }

    #[test]
    fn what_is_late_is_added_last() {
        let late = Step::Sine(state(0));
        let negated = negative(value(0));
        let found = ordered(&[
            late.clone(),
            Step::Add(state(1), negated),
            Step::Add(value(1), state(2)),
        ]);
        let sum = Step::Add(state(1), state(2));
        assert_eq!(found, [late, sum, Step::Add(value(1), negated)]);
    }

    #[test]
    fn what_is_late_is_multiplied_last() {
        let late = Step::Sine(state(0));
        let found = ordered(&[
            late.clone(),
            Step::Multiply(state(1), value(0)),
            Step::Multiply(value(1), state(2)),
        ]);
        let product = Step::Multiply(state(1), state(2));
        assert_eq!(found, [late, product, Step::Multiply(value(1), value(0))]);
    }

    #[test]
    fn what_two_products_come_to_alike_is_made_once() {
        let late = Step::Sine(state(0));
        let found = ordered(&[
            late.clone(),
            Step::Multiply(state(1), value(0)),
            Step::Multiply(value(1), state(2)),
            Step::Cosine(value(2)),
            Step::Multiply(state(2), value(0)),
            Step::Multiply(value(4), state(1)),
        ]);
        let product = Step::Multiply(state(1), state(2));
        let whole = Step::Multiply(value(1), value(0));
        assert_eq!(found, [late, product, whole, Step::Cosine(value(2))]);
    }

    #[test]
    fn what_is_late_is_added_last_though_all_else_is_subtracted() {
        let late = Step::Sine(state(0));
        let found = ordered(&[
            late.clone(),
            Step::Add(value(0), negative(state(1))),
            Step::Add(value(1), negative(state(2))),
        ]);
        let sum = Step::Add(state(1), state(2));
        assert_eq!(found, [late, sum, Step::Add(value(0), negative(value(1)))]);
    }

    #[test]
    fn what_is_late_in_a_sum_is_multiplied_by_a_product_that_is_there() {
        let late = Step::Sine(state(2));
        let there = Step::Multiply(state(0), state(1));
        let found = ordered(&[
            there.clone(),
            late.clone(),
            Step::Multiply(state(0), value(1)),
            Step::Add(state(3), negative(value(2))),
            Step::Multiply(value(3), state(1)),
        ]);
        let rest = Step::Multiply(state(3), state(1));
        let product = Step::Multiply(value(0), value(1));
        let sum = Step::Add(value(2), negative(value(3)));
        assert_eq!(found, [there, late, rest, product, sum]);
    }

    #[test]
    fn a_sum_is_multiplied_as_a_whole_where_no_product_is_there() {
        let steps = [
            Step::Sine(state(2)),
            Step::Multiply(state(0), value(0)),
            Step::Add(state(3), value(1)),
            Step::Multiply(value(2), state(1)),
        ];
        assert_eq!(ordered(&steps), steps);
    }

    #[test]
    fn a_sum_is_multiplied_as_a_whole_where_the_factor_comes_late() {
        let steps = [
            Step::Sine(state(2)),
            Step::Multiply(state(0), value(0)),
            Step::Multiply(state(0), state(1)),
            Step::Add(state(3), value(2)),
            Step::Multiply(value(3), value(0)),
        ];
        let routine = Routine {
            steps: steps.to_vec(),
            names: vec![String::new(); 5],
            results: vec![value(1), value(4)],
            sweeps: Vec::new(),
            repeats: Vec::new(),
        };
        assert_eq!(reorder(&routine).steps, steps);
    }

    #[test]
    fn sweeps_take_no_product_of_other_sweeps() {
        let sweep = |first: usize, steps: &[Step]| Sweep {
            coverage: coverage(0),
            first,
            steps: steps.to_vec(),
            results: vec![value(first + steps.len() - 1)],
        };
        let first = [
            Step::Multiply(state(0), state(1)),
            Step::Multiply(value(1), value(0)),
        ];
        let second = [
            Step::Sine(state(0)),
            Step::Multiply(state(0), value(3)),
            Step::Add(state(3), value(4)),
            Step::Multiply(value(5), state(1)),
        ];
        let routine = Routine {
            steps: vec![Step::Sine(state(2))],
            names: vec![String::new(); 7],
            results: vec![value(0)],
            sweeps: vec![sweep(1, &first), sweep(3, &second)],
            repeats: Vec::new(),
        };
        assert_eq!(reorder(&routine).sweeps[1].steps, second);
    }

    #[test]
    fn a_partial_sum_that_is_needed_stays() {
        let steps = [
            Step::Sine(state(0)),
            Step::Add(state(1), value(0)),
            Step::Add(value(1), state(2)),
            Step::Multiply(value(1), value(2)),
        ];
        assert_eq!(ordered(&steps), steps);
    }
}
