//! Components that ship with the compiler, written in the language itself.
//!
//! A model uses them by name. A component that the user declares under the same name wins.

use std::collections::BTreeSet;

use proc_macro2::Span;

use super::ast::{Component, Item, Source, Statement};
use super::items;
use super::recovery::Sink;
use crate::diagnostics::Diagnostics;
use crate::inclusion::text;

macro_rules! files {
    ($($name:literal: $file:literal,)*) => {
        /// Names and texts, in order of names.
        const FILES: &[(&str, &str)] = &[$(($name, include_str!(concat!("../../library/", $file)))),*];
    };
}

files! {
    "Accumulator": "accumulator.mbg",
    "AddedMass": "added_mass.mbg",
    "Backlash": "backlash.mbg",
    "Bearing": "bearing.mbg",
    "Bearings": "bearings.mbg",
    "Blade": "blade.mbg",
    "Body": "body.mbg",
    "BodyContact": "body_contact.mbg",
    "Brake": "brake.mbg",
    "Capacitor": "capacitor.mbg",
    "Clutch": "clutch.mbg",
    "Conduction": "conduction.mbg",
    "Contact": "contact.mbg",
    "Cut": "cut.mbg",
    "Cylinder": "cylinder.mbg",
    "Cylindrical": "cylindrical.mbg",
    "DcMotor": "dc_motor.mbg",
    "Differential": "differential.mbg",
    "Diode": "diode.mbg",
    "ElasticShaft": "elastic_shaft.mbg",
    "Fixed": "fixed.mbg",
    "Free": "free.mbg",
    "FreeRotation": "free_rotation.mbg",
    "Freewheel": "freewheel.mbg",
    "Friction": "friction.mbg",
    "Gear": "gear.mbg",
    "Gimbal": "gimbal.mbg",
    "GimbalAxis": "gimbal_axis.mbg",
    "GimbalSeries": "gimbal_series.mbg",
    "HeatCapacity": "heat_capacity.mbg",
    "HeatSource": "heat_source.mbg",
    "Inductor": "inductor.mbg",
    "LineForce": "line_force.mbg",
    "Load": "load.mbg",
    "Mount": "mount.mbg",
    "Offset": "offset.mbg",
    "Orifice": "orifice.mbg",
    "Planar": "planar.mbg",
    "PlanarBody": "planar_body.mbg",
    "PlanarBodyContact": "planar_body_contact.mbg",
    "PlanarContact": "planar_contact.mbg",
    "PlanarCut": "planar_cut.mbg",
    "PlanarFree": "planar_free.mbg",
    "PlanarLineForce": "planar_line_force.mbg",
    "PlanarLink": "planar_link.mbg",
    "PlanarLoad": "planar_load.mbg",
    "PlanarOffset": "planar_offset.mbg",
    "PlanarPointMass": "planar_point_mass.mbg",
    "PlanarPrismatic": "planar_prismatic.mbg",
    "PlanarRevolute": "planar_revolute.mbg",
    "PlanarRod": "planar_rod.mbg",
    "Planetary": "planetary.mbg",
    "PointMass": "point_mass.mbg",
    "Prismatic": "prismatic.mbg",
    "Pump": "pump.mbg",
    "Rack": "rack.mbg",
    "Resistor": "resistor.mbg",
    "Revolute": "revolute.mbg",
    "Rod": "rod.mbg",
    "Rotor": "rotor.mbg",
    "Spherical": "spherical.mbg",
    "Stop": "stop.mbg",
    "Transformer": "transformer.mbg",
    "Turn": "turn.mbg",
    "Universal": "universal.mbg",
}

/// The names of all components of the library.
pub fn names() -> impl Iterator<Item = &'static str> {
    FILES.iter().map(|(name, _)| *name)
}

/// The text of a component.
#[must_use]
pub fn text(name: &str) -> Option<&'static str> {
    let file = FILES.iter().find(|(known, _)| *known == name);
    file.map(|(_, text)| *text)
}

/// Adds the components that a source uses and does not declare; only these are ever read.
pub(super) fn complete(source: &mut Source) {
    let mut known: BTreeSet<String> = BTreeSet::new();
    let mut used = Vec::new();
    for item in &source.items {
        match item {
            Item::Model(model) => instances(&model.statements, &mut used),
            Item::Component(component) => {
                known.insert(component.name.to_string());
                instances(&component.statements, &mut used);
            }
        }
    }
    while let Some(name) = used.pop() {
        if known.contains(&name) {
            continue;
        }
        if let Some(component) = text(&name).and_then(read) {
            instances(&component.statements, &mut used);
            source.library.push(component);
        }
        known.insert(name);
    }
}

/// The names of the components that statements call.
fn instances(statements: &[Statement], names: &mut Vec<String>) {
    for statement in statements {
        match statement {
            Statement::Instance(instance) => names.push(instance.component.to_string()),
            Statement::Loop(repeated) => instances(&repeated.statements, names),
            Statement::Conditional(conditional) => conditional
                .branches
                .iter()
                .for_each(|branch| instances(&branch.statements, names)),
            _ => {}
        }
    }
}

/// Reads one file of the library, in which a test finds no mistakes.
fn read(file: &str) -> Option<Component> {
    let (tokens, _) = text::tokens(file, &|_| Span::call_site()).ok()?;
    let mut unheard = Diagnostics::new();
    let source = items::source(tokens, &mut Sink::new(&mut unheard));
    source.items.into_iter().find_map(|item| match item {
        Item::Component(component) => Some(Component {
            library: true,
            ..component
        }),
        Item::Model(_) => None,
    })
}
