//! Linear systems of fixed size over real and complex numbers.

use core::ops::{Add, Mul, Sub};

use crate::Real;

/// A number that elimination works on.
pub trait Element: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// What it consists of.
    type Part: Real;
    /// A real number.
    fn from_part(part: Self::Part) -> Self;
    /// Zero.
    fn zero() -> Self {
        Self::from_part(Self::Part::from_f64(0.0))
    }
    /// Less the product of two others.
    #[inline]
    fn less(self, a: Self, b: Self) -> Self {
        self - a * b
    }
    /// `Σ column · factor`.
    fn product<const N: usize>(columns: &[[Self; N]; N], factors: &[Self; N]) -> [Self; N];
    /// Its reciprocal. That of what is infinite is NaN and not zero, by which a state would stand still unseen.
    fn reciprocal(self) -> Self;
    /// A size to choose pivots by, lane by lane.
    fn sizes(self) -> Self::Part;
    /// That of the lane where it is the largest.
    #[inline]
    fn size(self) -> f64 {
        self.sizes().magnitude()
    }
}

impl<T: Real> Element for T {
    type Part = T;

    fn from_part(part: T) -> Self {
        part
    }

    #[inline]
    fn less(self, a: T, b: T) -> T {
        (-a).multiply_add(b, self)
    }

    #[inline(always)]
    fn product<const N: usize>(columns: &[[T; N]; N], factors: &[T; N]) -> [T; N] {
        let mut sums = [T::from_f64(0.0); N];
        for (column, factor) in columns.iter().zip(factors) {
            for (sum, element) in sums.iter_mut().zip(column) {
                *sum = element.multiply_add(*factor, *sum);
            }
        }
        sums
    }

    fn reciprocal(self) -> Self {
        T::from_f64(1.0) / self + T::from_f64(0.0) * self
    }

    #[inline]
    fn sizes(self) -> T {
        self.abs()
    }
}

/// A complex number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Complex<T> {
    /// Real part.
    pub real: T,
    /// Imaginary part.
    pub imaginary: T,
}

impl<T: Real> Add for Complex<T> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            real: self.real + other.real,
            imaginary: self.imaginary + other.imaginary,
        }
    }
}

impl<T: Real> Sub for Complex<T> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self {
            real: self.real - other.real,
            imaginary: self.imaginary - other.imaginary,
        }
    }
}

impl<T: Real> Mul for Complex<T> {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self {
            real: self.real * other.real - self.imaginary * other.imaginary,
            imaginary: self.real * other.imaginary + self.imaginary * other.real,
        }
    }
}

impl<T: Real> Element for Complex<T> {
    type Part = T;

    fn from_part(real: T) -> Self {
        let imaginary = T::from_f64(0.0);
        Self { real, imaginary }
    }

    #[inline]
    fn less(self, a: Self, b: Self) -> Self {
        let Self { real, imaginary } = self;
        Self {
            real: (-a.real).multiply_add(b.real, a.imaginary.multiply_add(b.imaginary, real)),
            imaginary: (-a.real)
                .multiply_add(b.imaginary, (-a.imaginary).multiply_add(b.real, imaginary)),
        }
    }

    /// By sums of the columns times real and imaginary parts, which need not be taken apart.
    #[inline(always)]
    fn product<const N: usize>(columns: &[[Self; N]; N], factors: &[Self; N]) -> [Self; N] {
        let mut sums = [[Self::zero(); N]; 2];
        for (column, factor) in columns.iter().zip(factors) {
            for (sums, factor) in sums.iter_mut().zip([factor.real, factor.imaginary]) {
                for (sum, element) in sums.iter_mut().zip(column) {
                    sum.real = element.real.multiply_add(factor, sum.real);
                    sum.imaginary = element.imaginary.multiply_add(factor, sum.imaginary);
                }
            }
        }
        let [real, imaginary] = sums;
        let mut product = real;
        for (product, turned) in product.iter_mut().zip(&imaginary) {
            product.real -= turned.imaginary;
            product.imaginary += turned.real;
        }
        product
    }

    /// Divides by the larger part first, so that no square overflows, in each lane by its own.
    fn reciprocal(self) -> Self {
        let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
        let Self { real, imaginary } = self;
        let chosen = |if_real, if_imaginary| {
            real.abs()
                .select_less(imaginary.abs(), if_imaginary, if_real)
        };
        let (larger, smaller) = (chosen(real, imaginary), chosen(imaginary, real));
        let ratio = smaller / larger;
        let scale = one / (larger + smaller * ratio) + zero * larger;
        Self {
            real: chosen(scale, ratio * scale),
            imaginary: -chosen(ratio * scale, scale),
        }
    }

