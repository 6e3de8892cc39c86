//! Symmetric positive semidefinite systems, singular ones included.

use nalgebra::{SMatrix, SVector};

use super::definite::{Definite, Factors};
use super::{Order, dot, everywhere, exchanged, largest};
use crate::Real;

/// In units of precision, size and largest diagonal element: a pivot below it is rounding.
const RANK: f64 = 8.0;
/// In units of the largest diagonal element: rows below it are brought to its size.
const SMALL: f64 = 1e-4;
/// In units of the largest diagonal element: a matrix whose pivots are all above it needs no exchanges. In units of its own: it
/// needs none either, but a step of refinement.
const REGULAR: f64 = 1e-4;
/// Up to this size a regular matrix is factorised without exchanges. Larger ones take their time anyway, and are refined.
const SHORT: usize = 32;

/// What [`least_norm`] found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeastNorm<T, const K: usize> {
    /// The solution of least norm.
    pub solution: SVector<T, K>,
    /// Rank of the matrix; of several lanes the largest.
    pub rank: usize,
    /// `max |b − S λ|`, relative to `max |b|`: of the order of the precision when the system is consistent.
    pub residual: T,
}

/// The `λ` of least norm of the consistent system `S λ = b` with `S` symmetric and positive semidefinite.
///
/// Such are the multipliers of closed loops, `S = G M⁻¹ Gᵀ`: singular where constraints are redundant or become so in
/// passing, and then the forces `Gᵀ λ` are the same for every solution. Only the lower triangle of `S` decides on the
/// rank.
///
/// `S` is factorised as `P S Pᵀ = L Lᵀ` with the largest remaining diagonal element as the next pivot (Higham,
/// *Accuracy and Stability of Numerical Algorithms*, 2nd ed., 10.3). **The rank** is the number of pivots above
/// `8 K ε max Sᵢᵢ`. That is the level of rounding in `S` and no more, on purpose: near a singular position a smaller
/// pivot still carries a force, and ignoring it errs more than its rounding does. Constraints of lengths and of angles stand
/// side by side, and those of small machines are small: a row is brought to the size of the largest one first, unless `√Sᵢᵢ`,
/// which is the size of the constraint's own row in `G`, is below `8 K ε` of that of the largest, as rounding is.
///
/// With the rank `r`, `λ = L (LᵀL)⁻² Lᵀ b` is the solution of least norm. It is computed without the loss of digits of
/// that formula: remove from `b` its part in the null space, solve the `r` equations of the pivots, and remove from
/// `λ` its part in the null space, which `[−L₂₁ L₁₁⁻¹, 1]ᵀ` spans with a good condition. A regular matrix has no null
/// space and is solved as usual, without exchanges where it is far from singular, and otherwise one step of iterative
/// refinement follows. If `b` is not consistent the result is the
/// least-squares solution of least norm.
///
/// # Example
///
/// ```
/// use mbg_runtime::solve::least_norm;
/// use nalgebra::{SMatrix, SVector};
///
/// // The same constraint twice: each multiplier takes half of the force.
/// let found = least_norm(&SMatrix::from([[2.0, 2.0], [2.0, 2.0]]), &SVector::from([6.0, 6.0]));
/// assert_eq!(found.rank, 1);
/// assert!((found.solution - SVector::from([1.5, 1.5])).norm() < 1e-15);
/// ```
#[must_use]
#[inline]
pub fn least_norm<T: Real, const K: usize>(
    matrix: &SMatrix<T, K, K>,
    right: &SVector<T, K>,
) -> LeastNorm<T, K> {
    Semidefinite::new(*matrix).solve(right)
}

/// `b − S λ`.
fn remainder<T: Real, const K: usize>(
    matrix: &SMatrix<T, K, K>,
    solution: &SVector<T, K>,
    right: &SVector<T, K>,
) -> SVector<T, K> {
    let mut remainder = *right;
    for (column, x) in matrix.data.0.iter().zip(solution.as_slice()) {
        for (remainder, element) in remainder.as_mut_slice().iter_mut().zip(column) {
            *remainder -= *element * *x;
        }
    }
    remainder
}

/// A symmetric positive semidefinite matrix, factorised for any number of right sides: see [`least_norm`].
#[derive(Clone, Debug)]
pub struct Semidefinite<T, const K: usize> {
    matrix: SMatrix<T, K, K>,
    factors: Factors<T, Careful<T, K>, K>,
}

