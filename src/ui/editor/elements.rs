//! Selection of vertices, edges and faces, on the chart on the screen and on the page; seams along it.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::sync::Arc;

use super::Editor;
use super::file_elements::{FileElements, NumberedChart, NumberedMesh};
use super::page::NumberedPage;
use crate::session::Action;
use crate::ui::state::{Edge, PageRequest, SelectionKind, Tool};
use crate::view::{ElementKind, ElementMesh, ElementSet, MeshEdge, MeshElement};
use freebound_core::mesh::{PolygonMesh, Seams, VertexId};

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

    /// Selected elements on the mesh that is shown. Faces of another mesh, which a preview hides, count as vertices.
    pub(super) fn selected_on_shown_mesh(&self) -> Cow<'_, ElementSet> {
        let elements = self.selected_elements();
        let are_there = self.shows_page() || self.mesh_scene().is_none_or(|scene| self.selection.are_of(scene));
        if are_there { Cow::Borrowed(elements) } else { Cow::Owned(elements.clone().into_vertices()) }
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
            let found_on = self.mesh_scene().map(|scene| scene.arrays.revision);
            self.selection.select_elements(elements, found_on);
        }
    }

    /// Clicks select the kind of what is selected: other tools select vertices, and edges or faces become vertices on
    /// another mesh.
    pub(super) fn keep_selection_kind(&mut self) {
        let (selected, now) = (self.selected_elements(), self.element_kind());
        let kind = selected.kind();
        if selected.is_empty() || now.is_none() || now == Some(kind) {
            return;
        }
        if self.selection.kind == SelectionKind::Charts {
            let vertices = selected.clone().into_vertices();
            self.set_elements(vertices);
        } else {
            self.selection.kind = SelectionKind::Elements(kind);
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
                if let Some(elements) = self.on_shown_mesh(|mesh| mesh.converted(&self.selected_on_shown_mesh(), kind))
                {
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
        match self.pointer.element()? {
            MeshElement::Vertex(vertex) | MeshElement::Edge([vertex, _]) => {
                scene.on_chart(vertex).map(|(chart, _)| chart)
            }
            MeshElement::Face(face) => scene.chart_of_face(face),
        }
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
        let selected = self.on_shown_mesh(|mesh| {
            if adds { mesh.toggled(&self.selected_on_shown_mesh(), element) } else { mesh.single(element) }
        });
        if let Some(elements) = selected {
            self.set_elements(elements);
        }
    }

    /// Adds elements of what is shown to the selection, which becomes one of their kind.
    pub(super) fn add_elements(&mut self, added: &ElementSet) {
        let union = self.on_shown_mesh(|mesh| {
            let before = mesh.converted(&self.selected_on_shown_mesh(), added.kind());
            mesh.union(&before, added)
        });
        if let Some(elements) = union {
            self.set_elements(elements);
        }
    }

    /// Shows a chart alone with the elements that are selected on it.
    pub(super) fn open_chart_with_elements(&mut self, chart: usize) {
        let Some(scene) = self.plane.page.scene() else { return };
        let of_file = FileElements::new(self.plane.page.elements(), &NumberedPage::of_chart(scene, chart));
        self.leave_page();
        if self.session.chart_on_screen() != Some(chart) {
            self.selection.await_mesh(of_file);
            return self.act(Action::ShowChart(chart));
        }
        if let Some(scene) = self.mesh_scene().map(Arc::clone) {
            let elements = of_file.on(&NumberedChart { scene: &scene, awaited: &BTreeSet::new() });
            self.selection.select_elements(elements, Some(scene.arrays.revision));
        }
    }
}

/// Seams along the selection.
impl Editor {
    /// Cuts the mesh along the selected edges, or around the selected faces.
    pub(super) fn cut_selection(&mut self) {
        let Some(edges) = self.on_shown_mesh(|mesh| mesh.edges_to_cut(&self.selected_on_shown_mesh())) else { return };
        let before = self.session.seams();
        let listed = self.edges_in_file(&edges);
        let seams = before.with(listed.in_file);
        let is_more = seams.edges().len() > before.edges().len();
        if is_more {
            self.act(Action::SetSeams(seams));
        }
        match listed.not_in_file {
            0 if is_more => {}
            0 => self.session.tell_no_edge("nothing to cut: select edges between two faces, or some of the faces"),
            count => {
                let edges = if count == 1 { "1 edge has" } else { &format!("{count} edges have") };
                self.session.tell_no_edge(&format!("{edges} no edge in the file: new or welded vertices lie there"));
            }
        }
    }

    /// Closes the seams along the selected edges.
    pub(super) fn join_selection(&mut self) {
        match self.seams_without_selection() {
            Some(seams) => self.act(Action::SetSeams(seams)),
            None if self.session.seams().of_texture => {
                self.session.tell_no_edge("nothing to join: seams of the file's texture coordinates stay");
            }
            None => self.session.tell_no_edge("nothing to join: no selected edge is a seam"),
        }
    }

    /// Seams without the selected edges. `None` if it changes nothing.
    fn seams_without_selection(&self) -> Option<Seams> {
        let edges = self.on_shown_mesh(|mesh| mesh.edges_in(&self.selected_on_shown_mesh()))?;
        let (edges, before) = (self.edges_in_file(&edges).in_file, self.session.seams());
        let is_automatic = edges.iter().any(|edge| before.automatic().contains(edge));
        let listed = if is_automatic { before.all_listed() } else { before.clone() };
        let seams = listed.without(edges);
        (seams.edges().len() < listed.edges().len()).then_some(seams)
    }

    /// Edges of what is shown, as edges of the file.
    fn edges_in_file(&self, edges: &BTreeSet<MeshEdge>) -> EdgesInFile {
        let Some(model) = self.session.model() else { return EdgesInFile::default() };
        let found: Vec<Option<Edge>> = if let Some(scene) = self.plane.page.scene().filter(|_| self.shows_page()) {
            let page = NumberedPage::new(scene);
            edges.iter().map(|&edge| page.edge(edge)).collect()
        } else if let Some(scene) = self.mesh_scene() {
            let chart = NumberedChart { scene, awaited: &BTreeSet::new() };
            edges.iter().map(|&edge| chart.edge(edge)).collect()
        } else {
            return EdgesInFile::default();
        };
        let candidates: BTreeSet<Edge> = found.iter().flatten().copied().collect();
        let in_file = edges_of_faces(&model.source.polygons, &candidates);
        let not_in_file = found.iter().filter(|edge| edge.is_none_or(|edge| !in_file.contains(&edge))).count();
        EdgesInFile { in_file, not_in_file }
    }
}

/// Edges of what is shown, in the file.
#[derive(Debug, Default)]
struct EdgesInFile {
    in_file: BTreeSet<Edge>,
    /// Number of edges that are none of the file: they lie inside a face with new vertices, or at welded vertices.
    not_in_file: usize,
}

/// Edges of a set that are sides of faces.
fn edges_of_faces(polygons: &PolygonMesh, edges: &BTreeSet<Edge>) -> BTreeSet<Edge> {
    let faces = (0..polygons.face_count()).map(|face| polygons.face(face));
    let sides = faces.flat_map(|corners| corners.iter().zip(corners.iter().cycle().skip(1)));
    sides.map(|(&a, &b)| [a.min(b), a.max(b)]).filter(|edge| edges.contains(edge)).collect()
}
