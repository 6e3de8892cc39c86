//! Accelerations in space.
//!
//! A force acts on the acceleration in space, `dv/dt + ω × v − g`, which is cheaper than `dv/dt` in axes that turn: it
//! needs no linear velocity, and `g` enters at the base alone. So the rate of each linear velocity is counted from the
//! value at which the efforts that are known at the masses vanish. What a turn or an arm adds on the way from mass to
//! mass is nothing, or `ω × (ω × r)`.
//!
//! A shift by anything known is right. It is made if what it leaves in the rows is nothing or a product that is known,
//! and therefore passed on as a bare value ([`Image`]).

use std::collections::{BTreeMap, BTreeSet};

use super::bodies::Frame;
use super::eliminate::System;
use super::shift::Given;
use super::tree::Tree;
use crate::symbolic::field::Image;
use crate::symbolic::{Expression, Pool};

pub(super) type Triple = [usize; 3];

/// Rates that are counted from accelerations in space.
#[derive(Default)]
pub(super) struct Carried {
    /// What is left in the rows that give rates, where it is not what was there.
    pub(super) left: BTreeMap<usize, Expression>,
    /// Of the masses whose rates these are.
    pub(super) inertias: Vec<Inertia>,
    /// Rates to which an arm adds.
    pub(super) ends: BTreeMap<usize, End>,
}

/// A component of a mass.
pub(super) struct Inertia {
    pub(super) rate: usize,
    /// The row in which the efforts on it balance: its own law, if all of them are known.
    pub(super) balance: usize,
    /// What gives its effort, unless that is known.
    pub(super) law: Option<Given>,
    /// What is left in the balance.
    pub(super) left: Expression,
    /// Coefficient of the rate in the balance.
    coefficient: Image,
    /// Value of the rate at which the known efforts vanish.
    value: Image,
}

/// A component of a vector to which an arm adds.
#[derive(Clone, Copy)]
pub(super) struct End {
    /// The same of the vector at the arm's other end; none if that is at rest.
    pub(super) from: Option<usize>,
    /// The rate with which the arm turns.
    pub(super) omega: Triple,
    /// The arm.
    pub(super) arm: [Expression; 3],
    /// Which component it is.
    pub(super) component: usize,
}

/// How the rate of a vector follows from that of another.
#[derive(Clone, Copy)]
enum Origin {
    /// From none, or from rates that are independent, but for what an arm adds.
    Base { arm: Option<Arm> },
    /// In the same axes, but for what an arm adds.
    Moved { from: Triple, arm: Option<Arm> },
    /// In other axes.
    Turned { from: Triple },
}

/// What an arm adds to a vector.
#[derive(Clone, Copy)]
struct Arm {
    /// The rates with which the arm turns.
    turning: Triple,
    /// Its length, if it is rigid.
    length: Option<[Expression; 3]>,
    /// `ω × ṙ`, which is known.
    convection: [Expression; 3],
}

impl Arm {
    fn convection(arm: Option<Self>) -> [Expression; 3] {
        arm.map_or([Expression::ZERO; 3], |arm| arm.convection)
    }
}

struct Carrier<'a> {
    system: &'a System,
    tree: &'a Tree,
    given: BTreeMap<usize, &'a Given>,
    vectors: &'a [Triple],
    /// The vectors of which each rate is a component.
    holding: BTreeMap<usize, Vec<Triple>>,
    velocity: &'a dyn Fn(usize) -> Expression,
    /// The vectors of masses, and those that they follow from.
    path: Vec<(Triple, Origin)>,
    /// Value that each rate is counted from.
    values: BTreeMap<usize, Image>,
    left: BTreeMap<usize, Expression>,
}

