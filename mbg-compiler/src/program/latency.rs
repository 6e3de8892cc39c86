//! Cycles until a result can be used, on the processors of today about the same everywhere.

use super::{Operand, Source, Step};

/// Of a sum, a product, or both fused.
pub(super) const SUM: u32 = 4;

/// Of a step, once its operands are there.
pub(super) fn of(step: &Step) -> u32 {
    match step {
        Step::Add(..) | Step::Multiply(..) | Step::MultiplyAdd(..) => SUM,
        Step::Divide(..) => 14,
        Step::SineCosine(_) | Step::Sine(_) | Step::Cosine(_) | Step::Call(..) => 40,
        Step::Solve(_) => 0,
    }
}

/// When the last of some operands is ready, of values that are ready at these times.
pub(super) fn latest(ready: &[u32], operands: &[Operand]) -> u32 {
    let mut latest = 0;
    for operand in operands {
        if let Source::Value(value) = operand.source {
            latest = latest.max(ready[value]);
        }
    }
    latest
}
