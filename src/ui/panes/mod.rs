//! The two panes: mesh and embedding, with their marks, insets and gestures.
//!
//! | file | what |
//! |---|---|
//! | `pane.rs` | what both panes share: header, message bars, marks, legend, wheel |
//! | `mesh_pane.rs` | the mesh in space |
//! | `plane_pane.rs` | the embedding |
//! | `bars.rs` | questions over a pane: recovered work, inward faces, mirrored targets |
//! | `boxes.rs` | selection with a box |
//! | `compare.rs` | words about two steps that are compared |
//! | `constrain.rs` | the constrain tool: vertex and place on the picture |
//! | `defect_marks.rs` | marks of defects |
//! | `magnifier.rs` | the inset that magnifies a defect |
//! | `pair_magnifier.rs` | the inset that magnifies one half of a pair |
//! | `pin_drag.rs` | a pin dragged with the pointer |
//! | `pins.rs` | kinds of pins and their marks |

mod bars;
mod boxes;
pub(super) mod compare;
pub(super) mod constrain;
mod defect_marks;
mod magnifier;
pub(super) mod mesh_pane;
mod pair_magnifier;
pub(super) mod pane;
pub(super) mod pin_drag;
pub(super) mod pins;
pub(super) mod plane_pane;

pub use constrain::{Half, Intent};
pub use pin_drag::PinDrag;
pub use pins::{PinKind, PinShown};
