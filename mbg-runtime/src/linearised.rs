//! A model next to a state.

use nalgebra::{Complex, SMatrix, SVector};

use crate::step::{Complex as Number, Element, Factors};
use crate::{Convertible, Real, Trouble};

/// A model linearised at a state: `δẋ = A δx + B δu`, `δy = C δx + D δu`.
///
/// [`Linearised::of`] gives it. Its poles are [`Linearised::poles`]; `complex_eigenvalues()` of `nalgebra` does not end on chains
/// of integrators, such as those of a body in free flight.
///
/// Not every pole is a motion of the model. The four numbers of an attitude count as states, and so do all coordinates of loops
/// that multipliers close. Two displacements at one junction, such as that of a spring beside a field of two ports, make a pole at
/// zero, since their difference stays what it was, whatever is done. No feedback moves such a pole, and an iteration of Riccati's
/// equation over all states does not end. The rows of both are the same in `A` and in `B`: leave one state out, and add its columns
/// of `A` and `C` to those of the other.
///
/// Filters and controllers that represent rotations by three small angles in axes of the body multiply: with the columns
/// `½ [-x, w, z, -y]`, `½ [-y, -z, w, x]` and `½ [-z, y, -x, w]` of a quaternion `[w, x, y, z]` as `E`, angles become a change `E δ`
/// of the quaternion, `4 Eᵀ` takes such a change to angles, and `4 Eᵀ Φ E` has the first `E` after the sample and the second
/// before it. Behind a correction [`System::close`](crate::System::close) makes the quaternion one of length one.
///
/// `A` belongs to one state and time. The states of a spinning rotor do not rest if its body is described in axes that turn with
/// it, or if its shaft is not round: there `A` is periodic in the angle, and its eigenvalues at one angle are no poles. Where the
/// rotor is round, write it in axes that do not turn; else take Floquet's multipliers over a turn, by
/// [`PeriodicTrim`](crate::PeriodicTrim) or as the product of [`Linearised::held`] or [`Rk4::transition`](crate::Rk4::transition)
/// over short parts of it.
///
/// A nonlinear algebraic loop is solved from zero, as at the start of a run: of several solutions it may find another one than
/// a run has found.
///
/// Jumps of laws are not seen: at rest the matrices are those without dry friction by `sign(f)`, though it would hold.
///
/// [`Linearised::of`] takes several matrices of all states on the stack: see [`Auto`](crate::Auto#stack).
///
/// # Example
///
/// ```
/// use mbg_runtime::{Linearised, System, mbg};
/// use nalgebra::{ComplexField, SVector};
///
/// mbg! {
///     /// A pendulum pushed by a torque.
///     model Pendulum {
///         input torque: N*m;
///         1 joint {
///             I rod { inertia: 0.5 }
///             C weight { effort: 20.0 * sin(q) }
///             R bearing { resistance: 0.2 }
///             Se push { effort: torque }
///         }
///         output angle: rad = weight.q;
///     }
/// }
///
/// let pendulum = Pendulum::<f64>::new(PendulumParameters::default())?;
/// let rest = pendulum.initial_state();
/// let linear = Linearised::of(&pendulum, 0.0, &rest, &SVector::zeros()).unwrap();
/// // 1 / (20 − 0.5 ω² + 0.2 jω) at its natural frequency.
/// let response = linear.response(f64::sqrt(40.0)).unwrap()[(0, 0)];
/// assert!((response.modulus() - 1.0 / (0.2 * f64::sqrt(40.0))).abs() < 1e-12);
/// assert!((response.argument() + std::f64::consts::FRAC_PI_2).abs() < 1e-12);
/// # Ok::<(), mbg_runtime::ParameterError>(())
/// ```
///
/// States and inputs to linearise at, such as those of a hover or of a steady turn, are found by [`Trim`](crate::Trim). A state
/// from elsewhere must be on closed loops, with quaternions of length one: [`System::close`](crate::System::close) leaves it as
/// it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linearised<T, const N: usize, const M: usize, const P: usize> {
    /// The state matrix `A = ∂f/∂x`.
    pub state: SMatrix<T, N, N>,
    /// The input matrix `B = ∂f/∂u`.
    pub input: SMatrix<T, N, M>,
    /// The output matrix `C = ∂y/∂x`.
    pub output: SMatrix<T, P, N>,
    /// The feedthrough matrix `D = ∂y/∂u`.
    pub feedthrough: SMatrix<T, P, M>,
}

