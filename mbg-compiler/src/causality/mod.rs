//! Stage 3, causality: who imposes what.
pub mod conflict;
pub mod dependence;
pub mod enumerate;
pub mod explain;
pub mod outlook;
pub mod propagation;
pub mod report;
pub mod report_conflict;
pub mod search;
pub mod strokes;
pub mod uniform;
pub mod ways;
pub mod words;

#[cfg(test)]
mod fixtures;
#[cfg(test)]
mod property;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod tests_report;
