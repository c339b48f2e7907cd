//! Progress on a terminal, and Ctrl-C.

use std::io::{IsTerminal as _, Write as _};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::time::{Duration, Instant};

use super::awaited::forget_awaited;
use super::error::INTERRUPTED as INTERRUPTED_CODE;
use super::say::warn;
use freebound_core::problem::SolveError;
use freebound_io::discard_unfinished;

/// Work shorter than this goes by without a word.
const QUIET: Duration = Duration::from_millis(500);

/// Time between two looks at the clock.
const TICK: Duration = Duration::from_millis(100);

/// Time that work has to stop by itself once it is asked to. With what it takes to end the process, a tenth of a second.
const GRACE: Duration = Duration::from_millis(50);

/// Time for the last word.
const LAST_WORD: Duration = Duration::from_millis(10);

/// The flag that Ctrl-C raises.
pub(super) static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Whether the user asked to stop.
pub(super) fn is_interrupted() -> bool {
    INTERRUPTED.load(Ordering::Relaxed)
}

/// Makes Ctrl-C and the system's wish to end the program raise the flag. Work that has not stopped a moment later is left
/// where it is; a second signal does not wait for that moment. Files are written aside and renamed, so neither leaves one
/// half-written.
pub(super) fn stop_on_interrupt() {
    let handler = || {
        let is_second = INTERRUPTED.swap(true, Ordering::Relaxed);
        let clock = std::thread::Builder::new().name("last moment".to_owned());
        if is_second || clock.spawn(end_after_grace).is_err() {
            end();
        }
    };
    if let Err(error) = ctrlc::set_handler(handler) {
        warn(format_args!("Ctrl-C will end the program without clearing up: {error}"));
    }
}

/// Ends the process as an interrupted one if it has not ended by itself, and says so where somebody reads it.
fn end_after_grace() {
    std::thread::sleep(GRACE);
    // Standard error may be blocked.
    std::thread::Builder::new().name("last word".to_owned()).spawn(|| warn(SolveError::Cancelled)).ok();
    std::thread::sleep(LAST_WORD);
    end();
}

/// Ends the process as an interrupted one, whatever it is doing.
fn end() {
    discard_unfinished();
    forget_awaited();
    std::process::exit(INTERRUPTED_CODE.into());
}

/// What the program is doing, shown on a terminal once it takes over half a second.
#[derive(Debug, Default)]
pub(super) struct ProgressLine {
    words: Mutex<Words>,
}

/// The line's words.
#[derive(Debug, Default)]
struct Words {
    /// What is done: the last step.
    done: String,
    /// What is being done.
    doing: &'static str,
}

impl ProgressLine {
    /// Names what begins now.
    pub(super) fn enter(&self, words: &'static str) {
        if let Ok(mut line) = self.words.lock() {
            line.doing = words;
        }
    }

    /// Says what has been reached, until something else is.
    pub(super) fn reach(&self, words: String) {
        if let Ok(mut line) = self.words.lock() {
            line.done = words;
        }
    }

    /// Both in one line.
    fn line(&self) -> String {
        self.words.lock().map_or_else(
            |_| "working".to_owned(),
            |line| if line.done.is_empty() { line.doing.to_owned() } else { format!("{}; {}", line.done, line.doing) },
        )
    }

    /// Runs `work` while a line on the terminal follows it.
    pub(super) fn follow<T>(&self, work: impl FnOnce() -> T) -> T {
        if !std::io::stderr().is_terminal() {
            return work();
        }
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

/// Stops the run if the user asked for it.
///
/// # Errors
///
/// [`SolveError::Cancelled`].
pub(super) fn go_on() -> Result<(), SolveError> {
    if is_interrupted() { Err(SolveError::Cancelled) } else { Ok(()) }
}