    #[inline]
    fn sizes(self) -> T {
        self.real.abs() + self.imaginary.abs()
    }
}

/// So many equations are solved by the inverse: of eight it takes at most twice as long as factors, and a solution a
/// seventh.
const INVERTED: usize = 8;

/// So many have an inverse by cofactors.
const SMALL: usize = 3;

/// `P A = L U` with partial pivoting; the pivots' reciprocals are kept in their place.
///
/// For steps of implicit methods, whose lanes share all decisions and so their pivots, and whose matrices may be complex;
/// [`Regular`](crate::solve::Regular) is for loops in models, where each lane must give what it would give alone, in
/// whatever units. Of a singular matrix the solutions are not finite. Of up to eight equations the columns of the
/// inverse are kept instead: its products need not wait for each other, and a step takes several.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Factors<E, const N: usize> {
    pub(super) rows: [[E; N]; N],
    order: [usize; N],
}

impl<E: Element, const N: usize> Factors<E, N> {
    /// Nothing yet.
    #[inline(always)]
    pub(crate) fn empty() -> Self {
        Self {
            rows: [[E::zero(); N]; N],
            order: [0; N],
        }
    }

    /// Factors of the matrix of these entries.
    #[inline(always)]
    pub(crate) fn factorise(&mut self, entry: impl Fn(usize, usize) -> E) {
        if N > INVERTED {
            fill(&mut self.rows, entry);
            return self.eliminate();
        }
        if N <= SMALL {
            let mut rows = [[E::zero(); N]; N];
            fill(&mut rows, &entry);
            if by_cofactors(&rows, &mut self.rows) {
                return;
            }
        }
        // The rows of the inverse of the transpose are the columns of the inverse.
        fill(&mut self.rows, |row, column| entry(column, row));
        self.invert();
    }

    #[inline(never)]
    fn eliminate(&mut self) {
        let Self { rows, order } = self;
        for k in 0..N {
            let pivot = exchange(rows, k);
            order[k] = pivot;
            let (above, below) = rows.split_at_mut(k + 1);
            let pivot_row = &mut above[k];
            pivot_row[k] = pivot_row[k].reciprocal();
            for row in below {
                let factor = row[k] * pivot_row[k];
                row[k] = factor;
                for (element, pivot) in row[k + 1..].iter_mut().zip(&pivot_row[k + 1..]) {
                    *element = element.less(factor, *pivot);
                }
            }
        }
    }

    /// The inverse in the place of the matrix, by Gauss and Jordan with a search for pivots.
    #[inline(never)]
    fn invert(&mut self) {
        let Self { rows, order } = self;
        for k in 0..N {
            order[k] = exchange(rows, k);
            let reciprocal = rows[k][k].reciprocal();
            let mut above = rows[k];
            for (j, element) in above.iter_mut().enumerate() {
                *element = if j == k {
                    reciprocal
                } else {
                    *element * reciprocal
                };
            }
            for (i, row) in rows.iter_mut().enumerate() {
                if i == k {
                    *row = above;
                    continue;
                }
                let factor = row[k];
                for (j, (element, above)) in row.iter_mut().zip(&above).enumerate() {
                    let kept = if j == k { E::zero() } else { *element };
                    *element = kept.less(factor, *above);
                }
            }
        }
        for k in (0..N).rev() {
            let pivot = order[k];
            // Compared to their number, so that no check is left that panics.
            if pivot != k && pivot < N {
                for row in rows.iter_mut() {
                    row.swap(k, pivot);
                }
            }
        }
    }

    /// The `x` of `A x = right`.
    #[inline]
    pub(crate) fn solve(&self, right: [E; N]) -> [E; N] {
        if N > INVERTED {
            return self.substituted(right);
        }
        if N > SMALL {
            return E::product(&self.rows, &right);
        }
        let product = |row: usize, column: usize| self.rows[column][row] * right[column];
        core::array::from_fn(|row| {
            (1..N).fold(product(row, 0), |sum, column| sum + product(row, column))
        })
    }

    fn substituted(&self, right: [E; N]) -> [E; N] {
        let mut x = right;
        for (k, pivot) in self.order.iter().enumerate() {
            if *pivot < N {
                x.swap(k, *pivot);
            }
        }
        for i in 1..N {
            for j in 0..i {
                x[i] = x[i].less(self.rows[i][j], x[j]);
            }
        }
        for i in (0..N).rev() {
            for j in i + 1..N {
                x[i] = x[i].less(self.rows[i][j], x[j]);
            }
            x[i] = x[i] * self.rows[i][i];
        }
        x
    }
}

