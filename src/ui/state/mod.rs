//! Plain data that the editor, the panels and the panes share: requests, tools, kinds of dialogs, views.
//!
//! | file | what |
//! |---|---|
//! | `request.rs` | requests that panels and panes collect and the editor carries out |
//! | `tool.rs` | tools of the left mouse button, halves of a pair |
//! | `pane.rs`, `pane_view.rs` | the two panes and the tabs; place and camera of a pane |
//! | `page.rs` | requests to the page of all charts, gestures on it |
//! | `shading_mode.rs` | colours of faces |
//! | `file_dialog_kind.rs` | kinds of file dialogs |
//! | `checker.rs` | squares of the checker, requests to change it |
//! | `comparison.rs` | requests to the comparison of methods and its morph |
//! | `hull_stage.rs` | stages of the virtual boundary |
//! | `select_by.rs` | what is selected, and ways to select by mesh, map and selection |
//! | `seam.rs` | clicks of the seam tool, rules that choose edges |
//! | `unsaved.rs` | the question about unsaved work |
//! | `help.rs` | windows that help: command palette, list of keys, messages, About |
//! | `brush.rs` | the brush of the brush tool |
//! | `inset_view.rs` | zoom and pan of the insets |
//! | `pin_drag.rs` | a drag of a pin |
//! | `timeline_view.rs` | state of the timeline in the window |
//! | `toast.rs` | the success message that shows |
//! | `tour.rs` | the guided tour |
//! | `welcome.rs` | the welcome at a start without a file |

mod brush;
mod checker;
mod comparison;
mod file_dialog_kind;
mod help;
mod hull_stage;
mod inset_view;
mod page;
mod pane;
mod pane_view;
mod pin_drag;
mod request;
mod seam;
mod select_by;
mod shading_mode;
mod timeline_view;
mod toast;
mod tool;
mod tour;
mod unsaved;
mod welcome;

pub use brush::BrushChoice;
pub(in crate::ui) use brush::brush_words;
pub use checker::{CheckerRequest, CheckerStyle};
pub(in crate::ui) use checker::{SQUARES, nearest_squares};
pub use comparison::{ComparisonExport, MorphRequest};
pub(in crate::ui) use file_dialog_kind::ExportOptions;
pub(crate) use file_dialog_kind::is_picture;
pub(in crate::ui) use file_dialog_kind::{
    BAKED, COPY_COMMAND, COPY_LAYOUT, DialogForm, EXPORTS, FileDialogKind, MESHES, NO_LAYOUT_PICTURE, NO_MAP, PATTERN,
};
pub use help::Help;
pub(in crate::ui) use help::{DocumentationView, KeyClash, KeyList, Palette};
pub use hull_stage::HullStage;
pub(in crate::ui) use inset_view::{InsetKind, InsetPan, InsetSubject, InsetView};
pub use page::{Alignment, Axis, GestureKind, PageRequest, Snap};
pub(in crate::ui) use page::{PageGesture, SnapPlaces};
pub use pane::{Pane, Tab};
pub(in crate::ui) use pane_view::{PaneView, Viewport, in_pane, size_of};
pub(in crate::ui) use pin_drag::PinDrag;
pub use request::{Request, StepTarget};
pub(in crate::ui) use seam::Edge;
pub use seam::{SeamClick, SeamRule};
pub use select_by::{SelectBy, SelectionKind};
pub use shading_mode::ShadingMode;
pub(in crate::ui) use timeline_view::{CURVE_COUNT, ROW_HEIGHT, TimelineView};
pub use timeline_view::{CurveRequest, CurvesExport};
pub(in crate::ui) use toast::Toast;
pub use tool::{Half, Intent, Tool};
pub(in crate::ui) use tour::TourStart;
pub use tour::{Tour, TourCard};
pub(in crate::ui) use unsaved::{PendingClose, UnsavedAnswer};
pub use welcome::Welcome;
