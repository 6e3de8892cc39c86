//! Draws every picture of `docs/gallery.md`, or those that are named.
//!
//! `cargo run --release --example gallery` draws all; `cargo run --release --example gallery -- quarter_car top` two.

mod amplifier;
mod arm;
mod bricard;
mod chain;
mod container;
mod curve;
mod double_pendulum;
mod draw;
mod forward_flight;
mod four_bars;
mod gait;
mod gimbal_lock;
mod governor;
mod heat;
mod hill_start;
mod hydraulic_drive;
mod inverter;
mod motor;
#[path = "../../tests/orientation/reference.rs"]
#[allow(dead_code, reason = "two scenes show some of it")]
mod orientation;
mod quarter_car;
mod rectifier;
#[path = "../../tests/references/mod.rs"]
mod references;
mod ride;
mod run;
mod sleeping_top;
mod slider_crank;
mod space;
mod stiff_pin;
mod through_lock;
mod top;
mod tumbling;
mod walker;

use std::error::Error;
use std::path::Path;

type Draw = fn(&Path) -> Result<(), Box<dyn Error>>;

/// Each scene: the name of its file, and what draws it.
const SCENES: [(&str, Draw); 25] = [
    ("gimbal_lock", gimbal_lock::draw),
    ("through_lock", through_lock::draw),
    ("tumbling", tumbling::draw),
    ("top", top::draw),
    ("sleeping_top", sleeping_top::draw),
    ("double_pendulum", double_pendulum::draw),
    ("chain", chain::draw),
    ("stiff_pin", stiff_pin::draw),
    ("four_bars", four_bars::draw),
    ("slider_crank", slider_crank::draw),
    ("bricard", bricard::draw),
    ("governor", governor::draw),
    ("arm", arm::draw),
    ("walker", walker::draw),
    ("container", container::draw),
    ("forward_flight", forward_flight::draw),
    ("quarter_car", quarter_car::draw),
    ("ride", ride::draw),
    ("hill_start", hill_start::draw),
    ("motor", motor::draw),
    ("rectifier", rectifier::draw),
    ("inverter", inverter::draw),
    ("amplifier", amplifier::draw),
    ("hydraulic_drive", hydraulic_drive::draw),
    ("heat", heat::draw),
];

fn main() -> Result<(), Box<dyn Error>> {
    let out = Path::new("docs/gallery");
    std::fs::create_dir_all(out)?;
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    for name in &wanted {
        if SCENES.iter().all(|(scene, _)| scene != name) {
            let known: Vec<&str> = SCENES.iter().map(|(scene, _)| *scene).collect();
            return Err(format!("no scene `{name}`; there are {}", known.join(", ")).into());
        }
    }
    for (name, draw) in SCENES {
        if wanted.is_empty() || wanted.iter().any(|wanted| wanted == name) {
            let path = out.join(name).with_extension("svg");
            draw(&path)?;
            println!("{}", path.display());
        }
    }
    Ok(())
}
