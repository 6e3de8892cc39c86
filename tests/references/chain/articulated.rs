//! Forward dynamics by the articulated-body recursion, written for this chain by hand.
//!
//! Featherstone, *Rigid Body Dynamics Algorithms*, 2008, chapter 7, with the changes that a careful hand makes:
//!
//! - Everything is in the axes of its link, about the joint that holds it. A change of axes is a turn in a plane.
//! - The accelerations that the motion has without any `q̈` are found on the way out. What is left is linear in `q̈` and
//!   needs no velocity product on the way back.
//! - The centre of mass and the next joint lie on the z axis, so that of `α× + ω×ω×` only the third column is needed.
//! - What a joint passes on has no torque about its axis beyond the given one: those rows are zero, or the torque, and
//!   are not computed.
//! - A symmetric block is turned with nine operations, see [`Turn::symmetric`].

use super::{DAMPING, GRAVITY, INERTIA_ACROSS, INERTIA_ALONG, MASS, axis};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// What the recursion computes with: numbers, or counters of operations.
pub(crate) trait Scalar:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// A constant.
    fn constant(value: f64) -> Self;
    /// Sine and cosine.
    fn sin_cos(self) -> (Self, Self);
}

impl Scalar for f64 {
    fn constant(value: f64) -> Self {
        value
    }

    fn sin_cos(self) -> (Self, Self) {
        f64::sin_cos(self)
    }
}

type Vector<T> = [T; 3];
type Matrix<T> = [[T; 3]; 3];

/// `q̈` of the chain, its links of `length`.
pub(crate) fn accelerations<T: Scalar>(length: f64, q: &[T], v: &[T], torque: &[T]) -> Vec<T> {
    let links = outward(length, q, v);
    let joints = inward(length, &links, v, torque);
    let mut change = Motion::zero();
    let mut found = Vec::with_capacity(q.len());
    for (k, (link, joint)) in links.iter().zip(&joints).enumerate() {
        change = link.turn.in_link(change.moved(length));
        let a = joint.free
            - dot(&joint.resisting.angular, &change.angular)
            - dot(&joint.resisting.linear, &change.linear);
        change.angular[axis(k)] = change.angular[axis(k)] + a;
        found.push(a);
    }
    found
}

/// An angular and a linear vector.
#[derive(Clone, Copy)]
struct Motion<T> {
    angular: Vector<T>,
    linear: Vector<T>,
}

impl<T: Scalar> Motion<T> {
    fn zero() -> Self {
        let zero = T::constant(0.0);
        Self {
            angular: [zero; 3],
            linear: [zero; 3],
        }
    }

    /// Acceleration at the next joint, `(0, 0, −length)`, of a link that is at rest.
    fn moved(self, length: f64) -> Self {
        let length = T::constant(length);
        let ([x, y, _], [a, b, c]) = (self.angular, self.linear);
        Self {
            angular: self.angular,
            linear: [a - length * y, b + length * x, c],
        }
    }
}

/// A link without `q̈`: its turn against the link above, and force and torque that its motion takes.
struct Link<T> {
    turn: Turn<T>,
    force: Motion<T>,
}

/// From the base to the tip.
fn outward<T: Scalar>(length: f64, q: &[T], v: &[T]) -> Vec<Link<T>> {
    let zero = T::constant(0.0);
    let half = T::constant(0.5 * length);
    let mass = T::constant(MASS);
    let across = T::constant(INERTIA_ACROSS);
    let difference = T::constant(INERTIA_ACROSS - INERTIA_ALONG);
    let along = T::constant(INERTIA_ALONG);

    let mut omega = [zero; 3];
    // Instead of gravity the base accelerates upwards. `joint` is the acceleration of the next joint.
    let mut alpha = [zero; 3];
    let mut joint = [zero, zero, T::constant(GRAVITY)];
    let mut links = Vec::with_capacity(q.len());
    for (i, (q, v)) in q.iter().zip(v).enumerate() {
        let turn = Turn::new(axis(i), *q);
        omega = turn.vector_in_link(omega);
        alpha = turn.vector_in_link(alpha);
        joint = turn.vector_in_link(joint);
        // ω × axis q̇, with ω before the joint's own rate is added.
        let (j, k) = turn.plane();
        (alpha[j], alpha[k]) = (alpha[j] + omega[k] * *v, alpha[k] - omega[j] * *v);
        omega[axis(i)] = omega[axis(i)] + *v;

        let [x, y, z] = omega;
        let (xz, yz) = (x * z, y * z);
        // Acceleration of the point (0, 0, half) against the joint.
        let lever = [
            half * (alpha[1] + xz),
            half * (yz - alpha[0]),
            -(half * (x * x + y * y)),
        ];
        let centre = subtract(joint, lever);
        let force = centre.map(|a| mass * a);
        links.push(Link {
            turn,
            force: Motion {
                angular: [
                    across * alpha[0] - difference * yz + half * force[1],
                    across * alpha[1] + difference * xz - half * force[0],
                    along * alpha[2],
                ],
                linear: force,
            },
        });
        joint = subtract(centre, lever);
    }
    links
}

