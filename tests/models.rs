//! The macro used for real: behaviour against references, closed forms and identities.

#[path = "../examples/arm/model.rs"]
#[allow(unreachable_pub)]
mod arm;
#[path = "../examples/dc_motor/model.rs"]
#[allow(unreachable_pub)]
mod dc_motor;
#[path = "../examples/ins/models.rs"]
#[allow(unreachable_pub)]
mod ins;
#[path = "../examples/ins/reference.rs"]
#[allow(unreachable_pub)]
mod reference;
#[path = "references/mod.rs"]
mod references;
#[path = "../examples/ins/run.rs"]
#[allow(unreachable_pub, dead_code)]
mod run;

#[allow(clippy::unwrap_used)]
mod models {
    mod amplifier;
    #[expect(
        deprecated,
        reason = "a warning of the macro: links of the winder are no whole bodies"
    )]
    mod arm;
    mod audit;
    mod batches;
    #[allow(
        deprecated,
        reason = "warnings of the macro, one of which is tested there"
    )]
    mod behaviour;
    mod body_contacts;
    #[expect(
        deprecated,
        reason = "a warning of the macro: loops begin open there, and are closed"
    )]
    mod closed;
    mod columns;
    mod contacts;
    mod curves;
    mod cycles;
    mod dependent;
    mod energy;
    mod floating;
    mod gimbals;
    mod lagrange;
    mod linearised;
    mod lines;
    mod loops;
    #[allow(dead_code, reason = "the example prints more of it")]
    mod mechanisms;
    mod mimics;
    mod navigation;
    mod parameters;
    mod pins;
    mod pivots;
    mod platform;
    mod rods;
    mod rows;
    mod stages;
    #[allow(deprecated, reason = "a warning of the macro, which is meant there")]
    mod starts;
    mod trims;
    mod water;
}
