//! Error against work: two methods on smooth problems, four on stiff ones and on one of both kinds, and what `Auto` makes of them.
//!
//! `cargo run --release --example methods`

#[allow(dead_code, reason = "tests use more of it")]
mod problems;

use std::time::Instant;

use mbg_runtime::{
    Adaptive, Auto, Dop853, Estimating, Integrator, Radau5, Radau9, Rodas4, Rodas5P, Statistics,
    Stopped, Tsit5,
};
use nalgebra::SVector;
use problems::{Law, Pendulum, RigidBody, Robertson, StiffPin, VanDerPol, Warmed, Written};

/// A problem without inputs and the state at its end.
struct Task<L, const N: usize> {
    title: &'static str,
    law: L,
    start: SVector<f64, N>,
    end: f64,
    nominal: [f64; N],
    reference: SVector<f64, N>,
}

impl<L: Law<N, 0> + Copy, const N: usize> Task<L, N> {
    /// A task whose reference is a run by another method at a tolerance of 1e-12.
    fn new(
        title: &'static str,
        law: L,
        (start, end): (SVector<f64, N>, f64),
        nominal: [f64; N],
        strict: impl Estimating,
    ) -> Result<Self, Stopped> {
        let mut task = Self {
            title,
            law,
            start,
            end,
            nominal,
            reference: start,
        };
        task.reference = task.run(&task.with(strict, 1e-12))?.0;
        Ok(task)
    }

    fn with<S>(&self, method: S, tolerance: f64) -> Adaptive<'_, S> {
        Adaptive {
            nominal: &self.nominal,
            ..Adaptive::new(method, tolerance, tolerance)
        }
    }

    fn run(&self, solver: &impl Integrator<N>) -> Result<(SVector<f64, N>, Statistics), Stopped> {
        let mut last = self.start;
        let statistics =
            solver.integrate(&Written(self.law), &(), 0.0, self.end, self.start, |step| {
                last = *step.state()
            })?;
        Ok((last, statistics))
    }

    /// The largest error of a state relative to the larger of its size and its nominal size.
    fn error(&self, found: &SVector<f64, N>) -> f64 {
        (0..N).fold(0.0, |largest, state| {
            let size = self.reference[state].abs().max(self.nominal[state]);
            f64::max(largest, (found[state] - self.reference[state]).abs() / size)
        })
    }

    fn head(&self) {
        println!("\n{}, 0 to {} s", self.title, self.end);
        println!(
            "{:<13}{:>10}{:>10}{:>8}{:>10}{:>13}{:>11}{:>11}{:>11}",
            "method",
            "tolerance",
            "error",
            "steps",
            "rejected",
            "evaluations",
            "jacobians",
            "factorised",
            "time / µs"
        );
    }

    /// A line; the time is the median of eleven runs.
    fn line(&self, name: &str, tolerance: f64, solver: &impl Integrator<N>) -> Result<(), Stopped> {
        let (found, statistics) = self.run(solver)?;
        let mut times = [0.0; 11];
        for time in &mut times {
            let start = Instant::now();
            let _ = std::hint::black_box(self.run(solver)?);
            *time = start.elapsed().as_secs_f64() * 1e6;
        }
        times.sort_by(f64::total_cmp);
        println!(
            "{name:<13}{tolerance:>10.0e}{:>10.1e}{:>8}{:>10}{:>13}{:>11}{:>11}{:>11.0}",
            self.error(&found),
            statistics.steps,
            statistics.rejected,
            statistics.evaluations,
            statistics.jacobians,
            statistics.factorisations,
            times[5]
        );
        Ok(())
    }

    fn lines<S: Estimating>(&self, method: S) -> Result<(), Stopped> {
        for tolerance in [1e-3, 1e-6, 1e-9] {
            self.line(S::NAME, tolerance, &self.with(method, tolerance))?;
        }
        Ok(())
    }

    fn auto(&self) -> Result<(), Stopped> {
        let auto = |tolerance| Auto {
            nominal: &self.nominal,
            ..Auto::new(tolerance, tolerance)
        };
        for tolerance in [1e-3, 1e-6, 1e-9] {
            self.line("auto", tolerance, &auto(tolerance))?;
        }
        let (system, input) = (Written(self.law), ());
        let choice = auto(1e-6).choose(&system, &input, 0.0, self.end, self.start)?;
        println!("auto picks {choice}");
        Ok(())
    }

    fn smooth(&self) -> Result<(), Stopped> {
        self.head();
        self.lines(Tsit5)?;
        self.lines(Dop853)?;
        self.auto()
    }

    /// Of both kinds.
    fn mixed(&self) -> Result<(), Stopped> {
        self.head();
        self.lines(Tsit5)?;
        self.lines(Dop853)?;
        self.lines(Rodas5P)?;
        self.lines(Radau9)?;
        self.auto()
    }

    fn stiff(&self) -> Result<(), Stopped> {
        self.head();
        self.lines(Rodas4)?;
        self.lines(Rodas5P)?;
        self.lines(Radau5)?;
        self.lines(Radau9)?;
        self.auto()
    }
}

fn main() -> Result<(), Stopped> {
    let start = SVector::from([2.0, 1.0]);
    Task::new("pendulum", Pendulum, (start, 100.0), [1.0; 2], Dop853)?.smooth()?;
    let start = SVector::from([1e-4, 10.0, 6e-4, 1.0, 0.0, 0.0, 0.0]);
    let title = "rigid body near its middle axis";
    Task::new(title, RigidBody, (start, 100.0), [1.0; 7], Dop853)?.smooth()?;

    let start = SVector::from_fn(|place, _| if place == 0 { 1.0 } else { 0.0 });
    let title = "rod of eight parts, warmed at one end";
    Task::new(title, Warmed, (start, 20.0), [1.0; 10], Radau9)?.mixed()?;

    let pin = StiffPin {
        stiffness: 1e8,
        damping: 1e3,
    };
    let nominal = [1e-7, 1e-7, 1.0, 1e-3, 1e-3, 1.0];
    let title = "pendulum on a stiff pin, 1e8 N/m";
    Task::new(title, pin, (StiffPin::level(), 5.0), nominal, Radau5)?.stiff()?;
    let start = SVector::from([2.0, 0.0]);
    Task::new(
        "Van der Pol, 1e-6",
        VanDerPol,
        (start, 2.0),
        [1.0; 2],
        Rodas5P,
    )?
    .stiff()?;
    let start = SVector::from([1.0, 0.0, 0.0]);
    let nominal = [1.0, 1e-5, 1.0];
    Task::new("Robertson", Robertson, (start, 1e5), nominal, Radau5)?.stiff()
}
