//! Hard cases for methods of integration: each is solved to a reference, or refused with the time and the cause.
//!
//! `cargo run --release --example hard_cases`

mod suite;

fn main() {
    println!("{}", suite::HEAD);
    let mut failed = 0;
    for (_, case) in suite::CASES {
        for line in case() {
            println!("{line}");
            failed += u32::from(!line.holds());
        }
    }
    println!("\n{failed} of them do not do what is expected");
    std::process::exit(i32::from(failed > 0));
}
