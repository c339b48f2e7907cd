//! Progress on the terminal, and Ctrl-C.

use std::io::{IsTerminal as _, Write as _};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Mutex, OnceLock};
use std::time::{Duration, Instant};

use super::awaited::forget_awaited;
use clap::ValueEnum;
use serde::Serialize;

use super::error::INTERRUPTED as INTERRUPTED_CODE;
use super::say::warn;
use freebound_core::flatten::Step;
use freebound_core::problem::SolveError;
use freebound_io::discard_unfinished;

/// Time before the progress line appears.
const QUIET: Duration = Duration::from_millis(500);

/// Update interval of the progress line.
const TICK: Duration = Duration::from_millis(100);

/// Time for the work to stop after an interrupt. Together with ending the process it takes a tenth of a second.
const GRACE: Duration = Duration::from_millis(50);

/// Time for the last message.
const LAST_WORD: Duration = Duration::from_millis(10);

/// Flag that Ctrl-C sets.
pub(super) static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// True if the user interrupted the run.
pub(super) fn is_interrupted() -> bool {
    INTERRUPTED.load(Ordering::Relaxed)
}

/// Sets [`INTERRUPTED`] on Ctrl-C and on termination signals. Work that does not stop within a short time is aborted; a
/// second signal aborts it at once. Files are written aside and renamed, so no file is left half-written.
pub(super) fn stop_on_interrupt() {
    let handler = || {
        let is_second = INTERRUPTED.swap(true, Ordering::Relaxed);
        let clock = std::thread::Builder::new().name("last moment".to_owned());
        if is_second || clock.spawn(end_after_grace).is_err() {
            end();
        }
    };
    if let Err(error) = ctrlc::set_handler(handler) {
        warn(format_args!("Ctrl-C will end the program without cleaning up: {error}"));
    }
}

/// Ends the process as interrupted, with a message, if it has not ended by itself.
fn end_after_grace() {
    std::thread::sleep(GRACE);
    // Standard error may be blocked, so a thread writes the message.
    std::thread::Builder::new().name("last word".to_owned()).spawn(|| warn(SolveError::Cancelled)).ok();
    std::thread::sleep(LAST_WORD);
    end();
}

/// Ends the process as interrupted, at once.
fn end() {
    discard_unfinished();
    forget_awaited();
    std::process::exit(INTERRUPTED_CODE.into());
}

/// Form of the progress on standard error.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum ProgressForm {
    /// A line that changes, on a terminal only
    #[default]
    Line,
    /// A line of JSON for each change, at most ten each second
    Json,
    /// Nothing
    None,
}

/// Form of the progress of this process.
static FORM: OnceLock<ProgressForm> = OnceLock::new();

/// Sets the form of the progress. Only the first call counts.
pub(super) fn set_form(form: ProgressForm) {
    FORM.set(form).ok();
}

/// Progress of a command as a line of JSON. Field names are part of the interface.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
struct ProgressNumbers {
    /// Current activity.
    activity: &'static str,
    /// Stage that made the last step.
    stage: Option<&'static str>,
    /// Index of the last step.
    step: Option<usize>,
    /// Mean energy of the last step, if its stage measures it; 4 is an isometric map.
    energy: Option<f64>,
    /// Number of finished items of a command that has many.
    done: Option<u64>,
    /// Number of all items.
    total: Option<u64>,
}

/// Line of JSON with the time.
#[derive(Serialize)]
struct TimedProgress<'a> {
    #[serde(flatten)]
    numbers: &'a ProgressNumbers,
    /// Time since the start of the command.
    seconds: f64,
}

/// Progress of a command. On a terminal its line appears if the work takes over half a second.
#[derive(Debug, Default)]
pub(super) struct ProgressLine {
    words: Mutex<Words>,
}

/// Text of the progress line.
#[derive(Debug, Default)]
struct Words {
    /// Last result: the newest step.
    done: String,
    /// Current activity, and numbers of the last result.
    numbers: ProgressNumbers,
}

