//! Work that cannot be stopped, on threads of its own, which a caller who gives up leaves behind.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::AtomicBool;
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::time::Duration;

use crate::parallel::spawn_detached;

use super::LinalgError;
use super::pattern::go_on_unless;

/// How often the wish to stop is looked at meanwhile.
const LOOKS: Duration = Duration::from_millis(5);

/// What `work` gives, unless the caller gives up before: then it ends by itself, with its memory and its share of the
/// processor until then, and nobody hears of it. It has as many threads as the caller's, but none of these: those may all
/// be waiting here. Where there are none to be had, it is done by the caller.
///
/// # Errors
///
/// [`LinalgError::Cancelled`].
///
/// # Panics
///
/// Where the work does.
pub(crate) fn run_apart<T: Send + 'static>(
    work: impl FnOnce() -> T + Send + 'static,
    cancel: &AtomicBool,
) -> Result<T, LinalgError> {
    go_on_unless(cancel)?;
    let (send, receive) = sync_channel(1);
    let detached = move || {
        let found = catch_unwind(AssertUnwindSafe(work));
        // A caller who gave up does not listen.
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
            // The caller lets go of the other end.
            assert!(wait.recv().is_err());
        };
        assert_eq!(run_apart(work, &flag), Err(LinalgError::Cancelled));
        drop(caller_is_back);
    }

    /// All threads of the pool that everybody shares wait for work that shares itself out.
    #[test]
    fn work_on_all_threads_is_done_while_all_threads_wait_for_it() {
        let flag = AtomicBool::new(false);
        let sum = || (0..1000_u64).into_par_iter().sum::<u64>();
        let count = 4 * crate::parallel::current_num_threads();
        let sums: Vec<_> = (0..count).into_par_iter().map(|_| run_apart(sum, &flag)).collect();
        assert!(sums.iter().all(|sum| *sum == Ok(499_500)));
    }
}