impl Carried {
    /// Those of a block; none if rows besides need what rates are counted from.
    pub(super) fn of(
        pool: &mut Pool,
        system: &System,
        tree: &Tree,
        (vectors, frames): (&[Triple], &[Frame]),
        rows: &[Given],
        velocity: &dyn Fn(usize) -> Expression,
    ) -> Self {
        let mut carrier = Carrier {
            system,
            tree,
            given: rows.iter().map(|given| (given.unknown, given)).collect(),
            vectors,
            holding: holding(vectors),
            velocity,
            path: Vec::new(),
            values: BTreeMap::new(),
            left: BTreeMap::new(),
        };
        // A moment of inertia about its principal axes has laws as a mass has, and is none.
        let turns = |vector: &Triple| frames.iter().any(|frame| frame.omega == *vector);
        let masses = vectors.iter().filter(|vector| !turns(vector));
        let masses = masses.filter_map(|vector| Some((*vector, carrier.mass(pool, vector)?)));
        let mut open: Vec<(Triple, [Inertia; 3])> = masses.collect();
        let mut inertias = Vec::new();
        // Where a force is known beside gravity, the value at the base is found by another mass.
        loop {
            let fits = |(vector, mass): &mut _| carrier.take(pool, *vector, mass).is_some();
            let taken: Vec<(Triple, [Inertia; 3])> = open.extract_if(.., fits).collect();
            if taken.is_empty() {
                break;
            }
            inertias.extend(taken.into_iter().flat_map(|(_, mass)| mass));
        }
        if carrier.moves_more(&inertias) {
            return Self::default();
        }
        Self {
            ends: carrier.path.iter().flat_map(ends).collect(),
            left: carrier.left,
            inertias,
        }
    }
}

