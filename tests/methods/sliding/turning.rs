//! Bodies on blades that rub: which motion each blade holds up turns with the body.

use mbg_runtime::mbg;
use nalgebra::Vector3;

use super::networks::numbers;
use super::several::by_all;

mbg! {
    /// A flat body on three blades, which rub sideways and let it go along.
    model Sledge {
        param mass = 1.0; param inertia = 1.0;
        param start[3] = [0.0, 0.0, 0.0];
        param push[3] = [0.0, 0.0, 0.0];
        param stiffness[3] = [0.0, 0.0, 0.0];
        param directions[3] = [0.0, 0.0, 0.0];
        param arms[3] = [0.0, 0.0, 0.0];
        param most[3] = [0.0, 0.0, 0.0];
        1 body[3] {
            I frame { inertia: [[mass, 0.0, 0.0], [0.0, mass, 0.0], [0.0, 0.0, inertia]], initial_flow: start }
            Se force { effort: push }
            C spring { stiffness: [[stiffness.x, 0.0, 0.0], [0.0, stiffness.y, 0.0], [0.0, 0.0, stiffness.z]] }
        }
        integral angle = body.f.z;
        1 a { R rub_a { effort: most.x * sign(f) } }
        1 b { R rub_b { effort: most.y * sign(f) } }
        1 c { R rub_c { effort: most.z * sign(f) } }
        body -> MTF at_a { flow: [[cos(angle + directions.x), sin(angle + directions.x), arms.x]] } -> a;
        body -> MTF at_b { flow: [[cos(angle + directions.y), sin(angle + directions.y), arms.y]] } -> b;
        body -> MTF at_c { flow: [[cos(angle + directions.z), sin(angle + directions.z), arms.z]] } -> c;
        output speeds[3] = body.f;
    }
}

/// A sledge with blades in any direction, or in the same one and across it; some rub, some have springs.
fn at_random(blades: usize, next: &mut impl FnMut() -> f64) -> SledgeParameters<f64> {
    let mut about = |middle: f64, most: f64| middle + most * (2.0 * next() - 1.0);
    let (mass, inertia) = (about(1.0, 0.5), about(0.5, 0.4));
    let start = [about(0.0, 2.0), about(0.0, 2.0), about(0.0, 3.0)];
    let is_pushed = about(0.0, 1.0) > 0.0;
    let push = [about(0.0, 3.0), about(0.0, 3.0), about(0.0, 2.0)]
        .map(|it| if is_pushed { it } else { 0.0 });
    let has_springs = about(0.0, 1.0) > 0.0;
    let stiffness = [about(5.0, 5.0), about(5.0, 5.0), about(3.0, 3.0)]
        .map(|it| if has_springs { it } else { 0.0 });
    let (mut directions, mut arms, mut most) = ([0.0; 3], [0.0; 3], [0.0; 3]);
    for blade in 0..blades {
        directions[blade] = match about(0.0, 1.0) {
            ..-0.3 => about(0.0, 3.0),
            ..0.3 => directions[0],
            _ => directions[0] + core::f64::consts::FRAC_PI_2,
        };
        arms[blade] = about(0.0, 1.0);
        most[blade] = about(1.5, 1.3);
    }
    SledgeParameters {
        mass,
        inertia,
        start,
        push,
        stiffness,
        directions,
        arms,
        most,
    }
}

/// The speeds at an end by impulses over short steps, of all that friction allows those by which the body is slowed down most
/// (Moreau, *Computer Methods in Applied Mechanics and Engineering* 177 (1999), 329–349): of first order.
fn by_impulses(sledge: &SledgeParameters<f64>, end: f64, steps: u32) -> Vector3<f64> {
    let step = end / f64::from(steps);
    let masses = Vector3::new(sledge.mass, sledge.mass, sledge.inertia);
    let (push, stiffness) = (Vector3::from(sledge.push), Vector3::from(sledge.stiffness));
    let (mut speeds, mut place) = (Vector3::from(sledge.start), Vector3::zeros());
    let mut impulses = [0.0_f64; 3];
    for _ in 0..steps {
        let middle: Vector3<f64> = place + 0.5 * step * speeds;
        let blades: [Vector3<f64>; 3] = core::array::from_fn(|blade| {
            let (sine, cosine) = (middle.z + sledge.directions[blade]).sin_cos();
            Vector3::new(cosine, sine, sledge.arms[blade])
        });
        let mut next =
            speeds + (step * (push - stiffness.component_mul(&middle))).component_div(&masses);
        for (blade, impulse) in blades.iter().zip(&impulses) {
            next -= *impulse * blade.component_div(&masses);
        }
        for _ in 0..2000 {
            let mut change = 0.0_f64;
            for (blade, (impulse, most)) in blades.iter().zip(impulses.iter_mut().zip(sledge.most))
            {
                let mobility = blade.component_div(&masses);
                let wanted = *impulse + blade.dot(&next) / blade.dot(&mobility);
                let more = wanted.clamp(-most * step, most * step) - *impulse;
                *impulse += more;
                next -= more * mobility;
                change = change.max(more.abs());
            }
            if change < 1e-13 * step {
                break;
            }
        }
        place += 0.5 * step * (speeds + next);
        speeds = next;
    }
    speeds
}

/// Blades are caught, torn loose and turned away from where they held, one by one and at once where the body stands still.
#[test]
fn blades_hold_what_turns_with_the_body() {
    let mut next = numbers(7);
    for number in 0..24 {
        let sledge = at_random(1 + number % 3, &mut next);
        let impulses = by_impulses(&sledge, 2.0, 2000);
        let all = by_all(&Sledge::new(sledge).unwrap(), 2.0, 1e-9, 0.01);
        let [_, (_, _, expected), ..] = &all[..] else {
            unreachable!()
        };
        assert!(
            (expected - impulses).norm() < 2e-2,
            "{expected} {impulses} {sledge:?}"
        );
        for (name, _, speeds) in &all {
            let error = (speeds - expected).norm();
            assert!(
                error < if *name == "RK4" { 1e-5 } else { 1e-6 },
                "{name}: {error:e} in {number}: {sledge:?}"
            );
        }
    }
}
