//! Everything around the panes: panels at the right, menus, tool bar, status bar, dialogs.
//!
//! | file | what |
//! |---|---|
//! | `side_panel.rs` | the panel at the right with its tabs |
//! | `method_panel.rs`, `pins_panel.rs`, `defects_panel.rs`, `vertex_panel.rs` | one tab each |
//! | `picture_panel.rs` | the picture's part of the pins' tab |
//! | `equation_table.rs` | terms of a vertex's equation, as a table and in the embedding's pane |
//! | `menu.rs`, `verdict_pill.rs` | the menu bar and the verdict in it |
//! | `tools.rs` | the tool bar at the left |
//! | `status.rs` | the status bar |
//! | `floating.rs` | list of keys, "go to", the file dialog inside the window |
//! | `dialogs.rs` | choice of a file |
//! | `exports.rs` | list of exports, pictures of panes |
//! | `unsaved.rs` | the question about unsaved work, the window's title |

mod defects_panel;
pub(super) mod dialogs;
pub(super) mod equation_table;
pub(super) mod exports;
pub(super) mod floating;
pub(super) mod menu;
pub(super) mod method_panel;
mod picture_panel;
mod pins_panel;
pub(super) mod side_panel;
pub(super) mod status;
pub(super) mod tools;
pub(super) mod unsaved;
mod verdict_pill;
mod vertex_panel;

pub(crate) use dialogs::Dialogs;
pub(super) use unsaved::{Answer, Unsaved};
