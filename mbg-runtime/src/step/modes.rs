//! The fastest mode of a Jacobian.

use nalgebra::{SMatrix, SVector};

use crate::{Real, Sparsity};

/// Rounds of the power method.
const ROUNDS: usize = 30;
/// How often roots are taken of what bounds all modes: after twice as many rounds each time units of the states matter less.
const ROOTS: u32 = 3;
/// An entry of a pattern takes so many times as long as one of whole columns, of which several are multiplied at once.
const SPARSE: usize = 4;

/// Size of the largest eigenvalue of all lanes, and whether it decays: alone, or one of a pair within 45° of the negative axis, and
/// nothing grows about as fast.
pub(super) fn fastest<T: Real, const N: usize>(
    jacobian: &SMatrix<T, N, N>,
    sparsity: Option<&Sparsity>,
) -> (f64, bool) {
    let larger =
        |largest: (f64, bool), it: (f64, bool)| if it.0 > largest.0 { it } else { largest };
    let lanes = Rates::of_lanes(jacobian, sparsity);
    lanes.map(|it| it.fastest()).fold((0.0, false), larger)
}

/// A size that no eigenvalue of any lane exceeds.
pub(super) fn bound<T: Real, const N: usize>(
    jacobian: &SMatrix<T, N, N>,
    sparsity: Option<&Sparsity>,
) -> f64 {
    let lanes = Rates::of_lanes(jacobian, sparsity);
    lanes.map(|it| it.bound()).fold(0.0, f64::max)
}

/// How many entries a pattern has.
fn entries(sparsity: &Sparsity) -> usize {
    sparsity.rows.iter().map(|row| row.len()).sum()
}

/// A Jacobian in one lane.
struct Rates<'a, T, const N: usize> {
    jacobian: &'a SMatrix<T, N, N>,
    /// Its pattern, if that is worth minding.
    sparsity: Option<&'a Sparsity>,
    lane: usize,
    /// Its largest entry.
    scale: f64,
}

impl<'a, T: Real, const N: usize> Rates<'a, T, N> {
    /// One for each lane in which there is something.
    fn of_lanes(
        jacobian: &'a SMatrix<T, N, N>,
        sparsity: Option<&'a Sparsity>,
    ) -> impl Iterator<Item = Self> {
        let sparsity = sparsity.filter(|it| SPARSE * entries(it) < N * N);
        let lanes = (0..).map_while(move |lane| {
            jacobian.iter().next()?.in_lane(lane)?;
            let size = |it: &T| it.in_lane(lane).map_or(0.0, |it| it.into().abs());
            let scale = jacobian.iter().map(size).fold(0.0, f64::max);
            Some(Self {
                jacobian,
                sparsity,
                lane,
                scale,
            })
        });
        lanes.filter(|it| it.scale > 0.0 && it.scale.is_finite())
    }

    /// The product of a vector with what is told of each entry, in units of the largest.
    fn times(&self, v: &SVector<f64, N>, told: impl Fn(f64) -> f64) -> SVector<f64, N> {
        let told = |it: T| told(it.in_lane(self.lane).map_or(f64::NAN, Into::into));
        let v = v / self.scale;
        let mut product = SVector::<f64, N>::from_element(0.0);
        let Some(Sparsity { rows, .. }) = self.sparsity else {
            for (column, factor) in self.jacobian.column_iter().zip(&v) {
                product.axpy(*factor, &column.map(told), 1.0);
            }
            return product;
        };
        for ((row, columns), sum) in rows.iter().enumerate().zip(&mut product) {
            for column in columns.iter().map(|it| usize::from(*it)) {
                let entry = self.jacobian.get((row, column));
                if let (Some(it), Some(factor)) = (entry, v.get(column)) {
                    *sum += told(*it) * factor;
                }
            }
        }
        product
    }

    /// What no eigenvalue exceeds: no power of the matrix is larger than that of the sizes of its entries.
    fn bound(&self) -> f64 {
        let mut v = SVector::<f64, N>::from_element(1.0);
        for _ in 0..1 << ROOTS {
            v = self.times(&v, f64::abs);
        }
        let power = v.iter().copied().fold(0.0, f64::max);
        self.scale * (0..ROOTS).fold(power, |power, _| Real::sqrt(power))
    }

    /// What [`fastest`] tells of this lane.
    ///
    /// The last three vectors of the power method are nearly dependent: `v″ = a v′ + b v` has the eigenvalues as roots. Where many
    /// modes are about as fast as each other they are not, and the size is that by which the vectors have grown.
    fn fastest(&self) -> (f64, bool) {
        // Uneven, so that no symmetry of the model hides a mode.
        let mut v = SVector::<f64, N>::from_fn(|row, _| 1.0 + 0.37 * Real::sin(row as f64 * 1.7));
        let times = |v: &SVector<f64, N>| self.times(v, |it| it);
        let mut grown = 0.0;
        for round in 0..ROUNDS {
            let next = times(&v);
            let size = next
                .iter()
                .fold(0.0, |largest: f64, it| largest.max(it.magnitude()));
            if size == 0.0 || !size.is_finite() {
                return (0.0, false);
            }
            v = next.map(|it| it / size);
            if 2 * round >= ROUNDS {
                grown += Real::ln(size);
            }
        }
        let grown = self.scale * Real::exp(2.0 * grown / ROUNDS as f64);
        let (size, decays) = of_pair(&times, &v);
        let size = self.scale * size;
        if grown > 2.0 * size {
            (grown, decays)
        } else {
            (size, decays)
        }
    }
}

