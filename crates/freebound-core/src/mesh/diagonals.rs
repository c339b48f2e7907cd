//! Diagonals of averaged polygons that are not sides of triangles: the links of the equations beyond the halfedges.

use super::polygons::Polygons;
use super::{DiskMesh, VertexId};

/// Diagonals by their ends and by vertex. All lists are empty if there are no polygons.
#[derive(Clone, Debug, Default)]
pub(super) struct Diagonals {
    /// Ends of each diagonal, the lower number first; ascending.
    ends: Vec<[VertexId; 2]>,
    /// Start of each vertex's list in `of_vertex`, and the end of the last list.
    starts: Vec<u32>,
    /// Links by the vertex they leave: 2 k from the lower end of diagonal k, 2 k + 1 from its higher end.
    of_vertex: Vec<u32>,
}

impl Diagonals {
    /// Collects the diagonals of a mesh's averaged polygons.
    pub(super) fn of(mesh: &DiskMesh, polygons: &Polygons) -> Self {
        let mut ends = Vec::new();
        for polygon in polygons.iter().filter(super::polygons::Polygon::is_averaged) {
            let (corners, count) = (polygon.corners, polygon.corners.len());
            for (at, &a) in corners.iter().enumerate() {
                // The side that closes the polygon joins the first corner and the last.
                let last = count - usize::from(at == 0);
                ends.extend(corners[..last].iter().skip(at + 2).map(|&b| [a.min(b), a.max(b)]));
            }
        }
        ends.sort_unstable();
        ends.dedup();
        ends.retain(|&[a, b]| mesh.outgoing(a).all(|h| mesh.head(h) != b));
        if ends.is_empty() {
            return Self::default();
        }
        let mut leaving: Vec<(VertexId, u32)> =
            (0..).zip(&ends).flat_map(|(k, &[a, b])| [(a, 2 * k), (b, 2 * k + 1)]).collect();
        leaving.sort_unstable();
        let starts = mesh.vertices().map(|v| leaving.partition_point(|&(of, _)| of < v));
        let starts = starts.chain([leaving.len()]).map(|start| u32::try_from(start).expect("links fit")).collect();
        Self { ends, starts, of_vertex: leaving.into_iter().map(|(_, link)| link).collect() }
    }

    /// Number of links: two per diagonal, one in each direction.
    pub(super) fn link_count(&self) -> usize {
        2 * self.ends.len()
    }

    /// Tail and head of a link.
    pub(super) fn ends(&self, link: usize) -> [VertexId; 2] {
        let [low, high] = self.ends[link / 2];
        if link.is_multiple_of(2) { [low, high] } else { [high, low] }
    }

    /// Links that leave a vertex.
    pub(super) fn from(&self, vertex: VertexId) -> &[u32] {
        match self.starts.get(vertex.index()..vertex.index() + 2) {
            Some(&[from, to]) => &self.of_vertex[from as usize..to as usize],
            _ => &[],
        }
    }
}
