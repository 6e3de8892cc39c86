//! Closed loops of machines of nanometres to kilometres: in units of their size they start and move as those of metres do.
#![allow(clippy::unwrap_used, missing_docs)]

use mbg_runtime::{Adaptive, Integrator, Real, Rk4, System, Tsit5, mbg};
use nalgebra::SVector;

mbg! {
    /// A slider-crank whose guide holds an angle beside a length.
    #[derivative]
    model Guided {
        causality componentwise;
        param length: m = 1.0;
        param mass: kg = 1.0;
        let inertia = mass * length * length / 12.0;
        1 ground[3]; 1 crank[3]; 1 pin[3]; 1 rod[3]; 1 end[3]; 1 slide[3];
        Sf fixed[3] { flow: 0.0 } -> ground;
        first: PlanarRevolute { initial: 0.7, initial_rate: 10.0 } (ground, crank);
        cranked: PlanarBody { mass: mass, inertia: inertia } (crank);
        arm: PlanarOffset { x: length } (crank, pin);
        second: PlanarRevolute { initial: -0.7 - asin(0.5 * sin(0.7)) } (pin, rod);
        pushed: PlanarBody { mass: mass, inertia: inertia } (rod);
        long: PlanarOffset { x: 2.0 * length } (rod, end);
        third: PlanarRevolute { initial: asin(0.5 * sin(0.7)) } (end, slide);
        slid: PlanarBody { mass: mass, inertia: inertia } (slide);
        guide: PlanarCut { joint: prismatic } (ground, slide);
        output rates[2]: rad/s = [first.rate.f, second.rate.f];
        output angles[2]: rad = [first.angle, second.angle];
    }

    /// One whose slide has its way and its momentum for states.
    #[derivative]
    model Piston {
        causality componentwise;
        param length: m = 1.0;
        param mass: kg = 1.0;
        let inertia = mass * length * length / 12.0;
        1 ground[3]; 1 crank[3]; 1 pin[3]; 1 rod[3]; 1 end[3]; 1 slide[3];
        Sf fixed[3] { flow: 0.0 } -> ground;
        first: PlanarRevolute { initial: 0.7, initial_rate: 10.0 } (ground, crank);
        cranked: PlanarBody { mass: mass, inertia: inertia } (crank);
        arm: PlanarOffset { x: length } (crank, pin);
        second: PlanarRevolute { initial: -0.7 - asin(0.5 * sin(0.7)) } (pin, rod);
        pushed: PlanarBody { mass: mass, inertia: inertia } (rod);
        long: PlanarOffset { x: 2.0 * length } (rod, end);
        guide: PlanarPrismatic { initial: length * (cos(0.7) + sqrt(4.0 - sin(0.7) * sin(0.7))) } (ground, slide);
        block: PlanarPointMass { mass: mass } (slide);
        pinned: PlanarCut { joint: revolute } (end, slide);
        output rates[2]: rad/s = [first.rate.f, second.rate.f];
        output angles[2]: rad = [first.angle, second.angle];
    }

    #[derivative]
    model Planar {
        causality componentwise;
        param length: m = 1.0;
        param mass: kg = 1.0;
        let inertia = mass * length * length / 12.0;
        1 ground[3]; 1 crank[3]; 1 tip[3]; 1 coupler[3]; 1 end[3]; 1 stand[3]; 1 rocker[3]; 1 top[3];
        Sf fixed[3] { flow: 0.0 } -> ground;
        shift: PlanarOffset { x: 3.0 * length } (ground, stand);
        one: PlanarRevolute { initial: 1.2, initial_rate: 10.0 } (ground, crank);
        first: PlanarOffset { x: length } (crank, tip);
        light: PlanarBody { mass: mass, inertia: inertia } (crank);
        two: PlanarRevolute { initial: -0.838_566_056_505_287_5 } (tip, coupler);
        second: PlanarOffset { x: 3.0 * length } (coupler, end);
        long: PlanarBody { mass: mass, inertia: 10.0 * inertia } (coupler);
        three: PlanarRevolute { initial: 1.486_431_327_373_772_8 } (stand, rocker);
        third: PlanarOffset { x: 2.0 * length } (rocker, top);
        heavy: PlanarBody { mass: mass, inertia: inertia } (rocker);
        pin: PlanarCut { joint: revolute } (end, top);
        output rates[2]: rad/s = [one.rate.f, two.rate.f];
        output angles[2]: rad = [one.angle, two.angle];
    }

    /// A four-bar of hinges in space. What holds it in its plane is redundant, and zero but for rounding, as its base is turned.
    #[derivative]
    model Tilted {
        causality componentwise;
        param length: m = 1.0;
        param mass: kg = 1.0;
        let inertia = mass * length * length / 12.0;
        1 world[6]; 1 base[6]; 1 crank[6]; 1 tip[6]; 1 coupler[6]; 1 end[6]; 1 stand[6]; 1 rocker[6]; 1 top[6];
        Sf fixed[6] { flow: 0.0 } -> world;
        turned: Turn { by: rot_x(0.3) * rot_y(0.2) } (world, base);
        one: Revolute { axis: 2, initial: 1.2, initial_rate: 10.0 } (base, crank);
        short: Body { mass: mass, inertia: diag(inertia, inertia, inertia) } (crank);
        first: Offset { by: [length, 0.0, 0.0] } (crank, tip);
        two: Revolute { axis: 2, initial: -0.838_566_056_505_287_5 } (tip, coupler);
        long: Body { mass: mass, inertia: diag(inertia, inertia, inertia) } (coupler);
        second: Offset { by: [3.0 * length, 0.0, 0.0] } (coupler, end);
        apart: Offset { by: [3.0 * length, 0.0, 0.0] } (base, stand);
        three: Revolute { axis: 2, initial: 1.486_431_327_373_772_8 } (stand, rocker);
        heavy: Body { mass: mass, inertia: diag(inertia, inertia, inertia) } (rocker);
        third: Offset { by: [2.0 * length, 0.0, 0.0] } (rocker, top);
        cut: Cut { joint: revolute } (end, top);
        output rates[2]: rad/s = [one.rate.f, two.rate.f];
        output angles[2]: rad = [one.angle, two.angle];
    }
}