impl<T: Real, const K: usize> Semidefinite<T, K> {
    /// Factorises the matrix, of which the lower triangle decides on the rank.
    #[must_use]
    #[inline]
    pub fn new(matrix: SMatrix<T, K, K>) -> Self {
        Self::of_rank(matrix, T::from_f64(K as f64))
    }

    /// The same where no more than so many pivots are other than zero, as is known from elsewhere: errors that are larger
    /// than rounding make more.
    #[must_use]
    #[inline]
    pub fn of_rank(matrix: SMatrix<T, K, K>, rank: T) -> Self {
        let careful = || Careful::new(matrix, rank);
        let factors = if K <= SHORT && everywhere(rank, |rank| rank >= K as f64) {
            let bound = T::from_f64(REGULAR) * largest((0..K).map(|i| matrix[(i, i)]));
            let one = T::from_f64(1.0);
            Factors::of(Definite::new(&matrix, one, |_| bound), careful)
        } else {
            Factors::Other(careful())
        };
        Self { matrix, factors }
    }

    /// The solution of least norm with this right side.
    #[must_use]
    #[inline]
    pub fn solve(&self, right: &SVector<T, K>) -> LeastNorm<T, K> {
        let solution = self.solution(right);
        let rank = match &self.factors {
            Factors::Other(Careful(Factors::Other(pivoted))) => pivoted.rank,
            _ => K,
        };
        let zero = T::from_f64(0.0);
        let size = largest(right.data.0[0]);
        let residual = largest(remainder(&self.matrix, &solution, right).data.0[0]);
        LeastNorm {
            solution,
            rank,
            residual: residual / zero.select_less(size, size, T::from_f64(1.0)),
        }
    }

    /// The solution alone.
    #[must_use]
    #[inline]
    pub fn solution(&self, right: &SVector<T, K>) -> SVector<T, K> {
        self.factors.solution(right, self.careful())
    }

    /// The same for several right sides, as many as the scalar takes [columns](crate::Columns) at once.
    #[must_use]
    #[inline]
    pub fn columns(&self, right: &[T::Columns; K]) -> [T::Columns; K] {
        self.factors.columns(right, self.careful())
    }

    fn careful(&self) -> impl Fn(&Careful<T, K>, &SVector<T, K>) -> SVector<T, K> {
        |careful, right| careful.refined(&self.matrix, right)
    }
}

/// Factors of a matrix whose pivots differ much, because of the units of its rows or next to a singular position: without
/// exchanges where each pivot is large beside its own diagonal element, and that is no rounding.
#[derive(Clone, Debug)]
struct Careful<T, const K: usize>(Factors<T, Pivoted<T, K>, K>);

impl<T: Real, const K: usize> Careful<T, K> {
    #[cold]
    #[inline(never)]
    fn new(matrix: SMatrix<T, K, K>, rank: T) -> Self {
        let pivoted = || Pivoted::new(matrix, rank);
        if K > SHORT || !everywhere(rank, |rank| rank >= K as f64) {
            return Self(Factors::Other(pivoted()));
        }
        let lost = T::from_f64(rounding::<T, K>()) * largest((0..K).map(|i| matrix[(i, i)]));
        let [one, part, never] = [1.0, REGULAR, f64::INFINITY].map(T::from_f64);
        let bound = |own: T| lost.select_less(own, part * own, never);
        Self(Factors::of(Definite::new(&matrix, one, bound), pivoted))
    }

    /// The solution of least norm after one step of iterative refinement.
    #[cold]
    #[inline(never)]
    fn refined(&self, matrix: &SMatrix<T, K, K>, right: &SVector<T, K>) -> SVector<T, K> {
        let first = self.0.solution(right, Pivoted::least_squares);
        let left = remainder(matrix, &first, right);
        let refinement = self.0.solution(&left, Pivoted::least_squares);
        first.zip_map(&refinement, |first, refinement| first + refinement)
    }
}

/// The rank of each lane, as [`least_norm`] tells it.
pub(super) fn rank<T: Real, const K: usize>(matrix: SMatrix<T, K, K>) -> T {
    let factors = Pivoted::new(matrix, T::from_f64(K as f64));
    let kept = factors.kept.iter();
    kept.fold(T::from_f64(0.0), |rank, kept| rank + *kept)
}

