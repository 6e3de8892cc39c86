//! Operands and directions for tests.

use super::{Coverage, Line, Mode, Operand, Source};
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

/// So many directions of one variable each, on which one rate depends.
pub(super) fn coverage(directions: usize) -> Coverage {
    let direction = |number| {
        vec![Line {
            number,
            entries: vec![0],
        }]
    };
    Coverage {
        size: [1, directions],
        mode: Mode::Forward,
        directions: (0..directions).map(direction).collect(),
        units: Vec::new(),
    }
}

pub(super) fn negative(operand: Operand) -> Operand {
    Operand {
        negative: true,
        ..operand
    }
}
