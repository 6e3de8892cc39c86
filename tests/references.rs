//! The references that other tests compare with, checked against each other and against published numbers.

#[path = "references/mod.rs"]
mod references;
