//! Exact arithmetic in large prime fields.
//!
//! Every expression carries its value at three fixed pseudo-random points: two of the field with 2⁶¹ − 1 elements, and one
//! of that with 2⁶¹ − 45. Two expressions that agree there are equal as functions but for a chance of about
//! (degree / 2⁶¹)³ (Schwartz 1980; Zippel 1979), so equality, zero and rank are decided by evaluation and never by rewriting.
//!
//! A number has one value in a field, wherever the point. Two fields tell all numbers apart that differ by less than their
//! product; in the first alone, which is the quicker, 2⁶¹ would be 1, and a scale of 2³⁰ that of 2⁻³¹.

use std::hash::{Hash, Hasher};

/// By how much the first prime is below 2⁶¹, a prime of Mersenne.
const FIRST: u64 = 1;
/// The same of the second: powers of 2 and 10 take all its values but zero.
const SECOND: u64 = 45;
/// The prime of the first two points.
pub const PRIME: u64 = prime::<FIRST>();

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

const fn prime<const BELOW: u64>() -> u64 {
    (1 << 61) - BELOW
}

fn sum<const BELOW: u64>(a: u64, b: u64) -> u64 {
    let sum = a + b;
    if sum >= prime::<BELOW>() {
        sum - prime::<BELOW>()
    } else {
        sum
    }
}

fn opposite<const BELOW: u64>(a: u64) -> u64 {
    if a == 0 { 0 } else { prime::<BELOW>() - a }
}

/// 2⁶¹ is `BELOW` here, so what stands above that bit is folded in: twice, unless `BELOW` is 1.
fn product<const BELOW: u64>(a: u64, b: u64) -> u64 {
    const LOW: u128 = (1 << 61) - 1;
    let product = u128::from(a) * u128::from(b);
    if BELOW == 1 {
        return sum::<BELOW>((product & LOW) as u64, (product >> 61) as u64);
    }
    let folded = (product & LOW) + (product >> 61) * u128::from(BELOW);
    let rest = (folded >> 61) as u64 * BELOW;
    sum::<BELOW>((folded & LOW) as u64, rest)
}

fn raised<const BELOW: u64>(mut base: u64, mut exponent: u64) -> u64 {
    let mut result = 1;
    while exponent > 0 {
        if exponent & 1 == 1 {
            result = product::<BELOW>(result, base);
        }
        base = product::<BELOW>(base, base);
        exponent >>= 1;
    }
    result
}

/// Extended Euclid, since it runs unoptimised inside the compiler.
fn inverse<const BELOW: u64>(a: u64) -> Option<u64> {
    let prime = prime::<BELOW>() as i64;
    let (mut r0, mut r1) = (prime, a as i64);
    let (mut t0, mut t1) = (0i64, 1i64);
    while r1 != 0 {
        let quotient = r0 / r1;
        (r0, r1) = (r1, r0 - quotient * r1);
        (t0, t1) = (t1, t0 - quotient * t1);
    }
    (r0 == 1).then(|| t0.rem_euclid(prime) as u64)
}

/// `digits · 10^exponent`.
fn decimal<const BELOW: u64>(digits: &str, exponent: i64) -> u64 {
    let append =
        |value, digit: u8| sum::<BELOW>(product::<BELOW>(value, 10), u64::from(digit - b'0'));
    let mantissa = digits.bytes().fold(0, append);
    let scale = raised::<BELOW>(10, exponent.unsigned_abs());
    let scale = if exponent < 0 {
        inverse::<BELOW>(scale).unwrap_or(0)
    } else {
        scale
    };
    product::<BELOW>(mantissa, scale)
}

/// Negative, in the field of the first two points.
#[must_use]
pub fn negate(a: u64) -> u64 {
    opposite::<FIRST>(a)
}

/// Difference, in the field of the first two points.
#[must_use]
pub fn subtract(a: u64, b: u64) -> u64 {
    sum::<FIRST>(a, negate(b))
}

/// Product, in the field of the first two points.
#[must_use]
pub fn multiply(a: u64, b: u64) -> u64 {
    product::<FIRST>(a, b)
}

