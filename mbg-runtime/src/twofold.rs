//! Errors of functions against sums of two `f64`, in tests.

/// A number as the sum of two, the second below half a unit of the last place of the first.
#[derive(Clone, Copy)]
pub(crate) struct Twofold(pub(crate) f64, pub(crate) f64);

impl Twofold {
    /// Exact (Knuth).
    pub(crate) fn sum(a: f64, b: f64) -> Self {
        let sum = a + b;
        let second = sum - a;
        Self(sum, (a - (sum - second)) + (b - second))
    }

    /// Exact (Dekker).
    pub(crate) fn product(a: f64, b: f64) -> Self {
        let halves = |x: f64| {
            let scaled = x * 134_217_729.0;
            let upper = scaled - (scaled - x);
            (upper, x - upper)
        };
        let product = a * b;
        let ((a, c), (b, d)) = (halves(a), halves(b));
        Self(product, ((a * b - product) + a * d + c * b) + c * d)
    }

    pub(crate) fn plus(self, other: Self) -> Self {
        let Self(sum, rest) = Self::sum(self.0, other.0);
        let Self(small, tiny) = Self::sum(self.1, other.1);
        let Self(sum, rest) = Self::sum(sum, rest + small);
        Self::sum(sum, rest + tiny)
    }

    pub(crate) fn times(self, other: Self) -> Self {
        let Self(product, rest) = Self::product(self.0, other.0);
        Self::sum(product, rest + (self.0 * other.1 + self.1 * other.0))
    }

    pub(crate) fn over(self, divisor: f64) -> Self {
        let quotient = self.0 / divisor;
        let Self(product, rest) = Self::product(quotient, divisor);
        Self::sum(quotient, ((self.0 - product) - rest + self.1) / divisor)
    }

    pub(crate) fn flipped(self, flip: bool) -> Self {
        if flip { Self(-self.0, -self.1) } else { self }
    }
}

/// Distance of a result in units of the last place of what it should be, and without.
pub(crate) fn error(found: f64, exact: Twofold, bits: i32) -> [f64; 2] {
    let distance = ((found - exact.0) - exact.1).abs();
    let exponent = (exact.0.abs().to_bits() >> 52) as i32 - 1023;
    [distance / 2.0_f64.powi(exponent - bits), distance]
}

/// Fewer points where arithmetic is slow.
const POINTS: u32 = if cfg!(debug_assertions) {
    60_000
} else {
    4_000_000
};

/// Numbers of both signs, evenly spread within a range, each at a place of its own between two multiples of the step.
pub(crate) fn spread(largest: f64) -> impl Iterator<Item = f64> {
    let mut random = crate::solve::lanes::random();
    (0..POINTS).map(move |_| random() * largest)
}

/// The number so many steps further from zero.
pub(crate) fn next(angle: f64, steps: i64) -> f64 {
    f64::from_bits(angle.to_bits().wrapping_add_signed(steps))
}
