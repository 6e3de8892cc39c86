//! Prints every stage of the models in a file: `cargo run -p mbg-compiler --example explain -- FILE`.

mod source;

use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("usage: explain FILE")?;
    let tokens = source::tokens(&path)?;
    let place = |span| source::place(&path, span);
    let text = mbg_compiler::explain::explain(tokens, &source::included, &place);
    print!("{text}");
    Ok(())
}
