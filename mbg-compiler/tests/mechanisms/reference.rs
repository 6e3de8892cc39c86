//! Gauss's principle: of all accelerations that fulfil the constraints, mechanisms have those that are nearest to the ones
//! without constraints, by kinetic energy. Where frames are comes from the poses alone.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn, Vector3};

use super::parts::{
    Closed, Closing, Drive, Family, Mass, Mechanism, Motion, Part, attitude, part_or_ground, unit,
};
use super::pose::{Polynomial, Pose, dot};

/// The least eigenvalue of a mass matrix with ones on its diagonal, and what is left of a constraint beside others, that are
/// far from none.
const REGULAR: f64 = 1e-3;

/// What is shorter is none.
const NONE: f64 = 1e-10;

/// A line that is shorter has no direction.
const SHORT: f64 = 0.1;

/// A mechanism at positions and rates.
pub(crate) struct Reference<'a> {
    mechanism: &'a Mechanism,
    positions: Vec<f64>,
    rates: Vec<f64>,
    /// Poses where one coordinate alone has a rate, of one.
    units: Vec<Vec<Pose>>,
    /// What constraints say of accelerations and of the rates of rates; those of loops come last.
    constraints: Constraints,
    mass: DMatrix<f64>,
}

/// `jacobian rates = own`, of which the rows behind `hard` are kept by the multipliers of cuts.
struct Constraints {
    jacobian: DMatrix<f64>,
    own: DVector<f64>,
    hard: usize,
    /// How many rows each cut has.
    cuts: Vec<usize>,
}

impl Constraints {
    /// Whether each cut says something.
    fn are_told(&self) -> bool {
        let mut first = self.hard;
        self.cuts.iter().all(|count| {
            let rows = self.jacobian.rows(first, *count);
            first += count;
            rows.norm() > REGULAR
        })
    }
}

/// What a constraint keeps at zero: a rate, and that of the rate.
type Kept = [f64; 2];

impl<'a> Reference<'a> {
    /// With rates that fulfil the constraints: all of them, or those that are not kept by multipliers. None near where some
    /// become dependent, or where a motion has no inertia.
    pub(crate) fn of(mechanism: &'a Mechanism, positions: Vec<f64>, all: bool) -> Option<Self> {
        let mut reference = Self::at(mechanism, positions);
        let Constraints {
            jacobian,
            own,
            hard,
            ..
        } = &reference.constraints;
        let rows = if all { own.len() } else { *hard };
        let rates = DVector::from_vec(reference.rates.clone());
        let apart = own - jacobian * &rates;
        let apart = apart.rows(0, rows).into_owned();
        let rates = rates + least(&jacobian.rows(0, rows).into_owned(), &apart)?;
        reference.rates = rates.as_slice().to_vec();
        let is_short = |line: (f64, f64, DVector<f64>)| line.0 < SHORT;
        let is_regular = reference.is_regular()
            && reference.constraints.are_told()
            && !reference.line().is_some_and(is_short);
        is_regular.then_some(reference)
    }

    fn at(mechanism: &'a Mechanism, positions: Vec<f64>) -> Self {
        let rates: Vec<f64> = mechanism
            .families()
            .flat_map(|it| it.rate.clone())
            .collect();
        let count = rates.len();
        let units = (0..count).map(|k| {
            let rate = |j: usize| f64::from(u8::from(j == k));
            let at = (0..count).map(|j| [positions[j], rate(j), 0.0]);
            mechanism.poses(&at.collect::<Vec<_>>())
        });
        let units: Vec<Vec<Pose>> = units.collect();
        let mut reference = Self {
            mass: DMatrix::zeros(count, count),
            constraints: Constraints {
                jacobian: DMatrix::zeros(0, count),
                own: DVector::zeros(0),
                hard: 0,
                cuts: Vec::new(),
            },
            mechanism,
            positions,
            rates,
            units,
        };
        reference.mass = reference.inertia();
        reference.constraints = reference.constraints();
        reference
    }

