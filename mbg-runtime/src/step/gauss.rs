//! Gauss's methods of collocation, solved by sweeps over the stages.

use core::array;
use core::marker::PhantomData;

use nalgebra::{SMatrix, SVector};

use super::dense::Polynomial;
use super::elimination::Shifted;
use super::method::{
    Family, Method, Start, Stepper, Trial, along, combination, lagrange, larger, leading, relative,
    settles,
};
use super::problem::Problem;
use super::rounding::Floor;
use super::seen;
use super::tolerance::{NOISE, Sizes, Tolerance};
use crate::{Input, Real, System};

/// Gauss's method with three stages.
///
/// | order | in between | estimate | a step costs | stability |
/// |---|---|---|---|---|
/// | 6 | 3, error of power 4 | none | three evaluations a sweep: about ten sweeps to rounding | A, symplectic, symmetric |
///
/// For conservative problems over long times: with [`Fixed::compensated`](super::Fixed::compensated) and sweeps to
/// rounding, quadratic invariants stay where they were. A fixed number of sweeps makes the cost per step known in
/// advance; three keep the order. The first step, and the first behind a jump, takes two more, since it has no step
/// before it to start from. Sweeps do not converge where `h |∂f/∂x|` exceeds about 2: no method for stiff problems.
///
/// Source: J. C. Butcher, *Mathematics of Computation* 18 (1964), 50–64; Hairer, Lubich and Wanner, *Geometric
/// Numerical Integration*, 2nd ed. (2006), II.1.3 and VIII.6.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Gauss6 {
    /// Number of sweeps; to rounding when there is none.
    pub sweeps: Option<u32>,
}

/// The implicit midpoint rule, solved by Newton's method with the Jacobian at the start of the step.
///
/// | order | in between | estimate | a step costs | stability |
/// |---|---|---|---|---|
/// | 2 | 2 | none | a Jacobian, a factorisation, one evaluation and one solve a sweep | A, symplectic, symmetric |
///
/// For stiff mechanics at a fixed step on a microcontroller, where energy must neither grow nor vanish. The number of
/// sweeps is fixed: 2 or 3 suffice, where the Jacobian changes little over a step. Where it changes so much that the last
/// sweep comes no nearer, the stage is not found; of a single sweep nothing is known.
///
/// Source: Hairer and Wanner, *Solving Ordinary Differential Equations II*, 2nd ed. (1996), IV.5 and IV.8.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImplicitMidpoint {
    /// Number of Newton's sweeps.
    pub sweeps: u32,
}

impl Default for ImplicitMidpoint {
    /// Three sweeps.
    fn default() -> Self {
        Self { sweeps: 3 }
    }
}

/// Coefficients of a method with `S` stages.
struct Tableau<const S: usize> {
    nodes: [f64; S],
    matrix: [[f64; S]; S],
    weights: [f64; S],
    /// Weights of `d₁, d₂` in `x + s (Δ + (1 − s) (d₁ + s d₂))`.
    dense: [[f64; S]; 2],
}

const MIDPOINT: Tableau<1> = Tableau {
    nodes: [0.5],
    matrix: [[0.5]],
    weights: [1.0],
    dense: [[0.0]; 2],
};

/// √15.
const Q: f64 = 3.872_983_346_207_417;

const GAUSS6: Tableau<3> = Tableau {
    nodes: [0.5 - Q / 10.0, 0.5, 0.5 + Q / 10.0],
    matrix: [
        [5.0 / 36.0, 2.0 / 9.0 - Q / 15.0, 5.0 / 36.0 - Q / 30.0],
        [5.0 / 36.0 + Q / 24.0, 2.0 / 9.0, 5.0 / 36.0 - Q / 24.0],
        [5.0 / 36.0 + Q / 30.0, 2.0 / 9.0 + Q / 15.0, 5.0 / 36.0],
    ],
    weights: [5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0],
    dense: [
        [
            (0.5 + Q / 10.0) / 0.6 - 5.0 / 18.0,
            -2.0 / 3.0 - 4.0 / 9.0,
            (0.5 - Q / 10.0) / 0.6 - 5.0 / 18.0,
        ],
        [-1.0 / 0.9, 1.0 / 0.45, -1.0 / 0.9],
    ],
};

