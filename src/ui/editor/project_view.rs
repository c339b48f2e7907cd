//! How the person looks at the document, kept in its project and put on again when it is opened.
//!
//! ```text
//! mesh_camera    pivot x, y, z; distance; yaw, pitch         world units, radians
//! plane_camera   center x, y; height of what the pane shows   embedding units
//! ```
//!
//! Numbers that are none of these are ignored, as names are that mean nothing here.

use crate::io::ProjectView;
use crate::mesh::VertexId;
use crate::ui::{Editor, Shading, Tool};

impl Editor {
    fn view(&self) -> ProjectView {
        let shading = Some(self.look.shading.title().to_owned());
        ProjectView {
            mesh_shading: shading.clone(),
            plane_shading: shading,
            mesh_camera: self.mesh.pane.camera().and_then(|camera| finite(&camera.numbers())),
            plane_camera: self.plane_camera_numbers(),
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

    /// Keeps the view that copies for recovery are made with fresh. Call once per frame.
    pub(super) fn refresh_view(&mut self) {
        if self.opened.view_is_due(&self.session) {
            self.keep_view();
        }
    }

    /// Puts on how the person looked at what was opened. Call once its mesh is drawn.
    pub(super) fn put_on_view(&mut self) {
        let view = self.session.view().clone();
        let shading = view.mesh_shading.and_then(|name| Shading::ALL.into_iter().find(|s| s.title() == name));
        if let Some(shading) = shading {
            self.look.shading = shading;
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
        let count = self.session.model().map_or(0, |model| model.mesh().vertex_count());
        let there = view.selection.into_iter().map(VertexId::new).filter(|vertex| vertex.index() < count);
        self.selection.select(there);
    }

    /// The plane's camera; none where the window chose it by itself, as it will again.
    fn plane_camera_numbers(&self) -> Option<Vec<f64>> {
        if let Some(saved) = self.plane.saved_camera() {
            return Some(saved.clone());
        }
        let camera = self.plane.pane.camera().filter(|_| !self.plane.is_framed())?;
        finite(&camera.numbers(self.plane.pane.size()))
    }
}

/// JSON has no words for numbers that are not finite, and a project with one could not be read again.
fn finite(numbers: &[f64]) -> Option<Vec<f64>> {
    numbers.iter().all(|number| number.is_finite()).then(|| numbers.to_vec())
}