    /// Whether what keeps rates without multipliers is independent at the start.
    pub(crate) fn is_reducible(mechanism: &Mechanism) -> bool {
        let reference = Reference::at(mechanism, mechanism.start());
        let Constraints { jacobian, hard, .. } = &reference.constraints;
        are_independent(&jacobian.rows(0, *hard).into_owned())
    }

    fn is_regular(&self) -> bool {
        let diagonal = self.mass.diagonal();
        let scaled = DMatrix::from_fn(diagonal.len(), diagonal.len(), |row, column| {
            self.mass[(row, column)] / (diagonal[row] * diagonal[column]).sqrt()
        });
        let least = scaled.symmetric_eigenvalues().min();
        diagonal.min() > REGULAR && least > REGULAR
    }

    /// Positions, rates and so much of accelerations, over two.
    fn coordinates(&self, accelerations: &DVector<f64>) -> Vec<Polynomial<f64>> {
        let both = self.positions.iter().zip(&self.rates);
        let all = both.zip(accelerations);
        all.map(|((position, rate), it)| [*position, *rate, it / 2.0])
            .collect()
    }

    fn size(&self) -> usize {
        self.rates.len()
    }

    /// The partial velocities of a point of a part, in the world, and of its turning, in its own axes.
    fn partials(&self, part: usize, arm: Vector3<f64>) -> [DMatrix<f64>; 2] {
        let columns = |of: &dyn Fn(&Pose) -> Vector3<f64>| {
            let columns: Vec<_> = self.units.iter().map(|it| of(&it[part])).collect();
            DMatrix::from_fn(3, self.size(), |row, column| columns[column][row])
        };
        [
            columns(&|pose| pose.at(arm).velocity()),
            columns(&|pose| pose.spin()[0]),
        ]
    }

    fn inertia(&self) -> DMatrix<f64> {
        let mut sum = DMatrix::zeros(self.size(), self.size());
        let (places, _) = self.mechanism.places();
        for (k, part) in self.mechanism.parts.iter().enumerate() {
            let (mass, centre) = part.weight();
            let [velocity, spin] = self.partials(k, centre);
            sum += velocity.transpose() * velocity * mass;
            if let Mass::Body { inertia, .. } = part.mass {
                sum += spin.transpose() * inertia * spin;
            }
            if let Drive::Wheel(inertia) = part.drive {
                sum[(places[k], places[k])] += inertia;
            }
        }
        sum
    }

    fn constraints(&self) -> Constraints {
        let count = self.size();
        let rates = |moved: Option<usize>| {
            let rate = |k: usize| f64::from(u8::from(moved == Some(k)));
            let at = (0..count).map(|k| [self.positions[k], rate(k), 0.0]);
            self.kept(&at.collect::<Vec<_>>())
        };
        let (still, cuts) = rates(None);
        let columns: Vec<Vec<Kept>> = (0..count).map(|k| rates(Some(k)).0).collect();
        Constraints {
            jacobian: DMatrix::from_fn(still.len(), count, |row, column| {
                columns[column][row][0] - still[row][0]
            }),
            own: DVector::from_iterator(still.len(), still.iter().map(|it| -it[0])),
            hard: still.len() - cuts.iter().sum::<usize>(),
            cuts,
        }
    }

