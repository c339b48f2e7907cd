//! The state that the window keeps of the open document beside the session: whether it is on the screen yet, and questions
//! that were dismissed.

use std::time::{Duration, Instant};

use crate::session::Session;

/// How old the view in a copy for recovery may be. A selection can be large, so that it is not taken every frame.
const VIEW_INTERVAL: Duration = Duration::from_secs(1);

#[derive(Debug, Default)]
pub struct Opened {
    /// What is on the screen, by the session's count of openings.
    on_screen: Option<u64>,
    /// Whether what is on the screen is one chart of several.
    has_charts: bool,
    /// The mesh that the session had last, by its revision.
    model: u64,
    /// When the session was last told how the person looks at it.
    view_kept: Option<Instant>,
    /// The mesh, by its revision, whose faces may point inward.
    faces_left: Option<u64>,
    /// What was opened, by the session's count, where the targets may look mirrored.
    targets_left: Option<u64>,
}

impl Opened {
    /// Takes in that the session's mesh is on the screen. Returns whether it is of another opening than before.
    pub(super) fn put_on_screen(&mut self, session: &Session) -> bool {
        self.on_screen.replace(session.opening_revision()) != Some(session.opening_revision())
    }

    /// Takes in whether the mesh on the screen has several charts. Returns whether it has them since now.
    pub(super) fn note_charts(&mut self, session: &Session) -> bool {
        let has_charts = session.charts().is_some();
        !std::mem::replace(&mut self.has_charts, has_charts) && has_charts
    }

    /// Takes in which mesh, in which form, the session has. Returns the revision of the one before, where that was another.
    pub(super) fn note_model(&mut self, session: &Session) -> Option<u64> {
        let before = std::mem::replace(&mut self.model, session.model_revision());
        (before != self.model).then_some(before)
    }

    pub(super) fn is_on_screen(&self, session: &Session) -> bool {
        self.on_screen == Some(session.opening_revision())
    }

    /// Whether the view is due to be kept, which it then counts as. Call once per frame.
    pub(super) fn view_is_due(&mut self, session: &Session) -> bool {
        let is_due = self.view_kept.is_none_or(|kept| kept.elapsed() >= VIEW_INTERVAL) && session.has_unsaved_work();
        if is_due {
            self.view_kept = Some(Instant::now());
        }
        is_due
    }

    pub(super) fn leave_faces(&mut self, session: &Session) {
        self.faces_left = Some(session.model_revision());
    }

    pub(super) fn leave_targets(&mut self, session: &Session) {
        self.targets_left = Some(session.opening_revision());
    }

    /// Whether the mesh's faces point inward, and nobody said that they may.
    pub(in crate::ui) fn faces_point_inward(&self, session: &Session) -> bool {
        self.faces_left != Some(session.model_revision())
            && session.model().is_some_and(|model| model.prepared.faces_point_inward)
    }

    /// Whether the targets look mirrored, and nobody said that they may.
    pub(in crate::ui) fn targets_look_mirrored(&self, session: &Session) -> bool {
        self.targets_left != Some(session.opening_revision()) && session.targets_look_mirrored()
    }
}
