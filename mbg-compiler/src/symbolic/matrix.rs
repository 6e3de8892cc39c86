//! Matrices over the pool, and products that stay products.
//!
//! A rotation is known as a rotation: a [`Product`] keeps its factors, so that it can be applied axis by axis,
//! turned round by changing signs of angles, or split into transformers in a row.

use super::expression::Expression;
use super::field::Image;
use super::pool::Pool;

/// A dense matrix, by rows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Matrix {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// Entries by rows.
    pub entries: Vec<Expression>,
}

impl Matrix {
    /// From entries by rows.
    #[must_use]
    pub fn new(rows: usize, columns: usize, entries: Vec<Expression>) -> Self {
        debug_assert_eq!(entries.len(), rows * columns);
        Self {
            rows,
            columns,
            entries,
        }
    }

    /// A column.
    #[must_use]
    pub fn column(entries: Vec<Expression>) -> Self {
        Self::new(entries.len(), 1, entries)
    }

    /// With the given diagonal, zero elsewhere.
    #[must_use]
    pub fn diagonal(entries: &[Expression]) -> Self {
        let size = entries.len();
        let mut matrix = Self::new(size, size, vec![Expression::ZERO; size * size]);
        for (index, entry) in entries.iter().enumerate() {
            matrix.entries[index * size + index] = *entry;
        }
        matrix
    }

    /// Entry at (row, column).
    #[must_use]
    pub fn at(&self, row: usize, column: usize) -> Expression {
        self.entries[row * self.columns + column]
    }

    /// Transposed.
    #[must_use]
    pub fn transpose(&self) -> Self {
        let entries = (0..self.columns)
            .flat_map(|c| (0..self.rows).map(move |r| self.at(r, c)))
            .collect();
        Self::new(self.columns, self.rows, entries)
    }

    /// Product; the caller has compared the dimensions.
    #[must_use]
    pub fn times(&self, pool: &mut Pool, other: &Self) -> Self {
        let mut entries = Vec::with_capacity(self.rows * other.columns);
        for row in 0..self.rows {
            for column in 0..other.columns {
                let terms: Vec<_> = (0..self.columns)
                    .map(|k| pool.multiply(self.at(row, k), other.at(k, column)))
                    .collect();
                entries.push(pool.sum(&terms));
            }
        }
        Self::new(self.rows, other.columns, entries)
    }

    /// Entry by entry.
    #[must_use]
    pub fn map(&self, operation: impl FnMut(Expression) -> Expression) -> Self {
        Self::new(
            self.rows,
            self.columns,
            self.entries.iter().copied().map(operation).collect(),
        )
    }

    /// Whether all entries off the diagonal are zero.
    #[must_use]
    pub fn is_diagonal(&self) -> bool {
        self.rows == self.columns
            && (0..self.rows)
                .all(|r| (0..self.columns).all(|c| r == c || self.at(r, c) == Expression::ZERO))
    }

    /// Whether it equals its transpose.
    #[must_use]
    pub fn is_symmetric(&self) -> bool {
        *self == self.transpose()
    }

    /// Which rows to negate to make it symmetric, the first of those that belong together not being one; none if that
    /// does not make it so.
    #[must_use]
    pub fn signs_of_symmetry(&self) -> Option<Vec<bool>> {
        let mut signs = vec![None; self.rows];
        for first in 0..self.rows {
            if signs[first].is_some() {
                continue;
            }
            signs[first] = Some(false);
            let mut pending = vec![first];
            while let Some(row) = pending.pop() {
                for other in (0..self.rows).filter(|other| self.at(row, *other) != Expression::ZERO)
                {
                    let differs = self.at(row, other) != self.at(other, row);
                    let needed = signs[row].map(|sign| sign != differs);
                    if signs[other].is_none() {
                        signs[other] = needed;
                        pending.push(other);
                    }
                }
            }
        }
        let signs: Vec<bool> = signs.into_iter().flatten().collect();
        self.with_rows_negated(&signs)
            .is_symmetric()
            .then_some(signs)
    }

