//! One stroke per multibond: the verdict.
