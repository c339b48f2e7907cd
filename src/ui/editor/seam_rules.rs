//! Seams by a rule: at sharp edges, or at borders of materials or groups. The edges are found in the background and
//! cut at once.

use super::async_scene::AsyncScene;
use crate::session::{JobFailure, Model, Wake};
use crate::ui::state::{Edge, SeamRule};
use freebound_core::mesh::Seams;
use freebound_io::LabelError;

/// Edges that a rule chooses.
pub(super) fn edges_of(rule: SeamRule, model: &Model) -> Result<Vec<Edge>, LabelError> {
    match rule {
        SeamRule::Sharp(degrees) => Ok(model.crease_edges(degrees)),
        SeamRule::Materials => model.material_borders(),
        SeamRule::Groups => model.group_borders(),
    }
}

/// State of the search for edges by a rule.
#[derive(Debug)]
pub(in crate::ui) struct SeamRules {
    /// Least angle of a sharp edge, degrees.
    pub(in crate::ui) degrees: f64,
    /// Background job that finds the edges. Key: the rule, and the session's count of openings.
    pub(super) job: AsyncScene<(SeamRule, u64), Result<Vec<Edge>, LabelError>>,
    /// Result message of the last rule, and the seams at that time.
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

    /// Result message of the last rule, until something else is done.
    pub(in crate::ui) fn said(&self) -> Option<&str> {
        self.said.as_ref().map(|(words, _)| &**words)
    }

    pub(super) fn forget_said(&mut self) {
        self.said = None;
    }

    /// Drops the message if the seams have changed.
    pub(super) fn forget_said_of_other(&mut self, seams: &Seams) {
        self.said.take_if(|(_, of)| of != seams);
    }
}
