//! Robots whose links hang on each other as a tree, given as URDF gives them: forward dynamics by recursive
//! Newton-Euler and a dense mass matrix, in axes of the world.
//!
//! Outward go velocities and accelerations, inward the forces and moments that the links take (Luh, Walker and Paul,
//! *J. Dyn. Sys. Meas. Control* 102, 1980). What the joints must give for `q̈` is `M q̈ + b`: with `q̈ = 0` it is `b`, and with
//! one rate changing and everything at rest it is a column of `M`.

use nalgebra::{Matrix3, Rotation3, Vector3};

use super::dense;

/// What a joint does.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Fixed,
    Revolute,
    Prismatic,
}

/// A link and the joint that holds it.
#[derive(Clone, Copy)]
pub(crate) struct Link {
    /// The link that the joint stands on, none for the base; links come after their parents.
    pub(crate) parent: Option<usize>,
    pub(crate) kind: Kind,
    /// The joint's frame in that of the parent: `xyz` and `rpy`.
    pub(crate) place: [f64; 3],
    pub(crate) angles: [f64; 3],
    /// In axes of the joint.
    pub(crate) axis: [f64; 3],
    pub(crate) damping: f64,
    /// Dry friction, which is `friction tanh(q̇ / slip)`.
    pub(crate) friction: f64,
    pub(crate) mass: f64,
    /// The frame of the inertia in that of the link: `xyz` and `rpy`.
    pub(crate) centre: [f64; 3],
    pub(crate) centre_angles: [f64; 3],
    /// `ixx, ixy, ixz, iyy, iyz, izz`.
    pub(crate) inertia: [f64; 6],
}

impl Link {
    /// A link of no mass on a hinge about x in the base.
    pub(crate) const PLAIN: Self = Self {
        parent: None,
        kind: Kind::Revolute,
        place: [0.0; 3],
        angles: [0.0; 3],
        axis: [1.0, 0.0, 0.0],
        damping: 0.0,
        friction: 0.0,
        mass: 0.0,
        centre: [0.0; 3],
        centre_angles: [0.0; 3],
        inertia: [0.0; 6],
    };
}

/// Rate at which dry friction has three quarters of its value.
pub(crate) const SLIP: f64 = 1e-3;

/// A link where it is, in axes of the world.
struct Placed {
    origin: Vector3<f64>,
    turn: Rotation3<f64>,
    axis: Vector3<f64>,
    centre: Vector3<f64>,
    inertia: Matrix3<f64>,
}

/// The rotation by roll, pitch and yaw about fixed axes.
fn rotation([roll, pitch, yaw]: [f64; 3]) -> Rotation3<f64> {
    let about = |axis: Vector3<f64>, angle| Rotation3::new(axis * angle);
    about(Vector3::z(), yaw) * about(Vector3::y(), pitch) * about(Vector3::x(), roll)
}

/// `values` by joint as values by link, zero where a joint is fixed.
fn by_link(links: &[Link], values: &[f64]) -> Vec<f64> {
    let mut values = values.iter();
    let own = |link: &Link| match link.kind {
        Kind::Fixed => 0.0,
        _ => *values.next().unwrap(),
    };
    links.iter().map(own).collect()
}

fn placed(links: &[Link], q: &[f64]) -> Vec<Placed> {
    let mut found: Vec<Placed> = Vec::new();
    for (link, q) in links.iter().zip(q) {
        let (origin, turn) = match link.parent {
            Some(parent) => (found[parent].origin, found[parent].turn),
            None => (Vector3::zeros(), Rotation3::identity()),
        };
        let joint = turn * rotation(link.angles);
        let own = Vector3::from(link.axis).normalize();
        let axis = joint * own;
        let (slid, turned) = match link.kind {
            Kind::Prismatic => (axis * *q, joint),
            _ => (Vector3::zeros(), joint * Rotation3::new(own * *q)),
        };
        let origin = origin + turn * Vector3::from(link.place) + slid;
        let [xx, xy, xz, yy, yz, zz] = link.inertia;
        let principal = turned * rotation(link.centre_angles);
        let inertia = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        found.push(Placed {
            origin,
            turn: turned,
            axis,
            centre: origin + turned * Vector3::from(link.centre),
            inertia: principal * inertia * principal.inverse(),
        });
    }
    found
}

