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
    /// Balances of which nothing is left, and the effort of the mass in each.
    pub(super) masses: Vec<(usize, Given)>,
    /// Rates to which an arm adds.
    pub(super) ends: BTreeMap<usize, End>,
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
    /// The velocity with which the arm turns.
    omega: [Expression; 3],
    /// Its length, if it is rigid.
    length: Option<[Expression; 3]>,
    /// What its end has of velocity more.
    velocity: [Expression; 3],
}

struct Carrier<'a> {
    system: &'a System,
    tree: &'a Tree,
    given: BTreeMap<usize, &'a Given>,
    vectors: &'a [Triple],
    /// The vectors of which each rate is a component.
    holding: BTreeMap<usize, Vec<Triple>>,
    velocity: &'a dyn Fn(usize) -> Expression,
    /// Value that each rate is counted from.
    values: BTreeMap<usize, Image>,
    left: BTreeMap<usize, Expression>,
}

impl Carried {
    /// None if nothing is gained.
    pub(super) fn of(
        pool: &mut Pool,
        system: &System,
        tree: &Tree,
        (vectors, frames): (&[Triple], &[Frame]),
        rows: &[Given],
        velocity: &dyn Fn(usize) -> Expression,
    ) -> Option<Self> {
        let mut carrier = Carrier {
            system,
            tree,
            given: rows.iter().map(|given| (given.unknown, given)).collect(),
            vectors,
            holding: holding(vectors),
            velocity,
            values: BTreeMap::new(),
            left: BTreeMap::new(),
        };
        let mut masses = Vec::new();
        let mut path: Vec<(Triple, Origin)> = Vec::new();
        // A moment of inertia about its principal axes has laws as a mass has, and is none.
        let turns = |vector: &Triple| frames.iter().any(|frame| frame.omega == *vector);
        for vector in vectors.iter().filter(|vector| !turns(vector)) {
            if let Some(mass) = carrier.mass(pool, vector)
                && let Some(branch) = carrier.branch(pool, *vector, &path)
            {
                path.extend(branch);
                for (rate, value, balance, law) in mass {
                    carrier.values.insert(rate, value);
                    masses.push((balance, law));
                }
            }
        }
        for (vector, origin) in &path {
            carrier.pass(pool, &path, *vector, *origin)?;
        }
        let left = std::mem::take(&mut carrier.left);
        let is_mass = |row| {
            let efforts = masses.iter().map(|(_, law): &(usize, Given)| law.unknown);
            let mut entries = efforts.map(|effort| system.entry(row, effort));
            entries.any(|entry| entry != Expression::ZERO)
        };
        let moves_more = |rate: &usize| {
            let mut rows = system.rows_with(*rate);
            rows.any(|row| match tree.given_by(row) {
                Some(given) => !left.contains_key(&given),
                None => !is_mass(row),
            })
        };
        let is_gain = !masses.is_empty() && !left.keys().any(moves_more);
        is_gain.then(|| Self {
            ends: path.iter().flat_map(ends).collect(),
            left,
            masses,
        })
    }
}

