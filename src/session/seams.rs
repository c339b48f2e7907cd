//! Seams that the user draws, and their files.

use std::path::PathBuf;
use std::sync::Arc;

use super::background_jobs::BackgroundJob;
use super::{Message, MessagePlace, Session, Written};
use freebound_core::mesh::{Preparation, Seams, VertexId};
use freebound_io::{EdgesError, read_edges, write_durably, write_edges};

impl Session {
    /// Seams of the mesh, or of the requested preparation.
    pub fn seams(&self) -> &Seams {
        &self.form_to_be().seams
    }

    /// Replaces all seams, as one edit.
    pub(super) fn set_seams(&mut self, seams: Seams) {
        self.want_form(Preparation { seams, ..self.form_to_be().clone() });
    }

    /// Reads seams in the background, to be added to the existing ones.
    pub(super) fn import_seams(&mut self, path: PathBuf) {
        let Some(source) = self.model().map(|model| Arc::clone(&model.source)) else {
            return self.complain("seams need a mesh: open one first", None);
        };
        self.jobs.send("reading the seams", move |_| BackgroundJob::Seams(read_edges(&path, &source.polygons)));
    }

    /// Adds seams that were read.
    pub(super) fn take_seams(&mut self, read: Result<Vec<[VertexId; 2]>, EdgesError>) {
        match read {
            Ok(edges) if edges.is_empty() => self.complain("the file has no edges", None),
            Ok(edges) => self.set_seams(self.seams().with(edges)),
            Err(error) => {
                let vertices = error.vertices().into_iter().filter(|&number| self.has_number(number)).collect();
                let message = Message::error(MessagePlace::Mesh, error.to_string()).with_vertices(vertices);
                self.messages.say(message.with_remedy("nothing was imported: repair the file and import it again"));
            }
        }
    }

    /// Writes the seams, those by hand and automatic ones, to a file of edges.
    pub(super) fn export_seams(&mut self, path: PathBuf) {
        let seams = self.seams().all_listed();
        if seams.edges().is_empty() {
            return self.complain("there are no seams to write: draw one with the Seam tool first", None);
        }
        if self.refuses_to_replace(&path, None) {
            return;
        }
        self.files.write(move || {
            write_durably(&path, |out| write_edges(out, seams.edges().iter().copied()))?;
            let words = if seams.edges().len() == 1 { "edge" } else { "edges" };
            Ok(Written { about: Some(format!("{} {words}", seams.edges().len())), ..Written::file(path) })
        });
    }
}
