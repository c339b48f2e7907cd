//! Work that cannot be stopped, on a thread of its own, which a caller who gives up leaves behind.

use std::sync::atomic::AtomicBool;
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::Builder;
use std::time::Duration;

use super::LinalgError;
use super::order::go_on_unless;

/// How often the wish to stop is looked at meanwhile.
const LOOKS: Duration = Duration::from_millis(5);

/// What `work` gives, unless the caller gives up before: then the work ends by itself, and nobody hears of it. Where there
/// is no thread to be had, it is done here.
///
/// # Errors
///
/// [`LinalgError::Cancelled`].
///
/// # Panics
///
/// Where the work does.
pub fn apart<T: Send + 'static>(
    work: impl FnOnce() -> T + Send + 'static,
    cancel: &AtomicBool,
) -> Result<T, LinalgError> {
    go_on_unless(cancel)?;
    let (send, receive) = sync_channel(1);
    // Whoever comes first does it.
    let work = Arc::new(Mutex::new(Some(work)));
    let there = Arc::clone(&work);
    let take = |work: &Mutex<Option<_>>| work.lock().unwrap_or_else(PoisonError::into_inner).take();
    let started = Builder::new().name("apart".to_owned()).spawn(move || {
        let work = take(&there);
        // A caller who gave up does not listen.
        work.map(|work| send.send(work()))
    });
    let Ok(thread) = started else {
        let work = take(&work).expect("no thread has taken it");
        return Ok(work());
    };
    loop {
        match receive.recv_timeout(LOOKS) {
            Ok(found) => return Ok(found),
            Err(RecvTimeoutError::Timeout) => go_on_unless(cancel)?,
            Err(RecvTimeoutError::Disconnected) => match thread.join() {
                Err(panic) => std::panic::resume_unwind(panic),
                Ok(_) => unreachable!("it sends what it has found"),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::Ordering;

    use super::*;

    #[test]
    fn what_is_done_apart_comes_back_and_its_panics_too() {
        let flag = AtomicBool::new(false);
        assert_eq!(apart(|| 6 * 7, &flag), Ok(42));
        let panicked = std::panic::catch_unwind(|| apart(|| panic!("of the work's own"), &AtomicBool::new(false)));
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
        assert_eq!(apart(work, &flag), Err(LinalgError::Cancelled));
        drop(caller_is_back);
    }
}
