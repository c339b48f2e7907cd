//! Map from vertices on the screen to vertices of the file. The mesh on the screen may be cut, repaired, or one chart
//! of several.

use crate::session::Model;
use freebound_core::mesh::{FaceId, PolygonMesh, Repaired, VertexId};

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
        // A chart has its own numbering, so the copies of a vertex are found in the whole mesh.
        let all = || (0..model.vertex_count()).map(VertexId::from_index);
        let of =
            vertices_in_file(model).map(|of| all().map(|vertex| of[model.vertex_in_file(vertex).index()]).collect());
        let whole = model.whole_repaired();
        Self {
            vertex_count: model.vertex_count(),
            other: of.map(others),
            is_several: whole.map(|whole| several(whole, &model.source.polygons)).unwrap_or_default(),
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

/// Vertex of the file for each vertex of the repaired mesh; `None` if they are equal.
pub(super) fn vertices_in_file(model: &Model) -> Option<Vec<VertexId>> {
    model.whole_repaired().map(|whole| whole.vertices_of(&model.source.polygons))
}

/// Number in files of a vertex of a mesh or chart. `None` for a new vertex of a step, and for one that only fills a hole.
pub(super) fn number_in_file(model: &Model, vertex: VertexId) -> Option<VertexId> {
    (vertex.index() < model.vertex_count()).then(|| model.vertex_in_file(vertex))
}

/// Vertex of the file for a vertex of a mesh or chart. `whole` is the result of [`vertices_in_file`].
pub(super) fn vertex_in_source(model: &Model, whole: Option<&[VertexId]>, vertex: VertexId) -> Option<VertexId> {
    let repaired = number_in_file(model, vertex)?;
    whole.map_or(Some(repaired), |whole| whole.get(repaired.index()).copied())
}

/// Face of the file for a face of a mesh or chart, by the number of its polygon.
pub(super) fn face_in_source(model: &Model, polygon: u32) -> Option<FaceId> {
    match model.prepared.repaired.as_deref() {
        Some(repaired) => repaired.face_in_file(polygon),
        None => Some(FaceId::new(polygon)),
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
