//! Map from vertices on the screen to vertices of the file. The mesh on the screen may be cut, repaired, or one chart
//! of several.

use crate::session::Model;
use freebound_core::mesh::{PolygonMesh, Repaired, VertexId};

/// Vertices of a mesh on the screen and in its file. New vertices of a step have no vertex in the file.
#[derive(Debug)]
pub(in crate::ui) struct InFile {
    vertex_count: usize,
    /// Map to the vertices of the file and back; `None` if it is the identity.
    other: Option<Others>,
    /// For each vertex of the file: true if it has several copies, on any charts. Empty if no vertex has.
    is_several: Vec<bool>,
}

#[derive(Debug)]
struct Others {
    of: Vec<VertexId>,
    by_file: Vec<VertexId>,
}

impl InFile {
    pub(super) fn of(model: &Model) -> Self {
        let others = |of: Vec<VertexId>| {
            let mut by_file: Vec<VertexId> = (0..of.len()).map(VertexId::from_index).collect();
            by_file.sort_by_key(|vertex| of[vertex.index()]);
            Others { of, by_file }
        };
        let source = &model.source.polygons;
        // A chart has its own numbering, so the copies of a vertex are found in the whole mesh.
        let whole = model.whole_repaired();
        let of_whole = whole.map(|whole| whole.vertices_of(source));
        let all = || (0..model.vertex_count()).map(VertexId::from_index);
        let of = of_whole.map(|of| all().map(|vertex| of[model.vertex_in_file(vertex).index()]).collect());
        Self {
            vertex_count: model.vertex_count(),
            other: of.map(others),
            is_several: whole.map(|whole| several(whole, source)).unwrap_or_default(),
        }
    }

    /// True if a vertex of the file has several copies, on this chart or others, because the mesh is cut there.
    pub(in crate::ui) fn is_several(&self, of_file: VertexId) -> bool {
        self.is_several.get(of_file.index()).copied().unwrap_or_default()
    }

    /// Vertex of the file for a vertex on the screen.
    pub(in crate::ui) fn vertex(&self, vertex: VertexId) -> Option<VertexId> {
        match &self.other {
            None => Some(vertex).filter(|vertex| vertex.index() < self.vertex_count),
            Some(others) => others.of.get(vertex.index()).copied(),
        }
    }

    /// Copies on the screen of a vertex of the file: several at a cut, none if the vertex is on another chart.
    pub(in crate::ui) fn copies(&self, of_file: VertexId) -> impl Iterator<Item = VertexId> + '_ {
        let same = (self.other.is_none() && of_file.index() < self.vertex_count).then_some(of_file);
        let several = self.other.as_ref().map_or(&[][..], |others| others.copies(of_file));
        same.into_iter().chain(several.iter().copied())
    }
}

/// For each vertex of a file: true if its corners have several vertices in `whole`.
fn several(whole: &Repaired, source: &PolygonMesh) -> Vec<bool> {
    let mut first = vec![None; source.positions.len()];
    let mut is_several = vec![false; source.positions.len()];
    for (corner, &vertex) in whole.polygons().corners.iter().enumerate() {
        let of = source.corners[whole.corner_of(corner)].index();
        is_several[of] |= *first[of].get_or_insert(vertex) != vertex;
    }
    is_several
}

impl Others {
    fn copies(&self, of_file: VertexId) -> &[VertexId] {
        let of = |vertex: &VertexId| self.of[vertex.index()];
        let from = self.by_file.partition_point(|vertex| of(vertex) < of_file);
        let rest = &self.by_file[from..];
        &rest[..rest.partition_point(|vertex| of(vertex) == of_file)]
    }
}
