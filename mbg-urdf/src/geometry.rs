//! Vectors and rotations in space, and rigid bodies that are put together.

/// Three components.
pub(crate) type Vector = [f64; 3];
/// By rows.
pub(crate) type Matrix = [[f64; 3]; 3];

/// No rotation.
pub(crate) const IDENTITY: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Angles this near to a multiple of a right angle are meant to be one, in rad: files give eleven digits of π/2.
pub(crate) const RIGHT: f64 = 1e-9;

/// What is this small in a rotation is what rounding leaves of zero.
const ROUNDED: f64 = 1e-15;

/// A matrix times a matrix. Adding a zero makes no zero negative.
pub(crate) fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let entry = |i: usize, j: usize| (0..3).map(|k| a[i][k] * b[k][j]).sum::<f64>() + 0.0;
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)))
}

/// A matrix times a column.
pub(crate) fn applied(a: &Matrix, v: &Vector) -> Vector {
    a.map(|row| (0..3).map(|k| row[k] * v[k]).sum::<f64>() + 0.0)
}

pub(crate) fn transposed(a: &Matrix) -> Matrix {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| a[j][i]))
}

pub(crate) fn plus(a: &Vector, b: &Vector) -> Vector {
    [0, 1, 2].map(|i| a[i] + b[i])
}

/// Sine and cosine, exact where the angle is this near to a multiple of a right angle.
fn sin_cos(angle: f64, near: f64) -> (f64, f64) {
    let quarters = (angle / std::f64::consts::FRAC_PI_2).round();
    if (angle - quarters * std::f64::consts::FRAC_PI_2).abs() > near {
        return angle.sin_cos();
    }
    match quarters.rem_euclid(4.0) {
        0.0 => (0.0, 1.0),
        1.0 => (1.0, 0.0),
        2.0 => (0.0, -1.0),
        _ => (-1.0, 0.0),
    }
}

/// The rotation by roll, pitch and yaw about fixed axes: `R_z(yaw) R_y(pitch) R_x(roll)`. Right angles are those of files.
pub(crate) fn rotation(angles: Vector) -> Matrix {
    turns(angles, RIGHT)
}

/// Roll, pitch and yaw of a quaternion `[x, y, z, w]` of any length.
pub(crate) fn angles([x, y, z, w]: [f64; 4]) -> Vector {
    let sine = 2.0 * (w * y - x * z);
    let (along, beside) = (w * w + x * x - y * y - z * z, 2.0 * (x * y + w * z));
    let cosine = along.hypot(beside);
    // Upright, roll and yaw are about one line.
    let yaw = if cosine <= RIGHT * sine.abs() {
        0.0
    } else {
        beside.atan2(along)
    };
    // From what is left without the yaw, so that both fit where they are hard to tell apart.
    let (sine_half, cosine_half) = (0.5 * yaw).sin_cos();
    let roll = (cosine_half * x + sine_half * y).atan2(cosine_half * w + sine_half * z);
    [2.0 * roll, sine.atan2(cosine), yaw]
}

fn turns(angles: Vector, near: f64) -> Matrix {
    let [(a, b), (c, d), (e, f)] = angles.map(|it| sin_cos(it, near));
    let about_x = [[1.0, 0.0, 0.0], [0.0, b, -a], [0.0, a, b]];
    let about_y = [[d, 0.0, c], [0.0, 1.0, 0.0], [-c, 0.0, d]];
    let about_z = [[f, -e, 0.0], [e, f, 0.0], [0.0, 0.0, 1.0]];
    product(&product(&about_z, &about_y), &about_x)
}

/// The rotation about a coordinate axis, by number.
pub(crate) fn about(axis: usize, angle: f64) -> Matrix {
    let mut angles = [0.0; 3];
    angles[axis] = angle;
    turns(angles, ROUNDED)
}

/// A coordinate axis that is across both of these.
pub(crate) fn across(a: usize, b: usize) -> usize {
    if a == b { (a + 1) % 3 } else { 3 - a - b }
}

