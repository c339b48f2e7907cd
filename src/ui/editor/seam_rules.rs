//! Seams by a rule: at sharp edges, or where materials or groups meet. They are found in the background and cut at once.

use super::async_scene::AsyncScene;
use crate::session::{JobFailure, Model, Wake};
use crate::ui::state::{Edge, SeamRule};
use freebound_core::mesh::Seams;
use freebound_io::LabelError;

/// The edges that a rule chooses.
pub(super) fn edges_of(rule: SeamRule, model: &Model) -> Result<Vec<Edge>, LabelError> {
    match rule {
        SeamRule::Sharp(degrees) => Ok(model.crease_edges(degrees)),
        SeamRule::Materials => model.material_borders(),
        SeamRule::Groups => model.group_borders(),
    }
}

/// Seams by a rule, as they are asked for and found.
#[derive(Debug)]
pub(in crate::ui) struct SeamRules {
    /// The least angle of a sharp edge, degrees.
    pub(in crate::ui) degrees: f64,
    /// By the rule, and what is open, by the session's count.
    pub(super) job: AsyncScene<(SeamRule, u64), Result<Vec<Edge>, LabelError>>,
    /// What came of the last one, and the seams that there were then.
    pub(super) said: Option<(String, Seams)>,
}

impl SeamRules {
    pub(super) fn new(wake: &Wake) -> Self {
        Self { degrees: Model::SHARP_DEGREES, job: AsyncScene::new("seams by a rule", wake), said: None }
    }

    pub(super) fn is_busy(&self) -> bool {
        self.job.is_busy()
    }

    pub(super) fn take_failure(&mut self) -> Option<JobFailure> {
        self.job.take_failure()
    }

    /// What came of the last rule, until something else is done.
    pub(in crate::ui) fn said(&self) -> Option<&str> {
        self.said.as_ref().map(|(words, _)| &**words)
    }

    pub(super) fn forget_said(&mut self) {
        self.said = None;
    }

    /// Forgets it where the seams are others by now.
    pub(super) fn forget_said_of_other(&mut self, seams: &Seams) {
        self.said.take_if(|(_, of)| of != seams);
    }
}
