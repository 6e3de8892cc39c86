//! Products that are used once, in a sum, become one step with it.
//!
//! On a target with a fused multiply-add that is one instruction in place of two, and half of their latency. Of a sum of
//! two products the one that is ready last is taken in, so that the other does not wait for it.

use super::{Operand, Routine, Solve, Source, Step, Sweep, latency};

/// The routine with products taken into sums.
pub(super) fn contract(routine: &Routine) -> Routine {
    let mut uses = vec![0; routine.names.len()];
    count_uses(&routine.steps, &mut uses);
    count(&routine.read_behind(), &mut uses);
    let mut contraction = Contraction {
        uses,
        products: vec![None; routine.names.len()],
        ready: vec![0; routine.names.len()],
        taken: vec![false; routine.names.len()],
    };
    contraction.choose(&routine.steps, 0);
    for sweep in &routine.sweeps {
        contraction.choose(&sweep.steps, sweep.first);
    }
    let mut places = Vec::with_capacity(routine.names.len());
    let mut names = Vec::new();
    for (taken, name) in contraction.taken.iter().zip(&routine.names) {
        places.push(names.len());
        if !taken {
            names.push(name.clone());
        }
    }
    // One more for where nothing comes.
    places.push(names.len());
    let rewrite = Rewrite {
        contraction: &contraction,
        places: &places,
    };
    Routine {
        steps: rewrite.steps(&routine.steps, 0),
        names,
        results: rewrite.operands(&routine.results),
        sweeps: routine.sweeps.iter().map(|it| rewrite.sweep(it)).collect(),
        repeats: Vec::new(),
    }
}

fn count_uses(steps: &[Step], uses: &mut [usize]) {
    for step in steps {
        count(&step.operands(), uses);
    }
}

fn count(operands: &[Operand], uses: &mut [usize]) {
    for operand in operands {
        if let Source::Value(value) = operand.source {
            uses[value] += 1;
        }
    }
}

struct Contraction {
    uses: Vec<usize>,
    /// The factors of each value that is a product in the list of steps at hand.
    products: Vec<Option<[Operand; 2]>>,
    /// When each value is ready.
    ready: Vec<u32>,
    /// Products that have gone into a sum.
    taken: Vec<bool>,
}

impl Contraction {
    /// Decides for a list of steps whose values begin with number `value`.
    fn choose(&mut self, steps: &[Step], mut value: usize) {
        let first = value;
        for step in steps {
            let start = self.latest(&step.operands());
            let end = match step {
                Step::Add(a, b) => self.sum(first, *a, *b).unwrap_or(start + latency::SUM),
                Step::Multiply(a, b) => {
                    self.products[value] = Some([*a, *b]);
                    start + latency::SUM
                }
                Step::Solve(solve) => {
                    self.choose(&solve.steps, value);
                    start
                }
                _ => start + latency::of(step),
            };
            let next = value + step.results();
            if !matches!(step, Step::Solve(_)) {
                self.ready[value..next].fill(end);
            }
            value = next;
        }
    }

    /// Takes one of the terms in, if it may be; says when the sum is ready then.
    fn sum(&mut self, first: usize, a: Operand, b: Operand) -> Option<u32> {
        let factors = |operand: Operand| self.factors(first, operand);
        let taken = match (factors(a), factors(b)) {
            (Some(x), Some(y)) if self.latest(&x) < self.latest(&y) => b,
            (Some(_), _) => a,
            (None, Some(_)) => b,
            (None, None) => return None,
        };
        let addend = if taken == a { b } else { a };
        let [x, y] = factors(taken)?;
        let Source::Value(product) = taken.source else {
            return None;
        };
        self.taken[product] = true;
        Some(self.latest(&[x, y, addend]) + latency::SUM)
    }

    /// The factors of a term that nothing else uses, made by the steps from value `first` on: what is worked out before
    /// an iteration stays there.
    fn factors(&self, first: usize, operand: Operand) -> Option<[Operand; 2]> {
        match operand.source {
            Source::Value(value) if value >= first && self.uses[value] == 1 => self.products[value],
            _ => None,
        }
    }

    fn latest(&self, operands: &[Operand]) -> u32 {
        latency::latest(&self.ready, operands)
    }
}

/// The steps without the products that were taken in, and values by their new numbers.
struct Rewrite<'a> {
    contraction: &'a Contraction,
    places: &'a [usize],
}

impl Rewrite<'_> {
    fn steps(&self, steps: &[Step], mut value: usize) -> Vec<Step> {
        let mut kept = Vec::with_capacity(steps.len());
        for step in steps {
            let gone = matches!(step, Step::Multiply(..)) && self.contraction.taken[value];
            if !gone {
                kept.push(self.step(step, value));
            }
            value += step.results();
        }
        kept
    }

    fn sweep(&self, sweep: &Sweep) -> Sweep {
        Sweep {
            coverage: sweep.coverage.clone(),
            first: self.places[sweep.first],
            steps: self.steps(&sweep.steps, sweep.first),
            results: self.operands(&sweep.results),
        }
    }

    fn step(&self, step: &Step, value: usize) -> Step {
        let place = |operand: &Operand| self.operand(*operand);
        match step {
            Step::Add(a, b) => match (self.taken(*a), self.taken(*b)) {
                (Some([x, y]), _) => Step::MultiplyAdd(x, y, place(b)),
                (None, Some([x, y])) => Step::MultiplyAdd(x, y, place(a)),
                (None, None) => Step::Add(place(a), place(b)),
            },
            Step::Solve(solve) => Step::Solve(Solve {
                steps: self.steps(&solve.steps, value),
                results: self.operands(&solve.results),
                ..solve.clone()
            }),
            _ => step.with(&|operand| self.operand(operand)),
        }
    }

    /// The factors of a term that was taken in, with its sign on the first.
    fn taken(&self, operand: Operand) -> Option<[Operand; 2]> {
        let Source::Value(value) = operand.source else {
            return None;
        };
        let [x, y] = self.contraction.products[value].filter(|_| self.contraction.taken[value])?;
        let [mut x, y] = [self.operand(x), self.operand(y)];
        x.negative ^= operand.negative;
        Some([x, y])
    }

    fn operands(&self, operands: &[Operand]) -> Vec<Operand> {
        operands.iter().map(|it| self.operand(*it)).collect()
    }

    fn operand(&self, operand: Operand) -> Operand {
        operand.renumbered(self.places)
    }
}
