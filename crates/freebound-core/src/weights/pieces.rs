//! Pieces: the triangles that weights are summed over. Pieces are the faces and, for averaged polygons, the triangles
//! of all their fans.
//!
//! A polygon with n corners has n fans, one per corner, each with n − 2 triangles that count by 1/n. So the weights do
//! not depend on a choice of triangulation. The triangle at a corner belongs to the fans of its two neighbours. Any
//! other triangle of a fan has one side on the outline and belongs to that fan alone. A quad has four triangles, the
//! ones of its two diagonals, which count by half each.

use crate::parallel::prelude::*;

use crate::mesh::{DiskMesh, FaceId, HalfedgeId, Polygon, VertexId};

/// A triangle with its share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    pub(crate) corners: [VertexId; 3],
    /// Links from each corner to the next.
    pub(crate) links: [HalfedgeId; 3],
    /// Factor of the triangle's weights: 1 for a face. The shares of a polygon with n corners sum to n − 2.
    pub(crate) share: f64,
    /// Face of the piece, or first face of its polygon.
    pub(crate) face: FaceId,
}

impl Piece {
    pub(crate) fn of_face(mesh: &DiskMesh, face: FaceId) -> Self {
        let side = |k| HalfedgeId::from_index(3 * face.index() + k);
        Self { corners: mesh.face(face), links: [0, 1, 2].map(side), share: 1.0, face }
    }
}

/// Number of faces, or of averaged polygons, whose pieces are processed at one time.
const AT_ONCE: usize = 1 << 15;

/// Averaged polygons of a mesh.
pub(crate) struct Fans<'a> {
    polygons: Vec<Polygon<'a>>,
    /// True for each face of an averaged polygon; empty if there are no averaged polygons.
    has_face: Vec<bool>,
}

impl<'a> Fans<'a> {
    pub(crate) fn of(mesh: &'a DiskMesh) -> Self {
        let polygons: Vec<Polygon<'_>> = mesh.polygons().filter(Polygon::is_averaged).collect();
        let mut has_face = vec![false; if polygons.is_empty() { 0 } else { mesh.face_count() }];
        for face in polygons.iter().flat_map(Polygon::faces) {
            has_face[face.index()] = true;
        }
        Self { polygons, has_face }
    }

    /// True if a face belongs to an averaged polygon and so is not a piece.
    pub(crate) fn has_face(&self, face: usize) -> bool {
        self.has_face.get(face) == Some(&true)
    }

    /// Passes the pieces of all fans to `take`, in blocks.
    pub(crate) fn in_pieces<E>(
        &self,
        mesh: &DiskMesh,
        mut take: impl FnMut(&[Piece]) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut pieces: Vec<Piece> = Vec::new();
        for some in self.polygons.chunks(AT_ONCE) {
            pieces.clear();
            pieces.par_extend(some.par_iter().flat_map_iter(|polygon| fans(mesh, polygon)));
            take(&pieces)?;
        }
        Ok(())
    }
}

/// Passes all pieces to `take`, in blocks: first the faces in their order, except faces of averaged polygons; then the
/// fans of these polygons.
pub(crate) fn in_pieces<E>(mesh: &DiskMesh, mut take: impl FnMut(&[Piece]) -> Result<(), E>) -> Result<(), E> {
    let of = Fans::of(mesh);
    let mut pieces: Vec<Piece> = Vec::new();
    for first in (0..mesh.face_count()).step_by(AT_ONCE) {
        let faces = first..mesh.face_count().min(first + AT_ONCE);
        pieces.clear();
        let whole = faces.into_par_iter().filter(|&face| !of.has_face(face));
        pieces.par_extend(whole.map(|face| Piece::of_face(mesh, FaceId::from_index(face))));
        take(&pieces)?;
    }
    of.in_pieces(mesh, take)
}

/// Pieces with a corner at a vertex. Without averaged polygons there, they are its faces counter-clockwise.
pub(crate) fn pieces_at(mesh: &DiskMesh, vertex: VertexId) -> Vec<Piece> {
    let mut pieces: Vec<Piece> = Vec::new();
    for face in mesh.outgoing(vertex).filter_map(|side| mesh.face_of(side)) {
        match mesh.polygon_of(face).filter(Polygon::is_averaged) {
            None => pieces.push(Piece::of_face(mesh, face)),
            Some(polygon) if pieces.iter().any(|piece| piece.face == polygon.first_face) => {}
            Some(polygon) => pieces.extend(fans(mesh, &polygon).filter(|piece| piece.corners.contains(&vertex))),
        }
    }
    pieces
}

/// Triangles of a polygon's fans, each once.
fn fans<'a>(mesh: &'a DiskMesh, polygon: &Polygon<'a>) -> impl Iterator<Item = Piece> + use<'a> {
    let (corners, count, face) = (polygon.corners, polygon.corners.len(), polygon.first_face);
    let piece = move |places: [usize; 3], fans: f64| {
        let corners = places.map(|place| corners[place % count]);
        let links = [0, 1, 2].map(|k| link(mesh, corners[k], corners[(k + 1) % 3]));
        Piece { corners, links, share: fans / count as f64, face }
    };
    let ears = (0..count).map(move |at| piece([at, at + 1, at + 2], 2.0));
    let others = (0..count)
        .flat_map(move |apex| (2..count - 2).map(move |ahead| [apex, apex + ahead, apex + ahead + 1]))
        .map(move |places| piece(places, 1.0));
    ears.chain(others)
}

fn link(mesh: &DiskMesh, from: VertexId, to: VertexId) -> HalfedgeId {
    mesh.links_from(from).find(|&link| mesh.head(link) == to).expect("corners of an averaged polygon are linked")
}
