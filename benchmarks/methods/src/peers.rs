//! Solvers of other crates, given the same right-hand side, the same exact Jacobian, and a new start behind each jump.

use mbg_compare::{Comparison, Problem, TOLERANCES};
use mbg_runtime::{Input, Statistics, System};
use nalgebra::SVector;
use numeris::ode::{
    AdaptiveSettings, RKAdaptive, RKTS54, RKV87, RKV98NoInterp, RODAS4, Rosenbrock,
};
use numeris::{Matrix, Vector};
use ode_solvers::dop_shared::OutputType;

pub type Row<const N: usize> = SVector<f64, N>;

/// The right-hand side that is given to others.
pub trait RightHandSide<const N: usize, const M: usize> {
    /// The derivative of the state.
    fn slope(&self, t: f64, x: &Row<N>, u: &SVector<f64, M>) -> Row<N>;
}

/// That of our model.
pub struct Ours<'a, S, const P: usize>(pub &'a S);

impl<S, const N: usize, const M: usize, const P: usize> RightHandSide<N, M> for Ours<'_, S, P>
where
    S: System<f64, N, M, P>,
{
    #[inline]
    fn slope(&self, t: f64, x: &Row<N>, u: &SVector<f64, M>) -> Row<N> {
        self.0.derivative(t, x, u, &mut S::Memory::default())
    }
}

/// The state at the end of a piece, and what it took.
type Piece<const N: usize> = Result<(Row<N>, Statistics), String>;

/// Runs a solver from jump to jump, and to each time at which the problem is judged.
pub fn pieces<S, I, const N: usize, const M: usize, const P: usize>(
    problem: &Problem<'_, S, I, N, M, P>,
    times: &[f64],
    states: &mut Vec<Row<N>>,
    mut piece: impl FnMut([f64; 2], Row<N>) -> Piece<N>,
) -> Result<Statistics, String>
where
    S: System<f64, N, M, P>,
    I: Input<f64, M>,
{
    let (mut t, mut x) = (problem.start, problem.state);
    let mut sum = Statistics::default();
    for &time in times {
        while t < time {
            let end = match problem.input.next_jump(t) {
                Some(jump) if jump < time => jump,
                _ => time,
            };
            let (next, statistics) = piece([t, end], x)?;
            sum += statistics;
            (t, x) = (end, next);
        }
        states.push(x);
    }
    Ok(sum)
}

fn settings([relative, absolute]: [f64; 2]) -> AdaptiveSettings<f64> {
    AdaptiveSettings {
        rel_tol: relative,
        abs_tol: absolute,
        min_step: 1e-30,
        max_steps: 10_000_000,
        ..AdaptiveSettings::default()
    }
}

fn gathered<const N: usize>(y: &Vector<f64, N>) -> Row<N> {
    Row::from_fn(|state, _| y[state])
}

fn spread<const N: usize>(x: &Row<N>) -> Vector<f64, N> {
    Vector::from_array(core::array::from_fn(|state| x[state]))
}

fn taken<const N: usize>(solution: numeris::ode::Solution<f64, N, 1>) -> (Row<N>, Statistics) {
    let statistics = Statistics {
        steps: solution.accepted as u64,
        rejected: solution.rejected as u64,
        evaluations: solution.evals as u64,
        ..Statistics::default()
    };
    (gathered(&solution.y), statistics)
}

/// A right-hand side as `ode_solvers` takes it.
struct Slope<'b, I, L, const M: usize> {
    input: &'b I,
    law: &'b L,
    since: f64,
}

type Column<const N: usize> = ode_solvers::SVector<f64, N>;

impl<I, L, const N: usize, const M: usize> ode_solvers::System<f64, Column<N>>
    for Slope<'_, I, L, M>
where
    I: Input<f64, M>,
    L: RightHandSide<N, M>,
{
    fn system(&self, t: f64, y: &Column<N>, dy: &mut Column<N>) {
        let u = self.input.value(t, self.since);
        let x = Row::from(<[f64; N]>::from(*y));
        let slope = self.law.slope(t, &x, &u);
        *dy = Column::from(<[f64; N]>::from(slope));
    }
}

/// Puts solvers of other crates into a comparison, at all its tolerances.
pub struct Peers<'c, 'p, S, I, L, const N: usize, const M: usize, const P: usize> {
    comparison: &'c mut Comparison<'p, S, I, N, M, P>,
    law: &'c L,
    /// Absolute tolerances as a part of relative ones.
    small: f64,
}

