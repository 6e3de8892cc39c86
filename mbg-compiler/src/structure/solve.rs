//! Solving the blocks one after another.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};

use super::bodies::Frame;
use super::congruence;
use super::eliminate::{System, Vanished};
use super::shift::Shift;
use super::tree::{Columns, Tree};
use super::{Failure, Formulation, Inverted, Loop, Solution};
use crate::elaborate::Condition;
use crate::equations::{Equation, Inertia, Owner, Scalars};
use crate::symbolic::{
    Differentiator, Expression, Function, Linear, Pool, Rate, Substitution, Symbol,
};

impl From<Vanished> for Failure {
    fn from(_: Vanished) -> Self {
        Self::Singular
    }
}

/// Solves blocks in the order given.
pub(super) fn blocks(
    scalars: &Scalars,
    formulation: Formulation,
    unknown_of: &[usize],
    order: &[Vec<usize>],
    pool: &mut Pool,
) -> Result<Solution, Failure> {
    let solution = Solution {
        values: vec![Expression::ZERO; scalars.unknowns],
        conditioning: Vec::new(),
        assumptions: Vec::new(),
        loops: Vec::new(),
    };
    let mut solver = Solver {
        scalars,
        formulation,
        pool,
        solution,
        known: vec![false; scalars.unknowns],
        signals_of: signals_of(scalars),
        substitution: Substitution::new(),
        current: Vec::new(),
    };
    for block in order {
        let unknowns: Vec<usize> = block.iter().map(|equation| unknown_of[*equation]).collect();
        solver.current.clone_from(&unknowns);
        solver.block(block, &unknowns)?;
    }
    Ok(solver.solution)
}

/// Signals that read each unknown.
fn signals_of(scalars: &Scalars) -> Vec<Vec<(usize, bool)>> {
    let mut readers = vec![Vec::new(); scalars.unknowns];
    for (number, (unknown, reversed)) in scalars.signals.iter().enumerate() {
        readers[*unknown].push((number, *reversed));
    }
    readers
}

/// Where each unknown stands in its block.
pub(super) fn places(unknowns: &[usize]) -> BTreeMap<usize, usize> {
    unknowns
        .iter()
        .enumerate()
        .map(|(place, unknown)| (*unknown, place))
        .collect()
}

/// What is known of a divisor.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Sign {
    Positive,
    NotNegative,
}

/// What is eliminated together with one independent rate.
#[derive(Default)]
struct Level {
    rows: BTreeSet<usize>,
    /// Columns, the deepest first.
    columns: BTreeMap<Reverse<usize>, BTreeSet<usize>>,
    /// The independent rate itself, which is eliminated by its inertia.
    last: Option<usize>,
}

/// An independent rate, the balance of efforts on it, and what is known of its inertia there.
struct Joint {
    row: usize,
    column: usize,
    sign: Sign,
}

pub(super) struct Solver<'a> {
    pub(super) scalars: &'a Scalars,
    formulation: Formulation,
    pub(super) pool: &'a mut Pool,
    pub(super) solution: Solution,
    known: Vec<bool>,
    signals_of: Vec<Vec<(usize, bool)>>,
    substitution: Substitution,
    /// The unknowns of the block that is being solved.
    current: Vec<usize>,
}

