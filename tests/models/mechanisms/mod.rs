//! Published mechanisms with closed loops, built from the library and run over their published horizons.

pub(crate) mod andrews;
#[cfg(test)]
mod bennett;
pub(crate) mod bricard;
pub(crate) mod four_bars;
pub(crate) mod governor;
pub(crate) mod slider_crank;
mod task;
#[cfg(test)]
mod tests;

pub(crate) use task::{Figures, Method, Task, states};
