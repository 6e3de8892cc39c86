//! Stage 5c, sweeps: what several columns or rows of a Jacobian at once are worked out from.
//!
//! Input: rates and the variables that they depend on. Output: [`Slopes`], one list of steps for any direction. Forwards,
//! variables change and rates follow: a run gives a column, or several of which no two are in one rate. Backwards, rates have
//! weights and their sum says by what each variable is multiplied: a run gives a row, or several. The second list is the first read
//! from its end. An arm of seven joints has 14 variables and seven accelerations.

use std::collections::BTreeMap;

use crate::bits::Bits;
use crate::program::{Coverage, Direction, Line, Mode, Slopes, Unit};
use crate::sparsity::Pattern;
use crate::symbolic::substitute::{operations, visit};
use crate::symbolic::{
    Dependence, Differentiator, Expression, Operation, Pool, Symbol, transposed,
};

/// As many directions at once take as long as one step of a long code that is written out: what sweeps read is kept in
/// memory. Measured on arms, walkers and chains for AVX2 and AVX-512.
const TOGETHER: usize = 4;

/// A Jacobian that is to be worked out.
pub struct Wanted<'a> {
    /// What is differentiated.
    pub rates: &'a [Expression],
    /// By what.
    pub variables: &'a [Symbol],
    /// Which rates depend on which variables.
    pub pattern: &'a Pattern,
}

impl Wanted<'_> {
    /// A sweep that gives the columns of some variables.
    pub fn forward(&self, pool: &mut Pool, variables: &[usize]) -> Slopes {
        let mut forms = self.slopes(pool, variables);
        let units = take_units(pool, &mut forms);
        let columns = variables.iter().map(|variable| Line {
            number: *variable,
            entries: rows(&forms)
                .filter(|row| self.pattern[*row].contains(variable))
                .collect(),
        });
        Slopes {
            coverage: self.coverage(Mode::Forward, columns.collect(), units),
            forms,
        }
    }

    /// A sweep that gives all rows, if the rates' slopes can be read backwards.
    pub fn reverse(&self, pool: &mut Pool) -> Option<Slopes> {
        let every: Vec<usize> = (0..self.variables.len()).collect();
        let mut slopes = self.slopes(pool, &every);
        let units = take_units(pool, &mut slopes);
        let weighted: Vec<_> = rows(&slopes)
            .map(|row| (slopes[row], pool.symbol(Symbol::Slope(row))))
            .collect();
        let mut found = transposed(pool, &weighted)?;
        let forms = every.iter().map(|variable| found.remove(variable));
        let rows = rows(&slopes).map(|row| Line {
            number: row,
            entries: self.pattern[row].iter().copied().collect(),
        });
        Some(Slopes {
            coverage: self.coverage(Mode::Reverse, rows.collect(), units),
            forms: forms.map(|it| it.unwrap_or(Expression::ZERO)).collect(),
        })
    }

    /// About how many steps of a code that is written out take as long as these sweeps, each run through to its end.
    pub fn steps(&self, pool: &Pool, sweeps: &[Slopes]) -> usize {
        let steps = sweeps.iter().map(|sweep| {
            let runs = sweep.coverage.directions.len().div_ceil(TOGETHER);
            runs * self.beside(pool, &sweep.forms)
        });
        steps.sum()
    }

    /// The same if only that is gone through which one of the directions of a run changes. It tells sweeps apart, but not what
    /// each part that is left out costs.
    pub fn changing_steps(&self, pool: &Pool, sweeps: &[Slopes]) -> usize {
        let forms = sweeps.iter().flat_map(|it| it.forms.iter().copied());
        let forms: Vec<Expression> = forms.collect();
        let changing = sweeps.iter().map(|it| changing(pool, it));
        let changing: Vec<Vec<Bits>> = changing.collect();
        let once = self.beside(pool, &forms);
        let once = once.saturating_sub(changing.iter().map(Vec::len).sum());
        let runs = sweeps.iter().zip(&changing);
        let runs = runs.map(|(sweep, changing)| {
            let directions = sweep.coverage.directions.chunks(TOGETHER);
            let steps = directions.map(|together| {
                let lines = together.iter().flatten().map(|line| line.number);
                let lines: Bits = lines.collect();
                changing.iter().filter(|step| step.meets(&lines)).count()
            });
            steps.sum::<usize>()
        });
        once + runs.sum::<usize>()
    }

    /// How many steps expressions take beside the rates.
    pub fn beside(&self, pool: &Pool, others: &[Expression]) -> usize {
        operations(pool, &[self.rates, others].concat()) - operations(pool, self.rates)
    }

    /// How rates change where only some of the variables do.
    fn slopes(&self, pool: &mut Pool, changing: &[usize]) -> Vec<Expression> {
        let direction = changing.iter();
        let direction: BTreeMap<Symbol, Expression> = direction
            .map(|place| (self.variables[*place], pool.symbol(Symbol::Slope(*place))))
            .collect();
        let mut differentiator = Differentiator::along(direction);
        let rates = self.rates.iter();
        rates
            .map(|rate| differentiator.derivative(pool, *rate))
            .collect()
    }

    fn coverage(&self, mode: Mode, lines: Vec<Line>, units: Vec<Unit>) -> Coverage {
        Coverage {
            size: [self.rates.len(), self.variables.len()],
            mode,
            directions: directions(lines),
            units,
        }
    }
}

