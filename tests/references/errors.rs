//! Errors, of which one that is no number is larger than any: it is within no bound.

/// The larger one of two errors.
pub(crate) fn larger(error: f64, other: f64) -> f64 {
    if other > error || other.is_nan() {
        other
    } else {
        error
    }
}

/// The largest difference of components.
pub(crate) fn apart(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let pairs = found.iter().zip(expected);
    pairs.fold(0.0, |largest, (found, expected)| {
        larger(largest, (found - expected).abs())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_stays_the_largest() {
        assert_eq!(apart(&[1.0, 5.0, 2.0], &[1.0, 2.0, 1.0]), 3.0);
        assert!(apart(&[1.0, f64::NAN, 2.0], &[1.0, 2.0, 0.0]).is_nan());
    }
}
