//! All bits of a motion in one number.

use crate::print;

/// All bits of all states in one number (Fowler, Noll and Vo's hash 1a).
pub(crate) struct Digest(u64);

impl Digest {
    pub(crate) const fn new() -> Self {
        Self(0xCBF2_9CE4_8422_2325)
    }

    pub(crate) fn add(&mut self, number: f64) {
        for byte in number.to_bits().to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x100_0000_01B3);
        }
    }

    pub(crate) fn print(&self) {
        print::text("digest of all states ");
        print::bits(self.0);
        print::line("");
    }
}
