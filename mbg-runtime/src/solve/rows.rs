//! Linear systems whose unknowns are states and inputs, with any rank.

use nalgebra::{SMatrix, SVector};

use crate::Real;

/// Passes over all pairs of rows at most: each squares what is left of the angles between them.
const PASSES: usize = 30;
/// Passes that bring the entries of rows and columns to the size of one.
const BALANCES: usize = 3;

/// Sizes of states and inputs.
pub(crate) type Sizes<const N: usize, const M: usize> = (SVector<f64, N>, SVector<f64, M>);

/// An equation `a · x + b · u = right`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row<const N: usize, const M: usize> {
    by_state: SVector<f64, N>,
    by_input: SVector<f64, M>,
    right: f64,
    /// What it was multiplied by.
    weight: f64,
}

impl<const N: usize, const M: usize> Row<N, M> {
    pub(crate) fn new(by_state: SVector<f64, N>, by_input: SVector<f64, M>, right: f64) -> Self {
        Self {
            by_state,
            by_input,
            right,
            weight: 1.0,
        }
    }

    /// An equation that says nothing.
    pub(crate) fn empty() -> Self {
        Self::new(SVector::zeros(), SVector::zeros(), 0.0)
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.largest() == 0.0
    }

    /// The entry of a state or, behind these, of an input.
    pub(crate) fn entry(&self, number: usize) -> f64 {
        let mut entries = self.by_state.iter().chain(&self.by_input);
        entries.nth(number).copied().unwrap_or(0.0)
    }

    /// The number by which another one is to be multiplied to be this one, but for such a part of it.
    pub(crate) fn in_units_of(&self, other: &Self, part: f64) -> Option<f64> {
        let pairs = || self.pairs(other);
        let (own, largest) = pairs().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
        let number = own / largest;
        let aside = |(own, other): (f64, f64)| (own - number * other).abs();
        let least = part * own.abs();
        let is_same = own != 0.0 && number.is_finite() && pairs().all(|it| aside(it) <= least);
        is_same.then_some(number)
    }

    /// Whether it is another one, times this number, but for such a part of each of its entries, which may have any units, and of
    /// the terms of its right side.
    pub(crate) fn is_multiple(
        &self,
        (other, times): (&Self, f64),
        sizes: &Sizes<N, M>,
        part: f64,
    ) -> bool {
        let near = |(own, other): (f64, f64)| (own - times * other).abs() <= part * own.abs();
        let aside = (self.right - times * other.right).abs();
        self.pairs(other).all(near) && aside <= part * (self.right.abs() + self.terms(sizes))
    }

    pub(crate) fn is_finite(&self) -> bool {
        self.pairs(self).all(|(own, _)| own.is_finite()) && self.right.is_finite()
    }

    /// Its entries next to those of another one.
    fn pairs(&self, other: &Self) -> impl Iterator<Item = (f64, f64)> {
        let (states, inputs) = (self.by_state.iter(), self.by_input.iter());
        let pairs = states
            .zip(&other.by_state)
            .chain(inputs.zip(&other.by_input));
        pairs.map(|(own, other)| (*own, *other))
    }

    /// The terms that it is made of where unknowns have these sizes.
    fn terms(&self, (states, inputs): &Sizes<N, M>) -> f64 {
        self.by_state.abs().dot(states) + self.by_input.abs().dot(inputs)
    }

    /// What is left of it, its right side, beside the terms that it is made of where unknowns have these sizes.
    pub(crate) fn part_left(&self, sizes: &Sizes<N, M>) -> f64 {
        if self.right == 0.0 {
            return 0.0;
        }
        self.right.abs() / self.terms(sizes)
    }

    /// How much of an input makes up for what terms of these sizes have beyond rounding, if it has an influence.
    pub(crate) fn error(&self, input: usize, sizes: &Sizes<N, M>, rounding: f64) -> Option<f64> {
        let slope = self.by_input.get(input).filter(|slope| **slope != 0.0)?;
        Some((self.terms(sizes) - rounding).max(0.0) / slope.abs())
    }

    fn largest(&self) -> f64 {
        let entries = self.by_state.iter().chain(self.by_input.iter());
        entries.fold(0.0, |largest, entry| largest.max(entry.abs()))
    }

    fn dot(&self, other: &Self) -> f64 {
        self.by_state.dot(&other.by_state) + self.by_input.dot(&other.by_input)
    }

    fn times(mut self, factor: f64) -> Self {
        self.by_state *= factor;
        self.by_input *= factor;
        self.right *= factor;
        self.weight *= factor;
        self
    }

