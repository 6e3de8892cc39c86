//! Running one architecture and comparing it with the reference.

use mbg_runtime::attitude::{euler_xyz, rotation_from_quaternion};
use mbg_runtime::{Adaptive, Dop853, Input, Integrator, Rk4, Stopped, System};
use nalgebra::{SVector, Vector3, Vector4};

use crate::reference::Instant;

/// What is shown of one instant, in SI units.
#[derive(Clone, Copy)]
pub(crate) struct Sample {
    /// Time.
    pub time: f64,
    /// Gimbal angles, rates of fuselage and platform, attitude, eq. (16), attitude of the
    /// platform: the outputs of the observed models.
    pub output: SVector<f64, 20>,
    /// Euler angles of the fuselage.
    pub euler: Vector3<f64>,
    /// Deviation of the platform.
    pub beta: Vector3<f64>,
}

/// How to integrate.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Method {
    /// The classical method of Runge and Kutta, one step from sample to sample.
    Rk4,
    /// The adaptive method of order 8 at this relative tolerance, samples interpolated.
    Dop853(f64),
}

/// Runs an observed model from rest and keeps what it shows every `step`.
///
/// # Errors
/// As the stepper.
pub(crate) fn run(
    model: &impl System<f64, 20, 3, 20>,
    method: Method,
    wind: &impl Input<f64, 3>,
    step: f64,
    end: f64,
) -> Result<Vec<Sample>, Stopped> {
    let mut samples = Vec::new();
    let still = SVector::<f64, 3>::zeros();
    let observer = |t: f64, x: &SVector<f64, 20>| {
        let output = model.output(t, x, &still, &mut Default::default());
        samples.push(sample(t, output));
    };
    let start = model.initial_state();
    match method {
        Method::Rk4 => Rk4::fixed(model, wind, 0.0, end, step, start, observer)?,
        Method::Dop853(tolerance) => {
            // The platform turns by less than a millionth of what the fuselage does.
            let solver = Adaptive::new(Dop853, tolerance, tolerance * 1e-6);
            let times: Vec<f64> = (0..)
                .map(|number| f64::from(number) * step)
                .take_while(|time| *time < end - 1e-9)
                .chain([end])
                .collect();
            solver.sample(model, wind, 0.0, start, &times, observer)?
        }
    };
    Ok(samples)
}

fn sample(time: f64, output: SVector<f64, 20>) -> Sample {
    let attitude =
        |first: usize| rotation_from_quaternion(&Vector4::from_fn(|row, _| output[first + row]));
    let (fuselage, platform) = (attitude(9), attitude(16));
    Sample {
        time,
        output,
        euler: euler_xyz(&fuselage),
        beta: euler_xyz(&platform),
    }
}

/// Name, value of a sample, value of the reference.
type Quantity = (
    &'static str,
    fn(&Sample) -> Vec<f64>,
    fn(&Instant) -> Vec<f64>,
);

/// Largest error of each quantity over the reference's instants, relative to the quantity's largest component value.
pub(crate) fn errors(samples: &[Sample], reference: &[Instant]) -> Vec<(&'static str, f64)> {
    let quantities: [Quantity; 7] = [
        (
            "gimbal angles",
            |s| s.output.as_slice()[0..3].to_vec(),
            |r| r.alpha.to_vec(),
        ),
        (
            "fuselage rate",
            |s| s.output.as_slice()[3..6].to_vec(),
            |r| r.fuselage.to_vec(),
        ),
        (
            "platform rate",
            |s| s.output.as_slice()[6..9].to_vec(),
            |r| r.platform.to_vec(),
        ),
        (
            "attitude",
            |s| s.output.as_slice()[9..13].to_vec(),
            |r| r.attitude.to_vec(),
        ),
        (
            "eq. (16)",
            |s| s.output.as_slice()[13..16].to_vec(),
            |r| r.estimate.to_vec(),
        ),
        (
            "Euler angles",
            |s| s.euler.as_slice().to_vec(),
            |r| r.euler.to_vec(),
        ),
        (
            "platform deviation",
            |s| s.beta.as_slice().to_vec(),
            |r| r.beta.to_vec(),
        ),
    ];
    quantities
        .into_iter()
        .map(|(name, ours, theirs)| (name, error(samples, reference, ours, theirs)))
        .collect()
}

fn error(
    samples: &[Sample],
    reference: &[Instant],
    ours: fn(&Sample) -> Vec<f64>,
    theirs: fn(&Instant) -> Vec<f64>,
) -> f64 {
    let components = reference.first().map_or(0, |instant| theirs(instant).len());
    let mut worst = 0.0_f64;
    for component in 0..components {
        let scale = samples
            .iter()
            .map(|sample| ours(sample)[component].abs())
            .fold(0.0, f64::max);
        for instant in reference {
            let Some(sample) = nearest(samples, instant.time) else {
                return f64::NAN;
            };
            let difference = ours(sample)[component] - theirs(instant)[component];
            worst = worst.max(difference.abs() / scale.max(f64::MIN_POSITIVE));
        }
    }
    worst
}

/// The sample at a time of the grid; none if the run did not reach it.
fn nearest(samples: &[Sample], time: f64) -> Option<&Sample> {
    let position = samples.partition_point(|sample| sample.time < time - 1e-9);
    samples
        .get(position)
        .filter(|sample| (sample.time - time).abs() < 1e-9)
}
