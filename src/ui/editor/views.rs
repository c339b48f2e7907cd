//! The editor puts things before the person's eyes: the selection, elements, defects.

use glam::{DVec2, DVec3};

use crate::geom::Bounds;
use crate::mesh::{EdgeId, FaceId, VertexId};
use crate::render::PictureLayer;
use crate::session::Document;
use crate::solver::{Embedding, Verdict};
use crate::ui::{Editor, Element};
use crate::view::{Sphere, bounds_of};

/// Half the width of what `Request::GoTo` shows, in lengths of the element's longest edge.
const GO_TO_MARGIN: f64 = 7.0;

/// A single vertex is shown with this part of the whole around it.
const LEAST_PART: f64 = 12.0;

/// One thing wrong with an embedding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Defect {
    /// A face that is turned over or has no area.
    Flipped(FaceId),
    /// Two boundary edges that meet.
    Crossing([EdgeId; 2]),
    /// An interior vertex that its faces wind around twice.
    Overwound(VertexId),
}

impl Defect {
    /// The defects that a verdict lists: flipped faces, then crossings, then overwound vertices.
    pub(in crate::ui) fn all(verdict: &Verdict) -> impl Iterator<Item = Self> {
        let flipped = verdict.flipped_faces.iter().map(|&face| Self::Flipped(face));
        let crossings = verdict.boundary_crossings.iter().map(|&edges| Self::Crossing(edges));
        let overwound = verdict.overwound_vertices.iter().map(|&vertex| Self::Overwound(vertex));
        flipped.chain(crossings).chain(overwound)
    }

    fn elements(self) -> Vec<Element> {
        match self {
            Self::Flipped(face) => vec![Element::Face(face)],
            Self::Crossing(edges) => edges.map(Element::Edge).to_vec(),
            Self::Overwound(vertex) => vec![Element::Vertex(vertex)],
        }
    }

    /// What it is, for lists.
    pub fn words(self) -> String {
        match self {
            Self::Flipped(face) => format!("flipped face {face}"),
            Self::Crossing([a, b]) => format!("crossing {a} × {b}"),
            Self::Overwound(vertex) => format!("overwound vertex {vertex}"),
        }
    }
}

/// Where a document's picture lies in the plane.
pub(super) fn picture_box(document: &Document) -> Bounds {
    let [low, high] = document.frame().corners();
    Bounds { low, high }
}

impl Editor {
    pub(super) fn frame(&mut self) {
        let Some(scene) = self.mesh_scene() else { return };
        let selected: Vec<VertexId> = self.selection.vertices().iter().copied().collect();
        let ball = around(&scene.mesh().positions, &selected, scene.sphere);
        self.mesh.frame(ball);
        let Some(plane) = self.plane.drawn().cloned() else { return };
        let bounds = self.with_picture(plane.arrays.bounds);
        self.plane.frame(box_around(plane.positions(), &selected, bounds));
        if let Some(camera) = self.plane.camera().filter(|_| selected.is_empty() && plane.is_plain_result()) {
            self.plane.set_framed(camera);
        }
    }

    /// Whether the document has a picture.
    pub fn has_picture(&self) -> bool {
        self.session.document().picture.is_some()
    }

    /// Where the picture lies in the plane; without one, the unit square of texture coordinates.
    pub(in crate::ui) fn picture_box(&self) -> Bounds {
        picture_box(self.session.document())
    }

    /// All that there is in the plane: the embedding, and the picture where there is one.
    pub(in crate::ui) fn with_picture(&self, embedding: Bounds) -> Bounds {
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
            let vertices = defect.elements().into_iter().flat_map(|element| scene.vertices_of(element)).collect();
            self.go_to_vertices(vertices);
        }
    }

    /// Everything that is wrong with the embedding on the screen: flipped faces, crossings, overwound vertices.
    pub fn defects(&self) -> Vec<Defect> {
        self.session.outcome().map(|outcome| Defect::all(&outcome.step.verdict).collect()).unwrap_or_default()
    }

    /// How many defects are listed.
    pub fn defect_count(&self) -> usize {
        self.session.outcome().map_or(0, |outcome| Defect::all(&outcome.step.verdict).count())
    }
}

/// A ball around a few vertices with some of the mesh around it; all of the mesh where there are none.
fn around(positions: &[DVec3], vertices: &[VertexId], all: Sphere) -> Sphere {
    if vertices.is_empty() {
        return all;
    }
    let points: Vec<DVec3> = vertices.iter().filter_map(|v| positions.get(v.index()).copied()).collect();
    let center = Sphere::around(&points).center;
    // The ball of a single point has a made-up size, so the points are asked.
    let radius = points.iter().map(|point| point.distance(center)).fold(0.0, f64::max);
    Sphere { center, radius: (radius * GO_TO_MARGIN).max(all.radius / LEAST_PART).min(all.radius) }
}

/// A box around a few vertices of the embedding with some of it around; all of it where there are none.
fn box_around(embedding: &Embedding, vertices: &[VertexId], all: Bounds) -> Bounds {
    if vertices.is_empty() {
        return all;
    }
    let points: Vec<DVec2> = vertices.iter().filter_map(|v| embedding.get(v.index()).copied()).collect();
    let tight = bounds_of(&points);
    let reach = tight.size().max_element();
    let half = (reach * GO_TO_MARGIN / 2.0).max(all.extent() / LEAST_PART).min(all.extent());
    let center = tight.middle();
    Bounds { low: center - half, high: center + half }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_single_vertex_is_shown_from_near_by() {
        let all = Sphere { center: DVec3::ZERO, radius: 2.0 };
        let near = around(&[DVec3::X], &[VertexId::new(0)], all);
        assert!(near.center == DVec3::X && near.radius < 0.2 * all.radius, "{near:?}");
        let whole = Bounds { low: DVec2::ZERO, high: DVec2::splat(3.0) };
        let part = box_around(&vec![DVec2::ONE].into(), &[VertexId::new(0)], whole);
        assert!(part.middle() == DVec2::ONE && part.extent() < 0.2 * whole.extent(), "{part:?}");
    }

    #[test]
    fn nothing_wider_than_the_whole_is_shown() {
        let all = Sphere { center: DVec3::ZERO, radius: 2.0 };
        let shown = around(&[DVec3::X * -2.0, DVec3::X * 2.0], &[0, 1].map(VertexId::new), all);
        assert!((shown.radius - all.radius).abs() < 1e-12, "{shown:?}");
    }
}
