//! Seams by a rule: at sharp edges, or where materials or groups meet. They are found in the background and cut at once.

use std::sync::Arc;

use super::making::Making;
use super::seam_tool::Edge;
use crate::io::LabelError;
use crate::mesh::Seams;
use crate::session::{Action, Failure, Model, Wake};
use crate::ui::{Editor, Tool, counted, sentence};

/// Which edges become seams.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SeamRule {
    /// Where faces meet at an angle of so many degrees or more between their normals.
    Sharp(f64),
    /// Where faces of two materials meet.
    Materials,
    /// Where faces of two groups or objects meet.
    Groups,
}

impl SeamRule {
    fn edges(self, model: &Model) -> Result<Vec<Edge>, LabelError> {
        match self {
            Self::Sharp(degrees) => Ok(model.crease_edges(degrees)),
            Self::Materials => model.material_borders(),
            Self::Groups => model.group_borders(),
        }
    }
}

/// Seams by a rule, as they are asked for and found.
#[derive(Debug)]
pub(in crate::ui) struct SeamRules {
    /// The least angle of a sharp edge, degrees.
    pub(in crate::ui) degrees: f64,
    /// By the rule, and what is open, by the session's count.
    job: Making<(SeamRule, u64), Result<Vec<Edge>, LabelError>>,
    /// What came of the last one, and the seams that there were then.
    said: Option<(String, Seams)>,
}

impl SeamRules {
    pub(super) fn new(wake: &Wake) -> Self {
        Self { degrees: Model::SHARP_DEGREES, job: Making::new("seams by a rule", wake), said: None }
    }

    pub(super) fn is_busy(&self) -> bool {
        self.job.is_busy()
    }

    pub(super) fn take_failure(&mut self) -> Option<Failure> {
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
    fn forget_said_of_other(&mut self, seams: &Seams) {
        self.said.take_if(|(_, of)| of != seams);
    }
}

impl Editor {
    /// Has the edges of a rule found, with the tool in hand that says what comes of it.
    pub(super) fn cut_by_rule(&mut self, rule: SeamRule) {
        let Some(model) = self.session.model().map(Arc::clone) else { return };
        self.tools.take_up(Tool::Seam);
        let key = (rule, self.session.opening_revision());
        self.tools.seam.rules.job.make(key, move |_| rule.edges(&model));
    }

    /// Cuts along the edges of a rule once they are found, and no drag goes on, of which they would be a part. Call once per frame.
    pub(super) fn take_seams_by_rule(&mut self) {
        self.tools.seam.rules.forget_said_of_other(self.session.seams());
        if self.session.is_in_gesture() {
            return;
        }
        let opening = self.session.opening_revision();
        let Some((_, found)) = self.tools.seam.rules.job.poll().filter(|((_, of), _)| *of == opening) else { return };
        let words = match found {
            Err(error) => sentence(&error.to_string()),
            Ok(edges) => {
                let before = self.session.seams();
                let seams = before.with(edges);
                let count = seams.edges().len() - before.edges().len();
                if count > 0 {
                    self.session.handle(Action::SetSeams(seams));
                }
                format!("{} more", counted(count, "edge", "edges"))
            }
        };
        let said = Some((words, self.session.seams().clone()));
        self.tools.seam.rules.said = said.filter(|_| self.tools.tool() == Tool::Seam);
    }
}
