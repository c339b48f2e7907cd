//! The tool in hand, and what it has begun: half a pair, a drag, a nudge.

use super::Tool;
use crate::mesh::VertexId;
use crate::solver::Hold;
use crate::ui::panes::pin_drag::PinDrag;
use crate::ui::panes::{Half, Intent};

#[derive(Clone, Debug, Default)]
pub struct ToolState {
    tool: Tool,
    pair: Option<Half>,
    intent: Intent,
    /// How the next constraint is held, where a person chose.
    hold: Option<Hold>,
    drag: Option<PinDrag>,
    is_nudging: bool,
}

impl ToolState {
    pub fn tool(&self) -> Tool {
        self.tool
    }

    /// Takes up a tool. Half a pair is given up.
    pub fn take_up(&mut self, tool: Tool) {
        (self.tool, self.pair) = (tool, None);
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
    pub(in crate::ui) fn hold(&self) -> Hold {
        self.hold.unwrap_or(Hold::Hard)
    }

    pub(super) fn set_hold(&mut self, hold: Hold) {
        self.hold = Some(hold);
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
