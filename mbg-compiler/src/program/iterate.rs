//! The solves of an interpreted program: Newton's iteration, halving steps that do not help, and linear equations
//! that may be singular.

use crate::symbolic::evaluate::regular;

/// Most evaluations.
const EVALUATIONS: usize = 1000;

/// Makes the residuals zero, from zero; NaN if it does not get there. `evaluate` gives residuals, then their
/// derivatives by rows.
pub(super) fn iterate(size: usize, evaluate: impl Fn(&[f64]) -> Vec<f64>) -> Vec<f64> {
    let mut point = vec![0.0; size];
    let mut values = evaluate(&point);
    let mut rest = EVALUATIONS;
    while rest > 0 {
        let step = regular(&values[..size], &values[size..]);
        let scale = point.iter().fold(1e-300_f64, |scale, z| scale.max(z.abs()));
        let last = step.iter().all(|step| step.abs() <= 1e-13 * scale);
        let mut factor = 1.0;
        loop {
            let trial: Vec<f64> = point
                .iter()
                .zip(&step)
                .map(|(z, s)| z - factor * s)
                .collect();
            if last {
                return trial;
            }
            let found = evaluate(&trial);
            rest = rest.saturating_sub(1);
            let better = norm(&found[..size]) <= norm(&values[..size]);
            if better || factor < 1e-6 || rest == 0 {
                (point, values) = (trial, found);
                break;
            }
            factor *= 0.5;
        }
    }
    vec![f64::NAN; size]
}

/// A solution of `S z = b` with a symmetric positive semidefinite matrix by rows, zero where it is free.
pub(super) fn consistent(right: &[f64], matrix: &[f64]) -> Vec<f64> {
    let size = right.len();
    let mut rows: Vec<Vec<f64>> = (0..size)
        .map(|row| {
            let mut entries = matrix[row * size..][..size].to_vec();
            entries.push(right[row]);
            entries
        })
        .collect();
    let largest = (0..size).fold(0.0_f64, |largest, k| largest.max(rows[k][k].abs()));
    let mut open: Vec<usize> = (0..size).collect();
    let mut solution = vec![0.0; size];
    let mut pivots = Vec::new();
    while let Some(place) =
        (0..open.len()).max_by(|a, b| rows[open[*a]][open[*a]].total_cmp(&rows[open[*b]][open[*b]]))
    {
        let pivot = open.swap_remove(place);
        if rows[pivot][pivot] <= 1e-14 * largest {
            break;
        }
        let above = rows[pivot].clone();
        for row in &open {
            let factor = rows[*row][pivot] / above[pivot];
            for (entry, above) in rows[*row].iter_mut().zip(&above) {
                *entry -= factor * above;
            }
        }
        pivots.push(pivot);
    }
    for (done, pivot) in pivots.iter().enumerate().rev() {
        let known: f64 = pivots[done + 1..]
            .iter()
            .map(|later| rows[*pivot][*later] * solution[*later])
            .sum();
        solution[*pivot] = (rows[*pivot][size] - known) / rows[*pivot][*pivot];
    }
    solution
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|value| value.abs()).sum()
}