impl<T: Real, const N: usize, const M: usize, const P: usize> Linearised<T, N, M, P> {
    /// Next to a state, exact but for rounding: the model's own Jacobians, and its outputs on [`Dual`](crate::Dual) numbers.
    ///
    /// # Errors
    ///
    /// What [`System::trouble`](crate::System::trouble) says of this state, and an entry that is infinite or NaN, where a law has no
    /// finite slope.
    pub fn of<S>(system: &S, t: T, x: &SVector<T, N>, u: &SVector<T, M>) -> Result<Self, Trouble>
    where
        S: Convertible<T, N, M, P>,
    {
        let linear = Self::unchecked(system, t, x, u)?;
        let (states, inputs, outputs) = (S::META.states, S::META.inputs, S::META.outputs);
        let trouble = Trouble::of_jacobian(&linear.state, [states, states])
            .or_else(|| Trouble::of_jacobian(&linear.input, [states, inputs]))
            .or_else(|| Trouble::of_jacobian(&linear.output, [outputs, states]))
            .or_else(|| Trouble::of_jacobian(&linear.feedthrough, [outputs, inputs]));
        trouble.map_or(Ok(linear), Err)
    }

    /// The same, whose entries may be infinite or NaN.
    pub(crate) fn unchecked<S>(
        system: &S,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
    ) -> Result<Self, Trouble>
    where
        S: Convertible<T, N, M, P>,
    {
        let mut memory = S::Memory::default();
        let state = system.jacobian_state(t, x, u, &mut memory);
        if let Some(trouble) = system.trouble(t, x, u, &memory) {
            return Err(trouble);
        }
        Ok(Self {
            state,
            input: system.jacobian_input(t, x, u, &mut memory),
            output: system.output_jacobian_state(t, x, u),
            feedthrough: system.output_jacobian_input(t, x, u),
        })
    }

    /// The frequency response `C (jω I − A)⁻¹ B + D`: amplitudes and phases of outputs to inputs that swing with `frequency`
    /// in rad/s. None where it is not finite: a pole lies there. At zero that is so, too, where displacements depend on each
    /// other, as those of two springs at one junction: there a low frequency tells the response at rest.
    /// Lanes share their pivots: it may be less exact in one than alone, and there is none where no pivot serves all lanes.
    #[must_use]
    pub fn response(&self, frequency: T) -> Option<SMatrix<Complex<T>, P, M>> {
        let zero = T::from_f64(0.0);
        let mut factors = Factors::<Number<T>, N>::empty();
        factors.factorise(|row, column| Number {
            real: -*self.state.get((row, column)).unwrap_or(&zero),
            imaginary: if row == column { frequency } else { zero },
        });
        let mut response = self.feedthrough.map(|part| Complex::new(part, zero));
        for (mut response, input) in response.column_iter_mut().zip(self.input.column_iter()) {
            let mut right = [Number::zero(); N];
            for (right, part) in right.iter_mut().zip(input.iter()) {
                right.real = *part;
            }
            let swings = factors.solve(right);
            for (swing, weights) in swings.iter().zip(self.output.column_iter()) {
                for (sum, weight) in response.iter_mut().zip(weights.iter()) {
                    sum.re += *weight * swing.real;
                    sum.im += *weight * swing.imaginary;
                }
            }
        }
        let is_finite = |it: &Complex<T>| (it.re.magnitude() + it.im.magnitude()).is_finite();
        response.iter().all(is_finite).then_some(response)
    }

