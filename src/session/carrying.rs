//! Constraints of a project, carried to the open mesh.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::background_jobs::BackgroundJob;
use super::carried_pins::{CarriedPins, CarryError};
use super::{Message, MessagePlace, Model, Session};
use freebound_core::mesh::VertexId;
use freebound_core::problem::Control;

/// Description of the background job.
const CARRYING: &str = "carrying the constraints";

impl Session {
    /// Carries the constraints of a project to the open mesh in the background.
    pub(super) fn carry_constraints(&mut self, path: PathBuf) {
        let Some(model) = self.model().cloned() else { return };
        let v_axis = self.document.v_axis;
        self.jobs.send(CARRYING, move |cancel| {
            let read = CarriedPins::read(&path, &model, v_axis, Control::new(cancel, &|_| {}));
            BackgroundJob::Carried { path, mesh: model, read }
        });
    }

    /// Makes carried constraints an edit, and lists their vertices.
    pub(super) fn take_carried(&mut self, path: &Path, mesh: &Arc<Model>, read: Result<CarriedPins, CarryError>) {
        let CarriedPins { carried, is_moved } = match read {
            Ok(carried) => carried,
            Err(CarryError::Cancelled(_)) => return,
            Err(error) => {
                let message = Message::error(MessagePlace::Embedding, error.to_string()).of_file(Some(path));
                self.messages.say(message.with_remedy("nothing was imported: choose another project"));
                return;
            }
        };
        if self.model().is_none_or(|model| !Arc::ptr_eq(&model.source, &mesh.source)) {
            let text = "the constraints were not imported: the mesh has changed meanwhile";
            return self.complain(text, Some("import them again"));
        }
        let report = carried.report;
        let of_chart = |&vertex| mesh.vertex_of_file(vertex);
        let vertices: Vec<VertexId> = carried.constraints.targets.keys().filter_map(of_chart).collect();
        self.take_constraints(carried.constraints);
        if report.count + report.lost.len() == 0 {
            return;
        }
        let noun = if report.count == 1 { "constraint" } else { "constraints" };
        let percent = 100.0 * report.largest_distance / report.diagonal;
        let away = if report.same_faces { String::new() } else { format!(", at most {percent:.2} % of the size away") };
        let moved = if is_moved { "; the mesh of the project was moved and scaled to this one" } else { "" };
        let lost = match report.lost.len() {
            0 => String::new(),
            count => format!("; {count} lost, because others took the vertices near them"),
        };
        let words = format!("{} {noun} carried{away}{moved}{lost}", report.count);
        let message = Message::note(MessagePlace::Embedding, words).with_vertices(vertices).of_file(Some(path));
        self.messages.say(message.with_remedy("check the vertices of the constraints"));
    }
}