    /// The rows in an order in which the matrix equals its transpose but for signs of rows, if there is one: that of an inertia
    /// has one, also where its rows and its columns were sorted apart. It is looked for row by row, and not for long: hardly
    /// ever do as many entries agree that a row was taken in vain.
    #[must_use]
    pub fn order_of_symmetry(&self) -> Option<Vec<usize>> {
        let mut order = Vec::with_capacity(self.rows);
        let mut tries = self.rows * self.rows * self.rows;
        let is_found = self.ordered(&mut order, &mut tries);
        let has_signs = || self.with_rows(&order).signs_of_symmetry().is_some();
        (is_found && has_signs()).then_some(order)
    }

    /// Whether rows that go on from these were found.
    fn ordered(&self, order: &mut Vec<usize>, tries: &mut usize) -> bool {
        let place = order.len();
        if place == self.rows {
            return true;
        }
        for row in 0..self.rows {
            let is_like = |(other, before): (usize, &usize)| {
                self.at(row, other).magnitude() == self.at(*before, place).magnitude()
            };
            let fits = !order.contains(&row)
                && self.at(row, place) != Expression::ZERO
                && order.iter().enumerate().all(is_like);
            if !fits || *tries == 0 {
                continue;
            }
            *tries -= 1;
            order.push(row);
            if self.ordered(order, tries) {
                return true;
            }
            order.pop();
        }
        false
    }

    /// The same with its rows in another order.
    #[must_use]
    pub fn with_rows(&self, order: &[usize]) -> Self {
        let entries = order
            .iter()
            .flat_map(|row| (0..self.columns).map(|column| self.at(*row, column)));
        Self::new(order.len(), self.columns, entries.collect())
    }

    /// The same with some rows negated.
    #[must_use]
    pub fn with_rows_negated(&self, negated: &[bool]) -> Self {
        let entries = self.entries.iter().enumerate();
        let entries = entries.map(|(place, it)| it.flipped(negated[place / self.columns]));
        Self::new(self.rows, self.columns, entries.collect())
    }

    /// Determinant by minors along the rows, each minor once; meant for the small blocks that models have.
    #[must_use]
    pub fn determinant(&self, pool: &mut Pool) -> Expression {
        let all: Vec<usize> = (0..self.rows).collect();
        Minors::new(self).minor(pool, &all, &all)
    }

    /// The upper left part of a given size.
    #[must_use]
    pub fn leading(&self, size: usize) -> Self {
        let entries = (0..size)
            .flat_map(|row| (0..size).map(move |column| self.at(row, column)))
            .collect();
        Self::new(size, size, entries)
    }

    /// Adjugate: `A · adj A = det A · 1`.
    #[must_use]
    pub fn adjugate(&self, pool: &mut Pool) -> Self {
        let size = self.rows;
        let mut minors = Minors::new(self);
        let mut entries = Vec::with_capacity(size * size);
        for row in 0..size {
            for column in 0..size {
                let rows: Vec<usize> = (0..size).filter(|r| *r != column).collect();
                let columns: Vec<usize> = (0..size).filter(|c| *c != row).collect();
                entries.push(
                    minors
                        .minor(pool, &rows, &columns)
                        .flipped((row + column) % 2 == 1),
                );
            }
        }
        Self::new(size, size, entries)
    }

    /// Whether a square matrix is regular somewhere, by elimination at the points of the field.
    #[must_use]
    pub fn is_regular(&self, pool: &Pool) -> bool {
        let mut rows: Vec<Vec<Image>> = self
            .entries
            .chunks(self.columns)
            .map(|row| row.iter().map(|entry| pool.image(*entry)).collect())
            .collect();
        for column in 0..self.columns {
            let pivot =
                (column..self.rows).find_map(|row| Some((row, rows[row][column].inverted()?)));
            let Some((row, reciprocal)) = pivot else {
                return false;
            };
            rows.swap(column, row);
            let (above, below) = rows.split_at_mut(column + 1);
            for row in below {
                let factor = row[column].times(reciprocal);
                for (entry, above) in row.iter_mut().zip(&above[column]) {
                    *entry = entry.minus(factor.times(*above));
                }
            }
        }
        true
    }

    /// Inverse; none if it is identically singular. Diagonal matrices are inverted entry by entry.
    #[must_use]
    pub fn inverse(&self, pool: &mut Pool) -> Option<Self> {
        if self.is_diagonal() {
            let inverted: Option<Vec<_>> = (0..self.rows)
                .map(|k| pool.divide(Expression::ONE, self.at(k, k)))
                .collect();
            return Some(Self::diagonal(&inverted?));
        }
        let determinant = self.determinant(pool);
        let adjugate = self.adjugate(pool);
        let entries: Option<Vec<_>> = adjugate
            .entries
            .iter()
            .map(|entry| pool.divide(*entry, determinant))
            .collect();
        Some(Self::new(self.rows, self.columns, entries?))
    }
}

