//! Poles of a model next to a state.

use nalgebra::{Complex, SMatrix};

use crate::step::seen;
use crate::{Linearised, Real};

/// Sweeps for one pole or pair at most.
const SWEEPS: u32 = 60;
/// After so many without one a shift of another kind is taken.
const PATIENCE: u32 = 10;
/// Scales are powers of the base of numbers, by which nothing is rounded.
const BASE: f64 = 2.0;
/// A scale is taken if it makes a row and a column so much shorter together.
const SHORTER: f64 = 0.95;

impl<T: Real, const N: usize, const M: usize, const P: usize> Linearised<T, N, M, P> {
    /// The poles in rad/s, the eigenvalues of `A`: real parts below zero decay, pairs with imaginary parts swing. None where an
    /// entry of `A` is not finite, or where they are not found in a bounded number of sweeps. Of several lanes they are those of the
    /// first, and [`Dual`](crate::Dual) numbers leave their slopes.
    ///
    /// States from which nothing follows, and those that follow from no other, are taken first, so that a free body and a chain of
    /// integrators have poles at zero to the last bit; then the matrix is scaled (Parlett and Reinsch, *Numerische Mathematik* 13
    /// (1969), 293–304) and swept by the double-shift QR algorithm (Francis, *The Computer Journal* 4 (1962), 332–345). A pole that
    /// is there `m` times comes with an error of the `m`-th root of rounding.
    ///
    /// # Example
    ///
    /// ```
    /// use mbg_runtime::{Linearised, System, mbg};
    /// use nalgebra::SVector;
    ///
    /// mbg! {
    ///     /// A mass on a spring, with an integral of its way for a controller.
    ///     model Swing {
    ///         1 way { I mass { inertia: 2.0 } C spring { stiffness: 200.0 } R damper { resistance: 4.0 } }
    ///         integral sum: m*s = spring.q;
    ///         output sum: m*s = sum;
    ///     }
    /// }
    ///
    /// let swing = Swing::<f64>::new(SwingParameters::default())?;
    /// let next = Linearised::of(&swing, 0.0, &swing.initial_state(), &SVector::zeros())?;
    /// let poles = next.poles().unwrap();
    /// // s² + 2 s + 100 = 0, and the integral.
    /// assert_eq!(poles.iter().filter(|pole| pole.re == 0.0 && pole.im == 0.0).count(), 1);
    /// let swings = poles.iter().filter(|pole| (pole.re + 1.0).abs() < 1e-12 && (pole.im.abs() - f64::sqrt(99.0)).abs() < 1e-12);
    /// assert_eq!(swings.count(), 2);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn poles(&self) -> Option<[Complex<f64>; N]> {
        eigenvalues(self.state.map(seen))
    }
}

/// The eigenvalues of a matrix; none where they are not finite or not found.
pub(crate) fn eigenvalues<const N: usize>(matrix: SMatrix<f64, N, N>) -> Option<[Complex<f64>; N]> {
    if !matrix.iter().all(|entry| entry.is_finite()) {
        return None;
    }
    let mut sweep = Sweep {
        matrix,
        poles: [Complex::new(0.0, 0.0); N],
        shift: 0.0,
    };
    let (first, end) = sweep.isolate();
    for place in (0..first).chain(end..N) {
        sweep.poles[place].re = sweep.matrix[(place, place)];
    }
    sweep.balance(first, end);
    sweep.reduce(first, end);
    sweep.all(first, end)?;
    Some(sweep.poles)
}

/// A matrix on its way to a triangle of blocks.
struct Sweep<const N: usize> {
    matrix: SMatrix<f64, N, N>,
    poles: [Complex<f64>; N],
    /// What has been taken off the diagonal.
    shift: f64,
}

impl<const N: usize> Sweep<N> {
    /// Puts states of which the rate follows from none of the others behind, those from which no other follows before the
    /// rest, and gives the range of that.
    fn isolate(&mut self) -> (usize, usize) {
        let (mut first, mut end) = (0, N);
        loop {
            let alone =
                |row: usize, column: usize| row == column || self.matrix[(row, column)] == 0.0;
            let behind = (first..end).find(|row| (first..end).all(|column| alone(*row, column)));
            let before = (first..end).find(|column| (first..end).all(|row| alone(row, *column)));
            if let Some(place) = behind {
                end -= 1;
                self.exchange(place, end);
            } else if let Some(place) = before {
                self.exchange(place, first);
                first += 1;
            } else {
                return (first, end);
            }
        }
    }

