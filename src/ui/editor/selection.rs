//! Selection, element under the pointer, and active tool with its state: half a pair, a drag, a nudge.

use std::collections::BTreeSet;
use std::sync::Arc;

use eframe::egui;
use glam::DVec2;

use super::drawn_elements::DrawnElements;
use super::file_elements::{FileElements, NumberedChart};
use super::scene::MeshScene;
use super::seam_hover::SeamHover;
use super::seam_tool::SeamTool;
use crate::session::Wake;
use crate::ui::state::{BrushChoice, Half, Intent, Pane, PinDrag, SelectionKind, Tool};
use crate::view::{EdgeList, ElementSet, MeshElement, Revision};
use freebound_core::mesh::VertexId;
use freebound_core::problem::PinKind;

#[derive(Clone, Debug, Default)]
pub struct Selection {
    elements: DrawnElements,
    /// Kind of elements or charts that clicks and regions select.
    pub(super) kind: SelectionKind,
    /// Elements of the file that return with the scene of another preparation. They stay until the user selects others,
    /// because a cut can lead to a chart that has only some of them, and undo leads back.
    of_file: Option<FileElements>,
    /// True if the selection is to be framed with that scene.
    is_framed_later: bool,
    defect: Option<usize>,
    /// True if vertices behind the mesh are picked and selected, too (X-ray).
    pub through: bool,
    /// True if vertices outside the hull of their neighbours are marked. They are not defects, but the cause of
    /// folds.
    pub marks_outside_hull: bool,
}

impl Selection {
    /// Selected vertices, or the vertices of the selected edges or faces.
    pub fn vertices(&self) -> &BTreeSet<VertexId> {
        self.elements().vertices()
    }

    /// Selected elements.
    pub fn elements(&self) -> &ElementSet {
        self.elements.get()
    }

    /// Kind of elements or charts that clicks and regions select.
    pub fn kind(&self) -> SelectionKind {
        self.kind
    }

    /// Selects exactly these vertices.
    pub fn select(&mut self, vertices: impl IntoIterator<Item = VertexId>) {
        self.select_elements(ElementSet::of_vertices(vertices), None);
    }

    /// Selects exactly these elements, which were found on the mesh with these arrays.
    pub(super) fn select_elements(&mut self, elements: ElementSet, found_on: Option<Revision>) {
        self.elements.set(elements, found_on);
        self.of_file = None;
        self.is_framed_later = false;
    }

    /// Keeps the elements of a mesh by their numbers in the file, because another preparation of it follows.
    pub(super) fn keep_of_file(&mut self, before: &NumberedChart<'_>) {
        if self.of_file.is_none() && self.are_of(before.scene) {
            self.of_file = Some(FileElements::new(self.elements.get(), before));
        }
    }

    /// Drops the elements of the file, because another chart follows; not those that are awaited there.
    pub(super) fn forget_of_file(&mut self) {
        if !self.is_framed_later {
            self.of_file = None;
        }
    }

    /// Clears the elements because the mesh has changed.
    pub(super) fn let_go(&mut self) {
        self.elements.set(ElementSet::default(), None);
    }

    /// Selects elements of the file once the mesh that has them is on the screen. They are framed then.
    pub(super) fn await_mesh(&mut self, of_file: FileElements) {
        self.select([]);
        (self.of_file, self.is_framed_later) = (Some(of_file), true);
    }

    /// Restores the selection on a new mesh from the kept elements of the file. Returns true if the selection is to be
    /// framed.
    pub(super) fn come_back(&mut self, mesh: &NumberedChart<'_>) -> bool {
        if let Some(of_file) = &self.of_file {
            self.elements.set(of_file.on(mesh), Some(mesh.scene.arrays.revision));
        }
        if !mesh.awaited.is_empty() {
            // The elements of the file are those of all copies of their vertices, not of the awaited ones alone.
            self.of_file = None;
        }
        self.is_framed_later && !self.vertices().is_empty()
    }

    /// Selected elements, if they have their numbers on the mesh of a scene.
    pub(in crate::ui) fn elements_on(&self, scene: &MeshScene) -> Option<&ElementSet> {
        self.are_of(scene).then(|| self.elements())
    }

    /// True if the elements have their numbers on the mesh of a scene.
    pub(super) fn are_of(&self, scene: &MeshScene) -> bool {
        self.elements.are_of(scene.arrays.revision)
    }

    /// True once if the selection is to be framed in the map, too, which follows the mesh.
    pub(super) fn is_map_due(&mut self) -> bool {
        let is_due = self.is_framed_later && !self.vertices().is_empty();
        self.is_framed_later &= !is_due;
        is_due
    }

