//! Work that cannot be stopped, on detached threads, which a cancelled caller leaves behind.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::AtomicBool;
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::time::Duration;

use crate::parallel::spawn_detached;

use super::LinalgError;
use super::pattern::go_on_unless;

/// Interval between two checks of the cancel flag.
const LOOKS: Duration = Duration::from_millis(5);

/// Returns the result of `work`, or leaves it behind if the caller cancels. Work left behind ends by itself and keeps
/// its memory and its share of the processor until then; its result is dropped. The work has its own threads, as many
/// as the caller's pool, since all threads of that pool may be waiting here. If no threads are available, the caller
/// does the work.
///
/// # Errors
///
/// [`LinalgError::Cancelled`].
///
/// # Panics
///
/// If the work panics.
pub(crate) fn run_apart<T: Send + 'static>(
    work: impl FnOnce() -> T + Send + 'static,
    cancel: &AtomicBool,
) -> Result<T, LinalgError> {
    go_on_unless(cancel)?;
    let (send, receive) = sync_channel(1);
    let detached = move || {
        let found = catch_unwind(AssertUnwindSafe(work));
        // A cancelled caller does not receive.
        send.send(found).ok();
    };
    if let Err(detached) = spawn_detached(detached) {
        detached();
    }
    loop {
        match receive.recv_timeout(LOOKS) {
            Ok(Ok(found)) => return Ok(found),
            Ok(Err(panic)) => resume_unwind(panic),
            Err(RecvTimeoutError::Timeout) => go_on_unless(cancel)?,
            Err(RecvTimeoutError::Disconnected) => unreachable!("it sends what it has found"),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::sync::atomic::Ordering;

    use crate::parallel::prelude::*;

    use super::*;

    #[test]
    fn what_is_done_apart_comes_back_and_its_panics_too() {
        let flag = AtomicBool::new(false);
        assert_eq!(run_apart(|| 6 * 7, &flag), Ok(42));
        let panicked = catch_unwind(|| run_apart(|| panic!("of the work's own"), &AtomicBool::new(false)));
        assert_eq!(panicked.map(|_: Result<(), _>| ()).unwrap_err().downcast_ref(), Some(&"of the work's own"));
    }

    #[test]
    fn nobody_waits_for_what_is_left_behind() {
        let flag = Arc::new(AtomicBool::new(false));
        let raises = Arc::clone(&flag);
        let (caller_is_back, wait) = sync_channel::<()>(0);
        let work = move || {
            raises.store(true, Ordering::Relaxed);
            // The caller drops its end.
            assert!(wait.recv().is_err());
        };
        assert_eq!(run_apart(work, &flag), Err(LinalgError::Cancelled));
        drop(caller_is_back);
    }

    /// Waits for parallel work on all threads of the shared pool at once.
    #[test]
    fn work_on_all_threads_is_done_while_all_threads_wait_for_it() {
        let flag = AtomicBool::new(false);
        let sum = || (0..1000_u64).into_par_iter().sum::<u64>();
        let count = 4 * crate::parallel::current_num_threads();
        let sums: Vec<_> = (0..count).into_par_iter().map(|_| run_apart(sum, &flag)).collect();
        assert!(sums.iter().all(|sum| *sum == Ok(499_500)));
    }
}
