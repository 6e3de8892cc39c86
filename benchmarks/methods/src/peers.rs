//! Solvers of other crates, given the same right-hand side, the same exact Jacobian, and a new start behind each jump.

use mbg_compare::{Comparison, Problem};
use mbg_runtime::{Input, Statistics, System};
use nalgebra::SVector;
use numeris::ode::{
    AdaptiveSettings, RKAdaptive, RKTS54, RKV87, RKV98NoInterp, RODAS4, Rosenbrock,
};
use numeris::{Matrix, Vector};
use ode_solvers::dop_shared::OutputType;

pub(crate) type Row<const N: usize> = SVector<f64, N>;

/// The right-hand side that is given to others.
pub(crate) trait Law<const N: usize, const M: usize> {
    fn slope(&self, t: f64, x: &Row<N>, u: &SVector<f64, M>) -> Row<N>;
}

/// That of our model.
pub(crate) struct Ours<'a, S, const P: usize>(pub &'a S);

impl<S, const N: usize, const M: usize, const P: usize> Law<N, M> for Ours<'_, S, P>
where
    S: System<f64, N, M, P>,
{
    #[inline]
    fn slope(&self, t: f64, x: &Row<N>, u: &SVector<f64, M>) -> Row<N> {
        self.0.derivative(t, x, u, &mut S::Memory::default())
    }
}

/// Runs a solver from jump to jump, and to each time at which the problem is judged.
pub(crate) fn pieces<S, I, const N: usize, const M: usize, const P: usize>(
    problem: &Problem<'_, S, I, N, M, P>,
    times: &[f64],
    states: &mut Vec<Row<N>>,
    mut piece: impl FnMut(f64, f64, Row<N>) -> Result<(Row<N>, Statistics), String>,
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
            let (next, statistics) = piece(t, end, x)?;
            sum.evaluations += statistics.evaluations;
            sum.steps += statistics.steps;
            sum.rejected += statistics.rejected;
            sum.factorisations += statistics.factorisations;
            (t, x) = (end, next);
        }
        states.push(x);
    }
    Ok(sum)
}

fn settings(tolerance: f64, absolute: f64) -> AdaptiveSettings<f64> {
    AdaptiveSettings {
        rel_tol: tolerance,
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

/// An explicit method of `numeris`.
fn explicit<
    A,
    S,
    I,
    L,
    const G: usize,
    const D: usize,
    const N: usize,
    const M: usize,
    const P: usize,
>(
    name: &str,
    comparison: &mut Comparison<'_, S, I, N, M, P>,
    law: &L,
    tolerances: &[f64],
    small: f64,
) where
    A: RKAdaptive<G, D>,
    S: System<f64, N, M, P>,
    I: Input<f64, M>,
    L: Law<N, M>,
{
    let problem = comparison.problem().clone();
    for &tolerance in tolerances {
        let set = settings(tolerance, tolerance * small);
        let run = |times: &[f64], states: &mut Vec<Row<N>>| {
            pieces(&problem, times, states, |t, end, x| {
                let slope = |time: f64, y: &Vector<f64, N>| {
                    let u = problem.input.value(time, t);
                    spread(&law.slope(time, &gathered(y), &u))
                };
                A::integrate(t, end, &spread(&x), slope, &set)
                    .map(taken)
                    .map_err(|error| format!("{error:?}"))
            })
        };
        comparison.solver(name, &format!("rtol = {tolerance:e}"), run);
    }
}

/// `numeris`: Verner's pairs of orders 9 and 8 and of 8 and 7, and that of Tsitouras.
pub fn numeris_smooth<S, I, L, const N: usize, const M: usize, const P: usize>(
    comparison: &mut Comparison<'_, S, I, N, M, P>,
    law: &L,
    tolerances: &[f64],
    small: f64,
) where
    S: System<f64, N, M, P>,
    I: Input<f64, M>,
    L: Law<N, M>,
{
    explicit::<RKV98NoInterp, _, _, _, _, _, N, M, P>(
        "numeris rkv98",
        comparison,
        law,
        tolerances,
        small,
    );
    explicit::<RKV87, _, _, _, _, _, N, M, P>("numeris rkv87", comparison, law, tolerances, small);
    explicit::<RKTS54, _, _, _, _, _, N, M, P>(
        "numeris rkts54",
        comparison,
        law,
        tolerances,
        small,
    );
}

/// `numeris`: Rodas4.
pub fn numeris_stiff<S, I, const N: usize, const M: usize, const P: usize>(
    comparison: &mut Comparison<'_, S, I, N, M, P>,
    tolerances: &[f64],
    small: f64,
) where
    S: System<f64, N, M, P>,
    I: Input<f64, M>,
{
    let problem = comparison.problem().clone();
    for &tolerance in tolerances {
        let set = settings(tolerance, tolerance * small);
        let run = |times: &[f64], states: &mut Vec<Row<N>>| {
            let (mut first, mut second) = (S::Memory::default(), S::Memory::default());
            pieces(&problem, times, states, |t, end, x| {
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
                RODAS4::integrate(t, end, &spread(&x), slope, jacobian, &set)
                    .map(taken)
                    .map_err(|error| format!("{error:?}"))
            })
        };
        let name = format!("numeris rodas4, atol {small:e} rtol");
        comparison.solver(&name, &format!("rtol = {tolerance:e}"), run);
    }
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
    L: Law<N, M>,
{
    fn system(&self, t: f64, y: &Column<N>, dy: &mut Column<N>) {
        let u = self.input.value(t, self.since);
        let x = Row::from(<[f64; N]>::from(*y));
        let slope = self.law.slope(t, &x, &u);
        *dy = Column::from(<[f64; N]>::from(slope));
    }
}

/// `ode_solvers`: the method of Dormand and Prince of order 8.
pub fn ode_solvers_smooth<S, I, L, const N: usize, const M: usize, const P: usize>(
    comparison: &mut Comparison<'_, S, I, N, M, P>,
    law: &L,
    tolerances: &[f64],
    small: f64,
) where
    S: System<f64, N, M, P>,
    I: Input<f64, M>,
    L: Law<N, M>,
{
    let problem = comparison.problem().clone();
    for &tolerance in tolerances {
        let run = |times: &[f64], states: &mut Vec<Row<N>>| {
            pieces(&problem, times, states, |t, end, x| {
                let slope = Slope {
                    input: problem.input,
                    law,
                    since: t,
                };
                let start = Column::from(<[f64; N]>::from(x));
                let mut stepper = ode_solvers::Dop853::new(
                    slope,
                    t,
                    end,
                    end - t,
                    start,
                    tolerance,
                    tolerance * small,
                );
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
            })
        };
        comparison.solver("ode_solvers dop853", &format!("rtol = {tolerance:e}"), run);
    }
}