impl Carrier<'_> {
    /// The components of the mass that moves with a vector.
    fn mass(&self, pool: &Pool, vector: &Triple) -> Option<[Inertia; 3]> {
        let [x, y, z] = vector.map(|rate| self.inertia(pool, rate));
        Some([x?, y?, z?])
    }

    /// The inertia that a rate moves alone.
    fn inertia(&self, pool: &Pool, rate: usize) -> Option<Inertia> {
        let rows = self.system.rows_with(rate);
        let row = only(rows.filter(|row| self.tree.given_by(*row).is_none()))?;
        let mut others = self.system.row(row).filter(|(column, _)| *column != rate);
        let (balance, law, coefficient) = match others.next() {
            None => (row, None, pool.image(self.system.entry(row, rate))),
            // Where a loop is closed, a row may hold a rate of either end.
            Some((rate, _)) if self.tree.is_rate(rate) => return None,
            Some((effort, _)) => {
                let law = Given::of(self.system, row, effort)?;
                let balance = only(self.system.rows_with(effort).filter(|it| *it != row))?;
                let [(_, amount)] = *law.terms else {
                    return None;
                };
                (law.constant == Expression::ZERO).then_some(())?;
                let own = pool.image(self.system.entry(balance, effort));
                (balance, Some(law), own.times(pool.image(amount)))
            }
        };
        let known = self.system.right(balance);
        Some(Inertia {
            rate,
            balance,
            law,
            left: known,
            coefficient,
            value: pool.image(known).times(coefficient.inverted()?).negated(),
        })
    }

    /// Takes a mass that moves with a vector; none if it does not fit to those that are taken.
    fn take(&mut self, pool: &mut Pool, vector: Triple, mass: &mut [Inertia; 3]) -> Option<()> {
        let branch = self.branch(pool, vector)?;
        let own = [0, 1, 2].map(|k| mass[k].value);
        let passed = self.pass(pool, &branch, own)?;
        for inertia in &mut *mass {
            let passed = passed.get(&inertia.rate).map(|(value, _)| value);
            let value = *passed.or_else(|| self.values.get(&inertia.rate))?;
            let known = pool.image(self.system.right(inertia.balance));
            inertia.left = pool.find(known.plus(inertia.coefficient.times(value)))?;
        }
        for (rate, (value, left)) in passed {
            self.values.insert(rate, value);
            self.left.insert(rate, left);
        }
        self.path.extend(branch);
        Some(())
    }

    /// Whether other rows hold rates that are counted anew: what they are counted from, which nothing computes, is known in
    /// the rows of the path and in the balances of the masses alone.
    fn moves_more(&self, inertias: &[Inertia]) -> bool {
        let efforts = inertias.iter().filter_map(|it| it.law.as_ref());
        let efforts: BTreeSet<usize> = efforts.map(|law| law.unknown).collect();
        let balances: BTreeSet<usize> = inertias.iter().map(|it| it.balance).collect();
        let is_mass = |row: usize| {
            let mut columns = self.system.row(row).map(|(column, _)| column);
            balances.contains(&row) || columns.any(|column| efforts.contains(&column))
        };
        let mut rows = self
            .left
            .keys()
            .flat_map(|rate| self.system.rows_with(*rate));
        rows.any(|row| match self.tree.given_by(row) {
            Some(given) => !self.left.contains_key(&given),
            None => !is_mass(row),
        })
    }

    /// The vectors from which a vector follows, and how, from the base on, but for those that are known already.
    fn branch(&self, pool: &mut Pool, vector: Triple) -> Option<Vec<(Triple, Origin)>> {
        let mut branch = Vec::new();
        let mut next = Some(vector);
        let is_known = |vector: &Triple| self.path.iter().any(|(other, _)| other == vector);
        while let Some(vector) = next.filter(|vector| !is_known(vector)) {
            let origin = self.origin(pool, &vector)?;
            branch.push((vector, origin));
            next = match origin {
                Origin::Base { .. } => None,
                Origin::Moved { from, .. } | Origin::Turned { from } => Some(from),
            };
        }
        branch.reverse();
        Some(branch)
    }

    /// How the rate of a vector follows; none if in no such way.
    fn origin(&self, pool: &mut Pool, vector: &Triple) -> Option<Origin> {
        let mut causes = Vec::new();
        for rate in vector {
            causes.extend(self.given[rate].terms.iter().map(|(column, _)| *column));
        }
        let candidates = self.candidates(vector);
        let mut origins = candidates.into_iter().filter_map(|other| {
            let is_whole = causes.iter().all(|cause| other.contains(cause));
            match is_orthonormal(&self.images(pool, vector, &other))? {
                true if self.is_moved_itself(pool, &other) => Some((other, true)),
                false if is_whole => Some((other, false)),
                _ => None,
            }
        });
        let origin = match (origins.next(), origins.next()) {
            (Some((from, true)), None) => Origin::Moved {
                from,
                arm: self.arm(pool, vector, &from)?,
            },
            (Some((from, false)), None) => Origin::Turned { from },
            (None, _) => Origin::Base {
                arm: self.arm(pool, vector, &[usize::MAX; 3])?,
            },
            _ => return None,
        };
        Some(origin)
    }

    /// Whether a vector is at the base, or follows from another with its length.
    fn is_moved_itself(&self, pool: &Pool, vector: &Triple) -> bool {
        let mut terms = vector.iter().flat_map(|rate| &self.given[rate].terms);
        let others = self.candidates(vector);
        let mut others = others.iter().filter(|other| *other != vector);
        terms.all(|(cause, _)| !self.given.contains_key(cause))
            || others.any(|other| is_orthonormal(&self.images(pool, vector, other)).is_some())
    }

    /// Vectors that the first component of a vector follows from.
    fn candidates(&self, vector: &Triple) -> BTreeSet<Triple> {
        let terms = self.given[&vector[0]].terms.iter();
        let holding = terms.filter_map(|(cause, _)| self.holding.get(cause));
        holding.flatten().copied().collect()
    }

    /// Coefficients of one vector in the rows of another.
    fn coefficients(&self, vector: &Triple, other: &Triple) -> [[Expression; 3]; 3] {
        vector.map(|rate| {
            let terms = &self.given[&rate].terms;
            other.map(|column| {
                let term = terms.iter().find(|(cause, _)| *cause == column);
                term.map_or(Expression::ZERO, |(_, value)| *value)
            })
        })
    }

    fn images(&self, pool: &Pool, vector: &Triple, other: &Triple) -> [[Image; 3]; 3] {
        self.coefficients(vector, other)
            .map(|row| row.map(|entry| pool.image(entry)))
    }

    /// The values of a branch and what is left in its rows; `own` is the value at its end, if no other is known.
    fn pass(
        &self,
        pool: &mut Pool,
        branch: &[(Triple, Origin)],
        own: [Image; 3],
    ) -> Option<BTreeMap<usize, (Image, Expression)>> {
        let mut passed = BTreeMap::new();
        let mut values = [Image::ZERO; 3];
        for (vector, origin) in branch {
            let left;
            let known = |from: &Triple| match self.values.contains_key(&from[0]) {
                true => from.map(|rate| self.values[&rate]),
                false => values,
            };
            (values, left) = match origin {
                Origin::Base { arm } => {
                    let values = self.above(pool, branch, own);
                    let product = Arm::convection(*arm);
                    (values, self.rest(pool, vector, values, product)?)
                }
                Origin::Moved { from, arm } => {
                    let (from, product) = (known(from), Arm::convection(*arm));
                    let values = [0, 1, 2].map(|k| from[k].plus(pool.image(product[k])));
                    let constant = vector.map(|rate| self.given[&rate].constant);
                    let left = [0, 1, 2].map(|k| pool.add(constant[k], product[k]));
                    (values, left)
                }
                Origin::Turned { from } => {
                    let matrix = self.images(pool, vector, from);
                    let constants = self.constants(pool, vector);
                    let from = known(from);
                    let value = |k: usize| dot(&matrix[k], &from).minus(constants[k]);
                    ([0, 1, 2].map(value), [Expression::ZERO; 3])
                }
            };
            for k in 0..3 {
                let new = (values[k], left[k]);
                let before = self.values.get(&vector[k]);
                if before.is_some_and(|before| *before != values[k])
                    || passed.insert(vector[k], new).is_some_and(|it| it != new)
                {
                    return None;
                }
            }
        }
        Some(passed)
    }

    /// The value at the base of a branch, from that at its end.
    fn above(&self, pool: &Pool, branch: &[(Triple, Origin)], end: [Image; 3]) -> [Image; 3] {
        let mut values = end;
        for (vector, origin) in branch.iter().rev() {
            match origin {
                Origin::Base { .. } => break,
                Origin::Moved { arm, .. } => {
                    let product = Arm::convection(*arm);
                    values = [0, 1, 2].map(|k| values[k].minus(pool.image(product[k])));
                }
                Origin::Turned { from } => {
                    let constants = self.constants(pool, vector);
                    let turned = [0, 1, 2].map(|k| values[k].plus(constants[k]));
                    let matrix = self.images(pool, vector, from);
                    let column = |column: usize| matrix.map(|row| row[column]);
                    values = [0, 1, 2].map(|k| dot(&column(k), &turned));
                }
            }
        }
        values
    }

    /// What is left in the rows of a vector at the base, which is known by itself but for a product.
    fn rest(
        &self,
        pool: &mut Pool,
        vector: &Triple,
        values: [Image; 3],
        product: [Expression; 3],
    ) -> Option<[Expression; 3]> {
        let constants = self.constants(pool, vector);
        let mut left = product;
        for k in 0..3 {
            let rest = constants[k].plus(values[k]).minus(pool.image(product[k]));
            let rest = pool.find(rest)?;
            left[k] = pool.add(rest, product[k]);
        }
        Some(left)
    }

    fn constants(&self, pool: &Pool, vector: &Triple) -> [Image; 3] {
        vector.map(|rate| pool.image(self.given[&rate].constant))
    }

    /// What is added to a vector beyond another one; none if it does not follow from the turning of an arm.
    fn arm(&self, pool: &mut Pool, vector: &Triple, from: &Triple) -> Option<Option<Arm>> {
        let mut causes = Vec::new();
        let mut velocity = [Expression::ZERO; 3];
        let mut matrix: [BTreeMap<usize, Expression>; 3] = Default::default();
        // What an arm slides by is independent.
        let mut is_rigid = true;
        for ((rate, sum), row) in vector.iter().zip(&mut velocity).zip(&mut matrix) {
            let terms = self.given[rate].terms.iter();
            for (column, coefficient) in terms.filter(|(column, _)| !from.contains(column)) {
                self.tree.is_rate(*column).then_some(())?;
                let given = self.given.get(column);
                is_rigid &= given.is_some();
                let given = given.map_or(&[][..], |given| &given.terms);
                for (cause, value) in given {
                    causes.push(*cause);
                    let product = pool.multiply(*coefficient, *value);
                    let entry = row.entry(*cause).or_insert(Expression::ZERO);
                    *entry = pool.add(*entry, product);
                }
                let term = pool.multiply(*coefficient, (self.velocity)(*column));
                *sum = pool.add(*sum, term);
            }
        }
        if causes.is_empty() {
            return Some(None);
        }
        let holds_all = |other: &&Triple| causes.iter().all(|cause| other.contains(cause));
        let turning = *self.vectors.iter().find(holds_all)?;
        let length =
            length(&matrix.map(|row| {
                turning.map(|rate| row.get(&rate).copied().unwrap_or(Expression::ZERO))
            }));
        Some(Some(Arm {
            turning,
            length: length.filter(|_| is_rigid),
            convection: convection(pool, turning.map(self.velocity), velocity),
        }))
    }
}