/// Whether the matrix takes every coordinate axis to one, or to the opposite of one.
pub(crate) fn is_permutation(turn: &Matrix) -> bool {
    turn.iter()
        .flatten()
        .all(|it| [0.0, 1.0].contains(&it.abs()))
}

/// Whether two rotations differ by rounding alone.
pub(crate) fn is_near(a: &Matrix, b: &Matrix) -> bool {
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    pairs.map(|(a, b)| (a - b).abs()).all(|off| off <= ROUNDED)
}

/// The angles of a rotation about `first`, the axis [`across`] and `last`, in a row. Where it takes `last` to `first` or
/// to its opposite the first angle is zero.
pub(crate) fn between(turn: &Matrix, first: usize, last: usize) -> [f64; 3] {
    let middle = across(first, last);
    // Turned back by the first angle, what `last` is taken to has no component along the middle axis.
    let [along, beside] = [middle, across(first, middle)].map(|it| turn[it][last]);
    let right_handed = middle == (first + 1) % 3;
    let tangent = if right_handed { -along } else { along };
    let angle = if along.abs() <= ROUNDED {
        0.0
    } else {
        tangent.atan2(beside.abs()) * 1.0_f64.copysign(beside)
    };
    let rest = product(&about(first, -angle), turn);
    let tilt = angle_about(middle, &rest, last);
    let rest = product(&about(middle, -tilt), &rest);
    [angle, tilt, angle_about(last, &rest, (last + 1) % 3)]
}

/// The angle about `axis` by which a rotation takes the axis `from` across it to where the matrix does.
fn angle_about(axis: usize, turn: &Matrix, from: usize) -> f64 {
    let next = [1, 2, 0][from];
    if next == axis {
        let before = [2, 0, 1][from];
        (-turn[before][from]).atan2(turn[from][from])
    } else {
        turn[next][from].atan2(turn[from][from])
    }
}

/// The direction of a vector that is not zero, whose squares may have no place in a number.
fn unit(vector: &Vector) -> Vector {
    let largest = vector
        .iter()
        .fold(0.0, |largest: f64, it| largest.max(it.abs()));
    // By a power of two, which rounds nothing.
    let scale = largest.log2().floor().clamp(-1000.0, 1000.0).exp2();
    let scaled = vector.map(|it| it / scale);
    let length = scaled.iter().map(|it| it * it).sum::<f64>().sqrt();
    scaled.map(|it| it / length)
}

/// A coordinate axis, and a rotation that takes it to the direction of `axis`.
///
/// None where the direction is a coordinate axis itself, half a turn where it is the opposite of one.
pub(crate) fn aligned(axis: &Vector) -> (usize, Matrix) {
    let unit = unit(axis);
    for along in 0..3 {
        let across = [(along + 1) % 3, (along + 2) % 3];
        if across.iter().any(|it| unit[*it].abs() > RIGHT) {
            continue;
        }
        let mut turn = IDENTITY;
        if unit[along] < 0.0 {
            turn[along][along] = -1.0;
            turn[across[1]][across[1]] = -1.0;
        }
        return (along, turn);
    }
    if unit[2] >= 0.0 {
        return (2, tilted(unit));
    }
    let half = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]];
    (2, product(&tilted(unit.map(|it| -it)), &half))
}

/// The shortest rotation that takes z to a unit vector, at most a right angle away so that no digits are lost:
/// `R = 1 + [w] + [w]² / (1 + cos)`, with `w` the vector product of both.
fn tilted([x, y, z]: Vector) -> Matrix {
    let scale = 1.0 / (1.0 + z);
    [
        [1.0 - scale * x * x, -scale * x * y, x],
        [-scale * x * y, 1.0 - scale * y * y, y],
        [-x, -y, z],
    ]
}

/// No length below this is meant, in m: some files write -2.7e-51.
pub(crate) const LENGTH: f64 = 1e-12;

/// A place without what no length can be.
pub(crate) fn measured(place: &Vector) -> Vector {
    place.map(|it| if it.abs() < LENGTH { 0.0 } else { it })
}

/// Where a frame stands in another one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pose {
    pub(crate) place: Vector,
    /// Takes axes of the frame to those of the other.
    pub(crate) turn: Matrix,
}

