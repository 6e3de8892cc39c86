//! Rounds in which all contestants take turns, and which of their samples count.

use std::hint::black_box;
use std::time::Instant;

use crate::contestant::Contestant;

/// About how long one sample is, in ns.
const SAMPLE: f64 = 40_000.0;
/// A sample counts if the probes before and after it ran at this multiple of their usual time or faster.
const SLOWEST: f64 = 1.05;
/// As long, in ns, a core is given to come back to its usual clock, which some lower behind wide registers.
const RECOVERY: f64 = 2e6;

/// Work that is slow exactly while others use the core: it is bound by how many instructions a core issues at first, by
/// how many it has waiting afterwards, of which a neighbour takes half even where it computes little.
fn probe() -> f64 {
    let start = Instant::now();
    let mut words: [u64; 6] = black_box([1, 2, 3, 4, 5, 6]);
    let mut numbers: [f64; 4] = black_box([1.0, 1.1, 1.2, 1.3]);
    for _ in 0..500 {
        for word in &mut words {
            *word = (*word ^ (*word >> 7)).wrapping_add(0x9e37_79b9);
        }
        for number in &mut numbers {
            *number = *number * 0.999 + 1e-3;
        }
        words = black_box(words);
    }
    black_box((words, numbers));
    for _ in 0..100 {
        let mut number = black_box(1.0);
        for _ in 0..24 {
            number = number * 0.999 + 1e-3;
        }
        black_box(number);
    }
    start.elapsed().as_secs_f64() * 1e9
}

/// The probe, once it takes no longer than this; that of a core that does not come to rest otherwise.
fn rested(bound: f64) -> f64 {
    let start = Instant::now();
    loop {
        let time = probe();
        if time <= bound || start.elapsed().as_secs_f64() * 1e9 > RECOVERY {
            return time;
        }
    }
}

/// What a probe takes on a machine at rest: the fastest tenth.
fn usual(probes: impl Iterator<Item = f64>) -> f64 {
    let mut probes: Vec<f64> = probes.collect();
    probes.sort_by(f64::total_cmp);
    probes[probes.len() / 10]
}

/// Time in ns per state, and the probes before and after it.
#[derive(Clone, Copy)]
struct Sample {
    time: f64,
    before: f64,
    after: f64,
}

/// Times in ns per state, by contestant and round; `None` where a neighbour disturbed.
pub(crate) struct Times(Vec<Vec<Option<f64>>>);

impl Times {
    /// Lets all take turns.
    pub(crate) fn measure(contestants: &mut [Contestant], rounds: usize) -> Self {
        let turns: Vec<usize> = contestants.iter_mut().map(turns).collect();
        let mut samples = vec![Vec::with_capacity(rounds); contestants.len()];
        let mut fastest = f64::INFINITY;
        for _ in 0..rounds {
            for ((contestant, turns), samples) in
                contestants.iter_mut().zip(&turns).zip(&mut samples)
            {
                let before = rested(SLOWEST * fastest);
                fastest = fastest.min(before);
                // The code and data of this one come back to the caches, and the clock is what it makes it.
                (contestant.run)(*turns);
                let start = Instant::now();
                (contestant.run)(*turns);
                let time = start.elapsed().as_secs_f64() * 1e9;
                samples.push(Sample {
                    time: time / (turns * contestant.states) as f64,
                    before,
                    after: probe(),
                });
            }
        }
        let before = usual(samples.iter().flatten().map(|it| it.before));
        let kept = samples.into_iter().map(|samples| {
            // Registers that lower the clock do so in every sample, a neighbour in some.
            let after = usual(samples.iter().map(|it| it.after));
            let undisturbed =
                |it: &Sample| it.before <= SLOWEST * before && it.after <= SLOWEST * after;
            let time = |it: Sample| undisturbed(&it).then_some(it.time);
            samples.into_iter().map(time).collect()
        });
        Self(kept.collect())
    }

    /// Part of all samples that count.
    pub(crate) fn kept(&self) -> f64 {
        let all = self.0.iter().flatten();
        all.clone().flatten().count() as f64 / all.count() as f64
    }

    /// Median time of a contestant; nothing if a neighbour disturbed in every round.
    pub(crate) fn median(&self, contestant: usize) -> Option<f64> {
        median(self.0[contestant].iter().flatten().copied().collect())
    }

    /// Median of the ratios, round by round; nothing if in none both were undisturbed.
    pub(crate) fn ratio(&self, contestant: usize, reference: usize) -> Option<f64> {
        let pairs = self.0[contestant].iter().zip(&self.0[reference]);
        median(pairs.filter_map(|(a, b)| Some((*a)? / (*b)?)).collect())
    }
}

/// How often to run for one sample.
fn turns(contestant: &mut Contestant) -> usize {
    let mut best = f64::INFINITY;
    for _ in 0..5 {
        let start = Instant::now();
        (contestant.run)(20);
        best = best.min(start.elapsed().as_secs_f64() * 1e9 / 20.0);
    }
    ((SAMPLE / best) as usize).max(1)
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}
