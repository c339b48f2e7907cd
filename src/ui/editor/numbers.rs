//! Names of elements on the screen. Vertices and faces have the numbers of files, reports and the command line, never
//! those of a chart.

use super::Editor;
use super::element::Element;
use super::in_file::number_in_file;
use super::page::PageScene;
use super::scene::MeshScene;
use crate::ui::state::Request;
use crate::view::MeshElement;
use freebound_core::mesh::{EdgeId, FaceId, NewVertex, VertexId};

/// Name of a vertex that only fills a hole.
const IN_HOLE: &str = "virtual";

/// Name of a new vertex of a step, as an end of an edge.
const NEW: &str = "new vertex";

impl MeshScene {
    /// Name of a vertex without a number in files.
    fn no_number(&self, vertex: VertexId) -> String {
        if self.new_vertex(vertex).is_some() { NEW.to_owned() } else { IN_HOLE.to_owned() }
    }

    /// Number in files of a vertex. `None` for a new vertex, and for a vertex that only fills a hole.
    pub fn number_of(&self, vertex: VertexId) -> Option<VertexId> {
        number_in_file(&self.model, vertex)
    }

    /// Name of a vertex: its number in files, or the edge of a new vertex.
    pub fn vertex_words(&self, vertex: VertexId) -> String {
        let words = self.vertex_short_words(vertex);
        if self.new_vertex(vertex).is_some() { format!("new vertex on edge {words}") } else { words }
    }

    /// Short name of a vertex: its number in files, or only the edge of a new vertex.
    pub(in crate::ui) fn vertex_short_words(&self, vertex: VertexId) -> String {
        match self.new_vertex(vertex) {
            Some(new) => self.ends_words(new.edge),
            None => self.number_of(vertex).map_or_else(|| IN_HOLE.to_owned(), |number| number.to_string()),
        }
    }

    /// Name of an edge by its ends. A boundary edge with a new vertex has the name of the edge that it is a part of.
    pub(in crate::ui) fn edge_words(&self, edge: EdgeId) -> String {
        let Some(disk) = self.disk().filter(|disk| edge.index() < disk.edge_count()) else { return edge.to_string() };
        let ends = disk.ends(edge);
        let new: Option<&NewVertex> = ends.iter().find_map(|&end| self.new_vertex(end));
        self.ends_words(new.map_or(ends, |new| new.edge))
    }

    /// Name of an edge by its ends.
    fn ends_words(&self, ends: [VertexId; 2]) -> String {
        let [a, b] = ends.map(|end| self.number_of(end).map_or_else(|| self.no_number(end), |end| end.to_string()));
        format!("{a}–{b}")
    }

    /// Name of a vertex, an edge or a face.
    pub(in crate::ui) fn element_words(&self, element: MeshElement) -> String {
        match element {
            MeshElement::Vertex(vertex) => self.vertex_words(vertex),
            MeshElement::Edge(ends) => self.ends_words(ends),
            MeshElement::Face(face) if face.index() < self.mesh().face_count() => {
                format!("face {}", self.face_number(face).number())
            }
            MeshElement::Face(_) => String::new(),
        }
    }

    /// Number in files of the face that a triangle is, or is a part of.
    pub fn face_number(&self, face: FaceId) -> FaceId {
        FaceId::new(self.mesh().polygon(face))
    }
}

impl PageScene {
    /// Name of a vertex, an edge or a face of the page, with its chart.
    pub(in crate::ui) fn element_words(&self, element: MeshElement) -> Option<String> {
        let vertex_words = |vertex: VertexId| {
            let (chart, vertex) = self.on_chart(vertex)?;
            let number = number_in_file(self.model_of(chart)?, vertex);
            Some((chart, number.map_or_else(|| NEW.to_owned(), |number| number.to_string())))
        };
        let (chart, words) = match element {
            MeshElement::Vertex(vertex) => vertex_words(vertex)?,
            MeshElement::Edge([a, b]) => {
                let (chart, first) = vertex_words(a)?;
                (chart, format!("{first}–{}", vertex_words(b)?.1))
            }
            MeshElement::Face(face) => {
                let (chart, number) = self.face_number(face)?;
                (chart, format!("face {}", number.number()))
            }
        };
        Some(format!("Chart {chart}, {words}"))
    }
}

impl Editor {
    /// Name of a vertex on the screen: its number in files, or the edge of a new vertex.
    pub(in crate::ui) fn vertex_words(&self, vertex: VertexId) -> String {
        match self.mesh_scene() {
            Some(scene) => scene.vertex_words(vertex),
            None => self.session.number_of(vertex).to_string(),
        }
    }

    /// Request that shows an element: a vertex or face by its number in files, on any chart, or an edge of the mesh on
    /// the screen. `None` if there is no such element.
    pub(in crate::ui) fn request_to_show(&self, element: Element) -> Option<Request> {
        match element {
            Element::Vertex(number) => self.session.has_number(number).then(|| Request::GoToFileVertices(vec![number])),
            Element::Face(face) => {
                let count = self.session.model()?.source.polygons.face_count();
                (face.index() < count).then(|| Request::GoToFileFaces(vec![face]))
            }
            Element::Edge(_) => {
                let ends = self.mesh_scene()?.vertices_of(element);
                (!ends.is_empty()).then_some(Request::GoTo(ends))
            }
        }
    }
}
