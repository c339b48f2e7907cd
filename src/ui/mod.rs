//! Panels and panes of the window: they show the editor's state and collect requests.
//!
//! | file | what |
//! |---|---|
//! | `window.rs` | one frame: all panels and panes in their places |
//! | `commands/` | commands: one table for the menus and the command palette |
//! | `key_map.rs` | keys as the user has set them |
//! | `controls.rs` | building blocks of panels |
//! | `explanations.rs` | meaning, formula and range of the measures |
//! | `typed.rs` | number fields that mark invalid input |
//! | `state/` | plain data that editor, panels and panes share: requests, tools, views |
//! | `editor/` | the editor's state, and the handling of requests |
//! | `panes/` | mesh and embedding |
//! | `panels/` | menus, bars, panels, dialogs |
//! | `timeline/` | the strip under the panes |
//! | `presses.rs` | delivery of every key and button press in its own pass |
//! | `keys.rs`, `keyboard.rs` | table of shortcuts; requests of key presses, pins moved by arrow keys |
//! | `dialogs/` | file dialogs |
//! | `icons.rs` | signs of tools and verdicts |
//! | `documentation.rs` | pages of the book, and a search in them |
//! | `round_joins.rs` | closed lines without spikes |
//! | `theme.rs` | colours and sizes |

mod commands;
mod controls;
mod dialogs;
mod documentation;
mod editor;
mod explanations;
mod icons;
mod key_map;
mod keyboard;
mod keys;
mod panels;
mod panes;
mod presses;
mod round_joins;
mod state;
pub mod theme;
mod timeline;
mod typed;
mod window;

pub use controls::sentence;
use controls::{
    Control, Offer, accented, accented_if, close_button, counted, dialog_buttons, figures, five_digits, head, heads,
    list, number, open_list, option_list, pairs, read_more, remark, short, tip_with_keys,
};
pub(crate) use dialogs::Dialogs;
pub use editor::{Defect, Editor, MorphView};
use editor::{Element, HullScene};
use explanations::GOOD_ENERGY;
pub use explanations::Measure;
pub use key_map::{KeyMap, KeyPreset};
pub use keys::{BINDINGS, Binding};
use keys::{keys_of, with_keys_set};
pub use panes::PinMark;
use state::FileDialogKind;
pub(crate) use state::is_picture;
pub use state::{
    Alignment, Axis, BrushChoice, CheckerRequest, CheckerStyle, ComparisonExport, CurveRequest, CurvesExport,
    GestureKind, Half, Help, HullStage, Intent, MorphRequest, PageRequest, Pane, Request, SeamClick, SeamRule,
    SelectBy, SelectionKind, ShadingMode, Snap, StepTarget, Tab, Tool, Tour, TourCard, Welcome,
};
use theme::{Theme, theme_of};
use typed::Typed;
pub use window::window_ui;