    /// What constraints keep at zero, and how many of the last are those of each cut.
    fn kept(&self, coordinates: &[Polynomial<f64>]) -> (Vec<Kept>, Vec<usize>) {
        let Mechanism {
            parts,
            closings,
            ratio,
            is_planar,
            ..
        } = self.mechanism;
        let (places, _) = self.mechanism.places();
        let poses = self.mechanism.poses(coordinates);
        let rate = |part: usize| {
            let [_, rate, change] = coordinates[places[part]];
            [rate, 2.0 * change]
        };
        let mut kept = Vec::new();
        for (k, part) in parts.iter().enumerate() {
            if let Drive::Servo(change) = part.drive {
                let [own, own_change] = rate(k);
                kept.push([own - part.first_rate(), own_change - change]);
            }
        }
        if let Some(ratio) = ratio {
            let [from, to] = [rate(ratio.from), rate(ratio.to)];
            kept.push([0, 1].map(|k| to[k] - ratio.ratio * from[k]));
        }
        let is_ring = |it: &&Closing| it.word == Closed::Ring;
        let rings = closings.iter().filter(is_ring);
        kept.extend(rings.flat_map(|it| it.kept(&poses, *is_planar)));
        let cuts = closings.iter().filter(|it| !is_ring(it));
        let cuts: Vec<Vec<Kept>> = cuts.map(|it| it.kept(&poses, *is_planar)).collect();
        kept.extend(cuts.iter().flatten());
        (kept, cuts.iter().map(Vec::len).collect())
    }

    /// What acts along each coordinate besides inertia, where rates do not change.
    fn forces(&self) -> DVector<f64> {
        let steady = self.coordinates(&DVector::zeros(self.size()));
        let poses = self.mechanism.poses(&steady);
        let mut sum = DVector::zeros(self.size());
        for (k, part) in self.mechanism.parts.iter().enumerate() {
            let (mass, centre) = part.weight();
            let [velocity, spin] = self.partials(k, centre);
            let inertial = poses[k].at(centre).acceleration();
            sum += velocity.transpose() * (self.mechanism.fall() - inertial) * mass;
            if let Mass::Body { inertia, .. } = part.mass {
                let [omega, alpha] = poses[k].spin();
                let needed = inertia * alpha + omega.cross(&(inertia * omega));
                sum -= spin.transpose() * needed;
            }
            if let Some(load) = &part.load {
                let axes = poses[k].axes[0];
                let is_of_world = load.is_of_world;
                let force = if is_of_world {
                    load.force
                } else {
                    axes * load.force
                };
                let moment = match is_of_world {
                    true => axes.transpose() * load.moment,
                    false => load.moment,
                };
                let [velocity, spin] = self.partials(k, Vector3::zeros());
                sum += velocity.transpose() * force + spin.transpose() * moment;
            }
        }
        sum + self.along_joints() + self.along_line()
    }

    fn along_joints(&self) -> DVector<f64> {
        let mut forces = Vec::new();
        for family in self.mechanism.families() {
            let own = forces.len()..forces.len() + family.size();
            let spring = family.spring_forces(&self.positions[own.clone()]);
            for (place, k) in own.enumerate() {
                let damping = family.damping[place] * self.rates[k];
                forces.push(spring[place] + family.motor[place] - damping);
            }
        }
        DVector::from_vec(forces)
    }

    /// The line's length, how fast it grows, and how its ends' coordinates do that.
    fn line(&self) -> Option<(f64, f64, DVector<f64>)> {
        let line = self.mechanism.line.as_ref()?;
        let span = |poses: &[Pose]| {
            let far = part_or_ground(poses, line.to).at(line.offset);
            [0, 1].map(|k| far.place[k] - poses[line.from].place[k])
        };
        let [start, _] = span(&self.units[0]);
        let along = start.normalize();
        let slopes = self.units.iter().map(|poses| along.dot(&span(poses)[1]));
        let slopes = DVector::from_iterator(self.size(), slopes);
        let rate = slopes.dot(&DVector::from_vec(self.rates.clone()));
        Some((start.norm(), rate, slopes))
    }

    fn along_line(&self) -> DVector<f64> {
        let (Some(line), Some((length, rate, slopes))) = (&self.mechanism.line, self.line()) else {
            return DVector::zeros(self.size());
        };
        let tension = line.stiffness * (length - line.rest) + line.damping * rate + line.force;
        slopes * -tension
    }