impl<'c, 'p, S, I, L, const N: usize, const M: usize, const P: usize>
    Peers<'c, 'p, S, I, L, N, M, P>
where
    S: System<f64, N, M, P>,
    I: Input<f64, M>,
    L: RightHandSide<N, M>,
{
    pub fn new(comparison: &'c mut Comparison<'p, S, I, N, M, P>, law: &'c L, small: f64) -> Self {
        Self {
            comparison,
            law,
            small,
        }
    }

    /// Adds a solver. `piece` goes from one time to another, between which nothing jumps, at a relative and an absolute
    /// tolerance.
    fn add(
        &mut self,
        name: &str,
        piece: impl Fn(&Problem<'p, S, I, N, M, P>, [f64; 2], [f64; 2], Row<N>) -> Piece<N>,
    ) {
        let problem = self.comparison.problem().clone();
        for tolerance in TOLERANCES {
            let tolerances = [tolerance, tolerance * self.small];
            let run = |times: &[f64], states: &mut Vec<Row<N>>| {
                pieces(&problem, times, states, |times, x| {
                    piece(&problem, tolerances, times, x)
                })
            };
            let setting = format!("rtol = {tolerance:e}");
            self.comparison.solver(name, &setting, run);
        }
    }

    /// An explicit method of `numeris`.
    fn explicit<A: RKAdaptive<G, D>, const G: usize, const D: usize>(&mut self, name: &str) {
        let law = self.law;
        self.add(name, |problem, tolerances, [t, end], x| {
            let slope = |time: f64, y: &Vector<f64, N>| {
                let u = problem.input.value(time, t);
                spread(&law.slope(time, &gathered(y), &u))
            };
            A::integrate(t, end, &spread(&x), slope, &settings(tolerances))
                .map(taken)
                .map_err(|error| format!("{error:?}"))
        });
    }

    /// `numeris`: Verner's pairs of orders 9 and 8 and of 8 and 7, and that of Tsitouras.
    pub fn numeris_smooth(&mut self) {
        self.explicit::<RKV98NoInterp, _, _>("numeris rkv98");
        self.explicit::<RKV87, _, _>("numeris rkv87");
        self.explicit::<RKTS54, _, _>("numeris rkts54");
    }

    /// `numeris`: Rodas4.
    pub fn numeris_stiff(&mut self) {
        let name = format!("numeris rodas4, atol {:e} rtol", self.small);
        self.add(&name, |problem, tolerances, [t, end], x| {
            let (mut first, mut second) = (S::Memory::default(), S::Memory::default());
            let slope = |time: f64, y: &Vector<f64, N>| {
                let u = problem.input.value(time, t);
                spread(
                    &problem
                        .system
                        .derivative(time, &gathered(y), &u, &mut first),
                )
            };
            let jacobian = |time: f64, y: &Vector<f64, N>| {
                let u = problem.input.value(time, t);
                let found = problem
                    .system
                    .jacobian_state(time, &gathered(y), &u, &mut second);
                Matrix::from_fn(|row, column| found[(row, column)])
            };
            RODAS4::integrate(t, end, &spread(&x), slope, jacobian, &settings(tolerances))
                .map(taken)
                .map_err(|error| format!("{error:?}"))
        });
    }

    /// `ode_solvers`: the method of Dormand and Prince of order 8.
    pub fn ode_solvers_smooth(&mut self) {
        let law = self.law;
        self.add(
            "ode_solvers dop853",
            |problem, [relative, absolute], [t, end], x| {
                let slope = Slope {
                    input: problem.input,
                    law,
                    since: t,
                };
                let start = Column::from(<[f64; N]>::from(x));
                let mut stepper =
                    ode_solvers::Dop853::new(slope, t, end, end - t, start, relative, absolute);
                stepper.set_output(OutputType::Sparse);
                let statistics = stepper.integrate().map_err(|error| error.to_string())?;
                let last = stepper.y_out().last().ok_or("no result")?;
                let statistics = Statistics {
                    steps: u64::from(statistics.accepted_steps),
                    rejected: u64::from(statistics.rejected_steps),
                    evaluations: u64::from(statistics.num_eval),
                    ..Statistics::default()
                };
                Ok((Row::from(<[f64; N]>::from(*last)), statistics))
            },
        );
    }
}
