//! The paper: weights, systems, methods, verdict and distortion. Knows no screen and no file.

mod control;
mod distortion;
mod error;
mod method;
mod solution;
mod verdict;

pub use control::{Control, Phase};
pub use distortion::{Distortion, DistortionSummary, FaceDistortion, Spread, distortion};
pub use error::SolveError;
pub use method::{BoundaryShape, Family, Method, Settings};
pub use solution::{PhaseSeconds, Solution};
pub use verdict::{Verdict, verdict};
