//! Copy of the layout of another mesh, as one edit: its seams, and its charts in their shapes at their places.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::background_jobs::BackgroundJob;
use super::chart_layout::ChartPlace;
use super::layout_of_other::{CopiedChart, LayoutOfOther, LayoutOfOtherError};
use super::{ChartEdits, Command, Message, MessagePlace, Session, Shape};
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::{ShapedMap, Target};
use freebound_core::problem::{Control, PinKind, Settings, Start};
use freebound_io::{TransferError, TransferReport};

/// Name of the job that copies the layout of another mesh.
const COPYING: &str = "copying the layout";

impl Session {
    /// Copies the layout of another mesh file in the background.
    pub(super) fn copy_layout_of(&mut self, path: PathBuf) {
        let Some(model) = self.model().cloned() else {
            return self.complain("a layout needs a mesh to be copied to: open one first", None);
        };
        if !self.has_form_as_wanted() {
            let text = "the layout was not copied: the mesh is not prepared yet";
            return self.complain(text, Some("try again in a moment"));
        }
        let document = self.document.clone();
        self.jobs.send(COPYING, move |cancel| {
            let read = LayoutOfOther::read(&path, model, &document, Control::new(cancel, &|_| {}));
            BackgroundJob::LayoutOfOther { path, read: read.map(Box::new) }
        });
    }

    /// Makes a copied layout an edit. Pins are dropped, because the layout holds all vertices.
    pub(super) fn take_layout_of_other(&mut self, path: &Path, read: Result<Box<LayoutOfOther>, LayoutOfOtherError>) {
        let copied = match read {
            Ok(copied) => *copied,
            Err(LayoutOfOtherError::Transfer(TransferError::Cancelled)) => return,
            Err(error) => {
                let message = Message::error(MessagePlace::Mesh, error.to_string()).of_file(Some(path));
                let remedy = match error {
                    LayoutOfOtherError::Read(_) => "choose another mesh file",
                    LayoutOfOtherError::Transfer(TransferError::NoFaces) => "open a mesh with faces",
                    LayoutOfOtherError::Transfer(_) => "choose a mesh with texture coordinates",
                };
                self.messages.say(message.with_remedy(remedy));
                return;
            }
        };
        let is_of_screen = self.model().is_some_and(|model| Arc::ptr_eq(model, copied.reshaped.before()));
        if !is_of_screen || !self.has_form_as_wanted() || self.mesh.wanted().is_some() {
            let text = "the layout was not copied: the mesh has changed meanwhile";
            return self.complain(text, Some("copy the layout again"));
        }
        if copied.charts.is_empty() && copied.report.is_apart() {
            let message = Message::error(MessagePlace::Mesh, "the layout belongs to another surface");
            let message = message.of_file(Some(path));
            self.messages.say(message.with_remedy("choose the layout of a mesh of the same surface"));
            return;
        }
        let done = copied_words(&copied);
        let edits = self.edits_to_take(&copied);
        self.mesh.take_other(Arc::new(copied.reshaped.into_model()));
        self.edit(edits);
        self.messages.say(done);
    }

    /// Edits that cut the mesh along the seams of a layout, and lay its charts as the layout does.
    fn edits_to_take(&self, copied: &LayoutOfOther) -> Vec<Command> {
        let shape = copied.reshaped.shape(&self.document);
        let mut shape = Shape { shown: ChartEdits::default(), elsewhere: BTreeMap::new(), ..shape };
        let here = copied.reshaped.now().prepared.chart.as_ref().map_or(0, |of| of.number);
        let mut layout = self.document.layout.without_places();
        // They name charts by faces, which begin other charts now.
        layout.stacked.clear();
        layout.sizes.clear();
        for chart in &copied.charts {
            let edits = self.edits_of_copied(chart);
            if chart.number == here {
                shape.shown = edits;
            } else {
                shape.elsewhere.insert(chart.number, edits);
            }
            if let Some(first_face) = chart.first_face {
                layout.placed.insert(first_face, ChartPlace(Arc::clone(&chart.coordinates)));
            }
        }
        let settings = Settings { start: Start::FromScratch, ..self.settings_from_layout() };
        let shape = Command::Reshape(Box::new(shape));
        vec![shape, Command::SetLayout(Box::new(layout)), Command::SetSettings(settings)]
    }

    /// Edits of a chart that has its shape in the layout. A single chart has no place on a page, so two pins hold it.
    fn edits_of_copied(&self, chart: &CopiedChart) -> ChartEdits {
        let in_plane = self.document.problem_with(ChartEdits::default()).in_plane(&chart.coordinates);
        let frame = self.document.frame();
        let held = chart.held.iter().flatten();
        let target =
            |&vertex: &VertexId| (vertex, Target { uv: frame.uv_from_plane(in_plane[vertex]), kind: PinKind::Hard });
        let targets = held.map(target).collect();
        ChartEdits { targets, shaped: Some(ShapedMap(Arc::new(in_plane))), ..ChartEdits::default() }
    }
}

/// Note on a copied layout: how its places were found, and the charts that differ from it.
fn copied_words(copied: &LayoutOfOther) -> Message {
    let by = match copied.report {
        TransferReport::Corners => "the layout was copied corner by corner".to_owned(),
        TransferReport::NearestPoints { mean_distance, diagonal, .. } => {
            let moved = if copied.is_moved { "moved and scaled to this mesh, " } else { "" };
            format!("the layout was copied by nearest points, {moved}{:.2} % apart", 100.0 * mean_distance / diagonal)
        }
    };
    let note = Message::note(MessagePlace::Embedding, by);
    if copied.report.is_apart() {
        return note.with_remedy("move and scale both meshes to one place and size");
    }
    let turned = copied.charts.iter().filter(|chart| chart.is_turned).count();
    let turned = match turned {
        0 => None,
        1 => Some("1 chart is mirrored there, and was turned over".to_owned()),
        _ => Some(format!("{turned} charts are mirrored there, and were turned over")),
    };
    let folded = match copied.missing() {
        0 => None,
        1 => Some("1 chart would fold, and was flattened anew".to_owned()),
        missing => Some(format!("{missing} charts would fold, and were flattened anew")),
    };
    let words: Vec<String> = turned.into_iter().chain(folded).collect();
    if words.is_empty() { note } else { note.with_remedy(words.join("; ")) }
}
