//! Forces along lines, and storages whose displacement follows from other states.

use mbg_runtime::{Adaptive, Dop853, Dual, Integrator, System, mbg};
use nalgebra::{Quaternion, SVector, UnitQuaternion, Vector3};

use super::audit::assert_sound_about_the_start;

mbg! {
    include "tests/models/lines.mbg";
    include "examples/gallery/container.mbg";

    /// A bob that a rope holds in a plane, and one in space.
    model Roped {
        param stiffness: N/m = 100.0;
        1 ground[3]; 1 pole[6];
        Sf fixed[3] { flow: 0.0 } -> ground;
        Sf rooted[6] { flow: 0.0 } -> pole;
        1 bob[3] { I mass { inertia: 2.0 } }
        integral x: m = bob.f.y, initial: 1.2;
        integral y: m = bob.f.z;
        rope: PlanarLineForce {
            kind: rope, stiffness: stiffness, rest: 1.0, damping: 20.0, position_b: [x, y]
        } (ground, bob);
        1 stone[6] { I rock { inertia: 2.0 } }
        integral east: m = stone.f[3], initial: 1.2;
        integral north: m = stone.f[4];
        integral up: m = stone.f[5];
        line: LineForce {
            kind: rope, stiffness: stiffness, rest: 1.0, damping: 20.0, orientation_b: 1.0, position_b: [east, north, up]
        } (pole, stone);
        pulls: LineForce { kind: rope, rest: 1.0, damping: 5.0, orientation_b: 1.0, position_b: [east, north, up] } (pole, stone);
        output tensions[3]: N = [rope.tension, line.tension, pulls.tension];
    }
}

const GRAVITY: Vector3<f64> = Vector3::new(0.0, 0.0, -9.81);

fn hung() -> Hung<f64> {
    Hung::new(HungParameters::default()).unwrap()
}

/// The place of a state, by its name.
fn place(name: &str) -> usize {
    Hung::<f64>::META.state(name).unwrap()
}

/// A vector of the state, by the name of its first component without `x`.
fn vector(x: &SVector<f64, 26>, name: &str) -> Vector3<f64> {
    let first = place(&format!("{name}.x"));
    Vector3::new(x[first], x[first + 1], x[first + 2])
}

/// A body that flies, by its momenta in its own axes.
struct Flying {
    place: Vector3<f64>,
    turn: UnitQuaternion<f64>,
    mass: f64,
    inertia: Vector3<f64>,
    momentum: Vector3<f64>,
    spin: Vector3<f64>,
}

impl Flying {
    fn of(
        x: &SVector<f64, 26>,
        [joint, body]: [&str; 2],
        mass: f64,
        inertia: Vector3<f64>,
    ) -> Self {
        let first = place(&format!("{joint}.rotation.quaternion.0"));
        Self {
            place: vector(x, &format!("{joint}.position")),
            turn: UnitQuaternion::new_unchecked(Quaternion::new(
                x[first],
                x[first + 1],
                x[first + 2],
                x[first + 3],
            )),
            mass,
            inertia,
            momentum: vector(x, &format!("{body}.body.p")),
            spin: vector(x, &format!("{body}.spin.p")),
        }
    }

    fn rate(&self) -> Vector3<f64> {
        self.spin.component_div(&self.inertia)
    }

    /// A point of it and its velocity in the world.
    fn point(&self, by: Vector3<f64>) -> [Vector3<f64>; 2] {
        let velocity = self.momentum / self.mass + self.rate().cross(&by);
        [self.place + self.turn * by, self.turn * velocity]
    }

    /// By Newton and Euler, of forces in the world at points of it.
    fn rates(&self, forces: &[(Vector3<f64>, Vector3<f64>)]) -> [Vector3<f64>; 2] {
        let own = |force: &Vector3<f64>| self.turn.inverse() * force;
        let weight = own(&(self.mass * GRAVITY));
        let force = forces
            .iter()
            .fold(weight, |sum, (_, force)| sum + own(force));
        let moments = forces.iter().map(|(by, force)| by.cross(&own(force)));
        let moment: Vector3<f64> = moments.sum();
        let rate = self.rate();
        [
            force - rate.cross(&self.momentum),
            moment - rate.cross(&self.spin),
        ]
    }
}

