//! Jacobians by sweeps, as many directions at once as a scalar has lanes.

use nalgebra::SMatrix;

use crate::{Columns, Real};

/// What a sweep gives `R` times: from how `L` variables change what rates do, or from weights of rates what variables are
/// multiplied by. The bits say in which directions, by their places modulo 64: what changes in none of these is zero, and left
/// out.
type Slopes<'a, T, const L: usize, const R: usize> =
    dyn Fn(u64, &[<T as Real>::Columns; L]) -> [<T as Real>::Columns; R] + 'a;

/// Lines of a matrix that are worked out together: one, and others with the entries that are theirs instead of its own.
type Direction<'a> = (usize, &'a [(usize, &'a [usize])]);

/// Fills columns of a Jacobian, in these of its rows, which ascend. `slopes` says how rates change with the variables.
// It is called as a function of its own: written into the loop, all that does not depend on the column would be made lanes
// of before, and kept in memory.
#[inline(never)]
pub fn columns<T: Real, const N: usize, const K: usize, const R: usize>(
    jacobian: &mut SMatrix<T, N, K>,
    directions: &[Direction<'_>],
    rows: &[usize; R],
    slopes: &Slopes<T, K, R>,
) {
    sweep(directions, rows, slopes, |column, row, slope| {
        if let Some(entry) = jacobian.get_mut((row, column)) {
            *entry = slope;
        }
    });
}

/// Fills rows of a Jacobian, in these of its columns, which ascend. `slopes` says by what the variables are multiplied in the
/// sum of weighted rates.
#[inline(never)]
pub fn rows<T: Real, const N: usize, const K: usize, const R: usize>(
    jacobian: &mut SMatrix<T, N, K>,
    directions: &[Direction<'_>],
    columns: &[usize; R],
    slopes: &Slopes<T, N, R>,
) {
    sweep(directions, columns, slopes, |row, column, slope| {
        if let Some(entry) = jacobian.get_mut((row, column)) {
            *entry = slope;
        }
    });
}

/// Works out all directions, and writes what they give by line and entry.
#[inline(always)]
fn sweep<T: Real, const L: usize, const R: usize>(
    directions: &[Direction<'_>],
    entries: &[usize; R],
    slopes: &Slopes<T, L, R>,
    mut write: impl FnMut(usize, usize, T),
) {
    let count = <T::Columns as Columns<T>>::COUNT;
    for (number, together) in directions.chunks(count).enumerate() {
        let places = number * count..number * count + together.len();
        let changing = places.fold(0, |changing, place| changing | 1 << (place % 64));
        let mut changes = [<T::Columns as Real>::from_f64(0.0); L];
        for (lane, (first, others)) in together.iter().enumerate() {
            let others = others.iter().map(|(line, _)| line);
            for line in [first].into_iter().chain(others) {
                if let Some(change) = changes.get_mut(*line) {
                    *change = Columns::<T>::from_columns(|other| {
                        T::from_f64(if other == lane { 1.0 } else { 0.0 })
                    });
                }
            }
        }
        let found = slopes(changing, &changes);
        for (lane, (first, others)) in together.iter().enumerate() {
            for (entry, slope) in entries.iter().zip(&found) {
                if let Some(slope) = slope.as_columns().get(lane) {
                    write(*first, *entry, *slope);
                }
            }
            for (line, own) in *others {
                for entry in *own {
                    let place = entries.binary_search(entry).ok();
                    let slope = place.and_then(|place| found.get(place)?.as_columns().get(lane));
                    if let Some(slope) = slope {
                        write(*first, *entry, T::from_f64(0.0));
                        write(*line, *entry, *slope);
                    }
                }
            }
        }
    }
}
