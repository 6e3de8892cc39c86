//! Only the C runtime's start-up code is taken from outside.

fn main() {
    println!("cargo::rustc-link-arg-bins=-lc");
}
