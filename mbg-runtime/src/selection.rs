//! What is to be found of states and inputs, and what is wanted of each state.

use crate::meta::is_named;
use crate::{Meta, System, Trimmed, Untrimmed};

/// Which states and inputs stay as they are, and how much each state is to change, if that matters.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Selection<const N: usize, const M: usize> {
    pub(crate) fixed: ([bool; N], [bool; M]),
    pub(crate) changes: [Option<f64>; N],
    /// Among which states those that change alike differ as in the guess.
    pub(crate) kept: [bool; N],
    unknown: Option<Untrimmed>,
}

impl<const N: usize, const M: usize> Selection<N, M> {
    /// Everything is to be found, and no state to change.
    pub(crate) const fn new() -> Self {
        Self {
            fixed: ([false; N], [false; M]),
            changes: [Some(0.0); N],
            kept: [false; N],
            unknown: None,
        }
    }

    /// Nothing, unless a name was none of the model's.
    pub(crate) fn check(&self) -> Result<(), Untrimmed> {
        self.unknown.map_or(Ok(()), Err)
    }

    /// The point with its state on closed loops and attitudes, on which what stays as it is does so.
    #[inline(never)]
    pub(crate) fn closed<const P: usize>(
        &self,
        system: &impl System<f64, N, M, P>,
        time: f64,
        point: Trimmed<N, M>,
    ) -> Result<Trimmed<N, M>, Untrimmed> {
        let states = &self.fixed.0;
        // One of them stands for each state that is not fixed: where they are counted, LLVM takes minutes over the count.
        let any = states.iter().position(|is_fixed| *is_fixed);
        let all = core::array::from_fn::<_, N, _>(|state| match states[state] {
            true => state,
            false => any.unwrap_or(state),
        });
        let fixed = if any.is_some() { &all[..] } else { &[] };
        let Trimmed { state, input } = point;
        match system.close(time, state, &input, fixed) {
            Ok(state) => Ok(Trimmed { state, input }),
            Err(trouble) => Err(Untrimmed::Trouble(trouble)),
        }
    }

    /// Among which states those that change alike are to differ as in the guess: those that are to be found and to stay as they are.
    /// None where loops are closed, which decide that themselves.
    pub(crate) fn may_keep(&self, meta: &Meta) -> Option<[bool; N]> {
        let kept =
            core::array::from_fn(|state| !self.fixed.0[state] && self.changes[state] == Some(0.0));
        meta.closures.is_empty().then_some(kept)
    }

    /// The same with differences kept among these.
    pub(crate) const fn keeping(&self, kept: [bool; N]) -> Self {
        Self { kept, ..*self }
    }

    /// The same with states that may be anything, but for one that tells when a motion comes back, and may change as they do where they
    /// were to change: what is left is what inputs and the model ask for.
    pub(crate) fn without_targets(&self, section: Option<usize>) -> Self {
        let (states, inputs) = self.fixed;
        let fixed = core::array::from_fn(|state| states[state] && Some(state) == section);
        let at_rest = |change: Option<f64>| change.filter(|change| *change == 0.0);
        Self {
            fixed: (fixed, inputs),
            changes: self.changes.map(at_rest),
            ..*self
        }
    }

    /// Keeps states or inputs of this name as they are.
    pub(crate) fn fix(&mut self, meta: &Meta, name: &'static str) {
        let mut found = false;
        let names = meta.states.iter().chain(meta.inputs);
        for (fixed, variable) in self.fixed.0.iter_mut().chain(&mut self.fixed.1).zip(names) {
            let is_named = is_named(variable.name, name);
            (*fixed, found) = (*fixed || is_named, found || is_named);
        }
        self.know(found, "state or input", name);
    }

    /// Wants a change of states of this name.
    pub(crate) fn change(&mut self, meta: &Meta, name: &'static str, wanted: Option<f64>) {
        let mut found = false;
        for (change, variable) in self.changes.iter_mut().zip(meta.states) {
            if is_named(variable.name, name) {
                (*change, found) = (wanted, true);
            }
        }
        self.know(found, "state", name);
    }

    /// Keeps the first name that is not found.
    pub(crate) fn know(&mut self, found: bool, kind: &'static str, name: &'static str) {
        if !found && self.unknown.is_none() {
            self.unknown = Some(Untrimmed::Unknown { kind, name });
        }
    }
}
