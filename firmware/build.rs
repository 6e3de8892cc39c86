//! Chooses the memory map of the microcontroller.

use std::env;

fn main() {
    println!("cargo::rerun-if-changed=memory");
    let map = match env::var("CARGO_CFG_TARGET_ARCH").as_deref() {
        Ok("arm") => "cortex-m.x",
        Ok("riscv32") => "riscv.x",
        _ => return,
    };
    let folder = env::var("CARGO_MANIFEST_DIR").unwrap_or_default();
    println!("cargo::rustc-link-arg-bins=-T{folder}/memory/{map}");
}
