//! Triangles that weights are summed over: the faces; of averaged polygons all their fans.
//!
//! A polygon with n corners is cut in another way by the fan of each corner, n − 2 triangles that count by 1/n. So no
//! choice of a cut shows in the weights. The triangle at a corner belongs to the fans of its two neighbours; any other
//! triangle of a fan has one side on the outline and belongs to that fan alone. A quad has four triangles, those of its
//! two diagonals, by half each.

use crate::parallel::prelude::*;

use crate::mesh::{DiskMesh, FaceId, HalfedgeId, Polygon, VertexId};

/// A triangle, and how much it counts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    pub(crate) corners: [VertexId; 3],
    /// The links from each corner to the next.
    pub(crate) links: [HalfedgeId; 3],
    /// 1 for a face; those of a polygon with n corners sum to n − 2.
    pub(crate) share: f64,
    /// The face, or the first one of the polygon.
    pub(crate) face: FaceId,
}

impl Piece {
    pub(crate) fn of_face(mesh: &DiskMesh, face: FaceId) -> Self {
        let side = |k| HalfedgeId::from_index(3 * face.index() + k);
        Self { corners: mesh.face(face), links: [0, 1, 2].map(side), share: 1.0, face }
    }
}

/// Faces, or averaged polygons, whose pieces are handed over at one time.
const AT_ONCE: usize = 1 << 15;

/// The averaged polygons of a mesh.
pub(crate) struct Fans<'a> {
    polygons: Vec<Polygon<'a>>,
    /// For each face whether it belongs to one of them; empty where there are none.
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

    /// Whether a face belongs to an averaged polygon: then it is no piece.
    pub(crate) fn has_face(&self, face: usize) -> bool {
        self.has_face.get(face) == Some(&true)
    }

    /// Hands over the pieces of all fans, some at a time.
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

/// Hands over all pieces, some at a time: the faces in their order, but for those of averaged polygons; then the fans of
/// these.
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

/// The pieces with a corner at a vertex; where it has no averaged polygon, its faces counter-clockwise.
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

/// The triangles of a polygon's fans, each once.
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
