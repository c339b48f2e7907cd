//! Background construction of drawn data, one job at a time. A failure is reported once, and its job is not retried.

use std::sync::atomic::AtomicBool;

use crate::session::{Background, JobFailure, Wake};

#[derive(Debug)]
pub(super) struct AsyncScene<K, T> {
    job: Background<K, T>,
    /// Key of the last job, if it failed.
    failed: Option<K>,
    /// Reason of the last failure, until it is reported.
    failure: Option<JobFailure>,
}

impl<K: Clone + PartialEq, T: Send + 'static> AsyncScene<K, T> {
    /// Slot without a job. `name` is the name of its threads; `wake` is called at the end of each job.
    pub(super) fn new(name: &'static str, wake: &Wake) -> Self {
        Self { job: Background::new(name, wake), failed: None, failure: None }
    }

    pub(super) fn is_busy(&self) -> bool {
        self.job.is_busy()
    }

    /// True if the last failed job has this key.
    pub(super) fn has_failed(&self, key: &K) -> bool {
        self.failed.as_ref() == Some(key)
    }

    /// Last failure, returned once.
    pub(super) fn take_failure(&mut self) -> Option<JobFailure> {
        self.failure.take()
    }

    /// Cancels the running job.
    pub(super) fn cancel(&mut self) {
        self.job.cancel();
    }

    /// Starts a job, unless a job is running or the last one with this key failed.
    pub(super) fn make(&mut self, key: K, work: impl FnOnce(&AtomicBool) -> T + Send + 'static) {
        if !self.is_busy() && !self.has_failed(&key) {
            self.job.start(key, work);
        }
    }

    /// Result of a finished job, returned once. Call once per frame.
    pub(super) fn poll(&mut self) -> Option<(K, T)> {
        match self.job.poll()? {
            (key, Ok(made)) => {
                self.failed = None;
                Some((key, made))
            }
            (key, Err(failure)) => {
                (self.failed, self.failure) = (Some(key), Some(failure));
                None
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::time::Duration;

    use super::*;

    fn poll_to_the_end(scenes: &mut AsyncScene<u8, u8>) -> Option<(u8, u8)> {
        while scenes.is_busy() {
            std::thread::sleep(Duration::from_millis(1));
            if let Some(made) = scenes.poll() {
                return Some(made);
            }
        }
        None
    }

    #[test]
    fn what_could_not_be_made_is_said_once_and_not_tried_again() {
        let mut scenes = AsyncScene::new("test", &(Arc::new(|| {}) as Wake));
        scenes.make(1, |_| panic!("on purpose"));
        assert_eq!(poll_to_the_end(&mut scenes), None);
        assert!(scenes.has_failed(&1) && !scenes.has_failed(&2));
        assert_eq!(scenes.take_failure(), Some(JobFailure::Lost));
        assert_eq!(scenes.take_failure(), None);
        scenes.make(1, |_| 10);
        assert!(!scenes.is_busy());
        scenes.make(2, |_| 20);
        assert_eq!(poll_to_the_end(&mut scenes), Some((2, 20)));
    }
}
