//! Work on background threads, with one slot for each kind of work.
//!
//! ```text
//! start(key, work) ──▶ thread: work(&cancel) ──▶ wake ──▶ poll() = Some((key, outcome)), once
//! ```
//!
//! The key identifies a piece of work. Its owner compares the key on arrival and drops outdated results. A thread that
//! panicked, or that could not be started, arrives as a [`JobFailure`].

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};
use std::{fmt, thread};

/// Callback that requests another frame. Background threads call it.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// Reason why a job returned no outcome.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum JobFailure {
    /// The operating system started no thread, with this error.
    NoThread(String),
    /// The thread panicked.
    Lost,
}

impl JobFailure {
    /// Message for the user. `work` is a noun, such as "saving".
    pub fn words(&self, work: &str) -> String {
        match self {
            Self::NoThread(error) => format!("{work} could not start a thread: {error}"),
            Self::Lost => format!("{work} stopped unexpectedly"),
        }
    }

    /// Action that the message suggests.
    pub const fn remedy(&self) -> Option<&'static str> {
        match self {
            Self::NoThread(_) => None,
            Self::Lost => Some("this is a bug in Freebound: please report it with the mesh"),
        }
    }
}

/// Background work of one kind, usually one job at a time. Dropping the slot asks its jobs to stop.
pub struct Background<K, T> {
    name: &'static str,
    wake: Wake,
    jobs: Vec<Job<K, T>>,
}

/// Job on a thread.
struct Job<K, T> {
    key: K,
    cancel: CancelOnDrop,
    outcome: Result<Receiver<T>, JobFailure>,
}

impl<K, T> Background<K, T> {
    /// Returns an empty slot. `name` names its threads. `wake` is called at the end of each job.
    pub fn new(name: &'static str, wake: &Wake) -> Self {
        Self { name, wake: Arc::clone(wake), jobs: Vec::new() }
    }

    /// Key of the oldest job.
    pub fn key(&self) -> Option<&K> {
        self.keys().next()
    }

    /// Keys of all jobs, oldest first.
    pub fn keys(&self) -> impl Iterator<Item = &K> {
        self.jobs.iter().map(|job| &job.key)
    }

    /// True if a job is running or its outcome has not been polled yet.
    pub fn is_busy(&self) -> bool {
        !self.jobs.is_empty()
    }

    /// Drops all jobs.
    pub fn cancel(&mut self) {
        self.jobs.clear();
    }

    /// Drops all jobs whose key is not kept.
    pub(super) fn cancel_but(&mut self, is_kept: impl Fn(&K) -> bool) {
        self.jobs.retain(|job| is_kept(&job.key));
    }

    /// Asks the jobs to stop at their next check. Their outcomes still arrive.
    pub fn interrupt(&self) {
        for job in &self.jobs {
            job.cancel.0.store(true, Ordering::Relaxed);
        }
    }

    /// Returns the outcome of a job that has ended. Each outcome is returned once. Call once per frame.
    pub fn poll(&mut self) -> Option<(K, Result<T, JobFailure>)> {
        let ended = |(index, job): (usize, &Job<K, T>)| Some((index, job.outcome()?));
        let (index, outcome) = self.jobs.iter().enumerate().find_map(ended)?;
        Some((self.jobs.remove(index).key, outcome))
    }

    /// Returns an outcome as [`poll`](Self::poll) does, but in the order of starting for jobs with equal keys.
    pub(super) fn poll_in_order(&mut self) -> Option<(K, Result<T, JobFailure>)>
    where
        K: PartialEq,
    {
        let is_first = |index: usize| self.keys().position(|key| *key == self.jobs[index].key) == Some(index);
        let ended = |(index, job): (usize, &Job<K, T>)| Some((index, job.outcome()?));
        let mut in_order = self.jobs.iter().enumerate().filter(|(index, _)| is_first(*index));
        let (index, outcome) = in_order.find_map(ended)?;
        Some((self.jobs.remove(index).key, outcome))
    }
}

impl<K, T: Send + 'static> Background<K, T> {
    /// Starts a job and drops the jobs before it. `work` checks its flag regularly and stops once the flag is set.
    pub fn start(&mut self, key: K, work: impl FnOnce(&AtomicBool) -> T + Send + 'static) {
        self.cancel();
        self.add(key, work);
    }

    /// Starts a job beside the running jobs.
    pub fn add(&mut self, key: K, work: impl FnOnce(&AtomicBool) -> T + Send + 'static) {
        let cancel = CancelOnDrop(Arc::new(AtomicBool::new(false)));
        let (sender, receiver) = sync_channel(1);
        let (flag, wake) = (Arc::clone(&cancel.0), Arc::clone(&self.wake));
        let run = move || {
            let outcome = work(&flag);
            // Sending fails if the owner is gone. The outcome is not needed then.
            sender.send(outcome).ok();
            // Disconnect the channel before waking, so that the woken thread sees the final state.
            drop(sender);
            wake();
        };
        let thread = thread::Builder::new().name(self.name.to_owned()).spawn(run);
        let outcome = thread.map(|_| receiver).map_err(|error| JobFailure::NoThread(error.to_string()));
        self.jobs.push(Job { key, cancel, outcome });
    }
}

impl<K, T> Job<K, T> {
    fn outcome(&self) -> Option<Result<T, JobFailure>> {
        match &self.outcome {
            Err(failure) => Some(Err(failure.clone())),
            Ok(receiver) => match receiver.try_recv() {
                Ok(outcome) => Some(Ok(outcome)),
                Err(TryRecvError::Empty) => None,
                Err(TryRecvError::Disconnected) => Some(Err(JobFailure::Lost)),
            },
        }
    }
}

/// Cancellation flag of a job. Dropping it sets the flag, because nothing waits for the outcome then.
struct CancelOnDrop(Arc<AtomicBool>);

impl Drop for CancelOnDrop {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

impl<K, T> fmt::Debug for Background<K, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Background({}, {} under way)", self.name, self.jobs.len())
    }
}