impl Carrier<'_> {
    /// If every component of a vector moves a mass: its rate, the value at which the efforts known there vanish, the
    /// balance of these efforts, and the law of the mass.
    fn mass(&self, pool: &Pool, vector: &Triple) -> Option<Vec<(usize, Image, usize, Given)>> {
        let component = |rate: &usize| {
            let others = self.system.rows_with(*rate);
            let inertia = only(others.filter(|row| self.tree.given_by(*row).is_none()))?;
            let effort = only(
                self.system
                    .row(inertia)
                    .filter(|(column, _)| column != rate),
            )?
            .0;
            let law = Given::of(self.system, inertia, effort)?;
            let balance = only(self.system.rows_with(effort).filter(|row| *row != inertia))?;
            let factor = pool.image(self.system.entry(balance, effort));
            let factor = factor.times(pool.image(law.terms[0].1)).inverted()?;
            let value = pool
                .image(self.system.right(balance))
                .times(factor)
                .negated();
            (law.constant == Expression::ZERO).then_some((*rate, value, balance, law))
        };
        vector.iter().map(component).collect()
    }

    /// The vectors from which a vector follows, and how, from the base on, but for those that are known already.
    fn branch(
        &self,
        pool: &mut Pool,
        vector: Triple,
        known: &[(Triple, Origin)],
    ) -> Option<Vec<(Triple, Origin)>> {
        let mut branch = Vec::new();
        let mut next = Some(vector);
        while let Some(vector) =
            next.filter(|vector| known.iter().all(|(other, _)| other != vector))
        {
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
            (None, _) if self.is_free(vector) => Origin::Base { arm: None },
            (None, _) => Origin::Base {
                arm: self.arm(pool, vector, &[usize::MAX; 3])?,
            },
            _ => return None,
        };
        Some(origin)
    }

    /// Whether a vector follows from independent rates alone, as the velocity of what flies does.
    fn is_free(&self, vector: &Triple) -> bool {
        vector.iter().all(|rate| {
            let terms = &self.given[rate].terms;
            let is_independent = |(cause, _): &(usize, Expression)| !self.given.contains_key(cause);
            !terms.is_empty() && terms.iter().all(is_independent)
        })
    }

    /// Whether a vector is at the base, or follows from another with its length.
    fn is_moved_itself(&self, pool: &Pool, vector: &Triple) -> bool {
        let terms = || vector.iter().flat_map(|rate| &self.given[rate].terms);
        let others = self.candidates(vector);
        let mut others = others.iter().filter(|other| *other != vector);
        terms().next().is_none()
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

    /// Passes the value on to a vector.
    fn pass(
        &mut self,
        pool: &mut Pool,
        path: &[(Triple, Origin)],
        vector: Triple,
        origin: Origin,
    ) -> Option<()> {
        let (values, left) = match origin {
            Origin::Base { arm } => {
                let values = self.above(pool, path, vector)?;
                let product = convection(pool, arm);
                let mut left = [Expression::ZERO; 3];
                for k in 0..3 {
                    let constant = pool.image(self.given[&vector[k]].constant);
                    let rest = constant.plus(values[k]).minus(pool.image(product[k]));
                    let rest = pool.find(rest)?;
                    left[k] = pool.add(rest, product[k]);
                }
                (values, left)
            }
            Origin::Moved { from, arm } => {
                let product = convection(pool, arm);
                let values = [0, 1, 2].map(|k| self.values[&from[k]].plus(pool.image(product[k])));
                let left = [0, 1, 2].map(|k| pool.add(self.given[&vector[k]].constant, product[k]));
                (values, left)
            }
            Origin::Turned { from } => {
                let matrix = self.images(pool, &vector, &from);
                let value = |k: usize| {
                    let start = pool.image(self.given[&vector[k]].constant).negated();
                    (0..3).fold(start, |sum, j| {
                        sum.plus(matrix[k][j].times(self.values[&from[j]]))
                    })
                };
                ([0, 1, 2].map(value), [Expression::ZERO; 3])
            }
        };
        for k in 0..3 {
            if *self.values.entry(vector[k]).or_insert(values[k]) != values[k] {
                return None;
            }
            self.left.insert(vector[k], left[k]);
        }
        Some(())
    }

    /// The value of a vector, from that of a mass that follows from it.
    fn above(
        &self,
        pool: &mut Pool,
        path: &[(Triple, Origin)],
        vector: Triple,
    ) -> Option<[Image; 3]> {
        if self.values.contains_key(&vector[0]) {
            return Some(vector.map(|rate| self.values[&rate]));
        }
        let follows = |(_, origin): &&(Triple, Origin)| match origin {
            Origin::Base { .. } => false,
            Origin::Moved { from, .. } | Origin::Turned { from } => *from == vector,
        };
        let (next, origin) = path.iter().find(follows)?;
        let values = self.above(pool, path, *next)?;
        if let Origin::Moved { arm, .. } = origin {
            let product = convection(pool, *arm);
            return Some([0, 1, 2].map(|k| values[k].minus(pool.image(product[k]))));
        }
        let matrix = self.images(pool, next, &vector);
        let ahead = [0, 1, 2].map(|k| values[k].plus(pool.image(self.given[&next[k]].constant)));
        let value =
            |k: usize| (0..3).fold(Image::ZERO, |sum, j| sum.plus(matrix[j][k].times(ahead[j])));
        Some([0, 1, 2].map(value))
    }

    /// What is added to a vector beyond another one; none if it does not follow from the turning of an arm.
    fn arm(&self, pool: &mut Pool, vector: &Triple, from: &Triple) -> Option<Option<Arm>> {
        let mut causes = Vec::new();
        let mut velocity = [Expression::ZERO; 3];
        let mut matrix: [BTreeMap<usize, Expression>; 3] = Default::default();
        for ((rate, sum), row) in vector.iter().zip(&mut velocity).zip(&mut matrix) {
            let terms = self.given[rate].terms.iter();
            for (column, coefficient) in terms.filter(|(column, _)| !from.contains(column)) {
                causes.extend(
                    self.given
                        .get(column)?
                        .terms
                        .iter()
                        .map(|(cause, _)| *cause),
                );
                for (cause, value) in &self.given[column].terms {
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
        Some(Some(Arm {
            turning,
            omega: turning.map(self.velocity),
            length: length(&matrix.map(|row| {
                turning.map(|rate| row.get(&rate).copied().unwrap_or(Expression::ZERO))
            })),
            velocity,
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
fn convection(pool: &mut Pool, arm: Option<Arm>) -> [Expression; 3] {
    let Some(Arm {
        omega, velocity, ..
    }) = arm
    else {
        return [Expression::ZERO; 3];
    };
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

/// Whether rows of length one at right angles are those of the identity; none if they are not such rows.
pub(super) fn is_orthonormal(matrix: &[[Image; 3]; 3]) -> Option<bool> {
    let unit = |a: usize, b: usize| if a == b { Image::ONE } else { Image::ZERO };
    let dot = |a: usize, b: usize| {
        (0..3).fold(Image::ZERO, |sum, k| {
            sum.plus(matrix[a][k].times(matrix[b][k]))
        })
    };
    let pairs = || (0..3).flat_map(|a| (0..3).map(move |b| (a, b)));
    pairs()
        .all(|(a, b)| dot(a, b) == unit(a, b))
        .then(|| pairs().all(|(a, b)| matrix[a][b] == unit(a, b)))
}
