//! Collocation by sweeps that evaluate all stages at once.

mod between;
mod lobatto;
mod sweep;

use core::array;
use core::marker::PhantomData;

use nalgebra::SVector;

use self::lobatto::Tableau;
use self::sweep::{Nodes, Sweep, advance, at, last, scaled, summed};
use super::dense::{Part, Polynomial};
use super::method::{
    Estimating, Family, Method, Start, Stepper, Trial, combination, lagrange, leading,
};
use super::problem::Problem;
use super::seen;
use super::tolerance::{Measure, Tolerance};
use crate::{Columns, Input, Real, System};

/// The parallel iteration of Lobatto's method with five stages.
///
/// | order | in between | estimate | evaluations a step | stable for real `hλ` from | for imaginary `hλ` up to |
/// |---|---|---|---|---|---|
/// | 8 | 5, error of power 6, free of charge; where that is less exact than the ends, over parts of the step | 8 | four sweeps of four at once, at times one more | −1.69 | 1.70, but up to 1.0 it grows by as much as 1e-6 a step |
///
/// For smooth problems to tight tolerances whose derivative is not cheap, in programs that are compiled for registers of four
/// numbers (`-C target-cpu=x86-64-v3` or `native`) with the feature `lanes`: a sweep evaluates all stages in little more
/// time than one ([`System::derivatives`]). Without lanes, in `f32`, on dual numbers and for models with nonlinear loops it
/// gives the same, and [`Dop853`](super::Dop853) is faster. So it is for a handful of products per state.
///
/// Not for laws that bend, as at contacts and in dry friction: a ball that bounces off a stiff floor is 0.7 mm off after 5 s at a
/// tolerance of 1e-8, where the other adaptive methods are some micrometres off at most.
///
/// Sweeps begin with the polynomial of the step before. At the start and behind a jump there is none, and three more are
/// taken. The limits of stability are those of steps of one length.
///
/// Ends are of a far higher order than what is in between. Where a sample asks for it, a part of the step, down to a sixteenth,
/// is gone through once more, by up to eight sweeps.
///
/// Source: P. J. van der Houwen and B. P. Sommeijer, *Journal of Computational and Applied Mathematics* 29 (1990),
/// 111–127; the method that is iterated is Lobatto IIIA in Hairer and Wanner, *Solving Ordinary Differential Equations II*,
/// 2nd ed. (1996), IV.5.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pirk8;

/// The parallel iteration of Lobatto's method with nine stages.
///
/// | order | in between | estimate | evaluations a step | stable for real `hλ` from | for imaginary `hλ` up to |
/// |---|---|---|---|---|---|
/// | 16 | 9, error of power 10, free of charge; where that is less exact than the ends, over parts of the step | 16 | nine sweeps of eight, four at once, at times one more | −3.50 | 3.47, but up to 2.2 it grows by as much as 1e-9 a step |
///
/// For long runs of very smooth problems, without jumps and to errors of 1e-6 and less; to 1e-3 the sweeps limit the steps,
/// and other methods are faster. Registers and scalars count as for [`Pirk8`], and so does the source.
///
/// At the start and behind a jump five more sweeps are taken, and no step is more than twice as long as the one before. An
/// input that is not smooth, and not declared, may be too short for its steps: see
/// [`Adaptive::longest`](super::Adaptive::longest). Not for laws that bend, as [`Pirk8`] is not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pirk16;

const LOBATTO5: Tableau<5, 1> = Tableau::new([
    0.0,
    0.172_673_164_646_011_43,
    0.5,
    0.827_326_835_353_988_6,
    1.0,
]);

const LOBATTO9: Tableau<9, 2> = Tableau::new([
    0.0,
    0.050_121_002_294_269_92,
    0.161_406_860_244_631_13,
    0.318_441_268_086_910_9,
    0.5,
    0.681_558_731_913_089_1,
    0.838_593_139_755_368_9,
    0.949_878_997_705_73,
    1.0,
]);

