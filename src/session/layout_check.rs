//! Verdict on the texture coordinates that the open file came with.

use std::sync::Arc;

use super::{Background, Document, Session, Wake};
use freebound_core::problem::Control;
use freebound_core::verify::{LayoutOptions, LayoutVerdict};
use freebound_io::JudgeError;

/// Check of the layout of the open file. Its key is the number of the opening.
pub(super) struct LayoutCheck {
    job: Background<u64, Result<LayoutVerdict, JudgeError>>,
    found: Option<(u64, Result<Arc<LayoutVerdict>, String>)>,
    /// Document of an opened mesh whose first map waits for the check.
    decides: Option<Box<Document>>,
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
    /// Failed, for this reason.
    Failed(String),
}

impl LayoutCheck {
    pub(super) fn new(wake: &Wake) -> Self {
        Self { job: Background::new("check", wake), found: None, decides: None }
    }

    /// Lets the first map of a document wait for the check.
    pub(super) fn decide(&mut self, document: Document) {
        self.decides = Some(Box::new(document));
    }

    /// Document whose first map waits for the check.
    pub(super) fn decides_for(&self) -> Option<&Document> {
        self.decides.as_deref()
    }

    /// Ends the wait of a first map. Returns true if one was waiting.
    pub(super) fn end_wait(&mut self) -> bool {
        self.decides.take().is_some()
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
        self.layout_check.job.start(self.opening_revision(), move |cancel| {
            let control = Control::new(cancel, &|_| {});
            model.source.judged_layout(LayoutOptions::default(), false, control).map(|found| found.verdict)
        });
    }

    /// Takes the result of the check.
    pub(super) fn poll_layout_check(&mut self) {
        let opening = self.opening_revision();
        if self.layout_check.job.key().is_some_and(|key| *key != opening) {
            self.layout_check.job.cancel();
        }
        if let Some((of, outcome)) = self.layout_check.job.poll() {
            let found = match outcome {
                Ok(found) => found.map(Arc::new).map_err(|error| error.to_string()),
                Err(failure) => Err(failure.words("the check")),
            };
            self.layout_check.found = Some((of, found));
        }
    }
}
