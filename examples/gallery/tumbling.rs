//! A free body about its middle axis of inertia.

use std::error::Error;
use std::path::Path;

use mbg_runtime::{System, mbg};
use nalgebra::Vector3;

use crate::draw::{BLUE, GREEN, GREY, ORANGE, Panel, picture};
use crate::run::{over, run};
use crate::space::{Place, View, on_sphere, sphere};

mbg! { include "examples/tumbling.mbg"; }

pub(crate) fn draw(path: &Path) -> Result<(), Box<dyn Error>> {
    let body = Tumbling::<f64>::new(TumblingParameters::default())?;
    let found = run(&body, &(), body.initial_state(), 30.0, 3000)?;
    let rate = |axis: usize| over(&found, |it| it.output[axis]);
    let rates = Panel::new("In axes of the body", "time in s", "rate in rad/s")
        .line("x, least inertia", BLUE, rate(0))
        .line("y, middle", ORANGE, rate(1))
        .line("z, greatest", GREEN, rate(2));

    let view = View::from(58.0, 24.0);
    let title = "Angular momentum in axes of the body";
    let mut polhodes = sphere(Panel::view(title).weight(0.75), view);
    let momentum = 10.0;
    for degrees in [15.0_f64, 30.0, 45.0, 60.0, 75.0] {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        for (direction, color) in [
            (Vector3::new(cosine, sine, 0.0), BLUE),
            (Vector3::new(-cosine, sine, 0.0), BLUE),
            (Vector3::new(0.0, sine, cosine), GREEN),
            (Vector3::new(0.0, sine, -cosine), GREEN),
        ] {
            let mut start = body.initial_state();
            start
                .fixed_rows_mut::<3>(0)
                .copy_from(&(momentum * direction));
            let way = run(&body, &(), start, 7.0, 700)?;
            let way: Vec<Place> = way.iter().map(|it| on_unit(it.state.as_slice())).collect();
            polhodes = on_sphere(polhodes, view, color, 1, 0.8, &way);
        }
    }
    let way: Vec<Place> = found
        .iter()
        .map(|it| on_unit(it.state.as_slice()))
        .collect();
    polhodes = on_sphere(polhodes, view, ORANGE, 2, 1.0, &way);
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let mut end = [0.0; 3];
        end[axis] = 1.0;
        let mut word = end;
        (end[axis], word[axis]) = (1.2, 1.3);
        let mut start = end;
        start[axis] = 1.0;
        polhodes = polhodes
            .stroke(GREY, 1.0, 2, view.path(&[start, end]))
            .label(name, view.seen(word));
    }
    picture(
        path,
        "A body that turns about its middle axis flips over, again and again",
        430,
        &[rates, polhodes],
    )
}

/// The momentum, the first three states, as a direction.
fn on_unit(state: &[f64]) -> Place {
    let momentum = Vector3::new(state[0], state[1], state[2]);
    momentum.normalize().into()
}
