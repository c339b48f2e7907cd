//! The paper: weights, systems, methods, verdict and distortion. Knows no screen and no file.
//!
//! | files | what |
//! |---|---|
//! | `method`, `family`, `boundary_shape`, `settings`, `choice` | what can be chosen, with its names and words |
//! | `variant` | a method with its weights and its boundary, as comparisons name it |
//! | `pins`, `conflicts` | pins and gauge; pins that contradict each other |
//! | `placing`, `upright`, `sheet`, `rounding` | size, place and turn of what is not pinned, without a fold; the numbers that are written of it |
//! | `units` | the units of a solve: near the origin and near size 1, wherever the targets are |
//! | `embedding`, `solution` | positions of all vertices in the plane; one with the numbers of its solve |
//! | `weights`, `pieces`, `equations`, `plane_weights`, `shape_preserving` | the equations of every vertex, from the surface or from the plane |
//! | `system`, `prepared`, `free_gauge`, `free_layout`, `free_solve`, `fixed_solve`, `least_squares`, `many_pins`, `left_kernel`, `convex`, `hull_corners` | one linear solve, with a free or a fixed boundary |
//! | `iterate` | one mean-value iteration (paper §4) |
//! | `lee` | layers of virtual triangles around the mesh, on a convex shape |
//! | `stretch` | a convex boundary with less and less stretch |
//! | `virtual_boundary` | mesh and outside embedded together (paper §5) |
//! | `angles/` | angle based flattening: the angles first, then the plane |
//! | `spectral` | the least conformal energy without a pin |
//! | `schnyder` | a drawing in whole numbers, planar by theorem |
//! | `outside`, `rest`, `foldover_energy`, `membrane`, `block_pattern` | energies of mesh and outside, and Newton's method on them |
//! | `slim` | an energy lowered from Tutte's map, as others ship it |
//! | `live/` | a planar embedding under a dragged pin, proved at every frame |
//! | `coarse/` | a surface with fewer vertices, and the way back from it, one-to-one throughout |
//! | `continuation`, `matchmaker/`, `room_at_boundary`, `relaxing` | one-to-one on the way to constraints; new vertices; lower distortion |
//! | `ladder/`, `flatten` | a plan of rungs over all of these, each step proved; all of them in one call |
//! | `morph/` | a way between two planar embeddings, every frame proved one-to-one |
//! | `verdict`, `atlas`, `distortion`, `vertex_equation` | what is said of an embedding |
//! | `hull_condition`, `one_form` | vertices outside the hull of their neighbours; indices of one-forms |
//! | `study/` | the iteration on many random trials: the paper's open question (§7) |
//! | `control`, `error` | progress and cancelling; why no embedding was produced |

mod angles;
mod atlas;
mod block_pattern;
mod boundary_shape;
mod choice;
pub mod coarse;
mod conflicts;
mod continuation;
mod control;
mod convex;
mod distortion;
mod embedding;
pub mod equations;
mod error;
mod family;
mod fixed_solve;
mod flatten;
pub mod foldover_energy;
mod free_gauge;
mod free_layout;
mod free_solve;
mod hull_condition;
mod hull_corners;
mod iterate;
mod ladder;
mod least_squares;
mod lee;
mod left_kernel;
mod live;
mod many_pins;
mod matchmaker;
mod membrane;
mod method;
mod morph;
mod one_form;
mod outside;
mod pieces;
mod pins;
mod placing;
pub mod plane_weights;
mod prepared;
mod relaxing;
mod rest;
mod room_at_boundary;
mod rounding;
mod schnyder;
mod settings;
mod shape_preserving;
mod sheet;
pub mod slim;
mod solution;
mod spectral;
mod stretch;
pub mod study;
mod system;
mod units;
mod upright;
mod variant;
mod verdict;
mod vertex_equation;
mod virtual_boundary;
pub mod weights;

pub use angles::{AngleMap, AngleSystem, angle_based};
pub use atlas::{AtlasVerdict, ChartVerdict, OVERLAPS_LISTED, atlas_verdict};
pub use boundary_shape::{BoundaryShape, Spacing};
pub use choice::{Choice, Words};
pub use conflicts::{CONFLICTS_LISTED, Conflict, conflicts};
pub use control::{Control, Phase};
pub use convex::convex_boundary;
pub use distortion::{Distortion, DistortionSummary, FaceDistortion, Mean, Spread, distortion};
pub use embedding::Embedding;
pub use error::SolveError;
pub use family::Family;
pub use flatten::{FlattenError, Options, flatten};
pub use hull_condition::{CornerKind, HullStanding, holes_turn_once, hull_standing, vertices_outside_hull};
pub use iterate::Iteration;
pub use ladder::{Candidate, Ending, Kept, Ladder, PlanarStart, Progress, Step, largest_move};
pub use lee::Padded;
pub use live::{Aim, Live, Moved, Obstacle};
pub use matchmaker::{Matched, matched, with_room_made, without_needless_vertices};
pub use method::Method;
pub use morph::{Morph, MorphOptions, NoMorph, Route, morph};
pub use one_form::{OneFormIndices, index_range};
pub use outside::Outside;
pub use pins::{
    Hold, Pin, PinPositions, Pins, TakenTargets, are_held_alike, check_pins, farthest_pair, fixed_pins, gauge_pins,
    hard_pins,
};
pub use placing::{to_true_area, to_unit_box, to_unit_square, to_unit_square_by_power_of_two, true_area_factor};
pub use prepared::{Prepared, solve_once};
pub use rounding::{Grid, Rounded, rounded};
pub use schnyder::schnyder;
pub use settings::{GaugeSize, Growth, Settings, Start, Treatment};
pub use shape_preserving::shape_preserving;
pub use sheet::Sheet;
pub use solution::{Convergence, LinearSolve, PhaseSeconds, Solution, Stop};
pub use spectral::{Spectral, spectral};
pub use stretch::{LessStretched, StretchMinimising};
pub use system::FreeSystem;
pub use variant::Variant;
pub use verdict::{Verdict, is_one_to_one, is_planar, verdict};
pub use vertex_equation::{EquationTerm, NoEquation, VertexEquation, WeightSource, equation_of_step};
pub use virtual_boundary::{Extended, Outline, VirtualBoundary};