    /// Adds vertices to the selection. Selected edges or faces become their vertices.
    pub fn add(&mut self, vertices: impl IntoIterator<Item = VertexId>) {
        self.elements.change(|elements| elements.add_vertices(vertices));
        self.of_file = None;
    }

    /// Adds a vertex to the selection, or removes it. Selected edges or faces become their vertices.
    pub(super) fn toggle(&mut self, vertex: VertexId) {
        self.elements.change(|elements| elements.toggle_vertex(vertex));
        self.of_file = None;
    }

    /// Keeps the elements that a mesh has. Faces of another mesh, which have other numbers, become their vertices.
    pub(super) fn keep_on(&mut self, scene: &MeshScene) {
        let is_there = |vertex: &VertexId| vertex.index() < scene.mesh().vertex_count();
        if self.are_of(scene) && self.vertices().iter().all(is_there) {
            return;
        }
        let kept: Vec<VertexId> = self.vertices().iter().copied().filter(is_there).collect();
        self.elements.set(ElementSet::of_vertices(kept), None);
    }

    /// Edges of the selection, to be drawn over the mesh with these arrays.
    pub(in crate::ui) fn lines(&self, arrays: Revision) -> Option<&Arc<EdgeList>> {
        self.elements.lines(arrays)
    }

    /// Finds the edges of the selection on a mesh, unless they are known.
    pub(super) fn refresh_lines(&mut self, scene: &MeshScene) {
        self.elements.refresh(scene.arrays.revision, || scene.elements());
    }

    /// Last shown defect, by its place in the list.
    pub fn defect(&self) -> Option<usize> {
        self.defect
    }

    /// Keeps the defect if its place is below a count.
    pub(super) fn keep_defect_below(&mut self, count: usize) {
        self.defect = self.defect.filter(|place| *place < count);
    }

    pub fn set_defect(&mut self, place: Option<usize>) {
        self.defect = place;
    }
}

/// Shapes of regions that select.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::ui) enum RegionShape {
    /// Box between two corners.
    Box,
    /// Inside of a closed curve.
    Lasso,
    /// Surroundings of a line, as wide as a brush.
    Stroke,
}

/// Region that is being drawn to select what lies in it.
#[derive(Clone, Debug)]
pub(in crate::ui) struct DrawnRegion {
    pane: Pane,
    pub(in crate::ui) shape: RegionShape,
    /// Points of a lasso or a stroke, or two corners of a box; window points.
    pub(in crate::ui) points: Vec<egui::Pos2>,
}

/// Element under the pointer, and the region being drawn.
#[derive(Clone, Debug, Default)]
pub struct Pointer {
    pane: Option<Pane>,
    vertex: Option<VertexId>,
    /// Edge or face that a click would select, on the chart on the screen or on the page.
    element: Option<MeshElement>,
    in_embedding: Option<DVec2>,
    /// Vertex whose menu is or was open.
    menu_vertex: Option<VertexId>,
    /// Region being drawn with Ctrl.
    region: Option<DrawnRegion>,
}

impl Pointer {
    pub fn pane(&self) -> Option<Pane> {
        self.pane
    }

    pub fn vertex(&self) -> Option<VertexId> {
        self.vertex
    }

    pub(in crate::ui) fn menu_vertex(&self) -> Option<VertexId> {
        self.menu_vertex
    }

    pub(in crate::ui) fn set_menu_vertex(&mut self, vertex: Option<VertexId>) {
        self.menu_vertex = vertex;
    }

    /// Closes the menu of a vertex at or above a vertex count.
    pub(super) fn keep_menu_below(&mut self, vertex_count: usize) {
        self.menu_vertex = self.menu_vertex.filter(|vertex| vertex.index() < vertex_count);
    }

    /// Clears the elements of a mesh that no longer exists.
    pub(super) fn forget_vertices(&mut self) {
        (self.vertex, self.menu_vertex, self.element) = (None, None, None);
    }

    /// Edge or face that a click would select, or a vertex of the page.
    pub(in crate::ui) fn element(&self) -> Option<MeshElement> {
        self.element
    }

    pub(in crate::ui) fn set_element(&mut self, element: Option<MeshElement>) {
        self.element = element;
    }

    /// Position of the pointer in the plane of the embedding.
    pub(in crate::ui) fn in_embedding(&self) -> Option<DVec2> {
        self.in_embedding
    }

    /// Starts a frame. Keeps the vertex until both panes have been drawn: the pane drawn first shows the vertex found
    /// in the other pane.
    pub(in crate::ui) fn begin_frame(&mut self) {
        (self.pane, self.in_embedding) = (None, None);
    }

    pub(in crate::ui) fn set_vertex(&mut self, vertex: Option<VertexId>) {
        self.vertex = vertex;
    }

