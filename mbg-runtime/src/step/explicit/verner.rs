//! The pair of Verner of order 9(8), with the coefficients of the crate `numeris`.

use numeris::ode::{RKAdaptive, RKV98};

use super::Tableau;

const STAGES: usize = 16;
/// With the slope at the end, and stages for the dense output.
const ALL: usize = 21;
const DEGREE: usize = 8;

const ROWS: &[[f64; ALL]; ALL] = &RKV98::A;
const ERROR: &[f64; ALL] = &RKV98::BERR;
const DENSE: &[[f64; ALL]; DEGREE] = &dense();

/// Sixteen stages, the last of which serves the estimate alone, the slope at the end, and four more for the dense output.
pub(super) const VERNER9: Tableau<STAGES, ALL> = Tableau {
    nodes: RKV98::C,
    rows: rows(),
    errors: [ERROR.split_at(STAGES).0, &[]],
    dense: [&DENSE[3], &DENSE[4], &DENSE[5], &DENSE[6], &DENSE[7]],
};

/// The weights of what comes before each stage; those of the result are those of the slope at the end.
const fn rows() -> [&'static [f64]; ALL] {
    let mut rows: [&[f64]; ALL] = [&[]; ALL];
    let mut stage = 0;
    while stage < ALL {
        rows[stage] = ROWS[stage].split_at(stage).0;
        stage += 1;
    }
    rows
}

/// The polynomials over a step by which the stages count, from powers into the form of
/// [`Polynomial`](super::Polynomial): the remainders of divisions by `s` and by `1 - s` in turns.
const fn dense() -> [[f64; ALL]; DEGREE] {
    let powers = RKV98::BI;
    let mut dense = [[0.0; ALL]; DEGREE];
    let mut stage = 0;
    while stage < ALL {
        // The powers begin with the first: one division by `s` is done.
        let mut rest = powers[stage];
        let mut place = 0;
        while place < DEGREE {
            let left = DEGREE - place;
            dense[place][stage] = if place % 2 == 0 {
                remainder_at_end(&mut rest, left)
            } else {
                remainder_at_start(&mut rest, left)
            };
            place += 1;
        }
        stage += 1;
    }
    dense
}

/// Divides a polynomial of so many coefficients by `1 - s`; gives the remainder, its value at 1.
const fn remainder_at_end(polynomial: &mut [f64; DEGREE], count: usize) -> f64 {
    let mut value = 0.0;
    let mut power = count;
    while power > 0 {
        power -= 1;
        // The quotient's coefficient of this power is minus the sum of those above it.
        let above = value;
        value += polynomial[power];
        polynomial[power] = -above;
    }
    value
}

/// Divides a polynomial of so many coefficients by `s`; gives the remainder, its value at 0.
const fn remainder_at_start(polynomial: &mut [f64; DEGREE], count: usize) -> f64 {
    let value = polynomial[0];
    let mut power = 1;
    while power < count {
        polynomial[power - 1] = polynomial[power];
        power += 1;
    }
    value
}
