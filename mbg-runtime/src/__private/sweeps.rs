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
        *jacobian.get_mut((row, column))? = slope;
        Some(())
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
        *jacobian.get_mut((row, column))? = slope;
        Some(())
    });
}

/// Works out all directions, and writes what they give by line and entry.
#[inline(always)]
fn sweep<T: Real, const L: usize, const R: usize>(
    directions: &[Direction<'_>],
    entries: &[usize; R],
    slopes: &Slopes<T, L, R>,
    mut write: impl FnMut(usize, usize, T) -> Option<()>,
) {
    let count = <T::Columns as Columns<T>>::COUNT;
    let zero = T::from_f64(0.0);
    let mut changes = [<T::Columns as Real>::from_f64(0.0); L];
    for (number, together) in directions.chunks(count).enumerate() {
        let places = number * count..number * count + together.len();
        let changing = places.fold(0, |changing, place| changing | 1 << (place % 64));
        for (lane, direction) in together.iter().enumerate() {
            let one = |other| T::from_f64(if other == lane { 1.0 } else { 0.0 });
            change(&mut changes, direction, Columns::<T>::from_columns(one));
        }
        let found = slopes(changing, &changes);
        for (lane, direction) in together.iter().enumerate() {
            change(&mut changes, direction, Columns::<T>::whole(zero));
            let slope = |place: usize| found.get(place)?.as_columns().get(lane).copied();
            let (first, others) = direction;
            // It may end early, so that compilers write entry by entry: scattered lanes take longer.
            for (place, entry) in entries.iter().enumerate() {
                let written = slope(place).and_then(|slope| write(*first, *entry, slope));
                if written.is_none() {
                    break;
                }
            }
            for (line, own) in *others {
                for entry in *own {
                    let place = entries.binary_search(entry).ok();
                    if let Some(slope) = place.and_then(slope) {
                        write(*first, *entry, zero);
                        write(*line, *entry, slope);
                    }
                }
            }
        }
    }
}

/// Changes all lines of a direction.
fn change<C: Copy, const L: usize>(changes: &mut [C; L], direction: &Direction<'_>, by: C) {
    let (first, others) = direction;
    let others = others.iter().map(|(line, _)| line);
    for line in [first].into_iter().chain(others) {
        if let Some(line) = changes.get_mut(*line) {
            *line = by;
        }
    }
}