/// Minors of one matrix, each computed once.
struct Minors<'a> {
    matrix: &'a Matrix,
    known: std::collections::BTreeMap<(Vec<usize>, Vec<usize>), Expression>,
}

impl<'a> Minors<'a> {
    fn new(matrix: &'a Matrix) -> Self {
        Self {
            matrix,
            known: std::collections::BTreeMap::new(),
        }
    }

    fn minor(&mut self, pool: &mut Pool, rows: &[usize], columns: &[usize]) -> Expression {
        let Some((&first, rest)) = rows.split_first() else {
            return Expression::ONE;
        };
        let key = (rows.to_vec(), columns.to_vec());
        if let Some(known) = self.known.get(&key) {
            return *known;
        }
        let mut sum = Expression::ZERO;
        for (position, &column) in columns.iter().enumerate() {
            let entry = self.matrix.at(first, column);
            if entry == Expression::ZERO {
                continue;
            }
            let others: Vec<usize> = columns
                .iter()
                .copied()
                .filter(|other| *other != column)
                .collect();
            let minor = self.minor(pool, rest, &others);
            let term = pool.multiply(entry, minor).flipped(position % 2 == 1);
            sum = pool.add(sum, term);
        }
        self.known.insert(key, sum);
        sum
    }
}

/// One factor of a product.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Factor {
    /// The active rotation about axis 0, 1 or 2; its transpose is the one by the opposite angle.
    Rotation {
        /// 0, 1 or 2 for x, y or z.
        axis: usize,
        /// In radians.
        angle: Expression,
    },
    /// Eq. (8) of Tod et al. (2013): angular velocity of three concentric gimbals, in the axes before the first,
    /// from the rates of their angles. With axes i, j, k it has the columns `e_i`, `R_i e_j`, `R_i R_j e_k`.
    GimbalJacobian {
        /// The axes about which they turn, 0, 1 or 2 each.
        axes: [usize; 3],
        /// The gimbals' angles.
        angles: [Expression; 3],
        /// Whether it is transposed.
        transposed: bool,
    },
    /// Anything else.
    Dense(Matrix),
}

impl Factor {
    fn size(&self) -> (usize, usize) {
        match self {
            Self::Rotation { .. } | Self::GimbalJacobian { .. } => (3, 3),
            Self::Dense(matrix) => (matrix.rows, matrix.columns),
        }
    }

    /// Transposed.
    #[must_use]
    pub fn transpose(&self) -> Self {
        match self {
            Self::Rotation { axis, angle } => Self::Rotation {
                axis: *axis,
                angle: angle.negated(),
            },
            Self::GimbalJacobian {
                axes,
                angles,
                transposed,
            } => Self::GimbalJacobian {
                axes: *axes,
                angles: *angles,
                transposed: !transposed,
            },
            Self::Dense(matrix) => Self::Dense(matrix.transpose()),
        }
    }

    /// Entries.
    #[must_use]
    pub fn to_matrix(&self, pool: &mut Pool) -> Matrix {
        match self {
            Self::Rotation { axis, angle } => rotation(pool, *axis, *angle),
            Self::GimbalJacobian {
                axes,
                angles,
                transposed,
            } => {
                let matrix = gimbal_jacobian(pool, *axes, *angles);
                if *transposed {
                    matrix.transpose()
                } else {
                    matrix
                }
            }
            Self::Dense(matrix) => matrix.clone(),
        }
    }

    fn apply(&self, pool: &mut Pool, vector: &Matrix) -> Matrix {
        match self {
            Self::GimbalJacobian {
                axes,
                angles,
                transposed,
            } => apply_jacobian(pool, *axes, *angles, *transposed, vector),
            _ => self.to_matrix(pool).times(pool, vector),
        }
    }
}

/// A product of matrices, leftmost factor first; never empty.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Product {
    /// Leftmost first.
    pub factors: Vec<Factor>,
}

impl Product {
    /// One factor.
    #[must_use]
    pub fn of(factor: Factor) -> Self {
        Self {
            factors: vec![factor],
        }
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.factors.first().map_or(0, |factor| factor.size().0)
    }

