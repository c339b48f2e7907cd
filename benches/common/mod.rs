//! Shared parts of the benchmarks: meshes of any size, clocks, tables, and the description of the machine.

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

/// Arguments after `--`; cargo adds `--bench` by itself.
pub(crate) fn arguments() -> Vec<String> {
    std::env::args().skip(1).filter(|argument| argument != "--bench").collect()
}

/// Returns the seconds of wall clock, and the result.
pub(crate) fn time<R>(run: impl FnOnce() -> R) -> (f64, R) {
    let start = Instant::now();
    let result = std::hint::black_box(run());
    (start.elapsed().as_secs_f64(), result)
}

/// Wall-clock seconds of several runs of one job. Results quote the median, which other programs on the machine
/// affect least.
#[derive(Clone, Debug, Default)]
pub(crate) struct Times(Vec<f64>);

impl Times {
    /// Runs the job and adds its time.
    pub(crate) fn run<R>(&mut self, run: impl FnOnce() -> R) -> R {
        let (seconds, result) = time(run);
        self.add(seconds);
        result
    }

    /// Adds a time that was measured elsewhere.
    pub(crate) fn add(&mut self, seconds: f64) {
        self.0.push(seconds);
    }

    /// Median of the times.
    pub(crate) fn median(&self) -> f64 {
        let mut sorted = self.0.clone();
        sorted.sort_unstable_by(f64::total_cmp);
        sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
    }

    /// Least time: the speed of an otherwise idle machine.
    pub(crate) fn least(&self) -> f64 {
        self.0.iter().copied().fold(f64::INFINITY, f64::min)
    }
}
