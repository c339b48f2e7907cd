//! Normals or colours of a file, as its format stores them.

use std::ops::Range;

use glam::{DVec3, DVec4};

use freebound_core::mesh::VertexId;

/// Values of one kind in a file.
#[derive(Debug)]
pub(crate) enum FileValues {
    /// Value of each vertex.
    AtVertices(Vec<DVec4>),
    /// Value at each corner.
    AtCorners(CornerValues),
}

/// Values at the corners of a file.
#[derive(Debug, Default)]
pub(crate) struct CornerValues {
    /// First corner of each face, and the end of the last face.
    pub(crate) starts: Vec<usize>,
    /// Vertex of the mesh at each corner.
    pub(crate) vertices: Vec<u32>,
    /// Value at each corner, if it has one.
    pub(crate) values: Vec<Option<DVec4>>,
}

impl FileValues {
    /// Value of a vertex in a face of the file; `at` is its likely place in the face.
    pub(crate) fn at(&self, face: usize, at: usize, vertex: VertexId) -> Option<DVec4> {
        match self {
            Self::AtVertices(values) => values.get(vertex.index()).copied(),
            Self::AtCorners(CornerValues { starts, vertices, values }) => {
                let corners: Range<usize> = *starts.get(face)?..*starts.get(face + 1)?;
                let likely = corners.start + at;
                let is_there = |&corner: &usize| vertices[corner] == vertex.number();
                let corner = Some(likely).filter(|corner| corners.contains(corner)).filter(is_there);
                values[corner.or_else(|| corners.clone().find(is_there))?]
            }
        }
    }
}

/// Converts a colour from linear to sRGB.
pub(crate) fn srgb_from_linear(colour: DVec4) -> DVec4 {
    let one = |x: f64| if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
    colour.truncate().clamp(DVec3::ZERO, DVec3::ONE).map(one).extend(colour.w)
}

/// Converts a colour from sRGB to linear.
pub(crate) fn linear_from_srgb(colour: DVec4) -> DVec4 {
    let one = |x: f64| if x <= 0.040_45 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) };
    colour.truncate().map(one).extend(colour.w)
}