/// In units of the largest diagonal element: one that is no larger is rounding.
fn rounding<T: Real, const K: usize>() -> f64 {
    let part = RANK * K as f64 * T::EPSILON;
    part * part
}

/// What brings each row and column that is small, and more than rounding, to the size of the largest.
fn scales<T: Real, const K: usize>(matrix: &SMatrix<T, K, K>) -> [T; K] {
    let one = T::from_f64(1.0);
    let size = largest((0..K).map(|i| matrix[(i, i)]));
    let [small, lost] = [SMALL, rounding::<T, K>()].map(|bound| T::from_f64(bound) * size);
    core::array::from_fn(|i| {
        let own = matrix[(i, i)];
        let needed = own.select_less(small, lost.select_less(own, own, size), size);
        needed.select_less(size, (size / needed).sqrt(), one)
    })
}

/// `P D S D Pᵀ = L Lᵀ` with the largest remaining diagonal element as the next pivot.
#[derive(Clone, Debug)]
struct Pivoted<T, const K: usize> {
    /// `L`, in the order of the pivots. In lanes that have ended a column is that of the identity.
    lower: [[T; K]; K],
    /// Reciprocals of its diagonal, zero in the lanes where a pivot does not count.
    inverse: [T; K],
    order: Order<T, K>,
    /// What rows and columns were multiplied by, in the order of the pivots.
    scale: [T; K],
    /// 1 in the lanes where a pivot counts, else 0.
    kept: [T; K],
    /// The first pivot that counts in no lane.
    rank: usize,
    /// Orthonormal vectors that span the null space, in the order of the pivots, from index `regular` on. A vector is
    /// zero in lanes that are regular there.
    null: [[T; K]; K],
    /// The first pivot that does not count in every lane.
    regular: usize,
}

impl<T: Real, const K: usize> Pivoted<T, K> {
    fn new(matrix: SMatrix<T, K, K>, most: T) -> Self {
        let zero = T::from_f64(0.0);
        let scale = scales(&matrix);
        let mut lower = matrix.transpose().data.0;
        for (row, by) in lower.iter_mut().zip(scale) {
            for (element, other) in row.iter_mut().zip(scale) {
                *element = by * other * *element;
            }
        }
        let mut factors = Self {
            lower,
            inverse: [zero; K],
            order: Order::unchanged(),
            scale,
            kept: [zero; K],
            rank: K,
            null: [[zero; K]; K],
            regular: K,
        };
        factors.factorise(most);
        factors.scale = factors.order.apply(&scale);
        factors.span_null_space();
        factors
    }

    /// With `most` pivots at most.
    fn factorise(&mut self, most: T) {
        let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
        let threshold =
            T::from_f64(RANK * K as f64 * T::EPSILON) * largest((0..K).map(|i| self.lower[i][i]));
        for k in 0..K {
            self.bring_largest(k);
            let pivot = self.lower[k][k];
            let kept = threshold.select_less(pivot, one, zero);
            let kept = T::from_f64(k as f64).select_less(most, kept, zero);
            if self.regular == K && !everywhere(kept, |lane| lane == 1.0) {
                self.regular = k;
            }
            if everywhere(kept, |lane| lane == 0.0) {
                self.rank = k;
                return;
            }
            self.kept[k] = kept;
            let root = zero.select_less(kept, pivot, one).sqrt();
            self.lower[k][k] = root;
            let inverse = kept / root;
            self.inverse[k] = inverse;
            let mut column = [zero; K];
            for i in k + 1..K {
                column[i] = inverse * self.lower[i][k];
                self.lower[i][k] = column[i];
                let factor = column[i];
                let row = self.lower[i][k + 1..=i].iter_mut();
                for (element, other) in row.zip(&column[k + 1..=i]) {
                    *element -= factor * *other;
                }
            }
        }
    }

    /// Exchanges rows and columns so that the largest remaining diagonal element is number `k`.
    fn bring_largest(&mut self, k: usize) {
        let top = (k..K).fold(self.lower[k][k], |top, i| top.max(self.lower[i][i]));
        for i in k + 1..K {
            let (here, there) = (self.lower[k][k], self.lower[i][i]);
            let sizes = (here, there.select_less(top, here, there));
            if everywhere(sizes.0 - sizes.1, |difference| difference >= 0.0) {
                continue;
            }
            let mut exchange =
                |(row, column): (usize, usize), (other_row, other_column): (usize, usize)| {
                    let pair = (self.lower[row][column], self.lower[other_row][other_column]);
                    let (a, b) = exchanged(sizes.0, sizes.1, pair);
                    self.lower[row][column] = a;
                    self.lower[other_row][other_column] = b;
                };
            exchange((k, k), (i, i));
            (0..k).for_each(|j| exchange((k, j), (i, j)));
            (k + 1..i).for_each(|j| exchange((j, k), (i, j)));
            (i + 1..K).for_each(|j| exchange((j, k), (j, i)));
            self.order.exchange(sizes, i, k);
        }
    }

