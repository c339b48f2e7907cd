//! State of the window for the open document, outside the session: whether the document is on the screen yet, and the
//! dismissed questions.

use std::time::{Duration, Instant};

use crate::session::{MapOrigin, Session};
use freebound_core::mesh::VertexId;

/// Greatest age of the view in a recovery copy. A selection can be large, so the view is not stored every frame.
const VIEW_INTERVAL: Duration = Duration::from_secs(1);

#[derive(Debug, Default)]
pub struct Opened {
    /// Opening on the screen, by the session's count of openings.
    on_screen: Option<u64>,
    /// True if the mesh on the screen is one of several charts.
    has_charts: bool,
    /// Revision of the session's last mesh.
    model: u64,
    /// Time at which the session last received the view.
    view_kept: Option<Instant>,
    /// Revision of the mesh whose inward faces the user accepted.
    faces_left: Option<u64>,
    /// Opening whose mirrored targets the user accepted, by the session's count.
    targets_left: Option<u64>,
    /// Opening whose line on the origin of the map is closed.
    map_origin_closed: Option<u64>,
    /// Vertices to be selected once their mesh is on the screen, by their numbers in files.
    awaited: Vec<VertexId>,
}

impl Opened {
    /// Records that the session's mesh is on the screen. Returns true if it belongs to another opening than before.
    pub(super) fn put_on_screen(&mut self, session: &Session) -> bool {
        self.on_screen.replace(session.opening_revision()) != Some(session.opening_revision())
    }

    /// Records whether the mesh on the screen has several charts. Returns true if that is new.
    pub(super) fn note_charts(&mut self, session: &Session) -> bool {
        let has_charts = session.charts().is_some();
        !std::mem::replace(&mut self.has_charts, has_charts) && has_charts
    }

    /// Records the session's mesh and its preparation. Returns the revision of the mesh before if that was another.
    pub(super) fn note_model(&mut self, session: &Session) -> Option<u64> {
        let before = std::mem::replace(&mut self.model, session.model_revision());
        (before != self.model).then_some(before)
    }

    /// Sets the vertices to be selected once their mesh is on the screen, by their numbers in files.
    pub(super) fn await_vertices(&mut self, numbers: Vec<VertexId>) {
        self.awaited = numbers;
    }

    /// Returns the awaited vertices once, by their numbers in files.
    pub(super) fn take_awaited(&mut self) -> Vec<VertexId> {
        std::mem::take(&mut self.awaited)
    }

    pub(super) fn is_on_screen(&self, session: &Session) -> bool {
        self.on_screen == Some(session.opening_revision())
    }

    /// True if the view is due to be stored, and then counts it as stored. Call once per frame.
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

    pub(super) fn close_map_origin(&mut self, session: &Session) {
        self.map_origin_closed = Some(session.opening_revision());
    }

    /// Origin of the map on the screen, unless its line is closed.
    pub(in crate::ui) fn map_origin(&self, session: &Session) -> Option<MapOrigin> {
        session.map_origin().filter(|_| self.map_origin_closed != Some(session.opening_revision()))
    }

    /// True if the faces point inward and the user has not accepted that.
    pub(in crate::ui) fn faces_point_inward(&self, session: &Session) -> bool {
        self.faces_left != Some(session.model_revision())
            && session.model().is_some_and(|model| model.prepared.faces_point_inward)
    }

    /// True if the targets look mirrored and the user has not accepted that.
    pub(in crate::ui) fn targets_look_mirrored(&self, session: &Session) -> bool {
        self.targets_left != Some(session.opening_revision()) && session.targets_look_mirrored()
    }
}
