//! Models of physical systems, written as bond graphs in the macro `mbg!`, and what runs, trims and linearises them.
//!
//! Begin with the [`language`], whose first example is a whole model with its run.
//!
//! | to | look at |
//! |---|---|
//! | write a model | the [`language`], the [`joints`] of the library, all its components in the [`library`] |
//! | see what models do | `docs/gallery.md` of the repository, a picture of each |
//! | ask a model | [`System`], [`Meta`] |
//! | run it | [`Integrator`]: [`Fixed`] steps or an [`Adaptive`] one, and a [`Method`]; or [`Auto`], which picks them; [`Input`] |
//! | write what it does as CSV | `examples/log_to_csv.rs` of the repository |
//! | stop it at an event, change its state and go on | [events](language#events), [`Integrator::until`] |
//! | drive it by a recorded log | [`Sampled`] |
//! | find where it rests, hovers or turns steadily | [`Trim`] |
//! | find a periodic motion, and whether it is stable | [`PeriodicTrim`] |
//! | design a controller for it | [`Linearised`]: its matrices, poles and frequency response |
//! | run it with a controller, sampled or not | [controllers](language#controllers) |
//! | estimate its state, predict its motion | [`Rk4::transition`], [`Convertible::output_jacobian_state`] |
//! | compute with other numbers | [`Real`], [`Dual`]; `lanes` with the feature of that name |
//! | run batches on any processor | `batch` with the feature `dispatch` |
//! | find out what went wrong | [`Stopped`], [`Trouble`], [`ParameterError`] |
//!
//! A crate with models depends on this one (by path, until it is published) and on `nalgebra`, whose vectors and matrices models
//! take and return:
//!
//! ```toml
//! [dependencies]
//! mbg-runtime = { path = "../mbg/mbg-runtime" }
//! nalgebra = "0.35"
//! ```
//!
//! `nalgebra` must have that version. It is also re-exported as [`mbg_runtime::nalgebra`](mod@nalgebra), which needs no dependency
//! of its own.
//!
//! Cargo does not optimise macros, not even in release builds. Where a large model takes long to expand, optimise them in
//! `Cargo.toml`:
//!
//! ```toml
//! [profile.dev.build-override]
//! opt-level = 3
//! [profile.release.build-override]
//! opt-level = 3
//! ```
//!
//! # Features
//!
//! | feature | gives |
//! |---|---|
//! | `macros`, on unless it is switched off | the macro `mbg!` |
//! | `std` | for a desktop: fused multiply-add where the target has it, several columns or rows of a large Jacobian at once, functions of the standard library |
//! | `lanes` | [`Real`] for several numbers side by side; part of `std` |
//! | `dispatch` | batches by the widest registers that a processor has; with `std` |
//! | `reproducible` | the same bits on every target: no fused multiply-add, and elementary functions of the crate `libm` |
//! | `numeris` | the pair of Verner of order 9(8), with the coefficients of that crate |
//!
//! Without `std` nothing of the standard library is linked. For speed on a desktop, enable `std` and compile for its processor:
//!
//! ```toml
//! # Cargo.toml
//! mbg-runtime = { path = "../mbg/mbg-runtime", features = ["std"] }
//!
//! # .cargo/config.toml
//! [build]
//! rustflags = ["-C", "target-cpu=native"]
//! ```
#![no_std]
#[cfg(any(test, feature = "std"))]
extern crate std;

#[doc(hidden)]
pub mod __private;
mod apart;
pub mod attitude;
#[cfg(feature = "dispatch")]
pub mod batch;
mod beside;
#[cfg(all(test, feature = "macros"))]
mod called;
mod columns;
mod convertible;
mod course;
mod dual;
mod exponential;
mod four;
mod input;
mod lane;
#[cfg(feature = "lanes")]
pub mod lanes;
mod linearised;
#[cfg(any(feature = "macros", all(doc, not(doctest))))]
#[doc = include_str!("language.md")]
pub mod language {}
#[cfg(any(feature = "macros", all(doc, not(doctest))))]
#[doc = include_str!("joints.md")]
pub mod joints {}
#[cfg(any(feature = "macros", all(doc, not(doctest))))]
#[doc = include_str!("library.md")]
pub mod library {}
mod meta;
mod periodic;
mod poles;
mod real;
mod scalar;
mod search;
mod selection;
mod sine;
pub mod solve;
mod sparsity;
mod step;
mod system;
mod trim;
#[cfg(test)]
mod twofold;
mod untrimmed;

pub use columns::Columns;
pub use convertible::Convertible;
pub use course::Course;
pub use dual::Dual;
pub use four::Four;
pub use input::{Constant, Differentiable, Input, Pulse, SampleError, Sampled, Smooth, Sum};
pub use linearised::Linearised;
pub use meta::{Bond, Eliminated, Loop, LoopClass, Meta, Operations, Solver, Stroke, Variable};
pub use nalgebra;
pub use periodic::{Cycle, PeriodicTrim};
pub use real::{FUSED, Real};
pub use solve::{LoopMemory, Memory, Outcome};
pub use sparsity::{Elimination, Sparsity};
#[cfg(feature = "numeris")]
pub use step::Verner9;
pub use step::{
    Adaptive, Arrival, Auto, Cause, Choice, Direction, Dop853, Estimating, Fixed, Gauss6,
    ImplicitMidpoint, Integrator, Method, Picked, Pirk8, Pirk16, Radau5, Radau9, Reason, Rk4,
    Rodas4, Rodas5P, Room, Rooms, Ros2, Statistics, Step, Stopped, Transition, Tsit5,
};
pub use system::{ParameterError, Power, System, Trouble};
pub use trim::{Trim, Trimmed};
pub use untrimmed::Untrimmed;

/// Compiles multibond graphs into flat, allocation-free state-space code.
///
/// A `model Name { … }` becomes a type `Name<T>` that implements [`System`] for every scalar `T` that is [`Real`], and a type
/// `NameParameters<T>` with its parameters. `Name::new` takes these and checks them. The module [`language`] describes what stands
/// between the braces; [`joints`] and [`library`] describe the components that are there without being declared.
///
/// ```
/// use mbg_runtime::{System, mbg};
///
/// mbg! {
///     /// A mass on a spring.
///     model Swing {
///         param stiffness: N/m = 50.0;
///         1 velocity {
///             I body { inertia: 2.0 }
///             C spring { stiffness: stiffness, initial: 0.1 }
///         }
///         output position: m = spring.q;
///     }
/// }
///
/// let model = Swing::<f64>::new(SwingParameters { stiffness: 80.0 })?;
/// assert_eq!(model.initial_state().as_slice(), [0.0, 0.1]);
/// # Ok::<(), mbg_runtime::ParameterError>(())
/// ```
#[cfg(feature = "macros")]
#[macro_export]
macro_rules! mbg {
    ($($written:tt)*) => {
        $crate::__private::expand! { $crate $($written)* }
    };
}