    fn exchange(&mut self, one: usize, other: usize) {
        self.matrix.swap_rows(one, other);
        self.matrix.swap_columns(one, other);
    }

    /// Scales states so that rows are about as long as columns.
    fn balance(&mut self, first: usize, end: usize) {
        let mut changed = true;
        while changed {
            changed = false;
            for place in first..end {
                let others = (first..end).filter(|it| *it != place);
                let (mut column, row) = others.fold((0.0, 0.0), |(column, row), other| {
                    (
                        column + self.matrix[(other, place)].abs(),
                        row + self.matrix[(place, other)].abs(),
                    )
                });
                if column == 0.0 || row == 0.0 || !(column + row).is_finite() {
                    continue;
                }
                let before = column + row;
                let mut scale = 1.0;
                while column < row / BASE {
                    (scale, column) = (scale * BASE, column * BASE * BASE);
                }
                while column >= row * BASE {
                    (scale, column) = (scale / BASE, column / (BASE * BASE));
                }
                if (column + row) / scale < SHORTER * before {
                    changed = true;
                    for other in 0..N {
                        self.matrix[(place, other)] /= scale;
                        self.matrix[(other, place)] *= scale;
                    }
                }
            }
        }
    }

    /// Makes entries more than one place below the diagonal zero, by elimination with the largest pivot.
    fn reduce(&mut self, first: usize, end: usize) {
        for column in first..end.saturating_sub(2) {
            let below = column + 1;
            let size = |row: usize| self.matrix[(row, column)].abs();
            let pivot = (below..end).fold(
                below,
                |best, row| if size(row) > size(best) { row } else { best },
            );
            self.exchange(below, pivot);
            let pivot = self.matrix[(below, column)];
            if pivot == 0.0 {
                continue;
            }
            for row in below + 1..end {
                let factor = self.matrix[(row, column)] / pivot;
                if factor == 0.0 {
                    continue;
                }
                for other in 0..N {
                    self.matrix[(row, other)] -= factor * self.matrix[(below, other)];
                }
                for other in 0..N {
                    self.matrix[(other, below)] += factor * self.matrix[(other, row)];
                }
                self.matrix[(row, column)] = 0.0;
            }
        }
    }

    /// Finds all poles of a range, the last first.
    fn all(&mut self, first: usize, mut end: usize) -> Option<()> {
        let mut sweeps = 0;
        while end > first {
            let start = self.start(first, end);
            match end - start {
                1 => {
                    self.poles[start].re = self.matrix[(start, start)] + self.shift;
                    (end, sweeps) = (start, 0);
                }
                2 => {
                    self.pair(start);
                    (end, sweeps) = (start, 0);
                }
                _ if sweeps == SWEEPS => return None,
                _ => {
                    sweeps += 1;
                    self.sweep(start, end, sweeps);
                }
            }
        }
        Some(())
    }

    /// Where the last block begins that nothing below its diagonal joins to what is before.
    fn start(&mut self, first: usize, end: usize) -> usize {
        let whole = || {
            let range = first..end;
            let entries = range
                .clone()
                .flat_map(|row| range.clone().map(move |column| (row, column)));
            entries.map(|place| self.matrix[place].abs()).sum::<f64>()
        };
        let mut start = end - 1;
        while start > first {
            let beside =
                self.matrix[(start - 1, start - 1)].abs() + self.matrix[(start, start)].abs();
            let beside = if beside == 0.0 { whole() } else { beside };
            if self.matrix[(start, start - 1)].abs() <= f64::EPSILON * beside {
                self.matrix[(start, start - 1)] = 0.0;
                break;
            }
            start -= 1;
        }
        start
    }

    /// The two poles of a block.
    fn pair(&mut self, start: usize) {
        let entry = |row, column| self.matrix[(start + row, start + column)];
        let half = 0.5 * (entry(0, 0) - entry(1, 1));
        let product = entry(1, 0) * entry(0, 1);
        let square = half * half + product;
        let last = entry(1, 1) + self.shift;
        let root = Real::sqrt(square.abs());
        self.poles[start..start + 2].copy_from_slice(&if square >= 0.0 {
            let far = half + if half < 0.0 { -root } else { root };
            let near = if far == 0.0 {
                last
            } else {
                last - product / far
            };
            [Complex::new(last + far, 0.0), Complex::new(near, 0.0)]
        } else {
            let re = last + half;
            [Complex::new(re, root), Complex::new(re, -root)]
        });
    }

