//! Constraints of a project, carried to the open mesh.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::background_jobs::BackgroundJob;
use super::carried_pins::{CarriedPins, CarryError};
use super::{Message, MessagePlace, Model, Session};
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Targets;
use freebound_core::problem::Control;
use freebound_io::CarryReport;

/// Description of the background job.
const CARRYING: &str = "carrying the constraints";

impl Session {
    /// Carries the constraints of a project to the open mesh in the background.
    pub(super) fn carry_constraints(&mut self, path: PathBuf) {
        let Some(model) = self.model().cloned() else {
            return self.complain("constraints need a mesh: open one first", None);
        };
        let memory = self.files.memory();
        self.jobs.send(CARRYING, move |cancel| {
            let read = CarriedPins::read(&path, &model, memory, Control::new(cancel, &|_| {}));
            BackgroundJob::Carried { path, mesh: model, read }
        });
    }

    /// Makes carried constraints an edit, and lists their vertices.
    pub(super) fn take_carried(&mut self, path: &Path, mesh: &Arc<Model>, read: Result<CarriedPins, CarryError>) {
        let CarriedPins { mut carried, is_moved, v_axis } = match read {
            Ok(carried) => carried,
            Err(CarryError::Cancelled(_)) => return,
            Err(error) => {
                let message = Message::error(MessagePlace::Embedding, error.to_string()).of_file(Some(path));
                self.messages.say(message.with_remedy(error.remedy()));
                return;
            }
        };
        let now = self
            .model()
            .filter(|now| Arc::ptr_eq(&now.source, &mesh.source) && now.whole_repaired() == mesh.whole_repaired());
        let Some(now) = now.cloned() else {
            let text = "the constraints were not imported: the mesh has changed meanwhile";
            return self.complain(text, Some("import them again"));
        };
        // Pins cannot be on vertices that were joined with others, or left out.
        let can_be_pinned = |vertex: &VertexId| {
            let one =
                Targets::from_iter(carried.constraints.targets.get_key_value(vertex).map(|(&v, &target)| (v, target)));
            now.check_targets(&one).is_ok()
        };
        let refused: Vec<VertexId> =
            carried.constraints.targets.keys().copied().filter(|vertex| !can_be_pinned(vertex)).collect();
        for vertex in &refused {
            carried.constraints.targets.remove(vertex);
            carried.constraints.notes.remove(vertex);
        }
        if v_axis != self.document.v_axis {
            carried.constraints.targets.values_mut().for_each(|target| target.uv.y = 1.0 - target.uv.y);
        }
        let lost = carried.report.lost().len() + refused.len();
        if carried.constraints.targets.is_empty() && lost > 0 {
            let text = "no pin of the project has a vertex on this mesh";
            return self.complain(text, Some("choose the project of a mesh of the same surface"));
        }
        let vertices: Vec<VertexId> = carried.constraints.targets.keys().copied().collect();
        let count = carried.constraints.targets.len();
        if self.take_constraints(carried.constraints) {
            let words = carried_words(&carried.report, count, lost, is_moved);
            let message = Message::note(MessagePlace::Embedding, words).with_vertices(vertices).of_file(Some(path));
            self.messages.say(message.with_remedy(advice(&carried.report)));
        }
    }
}

/// Text about carried constraints.
fn carried_words(report: &CarryReport, count: usize, lost: usize, is_moved: bool) -> String {
    let noun = if count == 1 { "pin" } else { "pins" };
    let percent = report.largest_percent();
    let away =
        if report.same_faces { String::new() } else { format!(", moved by at most {percent:.2} % of the diagonal") };
    let fitted = if is_moved { ", mesh fitted" } else { "" };
    let lost = if lost == 0 { String::new() } else { format!("; {lost} have no free vertex near") };
    format!("{count} {noun} carried{away}{fitted}{lost}")
}

/// Action that the message about carried constraints suggests.
fn advice(report: &CarryReport) -> &'static str {
    if report.is_apart() {
        "the meshes lie apart: check the vertices of the pins"
    } else {
        "check the vertices of the pins"
    }
}
