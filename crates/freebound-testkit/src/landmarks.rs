//! Landmarks: vertices of the face mesh with their positions in the portrait.

use glam::{DVec2, DVec3};

use super::face::face;
use super::portrait::picture_from_sculpture;
use super::sculpt::{EYE, EYE_HALF_WIDTH, EYE_TILT, MOUTH_HALF_WIDTH, distance};
use freebound_core::mesh::VertexId;

/// Names and positions on the sculpture, seen from the front. The person looks along +z, so that their left is at +x.
///
/// All landmarks are in the middle of the face. Pins at its sides would crowd the rim, which reaches behind the ears,
/// until it crosses itself.
const PLACES: [(&str, f64, f64); 12] = [
    ("left eye, outer corner", EYE.x + EYE_HALF_WIDTH, EYE.y + EYE_TILT),
    ("left eye, inner corner", EYE.x - EYE_HALF_WIDTH, EYE.y - EYE_TILT),
    ("right eye, inner corner", EYE_HALF_WIDTH - EYE.x, EYE.y - EYE_TILT),
    ("right eye, outer corner", -EYE.x - EYE_HALF_WIDTH, EYE.y + EYE_TILT),
    ("bridge of the nose", 0.0, 0.10),
    ("tip of the nose", 0.0, -0.22),
    ("left wing of the nose", 0.172, -0.265),
    ("right wing of the nose", -0.172, -0.265),
    ("upper lip", 0.0, -0.52),
    ("left corner of the mouth", MOUTH_HALF_WIDTH, -0.570),
    ("right corner of the mouth", -MOUTH_HALF_WIDTH, -0.570),
    ("lower lip", 0.0, -0.62),
];

/// Vertex of the face mesh and its position in the portrait.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedLandmark {
    /// Name; left and right are the person's.
    pub name: &'static str,
    /// Vertex of [`BuiltIn::Face`](super::BuiltIn::Face) that is nearest to the landmark.
    pub vertex: VertexId,
    /// Target: u and v of the portrait, v up.
    pub target: [f64; 2],
}

/// Foremost point of the sculpture at an x and y.
fn lift(p: DVec2) -> DVec3 {
    let mut z = 1.2;
    for _ in 0..100 {
        z -= 0.8 * distance(p.extend(z));
    }
    p.extend(z)
}

/// Landmarks that tie the face mesh to the portrait. No similarity maps the vertices to their targets.
pub fn landmarks() -> Vec<PlacedLandmark> {
    let mesh = face();
    let nearest = |p: DVec3| {
        let by_distance = |a: &usize, b: &usize| {
            mesh.positions[*a].distance_squared(p).total_cmp(&mesh.positions[*b].distance_squared(p))
        };
        VertexId::from_index((0..mesh.vertex_count()).min_by(by_distance).unwrap_or_default())
    };
    PLACES
        .iter()
        .map(|&(name, x, y)| {
            let vertex = nearest(lift(DVec2::new(x, y)));
            // The place of the vertex itself: half an edge beside it would twist the mouth, which is a few edges high.
            let target = picture_from_sculpture(mesh.positions[vertex.index()].truncate());
            PlacedLandmark { name, vertex, target: target.to_array() }
        })
        .collect()
}
