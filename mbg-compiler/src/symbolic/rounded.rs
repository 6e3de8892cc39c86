//! Rotations that are written as numbers.
//!
//! Numbers that are rounded are no rotation in exact arithmetic, and nothing that rests on one could be proven for them.
//! So they stand for the three turns about axes that lead to them: each has a sine and a cosine of which the squares are
//! one, exactly.

use super::field::Image;
use super::matrix::{Factor, Matrix, Product};
use super::pool::Pool;

/// A number with its exact image.
#[derive(Clone, Copy)]
struct Number {
    value: f64,
    image: Image,
}

type Numbers = [[Number; 3]; 3];

/// In the plane of two axes, from the first to the second.
#[derive(Clone, Copy)]
struct Turn {
    axes: (usize, usize),
    cosine: Number,
    sine: Number,
}

/// The rotation nearest to a matrix of numbers, but for rounding.
///
/// Two turns in a row, as where there is a zero off the diagonal, cost less one by one; three cost more than their product.
#[must_use]
pub fn rotation(pool: &mut Pool, matrix: [[f64; 3]; 3]) -> Product {
    let mut rest = matrix.map(|row| row.map(without_rounding));
    let turns = planes(&rest).map(|(first, second)| {
        let turn = Turn::towards((first, second), rest[first][first], rest[second][first]);
        let (cosine, sine) = (turn.cosine.value, turn.sine.value);
        let [along, across] = [first, second].map(|row| rest[row]);
        rest[first] = [0, 1, 2].map(|k| without_rounding(cosine * along[k] + sine * across[k]));
        rest[second] = [0, 1, 2].map(|k| without_rounding(cosine * across[k] - sine * along[k]));
        turn
    });
    let made = turns.iter().filter(|turn| !turn.is_nothing());
    let mut factors: Vec<Numbers> = made.map(Turn::matrix).collect();
    match factors[..] {
        [] => factors.push(turns[0].matrix()),
        [first, second, third] => factors = vec![product(&product(&first, &second), &third)],
        _ => {}
    }
    let factors = factors.iter().map(|factor| {
        let entries = factor.as_flattened().iter();
        let constants = entries.map(|entry| pool.constant(entry.value, entry.image));
        Factor::Dense(Matrix::new(3, 3, constants.collect()))
    });
    Product {
        factors: factors.collect(),
    }
}

/// Zero in the place of a rounding error, which would be divided by.
fn without_rounding(entry: f64) -> f64 {
    match entry.abs() <= 2.0 * f64::EPSILON {
        true => 0.0,
        false => entry,
    }
}

/// The planes of three turns in a row that make a rotation, the first of them nothing where the matrix has a zero.
fn planes(matrix: &[[f64; 3]; 3]) -> [(usize, usize); 3] {
    let mut pairs = (0..3).flat_map(|row| (0..3).map(move |column| (row, column)));
    let zero = pairs.find(|(row, column)| row != column && matrix[*row][*column] == 0.0);
    let (second, first) = zero.unwrap_or((1, 0));
    let third = 3 - first - second;
    [(first, second), (first, third), (second, third)]
}

impl Turn {
    /// Towards a point; nothing if that is the origin.
    fn towards(axes: (usize, usize), along: f64, across: f64) -> Self {
        let length = along.hypot(across);
        let (cosine, sine) = match length > 0.0 {
            true => (along / length, across / length),
            false => (1.0, 0.0),
        };
        let exact = |cosine: i64, sine: i64| (Image::integer(cosine), Image::integer(sine));
        let images = if sine == 0.0 {
            exact(if cosine < 0.0 { -1 } else { 1 }, 0)
        } else if cosine == 0.0 {
            exact(0, if sine < 0.0 { -1 } else { 1 })
        } else {
            let angle = Image::unknown(&[0x7_0221, cosine.to_bits(), sine.abs().to_bits()]);
            let (cosine, unsigned) = Image::circle(angle);
            let is_back = sine < 0.0;
            (
                cosine,
                if is_back {
                    unsigned.negated()
                } else {
                    unsigned
                },
            )
        };
        let number = |value, image| Number { value, image };
        Self {
            axes,
            cosine: number(cosine, images.0),
            sine: number(sine, images.1),
        }
    }

    fn is_nothing(&self) -> bool {
        self.sine.value == 0.0 && self.cosine.value > 0.0
    }

