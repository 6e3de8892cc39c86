//! Which of thresholds next to each other a motion stays on.

use nalgebra::{SMatrix, SVector};

use super::Each;
use crate::solve::Regular;

/// Of several means that all hold the one next to that of equal parts is taken, by this part of what each makes different itself.
const EVEN: f64 = 1e-10;
/// What is so little of what a surface makes different itself is rounding.
const ROUNDING: f64 = 1e-12;
/// So often a surface changes how it is.
const TURNS: usize = 1024;

/// How a motion is at a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Choice {
    /// It stays there, by so much of what is ahead.
    Stays(f64),
    /// It goes where it is not ahead.
    Before,
    /// It goes ahead.
    Ahead,
}

impl Choice {
    /// The part of the mean that is ahead.
    pub(super) const fn part(self) -> f64 {
        match self {
            Self::Stays(part) => part,
            Self::Before => 0.0,
            Self::Ahead => 1.0,
        }
    }
}

/// How a motion is at the first surfaces, as many as there are, where each is known as it is if that is given.
///
/// `rates` has how fast each goes ahead before all of them, and how much faster behind each of them: in the mean with these parts
/// all rates are zero, or lead where the part is. That is a linear complementarity problem with bounds, whose solution is the only one
/// if what surfaces make different are losses (a P-matrix); of those that violate it the first one changes (Murty, *Linear
/// Complementarity, Linear and Nonlinear Programming*, Heldermann 1988, §4.2; with bounds on both sides by the same induction).
pub(super) fn chosen<const K: usize>(
    (first, faster): (&Each<f64, K>, &Each<Each<f64, K>, K>),
    count: usize,
    known: &Each<Option<Choice>, K>,
) -> Option<Each<Choice, K>> {
    let mut choices = Each::all(Choice::Stays(0.5));
    for (choice, known) in choices.iter_mut().zip(known).take(count) {
        *choice = known.unwrap_or(*choice);
    }
    // By how much slower each is behind itself.
    let own = |row: usize| -faster[row][row];
    let slower = |row: usize, column: usize| {
        let even = if row == column { EVEN } else { 0.0 };
        even - faster[column][row] / own(row)
    };
    let is_open = |place: usize| place < count && known[place].is_none();
    for _ in 0..TURNS {
        let stays = |place: usize| is_open(place) && matches!(choices[place], Choice::Stays(_));
        let matrix =
            SMatrix::<f64, K, K>::from_fn(|row, column| match stays(row) && stays(column) {
                true => slower(row, column),
                false => f64::from(u8::from(row == column)),
            });
        // How fast each still goes ahead with the parts of those that do not stay, beside what slows it.
        let open = |row: usize| {
            let others = (0..count).filter(|other| !stays(*other));
            let by_others: f64 = others
                .map(|other| slower(row, other) * choices[other].part())
                .sum();
            first[row] / own(row) + 0.5 * EVEN - by_others
        };
        let right = SVector::<f64, K>::from_fn(|row, _| match stays(row) {
            true => open(row),
            false => 0.0,
        });
        let solution = Regular::new(matrix).solution(&right);
        let parts = Each::<f64, K>::of(|place| solution[place]);
        if parts.iter().any(|part| !part.is_finite()) {
            return None;
        }
        let rate = |row: usize| {
            let staying = (0..count).filter(|other| stays(*other));
            let by_those: f64 = staying.map(|other| slower(row, other) * parts[other]).sum();
            open(row) - by_those
        };
        let change = (0..count)
            .filter(|place| is_open(*place))
            .find_map(|place| {
                let there = match choices[place] {
                    Choice::Stays(_) if parts[place] < -ROUNDING => Choice::Before,
                    Choice::Stays(_) if parts[place] > 1.0 + ROUNDING => Choice::Ahead,
                    Choice::Before if rate(place) > ROUNDING => Choice::Stays(0.5),
                    Choice::Ahead if rate(place) < -ROUNDING => Choice::Stays(0.5),
                    _ => return None,
                };
                Some((place, there))
            });
        match change {
            Some((place, there)) => choices[place] = there,
            None => {
                let staying: Each<bool, K> = Each::of(stays);
                for (place, choice) in choices.iter_mut().enumerate() {
                    if staying[place] {
                        *choice = Choice::Stays(parts[place]);
                    }
                }
                return Some(choices);
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// More than there are.
    const K: usize = 4;

    /// Masses of 1 kg, forces on them, and what rubs: the speeds of each, and the most it takes.
    fn rubbing(
        forces: &[f64],
        pairs: &[(usize, Option<usize>, f64)],
    ) -> (Each<f64, K>, Each<Each<f64, K>, K>) {
        let along = |pair: &(usize, Option<usize>, f64), mass: usize| -> f64 {
            f64::from(u8::from(pair.0 == mass)) - f64::from(u8::from(pair.1 == Some(mass)))
        };
        let product = |a, b| {
            (0..forces.len())
                .map(|mass| along(a, mass) * along(b, mass))
                .sum::<f64>()
        };
        let (mut first, mut faster) = (Each::all(0.0), Each::all(Each::all(0.0)));
        for (row, pair) in pairs.iter().enumerate() {
            first[row] = (0..forces.len())
                .map(|mass| along(pair, mass) * forces[mass])
                .sum();
            for (column, other) in pairs.iter().enumerate() {
                faster[column][row] = -2.0 * other.2 * product(pair, other);
                first[row] += other.2 * product(pair, other);
            }
        }
        (first, faster)
    }

    fn of(forces: &[f64], pairs: &[(usize, Option<usize>, f64)]) -> [Choice; K] {
        let (first, faster) = rubbing(forces, pairs);
        *chosen((&first, &faster), pairs.len(), &Each::all(None)).unwrap()
    }

    #[test]
    fn a_brake_holds_as_much_as_it_can() {
        let [held, ..] = of(&[0.5], &[(0, None, 1.0)]);
        assert!((held.part() - 0.75).abs() < 1e-9, "{held:?}");
        assert_eq!(of(&[1.5], &[(0, None, 1.0)])[0], Choice::Ahead);
        assert_eq!(of(&[-1.5], &[(0, None, 1.0)])[0], Choice::Before);
    }

    /// A force of 2.5 N tears a mass loose from its brake, and drags at another one that its own brake holds.
    #[test]
    fn what_is_torn_loose_drags_at_what_holds() {
        let pairs = [(0, None, 1.0), (1, None, 1.2), (0, Some(1), 1.0)];
        let [first, second, between, ..] = of(&[2.5, 0.0], &pairs);
        assert_eq!((first, between), (Choice::Ahead, Choice::Ahead));
        assert!(
            matches!(second, Choice::Stays(part) if (part - 11.0 / 12.0).abs() < 1e-9),
            "{second:?}"
        );
    }

    /// Three clutches in a ring: of the parts that hold the ring those next to each other are taken.
    #[test]
    fn parts_of_a_ring_are_even() {
        let pairs = [(0, Some(1), 1.0), (1, Some(2), 1.0), (2, Some(0), 1.0)];
        let choices = of(&[0.9, 0.0, 0.0], &pairs);
        let expected = [0.5 + 0.15, 0.5, 0.5 - 0.15];
        for (choice, part) in choices.iter().zip(expected) {
            assert!(
                matches!(choice, Choice::Stays(it) if (it - part).abs() < 1e-6),
                "{choices:?}"
            );
        }
    }

    #[test]
    fn what_is_known_stays_so() {
        let (first, faster) = rubbing(&[0.5, 0.0], &[(0, None, 1.0), (0, Some(1), 1.0)]);
        let mut known = Each::all(None);
        known[1] = Some(Choice::Before);
        let [brake, clutch, ..] = *chosen((&first, &faster), 2, &known).unwrap();
        assert_eq!((brake, clutch), (Choice::Ahead, Choice::Before));
    }
}
