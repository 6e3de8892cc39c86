//! The paper's ground, which the example leaves out: friction of equal size in all directions is the same about the
//! axes of the ground, of the air or of the fuselage, so the motion is that of the free system.

use mbg_compiler::compile::{Compiled, Routines};
use mbg_compiler::program::{Arguments, evaluate};

use super::language::{FIXED, FRICTION, GIMBALS, REVOLUTES, STIFF, System, texts};

/// What all systems share: momentum of the fuselage, momentum of the platform, gimbal angles.
type Motion = Vec<[f64; 9]>;

/// Steps of RK4 from rest through a gust on [1, 1.1) s, with a stiffness of the ground.
fn motion(system: System, ground: f64, step: f64, end: f64) -> Motion {
    let compiled = system
        .compile()
        .unwrap_or_else(|found| panic!("{:?}", texts(&found)));
    let parameters: Vec<f64> = compiled
        .model
        .parameters
        .iter()
        .map(|parameter| {
            if parameter.declared == "ground" {
                ground
            } else {
                parameter.default
            }
        })
        .collect();
    let shown = shared(&compiled);
    let mut state = vec![0.0; compiled.states.len()];
    let count = |time: f64| (time / step).round() as usize;
    let mut motion = Vec::new();
    for number in 0..count(end) {
        let gust = (count(1.0)..count(1.1)).contains(&number);
        let input = if gust {
            [5000.0, 1000.0, 10000.0]
        } else {
            [0.0; 3]
        };
        let slope = |state: &[f64]| {
            let arguments = Arguments {
                parameters: &parameters,
                time: 0.0,
                state,
                input: &input,
            };
            evaluate(&compiled.program, Routines::DERIVATIVE, &arguments)
        };
        let ahead = |by: f64, slope: &[f64]| -> Vec<f64> {
            state.iter().zip(slope).map(|(x, k)| x + by * k).collect()
        };
        let k1 = slope(&state);
        let k2 = slope(&ahead(step / 2.0, &k1));
        let k3 = slope(&ahead(step / 2.0, &k2));
        let k4 = slope(&ahead(step, &k3));
        for (row, x) in state.iter_mut().enumerate() {
            *x += step / 6.0 * (k1[row] + 2.0 * k2[row] + 2.0 * k3[row] + k4[row]);
        }
        motion.push(shown.map(|index| state[index]));
    }
    motion
}

/// Places of the shared states, by name.
fn shared(compiled: &Compiled) -> [usize; 9] {
    let place = |parts: [&str; 2]| {
        compiled
            .states
            .iter()
            .position(|state| {
                let name = &compiled.model.states[*state].variable.name;
                name == parts[0] || name == parts[1]
            })
            .unwrap_or_else(|| panic!("no state {parts:?}"))
    };
    [
        ["hull.p.x"; 2],
        ["hull.p.y"; 2],
        ["hull.p.z"; 2],
        ["body.p.x"; 2],
        ["body.p.y"; 2],
        ["body.p.z"; 2],
        ["joint.spring.q.x", "joint.x.spring.q"],
        ["joint.spring.q.y", "joint.y.spring.q"],
        ["joint.spring.q.z", "joint.z.spring.q"],
    ]
    .map(place)
}

/// Largest difference of a component, relative to its largest value.
fn apart(one: &Motion, other: &Motion) -> f64 {
    let worst = |component: usize| {
        let scale = other
            .iter()
            .map(|instant| instant[component].abs())
            .fold(0.0, f64::max);
        assert!(scale > 0.0, "component {component} moves");
        let largest = one
            .iter()
            .zip(other)
            .map(|(one, other)| (one[component] - other[component]).abs())
            .fold(0.0, f64::max);
        largest / scale
    };
    assert_eq!(one.len(), other.len());
    (0..9).map(worst).fold(0.0, f64::max)
}

/// Both joints before the platform, the second accepted as drawn.
const JOINTS: [(&str, &str); 2] = [("", GIMBALS), ("#[derivative]", REVOLUTES)];

#[test]
fn a_fixed_ground_changes_nothing() {
    let free = motion(System::free(GIMBALS), 0.0, 1e-2, 20.0);
    for (mark, joint) in JOINTS {
        let system = System {
            mark,
            ..System::grounded(FIXED, FRICTION, joint)
        };
        let difference = apart(&motion(system, 0.0, 1e-2, 20.0), &free);
        assert!(difference < 1e-14, "{joint}: {difference:e}");
    }
}

/// Friction about the axes of gimbals between ground and fuselage, `J⁻ᵀ R J⁻¹ ω`, is another friction: momentum of the fuselage
/// and its Euler angle about x at the end, of the equations by hand at 1e-12.
#[test]
fn friction_about_axes_of_gimbals_is_another() {
    const MOMENTUM: [f64; 3] = [85.58367460526198, -38.043766998398713, 32.57298877177348];
    let gimbals = "Gimbals { stiffness: 0.0, damping: drag }";
    let end = |air| motion(System::grounded(FIXED, air, GIMBALS), 0.0, 5e-3, 20.0)[3999];
    for (found, expected) in end(gimbals).iter().zip(MOMENTUM) {
        assert!((found - expected).abs() < 1e-4, "{found} {expected}");
    }
    for (air, expected) in [(gimbals, 0.4149494575273851), (FRICTION, 0.379976877)] {
        // The platform stays, but for some 1e-5 rad, so that its gimbals turn back what the fuselage turns.
        let [.., a, b, c] = end(air);
        let across = a.sin() * c.cos() + a.cos() * b.sin() * c.sin();
        let angle = f64::atan2(-across, a.cos() * b.cos());
        assert!((angle - expected).abs() < 1e-4, "{angle} {expected}");
    }
}

#[test]
fn a_stiff_ground_tends_to_the_fixed_one_as_its_compliance() {
    let (step, end) = (1e-3, 5.0);
    let free = motion(System::free(GIMBALS), 0.0, step, end);
    for (mark, joint) in JOINTS {
        let system = System {
            mark,
            ..System::grounded(STIFF, FRICTION, joint)
        };
        let [soft, stiff] = [1e5, 2e5].map(|ground| motion(system, ground, step, end));
        let errors = [apart(&soft, &free), apart(&stiff, &free)];
        let limit: Motion = soft
            .iter()
            .zip(&stiff)
            .map(|(soft, stiff)| std::array::from_fn(|k| 2.0 * stiff[k] - soft[k]))
            .collect();
        let rest = apart(&limit, &free);
        // The air's friction d follows the fuselage J late by d / k, which costs d² / (k J) of its momentum.
        assert!(errors[1] < 2.0 * 1e3 * 1e3 / (2e5 * 5e3), "{errors:?}");
        let ratio = errors[0] / errors[1];
        assert!((ratio - 2.0).abs() < 0.01, "{joint}: {ratio}");
        assert!(rest < errors[1] / 15.0, "{joint}: {rest:e}");
    }
}