/// What the joints must give along their axes for these rates and accelerations, by link.
fn given(links: &[Link], at: &[Placed], v: &[f64], a: &[f64], gravity: Vector3<f64>) -> Vec<f64> {
    let zero = Vector3::zeros();
    // ω, α, and the acceleration of the origin, which gravity is part of.
    let mut motion: Vec<[Vector3<f64>; 3]> = Vec::new();
    for (i, link) in links.iter().enumerate() {
        let (before, [omega, alpha, linear]) = match link.parent {
            Some(parent) => (at[parent].origin, motion[parent]),
            None => (zero, [zero, zero, -gravity]),
        };
        let arm = at[i].origin - before;
        let linear = linear + alpha.cross(&arm) + omega.cross(&omega.cross(&arm));
        let (rate, change) = (at[i].axis * v[i], at[i].axis * a[i]);
        motion.push(match link.kind {
            Kind::Prismatic => [omega, alpha, linear + 2.0 * omega.cross(&rate) + change],
            _ => [omega + rate, alpha + omega.cross(&rate) + change, linear],
        });
    }
    // What holds a link: a force, and a moment about the origin of the link.
    let mut held = vec![[zero; 2]; links.len()];
    let mut found = vec![0.0; links.len()];
    for i in (0..links.len()).rev() {
        let [omega, alpha, linear] = motion[i];
        let arm = at[i].centre - at[i].origin;
        let centre = linear + alpha.cross(&arm) + omega.cross(&omega.cross(&arm));
        let force = links[i].mass * centre;
        held[i][0] += force;
        held[i][1] +=
            arm.cross(&force) + at[i].inertia * alpha + omega.cross(&(at[i].inertia * omega));
        let [force, moment] = held[i];
        found[i] = match links[i].kind {
            Kind::Fixed => 0.0,
            Kind::Revolute => at[i].axis.dot(&moment),
            Kind::Prismatic => at[i].axis.dot(&force),
        };
        if let Some(parent) = links[i].parent {
            let arm = at[i].origin - at[parent].origin;
            held[parent][0] += force;
            held[parent][1] += moment + arm.cross(&force);
        }
    }
    found
}

/// `q̈` by joint that moves, with the columns of the mass matrix.
pub(crate) fn accelerations(
    links: &[Link],
    q: &[f64],
    v: &[f64],
    effort: &[f64],
    gravity: [f64; 3],
) -> (Vec<f64>, Vec<Vec<f64>>) {
    let free: Vec<usize> = (0..links.len())
        .filter(|i| links[*i].kind != Kind::Fixed)
        .collect();
    let [q, v, effort] = [q, v, effort].map(|values| by_link(links, values));
    let (at, rest) = (placed(links, &q), vec![0.0; links.len()]);
    let bias = given(links, &at, &v, &rest, gravity.into());
    let column = |i: &usize| {
        let mut one = rest.clone();
        one[*i] = 1.0;
        let column = given(links, &at, &rest, &one, Vector3::zeros());
        free.iter().map(|j| column[*j]).collect()
    };
    let matrix: Vec<Vec<f64>> = free.iter().map(column).collect();
    let right = |i: &usize| {
        let link = &links[*i];
        effort[*i] - link.damping * v[*i] - link.friction * (v[*i] / SLIP).tanh() - bias[*i]
    };
    let right = free.iter().map(right).collect();
    (dense::solve(matrix.clone(), right), matrix)
}

/// Where the frame of a link is in the world.
pub(crate) fn position(links: &[Link], q: &[f64], link: usize) -> [f64; 3] {
    placed(links, &by_link(links, q))[link].origin.into()
}

#[cfg(test)]
mod tests {
    use super::super::chain::{self, composite};
    use super::*;

    /// The chain in space, written as a tree.
    fn as_tree(n: usize) -> Vec<Link> {
        let link = |i: usize| Link {
            parent: i.checked_sub(1),
            kind: Kind::Revolute,
            place: [0.0, 0.0, if i == 0 { 0.0 } else { -chain::LENGTH }],
            angles: [0.0; 3],
            axis: if chain::axis(i) == 0 {
                [1.0, 0.0, 0.0]
            } else {
                [0.0, 1.0, 0.0]
            },
            damping: chain::DAMPING,
            mass: chain::MASS,
            centre: [0.0, 0.0, -chain::LENGTH / 2.0],
            inertia: [
                chain::INERTIA_ACROSS,
                0.0,
                0.0,
                chain::INERTIA_ACROSS,
                0.0,
                chain::INERTIA_ALONG,
            ],
            ..Link::PLAIN
        };
        (0..n).map(link).collect()
    }

    #[test]
    fn a_chain_is_a_tree() {
        for seed in 0..20 {
            let [q, v, torque] = chain::sample(7, seed);
            let gravity = [0.0, 0.0, -chain::GRAVITY];
            let (found, _) = accelerations(&as_tree(7), &q, &v, &torque, gravity);
            let expected = composite::accelerations(&q, &v, &torque);
            let size = expected.iter().fold(0.0_f64, |size, it| size.max(it.abs()));
            for (found, expected) in found.iter().zip(&expected) {
                assert!(
                    (found - expected).abs() < 1e-11 * size,
                    "{found} {expected}"
                );
            }
        }
    }

    #[test]
    fn a_slide_on_a_turntable() {
        // A point mass at r on a table that turns at ω: r̈ = r ω², and the table slows by 2 r ṙ ω / r².
        let frame = Link {
            axis: [0.0, 0.0, 2.0],
            ..Link::PLAIN
        };
        let slide = Link {
            parent: Some(0),
            kind: Kind::Prismatic,
            mass: 3.0,
            ..Link::PLAIN
        };
        let (r, rate, omega) = (0.7, 0.3, 1.1);
        let found = accelerations(
            &[frame, slide],
            &[0.4, r],
            &[omega, rate],
            &[0.0; 2],
            [0.0; 3],
        );
        assert!((found.0[0] + 2.0 * rate * omega / r).abs() < 1e-14);
        assert!((found.0[1] - r * omega * omega).abs() < 1e-14);
    }
}