/// What a joint answers: `q̈ = free − resisting · (acceleration of the axes it turns in)`.
struct Joint<T> {
    free: T,
    resisting: Motion<T>,
}

/// From the tip to the base.
fn inward<T: Scalar>(length: f64, links: &[Link<T>], v: &[T], torque: &[T]) -> Vec<Joint<T>> {
    let damping = T::constant(DAMPING);
    let mut inertia = Inertia::zero();
    let mut force = Motion::zero();
    let mut joints = Vec::with_capacity(links.len());
    for (k, link) in links.iter().enumerate().rev() {
        inertia.add_link(length);
        force = Motion {
            angular: add(force.angular, link.force.angular),
            linear: add(force.linear, link.force.linear),
        };
        let driving = torque[k] - damping * v[k];
        let joint = inertia.release(&mut force, axis(k), driving);
        if k > 0 {
            inertia = link.turn.inertia_out_of_link(&inertia).moved(length);
            force = link.turn.out_of_link(force);
            let [x, y, _] = force.linear;
            let length = T::constant(length);
            force.angular[0] = force.angular[0] + length * y;
            force.angular[1] = force.angular[1] - length * x;
        }
        joints.push(joint);
    }
    joints.reverse();
    joints
}

/// An articulated inertia: torque = `angular · α + coupling · a`, force = `couplingᵀ · α + linear · a`.
struct Inertia<T> {
    /// Symmetric, on and below the diagonal.
    angular: Matrix<T>,
    coupling: Matrix<T>,
    /// Symmetric, on and below the diagonal.
    linear: Matrix<T>,
}

impl<T: Scalar> Inertia<T> {
    fn zero() -> Self {
        let zero = [[T::constant(0.0); 3]; 3];
        Self {
            angular: zero,
            coupling: zero,
            linear: zero,
        }
    }

    fn add_link(&mut self, length: f64) {
        let across = INERTIA_ACROSS + 0.25 * MASS * length * length;
        let plus = |element: &mut T, value: f64| *element = *element + T::constant(value);
        for (i, inertia) in [across, across, INERTIA_ALONG].into_iter().enumerate() {
            plus(&mut self.angular[i][i], inertia);
            plus(&mut self.linear[i][i], MASS);
        }
        let moment = 0.5 * MASS * length;
        plus(&mut self.coupling[0][1], moment);
        plus(&mut self.coupling[1][0], -moment);
    }

    /// Lets the axis `k` turn freely under the torque `driving`: what is left is what the joint passes on.
    fn release(&mut self, force: &mut Motion<T>, k: usize, driving: T) -> Joint<T> {
        let zero = T::constant(0.0);
        let (a, b) = others(k);
        let inverse = T::constant(1.0) / self.angular[k][k];
        let free = (driving - force.angular[k]) * inverse;
        let mut column = [zero; 3];
        column[a] = self.lower(a, k);
        column[b] = self.lower(b, k);
        let row = self.coupling[k];
        let mut resisting = Motion {
            angular: column.map(|element| element * inverse),
            linear: row.map(|element| element * inverse),
        };
        // The inertia about the axis, times its inverse.
        resisting.angular[k] = T::constant(1.0);
        for i in [a, b] {
            for j in [a, b].into_iter().filter(|j| *j <= i) {
                self.angular[i][j] = self.angular[i][j] - column[i] * resisting.angular[j];
            }
            for j in 0..3 {
                self.coupling[i][j] = self.coupling[i][j] - column[i] * resisting.linear[j];
            }
            force.angular[i] = force.angular[i] + column[i] * free;
        }
        for (i, element) in row.into_iter().enumerate() {
            for j in 0..=i {
                self.linear[i][j] = self.linear[i][j] - element * resisting.linear[j];
            }
            self.angular[i.max(k)][i.min(k)] = zero;
            force.linear[i] = force.linear[i] + element * free;
        }
        self.coupling[k] = [zero; 3];
        force.angular[k] = driving;
        Joint { free, resisting }
    }

    fn lower(&self, i: usize, j: usize) -> T {
        self.angular[i.max(j)][i.min(j)]
    }

    /// About the joint above, at `(0, 0, length)`. With `E = −r×` and `r = (0, 0, −length)`:
    /// `H' = H + Eᵀ M`, `A' = A + H' E + Eᵀ Hᵀ`.
    fn moved(mut self, length: f64) -> Self {
        let length = T::constant(length);
        let before = self.coupling;
        let m = |i: usize, j: usize| self.linear[i.max(j)][i.min(j)];
        for j in [0, 1, 2] {
            self.coupling[0][j] = before[0][j] + length * m(1, j);
            self.coupling[1][j] = before[1][j] - length * m(0, j);
        }
        let h = &self.coupling;
        let a = &mut self.angular;
        a[0][0] = a[0][0] + length * (h[0][1] + before[0][1]);
        a[1][0] = a[1][0] + length * (h[1][1] - before[0][0]);
        a[1][1] = a[1][1] - length * (h[1][0] + before[1][0]);
        a[2][0] = a[2][0] + length * before[2][1];
        a[2][1] = a[2][1] - length * before[2][0];
        self
    }
}

