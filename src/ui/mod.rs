//! The window's panels and panes: they show the editor's state and collect requests.

mod boxes;
mod compare;
mod defect;
mod defect_marks;
mod defects_panel;
mod dialogs;
mod ease;
mod editor;
mod editor_scenes;
mod editor_timeline;
mod equation_table;
mod floating;
mod framing;
mod hull;
mod icons;
mod keys;
mod magnifier;
mod menu;
mod mesh_pane;
mod method_panel;
mod pane;
mod pins_panel;
mod plane_pane;
mod request;
mod scene;
mod side_panel;
mod status;
pub mod theme;
mod timeline;
mod timeline_buttons;
mod timeline_chips;
mod timeline_curves;
mod tools;
mod vertex_panel;
mod window;

pub use defect::Defect;
pub use dialogs::{Choice, Dialogs, Purpose};
pub use ease::Ease;
pub use editor::Editor;
pub use hull::{HullScene, HullView, Stage};
pub use keys::{BINDINGS, Binding, keys_of};
pub use method_panel::sentence;
pub use pane::PinOwner;
pub use request::{Pane, Request, Shading, StepTarget, Tab, Tool};
pub use scene::{Element, MeshScene, Paint, PaintKey, PlaneScene};
pub use timeline::TimelineView;
pub use window::window_ui;

/// Fields of the checker across the embedding.
pub const CHECKER_FIELDS: f64 = 40.0;
