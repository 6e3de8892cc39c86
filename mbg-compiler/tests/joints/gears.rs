//! Gears and racks: what turns or slides with a wheel counts as inertia of the wheel, and nothing is lost between teeth.

use mbg_compiler::compile::Routines;

use crate::scene::Scene;

/// A motor on a wheel of radius 0.2 and inertia 0.3, and what it drives.
fn driven(coupling: &str, second: &str) -> Scene {
    Scene::of(&format!(
        "#[derivative] model Driven {{
            causality componentwise;
            1 ground[6]; 1 first[6]; 1 second[6];
            Sf fixed[6] {{ flow: 0.0 }} -> ground;
            wheel: Revolute {{ axis: 2, torque: 1.5 }} (ground, first);
            inertia: Body {{ mass: 1.0, inertia: diag(0.1, 0.2, 0.3) }} (first);
            {second}
            load: Body {{ mass: 4.0, inertia: diag(0.5, 0.6, 0.7) }} (second);
            coupling: {coupling};
            output first = wheel.rate.f;
            output second = other.rate.f;
            output angle = wheel.angle;
        }}"
    ))
}

const WHEEL: &str = "other: Revolute { axis: 2 } (ground, second);";
const SLIDE: &str = "other: Prismatic { axis: 0 } (ground, second);";

/// Accelerations of both, from a state in which they move.
fn accelerations(scene: &Scene) -> [f64; 2] {
    let state = scene.state(1);
    let rates = scene.run(Routines::DERIVATIVE, &state);
    let slopes = scene.along(Routines::OUTPUT, &state, &rates);
    [slopes[0], slopes[1]]
}

#[test]
fn wheels_turn_together_as_one() {
    for (radius, ratio) in [("0.5", -0.4), ("-0.5", 0.4)] {
        let gear = format!("Gear {{ radius_a: 0.2, radius_b: {radius} }} (wheel.rate, other.rate)");
        let scene = driven(&gear, WHEEL);
        assert_eq!(scene.velocities(), 1);
        let found = accelerations(&scene);
        let expected = 1.5 / (0.3 + 0.7 * ratio * ratio);
        assert!((found[0] - expected).abs() < 1e-12 && (found[1] - ratio * expected).abs() < 1e-12);
    }
}

#[test]
fn a_rack_slides_with_its_wheel() {
    let scene = driven("Rack { radius: 0.2 } (wheel.rate, other.rate)", SLIDE);
    assert_eq!(scene.velocities(), 1);
    let found = accelerations(&scene);
    let expected = 1.5 / (0.3 + 4.0 * 0.2 * 0.2);
    assert!((found[0] - expected).abs() < 1e-12 && (found[1] - 0.2 * expected).abs() < 1e-12);
}

/// The angle after half a second is that with rigid teeth, less an error that falls as 1/stiffness.
#[test]
fn teeth_that_give_way_become_rigid() {
    let couplings = [
        (
            "Gear { radius_a: 0.2, radius_b: 0.5, ",
            WHEEL,
            1.5 / (0.3 + 0.7 * 0.16),
        ),
        ("Rack { radius: 0.2, ", SLIDE, 1.5 / (0.3 + 4.0 * 0.04)),
    ];
    for (coupling, second, acceleration) in couplings {
        let error = |stiffness: f64| {
            let damping = 2.0 * stiffness.sqrt();
            let scene = driven(
                &format!(
                    "{coupling} blocked: compliant, blocked_stiffness: {stiffness:?}, blocked_damping: {damping:?} }}
                     (wheel.rate, other.rate)"
                ),
                second,
            );
            assert_eq!(scene.velocities(), 2);
            let steps = (5.0 * damping) as usize;
            let state = scene.after(scene.start(), 0.5 / steps as f64, steps);
            (scene.run(Routines::OUTPUT, &state)[2] - 0.125 * acceleration).abs()
        };
        let errors = [1e4, 1e5, 1e6, 1e7].map(error);
        let slopes = [0, 1, 2].map(|decade| (errors[decade + 1] / errors[decade]).log10());
        println!("{coupling} …: {errors:?}, slopes {slopes:.3?}");
        assert!(
            slopes.iter().all(|slope| (slope + 1.0).abs() < 0.05),
            "{coupling}: {slopes:?}"
        );
    }
}
