//! Stage 1, syntax: tokens to a tree.
pub mod ast;
