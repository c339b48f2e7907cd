//! Seams by a rule: at sharp edges, or where materials or groups meet. They are found in the background and cut at once.

use std::sync::Arc;

use super::making::Making;
use super::seam_tool::Edge;
use crate::io::LabelError;
use crate::session::{Action, Failure, Model, Wake};
use crate::ui::{Editor, counted, sentence};

/// The least angle of a sharp edge at the start, degrees.
pub(in crate::ui) const SHARP: f64 = 60.0;

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
    /// What came of the last one.
    said: Option<String>,
}

impl SeamRules {
    pub(super) fn new(wake: &Wake) -> Self {
        Self { degrees: SHARP, job: Making::new("seams by a rule", wake), said: None }
    }

    pub(super) fn is_busy(&self) -> bool {
        self.job.is_busy()
    }

    pub(super) fn take_failure(&mut self) -> Option<Failure> {
        self.job.take_failure()
    }

    /// What came of the last rule, until something else is done.
    pub(in crate::ui) fn said(&self) -> Option<&str> {
        self.said.as_deref()
    }

    pub(super) fn forget_said(&mut self) {
        self.said = None;
    }
}

impl Editor {
    /// Has the edges of a rule found.
    pub(super) fn cut_by_rule(&mut self, rule: SeamRule) {
        let Some(model) = self.session.model().map(Arc::clone) else { return };
        let key = (rule, self.session.opening_revision());
        self.tools.seam.rules.job.make(key, move |_| rule.edges(&model));
    }

    /// Cuts along the edges of a rule once they are found. Call once per frame.
    pub(super) fn take_seams_by_rule(&mut self) {
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
        self.tools.seam.rules.said = Some(words);
    }
}
