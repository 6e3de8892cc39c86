//! What residuals are measured in, so that the units of a model decide on nothing: lengths of micrometres stand beside angles.

use nalgebra::{SMatrix, SVector};

use crate::Real;
use crate::solve::moved;

/// How far from the start residuals are looked at: angles in radians, displacements in parts of themselves.
const AROUND: f64 = 0.03;
/// At how many points.
const POINTS: usize = 5;
/// How far from each rounding is looked at, in units of the root of precision: values have other digits there, and what is not
/// linear is below rounding.
const BESIDE: f64 = 0.125;
/// At how many places.
const PLACES: usize = 4;

/// Residuals of positions or of flows.
#[derive(Clone, Copy, PartialEq)]
pub enum Level {
    /// Of displacements.
    Positions,
    /// Of rates and momenta, in which they are linear.
    Flows,
}

/// What residuals are measured in.
pub struct Measure<'a, T> {
    /// What they are of.
    pub level: Level,
    /// The unit of each of them, as [`units`] finds it. Residuals behind these are those of what is given; if there are no units
    /// all residuals are measured in one.
    pub units: &'a [T],
    /// States in which residuals of positions are linear, such as the way of a slide.
    pub linear: &'a [usize],
}

/// What residuals are multiplied by.
pub(super) struct Factors<T, const M: usize>([T; M]);

impl<T: Real> Measure<'_, T> {
    /// The size that rounding has in residuals that are measured already, in units of precision.
    pub(super) fn sizes<const M: usize, const N: usize>(
        &self,
        x: &SVector<T, N>,
        (residuals, jacobian): &(SVector<T, M>, SMatrix<T, M, N>),
    ) -> [T; M] {
        match self.level {
            Level::Positions => sizes(x, jacobian, self.linear),
            // What drives a loop is no state, and is all there is where rates are zero before.
            Level::Flows => {
                let mut sizes = sizes_of_terms(&x.map(Real::abs), jacobian);
                for (size, residual) in sizes.iter_mut().zip(residuals) {
                    *size += residual.abs();
                }
                sizes
            }
        }
    }

    /// One over each unit, of which there is one for each residual.
    pub(super) fn factors<const M: usize>(&self) -> Factors<T, M> {
        let mut by = [T::from_f64(1.0); M];
        for (by, unit) in by.iter_mut().zip(self.units) {
            *by = *by / *unit;
        }
        Factors(by)
    }

    /// The same, and of residuals behind these by what their states do to the others: a rate is measured in what moves a loop by
    /// one of its units.
    pub(super) fn factors_at<const M: usize, const N: usize>(
        &self,
        x: &SVector<T, N>,
        start: &(SVector<T, M>, SMatrix<T, M, N>),
    ) -> Factors<T, M> {
        let mut by = self.factors::<M>();
        let known = self.units.len();
        if known == 0 || known >= M {
            return by;
        }
        let zero = T::from_f64(0.0);
        let sizes = by.values(SVector::from(self.sizes(x, start)));
        let fastest = largest_of(sizes.iter().take(known).copied());
        let fastest = if fastest > 0.0 { fastest } else { 1.0 };
        let mut units = [zero; M];
        for column in start.1.data.0 {
            let loops = column.iter().zip(&by.0).take(known);
            let does = loops.fold(zero, |most, (slope, by)| most.max((*slope * *by).abs()));
            for (unit, slope) in units.iter_mut().zip(column) {
                let moved = zero.select_less(does, slope.abs() / does, zero);
                *unit = unit.max(moved);
            }
        }
        let given = by.0.iter_mut().zip(units).zip(sizes.iter());
        for ((by, unit), size) in given.skip(known) {
            // What moves no loop is measured in itself.
            let own = *size / T::from_f64(fastest);
            let unit = or_one(zero.select_less(unit, unit, own));
            *by = T::from_f64(1.0) / unit.with_slopes_of(zero);
        }
        by
    }
}

impl<T: Real, const M: usize> Factors<T, M> {
    pub(super) fn values(&self, mut residuals: SVector<T, M>) -> SVector<T, M> {
        for (residual, by) in residuals.iter_mut().zip(self.0) {
            *residual = *residual * by;
        }
        residuals
    }

    pub(super) fn both<const N: usize>(
        &self,
        (residuals, mut jacobian): (SVector<T, M>, SMatrix<T, M, N>),
    ) -> (SVector<T, M>, SMatrix<T, M, N>) {
        for column in &mut jacobian.data.0 {
            for (slope, by) in column.iter_mut().zip(self.0) {
                *slope = *slope * by;
            }
        }
        (self.values(residuals), jacobian)
    }

    /// A residual as it is.
    pub(super) fn undone(&self, number: usize, residual: T) -> T {
        let by = self.0.get(number).copied();
        residual / by.unwrap_or(T::from_f64(1.0))
    }
}

/// The units of residuals of positions: what they are made of near `start`, seen by what states contribute, and by their rounding.
///
/// Rounding tells where constraints are redundant: what holds a plane mechanism in its plane is zero wherever that is, but for
/// rounding of lengths.
#[cold]
pub fn units<T: Real, const M: usize, const N: usize>(
    start: &SVector<T, N>,
    linear: &[usize],
    evaluate: impl Fn(&SVector<T, N>) -> (SVector<T, M>, SMatrix<T, M, N>),
) -> [T; M] {
    let zero = T::from_f64(0.0);
    let mut units = [zero; M];
    let mut at_least = |found: [T; M]| {
        for (unit, found) in units.iter_mut().zip(found) {
            // None that is no number.
            *unit = unit.select_less(found, found, *unit);
        }
    };
    for point in 0..POINTS {
        let x = moved(start, (AROUND, point), linear);
        let (residuals, jacobian) = evaluate(&x);
        at_least(sizes(&x, &jacobian, linear));
        for place in 1..=PLACES {
            let next = moved(&x, (BESIDE * T::SINGULAR, point * PLACES + place), linear);
            let expected = residuals + product(&jacobian, &(next.zip_map(&x, |next, x| next - x)));
            let aside = evaluate(&next)
                .0
                .zip_map(&expected, |found, expected| found - expected);
            at_least(aside.map(|it| it.abs() / T::from_f64(T::EPSILON)).data.0[0]);
        }
    }
    units.map(|unit| or_one(unit).with_slopes_of(zero))
}

