//! A navigation system that comes near gimbal lock: its gimbals whirl, a quaternion notices nothing.

use std::error::Error;
use std::path::Path;

use mbg_runtime::{Pulse, System, mbg};
use nalgebra::Vector3;

use crate::draw::{BLUE, GREEN, ORANGE, PURPLE, Panel, picture};
use crate::run::{over, run};

mbg! { include "examples/gallery/navigation.mbg"; }

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let gust = Pulse {
        amplitude: Vector3::new(300.0, 1e4, 150.0),
        start: 1.0,
        end: 2.0,
    };
    let quaternion = NavigationQuaternion::<f64>::new(NavigationQuaternionParameters::default())?;
    let passing = run(&quaternion, &gust, quaternion.initial_state(), 10.0, 4000)?;
    let gimbals = NavigationAngles::<f64>::new(NavigationAnglesParameters::default())?;
    let whirling = run(&gimbals, &gust, gimbals.initial_state(), 10.0, 4000)?;

    let angle = |axis: usize| over(&whirling, move |it| it.output[axis].to_degrees());
    let angles = Panel::new("Gimbals", "time in s", "angle in °")
        .line("outer", BLUE, angle(0))
        .line("middle", ORANGE, angle(1))
        .line("inner", GREEN, angle(2));
    let component = |place: usize| over(&passing, move |it| it.output[3 + place]);
    let components = Panel::new("Quaternion", "time in s", "component")
        .line("w", PURPLE, component(0))
        .line("x", BLUE, component(1))
        .line("y", ORANGE, component(2))
        .line("z", GREEN, component(3));
    let still = Vector3::zeros();
    let conditioning = over(&whirling, |it| {
        gimbals.conditioning(it.time, &it.state, &still)[0]
            .abs()
            .log10()
    });
    let block = Panel::new(
        "Conditioning of the gimbals",
        "time in s",
        "log₁₀ of |cos(middle)|",
    )
    .line("what is divided by", ORANGE, conditioning);
    picture(
        path,
        "A rotorcraft pitches over: gimbals come near their lock, the quaternion has none",
        380,
        &[angles, components, block],
    )
}
