//! The pairs of vertices of the built-in cube that the figures pin, and what they show.
//!
//! Found by a search over pairs of its 652 vertices, each pinned at the pair's distance, the pinned vertices' equations
//! left out. How many pairs fold faces:
//!
//! | pairs                                  | mean value | Lévy   | conformal |
//! |----------------------------------------|------------|--------|-----------|
//! | 1128, all with both on the boundary    | 264        | 91     | 0         |
//! | 42 445, every fifth of all             | 30 003     | 20 102 | 3663      |
//!
//! So with two boundary vertices, as the paper's text has it, conformal weights do not fold this cube; and where the
//! other weights do, the boundary mostly crosses itself. With a vertex inside the surface faces fold at that vertex,
//! mostly below a simple boundary. Where conformal weights fold, the others fold more.

use freebound_core::mesh::VertexId;
use freebound_core::problem::{Family, Method, Settings};

/// Two vertices to pin, and what was measured with them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PinPair {
    /// The vertices.
    pub vertices: [VertexId; 2],
    /// Flipped faces by weights, in the order of [`WEIGHTS`].
    pub flipped_faces: [usize; 3],
    /// Mean-value iterations until the embedding is planar, from each of these.
    pub iterations: [usize; 3],
}

/// Weights of figure 4's columns, with their names.
pub const WEIGHTS: [(&str, Method, Family); 3] = [
    ("mean value", Method::Natural, Family::MeanValue),
    ("Lévy", Method::Levy, Family::Conformal),
    ("conformal", Method::Natural, Family::Conformal),
];

/// A corner of the cube's top and a vertex of the boundary. The boundary bends inward, so that its convex hull leaves
/// pockets.
pub const TOP_AND_BOUNDARY: PinPair =
    PinPair { vertices: [VertexId::new(24), VertexId::new(435)], flipped_faces: [4, 2, 1], iterations: [1, 1, 1] };

/// Two opposite corners of the cube's top.
pub const TOP_DIAGONAL: PinPair =
    PinPair { vertices: [VertexId::new(12), VertexId::new(36)], flipped_faces: [8, 5, 4], iterations: [2, 2, 1] };

/// The rows of figure 4.
pub const PAIRS: [PinPair; 2] = [TOP_AND_BOUNDARY, TOP_DIAGONAL];

/// The settings of one of [`WEIGHTS`].
pub fn settings(weights: usize) -> Settings {
    let (_, method, family) = WEIGHTS[weights].clone();
    Settings::new(method, family)
}
