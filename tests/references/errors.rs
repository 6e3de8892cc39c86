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

/// The same of two quaternions, of which both signs are one rotation.
pub(crate) fn turned(found: &[f64], expected: &[f64; 4]) -> f64 {
    let product: f64 = found.iter().zip(expected).map(|(a, b)| a * b).sum();
    apart(found, &expected.map(|part| product.signum() * part))
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
