//! One lane of a scalar: numbers that have an order, in the precision of the model.

use nalgebra::SVector;

use crate::Real;

/// The number itself; of several lanes the first.
#[inline]
pub(crate) fn lane<T: Real>(number: T) -> T::Lane {
    or_nan(number.in_lane(0))
}

/// The number in a lane that there is.
#[inline]
pub(crate) fn or_nan<L: Real>(number: Option<L>) -> L {
    number.unwrap_or_else(|| L::from_f64(f64::NAN))
}

pub(crate) fn is_finite<L: Real + PartialOrd>(number: L) -> bool {
    number.abs() < L::from_f64(f64::INFINITY)
}

/// Whether both are on the same side of zero. Their product may be too small for single precision.
pub(crate) fn are_alike<L: Real + PartialOrd>(a: L, b: L) -> bool {
    let zero = L::from_f64(0.0);
    (a < zero && b < zero) || (a > zero && b > zero)
}

// Written so that what is no number is left out.

pub(crate) fn larger<L: PartialOrd>(a: L, b: L) -> L {
    if b > a { b } else { a }
}

pub(crate) fn smaller<L: PartialOrd>(a: L, b: L) -> L {
    if b < a { b } else { a }
}

/// The length of a vector; of one whose squares single precision has not, that of its largest entry.
pub(crate) fn length<T: Real, const N: usize>(vector: &SVector<T, N>) -> T::Lane {
    let (vector, zero) = (vector.map(lane), T::Lane::from_f64(0.0));
    let squares = dot(&vector, &vector);
    match squares == zero || squares == T::Lane::from_f64(f64::INFINITY) {
        true => vector
            .iter()
            .fold(zero, |largest, it| larger(largest, it.abs())),
        false => squares.sqrt(),
    }
}

pub(crate) fn dot<L: Real, const N: usize>(a: &SVector<L, N>, b: &SVector<L, N>) -> L {
    let pairs = a.iter().zip(b);
    pairs.fold(L::from_f64(0.0), |sum, (a, b)| sum + *a * *b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_those_of_what_is_very_long_or_short_too() {
        let of = |entries: [f32; 3]| length(&SVector::from(entries));
        assert_eq!(of([3.0, 0.0, -4.0]), 5.0);
        assert_eq!(of([0.0; 3]), 0.0);
        assert_eq!(of([1e-30, 0.0, 0.0]), 1e-30);
        assert_eq!(of([0.0, -1e30, 0.0]), 1e30);
        assert!(of([f32::NAN, 0.0, 1.0]).is_nan());
    }

    #[test]
    fn small_numbers_have_a_side() {
        let [small, large, none] = [1e-30_f32, 1e-20, f32::NAN];
        assert!(are_alike(small, large) && are_alike(-small, -large));
        assert!(
            ![(small, -large), (0.0, large), (none, large)]
                .iter()
                .any(|it| are_alike(it.0, it.1))
        );
    }

    #[test]
    fn what_is_no_number_is_left_out() {
        assert_eq!([larger(1.0, f64::NAN), smaller(1.0, f64::NAN)], [1.0; 2]);
        assert!([f32::NAN, f32::INFINITY].iter().all(|it| !is_finite(*it)));
    }
}
