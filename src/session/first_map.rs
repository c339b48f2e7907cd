//! First map of a mesh that was opened: the layout of its file, a map along automatic seams, or the mesh as it is.
//!
//! A layout that is proved planar is shown as it is. Other meshes are cut along automatic seams. A single disk, the
//! input of the paper, is not cut.

use super::{Command, Document, LayoutCheckState, Session};
use freebound_core::mesh::Preparation;
use freebound_core::problem::{Method, Settings, Stage, Start};

/// Name of the check of a layout on the screen.
pub(super) const CHECKING: &str = "checking the layout of the file";

/// Origin of the map on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapOrigin {
    /// Texture coordinates of the file, unchanged.
    FileLayout,
    /// Texture coordinates of the file, which a run has changed.
    FromLayout,
    /// Automatic seams, with the number of their edges.
    AutomaticSeams(usize),
    /// Seams that the user has chosen.
    ChosenSeams,
    /// Mesh without seams.
    Plain,
}

/// Work that the first map of an opened mesh waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FirstMapWork {
    /// Check of the layout of the file.
    Check,
    /// Search for automatic seams.
    Seams,
}

impl Session {
    /// Starts the first map of an opened mesh. Returns true if the map follows a check, a search or an edit.
    pub(super) fn begin_first_map(&mut self) -> bool {
        if self.model().is_some_and(|model| model.source.texture.is_some()) {
            self.check_layout();
            self.layout_check.decide(self.document.clone());
            return true;
        }
        self.unwrap_opened()
    }

    /// Shows the layout of the file if the check has proved it planar, and another map if it has not. An edit of the
    /// user ends the wait.
    pub(super) fn choose_first_map(&mut self) {
        let Some(waiting) = self.layout_check.decides_for() else { return };
        if self.mesh.wanted().is_some() || self.unwrapping.is_cutting() || !has_same_map(waiting, &self.document) {
            // The user has asked for another map meanwhile.
            self.layout_check.end_wait();
            if self.outcome().is_none() && !self.is_running() && !self.unwrapping.is_busy() {
                self.map_without_layout();
            }
            return;
        }
        let is_good = match self.layout_check() {
            Some(LayoutCheckState::Running) => return,
            Some(LayoutCheckState::Done(found)) => found.planar && found.passes,
            _ => false,
        };
        self.layout_check.end_wait();
        let is_torn = self.model().and_then(|model| model.source.has_texture_seams().ok());
        if let Some(is_torn) = is_torn.filter(|_| is_good) {
            self.keeping_saved(|session| session.take_layout_of_opened(is_torn));
        } else {
            self.map_without_layout();
        }
    }

    /// Cuts an opened mesh along automatic seams, or solves it as it is.
    fn map_without_layout(&mut self) {
        if !self.unwrap_opened() {
            self.go_on_without_seams();
        }
    }

    /// Work that the first map of an opened mesh waits for.
    pub fn first_map_work(&self) -> Option<FirstMapWork> {
        if self.layout_check.decides_for().is_some() {
            return Some(FirstMapWork::Check);
        }
        self.unwrapping.is_for_opening().then_some(FirstMapWork::Seams)
    }

    /// Ends the wait for the check of the file's layout, and solves the mesh as it is.
    pub(super) fn stop_first_map(&mut self) {
        if self.layout_check.end_wait() {
            self.go_on_without_seams();
        }
    }

    /// Carries out an edit that is no unsaved work, because it follows the opening of a file.
    pub(super) fn keeping_saved(&mut self, edit: impl FnOnce(&mut Self)) {
        // A project that was saved meanwhile has no such edit.
        let has_project = self.files.project().is_some() || self.files.is_saving_project();
        let was_saved = !self.has_unsaved_work() && !has_project;
        edit(self);
        if was_saved {
            self.files.note_unchanged(&self.document);
        }
    }

    /// Cuts the opened mesh along the seams of the file's layout and starts from it. Faults are repaired.
    fn take_layout_of_opened(&mut self, is_torn: bool) {
        let is_faulty = self.model().is_some_and(|model| model.is_faulty());
        let form = if is_faulty { self.document.form.with_all_repairs() } else { self.document.form.clone() };
        let commands = self.commands_to_take_layout(form, is_torn);
        self.edit(commands);
    }

    /// Edits that cut the mesh along the seams of the file's layout and start from it.
    pub(super) fn commands_to_take_layout(&self, form: Preparation, is_torn: bool) -> Vec<Command> {
        let mut seams = form.seams.clone();
        seams.of_texture |= is_torn;
        vec![Command::SetForm(Preparation { seams, ..form }), Command::SetSettings(self.settings_from_layout())]
    }

    /// Settings of the document, with the layout of the file as their start.
    pub(super) fn settings_from_layout(&self) -> Settings {
        let before = self.document.settings.clone();
        let method = if before.method.continues_from_layout() { before.method } else { Method::Auto };
        let family = before.family.filter(|family| family.power().is_some());
        Settings { method, family, start: Start::File, ..before }
    }

    /// Origin of the map on the screen. `None` if there is no map, for an example, and with pins.
    pub fn map_origin(&self) -> Option<MapOrigin> {
        let (model, outcome) = (self.model()?, self.outcome()?);
        if model.built_in.is_some() || !self.document.targets.is_empty() {
            return None;
        }
        let seams = self.seams();
        Some(match (self.document.settings.start, self.automatic_seams()) {
            (Start::File, _) if outcome.step.candidate.stage == Stage::Given => MapOrigin::FileLayout,
            (Start::File, _) => MapOrigin::FromLayout,
            (_, Some(seams)) => MapOrigin::AutomaticSeams(seams.edges().len()),
            (_, None) if seams.of_texture || !seams.edges().is_empty() => MapOrigin::ChosenSeams,
            (_, None) => MapOrigin::Plain,
        })
    }
}

/// True if two documents ask for the same map.
fn has_same_map(a: &Document, b: &Document) -> bool {
    let has_same_edits = a.targets == b.targets && a.elsewhere == b.elsewhere && a.relaxed == b.relaxed;
    has_same_edits && a.settings == b.settings && a.form == b.form && a.chart == b.chart
}
