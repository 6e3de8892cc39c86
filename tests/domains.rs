//! Domains with the components of the library: circuits, drivelines, hydraulics, heat.

#[path = "../examples/hydraulic_drive/model.rs"]
#[allow(unreachable_pub)]
mod drive;
#[path = "references/mod.rs"]
mod references;

#[allow(clippy::unwrap_used)]
mod domains {
    mod balance;
    mod circuits;
    mod drivelines;
    mod heat;
    mod hydraulics;
    mod vehicles;
}
