//! The results as a table and as a CSV file.

use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use crate::contestant::Contestant;
use crate::plot;
use crate::rounds::Times;

/// A scene, and what is aimed at: our time relative to that of the fastest peer.
pub(crate) struct Scene {
    pub(crate) name: &'static str,
    pub(crate) title: &'static str,
    pub(crate) bar: Option<f64>,
}

const fn scene(name: &'static str, title: &'static str, bar: Option<f64>) -> Scene {
    Scene { name, title, bar }
}

/// In the order in which they are shown.
pub(crate) const SCENES: [Scene; 10] = [
    scene("ins-value", "INS", Some(0.5)),
    scene("ins-jacobian", "INS, value and Jacobian", Some(0.5)),
    scene("chain8-value", "chain of 8 links", Some(0.7)),
    scene("chain16-value", "chain of 16 links", Some(0.7)),
    scene("chain64-value", "chain of 64 links", Some(0.7)),
    scene("arm-value", "7-axis arm", Some(0.7)),
    scene("arm-jacobian", "7-axis arm, value and Jacobian", Some(0.5)),
    scene("fourbar-value", "four-bar", Some(0.8)),
    scene("ins-batch", "INS, batch of 4096, per state", None),
    scene("arm-batch", "7-axis arm, batch of 4096, per state", None),
];

/// Our contestant in `f64` of a scene.
pub(crate) fn ours(contestants: &[Contestant], scene: &str) -> Option<usize> {
    let label =
        |it: &Contestant| it.is_ours() && it.label.scene == scene && it.label.variant == "f64";
    contestants.iter().position(label)
}

/// A contestant's figures.
#[derive(Clone)]
pub(crate) struct Row {
    pub(crate) scene: String,
    pub(crate) peer: String,
    pub(crate) variant: String,
    /// In ns per state; nothing if a neighbour disturbed in every round.
    pub(crate) time: Option<f64>,
    /// Our scalar time divided by it, round by round.
    ratio: Option<f64>,
    operations: Option<usize>,
    instructions: Option<u64>,
    difference: f64,
    is_ours: bool,
}

/// All figures.
pub(crate) struct Report {
    pub(crate) rows: Vec<Row>,
}

impl Report {
    pub(crate) fn new(
        contestants: &[Contestant],
        differences: &[f64],
        times: &Times,
        folder: &Path,
    ) -> Result<Self, Box<dyn Error>> {
        let counted = fs::read_to_string(folder.join("instructions")).unwrap_or_default();
        let instructions: BTreeMap<&str, u64> = counted
            .lines()
            .filter_map(|line| line.split_once('\t'))
            .filter_map(|(name, count)| Some((name, count.parse().ok()?)))
            .collect();
        let mut rows = Vec::new();
        for (number, contestant) in contestants.iter().enumerate() {
            let label = contestant.label.clone();
            let reference = ours(contestants, &label.scene).ok_or("a scene without us")?;
            rows.push(Row {
                time: times.median(number),
                ratio: times.ratio(reference, number),
                operations: label.operations,
                instructions: instructions.get(contestant.name().as_str()).copied(),
                difference: differences[number],
                is_ours: contestant.is_ours(),
                scene: label.scene,
                peer: label.peer,
                variant: label.variant,
            });
        }
        Ok(Self { rows })
    }

    /// Rows of a scene, fastest first.
    pub(crate) fn of(&self, scene: &str) -> Vec<&Row> {
        let mut rows: Vec<&Row> = self.rows.iter().filter(|row| row.scene == scene).collect();
        let time = |row: &Row| row.time.unwrap_or(f64::INFINITY);
        rows.sort_by(|a, b| time(a).total_cmp(&time(b)));
        rows
    }

    /// Writes everything.
    pub(crate) fn write(&self, output: &Path, times: &Times) -> Result<(), Box<dyn Error>> {
        fs::create_dir_all(output)?;
        let text = [
            self.summary(),
            self.growth(),
            self.everything(),
            kept(times),
        ]
        .join("\n");
        print!("{text}");
        fs::write(output.join("table.txt"), text)?;
        fs::write(output.join("results.csv"), self.csv())?;
        plot::draw(self, &output.join("times.svg"))
    }