    /// The positions and rates with the accelerations; none where constraints are nearly dependent.
    pub(crate) fn motion(&self) -> Option<Vec<Polynomial<f64>>> {
        let still = DVector::zeros(self.size());
        let (kept, _) = self.kept(&self.coordinates(&still));
        let bias = DVector::from_iterator(kept.len(), kept.iter().map(|it| -it[1]));
        let factor = Cholesky::<f64, Dyn>::new(self.mass.clone())?.l();
        let free = factor.solve_lower_triangular(&self.forces())?;
        let across = factor.solve_lower_triangular(&self.constraints.jacobian.transpose())?;
        let across = across.transpose();
        let found = &free + least(&across, &(bias - &across * &free))?;
        let accelerations = factor.transpose().solve_upper_triangular(&found)?;
        Some(self.coordinates(&accelerations))
    }

    /// By how much the flows of the ends of cuts differ.
    pub(crate) fn open(&self) -> Vec<f64> {
        let (kept, _) = self.kept(&self.coordinates(&DVector::zeros(self.size())));
        kept[self.constraints.hard..]
            .iter()
            .map(|it| it[0])
            .collect()
    }

    /// The energy, and how fast it changes along a motion.
    pub(crate) fn energy(&self, motion: &[Polynomial<f64>]) -> [f64; 2] {
        let mut sum = [0.0; 2];
        let mut add = |energy: f64, change: f64| sum = [sum[0] + energy, sum[1] + change];
        let poses = self.mechanism.poses(motion);
        let mut rest = motion;
        for (part, pose) in self.mechanism.parts.iter().zip(&poses) {
            let (mass, centre) = part.weight();
            let centre = pose.at(centre);
            let momentum = mass * centre.velocity();
            add(
                momentum.dot(&centre.velocity()) / 2.0,
                momentum.dot(&centre.acceleration()),
            );
            if let Mass::Body { inertia, .. } = part.mass {
                let [omega, alpha] = pose.spin();
                let momentum = inertia * omega;
                add(momentum.dot(&omega) / 2.0, momentum.dot(&alpha));
            }
            if let (Drive::Wheel(inertia), [_, rate, change]) = (part.drive, rest[0]) {
                add(inertia * rate * rate / 2.0, inertia * rate * 2.0 * change);
            }
            for family in &part.joint.families {
                let (own, behind) = rest.split_at(family.size());
                rest = behind;
                if let (Some((stiffness, rests)), false) = (&family.spring, family.is_attitude()) {
                    for ((stiffness, at), [position, rate, _]) in
                        stiffness.iter().zip(rests).zip(own)
                    {
                        let stretch = position - at;
                        add(
                            stiffness * stretch * stretch / 2.0,
                            stiffness * stretch * rate,
                        );
                    }
                }
            }
        }
        if let (Some(line), Some((length, rate, _))) = (&self.mechanism.line, self.line()) {
            let stretch = length - line.rest;
            add(
                line.stiffness * stretch * stretch / 2.0,
                line.stiffness * stretch * rate,
            );
        }
        sum
    }

    pub(crate) fn dissipated(&self) -> f64 {
        let damping = self.mechanism.families().flat_map(|it| &it.damping);
        let losses = damping.zip(&self.rates).map(|(it, rate)| it * rate * rate);
        let own = losses.sum::<f64>();
        match (&self.mechanism.line, self.line()) {
            (Some(line), Some((_, rate, _))) => own + line.damping * rate * rate,
            _ => own,
        }
    }
}

impl Part {
    /// Mass and its centre.
    fn weight(&self) -> (f64, Vector3<f64>) {
        match self.mass {
            Mass::None => (0.0, Vector3::zeros()),
            Mass::Point(mass) => (mass, Vector3::zeros()),
            Mass::Body { mass, centre, .. } => (mass, centre),
        }
    }

    pub(crate) fn first_rate(&self) -> f64 {
        self.joint.families[0].rate[0]
    }
}

impl Family {
    pub(crate) fn is_attitude(&self) -> bool {
        matches!(self.motion, Motion::Attitude(_))
    }