    /// From `L₁₁ᵀ x = L₂₁ᵀ`, made orthonormal by Gram and Schmidt.
    fn span_null_space(&mut self) {
        let one = T::from_f64(1.0);
        for index in self.regular..K {
            let mut vector = [T::from_f64(0.0); K];
            vector[..index.min(self.rank)]
                .copy_from_slice(&self.lower[index][..index.min(self.rank)]);
            self.solve_transposed(&mut vector);
            vector = vector.map(|x| -x);
            vector[index] = one;
            self.scale_each(&mut vector);
            for other in &self.null[self.regular..index] {
                let part = dot(&vector, other);
                for (x, other) in vector.iter_mut().zip(other) {
                    *x -= part * *other;
                }
            }
            let active = one - self.kept[index];
            let scale = active / dot(&vector, &vector).sqrt();
            self.null[index] = vector.map(|x| x * scale);
        }
    }

    /// `L₁₁ᵀ x = y` in place, with zeros for pivots that do not count.
    fn solve_transposed(&self, x: &mut [T; K]) {
        for k in (0..self.rank).rev() {
            let (before, behind) = x.split_at_mut(k);
            behind[0] = self.inverse[k] * behind[0];
            for (x, element) in before.iter_mut().zip(&self.lower[k]) {
                *x -= *element * behind[0];
            }
        }
        x[self.rank..].fill(T::from_f64(0.0));
    }

    fn scale_each(&self, x: &mut [T; K]) {
        for (x, scale) in x.iter_mut().zip(&self.scale) {
            *x = *scale * *x;
        }
    }

    fn remove_null_space(&self, x: &mut [T; K]) {
        for vector in &self.null[self.regular..] {
            let part = dot(x, vector);
            for (x, vector) in x.iter_mut().zip(vector) {
                *x -= part * *vector;
            }
        }
    }

