//! Rank of integer matrices modulo a prime, by dense elimination.

/// Arithmetic is modulo this prime.
pub(crate) const PRIME: i64 = 2_147_483_647;

/// The rank of rows of `columns` entries, each row given as sums of (column, value).
pub(crate) fn rank(columns: usize, rows: impl Iterator<Item = Vec<(usize, i64)>>) -> usize {
    let mut matrix: Vec<Vec<i64>> = rows
        .map(|row| {
            let mut dense = vec![0; columns];
            for (column, value) in row {
                dense[column] = (dense[column] + value).rem_euclid(PRIME);
            }
            dense
        })
        .collect();
    let mut rank = 0;
    for column in 0..columns {
        let Some(pivot) = (rank..matrix.len()).find(|row| matrix[*row][column] != 0) else {
            continue;
        };
        matrix.swap(rank, pivot);
        let top = matrix[rank].clone();
        for row in &mut matrix[rank + 1..] {
            // Cross multiplication instead of an inverse.
            let (keep, take) = (top[column], row[column]);
            for (entry, above) in row.iter_mut().zip(&top) {
                *entry = (*entry * keep % PRIME - take * above % PRIME).rem_euclid(PRIME);
            }
        }
        rank += 1;
    }
    rank
}
