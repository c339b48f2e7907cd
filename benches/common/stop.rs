//! Stopping work after a while.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::time::{Duration, Instant};

/// Does some work, and raises a flag where it takes longer. Also returns how long it went on from then, where it came to that.
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
