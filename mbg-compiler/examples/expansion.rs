//! How long the macro takes, unoptimised as it runs inside `rustc`:
//! `cargo run -p mbg-compiler --example expansion -- FILE…`, for instance `examples/ins/models.rs examples/arm/model.rs`.

mod source;

use std::error::Error;
use std::time::Instant;

use mbg_compiler::diagnostics::Diagnostics;
use quote::quote;

/// Runs of each file, of which the median counts.
const RUNS: usize = 5;

fn main() -> Result<(), Box<dyn Error>> {
    let paths: Vec<String> = std::env::args().skip(1).collect();
    if paths.is_empty() {
        return Err("usage: expansion FILE…".into());
    }
    println!("{:<40} {:>9} {:>10}", "file", "time / ms", "text / kB");
    for path in paths {
        let tokens = source::tokens(&path)?;
        let mut times = [0.0; RUNS];
        let mut size = 0;
        for time in &mut times {
            let tokens = tokens.clone();
            let begin = Instant::now();
            let mut ignored = Diagnostics::new();
            let items = mbg_compiler::expansion(
                tokens,
                &quote!(::mbg_runtime),
                &source::included,
                &mut ignored,
            );
            *time = 1e3 * begin.elapsed().as_secs_f64();
            size = items.to_string().len();
        }
        times.sort_by(f64::total_cmp);
        println!(
            "{path:<40} {:>9.0} {:>10.0}",
            times[RUNS / 2],
            size as f64 / 1e3
        );
    }
    Ok(())
}
