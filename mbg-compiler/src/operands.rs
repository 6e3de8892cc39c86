//! What one operation is computed from.

use std::borrow::Cow;
use std::ops::Deref;

/// Operands, read as a slice. Every walk asks for them at every node, so few of them take no memory of their own.
pub enum Operands<'a, T: Clone> {
    /// None.
    Zero,
    /// One.
    One([T; 1]),
    /// Two.
    Two([T; 2]),
    /// Three.
    Three([T; 3]),
    /// Any number.
    Many(Cow<'a, [T]>),
}

impl<T: Clone> Deref for Operands<'_, T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        match self {
            Self::Zero => &[],
            Self::One(operands) => operands,
            Self::Two(operands) => operands,
            Self::Three(operands) => operands,
            Self::Many(operands) => operands,
        }
    }
}