/// How the stages are found.
#[derive(Clone, Copy)]
enum Solve {
    /// By sweeps `k ← f(x + h A k)`, so many or to rounding.
    Sweeps(Option<u32>),
    /// By so many sweeps of Newton's method, one stage after the other.
    Newton(u32),
}

/// Most sweeps to rounding.
const MOST: u32 = 50;
/// After so many of them it is looked for states that are rounding alone.
const MANY: u32 = 16;
/// Sweeps that bring back what is moved.
const ONWARD: u32 = 4;
/// In units of what states have been and become: Newton's sweeps have found a stage when the last one changes it by less.
const NEAR: f64 = 1e-3;
/// In the same units: or when it leaves less to be changed.
const LEFT: f64 = 1e-2;
/// What a sweep leaves of the equations is less than this part of what it found where the slopes on the way are those at the start.
const SHRINKS: f64 = 0.9;

/// A method of this family.
pub trait Collocation<const S: usize>: Copy {
    #[doc(hidden)]
    #[allow(private_interfaces, reason = "no method is written outside")]
    const TABLEAU: Tableau<S>;

    /// How its stages are found.
    #[doc(hidden)]
    #[allow(private_interfaces, reason = "no method is written outside")]
    fn solve(&self) -> Solve;
}

/// What Newton's sweeps keep from step to step, so that zeros outside of the pattern are written once.
struct Newton<T, const N: usize> {
    jacobian: SMatrix<T, N, N>,
    factors: Shifted<T, N>,
}

/// The stages of the last step, and `K` matrices for Newton's sweeps, one or none.
pub struct Stages<A, T, const N: usize, const S: usize, const K: usize> {
    solve: Solve,
    newton: [Newton<T, N>; K],
    slopes: [SVector<T, N>; S],
    /// Length of the last step; none at the start and behind a jump.
    length: Option<T>,
    sizes: Sizes<N>,
    method: PhantomData<A>,
}

#[allow(private_interfaces, reason = "no method is written outside")]
impl<A, T, const N: usize, const S: usize, const K: usize> Stepper<A, T, N>
    for Stages<A, T, N, S, K>
where
    A: Collocation<S>,
    T: Real,
{
    fn new(method: &A) -> Self {
        let zero = T::from_f64(0.0);
        let newton = |_| Newton {
            jacobian: SMatrix::from_element(zero),
            factors: Shifted::empty(),
        };
        Self {
            solve: method.solve(),
            newton: array::from_fn(newton),
            slopes: [SVector::from_element(zero); S],
            length: None,
            sizes: Sizes::new(),
            method: PhantomData,
        }
    }

    fn attempt<Y, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, Y, I, N, M, P>,
        start: &Start<T, N>,
        _tolerance: Option<&Tolerance<N>>,
    ) -> Trial<T, N>
    where
        Y: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let first = self.length.is_none();
        let mut memories = [None; S];
        self.predict(start);
        let found = match self.solve {
            Solve::Newton(sweeps) => self.by_newton(problem, (start, &mut memories), sweeps),
            Solve::Sweeps(Some(sweeps)) => {
                for _ in 0..if first { sweeps + 2 } else { sweeps } {
                    let at = (start, &mut memories);
                    Self::sweep(&mut self.slopes, problem, at, None);
                }
                true
            }
            Solve::Sweeps(None) => self.by_sweeps(problem, (start, &mut memories)),
        };
        let length = start.span.length;
        self.length = Some(length);
        let weights = const { &A::TABLEAU.weights };
        Trial {
            change: combination(weights, &self.slopes).map(|sum| length * sum),
            slope: None,
            error: if found { 0.0 } else { f64::INFINITY },
            coarse: 0.0,
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
        between(&A::TABLEAU, &self.slopes, start, end)
    }

    fn place_of_jacobian(&self, start: &Start<T, N>) -> Option<(T, SVector<T, N>)> {
        match self.solve {
            Solve::Newton(_) => Some((start.span.start, start.x)),
            Solve::Sweeps(_) => None,
        }
    }
}

/// The polynomial over a step.
fn between<T: Real, const N: usize, const S: usize>(
    tableau: &Tableau<S>,
    slopes: &[SVector<T, N>; S],
    start: &Start<T, N>,
    end: &SVector<T, N>,
) -> Polynomial<T, N> {
    let mut polynomial = Polynomial::line(&start.x, end);
    let higher = polynomial.coefficients.iter_mut().skip(1);
    for (coefficient, weights) in higher.zip(&tableau.dense) {
        let sum = combination(weights, slopes);
        *coefficient = sum.map(|sum| start.span.length * sum);
    }
    polynomial
}