/// The components of a vector to which a rigid arm adds.
fn ends((vector, origin): &(Triple, Origin)) -> Vec<(usize, End)> {
    let (from, arm) = match *origin {
        Origin::Moved {
            from,
            arm: Some(arm),
        } => (Some(from), arm),
        Origin::Base { arm: Some(arm) } => (None, arm),
        _ => return Vec::new(),
    };
    let end = |component: usize, length| End {
        from: from.map(|from| from[component]),
        omega: arm.turning,
        arm: length,
        component,
    };
    let components = arm.length.into_iter().flat_map(|length| {
        let component = |component: usize| (vector[component], end(component, length));
        [0, 1, 2].map(component)
    });
    components.collect()
}

/// The vectors of which each rate is a component.
fn holding(vectors: &[Triple]) -> BTreeMap<usize, Vec<Triple>> {
    let mut holding: BTreeMap<usize, Vec<Triple>> = BTreeMap::new();
    for vector in vectors {
        for rate in vector {
            holding.entry(*rate).or_default().push(*vector);
        }
    }
    holding
}

/// The vector `r` of a matrix that gives `ω × r`.
pub(super) fn length(matrix: &[[Expression; 3]; 3]) -> Option<[Expression; 3]> {
    let is_skew = (0..3)
        .all(|row| (0..=row).all(|column| matrix[row][column] == matrix[column][row].negated()));
    is_skew.then(|| [matrix[1][2], matrix[2][0], matrix[0][1]])
}