    fn matrix(&self) -> Numbers {
        let mut matrix = [0, 1, 2].map(|row| [0, 1, 2].map(|column| Number::unit(row == column)));
        let (first, second) = self.axes;
        (matrix[first][first], matrix[first][second]) = (self.cosine, self.sine.negated());
        (matrix[second][first], matrix[second][second]) = (self.sine, self.cosine);
        matrix
    }
}

fn product(left: &Numbers, right: &Numbers) -> Numbers {
    let zero = Number::unit(false);
    let entry = |row: usize, column: usize| {
        (0..3).fold(zero, |sum, k| {
            sum.plus(left[row][k].times(right[k][column]))
        })
    };
    [0, 1, 2].map(|row| [0, 1, 2].map(|column| entry(row, column)))
}

impl Number {
    fn unit(is_one: bool) -> Self {
        let value = i64::from(is_one);
        Self {
            value: value as f64,
            image: Image::integer(value),
        }
    }

    fn plus(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            image: self.image.plus(other.image),
        }
    }

    fn times(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            image: self.image.times(other.image),
        }
    }

    fn negated(self) -> Self {
        Self {
            value: -self.value,
            image: self.image.negated(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Expression;
    use super::*;

    fn values(pool: &Pool, matrix: &Matrix) -> Vec<f64> {
        let value = |entry: &Expression| pool.constant_value(*entry).unwrap();
        matrix.entries.iter().map(value).collect()
    }

    fn is_exact(pool: &mut Pool, matrix: &Matrix) -> bool {
        let gram = matrix.transpose().times(pool, matrix);
        let unit = Matrix::diagonal(&[Expression::ONE; 3]);
        gram.entries == unit.entries && matrix.determinant(pool) == Expression::ONE
    }

    fn product(angles: [f64; 3]) -> [[f64; 3]; 3] {
        let [(sx, cx), (sy, cy), (sz, cz)] = angles.map(f64::sin_cos);
        [
            [cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx],
            [sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx],
            [-sy, cy * sx, cy * cx],
        ]
    }

    #[test]
    fn rounded_numbers_become_a_rotation_that_is_exact() {
        let angles = [0.3, -1.2, 2.9, 3.1, -2.2, 1.5709, -1.5709, 0.0];
        for (x, y) in angles.iter().flat_map(|x| angles.map(|y| (*x, y))) {
            for z in angles {
                let mut pool = Pool::new();
                let matrix = product([x, y, z]);
                let rotation = rotation(&mut pool, matrix).to_matrix(&mut pool);
                assert!(is_exact(&mut pool, &rotation), "{matrix:?}");
                for (value, wanted) in values(&pool, &rotation).iter().zip(matrix.as_flattened()) {
                    assert!((value - wanted).abs() < 5e-16, "{matrix:?}");
                }
            }
        }
    }

    #[test]
    fn a_zero_off_the_diagonal_stays_nothing() {
        let (sx, cx) = 0.3f64.sin_cos();
        let (sy, cy) = 1.5709f64.sin_cos();
        let first = [
            [cy, 0.0, sy],
            [sx * sy, cx, -sx * cy],
            [-cx * sy, sx, cx * cy],
        ];
        for shift in 0..3 {
            let matrix: [[f64; 3]; 3] = std::array::from_fn(|row| {
                std::array::from_fn(|column| first[(row + shift) % 3][(column + shift) % 3])
            });
            let mut pool = Pool::new();
            let rotation = rotation(&mut pool, matrix).to_matrix(&mut pool);
            let zero = ((3 - shift) % 3, (4 - shift) % 3);
            assert_eq!(rotation.at(zero.0, zero.1), Expression::ZERO);
            assert!(is_exact(&mut pool, &rotation));
        }
    }

    #[test]
    fn right_angles_are_whole() {
        let matrix = [[0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]];
        for rounding in [0.0, 6e-17, -6e-17] {
            let mut pool = Pool::new();
            let rounded = matrix.map(|row| row.map(|it| it + rounding));
            let rotation = rotation(&mut pool, rounded).to_matrix(&mut pool);
            let whole = matrix.as_flattened().iter();
            let whole = whole.map(|it| pool.integer(*it as i64));
            assert_eq!(rotation.entries, whole.collect::<Vec<_>>(), "{rounding}");
        }
    }
}