impl<A, T, const N: usize, const S: usize, const K: usize> Stages<A, T, N, S, K>
where
    A: Collocation<S>,
    T: Real,
{
    /// The stages as the last step continues; without one, the derivative at the start.
    fn predict(&mut self, start: &Start<T, N>) {
        let Some(before) = self.length.filter(|_| !start.again) else {
            self.slopes = [start.slope; S];
            return;
        };
        let ratio = seen(start.span.length / before);
        let known = self.slopes;
        for (node, slope) in A::TABLEAU.nodes.iter().zip(&mut self.slopes) {
            let distances = A::TABLEAU.nodes.map(|other| 1.0 + node * ratio - other);
            let weights = lagrange(const { &leading(&A::TABLEAU.nodes) }, &distances);
            *slope = combination(&weights, &known);
        }
    }

    /// Sweeps of Newton's method with the Jacobian at the start; whether they have found the stages.
    fn by_newton<Y, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, Y, I, N, M, P>,
        (start, memories): (&Start<T, N>, &mut [Option<Y::Memory>; S]),
        sweeps: u32,
    ) -> bool
    where
        Y: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        let Some(Newton { jacobian, factors }) = self.newton.first_mut() else {
            return false;
        };
        let scale = start.span.length * T::from_f64(A::TABLEAU.matrix[0][0]);
        let place = (start.span.start, &start.x);
        problem.factorise((place, Some(start.span.length)), scale, (jacobian, factors));
        self.sizes.note(&start.x);
        let along = |slope: SVector<T, N>| slope.map(|slope| start.span.length * slope);
        let (mut before, mut last) = (f64::INFINITY, f64::INFINITY);
        let (mut found, mut left) = (f64::INFINITY, f64::INFINITY);
        for _ in 0..sweeps {
            (before, found) = (last, left);
            let known = self.slopes[0];
            let mut residual = known;
            let newton = Some((&*factors, &mut residual));
            Self::sweep(&mut self.slopes, problem, (start, memories), newton);
            let [change, ahead] = [self.slopes[0] - known, self.slopes[0]].map(along);
            let measure = self.sizes.between(&start.x, &ahead);
            (last, left) = (measure.norm(&change), measure.norm(&along(residual)));
        }
        // Slopes that are far steeper at the start than on the way make sweeps short which leave as much as they found.
        if left > LEFT && left > SHRINKS * found && last > NOISE * T::EPSILON {
            return false;
        }
        let rate = last / before;
        last <= NEAR || rate < 1.0 && last * rate / (1.0 - rate) <= LEFT
    }

    /// Sweeps to rounding; whether they have come to that.
    ///
    /// The last bits of sweeps that stop early add up over long times.
    fn by_sweeps<Y, I, const M: usize, const P: usize>(
        &mut self,
        problem: &mut Problem<'_, T, Y, I, N, M, P>,
        (start, memories): (&Start<T, N>, &mut [Option<Y::Memory>; S]),
    ) -> bool
    where
        Y: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        self.sizes.note(&start.x);
        let Self { slopes, sizes, .. } = self;
        let along = |slope: &SVector<T, N>| slope.map(|slope| start.span.length * slope);
        let (mut sweeps, mut floor) = (0, Floor::new());
        settles::<T>(
            MOST,
            |_before, _last| false,
            || {
                let known = *slopes;
                Self::sweep(slopes, problem, (start, memories), None);
                let ways = slopes.each_ref().map(along);
                let changes: [SVector<T, N>; S] =
                    array::from_fn(|it| along(&(slopes[it] - known[it])));
                sweeps += 1;
                if sweeps >= MANY {
                    floor.look(&changes, (&start.x, &ways, sizes), |way| {
                        let kept = (*memories, problem.memory);
                        let steeper = way.map(|way| way / start.span.length);
                        let mut slopes = slopes.each_ref().map(|slope| slope + steeper);
                        for _ in 0..ONWARD {
                            Self::sweep(&mut slopes, problem, (start, memories), None);
                        }
                        (*memories, problem.memory) = kept;
                        slopes.each_ref().map(along)
                    });
                }
                let changes = floor.beyond(changes);
                let sizes = changes.iter().zip(&ways);
                let sizes = sizes.map(|(change, way)| relative(change, &start.x, way));
                sizes.fold(0.0, larger)
            },
        )
    }

    /// One sweep over all stages. One of Newton's method leaves what the equations of the last stage had left before.
    fn sweep<Y, I, const M: usize, const P: usize>(
        slopes: &mut [SVector<T, N>; S],
        problem: &mut Problem<'_, T, Y, I, N, M, P>,
        (start, memories): (&Start<T, N>, &mut [Option<Y::Memory>; S]),
        mut newton: Option<(&Shifted<T, N>, &mut SVector<T, N>)>,
    ) where
        Y: System<T, N, M, P>,
        I: Input<T, M> + ?Sized,
    {
        // All before the first slope: beside a derivative that is inlined a compiler would not write the weights out.
        let stages: [SVector<T, N>; S] = array::from_fn(|stage| {
            let direction = combination(&A::TABLEAU.matrix[stage], slopes);
            along(&start.x, start.span.length, &direction)
        });
        for stage in 0..S {
            let t = start.span.at(T::from_f64(A::TABLEAU.nodes[stage]));
            let slope = problem.slope_of_stage(t, &stages[stage], &mut memories[stage]);
            if let Some((factors, residual)) = &mut newton {
                **residual = slope - slopes[stage];
                slopes[stage] += factors.solved::<Y, M, P>(residual);
            } else {
                slopes[stage] = slope;
            }
        }
    }
}

