//! Defects of an embedding: what a verdict lists.

use super::element::Element;
use super::scene::MeshScene;
use freebound_core::mesh::{EdgeId, FaceId, VertexId};
use freebound_core::verify::Verdict;

/// Defects of an embedding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Defect {
    /// A face that is turned over or has no area.
    Flipped(FaceId),
    /// A polygon that another cut into triangles would fold, by its first face.
    Concave(FaceId),
    /// A hole that meets itself or is turned inside out, by its lowest vertex.
    CrossedHole(VertexId),
    /// Two boundary edges that meet.
    Crossing([EdgeId; 2]),
    /// An interior vertex that its faces wind around twice.
    Overwound(VertexId),
}

impl Defect {
    /// The defects that a verdict lists: flipped faces, concave polygons, crossed holes, crossings, overwound vertices.
    pub(in crate::ui) fn all(verdict: &Verdict) -> impl Iterator<Item = Self> {
        let flipped = verdict.flipped_faces.iter().map(|&face| Self::Flipped(face));
        let crossings = verdict.boundary_crossings.iter().map(|&edges| Self::Crossing(edges));
        let overwound = verdict.overwound_vertices.iter().map(|&vertex| Self::Overwound(vertex));
        let concave = verdict.concave_polygons.iter().map(|&face| Self::Concave(face));
        let holes = verdict.crossed_holes.iter().map(|&lowest| Self::CrossedHole(lowest));
        flipped.chain(concave).chain(holes).chain(crossings).chain(overwound)
    }

    pub(in crate::ui) fn elements(self, scene: &MeshScene) -> Vec<Element> {
        match self {
            Self::Flipped(face) => vec![Element::Face(face)],
            Self::Concave(first) => {
                let polygon = scene.disk().and_then(|disk| disk.polygon_of(first));
                polygon.map(|polygon| polygon.faces().map(Element::Face).collect()).unwrap_or_default()
            }
            Self::CrossedHole(lowest) => scene.hole_rim(lowest).into_iter().map(Element::Vertex).collect(),
            Self::Crossing(edges) => edges.map(Element::Edge).to_vec(),
            Self::Overwound(vertex) => vec![Element::Vertex(vertex)],
        }
    }

    /// Its words in lists.
    pub fn words(self) -> String {
        match self {
            Self::Flipped(face) => format!("flipped face {face}"),
            Self::Concave(face) => format!("concave polygon at {face}"),
            Self::CrossedHole(lowest) => format!("crossed hole at {lowest}"),
            Self::Crossing([a, b]) => format!("crossing {a} × {b}"),
            Self::Overwound(vertex) => format!("overwound vertex {vertex}"),
        }
    }
}
