//! Triangles that weights are summed over: the faces; of averaged polygons all their fans.
//!
//! A polygon with n corners is cut in another way by the fan of each corner, n − 2 triangles that count by 1/n. So no
//! choice of a cut shows in the weights. The triangle at a corner belongs to the fans of its two neighbours; any other
//! triangle of a fan has one side on the outline and belongs to that fan alone. A quad has four triangles, those of its
//! two diagonals, by half each.

use rayon::prelude::*;

use crate::mesh::{DiskMesh, FaceId, HalfedgeId, Polygon, VertexId};

/// A triangle, and how much it counts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub(super) corners: [VertexId; 3],
    /// The links from each corner to the next.
    pub(super) links: [HalfedgeId; 3],
    /// 1 for a face; those of a polygon with n corners sum to n − 2.
    pub(super) share: f64,
    /// The face, or the first one of the polygon.
    pub(super) face: FaceId,
}

/// The faces in their order, but for those of averaged polygons; then the fans of these.
pub(super) fn pieces(mesh: &DiskMesh) -> Vec<Piece> {
    let averaged: Vec<Polygon<'_>> = mesh.polygons().filter(Polygon::is_averaged).collect();
    let mut is_in_fans = vec![false; if averaged.is_empty() { 0 } else { mesh.face_count() }];
    for face in averaged.iter().flat_map(Polygon::faces) {
        is_in_fans[face.index()] = true;
    }
    let whole = mesh.faces().filter(|face| is_in_fans.get(face.index()) != Some(&true)).map(|face| Piece {
        corners: mesh.face(face),
        links: [0, 1, 2].map(|k| HalfedgeId::from_index(3 * face.index() + k)),
        share: 1.0,
        face,
    });
    let mut pieces: Vec<Piece> = whole.collect();
    pieces.par_extend(averaged.par_iter().flat_map_iter(|polygon| fans(mesh, polygon)));
    pieces
}

/// The triangles of a polygon's fans, each once.
fn fans(mesh: &DiskMesh, polygon: &Polygon<'_>) -> Vec<Piece> {
    let (corners, count) = (polygon.corners, polygon.corners.len());
    let piece = |places: [usize; 3], fans: f64| {
        let corners = places.map(|place| corners[place % count]);
        let links = [0, 1, 2].map(|k| link(mesh, corners[k], corners[(k + 1) % 3]));
        Piece { corners, links, share: fans / count as f64, face: polygon.first_face }
    };
    let ears = (0..count).map(|at| piece([at, at + 1, at + 2], 2.0));
    let others = (0..count)
        .flat_map(|apex| (2..count - 2).map(move |ahead| [apex, apex + ahead, apex + ahead + 1]))
        .map(|places| piece(places, 1.0));
    ears.chain(others).collect()
}

fn link(mesh: &DiskMesh, from: VertexId, to: VertexId) -> HalfedgeId {
    mesh.links_from(from).find(|&link| mesh.head(link) == to).expect("corners of an averaged polygon are linked")
}
