//! The editor puts things before the person's eyes: the selection, elements, defects.

use super::framing::{grown, grown_box, positions_of};
use super::scene::vertices_of;
use crate::mesh::VertexId;
use crate::ui::Editor;

impl Editor {
    pub(in crate::ui) fn frame(&mut self) {
        let (Some(scene), Some(mut orbit)) = (self.mesh_scene(), self.orbit) else { return };
        let positions = &scene.mesh().positions;
        let selected: Vec<VertexId> = self.selection.vertices().iter().copied().collect();
        let ball =
            if selected.is_empty() { scene.sphere } else { grown(&positions_of(positions, &selected), scene.sphere) };
        orbit.frame(ball, self.mesh_pane_size);
        self.orbit = Some(orbit);
        let Some(plane) = self.drawn_plane().cloned() else { return };
        let bounds = self.with_picture(plane.arrays.bounds());
        let Some(camera) = &mut self.plane_camera else { return };
        let wanted = if selected.is_empty() { bounds } else { grown_box(plane.positions(), &selected, bounds) };
        camera.frame(wanted, self.plane_pane_size);
        if let Some(camera) = self.plane_camera.filter(|_| selected.is_empty() && plane.is_plain_result()) {
            self.set_framed(camera);
        }
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