/// Rates and angles at the start, and after half a second by two methods.
fn seen<T: Real, S: System<T, 6, 0, 4, Memory = ()>>(system: &S) -> [[f64; 4]; 3] {
    let [start, end, step] = [0.0, 0.5, 1e-3].map(T::from_f64);
    let look = |x: &SVector<T, 6>| {
        let outputs = system.output(start, x, &SVector::from([]), &mut ());
        outputs.map(|it| it.find(|_| true).unwrap()).into()
    };
    let first = system.initial_state();
    let mut ends = [first; 2];
    Rk4::fixed(system, &(), start, end, step, first, |_, x| ends[0] = *x).unwrap();
    Adaptive::new(Tsit5, 1e-5, 1e-30)
        .integrate(system, &(), start, end, first, |step| {
            ends[1] = *step.state()
        })
        .unwrap();
    [look(&first), look(&ends[0]), look(&ends[1])]
}

/// Lengths and masses in which a machine is to be as one of a metre and a kilogram.
const SIZES: [[f64; 2]; 11] = [
    [1e-9, 1e-9],
    [1e-8, 1.0],
    [1e-7, 1e-6],
    [4e-7, 1.0],
    [1e-6, 1.0],
    [1e-6, 1e-12],
    [1e-5, 1e-12],
    [1e-3, 1e-9],
    [1e-1, 1e-3],
    [100.0, 1.0],
    [1e3, 1e6],
];

macro_rules! sizes {
    ($($test:ident: $model:ident, $parameters:ident;)*) => { $(
        #[test]
        fn $test() {
            fn found<T: Real>([length, mass]: [f64; 2]) -> [[f64; 4]; 3] {
                let [length, mass] = [length, mass].map(T::from_f64);
                seen::<T, $model<T>>(&$model::new($parameters { length, mass }).unwrap())
            }
            compare(found::<f64>, found::<f32>);
        }
    )* };
}

sizes! {
    slider_cranks_whose_guide_holds_an_angle: Guided, GuidedParameters;
    slider_cranks_with_a_way: Piston, PistonParameters;
    four_bars_in_a_plane: Planar, PlanarParameters;
    four_bars_of_hinges_in_space: Tilted, TiltedParameters;
}

fn compare(double: fn([f64; 2]) -> [[f64; 4]; 3], single: fn([f64; 2]) -> [[f64; 4]; 3]) {
    let usual = double([1.0, 1.0]);
    // The rate that is given.
    assert!((usual[0][0] - 10.0).abs() < 1e-12, "{}", usual[0][0]);
    for size in SIZES {
        let compare = |found: [[f64; 4]; 3], bounds: [f64; 3]| {
            for ((found, usual), bound) in found.iter().zip(&usual).zip(bounds) {
                for (found, usual) in found.iter().zip(usual) {
                    assert!((found - usual).abs() < bound, "{size:?} {found} {usual}");
                }
            }
        };
        // Adaptive steps are others where a state is a momentum.
        compare(double(size), [1e-11, 1e-6, 1e-2]);
        compare(single(size), [1e-4, 2e-3, 1e-2]);
    }
}
