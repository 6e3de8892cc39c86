//! Exact arithmetic in a large prime field.
//!
//! Every expression carries its value at three fixed pseudo-random points of the field with 2⁶¹ − 1 elements.
//! Two expressions that agree there are equal as functions but for a chance of about (degree / 2⁶¹)³
//! (Schwartz 1980; Zippel 1979), so equality, zero and rank are decided by evaluation and never by rewriting.

use std::hash::{Hash, Hasher};

/// The prime 2⁶¹ − 1.
pub const PRIME: u64 = (1 << 61) - 1;

/// How many points.
pub const POINTS: usize = 3;

/// The values of one expression at the points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Image(pub [u64; POINTS]);

/// By the first point alone, which is as random as all.
impl Hash for Image {
    fn hash<H: Hasher>(&self, state: &mut H) {
        state.write_u64(self.0[0]);
    }
}

/// Sum modulo the prime.
#[must_use]
pub fn add(a: u64, b: u64) -> u64 {
    let sum = a + b;
    if sum >= PRIME { sum - PRIME } else { sum }
}

/// Negative modulo the prime.
#[must_use]
pub fn negate(a: u64) -> u64 {
    if a == 0 { 0 } else { PRIME - a }
}

/// Difference modulo the prime.
#[must_use]
pub fn subtract(a: u64, b: u64) -> u64 {
    add(a, negate(b))
}

/// Product modulo the prime.
#[must_use]
pub fn multiply(a: u64, b: u64) -> u64 {
    let product = u128::from(a) * u128::from(b);
    let low = (product & u128::from(PRIME)) as u64;
    let high = (product >> 61) as u64;
    add(low, high)
}

/// Power with a non-negative exponent.
#[must_use]
pub fn power(mut base: u64, mut exponent: u64) -> u64 {
    let mut result = 1;
    while exponent > 0 {
        if exponent & 1 == 1 {
            result = multiply(result, base);
        }
        base = multiply(base, base);
        exponent >>= 1;
    }
    result
}

/// Inverse; none of zero. Extended Euclid, since it runs unoptimised inside the compiler.
#[must_use]
pub fn invert(a: u64) -> Option<u64> {
    let (mut r0, mut r1) = (i128::from(PRIME), i128::from(a));
    let (mut t0, mut t1) = (0i128, 1i128);
    while r1 != 0 {
        let quotient = r0 / r1;
        (r0, r1) = (r1, r0 - quotient * r1);
        (t0, t1) = (t1, t0 - quotient * t1);
    }
    (r0 == 1).then(|| t0.rem_euclid(i128::from(PRIME)) as u64)
}

/// Reciprocals of several that are not zero, by one inversion (Montgomery 1987).
#[must_use]
pub fn reciprocals(elements: &[u64]) -> Vec<u64> {
    let mut products = vec![1];
    for element in elements {
        products.push(multiply(products[products.len() - 1], *element));
    }
    let mut reciprocal = products.pop().and_then(invert).unwrap_or(0);
    let mut reciprocals = Vec::with_capacity(elements.len());
    for (element, before) in elements.iter().zip(products).rev() {
        reciprocals.push(multiply(reciprocal, before));
        reciprocal = multiply(reciprocal, *element);
    }
    reciprocals.reverse();
    reciprocals
}

/// The fraction that an element stands for, if numerator and denominator are at most `largest` (Wang 1981).
#[must_use]
pub fn fraction(element: u64, largest: u64) -> Option<(i64, i64)> {
    let largest = i128::from(largest);
    let (mut r0, mut r1) = (i128::from(PRIME), i128::from(element));
    let (mut t0, mut t1) = (0i128, 1i128);
    while r1 > largest {
        let quotient = r0 / r1;
        (r0, r1) = (r1, r0 - quotient * r1);
        (t0, t1) = (t1, t0 - quotient * t1);
    }
    (t1.abs() <= largest).then(|| ((r1 * t1.signum()) as i64, t1.abs() as i64))
}

/// A fixed pseudo-random element that depends on the words given (splitmix64).
#[must_use]
pub fn scatter(words: &[u64]) -> u64 {
    let mut state = 0x9e37_79b9_7f4a_7c15u64;
    for word in words {
        state = mix(state ^ mix(word.wrapping_add(0x632b_e59b_d9b4_e019)));
    }
    state % PRIME
}

