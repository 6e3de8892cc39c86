//! Orientations: rotation matrices from and to quaternions and the angles of a sequence.
//!
//! A rotation matrix `R` takes the components of a vector in a body's axes to those in the axes that it is seen from,
//! and a quaternion `[w, x, y, z]` of length one does the same by `q ∘ (0, v) ∘ q⁻¹`. A sequence i, j, k of axes, no
//! neighbours equal, has the angles of `R = R_i(a) R_j(b) R_k(c)`.

use super::expression::{Expression, Function};
use super::matrix::Matrix;
use super::pool::Pool;

/// The rotation matrix of a quaternion of length one.
#[must_use]
pub fn matrix_of(pool: &mut Pool, quaternion: [Expression; 4]) -> Matrix {
    let [w, x, y, z] = quaternion;
    // Of the form 1 − 2 (a² + b²), or 2 (a b ± w c).
    let mut diagonal = |a, b| {
        let squares = [pool.multiply(a, a), pool.multiply(b, b)];
        let sum = pool.sum(&squares);
        let double = twice(pool, sum);
        pool.subtract(Expression::ONE, double)
    };
    let [xx, yy, zz] = [diagonal(y, z), diagonal(x, z), diagonal(x, y)];
    let mut pair = |a, b, c| {
        let (product, turn) = (pool.multiply(a, b), pool.multiply(w, c));
        let (sum, difference) = (pool.add(product, turn), pool.subtract(product, turn));
        [twice(pool, sum), twice(pool, difference)]
    };
    let ([yx, xy], [xz, zx], [zy, yz]) = (pair(x, y, z), pair(x, z, y), pair(y, z, x));
    Matrix::new(3, 3, vec![xx, xy, xz, yx, yy, yz, zx, zy, zz])
}

fn twice(pool: &mut Pool, value: Expression) -> Expression {
    let two = pool.integer(2);
    pool.multiply(two, value)
}

/// The quaternion of a rotation matrix whose real part is not negative.
///
/// `4 q qᵀ` is linear in the matrix. Its column with the largest diagonal entry is divided by the root of that entry,
/// which is at least one (Shepperd 1978).
#[must_use]
pub fn quaternion_of(pool: &mut Pool, matrix: &Matrix) -> [Expression; 4] {
    let square = squares(pool, matrix);
    let mut largest = square[0][0];
    let mut column = square[0];
    for candidate in [1, 2, 3].map(|part| (square[part][part], square[part])) {
        let mut choose =
            |yes, no| pool.call(Function::SelectLess, &[largest, candidate.0, yes, no]);
        column = [0, 1, 2, 3].map(|part| choose(candidate.1[part], column[part]));
        largest = choose(candidate.0, largest);
    }
    let root = pool.call(Function::Sqrt, &[largest]);
    let double = twice(pool, root);
    let scale = pool
        .divide(Expression::ONE, double)
        .unwrap_or(Expression::ZERO);
    let signs = [column[0], Expression::ZERO, scale.negated(), scale];
    let scale = pool.call(Function::SelectLess, &signs);
    column.map(|entry| pool.multiply(entry, scale))
}

/// `4 q qᵀ`.
fn squares(pool: &mut Pool, matrix: &Matrix) -> [[Expression; 4]; 4] {
    let at = |row: usize, column: usize| matrix.at(row, column);
    let mut square = [[Expression::ZERO; 4]; 4];
    for (part, row) in square.iter_mut().enumerate() {
        // Of the three signs in 1 ± R11 ± R22 ± R33 all are plus for w, and one for x, y and z.
        let terms = (0..3).map(|axis| at(axis, axis).flipped(part != 0 && part != axis + 1));
        let terms: Vec<Expression> = terms.chain([Expression::ONE]).collect();
        row[part] = pool.sum(&terms);
    }
    for axis in 0..3 {
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        let turn = pool.subtract(at(last, next), at(next, last));
        (square[0][axis + 1], square[axis + 1][0]) = (turn, turn);
        let product = pool.add(at(next, last), at(last, next));
        (square[next + 1][last + 1], square[last + 1][next + 1]) = (product, product);
    }
    square
}

