//! Work on a background thread, with progress and cancel. Knows no screen.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TryRecvError, sync_channel};
use std::thread;

/// Progress messages kept before new ones are dropped.
const PROGRESS_CAPACITY: usize = 64;

/// The worker's end: how to report and when to stop.
#[derive(Debug)]
pub struct JobContext<P> {
    cancel: Arc<AtomicBool>,
    progress: SyncSender<P>,
}

impl<P> JobContext<P> {
    /// Reports progress. A full channel drops the report: progress must never block work.
    pub fn report(&self, progress: P) {
        self.progress.try_send(progress).ok();
    }

    /// The flag that the owner raises to stop the work.
    pub fn cancel_flag(&self) -> &AtomicBool {
        &self.cancel
    }
}

/// What a running job has to say since the last look.
#[derive(Debug, PartialEq, Eq)]
pub enum Poll<T> {
    /// Still at work.
    Running,
    /// Finished, and this is the only time the outcome is handed out.
    Done(T),
    /// The worker panicked, or its outcome was already handed out.
    Lost,
}

/// The owner's end of a background computation. Dropping it asks the work to stop.
#[derive(Debug)]
pub struct Job<P, T> {
    cancel: Arc<AtomicBool>,
    progress: Receiver<P>,
    outcome: Receiver<T>,
}

impl<P: Send + 'static, T: Send + 'static> Job<P, T> {
    /// Starts `work` on a thread called `name`. `wake` runs once at the end, to ask for a repaint.
    ///
    /// # Errors
    ///
    /// If the operating system cannot start a thread.
    pub fn spawn(
        name: &str,
        wake: impl FnOnce() + Send + 'static,
        work: impl FnOnce(&JobContext<P>) -> T + Send + 'static,
    ) -> std::io::Result<Self> {
        let cancel = Arc::new(AtomicBool::new(false));
        let (progress_end, progress) = sync_channel(PROGRESS_CAPACITY);
        let (outcome_end, outcome) = sync_channel(1);
        let context = JobContext { cancel: Arc::clone(&cancel), progress: progress_end };
        thread::Builder::new().name(name.to_owned()).spawn(move || {
            // The owner may be gone; then nobody wants the outcome.
            outcome_end.send(work(&context)).ok();
            // Closed before the wake, so that whoever wakes sees the final state.
            drop(outcome_end);
            wake();
        })?;
        Ok(Self { cancel, progress, outcome })
    }
}

impl<P, T> Job<P, T> {
    /// Asks the work to stop. It does so at its next check.
    pub fn cancel(&self) {
        self.cancel.store(true, Ordering::Relaxed);
    }

    /// The newest progress report since the last call.
    pub fn latest_progress(&self) -> Option<P> {
        self.progress.try_iter().last()
    }

    /// Looks for the outcome without waiting.
    pub fn poll(&self) -> Poll<T> {
        match self.outcome.try_recv() {
            Ok(outcome) => Poll::Done(outcome),
            Err(TryRecvError::Empty) => Poll::Running,
            Err(TryRecvError::Disconnected) => Poll::Lost,
        }
    }
}

impl<P, T> Drop for Job<P, T> {
    fn drop(&mut self) {
        self.cancel();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cancel_stops_the_loop() {
        let (woken_end, woken) = sync_channel(1);
        let job = Job::spawn(
            "count",
            move || woken_end.send(()).unwrap(),
            |context| {
                let mut steps = 0_u64;
                while !context.cancel_flag().load(Ordering::Relaxed) {
                    steps += 1;
                    context.report(steps);
                }
                steps
            },
        )
        .unwrap();
        job.cancel();
        woken.recv().unwrap();
        assert!(matches!(job.poll(), Poll::Done(_)));
        assert_eq!(job.poll(), Poll::Lost);
    }

    #[test]
    fn a_panic_in_the_work_is_a_lost_job() {
        let job = Job::<(), ()>::spawn("doomed", || (), |_| panic!("on purpose")).unwrap();
        while job.poll() == Poll::Running {
            thread::yield_now();
        }
        assert_eq!(job.poll(), Poll::Lost);
    }
}
