//! The pair of Verner of order 9(8), with the coefficients of the crate `numeris`.

use numeris::ode::{RKAdaptive, RKV98};

use super::Tableau;
use crate::step::dense::{DEGREE, in_turns};

const STAGES: usize = 16;
/// With the slope at the end, and stages for the dense output.
const ALL: usize = 21;

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

/// The polynomials over a step by which the stages count, in the form of [`Polynomial`](super::Polynomial).
const fn dense() -> [[f64; ALL]; DEGREE] {
    let powers = RKV98::BI;
    let mut dense = [[0.0; ALL]; DEGREE];
    let mut stage = 0;
    while stage < ALL {
        let mut of_stage = [0.0; DEGREE];
        let mut power = 0;
        while power < powers[stage].len() {
            of_stage[power] = powers[stage][power];
            power += 1;
        }
        let coefficients = in_turns(of_stage);
        let mut place = 0;
        while place < DEGREE {
            dense[place][stage] = coefficients[place];
            place += 1;
        }
        stage += 1;
    }
    dense
}
