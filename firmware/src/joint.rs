//! A joint of a robot that dry friction holds and lets go, by a run of one step for each tick of its controller.

use core::hint::black_box;

use mbg_runtime::{Constant, Fixed, Integrator, Rk4, System, mbg};
use nalgebra::SVector;

use crate::digest::Digest;
use crate::{measure, print};

mbg! {
    /// A motor with its gear, and what rubs there.
    model Joint {
        param inertia: kg*m^2 = 0.02;
        param friction: N*m = 0.5;
        input torque: N*m;
        1 shaft {
            I rotor { inertia: inertia }
            R gear { effort: friction * sign(f) }
            Se motor { effort: torque }
        }
        integral angle: rad = shaft.f;
        output turned: rad = angle;
    }
}

type State = SVector<f32, 2>;

/// Length of a tick in seconds.
const TICK: f32 = 0.01;
/// Ticks of the motion, of which the torque goes up and down again in so many.
const TICKS: u32 = 800;
const PERIOD: u32 = 400;
/// Ticks between two that are measured.
const APART: u32 = 10;
/// The largest error of the angle, relative to the largest angle.
const BOUND: f64 = 1e-6;

/// Up to twice what friction holds, to both sides.
fn torque(tick: u32) -> f32 {
    let along = (tick % PERIOD) as f32 / PERIOD as f32;
    let there = if along < 0.5 { along } else { 1.0 - along };
    4.0 * there - 1.0
}

/// One tick; whether it ended.
#[inline(never)]
fn step(model: &Joint<f32>, torque: f32, x: &mut State) -> bool {
    let (input, start) = (Constant(SVector::from([torque])), *x);
    let solver = Fixed::new(Rk4, f64::from(TICK));
    let ran = solver.integrate(model, &input, 0.0, TICK, start, |step| *x = *step.state());
    ran.is_ok()
}

/// The motion in closed form.
#[derive(Clone, Copy, Default)]
struct Exact {
    speed: f64,
    angle: f64,
}

impl Exact {
    /// A tick, of which what slows down takes a part until it is at rest.
    fn step(&mut self, torque: f64) {
        let (parameters, mut rest) = (JointParameters::<f64>::default(), f64::from(TICK));
        while rest > 0.0 {
            let way = if self.speed == 0.0 {
                torque
            } else {
                self.speed
            };
            let force = torque - parameters.friction.copysign(way);
            let rate = force / parameters.inertia;
            if self.speed == 0.0 && force * torque <= 0.0 {
                return;
            }
            let until_rest = -self.speed / rate;
            let time = match until_rest > 0.0 && until_rest < rest {
                true => until_rest,
                false => rest,
            };
            self.angle += time * (self.speed + 0.5 * time * rate);
            self.speed = if time < rest {
                0.0
            } else {
                self.speed + time * rate
            };
            rest -= time;
        }
    }
}

/// What ticks cost of one kind.
struct Cost {
    title: &'static str,
    least: u64,
    most: u64,
    stack: u64,
}

impl Cost {
    const fn of(title: &'static str) -> Self {
        Self {
            title,
            least: u64::MAX,
            most: 0,
            stack: 0,
        }
    }

    fn look(&mut self, model: &Joint<f32>, torque: f32, x: &State) {
        let repeated = |is_stepped: bool| {
            measure::instructions(|| {
                let mut x = *x;
                if is_stepped {
                    black_box(step(black_box(model), torque, &mut x));
                }
                black_box(&mut x);
            })
        };
        let count = repeated(true).saturating_sub(repeated(false));
        (self.least, self.most) = (self.least.min(count), self.most.max(count));
        let mut x = *x;
        let stack = measure::stack(|| _ = black_box(step)(model, torque, &mut x));
        self.stack = self.stack.max(stack);
    }

    fn print(&self) {
        print::line(self.title);
        let numbers = [
            ("instructions per step ", self.least),
            (" to ", self.most),
            ("\nbytes of stack per step ", self.stack),
        ];
        for (name, number) in numbers {
            print::text(name);
            print::integer(number, 1);
        }
        print::line("\n");
    }
}

/// Moves the joint, and prints its error, all bits in one number, and what ticks cost; whether it stayed within its bound of error.
pub(crate) fn moves() -> bool {
    let Ok(model) = Joint::<f32>::new(JointParameters::default()) else {
        return false;
    };
    let (mut x, mut exact, mut digest) = (model.initial_state(), Exact::default(), Digest::new());
    let titles = [
        "Joint, f32, slips",
        "Joint, f32, holds",
        "Joint, f32, between",
    ];
    let [mut slips, mut holds, mut between] = titles.map(Cost::of);
    let (mut largest, mut error) = (0.0_f64, 0.0_f64);
    for tick in 0..TICKS {
        let (before, start) = (exact, x);
        exact.step(f64::from(torque(tick)));
        let cost = match (before.speed, exact.speed) {
            (0.0, 0.0) => &mut holds,
            (before, behind) if before * behind > 0.0 => &mut slips,
            _ => &mut between,
        };
        if tick % APART == 0 || before.speed * exact.speed <= 0.0 && before.speed != exact.speed {
            cost.look(&model, torque(tick), &start);
        }
        if !step(&model, torque(tick), &mut x) {
            print::line("the joint cannot be moved any more");
            return false;
        }
        x.iter()
            .for_each(|component| digest.add(f64::from(*component)));
        largest = largest.max(exact.angle.abs());
        error = error.max((f64::from(x[1]) - exact.angle).abs());
    }
    print::text("Joint, f32: error of the angle ");
    print::scientific(error / largest);
    print::line("");
    digest.print();
    [slips, holds, between].iter().for_each(Cost::print);
    error < BOUND * largest
}
