//! Shadings of the panes: changes, and colouring of the faces.

use super::Editor;
use super::appearance::{Appearance, PaintSources};
use super::paint::Legend;
use crate::ui::state::{Pane, ShadingMode, Tool};

impl Editor {
    /// Current appearance of faces. The constrain tool over a picture has its own, separate appearance.
    pub fn appearance(&self) -> &Appearance {
        if self.is_placing_on_picture() { &self.pane_shading.over_picture } else { &self.pane_shading.usual }
    }

    /// Current appearance of faces, mutable.
    pub fn appearance_mut(&mut self) -> &mut Appearance {
        if self.is_placing_on_picture() { &mut self.pane_shading.over_picture } else { &mut self.pane_shading.usual }
    }

    fn is_placing_on_picture(&self) -> bool {
        self.tools.tool() == Tool::Constrain && self.has_picture()
    }

    /// Shading of a pane.
    pub fn shading(&self, pane: Pane) -> ShadingMode {
        self.appearance().shading(pane)
    }

    /// Legend of the shading of a pane.
    pub(in crate::ui) fn legend(&self, pane: Pane) -> Option<&Legend> {
        if self.shows_page() { self.plane.page.legend(pane) } else { self.pane_shading.legend(pane) }
    }

    /// Shades the pane under the pointer, or both panes if it is over neither.
    pub(super) fn shade(&mut self, shading: ShadingMode) {
        if self.pointer.pane() != Some(Pane::Mesh) && self.shade_comparison(shading) {
            return;
        }
        match self.pointer.pane() {
            Some(pane) => self.shade_pane(pane, shading),
            None => Pane::BOTH.into_iter().for_each(|pane| self.shade_pane(pane, shading)),
        }
    }

    /// Sets the shading of a pane that the user chose.
    pub(super) fn shade_pane(&mut self, pane: Pane, shading: ShadingMode) {
        let appearance = self.appearance_mut();
        appearance.shade(pane, shading);
        if shading.is_for(pane) {
            appearance.own[pane as usize] = Some(shading);
        }
    }

    /// Recolours the faces if needed. Call once per frame.
    pub(super) fn refresh_paints(&mut self) {
        if self.shows_page() {
            for (pane, shading) in Pane::BOTH.map(|pane| (pane, self.shading(pane))) {
                self.plane.page.refresh_paint(pane, shading, self.files.table.shown());
            }
            return;
        }
        let Some(given) = self.mesh.scene() else { return };
        let base = self.plane.moved_from(&self.session).map(AsRef::as_ref);
        let column = self.files.table.shown();
        let sources = PaintSources { given, plane: self.plane.scene().map(AsRef::as_ref), base, column };
        for (pane, shading) in Pane::BOTH.map(|pane| (pane, self.shading(pane))) {
            self.pane_shading.refresh_paint(pane, shading, sources);
        }
    }
}