    /// One sweep with two shifts over a block of three or more.
    fn sweep(&mut self, start: usize, end: usize, number: u32) {
        let last = end - 1;
        // Sum and product of the shifts: the poles of the last two rows.
        let [a, d] = [last - 1, last].map(|place| self.matrix[(place, place)]);
        let mut sum = a + d;
        let mut product = a * d - self.matrix[(last, last - 1)] * self.matrix[(last - 1, last)];
        if number.is_multiple_of(PATIENCE) {
            self.shift += d;
            (start..end).for_each(|place| self.matrix[(place, place)] -= d);
            // What is before the block is shifted with it, as its poles are found later.
            (0..start).for_each(|place| self.matrix[(place, place)] -= d);
            let size =
                self.matrix[(last, last - 1)].abs() + self.matrix[(last - 1, last - 2)].abs();
            (sum, product) = (1.5 * size, size * size);
        }
        let entry = |row: usize, column: usize| self.matrix[(start + row, start + column)];
        let mut column = [
            entry(0, 0) * (entry(0, 0) - sum) + entry(0, 1) * entry(1, 0) + product,
            entry(1, 0) * (entry(0, 0) + entry(1, 1) - sum),
            entry(1, 0) * entry(2, 1),
        ];
        for place in start..last {
            let size = (last + 1 - place).min(3);
            if place > start {
                let part = |k: usize| {
                    if k < size {
                        self.matrix[(place + k, place - 1)]
                    } else {
                        0.0
                    }
                };
                column = [0, 1, 2].map(part);
            }
            if size == 2 {
                column[2] = 0.0;
            }
            let Some((mirror, length)) = mirror(column) else {
                continue;
            };
            if place > start {
                self.matrix[(place, place - 1)] = -length;
                (1..size).for_each(|k| self.matrix[(place + k, place - 1)] = 0.0);
            }
            self.reflect(place, size, &mirror, start, end);
        }
    }

    /// Applies `I − m mᵀ` from both sides.
    fn reflect(&mut self, place: usize, size: usize, mirror: &[f64; 3], start: usize, end: usize) {
        for column in place..end {
            let along: f64 = (0..size)
                .map(|k| mirror[k] * self.matrix[(place + k, column)])
                .sum();
            (0..size).for_each(|k| self.matrix[(place + k, column)] -= along * mirror[k]);
        }
        for row in start..end.min(place + size + 1) {
            let along: f64 = (0..size)
                .map(|k| mirror[k] * self.matrix[(row, place + k)])
                .sum();
            (0..size).for_each(|k| self.matrix[(row, place + k)] -= along * mirror[k]);
        }
    }
}

