//! Types of a problem and of its solution.
//!
//! | file | contents |
//! |---|---|
//! | `method`, `stage` | the user's choice of a method, with a table of its traits; the stage that made a step |
//! | `family`, `boundary_shape` | weights; convex shapes for a boundary |
//! | `settings`, `variant` | all settings of a solve; a method as comparisons name it |
//! | `named_option`, `by_name` | options with names and labels; serde by name |
//! | `pins` | pinned vertices in the plane |
//! | `units` | units of a solve: near the origin and near size 1 |
//! | `embedding`, `solution`, `progress` | positions in the plane; the numbers of a linear solve and of an energy |
//! | `weight_source` | origin of a step's weights |
//! | `control`, `error` | progress and cancellation; reasons why there is no embedding |

mod boundary_shape;
#[cfg(feature = "serde")]
mod by_name;
mod control;
mod embedding;
mod error;
mod family;
mod method;
mod named_option;
pub(crate) mod pins;
mod progress;
mod settings;
mod solution;
mod stage;
pub(crate) mod units;
mod variant;
mod weight_source;

pub use boundary_shape::{BoundaryShape, Spacing};
pub use control::{Control, Phase};
pub use embedding::Embedding;
pub use error::{Cause, SolveError};
pub use family::Family;
pub use method::{FamilyChoice, LayoutUse, Method, MethodTraits, PinUse};
pub use named_option::{Labels, NamedOption};
pub use pins::{
    Pin, PinKind, PinPositions, Pins, TakenTargets, are_held_alike, check_pins, farthest_pair, fixed_pins, gauge_pins,
    hard_pins,
};
pub use progress::Progress;
pub use settings::{GaugeSize, Growth, Settings, Start, Treatment};
pub use solution::{Convergence, LinearSolve, PhaseSeconds, Solution, Stop};
pub use stage::Stage;
pub use variant::Variant;
pub use weight_source::{NoEquation, WeightSource};
