//! Vertices of what is on the screen, which may be cut, mended, or one chart of several, as those of the file.

use crate::session::Model;
use freebound_core::mesh::{PolygonMesh, Repaired, VertexId};

/// Vertices of a mesh on the screen and of its file. New vertices of a step are of no file.
#[derive(Debug)]
pub(in crate::ui) struct InFile {
    vertex_count: usize,
    /// The file's vertex that each vertex is, and the vertices in the order of these; none where all are the same.
    other: Option<Others>,
    /// For each vertex of the file whether it is several, on whatever charts; empty where none is.
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
        // A chart has numbers of its own: all of them together tell those that the file has.
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

    /// Whether a vertex of the file is several, on this chart or others: because the mesh is cut there.
    pub(in crate::ui) fn is_several(&self, of_file: VertexId) -> bool {
        self.is_several.get(of_file.index()).copied().unwrap_or_default()
    }

    /// The file's vertex that a vertex is.
    pub(in crate::ui) fn vertex(&self, vertex: VertexId) -> Option<VertexId> {
        match &self.other {
            None => Some(vertex).filter(|vertex| vertex.index() < self.vertex_count),
            Some(others) => others.of.get(vertex.index()).copied(),
        }
    }

    /// The vertices that one of the file is here: several where it is cut there, none where it is on another chart.
    pub(in crate::ui) fn copies(&self, of_file: VertexId) -> impl Iterator<Item = VertexId> + '_ {
        let same = (self.other.is_none() && of_file.index() < self.vertex_count).then_some(of_file);
        let several = self.other.as_ref().map_or(&[][..], |others| others.copies(of_file));
        same.into_iter().chain(several.iter().copied())
    }
}

/// For each vertex of a file whether faces at it have several vertices there.
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
