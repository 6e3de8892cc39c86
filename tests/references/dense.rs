//! Linear systems whose size is known at run time.

/// The `x` of `A x = b`, by Gaussian elimination with partial pivoting.
pub(crate) fn solve(mut matrix: Vec<Vec<f64>>, mut right: Vec<f64>) -> Vec<f64> {
    let size = right.len();
    for k in 0..size {
        let pivot = (k..size)
            .max_by(|i, j| matrix[*i][k].abs().total_cmp(&matrix[*j][k].abs()))
            .unwrap();
        matrix.swap(k, pivot);
        right.swap(k, pivot);
        let pivot_row = matrix[k].clone();
        for i in k + 1..size {
            let factor = matrix[i][k] / pivot_row[k];
            for (element, pivot) in matrix[i].iter_mut().zip(&pivot_row).skip(k) {
                *element -= factor * pivot;
            }
            right[i] -= factor * right[k];
        }
    }
    for k in (0..size).rev() {
        let sum: f64 = (k + 1..size).map(|j| matrix[k][j] * right[j]).sum();
        right[k] = (right[k] - sum) / matrix[k][k];
    }
    right
}

#[test]
fn solves() {
    let matrix = vec![
        vec![0.0, 2.0, 1.0],
        vec![1.0, 1.0, 0.0],
        vec![3.0, 0.0, -1.0],
    ];
    let x = solve(matrix, vec![7.0, 3.0, 0.0]);
    for (x, expected) in x.iter().zip([1.0, 2.0, 3.0]) {
        assert!((x - expected).abs() < 1e-15);
    }
}
