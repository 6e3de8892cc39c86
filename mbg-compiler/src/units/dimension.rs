//! Dimensions: products of powers of base units, and of units that are not known yet.

use crate::entries::merged;

/// A fraction in lowest terms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Ratio {
    numerator: i64,
    denominator: i64,
}

/// Exponents are held below this, so that nothing overflows; no quantity of physics comes near.
const LARGEST: i64 = 1 << 30;

/// Exponents of powers that are looked for: 1.4 has 5, 0.714 has 500.
const LARGEST_DENOMINATOR: i64 = 1000;

impl Ratio {
    /// One.
    pub(super) const ONE: Self = Self {
        numerator: 1,
        denominator: 1,
    };
    /// Minus one.
    pub(super) const MINUS: Self = Self {
        numerator: -1,
        denominator: 1,
    };
    /// A half.
    pub(super) const HALF: Self = Self {
        numerator: 1,
        denominator: 2,
    };

    /// A fraction; the denominator is not zero.
    #[must_use]
    pub(super) fn new(numerator: i64, denominator: i64) -> Self {
        // Nearly all are whole.
        if denominator == 1 {
            return Self {
                numerator: numerator.clamp(-LARGEST, LARGEST),
                denominator,
            };
        }
        let sign = denominator.signum();
        let common = common_divisor(numerator.abs(), denominator.abs()).max(1);
        let held = |number: i64| (sign * number / common).clamp(-LARGEST, LARGEST);
        Self {
            numerator: held(numerator),
            denominator: held(denominator).max(1),
        }
    }

    /// The fraction of a small denominator that a number is, if it is one.
    #[must_use]
    pub(super) fn nearest(number: f64) -> Option<Self> {
        let numerator = |denominator: i64| number * denominator as f64;
        let is_whole = |number: f64| (number - number.round()).abs() < 1e-9 && number.abs() < 1e6;
        let denominator = (1..=LARGEST_DENOMINATOR).find(|it| is_whole(numerator(*it)))?;
        Some(Self::new(
            numerator(denominator).round() as i64,
            denominator,
        ))
    }

    fn plus(self, other: Self) -> Self {
        Self::new(
            self.numerator * other.denominator + other.numerator * self.denominator,
            self.denominator * other.denominator,
        )
    }

    fn times(self, other: Self) -> Self {
        Self::new(
            self.numerator * other.numerator,
            self.denominator * other.denominator,
        )
    }

    fn is_zero(self) -> bool {
        self.numerator == 0
    }

    /// `-1/self`; self is not zero.
    fn negative_reciprocal(self) -> Self {
        Self::new(-self.denominator, self.numerator)
    }
}

fn common_divisor(mut a: i64, mut b: i64) -> i64 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

/// What a dimension is a product of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Factor {
    /// A base unit, by its place in [`BASES`].
    Base(usize),
    /// A unit that is not known yet, by number.
    Unknown(usize),
}

/// The base units.
pub(super) const BASES: [&str; 7] = ["kg", "m", "s", "A", "K", "mol", "cd"];

/// A product of powers other than zero, by factors that ascend.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Dimension(Vec<(Factor, Ratio)>);

impl Dimension {
    /// Of a pure number.
    #[must_use]
    pub(super) fn pure() -> Self {
        Self::default()
    }

    /// Of the base units with these exponents.
    #[must_use]
    pub(super) fn of(exponents: [i8; 7]) -> Self {
        let factors = exponents.into_iter().enumerate();
        let factors = factors.filter(|(_, exponent)| *exponent != 0);
        Self(
            factors
                .map(|(base, exponent)| (Factor::Base(base), Ratio::new(exponent.into(), 1)))
                .collect(),
        )
    }

    /// Of a unit that is not known yet.
    #[must_use]
    fn unknown(number: usize) -> Self {
        Self(vec![(Factor::Unknown(number), Ratio::ONE)])
    }

    /// The product with a power of another.
    #[must_use]
    pub(super) fn times_power(&self, other: &Self, exponent: Ratio) -> Self {
        let product = merged(&self.0, &other.0, |own, power| {
            let more = power.times(exponent);
            let sum = own.map_or(more, |own| own.plus(more));
            (!sum.is_zero()).then_some(sum)
        });
        Self(product)
    }

    /// The product.
    #[must_use]
    pub(super) fn times(&self, other: &Self) -> Self {
        self.times_power(other, Ratio::ONE)
    }

    /// The quotient.
    #[must_use]
    pub(super) fn over(&self, other: &Self) -> Self {
        self.times_power(other, Ratio::MINUS)
    }

