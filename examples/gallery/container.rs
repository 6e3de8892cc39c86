//! A container on four ropes below a trolley.

use std::error::Error;
use std::path::Path;

use mbg_runtime::{Trim, mbg};

use crate::draw::{BLUE, GREEN, GREY, ORANGE, Panel, picture};
use crate::run::{over, run};

mbg! { include "examples/gallery/container.mbg"; }

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let container = Container::<f64>::new(ContainerParameters::default())?;
    // It hangs still below the moving trolley, askew since its load is.
    let start = Trim::new(&container)
        .rate("rail.travel", 2.0)
        .rate("free.position.x", 2.0)
        .fix("rail.travel")
        .solve()?
        .state;
    let found = run(&container, &(), start, 16.0, 3200)?;
    let force = |rope: usize| over(&found, move |it| 1e-3 * it.output[rope]);
    let tensions = Panel::new("Tensions of the ropes", "time in s", "tension in kN")
        .line("fore, left", BLUE, force(0))
        .line("fore, right", GREEN, force(1))
        .line("aft, left", ORANGE, force(2))
        .line("aft, right", GREY, force(3));
    let swings = Panel::new("Sway and pitch", "time in s", "sway in m, pitch in degrees")
        .line("sway", BLUE, over(&found, |it| it.output[4]))
        .line(
            "pitch",
            ORANGE,
            over(&found, |it| it.output[5].to_degrees()),
        );
    picture(
        path,
        "A container of 8 t on four ropes; its trolley brakes at 4 s",
        400,
        &[tensions, swings],
    )
}
