//! Times our generated models and the best existing generators and engines on the same scenes; `run` builds all of it.
//!
//! usage: benchmarks FOLDER TARGET compare ROUNDS OUTPUT | list | count NAME TURNS
//!
//! FOLDER is what the scripts in `peers/` have filled, TARGET the instruction set for which this program was compiled,
//! too. `compare` writes table, CSV and plot into OUTPUT; it reads instructions from `instructions` in FOLDER if there is
//! such a file. `count` evaluates so often and prints nothing: the difference of two counts under
//! `valgrind --tool=callgrind` gives the instructions of one turn.

mod contestant;
#[allow(missing_docs)]
mod models;
mod ours;
mod peers;
mod plot;
mod report;
mod rounds;

use std::error::Error;
use std::path::Path;

use contestant::Contestant;
use report::Report;

/// All in the order in which they are shown, or the one that is named.
fn contestants(
    folder: &Path,
    target: &str,
    only: Option<&str>,
) -> Result<Vec<Contestant>, Box<dyn Error>> {
    let mut found = Vec::new();
    if only.is_none_or(|name| name.contains(contestant::OURS)) {
        found.extend(ours::contestants(folder)?);
    }
    found.extend(peers::contestants(folder, target, only)?);
    found.retain(|it| only.is_none_or(|name| it.name() == name));
    found.sort_by_key(|it| {
        report::SCENES
            .iter()
            .position(|scene| scene.name == it.label.scene)
    });
    Ok(found)
}

/// The largest difference of a contestant's results from ours. Each row is taken relative to its largest element: that of
/// ẋ by itself, that of ∂ẋ/∂x over all columns, since elements of it may be zero but for rounding.
fn difference(ours: &[Vec<f64>], theirs: &[Vec<f64>], rows: usize) -> f64 {
    let mut gaps = vec![0.0_f64; 2 * rows];
    let mut sizes = vec![f64::MIN_POSITIVE; 2 * rows];
    for (ours, theirs) in ours.iter().zip(theirs) {
        for (place, (ours, theirs)) in ours.iter().zip(theirs).enumerate() {
            let row = if place < rows {
                place
            } else {
                rows + place % rows
            };
            sizes[row] = sizes[row].max(ours.abs());
            // Unlike `max` this keeps what is not a number.
            let gap = (ours - theirs).abs();
            gaps[row] = if gap <= gaps[row] { gaps[row] } else { gap };
        }
    }
    gaps.iter()
        .zip(sizes)
        .map(|(gap, size)| gap / size)
        .fold(0.0, |worst, it| if it <= worst { worst } else { it })
}

/// How far each is from our scalar result; an error if that is more than rounding.
fn differences(contestants: &mut [Contestant]) -> Result<Vec<f64>, Box<dyn Error>> {
    let mut values: Vec<Vec<Vec<f64>>> = Vec::new();
    for contestant in contestants.iter_mut() {
        values.push((0..64).map(|state| (contestant.value)(state)).collect());
    }
    let mut found = Vec::new();
    for (contestant, theirs) in contestants.iter().zip(&values) {
        let reference =
            report::ours(contestants, &contestant.label.scene).ok_or("a scene without us")?;
        let difference = difference(&values[reference], theirs, contestant.variables);
        if difference > contestant.tolerance || difference.is_nan() {
            return Err(format!("{} differs by {difference:.1e}", contestant.name()).into());
        }
        found.push(difference);
    }
    Ok(found)
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let [folder, target, rest @ ..] = &words[..] else {
        return Err(
            "usage: benchmarks FOLDER TARGET compare ROUNDS OUTPUT | list | count NAME TURNS"
                .into(),
        );
    };
    let folder = Path::new(folder);
    let only = if let ["count", name, _] = rest {
        Some(*name)
    } else {
        None
    };
    let mut contestants = contestants(folder, target, only)?;
    match rest {
        ["list"] => {
            for contestant in &contestants {
                println!("{}\t{}", contestant.name(), contestant.states);
            }
        }
        ["count", _, turns] => {
            let found = contestants.first_mut().ok_or("no such contestant")?;
            (found.run)(turns.parse()?);
        }
        ["compare", rounds, output] => {
            let differences = differences(&mut contestants)?;
            let times = rounds::Times::measure(&mut contestants, rounds.parse()?);
            let report = Report::new(&contestants, &differences, &times, folder)?;
            report.write(Path::new(output), &times)?;
        }
        _ => return Err("nothing of that name".into()),
    }
    Ok(())
}
