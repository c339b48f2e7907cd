//! What is selected, what is under the pointer, and the tool in hand with what it has begun: half a pair, a drag, a nudge.

use std::collections::BTreeSet;

use eframe::egui;
use glam::DVec2;

use super::seam_tool::SeamTool;
use crate::session::Wake;
use crate::ui::state::{Half, Intent, Pane, PinDrag, Tool};
use freebound_core::mesh::VertexId;
use freebound_core::problem::PinKind;

#[derive(Clone, Debug, Default)]
pub struct Selection {
    vertices: BTreeSet<VertexId>,
    /// Vertices of the file that were selected before the mesh had others, until these are known.
    of_file: BTreeSet<VertexId>,
    defect: Option<usize>,
    /// Whether vertices outside the hull of their neighbours are marked: no defects of their own, but why it folds.
    pub marks_outside_hull: bool,
}

impl Selection {
    pub fn vertices(&self) -> &BTreeSet<VertexId> {
        &self.vertices
    }

    /// Selects exactly these vertices.
    pub fn select(&mut self, vertices: impl IntoIterator<Item = VertexId>) {
        self.vertices = vertices.into_iter().collect();
        self.of_file.clear();
    }

    /// Lets go of all vertices: the mesh has others now. Keeps those of the file that they are, where it has them.
    pub(super) fn let_go(&mut self, in_file: impl Fn(VertexId) -> Option<VertexId>) {
        self.of_file.extend(std::mem::take(&mut self.vertices).into_iter().filter_map(in_file));
    }

    /// Selects again what was let go of, now that the vertices are known that one of the file is.
    pub(super) fn come_back(&mut self, copies: impl Fn(VertexId) -> Vec<VertexId>) {
        self.vertices.extend(std::mem::take(&mut self.of_file).into_iter().flat_map(copies));
    }

    /// Selects vertices beside the others.
    pub fn add(&mut self, vertices: impl IntoIterator<Item = VertexId>) {
        self.vertices.extend(vertices);
    }

    /// Selects a vertex beside the others, or no more.
    pub(super) fn toggle(&mut self, vertex: VertexId) {
        if !self.vertices.remove(&vertex) {
            self.vertices.insert(vertex);
        }
    }

    /// Keeps the vertices of a mesh with so many.
    pub(super) fn keep_below(&mut self, vertex_count: usize) {
        self.vertices.retain(|vertex| vertex.index() < vertex_count);
    }

    /// The defect shown last, by its place in the list.
    pub fn defect(&self) -> Option<usize> {
        self.defect
    }

    /// Keeps the defect where the list has so many.
    pub(super) fn keep_defect_below(&mut self, count: usize) {
        self.defect = self.defect.filter(|place| *place < count);
    }

    pub fn set_defect(&mut self, place: Option<usize>) {
        self.defect = place;
    }
}

/// What is under the pointer, and the box that it draws.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pointer {
    pane: Option<Pane>,
    vertex: Option<VertexId>,
    in_embedding: Option<DVec2>,
    /// The vertex whose menu is open, or was.
    menu_vertex: Option<VertexId>,
    /// The box being drawn with Ctrl, from its first corner, in window points.
    box_from: Option<(Pane, egui::Pos2)>,
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

    /// Closes the menu of a vertex that a mesh with so many does not have.
    pub(super) fn keep_menu_below(&mut self, vertex_count: usize) {
        self.menu_vertex = self.menu_vertex.filter(|vertex| vertex.index() < vertex_count);
    }

    /// Forgets the vertices of a mesh that is gone.
    pub(super) fn forget_vertices(&mut self) {
        (self.vertex, self.menu_vertex) = (None, None);
    }

    /// The pointer in the plane of the embedding.
    pub(in crate::ui) fn in_embedding(&self) -> Option<DVec2> {
        self.in_embedding
    }

    /// Takes in that a frame begins. The vertex stays until both panes were shown: the one drawn first shows what the
    /// pointer found in the other.
    pub(in crate::ui) fn begin_frame(&mut self) {
        (self.pane, self.in_embedding) = (None, None);
    }

    pub(in crate::ui) fn set_vertex(&mut self, vertex: Option<VertexId>) {
        self.vertex = vertex;
    }

    pub(in crate::ui) fn over_mesh(&mut self, vertex: Option<VertexId>) {
        (self.pane, self.vertex) = (Some(Pane::Mesh), vertex);
    }

    /// Takes in where the pointer is in the plane, and what is under it.
    pub(in crate::ui) fn over_plane(&mut self, place: Option<DVec2>, vertex: Option<VertexId>) {
        (self.pane, self.in_embedding, self.vertex) = (Some(Pane::Plane), place, vertex);
    }

    /// The first corner of the box that is drawn in a pane.
    pub(in crate::ui) fn box_in(&self, pane: Pane) -> Option<egui::Pos2> {
        self.box_from.filter(|(of, _)| *of == pane).map(|(_, from)| from)
    }

    pub(in crate::ui) fn begin_box(&mut self, pane: Pane, from: Option<egui::Pos2>) {
        self.box_from = from.map(|from| (pane, from));
    }

    pub(in crate::ui) fn end_box(&mut self) -> bool {
        self.box_from.take().is_some()
    }
}