impl Pose {
    pub(crate) const NONE: Self = Self {
        place: [0.0; 3],
        turn: IDENTITY,
    };

    /// Turned about an axis.
    pub(crate) fn turned(axis: &Vector, angle: f64) -> Self {
        let (along, tilt) = aligned(axis);
        let turn = product(&product(&tilt, &about(along, angle)), &transposed(&tilt));
        Self { turn, ..Self::NONE }
    }

    /// Moved along an axis.
    pub(crate) fn moved(axis: &Vector, travel: f64) -> Self {
        Self {
            place: unit(axis).map(|it| it * travel),
            ..Self::NONE
        }
    }

    /// A pose in this one's frame, in the frame that this one is in.
    pub(crate) fn of(&self, inner: &Self) -> Self {
        Self {
            place: plus(&self.place, &applied(&self.turn, &inner.place)),
            turn: product(&self.turn, &inner.turn),
        }
    }
}

/// What is this small beside the largest entry of a matrix is what rounding leaves of zero.
const ROUNDING: f64 = 1e-12;

/// A symmetric matrix as a sum of `weight direction directionᵀ` with positive weights, as many as its rank. None where the
/// matrix is negative along a direction.
///
/// Cholesky's method, the largest entry of the diagonal first.
pub(crate) fn squares(matrix: &Matrix) -> Option<Vec<(f64, Vector)>> {
    let size = matrix
        .iter()
        .flatten()
        .fold(0.0_f64, |size, it| size.max(it.abs()));
    let (mut left, mut found) = (*matrix, Vec::new());
    for _ in 0..3 {
        let larger = |a: usize, b: usize| if left[b][b] > left[a][a] { b } else { a };
        let pivot = larger(larger(0, 1), 2);
        let weight = left[pivot][pivot];
        if weight <= ROUNDING * size {
            break;
        }
        let share = left[pivot].map(|it| it / weight);
        let direction = share.map(|it| if it.abs() <= ROUNDING { 0.0 } else { it });
        let rest = |i: usize, j: usize| match i == pivot || j == pivot {
            true => 0.0,
            false => left[i][j] - weight * direction[i] * direction[j],
        };
        left = [0, 1, 2].map(|i| [0, 1, 2].map(|j| rest(i, j)));
        found.push((weight, direction));
    }
    let nothing = left.iter().flatten().all(|it| it.abs() <= ROUNDING * size);
    nothing.then_some(found)
}

/// How far beside its centre a mass has an inertia that rounding may have left of zero, in m: some files write -5e-20 kg m².
const EXTENT: f64 = 1e-8;

/// An entry of the inertia of a mass, zero where no extent could be measured.
pub(crate) fn measurable(entry: f64, mass: f64) -> f64 {
    if entry.abs() <= mass * EXTENT * EXTENT {
        0.0
    } else {
        entry
    }
}

/// Mass, its centre, and the inertia about that centre, in axes of a frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Body {
    pub(crate) mass: f64,
    pub(crate) centre: Vector,
    pub(crate) inertia: Matrix,
}

impl Body {
    /// The same body in the frame in which its own has this pose.
    pub(crate) fn seen(&self, pose: &Pose) -> Self {
        if pose.turn == IDENTITY {
            let centre = plus(&pose.place, &self.centre);
            return Self { centre, ..*self };
        }
        let inertia = product(&product(&pose.turn, &self.inertia), &transposed(&pose.turn));
        Self {
            mass: self.mass,
            centre: plus(&pose.place, &applied(&pose.turn, &self.centre)),
            inertia: symmetric(&inertia),
        }
    }