/// The tension of a line, and the force that it has on its first end.
fn tension([a, b]: [[Vector3<f64>; 2]; 2], law: impl Fn(f64, f64) -> f64) -> Vector3<f64> {
    let span = b[0] - a[0];
    let rate = span.dot(&(b[1] - a[1])) / span.norm();
    span.normalize() * law(span.norm(), rate)
}

#[test]
fn bodies_on_lines_move_as_by_newton_and_euler() {
    let model = hung();
    let mut slack = 0;
    for number in 0..40 {
        // About the start, where the rope is taut and slack in turns.
        let mut x = model.initial_state();
        for (state, value) in x.iter_mut().enumerate() {
            *value += 0.3 * f64::sin(f64::from(number) * 1.7 + state as f64 * 2.3);
        }
        for joint in ["first", "second"] {
            let first = place(&format!("{joint}.rotation.quaternion.0"));
            let length = x.rows(first, 4).norm();
            x.rows_mut(first, 4).unscale_mut(length);
        }
        let wind = Vector3::new(0.3, -0.2, 0.1);
        let slopes = model.derivative(0.0, &x, &wind, &mut ());

        let inertia = Vector3::new(0.1, 0.2, 0.25);
        let platform = Flying::of(&x, ["first", "hull"], 2.0, inertia);
        let stone = Flying::of(&x, ["second", "rock"], 0.5, Vector3::repeat(0.01));
        let still = |x, y, z| [Vector3::new(x, y, z), Vector3::zeros()];
        let [left, right, below] =
            [[-0.3, 0.1, 0.05], [0.3, -0.1, 0.05], [0.0, 0.05, -0.1]].map(Vector3::from);
        let near = tension(
            [platform.point(left), still(-0.4, 0.0, 0.0)],
            |length, rate| 200.0 * (length - 1.0) + 1.5 * rate,
        );
        let far = tension(
            [platform.point(right), still(0.5, 0.3, 0.1)],
            |length, rate| 150.0 * (length - 1.1) + 2.0 * rate,
        );
        let ends = [platform.point(below), stone.point(Vector3::zeros())];
        slack += u32::from((ends[0][0] - ends[1][0]).norm() < 0.8);
        let rope = tension(ends, |length, rate| {
            3.0 + if length > 0.8 {
                f64::max(80.0 * (length - 0.8) + 0.7 * rate, 0.0)
            } else {
                0.0
            }
        });
        let forces = [
            (left, near),
            (right, far),
            (below, rope),
            (Vector3::zeros(), wind),
        ];
        let [force, moment] = platform.rates(&forces);
        let [falling, turning] = stone.rates(&[(Vector3::zeros(), -rope)]);
        for (name, expected) in [
            ("hull.body.p", force),
            ("hull.spin.p", moment),
            ("rock.body.p", falling),
            ("rock.spin.p", turning),
        ] {
            let found = vector(&slopes, name);
            assert!(
                (found - expected).norm() < 1e-11 * (1.0 + expected.norm()),
                "{name}: {found} instead of {expected}"
            );
        }
    }
    assert!((5..35).contains(&slack), "{slack} of 40 are slack");
}

#[test]
fn what_is_stored_is_in_the_balance_and_jacobians_are_right() {
    macro_rules! sound {
        ($model:ident, $parameters:ident) => {
            assert_sound_about_the_start((
                &$model::<f64>::new($parameters::default()).unwrap(),
                &$model::<Dual<f64>>::new($parameters::default()).unwrap(),
            ))
        };
    }
    sound!(Hung, HungParameters);
    sound!(Springy, SpringyParameters);
    sound!(Wound, WoundParameters);
    sound!(Container, ContainerParameters);
    sound!(Roped, RopedParameters);
}

