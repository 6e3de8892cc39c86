//! Linear theory of a rotor in steady rotation: flap, lag and feather of a blade, what they are in the axes of the mast,
//! and the whirl of lag and a mast that gives way, after Coleman and Feingold, NACA Report 1351 (1958).
//!
//! Blades are thin: their inertia about z is the sum of the other two. Angles are about x, outwards along the arm, y, and
//! z, along the axis of rotation.

use std::f64::consts::TAU;

use nalgebra::{Complex, DMatrix, Matrix4};

/// Equal blades on hinges, on a hub at a driven speed, on a mast that slides in the plane of the hub.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rotor {
    pub(crate) blades: usize,
    /// Ω.
    pub(crate) speed: f64,
    /// Of the hinges from the axis.
    pub(crate) offset: f64,
    /// Of each blade.
    pub(crate) mass: f64,
    /// Of mass, from the hinges outwards.
    pub(crate) centre: f64,
    /// About the centre of mass.
    pub(crate) inertia: [f64; 3],
    /// Of the hinges.
    pub(crate) stiffness: [f64; 3],
    /// Of what slides besides the blades.
    pub(crate) mast_mass: f64,
    /// In each direction.
    pub(crate) mast_stiffness: f64,
}

impl Rotor {
    fn first_moment(&self) -> f64 {
        self.mass * self.centre
    }

    /// About the hinges.
    fn inertia_about_hinges(&self) -> [f64; 3] {
        let steiner = self.first_moment() * self.centre;
        let [x, y, z] = self.inertia;
        [x, y + steiner, z + steiner]
    }

    /// Of one blade in the axes of the hub: feather, flap and lag.
    pub(crate) fn rotating(&self) -> [f64; 3] {
        let inertia = self.inertia_about_hinges();
        let centrifugal = self.offset * self.first_moment();
        let stiffening = [
            1.0,
            1.0 + centrifugal / inertia[1],
            centrifugal / inertia[2],
        ];
        [0, 1, 2].map(|axis| {
            let spring = self.stiffness[axis] / inertia[axis];
            (self.speed * self.speed * stiffening[axis] + spring).sqrt()
        })
    }

    /// Of the mast with the blades, while they keep still in the hub.
    pub(crate) fn sliding(&self) -> f64 {
        (self.mast_stiffness / self.sliding_mass()).sqrt()
    }

    fn sliding_mass(&self) -> f64 {
        self.mast_mass + self.blades as f64 * self.mass
    }

    /// Frequencies ω of `exp(iωt)`, signed in the sense of rotation, in which the mast and the cyclic lag whirl.
    ///
    /// With z = x + iy of the mast, w = i (ζ_c + iζ_s) of the lag, S and I of a blade about its hinges:
    ///     M z̈ + k z + (N/2) S ẅ = 0,   I (ẅ − 2iΩẇ + (ω_ζ² − Ω²) w) + S z̈ = 0,
    /// so that (k − Mω²)(ω_ζ² − (ω − Ω)²) = N S² ω⁴ / 2I. It needs three blades or more. A pair of complex roots is
    /// ground resonance.
    pub(crate) fn whirl(&self) -> [Complex<f64>; 4] {
        let [_, _, inertia] = self.inertia_about_hinges();
        let [_, _, lag] = self.rotating();
        let (mass, stiffness, speed) = (self.sliding_mass(), self.mast_stiffness, self.speed);
        let coupling = self.blades as f64 * self.first_moment().powi(2) / (2.0 * inertia);
        let detuning = lag * lag - speed * speed;
        // By rising powers.
        let polynomial = [
            stiffness * detuning,
            2.0 * stiffness * speed,
            -stiffness - mass * detuning,
            -2.0 * mass * speed,
            mass - coupling,
        ];
        roots(&polynomial)
    }

    /// The collective lag of a hub that turns freely, in its own axes. `hub_inertia` is that of the hub alone.
    ///
    /// I (ψ̈ + ζ̈) + S e ψ̈ + I ω_ζ² ζ = 0 of each blade, and (J + N (I + m e² + 2 S e)) ψ̈ + N (I + S e) ζ̈ = 0.
    pub(crate) fn collective_lag_of_a_free_hub(&self, hub_inertia: f64) -> f64 {
        let [_, _, inertia] = self.inertia_about_hinges();
        let [_, _, lag] = self.rotating();
        let arm = self.first_moment() * self.offset;
        let blade = inertia + self.mass * self.offset * self.offset + 2.0 * arm;
        let blades = self.blades as f64;
        let whole = hub_inertia + blades * blade;
        lag / (1.0 - blades * (inertia + arm).powi(2) / (inertia * whole)).sqrt()
    }