    /// What its springs put on the coordinates. Those of an orientation have the potential k tr(1 - R) / 2.
    fn spring_forces(&self, positions: &[f64]) -> Vec<f64> {
        let Some((stiffness, rest)) = &self.spring else {
            return vec![0.0; positions.len()];
        };
        if let Motion::Attitude(order) = self.motion {
            let turned = attitude(order, rest).transpose() * attitude(order, positions);
            let slope = |axis| (turned * unit(axis).cross_matrix()).trace() / 2.0;
            return (0..3).map(|axis| stiffness[0] * slope(axis)).collect();
        }
        let all = stiffness.iter().zip(rest).zip(positions);
        all.map(|((stiffness, rest), position)| -stiffness * (position - rest))
            .collect()
    }
}

impl Closing {
    /// What it keeps, in the order of the library.
    fn kept(&self, poses: &[Pose], is_planar: bool) -> Vec<Kept> {
        let (a, b) = (&poses[self.from], self.other(poses));
        let apart = [0, 1, 2].map(|k| a.place[k] - b.place[k]);
        let gap = |axis: usize| [apart[1][axis], 2.0 * apart[2][axis]];
        let (first, second) = (a.spin(), b.spin());
        let turned = [0, 1].map(|k| first[k].z - second[k].z);
        if is_planar {
            let (sine, cosine) = self.direction.sin_cos();
            let normal = a.direction(Vector3::new(-sine, cosine, 0.0));
            let beside = rates(dot(&apart, &normal));
            return match self.word {
                Closed::Slot => vec![beside],
                Closed::Prismatic => vec![turned, beside],
                Closed::Fixed | Closed::Ring => vec![turned, gap(0), gap(1)],
                _ => vec![gap(0), gap(1)],
            };
        }
        let angle = |i, j| rates(dot(&a.direction(unit(i)), &b.direction(unit(j))));
        let mut kept = vec![gap(0), gap(1), gap(2)];
        match self.word {
            Closed::Universal => kept.push(angle(0, 1)),
            Closed::Revolute => kept.extend([angle(0, 2), angle(1, 2)]),
            Closed::Fixed | Closed::Ring => {
                kept.extend([angle(0, 1), angle(0, 2), angle(1, 2)]);
            }
            _ => {}
        }
        kept
    }
}

fn rates(of: Polynomial<f64>) -> Kept {
    [of[1], 2.0 * of[2]]
}

/// The least that makes the product so much, by rows one after another, each made orthogonal to those before; none where a
/// row nearly depends on others, or says something else than they do.
fn least(matrix: &DMatrix<f64>, right: &DVector<f64>) -> Option<DVector<f64>> {
    let mut rows: Vec<(DVector<f64>, f64)> = (0..right.len())
        .map(|row| (matrix.row(row).transpose(), right[row]))
        .collect();
    for (row, value) in &mut rows {
        let length = row.norm();
        if length > NONE {
            *row /= length;
            *value /= length;
        }
    }
    let mut found = DVector::zeros(matrix.ncols());
    loop {
        let length = |place: &usize| rows[*place].0.norm();
        let longest = (0..rows.len()).max_by(|a, b| length(a).total_cmp(&length(b)));
        let Some(place) = longest.filter(|it| length(it) > NONE) else {
            let is_kept = rows.iter().all(|(_, value)| value.abs() < NONE);
            return is_kept.then_some(found);
        };
        let (row, value) = rows.swap_remove(place);
        let length = row.norm();
        if length < REGULAR {
            return None;
        }
        let (row, value) = (row / length, value / length);
        found += &row * value;
        for (other, rest) in &mut rows {
            for _ in 0..2 {
                let along = row.dot(other);
                *other -= &row * along;
                *rest -= value * along;
            }
        }
    }
}

/// Whether rows are independent.
fn are_independent(matrix: &DMatrix<f64>) -> bool {
    let mut basis: Vec<DVector<f64>> = Vec::new();
    matrix.row_iter().all(|row| {
        let mut row = row.transpose().normalize();
        for _ in 0..2 {
            for other in &basis {
                row -= other * other.dot(&row);
            }
        }
        let length = row.norm();
        basis.push(row / length);
        length > REGULAR
    })
}