/// Inverse in the field of the first two points; none of zero.
#[must_use]
pub fn invert(a: u64) -> Option<u64> {
    inverse::<FIRST>(a)
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
    let largest = largest as i64;
    let (mut r0, mut r1) = (PRIME as i64, element as i64);
    let (mut t0, mut t1) = (0i64, 1i64);
    while r1 > largest {
        let quotient = r0 / r1;
        (r0, r1) = (r1, r0 - quotient * r1);
        (t0, t1) = (t1, t0 - quotient * t1);
    }
    (t1.abs() <= largest).then(|| (r1 * t1.signum(), t1.abs()))
}

/// A fixed pseudo-random element that depends on the words given (splitmix64).
#[must_use]
pub fn scatter(words: &[u64]) -> u64 {
    let mut state = 0x9e37_79b9_7f4a_7c15u64;
    for word in words {
        state = mix(state ^ mix(word.wrapping_add(0x632b_e59b_d9b4_e019)));
    }
    state % prime::<SECOND>()
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

    /// A number, by its values in both fields.
    fn number(first: u64, second: u64) -> Self {
        Self([first, first, second])
    }

    /// An integer.
    #[must_use]
    pub fn integer(value: i64) -> Self {
        let size = value.unsigned_abs();
        let image = Self::number(size % prime::<FIRST>(), size % prime::<SECOND>());
        if value < 0 { image.negated() } else { image }
    }

    /// `digits · 10^exponent`.
    #[must_use]
    pub fn decimal(digits: &str, exponent: i64) -> Self {
        let first = decimal::<FIRST>(digits, exponent);
        Self::number(first, decimal::<SECOND>(digits, exponent))
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

    fn zip(self, other: Self, first: fn(u64, u64) -> u64, second: fn(u64, u64) -> u64) -> Self {
        let ([a, b, c], [d, e, f]) = (self.0, other.0);
        Self([first(a, d), first(b, e), second(c, f)])
    }

    /// Sum.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        self.zip(other, sum::<FIRST>, sum::<SECOND>)
    }

    /// Difference.
    #[must_use]
    pub fn minus(self, other: Self) -> Self {
        self.plus(other.negated())
    }

    /// Product.
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        self.zip(other, product::<FIRST>, product::<SECOND>)
    }

    /// Negative.
    #[must_use]
    pub fn negated(self) -> Self {
        let [a, b, c] = self.0;
        Self([
            opposite::<FIRST>(a),
            opposite::<FIRST>(b),
            opposite::<SECOND>(c),
        ])
    }

    /// One of it and its negative, the same for both, and whether that is the negative.
    #[must_use]
    pub fn unsigned(self) -> (Self, bool) {
        let [a, b, c] = self.0;
        // Of an element and its negative, which add up to an odd prime, one is above its half.
        let is_negative = match (a, b) {
            (0, 0) => c > prime::<SECOND>() / 2,
            (0, _) => b > prime::<FIRST>() / 2,
            _ => a > prime::<FIRST>() / 2,
        };
        if is_negative {
            (self.negated(), true)
        } else {
            (self, false)
        }
    }

    /// Inverse; none where it is zero at a point.
    #[must_use]
    pub fn inverted(self) -> Option<Self> {
        let [a, b, c] = self.0;
        Some(Self([
            inverse::<FIRST>(a)?,
            inverse::<FIRST>(b)?,
            inverse::<SECOND>(c)?,
        ]))
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
    fn numbers_are_told_apart_by_both_fields() {
        let power = |exponent: i64| {
            let two = Image::integer(2);
            let power = (0..exponent.abs()).fold(Image::ONE, |power, _| power.times(two));
            if exponent < 0 {
                power.inverted().unwrap()
            } else {
                power
            }
        };
        let images: Vec<Image> = (-200..200).map(power).collect();
        for (place, image) in images.iter().enumerate() {
            assert!(!images[..place].contains(image), "2^{}", place as i64 - 200);
        }
        // All but the last are equal in the first field, and that in the second.
        let equal_in_one = [
            ("9223372036854775807", 3),
            ("2305843009213693951", 0),
            ("2305843009213693952", 45),
        ];
        for (number, other) in equal_in_one {
            assert_ne!(Image::decimal(number, 0), Image::integer(other));
        }
        let [large, small] = [Image::integer(i64::MAX), Image::integer(-3)];
        assert_eq!(
            large.times(small),
            Image::decimal("27670116110564327421", 0).negated()
        );
    }

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
