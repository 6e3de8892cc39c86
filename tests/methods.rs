//! Methods of integration on problems with known answers: orders, dense output, events, hard cases.
#![allow(clippy::unwrap_used)]

#[path = "references/errors.rs"]
#[allow(dead_code)]
mod errors;
#[path = "../examples/methods/problems.rs"]
mod problems;

#[path = "methods/attitudes.rs"]
mod attitudes;
#[path = "methods/auto.rs"]
mod auto;
#[path = "methods/changes.rs"]
mod changes;
#[path = "methods/driven.rs"]
mod driven;
#[path = "methods/events.rs"]
mod events;
#[path = "methods/hard.rs"]
mod hard;
#[path = "methods/jumps.rs"]
mod jumps;
#[path = "methods/kinks.rs"]
mod kinks;
#[path = "methods/orders.rs"]
mod orders;
#[path = "methods/parallel.rs"]
mod parallel;
#[path = "methods/roots.rs"]
mod roots;
#[path = "methods/sampled.rs"]
mod sampled;
#[path = "methods/singular.rs"]
mod singular;
#[path = "methods/sliding.rs"]
mod sliding;
#[path = "methods/stability.rs"]
mod stability;
#[path = "methods/starts.rs"]
mod starts;
#[path = "methods/stops.rs"]
mod stops;
#[path = "methods/thresholds.rs"]
mod thresholds;
#[path = "methods/times.rs"]
mod times;
#[path = "methods/work.rs"]
mod work;
