//! Whether a law has an integral along a ray, as far as samples of it show.

use std::ops::Range;

/// How often the stretch around the largest sample is looked at more closely.
const LOOKS: usize = 10;

/// Samples of a stretch.
const SAMPLES: usize = 64;

/// How much less the last stretch holds than the first, where there is an integral that a quadrature finds. Of `x^p` it is
/// that for `p > -0.75`.
const LESS: f64 = 1e-3;

/// Whether a function has an integral from 0 to 1: it has values there, and what the stretch around the largest of them
/// holds falls with the length of that. Around a pole it does not.
pub(super) fn is_integrable(value: impl Fn(f64) -> f64) -> bool {
    let mut stretch = 0.0..1.0;
    let mut held = Vec::new();
    for _ in 0..LOOKS {
        let Some((largest, around)) = look(&value, &stretch) else {
            return false;
        };
        held.push(largest * (stretch.end - stretch.start));
        stretch = around;
    }
    held[LOOKS - 1] <= LESS * held[0]
}

/// The largest finite size in a stretch, and what lies around the largest size of all; none if some have no value, or none
/// is finite.
fn look(value: impl Fn(f64) -> f64, stretch: &Range<f64>) -> Option<(f64, Range<f64>)> {
    let part = (stretch.end - stretch.start) / SAMPLES as f64;
    let (mut finite, mut all, mut place) = (None, -1.0, 0);
    for sample in 0..SAMPLES {
        // In the middle of its part, since functions that have an integral may be infinite at an end.
        let size = value(stretch.start + part * (sample as f64 + 0.5)).abs();
        if size.is_nan() {
            return None;
        }
        if size > all {
            (all, place) = (size, sample);
        }
        if size.is_finite() {
            finite = Some(size.max(finite.unwrap_or(0.0)));
        }
    }
    let bound = |part_number: f64| {
        let bound = stretch.start + part * part_number;
        bound.clamp(stretch.start, stretch.end)
    };
    let around = bound(place as f64 - 1.0)..bound(place as f64 + 2.0);
    Some((finite?, around))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poles_are_found_wherever_they_are() {
        for place in [0.0, 1e-9, 0.25, 0.3_f64.sqrt(), 0.987_654_321, 1.0] {
            for power in [1.0, 1.5, 2.0, 13.0] {
                let pole = |x: f64| (x - place).abs().powf(-power);
                assert!(!is_integrable(pole), "{power} at {place}");
                assert!(!is_integrable(|x| pole(x).copysign(x - place) + x.exp()));
            }
        }
        assert!(!is_integrable(|x| (x - 0.3).ln()));
    }

    #[test]
    fn what_has_an_integral_is_seen_to_have_one() {
        for place in [0.0, 1e-9, 0.25, 0.3_f64.sqrt(), 1.0] {
            let ways: [fn(f64) -> f64; 6] = [
                |way| way.abs().ln(),
                |way| way.abs().powf(-0.5),
                |way| (1e6 * way).tanh(),
                |way| 1.0 / (way * way + 1e-6),
                |way| 1.0 / way.tanh() - 1.0 / way,
                |_| 0.0,
            ];
            for (number, function) in ways.iter().enumerate() {
                assert!(
                    is_integrable(|x| function(x - place)),
                    "{number} at {place}"
                );
            }
        }
    }
}
