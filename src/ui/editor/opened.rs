//! What the window keeps of the open document beside the session: whether it is on the screen yet, questions that were
//! waved away, and how the person looks at it, which is kept in its project and put on again when it is opened.
//!
//! ```text
//! mesh_camera    pivot x, y, z; distance; yaw, pitch         world units, radians
//! plane_camera   center x, y; height of what the pane shows   embedding units
//! ```
//!
//! Numbers that are none of these are ignored, as names are that mean nothing here.

use std::time::{Duration, Instant};

use crate::io::ProjectView;
use crate::mesh::VertexId;
use crate::session::Session;
use crate::ui::{Editor, Pane, Shading, Tool};

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
            && session.model().is_some_and(|model| model.faces_point_inward)
    }

    /// Whether the targets look mirrored, and nobody said that they may.
    pub(in crate::ui) fn targets_look_mirrored(&self, session: &Session) -> bool {
        self.targets_left != Some(session.opening_revision()) && session.targets_look_mirrored()
    }
}

impl Editor {
    fn view(&self) -> ProjectView {
        let shading = |pane| Some(self.look.usual.shading(pane).title().to_owned());
        ProjectView {
            mesh_shading: shading(Pane::Mesh),
            plane_shading: shading(Pane::Plane),
            mesh_camera: self.mesh.pane.camera().and_then(|camera| finite(camera.numbers().to_vec())),
            plane_camera: self.plane.camera_numbers().and_then(finite),
            selection: self.selection.vertices().iter().map(|vertex| vertex.number()).collect(),
            tool: Some(self.tools.tool().words()[0].to_owned()),
        }
    }

    /// Tells the session how the person looks at it, to be saved with it. While what was opened is not on the screen
    /// yet, the session knows better.
    pub(in crate::ui) fn keep_view(&mut self) {
        if self.opened.is_on_screen(&self.session) {
            let view = self.view();
            self.session.set_view(view);
        }
    }

    /// Puts on how the person looked at what was opened. Call once its mesh is drawn.
    pub(super) fn put_on_view(&mut self) {
        let view = self.session.view().clone();
        for (pane, name) in Pane::BOTH.into_iter().zip([&view.mesh_shading, &view.plane_shading]) {
            if let Some(shading) = Shading::called(name.as_deref()) {
                self.look.usual.shade(pane, shading);
            }
        }
        if let Some(tool) = Tool::ALL.into_iter().find(|tool| view.tool.as_deref() == Some(tool.words()[0])) {
            self.tools.take_up(tool);
        }
        let orbit =
            view.mesh_camera.zip(self.mesh.pane.camera()).and_then(|(numbers, start)| start.with_numbers(&numbers));
        if let Some(orbit) = orbit {
            self.mesh.pane.set_camera(orbit);
        }
        self.plane.set_saved_camera(view.plane_camera);
        let count = self.session.model().map_or(0, |model| model.vertex_count());
        let there = view.selection.into_iter().map(VertexId::new).filter(|vertex| vertex.index() < count);
        self.selection.select(there);
    }
}

/// JSON has no words for numbers that are not finite, and a project with one could not be read again.
fn finite(numbers: Vec<f64>) -> Option<Vec<f64>> {
    numbers.iter().all(|number| number.is_finite()).then_some(numbers)
}