    /// Number of columns.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.factors.last().map_or(0, |factor| factor.size().1)
    }

    /// Followed on the right by `other`.
    #[must_use]
    pub fn then(mut self, other: Self) -> Self {
        self.factors.extend(other.factors);
        self
    }

    /// Transposed.
    #[must_use]
    pub fn transpose(&self) -> Self {
        Self {
            factors: self.factors.iter().rev().map(Factor::transpose).collect(),
        }
    }

    /// Multiplied out.
    #[must_use]
    pub fn to_matrix(&self, pool: &mut Pool) -> Matrix {
        let mut factors = self.factors.iter().rev();
        let Some(last) = factors.next() else {
            return Matrix::column(Vec::new());
        };
        let mut matrix = last.to_matrix(pool);
        for factor in factors {
            matrix = factor.to_matrix(pool).times(pool, &matrix);
        }
        matrix
    }

    /// Applied to a column, factor by factor.
    #[must_use]
    pub fn apply(&self, pool: &mut Pool, vector: &Matrix) -> Matrix {
        self.factors
            .iter()
            .rev()
            .fold(vector.clone(), |vector, factor| factor.apply(pool, &vector))
    }
}

/// Active rotation about an axis.
fn rotation(pool: &mut Pool, axis: usize, angle: Expression) -> Matrix {
    let (sine, cosine) = (pool.sine(angle), pool.cosine(angle));
    let (first, second) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut matrix = Matrix::diagonal(&[Expression::ONE; 3]);
    matrix.entries[first * 3 + first] = cosine;
    matrix.entries[second * 3 + second] = cosine;
    matrix.entries[first * 3 + second] = sine.negated();
    matrix.entries[second * 3 + first] = sine;
    matrix
}

/// Its columns, by applying it to the unit vectors.
fn gimbal_jacobian(pool: &mut Pool, axes: [usize; 3], angles: [Expression; 3]) -> Matrix {
    let columns: Vec<Matrix> = (0..3)
        .map(|gimbal| {
            let rates = along(gimbal, Expression::ONE);
            apply_jacobian(pool, axes, angles, false, &rates)
        })
        .collect();
    let entries = (0..9).map(|entry| columns[entry % 3].at(entry / 3, 0));
    Matrix::new(3, 3, entries.collect())
}

/// In nested frames: `e_i v₀ + R_i (e_j v₁ + R_j e_k v₂)`, or the transposed of that.
fn apply_jacobian(
    pool: &mut Pool,
    axes: [usize; 3],
    angles: [Expression; 3],
    transposed: bool,
    vector: &Matrix,
) -> Matrix {
    if transposed {
        let inner = rotation(pool, axes[0], angles[0].negated()).times(pool, vector);
        let innermost = rotation(pool, axes[1], angles[1].negated()).times(pool, &inner);
        let frames = [vector, &inner, &innermost];
        let entries = frames
            .into_iter()
            .zip(axes)
            .map(|(frame, axis)| frame.at(axis, 0));
        return Matrix::column(entries.collect());
    }
    let mut sum = along(axes[2], vector.at(2, 0));
    for gimbal in [1, 0] {
        sum = rotation(pool, axes[gimbal], angles[gimbal]).times(pool, &sum);
        let entry = &mut sum.entries[axes[gimbal]];
        *entry = pool.add(*entry, vector.at(gimbal, 0));
    }
    sum
}

/// A vector of three along an axis.
fn along(axis: usize, value: Expression) -> Matrix {
    let mut entries = vec![Expression::ZERO; 3];
    entries[axis] = value;
    Matrix::column(entries)
}

#[cfg(test)]
mod tests {
    use super::super::Symbol;
    use super::*;

    fn angles(pool: &mut Pool) -> [Expression; 3] {
        [0, 1, 2].map(|index| pool.symbol(Symbol::State(index)))
    }

    fn turned(angles: &[Expression; 3]) -> Product {
        let factors = angles.iter().enumerate();
        let factors = factors.map(|(axis, angle)| Factor::Rotation {
            axis,
            angle: *angle,
        });
        Product {
            factors: factors.collect(),
        }
    }

