//! A step of the compass walker: it swings until a foot strikes the slope, which changes its rates.

use std::error::Error;

use mbg_runtime::{
    Adaptive, Arrival, Direction, Dop853, Integrator, Linearised, Step, System, mbg,
};
use nalgebra::SVector;

mbg! { include "examples/gallery/walker.mbg"; }

/// Angles of the leg on the ground against the slope's normal and of the other leg against it, and their rates.
pub(crate) const STATES: [&str; 4] = [
    "compass.ankle.angle",
    "compass.hinge.angle",
    "compass.ankle.rate.f",
    "compass.hinge.rate.f",
];

/// The places of these states in a model.
fn places<S, const N: usize, const M: usize, const P: usize>(
    _: &S,
) -> Result<[usize; 4], &'static str>
where
    S: System<f64, N, M, P>,
{
    let mut places = [0; 4];
    for (place, name) in places.iter_mut().zip(STATES) {
        *place = S::META.state(name).ok_or("a state has another name")?;
    }
    Ok(places)
}

/// Swings until the foot in the air strikes.
pub(crate) fn swing(
    walker: &Walker<f64>,
    start: SVector<f64, 4>,
    observer: impl FnMut(&mut Step<'_, f64, 4>),
) -> Result<Arrival<f64, 4>, Box<dyn Error>> {
    let [ankle, hinge, ..] = places(walker)?;
    // Both feet are on the slope where the legs stand opposite to each other. Beside each other they pass, the foot below
    // the slope, which a walker without knees cannot help.
    let opposite = |_, x: &SVector<f64, 4>| 2.0 * x[ankle] + x[hinge];
    let falling = (Direction::Falling, opposite);
    let solver = Adaptive::new(Dop853, 1e-12, 1e-14);
    let arrival = solver.until(walker, &(), 0.0, 2.0, start, falling, observer)?;
    if arrival.found {
        Ok(arrival)
    } else {
        Err("the foot never strikes".into())
    }
}

/// The state behind a strike, with the legs in exchanged roles.
pub(crate) fn strike(
    walker: &Walker<f64>,
    struck: &Struck<f64>,
    before: &SVector<f64, 4>,
) -> Result<SVector<f64, 4>, Box<dyn Error>> {
    let own = places(walker)?;
    let free = places(struck)?;
    // The foot that stood is free to go: it is where the slides are at zero and at rest.
    let mut state = struck.initial_state();
    for (own, free) in own.into_iter().zip(free) {
        state[free] = before[own];
    }
    // An impulse changes rates as a force changes their derivatives, and this one stops the foot that strikes.
    let still = SVector::zeros();
    let speed = struck.output(0.0, &state, &still, &mut Default::default());
    let near = Linearised::of(struck, 0.0, &state, &still).map_err(|it| it.to_string())?;
    let mobility = (near.output * near.input).try_inverse();
    let impulse = -(mobility.ok_or("nothing moves")? * speed);
    state += near.input * impulse;

    let [stance, between, rate, relative] = free.map(|place| state[place]);
    let mut after = SVector::zeros();
    for (place, value) in
        own.into_iter()
            .zip([stance + between, -between, rate + relative, -relative])
    {
        after[place] = value;
    }
    Ok(after)
}