/// An error of up to so many tolerances is worth one more sweep.
const WORTH: f64 = 30.0;

/// A method of this family.
pub trait Swept<const S: usize, const G: usize>: Copy {
    #[doc(hidden)]
    #[allow(private_interfaces, reason = "no method is written outside")]
    const TABLEAU: Tableau<S, G>;

    /// Sweeps of a step, and further ones where there is no step before.
    #[doc(hidden)]
    const SWEEPS: [u32; 2];

    /// How many times longer a step may be than the one before, so that lengths at which an input is followed badly come before
    /// those at which all nodes miss it.
    #[doc(hidden)]
    const GROWTH: f64;

    /// How much faster than by a constant ratio Legendre's coefficients of a sine fall.
    #[doc(hidden)]
    const SINE: f64;
}

/// Slopes at the nodes of a step; of no length as long as there is none.
#[derive(Clone, Copy)]
struct Slopes<T: Real, const N: usize, const G: usize> {
    length: T,
    first: SVector<T, N>,
    others: Nodes<T, N, G>,
}

impl<T: Real, const N: usize, const G: usize> Slopes<T, N, G> {
    fn is_known(&self) -> bool {
        seen(self.length) > 0.0
    }
}

/// The last step that was taken, and the one that was tried last.
///
/// Both keep their place, and what is as large as slopes at all nodes is written where it stays: copied as a whole it goes
/// through memory, in other parts than it is read by what comes next, which has to wait for that.
pub struct Stages<A, T: Real, const N: usize, const S: usize, const G: usize> {
    steps: [Slopes<T, N, G>; 2],
    /// Whether the second of them was tried last.
    is_second: bool,
    method: PhantomData<A>,
}

#[allow(private_interfaces, reason = "no method is written outside")]
impl<A, T, const N: usize, const S: usize, const G: usize> Stepper<A, T, N>
    for Stages<A, T, N, S, G>
where
    A: Swept<S, G>,
    T: Real,
{
    #[inline]
    fn new(_method: &A) -> Self {
        let zero = T::from_f64(0.0);
        let none = Slopes {
            length: zero,
            first: SVector::from_element(zero),
            others: [SVector::from_element(T::Stages::whole(zero)); G],
        };
        Self {
            steps: [none; 2],
            is_second: false,
            method: PhantomData,
        }
    }

    fn attempt<Y, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, Y, I, N, M, P>,
        start: &Start<T, N>,
        tolerance: Option<&Tolerance<N>>,
    ) -> Trial<T, N>
    where
        Y: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let memory = problem.memory;
        let (before, tried) = self.next(start.again);
        let sweep = Sweep::over::<A, _, _, P>(problem, start);
        let sweeps = if before.is_known() {
            A::SWEEPS[0]
        } else {
            A::SWEEPS[0] + A::SWEEPS[1]
        };

        (tried.length, tried.first) = (start.span.length, start.slope);
        Self::predict(before, T::from_f64(1.0), tried);
        let slopes = &mut tried.others;
        let mut stages = sweep.base;
        sweep.advance(&mut stages, slopes);
        let measure =
            tolerance.map(|it| it.between(&start.x, &(last::<T, N, G>(&stages) - start.x)));
        let mut end = start.x;
        let (mut left, mut missed) = (sweeps, 0.0);
        let error = loop {
            for number in 0..left {
                // Stages before a fold of a loop would find its far branch from stages behind it.
                problem.memory = memory;
                sweep.slopes(problem, &stages, slopes);
                if number == 0
                    && left > 1
                    && let Some(measure) = &measure
                {
                    missed = Self::truncation(measure, start, slopes);
                }
                end = last::<T, N, G>(&stages);
                sweep.advance(&mut stages, slopes);
            }
            let change = last::<T, N, G>(&stages) - end;
            let square = measure.as_ref().map_or(0.0, |it| it.square(&change));
            let error = Real::sqrt(square + missed);
            if left == 1 {
                // Good enough or not, the next step shall be shorter.
                break error.max(1.0);
            }
            if !(1.0..WORTH).contains(&error) {
                break error;
            }
            left = 1;
        };
        // What is in between is of far lower order than the end, and would be taken for what a probe looks for: that is worth
        // it where sources may pulse.
        let is_probed = !problem.is_left_alone();
        Trial {
            change: last::<T, N, G>(&stages) - start.x,
            slope: Some(last::<T, N, G>(slopes)),
            error,
            coarse: if is_probed { error * error } else { 0.0 },
        }
    }

    fn polynomial<Y, I, const M: usize, const P: usize>(
        &mut self,
        _problem: &mut Problem<'_, T, Y, I, N, M, P>,
        start: &Start<T, N>,
        (end, _): (&SVector<T, N>, Option<SVector<T, N>>),
    ) -> Polynomial<T, N>
    where
        Y: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        Self::between(self.tried(), start, end)
    }

    fn samples<Y, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, Y, I, N, M, P>,
        start: &Start<T, N>,
        (end, _): (&SVector<T, N>, Option<SVector<T, N>>),
        tolerance: &Tolerance<N>,
        place: f64,
    ) -> Part<T, N>
    where
        Y: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        self.part_at(problem, (start, end), tolerance, place)
    }

    fn growth(&self) -> f64 {
        A::GROWTH
    }
}

