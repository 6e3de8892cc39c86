//! Twenty seconds of the INS in a gust, in steps of constant length.

use core::hint::black_box;

use mbg_runtime::{Real, Rk4, System};
use nalgebra::SVector;

use crate::digest::Digest;
use crate::reference::{Instant, PULSE};
use crate::{measure, print};

/// Steps in a second.
const RATE: u32 = 100;
/// Length of the flight in seconds.
const SECONDS: u32 = 20;
/// Seconds between two rows of the table.
const ROWS: u32 = 2;
/// Steps during which the gust blows.
const GUST: core::ops::Range<u32> = RATE..RATE + RATE / 10;

/// What is kept from step to step.
#[derive(Clone, Copy)]
pub(crate) struct State<T, const N: usize> {
    x: SVector<T, N>,
    /// What rounding has taken off the sums.
    lost: SVector<T, N>,
}

/// One step of the state of a model, at a time and with a torque of the wind. It tells whether the state can be trusted.
pub(crate) type Step<S, T, const N: usize> = fn(&S, T, &SVector<T, 3>, &mut State<T, N>) -> bool;

fn length<T: Real>() -> T {
    T::from_f64(1.0 / f64::from(RATE))
}

/// The steps that a controller's loop may make.
pub(crate) trait Steps<T: Real, const N: usize, const P: usize>:
    System<T, N, 3, P, Memory = ()> + Sized
{
    /// The step alone.
    #[inline(never)]
    fn plain(&self, t: T, wind: &SVector<T, 3>, state: &mut State<T, N>) -> bool {
        state.x = Rk4::step(self, t, &state.x, wind, length(), &mut ());
        true
    }

    /// With compensated sums.
    #[inline(never)]
    fn compensated(&self, t: T, wind: &SVector<T, 3>, state: &mut State<T, N>) -> bool {
        let State { x, lost } = state;
        *x = Rk4::compensated_step(self, t, x, wind, length(), lost, &mut ());
        true
    }

    /// With compensated sums, attitudes made rotations again, and the singular set watched.
    #[inline(never)]
    fn guarded(&self, t: T, wind: &SVector<T, 3>, state: &mut State<T, N>) -> bool {
        let State { x, lost } = state;
        let next = Rk4::compensated_step(self, t, x, wind, length(), lost, &mut ());
        let t = t + length();
        match self.close(t, next, wind, &[]) {
            Ok(closed) => *x = closed,
            Err(_) => return false,
        }
        self.trouble(t, x, wind, &()).is_none()
    }
}

impl<S, T: Real, const N: usize, const P: usize> Steps<T, N, P> for S where
    S: System<T, N, 3, P, Memory = ()>
{
}

/// Flies, and prints trajectory, error, all bits in one number, and cost. Whether every state could be trusted, and no
/// error is above `bound`.
pub(crate) fn fly<T, S, const N: usize, const P: usize>(
    title: &str,
    model: &S,
    step: Step<S, T, N>,
    bound: f64,
) -> bool
where
    T: Real,
    S: System<T, N, 3, P, Memory = ()>,
{
    print::line(title);
    let zero = SVector::from_element(T::from_f64(0.0));
    let mut state = State {
        x: model.initial_state(),
        lost: zero,
    };
    let (mut digest, mut cost, mut error) = (Digest::new(), Cost::new(), Error::default());
    for number in 0..=SECONDS * RATE {
        let t = T::from_f64(f64::from(number) / f64::from(RATE));
        let wind = if GUST.contains(&number) {
            SVector::from([5000.0, 1000.0, 10000.0].map(T::from_f64))
        } else {
            zero.fixed_rows::<3>(0).into_owned()
        };
        let output = model.output(t, &state.x, &wind, &mut ()).map(seen);
        error.look(number, &output);
        if number % (ROWS * RATE) == 0 {
            row(number / RATE, &output);
            cost.look(model, t, &wind, &state, step);
        }
        if !step(model, t, &wind, &mut state) {
            print::line("the state cannot be trusted any more");
            return false;
        }
        for component in &state.x {
            digest.add(seen(*component));
        }
    }
    error.print();
    digest.print();
    cost.print();
    error.within(bound)
}