/// What a matrix of which one pair of modes is left in a vector tells of them.
fn of_pair<const N: usize>(
    times: &impl Fn(&SVector<f64, N>) -> SVector<f64, N>,
    v: &SVector<f64, N>,
) -> (f64, bool) {
    let first = times(v);
    let second = times(&first);
    let [vv, fv, ff] = [v.dot(v), first.dot(v), first.dot(&first)];
    let [sv, sf] = [second.dot(v), second.dot(&first)];
    let determinant = ff * vv - fv * fv;
    if determinant <= 1e-12 * ff * vv {
        // One real eigenvalue: the vectors are parallel.
        return (Real::sqrt(ff / vv), fv < 0.0);
    }
    let a = (sf * vv - sv * fv) / determinant;
    let b = (sv * ff - sf * fv) / determinant;
    let discriminant = 0.25 * a * a + b;
    if discriminant < 0.0 {
        let (size, real) = (Real::sqrt(-b), 0.5 * a);
        return (size, -real >= size * core::f64::consts::FRAC_1_SQRT_2);
    }
    let root = Real::sqrt(discriminant);
    let size = 0.5 * a.abs() + root;
    (size, a < 0.0 && 0.5 * a + root < 0.5 * size)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fastest_modes_are_found() {
        let told = |matrix: [[f64; 2]; 2], expected: f64| {
            let (size, decays) = fastest(&SMatrix::<f64, 2, 2>::from(matrix), None);
            assert!((size / expected - 1.0).abs() < 1e-6, "{size}");
            decays
        };
        assert!(!told([[0.0, -1e8], [1.0, -10.0]], 1e4));
        assert!(told([[-1e6, 3.0], [2.0, -1.0]], 1e6));
        assert!(!told([[1e6, 3.0], [2.0, -1.0]], 1e6));
        assert!(told([[-3.0, 1.0], [-1.0, -3.0]], f64::sqrt(10.0)));
        assert!(!told([[3.0, 1.0], [-1.0, 3.0]], f64::sqrt(10.0)));
        // One grows as fast as the other decays.
        assert!(!told([[0.0, 1.0], [1.0, 0.0]], 1.0));
        assert_eq!(
            fastest(&SMatrix::from([[0.0, 0.0], [1.0, 0.0]]), None),
            (0.0, false)
        );
        assert_eq!(fastest(&SMatrix::<f64, 0, 0>::from([]), None), (0.0, false));
    }

    #[test]
    fn no_mode_is_faster_than_the_bound() {
        let turning = SMatrix::from([[0.0, -1e8], [1.0, -10.0]]);
        assert!(bound(&turning, None) >= 1e4 && bound(&turning, None) < 3e4);
        // What is driven and drives nothing has no mode.
        let driven = SMatrix::from([[0.0, 1e6, 0.0], [0.0, -2.0, 0.0], [0.0, 1e3, 0.0]]);
        assert!(bound(&driven, None) >= 2.0 && bound(&driven, None) < 20.0);
        let one_way = SMatrix::from([[0.0, 0.0], [1.0, 0.0]]);
        assert_eq!(bound(&one_way, None), 0.0);
        assert_eq!(bound(&SMatrix::<f64, 0, 0>::from([]), None), 0.0);
    }

    #[test]
    fn zeros_of_a_pattern_are_left_out() {
        let sparsity = Sparsity {
            rows: &[
                &[0, 1],
                &[1, 8],
                &[2],
                &[2, 3],
                &[4],
                &[5],
                &[4, 6],
                &[7],
                &[0, 8],
            ],
            elimination: None,
        };
        let matrix = SMatrix::<f64, 9, 9>::from_fn(|row, column| {
            let is_there = sparsity.rows[row].contains(&(column as u16));
            f64::from(u8::from(is_there)) * (1.0 + row as f64 - 3.0 * column as f64)
        });
        assert_eq!(fastest(&matrix, Some(&sparsity)), fastest(&matrix, None));
        assert_eq!(bound(&matrix, Some(&sparsity)), bound(&matrix, None));
        let mut other = matrix;
        other[(2, 5)] = f64::NAN;
        assert_eq!(fastest(&other, Some(&sparsity)), fastest(&matrix, None));
    }

    #[test]
    fn the_fastest_of_many_modes_is_found_within_a_factor_of_two() {
        // A wave along thirty cells: momenta and displacements in their own units, slightly damped, with modes up to
        // nearly 2.
        let wave = |unit: f64| {
            SMatrix::<f64, 60, 60>::from_fn(|row, column| {
                let (own, other) = (row % 30, column % 30);
                let damping = if row == column { -1e-3 } else { 0.0 };
                match (row < 30, column < 30) {
                    (true, false) if other == own => -unit,
                    (true, false) if other + 1 == own => unit,
                    (false, true) if other == own => 1.0 / unit,
                    (false, true) if other == own + 1 => -1.0 / unit,
                    (true, true) => damping,
                    _ => 0.0,
                }
            })
        };
        for unit in [1.0, 1e3, 1e6, 1e-6] {
            let (size, _) = fastest(&wave(unit), None);
            assert!(size > 1.0 && size < 4.0, "{unit:e}: {size}");
            let most = bound(&wave(unit), None);
            assert!((2.0..8.0).contains(&most), "{unit:e}: {most}");
        }
    }
}