impl<A, T, const N: usize, const S: usize, const G: usize> Stages<A, T, N, S, G>
where
    A: Swept<S, G>,
    T: Real,
{
    /// The step that was tried last.
    fn tried(&self) -> &Slopes<T, N, G> {
        let [first, second] = &self.steps;
        if self.is_second { second } else { first }
    }

    /// The polynomial over a step.
    fn between(
        tried: &Slopes<T, N, G>,
        start: &Start<T, N>,
        end: &SVector<T, N>,
    ) -> Polynomial<T, N> {
        let slopes: [SVector<T, N>; S] = array::from_fn(|node| match node {
            0 => tried.first,
            _ => at::<T, N, G>(node, &tried.others),
        });
        let scaled = |slope: SVector<T, N>| slope.map(|slope| tried.length * slope);
        let ends = [slopes[0], slopes[S - 1]].map(scaled);
        let mut polynomial = Polynomial::cubic((&start.x, ends[0]), (end, ends[1]));
        let higher = polynomial.coefficients.iter_mut().skip(3);
        for (coefficient, weights) in higher.zip(const { &A::TABLEAU.dense }) {
            *coefficient = scaled(combination(weights, &slopes));
        }
        polynomial
    }

    /// The last step that was taken, and the place of the one that is to be tried.
    fn next(&mut self, again: bool) -> (&Slopes<T, N, G>, &mut Slopes<T, N, G>) {
        if !again {
            self.is_second = !self.is_second;
        }
        let [first, second] = &mut self.steps;
        if self.is_second {
            (first, second)
        } else {
            (second, first)
        }
    }

    /// The slopes of a step as another one has or continues them, which began so many of its lengths before; without that, those at
    /// the start.
    fn predict(before: &Slopes<T, N, G>, ahead: T, step: &mut Slopes<T, N, G>) {
        if !before.is_known() {
            step.others = [step.first.map(T::Stages::whole); G];
            return;
        }
        let nodes = const { &A::TABLEAU.nodes };
        let ratio = step.length / before.length;
        let offsets = nodes.map(|node| T::Stages::whole(ahead - T::from_f64(node)));
        let mut weights = [[T::Stages::from_f64(0.0); G]; S];
        for group in 0..G {
            let own = array::from_fn(|place| nodes[4 * group + place + 1]);
            let places = scaled::<T>(ratio, own);
            let distances = offsets.map(|offset| places + offset);
            let of_group = lagrange(const { &leading(&A::TABLEAU.nodes) }, &distances);
            for (weights, weight) in weights.iter_mut().zip(of_group) {
                weights[group] = weight;
            }
        }
        let first = before.first.map(T::Stages::whole);
        let base = weights[0].map(|weight| first.map(|slope| weight * slope));
        advance::<T, N, S, G>(&mut step.others, &base, &weights, &before.others);
    }

    /// What the method misses even where the sweeps come to their end: the mean square in units of the tolerance.
    ///
    /// Legendre's coefficients of smooth slopes fall by a ratio r from half the last degree to the last, and by r² or less from
    /// there to twice the last degree, which is the first that the method takes for another. Of a sine it is r² times
    /// [`Swept::SINE`], and a quarter of that counts. Where slopes jump r is near one, and all of the last counts.
    #[inline(never)]
    fn truncation(measure: &Measure<N>, start: &Start<T, N>, slopes: &Nodes<T, N, G>) -> f64 {
        let length = start.span.length;
        let weights = const { &A::TABLEAU.legendre }
            .map(|[half, last]| [scaled::<T>(length, [half, last, 0.0, 0.0])]);
        let both: SVector<T::Stages, N> = SVector::from_fn(|state, _| {
            let first = weights[0][0] * T::Stages::whole(start.slope[state]);
            let [both] = summed::<T, N, S, G, 1>([first], &weights, slopes, state);
            both
        });
        let square = |place: usize| measure.square(&both.map(|it| it.as_columns()[place]));
        let [half, last] = [square(0), square(1)];
        let ratio = last / (last + half).max(f64::MIN_POSITIVE);
        let smooth = 0.25 * A::SINE;
        last * ratio * ratio * (ratio + smooth * smooth)
    }
}

