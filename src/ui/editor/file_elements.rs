//! Selected elements by their numbers in the file. These stay while the mesh is cut, repaired or joined.

use std::collections::BTreeSet;

use super::in_file::face_in_source;
use super::scene::MeshScene;
use crate::view::{ElementKind, ElementMesh, ElementSet, MeshEdge};
use freebound_core::mesh::{FaceId, VertexId};

/// Elements of one kind by their numbers in the file.
#[derive(Clone, Debug, Default)]
pub(super) struct FileElements {
    kind: ElementKind,
    vertices: BTreeSet<VertexId>,
    edges: BTreeSet<MeshEdge>,
    faces: BTreeSet<FaceId>,
}

/// Mesh on the screen, with the numbers of its elements in the file.
pub(super) trait NumberedMesh {
    /// The mesh.
    fn mesh(&self) -> ElementMesh<'_>;

    /// Vertex of the file. `None` for a new vertex.
    fn vertex(&self, vertex: VertexId) -> Option<VertexId>;

    /// Face of the file that a triangle is, or is a part of.
    fn face(&self, triangle: FaceId) -> Option<FaceId>;

    /// Ends of the edge that a new vertex splits. `None` for a vertex of the file.
    fn split_edge(&self, vertex: VertexId) -> Option<[VertexId; 2]>;

    /// Edge of the file that an edge is, or is a part of. `None` if an end has no vertex there.
    fn edge(&self, ends: MeshEdge) -> Option<MeshEdge> {
        let whole = match ends.map(|end| self.split_edge(end)) {
            [None, None] => ends,
            [Some(split), None] if split.contains(&ends[1]) => split,
            [None, Some(split)] if split.contains(&ends[0]) => split,
            [Some(split), Some(other)] if split == other => split,
            _ => return None,
        };
        let [a, b] = whole.map(|end| self.vertex(end));
        let (a, b) = (a?, b?);
        Some([a.min(b), a.max(b)])
    }
}

impl FileElements {
    pub(super) fn of_vertices(vertices: impl IntoIterator<Item = VertexId>) -> Self {
        Self { vertices: vertices.into_iter().collect(), ..Self::default() }
    }

    /// Elements of a mesh. Those that the file does not have are left out.
    pub(super) fn new(elements: &ElementSet, mesh: &impl NumberedMesh) -> Self {
        let kind = elements.kind();
        match kind {
            ElementKind::Vertices => {
                Self::of_vertices(elements.vertices().iter().filter_map(|&vertex| mesh.vertex(vertex)))
            }
            ElementKind::Edges => {
                let edges = elements.edges().iter().filter_map(|&ends| mesh.edge(ends)).collect();
                Self { kind, edges, ..Self::default() }
            }
            ElementKind::Faces => {
                let faces = elements.faces().iter().filter_map(|&triangle| mesh.face(triangle)).collect();
                Self { kind, faces, ..Self::default() }
            }
        }
    }

    /// These elements on a mesh: every copy that it has of them.
    pub(super) fn on(&self, mesh: &impl NumberedMesh) -> ElementSet {
        let elements = mesh.mesh();
        match self.kind {
            _ if self.is_empty() => ElementSet::default(),
            ElementKind::Vertices => {
                let is_selected = |vertex| mesh.vertex(vertex).is_some_and(|of| self.vertices.contains(&of));
                elements.vertices_where(is_selected)
            }
            ElementKind::Edges => {
                elements.edges_where(|ends| mesh.edge(ends).is_some_and(|edge| self.edges.contains(&edge)))
            }
            ElementKind::Faces => {
                elements.faces_where(|triangle| mesh.face(triangle).is_some_and(|face| self.faces.contains(&face)))
            }
        }
    }

    fn is_empty(&self) -> bool {
        self.vertices.is_empty() && self.edges.is_empty() && self.faces.is_empty()
    }
}

/// Mesh of one chart. `awaited` are numbers in files of the only vertices that count; none if all count.
pub(super) struct NumberedChart<'a> {
    pub(super) scene: &'a MeshScene,
    pub(super) awaited: &'a BTreeSet<VertexId>,
}

impl NumberedMesh for NumberedChart<'_> {
    fn mesh(&self) -> ElementMesh<'_> {
        self.scene.elements()
    }

    fn vertex(&self, vertex: VertexId) -> Option<VertexId> {
        let is_awaited = |own| self.awaited.is_empty() || self.awaited.contains(&own);
        self.scene.in_file.vertex(vertex).filter(|_| self.scene.number_of(vertex).is_some_and(is_awaited))
    }

    fn split_edge(&self, vertex: VertexId) -> Option<[VertexId; 2]> {
        self.scene.new_vertex(vertex).map(|new| new.edge)
    }

    fn face(&self, triangle: FaceId) -> Option<FaceId> {
        face_in_source(&self.scene.model, self.scene.mesh().polygon(triangle))
    }
}
