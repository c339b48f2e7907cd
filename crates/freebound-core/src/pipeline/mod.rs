//! Pipeline from a mesh to a proved atlas: preparation, one problem per chart, steps, layout, proof.
//!
//! The command line, the editor and scripts share this layer. Input and output are plain types: arrays, ids and
//! options. The layer knows no path, no file and no screen.
//!
//! | file | contents |
//! |---|---|
//! | `prepared_mesh` | a mesh repaired, cut and filled: a disk, several charts, or faults |
//! | `options` | all options of a run, collected before anything is built |
//! | `automatic_seams` | short seams whose map keeps the distortion below a bound |
//! | `targets` | the user's pins in texture coordinates |
//! | `problem` | settings, frame and targets of one chart |
//! | `run` | one chart from its problem to its last step |
//! | `outcome` | a proved step with its distortion and its final coordinates |
//! | `laid_chart` | charts with final coordinates, and their proof as one mesh |
//! | `atlas` | layout of several charts: packing, placement, proof |
//! | `pieces` | charts as pieces of a packing, around charts that stay |
//! | `stacks` | charts with congruent surfaces that share one place |
//! | `repack`, `given_charts` | new places for the charts of a given layout, without flattening |
//! | `surface_search` | nearest point of a surface that faces a direction |
//! | `layout_copy` | layout of one mesh on another mesh of the surface |
//! | `unwrap` | the easy calls: any mesh to a proved atlas, and the proof of a given layout |
//! | `summary` | plain data about a result |
//! | `study/` | the iteration on many random trials (paper §7) |

mod atlas;
mod automatic_seams;
mod given_charts;
mod laid_chart;
mod layout_copy;
mod options;
mod outcome;
mod pieces;
mod prepared_mesh;
mod problem;
mod repack;
mod run;
mod stacks;
pub mod study;
mod summary;
mod surface_search;
mod targets;
mod unwrap;

pub use atlas::{Arrangement, Atlas, ChartSummary, SolvedChart, atlas};
pub use automatic_seams::{AutomaticSeams, MeshToCut, SeamProgress, SeamReport};
pub use given_charts::charts_of_layout;
pub use laid_chart::{JoinedCharts, LaidChart, joined, prove_atlas, restack};
pub use layout_copy::{CopiedLayout, CopyLayoutError, LayoutSurface, copy_layout};
pub use options::PipelineOptions;
pub use outcome::{Outcome, pins_summary, upright};
pub use prepared_mesh::{ChartOf, PreparedMesh, Surface};
pub use problem::{Problem, ShapedMap};
pub use repack::{
    ChartSizes, GivenLayout, LockedCharts, RepackError, RepackOptions, Repacked, RepackedChart, repack, repack_with,
};
pub use run::SolvedProblem;
pub use stacks::StackedChart;
pub use summary::{Fit, PackingSummary, PinsSummary, Placement, SoftPinSummary, StackedOn};
pub use surface_search::SurfaceSearch;
pub use targets::{Target, Targets, hard_targets, pins_in_plane};
pub use unwrap::{NO_COORDINATE, UnwrapError, Unwrapped, unwrap, unwrap_with, verify};
