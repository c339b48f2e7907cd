//! View that a project file keeps: cameras, shadings, tool and selection.
//!
//! ```text
//! mesh_camera    pivot x, y, z; distance; yaw, pitch         world units, radians
//! plane_camera   center x, y; height of what the pane shows   embedding units
//! ```
//!
//! Malformed camera numbers and unknown names are ignored.

use super::Editor;
use crate::ui::state::{Pane, ShadingMode, Tool};
use freebound_core::mesh::VertexId;
use freebound_io::ProjectView;

impl Editor {
    fn view(&self) -> ProjectView {
        let shading = |pane| Some(self.pane_shading.usual.shading(pane).title().to_owned());
        ProjectView {
            mesh_shading: shading(Pane::Mesh),
            plane_shading: shading(Pane::Plane),
            mesh_camera: self.mesh.pane.camera().and_then(|camera| finite(camera.numbers().to_vec())),
            plane_camera: self.plane.camera_numbers().and_then(finite),
            selection: self.selection.vertices().iter().map(|vertex| vertex.number()).collect(),
            tool: Some(self.tools.tool().words()[0].to_owned()),
        }
    }

    /// Stores the view in the session, to be saved with the document. Does nothing while the document is not on the
    /// screen yet, because the session then has the better view.
    pub(in crate::ui) fn keep_view(&mut self) {
        if self.opened.is_on_screen(&self.session) {
            let view = self.view();
            self.session.set_view(view);
        }
    }

    /// Restores the view of the opened document. Call once its mesh is drawn.
    pub(super) fn put_on_view(&mut self) {
        let view = self.session.view().clone();
        for (pane, name) in Pane::BOTH.into_iter().zip([&view.mesh_shading, &view.plane_shading]) {
            if let Some(shading) = ShadingMode::called(name.as_deref()) {
                self.pane_shading.usual.shade(pane, shading);
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

/// Returns the numbers if all are finite. JSON has no other numbers, and a project with them could not be read again.
fn finite(numbers: Vec<f64>) -> Option<Vec<f64>> {
    numbers.iter().all(|number| number.is_finite()).then_some(numbers)
}
