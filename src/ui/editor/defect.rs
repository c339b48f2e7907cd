//! Defects of an embedding, listed by a verdict.

use super::element::Element;
use super::scene::MeshScene;
use freebound_core::mesh::{EdgeId, FaceId, VertexId};
use freebound_core::verify::Verdict;

/// Defect of an embedding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Defect {
    /// Face that is flipped or has no area.
    Flipped(FaceId),
    /// Polygon with a triangulation that would fold, by its first face.
    Concave(FaceId),
    /// Hole whose rim crosses itself or is turned inside out, by its lowest vertex.
    CrossedHole(VertexId),
    /// Two boundary edges that meet.
    Crossing([EdgeId; 2]),
    /// Interior vertex around which the faces wind twice.
    Overwound(VertexId),
}

impl Defect {
    /// Defects that a verdict lists: flipped faces, concave polygons, crossed holes, crossings, overwound vertices.
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

    /// Description in lists, with the numbers of files. `scene` is the mesh of the embedding.
    pub fn words(self, scene: &MeshScene) -> String {
        match self {
            Self::Flipped(face) => format!("flipped face {}", scene.face_number(face)),
            Self::Concave(face) => format!("concave polygon at {}", scene.face_number(face)),
            Self::CrossedHole(lowest) => format!("crossed hole at {}", scene.vertex_words(lowest)),
            Self::Crossing(edges) => {
                let [a, b] = edges.map(|edge| scene.edge_words(edge));
                format!("crossing {a} × {b}")
            }
            Self::Overwound(vertex) if scene.new_vertex(vertex).is_some() => {
                format!("overwound {}", scene.vertex_words(vertex))
            }
            Self::Overwound(vertex) => format!("overwound vertex {}", scene.vertex_words(vertex)),
        }
    }
}
