//! Work on background threads: a slot for each kind of it.
//!
//! ```text
//! start(key, work) ──▶ thread: work(&cancel) ──▶ wake ──▶ poll() = Some((key, outcome)), once
//! ```
//!
//! The key says what a piece of work is for; its owner compares it on arrival and drops what is out of date. A thread
//! that panicked, or that could not be started, arrives as a [`JobFailure`].

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};
use std::{fmt, thread};

/// Asks the screen to look again; called from background threads.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// Why work gave no outcome.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum JobFailure {
    /// The operating system started no thread, for this reason.
    NoThread(String),
    /// The thread panicked.
    Lost,
}

impl JobFailure {
    /// What to tell a person, where `work` is a noun, such as "saving".
    pub fn words(&self, work: &str) -> String {
        match self {
            Self::NoThread(error) => format!("no thread for {work}: {error}"),
            Self::Lost => format!("{work} stopped unexpectedly"),
        }
    }

    /// What to do about it.
    pub const fn remedy(&self) -> Option<&'static str> {
        match self {
            Self::NoThread(_) => None,
            Self::Lost => Some("this is a bug in Freebound: please report it with the mesh"),
        }
    }
}

/// Work of one kind in the background, as a rule one piece at a time. Dropping it asks the work to stop.
pub struct Background<K, T> {
    name: &'static str,
    wake: Wake,
    jobs: Vec<Job<K, T>>,
}

/// One piece of work.
struct Job<K, T> {
    key: K,
    cancel: CancelOnDrop,
    outcome: Result<Receiver<T>, JobFailure>,
}

impl<K, T> Background<K, T> {
    /// A slot without work. `name` is that of its threads; `wake` is called at the end of each piece of work.
    pub fn new(name: &'static str, wake: &Wake) -> Self {
        Self { name, wake: Arc::clone(wake), jobs: Vec::new() }
    }

    /// The key of the work under way, the oldest where there are several.
    pub fn key(&self) -> Option<&K> {
        self.keys().next()
    }

    /// The keys of all work under way, in the order of its beginning.
    pub fn keys(&self) -> impl Iterator<Item = &K> {
        self.jobs.iter().map(|job| &job.key)
    }

    /// Whether work is under way, or its outcome was not taken yet.
    pub fn is_busy(&self) -> bool {
        !self.jobs.is_empty()
    }

    /// Drops all work.
    pub fn cancel(&mut self) {
        self.jobs.clear();
    }

    /// Drops all work but what has one of these keys.
    pub(super) fn cancel_but(&mut self, is_kept: impl Fn(&K) -> bool) {
        self.jobs.retain(|job| is_kept(&job.key));
    }

    /// Asks the work to stop at its next check. Its outcome still arrives.
    pub fn interrupt(&self) {
        for job in &self.jobs {
            job.cancel.0.store(true, Ordering::Relaxed);
        }
    }

    /// The outcome of a piece of work that has ended, each once. Call once per frame.
    pub fn poll(&mut self) -> Option<(K, Result<T, JobFailure>)> {
        let ended = |(index, job): (usize, &Job<K, T>)| Some((index, job.outcome()?));
        let (index, outcome) = self.jobs.iter().enumerate().find_map(ended)?;
        Some((self.jobs.remove(index).key, outcome))
    }

    /// As [`poll`](Self::poll); of pieces of work with the same key, the one that began first comes first.
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
    /// Starts work in the place of what is under way. It looks at its flag now and then, and stops where that is raised.
    pub fn start(&mut self, key: K, work: impl FnOnce(&AtomicBool) -> T + Send + 'static) {
        self.cancel();
        self.add(key, work);
    }

    /// Starts work beside what is under way.
    pub fn add(&mut self, key: K, work: impl FnOnce(&AtomicBool) -> T + Send + 'static) {
        let cancel = CancelOnDrop(Arc::new(AtomicBool::new(false)));
        let (sender, receiver) = sync_channel(1);
        let (flag, wake) = (Arc::clone(&cancel.0), Arc::clone(&self.wake));
        let run = move || {
            let outcome = work(&flag);
            // The owner may be gone; then nobody wants the outcome.
            sender.send(outcome).ok();
            // Closed before the wake, so that whoever wakes sees the final state.
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

/// The flag that asks work to stop. It is raised where nobody waits for the outcome any more.
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