    #[test]
    fn rotation_times_its_transpose_is_the_identity_node_for_node() {
        let mut pool = Pool::new();
        let angles = angles(&mut pool);
        let turn = turned(&angles);
        let product = turn.transpose().then(turn.clone()).to_matrix(&mut pool);
        assert_eq!(product, Matrix::diagonal(&[Expression::ONE; 3]));
        assert_eq!(
            turn.to_matrix(&mut pool).determinant(&mut pool),
            Expression::ONE
        );
    }

    #[test]
    fn rows_of_a_symmetric_matrix_are_found_in_any_order() {
        let mut pool = Pool::new();
        let symbol = |pool: &mut Pool, state| pool.symbol(Symbol::State(state));
        let entry = |row: usize, column: usize| row.min(column) * 5 + row.max(column);
        let mut entries = Vec::new();
        for (row, column) in (0..5).flat_map(|row| (0..5).map(move |column| (row, column))) {
            entries.push(symbol(&mut pool, entry(row, column)).flipped(row == 3));
        }
        let matrix = Matrix::new(5, 5, entries);
        let mixed = matrix.with_rows(&[3, 0, 4, 1, 2]);
        assert_eq!(mixed.order_of_symmetry(), Some(vec![1, 3, 4, 0, 2]));
        let mut other = mixed;
        other.entries[7] = symbol(&mut pool, 99);
        assert_eq!(other.order_of_symmetry(), None);
        // A mass whose balances are in axes that turn is none.
        let angles = angles(&mut pool);
        let turn = turned(&angles);
        let turn = turn.to_matrix(&mut pool).with_rows(&[2, 0, 1]);
        assert_eq!(turn.order_of_symmetry(), None);
    }

    #[test]
    fn rows_are_negated_where_that_makes_a_matrix_symmetric() {
        let mut pool = Pool::new();
        let [a, b, c] = angles(&mut pool);
        let (zero, minus) = (Expression::ZERO, b.negated());
        // The last row stands beside the others alone.
        let coupled = [a, b, zero, minus, c, zero, zero, zero, a.negated()];
        let matrix = Matrix::new(3, 3, coupled.to_vec());
        let signs = matrix.signs_of_symmetry().expect("it can be symmetric");
        assert_eq!(signs, [false, true, false]);
        assert!(matrix.with_rows_negated(&signs).is_symmetric());
        // Around the triangle one sign is left over, and two entries differ in more than their signs.
        let around = [a, b, c, b, a, b, minus, b, a];
        let apart = [a, b, c, a];
        for (size, entries) in [(3, &around[..]), (2, &apart)] {
            let matrix = Matrix::new(size, size, entries.to_vec());
            assert_eq!(matrix.signs_of_symmetry(), None, "{entries:?}");
        }
    }

    /// Three rotations, no two neighbours of which have one axis.
    fn sequences() -> impl Iterator<Item = [usize; 3]> {
        (0..27)
            .map(|number| [number / 9, number / 3 % 3, number % 3])
            .filter(|[first, second, third]| first != second && second != third)
    }

    #[test]
    fn determinant_of_the_gimbal_jacobian_is_cosine_or_sine_of_the_second_angle() {
        let mut pool = Pool::new();
        let angles = angles(&mut pool);
        assert_eq!(sequences().count(), 12);
        for axes in sequences() {
            let jacobian = Factor::GimbalJacobian {
                axes,
                angles,
                transposed: false,
            }
            .to_matrix(&mut pool);
            let expected = if axes[0] == axes[2] {
                pool.sine(angles[1])
            } else {
                pool.cosine(angles[1])
            };
            assert_eq!(jacobian.determinant(&mut pool).magnitude(), expected);
            let inverse = jacobian.inverse(&mut pool).unwrap();
            assert_eq!(
                inverse.times(&mut pool, &jacobian),
                Matrix::diagonal(&[Expression::ONE; 3])
            );
        }
    }

    #[test]
    fn applying_the_jacobian_in_nested_frames_equals_its_matrix() {
        let mut pool = Pool::new();
        let angles = angles(&mut pool);
        let vector = Matrix::column(
            (3..6)
                .map(|index| pool.symbol(Symbol::State(index)))
                .collect(),
        );
        for axes in sequences() {
            for transposed in [false, true] {
                let factor = Factor::GimbalJacobian {
                    axes,
                    angles,
                    transposed,
                };
                let nested = factor.apply(&mut pool, &vector);
                let dense = factor.to_matrix(&mut pool).times(&mut pool, &vector);
                assert_eq!(nested, dense);
            }
        }
    }
}