    /// Ours against the fastest peer of each scene.
    fn summary(&self) -> String {
        let mut text = format!(
            "{:<38}{:>9}{:>11}  {:<22}{:>7}{:>6}{:>13}{:>8}{:>10}{:>14}{:>8}\n",
            "scene",
            "ours/ns",
            "fastest/ns",
            "fastest peer",
            "ratio",
            "bar",
            "operations",
            "fewest",
            "ratio",
            "instructions",
            "ratio"
        );
        for scene in &SCENES {
            let rows = self.of(scene.name);
            let Some(ours) = rows.iter().find(|row| row.is_ours) else {
                continue;
            };
            let Some(peer) = rows.iter().find(|row| !row.is_ours) else {
                continue;
            };
            let scalar = rows.iter().find(|row| row.is_ours && row.variant == "f64");
            // In lanes there is no round to compare with: medians do.
            let ratio = match scalar {
                Some(scalar) if std::ptr::eq(*scalar, *ours) => peer.ratio,
                _ => quotient(ours.time, peer.time),
            };
            let fewest = rows
                .iter()
                .filter(|row| !row.is_ours)
                .filter_map(|row| row.operations)
                .min();
            let least = rows
                .iter()
                .filter(|row| !row.is_ours)
                .filter_map(|row| row.instructions)
                .min();
            let parts = |a: Option<f64>, b: Option<f64>| figure(quotient(a, b), 2);
            let _ = writeln!(
                text,
                "{:<38}{:>9}{:>11}  {:<22}{:>7}{:>6}{:>13}{:>8}{:>10}{:>14}{:>8}",
                scene.title,
                figure(ours.time, 1),
                figure(peer.time, 1),
                format!("{} {}", peer.peer, peer.variant),
                figure(ratio, 2),
                figure(scene.bar, 2),
                shown(ours.operations),
                shown(fewest),
                parts(
                    ours.operations.map(|it| it as f64),
                    fewest.map(|it| it as f64)
                ),
                shown(ours.instructions),
                parts(
                    ours.instructions.map(|it| it as f64),
                    least.map(|it| it as f64)
                ),
            );
        }
        text
    }

    /// How much longer a link of the long chain takes than one of the short chain.
    fn growth(&self) -> String {
        let mut text = "time per link, chain of 64 links to chain of 8:".to_owned();
        let mut seen: Vec<&str> = Vec::new();
        for long in self.of("chain64-value") {
            let short = self.of("chain8-value");
            let short = short.iter().find(|row| row.peer == long.peer);
            if let (Some(short), false) = (short, seen.contains(&long.peer.as_str())) {
                seen.push(&long.peer);
                let growth = quotient(long.time, short.time).map(|it| it / 8.0);
                let _ = write!(text, " {} {}", long.peer, figure(growth, 2));
            }
        }
        text + "\n"
    }

    fn everything(&self) -> String {
        let mut text = format!(
            "{:<38}{:<12}{:<14}{:>11}{:>11}{:>12}{:>14}{:>12}\n",
            "scene", "by", "variant", "ns", "ours/it", "operations", "instructions", "difference"
        );
        for scene in &SCENES {
            for row in self.of(scene.name) {
                let _ = writeln!(
                    text,
                    "{:<38}{:<12}{:<14}{:>11}{:>11}{:>12}{:>14}{:>12.1e}",
                    scene.title,
                    row.peer,
                    row.variant,
                    figure(row.time, 1),
                    figure(row.ratio, 2),
                    shown(row.operations),
                    shown(row.instructions),
                    row.difference
                );
            }
        }
        text
    }

    fn csv(&self) -> String {
        let mut text = "scene,by,variant,ns,ratio,operations,instructions,difference\n".to_owned();
        for row in &self.rows {
            let whole = |count: Option<u64>| count.map(|it| it.to_string()).unwrap_or_default();
            let _ = writeln!(
                text,
                "{},{},{},{},{},{},{},{:.1e}",
                row.scene,
                row.peer,
                row.variant,
                figure(row.time, 2),
                figure(row.ratio, 3),
                whole(row.operations.map(|it| it as u64)),
                whole(row.instructions),
                row.difference
            );
        }
        text
    }
}

fn kept(times: &Times) -> String {
    format!(
        "{:.0} % of the samples ran undisturbed; only those count.\n",
        100.0 * times.kept()
    )
}

fn quotient(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    Some(a? / b?)
}

fn figure(value: Option<f64>, digits: usize) -> String {
    shown(value.map(|it| format!("{it:.digits$}")))
}

fn shown(value: Option<impl ToString>) -> String {
    value.map_or("-".to_owned(), |it| it.to_string())
}
