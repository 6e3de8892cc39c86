//! Antiderivatives of powers and products of sines and cosines.

use super::antiderivative::{Integration, WAVE};
use super::expression::{Expression, Operation};
use super::substitute::visit;

/// Most factors of a product of waves; each doubles the waves of its sum.
const MOST_WAVES: usize = 6;

/// A sine or a cosine of an angle.
#[derive(Clone, Copy)]
struct Wave {
    is_sine: bool,
    angle: Expression,
    is_negative: bool,
}

impl Integration<'_> {
    /// `∫ sinⁿ = ((n − 1) ∫ sinⁿ⁻² − sinⁿ⁻¹ cos) / n`, and that of the cosine likewise.
    pub(super) fn power_of_wave(&mut self, base: Expression, exponent: i32) -> Option<Expression> {
        let (other, angle) = match *self.pool.operation(base) {
            Operation::Sine(angle) => (self.pool.cosine(angle).negated(), angle),
            Operation::Cosine(angle) => (self.pool.sine(angle), angle),
            _ => return None,
        };
        let [below, second] = [1, 2].map(|less| self.pool.power(base, exponent - less));
        let product = self.pool.multiply(below?, other);
        let scale = self.pool.integer(WAVE);
        let first = self.inner(angle, product, scale)?;
        let second = self.part(second?)?;
        let [before, all] = [exponent - 1, exponent].map(|it| self.pool.integer(it.into()));
        let second = self.pool.multiply(before, second);
        let sum = self.pool.add(first, second);
        self.pool.divide(sum, all)
    }

    /// A product of sines and cosines as half the sum of those of sums and differences of their angles.
    pub(super) fn product_of_waves(&mut self, a: Expression, b: Expression) -> Option<Expression> {
        let mut factors = Vec::new();
        for factor in [a, b] {
            self.add_waves(factor, &mut factors)?;
        }
        let (first, others) = factors
            .split_first()
            .filter(|(_, rest)| rest.len() < MOST_WAVES)?;
        let mut waves = vec![*first];
        for wave in others {
            let products = waves
                .into_iter()
                .flat_map(|known| self.multiplied(known, *wave));
            waves = products.collect();
        }
        if waves.iter().any(|wave| self.may_stand(wave.angle)) {
            return None;
        }
        let terms: Vec<Expression> = waves.iter().map(|wave| self.written(wave)).collect();
        let sum = self.pool.sum(&terms);
        let integral = self.part(sum)?;
        let parts = self.pool.integer(1 << others.len());
        self.pool.divide(integral, parts)
    }

    /// Adds the factors of a product, if all of them are waves.
    fn add_waves(&self, product: Expression, waves: &mut Vec<Wave>) -> Option<()> {
        let is_negative = product.is_negative();
        let (is_sine, angle) = match *self.pool.operation(product) {
            Operation::Sine(angle) => (true, angle),
            Operation::Cosine(angle) => (false, angle),
            Operation::Multiply(a, b) => {
                let place = waves.len();
                self.add_waves(a, waves)?;
                self.add_waves(b, waves)?;
                waves[place].is_negative ^= is_negative;
                return Some(());
            }
            _ => return None,
        };
        waves.push(Wave {
            is_sine,
            angle,
            is_negative,
        });
        Some(())
    }

    /// Whether an angle that changes may have no slope for some parameters, as a difference of them.
    fn may_stand(&mut self, angle: Expression) -> bool {
        let Some(slope) = self.slope(angle) else {
            return !self.is_free(angle);
        };
        let mut is_sum = false;
        visit(self.pool, &[slope], |_, operation| {
            is_sum |= matches!(operation, Operation::Add(..));
        });
        is_sum
    }

    /// Twice the product of two waves.
    fn multiplied(&mut self, a: Wave, b: Wave) -> [Wave; 2] {
        let sum = self.pool.add(a.angle, b.angle);
        let difference = self.pool.subtract(a.angle, b.angle);
        let is_negative = a.is_negative ^ b.is_negative;
        let is_sine = a.is_sine ^ b.is_sine;
        let wave = |angle, turns: bool| Wave {
            is_sine,
            angle,
            is_negative: is_negative ^ turns,
        };
        // 2 sin a sin b = cos(a − b) − cos(a + b), 2 cos a sin b = sin(a + b) − sin(a − b)
        match (a.is_sine, b.is_sine) {
            (true, true) => [wave(difference, false), wave(sum, true)],
            (false, true) => [wave(sum, false), wave(difference, true)],
            _ => [wave(sum, false), wave(difference, false)],
        }
    }

    fn written(&mut self, wave: &Wave) -> Expression {
        let value = if wave.is_sine {
            self.pool.sine(wave.angle)
        } else {
            self.pool.cosine(wave.angle)
        };
        value.flipped(wave.is_negative)
    }
}

#[cfg(test)]
mod tests {
    use crate::symbolic::growth::tests::assert_integrated;

    #[test]
    fn products_of_waves_are_integrated() {
        let places = [[-0.9, 0.8], [0.0, 5.0]];
        assert_integrated(&places, |pool, x, a| {
            let [twelve, tenth] = [12, 10].map(|it| pool.integer(it));
            let angle = pool.multiply(twelve, x);
            let ripple = pool.cosine(x);
            let ripple = pool.divide(ripple, tenth).expect("a quotient");
            let sum = pool.add(a, ripple);
            let wave = pool.sine(angle);
            pool.multiply(wave, sum)
        });
        assert_integrated(&places, |pool, x, a| {
            let [two, three] = [2, 3].map(|it| pool.integer(it));
            let [first, second] = [two, three].map(|slope| {
                let slope = pool.multiply(slope, a);
                let angle = pool.multiply(slope, x);
                [pool.sine(angle), pool.cosine(angle)]
            });
            let product = pool.multiply(first[0], second[1].negated());
            let product = pool.multiply(product, second[0]);
            pool.multiply(first[1], product)
        });
    }
}