/// A number if it is larger than zero, else one.
fn or_one<T: Real>(number: T) -> T {
    T::from_f64(0.0).select_less(number, number, T::from_f64(1.0))
}

/// The largest in any lane.
pub(super) fn largest_of<T: Real>(numbers: impl IntoIterator<Item = T>) -> f64 {
    numbers.into_iter().map(T::magnitude).fold(0.0, f64::max)
}

/// What states contribute to residuals of positions. These turn with angles, which may be zero, and are as long as links are then;
/// a displacement contributes itself.
fn sizes<T: Real, const M: usize, const N: usize>(
    x: &SVector<T, N>,
    jacobian: &SMatrix<T, M, N>,
    linear: &[usize],
) -> [T; M] {
    let size = |state: usize| {
        let least = if linear.contains(&state) { 0.0 } else { 1.0 };
        x[state].abs().max(T::from_f64(least))
    };
    sizes_of_terms(&SVector::from_fn(|state, _| size(state)), jacobian)
}

fn sizes_of_terms<T: Real, const M: usize, const N: usize>(
    states: &SVector<T, N>,
    jacobian: &SMatrix<T, M, N>,
) -> [T; M] {
    let mut sums = [T::from_f64(0.0); M];
    for (column, state) in jacobian.data.0.iter().zip(states) {
        for (sum, slope) in sums.iter_mut().zip(column) {
            *sum += (*slope * *state).abs();
        }
    }
    sums
}

fn product<T: Real, const M: usize, const N: usize>(
    jacobian: &SMatrix<T, M, N>,
    x: &SVector<T, N>,
) -> SVector<T, M> {
    let mut product = [T::from_f64(0.0); M];
    for (column, x) in jacobian.data.0.iter().zip(x) {
        for (sum, slope) in product.iter_mut().zip(column) {
            *sum += *slope * *x;
        }
    }
    SVector::from(product)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The end of two rods on two hinges and a slide: along the slide, across it, out of the plane of a base that is turned, which
    /// is rounding, and the sum of the angles.
    fn residuals<T: Real>(length: T, x: &SVector<T, 3>) -> (SVector<T, 4>, SMatrix<T, 4, 3>) {
        let [zero, one, half] = [0.0, 1.0, 0.5].map(T::from_f64);
        let (sine, cosine) = x[0].sin_cos();
        let (other_sine, other_cosine) = (x[0] + x[1]).sin_cos();
        let [along, across] = [
            length * cosine + length * other_cosine,
            length * (sine + other_sine),
        ];
        let out = half * (along * T::from_f64(0.3))
            - T::from_f64(0.15) * length * cosine
            - T::from_f64(0.15) * (length * other_cosine);
        let values = SVector::from([along - x[2], across, out, x[0] + x[1]]);
        let [first, second] = [-length * other_sine, length * other_cosine];
        let columns = [
            [first - length * sine, second + length * cosine, zero, one],
            [first, second, zero, one],
            [-one, zero, zero, zero],
        ];
        (values, SMatrix::from(columns))
    }

    /// Terms are small themselves where both rods are upright.
    #[test]
    fn units_are_those_of_what_residuals_are_made_of() {
        fn check<T: Real>(length: f64, angles: [f64; 2]) {
            let arm = T::from_f64(length);
            let start = SVector::from([angles[0], angles[1], length].map(T::from_f64));
            let found = units(&start, &[2], |x| residuals(arm, x)).map(T::magnitude);
            let expected = [length, length, length, 1.0];
            for (number, (found, expected)) in found.iter().zip(expected).enumerate() {
                let part = found / expected;
                assert!((1e-3..10.0).contains(&part), "{number} {length:e} {part}");
            }
        }
        for length in [1e-9, 1e-6, 1e-3, 1.0, 1e3] {
            for angles in [[0.0, 0.0], [0.4, -1.0], [1.57, 0.0]] {
                check::<f64>(length, angles);
                check::<f32>(length, angles);
            }
        }
    }

    /// A rate that is given is measured in what moves a loop by one of its units, and what moves none in itself.
    #[test]
    fn what_is_given_is_measured_beside_the_loop() {
        let measure = Measure {
            level: Level::Flows,
            units: &[1e-6, 1.0],
            linear: &[],
        };
        let rows = [
            [2e-6, 1e12, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 7.0],
        ];
        let jacobian = SMatrix::<f64, 5, 3>::from_fn(|row, column| rows[row][column]);
        let x = SVector::from([3.0, 0.0, 5.0]);
        let by = measure.factors_at(&x, &(SVector::zeros(), jacobian)).0;
        let expected = [1e6, 1.0, 2.0, 1e18, 6.0 / 35.0];
        for (found, expected) in by.iter().zip(expected) {
            assert!(
                (found / expected - 1.0).abs() < 1e-12,
                "{found:e} {expected:e}"
            );
        }
    }
}
