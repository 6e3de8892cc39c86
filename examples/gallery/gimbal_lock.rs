//! A navigation system whose gimbals lock, and one with a quaternion, which does not.

use std::error::Error;
use std::path::Path;

use mbg_runtime::{DormandPrince, Pulse, System, mbg};
use nalgebra::Vector3;

use crate::draw::{BLUE, GREY, ORANGE, Panel, picture};
use crate::run::{over, run};

mbg! { include "examples/gallery/navigation.mbg"; }

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let gust = Pulse {
        amplitude: Vector3::new(0.0, 1e4, 0.0),
        start: 1.0,
        end: 2.0,
    };
    let quaternion = NavigationQuaternion::<f64>::new(NavigationQuaternionParameters::default())?;
    let found = run(&quaternion, &gust, quaternion.initial_state(), 20.0, 2000)?;
    let gimbals = NavigationAngles::<f64>::new(NavigationAnglesParameters::default())?;
    let (mut pitch, mut conditioning) = (Vec::new(), Vec::new());
    let stopped = DormandPrince::new(1e-10, 1e-13).integrate(
        &gimbals,
        &gust,
        0.0,
        20.0,
        gimbals.initial_state(),
        |step| {
            let (t, u) = (step.end(), Vector3::zeros());
            let output = gimbals.output(t, step.state(), &u, &mut ());
            pitch.push((t, -output[1].to_degrees()));
            conditioning.push((t, gimbals.conditioning(t, step.state(), &u)[0].abs()));
        },
    );
    println!("{stopped:?} {:?}", conditioning.last());
    let last = |points: &[(f64, f64)]| points.last().copied().into_iter().collect::<Vec<_>>();
    let end = (last(&pitch), last(&conditioning));
    let turned = over(&found, |it| {
        // The platform stays; what turns against it is the fuselage.
        let half = (-it.output[5]).atan2(it.output[3]);
        2.0 * half.to_degrees()
    });
    let attitudes = Panel::new("Pitch", "time in s", "angle in °")
        .line("with a quaternion", BLUE, turned)
        .line("with three gimbals", ORANGE, pitch)
        .dots("stopped", GREY, 5, end.0);
    let cosine = over(&found, |it| it.output[4 - 3].cos().abs());
    let blocks = Panel::new("Conditioning of the gimbals", "time in s", "determinant")
        .dashes("at the quaternion's attitude", BLUE, cosine)
        .line("of the run with gimbals", ORANGE, conditioning)
        .dots("stopped", GREY, 5, end.1);
    picture(
        path,
        "A rotorcraft pitches over: the gimbals lock, the quaternion passes",
        400,
        &[attitudes, blocks],
    )
}