    fn plus(mut self, other: &Self) -> Self {
        self.by_state += other.by_state;
        self.by_input += other.by_input;
        self.right += other.right;
        self
    }
}

/// `N` equations and `P` more for `N` states and `M` inputs.
///
/// They are brought to the size of one, then turned into each other until all are at right angles, by Hestenes' rotations from one
/// side: then their lengths are the singular values, and each says its part of the solution for itself, whatever the rank.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rows<const N: usize, const M: usize, const P: usize> {
    rates: [Row<N, M>; N],
    outputs: [Row<N, M>; P],
    /// What unknowns are measured in.
    units: (SVector<f64, N>, SVector<f64, M>),
    /// How the state changes by each of them.
    along: SMatrix<f64, N, N>,
}

impl<const N: usize, const M: usize, const P: usize> Rows<N, M, P> {
    pub(crate) fn new(rates: [Row<N, M>; N], outputs: [Row<N, M>; P]) -> Self {
        let units = (SVector::repeat(1.0), SVector::repeat(1.0));
        Self {
            rates,
            outputs,
            units,
            along: SMatrix::identity(),
        }
    }

    /// Where one state changes as an earlier one does, times a number, what they differ by stays as it is in a guess, for their
    /// changes say nothing of it: such are the displacements of two springs at one junction. Both must be among these.
    pub(crate) fn keep_differences(
        &mut self,
        among: &[bool; N],
        (state, guess): (&SVector<f64, N>, &SVector<f64, N>),
        part: f64,
    ) {
        let rates = self.rates;
        for number in (1..N).filter(|number| among[*number]) {
            let mut earlier = (0..number).filter(|earlier| among[*earlier]);
            let same = earlier.find_map(|earlier| {
                let times = rates[number].in_units_of(&rates[earlier], part)?;
                Some((earlier, times))
            });
            if let Some((earlier, times)) = same {
                let mut by_state = SVector::<f64, N>::zeros();
                (by_state[number], by_state[earlier]) = (1.0, -times);
                let left = by_state.dot(&(state - guess));
                self.rates[number] = Row::new(by_state, SVector::zeros(), left);
            }
        }
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &Row<N, M>> {
        self.rates.iter().chain(&self.outputs)
    }

    fn iter_mut(&mut self) -> impl Iterator<Item = &mut Row<N, M>> {
        self.rates.iter_mut().chain(&mut self.outputs)
    }

    /// These sizes, but no unknown smaller than this part of what would be as much as all else that an equation has: what is zero
    /// has a size by that, in its own unit.
    ///
    /// An equation in which an unknown has less than this part of its balanced entries tells nothing: that may be what rounding has
    /// left of slopes that cancel out, and sizes by that would hide whatever is left of other equations.
    #[inline(never)]
    pub(crate) fn seen(
        &self,
        sizes: &Sizes<N, M>,
        part: f64,
        tangents: &SMatrix<f64, N, N>,
    ) -> Sizes<N, M> {
        let (mut states, mut inputs) = *sizes;
        let mut balanced = *self;
        balanced.balance(tangents);
        for (row, balanced) in self.iter().zip(balanced.iter()) {
            let terms = row.right.abs() + row.terms(sizes);
            let see = |size: &mut f64, entry: f64, balanced: f64| {
                let other = part * (terms / entry.abs());
                if other.is_finite() && balanced.abs() > part {
                    *size = size.max(other);
                }
            };
            states.zip_zip_apply(&row.by_state, &balanced.by_state, see);
            inputs.zip_zip_apply(&row.by_input, &balanced.by_input, see);
        }
        // In balanced units unknowns are about as large as each other, and so is what no other equation tells of: a velocity
        // at rest.
        let units = &balanced.units;
        let (by_state, by_input) = (
            sizes.0.component_div(&units.0),
            sizes.1.component_div(&units.1),
        );
        let least = part
            * by_state
                .iter()
                .chain(&by_input)
                .fold(0.0, |most: f64, it| most.max(*it));
        let larger = |size: &mut f64, unit: f64| *size = size.max(least * unit);
        states.zip_apply(&units.0, larger);
        inputs.zip_apply(&units.1, larger);
        (states, inputs)
    }

    /// Takes away the influence of what does not change.
    #[inline(never)]
    pub(crate) fn fix(&mut self, (states, inputs): &([bool; N], [bool; M])) {
        let fix = |slope: &mut f64, is_fixed| *slope = if is_fixed { 0.0 } else { *slope };
        for row in self.iter_mut() {
            row.by_state.zip_apply(&SVector::from(*states), fix);
            row.by_input.zip_apply(&SVector::from(*inputs), fix);
        }
    }

    /// What equations were multiplied by.
    pub(crate) fn weights(&self) -> (SVector<f64, N>, SVector<f64, P>) {
        (
            SVector::from(self.rates.map(|row| row.weight)),
            SVector::from(self.outputs.map(|row| row.weight)),
        )
    }

    /// Turns the equations to right angles, with changes of the state along `tangents`.
    #[inline(never)]
    pub(crate) fn straighten(&mut self, tangents: &SMatrix<f64, N, N>) {
        let closed = closed(tangents, &self.units.0);
        self.along = tangents * SMatrix::from_diagonal(&self.units.0);
        for row in self.iter_mut() {
            row.by_state = closed(&row.by_state);
        }
        for _ in 0..PASSES {
            let mut turned = false;
            for second in 1..N + P {
                for first in 0..second {
                    turned |= self.turn(first, second);
                }
            }
            if !turned {
                break;
            }
        }
    }

    /// The least-squares solution that is least in units of unknowns, of equations at right angles, by those that are not smaller
    /// than a part of the largest one.
    #[inline(never)]
    pub(crate) fn solution(&self, part: f64) -> (SVector<f64, N>, SVector<f64, M>) {
        let largest = self.iter().map(|row| row.dot(row)).fold(0.0, f64::max);
        let mut sum = Row::empty();
        for row in self.iter() {
            let square = row.dot(row);
            if square > part * part * largest {
                sum = sum.plus(&row.times(row.right / square));
            }
        }
        (
            self.along * sum.by_state,
            sum.by_input.component_mul(&self.units.1),
        )
    }

    /// Brings the largest entries of rows and columns to the size of one: the scaling of Ruiz. A state does what it does by itself,
    /// and what it does by changes along `tangents`: the angle of a rod that stays level does nothing but turn what it is joined to.
    #[inline(never)]
    pub(crate) fn balance(&mut self, tangents: &SMatrix<f64, N, N>) {
        for _ in 0..BALANCES {
            let closed = closed(tangents, &self.units.0);
            let mut by_state = SVector::<f64, N>::zeros();
            let mut by_input = SVector::<f64, M>::zeros();
            for row in self.iter_mut() {
                *row = row.times(inverse_root(row.largest(), 0.0));
                by_state.zip_apply(&row.by_state, larger);
                by_state.zip_apply(&closed(&row.by_state), larger);
                by_input.zip_apply(&row.by_input, larger);
            }
            // What no row has more of than rounding has no influence.
            let unit = |largest| inverse_root(largest, f64::EPSILON);
            let (by_state, by_input) = (by_state.map(unit), by_input.map(unit));
            for row in self.iter_mut() {
                row.by_state.component_mul_assign(&by_state);
                row.by_input.component_mul_assign(&by_input);
            }
            self.units.0.component_mul_assign(&by_state);
            self.units.1.component_mul_assign(&by_input);
        }
    }

    /// Measures no unknown in a larger unit than these, and lowers them to the present ones.
    ///
    /// What has an influence only while equations do not hold, such as the angles of a load on a rope with the force that is left
    /// on it, would move without bound where hardly anything is left.
    #[inline(never)]
    pub(crate) fn limit(&mut self, most: &mut Sizes<N, M>) {
        let lower = |most: &mut f64, unit: f64| *most = most.min(unit);
        most.0.zip_apply(&self.units.0, lower);
        most.1.zip_apply(&self.units.1, lower);
        let by_state = most.0.component_div(&self.units.0);
        let by_input = most.1.component_div(&self.units.1);
        for row in self.iter_mut() {
            row.by_state.component_mul_assign(&by_state);
            row.by_input.component_mul_assign(&by_input);
        }
        self.units = *most;
    }

    /// Turns two rows to right angles; whether they were not.
    #[inline(never)]
    fn turn(&mut self, first: usize, second: usize) -> bool {
        let (a, b) = (*self.at(first), *self.at(second));
        let [size, other, common] = [a.dot(&a), b.dot(&b), a.dot(&b)];
        if common == 0.0 || common.abs() <= f64::EPSILON * Real::sqrt(size * other) {
            return false;
        }
        let half = (other - size) / (2.0 * common);
        let tangent = Real::sign(half) / (half.abs() + Real::sqrt(1.0 + half * half));
        let tangent = if half == 0.0 { 1.0 } else { tangent };
        let cosine = 1.0 / Real::sqrt(1.0 + tangent * tangent);
        let sine = cosine * tangent;
        *self.at(first) = a.times(cosine).plus(&b.times(-sine));
        *self.at(second) = a.times(sine).plus(&b.times(cosine));
        true
    }

    fn at(&mut self, row: usize) -> &mut Row<N, M> {
        if row < N {
            &mut self.rates[row]
        } else {
            &mut self.outputs[row - N]
        }
    }
}

/// What slopes by states in these units are for changes along tangents.
fn closed<const N: usize>(
    tangents: &SMatrix<f64, N, N>,
    units: &SVector<f64, N>,
) -> impl Fn(&SVector<f64, N>) -> SVector<f64, N> + use<N> {
    let along = tangents * SMatrix::from_diagonal(units);
    let inverse = units.map(|unit| 1.0 / unit);
    move |slopes| along.tr_mul(&slopes.component_mul(&inverse))
}

fn larger(largest: &mut f64, entry: f64) {
    *largest = largest.max(entry.abs());
}

/// Of what is too small, one.
fn inverse_root(size: f64, small: f64) -> f64 {
    if size > small {
        1.0 / Real::sqrt(size)
    } else {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(by_state: [f64; 2], by_input: [f64; 2], right: f64) -> Row<2, 2> {
        Row::new(SVector::from(by_state), SVector::from(by_input), right)
    }

    fn balanced<const P: usize>(mut rows: Rows<2, 2, P>) -> (SVector<f64, 2>, SVector<f64, 2>) {
        rows.balance(&SMatrix::identity());
        rows.straighten(&SMatrix::identity());
        rows.solution(1e-9)
    }

    /// Solutions of what is solved exactly, whatever the units.
    #[test]
    fn what_is_asked_holds() {
        let rates = [
            row([1e8, 2.0], [0.0, 3e-6], 1e8),
            row([0.0, 1e-7], [1e-9, 0.0], 2e-7),
        ];
        let outputs = [row([1.0, 1.0], [1.0, 1.0], 4.0)];
        let rows = Rows::new(rates, outputs);
        let (x, u) = balanced(rows);
        for row in rows.iter() {
            let left = row.by_state.dot(&x) + row.by_input.dot(&u) - row.right;
            assert!(left.abs() < 1e-12 * row.right, "{left:e}");
        }
    }

    #[test]
    fn what_is_told_twice_is_told_once_and_effort_is_shared() {
        let told = row([0.0, 0.0], [1.0, 1.0], 2.0);
        let rows = Rows::new([told, told.times(1e3)], [told]);
        let (x, u) = balanced(rows);
        assert!(x.norm() < 1e-15 && (u - SVector::from([1.0, 1.0])).norm() < 1e-14);
    }

    #[test]
    fn states_change_along_tangents_alone() {
        let mut rows = Rows::new(
            [
                row([1.0, 0.0], [0.0, 0.0], 1.0),
                row([0.0; 2], [0.0; 2], 0.0),
            ],
            [],
        );
        let tangents = SMatrix::from([[0.5, 0.5], [0.5, 0.5]]);
        rows.balance(&tangents);
        rows.straighten(&tangents);
        let (x, _) = rows.solution(1e-9);
        assert!((x - SVector::from([1.0, 1.0])).norm() < 1e-14, "{x}");
    }

    /// A slope that is rounding beside the others makes no unknown so large that what is left elsewhere is small beside it.
    #[test]
    fn rounding_of_a_slope_hides_nothing() {
        let rates = [
            row([1e5, -1e-18], [0.0; 2], 0.0),
            row([2.0, 1.0], [0.0; 2], 1e-3),
        ];
        let rows = Rows::new(rates, []);
        let sizes = (SVector::repeat(1.0), SVector::zeros());
        let seen = rows.seen(&sizes, 1e-9, &SMatrix::identity());
        let left = rows.iter().map(|row| row.part_left(&seen)).sum::<f64>();
        assert!((left - 1e-3 / 3.0).abs() < 1e-15, "{left:e}");
    }

    #[test]
    fn what_loses_its_influence_stays_in_its_unit() {
        let mut units = (
            SVector::repeat(f64::INFINITY),
            SVector::repeat(f64::INFINITY),
        );
        let solution = |slope: f64, units: &mut Sizes<2, 2>| {
            let rate = row([1.0, slope], [0.0; 2], slope);
            let mut rows = Rows::new([rate, Row::empty()], []);
            rows.balance(&SMatrix::identity());
            rows.limit(units);
            rows.straighten(&SMatrix::identity());
            rows.solution(1e-9).0
        };
        let (first, second) = (solution(1.0, &mut units), solution(1e-6, &mut units));
        assert!(
            (first - SVector::from([0.5, 0.5])).norm() < 1e-15,
            "{first}"
        );
        assert!(
            (second - SVector::from([1e-6, 1e-12])).norm() < 1e-15,
            "{second}"
        );
    }
}