/// Brings the largest element of a column, from the diagonal on, to the diagonal; gives its row.
#[inline(always)]
fn exchange<E: Element, const N: usize>(rows: &mut [[E; N]; N], column: usize) -> usize {
    let has_lanes = E::Part::from_f64(0.0).in_lane(1).is_some();
    let scale = has_lanes.then(|| largest(rows, column));
    // Of several lanes by the one in which it is the smallest part of what the lane has: zero in one is a pivot for none.
    let size = |row: &[E; N]| match scale {
        Some(scale) => 1.0 - ((scale - row[column].sizes()) / scale).magnitude(),
        None => row[column].size(),
    };
    let mut pivot = column;
    let mut largest = size(&rows[column]);
    for (i, row) in rows.iter().enumerate().skip(column + 1) {
        let size = size(row);
        if size > largest {
            (pivot, largest) = (i, size);
        }
    }
    if pivot != column && pivot < N {
        rows.swap(column, pivot);
    }
    pivot
}

/// The largest size in a column, from the diagonal on, lane by lane; 1 where nothing is there.
fn largest<E: Element, const N: usize>(rows: &[[E; N]; N], column: usize) -> E::Part {
    let [zero, one] = [0.0, 1.0].map(E::Part::from_f64);
    let sizes = rows.iter().skip(column).map(|row| row[column].sizes());
    let largest = sizes.fold(zero, |largest, size| {
        largest.select_less(size, size, largest)
    });
    zero.select_less(largest, largest, one)
}

/// Writes entries to a matrix, without a copy of it.
#[inline(always)]
fn fill<E: Element, const N: usize>(rows: &mut [[E; N]; N], entry: impl Fn(usize, usize) -> E) {
    // Counted, so that no check of a place is left in what gives the entries.
    for (i, row) in (0..N).zip(rows) {
        for (j, element) in (0..N).zip(row) {
            *element = entry(i, j);
        }
    }
}

