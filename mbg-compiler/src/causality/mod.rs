//! Stage 3, causality: who imposes what.
pub mod uniform;