impl Solver<'_> {
    fn block(&mut self, equations: &[usize], unknowns: &[usize]) -> Result<(), Failure> {
        let scalars = self.scalars;
        let rows: Vec<&Equation> = equations
            .iter()
            .map(|equation| &scalars.equations[*equation])
            .collect();
        let place = places(unknowns);
        let reads_itself = |row: &&Equation| row.signals.iter().any(|it| place.contains_key(it));
        if rows.iter().any(reads_itself) {
            return self.by_tearing(equations, unknowns);
        }
        if unknowns
            .iter()
            .any(|unknown| scalars.turns[*unknown].is_some())
        {
            // In the order of the model and not in that of the matching, so that like parts come out alike.
            let sorted = |numbers: &[usize]| {
                let mut sorted = numbers.to_vec();
                sorted.sort_unstable();
                sorted
            };
            return self.by_levels(&sorted(equations), &sorted(unknowns));
        }
        let (mut matrix, mut right) = (Vec::new(), Vec::new());
        let mut norms = Vec::new();
        for row in &rows {
            let (coefficients, rest) = self.sparse_row(row, &place)?;
            norms.push(self.norm(row)?);
            matrix.push(coefficients);
            right.push(rest.negated());
        }
        let (values, divisor) = self.linear(System::new(matrix, right), unknowns, &norms)?;
        let by_law = rows
            .iter()
            .any(|row| matches!(row.owner, Owner::Element(..)));
        if unknowns.len() > 1 && (by_law || self.pool.rate(divisor) != Rate::Constant) {
            self.solution.loops.push(Loop {
                equations: equations.to_vec(),
                unknowns: unknowns.to_vec(),
                iterated: 0,
            });
        }
        self.store(unknowns, values);
        Ok(())
    }

    pub(super) fn store(&mut self, unknowns: &[usize], values: Vec<Expression>) {
        for (unknown, value) in unknowns.iter().zip(values) {
            self.solution.values[*unknown] = value;
            self.known[*unknown] = true;
            self.show(*unknown, value);
        }
    }

    /// Lets the signals that read an unknown have this value.
    pub(super) fn show(&mut self, unknown: usize, value: Expression) {
        for (signal, reversed) in &self.signals_of[unknown] {
            self.substitution
                .set(Symbol::Signal(*signal), value.flipped(*reversed));
        }
    }

    /// Solves a block of a reduced system from the leaves to the base. What belongs to one level is eliminated by
    /// constant pivots, and then by the inertia of its independent rate, if that is proven positive. The rest is
    /// solved as a whole.
    fn by_levels(&mut self, equations: &[usize], unknowns: &[usize]) -> Result<(), Failure> {
        let scalars = self.scalars;
        let place = places(unknowns);
        let mut rows = Vec::with_capacity(equations.len());
        let mut right = Vec::with_capacity(equations.len());
        for equation in equations {
            let (coefficients, rest) = self.sparse_row(&scalars.equations[*equation], &place)?;
            rows.push(coefficients);
            right.push(rest.negated());
        }
        let mut system = System::new(rows, right);
        let tree = Tree::of(scalars, equations, &place);
        let shift = self.shift(&mut system, &tree, unknowns, &place);
        let (matrix, right) = system.equations();
        let all: Columns = (0..equations.len()).collect();
        // The balance at a massless frame stays open until the level of the hinge that carries the frame.
        let mut passed = Columns::new();
        let mut joints = Vec::new();
        for (number, level) in self.levels(equations, unknowns) {
            if !scalars.closures.is_empty() {
                passed.clear();
            }
            passed.extend(&level.rows);
            let mut delayed = Columns::new();
            let moved = level
                .last
                .map(|last| tree.moved(&system, last))
                .unwrap_or_default();
            for columns in level.columns.into_values() {
                let (wait, now): (Columns, Columns) = columns.into_iter().partition(|column| {
                    tree.rate_of(*column).is_some_and(|rate| {
                        !moved.contains(&rate) && tree.is_turned(self.pool, &system, rate)
                    })
                });
                delayed.extend(wait);
                self.carry(&mut system, &tree, &level.rows, now)?;
            }
            if let Some(column) = level.last {
                self.gather(&mut system, &tree, &passed, column)?;
            }
            if let Some(column) = level.last
                && let Some(row) = tree.balance(&system, &passed, column)
                && self.is_inertia((&tree, &system), row, (number, equations[row]))
                && let Some(sign) = self.sign(number)
                && system.entry(row, column) != Expression::ZERO
            {
                delayed.extend(tree.frame(self.pool, &system, row));
                let joint = Joint { row, column, sign };
                match self.formulation {
                    Formulation::Articulated => self.release(&mut system, &joint)?,
                    Formulation::Composite => {
                        passed.remove(&row);
                        joints.push(joint);
                    }
                }
            }
            self.carry(&mut system, &tree, &all, delayed)?;
        }
        for joint in &joints {
            self.release(&mut system, joint)?;
        }
        let (rest, values) = if scalars.closures.is_empty() {
            self.rest(&mut system, &tree, unknowns)?
        } else {
            self.multipliers(&mut system, equations, unknowns)?
        };
        let mut values = system.back_substitute(self.pool, &rest.columns, &values)?;
        self.pool.solved(Linear {
            matrix,
            right,
            steps: system.into_steps(),
            rest,
            values: values.clone(),
        });
        if let Some(shift) = shift {
            shift.undo(self.pool, &mut values);
        }
        self.store(unknowns, values);
        Ok(())
    }

    /// Eliminates what is fixed to other rates, from the leaves on, in the balance on an independent rate among the rows given,
    /// or else the efforts for which there is none.
    fn gather(
        &mut self,
        system: &mut System,
        tree: &Tree,
        rows: &Columns,
        rate: usize,
    ) -> Result<(), Failure> {
        let all: Columns = (0..system.size()).collect();
        let mut open = system.open().len() + 1;
        // Ends where no pivot was found, so that each round but the last leaves fewer rows.
        while system.open().len() < open
            && let Some(fixed) = tree.fixed(self.pool, system, rows, rate)
        {
            open = system.open().len();
            self.carry(system, tree, &all, fixed)?;
        }
        let hindering = tree.hindering(system, rows, rate);
        self.carry(system, tree, rows, hindering)
    }

    /// Eliminates columns by constant pivots in the rows given.
    fn carry(
        &mut self,
        system: &mut System,
        tree: &Tree,
        rows: &Columns,
        columns: Columns,
    ) -> Result<(), Failure> {
        let admitted = |row, column| tree.admits(row, column);
        for columns in tree.in_order(columns) {
            congruence::prepare(self.pool, system, tree, &columns);
            system.eliminate_constants(self.pool, rows, &columns, &admitted)?;
        }
        Ok(())
    }

    /// Eliminates an independent rate by its inertia.
    fn release(&mut self, system: &mut System, joint: &Joint) -> Result<(), Failure> {
        if joint.sign == Sign::NotNegative {
            self.note(system.entry(joint.row, joint.column), &[]);
        }
        system.eliminate(self.pool, joint.row, joint.column)?;
        Ok(())
    }

    fn shift(
        &mut self,
        system: &mut System,
        tree: &Tree,
        unknowns: &[usize],
        place: &BTreeMap<usize, usize>,
    ) -> Option<Shift> {
        let rate_of = &self.scalars.rate_of;
        let rate = |unknown: &usize| {
            let rate = place.get(rate_of.get(unknown)?).copied();
            rate.filter(|rate| tree.is_given(*rate))
        };
        let vectors: BTreeSet<[usize; 3]> = self
            .scalars
            .wires
            .iter()
            .filter_map(|wire| {
                let rates = wire.iter().map(|pair| pair.iter().find_map(rate));
                rates.collect::<Option<Vec<usize>>>()?.try_into().ok()
            })
            .collect();
        let vectors: Vec<[usize; 3]> = vectors.into_iter().collect();
        let common = self.scalars.common.iter();
        let triple = |flows: &[usize]| -> Option<[usize; 3]> {
            let rates: Option<Vec<usize>> = flows.iter().map(rate).collect();
            rates?.try_into().ok()
        };
        let frames = common.filter(|flows| flows.len() == 6);
        let frames = frames.filter_map(|flows| {
            let (omega, origin) = flows.split_at(3);
            Some(Frame {
                omega: triple(omega)?,
                origin: triple(origin),
            })
        });
        let frames: Vec<Frame> = frames.collect();
        let unknown_of: BTreeMap<usize, usize> = rate_of
            .iter()
            .map(|(unknown, rate)| (*rate, *unknown))
            .collect();
        let values = &self.solution.values;
        let velocity = |column: usize| values[unknown_of[&unknowns[column]]];
        Shift::of(self.pool, system, tree, (&vectors, &frames), &velocity)
    }

    /// Rows and columns of a block by level.
    fn levels(&self, equations: &[usize], unknowns: &[usize]) -> BTreeMap<usize, Level> {
        let mut levels: BTreeMap<usize, Level> = BTreeMap::new();
        for (row, equation) in equations.iter().enumerate() {
            if let Some(level) = self.scalars.equations[*equation].level {
                levels.entry(level).or_default().rows.insert(row);
            }
        }
        for (column, unknown) in unknowns.iter().enumerate() {
            let Some(turn) = self.scalars.turns[*unknown] else {
                continue;
            };
            let level = levels.entry(turn.level).or_default();
            match self.scalars.independent.get(&turn.level) {
                Some(independent) if independent.unknown == *unknown => level.last = Some(column),
                _ => {
                    let deepest = level.columns.entry(Reverse(turn.depth)).or_default();
                    deepest.insert(column);
                }
            }
        }
        levels
    }

    /// What is known of the inertia that a level divides by. It is positive at every state where some storage with a
    /// positive definite law moves with the level's own rate, however the state, while all levels below are held. Where
    /// all laws are definite it is never negative, and zero only where the whole block is singular: a semidefinite
    /// matrix with a singular leading part is singular.
    fn sign(&mut self, level: usize) -> Option<Sign> {
        let (state, storages) = match &self.scalars.independent.get(&level)?.inertia {
            Inertia::Unknown => return None,
            Inertia::Own => return Some(Sign::Positive),
            Inertia::Moved { state, storages } => (*state, storages),
        };
        let mut slope = Differentiator::new(Symbol::State(state));
        let mut always = false;
        for unknowns in storages {
            let squares: Vec<Expression> = unknowns
                .iter()
                .map(|unknown| {
                    let column = slope.derivative(self.pool, self.solution.values[*unknown]);
                    self.pool.multiply(column, column)
                })
                .collect();
            let sum = self.pool.sum(&squares);
            always |= self.pool.constant_value(sum).is_some_and(|sum| sum > 0.0);
        }
        Some(if always {
            Sign::Positive
        } else {
            Sign::NotNegative
        })
    }

    /// Whether what an equation is about moves with the level's own rate. The balance at a junction that does not is that of
    /// another rate, such as one by which a bearing below gives way: what this rate has there is no inertia, and may vanish.
    fn moves(&mut self, level: usize, equation: usize) -> bool {
        let independent = self.scalars.independent.get(&level);
        let Some(Inertia::Moved { state, .. }) = independent.map(|it| &it.inertia) else {
            return true;
        };
        let mut slope = Differentiator::new(Symbol::State(*state));
        let about = self.scalars.equations[equation].about;
        let mut values = about
            .into_iter()
            .map(|unknown| self.solution.values[unknown]);
        values.any(|value| slope.derivative(self.pool, value) != Expression::ZERO)
    }

    /// Whether a level's own rate has an inertia in a row, which is an equation: not beside the rate of a level further out that
    /// is still there. The row is the balance of both together by then, and its columns are each for itself.
    fn is_inertia(
        &mut self,
        (tree, system): (&Tree, &System),
        row: usize,
        (level, equation): (usize, usize),
    ) -> bool {
        let is_alone = self.formulation == Formulation::Composite
            || !tree.holds_level_before(system, row, level);
        is_alone && self.moves(level, equation)
    }

    /// Coefficients of the block's unknowns, and the sum of what is known.
    pub(super) fn sparse_row(
        &mut self,
        row: &Equation,
        place: &BTreeMap<usize, usize>,
    ) -> Result<(BTreeMap<usize, Expression>, Expression), Failure> {
        let mut coefficients = BTreeMap::new();
        let mut rest = self.replaced(row.constant)?;
        for (unknown, coefficient) in &row.terms {
            let coefficient = self.replaced(*coefficient)?;
            match place.get(unknown) {
                Some(position) if coefficient != Expression::ZERO => {
                    coefficients.insert(*position, coefficient);
                }
                Some(_) => {}
                None => {
                    debug_assert!(self.known[*unknown], "blocks come in order of need");
                    let value = self.solution.values[*unknown];
                    let term = self.pool.multiply(coefficient, value);
                    rest = self.pool.add(rest, term);
                }
            }
        }
        Ok((coefficients, rest))
    }

    fn replaced(&mut self, expression: Expression) -> Result<Expression, Failure> {
        if self.scalars.signals.is_empty() {
            return Ok(expression);
        }
        self.substitution
            .apply(self.pool, expression)
            .ok_or(Failure::Singular)
    }

    /// Euclidean norm of the coefficients that vary; 1 if there are fewer than two of them.
    fn norm(&mut self, row: &Equation) -> Result<Expression, Failure> {
        let mut squares = Vec::new();
        for coefficient in row.terms.values() {
            let coefficient = self.replaced(*coefficient)?;
            if self.pool.rate(coefficient) == Rate::Varying {
                squares.push(self.pool.multiply(coefficient, coefficient));
            }
        }
        if squares.len() < 2 {
            return Ok(Expression::ONE);
        }
        let sum = self.pool.sum(&squares);
        Ok(self.pool.call(Function::Sqrt, &[sum]))
    }

    /// Remembers what was divided by.
    pub(super) fn note(&mut self, divisor: Expression, norms: &[Expression]) {
        match self.pool.rate(divisor) {
            Rate::Constant => {}
            Rate::Parameter => {
                let entry = (divisor.magnitude(), Condition::NonZero);
                if !self.solution.assumptions.contains(&entry) {
                    self.solution.assumptions.push(entry);
                }
            }
            Rate::Varying => {
                let mut normalised = divisor;
                for norm in norms {
                    if let Some(quotient) = self.pool.divide(normalised, *norm) {
                        normalised = quotient;
                    }
                }
                let normalised = normalised.magnitude();
                let known = &mut self.solution.conditioning;
                if known.iter().all(|it| it.normalised != normalised) {
                    let unknowns = self.current.clone();
                    known.push(Inverted {
                        normalised,
                        unknowns,
                    });
                }
            }
        }
    }
}