/// The columns of the inverse of at most three rows by cofactors, which need not wait for each other; not of a singular
/// matrix, nor where products may leave the range of the numbers. Whether it came to that.
#[inline(always)]
fn by_cofactors<E: Element, const N: usize>(rows: &[[E; N]; N], columns: &mut [[E; N]; N]) -> bool {
    let zero = E::zero();
    let found: &[E] = match *rows.as_flattened() {
        [_] => &[E::from_part(E::Part::from_f64(1.0))],
        [a, b, c, d] => &[d, zero - c, zero - b, a],
        [a, b, c, d, e, f, g, h, i] => &[
            e * i - f * h,
            f * g - d * i,
            d * h - e * g,
            c * h - b * i,
            a * i - c * g,
            b * g - a * h,
            b * f - c * e,
            c * d - a * f,
            a * e - b * d,
        ],
        _ => return false,
    };
    let first_rows = rows.as_flattened().iter().zip(found).take(N);
    let determinant = first_rows.fold(zero, |sum, (element, cofactor)| sum + *element * *cofactor);
    let size = determinant.size();
    let small = E::Part::EPSILON * E::Part::EPSILON;
    let small = small * small;
    if size.is_nan() || size <= small || size >= 1.0 / small {
        return false;
    }
    let reciprocal = determinant.reciprocal();
    for (element, cofactor) in columns.as_flattened_mut().iter_mut().zip(found) {
        *element = *cofactor * reciprocal;
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::lanes::random;
    use std::vec::Vec;

    fn factors<E: Element, const N: usize>(rows: [[E; N]; N]) -> Factors<E, N> {
        let mut factors = Factors::empty();
        factors.factorise(|row, column| rows[row][column]);
        factors
    }

    #[test]
    fn solves_what_needs_pivots() {
        let rows = [[0.0, 1e-20, 3.0], [2.0, 1.0, 0.0], [1e20, 0.0, 1e20]];
        let x = [1.0, -2.0, 3.0];
        let right = rows.map(|row: [f64; 3]| row.iter().zip(x).map(|(a, x)| a * x).sum());
        let found = factors(rows).solve(right);
        for (found, x) in found.iter().zip(x) {
            assert!((found - x).abs() < 1e-14, "{found}");
        }
    }

    #[test]
    fn a_singular_matrix_gives_nothing_finite() {
        let x = factors([[1.0, 2.0], [2.0, 4.0]]).solve([1.0, 1.0]);
        assert!(x.iter().all(|x: &f64| !x.is_finite()), "{x:?}");
        let x = factors([[1.0; 5]; 5]).solve([1.0, 2.0, 3.0, 4.0, 5.0]);
        assert!(x.iter().all(|x: &f64| !x.is_finite()), "{x:?}");
    }

    /// Of random matrices, most without a diagonal to rely on, in random units.
    fn assert_solves<const N: usize>() {
        let mut random = random();
        for _ in 0..100 {
            let units: [f64; N] = core::array::from_fn(|_| 10.0_f64.powf(6.0 * random()));
            let mut number = |size: f64| Complex {
                real: size * random(),
                imaginary: size * random(),
            };
            let x: [Complex<f64>; N] = core::array::from_fn(|row| number(1.0 / units[row]));
            let rows: [[Complex<f64>; N]; N] = core::array::from_fn(|row| {
                core::array::from_fn(|column| {
                    let size = units[row] * units[column];
                    number(if row == column { 1e-9 * size } else { size })
                })
            });
            let right = rows.map(|row| {
                let terms = row.iter().zip(x).map(|(a, x)| *a * x);
                terms.fold(Complex::zero(), |sum, term| sum + term)
            });
            let found = factors(rows).solve(right);
            for ((found, x), unit) in found.iter().zip(x).zip(units) {
                assert!((*found - x).size() * unit < 1e-9, "{N}: {found:?}, {x:?}");
            }
        }
    }

    #[test]
    fn every_number_of_equations_is_solved_whatever_the_units() {
        assert_solves::<2>();
        assert_solves::<3>();
        assert_solves::<4>();
        assert_solves::<6>();
        assert_solves::<8>();
        assert_solves::<9>();
        assert_solves::<12>();
    }

    /// What is the largest in one lane is zero in another one.
    #[cfg(feature = "lanes")]
    #[test]
    fn a_pivot_serves_all_lanes() {
        use crate::lanes::{Lanes, f64x4};

        let entry = |lane: usize, row: usize, column: usize| match (row, column) {
            (0, 0) => [0.0, 90.0, 0.0, 1.0][lane],
            (1, 0) => [70.0, 0.0, 2.0, 80.0][lane],
            _ if row == column => 3.0,
            _ => 1.0 / (1.0 + row as f64 + 2.0 * column as f64),
        };
        fn solved<E: Element>(entry: impl Fn(usize, usize) -> E) -> [E; 9] {
            let mut factors = Factors::<E, 9>::empty();
            factors.factorise(entry);
            factors.solve([E::from_part(E::Part::from_f64(1.0)); 9])
        }
        let together = solved(|row, column| f64x4::from_lanes(|lane| entry(lane, row, column)));
        for lane in 0..4 {
            let alone = solved(|row, column| entry(lane, row, column));
            for (found, expected) in together.iter().zip(alone) {
                let found = found.lane(lane);
                assert!(
                    (found - expected).abs() < 1e-13,
                    "{lane}: {found} {expected}"
                );
            }
        }
    }

    #[cfg(feature = "lanes")]
    #[test]
    fn reciprocals_are_those_of_each_lane_alone() {
        use crate::lanes::{Lanes, f64x4};

        let parts = [[0.0, 2.0], [3.0, 0.0], [-1e200, 1e180], [1.0, -4.0]];
        let [real, imaginary] = [0, 1].map(|part| f64x4::from_lanes(|lane| parts[lane][part]));
        let together = Complex { real, imaginary }.reciprocal();
        for (lane, [real, imaginary]) in parts.into_iter().enumerate() {
            let number = Complex { real, imaginary };
            let alone = number.reciprocal();
            let one = number * alone;
            assert!(
                (one.real - 1.0).abs() < 1e-15 && one.imaginary.abs() < 1e-15,
                "{one:?}"
            );
            let found = [together.real.lane(lane), together.imaginary.lane(lane)];
            assert_eq!(found, [alone.real, alone.imaginary]);
        }
    }

    #[test]
    fn complex_solutions_fulfil_their_equations() {
        let number = |real: f64, imaginary: f64| Complex { real, imaginary };
        let rows = [
            [number(0.0, 1e-3), number(2.0, -1.0), number(1.0, 0.0)],
            [number(1.0, 1.0), number(0.5, 0.0), number(-3.0, 2.0)],
            [number(-2.0, 0.3), number(1.0, 4.0), number(0.0, 7.0)],
        ];
        let x = [number(1.0, 2.0), number(-0.5, 0.0), number(3.0, -1.0)];
        let right: Vec<_> = rows
            .iter()
            .map(|row| {
                let terms = row.iter().zip(x).map(|(a, x)| *a * x);
                terms.fold(number(0.0, 0.0), |sum, term| sum + term)
            })
            .collect();
        let found = factors(rows).solve([right[0], right[1], right[2]]);
        for (found, x) in found.iter().zip(x) {
            assert!((*found - x).size() < 1e-14, "{found:?}");
        }
    }
}
