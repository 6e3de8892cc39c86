//! Speed against error of methods of integration on any [`System`].
//!
//! [`compare`] is all that is needed: it works out a reference, verifies it, runs the methods that suit the problem, and
//! gives a [`Comparison`] that prints as a table and draws as a picture of error against time, evaluations and steps.
//! A [`Comparison`] that is made by hand takes any method of `mbg-runtime` and solvers from elsewhere.
//!
//! # Example
//!
//! ```
//! use mbg_compare::{Comparison, Problem, compare};
//! use mbg_runtime::{Rk4, System};
//!
//! fn report<const N: usize, const P: usize>(
//!     model: &impl System<f64, N, 0, P>,
//! ) -> Result<(), Box<dyn std::error::Error>> {
//!     let problem = Problem::new("My model", model, &(), (0.0, 10.0), model.initial_state());
//!     let mut comparison: Comparison<'_, _, _, N, 0, P> = compare(problem)?;
//!     comparison.over_steps(Rk4, &[0.1, 0.01, 0.001]);
//!     println!("{comparison}");
//!     comparison.draw("my_model.svg")?;
//!     Ok(())
//! }
//! ```

mod measure;
mod picture;
mod reference;
mod table;

use mbg_runtime::{Dop853, Input, Pirk8, Radau5, Radau9, Rodas4, Rodas5P, System, Tsit5};
use nalgebra::SVector;

pub use measure::{Comparison, Measured, Point};
pub use reference::{Reference, Unverified};

/// What is integrated, and where it is judged.
#[derive(Debug)]
pub struct Problem<'a, S, I, const N: usize, const M: usize, const P: usize> {
    /// The head of table and picture.
    pub title: String,
    /// The model.
    pub system: &'a S,
    /// Its inputs.
    pub input: &'a I,
    /// The time at which it starts.
    pub start: f64,
    /// The state there.
    pub state: SVector<f64, N>,
    /// The times at which states are compared, ascending; runs end with the last of them.
    pub times: Vec<f64>,
    /// Nominal sizes of the states: a state counts as no smaller. Without them each counts by its largest size.
    pub nominal: Option<[f64; N]>,
    /// How well two methods must agree for a reference.
    pub agreement: f64,
}

/// Written out, because the model and its inputs need not be cloned.
impl<S, I, const N: usize, const M: usize, const P: usize> Clone for Problem<'_, S, I, N, M, P> {
    fn clone(&self) -> Self {
        Self {
            title: self.title.clone(),
            times: self.times.clone(),
            ..*self
        }
    }
}

impl<'a, S, I, const N: usize, const M: usize, const P: usize> Problem<'a, S, I, N, M, P>
where
    S: System<f64, N, M, P>,
    I: Input<f64, M>,
{
    /// A problem that is judged at its end, by a reference on which two methods agree within 1e-8.
    pub fn new(
        title: impl Into<String>,
        system: &'a S,
        input: &'a I,
        (start, end): (f64, f64),
        state: SVector<f64, N>,
    ) -> Self {
        Self {
            title: title.into(),
            system,
            input,
            start,
            state,
            times: vec![end],
            nominal: None,
            agreement: 1e-8,
        }
    }

    /// The same, judged at these times, in whatever order; without any at its end.
    #[must_use]
    pub fn at(mut self, times: impl Into<Vec<f64>>) -> Self {
        let mut times = times.into();
        times.sort_by(f64::total_cmp);
        if !times.is_empty() {
            self.times = times;
        }
        self
    }

    /// The same with nominal sizes of the states.
    #[must_use]
    pub fn nominal(mut self, sizes: [f64; N]) -> Self {
        self.nominal = Some(sizes);
        self
    }

    fn end(&self) -> f64 {
        self.times.last().copied().unwrap_or(self.start)
    }

    fn sizes(&self) -> &[f64] {
        self.nominal.as_ref().map_or(&[], |sizes| sizes.as_slice())
    }
}

/// Tolerances that [`compare`] asks for.
pub const TOLERANCES: [f64; 7] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9];

/// Runs the adaptive methods that suit the problem: those for stiff problems where
/// [`Auto`](mbg_runtime::Auto) would pick one, else those for smooth ones.
///
/// # Errors
///
/// No two methods agree on a reference.
pub fn compare<S, I, const N: usize, const M: usize, const P: usize>(
    problem: Problem<'_, S, I, N, M, P>,
) -> Result<Comparison<'_, S, I, N, M, P>, Unverified>
where
    S: System<f64, N, M, P>,
    I: Input<f64, M>,
{
    let mut comparison = Comparison::new(problem)?;
    if comparison.reference().stiff {
        comparison.over_tolerances(Rodas4, &TOLERANCES);
        comparison.over_tolerances(Rodas5P, &TOLERANCES);
        comparison.over_tolerances(Radau5, &TOLERANCES);
        comparison.over_tolerances(Radau9, &TOLERANCES);
    } else {
        comparison.over_tolerances(Tsit5, &TOLERANCES);
        comparison.over_tolerances(Dop853, &TOLERANCES);
        comparison.over_tolerances(Pirk8, &TOLERANCES);
    }
    Ok(comparison)
}
