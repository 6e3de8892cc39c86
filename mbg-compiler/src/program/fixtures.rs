//! Operands and directions for tests.

use super::{Column, Direction, Operand, Source};
use crate::symbolic::Symbol;

pub(super) fn value(number: usize) -> Operand {
    Operand::plain(Source::Value(number))
}

pub(super) fn state(number: usize) -> Operand {
    Operand::plain(Source::Symbol(Symbol::State(number)))
}

pub(super) fn slope(variable: usize) -> Operand {
    Operand::plain(Source::Symbol(Symbol::Slope(variable)))
}

/// That of one variable, which one row depends on.
pub(super) fn direction(variable: usize) -> Direction {
    vec![Column {
        variable,
        rows: vec![0],
    }]
}

pub(super) fn negative(operand: Operand) -> Operand {
    Operand {
        negative: true,
        ..operand
    }
}