    /// The model from sample to sample, where inputs are held for a `period` in s (zero-order hold): `Φ = exp(A h)` and
    /// `Γ = ∫ exp(A τ) dτ B` of `x(t + h) = Φ x(t) + Γ u`, as discrete controllers and filters are designed with. None where they
    /// are not finite.
    ///
    /// Where the state does not rest the model is another one at the end of the period, and the error of `Φ` falls with the square of
    /// that. The exact derivatives of a step, as iterations over a trajectory need them, are those of
    /// [`Rk4::transition`](crate::Rk4::transition).
    ///
    /// Both are summed for a part of the period that is short enough, whose double is taken as often as needed (scaling and
    /// squaring; Moler and Van Loan, *SIAM Review* 45 (2003), 3–49, method 3), of `Φ − I`, so that slow motions beside fast
    /// ones keep their digits.
    ///
    /// # Example
    ///
    /// ```
    /// use mbg_runtime::Linearised;
    /// use nalgebra::{SMatrix, Matrix2};
    ///
    /// // A mass of 1 kg that a force pushes: x = (way, velocity).
    /// let mass = Linearised {
    ///     state: Matrix2::new(0.0, 1.0, 0.0, 0.0),
    ///     input: SMatrix::<f64, 2, 1>::new(0.0, 1.0),
    ///     output: SMatrix::<f64, 1, 2>::new(1.0, 0.0),
    ///     feedthrough: SMatrix::<f64, 1, 1>::new(0.0),
    /// };
    /// let (transition, push) = mass.held(0.5).unwrap();
    /// assert_eq!(transition, Matrix2::new(1.0, 0.5, 0.0, 1.0));
    /// assert_eq!(push, SMatrix::<f64, 2, 1>::new(0.125, 0.5));
    /// ```
    #[must_use]
    pub fn held(&self, period: T) -> Option<(SMatrix<T, N, N>, SMatrix<T, N, M>)> {
        let (doublings, part) = self.parts(period)?;
        let (mut change, mean) = self.short(part);
        let mut push = product(&mean, &self.input).map(|it| part * it);
        for _ in 0..doublings {
            push = push + push + product(&change, &push);
            change = change + change + product(&change, &change);
        }
        let transition = beside_one(change);
        let is_finite = |it: &T| it.magnitude().is_finite();
        let are_finite = transition.iter().all(is_finite) && push.iter().all(is_finite);
        are_finite.then_some((transition, push))
    }

    /// What white noise of the inputs adds to the covariance of the state over a `period` in s:
    /// `∫ exp(A τ) B S Bᵀ exp(Aᵀ τ) dτ` with its two-sided spectral density `S`, as Kalman's filter is designed with beside `Φ` of
    /// [`held`](Self::held). None where it is not finite.
    ///
    /// `S` has the square of an input's unit per Hz, such as the square of a gyroscope's angle random walk in rad/s/√Hz. The same
    /// noise in a run is a [`Sampled::held`](crate::Sampled::held) input, of which values that are held for a time `h` have the
    /// variance `S / h`.
    ///
    /// It is summed for a part of the period and doubled as often as needed, as by [`held`](Self::held).
    ///
    /// # Example
    ///
    /// ```
    /// use mbg_runtime::Linearised;
    /// use nalgebra::{Matrix1, Matrix2, SMatrix};
    ///
    /// // A mass of 1 kg that noise pushes: x = (way, velocity).
    /// let mass = Linearised {
    ///     state: Matrix2::new(0.0, 1.0, 0.0, 0.0),
    ///     input: SMatrix::<f64, 2, 1>::new(0.0, 1.0),
    ///     output: SMatrix::<f64, 1, 2>::new(1.0, 0.0),
    ///     feedthrough: SMatrix::<f64, 1, 1>::new(0.0),
    /// };
    /// let (s, h) = (0.2, 0.5);
    /// let added = mass.noise(&Matrix1::new(s), h).unwrap();
    /// let expected = s * Matrix2::new(h * h * h / 3.0, h * h / 2.0, h * h / 2.0, h);
    /// assert!((added - expected).norm() < 1e-16);
    /// ```
    #[must_use]
    pub fn noise(&self, density: &SMatrix<T, M, M>, period: T) -> Option<SMatrix<T, N, N>> {
        let (doublings, part) = self.parts(period)?;
        let source = product(&product(&self.input, density), &self.input.transpose());
        // Σ hᵏ⁺¹ / (k + 1)! of what is applied k times, X → A X + X Aᵀ, the last terms first.
        let step = self.state.map(|it| part * it);
        let mut sum = source;
        for order in (2..=2 * TERMS).rev() {
            let shrink = T::from_f64(1.0 / f64::from(order));
            let applied = product(&step, &sum) + product(&sum, &step.transpose());
            sum = source + applied.map(|it| shrink * it);
        }
        let mut covariance = sum.map(|it| part * it);
        let (mut change, _) = self.short(part);
        for _ in 0..doublings {
            // Half of Q + Φ Q Φᵀ, and the other, or rounding would add up to what is not symmetric.
            let first = product(&change, &covariance);
            let both = product(&first, &change.transpose()).map(|it| T::from_f64(0.5) * it);
            let half = covariance + first + both;
            covariance = half + half.transpose();
            change = change + change + product(&change, &change);
        }
        let is_finite = |it: &T| it.magnitude().is_finite();
        covariance.iter().all(is_finite).then_some(covariance)
    }