impl ProgressLine {
    /// Sets the current activity.
    pub(super) fn enter(&self, words: &'static str) {
        if let Ok(mut line) = self.words.lock() {
            line.numbers.activity = words;
        }
    }

    /// Sets the last step as the last result. `words` describe it.
    pub(super) fn reach_step(&self, step: &Step, words: String) {
        if let Ok(mut line) = self.words.lock() {
            line.done = words;
            line.numbers.stage = Some(step.candidate.stage.name());
            line.numbers.step = Some(step.index);
            line.numbers.energy = step.candidate.progress.map(|progress| progress.energy);
        }
    }

    /// Sets the number of finished items as the last result.
    pub(super) fn reach_items(&self, done: u64, total: u64, items: &str) {
        if let Ok(mut line) = self.words.lock() {
            line.done = format!("{done} of {total} {items}");
            (line.numbers.done, line.numbers.total) = (Some(done), Some(total));
        }
    }

    /// Sets the last result.
    pub(super) fn reach(&self, words: String) {
        if let Ok(mut line) = self.words.lock() {
            line.done = words;
        }
    }

    /// Progress line with both texts.
    fn line(&self) -> String {
        self.words.lock().map_or_else(
            |_| "working".to_owned(),
            |line| {
                let Words { done, numbers } = &*line;
                if done.is_empty() { numbers.activity.to_owned() } else { format!("{done}; {}", numbers.activity) }
            },
        )
    }

    /// Runs `work` while standard error shows the progress.
    pub(super) fn follow<T>(&self, work: impl FnOnce() -> T) -> T {
        match FORM.get().copied().unwrap_or_default() {
            ProgressForm::Json => self.follow_in_json(work),
            ProgressForm::Line if std::io::stderr().is_terminal() => self.follow_on_terminal(work),
            ProgressForm::Line | ProgressForm::None => work(),
        }
    }

    fn follow_in_json<T>(&self, work: impl FnOnce() -> T) -> T {
        std::thread::scope(|scope| {
            let (done, wait) = sync_channel::<()>(0);
            let start = Instant::now();
            let tell = move || {
                let mut last = ProgressNumbers::default();
                loop {
                    let is_over = wait.recv_timeout(TICK) != Err(RecvTimeoutError::Timeout);
                    let now = self.words.lock().map(|words| words.numbers.clone()).unwrap_or_default();
                    if now != last {
                        let line = TimedProgress { numbers: &now, seconds: start.elapsed().as_secs_f64() };
                        let text = serde_json::to_string(&line).unwrap_or_default();
                        writeln!(std::io::stderr(), "{text}").ok();
                        last = now;
                    }
                    if is_over {
                        return;
                    }
                }
            };
            let ticker = std::thread::Builder::new().name("progress".to_owned()).spawn_scoped(scope, tell);
            let result = work();
            drop(done);
            drop(ticker);
            result
        })
    }

    fn follow_on_terminal<T>(&self, work: impl FnOnce() -> T) -> T {
        std::thread::scope(|scope| {
            let (done, wait) = sync_channel::<()>(0);
            let ticker = std::thread::Builder::new().name("progress".to_owned()).spawn_scoped(scope, move || {
                let start = Instant::now();
                while wait.recv_timeout(TICK) == Err(RecvTimeoutError::Timeout) {
                    if start.elapsed() >= QUIET {
                        self.show(start.elapsed());
                    }
                }
                if start.elapsed() >= QUIET {
                    write!(std::io::stderr(), "\r\x1b[K").ok();
                }
            });
            let result = work();
            drop(done);
            drop(ticker);
            result
        })
    }

    fn show(&self, elapsed: Duration) {
        let mut terminal = std::io::stderr().lock();
        write!(terminal, "\r\x1b[K{} … {:.1} s", self.line(), elapsed.as_secs_f64()).ok();
        terminal.flush().ok();
    }
}

/// Returns an error if the user interrupted the run.
///
/// # Errors
///
/// [`SolveError::Cancelled`].
pub(super) fn go_on() -> Result<(), SolveError> {
    if is_interrupted() { Err(SolveError::Cancelled) } else { Ok(()) }
}