/// A method of this family.
macro_rules! gauss {
    ($name:ident, $tableau:ident: $stages:literal, $matrices:literal, $text:literal, order $order:literal, $dense:literal, |$method:ident| $solve:expr) => {
        impl Method for $name {
            const NAME: &'static str = $text;
            const ORDER: u32 = $order;
            const DENSE_ORDER: u32 = $dense;
        }

        impl Collocation<$stages> for $name {
            #[allow(private_interfaces, reason = "no method is written outside")]
            const TABLEAU: Tableau<$stages> = $tableau;

            #[allow(private_interfaces, reason = "no method is written outside")]
            fn solve(&self) -> Solve {
                let $method = self;
                $solve
            }
        }

        impl Family for $name {
            type Work<T: Real, const N: usize> = Stages<Self, T, N, $stages, $matrices>;
        }
    };
}

gauss!(Gauss6, GAUSS6: 3, 0, "Gauss 6", order 6, 4, |method| Solve::Sweeps(method.sweeps));
gauss!(ImplicitMidpoint, MIDPOINT: 1, 1, "implicit midpoint", order 2, 2, |method| Solve::Newton(method.sweeps));

#[cfg(test)]
mod tests {
    use super::*;
    use crate::step::trees::Scheme;

    fn assert_order<const S: usize>(name: &str, tableau: &Tableau<S>, order: usize) {
        let rows = tableau.matrix.map(|row| row.to_vec()).to_vec();
        let scheme = Scheme {
            several: rows.clone(),
            single: rows,
        };
        scheme.assert_order(name, &tableau.weights, order, 1.0, 1e-15);
        // Quadratic invariants stay: bᵢ aᵢⱼ + bⱼ aⱼᵢ = bᵢ bⱼ.
        for i in 0..S {
            for j in 0..S {
                let (b, a) = (tableau.weights, tableau.matrix);
                let sum = b[i] * a[i][j] + b[j] * a[j][i] - b[i] * b[j];
                assert!(sum.abs() < 1e-16, "{name} {i} {j} {sum:e}");
            }
        }
        let slopes = core::array::from_fn(|stage| {
            SVector::<f64, S>::from_fn(|row, _| f64::from(row == stage))
        });
        let span = crate::step::method::Span {
            start: 0.0,
            end: 1.0,
            length: 1.0,
        };
        let zero = SVector::zeros();
        let start = Start::of(span, zero, zero);
        let between = between(tableau, &slopes, &start, &SVector::from(tableau.weights));
        for s in [0.1, 0.35, 0.8] {
            let weights = between.at(s);
            scheme.assert_order(name, weights.as_slice(), S, s, 1e-14);
        }
    }

    #[test]
    fn conditions_of_order_hold() {
        assert_order("implicit midpoint", &MIDPOINT, 2);
        assert_order("Gauss 6", &GAUSS6, 6);
    }
}