#[derive(Debug)]
pub struct ToolState {
    tool: Tool,
    /// The seam that is being drawn.
    pub seam: SeamTool,
    pair: Option<Half>,
    intent: Intent,
    /// How the next constraint is held, where a person chose.
    kind: Option<PinKind>,
    drag: Option<PinDrag>,
    is_nudging: bool,
}

impl ToolState {
    pub(super) fn new(wake: &Wake) -> Self {
        Self {
            tool: Tool::default(),
            seam: SeamTool::new(wake),
            pair: None,
            intent: Intent::default(),
            kind: None,
            drag: None,
            is_nudging: false,
        }
    }

    pub fn tool(&self) -> Tool {
        self.tool
    }

    /// Takes up a tool. Half a pair is given up, and the seam that was drawn last is done.
    pub fn take_up(&mut self, tool: Tool) {
        (self.tool, self.pair) = (tool, None);
        if tool != Tool::Seam {
            self.seam.put_away();
        }
    }

    /// The half of a pair that the constrain tool has placed.
    pub fn pair(&self) -> Option<Half> {
        self.pair
    }

    pub fn set_pair(&mut self, pair: Option<Half>) {
        self.pair = pair;
    }

    /// Whether the constrain tool has placed half a pair.
    pub(in crate::ui) fn is_placing_pair(&self) -> bool {
        self.tool == Tool::Constrain && self.pair.is_some()
    }

    /// What a click of the constrain tool would do.
    pub fn intent(&self) -> Intent {
        self.intent
    }

    pub(in crate::ui) fn take_intent(&mut self) -> Intent {
        std::mem::take(&mut self.intent)
    }

    pub(in crate::ui) fn set_intent(&mut self, intent: Intent) {
        self.intent = intent;
    }

    /// How the next constraint is held.
    pub(in crate::ui) fn kind(&self) -> PinKind {
        self.kind.unwrap_or(PinKind::Hard)
    }

    pub(super) fn set_pin_kind(&mut self, kind: PinKind) {
        self.kind = Some(kind);
    }

    pub fn dragged(&self) -> Option<VertexId> {
        self.drag.as_ref().map(PinDrag::vertex)
    }

    /// The drag of a pin, if it is the one being dragged.
    pub(in crate::ui) fn drag_of(&mut self, vertex: VertexId) -> Option<&mut PinDrag> {
        self.drag.as_mut().filter(|drag| drag.vertex() == vertex)
    }

    pub(in crate::ui) fn begin_drag(&mut self, drag: PinDrag) {
        self.drag = Some(drag);
    }

    /// Ends the drag. Returns whether there was one.
    pub(in crate::ui) fn end_drag(&mut self) -> bool {
        self.drag.take().is_some()
    }

    /// Whether arrow keys are moving pins.
    pub fn is_nudging(&self) -> bool {
        self.is_nudging
    }

    pub(in crate::ui) fn set_nudging(&mut self, is_nudging: bool) {
        self.is_nudging = is_nudging;
    }
}