fn mix(word: u64) -> u64 {
    let mut z = word.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl Image {
    /// Zero everywhere.
    pub const ZERO: Self = Self([0; POINTS]);
    /// One everywhere.
    pub const ONE: Self = Self([1; POINTS]);

    /// An integer.
    #[must_use]
    pub fn integer(value: i64) -> Self {
        let magnitude = value.unsigned_abs() % PRIME;
        Self(
            [if value < 0 {
                negate(magnitude)
            } else {
                magnitude
            }; POINTS],
        )
    }

    /// `digits · 10^exponent`.
    #[must_use]
    pub fn decimal(digits: &str, exponent: i64) -> Self {
        let mantissa = digits.bytes().fold(0, |value, digit| {
            add(multiply(value, 10), u64::from(digit - b'0'))
        });
        let scale = power(10, exponent.unsigned_abs());
        let scale = if exponent < 0 {
            invert(scale).unwrap_or(0)
        } else {
            scale
        };
        Self([multiply(mantissa, scale); POINTS])
    }

    /// An independent unknown that depends on the words given.
    #[must_use]
    pub fn unknown(words: &[u64]) -> Self {
        let mut keyed = words.to_vec();
        keyed.push(0);
        Self::at_points(|point| {
            *keyed.last_mut().expect("pushed above") = point as u64;
            scatter(&keyed)
        })
    }

    /// The independent unknown `function(arguments)`.
    #[must_use]
    pub fn opaque(function: u64, arguments: &[Image]) -> Self {
        Self::at_points(|point| {
            let mut words = vec![function, point as u64];
            words.extend(arguments.iter().flat_map(|argument| argument.0));
            scatter(&words)
        })
    }

    fn at_points(mut value: impl FnMut(usize) -> u64) -> Self {
        // Written out, since it runs unoptimised inside the compiler.
        Self([value(0), value(1), value(2)])
    }

    fn zip(self, other: Self, operation: impl Fn(u64, u64) -> u64) -> Self {
        Self::at_points(|point| operation(self.0[point], other.0[point]))
    }

    /// Sum.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        self.zip(other, add)
    }

    /// Difference.
    #[must_use]
    pub fn minus(self, other: Self) -> Self {
        self.zip(other, subtract)
    }

    /// Product.
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        self.zip(other, multiply)
    }

    /// Negative.
    #[must_use]
    pub fn negated(self) -> Self {
        Self::at_points(|point| negate(self.0[point]))
    }

    /// Inverse; none where it is zero at a point.
    #[must_use]
    pub fn inverted(self) -> Option<Self> {
        let mut image = [0; POINTS];
        for (slot, value) in image.iter_mut().zip(self.0) {
            *slot = invert(value)?;
        }
        Some(Self(image))
    }

    /// Cosine and sine of a base angle: a random point of the circle, by its rational parametrisation.
    #[must_use]
    pub fn circle(angle: Image) -> (Self, Self) {
        let t = Self::opaque(0xc1_2c1e, &[angle]);
        let square = t.times(t);
        let scale = Self::ONE.plus(square).inverted().unwrap_or(Self::ZERO);
        (Self::ONE.minus(square).times(scale), t.plus(t).times(scale))
    }

    /// A random point of the unit sphere in four dimensions that depends on the word given, by its rational
    /// parametrisation: a quaternion of length one.
    #[must_use]
    pub fn sphere(word: u64) -> [Self; 4] {
        let [a, b, c] = [0, 1, 2].map(|axis| Self::unknown(&[0x5_b4e2, word, axis]));
        let squares = a.times(a).plus(b.times(b)).plus(c.times(c));
        let scale = Self::ONE.plus(squares).inverted().unwrap_or(Self::ZERO);
        let double = |part: Self| part.plus(part).times(scale);
        [
            Self::ONE.minus(squares).times(scale),
            double(a),
            double(b),
            double(c),
        ]
    }

    /// A random rotation matrix that depends on the word given, by rows: that of a random quaternion.
    #[must_use]
    pub fn rotation(word: u64) -> [Self; 9] {
        let q = Self::sphere(word);
        let product = |a: usize, b: usize| {
            let product = q[a].times(q[b]);
            product.plus(product)
        };
        let diagonal = |a, b| Self::ONE.minus(product(a, a)).minus(product(b, b));
        [
            diagonal(2, 3),
            product(1, 2).minus(product(0, 3)),
            product(1, 3).plus(product(0, 2)),
            product(1, 2).plus(product(0, 3)),
            diagonal(1, 3),
            product(2, 3).minus(product(0, 1)),
            product(1, 3).minus(product(0, 2)),
            product(2, 3).plus(product(0, 1)),
            diagonal(1, 2),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_and_decimal_are_exact() {
        let third = invert(3).unwrap();
        assert_eq!(multiply(third, 3), 1);
        assert_eq!(invert(0), None);
        let tenth = Image::decimal("1", -1);
        assert_eq!(tenth.times(Image::integer(10)), Image::ONE);
        assert_eq!(multiply(PRIME - 1, PRIME - 1), 1);
    }

    #[test]
    fn reciprocals_are_inverses_and_fractions_are_found_again() {
        let elements = [2, 3, PRIME - 7, 1 << 40];
        for (element, reciprocal) in elements.iter().zip(reciprocals(&elements)) {
            assert_eq!(multiply(*element, reciprocal), 1);
        }
        let [third, tenth] = [3, 10].map(|it| invert(it).unwrap());
        assert_eq!(fraction(multiply(334, third), 1000), Some((334, 3)));
        assert_eq!(fraction(negate(tenth), 1000), Some((-1, 10)));
        assert_eq!(fraction(scatter(&[1]), 1000), None);
    }

    #[test]
    fn circle_points_are_on_the_circle() {
        let (cosine, sine) = Image::circle(Image::unknown(&[7]));
        assert_eq!(cosine.times(cosine).plus(sine.times(sine)), Image::ONE);
    }

    #[test]
    fn quaternions_have_length_one_and_rotations_orthonormal_rows() {
        let dot = |a: &[Image], b: &[Image]| {
            let products = a.iter().zip(b).map(|(a, b)| a.times(*b));
            products.fold(Image::ZERO, Image::plus)
        };
        let sphere = Image::sphere(3);
        assert_eq!(dot(&sphere, &sphere), Image::ONE);
        let rotation = Image::rotation(3);
        for a in 0..3 {
            for b in 0..3 {
                let expected = if a == b { Image::ONE } else { Image::ZERO };
                let [a, b] = [a, b].map(|row| &rotation[3 * row..3 * row + 3]);
                assert_eq!(dot(a, b), expected);
            }
        }
    }
}
