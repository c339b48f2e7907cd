//! Selection of vertices, edges and faces, on the chart on the screen and on the page; seams along it.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::Editor;
use super::colour_table::vertices_in_file;
use crate::session::{Action, Model};
use crate::ui::state::{Edge, PageRequest, SelectionKind, Tool};
use crate::view::{ElementKind, ElementMesh, ElementSet, MeshEdge, MeshElement};
use freebound_core::mesh::{Seams, VertexId};

/// Kinds of elements.
impl Editor {
    /// Kind of elements that clicks and regions select on what is shown. `None` if they select charts.
    pub fn element_kind(&self) -> Option<ElementKind> {
        match self.selection.kind() {
            SelectionKind::Elements(kind) => Some(kind),
            SelectionKind::Charts if self.shows_page() => None,
            SelectionKind::Charts => Some(ElementKind::Vertices),
        }
    }

    /// Kind of elements or charts that clicks and regions select on the chart or the page that is shown.
    pub fn selection_kind_shown(&self) -> SelectionKind {
        self.element_kind().map_or(SelectionKind::Charts, SelectionKind::Elements)
    }

    /// Kind of elements that a click with the active tool selects, if it selects elements of what is shown.
    pub(in crate::ui) fn kind_under_pointer(&self) -> Option<ElementKind> {
        self.element_kind().filter(|_| self.tools.tool() == Tool::Select)
    }

    /// Selected elements of what is shown: of the page, or of the chart on the screen.
    pub fn selected_elements(&self) -> &ElementSet {
        if self.shows_page() { self.plane.page.elements() } else { self.selection.elements() }
    }

    /// Result of a computation on the mesh that is shown. `None` if there is none, or just after a change of chart.
    pub(super) fn on_shown_mesh<T>(&self, compute: impl FnOnce(&ElementMesh<'_>) -> T) -> Option<T> {
        if self.shows_page() {
            return Some(compute(&self.plane.page.scene()?.elements()));
        }
        let scene = self.mesh_scene().filter(|scene| self.is_of_session(scene))?;
        Some(compute(&scene.elements()))
    }

    /// Selects exactly these elements of what is shown.
    pub(super) fn set_elements(&mut self, elements: ElementSet) {
        if self.shows_page() {
            self.plane.page.select([]);
            self.plane.page.select_elements(elements);
        } else {
            self.selection.select_elements(elements);
        }
    }

    /// Finds the edges of the selection on the screen. Call once per frame.
    pub(super) fn refresh_selection_lines(&mut self) {
        if let Some(scene) = self.mesh_scene().map(Arc::clone).filter(|scene| self.is_of_session(scene)) {
            self.selection.refresh_lines(&scene);
        }
    }

    /// Sets what clicks and regions select. The selection becomes one of that kind.
    pub(super) fn set_selection_kind(&mut self, kind: SelectionKind) {
        if kind == SelectionKind::Charts && self.session.charts().is_none() {
            return;
        }
        if self.tools.tool() != Tool::Select {
            self.take_up_tool(Tool::Select);
        }
        self.drop_gesture();
        if kind == SelectionKind::Charts && !self.shows_page() {
            self.handle(PageRequest::Show(true).into());
            self.selection.kind = kind;
            return;
        }
        let of_page = self.shows_page();
        match kind {
            SelectionKind::Charts => self.select_charts_of_elements(),
            SelectionKind::Elements(kind) if of_page && self.element_kind().is_none() => {
                let charts = self.plane.page.selected().clone();
                let scene = self.plane.page.scene().map(Arc::clone);
                let is_in = |vertex| {
                    let place = scene.as_ref().and_then(|scene| scene.on_chart(vertex));
                    place.is_some_and(|(chart, _)| charts.contains(&chart))
                };
                if let Some(elements) = self.on_shown_mesh(|mesh| mesh.inside(kind, is_in)) {
                    self.set_elements(elements);
                }
            }
            SelectionKind::Elements(kind) => {
                if let Some(elements) = self.on_shown_mesh(|mesh| mesh.converted(self.selected_elements(), kind)) {
                    self.set_elements(elements);
                }
            }
        }
        self.selection.kind = kind;
    }

    /// Selects the charts that have selected elements, and no elements.
    pub(super) fn select_charts_of_elements(&mut self) {
        self.selection.kind = SelectionKind::Charts;
        let charts = self.charts_of_elements();
        self.plane.page.select_elements(ElementSet::default());
        if !charts.is_empty() {
            let charts = self.session.page().map(|page| page.with_stacks(&charts)).unwrap_or(charts);
            self.plane.page.select(charts);
        }
    }

    /// Chart of the element under the pointer, on the page.
    pub(in crate::ui) fn chart_of_element(&self) -> Option<usize> {
        let scene = self.plane.page.scene()?;
        let vertex = match self.pointer.element()? {
            MeshElement::Vertex(vertex) | MeshElement::Edge([vertex, _]) => vertex,
            MeshElement::Face(face) => *scene.mesh.triangles.get(face.index())?.first()?,
        };
        scene.on_chart(vertex).map(|(chart, _)| chart)
    }

    /// Charts with selected elements of the page.
    pub(in crate::ui) fn charts_of_elements(&self) -> BTreeSet<usize> {
        let Some(scene) = self.plane.page.scene() else { return BTreeSet::new() };
        let chart = |vertex: &VertexId| scene.on_chart(*vertex).map(|(chart, _)| chart);
        self.plane.page.elements().vertices().iter().filter_map(chart).collect()
    }
}

/// Clicks and regions.
impl Editor {
    /// Selects an element of what is shown, or adds it to the selection, or removes it.
    pub(super) fn select_element(&mut self, element: MeshElement, adds: bool) {
        let before = self.selected_elements();
        let select = |mesh: &ElementMesh<'_>| if adds { mesh.toggled(before, element) } else { mesh.single(element) };
        if let Some(elements) = self.on_shown_mesh(select) {
            self.set_elements(elements);
        }
    }

