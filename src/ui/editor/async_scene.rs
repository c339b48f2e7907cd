//! What is drawn is made in the background, one at a time. What could not be made is said once, and not tried again.

use std::sync::atomic::AtomicBool;

use crate::session::{Background, JobFailure, Wake};

#[derive(Debug)]
pub(super) struct AsyncScene<K, T> {
    job: Background<K, T>,
    /// What could not be made last.
    failed: Option<K>,
    /// Why, until somebody has said so.
    failure: Option<JobFailure>,
}

impl<K: Clone + PartialEq, T: Send + 'static> AsyncScene<K, T> {
    /// A slot without work. `name` is that of its threads; `wake` is called at the end of each piece of work.
    pub(super) fn new(name: &'static str, wake: &Wake) -> Self {
        Self { job: Background::new(name, wake), failed: None, failure: None }
    }

    pub(super) fn is_busy(&self) -> bool {
        self.job.is_busy()
    }

    /// Whether this could not be made.
    pub(super) fn has_failed(&self, key: &K) -> bool {
        self.failed.as_ref() == Some(key)
    }

    /// Why something could not be made; each failure once.
    pub(super) fn take_failure(&mut self) -> Option<JobFailure> {
        self.failure.take()
    }

    /// Drops the work under way.
    pub(super) fn cancel(&mut self) {
        self.job.cancel();
    }

    /// Makes something, unless something is being made or this could not be made before.
    pub(super) fn make(&mut self, key: K, work: impl FnOnce(&AtomicBool) -> T + Send + 'static) {
        if !self.is_busy() && !self.has_failed(&key) {
            self.job.start(key, work);
        }
    }

    /// What was made, once. Call once per frame.
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
