//! Pairs of vertices of the built-in cube that the figures pin, with their measurements.
//!
//! A search over pairs of the cube's 652 vertices found them. Each pair is pinned at its distance, and the equations of
//! the pinned vertices are eliminated. Number of pairs that fold faces:
//!
//! | pairs                               | mean value | Lévy   | conformal |
//! |-------------------------------------|------------|--------|-----------|
//! | 1128, all with both on the boundary | 264        | 91     | 0         |
//! | 42 445, every fifth of all          | 30 003     | 20 102 | 3663      |
//!
//! With two boundary vertices, as in the paper's text, conformal weights do not fold this cube. If the other weights
//! fold it, the boundary mostly crosses itself. With a vertex inside the surface, faces fold at that vertex, mostly
//! with a simple boundary. If conformal weights fold, the others fold more.

use freebound_core::mesh::VertexId;
use freebound_core::problem::{Family, Method, Settings};

/// Pair of vertices to pin, with its measurements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PinPair {
    /// Vertices to pin.
    pub vertices: [VertexId; 2],
    /// Number of flipped faces, for each of [`WEIGHTS`].
    pub flipped_faces: [usize; 3],
    /// Number of mean-value iterations until the embedding is planar, for each of [`WEIGHTS`].
    pub iterations: [usize; 3],
}

/// Weights of the columns of figure 4, with their names.
pub const WEIGHTS: [(&str, Method, Family); 3] = [
    ("mean value", Method::Natural, Family::MeanValue),
    ("Lévy", Method::Levy, Family::Conformal),
    ("conformal", Method::Natural, Family::Conformal),
];

/// Corner of the cube's top, and a vertex of the boundary. The boundary bends inward, so that its convex hull leaves
/// pockets.
pub const TOP_AND_BOUNDARY: PinPair =
    PinPair { vertices: [VertexId::new(24), VertexId::new(435)], flipped_faces: [4, 2, 1], iterations: [1, 1, 1] };

/// Opposite corners of the cube's top.
pub const TOP_DIAGONAL: PinPair =
    PinPair { vertices: [VertexId::new(12), VertexId::new(36)], flipped_faces: [8, 5, 4], iterations: [2, 2, 1] };

/// Pairs of the rows of figure 4.
pub const PAIRS: [PinPair; 2] = [TOP_AND_BOUNDARY, TOP_DIAGONAL];

/// Settings for one of [`WEIGHTS`].
pub fn settings(weights: usize) -> Settings {
    let (_, method, family) = WEIGHTS[weights].clone();
    Settings::new(method, family)
}