/// `ω × ṙ`.
fn convection(
    pool: &mut Pool,
    omega: [Expression; 3],
    velocity: [Expression; 3],
) -> [Expression; 3] {
    [0, 1, 2].map(|k| {
        let (next, last) = ((k + 1) % 3, (k + 2) % 3);
        let (scale, [forward, backward]) = common_scale(pool, [velocity[last], velocity[next]]);
        let first = pool.multiply(omega[next], forward);
        let second = pool.multiply(omega[last], backward);
        let difference = pool.subtract(first, second);
        pool.multiply(scale, difference)
    })
}

/// A scale that both parts have, and the parts without it.
///
/// So an arm along an axis is multiplied once, and the squares of rates beside it stand alone, as other arms need them.
fn common_scale(pool: &Pool, parts: [Expression; 2]) -> (Expression, [Expression; 2]) {
    let [(one, first), (other, second)] = parts.map(|part| pool.scaled(part.magnitude()));
    if one != other {
        return (Expression::ONE, parts);
    }
    let signed = |scaled: Expression, part: Expression| scaled.flipped(part.is_negative());
    (one, [signed(first, parts[0]), signed(second, parts[1])])
}

/// The one item.
fn only<T>(mut items: impl Iterator<Item = T>) -> Option<T> {
    let item = items.next()?;
    items.next().is_none().then_some(item)
}

pub(super) fn dot(a: &[Image; 3], b: &[Image; 3]) -> Image {
    (0..3).fold(Image::ZERO, |sum, k| sum.plus(a[k].times(b[k])))
}

/// Whether rows of length one at right angles are those of the identity; none if they are not such rows.
pub(super) fn is_orthonormal(matrix: &[[Image; 3]; 3]) -> Option<bool> {
    let unit = |a: usize, b: usize| if a == b { Image::ONE } else { Image::ZERO };
    let pairs = || (0..3).flat_map(|a| (0..3).map(move |b| (a, b)));
    pairs()
        .all(|(a, b)| dot(&matrix[a], &matrix[b]) == unit(a, b))
        .then(|| pairs().all(|(a, b)| matrix[a][b] == unit(a, b)))
}
