//! Framing of the selection, of elements and of defects.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::Editor;
use super::defect::Defect;
use super::file_elements::FileElements;
use super::in_file::vertices_in_file;
use super::page::LEAST_SHARE;
use super::picture_box::picture_box;
use crate::session::{Action, Model};
use crate::view::{Sphere, part_around};
use freebound_core::geom::Bounds;
use freebound_core::mesh::{FaceId, VertexId};
use freebound_core::pipeline::Outcome;

impl Editor {
    pub(super) fn frame(&mut self) {
        self.plane.comparison.frame();
        if self.shows_page() {
            return self.frame_page();
        }
        let Some(scene) = self.mesh_scene() else { return };
        let selected: Vec<VertexId> = self.selection.vertices().iter().copied().collect();
        let positions = &scene.mesh().positions;
        let points: Vec<DVec3> = selected.iter().filter_map(|v| positions.get(v.index()).copied()).collect();
        let ball = if selected.is_empty() { scene.sphere } else { scene.sphere.part_around(&points) };
        self.mesh.frame(ball);
        let Some(plane) = self.plane.drawn().cloned() else { return };
        let bounds = self.with_picture(plane.arrays.bounds);
        let points: Vec<DVec2> = selected.iter().filter_map(|&v| plane.position_of(v)).collect();
        self.plane.frame(if selected.is_empty() { bounds } else { part_around(&points, bounds) });
        if let Some(camera) = self.plane.pane.camera().filter(|_| selected.is_empty() && plane.is_plain_result()) {
            self.plane.set_framed(camera);
        }
    }

    /// Frames the selected charts or elements of the page in both panes, or everything.
    fn frame_page(&mut self) {
        self.plane.page.frame_selection();
        let (Some(page), Some(scene)) = (self.plane.page.scene(), self.mesh.scene()) else { return };
        let points = page.points_of(self.plane.page.selected().iter().copied());
        let of_elements = page.positions_of(self.plane.page.elements().vertices());
        let ball = if points.is_empty() && of_elements.is_empty() {
            scene.sphere
        } else if points.is_empty() {
            let Sphere { center, radius } = Sphere::around(&of_elements);
            Sphere { center, radius: radius.clamp(LEAST_SHARE * scene.sphere.radius, scene.sphere.radius) }
        } else {
            Sphere::around(&points)
        };
        self.mesh.frame(ball);
    }

    /// True if the document has a picture.
    pub fn has_picture(&self) -> bool {
        self.session.document().picture.is_some()
    }

    /// Bounds of the embedding, and of the picture if there is one.
    pub(in crate::ui) fn with_picture(&self, embedding: Bounds) -> Bounds {
        if self.has_picture() { embedding.union(picture_box(self.session.document())) } else { embedding }
    }

    pub(super) fn go_to_vertices(&mut self, vertices: Vec<VertexId>) {
        if !vertices.is_empty() {
            self.leave_page();
            self.selection.select(vertices);
            self.frame();
        }
    }

    pub(super) fn go_to_file_faces(&mut self, faces: &[FaceId]) {
        let (Some(model), Some(&first)) = (self.session.model(), faces.first()) else { return };
        let corners = faces.iter().flat_map(|&face| corners_in_file(model, face)).copied();
        let numbers: Vec<VertexId> = corners.filter(|&number| self.session.has_number(number)).collect();
        if numbers.is_empty() {
            self.session.tell_left_out(first);
        }
        self.go_to_file_vertices(numbers);
    }

    /// Shows vertices by their numbers in files, with the chart of the first one. Selects those on that chart.
    pub(super) fn go_to_file_vertices(&mut self, numbers: Vec<VertexId>) {
        let Some(model) = self.session.model().map(Arc::clone) else { return };
        let charts = model.prepared.chart.as_ref().map(|of| &of.charts);
        let chart = numbers.iter().find_map(|&number| charts?.chart_of_vertex(number));
        let elsewhere = chart.filter(|&chart| self.session.chart_on_screen() != Some(chart));
        let is_behind = self.mesh_scene().is_none_or(|scene| !self.is_of_session(scene));
        if elsewhere.is_none() && !is_behind {
            return self.go_to_vertices(numbers.iter().filter_map(|&number| model.vertex_of_file(number)).collect());
        }
        self.leave_page();
        self.selection.await_mesh(FileElements::of_vertices(vertices_of_source(&model, &numbers)));
        self.opened.await_vertices(numbers);
        if let Some(chart) = elsewhere {
            self.act(Action::ShowChart(chart));
        }
    }

    pub(super) fn step_defect(&mut self, by: isize) {
        let count = self.defect_count().cast_signed();
        let next = match self.selection.defect() {
            _ if count == 0 => return,
            Some(at) => (at.cast_signed() + by).rem_euclid(count),
            None if by < 0 => count - 1,
            None => 0,
        };
        self.go_to_defect(next.cast_unsigned());
    }

    pub(super) fn go_to_defect(&mut self, place: usize) {
        self.selection.set_defect(Some(place));
        if let (Some(scene), Some(defect)) = (self.mesh_scene(), self.defects().get(place)) {
            let vertices = defect.elements(scene).into_iter().flat_map(|element| scene.vertices_of(element)).collect();
            self.go_to_vertices(vertices);
        }
    }

    /// Outcome on the screen. During a transition, or while the pane is behind the session, the outcome before.
    pub fn step_on_screen(&self) -> Option<&Arc<Outcome>> {
        self.plane.scene().map(|scene| &scene.outcome)
    }

    /// True if the drawn embedding is a drag preview, or glides from one to its step.
    pub fn shows_preview(&self) -> bool {
        self.plane.shows_preview()
    }

    /// Defects of the embedding on the screen: flipped faces, concave polygons, crossed holes, crossings, overwound
    /// vertices.
    pub fn defects(&self) -> Vec<Defect> {
        self.step_on_screen().map(|outcome| Defect::all(&outcome.step.verdict).collect()).unwrap_or_default()
    }

    /// Vertices outside the hull of their neighbours in the embedding on the screen, which cause its folds.
    pub fn outside_hull(&self) -> &[VertexId] {
        self.step_on_screen().map_or(&[], |outcome| &outcome.step.outside_hull)
    }

    /// Number of listed defects.
    pub fn defect_count(&self) -> usize {
        self.step_on_screen().map_or(0, |outcome| Defect::all(&outcome.step.verdict).count())
    }
}

/// Corners of a face of the file, by their numbers in files. A face that repairs removed has the corners of the file.
fn corners_in_file(model: &Model, face: FaceId) -> &[VertexId] {
    let given = model.source.polygons.face(face.index());
    let Some(whole) = model.whole_repaired() else { return given };
    let place = (0..).map_while(|place| whole.face_in_file(place)).position(|of| of == face);
    place.map_or(given, |place| whole.polygons().face(place))
}

/// Vertices of the file before cuts and repairs, for vertices by their numbers in files.
fn vertices_of_source(model: &Model, numbers: &[VertexId]) -> Vec<VertexId> {
    let Some(of) = vertices_in_file(model) else { return numbers.to_vec() };
    numbers.iter().filter_map(|number| of.get(number.index()).copied()).collect()
}