/// A turn about x or y, by the angle of a joint.
struct Turn<T> {
    axis: usize,
    sine: T,
    cosine: T,
}

impl<T: Scalar> Turn<T> {
    fn new(axis: usize, angle: T) -> Self {
        let (sine, cosine) = angle.sin_cos();
        Self { axis, sine, cosine }
    }

    /// The two other axes, so that the turn takes the first towards the second.
    fn plane(&self) -> (usize, usize) {
        others(self.axis)
    }

    fn vector_in_link(&self, mut v: Vector<T>) -> Vector<T> {
        let (j, k) = self.plane();
        (v[j], v[k]) = (
            self.cosine * v[j] + self.sine * v[k],
            self.cosine * v[k] - self.sine * v[j],
        );
        v
    }

    fn vector_out_of_link(&self, mut v: Vector<T>) -> Vector<T> {
        let (j, k) = self.plane();
        (v[j], v[k]) = self.pair(v[j], v[k]);
        v
    }

    fn pair(&self, a: T, b: T) -> (T, T) {
        (
            self.cosine * a - self.sine * b,
            self.sine * a + self.cosine * b,
        )
    }

    fn in_link(&self, motion: Motion<T>) -> Motion<T> {
        Motion {
            angular: self.vector_in_link(motion.angular),
            linear: self.vector_in_link(motion.linear),
        }
    }

    fn out_of_link(&self, motion: Motion<T>) -> Motion<T> {
        Motion {
            angular: self.vector_out_of_link(motion.angular),
            linear: self.vector_out_of_link(motion.linear),
        }
    }

    /// `[a b; c d]` with its axes turned: with `p = s (a − d) + c (b + c)`,
    /// `a' = a − s p`, `d' = d + s p`, `b' = c p − c`, `c' = c p − b`.
    fn block(&self, [[a, b], [c, d]]: [[T; 2]; 2]) -> [[T; 2]; 2] {
        let p = self.sine * (a - d) + self.cosine * (b + c);
        let (sine, cosine) = (self.sine * p, self.cosine * p);
        [[a - sine, cosine - c], [cosine - b, d + sine]]
    }

    /// The same for `b = c`: nothing is computed twice.
    fn symmetric(&self, a: T, b: T, d: T) -> (T, T, T) {
        let p = self.sine * (a - d) + (self.cosine + self.cosine) * b;
        let sine = self.sine * p;
        (a - sine, self.cosine * p - b, d + sine)
    }

    /// Turns the axes of a symmetric matrix.
    fn symmetric_matrix(&self, matrix: &Matrix<T>) -> Matrix<T> {
        let (j, k) = self.plane();
        let i = self.axis;
        let at = |a: usize, b: usize| (a.max(b), a.min(b));
        let get = |(row, column): (usize, usize)| matrix[row][column];
        let mut turned = *matrix;
        let mut set = |(row, column): (usize, usize), value| turned[row][column] = value;
        let (first, mixed, second) = self.symmetric(get(at(j, j)), get(at(k, j)), get(at(k, k)));
        set(at(j, j), first);
        set(at(k, j), mixed);
        set(at(k, k), second);
        let (first, second) = self.pair(get(at(i, j)), get(at(i, k)));
        set(at(i, j), first);
        set(at(i, k), second);
        turned
    }

    fn inertia_out_of_link(&self, inertia: &Inertia<T>) -> Inertia<T> {
        let (j, k) = self.plane();
        let i = self.axis;
        let h = &inertia.coupling;
        let mut coupling = *h;
        let block = self.block([[h[j][j], h[j][k]], [h[k][j], h[k][k]]]);
        (
            [coupling[j][j], coupling[j][k]],
            [coupling[k][j], coupling[k][k]],
        ) = (block[0], block[1]);
        (coupling[j][i], coupling[k][i]) = self.pair(h[j][i], h[k][i]);
        (coupling[i][j], coupling[i][k]) = self.pair(h[i][j], h[i][k]);
        Inertia {
            angular: self.symmetric_matrix(&inertia.angular),
            coupling,
            linear: self.symmetric_matrix(&inertia.linear),
        }
    }
}

/// The axes other than `axis`, in the order in which a turn about it takes the first towards the second.
fn others(axis: usize) -> (usize, usize) {
    ((axis + 1) % 3, (axis + 2) % 3)
}

fn add<T: Scalar>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn subtract<T: Scalar>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot<T: Scalar>(a: &Vector<T>, b: &Vector<T>) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
