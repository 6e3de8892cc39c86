//! From the expression graph to steps in order.

use std::borrow::Cow;
use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet};

use super::arrange::arrange;
use super::contract::contract;
use super::hoist::hoist;
use super::reorder::reorder;
use super::repeats::repeats;
use super::signs::signs;
use super::stretches::by_stretches;
use super::{Operand, Program, Request, Routine, Slopes, Solve, Solver, Source, Step, Sweep};
use crate::operands::Operands;
use crate::symbolic::{Expression, Implicit, Method, Operation, Pool, Rate, Symbol};

/// Builds one function for each request. `state` gives the place in `x` of each candidate state; `names` names nodes.
#[must_use]
pub fn build(
    pool: &Pool,
    requests: &[Request],
    state: &dyn Fn(usize) -> usize,
    names: &BTreeMap<usize, String>,
) -> Program {
    let folded_nodes = folded_nodes(pool, requests);
    let mut folded = vec![None; pool.len()];
    for (number, node) in folded_nodes.iter().enumerate() {
        folded[node.node()] = Some(number);
    }
    let context = Context {
        pool,
        captured: (0..pool.implicit().len())
            .map(|number| captured(pool, number))
            .collect(),
        folded,
        changing: OnceCell::new(),
        state,
        names,
    };
    let folded = context.routine(&Request::from(folded_nodes), true);
    let routines = requests
        .iter()
        .map(|request| context.routine(request, false))
        .collect();
    Program { folded, routines }
}

/// Expressions of parameters alone that something varying, or a result, is computed from.
fn folded_nodes(pool: &Pool, requests: &[Request]) -> Vec<Expression> {
    let mut seen = vec![false; pool.len()];
    let mut found = Vec::new();
    let roots = requests.iter().flat_map(|request| {
        let sweeps = request.sweeps.iter();
        request
            .results
            .iter()
            .chain(sweeps.flat_map(|it| &it.forms))
    });
    for root in roots {
        let mut pending = vec![root.magnitude()];
        while let Some(current) = pending.pop() {
            if std::mem::replace(&mut seen[current.node()], true) {
                continue;
            }
            match (pool.rate(current), pool.operation(current)) {
                (Rate::Varying, _) => {
                    let causes = pool.causes(current);
                    pending.extend(causes.iter().rev().map(|it| it.magnitude()));
                }
                (Rate::Parameter, Operation::Symbol(_)) | (Rate::Constant, _) => {}
                (Rate::Parameter, _) => found.push(current),
            }
        }
    }
    found
}

/// What a solve needs before it begins: of an iteration what its evaluation reads and does not depend on its unknowns.
fn captured(pool: &Pool, number: usize) -> Vec<Expression> {
    let implicit = &pool.implicit()[number];
    let evaluated = implicit.evaluated();
    match implicit.method {
        Method::Newton { .. } => free_of_unknowns(pool, implicit, evaluated),
        Method::Linear { .. } => evaluated,
        Method::Slope { of, .. } => [evaluated, captured(pool, of)].concat(),
    }
}

/// The last expressions below the roots that do not depend on the unknowns.
fn free_of_unknowns(
    pool: &Pool,
    implicit: &Implicit,
    mut pending: Vec<Expression>,
) -> Vec<Expression> {
    let depends = dependent(pool, implicit);
    let mut seen = vec![false; pool.len()];
    let mut found = Vec::new();
    pending.reverse();
    while let Some(current) = pending.pop() {
        if std::mem::replace(&mut seen[current.node()], true) {
            continue;
        }
        if depends[current.node()] {
            pending.extend(pool.operation(current).operands().iter().rev());
        } else {
            found.push(current.magnitude());
        }
    }
    found
}

/// Whether each node depends on the unknowns; operands come before what uses them unless they are constants.
fn dependent(pool: &Pool, implicit: &Implicit) -> Vec<bool> {
    let mut depends = Vec::with_capacity(pool.len());
    for operation in pool.operations() {
        depends.push(match operation {
            Operation::Symbol(Symbol::Unknown(unknown)) => implicit.unknowns.contains(unknown),
            _ => {
                let known = |it: &Expression| depends.get(it.node()).copied().unwrap_or(false);
                operation.operands().iter().any(known)
            }
        });
    }
    depends
}