    /// Sets the vertex under the pointer in the mesh pane. Clears the element: set it after.
    pub(in crate::ui) fn over_mesh(&mut self, vertex: Option<VertexId>) {
        (self.pane, self.vertex, self.element) = (Some(Pane::Mesh), vertex, None);
    }

    /// Sets the position of the pointer in the plane, and the vertex under it. Clears the element: set it after.
    pub(in crate::ui) fn over_plane(&mut self, place: Option<DVec2>, vertex: Option<VertexId>) {
        (self.pane, self.in_embedding, self.vertex, self.element) = (Some(Pane::Plane), place, vertex, None);
    }

    /// Region being drawn in a pane, with the pointer as its newest point. A lasso or a stroke gets a point after each
    /// `step`.
    pub(in crate::ui) fn region_in(&mut self, pane: Pane, at: egui::Pos2, step: f32) -> Option<&DrawnRegion> {
        let drawn = self.region.as_mut().filter(|drawn| drawn.pane == pane)?;
        let is_box = drawn.shape == RegionShape::Box;
        if is_box {
            drawn.points.truncate(1);
        }
        if is_box || drawn.points.last().is_none_or(|last| last.distance(at) >= step) {
            drawn.points.push(at);
        }
        self.region.as_ref()
    }

    pub(in crate::ui) fn begin_region(&mut self, pane: Pane, from: Option<egui::Pos2>, shape: RegionShape) {
        self.region = from.map(|from| DrawnRegion { pane, shape, points: vec![from] });
    }

    pub(in crate::ui) fn end_region(&mut self) -> bool {
        self.region.take().is_some()
    }
}

#[derive(Debug)]
pub struct ToolState {
    tool: Tool,
    /// Seam being drawn.
    pub seam: SeamTool,
    /// Seam under the pointer.
    pub seam_hover: SeamHover,
    pair: Option<Half>,
    intent: Intent,
    /// Pin kind that the user chose for the next constraint.
    kind: Option<PinKind>,
    drag: Option<PinDrag>,
    is_nudging: bool,
    /// Brush of the brush tool.
    pub brush: BrushChoice,
}

impl ToolState {
    pub(super) fn new(wake: &Wake) -> Self {
        Self {
            tool: Tool::default(),
            seam: SeamTool::new(wake),
            seam_hover: SeamHover::default(),
            pair: None,
            intent: Intent::default(),
            kind: None,
            drag: None,
            is_nudging: false,
            brush: BrushChoice::default(),
        }
    }

    pub fn tool(&self) -> Tool {
        self.tool
    }

    /// Activates a tool. Cancels half a pair, and ends the seam being drawn.
    pub fn take_up(&mut self, tool: Tool) {
        (self.tool, self.pair) = (tool, None);
        if tool != Tool::Seam {
            self.seam.put_away();
        }
    }

    /// First half of a pair, placed by the constrain tool.
    pub fn pair(&self) -> Option<Half> {
        self.pair
    }

    pub fn set_pair(&mut self, pair: Option<Half>) {
        self.pair = pair;
    }

    /// True if the constrain tool has placed half a pair.
    pub(in crate::ui) fn is_placing_pair(&self) -> bool {
        self.tool == Tool::Constrain && self.pair.is_some()
    }

    /// Effect of a click of the constrain tool.
    pub fn intent(&self) -> Intent {
        self.intent
    }

    pub(in crate::ui) fn take_intent(&mut self) -> Intent {
        std::mem::take(&mut self.intent)
    }

    pub(in crate::ui) fn set_intent(&mut self, intent: Intent) {
        self.intent = intent;
    }

    /// Pin kind of the next constraint. Default: hard.
    pub(in crate::ui) fn kind(&self) -> PinKind {
        self.kind.unwrap_or(PinKind::Hard)
    }

    pub(super) fn set_pin_kind(&mut self, kind: PinKind) {
        self.kind = Some(kind);
    }

    pub fn dragged(&self) -> Option<VertexId> {
        self.drag.as_ref().map(PinDrag::vertex)
    }

    /// Drag of a pin, if that pin is being dragged.
    pub(in crate::ui) fn drag_of(&mut self, vertex: VertexId) -> Option<&mut PinDrag> {
        self.drag.as_mut().filter(|drag| drag.vertex() == vertex)
    }

    pub(in crate::ui) fn begin_drag(&mut self, drag: PinDrag) {
        self.drag = Some(drag);
    }

    /// Ends the drag. Returns true if there was one.
    pub(in crate::ui) fn end_drag(&mut self) -> bool {
        self.drag.take().is_some()
    }

    /// True if arrow keys are moving pins.
    pub fn is_nudging(&self) -> bool {
        self.is_nudging
    }

    pub(in crate::ui) fn set_nudging(&mut self, is_nudging: bool) {
        self.is_nudging = is_nudging;
    }
}