    /// The least-squares solution of least norm, without refinement.
    fn least_squares(&self, right: &SVector<T, K>) -> SVector<T, K> {
        let mut x = self.order.apply(&right.data.0[0]);
        self.remove_null_space(&mut x);
        self.scale_each(&mut x);
        for k in 0..self.rank {
            x[k] = self.inverse[k] * (x[k] - dot(&self.lower[k][..k], &x[..k]));
        }
        self.solve_transposed(&mut x);
        self.scale_each(&mut x);
        self.remove_null_space(&mut x);
        SVector::from(self.order.undo(&x))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Dual;
    use crate::solve::lanes::{Pair, random};

    /// `B Bᵀ` with `B` of `R` columns, random and well conditioned.
    fn gram<const K: usize, const R: usize>() -> (SMatrix<f64, K, K>, SMatrix<f64, K, R>) {
        let mut random = random();
        let factor = SMatrix::<f64, K, R>::from_fn(|i, j| {
            random() / R as f64 + if i % R == j { 1.0 } else { 0.0 }
        });
        (factor * factor.transpose(), factor)
    }

    /// A consistent system of rank `R`: the solution of least norm lies in the range.
    fn check<const K: usize, const R: usize>() {
        let (matrix, factor) = gram::<K, R>();
        let expected = factor * SVector::<f64, R>::from_fn(|i, _| (1.0 + i as f64).sin());
        let found = least_norm(&matrix, &(matrix * expected));
        assert_eq!(found.rank, R.min(K), "{K} {R}");
        assert!(found.residual < 1e-13, "{K} {R} {}", found.residual);
        let error = (found.solution - expected).norm() / expected.norm();
        assert!(error < 1e-13, "{K} {R} {error:e}");
    }

    #[test]
    fn one_to_forty_unknowns() {
        macro_rules! check_all {
            ($($size:literal)*) => { $( check::<$size, $size>(); check::<$size, { $size - $size / 2 }>(); )* };
        }
        check_all!(1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20);
        check_all!(21 22 23 24 25 26 27 28 29 30 31 32 33 34 35 36 37 38 39 40);
    }

    #[test]
    fn duplicated_rows_share_the_load() {
        // Rows 0 and 2 are the same constraint, row 3 is twice that of row 1.
        let constraint = SMatrix::<f64, 4, 3>::from_row_slice(&[
            1.0, 2.0, 0.0, 0.0, 1.0, 1.0, 1.0, 2.0, 0.0, 0.0, 2.0, 2.0,
        ]);
        let matrix = constraint * constraint.transpose();
        let right = constraint * SVector::from([1.0, -2.0, 0.5]);
        let found = least_norm(&matrix, &right);
        let expected = matrix.svd(true, true).solve(&right, 1e-12).unwrap();
        assert_eq!(found.rank, 2);
        assert!((found.solution - expected).norm() < 1e-14);
        assert!((found.solution[0] - found.solution[2]).abs() < 1e-15);
        assert!((2.0 * found.solution[1] - found.solution[3]).abs() < 1e-15);
    }

    /// Two rows that are parallel but for an error.
    #[test]
    fn errors_make_no_pivots_beyond_the_rank() {
        let rows = SMatrix::<f64, 2, 3>::from_row_slice(&[1.0, 2.0, 0.0, 1.0, 2.0, 1e-4]);
        let right = SVector::from([6.0, 6.0 + 1e-4]);
        let found = Semidefinite::of_rank(rows * rows.transpose(), 1.0).solve(&right);
        assert_eq!(found.rank, 1);
        let force = rows.transpose() * found.solution;
        assert!(
            (force - SVector::from([1.2, 2.4, 0.0])).norm() < 1e-3,
            "{force}"
        );
    }

    #[test]
    fn zero_matrix() {
        let found = least_norm(&SMatrix::<f64, 3, 3>::zeros(), &SVector::zeros());
        assert_eq!(
            (found.rank, found.solution, found.residual),
            (0, SVector::zeros(), 0.0)
        );
        let inconsistent = least_norm(
            &SMatrix::<f64, 3, 3>::zeros(),
            &SVector::from([1.0, 0.0, 0.0]),
        );
        assert_eq!(
            (inconsistent.solution, inconsistent.residual),
            (SVector::zeros(), 1.0)
        );
    }

    #[test]
    fn nothing_to_solve() {
        assert_eq!(
            least_norm(&SMatrix::<f64, 0, 0>::zeros(), &SVector::zeros()).rank,
            0
        );
    }

    #[test]
    fn forces_survive_a_singular_position() {
        // Two rows at the angle θ; the force of a consistent b is G⁺ b whatever the rank is taken to be.
        let force = SVector::from([0.3, 0.7]);
        for exponent in 0..12 {
            let angle = 10.0_f64.powi(-exponent);
            let constraint = SMatrix::<f64, 2, 2>::new(1.0, 0.0, angle.cos(), angle.sin());
            let matrix = constraint * constraint.transpose();
            let found = least_norm(&matrix, &(constraint * force));
            let error = (constraint.transpose() * found.solution - force).norm();
            // Below the rank's level the force across is lost, above it is kept with what rounding leaves.
            let bound = if exponent < 7 {
                4e-16 * 10.0_f64.powi(2 * exponent) + 1e-15
            } else {
                1.0
            };
            assert!(error <= bound, "{angle:e} {error:e}");
            assert_eq!(found.rank, if exponent < 8 { 2 } else { 1 }, "{angle:e}");
            assert!(
                found.solution.norm() < 1.0 / angle,
                "{angle:e} {}",
                found.solution
            );
        }
    }

    /// An angle held on a body of a gram, and a length of its arm of a millimetre: the second row is small, and no rounding.
    #[test]
    fn rows_of_other_units_count() {
        fn solved<T: Real>(arm: f64) -> [f64; 2] {
            let rows = [
                [0.0, 0.5, 1.0],
                [arm, 2.0 * arm, 0.0],
                [arm, 2.0 * arm, 0.0],
            ];
            let matrix = SMatrix::<f64, 3, 3>::from_fn(|i, j| dot(&rows[i], &rows[j]));
            let right = matrix * SVector::from([2.0, 3.0 / arm, 3.0 / arm]);
            let found = least_norm(&matrix.map(T::from_f64), &right.map(T::from_f64));
            assert_eq!(found.rank, 2, "{arm:e}");
            let [turning, first, second] =
                found.solution.map(|it| it.find(|_| true).unwrap()).data.0[0];
            assert!((first / second - 1.0).abs() < 1e-3, "{first} {second}");
            [turning / 2.0 - 1.0, first * arm / 3.0 - 1.0]
        }
        for arm in [1e3, 1.0, 1e-3, 1e-6, 1e-9, 1e-12] {
            let errors = solved::<f64>(arm);
            assert!(
                errors.iter().all(|error| error.abs() < 1e-12),
                "{arm:e} {errors:?}"
            );
        }
        for arm in [1e3, 1.0, 1e-3, 1e-4] {
            let errors = solved::<f32>(arm);
            assert!(
                errors.iter().all(|error| error.abs() < 1e-4),
                "{arm:e} {errors:?}"
            );
        }
    }

    /// Neither a row that is small nor one large beside it takes an exchange; one that is rounding, or nearly depends on the one
    /// before, does.
    #[test]
    fn sizes_of_rows_do_not_decide_on_exchanges() {
        let kinds = |length: f64, angle: f64| {
            let rows = [[1.0, 0.0], [length * angle.cos(), length * angle.sin()]];
            let matrix = SMatrix::<f64, 2, 2>::from_fn(|i, j| dot(&rows[i], &rows[j]));
            matches!(
                Semidefinite::new(matrix).factors,
                Factors::Definite(_) | Factors::Other(Careful(Factors::Definite(_)))
            )
        };
        for length in [1e-12, 1e-6, 1e-2, 1.0, 1e4, 1e12] {
            assert!(kinds(length, 1.0) && kinds(length, 0.011), "{length:e}");
            assert!(!kinds(length, 0.009), "{length:e}");
        }
        assert!(!kinds(1e-15, 1.0) && !kinds(1e15, 1.0));
    }

    #[test]
    fn an_inconsistent_system_gets_least_squares() {
        let (matrix, _) = gram::<5, 3>();
        let right = SVector::from([1.0, -1.0, 2.0, 0.5, 0.0]);
        let found = least_norm(&matrix, &right);
        let expected = matrix.svd(true, true).solve(&right, 1e-12).unwrap();
        assert!((found.solution - expected).norm() < 1e-11 * expected.norm());
        assert!(found.residual > 1e-3);
    }

    #[test]
    fn single_precision() {
        let (matrix, factor) = gram::<12, 7>();
        let expected = factor * SVector::<f64, 7>::from_element(1.0);
        let narrow = |x: f64| x as f32;
        let found = least_norm(&matrix.map(narrow), &(matrix * expected).map(narrow));
        assert_eq!(found.rank, 7);
        let error = (found.solution.map(f64::from) - expected).norm() / expected.norm();
        assert!(error < 1e-4, "{error:e}");
    }

    #[test]
    fn slopes_of_a_redundant_system() {
        // S = [c c; c c], b = [d d]: λ = d / 2c each.
        let (c, d) = (
            Dual {
                value: 2.0_f64,
                slope: 1.0,
            },
            Dual {
                value: 6.0,
                slope: 5.0,
            },
        );
        let found = least_norm(
            &SMatrix::<_, 2, 2>::from_element(c),
            &SVector::from_element(d),
        );
        let expected: f64 = (5.0 * 2.0 - 6.0) / 8.0;
        for x in found.solution.iter() {
            assert!(
                (x.value - 1.5).abs() < 1e-15 && (x.slope - expected).abs() < 1e-15,
                "{x:?}"
            );
        }
    }

    #[test]
    fn lanes_of_different_rank() {
        let (regular, _) = gram::<4, 4>();
        let (singular, _) = gram::<4, 2>();
        let x = SVector::from([1.0, 2.0, -1.0, 0.5]);
        let lanes = [(regular, singular), (singular, regular)];
        for (first, second) in lanes {
            let matrix = first.zip_map(&second, |a, b| Pair([a, b]));
            let right = (first * x).zip_map(&(second * x), |a, b| Pair([a, b]));
            let both = least_norm(&matrix, &right);
            for (lane, alone) in [first, second].into_iter().enumerate() {
                let alone = least_norm(&alone, &(alone * x));
                let error = both.solution.map(|it| it.0[lane]) - alone.solution;
                assert!(error.norm() < 1e-12, "{lane} {error}");
            }
        }
    }
}
