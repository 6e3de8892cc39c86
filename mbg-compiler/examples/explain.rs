//! Prints every stage of the models in a file: `cargo run -p mbg-compiler --example explain -- FILE`. It fails where a
//! model has a mistake.

mod source;

use std::error::Error;
use std::process::ExitCode;

use mbg_compiler::explain::explain;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("usage: explain FILE")?;
    let tokens = source::tokens(&path)?;
    let place = |span| source::place(&path, span);
    let (text, code) = match explain(tokens, &source::included, &place) {
        Ok(text) => (text, ExitCode::SUCCESS),
        Err(text) => (text, ExitCode::FAILURE),
    };
    print!("{text}");
    Ok(code)
}