    /// Whether it is that of a pure number.
    #[must_use]
    pub(super) fn is_pure(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether it has roots of base units.
    #[must_use]
    pub(super) fn has_roots(&self) -> bool {
        self.0.iter().any(|(_, exponent)| exponent.denominator != 1)
    }

    /// Whether it is a power of the kelvin, other than a pure number.
    #[must_use]
    pub(super) fn is_power_of_kelvin(&self) -> bool {
        matches!(self.0[..], [(Factor::Base(base), _)] if BASES[base] == "K")
    }

    /// Whether no unknown unit is in it.
    #[must_use]
    pub(super) fn is_known(&self) -> bool {
        self.last_unknown().is_none()
    }

    fn last_unknown(&self) -> Option<(usize, Ratio)> {
        match self.0.last() {
            Some((Factor::Unknown(number), exponent)) => Some((*number, *exponent)),
            _ => None,
        }
    }

    /// Powers of base units in their order, unknown units left out.
    #[must_use]
    pub(super) fn text(&self) -> String {
        let known = self.0.iter().filter_map(|(factor, exponent)| match factor {
            Factor::Base(base) => Some((BASES[*base], *exponent)),
            Factor::Unknown(_) => None,
        });
        let (above, below): (Vec<_>, Vec<_>) = known.partition(|(_, power)| power.numerator > 0);
        let power = |(base, exponent): &(&str, Ratio)| {
            let size = exponent.numerator.abs();
            match (size, exponent.denominator) {
                (1, 1) => (*base).to_owned(),
                (_, 1) => format!("{base}^{size}"),
                (_, denominator) => format!("{base}^({size}/{denominator})"),
            }
        };
        let above: Vec<String> = above.iter().map(power).collect();
        let below: Vec<String> = below.iter().map(power).collect();
        let above = if above.is_empty() {
            "1".to_owned()
        } else {
            above.join("*")
        };
        match below[..] {
            [] => above,
            [ref only] => format!("{above}/{only}"),
            _ => format!("{above}/({})", below.join("*")),
        }
    }
}

/// What is known of unknown units: a linear system in exponents, solved as it grows.
#[derive(Default)]
pub(super) struct Unknowns(Vec<Option<Dimension>>);

impl Unknowns {
    /// One more.
    pub(super) fn fresh(&mut self) -> Dimension {
        self.0.push(None);
        Dimension::unknown(self.0.len() - 1)
    }

    /// A dimension without the unknowns that are solved for.
    pub(super) fn reduce(&mut self, dimension: &Dimension) -> Dimension {
        let mut reduced = dimension.clone();
        loop {
            let solved = |(factor, _): &(Factor, Ratio)| match factor {
                Factor::Unknown(number) => self.0[*number].is_some(),
                Factor::Base(_) => false,
            };
            let Some(place) = reduced.0.iter().position(solved) else {
                return reduced;
            };
            let (factor, exponent) = reduced.0.remove(place);
            if let Factor::Unknown(number) = factor {
                reduced = reduced.times_power(&self.shortened(number), exponent);
            }
        }
    }

    /// The value of a solved unknown; where it is another unknown that is solved itself, the way is kept short.
    fn shortened(&mut self, number: usize) -> Dimension {
        let mut value = self.0[number].clone().unwrap_or_default();
        while let [(Factor::Unknown(next), Ratio::ONE)] = value.0[..]
            && let Some(further) = self.0[next].clone()
        {
            value = further;
        }
        self.0[number] = Some(value.clone());
        value
    }

    /// Makes two dimensions equal; false if they cannot be.
    pub(super) fn equate(&mut self, left: &Dimension, right: &Dimension) -> bool {
        let quotient = self.reduce(&left.over(right));
        let Some((number, exponent)) = quotient.last_unknown() else {
            return quotient.is_pure();
        };
        let mut rest = quotient;
        // The last factor is that unknown.
        rest.0.pop();
        let value = Dimension::pure().times_power(&rest, exponent.negative_reciprocal());
        self.0[number] = Some(value);
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_equations_give_two_unknowns() {
        // Effort and flow from their product, the power, and their quotient, a mass per time.
        let mut unknowns = Unknowns::default();
        let (effort, flow) = (unknowns.fresh(), unknowns.fresh());
        let watt = Dimension::of([1, 2, -3, 0, 0, 0, 0]);
        let mass_per_time = Dimension::of([1, 0, -1, 0, 0, 0, 0]);
        assert!(unknowns.equate(&effort.times(&flow), &watt));
        assert!(unknowns.equate(&effort.over(&flow), &mass_per_time));
        assert_eq!(unknowns.reduce(&effort).text(), "kg*m/s^2");
        assert_eq!(unknowns.reduce(&flow).text(), "m/s");
        assert!(!unknowns.equate(&effort, &flow));
    }

    #[test]
    fn powers_are_fractions() {
        let metre = Dimension::of([0, 1, 0, 0, 0, 0, 0]);
        let root = Dimension::pure().times_power(&metre, Ratio::HALF);
        assert_eq!(root.text(), "m^(1/2)");
        assert_eq!(root.times(&root), metre);
        assert!(root.over(&root).is_pure());
        let huge = Ratio::new(LARGEST, 1).times(Ratio::new(LARGEST, 1));
        assert_eq!(huge, Ratio::new(LARGEST, 1));
    }
}
