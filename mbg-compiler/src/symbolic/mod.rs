//! Symbolic expressions: a pool in which equal functions are one node, and matrices over it.
//!
//! This is the ground on which the stages from elaboration to the program stand. Nothing in it knows of bond graphs.

pub mod affine;
pub mod antiderivative;
mod arithmetic;
mod chain_rule;
pub(crate) mod choices;
pub mod dense;
pub mod dependence;
pub mod differentiate;
pub mod evaluate;
pub mod expression;
mod factors;
pub mod field;
mod growth;
pub mod identity;
pub mod implicit;
pub mod linear;
pub mod matrix;
pub mod orientation;
pub mod pool;
pub mod print;
mod products;
pub(crate) mod quadrature;
mod rest;
pub mod rounded;
mod share;
pub mod substitute;
mod transpose;
mod uses;
pub(crate) mod vanishing;
mod walk;
mod waves;

pub use affine::{affine, linear_part};
pub use antiderivative::antiderivative;
pub use arithmetic::LARGEST_POWER;
pub use dense::dense;
pub use dependence::Dependence;
pub use differentiate::{Differentiator, jacobian};
pub use evaluate::Evaluation;
pub use expression::{Expression, Function, Operation, Rate, Symbol};
pub use implicit::{Implicit, Kind, Method, Place};
pub use linear::{Elimination, Linear, Rest, RestSolver, Step};
pub use matrix::{Factor, Matrix, Product};
pub use pool::Pool;
pub use products::products;
pub use share::share;
pub use substitute::Substitution;
pub use transpose::transposed;
