//! Lobatto's methods IIIA, from their nodes.
//!
//! Slopes at the nodes are sums of Legendre's polynomials, and their integrals are known in closed form: Hairer and
//! Wanner, *Solving Ordinary Differential Equations II*, 2nd ed. (1996), IV.5.

use crate::step::dense::{DEGREE, in_turns};

/// Coefficients of a method with `S` nodes, of which all but the first make `G` groups of four.
pub(super) struct Tableau<const S: usize, const G: usize> {
    /// The nodes; the first is the start, the last the end.
    pub(super) nodes: [f64; S],
    /// Weights of the slope at each node in the states at all nodes but the first.
    pub(super) weights: [[[f64; 4]; G]; S],
    /// Weights of the slope at each node in two of Legendre's coefficients: the last one, and that of half its degree.
    pub(super) legendre: [[f64; 2]; S],
    /// Weights of the slope at each node in the coefficients of the polynomial over the step, behind those of the cubic.
    pub(super) dense: [[f64; S]; DEGREE - 3],
}

impl<const S: usize, const G: usize> Tableau<S, G> {
    pub(super) const fn new(nodes: [f64; S]) -> Self {
        let mut tableau = Self {
            nodes,
            weights: [[[0.0; 4]; G]; S],
            legendre: [[0.0; 2]; S],
            dense: [[0.0; S]; DEGREE - 3],
        };
        let mut node = 0;
        while node < S {
            let series = series::<S>(nodes[node]);
            let mut stage = 1;
            while stage < S {
                let weight = integral(&series, nodes[stage]);
                tableau.weights[node][(stage - 1) / 4][(stage - 1) % 4] = weight;
                stage += 1;
            }
            tableau.legendre[node] = [series[(S - 1) / 2], series[S - 1]];
            let mut degree = 1;
            while degree < S {
                let integral = INTEGRALS[degree];
                let mut place = 3;
                while place < DEGREE {
                    tableau.dense[place - 3][node] += series[degree] * integral[place];
                    place += 1;
                }
                degree += 1;
            }
            node += 1;
        }
        tableau
    }
}

/// Legendre's coefficients of the slope that is one at this node and zero at all others.
const fn series<const S: usize>(node: f64) -> [f64; S] {
    let degree = (S - 1) as f64;
    let values = legendre(node);
    let last = values[S - 1];
    let weight = 1.0 / (degree * (degree + 1.0) * last * last);
    let mut series = [0.0; S];
    let mut place = 0;
    while place < S {
        // The square of the last polynomial is not summed exactly.
        let norm = if place == S - 1 {
            degree
        } else {
            2.0 * place as f64 + 1.0
        };
        series[place] = weight * norm * values[place];
        place += 1;
    }
    series
}

/// The integral of a series from zero to `s`.
const fn integral<const S: usize>(series: &[f64; S], s: f64) -> f64 {
    let values = legendre(s);
    let mut sum = series[0] * s;
    let mut place = 1;
    while place < S {
        let change = values[place + 1] - values[place - 1];
        sum += series[place] * change / (4.0 * place as f64 + 2.0);
        place += 1;
    }
    sum
}

/// The values at `s` of Legendre's polynomials over the step.
const fn legendre(s: f64) -> [f64; DEGREE + 1] {
    let x = 2.0 * s - 1.0;
    let mut values = [1.0; DEGREE + 1];
    values[1] = x;
    let mut place = 1;
    while place < DEGREE {
        let degree = place as f64;
        let next = (2.0 * degree + 1.0) * x * values[place] - degree * values[place - 1];
        values[place + 1] = next / (degree + 1.0);
        place += 1;
    }
    values
}

/// The integrals of Legendre's polynomials over the step, as they are interpolated.
const INTEGRALS: [[f64; DEGREE]; DEGREE] = {
    let mut integrals = [[0.0; DEGREE]; DEGREE];
    let mut degree = 1;
    while degree < DEGREE {
        // The integral is a multiple of what the next polynomial is more than the one before. All coefficients are integers.
        let (next, before) = (powers(degree + 1), powers(degree - 1));
        let mut difference = [0.0; DEGREE];
        let mut place = 0;
        while place < DEGREE {
            difference[place] = next[place + 1] - before[place + 1];
            place += 1;
        }
        integrals[degree] = in_turns(difference);
        let mut place = 0;
        while place < DEGREE {
            integrals[degree][place] /= 4.0 * degree as f64 + 2.0;
            place += 1;
        }
        degree += 1;
    }
    integrals
};

/// Legendre's polynomial of this degree over the step, as coefficients of powers of `s`, which are integers.
const fn powers(degree: usize) -> [f64; DEGREE + 1] {
    let mut powers = [0.0; DEGREE + 1];
    powers[0] = if degree.is_multiple_of(2) { 1.0 } else { -1.0 };
    let mut power = 0;
    while power < degree {
        let product = (degree - power) * (degree + power + 1);
        powers[power + 1] = -powers[power] * product as f64 / ((power + 1) * (power + 1)) as f64;
        power += 1;
    }
    powers
}