/// The tension is 100 (length − 1) + 20 rate where that is not negative, with one more damper in space: it is what the momenta lose.
#[test]
fn ropes_do_not_push() {
    let model = Roped::<f64>::new(RopedParameters::default()).unwrap();
    for (length, rate, expected) in [
        (1.2, -10.0, 0.0),
        (1.2, -1.0, 0.0),
        (1.2, -0.5, 10.0),
        (1.2, 0.0, 20.0),
        (1.2, 1.0, 40.0),
        (1.0 + 1e-9, -1.0, 0.0),
        (0.9, 1.0, 0.0),
        (0.9, -1.0, 0.0),
    ] {
        let place = |name| Roped::<f64>::META.state(name).unwrap();
        let mut x = model.initial_state();
        let [bob, stone] = ["mass.p.y", "rock.p.3"].map(place);
        (x[place("x")], x[place("east")]) = (length, length);
        (x[bob], x[stone]) = (2.0 * rate, 2.0 * rate);
        let slopes = model.derivative(0.0, &x, &SVector::zeros(), &mut ());
        let is_long = f64::from(u8::from(length > 1.0));
        let more = is_long * f64::max(5.0 * rate, 0.0);
        for tension in [-slopes[bob], -slopes[stone] - more] {
            assert!(
                (tension - expected).abs() < 1e-12,
                "{length} {rate}: {tension} instead of {expected}"
            );
        }
        let told = model.output(0.0, &x, &SVector::zeros(), &mut ());
        assert!((told - SVector::from([expected, expected, more])).norm() < 1e-12);
        // What ropes take from a motion is stored or becomes heat, which is never negative.
        let power = model.power(0.0, &x, &SVector::zeros(), &mut ());
        let stored = is_long * 100.0 * (length - 1.0) * rate;
        let heat = 2.0 * (expected * rate - stored) + more * rate;
        assert!(
            (power.dissipated - heat).abs() < 1e-12 * (1.0 + heat),
            "{length} {rate}: {power:?} {heat}"
        );
        assert!(power.dissipated >= 0.0);
    }
}

#[test]
fn a_bob_on_a_spring_moves_as_in_polar_coordinates() {
    let model = Springy::new(SpringyParameters::default()).unwrap();
    let mut names = Springy::<f64>::META.states[2..].iter().map(|it| it.name);
    assert!(names.by_ref().eq(["across.travel", "up.travel"]));
    let mut last = model.initial_state();
    Adaptive::new(Dop853, 1e-12, 1e-12)
        .integrate(&model, &(), 0.0, 3.0, last, |step| last = *step.state())
        .unwrap();
    // Lagrange: r'' = r θ'² + g cos θ - k/m (r - l),  r θ'' = -2 r' θ' - g sin θ.
    let slope = |[r, angle, speed, turning]: [f64; 4]| {
        [
            speed,
            turning,
            r * turning * turning + 9.81 * angle.cos() - 30.0 / 1.5 * (r - 0.7),
            (-2.0 * speed * turning - 9.81 * angle.sin()) / r,
        ]
    };
    let mut polar = [f64::hypot(0.4, 0.8), f64::atan2(0.4, 0.8), 0.0, 0.0];
    let h = 1e-4;
    for _ in 0..30_000 {
        let ahead = |by: f64, k: [f64; 4]| std::array::from_fn(|it| polar[it] + by * k[it]);
        let a = slope(polar);
        let b = slope(ahead(h / 2.0, a));
        let c = slope(ahead(h / 2.0, b));
        let d = slope(ahead(h, c));
        polar = std::array::from_fn(|it| {
            polar[it] + h / 6.0 * (a[it] + 2.0 * b[it] + 2.0 * c[it] + d[it])
        });
    }
    let [r, angle, ..] = polar;
    let found = [last[2], last[3]];
    let expected = [r * angle.sin(), -r * angle.cos()];
    for (found, expected) in found.iter().zip(expected) {
        assert!(
            (found - expected).abs() < 1e-10,
            "{found} instead of {expected}"
        );
    }
}

#[test]
fn what_is_told_is_no_state() {
    let mut states = Wound::<f64>::META.states.iter().map(|it| it.name);
    assert!(states.all(|name| !name.contains("hemp") && !name.contains("coil")));
    let model = Wound::<f64>::new(WoundParameters::default()).unwrap();
    // 4 (2 · 0.2)² / 2 in the coil, 0.3 · 1² / 2 in the wheel.
    assert!((model.energy(0.0, &model.initial_state()) - (0.32 + 0.15)).abs() < 1e-15);
}
