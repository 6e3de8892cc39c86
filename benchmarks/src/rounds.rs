//! Rounds in which all contestants take turns, and which of their samples count.

use std::hint::black_box;
use std::time::Instant;

use crate::contestant::Contestant;

/// About how long one sample is, in ns.
const SAMPLE: f64 = 40_000.0;
/// A sample counts if the probes before and after it ran at this multiple of their usual time or faster.
const SLOWEST: f64 = 1.05;

/// Work that is bound by how many instructions a core issues, so that it is slow exactly while others use the core.
fn probe() -> f64 {
    let start = Instant::now();
    let mut words: [u64; 6] = black_box([1, 2, 3, 4, 5, 6]);
    let mut numbers: [f64; 4] = black_box([1.0, 1.1, 1.2, 1.3]);
    for _ in 0..800 {
        for word in &mut words {
            *word = (*word ^ (*word >> 7)).wrapping_add(0x9e37_79b9);
        }
        for number in &mut numbers {
            *number = *number * 0.999 + 1e-3;
        }
        words = black_box(words);
    }
    black_box((words, numbers));
    start.elapsed().as_secs_f64() * 1e9
}

/// Times in ns per state, by contestant and round; `None` where a neighbour disturbed.
pub(crate) struct Times(Vec<Vec<Option<f64>>>);

impl Times {
    /// Lets all take turns.
    pub(crate) fn measure(contestants: &mut [Contestant], rounds: usize) -> Self {
        let turns: Vec<usize> = contestants.iter_mut().map(turns).collect();
        let mut samples = vec![Vec::with_capacity(rounds); contestants.len()];
        let mut probes = Vec::with_capacity(rounds * contestants.len());
        for _ in 0..rounds {
            for ((contestant, turns), samples) in
                contestants.iter_mut().zip(&turns).zip(&mut samples)
            {
                // The code and data of this one come back to the caches.
                (contestant.run)(turns.div_ceil(8));
                let before = probe();
                let start = Instant::now();
                (contestant.run)(*turns);
                let time = start.elapsed().as_secs_f64() * 1e9;
                let slowest = before.max(probe());
                probes.push(slowest);
                samples.push((time / (turns * contestant.states) as f64, slowest));
            }
        }
        // The fastest tenth is a machine at rest.
        probes.sort_by(f64::total_cmp);
        let bound = SLOWEST * probes[probes.len() / 10];
        let undisturbed = |(time, probe)| (probe <= bound).then_some(time);
        let kept = samples
            .into_iter()
            .map(|samples| samples.into_iter().map(undisturbed).collect());
        Self(kept.collect())
    }

    /// Part of all samples that count.
    pub(crate) fn kept(&self) -> f64 {
        let all = self.0.iter().flatten();
        all.clone().flatten().count() as f64 / all.count() as f64
    }

    /// Median time of a contestant.
    pub(crate) fn median(&self, contestant: usize) -> f64 {
        median(self.0[contestant].iter().flatten().copied().collect())
    }

    /// Median of the ratios, round by round.
    pub(crate) fn ratio(&self, contestant: usize, reference: usize) -> f64 {
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

/// NaN where nothing is left.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
