//! Exact proofs about an embedding, and its distortion.
//!
//! | file | contents |
//! |---|---|
//! | `verdict`, `atlas_verdict` | planar or not, of one disk and of several charts |
//! | `layout`, `findings` | planar or not, of any triangles of the plane, with remarks |
//! | `moved` | planar or not, of charts that move among others |
//! | `uv_frame` | the frame in which coordinates are written and proved |
//! | `rounding` | coordinates rounded to 32 bits without a fold |
//! | `conflicts` | pins that contradict each other |
//! | `hull_condition`, `one_form` | vertices outside the hull of their neighbours; indices of one-forms |
//! | `distortion` | angle, area and stretch distortion of every face |

mod atlas_verdict;
mod conflicts;
mod distortion;
mod findings;
pub(crate) mod hull_condition;
mod layout;
mod moved;
mod one_form;
mod rounding;
mod uv_frame;
pub(crate) mod verdict;

pub use atlas_verdict::{
    AtlasVerdict, ChartRelations, ChartVerdict, OVERLAPS_LISTED, atlas_verdict, equal_outlines, stacked_atlas_verdict,
};
pub use conflicts::{CONFLICTS_LISTED, Conflict, conflicts};
pub use distortion::{Distortion, DistortionSummary, FaceDistortion, Mean, Spread, distortion};
pub use findings::{FINDINGS_LISTED, Finding, FindingCode, FindingSeverity};
pub use hull_condition::{CornerKind, HullStanding, holes_turn_once, hull_standing, vertices_outside_hull};
pub use layout::{
    LayoutOptions, LayoutVerdict, MOST_WITHOUT_PLACE, PixelGap, PlaneLayout, layout_verdict, layout_verdict_with,
};
pub use moved::{ChartInPlane, MoveVerdict, move_verdict, shaped_verdict};
pub use one_form::{OneFormIndices, index_range};
pub use rounding::{Rounded, RoundingGrid, rounded};
pub use uv_frame::UvFrame;
pub use verdict::{Verdict, is_one_to_one, is_planar, verdict};