fn seen<T: Real>(number: T) -> f64 {
    number.find(|_| true).unwrap_or(f64::NAN)
}

/// Gimbal angles, and their estimate where there is one.
fn row<const P: usize>(second: u32, output: &SVector<f64, P>) {
    print::integer(u64::from(second), 4);
    let angles = output.iter().take(3).chain(output.iter().skip(13).take(3));
    angles.for_each(|angle| print::decimal(*angle));
    print::line("");
}

/// Gimbal angles and their estimate against the reference.
#[derive(Default)]
struct Error {
    angles: Difference,
    estimate: Difference,
}

impl Error {
    fn look<const P: usize>(&mut self, number: u32, output: &SVector<f64, P>) {
        let steps = |instant: &Instant| instant.time * f64::from(RATE);
        let here = |instant: &&Instant| (steps(instant) - f64::from(number)).abs() < 0.1;
        for instant in PULSE.iter().filter(here) {
            self.angles.look(output.iter(), &instant.alpha);
            self.estimate
                .look(output.iter().skip(13), &instant.estimate);
        }
    }

    fn print(&self) {
        self.angles
            .print("largest error of the gimbal angles, relative to the largest ");
        self.estimate
            .print("largest error of the estimate, relative to the largest ");
    }

    fn within(&self, bound: f64) -> bool {
        [&self.angles, &self.estimate]
            .iter()
            .all(|difference| difference.largest <= bound * difference.value)
    }
}

/// Largest difference from the reference, and the reference's largest value; zero where nothing was looked at.
#[derive(Default)]
struct Difference {
    largest: f64,
    value: f64,
}

impl Difference {
    fn look<'a>(&mut self, numbers: impl Iterator<Item = &'a f64>, reference: &[f64; 3]) {
        for (number, reference) in numbers.zip(reference) {
            let difference = (number - reference).abs();
            if difference > self.largest || difference.is_nan() {
                self.largest = difference;
            }
            self.value = self.value.max(reference.abs());
        }
    }

    fn print(&self, name: &str) {
        if self.value > 0.0 {
            print::text(name);
            print::scientific(self.largest / self.value);
            print::line("");
        }
    }
}

/// What a step costs, over all states looked at.
struct Cost {
    least: u64,
    most: u64,
    stack: u64,
    /// Instructions and stack where the gimbals have turned thousands of times.
    far: (u64, u64),
}

impl Cost {
    const fn new() -> Self {
        Self {
            least: u64::MAX,
            most: 0,
            stack: 0,
            far: (0, 0),
        }
    }

    /// Measures a step from the state, from its opposite, from near rest, from far away, and from very far away.
    fn look<T: Real, S, const N: usize>(
        &mut self,
        model: &S,
        t: T,
        wind: &SVector<T, 3>,
        state: &State<T, N>,
        step: Step<S, T, N>,
    ) {
        let measured = |factor: f64| {
            let factor = T::from_f64(factor);
            let from = State {
                x: state.x.map(|component| factor * component),
                ..*state
            };
            let repeated = |step: Option<Step<S, T, N>>| {
                measure::instructions(|| {
                    let mut state = from;
                    if let Some(step) = step {
                        step(black_box(model), t, wind, &mut state);
                    }
                    black_box(&mut state);
                })
            };
            let count = repeated(Some(step)).saturating_sub(repeated(None));
            let mut state = from;
            let stack = measure::stack(|| _ = black_box(step)(model, t, wind, &mut state));
            (count, stack)
        };
        for factor in [1.0, -1.0, 1e-3, 30.0] {
            let (count, stack) = measured(factor);
            (self.least, self.most) = (self.least.min(count), self.most.max(count));
            self.stack = self.stack.max(stack);
        }
        let (count, stack) = measured(1e5);
        self.far = (self.far.0.max(count), self.far.1.max(stack));
    }

    fn print(&self) {
        let (count, stack) = self.far;
        let numbers = [
            ("instructions per step ", self.least),
            (" to ", self.most),
            (", far away up to ", count),
            ("\nbytes of stack per step ", self.stack),
            (", far away ", stack),
        ];
        for (name, number) in numbers {
            print::text(name);
            print::integer(number, 1);
        }
        print::line("\n");
    }
}