    /// All eigenvalues in the axes of the mast, of three blades or more, with what they belong to.
    pub(crate) fn eigenvalues(&self) -> Vec<(String, Complex<f64>)> {
        let mut eigenvalues = Vec::new();
        let mut add = |name: String, frequency: Complex<f64>| {
            let value = Complex::new(-frequency.im, frequency.re);
            eigenvalues.push((name.clone(), value));
            eigenvalues.push((name, value.conj()));
        };
        for (word, frequency) in ["feather", "flap", "lag"].iter().zip(self.rotating()) {
            add(format!("{word}, collective"), frequency.into());
            if self.blades.is_multiple_of(2) {
                add(format!("{word}, differential"), frequency.into());
            }
            for harmonic in 1..=(self.blades - 1) / 2 {
                if *word == "lag" && harmonic == 1 {
                    continue;
                }
                let cyclic = if harmonic == 1 {
                    ""
                } else {
                    " of the second harmonic"
                };
                let turned = harmonic as f64 * self.speed;
                add(
                    format!("{word}, regressive{cyclic}"),
                    (turned - frequency).into(),
                );
                add(
                    format!("{word}, progressive{cyclic}"),
                    (turned + frequency).into(),
                );
            }
        }
        for (name, frequency) in self.named_whirl() {
            add(name.to_owned(), frequency);
        }
        eigenvalues
    }

    /// The whirls, each with the name of what it would be without coupling.
    fn named_whirl(&self) -> Vec<(&'static str, Complex<f64>)> {
        let [_, _, lag] = self.rotating();
        let mut left = self.whirl().to_vec();
        [
            ("mast, against the rotation", -self.sliding()),
            ("lag, progressive", self.speed + lag),
            ("mast, with the rotation", self.sliding()),
            ("lag, regressive", self.speed - lag),
        ]
        .map(|(name, uncoupled)| (name, left.swap_remove(nearest(&left, uncoupled.into()))))
        .to_vec()
    }
}

/// All roots of a polynomial of degree four, made exact to rounding by Newton's iteration.
fn roots(polynomial: &[f64; 5]) -> [Complex<f64>; 4] {
    let companion = Matrix4::from_fn(|row, column| match column {
        3 => -polynomial[row] / polynomial[4],
        _ => f64::from(u8::from(row == column + 1)),
    });
    let found = companion.complex_eigenvalues();
    std::array::from_fn(|place| {
        (0..3).fold(found[place], |root, _| {
            let (mut value, mut slope) = (Complex::new(0.0, 0.0), Complex::new(0.0, 0.0));
            for coefficient in polynomial.iter().rev() {
                slope = slope * root + value;
                value = value * root + *coefficient;
            }
            root - value / slope
        })
    })
}

/// The distance from zero.
pub(crate) fn modulus(number: Complex<f64>) -> f64 {
    number.re.hypot(number.im)
}

/// The place of the number that is nearest to another.
fn nearest(numbers: &[Complex<f64>], to: Complex<f64>) -> usize {
    let distance = |place: &usize| modulus(numbers[*place] - to);
    let places = 0..numbers.len();
    places
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))
        .unwrap_or_default()
}

/// Pairs of expected and found numbers, each found one taken once, in order of what is expected.
pub(crate) fn matched(
    expected: &[Complex<f64>],
    found: &[Complex<f64>],
) -> Vec<(Complex<f64>, Complex<f64>)> {
    assert_eq!(expected.len(), found.len());
    let mut left = found.to_vec();
    let pair = |of: &Complex<f64>| (*of, left.swap_remove(nearest(&left, *of)));
    expected.iter().map(pair).collect()
}

/// Coordinates of all blades at an azimuth of the first one, by their own: collective, differential if there are evenly
/// many, and cosine and sine of each harmonic. With it, how that changes with the azimuth.
fn multiblade(blades: usize, azimuth: f64) -> [DMatrix<f64>; 2] {
    let even = usize::from(blades.is_multiple_of(2));
    let count = blades as f64;
    let value = |row: usize, blade: usize, derivative: bool| {
        let angle = azimuth + TAU * blade as f64 / count;
        let sign = if blade.is_multiple_of(2) { 1.0 } else { -1.0 };
        if row <= even {
            let constant = if row == 0 { 1.0 } else { sign };
            return if derivative { 0.0 } else { constant / count };
        }
        let harmonic = (1 + (row - 1 - even) / 2) as f64;
        let (sine, cosine) = (harmonic * angle).sin_cos();
        let wave = match ((row - 1 - even) % 2, derivative) {
            (0, false) => cosine,
            (0, true) => -harmonic * sine,
            (_, false) => sine,
            (_, true) => harmonic * cosine,
        };
        2.0 / count * wave
    };
    [false, true].map(|derivative| {
        DMatrix::from_fn(blades, blades, |row, blade| value(row, blade, derivative))
    })
}

/// The matrix of ẋ = J x in coordinates that do not turn: those of all blades, for each of the families, which tell the
/// place of a state of each blade. The hub turns at `speed`.
pub(crate) fn in_axes_of_the_mast(
    jacobian: &DMatrix<f64>,
    families: &[Vec<usize>],
    azimuth: f64,
    speed: f64,
) -> DMatrix<f64> {
    let size = jacobian.nrows();
    let mut transform = DMatrix::identity(size, size);
    let mut inverse = DMatrix::identity(size, size);
    let mut slope = DMatrix::zeros(size, size);
    for family in families {
        let [value, rate] = multiblade(family.len(), azimuth);
        let back = value.clone().try_inverse().unwrap_or_else(|| value.clone());
        for (row, at) in family.iter().enumerate() {
            for (column, from) in family.iter().enumerate() {
                transform[(*at, *from)] = value[(row, column)];
                inverse[(*at, *from)] = back[(row, column)];
                slope[(*at, *from)] = speed * rate[(row, column)];
            }
        }
    }
    (transform * jacobian + slope) * inverse
}
