//! The window's panels and panes: they show the editor's state and collect requests.
//!
//! | file | what |
//! |---|---|
//! | `window.rs` | one frame: all panels and panes in their places |
//! | `controls.rs` | what panels are put together from |
//! | `typed.rs` | fields of numbers, marked where what was typed cannot be taken |
//! | `editor/` | the editor's state and what a request does to it |
//! | `panes/` | mesh and embedding |
//! | `panels/` | menus, bars, panels, dialogs |
//! | `timeline/` | the strip under the panes |
//! | `presses.rs` | every press of a key or a button in a pass of its own |
//! | `keys.rs` | keys and what they ask for; pins moved by arrow keys |
//! | `icons.rs` | signs of tools and verdicts |
//! | `theme.rs` | colours and sizes |

mod controls;
mod editor;
mod icons;
mod keys;
mod panels;
mod panes;
mod presses;
pub mod theme;
mod timeline;
mod typed;
mod window;

pub use controls::sentence;
use controls::{
    Control, Offer, close_button, counted, figures, five_digits, heads, list, number, pairs, remark, tip_with_keys,
};
pub use editor::{
    ComparisonExport, Defect, Editor, MorphRequest, MorphView, Pane, Request, SeamClick, SeamRule, Shading, Stage,
    StepTarget, Tab, Tool,
};
use editor::{Element, HullScene, Purpose};
use keys::keys_of;
pub use keys::{BINDINGS, Binding};
pub(crate) use panels::Dialogs;
use panels::{Answer, Unsaved};
pub use panes::{Half, Intent, PinKind};
use theme::{Theme, theme_of};
use timeline::TimelineView;
use typed::Typed;
pub use window::window_ui;
