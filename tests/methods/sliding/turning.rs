//! Bodies on blades that rub: which motion each blade holds up turns with the body.

use mbg_runtime::mbg;
use nalgebra::Vector3;

use super::several::by_all;

mbg! {
    /// A flat body on up to four blades, which rub sideways and let it go along.
    model Sledge {
        param mass = 1.0; param inertia = 1.0;
        param start[3] = [0.0, 0.0, 0.0];
        param push[3] = [0.0, 0.0, 0.0];
        param stiffness[3] = [0.0, 0.0, 0.0];
        param strain[3] = [0.0, 0.0, 0.0];
        param directions[4] = [0.0, 0.0, 0.0, 0.0];
        param arms[4] = [0.0, 0.0, 0.0, 0.0];
        param most[4] = [0.0, 0.0, 0.0, 0.0];
        1 body[3] {
            I frame { inertia: [[mass, 0.0, 0.0], [0.0, mass, 0.0], [0.0, 0.0, inertia]], initial_flow: start }
            Se force { effort: push }
            C spring {
                stiffness: [[stiffness.x, 0.0, 0.0], [0.0, stiffness.y, 0.0], [0.0, 0.0, stiffness.z]],
                initial: strain
            }
        }
        integral angle = body.f.z;
        1 a { R rub_a { effort: most[0] * sign(f) } }
        1 b { R rub_b { effort: most[1] * sign(f) } }
        1 c { R rub_c { effort: most[2] * sign(f) } }
        1 d { R rub_d { effort: most[3] * sign(f) } }
        body -> MTF at_a { flow: [[cos(angle + directions[0]), sin(angle + directions[0]), arms[0]]] } -> a;
        body -> MTF at_b { flow: [[cos(angle + directions[1]), sin(angle + directions[1]), arms[1]]] } -> b;
        body -> MTF at_c { flow: [[cos(angle + directions[2]), sin(angle + directions[2]), arms[2]]] } -> c;
        body -> MTF at_d { flow: [[cos(angle + directions[3]), sin(angle + directions[3]), arms[3]]] } -> d;
        output speeds[3] = body.f;
    }
}

/// A sledge with one to four blades in any direction, or in the same one and across it; some are pushed, some have springs, and blades
/// that it has not rub by nothing.
fn sledge(seed: u64) -> SledgeParameters<f64> {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    let mut about = |middle: f64, most: f64| {
        for _ in 0..3 {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
        }
        middle + most * (2.0 * (state >> 11) as f64 / (1_u64 << 53) as f64 - 1.0)
    };
    let mut sledge = SledgeParameters {
        mass: about(1.0, 0.5),
        inertia: about(0.5, 0.4),
        start: [2.0, 2.0, 3.0].map(|most| about(0.0, most)),
        ..SledgeParameters::default()
    };
    if about(0.0, 1.0) > 0.0 {
        sledge.push = [3.0, 3.0, 2.0].map(|most| about(0.0, most));
    }
    if about(0.0, 1.0) > 0.0 {
        sledge.stiffness = [5.0, 5.0, 3.0].map(|most| about(most, most));
    }
    sledge.strain = [0.5; 3].map(|most| about(0.0, most));
    for blade in 0..=(seed % 4) as usize {
        let first = sledge.directions[0];
        sledge.directions[blade] = match blade > 0 && about(0.0, 1.0) > 0.3 {
            true if about(0.0, 1.0) > 0.0 => first,
            true => first + core::f64::consts::FRAC_PI_2,
            false => about(0.0, 3.0),
        };
        sledge.arms[blade] = about(0.0, 1.0);
        sledge.most[blade] = about(1.5, 1.3);
    }
    sledge
}

/// The speeds at an end by impulses over short steps, of all that friction allows those by which the body is slowed down most
/// (Moreau, *Computer Methods in Applied Mechanics and Engineering* 177 (1999), 329–349): of first order.
fn by_impulses(sledge: &SledgeParameters<f64>, end: f64, steps: u32) -> Vector3<f64> {
    let step = end / f64::from(steps);
    let masses = Vector3::new(sledge.mass, sledge.mass, sledge.inertia);
    let (push, stiffness) = (Vector3::from(sledge.push), Vector3::from(sledge.stiffness));
    let (mut speeds, mut place) = (Vector3::from(sledge.start), Vector3::from(sledge.strain));
    let mut impulses = [0.0_f64; 4];
    for _ in 0..steps {
        let middle: Vector3<f64> = place + 0.5 * step * speeds;
        let blades: [Vector3<f64>; 4] = core::array::from_fn(|blade| {
            let (sine, cosine) = (middle.z - sledge.strain[2] + sledge.directions[blade]).sin_cos();
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

/// Blades are caught, torn loose and turned away from where they held, one by one and at once where the body stands still: those of
/// thousands that were hardest.
#[test]
fn blades_hold_what_turns_with_the_body() {
    let hard = [
        1, 4, 13, 22, 56, 86, 91, 96, 98, 157, 159, 203, 261, 290, 770, 1057, 1454, 1479, 1631,
        2482, 3112, 3406, 3437,
    ];
    for seed in hard {
        let sledge = sledge(seed);
        let impulses = by_impulses(&sledge, 2.0, 2000);
        let all = by_all(&Sledge::new(sledge).unwrap(), 2.0, 1e-9, 2e-3);
        let [_, (_, _, expected), ..] = &all[..] else {
            unreachable!()
        };
        let error = (expected - impulses).norm();
        assert!(error < 2e-2, "{seed}: {expected} {impulses}");
        for (name, _, speeds) in &all {
            let error = (speeds - expected).norm();
            let most = if *name == "RK4" { 1e-5 } else { 1e-6 };
            assert!(error < most, "{name}: {error:e} of {seed}");
        }
    }
}
