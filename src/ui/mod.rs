//! The window's panels and panes: they show the editor's state and collect requests.
//!
//! | file | what |
//! |---|---|
//! | `window.rs` | one frame: all panels and panes in their places |
//! | `controls.rs` | what panels are put together from |
//! | `typed.rs` | fields of numbers, marked where what was typed cannot be taken |
//! | `state/` | plain data that editor, panels and panes share: requests, tools, views |
//! | `editor/` | the editor's state and what a request does to it |
//! | `panes/` | mesh and embedding |
//! | `panels/` | menus, bars, panels, dialogs |
//! | `timeline/` | the strip under the panes |
//! | `presses.rs` | every press of a key or a button in a pass of its own |
//! | `keys.rs`, `keyboard.rs` | keys and what they ask for; presses, and pins moved by arrow keys |
//! | `dialogs.rs` | choice of a file |
//! | `icons.rs` | signs of tools and verdicts |
//! | `theme.rs` | colours and sizes |

mod controls;
mod dialogs;
mod editor;
mod icons;
mod keyboard;
mod keys;
mod panels;
mod panes;
mod presses;
mod state;
pub mod theme;
mod timeline;
mod typed;
mod window;

pub use controls::sentence;
use controls::{
    Control, Offer, close_button, counted, figures, five_digits, heads, list, number, pairs, remark, short,
    tip_with_keys,
};
pub(crate) use dialogs::Dialogs;
pub use editor::{Defect, Editor, MorphView};
use editor::{Element, HullScene};
use keys::keys_of;
pub use keys::{BINDINGS, Binding};
pub use panes::PinMark;
use state::FileDialogKind;
pub use state::{
    ComparisonExport, Half, HullStage, Intent, MorphRequest, Pane, Request, SeamClick, SeamRule, ShadingMode,
    StepTarget, Tab, Tool,
};
use theme::{Theme, theme_of};
use typed::Typed;
pub use window::window_ui;
