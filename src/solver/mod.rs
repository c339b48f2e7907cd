//! The paper: weights, systems, methods, verdict and distortion. Knows no screen and no file.

mod catalogue;
mod control;
mod convex;
mod distortion;
pub mod equations;
mod error;
mod method;
mod pins;
mod prepared;
mod scale;
mod shape_preserving;
mod solution;
mod system;
mod verdict;
pub mod weights;

pub use catalogue::{CatalogueEntry, FAMILIES, METHODS};
pub use control::{Control, Phase};
pub use convex::convex_boundary;
pub use distortion::{Distortion, DistortionSummary, FaceDistortion, Spread, distortion};
pub use error::SolveError;
pub use method::{BoundaryShape, Family, Method, Settings};
pub use pins::{Pins, check_pins, farthest_pair, gauge_pins};
pub use prepared::{Prepared, flatten};
pub use scale::{to_true_area, to_unit_square};
pub use shape_preserving::shape_preserving;
pub use solution::{PhaseSeconds, Solution};
pub use system::FreeSystem;
pub use verdict::{Verdict, verdict};
