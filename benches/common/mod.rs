//! What the benchmarks share: meshes of any size, clocks, tables, and the name of the machine.

#![allow(dead_code, reason = "every benchmark uses a part of this")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "sizes of meshes come from small positive floats"
)]

pub(crate) mod machine;
pub(crate) mod stop;
pub(crate) mod table;

use std::time::Instant;

/// What the user typed behind `--`; cargo adds `--bench` by itself.
pub(crate) fn arguments() -> Vec<String> {
    std::env::args().skip(1).filter(|argument| argument != "--bench").collect()
}

/// Seconds of wall clock, and the result.
pub(crate) fn time<R>(run: impl FnOnce() -> R) -> (f64, R) {
    let start = Instant::now();
    let result = std::hint::black_box(run());
    (start.elapsed().as_secs_f64(), result)
}

/// Wall-clock seconds of several runs of one job. The median is quoted, which other programs on the machine move least.
#[derive(Clone, Debug, Default)]
pub(crate) struct Times(Vec<f64>);

impl Times {
    /// Runs the job once more.
    pub(crate) fn run<R>(&mut self, run: impl FnOnce() -> R) -> R {
        let (seconds, result) = time(run);
        self.add(seconds);
        result
    }

    /// Takes a time from elsewhere.
    pub(crate) fn add(&mut self, seconds: f64) {
        self.0.push(seconds);
    }

    /// The middle one.
    pub(crate) fn median(&self) -> f64 {
        let mut sorted = self.0.clone();
        sorted.sort_unstable_by(f64::total_cmp);
        sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
    }

    /// The least: what the machine can do when it is left alone.
    pub(crate) fn least(&self) -> f64 {
        self.0.iter().copied().fold(f64::INFINITY, f64::min)
    }
}