    /// Both as one rigid body: by Steiner's theorem `J = Σ Jᵢ + m₁ m₂ / (m₁ + m₂) (d² 1 − d dᵀ)`, with the distance `d`
    /// of the centres.
    pub(crate) fn with(&self, other: &Self) -> Self {
        let mass = self.mass + other.mass;
        let shared = |i: usize| (self.mass * self.centre[i] + other.mass * other.centre[i]) / mass;
        // An inertia without a mass has no centre that matters.
        let centre = match [self.mass, other.mass] {
            [_, 0.0] => self.centre,
            [0.0, _] => other.centre,
            _ => [0, 1, 2].map(shared),
        };
        let d = [0, 1, 2].map(|i| other.centre[i] - self.centre[i]);
        let square: f64 = d.iter().map(|it| it * it).sum();
        let reduced = if mass == 0.0 {
            0.0
        } else {
            self.mass * other.mass / mass
        };
        let entry = |i: usize, j: usize| {
            let steiner = if i == j { square } else { 0.0 } - d[i] * d[j];
            self.inertia[i][j] + other.inertia[i][j] + reduced * steiner
        };
        Self {
            mass,
            centre,
            inertia: [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j))),
        }
    }
}

/// The matrix with what is above its diagonal below it too, free of rounding.
fn symmetric(matrix: &Matrix) -> Matrix {
    [0, 1, 2].map(|i: usize| [0, 1, 2].map(|j: usize| matrix[i.min(j)][i.max(j)]))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn assert_near(a: &Matrix, b: &Matrix) {
        for (a, b) in a.iter().flatten().zip(b.iter().flatten()) {
            assert!((a - b).abs() < 1e-15, "{a} {b}");
        }
    }

    #[test]
    #[allow(clippy::approx_constant, reason = "as files give them")]
    fn right_angles_are_exact() {
        let turn = rotation([-1.57079632679, 0.0, 3.14159265359]);
        assert_eq!(turn, [[-1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, -1.0, 0.0]]);
        assert!(rotation([1.5708, 0.0, 0.0])[1][1] != 0.0);
    }

    #[test]
    fn angles_of_quaternions_are_those_of_the_rotation() {
        for turn in [
            [0.1, -0.2, 0.3, 0.9],
            [-2.0, 3.0, 1.0, -0.5],
            [0.0, 0.0, 0.0, -1.0],
            [0.5, 0.5, -0.5, 0.5],
            [0.3, 0.6, -0.3, 0.6],
            [0.1, -0.7, 0.1 + 1e-6, 0.7],
            [0.0, 1.0, 0.0, 0.0],
            [1e-3, 1.0, 1e-3, -1e-3],
        ] {
            let square: f64 = turn.iter().map(|it| it * it).sum();
            let [x, y, z, w] = turn;
            let expected = [
                [
                    w * w + x * x - y * y - z * z,
                    2.0 * (x * y - w * z),
                    2.0 * (x * z + w * y),
                ],
                [
                    2.0 * (x * y + w * z),
                    w * w - x * x + y * y - z * z,
                    2.0 * (y * z - w * x),
                ],
                [
                    2.0 * (x * z - w * y),
                    2.0 * (y * z + w * x),
                    w * w - x * x - y * y + z * z,
                ],
            ]
            .map(|row| row.map(|it| it / square));
            let found = turns(angles(turn), 0.0);
            assert_near(&found, &expected);
        }
        assert_eq!(
            angles([0.5, 0.5, -0.5, 0.5])[1],
            std::f64::consts::FRAC_PI_2
        );
    }

    #[test]
    fn axes_are_reached_by_rotations() {
        let axes = [
            [1.0, 0.0, 0.0],
            [0.0, -2.0, 0.0],
            [0.0, 0.0, -1.0],
            [0.3, -0.4, 1.2],
            [0.3, 0.4, -1.2],
            [1e-6, 0.0, -1.0],
        ];
        for axis in axes {
            let (along, turn) = aligned(&axis);
            assert_near(&product(&turn, &transposed(&turn)), &IDENTITY);
            let length = axis.iter().map(|it| it * it).sum::<f64>().sqrt();
            for i in 0..3 {
                assert!((turn[i][along] - axis[i] / length).abs() < 1e-15);
            }
            for size in [1e200, 1e-200] {
                assert_eq!(along, aligned(&axis.map(|it| size * it)).0);
                assert_near(&aligned(&axis.map(|it| size * it)).1, &turn);
            }
        }
    }

    #[test]
    fn rotations_are_three_about_two_axes_and_what_is_across() {
        for turn in [
            rotation([0.3, -0.4, 1.1]),
            rotation([2.9, 1.2, -2.8]),
            rotation([1.5709, 0.0, -1.5709]),
            about(1, 0.7),
            about(0, std::f64::consts::PI),
            IDENTITY,
        ] {
            for (first, last) in [
                (0, 0),
                (0, 1),
                (0, 2),
                (1, 0),
                (1, 1),
                (1, 2),
                (2, 0),
                (2, 1),
                (2, 2),
            ] {
                let [a, b, c] = between(&turn, first, last);
                let middle = about(across(first, last), b);
                assert_near(
                    &product(&product(&about(first, a), &middle), &about(last, c)),
                    &turn,
                );
            }
        }
        assert_eq!(between(&rotation([0.0, 0.0, 0.5]), 2, 2), [0.0, 0.0, 0.5]);
        assert_eq!(between(&rotation([0.0, 0.5, 0.0]), 0, 2), [0.0, 0.5, 0.0]);
    }

    #[test]
    fn two_halves_of_a_rod_are_the_rod() {
        // A rod along x of length 2 and mass 3: m l² / 12 = 1.
        let half = |at: f64| Body {
            mass: 1.5,
            centre: [at, 0.0, 0.0],
            inertia: [[0.0; 3], [0.0, 0.125, 0.0], [0.0, 0.0, 0.125]],
        };
        let rod = half(-0.5).with(&half(0.5));
        assert_eq!(rod.centre, [0.0; 3]);
        assert_near(&rod.inertia, &[[0.0; 3], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    }

    #[test]
    fn an_inertia_without_a_mass_is_added_wherever_it_is() {
        let body = |mass: f64, at: f64, inertia: f64| Body {
            mass,
            centre: [at, 0.0, 0.0],
            inertia: [[inertia, 0.0, 0.0], [0.0; 3], [0.0; 3]],
        };
        let (link, rotor) = (body(2.0, 0.3, 0.1), body(0.0, 0.7, 0.5));
        for whole in [link.with(&rotor), rotor.with(&link)] {
            assert_eq!((whole.mass, whole.centre), (2.0, [0.3, 0.0, 0.0]));
            assert_eq!(whole.inertia, [[0.6, 0.0, 0.0], [0.0; 3], [0.0; 3]]);
        }
        let two = rotor.with(&rotor);
        assert_eq!((two.mass, two.inertia[0][0]), (0.0, 1.0));
    }

    #[test]
    fn inertias_are_sums_of_squares() {
        let turn = rotation([0.3, -0.4, 1.1]);
        for (principal, rank) in [
            ([0.0, 0.0, 0.0], 0),
            ([0.0, 0.5, 0.0], 1),
            ([0.5, 0.0, 0.5], 2),
            ([0.1, 0.2, 0.3], 3),
        ] {
            let mut diagonal = [[0.0; 3]; 3];
            (0..3).for_each(|i| diagonal[i][i] = principal[i]);
            let inertia = product(&product(&turn, &diagonal), &transposed(&turn));
            let found = squares(&inertia).unwrap();
            assert_eq!(found.len(), rank);
            let entry = |i: usize, j: usize| found.iter().map(|(d, l)| d * l[i] * l[j]).sum();
            assert_near(&inertia, &[0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j))));
        }
        assert_eq!(squares(&[[1.0, 2.0, 0.0], [2.0, 1.0, 0.0], [0.0; 3]]), None);
        assert_eq!(squares(&[[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0; 3]]), None);
    }

    #[test]
    fn a_turned_body_keeps_its_principal_inertias() {
        let body = Body {
            mass: 1.0,
            centre: [1.0, 2.0, 3.0],
            inertia: [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]],
        };
        let pose = Pose {
            place: [0.0, 0.0, 1.0],
            turn: rotation([std::f64::consts::FRAC_PI_2, 0.0, 0.0]),
        };
        let seen = body.seen(&pose);
        assert_eq!(seen.centre, [1.0, -3.0, 3.0]);
        assert_eq!(
            seen.inertia,
            [[1.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 2.0]]
        );
    }
}