    /// Adds elements of what is shown to the selection, which becomes one of their kind.
    pub(super) fn add_elements(&mut self, added: &ElementSet) {
        let before = self.selected_elements();
        let union = |mesh: &ElementMesh<'_>| mesh.union(&mesh.converted(before, added.kind()), added);
        if let Some(elements) = self.on_shown_mesh(union) {
            self.set_elements(elements);
        }
    }

    /// Shows a chart alone with the elements that are selected on it.
    pub(super) fn open_chart_with_elements(&mut self, chart: usize) {
        let Some(scene) = self.plane.page.scene() else { return };
        let on_chart = |vertex: &VertexId| scene.on_chart(*vertex).filter(|(of, _)| *of == chart);
        let vertices: Vec<VertexId> =
            self.plane.page.elements().vertices().iter().filter_map(on_chart).map(|(_, v)| v).collect();
        if self.session.chart_on_screen() == Some(chart) {
            self.leave_page();
            return self.selection.select(vertices);
        }
        let Some(model) = scene.model_of(chart) else { return };
        let whole = vertices_in_file(model);
        let in_file: Vec<VertexId> =
            vertices.into_iter().filter_map(|v| file_vertex(model, whole.as_deref(), v)).collect();
        self.leave_page();
        self.selection.await_mesh(in_file);
        self.act(Action::ShowChart(chart));
    }
}

/// Seams along the selection.
impl Editor {
    /// Cuts the mesh along the selected edges, or around the selected faces.
    pub(super) fn cut_selection(&mut self) {
        match self.seams_along_selection() {
            Some(seams) => self.act(Action::SetSeams(seams)),
            None => self.session.tell_no_edge("nothing to cut: select edges between two faces, or some of the faces"),
        }
    }

    /// Closes the seams along the selected edges.
    pub(super) fn join_selection(&mut self) {
        match self.seams_without_selection() {
            Some(seams) => self.act(Action::SetSeams(seams)),
            None => self.session.tell_no_edge("nothing to join: no selected edge is a seam"),
        }
    }

    /// Seams with a cut along the selected edges, or around the selected faces. `None` if it changes nothing.
    fn seams_along_selection(&self) -> Option<Seams> {
        let edges = self.on_shown_mesh(|mesh| mesh.edges_to_cut(self.selected_elements()))?;
        let before = self.session.seams();
        let seams = before.with(self.edges_in_file(&edges));
        (seams.edges().len() > before.edges().len()).then_some(seams)
    }

    /// Seams without the selected edges. `None` if it changes nothing.
    fn seams_without_selection(&self) -> Option<Seams> {
        let edges = self.on_shown_mesh(|mesh| mesh.edges_in(self.selected_elements()))?;
        let (edges, before) = (self.edges_in_file(&edges), self.session.seams());
        let is_automatic = edges.iter().any(|edge| before.automatic().contains(edge));
        let listed = if is_automatic { before.all_listed() } else { before.clone() };
        let seams = listed.without(edges);
        (seams.edges().len() < listed.edges().len()).then_some(seams)
    }

    /// Edges of what is shown as edges of the file. Edges at new vertices have none.
    fn edges_in_file(&self, edges: &BTreeSet<MeshEdge>) -> Vec<Edge> {
        let Some(first) = self.shown_model() else { return Vec::new() };
        let whole = vertices_in_file(first);
        let page = self.plane.page.scene().filter(|_| self.shows_page());
        let of_file = |vertex: VertexId| match page {
            None => file_vertex(first, whole.as_deref(), vertex),
            Some(scene) => {
                let (chart, vertex) = scene.on_chart(vertex)?;
                file_vertex(scene.model_of(chart)?, whole.as_deref(), vertex)
            }
        };
        let in_file = |&[a, b]: &MeshEdge| {
            let (a, b) = (of_file(a)?, of_file(b)?);
            Some([a.min(b), a.max(b)])
        };
        edges.iter().filter_map(in_file).collect()
    }

    /// Model of the chart on the screen, or of the first chart of the page. All charts belong to one file.
    fn shown_model(&self) -> Option<&Model> {
        match self.plane.page.scene().filter(|_| self.shows_page()) {
            Some(scene) => scene.model_of(0),
            None => self.session.model().map(Arc::as_ref),
        }
    }
}

/// Vertex of the file for a vertex of a chart. `whole` is the result of [`vertices_in_file`].
fn file_vertex(model: &Model, whole: Option<&[VertexId]>, vertex: VertexId) -> Option<VertexId> {
    if vertex.index() >= model.vertex_count() {
        return None;
    }
    let repaired = model.vertex_in_file(vertex);
    whole.map_or(Some(repaired), |whole| whole.get(repaired.index()).copied())
}