/// A method of this family.
macro_rules! parallel {
    ($name:ident, $tableau:ident: $nodes:literal by $groups:literal, $text:literal, order $order:literal, $dense:literal, sweeps $sweeps:expr, loosest $loosest:literal, growth $growth:expr, $sine:expr) => {
        impl Method for $name {
            const NAME: &'static str = $text;
            const ORDER: u32 = $order;
            const DENSE_ORDER: u32 = $dense;
        }

        impl Estimating for $name {
            const ESTIMATE_ORDER: u32 = $order + 1;
        }

        impl Swept<$nodes, $groups> for $name {
            #[allow(private_interfaces, reason = "no method is written outside")]
            const TABLEAU: Tableau<$nodes, $groups> = $tableau;
            const SWEEPS: [u32; 2] = $sweeps;
            const GROWTH: f64 = $growth;
            const SINE: f64 = $sine;
        }

        impl Family for $name {
            type Work<T: Real, const N: usize> = Stages<Self, T, N, $nodes, $groups>;

            const IMPLICIT: bool = false;

            const LOOSEST: f64 = $loosest;
        }
    };
}

parallel!(Pirk8, LOBATTO5: 5 by 1, "PIRK 8", order 8, 6, sweeps [4, 3], loosest 1e-2, growth f64::INFINITY, 1.0 / 16.0);
parallel!(Pirk16, LOBATTO9: 9 by 2, "PIRK 16", order 16, 10, sweeps [9, 5], loosest 1e-4, growth 2.0, 1.0 / 256.0);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::step::method::Span;
    use crate::step::trees::Scheme;
    use std::vec::Vec;

    const OVER_ONE: Span<f64> = Span {
        start: 0.0,
        end: 1.0,
        length: 1.0,
    };

    /// What a step from zero knows whose states have these slopes at the nodes.
    fn sampled<A, const N: usize, const S: usize, const G: usize>(
        span: Span<f64>,
        slope: impl Fn(usize, f64) -> f64,
    ) -> (Start<f64, N>, Slopes<f64, N, G>)
    where
        A: Swept<S, G>,
    {
        let nodes = A::TABLEAU.nodes;
        let at = |state: usize, node: usize| slope(state, span.start + span.length * nodes[node]);
        let first = SVector::from_fn(|state, _| at(state, 0));
        let others = array::from_fn(|group| {
            SVector::from_fn(|state, _| {
                <f64 as Real>::Stages::from_columns(|place| at(state, 4 * group + place + 1))
            })
        });
        let start = Start::of(span, SVector::zeros(), first);
        let slopes = Slopes {
            length: span.length,
            first,
            others,
        };
        (start, slopes)
    }

    /// Weights of all slopes in the state at a node.
    fn row<A: Swept<S, G>, const S: usize, const G: usize>(node: usize) -> [f64; S] {
        A::TABLEAU.weights.map(|weights| match node {
            0 => 0.0,
            _ => weights[(node - 1) / 4][(node - 1) % 4],
        })
    }

    #[test]
    fn conditions_of_order_hold() {
        let rows: Vec<Vec<f64>> = (0..5)
            .map(|node| row::<Pirk8, 5, 1>(node).to_vec())
            .collect();
        let scheme = Scheme {
            several: rows.clone(),
            single: rows.clone(),
        };
        scheme.assert_order("PIRK 8", &rows[4], 8, 1.0, 1e-15);
        let node_of = |s: f64| LOBATTO5.nodes.iter().position(|node| *node == s);
        let (start, slopes) =
            sampled::<Pirk8, 5, 5, 1>(OVER_ONE, |state, s| f64::from(node_of(s) == Some(state)));
        let end = SVector::from_row_slice(&rows[4]);
        for s in [0.1, 0.35, 0.8] {
            let weights = Stages::<Pirk8, f64, 5, 5, 1>::between(&slopes, &start, &end).at(s);
            scheme.assert_order("PIRK 8", weights.as_slice(), 5, s, 1e-14);
        }
    }

    /// What collocation is, and the order of the quadrature at its end, which together give the order: Hairer and Wanner II,
    /// IV.5.
    fn assert_integrates<A: Method + Swept<S, G>, const S: usize, const G: usize>() {
        let nodes = A::TABLEAU.nodes;
        for node in 1..S {
            let degrees = if node == S - 1 { A::ORDER } else { S as u32 };
            for power in 1..=degrees as i32 {
                let pairs = row::<A, S, G>(node).into_iter().zip(nodes);
                let sum: f64 = pairs
                    .map(|(weight, node)| weight * node.powi(power - 1))
                    .sum();
                let exact = nodes[node].powi(power) / f64::from(power);
                assert!((sum - exact).abs() < 1e-15, "{} {node} {power}", A::NAME);
            }
        }
        let pairs = row::<A, S, G>(S - 1).into_iter().zip(nodes);
        let next = A::ORDER as i32;
        let sum: f64 = pairs.map(|(weight, node)| weight * node.powi(next)).sum();
        assert!(
            (sum - 1.0 / f64::from(next + 1)).abs() > 1e-12,
            "{}",
            A::NAME
        );
    }

    #[test]
    fn powers_are_integrated_up_to_the_order() {
        assert_integrates::<Pirk8, 5, 1>();
        assert_integrates::<Pirk16, 9, 2>();
    }

    /// A power of the time is predicted from the step before and interpolated within it, whatever the lengths are.
    fn assert_exact<A: Swept<S, G>, const S: usize, const G: usize>() {
        let (before, length) = (0.8, 1.3);
        let span = |start: f64, length: f64| Span {
            start,
            end: start + length,
            length,
        };
        for power in 0..S as i32 {
            let slope = |_: usize, t: f64| t.powi(power);
            let state = |t: f64| t.powi(power + 1) / f64::from(power + 1);
            let (earlier, slopes) = sampled::<A, 1, S, G>(span(0.0, before), slope);
            let (_, expected) = sampled::<A, 1, S, G>(span(before, length), slope);
            let mut predicted = Slopes {
                others: slopes.others,
                ..expected
            };
            Stages::<A, f64, 1, S, G>::predict(&slopes, 1.0, &mut predicted);
            for (predicted, expected) in predicted.others.iter().zip(&expected.others) {
                let pairs = predicted[0]
                    .as_columns()
                    .iter()
                    .zip(expected[0].as_columns());
                for (predicted, expected) in pairs {
                    let (predicted, expected): (f64, f64) = (*predicted, *expected);
                    let error = (predicted - expected).abs() / (1.0 + expected.abs());
                    assert!(error < 1e-9, "{power}: {predicted} {expected}");
                }
            }
            let end = SVector::from([state(before)]);
            let between = Stages::<A, f64, 1, S, G>::between(&slopes, &earlier, &end);
            for s in [0.1, 0.35, 0.8] {
                let error = (between.at(s)[0] - state(s * before)).abs();
                assert!(error < 1e-14, "{power} {s}: {error:e}");
            }
        }
    }

    #[test]
    fn polynomials_are_continued_and_interpolated_whatever_the_lengths_are() {
        assert_exact::<Pirk8, 5, 1>();
        assert_exact::<Pirk16, 9, 2>();
    }

    /// What the truncation makes of the slopes over a step of length 1.
    fn missed<A: Swept<S, G>, const S: usize, const G: usize>(slope: impl Fn(f64) -> f64) -> f64 {
        let measure = Tolerance::<1>::new(0.0, 1.0, &[]).around(&SVector::from([0.0]));
        let (start, slopes) = sampled::<A, 1, S, G>(OVER_ONE, |_, t| slope(t));
        Real::sqrt(Stages::<A, f64, 1, S, G>::truncation(
            &measure,
            &start,
            &slopes.others,
        ))
    }

    /// What is estimated, over what the method misses, of slopes with this integral over the step.
    fn estimated<A: Swept<S, G>, const S: usize, const G: usize>(
        slope: impl Fn(f64) -> f64,
        integral: f64,
    ) -> f64 {
        let ends = row::<A, S, G>(S - 1).into_iter().zip(A::TABLEAU.nodes);
        let found: f64 = ends.map(|(weight, node)| weight * slope(node)).sum();
        missed::<A, S, G>(slope) / (found - integral).abs()
    }

    /// Legendre's polynomials over the step: those of half the last degree and of the last are told apart from all others.
    #[test]
    fn the_truncation_sees_smooth_slopes_less_than_jumps() {
        assert!(missed::<Pirk8, 5, 1>(|t| 1.0 + t * (3.0 - t * (2.0 - t))) < 1e-30);
        assert!(missed::<Pirk16, 9, 2>(|t| 1.0 + t.powi(7)) < 1e-30);
        let fourth = |t: f64| 1.0 + t * (-20.0 + t * (90.0 + t * (-140.0 + t * 70.0)));
        assert!((missed::<Pirk8, 5, 1>(fourth) - 1.0).abs() < 1e-3);
        assert!(missed::<Pirk16, 9, 2>(fourth) < 1e-30);
        let of_sine = |angle: f64| {
            let slope = move |t: f64| Real::sin(angle * t + 0.4);
            (slope, (0.4_f64.cos() - (angle + 0.4).cos()) / angle)
        };
        for angle in [1.0, 2.0, 4.0, 8.0] {
            let (slope, integral) = of_sine(angle);
            let ratio = estimated::<Pirk8, 5, 1>(slope, integral);
            assert!(ratio > 0.5 && ratio < 50.0, "{angle} {ratio}");
        }
        // Of slower ones no more is missed than is rounded. Ten thousand times too much makes a step less than twice too short.
        for angle in [8.0, 12.0, 16.0] {
            let (slope, integral) = of_sine(angle);
            let ratio = estimated::<Pirk16, 9, 2>(slope, integral);
            assert!(ratio > 0.5 && ratio < 1e4, "{angle} {ratio}");
        }
        for jump in [0.1, 0.3, 0.6, 0.9] {
            let slope = |t: f64| f64::from(t > jump);
            let ratios = [
                estimated::<Pirk8, 5, 1>(slope, 1.0 - jump),
                estimated::<Pirk16, 9, 2>(slope, 1.0 - jump),
            ];
            assert!(
                ratios.into_iter().all(|ratio| ratio > 0.1),
                "{jump} {ratios:?}"
            );
        }
    }
}