struct Context<'a> {
    pool: &'a Pool,
    /// What each iteration needs before it begins.
    captured: Vec<Vec<Expression>>,
    /// The number of what is folded, by node.
    folded: Vec<Option<usize>>,
    /// Whether each node changes along a direction, once that was asked for.
    changing: OnceCell<Vec<bool>>,
    state: &'a dyn Fn(usize) -> usize,
    names: &'a BTreeMap<usize, String>,
}

/// A routine in the making.
struct Draft {
    routine: Routine,
    /// The number of what there is, by node.
    values: Vec<Option<usize>>,
    /// Reciprocals by the node of the divisor.
    reciprocals: BTreeMap<usize, usize>,
    /// Iterations that have been run, and the one that is being written.
    solved: BTreeSet<usize>,
}

impl Draft {
    /// Appends a step; gives the number of its first value.
    fn push(&mut self, step: Step, names: &[String]) -> usize {
        let first = self.routine.names.len();
        self.routine.names.extend_from_slice(names);
        self.routine.steps.push(step);
        first
    }

    /// The reciprocal of a divisor, made where it is not there.
    fn reciprocal(&mut self, node: usize, divisor: Operand) -> usize {
        if let Some(value) = self.reciprocals.get(&node) {
            return *value;
        }
        let one = Operand::plain(Source::Constant(1.0));
        let value = self.push(Step::Divide(one, divisor), &[String::new()]);
        self.reciprocals.insert(node, value);
        value
    }
}

/// What several steps have in common.
struct Common {
    /// Angles of which both sine and cosine are needed, with the two nodes.
    angles: BTreeMap<usize, (usize, usize)>,
    /// Those of them that are at hand from the start, with their sines.
    early: Vec<(Expression, Expression)>,
    /// Divisors of several quotients. These become products with one reciprocal: a division takes the time of five to ten
    /// multiplications and seldom overlaps with another, and the second rounding costs half a unit of the last place.
    divisors: BTreeSet<usize>,
}

/// What several sweeps of a Jacobian have in common.
#[derive(Default)]
struct Unchanging {
    /// Expressions.
    needed: Vec<Expression>,
    /// Divisors by node.
    divisors: BTreeMap<usize, Expression>,
    /// Numbers of linear solves whose factors are used.
    factorised: BTreeSet<usize>,
}

