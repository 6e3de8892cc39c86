//! Models written from first principles, independent of the compiler: what it generates is compared with them.
//!
//! A test file includes this tree with `#[path = "references/mod.rs"] mod references;`.
#![allow(dead_code, clippy::unwrap_used)]

pub(crate) mod andrews;
pub(crate) mod bricard;
pub(crate) mod cart;
pub(crate) mod chain;
pub(crate) mod crane;
pub(crate) mod dense;
pub(crate) mod double_pendulum;
pub(crate) mod errors;
pub(crate) mod flywheels;
pub(crate) mod four_bar;
pub(crate) mod governor;
pub(crate) mod integrate;
pub(crate) mod noise;
pub(crate) mod planar;
pub(crate) mod quarter_car;
pub(crate) mod rectifier;
pub(crate) mod robots;
pub(crate) mod slider_crank;
pub(crate) mod transistor_amplifier;
pub(crate) mod tree;
pub(crate) mod walker;
