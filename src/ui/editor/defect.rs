//! One thing wrong with an embedding.

use crate::mesh::{EdgeId, FaceId, VertexId};
use crate::solver::Verdict;
use crate::ui::Element;

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
    /// The elements at fault.
    pub fn elements(self) -> [Option<Element>; 2] {
        match self {
            Self::Flipped(face) => [Some(Element::Face(face)), None],
            Self::Crossing([a, b]) => [Some(Element::Edge(a)), Some(Element::Edge(b))],
            Self::Overwound(vertex) => [Some(Element::Vertex(vertex)), None],
        }
    }

    /// The defect of a verdict by its place: flipped faces, then crossings, then overwound vertices.
    pub fn nth(verdict: &Verdict, place: usize) -> Option<Self> {
        let Verdict { flipped_faces, boundary_crossings, overwound_vertices, .. } = verdict;
        let flipped = flipped_faces.iter().map(|&face| Self::Flipped(face));
        let crossings = boundary_crossings.iter().map(|&edges| Self::Crossing(edges));
        let overwound = overwound_vertices.iter().map(|&vertex| Self::Overwound(vertex));
        flipped.chain(crossings).chain(overwound).nth(place)
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