/// The rows that are worked out.
fn rows(slopes: &[Expression]) -> impl Iterator<Item = usize> {
    (0..slopes.len()).filter(|row| slopes[*row] != Expression::ZERO)
}

/// Takes out rates that change as one of the variables does: their rows need no steps.
fn take_units(pool: &Pool, slopes: &mut [Expression]) -> Vec<Unit> {
    let mut units = Vec::new();
    for (row, slope) in slopes.iter_mut().enumerate() {
        if let Operation::Symbol(Symbol::Slope(column)) = *pool.operation(*slope) {
            let negative = slope.is_negative();
            *slope = Expression::ZERO;
            units.push(Unit {
                row,
                column,
                negative,
            });
        }
    }
    units
}

/// Lines that share no entry, together: each goes with the first with which it can (Curtis, Powell and Reid, *J. Inst. Maths
/// Applics* 13 (1974), 117–119).
fn directions(lines: Vec<Line>) -> Vec<Direction> {
    let mut directions: Vec<(Bits, Direction)> = Vec::new();
    for line in lines.into_iter().filter(|line| !line.entries.is_empty()) {
        let own: Bits = line.entries.iter().copied().collect();
        match directions.iter_mut().find(|(taken, _)| !taken.meets(&own)) {
            Some((taken, direction)) => {
                taken.join(&own);
                direction.push(line);
            }
            None => directions.push((own, vec![line])),
        }
    }
    directions
        .into_iter()
        .map(|(_, direction)| direction)
        .collect()
}

/// In which lines each step of a sweep changes that changes in any.
fn changing(pool: &Pool, sweep: &Slopes) -> Vec<Bits> {
    let lines = sweep.coverage.directions.iter().flatten();
    let lines = lines.map(|line| line.number).max().map_or(0, |it| it + 1);
    let slopes: Vec<Symbol> = (0..lines).map(Symbol::Slope).collect();
    let dependence = Dependence::of(pool, &sweep.forms, &slopes);
    let mut changing = Vec::new();
    visit(pool, &sweep.forms, |node, operation| {
        let lines: Bits = dependence.places(node).collect();
        if !matches!(operation, Operation::Symbol(_)) && lines.len() > 0 {
            changing.push(lines);
        }
    });
    changing
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(directions: &[Direction]) -> Vec<Vec<usize>> {
        let of = |direction: &Direction| direction.iter().map(|it| it.number).collect();
        directions.iter().map(of).collect()
    }

    #[test]
    fn neighbours_in_a_row_change_alone() {
        let column = |number: usize| Line {
            number,
            entries: (number.saturating_sub(1)..(number + 2).min(7)).collect(),
        };
        let found = directions((0..7).map(column).collect());
        assert_eq!(numbers(&found), [vec![0, 3, 6], vec![1, 4], vec![2, 5]]);
        assert_eq!(found[0][1].entries, [2, 3, 4]);
        assert_eq!(
            numbers(&directions([1, 2, 5].map(column).to_vec())),
            [vec![1, 5], vec![2]]
        );
    }
}