/// The vector `m` of the reflection `I − m mᵀ` that turns a column into minus its length with the sign of its first entry, and that;
/// none of nothing.
fn mirror(column: [f64; 3]) -> Option<([f64; 3], f64)> {
    let scale = column
        .iter()
        .fold(0.0_f64, |scale, part| scale.max(part.abs()));
    if scale == 0.0 {
        return None;
    }
    let [a, b, c] = column.map(|part| part / scale);
    let length = Real::sqrt(a * a + b * b + c * c);
    let length = if a < 0.0 { -length } else { length };
    // |(a + l, b, c)|² = 2 l (l + a).
    let factor = 1.0 / Real::sqrt(length * (length + a));
    Some((
        [(a + length) * factor, b * factor, c * factor],
        length * scale,
    ))
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::*;

    fn poles<const N: usize>(state: SMatrix<f64, N, N>) -> Vec<Complex<f64>> {
        let model = Linearised::<f64, N, 1, 1> {
            state,
            input: SMatrix::zeros(),
            output: SMatrix::zeros(),
            feedthrough: SMatrix::zeros(),
        };
        let mut poles = model.poles().unwrap().to_vec();
        poles.sort_by(|a, b| a.re.total_cmp(&b.re).then(a.im.total_cmp(&b.im)));
        poles
    }

    /// What is expected, and how near.
    fn assert_near(found: &[Complex<f64>], expected: &[[f64; 2]], error: f64) {
        for (found, [re, im]) in found.iter().zip(expected) {
            let off = (found.re - re).hypot(found.im - im);
            assert!(off <= error, "{found} instead of {re} + {im}i");
        }
        assert_eq!(found.len(), expected.len());
    }

    #[test]
    fn chains_of_integrators_are_at_zero() {
        let chain =
            SMatrix::<f64, 7, 7>::from_fn(|row, column| f64::from(u8::from(row == column + 1)));
        assert_eq!(poles(chain), [Complex::new(0.0, 0.0); 7]);
        // In other units, and mixed.
        let mixing = SMatrix::<f64, 4, 4>::new(
            1.0, 2.0, 0.0, 1.0, 0.0, 1.0, 3.0, 0.0, 2.0, 0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 2.0,
        );
        let chain =
            SMatrix::<f64, 4, 4>::from_fn(|row, column| f64::from(u8::from(row == column + 1)));
        let mixed = mixing * chain * mixing.try_inverse().unwrap();
        assert_near(&poles(mixed), &[[0.0; 2]; 4], 1e-3);
    }

    #[test]
    fn pairs_far_from_each_other_keep_their_digits() {
        let mut state = SMatrix::<f64, 6, 6>::zeros();
        for (place, (rate, decay)) in [(1e-3, 1e-4), (1.0, 0.1), (1e5, 20.0)]
            .into_iter()
            .enumerate()
        {
            let first = 2 * place;
            state[(first, first + 1)] = 1.0;
            state[(first + 1, first)] = -(rate * rate + decay * decay);
            state[(first + 1, first + 1)] = -2.0 * decay;
            if place > 0 {
                state[(first - 1, first)] = 1e-3;
            }
        }
        let expected = [
            [-20.0, -1e5],
            [-20.0, 1e5],
            [-0.1, -1.0],
            [-0.1, 1.0],
            [-1e-4, -1e-3],
            [-1e-4, 1e-3],
        ];
        for (found, [re, im]) in poles(state).iter().zip(expected) {
            let off = (found.re - re).hypot(found.im - im) / im.abs();
            assert!(off < 1e-11, "{found} instead of {re} + {im}i");
        }
    }

    #[test]
    fn companions_have_the_roots_of_their_polynomials() {
        // (s + 1)(s + 2)…(s + 8): coefficients from s⁷ down.
        let coefficients = [
            36.0, 546.0, 4536.0, 22449.0, 67284.0, 118_124.0, 109_584.0, 40_320.0,
        ];
        let mut state = SMatrix::<f64, 8, 8>::zeros();
        for (column, coefficient) in coefficients.into_iter().enumerate() {
            state[(0, column)] = -coefficient;
            if column > 0 {
                state[(column, column - 1)] = 1.0;
            }
        }
        let expected: Vec<[f64; 2]> = (1..=8).rev().map(|root| [-f64::from(root), 0.0]).collect();
        assert_near(&poles(state), &expected, 1e-9);
        // sⁿ = 1, whose shifts are all alike.
        let ring = SMatrix::<f64, 5, 5>::from_fn(|row, column| {
            f64::from(u8::from(row == (column + 1) % 5))
        });
        let mut expected: Vec<[f64; 2]> = (0..5)
            .map(|k| f64::from(k) * core::f64::consts::TAU / 5.0)
            .map(|angle| [angle.cos(), angle.sin()])
            .collect();
        expected.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        let found = poles(ring);
        for [re, im] in expected {
            let near = found.iter().map(|it| (it.re - re).hypot(it.im - im));
            assert!(
                near.fold(1.0, f64::min) < 1e-14,
                "{re} + {im}i in {found:?}"
            );
        }
    }

    /// Sums of powers of the poles are traces of powers of the matrix.
    #[test]
    fn random_matrices_have_their_traces() {
        let mut seed = 7_u64;
        let mut next = || {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        for round in 0..200 {
            let mut state = SMatrix::<f64, 9, 9>::from_fn(|_, _| next());
            if round % 2 == 0 {
                // With gaps.
                state
                    .iter_mut()
                    .for_each(|it| *it = if next() < 0.1 { 0.0 } else { *it });
            }
            let found = poles(state);
            let mut power = state;
            let mut of_poles: Vec<Complex<f64>> = found.clone();
            for _ in 0..4 {
                let sum: Complex<f64> = of_poles.iter().sum();
                assert!(
                    (sum.re - power.trace()).abs() < 1e-12 && sum.im.abs() < 1e-12,
                    "{sum} {round}"
                );
                power *= state;
                of_poles
                    .iter_mut()
                    .zip(&found)
                    .for_each(|(it, pole)| *it *= pole);
            }
        }
    }

    #[test]
    fn what_is_no_number_has_no_poles() {
        let mut state = SMatrix::<f64, 3, 3>::identity();
        state[(1, 2)] = f64::NAN;
        let model = Linearised::<f64, 3, 0, 0> {
            state,
            input: SMatrix::zeros(),
            output: SMatrix::zeros(),
            feedthrough: SMatrix::zeros(),
        };
        assert_eq!(model.poles(), None);
    }
}