    /// `exp(A h) − I` and `Σ (A h)ᵏ / (k + 1)!` over a short period, the last terms first.
    fn short(&self, part: T) -> (SMatrix<T, N, N>, SMatrix<T, N, N>) {
        let step = self.state.map(|it| part * it);
        let mut mean = SMatrix::<T, N, N>::from_element(T::from_f64(0.0));
        for order in (2..=TERMS).rev() {
            let shrink = T::from_f64(1.0 / f64::from(order));
            mean = product(&step, &beside_one(mean)).map(|it| shrink * it);
        }
        let mean = beside_one(mean);
        (product(&step, &mean), mean)
    }

    /// How often a part of a period is doubled, and that part: over it, the exponential is a short sum.
    fn parts(&self, period: T) -> Option<(u32, T)> {
        let columns = self.state.column_iter();
        let sums = columns.map(|column| column.iter().map(|it| it.magnitude()).sum::<f64>());
        let norm = sums.fold(0.0, f64::max) * period.magnitude();
        if !norm.is_finite() {
            return None;
        }
        let (mut doublings, mut part) = (0, 1.0);
        while norm * part > 0.5 {
            (doublings, part) = (doublings + 1, 0.5 * part);
        }
        Some((doublings, T::from_f64(part) * period))
    }
}

/// Terms of the exponential of a matrix whose norm is 1/2 at most: what follows is below 1e-19 of it.
const TERMS: u32 = 16;

/// The matrix and the identity.
pub(crate) fn beside_one<T: Real, const N: usize>(
    mut matrix: SMatrix<T, N, N>,
) -> SMatrix<T, N, N> {
    let diagonal = matrix.iter_mut().step_by(N + 1);
    diagonal.for_each(|it| *it += T::from_f64(1.0));
    matrix
}

pub(crate) fn product<T: Real, const A: usize, const B: usize, const C: usize>(
    left: &SMatrix<T, A, B>,
    right: &SMatrix<T, B, C>,
) -> SMatrix<T, A, C> {
    // Column by column: what is next to each other in memory goes through registers side by side.
    let zero = T::from_f64(0.0);
    let mut product = SMatrix::<T, A, C>::from_element(zero);
    for (sums, weights) in product.data.0.iter_mut().zip(&right.data.0) {
        for (column, weight) in left.data.0.iter().zip(weights) {
            for (sum, part) in sums.iter_mut().zip(column) {
                *sum += *part * *weight;
            }
        }
    }
    product
}
