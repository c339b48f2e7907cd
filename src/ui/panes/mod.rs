//! Mesh pane and embedding pane, with their marks, insets and gestures.
//!
//! | file | what |
//! |---|---|
//! | `header.rs` | the header of a pane: title, shading, switches |
//! | `pane.rs` | common parts of both panes: positions on the screen, clicks, the wheel, marks of defects |
//! | `region.rs` | box or lasso that selects what lies in it |
//! | `elements.rs` | vertices, edges and faces: under the pointer, in a region, selected |
//! | `outside_hull.rs` | marks of vertices outside the hull of their neighbours |
//! | `mesh_pane.rs` | the mesh in space |
//! | `plane_pane.rs` | the embedding |
//! | `page_pane.rs` | all charts on the page, in both panes |
//! | `comparison/` | methods side by side, in place of the embedding |
//! | `bars.rs` | bars over a pane: messages and questions |
//! | `brush.rs` | the brush tool in the embedding pane |
//! | `map_origin.rs` | line over the embedding: origin of the map, and other maps to choose |
//! | `checker.rs` | rows of the shading menu that set the squares of the checker |
//! | `legend.rs` | the legend of a shading, notes about compared steps |
//! | `constrain.rs` | the constrain tool: vertex and place on the picture |
//! | `seam.rs` | the seam tool: preview of paths, and its options |
//! | `magnifier.rs` | the insets that magnify a defect, and the halves of a pair |
//! | `inset.rs` | common parts of insets: wheel and drags over them, the close button |
//! | `pin_drag.rs` | a pin dragged with the pointer |
//! | `pins.rs` | kinds of pins and their marks |
//! | `vertex_menu.rs` | the context menu of a vertex or a pin |

mod bars;
mod brush;
mod checker;
pub(super) mod comparison;
pub(super) mod constrain;
mod elements;
mod header;
pub(super) mod inset;
mod legend;
mod magnifier;
mod map_origin;
pub(super) mod mesh_pane;
mod outside_hull;
pub(super) mod page_pane;
pub(super) mod pane;
pub(super) mod pin_drag;
pub(super) mod pins;
pub(super) mod plane_pane;
mod region;
pub(super) mod seam;
pub(super) mod vertex_menu;

pub use pins::PinMark;
