//! What holds for every model at any state: its energy changes by what is supplied less what is dissipated, and its
//! Jacobians are the derivatives of its rates. Both by dual numbers, exact to rounding.

use mbg_runtime::{Dual, System};
use nalgebra::SVector;

use crate::references::noise::noise;

/// States at which a divisor is smaller are not tried.
const REGULAR: f64 = 0.05;

/// A model on dual numbers, at a point and along directions of it.
pub(super) struct Probe<'a, S, const N: usize, const M: usize> {
    pub(super) model: &'a S,
    pub(super) time: f64,
    pub(super) state: SVector<f64, N>,
    pub(super) input: SVector<f64, M>,
}

type Lifted<const N: usize> = SVector<Dual<f64>, N>;

impl<S, const N: usize, const M: usize> Probe<'_, S, N, M> {
    fn lifted<const K: usize>(values: &SVector<f64, K>, slopes: &SVector<f64, K>) -> Lifted<K> {
        values.zip_map(slopes, |value, slope| Dual { value, slope })
    }

    fn time(&self, slope: f64) -> Dual<f64> {
        Dual {
            value: self.time,
            slope,
        }
    }

    pub(super) fn rates<const P: usize>(&self) -> SVector<f64, N>
    where
        S: System<Dual<f64>, N, M, P>,
    {
        self.rates_along(&SVector::zeros(), &SVector::zeros())
            .map(|rate| rate.value)
    }

    fn rates_along<const P: usize>(&self, x: &SVector<f64, N>, u: &SVector<f64, M>) -> Lifted<N>
    where
        S: System<Dual<f64>, N, M, P>,
    {
        let (state, input) = (Self::lifted(&self.state, x), Self::lifted(&self.input, u));
        self.model
            .derivative(self.time(0.0), &state, &input, &mut S::Memory::default())
    }

    /// Outputs with their derivatives in time, the input being constant.
    pub(super) fn outputs<const P: usize>(&self) -> Lifted<P>
    where
        S: System<Dual<f64>, N, M, P>,
    {
        let state = Self::lifted(&self.state, &self.rates());
        let input = Self::lifted(&self.input, &SVector::zeros());
        self.model
            .output(self.time(1.0), &state, &input, &mut S::Memory::default())
    }

    fn energy_along<const P: usize>(&self, time: f64, x: &SVector<f64, N>) -> f64
    where
        S: System<Dual<f64>, N, M, P>,
    {
        let state = Self::lifted(&self.state, x);
        self.model.energy(self.time(time), &state).slope
    }

    /// By how much energy is created, over the power that flows.
    fn imbalance<const P: usize>(&self) -> f64
    where
        S: System<Dual<f64>, N, M, P>,
    {
        let rates = self.rates();
        let state = Self::lifted(&self.state, &rates);
        let input = Self::lifted(&self.input, &SVector::zeros());
        let power = self
            .model
            .power(self.time(0.0), &state, &input, &mut S::Memory::default());
        let (supplied, dissipated) = (power.supplied.value, power.dissipated.value);
        let gross = (0..N)
            .map(|place| {
                let along = SVector::from_fn(|row, _| if row == place { rates[row] } else { 0.0 });
                self.energy_along(0.0, &along).abs()
            })
            .sum::<f64>();
        let gross = gross.max(supplied.abs()).max(dissipated.abs());
        (self.energy_along(1.0, &rates) - supplied + dissipated).abs() / gross
    }

    /// By how much a Jacobian is off, over its largest entry.
    fn deviation<const P: usize>(&self, plain: &impl System<f64, N, M, P>) -> f64
    where
        S: System<Dual<f64>, N, M, P>,
    {
        let (t, x, u) = (self.time, &self.state, &self.input);
        let by_state = plain.jacobian_state(t, x, u, &mut Default::default());
        let by_input = plain.jacobian_input(t, x, u, &mut Default::default());
        let unit = |place: usize, row: usize| f64::from(u8::from(place == row));
        let mut off = 0.0;
        for column in 0..N + M {
            let x = SVector::from_fn(|row, _| unit(column, row));
            let u = SVector::from_fn(|row, _| unit(column, row + N));
            for (row, rate) in self.rates_along(&x, &u).iter().enumerate() {
                let ours = if column < N {
                    by_state[(row, column)]
                } else {
                    by_input[(row, column - N)]
                };
                let error = (ours - rate.slope).abs();
                assert!(error.is_finite(), "({row}, {column})");
                off = f64::max(off, error);
            }
        }
        let largest = f64::max(by_state.amax(), if M > 0 { by_input.amax() } else { 0.0 });
        off / largest.max(1.0)
    }

    /// No energy is created, and the Jacobians are right.
    #[track_caller]
    pub(super) fn assert_sound<const P: usize>(&self, plain: &impl System<f64, N, M, P>)
    where
        S: System<Dual<f64>, N, M, P>,
    {
        let (imbalance, deviation) = (self.imbalance(), self.deviation(plain));
        assert!(imbalance < 1e-12, "energy by {imbalance:e}");
        assert!(deviation < 1e-11, "Jacobian by {deviation:e}");
    }
}

/// Audits a model at random states, and does with each what `inspect` does.
#[track_caller]
pub(super) fn audit<D, const N: usize, const M: usize, const P: usize>(
    plain: &impl System<f64, N, M, P>,
    dual: &D,
    inspect: impl Fn(&Probe<D, N, M>),
) where
    D: System<Dual<f64>, N, M, P>,
{
    let mut next = noise(7);
    let mut regular = 0;
    for _ in 0..200 {
        let probe = Probe {
            model: dual,
            time: 2.0 * next(),
            state: SVector::from_fn(|_, _| 2.0 * next()),
            input: SVector::from_fn(|_, _| 3.0 * next()),
        };
        let conditioning = plain.conditioning(probe.time, &probe.state, &probe.input);
        if conditioning
            .as_ref()
            .iter()
            .any(|value| value.abs() < REGULAR)
        {
            continue;
        }
        regular += 1;
        probe.assert_sound(plain);
        inspect(&probe);
    }
    assert!(regular > 100, "{regular} states of 200 are regular");
}

#[track_caller]
pub(super) fn near(found: f64, expected: f64, tolerance: f64) {
    let error = (found - expected).abs() / expected.abs().max(1.0);
    assert!(error < tolerance, "{found} is not {expected}, by {error:e}");
}

/// At states about the start, closed: energies balance, and Jacobians are right.
pub(super) fn assert_sound_about_the_start<S, D, const N: usize, const M: usize, const P: usize>(
    (plain, dual): (&S, &D),
) where
    S: System<f64, N, M, P>,
    D: System<Dual<f64>, N, M, P>,
{
    let mut next = noise(5);
    for _ in 0..20 {
        let moved = plain.initial_state().map(|it| it + 0.2 * next());
        let input = SVector::from_fn(|_, _| next());
        let state = plain.close(0.3, moved, &input, &[]).unwrap();
        let probe = Probe {
            model: dual,
            time: 0.3,
            state,
            input,
        };
        probe.assert_sound(plain);
    }
}
