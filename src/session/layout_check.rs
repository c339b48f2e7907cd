//! Verdict on the texture coordinates that the open file came with.

use std::sync::Arc;

use super::{Background, JobFailure, Session, Wake};
use freebound_core::verify::{LayoutOptions, LayoutVerdict};

/// Check of the layout of the open file. Its key is the number of the opening.
pub(super) struct LayoutCheck {
    job: Background<u64, Option<LayoutVerdict>>,
    found: Option<(u64, Result<Arc<LayoutVerdict>, JobFailure>)>,
}

/// State of the check of the open file's layout.
#[derive(Clone, Debug)]
pub enum LayoutCheckState {
    /// Not requested.
    Open,
    /// In progress.
    Running,
    /// Finished.
    Done(Arc<LayoutVerdict>),
    /// Failed.
    Failed(JobFailure),
}

impl LayoutCheck {
    pub(super) fn new(wake: &Wake) -> Self {
        Self { job: Background::new("check", wake), found: None }
    }
}

impl Session {
    /// State of the check of the open file's layout. `None` if the file has no texture coordinates.
    pub fn layout_check(&self) -> Option<LayoutCheckState> {
        self.model()?.source.texture.as_ref()?;
        let opening = self.opening_revision();
        Some(match &self.layout_check.found {
            _ if self.layout_check.job.key() == Some(&opening) => LayoutCheckState::Running,
            Some((of, Ok(found))) if *of == opening => LayoutCheckState::Done(Arc::clone(found)),
            Some((of, Err(failure))) if *of == opening => LayoutCheckState::Failed(failure.clone()),
            _ => LayoutCheckState::Open,
        })
    }

    /// Judges the texture coordinates of the open file in the background.
    pub(super) fn check_layout(&mut self) {
        let Some(model) = self.model().cloned() else { return };
        let judge = move || model.source.judged_layout(LayoutOptions::default(), false).ok().map(|found| found.verdict);
        self.layout_check.job.start(self.opening_revision(), move |_| judge());
    }

    /// Takes the result of the check.
    pub(super) fn poll_layout_check(&mut self) {
        let opening = self.opening_revision();
        if self.layout_check.job.key().is_some_and(|key| *key != opening) {
            self.layout_check.job.cancel();
        }
        if let Some((of, outcome)) = self.layout_check.job.poll() {
            let found = outcome.map(|found| found.map(Arc::new));
            self.layout_check.found = match found {
                Ok(None) => None,
                Ok(Some(found)) => Some((of, Ok(found))),
                Err(failure) => Some((of, Err(failure))),
            };
        }
    }
}
