//! Numbers in the file of the elements of the page.

use super::PageScene;
use crate::ui::editor::file_elements::NumberedMesh;
use crate::ui::editor::in_file::{face_in_source, vertex_in_source, vertices_in_file};
use crate::view::ElementMesh;
use freebound_core::mesh::{FaceId, VertexId};

/// Mesh of all charts on the page.
pub(in crate::ui::editor) struct NumberedPage<'a> {
    scene: &'a PageScene,
    /// Only chart whose elements count. `None` if all count.
    chart: Option<usize>,
    /// Vertex of the file for each vertex of the repaired mesh; `None` if they are equal.
    whole: Option<Vec<VertexId>>,
}

impl<'a> NumberedPage<'a> {
    pub(in crate::ui::editor) fn new(scene: &'a PageScene) -> Self {
        // All charts belong to one file.
        Self { scene, chart: None, whole: scene.model_of(0).and_then(vertices_in_file) }
    }

    /// Elements of one chart alone.
    pub(in crate::ui::editor) fn of_chart(scene: &'a PageScene, chart: usize) -> Self {
        Self { chart: Some(chart), ..Self::new(scene) }
    }

    fn counts(&self, chart: usize) -> bool {
        self.chart.is_none_or(|only| only == chart)
    }
}

impl NumberedMesh for NumberedPage<'_> {
    fn mesh(&self) -> ElementMesh<'_> {
        self.scene.elements()
    }

    fn vertex(&self, vertex: VertexId) -> Option<VertexId> {
        let (chart, vertex) = self.scene.on_chart(vertex).filter(|(chart, _)| self.counts(*chart))?;
        vertex_in_source(self.scene.model_of(chart)?, self.whole.as_deref(), vertex)
    }

    fn split_edge(&self, vertex: VertexId) -> Option<[VertexId; 2]> {
        self.scene.split_edge(vertex)
    }

    fn face(&self, triangle: FaceId) -> Option<FaceId> {
        let (chart, number) = self.scene.face_number(triangle).filter(|(chart, _)| self.counts(*chart))?;
        face_in_source(self.scene.model_of(chart)?, number.number())
    }
}
