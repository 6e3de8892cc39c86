//! How a point at which conditions hold is searched for, so that a motion from the guess may reach it.

use crate::apart::apart;
use crate::selection::Selection;
use crate::{Convertible, Trimmed, Untrimmed};

/// What is asked for: the model, the time, the guess, and what may be chosen.
pub(crate) struct Asked<'a, S, const N: usize, const M: usize> {
    pub(crate) system: &'a S,
    pub(crate) time: f64,
    pub(crate) start: Trimmed<N, M>,
    pub(crate) selection: Selection<N, M>,
}

/// What is found, or why nothing is, with what no motion from the guess reaches.
type Reached<F> = Result<F, (Untrimmed, Option<F>)>;

/// A search for a point at which conditions hold, or for a motion that begins there.
pub(crate) trait Search<S, const N: usize, const M: usize, const P: usize>: Sized
where
    S: Convertible<f64, N, M, P>,
{
    /// What is found.
    type Found: Copy;
    /// What states that change alike differ by may change by this part of them: by rounding.
    const APART: f64;

    fn asked(&self) -> Asked<'_, S, N, M>;

    /// The same with another choice.
    fn choosing(&self, selection: Selection<N, M>) -> Self;

    /// The same without outputs, rates and fixed states that ask for a point other than the guess.
    fn without_targets(&self) -> Self;

    /// What corrections lead to from a point.
    fn found(&self, from: Trimmed<N, M>) -> Result<Self::Found, Untrimmed>;

    /// The point at which that begins.
    fn point(found: &Self::Found) -> Trimmed<N, M>;

    /// What is found with differences between states that change alike as in the guess; with others where it is not known that no
    /// motion leads there, or where it is targets that ask for them.
    fn search(&self) -> Result<Self::Found, Untrimmed> {
        let Asked {
            start, selection, ..
        } = self.asked();
        selection.check()?;
        let Some(among) = selection.may_keep(S::META) else {
            return self.found(start);
        };
        self.reached(&among).or_else(|(missed, other)| {
            let found = other.ok_or(missed)?;
            // Unless none is reached without them it is targets that ask for other differences.
            match self.without_targets().reached(&among) {
                Err((missed, Some(_))) => Err(missed),
                _ => Ok(found),
            }
        })
    }

    /// What is found with differences between these states as in the guess, or without where it is not known that no motion leads there.
    fn reached(&self, among: &[bool; N]) -> Reached<Self::Found> {
        let Asked {
            system,
            time,
            start,
            selection,
        } = self.asked();
        let keeping = |kept| self.choosing(selection.keeping(kept));
        if let Ok(found) = keeping(*among).found(start) {
            return Ok(found);
        }
        let found = self.found(start).map_err(|missed| (missed, None))?;
        let point = Self::point(&found);
        let Some((apart, kept)) = apart(system, time, among, (&start, &point), Self::APART) else {
            return Ok(found);
        };
        // With these alone, or from there, the one with the differences of the guess may be found.
        let keeping = keeping(kept);
        let kept = keeping.found(start).or_else(|_| keeping.found(point));
        kept.map_err(|_| (apart, Some(found)))
    }
}
