//! Operands for tests.

use super::{Operand, Source};
use crate::symbolic::Symbol;

pub(super) fn value(number: usize) -> Operand {
    Operand::plain(Source::Value(number))
}

pub(super) fn state(number: usize) -> Operand {
    Operand::plain(Source::Symbol(Symbol::State(number)))
}

pub(super) fn negative(operand: Operand) -> Operand {
    Operand {
        negative: true,
        ..operand
    }
}
