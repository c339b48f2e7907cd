//! Cancelling work after a time limit.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::time::{Duration, Instant};

/// Runs `work` and raises `flag` after `limit`. Also returns how long the work continued after that; `None` if it
/// finished in time.
pub(crate) fn within<R>(limit: Duration, flag: &AtomicBool, work: impl FnOnce() -> R) -> (R, Option<Duration>) {
    std::thread::scope(|scope| {
        let (done, wait) = sync_channel::<()>(0);
        let raising = scope.spawn(move || {
            let is_late = wait.recv_timeout(limit) == Err(RecvTimeoutError::Timeout);
            is_late.then(|| {
                let raised = Instant::now();
                flag.store(true, Ordering::Relaxed);
                raised
            })
        });
        let result = work();
        let ended = Instant::now();
        drop(done);
        let raised = raising.join().expect("it only waits");
        (result, raised.map(|raised| ended.saturating_duration_since(raised)))
    })
}
