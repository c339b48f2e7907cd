//! Actions of the table of numbers that colours the faces.

use std::path::PathBuf;

use super::Editor;
use crate::session::MessagePlace;
use crate::ui::controls::sentence;
use crate::ui::state::{Pane, ShadingMode};
use freebound_io::ElementCounts;

impl Editor {
    /// Reads a table in the background.
    pub(super) fn open_table(&mut self, path: PathBuf) {
        let Some(polygons) = self.session.model().map(|model| &model.source.polygons) else { return };
        let counts = ElementCounts { vertices: polygons.positions.len(), faces: polygons.face_count() };
        self.files.table.read(path, self.session.opening_revision(), counts, &self.gpu.wake());
    }

    /// Shows a table that was read, or reports its fault. Call once per frame.
    pub(super) fn poll_table(&mut self) {
        if let Some(failure) = self.files.table.take_failure() {
            self.session.tell_failure(MessagePlace::Mesh, "reading the table", &failure);
        }
        let Some(((path, opening), read)) = self.files.table.poll() else { return };
        if opening != self.session.opening_revision() {
            return;
        }
        match read {
            Ok(table) => {
                self.files.table.open(table);
                self.show_column(0);
            }
            Err(fault) => {
                let text = format!("{}: {fault}", path.file_name().unwrap_or_default().to_string_lossy());
                self.session.tell_fault(MessagePlace::Mesh, text, &sentence(fault.remedy()));
            }
        }
    }

    /// Colours the faces of both panes by a column of the table.
    pub(super) fn show_column(&mut self, place: usize) {
        if self.files.table.choose(place) {
            for pane in Pane::BOTH {
                self.appearance_mut().shade(pane, ShadingMode::Column);
            }
        }
    }

    /// Forgets the table, which belongs to another document.
    pub(super) fn forget_table(&mut self) {
        self.files.table.forget();
        for appearance in [&mut self.pane_shading.usual, &mut self.pane_shading.over_picture] {
            for pane in Pane::BOTH {
                if appearance.shading(pane) == ShadingMode::Column {
                    appearance.shade(pane, ShadingMode::Checker);
                }
            }
        }
    }

    /// Name of a shading: the title of its column, if there is one.
    pub(in crate::ui) fn title_of_shading(&self, shading: ShadingMode) -> String {
        let column = self.files.table.shown().filter(|_| shading == ShadingMode::Column);
        column.map_or_else(
            || shading.title().to_owned(),
            |shown| format!("{} ({})", shown.column.title, shown.element.name()),
        )
    }
}
