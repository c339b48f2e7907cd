//! The editor puts things before the person's eyes: the selection, elements, defects.

use super::framing::{grown, grown_box, positions_of};
use super::scene::vertices_of;
use crate::mesh::VertexId;
use crate::render::PictureLayer;
use crate::session::Document;
use crate::ui::Editor;
use crate::view::PlaneBox;

/// Where a document's picture lies in the plane.
pub(super) fn picture_box(document: &Document) -> PlaneBox {
    let [min, max] = document.frame().corners();
    PlaneBox { min, max }
}

impl Editor {
    pub(in crate::ui) fn frame(&mut self) {
        let Some(scene) = self.mesh_scene() else { return };
        let selected: Vec<VertexId> = self.selection.vertices().iter().copied().collect();
        let whole = scene.sphere;
        let ball =
            if selected.is_empty() { whole } else { grown(&positions_of(&scene.mesh().positions, &selected), whole) };
        self.mesh.frame(ball);
        let Some(plane) = self.plane.drawn().cloned() else { return };
        let bounds = self.with_picture(plane.arrays.bounds());
        let wanted = if selected.is_empty() { bounds } else { grown_box(plane.positions(), &selected, bounds) };
        self.plane.frame(wanted);
        if let Some(camera) = self.plane.camera().filter(|_| selected.is_empty() && plane.is_plain_result()) {
            self.plane.set_framed(camera);
        }
    }

    /// Whether the document has a picture.
    pub fn has_picture(&self) -> bool {
        self.session.document().picture.is_some()
    }

    /// Where the picture lies in the plane; without one, the unit square of texture coordinates.
    pub(in crate::ui) fn picture_box(&self) -> PlaneBox {
        picture_box(self.session.document())
    }

    /// All that there is in the plane: the embedding, and the picture where there is one.
    pub(in crate::ui) fn with_picture(&self, embedding: PlaneBox) -> PlaneBox {
        if self.has_picture() { embedding.union(self.picture_box()) } else { embedding }
    }

    /// The picture as panes draw it.
    pub(in crate::ui) fn picture_layer(&self) -> Option<PictureLayer> {
        self.look.picture_layer(self.picture_box())
    }

    pub(super) fn go_to_vertices(&mut self, vertices: Vec<VertexId>) {
        if !vertices.is_empty() {
            self.selection.select(vertices);
            self.frame();
        }
    }

    pub(super) fn step_defect(&mut self, by: isize) {
        let defects = self.defects();
        if defects.is_empty() {
            return;
        }
        let count = defects.len().cast_signed();
        let next = match self.selection.defect() {
            Some(at) => (at.cast_signed() + by).rem_euclid(count),
            None if by < 0 => count - 1,
            None => 0,
        };
        self.selection.set_defect(Some(next.cast_unsigned()));
        self.go_to_defect(next.cast_unsigned());
    }

    pub(super) fn go_to_defect(&mut self, place: usize) {
        self.selection.set_defect(Some(place));
        let (Some(scene), Some(defect)) = (self.mesh_scene().cloned(), self.defects().get(place).copied()) else {
            return;
        };
        let vertices = defect.elements().into_iter().flatten().flat_map(|element| vertices_of(&scene, element));
        self.go_to_vertices(vertices.collect());
    }
}
