//! The table.

use core::fmt;

use crate::Comparison;

impl<S, I, const N: usize, const M: usize, const P: usize> fmt::Display
    for Comparison<'_, S, I, N, M, P>
{
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (problem, reference) = (self.problem(), self.reference());
        let end = problem.times.last().copied().unwrap_or(problem.start);
        writeln!(
            formatter,
            "{}, {} s to {end} s",
            problem.title, problem.start
        )?;
        let [first, second] = reference.methods;
        writeln!(
            formatter,
            "reference: {first} at {:e}, with which {second} agrees within {:.0e}; smaller errors are not certain",
            reference.tolerance, reference.agreement
        )?;
        let names = self.points().iter().map(|it| it.method.chars().count());
        let wide = names.fold(18, usize::max) + 2;
        writeln!(
            formatter,
            "\n{:<wide$}{:<16}{:>10}{:>12}{:>14}{:>10}",
            "method", "setting", "error", "time / µs", "evaluations", "steps"
        )?;
        for point in self.points() {
            write!(formatter, "{:<wide$}{:<16}", point.method, point.setting)?;
            match &point.outcome {
                Ok(it) => writeln!(
                    formatter,
                    "{:>10.1e}{:>12.1}{:>14}{:>10}",
                    it.error,
                    it.time * 1e6,
                    it.evaluations,
                    it.steps
                )?,
                Err(reason) => writeln!(formatter, "  {reason}")?,
            }
        }
        Ok(())
    }
}