impl Context<'_> {
    /// Steps for the roots, each node once, operands before what uses them. While folding, nothing is taken from the
    /// folded values, since these are just being made.
    fn routine(&self, request: &Request, folding: bool) -> Routine {
        let roots = &request.results;
        let mut draft = Draft {
            routine: Routine::default(),
            values: vec![None; self.pool.len()],
            reciprocals: BTreeMap::new(),
            solved: BTreeSet::new(),
        };
        let unchanging = self.unchanging(&request.sweeps);
        self.steps(
            &mut draft,
            &[&roots[..], &unchanging.needed].concat(),
            folding,
        );
        self.prepare(&mut draft, &unchanging);
        for slopes in &request.sweeps {
            self.sweep(&mut draft, slopes, &unchanging);
        }
        draft.routine.results = roots
            .iter()
            .map(|root| self.operand(&draft, *root, folding))
            .collect();
        if folding {
            return contract(&draft.routine);
        }
        let mut hoisted = hoist(&signs(&contract(&reorder(&draft.routine))));
        hoisted.repeats = repeats(&hoisted);
        if hoisted.repeats.is_empty() {
            by_stretches(&arrange(&hoisted))
        } else {
            hoisted
        }
    }

    /// Whether each node changes along a direction; operands come before what uses them.
    fn changing(&self) -> Vec<bool> {
        let mut changing = Vec::with_capacity(self.pool.len());
        for node in self.pool.nodes() {
            changing.push(match self.pool.operation(node) {
                Operation::Symbol(Symbol::Slope(_)) => true,
                _ => {
                    let known = |it: &Expression| changing.get(it.node()).copied();
                    let before = self.before(node);
                    before.iter().any(|it| known(it).unwrap_or(false))
                }
            });
        }
        changing
    }

    /// What slopes are worked out from and does not change with the direction.
    fn unchanging(&self, sweeps: &[Slopes]) -> Unchanging {
        let mut found = Unchanging::default();
        if sweeps.is_empty() {
            return found;
        }
        let changing = self.changing.get_or_init(|| self.changing());
        let mut seen = vec![false; self.pool.len()];
        let forms = sweeps.iter().rev().flat_map(|it| it.forms.iter().rev());
        let mut pending: Vec<Expression> = forms.copied().collect();
        while let Some(current) = pending.pop() {
            if std::mem::replace(&mut seen[current.node()], true) {
                continue;
            }
            if !changing[current.node()] {
                found.needed.push(current.magnitude());
                continue;
            }
            match self.pool.operation(current) {
                Operation::Divide(_, divisor) => {
                    found.divisors.insert(divisor.node(), divisor.magnitude());
                }
                Operation::Symbol(symbol) => {
                    let place = self.pool.place(*symbol);
                    let earlier = place.and_then(|it| self.pool.implicit()[it.number].earlier());
                    found.factorised.extend(earlier);
                }
                _ => {}
            }
            pending.extend(self.before(current).iter().rev());
        }
        found
    }

    /// Reciprocals and factors that slopes are worked out with; what these are made of is there.
    fn prepare(&self, draft: &mut Draft, unchanging: &Unchanging) {
        for (node, divisor) in &unchanging.divisors {
            let divisor = self.operand(draft, *divisor, false);
            draft.reciprocal(*node, divisor);
        }
        for number in &unchanging.factorised {
            if !draft.solved.contains(number) {
                self.solve(draft, *number);
            }
        }
    }

    /// Steps for slopes, all that does not change with the direction being there.
    fn sweep(&self, draft: &mut Draft, slopes: &Slopes, unchanging: &Unchanging) {
        let common = Common {
            angles: BTreeMap::new(),
            early: Vec::new(),
            divisors: unchanging.divisors.keys().copied().collect(),
        };
        let outside = (draft.values.clone(), draft.solved.clone());
        let first = draft.routine.names.len();
        let before = std::mem::take(&mut draft.routine.steps);
        for form in &slopes.forms {
            self.visit(draft, form.magnitude(), false, &common);
        }
        let sweep = Sweep {
            coverage: slopes.coverage.clone(),
            first,
            results: self.operands(draft, &slopes.forms),
            steps: std::mem::replace(&mut draft.routine.steps, before),
        };
        (draft.values, draft.solved) = outside;
        draft.routine.sweeps.push(sweep);
    }

    /// Appends what the roots still need.
    fn steps(&self, draft: &mut Draft, roots: &[Expression], folding: bool) {
        let common = self.common(draft, roots, folding);
        self.early_angles(draft, folding, &common);
        for root in roots {
            self.visit(draft, root.magnitude(), folding, &common);
        }
    }

    /// Angles that are at hand from the start come first, so that their sines are evaluated side by side.
    fn early_angles(&self, draft: &mut Draft, folding: bool, common: &Common) {
        let early = || common.early.iter();
        for (angle, _) in early() {
            self.visit(draft, *angle, folding, common);
        }
        for (_, sine) in early() {
            self.visit(draft, *sine, folding, common);
        }
    }

    /// Whether it is a sum or product of what is at hand from the start.
    fn is_early(&self, expression: Expression, folding: bool) -> bool {
        if self.is_leaf(expression, folding) {
            return true;
        }
        match self.pool.operation(expression) {
            Operation::Add(a, b) | Operation::Multiply(a, b) => {
                self.is_leaf(*b, folding) && self.is_early(*a, folding)
                    || self.is_leaf(*a, folding) && self.is_early(*b, folding)
            }
            _ => false,
        }
    }

    /// What must be there before a node.
    fn before(&self, expression: Expression) -> Operands<'_, Expression> {
        match self.pool.operation(expression) {
            Operation::Symbol(symbol) => match self.pool.place(*symbol) {
                Some(place) => Operands::Many(Cow::Borrowed(&self.captured[place.number])),
                None => Operands::Zero,
            },
            operation => operation.operands(),
        }
    }

    /// Whether a node needs no step here.
    fn is_leaf(&self, expression: Expression, folding: bool) -> bool {
        match self.pool.operation(expression) {
            Operation::Constant(_) => true,
            Operation::Symbol(symbol) => self.pool.place(*symbol).is_none(),
            _ => !folding && self.folded[expression.node()].is_some(),
        }
    }

    /// What several of the steps have in common that the roots still need.
    fn common(&self, draft: &Draft, roots: &[Expression], folding: bool) -> Common {
        let mut sines = BTreeMap::new();
        let mut cosines = BTreeMap::new();
        let mut quotients: BTreeMap<usize, usize> = BTreeMap::new();
        let mut seen = vec![false; self.pool.len()];
        let mut pending: Vec<Expression> = roots.to_vec();
        while let Some(current) = pending.pop() {
            let known = self.is_leaf(current, folding) || draft.values[current.node()].is_some();
            if std::mem::replace(&mut seen[current.node()], true) || known {
                continue;
            }
            let operation = self.pool.operation(current);
            match operation {
                Operation::Sine(angle) => drop(sines.insert(*angle, current.magnitude())),
                Operation::Cosine(angle) => drop(cosines.insert(*angle, current.magnitude())),
                Operation::Divide(_, divisor) => *quotients.entry(divisor.node()).or_default() += 1,
                _ => {}
            }
            pending.extend_from_slice(&self.before(current));
        }
        sines.retain(|angle, _| cosines.contains_key(angle));
        let early = sines
            .iter()
            .map(|(angle, sine)| (*angle, *sine))
            .filter(|(angle, _)| self.is_early(*angle, folding))
            .collect();
        let paired = |(angle, sine): (Expression, Expression)| {
            let cosine = cosines.get(&angle)?;
            Some((angle.node(), (sine.node(), cosine.node())))
        };
        quotients.retain(|_, quotients| *quotients > 1 && !folding);
        Common {
            angles: sines.into_iter().filter_map(paired).collect(),
            early,
            divisors: quotients.into_keys().collect(),
        }
    }

    fn visit(&self, draft: &mut Draft, root: Expression, folding: bool, common: &Common) {
        let mut pending = vec![(root, false)];
        while let Some((current, ready)) = pending.pop() {
            if draft.values[current.node()].is_some() || self.is_leaf(current, folding) {
                continue;
            }
            let operation = self.pool.operation(current);
            let place = match operation {
                Operation::Symbol(symbol) => self.pool.place(*symbol),
                _ => None,
            };
            if place.is_some_and(|place| draft.solved.contains(&place.number)) {
                continue;
            }
            if !ready {
                pending.push((current, true));
                let before = self.before(current);
                pending.extend(before.iter().rev().map(|it| (it.magnitude(), false)));
                continue;
            }
            match place {
                Some(place) => self.solve(draft, place.number),
                None => self.step(draft, current, operation, folding, common),
            }
        }
    }

    /// A solve, for which everything that it captures is there, behind the one whose matrix it uses.
    fn solve(&self, draft: &mut Draft, number: usize) {
        let implicit = &self.pool.implicit()[number];
        if let Some(earlier) = implicit.earlier()
            && !draft.solved.contains(&earlier)
        {
            self.solve(draft, earlier);
        }
        draft.solved.insert(number);
        let evaluated = implicit.evaluated();
        let (steps, results) = match implicit.method {
            Method::Newton { .. } => self.evaluation(draft, &evaluated),
            Method::Linear { .. } | Method::Slope { .. } => {
                (Vec::new(), self.operands(draft, &evaluated))
            }
        };
        draft.routine.steps.push(Step::Solve(Solve {
            number,
            solver: self.solver(number),
            size: implicit.unknowns.len(),
            steps,
            results,
        }));
    }

    fn solver(&self, number: usize) -> Solver {
        let implicit = self.pool.implicit();
        let newton = |it: &&Implicit| matches!(it.method, Method::Newton { .. });
        match implicit[number].method {
            Method::Newton { .. } => {
                Solver::Newton(implicit[..number].iter().filter(newton).count())
            }
            Method::Linear { kind, .. } => Solver::Linear(kind),
            Method::Slope { of, .. } => Solver::Slope(of),
        }
    }

    /// The steps of one evaluation of an iteration, and its results. Nothing that it works out is seen outside, since
    /// there the unknowns have their final values.
    fn evaluation(&self, draft: &mut Draft, evaluated: &[Expression]) -> (Vec<Step>, Vec<Operand>) {
        let outside = (draft.values.clone(), draft.reciprocals.clone());
        let before = std::mem::take(&mut draft.routine.steps);
        self.steps(draft, evaluated, false);
        let results = self.operands(draft, evaluated);
        (draft.values, draft.reciprocals) = outside;
        (std::mem::replace(&mut draft.routine.steps, before), results)
    }

    fn operands(&self, draft: &Draft, expressions: &[Expression]) -> Vec<Operand> {
        let operand = |expression: &Expression| self.operand(draft, *expression, false);
        expressions.iter().map(operand).collect()
    }

    fn step(
        &self,
        draft: &mut Draft,
        current: Expression,
        operation: &Operation,
        folding: bool,
        common: &Common,
    ) {
        let operand = |expression: &Expression| self.operand(draft, *expression, folding);
        let step = match operation {
            Operation::Constant(_) | Operation::Symbol(_) => return,
            Operation::Add(a, b) => Step::Add(operand(a), operand(b)),
            Operation::Multiply(a, b) => Step::Multiply(operand(a), operand(b)),
            Operation::Divide(a, b) if common.divisors.contains(&b.node()) => {
                let (dividend, divisor) = (operand(a), operand(b));
                let reciprocal = draft.reciprocal(b.node(), divisor);
                if *a == Expression::ONE {
                    draft.values[current.node()] = Some(reciprocal);
                    return;
                }
                Step::Multiply(dividend, Operand::plain(Source::Value(reciprocal)))
            }
            Operation::Divide(a, b) => Step::Divide(operand(a), operand(b)),
            Operation::Sine(a) | Operation::Cosine(a) => {
                let angle = operand(a);
                if let Some((sine, cosine)) = common.angles.get(&a.node()) {
                    let first = draft.push(
                        Step::SineCosine(angle),
                        &[self.name(*sine), self.name(*cosine)],
                    );
                    draft.values[*sine] = Some(first);
                    draft.values[*cosine] = Some(first + 1);
                    return;
                }
                if matches!(operation, Operation::Sine(_)) {
                    Step::Sine(angle)
                } else {
                    Step::Cosine(angle)
                }
            }
            Operation::Call(function, arguments) => {
                Step::Call(*function, arguments.iter().map(operand).collect())
            }
        };
        let value = draft.push(step, &[self.name(current.node())]);
        draft.values[current.node()] = Some(value);
    }

    fn name(&self, node: usize) -> String {
        self.names.get(&node).cloned().unwrap_or_default()
    }

    fn operand(&self, draft: &Draft, expression: Expression, folding: bool) -> Operand {
        let node = expression.node();
        let source = match self.pool.operation(expression) {
            Operation::Constant(value) => Source::Constant(*value),
            Operation::Symbol(Symbol::State(index)) => {
                Source::Symbol(Symbol::State((self.state)(*index)))
            }
            Operation::Symbol(symbol) => match self.pool.place(*symbol) {
                Some(place) => Source::Solved(place),
                None => Source::Symbol(*symbol),
            },
            _ => match (draft.values[node], self.folded[node]) {
                (_, Some(number)) if !folding => Source::Folded(number),
                (Some(value), _) => Source::Value(value),
                // No node is read before it is made; if one were, the check for finite numbers would refuse the program.
                _ => Source::Constant(f64::NAN),
            },
        };
        Operand {
            source,
            negative: expression.is_negative(),
        }
    }
}
