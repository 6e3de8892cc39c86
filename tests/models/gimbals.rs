//! Gimbals without mass as the limit of gimbals with it.

use mbg_runtime::{Adaptive, Dop853, Integrator, System, mbg};
use nalgebra::SVector;

use crate::ins::gust;
use crate::references::errors::apart;

mbg! {
    /// The navigation system of Tod et al. (2013) with gimbals that have an inertia.
    #[derivative]
    pub(crate) model Heavy {
        causality componentwise;
        param ring: kg*m^2 = 1.0;
        input gust[3]: N*m;
        1 fuselage[3] {
            I hull { inertia: diag(1e4, 1e4, 5e3), gyroscopic }
            R air { resistance: 1e3 }
            Se wind { effort: gust }
        }
        1 outer[3] { I outer_ring { inertia: ring } }
        1 inner[3] { I inner_ring { inertia: ring } }
        1 platform[3] { I body { inertia: 10.0 } }
        x: GimbalAxis { axis: 0, stiffness: 1e-5, damping: 1e-5 } (fuselage, outer);
        y: GimbalAxis { axis: 1, stiffness: 1e-5, damping: 1e-5 } (outer, inner);
        z: GimbalAxis { axis: 2, stiffness: 1e-5, damping: 1e-5 } (inner, platform);
        output angles[3]: rad = [x.angle, y.angle, z.angle];
    }
}

/// The angles of gimbals without mass 4 s after a gust of 1 s has begun, in rad.
const MASSLESS: [f64; 3] = [1.0105725590406142, -0.32257882628632933, -5.219655538693985];

/// Inertia of a gimbal in kg m², and its largest effect on an angle at that time in rad: by an independent solver of
/// differential-algebraic equations at 1e-11.
const EFFECTS: [(f64, f64); 4] = [
    (1.0, 0.4321538148413617),
    (0.1, 0.035274989584991756),
    (0.01, 0.003399179788805995),
    (0.001, 0.0003385960690944767),
];

#[test]
fn gimbals_lose_their_effect_with_their_inertia() {
    for (ring, effect) in EFFECTS {
        let model = Heavy::<f64>::new(HeavyParameters { ring }).unwrap();
        let mut last = SVector::zeros();
        Adaptive::new(Dop853, 1e-12, 1e-15)
            .sample(
                &model,
                &gust(1.0),
                0.0,
                model.initial_state(),
                &[5.0],
                |t, x| {
                    last = model.output(t, x, &SVector::zeros(), &mut Default::default());
                },
            )
            .unwrap();
        let found = apart(last.as_slice(), &MASSLESS);
        let error = (found / effect - 1.0).abs();
        assert!(error < 1e-6, "{ring}: {found:e} {error:e}");
    }
}
