//! Description of the machine that the measurements belong to, as far as Linux provides it.

use std::fs;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;

/// Interval between two readings of a child's memory.
const POLL: Duration = Duration::from_millis(5);

/// Prints one line on processor, cores, memory and load.
pub(crate) fn print_machine() {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let model = field("/proc/cpuinfo", "model name").unwrap_or_else(|| "unknown processor".to_owned());
    let memory = field("/proc/meminfo", "MemTotal").unwrap_or_default();
    let load = fs::read_to_string("/proc/loadavg").unwrap_or_default();
    let load: Vec<&str> = load.split(' ').take(3).collect();
    let load = load.join(" ");
    println!("machine: {model}, {cores} cores, memory {memory}; load before the start {load}");
    println!("times are medians of wall-clock seconds; what is compared was run in turns\n");
}

/// First value of a `name: value` line.
fn field(path: &str, name: &str) -> Option<String> {
    let text = fs::read_to_string(path).ok()?;
    let value = text.lines().find_map(|line| line.strip_prefix(name)?.trim_start().strip_prefix(':'))?;
    Some(value.trim().to_owned())
}

/// Processor seconds used by this process; less affected by other programs than the wall clock.
pub(crate) fn processor_seconds() -> f64 {
    seconds_of_stat([13, 14])
}

/// Processor seconds used by all child processes that have ended and been waited for.
pub(crate) fn processor_seconds_of_children() -> f64 {
    seconds_of_stat([15, 16])
}

/// Sum of two of the kernel's times of this process: user time and system time.
fn seconds_of_stat(fields: [usize; 2]) -> f64 {
    /// Clock ticks per second of the kernel's times.
    const TICKS_PER_SECOND: f64 = 100.0;
    let stat = fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let field = |index: usize| stat.split(' ').nth(index).and_then(|text| text.parse::<f64>().ok()).unwrap_or(0.0);
    fields.map(field).iter().sum::<f64>() / TICKS_PER_SECOND
}

/// Follows the peak memory of a child process until it ends. The kernel's high-water mark is read every few
/// milliseconds, so only a rise in the last of them is missed.
pub(crate) struct PeakWatch {
    stop: Arc<AtomicBool>,
    peak: Arc<AtomicU64>,
    watcher: JoinHandle<()>,
}

impl PeakWatch {
    /// Starts watching.
    #[expect(clippy::disallowed_methods, reason = "a watcher that sleeps must not hold a worker of the pool")]
    pub(crate) fn new(process: u32) -> Self {
        let (stop, peak) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicU64::new(0)));
        let (stopped, highest) = (Arc::clone(&stop), Arc::clone(&peak));
        let watcher = std::thread::spawn(move || {
            let path = format!("/proc/{process}/status");
            while !stopped.load(Ordering::Relaxed) {
                let kibibytes = field(&path, "VmHWM").and_then(|text| text.strip_suffix("kB")?.trim().parse().ok());
                highest.fetch_max(1024 * kibibytes.unwrap_or(0), Ordering::Relaxed);
                std::thread::sleep(POLL);
            }
        });
        Self { stop, peak, watcher }
    }

    /// Stops watching and returns the peak in bytes.
    pub(crate) fn finish(self) -> u64 {
        self.stop.store(true, Ordering::Relaxed);
        self.watcher.join().expect("the watcher does not panic");
        self.peak.load(Ordering::Relaxed)
    }
}