/// The angles of a rotation matrix: the first and the last in (−π, π], the middle one with a cosine that is not
/// negative, or with a sine that is not where the first and the last axis are one.
///
/// Nothing is divided by. Where the sequence is singular the first angle is zero in exact arithmetic.
#[must_use]
pub fn angles_of(pool: &mut Pool, matrix: &Matrix, axes: [usize; 3]) -> [Expression; 3] {
    let [i, j, _] = axes;
    let k = 3 - i - j;
    let left_handed = (i + 1) % 3 != j;
    let at = |row: usize, column: usize| matrix.at(row, column);
    let first = if axes[2] == i {
        [at(j, i), at(k, i).flipped(!left_handed)]
    } else {
        [at(j, k).flipped(!left_handed), at(k, k)]
    };
    let first = pool.call(Function::Atan2, &first);
    let (sine, cosine) = (pool.sine(first), pool.cosine(first));
    let mut turned = |a: Expression, b: Expression| {
        let (a, b) = (pool.multiply(cosine, a), pool.multiply(sine, b));
        pool.add(a, b)
    };
    let (middle, last) = if axes[2] == i {
        let across = turned(at(k, i).flipped(!left_handed), at(j, i));
        (
            [across, at(i, i)],
            [
                turned(at(j, k), at(k, k).flipped(left_handed)).flipped(!left_handed),
                turned(at(j, j), at(k, j).flipped(left_handed)),
            ],
        )
    } else {
        let along = turned(at(k, k), at(j, k).flipped(!left_handed));
        (
            [at(i, k).flipped(left_handed), along],
            [
                turned(at(j, i), at(k, i).flipped(left_handed)).flipped(left_handed),
                turned(at(j, j), at(k, j).flipped(left_handed)),
            ],
        )
    };
    [
        first,
        pool.call(Function::Atan2, &middle),
        pool.call(Function::Atan2, &last),
    ]
}

#[cfg(test)]
mod tests {
    use super::super::field::Image;
    use super::super::matrix::{Factor, Product};
    use super::super::{Evaluation, Symbol};
    use super::*;

    fn states<const N: usize>(pool: &mut Pool) -> [Expression; N] {
        std::array::from_fn(|index| pool.symbol(Symbol::State(index)))
    }

    fn values(pool: &Pool, expressions: &[Expression], state: &[f64]) -> Vec<f64> {
        let symbol = |symbol: Symbol| match symbol {
            Symbol::State(index) => state[index],
            _ => f64::NAN,
        };
        let mut evaluation = Evaluation::new(&symbol);
        expressions
            .iter()
            .map(|expression| evaluation.value(pool, *expression))
            .collect()
    }

    fn assert_near(found: &[f64], expected: &[f64], tolerance: f64) {
        assert_eq!(found.len(), expected.len());
        for (a, b) in found.iter().zip(expected) {
            assert!((a - b).abs() < tolerance, "{found:?} {expected:?}");
        }
    }

    fn turned(pool: &mut Pool, axes: [usize; 3], angles: [Expression; 3]) -> Matrix {
        let turns = axes.into_iter().zip(angles);
        let factors = turns.map(|(axis, angle)| Factor::Rotation { axis, angle });
        let product = Product {
            factors: factors.collect(),
        };
        product.to_matrix(pool)
    }

    #[test]
    fn a_quaternion_comes_back_with_its_sign_made_positive() {
        let mut pool = Pool::new();
        for (state, image) in Image::sphere(7).into_iter().enumerate() {
            pool.locate(state, image);
        }
        let parts = states(&mut pool);
        let matrix = matrix_of(&mut pool, parts);
        let unit = matrix.transpose().times(&mut pool, &matrix);
        assert_eq!(unit, Matrix::diagonal(&[Expression::ONE; 3]));
        assert_eq!(matrix.determinant(&mut pool), Expression::ONE);
        let quaternion = quaternion_of(&mut pool, &matrix);
        for state in [
            [0.5, 0.5, -0.5, 0.5],
            [0.1, 0.7, 0.1, -0.7],
            [0.0, 0.0, 0.6, 0.8],
            [-0.1, 0.3, 0.3, 0.9],
        ] {
            let length = state
                .iter()
                .map(|part: &f64| part * part)
                .sum::<f64>()
                .sqrt();
            let state = state.map(|part| part / length);
            let sign = if state[0] < 0.0 { -1.0 } else { 1.0 };
            let found = values(&pool, &quaternion, &state);
            assert_near(&found, &state.map(|part| sign * part), 1e-15);
        }
    }

    #[test]
    fn angles_of_every_sequence_give_the_matrix_back() {
        for number in 0..27 {
            let axes = [number / 9, number / 3 % 3, number % 3];
            if axes[0] == axes[1] || axes[1] == axes[2] {
                continue;
            }
            let mut pool = Pool::new();
            let angles = states(&mut pool);
            let matrix = turned(&mut pool, axes, angles);
            let found = angles_of(&mut pool, &matrix, axes);
            let again = turned(&mut pool, axes, found);
            let proper = axes[0] == axes[2];
            for middle in [-2.0, -1.0, 0.0, 0.5, std::f64::consts::FRAC_PI_2, 3.0] {
                let state = [0.4, middle, -2.5];
                let expected = values(&pool, &matrix.entries, &state);
                assert_near(&values(&pool, &again.entries, &state), &expected, 1e-14);
                if (proper && middle > 0.0) || (!proper && f64::cos(middle) > 0.1) {
                    assert_near(&values(&pool, &found, &state), &state, 1e-14);
                }
            }
        }
    }
}
